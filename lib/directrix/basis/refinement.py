"""The same spline on other knots or of higher degree, by blossoms: knot insertion, clamping, cutting, degree elevation.

The blossom f[a_1, ..., a_p] of a polynomial of degree p is the one function that is symmetric, affine in each argument and
f[t, ..., t] = f(t). The control points of a spline are its blossom at neighbouring knots, P_j = f[t_(j+1), ..., t_(j+p)], so
the control points on any finer knots are blossoms too, and nothing is ever fitted (L. Ramshaw, Blossoms are polar forms, CAGD 6
(1989) 323-358; Piegl & Tiller, The NURBS Book, 2nd ed., chapter 5, has the same results by algorithms of their own).
"""

from __future__ import annotations

import numpy as np

from directrix.basis.spline import spline_span
from directrix.checks import Array


def blossom(knots: Array, order: int, points: Array, span: int, arguments: Array) -> Array:
    """The blossom of a spline's polynomial piece on [t_span, t_(span+1)], at degree = order - 1 arguments.

    de Boor's recursion with a new argument in each round: d_i <- (1 - α) d_(i-1) + α d_i, α = (a_r - t_i)/(t_(i+p+1-r) - t_i).

    Parameters
    ----------
    knots : (m + k,)
    points : (m, ...) control points along axis 0
    span : index of a span that is not empty, inside the domain
    arguments : (k - 1,)

    Examples
    --------
    >>> line = np.array([[0.0], [2.0], [4.0]])
    >>> blossom(np.array([0.0, 0, 0, 2, 2, 2]), 3, line, 2, np.array([0.0, 1.0])).tolist()
    [1.0]
    """
    degree = order - 1
    near = np.array(points[span - degree : span + 1])
    for r, a in enumerate(arguments, start=1):
        for i in range(span, span - degree + r - 1, -1):
            share = (a - knots[i]) / (knots[i + degree + 1 - r] - knots[i])
            j = i - span + degree
            near[j] = (1 - share) * near[j - 1] + share * near[j]
    return np.asarray(near[degree])


def on_knots(knots: Array, order: int, points: Array, values: Array) -> Array:
    """Control points of the same spline on other knots, of the same order.

    Parameters
    ----------
    knots : (m + k,) the old knots
    order : k = degree + 1
    points : (m, ...) old control points along axis 0
    values : the new knots, none more than k times; on their domain, which lies in the old one, every old knot occurs at least
        as often as before (k times if it was more)

    Returns
    -------
    (len(values) - k, ...)

    Examples
    --------
    >>> on_knots(np.array([0.0, 0, 2, 2]), 2, np.array([[0.0], [4.0]]), np.array([0.0, 0, 1, 2, 2])).ravel().tolist()
    [0.0, 2.0, 4.0]
    """
    spans = _pieces(knots, order, values, order)
    return np.stack([blossom(knots, order, points, span, values[j + 1 : j + order]) for j, span in enumerate(spans)])


def raised(knots: Array, order: int, points: Array) -> tuple[Array, Array]:
    """Knots and control points of the same spline with its degree raised by one; each distinct knot of the domain once more.

    F[a_0, ..., a_p] = Σ_i f[all but a_i] / (p + 1). Ends that are not clamped become so.

    Examples
    --------
    >>> raised(np.array([0.0, 0, 1, 1]), 2, np.array([[0.0], [4.0]]))[1].ravel().tolist()
    [0.0, 2.0, 4.0]
    """
    start, end = knots[order - 1], knots[-order]
    distinct, counts = np.unique(knots[(knots > start) & (knots < end)], return_counts=True)
    inner = np.repeat(distinct, np.minimum(counts, order) + 1)
    values = np.concatenate([[start] * (order + 1), inner, [end] * (order + 1)])
    result = []
    for j, span in enumerate(_pieces(knots, order, values, order + 1)):
        arguments = values[j + 1 : j + order + 1]
        parts = [blossom(knots, order, points, span, np.delete(arguments, i)) for i in range(order)]
        result.append(sum(parts[1:], parts[0]) / order)
    return values, np.stack(result)


