"""Whether a function answers an exercise, found out without the judge: a dense comparison with the reference.

Fresh seeds, scattered points, corners, edges and simple fractions; as vectors, as an open mesh and as single numbers. Nothing
of ``autograder.comparison``, ``diagnosis`` or ``judge`` is used: only the exercise's own reference, data and tolerance.
"""

from __future__ import annotations

import itertools
import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from autograder.exercise import Drawn, Exercise

Array = NDArray[Any]
FRACTIONS = {1: 24, 2: 12, 3: 4}  # simple fractions 0, 1/n, ..., 1 along each axis
BORDER = 10.0  # between a tenth of and ten times the tolerance the oracle does not decide
SAME_SET = 1e-6  # where an exercise gives full marks for the same set of points


@dataclass(frozen=True)
class Opinion:
    """``equal``, ``differs`` or ``borderline``, with the largest deviation in units of the tolerance and where it was met."""

    word: str
    deviation: float
    place: str = ""


class Oracle:
    """The right answers to an exercise under several seeds, and what other answers are apart from them."""

    def __init__(self, exercise: Exercise, seeds: Sequence[int | str | bytes], scattered: int = 160) -> None:
        self.exercise = exercise
        self.axes = 2 if exercise.judged_as is not None else len(exercise.parameters)
        rng = np.random.default_rng(abs(hash_of(exercise.id)))
        self.cases = [
            Case(self, f"seed {seed!r}, {drawn.name}", drawn, rng, scattered) for seed in seeds for drawn in exercise.draw(seed)
        ]

    def opinion(self, function: Callable[..., Any]) -> Opinion:
        """Hold a function to all cases; the first clear difference ends it."""
        worst = Opinion("equal", 0.0)
        for case in self.cases:
            for form, deviation in case.deviations(function):
                if deviation > worst.deviation:
                    worst = Opinion(_word(deviation), deviation, f"{case.name}, {form}")
                if worst.word == "differs":
                    return worst
        return worst


def hash_of(text: str) -> int:
    """A number for a text, the same in every process."""
    return int.from_bytes(text.encode()[:8].ljust(8, b"-"), "big")


def _word(deviation: float) -> str:
    return "equal" if deviation <= 1 / BORDER else "borderline" if deviation < BORDER else "differs"


class Case:
    """One data set under one seed."""

    def __init__(self, oracle: Oracle, name: str, drawn: Drawn, rng: np.random.Generator, scattered: int) -> None:
        self.exercise, self.name = oracle.exercise, name
        self.arguments = list(drawn.arguments.values())
        self.forms = _forms(oracle.axes, rng, scattered) if oracle.axes else {"value": ()}
        self.raises = False
        try:
            self.expected = {form: self._ask(self.exercise.reference, parameters) for form, parameters in self.forms.items()}
        except ValueError:
            self.raises = True
            self.forms = dict(itertools.islice(self.forms.items(), 1))
            return
        self.tolerance = self._tolerance()

    def _tolerance(self) -> float:
        """What may differ, in the units of the answer: the exercise's tolerance times the size of the right answer."""
        exercise, values = self.exercise, next(iter(self.expected.values()))
        if isinstance(values, str) or np.asarray(values).dtype.kind in "biu":
            return 1.0
        finite = np.asarray(values, dtype=float)
        if self.exercise.judged_as is not None or self.exercise.parameters:
            size = float(np.linalg.norm(np.ptp(finite.reshape(-1, finite.shape[-1]), axis=0)))
            size = size or float(np.abs(finite).max())
            allowed = SAME_SET if exercise.accept.get("same set") == 1.0 else exercise.tolerance
            return allowed * size + 1e-14 * float(np.abs(finite).max())
        numbers = [np.abs(a).max() for a in map(np.asarray, self.arguments) if a.dtype.kind in "iuf" and a.size]
        floor = 0.0 if exercise.kind == "basis" else 1e-12 * float(max(numbers, default=0.0))
        return exercise.tolerance * float(np.abs(finite).max(initial=0.0)) + floor

    def deviations(self, function: Callable[..., Any]) -> Any:
        """Pairs of a form of input and how far the answers are apart, in units of the tolerance; infinite without an answer."""
        for form, parameters in self.forms.items():
            try:
                answer = self._ask(function, parameters)
            except ValueError:
                yield form, 0.0 if self.raises else math.inf
                continue
            except Exception:
                yield form, math.inf
                continue
            yield form, math.inf if self.raises else self._apart(answer, form)

    def _ask(self, function: Callable[..., Any], parameters: tuple[Array, ...]) -> Any:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            if self.exercise.judged_as is None:
                return _plain(function(*parameters, *self.arguments))
            return _plain(self.exercise.judged_as(function(*self.arguments))(*parameters))

    def _apart(self, answer: Any, form: str) -> float:
        expected = self.expected[form]
        if isinstance(answer, str) or isinstance(expected, str):
            return 0.0 if isinstance(answer, str) and isinstance(expected, str) and answer == expected else math.inf
        answer, expected = np.asarray(answer), np.asarray(expected)
        if answer.dtype.kind not in "biuf" or answer.shape != expected.shape:
            return math.inf
        if expected.dtype.kind in "biu":  # truth values and whole numbers are equal or they are not
            return 0.0 if np.array_equal(answer, expected) else math.inf
        answer = answer.astype(float)
        if not np.isfinite(answer).all():
            return math.inf
        if self.exercise.accept.get("same set") == 1.0:
            return EQUATIONS[self.exercise.id](answer, *self.arguments, form) / self.tolerance
        error = np.abs(answer - expected)
        if self.exercise.parameters:
            error = np.linalg.norm(error, axis=-1)
        return float(error.max(initial=0.0)) / self.tolerance


