"""The verdict card: what a learner reads in a notebook and in the feedback, as HTML and as plain text, and the figure below it.

The HTML is a fragment without script, link, class or id, styled inline, so that JupyterLab's sanitiser and nh3 leave it whole
(``STYLE_PROPERTIES`` names all it uses). Its ground is translucent and its text inherits the page's colour, so it reads on a
light page and on a dark one; the outcome is said by a word and a sign as well. The text alone suffices. No points stand on a
card: a mark given later by hand would contradict it.
"""

from __future__ import annotations

import base64
import binascii
import copy
import functools
import html as _html
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from operator import itemgetter
from typing import Any

import numpy as np
from directrix.plot import compare
from directrix.plot.palette import CONFIG

from autograder.messages import amount, number, say
from autograder.result import Case, Figure, Outcome, Tier, Verdict

PLOTLY = "application/vnd.plotly.v1+json"
# What the outcome is called, its sign, and the ground of its badge: white text has a contrast of at least 5 on each.
OUTCOMES: dict[Outcome, tuple[str, str, str]] = {
    "passed": ("Right", "✓", "#00704F"),
    "partial": ("Partly right", "◐", "#8A5A00"),
    "failed": ("Not right yet", "✗", "#A8430A"),
    "not run": ("Nothing to judge yet", "○", "#5F6670"),
    "could not judge": ("Could not be judged", "?", "#7A3E8E"),
}
# Each rung in the words of a table, with a sign of its own.
TIERS: dict[Tier, tuple[str, str]] = {
    "identical": ("✓", "right"),
    "mistake": ("✗", "a known slip"),
    "relabelled": ("⇄", "right, but its parameters are labelled otherwise"),
    "other start": ("↻", "right, but starts elsewhere"),
    "close": ("≈", "close, not equal"),
    "same set": ("≅", "right set of points, traced otherwise"),
    "covered": ("≅", "right set of points, covered more than once"),
    "part": ("⊂", "a part of it"),
    "more": ("⊃", "more than it"),
    "moved": ("↷", "right shape, other place or size"),
    "different": ("✗", "different"),
    "error": ("!", "no answer"),
    "timeout": ("!", "took too long"),
    "shape": ("!", "wrong shape of the answer"),
    "not finite": ("!", "not finite"),
    "not pointwise": ("!", "not point by point"),
    "not repeatable": ("!", "not repeatable"),
}
PARTS = {"right": "What holds", "wrong": "What does not", "where": "Where", "look": "Look at"}
LETTERS = {1: ("u",), 2: ("u", "w"), 3: ("u", "v", "w")}
STYLE_PROPERTIES = frozenset(
    {
        "background-color", "border-bottom", "border-collapse", "border-left", "border-radius", "color", "font-size",
        "font-weight", "line-height", "margin", "max-width", "overflow-x", "padding", "text-align", "vertical-align",
        "white-space",
    }
)  # fmt: skip
SHORT = 34  # characters of a cell of the table that stay on one line
LONGEST = 1200  # characters of one part
LONGEST_NOTE = 2400
FIGURE_KINDS = frozenset({"surface", "scatter3d"})
FIGURE_NUMBERS = 400_000


@dataclass(frozen=True)
class Card:
    """What a card says: an outcome, a title, parts with a heading each, a table of cases, notes in the words of the machine."""

    outcome: Outcome
    title: str
    parts: tuple[tuple[str, str], ...]
    cases: tuple[Case, ...] = ()
    notes: tuple[tuple[str, str], ...] = ()


def of(verdict: Verdict, notes: Iterable[tuple[str, str]] = ()) -> Card:
    """The card of a verdict, with notes (heading, text) such as what the function printed."""
    named = [(PARTS.get(name, name.capitalize()), text) for name, text in verdict.parts if text]
    # Sentences that follow each other under one heading are one paragraph.
    parts = [(name, " ".join(text for _, text in said)) for name, said in groupby(named, key=itemgetter(0))]
    if not parts and verdict.message:
        parts = [("", verdict.message)]
    if verdict.terms:
        parts.append(("Worth", worth(verdict)))
    cases = verdict.cases if verdict.outcome != "not run" else ()
    return Card(verdict.outcome, verdict.title or verdict.exercise, tuple(parts), cases, tuple(notes))


