"""The known forms: the syllabus' numbers, both guises, and the geometry that makes them what they are."""

import math

import directrix as dx
import numpy as np
import pytest
from scipy.integrate import quad

U, W = np.linspace(0, 1, 17)[:, None], np.linspace(0, 1, 13)[None, :]
PI = math.pi


@pytest.mark.parametrize(
    ("surface", "at", "point"),
    [
        (dx.Cylinder(2, 5), (0.25, 0.4), (0, 2, 2)),
        (dx.Cylinder(2, 5), (0.1, 0.5), (1.61803399, 1.1755705, 2.5)),
        (dx.Cone(3, 1, 4), (0.25, 0.5), (0, 2, 2)),
        (dx.Cone(3, 1, 4), (0.125, 0.25), (1.76776695, 1.76776695, 1)),
        (dx.Sphere(2), (0.75, 0.125), (1, 1, 1.41421356)),
        (dx.Sphere(2), (0.5, 0.25), (0, 2, 0)),
        (dx.Torus(3, 1), (0, 0.25), (0, 4, 0)),
        (dx.Torus(3, 1), (0.125, 0.5), (-3.70710678, 0, 0.707106781)),
    ],
)
def test_the_numbers_of_the_syllabus(surface, at, point):
    """Printed to nine digits."""
    assert np.allclose(surface(*at), point, rtol=0, atol=5e-9)


def formulas():
    """Each form with its formula written out once more, in plain numpy."""
    phi, theta = PI * (U - 0.5), 2 * PI * W
    yield dx.Cylinder(2, -5), (2 * np.cos(2 * PI * U), 2 * np.sin(2 * PI * U), -5 * W)
    rho = 3 + (0.5 - 3) * W
    yield dx.Cone(3, 0.5, 4), (rho * np.cos(2 * PI * U), rho * np.sin(2 * PI * U), 4 * W)
    yield dx.Sphere(2), (2 * np.cos(phi) * np.cos(theta), 2 * np.cos(phi) * np.sin(theta), 2 * np.sin(phi))
    rho = 3 + 1.5 * np.cos(2 * PI * U)
    yield dx.Torus(3, 1.5), (rho * np.cos(theta), rho * np.sin(theta), 1.5 * np.sin(2 * PI * U))


@pytest.mark.parametrize(("surface", "formula"), list(formulas()))
def test_the_formula_of_the_lecture(surface, formula):
    """To the rounding of pi in the formula."""
    assert np.allclose(surface(U, W), np.stack(np.broadcast_arrays(*formula), -1), rtol=0, atol=5e-15)


@pytest.mark.parametrize("surface", [dx.Sphere(2), dx.Torus(3, 1), dx.Torus(1, 1), dx.Torus(1, 2), dx.Torus(0, 2)])
def test_circle_on_circle_is_the_same_map(surface):
    """Sphere and torus: the sweep is the formula, point for point."""
    assert np.allclose(surface.swept()(U, W), surface(U, W), rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    "surface", [dx.Cylinder(2, 5), dx.Cylinder(2, -5), dx.Cone(3, 1, 4), dx.Cone(3, 0, 4), dx.Cone(0, 3, 4)]
)
def test_line_on_circle_exchanges_u_and_w(surface):
    """Cylinder and cone: a line turned has u along the line and w round."""
    assert np.allclose(surface.swept()(W, U), surface(U, W), rtol=0, atol=1e-15)
    assert np.allclose(surface.swept().swap()(U, W), surface(U, W), rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    "surface", [dx.Cylinder(2, 5), dx.Cylinder(1, -3), dx.Cone(3, 1, 4), dx.Cone(0, 3, 4), dx.Sphere(2), dx.Torus(0, 2)]
)
def test_every_point_satisfies_the_implicit_form(surface):
    """To rounding of the squares."""
    assert np.abs(surface.implicit()(surface(U, W))).max() < 1e-13


def test_which_quadric_each_form_is():
    """By the classifier, which knows nothing of the forms."""
    kinds = [form.implicit().classify().kind for form in (dx.Cylinder(2, 5), dx.Cone(3, 1, 4), dx.Cone(2, 2, 4), dx.Sphere(2))]
    assert kinds == ["elliptic cylinder", "cone", "elliptic cylinder", "ellipsoid"]


