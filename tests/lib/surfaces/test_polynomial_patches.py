"""Algebraic, Hermite, point and Bezier patches: printed values, exact values, and one form held against another."""

import json
from pathlib import Path

import directrix as dx
import geomdl.BSpline
import numpy as np
import pytest
from directrix.basis import bernstein
from directrix.errors import DegenerateError, GeometryError, NumberError, OrderError, ShapeError
from directrix.surfaces.bezier import bezier_point
from hypothesis import given, settings
from hypothesis import strategies as st

DATA = {
    name: np.array(value, dtype=float)
    for name, value in json.loads(Path(__file__).with_name("syllabus_data.json").read_text()).items()
}
U, W = np.linspace(0, 1, 9)[:, None], np.linspace(0, 1, 8)[None, :]
seeds = st.integers(0, 2**32 - 1)
fixed = settings(derandomize=True, max_examples=40, deadline=None)


def four_forms(rng):
    """One random patch of each polynomial form, of mixed degrees where the form allows."""
    m, n = rng.integers(2, 6, 2)
    net = rng.standard_normal((m, n, 3))
    tu = np.concatenate([[0], np.sort(rng.uniform(0.1, 0.9, m - 2)), [1]])
    return [
        dx.AlgebraicPatch(net),
        dx.HermitePatch(rng.standard_normal((4, 4, 3))),
        dx.PointPatch(net, tu if (np.diff(tu) > 0.02).all() else None, "chord"),
        dx.BezierPatch(net),
    ]


@pytest.mark.parametrize(
    ("patch", "u", "w", "expected"),
    [
        (dx.AlgebraicPatch(DATA["a44"]), 0.5, 0.25, (5.41796875, 2.19140625, 2.47265625)),
        (dx.HermitePatch(DATA["G"]), 0.5, 0.5, (2.890625, 1.65625, 0.90625)),
        (dx.HermitePatch(DATA["G"]), 0.25, 0.75, (1.989013671875, 2.69580078125, 0.8515625)),
        (dx.BezierPatch(DATA["BP"]), 0.5, 0.5, (4.203125, 5.640625, -0.09375)),
        (dx.Ferguson(DATA["p"], DATA["pu"], DATA["pw"]), 0.5, 0.5, (2.875, 1.625, 1)),
        (dx.Ferguson(DATA["p"], DATA["pu"], DATA["pw"]), 0.25, 0.75, (1.9208984375, 2.744140625, 0.904296875)),
    ],
)
def test_dyadic_parameters_give_exact_points(patch, u, w, expected):
    """Whole-number data at dyadic parameters: nothing is rounded, so the course's printed values hold to the last bit."""
    assert patch(u, w).tolist() == list(expected)
    assert patch([[u]], [[w]]).tolist() == [[list(expected)]]
    assert patch([u, 0, 1], [w, 0, 1])[0].tolist() == list(expected)


def test_point_patch_printed_value():
    """The course's quartic by cubic patch with chosen parameters."""
    patch = dx.PointPatch(DATA["P54"], (0, 0.2, 0.45, 0.7, 1), (0, 0.3, 0.75, 1))
    np.testing.assert_allclose(patch(0.5, 0.5), (5.62816372, 7.07279427, -0.109650931), rtol=1e-8)
    assert patch(0.45, 0.75).tolist() == [5, 8, 1]


def test_point_patch_meets_its_points_exactly():
    """S(tu[i], tw[j]) = P[i, j]: the Lagrange factors vanish exactly at the other nodes."""
    patch = dx.PointPatch(DATA["P54"], (0, 0.25, 0.5, 0.625, 1), (0, 0.125, 0.75, 1))
    np.testing.assert_allclose(patch(patch.tu[:, None], patch.tw[None]), DATA["P54"], rtol=1e-15, atol=1e-15)


