"""Findings put into words: places, values, relabellings, data sets."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from autograder import messages
from autograder.comparison import values as value_rungs
from autograder.comparison.answers import Answer, Numbers, Raised, Several, Word
from autograder.comparison.gates import Trouble
from autograder.comparison.maps import Sampled
from autograder.comparison.symmetry import Symmetry
from autograder.comparison.target import Target
from autograder.diagnosis.ladder import Finding
from autograder.messages import listing, number, say, written

Parts = list[tuple[str, str]]

LONGEST_SAYING = 120  # characters of what is said of a data set
PLAIN = 0.05  # of the size: from here on a picture shows a deviation as well as it shows a larger one


def worst_finding(findings: Sequence[Finding]) -> Finding:
    """The finding to show: data that see before blind ones, maps before what has no numbers, the first that is plain.

    An exercise's data sets go from the simple to the special: of two that show a deviation the earlier is easier to read.
    """

    def rank(f: Finding) -> tuple[bool, bool, bool, float]:
        seen = not f.right and f.sampled is not None and np.isfinite(f.sampled.values).all()
        deviation = min(f.sampled.worst, PLAIN) if seen and f.sampled is not None else 0.0
        return not f.right, not f.target.raises, not f.target.drawn.blind, deviation

    return max(findings, key=rank)


def worst_index(f: Sampled) -> int:
    """The sample that is furthest off; of equally bad ones one inside."""
    deviations = np.where(np.isfinite(f.deviations), f.deviations, np.inf)
    inside = f.target.samples.inside[f.indices]
    bad = deviations >= deviations.max() * (1 - 1e-9)
    return int((bad & inside).argmax() if (bad & inside).any() else bad.argmax())


def is_float32(f: Sampled) -> bool:
    """Whether all its values are numbers that float32 can hold, and the right ones rounded to it are near."""
    return bool((f.values.astype(np.float32) == f.values).all()) and f.worst < 1e-5


def pair_written(f: Sampled, i: int) -> tuple[str, str]:
    """The learner's point and the right one, with so many digits that they differ."""
    size = float(np.abs(f.expected[i]).max(initial=0.0)) or f.target.size
    digits = messages.digits_for(float(f.deviations[i]), size)
    # A coordinate that is a rounding error beside the whole is written 0, where the point itself is the origin as well.
    yours, expected = (np.where(np.abs(point) < 1e-12 * f.target.size, 0.0, point) for point in (f.values[i], f.expected[i]))
    return written(yours, digits), written(expected, digits)


def value_wrong(finding: Finding, answer: Answer, expected: Answer) -> Parts:
    """What is wrong with a value."""
    if isinstance(expected, Several):
        items = value_rungs.as_items(answer, len(expected.items))
        if items is None:
            count = len(answer.items) if isinstance(answer, Several) else 1
            return [("wrong", say("wrong.tuple", expected=len(expected.items), yours=count))]
        k = finding.facts.get("item")
        if k is None:
            return [("wrong", say("wrong.value"))]
        parts: Parts = [("wrong", say("wrong.item", item=k))]
        if finding.pattern is not None:
            return [*parts, ("wrong", pattern_text(finding))]
        return parts
    if isinstance(expected, Word):
        return [("wrong", word_text(answer, expected, finding))]
    truth = isinstance(expected, Numbers) and expected.was == "bool" and expected.values.ndim == 0
    if isinstance(answer, Word):
        return [("wrong", say("wrong.not_truth" if truth else "wrong.not_number", yours=answer.text[:40]))]
    if truth and isinstance(answer, Numbers) and answer.values.ndim == 0:
        facts = {"yours": spoken_answer(answer, "bool"), "expected": spoken_answer(expected)}
        return [("wrong", say("wrong.yes_no", **facts))]
    if finding.pattern is not None:
        return [("wrong", pattern_text(finding))]
    return [("wrong", say("wrong.value"))]


def sense_text(findings: Sequence[Finding]) -> str | None:
    """What single numbers that are wrong, and are no fixed multiple of the right ones, have in common over the data sets."""
    differences = []
    for finding in findings:
        answer, expected = finding.gated.answer, finding.target.expected
        if not isinstance(answer, Numbers) or not isinstance(expected, Numbers) or expected.was == "bool":
            return None
        if answer.values.ndim or expected.values.ndim:
            return None
        differences.append(float(answer.values - expected.values))
    found = value_rungs.sense(differences)
    if found is None or any(finding.pattern is not None for finding in findings):
        return None
    return say(found.key, **{key: number(value, 6) for key, value in found.facts.items()})


