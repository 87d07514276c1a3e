"""``view``: a picture of anything that can be called with u and w."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.errors import GeometryError
from directrix.plot import palette, traces
from directrix.plot.assembling import figure_of
from directrix.plot.beside import Knots, closed_axes, further_curves, further_surfaces, knot_lines, knots_of, measured, net_of
from directrix.plot.comparing import FARTHER, LINES, comparison, edges_and_lines, letters
from directrix.plot.sampling import Array, count_parameters, grid_normals, sample, sample_enough, size_of
from directrix.plot.scene import Box, coloured, layout, legend, scene, short, word
from directrix.plot.square import parameter_square

if TYPE_CHECKING:
    from plotly.graph_objects import Figure

MOST = 121
CURVE = 65
SURFACE, FACE = (33, 65), (17, 33)  # the fewest with which it looks round; eighths and quarters fall on samples
COMPARED = 33, 49  # usually, at most
HEIGHT = 460
NORMALS = 9  # needles each way
COLOURS = ("gaussian", "mean")


def view(
    f: Callable[..., Any],
    *,
    against: Callable[..., Any] | None = None,
    net: ArrayLike | bool | None = None,
    normals: bool = False,
    knots: Sequence[ArrayLike] | bool | None = None,
    colour: str | None = None,
    square: bool = False,
    mark: Sequence[float] | None = None,
    curves: Mapping[str, Callable[..., Any] | ArrayLike] | None = None,
    also: Sequence[Callable[..., Any]] = (),
    points: ArrayLike | None = None,
    deviations: ArrayLike | None = None,
    title: str | None = None,
    names: tuple[str, str] = ("reference", "yours"),
    samples: int | None = None,
    lines: int = LINES,
    height: int | None = None,
) -> Figure:
    """A 3-D picture of a surface, a curve or a solid: any callable f(u, w), f(u) or f(u, v, w) with parameters in [0, 1].

    The lines of a surface are its parameter lines, blue where u runs and orange where w runs, every eighth of the range; the
    dot is u = w = 0, and the letters stand on the edges where u and w grow from there. Hovering tells (u, w) and the point.

    Parameters
    ----------
    f : callable
        Called with arrays, u of shape (n, 1) and w of shape (1, m); returns points (n, m, 3). For a curve u (n,) and
        points (n, 3). A solid is drawn as its six faces.
    against : callable, optional
        The reference of a comparison. Two scenes on the same axes, whose cameras turn together: ``against`` on the left, f
        coloured by its deviation on the right, divided by the size (the diagonal of the reference's box); the largest is
        marked in both.
    net : (m, n, 3) or (m, 3), or True, optional
        A control net or polygon, drawn with its points P[i, j]; True: the form's own.
    normals : bool
        Needles along the unit normals: ``f.normal(u, w)`` where f has it, differences of the samples otherwise.
    knots : (values of u, values of w), or True, optional
        Parameters in [0, 1] whose lines are drawn thick and light blue; True: the form's own knots.
    colour : {"gaussian", "mean"}, optional
        Colours the surface by ``f.curvature(u, w)``.
    square : bool
        The parameter square beside the surface, its lines in the same colours.
    mark : (u, w), optional
        A place that is marked on the surface and in the square.
    curves : mapping of name to callable or points, optional
        Further curves in the same scene: c(t) for t in [0, 1], or points (n, 3).
    also : surfaces, optional
        Further surfaces in the same scene, such as the other sheet of a hyperboloid.
    points : (n, 3), optional
        Measured points.
    deviations : (n,), optional
        Their signed deviations, which colour them: blue below, orange above.
    title : str, optional
        A line above the picture.
    names : (str, str)
        What the two scenes of a comparison are called, left and right.
    samples : int, optional
        Samples each way, 2 to 121. By default as few as a surface needs to look round, 33 or 65, on the faces of a solid 17
        or 33; a comparison has 33 (49 at most), a curve 257.
    lines : int
        Parts into which the parameter lines divide each range; 1 draws the edges only.
    height : int, optional
        Height in pixels.

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    GeometryError
        Where f, or something beside it, cannot be drawn; the message says what to change.

    Examples
    --------
    >>> def saddle(u, w):
    ...     return np.stack(np.broadcast_arrays(u, w, u * w), axis=-1)
    >>> figure = view(saddle, title="z = xy")
    >>> figure.data[0].type, figure.layout.title.text
    ('surface', 'z = xy')
    """
    if samples is not None and not 2 <= samples <= MOST:
        raise GeometryError(f"samples must be from 2 to {MOST}; got {samples}. More would only make the notebook heavy.")
    count = count_parameters(f)
    if against is not None:
        built = _against(f, against, count, names, title, samples)
    elif count == 1:
        built = _curve(f, title, samples or CURVE, mark)
    elif count == 3:
        built = _solid(f, title, samples)
    else:
        built = _surface(
            f, title, samples, lines, colour=colour, normals=normals, square=square, mark=mark, knots=knots_of(f, knots)
        )
    polygon = net_of(f, net)
    closed = closed_axes(f) if net is True else []
    extra = further_surfaces(also, SURFACE if samples is None else (samples,)) + (
        [] if polygon is None else traces.net(polygon, closed)
    )
    extra += further_curves(curves or {}, samples or CURVE) + ([] if points is None else [measured(points, deviations)])
    if extra:
        built["data"] += extra
        if against is None:
            drawn = [np.stack([trace[axis] for axis in "xyz"], axis=-1) for trace in extra]
            box = Box.around(built.pop("points"), *drawn)
            domain = tuple(built["layout"]["scene"]["domain"]["x"])
            built["layout"]["scene"] = scene(box, domain, distance=FARTHER if domain[1] < 1 else 1.0)
            built["layout"]["annotations"][0]["text"] += _said(polygon, curves or {})
    built.pop("points", None)
    if height is not None:
        built["layout"]["height"] = height
    return _figure(built)


def _surface(
    f: Callable[..., Any], title: str | None, samples: int | None, lines: int, *,
    colour: str | None, normals: bool, knots: Knots | None, square: bool, mark: Sequence[float] | None,
) -> dict[str, Any]:  # fmt: skip
    counts = SURFACE if (SURFACE[0] - 1) % lines == 0 else SURFACE[-1:]  # on few samples such lines would stand unevenly
    at_u, at_w = knots or (np.empty(0), np.empty(0))
    u, w, (every,) = sample_enough(
        counts if samples is None else (samples,), lambda u, w: [sample(f, np.union1d(u, at_u), np.union1d(w, at_w))]
    )
    points = every if knots is None else every[np.ix_(np.isin(np.union1d(u, at_u), u), np.isin(np.union1d(w, at_w), w))]
    name = short(_name_of(f))
    rows, columns = edges_and_lines(len(u), lines), edges_and_lines(len(w), lines)
    built = [traces.surface(points, u, w, name=name) if colour is None else _curved(f, points, u, w, colour, name)]
    size = size_of(points)
    directions = grid_normals(points)
    drawn = [
        traces.parameter_lines(points, size, along="u", at=columns[1], width=1.5, normals=directions),
        traces.parameter_lines(points, size, along="w", at=rows[1], width=1.5, normals=directions),
        traces.parameter_lines(points, size, along="u", at=columns[0], width=5, normals=directions),
        traces.parameter_lines(points, size, along="w", at=rows[0], width=5, normals=directions),
    ]
    built += [trace for trace in drawn if len(trace["x"])] + letters(points, size, "scene", normals=directions)
    notes = [legend()]
    if knots is not None:
        built += knot_lines(every, u, w, knots)
        notes.append(coloured("━ knots", palette.KNOT))
    if normals:
        built[0]["opacity"] = 0.8  # a normal may point to the side that is turned away
        built.append(_needles(f, points, u, w))
        notes.append(coloured("━ normals", palette.NORMAL))
    if mark is not None:
        place = _place(mark, 2)
        label = f"(u, w) = ({place[0]:.3g}, {place[1]:.3g})"
        here = sample(f, place[:1], place[1:])[0]
        built.append(traces.marks(here, colour=palette.MARK, size=6, symbol="diamond", name=label))
        notes.append(coloured(f"◆ {label}", palette.MARK))
    holes = int(np.isnan(points).any(axis=-1).sum())
    alt = f"A 3-D picture of the surface {name} with its parameter lines."
    figure = layout(height=HEIGHT, title=title, alt=alt)
    if holes:
        said = f"{holes} of {len(u) * len(w)} points are not finite"
        notes.append(said)
        figure["meta"]["alt"] += f" {said}."
    domain = (0.0, 1.0)
    if square:
        domain = (0.0, 0.62)
        more, axes = parameter_square(rows[1], len(u), knots=knots, mark=mark, domain=(0.68, 0.98))
        built += more
        figure |= axes
    figure |= {
        "scene": scene(Box.around(points), domain, distance=FARTHER if square else 1.0),
        "annotations": [word("&nbsp;&nbsp;&nbsp;".join(notes), 0.5, -0.03, yanchor="top")],
    }
    return {"data": built, "layout": figure, "points": points}


def _curve(f: Callable[..., Any], title: str | None, samples: int, mark: Sequence[float] | None) -> dict[str, Any]:
    u = np.linspace(0.0, 1.0, min(4 * (samples - 1) + 1, 481))
    points = sample(f, u)
    name = short(_name_of(f))
    eighths = points[:: max((len(u) - 1) // 8, 1)]
    built = [
        traces.curve(points, u, colour=palette.U, name=name),
        traces.marks(eighths[1:], colour=palette.U, size=3, symbol="circle", name="every eighth of u"),
        traces.marks(points[:1], colour=palette.INK, size=5, symbol="circle", name="u = 0"),
    ]
    notes = [legend(("u",)), "large dot: u = 0, small dots: every eighth"]
    if mark is not None:
        place = _place(mark, 1)
        label = f"u = {place[0]:.3g}"
        built.append(traces.marks(sample(f, place), colour=palette.MARK, size=6, symbol="diamond", name=label))
        notes.append(coloured(f"◆ {label}", palette.MARK))
    figure = layout(height=HEIGHT, title=title, alt=f"A 3-D picture of the curve {name}, with dots at every eighth of u.")
    figure |= {
        "scene": scene(Box.around(points)),
        "annotations": [word("&nbsp;&nbsp;&nbsp;".join(notes), 0.5, -0.03, yanchor="top")],
    }
    return {"data": built, "layout": figure, "points": points}


def _solid(f: Callable[..., Any], title: str | None, samples: int | None) -> dict[str, Any]:
    """The six faces of f(u, v, w): on each, one parameter is 0 or 1 and the other two run."""
    colours = {"u": palette.U, "v": palette.NORMAL, "w": palette.W}
    named = [(f"{axis} = {end}", "uvw".replace(axis, "")) for axis in "uvw" for end in (0, 1)]
    counts = FACE if samples is None else (min(samples, FACE[-1]),)
    u, w, faces = sample_enough(counts, lambda u, w: _faces(f, max(u, w, key=len)))
    t = max(u, w, key=len)
    inner = edges_and_lines(len(t), 4)[1]
    built: list[dict[str, Any]] = []
    for (name, running), points in zip(named, faces, strict=True):
        built.append(traces.surface(points, t, t, name=name, letters=(running[0], running[1])))
        lift = traces.LIFT * size_of(points) * grid_normals(points)
        for side in (points + lift, points - lift):
            for letter, way in ((running[0], side.transpose(1, 0, 2)), (running[1], side)):
                built.append(traces.line([way[i] for i in inner], colour=colours[letter], width=1.5, name=name))
                built.append(traces.line([way[i] for i in (0, -1)], colour=colours[letter], width=4, name=name))
    every = np.concatenate([points.reshape(-1, 3) for points in faces])
    runs = [coloured(f"━ along {letter}", colour) for letter, colour in colours.items()]
    figure = layout(height=HEIGHT, title=title, alt=f"A 3-D picture of the solid {short(_name_of(f))}: its six faces.")
    figure |= {
        "scene": scene(Box.around(every)),
        "annotations": [word("&nbsp;&nbsp;&nbsp;".join(runs), 0.5, -0.03, yanchor="top")],
    }
    return {"data": built, "layout": figure, "points": every}


def _faces(f: Callable[..., Any], t: Array) -> list[Array]:
    """The faces u = 0, u = 1, v = 0 ... of a solid, sampled at t both ways, (n, n, 3) each."""
    faces: list[Array] = []
    for held in range(3):
        axes = [t, t, t]
        axes[held] = np.array([0.0, 1.0])
        faces += [*np.moveaxis(sample(f, *axes), held, 0)]
    return faces


def _against(
    f: Callable[..., Any], g: Callable[..., Any], count: int, names: tuple[str, str], title: str | None, samples: int | None
) -> dict[str, Any]:
    if count == 3:
        raise GeometryError("solids are compared face by face: view(face, against=other_face)")
    each = samples or CURVE if count == 1 else min(samples or COMPARED[0], COMPARED[1])
    axes = [np.linspace(0.0, 1.0, each)] * count
    return comparison(axes, sample(g, *axes), sample(f, *axes), names=names, title=title)


def _curved(f: Callable[..., Any], points: Array, u: Array, w: Array, colour: str, name: str) -> dict[str, Any]:
    if colour not in COLOURS:
        raise GeometryError(f"colour must be one of {', '.join(map(repr, COLOURS))}; got {colour!r}")
    curvature = getattr(f, "curvature", None)
    if curvature is None:
        raise GeometryError(f"colour={colour!r} needs a surface that has .curvature(u, w); {name} has none")
    values = np.broadcast_to(np.asarray(getattr(curvature(u[:, None], w[None, :]), colour), dtype=float), points.shape[:2])
    values = np.where(np.isfinite(values), values, np.nan)
    # A few extreme values, at an apex say, must not wash out all others: the bar ends at the 2nd and 98th percentile.
    finite = np.abs(values[np.isfinite(values)])
    top = float(np.percentile(finite, 98)) if finite.size else 1.0
    bar = {
        "title": {"text": f"{colour}<br>curvature", "font": {"size": 12}}, "thickness": 12, "len": 0.78, "x": 0.93,
        "outlinewidth": 0, "tickfont": {"size": 11}, "nticks": 6, "tickformat": ".3~g",
    }  # fmt: skip
    limits = (-top, top) if top > 0 else (-1.0, 1.0)
    return traces.surface(
        points, u, w, colour=values, bar=bar, scale=palette.SIGNED, limits=limits, says=f"{colour} curvature", name=name
    )


def _needles(f: Callable[..., Any], points: Array, u: Array, w: Array) -> dict[str, Any]:
    i, j = (np.unique(np.linspace(0, len(t) - 1, min(NORMALS, len(t))).round().astype(int)) for t in (u, w))
    own = getattr(f, "normal", None)
    if own is None:
        directions = grid_normals(points)[np.ix_(i, j)]
    else:
        directions = np.broadcast_to(np.asarray(own(u[i][:, None], w[j][None, :]), dtype=float), (len(i), len(j), 3))
    return traces.normals(points[np.ix_(i, j)], directions, 0.09 * size_of(points))


def _said(net: Array | None, curves: Mapping[str, Any]) -> str:
    """What the line below says of a net and of named curves."""
    words = []
    if net is not None:
        words.append(coloured("━ polygon" if net.ndim == 2 else "━ net", palette.NET))
    if curves:
        words.append(coloured(f"━ {short(', '.join(curves))}", palette.CURVE))
    return "".join(f"&nbsp;&nbsp;&nbsp;{one}" for one in words)


def _place(mark: Sequence[float], count: int) -> Array:
    place = np.atleast_1d(checks.real("mark", mark))
    if place.shape != (count,) or not ((place >= 0) & (place <= 1)).all():
        wanted = "(u, w)" if count == 2 else "u"
        raise GeometryError(f"mark must be {wanted} in [0, 1]; got {mark!r}")
    return place


def _name_of(f: Callable[..., Any]) -> str:
    name = getattr(f, "__name__", type(f).__name__)
    return "f" if name == "<lambda>" else str(name)


def _figure(built: dict[str, Any]) -> Figure:
    import plotly.io as pio

    # The notebook renderer takes its configuration from here; without it plotly.js offers to upload the figure.
    renderer = pio.renderers["plotly_mimetype"]
    renderer.config = {**(renderer.config or {}), **palette.CONFIG}
    # Built from parts that the tests hold valid: checking each again takes as long as all of the drawing.
    return figure_of(built["data"], built["layout"])
