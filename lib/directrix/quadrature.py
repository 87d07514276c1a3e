"""Adaptive Gauss quadrature of a vectorised function over an interval or the unit square, for lengths and areas."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from directrix.checks import Array

POINTS = 10  # of the Gauss rule on one cell, each way: exact for polynomials of degree 19
ROUNDS = 20  # halvings at most: cells of a millionth
NODES, WEIGHTS = (part / 2 for part in np.polynomial.legendre.leggauss(POINTS))
NODES = NODES + 0.5


def integrate(f: Callable[[Array], Array], breaks: Array, *, tolerance: float = 1e-11) -> float:
    """The integral of f over [0, 1], cells starting at the breaks and halved until halving changes nothing.

    Parameters
    ----------
    f : maps (k,) parameters to (k,) values
    breaks : increasing, from 0 to 1: where f may be less smooth
    tolerance : relative to the integral
    """
    return integrate_square(lambda u, w: f(u), breaks, np.array([0.0, 1.0]), tolerance=tolerance, across=False)


def integrate_square(
    f: Callable[[Array, Array], Array], breaks_u: Array, breaks_w: Array, *, tolerance: float = 1e-11, across: bool = True
) -> float:
    """The integral of f over the unit square; ``across=False`` leaves w undivided.

    Each cell is compared with its halves (Davis & Rabinowitz, Methods of Numerical Integration, 2nd ed., chapter 6);
    cells that agree are done, the others are divided. After 20 halvings what is left is taken as it is: a kink along a
    curve then costs less than 1e-9.
    """
    cells = np.array([(a, b, c, d) for a, b in pairwise(breaks_u) for c, d in pairwise(breaks_w)])
    values, total = _cell_integrals(f, cells), 0.0
    for _ in range(ROUNDS):
        parts = _divided(cells, across=across)
        finer = _cell_integrals(f, parts.reshape(-1, 4)).reshape(len(cells), -1)
        whole = abs(total) + np.abs(finer.sum(axis=1)).sum()
        doubt = np.abs(finer.sum(axis=1) - values)
        done = doubt <= tolerance * whole * np.maximum((cells[:, 1] - cells[:, 0]) * (cells[:, 3] - cells[:, 2]), 1e-4)
        total += float(finer[done].sum())
        if done.all():
            return total
        cells, values = parts[~done].reshape(-1, 4), finer[~done].ravel()
        if len(cells) > 60_000:
            break
    return total + float(values.sum())


def _divided(cells: Array, *, across: bool) -> Array:
    """Halves (c, 2, 4) or quarters (c, 4, 4) of the cells (c, 4), whose rows are u from, u to, w from, w to."""
    a, b, c, d = cells.T
    m, n = (a + b) / 2, (c + d) / 2
    if not across:
        return np.stack([np.stack(row, axis=-1) for row in ((a, m, c, d), (m, b, c, d))], axis=1)
    quarters = ((a, m, c, n), (a, m, n, d), (m, b, c, n), (m, b, n, d))
    return np.stack([np.stack(row, axis=-1) for row in quarters], axis=1)


def _cell_integrals(f: Callable[[Array, Array], Array], cells: Array) -> Array:
    a, b, c, d = (side[:, None, None] for side in cells.T)
    u = (a + (b - a) * NODES[:, None]) + 0 * NODES
    w = (c + (d - c) * NODES) + 0 * NODES[:, None]
    values = f(u.ravel(), w.ravel()).reshape(u.shape)
    return np.asarray(np.einsum("cij,i,j->c", values, WEIGHTS, WEIGHTS) * ((b - a) * (d - c))[:, 0, 0])
