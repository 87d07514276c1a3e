"""The words of a comparison picture: what is read and heard there. Another language hands ``compare`` words of its own.

Each text keeps the names in braces of the one it replaces. ``<br>`` breaks a line; what a browser reads aloud has none.
"""

from __future__ import annotations

from collections.abc import Mapping

Words = Mapping[str, str]

WORDS: dict[str, str] = {
    # --- seen
    "coloured": "{name}, coloured by its deviation",
    "bar": "off by<br>÷ size",
    "off": "off by (÷ size)",
    "along": "along {letter}",
    "largest": "largest deviation",
    "here": "here",
    "goal": "should be here",
    "right": "{name} = the reference",
    "corner": "3-D",
    "from": "from {axis}",
    # --- what the picture leaves out
    "none_finite": "no point of yours is finite",
    "not_finite": "{count} of {total} points of yours are not finite",
    "far": "yours runs out of the picture, up to {times} sizes away",
    "very_far": "yours runs out of the picture, more than a billion sizes away",
    # --- read aloud
    "two_scenes": (
        "Two 3-D scenes on the same axes whose cameras turn together. Left: {first}. "
        "Right: {second}, coloured by its deviation."
    ),
    "two_curves": "One 3-D scene with two curves: {first}, and {second} dashed.",
    "alone": "A 3-D scene: {name}.",
    "alone_right": "A 3-D scene: {name}, which agrees with the reference everywhere.",
    "agree": "They agree.",
    "deviation": "Largest deviation {amount} of its size, marked at {place}.",
    "deviation_not_finite": "Largest deviation not finite, marked at {place}.",
}
