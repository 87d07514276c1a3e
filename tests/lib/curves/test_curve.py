"""What every curve must do, asked of every curve: shapes, domain, derivatives, moving, cutting."""

from itertools import pairwise

import directrix as dx
import numpy as np
import pytest
from directrix.differential import numeric_derivative

RNG = np.random.default_rng(11)
P = RNG.integers(-8, 8, (7, 3)).astype(float)
CURVES = {
    "line": dx.Line((1, 2, 3), (4, 0, -1)),
    "arc": dx.Arc((1, 0, 2), 3, 0.3, -2, (1, 2, 2)),
    "circle": dx.Circle((1, 1, 1), 2, (0, 1, 1)),
    "conic": dx.Conic((0, 0, 0), (1, 3, 0), (4, 0, 1), 0.6),
    "hermite": dx.HermiteCurve(*P[:4]),
    "point": dx.PointCurve(P[:5], [0, 0.2, 0.45, 0.7, 1]),
    "bezier": dx.BezierCurve(P[:6]),
    "bspline": dx.BSplineCurve(P, 4),
    "bspline uniform": dx.BSplineCurve(P, 3, "uniform"),
    "bspline periodic": dx.BSplineCurve(P, 4, "periodic"),
    "bspline given": dx.BSplineCurve(P, 4, [0, 0, 0, 0, 1, 1.5, 4, 5, 5, 5, 5]),
    "nurbs": dx.NurbsCurve(P, [1, 2, 0.5, 3, 1, 1, 2], 4),
    "moved": dx.Transform.rotate((1, 1, 0), 0.7) @ dx.Circle((1, 1, 1), 2),
    "segment": dx.BSplineCurve(P, 4).segment(0.9, 0.2),
}
NUMERIC = {
    "function": dx.FunctionCurve(lambda t: np.stack([np.cos(3 * t), t**2, np.exp(t)], -1)),
    "moved function": dx.Transform.scale(2) @ dx.FunctionCurve(lambda t: np.stack([np.cos(3 * t), t**2, np.exp(t)], -1)),
}
EVERY = pytest.mark.parametrize("curve", [pytest.param(curve, id=name) for name, curve in {**CURVES, **NUMERIC}.items()])
ANALYTIC = pytest.mark.parametrize("curve", [pytest.param(curve, id=name) for name, curve in CURVES.items()])


@EVERY
def test_shapes(curve):
    """u.shape + (3,), float64, scalars (3,), empty (0, 3), and always a fresh writable array."""
    for u, shape in (
        (0.5, (3,)),
        ([], (0, 3)),
        ([0.5], (1, 3)),
        (np.zeros((2, 0)), (2, 0, 3)),
        (np.full((4, 2), 0.5), (4, 2, 3)),
    ):
        for value in (curve(u), curve.derivative(u), curve.derivative(u, 2), curve.tangent(u)):
            assert value.shape == shape
            assert value.dtype == np.float64
            assert value.flags.writeable


@EVERY
def test_pointwise(curve):
    """A sample alone is the same as among others, to rounding of the sums."""
    u = np.linspace(0, 1, 13)
    assert np.allclose(curve(u), [curve(x) for x in u], rtol=0, atol=1e-14)


@EVERY
def test_parameters_just_outside_are_clamped_and_further_out_refused(curve):
    """1e-13 is rounding of the caller's, 1e-11 is not, NaN never."""
    assert np.array_equal(curve([-1e-13, 1 + 1e-13]), curve([0, 1]))
    for bad in (-1e-11, 1 + 1e-11, np.nan, np.inf):
        with pytest.raises(dx.DomainError, match=r"u must lie in \[0, 1\]"):
            curve([0.5, bad])


@ANALYTIC
@pytest.mark.parametrize("n", [1, 2, 3])
def test_derivatives_are_those_of_the_points(curve, n):
    """Each derivative against the numeric first derivative of the one before, away from knots by nature or between them."""
    breaks = curve.breaks()
    for a, b in pairwise(breaks):

        def piece(t, a=a, b=b):
            return curve.derivative(a + (b - a) * np.clip(t, 1e-13, 1 - 1e-13), n - 1)

        t = np.array([0.1, 0.5, 0.9])
        numeric = numeric_derivative(piece, t, 1) / (b - a)
        exact = curve.derivative(a + (b - a) * t, n)
        assert np.allclose(numeric, exact, atol=1e-9 * max(1.0, np.abs(exact).max(), np.abs(piece(t)).max() / (b - a)))


