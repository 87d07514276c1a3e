"""Two maps as sets of points: the same, one a part of the other, covered several times, collapsed.

Sets are compared by directed distances both ways at samples, at the edges and just inside them (a sliver that 3.1 for π leaves
out touches the seam, so edges alone do not see it). How often a set is covered shows in the measure: length, area or volume,
by the midpoint rule over the derivative, which sees 57 turns where a triangulation would see noise.

Known limits: decided at samples only, so a bump narrower than about a twelfth of the domain may be missed; a surface that
crosses itself is one set, so an exchange of its sheets is not seen.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from autograder.comparison.answers import Array
from autograder.comparison.nearest import Cloud, Evaluator, cloud, nearest, tensor
from autograder.comparison.samples import low_discrepancy
from autograder.result import Tier

SAME = 1e-6  # distance relative to the size
RATIO = 0.01  # area ratios this near to 1 count as 1
# Even, so that a fold in the middle lies between cells; with other powers of 2, so that no middle lies on a diagonal.
MIDPOINTS = {1: (256,), 2: (32, 34), 3: (12, 10, 16)}
ALONG = {1: 0, 2: 32, 3: 12}  # places along each edge
FINE = {1: 1024, 2: 128, 3: 24}  # cells each way where the ratio of measures must be known better
DOUBTFUL = 0.5  # a ratio this near to 1 is looked at more closely
STEP = 1e-5
JUST_INSIDE = 1e-4
NOTHING = 64 * float(np.finfo(float).eps) / STEP  # a difference quotient of less, relative to the points, is rounding
PARALLEL = 1e-6  # sine of the angle at which two derivatives are one direction


@dataclass(frozen=True, eq=False)
class Measured:
    """A map with its measure and with starting points for searches.

    ``measure`` is its length, area or volume counted as often as it is covered; ``collapsed`` the share of the domain where it
    is 0; ``elements`` the measure of each midpoint cell.
    """

    at: Evaluator
    n: int
    cloud: Cloud
    points: Array  # at the midpoints
    elements: Array
    squeezed: NDArray[np.bool_]  # the cells that are squeezed to nothing

    @property
    def measure(self) -> float:
        """Length, area or volume."""
        return float(self.elements.mean())

    @property
    def collapsed(self) -> float:
        """Share of the domain that is squeezed to nothing."""
        return float(self.squeezed.mean())

    @cached_property
    def finely(self) -> float:
        """The measure by chords of many cells: a speed that is uneven, or infinite at an edge, falsifies it least."""
        line = np.linspace(0.0, 1.0, FINE[self.n] + 1)
        values = self.at(tensor([line] * self.n)).reshape(*[len(line)] * self.n, -1)
        sides = []
        for axis in range(self.n):
            side = np.diff(values, axis=axis)
            for other in set(range(self.n)) - {axis}:
                side = np.moveaxis(side, other, 0)
                side = np.moveaxis((side[1:] + side[:-1]) / 2, 0, other)
            sides.append(side.reshape(-1, values.shape[-1]))
        gram = np.einsum("ikc,jkc->kij", sides, sides)
        return float(np.sqrt(np.maximum(np.linalg.det(gram), 0.0)).sum())

    @cached_property
    def probes(self) -> Array:
        """Points of the map that must lie on the other: scattered, on all edges, and just inside them."""
        return self.at(probe_parameters(self.n))


def measured(at: Evaluator, n: int) -> Measured:
    """Measure a map with one call of it."""
    parameters = tensor([(np.arange(count) + 0.5) / count for count in MIDPOINTS[n]])
    edges = edge_parameters(n, ALONG[n])
    shifts = [sign * STEP * np.eye(n)[i] for i in range(n) for sign in (1.0, -1.0)]
    values = at(np.concatenate([parameters, *(parameters + s for s in shifts), edges]))
    count = len(parameters)
    here = values[:count]
    moved = values[count : count * (1 + 2 * n)].reshape(n, 2, count, -1)
    derivatives = (moved[:, 0] - moved[:, 1]) / (2 * STEP)  # (n, K, 3)
    gram = np.einsum("ikc,jkc->kij", derivatives, derivatives)
    elements = np.sqrt(np.maximum(np.linalg.det(gram), 0.0))
    squeezed = _squeezed(derivatives, elements, float(np.abs(values).max(initial=0.0)))
    # Searches start where the map is not squeezed: from inside a fold no derivative shows the way out.
    live = ~squeezed & np.isfinite(elements)
    rim = values[count * (1 + 2 * n) :]
    kept = _distinct(rim, 2 * n)
    seeds, places = np.concatenate([parameters[live], edges[kept]]), np.concatenate([here[live], rim[kept]])
    start = cloud(seeds, places, 1 / MIDPOINTS[n][0])
    return Measured(at, n, start, here, elements, squeezed)


def _squeezed(derivatives: Array, elements: Array, largest: float) -> NDArray[np.bool_]:
    """Where a parameter moves nothing, or two move the point along one line. A map that is only slow there is not squeezed."""
    lengths = np.linalg.norm(derivatives, axis=-1)
    still = (lengths <= NOTHING * largest).any(axis=0)
    return np.asarray(still | (elements <= PARALLEL * lengths.prod(axis=0)))


def _distinct(rim: Array, sides: int) -> NDArray[np.intp]:
    """Indices of the points on the sides without those that coincide with another of the same side: a pole counts once.

    A seam is kept twice, since its two sides are different places to start from.
    """
    grain = 1e-9 * (float(np.abs(rim[np.isfinite(rim)]).max(initial=0.0)) or 1.0)
    chosen = []
    for side in np.split(np.arange(len(rim)), sides):
        _, first = np.unique(np.round(rim[side] / grain), axis=0, return_index=True)
        chosen.append(side[np.sort(first)])
    return np.concatenate(chosen)


def edge_parameters(n: int, count: int) -> Array:
    """Points along all sides, corners included."""
    if n == 1:
        return np.array([[0.0], [1.0]])
    line = np.linspace(0.0, 1.0, count)
    sides = tensor([line] * (n - 1))
    return np.concatenate([np.insert(sides, axis, end, axis=1) for axis in range(n) for end in (0.0, 1.0)])


def probe_parameters(n: int) -> Array:
    """Where a map is tried against another: 40 scattered points, the sides, and rings just inside them."""
    scattered = low_discrepancy(n, 40)
    sides = edge_parameters(n, 9 if n == 2 else 4)
    inside = np.clip(sides, JUST_INSIDE, 1.0 - JUST_INSIDE)
    return np.concatenate([scattered, sides, inside])


@dataclass(frozen=True)
class SetFinding:
    """How two sets lie to each other: the tier, the ratio of measures, the share of the domain that is collapsed."""

    tier: Tier
    ratio: float
    collapsed: float

    @property
    def times(self) -> float:
        """How often the right set is covered, to a whole number where it is near one."""
        whole = round(self.ratio)
        return float(whole) if whole and math.isclose(self.ratio, whole, rel_tol=0.02) else self.ratio


def on(points: Array, other: Evaluator, start: Cloud, size: float, same: float = SAME) -> bool:
    """Whether all points lie on the other map. A few are tried first: most sets that differ, differ there."""
    few = points[:: max(1, len(points) // 9)]
    enough = same * size
    return all((nearest(other, start, some, enough / 10).distances <= enough).all() for some in (few, points))


def compare_sets(yours: Measured, right: Measured, size: float, same: float = SAME) -> SetFinding | None:
    """Same set, covered n times, part or more of it; None where neither lies on the other, up to ``same`` times the size."""
    inside = on(yours.probes, right.at, right.cloud, size, same)
    covers = on(right.probes, yours.at, yours.cloud, size, same)
    ratio = yours.measure / right.measure if right.measure else 1.0
    if inside and covers and RATIO < abs(ratio - 1) < DOUBTFUL:
        ratio = yours.finely / right.finely
    collapsed = yours.collapsed
    if inside and covers:
        tier: Tier = "same set" if abs(ratio - 1) <= RATIO and collapsed <= right.collapsed + RATIO else "covered"
    elif inside:
        tier = "part"
    elif covers:
        tier = "more"
    else:
        return None
    return SetFinding(tier, ratio, collapsed)
