"""Knot vectors: the course's own, the ones of scipy, and every refusal with its neighbour."""

import numpy as np
import pytest
from directrix.errors import KnotError, NumberError, OrderError, ShapeError
from directrix.knots import knot_vector, open_knots, uniform_knots


def test_open_knots_of_the_course():
    """m = 6, k = 4 has the four-fold ends and two inner knots."""
    assert open_knots(6, 4).tolist() == [0, 0, 0, 0, 1, 2, 3, 3, 3, 3]


@pytest.mark.parametrize(("m", "k"), [(m, k) for m in range(1, 9) for k in range(1, m + 1)])
def test_open_knots_by_cases(m, k):
    """Textbook cases, n = m - 1: t_i = 0 for i < k, i - k + 1 for k <= i <= n, n - k + 2 for i > n."""
    n = m - 1
    cases = [0 if i < k else i - k + 1 if i <= n else n - k + 2 for i in range(m + k)]
    assert open_knots(m, k).tolist() == cases


def test_the_domain_and_the_way_into_it():
    """u in [0, 1] is stretched onto knots[k - 1] .. knots[-k], both ends met exactly."""
    knots = knot_vector("knots", [0, 1, 2, 4, 8, 9], 3, 3)
    assert (knots.start, knots.end, knots.count, knots.degree) == (2.0, 4.0, 3, 2)
    assert knots.stretch(np.array([0, 0.25, 1])).tolist() == [2, 2.5, 4]
    assert knots.relax(np.array([2, 2.5, 4])).tolist() == [0, 0.25, 1]


def test_breaks_are_the_distinct_knots_of_the_domain():
    """Knots outside the domain do not count; repeated ones count once."""
    assert knot_vector("knots", [0, 0, 0, 1, 1, 4, 4, 4], 5, 3).breaks().tolist() == [0, 0.25, 1]
    assert knot_vector("knots", "uniform", 5, 3).breaks().tolist() == pytest.approx([0, 1 / 3, 2 / 3, 1])
    assert knot_vector("knots", [0, 0, 0, 1, 1, 4, 4, 4], 5, 3).multiplicity(1) == 2


def test_periodic_knots_wrap_the_first_points():
    """k - 1 points are used again at the end."""
    knots = knot_vector("knots", "periodic", 5, 4)
    points = np.arange(15.0).reshape(5, 3)
    assert knots.count == 8
    assert knots.extended(points).tolist() == [*points.tolist(), *points[:3].tolist()]
    assert knot_vector("knots", "open", 5, 4).extended(points) is points


@pytest.mark.parametrize(
    ("knots", "error", "message"),
    [
        ([0, 0, 1, 1], KnotError, r"knots must be 7 numbers: 4 control points \+ order 3 \(degree 2\); got shape \(4,\)"),
        (np.zeros((7, 1)), KnotError, r"got shape \(7, 1\)"),
        ([0, 0, 0, 2, 1, 3, 3], KnotError, "knots must not decrease; knot 3 is 2 and knot 4 is 1"),
        ([0, 0, 1, 1, 1, 2, 3], KnotError, r"must leave a domain: knots\[order - 1\] < knots\[-order\]; both are 1"),
        ([0, 0, 0, np.nan, 1, 1, 1], NumberError, "knots must be finite"),
        (["a"] * 7, ShapeError, "knots must be real numbers"),
        ("clamped", NumberError, "knots must be one of 'open', 'uniform', 'periodic'; got 'clamped'"),
    ],
)
def test_knots_refused(knots, error, message):
    """Four points of order 3: what each fault is told."""
    with pytest.raises(error, match=message):
        knot_vector("knots", knots, 4, 3)


@pytest.mark.parametrize(
    "knots",
    [
        [0, 0, 0, 1, 2, 2, 2], [0, 0, 0, 1, 1, 1, 2], [-3, 0, 0, 0.5, 7, 7, 9], [0, 0, 0, 0, 1, 1, 1],
        [0, 1, 1, 2, 2, 2, 2], "open", "uniform", "periodic",
    ],
)  # fmt: skip
def test_knots_accepted(knots):
    """Any sequence that does not decrease and leaves a domain: the ends need not be repeated, and may be too often."""
    assert knot_vector("knots", knots, 4, 3).order == 3


def test_functions_that_are_zero_everywhere():
    """Of order 3 with 0 four times and 5 five times: one function and then two whose support is a point."""
    knots = knot_vector("knots", [0, 0, 0, 0, 2, 5, 5, 5, 5, 5, 9, 9, 9], 10, 3)
    assert np.flatnonzero(~knots.live).tolist() == [0, 5, 6]
    assert not knots.clamped
    assert knot_vector("knots", [0, 0, 0, 2, 5, 5, 5], 4, 3).clamped


def test_clamped_is_what_begins_and_ends_with_its_domain():
    """A first knot before the domain makes a first function that does not reach into it."""
    assert not knot_vector("knots", [-1, 0, 0, 0, 1, 1, 1], 4, 3).clamped
    assert not knot_vector("knots", "periodic", 4, 3).clamped


def test_a_domain_of_no_length_is_refused():
    """Two points of order 2 with knots 0 1 1 2 have the domain [1, 1]; 0 1 2 2 has [1, 2]."""
    with pytest.raises(KnotError, match=r"must leave a domain: knots\[order - 1\] < knots\[-order\]; both are 1"):
        knot_vector("knots", [0, 1, 1, 2], 2, 2)
    assert knot_vector("knots", [0, 1, 2, 2], 2, 2).end == 2


@pytest.mark.parametrize("maker", [open_knots, uniform_knots])
@pytest.mark.parametrize(("m", "k"), [(3, 4), (3, 0), (0, 1), (3, 2.5)])
def test_orders_that_do_not_fit(maker, m, k):
    """1 <= k <= m."""
    with pytest.raises(OrderError):
        maker(m, k)
