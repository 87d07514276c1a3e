"""Derivatives of a quotient A / h of several parameters, from those of the homogeneous form (A, h)."""

from __future__ import annotations

from collections.abc import Sequence
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
    return sorted({below for order in orders for below in product(*(range(n + 1) for n in order))})


def cartesian(parts: dict[Order, Array], orders: Sequence[Order], out: Array | None = None) -> list[Array]:
    """Derivatives of A / h from those of (A, h), given as component planes (4, ...); the answers as arrays (..., 3).

    S^(k) = (A^(k) - Σ C(k, i) h^(i) S^(k-i)) / h, the sum over all 0 != i <= k, with k = (k1, k2, ...) and C(k, i) the product
    of the binomials (Piegl & Tiller, The NURBS Book, 2nd ed., equation 4.20 for two parameters). The parts are used up; the
    answers are written to the planes ``out``, shape (len(orders), 3, ...), if they are given.
    """
    zero = (0,) * len(orders[0])
    inverse, done = 1.0 / parts[zero][3], {}
    places = {} if out is None else dict(zip(orders, out, strict=True))
    scratch = np.empty(parts[zero][:3].shape) if len(parts) > 1 else inverse
    for k, part in sorted(parts.items()):
        value = part[:3]  # worked on in place: fresh memory costs more here than arithmetic
        for i in product(*(range(n + 1) for n in k)):
            if i != zero:
                ways = prod(comb(n, j) for n, j in zip(k, i, strict=True))
                rest = tuple(n - j for n, j in zip(k, i, strict=True))
                value -= np.multiply(done[rest], parts[i][3] if ways == 1 else ways * parts[i][3], out=scratch)
        done[k] = np.multiply(value, inverse, out=places.get(k, value))
    return [np.moveaxis(done[order], 0, -1) for order in orders]
