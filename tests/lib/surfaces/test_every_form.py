"""One of each public surface: tangents, normal and curvatures against differences of its points and normals alone."""

import directrix as dx
import numpy as np
import pytest
from directrix.surfaces.surface import Surface

RNG = np.random.default_rng(11)
X, Y = np.meshgrid(np.arange(5.0), np.arange(4.0), indexing="ij")
NET = np.stack([X, Y, np.sin(X) + 0.3 * Y * Y], axis=-1) + 0.1 * RNG.random((5, 4, 3))
C0, C1 = (dx.BezierCurve([(0, y, 0), (1, y, z), (3, y, 1)]) for y, z in ((0, 2), (2, -1)))
D0, D1 = (dx.BezierCurve([(x, 0, z), (x, 1, z + 1), (x, 2, z)]) for x, z in ((0, 0), (3, 1)))
CORNERS = NET[:2, :2]
FORMS = [
    dx.Plane((0, 0, 0), (2, 0, 1), (0, 3, 1)), dx.Triangle((0, 0, 0), (2, 0, 1), (0, 3, 1)), dx.Cylinder(2, 5),
    dx.Cone(3, 1, 4), dx.Sphere(2), dx.Torus(3, 1), dx.LinearSweep(C0, (0, 1, 1), 2), dx.CircularSweep(C1, "x", 2.0),
    dx.GenericSweep(dx.Circle((0, 0, 0), 0.5, (1, 0, 0)), C0, "minimal"), dx.AlgebraicPatch(NET[:3]),
    dx.HermitePatch.of(CORNERS, 2 * CORNERS, 3 * CORNERS, CORNERS**2), dx.PointPatch(NET), dx.BezierPatch(NET),
    dx.BSplinePatch(NET, 4, 3), dx.NurbsPatch(NET, RNG.uniform(0.5, 2, (5, 4)), 3, 4),
    dx.Bilinear((0, 0, 0), (0, 2, 1), (3, 0, 1), (3, 2, 0)), dx.Ruled(C0, C1), dx.Coons(C0, C1, D0, D1, blend="cubic"),
    dx.Ferguson(CORNERS, [[(1, 0, 1)] * 2] * 2, [[(0, 1, -1)] * 2] * 2),
]  # fmt: skip
U, W = RNG.uniform(0.05, 0.95, (2, 60))
STEP = 1e-5  # central differences err by its square and by 1e-16 / STEP: relative 1e-10


def differences(f, u, w):
    along_u = (f(u + STEP, w) - f(u - STEP, w)) / (2 * STEP)
    along_w = (f(u, w + STEP) - f(u, w - STEP)) / (2 * STEP)
    return along_u, along_w


def test_no_public_surface_is_left_out():
    """The list above has one of every class that directrix names."""
    named = {
        name for name in dx.__all__ if isinstance(form := getattr(dx, name), type) and issubclass(form, Surface)
    }  # fmt: skip
    assert {type(form).__name__ for form in FORMS} == named - {"Surface"}


@pytest.mark.parametrize("form", FORMS, ids=lambda form: type(form).__name__)
def test_tangents_normals_and_curvatures(form):
    """S_u and S_w, their cross product, and the equations of Weingarten: n_u and n_w give the shape operator."""
    tangent_u, tangent_w = differences(form, U, W)
    size = np.abs(form(U, W)).max()
    assert form.derivative(U, W, 1, 0) == pytest.approx(tangent_u, abs=1e-7 * size)
    assert form.derivative(U, W, 0, 1) == pytest.approx(tangent_w, abs=1e-7 * size)
    cross = np.cross(tangent_u, tangent_w)
    normal = form.normal(U, W)
    assert normal == pytest.approx(cross / np.linalg.norm(cross, axis=-1, keepdims=True), abs=1e-6)

    normal_u, normal_w = differences(form.normal, U, W)
    frame = np.stack([tangent_u, tangent_w], axis=-1)
    shape = -np.linalg.pinv(frame) @ np.stack([normal_u, normal_w], axis=-1)
    found = form.curvature(U, W)
    allowed = 1e-5 * (1 + np.abs(found.k1) + np.abs(found.k2))
    assert (np.abs(np.trace(shape, axis1=-2, axis2=-1) / 2 - found.mean) <= allowed).all()
    assert (np.abs(np.linalg.det(shape) - found.gaussian) <= allowed * (1 + np.abs(found.k1) + np.abs(found.k2))).all()
    assert (found.k1 >= found.k2).all()
    assert found.k1 * found.k2 == pytest.approx(found.gaussian, abs=1e-9)
