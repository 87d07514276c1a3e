"""The nearest points of a parametric map, for many points at once; the map is a black box on arrays of parameters.

Seeds come from a grid in a k-d tree, several to a point and well apart, since a grid's nearest point may lie on another sheet
or in a region that is squeezed to nothing. Damped Gauss-Newton with one-sided differences does most of the work; where it
stops short (kinks, poles, zero derivatives at an edge) a pattern search over a shrinking window, which needs no derivatives,
takes over. Every round evaluates the map once, for all points together.

Distances near 0 are found to rounding; far ones, which decide nothing, to about 1e-4 of themselves, since Gauss-Newton crawls
where a far target meets a bent map.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from autograder.comparison.answers import Array

if TYPE_CHECKING:
    from scipy.spatial import KDTree

Evaluator: TypeAlias = Callable[[Array], Array]  # parameters (N, n) -> points (N, 3)
SEEDS = 5
NEAR = 64  # grid points among which the seeds are chosen
APART = 2.5  # seeds of one point are at least so many cells apart
NEWTON_ROUNDS = 14
PATTERN_ROUNDS = 34
SHRINK = 0.62
LINE, ZOOMS = 17, 4  # places tried on a line, and how often the best is zoomed in on
STEP, SHORTEST_STEP = 1e-7, 1e-8
HARD = (2, 10, 20, 40)  # points that one pattern search after another takes up; the worst go first


@dataclass(frozen=True, eq=False)
class Cloud:
    """Points of a map at a grid of parameters, to start searches from."""

    parameters: Array
    points: Array
    tree: KDTree
    cell: float  # of the grid, in parameters


def cloud(parameters: Array, points: Array, cell: float) -> Cloud:
    """Points that were evaluated already."""
    from scipy.spatial import KDTree  # loaded when it is used: a course without exercises never does

    finite = np.isfinite(points).all(axis=1)
    return Cloud(parameters[finite], points[finite], KDTree(points[finite]), cell)


def tensor(axes: list[Array]) -> Array:
    """All combinations of the axes' values, (N, n), last axis fastest."""
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes))


@dataclass(frozen=True, eq=False)
class Nearest:
    """For each point the parameters of the nearest place found, that place, and its distance."""

    parameters: Array
    points: Array
    distances: Array


def nearest(at: Evaluator, start: Cloud, targets: Array, enough: float) -> Nearest:
    """The nearest places of the map to the targets (K, 3). ``enough``: a distance below which a search may stop."""
    seeds = _seeds(start, targets)
    found = _newton(at, seeds, np.repeat(targets[:, None], seeds.shape[1], axis=1), enough)
    best = _best(found)
    parameters, points, distances = best.parameters, best.points, best.distances
    left = np.flatnonzero(distances > enough)
    left = left[np.argsort(-distances[left], kind="stable")]
    for batch in HARD:
        hard, left = left[:batch], left[batch:]
        if len(hard) == 0:
            break
        ends = _along(at, seeds[hard], found.parameters[hard], targets[hard])
        turned_back = _best(_newton(at, ends, np.repeat(targets[hard][:, None], ends.shape[1], axis=1), enough))
        _take(turned_back, hard, parameters, points, distances)
        hard = hard[distances[hard] > enough]
        if len(hard) == 0:
            continue
        tries = np.concatenate([seeds[hard], parameters[hard][:, None]], axis=1)
        tried = _pattern(at, tries, targets[hard], start.cell)
        _take(
            _best(_newton(at, tried.parameters[:, None], targets[hard][:, None], enough)), hard, parameters, points, distances
        )
        if (distances[hard] > enough).any():
            break  # one point that stays off decides
    return Nearest(parameters, points, distances)


def improved(at: Evaluator, known: Nearest, targets: Array, rounds: int) -> Nearest:
    """The nearest places to targets that have moved a little, from those known before."""
    found = _newton(at, known.parameters[:, None], targets[:, None], 0.0, rounds=rounds)
    return _best(found)


