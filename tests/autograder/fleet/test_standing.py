"""The class as it stands, read without grading: what `directrix report` shows."""

import json
import shutil
import subprocess
import sys

import pytest

from autograder import fleet
from autograder.errors import CourseError

RIGHT = {"square": "def square(x): return x * x", "half": "def half(x): return x / 2", "why": "It is so."}


def test_the_class_as_it_stands(ordinary):
    """The marks of the grader and by hand; who handed in and is not graded is there; nothing is graded or changed."""
    course = ordinary.course()
    ordinary.hand_in("ada", {"one": RIGHT, "two": {}})
    graded = fleet.grade(course, "ps1")
    ordinary.hand_in("bob", {"one": {}, "two": {}})
    ordinary.sql("update grade set manual_score = 3.5 where cell_id = (select id from base_cell where name = 'why' limit 1)")
    tables = ordinary.tables()
    standing = fleet.standing(course, "ps1")
    assert [(one.student, one.status, one.faults) for one in standing.students] == [
        ("ada", "graded", ()),
        ("bob", "failed", ()),
    ]
    assert (standing.level, standing.available, standing.seconds) == (graded.level, graded.available, 0.0)
    then, now = ({cell.name: cell.points for cell in one.student("ada").cells} for one in (graded, standing))
    assert now == {**then, "why": 3.5}
    assert standing.student("ada").score == graded.student("ada").score + 3.5
    ran = subprocess.run(
        [sys.executable, "-m", "autograder", "report", "ps1", "--json"],
        cwd=ordinary.folder, capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stderr
    told = json.loads(ran.stdout)
    assert (told["submissions"], told["mean"]) == (2, standing.student("ada").score)
    assert "not graded" in ran.stderr
    assert f"1 graded; sandbox level {graded.level}" in ran.stderr
    assert ordinary.tables() == tables


def test_who_reads_writes_nothing(ordinary):
    """A course may lie on a disk that is closed to writing, its records left behind."""
    ordinary.hand_in("ada", {"one": RIGHT, "two": {}})
    graded = fleet.grade(ordinary.course(), "ps1").student("ada")
    shutil.rmtree(ordinary.folder / ".directrix")
    assert fleet.standing(ordinary.course(), "ps1").student("ada").score == graded.score
    assert not (ordinary.folder / ".directrix").exists()


def test_a_journal_that_is_lost_costs_the_cells_and_no_mark(ordinary):
    ordinary.hand_in("ada", {"one": RIGHT, "two": {}})
    graded = fleet.grade(ordinary.course(), "ps1")
    for entry in (ordinary.folder / ".directrix" / "graded" / "ps1").iterdir():
        entry.unlink()
    standing = fleet.standing(ordinary.course(), "ps1").student("ada")
    assert (standing.status, standing.cells, standing.score) == ("graded", (), graded.student("ada").score)


def test_an_assignment_that_is_not_there_is_named(ordinary):
    with pytest.raises(CourseError, match="ps9"):
        fleet.standing(ordinary.course(), "ps9")
