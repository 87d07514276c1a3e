"""The last walls, put up by a child around itself before it reads a line of anybody's code.

Level A: the child is pid 1 of its own user, pid, mount and ipc namespaces, has its own tmpfs and /proc, no capabilities,
Landlock, resource limits and the system call filter. Level A-: the same in the zygote's namespaces, which all notebooks
share; so there is no /proc, and after its files are laid out a notebook may write none (a shared tmpfs could be filled by
one, and read by the next). Whatever fails raises: there is no weaker way on.
"""

from __future__ import annotations

import contextlib
import glob
import mmap
import os
import resource
import sys
from collections.abc import Callable, Sequence

from autograder.sandbox import system

UID = 1000  # inside; on the host it is the grader's uid, or the one that root drops to
SCRATCH = "/scratch"
READABLE = ("/python", "/packages", "/guest", "/usr", "/lib", "/lib64", "/etc", "/nix", "/gnu", "/dev/random", "/dev/urandom")
DEVICES = ("/dev/null", "/dev/zero", "/dev/full")
PROC = tuple(f"/proc/{name}" for name in ("cpuinfo", "meminfo", "self/stat", "self/statm", "self/status"))
NAMESPACES = system.CLONE_NEWUSER | system.CLONE_NEWPID | system.CLONE_NEWNS | system.CLONE_NEWIPC
PROCESS_ID_MAX = 400  # the least a kernel takes is about 300; RLIMIT_NPROC is the tighter one


def confine(
    level: str,
    limits: dict[str, int | float],
    scratch: str,
    programme: bytes,
    lay_out: Callable[[], None],
    withhold: Sequence[str] = (),
) -> dict[str, int | str]:
    """Put up all walls; afterwards the process is in its own working folder. Returns what was found on the way.

    ``lay_out`` writes the notebook's files into the current folder, before that may become unwritable. ``withhold`` are
    modules that this process shall not find.
    """
    facts: dict[str, int | str] = {"level": level}
    os.setsid()  # kill(0) reaches a whole process group, also across pid namespaces: be a group of one
    if level == "A":
        _become_somebody()
        facts["proc"] = _own_mounts(limits)
        _withhold(withhold)
    elif withhold:
        raise OSError(f"to withhold {', '.join(withhold)}, a notebook needs a mount namespace of its own, which level A has")
    work, temporary = f"{scratch}/work", f"{scratch}/tmp"
    for folder in (work, temporary, f"{scratch}/home"):
        os.makedirs(folder, 0o700, exist_ok=False)
    if level == "A":
        system.mount(temporary, "/tmp", None, system.MS_BIND)
    _capture(scratch, int(limits["file"]))
    os.chdir(work)
    lay_out()
    limit_resources(limits)
    system.leave_no_core()
    if level == "A":
        system.drop_capabilities()
    system.no_new_privileges()
    if level == "A":
        facts["landlock"] = system.landlock([*READABLE, *PROC], DEVICES, [scratch, "/tmp"])
    else:
        facts["landlock"] = system.landlock([*READABLE, scratch], DEVICES, [])
    if level == "A-" and int(facts["landlock"]) < 6:
        raise OSError("without namespaces for each notebook, Landlock ABI 6 is needed to keep signals apart (Linux 6.12)")
    system.load_filter(programme)
    return facts


def _become_somebody() -> None:
    """Map one user id in the new user namespace."""
    _write("/proc/self/setgroups", "deny")
    _write("/proc/self/gid_map", f"{UID} {UID} 1")
    _write("/proc/self/uid_map", f"{UID} {UID} 1")


def _own_mounts(limits: dict[str, int | float]) -> str:
    """A bounded tmpfs, and a /proc that shows this process only (or nothing, where the kernel does not allow one)."""
    nosuid = system.MS_NOSUID | system.MS_NODEV
    inodes = 4 * int(limits["files"]) + 64
    system.mount("tmpfs", SCRATCH, "tmpfs", nosuid, f"size={int(limits['scratch'])},nr_inodes={inodes},mode=700")
    try:
        system.mount("proc", "/proc", "proc", nosuid | system.MS_NOEXEC)
    except OSError:
        system.mount("tmpfs", "/proc", "tmpfs", nosuid | system.MS_NOEXEC | system.MS_RDONLY, "size=4k,nr_inodes=2")
        return "hidden"
    with contextlib.suppress(OSError):  # counted per pid namespace from Linux 6.14 on; before, nobody here may write it
        _write("/proc/sys/kernel/pid_max", str(PROCESS_ID_MAX))
    return "own"


def _withhold(modules: Sequence[str]) -> None:
    """Cover the files of top-level modules, and what is compiled of them, with nothing."""
    for name in modules:
        if any(loaded.partition(".")[0] == name for loaded in sys.modules):
            raise OSError(f"{name} cannot be withheld: the sandbox itself uses it")
        for folder in filter(os.path.isdir, sys.path):
            for path in glob.glob(f"{glob.escape(folder)}/{name}*") + glob.glob(f"{glob.escape(folder)}/__pycache__/{name}.*"):
                if os.path.basename(path).partition(".")[0].partition("-")[0] != name:
                    continue  # another module whose name begins alike
                if os.path.isdir(path):
                    system.mount("tmpfs", path, "tmpfs", system.MS_NOSUID | system.MS_NODEV | system.MS_RDONLY, "size=4k")
                else:
                    system.mount("/dev/null", path, None, system.MS_BIND)


def _capture(scratch: str, size: int) -> None:
    """Let what C code prints go to unlinked files, one for each stream, which the shell reads after each cell."""
    for descriptor in (1, 2):
        path = f"{scratch}/printed"
        file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_APPEND, 0o600)
        os.unlink(path)
        os.dup2(file, descriptor)
        os.close(file)


def limit_resources(limits: dict[str, int | float]) -> None:
    """Resource limits, set inside the user namespace: RLIMIT_NPROC counts per namespace and does not bind the host's root."""
    _set(resource.RLIMIT_AS, _address_space() + int(limits["memory"]))
    _set(resource.RLIMIT_CPU, int(limits["notebook_cpu"]) + 10)  # the grader ends it earlier; this holds if the grader has died
    _set(resource.RLIMIT_NPROC, int(limits["threads"]))
    _set(resource.RLIMIT_FSIZE, int(limits["file"]))
    _set(resource.RLIMIT_NOFILE, 256)
    _set(resource.RLIMIT_CORE, 1)  # a program of the machine that is given cores is given one also at 0, never at 1
    _set(resource.RLIMIT_MSGQUEUE, 0)
    _set(resource.RLIMIT_MEMLOCK, 0)
    _set(resource.RLIMIT_SIGPENDING, 256)


def _address_space() -> int:
    """Bytes that the interpreter has already; where no /proc says so, the least limit under which it may have a page more."""
    with contextlib.suppress(OSError), open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[0]) * resource.getpagesize()
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    least, most = 0, 2**40 if hard == resource.RLIM_INFINITY else hard
    while most - least > 2**20:
        middle = (least + most) // 2
        try:
            resource.setrlimit(resource.RLIMIT_AS, (middle, hard))
            mmap.mmap(-1, resource.getpagesize()).close()
        except (OSError, MemoryError):
            least = middle
        else:
            most = middle
        finally:
            resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
    return most


def _set(which: int, value: int) -> None:
    """Lower a limit, never above what already holds."""
    hard = resource.getrlimit(which)[1]
    value = value if hard == resource.RLIM_INFINITY else min(value, hard)
    resource.setrlimit(which, (value, value))


def _write(path: str, text: str) -> None:
    with open(path, "w", encoding="ascii") as file:
        file.write(text)
