"""What a Dask cluster's doors let through: who listens to the network, who joins late, whose answers are whose.

Scheduler and workers are this process's own, without TLS.
"""

import importlib
from dataclasses import replace

import distributed
import pytest

from autograder import fleet
from autograder.errors import CourseError
from autograder.fleet.connection import connected
from tests.autograder.fleet.dask_processes import IN_THIS_PROCESS, in_this_process

RIGHT = {"square": "def square(x): return x * x", "half": "def half(x): return x / 2"}


def hand_in(room, count):
    room.configure('c.Directrix.packages = ("numpy",)\n')  # starts quickly
    for number in range(count):
        room.hand_in(f"s{number:02d}", {"one": RIGHT, "two": {"add": "def add(a, b): return a + b"}})


def forged(landed):
    """Of two: the first one twice. Of one: for another student's marks, of other bytes, nothing, or what is no answer."""
    if len(landed) > 1:
        return [landed[0]] * len(landed)
    (one,) = landed
    if one.student == "s01":
        return [replace(one, outcome=replace(one.outcome, record=replace(one.outcome.record, student="s00")))]
    if one.student == "s02":
        return [replace(one, outcome=replace(one.outcome, digest="of other bytes"))]
    return {"s03": [], "s04": [one.student]}.get(one.student, landed)


def test_what_a_worker_answers_for_another_submission_is_given_to_nobody(ordinary, monkeypatch):
    """A worker is trusted, but may be broken: each is asked for again by itself, and failing that, named."""
    remote = importlib.import_module("autograder.fleet.remote")
    grade = remote.Grading.grade
    monkeypatch.setattr(remote.Grading, "grade", lambda self, batch: forged(grade(self, batch)))
    monkeypatch.setattr(importlib.import_module("autograder.fleet.cluster"), "BATCH", 2)
    hand_in(ordinary, 5)
    with in_this_process("tcp://127.0.0.1", 1, host="tcp://127.0.0.1") as address:
        graded = fleet.grade(ordinary.course(), "ps1", scheduler=address)
    assert {student.student: student.status for student in graded.students} == {
        "s00": "graded", "s01": "failed", "s02": "failed", "s03": "failed", "s04": "failed"
    }  # fmt: skip
    assert all("answered for another submission" in fault for fault in graded.faults)
    assert {name.split("/")[0] for name in ordinary.autograded()} == {"s00"}
    assert {row[0] for row in ordinary.tables()["grades"]} == {"s00"}


def test_a_scheduler_that_listens_to_the_network_is_refused_though_it_is_reached_on_the_loopback_interface():
    with in_this_process("tcp://127.0.0.1", 0) as address, connected(address) as client:
        assert client.scheduler.address == address
    with (
        in_this_process("tcp://0.0.0.0", 0) as address,
        pytest.raises(CourseError, match=r"^tcp://0\.0\.0\.0:\d+ is neither TLS.* --host 127\.0\.0\.1"),
        connected(address),
    ):
        pass


def test_a_worker_that_listens_to_the_network_grades_nothing(ordinary):
    """`dask worker tcp://127.0.0.1:8786` is known by a loopback address, and listens on all interfaces."""
    hand_in(ordinary, 1)
    with (
        in_this_process("tcp://127.0.0.1", 1) as address,
        pytest.raises(CourseError, match=r"^tcp://0\.0\.0\.0:\d+ is neither TLS nor on this machine alone"),
    ):
        fleet.grade(ordinary.course(), "ps1", scheduler=address)
    assert ordinary.autograded() == {}


def test_a_worker_that_joins_while_a_class_is_graded_and_may_not_gets_nothing(ordinary, monkeypatch):
    """Dask lets it in, though the setting up of its sandbox failed: here since it listens to the network."""
    monkeypatch.setattr(importlib.import_module("autograder.fleet.cluster"), "BATCH", 1)
    hand_in(ordinary, 12)
    joined = []

    def join(done, total, student):
        if done == 1:
            joined.append(IN_THIS_PROCESS[0].sync(start))

    async def start():
        return await distributed.Worker(address, nthreads=1, dashboard=False)

    with in_this_process("tcp://127.0.0.1", 1, host="tcp://127.0.0.1") as address:
        graded = fleet.grade(ordinary.course(), "ps1", scheduler=address, progress=join)
        (worker,) = joined
        assert worker.status.name == "running"
        assert worker.state.executed_count == 0
        IN_THIS_PROCESS[0].sync(worker.close)
    assert {student.status for student in graded.students} == {"graded"}


def test_what_some_workers_were_given_is_taken_back_if_another_one_cannot_be_used(ordinary):
    hand_in(ordinary, 1)

    async def start():
        return await distributed.Worker(address, nthreads=1, dashboard=False)

    with in_this_process("tcp://127.0.0.1", 1, host="tcp://127.0.0.1") as address:
        worker = IN_THIS_PROCESS[0].sync(start)
        with connected(address) as client:
            with pytest.raises(CourseError, match=r"^tcp://0\.0\.0\.0:\d+ is neither TLS"):
                fleet.grade(ordinary.course(), "ps1", scheduler=client)
            assert set(client.run_on_scheduler(lambda dask_scheduler: set(dask_scheduler.worker_plugins))) <= {"shuffle"}
            for held in client.run(lambda dask_worker: set(dask_worker.plugins)).values():
                assert held <= {"shuffle"}
        IN_THIS_PROCESS[0].sync(worker.close)


def test_the_pages_that_dask_shows_to_everybody_name_no_line_that_is_being_judged(ordinary, monkeypatch):
    """A scheduler's /info/call-stacks/ asks the workers where they are; nobody has to say who asks."""
    remote = importlib.import_module("autograder.fleet.remote")
    grade = remote.Grading.grade
    hand_in(ordinary, 1)
    stacks = []

    async def call_stack():
        (worker,) = IN_THIS_PROCESS[0].workers.values()
        stacks.append(str(worker.get_call_stack()))

    def hidden(self, batch):
        IN_THIS_PROCESS[0].sync(call_stack)
        return grade(self, batch)

    monkeypatch.setattr(remote.Grading, "grade", hidden)
    with in_this_process("tcp://127.0.0.1", 1, host="tcp://127.0.0.1") as address:
        assert fleet.grade(ordinary.course(), "ps1", scheduler=address).student("s00").status == "graded"
    (shown,) = stacks
    assert "in grade_batch" in shown
    assert "in hidden" not in shown
