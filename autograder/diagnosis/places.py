"""Where a map is right and where it is not: corners, edges, coordinates; and what one rule would explain all of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from autograder.comparison.answers import Array
from autograder.comparison.maps import Sampled, agree

AXES = "xyz"


@dataclass(frozen=True)
class Localised:
    """Where maps are right and where they are not, over several data sets at once.

    ``coordinates`` tells per coordinate whether it is right everywhere; ``corners`` and ``sides`` are those right on every
    data set, sides as (axis, end).
    """

    coordinates: tuple[bool, ...]
    corners: tuple[tuple[int, ...], ...]
    all_corners: int
    sides: tuple[tuple[int, int], ...]
    unused: tuple[int, ...]  # parameters that change nothing, though they should

    @property
    def inside_only(self) -> bool:
        """Whether all sides are right."""
        return len(self.sides) > 0 and len(self.sides) * 2 ** (self._dimension - 1) == self._dimension * self.all_corners

    @property
    def _dimension(self) -> int:
        return self.all_corners.bit_length() - 1


def localise(maps: Sequence[Sampled]) -> Localised:
    """What holds on all of these maps."""
    first = maps[0].target.samples
    n = first.dimension
    wrongs = [_wrong_at(f) for f in maps]
    columns = range(maps[0].values.shape[1]) if maps[0].values.ndim == 2 else ()
    coordinates = tuple(
        all(bool((np.abs(f.values[:, c] - f.expected[:, c]) <= f.target.allowed).all()) for f in maps) for c in columns
    )
    corner_places = [tuple(int(x) for x in p) for p in first.points[first.corners]]
    corners = tuple(
        p
        for i, p in enumerate(corner_places)
        if not any(w.get(int(f.target.samples.corners[i]), True) for f, w in zip(maps, wrongs, strict=True))
    )
    sides = tuple(
        key
        for key in first.edges
        if not any(any(w.get(int(i), True) for i in f.target.samples.edges[key]) for f, w in zip(maps, wrongs, strict=True))
    )
    unused = tuple(
        axis
        for axis in range(n)
        if all(_still(f.values, f, axis) for f in maps) and not all(_still(f.expected, f, axis) for f in maps)
    )
    return Localised(coordinates, corners, 2**n, sides, unused)


def _wrong_at(f: Sampled) -> dict[int, bool]:
    return dict(zip(f.indices.tolist(), (f.deviations > f.target.allowed).tolist(), strict=True))


def _still(values: Array, f: Sampled, axis: int) -> bool:
    """Whether the values on the grid do not change along an axis."""
    grid = f.target.samples.grid
    if len(f.indices) < grid.size:
        return False
    layers = np.moveaxis(values[grid], axis, 0)
    return bool((np.abs(layers - layers[:1]) <= f.target.allowed).all())


def steady(maps: Sequence[Sampled]) -> tuple[int, ...]:
    """Axes along which the difference to the right map does not change, on any of these maps, though the map itself does.

    What the function does with such a parameter is right: f(u, w) = g(u, w) + e(w).
    """
    axes = range(maps[0].target.samples.dimension)
    found = tuple(
        axis
        for axis in axes
        if all(_still(f.values - f.expected, f, axis) for f in maps) and not all(_still(f.expected, f, axis) for f in maps)
    )
    return found if len(found) < len(axes) else ()


@dataclass(frozen=True)
class CoordinateFact:
    """One thing to say of all points at once: a key of the catalogue and its facts."""

    key: str
    facts: dict[str, Any]


def coordinate_fact(maps: Sequence[Sampled]) -> CoordinateFact | None:
    """A wrong sign, factor, offset or exchange of coordinates that explains every one of these maps."""
    if any(f.values.ndim != 2 or f.values.shape[1] != 3 for f in maps):
        return None
    factors = {_ratio(f.values, f) for f in maps}
    if len(factors) == 1 and (factor := factors.pop()) is not None and factor != 1.0:
        return CoordinateFact("fact.factor", {"factor": factor})
    wrong = [c for c in range(3) if any(np.abs(f.values[:, c] - f.expected[:, c]).max() > f.target.allowed for f in maps)]
    if len(wrong) == 2:
        a, b = wrong
        if all(agree(f.values[:, [a, b]], f.expected[:, [b, a]], f.target.allowed) for f in maps):
            return CoordinateFact("fact.coordinates_exchanged", {"yours": AXES[a], "expected": AXES[b]})
    if len(wrong) != 1:
        return None
    c = wrong[0]
    ratios = {_ratio(f.values[:, c], f, f.expected[:, c]) for f in maps}
    if len(ratios) == 1 and (ratio := ratios.pop()) is not None:
        if ratio == -1.0:
            return CoordinateFact("fact.coordinate_sign", {"name": AXES[c]})
        return CoordinateFact("fact.coordinate_factor", {"name": AXES[c], "factor": ratio})
    offsets = [f.values[:, c] - f.expected[:, c] for f in maps]
    if all(np.ptp(o) <= f.target.allowed for o, f in zip(offsets, maps, strict=True)):
        return CoordinateFact("fact.coordinate_offset", {"name": AXES[c], "offset": float(offsets[0].mean())})
    return None


def _ratio(values: Array, f: Sampled, expected: Array | None = None) -> float | None:
    """The factor that makes the right values into these, rounded; None where there is none."""
    right = f.expected if expected is None else expected
    square = float((right * right).sum())
    if square == 0.0:
        return None
    factor = float((values * right).sum()) / square
    if abs(factor) < 1e-9 or not agree(values, factor * right, 10 * f.target.allowed * max(1.0, abs(factor))):
        return None
    return float(f"{factor:.8g}")
