"""Two samplings of one form against each other: the reference, and yours coloured by how far it is off.

Both are drawn on the same axes at the same scale, in two scenes whose cameras turn together (see figures.js); buttons turn both
where no script may run. The worst place carries the same mark in both.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.plot import palette, traces
from directrix.plot.lettering import letters as letters
from directrix.plot.sampling import LETTERS, Array, axes_of, deviation, grid_normals, points_on, size_of
from directrix.plot.scene import VIEWS, Box, camera, coloured, encode, layout, legend, scene, short, word
from directrix.plot.wording import WORDS, Words

HEIGHT = 430
ROUNDING = 1e-9  # relative deviations up to this are none
LINES = 8  # parameter lines each way, apart from the edges: every eighth of the range
FAR = 8.0  # a surface that runs further out than this many sizes of the reference leaves the picture
FARTHER = 1.14  # two narrow scenes want their cameras a little further away
DOMAINS = ((0.0, 0.455), (0.465, 0.92))
SIDES = {view: view.removeprefix("from ") for view in VIEWS if view.startswith("from ")}


def compare(
    parameters: Sequence[ArrayLike],
    expected: ArrayLike,
    yours: ArrayLike | None,
    *,
    worst: Sequence[float] | None = None,
    size: float | None = None,
    names: tuple[str, str] = ("reference", "yours"),
    title: str | None = None,
    same: bool = False,
    letters: Sequence[str] | None = None,
    words: Words = WORDS,
) -> dict[str, Any]:
    """A comparison figure of sampled curves or surfaces, as plain JSON (``data`` and ``layout``).

    Parameters
    ----------
    parameters : the values along each axis: [u (n,)] for a curve, [u (n,), w (m,)] for a surface
    expected : (n, 3) or (n, m, 3), the reference
    yours : the same shape, or None where there is nothing to compare: then the reference stands alone
    worst : the parameter place to mark; by default the sample that is furthest off
    size : what deviations are divided by; by default the diagonal of the reference's box
    names : what the two are called
    title : a line above
    same : True draws ``yours`` alone, since it is the reference
    letters : what the parameters are called where that is not u, or u and w: a layer of a solid runs along u and v
    words : what is read and heard there, with the keys of :data:`directrix.plot.wording.WORDS`

    Raises
    ------
    ShapeError
        If the arrays do not fit each other.

    Examples
    --------
    >>> t = np.linspace(0, 1, 5)
    >>> line = np.stack([t, 0 * t, 0 * t], axis=-1)
    >>> sorted(compare([t], line, line + (0, 0, 0.5)))
    ['data', 'layout']
    """
    built = comparison(
        parameters, expected, yours, worst=worst, size=size, names=names, title=title, same=same, letters=letters, words=words
    )
    plain: dict[str, Any] = encode(built)
    return plain


def comparison(
    parameters: Sequence[ArrayLike],
    expected: ArrayLike,
    yours: ArrayLike | None,
    *,
    worst: Sequence[float] | None = None,
    size: float | None = None,
    names: tuple[str, str] = ("reference", "yours"),
    title: str | None = None,
    same: bool = False,
    letters: Sequence[str] | None = None,
    words: Words = WORDS,
) -> dict[str, Any]:
    """:func:`compare` with its arrays still arrays."""
    axes = axes_of(parameters)
    called = tuple(letters) if letters is not None else LETTERS[len(axes)]
    right = points_on("expected", expected, axes)
    if yours is None or same:
        shown, name = (right, names[0]) if yours is None else (points_on("yours", yours, axes), names[1])
        return _alone(axes, shown, name, title, same, called, words)
    left = points_on("yours", yours, axes)
    off = deviation(right, left) / (size or size_of(right))
    place = _worst(axes, off, worst)
    left, far = _within_reach(right, left, words)
    draw = _two_curves if len(axes) == 1 else _two_scenes
    built = draw(axes, right, left, off, place, names, title, called, words)
    if far:
        built["layout"]["annotations"].append(word(far, sum(DOMAINS[1]) / 2 if len(axes) == 2 else 0.5, 0.93))
        built["layout"]["meta"]["alt"] += f" {far}."
    return built


def _two_scenes(
    axes: list[Array],
    right: Array,
    left: Array,
    off: Array,
    place: Array | None,
    names: tuple[str, str],
    title: str | None,
    called: tuple[str, ...],
    words: Words,
) -> dict[str, Any]:
    u, w = axes
    box = _box(right, left)
    top = min(float(np.nanmax(off)), FAR) if np.isfinite(off).any() else 0.0
    limits = (0.0, top if top > ROUNDING else 1.0)  # or rounding would be painted as a deviation
    bar = {
        "title": {"text": words["bar"], "font": {"size": 12}}, "thickness": 12, "len": 0.78, "x": 0.935,
        "xanchor": "left", "y": 0.5, "tickfont": {"size": 11}, "nticks": 6, "outlinewidth": 0, "tickformat": ".3~g",
    }  # fmt: skip
    data = [
        traces.surface(right, u, w, scene="scene", name=names[0], letters=(called[0], called[1])),
        traces.surface(
            left,
            u,
            w,
            colour=np.minimum(off, 1e6),
            bar=bar,
            limits=limits,
            says=words["off"],
            scene="scene2",
            name=names[1],
            letters=(called[0], called[1]),
        ),
    ]
    data += _lines(right, u, w, size_of(right), "scene", called) + _lines(left, u, w, size_of(right), "scene2", called)
    data += _marked(axes, right, left, place, "scene", "scene2", called, words)
    notes = [
        word(f"<b>{short(names[0])}</b>", sum(DOMAINS[0]) / 2, 1.0, size=14),
        word(words["coloured"].format(name=f"<b>{short(names[1])}</b>"), sum(DOMAINS[1]) / 2, 1.0, size=14),
        word(legend(called, extra=_largest(words) if place is not None else "", along=words["along"]), 0.99, -0.03,
             anchor="right", yanchor="top"),
    ]  # fmt: skip
    alt = f"{words['two_scenes'].format(first=names[0], second=names[1])} {_said(off, place, called, words)}"
    corner = box.corner(None if place is None else between(axes, right, place))
    figure = layout(height=HEIGHT, title=title, alt=alt, link=("scene", "scene2"))
    figure |= {
        "scene": scene(box, DOMAINS[0], distance=FARTHER, corner=corner),
        "scene2": scene(box, DOMAINS[1], distance=FARTHER, corner=corner),
        "annotations": notes,
        "updatemenus": [_views(("scene", "scene2"), corner, words)],
    }
    figure["margin"] |= {"t": 62 if title else 34}
    return {"data": data, "layout": figure}


def _two_curves(
    axes: list[Array],
    right: Array,
    left: Array,
    off: Array,
    place: Array | None,
    names: tuple[str, str],
    title: str | None,
    called: tuple[str, ...],
    words: Words,
) -> dict[str, Any]:
    box = _box(right, left)
    data = [
        traces.curve(right, axes[0], colour=palette.REFERENCE, name=names[0], width=8),
        traces.curve(left, axes[0], colour=palette.YOURS, name=names[1], width=5, dash="dash"),
        *_marked(axes, right, left, place, "scene", "scene", called, words),
    ]
    key = [
        coloured(f"━ {short(names[0])}", palette.REFERENCE),
        coloured(f"╍ {short(names[1])}", palette.YOURS),
        *([_largest(words)] if place is not None else []),
    ]
    alt = f"{words['two_curves'].format(first=names[0], second=names[1])} {_said(off, place, called, words)}"
    figure = layout(height=HEIGHT, title=title, alt=alt)
    figure |= {"scene": scene(box), "annotations": [word("&nbsp;&nbsp;&nbsp;".join(key), 0.5, -0.03, yanchor="top")]}
    return {"data": data, "layout": figure}


def _alone(
    axes: list[Array], points: Array, name: str, title: str | None, same: bool, called: tuple[str, ...], words: Words
) -> dict[str, Any]:
    alt = words["alone_right" if same else "alone"].format(name=name)
    figure = layout(height=HEIGHT, title=title, alt=alt)
    strong = f"<b>{short(name)}</b>"
    key = [words["right"].format(name=strong) if same else strong]
    if len(axes) == 1:
        data = [traces.curve(points, axes[0], colour=palette.U, name=name)]
    else:
        data = [
            traces.surface(points, *axes, name=name, letters=(called[0], called[1])),
            *_lines(points, axes[0], axes[1], size_of(points), "scene", called),
        ]
        key.append(legend(called, along=words["along"]))
    figure |= {
        "scene": scene(Box.around(points)),
        "annotations": [word("&nbsp;&nbsp;&nbsp;".join(key), 0.5, -0.03, yanchor="top")],
    }
    return {"data": data, "layout": figure}


def edges_and_lines(count: int, lines: int) -> tuple[list[int], list[int]]:
    """Indices of the two edges, and of about ``lines - 1`` samples evenly between them."""
    step = max((count - 1) / lines, 1.0)
    inner = sorted({round(i * step) for i in range(1, lines)} & set(range(1, count - 1)))
    return [0, count - 1], inner


def _lines(points: Array, u: Array, w: Array, size: float, where: str, called: tuple[str, ...]) -> list[dict[str, Any]]:
    """Parameter lines inside, the edges thicker, and the letters that say which way u and w run."""
    rows, columns = edges_and_lines(len(u), LINES), edges_and_lines(len(w), LINES)
    normals = grid_normals(points)
    drawn = [
        traces.parameter_lines(points, size, along="u", at=columns[1], width=1.5, normals=normals, scene=where),
        traces.parameter_lines(points, size, along="w", at=rows[1], width=1.5, normals=normals, scene=where),
        traces.parameter_lines(points, size, along="u", at=columns[0], width=3.5, normals=normals, scene=where),
        traces.parameter_lines(points, size, along="w", at=rows[0], width=3.5, normals=normals, scene=where),
    ]
    return [trace for trace in drawn if np.isfinite(trace["x"]).any()] + letters(
        points, size, where, (called[0], called[1]), normals
    )


def _marked(
    axes: list[Array],
    right: Array,
    left: Array,
    place: Array | None,
    first: str,
    second: str,
    called: tuple[str, ...],
    words: Words,
) -> list[dict[str, Any]]:
    """The worst place in both, and in yours a line to where it should be."""
    if place is None:
        return []
    there, here = between(axes, right, place), between(axes, left, place)
    label = f"{words['largest' if first != second else 'here']}, {_at(place, called)}"
    goal = f"{words['goal']}, {_at(place, called)}"
    drawn = [traces.marks(there, colour=palette.MARK, size=6, symbol="diamond", name=goal, scene=first)]
    if np.isfinite(here).all():
        drawn.append(traces.marks(here, colour=palette.MARK, size=6, symbol="diamond", name=label, scene=second))
        if first != second:
            drawn.append(traces.marks(there, colour=palette.MARK, size=6, symbol="diamond-open", name=goal, scene=second))
        drawn.append(traces.line([np.stack([here, there])], colour=palette.MARK, width=3, dash="dot", name="off", scene=second))
    return drawn


def between(axes: list[Array], points: Array, place: Array) -> Array:
    """The point of a sampling at any parameters, linear between the samples."""
    for axis, value in zip(axes, place, strict=True):
        i = int(np.clip(np.searchsorted(axis, value, side="right") - 1, 0, max(len(axis) - 2, 0)))
        after = min(i + 1, len(axis) - 1)
        t = 0.0 if after == i else float(np.clip((value - axis[i]) / (axis[after] - axis[i]), 0.0, 1.0))
        points = points[i] if t == 0 else points[after] if t == 1 else (1 - t) * points[i] + t * points[after]
    return points


def _worst(axes: list[Array], off: Array, worst: Sequence[float] | None) -> Array | None:
    if worst is not None and len(worst) == len(axes):
        return checks.real("worst", worst)
    if not np.isfinite(off).any() or np.nanmax(off) <= ROUNDING:
        return None
    index = np.unravel_index(int(np.nanargmax(off)), off.shape)
    return np.array([axis[i] for axis, i in zip(axes, index, strict=True)])


def _within_reach(right: Array, left: Array, words: Words) -> tuple[Array, str]:
    """``left`` without the points that are so far out that float32 and the eye lose them, and the words that say so."""
    finite = np.isfinite(left).all(axis=-1)
    if not finite.any():
        return left, words["none_finite"]
    size, centre = size_of(right), np.nanmean(right.reshape(-1, 3), axis=0)
    with np.errstate(over="ignore", invalid="ignore"):
        reach = np.linalg.norm(left - centre, axis=-1) / size
    reach = np.where(finite & ~np.isfinite(reach), np.inf, reach)
    furthest = float(np.nanmax(np.where(finite, reach, np.nan)))
    kept = np.where((reach <= 100 * FAR)[..., None], left, np.nan)
    if furthest <= FAR:
        some = words["not_finite"].format(count=int((~finite).sum()), total=finite.size)
        return kept, "" if finite.all() else some
    return kept, words["far"].format(times=f"{furthest:.3g}") if furthest < 1e9 else words["very_far"]


def _box(right: Array, left: Array) -> Box:
    """The common box; a surface that runs far out is cut, or the reference would be a dot."""
    size, centre = size_of(right), np.nanmean(right.reshape(-1, 3), axis=0)
    finite = left[np.isfinite(left).all(axis=-1)]
    if len(finite) and np.linalg.norm(finite - centre, axis=-1).max() > FAR * size:
        finite = np.clip(finite, centre - size, centre + size)
    return Box.around(right, finite)


def _views(scenes: tuple[str, ...], corner: tuple[float, float, float], words: Words) -> dict[str, Any]:
    """Buttons for the standard views; they turn all scenes at once without any script."""
    buttons = [
        {
            "label": words["corner"] if view not in SIDES else words["from"].format(axis=SIDES[view]),
            "method": "relayout",
            "args": [{f"{name}.camera": camera(view, FARTHER, corner) for name in scenes}],
        }
        for view in VIEWS
    ]
    return {
        "type": "buttons", "direction": "right", "buttons": buttons, "showactive": False, "x": 0.0, "y": 0.0,
        "xanchor": "left", "yanchor": "top", "pad": {"l": 6, "t": 8}, "bgcolor": palette.CLEAR, "bordercolor": palette.GRID,
        "font": {"size": 11, "color": palette.INK},
    }  # fmt: skip


def _at(place: Array, called: tuple[str, ...]) -> str:
    numbers = ", ".join(f"{value:.3g}" for value in place)
    return f"{called[0]} = {numbers}" if len(place) == 1 else f"({', '.join(called)}) = ({numbers})"


def _largest(words: Words) -> str:
    """The mark of the worst place, for the legend."""
    return coloured(f"◆ {words['largest']}", palette.MARK)


def _said(off: Array, place: Array | None, called: tuple[str, ...], words: Words) -> str:
    if place is None:
        return words["agree"] if np.isfinite(off).all() else ""
    if not np.isfinite(off).any():
        return words["deviation_not_finite"].format(place=_at(place, called))
    return words["deviation"].format(amount=f"{np.nanmax(off):.3g}", place=_at(place, called))
