"""B-spline sums over nets: rows of all basis functions for a grid, the few whose support holds the point for scattered points.

Both come from the knots as they are and differentiate by u and w, not by the knots' own parameters.
"""

# ruff: noqa: E741 (k and l are the orders, as the lecture names them)
from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from directrix.basis import SpanTable, bernstein, bezier_extraction, derived, spline_planes
from directrix.checks import Array
from directrix.knots import KnotVector

if TYPE_CHECKING:
    from scipy.interpolate import BSpline, NdBSpline

FEW = 1000  # points up to which scipy's evaluator, one point after the other, beats the sparse product
BLOCK = 4096  # points at a time, fewer for high orders: what stays in a processor's cache

Order = tuple[int, int]


class ScatteredSums:
    """Σ_i Σ_j N_i(u) N_j(w) c_ij and its derivatives at scattered points, at a cost that does not grow with the net.

    At a point only k of the N_i and l of the N_j are not zero. The k are one row of a sparse matrix; times the net, whose rows
    are cut along w into Bezier pieces, they leave the l Bezier points of a curve, which l Bernstein functions blend, one row of
    a second sparse matrix (Piegl & Tiller, The NURBS Book, 2nd ed., algorithm A3.5, for a block of points at a time). Preparing
    that is worth while for more than `FEW` points: `blocks`; `few` goes to scipy's compiled evaluator.

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
        self._prepared: dict[int, Array] = {}

    @cached_property
    def _compiled(self) -> NdBSpline:
        return compiled_sums(self._net, self._knots)

    @cached_property
    def _spans(self) -> tuple[SpanTable, SpanTable]:
        u, w = (SpanTable(knots.values, knots.order) for knots in self._knots)
        return u, w

    def _pieces(self, nw: int) -> Array:
        """Bezier points along w of the nw-th derivative, [span of w, row of the net, point, coordinate], as a matrix.

        Row j m + i is the piece of row i of the net on the j-th span: shape ((n - l + 1) m, (l - nw) d). Lower derivatives of
        polynomials on a span could do for all nw, but lose digits on spans much shorter than their neighbours.
        """
        if nw not in self._prepared:
            m, _, d = self._net.shape
            values, order, points = self._knots[1].values, self._knots[1].order, self._net.swapaxes(0, 1)
            for lower in range(order, order - nw, -1):
                values, points = derived(values, lower, points)
            order -= nw
            near = np.lib.stride_tricks.sliding_window_view(points.reshape(len(points), -1), order, axis=0)
            found = bezier_extraction(values, order) @ near.swapaxes(1, 2)
            self._prepared[nw] = found.reshape(-1, order, m, d).swapaxes(1, 2).reshape(-1, order * d)
        return self._prepared[nw]

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
        m, n, d = self._net.shape
        (k, l), (along_u, along_w) = (knots.order for knots in self._knots), self._knots
        block = min(len(u), max(1, BLOCK * 16 // max(16, k * l)))
        functions = _Rows((block, m * (n - l + 1)), k)
        blending = {nw: _Rows((block, block * (l - nw)), l - nw) for nw in {nw for _, nw in orders} if nw < l}
        for blend in blending.values():
            blend.columns[:] = np.arange(blend.columns.size).reshape(block, -1)
        starts, widths = along_w.values, np.diff(along_w.values)
        for start in range(0, len(u), block):
            part = slice(start, min(start + block, len(u)))
            size = part.stop - start
            s, t = along_u.stretch(u[part]), along_w.stretch(w[part])
            span_u, span_w = self._spans[0](u[part], s), self._spans[1](w[part], t)
            corner = (span_w - l + 1) * m + span_u - k + 1
            for i in range(k):
                functions.columns[:size, i] = corner + i
            x = (t - starts[span_w]) / widths[span_w]
            for nw, blend in blending.items():
                blend.values[:size] = bernstein(l - 1 - nw, x)
            found = {}
            for nu in {nu for nu, _ in orders}:
                functions.values[:size] = spline_planes(along_u.values, k, s, span_u, nu).T
                for nw in (nw for other, nw in orders if other == nu):
                    if nw < l:
                        curves = functions.matrix @ self._pieces(nw)
                        found[nu, nw] = (blending[nw].matrix @ curves.reshape(-1, d))[:size].T
                    else:
                        found[nu, nw] = np.zeros((d, size))
            yield part, found


class _Rows:
    """A sparse matrix with the same number of entries in each row, whose values and columns are filled in again and again."""

    def __init__(self, shape: tuple[int, int], width: int) -> None:
        from scipy.sparse import csr_array

        self.values, self.columns = np.zeros((shape[0], width)), np.zeros((shape[0], width), dtype=np.int32)
        ends = np.arange(0, shape[0] * width + 1, width, dtype=np.int32)
        self.matrix = csr_array((self.values.ravel(), self.columns.ravel(), ends), shape=shape)  # shares the two arrays


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
