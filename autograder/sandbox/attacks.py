"""What hostile code tries. Each function returns True if it got through; it fails, or raises, where it was stopped.

``directrix doctor`` and the tests run this file in the sandbox, and also without it (``python attacks.py NAME FACTS``), to show
that each attack would work if nobody stopped it. Standard library only, and harmless by construction: decoys, small amounts,
everything undone. ``facts`` is JSON: what the attacker knows, such as the path of a decoy.
More than 400 lines, for it is one list and one file crosses into the sandbox; each attack is a few lines.
"""

import ctypes
import fcntl
import importlib
import json
import mmap
import os
import platform
import signal
import socket
import sys
import tempfile
import threading
import time
from typing import Any

libc: Any = ctypes.CDLL(None, use_errno=True)
X86 = platform.machine() == "x86_64"


def _syscall(on_x86: int, on_arm: int, *arguments: int) -> bool:
    return bool(libc.syscall(ctypes.c_long(on_x86 if X86 else on_arm), *map(ctypes.c_long, arguments)) >= 0)


def read_gradebook(facts: str) -> bool:
    """Read a file of the grader by its path."""
    with open(json.loads(facts)["decoy"], encoding="utf-8") as file:
        return "secret" in file.read()


def stat_gradebook(facts: str) -> bool:
    """Ask whether a file of the grader exists, and how large it is."""
    return os.stat(json.loads(facts)["decoy"]).st_size > 0


def read_passwd(facts: str) -> bool:
    """Read /etc/passwd."""
    with open("/etc/passwd", encoding="utf-8") as file:
        return "root" in file.read()


def read_through_link(facts: str) -> bool:
    """Read a file of the grader through a symbolic link in the working folder."""
    os.symlink(json.loads(facts)["decoy"], "link")
    try:
        with open("link", encoding="utf-8") as file:
            return "secret" in file.read()
    finally:
        os.unlink("link")


def read_environments(facts: str) -> bool:
    """Read the environment of another process, where tokens are kept."""
    for pid in _others(facts):
        try:
            with open(f"/proc/{pid}/environ", "rb") as file:
                if file.read():
                    return True
        except OSError:
            continue
    return False


def list_processes(facts: str) -> bool:
    """See other processes in /proc."""
    return any(os.path.exists(f"/proc/{pid}") for pid in _others(facts))


def _others(facts: str) -> list[int]:
    """Process ids worth a try: those listed in /proc, and low ones in case it cannot be listed."""
    try:
        listed = [int(name) for name in os.listdir("/proc") if name.isdigit()]
    except OSError:
        listed = []
    known = json.loads(facts)
    return [pid for pid in {*listed, *range(1, 400), known["victim"], known["grader"]} if pid not in (0, os.getpid())]


def inherited_descriptors(facts: str) -> bool:
    """Use a file that the grader has open."""
    known = {0, 1, 2, 3}  # standard streams, and the sandbox's own socket
    for descriptor in set(range(4, 256)) - known:
        try:
            if b"secret" in os.pread(descriptor, 100, 0):
                return True
        except OSError:
            continue
    return False


def reference_library(facts: str) -> bool:
    """Import the reference solutions."""
    return any(
        _importable(name) for name in ("directrix.curves", "directrix.surfaces", "autograder.catalogue", "autograder.judge")
    )


def _importable(name: str) -> bool:
    try:
        importlib.import_module(name)
    except ImportError:
        return False
    return True


def write_outside(facts: str) -> bool:
    """Write into a folder of the grader."""
    path = os.path.join(json.loads(facts)["writable"], "written")
    with open(path, "w", encoding="utf-8") as file:
        file.write("x")
    os.unlink(path)
    return True


def write_packages(facts: str) -> bool:
    """Change the standard library for everyone after."""
    with open(json.__file__, "ab"):
        return True


def tcp(facts: str) -> bool:
    """Connect to a server of this machine over TCP."""
    socket.create_connection(("127.0.0.1", json.loads(facts)["port"]), timeout=2).close()
    return True