def worth(verdict: Verdict) -> str:
    """The arithmetic of a part of the points, ``0.75 (right on 3 of 4 data sets) × 0.5 (since not on all) = 0.375 ...``."""
    fraction = number(verdict.fraction)
    if len(verdict.terms) == 1:
        return say("share.one", fraction=fraction, why=verdict.terms[0][0])
    told = [say("share.term", factor=number(factor), why=why) for why, factor in verdict.terms]
    return say("share", sum=" × ".join(told), fraction=fraction)


def with_parts(shown: Card, parts: Iterable[tuple[str, str]]) -> Card:
    """The same card with more to say at its end."""
    return replace(shown, parts=(*shown.parts, *parts))


def html(verdict: Verdict | Card) -> str:
    """The card as an HTML fragment. Everything that came from outside is escaped."""
    card = verdict if isinstance(verdict, Card) else of(verdict)
    word, sign, ground = OUTCOMES[card.outcome]
    badge = (
        f'<span style="background-color: {ground}; color: #ffffff; font-weight: bold; padding: 2px 9px; border-radius: 9px; '
        f'white-space: nowrap">{sign}&nbsp;{_escape(word)}</span>'
    )
    body = [
        f'<div style="margin: 0 0 6px 0">{badge}&nbsp; <b>{_escape(card.title)}</b></div>',
        *(_part(heading, text) for heading, text in card.parts),
        _table(card.cases),
        *(_note(heading, text) for heading, text in card.notes),
    ]
    return (
        f'<div style="border-left: 5px solid {ground}; background-color: rgba(128, 128, 128, 0.09); border-radius: 3px; '
        f'padding: 10px 14px; margin: 4px 0; max-width: 860px; line-height: 1.5; font-size: 14px">{"".join(body)}</div>'
    )


def text(verdict: Verdict | Card) -> str:
    """The card as plain text: all that the HTML says."""
    card = verdict if isinstance(verdict, Card) else of(verdict)
    word, sign, _ = OUTCOMES[card.outcome]
    lines = [f"[{sign} {word}] {_clean(card.title)}"]
    for heading, said in card.parts:
        shown = _clean(said, LONGEST).replace("`", "")
        lines.append(f"{_clean(heading)}: {shown}" if heading else shown)
    if alike := _all_alike(card.cases):
        lines.append(f"Data sets: {_clean(alike, LONGEST)}")
    elif card.cases:
        lines.append("Data sets:")
        lines += [
            f"  {sign} {': '.join(part for part in (name, said) if part)}" for sign, name, said in _rows_as_text(card.cases)
        ]
    for heading, said in card.notes:
        lines.append(f"{_clean(heading)}:")
        lines += [f"    {line}" for line in _clean(said, LONGEST_NOTE, lines=True).splitlines()]
    return "\n".join(lines)


def bundle(verdict: Verdict | Card) -> dict[str, Any]:
    """The card as a mime bundle."""
    return {"text/plain": text(verdict), "text/html": html(verdict)}


def figure(verdict: Verdict) -> dict[str, Any] | None:
    """The comparison figure of a verdict as plain plotly JSON, or None where it has nothing to show.

    Arrays are typed arrays of float32 in base64. A right answer is drawn alone: one scene instead of two equal ones, since a
    browser keeps only so many.
    """
    if verdict.figure is None:
        return None
    same = verdict.outcome == "passed" and verdict.tier == "identical" and verdict.figure.yours is not None
    if same and verdict.figure.yours is verdict.figure.expected:
        return copy.deepcopy(_drawn_once(_Itself(verdict.figure)))
    return _drawn(verdict.figure, same=same)


@dataclass(frozen=True, eq=False)
class _Itself:
    """A figure as a key: equal to the very same object only."""

    figure: Figure

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Itself) and other.figure is self.figure

    def __hash__(self) -> int:
        return id(self.figure)


