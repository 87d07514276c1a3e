"""Nearest points: closed forms, points of the surface itself, and a look at every sample of a dense grid."""

import directrix as dx
import numpy as np
import pytest

RNG = np.random.default_rng(9)
HELIX = dx.GenericSweep(
    dx.BezierCurve([(1, 0, 0), (1.2, 0.1, 0.3), (1.3, 0.3, 0)]),
    dx.NurbsCurve([(1, 0, 0), (1, 2, 1), (-2, 2, 2), (-2, -2, 3), (2, -2, 4)], np.ones(5), 4),
    "minimal",
)
SURFACES = [dx.Sphere(2), dx.Torus(3, 1), dx.Cylinder(2, 5), dx.Cone(2, 0, 3), dx.Plane((1, 2, 0), (4, 1, 2), (0, 5, 3)), HELIX]
EVERY = pytest.mark.parametrize("surface", SURFACES, ids=lambda s: type(s).__name__)


@EVERY
def test_points_of_the_surface_are_found_again(surface):
    """Distance 0 to rounding, and the parameters lead to the point; seams and poles included."""
    u, w = np.concatenate([RNG.random((2, 60)), [[0, 1, 0, 1, 0.5], [0, 0, 1, 1, 0]]], axis=1)
    points = surface(u, w)
    found = surface.nearest(points)
    assert found.distance.max() < 1e-8
    assert np.allclose(surface(found.u, found.w), points, atol=1e-8)


@EVERY
def test_no_sample_of_a_dense_grid_is_nearer(surface):
    """For points anywhere around: the answer is the global one."""
    points = 3 * RNG.normal(size=(80, 3))
    grid = surface(np.linspace(0, 1, 150)[:, None], np.linspace(0, 1, 150)[None, :]).reshape(-1, 3)
    dense = np.array([np.sqrt(((grid - point) ** 2).sum(axis=1).min()) for point in points])
    found = surface.nearest(points)
    assert (found.distance <= dense + 1e-12).all()
    assert np.allclose(np.linalg.norm(surface(found.u, found.w) - points, axis=1), found.distance, atol=1e-14)


@EVERY
def test_the_connection_is_perpendicular_inside(surface):
    """First-order condition, where the foot is not on the edge."""
    points = 3 * RNG.normal(size=(40, 3))
    u, w, _ = surface.nearest(points)
    inner = (u > 0) & (u < 1) & (w > 0) & (w < 1)
    away = (surface(u, w) - points)[inner]
    for orders in ((1, 0), (0, 1)):
        tangent = surface.derivative(u, w, *orders)[inner]
        assert np.abs((away * tangent).sum(-1)).max(initial=0) < 1e-6 * np.abs(tangent).max()


def test_distances_to_the_sphere_and_the_torus():
    """||p| - r|, and the distance to the circle of centres less r."""
    points = 3 * RNG.normal(size=(5, 7, 3))
    found = dx.Sphere(2).nearest(points)
    assert found.u.shape == found.w.shape == found.distance.shape == (5, 7)
    assert np.allclose(found.distance, np.abs(np.linalg.norm(points, axis=-1) - 2), atol=1e-9)
    away = np.hypot(np.hypot(points[..., 0], points[..., 1]) - 3, points[..., 2])
    assert np.allclose(dx.Torus(3, 1).nearest(points).distance, np.abs(away - 1), atol=1e-9)


def test_one_point_and_none():
    """Scalars for one, empty arrays for none."""
    assert dx.Cylinder(1, 2).nearest((3, 0, 1)).distance == pytest.approx(2)
    assert dx.Cylinder(1, 2).nearest((3, 0, 1)).u.shape == ()
    assert dx.Cylinder(1, 2).nearest(np.empty((0, 3))).u.shape == (0,)


def test_beyond_an_edge_the_edge_is_nearest():
    """Above a cylinder its rim, beside a plane patch its corner."""
    u, w, distance = dx.Cylinder(1, 2).nearest((0, 1, 5))
    assert (u, w) == (pytest.approx(0.25), 1)
    assert distance == pytest.approx(3)
    assert dx.Plane((0, 0, 0), (1, 0, 0), (0, 1, 0)).nearest((3, 3, 1))[:2] == (1, 1)


def facets(seed):
    """A surface of creases: order 2, so every inner knot line is one."""
    return dx.BSplinePatch(2 * np.random.default_rng(seed).normal(size=(6, 5, 3)), 2, 3)


def uneven(seed):
    """Nearly all of it lies in slivers along the sides, since a few weights are far larger than their neighbours."""
    rng = np.random.default_rng(seed)
    return dx.NurbsPatch(2 * rng.normal(size=(5, 3, 3)), 10 ** rng.uniform(-1.5, 1.5, (5, 3)), 4, 3)


@pytest.mark.parametrize("made", [facets, uneven])
@pytest.mark.parametrize("seed", range(4))
def test_creases_and_unequal_weights_hide_no_nearer_point(made, seed):
    """A search that meets a crease goes on along it; where the surface runs fast it is sampled more densely."""
    surface, points = made(seed), 3 * np.random.default_rng(seed).normal(size=(40, 3))
    dense = np.linspace(0, 1, 301)
    grid = surface(dense[:, None], dense[None, :]).reshape(-1, 3)
    found = surface.nearest(points)
    assert (found.distance <= np.linalg.norm(points[:, None] - grid, axis=-1).min(axis=1) + 1e-8).all()
    assert np.allclose(np.linalg.norm(surface(found.u, found.w) - points, axis=1), found.distance, atol=1e-14)
