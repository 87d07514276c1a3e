"""splipy beside ours on random data: sweeps of all kinds, Coons, ruled surfaces, solids, and knots."""

from math import pi

import directrix as dx
import numpy as np
import pytest

splipy = pytest.importorskip("splipy", reason="splipy is not installed: uv sync --group oracles")
surface_factory, volume_factory = map(pytest.importorskip, ("splipy.surface_factory", "splipy.volume_factory"))

T = np.linspace(0, 1, 17)
U, W = T[:, None], T[None, :]
ATOL = 1e-12  # coordinates of size 1 to 10: a few hundred roundings
SEEDS = pytest.mark.parametrize("seed", range(20))
KNOTS = np.array([0, 0, 0, 0, 0.2, 0.5, 0.5, 1, 1, 1, 1])


def bspline(rng, knots=KNOTS, start=None, end=None):
    """A random cubic with a double knot, from and to given points."""
    points = rng.standard_normal((len(knots) - 4, 3))
    points[0] = points[0] if start is None else start
    points[-1] = points[-1] if end is None else end
    return dx.BSplineCurve(points, 4, knots)


def peer(curve):
    """The same curve in splipy, whose rational points carry their weights as a factor."""
    if isinstance(curve, dx.NurbsCurve):
        lifted = np.c_[curve.control_points * curve.weights[:, None], curve.weights]
        return splipy.Curve(splipy.BSplineBasis(curve.order, curve.knots), lifted, rational=True)
    return splipy.Curve(splipy.BSplineBasis(curve.order, curve.knots), curve.control_points)


@pytest.mark.parametrize("seed", range(3))
def test_linear_sweep_is_its_extrusion(seed):
    """surface_factory.extrude by the vector distance x unit direction."""
    rng = np.random.default_rng(seed)
    sweep = dx.LinearSweep(bspline(rng), rng.standard_normal(3), 2.5)
    np.testing.assert_allclose(sweep(U, W), surface_factory.extrude(peer(sweep.curve), sweep.vector)(T, T), atol=ATOL)


@pytest.mark.parametrize("angle", [2 * pi, 1.0, 4.0])
def test_circular_sweep_is_its_revolution(angle):
    """surface_factory.revolve, rational: the same parallels, at another speed; so radius, height and curve are compared."""
    rng = np.random.default_rng(7)
    axis = np.array([1.0, 2, 2]) / 3
    sweep = dx.CircularSweep.about(bspline(rng), (0, 0, 0), axis, angle)
    theirs = surface_factory.revolve(peer(sweep.curve), angle, axis)
    end = theirs.end(1)
    grid = theirs(T, end * T)
    ours = sweep(U, W)
    np.testing.assert_allclose(ours @ axis, grid @ axis, atol=ATOL)
    np.testing.assert_allclose(
        np.linalg.norm(np.cross(ours, axis), axis=-1), np.linalg.norm(np.cross(grid, axis), axis=-1), atol=ATOL
    )
    np.testing.assert_allclose(ours[:, [0, -1]], grid[:, [0, -1]], atol=1e-11)
    if angle == 1.0:  # one rational piece, as ours
        np.testing.assert_allclose(dx.to_nurbs(sweep)(U, W), grid, atol=1e-11)


@pytest.mark.parametrize("seed", range(3))
def test_coons_is_its_patch_of_four_edges(seed):
    """surface_factory.edge_curves, on random space curves with double knots."""
    rng = np.random.default_rng(seed)
    corner = rng.standard_normal((2, 2, 3))
    c0, c1 = (bspline(rng, start=corner[0, j], end=corner[1, j]) for j in (0, 1))
    d0, d1 = (bspline(rng, start=corner[i, 0], end=corner[i, 1]) for i in (0, 1))
    theirs = surface_factory.edge_curves(peer(c0), peer(d1), peer(c1), peer(d0))
    np.testing.assert_allclose(dx.Coons(c0, c1, d0, d1)(U, W), theirs(T, T), atol=ATOL)
    ruled = surface_factory.edge_curves(peer(c0), peer(c1))
    np.testing.assert_allclose(dx.Ruled(c0, c1)(U, W), ruled(T, T), atol=ATOL)