def word_text(answer: Answer, expected: Word, finding: Finding) -> str:
    """What is wrong with a word."""
    if not isinstance(answer, Word):
        return say("wrong.not_word", yours=spoken_answer(answer))
    if answer.text.strip().lower() == expected.text.strip().lower():
        return say("wrong.word_case", yours=answer.text[:40])
    return say("wrong.word", yours=answer.text[:40])


def pattern_text(finding: Finding) -> str:
    """A pattern in words."""
    assert finding.pattern is not None
    facts = {k: number(v, 6) if isinstance(v, float) else v for k, v in finding.pattern.facts.items()}
    return say(finding.pattern.key, **facts)


def value_where(finding: Finding, data: str) -> Parts:
    """The entry that is furthest off, with both entries."""
    answer, expected = finding.gated.answer, finding.target.expected
    if answer is None or isinstance(expected, Raised):
        return []
    if isinstance(expected, Word) or isinstance(answer, Word):
        return [("where", say("where.word", data=data, yours=spoken_answer(answer)))]
    entry = value_rungs.worst(finding.target, answer, expected)
    if entry is None:
        return [("where", say("where.data", data=data))]
    if isinstance(expected, Numbers) and expected.was == "bool":
        yours, right = spoken_truth(entry.yours), spoken_truth(entry.expected)
    else:
        digits = messages.digits_for(abs(entry.yours - entry.expected), abs(entry.expected) or 1.0)
        yours, right = number(entry.yours, digits), number(entry.expected, digits)
    at = say("where.index", index=list(entry.index)) if entry.index else ""
    if entry.item is not None:
        key = "where.index_of_element" if at else "where.element"
        at = say(key, index=list(entry.index), item=entry.item)
    key = "where.entry" if at else "where.number"
    return [("where", say(key, data=data, place=at, yours=yours, expected=right))]


def spoken_truth(value: Any) -> str:
    """True or False for the number of a mask."""
    return str(bool(value)) if float(value) in (0.0, 1.0) else number(float(value))


def spoken_answer(answer: Answer, was: str | None = None) -> str:
    """An answer in a few words."""
    if isinstance(answer, Numbers):
        if answer.values.ndim == 0:
            truth = (was or answer.was) == "bool"
            return spoken_truth(answer.values) if truth else number(float(answer.values), 6)
        return say("told.array", shape=answer.values.shape) if answer.values.size > 4 else written(answer.values)
    if isinstance(answer, Word):
        return repr(answer.text[:40])
    if isinstance(answer, Several):
        return "(" + ", ".join(spoken_answer(item) for item in answer.items[:4]) + ")"
    return "None"


def relabelled(symmetry: Symmetry) -> str:
    """A relabelling in words."""
    key = f"relabel.{symmetry.name}"
    if key in messages.TEXT:
        return say(key)
    return say("relabel.other", formula=symmetry.formula, names=", ".join(symmetry.names))


def spoken(id: str) -> str:
    """A mistake's id as words."""
    return id.replace("_", " ")


def named(names: Sequence[str] | set[str]) -> str:
    """``the data set a``, ``the data sets a and b``."""
    every = sorted(names) if isinstance(names, set) else list(names)
    return say("data.one" if len(every) == 1 else "data.many", names=listing(every))


def described(target: Target) -> str:
    """A data set with what is said of it and those of its arguments that are short enough to read."""
    shown = [
        f"{name} = {repr(value) if isinstance(value, str) else written(value)}"
        for name, value in target.drawn.arguments.items()
        if isinstance(value, str | bool | int | float) or (isinstance(value, np.ndarray) and value.size <= 3)
    ]
    says = target.drawn.says.rstrip(".") if target.exercise.kind != "label" else ""  # or it would tell the answer
    told = ([says] if 0 < len(says) <= LONGEST_SAYING else []) + ([", ".join(shown)] if shown else [])
    return say("data.with", name=target.name, arguments="; ".join(told)) if told else target.name


def trouble_text(trouble: Trouble) -> str:
    """A form of input that is not handled, in words."""
    return say(trouble.key, **{**trouble.facts, "given": given_text(trouble.facts), "names": listing(trouble.facts["names"])})


def given_text(facts: dict[str, Any]) -> str:
    """A form of input in words."""
    return say(f"given.{facts['form']}", shapes=facts["given"])
