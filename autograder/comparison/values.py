"""The rungs for answers that are not maps: numbers, nets, bases, words, and tuples of these.

Numbers are compared relative to the largest of the expected ones, with room for the rounding that the size of the data brings;
a basis, whose values lie between 0 and 1 whatever the degree and the knots, without that room.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from autograder.comparison.answers import Answer, Array, Numbers, Raised, Several, Unreadable, Word
from autograder.comparison.maps import agree
from autograder.comparison.target import Target
from autograder.messages import listing, written

FLOOR = 1e-12  # rounding errors relative to the data
MOST_PATTERN = 20_000  # larger arrays are not searched for patterns
MOST_NAMED = 8  # points that are told one by one


@dataclass(frozen=True)
class Pattern:
    """What a wrong value has to do with the right one: a key of the message catalogue and the facts that fill it in."""

    key: str
    facts: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Difference:
    """Where two answers part: the element of a tuple, the index of the entry, both entries, relative deviation."""

    item: int | None
    index: tuple[int, ...]
    yours: float
    expected: float
    relative: float


def scale(target: Target, expected: Numbers) -> float:
    """What tolerances of this answer are relative to."""
    return _largest(expected) or target.data_scale


def allowed(target: Target, expected: Numbers) -> float:
    """The difference that still counts as equal."""
    if expected.was != "float":
        return target.exercise.tolerance
    floor = 0.0 if target.exercise.kind == "basis" else FLOOR * target.data_scale
    return target.exercise.tolerance * _largest(expected) + floor


def _largest(expected: Numbers) -> float:
    """The largest absolute value; a known mistake may hold infinities and NaN besides."""
    finite = expected.values[np.isfinite(expected.values)]
    return float(np.abs(finite).max(initial=0.0))


def same(target: Target, yours: Answer, expected: Answer, *, near: float = 0.0) -> bool:
    """Whether an answer equals the expected one. ``near``: a further allowance relative to the scale."""
    if isinstance(expected, Raised):
        return isinstance(yours, Raised) and yours.kind == "error" and yours.is_a(expected.exception or "ValueError")
    if isinstance(expected, Word):
        return isinstance(yours, Word) and yours.text == expected.text
    if isinstance(expected, Several):
        items = as_items(yours, len(expected.items))
        return items is not None and all(
            same(target, mine, right, near=near) for mine, right in zip(items, expected.items, strict=True)
        )
    if isinstance(expected, Numbers) and isinstance(yours, Numbers):
        return agree(yours.values, expected.values, allowed(target, expected) + near * scale(target, expected))
    return False


def as_items(yours: Answer, count: int) -> tuple[Answer, ...] | None:
    """A tuple's elements; an array whose first axis has that length (equal rows become one array) counts as a tuple."""
    if isinstance(yours, Several):
        return yours.items if len(yours.items) == count else None
    if isinstance(yours, Numbers) and yours.values.ndim and len(yours.values) == count:
        return tuple(Numbers(np.asarray(row), yours.was) for row in yours.values)
    return None


def pairs(yours: Answer, expected: Answer) -> Iterator[tuple[int | None, Answer, Answer]]:
    """The elements of tuples side by side, or the one pair of answers that are not tuples."""
    if isinstance(expected, Several):
        items = as_items(yours, len(expected.items))
        if items is not None:
            yield from ((i, mine, right) for i, (mine, right) in enumerate(zip(items, expected.items, strict=True)))
    else:
        yield None, yours, expected


def not_finite(yours: Answer) -> bool:
    """Whether an infinity or a NaN is in it."""
    if isinstance(yours, Several):
        return any(not_finite(item) for item in yours.items)
    return isinstance(yours, Numbers) and not np.isfinite(yours.values).all()


def first_unreadable(yours: Answer) -> Unreadable | None:
    """The part of an answer that could not be taken as numbers."""
    if isinstance(yours, Several):
        return next((bad for item in yours.items if (bad := first_unreadable(item)) is not None), None)
    return yours if isinstance(yours, Unreadable) else None


