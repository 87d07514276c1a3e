"""Derivatives of a quotient A / h of several parameters, from those of the homogeneous form (A, h)."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from itertools import product
from math import comb, prod

import numpy as np

from directrix.checks import Array

Order = tuple[int, ...]


def lower(orders: Sequence[Order]) -> list[Order]:
    """All orders that the quotient rule needs to reach the given ones.

    >>> lower([(1, 1)])
    [(0, 0), (0, 1), (1, 0), (1, 1)]
    """
    return [order for order, _ in _rule(tuple(orders))]


def cartesian(parts: dict[Order, Array], orders: Sequence[Order], out: Array | None = None) -> list[Array]:
    """Derivatives of A / h from those of (A, h), given as component planes (4, ...); the answers as arrays (..., 3).

    S^(k) = (A^(k) - Σ C(k, i) h^(i) S^(k-i)) / h, the sum over all 0 != i <= k, with k = (k1, k2, ...) and C(k, i) the product
    of the binomials (Piegl & Tiller, The NURBS Book, 2nd ed., equation 4.20 for two parameters). The parts are used up; the
    answers are written to the planes ``out``, shape (len(orders), 3, ...), if they are given.
    """
    rule = _rule(tuple(orders))
    places = {} if out is None else dict(zip(orders, out, strict=True))
    h = parts[rule[0][0]][3, ...]
    done: dict[Order, Array] = {}
    scratch = h
    over_h: np.ufunc = np.divide
    if len(rule) > 1:
        scratch = np.empty((3, *h.shape))
        np.reciprocal(h, out=h)  # in place: of several derivatives one division a point, and the rest products
        over_h = np.multiply
    for k, terms in rule:
        value = parts[k][:3]  # worked on in place: fresh memory costs more here than arithmetic
        for ways, i, rest in terms:
            value -= np.multiply(done[rest], parts[i][3] if ways == 1 else ways * parts[i][3], out=scratch)
        done[k] = over_h(value, h, out=places.get(k, value))
    return [done[order].transpose(*range(1, h.ndim + 1), 0) for order in orders]


@cache
def _rule(orders: tuple[Order, ...]) -> list[tuple[Order, list[tuple[int, Order, Order]]]]:
    """The orders that are needed, from low to high, each with its terms of the sum: (C(k, i), i, k - i)."""
    found = []
    for k in sorted({below for order in orders for below in product(*(range(n + 1) for n in order))}):
        terms = [
            (prod(map(comb, k, i)), i, tuple(n - j for n, j in zip(k, i, strict=True)))
            for i in product(*(range(n + 1) for n in k))
            if any(i)
        ]
        found.append((k, terms))
    return found
