"""Bilinear, ruled and Coons surfaces: printed values, boundaries, identities, and curves that do not meet."""

import directrix as dx
import numpy as np
import pytest
from directrix.errors import CornerError, CurveError, DegenerateError, NumberError, OrderError, ShapeError
from hypothesis import given, settings
from hypothesis import strategies as st

U, W = np.linspace(0, 1, 9)[:, None], np.linspace(0, 1, 8)[None, :]
seeds = st.integers(0, 2**32 - 1)
fixed = settings(derandomize=True, max_examples=30, deadline=None)


def heights(u_of, w_of, z):
    """A curve (u, w, z) over the unit square as a plain callable of t."""
    return lambda t: np.stack([u_of(t), w_of(t), z(t)], axis=-1)


# TAMU CPSC 645, homework 3, question 3: four height curves over the unit square.
TAMU = (
    heights(lambda u: u, lambda u: 0 * u, lambda u: 3 * u**2 + 3 * u + 2),
    heights(lambda u: u, lambda u: 0 * u + 1, lambda u: 2 * u**2 - 10 * u + 28),
    heights(lambda w: 0 * w, lambda w: w, lambda w: 12 * w**2 + 14 * w + 2),
    heights(lambda w: 0 * w + 1, lambda w: w, lambda w: 12 * w + 8),
)


def four_curves(rng):
    """Random boundary curves that meet at random corners, of different degrees on opposite sides."""
    p = rng.standard_normal((2, 2, 3))
    ends = [(p[0, 0], p[1, 0]), (p[0, 1], p[1, 1]), (p[0, 0], p[0, 1]), (p[1, 0], p[1, 1])]
    return [dx.BezierCurve([a, *rng.standard_normal((int(rng.integers(1, 4)), 3)), b]) for a, b in ends]


def test_tamu_height_field():
    """The printed example: S(1/2, 1/2) = (1/2, 1/2, 12.375), exactly; from plain callables and from algebraic curves."""
    patch = dx.Coons(*TAMU)
    assert patch(0.5, 0.5).tolist() == [0.5, 0.5, 12.375]
    assert patch([[0.5]], [[0.5]]).tolist() == [[[0.5, 0.5, 12.375]]]
    np.testing.assert_allclose(patch.derivative(0.25, 0.75, 1, 1), (0, 0, -19.5), atol=1e-9)  # -13.5 - 20 + 14


@fixed
@given(seeds)
def test_coons_meets_its_four_curves(seed):
    """Both blends: the four edges of the patch are the four curves, to the last bits."""
    rng = np.random.default_rng(seed)
    c0, c1, d0, d1 = four_curves(rng)
    t = rng.random(7)
    for blend in ("linear", "cubic"):
        patch = dx.Coons(c0, c1, d0, d1, blend=blend)
        for got, curve in [(patch(t, 0), c0), (patch(t, 1), c1), (patch(0, t), d0), (patch(1, t), d1)]:
            np.testing.assert_allclose(got, curve(t), atol=1e-14)


@fixed
@given(seeds)
def test_coons_is_two_ruled_less_the_bilinear(seed):
    """The formula itself, and its derivatives, from the library's own ruled and bilinear surfaces."""
    rng = np.random.default_rng(seed)
    c0, c1, d0, d1 = four_curves(rng)
    patch, p = dx.Coons(c0, c1, d0, d1), [c0(0), c1(0), c0(1), c1(1)]
    parts = dx.Ruled(c0, c1), dx.Ruled(d0, d1).swap(), dx.Bilinear(*p)
    for nu, nw in [(0, 0), (1, 0), (0, 1), (1, 1), (2, 0), (0, 2), (2, 1), (3, 0)]:
        a, b, c = (part.derivative(U, W, nu, nw) for part in parts)
        np.testing.assert_allclose(patch.derivative(U, W, nu, nw), a + b - c, atol=1e-12)


@fixed
@given(seeds)
def test_greville_weights_make_the_discrete_net_exact(seed):
    """B-spline boundary curves: the net blended at Greville abscissae is the Coons patch; blended by index it misses it."""
    rng = np.random.default_rng(seed)
    m, k = 7, 4
    knots = np.concatenate([[0] * k, np.sort(rng.uniform(0, 1, m - k)) ** 2, [1] * k])
    greville = np.array([knots[i + 1 : i + k].mean() for i in range(m)])
    greville[-1] = 1.0
    p = rng.standard_normal((2, 2, 3))
    ends = [(p[0, 0], p[1, 0]), (p[0, 1], p[1, 1]), (p[0, 0], p[0, 1]), (p[1, 0], p[1, 1])]
    polygon = [np.array([a, *rng.standard_normal((m - 2, 3)), b]) for a, b in ends]
    patch = dx.Coons(*(dx.BSplineCurve(points, k, knots) for points in polygon))
    exact = dx.BSplinePatch(dx.coons_net(*polygon, tu=greville, tw=greville), k, k, knots, knots)
    np.testing.assert_allclose(exact(U, W), patch(U, W), atol=1e-13)
    by_index = dx.BSplinePatch(dx.coons_net(*polygon), k, k, knots, knots)
    assert np.abs(by_index(U, W) - patch(U, W)).max() > 1e-4