def test_sixteen_points_by_the_printed_matrix():
    """Equally spaced 4 x 4 points are the sixteen-point form U M P Mᵀ Wᵀ with the matrix that textbooks print."""
    M = np.array([[-9 / 2, 27 / 2, -27 / 2, 9 / 2], [9, -45 / 2, 18, -9 / 2], [-11 / 2, 9, -9 / 2, 1], [1, 0, 0, 0]])
    powers = lambda t: np.stack([t**3, t**2, t, t**0], axis=-1) @ M  # noqa: E731
    expected = np.einsum("ai,bj,ijc->abc", powers(U[:, 0]), powers(W[0]), DATA["BP"])
    np.testing.assert_allclose(dx.PointPatch(DATA["BP"])(U, W), expected, atol=1e-12)


def test_hermite_patch_by_the_printed_matrix():
    """S = U M_F G M_Fᵀ Wᵀ with descending powers."""
    M = np.array([[2, -2, 1, 1], [-3, 3, -2, -1], [0, 0, 1, 0], [1, 0, 0, 0]])
    powers = lambda t: np.stack([t**3, t**2, t, t**0], axis=-1) @ M  # noqa: E731
    expected = np.einsum("ai,bj,ijc->abc", powers(U[:, 0]), powers(W[0]), DATA["G"])
    np.testing.assert_allclose(dx.HermitePatch(DATA["G"])(U, W), expected, atol=1e-13)


def test_hermite_corner_data_come_back():
    """Corner points, tangents and twists of the surface are the blocks of G."""
    patch = dx.HermitePatch(DATA["G"])
    ends = np.array([0.0, 1.0])
    for (nu, nw), block in zip(
        [(0, 0), (1, 0), (0, 1), (1, 1)], [patch.corners, patch.tangents_u, patch.tangents_w, patch.twists], strict=True
    ):
        assert patch.derivative(ends[:, None], ends[None], nu, nw).tolist() == block.tolist()


def test_hermite_twist_rules():
    """Zero twists make Ferguson's patch; Coons (for one patch Adini's) twists make the Coons patch of the edges."""
    p, pu, pw = DATA["p"], DATA["pu"], DATA["pw"]
    assert dx.HermitePatch.of(p, pu, pw).G.tolist() == dx.Ferguson(p, pu, pw).G.tolist()
    coons = dx.HermitePatch.of(p, pu, pw, "coons")
    assert coons == dx.HermitePatch.of(p, pu, pw, "adini") == dx.HermitePatch.of(p, pu, pw, dx.coons_twists(DATA["G"]))
    assert dx.coons_twists(DATA["G"])[0].tolist() == [[-4, -2, 1], [0, -3, 0]]
    edge = [dx.HermiteCurve(*q) for q in (DATA["G"][[0, 1, 2, 3], 0], DATA["G"][:, 1], DATA["G"][0], DATA["G"][1])]
    np.testing.assert_allclose(coons(U, W), dx.Coons(*edge)(U, W), atol=1e-13)


def test_ferguson_is_the_cubic_coons_patch_of_its_edges():
    """Four Hermite cubics blended with F1 and F2 give the zero-twist patch."""
    G = DATA["G"]
    edge = [dx.HermiteCurve(*q) for q in (G[:, 0], G[:, 1], G[0], G[1])]
    patch = dx.Ferguson(DATA["p"], DATA["pu"], DATA["pw"])
    for nu, nw in [(0, 0), (1, 0), (0, 1), (1, 1), (2, 1)]:
        np.testing.assert_allclose(
            dx.Coons(*edge, blend="cubic").derivative(U, W, nu, nw), patch.derivative(U, W, nu, nw), atol=1e-12
        )


