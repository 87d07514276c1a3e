"""How smoothly two curves, or two patches, go over into one another."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from directrix.checks import Array
from directrix.curves.curve import Curve
from directrix.differential import cross, dot, norm
from directrix.errors import GeometryError, OrderError
from directrix.surfaces.surface import Surface

SAMPLES = np.linspace(0.0, 1.0, 33)
GAP = 1e-9  # of the size of both: edges this close are one
SMOOTH = 1e-7  # relative difference of derivatives, or sine of the angle between tangent planes, that counts as none
EDGES = ("u=0", "u=1", "w=0", "w=1")
ENDS = ("u=0", "u=1")


class Join(NamedTuple):
    """What ``join`` found.

    Attributes
    ----------
    continuity : 'none', 'C0' (they meet), 'G1' (one tangent line or plane), 'C1' (equal derivatives across), 'C2' (the second
        derivatives too)
    edge_a, edge_b : the ends or edges that meet: 'u=0', 'u=1', 'w=0', 'w=1'
    reverse : whether the parameters run against each other along the edge
    gap : largest distance along the edge, in the unit of length
    """

    continuity: str
    edge_a: str
    edge_b: str
    reverse: bool
    gap: float


def join(a: Any, b: Any) -> Join:
    """The order of continuity between two curves, or two patches, at the ends or edges that lie nearest to each other.

    Where edges of both meet in a pole, and other edges meet too, those count. C0: the edges are the same, point for point, to
    1e-9 of the size of both. G1: besides, the tangent planes agree along the
    edge and b goes on where a leaves off. C1, C2: the first (and second) derivatives across the edge are equal as well, with a
    and b run through at the speed of their own parameters (Farin, Curves and Surfaces for CAGD, 5th ed., on continuity).

    Parameters
    ----------
    a, b : two curves, or two surfaces, of the library

    Raises
    ------
    GeometryError
        If they are not two curves or two surfaces.

    Examples
    --------
    >>> from directrix.curves.line import Line
    >>> join(Line((0, 0, 0), (1, 0, 0)), Line((1, 0, 0), (3, 0, 0))).continuity
    'G1'
    """
    edges: tuple[str, ...]
    end: Any
    if isinstance(a, Curve) and isinstance(b, Curve):
        edges, end = ENDS, _end_of_curve
    elif isinstance(a, Surface) and isinstance(b, Surface):
        edges, end = EDGES, _edge_of_surface
    else:
        raise GeometryError(f"join needs two curves or two surfaces; got {type(a).__name__} and {type(b).__name__}.")
    size = _size(a, edges, end) + _size(b, edges, end)
    pairs = []
    for edge_a in edges:
        for edge_b in edges:
            for reverse in (False, True) if edges is EDGES else (False,):
                there = end(b, edge_b, 0)[::-1] if reverse else end(b, edge_b, 0)
                pairs.append((float(norm(end(a, edge_a, 0) - there).max()), edge_a, edge_b, reverse))
    points = {edge for edge in edges if norm(end(a, edge, 0) - end(a, edge, 0)[0]).max() <= GAP * size}

    def rank(pair: tuple[float, str, str, bool]) -> tuple[bool, float, bool]:
        """Edges that meet before others; of these, edges before what has shrunk to a point, as at a pole."""
        apart = pair[0] > GAP * size
        return apart, pair[0] if apart else 0.0, pair[1] in points

    gap, edge_a, edge_b, reverse = min(pairs, key=rank)
    if gap > GAP * size:
        return Join("none", edge_a, edge_b, reverse, gap)

    def across(which: Any, edge: str, n: int) -> Array:
        """The n-th derivative going from a through the edge into b."""
        forward = edge.endswith("1") if which is a else edge.endswith("0")
        value: Array = end(which, edge, n) * (1.0 if forward else -1.0) ** n
        return value[::-1] if which is b and reverse else value

    return Join(_smoothness(a, b, edge_a, edge_b, across, end), edge_a, edge_b, reverse, gap)


def _smoothness(a: Any, b: Any, edge_a: str, edge_b: str, across: Any, end: Any) -> str:
    leaving, entering = across(a, edge_a, 1), across(b, edge_b, 1)
    if not _equal(leaving, entering):
        along = _along(a, edge_a) if end is _edge_of_surface else None
        return "G1" if _tangent(leaving, entering, along) else "C0"
    try:
        return "C2" if _equal(across(a, edge_a, 2), across(b, edge_b, 2)) else "C1"
    except OrderError:
        return "C1"


def _equal(a: Array, b: Array) -> bool:
    return bool(norm(a - b).max() <= SMOOTH * max(norm(a).max(), norm(b).max(), np.finfo(np.float64).tiny))


def _tangent(leaving: Array, entering: Array, along: Array | None) -> bool:
    """Whether b goes on in a's tangent line or plane: what is across the edge has one direction on both sides."""
    if along is not None:
        fast = norm(along) > 0
        along = along / np.where(fast, norm(along), 1.0)[..., None]
        leaving, entering = (v - dot(v, along)[..., None] * along for v in (leaving, entering))
    lengths = norm(leaving) * norm(entering)
    return bool((norm(cross(leaving, entering)) <= SMOOTH * lengths).all() and (dot(leaving, entering) >= 0).all())


def _size(form: Any, edges: tuple[str, ...], end: Any) -> float:
    return float(np.ptp(np.concatenate([end(form, edge, 0) for edge in edges]), axis=0).max())


def _end_of_curve(curve: Curve, edge: str, n: int) -> Array:
    return curve.derivative([float(edge[-1])], n)


def _edge_of_surface(surface: Surface, edge: str, n: int) -> Array:
    """The n-th derivative across an edge, in the sense of the growing parameter, at 33 places of the edge."""
    fixed = float(edge[-1])
    return surface.derivative(fixed, SAMPLES, n, 0) if edge[0] == "u" else surface.derivative(SAMPLES, fixed, 0, n)


def _along(surface: Surface, edge: str) -> Array:
    fixed = float(edge[-1])
    return surface.derivative(fixed, SAMPLES, 0, 1) if edge[0] == "u" else surface.derivative(SAMPLES, fixed, 1, 0)