def udp(facts: str) -> bool:
    """Send a datagram."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        return sender.sendto(b"x", ("127.0.0.1", json.loads(facts)["port"])) == 1


def abstract_socket(facts: str) -> bool:
    """Connect to an abstract unix socket, which no file permission guards."""
    with socket.socket(socket.AF_UNIX) as end:
        end.connect("\0" + json.loads(facts)["abstract"])
    return True


def unix_socket(facts: str) -> bool:
    """Connect to a unix socket by its path."""
    with socket.socket(socket.AF_UNIX) as end:
        end.connect(json.loads(facts)["unix"])
    return True


def datagram_pair(facts: str) -> bool:
    """Make a pair of datagram sockets, which can send to any abstract address."""
    for end in socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM):
        end.close()
    return True


def fork(facts: str) -> bool:
    """Start a process."""
    pid = os.fork()
    if pid == 0:
        os._exit(0)
    os.waitpid(pid, 0)
    return True


def spawn(facts: str) -> bool:
    """Run a program."""
    pid = os.posix_spawn(sys.executable, [sys.executable, "-S", "-c", "pass"], os.environ)
    return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 0


def replace_program(facts: str) -> bool:
    """Replace this process by a program (tried with a path that is no program, to come back)."""
    try:
        os.execv(os.path.dirname(sys.executable) or "/", ["x"])
    except PermissionError as error:
        return error.errno != 1  # EPERM is the filter; EACCES the kernel's word on a folder
    return True


def many_threads(facts: str) -> bool:
    """Start 300 threads at once."""
    stop = threading.Event()
    before = threading.stack_size(256 * 1024)
    started = []
    try:
        for _ in range(300):
            thread = threading.Thread(target=stop.wait, args=(5,), daemon=True)
            thread.start()
            started.append(thread)
    except RuntimeError:
        return False
    finally:
        stop.set()
        threading.stack_size(before)
        for thread in started:
            thread.join()
    return True


def much_memory(facts: str) -> bool:
    """Take twice the memory that is allowed."""
    mmap.mmap(-1, json.loads(facts)["memory"] * 2).close()
    return True


def memory_file(facts: str) -> bool:
    """Keep data in a memfd, which no memory limit counts."""
    os.close(os.memfd_create("x"))
    return True


def shared_memory(facts: str) -> bool:
    """Keep data in System V shared memory, which no memory limit counts."""
    identifier = libc.shmget(0, ctypes.c_size_t(4096), 0o1600)  # IPC_PRIVATE, IPC_CREAT | 0600
    if identifier < 0:
        return False
    libc.shmctl(identifier, 0, None)  # IPC_RMID
    return True


def fill_disk(facts: str) -> bool:
    """Write more than the scratch folder may hold, in files that are small enough each."""
    wanted, size = json.loads(facts)["scratch"] + 2**20, 2**20
    with tempfile.TemporaryDirectory() as folder:
        for number in range(wanted // size + 1):
            with open(f"{folder}/{number}", "wb") as file:
                file.write(bytes(size))
    return True


def large_file(facts: str) -> bool:
    """Write one file larger than allowed."""
    with tempfile.TemporaryFile() as file:
        file.truncate(json.loads(facts)["file"] + 1)
    return True


def many_files(facts: str) -> bool:
    """Make 20000 empty files."""
    with tempfile.TemporaryDirectory() as folder:
        for number in range(20_000):
            os.close(os.open(f"{folder}/{number}", os.O_CREAT | os.O_WRONLY))
    return True


def shared_folder(facts: str) -> bool:
    """Read what another notebook left in the folder for temporary files."""
    with open(json.loads(facts)["left"], encoding="utf-8") as file:
        return "secret" in file.read()


def close_folder(facts: str) -> bool:
    """Close another notebook's folder to it (its mode is set to what it is: what may do that may do the other)."""
    folder = os.path.dirname(json.loads(facts)["left"])
    if folder == os.environ.get("TMPDIR"):  # this notebook's own
        return False
    os.chmod(folder, os.stat(folder).st_mode & 0o7777)
    return True


def fifo(facts: str) -> bool:
    """Make a FIFO, on which whoever opens it waits for ever."""
    os.mkfifo("pipe")
    os.unlink("pipe")
    return True


def kill_others(facts: str) -> bool:
    """End the grader or another notebook (outside the sandbox: a victim; everybody else gets signal 0, which does nothing)."""
    known = json.loads(facts)
    for pid in _others(facts):
        try:
            os.kill(pid, signal.SIGKILL if pid == known["victim"] else 0)
        except OSError:
            continue
        if pid in (known["victim"], known["grader"]):
            return True
    return False


def kill_by_file(facts: str) -> bool:
    """End another notebook by the signal that says that a file can be read (outside the sandbox: a victim)."""
    here, there = socket.socketpair()
    victim = json.loads(facts)["victim"]
    for pid in [victim] if victim else range(2, 40):  # the first process of a namespace hears no signal from inside
        if pid == os.getpid():
            continue
        try:
            fcntl.fcntl(here, fcntl.F_SETSIG, signal.SIGKILL)
            fcntl.fcntl(here, fcntl.F_SETOWN, pid)
            fcntl.fcntl(here, fcntl.F_SETFL, os.O_NONBLOCK | os.O_ASYNC)
        except OSError:
            continue
        there.send(b"x")
        here.recv(1)
    if not victim:
        return False  # a neighbour that is gone is seen by who asks it
    time.sleep(0.2)
    with open(f"/proc/{victim}/stat", encoding="ascii") as file:
        return file.read().rpartition(")")[2].split()[0] == "Z"