@fixed
@given(seeds)
def test_derivatives_are_derivatives(seed):
    """Each analytic derivative is the derivative of the one below it: complex-free check by a polynomial fit in u and in w."""
    rng = np.random.default_rng(seed)
    for patch in four_forms(rng):
        nodes = (np.cos(np.pi * np.arange(9) / 8)[::-1] + 1) / 2
        a, b = rng.integers(0, 3, 2)
        at = rng.random()
        values = patch.derivative(nodes, at, a, b)
        slope = np.polynomial.polynomial.polyder(np.linalg.solve(np.vander(nodes, increasing=True), values))
        t = rng.random(5)
        np.testing.assert_allclose(patch.derivative(t, at, a + 1, b), np.vander(t, 8, increasing=True) @ slope, atol=2e-8)
        values = patch.derivative(at, nodes, a, b)
        slope = np.polynomial.polynomial.polyder(np.linalg.solve(np.vander(nodes, increasing=True), values))
        np.testing.assert_allclose(patch.derivative(at, t, a, b + 1), np.vander(t, 8, increasing=True) @ slope, atol=2e-8)


@fixed
@given(seeds)
def test_grid_and_scattered_points_agree(seed):
    """The path that an open mesh takes and the one that scattered points take give the same to rounding, in every shape."""
    rng = np.random.default_rng(seed)
    for patch in four_forms(rng):
        u, w = rng.random((2, 6))
        grid = patch.derivative(u[:, None], w[None], 1, 1)
        assert grid.shape == (6, 6, 3)
        np.testing.assert_allclose(patch.derivative(*np.meshgrid(u, w, indexing="ij"), 1, 1), grid, atol=1e-10)
        np.testing.assert_allclose(patch.derivative(u, w, 1, 1), grid[range(6), range(6)], atol=1e-10)
        np.testing.assert_allclose(patch.derivative(w[None, :], u[:, None], 0, 0), patch(w, u[:, None]), atol=1e-12)
        assert patch(u[:, None, None], w[None, :4, None]).shape == (6, 4, 1, 3)
        assert patch(0.5, w).shape == (6, 3)
        assert patch([], 0.5).shape == (0, 3)
        assert patch(np.empty((0, 1)), w[None]).shape == (0, 6, 3)


@fixed
@given(seeds)
def test_affine_maps_commute(seed):
    """(T S)(u, w) = T(S(u, w)) for every affine map, and the kind of patch is kept."""
    rng = np.random.default_rng(seed)
    T = dx.Transform.of(rng.standard_normal((3, 3)), rng.standard_normal(3))
    for patch in four_forms(rng):
        moved = T @ patch
        assert type(moved) is type(patch)
        np.testing.assert_allclose(moved(U, W), T @ patch(U, W), atol=1e-12)


@fixed
@given(seeds)
def test_parts_are_parts(seed):
    """A sub-patch, a flip, a swap and a split keep their kind and run over the same points."""
    rng = np.random.default_rng(seed)
    for patch in four_forms(rng):
        u0, u1, w0, w1 = rng.random(4)
        part = patch.patch(u0, u1, w0, w1)
        assert type(part) is type(patch)
        inner = patch(u0 + (u1 - u0) * U, w0 + (w1 - w0) * W)
        np.testing.assert_allclose(part(U, W), inner, atol=1e-9)
        np.testing.assert_allclose(patch.flip_u()(U, W), patch(1 - U, W), atol=1e-9)
        np.testing.assert_allclose(patch.flip_w()(U, W), patch(U, 1 - W), atol=1e-9)
        np.testing.assert_allclose(patch.swap()(W.T, U.T), np.swapaxes(patch(U, W), 0, 1), atol=1e-12)
        left, right = patch.split(u=0.25)
        np.testing.assert_allclose(left(1, W[0]), right(0, W[0]), atol=1e-9)
        np.testing.assert_allclose(left(U, W), patch(U / 4, W), atol=1e-9)


