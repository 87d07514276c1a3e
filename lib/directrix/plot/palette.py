"""The colours and sizes of every picture, in one place.

u and w keep their colours everywhere: in the picture, in the parameter square, in the text beside them. The hues are those of
M. Okabe and K. Ito, "Color universal design" (2008), which readers with any common colour deficiency tell apart; deviations use
cividis (J. R. Nuñez et al., PLOS ONE 13(7), 2018), whose lightness grows evenly. Text and axes are a middle grey that reads on
a light page and on a dark one alike, and the paper is transparent.
"""

from __future__ import annotations

U = "#0072B2"  # what runs along u: the curves w = constant
W = "#D55E00"  # what runs along w: the curves u = constant
NET = "#8A6FB0"  # control points and their net
NORMAL = "#009E73"
KNOT = "#56B4E9"
CURVE = "#009E73"
MARK = "#E0218A"  # a place that is pointed at
REFERENCE = "#0072B2"  # two curves against each other
YOURS = "#D55E00"
INK = "#7A7A7A"
GRID = "#A6A6A6"  # opaque: WebGL adds a translucent line to a light page and it vanishes
PLAIN = "#D3DCE6"  # a surface that carries no data in its colour
CLEAR = "rgba(0, 0, 0, 0)"

# Without its darkest tenth, which on a dark page would be a hole.
CIVIDIS = ("#123570", "#3B496C", "#575D6D", "#707173", "#8A8678", "#A59C74", "#C3B369", "#E1CC55", "#FEE838")
# Two-sided maps (curvature has a sign): dark blue below, pale at zero, dark orange above.
SIGNED = ("#00466F", "#2F7FB8", "#9CC7E4", "#F2F2F0", "#F3BE93", "#D9792F", "#8A3A00")

FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif"
# True colours against a colour bar need a surface that is not shaded at all.
FLAT = {"ambient": 1.0, "diffuse": 0.0, "specular": 0.0, "fresnel": 0.0, "roughness": 1.0}
SHADED = {"ambient": 0.7, "diffuse": 0.5, "specular": 0.05, "fresnel": 0.05, "roughness": 0.8}
LIGHT = {"x": 2000.0, "y": -6000.0, "z": 7000.0}  # above the reader's left shoulder

# plotly.js 4 offers to upload a figure to a cloud service; a course does not.
CONFIG = {"displaylogo": False, "modeBarButtonsToRemove": ["sendChartToCloud"], "responsive": True}


def scale(colours: tuple[str, ...]) -> list[list[float | str]]:
    """A plotly colour scale with the colours at even places of [0, 1]."""
    return [[i / (len(colours) - 1), colour] for i, colour in enumerate(colours)]


def constant(colour: str) -> list[list[float | str]]:
    """A colour scale of one colour."""
    return [[0.0, colour], [1.0, colour]]
