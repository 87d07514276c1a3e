"""The symmetries of the parameter domain [0, 1]^n: parameters exchanged and run backwards.

A symmetry σ takes the parameters p to q with q[i] = p[order[i]], replaced by 1 - p[order[i]] where ``flipped[i]``. There are
2 for a curve, the dihedral group of 8 for a surface and 48 for a solid.
"""

from __future__ import annotations

import functools
import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

# A surface's eight have names of their own; the order is that of plainness, in which one of several is claimed.
SURFACE_NAMES: dict[tuple[tuple[int, ...], tuple[bool, ...]], str] = {
    ((0, 1), (False, False)): "id",
    ((0, 1), (True, False)): "flip_u",
    ((0, 1), (False, True)): "flip_w",
    ((1, 0), (False, False)): "swap",
    ((0, 1), (True, True)): "rot180",
    ((1, 0), (True, False)): "rot90",
    ((1, 0), (False, True)): "rot270",
    ((1, 0), (True, True)): "antiswap",
}


@dataclass(frozen=True)
class Symmetry:
    """One relabelling of the parameters ``names``; see the module for what ``order`` and ``flipped`` mean."""

    names: tuple[str, ...]
    order: tuple[int, ...]
    flipped: tuple[bool, ...]

    @property
    def name(self) -> str:
        """``id``, ``flip_u``, ``swap`` ... for a surface; ``flip_v`` or ``(w, v, 1-u)`` for a solid."""
        if len(self.names) == 2:
            return SURFACE_NAMES[self.order, self.flipped]
        if self.order == tuple(range(len(self.order))):
            turned = [name for name, flip in zip(self.names, self.flipped, strict=True) if flip]
            return "flip_" + "".join(turned) if turned else "id"
        return self.formula

    @property
    def formula(self) -> str:
        """The parameters it leads to: ``(1-w, u)``."""
        return "(" + ", ".join(
            f"1-{self.names[i]}" if flip else self.names[i] for i, flip in zip(self.order, self.flipped, strict=True)
        ) + ")"  # fmt: skip

    @property
    def determinant(self) -> int:
        """+1 where the sense of the domain, hence the side of a surface's normal, is kept, else -1."""
        n = len(self.order)
        crossings = sum(self.order[i] > self.order[j] for i in range(n) for j in range(i + 1, n))
        return -1 if (crossings + sum(self.flipped)) % 2 else 1

    @property
    def inverse(self) -> Symmetry:
        """The symmetry that undoes it."""
        order = [0] * len(self.order)
        flipped = [False] * len(self.order)
        for i, (source, flip) in enumerate(zip(self.order, self.flipped, strict=True)):
            order[source], flipped[source] = i, flip
        return Symmetry(self.names, tuple(order), tuple(flipped))

    def __call__(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """The relabelled parameters of points (..., n)."""
        taken = points[..., list(self.order)]
        return np.where(self.flipped, 1.0 - taken, taken)


@functools.cache
def symmetries(names: tuple[str, ...]) -> tuple[Symmetry, ...]:
    """All symmetries for these parameter names, the identity first, plainer ones before others."""
    n = len(names)
    every = [
        Symmetry(names, order, flipped)
        for order in itertools.permutations(range(n))
        for flipped in itertools.product((False, True), repeat=n)
    ]
    if n == 2:
        rank = list(SURFACE_NAMES.values())
        return tuple(sorted(every, key=lambda s: rank.index(s.name)))
    return tuple(sorted(every, key=lambda s: (s.order != tuple(range(n)), sum(s.flipped), s.order)))