def test_ferguson_parts_and_moves():
    """A part of a Ferguson patch has twists and is a Hermite patch; moved or swapped it stays one without."""
    patch = dx.Ferguson(DATA["p"], DATA["pu"], DATA["pw"])
    part = patch.patch(0, 0.5, 0, 0.5)
    assert type(part) is dx.HermitePatch
    assert part.twists.any()
    np.testing.assert_allclose(part(U, W), patch(U / 2, W / 2), atol=1e-13)
    assert type(patch.swap()) is dx.Ferguson
    assert patch.swap().swap() == patch
    assert type(dx.Transform.rotate("x", 1.0) @ patch) is dx.Ferguson


@fixed
@given(seeds)
def test_bezier_against_de_casteljau_and_geomdl(seed):
    """Random nets of mixed degree, against the recursion and another library."""
    rng = np.random.default_rng(seed)
    m, n = (int(x) for x in rng.integers(2, 7, 2))
    net = rng.standard_normal((m, n, 3))
    patch = dx.BezierPatch(net)
    u, w = rng.random((2, 7))
    slow = np.array([bezier_point(net, a, b) for a, b in zip(u, w, strict=True)])
    np.testing.assert_allclose(patch(u, w), slow, atol=1e-13)
    other = geomdl.BSpline.Surface()
    other.degree_u, other.degree_v = m - 1, n - 1
    other.set_ctrlpts(net.reshape(-1, 3).tolist(), m, n)
    other.knotvector_u, other.knotvector_v = [0] * m + [1] * m, [0] * n + [1] * n
    np.testing.assert_allclose(patch(u, w), other.evaluate_list(list(zip(u.tolist(), w.tolist(), strict=True))), atol=1e-12)


@fixed
@given(seeds)
def test_bezier_lies_in_the_hull_and_meets_its_corners(seed):
    """Partition of unity, corner interpolation, the box of the net, and what its boundary rows and its cross sections are."""
    rng = np.random.default_rng(seed)
    net = rng.standard_normal((4, 3, 3))
    patch = dx.BezierPatch(net)
    points = patch(U, W)
    assert (points <= net.max(axis=(0, 1)) + 1e-12).all()
    assert (points >= net.min(axis=(0, 1)) - 1e-12).all()
    assert patch(U[[0, -1]], W[:, [0, -1]]).tolist() == net[[0, -1]][:, [0, -1]].tolist()
    np.testing.assert_allclose(bernstein(5, U[:, 0]).sum(axis=1), 1, rtol=1e-15)
    np.testing.assert_allclose(patch.curve_w(0.0)(W[0]), dx.BezierCurve(net[0])(W[0]), atol=1e-15)
    np.testing.assert_allclose(patch.curve_u(0.3)(U[:, 0]), patch(U[:, 0], 0.3), atol=1e-13)
    np.testing.assert_allclose(patch.curve_w(0.3)(W[0]), patch(0.3, W[0]), atol=1e-13)


def test_derivatives_above_the_degree_vanish():
    """A bicubic has no fourth derivative."""
    for patch in (dx.BezierPatch(DATA["BP"]), dx.HermitePatch(DATA["G"]), dx.AlgebraicPatch(DATA["a43"])):
        assert not patch.derivative(U, W, 4, 0).any()
        assert not patch.derivative(0.5, 0.5, 1, 4).any()
    assert not dx.PointPatch(DATA["BP3"]).derivative(U, W, 0, 3).any()


def test_collapsed_edge_has_the_limit_normal():
    """A Bezier patch with an edge collapsed to a point (an octant-like cap) has a normal there, and no NaN."""
    net = np.array([[(0, 0, 1), (0, 0, 1), (0, 0, 1)], [(1, 0, 1), (1, 1, 1), (0, 1, 1)], [(1, 0, 0), (1, 1, 0), (0, 1, 0)]])
    normal = dx.BezierPatch(net).normal(0.0, W[0])
    np.testing.assert_allclose(np.abs(normal @ [0, 0, 1]), 1, atol=1e-9)


