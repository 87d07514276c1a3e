"""The polynomials that the forms are made of: powers, Bernstein, Hermite and Lagrange.

Each returns an array ``t.shape + (number of functions,)`` and takes the order of a derivative with respect to t.
"""

from __future__ import annotations

from functools import cache
from math import comb, perm

import numpy as np

from directrix.checks import Array

HERMITE = np.array([[2.0, -2, 1, 1], [-3, 3, -2, -1], [0, 0, 1, 0], [1, 0, 0, 0]])
"""M_F: the Hermite blending functions are [t^3 t^2 t 1] M_F (Mortenson, Geometric Modeling, 3rd ed., "Hermite Curves")."""


def linear(t: Array, start: Array | float, end: Array | float, derivative: int = 0) -> Array:
    """From start at t = 0 to end at t = 1, both met exactly: (1 - t) start + t end, or its derivative.

    Of a vector, pass ``t[..., None]``.
    """
    if derivative == 0:
        return np.asarray((1 - t) * start + t * end)
    slope = np.subtract(end, start, dtype=np.float64) * (derivative == 1)
    return np.broadcast_to(slope, np.broadcast_shapes(np.shape(t), slope.shape))


def monomials(degree: int, t: Array, derivative: int = 0) -> Array:
    """The powers 1, t, ..., t^degree, or their derivatives; 0^0 = 1. Shape t.shape + (degree + 1,)."""
    t = np.asarray(t, dtype=np.float64)
    result = np.zeros((*t.shape, degree + 1))
    power = np.ones(t.shape)
    for i in range(derivative, degree + 1):
        result[..., i] = perm(i, derivative) * power
        power = power * t
    return result


def bernstein(degree: int, t: Array, derivative: int = 0) -> Array:
    """The Bernstein functions B_i(t) = C(n, i) t^i (1 - t)^(n - i) of degree n (order n + 1), or their derivatives.

    B_i' = n (B_{i-1} of degree n - 1  -  B_i of degree n - 1), applied ``derivative`` times
    (Farin, Curves and Surfaces for CAGD, 5th ed., "The Derivative of a Bezier Curve"). Finite at t = 0 and 1, since 0^0 = 1.

    Examples
    --------
    >>> bernstein(2, np.array(0.5)).tolist()
    [0.25, 0.5, 0.25]
    """
    t = np.asarray(t, dtype=np.float64)
    if derivative > degree:
        return np.zeros((*t.shape, degree + 1))
    lower = degree - derivative
    powers = np.empty((lower + 1, 2, *t.shape))  # of t and of 1 - t, one after the other: faster than side by side
    powers[0] = 1.0
    if lower:
        powers[1, 0], powers[1, 1] = t, 1 - t
    for i in range(2, lower + 1):
        np.multiply(powers[i - 1], powers[1], out=powers[i])
    planes = powers[:, 0] * powers[::-1, 1]
    planes[1:-1] *= _inner_binomials(lower).reshape(-1, *[1] * t.ndim)
    values = planes.transpose(*range(1, planes.ndim), 0)
    for n in range(lower + 1, degree + 1):
        values = n * -np.diff(values, axis=-1, prepend=0.0, append=0.0)
    return values


@cache
def _inner_binomials(n: int) -> Array:
    """C(n, 1), ..., C(n, n - 1): all that are not 1."""
    return np.array([comb(n, i) for i in range(1, n)], dtype=np.float64)


def hermite(t: Array, derivative: int = 0) -> Array:
    """The Hermite blending functions F1..F4, for p(0), p(1), p'(0), p'(1), or their derivatives. Shape t.shape + (4,).

    F1 = 2t^3 - 3t^2 + 1, F2 = -2t^3 + 3t^2, F3 = t^3 - 2t^2 + t, F4 = t^3 - t^2
    (Mortenson, Geometric Modeling, 3rd ed., "Hermite Basis Functions").

    Examples
    --------
    >>> hermite(np.array(0.5)).tolist()
    [0.5, 0.5, 0.125, -0.125]
    """
    return np.asarray(monomials(3, t, derivative) @ HERMITE[::-1])


def lagrange(nodes: Array, t: Array, derivative: int = 0) -> Array:
    """The Lagrange polynomials L_i over the nodes, L_i(t_j) = 1 if i = j, else 0, or their derivatives.

    L_i(t) = prod over k != i of (t - t_k) / (t_i - t_k) (NIST Digital Library of Mathematical Functions, eq. 3.3.2).
    A product is differentiated factor by factor, (f (t - t_k))^(j) = f^(j) (t - t_k) + j f^(j-1), which keeps all digits that
    interpolation itself keeps: equally spaced nodes lose about one digit for every three beyond ten.

    Examples
    --------
    >>> lagrange(np.array([0.0, 0.5, 1.0]), np.array([0.5, 0.25])).tolist()
    [[0.0, 1.0, 0.0], [0.375, 0.75, -0.125]]
    """
    t = np.asarray(t, dtype=np.float64)
    result = np.empty((*t.shape, len(nodes)))
    for i, node in enumerate(nodes):
        product = [np.ones(t.shape), *(np.zeros(t.shape) for _ in range(derivative))]
        for other in np.delete(nodes, i):
            for j in range(derivative, -1, -1):
                product[j] = product[j] * (t - other) / (node - other) + (j * product[j - 1] / (node - other) if j else 0.0)
        result[..., i] = product[derivative]
    return result


def de_casteljau(points: Array, t: float) -> tuple[Array, Array, Array]:
    """One point of a Bezier curve by repeated interpolation, the slow honest way, and the control points of both parts.

    Each round replaces neighbours by (1 - t) a + t b, until one point is left; first points of the rounds are the control
    points of the part [0, t], last points those of [t, 1] (Farin, Curves and Surfaces for CAGD, 5th ed., on subdivision).

    Parameters
    ----------
    points : (n + 1, ...) control points of a curve of degree n, along axis 0
    t : where, in [0, 1]

    Returns
    -------
    (point, left, right) : the point, and two arrays of the shape of ``points``

    Examples
    --------
    >>> de_casteljau(np.array([[0.0, 0, 0], [1, 2, 0], [2, 0, 0]]), 0.5)[0].tolist()
    [1.0, 1.0, 0.0]
    """
    rounds = [np.asarray(points, dtype=np.float64)]
    while len(rounds[-1]) > 1:
        rounds.append((1 - t) * rounds[-1][:-1] + t * rounds[-1][1:])
    left = np.stack([line[0] for line in rounds])
    right = np.stack([line[-1] for line in reversed(rounds)])
    return rounds[-1][0], left, right
