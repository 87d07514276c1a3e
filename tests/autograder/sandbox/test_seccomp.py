"""The filter decides as its tables say, on both architectures: its instructions are run by a small interpreter here."""

import struct

import pytest

from autograder.sandbox.guest import seccomp

ALLOW, KILL = 0x7FFF0000, 0x80000000
ERRNO = {name: 0x50000 | number for name, number in {"EPERM": 1, "ENOSYS": 38, "ENOTSUP": 95, "ENOTTY": 25}.items()}


def decide(machine, number, arguments=(), architecture=None, **kind):
    """Run the programme as the kernel would."""
    code = list(struct.iter_unpack("<HBBI", seccomp.programme(machine, **kind)))
    data = struct.pack("<iIQ6Q", number, architecture or seccomp.ARCHITECTURES[machine][0], 0, *(*arguments, *[0] * 6)[:6])
    at, value = 0, 0
    while True:
        what, yes, no, k = code[at]
        at += 1
        if what == 0x20:
            value = struct.unpack_from("<I", data, k)[0]
        elif what == 0x15:
            at += yes if value == k else no
        elif what == 0x35:
            at += yes if value >= k else no
        elif what == 0x54:
            value &= k
        elif what == 0x05:
            at += k
        else:
            assert what == 0x06
            return k


@pytest.fixture(params=["x86_64", "aarch64"])
def machine(request):
    return request.param


def number(machine, name):
    column = seccomp.ARCHITECTURES[machine][1]
    return seccomp.numbers(seccomp.ALLOWED + seccomp.CONDITIONAL, column)[name]


def test_every_number_gets_the_answer_of_its_table(machine):
    column = seccomp.ARCHITECTURES[machine][1]
    allowed, xattr = (set(seccomp.numbers(table, column).values()) for table in (seccomp.ALLOWED, seccomp.XATTR))
    conditional = set(seccomp.numbers(seccomp.CONDITIONAL, column).values())
    for call in range(seccomp.NEWEST + 100):
        expected = ERRNO["EPERM"]
        if call in allowed:
            expected = ALLOW
        elif call in xattr:
            expected = ERRNO["ENOTSUP"]
        elif call > seccomp.NEWEST:
            expected = ERRNO["ENOSYS"]
        if call not in conditional:
            assert decide(machine, call) == expected, call


def test_notebooks_that_share_a_file_system_change_no_modes_there(machine):
    known = seccomp.numbers(seccomp.ALLOWED, seccomp.ARCHITECTURES[machine][1])
    refused = {name for name, call in known.items() if decide(machine, call, shared=True) != decide(machine, call)}
    assert refused == set(seccomp.MODES) & set(known)
    assert {"fchmod", "fchmodat", "utimensat"} <= refused
    assert decide(machine, known["fchmodat"], shared=True) == ERRNO["EPERM"]


@pytest.mark.parametrize(
    "name",
    ["execve", "execveat", "ptrace", "memfd_create", "unshare", "mount", "bpf", "socket", "connect", "shmget", "mknodat"],
)
def test_dangerous_calls_are_refused_by_number(name):
    """Numbers written out here, apart from the tables."""
    calls = {
        "execve": (59, 221),
        "execveat": (322, 281),
        "ptrace": (101, 117),
        "memfd_create": (319, 279),
        "unshare": (272, 97),
        "mount": (165, 40),
        "bpf": (321, 280),
        "socket": (41, 198),
        "connect": (42, 203),
        "shmget": (29, 194),
        "mknodat": (259, 33),
    }
    assert decide("x86_64", calls[name][0]) == ERRNO["EPERM"]
    assert decide("aarch64", calls[name][1]) == ERRNO["EPERM"]


@pytest.mark.parametrize("call", [57, 58])
def test_fork_and_vfork_are_refused(call):
    assert decide("x86_64", call) == ERRNO["EPERM"]