def test_cubic_blend_keeps_the_cross_tangent_of_the_ends():
    """Across an edge the tangent of a cubic blend lies between those of the edge's ends, by F1 and F2."""
    curves = four_curves(np.random.default_rng(1))
    patch = dx.Coons(*curves, blend="cubic")
    u = np.linspace(0, 1, 5)
    F2 = (3 * u**2 - 2 * u**3)[:, None]
    expected = (1 - F2) * curves[2].derivative(0.0) + F2 * curves[3].derivative(0.0)
    np.testing.assert_allclose(patch.derivative(u, 0, 0, 1), expected, atol=1e-13)


def test_mixed_kinds_of_curves():
    """A line, an arc, a Bezier and a B-spline curve together, as the lecture says; derivatives are analytic."""
    arc = dx.Arc((0, 0, 0), 2, 0, np.pi / 2, (0, 0, 1))
    a, b = arc(0.0), arc(1.0)
    top = dx.BezierCurve([a + [0, 0, 3], (3, 3, 5), b + [0, 0, 3]])
    side = dx.BSplineCurve([a, a + [1, 0, 1], a + [0, 1, 2], a + [0, 0, 3]], 3)
    patch = dx.Coons(arc, top, side, dx.Line(b, b + [0, 0, 3]))
    h = 1e-5
    numeric = (patch(0.4 + h, 0.7) - patch(0.4 - h, 0.7)) / (2 * h)
    np.testing.assert_allclose(patch.derivative(0.4, 0.7, 1, 0), numeric, atol=1e-9)
    assert patch.breaks()[1].tolist() == [0, 0.5, 1]


def test_coons_of_callables_differentiates_numerically_twice():
    """Plain callables: first and second derivatives to the documented accuracy, a third is refused."""
    curves = four_curves(np.random.default_rng(3))
    plain = dx.Coons(*(lambda t, c=c: c(t) for c in curves))
    exact = dx.Coons(*curves)
    np.testing.assert_allclose(plain.derivative(U, W, 1, 1), exact.derivative(U, W, 1, 1), atol=1e-9)
    np.testing.assert_allclose(plain.derivative(U, W, 2, 0), exact.derivative(U, W, 2, 0), atol=1e-6)
    with pytest.raises(OrderError, match="at most 2"):
        plain.derivative(U, W, 3, 0)


def test_moving_and_swapping():
    curves = four_curves(np.random.default_rng(4))
    T = dx.Transform.rotate((1, 2, 3), 0.7, point=(1, 1, 1))
    for form in (dx.Coons(*curves), dx.Coons(*curves, blend="cubic"), dx.Ruled(curves[0], curves[1])):
        moved = T @ form
        assert type(moved) is type(form)
        np.testing.assert_allclose(moved(U, W), T @ form(U, W), atol=1e-13)
        np.testing.assert_allclose(form.swap()(W.T, U.T), np.swapaxes(form(U, W), 0, 1), atol=1e-13)
        np.testing.assert_allclose(form.patch(0.75, 0.25, 0, 0.5)(U, W), form(0.75 - U / 2, W / 2), atol=1e-13)


def test_bilinear_exact():
    """The corners of the argument order: p01 is u = 0, w = 1. Straight in u and in w; a saddle with negative K if twisted."""
    patch = dx.Bilinear((0, 0, 0), (0, 4, 0), (4, 0, 0), (4, 4, 8))
    assert patch(0, 1).tolist() == [0, 4, 0]
    assert patch(1, 0).tolist() == [4, 0, 0]
    assert patch(0.25, 0.5).tolist() == [1, 2, 1]
    assert patch.derivative(0.25, 0.5, 1, 1).tolist() == [0, 0, 8]
    assert not patch.derivative(U, W, 2, 0).any()
    assert patch.curvature(0, 0).gaussian == pytest.approx(-(0.5**2))
    assert not patch.is_flat()
    assert dx.Bilinear((0, 0, 0), (0, 4, 0), (4, 0, 0), (7, 4, 0)).is_flat()
    assert type(patch.patch(0, 0.5, 1, 0)) is dx.Bilinear
    np.testing.assert_allclose(patch.patch(0, 0.5, 1, 0)(U, W), patch(U / 2, 1 - W), atol=1e-14)
    assert patch.swap()(1, 0).tolist() == [0, 4, 0]
    assert type(dx.Transform.translate((1, 0, 0)) @ patch) is dx.Bilinear