@EVERY
def test_the_zeroth_derivative_is_the_curve(curve):
    """So a caller may loop over orders."""
    assert np.array_equal(curve.derivative([0.2, 0.8], 0), curve([0.2, 0.8]))


@EVERY
def test_moving_commutes_with_evaluating(curve):
    """Affine invariance, for the points and for the derivatives."""
    move = dx.Transform.rotate((1, 2, 3), 0.4, (1, 0, 0)) @ dx.Transform.scale((1, 2, -0.5)) @ dx.Transform.translate((3, 2, 1))
    u = np.linspace(0, 1, 9)
    moved = move @ curve
    assert np.allclose(moved(u), move @ curve(u), atol=1e-13)
    exact = move.vectors(curve.derivative(u, 2))
    assert np.allclose(moved.derivative(u, 2), exact, atol=1e-7 * np.abs(exact).max())  # numeric second derivatives: 1e-8


@EVERY
def test_cutting_keeps_the_points(curve):
    """segment, flip and split are the same curve at other parameters; derivatives scale with the length of the part."""
    u = np.linspace(0, 1, 9)
    assert np.allclose(curve.segment(0.25, 0.75)(u), curve(0.25 + u / 2), atol=1e-14)
    assert np.allclose(curve.segment(0.25, 0.75).derivative(u[1:-1]), curve.derivative(0.25 + u[1:-1] / 2) / 2, atol=1e-10)
    assert np.allclose(curve.flip()(u), curve(1 - u), atol=1e-14)
    first, second = curve.split(0.25)
    assert np.allclose(first(u), curve(u / 4), atol=1e-14)
    assert np.allclose(second(u), curve(0.25 + 0.75 * u), atol=1e-14)


def test_a_segment_of_a_segment_is_one_segment():
    """Cutting again does not pile up."""
    curve = dx.Arc((0, 0, 0), 1, 0, 1)
    part = curve.segment(0.5, 1).segment(0, 0.5)
    assert (part.curve, part.u0, part.u1) == (curve, 0.5, 0.75)
    assert dx.BSplineCurve(P, 2).segment(0.25, 0.75).breaks().tolist() == pytest.approx([0, 1 / 6, 0.5, 5 / 6, 1])


def test_length():
    """Of a circle, of a parabola (closed form), of a polygon with breaks."""
    assert dx.Circle((0, 0, 0), 2).length() == pytest.approx(4 * np.pi, rel=1e-13)
    parabola = dx.BezierCurve([(0, 0, 0), (0.5, 0, 0), (1, 1, 0)])  # y = x^2
    assert parabola.length() == pytest.approx(np.sqrt(5) / 2 + np.arcsinh(2) / 4, rel=1e-12)
    assert dx.BSplineCurve([(0, 0, 0), (3, 4, 0), (3, 0, 0)], 2).length() == pytest.approx(9, rel=1e-14)


def test_unit_tangents():
    """Of length 1; (0, 0, 0) where the curve stands still, not NaN."""
    assert dx.Circle((0, 0, 0), 2).tangent(0.0).tolist() == [0, 1, 0]
    assert dx.BezierCurve([(0, 0, 0), (0, 0, 0), (1, 1, 0)]).tangent(0.0).tolist() == [0, 0, 0]


def test_closed_curves():
    """A periodic spline and a circle are, an arc is not."""
    assert dx.Circle((5, 5, 5), 2).is_closed()
    assert dx.BSplineCurve(P, 4, "periodic").is_closed()
    assert not dx.Arc((0, 0, 0), 1, 0, 6.28).is_closed()


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda c: c.derivative(0.5, -1), dx.OrderError, "n must be a whole number of at least 0; got -1"),
        (lambda c: c.derivative(0.5, 1.5), dx.OrderError, "got 1.5"),
        (lambda c: c.segment(0.5, 0.5), dx.DegenerateError, "u0 and u1 must differ; both are 0.5"),
        (lambda c: c.segment(0, 1.2), dx.DomainError, r"u1 must lie in \[0, 1\]; got u1 = 1.2"),
        (lambda c: c.segment([0, 1], 1), dx.ShapeError, "u0 must be one number"),
        (lambda c: c.split(1), dx.DomainError, "u must lie strictly between 0 and 1"),
        (lambda c: c(["a"]), dx.ShapeError, "u must be real numbers"),
    ],
)
def test_refused(call, error, message):
    """The tests above hold the neighbours."""
    with pytest.raises(error, match=message):
        call(dx.Line((0, 0, 0), (1, 1, 1)))
