"""The point of a surface nearest to a given one: a look everywhere first, then Newton's method from the best places."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from directrix.checks import Array, Indices
from directrix.differential import dot

if TYPE_CHECKING:
    from directrix.surfaces.surface import Surface

LEAST = 33  # samples each way of the look everywhere
STARTS = 6  # places from which Newton's method sets out, for each point
ROUNDS = 60  # damped Newton steps at most; quadratic convergence needs about six
STRIDE = 1 / 16  # the longest step: a start stays in the valley that it was chosen for
BATCH = 400_000  # distances held at once


class Nearest(NamedTuple):
    """Parameters of the nearest points, and how far they are; each of the shape of the points given."""

    u: Array
    w: Array
    distance: Array


def nearest(surface: Surface, points: Array) -> Nearest:
    """For each of n points (n, 3) the (u, w) of the nearest point of the surface.

    The surface is sampled at no less than 33 x 33 parameters, six at least between neighbouring breaks; from up to six local
    minima of the distance on that grid a damped Newton iteration (Piegl & Tiller, The NURBS Book, 2nd ed., section 6.1) goes
    down inside the closed square, and the best end is kept. A dip of the distance narrower than the samples can be missed.
    """
    us, ws = (_samples(breaks) for breaks in surface.breaks())
    grid = surface(us[:, None], ws[None, :])
    chunk = max(1, BATCH // (len(us) * len(ws)))
    parts = [_nearest(surface, points[i : i + chunk], us, ws, grid) for i in range(0, len(points), chunk)]
    if not parts:
        return Nearest(*np.empty((3, 0)))
    return Nearest(*(np.concatenate(part) for part in zip(*parts, strict=True)))


def _samples(breaks: Array) -> Array:
    each = max(6, -(-LEAST // (len(breaks) - 1)))
    middles = (np.arange(each) + 0.5) / each  # no sample on an edge: at a pole all directions look alike
    return np.concatenate([a + (b - a) * middles for a, b in pairwise(breaks)])


def _nearest(surface: Surface, points: Array, us: Array, ws: Array, grid: Array) -> tuple[Array, Array, Array]:
    far = sum((points[:, None, None, i] - grid[..., i]) ** 2 for i in range(3))
    starts = _local_minima(np.asarray(far))
    i, j = np.unravel_index(starts, grid.shape[:2])
    target = np.repeat(points, STARTS, axis=0)
    u, w = _descend(surface, target, us[i].ravel(), ws[j].ravel())
    square = dot(*(2 * [surface(u, w) - target])).reshape(-1, STARTS)
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


def _descend(surface: Surface, target: Array, u: Array, w: Array) -> tuple[Array, Array]:
    """Newton's method on half the squared distance, damped where it would not go down, held inside the square."""
    damping = np.full(len(u), 1e-8)
    active = np.arange(len(u))
    orders = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))
    for _ in range(ROUNDS):
        here, su, sw, suu, suw, sww = surface._jet_at(u[active], w[active], list(orders))
        away = here - target[active]
        step = _step(away, su, sw, (suu, suw, sww), u[active], w[active], damping[active])
        short = [np.clip(part, -STRIDE, STRIDE) for part in step]
        new_u, new_w = (np.clip(old[active] + part, 0.0, 1.0) for old, part in zip((u, w), short, strict=True))
        after = surface(new_u, new_w) - target[active]
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
    away: Array, su: Array, sw: Array, seconds: tuple[Array, ...], u: Array, w: Array, damping: Array
) -> tuple[Array, Array]:
    """The step that solves (H + damping |H| I) step = -gradient; Gauss-Newton's H where the full one is not positive.

    A parameter that stands on its bound and is pushed outwards stays there, and the other one moves alone.
    """
    suu, suw, sww = seconds
    gu, gw = dot(away, su), dot(away, sw)
    held_u = ((u == 0) & (gu > 0)) | ((u == 1) & (gu < 0))
    held_w = ((w == 0) & (gw > 0)) | ((w == 1) & (gw < 0))
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
