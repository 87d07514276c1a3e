"""Which isolation this machine gives, found out by attacking it.

Every attack of ``sandbox/attacks.py`` is run inside the sandbox, and once outside it: an attack that fails without the sandbox
too proves nothing here and is not counted. The level is the best one whose sandbox starts and stops all that count:

    A, A-    notebooks are graded; A has namespaces of its own for each
    B        Landlock and the system call filter can be had, namespaces cannot: nothing is graded here as it stands
    C, D     macOS; nothing at all

Below A- nothing was attacked, since nothing would be run: the report says what is missing, and where to grade instead.
"""

from __future__ import annotations

import contextlib
import json
import os
import platform
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal

from autograder.errors import CallFailed, IsolationError, SandboxError
from autograder.sandbox import attacks, system
from autograder.sandbox.box import LEVELS, Sandbox
from autograder.sandbox.launcher import bubblewrap
from autograder.sandbox.policy import Limits, Policy

SCRIPT = Path(attacks.__file__)
ATTACKS = tuple(
    name for name, value in vars(attacks).items() if callable(value) and value.__module__ == attacks.__name__ and name[0] != "_"
)
MiB = 2**20
LIMITS = Limits(call_cpu=0.4, patience=0.5, memory=512 * MiB, scratch=8 * MiB, file=4 * MiB, files=500)
PATIENCE = 20.0  # seconds that an endless attack would go on for; being stopped takes less than two
UNGUARDED_SECONDS = 1.5
LEAVE = """
import os
path = os.path.join(os.environ["TMPDIR"], "left")
try:
    with open(path, "w") as file:
        file.write("secret")
finally:
    print(path)
"""

NAMESPACES = "from autograder.sandbox import system; system.unshare(0x10000000 | 0x20000)"  # CLONE_NEWUSER | CLONE_NEWNS
FILTER = """
from autograder.sandbox import system
from autograder.sandbox.guest import seccomp
system.no_new_privileges()
system.load_filter(seccomp.programme())
"""
SETTINGS = {  # of the kernel: the value that forbids, and what to do about it
    "/proc/sys/kernel/apparmor_restrict_unprivileged_userns": (
        "1", "AppArmor keeps user namespaces to programs it knows (Ubuntu 24.04 and newer): `apt install bubblewrap`, whose "
        "path it knows, or `sysctl kernel.apparmor_restrict_unprivileged_userns=0`.",
    ),
    "/proc/sys/kernel/unprivileged_userns_clone": (
        "0", "User namespaces are off: `sysctl kernel.unprivileged_userns_clone=1`.",
    ),
    "/proc/sys/user/max_user_namespaces": ("0", "User namespaces are off: `sysctl user.max_user_namespaces=10000`."),
}  # fmt: skip
CONTAINERS = ("/.dockerenv", "/run/.containerenv")

Outcome = Literal["stopped", "got through", "proves nothing"]


@dataclass(frozen=True)
class Probe:
    """One attack: what it tried, what came of it in the sandbox, and whether it works without."""

    name: str
    tried: str
    outcome: Outcome
    detail: str = ""


