"""Hyperpatches: printed values, faces, outward normals, volumes known in closed form, and the tensor sums written out."""

import directrix as dx
import numpy as np
import pytest
from directrix.basis import bernstein, hermite
from directrix.errors import DomainError, OrderError, ShapeError, WeightError
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import NdBSpline

seeds = st.integers(0, 2**32 - 1)
fixed = settings(derandomize=True, max_examples=25, deadline=None)
T3 = np.linspace(0, 1, 4)


def lattice(l, m, n):  # noqa: E741
    """A right-handed block of control points, l x m x n, of size 3 x 4 x 5."""
    axes = np.meshgrid(np.linspace(0, 3, l), np.linspace(0, 4, m), np.linspace(0, 5, n), indexing="ij")
    return np.stack(axes, axis=-1)


def four_solids(rng, wobble=0.2):
    """One solid of each form, near a block so that it does not fold."""
    net = lattice(4, 3, 5) + wobble * rng.uniform(-1, 1, (4, 3, 5, 3))
    weights = rng.uniform(0.7, 1.4, (4, 3, 5))
    G = np.zeros((4, 4, 4, 3))
    for axis, size in enumerate((3.0, 4.0, 5.0)):
        shape = [slice(0, 2)] * 3
        for entry in (1, 2, 3):
            shape[axis] = entry
            G[(*shape, axis)] = size
    G = G + wobble * rng.uniform(-1, 1, G.shape)
    return [
        dx.HermiteHyperpatch(G),
        dx.BezierHyperpatch(net),
        dx.BSplineHyperpatch(net, 3, 2, 4),
        dx.NurbsHyperpatch(net, weights, 3, 3, 3, knots_u=[0, 0, 0, 0.3, 2, 2, 2]),
    ]


def test_exact_points():
    """Whole control points at dyadic parameters: the sum Σ B B B P written out with fractions, exactly."""
    net = np.arange(4 * 4 * 4 * 3.0).reshape(4, 4, 4, 3) % 7
    solid = dx.BezierHyperpatch(net)
    b = np.array([1, 3, 3, 1]) / 8
    assert solid(0.5, 0.5, 0.5).tolist() == np.einsum("i,j,k,ijkc->c", b, b, b, net).tolist()
    assert solid([0, 1], [0, 1], [0, 1]).tolist() == [net[0, 0, 0].tolist(), net[3, 3, 3].tolist()]


@fixed
@given(seeds)
def test_sums_written_out(seed):
    """Hermite and Bezier solids against the triple sum by einsum, B-spline and NURBS against scipy on lifted points."""
    rng = np.random.default_rng(seed)
    hermite_solid, bezier, spline, nurbs = four_solids(rng)
    u, v, w = rng.random((3, 6))
    F = [hermite(t) for t in (u, v, w)]
    np.testing.assert_allclose(hermite_solid(u, v, w), np.einsum("pi,pj,pk,ijkc->pc", *F, hermite_solid.G), atol=1e-12)
    B = [bernstein(d, t) for d, t in zip(bezier.degrees, (u, v, w), strict=True)]
    np.testing.assert_allclose(bezier(u, v, w), np.einsum("pi,pj,pk,ijkc->pc", *B, bezier.control_net), atol=1e-12)
    for solid in (spline, nurbs):
        weights = getattr(solid, "weights", np.ones(solid.control_net.shape[:3]))[..., None]
        lifted = np.concatenate([solid.control_net * weights, weights], axis=-1)
        t = np.stack([k.stretch(x) for k, x in zip(solid.knot_vectors, (u, v, w), strict=True)], axis=-1)
        plain = NdBSpline(tuple(k.values for k in solid.knot_vectors), lifted, solid.degrees)(t)
        np.testing.assert_allclose(solid(u, v, w), plain[:, :3] / plain[:, 3:], atol=1e-12)


