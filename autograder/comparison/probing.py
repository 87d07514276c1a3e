"""A learner's map as a black box for the dear rungs, within a stated number of calls and of points.

Only those rungs call it after something has been compared, so no full mark hangs on these calls. Where the function fails or
the budget is spent, the search ends and the cheaper finding stands.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from autograder.comparison.answers import Array, Numbers, ask
from autograder.comparison.gates import Gated
from autograder.comparison.samples import read_only

MOST_CALLS = 600
MOST_POINTS = 120_000


class Exhausted(Exception):
    """The budget is spent, or the function gave no usable answer."""


class Probe:
    """Points (N, n) of parameters to points (N, 3), asked of the learner's function as vectors."""

    def __init__(self, gated: Gated, call: Callable[..., Any]) -> None:
        self.gated = gated
        self.call = call
        self.calls = 0
        self.points = 0

    @property
    def possible(self) -> bool:
        """Whether the function takes vectors, or its answer is a surface that is at hand."""
        return self.gated.surface is not None or "vector" not in {t.form for t in self.gated.troubles}

    def __call__(self, points: Array) -> Array:
        """Values at the parameters."""
        if self.gated.surface is not None:
            return self.gated.surface(points)
        self.calls += 1
        self.points += len(points)
        if self.calls > MOST_CALLS or self.points > MOST_POINTS:
            raise Exhausted
        columns = tuple(read_only(np.ascontiguousarray(column)) for column in points.T)
        answer = ask(self.call, (*columns, *self.gated.target.arguments), whole=True)
        if not isinstance(answer, Numbers) or answer.values.shape != (len(points), *self.gated.target.values.shape[1:]):
            raise Exhausted
        return answer.values
