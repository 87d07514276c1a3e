"""Which surface a quadric is: rank and signature of Q = [[M, b], [bᵀ, c]], with tolerances of the right dimension.

M is made dimensionless by its largest eigenvalue; then b is a length and c the square of one, and each is compared with what it
was computed from. So the answer does not depend on the unit of length, on the factor of the equation, or on the place.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from directrix.checks import Array

BENDING = 1e4  # a paraboloid flatter than tolerance * BENDING of its size is told from a cylinder by rounding alone

KINDS = (
    "ellipsoid",
    "hyperboloid of one sheet",
    "hyperboloid of two sheets",
    "cone",
    "elliptic paraboloid",
    "hyperbolic paraboloid",
    "elliptic cylinder",
    "hyperbolic cylinder",
    "parabolic cylinder",
    "intersecting planes",
    "parallel planes",
    "coincident planes",
    "line",
    "point",
    "empty",
    "everything",
)


@dataclass(frozen=True, eq=False)
class Classification:
    """What a quadric is, and where it lies: see `Quadric.classify` for the equation that goes with each kind.

    Attributes
    ----------
    kind : str
        One of `KINDS`.
    center : (3,) array or None
        Centre, vertex or apex; where there is a whole line or plane of centres, the one nearest to the origin. None for
        ``empty`` and ``everything``.
    axes : (3, 3) array or None
        Rows e1, e2, e3: a right-handed orthonormal frame.
    radii : (3,) array or None
        The lengths a, b, c of the standard equation; infinite along a direction in which the surface is straight.
    """

    kind: str
    center: Array | None = None
    axes: Array | None = None
    radii: Array | None = None

    def __repr__(self) -> str:
        if self.center is None or self.radii is None:
            return f"Classification({self.kind!r})"
        with np.printoptions(precision=6, suppress=True):
            return f"Classification({self.kind!r}, center={self.center}, radii={self.radii})"


def classified(Q: Array, tolerance: float, size: float) -> Classification:
    """The kind, frame and radii of the quadric of a symmetric matrix Q (4, 4): see `Quadric.classify`."""
    M, b, c = Q[:3, :3], Q[:3, 3], Q[3, 3]
    values, vectors = np.linalg.eigh(M)
    largest = np.abs(values).max()
    if largest == 0 or (size and largest * size**2 <= tolerance * max(np.abs(b).max() * size, abs(c))):
        return _plane(b, c, tolerance, size)
    values, b, c = values / largest, b / largest, c / largest  # now b is a length and c a length squared
    kept = np.abs(values) > tolerance
    if np.sign(values[kept]).sum() < 0:
        values, b, c = -values, -b, -c
    along = vectors.T @ b
    foot = np.where(kept, -along / np.where(kept, values, 1.0), 0.0)
    center = vectors @ foot
    c0 = c + along[kept] @ foot[kept]
    b0 = np.where(kept, 0.0, along)
    length = np.abs(b).max() / np.abs(values[kept]).min() + np.sqrt(abs(c)) + size
    if np.linalg.norm(b0) <= BENDING * tolerance * length:
        b0 = np.zeros(3)
    if abs(c0) <= tolerance * (abs(c) + foot @ foot + size**2):
        c0 = 0.0
    if b0.any():
        return _without_center(values, vectors, kept, b0, c0, center)
    return _central(values, vectors, kept, c0, center)


def _plane(b: Array, c: float, tolerance: float, size: float) -> Classification:
    """0 x² + ... + 2 b·x + c = 0."""
    steep = float(np.linalg.norm(b))
    if steep == 0 or (size and steep * size <= tolerance * abs(c)):
        return Classification("everything" if c == 0 else "empty")
    normal = b / steep
    across = np.linalg.svd(normal[None])[2][2]
    return _frame("coincident planes", -c / (2 * steep) * normal, normal, across, (0.0, np.inf, np.inf))


def _without_center(values: Array, vectors: Array, kept: Array, b0: Array, c0: float, foot: Array) -> Classification:
    """Σ λ_i x_i² + 2 b0·x + c0 = 0 with b0 in the null space of M: paraboloids and the parabolic cylinder."""
    steep = float(np.linalg.norm(b0))
    opening = -(vectors @ b0) / steep
    pairs = sorted(((steep / values[i], vectors[:, i]) for i in np.nonzero(kept)[0]), key=lambda pair: -abs(pair[0]))
    vertex = foot + c0 / (2 * steep) * opening
    if len(pairs) == 1:
        (a, e1) = pairs[0]
        return _frame("parabolic cylinder", vertex, e1, np.sign(a) * opening, (abs(a), np.inf, np.inf))
    (a, e1), (b, _) = pairs
    kind = "elliptic paraboloid" if a * b > 0 else "hyperbolic paraboloid"
    return _frame(kind, vertex, e1, np.sign(a) * opening, (abs(a), abs(b), np.inf))


def _central(values: Array, vectors: Array, kept: Array, c0: float, center: Array) -> Classification:
    """Σ λ_i x_i² + c0 = 0."""
    plus = [i for i in range(3) if kept[i] and values[i] > 0]
    minus = [i for i in range(3) if kept[i] and values[i] < 0]
    flat = [i for i in range(3) if not kept[i]]
    if c0 > 0 and not minus:
        return Classification("empty")
    if c0 > 0 and len(plus) == len(minus):
        plus, minus = minus, plus
    unit = np.sqrt(abs(c0)) if c0 else 1.0
    half = unit / np.sqrt(np.where(kept, np.abs(values), np.nan))
    plus.sort(key=lambda i: -half[i])
    order = np.array([*plus, *minus, *flat], dtype=np.intp)
    a, b, c = half[order]
    e1, e3 = vectors[:, order[0]], vectors[:, order[2]]
    inf = np.inf
    match (len(plus), len(minus)):
        case (3, 0):
            return _frame("ellipsoid" if c0 else "point", center, e1, e3, (a, b, c) if c0 else (0.0, 0.0, 0.0))
        case (2, 1) if c0:
            kind = "hyperboloid of one sheet" if c0 < 0 else "hyperboloid of two sheets"
            return _frame(kind, center, e1, e3, (a, b, c))
        case (2, 1):
            return _frame("cone", center, e1, e3, (a / c, b / c, 1.0))
        case (2, 0):
            return _frame("elliptic cylinder" if c0 else "line", center, e1, e3, (a, b, inf) if c0 else (0.0, 0.0, inf))
        case (1, 1) if c0:
            return _frame("hyperbolic cylinder", center, e1, e3, (a, b, inf))
        case (1, 1):
            if a < b:
                e1, a, b = vectors[:, order[1]], b, a
            return _frame("intersecting planes", center, e1, e3, (1.0, b / a, inf))
        case _:
            return _frame("parallel planes" if c0 else "coincident planes", center, e1, e3, (a if c0 else 0.0, inf, inf))


def _frame(kind: str, center: Array, e1: Array, e3: Array, radii: tuple[float, float, float]) -> Classification:
    """A right-handed frame from e1 and e3; a direction that could as well be reversed has its largest component positive."""
    if kind not in ("elliptic paraboloid", "hyperbolic paraboloid", "parabolic cylinder"):
        e3 = _upward(e3)
    e1 = _upward(e1)
    axes = np.stack([e1, np.cross(e3, e1), e3])
    return Classification(kind, center + 0.0, axes + 0.0, np.array(radii))


def _upward(direction: Array) -> Array:
    return direction * np.sign(direction[np.argmax(np.abs(direction).round(9))])
