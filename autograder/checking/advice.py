"""The cards for everything that is not an answer: check("cylinder"), check(cylinder(...)), a function that is not there."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from autograder.card import Card
from autograder.catalogue import Catalogue
from autograder.checking.shell import Failure
from autograder.exercise import Exercise

if TYPE_CHECKING:
    from autograder.checking.calling import Learner

Parts = tuple[tuple[str, str], ...]


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
    title = f"{name} is not defined"
    if failure is not None:
        return Card("not run", title, failed_cell(name, failure))
    parts = [("What does not", f"There is no function `{name}` in this notebook's memory.")]
    exercise = catalogue.get(name)
    near = _near(name, [known for known, value in defined.items() if callable(value) and not known.startswith("_")])
    if exercise is None and (ids := _near(name, [one.id for one in catalogue])):
        parts.append(("Next", f"Is the name written as in the task? There is an exercise {_or(ids)}."))
    elif near:
        parts.append(
            ("Next", f"You have defined {_or(near)}; the task wants `def {exercise.signature if exercise else name}:`.")
        )
    else:
        wanted = f"`def {exercise.signature}:`" if exercise is not None else "the function"
        parts.append(("Next", f"Run the cell that begins with {wanted} first (Shift+Enter), then this one again."))
        parts.append(("Why", "After a restart of the kernel every cell has to be run again, from the top."))
    return Card("not run", title, tuple(parts))


def failed_cell(name: str, failure: Failure) -> Parts:
    """What happened to the cell that should have defined a function."""
    place = f"Line {failure.line} of that cell" if failure.line else "In that cell"
    parts = [("What does not", f"The cell that should define `{name}` stopped: {failure.exception}: {failure.message}")]
    parts.append(("Where", f"{place}: `{failure.source}`" if failure.source else f"{place}."))
    hint = _syntax_hint(failure) if failure.is_syntax else "Mend that line, run that cell again, then this one."
    parts.append(("Next", hint))
    return tuple(parts)


def older_version(name: str, failure: Failure) -> tuple[str, str]:
    """The warning that what was judged is not what stands in the notebook now."""
    return (
        "Careful",
        f"The newest cell that defines `{name}` stopped ({failure.exception}, line {failure.line}); "
        "judged here is the version from before. Mend that cell and run it first.",
    )


def whose_numbers(student: str) -> tuple[str, str]:
    """For an exercise with numbers of one's own: whose they are."""
    if student:
        return "Your own numbers", f"Some of these data are those of {student}: somebody else has others."
    return "Everybody's numbers", "These data are the same for all. For your own, type your id in the cell that asks for it."


def interrupted(exercise: Exercise, learner: Learner) -> Card:
    """The card where the learner stopped the kernel while the function ran."""
    parts = (
        ("What does not", f"`{exercise.id}` was stopped by you in its call number {learner.calls}."),
        ("Next", "Is there a loop that cannot end, or one that does the same work for every point?"),
    )
    return Card("failed", exercise.title, parts, notes=tuple(learner.notes()))


def _a_name(text: str, catalogue: Catalogue) -> Card:
    exercise = catalogue.get(text)
    name = exercise.id if exercise is not None else next(iter(_near(text, [one.id for one in catalogue])), "cylinder")
    parts = (
        ("What does not", "check takes the function itself, not its name in quotation marks."),
        ("Next", f"Write `check({name})`."),
    )
    return Card("not run", "A name instead of a function", parts)


def _a_result(value: Any) -> Card:
    if value is None:
        what = "check was given nothing (None): the function was called, and it returned nothing"
    elif isinstance(value, np.ndarray):
        what = f"check was given an array of shape {value.shape}: what a function returned"
    else:
        what = f"check was given a value of type {type(value).__name__}: what a function returned"
    parts = (
        ("What does not", f"{what}. It takes the function itself, which it calls with data of its own."),
        ("Next", "Write the name only, without brackets behind it: `check(cylinder)`, not `check(cylinder(...))`."),
    )
    return Card("not run", "A result instead of a function", parts)


def _unknown(f: Any, catalogue: Catalogue, defined: Mapping[str, Any]) -> Card:
    name = name_of(f)
    if name in ("", "<lambda>"):
        own = next((key for key, value in defined.items() if value is f and catalogue.get(key)), None)
        how = f"`def {catalogue.find(own).signature}:`" if own else "as the task shows"
        unnamed = (
            ("What does not", "This function has no name, and its name tells which exercise it answers."),
            ("Next", f"Write it with def: {how}" if own else f"Write it with def, {how}."),
        )
        return Card("not run", "A function without a name", unnamed)
    near = _near(name, [one.id for one in catalogue])
    parts = [("What does not", f"There is no exercise called `{name}`; the name of the function tells which one it answers.")]
    if near:
        wanted = catalogue.find(near[0])
        parts.append(("Next", f"Did you mean {_or(near)}? Then write `def {wanted.signature}:`"))
    else:
        parts.append(("Next", "Keep the name that stands in the task, and check that one."))
        away = "An exercise of your own course is known only where its exercises are: beside the notebook, or installed"
        parts.append(("If it is the name in the task", f"{away}; ask whoever gave you the notebook."))
        parts.append(("There are", ", ".join(one.id for one in catalogue)))
    return Card("not run", f"No exercise {name}", tuple(parts))


def _syntax_hint(failure: Failure) -> str:
    opened = {"(": ")", "[": "]", "{": "}"}
    count = {char: failure.cell.count(char) for char in "()[]{}"}
    unequal = [f"{count[a]} times {a} and {count[b]} times {b}" for a, b in opened.items() if count[a] != count[b]]
    if unequal:
        return f"Count the brackets: that cell has {', '.join(unequal)}. Python often notices only on the line below."
    if failure.exception in ("IndentationError", "TabError"):
        return "Lines of one block begin at the same column: four blanks for each step in, and no tabs."
    return "Read the line above it as well: Python often notices a slip only on the line below."


def _near(name: str, among: list[str]) -> list[str]:
    """Names like this one: misspelt, or in other capitals."""
    folded = {one.lower(): one for one in among}
    return [folded[key] for key in difflib.get_close_matches(name.lower(), list(folded), n=3, cutoff=0.6)]


def _or(names: list[str]) -> str:
    shown = [f"`{name}`" for name in names]
    return " or ".join([", ".join(shown[:-1]), shown[-1]]) if len(shown) > 1 else shown[0]
