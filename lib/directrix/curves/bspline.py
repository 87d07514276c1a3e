"""B-spline curves, and the rational ones."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.basis import spline_local
from directrix.checks import Array
from directrix.curves.curve import Curve
from directrix.curves.rational import lift, quotient
from directrix.knots import Knots, KnotVector, knot_vector
from directrix.transform import Transform


class BSplineCurve(Curve):
    """The B-spline curve of m control points and order k (degree k - 1): p(u) = sum of N_i,k(t) P_i.

    t is u stretched onto the knots' own domain, t = (1 - u) knots[k - 1] + u knots[-k]; derivatives are with respect to u
    (Piegl & Tiller, The NURBS Book, 2nd ed., sections 3.2 and 3.3, with k = p + 1). Each point moves only k spans. Where a knot
    is repeated k - 1 times the curve has a corner, k times a gap; there values and derivatives are those of growing u, at
    u = 1 those of the curve's own side. Derivatives to any order.

    Parameters
    ----------
    points : (m, 3), m >= 2
    order : k = degree + 1, 1 <= k <= m; 4 is cubic
    knots : 'open' (starts at the first point, ends at the last), 'uniform', 'periodic' (closed: the first k - 1 points are used
        again), or m + k non-decreasing numbers; a point whose k + 1 knots are all one has no influence

    Raises
    ------
    ShapeError
        If points is not (m, 3).
    OrderError
        If not 1 <= order <= m.
    KnotError
        If given knots do not fit.

    Examples
    --------
    >>> points = [(0, 0, 0), (2, 4, 0), (4, 4, 0), (6, 0, 0)]
    >>> BSplineCurve(points, 3)([0.0, 0.5]).tolist()
    [[0.0, 0.0, 0.0], [3.0, 4.0, 0.0]]
    """

    control_points: Array
    order: int
    knot_vector: KnotVector

    def __init__(self, points: ArrayLike, order: int, knots: Knots = "open") -> None:
        points = checks.points("points", points)
        k = checks.order("order", order, len(points))
        self._hold(control_points=points, order=k, knot_vector=knot_vector("knots", knots, len(points), k))

    @property
    def degree(self) -> int:
        """order - 1."""
        return self.order - 1

    @property
    def knots(self) -> Array:
        """The knots, (m + k,); (m + 2k - 1,) when periodic."""
        return self.knot_vector.values

    def _derivative(self, u: Array, n: int) -> Array:
        return spline_sum(self.knot_vector, self.control_points, u, n)

    def breaks(self) -> Array:
        """The distinct knots, as values of u."""
        return self.knot_vector.breaks()

    def moved(self, transform: Transform) -> BSplineCurve:
        """The B-spline curve of the moved points."""
        return self._with(transform.points(self.control_points))

    def _with(self, points: Array) -> BSplineCurve:
        result = type(self).__new__(type(self))
        result._hold(control_points=points, order=self.order, knot_vector=self.knot_vector)
        return result


class NurbsCurve(Curve):
    """The rational B-spline curve: p(u) = sum of N_i,k(t) h_i P_i / sum of N_i,k(t) h_i, order k (degree k - 1).

    The points are Cartesian, not multiplied by their weights; multiplying all weights by one number changes nothing, a larger
    weight pulls the curve to its point. t is u stretched onto the knots' domain, as for ``BSplineCurve`` (Piegl & Tiller, The
    NURBS Book, 2nd ed., sections 4.2 and 4.3, who write w for the weights). Derivatives to any order.

    Parameters
    ----------
    points : (m, 3), Cartesian, m >= 2
    weights : (m,), all > 0
    order : k = degree + 1, 1 <= k <= m
    knots : as for ``BSplineCurve``

    Raises
    ------
    ShapeError
        If points is not (m, 3), or weights not (m,).
    WeightError
        If a weight is not above 0.
    OrderError
        If not 1 <= order <= m.
    KnotError
        If given knots do not fit.

    Examples
    --------
    >>> NurbsCurve([(0, 0, 0), (1, 2, 0), (2, 0, 0)], [1, 3, 1], 3)(0.5)
    array([1. , 1.5, 0. ])
    """

    control_points: Array
    weights: Array
    order: int
    knot_vector: KnotVector

    def __init__(self, points: ArrayLike, weights: ArrayLike, order: int, knots: Knots = "open") -> None:
        points = checks.points("points", points)
        k = checks.order("order", order, len(points))
        self._hold(
            control_points=points,
            weights=checks.weights("weights", weights, (len(points),)),
            order=k,
            knot_vector=knot_vector("knots", knots, len(points), k),
        )

    @property
    def degree(self) -> int:
        """order - 1."""
        return self.order - 1

    @property
    def knots(self) -> Array:
        """The knots, (m + k,); (m + 2k - 1,) when periodic."""
        return self.knot_vector.values

    def _derivative(self, u: Array, n: int) -> Array:
        homogeneous = lift(self.control_points, self.weights)
        return quotient(lambda i: spline_sum(self.knot_vector, homogeneous, u, i), n)

    def breaks(self) -> Array:
        """The distinct knots, as values of u."""
        return self.knot_vector.breaks()

    def moved(self, transform: Transform) -> NurbsCurve:
        """The curve of the moved points with the same weights, which is the moved curve for every affine map."""
        result = type(self).__new__(type(self))
        points = transform.points(self.control_points)
        result._hold(control_points=points, weights=self.weights, order=self.order, knot_vector=self.knot_vector)
        return result


def spline_sum(knots: KnotVector, points: Array, u: Array, n: int) -> Array:
    """The n-th derivative by u of the sum of N_i(t) P_i, for control points (m, d) of any dimension: u.shape + (d,)."""
    first, values = spline_local(knots.values, knots.order, knots.stretch(u), n)
    near = knots.extended(points)[first[..., None] + np.arange(knots.order)]
    return np.asarray(np.einsum("...k,...kd->...d", values, near)) * (knots.end - knots.start) ** n
