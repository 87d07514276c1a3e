"""Form errors of few points, partial arcs and noise; and kinds of quadrics, wherever they lie and in any unit."""

import directrix as dx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

FORMS = {
    "flatness": dx.Plane((0, 0, 0), (4, 0, 0), (0, 3, 0)), "cylindricity": dx.Cylinder(2, 3), "conicity": dx.Cone(2, 1, 3),
    "sphericity": dx.Sphere(2), "toricity": dx.Torus(3, 1),
}  # fmt: skip
SEED = st.integers(0, 2**32 - 1)


def moved(rng, unit=1.0, far=5.0):
    """A rigid motion, and then a change of unit."""
    turn = dx.Transform.rotate(rng.standard_normal(3), rng.uniform(0, 6))
    return dx.Transform.scale(unit) @ dx.Transform.translate(far * rng.standard_normal(3)) @ turn


@pytest.mark.parametrize("name", FORMS)
@settings(max_examples=8)
@given(SEED, st.integers(16, 60), st.floats(0.3, 1.0), st.sampled_from([1e-3, 1e-2]), st.sampled_from([1e-6, 1.0, 1e6]))
def test_the_zone_is_no_wider_than_that_of_least_squares(name, seed, n, turn, noise, unit):
    """Few points on a part of the form, with noise, moved anywhere, in any unit: the minimum zone is the narrower one, both are
    at most as wide as the noise (about the true form), and all points lie in it."""
    rng = np.random.default_rng(seed)
    form, measure = FORMS[name], getattr(dx, name)
    u, w = (turn * rng.random(n), rng.random(n)) if name != "sphericity" else (rng.random(n), turn * rng.random(n))
    off = noise * rng.uniform(-1, 1, n)
    points = moved(rng, unit) @ (form(u, w) + off[:, None] * form.normal(u, w))
    squares, zone = measure(points), measure(points, method="minimum zone")
    assert zone.value <= squares.value * (1 + 1e-9)
    assert zone.value <= np.ptp(off) * unit * (1 + 1e-6)
    assert squares.rms <= zone.rms * (1 + 1e-6)
    assert np.ptp(zone.residuals) == pytest.approx(zone.value, rel=1e-9)
    assert squares.residuals.shape == (n,)


KINDS = {
    "ellipsoid": (1, 1 / 4, 1 / 9, 0, 0, 0, 0, 0, 0, -1), "hyperboloid of one sheet": (1, 1 / 4, -1 / 9, 0, 0, 0, 0, 0, 0, -1),
    "hyperboloid of two sheets": (1, 1 / 4, -1 / 9, 0, 0, 0, 0, 0, 0, 1), "cone": (1, 1 / 4, -1 / 9, 0, 0, 0, 0, 0, 0, 0),
    "elliptic paraboloid": (1, 1 / 4, 0, 0, 0, 0, 0, 0, -2, 0), "hyperbolic paraboloid": (1, -1 / 4, 0, 0, 0, 0, 0, 0, -2, 0),
    "elliptic cylinder": (1, 1 / 4, 0, 0, 0, 0, 0, 0, 0, -1), "hyperbolic cylinder": (1, -1 / 4, 0, 0, 0, 0, 0, 0, 0, -1),
    "parabolic cylinder": (1, 0, 0, 0, 0, 0, 0, -2, 0, 0), "intersecting planes": (1, -1 / 4, 0, 0, 0, 0, 0, 0, 0, 0),
    "parallel planes": (1, 0, 0, 0, 0, 0, 0, 0, 0, -1), "coincident planes": (1, 0, 0, 0, 0, 0, 0, 0, 0, 0),
    "line": (1, 1 / 4, 0, 0, 0, 0, 0, 0, 0, 0), "point": (1, 1 / 4, 1 / 9, 0, 0, 0, 0, 0, 0, 0),
    "empty": (1, 1 / 4, 1 / 9, 0, 0, 0, 0, 0, 0, 1),
}  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
@given(SEED, st.floats(-6, 6), st.floats(-6, 6), st.sampled_from([-1, 1]), st.floats(0, 30))
def test_a_quadric_keeps_its_kind(kind, seed, unit, factor, sign, far):
    """Any rigid motion, any unit from 1e-6 to 1e6, any factor of the equation: the same kind, and the same frame moved."""
    rng = np.random.default_rng(seed)
    move = moved(rng, 10**unit, far)
    quadric = move @ dx.Quadric(*KINDS[kind])
    found = dx.Quadric(*(sign * 10**factor * quadric.coefficients)).classify()
    assert found.kind == kind
    if kind in ("ellipsoid", "hyperboloid of one sheet", "hyperboloid of two sheets"):
        np.testing.assert_allclose(sorted(found.radii), np.array([1, 2, 3]) * 10**unit, rtol=1e-6)
        np.testing.assert_allclose(found.center, move @ np.zeros(3), atol=1e-6 * 10**unit)
