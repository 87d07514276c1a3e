"""Each curve against what it is: exact values, other libraries, and its own refusals."""

import math

import directrix as dx
import geomdl.BSpline
import geomdl.NURBS
import numpy as np
import pytest
from directrix.basis import cox_de_boor, de_casteljau
from directrix.curves.point import chord_length
from scipy.interpolate import BSpline, CubicHermiteSpline, KroghInterpolator

U = np.arange(17) / 16
RNG = np.random.default_rng(5)
P = RNG.integers(-8, 8, (7, 3)).astype(float)


def refused(call, error, message):
    with pytest.raises(error, match=message):
        call()


def test_line_is_exact_on_dyadic_data():
    """(1 - u) start + u end, the ends met to the last bit even where end - start rounds."""
    assert dx.Line((0, 8, -4), (4, 0, 4))(0.25).tolist() == [1, 6, -2]
    odd = dx.Line((0.1, 0, 0), (0.3, 0, 1e17))
    assert odd([0.0, 1.0]).tolist() == [[0.1, 0, 0], [0.3, 0, 1e17]]
    assert odd.derivative(0.5, 2).tolist() == [0, 0, 0]


def test_line_refuses_one_point_twice():
    """A line needs a direction; a very short one is a line."""
    refused(
        lambda: dx.Line((1, 2, 3), (1, 2, 3)), dx.DegenerateError, r"start and end must be different points; both are \[1.0"
    )
    assert dx.Line((1, 2, 3), (1, 2, 3 + 1e-12)).length() > 0


def test_arc_against_its_formula():
    """Constant speed, from the projected x axis, by the right-hand rule."""
    arc = dx.Arc((1, 2, 3), 2, math.pi / 6, math.pi)
    a = math.pi / 6 + (math.pi - math.pi / 6) * U
    assert np.allclose(arc(U), np.stack([1 + 2 * np.cos(a), 2 + 2 * np.sin(a), 3 + 0 * a], -1), atol=1e-15)
    assert np.allclose(np.linalg.norm(arc.derivative(U), axis=-1), 2 * (math.pi - math.pi / 6), rtol=1e-14)


@pytest.mark.parametrize(
    ("normal", "start", "quarter"),
    [
        ((0, 0, 1), (1, 0, 0), (0, 1, 0)),
        ((0, 0, -5), (1, 0, 0), (0, -1, 0)),
        ((0, -1, 0), (1, 0, 0), (0, 0, 1)),  # the circle of the torus: in the xz-plane, rising
        ((0, 1, 0), (1, 0, 0), (0, 0, -1)),
        ((1, 0, 0), (0, 1, 0), (0, 0, 1)),  # x projects to nothing: from y
        ((-1, 0, 0), (0, 1, 0), (0, 0, -1)),
    ],
)
def test_where_a_circle_starts(normal, start, quarter):
    """In the direction of the projected x axis, else y; then round by the right-hand rule. Exactly."""
    circle = dx.Circle((0, 0, 0), 1, normal)
    assert circle([0, 0.25, 1]).tolist() == [list(start), list(quarter), list(start)]


def test_circle_lies_in_its_plane_at_its_distance():
    """For any normal."""
    for normal in RNG.normal(size=(10, 3)):
        points = dx.Circle((1, 2, 3), 4, normal)(U) - (1, 2, 3)
        assert np.allclose(np.linalg.norm(points, axis=1), 4, rtol=1e-14)
        assert np.allclose(points @ normal, 0, atol=1e-13)


def test_arc_refusals():
    """A radius of 0, a turn of nothing, a normal of nothing; the negative turn is allowed."""
    refused(lambda: dx.Arc((0, 0, 0), 0, 0, 1), dx.NumberError, "radius must be greater than 0")
    refused(lambda: dx.Circle((0, 0, 0), -1), dx.NumberError, "radius must be greater than 0; got -1")
    refused(lambda: dx.Arc((0, 0, 0), 1, 2, 2), dx.NumberError, r"start and end must be different angles; both are 2")
    refused(lambda: dx.Circle((0, 0, 0), 1, (0, 0, 0)), dx.DegenerateError, "normal must not be the zero vector")
    assert dx.Arc((0, 0, 0), 1, 0, -math.pi / 2)(1.0).tolist() == [0, -1, 0]


def test_bezier_is_de_casteljau():
    """The slow way at every place, exactly on dyadic data; ends and end tangents."""
    curve = dx.BezierCurve(P[:4])
    for u in U:
        assert curve(u).tolist() == de_casteljau(P[:4], u)[0].tolist()
    assert curve.derivative([0.0, 1.0]).tolist() == [(3 * (P[1] - P[0])).tolist(), (3 * (P[3] - P[2])).tolist()]
    assert not curve.derivative(U, 4).any()


