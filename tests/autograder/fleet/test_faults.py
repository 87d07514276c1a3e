"""What goes wrong: learners' code that hangs, dies or floods; a grader that is killed; a disk that is full."""

import importlib
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from autograder import fleet
from autograder.errors import SandboxError

RIGHT = {"square": "def square(x): return x * x", "half": "def half(x): return x / 2"}
ADD = {"add": "def add(a, b): return a + b"}
BROKEN = {
    "loop": "while True: pass",
    "loop_in_function": "def square(x):\n    while True: pass",
    "exit": "import os; os._exit(0)",
    "exit_in_function": "def square(x):\n    import os; os._exit(0)",
    "hang_in_c": "def square(x): return sum(range(10**13))",
    "memory": "def square(x): return b'x' * (8 << 30)",
    "flood": "def square(x):\n    while True: print('x' * 10_000)",
    "recursion": "import sys\nsys.setrecursionlimit(10**9)\ndef square(x): return square(x)",
    "sys_exit": "import sys; sys.exit(0)",
    "syntax": "def square(x) return x",
}


def points(graded, student):
    return {cell.name: cell.points for cell in graded.student(student).cells}


def test_a_broken_answer_costs_only_itself(ordinary):
    """Nothing before it and nothing after it is lost, in this notebook or the other."""
    ordinary.configure("c.Execute.timeout = 1\n")
    for student, square in BROKEN.items():
        ordinary.hand_in(student, {"one": {**RIGHT, "square": square}, "two": ADD})
    graded = fleet.grade(ordinary.course(), "ps1")
    for student in BROKEN:
        marks = points(graded, student)
        assert (marks["test_square"], marks["test_half"], marks["test_add"]) == (0.0, 3.0, 1.0), student
    assert graded.failures == ()


@pytest.fixture
def big_class(ordinary):
    for number in range(8):
        square = RIGHT["square"] if number % 2 else "def square(x): return 4"
        ordinary.hand_in(f"s{number}", {"one": {**RIGHT, "square": square}, "two": ADD})
    return ordinary


GRADE = """
import importlib
import sys
from autograder import fleet
importlib.import_module("autograder.fleet.grade").BATCH = 1
fleet.grade(fleet.Course(sys.argv[1]), "ps1", workers=2)
"""


def test_a_grader_killed_at_any_moment_leaves_what_a_clean_run_gives(big_class, tmp_path):
    """kill -9, four times at different moments, then one run to the end: the same tables and files as without kills."""
    big_class.course().secret()
    clean = big_class.copy(tmp_path / "clean")
    fleet.grade(clean.course(), "ps1")
    for delay in (1.2, 1.6, 2.0, 2.4):
        with subprocess.Popen([sys.executable, "-c", GRADE, str(big_class.folder)], stderr=subprocess.DEVNULL) as grader:
            try:
                grader.wait(delay)
            except subprocess.TimeoutExpired:
                os.kill(grader.pid, signal.SIGKILL)
    done = fleet.grade(big_class.course(), "ps1")
    assert [student.status for student in done.students].count("failed") == 0
    assert big_class.tables() == clean.tables()
    assert big_class.autograded() == clean.autograded()
    left = list(big_class.folder.rglob("*.directrix-*"))
    assert left == []


def test_a_disk_that_is_full_is_named_and_the_next_run_mends_it(big_class, monkeypatch):
    from autograder.fleet import publish

    real = publish.stage

    def full(place, files, **options):
        if "s3" in place.parts:
            raise OSError(28, "No space left on device")
        return real(place, files, **options)

    monkeypatch.setattr(publish, "stage", full)
    graded = fleet.grade(big_class.course(), "ps1")
    assert graded.faults == ("s3: the graded notebook could not be written: No space left on device",)
    assert not (big_class.folder / "autograded/s3").exists()
    monkeypatch.undo()
    again = fleet.grade(big_class.course(), "ps1")
    assert {student.student: student.status for student in again.students}["s3"] == "graded"
    assert again.failures == ()


def test_a_fault_of_the_grader_is_no_zero_and_is_tried_again(big_class, monkeypatch):
    module = importlib.import_module("autograder.fleet.task")
    real = module.grade_one

    def fails(plan, student, submitted):
        if student == "s1":
            raise ZeroDivisionError("a bug")
        if student == "s2":
            raise SandboxError("the zygote has died")
        return real(plan, student, submitted)

    monkeypatch.setattr(module, "grade_one", fails)
    graded = fleet.grade(big_class.course(), "ps1")
    assert graded.faults == ("s1: ZeroDivisionError: a bug", "s2: the zygote has died")
    assert big_class.sql("select count(*) from submitted_assignment") == [(6,)]
    monkeypatch.undo()
    assert fleet.grade(big_class.course(), "ps1").failures == ()