def bezier_extraction(knots: Array, order: int) -> Array:
    """What makes Bezier points of a spline's control points, for each span of the domain: shape (m - k + 1, k, k).

    Entry [i] times control points i, ..., i + k - 1 is the k Bezier points of the piece on [t_(i+k-1), t_(i+k)]: `blossom` at
    all spans at once. All entries are at least 0 and each row sums to 1; those of an empty span are 0 (M. J. Borden,
    M. A. Scott, J. A. Evans, T. J. R. Hughes, Int. J. Numer. Meth. Engng 87 (2011) 15-47).

    Examples
    --------
    >>> bezier_extraction(np.array([0.0, 0, 0, 1, 2, 2, 2]), 3).tolist()[0]
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.5, 0.5]]
    """
    degree = order - 1
    first = np.flatnonzero(knots[degree:-order] < knots[order : len(knots) - degree])
    start, end = knots[first + degree, None], knots[first + order, None]
    result = np.zeros((len(knots) - 2 * order + 1, order, order))
    for row in range(order):  # arguments: the end of the span ``row`` times, else its start
        near = np.tile(np.eye(order), (len(first), 1, 1))
        for r in range(1, order):
            low = first[:, None] + np.arange(r, order)
            share = ((end if r <= row else start) - knots[low]) / (knots[low + order - r] - knots[low])
            near[:, r:] = (1 - share)[..., None] * near[:, r - 1 : -1] + share[..., None] * near[:, r:]
        result[first, row] = near[:, degree]
    return result


def derived(knots: Array, order: int, points: Array) -> tuple[Array, Array]:
    """Knots and control points, along axis 0, of the derivative of a spline: order - 1, one point and two knots less.

    P'_i = (k - 1) (P_(i+1) - P_i) / (t_(i+k) - t_(i+1)), 0 for a function that is zero everywhere (Piegl & Tiller, The NURBS
    Book, 2nd ed., eq. 3.4).

    Examples
    --------
    >>> derived(np.array([0.0, 0, 2, 2]), 2, np.array([[0.0], [4.0]]))[1].ravel().tolist()
    [2.0]
    """
    wide = knots[order:-1] - knots[1:-order]
    speed = np.divide(order - 1, wide, out=np.zeros_like(wide), where=wide > 0)
    return knots[1:-1], np.diff(points, axis=0) * speed.reshape(-1, *[1] * (points.ndim - 1))


def clamped(knots: Array, order: int, start: float, end: float, times: int = 0) -> Array:
    """Knots for the part [start, end] of a spline: both ends ``order`` times, each inner knot ``times`` to ``order`` times.

    A constant, order 1 without a knot inside, gets one halfway: a net has two points at least.

    Examples
    --------
    >>> clamped(np.array([0.0, 1, 2, 3, 4]), 2, 1.5, 3.0).tolist()
    [1.5, 1.5, 2.0, 3.0, 3.0]
    """
    inner = knots[(knots > start) & (knots < end)]
    distinct, counts = np.unique(inner, return_counts=True)
    inner = np.repeat(distinct, np.clip(counts, times, order))
    if order == 1 and not inner.size:
        inner = np.array([(start + end) / 2])
    return np.concatenate([[start] * order, inner, [end] * order])


def _pieces(knots: Array, order: int, values: Array, new_order: int) -> list[int]:
    """For each new basis function a span of the old knots in which it does not vanish."""
    start, end = values[new_order - 1], values[-new_order]
    middles = []
    for j in range(len(values) - new_order):
        support = values[j : j + new_order + 1]
        wide = np.nonzero((np.diff(support) > 0) & (support[:-1] >= start) & (support[1:] <= end))[0]
        middles.append((support[wide[0]] + support[wide[0] + 1]) / 2)
    return [int(span) for span in spline_span(knots, order, np.array(middles))]
