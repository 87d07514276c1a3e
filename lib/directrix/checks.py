"""What every form asks of its arguments, in one place: each check returns the clean value or says what to try.

Arrays come back as fresh, read-only float64 copies. Parameters within 1e-12 of [0, 1] are clamped.
"""

from __future__ import annotations

import numbers
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from directrix.errors import DegenerateError, DomainError, NumberError, OrderError, ShapeError, WeightError

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
Mask = NDArray[np.bool_]

EDGE = 1e-12  # a parameter this far outside [0, 1] is rounding of the caller's; further out is an error
LARGEST = 1e75  # of a number or coordinate: products of four of them are still floats
COLLINEAR = 1e-12  # sine of the angle below which two directions are one
HIGHEST = 64  # order of a derivative: beyond it binomials and powers are no numbers worth having


def real(name: str, value: Any) -> Array:
    """A float64 array of real numbers, NaN and infinity among them, of any shape."""
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise ShapeError(
            f"{name} must be real numbers; got an array of which {int(np.sum(value.mask))} are masked. "
            "Leave those out, or give them a value with .filled().",
            name=name,
        )
    try:
        given = np.asarray(value)
        if given.dtype.kind not in "biuf":
            if given.dtype.kind != "O":
                raise TypeError(f"an array of {given.dtype}")
            if any(item is None for item in given.flat):
                raise TypeError("None stands for no number")
            given = given.astype(np.float64)
        return np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        kind = "rows of unequal length" if "inhomogeneous" in str(error) else repr(value)[:60]
        raise ShapeError(f"{name} must be real numbers; got {kind}.", name=name) from None


def array(name: str, value: Any) -> Array:
    """A fresh float64 array of finite real numbers of at most 1e75, of any shape."""
    given = real(name, value)
    if not np.isfinite(given).all():
        raise NumberError(
            f"{name} must be finite; got {_first_bad(given)}. Look for a division by zero in what made it.", name=name
        )
    if given.size and (most := float(np.abs(given).max())) > LARGEST:
        raise NumberError(
            f"{name} must be at most {LARGEST:g} in size; got {most:g}. Products of such numbers overflow: "
            "choose a larger unit.",
            name=name,
            got=most,
        )
    return np.array(given, dtype=np.float64)


def number(name: str, value: Any) -> float:
    """A finite real number."""
    given = array(name, value)
    if given.ndim:
        raise ShapeError(f"{name} must be one number; got an array of shape {given.shape}.", name=name, got=given.shape)
    return float(given)


def positive(name: str, value: Any) -> float:
    """A number above 0."""
    given = number(name, value)
    if given <= 0:
        raise NumberError(f"{name} must be greater than 0; got {given:g}.", name=name, got=given)
    return given


def not_negative(name: str, value: Any) -> float:
    """A number of at least 0."""
    given = number(name, value)
    if given < 0:
        raise NumberError(f"{name} must be at least 0; got {given:g}.", name=name, got=given)
    return given


def not_zero(name: str, value: Any) -> float:
    """A number other than 0."""
    given = number(name, value)
    if given == 0:
        raise NumberError(f"{name} must not be 0: the surface would collapse to a curve.", name=name, got=given)
    return given


def choice(name: str, value: Any, choices: Sequence[str], *, hint: str = "") -> str:
    """One of a few words."""
    if not isinstance(value, str) or value not in choices:
        words = ", ".join(repr(word) for word in choices)
        raise NumberError(f"{name} must be one of {words}; got {value!r}.{hint and ' ' + hint}", name=name, got=value)
    return value


def point(name: str, value: Any) -> Array:
    """A point or vector of shape (3,)."""
    given = array(name, value)
    if given.shape != (3,):
        hint = " Put it into space with z = 0." if given.shape == (2,) else ""
        raise ShapeError(f"{name} must have shape (3,); got {given.shape}.{hint}", name=name, got=given.shape)
    return _locked(given)


def vector(name: str, value: Any) -> Array:
    """A vector of shape (3,) that is not zero, as given."""
    given = point(name, value)
    if not given.any():
        raise DegenerateError(f"{name} must not be the zero vector: it gives no direction.", name=name)
    return given


def direction(name: str, value: Any) -> Array:
    """A direction of any length but 0, made unit."""
    given = vector(name, value)
    return _locked(given / length(given))


def length(given: Array) -> float:
    """Euclidean length, safe from overflow and underflow of the squares."""
    largest = float(np.abs(given).max())
    return largest * float(np.linalg.norm(given / largest)) if largest else 0.0


def points(name: str, value: Any, *, least: int = 2) -> Array:
    """Points of shape (n, 3) with n >= least."""
    given = array(name, value)
    if given.ndim != 2 or given.shape[1] != 3 or len(given) < least:
        raise ShapeError(
            f"{name} must have shape (n, 3) with n >= {least}; got {given.shape}.{_points_hint(given)}",
            name=name,
            got=given.shape,
        )
    return _locked(given)


def net(name: str, value: Any, *, least: int = 2) -> Array:
    """A control net of shape (m, n, 3), m points along u (axis 0) and n along w (axis 1)."""
    given = array(name, value)
    if given.ndim != 3 or given.shape[2] != 3 or min(given.shape[:2]) < least:
        raise ShapeError(
            f"{name} must have shape (m, n, 3) with m, n >= {least}; got {given.shape}.{_net_hint(given)}",
            name=name,
            got=given.shape,
        )
    return _locked(given)