def test_a_session_that_cannot_be_opened_leaves_no_mark_and_is_tried_again(big_class, monkeypatch):
    from autograder.sandbox import Sandbox

    real, here = Sandbox.open, os.getpid()

    def refuses(*args, **options):
        if os.getpid() == here:  # before any submission is read
            return real(*args, **options)
        raise SandboxError("no process for a notebook")

    with monkeypatch.context() as patch:
        patch.setattr(Sandbox, "open", refuses)
        graded = fleet.grade(big_class.course(), "ps1", students=["s1"])
    assert points(graded, "s1")["test_square"] is None
    assert "no process for a notebook" in graded.faults[0]
    again = fleet.grade(big_class.course(), "ps1", students=["s1"])
    assert again.student("s1").status == "graded"
    assert points(again, "s1")["test_square"] == 2.0


def test_what_a_killed_grader_left_beside_a_place_is_cleared(tmp_path):
    from autograder.fleet import publish

    place = tmp_path / "ada" / "A1"
    staged = publish.stage(place, {"a.txt": b"1"}, mode=0o444, groupshared=False)
    assert not place.exists()
    again = publish.stage(place, {"b/c.txt": b"2"}, mode=0o444, groupshared=False)
    assert not staged.exists()
    publish.publish(again, place)
    assert (place / "b/c.txt").read_bytes() == b"2"
    newer = publish.stage(place, {"d.txt": b"3"}, mode=0o664, groupshared=True)
    publish.publish(newer, place)
    assert [path.name for path in (tmp_path / "ada").iterdir()] == ["A1"]
    assert [path.name for path in place.iterdir()] == ["d.txt"]
    assert place.stat().st_mode & 0o2770 == 0o2770


def test_hidden_data_differ_for_every_submission_and_marks_do_not(surfaces):
    """The same right answer in two notebooks: two seeds, the same points; forged outputs and a patched numpy change nothing."""
    right = "def cylinder(u, w, r, h):\n    u, w = np.broadcast_arrays(u, w)\n    a = 2 * np.pi * u\n"
    right += "    return np.stack([r * np.cos(a), r * np.sin(a), h * w], axis=-1)"

    def forged(nb):
        for cell in nb["cells"]:
            name = cell["metadata"].get("nbgrader", {}).get("grade_id", "")
            if name == "cylinder":
                cell["source"] = right
            if name.startswith("check_"):
                cell["source"] = "27.0"
                cell["outputs"] = [{"output_type": "execute_result", "data": {"text/plain": "27.0"}, "metadata": {}}]

    surfaces.hand_in("ada", {"known-forms": {"cylinder": right}})
    surfaces.hand_in("eve", {"known-forms": forged})
    graded = fleet.grade(surfaces.course(), "A1")
    assert graded.student("ada").score == graded.student("eve").score == 4.0
    assert points(graded, "eve")["check_sphere"] == 0.0
    secret = (surfaces.folder / ".directrix/secret").read_text().strip()
    for path in surfaces.folder.rglob("*"):
        if path.is_file() and path.name != "secret":
            assert secret.encode() not in path.read_bytes(), path


@pytest.mark.parametrize("moment", ["before the files", "before the journal"])
def test_a_grader_killed_after_the_marks_of_a_second_submission_goes_on_from_there(big_class, monkeypatch, moment):
    """The old files lie beside the new marks then; the next run must not take them for what was graded."""
    from autograder.fleet import journal, publish

    fleet.grade(big_class.course(), "ps1", students=["s1"])
    big_class.hand_in("s1", {"one": {**RIGHT, "square": "def square(x): return 4"}, "two": ADD})

    def killed(*args, **options):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(*((publish, "publish", killed) if moment == "before the files" else (journal.Journal, "write", killed)))
        with pytest.raises(KeyboardInterrupt):
            fleet.grade(big_class.course(), "ps1", students=["s1"])
    graded = fleet.grade(big_class.course(), "ps1", students=["s1"]).student("s1")
    assert (graded.status, points_of(graded)["test_square"]) == ("graded", 0.0)
    assert b"return 4" in (big_class.folder / "autograded/s1/ps1/one.ipynb").read_bytes()
    assert list(big_class.folder.rglob("*.directrix-*")) == []
    assert fleet.grade(big_class.course(), "ps1", students=["s1"]).student("s1").status == "unchanged"


