"""Evaluates what is to be drawn on a mesh, or takes what was sampled, and says clearly what is wrong when it cannot be drawn.

Whatever is callable may be drawn: a form of the library, a lambda, a learner's own function. So nothing is assumed of it but
that it takes parameters in [0, 1] and returns points along the last axis.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from directrix import checks
from directrix.errors import CurveError, GeometryError, ShapeError

Array = NDArray[np.float64]
LETTERS = {1: ("u",), 2: ("u", "w"), 3: ("u", "v", "w")}
BEND = np.cos(np.radians(10.0))  # of a line at a sample: in a full turn of 32 steps facets are seen, of 64 hardly


def count_parameters(f: Callable[..., Any]) -> int:
    """How many parameters f takes: 1 for a curve, 2 for a surface, 3 for a solid.

    Raises
    ------
    CurveError
        If f is no function of one, two or three parameters.
    """
    if not callable(f):
        raise CurveError(
            f"a picture needs a function of u and w; got {_described(f)}. Pass the function itself: view(f), not view(f(u, w))."
        )
    try:
        given = inspect.signature(f).parameters.values()
    except (TypeError, ValueError):  # compiled functions without a signature
        return 2
    if any(one.kind is one.VAR_POSITIONAL for one in given):
        return 2
    positional = [one for one in given if one.kind in (one.POSITIONAL_ONLY, one.POSITIONAL_OR_KEYWORD)]
    needed = [one.name for one in positional if one.default is one.empty]
    count = len(needed) or min(len(positional), 2)
    if count not in LETTERS:
        name = getattr(f, "__name__", "f")
        extra = ", ".join(needed[2:])
        raise CurveError(
            f"a picture needs a function of u and w alone; {name} takes {', '.join(needed) or 'nothing'}. "
            f"Fix the others first: view(lambda u, w: {name}(u, w, ...)) with values for {extra or 'them'}."
        )
    return count


def sample(f: Callable[..., Any], *parameters: Array) -> Array:
    """Points of f on the open mesh of the parameters, shape (len(u), len(w), 3) for a surface, (len(u), 3) for a curve.

    Points that are not finite are kept as NaN and drawn as holes.

    Raises
    ------
    ShapeError
        If the answer is no array of points of that shape.
    """
    shape = tuple(len(axis) for axis in parameters)
    mesh = np.meshgrid(*parameters, indexing="ij", sparse=True)
    with np.errstate(all="ignore"):
        answer = f(*mesh)
    letters = LETTERS[len(parameters)]
    try:
        if answer is None:  # which numpy would read as NaN
            raise TypeError
        points = np.asarray(answer, dtype=float)
    except (TypeError, ValueError):
        raise ShapeError(f"a picture needs points (x, y, z) for every {_listed(letters)}; got {_described(answer)}") from None
    if points.shape == (3,):  # a constant answer: one point for all
        points = np.broadcast_to(points, (*shape, 3))
    if points.shape != (*shape, 3):
        raise ShapeError(
            f"for {' and '.join(f'{letter} of shape {axis.shape}' for letter, axis in zip(letters, mesh, strict=True))} "
            f"the points must have shape {(*shape, 3)}; got {points.shape}. {_advice(points, shape)}",
            got=points.shape,
        )
    return np.where(np.isfinite(points), points, np.nan)


def sample_enough(
    counts: Sequence[int], sampled: Callable[[Array, Array], Sequence[Array]]
) -> tuple[Array, Array, Sequence[Array]]:
    """Parameters u (n,) and w (m,), and surfaces sampled at them, (n, m, 3) each, as ``sampled(u, w)`` gives them.

    n is the first of ``counts``, or the last where lines along u would be seen to have corners, or have holes; so is m for w.
    A learner's function may well be slow, and a notebook heavy: most surfaces bend much one way only, or not at all.
    """
    few, many = np.linspace(0.0, 1.0, counts[0]), np.linspace(0.0, 1.0, counts[-1])
    found = sampled(few, few)
    bent = [len(counts) > 1 and any(_bends(points, axis) for points in found) for axis in (0, 1)]
    u, w = (many if one else few for one in bent)
    return u, w, sampled(u, w) if any(bent) else found


def _bends(points: Array, axis: int) -> bool:
    """Whether a line along an axis of a sampled surface (n, m, 3) bends at a sample so much that it is seen, or has a hole."""
    steps = np.diff(points if axis == 0 else points.swapaxes(0, 1), axis=0)
    squares = np.einsum("ijk,ijk->ij", steps, steps)
    along = np.einsum("ijk,ijk->ij", steps[1:], steps[:-1])
    product = np.sqrt(squares[1:] * squares[:-1])
    still = 1e-18 * np.nanmax(squares, initial=0.0)  # at a pole all points of a line are one
    return not ((along >= BEND * product) | (product <= still)).all()


def grid_normals(points: Array) -> Array:
    """Unit normals of a sampled surface (n, m, 3) by differences; (0, 0, 0) where they vanish, as at a pole."""
    rows = np.ascontiguousarray(points.transpose(2, 0, 1))  # a coordinate an array: a third of the time of rows of three
    a, b = _differences(rows), _differences(rows.swapaxes(1, 2)).swapaxes(1, 2)
    normals, product = np.empty_like(rows), np.empty(rows.shape[1:])
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):  # in place: new memory costs as much as the sums in it
        np.multiply(a[j], b[k], out=normals[i])
        normals[i] -= np.multiply(a[k], b[j], out=product)
    length = _lengths(normals)
    unit = np.empty(points.shape)
    with np.errstate(invalid="ignore", divide="ignore"):
        vanishing = ~(length > 1e-9 * np.maximum(_lengths(a) * _lengths(b), 1e-300))
        np.divide(normals, length, out=unit.transpose(2, 0, 1))
    unit[vanishing] = 0.0
    return unit


def _differences(rows: Array) -> Array:
    """Along the second axis, central ones inside and one-sided ones at the ends, as by ``np.gradient``; 0 of a single place."""
    found = np.zeros_like(rows)
    if rows.shape[1] > 1:
        np.subtract(rows[:, 2:], rows[:, :-2], out=found[:, 1:-1])
        found[:, 1:-1] *= 0.5
        found[:, 0], found[:, -1] = rows[:, 1] - rows[:, 0], rows[:, -1] - rows[:, -2]
    return found


def _lengths(rows: Array) -> Array:
    """Lengths of vectors whose coordinates are the rows."""
    squares: Array = rows[0] * rows[0]
    squares += rows[1] * rows[1]
    squares += rows[2] * rows[2]
    return np.sqrt(squares, out=squares)


def deviation(expected: Array, yours: Array) -> Array:
    """Distance between two samplings, point by point; NaN where one of them is not finite."""
    with np.errstate(invalid="ignore", over="ignore"):
        distance: Array = np.linalg.norm(np.asarray(yours) - np.asarray(expected), axis=-1)
    return np.where(np.isfinite(distance), distance, np.nan)


def size_of(*samplings: Array) -> float:
    """Diagonal of the box around all points, never 0."""
    low, high = bounds(*samplings)
    return float(np.linalg.norm(high - low)) or 1.0


def bounds(*samplings: Array) -> tuple[Array, Array]:
    """Lowest and highest finite coordinates of all points.

    Raises
    ------
    GeometryError
        If no point is finite.
    """
    parts = [np.reshape(points, (-1, 3)).T for points in samplings]
    rows = np.ascontiguousarray(parts[0] if len(parts) == 1 else np.concatenate(parts, axis=1))  # a coordinate a row: quick
    if not np.isfinite(rows).all():
        rows = rows[:, np.isfinite(rows).all(axis=0)]
    if not rows.shape[1]:
        raise GeometryError("there is nothing to draw: every point is NaN or infinite. Evaluate it at (0.5, 0.5) and look.")
    return rows.min(axis=1), rows.max(axis=1)


def _advice(points: Array, shape: tuple[int, ...]) -> str:
    if points.shape == (3, *shape):
        return "The coordinates come first: put them last, np.stack([x, y, z], axis=-1)."
    if points.shape == (*shape, 2):
        return "The third coordinate is missing: a plane figure needs z = 0 as well."
    if points.ndim == len(shape) + 1 and points.shape[-1] == 3:
        return "Combine u and w by broadcasting; np.broadcast_arrays(x, y, z) brings the coordinates to one shape."
    return "Return np.stack(np.broadcast_arrays(x, y, z), axis=-1)."


def _listed(letters: tuple[str, ...]) -> str:
    return letters[0] if len(letters) == 1 else f"({', '.join(letters)})"


def _described(value: Any) -> str:
    if value is None:
        return "None: is a return missing?"
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape} and type {value.dtype}"
    text = repr(value)
    return f"{text if len(text) <= 60 else text[:57] + '...'} ({type(value).__name__})"


def axes_of(parameters: Sequence[ArrayLike]) -> list[Array]:
    """The parameters of a sampling, one array (n,) for each.

    Raises
    ------
    ShapeError
        If they are not those of a curve or of a surface.
    """
    if not isinstance(parameters, list | tuple) or len(parameters) not in (1, 2):
        raise ShapeError(
            "a comparison takes the parameters of a curve or of a surface, a list of 1 or 2 arrays; got "
            + (f"{len(parameters)} of them" if isinstance(parameters, list | tuple) else type(parameters).__name__)
        )
    axes = [checks.real("parameters", axis) for axis in parameters]
    for axis in axes:
        if axis.ndim != 1 or not axis.size:
            raise ShapeError(f"each axis of parameters must be a list of numbers, shape (n,); got {axis.shape}", got=axis.shape)
    return axes


def points_on(name: str, given: ArrayLike, axes: list[Array]) -> Array:
    """Points given on these axes; NaN where a coordinate is not finite.

    Raises
    ------
    ShapeError
        If there is not one point for each of the parameters.
    """
    points = checks.real(name, given)
    shape = (*(len(axis) for axis in axes), 3)
    if points.shape != shape:
        raise ShapeError(
            f"{name} must have shape {shape}, one point for each of the parameters given; got {points.shape}", got=points.shape
        )
    return np.where(np.isfinite(points).all(axis=-1, keepdims=True), points, np.nan)