def test_bezier_lies_in_the_hull_of_its_points():
    """Its coordinate in any direction lies between those of the points."""
    curve = dx.BezierCurve(P)
    for k in RNG.normal(size=(20, 3)):
        assert (curve(U) @ k <= (P @ k).max() + 1e-12).all()


def test_bezier_splits_into_beziers():
    """With control points of their own that join in every derivative."""
    left, right = dx.BezierCurve(P).split(0.375)
    assert isinstance(left, dx.BezierCurve)
    assert dx.join(left, right).continuity == "G1"  # each at a speed of its own
    assert np.allclose(left.derivative(1.0, 3) / 0.375**3, right.derivative(0.0, 3) / 0.625**3, rtol=1e-9)
    assert dx.BezierCurve(P).flip() == dx.BezierCurve(P[::-1])


def test_bezier_refusals():
    """One point, or points in the plane."""
    refused(lambda: dx.BezierCurve([(0, 0, 0)]), dx.ShapeError, r"points must have shape \(n, 3\) with n >= 2; got \(1, 3\)")
    refused(lambda: dx.BezierCurve([(0, 0), (1, 1)]), dx.ShapeError, "Add a column of zeros for z")


def test_hermite_against_scipy():
    """scipy's own cubic through values and slopes."""
    oracle = CubicHermiteSpline([0, 1], P[:2], P[2:4])
    curve = dx.HermiteCurve(*P[:4])
    for n in range(4):
        assert np.allclose(curve.derivative(U, n), oracle(U, nu=n), atol=1e-12)
    refused(lambda: dx.HermiteCurve(*P[:3], (1, 2)), dx.ShapeError, r"t1 must have shape \(3,\)")


def test_hermite_is_a_bezier_with_legs_of_a_third():
    """p0, p0 + t0/3, p1 - t1/3, p1."""
    p0, p1, t0, t1 = P[:4]
    assert np.allclose(dx.HermiteCurve(p0, p1, t0, t1)(U), dx.BezierCurve([p0, p0 + t0 / 3, p1 - t1 / 3, p1])(U), atol=1e-14)


@pytest.mark.parametrize("parameters", [None, [0, 0.1, 0.2, 0.5, 0.8, 0.9, 1], "chord"])
def test_point_curve_against_scipy(parameters):
    """scipy's Krogh interpolation, with derivatives; the points are met exactly."""
    curve = dx.PointCurve(P, parameters)
    oracle = KroghInterpolator(curve.parameters, P)
    assert np.array_equal(curve(curve.parameters), P)
    for n in range(3):
        exact = oracle.derivative(U, n) if n else oracle(U)
        assert np.allclose(curve.derivative(U, n), exact, rtol=1e-9, atol=1e-9 * np.abs(exact).max())


def test_point_curve_refusals():
    """Wrong parameters, and chords of no length."""
    refused(lambda: dx.PointCurve(P, [0, 1]), dx.ShapeError, r"parameters must have shape \(7,\)")
    refused(lambda: dx.PointCurve(P[:3], [0, 0.5, 0.5]), dx.NumberError, "parameters must increase from 0 to 1")
    refused(lambda: dx.PointCurve(P, "uniform"), dx.NumberError, "parameters must be one of 'chord'; got 'uniform'. Or give")
    refused(lambda: dx.PointCurve(P[[0, 1, 1]], "chord"), dx.DegenerateError, "points 1 and 2 are equal. Remove one")
    assert chord_length(np.array([[0, 0, 0], [3, 4, 0], [3, 4, 15.0]])).tolist() == [0, 0.25, 1]


KNOTS = [
    (4, "open"),
    (2, "open"),
    (7, "open"),
    (3, "uniform"),
    (4, [0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2]),
    (3, [-1, 0, 0.5, 2, 2, 3, 4, 4.5, 5, 7]),
]


@pytest.mark.parametrize(("order", "knots"), KNOTS)
def test_bspline_is_the_sum_of_the_recursion(order, knots):
    """The slow way at every place, and scipy with derivatives, the domain stretched from u to t."""
    curve = dx.BSplineCurve(P, order, knots)
    start, end = curve.knots[order - 1], curve.knots[-order]
    for u in U:
        t = (1 - u) * start + u * end
        assert np.allclose(curve(u), cox_de_boor(curve.knots, order, t) @ P, atol=1e-13)
    oracle = BSpline(curve.knots, P, order - 1)
    inside = U[:-1]
    t = start + (end - start) * inside
    for n in range(order):
        exact = oracle(t, nu=n) * (end - start) ** n
        assert np.allclose(curve.derivative(inside, n), exact, atol=1e-9 * max(1, np.abs(exact).max()))


