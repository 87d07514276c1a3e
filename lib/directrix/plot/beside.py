"""What stands beside a surface in its picture: its net, its knot lines, further forms, measured points."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.errors import GeometryError, ShapeError
from directrix.plot import palette, traces
from directrix.plot.comparing import LINES, edges_and_lines
from directrix.plot.sampling import Array, count_parameters, grid_normals, sample, sample_enough, size_of
from directrix.plot.scene import short

NETS = ("control_net", "control_points", "points")
Knots = tuple[Array, Array]


def net_of(f: Callable[..., Any], net: ArrayLike | bool | None) -> Array | None:
    """The net to draw: the one given, or for True the form's own."""
    if net is None or net is False:
        return None
    if net is True:
        found = next((getattr(f, name) for name in NETS if hasattr(f, name)), None)
        if found is None:
            raise GeometryError(f"net=True draws the control points of the form; {type(f).__name__} has none. Give the points.")
        net = found
    points = checks.real("net", net)
    if points.ndim not in (2, 3, 4) or points.shape[-1] != 3 or not points.size:
        raise ShapeError(f"net must have shape (m, n, 3), or (m, 3) for a polygon; got {points.shape}", got=points.shape)
    return points


def closed_axes(f: Callable[..., Any]) -> list[bool]:
    """Along which axes of its net a form uses the first control points again: where its knots are periodic."""
    one, two, three = getattr(f, "knot_vector", None), getattr(f, "knot_vector_u", None), getattr(f, "knot_vectors", None)
    vectors = [one] if one is not None else [two, getattr(f, "knot_vector_w", None)] if two is not None else three or []
    return [bool(getattr(vector, "wrap", 0)) for vector in vectors]


def knots_of(f: Callable[..., Any], knots: Sequence[ArrayLike] | bool | None) -> Knots | None:
    """Where knot lines are to be drawn, values of u and of w: those given, or for True the form's own between 0 and 1."""
    if knots is None or knots is False:
        return None
    if knots is True:
        breaks = getattr(f, "breaks", None)
        if breaks is None:
            raise GeometryError(
                f"knots=True draws the knots of the form; {type(f).__name__} has none. Give values of u and of w."
            )
        knots = [values[(values > 0) & (values < 1)] for values in breaks()]
    if len(knots) != 2:
        raise ShapeError(f"knots must be two lists, values of u and values of w; got {len(knots)}")
    at_u, at_w = (np.unique(checks.real("knots", values)) for values in knots)
    for values in (at_u, at_w):
        if not ((values >= 0) & (values <= 1)).all():
            raise GeometryError("knots must be given as parameters in [0, 1]; stretch them onto it first")
    return at_u, at_w


def knot_lines(points: Array, u: Array, w: Array, knots: Knots) -> list[dict[str, Any]]:
    """The lines u = knot and w = knot of a surface whose points are given at u, w and the knots; lifted off it as all lines."""
    at_u, at_w = knots
    u, w = np.union1d(u, at_u), np.union1d(w, at_w)
    lift = 1.5 * traces.LIFT * size_of(points) * grid_normals(points)
    across = [
        line
        for side in (points + lift, points - lift)
        for line in (*side[np.searchsorted(u, at_u)], *side[:, np.searchsorted(w, at_w)].transpose(1, 0, 2))
    ]
    return [traces.line(across, colour=palette.KNOT, width=6, name="knots")] if across else []


def further_surfaces(also: Sequence[Callable[..., Any]], counts: Sequence[int]) -> list[dict[str, Any]]:
    """More surfaces in the same scene, with their parameter lines; for ``counts`` see :func:`sample_enough`."""
    drawn = []
    for f in also:
        if count_parameters(f) != 2:
            raise GeometryError("also takes further surfaces f(u, w); for curves and points there is curves={name: curve}")
        u, w, (points,) = sample_enough(counts, lambda u, w, f=f: [sample(f, u, w)])  # type: ignore[misc]
        size = size_of(points)
        drawn.append(traces.surface(points, u, w, name=short(type(f).__name__)))
        rows, columns = edges_and_lines(len(u), LINES), edges_and_lines(len(w), LINES)
        for which, width in ((1, 1.5), (0, 5)):
            drawn.append(traces.parameter_lines(points, size, along="u", at=columns[which], width=width))
            drawn.append(traces.parameter_lines(points, size, along="w", at=rows[which], width=width))
    return drawn


def further_curves(curves: Mapping[str, Any], samples: int) -> list[dict[str, Any]]:
    """Curves c(t), polylines (n, 3) and single points, each under its name."""
    drawn: list[dict[str, Any]] = []
    t = np.linspace(0.0, 1.0, samples)
    for name, one in curves.items():
        if callable(one):
            drawn.append(traces.curve(sample(one, t), t, colour=palette.CURVE, name=short(name)))
            continue
        points = checks.real(f"curve {name!r}", one)
        if points.shape[-1:] != (3,):
            raise ShapeError(
                f"curve {name!r} must be points, shape (n, 3), or a function; got {points.shape}", got=points.shape
            )
        points = points.reshape(-1, 3)
        if len(points) == 1:
            drawn.append(
                traces.marks(points, colour=palette.CURVE, size=5, symbol="circle", name=short(name), text=[short(name)])
            )
        else:
            drawn.append(traces.curve(points, np.linspace(0, 1, len(points)), colour=palette.CURVE, name=short(name)))
    return drawn


def measured(points: ArrayLike, deviations: ArrayLike | None) -> dict[str, Any]:
    """Measured points (n, 3) as dots, coloured by their signed deviations (n,) where those are given."""
    places = checks.real("points", points)
    if places.ndim != 2 or places.shape[-1] != 3:
        raise ShapeError(f"points must have shape (n, 3); got {places.shape}", got=places.shape)
    drawn = traces.marks(places, colour=palette.INK, size=3.5, symbol="circle", name="measured")
    if deviations is None:
        return drawn
    off = checks.real("deviations", deviations)
    if off.shape != places.shape[:1]:
        raise ShapeError(f"deviations must have shape ({len(places)},), one a point; got {off.shape}", got=off.shape)
    top = float(np.abs(off[np.isfinite(off)]).max(initial=0.0)) or 1.0
    drawn["marker"] |= {
        "color": off.astype(np.float32), "cmin": -top, "cmax": top, "colorscale": palette.scale(palette.SIGNED),
        "line": {"color": palette.INK, "width": 1}, "showscale": True,
        "colorbar": {
            "title": {"text": "off by", "font": {"size": 12}}, "thickness": 12, "len": 0.78, "x": 0.93, "outlinewidth": 0,
            "tickfont": {"size": 11}, "nticks": 6, "tickformat": ".3~g",
        },
    }  # fmt: skip
    drawn["customdata"] = off.astype(np.float32)[:, None]
    drawn["hovertemplate"] = f"<b>off by %{{customdata[0]:.3~g}}</b><br>{traces.POINT}<extra></extra>"
    return drawn
