"""B-spline sums over nets: rows of all basis functions for a grid, the few whose support holds the point for scattered points.

Both come from the knots as they are and differentiate by u and w, not by the knots' own parameters.
"""

# ruff: noqa: E741 (k and l are the orders, as the lecture names them)
from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from directrix.basis import SpanTable, spline_planes
from directrix.checks import Array, Indices
from directrix.knots import KnotVector

if TYPE_CHECKING:
    from scipy.interpolate import BSpline, NdBSpline

FEW = 1000  # points up to which scipy's evaluator, one point after the other, beats the sparse product
BLOCK = 4096  # points at a time, fewer for high orders: what stays in a processor's cache

Order = tuple[int, int]


class ScatteredSums:
    """Σ_i Σ_j N_i(u) N_j(w) c_ij and its derivatives at scattered points, at a cost that does not grow with the net.

    At a point only k of the N_i and l of the N_j are not zero. The k are one row of a sparse matrix; times the net, read
    through a window of l columns, they leave l numbers a coordinate, which the N_j blend (Piegl & Tiller, The NURBS Book, 2nd
    ed., algorithm A3.5, for a block of points at a time). Preparing that is worth while for more than `FEW` points: `blocks`;
    `few` goes to scipy's compiled evaluator.

    Parameters
    ----------
    net : (m, n, d), first points repeated for periodic knots
    along_u, along_w : knot vectors of m and n functions

    Examples
    --------
    >>> from directrix.knots import knot_vector
    >>> sums = ScatteredSums(np.array([[[0.0], [2.0]], [[2.0], [8.0]]]), *[knot_vector("knots", "open", 2, 2)] * 2)
    >>> sums.few(np.array([0.0, 0.5]), np.array([1.0, 0.5]), [(1, 0)])[1, 0].tolist()
    [[6.0, 4.0]]
    >>> [found[1, 0].tolist() for _, found in sums.blocks(np.array([0.0, 0.5]), np.array([1.0, 0.5]), [(1, 0)])]
    [[[6.0, 4.0]]]
    """

    def __init__(self, net: Array, along_u: KnotVector, along_w: KnotVector) -> None:
        self._net, self._knots = net, (along_u, along_w)
        self._speeds = speed(along_u), speed(along_w)

    @cached_property
    def _compiled(self) -> NdBSpline:
        return compiled_sums(self._net, self._knots)

    @cached_property
    def _spans(self) -> tuple[SpanTable, SpanTable]:
        u, w = (SpanTable(knots.values, knots.order) for knots in self._knots)
        return u, w

    @cached_property
    def _windows(self) -> Array:
        """Row i (n - l + 1) + j holds c[i, j : j + l], one coordinate after the other: shape (m (n - l + 1), d l)."""
        order = self._knots[1].order
        return np.lib.stride_tricks.sliding_window_view(self._net, order, axis=1).reshape(-1, self._net.shape[2] * order)

    def few(self, u: Array, w: Array, orders: Sequence[Order]) -> dict[Order, Array]:
        """The derivatives at parameters that broadcast, one point after the other, as planes (d, ...)."""
        places = np.empty((*np.broadcast(u, w).shape, 2))
        places[..., 0], places[..., 1] = self._knots[0].stretch(u), self._knots[1].stretch(w)
        k, l = self._knots[0].order, self._knots[1].order
        found = {}
        for nu, nw in orders:
            if nu >= k or nw >= l:
                found[nu, nw] = np.zeros((self._net.shape[2], *places.shape[:-1]))
            else:
                value = self._compiled(places, nu=(nu, nw))
                found[nu, nw] = value.transpose(-1, *range(value.ndim - 1))
        return self._scaled(found)

    def blocks(self, u: Array, w: Array, orders: Sequence[Order]) -> Iterator[tuple[slice, dict[Order, Array]]]:
        """The derivatives at u (n,) and w (n,), some points at a time, as planes (d, points): fresh ones for each block."""
        for part, found in self._many(u, w, orders):
            yield part, self._scaled(found)

    def _scaled(self, found: dict[Order, Array]) -> dict[Order, Array]:
        """From derivatives by the knots' own parameters to those by u and w."""
        for (nu, nw), value in found.items():
            if nu or nw:
                value *= self._speeds[0] ** nu * self._speeds[1] ** nw
        return found

    def _many(self, u: Array, w: Array, orders: Sequence[Order]) -> Iterator[tuple[slice, dict[Order, Array]]]:
        from scipy.sparse import csr_array

        m, n, d = self._net.shape
        k, l = (knots.order for knots in self._knots)
        block = min(len(u), max(1, BLOCK * 16 // max(16, k * l)))
        functions, columns = np.zeros((block, k)), np.zeros((block, k), dtype=np.int32)
        pieces = functions.ravel(), columns.ravel(), np.arange(0, block * k + 1, k, dtype=np.int32)
        matrix = csr_array(pieces, shape=(block, m * (n - l + 1)))  # reads the two arrays, which are filled again and again
        repeated, summed = np.tile(np.eye(l), d), np.repeat(np.eye(d), l, axis=0)
        for start in range(0, len(u), block):
            part = slice(start, min(start + block, len(u)))
            size = part.stop - start
            f, spans_u = self._functions(0, u[part], {nu for nu, _ in orders})
            g, spans_w = self._functions(1, w[part], {nw for _, nw in orders})
            corner = (spans_u - k + 1) * (n - l + 1) + spans_w - l + 1
            for i in range(k):
                columns[:size, i] = corner + i * (n - l + 1)
            found = {}
            for nu in f:
                functions[:size] = f[nu].T
                along_u = (matrix @ self._windows)[:size]
                for nw in (nw for other, nw in orders if other == nu):
                    products = g[nw].T @ repeated
                    products *= along_u
                    found[nu, nw] = summed.T @ products.T
            yield part, found

    def _functions(self, axis: int, u: Array, derivatives: set[int]) -> tuple[dict[int, Array], Indices]:
        """Basis functions that are not zero, or their derivatives, as planes, and the spans."""
        knots = self._knots[axis]
        t = knots.stretch(u)
        spans = self._spans[axis](u, t)
        return {n: spline_planes(knots.values, knots.order, t, spans, n) for n in derivatives}, spans


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
