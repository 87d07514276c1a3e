"""Calls of learners' functions: finding them, turning answers into plain values, telling how they failed."""

from __future__ import annotations

import linecache
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from autograder.curvedata import CurveData, SurfaceData
from autograder.sandbox.wire import DEPTH

if TYPE_CHECKING:
    from autograder.sandbox.guest.shell import Shell

MESSAGE = 2000  # characters kept of an error's message


class Missing(Exception):
    """There is no such function in the notebook."""


class Refused(Exception):
    """What the function returned cannot be taken as an answer."""


class TimeLimitExceeded(BaseException):
    """A cell or call has used up its time. Not an ``Exception``, so that ``except Exception`` does not swallow it."""


def find(namespace: dict[str, Any], name: str) -> Callable[..., Any]:
    """The function of that name in the notebook."""
    if name not in namespace:
        raise Missing(f"the notebook defines no function called {name}")
    function = namespace[name]
    if not callable(function):
        raise Missing(f"{name} is not a function in the notebook but of type {type(function).__name__}")
    return function  # type: ignore[no-any-return]


def plain(value: Any, depth: int = DEPTH) -> Any:
    """An answer as None, bool, int, float, str, numeric array, curve, surface, or tuple of these.

    Lists of numbers become arrays, other lists tuples.

    Raises
    ------
    Refused
        For anything else; the message says what came and what is wanted.
    """
    if value is None or isinstance(value, bool | CurveData | SurfaceData):
        return value
    if isinstance(value, int | float | str):
        for kind in (int, float, str):
            if isinstance(value, kind):
                return _within_int64(int(value)) if kind is int else kind(value)
    if isinstance(value, tuple | list):
        return _sequence(value, depth)
    if isinstance(value, np.generic) and value.dtype.kind in "biufUS":
        return plain(value.item() if value.dtype.kind in "biuU" else float(value), depth)
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise Refused("the function returned a masked array; return a plain array, every point of it defined")
    if hasattr(value, "__array__") or isinstance(value, complex):
        return _numeric(np.asarray(value))
    raise Refused(
        f"the function returned {_a(type(value).__name__)}; an answer is an array, a number, a text or a tuple of these"
    )


def _sequence(value: Any, depth: int) -> Any:
    if depth < 1:
        raise Refused("the function returned lists or tuples nested too deeply; return an array")
    if isinstance(value, list):
        try:
            array = np.asarray(value)
        except (ValueError, TypeError):  # rows of different lengths
            array = np.asarray(None)
        if array.dtype.kind in "biufc":
            return array
    return tuple([plain(item, depth - 1) for item in value])


def _numeric(array: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    if array.dtype.kind == "O":
        raise Refused(
            "the function returned an array of objects (dtype object); usually its rows differ in length. "
            "Return an array of numbers, for example by np.stack([x, y, z], axis=-1)"
        )
    if array.dtype.kind not in "biufc":
        raise Refused(f"the function returned an array of dtype {array.dtype}; return an array of numbers")
    if array.ndim > 8:
        raise Refused(f"the function returned an array of {array.ndim} dimensions; at most 8 can be taken")
    return array


def _within_int64(value: int) -> int:
    if not -(2**63) <= value < 2**63:
        raise Refused("the function returned an integer of more than 64 bits")
    return value


def _a(name: str) -> str:
    return f"an {name}" if name[:1].lower() in "aeiou" else f"a {name}"


@contextmanager
def failures(shell: Shell) -> Iterator[list[Any]]:
    """Catches whatever goes wrong inside and fills the list with (False, kind, message, exception, bases, line, source).

    Used as ``with failures(shell) as failure: ...``; ``tuple(failure)`` is the answer then.
    """
    failure: list[Any] = []
    try:
        yield failure
    except (Missing, Refused) as error:
        kind = "missing" if isinstance(error, Missing) else "refused"
        failure += [False, kind, str(error)[:MESSAGE], "", (), None, ""]
    except TimeLimitExceeded as error:
        failure += [False, "timeout", str(error), "", (), *_place(error, shell)]
    except MemoryError as error:
        failure += [False, "memory", "", "MemoryError", ("MemoryError",), *_place(error, shell)]
    except BaseException as error:
        failure += [False, "error", _message(error), type(error).__name__, _bases(error), *_place(error, shell)]


def _message(error: BaseException) -> str:
    try:
        return str(error)[:MESSAGE]
    except BaseException:  # a learner's own __str__
        return "(its message cannot be shown)"


def _bases(error: BaseException) -> tuple[str, ...]:
    return tuple(base.__name__[:100] for base in type(error).__mro__[:20])


def _place(error: BaseException, shell: Shell) -> tuple[int | None, str]:
    """Line and text of the innermost place in the learner's own cells."""
    place: tuple[int | None, str] = (None, "")
    for frame, line in traceback.walk_tb(error.__traceback__):
        name = frame.f_code.co_filename
        if shell.is_cell(name):
            place = line, linecache.getline(name, line).strip()[:500]
    return place
