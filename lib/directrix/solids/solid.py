"""What all solids share: checked parameters, shapes, the Jacobian, volume, and six outward faces."""

from __future__ import annotations

from itertools import pairwise, product
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.checks import Array
from directrix.errors import GeometryError, ShapeError
from directrix.frozen import Frozen
from directrix.surfaces.surface import Surface

if TYPE_CHECKING:
    from directrix.transform import Transform

Orders = list[tuple[int, int, int]]
FIRST: Orders = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]


class Solid(Frozen):
    """A solid S(u, v, w), u, v, w in [0, 1]: a hyperpatch in Mortenson's word (Geometric Modeling).

    Called with numbers or arrays that broadcast against each other it gives points of shape
    ``np.broadcast_shapes(u.shape, v.shape, w.shape) + (3,)``: scalars (3,), empty arrays (0, 3). Parameters within 1e-12 of
    [0, 1] are clamped; further out is a ``DomainError``.
    """

    def _derivatives(self, u: Array, v: Array, w: Array, orders: Orders) -> list[Array]:
        """Several derivatives at checked parameters that broadcast; each of the full shape (..., 3)."""
        raise NotImplementedError

    def _face(self, axis: int, end: int) -> Surface:
        """The boundary patch where parameter ``axis`` is ``end``; the other two parameters in their order."""
        raise NotImplementedError

    def breaks(self) -> tuple[Array, Array, Array]:
        """Values of u, v and w between which the solid is smooth."""
        ends = np.array([0.0, 1.0])
        return ends, ends, ends

    def __call__(self, u: ArrayLike, v: ArrayLike, w: ArrayLike) -> Array:
        """Points of the solid, of the shape that u, v and w broadcast to, and (3,)."""
        return self._evaluate(u, v, w, [(0, 0, 0)])[0]

    def derivative(self, u: ArrayLike, v: ArrayLike, w: ArrayLike, nu: int, nv: int, nw: int) -> Array:
        """The derivative of order nu in u, nv in v, nw in w.

        Raises
        ------
        DomainError
            If a parameter is outside [0, 1].
        OrderError
            If an order is no whole number of at least 0.
        """
        by_u, by_v, by_w = (checks.derivative_order(name, n) for name, n in (("nu", nu), ("nv", nv), ("nw", nw)))
        return self._evaluate(u, v, w, [(by_u, by_v, by_w)])[0]

    def jacobian(self, u: ArrayLike, v: ArrayLike, w: ArrayLike) -> Array:
        """The determinant of (S_u, S_v, S_w), of the parameters' shape: positive where the map is right-handed, 0 at folds."""
        return determinant(*self._evaluate(u, v, w, FIRST))

    def _evaluate(self, u: ArrayLike, v: ArrayLike, w: ArrayLike, orders: Orders) -> list[Array]:
        u, v, w = checks.parameter("u", u), checks.parameter("v", v), checks.parameter("w", w)
        shape = (*checks.broadcast(u=u, v=v, w=w), 3)
        if 0 in shape:
            return [np.empty(shape) for _ in orders]
        return [np.array(np.broadcast_to(value, shape)) for value in self._derivatives(u, v, w, orders)]

    def signed_volume(self) -> float:
        """The integral of the Jacobian over the cube: negative if the parametrisation is left-handed.

        Gauss quadrature on the cells between the breaks, with more nodes until the value stays within 1e-12 of itself; exact to
        rounding for polynomial solids.
        """
        previous, nodes = np.inf, self._nodes()
        while True:
            value = self._quadrature(nodes)
            if abs(value - previous) <= 1e-12 * abs(value) or nodes >= 48:
                return value
            previous, nodes = value, nodes + 6

    def _nodes(self) -> int:
        return 6

    def _quadrature(self, nodes: int) -> float:
        x, weights = np.polynomial.legendre.leggauss(nodes)
        x, weights = (x + 1) / 2, weights / 2
        total = 0.0
        for (a, b), (c, d), (e, f) in product(*(pairwise(breaks) for breaks in self.breaks())):
            u, v, w = a + (b - a) * x, c + (d - c) * x, e + (f - e) * x
            value = determinant(*self._derivatives(u[:, None, None], v[None, :, None], w[None, None, :], FIRST))
            total += float(np.einsum("ijk,i,j,k->", value, weights, weights, weights)) * (b - a) * (d - c) * (f - e)
        return float(total)

    def volume(self) -> float:
        """The volume, 0 or more: |∫∫∫ det(S_u, S_v, S_w)|. A part where the solid folds back counts negative."""
        return abs(self.signed_volume())

    def faces(self, *, outward: bool = True) -> tuple[Surface, ...]:
        """The six boundary patches u = 0, u = 1, v = 0, v = 1, w = 0, w = 1, in this order.

        The two remaining parameters become u and w of the patch, in their order; their normals then point out on u = 1, v = 0
        and w = 1 of a right-handed solid, and in on the others. With ``outward`` those others are swapped (u and w exchanged),
        so that every normal points out; the sign of the volume tells the hand.
        """
        if not isinstance(outward, bool | np.bool):
            raise GeometryError(f"outward must be True or False; got {outward!r:.60}.")
        patches = [self._face(axis, end) for axis in range(3) for end in (0, 1)]
        if not outward:
            return tuple(patches)
        inward = (0, 3, 4) if self.signed_volume() >= 0 else (1, 2, 5)
        return tuple(patch.swap() if i in inward else patch for i, patch in enumerate(patches))

    def moved(self, transform: Transform) -> Solid:
        """This solid under an affine map; also written ``transform @ solid``."""
        raise NotImplementedError


def determinant(a: Array, b: Array, c: Array) -> Array:
    """a · (b x c) along the last axis."""
    return np.asarray(
        a[..., 0] * (b[..., 1] * c[..., 2] - b[..., 2] * c[..., 1])
        + a[..., 1] * (b[..., 2] * c[..., 0] - b[..., 0] * c[..., 2])
        + a[..., 2] * (b[..., 0] * c[..., 1] - b[..., 1] * c[..., 0])
    )


def checked_net(name: str, value: ArrayLike) -> Array:
    """A control net of shape (l, m, n, 3), points along u, v and w on axes 0, 1 and 2."""
    given = checks.array(name, value)
    if given.ndim != 4 or given.shape[3] != 3 or min(given.shape[:3]) < 2:
        hint = " For 64 points use .reshape(4, 4, 4, 3), first index u." if given.size == 192 else ""
        raise ShapeError(
            f"{name} must have shape (l, m, n, 3) with l, m, n >= 2; got {given.shape}.{hint}", name=name, got=given.shape
        )
    return given


def blended(net: Array, rows: tuple[Array, Array, Array]) -> Array:
    """Σ f_i(u) g_j(v) h_k(w) c_ijk for functions (..., l), (..., m), (..., n) that broadcast and a net (l, m, n, d)."""
    f, g, h = rows
    l, m, n, d = net.shape  # noqa: E741
    half = (f @ net.reshape(l, -1)).reshape(*f.shape[:-1], m, n * d)
    third = (g[..., None, :] @ half)[..., 0, :]
    return np.asarray((h[..., None, :] @ third.reshape(*third.shape[:-1], n, d))[..., 0, :])
