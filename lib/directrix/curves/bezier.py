"""Bezier curves of any degree."""

from __future__ import annotations

from math import perm

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.basis import bernstein, de_casteljau
from directrix.checks import Array
from directrix.curves.curve import Curve
from directrix.transform import Transform


class BezierCurve(Curve):
    """The Bezier curve of n + 1 control points, of degree n (order n + 1): p(u) = sum of B_i(u) P_i.

    B_i(u) = C(n, i) u^i (1 - u)^(n - i) (Farin, Curves and Surfaces for CAGD, 5th ed., "The Bernstein Form of
    a Bezier Curve"). It starts at the first and ends at the last point. Derivatives to any order: n (n - 1) ... times the
    Bezier curve of the differences of the points. Parts and splits are Bezier curves again, by de Casteljau's rule.

    Parameters
    ----------
    points : (n + 1, 3), n >= 1

    Raises
    ------
    ShapeError
        If points is not of shape (n + 1, 3) with at least two points.

    Examples
    --------
    >>> arch = BezierCurve([(0, 0, 0), (1, 2, 0), (2, 0, 0)])
    >>> arch(0.5)
    array([1., 1., 0.])
    >>> arch.derivative(0.0)
    array([2., 4., 0.])
    """

    control_points: Array

    def __init__(self, points: ArrayLike) -> None:
        self._hold(control_points=checks.points("points", points))

    @property
    def degree(self) -> int:
        """Number of points - 1; the order is degree + 1."""
        return len(self.control_points) - 1

    def _derivative(self, u: Array, n: int) -> Array:
        if n > self.degree:
            return np.zeros(3)
        return bernstein(self.degree - n, u) @ (perm(self.degree, n) * np.diff(self.control_points, n, axis=0))

    def moved(self, transform: Transform) -> BezierCurve:
        """The Bezier curve of the moved control points."""
        return BezierCurve(transform.points(self.control_points))

    def flip(self) -> BezierCurve:
        """The same curve run backwards: the points in reverse."""
        return BezierCurve(self.control_points[::-1])

    def split(self, u: float) -> tuple[BezierCurve, BezierCurve]:
        """The parts before and after u, each with control points of its own, by de Casteljau's rule."""
        _, left, right = de_casteljau(self.control_points, checks.inside("u", u))
        return BezierCurve(left), BezierCurve(right)
