"""What surrounds the traces: axes of one scale, the camera, the words, and a figure as plain JSON."""

from __future__ import annotations

import base64
import functools
from dataclasses import dataclass
from typing import Any

import numpy as np

from directrix.plot import palette
from directrix.plot.sampling import Array, bounds
from directrix.plot.wording import WORDS

# Looking down on the corner between +x and -y, z upwards: u and w of the known forms start towards the reader.
CORNER = (1.18, -1.37, 0.86)
EYE = dict(zip("xyz", CORNER, strict=True))
VIEWS: dict[str, dict[str, dict[str, float]]] = {
    "3-D": {"eye": EYE, "up": {"x": 0, "y": 0, "z": 1}},
    "from +x": {"eye": {"x": 1.9, "y": 0, "z": 0}, "up": {"x": 0, "y": 0, "z": 1}},
    "from −y": {"eye": {"x": 0, "y": -1.9, "z": 0}, "up": {"x": 0, "y": 0, "z": 1}},
    "from +z": {"eye": {"x": 0, "y": 0, "z": 1.9}, "up": {"x": 0, "y": 1, "z": 0}},
}
CENTRE = {"x": 0, "y": 0, "z": -0.1}
MIDDLE = np.array(list(CENTRE.values()))
ENDS = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
OPENING = 0.9 * float(np.tan(np.pi / 8))  # room for the numbers at the axes


@dataclass(frozen=True)
class Box:
    """The part of space that a scene shows: the same for both scenes of a comparison."""

    low: tuple[float, float, float]
    high: tuple[float, float, float]

    @classmethod
    def around(cls, *samplings: Array) -> Box:
        """The box of all points with a margin. A flat figure keeps a little depth, so that its axes can be read."""
        low, high = bounds(*samplings)
        extent = high - low
        largest = float(extent.max())
        # A figure of a single point still needs a box; and float32, in which it is drawn, needs room to tell numbers apart.
        least = 0.12 * largest or max(float(np.abs(high).max()), 1.0)
        grow = np.maximum(0.06 * largest, (least - extent) / 2)
        a, b = (low - grow).tolist(), (high + grow).tolist()
        return cls((a[0], a[1], a[2]), (b[0], b[1], b[2]))

    @property
    def size(self) -> float:
        """The diagonal."""
        return float(np.linalg.norm(np.subtract(self.high, self.low)))

    @property
    def aspect(self) -> dict[str, float]:
        """The ratio of the axes, one scale on all three, about the size that plotly's camera expects."""
        extent = np.subtract(self.high, self.low)
        shape = extent * (np.sqrt(3) / np.linalg.norm(extent))
        return dict(zip("xyz", map(float, shape), strict=True))

    def fitting(self, corner: tuple[float, float, float]) -> float:
        """How much further away than usual the camera must stand for a tall box: up to its ends inside the picture."""
        ahead, up, away = _looking(corner)
        seen = ENDS * (np.array(list(self.aspect.values())) / 2) - MIDDLE
        # Each end is inside if |up| <= OPENING (distance + depth): plotly's camera looks through 45 degrees.
        needed = np.abs(seen @ up) / OPENING - seen @ ahead
        return max(1.0, float(needed.max() / away))

    def corner(self, place: Array | None) -> tuple[float, float, float]:
        """The camera's corner from which a place is likely seen: the usual one unless the place lies on the far side."""
        x, y, z = CORNER
        if place is None or not np.isfinite(place).all():
            return CORNER
        away = (np.asarray(place) - np.add(self.low, self.high) / 2) / np.subtract(self.high, self.low).max()
        towards = [(a * x, b * y) for a, b in ((1, 1), (1, -1), (-1, 1), (-1, -1))]
        seen = [away[0] * a + away[1] * b for a, b in towards]
        best = towards[int(np.argmax(seen))] if seen[0] < 0.1 else (x, y)
        return (*best, z)


@functools.lru_cache(maxsize=16)
def _looking(corner: tuple[float, float, float]) -> tuple[Array, Array, float]:
    """From a corner: where ahead is, where up is, and how far away the middle."""
    eye = np.array(corner)
    away = np.linalg.norm(eye)
    ahead = -eye / away
    right = np.cross(ahead, (0, 0, 1)) / np.linalg.norm(np.cross(ahead, (0, 0, 1)))
    return ahead, np.cross(right, ahead), float(away)


