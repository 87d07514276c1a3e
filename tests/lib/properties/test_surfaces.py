"""Properties of known forms, planes and sweeps over random sizes, axes and curves."""

import math

import directrix as dx
import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

SIZE = st.floats(0.01, 100)
POINT = arrays(float, 3, elements=st.floats(-8, 8, width=32))
NET = arrays(float, (4, 3), elements=st.floats(-8, 8, width=32))
U, W = np.linspace(0, 1, 7)[:, None], np.linspace(0, 1, 8)[None, :]


@given(SIZE)
def test_sphere_is_a_sphere(radius):
    """|S| = r, K = 1/r^2, k1 = k2 = 1/r, area 4 pi r^2, and its sweep."""
    sphere = dx.Sphere(radius)
    assert np.allclose(np.linalg.norm(sphere(U, W), axis=-1), radius, rtol=1e-14)
    bent = sphere.curvature(U, W)
    assert np.allclose(bent.gaussian * radius**2, 1, rtol=1e-6)
    assert np.allclose([bent.k1[1:-1] * radius, bent.k2[1:-1] * radius], 1, rtol=1e-12)
    assert math.isclose(sphere.area(), 4 * math.pi * radius**2, rel_tol=1e-10)
    assert np.allclose(sphere.swept()(U, W), sphere(U, W), rtol=0, atol=1e-14 * radius)


@given(st.floats(0, 100), SIZE)
def test_torus_is_a_torus(R, r):
    """(sqrt(x^2 + y^2) - R)^2 + z^2 = r^2 on the outer half; area 4 pi^2 R r of a ring; its sweep."""
    torus = dx.Torus(R, r)
    x, y, z = np.moveaxis(torus(U, W), -1, 0)
    outer = (R + r * np.cos(2 * np.pi * U) >= 0) & (W >= 0)
    assert np.allclose(((np.hypot(x, y) - R) ** 2 + z**2)[outer], r * r, rtol=1e-9, atol=1e-12 * (R + r) ** 2)
    assert np.allclose(torus.swept()(U, W), torus(U, W), rtol=0, atol=1e-14 * (R + r))
    if r <= R:
        assert math.isclose(torus.area(), 4 * math.pi**2 * R * r, rel_tol=1e-9)


@given(st.floats(0, 100), st.floats(0, 100), SIZE)
def test_cone_is_a_cone(r1, r2, height):
    """On its quadric, slant area, its sweep, K = 0; with equal radii the cylinder."""
    assume(max(r1, r2) > 0.01)
    cone, size = dx.Cone(r1, r2, height), r1 + r2 + height
    assert np.abs(cone.implicit()(cone(U, W))).max() <= 1e-13 * size**2 * (1 + ((r2 - r1) / height) ** 2)
    assert math.isclose(cone.area(), math.pi * (r1 + r2) * math.hypot(r2 - r1, height), rel_tol=1e-9)
    assert np.allclose(cone.swept().swap()(U, W), cone(U, W), rtol=0, atol=1e-14 * size)
    assert np.allclose(
        dx.Cone(r1 or 1, r1 or 1, height)(U, W), dx.Cylinder(r1 or 1, height)(U, W), rtol=0, atol=1e-14 * (size + 1)
    )


@given(POINT, POINT, POINT)
def test_plane_and_triangle(p1, p2, p3):
    """Flat, with the triangle half of the parallelogram, or refused."""
    try:
        plane, triangle = dx.Plane(p1, p2, p3), dx.Triangle(p1, p2, p3)
    except dx.DegenerateError:
        spread = np.cross(p2 - p1, p3 - p1)
        assert np.linalg.norm(spread) <= 1e-11 * np.linalg.norm(p2 - p1) * np.linalg.norm(p3 - p1)
        return
    assume(np.linalg.norm(np.cross(p2 - p1, p3 - p1)) > 1e-6)  # beside coordinates of size 1: less would be rounding
    n = plane.normal(0.5, 0.5)
    assert np.abs((triangle(U, W) - p1) @ n).max() <= 1e-9 * (1 + np.abs([p1, p2, p3]).max())
    assert math.isclose(triangle.area(), plane.area() / 2, rel_tol=1e-9)


