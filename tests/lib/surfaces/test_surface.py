"""What every surface must do, asked of the known forms, planes and sweeps: shapes, meshes, derivatives, poles, cutting."""

import directrix as dx
import numpy as np
import pytest
from directrix.differential import numeric_derivative
from directrix.surfaces.surface import Surface

PROFILE = dx.BezierCurve([(2, 0, -1), (3, 0, 0), (1, 1, 1), (2, 0, 2)])
PATH = dx.BezierCurve([(0, 0, 0), (1, 3, 1), (4, 3, -2), (5, 0, 3)])
SURFACES = {
    "cylinder": dx.Cylinder(2, 5),
    "cylinder down": dx.Cylinder(2, -5),
    "frustum": dx.Cone(3, 1, 4),
    "cone": dx.Cone(3, 0, 4),
    "sphere": dx.Sphere(2),
    "torus": dx.Torus(3, 1),
    "spindle": dx.Torus(1.25, 2),
    "plane": dx.Plane((1, 2, 0), (4, 1, 2), (0, 5, 3)),
    "triangle": dx.Triangle((1, 2, 0), (4, 1, 2), (0, 5, 3)),
    "linear sweep": dx.LinearSweep(PROFILE, (1, 2, 2), 6),
    "about y": dx.CircularSweep(PROFILE, "y", 2.0),
    "about any axis": dx.CircularSweep.about(PROFILE, (1, 0, -1), (1, 2, 2), -4.0),
    "translational": dx.GenericSweep(PROFILE, PATH),
    "tapered": dx.GenericSweep(PROFILE, PATH, taper=0.25),
    "frenet": dx.GenericSweep(PROFILE, PATH, "frenet"),
    "minimal": dx.GenericSweep(PROFILE, PATH, "minimal", taper=2),
    "moved": dx.Transform.rotate((1, 1, 0), 1.0) @ dx.Torus(3, 1),
    "patch": dx.Torus(3, 1).patch(0.75, 0.25, 0.1, 0.6),
    "swapped": dx.Cone(3, 1, 4).swap(),
}
EVERY = pytest.mark.parametrize("surface", [pytest.param(surface, id=name) for name, surface in SURFACES.items()])
G = np.linspace(0, 1, 7)


@EVERY
def test_shapes(surface):
    """np.broadcast_shapes(u.shape, w.shape) + (3,), float64, scalars (3,), empty (0, 3), fresh and writable."""
    u = np.linspace(0.1, 0.9, 4)
    for args, shape in (
        ((0.5, 0.25), ()),
        (([], 0.5), (0,)),
        (([], []), (0,)),
        ((np.zeros((0, 1)), np.zeros((1, 5))), (0, 5)),
        ((u, 0.25), (4,)),
        ((0.25, u), (4,)),
        ((u, u), (4,)),
        ((u[:, None], u[None, :3]), (4, 3)),
        ((u[:, None], u), (4, 4)),
        ((u[None, :], u[:3, None]), (3, 4)),
        ((np.full((2, 3, 4), 0.5), u), (2, 3, 4)),
    ):
        for value in (surface(*args), surface.derivative(*args, 1, 1), surface.normal(*args)):
            assert value.shape == (*shape, 3)
            assert value.dtype == np.float64
            assert value.flags.writeable
        assert surface.curvature(*args).gaussian.shape == shape


@EVERY
@pytest.mark.parametrize("orders", [(0, 0), (1, 0), (0, 1), (1, 1), (0, 2)])
def test_an_open_mesh_is_its_scattered_points(surface, orders):
    """The caller never chooses between the paths, and the answers agree to rounding; one point alone as well."""
    u, w = np.random.default_rng(2).random((2, 5))
    mesh = surface.derivative(u[:, None], w[None, :], *orders)
    scattered = surface.derivative(*np.meshgrid(u, w, indexing="ij"), *orders)
    size = max(1.0, np.abs(mesh).max())
    assert np.allclose(mesh, scattered, rtol=0, atol=1e-13 * size)
    assert np.allclose(mesh[2, 3], surface.derivative(u[2], w[3], *orders), rtol=0, atol=1e-13 * size)