@fixed
@given(seeds)
def test_grid_scattered_and_shapes(seed):
    """A grid, scattered points and single points give the same, in every shape that broadcasts."""
    rng = np.random.default_rng(seed)
    for solid in four_solids(rng):
        u, v, w = rng.random(4), rng.random(3), rng.random(5)
        grid = solid(u[:, None, None], v[None, :, None], w)
        assert grid.shape == (4, 3, 5, 3)
        flat = solid(*(x.ravel() for x in np.meshgrid(u, v, w, indexing="ij")))
        np.testing.assert_allclose(flat.reshape(grid.shape), grid, atol=1e-12)
        np.testing.assert_allclose(solid(u[1], v[2], w[3]), grid[1, 2, 3], atol=1e-12)
        assert solid(0.5, v, 0.5).shape == (3, 3)
        assert solid([], 0.5, 0.5).shape == (0, 3)


@fixed
@given(seeds)
def test_derivatives_are_derivatives(seed):
    """Central differences of the form itself, in all three parameters."""
    rng = np.random.default_rng(seed)
    h = 1e-5
    for solid in four_solids(rng):
        u, v, w = rng.uniform(0.2, 0.8, 3)
        for axis, order in enumerate(np.eye(3, dtype=int)):
            step = h * np.eye(3)[axis]
            for base in [(0, 0, 0), (1, 1, 0), (0, 1, 1)]:
                above = solid.derivative(*(np.array([u, v, w]) + step), *base)
                below = solid.derivative(*(np.array([u, v, w]) - step), *base)
                exact = solid.derivative(u, v, w, *(int(a + b) for a, b in zip(order, base, strict=True)))
                np.testing.assert_allclose(exact, (above - below) / (2 * h), atol=2e-5)
        jacobian = np.linalg.det(np.stack([solid.derivative(u, v, w, *(int(x) for x in e)) for e in np.eye(3, dtype=int)]))
        np.testing.assert_allclose(solid.jacobian(u, v, w), jacobian, rtol=1e-12)


@fixed
@given(seeds)
def test_faces_are_the_boundary_and_point_outward(seed):
    """Six patches of the solid's own kind in the order u=0, u=1, v=0, v=1, w=0, w=1; their normals leave the solid."""
    rng = np.random.default_rng(seed)
    kinds = [dx.HermitePatch, dx.BezierPatch, dx.BSplinePatch, dx.NurbsPatch]
    for solid, kind in zip(four_solids(rng), kinds, strict=True):
        for mirrored in (False, True):
            form = dx.Transform.reflect("x") @ solid if mirrored else solid
            assert (form.signed_volume() < 0) is mirrored
            a, b = rng.random((2, 5))
            for i, (plain, outward) in enumerate(zip(form.faces(outward=False), form.faces(), strict=True)):
                axis, end = divmod(i, 2)
                at = [a, b]
                at.insert(axis, np.full(5, float(end)))
                np.testing.assert_allclose(plain(a, b), form(*at), atol=1e-12)
                assert type(plain) is type(outward) is kind
                middle = outward(0.5, 0.5) - form(0.5, 0.5, 0.5)
                assert outward.normal(0.5, 0.5) @ middle > 0


def test_volume_of_a_block_and_of_its_images():
    """An affine image has |det| times the volume; polynomial quadrature is exact."""
    block = dx.BezierHyperpatch(lattice(3, 4, 2))
    assert block.volume() == pytest.approx(60, rel=1e-14)
    T = dx.Transform.of([[1, 2, 0], [0, 1, 3], [1, 0, -2]], (1, 2, 3))
    assert (T @ block).volume() == pytest.approx(60 * abs(np.linalg.det(T.linear)), rel=1e-13)
    assert (T @ block).signed_volume() == pytest.approx(60 * np.linalg.det(T.linear), rel=1e-13)


@fixed
@given(seeds)
def test_volume_is_the_flux_through_the_faces(seed):
    """Gauss: the volume is a third of the flux of x through the six outward faces, by quadrature of the patches alone."""
    rng = np.random.default_rng(seed)
    x, weights = np.polynomial.legendre.leggauss(16)
    x, weights = (x + 1) / 2, weights / 2
    for solid in four_solids(rng):
        flux = 0.0
        for face in solid.faces():
            for u0, u1 in zip(face.breaks()[0][:-1], face.breaks()[0][1:], strict=True):
                for w0, w1 in zip(face.breaks()[1][:-1], face.breaks()[1][1:], strict=True):
                    u, w = (u0 + (u1 - u0) * x)[:, None], (w0 + (w1 - w0) * x)[None]
                    area = np.cross(face.derivative(u, w, 1, 0), face.derivative(u, w, 0, 1))
                    flux += (face(u, w) * area).sum(axis=2) @ weights @ weights * (u1 - u0) * (w1 - w0)
        np.testing.assert_allclose(solid.volume(), flux / 3, rtol=1e-9)


