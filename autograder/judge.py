"""The judge: asks, holds the answers to the gates, climbs the ladder, and says what it found. Pure and deterministic.

``judge(exercise, call, seed=...)`` makes all calls that decide marks before it compares anything. What a learner gets to see
(values, places, figure) comes from the public data; of hidden data only the tier is told.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from autograder.comparison.answers import Numbers, Raised
from autograder.comparison.asking import Asked, ask_all
from autograder.comparison.gates import Gated, through_gates
from autograder.comparison.target import Target, targets
from autograder.diagnosis.credit import product, terms
from autograder.diagnosis.earlier import Earlier, explained, not_written_earlier, with_earlier
from autograder.diagnosis.explain import Explanation
from autograder.diagnosis.figure import figure_of
from autograder.diagnosis.ladder import (
    DEAR,
    Finding,
    Recognised,
    answerable,
    climb,
    find,
    overall,
    recognise,
    recognise_more,
    search,
)
from autograder.diagnosis.wording import Parts, pair_written, spoken_answer, worst_finding, worst_index
from autograder.errors import ExerciseError, SandboxError
from autograder.exercise import PUBLIC_SEED, Exercise
from autograder.messages import say
from autograder.result import Case, Outcome, Tier, Verdict

CHEAP: tuple[Tier, ...] = ("identical", "relabelled", "other start", "close")  # these say more than a mistake nearly met


def judge(
    exercise: Exercise,
    call: Callable[..., Any],
    *,
    seed: int | str | bytes = PUBLIC_SEED,
    public_seed: int | str | bytes = PUBLIC_SEED,
    figure: bool = True,
    search: bool = True,
    earlier: Callable[[], Sequence[Earlier]] = tuple,
) -> Verdict:
    """Judge one answer to one exercise.

    Parameters
    ----------
    exercise : Exercise
        Its reference, data, mistakes and credits.
    call : callable
        The learner's function wherever it runs, called with positional arguments in the order of the signature. It may raise
        anything; :class:`CallFailed` says more than other exceptions do.
    seed : int, str or bytes
        Of the data that are judged. Where it is not ``public_seed``, the public data are judged as well and are the only ones
        that a learner gets to see.
    figure : bool
        Whether to sample both surfaces for a picture.
    search : bool
        Whether the dear rungs (same set, covered, part, more, moved set) may call the function again, within the budget of
        :mod:`autograder.comparison.probing`: on the public data, and on hidden data only where such a rung earns credit.
    earlier : callable
        The earlier functions of the same notebook that this one calls and that are not right; asked for only where this one is
        not right either. They may be called, for words only: no mark depends on it.

    Returns
    -------
    Verdict
        Its outcome is "could not judge" where the exercise or the sandbox failed, never the learner's zero.
    """
    try:
        shown = targets(exercise, public_seed)
        hidden = targets(exercise, seed, hidden=True) if seed != public_seed else ()
        asked = ask_all([*shown, *hidden], call)
        return _verdict(exercise, asked, call, figure=figure, search=search, earlier=earlier)
    except (ExerciseError, SandboxError) as failure:
        message = say("own.failure", message=" ".join(str(failure).split())[:500])
        return Verdict(
            exercise.id, "could not judge", 0.0, "error", message, parts=(("wrong", message),), title=exercise.title
        )  # fmt: skip


def _verdict(
    exercise: Exercise,
    asked: Sequence[Asked],
    call: Callable[..., Any],
    *,
    figure: bool,
    search: bool,
    earlier: Callable[[], Sequence[Earlier]],
) -> Verdict:
    gated = through_gates(asked)
    findings = [find(one) for one in gated]
    shown = [f for f in findings if not f.target.hidden]
    hidden = [f for f in findings if f.target.hidden]
    if not_written(gated):
        return _not_run(exercise, shown, [one for one in earlier() if not one.written])
    asked_for = answerable(findings)
    recognised = _diagnose(asked_for, call if search else None)
    rung = overall(findings if all(f.right for f in asked_for) else asked_for)
    handled = not any(one.troubles for one in gated)
    tier: Tier = "mistake" if recognised is not None else "shape" if rung == "identical" and not handled else rung
    worth = terms(exercise, findings, rung, recognised, handled=handled)
    fraction = product(worth)
    parts = Explanation(shown, hidden, tier, recognised).parts()
    if fraction == 1.0 and tier != "identical":
        told = [("right", text) for part, text in parts if part in ("right", "wrong")]
        parts = [*told, ("right", say("right.accepted"))]
    before = earlier() if fraction < 1.0 else ()
    follows = explained(findings, before)
    if before:
        parts = with_earlier(parts, exercise.id, before, proved=follows)
    return Verdict(
        exercise=exercise.id,
        outcome=_outcome(fraction),
        fraction=fraction,
        tier=tier,
        message=" ".join(text for _, text in parts),
        mistake=recognised.mistake.id if recognised is not None else None,
        cases=tuple(_case(f, recognised) for f in findings),
        parts=tuple(parts),
        figure=figure_of(worst_finding(shown), call) if figure else None,
        title=exercise.title,
        symmetries=_symmetries(findings) if tier == "relabelled" else (),
        follows=tuple(one.exercise.id for one in before) if follows else (),
        terms=worth if 0.0 < fraction < 1.0 else (),
    )


def _diagnose(findings: Sequence[Finding], call: Callable[..., Any] | None) -> Recognised | None:
    """Cheap before dear: known mistakes, cheap rungs, mistakes that compose, then what calls the function again."""
    if all(f.right for f in findings):
        return None
    recognised = recognise(findings)
    if recognised is None or recognised.mistake.credit is None:
        for finding in findings:
            climb(finding)
    if recognised is None and any(f.tier not in CHEAP for f in findings):
        recognised = recognise_more(findings)
    if recognised is None:
        _search(findings, call)
    return recognised


def _search(findings: Sequence[Finding], call: Callable[..., Any] | None) -> None:
    """The dear rungs: on public data, and on hidden data as far as marks hang on it."""
    exercise = findings[0].target.exercise
    for finding in sorted((f for f in findings if not f.target.hidden), key=lambda f: f.target.drawn.blind):
        before = finding.tier
        search(finding, call)
        if before == finding.tier == "different":
            break  # the lowest rung already: what the others are changes nothing
    public = [f for f in findings if not f.target.hidden]
    shown = overall(public)
    earns = (shown in DEAR or any(f.sets is not None for f in public)) and exercise.tier_credit(shown) > 0
    for finding in findings:
        if finding.target.hidden and finding.tier in ("different", "close"):
            search(finding, call if earns else None)
            if finding.tier == "different" and shown in DEAR and not earns:
                finding.tier = shown  # worth as little; the public data say which it is


def _outcome(fraction: float) -> Outcome:
    return "passed" if fraction == 1.0 else "partial" if fraction > 0.0 else "failed"


def not_written(gated: Sequence[Gated]) -> bool:
    """Whether the function is still the stub that raises NotImplementedError, or is missing."""
    keys = {one.stopped.key for one in gated if one.stopped is not None}
    called = [one for one in gated if one.stopped is None or one.stopped.key != "error.not_reached"]
    stub = all(
        (one.stopped is not None and one.stopped.key == "error.stub")
        or (isinstance(one.answer, Raised) and one.answer.is_a("NotImplementedError"))
        for one in called
    )
    return stub or "error.missing" in keys


def _not_run(exercise: Exercise, shown: Sequence[Finding], unwritten: Sequence[Earlier]) -> Verdict:
    parts: Parts = not_written_earlier(exercise.id, unwritten) if unwritten else Explanation(shown, (), "error").parts()
    return Verdict(
        exercise.id,
        "not run",
        0.0,
        "error",
        " ".join(text for _, text in parts),
        cases=tuple(Case(f.target.name, "error", blind=f.target.drawn.blind) for f in shown),
        parts=tuple(parts),
        title=exercise.title,
    )


def _case(finding: Finding, recognised: Recognised | None) -> Case:
    target, tier = finding.target, finding.tier
    mistake = None
    if recognised is not None and not finding.right and not target.raises:
        tier, mistake = "mistake", recognised.mistake.id
    case = Case(target.name, tier, blind=target.drawn.blind, hidden=target.hidden, mistake=mistake)
    if target.hidden:
        return case
    return replace(case, **_shown(finding), note=_note(finding))


def _shown(finding: Finding) -> dict[str, Any]:
    """What a public case tells beyond its tier."""
    f = finding.sampled
    if f is not None:
        i = worst_index(f)
        yours, expected = pair_written(f, i)
        where = None if finding.right else tuple(float(x) for x in f.points[i])
        return {"deviation": _rounded(f.worst), "where": where, "yours": yours, "expected": expected}
    gated = finding.gated
    if gated.stopped is not None:
        return {"where": gated.stopped.where}
    if gated.answer is None or finding.right:
        return {"deviation": 0.0}
    return {"yours": _told(gated.answer), "expected": _expected(finding.target)}


def _told(answer: Any) -> str:
    return f"{answer.exception}: {answer.message}" if isinstance(answer, Raised) else spoken_answer(answer)


def _expected(target: Target) -> str | None:
    if isinstance(target.expected, Raised):
        return "ValueError"
    # A word is the whole solution of its task: it is not told.
    return spoken_answer(target.expected) if isinstance(target.expected, Numbers) else None


def _note(finding: Finding) -> str:
    gated = finding.gated
    if gated.stopped is not None:
        return gated.stopped.key
    if gated.troubles:
        return gated.troubles[0].key
    return finding.pattern.key if finding.pattern is not None else ""


def _rounded(x: float) -> float | None:
    return float(f"{x:.4g}") if np.isfinite(x) else None


def _symmetries(findings: Sequence[Finding]) -> tuple[str, ...]:
    sets = [f.symmetries for f in findings if f.tier == "relabelled"]
    return tuple(s.name for s in sets[0] if all(s in other for other in sets)) if sets else ()
