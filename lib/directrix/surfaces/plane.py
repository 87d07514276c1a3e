"""Plane patches: a parallelogram and a triangle through three points."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.basis import linear
from directrix.checks import Array
from directrix.curves.line import Line
from directrix.quadric import Quadric
from directrix.surfaces.extrusion import LinearSweep
from directrix.surfaces.surface import Surface
from directrix.surfaces.sweep import GenericSweep
from directrix.transform import Transform


class _ThreePoints(Surface):
    """Three points that are not on one line."""

    p1: Array
    p2: Array
    p3: Array

    def __init__(self, p1: ArrayLike, p2: ArrayLike, p3: ArrayLike) -> None:
        p1, p2, p3 = checks.point("p1", p1), checks.point("p2", p2), checks.point("p3", p3)
        message = f"p1, p2, p3 must not lie on one line; got {p1.tolist()}, {p2.tolist()}, {p3.tolist()}. Move one of them."
        checks.spanning(message, p2 - p1, p3 - p1)
        self._hold(p1=p1, p2=p2, p3=p3)

    def implicit(self) -> Quadric:
        """The plane n . (x - p1) = 0 with the unit normal n, without edges."""
        normal = checks.direction("normal", np.cross(self.p2 - self.p1, self.p3 - self.p1))
        a, b, c = (float(part) for part in normal)
        return Quadric(0, 0, 0, 0, 0, 0, a, b, c, -float(normal @ self.p1))

    def moved(self, transform: Transform) -> Surface:
        """The same form through the moved points."""
        return type(self)(*(transform.points(point) for point in (self.p1, self.p2, self.p3)))


class Plane(_ThreePoints):
    """The plane patch through three points: S(u, w) = p1 + u (p2 - p1) + w (p3 - p1).

    A parallelogram with S(0, 0) = p1, S(1, 0) = p2, S(0, 1) = p3 and S(1, 1) = p2 + p3 - p1. The half u + w <= 1 is the
    triangle p1 p2 p3. Normal (p2 - p1) x (p3 - p1), made unit. (Piegl & Tiller, The NURBS Book,
    2nd ed., section 8.2, with vanishing twist.)

    Parameters
    ----------
    p1, p2, p3 : (3,), not on one line

    Raises
    ------
    DegenerateError
        If the points lie on one line (two of them equal, or the sine of the angle at p1 at most 1e-12).

    Examples
    --------
    >>> Plane((0, 0, 0), (4, 0, 0), (0, 2, 1))(0.5, 0.5)
    array([2. , 1. , 0.5])
    """

    def _derivative(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        if nu and nw:
            return np.zeros(3)
        if nw:
            return linear(w[..., None], self.p1, self.p3, nw)
        along = linear(u[..., None], self.p1, self.p2, nu)
        return along if nu else along + w[..., None] * (self.p3 - self.p1)

    def swept(self) -> LinearSweep:
        """The same map as a sweep: the line p1 p2 swept by the vector from p1 to p3."""
        return LinearSweep.between(Line(self.p1, self.p2), self.p1, self.p3)


class Triangle(_ThreePoints):
    """The triangle p1 p2 p3 as the image of the whole square: S(u, w) = (1 - u)(1 - w) p1 + u (1 - w) p2 + w p3.

    The edge w = 0 runs from p1 to p2, the edge w = 1 collapses to p3: S_u = 0 there, and the normal is still that of the
    plane. The triangle as half of a parallelogram is ``Plane`` with u + w <= 1. (Piegl & Tiller, The NURBS Book,
    2nd ed., section 8.4, as the ruled surface between an edge and a point.)

    Parameters
    ----------
    p1, p2, p3 : (3,), not on one line

    Raises
    ------
    DegenerateError
        If the points lie on one line (two of them equal, or the sine of the angle at p1 at most 1e-12).

    Examples
    --------
    >>> Triangle((0, 0, 0), (4, 0, 0), (0, 2, 1))([0.5, 0.25], [0.5, 1.0]).tolist()
    [[1.0, 1.0, 0.5], [0.0, 2.0, 1.0]]
    """

    def swept(self) -> GenericSweep:
        """The same map as a tapered sweep: the line p1 p2 carried along p1 p3, shrinking evenly to a point."""
        return GenericSweep(Line(self.p1, self.p2), Line(self.p1, self.p3), taper=0.0)

    def _derivative(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        edge, rest = linear(u[..., None], self.p1, self.p2, nu), linear(w[..., None], 1.0, 0.0, nw)
        return edge * rest if nu else edge * rest + linear(w[..., None], 0.0, 1.0, nw) * self.p3
