"""Derivatives of a quotient: what all rational forms of one parameter share."""

from __future__ import annotations

from collections.abc import Callable
from math import comb

import numpy as np

from directrix.checks import Array


def quotient(homogeneous: Callable[[int], Array], n: int) -> Array:
    """The n-th derivative of A / h, from derivatives of the homogeneous curve (A, h).

    C^(n) = (A^(n) - sum over i = 1..n of C(n, i) h^(i) C^(n - i)) / h (Piegl & Tiller, The NURBS Book, 2nd ed., eq. 4.8; their
    w is our weight h).

    Parameters
    ----------
    homogeneous : derivative order -> array (..., 4): x h, y h, z h, h
    n : order of the derivative
    """
    parts = [homogeneous(i) for i in range(n + 1)]
    weight = parts[0][..., 3:]
    result: list[Array] = []
    for i, part in enumerate(parts):
        rest = part[..., :3]
        for j in range(1, i + 1):
            rest = rest - comb(i, j) * parts[j][..., 3:] * result[i - j]
        result.append(rest / weight)
    return result[n]


def lift(points: Array, weights: Array) -> Array:
    """Homogeneous control points (..., 4): Cartesian points multiplied by their weights, and the weights."""
    return np.concatenate([points * weights[..., None], weights[..., None]], axis=-1)
