"""The planned calls of a learner's function: all that marks depend on, made before anything is compared.

Per data set of a map one call with all samples as vectors, one with an open mesh, one with single numbers; for one data set
also two samples alone, an empty array, and the first call once more at the very end. Where hidden data decide, vectors do for
all but the first of the public data sets. Only where vectors are not answered, single points are asked for one by one. No call
depends on whether an earlier answer was right.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from autograder.comparison.answers import Answer, Numbers, Raised, ask, ask_in_turn
from autograder.comparison.samples import read_only
from autograder.comparison.target import Target

PAIR = (-3, -8)  # two low-discrepancy samples, out of order


@dataclass(eq=False)
class Asked:
    """The answers on one data set; None where a call was not made."""

    target: Target
    vector: Answer | None = None
    mesh: Answer | None = None
    scalar: Answer | None = None
    singles: tuple[Answer, ...] | None = None
    pair: Answer | None = None
    empty: Answer | None = None
    again: Answer | None = None

    @property
    def answers(self) -> list[Answer]:
        """Every answer there is."""
        every = [self.vector, self.mesh, self.scalar, *(self.singles or ()), self.pair, self.empty, self.again]
        return [answer for answer in every if answer is not None]

    @property
    def fatal(self) -> Raised | None:
        """The limit or the death that ended the calls."""
        return next((a for a in self.answers if isinstance(a, Raised) and a.fatal), None)


class _Stopped(Exception):
    """No further call can be answered."""


def ask_all(targets: Sequence[Target], call: Callable[..., Any]) -> list[Asked]:
    """Make every planned call, data set by data set; end early where the function can answer no more.

    Once the first data set is answered in the right shape, so will be the others, most likely: the calls that will then be
    made are made in turn, without a pause between them, and what they gave is taken when its time comes.
    """
    asked = [Asked(target) for target in targets]
    whole = bool(targets[0].exercise.parameters) or not any(target.is_tuple for target in targets)
    first = next((a for a in asked if not a.target.drawn.blind and not a.target.raises), None)
    decided = any(target.hidden for target in targets)
    ahead: dict[tuple[Asked, str], Answer] = {}

    def ask_ahead(planned: list[tuple[Asked, str]]) -> None:
        answers = ask_in_turn(call, [_arguments(place, name) for place, name in planned], whole=whole)
        ahead.update(zip(planned, answers, strict=False))

    def put(place: Asked, name: str) -> Answer:
        answer = ahead.pop((place, name), None)
        if answer is None:
            answer = ask(call, _arguments(place, name), whole=whole)
        setattr(place, name, answer)
        if isinstance(answer, Raised) and answer.fatal:
            raise _Stopped
        return answer

    def put_singles(place: Asked) -> None:
        points = place.target.samples.points
        sets = [(*map(float, points[i]), *place.target.arguments) for i in place.target.samples.singles]
        answers = ask_in_turn(call, sets, whole=whole)
        if isinstance(answers[-1], Raised) and answers[-1].fatal:
            place.scalar = answers[-1]
            raise _Stopped
        place.singles = tuple(answers)

    def every_form(place: Asked) -> bool:
        return place.target.hidden or place is first or not decided

    try:
        ask_ahead([(asked[0], name) for name in _forms(asked[0], every_form=every_form(asked[0]))])
        for place in asked:
            _ask_one(place, put, put_singles, every_form=every_form(place))
            if place is asked[0] and _fits(place):
                planned = [(one, name) for one in asked[1:] for name in _forms(one, every_form=every_form(one))]
                planned += [(first, name) for name in _more_forms(first)] if first is not None else []
                ask_ahead(planned)
        if first is not None:
            for name in _more_forms(first):
                put(first, name)
    except _Stopped:
        pass
    return asked


def _ask_one(place: Asked, put: Callable[..., Answer], put_singles: Callable[[Asked], None], *, every_form: bool) -> None:
    target = place.target
    put(place, "vector")
    if not target.exercise.parameters or target.raises or (_fits(place) and not every_form):
        return
    put(place, "mesh")
    scalar = put(place, "scalar")
    if not _fits(place) and _has_shape(scalar, target.values.shape[1:]):
        put_singles(place)


def _forms(place: Asked, *, every_form: bool) -> tuple[str, ...]:
    """What is asked on one data set, if it is answered in the right shape."""
    every_form = every_form and bool(place.target.exercise.parameters) and not place.target.raises
    return ("vector", "mesh", "scalar") if every_form else ("vector",)


def _more_forms(place: Asked) -> tuple[str, ...]:
    """What is asked on the first data set in the end."""
    return ("pair", "empty", "again") if place.target.exercise.parameters else ("again",)


def _arguments(place: Asked, name: str) -> tuple[Any, ...]:
    """The arguments of a call."""
    target = place.target
    if not target.exercise.parameters:
        return tuple(target.arguments)
    samples = target.samples
    parameters: tuple[Any, ...]
    if name == "mesh":
        parameters = samples.open_mesh()
    elif name == "scalar":
        parameters = tuple(map(float, samples.points[-1]))
    elif name == "pair":
        parameters = samples.columns(np.array(PAIR))
    elif name == "empty":
        parameters = tuple(read_only(np.empty(0)) for _ in target.names)
    else:
        parameters = samples.columns()
    return (*parameters, *target.arguments)


def _fits(place: Asked) -> bool:
    """Whether vectors are answered in the right shape, so that the answers to the next calls need not be seen first."""
    target = place.target
    return not target.exercise.parameters or (not target.raises and _has_shape(place.vector, target.values.shape))


def _has_shape(answer: Answer | None, shape: tuple[int, ...]) -> bool:
    return isinstance(answer, Numbers) and answer.values.shape == shape
