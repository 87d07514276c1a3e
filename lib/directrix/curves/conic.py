"""Conic sections as rational quadratics."""

from __future__ import annotations

from math import perm

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.basis import bernstein
from directrix.checks import Array
from directrix.curves.curve import Curve
from directrix.curves.rational import lift, quotient
from directrix.transform import Transform


class Conic(Curve):
    """An arc of a conic: p(u) = (B0 p0 + weight B1 p1 + B2 p2) / (B0 + weight B1 + B2), degree 2 (order 3), end weights 1.

    It starts at p0 towards p1 and arrives at p2 from p1. weight < 1 gives an ellipse, 1 a parabola, > 1 a hyperbola; with
    |p0 p1| = |p1 p2| and weight = cos of half the turn a circle, whose parameter is not the angle (Piegl & Tiller, The NURBS
    Book, 2nd ed., section 7.3; Farin, Curves and Surfaces for CAGD, 5th ed., on conics). Derivatives to any order.

    Parameters
    ----------
    p0, p1, p2 : (3,); p1 is where the end tangents meet
    weight : > 0

    Raises
    ------
    WeightError
        If the weight is not above 0.

    Examples
    --------
    >>> Conic((0, 0, 0), (1, 2, 0), (2, 0, 0), 1)(0.5)
    array([1., 1., 0.])
    >>> Conic((0, 0, 0), (1, 2, 0), (2, 0, 0), 3)(0.5)
    array([1. , 1.5, 0. ])
    """

    p0: Array
    p1: Array
    p2: Array
    weight: float

    def __init__(self, p0: ArrayLike, p1: ArrayLike, p2: ArrayLike, weight: float) -> None:
        given = {"p0": p0, "p1": p1, "p2": p2}
        self._hold(
            **{name: checks.point(name, value) for name, value in given.items()},
            weight=float(checks.weights("weight", checks.number("weight", weight), ())),
        )

    @property
    def control_points(self) -> Array:
        """The three points, (3, 3)."""
        return np.stack([self.p0, self.p1, self.p2])

    @property
    def weights(self) -> Array:
        """Their weights, (1, weight, 1)."""
        return np.array([1.0, self.weight, 1.0])

    @property
    def kind(self) -> str:
        """'ellipse', 'parabola' or 'hyperbola'."""
        return "ellipse" if self.weight < 1 else "parabola" if self.weight == 1 else "hyperbola"

    def _derivative(self, u: Array, n: int) -> Array:
        return rational_bezier(lift(self.control_points, self.weights), u, n)

    def moved(self, transform: Transform) -> Conic:
        """The conic of the moved points; an affine map keeps its kind and its weight."""
        p0, p1, p2 = transform.points(self.control_points)
        return Conic(p0, p1, p2, self.weight)


def rational_bezier(homogeneous: Array, u: Array, n: int) -> Array:
    """The n-th derivative of the rational Bezier curve of homogeneous control points (degree + 1, 4)."""
    degree = len(homogeneous) - 1

    def derivative(i: int) -> Array:
        if i > degree:
            return np.zeros((*u.shape, 4))
        return np.asarray(bernstein(degree - i, u) @ (perm(degree, i) * np.diff(homogeneous, i, axis=0)))

    return quotient(derivative, n)
