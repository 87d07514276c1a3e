"""Arrays of parameters and points: what is a grid, how it is cut into blocks of rows, how coordinates become points."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from directrix.checks import Array

BLOCK = 8000  # parameters worked on at a time where much is computed for each: what stays in a processor's cache


def components(x: Array | float, y: Array | float, z: Array | float) -> Array:
    """Three coordinates that broadcast against each other as one array (..., 3)."""
    result = np.empty((*np.broadcast_shapes(np.shape(x), np.shape(y), np.shape(z)), 3))
    result[..., 0], result[..., 1], result[..., 2] = x, y, z
    return result


def is_open_mesh(u: Array, w: Array) -> bool:
    """Whether the parameters are a grid of all u against all w: (n, 1) against (1, m), or one of them a single number."""
    if u.size == 1 or w.size == 1:
        return True
    return u.ndim == 2 and u.shape[1] == 1 and (w.ndim == 1 or (w.ndim == 2 and w.shape[0] == 1))


def full(value: Array, shape: tuple[int, ...]) -> Array:
    """The value as a writable array of this shape: as it is, or broadcast and copied."""
    if value.shape == shape and value.flags.writeable:
        return value
    return np.array(np.broadcast_to(value, shape))


def row_blocks(shape: tuple[int, ...]) -> Iterator[slice]:
    """Slices of the first axis that hold about BLOCK parameters each."""
    step = max(1, BLOCK * shape[0] // math.prod(shape))
    return (slice(start, start + step) for start in range(0, shape[0], step))


def rows_of(given: Array, rows: slice, shape: tuple[int, ...]) -> Array:
    """The part of a parameter array that belongs to these rows of the full shape; all of it, if it has one row for all."""
    return given[rows] if given.ndim == len(shape) and len(given) == shape[0] > 1 else given