def worst(target: Target, yours: Answer, expected: Answer) -> Difference | None:
    """The entry that is furthest off, relative to its own array's scale; None where shapes or kinds differ."""
    found: list[Difference] = []
    for item, mine, right in pairs(yours, expected):
        if not isinstance(mine, Numbers) or not isinstance(right, Numbers) or mine.values.shape != right.values.shape:
            return None
        if not right.values.size:
            continue
        errors = np.where(np.isfinite(mine.values), np.abs(mine.values - right.values), np.inf)
        index = np.unravel_index(int(errors.argmax()), errors.shape)
        place = tuple(int(i) for i in index)
        relative = float(errors[index]) / scale(target, right)
        found.append(Difference(item, place, float(mine.values[index]), float(right.values[index]), relative))
    return max(found, key=lambda d: d.relative, default=None)


def pattern(target: Target, mine: Numbers, right: Numbers) -> Pattern | None:
    """The plainest relation between a wrong array and the right one; None where there is none to tell."""
    a, b = mine.values, right.values
    if max(a.size, b.size) > MOST_PATTERN or not np.isfinite(a).all():
        return None
    enough = allowed(target, right) + 1e-9 * scale(target, right)
    if a.shape != b.shape:
        return _other_shape(a, b, enough)
    if not b.any():
        return None
    return _factor(a, b, enough) or _rearranged(a, b, enough) or _partly_right(a, b, enough)


def _other_shape(a: Array, b: Array, enough: float) -> Pattern:
    facts = {"yours": str(a.shape), "expected": str(b.shape)}
    if a.ndim == b.ndim and a.ndim >= 2:
        for axes in itertools.permutations(range(a.ndim)):
            turned = a.transpose(axes)
            if turned.shape == b.shape and agree(turned, b, enough):
                return Pattern("value.shape.transposed", facts)
    if a.size == b.size:
        if agree(a.ravel(), b.ravel(), enough):
            return Pattern("value.shape.reshape", facts)
        return Pattern("value.shape.same_size", facts)
    if a.ndim == b.ndim:
        off = [(axis, int(x - y)) for axis, (x, y) in enumerate(zip(a.shape, b.shape, strict=True)) if x != y]
        if len(off) == 1 and abs(off[0][1]) == 1:
            key = "value.shape.one_more" if off[0][1] > 0 else "value.shape.one_less"
            return Pattern(key, {**facts, "axis": off[0][0]})
    return Pattern("value.shape.other", facts)


def _common_factor(a: Array, b: Array, enough: float) -> float | None:
    """The one factor by which all of several entries are off."""
    square = float((b * b).sum())
    if a.size < 2 or square == 0.0:
        return None
    factor = float((a * b).sum() / square)
    return factor if abs(factor) > 1e-12 and agree(a, factor * b, enough * max(1.0, abs(factor))) else None


def _factor(a: Array, b: Array, enough: float) -> Pattern | None:
    if agree(a, -b, enough):
        return Pattern("value.sign")
    factor = _common_factor(a, b, enough) if b.size > 1 else _plain_factor(float(a.sum()), float(b.sum()))
    if factor is not None:
        return Pattern("value.factor", {"factor": factor})
    if b.size > 1:
        offset = float((a - b).mean())
        if agree(a, b + offset, enough):
            return Pattern("value.offset", {"offset": offset})
        if _of_points(b):
            shift = (a - b).reshape(-1, 3).mean(axis=0)
            if agree(a, b + shift, enough):
                return Pattern("value.shifted", {"shift": written(shift)})
        with np.errstate(divide="ignore", invalid="ignore"):
            signs_only = agree(np.abs(a), np.abs(b), enough)
        if signs_only:
            return Pattern("value.some_signs", {"count": int((np.abs(a - b) > enough).sum()), "total": int(b.size)})
    return None


def _plain_factor(a: float, b: float) -> float | None:
    """The factor between two single numbers, where it is one worth telling: 2, 1/2, 3, 1/3, 10 ..., π/180 and its inverse."""
    told = (2, 3, 4, 6, 9, 10, 100, 1000, np.pi, 2 * np.pi, 180 / np.pi)
    return next((f for t in told for f in (t, 1 / t) if abs(a - f * b) <= 1e-9 * abs(a)), None)


