"""The earlier functions of the notebook that a function calls and that are not right, judged in their turn."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from autograder import uses
from autograder.catalogue import Catalogue
from autograder.checking.calling import Learner
from autograder.diagnosis.earlier import Earlier
from autograder.judge import judge


def used_by(f: Callable[..., Any], known: Catalogue) -> list[Earlier]:
    """Earlier functions that ``f`` looks up among its globals, as far as they answer exercises and are not right."""
    defined = getattr(getattr(f, "pyfunc", f), "__globals__", {})
    found = []
    for id in uses.in_function(f, [exercise.id for exercise in known]):
        function, exercise = defined.get(id), known.find(id)
        if not callable(function):
            continue
        verdict = judge(exercise, Learner(function), figure=False, search=False)
        if verdict.outcome in ("partial", "failed", "not run"):
            found.append(Earlier(exercise, Learner(function), written=verdict.outcome != "not run"))
    return found
