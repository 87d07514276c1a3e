"""The last rung: the same set of points, moved and traced in another way.

Centroids and second moments of both sets give a first guess of the motion (up to the signs of the principal axes, and up to
their order where moments agree). It is refined with residuals both ways, in which motion along free directions of the surface
is projected out: plain point-to-point matching crawls along a cylinder, and one-sided matching never feels its ends.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np

from autograder.comparison.answers import Array
from autograder.comparison.motion import Motion
from autograder.comparison.nearest import Evaluator, Nearest, improved, nearest, slopes
from autograder.comparison.sets import SAME, Measured, on

MOMENTS = 0.02  # relative difference of second moments that is still taken for equal
CANDIDATES = 3
ROUNDS = 12
MOST = 0.85  # the share of points that a trimmed refinement listens to
STALLED = 0.6  # Gauss-Newton that leaves more than this share of its residual is on its way to no match
ELSEWHERE = 0.05  # guesses whose mean distance, relative to the spread, is larger are no match


def moved_set(yours: Measured, right: Measured, size: float) -> Motion | None:
    """The motion that takes the right set to the learner's, or None."""
    for motion in _guesses(yours, right)[:CANDIDATES]:
        for trimmed in (False, True):
            refined = _refined(motion, yours, right, size, trimmed=trimmed)
            if refined is not None and _holds(refined, yours, right, size):
                return refined if _moves(refined, right, size) else None
    return None


def _moves(motion: Motion, right: Measured, size: float) -> bool:
    """Whether it takes the set to another place: within what counts as the same, it is the same place, met less well."""
    return bool(np.linalg.norm(motion(right.points) - right.points, axis=-1).max() > 100 * SAME * size)


def _moments(of: Measured) -> tuple[Array, Array, Array]:
    """Centroid, second moments (ascending) and principal axes (columns), weighted with the measure."""
    weights = of.elements / of.elements.sum()
    centre = weights @ of.points
    away = of.points - centre
    values, axes = np.linalg.eigh((weights[:, None] * away).T @ away)
    return centre, values, axes


