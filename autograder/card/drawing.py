"""The figure of a card: both surfaces beside each other, as plain plotly JSON that is checked before it leaves."""

from __future__ import annotations

import base64
import binascii
import copy
import json
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from directrix.plot import compare
from directrix.plot.palette import CONFIG
from directrix.plot.wording import WORDS

from autograder import messages
from autograder.messages import say
from autograder.result import Verdict

PLOTLY = "application/vnd.plotly.v1+json"
FIGURE_KINDS = frozenset({"surface", "scatter3d"})
FIGURE_NUMBERS = 400_000
KEPT = 48  # figures of a tenth of a megabyte that are kept


def figure(verdict: Verdict) -> dict[str, Any] | None:
    """The comparison figure of a verdict as plain plotly JSON, or None where it has nothing to show.

    Arrays are typed arrays of float32 in base64. A right answer is drawn alone: one scene instead of two equal ones, since a
    browser keeps only so many.
    """
    shared = _shared(verdict)
    return None if shared is None else copy.deepcopy({part: shared[part] for part in ("data", "layout")})


def figure_bundle(verdict: Verdict) -> dict[str, Any] | None:
    """The figure as a mime bundle, its description as the text, or None. Many cards show one figure: nobody changes it."""
    shared = _shared(verdict)
    if shared is None:
        return None
    return {"text/plain": say("figure.described", alt=shared["layout"]["meta"]["alt"]), PLOTLY: shared}


class Shared(dict[str, Any]):
    """A figure that many cards show, so that nobody changes it, with its JSON as it is written to a file."""

    written: bytes = b""


@dataclass(frozen=True, eq=False)
class _Itself:
    """Anything as a key: equal to the very same object only."""

    thing: Any

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Itself) and other.thing is self.thing

    def __hash__(self) -> int:
        return id(self.thing)


def _shared(verdict: Verdict) -> Shared | None:
    """The figure of a verdict. Many of a class are right, and many make the same mistake: what was drawn is kept for them."""
    drawn = verdict.figure
    if drawn is None:
        return None
    words = {name: messages.TEXT[f"figure.{name}"] for name in WORDS}
    names = say("figure.reference"), say("figure.yours")
    same = verdict.outcome == "passed" and verdict.tier == "identical" and drawn.yours is not None
    right = drawn.yours is drawn.expected  # the judge hands out one object for what all who are right get to see
    yours = None if drawn.yours is None or right else _numbers(drawn.yours)
    key = (
        same, right, _Itself(drawn.expected), None if yours is None else yours.tobytes(), drawn.parameters, drawn.worst,
        drawn.size, drawn.names, drawn.layer, names, tuple(words.values()),
    )  # fmt: skip
    shown = _kept.pop(key, None)
    if shown is None:
        expected = _numbers(drawn.expected)
        built = compare(
            drawn.parameters,
            expected,
            expected if right else yours,
            worst=None if same else drawn.worst,
            size=drawn.size,
            title=say("figure.layer", layer=drawn.layer) if drawn.layer else None,
            same=same,
            letters=drawn.names or None,
            names=names,
            words=words,
        )
        shown = Shared({**validated(built), "config": dict(CONFIG)})
        shown.written = json.dumps(shown, sort_keys=True, ensure_ascii=False, allow_nan=False).encode("utf-8")
    _kept[key] = shown  # the newest last
    while len(_kept) > KEPT:
        del _kept[next(iter(_kept))]
    return shown


_kept: dict[tuple[Any, ...], Shared] = {}


def validated(built: Mapping[str, Any]) -> dict[str, Any]:
    """The figure itself, if it is what a card may show: surfaces and lines in space, finite numbers or gaps, bounded.

    Raises
    ------
    ValueError
        That says what is wrong with it.
    """
    if set(built) != {"data", "layout"} or not isinstance(built["data"], list) or not isinstance(built["layout"], dict):
        raise ValueError("a figure has data (a list) and layout (a dict), and nothing else")
    for trace in built["data"]:
        if not isinstance(trace, dict) or trace.get("type") not in FIGURE_KINDS:
            raise ValueError(f"a figure holds traces of the kinds {', '.join(sorted(FIGURE_KINDS))} only")
    count = sum(_counted(value) for value in (built["data"], built["layout"]))
    if count > FIGURE_NUMBERS:
        raise ValueError(f"a figure holds at most {FIGURE_NUMBERS} numbers; got {count}")
    return dict(built)


def _counted(value: Any) -> int:
    """How many numbers a JSON value holds; refuses what is neither finite nor a gap, and anything that is not JSON."""
    if value is None or isinstance(value, bool):
        return 0
    if isinstance(value, str):
        if len(value) > 4000:
            raise ValueError("a string in a figure is too long")
        return 0
    if isinstance(value, int | float):
        if not math.isfinite(value):
            raise ValueError("a number in a figure is not finite")
        return 1
    if isinstance(value, list):
        return sum(map(_counted, value))
    if isinstance(value, dict):
        if "bdata" in value:
            return _counted_typed(value)
        if not all(isinstance(key, str) for key in value):
            raise ValueError("a key in a figure is not a string")
        return sum(map(_counted, value.values()))
    raise ValueError(f"a figure holds plain JSON only; got {type(value).__name__}")


def _counted_typed(value: Mapping[str, Any]) -> int:
    if not set(value) <= {"bdata", "dtype", "shape"} or value.get("dtype") != "f4" or not isinstance(value["bdata"], str):
        raise ValueError("a typed array in a figure has dtype f4, bdata and perhaps shape")
    try:
        data = np.frombuffer(base64.b64decode(value["bdata"], validate=True), "<f4")
    except (binascii.Error, ValueError):
        raise ValueError("a typed array in a figure is not base64 of whole float32 numbers") from None
    if np.isinf(data).any():
        raise ValueError("a number in a figure is not finite")
    shape = value.get("shape", str(data.size))
    if not re.fullmatch(r"\d+(, \d+)*", shape) or math.prod(map(int, shape.split(", "))) != data.size:
        raise ValueError("the shape of a typed array in a figure does not fit its numbers")
    return int(data.size)


def _numbers(nested: Any) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Nested lists with None for what is not finite, as an array with NaN."""
    return np.asarray(nested, dtype=np.float64)  # None becomes NaN
