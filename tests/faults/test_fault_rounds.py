"""A small campaign of faults in every run of the tests; `python tests/faults/fault_rounds.py` runs the large one."""

import subprocess
import sys
from pathlib import Path
from typing import ClassVar

import pytest

from tests.autograder.postgres_server import programs
from tests.faults import fault_rounds
from tests.faults.faults import FAULTS

SCRIPT = Path(fault_rounds.__file__)


def run(*arguments):
    """In a process of its own: it forks graders, which must not inherit what other tests have started."""
    return subprocess.run([sys.executable, str(SCRIPT), *arguments], capture_output=True, text=True, timeout=600)


def test_a_class_comes_through_faults_of_each_kind():
    count = len(FAULTS) - 1  # without the database server
    done = run("--faults", str(count), "--backend", "sqlite", "--seed", "5")
    assert done.returncode == 0, done.stdout[-5000:] + done.stderr[-3000:]
    lines = [line for line in done.stdout.splitlines() if line.startswith("  ")]
    assert len(lines) == count
    hit = {line[2:36].strip(): int(line[36:40]) for line in lines}
    assert sum(hit.values()) >= count // 3  # the others came too late: moments are random and machines differ


def test_a_class_in_postgresql_comes_through_a_few():
    if programs() is None:
        pytest.skip("no PostgreSQL found: install the package `postgresql` to run this test")
    done = run("--faults", "2", "--backend", "postgres", "--seed", "2")
    assert done.returncode == 0, done.stdout[-5000:] + done.stderr[-3000:]


def test_the_campaign_sees_what_it_looks_for(tmp_path):
    """A changed file, a missing one, a mark from nowhere, a lost or invented manual mark, a doubled row."""

    class Reference:  # as fault_rounds.Reference
        grades = [{("s00", "one", "test_square", "GradeCell"): (2.0, None, None, 0)}] * 2
        comments = [{}] * 2
        files = [{"s00/ps1/one.ipynb": b"{}", "s00/ps1/data.csv": b"1"}] * 2

    class Room:
        folder = tmp_path
        files: ClassVar = {"s00/ps1/one.ipynb": b"{}", "s00/ps1/data.csv": b"1"}
        grade = ("s00", "one", "test_square", "GradeCell", 2.0, None, None, 0)
        times = 1

        def autograded(self):
            return self.files

        def tables(self):
            return {"grades": [self.grade] * self.times, "comments": []}

    looked = fault_rounds.Round.__new__(fault_rounds.Round)
    looked.reference, looked.room, looked.manual, looked.turn = Reference, Room(), {}, dict.fromkeys(fault_rounds.CLASS, 0)
    looked._whole()
    changes = {
        "is nothing that a clean run writes": {"files": {"s00/ps1/one.ipynb": b"{"}},
        "is not whole": {"files": {"s00/ps1/one.ipynb": b"{}"}},
        "which no clean run gives": {"grade": (*Room.grade[:4], 1.0, None, None, 0)},
        "was marked by hand": {"grade": (*Room.grade[:4], 2.0, 1.0, None, 0)},
        "two grades of": {"times": 2},
    }
    for said, change in changes.items():
        looked.room = type("Changed", (Room,), change)()
        with pytest.raises(fault_rounds.Differs, match=said):
            looked._whole()