@EVERY
@pytest.mark.parametrize("orders", [(1, 0), (2, 0), (0, 1), (0, 2), (1, 1), (1, 2)])
def test_derivatives_are_those_of_the_points(surface, orders):
    """Against the numeric first derivative of the order before, along the parameter of highest order."""
    nu, nw = orders
    u, w = np.array([0.15, 0.5, 0.85]), np.array([0.2, 0.55, 0.9])
    if nw:
        numeric = numeric_derivative(lambda t: surface.derivative(u[:, None], t[None, :], nu, nw - 1).swapaxes(0, 1), w, 1)
        exact = surface.derivative(u[:, None], w[None, :], nu, nw).swapaxes(0, 1)
    else:
        numeric = numeric_derivative(lambda t: surface.derivative(t[:, None], w[None, :], nu - 1, nw), u, 1)
        exact = surface.derivative(u[:, None], w[None, :], nu, nw)
    # the minimal frame itself is found to 5e-10, which a difference over 1/1024 of the path would magnify
    assert np.allclose(numeric, exact, rtol=0, atol=2e-6 * max(1.0, np.abs(exact).max()))


@EVERY
def test_parameters_outside(surface):
    """Clamped within 1e-12, refused further out, in either parameter."""
    assert np.array_equal(surface(-1e-13, 1 + 1e-13), surface(0, 1))
    for args in ((1 + 1e-11, 0.5), (0.5, -1e-11), (np.nan, 0.5), (0.5, [0.5, np.inf])):
        with pytest.raises(dx.DomainError, match=r"must lie in \[0, 1\]"):
            surface(*args)


@EVERY
def test_normals_are_unit_and_perpendicular(surface):
    """Everywhere on the closed square, poles and edges included, or (0, 0, 0), never NaN."""
    u, w = G[:, None], G[None, :]
    normal = surface.normal(u, w)
    length = np.linalg.norm(normal, axis=-1)
    assert (np.isclose(length, 1, atol=1e-14) | (length == 0)).all()
    assert (length[1:-1, 1:-1] > 0).mean() > 0.9
    for orders in ((1, 0), (0, 1)):
        tangent = surface.derivative(u, w, *orders)
        assert np.allclose((normal * tangent).sum(-1), 0, atol=1e-9 * np.abs(tangent).max())


@EVERY
def test_curvature_from_the_normals(surface):
    """Weingarten, an independent route: K n = n_u x n_w / |S_u x S_w|, with the normals differentiated numerically."""
    u, w = np.array([0.3, 0.45, 0.8]), 0.35
    n_u = numeric_derivative(lambda t: surface.normal(t, w), u, 1)
    n_w = np.stack([numeric_derivative(lambda t, x=x: surface.normal(x, t), np.array([w]), 1)[0] for x in u])
    normal, su, sw = surface.normal(u, w), surface.derivative(u, w, 1, 0), surface.derivative(u, w, 0, 1)
    area = np.linalg.norm(np.cross(su, sw), axis=-1)
    bent = surface.curvature(u, w)
    size = 1 + np.abs(bent.k1) + np.abs(bent.k2)
    assert np.allclose((np.cross(n_u, n_w) * normal).sum(-1) / area, bent.gaussian, atol=1e-5 * size.max() ** 2)
    assert np.allclose(bent.k1 * bent.k2, bent.gaussian, rtol=1e-9, atol=1e-12)
    assert np.allclose(bent.k1 + bent.k2, 2 * bent.mean, rtol=1e-9, atol=1e-12)
    assert (bent.k1 >= bent.k2).all()


@EVERY
def test_principal_directions(surface):
    """Orthogonal unit tangents, d1 x d2 = n, and the normal curvature along d1 is k1 (Euler)."""
    u, w = np.array([0.3, 0.45, 0.8]), np.array([0.35, 0.6, 0.2])
    d1, d2 = surface.principal_directions(u, w)
    assert np.allclose(np.cross(d1, d2), surface.normal(u, w), atol=1e-12)
    su, sw = surface.derivative(u, w, 1, 0), surface.derivative(u, w, 0, 1)
    L, M, N = surface.second_form(u, w)
    for d, k in ((d1, surface.curvature(u, w).k1), (d2, surface.curvature(u, w).k2)):
        a, b = np.stack([np.linalg.lstsq(np.stack([x, y], -1), z, rcond=None)[0] for x, y, z in zip(su, sw, d, strict=True)]).T
        assert np.allclose(a * a * L + 2 * a * b * M + b * b * N, k, atol=1e-9 * max(1, np.abs(k).max()))