def test_a_torus_is_no_quadric_unless_it_is_a_sphere():
    """The message gives its equation of degree four, which its points satisfy."""
    with pytest.raises(dx.ConversionError, match=r"a torus with R = 3 is no quadric but a surface of degree four"):
        dx.Torus(3, 1).implicit()
    x, y, z = np.moveaxis(dx.Torus(3, 1)(U, W), -1, 0)
    assert np.allclose((x**2 + y**2 + z**2 + 9 - 1) ** 2, 4 * 9 * (x**2 + y**2), rtol=1e-13)


@pytest.mark.parametrize(
    ("surface", "area"),
    [
        (dx.Cylinder(2, 5), 2 * PI * 2 * 5),
        (dx.Cone(3, 1, 4), PI * (3 + 1) * math.hypot(2, 4)),
        (dx.Cone(3, 0, 4), PI * 3 * 5),
        (dx.Sphere(2), 4 * PI * 4),
        (dx.Torus(3, 1), 4 * PI**2 * 3),
        (dx.Torus(1, 1), 4 * PI**2),
        (dx.Torus(0, 2), 2 * 4 * PI * 4),  # the sphere, covered twice
    ],
)
def test_areas(surface, area):
    """Closed forms."""
    assert surface.area() == pytest.approx(area, rel=1e-10)


def test_the_area_of_a_spindle_counts_the_lemon_inside():
    """|R + r cos phi| has a kink; scipy's one-dimensional quadrature is the oracle."""
    oracle = quad(lambda t: 2 * PI * abs(1 + 2 * math.cos(t)) * 2, 0, 2 * PI, points=[2 * PI / 3, 4 * PI / 3], epsabs=1e-12)[0]
    assert dx.Torus(1, 2).area() == pytest.approx(oracle, rel=1e-10)


def test_normals_point_where_the_docs_say():
    """Sphere and torus inward, cylinder and cone outward; a cylinder downwards inward."""
    p = dx.Sphere(2)(U, W)
    assert np.allclose(dx.Sphere(2).normal(U, W), -p / 2, atol=1e-12)
    axis = np.stack(np.broadcast_arrays(3 * np.cos(2 * PI * W), 3 * np.sin(2 * PI * W), 0 * U), -1)
    assert np.allclose(dx.Torus(3, 1).normal(U, W), axis - dx.Torus(3, 1)(U, W), atol=1e-12)
    out = dx.Cylinder(2, 5)(U, W) * (0.5, 0.5, 0)
    assert np.allclose(dx.Cylinder(2, 5).normal(U, W), out, atol=1e-12)
    assert np.allclose(dx.Cylinder(2, -5).normal(U, W), -out, atol=1e-12)
    assert (dx.Cone(3, 1, 4).normal(U, W) * out).sum(-1).min() > 0


def test_poles_have_the_limit_normal_exactly():
    """Along the whole collapsed edge, whatever w; also on the sweep and on a patch that begins there."""
    for sphere in (dx.Sphere(2), dx.Sphere(2).swept(), dx.Sphere(2).patch(0, 0.5, 0, 1)):
        assert np.allclose(sphere.normal(0.0, W[0]), [0, 0, 1], atol=1e-14)
    assert np.allclose(dx.Sphere(2).normal(1.0, W[0]), [0, 0, -1], atol=1e-14)
    assert (dx.Sphere(2)(0.0, W[0]) == [0, 0, -2]).all()


def test_an_apex_has_one_normal_for_each_ruling():
    """The limit in the square of parameters exists at each (u, 1) and is the normal all along that ruling."""
    cone = dx.Cone(3, 0, 4)
    assert np.allclose(cone.normal(U[:, 0], 1.0), cone.normal(U[:, 0], 0.5), atol=1e-14)
    assert np.isnan(cone.curvature(0.3, 1.0).k2)  # 1/radius grows without bound


def test_a_horn_torus_at_its_pinch():
    """S_w vanishes with its first derivative; the normal's limit is that of the tube, extrapolated to about 1e-7."""
    assert np.allclose(dx.Torus(1, 1).normal(0.5, 0.25), [0, 1, 0], atol=1e-6)


