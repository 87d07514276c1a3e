"""Circular arcs and circles, run through at constant speed."""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.checks import Array
from directrix.curves.curve import Curve
from directrix.errors import NumberError
from directrix.transform import turn


class Arc(Curve):
    """A circular arc at constant speed: p(u) = center + radius (cos a, sin a), a = (1 - u) start + u end.

    The angle a is measured in the plane across ``normal`` from the projection of the x axis (where that vanishes, from the y
    axis), positive by the right-hand rule about ``normal``: cos goes with that first axis e1, sin with normal x e1. The
    rational arcs of NURBS have the same points at another speed; conversion makes them. Derivatives to any order; multiples
    of a quarter turn are exact. (Piegl & Tiller, The NURBS Book, 2nd ed., section 7.2.)

    Parameters
    ----------
    center : (3,)
    radius : length, > 0
    start, end : radians; end < start runs the negative way, end - start = 2 pi closes the circle
    normal : (3,) of any length but 0

    Raises
    ------
    NumberError
        If the radius is not above 0, or start = end.
    DegenerateError
        If the normal is the zero vector.

    Examples
    --------
    >>> quarter = Arc((1, 0, 0), 2, 0, np.pi / 2)
    >>> quarter(1.0)
    array([1., 2., 0.])
    """

    center: Array
    radius: float
    start: float
    end: float
    normal: Array

    def __init__(self, center: ArrayLike, radius: float, start: float, end: float, normal: ArrayLike = (0.0, 0.0, 1.0)) -> None:
        start, end = checks.number("start", start), checks.number("end", end)
        if start == end:
            raise NumberError(
                f"start and end must be different angles; both are {start:g}. A whole turn is end = start + 2 pi."
            )
        self._hold(
            center=checks.point("center", center),
            radius=checks.positive("radius", radius),
            start=start,
            end=end,
            normal=checks.direction("normal", normal),
        )

    @property
    def axes(self) -> Array:
        """Rows e1, e2 of shape (2, 3): unit vectors in the plane of the arc, e1 x e2 = normal."""
        x, y, z = self.normal
        e1 = np.array([y * y + z * z, -x * y, -x * z])  # the x axis less its part along the normal, without cancellation
        if checks.length(e1) < 1e-9:
            e1 = np.array([-y * x, x * x + z * z, -y * z])
        e1 /= checks.length(e1)
        axes = np.stack([e1, np.cross(self.normal, e1)])
        axes += 0.0  # no -0.0
        return axes

    def _derivative(self, u: Array, n: int) -> Array:
        turns = (self.end - self.start) / (2 * pi)
        cos, sin = turn(self.start / (2 * pi) + turns * u, n)
        e1, e2 = self.axes * self.radius * turns**n
        around = cos[..., None] * e1 + sin[..., None] * e2
        return around + self.center if n == 0 else around

    def __repr__(self) -> str:
        return f"Arc({self.center.tolist()}, {self.radius:g}, {self.start:g}, {self.end:g}, normal={self.normal.tolist()})"


class Circle(Arc):
    """A whole circle at constant speed: the ``Arc`` from 0 to 2 pi.

    Starts and ends at center + radius e1, with e1 the projection of the x axis onto the plane (where that vanishes, of the y
    axis), and goes round by the right-hand rule about ``normal``. The same point, bit for bit, at u = 0 and u = 1.
    (Piegl & Tiller, The NURBS Book, 2nd ed., section 7.2.)

    Parameters
    ----------
    center : (3,)
    radius : length, > 0
    normal : (3,) of any length but 0

    Raises
    ------
    NumberError
        If the radius is not above 0.
    DegenerateError
        If the normal is the zero vector.

    Examples
    --------
    >>> Circle((0, 0, 1), 2)([0.0, 0.25, 1.0]).tolist()
    [[2.0, 0.0, 1.0], [0.0, 2.0, 1.0], [2.0, 0.0, 1.0]]
    """

    def __init__(self, center: ArrayLike, radius: float, normal: ArrayLike = (0.0, 0.0, 1.0)) -> None:
        super().__init__(center, radius, 0.0, 2 * pi, normal)

    def __repr__(self) -> str:
        return f"Circle({self.center.tolist()}, {self.radius:g}, normal={self.normal.tolist()})"
