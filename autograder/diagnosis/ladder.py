"""From answers that passed the gates to findings: the rung of the ladder and the known mistake.

A finding is made per data set; :func:`recognise` looks at all of them together, since a mistake must explain every data set.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from autograder.comparison import values as value_rungs
from autograder.comparison.answers import Answer, Array, Numbers, Raised, Several, Word
from autograder.comparison.gates import Gated
from autograder.comparison.maps import CLOSE, Sampled, Shifted, agree, other_start, relabellings
from autograder.comparison.symmetry import Symmetry
from autograder.comparison.target import Target
from autograder.comparison.values import Pattern
from autograder.exercise import Mistake
from autograder.result import GATES, LADDER, Tier

NEARER = 10  # a mistake is met "closely" only where the right answer is at least so many times farther away


@dataclass(eq=False)
class Finding:
    """How one data set was answered: its rung, and what the rung has to tell."""

    gated: Gated
    tier: Tier
    symmetries: tuple[Symmetry, ...] = ()
    shifted: Shifted | None = None
    pattern: Pattern | None = None
    facts: dict[str, Any] = field(default_factory=dict)

    @property
    def target(self) -> Target:
        """The data set."""
        return self.gated.target

    @property
    def sampled(self) -> Sampled | None:
        """The learner's map, if the answer is one and passed the gates."""
        return self.gated.sampled if self.gated.stopped is None else None

    @property
    def right(self) -> bool:
        """Whether nothing is wrong on this data set."""
        return self.tier == "identical"


@dataclass(frozen=True)
class Recognised:
    """A known mistake that explains every data set; ``close``: but for a rounded constant."""

    mistake: Mistake
    close: bool = False
    symmetry: Symmetry | None = None


def find(gated: Gated) -> Finding:
    """The cheap rungs on one data set."""
    if gated.stopped is not None:
        return Finding(gated, gated.stopped.tier)
    if gated.target.raises:
        return _expected_error(gated)
    if gated.sampled is not None:
        return _find_map(gated, gated.sampled)
    assert gated.answer is not None
    return _find_value(gated, gated.answer)


def _find_map(gated: Gated, f: Sampled) -> Finding:
    if f.identical:
        return Finding(gated, "identical")
    if f.target.exercise.kind == "mask":
        return Finding(gated, "different")
    if symmetries := relabellings(f):
        return Finding(gated, "relabelled", symmetries)
    if f.close:
        return Finding(gated, "close")
    if shifted := other_start(f):
        return Finding(gated, "other start", shifted=shifted)
    return Finding(gated, "different")


def _expected_error(gated: Gated) -> Finding:
    answer = gated.answer
    if isinstance(answer, Raised):
        return Finding(gated, "identical" if answer.is_a("ValueError") else "error")
    return Finding(gated, "different")


def _find_value(gated: Gated, answer: Answer) -> Finding:
    target, expected = gated.target, gated.target.expected
    if value_rungs.same(target, answer, expected):
        return Finding(gated, "identical")
    if value_rungs.same(target, answer, expected, near=CLOSE) and not _exact(expected):
        return Finding(gated, "close")
    wrong_shape = False
    for item, mine, right in value_rungs.pairs(answer, expected):
        if value_rungs.same(target, mine, right):
            continue
        if isinstance(mine, Numbers) and isinstance(right, Numbers):
            wrong_shape = wrong_shape or mine.values.shape != right.values.shape
            found = value_rungs.pattern(target, mine, right)
            return Finding(gated, "shape" if wrong_shape else "different", pattern=found, facts={"item": item})
        return Finding(gated, "different", facts={"item": item})
    return Finding(gated, "different")


def _exact(expected: Answer) -> bool:
    """Whether nothing may be rounded in it: words, whole numbers, yes and no."""
    if isinstance(expected, Several):
        return any(_exact(item) for item in expected.items)
    return isinstance(expected, Word) or (isinstance(expected, Numbers) and expected.was != "float")


def recognise(findings: Sequence[Finding]) -> Recognised | None:
    """The known mistake whose answers are met on every data set."""
    exercise = findings[0].target.exercise
    for near in (0.0, CLOSE):
        for mistake in exercise.mistakes:
            if all(_made(finding, mistake, near) for finding in findings) and (not near or _far(findings, mistake)):
                return Recognised(mistake, close=bool(near))
        if all(f.tier in ("identical", "close", "relabelled", "other start") for f in findings):
            return None  # these say more than a mistake that is nearly met
    return None


def _made(finding: Finding, mistake: Mistake, near: float) -> bool:
    target, known = finding.target, finding.target.mistake(mistake)
    answer = finding.gated.answer
    if target.raises or isinstance(known, Raised):
        return answer is not None and value_rungs.same(target, answer, known)
    f = finding.gated.sampled
    if f is None:
        return answer is not None and value_rungs.same(target, answer, known, near=near)
    assert isinstance(known, Numbers)
    return _meets(f, known.values, near)


def _meets(f: Sampled, values: Array, near: float = 0.0) -> bool:
    if values.shape[1:] != f.values.shape[1:]:
        return False
    finite = np.abs(values[np.isfinite(values)])
    allowed = max(f.target.allowed, f.target.exercise.tolerance * 2 * float(finite.max(initial=0.0)))
    return agree(f.values, values[f.indices], allowed + near * f.target.size)


def _far(findings: Sequence[Finding], mistake: Mistake) -> bool:
    """Whether the mistake is told from the right answer by more than the nearness that was allowed."""
    for finding in findings:
        f, known = finding.gated.sampled, finding.target.mistake(mistake)
        if f is None or not isinstance(known, Numbers) or known.values.shape != f.target.values.shape:
            continue
        if np.nanmax(np.abs(known.values - f.target.values), initial=0.0) > NEARER * CLOSE * f.target.size:
            return True
    return False


def overall(findings: Sequence[Finding]) -> Tier:
    """The tier of all data sets together: the worst gate, else the lowest rung. Blind data decide only where no other do."""
    wrong = [finding for finding in findings if not finding.right]
    wrong = [finding for finding in wrong if not finding.target.drawn.blind] or wrong
    if not wrong:
        return "identical"
    stopped = [finding.tier for finding in wrong if finding.tier in GATES]
    if stopped:
        return min(stopped, key=GATES.index)
    return max((finding.tier for finding in wrong), key=LADDER.index)


def common(findings: Sequence[Finding]) -> tuple[Symmetry, ...]:
    """The symmetries that explain every relabelled data set."""
    sets = [finding.symmetries for finding in findings if finding.tier == "relabelled"]
    return tuple(s for s in sets[0] if all(s in other for other in sets)) if sets else ()