def test_a_spindle_torus_on_its_axis():
    """Where R + r cos phi changes sign the normal turns round: no limit."""
    u = math.acos(-0.5) / (2 * PI)
    assert dx.Torus(1, 2).normal(u, 0.25).tolist() == [0, 0, 0]
    below, above = dx.Torus(1, 2).normal([u - 1e-3, u + 1e-3], 0.25)
    assert below @ above < -0.99


@pytest.mark.parametrize(
    ("surface", "k1", "k2"),
    [(dx.Cylinder(2, 5), 0, -0.5), (dx.Cylinder(2, -5), 0.5, 0), (dx.Sphere(2), 0.5, 0.5), (dx.Sphere(2).flip_u(), -0.5, -0.5)],
)
def test_constant_curvatures(surface, k1, k2):
    """Positive where the surface bends towards its normal, k1 >= k2; at the poles too."""
    bent = surface.curvature(U, W)
    assert np.allclose(bent.k1, k1, atol=1e-6)
    assert np.allclose(bent.k2, k2, atol=1e-6)
    assert np.allclose(bent.gaussian[3:-3], k1 * k2, atol=1e-12)


def test_curvature_of_the_torus():
    """1/r along the tube, cos phi / (R + r cos phi) round the axis, towards the inward normal."""
    phi = 2 * PI * U + 0 * W
    round_axis = np.cos(phi) / (3 + np.cos(phi))
    bent = dx.Torus(3, 1).curvature(U, W)
    assert np.allclose(bent.k1, 1, atol=1e-12)
    assert np.allclose(bent.k2, round_axis, atol=1e-12)


@pytest.mark.parametrize(("R", "r", "kind"), [(3, 1, "ring"), (1, 1, "horn"), (0.5, 1, "spindle"), (0, 1, "sphere")])
def test_when_a_torus_is_a_sphere(R, r, kind):
    """R to the centre of the tube: equal radii make a horn; the sphere needs R = 0."""
    assert dx.Torus(R, r).kind == kind
    away = np.linalg.norm(dx.Torus(R, r)(U, W), axis=-1)
    assert (np.ptp(away) < 1e-14) == (kind == "sphere")


def test_closed_forms_close_bit_for_bit():
    """u = 0 and u = 1, or w = 0 and w = 1, are the same numbers."""
    for surface in (dx.Cylinder(2, 5), dx.Cone(3, 1, 4), dx.Torus(3, 1)):
        assert np.array_equal(surface(0.0, W[0]), surface(1.0, W[0]))
    for surface in (dx.Sphere(2), dx.Torus(3, 1)):
        assert np.array_equal(surface(U[:, 0], 0.0), surface(U[:, 0], 1.0))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: dx.Cylinder(0, 1), "radius must be greater than 0; got 0"),
        (lambda: dx.Cylinder(-1, 1), "radius must be greater than 0; got -1"),
        (lambda: dx.Cylinder(1, 0), "height must not be 0"),
        (lambda: dx.Cylinder(1, math.nan), "height must be finite"),
        (lambda: dx.Cylinder([1, 2], 3), "radius must be one number"),
        (lambda: dx.Cylinder("1m", 3), "radius must be real numbers; got '1m'"),
        (lambda: dx.Cone(-1, 1, 1), "r1 must be at least 0"),
        (lambda: dx.Cone(1, -1, 1), "r2 must be at least 0"),
        (lambda: dx.Cone(0, 0, 1), "r1 and r2 must not both be 0: that is a line"),
        (lambda: dx.Cone(1, 1, 0), "height must be greater than 0"),
        (lambda: dx.Cone(1, 1, -2), "height must be greater than 0"),
        (lambda: dx.Sphere(0), "radius must be greater than 0"),
        (lambda: dx.Torus(-1, 1), "R must be at least 0"),
        (lambda: dx.Torus(1, 0), "r must be greater than 0"),
    ],
)
def test_refused(call, message):
    """Neighbours (height -1, one radius 0, R = 0) are used all through this file."""
    with pytest.raises(dx.GeometryError, match=message):
        call()
