"""The system call filter of a child: an allow-list, assembled here as BPF so that no library is needed for it.

Allowed are the calls by which a single process computes and works with files it may open anyway. Everything else fails
with EPERM: starting processes and programs (fork, vfork, clone without CLONE_THREAD, execve), memory that no limit counts
(memfd_create, System V shared memory, io_uring), other processes (ptrace, process_vm_readv, pidfd_*), sockets (but for
``socketpair`` of streams, which asyncio needs), namespaces, mounts, keys, bpf, userfaultfd, device nodes, ownership,
leases of files, signals sent by files, priorities and resource limits.
``clone3`` and calls newer than this table give ENOSYS, for which the C library has a second way. Calls of another
architecture (32-bit and x32) kill the process.

The BPF programme is a binary decision over the sorted numbers; see Documentation/userspace-api/seccomp_filter.rst of Linux.
"""

from __future__ import annotations

import errno
import platform
import struct
from collections.abc import Sequence

from autograder.sandbox.system import CLONE_NAMESPACES, CLONE_THREAD

ARCHITECTURES = {"x86_64": (0xC000003E, 0), "aarch64": (0xC00000B7, 1)}  # AUDIT_ARCH, column of the tables below
X32 = 0x40000000
NEWEST = 449  # numbers above this one are not in the tables

# name:x86_64:aarch64, "-" where an architecture has no such call
ALLOWED = """
    read:0:63 write:1:64 readv:19:65 writev:20:66 pread64:17:67 pwrite64:18:68 preadv:295:69 pwritev:296:70 preadv2:327:286
    pwritev2:328:287 open:2:- openat:257:56 openat2:437:437 close:3:57 close_range:436:436 creat:85:- stat:4:- fstat:5:80
    lstat:6:- newfstatat:262:79 statx:332:291 statfs:137:43 fstatfs:138:44 access:21:- faccessat:269:48 faccessat2:439:439
    readlink:89:- readlinkat:267:78 lseek:8:62 getdents64:217:61 getcwd:79:17 chdir:80:49 fchdir:81:50 rename:82:-
    renameat:264:38 renameat2:316:276 mkdir:83:- mkdirat:258:34 rmdir:84:- unlink:87:- unlinkat:263:35 link:86:-
    linkat:265:37 symlink:88:- symlinkat:266:36 truncate:76:45 ftruncate:77:46 fallocate:285:47 fadvise64:221:223
    chmod:90:- fchmod:91:52 fchmodat:268:53 utime:132:- utimes:235:- utimensat:280:88 futimesat:261:- umask:95:166
    fsync:74:82 fdatasync:75:83 sync_file_range:277:84 flock:73:32 dup:32:23 dup2:33:- dup3:292:24 pipe:22:-
    pipe2:293:59 sendfile:40:71 copy_file_range:326:285 mmap:9:222 mprotect:10:226 munmap:11:215 mremap:25:216 msync:26:227
    mincore:27:232 madvise:28:233 brk:12:214 membarrier:324:283 rt_sigaction:13:134 rt_sigprocmask:14:135
    rt_sigreturn:15:139 rt_sigpending:127:136 rt_sigtimedwait:128:137 rt_sigsuspend:130:133 sigaltstack:131:132 kill:62:129
    tkill:200:130 tgkill:234:131 restart_syscall:219:128 pause:34:- alarm:37:- getitimer:36:102 setitimer:38:103
    signalfd4:289:74 signalfd:282:- futex:202:98 futex_waitv:449:449 set_robust_list:273:99 get_robust_list:274:100
    set_tid_address:218:96 rseq:334:293 sched_yield:24:124 sched_getaffinity:204:123 sched_getparam:143:121
    sched_getscheduler:145:120 sched_get_priority_max:146:125 sched_get_priority_min:147:126 getpriority:140:141
    getcpu:309:168 exit:60:93 exit_group:231:94 wait4:61:260 waitid:247:95 nanosleep:35:101 clock_nanosleep:230:115
    clock_gettime:228:113 clock_getres:229:114 gettimeofday:96:169 time:201:- times:100:153 timerfd_create:283:85
    timerfd_settime:286:86 timerfd_gettime:287:87 getpid:39:172 getppid:110:173 gettid:186:178 getuid:102:174
    geteuid:107:175 getgid:104:176 getegid:108:177 getresuid:118:148 getresgid:120:150 getgroups:115:158 getpgid:121:155
    getpgrp:111:- getsid:124:156 getrlimit:97:163 getrusage:98:165 sysinfo:99:179 uname:63:160
    getrandom:318:278 capget:125:90 select:23:- pselect6:270:72 poll:7:- ppoll:271:73 epoll_create:213:-
    epoll_create1:291:20 epoll_ctl:233:21 epoll_wait:232:- epoll_pwait:281:22 epoll_pwait2:441:441 eventfd:284:-
    eventfd2:290:19 sendto:44:206 recvfrom:45:207 sendmsg:46:211 recvmsg:47:212 recvmmsg:299:243 shutdown:48:210
    getsockname:51:204 getpeername:52:205 getsockopt:55:209 setsockopt:54:208
"""
XATTR = """
    getxattr:191:8 lgetxattr:192:9 fgetxattr:193:10 setxattr:188:5 lsetxattr:189:6 fsetxattr:190:7 listxattr:194:11
    llistxattr:195:12 flistxattr:196:13 removexattr:197:14 lremovexattr:198:15 fremovexattr:199:16
"""
# Landlock does not cover these: where notebooks share a scratch folder, one could close or mark another one's.
MODES = ("chmod", "fchmod", "fchmodat", "utime", "utimes", "utimensat", "futimesat")
# What a Jupyter kernel takes beyond that: programs, sockets of its own network namespace, terminals.
PROCESSES = """
    fork:57:- vfork:58:- execve:59:221 arch_prctl:158:- connect:42:203 bind:49:200 listen:50:201 accept:43:202 accept4:288:242
    setsid:112:157 setpgid:109:154 setrlimit:160:164 chown:92:- fchown:93:55 fchownat:260:54 pidfd_open:434:434
    sched_setaffinity:203:122 sched_setscheduler:144:119 sched_setparam:142:118
"""
CONDITIONAL = "clone:56:220 socketpair:53:199 ioctl:16:29 fcntl:72:25 prctl:157:167 prlimit64:302:261 clone3:435:435"

