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

from autograder.comparison.answers import Answer, Numbers, Raised, ask
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
    """Make every planned call, data set by data set; end early where the function can answer no more."""
    asked = [Asked(target) for target in targets]
    whole = bool(targets[0].exercise.parameters) or not any(target.is_tuple for target in targets)

    def put(place: Asked, name: str, *parameters: Any) -> Answer:
        answer = ask(call, (*parameters, *place.target.arguments), whole=whole)
        setattr(place, name, answer)
        if isinstance(answer, Raised) and answer.fatal:
            raise _Stopped
        return answer

    first = next((a for a in asked if not a.target.drawn.blind and not a.target.raises), None)
    decided = any(target.hidden for target in targets)
    try:
        for place in asked:
            _ask_one(place, put, every_form=place.target.hidden or place is first or not decided)
        if first is not None:
            _ask_more(first, put)
    except _Stopped:
        pass
    return asked


def _ask_one(place: Asked, put: Callable[..., Answer], *, every_form: bool) -> None:
    target = place.target
    if not target.exercise.parameters:
        put(place, "vector")
        return
    samples = target.samples
    vector = put(place, "vector", *samples.columns())
    if target.raises or (_has_shape(vector, target.values.shape) and not every_form):
        return
    put(place, "mesh", *samples.open_mesh())
    scalar = put(place, "scalar", *(float(x) for x in samples.points[-1]))
    tail = target.values.shape[1:]
    if not _has_shape(vector, target.values.shape) and _has_shape(scalar, tail):
        place.singles = tuple(put(place, "scalar", *(float(x) for x in samples.points[i])) for i in samples.singles)
        place.scalar = scalar


def _ask_more(place: Asked, put: Callable[..., Answer]) -> None:
    target = place.target
    if target.exercise.parameters:
        put(place, "pair", *target.samples.columns(np.array(PAIR)))
        put(place, "empty", *(read_only(np.empty(0)) for _ in target.names))
        put(place, "again", *target.samples.columns())
    else:
        put(place, "again")


def _has_shape(answer: Answer, shape: tuple[int, ...]) -> bool:
    return isinstance(answer, Numbers) and answer.values.shape == shape
