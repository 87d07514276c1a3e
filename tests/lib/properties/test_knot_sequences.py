"""Any non-decreasing sequence of knots: outside the domain, at its ends and inside, knots as often as they like.

A knot more than k = order times makes functions whose support is one point. They are zero everywhere, so their control points
move nothing, and a form is what it is without them: that is the oracle here, beside the Cox-de Boor recursion with 0/0 = 0.
"""

from itertools import pairwise

import directrix as dx
import numpy as np
import pytest
from directrix import export
from directrix.basis import cox_de_boor, spline_row
from directrix.errors import KnotError
from directrix.knots import knot_vector
from directrix.surfaces.spline import de_boor_point
from hypothesis import given, settings
from hypothesis import strategies as st

T = np.unique([0, 1, *np.linspace(0, 1, 9), 1 / 7, 2 / 7, 3 / 7])  # with the knots of the strategy where they are sevenths
U, W = T[:, None], T[None, ::2]
ATOL = 1e-10  # nets of size 1, knots a seventh apart and blossoms of degree 3 at most


@st.composite
def sequences(draw, highest=4):
    """An order and any knots that leave a domain: runs of equal knots, of any length, anywhere."""
    order = draw(st.integers(1, highest))
    knots = np.sort(draw(st.lists(st.integers(0, 7), min_size=2 * order + (order == 1), max_size=18)))
    if len(knots) < order + max(order, 2) or knots[order - 1] >= knots[-order]:
        knots = np.repeat([0, 7], order + 1)
    return order, knots.astype(float)


def points_for(order, knots, seed=5):
    """Random points, one for each function."""
    return np.random.default_rng([seed, order, len(knots)]).standard_normal((len(knots) - order, 3))


def without_the_dead(order, knots, points):
    """Knots and points less those of each function that is zero everywhere, one at a time."""
    while (dead := np.flatnonzero(knots[order:] == knots[: len(points)])).size:
        knots, points = np.delete(knots, dead[0]), np.delete(points, dead[0], axis=0)
    return knots, points


@given(sequences())
def test_functions_sum_to_one_on_every_span(case):
    """None negative, none that is dead above zero, slopes summing to nothing; and the recursion says the same."""
    order, knots = case
    vector = knot_vector("knots", knots, len(knots) - order, order)
    t = vector.stretch(np.unique([*T, *vector.breaks()]))
    values = spline_row(knots, order, t)
    assert (values >= 0).all()
    np.testing.assert_allclose(values.sum(axis=-1), 1, atol=1e-14)
    assert not values[:, ~vector.live].any()
    slopes = spline_row(knots, order, t, 1)
    np.testing.assert_allclose(slopes.sum(axis=-1), 0, atol=1e-12 * (1 + np.abs(slopes).max()))
    np.testing.assert_allclose(values, [cox_de_boor(knots, order, one) for one in t], atol=1e-13)


@given(sequences(), st.integers(0, 3))
def test_a_dead_point_moves_nothing(case, n):
    """Curve, rational curve and all derivatives are those without the dead points, and their places do not matter."""
    order, knots = case
    points = points_for(order, knots)
    fewer, kept = without_the_dead(order, knots, points)
    junk = np.where(knot_vector("knots", knots, len(points), order).live[:, None], points, 1e6)
    weights = np.linspace(1, 2, len(points))
    of_kept = weights[knot_vector("knots", knots, len(points), order).live]
    if len(kept) > 1:
        np.testing.assert_array_equal(
            dx.BSplineCurve(junk, order, knots).derivative(T, n), dx.BSplineCurve(kept, order, fewer).derivative(T, n)
        )
        np.testing.assert_array_equal(
            dx.NurbsCurve(junk, weights, order, knots).derivative(T, n),
            dx.NurbsCurve(kept, of_kept, order, fewer).derivative(T, n),
        )


@given(sequences(3), sequences(3), st.booleans())
def test_patches_by_grid_points_and_recursion(case_u, case_w, rational):
    """A patch on two such sequences: the grid, scattered points, and the sum over the whole net."""
    (k, knots_u), (order_w, knots_w) = case_u, case_w
    net = np.random.default_rng(7).standard_normal((len(knots_u) - k, len(knots_w) - order_w, 3))
    weights = np.random.default_rng(8).uniform(0.5, 2, net.shape[:2])
    patch = (
        dx.NurbsPatch(net, weights, k, order_w, knots_u, knots_w)
        if rational
        else dx.BSplinePatch(net, k, order_w, knots_u, knots_w)
    )
    grid = patch(U, W)
    np.testing.assert_allclose(grid, patch(*np.broadcast_arrays(U, W)), atol=ATOL)
    for i, j in ((0, 0), (3, 2), (-1, -1), (0, -1)):
        np.testing.assert_allclose(grid[i, j], de_boor_point(patch, U[i, 0], W[0, j]), atol=ATOL)
    for order in ((1, 0), (0, 1), (1, 1)):
        np.testing.assert_allclose(
            patch.derivative(U, W, *order), patch.derivative(*np.broadcast_arrays(U, W), *order), atol=1e-6
        )
    assert np.isfinite(patch.normal(U, W)).all()