def test_ruled_between_circles():
    """Coaxial circles: cylinder, cone, and with one started later a hyperboloid of one sheet; as quadrics the residual is 0."""
    low, high = dx.Circle((0, 0, 0), 2, (0, 0, 1)), dx.Circle((0, 0, 3), 2, (0, 0, 1))
    np.testing.assert_allclose(dx.Ruled(low, high)(U, W), dx.Cylinder(2, 3)(U, W), atol=1e-15)
    np.testing.assert_allclose(dx.Ruled(low, dx.Circle((0, 0, 3), 1, (0, 0, 1)))(U, W), dx.Cone(2, 1, 3)(U, W), atol=1e-14)
    turned = dx.Transform.rotate("z", np.pi / 2) @ high
    waist = dx.Ruled(low, turned)(U, W).reshape(-1, 3)
    quadric = dx.Quadric.through(waist)
    assert quadric.classify().kind == "hyperboloid of one sheet"
    np.testing.assert_allclose(quadric.classify().center, (0, 0, 1.5), atol=1e-9)
    np.testing.assert_allclose(quadric.classify().radii[:2], np.sqrt(2), rtol=1e-9)


def test_coons_with_straight_opposite_edges_is_ruled():
    curves = four_curves(np.random.default_rng(8))
    d0, d1 = dx.Line(curves[0](0), curves[1](0)), dx.Line(curves[0](1), curves[1](1))
    np.testing.assert_allclose(dx.Coons(curves[0], curves[1], d0, d1)(U, W), dx.Ruled(curves[0], curves[1])(U, W), atol=1e-14)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda c0, c1, d0, d1: (c0, c1.flip(), d0.flip(), d1), "c1 and d0 run backwards"),
        (lambda c0, c1, d0, d1: (c0, c1, d0, d1.flip()), "d1 run backwards"),
        (lambda c0, c1, d0, d1: (c1, c0, d0, d1), "d0 and d1 run backwards"),
        (lambda c0, c1, d0, d1: (c0, c1, d0, dx.Line((9, 9, 9), (8, 8, 8))), r"c0\(1\) and d1\(0\) must be the same point"),
    ],
)
def test_curves_that_do_not_meet_are_named(change, message):
    """The error says which corner, how far apart, and which curve to turn round where that mends it."""
    curves = four_curves(np.random.default_rng(5))
    with pytest.raises(CornerError, match=message):
        dx.Coons(*change(*curves))


def test_c_and_d_exchanged_is_the_swapped_patch():
    """d before c is no error: it is the same surface with u and w exchanged."""
    curves = four_curves(np.random.default_rng(5))
    assert dx.Coons(*curves[2:], *curves[:2]) == dx.Coons(*curves).swap()


def test_corner_tolerance_grows_with_the_curves():
    """A gap of 1e-10 of the size passes, one of 1e-8 does not, whatever the unit of length."""
    for unit in (1e-6, 1.0, 1e6):
        lines = [
            ((0, 0, 0), (1, 0, 0)),
            ((0, 1, 0), (1, 1, 0)),
            ((0, 0, 0), (0, 1, 0)),
        ]
        c0, c1, d0 = (dx.Line(unit * np.array(a), unit * np.array(b)) for a, b in lines)
        near = dx.Line(unit * np.array((1, 0, 1e-10)), unit * np.array((1, 1, 0)))
        far = dx.Line(unit * np.array((1, 0, 1e-8)), unit * np.array((1, 1, 0)))
        dx.Coons(c0, c1, d0, near)
        with pytest.raises(CornerError, match="apart"):
            dx.Coons(c0, c1, d0, far)


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (lambda: dx.Coons(*four_curves(np.random.default_rng(5)), blend="quintic"), NumberError, "blend must be one of"),
        (lambda: dx.Coons(*four_curves(np.random.default_rng(5))[:3], lambda t: t), CurveError, "d1: a curve must return"),
        (lambda: dx.Ruled([(0, 0, 0), (1, 1, 1)], dx.Line((0, 0, 0), (1, 1, 1))), CurveError, "c0: a curve must be a callable"),
        (lambda: dx.Bilinear((0, 0, 0), (0, 0, 0), (0, 0, 0), (0, 0, 0)), DegenerateError, "all be the same point"),
        (lambda: dx.Bilinear((0, 0), (0, 1), (1, 0), (1, 1)), ShapeError, r"p00 must have shape \(3,\)"),
        (lambda: dx.coons_net(np.eye(3), np.eye(3)[:2], np.eye(3), np.eye(3)), CornerError, "same number of control points"),
        (lambda: dx.coons_net(np.eye(3), np.eye(3), np.eye(3), np.eye(3) + 1), CornerError, "boundary polygons must meet"),
    ],
)
def test_bad_input_is_named(make, error, message):
    with pytest.raises(error, match=message):
        make()
