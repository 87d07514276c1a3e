"""Any vectorised callable as a curve."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from directrix import checks
from directrix.checks import Array
from directrix.curves.curve import NUMERIC, Curve
from directrix.differential import numeric_derivative
from directrix.errors import CurveError


class FunctionCurve(Curve):
    """A curve p(u) = f(u) for any vectorised callable f; derivatives up to the second are taken numerically.

    f is called with a one-dimensional array of parameters in [0, 1], whatever the shape the curve was asked for. Derivatives
    come from local Chebyshev interpolants, one-sided at the ends: for a smooth f of size 1 the error is about 1e-12 for the
    first and 1e-9 for the second derivative, near the ends ten times more (``directrix.differential.numeric_derivative``;
    Trefethen, Approximation Theory and Approximation Practice, on spectral methods).

    Parameters
    ----------
    f : callable
        Maps parameters of shape (n,) to points of shape (n, 3), in the unit of length of your choice.

    Raises
    ------
    CurveError
        If f does not take an array, or does not return finite points of shape (n, 3).
    OrderError
        If a derivative above the second is asked for.

    Examples
    --------
    >>> parabola = FunctionCurve(lambda u: np.stack([u, u**2, 0 * u], axis=-1))
    >>> parabola(0.5)
    array([0.5 , 0.25, 0.  ])
    """

    f: Callable[[Array], Any]

    def __init__(self, f: Callable[[Array], Any]) -> None:
        if not callable(f):
            raise CurveError(f"a curve must be a callable u -> (..., 3); got {_described(f)}.")
        self._hold(f=f)
        self._sampled(np.array([0.0, 0.375, 1.0]))

    def _derivative(self, u: Array, n: int) -> Array:
        checks.derivative_order("n", n, most=2, why=NUMERIC)
        flat = u.ravel()
        value = self._sampled(flat) if n == 0 else numeric_derivative(self._sampled, flat, n)
        return value.reshape(*u.shape, 3)

    def _sampled(self, u: Array) -> Array:
        """The function's points (n, 3) at (n,) parameters, looked at before they are used."""
        asked = u.copy()
        try:
            value = np.array(self.f(asked), dtype=np.float64)
        except Exception as error:
            raise CurveError(
                f"a curve must accept an array of parameters; for {len(u)} parameters it raised "
                f"{type(error).__name__}: {error}. Write it with numpy functions, np.cos and not math.cos."
            ) from error
        if value.shape != (len(u), 3):
            raise CurveError(
                f"a curve must return points of shape u.shape + (3,): for u of shape ({len(u)},) that is ({len(u)}, 3); "
                f"got {value.shape}. np.stack([x, y, z], axis=-1) puts the coordinates last; "
                "give each the shape of u (0 * u for 0).",
                got=value.shape,
            )
        if not np.isfinite(value).all():
            at = u[~np.isfinite(value).all(axis=1)][0]
            raise CurveError(
                f"a curve must be finite on [0, 1]; at u = {at:.6g} it gave {value[u == at][0].tolist()}.", got=float(at)
            )
        return value


def as_curve(name: str, curve: Any) -> Curve:
    """A curve of the library as it is, any other callable as a ``FunctionCurve``; else an error that names the argument."""
    if isinstance(curve, Curve):
        return curve
    try:
        return FunctionCurve(curve)
    except CurveError as error:
        raise CurveError(f"{name}: {error}", name=name) from error.__cause__


def _described(value: Any) -> str:
    if isinstance(value, list | tuple | np.ndarray):
        return f"{repr(value)[:60]}; for points use BezierCurve, PointCurve or BSplineCurve"
    return repr(value)[:60]