def slopes(at: Evaluator, parameters: Array, values: Array) -> Array:
    """Derivatives (K, n, 3) by one-sided differences that stay inside [0, 1]; shorter ones near the ends, where a map may be
    as steep as a root.
    """
    n = parameters.shape[1]
    step = np.clip(1e-3 * np.minimum(parameters, 1 - parameters), SHORTEST_STEP, STEP)
    signs = np.where(parameters > 0.5, -1.0, 1.0) * step
    shifted = np.repeat(parameters[:, None], n, axis=1)
    shifted[:, np.arange(n), np.arange(n)] += signs
    moved = at(shifted.reshape(-1, n)).reshape(len(parameters), n, -1)
    return (moved - values[:, None]) / signs[..., None]


def _seeds(start: Cloud, targets: Array) -> Array:
    """Per target SEEDS parameters of near points: (K, SEEDS, n).

    The nearest; the nearest that is APART from it; then those of the near ones that lie farthest from all chosen: behind
    the tip of a cone the nearest grid points all lie on the wrong side of it.
    """
    count = min(NEAR, len(start.points))
    _, indices = start.tree.query(targets, k=count)
    near = start.parameters[np.reshape(indices, (len(targets), count))]
    rows = np.arange(len(targets))
    chosen = [near[:, 0]]
    gap = np.full((len(targets), count), np.inf)
    for k in range(SEEDS - 1):
        gap = np.minimum(gap, np.abs(near - chosen[-1][:, None]).max(axis=2))
        pick = (gap > APART * start.cell).argmax(axis=1) if k == 0 else gap.argmax(axis=1)
        chosen.append(near[rows, pick])
    return np.stack(chosen, axis=1)


def _best(found: Nearest) -> Nearest:
    """The best of several searches per target, (K, S, n) -> (K, n)."""
    pick = found.distances.argmin(axis=1)
    rows = np.arange(len(pick))
    return Nearest(found.parameters[rows, pick], found.points[rows, pick], found.distances[rows, pick])


def _newton(at: Evaluator, seeds: Array, targets: Array, enough: float, rounds: int = NEWTON_ROUNDS) -> Nearest:
    """Levenberg-Marquardt on [0, 1]^n for seeds (K, S, n); searches that have arrived, and their neighbours, rest."""
    shape = seeds.shape[:2]
    n = seeds.shape[-1]
    p = seeds.reshape(-1, n).copy()
    goal = targets.reshape(len(p), -1)
    values = at(p)
    distance = _length(values - goal)
    damping = np.full(len(p), 1e-3)
    for _ in range(rounds):
        done = (distance.reshape(shape) <= enough).any(axis=1)
        active = np.flatnonzero(np.repeat(~done, shape[1]) & (damping < 1e8))
        if len(active) == 0:
            break
        jacobian = slopes(at, p[active], values[active])
        step = _bounded_step(jacobian, goal[active] - values[active], p[active], damping[active])
        trial = np.clip(p[active] + step, 0.0, 1.0)
        trial_values = at(trial)
        trial_distance = _length(trial_values - goal[active])
        better = trial_distance < distance[active]
        took = active[better]
        p[took], values[took], distance[took] = trial[better], trial_values[better], trial_distance[better]
        damping[took] = np.maximum(damping[took] / 10, 1e-12)
        damping[active[~better]] *= 30
    tail = values.shape[1]
    return Nearest(p.reshape(*shape, n), values.reshape(*shape, tail), distance.reshape(shape))


