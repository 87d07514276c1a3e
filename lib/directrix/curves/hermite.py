"""The cubic curve of two points and two tangents."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.basis import hermite
from directrix.checks import Array
from directrix.curves.curve import Curve
from directrix.transform import Transform


class HermiteCurve(Curve):
    """The Hermite (Ferguson) cubic: p(u) = F1 p0 + F2 p1 + F3 t0 + F4 t1, of degree 3 (order 4).

    F1 = 2u^3 - 3u^2 + 1, F2 = -2u^3 + 3u^2, F3 = u^3 - 2u^2 + u, F4 = u^3 - u^2, so p(0) = p0, p(1) = p1, p'(0) = t0,
    p'(1) = t1 (Mortenson, Geometric Modeling, 3rd ed., "Hermite Basis Functions"). The tangents are derivatives with respect
    to u: three times the first and last legs of the Bezier polygon. Derivatives to any order.

    Parameters
    ----------
    p0, p1 : (3,), end points
    t0, t1 : (3,), derivatives at the ends

    Raises
    ------
    ShapeError
        If one of them is not of shape (3,).

    Examples
    --------
    >>> curve = HermiteCurve((0, 0, 0), (2, 0, 0), (0, 4, 0), (0, -4, 0))
    >>> curve(0.5), curve.derivative(1.0)
    (array([1., 1., 0.]), array([ 0., -4.,  0.]))
    """

    p0: Array
    p1: Array
    t0: Array
    t1: Array

    def __init__(self, p0: ArrayLike, p1: ArrayLike, t0: ArrayLike, t1: ArrayLike) -> None:
        given = {"p0": p0, "p1": p1, "t0": t0, "t1": t1}
        self._hold(**{name: checks.point(name, value) for name, value in given.items()})

    def _derivative(self, u: Array, n: int) -> Array:
        return hermite(u, n) @ np.stack([self.p0, self.p1, self.t0, self.t1])

    def moved(self, transform: Transform) -> HermiteCurve:
        """The cubic of the moved points and the turned tangents."""
        return HermiteCurve(
            *(transform.points(p) for p in (self.p0, self.p1)), *(transform.vectors(t) for t in (self.t0, self.t1))
        )
