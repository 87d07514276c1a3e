"""B-spline functions: the k that are not zero at t, the whole row of them, and the recursion as the lecture writes it.

N_i,1 = 1 on [t_i, t_(i+1)), 0 elsewhere, and the last span of the domain that is not empty is closed on the right;
N_i,q = (t - t_i) / (t_(i+q-1) - t_i) N_i,q-1  +  (t_(i+q) - t) / (t_(i+q) - t_(i+1)) N_(i+1),q-1;  0/0 := 0
(Piegl & Tiller, The NURBS Book, 2nd ed., eq. 2.5, with order q = p + 1). At a repeated knot, where the functions or their
derivatives jump, the side of growing t is taken; at the end of the domain the side of the domain.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from directrix.checks import Array, Indices


def spline_span(knots: Array, order: int, t: Array) -> Indices:
    """The index s of the knot span that holds t: t_s <= t < t_(s+1), the last one closed. Integers of the shape of t."""
    last = np.searchsorted(knots, knots[-order], side="left") - 1
    return np.asarray(np.minimum(np.searchsorted(knots, t, side="right") - 1, last))


def spline_local(knots: Array, order: int, t: Array, derivative: int = 0) -> tuple[Indices, Array]:
    """The k = order functions that are not zero at t, or their derivatives.

    The triangular scheme in which no denominator can vanish (Piegl & Tiller, The NURBS Book, 2nd ed., algorithm A2.2);
    derivatives by N'_i,q+1 = q (N_i,q / (t_(i+q) - t_i) - N_(i+1),q / (t_(i+q+1) - t_(i+1))) (eq. 2.7).

    Parameters
    ----------
    knots : (m + k,), non-decreasing
    order : k = degree + 1
    t : parameters in the domain [knots[k - 1], knots[m]], any shape
    derivative : order of the derivative with respect to t

    Returns
    -------
    (first, values) : ``values[..., j]`` belongs to function ``first + j``; shapes t.shape and t.shape + (k,)

    Examples
    --------
    >>> first, values = spline_local(np.array([0.0, 0, 0, 1, 2, 2, 2]), 3, np.array([0.5, 2.0]))
    >>> first.tolist(), values.tolist()
    ([0, 1], [[0.25, 0.625, 0.125], [0.0, 0.0, 1.0]])
    """
    t = np.asarray(t, dtype=np.float64)
    span = spline_span(knots, order, t)
    first = span - order + 1
    if derivative >= order:
        return first, np.zeros((*t.shape, order))
    rows = [np.ones(t.shape)]
    for q in range(1, order - derivative):
        carried, lower = np.zeros(t.shape), rows
        rows = []
        for j in range(q):
            left, right = knots[span + 1 + j - q], knots[span + 1 + j]
            share = lower[j] / (right - left)
            rows.append(carried + (right - t) * share)
            carried = (t - left) * share
        rows.append(carried)
    for q in range(order - derivative, order):
        shares = [q * row / (knots[span + 1 + j] - knots[span + 1 + j - q]) for j, row in enumerate(rows)]
        rows = [-shares[0], *(before - after for before, after in pairwise(shares)), shares[-1]]
    return first, np.stack(rows, axis=-1)


def spline_row(knots: Array, order: int, t: Array, derivative: int = 0) -> Array:
    """All m functions at t, or their derivatives: shape t.shape + (m,), at most k = order of a row not zero.

    >>> spline_row(np.array([0.0, 0, 1, 2, 2]), 2, np.array([0.5, 1.5])).tolist()
    [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5]]
    """
    first, values = spline_local(knots, order, t, derivative)
    result = np.zeros((*values.shape[:-1], len(knots) - order))
    np.put_along_axis(result, first[..., None] + np.arange(order), values, axis=-1)
    return result


def cox_de_boor(knots: Array, order: int, t: float) -> Array:
    """All m functions of one order at one t by the recursion itself: slow, and the same as the formula above, line by line.

    >>> cox_de_boor(np.array([0.0, 0, 0, 1, 2, 2, 2]), 3, 2.0).tolist()
    [0.0, 0.0, 0.0, 1.0]
    """
    end = knots[-order]
    last = max(i for i in range(len(knots) - 1) if knots[i] < knots[i + 1] <= end)
    functions = [1.0 if knots[i] <= t < knots[i + 1] or (i == last and t == end) else 0.0 for i in range(len(knots) - 1)]
    if t == end:  # the span that begins at the end lies outside the domain
        functions = [value if i == last else 0.0 for i, value in enumerate(functions)]
    for q in range(2, order + 1):
        functions = [
            _ratio(t - knots[i], knots[i + q - 1] - knots[i]) * functions[i]
            + _ratio(knots[i + q] - t, knots[i + q] - knots[i + 1]) * functions[i + 1]
            for i in range(len(knots) - q)
        ]
    return np.array(functions)


def _ratio(a: float, b: float) -> float:
    """a / b, and 0 where b = 0: the convention of the recursion."""
    return a / b if b else 0.0