@given(NET, POINT, st.floats(-20, 20))
def test_linear_sweep_two_ways(net, direction, distance):
    """By direction and distance, by two points anywhere, and as a generic sweep along a line: one surface."""
    assume(np.abs(direction).max() > 0.01 and abs(distance) > 0.01)
    curve = dx.BezierCurve(net)
    one = dx.LinearSweep(curve, direction, distance)
    anchor = np.array([1.0, -2, 3])
    two = dx.LinearSweep.between(curve, anchor, anchor + one.vector)
    three = dx.GenericSweep(curve, dx.Line(anchor, anchor + one.vector))
    assert np.allclose(one(U, W), two(U, W), rtol=0, atol=1e-12)
    assert np.allclose(one(U, W), three(U, W), rtol=0, atol=1e-12)
    assert np.allclose(one(U, 0.0), curve(U), rtol=0, atol=0)


@given(NET, POINT, POINT, st.floats(-7, 7))
def test_circular_sweep_about_any_axis_is_rigid(net, point, direction, angle):
    """Every section is the generatrix turned: w = 1 is the rotation by the whole angle, and the surface closes on itself."""
    assume(np.abs(direction).max() > 0.01)
    curve = dx.BezierCurve(net)
    sweep = dx.CircularSweep.about(curve, point, direction, angle)
    assert np.allclose(sweep(U, 1.0), dx.Transform.rotate(direction, angle, point) @ curve(U), rtol=0, atol=1e-12)
    assert np.allclose(sweep(U, 0.0), curve(U), rtol=0, atol=1e-13)
    half = dx.CircularSweep.about(curve, point, direction, angle / 2)
    assert np.allclose(half(U, W), sweep(U, W / 2), rtol=0, atol=1e-12)


@given(NET, POINT, POINT, st.floats(-7, 7))
def test_sweeping_commutes_with_moving(net, point, direction, angle):
    """Moving curve and axis together moves the sweep."""
    assume(np.abs(direction).max() > 0.01)
    move = dx.Transform.rotate((1, 2, 3), 1.0, (1, 1, 1)) @ dx.Transform.translate((1, -2, 0.5))
    curve = dx.BezierCurve(net)
    moved = dx.CircularSweep.about(move @ curve, move @ point, move.vectors(direction), angle)
    assert np.allclose(moved(U, W), (move @ dx.CircularSweep.about(curve, point, direction, angle))(U, W), rtol=0, atol=1e-11)


@given(NET, NET, st.sampled_from(["fixed", "frenet", "minimal"]), st.floats(0, 2))
def test_generic_sweep_keeps_its_section(generatrix, directrix, frame, taper):
    """Distances within a section are scaled by 1 + (taper - 1) w and nothing else, whatever the frame; or no frame exists."""
    try:
        sweep = dx.GenericSweep(dx.BezierCurve(generatrix), dx.BezierCurve(directrix), frame, taper=taper)
        points = sweep(U, W)
    except dx.DegenerateError:
        assert frame != "fixed"
        return
    apart = np.linalg.norm(points[1:] - points[:1], axis=-1)
    scale = 1 + (taper - 1) * W
    assert np.allclose(apart, scale * apart[:, :1], rtol=0, atol=1e-9)
    assert np.allclose(sweep(U, 0.0), dx.BezierCurve(generatrix)(U), rtol=0, atol=1e-12)


@given(
    st.sampled_from(
        [dx.Sphere(2), dx.Torus(3, 1), dx.Torus(1, 1), dx.Cone(2, 0, 3), dx.Triangle((0, 0, 0), (1, 0, 0), (0, 1, 0))]
    ),
    st.data(),
)
def test_normals_are_never_nan(surface, data):
    """At, near and just outside poles and seams: unit length or exactly zero, and continuous towards a pole."""
    edge = st.sampled_from([0.0, 1.0, 0.5, 1e-300, 1e-15, 1e-9, 1e-5, 1 - 1e-16, 1 - 1e-12, 1 + 1e-13, -1e-13])
    u, w = data.draw(st.one_of(edge, st.floats(0, 1))), data.draw(st.one_of(edge, st.floats(0, 1)))
    length = np.linalg.norm(surface.normal(u, w))
    assert abs(length - 1) < 1e-12
