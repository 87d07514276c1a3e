import numpy as np
import pytest

from autograder.comparison.sets import compare_sets, measured

TURN = 2 * np.pi


def as_points(f):
    return lambda p: np.stack(np.broadcast_arrays(*f(*p.T)), axis=-1)


def disc(u, w):
    return u * np.cos(TURN * w), u * np.sin(TURN * w), 0 * u


@pytest.mark.parametrize(
    ("f", "n", "measure"),
    [
        (lambda u: (np.cos(TURN * u), np.sin(TURN * u), 3 * u), 1, np.hypot(TURN, 3)),
        (disc, 2, np.pi),
        (
            lambda u, w: (np.sin(np.pi * u) * np.cos(TURN * w), np.sin(np.pi * u) * np.sin(TURN * w), np.cos(np.pi * u)),
            2,
            4 * np.pi,
        ),
        (lambda u, w: (np.cos(40 * TURN * u), np.sin(40 * TURN * u), w), 2, 40 * TURN),
        (lambda u, v, w: (2 * u, 3 * v, u * v + w), 3, 6.0),
    ],
)
def test_length_area_and_volume_are_those_of_the_formula(f, n, measure):
    assert measured(as_points(f), n).measure == pytest.approx(measure, rel=2e-3)


def test_a_fold_to_nothing_counts_as_collapsed():
    found = measured(as_points(lambda u, w: (np.minimum(u, 0.25), w, 0 * u)), 2)
    assert found.collapsed == pytest.approx(0.75, abs=0.03)


def test_two_derivatives_along_one_line_count_as_collapsed():
    """Beyond the diagonal the square is pushed onto it: neither derivative is nothing there."""

    def pushed(u, w):
        beyond = np.maximum(u + w - 1, 0) / 2
        return u - beyond, w - beyond, 0 * u

    assert measured(as_points(pushed), 2).collapsed == pytest.approx(0.5, abs=0.03)


def test_a_slow_start_is_not_collapsed():
    """Towards a pole u³ makes the first row of cells smaller than 1e-7 of the mean: small, but not nothing."""

    def ball(u, w):
        south = np.pi * (u**3 - 0.5)
        return np.cos(south) * np.cos(TURN * w), np.cos(south) * np.sin(TURN * w), np.sin(south)

    assert measured(as_points(ball), 2).collapsed == 0.0


def test_a_fold_along_a_diagonal_is_measured_twice():
    found = measured(as_points(lambda u, w: (*np.where(u + w > 1, (1 - w, 1 - u), (u, w)), 0 * u)), 2)
    assert found.measure == pytest.approx(1.0, rel=1e-9)
    crossed = measured(as_points(lambda u, w: (np.minimum(u, w), np.maximum(u, w), 0 * u)), 2)
    assert crossed.measure == pytest.approx(1.0, rel=1e-9)


def test_a_thin_map_is_not_collapsed():
    assert measured(as_points(lambda u, w: (u, 1e-3 * w, 0 * u)), 2).collapsed == 0.0


@pytest.mark.parametrize(
    ("f", "tier", "ratio"),
    [
        (lambda u, w: disc(np.sqrt(u), w), "same set", 1),
        (lambda u, w: disc(u, 3 * w), "covered", 3),
        (lambda u, w: disc(u, w / 3), "part", 1 / 3),
        (lambda u, w: disc(2 * u, w), "more", 4),
        (lambda u, w: disc(2 * u - 1, w), "covered", 2),
    ],
)
def test_a_disc_and_its_likes(f, tier, ratio):
    right, yours = measured(as_points(disc), 2), measured(as_points(f), 2)
    found = compare_sets(yours, right, 2.0)
    assert found is not None
    assert found.tier == tier
    assert found.ratio == pytest.approx(ratio, rel=5e-3)


def test_a_hole_that_no_grid_line_meets_is_seen_by_its_edge():
    """A disc with a pin hole is a part: its inner edge is tried from just inside the right disc's pole."""
    right = measured(as_points(disc), 2)
    pierced = measured(as_points(lambda u, w: disc(0.01 + 0.99 * u, w)), 2)
    found = compare_sets(pierced, right, 2.0)
    assert found is not None
    assert found.tier == "part"


def test_a_disc_lifted_by_a_hundred_thousandth_is_another_set():
    right = measured(as_points(disc), 2)
    lifted = measured(as_points(lambda u, w: (*disc(u, w)[:2], 1e-5 + 0 * u)), 2)
    assert compare_sets(lifted, right, 2.0) is None