@pytest.mark.parametrize("call", [425, 426, 427, 428, 434, 438, 440, 444])
def test_newer_dangerous_calls_are_refused(machine, call):
    """io_uring, open_tree, pidfd, process_madvise, Landlock: the same numbers on every architecture."""
    assert decide(machine, call) == ERRNO["EPERM"]


def test_threads_are_allowed_and_processes_are_not(machine):
    clone = number(machine, "clone")
    thread = 0x3D0F00  # what glibc's pthread_create passes
    assert decide(machine, clone, [thread]) == ALLOW
    assert decide(machine, clone, [17]) == ERRNO["EPERM"]  # fork
    assert decide(machine, clone, [0x4111]) == ERRNO["EPERM"]  # vfork
    for namespace in (0x20000, 0x02000000, 0x04000000, 0x08000000, 0x10000000, 0x20000000, 0x40000000):
        assert decide(machine, clone, [thread | namespace]) == ERRNO["EPERM"]


def test_clone3_is_missing_so_that_the_c_library_uses_clone(machine):
    assert decide(machine, 435) == ERRNO["ENOSYS"]


def test_only_stream_pairs_of_unix_sockets(machine):
    pair = number(machine, "socketpair")
    assert decide(machine, pair, [1, 1 | 0o2000000]) == ALLOW  # SOCK_STREAM | SOCK_CLOEXEC
    assert decide(machine, pair, [1, 2]) == ERRNO["EPERM"]  # datagrams can be sent to any address
    assert decide(machine, pair, [1, 5]) == ERRNO["EPERM"]
    assert decide(machine, pair, [2, 1]) == ERRNO["EPERM"]


def test_terminal_and_limit_calls_by_their_arguments(machine):
    assert decide(machine, number(machine, "ioctl"), [0, 0x5401]) == ALLOW
    assert decide(machine, number(machine, "ioctl"), [0, 0x5412]) == ERRNO["ENOTTY"]  # TIOCSTI types into a terminal
    assert decide(machine, number(machine, "prlimit64"), [0]) == ALLOW
    assert decide(machine, number(machine, "prlimit64"), [1]) == ERRNO["EPERM"]
    for new in (1, 1 << 32, 0x7FFF_DEAD_BEEF):  # where the new limit lies
        assert decide(machine, number(machine, "prlimit64"), [0, 0, new]) == ERRNO["EPERM"]
    assert decide(machine, {"x86_64": 160, "aarch64": 164}[machine]) == ERRNO["EPERM"]  # setrlimit
    assert decide(machine, number(machine, "prctl"), [15]) == ALLOW
    assert decide(machine, number(machine, "prctl"), [4]) == ERRNO["EPERM"]  # PR_SET_DUMPABLE


def test_of_files_only_what_concerns_no_other_process(machine):
    fcntl = number(machine, "fcntl")
    for command in (0, 1, 2, 3, 4, 5, 6, 7, 1030):  # F_DUPFD to F_SETLKW, F_DUPFD_CLOEXEC
        assert decide(machine, fcntl, [0, command]) == decide(machine, fcntl, [0, command], processes=True) == ALLOW
    for command in (8, 10, 15, 1024, 1026, 1031):  # F_SETOWN, F_SETSIG, F_SETOWN_EX, F_SETLEASE, F_NOTIFY, F_SETPIPE_SZ
        assert decide(machine, fcntl, [0, command]) == ERRNO["EPERM"]
        assert decide(machine, fcntl, [0, command], processes=True) == ERRNO["EPERM"]


def test_other_architectures_are_killed():
    assert decide("x86_64", 1, architecture=0x40000003) == KILL  # 32-bit
    assert decide("x86_64", 0x40000001) == KILL  # x32
    assert decide("aarch64", 1, architecture=0x40000028) == KILL


def test_an_unknown_machine_is_named():
    with pytest.raises(ValueError, match="riscv64"):
        seccomp.programme("riscv64")
