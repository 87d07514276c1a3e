"""B-spline and NURBS patches: printed values, the recursion, and three other libraries."""

import json
from pathlib import Path

import directrix as dx
import geomdl.NURBS
import numpy as np
import pytest
from directrix.errors import KnotError, NumberError, OrderError, ShapeError, WeightError
from directrix.knots import open_knots
from directrix.surfaces.spline import de_boor_point
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import NdBSpline

PRINTED = json.loads(Path(__file__).with_name("syllabus_data.json").read_text())
P65, H65 = np.array(PRINTED["P65"], dtype=float), np.array(PRINTED["h65"], dtype=float)
ALL_ORDERS = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (2, 1)]
seeds = st.integers(0, 2**32 - 1)
fixed = settings(derandomize=True, max_examples=40, deadline=None)


def random_knots(rng, count, order):
    """Non-decreasing knots with multiplicities, clamped or not, on some domain of their own."""
    for _ in range(50):
        kind = rng.integers(4)
        if kind == 0:
            return str(rng.choice(["open", "uniform", "periodic"])) if order > 1 else "open"
        inner = np.sort(rng.integers(1, 7, count - order)) / 8 if kind < 3 else np.sort(rng.random(count - order))
        ends = [0.0] * order, [1.0] * order
        if kind == 2:
            ends = -np.sort(rng.random(order))[::-1], 1 + np.sort(rng.random(order))
        knots = 3 * np.concatenate([ends[0], inner, ends[1]]) - 1
        if np.unique(knots, return_counts=True)[1].max() <= order and (np.diff(knots) >= 0).all():
            return knots
    return "open"


def random_patch(rng, *, rational=True, knots=True):
    m, n = (int(x) for x in rng.integers(2, 9, 2))
    k, l = int(rng.integers(1, m + 1)), int(rng.integers(1, n + 1))  # noqa: E741
    net = rng.standard_normal((m, n, 3))
    given_knots = (random_knots(rng, m, k), random_knots(rng, n, l)) if knots else ("open", "open")
    if rational:
        return dx.NurbsPatch(net, rng.uniform(0.25, 4, (m, n)), k, l, *given_knots)
    return dx.BSplinePatch(net, k, l, *given_knots)


def test_the_nurbs_book_example():
    """Piegl & Tiller, The NURBS Book, example 4.3: S(5/2, 1) = (2, 98/27, 68/27).

    Degrees 2 and 2 on knots (0,0,0,1,2,3,4,4,5,5,5) and (0,0,0,1,2,3,3,3); the 3 x 3 homogeneous points that count are printed.
    """
    homogeneous = np.ones((8, 5, 4))
    homogeneous[2:5, 1:4] = [
        [(0, 2, 4, 1), (0, 6, 4, 2), (0, 2, 0, 1)],
        [(4, 6, 8, 2), (12, 24, 12, 6), (4, 6, 0, 2)],
        [(4, 2, 4, 1), (8, 6, 4, 2), (4, 2, 0, 1)],
    ]
    net, weights = homogeneous[..., :3] / homogeneous[..., 3:], homogeneous[..., 3]
    patch = dx.NurbsPatch(net, weights, 3, 3, [0, 0, 0, 1, 2, 3, 4, 4, 5, 5, 5], [0, 0, 0, 1, 2, 3, 3, 3])
    np.testing.assert_allclose(patch(0.5, 1 / 3), (2, 98 / 27, 68 / 27), rtol=1e-15)
    np.testing.assert_allclose(patch([0.5], [1 / 3]), [(2, 98 / 27, 68 / 27)], rtol=1e-15)
    np.testing.assert_allclose(de_boor_point(patch, 0.5, 1 / 3), (2, 98 / 27, 68 / 27), rtol=1e-15)


@pytest.mark.parametrize(
    ("patch", "u", "w", "expected"),
    [
        (dx.BSplinePatch(P65, 4, 3), 0.5, 0.5, (7.23046875, 7.90234375, -0.04296875)),
        (dx.BSplinePatch(P65, 4, 3), 0.25, 0.75, (3.99633789, 10.3331299, 1.21105957)),
        (dx.BSplinePatch(P65, 4, 3), 1, 1, (17, 16, -2)),
        (dx.NurbsPatch(P65, H65, 4, 3), 0.5, 0.5, (5.97987928, 8.21529175, 0.169014085)),
        (dx.NurbsPatch(P65, H65, 4, 3), 0.25, 0.75, (3.88360329, 10.1342646, 1.39815288)),
    ],
)
def test_course_values(patch, u, w, expected):
    """The course's printed values, by all three ways: one point, a grid, scattered points."""
    for got in (patch(u, w), patch([[u], [0]], [[w, 1, 0]])[0, 0], patch([u, 0, 1], [w, 0, 1])[0], de_boor_point(patch, u, w)):
        np.testing.assert_allclose(got, expected, rtol=1e-8, atol=1e-8)


