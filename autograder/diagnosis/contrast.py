"""What the data sets that are answered rightly have in common, and those that are not have not.

Plain properties of the arguments are tried in turn: sizes that are equal, signs, zeros, ones, unit vectors, directions along an
axis. The first that parts right from wrong exactly is told. It is true of these data; that it is the reason is not claimed.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from autograder.comparison.answers import Array
from autograder.curvedata import CurveData
from autograder.diagnosis.ladder import Finding

SAME = 1e-9


@dataclass(frozen=True)
class Contrast:
    """A property with the arguments that it is of, and whether the right data have it: keys ``has.`` and ``lacks.``."""

    property: str
    names: tuple[str, ...]
    right_have_it: bool
    refusals: bool = False  # there are data without an answer too, of which nothing is said


def contrast(findings: Sequence[Finding]) -> Contrast | None:
    """The first property that all data answered rightly have and no other, or the other way round."""
    shown = [f for f in findings if not f.target.hidden and not f.target.raises]
    right = [f.target.drawn.arguments for f in shown if f.right]
    wrong = [f.target.drawn.arguments for f in shown if not f.right]
    refusals = len(shown) < len(findings)
    if not right or not wrong:
        return None
    for key, names, holds in _properties(right[0]):
        try:
            yes = [holds(*(one[name] for name in names)) for one in right]
            no = [holds(*(one[name] for name in names)) for one in wrong]
        except (TypeError, ValueError, IndexError):  # one of them is of another kind
            continue
        if all(yes) and not any(no):
            return Contrast(key, names, True, refusals)
        if all(no) and not any(yes):
            return Contrast(key, names, False, refusals)
    return None


def _properties(arguments: Any) -> Iterator[tuple[str, tuple[str, ...], Callable[..., bool]]]:
    kinds = {name: _kind(value) for name, value in arguments.items()}
    numbers = [name for name, kind in kinds.items() if kind == "number"]
    nets = [name for name, kind in kinds.items() if kind == "net"]
    vectors = [name for name, kind in kinds.items() if kind == "vector"]
    curves = [name for name, kind in kinds.items() if kind == "curve"]
    tables = [name for name, kind in kinds.items() if kind in ("net", "table")]
    for name in nets:
        yield "square", (name,), lambda net: np.shape(net)[0] == np.shape(net)[1]
    for pair in itertools.combinations(numbers, 2):
        yield "equal", pair, lambda a, b: bool(a == b)
    for name in numbers:
        yield "negative", (name,), lambda x: bool(x < 0)
        yield "zero", (name,), lambda x: bool(x == 0)
        yield "one", (name,), lambda x: bool(x == 1)
    for name in vectors:
        yield "unit", (name,), lambda v: abs(float(np.linalg.norm(v)) - 1) < SAME
        yield "axis", (name,), lambda v: int(np.count_nonzero(v)) == 1
        yield "origin", (name,), lambda v: not np.any(v)
    for name in tables:
        yield "alike", (name,), lambda table: float(np.ptp(np.asarray(table, dtype=float))) < SAME
    for name in curves:
        yield "closed", (name,), lambda c: _near(c(0.0), c(1.0), c)
        yield "flat", (name,), lambda c: bool(np.abs(_along(c)[:, 2]).max() < SAME)
        yield "from_origin", (name,), lambda c: _near(c(0.0), np.zeros(3), c)


def _kind(value: Any) -> str:
    if isinstance(value, CurveData):
        return "curve"
    if isinstance(value, int | float) and not isinstance(value, bool):
        return "number"
    if isinstance(value, np.ndarray) and value.dtype.kind in "fiu":
        return {1: "vector" if value.shape == (3,) else "row", 2: "table", 3: "net"}.get(value.ndim, "")
    return ""


def _along(curve: CurveData) -> Array:
    return curve(np.linspace(0.0, 1.0, 9))


def _near(a: Array, b: Array, curve: CurveData) -> bool:
    return bool(np.abs(a - b).max() <= SAME * max(1.0, float(np.abs(_along(curve)).max())))
