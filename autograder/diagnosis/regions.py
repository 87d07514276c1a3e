"""Where in the parameter domain a map is right: everywhere but on an edge, in some spans, up to a value.

Every statement is one about all public data at once that are wrong, and is made of the samples alone: nothing is claimed of a
span in which there are too few of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from autograder.comparison.answers import Array
from autograder.comparison.maps import Sampled

ENOUGH = 3  # samples strictly inside a span that make it count as right
SHARE = 0.1  # of the range of a parameter: less of it right is nothing to tell


@dataclass(frozen=True)
class OnlySides:
    """Wrong on these sides alone, as (axis, end), and nowhere off them."""

    sides: tuple[tuple[int, int], ...]


@dataclass(frozen=True)
class Spans:
    """Along an axis, spans are right or wrong as a whole: all ``but`` this run is right, or this run ``only``.

    The run is counted from the ``first`` span or from the ``last`` one; or it is ``inner``, and begins after ``start`` spans
    of ``count``.
    """

    axis: int
    form: Literal["but", "only"]
    counted: Literal["first", "last", "inner"]
    run: int
    start: int = 0
    count: int = 0


@dataclass(frozen=True)
class Interval:
    """Along an axis, right up to ``low`` and from ``high`` on (0 and 1: wrong from or to the very edge), wrong between."""

    axis: int
    low: float
    high: float


Region = OnlySides | Spans | Interval


def region(maps: Sequence[Sampled]) -> Region | None:
    """The plainest statement of where these maps, none of them right, go wrong; None where there is none."""
    if any(len(f.indices) < len(f.target.samples.points) for f in maps):
        return None
    wrong = [f.deviations > f.target.allowed for f in maps]
    return _only_sides(maps, wrong) or _along(maps, wrong)


def _only_sides(maps: Sequence[Sampled], wrong: Sequence[NDArray[np.bool_]]) -> OnlySides | None:
    """The fewest sides on which every wrong sample lies."""
    places = np.concatenate([f.points[bad] for f, bad in zip(maps, wrong, strict=True)])
    if not len(places) or not np.isin(places, (0.0, 1.0)).any(axis=1).all():
        return None
    left, sides = places, []
    while len(left):
        counts = {(axis, end): int((left[:, axis] == end).sum()) for axis in range(places.shape[1]) for end in (0, 1)}
        axis, end = max(counts, key=lambda side: counts[side])
        sides.append((axis, end))
        left = left[left[:, axis] != end]
    return OnlySides(tuple(sorted(sides))) if len(sides) <= places.shape[1] else None


def _along(maps: Sequence[Sampled], wrong: Sequence[NDArray[np.bool_]]) -> Spans | Interval | None:
    """A part of the range of one parameter beyond which all is right, the axis with the largest right part first."""
    found: list[tuple[float, Spans | Interval]] = []
    for axis in range(maps[0].target.samples.dimension):
        if spans := _spans(maps, wrong, axis):
            found.append((2.0 if spans.form == "but" else 1.5, spans))  # before any interval
        elif interval := _interval(maps, wrong, axis):
            found.append((interval.low + 1 - interval.high, interval))
    return max(found, key=lambda entry: entry[0])[1] if found else None


def _spans(maps: Sequence[Sampled], wrong: Sequence[NDArray[np.bool_]], axis: int) -> Spans | None:
    """Wrong spans in one run, which can be told in the same words for every map, however many spans each has."""
    found = [_forms(f, bad, axis) for f, bad in zip(maps, wrong, strict=True)]
    return next((form for form in found[0] if all(form in forms for forms in found[1:])), None)


def _forms(f: Sampled, bad: NDArray[np.bool_], axis: int) -> list[Spans]:
    """What can be said of the spans of one map, the shorter first."""
    breaks = f.target.breaks[axis] if f.target.breaks is not None else np.empty(0)
    count = len(breaks) - 1
    if count < 2:
        return []
    at = f.points[:, axis]
    inside = ~np.isin(at, breaks)
    span = np.searchsorted(breaks, at, side="right") - 1
    states = [bad[inside & (span == i)] for i in range(count)]
    spans = [i for i, state in enumerate(states) if state.any()]
    if any(len(state) < ENOUGH for state in states) or not 0 < len(spans) < count:
        return []
    first, last = spans[0], spans[-1]
    at_breaks = at[bad & ~inside]
    if len(spans) != last - first + 1 or ((at_breaks < breaks[first]) | (at_breaks > breaks[last + 1])).any():
        return []
    if first == 0:
        forms = [Spans(axis, "but", "first", last + 1), Spans(axis, "only", "last", count - last - 1)]
    elif last == count - 1:
        forms = [Spans(axis, "but", "last", count - first), Spans(axis, "only", "first", first)]
    else:
        forms = [Spans(axis, "but", "inner", len(spans), first, count)]
    return sorted(forms, key=lambda form: form.run)


def _interval(maps: Sequence[Sampled], wrong: Sequence[NDArray[np.bool_]], axis: int) -> Interval | None:
    low, high = 1.0, 0.0
    for f, bad in zip(maps, wrong, strict=True):
        at: Array = f.points[:, axis]
        low, high = min(low, float(at[bad].min())), max(high, float(at[bad].max()))
    below = [float(f.points[f.points[:, axis] < low, axis].max(initial=0.0)) for f in maps]
    above = [float(f.points[f.points[:, axis] > high, axis].min(initial=1.0)) for f in maps]
    interval = Interval(axis, min(below), max(above))
    return interval if interval.low + 1 - interval.high >= SHARE else None
