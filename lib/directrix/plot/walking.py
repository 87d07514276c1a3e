"""``walk``: a marker that moves in the parameter square and on the surface at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.errors import GeometryError, ShapeError
from directrix.plot import palette
from directrix.plot.sampling import Array
from directrix.plot.scene import legend
from directrix.plot.viewing import view

if TYPE_CHECKING:
    from plotly.graph_objects import Figure

STEPS = 25
MOST = 121
TRAIL = 97  # points of the path that is drawn behind the marker


def walk(
    f: Callable[..., Any],
    path: Callable[[Array], ArrayLike] | ArrayLike,
    *,
    steps: int = STEPS,
    title: str | None = None,
    height: int = 520,
) -> Figure:
    """A picture of the surface f(u, w) beside its parameter square, with one marker that walks a path in both.

    A slider moves the marker, and a button plays the walk; the whole way is drawn in both places. The frames hold the marker
    only, so that a walk is hardly larger than the picture itself.

    Parameters
    ----------
    f : callable
        As in :func:`directrix.plot.view`.
    path : callable or (n, 2)
        Places (u, w): a function of t, shape (n,) in [0, 1] to (n, 2), or the corners of a polygon that is walked evenly.
    steps : int
        Places of the slider, 2 to 121.
    title, height
        As in :func:`directrix.plot.view`.

    Raises
    ------
    ShapeError
        If the path does not give places (u, w).
    GeometryError
        If it leaves the unit square, or f cannot be drawn.

    Examples
    --------
    >>> def saddle(u, w):
    ...     return np.stack(np.broadcast_arrays(u, w, u * w), axis=-1)
    >>> len(walk(saddle, [(0, 0), (1, 1)], steps=5).frames)
    5
    """
    if not 2 <= steps <= MOST:
        raise GeometryError(f"steps must be from 2 to {MOST}; got {steps}")
    places = _places(path, np.linspace(0.0, 1.0, steps))
    trail = _places(path, np.linspace(0.0, 1.0, TRAIL))
    points, way = _on(f, places), _on(f, trail)
    figure = view(f, square=True, mark=places[0], curves={"the way": way}, title=title, height=height)
    figure.add_scatter(
        x=trail[:, 0],
        y=trail[:, 1],
        mode="lines",
        line={"color": palette.CURVE, "width": 3},
        hoverinfo="skip",
        showlegend=False,
    )
    figure.data = (figure.data[-1], *figure.data[:-1])  # the way lies under the marker
    marks = [i for i, trace in enumerate(figure.data) if getattr(trace, "marker", None) and trace.marker.symbol == "diamond"]
    figure.layout.annotations[0].text = legend()  # without the place of the marker, which the slider tells
    frames, entries = [], []
    for number, (place, point) in enumerate(zip(places, points, strict=True)):
        data = [
            {"type": "scatter3d", **{axis: [float(value)] for axis, value in zip("xyz", point, strict=True)}},
            {"type": "scatter", "x": [float(place[0])], "y": [float(place[1])]},
        ]
        frames.append({"name": str(number), "data": data, "traces": marks})
        entries.append({"label": f"({place[0]:.2f}, {place[1]:.2f})", "method": "animate", "args": [[str(number)], _at_once()]})
    figure.frames = frames
    figure.update_layout(sliders=[_slider(entries)], updatemenus=[_play()], margin={"b": 96})
    figure.layout.meta["alt"] += " A marker walks along a path, in the parameter square and on the surface; a slider moves it."
    return figure


def _on(f: Callable[..., Any], places: Array) -> Array:
    if not callable(f):
        raise GeometryError(f"a picture is drawn of a surface or a function f(u, w); got {type(f).__name__}")
    points = checks.real("f(u, w)", f(places[:, 0], places[:, 1]))
    if points.shape != (len(places), 3):
        raise ShapeError(
            f"for u and w of shape ({len(places)},) the points must have shape ({len(places)}, 3); got {points.shape}",
            got=points.shape,
        )
    return points


def _places(path: Callable[[Array], ArrayLike] | ArrayLike, t: Array) -> Array:
    if callable(path):
        places = checks.real("path(t)", path(t))
        if places.shape != (len(t), 2):
            raise ShapeError(f"path(t) must give places (u, w), shape ({len(t)}, 2); got {places.shape}", got=places.shape)
    else:
        places = _along(checks.real("path", path), t)
    if not ((places >= -1e-12) & (places <= 1 + 1e-12)).all():
        raise GeometryError("the path must stay in the unit square: u and w from 0 to 1")
    return np.clip(places, 0.0, 1.0)


def _along(corners: Array, t: Array) -> Array:
    """Places on the polygon, its length in the square shared out evenly."""
    if corners.ndim != 2 or corners.shape[1:] != (2,) or len(corners) < 2:
        raise ShapeError(
            f"a path is a function of t or at least two corners (u, w); got shape {corners.shape}", got=corners.shape
        )
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))])
    if length[-1] == 0:
        raise GeometryError("a path must lead somewhere: all its corners are the same place")
    return np.stack([np.interp(t * length[-1], length, corners[:, i]) for i in (0, 1)], axis=-1)


def _at_once(duration: int = 0) -> dict[str, Any]:
    return {"mode": "immediate", "frame": {"duration": duration, "redraw": True}, "transition": {"duration": 0}}


def _slider(steps: Sequence[dict[str, Any]]) -> dict[str, Any]:
    return {
        "steps": list(steps), "active": 0, "x": 0.12, "len": 0.86, "y": 0.0, "yanchor": "top", "pad": {"t": 30, "b": 0},
        "currentvalue": {"prefix": "(u, w) = ", "font": {"size": 13, "color": palette.MARK}, "offset": 8},
        "font": {"size": 1, "color": palette.CLEAR}, "tickcolor": palette.CLEAR, "bordercolor": palette.GRID,
    }  # fmt: skip


def _play() -> dict[str, Any]:
    button = {"label": "▶ walk", "method": "animate", "args": [None, {**_at_once(80), "fromcurrent": True}]}
    return {
        "type": "buttons", "buttons": [button], "showactive": False, "x": 0.0, "y": 0.0, "xanchor": "left", "yanchor": "top",
        "pad": {"t": 46, "l": 4}, "bgcolor": palette.CLEAR, "bordercolor": palette.GRID, "font": {"size": 12},
    }  # fmt: skip
