"""From answers that passed the gates to findings: the rung of the ladder and the known mistake.

A finding is made per data set; a mistake must explain every data set. The cheap rungs use values that are at hand; the dear
ones (:func:`search`) call the learner's function again, within a budget.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np

from autograder.comparison import values as value_rungs
from autograder.comparison.answers import Answer, Array, Numbers, Raised, Several, Word
from autograder.comparison.gates import Gated
from autograder.comparison.maps import CLOSE, Sampled, Shifted, agree, other_start, relabellings
from autograder.comparison.motion import Motion, Moved, moved
from autograder.comparison.moved_set import moved_set
from autograder.comparison.probing import Exhausted, Probe
from autograder.comparison.sets import Measured, SetFinding, compare_sets, measured
from autograder.comparison.symmetry import Symmetry
from autograder.comparison.target import Target
from autograder.comparison.values import Pattern
from autograder.exercise import Mistake
from autograder.result import GATES, LADDER, Tier

T = TypeVar("T")
NEARER = 10  # a mistake is met "closely" only where the right answer is at least so many times farther away
DEAR: tuple[Tier, ...] = ("same set", "covered", "part", "more", "moved")


@dataclass(eq=False)
class Finding:
    """How one data set was answered: its rung, and what the rung has to tell."""

    gated: Gated
    tier: Tier
    symmetries: tuple[Symmetry, ...] = ()
    shifted: Shifted | None = None
    sets: SetFinding | None = None
    moved: Moved | None = None
    motion: Motion | None = None  # of a set that is moved and traced in another way
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

    @property
    def on_ladder(self) -> Sampled | None:
        """A map of points that is not identical: what the rungs below look at."""
        f = self.sampled
        return f if f is not None and not self.right and f.values.ndim == 2 else None


@dataclass(frozen=True)
class Recognised:
    """A known mistake that explains every data set; ``close``: but for a rounded constant.

    Mistakes compose: with a relabelling (``symmetry``), or with a ``second`` mistake.
    """

    mistake: Mistake
    close: bool = False
    symmetry: Symmetry | None = None
    second: Mistake | None = None


# --- per data set ----------------------------------------------------------------------------------------------------------


def find(gated: Gated) -> Finding:
    """Right or not, and what a value that is not right has to do with the right one."""
    if gated.stopped is not None:
        return Finding(gated, gated.stopped.tier)
    if gated.target.raises:
        return _expected_error(gated)
    if gated.sampled is not None:
        return Finding(gated, "identical" if gated.sampled.identical else "different")
    assert gated.answer is not None
    return _find_value(gated, gated.answer)


def climb(finding: Finding) -> None:
    """The cheap rungs for a map: relabelled, close, other start. Vectors are no places: they are close or they are not."""
    f = finding.on_ladder
    if f is None:
        return
    if f.target.exercise.kind == "field":
        finding.tier = "close" if f.close else finding.tier
    elif symmetries := relabellings(f):
        finding.tier, finding.symmetries = "relabelled", symmetries
    elif f.close:
        finding.tier = "close"
    elif shifted := other_start(f):
        finding.tier, finding.shifted = "other start", shifted


def search(finding: Finding, call: Callable[..., Any] | None) -> None:
    """The rungs for sets and motions. Without ``call`` only what needs no further call: moved, point by point."""
    f = finding.on_ladder
    if f is None or f.target.exercise.kind == "field":
        return
    if finding.tier == "close":
        _same_after_all(finding, f, call)
    if finding.tier != "different":
        return
    probe = Probe(finding.gated, call) if call is not None else None
    with np.errstate(all="ignore"):
        yours = _measured(finding, probe) if probe is not None and probe.possible else None
        finding.sets = _attempted(lambda: compare_sets(yours, f.target.measured, f.target.size)) if yours else None
        if finding.sets is not None:
            full = f.target.exercise.tier_credit(finding.sets.tier) == 1.0
            finding.tier = "close" if full and yours and not _same(yours, f.target) else finding.sets.tier
            return
        finding.moved = moved(f)
        if finding.moved is None and yours is not None:
            finding.motion = _attempted(lambda: moved_set(yours, f.target.measured, f.target.size))
    if finding.moved is not None or finding.motion is not None:
        finding.tier = "moved"


def _same_after_all(finding: Finding, f: Sampled, call: Callable[..., Any] | None) -> None:
    """The right set at hardly another speed is close too. Where that set is worth more, it is looked for."""
    exercise = f.target.exercise
    if call is None or exercise.tier_credit("same set") <= exercise.tier_credit("close"):
        return
    with np.errstate(all="ignore"):
        yours = _measured(finding, Probe(finding.gated, call))
        found = _same(yours, f.target) if yours is not None else None
    if found is not None:
        finding.tier, finding.sets = "same set", found


def _same(yours: Measured, target: Target) -> SetFinding | None:
    """The right set, met to the exercise's tolerance as an identical map must be: what full marks ask for."""
    found = _attempted(lambda: compare_sets(yours, target.measured, target.size, target.allowed / target.size))
    return found if found is not None and found.tier == "same set" else None


