"""Vectors over the square are compared one by one: nothing is meant by moving them, and by no relabelling are they right."""

import numpy as np
import pytest

from autograder.exercise import exercise
from autograder.judge import judge


@pytest.fixture
def arrows():
    """Unit vectors over the square, all different."""

    @exercise(points=1, title="Arrows", kind="field", tolerance=1e-7)
    def arrows(u, w, a):
        """Return the arrows."""
        u, w = np.broadcast_arrays(u, w)
        v = np.stack([a + u, 2 * w, 1 - u * w], axis=-1)
        return v / np.linalg.norm(v, axis=-1, keepdims=True)

    @arrows.data
    def some(rng):
        return {"a": 0.5}

    @arrows.mistake("reversed", credit=0.5)
    def _(u, w, a):
        """You have them the other way round: where does yours point?"""
        return -arrows.reference(u, w, a)

    return arrows


def test_right_and_hardly_wrong(arrows):
    """What the tolerance allows is right; what float32 holds is close."""
    verdict = judge(arrows, lambda u, w, a: arrows.reference(u, w, a) + 5e-8)
    assert (verdict.fraction, verdict.tier) == (1.0, "identical")
    assert "field of vectors" in verdict.message
    verdict = judge(arrows, lambda u, w, a: arrows.reference(u, w, a).astype(np.float32) * np.float32(1.00001))
    assert (verdict.fraction, verdict.tier) == (0.8, "close")


def test_known_mistake_is_named(arrows):
    verdict = judge(arrows, lambda u, w, a: -arrows.reference(u, w, a))
    assert (verdict.mistake, verdict.fraction) == ("reversed", 0.5)


@pytest.mark.parametrize(
    "wrong",
    [
        lambda f: lambda u, w, a: f(w, u, a),
        lambda f: lambda u, w, a: f(1 - np.asarray(u), w, a),
        lambda f: lambda u, w, a: f(np.asarray(u) ** 2, w, a),
        lambda f: lambda u, w, a: f(u, w, a) + [1, 2, 3],
        lambda f: lambda u, w, a: 2 * f(u, w, a),
    ],
    ids=["exchanged", "flipped", "other speed", "moved", "longer"],
)
def test_no_rung_of_surfaces_is_claimed(arrows, wrong):
    """A surface would be relabelled, the same set, or moved."""
    verdict = judge(arrows, wrong(arrows.reference))
    assert (verdict.fraction, verdict.tier) == (0.0, "different")
    assert "your vector is" in verdict.message
    assert "surface" not in verdict.message
    assert verdict.figure is None


def test_wrong_length_is_told_as_a_length(arrows):
    verdict = judge(arrows, lambda u, w, a: 2 * arrows.reference(u, w, a))
    assert "Every vector is 2 times as long as it should be." in verdict.message


def test_gates_hold_for_fields_too(arrows):
    """A vector that does not exist is no number."""
    verdict = judge(arrows, lambda u, w, a: arrows.reference(u, w, a) / np.where(np.asarray(u) == 0, 0, 1)[..., None])
    assert (verdict.fraction, verdict.tier) == (0.0, "not finite")
