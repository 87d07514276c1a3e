"""Whether an answer is wrong only because an earlier function of the same notebook is, on which it is built.

An exercise may state how it is built from earlier ones (:meth:`Exercise.built_from`). That right formula is worked out here, on
the trusted side, with the learner's own earlier functions in it. Where it gives just what the learner's function gives, the
later function is right as far as it goes, and only the earlier one is to be put right. Where it does not, or nothing is stated,
no more is said than that the one calls the other: a right function may use a wrong one in another way than the formula does.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from autograder.comparison import values as value_rungs
from autograder.comparison.answers import Answer, Numbers, Raised, ask
from autograder.comparison.gates import plain
from autograder.comparison.maps import Sampled, agree
from autograder.comparison.target import Target
from autograder.curvedata import as_curve
from autograder.diagnosis.ladder import Finding
from autograder.diagnosis.wording import Parts
from autograder.errors import SandboxError
from autograder.exercise import Construction, Exercise
from autograder.messages import listing, say
from autograder.result import PARTS

MOST_CALLS = 200
ROOM = 100  # times the tolerance: two ways to build on the same wrong function round differently


@dataclass(frozen=True)
class Earlier:
    """An earlier function of the notebook that the judged one calls, and that is not right: its exercise and how to call it.

    ``written`` is False where it is still the stub.
    """

    exercise: Exercise
    call: Callable[..., Any]
    written: bool = True


class _Spent(Exception):
    """The earlier functions were called too often."""


def explained(findings: Sequence[Finding], earlier: Sequence[Earlier]) -> bool:
    """Whether the earlier functions explain what is found on every data set, shown or hidden."""
    if not earlier or all(f.right for f in findings):
        return False
    ids = {one.exercise.id for one in earlier}
    fitting = [c for c in findings[0].target.exercise.constructions if ids <= {block.id for block in c.blocks}]
    ordered = sorted(findings, key=lambda f: f.right)  # most claims that do not hold end at the first
    return any(all(_gives(f, construction, earlier) for f in ordered) for construction in fitting)


def _gives(finding: Finding, construction: Construction, earlier: Sequence[Earlier]) -> bool:
    """Whether the formula with the learner's earlier functions gives the learner's answer on this data set."""
    target, gated = finding.target, finding.gated
    calls = {one.exercise.id: _counted(one.call) for one in earlier}
    blocks = [calls.get(block.id, block.reference) for block in construction.blocks]
    parameters = target.samples.columns() if target.exercise.parameters else ()
    try:
        built = ask(lambda *arguments: construction.formula(*arguments, *blocks), (*parameters, *target.arguments), whole=False)
    except (SandboxError, _Spent):
        return False
    if gated.stopped is not None and "exception" in gated.stopped.facts:
        return isinstance(built, Raised) and bool(built.exception) and gated.stopped.facts["exception"] == built.exception
    if gated.sampled is not None:
        return _same_map(target, gated.sampled, built)
    return gated.answer is not None and _same_value(target, gated.answer, built)


def _same_map(target: Target, f: Sampled, built: Answer) -> bool:
    values = built.values if isinstance(built, Numbers) else np.empty(0)
    if target.exercise.judged_as is not None and not isinstance(built, Raised):
        try:
            values = target.surface(plain(built))(target.samples.points)
        except Exception:  # whatever the exercise's own function says of a net that it cannot take
            return False
    if values.shape != target.values.shape:
        return False
    largest = float(np.abs(f.values[np.isfinite(f.values)]).max(initial=0.0))
    return agree(f.values, values[f.indices], target.allowed + ROOM * target.exercise.tolerance * max(target.size, largest))


def _same_value(target: Target, answer: Answer, built: Answer) -> bool:
    if isinstance(answer, Raised):
        return isinstance(built, Raised) and answer.exception == built.exception
    return value_rungs.same(target, answer, built, near=ROOM * target.exercise.tolerance)


def _counted(call: Callable[..., Any]) -> Callable[..., Any]:
    """An earlier function as the formula calls it: with plain data, and not for ever."""
    calls = 0

    def counted(*arguments: Any) -> Any:
        nonlocal calls
        calls += 1
        if calls > MOST_CALLS:
            raise _Spent
        return call(*(as_curve(one) if callable(one) else one for one in arguments))

    return counted


def with_earlier(parts: Parts, id: str, earlier: Sequence[Earlier], *, proved: bool) -> Parts:
    """The parts of a message with what is to be said of the earlier functions; ``proved``: they explain all of it."""
    names = listing(f"`{one.exercise.id}`" for one in earlier)
    some = "_many" if len(earlier) > 1 else ""
    if proved:
        kept = [(name, text) for name, text in parts if name in ("right", "where")]
        told = [("right", say("right.built", id=f"`{id}`", names=names)), ("wrong", say(f"wrong.built{some}", names=names))]
        every = [*kept, *told, ("look", say("look.built", id=f"`{id}`", names=names))]
    else:
        every = [("look", say(f"look.calls{some}", id=f"`{id}`", names=names)), *parts]
    return sorted(every, key=lambda part: PARTS.index(part[0]))


def not_written_earlier(id: str, earlier: Sequence[Earlier]) -> Parts:
    """The parts of a message where the function ends in the stub of an earlier one."""
    names = listing(f"`{one.exercise.id}`" for one in earlier)
    some = "_many" if len(earlier) > 1 else ""
    return [
        ("wrong", say(f"error.stub_earlier{some}", id=f"`{id}`", names=names)),
        ("look", say("look.stub_earlier", names=names)),
    ]
