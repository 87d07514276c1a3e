"""The samples behind the comparison picture: both maps on one grid, of public data only.

The learner's function is asked once more, for the data set that shows the deviation best. No mark depends on it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from autograder.comparison.answers import Array, Numbers, ask
from autograder.comparison.samples import read_only
from autograder.comparison.target import Target
from autograder.diagnosis.ladder import Finding
from autograder.diagnosis.wording import worst_index
from autograder.result import Figure

LINES = {1: 129, 2: 33}
ONE_BY_ONE = 13  # lines where a function takes single numbers only


def figure_of(finding: Finding, call: Callable[..., Any]) -> Figure | None:
    """Both maps of this finding on a grid; None for what has no picture. A solid shows one layer of its last parameter."""
    target = finding.target
    if target.hidden or target.raises or not target.is_map or target.exercise.kind == "field":
        return None
    if target.values.ndim != 2 or target.values.shape[1] != 3:
        return None
    f = finding.sampled
    worst = tuple(float(x) for x in f.points[worst_index(f)]) if f is not None and not finding.right else None
    shown = min(len(target.names), 2)
    single_only = {"vector", "mesh"} <= {t.form for t in finding.gated.troubles}
    axis = np.linspace(0.0, 1.0, ONE_BY_ONE if single_only else LINES[shown])
    grid = np.stack(np.meshgrid(*[axis] * shown, indexing="ij"), axis=-1)
    points = grid.reshape(-1, shown)
    if len(target.names) == 3:
        layer = worst[2] if worst is not None else 1.0
        points = np.column_stack([points, np.full(len(points), layer)])
    expected = target.at(points)
    yours = _yours(finding, call, points, single_only=single_only)
    tail = (*grid.shape[:-1], 3)
    return Figure(
        kind="curve" if shown == 1 else "surface",
        parameters=(tuple(float(x) for x in axis),) * shown,
        expected=_nested(expected.reshape(tail), target.size),
        yours=_nested(yours.reshape(tail), target.size) if yours is not None else None,
        worst=worst[:shown] if worst is not None else None,
        size=float(f"{target.size:.6g}"),
    )


def _yours(finding: Finding, call: Callable[..., Any], points: Array, *, single_only: bool) -> Array | None:
    target, gated = finding.target, finding.gated
    if gated.surface is not None:
        return gated.surface(points)
    if gated.sampled is None:
        return None
    if single_only:
        values = [ask(call, (*map(float, p), *target.arguments), whole=True) for p in points]
        if all(isinstance(v, Numbers) and v.values.shape == (3,) for v in values):
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
    """Nested lists, rounded to a millionth of the size; None for what is not finite."""
    digits = max(0, 6 - int(np.floor(np.log10(size))))
    rounded = np.round(values, min(digits, 15)) + 0.0
    if np.isfinite(rounded).all():
        return rounded.tolist()
    told = rounded.astype(object)
    told[~np.isfinite(rounded)] = None
    return told.tolist()