@EVERY
def test_moving_commutes_with_evaluating(surface):
    """Affine invariance; a mirror turns the normal's sense, a rotation carries it along."""
    move = dx.Transform.rotate((1, 2, 3), 0.4, (1, 0, 0)) @ dx.Transform.translate((3, 2, 1))
    u, w = np.random.default_rng(4).random((2, 6))
    assert np.allclose((move @ surface)(u, w), move @ surface(u, w), atol=1e-13)
    assert np.allclose((move @ surface).normal(u, w), move.vectors(surface.normal(u, w)), atol=1e-9)
    mirror = dx.Transform.reflect("x")
    assert np.allclose((mirror @ surface).normal(u, w), -mirror.vectors(surface.normal(u, w)), atol=1e-9)
    squash = dx.Transform.scale((1, 2, 0.5))
    assert np.allclose((squash @ surface)(u, w), squash @ surface(u, w), atol=1e-13)


@EVERY
def test_relabelling(surface):
    """flip_u, flip_w, swap and patch are the same surface under other parameters; three of them turn the normal round."""
    u, w = np.random.default_rng(6).random((2, 6))
    assert np.allclose(surface.flip_u()(u, w), surface(1 - u, w), atol=1e-13)
    assert np.allclose(surface.flip_w()(u, w), surface(u, 1 - w), atol=1e-13)
    assert np.allclose(surface.swap()(u, w), surface(w, u), atol=1e-13)
    assert np.allclose(surface.flip_w().normal(u, w), -surface.normal(u, 1 - w), atol=1e-9)
    assert np.allclose(surface.swap().normal(u, w), -surface.normal(w, u), atol=1e-9)
    part = surface.patch(0.25, 0.75, 0.5, 1)
    assert np.allclose(part(u, w), surface(0.25 + u / 2, 0.5 + w / 2), atol=1e-13)
    assert np.allclose(part.derivative(u, w, 1, 1), surface.derivative(0.25 + u / 2, 0.5 + w / 2, 1, 1) / 4, atol=1e-12)
    low, high = surface.split(w=0.25)
    assert np.allclose(low(u, w), surface(u, w / 4), atol=1e-13)
    assert np.allclose(high(u, w), surface(u, 0.25 + 0.75 * w), atol=1e-13)
    assert surface.split(u=0.5)[0].area() + surface.split(u=0.5)[1].area() == pytest.approx(surface.area(), rel=1e-9)


def test_cutting_twice_does_not_pile_up():
    """A patch of a patch is one patch, two swaps are none, two moves one matrix."""
    torus = dx.Torus(3, 1)
    part = torus.patch(0.5, 1, 0, 1).patch(0, 0.5, 0.5, 1)
    assert (part.surface, part.u0, part.u1, part.w0, part.w1) == (torus, 0.5, 0.75, 0.5, 1)
    assert torus.swap().swap() is torus
    move = dx.Transform.translate((1, 0, 0))
    assert (move @ (move @ torus)).surface is torus


class Graph(Surface):
    """S = (u - 1/2, w - 1/2, z(u, w)), or any map given by its derivatives: for poles of every kind."""

    def __init__(self, table):
        self._hold(table=table)

    def _derivative(self, u, w, nu, nw):
        f = self.table.get((nu, nw))
        return np.zeros(3) if f is None else np.stack(np.broadcast_arrays(*f(u, w)), -1).astype(float)


def test_a_corner_where_the_limit_depends_on_the_way():
    """A Bezier patch with three corner points in one: along u and along w the normals differ, so there is none."""
    net = np.array([[[0, 0, 0], [0, 0, 0], [0, 2, 1]], [[0, 0, 0], [1, 1, 1], [1, 2, 2]], [[2, 0, -1], [2, 1, 3], [2, 2, 1]]])
    assert dx.BezierPatch(net).normal(0, 0).tolist() == [0, 0, 0]
    assert np.linalg.norm(dx.BezierPatch(net).normal(0.01, 0.01)) == pytest.approx(1)


