"""The cheap rungs for maps of the parameter domain: identical, relabelled, other start, close.

All of them compare values f that are already there with the reference at other parameters; none calls the learner's function.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from autograder.comparison.answers import Array
from autograder.comparison.symmetry import Symmetry
from autograder.comparison.target import Target

CLOSE = 2e-3
COARSE = {1: 72, 2: 20, 3: 8}  # trial shifts along each of 1, 2 or 3 closed directions
PROBES = 10


@dataclass(frozen=True, eq=False)
class Sampled:
    """A learner's map on one data set: values (K, 3) at the samples of these indices (K,)."""

    target: Target
    indices: NDArray[np.intp]
    values: Array

    @cached_property
    def points(self) -> Array:
        """The parameters, (K, n)."""
        return self.target.samples.points[self.indices]

    @cached_property
    def expected(self) -> Array:
        """The right values at the same parameters."""
        return self.target.values[self.indices]

    @cached_property
    def deviations(self) -> Array:
        """Distance between the two at each sample, (K,)."""
        return distances(self.values, self.expected)

    @property
    def worst(self) -> float:
        """The largest deviation relative to the size D."""
        return float(self.deviations.max()) / self.target.size

    @property
    def identical(self) -> bool:
        """T0: equal up to the tolerance at every sample."""
        worst = self.deviations.max()
        return bool(worst <= self.target.rounding or worst <= self.target.allowed)

    @property
    def close(self) -> bool:
        """T1c: a rounded constant away."""
        return self.worst <= CLOSE

    def equals(self, values: Array) -> bool:
        """Whether it has these values (N, 3) at the samples, up to the tolerance of the reference."""
        return bool(distances(self.values, values[self.indices]).max() <= self.target.allowed)


@dataclass(frozen=True)
class Shifted:
    """f(σ(p)) = g(p + shift): the symmetry and, per parameter, the shift in [0, 1); None along a direction not closed."""

    symmetry: Symmetry
    shift: tuple[float | None, ...]


def distances(a: Array, b: Array) -> Array:
    """Distance of each value of a from that of b: of points (K, 3), or of the numbers (K,) of a mask."""
    difference = np.abs(a - b)
    return difference if difference.ndim == 1 else np.linalg.norm(difference, axis=-1)


def agree(a: Array, b: Array, allowed: float) -> bool:
    """Whether both have the same shape and the same values; NaN agrees with NaN."""
    if a.shape != b.shape:
        return False
    if (np.abs(a - b) <= allowed).all():  # as it is nearly always
        return True
    with np.errstate(invalid="ignore"):
        return bool(((np.abs(a - b) <= allowed) | (np.isnan(a) & np.isnan(b)) | (a == b)).all())


def relabellings(f: Sampled) -> tuple[Symmetry, ...]:
    """T1: every symmetry σ with f∘σ = g, the identity included where f = g."""
    same, *others = f.target.symmetries
    return tuple([same] * f.identical + [s for s in others if f.equals(f.target.relabelled(s))])


def closed_directions(target: Target) -> tuple[int, ...]:
    """The parameters in which the reference closes: g at 0 equals g at 1."""
    return _closed(target, target.values)


def _closed(target: Target, values: Array) -> tuple[int, ...]:
    """The parameters in which these values at all samples close."""
    found = []
    for axis in range(target.samples.dimension):
        start, end = (values[target.samples.edges[axis, side]] for side in (0, 1))
        whole = values[target.samples.grid].std(axis=axis).max()  # an axis along which nothing moves is no circle
        if agree(start, end, 1e-7 * target.size) and whole > 1e-6 * target.size:
            found.append(axis)
    return tuple(found)


def other_start(f: Sampled) -> Shifted | None:
    """T1b: the same map but for the place where it starts along closed directions, up to a symmetry; None if it is not.

    A grid of trial shifts for every symmetry at a few points, then Gauss-Newton on all samples.
    """
    target, closed = f.target, closed_directions(f.target)
    whole_grid = len(f.indices) == len(target.samples.points)
    if not closed or (whole_grid and len(_closed(target, f.values)) < len(closed)):
        return None
    few = np.linspace(0, len(f.indices) - 1, PROBES).astype(int)
    axis = np.arange(COARSE[len(closed)]) / COARSE[len(closed)]
    trials = np.array(list(itertools.product(axis, repeat=len(closed))))
    symmetries = target.symmetries
    back = [s.inverse(f.points) for s in symmetries]
    starts = np.stack([_shifted(points[few], trials, closed) for points in back])
    values = target.at(starts.reshape(-1, target.samples.dimension)).reshape(*starts.shape[:-1], -1)
    errors = ((values - f.values[few]) ** 2).sum(axis=(2, 3))
    shifts = trials[errors.argmin(axis=1)]
    hopeful = np.flatnonzero(errors.min(axis=1) <= 0.1 * PROBES * target.size**2)
    for i in hopeful[np.argsort(errors.min(axis=1)[hopeful], kind="stable")][:4]:
        shift = _refined(f, back[i], shifts[i], closed)
        if agree(f.values, target.at(_shifted(back[i], shift[None], closed)[0]), target.allowed):
            # f(q) = g(σ⁻¹(q) + shift), so f(σ(p)) = g(p + shift).
            whole: list[float | None] = [None] * target.samples.dimension
            for k, direction in enumerate(closed):
                whole[direction] = float(np.round(shift[k] % 1.0, 9) % 1.0)
            return Shifted(symmetries[i], tuple(whole))
    return None


def _shifted(points: Array, shifts: Array, closed: tuple[int, ...]) -> Array:
    """Points (K, n) moved by each of the shifts (T, c) along the closed directions, wrapped: (T, K, n)."""
    moved = np.repeat(points[None], len(shifts), axis=0)
    moved[..., list(closed)] = (moved[..., list(closed)] + shifts[:, None, :]) % 1.0
    return moved


def _refined(f: Sampled, points: Array, shift: Array, closed: tuple[int, ...]) -> Array:
    """Gauss-Newton for the shift that brings the reference at the points to f; central differences."""
    step, best = 1e-5, shift
    for _ in range(12):
        offsets = np.concatenate([np.zeros((1, len(closed))), step * np.eye(len(closed)), -step * np.eye(len(closed))])
        moved = _shifted(points, best + offsets, closed)
        values = f.target.at(moved.reshape(-1, points.shape[1])).reshape(len(offsets), -1)
        residual = f.values.ravel() - values[0]
        slopes = (values[1 : 1 + len(closed)] - values[1 + len(closed) :]).T / (2 * step)
        change = np.clip(np.linalg.lstsq(slopes, residual, rcond=None)[0], -0.02, 0.02)
        best = best + change
        if np.abs(change).max() < 1e-14:
            break
    return best