@functools.lru_cache(maxsize=128)
def _drawn_once(key: _Itself) -> dict[str, Any]:
    """What all who are right get to see, drawn once: the judge hands out one object for it."""
    return _drawn(key.figure, same=True)


def _drawn(drawn: Figure, *, same: bool) -> dict[str, Any]:
    built = compare(
        drawn.parameters,
        _numbers(drawn.expected),
        None if drawn.yours is None else _numbers(drawn.yours),
        worst=None if same else drawn.worst,
        size=drawn.size,
        title=say("figure.layer", layer=drawn.layer) if drawn.layer else None,
        same=same,
        letters=drawn.names or None,
    )
    return validated(built)


def figure_bundle(verdict: Verdict) -> dict[str, Any] | None:
    """The figure as a mime bundle, its description as the text, or None."""
    built = figure(verdict)
    if built is None:
        return None
    return {"text/plain": f"[figure: {built['layout']['meta']['alt']}]", PLOTLY: {**built, "config": dict(CONFIG)}}


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


def _part(heading: str, text: str) -> str:
    label = f"<b>{_escape(heading)}:</b> " if heading else ""
    return f'<div style="margin: 3px 0">{label}{_marked_up(text)}</div>'


def _note(heading: str, text: str) -> str:
    ground = "background-color: rgba(128, 128, 128, 0.10); color: inherit"
    return (
        f'<div style="margin: 8px 0 0 0; font-size: 13px"><b>{_escape(heading)}:</b>'
        f'<pre style="margin: 2px 0 0 0; padding: 4px 8px; white-space: pre-wrap; font-size: 12px; {ground}">'
        f"{_escape(_clean(text, LONGEST_NOTE, lines=True))}</pre></div>"
    )


def _table(cases: Sequence[Case]) -> str:
    if not cases:
        return ""
    if said := _all_alike(cases):
        return f'<div style="margin: 3px 0"><b>Data sets:</b> {_escape(said)}</div>'
    columns = _columns(cases)
    letters = {told["at"].rsplit(" = ", 1)[0] for case in cases if "at" in (told := _worst_of(case))}
    at = letters.pop() if len(letters) == 1 else ""  # said once, in the head
    head = "".join(_cell(f"at {at}" if at and name == "at" else name, "th") for name in columns)
    plain = '<tr style="background-color: transparent">'  # JupyterLab would stripe the rows
    rows = [f"{plain}{head}</tr>"]
    for name, case in _named(cases):
        cells = {"data set": name, "result": _result_of(case), **_worst_of(case)}
        cells["at"] = cells.get("at", "").removeprefix(f"{at} = ")
        rows.append(plain + "".join(_cell(cells.get(name, "")) for name in columns) + "</tr>")
    return (
        '<div style="overflow-x: auto; margin: 8px 0 0 0"><table style="border-collapse: collapse; font-size: 13px; '
        f'margin: 0">{"".join(rows)}</table></div>'
    )


def _all_alike(cases: Sequence[Case]) -> str:
    """One line where no data set has anything of its own to tell: ``✓ right on all 2: lecture, any_size``."""
    results = {_result_of(case) for case in cases}
    if len(results) != 1 or any(_worst_of(case) for case in cases):
        return ""
    names = [_data_of(case) for case in cases]
    hidden = sum(case.hidden for case in cases)
    shown = [name for name, case in zip(names, cases, strict=True) if not case.hidden]
    shown += [f"{hidden} hidden"] if hidden else []
    many = f"on all {len(cases)}: " if len(cases) > 1 else "on "
    return f"{results.pop()} {many}{', '.join(shown)}"


def _named(cases: Sequence[Case]) -> list[tuple[str, Case]]:
    """Each data set by its name; hidden ones of one result together, since nothing more is told of them."""
    rows = [(_data_of(case), case) for case in cases if not case.hidden]
    hidden = [case for case in cases if case.hidden]
    for result in dict.fromkeys(map(_result_of, hidden)):
        alike = [case for case in hidden if _result_of(case) == result]
        rows.append((f"{len(alike)} hidden" if len(alike) > 1 else _data_of(alike[0]), alike[0]))
    return rows