def test_a_fold_has_no_normal():
    """S = ((u - 1/2)^2, w, 0): on both sides of u = 1/2 the normal points the other way, on the fold nowhere."""
    fold = Graph(
        {
            (0, 0): lambda u, w: ((u - 0.5) ** 2, w, 0 * u),
            (1, 0): lambda u, w: (2 * (u - 0.5), 0 * w, 0 * u),
            (2, 0): lambda u, w: (2 + 0 * u, 0 * w, 0 * u),
            (0, 1): lambda u, w: (0 * u, 1 + 0 * w, 0 * u),
        }
    )
    assert fold.normal([0.4, 0.5, 0.6], 0.5).tolist() == [[0, 0, -1], [0, 0, 0], [0, 0, 1]]


def test_a_pole_of_higher_order_has_its_limit():
    """S = (u^3 , w, u^5): S_u vanishes to the second order at u = 0, and the normal still tends to (0, 0, 1)."""
    flat = Graph(
        {
            (0, 0): lambda u, w: (u**3, w, u**5),
            (1, 0): lambda u, w: (3 * u**2, 0 * w, 5 * u**4),
            (2, 0): lambda u, w: (6 * u, 0 * w, 20 * u**3),
            (0, 1): lambda u, w: (0 * u, 1 + 0 * w, 0 * u),
        }
    )
    assert np.allclose(flat.normal(0.0, [0.0, 0.5, 1.0]), [0, 0, 1], atol=1e-6)  # extrapolated: the docstring says 1e-7


def test_a_surface_that_is_a_line_has_no_normal():
    """A line swept along itself: area 0, (0, 0, 0) everywhere, and no warning."""
    sweep = dx.LinearSweep(dx.Line((0, 0, 0), (1, 1, 1)), (1, 1, 1), 2)
    assert sweep.area() == pytest.approx(0, abs=1e-12)
    assert not sweep.normal(G[:, None], G[None, :]).any()
    assert np.isnan(sweep.curvature(0.5, 0.5).k1)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (
            lambda s: s([0.1, 0.2], [0.1, 0.2, 0.3]),
            dx.ShapeError,
            r"u of shape \(2,\) and w of shape \(3,\). For a grid write u\[:, None\]",
        ),
        (lambda s: s.derivative(0.5, 0.5, -1, 0), dx.OrderError, "nu must be a whole number"),
        (lambda s: s.derivative(0.5, 0.5, 0, 1.5), dx.OrderError, "nw must be a whole number"),
        (lambda s: s.split(), dx.OrderError, "give exactly one of u and w"),
        (lambda s: s.split(u=0.5, w=0.5), dx.OrderError, "give exactly one of u and w"),
        (lambda s: s.split(u=0.0), dx.DomainError, "u must lie strictly between 0 and 1"),
        (lambda s: s.split(w=1.0), dx.DomainError, "w must lie strictly between 0 and 1"),
        (lambda s: s.patch(0, 0, 0, 1), dx.OrderError, "u0 and u1 must differ; both are 0"),
        (lambda s: s.patch(0, 1, 0, 1.5), dx.DomainError, r"w1 must lie in \[0, 1\]"),
        (lambda s: s.nearest((1, 2)), dx.ShapeError, r"points must have shape \(\.\.\., 3\); got \(2,\)"),
    ],
)
def test_refused(call, error, message):
    """The tests above hold the neighbours."""
    with pytest.raises(error, match=message):
        call(dx.Sphere(1))


def test_orders_beyond_a_numeric_curve_are_refused():
    """Second derivatives of a plain callable are there, third are not; in w the sweep knows them all."""
    sweep = dx.CircularSweep(lambda t: np.stack([2 + np.sin(2 * t), 3 * t - 0.5, 0 * t], -1), "y")
    assert sweep.derivative(0.5, 0.5, 2, 5).shape == (3,)
    with pytest.raises(dx.OrderError, match="n must be at most 2 here; got 3"):
        sweep.derivative(0.5, 0.5, 3, 0)