def test_exact_at_dyadic_parameters():
    """Whole points and dyadic parameters of a quadratic B-spline: nothing is rounded."""
    patch = dx.BSplinePatch(P65[:4, :4], 3, 3)
    assert patch(0.5, 0.5).tolist() == P65[1:3, 1:3].mean(axis=(0, 1)).tolist()
    assert patch([[0], [1]], [[0, 1]]).tolist() == P65[:4:3, :4:3].tolist()


@fixed
@given(seeds)
def test_against_the_recursion(seed):
    """Random orders, knots with multiplicities, clamped or not, periodic: grid and scattered path against Cox-de Boor."""
    rng = np.random.default_rng(seed)
    patch = random_patch(rng, rational=bool(rng.integers(2)))
    u = np.concatenate([[0.0, 1.0], rng.integers(0, 9, 3) / 8, rng.random(2)])
    w = rng.permutation(np.concatenate([[0.0, 1.0], rng.integers(0, 9, 3) / 8, rng.random(2)]))
    slow = np.array([[de_boor_point(patch, a, b) for b in w] for a in u])
    np.testing.assert_allclose(patch(u[:, None], w[None]), slow, atol=1e-11)
    np.testing.assert_allclose(patch(*np.meshgrid(u, w, indexing="ij")), slow, atol=1e-11)
    np.testing.assert_allclose(patch(u[0], w[1]), slow[0, 1], atol=1e-11)


@fixed
@given(seeds)
def test_derivatives_of_both_paths_agree(seed):
    """Every derivative on the grid path equals the one at scattered points, at knots and ends too."""
    rng = np.random.default_rng(seed)
    patch = random_patch(rng, rational=bool(rng.integers(2)))
    u, w = (np.concatenate([[0.0, 1.0, 0.5], rng.random(3)]) for _ in range(2))
    for nu, nw in ALL_ORDERS:
        grid = patch.derivative(u[:, None], w[None], nu, nw)
        scattered = patch.derivative(*np.meshgrid(u, w, indexing="ij"), nu, nw)
        np.testing.assert_allclose(scattered, grid, atol=1e-9 * (1 + np.abs(grid).max()))


@fixed
@given(seeds)
def test_derivatives_against_geomdl(seed):
    """Derivatives by u and w of rational patches, with the factor of the knots' own domain, which geomdl rescales away."""
    rng = np.random.default_rng(seed)
    m, n = (int(x) for x in rng.integers(4, 8, 2))
    k, l = int(rng.integers(2, 5)), int(rng.integers(2, 5))  # noqa: E741
    net, weights = rng.standard_normal((m, n, 3)), rng.uniform(0.5, 2, (m, n))
    patch = dx.NurbsPatch(net, weights, k, l)
    peer = geomdl.NURBS.Surface()
    peer.degree_u, peer.degree_v = k - 1, l - 1
    peer.set_ctrlpts(np.concatenate([net * weights[..., None], weights[..., None]], axis=2).reshape(-1, 4).tolist(), m, n)
    peer.knotvector_u, peer.knotvector_v = open_knots(m, k).tolist(), open_knots(n, l).tolist()
    u, w = (float(x) for x in rng.random(2))
    found = peer.derivatives(u, w, 2)
    for nu, nw in [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]:
        np.testing.assert_allclose(patch.derivative(u, w, nu, nw), found[nu][nw], rtol=1e-9, atol=1e-9)


