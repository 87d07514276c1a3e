"""The sum of what notebooks may take fits the machine."""

import logging

import pytest

from autograder import fleet
from autograder.fleet import capacity
from autograder.fleet.capacity import LEAST, OWN, MiB, fit

GiB = 1024 * MiB


@pytest.mark.parametrize("free", [64 * GiB, 5 * GiB, 3 * GiB, 2 * GiB, OWN + GiB, GiB, OWN + LEAST])
@pytest.mark.parametrize("processes", [1, 2])
def test_all_limits_together_are_never_more_than_what_is_free(free, processes):
    found = fit(4, GiB, free, processes=processes)
    assert 1 <= found.workers <= 4
    assert found.workers * (processes * found.memory + OWN) <= free or (found.workers, found.memory) == (1, LEAST)
    assert bool(found.note) == ((found.workers, found.memory) != (4, GiB))


def test_fewer_workers_go_before_a_lower_limit():
    assert fit(4, GiB, 4 * (GiB + OWN)) == capacity.Fit(4, GiB)
    assert fit(4, GiB, 4 * (GiB + OWN) - 1).workers == 3
    assert fit(4, GiB, 4 * (GiB + OWN) - 1).memory == GiB
    tight = fit(4, GiB, GiB)
    assert (tight.workers, tight.memory) == (1, GiB - OWN)


def test_what_is_free_is_read_from_this_machine(tmp_path, monkeypatch):
    alone = capacity.available()
    assert 0 < alone < 2**50
    (tmp_path / "max").write_text(str(3 * MiB))
    (tmp_path / "used").write_text(str(MiB))
    monkeypatch.setattr(capacity, "CGROUPS", ((str(tmp_path / "max"), str(tmp_path / "used")), ("/no/such", "/file")))
    assert capacity.available() == 2 * MiB
    (tmp_path / "max").write_text("max")
    assert capacity.available() > MiB


def test_a_small_machine_grades_with_a_lower_limit_and_says_so(ordinary, monkeypatch, caplog):
    """Half a GiB is free: 300 MiB are more than a notebook may take there, and the message names a limit of 256."""
    monkeypatch.setattr(capacity, "available", lambda: 512 * MiB)
    ordinary.hand_in("ada", {"one": {"square": "x = bytes(300 << 20)\ndef square(x): return x * x"}})
    with caplog.at_level(logging.WARNING):
        graded = fleet.grade(ordinary.course(), "ps1", workers=4)
    assert "one at a time" in caplog.text
    assert next(cell.points for cell in graded.student("ada").cells if cell.name == "test_square") == 0.0
