"""What an answer is worth: a product of few factors, each with its reason, so that a learner can do the sum.

The first factor is a known slip's own credit; else the larger of two: the least credit that a tier earns among the data that
are wrong, and the share of the data sets that are right, of which a part counts (``Exercise.data_credit``). Further factors
follow for what is wrong besides: another slip, other labels, arguments without an answer that are not refused, shapes of
arguments that are not handled.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from autograder.diagnosis.ladder import Finding, Recognised, answerable
from autograder.exercise import REFUSAL_CREDIT, Exercise
from autograder.messages import number, say
from autograder.result import GATES, Tier

Terms = tuple[tuple[str, float], ...]
# What stops these is a fault of the function and not of a data set, or leaves a place without any point.
WHOLE: tuple[Tier, ...] = ("timeout", "not finite", "not pointwise", "not repeatable")


def terms(
    exercise: Exercise, findings: Sequence[Finding], rung: Tier, recognised: Recognised | None, *, handled: bool
) -> Terms:
    """The reasons and factors whose product is the fraction; none for an answer that is right."""
    asked_for = answerable(findings)
    found: list[tuple[str, float]] = []
    if recognised is not None and recognised.mistake.credit is not None:
        found.append((say("share.mistake"), recognised.mistake.credit))
    elif not all(f.right for f in asked_for):
        by_tier, by_data = _by_tier(exercise, asked_for, rung), _by_data(exercise, asked_for)
        found += by_tier if product(by_tier) >= product(by_data) else by_data
    if recognised is not None and recognised.symmetry is not None:
        found.append((say("share.relabelled_too"), exercise.tier_credit("relabelled")))
    if recognised is not None and recognised.second is not None:
        found.append((say("share.second"), recognised.second.credit or 0.0))
    if not all(f.right for f in findings if f.target.raises) and len(asked_for) < len(findings):
        found.append((say("share.refusal"), REFUSAL_CREDIT))
    if not handled:
        found.append((say("share.shape"), exercise.shape_credit))
    return tuple(found)


def product(factors: Sequence[tuple[str, float]]) -> float:
    """The fraction that the terms come to."""
    return float(math.prod(factor for _, factor in factors))


def _by_tier(exercise: Exercise, asked_for: Sequence[Finding], rung: Tier) -> list[tuple[str, float]]:
    """The least credit among the data that are wrong; blind ones count where they are as wrong as the others."""
    tiers = [f.tier for f in asked_for if not f.right and (not f.target.drawn.blind or rung == f.tier)]
    credit = {tier: 0.0 if tier in GATES else exercise.tier_credit(tier) for tier in tiers}
    least = min(credit, key=lambda tier: credit[tier], default=None)
    if least is None:
        return []
    return [(say(f"share.{least.replace(' ', '_')}") if credit[least] else "", credit[least])]


def _by_data(exercise: Exercise, asked_for: Sequence[Finding]) -> list[tuple[str, float]]:
    """The share of the data sets that are right, shown and hidden numbers alike; nothing where the function itself fails.

    Data that are the same for everybody count neither way: their answer can be written down without computing it.
    """
    seeing = [f for f in asked_for if not f.target.drawn.blind and f.target.name not in exercise.by_heart]
    if any(f.tier in WHOLE for f in asked_for):
        return [("", 0.0)]
    weights = {known.name: known.weight for known in exercise.data_sets if known.name in {f.target.name for f in seeing}}
    wrong = {f.target.name for f in seeing if not f.right}
    whole = math.fsum(weights.values())
    right = math.fsum(weight for name, weight in weights.items() if name not in wrong)
    if not wrong or not right:
        return [("", 0.0)]
    even = len(set(weights.values())) == 1
    told = (len(weights) - len(wrong), len(weights)) if even else (right, whole)
    facts = {"right": number(told[0]), "of": number(told[1])}
    left_out = [f for f in asked_for if f not in seeing]
    known = any(not f.target.drawn.blind for f in left_out)
    key = "share.data_drawn" if known else "share.data_seeing" if left_out else "share.data"
    key = key if even else "share.data_weighted"
    return [(say(key, **facts), right / whole), (say("share.partly"), exercise.data_credit)]