def _rearranged(a: Array, b: Array, enough: float) -> Pattern | None:
    for axes in itertools.permutations(range(b.ndim)):
        turned = a.transpose(axes)
        if axes != tuple(range(b.ndim)) and turned.shape == b.shape and agree(turned, b, enough):
            return Pattern("value.transposed")
    for axis in range(b.ndim):
        if b.shape[axis] < 2:
            continue
        if agree(np.flip(a, axis), b, enough):
            return Pattern("value.reversed", {"axis": axis})
        for shift in (1, -1):
            if agree(np.roll(a, shift, axis), b, enough):
                return Pattern("value.rolled", {"axis": axis})
        if b.shape[axis] <= 64 and (order := _matched(np.moveaxis(a, axis, 0), np.moveaxis(b, axis, 0), enough)):
            return Pattern("value.permuted", {"axis": axis, "order": ", ".join(map(str, order))})
    return None


def _matched(a: Array, b: Array, enough: float) -> list[int] | None:
    """The order in which the layers of a are those of b, if each of b is found in a exactly once."""
    order = []
    for layer in b:
        hits = [i for i, other in enumerate(a) if i not in order and agree(other, layer, enough)]
        if not hits:
            return None
        order.append(hits[0])
    return order


def _partly_right(a: Array, b: Array, enough: float) -> Pattern | None:
    right = np.abs(a - b) <= enough
    count, total = int(right.sum()), int(right.size)
    if total < 2 or not 0 < count < total:
        return None
    for axis in reversed(range(b.ndim)):
        others = tuple(i for i in range(b.ndim) if i != axis)
        layers: NDArray[np.bool_] = np.asarray(right.all(axis=others))
        if layers.any():
            wrong = np.flatnonzero(~layers)
            places = ", ".join(str(i) for i in wrong[:8]) + (", ..." if len(wrong) > 8 else "")
            facts = {"axis": axis, "wrong": places, "count": len(wrong), "of": len(layers)}
            factor = _common_factor(np.take(a, wrong, axis), np.take(b, wrong, axis), enough)
            if factor is not None:
                key = "value.items_factor" if b.ndim == 1 else "value.layers_factor"
                return Pattern(key, {**facts, "factor": factor})
            single = _points_right(right)
            if single is not None and axis < b.ndim - 1 and np.take(right.all(axis=-1), wrong, axis).any():
                return single  # which says more than layers that are wrong in part
            return Pattern("value.items" if b.ndim == 1 else "value.layers", facts)
    return _points_right(right) or Pattern("value.entries", {"count": total - count, "total": total})


def _of_points(b: NDArray[Any]) -> bool:
    """Whether it is a net of several points or vectors."""
    return b.ndim > 1 and b.shape[-1] == 3 and b.size > 3


def _points_right(right: NDArray[np.bool_]) -> Pattern | None:
    """Which points of a net are right and which are not, by naming the fewer of them; None where they are too many to name."""
    if not _of_points(right):
        return None
    points = right.all(axis=-1)
    mostly = points.sum() * 2 >= points.size
    named = np.argwhere(points != mostly)
    if not points.any() or len(named) > MOST_NAMED:
        return None
    places = listing("[" + ", ".join(map(str, place)) + "]" for place in named.tolist())
    return Pattern("value.points_wrong" if mostly else "value.points_right", {"places": places, "of": int(points.size)})


def sense(differences: Sequence[float]) -> Pattern | None:
    """What the differences of single numbers have in common, from one data set to the other."""
    if len(differences) < 2 or not np.isfinite(differences).all():
        return None
    first = differences[0]
    if all(abs(d - first) <= 1e-9 * abs(first) for d in differences):
        return Pattern("value.always_off", {"offset": first})
    if all(d > 0 for d in differences):
        return Pattern("value.always_larger")
    return Pattern("value.always_smaller") if all(d < 0 for d in differences) else None