KILL, ALLOW, ERRNO = 0x80000000, 0x7FFF0000, 0x00050000  # SECCOMP_RET_KILL_PROCESS, _ALLOW, _ERRNO
LOAD, EQUAL, AT_LEAST, AND, JUMP, RETURN = (
    0x20,
    0x15,
    0x35,
    0x54,
    0x05,
    0x06,
)  # BPF_LD|W|ABS, JMP|JEQ|K, JMP|JGE|K, ALU|AND|K, ...
NUMBER, ARCHITECTURE, ARGUMENTS = 0, 4, 16  # offsets in struct seccomp_data

CLONE_VM, CLONE_SIGHAND, CLONE_PTRACE, CLONE_VFORK = 0x100, 0x800, 0x2000, 0x4000
AF_UNIX, SOCK_STREAM, SOCK_TYPE_MASK = 1, 1, 0xF
IOCTLS = (0x5401, 0x5413, 0x541B, 0x5421, 0x5450, 0x5451)  # TCGETS, TIOCGWINSZ, FIONREAD, FIONBIO, FIONCLEX, FIOCLEX
# F_DUPFD, F_[GS]ETFD, F_[GS]ETFL, locks, F_GETOWN; locks of open files; F_DUPFD_CLOEXEC, F_GETPIPE_SZ, F_GET_SEALS. Never
# F_SETLEASE: whoever opens a leased file waits 45 seconds, and a grader's packages are files of the notebooks' own user.
FCNTLS = (0, 1, 2, 3, 4, 5, 6, 7, 9, 36, 37, 38, 1030, 1032, 1034)
PRCTLS = (15, 16, 0x53564D41)  # PR_SET_NAME, PR_GET_NAME, PR_SET_VMA
FAMILIES, AF_NETLINK, NETLINK_ROUTE = (1, 2, 10), 16, 0  # AF_UNIX, AF_INET, AF_INET6
# Terminals of their own (TCSETS*, TIOCSCTTY, TIOC[GS]PGRP, TIOCSWINSZ, TIOCNOTTY, TIOCGPTPEER, TIOCGPTN, TIOCSPTLCK); never
# TIOCSTI, which types into a terminal.
TERMINALS = (0x5402, 0x5403, 0x5404, 0x540E, 0x540F, 0x5410, 0x5414, 0x5422, 0x5441, 0x80045430, 0x40045431)
PR_SET_PDEATHSIG = 1

Instruction = tuple[int, int, int, int]
Code = list[Instruction]


def programme(machine: str | None = None, *, processes: bool = False, shared: bool = False) -> bytes:
    """The filter as an array of struct sock_filter; with ``processes`` the one for a Jupyter kernel, which may start programs.

    ``shared``: for notebooks whose folders lie in one file system (level A-), so that none may change modes or times there.

    Raises
    ------
    ValueError
        On an architecture that has no table here.
    """
    machine = machine or platform.machine()
    if machine not in ARCHITECTURES:
        raise ValueError(f"the system call filter knows {', '.join(ARCHITECTURES)}; this machine is {machine}")
    architecture, column = ARCHITECTURES[machine]
    code: Code = [(LOAD, 0, 0, ARCHITECTURE), (EQUAL, 1, 0, architecture), (RETURN, 0, 0, KILL), (LOAD, 0, 0, NUMBER)]
    if machine == "x86_64":
        code += [(AT_LEAST, 0, 1, X32), (RETURN, 0, 0, KILL)]
    code += _decide(_ranges(column, processes, shared))
    return b"".join(struct.pack("<HBBI", *instruction) for instruction in code)


