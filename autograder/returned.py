"""What a learner's function returned, in plain values: the same in ``check`` and behind the sandbox's wall, by the same code.

``np.asarray`` decides what is an array of numbers, so lists, ranges, fractions and arrays of objects that are numbers are taken
wherever a function is called. What is none of this becomes a :class:`Foreign`, which tells what it was and can cross to the
judge. This module imports numpy only: the sandbox loads it too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from autograder.curvedata import CurveData, SurfaceData

DEPTH = 4  # of lists and tuples in each other
ITEMS = 1000  # of a list or tuple that is not all numbers
TEXT = 10_000  # characters
DIMENSIONS = 32
MOST_VALUES = 2_000_000
KINDS = ("object", "function", "masked", "large")


@dataclass(frozen=True)
class Foreign:
    """What cannot be taken as it is, by its kind: an object or a function of some type, a masked or a very large array.

    ``text`` names its type; of a large array it is the number of values.
    """

    kind: str
    text: str

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise ValueError(f"kinds are {', '.join(KINDS)}; got {self.kind!r}")
        shown = "".join(letter for letter in self.text[:100] if letter.isprintable())
        object.__setattr__(self, "text", shown)


def plainly(value: Any, depth: int = DEPTH) -> Any:
    """None, bool, int, float, str, numeric array, curve, surface, :class:`Foreign`, or a list or tuple of these.

    Never raises, whatever comes. Doing it twice is as good as once.
    """
    if type(value) is np.ndarray and value.dtype == np.float64:
        return _bounded(value)
    try:
        return _plain(value, depth)
    except Exception:  # an object's own methods may raise anything
        return Foreign("object", type(value).__name__)


def _plain(value: Any, depth: int) -> Any:
    if value is None or isinstance(value, bool | CurveData | SurfaceData | Foreign):
        return value
    if isinstance(value, str):
        return str.__str__(value)[:TEXT]
    if isinstance(value, int | float):
        return _number(value)
    if callable(value):
        return Foreign("function", type(value).__name__)
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        return Foreign("masked", type(value).__name__)
    if not isinstance(value, list | tuple):
        return _array(value, depth)
    if depth < 1:
        return Foreign("object", type(value).__name__)
    if isinstance(value, tuple) and len(value) <= ITEMS:
        return tuple([plainly(item, depth - 1) for item in value])
    try:
        found = _numbers(np.asarray(value))
    except Exception:  # rows of unequal lengths; an object's own __array__ may raise anything
        found = None
    return _bounded(found) if found is not None else [plainly(item, depth - 1) for item in value[:ITEMS]]


def _number(value: float) -> Any:
    """A number of Python's own types; a whole one of more than 64 bits as a float."""
    if not isinstance(value, int):
        return float.__float__(value)
    whole = int.__int__(value)
    return whole if -(2**63) <= whole < 2**63 else float(whole)


def _array(value: Any, depth: int) -> Any:
    """What NumPy makes of an array, a number of its own types, or any object."""
    array = np.asarray(value)
    found = _numbers(array)
    if found is not None and found.ndim == 0 and not isinstance(value, np.ndarray):
        number = found[()]
        return found if found.dtype.kind == "c" else _number(float(number)) if found.dtype.kind == "f" else number.item()
    if found is not None:
        return _bounded(found)
    if array.dtype.kind in "SU":
        return [str(item)[:TEXT] for item in array.flat[:ITEMS]]
    if array.dtype.kind == "O" and array.ndim and isinstance(value, np.ndarray):
        return plainly(array.tolist(), depth)
    return Foreign("object", type(value).__name__)


def _numbers(array: NDArray[Any]) -> NDArray[Any] | None:
    """The numbers in an array, of objects too if each of them is one; None if they are no numbers."""
    if array.dtype.kind in "biufc":
        return array
    if array.dtype.kind != "O" or not array.size or any(item is None for item in array.flat):  # NumPy would make None NaN
        return None
    try:
        return np.array(array.tolist(), dtype=float)
    except Exception:  # no numbers; an object's own __float__ may raise anything
        return None


def _bounded(array: NDArray[Any]) -> Any:
    count = math.prod(max(1, length) for length in array.shape)  # an empty one may announce more than can be converted
    if count > MOST_VALUES:
        return Foreign("large", str(count))
    if array.ndim > DIMENSIONS:
        return Foreign("object", type(array).__name__)
    return array.astype(float) if array.dtype.kind == "f" and array.dtype.itemsize > 8 else np.asarray(array)
