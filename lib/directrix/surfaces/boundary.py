"""Surfaces from their boundaries: the bilinear patch of four points, the ruled surface of two curves."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.basis import linear
from directrix.checks import Array
from directrix.curves.curve import Curve
from directrix.curves.function import as_curve
from directrix.errors import DegenerateError
from directrix.surfaces.surface import Orders, Surface
from directrix.surfaces.tensor import sum_on_grid, window
from directrix.transform import Transform

CurveLike = Curve | Callable[[Array], Any]


class Bilinear(Surface):
    """The bilinear patch of four corners: both families of lines on it are straight.

    S(u, w) = (1-u)(1-w) p00 + (1-u) w p01 + u (1-w) p10 + u w p11. It is a plane quadrilateral if the corners are coplanar,
    else part of a hyperbolic paraboloid (Mortenson, Geometric Modeling, on ruled surfaces). Derivatives to any order.

    Parameters
    ----------
    p00, p01, p10, p11 : (3,), in any one unit of length
        p_ij is the corner u = i, w = j: mind that the second given is (0, 1). Two neighbours may coincide (a triangle).

    Raises
    ------
    ShapeError
        If a corner is not of shape (3,).
    DegenerateError
        If all four are one point.

    Examples
    --------
    >>> saddle = Bilinear((0, 0, 0), (0, 2, 0), (2, 0, 0), (2, 2, 4))
    >>> saddle(0.5, 0.25)
    array([1. , 0.5, 0.5])
    >>> saddle.normal(0, 0)
    array([0., 0., 1.])
    """

    p00: Array
    p01: Array
    p10: Array
    p11: Array

    def __init__(self, p00: ArrayLike, p01: ArrayLike, p10: ArrayLike, p11: ArrayLike) -> None:
        given = {"p00": p00, "p01": p01, "p10": p10, "p11": p11}
        corners = {name: checks.point(name, value) for name, value in given.items()}
        if all(np.array_equal(corner, corners["p00"]) for corner in corners.values()):
            raise DegenerateError("p00, p01, p10 and p11 must not all be the same point: there is no patch between them.")
        self._hold(**corners)

    @property
    def corners(self) -> Array:
        """The corners, indexed [u, w], shape (2, 2, 3)."""
        return np.array([[self.p00, self.p01], [self.p10, self.p11]])

    def is_flat(self, tolerance: float = 1e-12) -> bool:
        """Whether the corners lie in one plane: the volume of their box is at most tolerance times the cube of its size."""
        tolerance = checks.not_negative("tolerance", tolerance)
        edges = self.corners.reshape(4, 3)[1:] - self.p00
        size = np.abs(edges).max()
        return bool(abs(np.linalg.det(edges / size)) <= tolerance)

    def _derivative(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        u, w = u[..., None], w[..., None]
        return linear(w, linear(u, self.p00, self.p10, nu), linear(u, self.p01, self.p11, nu), nw)

    def moved(self, transform: Transform) -> Bilinear:
        """The bilinear patch of the moved corners."""
        return Bilinear(*(transform.points(p) for p in (self.p00, self.p01, self.p10, self.p11)))

    def patch(self, u0: float, u1: float, w0: float, w1: float) -> Bilinear:
        """The part from (u0, w0) to (u1, w1): a bilinear patch of its own corners."""
        u0, u1, w0, w1 = window(u0, u1, w0, w1)
        return Bilinear(self(u0, w0), self(u0, w1), self(u1, w0), self(u1, w1))

    def swap(self) -> Bilinear:
        """The same surface with u and w exchanged."""
        return Bilinear(self.p00, self.p10, self.p01, self.p11)


class Ruled(Surface):
    """The ruled surface between two curves: straight lines join points of equal parameter.

    S(u, w) = (1-w) c0(u) + w c1(u) (Mortenson, Geometric Modeling, on ruled surfaces). Which points are joined depends on
    the parametrisation of the curves. Two coaxial circles give a cylinder, a cone, or, one started later, a hyperboloid of one
    sheet. Derivatives as far as the curves have them.

    Parameters
    ----------
    c0, c1 : curves, or vectorised callables u -> (..., 3)
        The edges w = 0 and w = 1, run in the same direction.

    Raises
    ------
    CurveError
        If one of them is no curve.

    Examples
    --------
    >>> from directrix.curves.bezier import BezierCurve
    >>> arch = BezierCurve([(0, 0, 0), (1, 0, 2), (2, 0, 0)])
    >>> hall = Ruled(arch, arch.moved(Transform.translate((0, 4, 0))))
    >>> hall(0.5, 0.25)
    array([1., 1., 1.])
    """

    c0: Curve
    c1: Curve

    def __init__(self, c0: CurveLike, c1: CurveLike) -> None:
        self._hold(c0=as_curve("c0", c0), c1=as_curve("c1", c1))

    def _derivative(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        return linear(w[..., None], self.c0._derivative(u, nu), self.c1._derivative(u, nu), nw)

    def _mesh(self, u: Array, w: Array, orders: Orders) -> Sequence[Array]:
        falling, rising = ({nw: linear(w, *ends, nw)[:, None] for _, nw in orders} for ends in ((1.0, 0.0), (0.0, 1.0)))
        edges = {nu: [self.c0._derivative(u, nu), self.c1._derivative(u, nu)] for nu, _ in orders}
        return [sum_on_grid(edges[nu], [falling[nw], rising[nw]], u.size, w.size) for nu, nw in orders]

    def breaks(self) -> tuple[Array, Array]:
        """Where one of the curves is less smooth."""
        return np.union1d(self.c0.breaks(), self.c1.breaks()), np.array([0.0, 1.0])

    def moved(self, transform: Transform) -> Ruled:
        """The ruled surface between the moved curves."""
        return Ruled(self.c0.moved(transform), self.c1.moved(transform))
