"""The samples behind the comparison picture: both maps on one grid, of public data only.

The learner's function is asked once more, for the data set that shows the deviation best. No mark depends on it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from autograder.comparison.answers import Array, Numbers, ask, ask_in_turn
from autograder.comparison.gates import LARGEST
from autograder.comparison.samples import read_only
from autograder.comparison.target import Target
from autograder.diagnosis.ladder import Finding
from autograder.diagnosis.wording import worst_index
from autograder.messages import place
from autograder.result import Figure

LINES = {1: 129, 2: 33}
ONE_BY_ONE = 13  # lines where a function takes single numbers only
KEPT = 8  # grids of one data set that are remembered: a solid has as many layers as places that are wrong
DIGITS = 6  # of a coordinate, after the first digit of the size: finer than a screen shows


@dataclass(frozen=True, eq=False)
class Pictured:
    """The reference on the grid of a picture: its parameters (N, n), its values (N, 3), and the figure of it alone."""

    points: Array
    values: Array
    alone: Figure

    @cached_property
    def twice(self) -> Figure:
        """The figure of an answer that is the reference: one and the same object for all who are right."""
        return replace(self.alone, yours=self.alone.expected)

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of the nested lists."""
        return (*(len(axis) for axis in self.alone.parameters), 3)


def figure_of(finding: Finding, call: Callable[..., Any]) -> Figure | None:
    """Both maps of this finding on a grid; None for what has no picture. A solid shows one layer of its last parameter."""
    target = finding.target
    if target.hidden or target.raises or not target.is_map or target.exercise.kind == "field":
        return None
    if target.values.ndim != 2 or target.values.shape[1] != 3:
        return None
    f = finding.sampled
    worst = tuple(float(x) for x in f.points[worst_index(f)]) if f is not None and not finding.right else None
    single_only = {"vector", "mesh"} <= {t.form for t in finding.gated.troubles}
    layer = worst[2] if worst is not None and len(worst) == 3 else 1.0
    right = _pictured(target, ONE_BY_ONE if single_only else LINES[min(len(target.names), 2)], layer)
    yours = _yours(finding, call, right.points, single_only=single_only)
    if yours is None:
        return replace(right.alone, worst=worst[:2] if worst is not None else None)
    if finding.right and (np.abs(yours - right.values) <= 10.0**-DIGITS * target.size).all():
        return right.twice
    drawn = _nested(yours.reshape(right.shape), target.size)
    return replace(right.alone, yours=drawn, worst=worst[:2] if worst is not None else None)


def _pictured(target: Target, count: int, layer: float) -> Pictured:
    """The reference on a grid of so many lines each way, kept with its target for the next learner."""
    if (count, layer) not in target.pictures:
        shown = min(len(target.names), 2)
        axis = np.linspace(0.0, 1.0, count)
        points = np.stack(np.meshgrid(*[axis] * shown, indexing="ij"), axis=-1).reshape(-1, shown)
        if len(target.names) == 3:
            points = np.column_stack([points, np.full(len(points), layer)])
        values = target.at(points)
        alone = Figure(
            kind="curve" if shown == 1 else "surface",
            parameters=(tuple(float(x) for x in axis),) * shown,
            expected=_nested(values.reshape((count,) * shown + (3,)), target.size),
            size=float(f"{target.size:.6g}"),
            names=target.names[:shown],
            layer=place(target.names[2:], [layer]) if len(target.names) == 3 else "",
        )
        if len(target.pictures) >= KEPT:
            target.pictures.clear()
        target.pictures[count, layer] = Pictured(points, values, alone)
    found: Pictured = target.pictures[count, layer]
    return found


def _yours(finding: Finding, call: Callable[..., Any], points: Array, *, single_only: bool) -> Array | None:
    target, gated = finding.target, finding.gated
    if gated.surface is not None:
        return gated.surface(points)
    if gated.sampled is None:
        return None
    if single_only:
        values = ask_in_turn(call, [(*map(float, p), *target.arguments) for p in points], whole=True)
        if len(values) == len(points) and all(isinstance(v, Numbers) and v.values.shape == (3,) for v in values):
            return np.stack([v.values for v in values if isinstance(v, Numbers)])
        return None
    if "vector" not in {t.form for t in gated.troubles}:
        columns = tuple(read_only(np.ascontiguousarray(c)) for c in points.T)
        return _shaped(ask(call, (*columns, *target.arguments), whole=True), (len(points), 3))
    return _by_mesh(target, call, points)


def _by_mesh(target: Target, call: Callable[..., Any], points: Array) -> Array | None:
    axes = [np.unique(column) for column in points.T]
    answer = ask(call, (*(read_only(a) for a in np.ix_(*axes)), *target.arguments), whole=True)
    values = _shaped(answer, (*(len(a) for a in axes), 3))
    return values.reshape(-1, 3) if values is not None else None


def _shaped(answer: Any, shape: tuple[int, ...]) -> Array | None:
    return answer.values if isinstance(answer, Numbers) and answer.values.shape == shape else None


def _nested(values: Array, size: float) -> Any:
    """Nested lists, rounded to a millionth of the size; None for what is not finite, or too far out to compare."""
    digits = DIGITS - int(np.floor(np.log10(size)))
    shown = np.where(np.abs(values) < LARGEST, values, np.nan)  # or rounding, which multiplies, would overflow
    rounded = (np.round(shown, digits) if abs(digits) <= 15 else shown) + 0.0
    if np.isfinite(rounded).all():
        return rounded.tolist()
    told = rounded.astype(object)
    told[~np.isfinite(rounded)] = None
    return told.tolist()
