"""B-spline functions: the recursion of the lecture against the triangular scheme, and scipy and geomdl against both."""

import numpy as np
import pytest
from directrix.basis import (
    bernstein,
    bezier_extraction,
    cox_de_boor,
    derived,
    spline_local,
    spline_row,
    spline_span,
)
from directrix.knots import open_knots
from geomdl import helpers
from scipy.interpolate import BSpline

KNOTS = [
    (open_knots(6, 4), 4),
    (open_knots(4, 4), 4),
    (open_knots(5, 1), 1),
    (np.arange(9.0), 3),  # uniform
    (np.array([0.0, 0, 0, 1, 1, 2, 2, 2]), 3),  # a corner: k - 1 times
    (np.array([0.0, 0, 0, 1, 1, 1, 2, 2, 2]), 3),  # a gap: k times
    (np.array([-1.0, 0, 0.5, 0.5, 2, 3.25, 3.25, 4]), 3),
    (np.array([0.0, 0, 1, 5, 5, 6, 7]), 3),  # the last span of the domain [1, 5] ends at a repeated knot
]


def places(knots, order):
    """Both ends, all knots inside, and points between."""
    start, end = knots[order - 1], knots[-order]
    return np.unique(np.concatenate([np.linspace(start, end, 23), knots[(knots >= start) & (knots <= end)]]))


@pytest.mark.parametrize(("knots", "order"), KNOTS)
def test_the_fast_scheme_is_the_recursion(knots, order):
    """At every knot and between, the closed end included."""
    t = places(knots, order)
    assert np.allclose(spline_row(knots, order, t), [cox_de_boor(knots, order, x) for x in t], atol=1e-15)


@pytest.mark.parametrize(("knots", "order"), KNOTS)
def test_partition_of_unity_on_the_closed_domain(knots, order):
    """All functions are at least 0 and sum to 1; at the last knot of open knots the last one is 1."""
    values = spline_row(knots, order, places(knots, order))
    assert (values >= 0).all()
    assert np.allclose(values.sum(axis=-1), 1, atol=1e-15)


@pytest.mark.parametrize(("knots", "order"), KNOTS)
def test_scipy_has_the_same_functions_and_derivatives(knots, order):
    """An independent compiled evaluation, of growing t inside, of the domain's own side at its end."""
    t = places(knots, order)
    inside = t[t < knots[-order]]
    for derivative in range(order + 1):
        design = BSpline(knots, np.eye(len(knots) - order), order - 1)
        oracle = design(inside, nu=derivative) if derivative < order else np.zeros((len(inside), len(knots) - order))
        mine = spline_row(knots, order, inside, derivative)
        assert np.allclose(mine, oracle, atol=1e-11 * max(1.0, np.abs(oracle).max()))


def test_geomdl_has_the_same_functions():
    """A third implementation, on knots it does not rescale."""
    knots, order = open_knots(6, 4), 4
    for t in (0.0, 0.3, 1.0, 2.5, 3.0):
        span = helpers.find_span_linear(order - 1, knots.tolist(), 6, t)
        first, values = spline_local(knots, order, np.array(t))
        assert np.allclose(values, helpers.basis_function(order - 1, knots.tolist(), span, t), atol=1e-15)
        assert first == span - order + 1


def test_no_inner_knots_is_bernstein():
    """m = k: the Bezier case, with derivatives."""
    t = np.arange(9) / 8
    for derivative in range(4):
        assert np.allclose(spline_row(open_knots(4, 4), 4, t, derivative), bernstein(3, t, derivative), atol=1e-14)


def test_the_end_of_the_domain_is_closed():
    """Five public libraries had this bug: at the last knot all functions are 0."""
    assert spline_row(open_knots(6, 4), 4, np.array(3.0)).tolist() == [0, 0, 0, 0, 0, 1]
    assert cox_de_boor(open_knots(6, 4), 4, 3.0).tolist() == [0, 0, 0, 0, 0, 1]


def test_at_a_repeated_knot_the_side_of_growing_t():
    """The derivative of a corner jumps: from the right it belongs to the second piece."""
    knots = np.array([0.0, 0, 0, 1, 1, 2, 2, 2])
    left, right = spline_row(knots, 3, np.array([1 - 1e-12, 1.0]), 1)
    assert np.allclose(left, [0, -2, 2, 0, 0], atol=1e-9)
    assert right.tolist() == [0, 0, -2, 2, 0]


def test_spans_of_many_places_at_once():
    """The span is where the parameter lies, the last one closed; the shape is that of t."""
    assert spline_span(open_knots(6, 4), 4, np.array([[0.0, 0.5], [1.0, 3.0]])).tolist() == [[3, 3], [4, 5]]


def test_local_support():
    """Only k functions are not zero."""
    first, values = spline_local(open_knots(40, 4), 4, np.linspace(0, 37, 500))
    assert values.shape == (500, 4)
    assert (first >= 0).all()
    assert (first <= 36).all()


@pytest.mark.parametrize(("knots", "order"), KNOTS)
def test_bezier_pieces_are_the_spline(knots, order):
    """Bernstein functions of the place in a span, times its extraction, are the functions that are not zero there."""
    t = places(knots, order)
    span = spline_span(knots, order, t)
    inside = (t - knots[span]) / (knots[span + 1] - knots[span])
    extraction = bezier_extraction(knots, order)
    found = (bernstein(order - 1, inside)[:, None] @ extraction[span - order + 1])[:, 0]
    np.testing.assert_allclose(found, spline_local(knots, order, t)[1], atol=1e-14)
    empty = np.diff(knots)[order - 1 : len(knots) - order] == 0
    assert (extraction >= 0).all()
    np.testing.assert_allclose(extraction.sum(axis=2), np.where(empty, 0.0, 1.0)[:, None] * np.ones(order), atol=1e-14)


@pytest.mark.parametrize(("knots", "order"), [case for case in KNOTS if case[1] > 1])
def test_the_derived_spline_is_the_derivative(knots, order):
    """Its functions on its own knots, one order lower, against the derivatives of the functions."""
    points = np.random.default_rng(1).standard_normal((len(knots) - order, 2))
    t = places(knots, order)
    lower, differences = derived(knots, order, points)
    np.testing.assert_allclose(
        spline_row(lower, order - 1, t) @ differences, spline_row(knots, order, t, 1) @ points, atol=1e-12
    )
