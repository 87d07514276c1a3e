"""Arithmetic of splines in one parameter: sums and products on common knots, from which sums of products make surfaces.

A strand is a spline of one parameter with coefficients of any dimension. Sums need a common order and common knots, products
of degrees p and q are splines of degree p + q; both are exact: nothing is fitted or sampled.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import comb
from typing import NamedTuple

import numpy as np

from directrix.basis import clamped, on_knots, raised
from directrix.checks import Array

SAME = 1e-12  # knots nearer than this, on [0, 1], are one knot


class Strand(NamedTuple):
    """A spline on [0, 1]: coefficients (m, d), clamped knots (m + k,), order k = degree + 1."""

    points: Array
    knots: Array
    order: int


def bezier_strand(points: Array) -> Strand:
    """One polynomial piece by its Bezier points (k, d)."""
    order = len(points)
    return Strand(np.asarray(points, dtype=np.float64), np.repeat([0.0, 1.0], order), order)


def on_unit(points: Array, knots: Array, order: int) -> Strand:
    """A spline on any knots, clamped or not, as a strand on [0, 1]."""
    start, end = knots[order - 1], knots[-order]
    values = clamped(knots, order, start, end)
    if not np.array_equal(values, knots):
        points = on_knots(knots, order, points, values)
    unit = (values - start) / (end - start)
    unit[:order], unit[-order:] = 0.0, 1.0
    return Strand(points, unit, order)


def common(strands: Sequence[Strand]) -> list[Strand]:
    """The same splines with one order and one knot vector: the highest order, and every knot as often as any of them needs.

    Examples
    --------
    >>> line, arch = bezier_strand(np.array([[0.0], [4.0]])), bezier_strand(np.array([[0.0], [4.0], [0.0]]))
    >>> common([line, arch])[0].points.ravel().tolist()
    [0.0, 2.0, 4.0]
    """
    order = max(strand.order for strand in strands)
    lifted = []
    for points, knots, low in strands:
        for k in range(low, order):
            knots, points = raised(knots, k, points)
        lifted.append(Strand(points, knots, order))
    places = _merged([strand.knots for strand in lifted])
    snapped = [strand._replace(knots=_snapped(strand.knots, places)) for strand in lifted]
    inner: list[float] = []
    for place in places[1:-1]:
        inner += [place] * max(int((strand.knots == place).sum()) for strand in snapped)
    knots = np.concatenate([[0.0] * order, inner, [1.0] * order])
    return [
        strand
        if np.array_equal(strand.knots, knots)
        else Strand(on_knots(strand.knots, order, strand.points, knots), knots, order)
        for strand in snapped
    ]


def _merged(vectors: list[Array]) -> Array:
    """The distinct knots of several vectors, those that differ only by rounding taken as one."""
    places = np.unique(np.concatenate(vectors))
    return np.asarray(places[np.concatenate([[True], np.diff(places) > SAME])])


def _snapped(knots: Array, places: Array) -> Array:
    return np.asarray(places[np.abs(knots[:, None] - places).argmin(axis=1)])


def times(a: Strand, b: Strand) -> Strand:
    """The product of two splines, coordinate by coordinate (d = 1 goes with any d), on their Bezier pieces.

    c_k = Σ_(i+j=k) C(p, i) C(q, j) / C(p + q, k) a_i b_j (Farin, Curves and Surfaces for CAGD, "Formulas for Bernstein
    Polynomials"). Where the product is continuous its inner knots have multiplicity p + q, more than they may need.

    Examples
    --------
    >>> t = bezier_strand(np.array([[0.0], [1.0]]))
    >>> times(t, t).points.ravel().tolist()
    [0.0, 0.0, 1.0]
    """
    for one, other in ((a, b), (b, a)):
        if len(one.points) == 1:  # a constant
            return other._replace(points=one.points * other.points)
    places = _merged([a.knots, b.knots])
    first, second = (_pieces(strand, places) for strand in (a, b))
    p, q = a.order - 1, b.order - 1
    pieces = np.zeros((len(places) - 1, p + q + 1, max(first.shape[2], second.shape[2])))
    for i in range(p + 1):
        for j in range(q + 1):
            pieces[:, i + j] += comb(p, i) * comb(q, j) / comb(p + q, i + j) * first[:, i] * second[:, j]
    return joined(pieces, places)


def joined(pieces: Array, places: Array) -> Strand:
    """Bezier pieces (n, k, d) over consecutive places as one spline; neighbours share a point where all pieces meet."""
    count, order, dimension = pieces.shape
    size = max(float(np.abs(pieces).max()), 1e-300)
    together = all(np.abs(a[-1] - b[0]).max() <= 1e-13 * size for a, b in pairwise(pieces)) and order > 1
    inner = np.repeat(places[1:-1], order - 1 if together else order)
    knots = np.concatenate([[0.0] * order, inner, [1.0] * order])
    if not together or count == 1:
        return Strand(pieces.reshape(-1, dimension), knots, order)
    return Strand(np.concatenate([pieces[0], *(piece[1:] for piece in pieces[1:])]), knots, order)


def _pieces(strand: Strand, places: Array) -> Array:
    """Bezier points (n, k, d) of a strand between consecutive places, which hold all its knots."""
    knots = np.repeat(places, strand.order)
    points = on_knots(_snapped(strand.knots, places), strand.order, strand.points, knots)
    return points.reshape(len(places) - 1, strand.order, -1)


def sum_of_products(terms: Sequence[tuple[Strand, Strand]]) -> tuple[Array, Strand, Strand]:
    """Σ f(u) g(w) as a net (m, n, d), with strands that carry the knots and orders of u and of w.

    Each pair holds a vector strand and a scalar one (d = 1), either way round.
    """
    fs, gs = common([f for f, _ in terms]), common([g for _, g in terms])
    net = sum(f.points[:, None] * g.points[None] for f, g in zip(fs, gs, strict=True))
    return np.asarray(net), fs[0], gs[0]


def elevated(points: Array, times: int = 1) -> Array:
    """Bezier points along axis 0 of the same form with its degree raised ``times`` times.

    Q_i = i/n P_(i-1) + (1 - i/n) P_i, with n the old number of points (Farin, Curves and Surfaces for CAGD, 5th ed., "Degree
    Elevation").

    Examples
    --------
    >>> elevated(np.array([[0.0], [4.0]])).ravel().tolist()
    [0.0, 2.0, 4.0]
    """
    for _ in range(times):
        share = (np.arange(len(points) + 1) / len(points)).reshape(-1, *[1] * (points.ndim - 1))
        before, after = np.concatenate([points[:1], points]), np.concatenate([points, points[-1:]])
        points = share * before + (1 - share) * after
    return points