def off_the_quarter(points: Array, r: float, h: float, form: str) -> float:
    """How far points are from the quarter cylinder, by its equation x² + y² = r², and the first four from its corners."""
    points = points.reshape(-1, 3)
    x, y, z = points.T
    off = [np.abs(np.hypot(x, y) - r).max(), np.maximum(-x, 0).max(), np.maximum(-y, 0).max()]
    off += [np.maximum(-z * np.sign(h), 0).max(), np.maximum(np.abs(z) - abs(h), 0).max()]
    if form == "scattered places":  # the first four of these are the corners
        off.append(np.abs(points[:4] - [[r, 0, 0], [r, 0, h], [0, r, 0], [0, r, h]]).max())
    if form == "simple fractions":  # the four edges must be the set's own, or a part of it is left out
        x, y, z = np.moveaxis(points.reshape(FRACTIONS[2] + 1, FRACTIONS[2] + 1, 3), -1, 0)
        off += [np.abs(z[:, 0]).max(), np.abs(z[:, -1] - h).max(), np.abs(y[0]).max(), np.abs(x[-1]).max()]
    return float(max(off))


def off_the_turned(points: Array, profile: Array, h: Array, form: str) -> float:
    """How far points (ρ, z) are from the profile, a rational Bezier curve; the first four from its ends in the plane y = 0.

    A dense search along the curve, then a ternary search beside the nearest place. Points on one side of the axis only are
    infinitely far from a whole turn, as are those of a turn the other way.
    """
    points = points.reshape(-1, 3)
    rho = np.hypot(points[:, 0], points[:, 1])
    mine = np.stack([rho, points[:, 2]], axis=-1)

    def away(t: Array) -> Array:
        lifted = np.concatenate([np.asarray(profile) * np.asarray(h)[:, None], np.asarray(h)[:, None]], axis=1)
        rows = [np.broadcast_to(row, (*t.shape, 3)) for row in lifted]
        while len(rows) > 1:
            rows = [(1 - t[..., None]) * a + t[..., None] * b for a, b in itertools.pairwise(rows)]
        curve = rows[0][..., :2] / rows[0][..., 2:]
        return np.minimum(np.linalg.norm(mine - curve, axis=-1), np.linalg.norm(mine - curve * [-1, 1], axis=-1))

    line = np.linspace(0, 1, 801)
    distances = np.array([away(np.full(len(mine), t)) for t in line])
    best = np.full(len(mine), np.inf)
    for start in np.argsort(distances, axis=0)[:4]:  # the nearest node need not lie beside the nearest place
        low, high = np.clip(line[start] - 1 / 800, 0, 1), np.clip(line[start] + 1 / 800, 0, 1)
        for _ in range(45):
            a, b = low + (high - low) / 3, high - (high - low) / 3
            left = away(a) < away(b)
            low, high = np.where(left, low, a), np.where(left, b, high)
        best = np.minimum(best, away((low + high) / 2))
    off = [float(best.max())]
    if form == "scattered places":  # the first four of these are the corners
        ends = [(r, 0.0, z) for r, z in np.asarray(profile)[[0, 0, -1, -1]]]
        off.append(float(np.abs(points[:4] - ends).max()))
        reach = np.abs(np.asarray(points)[:, :2]).max()
        sides = [points[:, 0].max(), -points[:, 0].min(), points[:, 1].max(), -points[:, 1].min()]
        off.append(0.0 if min(sides) > 0.5 * reach else math.inf)
    if form == "simple fractions":
        along = points.reshape(FRACTIONS[2] + 1, FRACTIONS[2] + 1, 3)[FRACTIONS[2] // 2]
        off.append(0.0 if along[1, 1] > 0 else math.inf)
    return max(off)


# Where any parametrisation of the right set gets full marks, the set's own equation decides.
EQUATIONS: dict[str, Callable[..., float]] = {
    "nurbs_quarter_cylinder": off_the_quarter,
    "nurbs_revolve": off_the_turned,
}


def _plain(value: Any) -> Any:
    """An answer as an array or a string; a list or tuple of arrays of one shape is an array."""
    if value is None or isinstance(value, str):
        return value if value is not None else "nothing"
    array = np.asarray(value)
    if array.dtype.kind == "O":
        array = np.asarray(array.tolist(), dtype=float)
    return str(array) if array.dtype.kind in "SU" else array


def _forms(axes: int, rng: np.random.Generator, scattered: int) -> dict[str, tuple[Array, ...]]:
    """Parameters to ask at. Vectors: corners, then scattered points, then edges and simple fractions."""
    corners = np.array(list(itertools.product([0.0, 1.0], repeat=axes)))
    inside = rng.uniform(size=(scattered, axes))
    edges = rng.uniform(size=(8 * axes, axes))
    for number in range(len(edges)):
        edges[number, number % axes] = float(number // axes % 2)
    line = np.linspace(0.0, 1.0, FRACTIONS[axes] + 1)
    simple = np.array(list(itertools.product(line, repeat=axes)))
    vector = _frozen(np.concatenate([corners, inside, edges]).T)
    mesh = np.meshgrid(*[np.sort(rng.uniform(size=n)) for n in range(3, 3 + axes)], indexing="ij", sparse=True)
    place = tuple(float(x) for x in rng.uniform(size=axes))
    return {
        "scattered places": vector,
        "a mesh": _frozen(mesh),
        "single numbers": place,  # type: ignore[dict-item]
        "simple fractions": _frozen(simple.T),
    }


def _frozen(columns: Any) -> tuple[Array, ...]:
    arrays = tuple(np.ascontiguousarray(column) for column in columns)
    for array in arrays:
        array.flags.writeable = False
    return arrays