def weights(name: str, value: Any, shape: tuple[int, ...]) -> Array:
    """Weights, one for each control point, all above 0 (and at least 1e-75, so that their ratios do not overflow)."""
    given = array(name, value)
    if given.shape != shape:
        raise ShapeError(
            f"{name} must have shape {shape}, one weight for each control point; got {given.shape}.", name=name, got=given.shape
        )
    if (given <= 0).any():
        where = tuple(int(i) for i in np.argwhere(given <= 0)[0])
        rule = f"must all be greater than 0; {name}{list(where)} is" if where else "must be greater than 0; got"
        raise WeightError(
            f"{name} {rule} {given[where]:g}. A point of weight 0 or less can send the form to infinity.",
            name=name,
            got=float(given[where]),
        )
    if given.size and given.min() < 1 / LARGEST:
        raise WeightError(f"{name} must be at least {1 / LARGEST:g}; got {given.min():g}.", name=name, got=float(given.min()))
    return _locked(given)


def whole(name: str, value: Any, *, least: int = 0) -> int:
    """An integer of at least ``least``."""
    if isinstance(value, bool | np.bool_) or not isinstance(value, numbers.Integral) or value < least:
        raise OrderError(f"{name} must be a whole number of at least {least}; got {value!r}.", name=name, got=value)
    return int(value)


def order(name: str, value: Any, count: int) -> int:
    """An order k = degree + 1 that ``count`` control points can carry: 1 <= k <= count."""
    k = whole(name, value, least=1)
    if k > count:
        raise OrderError(
            f"{name} must be at most the number of control points; got order {k} (degree {k - 1}) for {count} points. "
            f"Lower the order to {count} or give more points.",
            name=name,
            got=k,
            count=count,
        )
    return k


def increasing(name: str, value: Any, count: int) -> Array:
    """Parameter values of an interpolating form: ``count`` of them, increasing from 0 to 1."""
    given = array(name, value)
    if given.shape != (count,):
        raise ShapeError(
            f"{name} must have shape ({count},), one parameter for each point; got {given.shape}.", name=name, got=given.shape
        )
    if given[0] != 0 or given[-1] != 1 or (np.diff(given) <= 0).any():
        raise NumberError(f"{name} must increase from 0 to 1; got {given.tolist()}.", name=name, got=given)
    return _locked(given)


def parameter(name: str, value: ArrayLike) -> Array:
    """Parameters in [0, 1], clamped where they are outside by less than 1e-12."""
    given = real(name, value)
    if given.size == 0:
        return given
    least, most = np.minimum.reduce(given, axis=None), np.maximum.reduce(given, axis=None)  # as min and max, but quicker
    if least >= 0 and most <= 1:
        return given
    if not (least >= -EDGE and most <= 1 + EDGE):  # written so that NaN lands here too
        bad = given[~((given >= -EDGE) & (given <= 1 + EDGE))].flat[0]
        raise DomainError(
            f"{name} must lie in [0, 1]; got {name} = {bad:.6g}. Pass the parameter itself, not an angle or a knot value.",
            name=name,
            got=float(bad),
        )
    return np.clip(given, 0.0, 1.0)


def inside(name: str, value: Any) -> float:
    """A parameter strictly between 0 and 1, where something can be cut in two."""
    at = number(name, value)
    if not 0 < at < 1:
        raise DomainError(f"{name} must lie strictly between 0 and 1 to split there; got {at:g}.", name=name, got=at)
    return at


def broadcast(**parameters: Array) -> tuple[int, ...]:
    """The common shape of parameter arrays."""
    try:
        return np.broadcast(*parameters.values()).shape
    except ValueError:
        shapes = " and ".join(f"{name} of shape {given.shape}" for name, given in parameters.items())
        names = list(parameters)
        raise ShapeError(
            f"{', '.join(names)} must broadcast against each other; got {shapes}. For a grid write "
            f"{names[0]}[:, None] and {names[-1]}[None, :].",
        ) from None


def derivative_order(name: str, value: Any, *, most: int = HIGHEST, why: str = "") -> int:
    """The order of a derivative: a whole number of at least 0 and at most ``most``, which is less where the form is numeric."""
    n = whole(name, value)
    if n > most:
        raise OrderError(f"{name} must be at most {most} here; got {n!r:.30}. {why}".rstrip(), name=name, got=n)
    return n


def spanning(message: str, a: Array, b: Array) -> None:
    """Two vectors must span a plane; ``message`` says what that means to the caller."""
    long_a, long_b = length(a), length(b)
    if not long_a or not long_b or length(np.cross(a / long_a, b / long_b)) <= COLLINEAR:
        raise DegenerateError(message)


def _first_bad(given: Array) -> str:
    where = tuple(int(i) for i in np.argwhere(~np.isfinite(given))[0])
    return f"{given[where]} at index {list(where)}" if where else str(given[()])


def _points_hint(given: Array) -> str:
    if given.ndim == 2 and given.shape[1] == 2:
        return " Add a column of zeros for z."
    if given.ndim == 2 and given.shape[0] == 3 and given.shape[1] != 3:
        return " The coordinates are the last axis: transpose it."
    return ""


def _net_hint(given: Array) -> str:
    if given.ndim == 2 and given.shape[1] == 3:
        side = round(len(given) ** 0.5)
        if side * side == len(given) and side > 1:
            return f" For a {side} x {side} net use .reshape({side}, {side}, 3), and look which index runs along u."
        return " Use .reshape(m, n, 3), and look which index runs along u."
    if given.ndim == 3 and given.shape[0] == 3 and given.shape[2] != 3:
        return " The coordinates are the last axis: np.moveaxis(net, 0, -1)."
    return ""


def _locked(given: Array) -> Array:
    given.flags.writeable = False
    return given