@dataclass(frozen=True)
class Report:
    """The level reached, the attacks, what the machine has, and what to do where a level is not given."""

    level: str
    meaning: str
    probes: tuple[Probe, ...]
    machine: dict[str, Any]
    advice: tuple[str, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """Plain lists, dicts and strings."""
        return asdict(self)


def report() -> list[Probe]:
    """The attacks at the best level that this machine gives."""
    return list(examine().probes)


def examine(levels: tuple[str, ...] = ("A", "A-")) -> Report:
    """Run the attacks at each level in turn until one is given in full; without one, say what is missing."""
    if sys.platform != "linux":
        level = "C" if sys.platform == "darwin" else "D"
        return Report(level, LEVELS[level], (), machine(), tuple(_advice(level)))
    advice: list[str] = []
    probes: tuple[Probe, ...] = ()
    with _decoys() as facts:
        bare = without_sandbox(facts)
        for level in levels:
            try:
                probes = attack(level, facts, bare)
            except SandboxError as error:
                advice.append(f"{level}: {error}")
                continue
            through = [probe.name for probe in probes if probe.outcome == "got through"]
            if not through:
                return Report(level, LEVELS[level], probes, machine(), tuple(advice + _advice(level)))
            advice.append(f"{level}: not stopped: {', '.join(through)}")
    found = machine()
    level = "B" if found["landlock"] and found["system call filter"] == "yes" else "D"
    return Report(level, LEVELS[level], probes, found, tuple(advice + _advice(level)))


def attack(level: str, facts: dict[str, Any], bare: dict[str, str]) -> tuple[Probe, ...]:
    """All attacks in a sandbox of that level. ``bare`` says how each went without: "got through", or why not.

    Raises
    ------
    IsolationError
        If the level is not given at all.
    """
    with Sandbox(Policy(packages=(), preload=()), level) as box, ThreadPoolExecutor(4) as pool:
        return tuple(pool.map(lambda name: _probe(box, name, facts, bare[name]), ATTACKS))


def without_sandbox(facts: dict[str, Any]) -> dict[str, str]:
    """Run every attack as an ordinary process of this user: how it went."""
    with ThreadPoolExecutor(4) as pool:
        return dict(zip(ATTACKS, pool.map(lambda name: _unguarded(name, facts), ATTACKS), strict=True))


def machine() -> dict[str, Any]:
    """What this machine has for a sandbox."""
    try:
        program = bubblewrap()
        version = subprocess.run([program, "--version"], capture_output=True, text=True, check=False).stdout.strip()
    except (IsolationError, OSError) as error:
        program, version = "", str(error)
    uid = os.geteuid() if hasattr(os, "geteuid") else None
    return {
        "system": platform.platform(),
        "user": "root, who drops to another uid" if uid == 0 else f"uid {uid}",
        "bubblewrap": f"{program} ({version})" if program else version,
        "landlock": system.landlock_abi() if sys.platform == "linux" else 0,
        "user namespaces": _tried(NAMESPACES),
        "system call filter": _tried(FILTER),
    }


def _tried(script: str) -> str:
    """ "yes" if a process of its own gets through this, else why not."""
    if sys.platform != "linux":
        return "only on Linux"
    paths = os.pathsep.join(path for path in sys.path if path)
    done = subprocess.run(
        [sys.executable, "-c", script], env=os.environ | {"PYTHONPATH": paths}, capture_output=True, text=True, check=False
    )
    said = done.stderr.strip().splitlines()
    return "yes" if done.returncode == 0 else f"no ({said[-1] if said else f'exit code {done.returncode}'})"


def _probe(box: Sandbox, name: str, facts: dict[str, Any], bare: str) -> Probe:
    """One attack from one notebook, beside another one that is there to be attacked."""
    tried = (getattr(attacks, name).__doc__ or "").strip().splitlines()[0]
    if bare != "got through":
        return Probe(name, tried, "proves nothing", f"without the sandbox: {bare}")
    began = time.monotonic()
    with box.open(limits=LIMITS) as neighbour, box.open(limits=LIMITS) as session:
        left = neighbour.run_cell(LEAVE).outputs[0]["text"].strip()
        session.run_cell(SCRIPT.read_text("utf-8").replace('if __name__ == "__main__"', "if False"))
        known = facts | {"left": left, "grader": os.getpid(), "victim": 0}
        try:
            through, detail = session.call(name, (json.dumps(known),)) is True, ""
        except CallFailed as failure:
            through, detail = False, f"{failure.exception}: {failure.message}".removeprefix(": ")
        if not through and neighbour.run_cell("1").status != "ok":
            through, detail = True, "the neighbour was harmed"
    seconds = time.monotonic() - began
    return Probe(
        name, tried, "got through" if through else "stopped", f"{detail} ({seconds:.1f} s)" if seconds > 0.5 else detail
    )


def _unguarded(name: str, facts: dict[str, Any]) -> str:
    """The same attack without a sandbox, in a folder of its own, with one harmless process as its victim."""
    endless = name in ("ignore_the_end", "hang_in_c", "sleep")
    with tempfile.TemporaryDirectory() as folder, open(facts["decoy"], "rb") as decoy:
        sleeper = [sys.executable, "-S", "-c", "import time; time.sleep(60)"]
        victim = subprocess.Popen(sleeper, process_group=0)
        try:
            known = facts | {"victim": victim.pid, "left": facts["decoy"], "grader": os.getpid(), "patience": UNGUARDED_SECONDS}
            command = [sys.executable, str(SCRIPT), name, json.dumps(known)]
            done = subprocess.run(
                command, cwd=folder, capture_output=True, text=True, timeout=30, pass_fds=[decoy.fileno()],
                process_group=victim.pid,
                env=os.environ | {"PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}, check=False,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return "took too long"
        finally:
            victim.kill()
            victim.wait()
    if done.stdout.strip().endswith("True"):
        return "got through"
    last = done.stderr.strip().splitlines()
    return last[-1] if last and not endless else "it did nothing"


@contextlib.contextmanager
def _decoys() -> Iterator[dict[str, Any]]:
    """A file that looks like a gradebook, a folder to write to, servers to connect to: open to every user of the machine."""
    with contextlib.ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="doctor-")))
        folder.chmod(0o755)
        (folder / "gradebook.db").write_text("secret marks", "utf-8")
        (folder / "gradebook.db").chmod(0o644)
        (folder / "writable").mkdir()
        (folder / "writable").chmod(0o777)
        tcp = stack.enter_context(socket.create_server(("127.0.0.1", 0)))
        abstract = f"directrix-doctor-{os.getpid()}"
        for address in (f"\0{abstract}", str(folder / "socket")):
            server = stack.enter_context(socket.socket(socket.AF_UNIX))
            server.bind(address)
            server.listen(64)
        (folder / "socket").chmod(0o777)
        yield {
            "decoy": str(folder / "gradebook.db"), "writable": str(folder / "writable"), "unix": str(folder / "socket"),
            "port": tcp.getsockname()[1], "abstract": abstract, "memory": LIMITS.memory, "scratch": LIMITS.scratch,
            "file": LIMITS.file, "patience": PATIENCE,
        }  # fmt: skip


