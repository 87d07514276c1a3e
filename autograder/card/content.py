"""What a card says, before it is HTML or plain text: outcome, parts with a heading each, and the table of data sets."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from operator import itemgetter

from autograder.messages import amount, number, say
from autograder.result import PARTS, Case, Outcome, Tier, Verdict

# The sign of each outcome, and the ground of its badge: white text has a contrast of at least 5 on each.
OUTCOMES: dict[Outcome, tuple[str, str]] = {
    "passed": ("✓", "#00704F"),
    "partial": ("◐", "#8A5A00"),
    "failed": ("✗", "#A8430A"),
    "not run": ("○", "#5F6670"),
    "could not judge": ("?", "#7A3E8E"),
}
SIGNS: dict[Tier, str] = {
    "identical": "✓",
    "mistake": "✗",
    "relabelled": "⇄",
    "other start": "↻",
    "close": "≈",
    "same set": "≅",
    "covered": "≅",
    "part": "⊂",
    "more": "⊃",
    "moved": "↷",
    "different": "✗",
    "error": "!",
    "timeout": "!",
    "shape": "!",
    "not finite": "!",
    "not pointwise": "!",
    "not repeatable": "!",
}
COLUMNS = ("off", "at", "yours", "reference")  # of the table, where some data set has something to say
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
    named = [(heading(name), text) for name, text in verdict.parts if text]
    # Sentences that follow each other under one heading are one paragraph.
    parts = [(name, " ".join(text for _, text in said)) for name, said in groupby(named, key=itemgetter(0))]
    if not parts and verdict.message:
        parts = [("", verdict.message)]
    if verdict.terms:
        parts.append((say("part.worth"), worth(verdict)))
    cases = verdict.cases if verdict.outcome != "not run" else ()
    return Card(verdict.outcome, verdict.title or verdict.exercise, tuple(parts), cases, tuple(notes))


def heading(part: str) -> str:
    """The heading of a part; that of a foreign verdict is called as it calls it."""
    return say(f"part.{part}") if part in PARTS else part.capitalize()


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
    shown += [say("table.many_hidden", count=hidden)] if hidden else []
    key = "table.all" if len(cases) > 1 else "table.one"
    return say(key, result=results.pop(), count=len(cases), names=", ".join(shown))


def by_name(cases: Sequence[Case]) -> list[tuple[str, Case]]:
    """Each data set by its name; hidden ones of one result together, since nothing more is told of them."""
    rows = [(_data_of(case), case) for case in cases if not case.hidden]
    hidden = [case for case in cases if case.hidden]
    for result in dict.fromkeys(map(result_of, hidden)):
        alike = [case for case in hidden if result_of(case) == result]
        rows.append((say("table.many_hidden", count=len(alike)) if len(alike) > 1 else _data_of(alike[0]), alike[0]))
    return rows


def columns_of(cases: Sequence[Case]) -> list[str]:
    """Only the columns in which some data set has something to say."""
    told = [worst_of(case) for case in cases]
    return ["data", "result", *(name for name in COLUMNS if any(row.get(name) for row in told))]


def _data_of(case: Case) -> str:
    name = case.data
    return say("table.hidden", name=name) if case.hidden else say("table.blind", name=name) if case.blind else name


def word_of(outcome: Outcome) -> str:
    """What an outcome is called on its badge."""
    return say(f"outcome.{outcome.replace(' ', '_')}")


def result_of(case: Case) -> str:
    """The rung of a data set with its sign, and the slip by its name."""
    if case.mistake and case.tier != "identical":
        said = say("tier.mistake_named", name=case.mistake)
    else:
        said = say(f"tier.{case.tier.replace(' ', '_')}")
    return f"{SIGNS[case.tier]} {said}"


def worst_of(case: Case) -> dict[str, str]:
    """Deviation, place and both values of a data set that is not right."""
    if case.hidden or case.tier == "identical":
        return {}
    told: dict[str, str] = {}
    if case.deviation is not None and math.isfinite(case.deviation):
        told["off"] = amount(case.deviation)
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
    if text.isprintable():
        return text
    return "".join(char for char in text if char.isprintable() or char in "\n\t")