def _bounded_step(jacobian: Array, residual: Array, p: Array, damping: Array) -> Array:
    """The damped least-squares step (K, n); parameters at a bound that would leave it are held, the others move on."""
    n = p.shape[1]
    gradient = np.einsum("kic,kc->ki", jacobian, residual)
    normal = np.einsum("kic,kjc->kij", jacobian, jacobian)
    held = ((p <= 0) & (gradient < 0)) | ((p >= 1) & (gradient > 0))
    sizes = np.einsum("kii->ki", normal)
    trace = sizes.sum(axis=1) + 1e-200
    # Damped direction by direction: near a pole one of them may be a million times as fast as the other.
    brakes = damping[:, None] * sizes + 1e-15 * trace[:, None]
    identity = np.eye(n)
    keep = (~held[:, :, None]) & (~held[:, None, :])
    system = np.where(keep, normal, 0.0) + brakes[:, :, None] * identity
    system += np.where(held, trace[:, None], 0.0)[:, :, None] * identity
    step = np.linalg.solve(system, np.where(held, 0.0, gradient)[..., None])[..., 0]
    return np.where(np.isfinite(step), step, 0.0)


def _take(better: Nearest, rows: NDArray[np.intp], parameters: Array, points: Array, distances: Array) -> None:
    """Put what is nearer in its place."""
    closer = better.distances < distances[rows]
    parameters[rows[closer]] = better.parameters[closer]
    points[rows[closer]] = better.points[closer]
    distances[rows[closer]] = better.distances[closer]


def _along(at: Evaluator, seeds: Array, ends: Array, targets: Array) -> Array:
    """The best place on each line from a seed to where Gauss-Newton ended, (K, S, n).

    A step that crosses a fold lands where nothing changes any more; the target lies on the line, just before the fold. Of
    places that are as good the one nearest to the seed is taken, so that zooming in finds the fold's edge.
    """
    k, s, n = seeds.shape
    low, high = np.zeros((k, s)), np.ones((k, s))
    for _ in range(ZOOMS):
        t = low[..., None] + (high - low)[..., None] * np.linspace(0.0, 1.0, LINE)
        trial = seeds[:, :, None] + t[..., None] * (ends - seeds)[:, :, None]
        d = _length(at(trial.reshape(-1, n)).reshape(k, s, LINE, -1) - targets[:, None, None])
        best = (d <= d.min(axis=2, keepdims=True) * (1 + 1e-9)).argmax(axis=2)
        rows = np.indices((k, s))
        low = t[(*rows, np.maximum(best - 1, 0))]
        high = t[(*rows, np.minimum(best + 1, LINE - 1))]
    middle: Array = t[(*rows, best)][..., None]
    return seeds + middle * (ends - seeds)


def _pattern(at: Evaluator, seeds: Array, targets: Array, cell: float) -> Nearest:
    """A shrinking-window search from seeds (K, S, n), the last of them with a wide window."""
    k, s, n = seeds.shape
    steps = 5 if n < 3 else 3
    offsets = np.array(list(itertools.product(np.linspace(-1, 1, steps), repeat=n)))
    p = seeds.reshape(-1, n).copy()
    goal = np.repeat(targets, s, axis=0)
    window = np.tile(np.array([2.0 * cell] * (s - 1) + [0.25]), k)[:, None]
    best = np.full(len(p), np.inf)
    points = np.empty((len(p), targets.shape[1]))
    rows = np.arange(len(p))
    for _ in range(PATTERN_ROUNDS):
        trial = np.clip(p[:, None] + window[..., None] * offsets, 0.0, 1.0)
        values = at(trial.reshape(-1, n)).reshape(len(p), len(offsets), -1)
        distances = _length(values - goal[:, None])
        pick = distances.argmin(axis=1)
        better = distances[rows, pick] < best
        p[better] = trial[rows, pick][better]
        points[better] = values[rows, pick][better]
        best[better] = distances[rows, pick][better]
        window = window * SHRINK
    return _best(Nearest(p.reshape(k, s, n), points.reshape(k, s, -1), best.reshape(k, s)))


def _length(vectors: Array) -> Array:
    lengths: NDArray[np.float64] = np.linalg.norm(vectors, axis=-1)
    return np.where(np.isfinite(lengths), lengths, np.inf)