def _advice(level: str) -> list[str]:
    """What is missing for level A here, and what to do."""
    if level == "A":
        return []
    if sys.platform == "darwin":
        return [
            "macOS has no namespaces, no Landlock and no system call filter: nothing is graded on it. Write and check here; "
            "grade in a Linux virtual machine (Lima, UTM, Multipass) that sees the course folder, or on a server.",
            IMAGE,
            IN_CONTAINERS,
        ]
    if sys.platform != "linux":
        return [
            "Windows has nothing that could hold a notebook here: nothing is graded on it. Write and check here; grade in "
            "WSL2: `wsl --install`, and in its Ubuntu `apt install bubblewrap python3-venv`, then `pip install directrix`.",
            "Keep the course folder inside WSL (`~/course`, not `/mnt/c`): permissions hold only there.",
            IMAGE,
            IN_CONTAINERS,
        ]
    found = ["Level A needs bubblewrap, user namespaces and Landlock (Linux 5.13 or newer)."]
    for path, (forbids, advice) in SETTINGS.items():
        if _content(path) == forbids:
            found.append(advice)
    if any(os.path.exists(path) for path in CONTAINERS) or "container" in os.environ:
        found.append(IN_CONTAINERS)
    if level == "B":
        found.append("What this machine has, Landlock and a system call filter, is not enough: nothing is graded at level B.")
    return found


IMAGE = (
    "Or in a container, which is a Linux virtual machine on your system too: the Containerfile at the top of Directrix's "
    "repository makes an image for grading, docs/container.md there says how to run it."
)
IN_CONTAINERS = (
    "In a container, allow user namespaces and mounts (Docker: --security-opt seccomp=unconfined --security-opt "
    "apparmor=unconfined --security-opt systempaths=unconfined; Podman: --security-opt unmask=ALL instead of the last) and "
    "be an ordinary user in it, or grade outside."
)


def _content(path: str) -> str:
    try:
        return Path(path).read_text("ascii").strip()
    except OSError:
        return ""


def main() -> None:
    """``python -m autograder.doctor``: the report as JSON."""
    print(json.dumps(examine().to_dict(), indent=1))


if __name__ == "__main__":
    main()
