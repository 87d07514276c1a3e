"""The same map in another place: moved, turned, mirrored or scaled, for each relabelling of the parameters.

Samples are matched by their parameters, so the best motion is found in closed form (S. Umeyama, Least-squares estimation of
transformation parameters between two point patterns, IEEE PAMI 13, 1991), with det Q forced to +1 and to -1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from autograder.comparison.answers import Array
from autograder.comparison.maps import Sampled
from autograder.comparison.symmetry import Symmetry

FITS = 1e-8  # residual relative to the size


@dataclass(frozen=True, eq=False)
class Motion:
    """x -> scale Q x + shift, with Q orthogonal."""

    scale: float
    turn: Array
    shift: Array

    def __call__(self, points: Array) -> Array:
        """The moved points."""
        return self.scale * points @ self.turn.T + self.shift

    @property
    def inverse(self) -> Motion:
        """The motion back."""
        back = self.turn.T
        return Motion(1 / self.scale, back, -(self.shift @ back.T) / self.scale)

    @property
    def reflects(self) -> bool:
        """Whether it mirrors."""
        return bool(np.linalg.det(self.turn) < 0)

    @property
    def keeps_size(self) -> bool:
        """Whether lengths stay."""
        return abs(self.scale - 1) <= 1e-7

    def kind(self, size: float) -> str:
        """``translation``, ``rotation`` (about an axis through the origin), ``screw`` (another turn), ``reflection``,
        ``scale`` (about the origin) or ``similarity``. Shifts are judged relative to the size.
        """
        still = np.abs(self.turn - np.eye(3)).max() <= 1e-7
        fixed = float(np.linalg.norm(self.shift)) <= 1e-7 * size
        if not self.keeps_size:
            return "scale" if still and fixed else "similarity"
        if self.reflects:
            return "reflection"
        return "translation" if still else "rotation" if fixed else "screw"

    @property
    def angle(self) -> float:
        """Angle of the turn in degrees, 0 to 180."""
        return float(np.degrees(np.arccos(np.clip((np.trace(self.turn) - 1) / 2, -1.0, 1.0))))

    @property
    def axis(self) -> Array:
        """Unit direction of the turn's axis, by the right-hand rule where the angle is below 180°."""
        values, vectors = np.linalg.eig(self.turn)
        axis = np.real(vectors[:, np.argmin(np.abs(values - 1))])
        curl = np.array(
            [self.turn[2, 1] - self.turn[1, 2], self.turn[0, 2] - self.turn[2, 0], self.turn[1, 0] - self.turn[0, 1]]
        )
        sign = np.sign(axis @ curl) if np.linalg.norm(curl) > 1e-9 else np.sign(axis[np.abs(axis).argmax()])
        found: Array = axis * (sign or 1.0)
        return found


@dataclass(frozen=True, eq=False)
class Moved:
    """f∘σ is the reference moved."""

    symmetry: Symmetry
    motion: Motion


def fit(points: Array, goal: Array, *, mirrored: bool, scaled: bool = True) -> tuple[Motion, float]:
    """The best motion of points (K, 3) onto goal, with det Q = -1 if ``mirrored``, and its largest residual."""
    a, b = points.mean(axis=0), goal.mean(axis=0)
    p, q = points - a, goal - b
    left, sizes, right = np.linalg.svd(q.T @ p)
    signs = np.ones(3)
    signs[2] = np.sign(np.linalg.det(left @ right)) * (-1.0 if mirrored else 1.0)
    turn = left * signs @ right
    square = float((p * p).sum())
    scale = float((sizes * signs).sum()) / square if square > 0 and scaled else 1.0
    if not 1e-3 < scale < 1e3:
        return Motion(1.0, np.eye(3), np.zeros(3)), np.inf
    motion = Motion(scale, turn, b - scale * a @ turn.T)
    return motion, float(np.linalg.norm(motion(points) - goal, axis=1).max())


def moved(f: Sampled) -> Moved | None:
    """T3: a motion under which the reference, relabelled, becomes f.

    Unit scale goes first, then no mirror, then plain labels: several motions fit where the reference has symmetries.
    """
    if f.values.ndim != 2 or f.values.shape[1] != 3 or len(f.indices) < 8:
        return None
    allowed = max(FITS * f.target.size, f.target.allowed)
    found = []
    for rank, symmetry in enumerate(f.target.symmetries):
        right = f.target.relabelled(symmetry)[f.indices]
        for mirrored in (False, True):
            motion, residual = fit(right, f.values, mirrored=mirrored)
            if residual <= allowed * max(1.0, motion.scale):
                found.append((not motion.keeps_size, mirrored, rank, Moved(symmetry, motion)))
    return min(found, key=lambda entry: entry[:3])[3] if found else None
