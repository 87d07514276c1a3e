"""Adaptive Gauss quadrature of a vectorised function over an interval or the unit square, for lengths and areas."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.polynomial import legendre

from directrix.checks import Array

POINTS = 10  # of the Gauss rule on one cell, each way: exact for polynomials of degree 19
ROUNDS = 40  # of halving, at most
CELLS = 20_000  # at most at once; a kink along a slanted line would ask for ever more
NODES, WEIGHTS = legendre.leggauss(POINTS)
TAIL = legendre.legvander(NODES, POINTS - 1)[:, -2:] * WEIGHTS[:, None]  # values -> their last two Legendre coefficients


def integrate(f: Callable[[Array], Array], breaks: Array, *, tolerance: float = 1e-11) -> float:
    """The integral of f over [0, 1], cells starting at the breaks and halved until halving changes nothing.

    Parameters
    ----------
    f : maps (k,) parameters to (k,) values
    breaks : increasing, from 0 to 1: where f may be less smooth
    tolerance : relative to the integral
    """
    return integrate_square(lambda u, w: f(u), breaks, np.array([0.0, 1.0]), tolerance=tolerance)


def integrate_square(
    f: Callable[[Array, Array], Array], breaks_u: Array, breaks_w: Array, *, tolerance: float = 1e-11
) -> float:
    """The integral of f over the unit square.

    Each cell is halved across the direction in which its Legendre series dies away more slowly, and compared with its halves
    (Davis & Rabinowitz, Methods of Numerical Integration, 2nd ed.); cells that agree are done. A kink along a line
    u = const or w = const is met to the tolerance; along a slanted one the last 20,000 cells are taken as they are, which
    leaves about 1e-9.

    Parameters
    ----------
    f : maps (k,), (k,) parameters to (k,) values
    breaks_u, breaks_w : increasing, from 0 to 1: where f may be less smooth
    tolerance : relative to the integral of |f|, roughly
    """
    cells = np.array([(a, b, c, d) for a, b in pairwise(breaks_u) for c, d in pairwise(breaks_w)])
    values, across = _integrals(f, cells)
    total, size = 0.0, 0.0
    for _ in range(ROUNDS):
        halves = _halved(cells, across)
        finer, finer_across = (part.reshape(len(cells), 2) for part in _integrals(f, halves.reshape(-1, 4)))
        whole = size + np.abs(finer).sum()
        share = np.maximum((cells[:, 1] - cells[:, 0]) * (cells[:, 3] - cells[:, 2]), 1e-4)
        done = np.abs(finer.sum(axis=1) - values) <= tolerance * whole * share
        total, size = total + float(finer[done].sum()), size + float(np.abs(finer[done]).sum())
        cells, values, across = halves[~done].reshape(-1, 4), finer[~done].ravel(), finer_across[~done].ravel()
        if not 0 < len(cells) <= CELLS:
            break
    return total + float(values.sum())


def _halved(cells: Array, across: Array) -> Array:
    """Halves (c, 2, 4) of the cells (c, 4), rows (u from, u to, w from, w to): cut across w where told, else across u."""
    first, second = cells.copy(), cells.copy()
    start = np.where(across > 0, 2, 0)
    rows = np.arange(len(cells))
    middle = (cells[rows, start] + cells[rows, start + 1]) / 2
    first[rows, start + 1], second[rows, start] = middle, middle
    return np.stack([first, second], axis=1)


def _integrals(f: Callable[[Array, Array], Array], cells: Array) -> tuple[Array, Array]:
    """The Gauss sums over cells (c, 4), and 1.0 for each cell that is rougher along w than along u, else 0.0."""
    a, b, c, d = (side[:, None, None] for side in cells.T)
    u, w = (a + b) / 2 + (b - a) / 2 * NODES[:, None], (c + d) / 2 + (d - c) / 2 * NODES
    u, w = np.broadcast_arrays(u, w)
    values = f(u.ravel(), w.ravel()).reshape(u.shape)
    sums = np.einsum("cij,i,j->c", values, WEIGHTS / 2, WEIGHTS / 2) * ((b - a) * (d - c))[:, 0, 0]
    rough_u = np.abs(np.einsum("cij,ik->cjk", values, TAIL)).max(axis=(1, 2))
    rough_w = np.abs(np.einsum("cij,jk->cik", values, TAIL)).max(axis=(1, 2))
    return sums, np.where(rough_w > rough_u, 1.0, 0.0)