def test_chord_parameters():
    """Chord lengths of the rows, each made 1, averaged; rows without length are left out."""
    x = np.array([0.0, 1, 4])
    net = np.stack(np.broadcast_arrays(x[:, None], np.arange(2.0)[None], 0.0), axis=-1)
    assert dx.PointPatch(net, "chord").tu.tolist() == [0, 0.25, 1]
    net[:, 1] = 7
    assert dx.PointPatch(net, "chord").tu.tolist() == [0, 0.25, 1]
    with pytest.raises(DegenerateError, match="points 0 and the next coincide in every row"):
        dx.PointPatch(net[[0, 0, 1]], "chord")
    with pytest.raises(DegenerateError, match="all steps have length 0"):
        dx.PointPatch(np.ones((3, 2, 3)), "chord")


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (
            lambda: dx.BezierPatch(np.zeros((16, 3))),
            ShapeError,
            r"shape \(m, n, 3\) with m, n >= 2; got \(16, 3\).*reshape\(4, 4, 3\)",
        ),
        (lambda: dx.BezierPatch(np.zeros((3, 4, 4))), ShapeError, r"last axis"),
        (lambda: dx.BezierPatch(np.zeros((1, 4, 3))), ShapeError, "m, n >= 2"),
        (lambda: dx.BezierPatch(np.full((2, 2, 3), np.nan)), NumberError, "net must be finite"),
        (lambda: dx.AlgebraicPatch(np.zeros((0, 2, 3))), ShapeError, "m, n >= 1"),
        (lambda: dx.HermitePatch(np.zeros((4, 4))), ShapeError, r"\(4, 4, 3\)"),
        (lambda: dx.HermitePatch.of(DATA["p"], DATA["pu"], DATA["pw"], "flat"), NumberError, "twists must be one of"),
        (lambda: dx.Ferguson(np.zeros((4, 3)), DATA["pu"], DATA["pw"]), ShapeError, r"p must have shape \(2, 2, 3\).*reshape"),
        (lambda: dx.PointPatch(DATA["BP"], tu=(0, 0.5, 1)), ShapeError, r"tu must have shape \(4,\)"),
        (lambda: dx.PointPatch(DATA["BP"], tw=(0, 0.5, 0.5, 1)), NumberError, "tw must increase from 0 to 1"),
        (lambda: dx.PointPatch(DATA["BP"], tw=(0, 0.5, 0.6, 2)), NumberError, "tw must increase from 0 to 1"),
        (lambda: dx.PointPatch(DATA["BP"], "equal"), NumberError, "'chord'"),
        (lambda: dx.BezierPatch(DATA["BP"]).patch(0.5, 0.5, 0, 1), OrderError, "u0 and u1 must differ"),
        (lambda: dx.BezierPatch(DATA["BP"])(1.5, 0), GeometryError, r"u must lie in \[0, 1\]"),
        (lambda: dx.BezierPatch(DATA["BP"])(np.nan, 0), GeometryError, r"u must lie in \[0, 1\]"),
        (lambda: dx.BezierPatch(DATA["BP"])(np.zeros(3), np.zeros(4)), ShapeError, "broadcast"),
        (lambda: dx.BezierPatch(DATA["BP"]).derivative(0, 0, -1, 0), OrderError, "nu must be a whole number"),
    ],
)
def test_bad_input_is_named(make, error, message):
    with pytest.raises(error, match=message):
        make()


def test_arrays_are_copied_and_frozen():
    """Neither the caller's array nor the patch can change under the other."""
    net = DATA["BP"].copy()
    patch = dx.BezierPatch(net)
    net[:] = 0
    assert patch(0, 0).tolist() == DATA["BP"][0, 0].tolist()
    with pytest.raises(ValueError, match="read-only"):
        patch.control_net[0, 0, 0] = 1
    points = patch(U, W)
    points[:] = 0
    assert patch(0, 0).tolist() == DATA["BP"][0, 0].tolist()