@fixed
@given(seeds)
def test_against_scipy(seed):
    """Random rational patches on given knots, against scipy's B-spline in homogeneous coordinates."""
    rng = np.random.default_rng(seed)
    m, n, k, l = 7, 6, 4, 3  # noqa: E741
    knots_u, knots_w = (np.concatenate([[0] * o, np.sort(rng.random(c - o)), [1] * o]) for c, o in ((m, k), (n, l)))
    net, weights = rng.standard_normal((m, n, 3)), rng.uniform(0.5, 2, (m, n))
    patch = dx.NurbsPatch(net, weights, k, l, knots_u, knots_w)
    lifted = np.concatenate([net * weights[..., None], weights[..., None]], axis=2)
    u, w = rng.random((2, 6))
    plain = NdBSpline((knots_u, knots_w), lifted, (k - 1, l - 1))(np.stack([u, w], axis=-1))
    np.testing.assert_allclose(patch(u, w), plain[:, :3] / plain[:, 3:], atol=1e-12)


@fixed
@given(seeds)
def test_invariants(seed):
    """Affine maps commute; a factor of all weights changes nothing; equal weights are the B-spline; the net's box holds all."""
    rng = np.random.default_rng(seed)
    patch = random_patch(rng)
    u, w = rng.random((9, 1)), rng.random((1, 8))
    T = dx.Transform.of(rng.standard_normal((3, 3)), rng.standard_normal(3))
    np.testing.assert_allclose((T @ patch)(u, w), T @ patch(u, w), atol=1e-12)
    knots = patch.knot_vector_u, patch.knot_vector_w
    given_knots = ["periodic" if v.wrap else v.values for v in knots]
    scaled = dx.NurbsPatch(patch.control_net, 7 * patch.weights, patch.k, patch.l, *given_knots)
    np.testing.assert_allclose(scaled(u, w), patch(u, w), atol=1e-13)
    plain = dx.BSplinePatch(patch.control_net, patch.k, patch.l, *given_knots)
    ones = dx.NurbsPatch(patch.control_net, np.full(patch.weights.shape, 3.0), patch.k, patch.l, *given_knots)
    np.testing.assert_allclose(ones(u, w), plain(u, w), atol=1e-13)
    assert (patch(u, w) <= patch.control_net.max(axis=(0, 1)) + 1e-12).all()
    np.testing.assert_allclose(patch.swap()(w.T, u.T), np.swapaxes(patch(u, w), 0, 1), atol=1e-12)


@fixed
@given(seeds)
def test_parts_are_exact(seed):
    """A part, run forwards or backwards, is a patch of its own kind on clamped knots, over the same points."""
    rng = np.random.default_rng(seed)
    patch = random_patch(rng, rational=bool(rng.integers(2)))
    u0, u1, w0, w1 = rng.random(4)
    part = patch.patch(u0, u1, w0, w1)
    assert type(part) is type(patch)
    u, w = rng.random((9, 1)), rng.random((1, 8))
    inner = patch(u0 + (u1 - u0) * u, w0 + (w1 - w0) * w)
    np.testing.assert_allclose(part(u, w), inner, atol=1e-8)
    np.testing.assert_allclose(patch.flip_u().flip_w()(u, w), patch(1 - u, 1 - w), atol=1e-8)


def test_bezier_is_the_case_without_inner_knots():
    """k = m and l = n: the Bezier patch of the same net."""
    u, w = np.linspace(0, 1, 7)[:, None], np.linspace(0, 1, 6)[None]
    np.testing.assert_allclose(dx.BSplinePatch(P65, 6, 5)(u, w), dx.BezierPatch(P65)(u, w), atol=1e-13)


def test_local_control():
    """Moving P[0, 0] moves nothing outside its k x l spans, and moves the corner itself with it."""
    moved = P65.copy()
    moved[0, 0] += 1
    before, after = dx.BSplinePatch(P65, 4, 3), dx.BSplinePatch(moved, 4, 3)
    u, w = np.linspace(0, 1, 13)[:, None], np.linspace(0, 1, 13)[None]
    change = np.abs(after(u, w) - before(u, w)).max(axis=-1)
    assert change[0, 0] == 1
    assert not change[(u >= 1 / 3) | (w >= 1 / 3)].any()


def test_own_domain_is_stretched():
    """Knots 2 x + 5 give the same surface as knots x, and the same derivatives by u."""
    knots = open_knots(6, 4)
    a, b = dx.BSplinePatch(P65, 4, 3, knots), dx.BSplinePatch(P65, 4, 3, 2 * knots + 5)
    u, w = np.linspace(0, 1, 7)[:, None], np.linspace(0, 1, 6)[None]
    np.testing.assert_allclose(a.derivative(u, w, 1, 1), b.derivative(u, w, 1, 1), atol=1e-12)


