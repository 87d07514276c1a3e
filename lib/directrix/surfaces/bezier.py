"""Bezier patches of any degrees."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.basis import bernstein, de_casteljau
from directrix.checks import Array
from directrix.curves.bezier import BezierCurve
from directrix.surfaces.tensor import TensorPatch, window
from directrix.transform import Transform


class BezierPatch(TensorPatch):
    """The Bezier patch S(u, w) = Σ_i Σ_j B_i(u) B_j(w) P_ij of a net of control points, of any degrees.

    B_i(u) = C(n, i) u^i (1 - u)^(n - i) (Farin, Curves and Surfaces for CAGD, 5th ed., on Bezier patches). It meets the four
    corner points; the boundary rows and columns of the net are control points of the boundary curves; inner rows and columns
    are control polygons of curves that do *not* lie on the patch. Derivatives to any order. Parts, splits and moved patches
    are Bezier patches again.

    Parameters
    ----------
    net : (m, n, 3), m, n >= 2, in any one unit of length
        Degree m - 1 (order m) in u, along axis 0; degree n - 1 (order n) in w, along axis 1.

    Raises
    ------
    ShapeError
        If net is not of shape (m, n, 3) with m, n >= 2.
    NumberError
        If a coordinate is not finite.

    Examples
    --------
    >>> net = [[(0, 0, 0), (0, 2, 0)], [(1, 0, 4), (1, 2, 4)], [(2, 0, 0), (2, 2, 0)]]
    >>> arch = BezierPatch(net)
    >>> arch(0.5, 0.5)
    array([1., 1., 2.])
    >>> arch.derivative(0, 0, 1, 0)
    array([2., 0., 8.])
    >>> arch.normal(0.5, 0.5)
    array([0., 0., 1.])
    """

    control_net: Array

    def __init__(self, net: ArrayLike) -> None:
        self._hold(control_net=checks.net("net", net))

    def _net(self) -> Array:
        return self.control_net

    def _functions_u(self, u: Array, order: int) -> Array:
        return bernstein(len(self.control_net) - 1, u, order)

    def _functions_w(self, w: Array, order: int) -> Array:
        return bernstein(self.control_net.shape[1] - 1, w, order)

    def moved(self, transform: Transform) -> BezierPatch:
        """The Bezier patch of the moved control points."""
        return BezierPatch(transform.points(self.control_net))

    def patch(self, u0: float, u1: float, w0: float, w1: float) -> BezierPatch:
        """The part from (u0, w0) to (u1, w1) as a Bezier patch of its own, by de Casteljau's rule."""
        u0, u1, w0, w1 = window(u0, u1, w0, w1)
        net = bezier_part(self.control_net, u0, u1)
        return BezierPatch(bezier_part(net.swapaxes(0, 1), w0, w1).swapaxes(0, 1))

    def swap(self) -> BezierPatch:
        """The same surface with u and w exchanged: the net transposed."""
        return BezierPatch(self.control_net.swapaxes(0, 1))

    def curve_u(self, w: float) -> BezierCurve:
        """The curve u -> S(u, w) of a fixed w: its control points are Σ_j B_j(w) P_ij."""
        at = checks.parameter("w", checks.number("w", w))
        return BezierCurve(np.einsum("ijc,j->ic", self.control_net, self._functions_w(at, 0)))

    def curve_w(self, u: float) -> BezierCurve:
        """The curve w -> S(u, w) of a fixed u: its control points are Σ_i B_i(u) P_ij."""
        at = checks.parameter("u", checks.number("u", u))
        return BezierCurve(np.einsum("ijc,i->jc", self.control_net, self._functions_u(at, 0)))


def bezier_part(points: Array, start: float, end: float) -> Array:
    """Control points along axis 0 of the part [start, end] of a Bezier form; start > end runs it backwards."""
    low, high = min(start, end), max(start, end)
    if high < 1:
        points = de_casteljau(points, high)[1]
    if low > 0:
        points = de_casteljau(points, low / high)[2]
    return points if start < end else points[::-1]


def bezier_point(net: Array, u: float, w: float) -> Array:
    """One point of a Bezier patch by de Casteljau's rule, first along u, then along w: the slow honest way.

    Examples
    --------
    >>> bezier_point(np.array([[(0, 0, 0), (0, 2, 0)], [(2, 0, 0), (2, 2, 4)]], float), 0.5, 0.5).tolist()
    [1.0, 1.0, 1.0]
    """
    return np.asarray(de_casteljau(de_casteljau(net, u)[0], w)[0])