def test_exact_quarter_cylinder_solid():
    """A rational solid with known volume: a quarter of a tube, radii 1 and 3, height 2, volume π (9 - 1)/4 · 2."""
    s = np.sqrt(0.5)
    arc = np.array([(1, 0), (1, 1), (0, 1)])
    net = np.array([[[(*(r * q), z) for z in (0, 2)] for q in arc] for r in (1, 3)], dtype=float)
    weights = np.ones((2, 3, 2))
    weights[:, 1] = s
    tube = dx.NurbsHyperpatch(net, weights, 2, 3, 2)
    assert tube.volume() == pytest.approx(np.pi * 8 / 4 * 2, rel=1e-12)
    points = tube(1, np.linspace(0, 1, 9), 0.5)
    np.testing.assert_allclose(np.hypot(points[:, 0], points[:, 1]), 3, rtol=1e-15)


def test_periodic_and_unclamped_knots():
    """A closed ring and a solid whose knots are not clamped: faces are still where the parameter is 0 or 1."""
    a = 2 * np.pi * np.arange(6) / 6
    ring = np.array([[[(r * np.cos(x), r * np.sin(x), z) for z in (0, 1)] for x in a] for r in (1, 2)])
    solid = dx.BSplineHyperpatch(ring, 2, 3, 2, knots_v="periodic")
    np.testing.assert_allclose(solid(0.3, 0, 0.2), solid(0.3, 1, 0.2), atol=1e-14)
    soft = dx.BSplineHyperpatch(lattice(5, 4, 4), 3, 3, 3, "uniform", "uniform", "uniform")
    for solid in (solid, soft):  # noqa: B020
        for i, face in enumerate(solid.faces(outward=False)):
            at = [0.25, 0.75]
            at.insert(i // 2, i % 2)
            np.testing.assert_allclose(face(0.25, 0.75), solid(*at), atol=1e-13)


@fixed
@given(seeds)
def test_affine_maps_commute(seed):
    rng = np.random.default_rng(seed)
    T = dx.Transform.of(rng.standard_normal((3, 3)), rng.standard_normal(3))
    for solid in four_solids(rng):
        moved = T @ solid
        assert type(moved) is type(solid)
        np.testing.assert_allclose(moved(T3, T3[::-1], 0.3), T @ solid(T3, T3[::-1], 0.3), atol=1e-12)


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (lambda: dx.BezierHyperpatch(np.zeros((64, 3))), ShapeError, r"\(l, m, n, 3\).*reshape\(4, 4, 4, 3\)"),
        (lambda: dx.BezierHyperpatch(np.zeros((4, 4, 1, 3))), ShapeError, "l, m, n >= 2"),
        (lambda: dx.HermiteHyperpatch(np.zeros((4, 4, 3))), ShapeError, r"G must have shape \(4, 4, 4, 3\)"),
        (
            lambda: dx.BSplineHyperpatch(lattice(4, 4, 4), 4, 5, 4),
            OrderError,
            "kv must be at most the number",
        ),
        (
            lambda: dx.NurbsHyperpatch(lattice(2, 2, 2), np.ones((2, 2)), 2, 2, 2),
            ShapeError,
            r"weights must have shape \(2, 2, 2\)",
        ),
        (lambda: dx.NurbsHyperpatch(lattice(2, 2, 2), np.zeros((2, 2, 2)), 2, 2, 2), WeightError, "greater than 0"),
        (lambda: dx.BezierHyperpatch(lattice(2, 2, 2))(0, 2, 0), DomainError, r"v must lie in \[0, 1\]"),
        (lambda: dx.BezierHyperpatch(lattice(2, 2, 2))(np.zeros(2), np.zeros(3), 0), ShapeError, "broadcast"),
        (lambda: dx.BezierHyperpatch(lattice(2, 2, 2)).derivative(0, 0, 0, 0, -1, 0), OrderError, "nv must be a whole number"),
    ],
)
def test_bad_input_is_named(make, error, message):
    with pytest.raises(error, match=message):
        make()
