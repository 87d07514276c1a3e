"""The letters of a surface: where on its edges u and w are written, so that they are seen and stand apart."""

from __future__ import annotations

from typing import Any

import numpy as np

from directrix.plot import palette, traces
from directrix.plot.sampling import Array, bounds, grid_normals
from directrix.plot.scene import CORNER

TOWARDS = np.array(CORNER) / np.linalg.norm(CORNER)  # the reader, before the figure is turned


def letters(
    points: Array, size: float, where: str, labels: tuple[str, str] = ("u", "w"), normals: Array | None = None
) -> list[dict[str, Any]]:
    """A dot where u = w = 0, and each letter on its edge from there, where it is seen best.

    Where an edge is no more than a point, as at a pole, its letter stands on the line through the middle.
    """
    start = points[:1, 0]
    placed = []
    if np.isfinite(points).any():
        places = _seen(points, size)
        ends = np.stack([points[place] for place in places])
        # Moved off the surface, to the side that is seen at first, and over the edge, or it would hide them; beside a closed
        # edge to the inner side, since the outer one is the end of the box.
        normals = grid_normals(points) if normals is None else normals
        off = np.stack([normals[place] for place in places])
        off = off * np.where(off @ TOWARDS < 0, -1.0, 1.0)[:, None]
        (i, on_u), (on_w, j) = places
        over = ends - np.stack([points[i, on_u + 1], points[on_w + 1, j]])
        over *= [[-1.0 if _closed(line) else 1.0] for line in (points[:, on_u], points[on_w])]
        long = np.linalg.norm(over, axis=1, keepdims=True)
        ends = ends + 0.03 * size * (off + over / np.where(long > 0, long, 1.0))
        if np.isfinite(ends).all():
            placed.append(traces.words(ends, labels, (palette.U, palette.W), scene=where))
    if np.isfinite(start).all():
        name = f"{labels[0]} = {labels[1]} = 0"
        placed.append(traces.marks(start, colour=palette.INK, size=4, symbol="circle", name=name, scene=where))
    return placed


def _closed(line: Array) -> bool:
    return bool((np.abs(line[0] - line[-1]) <= 1e-8 + 1e-5 * np.abs(line[-1])).all())


def _seen(points: Array, size: float) -> tuple[tuple[int, int], tuple[int, int]]:
    """An eighth to a half along each edge from u = w = 0, or anywhere on a closed one: near to the reader, and apart.

    The place of u first, on the line w = 0, then that of w, on u = 0; on the middle line where that edge is a point.
    """
    low, high = bounds(points)
    n, m = points.shape[:2]
    on_u, on_w = (
        middle if float(np.ptp(edge, axis=0).max()) < 0.02 * size else 0
        for edge, middle in ((points[:, 0], (m - 1) // 2), (points[0], (n - 1) // 2))
    )
    along_u, along_w = (
        [(len(line) * part) // 8 for part in ((2, 1, 3, 4, 5, 6, 7) if _closed(line) else (2, 1, 3, 4))]
        for line in (points[:, on_u], points[on_w])
    )
    a, b = (((places - (low + high) / 2) / size) for places in (points[along_u, on_u], points[on_w, along_w]))
    between = a[:, None] - b[None, :]  # each place of u against each of w
    apart = between - (between @ TOWARDS)[..., None] * TOWARDS
    worth = (a @ TOWARDS)[:, None] + (b @ TOWARDS)[None, :] + 4 * np.minimum(np.sqrt((apart * apart).sum(axis=-1)), 0.2)
    i, j = divmod(int(np.where(np.isfinite(worth), worth, -np.inf).argmax()), len(along_w))
    return (along_u[i], on_u), (on_w, along_w[j])
