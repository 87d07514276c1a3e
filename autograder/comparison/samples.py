"""The parameters at which answers are compared, and the forms in which a learner's function is asked for them.

A tensor grid with edges and corners (9 x 9 for a surface), points at simple fractions (a B-spline's knots lie there) and points
of the R_n low-discrepancy sequence (M. Roberts, The unreasonable effectiveness of quasirandom sequences, 2018), which have no
symmetry to hide a relabelling. Under a hidden seed the inner grid lines and the sequence are shifted, so that answers learnt
by heart do not help.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Form = Literal["vector", "mesh", "scalar"]
GRID = {1: 33, 2: 9, 3: 5}
SEQUENCE = 64
FRACTIONS = (1 / 3, 3 / 4, 1 / 5, 5 / 6, 1 / 2, 2 / 5, 1 / 6, 2 / 3, 1 / 4, 4 / 5, 3 / 5)
ONE_BY_ONE = 24  # single points that are asked for where a function takes numbers only


@dataclass(frozen=True, eq=False)
class Samples:
    """Points (N, n) of [0, 1]^n. The first ones are the tensor grid of ``axes``, last axis fastest."""

    points: NDArray[np.float64]
    axes: tuple[NDArray[np.float64], ...]

    @property
    def dimension(self) -> int:
        """Number n of parameters."""
        return len(self.axes)

    @cached_property
    def grid(self) -> NDArray[np.intp]:
        """Indices of the tensor grid, shape (9, 9) for a surface."""
        shape = tuple(len(axis) for axis in self.axes)
        return np.arange(math.prod(shape)).reshape(shape)

    @cached_property
    def mesh(self) -> NDArray[np.intp]:
        """Indices of an oblong part of the grid, (9, 7) for a surface: its sides differ, so an exchange of axes shows.

        A curve has no open mesh; its parameters come as a table (3, 11) instead.
        """
        if self.dimension == 1:
            return self.grid.reshape(3, -1)
        return self.grid[np.ix_(*(_without_inner(len(axis), 2 * i) for i, axis in enumerate(self.axes)))]

    @cached_property
    def edges(self) -> dict[tuple[int, int], NDArray[np.intp]]:
        """Indices of the grid points on each side: ``edges[axis, end]``, end 0 or 1."""
        return {(axis, end): np.take(self.grid, -end, axis=axis).ravel() for axis in range(self.dimension) for end in (0, 1)}

    @cached_property
    def corners(self) -> NDArray[np.intp]:
        """Indices of the 2^n corners."""
        return self.grid[np.ix_(*([0, -1] for _ in self.axes))].ravel()

    @cached_property
    def singles(self) -> NDArray[np.intp]:
        """Indices of the points that are asked for one by one: corners, middles of sides, fractions, low-discrepancy points."""
        middles = [side[len(side) // 2] for side in self.edges.values()]
        fractions = math.prod(self.grid.shape) + np.arange(self.dimension * len(FRACTIONS))
        last = np.arange(len(self.points) - ONE_BY_ONE, len(self.points))
        return np.unique(np.concatenate([self.corners, middles, fractions, last]))

    @cached_property
    def inside(self) -> NDArray[np.bool_]:
        """Which points lie off every edge."""
        return np.asarray(((self.points > 0) & (self.points < 1)).all(axis=1))

    def columns(self, indices: NDArray[np.intp] | slice = slice(None)) -> tuple[NDArray[np.float64], ...]:
        """The parameters of some points as n read-only vectors."""
        return tuple(read_only(column) for column in self.points[indices].T.copy())

    def open_mesh(self) -> tuple[NDArray[np.float64], ...]:
        """The axes of :attr:`mesh` as n arrays that broadcast against each other, (9, 1) and (1, 7)."""
        if self.dimension == 1:
            return (read_only(self.axes[0].reshape(3, -1).copy()),)
        axes = [axis[_without_inner(len(axis), 2 * i)] for i, axis in enumerate(self.axes)]
        return tuple(read_only(a.copy()) for a in np.ix_(*axes))


def read_only(array: NDArray[np.float64]) -> NDArray[np.float64]:
    """The same array, closed for writing."""
    array.flags.writeable = False
    return array


def low_discrepancy(n: int, count: int, start: NDArray[np.float64] | float = 0.5) -> NDArray[np.float64]:
    """``count`` points of the R_n sequence, x_k = start + k (1/g, 1/g², ...) mod 1 where g^(n+1) = g + 1."""
    points: NDArray[np.float64] = (start + _steps(n, count)) % 1.0
    return points


@functools.cache
def _steps(n: int, count: int) -> NDArray[np.float64]:
    g = 2.0
    for _ in range(64):
        g = (1 + g) ** (1 / (n + 1))
    return read_only(np.arange(1, count + 1)[:, None] * g ** -np.arange(1.0, n + 1))


def samples(n: int, rng: np.random.Generator | None = None, *, keep_grid: bool = False) -> Samples:
    """The sample points of n parameters; with ``rng`` the sequence and, unless ``keep_grid``, inner grid lines are shifted.

    A mask keeps its grid: u + w = 1 is met exactly there.
    """
    count = GRID[n]
    axes = []
    even = np.linspace(0.0, 1.0, count)
    for _ in range(n):
        axis = even.copy()
        if rng is not None and not keep_grid:
            axis[1:-1] += rng.uniform(-0.3, 0.3, count - 2) / (count - 1)
        axes.append(read_only(axis))
    on_grid, spread_out = count**n, SEQUENCE + n * len(FRACTIONS)
    points = np.empty((on_grid + spread_out, n))
    grid = points[:on_grid].reshape(*[count] * n, n)
    for i, axis in enumerate(axes):
        grid[..., i] = axis.reshape(-1, *[1] * (n - 1 - i))
    points[on_grid:] = low_discrepancy(n, spread_out, 0.5 if rng is None else rng.uniform(size=n))
    for i in range(n):
        first = on_grid + i * len(FRACTIONS)
        points[first : first + len(FRACTIONS), i] = FRACTIONS
    return Samples(read_only(points), tuple(axes))


def _without_inner(count: int, dropped: int) -> list[int]:
    """Indices 0 .. count-1 without ``dropped`` of the inner ones, ends kept."""
    return [0, *range(min(dropped, count - 2) + 1, count)]
