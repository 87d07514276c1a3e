"""Worker processes: what they share, what they must not, and what happens when one is killed."""

import fcntl
import itertools
import os
import signal
import subprocess
import sys
import time

import pytest

from autograder import fleet
from autograder.fleet.workers import TRIES, Crew, Lost

RIGHT = {"square": "def square(x): return x * x", "half": "def half(x): return x / 2"}


def test_every_task_is_done_once_by_several_processes():
    with Crew(lambda task, number: (task * task, os.getpid()), 3) as crew:
        done = dict(pair for pair in crew.each(range(40)) if pair is not None)
    assert {task: square for task, (square, _) in done.items()} == {task: task * task for task in range(40)}
    assert len({pid for _, pid in done.values()}) == 3
    assert os.getpid() not in {pid for _, pid in done.values()}


def test_the_tasks_of_a_killed_worker_are_done_by_another(tmp_path):
    """Each task but the last is done by the first process that has it; that one is killed in the middle of it."""

    def work(task, number):
        if task == 5 and not (tmp_path / "killed").exists():
            (tmp_path / "killed").touch()
            os.kill(os.getpid(), signal.SIGKILL)
        return task + 100

    with Crew(work, 2) as crew:
        done = dict(pair for pair in crew.each(range(20)) if pair is not None)
    assert done == {task: task + 100 for task in range(20)}


def test_a_task_that_ends_every_worker_is_given_up_alone(tmp_path):
    def work(task, number):
        if task == 3:
            (tmp_path / str(os.getpid())).touch()
            os.kill(os.getpid(), signal.SIGKILL)
        return task

    with Crew(work, 2) as crew:
        done = dict(pair for pair in crew.each(range(8)) if pair is not None)
    assert isinstance(done.pop(3), Lost)
    assert done == {task: task for task in range(8) if task != 3}
    assert len(list(tmp_path.iterdir())) == TRIES


def test_a_crew_that_waits_says_so():
    with Crew(lambda task, number: time.sleep(0.5), 1) as crew:
        assert next(crew.each([1], patience=0.05)) is None


def test_closing_names_what_was_not_finished():
    with Crew(lambda task, number: time.sleep(60), 1) as crew:
        assert next(crew.each([1, 2, 3], patience=0.05)) is None
    assert crew.unfinished == [1, 2]


def test_a_task_that_was_handed_over_is_finished():
    """Its taker may stop there, by an error of its own: the task is neither unfinished nor given the next one's answer."""
    with Crew(lambda task, number: task * task, 1) as crew:
        assert next(crew.each([2, 3, 4])) == (2, 4)
        assert [pair for pair in crew.each([5]) if pair is not None] == [(3, 9), (5, 25)]
        assert next(crew.each([6])) == (6, 36)
    assert crew.unfinished == []


def test_what_a_lost_worker_had_is_unfinished_where_nobody_takes_it_up():
    """The third worker that 9 ends has 3 as well."""
    with Crew(lambda task, number: os._exit(1) if task == 9 else task, 1) as crew:
        taken = list(itertools.islice(crew.each([9, 1, 2, 3]), 3))
        assert [(task, type(result)) for task, result in taken] == [(1, int), (2, int), (9, Lost)]
    assert crew.unfinished == [3]


def test_a_worker_holds_neither_locks_nor_files_of_its_parent(tmp_path):
    """The lock of the course lives as long as any process has it open: a worker must not."""
    path = tmp_path / "lock"
    with path.open("a") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        crew = Crew(lambda task, number: os.readlink(f"/proc/self/fd/{task}"), 1)
        assert next(crew.each([file.fileno()])) == (file.fileno(), os.devnull)
    with crew, path.open("a") as again:
        fcntl.flock(again, fcntl.LOCK_EX | fcntl.LOCK_NB)  # raises if the worker still held it


PARENT = """
import os, sys, time
from autograder.fleet.workers import Crew
crew = Crew(lambda task, number: os.write(1, b"%d\\n" % os.getpid()) and time.sleep(60), 2)
for _ in crew.each([1, 2], 0.1): pass
"""


def test_workers_end_with_their_parent():
    with subprocess.Popen([sys.executable, "-c", PARENT], stdout=subprocess.PIPE, text=True) as parent:
        pids = [int(parent.stdout.readline()) for _ in range(2)]
        parent.kill()
    deadline = time.monotonic() + 10
    while any(os.path.exists(f"/proc/{pid}") and _running(pid) for pid in pids):
        assert time.monotonic() < deadline
        time.sleep(0.02)


def _running(pid):
    try:
        with open(f"/proc/{pid}/stat") as file:
            return file.read().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


@pytest.mark.parametrize("kills", [1, 3])
def test_a_class_loses_nothing_with_a_killed_worker(ordinary, monkeypatch, tmp_path, kills):
    """A worker is killed in the middle of s1: once, and it is graded by another; always, and s1 alone is named."""
    import importlib

    module = importlib.import_module("autograder.fleet.task")
    real = module.grade_one

    def killed(plan, student, submitted):
        if student == "s1" and len(list(tmp_path.glob("kill-*"))) < kills:
            (tmp_path / f"kill-{os.getpid()}").touch()
            os.kill(os.getpid(), signal.SIGKILL)
        return real(plan, student, submitted)

    monkeypatch.setattr(module, "grade_one", killed)
    for number in range(4):
        ordinary.hand_in(f"s{number}", {"one": RIGHT})
    graded = fleet.grade(ordinary.course(), "ps1", workers=2)
    statuses = {student.student: student.status for student in graded.students}
    assert statuses == {f"s{n}": "failed" if (n, kills) == (1, TRIES) else "graded" for n in range(4)}
    assert {student.score for student in graded.students if student.status == "graded"} == {5.0}
    assert len(graded.faults) == (kills == TRIES)
    assert list(ordinary.folder.rglob("*.directrix-*")) == []