def lease(facts: str) -> bool:
    """Have whoever opens a file wait: any file of this user, a grader's Python and packages among them (one's own is tried)."""
    for opened in (lambda: os.fdopen(1, "ab", closefd=False), tempfile.TemporaryFile):  # at level A- no file may be made
        with opened() as file:
            try:
                fcntl.fcntl(file, fcntl.F_SETLEASE, fcntl.F_WRLCK)
            except OSError:  # what is printed may go to no file
                continue
            fcntl.fcntl(file, fcntl.F_SETLEASE, fcntl.F_UNLCK)
            return True
    return False


def kill_group(facts: str) -> bool:
    """Send a signal to the process group, which other processes may share."""
    signal.signal(signal.SIGUSR1, signal.SIG_IGN)
    os.kill(0, signal.SIGUSR1)
    return os.getpgrp() != os.getpid()


def trace(facts: str) -> bool:
    """Use ptrace."""
    return int(libc.ptrace(0, 0, None, None)) == 0  # PTRACE_TRACEME


def read_other_memory(facts: str) -> bool:
    """Read memory by process id (tried on this process itself)."""
    data, copy = ctypes.create_string_buffer(b"secret"), ctypes.create_string_buffer(6)
    ours = (ctypes.c_void_p * 2)(ctypes.addressof(copy), 6)
    theirs = (ctypes.c_void_p * 2)(ctypes.addressof(data), 6)
    arguments = (os.getpid(), ctypes.addressof(ours), 1, ctypes.addressof(theirs), 1, 0)
    return _syscall(310, 270, *arguments) and copy.raw == b"secret"


def user_namespace(facts: str) -> bool:
    """Become root of a new user namespace, the way to most kernel holes."""
    return int(libc.unshare(0x10000000)) == 0


def clone3(facts: str) -> bool:
    """Start a process by clone3, whose arguments a filter cannot read."""
    arguments = (ctypes.c_uint64 * 8)(0, 0, 0, 0, signal.SIGCHLD, 0, 0, 0)
    pid = libc.syscall(ctypes.c_long(435), ctypes.byref(arguments), ctypes.c_size_t(64))
    if pid == 0:
        os._exit(0)
    if pid > 0:
        os.waitpid(pid, 0)
    return bool(pid > 0)


def io_uring(facts: str) -> bool:
    """Use io_uring, which goes past system call filters."""
    settings = ctypes.create_string_buffer(120)
    return _syscall(425, 425, 1, ctypes.addressof(settings))


def userfault(facts: str) -> bool:
    """Use userfaultfd, a helper of kernel exploits."""
    return _syscall(323, 282, 1)  # UFFD_USER_MODE_ONLY


def keyring(facts: str) -> bool:
    """Use the kernel's keyrings."""
    return _syscall(250, 219, 0, -3, 1)  # KEYCTL_GET_KEYRING_ID, KEY_SPEC_SESSION_KEYRING


def priorities(facts: str) -> bool:
    """Change how processes are scheduled."""
    os.sched_setaffinity(0, os.sched_getaffinity(0))
    return True


def become_root(facts: str) -> bool:
    """Become user 0, or keep being it."""
    os.setuid(0)
    return os.access("/proc/1/environ", os.R_OK)


def ignore_the_end(facts: str) -> bool:
    """Loop for ever, catching every exception and ignoring every signal."""
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGALRM, signal.SIGPROF, signal.SIGXCPU, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    deadline = time.monotonic() + json.loads(facts)["patience"]
    while time.monotonic() < deadline:
        try:
            sum(range(100_000))
        except BaseException:
            continue
    return True


def hang_in_c(facts: str) -> bool:
    """Stay inside one call of compiled code."""
    return sum(range(int(json.loads(facts)["patience"] * 2e7))) > 0


def sleep(facts: str) -> bool:
    """Do nothing for long, so that no CPU limit notices."""
    for number in (signal.SIGALRM, signal.SIGPROF):
        signal.signal(number, signal.SIG_IGN)
    time.sleep(json.loads(facts)["patience"])
    return True


if __name__ == "__main__":
    print(globals()[sys.argv[1]](sys.argv[2]) is True)
