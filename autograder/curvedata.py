"""A curve or a surface as data: Chebyshev coefficients with an evaluator, and nothing that tells how it was made.

Exercises hand curves, and now and then a surface, to the learner's function. A callable cannot cross into the sandbox without
code crossing with it, and a callable of the reference library would tell its formula; so each is fitted to rounding and crosses
as numbers. The same opaque type is handed over in a learner's own notebook. A curve may consist of pieces; a surface is one
piece and has to be smooth. This module imports numpy only: the sandbox loads it too.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike, NDArray

DEGREE = 32  # of the trial fit on one piece; a piece whose last coefficients do not vanish is halved
MAX_PIECES = 64
SURFACE_DEGREE = 64  # of a surface's fit, in each parameter
EDGE = 1e-12  # parameters this far outside [0, 1] are taken to be rounding


class CurveData:
    """A curve t -> (..., 3) on [0, 1]; call it with a number or an array of any shape.

    Attributes
    ----------
    breaks : (p + 1,) ends of the pieces, from 0 to 1
    coefficients : (p, n, 3) Chebyshev coefficients of each piece on its own [-1, 1]
    """

    __slots__ = ("breaks", "coefficients")

    def __init__(self, breaks: ArrayLike, coefficients: ArrayLike) -> None:
        self.breaks = np.array(breaks, dtype=float)
        self.coefficients = np.array(coefficients, dtype=float)
        pieces = len(self.breaks) - 1
        if self.breaks.ndim != 1 or pieces < 1 or self.coefficients.ndim != 3 or len(self.coefficients) != pieces:
            raise ValueError(
                "a curve of p pieces has p + 1 breaks and coefficients of shape (p, n, dimension); "
                f"got {self.breaks.shape} and {self.coefficients.shape}"
            )
        self.breaks.flags.writeable = False
        self.coefficients.flags.writeable = False

    def __call__(self, t: ArrayLike) -> NDArray[np.float64]:
        """Points at the parameters t, shape ``t.shape + (3,)``."""
        given: NDArray[np.float64] = np.asarray(t, dtype=float)
        inside = (given >= -EDGE) & (given <= 1 + EDGE)
        if not inside.all():
            raise ValueError(
                f"curve(t) is defined for t in [0, 1]; got t = {given[~inside].flat[0]:.6g}. "
                "Pass the parameter itself, not an angle."
            )
        clipped: NDArray[np.float64] = np.clip(given, 0.0, 1.0)
        if len(self.coefficients) == 1:
            return _piece(self.coefficients[0], 2 * clipped - 1)
        result = np.empty((*clipped.shape, self.coefficients.shape[2]))
        piece = np.clip(np.searchsorted(self.breaks, clipped, side="right") - 1, 0, len(self.coefficients) - 1)
        for i in np.unique(piece):
            start, end = self.breaks[i], self.breaks[i + 1]
            here = piece == i
            result[here] = _piece(self.coefficients[i], (2 * clipped[here] - start - end) / (end - start))
        return result

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, CurveData)
            and np.array_equal(self.breaks, other.breaks)
            and np.array_equal(self.coefficients, other.coefficients)
        )

    def __hash__(self) -> int:
        return hash((self.breaks.tobytes(), self.coefficients.tobytes()))

    def __repr__(self) -> str:
        with np.printoptions(precision=4, suppress=True):
            return f"<curve from {self(0.0)} to {self(1.0)}>"


class SurfaceData:
    """A surface (u, w) -> (..., 3) on the unit square; call it with numbers or arrays that broadcast against each other.

    Attributes
    ----------
    coefficients : (n, m, 3) Chebyshev coefficients, along u and along w, each on its own [-1, 1]
    """

    __slots__ = ("coefficients",)

    def __init__(self, coefficients: ArrayLike) -> None:
        self.coefficients = np.array(coefficients, dtype=float)
        if self.coefficients.ndim != 3 or not self.coefficients.size:
            raise ValueError(f"a surface has coefficients of shape (n, m, dimension); got {self.coefficients.shape}")
        self.coefficients.flags.writeable = False

    def __call__(self, u: ArrayLike, w: ArrayLike) -> NDArray[np.float64]:
        """Points at the parameters u and w, their common shape + (3,)."""
        n, m, _ = self.coefficients.shape
        across, along = _polynomials("u", u, n), _polynomials("w", w, m)
        rows = np.tensordot(across, self.coefficients, 1)  # an open mesh stays open here, which makes it cheap
        found: NDArray[np.float64] = np.einsum("...md,...m->...d", rows, along)
        return found

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SurfaceData) and np.array_equal(self.coefficients, other.coefficients)

    def __hash__(self) -> int:
        return hash(self.coefficients.tobytes())

    def __repr__(self) -> str:
        with np.printoptions(precision=4, suppress=True):
            return f"<surface from {self(0.0, 0.0)} to {self(1.0, 1.0)}>"


def _polynomials(name: str, t: ArrayLike, count: int) -> NDArray[np.float64]:
    """The first Chebyshev polynomials at parameters in [0, 1], shape ``t.shape + (count,)``."""
    given: NDArray[np.float64] = np.asarray(t, dtype=float)
    inside = (given >= -EDGE) & (given <= 1 + EDGE)
    if not inside.all():
        raise ValueError(f"surface(u, w) is defined for u and w in [0, 1]; got {name} = {given[~inside].flat[0]:.6g}")
    values = np.asarray(chebyshev.chebvander(2 * np.clip(given, 0.0, 1.0) - 1, count - 1), dtype=np.float64)
    return values.reshape(*given.shape, count)  # NumPy makes arrays of single numbers


def as_data(map: Callable[..., Any]) -> CurveData | SurfaceData:
    """A callable as data: a surface where it needs two arguments, else a curve."""
    if isinstance(map, SurfaceData):
        return map
    try:
        given = inspect.signature(map).parameters.values()
    except (TypeError, ValueError):  # some compiled functions do not tell
        return as_curve(map)
    needed = [p for p in given if p.default is p.empty and p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)]
    return as_surface(map) if len(needed) == 2 else as_curve(map)


def as_surface(surface: Callable[..., Any], *, tolerance: float = 4e-15) -> SurfaceData:
    """Fit a vectorised callable (u, w) -> (..., dimension) on the unit square to rounding, in one piece.

    Raises
    ------
    ValueError
        If a series of degree 64 in each parameter does not suffice, or the callable does not return points.
    """
    if isinstance(surface, SurfaceData):
        return surface
    count = SURFACE_DEGREE + 1
    turns = np.outer(np.arange(count), 2 * np.arange(count) + 1) % (4 * count)  # whole numbers: no rounding in large angles
    cosines = np.cos(np.pi / (2 * count) * turns)
    nodes = (1 + cosines[1]) / 2
    values = np.asarray(surface(nodes[:, np.newaxis], nodes[np.newaxis, :]), dtype=float)
    if values.ndim != 3 or values.shape[:2] != (count, count) or not np.isfinite(values).all():
        raise ValueError(
            f"a surface must map u of shape (n, 1) and w of shape (1, m) to finite points of shape (n, m, 3); "
            f"n = m = {count} gave {values.shape}"
        )
    shares = 2.0 / count * cosines
    shares[0] /= 2
    along = np.tensordot(shares, values, 1)
    coefficients: NDArray[np.float64] = np.swapaxes(np.tensordot(shares, along, (1, 1)), 0, 1)
    small = tolerance * max(float(np.abs(values).max()), 1e-300)
    if max(np.abs(coefficients[-3:]).max(), np.abs(coefficients[:, -3:]).max()) > small * np.sqrt(count):
        raise ValueError(
            f"the surface is not smooth enough to be written as data of degree {SURFACE_DEGREE}: "
            "give a smoother one, without kinks, or a part of it"
        )
    along_u = _trimmed(coefficients.reshape(count, -1), small).reshape(-1, count, values.shape[2])
    along_w = _trimmed(np.swapaxes(along_u, 0, 1).reshape(count, -1), small)
    return SurfaceData(np.swapaxes(along_w.reshape(len(along_w), len(along_u), -1), 0, 1))


def as_curve(curve: Callable[[NDArray[np.float64]], Any], *, tolerance: float = 4e-15) -> CurveData:
    """Fit a vectorised callable t -> (..., dimension) on [0, 1] to rounding.

    Pieces are halved until their Chebyshev series has died away (J. P. Boyd, Chebyshev and Fourier Spectral Methods, 2nd ed.,
    chapter 2). A kink that does not lie on a dyadic fraction cannot be met this way.

    Raises
    ------
    ValueError
        If more than 64 pieces do not suffice, or the callable does not return ``t.shape + (dimension,)``.
    """
    if isinstance(curve, CurveData):
        return curve
    probe = np.asarray(curve(np.linspace(0.0, 1.0, 9)), dtype=float)
    if probe.ndim != 2 or len(probe) != 9 or not np.isfinite(probe).all():
        raise ValueError(
            f"a curve must map t of shape (n,) to finite points of shape (n, 3); nine parameters gave {probe.shape}"
        )
    scale = max(float(np.abs(probe).max()), 1e-300)
    todo, done = [(0.0, 1.0)], []
    while todo:
        start, end = todo.pop()
        coefficients = _interpolant(curve, start, end)
        tail = np.abs(coefficients[-3:]).max()
        if tail <= tolerance * scale * np.sqrt(DEGREE):
            done.append((start, end, _trimmed(coefficients, tolerance * scale)))
        elif len(todo) + len(done) + 2 > MAX_PIECES or end - start < 1 / 4096:
            raise ValueError(
                f"the curve is not smooth enough near t = {start:.6g} to be written as data; "
                "join smooth pieces at halves, quarters, eighths... of [0, 1]"
            )
        else:
            middle = (start + end) / 2
            todo += [(middle, end), (start, middle)]
    length = max(len(piece) for *_, piece in done)
    padded = [np.pad(piece, ((0, length - len(piece)), (0, 0))) for *_, piece in done]
    return CurveData([done[0][0], *(end for _, end, _ in done)], np.stack(padded))


def _piece(coefficients: NDArray[np.float64], x: NDArray[np.float64]) -> NDArray[np.float64]:
    values: NDArray[np.float64] = np.asarray(chebyshev.chebval(x, coefficients), dtype=np.float64)
    return np.moveaxis(values, 0, -1)


def _interpolant(curve: Callable[[NDArray[np.float64]], Any], start: float, end: float) -> NDArray[np.float64]:
    """Chebyshev coefficients (DEGREE + 1, dimension) of the interpolant at the Chebyshev points of the first kind."""
    angles = np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1)
    nodes = np.cos(angles)
    values = np.asarray(curve((start + end) / 2 + (end - start) / 2 * nodes), dtype=float)
    cosines = np.cos(np.outer(np.arange(DEGREE + 1), angles))
    coefficients: NDArray[np.float64] = 2.0 / (DEGREE + 1) * cosines @ values
    coefficients[0] /= 2
    return coefficients


def _trimmed(coefficients: NDArray[np.float64], small: float) -> NDArray[np.float64]:
    needed = np.nonzero((np.abs(coefficients) > small).any(axis=1))[0]
    return coefficients[: needed[-1] + 1] if len(needed) else coefficients[:1]
