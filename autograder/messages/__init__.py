"""All that a learner reads of the judge, the cards, grading and the feedback: one catalogue, so that a translation is one file.

:mod:`autograder.translation` reads that file and says how to begin one. Statements, titles and hints of known mistakes are not
here: they stand in the assignment, beside what they speak of.

judged   what the judge says of an answer
shown    what stands around it: headings, the table, cards where nothing can be judged, the figure, feedback page and site
graded   what grading writes into a notebook: no mark and why, what was stopped, what was cut
"""

from __future__ import annotations

import difflib
import math
import string
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from autograder.errors import CourseError
from autograder.messages.graded import GRADED
from autograder.messages.judged import JUDGED
from autograder.messages.shown import SHOWN

ENGLISH: Mapping[str, str] = MappingProxyType({**JUDGED, **SHOWN, **GRADED})
TEXT: dict[str, str] = dict(ENGLISH)  # what is said


def use(texts: Mapping[str, str]) -> None:
    """Speak in these texts from now on, in this process. Keys that are not among them keep their text.

    Raises
    ------
    CourseError
        If a key or a name in braces is not one of the English catalogue; then nothing is replaced.
    """
    for key, text in texts.items():
        _fitting(key, text)
    TEXT.update(texts)


def _fitting(key: str, text: object) -> None:
    """Refuse a text that could not be said."""
    if key not in ENGLISH:
        near = difflib.get_close_matches(key, ENGLISH, n=1)
        meant = f"; did you mean {near[0]!r}?" if near else ""
        raise CourseError(f"a translation has the keys of the catalogue; {key!r} is none{meant}")
    if not isinstance(text, str):
        raise CourseError(f"the translation of {key!r} must be a text; got {text!r}")
    try:
        unknown = sorted(_names(text) - _names(ENGLISH[key]))
    except ValueError as error:
        raise CourseError(f"the translation of {key!r} has a brace that is none ({error}); write it twice: {text!r}") from None
    if unknown:
        known = ", ".join(sorted(_names(ENGLISH[key]))) or "none"
        raise CourseError(f"the translation of {key!r} may name in braces: {known}; got {', '.join(unknown)}")


def _names(text: str) -> set[str]:
    """What stands in braces, whole: a plain name where nothing is wrong."""
    return {
        f"{name}{'!' + way if way else ''}{':' + form if form else ''}"
        for _, name, form, way in string.Formatter().parse(text)
        if name is not None
    }


def say(key: str, **facts: Any) -> str:
    """One sentence of the catalogue with its facts filled in."""
    return TEXT[key].format(**facts)


def listing(names: Iterable[str]) -> str:
    """``a, b and c``."""
    every = list(names)
    return TEXT["and"].join([", ".join(every[:-1]), every[-1]]) if len(every) > 1 else "".join(every)


def number(x: float, digits: int = 4) -> str:
    """A number with so many significant digits, without needless zeros; -0 is 0."""
    if not math.isfinite(x):
        return str(x)
    return f"{x + 0.0:.{digits}g}" if x else "0"


def written(value: ArrayLike, digits: int = 4) -> str:
    """A number, or a point or a short vector in brackets."""
    array = np.asarray(value)
    if array.dtype == bool:
        return str(bool(array)) if array.ndim == 0 else "(" + ", ".join(map(str, array.tolist())) + ")"
    size = float(np.abs(array[np.isfinite(array)]).max(initial=0.0))
    # Coordinates that are rounding errors beside the others are written 0.
    cleaned = np.where(np.abs(array) < 1e-12 * size, 0.0, array)
    if array.ndim == 0:
        return number(float(cleaned), digits)
    return "(" + ", ".join(number(float(x), digits) for x in cleaned.ravel()) + ")"


def digits_for(deviation: float, size: float) -> int:
    """So many significant digits that a deviation shows in a number of this size."""
    if not (deviation > 0 and math.isfinite(deviation) and size > 0):
        return 4
    return min(max(4, math.ceil(-math.log10(deviation / size)) + 2), 15)


def percent(share: float) -> str:
    """A share of 1 as a percentage: ``0.16 %``, ``48 %``."""
    return f"{_rounded(100 * share, 2 if share < 1 else 3)} %"


def _rounded(x: float, digits: int) -> str:
    """As `number`, but 99.7 is 100 and not 1e+02."""
    short = number(x, digits)
    return f"{float(short):.0f}" if "e+" in short and x < 1e6 else short


def amount(share: float) -> str:
    """A length relative to the size: ``48 % of its size``, ``13 times its size``."""
    if share >= 3:
        return say("amount.times", number=_rounded(share, 2))
    return say("amount.percent", number=_rounded(100 * share, 2 if share < 1 else 3))


def place(names: tuple[str, ...], at: Iterable[float]) -> str:
    """``u = 0.25, w = 1``."""
    return ", ".join(f"{name} = {number(float(x))}" for name, x in zip(names, at, strict=True))