def _measured(finding: Finding, probe: Probe) -> Measured | None:
    return _attempted(lambda: measured(probe, len(finding.target.names)))


def _attempted(look: Callable[[], T | None]) -> T | None:
    """What a search finds; None where its budget is spent, or where values off the samples are no numbers."""
    try:
        return look()
    except (Exhausted, np.linalg.LinAlgError):
        return None


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
    for item, mine, right in value_rungs.pairs(answer, expected):
        if value_rungs.same(target, mine, right):
            continue
        if isinstance(mine, Numbers) and isinstance(right, Numbers):
            tier: Tier = "shape" if mine.values.shape != right.values.shape else "different"
            return Finding(gated, tier, pattern=value_rungs.pattern(target, mine, right), facts={"item": item})
        return Finding(gated, "different", facts={"item": item})
    return Finding(gated, "different")


def _exact(expected: Answer) -> bool:
    """Whether nothing may be rounded in it: words, whole numbers, yes and no."""
    if isinstance(expected, Several):
        return any(_exact(item) for item in expected.items)
    return isinstance(expected, Word) or (isinstance(expected, Numbers) and expected.was != "float")


# --- known mistakes --------------------------------------------------------------------------------------------------------


def recognise(findings: Sequence[Finding]) -> Recognised | None:
    """The known mistake, in any of the ways it is written, whose answers are met on every data set."""
    exercise = findings[0].target.exercise
    mistakes = itertools.chain(exercise.mistakes, exercise.ways)
    return next((Recognised(m) for m in mistakes if all(_made(finding, m) for finding in findings)), None)


def recognise_more(findings: Sequence[Finding]) -> Recognised | None:
    """A known mistake with a rounded constant, with a relabelling on top, or together with a second one."""
    mistakes = findings[0].target.exercise.mistakes
    for mistake in mistakes:
        if all(_made(finding, mistake, CLOSE) for finding in findings) and _far(findings, mistake):
            return Recognised(mistake, close=True)
    if any(finding.gated.stopped is not None or finding.target.raises for finding in findings):
        return None
    maps = [finding.sampled for finding in findings]
    if any(f is None or f.values.ndim != 2 for f in maps):
        return None
    return _relabelled_mistake(maps, mistakes) or _two_mistakes(maps, mistakes)  # type: ignore[arg-type]


def _made(finding: Finding, mistake: Mistake, near: float = 0.0) -> bool:
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


def _relabelled_mistake(maps: Sequence[Sampled], mistakes: Sequence[Mistake]) -> Recognised | None:
    for mistake in mistakes:
        for symmetry in maps[0].target.symmetries[1:]:
            if all(_meets_relabelled(f, mistake, symmetry) for f in maps):
                return Recognised(mistake, symmetry=symmetry)
    return None


def _meets_relabelled(f: Sampled, mistake: Mistake, symmetry: Symmetry) -> bool:
    values = f.target.mistake_relabelled(mistake, symmetry)
    return values is not None and _meets(f, values)


def _two_mistakes(maps: Sequence[Sampled], mistakes: Sequence[Mistake]) -> Recognised | None:
    """Two mistakes whose effects add up, or multiply coordinate by coordinate (a factor and another factor)."""
    for one, other in itertools.combinations(mistakes, 2):
        for combine in (_added, _multiplied):
            if all(combine(f, one, other) for f in maps):
                return Recognised(one, second=other)
    return None


def _both(f: Sampled, one: Mistake, other: Mistake) -> tuple[Array, Array] | None:
    a, b = f.target.mistake(one), f.target.mistake(other)
    if (
        not isinstance(a, Numbers)
        or not isinstance(b, Numbers)
        or not a.values.shape == b.values.shape == f.target.values.shape
    ):
        return None
    return a.values[f.indices], b.values[f.indices]


def _added(f: Sampled, one: Mistake, other: Mistake) -> bool:
    both = _both(f, one, other)
    return both is not None and agree(f.values, both[0] + both[1] - f.expected, 4 * f.target.allowed)


def _multiplied(f: Sampled, one: Mistake, other: Mistake) -> bool:
    both = _both(f, one, other)
    if both is None or not agree(f.values * f.expected, both[0] * both[1], 4 * f.target.allowed * f.target.size):
        return False
    # Where the right coordinate is 0 a product tells nothing.
    blank = np.abs(f.expected) <= f.target.allowed
    known = [np.abs(f.values - v) <= f.target.allowed for v in (f.expected, *both)]
    return bool((known[0] | known[1] | known[2])[blank].all())


# --- all data sets together ------------------------------------------------------------------------------------------------


def answerable(findings: Sequence[Finding]) -> list[Finding]:
    """The findings on data that have an answer; all of them if none has. Not to refuse the others is a fault of its own."""
    return [finding for finding in findings if not finding.target.raises] or list(findings)


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
