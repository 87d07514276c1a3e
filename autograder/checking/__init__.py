"""``check(f)`` in a notebook and ``judge_function(id, f)`` from Python.

calling      the learner's function, called so that its errors have a line and its prints do not spill
earlier      the earlier functions that it calls and that are not right
signature    whether it can be called with the arguments of the exercise
advice       the cards for everything that is not an answer: a name, a result, a missing function
shell        IPython: showing cards, and remembering which cell failed to define a function
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn

from autograder import card, personal, uses
from autograder.catalogue import Catalogue, around
from autograder.checking import advice, shell
from autograder.checking.calling import Learner
from autograder.checking.earlier import used_by
from autograder.checking.signature import trouble_with
from autograder.errors import CheckFailed, CourseError
from autograder.exercise import PUBLIC_SEED, Exercise
from autograder.judge import judge
from autograder.messages import say
from autograder.result import Verdict

__all__ = ["check", "judge_function"]


def check(f: Callable[..., Any]) -> float:
    """Judge a function against the exercise of its name, show the verdict, and return the points.

    Parameters
    ----------
    f : callable
        The function itself, ``check(cylinder)``; its name says which exercise it answers.

    Returns
    -------
    float
        The points on the public data, between 0 and the exercise's.

    Raises
    ------
    CheckFailed
        If nothing is right, or nothing could be judged; the card above says why. Its traceback is one line.
    CourseError
        Where nbgrader autogrades without the bridge: marks are then given by the bridge or not at all.
    """
    _refuse_to_grade()
    known = exercises()
    exercise = known.get(advice.name_of(f)) if callable(f) else None
    if exercise is None:
        _stop(advice.no_exercise(f, known, shell.defined()))
    exercise = exercise.of_student(personal.seed_here())
    trouble = trouble_with(exercise, f)
    if trouble is not None and not trouble.callable:
        _stop(trouble.card(exercise))
    learner = Learner(f)
    try:
        with learner.quiet():
            verdict = judge(exercise, learner, seed=PUBLIC_SEED, earlier=lambda: used_by(f, known))
    except KeyboardInterrupt:
        _stop(advice.interrupted(exercise, learner))
    _show(exercise, f, verdict, learner)
    if verdict.fraction == 0.0:
        raise CheckFailed(_short(exercise, verdict))
    return verdict.points(exercise.points)


def judge_function(id: str, f: Callable[..., Any], seed: int | str | bytes = PUBLIC_SEED) -> Verdict:
    """The verdict on a function as the answer to the exercise of that id; shows nothing.

    Raises
    ------
    ExerciseError
        If there is no such exercise.
    """
    exercise = exercises().find(id)
    learner = Learner(f)
    with learner.quiet():
        return judge(exercise, learner, seed=seed)


def exercises() -> Catalogue:
    """All that ``check`` knows here: see :mod:`autograder.catalogue`."""
    return around(Path.cwd())


def _show(exercise: Exercise, f: Callable[..., Any], verdict: Verdict, learner: Learner) -> None:
    shown = card.of(verdict, notes=learner.notes())
    more = [advice.whose_numbers(personal.student_here())] if exercise.personal else []
    if verdict.fraction > 0.0:
        more += advice.not_there(exercise, uses.modules(f))
    stale = shell.failure_of(exercise.id)
    if stale is not None:
        more.append(advice.older_version(exercise.id, stale))
    trouble = trouble_with(exercise, f)
    if trouble is not None and verdict.outcome != "passed":
        more.append((say("part.arguments"), trouble.said))
    shell.show(card.bundle(card.with_parts(shown, more)))
    figure = card.figure_bundle(verdict)
    if figure is not None and shell.shows_figures():
        shell.show(figure)


def _missing(name: str) -> dict[str, Any]:
    return card.bundle(advice.missing(name, shell.failure_of(name), exercises(), shell.defined()))


def _stop(shown: card.Card) -> NoReturn:
    shell.show(card.bundle(shown))
    raise CheckFailed(say("stop.card", title=shown.title)) from None


def _short(exercise: Exercise, verdict: Verdict) -> str:
    key = {"not run": "stop.not_written", "could not judge": "stop.not_judged"}.get(verdict.outcome, "stop.not_right")
    return say(key, id=exercise.id)


def _refuse_to_grade() -> None:
    """Stock nbgrader would run this in the learner's own process, where any answer can be forged."""
    if os.environ.get("NBGRADER_EXECUTION") == "autograde":
        message = (
            "check() gives no marks inside the learner's own process, where they could be forged. Add two lines to "
            "nbgrader_config.py: `import autograder.bridge` and `autograder.bridge.configure(c)`, then autograde again "
            "(or use `directrix grade`). This notebook has not been judged."
        )
        print(message, file=sys.stderr)
        raise CourseError(message)


shell.listen(_missing)
