"""Form errors: constructed zones, motion and scale, noise, partial arcs, minimum zones against exhaustive search."""

from itertools import combinations

import directrix as dx
import numpy as np
import pytest
from directrix.errors import DegenerateError, GeometryError, NumberError, ShapeError
from directrix.inspection.fitting import fit_cone, fit_cylinder, fit_torus
from directrix.inspection.forms import IdealCone, IdealCylinder, IdealPlane, IdealSphere, IdealTorus
from scipy.spatial import ConvexHull

CHECKS = {
    "plane": dx.flatness,
    "sphere": dx.sphericity,
    "cylinder": dx.cylindricity,
    "cone": dx.conicity,
    "torus": dx.toricity,
}


def measured(kind, rng, n=400, turn=1.0, error=0.0, size=1.0):
    """Points of a form over part of a turn, in general position, disturbed along its normal by up to error/2."""
    u, w, e = turn * 2 * np.pi * rng.random(n), rng.random(n), error * (rng.random(n) - 0.5)
    if kind == "plane":
        points = np.stack([10 * u, 7 * w, e], axis=1)
    elif kind == "sphere":
        v = rng.standard_normal((n, 3)) + (0 if turn == 1 else [2, 0, 0])
        points = v / np.linalg.norm(v, axis=1)[:, None] * (5 + e)[:, None]
    elif kind == "cylinder":
        points = np.stack([(5 + e) * np.cos(u), (5 + e) * np.sin(u), 12 * w], axis=1)
    elif kind == "cone":
        s, c = np.sin(0.3), np.cos(0.3)
        rho, z = (2 + 4 * w) * s + e * c, (2 + 4 * w) * c - e * s
        points = np.stack([rho * np.cos(u), rho * np.sin(u), z], axis=1)
    else:
        v = 2 * np.pi * w
        rho = 6 + (2 + e) * np.cos(v)
        points = np.stack([rho * np.cos(u), rho * np.sin(u), (2 + e) * np.sin(v)], axis=1)
    return size * (points @ rotation(rng).T + rng.uniform(-50, 50, 3))


def rotation(rng):
    R, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    return R * np.sign(np.linalg.det(R))


@pytest.mark.parametrize("kind", CHECKS)
@pytest.mark.parametrize("size", [1e-3, 1.0, 1e4])
def test_perfect_points_have_no_error(kind, size):
    """Points of the form itself, turned, moved and in any unit: form error 0 to rounding, by both methods."""
    points = measured(kind, np.random.default_rng(1), size=size)
    for method in ("least squares", "minimum zone"):
        assert CHECKS[kind](points, method=method).value < 1e-11 * size


@pytest.mark.parametrize("kind", CHECKS)
@pytest.mark.parametrize("turn", [1.0, 0.25])
def test_noise_is_measured(kind, turn):
    """Noise of width 0.02: the zone is a little narrower than the noise, and never wider than about the least-squares form."""
    points = measured(kind, np.random.default_rng(2), turn=turn, error=0.02)
    result, zone = CHECKS[kind](points), CHECKS[kind](points, method="minimum zone")
    assert 0.018 < zone.value <= result.value + 1e-12 < 0.0225
    np.testing.assert_allclose(zone.residuals.max(), -zone.residuals.min(), rtol=1e-9)
    assert result.rms <= zone.rms + 1e-12
    assert result.value == pytest.approx(np.ptp(result.residuals), rel=1e-12)
    assert float(result) == result.value


@pytest.mark.parametrize("kind", CHECKS)
def test_nothing_depends_on_place_turn_or_unit(kind):
    """A rigid motion leaves the error, another unit of length scales it."""
    rng = np.random.default_rng(4)
    points = measured(kind, rng, n=150, error=0.05)
    first = CHECKS[kind](points).value
    moved = points @ rotation(rng).T + [3, -80, 5]
    np.testing.assert_allclose(CHECKS[kind](moved).value, first, rtol=1e-6)
    np.testing.assert_allclose(CHECKS[kind](1000 * points).value, 1000 * first, rtol=1e-6)
    zone = CHECKS[kind](points, method="minimum zone").value
    np.testing.assert_allclose(CHECKS[kind](moved, method="minimum zone").value, zone, rtol=1e-5)


