"""The Linux calls that Python has no function for: namespaces, mounts, Landlock, seccomp. ctypes only.

Loaded by the trusted side when it prepares mounts as root, by the zygote and by every child.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import platform
import struct
from collections.abc import Iterable

CLONE_THREAD = 0x10000
CLONE_NEWNS, CLONE_NEWIPC, CLONE_NEWUSER, CLONE_NEWPID = 0x20000, 0x08000000, 0x10000000, 0x20000000
CLONE_NAMESPACES = CLONE_NEWNS | CLONE_NEWIPC | CLONE_NEWUSER | CLONE_NEWPID | 0x02000000 | 0x04000000 | 0x40000000
CLONE_CHILD_CLEARTID, CLONE_CHILD_SETTID = 0x00200000, 0x01000000
SIGCHLD = 17

MS_RDONLY, MS_NOSUID, MS_NODEV, MS_NOEXEC, MS_BIND, MS_REC, MS_PRIVATE = 1, 2, 4, 8, 0x1000, 0x4000, 0x40000
AT_FDCWD, AT_EMPTY_PATH, AT_RECURSIVE = -100, 0x1000, 0x8000
OPEN_TREE_CLONE, MOVE_MOUNT_F_EMPTY_PATH = 1, 4
MOUNT_ATTR_RDONLY, MOUNT_ATTR_NOSUID = 1, 2

PR_SET_NO_NEW_PRIVS, PR_SET_SECCOMP, PR_GET_TID_ADDRESS, PR_SET_NAME, PR_SET_PDEATHSIG, PR_SET_DUMPABLE = 38, 22, 40, 15, 1, 4
SECCOMP_MODE_FILTER = 2

CLONE_NUMBER = {"x86_64": 56, "aarch64": 220}
CAPSET_NUMBER = {"x86_64": 126, "aarch64": 91}
GETTID_NUMBER = {"x86_64": 186, "aarch64": 178}
# The same on both architectures:
OPEN_TREE, MOVE_MOUNT, MOUNT_SETATTR = 428, 429, 442
LANDLOCK_CREATE, LANDLOCK_ADD, LANDLOCK_RESTRICT = 444, 445, 446

# Landlock's rights to files, by the ABI that introduced them.
FS_EXECUTE, FS_WRITE_FILE, FS_READ_FILE, FS_READ_DIR, FS_REMOVE_DIR, FS_REMOVE_FILE = 1, 2, 4, 8, 16, 32
FS_MAKE_DIR, FS_MAKE_REG, FS_MAKE_SYM, FS_REFER, FS_TRUNCATE = 1 << 7, 1 << 8, 1 << 12, 1 << 13, 1 << 14
FS_OF_ABI = (0, (1 << 13) - 1, (1 << 14) - 1, (1 << 15) - 1, (1 << 15) - 1, (1 << 16) - 1)
FS_READ = FS_READ_FILE | FS_READ_DIR
FS_USE = (
    FS_READ | FS_WRITE_FILE | FS_REMOVE_DIR | FS_REMOVE_FILE | FS_MAKE_DIR | FS_MAKE_REG | FS_MAKE_SYM | FS_REFER | FS_TRUNCATE
)
NET_TCP = 3  # bind and connect, ABI 4
SCOPES = 3  # abstract unix sockets and signals, ABI 6

libc = ctypes.CDLL(None, use_errno=True)
holding_gil = ctypes.PyDLL(None, use_errno=True)  # calls through this one do not release the interpreter lock
for _library in (libc, holding_gil):
    _library.syscall.restype = ctypes.c_long


def _check(result: int, what: str) -> int:
    if result < 0:
        number = ctypes.get_errno()
        raise OSError(number, f"{what}: {os.strerror(number)}")
    return result


def _path(path: str | None) -> bytes | None:
    return None if path is None else os.fsencode(path)


def mount(source: str, target: str, kind: str | None, flags: int, data: str | None = None) -> None:
    """mount(2)."""
    result = libc.mount(_path(source), _path(target), _path(kind), ctypes.c_ulong(flags), _path(data))
    _check(result, f"mount {kind or source} on {target}")


def unshare(flags: int) -> None:
    """unshare(2)."""
    _check(libc.unshare(ctypes.c_int(flags)), "unshare")


def open_tree(path: str) -> int:
    """A detached copy of the mounts at a path, as a file descriptor."""
    flags = OPEN_TREE_CLONE | AT_RECURSIVE | os.O_CLOEXEC
    number, at, flags_ = ctypes.c_long(OPEN_TREE), ctypes.c_int(AT_FDCWD), ctypes.c_uint(flags)
    return _check(libc.syscall(number, at, _path(path), flags_), f"open_tree {path}")


def set_read_only(tree: int) -> None:
    """Make a detached tree of mounts read-only, without set-uid programs."""
    attributes = struct.pack("<QQQQ", MOUNT_ATTR_RDONLY | MOUNT_ATTR_NOSUID, 0, 0, 0)
    flags = ctypes.c_uint(AT_EMPTY_PATH | AT_RECURSIVE)
    size = ctypes.c_size_t(len(attributes))
    _check(libc.syscall(ctypes.c_long(MOUNT_SETATTR), ctypes.c_int(tree), b"", flags, attributes, size), "mount_setattr")


def move_mount(tree: int, target: str) -> None:
    """Attach a detached tree of mounts at a path."""
    number, flags = ctypes.c_long(MOVE_MOUNT), ctypes.c_uint(MOVE_MOUNT_F_EMPTY_PATH)
    result = libc.syscall(number, ctypes.c_int(tree), b"", ctypes.c_int(AT_FDCWD), _path(target), flags)
    _check(result, f"move_mount to {target}")


def no_new_privileges() -> None:
    """PR_SET_NO_NEW_PRIVS."""
    _check(libc.prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0), "no_new_privs")


def die_with_parent() -> None:
    """PR_SET_PDEATHSIG: be killed when the thread that started this process ends."""
    _check(libc.prctl(PR_SET_PDEATHSIG, 9, 0, 0, 0), "pdeathsig")


def leave_no_core() -> None:
    """PR_SET_DUMPABLE 0: no core is written of this process, whatever its limits, and no other may look into it."""
    _check(libc.prctl(PR_SET_DUMPABLE, 0, 0, 0, 0), "dumpable")


def drop_capabilities() -> None:
    """Give up every capability, effective, permitted and inheritable."""
    header = struct.pack("<Ii", 0x20080522, 0)  # _LINUX_CAPABILITY_VERSION_3
    number = ctypes.c_long(CAPSET_NUMBER[platform.machine()])
    _check(libc.syscall(number, header, bytes(24)), "capset")


def load_filter(programme: bytes) -> None:
    """Install a seccomp filter for this process."""
    buffer = ctypes.create_string_buffer(programme, len(programme))
    header = struct.pack("@HxxxxxxP", len(programme) // 8, ctypes.addressof(buffer))  # struct sock_fprog
    _check(libc.prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, header, 0, 0), "seccomp")


def landlock_abi() -> int:
    """The Landlock version of this kernel, 0 where there is none."""
    return max(0, int(libc.syscall(ctypes.c_long(LANDLOCK_CREATE), None, ctypes.c_size_t(0), ctypes.c_uint(1))))


def landlock(readable: Iterable[str], writable: Iterable[str], usable: Iterable[str]) -> int:
    """Restrict this process to reading some trees and files, writing to some devices, and using some folders. Returns the ABI.

    TCP is refused from ABI 4 on, signals and abstract sockets that leave the process from ABI 6 on.
    """
    abi = landlock_abi()
    if abi < 1:
        raise OSError("this kernel has no Landlock, or it is switched off")
    handled = FS_OF_ABI[min(abi, len(FS_OF_ABI) - 1)]
    attributes = struct.pack("<QQQ", handled, NET_TCP if abi >= 4 else 0, SCOPES if abi >= 6 else 0)
    attributes = attributes[: 24 if abi >= 6 else 16 if abi >= 4 else 8]
    size = ctypes.c_size_t(len(attributes))
    ruleset = _check(libc.syscall(ctypes.c_long(LANDLOCK_CREATE), attributes, size, ctypes.c_uint(0)), "landlock ruleset")
    try:
        rules = [*((path, FS_READ) for path in readable), *((path, FS_READ_FILE | FS_WRITE_FILE) for path in writable)]
        for path, rights in [*rules, *((path, FS_USE) for path in usable)]:
            _landlock_rule(ruleset, path, rights & handled)
        _check(libc.syscall(ctypes.c_long(LANDLOCK_RESTRICT), ctypes.c_int(ruleset), ctypes.c_uint(0)), "landlock")
    finally:
        os.close(ruleset)
    return abi


def _landlock_rule(ruleset: int, path: str, rights: int) -> None:
    with contextlib.suppress(FileNotFoundError):  # a path that is not in this sandbox needs no rule
        place = os.open(path, os.O_PATH | os.O_CLOEXEC)
        try:
            if not os.path.isdir(path):
                rights &= FS_READ_FILE | FS_WRITE_FILE | FS_TRUNCATE
            rule = struct.pack("<Qi", rights, place)
            number = ctypes.c_long(LANDLOCK_ADD)
            result = libc.syscall(number, ctypes.c_int(ruleset), ctypes.c_int(1), rule, ctypes.c_uint(0))
            _check(result, f"landlock rule for {path}")
        finally:
            os.close(place)


def thread_id_address() -> int:
    """Where the C library keeps the main thread's id, which a raw clone must renew in the child."""
    address = ctypes.c_ulong(0)
    if libc.prctl(PR_GET_TID_ADDRESS, ctypes.byref(address), 0, 0, 0) == 0 and address.value:
        return address.value
    libc.pthread_self.restype = ctypes.c_ulong  # without checkpoint support in the kernel: look for it in struct pthread
    start, wanted = libc.pthread_self(), libc.syscall(ctypes.c_long(GETTID_NUMBER[platform.machine()]))
    for offset in range(0, 2048, 4):
        if ctypes.c_int.from_address(start + offset).value == wanted:
            return int(start + offset)
    raise OSError("cannot find where the C library keeps the thread id")


def clone(flags: int, tid_address: int) -> int:
    """fork() with namespaces in one step, like os.fork(): 0 in the child, its pid in the parent.

    ``tid_address`` comes from :func:`thread_id_address`, asked for once before.
    """
    arguments = [flags | CLONE_CHILD_SETTID | CLONE_CHILD_CLEARTID | SIGCHLD, 0, 0]
    # The last two arguments of clone(2), child_tid and tls, change places between the architectures.
    arguments += [tid_address, 0] if platform.machine() == "x86_64" else [0, tid_address]
    api = ctypes.pythonapi
    api.PyOS_BeforeFork()
    pid = int(holding_gil.syscall(ctypes.c_long(CLONE_NUMBER[platform.machine()]), *map(ctypes.c_ulong, arguments)))
    number = ctypes.get_errno()
    if pid == 0:
        api.PyOS_AfterFork_Child()
        return 0
    api.PyOS_AfterFork_Parent()
    if pid < 0:
        raise OSError(number, f"clone: {os.strerror(number)}")
    return pid
