"""B-spline functions: the k that are not zero at t, the whole row of them, and the recursion as the lecture writes it.

N_i,1 = 1 on [t_i, t_(i+1)), 0 elsewhere, and the last span of the domain that is not empty is closed on the right;
N_i,q = (t - t_i) / (t_(i+q-1) - t_i) N_i,q-1  +  (t_(i+q) - t) / (t_(i+q) - t_(i+1)) N_(i+1),q-1;  0/0 := 0
(Piegl & Tiller, The NURBS Book, 2nd ed., eq. 2.5, with order q = p + 1). At a repeated knot, where the functions or their
derivatives jump, the side of growing t is taken; at the end of the domain the side of the domain.
"""

from __future__ import annotations

import numpy as np

from directrix.checks import Array, Indices


def spline_span(knots: Array, order: int, t: Array) -> Indices:
    """The index s of the knot span that holds t: t_s <= t < t_(s+1), the last one closed. Integers of the shape of t."""
    last = np.searchsorted(knots, knots[-order], side="left") - 1
    return np.asarray(np.minimum(np.searchsorted(knots, t, side="right") - 1, last))


class SpanTable:
    """`spline_span` for many parameters at once, in a time that does not grow with the number of knots.

    The domain is cut into equal cells, several for each span, and each cell remembers the span in which it begins. A parameter
    takes the span of its cell; where this is wrong, because a knot lies inside the cell, the span is searched for.

    Parameters
    ----------
    knots : (m + k,), non-decreasing
    order : k = degree + 1

    Examples
    --------
    >>> SpanTable(np.array([0.0, 0, 0, 1, 2, 2, 2]), 3)(np.array([0.25, 0.5, 1.0]), np.array([0.5, 1.0, 2.0])).tolist()
    [2, 3, 3]
    """

    CELLS = 16  # for each knot: of equally spaced knots hardly a parameter is searched for

    def __init__(self, knots: Array, order: int) -> None:
        self._knots, self._order = knots, order
        self._count = self.CELLS * (len(knots) - 2 * order + 1)
        ends = np.arange(self._count + 1) / self._count
        self._cells = spline_span(knots, order, (1 - ends) * knots[order - 1] + ends * knots[-order])

    def __call__(self, u: Array, t: Array) -> Indices:
        """The spans that hold t (n,), where t is u (n,) in [0, 1] stretched onto the domain."""
        spans = self._cells[(u * self._count).astype(np.intp)]
        outside = np.flatnonzero((t < self._knots[spans]) | (t >= self._knots[1:][spans]))
        if outside.size:
            spans[outside] = spline_span(self._knots, self._order, t[outside])
        return spans


def spline_planes(knots: Array, order: int, t: Array, span: Indices, derivative: int = 0) -> Array:
    """The k = order functions that are not zero at each t (n,) in a known span, or their derivatives: shape (k, n).

    The triangular scheme in which no denominator can vanish (Piegl & Tiller, The NURBS Book, 2nd ed., algorithm A2.2), one
    function after the other: row j belongs to function span - k + 1 + j. Derivatives by
    N'_i,q+1 = q (N_i,q / (t_(i+q) - t_i) - N_(i+1),q / (t_(i+q+1) - t_(i+1))) (eq. 2.7).

    Examples
    --------
    >>> spline_planes(np.array([0.0, 0, 0, 1, 2, 2, 2]), 3, np.array([0.5, 2.0]), np.array([2, 3])).tolist()
    [[0.25, 0.0], [0.625, 0.0], [0.125, 1.0]]
    """
    if derivative >= order:
        return np.zeros((order, len(t)))
    near = knots.take(span + np.arange(2 - order, order)[:, None])  # the k - 1 knots up to t, and the k - 1 beyond
    below, above = near[: order - 1], near[order - 1 :]
    left, right = t - below, above - t
    values = np.empty((order, len(t)))
    values[0] = 1.0
    for q in range(1, order):  # q functions of order q become q + 1 of order q + 1
        low, high = slice(order - 1 - q, order - 1), slice(q)
        share = above[high] - below[low]
        np.divide(values[:q], share, out=share)
        if q < order - derivative:
            np.multiply(right[high], share, out=values[:q])
            share *= left[low]
        else:
            share *= q
            np.negative(share, out=values[:q])
        values[1:q] += share[:-1]
        values[q] = share[-1]
    return values


def spline_local(knots: Array, order: int, t: Array, derivative: int = 0) -> tuple[Indices, Array]:
    """The k = order functions that are not zero at t, or their derivatives, by `spline_planes`.

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
    planes = spline_planes(knots, order, t.ravel(), span.ravel(), derivative)
    return span - order + 1, planes.T.reshape(*t.shape, order)


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
