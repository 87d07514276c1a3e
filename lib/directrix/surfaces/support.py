"""B-spline sums over nets: rows of all basis functions for a grid, the few whose support holds the point for scattered points.

Both come from the knots as they are and differentiate by u and w, not by the knots' own parameters.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from directrix.basis import SpanTable, spline_planes
from directrix.checks import Array, Indices
from directrix.knots import KnotVector

if TYPE_CHECKING:
    from scipy.interpolate import BSpline, NdBSpline

SOME = 1500  # points for which scipy's evaluator, one point after the other, beats the sparse product
ENTRIES = 65_536  # of the sparse matrix at a time: 4096 bicubic points, what stays in a processor's cache

Order = tuple[int, int]


class ScatteredSums:
    """Σ_i Σ_j N_i(u) N_j(w) c_ij and its derivatives at scattered points, at a cost that does not grow with the net.

    Of the m n products of basis functions only k l are not zero at a point. They are one row of a sparse matrix, which, times
    the net, gives the sums of as many points as the matrix has rows (Piegl & Tiller, The NURBS Book, 2nd ed., algorithm A3.5,
    for many points at once). Building it is worth while from `SOME` points on; fewer go to scipy's compiled evaluator.

    Parameters
    ----------
    net : (m, n, d), first points repeated for periodic knots
    along_u, along_w : knot vectors of m and n functions

    Examples
    --------
    >>> from directrix.knots import knot_vector
    >>> sums = ScatteredSums(np.array([[[0.0], [2.0]], [[2.0], [8.0]]]), *[knot_vector("knots", "open", 2, 2)] * 2)
    >>> sums(np.array([0.0, 0.5]), np.array([1.0, 0.5]), [(0, 0), (1, 0)])[1, 0].tolist()
    [[6.0, 4.0]]
    """

    def __init__(self, net: Array, along_u: KnotVector, along_w: KnotVector) -> None:
        self._net, self._knots = net, (along_u, along_w)
        self._speed = speed(along_u), speed(along_w)
        self._compiled = compiled_sums(net, (along_u, along_w))
        self._spans = SpanTable(along_u.values, along_u.order), SpanTable(along_w.values, along_w.order)
        k, l = along_u.order, along_w.order  # noqa: E741 (the lecture's names)
        self.block = max(1, ENTRIES // max(16, k * l))
        self._near = (np.arange(1 - k, 1)[:, None] * net.shape[1] + np.arange(1 - l, 1)).ravel().astype(np.int32)

    def __call__(self, u: Array, w: Array, orders: Sequence[Order]) -> dict[Order, Array]:
        """The derivatives at u (n,) and w (n,), as planes (d, n); give no more than ``block`` points at a time."""
        s, t = self._knots[0].stretch(u), self._knots[1].stretch(w)
        found = self._one_by_one(s, t, orders) if len(s) <= SOME else self._at_once(s, t, orders)
        for nu, nw in orders:
            if nu or nw:
                found[nu, nw] *= self._speed[0] ** nu * self._speed[1] ** nw
        return found

    def _one_by_one(self, s: Array, t: Array, orders: Sequence[Order]) -> dict[Order, Array]:
        places, found = np.empty((len(s), 2)), {}
        places[:, 0], places[:, 1] = s, t
        k, l = (knots.order for knots in self._knots)  # noqa: E741
        for nu, nw in orders:
            zero = nu >= k or nw >= l
            found[nu, nw] = np.zeros((self._net.shape[2], len(s))) if zero else self._compiled(places, nu=(nu, nw)).T
        return found

    def _at_once(self, s: Array, t: Array, orders: Sequence[Order]) -> dict[Order, Array]:
        from scipy.sparse import csr_array

        m, n, d = self._net.shape
        spans = self._spans[0](s), self._spans[1](t)
        columns = ((spans[0] * n + spans[1]).astype(np.int32)[:, None] + self._near).ravel()
        starts = np.arange(0, len(columns) + 1, len(self._near), dtype=np.int32)
        f = {nu: self._functions(0, s, spans[0], nu) for nu in {nu for nu, _ in orders}}
        g = {nw: self._functions(1, t, spans[1], nw) for nw in {nw for _, nw in orders}}
        found = {}
        for nu, nw in orders:
            products = (f[nu][:, None] * g[nw]).reshape(len(self._near), len(s))
            matrix = csr_array((products.T.ravel(), columns, starts), shape=(len(s), m * n))
            found[nu, nw] = np.ascontiguousarray((matrix @ self._net.reshape(m * n, d)).T)
        return found

    def _functions(self, axis: int, t: Array, spans: Indices, derivative: int) -> Array:
        knots = self._knots[axis]
        return spline_planes(knots.values, knots.order, t, spans, derivative)


def speed(knots: KnotVector) -> float:
    """ds/du: how much faster the knot parameter runs than u."""
    return knots.end - knots.start


def needed(knots: KnotVector) -> tuple[int, Array]:
    """First function and knots of those functions whose support reaches into the domain; scipy wants no others."""
    t, k = knots.values, knots.order
    inside = [i for i in range(knots.count) if t[i + k] > knots.start and t[i] < knots.end]
    return inside[0], t[inside[0] : inside[-1] + k + 1]


def compiled_row(knots: KnotVector) -> BSpline:
    """All basis functions of a knot vector at once, as scipy's compiled B-spline with the identity for coefficients."""
    from scipy.interpolate import BSpline

    first, t = needed(knots)
    count = len(t) - knots.order
    return BSpline.construct_fast(t, np.eye(count, knots.count, first), knots.degree, extrapolate=True)


def compiled_sums(net: Array, knots: Sequence[KnotVector]) -> NdBSpline:
    """Σ N_i N_j ... c_ij... as scipy's compiled tensor-product B-spline of the knots' own parameters, for two or more axes."""
    from scipy.interpolate import NdBSpline

    values = []
    for axis, vector in enumerate(knots):
        first, t = needed(vector)
        net = np.take(net, range(first, first + len(t) - vector.order), axis=axis)
        values.append(t)
    return NdBSpline(tuple(values), np.ascontiguousarray(net), [vector.degree for vector in knots])


def row_of(compiled: BSpline, knots: KnotVector, u: Array, order: int) -> Array:
    """Values, or derivatives by u, of all basis functions at u (p,): shape (p, m)."""
    if order >= knots.order:
        return np.zeros((len(u), knots.count))
    value = compiled(knots.stretch(u), order)
    return np.asarray(value * speed(knots) ** order) if order else np.asarray(value)
