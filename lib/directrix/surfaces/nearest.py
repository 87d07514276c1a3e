"""The point of a surface nearest to a given one: a look everywhere first, then Newton's method from the best places."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from directrix.checks import Array, Indices
from directrix.differential import Jet, dot

LEAST = 33  # samples each way of the look everywhere
STARTS = 6  # places from which Newton's method sets out, for each point
ROUNDS = 60  # damped Newton steps at most; quadratic convergence needs about six
STRIDE = 1 / 16  # the longest step: a start stays in the valley that it was chosen for
UNEVEN = 2  # a step between samples so many times the mean one is divided
REFINED = 3  # times at most
CREASE = 1e-4  # a search that ends so near to a break may have met a crease
BATCH = 400_000  # distances held at once


class Nearest(NamedTuple):
    """Parameters of the nearest points, and how far they are; each of the shape of the points given."""

    u: Array
    w: Array
    distance: Array


def nearest(jet: Jet, breaks: tuple[Array, Array], points: Array) -> Nearest:
    """For each of n points (n, 3) the (u, w) of the nearest point of the surface.

    ``jet(u, w, orders)`` gives the surface's derivatives, of order (0, 0) its points; between its breaks it is smooth.

    The surface is sampled at no less than 33 x 33 parameters, six at least between neighbouring breaks, more where it runs
    fast; from up to six local minima of the distance on that grid a damped Newton iteration (Piegl & Tiller, The NURBS Book,
    2nd ed., section 6.1) goes down inside the closed square, and along a crease where it meets one; the best end is kept. A dip
    of the distance narrower than the samples can be missed.
    """
    us, ws, grid = _sampled(jet, *map(_samples, breaks))
    chunk = max(1, BATCH // (len(us) * len(ws)))
    parts = [_nearest(jet, breaks, points[i : i + chunk], us, ws, grid) for i in range(0, len(points), chunk)]
    if not parts:
        return Nearest(*np.empty((3, 0)))
    return Nearest(*(np.concatenate(part) for part in zip(*parts, strict=True)))


def _samples(breaks: Array) -> Array:
    each = max(6, -(-LEAST // (len(breaks) - 1)))
    middles = (np.arange(each) + 0.5) / each  # no sample on an edge: at a pole all directions look alike
    return np.concatenate([a + (b - a) * middles for a, b in pairwise(breaks)])


def _points(jet: Jet, u: Array, w: Array) -> Array:
    return jet(u, w, [(0, 0)])[0]


def _sampled(jet: Jet, us: Array, ws: Array) -> tuple[Array, Array, Array]:
    """The samples, more of them where a step from one to the next is long (unequal weights), and the surface there."""
    axes = [np.concatenate([[0.0], samples, [1.0]]) for samples in (us, ws)]
    for _ in range(REFINED):
        grid = _points(jet, axes[0][:, None], axes[1][None, :])
        steps = [np.linalg.norm(np.diff(grid, axis=axis), axis=-1).max(axis=1 - axis) for axis in (0, 1)]
        finer = [_divided(samples, step) for samples, step in zip(axes, steps, strict=True)]
        if all(len(old) == len(new) for old, new in zip(axes, finer, strict=True)):
            break
        axes = finer
    us, ws = (samples[1:-1] for samples in axes)
    return us, ws, _points(jet, us[:, None], ws[None, :])


def _divided(samples: Array, steps: Array) -> Array:
    """The samples, and between them more where a step is far longer than the mean: half as many more at most."""
    parts = np.maximum(np.ceil(steps / (UNEVEN * (steps.mean() or 1.0))), 1).astype(int)
    made = [a + (b - a) * np.arange(n) / n for (a, b), n in zip(pairwise(samples), parts, strict=True)]
    return np.concatenate([*made, samples[-1:]])


def _nearest(
    jet: Jet, breaks: tuple[Array, Array], points: Array, us: Array, ws: Array, grid: Array
) -> tuple[Array, Array, Array]:
    far = sum((points[:, None, None, i] - grid[..., i]) ** 2 for i in range(3))
    starts = _local_minima(np.asarray(far))
    i, j = np.unravel_index(starts, grid.shape[:2])
    target = np.repeat(points, STARTS, axis=0)
    u, w = _descend(jet, target, us[i].ravel(), ws[j].ravel())
    u, w = _along_creases(jet, breaks, target, u, w)
    square = dot(*(2 * [_points(jet, u, w) - target])).reshape(-1, STARTS)
    best = np.argmin(square, axis=1)
    rows = np.arange(len(points))
    u, w = u.reshape(-1, STARTS)[rows, best], w.reshape(-1, STARTS)[rows, best]
    return u, w, np.sqrt(square[rows, best])


def _local_minima(far: Array) -> Indices:
    """Flat indices (n, STARTS) of the lowest samples (n, a, b) that none of their four neighbours undercuts."""
    padded = np.pad(far, ((0, 0), (1, 1), (1, 1)), constant_values=np.inf)
    low = far <= np.minimum.reduce([padded[:, :-2, 1:-1], padded[:, 2:, 1:-1], padded[:, 1:-1, :-2], padded[:, 1:-1, 2:]])
    ranked = np.where(low, far, np.inf).reshape(len(far), -1)
    some = np.argpartition(ranked, STARTS, axis=1)[:, :STARTS]
    rows = np.arange(len(far))[:, None]
    best = ranked.argmin(axis=1)[:, None]
    return np.where(np.isfinite(ranked[rows, some]), some, best)


def _along_creases(jet: Jet, breaks: tuple[Array, Array], target: Array, u: Array, w: Array) -> tuple[Array, Array]:
    """Searches that may have stopped at a crease go on along it, one parameter held on the break, and then off it again."""
    for axis, inner in enumerate(values[1:-1] for values in breaks):
        here = (u, w)[axis]
        if not len(inner):
            continue
        crease = inner[np.abs(here[:, None] - inner).argmin(axis=1)]
        met = np.flatnonzero(np.abs(here - crease) <= CREASE)
        if not len(met):
            continue
        goal, start = target[met], [u[met], w[met]]
        before = _points(jet, *start) - goal
        start[axis] = crease[met]
        along = _descend(jet, goal, start[0], start[1], (axis == 0, axis == 1))
        end_u, end_w = _descend(jet, goal, *along)
        after = _points(jet, end_u, end_w) - goal
        better = dot(after, after) < dot(before, before)
        u[met[better]], w[met[better]] = end_u[better], end_w[better]
    return u, w


def _descend(jet: Jet, target: Array, u: Array, w: Array, held: Sequence[bool] = (False, False)) -> tuple[Array, Array]:
    """Newton's method on half the squared distance, damped where it would not go down, inside the square.

    ``held``: whether u and whether w stays where it is.
    """
    u, w = u.copy(), w.copy()
    damping = np.full(len(u), 1e-8)
    active = np.arange(len(u))
    orders = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]
    for _ in range(ROUNDS):
        here, su, sw, suu, suw, sww = jet(u[active], w[active], orders)
        away = here - target[active]
        step = _step(away, su, sw, (suu, suw, sww), u[active], w[active], damping[active], held)
        short = [np.clip(part, -STRIDE, STRIDE) for part in step]
        new_u, new_w = (np.clip(old[active] + part, 0.0, 1.0) for old, part in zip((u, w), short, strict=True))
        after = _points(jet, new_u, new_w) - target[active]
        better = dot(after, after) <= dot(away, away)
        moved = np.maximum(np.abs(new_u - u[active]), np.abs(new_w - w[active]))
        u[active] = np.where(better, new_u, u[active])
        w[active] = np.where(better, new_w, w[active])
        damping[active] = np.where(better, damping[active] / 8, damping[active] * 8)
        active = active[(moved > 1e-14) & (better | (moved > 1e-9))]
        if not len(active):
            break
    return u, w


def _step(
    away: Array,
    su: Array,
    sw: Array,
    seconds: tuple[Array, ...],
    u: Array,
    w: Array,
    damping: Array,
    held: Sequence[bool],
) -> tuple[Array, Array]:
    """The step that solves (H + damping |H| I) step = -gradient; Gauss-Newton's H where the full one is not positive.

    A parameter that stands on its bound and is pushed outwards stays there, and the other one moves alone.
    """
    suu, suw, sww = seconds
    gu, gw = dot(away, su), dot(away, sw)
    held_u = held[0] | ((u == 0) & (gu > 0)) | ((u == 1) & (gu < 0))
    held_w = held[1] | ((w == 0) & (gw > 0)) | ((w == 1) & (gw < 0))
    a, b, c = dot(su, su), dot(su, sw), dot(sw, sw)
    b = np.where(held_u | held_w, 0.0, b)
    full_a, full_c = a + dot(away, suu), c + dot(away, sww)
    full_b = np.where(held_u | held_w, 0.0, b + dot(away, suw))
    convex = (held_u | (full_a > 0)) & (held_w | (full_c > 0)) & (held_u | held_w | (full_a * full_c > full_b**2))
    a, b, c = (np.where(convex, whole, part) for whole, part in ((full_a, a), (full_b, b), (full_c, c)))
    a, c = np.where(held_u, 1.0, a), np.where(held_w, 1.0, c)
    lift = damping * (a + c) + np.finfo(np.float64).tiny
    a, c = a + lift, c + lift
    gu, gw = np.where(held_u, 0.0, gu), np.where(held_w, 0.0, gw)
    determinant = np.maximum(a * c - b * b, np.finfo(np.float64).tiny)
    return (b * gw - c * gu) / determinant, (b * gu - a * gw) / determinant
