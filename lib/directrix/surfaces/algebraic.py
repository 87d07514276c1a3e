"""The algebraic form: powers of u and w with vector coefficients."""

from __future__ import annotations

from math import comb

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.basis import monomials
from directrix.checks import Array
from directrix.surfaces.tensor import TensorPatch, window
from directrix.transform import Transform


class AlgebraicPatch(TensorPatch):
    """The polynomial patch S(u, w) = Σ_i Σ_j a_ij u^i w^j, of any degrees.

    ``a[i, j]`` multiplies u^i w^j: powers ascend. Textbooks print (u³ u² u 1): reverse both axes of their matrix
    (Mortenson, Geometric Modeling, 3rd ed.). Its numbers are derivatives: a_00 = S, a_10 = S_u, a_11 = S_uw at
    (0, 0). Derivatives to any order. A bicubic patch has 16 coefficients, 48 numbers; cubic by quadratic 36.

    Parameters
    ----------
    a : (m, n, 3), m, n >= 1, in any one unit of length
        Degree m - 1 (order m) in u, n - 1 (order n) in w.

    Raises
    ------
    ShapeError
        If a is not of shape (m, n, 3).
    NumberError
        If a coefficient is not finite.

    Examples
    --------
    >>> saddle = AlgebraicPatch([[(0, 0, 0), (0, 1, 0)], [(1, 0, 0), (0, 0, 1)]])      # (u, w, uw)
    >>> saddle(0.5, 0.25)
    array([0.5  , 0.25 , 0.125])
    >>> saddle.derivative(0.5, 0.25, 1, 1)
    array([0., 0., 1.])
    """

    a: Array

    def __init__(self, a: ArrayLike) -> None:
        self._hold(a=checks.net("a", a, least=1))

    def _net(self) -> Array:
        return self.a

    def _functions_u(self, u: Array, order: int) -> Array:
        return monomials(len(self.a) - 1, u, order)

    def _functions_w(self, w: Array, order: int) -> Array:
        return monomials(self.a.shape[1] - 1, w, order)

    def moved(self, transform: Transform) -> AlgebraicPatch:
        """The patch under an affine map: its coefficients are vectors, and only a_00 is a point."""
        a = transform.vectors(self.a)
        a[0, 0] += transform.offset
        return AlgebraicPatch(a)

    def patch(self, u0: float, u1: float, w0: float, w1: float) -> AlgebraicPatch:
        """The part from (u0, w0) to (u1, w1) as an algebraic patch of its own: u0 + (u1 - u0) u multiplied out."""
        u0, u1, w0, w1 = window(u0, u1, w0, w1)
        m, n = self.a.shape[:2]
        return AlgebraicPatch(np.einsum("ik,jl,klc->ijc", _substituted(m, u0, u1), _substituted(n, w0, w1), self.a))

    def swap(self) -> AlgebraicPatch:
        """The same surface with u and w exchanged."""
        return AlgebraicPatch(self.a.swapaxes(0, 1))


def _substituted(count: int, start: float, end: float) -> Array:
    """T with (start + (end - start) t)^k = Σ_i T[i, k] t^i."""
    T = np.zeros((count, count))
    for k in range(count):
        for i in range(k + 1):
            T[i, k] = comb(k, i) * start ** (k - i) * (end - start) ** i
    return T
