"""A curve as data: piecewise Chebyshev coefficients with an evaluator, and nothing that tells how it was made.

Exercises hand curves to the learner's function. A callable cannot cross into the sandbox without code crossing with it, and a
callable of the reference library would tell its formula; so every curve is fitted to rounding and crosses as numbers. The
same opaque type is handed over in a learner's own notebook. This module imports numpy only: the sandbox loads it too.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike, NDArray

DEGREE = 32  # of the trial fit on one piece; a piece whose last coefficients do not vanish is halved
MAX_PIECES = 64
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


def as_curve(curve: Callable[[NDArray[np.float64]], Any], *, tolerance: float = 4e-15) -> CurveData:
    """Fit a vectorised callable t -> (..., dimension) on [0, 1] to rounding.

    Pieces are halved until their Chebyshev series has died away (J. P. Boyd, Chebyshev and Fourier Spectral Methods, 2nd ed.,
    sections 2.3 and 2.12). A kink that does not lie on a dyadic fraction cannot be met this way.

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
