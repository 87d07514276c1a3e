"""Properties of curves over random data: degrees, points, knots with multiplicities, weights, angles."""

import directrix as dx
import numpy as np
from directrix.basis import spline_row
from directrix.knots import knot_vector
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

NUMBER = st.floats(-8, 8, width=32)
POINT = arrays(float, 3, elements=NUMBER)
U = np.linspace(0, 1, 9)


@st.composite
def control_points(draw, least=2, most=8):
    return draw(arrays(float, (draw(st.integers(least, most)), 3), elements=NUMBER))


@st.composite
def knots_of(draw, count):
    """An order for the count and a knot vector with random multiplicities up to the order, ends repeated or not."""
    order = draw(st.integers(1, count))
    kind = draw(st.sampled_from(["open", "uniform", "periodic", "given"]))
    if kind != "given":
        return order, kind
    inner = sorted(draw(st.lists(st.integers(1, 5), min_size=count - order, max_size=count - order)))
    if any(inner.count(knot) > order for knot in inner):
        return order, "open"
    return order, [0.0] * order + [float(knot) for knot in inner] + [6.0] * order


@st.composite
def splines(draw):
    points = draw(control_points())
    order, knots = draw(knots_of(len(points)))
    return dx.BSplineCurve(points, order, knots)


@st.composite
def moves(draw):
    move = dx.Transform.rotate(draw(POINT.filter(lambda k: np.abs(k).max() > 0.1)), draw(st.floats(-7, 7)), draw(POINT))
    return move @ dx.Transform.translate(draw(POINT)) @ dx.Transform.scale(draw(st.sampled_from([0.5, 1, -2])))


def inside_hull(points, curve_points):
    """In 13 directions no point lies beyond the outermost control point."""
    ways = np.random.default_rng(0).normal(size=(13, 3))
    return (curve_points @ ways.T <= (points @ ways.T).max(axis=0) + 1e-5 * (1 + np.abs(points).max())).all()


@given(control_points(), moves())
def test_bezier_is_affinely_invariant_and_in_its_hull(points, move):
    """Moving the points moves the curve; the curve stays within its points."""
    curve = dx.BezierCurve(points)
    assert np.allclose((move @ curve)(U), move @ curve(U), atol=1e-11)
    assert inside_hull(points, curve(U))
    assert np.array_equal(curve([0.0, 1.0]), points[[0, -1]])


@given(control_points(), st.floats(0.01, 0.99))
def test_bezier_split_is_the_same_curve(points, at):
    """Both parts, at their own speed."""
    curve = dx.BezierCurve(points)
    left, right = curve.split(at)
    assert np.allclose(left(U), curve(at * U), atol=1e-12)
    assert np.allclose(right(U), curve(np.minimum(at + (1 - at) * U, 1)), atol=1e-12)


@given(splines(), moves())
def test_spline_is_affinely_invariant_and_in_its_hull(curve, move):
    """For every order and every multiplicity of knots."""
    assert np.allclose((move @ curve)(U), move @ curve(U), atol=1e-11)
    assert inside_hull(curve.control_points, curve(U))


@given(st.integers(1, 8).flatmap(lambda count: st.tuples(st.just(count), knots_of(count))))
def test_spline_functions_partition_unity(case):
    """Not negative, sum 1, derivatives sum 0, on the closed domain of every knot vector."""
    count, (order, knots) = case
    vector = knot_vector("knots", knots, count, order)
    t = vector.stretch(np.unique(np.concatenate([U, vector.breaks()])))
    values = spline_row(vector.values, order, t)
    assert (values >= 0).all()
    assert np.allclose(values.sum(axis=-1), 1, atol=1e-14)
    slopes = spline_row(vector.values, order, t, 1)
    assert np.allclose(slopes.sum(axis=-1), 0, atol=1e-12 * (1 + np.abs(slopes).max()))


@given(control_points(3, 7), st.data())
def test_nurbs_weights_count_by_their_ratios(points, data):
    """One factor on all of them changes nothing, and equal ones make the B-spline."""
    weights = data.draw(arrays(float, len(points), elements=st.floats(0.125, 8, width=32)))
    order, knots = data.draw(knots_of(len(points)))
    curve = dx.NurbsCurve(points, weights, order, knots)
    assert np.allclose(dx.NurbsCurve(points, 4 * weights, order, knots)(U), curve(U), atol=1e-12)
    assert np.allclose(
        dx.NurbsCurve(points, 0 * weights + 2, order, knots)(U), dx.BSplineCurve(points, order, knots)(U), atol=1e-12
    )
    assert inside_hull(points, curve(U))


@given(POINT, POINT, POINT, st.floats(0.1, 10))
def test_conic_stays_in_its_triangle(p0, p1, p2, weight):
    """And its shoulder point lies on the median, weight / (1 + weight) of the way to p1."""
    conic = dx.Conic(p0, p1, p2, weight)
    assert inside_hull(np.stack([p0, p1, p2]), conic(U))
    assert np.allclose(conic(0.5), (p0 + p2) / 2 + weight / (1 + weight) * (p1 - (p0 + p2) / 2), atol=1e-12)


@given(POINT, st.floats(0.1, 9), st.floats(-7, 7), st.floats(-7, 7), POINT)
def test_arc_lies_on_its_sphere_and_in_its_plane(center, radius, start, end, normal):
    """At constant speed radius |end - start|."""
    if start == end or not normal.any():
        return
    arc = dx.Arc(center, radius, start, end, normal)
    away = arc(U) - center
    assert np.allclose(np.linalg.norm(away, axis=1), radius, rtol=1e-12)
    assert np.allclose(away @ arc.normal, 0, atol=1e-12)
    assert np.allclose(np.linalg.norm(arc.derivative(U), axis=1), radius * abs(end - start), rtol=1e-12)


@given(st.integers(2, 8).flatmap(lambda n: arrays(float, (n, 3), elements=NUMBER)))
def test_point_curve_meets_its_points(points):
    """Exactly, at its parameters."""
    curve = dx.PointCurve(points)
    assert np.array_equal(curve(curve.parameters), points)