def test_sides_at_a_gap_and_a_crease():
    """At a full knot the value is that of growing u; at a crease the derivative is; at u = 1 that of the last span."""
    net = np.array([[(x, y, x) for y in (0, 1)] for x in (0, 1, 5, 6)], dtype=float)
    torn = dx.BSplinePatch(net, 2, 2, [0, 0, 1, 1, 2, 2])
    assert torn(0.5, 0).tolist() == [5, 0, 5]
    assert torn([0.5, 1.0], [0.0, 0.0]).tolist() == [[5, 0, 5], [6, 0, 6]]
    assert torn(np.nextafter(0.5, 0), 0)[0] == pytest.approx(1)
    folded = dx.BSplinePatch(net[:3], 2, 2)
    assert folded.derivative(0.5, 0, 1, 0).tolist() == [8, 0, 8]
    assert folded.derivative([1.0, 0.25], [0.0, 0.0], 1, 0).tolist() == [[8, 0, 8], [2, 0, 2]]


def test_periodic_closes_smoothly():
    """A periodic net closes with k - 2 continuous derivatives, and its last knot span is not lost."""
    angle = 2 * np.pi * np.arange(7) / 7
    net = np.stack([np.stack([np.cos(angle), np.sin(angle), 0 * angle + z], axis=-1) for z in (0, 1)], axis=1)
    tube = dx.BSplinePatch(net, 4, 2, knots_u="periodic")
    for nu in range(3):
        np.testing.assert_allclose(tube.derivative(0, 0.3, nu, 0), tube.derivative(1, 0.3, nu, 0), atol=1e-10)
    assert tube.knot_vector_u.count == 10


def test_exact_quarter_cylinder():
    """Weights 1, √½, 1 make the quarter circle exactly: x² + y² = r²; the parameter is not the angle."""
    net = [[(x, y, z) for z in (0, 5)] for x, y in ((2, 0), (2, 2), (0, 2))]
    s = np.sqrt(0.5)
    quarter = dx.NurbsPatch(net, [(1, 1), (s, s), (1, 1)], 3, 2)
    points = quarter(np.linspace(0, 1, 33)[:, None], np.linspace(0, 1, 5)[None])
    np.testing.assert_allclose(np.hypot(points[..., 0], points[..., 1]), 2, rtol=1e-15)
    np.testing.assert_allclose(quarter(0.25, 0), (1.8595766, 0.736189419, 0), rtol=1e-8)
    bent = quarter.curvature(0.3, 0.5)
    np.testing.assert_allclose((bent.gaussian, bent.k1, bent.k2), (0, 0, -0.5), atol=1e-13)


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (lambda: dx.BSplinePatch(P65, 7, 3), OrderError, "k must be at most the number of control points; got order 7"),
        (lambda: dx.BSplinePatch(P65, 4, 0), OrderError, "l must be a whole number of at least 1"),
        (lambda: dx.BSplinePatch(P65, 4.0, 3), OrderError, "k must be a whole number"),
        (lambda: dx.BSplinePatch(P65, 4, 3, [0, 1]), KnotError, "knots_u must be 10 numbers"),
        (lambda: dx.BSplinePatch(P65, 4, 3, "open", [0, 0, 0, 2, 1, 3, 3, 3]), KnotError, "knots_w must not decrease"),
        (lambda: dx.BSplinePatch(P65, 4, 3, "closed"), NumberError, "knots_u must be one of 'open'"),
        (lambda: dx.BSplinePatch(P65, 4, 3, [0, 0, 0, 1, 1, 1, 1, 2, 2, 2]), KnotError, "knots_u must leave a domain"),
        (lambda: dx.NurbsPatch(P65, H65.T, 4, 3), ShapeError, r"weights must have shape \(6, 5\)"),
        (lambda: dx.NurbsPatch(P65, -H65, 4, 3), WeightError, "greater than 0"),
        (lambda: dx.NurbsPatch(P65, 0 * H65, 4, 3), WeightError, "greater than 0"),
        (lambda: dx.NurbsPatch(P65, H65 * np.nan, 4, 3), NumberError, "weights must be finite"),
        (lambda: dx.BSplinePatch(P65.reshape(30, 3), 4, 3), ShapeError, r"\(30, 3\)"),
    ],
)
def test_bad_input_is_named(make, error, message):
    with pytest.raises(error, match=message):
        make()
