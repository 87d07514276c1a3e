"""Verdicts go to JSON and back, and refuse what they cannot mean."""

import json

import pytest

from autograder.result import GATES, LADDER, Case, Figure, Verdict

FULL = Verdict(
    exercise="cylinder",
    outcome="partial",
    fraction=0.5,
    tier="mistake",
    message="All four corners are right.\nYou used u itself as the angle.",
    mistake="no_2pi",
    cases=(Case("generic", "mistake", 0.25, (0.5, 0.125), "(1, 2, 3)", "(1, 2, 4)"), Case("hidden", "mistake", hidden=True)),
    parts=(("right", "All four corners are right."), ("wrong", "You used u itself as the angle.")),
    figure=Figure("surface", ((0.0, 1.0), (0.0, 1.0)), [[[0.0] * 3] * 2] * 2, None, (0.5, 0.5), 2.0),
    title="Cylinder",
    symmetries=("flip_u",),
)


def test_a_verdict_comes_back_from_json_as_it_went():
    """Tuples, nested cases and the figure survive the way through strict JSON."""
    assert Verdict.from_json(FULL.to_json()) == FULL
    assert Verdict.from_dict(FULL.to_dict()) == FULL
    assert json.loads(FULL.to_json())["fraction"] == 0.5


@pytest.mark.parametrize("fraction", [-0.1, 1.1, float("nan")])
def test_a_fraction_outside_the_unit_interval_is_refused(fraction):
    """A fraction is checked where it is made, so that no mark can leave [0, points]."""
    with pytest.raises(ValueError, match=r"fraction must lie in \[0, 1\]"):
        Verdict("cylinder", "failed", fraction, "different", "")


def test_points_are_a_plain_float_within_the_points_available():
    """Marks are rounded to a millionth and clamped: 6.000000000000001 of 6 would stop nbgrader."""
    third = Verdict("cylinder", "partial", 1 / 3, "mistake", "")
    assert third.points(6) == 2.0
    assert type(third.points(6)) is float
    assert Verdict("cylinder", "passed", 1.0, "identical", "").points(6.1) == 6.1


def test_parts_of_the_message_are_found_by_name():
    """A missing part reads as nothing."""
    assert FULL.part("wrong") == "You used u itself as the angle."
    assert FULL.part("look") == ""


def test_the_ladder_starts_with_identical_and_ends_with_different():
    """Gates and ladder together are all tiers, in order."""
    assert (LADDER[0], LADDER[-1]) == ("identical", "different")
    assert not set(GATES) & set(LADDER)
