"""Marks do not depend on load: computing time is a limit, time by the clock is none that decides a mark."""

import pytest

from autograder import fleet
from autograder.sandbox import Limits

ADD = {"add": "def add(a, b): return a + b"}
BURNS = "def square(x):\n    while True: pass"
SLEEPS = "import time\ndef square(x):\n    time.sleep(60)\n    return x * x"


@pytest.fixture
def hasty(monkeypatch):
    """Two seconds of computing and one more by the clock, as on a machine whose processors are taken."""
    monkeypatch.setattr(Limits, "wall", lambda self, cpu: 1.0)


def marks(graded, student):
    return {cell.name: (cell.points, cell.look) for cell in graded.student(student).cells}


def test_burning_is_a_zero_and_sleeping_is_none(ordinary, hasty, monkeypatch):
    """Alone in the end, the code that sleeps is stopped again: a person looks, and the cells beside it have their marks."""
    ordinary.configure("c.Execute.timeout = 0.5\n")
    ordinary.hand_in("burns", {"one": {"square": BURNS, "half": "def half(x): return x / 2"}, "two": ADD})
    ordinary.hand_in("sleeps", {"one": {"square": SLEEPS, "half": "def half(x): return x / 2"}, "two": ADD})
    graded = fleet.grade(ordinary.course(), "ps1", workers=2)
    assert marks(graded, "burns")["test_square"] == (0.0, False)
    assert marks(graded, "sleeps")["test_square"] == (None, True)
    for student in ("burns", "sleeps"):
        assert marks(graded, student)["test_half"] == (3.0, False)
        assert marks(graded, student)["test_add"] == (1.0, False)
    assert graded.failures == ()
    assert [student.status for student in fleet.grade(ordinary.course(), "ps1").students] == ["unchanged", "unchanged"]


def test_what_was_only_too_slow_once_is_graded_alone(ordinary, tmp_path, monkeypatch):
    """The first run is stopped by the clock; the second, alone, has the time that it needs, and full marks."""
    import importlib

    module = importlib.import_module("autograder.fleet.task")
    real = module.grade_one
    seen = tmp_path / "seen"

    def grade_one(plan, student, submitted):
        with seen.open("a") as file:
            file.write(f"{student}\n")
        if student == "slow":
            Limits.wall = lambda self, cpu: 1.0 if seen.read_text().count("slow") == 1 else 30.0
        return real(plan, student, submitted)

    monkeypatch.setattr(module, "grade_one", grade_one)
    monkeypatch.setattr(Limits, "wall", Limits.wall)  # put back afterwards, whoever changed it
    slow = "import time\ndef square(x):\n    time.sleep(1.2)\n    return x * x"
    ordinary.hand_in("slow", {"one": {"square": slow}})
    ordinary.hand_in("quick", {"one": {"square": "def square(x): return x * x"}})
    graded = fleet.grade(ordinary.course(), "ps1", workers=2)
    assert marks(graded, "slow")["test_square"] == (2.0, False)
    assert seen.read_text().split().count("slow") == 2
    assert seen.read_text().split().count("quick") == 1


def test_what_fails_because_an_earlier_cell_was_stopped_by_the_clock_is_no_zero(ordinary, hasty):
    ordinary.hand_in("late", {"one": {"square": "import time; time.sleep(60)\ndef square(x): return x * x"}})
    graded = fleet.grade(ordinary.course(), "ps1")
    assert marks(graded, "late")["test_square"] == (None, True)
    note = next(cell.note for cell in graded.student("late").cells if cell.name == "test_square")
    assert "earlier cell" in note


def test_an_exercise_that_waits_could_not_be_judged(surfaces, hasty):
    waits = "import time\ndef cylinder(u, w, r, h):\n    time.sleep(60)\n"
    loops = "def sphere(u, w, r):\n    raise ValueError('not yet')\n"
    surfaces.hand_in("ada", {"known-forms": {"cylinder": waits, "sphere": loops}})
    graded = fleet.grade(surfaces.course(), "A1")
    cells = {cell.exercise: cell for cell in graded.student("ada").cells if cell.exercise}
    assert (cells["cylinder"].outcome, cells["cylinder"].points, cells["cylinder"].look) == ("could not judge", None, True)
