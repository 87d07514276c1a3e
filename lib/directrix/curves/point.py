"""The polynomial curve through given points."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.basis import lagrange
from directrix.checks import Array
from directrix.curves.curve import Curve
from directrix.errors import DegenerateError
from directrix.transform import Transform


class PointCurve(Curve):
    """The polynomial curve through n points: p(u) = sum of L_i(u) P_i, of degree n - 1 (order n), p(u_i) = P_i.

    L_i(u) = prod over k != i of (u - u_k) / (u_i - u_k) (Lagrange; Mortenson, Geometric Modeling, 3rd ed., "Four-Point
    Interpolation", has parameters 0, 1/3, 2/3, 1). Other parameters give another curve through the same points; more than
    about ten equally spaced ones oscillate (Runge). Derivatives to any order.

    Parameters
    ----------
    points : (n, 3), n >= 2
    parameters : (n,) increasing from 0 to 1, 'chord' for cumulative chord length, or None for equally spaced

    Raises
    ------
    ShapeError
        If points is not (n, 3), or there are not as many parameters as points.
    NumberError
        If the parameters do not increase from 0 to 1.
    DegenerateError
        If chord length is asked for and two neighbouring points are equal.

    Examples
    --------
    >>> curve = PointCurve([(0, 0, 0), (1, 1, 0), (2, 0, 0)])
    >>> curve([0.25, 0.5]).tolist()
    [[0.5, 0.75, 0.0], [1.0, 1.0, 0.0]]
    """

    control_points: Array
    parameters: Array

    def __init__(self, points: ArrayLike, parameters: ArrayLike | str | None = None) -> None:
        points = checks.points("points", points)
        self._hold(control_points=points, parameters=parameter_values("parameters", parameters, points))

    @property
    def degree(self) -> int:
        """Number of points - 1; the order is degree + 1."""
        return len(self.control_points) - 1

    def _derivative(self, u: Array, n: int) -> Array:
        return lagrange(self.parameters, u, n) @ self.control_points

    def moved(self, transform: Transform) -> PointCurve:
        """The curve through the moved points, at the same parameters."""
        return PointCurve(transform.points(self.control_points), self.parameters)


def parameter_values(name: str, parameters: ArrayLike | str | None, points: Array) -> Array:
    """Parameters for points (n, 3): equally spaced for None, by chord length for 'chord', else the given ones, checked."""
    if parameters is None:
        return np.linspace(0.0, 1.0, len(points))
    if isinstance(parameters, str):
        checks.choice(name, parameters, ("chord",), hint="Or give the parameters as numbers.")
        return chord_length(points)
    return checks.increasing(name, parameters, len(points))


def chord_length(points: Array) -> Array:
    """Parameters in the ratio of the distances between neighbouring points (Piegl & Tiller, The NURBS Book, eq. 9.5).

    >>> chord_length(np.array([[0.0, 0, 0], [1, 0, 0], [1, 3, 0]])).tolist()
    [0.0, 0.25, 1.0]
    """
    chords = np.array([checks.length(chord) for chord in np.diff(points, axis=0)])
    if not chords.all():
        at = int(np.argmin(chords))
        raise DegenerateError(
            f"chord length needs neighbouring points to differ; points {at} and {at + 1} are equal. Remove one."
        )
    total = np.concatenate([[0.0], np.cumsum(chords)])
    return np.asarray(total / total[-1])
