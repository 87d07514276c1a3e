"""What a card says, before it is HTML or plain text: outcome, parts with a heading each, and the table of data sets."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from operator import itemgetter

from autograder.messages import amount, number, say
from autograder.result import Case, Outcome, Tier, Verdict

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
PARTS = {"right": "What holds", "wrong": "What does not", "where": "Where", "look": "Next"}
LETTERS = {1: ("u",), 2: ("u", "w"), 3: ("u", "v", "w")}
LONGEST = 1200  # characters of one part
LONGEST_NOTE = 2400


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


def all_alike(cases: Sequence[Case]) -> str:
    """One line where no data set has anything of its own to tell: ``✓ right on all 2: lecture, any_size``."""
    results = {result_of(case) for case in cases}
    if len(results) != 1 or any(worst_of(case) for case in cases):
        return ""
    names = [_data_of(case) for case in cases]
    hidden = sum(case.hidden for case in cases)
    shown = [name for name, case in zip(names, cases, strict=True) if not case.hidden]
    shown += [f"{hidden} hidden"] if hidden else []
    many = f"on all {len(cases)}: " if len(cases) > 1 else "on "
    return f"{results.pop()} {many}{', '.join(shown)}"


def by_name(cases: Sequence[Case]) -> list[tuple[str, Case]]:
    """Each data set by its name; hidden ones of one result together, since nothing more is told of them."""
    rows = [(_data_of(case), case) for case in cases if not case.hidden]
    hidden = [case for case in cases if case.hidden]
    for result in dict.fromkeys(map(result_of, hidden)):
        alike = [case for case in hidden if result_of(case) == result]
        rows.append((f"{len(alike)} hidden" if len(alike) > 1 else _data_of(alike[0]), alike[0]))
    return rows


def columns_of(cases: Sequence[Case]) -> list[str]:
    """Only the columns in which some data set has something to say."""
    told = [worst_of(case) for case in cases]
    return [
        "data set",
        "result",
        *(name for name in ("off by", "at", "yours", "reference") if any(row.get(name) for row in told)),
    ]


def _data_of(case: Case) -> str:
    return f"{case.data} (hidden)" if case.hidden else f"{case.data} (blind)" if case.blind else case.data


def result_of(case: Case) -> str:
    """The rung of a data set with its sign, and the slip by its name."""
    sign, said = TIERS[case.tier]
    if case.mistake and case.tier != "identical":
        said = say("tier.named_mistake", name=case.mistake)
    return f"{sign} {said}"


def worst_of(case: Case) -> dict[str, str]:
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
        told["yours"] = clean(case.yours, 160)
    if case.expected:
        told["reference"] = clean(case.expected, 160)
    return told


def clean(text: str, longest: int = 400, *, lines: bool = False) -> str:
    """Printable text, cut to a length; on one line unless ``lines``."""
    kept = printable(text)
    if not lines:
        kept = " ".join(kept.split())
    return kept if len(kept) <= longest else kept[: longest - 1] + "…"


def printable(text: str) -> str:
    """Text without control characters and lone surrogates; ends of lines and tabs stay."""
    return "".join(char for char in text if char.isprintable() or char in "\n\t")