def test_fitted_forms_are_the_right_ones():
    """Position, axis and radii come back from partial, noisy data of known forms."""
    rng = np.random.default_rng(6)
    x = np.stack([np.cos(a := rng.uniform(0, 2, 300)) * 5, np.sin(a) * 5, rng.uniform(0, 9, 300)], axis=1)
    cylinder = dx.cylindricity(x).form
    assert isinstance(cylinder, IdealCylinder)
    assert cylinder.radius == pytest.approx(5, rel=1e-9)
    assert abs(cylinder.axis[2]) == pytest.approx(1, rel=1e-12)
    h = rng.uniform(1, 4, 300)
    cone = dx.conicity(np.stack([h * np.cos(a), h * np.sin(a), 2 * h], axis=1)).form
    assert isinstance(cone, IdealCone)
    assert abs(cone.half_angle) == pytest.approx(np.arctan(0.5), rel=1e-9)
    np.testing.assert_allclose(cone.apex, 0, atol=1e-8)
    torus = dx.toricity(dx.Torus(6, 2).patch(0, 1, 0, 0.2)(*rng.random((2, 300)))).form
    assert isinstance(torus, IdealTorus)
    assert (torus.R, torus.r) == (pytest.approx(6, rel=1e-8), pytest.approx(2, rel=1e-8))
    sphere = dx.sphericity(dx.Sphere(3).patch(0.5, 0.8, 0, 0.3)(*rng.random((2, 50)))).form
    assert isinstance(sphere, IdealSphere)
    assert sphere.radius == pytest.approx(3, rel=1e-9)
    plane = dx.flatness([(0, 0, 1), (1, 0, 1), (0, 1, 1), (5, 6, 1)]).form
    assert isinstance(plane, IdealPlane)
    np.testing.assert_allclose(np.abs(plane.normal), (0, 0, 1), atol=1e-15)


def test_flatness_of_the_course():
    """Peak to valley about the orthogonal least-squares plane, from its definition, on tilted data."""
    rng = np.random.default_rng(9)
    points = rng.random((40, 2)) @ [[1, 2, 3], [3, 1, 0]] + 0.01 * rng.standard_normal((40, 3))
    centred = points - points.mean(axis=0)
    _, vectors = np.linalg.eigh(centred.T @ centred)
    np.testing.assert_allclose(dx.flatness(points).value, np.ptp(centred @ vectors[:, 0]), rtol=1e-12)
    assert dx.flatness([(0, 0, 0), (4, 0, 0), (0, 4, 0), (4, 4, 0), (2, 2, 0.5)]).value == 0.5


def width_of_hull(points):
    """The narrowest slab of a point set, exhaustively: between a face and a vertex, or between two edges of its hull."""
    hull = ConvexHull(points)
    edges = {tuple(sorted(pair)) for face in hull.simplices for pair in combinations(face, 2)}
    directions = np.array([points[b] - points[a] for a, b in edges])
    pairs = np.cross(directions[:, None], directions[None]).reshape(-1, 3)
    normals = np.concatenate([hull.equations[:, :3], pairs[np.linalg.norm(pairs, axis=1) > 1e-9]])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    return min(
        np.ptp(points[hull.vertices] @ block.T, axis=0).min() for block in np.array_split(normals, 1 + len(normals) // 5000)
    )


def test_minimum_zone_flatness_is_the_width_of_the_hull():
    """Against exhaustive search over all faces and pairs of edges of the convex hull."""
    rng = np.random.default_rng(11)
    for _ in range(8):
        points = rng.random((25, 3)) * [10, 8, 0.3] @ rotation(rng).T
        np.testing.assert_allclose(dx.flatness(points, "minimum zone").value, width_of_hull(points), rtol=1e-9)


@pytest.mark.parametrize("thickness", [1.0, 0.3, 0.1])
def test_the_narrowest_zone_of_thick_clouds_is_found_too(thickness):
    """Few points far from flat have several zones that no small turn makes narrower; the least-squares plane leads to any."""
    rng = np.random.default_rng(77)
    for _ in range(8):
        points = rng.normal(size=(12, 3)) * [1, 0.6, thickness] @ rotation(rng).T
        np.testing.assert_allclose(dx.flatness(points, "minimum zone").value, width_of_hull(points), rtol=1e-9)


def test_minimum_zone_sphericity_of_a_constructed_zone():
    """Points on two concentric spheres, interlocked so that no other centre gives a narrower zone."""
    tetrahedron = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]) / np.sqrt(3)
    points = np.concatenate([10.5 * tetrahedron, -10 * tetrahedron]) + (5, 6, 7)
    zone = dx.sphericity(points, "minimum zone")
    assert zone.value == pytest.approx(0.5, rel=1e-9)
    np.testing.assert_allclose(zone.form.center, (5, 6, 7), atol=1e-7)
    assert zone.form.radius == pytest.approx(10.25, rel=1e-9)