def scene(
    box: Box, domain: tuple[float, float] = (0.0, 1.0), *, distance: float = 1.0, corner: tuple[float, float, float] = CORNER
) -> dict[str, Any]:
    """The layout of one scene: labelled axes of one scale, equal ranges for equal boxes, no background."""
    longest = max(np.subtract(box.high, box.low))
    axes = {
        f"{name}axis": {
            "title": {"text": name, "font": {"color": palette.INK, "size": 14}},
            "range": [box.low[i], box.high[i]],
            "nticks": max(2, round(5 * (box.high[i] - box.low[i]) / longest)),
            "tickfont": {"color": palette.INK, "size": 11},
            "gridcolor": palette.GRID,
            "zerolinecolor": palette.GRID,
            "linecolor": palette.GRID,
            "showbackground": False,
            "showspikes": False,
        }
        for i, name in enumerate("xyz")
    }
    return axes | {
        "aspectmode": "manual",
        "aspectratio": box.aspect,
        "camera": camera("3-D", max(distance, box.fitting(corner)), corner),
        "domain": {"x": list(domain), "y": [0.0, 1.0]},
        "bgcolor": palette.CLEAR,
        "hovermode": "closest",
        "dragmode": "turntable",
    }


def camera(view: str, distance: float = 1.0, corner: tuple[float, float, float] = CORNER) -> dict[str, Any]:
    """One of the standard views; "3-D" looks from the corner."""
    known = VIEWS[view]
    eye = dict(zip("xyz", corner, strict=True)) if view == "3-D" else known["eye"]
    return {
        "eye": {axis: value * distance for axis, value in eye.items()},
        "up": known["up"],
        "center": CENTRE if view == "3-D" else {"x": 0, "y": 0, "z": 0},
    }


def layout(*, height: int, title: str | None = None, alt: str = "", link: tuple[str, ...] = ()) -> dict[str, Any]:
    """What all pictures share. ``meta`` tells figures.js the words for who cannot see it, which scenes turn together, and that
    the picture is ours: a page may lay it out anew on a phone.
    """
    meta: dict[str, Any] = {"alt": alt, "fit": True}
    if link:
        meta["link"] = list(link)
    shared: dict[str, Any] = {
        "height": height,
        "margin": {"l": 0, "r": 0, "t": 46 if title else 12, "b": 46},
        "paper_bgcolor": palette.CLEAR,
        "plot_bgcolor": palette.CLEAR,
        "font": {"family": palette.FONT, "size": 13, "color": palette.INK},
        "hoverlabel": {"font": {"family": palette.FONT, "size": 13}, "align": "left"},
        "modebar": {"bgcolor": palette.CLEAR, "color": palette.INK, "activecolor": palette.U},
        "showlegend": False,
        "meta": meta,
        "template": {},
    }
    if title:
        shared["title"] = {"text": title, "font": {"size": 16}, "x": 0.5, "xanchor": "center", "y": 0.98, "yanchor": "top"}
    return shared


def word(text: str, x: float, y: float, *, size: int = 13, anchor: str = "center", yanchor: str = "bottom") -> dict[str, Any]:
    """A line of text at paper coordinates."""
    return {
        "text": text, "x": x, "y": y, "xref": "paper", "yref": "paper", "xanchor": anchor, "yanchor": yanchor,
        "showarrow": False, "font": {"size": size},
    }  # fmt: skip


def coloured(text: str, colour: str) -> str:
    """Text in a colour, inside an annotation."""
    return f"<span style='color:{colour}'>{text}</span>"


def legend(letters: tuple[str, ...] = ("u", "w"), extra: str = "", along: str = WORDS["along"]) -> str:
    """The line below a picture that says which colour runs along which parameter."""
    colours = (palette.U, palette.W)
    runs = [coloured(f"━ {along.format(letter=letter)}", colour) for letter, colour in zip(letters, colours, strict=False)]
    return "&nbsp;&nbsp;&nbsp;".join([*runs, *([extra] if extra else [])])


def encode(value: Any) -> Any:
    """A figure as plain JSON. Arrays become plotly's typed arrays: float32 in base64, a third of the size of digits."""
    if isinstance(value, dict):
        return {key: encode(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [encode(one) for one in value]
    if isinstance(value, np.ndarray):
        packed = np.ascontiguousarray(value, dtype="<f4")
        typed = {"dtype": "f4", "bdata": base64.b64encode(packed.tobytes()).decode("ascii")}
        return typed if packed.ndim == 1 else typed | {"shape": ", ".join(map(str, packed.shape))}
    if isinstance(value, np.generic):
        return value.item()
    return value


def short(text: str, most: int = 60) -> str:
    """Text cut to a length, plain enough for plotly's small HTML."""
    cut = text if len(text) <= most else text[: most - 1] + "…"
    return cut.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
