"""The cards for everything that is not an answer: check("cylinder"), check(cylinder(...)), a function that is not there."""

from __future__ import annotations

import difflib
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from autograder.card import Card
from autograder.catalogue import Catalogue
from autograder.checking.shell import Failure
from autograder.exercise import Exercise
from autograder.messages import say

if TYPE_CHECKING:
    from autograder.checking.calling import Learner

OFFERED = ("numpy", "plotly")  # packages that every exercise notebook finds where marks are given
ALWAYS = ("IPython", "autograder", "directrix")
Part = tuple[str, str]
Parts = tuple[Part, ...]


def name_of(f: Any) -> str:
    """The name a function was defined under, through functools.partial and wrappers; empty where it has none."""
    while hasattr(f, "func") and not hasattr(f, "__name__"):
        f = f.func
    return str(getattr(f, "__name__", ""))


def no_exercise(f: Any, catalogue: Catalogue, defined: Mapping[str, Any]) -> Card:
    """The card where what was handed to check names no exercise."""
    if isinstance(f, str):
        return _a_name(f, catalogue)
    if callable(f):
        return _unknown(f, catalogue, defined)
    return _a_result(f)


def missing(name: str, failure: Failure | None, catalogue: Catalogue, defined: Mapping[str, Any]) -> Card:
    """The card for ``check(name)`` where no such name is defined."""
    title = say("check.missing.title", name=name)
    if failure is not None:
        return Card("not run", title, failed_cell(name, failure))
    parts = [_wrong("check.missing", name=name)]
    exercise = catalogue.get(name)
    near = _near(name, [known for known, value in defined.items() if callable(value) and not known.startswith("_")])
    if exercise is None and (ids := _near(name, [one.id for one in catalogue])):
        parts.append(_look("check.missing.exercise", names=_or(ids)))
    elif near:
        parts.append(_look("check.missing.near", names=_or(near), signature=exercise.signature if exercise else name))
    else:
        run = _look("check.missing.run", signature=exercise.signature) if exercise else _look("check.missing.run_any")
        parts += [run, (say("part.why"), say("check.missing.why"))]
    return Card("not run", title, tuple(parts))


def failed_cell(name: str, failure: Failure) -> Parts:
    """What happened to the cell that should have defined a function."""
    place = f"check.cell.{'line' if failure.line else 'somewhere'}{'_source' if failure.source else ''}"
    return (
        _wrong("check.cell", name=name, exception=failure.exception, message=failure.message),
        (say("part.where"), say(place, line=failure.line, source=failure.source)),
        (say("part.look"), _syntax_hint(failure) if failure.is_syntax else say("check.cell.look")),
    )


def older_version(name: str, failure: Failure) -> Part:
    """The warning that what was judged is not what stands in the notebook now."""
    return say("part.careful"), say("check.older", name=name, exception=failure.exception, line=failure.line)


def whose_numbers(student: str) -> Part:
    """For an exercise with numbers of one's own: whose they are."""
    if student:
        return say("part.own_numbers"), say("check.own_numbers", student=student)
    return say("part.all_numbers"), say("check.all_numbers")


def not_there(exercise: Exercise, used: Sequence[str]) -> Parts:
    """Warnings of what a function uses and will not find where marks are given, from the names of the modules it uses."""
    there = (*OFFERED, *exercise.allow)
    own = [name for name in used if name.partition(".")[0] == "directrix" and name.split(".")[1:2] != ["plot"]]
    others = {name.partition(".")[0] for name in used if _installed(name)} - {*there, *ALWAYS}
    told = []
    if own:
        told.append((say("part.careful"), say("check.not_there.library", names=_listed(own))))
    if others:
        told.append((say("part.careful"), say("check.not_there", names=_listed(sorted(others)), there=", ".join(there))))
    return tuple(told)


def interrupted(exercise: Exercise, learner: Learner) -> Card:
    """The card where the learner stopped the kernel while the function ran."""
    parts = (_wrong("check.interrupted", id=exercise.id, calls=learner.calls), _look("check.interrupted.look"))
    return Card("failed", exercise.title, parts, notes=tuple(learner.notes()))


def _wrong(key: str, **facts: Any) -> Part:
    return say("part.wrong"), say(key, **facts)


def _look(key: str, **facts: Any) -> Part:
    return say("part.look"), say(key, **facts)


def _a_name(text: str, catalogue: Catalogue) -> Card:
    exercise = catalogue.get(text)
    name = exercise.id if exercise is not None else next(iter(_near(text, [one.id for one in catalogue])), "cylinder")
    return Card("not run", say("check.name.title"), (_wrong("check.name"), _look("check.name.look", name=name)))


def _a_result(value: Any) -> Card:
    if value is None:
        what = say("check.result.none")
    elif isinstance(value, np.ndarray):
        what = say("check.result.array", shape=value.shape)
    else:
        what = say("check.result.other", type=type(value).__name__)
    parts = ((say("part.wrong"), f"{what} {say('check.result.takes')}"), _look("check.result.look"))
    return Card("not run", say("check.result.title"), parts)


def _unknown(f: Any, catalogue: Catalogue, defined: Mapping[str, Any]) -> Card:
    name = name_of(f)
    if name in ("", "<lambda>"):
        own = next((key for key, value in defined.items() if value is f and catalogue.get(key)), None)
        known = catalogue.find(own).signature if own else None
        look = _look("check.unnamed.look_known", signature=known) if known else _look("check.unnamed.look")
        return Card("not run", say("check.unnamed.title"), (_wrong("check.unnamed"), look))
    near = _near(name, [one.id for one in catalogue])
    parts = [_wrong("check.unknown", name=name)]
    if near:
        parts.append(_look("check.unknown.near", names=_or(near), signature=catalogue.find(near[0]).signature))
    else:
        parts.append(_look("check.unknown.look"))
        parts.append((say("part.away"), say("check.unknown.away")))
        parts.append((say("part.known"), ", ".join(one.id for one in catalogue)))
    return Card("not run", say("check.unknown.title", name=name), tuple(parts))


def _syntax_hint(failure: Failure) -> str:
    opened = {"(": ")", "[": "]", "{": "}"}
    count = {char: failure.cell.count(char) for char in "()[]{}"}
    unequal = [
        say("check.syntax.bracket", opened=count[a], opening=a, closed=count[b], closing=b)
        for a, b in opened.items()
        if count[a] != count[b]
    ]
    if unequal:
        return say("check.syntax.brackets", counts=", ".join(unequal))
    return say("check.syntax.indentation" if failure.exception in ("IndentationError", "TabError") else "check.syntax.other")


def _near(name: str, among: list[str]) -> list[str]:
    """Names like this one: misspelt, or in other capitals."""
    folded = {one.lower(): one for one in among}
    return [folded[key] for key in difflib.get_close_matches(name.lower(), list(folded), n=3, cutoff=0.6)]


def _installed(module: str) -> bool:
    """Whether it is of an installed package: not of Python itself, and no file beside the notebook."""
    file = getattr(sys.modules.get(module.partition(".")[0]), "__file__", None) or ""
    return bool({"site-packages", "dist-packages"} & set(Path(file).parts))


def _listed(names: Sequence[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


def _or(names: list[str]) -> str:
    shown = [f"`{name}`" for name in names]
    return say("or").join([", ".join(shown[:-1]), shown[-1]]) if len(shown) > 1 else shown[0]