def test_frenet_sweep_meets_its_sections():
    """surface_factory.sweep interpolates x + n y_0 + b y_1 at the Greville abscissae of the path; there ours must be it."""
    path = dx.BezierCurve([(0, 0, 0), (1, 3, 1), (4, 3, -2), (5, 0, 3)])
    outline = dx.BezierCurve([(0, 1, 0), (1, 1, 0), (1, -1, 0), (-1, 0, 0)])
    there = peer(dx.to_bspline(path))
    theirs = surface_factory.sweep(there, peer(dx.to_bspline(outline)))
    n, b = there.normal(0), there.binormal(0)
    section = dx.BezierCurve(outline.control_points[:, :1] * n + outline.control_points[:, 1:2] * b + path(0.0))
    at = there.bases[0].greville()
    v = theirs.bases[1].greville()
    np.testing.assert_allclose(
        dx.GenericSweep(section, path, "frenet")(np.array(v)[None], np.array(at)[:, None]), theirs(at, v), atol=1e-9
    )


def test_a_solid_extruded_and_a_loft():
    """volume_factory.extrude of a patch is the hyperpatch of two layers; loft through two patches as well."""
    rng = np.random.default_rng(11)
    net = rng.standard_normal((5, 4, 3))
    patch = splipy.Surface(
        splipy.BSplineBasis(4, [0, 0, 0, 0, 0.5, 1, 1, 1, 1]), splipy.BSplineBasis(4), net.transpose(1, 0, 2).reshape(-1, 3)
    )
    amount = np.array([1.0, 2, 3])
    solid = dx.BSplineHyperpatch(np.stack([net, net + amount], axis=2), 4, 4, 2, [0, 0, 0, 0, 0.5, 1, 1, 1, 1])
    theirs = volume_factory.extrude(patch, amount)
    np.testing.assert_allclose(solid(U[..., None], W[..., None], T[None, None, ::4]), theirs(T, T, T[::4]), atol=ATOL)


def test_knots_degrees_and_parts_of_a_nurbs():
    """insert_knot, raise_order, split and reverse of a rational curve: control points and weights, one by one."""
    rng = np.random.default_rng(12)
    curve = dx.NurbsCurve(rng.standard_normal((7, 3)), rng.uniform(0.5, 2, 7), 4, KNOTS)

    def homogeneous(one):
        return np.c_[one.control_points * one.weights[:, None], one.weights]

    np.testing.assert_allclose(homogeneous(dx.insert_knot(curve, 0.3)), peer(curve).insert_knot(0.3).controlpoints, atol=ATOL)
    np.testing.assert_allclose(homogeneous(dx.elevate(curve)), peer(curve).raise_order(1).controlpoints, atol=1e-11)
    left, right = peer(curve).split(0.3)
    for ours, theirs in zip(curve.split(0.3), (left, right), strict=True):
        np.testing.assert_allclose(ours(T), theirs(theirs.start(0) + T * (theirs.end(0) - theirs.start(0))), atol=ATOL)
    np.testing.assert_allclose(curve.segment(1, 0)(T), peer(curve).reverse()(T), atol=ATOL)


@SEEDS
def test_bezier_patches_of_mixed_degree(seed):
    rng = np.random.default_rng(seed)
    m, n = rng.integers(2, 7, 2)
    net = rng.standard_normal((m, n, 3))
    theirs = splipy.Surface(splipy.BSplineBasis(m), splipy.BSplineBasis(n), net.transpose(1, 0, 2).reshape(-1, 3))
    np.testing.assert_allclose(dx.BezierPatch(net)(U, W), theirs(T, T), atol=ATOL)


@SEEDS
def test_nurbs_patches_and_their_derivatives(seed):
    """splipy wants control points multiplied by their weights."""
    rng = np.random.default_rng(seed)
    m, n, k, l = 7, 6, 4, 3  # noqa: E741
    knots_u, knots_w = (np.concatenate([[0] * o, np.sort(rng.random(c - o)), [1] * o]) for c, o in ((m, k), (n, l)))
    net, weights = rng.standard_normal((m, n, 3)), rng.uniform(0.5, 2, (m, n))
    patch = dx.NurbsPatch(net, weights, k, l, knots_u, knots_w)
    lifted = np.concatenate([net * weights[..., None], weights[..., None]], axis=2).transpose(1, 0, 2).reshape(-1, 4)
    theirs = splipy.Surface(splipy.BSplineBasis(k, knots_u), splipy.BSplineBasis(l, knots_w), lifted, rational=True)
    u, w = np.sort(rng.random((2, 6)))
    np.testing.assert_allclose(patch(u[:, None], w[None]), theirs(u, w), atol=ATOL)
    np.testing.assert_allclose(patch.derivative(u[:, None], w[None], 1, 0), theirs.derivative(u, w, d=(1, 0)), atol=1e-10)


@SEEDS
def test_degree_elevation(seed):
    points = np.random.default_rng(seed).standard_normal((7, 3))
    curve = dx.BSplineCurve(points, 4)
    theirs = peer(curve).raise_order(1)
    np.testing.assert_allclose(dx.elevate(curve).control_points, theirs.controlpoints, atol=1e-9)
