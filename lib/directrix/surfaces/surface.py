"""What all surfaces share: checked parameters, shapes, open meshes, normals, curvature, moving and cutting.

A form derives from ``Surface`` and gives one method, ``_derivative``. A tensor-product form may also give ``_jet`` (several
derivatives at once, sharing their basis functions), ``_mesh`` (the same on a grid, as matrix products) and ``_mesh_rows``
(some rows of a grid at a time). The caller never chooses: an open mesh, u of shape (n, 1) against w of shape (1, m), goes to
``_mesh`` by itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks, differential
from directrix.checks import Array, Mask
from directrix.differential import Curvature, FirstForm, SecondForm
from directrix.errors import OrderError, ShapeError
from directrix.frozen import Frozen
from directrix.quadrature import integrate_square
from directrix.surfaces import grids
from directrix.surfaces.grids import components as components
from directrix.surfaces.grids import full, is_open_mesh, rows_of
from directrix.surfaces.grids import row_blocks as row_blocks
from directrix.surfaces.nearest import Nearest, nearest

if TYPE_CHECKING:
    from directrix.transform import Transform

Orders = Sequence[tuple[int, int]]
FIRST = ((0, 0), (1, 0), (0, 1))
SECOND = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))


class Surface(Frozen):
    """A surface S(u, w) in space, u and w in [0, 1].

    Called with numbers or arrays that broadcast against each other, it gives points of shape
    ``np.broadcast_shapes(u.shape, w.shape) + (3,)``, float64: scalars give (3,), empty arrays (0, 3). Parameters within 1e-12
    of [0, 1] are clamped; further out is a ``DomainError``. Lengths are in the unit of the points given. (do Carmo,
    Differential Geometry of Curves and Surfaces, chapters 2 and 3.)

    Raises
    ------
    DomainError
        From every method that takes u and w, if one is outside [0, 1] by more than 1e-12, or NaN.
    ShapeError
        If u and w do not broadcast against each other, or hold no real numbers.

    Examples
    --------
    >>> from directrix.surfaces.known import Cylinder
    >>> tube = Cylinder(2, 5)
    >>> tube(0.25, 0.4)
    array([0., 2., 2.])
    >>> tube([[0.0], [0.25]], [[0.0, 0.5, 1.0]]).shape
    (2, 3, 3)
    """

    # What a form gives

    def _derivative(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        """The derivative of order nu in u and nw in w at checked parameters of any shapes that broadcast.

        (0, 0) gives the points. The result may have fewer axes, as long as it broadcasts to the full shape: (3,) for a
        constant.
        """
        raise NotImplementedError

    def _jet(self, u: Array, w: Array, orders: Orders) -> Sequence[Array]:
        """Several derivatives at the same parameters; override it to share what they have in common."""
        return [self._derivative(u, w, nu, nw) for nu, nw in orders]

    def _mesh(self, u: Array, w: Array, orders: Orders) -> Sequence[Array]:
        """Several derivatives on the grid of u (n,) against w (m,), each broadcastable to (n, m, 3)."""
        return self._jet(u[:, None], w[None, :], orders)

    def _mesh_rows(self, u: Array, w: Array, orders: Orders) -> Callable[[slice], Sequence[Array]]:
        """What gives the derivatives on some rows of the grid, good until it is called again.

        Override it to prepare once what all rows share.
        """
        return lambda part: self._mesh(u[part], w, orders)

    def breaks(self) -> tuple[Array, Array]:
        """Values of u, and of w, between which the surface is smooth, 0 and 1 among them."""
        return np.array([0.0, 1.0]), np.array([0.0, 1.0])

    # What it is asked

    def _evaluate(self, u: ArrayLike, w: ArrayLike, orders: Orders) -> list[Array]:
        """The one door: parameters checked, open meshes seen, every answer of the full shape."""
        u, w = checks.parameter("u", u), checks.parameter("w", w)
        shape = (*(u.shape if u.shape == w.shape else checks.broadcast(u=u, w=w)), 3)
        if 0 in shape:
            return [np.empty(shape) for _ in orders]
        if is_open_mesh(u, w):
            grid = (u.size, w.size, 3)
            return [full(value, grid).reshape(shape) for value in self._mesh(u.ravel(), w.ravel(), orders)]
        return [full(value, shape) for value in self._jet(u, w, orders)]

    def __call__(self, u: ArrayLike, w: ArrayLike) -> Array:
        """Points of the surface, shape np.broadcast_shapes(u.shape, w.shape) + (3,).

        Raises
        ------
        DomainError
            If a parameter is outside [0, 1] by more than 1e-12, or NaN.
        ShapeError
            If u and w do not broadcast against each other, or are no real numbers.
        """
        return self._evaluate(u, w, ((0, 0),))[0]

    def derivative(self, u: ArrayLike, w: ArrayLike, nu: int, nw: int) -> Array:
        """The derivative of order nu in u and nw in w: (1, 0) is S_u, (0, 1) S_w, (1, 1) the twist S_uw.

        Where the surface is less smooth than the order asks (a repeated knot), the derivative of the side of growing u and w.

        Raises
        ------
        OrderError
            If an order is no whole number of at least 0, or is above what the form knows.
        """
        orders = checks.derivative_order("nu", nu), checks.derivative_order("nw", nw)
        return self._evaluate(u, w, (orders,))[0]

    def normal(self, u: ArrayLike, w: ArrayLike) -> Array:
        """Unit normals S_u x S_w / |S_u x S_w|, shape as the points; the sense follows the parametrisation.

        Where |S_u x S_w| <= 1e-10 |S_u| |S_w|, or one of them vanishes (a pole, an apex, a collapsed edge): the limit from
        inside the square of parameters, where all directions agree on one, else (0, 0, 0). Never NaN. At the apex of a cone
        the limit exists at each (u, 1), and is the normal of that ruling.
        """
        u, w = checks.parameter("u", u), checks.parameter("w", w)
        shape = checks.broadcast(u=u, w=w)
        if is_open_mesh(u, w) and 0 not in shape:
            return self._normals_on_mesh(u.ravel(), w.ravel()).reshape(*shape, 3)
        if math.prod(shape) <= 2 * grids.BLOCK:
            return self._normals(u, w, self._evaluate(u, w, FIRST))
        result = np.moveaxis(np.empty((3, *shape)), 0, -1)
        for rows in row_blocks(shape):
            part = rows_of(u, rows, shape), rows_of(w, rows, shape)
            result[rows] = self._normals(*part, self._evaluate(*part, FIRST))
        return result

    def _normals_on_mesh(self, u: Array, w: Array) -> Array:
        """Normals on the grid of u (n,) and w (m,), some rows at a time."""
        jet = self._mesh_rows(u, w, FIRST)
        result = np.empty((3, u.size, w.size)).transpose(1, 2, 0)
        for rows in row_blocks((u.size, w.size)):
            here = u[rows, None]
            shape = (len(here), w.size, 3)
            result[rows] = self._normals(here, w[None], [np.broadcast_to(value, shape) for value in jet(rows)])
        return result

    def _normals(self, u: Array, w: Array, jet: Sequence[Array]) -> Array:
        """Unit normals from point and tangents; limits where these do not span a plane."""
        normal, regular = differential.unit_normal(*jet)
        if not regular.all():
            try:
                normal[~regular] = differential.limit_normals(self._jet_at, *self._where(u, w, ~regular))
            except OrderError:  # a form without second derivatives has no limit to offer
                normal[~regular] = 0.0
        return normal

    def first_form(self, u: ArrayLike, w: ArrayLike) -> FirstForm:
        """Coefficients E, F, G of the first fundamental form: E = S_u . S_u, F = S_u . S_w, G = S_w . S_w."""
        _, tangent_u, tangent_w = self._evaluate(u, w, FIRST)
        return differential.first_form(tangent_u, tangent_w)

    def second_form(self, u: ArrayLike, w: ArrayLike) -> SecondForm:
        """Coefficients L, M, N of the second fundamental form: S_uu . n, S_uw . n, S_ww . n; n as ``normal`` gives it."""
        return differential.second_form(self.normal(u, w), *self._evaluate(u, w, SECOND[3:]))

    def curvature(self, u: ArrayLike, w: ArrayLike) -> Curvature:
        """Gaussian and mean curvature and the principal curvatures k1 >= k2, each of the shape of the parameters.

        Positive where the surface bends towards its normal, so a sphere with inward normals has k1 = k2 = 1/r, a cylinder
        with outward normals k1 = 0, k2 = -1/r (do Carmo, Differential Geometry of Curves and Surfaces, section 3-2; texts
        differ in sign and numbering). At a pole the limit, to about 1e-6; NaN where there is none (the apex of a cone).
        """
        jet = self._evaluate(u, w, SECOND)
        normal, regular = differential.unit_normal(*jet[:3])
        if regular.all():
            return differential.curvature(jet[1], jet[2], differential.second_form(normal, *jet[3:]))
        return self._curvature_with_poles(u, w, jet, normal, regular)

    def principal_directions(self, u: ArrayLike, w: ArrayLike) -> tuple[Array, Array]:
        """Unit tangents along which the normal curvature is k1 and k2, with d1 x d2 = n; (0, 0, 0) where n does not exist."""
        jet = self._evaluate(u, w, SECOND)
        normal, regular = differential.unit_normal(*jet[:3])
        first, second = np.zeros((2, *normal.shape))
        form = differential.second_form(normal[regular], *(part[regular] for part in jet[3:]))
        first[regular], second[regular] = differential.principal_directions(jet[1][regular], jet[2][regular], form)
        return first, second

    def area(self) -> float:
        """Area: the integral of |S_u x S_w| over the square, by adaptive Gauss quadrature to about 1e-10 of itself.

        A part covered twice counts twice.
        """

        def element(u: Array, w: Array) -> Array:
            _, tangent_u, tangent_w = self._evaluate(u, w, FIRST)
            return differential.norm(differential.cross(tangent_u, tangent_w))

        return integrate_square(element, *self.breaks())

    def nearest(self, points: ArrayLike) -> Nearest:
        """The nearest point of the surface to each given point: u, w and the distance, each of shape points.shape[:-1].

        A look at a grid of samples first, then a damped Newton iteration from the best of them, so that the answer is the
        global one as long as no dip is narrower than the samples (33 each way at least, six between breaks).

        Parameters
        ----------
        points : (..., 3)

        Raises
        ------
        ShapeError
            If the last axis of points is not of length 3.
        """
        given = checks.array("points", points)
        if given.ndim == 0 or given.shape[-1] != 3:
            raise ShapeError(f"points must have shape (..., 3); got {given.shape}.", got=given.shape)
        found = nearest(self._jet_at, self.breaks(), given.reshape(-1, 3))
        return Nearest(*(part.reshape(given.shape[:-1]) for part in found))

    # Moving and cutting

    def moved(self, transform: Transform) -> Surface:
        """This surface under an affine map; also written ``transform @ surface``."""
        return MovedSurface(self, transform)

    def patch(self, u0: float, u1: float, w0: float, w1: float) -> Surface:
        """The part u0 <= u <= u1, w0 <= w <= w1, with parameters of its own in [0, 1]; u0 > u1 runs u backwards."""
        return SubPatch(self, u0, u1, w0, w1)

    def split(self, *, u: float | None = None, w: float | None = None) -> tuple[Surface, Surface]:
        """The two parts on either side of the line u = const or w = const; give exactly one."""
        if (u is None) == (w is None):
            raise OrderError("give exactly one of u and w to split at; to cut both ways split the parts again.")
        if u is not None:
            at = checks.inside("u", u)
            return self.patch(0.0, at, 0.0, 1.0), self.patch(at, 1.0, 0.0, 1.0)
        at = checks.inside("w", w)
        return self.patch(0.0, 1.0, 0.0, at), self.patch(0.0, 1.0, at, 1.0)

    def flip_u(self) -> Surface:
        """The same surface with u run backwards: S(1 - u, w). The normal turns round."""
        return self.patch(1.0, 0.0, 0.0, 1.0)

    def flip_w(self) -> Surface:
        """The same surface with w run backwards: S(u, 1 - w). The normal turns round."""
        return self.patch(0.0, 1.0, 1.0, 0.0)

    def swap(self) -> Surface:
        """The same surface with u and w exchanged: S(w, u). The normal turns round."""
        return Swapped(self)

    # Poles

    def _jet_at(self, u: Array, w: Array, orders: list[tuple[int, int]]) -> tuple[Array, ...]:
        return tuple(self._evaluate(u, w, orders))

    def _where(self, u: ArrayLike, w: ArrayLike, mask: Mask) -> tuple[Array, Array]:
        """The parameters at which a mask holds."""
        us, ws = (np.broadcast_to(checks.parameter(name, value), mask.shape) for name, value in (("u", u), ("w", w)))
        return us[mask], ws[mask]

    def _curvature_with_poles(self, u: ArrayLike, w: ArrayLike, jet: list[Array], normal: Array, regular: Mask) -> Curvature:
        result = np.full((4, *regular.shape), np.nan)
        form = differential.second_form(normal[regular], *(part[regular] for part in jet[3:]))
        result[:, regular] = differential.curvature(jet[1][regular], jet[2][regular], form)
        us, ws = self._where(u, w, ~regular)
        k1, k2 = np.array([differential.limit_curvature(self._jet_at, *at) for at in zip(us, ws, strict=True)]).T
        result[:, ~regular] = k1 * k2, (k1 + k2) / 2, k1, k2
        return Curvature(*result)


class MovedSurface(Surface):
    """A surface under an affine map."""

    surface: Surface
    transform: Transform

    def __init__(self, surface: Surface, transform: Transform) -> None:
        self._hold(surface=surface, transform=transform)

    def _derivative(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        return self._jet(u, w, ((nu, nw),))[0]

    def _jet(self, u: Array, w: Array, orders: Orders) -> Sequence[Array]:
        return self._mapped(self.surface._jet(u, w, orders), orders)

    def _mesh(self, u: Array, w: Array, orders: Orders) -> Sequence[Array]:
        return self._mapped(self.surface._mesh(u, w, orders), orders)

    def _mapped(self, values: Sequence[Array], orders: Orders) -> list[Array]:
        linear, offset = self.transform.linear, self.transform.offset
        return [value @ linear.T + (offset if order == (0, 0) else 0.0) for value, order in zip(values, orders, strict=True)]

    def moved(self, transform: Transform) -> Surface:
        """This surface under one more map: the two are multiplied."""
        return MovedSurface(self.surface, transform @ self.transform)

    def breaks(self) -> tuple[Array, Array]:
        """As those of the surface that was moved."""
        return self.surface.breaks()


class SubPatch(Surface):
    """Part of a surface: T(u, w) = S(u0 + (u1 - u0) u, w0 + (w1 - w0) w); an end before its start runs backwards."""

    surface: Surface
    u0: float
    u1: float
    w0: float
    w1: float

    def __init__(self, surface: Surface, u0: float, u1: float, w0: float, w1: float) -> None:
        ends = {"u0": u0, "u1": u1, "w0": w0, "w1": w1}
        u0, u1, w0, w1 = (float(checks.parameter(name, checks.number(name, value))) for name, value in ends.items())
        for name, start, end in (("u", u0, u1), ("w", w0, w1)):
            if start == end:
                raise OrderError(f"{name}0 and {name}1 must differ; both are {start:g}, which leaves a curve and no patch.")
        if isinstance(surface, SubPatch):
            u0, u1 = (surface.u0 * (1 - u) + surface.u1 * u for u in (u0, u1))
            w0, w1 = (surface.w0 * (1 - w) + surface.w1 * w for w in (w0, w1))
            surface = surface.surface
        self._hold(surface=surface, u0=u0, u1=u1, w0=w0, w1=w1)

    def _derivative(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        return self._jet(u, w, ((nu, nw),))[0]

    def _jet(self, u: Array, w: Array, orders: Orders) -> Sequence[Array]:
        return self._scaled(self.surface._jet(*self._inner(u, w), orders), orders)

    def _mesh(self, u: Array, w: Array, orders: Orders) -> Sequence[Array]:
        return self._scaled(self.surface._mesh(*self._inner(u, w), orders), orders)

    def _inner(self, u: Array, w: Array) -> tuple[Array, Array]:
        return (1 - u) * self.u0 + u * self.u1, (1 - w) * self.w0 + w * self.w1

    def _scaled(self, values: Sequence[Array], orders: Orders) -> list[Array]:
        long_u, long_w = self.u1 - self.u0, self.w1 - self.w0
        return [value * (long_u**nu * long_w**nw) for value, (nu, nw) in zip(values, orders, strict=True)]

    def breaks(self) -> tuple[Array, Array]:
        """Those of the whole surface that lie on the part."""
        us, ws = self.surface.breaks()
        return _part_of(us, self.u0, self.u1), _part_of(ws, self.w0, self.w1)


class Swapped(Surface):
    """A surface with u and w exchanged: T(u, w) = S(w, u)."""

    surface: Surface

    def __init__(self, surface: Surface) -> None:
        self._hold(surface=surface)

    def _derivative(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        return self.surface._derivative(w, u, nw, nu)

    def _jet(self, u: Array, w: Array, orders: Orders) -> Sequence[Array]:
        return self.surface._jet(w, u, [(nw, nu) for nu, nw in orders])

    def _mesh(self, u: Array, w: Array, orders: Orders) -> Sequence[Array]:
        turned = self.surface._mesh(w, u, [(nw, nu) for nu, nw in orders])
        return [np.swapaxes(full(value, (w.size, u.size, 3)), 0, 1) for value in turned]

    def swap(self) -> Surface:
        """The surface that was swapped."""
        return self.surface

    def breaks(self) -> tuple[Array, Array]:
        """Those of the other surface, exchanged."""
        return self.surface.breaks()[::-1]


def _part_of(breaks: Array, start: float, end: float) -> Array:
    inner = (breaks - start) / (end - start)
    return np.unique([0.0, 1.0, *inner[(inner > 0) & (inner < 1)]])
