"""The tricubic Hermite hyperpatch and the Bezier hyperpatch of any degrees."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.basis import bernstein, hermite
from directrix.checks import Array
from directrix.errors import ShapeError
from directrix.solids.solid import Orders, Solid, blended, checked_net
from directrix.surfaces.bezier import BezierPatch
from directrix.surfaces.hermite import HermitePatch
from directrix.transform import Transform


class HermiteHyperpatch(Solid):
    """The tricubic Hermite solid S(u, v, w) = Σ F_i(u) F_j(v) F_k(w) G_ijk of corner data.

    Index 0, 1 of each axis is the value at 0 and at 1, index 2, 3 the derivative there: G[0, 1, 0] is the corner (0, 1, 0),
    G[2, 1, 0] its S_u, G[2, 3, 0] its S_uv, G[2, 3, 2] its S_uvw. 8 corners, 24 tangents, 24 twists, 8 triple twists make 64
    (Mortenson, Geometric Modeling, on hyperpatches). A face is the `HermitePatch` of one layer of G.

    Parameters
    ----------
    G : (4, 4, 4, 3), axes u, v, w, in any one unit of length

    Raises
    ------
    ShapeError
        If G is not of shape (4, 4, 4, 3).

    Examples
    --------
    >>> G = np.zeros((4, 4, 4, 3))
    >>> G[1, :2, :2, 0] = G[2:, :2, :2, 0] = 1             # the unit cube: x = u, y = v, z = w
    >>> G[:2, 1, :2, 1] = G[:2, 2:, :2, 1] = 1
    >>> G[:2, :2, 1, 2] = G[:2, :2, 2:, 2] = 1
    >>> cube = HermiteHyperpatch(G)
    >>> cube(0.5, 0.25, 0.75)
    array([0.5 , 0.25, 0.75])
    >>> round(cube.volume(), 12)
    1.0
    """

    G: Array

    def __init__(self, G: ArrayLike) -> None:
        given = checks.array("G", G)
        if given.shape != (4, 4, 4, 3):
            raise ShapeError(f"G must have shape (4, 4, 4, 3), axes u, v, w; got {given.shape}.", name="G", got=given.shape)
        self._hold(G=given)

    def _derivatives(self, u: Array, v: Array, w: Array, orders: Orders) -> list[Array]:
        return [blended(self.G, (hermite(u, i), hermite(v, j), hermite(w, k))) for i, j, k in orders]

    def _face(self, axis: int, end: int) -> HermitePatch:
        return HermitePatch(np.take(self.G, end, axis=axis))

    def moved(self, transform: Transform) -> HermiteHyperpatch:
        """The solid under an affine map: corners move as points, all else as vectors."""
        G = transform.vectors(self.G)
        G[:2, :2, :2] += transform.offset
        return HermiteHyperpatch(G)


class BezierHyperpatch(Solid):
    """The Bezier solid S(u, v, w) = Σ B_i(u) B_j(v) B_k(w) P_ijk of a net of control points, of any degrees.

    The tricubic one has 4 x 4 x 4 = 64 points, 56 of them on the six faces, 8 inside (Mortenson, Geometric Modeling, on
    hyperpatches). It lies in the convex hull of its net. A face is the `BezierPatch` of one layer. Derivatives to any order.

    Parameters
    ----------
    net : (l, m, n, 3), l, m, n >= 2, axes u, v, w, in any one unit of length

    Raises
    ------
    ShapeError
        If net is not of shape (l, m, n, 3).

    Examples
    --------
    >>> corners = [[[(x, y, z) for z in (0, 2)] for y in (0, 2)] for x in (0, 2)]
    >>> BezierHyperpatch(corners)(0.5, 0.25, 1)
    array([1. , 0.5, 2. ])
    >>> round(BezierHyperpatch(corners).volume(), 12)
    8.0
    """

    control_net: Array

    def __init__(self, net: ArrayLike) -> None:
        self._hold(control_net=checked_net("net", net))

    @property
    def degrees(self) -> tuple[int, int, int]:
        """Degrees in u, v and w: one less than the numbers of points. The orders are one more."""
        l, m, n, _ = self.control_net.shape  # noqa: E741
        return l - 1, m - 1, n - 1

    def _derivatives(self, u: Array, v: Array, w: Array, orders: Orders) -> list[Array]:
        a, b, c = self.degrees
        return [blended(self.control_net, (bernstein(a, u, i), bernstein(b, v, j), bernstein(c, w, k))) for i, j, k in orders]

    def _nodes(self) -> int:
        return (3 * max(self.degrees)) // 2 + 1  # enough to be exact

    def _face(self, axis: int, end: int) -> BezierPatch:
        return BezierPatch(np.take(self.control_net, -end, axis=axis))

    def moved(self, transform: Transform) -> BezierHyperpatch:
        """The Bezier solid of the moved control points."""
        return BezierHyperpatch(transform.points(self.control_net))
