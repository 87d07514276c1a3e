"""The parameter square: where u and w live before the surface bends them, in the colours they keep on it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.plot import palette


def parameter_square(
    inner: Sequence[int],
    samples: int,
    *,
    knots: Sequence[ArrayLike] | None = None,
    mark: Sequence[float] | None = None,
    domain: tuple[float, float] = (0.68, 0.98),
) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Traces and axes of the square [0, 1] x [0, 1] with the lines at the samples ``inner``, u to the right and w upwards."""
    at = np.array([i / (samples - 1) for i in inner])
    ends = np.array([0.0, 1.0])
    drawn = [
        _lines(ends, at, palette.U, 1.2, True),
        _lines(ends, at, palette.W, 1.2, False),
        *([] if knots is None else _knots(knots)),
        _lines(ends, ends, palette.U, 4, True),
        _lines(ends, ends, palette.W, 4, False),
        _dot(0.0, 0.0, palette.INK, "circle", 8, "u = w = 0"),
    ]
    if mark is not None:
        drawn.append(_dot(float(mark[0]), float(mark[1]), palette.MARK, "diamond", 12, "marked"))
    shared = {
        "range": [-0.07, 1.07], "showgrid": False, "zeroline": False, "tickvals": [0, 0.25, 0.5, 0.75, 1], "fixedrange": True,
        "tickfont": {"size": 11, "color": palette.INK},
    }  # fmt: skip
    axes = {
        "xaxis": {**shared, "title": {"text": "u", "font": {"color": palette.U, "size": 16}}, "domain": list(domain)},
        "yaxis": {
            **shared, "title": {"text": "w", "font": {"color": palette.W, "size": 16}}, "domain": [0.12, 0.94],
            "scaleanchor": "x", "constrain": "domain",
        },
    }  # fmt: skip
    axes["xaxis"]["constrain"] = "domain"
    return drawn, axes


def _lines(running: np.ndarray, held: np.ndarray, colour: str, width: float, along_u: bool) -> dict[str, Any]:
    """Straight lines across the square at the held values, as one trace."""
    gap = np.nan
    a = [value for _ in held for value in (*running, gap)]
    b = [value for one in held for value in (one, one, gap)]
    x, y = (a, b) if along_u else (b, a)
    return {
        "type": "scatter", "mode": "lines", "x": np.array(x), "y": np.array(y), "line": {"color": colour, "width": width},
        "hoverinfo": "skip", "showlegend": False,
    }  # fmt: skip


def _knots(knots: Sequence[ArrayLike]) -> list[dict[str, Any]]:
    at_u, at_w = (np.unique(checks.real("knots", values)) for values in knots)
    ends = np.array([0.0, 1.0])
    return [_lines(ends, at_w, palette.KNOT, 4, True), _lines(ends, at_u, palette.KNOT, 4, False)]


def _dot(u: float, w: float, colour: str, symbol: str, size: float, name: str) -> dict[str, Any]:
    return {
        "type": "scatter", "mode": "markers", "x": [u], "y": [w], "marker": {"color": colour, "symbol": symbol, "size": size},
        "hovertemplate": f"{name}<br>(u, w) = (%{{x:.3~g}}, %{{y:.3~g}})<extra></extra>", "showlegend": False,
    }  # fmt: skip