def numbers(table: str, column: int) -> dict[str, int]:
    """Call numbers by name."""
    found = {}
    for entry in table.split():
        name, *by_architecture = entry.split(":")
        if by_architecture[column] != "-":
            found[name] = int(by_architecture[column])
    return found


def _ranges(column: int, processes: bool = False, shared: bool = False) -> list[tuple[int, Code]]:
    """(first number, what to do from there on), sorted; neighbours with the same answer are one range."""
    refuse: Code = [(RETURN, 0, 0, ERRNO | errno.EPERM)]
    answers = dict.fromkeys(range(NEWEST + 1), refuse)
    for table, answer in ((ALLOWED, ALLOW), (PROCESSES if processes else "", ALLOW), (XATTR, ERRNO | errno.ENOTSUP)):
        for number in numbers(table, column).values():
            answers[number] = [(RETURN, 0, 0, answer)]
    if shared:
        known = numbers(ALLOWED, column)
        answers |= {known[name]: refuse for name in MODES if name in known}
    conditions = {
        "clone": _masked(
            0, CLONE_VM | CLONE_SIGHAND | CLONE_THREAD | CLONE_NAMESPACES | CLONE_PTRACE | CLONE_VFORK,
            CLONE_VM | CLONE_SIGHAND | CLONE_THREAD,
        ),
        "socketpair": _masked(0, 0xFFFFFFFF, AF_UNIX, then=_masked(1, SOCK_TYPE_MASK, SOCK_STREAM)),
        "ioctl": _one_of(1, IOCTLS, errno.ENOTTY),
        "fcntl": _one_of(1, FCNTLS, errno.EPERM),
        "prctl": _one_of(0, PRCTLS, errno.EPERM),
        "prlimit64": _own_limits_read(),
        "clone3": [(RETURN, 0, 0, ERRNO | errno.ENOSYS)],
    }  # fmt: skip
    if processes:
        answers[numbers("socket:41:198", column)["socket"]] = _own_sockets()
        conditions["clone"] = _masked(0, CLONE_NAMESPACES | CLONE_PTRACE, 0)
        conditions["ioctl"] = _one_of(1, (*IOCTLS, *TERMINALS), errno.ENOTTY)
        conditions["prctl"] = _one_of(0, (*PRCTLS, PR_SET_PDEATHSIG), errno.EPERM)
    for name, number in numbers(CONDITIONAL, column).items():
        answers[number] = conditions[name]
    ranges: list[tuple[int, Code]] = []
    for number in sorted(answers):
        if not ranges or ranges[-1][1] != answers[number]:
            ranges.append((number, answers[number]))
    return [*ranges, (NEWEST + 1, [(RETURN, 0, 0, ERRNO | errno.ENOSYS)])]


def _decide(ranges: Sequence[tuple[int, Code]]) -> Code:
    """A balanced decision: below the middle range's first number go on, else jump over that half."""
    if len(ranges) == 1:
        return ranges[0][1]
    middle = len(ranges) // 2
    below, above = _decide(ranges[:middle]), _decide(ranges[middle:])
    return [(AT_LEAST, 0, 1, ranges[middle][0]), (JUMP, 0, 0, len(below)), *below, *above]


def _masked(argument: int, mask: int, wanted: int, then: Code | None = None) -> Code:
    """Allow (or go on with ``then``) if ``argument & mask == wanted``, else EPERM. The low half of an argument is compared."""
    return [
        (LOAD, 0, 0, ARGUMENTS + 8 * argument),
        (AND, 0, 0, mask),
        (EQUAL, 1, 0, wanted),
        (RETURN, 0, 0, ERRNO | errno.EPERM),
        *(then or [(RETURN, 0, 0, ALLOW)]),
    ]


def _own_limits_read() -> Code:
    """prlimit64(pid 0, which, no new limit, old): who lowers a limit of its own is ended by the kernel as if by the machine."""
    code: Code = []
    for half in (ARGUMENTS, ARGUMENTS + 16, ARGUMENTS + 20):  # pid, then both halves of the pointer to the new limit
        code += [(LOAD, 0, 0, half), (EQUAL, 1, 0, 0), (RETURN, 0, 0, ERRNO | errno.EPERM)]
    return [*code, (RETURN, 0, 0, ALLOW)]


def _own_sockets() -> Code:
    """socket() of the usual families, and of netlink only what lists the network's interfaces (libzmq asks for them)."""
    families = _one_of(0, FAMILIES, errno.EAFNOSUPPORT)[:-1]
    refused = (RETURN, 0, 0, ERRNO | errno.EAFNOSUPPORT)
    return [*families, (EQUAL, 1, 0, AF_NETLINK), refused, *_masked(2, 0xFFFFFFFF, NETLINK_ROUTE)]


def _one_of(argument: int, values: Sequence[int], otherwise: int) -> Code:
    code: Code = [(LOAD, 0, 0, ARGUMENTS + 8 * argument)]
    for value in values:
        code += [(EQUAL, 0, 1, value), (RETURN, 0, 0, ALLOW)]
    return [*code, (RETURN, 0, 0, ERRNO | otherwise)]