def _guesses(yours: Measured, right: Measured) -> list[Motion]:
    """Motions that match the moments, the best first; proper ones before mirrored ones that are as good."""
    if not (yours.measure > 0 and right.measure > 0 and np.isfinite(yours.points).all()):
        return []
    (a, spread_a, axes_a), (b, spread_b, axes_b) = _moments(right), _moments(yours)
    if not (spread_a[-1] > 0 and spread_b[-1] > 0):
        return []
    scale = float(np.sqrt(spread_b.sum() / spread_a.sum()))
    if not 1e-3 < scale < 1e3:
        return []
    if abs(scale - 1) < MOMENTS:
        scale = 1.0
    if np.abs(spread_b - scale**2 * spread_a).max() > 2 * MOMENTS * spread_b[-1]:
        return []
    across = float(np.sqrt(spread_a.sum()))
    thin = yours.points[:: max(1, len(yours.points) // 150)]
    found: list[tuple[float, bool, int, Motion]] = []
    for axes in _frames(axes_b, np.diff(spread_a) < 4 * MOMENTS * spread_a[-1]):
        turn = axes @ axes_a.T
        motion = Motion(scale, turn, b - scale * a @ turn.T)
        distances, _ = right.cloud.tree.query(motion.inverse(thin))
        off = float(distances.mean()) / across
        if off <= ELSEWHERE:
            found.append((round(off, 2), motion.reflects, len(found), motion))
    return [entry[3] for entry in sorted(found, key=lambda entry: entry[:3])]


def _frames(axes: Array, equal: Array) -> Iterator[Array]:
    """Principal axes with every choice of signs and, between axes whose moments agree, turned in steps of 15°."""
    plane = {(True, False): (0, 1), (False, True): (1, 2)}.get((bool(equal[0]), bool(equal[1])))
    orders = [[0, 1, 2]]
    if plane is not None:
        exchanged = [0, 1, 2]
        exchanged[plane[0]], exchanged[plane[1]] = plane[1], plane[0]
        orders.append(exchanged)
    elif equal.all():
        orders = [list(order) for order in itertools.permutations(range(3))]
    for angle in np.radians(np.arange(0, 90, 15)) if plane is not None else [0.0]:
        turned = axes.copy()
        if plane is not None:
            one, other = axes[:, plane[0]], axes[:, plane[1]]
            turned[:, plane[0]] = np.cos(angle) * one + np.sin(angle) * other
            turned[:, plane[1]] = np.cos(angle) * other - np.sin(angle) * one
        for order, signs in itertools.product(orders, itertools.product((1.0, -1.0), repeat=3)):
            yield turned[:, order] * signs


def _refined(motion: Motion, yours: Measured, right: Measured, size: float, *, trimmed: bool) -> Motion | None:
    """Two-sided Gauss-Newton over the motion; None where it does not come near.

    ``trimmed``: without the points that are much farther off than most. Their searches may rest on an edge where the map starts
    so slowly that no derivative leads off it; but a flat patch has nothing except such points to tell where it ends.
    """
    scaled = motion.scale != 1.0
    x, z = yours.probes, right.probes
    there, back = _close_by(right, motion.inverse(x), size), _close_by(yours, motion(z), size)
    last = worst = np.inf
    for round_number in range(ROUNDS):
        pulled, met = motion.inverse(x), motion.inverse(back.points)
        keep = 3.0 if trimmed else np.inf
        rows = [_residual(right.at, there, pulled, there.points, pulled, keep)]
        rows.append(_residual(yours.at, back, met, z, met, keep, motion))
        matrix, residual = (np.concatenate(parts) for parts in zip(*rows, strict=True))
        if not scaled:
            matrix = matrix[:, :6]
        step = np.linalg.lstsq(matrix, -residual, rcond=1e-9)[0]
        motion = _nudged(motion, step)
        there = improved(right.at, there, motion.inverse(x), 3)
        back = improved(yours.at, back, motion(z), 3)
        worst = max(_most(near) if trimmed else float(near.distances.max()) for near in (there, back))
        if worst <= SAME * size / 10 or (round_number > 1 and worst > max(STALLED * last, 1e-5 * size)):
            break
        last = worst
    return motion if worst <= 10 * SAME * size else None


def _close_by(of: Measured, targets: Array, size: float) -> Nearest:
    """Nearest places under a rough guess: the search may stop early."""
    return improved(of.at, nearest(of.at, of.cloud, targets, 1e-2 * size), targets, 6)


def _most(near: Nearest) -> float:
    """The distance that all but a few of the points keep to."""
    return float(np.quantile(near.distances, MOST))


def _residual(
    at: Evaluator, near: Nearest, points: Array, goal: Array, moving: Array, keep: float, motion: Motion | None = None
) -> tuple[Array, Array]:
    """Rows (3K, 7) of d(residual)/d(turn, shift, log scale) and residuals (3K,), free tangent directions projected out.

    Points farther off than ``keep`` times what most keep to are left out.
    """
    tangents = slopes(at, near.parameters, near.points)
    if motion is not None:
        tangents = tangents @ motion.turn / motion.scale
    free = (near.parameters > 1e-9) & (near.parameters < 1 - 1e-9)
    tangents = np.where(free[..., None], tangents, 0.0)
    # Projector on what is orthogonal to the free tangents, by the pseudo-inverse: collapsed directions project nothing.
    pseudo = np.linalg.pinv(tangents, rcond=1e-6)
    project = np.eye(3) - pseudo @ tangents
    k = len(points)
    rate = np.zeros((k, 3, 7))
    rate[:, 0, 1], rate[:, 0, 2] = moving[:, 2], -moving[:, 1]
    rate[:, 1, 0], rate[:, 1, 2] = -moving[:, 2], moving[:, 0]
    rate[:, 2, 0], rate[:, 2, 1] = moving[:, 1], -moving[:, 0]
    rate[:, :, 3:6] = np.eye(3)
    rate[:, :, 6] = moving
    kept = near.distances <= (keep * _most(near) if np.isfinite(keep) else np.inf)
    residual = np.einsum("kij,kj->ki", project, points - goal)
    return (project @ rate)[kept].reshape(-1, 7), residual[kept].ravel()


def _nudged(motion: Motion, step: Array) -> Motion:
    """The motion after the pulled-back points have been turned, shifted and scaled by a small step."""
    angle = float(np.linalg.norm(step[:3]))
    k = step[:3] / angle if angle > 0 else np.array([0.0, 0.0, 1.0])
    cross = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    turn = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    grow = float(np.exp(step[6])) if len(step) > 6 else 1.0
    back = motion.inverse
    pulled = Motion(back.scale * grow, turn @ back.turn, grow * back.shift @ turn.T + step[3:6])
    return pulled.inverse


def _holds(motion: Motion, yours: Measured, right: Measured, size: float) -> bool:
    """Whether the moved right set and the learner's are the same set."""
    inverse = motion.inverse
    return on(inverse(yours.probes), right.at, right.cloud, size) and on(
        motion(right.probes), yours.at, yours.cloud, size * motion.scale
    )