def test_minimum_zone_cannot_be_improved_nearby():
    """No small step of the form narrows its zone: tried in thousands of directions."""
    rng = np.random.default_rng(12)
    for kind in ("cylinder", "cone", "torus"):
        points = measured(kind, rng, n=120, error=0.05)
        zone = CHECKS[kind](points, method="minimum zone")
        for _ in range(1500):
            step = 10.0 ** rng.uniform(-6, -2) * rng.standard_normal(zone.form.steps)
            assert np.ptp(zone.form.stepped(step).distance(points)) >= zone.value - 1e-9


def test_slopes_of_the_distances():
    """The matrix of each form is the derivative of its distances by its steps: central differences."""
    rng = np.random.default_rng(13)
    axis = np.array([1.0, 2, 2]) / 3
    p = rng.standard_normal(3)
    forms = [
        IdealPlane(p, axis),
        IdealSphere(p, 2),
        IdealCylinder(p, axis, 2),
        IdealCone(p, axis, 2, 0.4),
        IdealTorus(p, axis, 3, 1),
    ]
    points = 4 * rng.standard_normal((20, 3))
    for form in forms:
        d, J = form.residuals(points)
        for i, e in enumerate(np.eye(form.steps) * 1e-6):
            numeric = (form.stepped(e).distance(points) - form.stepped(-e).distance(points)) / 2e-6
            np.testing.assert_allclose(J[:, i], numeric, atol=1e-7)
        np.testing.assert_allclose(form.shifted(np.ones(3)).distance(points + 1), d, atol=1e-12)


def test_given_axis():
    """About a datum axis nothing is fitted: range of the distances, whatever point of the axis and length of its direction."""
    rng = np.random.default_rng(14)
    points = measured("cylinder", rng, error=0.1)
    p, k = rng.standard_normal((2, 3))
    v = points - p
    rho = np.linalg.norm(np.cross(v, k), axis=1) / np.linalg.norm(k)
    for point, direction in [(p, k), (p + 7 * k, -3 * k)]:
        result = dx.cylindricity(points, point, direction)
        np.testing.assert_allclose(result.value, np.ptp(rho), rtol=1e-9)
        assert result.form.radius == pytest.approx(rho.mean())
    assert dx.cylindricity([(0, 0, 5), (0, 3, 0)], (0, 0, 0), (0, 0, 1)).value == 3


def test_algebraic_sphere_is_the_linear_fit():
    """|x|² = 2 c·x + k by ordinary least squares."""
    points = measured("sphere", np.random.default_rng(15), error=0.2)
    solution = np.linalg.lstsq(np.column_stack([2 * points, np.ones(len(points))]), (points**2).sum(axis=1), rcond=None)[0]
    expected = np.ptp(np.linalg.norm(points - solution[:3], axis=1))
    np.testing.assert_allclose(dx.sphericity(points, "algebraic").value, expected, rtol=1e-9)