@given(sequences(), st.floats(0.1, 0.9))
def test_conversions_leave_the_dead_out_and_the_form_where_it_is(case, at):
    """B-spline, NURBS, elevated, cut, split into Bezier pieces, with a knot more, and as text: the same curve."""
    order, knots = case
    curve = dx.BSplineCurve(points_for(order, knots), order, knots)
    expected = curve(T)
    for same in (dx.to_bspline(curve), dx.to_nurbs(curve)):
        np.testing.assert_allclose(same(T), expected, atol=ATOL)
        assert same.knot_vector.clamped
    np.testing.assert_allclose(dx.elevate(curve)(T), expected, atol=ATOL)
    pieces = dx.split_bezier(curve)
    if order > 1:
        assert len(pieces) == len(curve.breaks()) - 1
    for piece, (a, b) in zip(pieces, pairwise(dx.to_bspline(curve).breaks()), strict=True):
        inner = np.linspace(0.125, 0.875, 5)
        np.testing.assert_allclose(piece(inner), curve(a + (b - a) * inner), atol=ATOL)
    if not np.isclose(at, dx.to_bspline(curve).breaks(), atol=1e-9).any():
        np.testing.assert_allclose(dx.insert_knot(curve, at)(T), expected, atol=ATOL)
    assert export.loads(export.dumps(curve)) == [curve]


@settings(max_examples=20)
@given(sequences(3), st.booleans())
def test_patches_and_solids_are_converted(case, rational):
    """The same for a patch along either parameter, and for a solid, which to_bezier and to_nurbs take as well."""
    order, knots = case
    m = len(knots) - order
    rng = np.random.default_rng([9, m])
    net, weights = rng.standard_normal((m, 2, 3)), rng.uniform(0.5, 2, (m, 2))
    patch = dx.NurbsPatch(net, weights, order, 2, knots) if rational else dx.BSplinePatch(net, order, 2, knots)
    for form in (patch, patch.swap()):
        np.testing.assert_allclose(dx.to_nurbs(form)(U, W), form(U, W), atol=ATOL)
        np.testing.assert_allclose(dx.elevate(form)(U, W), form(U, W), atol=ATOL)
        np.testing.assert_allclose(dx.to_nurbs(form.patch(0.9, 0.2, 0.1, 0.8))(0.5, 0.5), form(0.55, 0.45), atol=ATOL)
    net, weights = rng.standard_normal((m, 2, 2, 3)), rng.uniform(0.5, 2, (m, 2, 2))
    solid = dx.NurbsHyperpatch(net, weights, order, 2, 2, knots) if rational else dx.BSplineHyperpatch(net, order, 2, 2, knots)
    grid = U[..., None], W[..., None], np.array([0, 0.3, 1.0])
    np.testing.assert_allclose(solid(*grid), solid(*np.broadcast_arrays(*grid)), atol=ATOL)
    nurbs = dx.to_nurbs(solid)
    np.testing.assert_allclose(nurbs(*grid), solid(*grid), atol=ATOL)
    assert all(vector.clamped for vector in nurbs.knot_vectors)
    for face, other in zip(solid.faces(), nurbs.faces(), strict=True):
        np.testing.assert_allclose(face(T[1:-1], 0.4), other(T[1:-1], 0.4), atol=ATOL)


@pytest.mark.parametrize("kind", ["uniform", "periodic", [0, 0, 1, 2, 3, 4], [-1, 0, 0, 2, 2, 2]])
def test_a_solid_of_one_piece_becomes_its_bezier_form(kind):
    """Knots that are not clamped: the Bezier net is not the given one."""
    net = np.random.default_rng(10).standard_normal((3, 3, 2, 3))
    solid = dx.BSplineHyperpatch(net, 3, 3, 2, kind)
    if len(solid.breaks()[0]) > 2:
        with pytest.raises(dx.ConversionError, match="polynomial pieces"):
            dx.to_bezier(solid)
        return
    places = np.random.default_rng(11).random((3, 20))
    np.testing.assert_allclose(dx.to_bezier(solid)(*places), solid(*places), atol=1e-13)


def test_superfluous_copies_are_removed_first():
    """Of a knot five times in order 3 the first two copies cost nothing; the third would close a tear."""
    points = points_for(3, np.arange(11.0))
    curve = dx.BSplineCurve(points, 3, [0, 0, 0, 1, 1, 1, 1, 1, 2, 2, 2])
    for times in (1, 2):
        fewer = dx.remove_knot(curve, 0.5, times=times)
        assert fewer.knots.tolist() == [0, 0, 0, 1, 1, 1, 2, 2, 2]
        np.testing.assert_allclose(fewer(T), curve(T), atol=1e-15)
    with pytest.raises(KnotError, match="cannot be removed"):
        dx.remove_knot(curve, 0.5, times=3)
    smooth = dx.insert_knot(dx.BezierCurve(points[:3]), 0.5, times=3)
    crowded = dx.BSplineCurve(
        np.insert(smooth.control_points, 3, 99, axis=0), 3, np.insert(smooth.knots, 3, 0.5)
    )  # the same parabola with a knot four times
    np.testing.assert_allclose(dx.remove_knot(crowded, 0.5, times=4).control_points, points[:3], atol=1e-12)


def test_step_holds_none_of_the_dead(tmp_path):
    """OpenCASCADE wants no knot above its degree: what is torn becomes two faces, and the dead rows are left out."""
    pytest.importorskip("OCP", reason="OpenCASCADE is not installed: uv sync --group oracles")
    net = np.array([[(x, y, x * x) for y in (0, 1)] for x in (9, 0, 1, 2, 7, 7, 3, 4, 5, 9)], dtype=float)
    patch = dx.BSplinePatch(net, 3, 2, [0, 0, 0, 0, 1, 1, 1, 1, 1, 2, 2, 2, 2])
    left, right = export.read(export.write(tmp_path / "crowded.step", patch))
    np.testing.assert_allclose(left(T[:-1], 0.25), patch(T[:-1] / 2, 0.25), atol=1e-12)
    np.testing.assert_allclose(left(1, 0.25), (2, 0.25, 4), atol=1e-12)  # the row before the tear
    np.testing.assert_allclose(right(T, 0.25), patch(0.5 + T / 2, 0.25), atol=1e-12)