def points_of(student):
    return {cell.name: cell.points for cell in student.cells}


def sandboxes():
    """The bubblewraps that this process has started: other tests keep one."""
    found = set()
    for task in Path("/proc/self/task").iterdir():
        for pid in (task / "children").read_text().split():
            if Path(f"/proc/{pid}/comm").read_text().strip() == "bwrap":
                found.add(int(pid))
    return found


def test_a_sandbox_that_is_killed_is_started_again_and_the_class_is_graded(big_class):
    """The zygote is killed after the first submission: nothing is lost, and nothing is the learners' fault."""
    for number in range(8):
        slow = "import time\ntime.sleep(0.2)\ndef square(x): return x * x"
        big_class.hand_in(f"s{number}", {"one": {**RIGHT, "square": slow}, "two": ADD})
    killed, others = [], sandboxes()

    def kill(done, total, student):
        if not killed:
            (own,) = sandboxes() - others
            os.kill(own, signal.SIGKILL)
            killed.append(own)

    module = importlib.import_module("autograder.fleet.grade")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "BATCH", 1)
        graded = fleet.grade(big_class.course(), "ps1", workers=2, progress=kill)
    assert killed
    assert graded.failures == ()
    assert {student.score for student in graded.students} == {6.0}


def test_a_process_that_is_killed_from_outside_costs_no_later_cell_its_mark(big_class, monkeypatch):
    """The cell that it was running is missing then: tests that fail for want of it are no zeros, and the next run mends it."""
    from autograder.sandbox.session import Session

    real, killed = Session.run_cell, []

    def run_cell(self, source, **options):
        if "def square" in source and not killed:
            killed.append(source)
            signal.pidfd_send_signal(self._process._pidfd, signal.SIGKILL)
        return real(self, source, **options)

    big_class.hand_in("s1", {"one": RIGHT, "two": ADD})
    fleet.grade(big_class.course(), "ps1", students=["s0"])  # how test cells run is known then
    with monkeypatch.context() as patch:
        patch.setattr(Session, "run_cell", run_cell)
        graded = fleet.grade(big_class.course(), "ps1", students=["s1"], workers=1).student("s1")
    marks = points_of(graded)
    assert (marks["test_square"], marks["test_half"], marks["test_add"]) == (None, 3.0, 1.0)
    assert "killed from outside" in graded.faults[0]
    again = fleet.grade(big_class.course(), "ps1", students=["s1"])
    assert again.failures == ()
    assert points_of(again.student("s1"))["test_square"] == 2.0


def test_a_start_that_was_disturbed_leads_to_no_weaker_level(monkeypatch):
    from autograder.errors import IsolationError
    from autograder.notebook import session

    tried = []

    class Fake:
        def __init__(self, policy, level):
            tried.append(level)
            if len(tried) == 1:
                raise IsolationError("killed from outside")

    monkeypatch.setattr(session, "Sandbox", Fake)
    session._sandbox(None, None)
    assert tried == ["A", "A"]


def test_the_command_names_what_the_grader_could_not_judge_and_ends_with_1(big_class, monkeypatch, capsys):
    from autograder import cli

    module = importlib.import_module("autograder.fleet.task")
    real = module.grade_one

    def fails(plan, student, submitted):
        if student == "s1":
            raise SandboxError("no process for a notebook")
        return real(plan, student, submitted)

    command = ["grade", "ps1", "--course", str(big_class.folder)]
    monkeypatch.setattr(module, "grade_one", fails)
    assert ended(cli.main, command) == 1
    assert capsys.readouterr().err.splitlines()[-1] == "directrix: s1: no process for a notebook"
    assert big_class.sql("select count(*) from submitted_assignment where student_id = 's1'") == [(0,)]
    monkeypatch.undo()
    assert ended(cli.main, [*command, "--resume"]) == 0
    assert big_class.sql("select count(*) from submitted_assignment where student_id = 's1'") == [(1,)]


def ended(main, arguments):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", ["directrix", *arguments])
        with pytest.raises(SystemExit) as end:
            main()
    return end.value.code or 0