def _columns(cases: Sequence[Case]) -> list[str]:
    """Only the columns in which some data set has something to say."""
    told = [_worst_of(case) for case in cases]
    return [
        "data set",
        "result",
        *(name for name in ("off by", "at", "yours", "reference") if any(row.get(name) for row in told)),
    ]


def _cell(text: str, tag: str = "td") -> str:
    line = "border-bottom: 1px solid rgba(128, 128, 128, 0.35)"
    weight = "bold" if tag == "th" else "normal"
    wrap = "nowrap" if len(text) <= SHORT else "normal"
    style = (
        f"font-weight: {weight}; white-space: {wrap}; text-align: left; vertical-align: top; padding: 2px 14px 2px 0; {line}"
    )
    return f'<{tag} style="{style}">{_escape(text)}</{tag}>'


def _data_of(case: Case) -> str:
    return f"{case.data} (hidden)" if case.hidden else f"{case.data} (blind)" if case.blind else case.data


def _result_of(case: Case) -> str:
    sign, said = TIERS[case.tier]
    if case.mistake and case.tier != "identical":
        said = f"{said}: {case.mistake}"
    return f"{sign} {said}"


def _worst_of(case: Case) -> dict[str, str]:
    """Deviation, place and both values of a data set that is not right."""
    if case.hidden or case.tier == "identical":
        return {}
    told: dict[str, str] = {}
    if case.deviation is not None and math.isfinite(case.deviation):
        told["off by"] = amount(case.deviation)
    if case.where:
        names = LETTERS.get(len(case.where), tuple(f"t{i}" for i in range(len(case.where))))
        values = ", ".join(f"{value:.4g}" for value in case.where)
        told["at"] = f"{names[0]} = {values}" if len(names) == 1 else f"({', '.join(names)}) = ({values})"
    if case.yours:
        told["yours"] = _clean(case.yours, 160)
    if case.expected:
        told["reference"] = _clean(case.expected, 160)
    return told


def _rows_as_text(cases: Sequence[Case]) -> Iterable[tuple[str, str, str]]:
    for name, case in _named(cases):
        sign, said = _result_of(case).split(" ", 1)
        told = _worst_of(case)
        more = [f"off by {told['off by']}"] if "off by" in told else []
        more += [f"at {told['at']}"] if "at" in told else []
        more += [f"yours {told['yours']}"] if "yours" in told else []
        more += [f"reference {told['reference']}"] if "reference" in told else []
        yield sign, _clean(name), _clean("; ".join([said, *more]))


def _numbers(nested: Any) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Nested lists with None for what is not finite, as an array with NaN."""
    return np.asarray(nested, dtype=np.float64)  # None becomes NaN


def _clean(text: str, longest: int = 400, *, lines: bool = False) -> str:
    """Printable text, cut to a length; on one line unless ``lines``."""
    kept = _printable(text)
    if not lines:
        kept = " ".join(kept.split())
    return kept if len(kept) <= longest else kept[: longest - 1] + "…"


def _printable(text: str) -> str:
    """Text without control characters and lone surrogates; ends of lines and tabs stay."""
    return "".join(char for char in text if char.isprintable() or char in "\n\t")


def _escape(text: str) -> str:
    """Text as HTML. $ and \\ stand in elements of their own, so that no MathJax reads a formula into a learner's words."""
    return re.sub(r"([$\\])", r"<span>\1</span>", _html.escape(_printable(text), quote=True))


def _marked_up(text: str) -> str:
    """Escaped text in which `code` is set as code, and a *word* with stress."""
    pieces = _clean(text, LONGEST).split("`")
    if len(pieces) % 2 == 0:  # a backtick without its partner is only a backtick
        return _stressed("`".join(pieces))
    return "".join(f"<code>{_escape(piece)}</code>" if i % 2 else _stressed(piece) for i, piece in enumerate(pieces))


def _stressed(text: str) -> str:
    """Escaped text with *words* between asterisks in italics; a product such as 2*x*y stays what it is."""
    return re.sub(r"(?<![\w*)\]])\*(\w(?:[\w -]*\w)?)\*(?![\w*(\[])", r"<em>\1</em>", _escape(text))
