"""The linear sweep: a curve carried along a straight line."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.basis import linear
from directrix.checks import Array
from directrix.curves.curve import Curve
from directrix.curves.function import as_curve
from directrix.errors import DegenerateError
from directrix.surfaces.surface import Surface
from directrix.transform import Transform


class LinearSweep(Surface):
    """A curve swept a distance along a direction: S(u, w) = C(u) + w d k, k the unit direction.

    u runs along the generatrix C, w along the straight directrix. In CAD: extrude. A closed curve stays closed in u; a line
    swept along itself collapses to a line (area 0, normal (0, 0, 0)). Derivatives to any order in w, in u as far as the
    curve's own. (Piegl & Tiller, The NURBS Book, 2nd ed., section 8.3, the general cylinder.)

    Parameters
    ----------
    curve : a curve of the library, or any vectorised callable u -> (..., 3)
    direction : (3,) of any length but 0: it is made unit
    distance : length; negative sweeps the other way

    Raises
    ------
    DegenerateError
        If the direction is the zero vector.
    CurveError
        If the curve is no vectorised callable.

    Examples
    --------
    >>> from directrix.curves.arc import Circle
    >>> LinearSweep(Circle((0, 0, 0), 1), (0, 0, 5), 2)(0.25, 0.5)
    array([0., 1., 1.])
    """

    curve: Curve
    direction: Array
    distance: float
    vector: Array

    def __init__(self, curve: Callable[[Array], Any], direction: ArrayLike, distance: float) -> None:
        direction, distance = checks.direction("direction", direction), checks.number("distance", distance)
        self._hold(curve=as_curve("curve", curve), direction=direction, distance=distance, vector=distance * direction)

    @classmethod
    def between(cls, curve: Callable[[Array], Any], a: ArrayLike, b: ArrayLike) -> LinearSweep:
        """The sweep by the free vector from a to b: S(u, w) = C(u) + w (b - a).

        The two points need not lie on the curve; only their difference counts.

        Raises
        ------
        DegenerateError
            If a and b are the same point.

        Examples
        --------
        >>> from directrix.curves.line import Line
        >>> LinearSweep.between(Line((0, 0, 0), (1, 0, 0)), (5, 5, 5), (5, 7, 5))(0.5, 0.5)
        array([0.5, 1. , 0. ])
        """
        a, b = checks.point("a", a), checks.point("b", b)
        if (a == b).all():
            raise DegenerateError(f"a and b must be different points: their difference is the sweep; both are {a.tolist()}.")
        sweep = cls.__new__(cls)
        direction = checks.direction("b - a", b - a)
        sweep._hold(curve=as_curve("curve", curve), direction=direction, distance=checks.length(b - a), vector=b - a)
        return sweep

    def _derivative(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        along = linear(w[..., None], 0 * self.vector, self.vector, nw) if nu == 0 else np.zeros(3)
        return self.curve._derivative(u, nu) + along if nw == 0 else along

    def breaks(self) -> tuple[Array, Array]:
        """Those of the curve in u; none in w."""
        return self.curve.breaks(), np.array([0.0, 1.0])

    def moved(self, transform: Transform) -> LinearSweep:
        """The sweep of the moved curve by the moved vector, which no affine map makes anything else."""
        return LinearSweep.between(self.curve.moved(transform), (0, 0, 0), transform.vectors(self.vector))