@pytest.mark.parametrize("kind", CHECKS)
def test_result_can_be_drawn(kind):
    """The fitted form comes as a surface that passes the points at the distance of their residuals."""
    points = measured(kind, np.random.default_rng(16), n=60)
    result = CHECKS[kind](points)
    surface = result.surface()(np.linspace(0, 1, 40)[:, None], np.linspace(0, 1, 40)[None]).reshape(-1, 3)
    assert np.abs(result.form.distance(surface)).max() < 1e-9
    near = np.linalg.norm(points[:, None] - surface[None], axis=2).min(axis=1)
    assert near.max() < 0.15 * np.ptp(points, axis=0).max()
    assert result.residuals.shape == (60,)
    assert "60 points" in repr(result)


@pytest.mark.parametrize(("kind", "least"), [("plane", 4), ("sphere", 5), ("cylinder", 6), ("cone", 7), ("torus", 8)])
def test_too_few_points(kind, least):
    points = measured(kind, np.random.default_rng(17), n=least)
    assert CHECKS[kind](points).value >= 0
    with pytest.raises(ShapeError, match=f"n >= {least}"):
        CHECKS[kind](points[1:])


@pytest.mark.parametrize("kind", ["sphere", "cylinder", "cone", "torus"])
def test_flat_points_are_refused(kind):
    """A plane or a line has no best sphere, cylinder, cone or torus."""
    rng = np.random.default_rng(19)
    flat = rng.random((30, 2)) @ rng.standard_normal((2, 3)) + 5
    with pytest.raises(DegenerateError, match="in one plane"):
        CHECKS[kind](flat)
    with pytest.raises(DegenerateError, match="on a line"):
        CHECKS[kind](np.outer(rng.random(30), [1, 2, 3]) + 5)


@pytest.mark.parametrize("angle", [0.02, 0.1, 0.5])
def test_a_thin_arc_is_a_cylinder(angle):
    """A strip of a few degrees, in any position: axis and radius are found from its slight bend."""
    rng = np.random.default_rng(20)
    a, z = angle * rng.random(200), rng.random(200)
    points = np.stack([np.cos(a), np.sin(a), z * angle], axis=1) @ rotation(rng).T + 3
    result = dx.cylindricity(points)
    assert result.value < 1e-12
    assert result.form.radius == pytest.approx(1, rel=1e-5)


def test_nearly_flat_noise_is_not_rolled_up():
    """A rough plane: no cylinder or cone found for it is worse than the plane itself."""
    rng = np.random.default_rng(21)
    points = np.c_[rng.random((100, 2)), 1e-3 * rng.standard_normal(100)]
    for check in (dx.cylindricity, dx.conicity):
        assert check(points).rms <= dx.flatness(points).rms * (1 + 1e-6)


def test_few_exact_points_are_met():
    """As many points as a form has parameters: it passes through all of them."""
    rng = np.random.default_rng(18)
    for kind, fit, n in (("cylinder", fit_cylinder, 8), ("cone", fit_cone, 10), ("torus", fit_torus, 12)):
        points = measured(kind, rng, n=n)
        points = points - points.mean(axis=0)
        assert np.abs(fit(points).distance(points)).max() < 1e-9


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (lambda: dx.flatness(np.ones((9, 3))), GeometryError, "all the same"),
        (lambda: dx.flatness(np.eye(4)[:, :3], "best"), NumberError, "method must be one of 'least squares'"),
        (lambda: dx.flatness([(0, 0, np.nan)] * 5), NumberError, "finite"),
        (lambda: dx.sphericity(np.c_[np.random.default_rng(0).random((9, 2)), np.ones(9)]), DegenerateError, "in one plane"),
        (lambda: dx.cylindricity(np.eye(4)[:, :3], (0, 0, 0)), GeometryError, "both of shape"),
        (lambda: dx.cylindricity(np.eye(4)[:, :3], (0, 0, 0), (0, 0, 0)), DegenerateError, "axis_direction"),
    ],
)
def test_bad_input_is_named(make, error, message):
    with pytest.raises(error, match=message):
        make()
