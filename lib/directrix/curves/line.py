"""A straight line between two points."""

from __future__ import annotations

from numpy.typing import ArrayLike

from directrix import checks
from directrix.basis import linear
from directrix.checks import Array
from directrix.curves.curve import Curve
from directrix.errors import DegenerateError
from directrix.transform import Transform


class Line(Curve):
    """The straight line from one point to another: p(u) = (1 - u) start + u end.

    Derivatives to any order; the ends are met exactly. (Mortenson, Geometric Modeling, 3rd ed., "Parametric Equations of
    Curves".)

    Parameters
    ----------
    start, end : (3,), different points

    Raises
    ------
    DegenerateError
        If start and end are the same point.

    Examples
    --------
    >>> Line((0, 0, 0), (4, 2, 0))(0.25)
    array([1. , 0.5, 0. ])
    """

    start: Array
    end: Array

    def __init__(self, start: ArrayLike, end: ArrayLike) -> None:
        start, end = checks.point("start", start), checks.point("end", end)
        if (start == end).all():
            raise DegenerateError(f"start and end must be different points; both are {start.tolist()}.")
        self._hold(start=start, end=end)

    def _derivative(self, u: Array, n: int) -> Array:
        return linear(u[..., None], self.start, self.end, n)

    def moved(self, transform: Transform) -> Line:
        """The line between the moved ends."""
        return Line(transform.points(self.start), transform.points(self.end))