def test_bspline_against_geomdl():
    """A third implementation; open knots on its [0, 1]."""
    theirs = geomdl.BSpline.Curve()
    theirs.degree, theirs.ctrlpts = 3, P.tolist()
    theirs.knotvector = (dx.BSplineCurve(P, 4).knots / 4).tolist()
    assert np.allclose(dx.BSplineCurve(P, 4)(U), theirs.evaluate_list(U.tolist()), atol=1e-12)


def test_bspline_moves_only_k_spans():
    """Local control: another first point leaves the end as it is, bit for bit."""
    other = P.copy()
    other[0] += 1
    a, b = dx.BSplineCurve(P, 4), dx.BSplineCurve(other, 4)
    assert np.array_equal(a(U[4:]), b(U[4:]))
    assert not np.array_equal(a(U[:4]), b(U[:4]))


def test_bspline_periodic_closes_smoothly():
    """Order 4: position, slope and curvature meet at the seam."""
    curve = dx.BSplineCurve(P, 4, "periodic")
    for n in range(3):
        start, end = curve.derivative([0.0, 1.0], n)
        assert np.allclose(start, end, atol=1e-9 * max(1, np.abs(start).max()))


def test_bspline_at_a_full_knot_takes_the_side_of_growing_u():
    """Order 3 with a knot three times: a gap; at the knot the second piece has the word."""
    points = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (5, 0, 0), (6, 0, 0), (7, 0, 0)]
    curve = dx.BSplineCurve(points, 3, [0, 0, 0, 1, 1, 1, 2, 2, 2])
    assert curve(0.5).tolist() == [5, 0, 0]
    assert np.allclose(curve(0.5 - 1e-14), [2, 0, 0], atol=1e-12)
    assert curve(1.0).tolist() == [7, 0, 0]


def test_bspline_refusals():
    """Orders and knots that do not fit; the tests above hold the neighbours."""
    refused(lambda: dx.BSplineCurve(P, 8), dx.OrderError, r"got order 8 \(degree 7\) for 7 points")
    refused(lambda: dx.BSplineCurve(P, 4, [0, 1]), dx.KnotError, "knots must be 11 numbers")
    refused(lambda: dx.BSplineCurve(P, 4, "bent"), dx.NumberError, "knots must be one of")
    refused(lambda: dx.BSplineCurve(P[:1], 1), dx.ShapeError, "with n >= 2")


WEIGHTS = [1, 2, 0.5, 3, 1, 1, 2]


def test_nurbs_against_geomdl():
    """With derivatives, which geomdl takes by its own quotient rule."""
    theirs = geomdl.NURBS.Curve()
    theirs.degree = 3
    theirs.ctrlpts, theirs.weights = P.tolist(), WEIGHTS
    theirs.knotvector = (dx.BSplineCurve(P, 4).knots / 4).tolist()
    curve = dx.NurbsCurve(P, WEIGHTS, 4)
    for u in (0.0, 0.1, 0.6, 0.99):
        oracle = np.array(theirs.derivatives(u, order=3))
        for n in range(4):
            assert np.allclose(curve.derivative(u, n), oracle[n], rtol=1e-9, atol=1e-9)


def test_nurbs_of_equal_weights_is_the_bspline():
    """And one factor on all weights changes nothing."""
    plain = dx.BSplineCurve(P, 4)(U)
    assert np.allclose(dx.NurbsCurve(P, np.full(7, 3.0), 4)(U), plain, atol=1e-14)
    assert np.allclose(dx.NurbsCurve(P, WEIGHTS, 4)(U), dx.NurbsCurve(P, 7 * np.array(WEIGHTS), 4)(U), atol=1e-14)


def test_nurbs_quarter_circle():
    """Weights 1, sqrt(1/2), 1 give a circle exactly, not at constant speed: 21.6 degrees at a quarter."""
    quarter = dx.NurbsCurve([(1, 0, 0), (1, 1, 0), (0, 1, 0)], [1, math.sqrt(0.5), 1], 3)
    assert np.allclose(np.linalg.norm(quarter(U), axis=1), 1, rtol=1e-15)
    x, y, _ = quarter(0.25)
    assert math.degrees(math.atan2(y, x)) == pytest.approx(21.60, abs=0.005)


