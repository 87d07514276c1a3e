"""The pieces of a picture as plain plotly dicts: surfaces, parameter lines, nets, normals, marks.

Lines of one kind are one ``scatter3d`` trace with NaN between them. They are lifted off the surface by 0.15 % of its size on
both sides, or the surface would swallow them here and there.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from directrix.plot import palette
from directrix.plot.sampling import Array, grid_normals

Trace = dict[str, Any]
LIFT = 0.0015
POINT = "(x, y, z) = (%{x:.4~g}, %{y:.4~g}, %{z:.4~g})"


def surface(
    points: Array,
    u: Array,
    w: Array,
    *,
    colour: Array | None = None,
    bar: dict[str, Any] | None = None,
    scale: Sequence[str] = palette.CIVIDIS,
    limits: tuple[float, float] = (0.0, 1.0),
    says: str = "",
    lighting: dict[str, float] | None = None,
    scene: str = "scene",
    name: str = "surface",
    letters: tuple[str, str] = ("u", "w"),
) -> Trace:
    """A surface (n, m, 3) over u (n,) and w (m,), with its parameters on hover.

    ``colour`` (n, m) colours it on ``scale`` between ``limits`` and is shown on hover after the words ``says``; without it
    the surface is plain.

    plotly.js reads ``customdata`` of a surface with rows and columns exchanged (plotly.js #5003), so it is handed over
    transposed. A browser test reads it back.
    """
    U, W = np.meshgrid(u, w, indexing="ij")
    shown = [U, W] if colour is None else [U, W, colour]
    hover = f"<b>{letters[0]} = %{{customdata[0]:.3~f}}, {letters[1]} = %{{customdata[1]:.3~f}}</b><br>{POINT}"
    if colour is not None:
        hover += f"<br>{says} %{{customdata[2]:.3~g}}"
    trace: Trace = {
        "type": "surface",
        "name": name,
        "scene": scene,
        **dict(zip("xyz", _coordinates(points), strict=True)),
        "customdata": np.dstack(shown).transpose(1, 0, 2).astype(np.float32),
        "hovertemplate": hover + "<extra></extra>",
        "contours": {axis: {"highlight": False} for axis in "xyz"},
        "showscale": False,
    }
    if colour is None:
        trace |= {
            "surfacecolor": np.zeros(U.shape, np.float32), "cmin": 0.0, "cmax": 1.0,
            "colorscale": palette.constant(palette.PLAIN), "lighting": lighting or palette.SHADED,
            "lightposition": palette.LIGHT,
        }  # fmt: skip
    else:
        trace |= {
            "surfacecolor": colour.astype(np.float32), "cmin": limits[0], "cmax": limits[1],
            "colorscale": palette.scale(tuple(scale)), "lighting": lighting or palette.FLAT,
        }  # fmt: skip
        if bar is not None:
            trace |= {"showscale": True, "colorbar": bar}
    return trace


def parameter_lines(
    points: Array,
    size: float,
    *,
    along: str,
    at: Iterable[int],
    width: float = 2.0,
    normals: Array | None = None,
    **style: Any,
) -> Trace:
    """The curves of a sampled surface on which one parameter is held, in the colour of the one that runs.

    ``along="u"``: w is held at the columns ``at`` and u runs. ``along="w"``: u is held at the rows ``at`` and w runs.
    ``size`` is that of the picture, of which the lift is a share; ``normals`` are :func:`grid_normals` of the points, where
    they are known already.
    """
    normals = grid_normals(points) if normals is None else normals
    picked = sorted(set(at))
    on, away = (rows[:, picked].swapaxes(0, 1) if along == "u" else rows[picked] for rows in (points, normals))
    lift = LIFT * size * away
    return line(
        np.concatenate([on + lift, on - lift]),
        colour=palette.U if along == "u" else palette.W,
        width=width,
        name=f"along {along}",
        **style,
    )


def line(
    curves: Sequence[Array] | Array,
    *,
    colour: str,
    width: float = 3.0,
    name: str = "",
    scene: str = "scene",
    dash: str = "solid",
) -> Trace:
    """Any number of polylines (n, 3) as one trace."""
    return {
        "type": "scatter3d",
        "mode": "lines",
        "name": name,
        "scene": scene,
        **dict(zip("xyz", _coordinates(_joined(curves)), strict=True)),
        "line": {"color": colour, "width": width, "dash": dash},
        "hoverinfo": "skip",
        "showlegend": False,
    }


def curve(
    points: Array, u: Array, *, colour: str, name: str, scene: str = "scene", dash: str = "solid", width: float = 6
) -> Trace:
    """One curve (n, 3) with its parameter on hover."""
    trace = line([points], colour=colour, width=width, name=name, scene=scene, dash=dash)
    return trace | {
        "hoverinfo": "all",
        "customdata": np.asarray(u, np.float32)[:, None],
        "hovertemplate": f"<b>u = %{{customdata[0]:.3~f}}</b><br>{POINT}<extra></extra>",
    }


def net(points: Array, closed: Sequence[bool] = (), *, scene: str = "scene") -> list[Trace]:
    """A control net (m, n, 3), or (l, m, n, 3), or a polygon (m, 3): thin lines and dots that tell their index.

    ``closed`` says along which axes the last point is joined to the first, as periodic knots join them.
    """
    curves: list[Array] = []
    for axis in range(points.ndim - 1):
        lines = np.moveaxis(points, axis, -2).reshape(-1, points.shape[axis], 3)
        round_again = axis < len(closed) and closed[axis]
        curves += list(np.concatenate([lines, lines[:, :1]], axis=1) if round_again else lines)
    index = [f"P[{', '.join(map(str, at))}]" for at in np.ndindex(points.shape[:-1])]
    dots = marks(points.reshape(-1, 3), colour=palette.NET, size=3.5, symbol="circle", name="control points", scene=scene)
    dots |= {"text": index, "hoverinfo": "text", "hovertemplate": f"<b>%{{text}}</b><br>{POINT}<extra></extra>"}
    return [line(curves, colour=palette.NET, width=1.5, name="control net", scene=scene), dots]


def normals(points: Array, directions: Array, length: float, *, scene: str = "scene") -> Trace:
    """Normals as needles, all of them one trace."""
    start, way = points.reshape(-1, 3), directions.reshape(-1, 3)
    keep = np.linalg.norm(way, axis=1) > 0.5  # at a pole there may be none
    curves = [np.stack([p, p + length * n]) for p, n in zip(start[keep], way[keep], strict=True)]
    return line(curves, colour=palette.NORMAL, width=3, name="normals", scene=scene)


def marks(
    points: Array, *, colour: str, size: float, symbol: str, name: str, text: Sequence[str] | None = None, scene: str = "scene"
) -> Trace:
    """Dots at points (n, 3), each with a short text beside it where one is given."""
    trace: Trace = {
        "type": "scatter3d",
        "mode": "markers" if text is None else "markers+text",
        "name": name,
        "scene": scene,
        **dict(zip("xyz", _coordinates(np.reshape(points, (-1, 3))), strict=True)),
        "marker": {"color": colour, "size": size, "symbol": symbol, "line": {"color": colour, "width": 1}},
        "hovertemplate": f"{name}<br>{POINT}<extra></extra>",
        "showlegend": False,
    }
    if text is not None:
        trace |= {"text": list(text), "textposition": "top center", "textfont": {"color": colour, "size": 13}}
    return trace


def words(points: Array, text: Sequence[str], colours: Sequence[str], *, scene: str = "scene") -> Trace:
    """Words that stand at points."""
    return {
        "type": "scatter3d",
        "mode": "text",
        "scene": scene,
        **dict(zip("xyz", _coordinates(points), strict=True)),
        "text": list(text),
        "textfont": {"color": list(colours), "size": 15, "weight": "bold"},
        "hoverinfo": "skip",
        "showlegend": False,
    }


def _coordinates(points: Array) -> list[NDArray[np.float32]]:
    return [np.ascontiguousarray(points[..., axis], dtype=np.float32) for axis in range(3)]


def _joined(curves: Sequence[Array] | Array) -> Array:
    """Polylines one after the other, a row of NaN between them."""
    if isinstance(curves, np.ndarray):  # all of one length
        joined = np.full((len(curves), curves.shape[1] + 1, 3), np.nan)
        joined[:, :-1] = curves
        return joined.reshape(-1, 3)[:-1]
    gap = np.full((1, 3), np.nan)
    pieces = [piece for one in curves for piece in (one, gap)]
    return np.concatenate(pieces[:-1]) if pieces else np.empty((0, 3))