def test_nurbs_refusals():
    """Weights that are missing, zero or negative."""
    refused(lambda: dx.NurbsCurve(P, [1, 2], 4), dx.ShapeError, r"weights must have shape \(7,\)")
    refused(lambda: dx.NurbsCurve(P, [1, 2, 0, 1, 1, 1, 1], 4), dx.WeightError, r"weights\[2\] is 0")
    assert np.allclose(dx.NurbsCurve(P, [1, 2, 1e-70, 1, 1, 1, 1], 4)(1.0), P[-1])


@pytest.mark.parametrize(("weight", "kind"), [(0.5, "ellipse"), (1, "parabola"), (2, "hyperbola")])
def test_conic_lies_on_a_conic_of_its_kind(weight, kind):
    """Six samples determine the conic; the sign of the discriminant tells its kind, and other samples lie on it."""
    conic = dx.Conic((0, 0, 0), (1, 2, 0), (3, 0.5, 0), weight)
    x, y, _ = conic(np.linspace(0, 1, 12)).T
    rows = np.stack([x * x, x * y, y * y, x, y, np.ones(12)], -1)
    a, b, c, *_ = np.linalg.svd(rows)[2][-1]
    assert np.linalg.svd(rows)[1][-1] < 1e-14
    assert conic.kind == kind
    assert (
        np.sign(round((b * b - 4 * a * c) / (a * a + b * b + c * c), 9)) == {"ellipse": -1, "parabola": 0, "hyperbola": 1}[kind]
    )


def test_conic_is_a_nurbs_and_refuses_weight_zero():
    """The same numbers through the other form."""
    points = [(0, 0, 0), (1, 2, 0), (3, 0.5, 1)]
    assert np.allclose(dx.Conic(*points, 0.7)(U), dx.NurbsCurve(points, [1, 0.7, 1], 3)(U), atol=1e-15)
    refused(lambda: dx.Conic(*points, 0), dx.WeightError, r"weight must be greater than 0; got 0\.")


def test_function_curve_takes_any_vectorised_callable():
    """Lists, float32 and functions of flat arrays only; it is always asked with one axis."""
    shapes = []

    def parabola(t):
        shapes.append(t.shape)
        return np.array([t, t**2, 0 * t]).T.astype(np.float32)

    assert dx.FunctionCurve(parabola)(np.full((2, 5), 0.5)).shape == (2, 5, 3)
    assert {len(shape) for shape in shapes} == {1}
    assert dx.FunctionCurve(lambda t: [[x, 0, 0] for x in t])(0.5).tolist() == [0.5, 0, 0]


def test_function_curve_derivatives():
    """First and second, against the formula, the ends included; a third is refused with a reason."""
    curve = dx.FunctionCurve(lambda t: np.stack([np.exp(t), np.cos(2 * t), t**3], -1))
    assert np.allclose(curve.derivative(U), np.stack([np.exp(U), -2 * np.sin(2 * U), 3 * U**2], -1), atol=1e-10)
    assert np.allclose(curve.derivative(U, 2), np.stack([np.exp(U), -4 * np.cos(2 * U), 6 * U], -1), atol=2e-7)
    refused(
        lambda: curve.derivative(0.5, 3),
        dx.OrderError,
        "n must be at most 2 here; got 3. Its derivatives are taken numerically",
    )


@pytest.mark.parametrize(
    ("f", "message"),
    [
        (
            lambda t: np.array([math.cos(t), 0, 0]),
            "a curve must accept an array of parameters; for 3 parameters it raised TypeError",
        ),
        (lambda t: np.stack([t, t], -1), r"for u of shape \(3,\) that is \(3, 3\); got \(3, 2\)"),
        (lambda t: np.array([1.0, 0, 0]), r"got \(3,\)"),
        (lambda t: np.stack([t, 1 / (t - 0.375), t], -1), "finite on|RuntimeWarning"),
        (lambda t: np.stack([t, np.where(t == 0.375, np.nan, t), t], -1), r"at u = 0.375 it gave \[0.375, nan, 0.375\]"),
        (lambda t: None, r"got \(\)"),
        (lambda t: "points", "could not convert string to float"),
        ([(0, 0, 0), (1, 1, 1)], r"got \[\(0, 0, 0\), \(1, 1, 1\)\]; for points use BezierCurve"),
        (3, "a curve must be a callable"),
    ],
)
def test_function_curve_refusals(f, message):
    """Found when the curve is made, not when it is used."""
    refused(lambda: dx.FunctionCurve(f), dx.CurveError, message)


def test_the_callable_may_write_into_its_argument():
    """It gets a copy; the caller's parameters stay."""

    def greedy(t):
        t *= 2
        return np.stack([t, t, t], -1)

    u = np.array([0.25, 0.5])
    assert dx.FunctionCurve(greedy)(u)[:, 0].tolist() == [0.5, 1]
    assert u.tolist() == [0.25, 0.5]
