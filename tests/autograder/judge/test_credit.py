"""What a part of the points is made of: factors with reasons whose product is the fraction."""

import math

import numpy as np
import pytest

from autograder import card
from autograder.catalogue import shipped
from autograder.errors import ExerciseError
from autograder.exercise import exercise
from autograder.judge import judge
from autograder.result import Verdict


def flat(u, w):
    return np.stack(np.broadcast_arrays(u, w, 0 * u * w), axis=-1)


def sheet(*, weights=(1, 1, 1, 1), blind=(), **options):
    """A flat piece with numbered data sets, right or wrong by what the answer does with the number."""

    @exercise(points=4, title="Sheet", kind="surface", **options)
    def sheet(u, w, d):
        """A flat piece."""
        return flat(u, w)

    for number, weight in enumerate(weights):

        def draw(rng, number=number):
            return {"d": number + rng.uniform(0, 0.5)}

        draw.__name__ = f"set_{number}"
        sheet.data(draw, weight=weight, blind=number in blind)
    return sheet


def wrong_on(*numbers, by=None):
    """An answer that is wrong on these data sets."""

    def answer(u, w, d):
        return flat(u, w) if int(d) not in numbers else (by or (lambda u, w: flat(u, w) + np.sin(5 * u * w)[..., None]))(u, w)

    return answer


def judged(one, answer, **options):
    return judge(one, answer, figure=False, search=False, **options)


def test_a_share_of_the_data_sets_counts_half():
    """Right on three of four: 3/4 of 1/2, and the card does the sum."""
    verdict = judged(sheet(), wrong_on(2))
    assert (verdict.outcome, verdict.fraction) == ("partial", 0.375)
    assert verdict.terms == (("right on 3 of 4 data sets", 0.75), ("since not on all", 0.5))
    line = "Worth: 0.75 (right on 3 of 4 data sets) × 0.5 (since not on all) = 0.375 of the points."
    assert line in card.text(verdict)


def test_right_on_none_is_nothing():
    """No share, no arithmetic."""
    verdict = judged(sheet(), wrong_on(0, 1, 2, 3))
    assert (verdict.fraction, verdict.terms) == (0.0, ())
    assert "Worth" not in card.text(verdict)


def test_right_on_all_is_everything():
    """There is nothing to explain."""
    verdict = judged(sheet(), wrong_on())
    assert (verdict.fraction, verdict.terms) == (1.0, ())
    assert "Worth" not in card.text(verdict)


def test_weights_decide_what_a_data_set_counts():
    """Twice the weight, twice the share."""
    heavy = sheet(weights=(1, 1, 2))
    assert judged(heavy, wrong_on(2)).fraction == 0.25
    assert judged(heavy, wrong_on(0)).fraction == 0.375
    assert judged(heavy, wrong_on(0)).terms[0] == ("right on data sets that count 3 of 4", 0.75)


def test_blind_data_count_nothing():
    """Who is right on blind data alone has no share; who is wrong on them alone loses none of the others."""
    assert judged(sheet(blind=(0, 1)), wrong_on(2, 3)).fraction == 0.0
    assert judged(sheet(blind=(0,)), wrong_on(3)).terms[0] == (
        "right on 2 of 3 data sets; blind ones do not count",
        2 / 3,
    )


def test_what_is_learnt_by_heart_counts_nothing():
    """A data set is right only where its hidden numbers are too, and one without any counts neither way."""

    @exercise(points=4, title="Sheet", kind="surface")
    def scaled(u, w, d):
        """A flat piece of size d."""
        return d * flat(u, w)

    @scaled.data
    def fixed(rng):
        return {"d": 2.0}

    @scaled.data
    def drawn(rng):
        return {"d": rng.uniform(3, 4)}

    @scaled.data
    def drawn_large(rng):
        return {"d": rng.uniform(30, 40)}

    assert scaled.by_heart == {"fixed"}
    by_heart = scaled.draw(0)[1].arguments["d"]

    def wrong(u, w):
        return np.sin(5 * u * w)[..., None] + flat(u, w)

    def written_down(u, w, d):
        return 2 * flat(u, w) if d == 2 else by_heart * flat(u, w) if d == by_heart else wrong(u, w)

    def small(u, w, d):
        return d * flat(u, w) if d < 10 else wrong(u, w)

    assert judged(scaled, written_down, seed=b"hidden").fraction == 0.0
    said = "right on 1 of 2 data sets; blind ones and those that are everybody's do not count"
    assert judged(scaled, small, seed=b"hidden").terms == ((said, 0.5), ("since not on all", 0.5))
    assert judged(scaled, lambda u, w, d: 2.0 * flat(u, w), seed=b"hidden").fraction == 0.0


def test_the_better_of_tier_and_data_counts():
    """Close everywhere is worth more than right on half; where the tier earns less, the share of the data does."""
    close = wrong_on(0, by=lambda u, w: flat(u, w) * 1.0001)
    assert judged(sheet(), close).terms == (("close to right", 0.8),)
    assert judged(sheet(accept={"close": 0.1}), close).fraction == 0.375


def test_an_exercise_may_set_what_a_part_is_worth():
    """From nothing to nearly all."""
    assert judged(sheet(data_credit=0.0), wrong_on(2)).fraction == 0.0
    assert judged(sheet(data_credit=0.9), wrong_on(2)).fraction == 0.75 * 0.9


@pytest.mark.parametrize("wrong", [1.0, -0.1, math.nan])
def test_a_part_is_never_worth_all(wrong):
    with pytest.raises(ExerciseError, match="data_credit must lie in"):
        sheet(data_credit=wrong)


def test_a_weight_is_a_number_of_0_or_more():
    with pytest.raises(ExerciseError, match="weight of data set 'set_0'"):
        sheet(weights=(-1,))


@pytest.mark.parametrize(
    "broken",
    [
        lambda u, w: flat(u, w) / np.where(np.asarray(u) * np.ones_like(w) == 0, 0, 1)[..., None],  # not finite on an edge
        lambda u, w: flat(u / max(np.max(u, initial=0.1), 0.1), w),  # not point by point
    ],
)
def test_a_fault_of_the_function_itself_leaves_no_share(broken):
    """What is not finite or not point by point earns nothing, on whatever data it shows."""
    with np.errstate(all="ignore"):
        assert judged(sheet(), wrong_on(0, by=broken)).fraction == 0.0


def test_words_are_not_worth_guessing():
    """One word for all data is right on some."""
    label = shipped().find("torus_class")
    right = [label.reference(*drawn.arguments.values()) for drawn in label.draw() if drawn.name == "any_ring"]
    verdict = judged(label, lambda *arguments: right[0])
    assert "identical" in {case.tier for case in verdict.cases}
    assert verdict.fraction == 0.0


@pytest.mark.parametrize("one", list(shipped()), ids=lambda one: one.id)
def test_the_sum_adds_up_for_every_listed_mistake(one):
    """The product of the printed factors is the fraction, each with its reason; a mistake's own credit comes first."""
    for mistake in one.mistakes:
        with np.errstate(all="ignore"):
            verdict = judged(one, mistake.formula)
        if not 0 < verdict.fraction < 1:
            assert verdict.terms == ()
            continue
        assert all(why for why, _ in verdict.terms), verdict.terms
        assert math.isclose(math.prod(factor for _, factor in verdict.terms), verdict.fraction, rel_tol=1e-12)
        if mistake.credit is not None and verdict.mistake == mistake.id:
            assert verdict.terms[0] == ("this slip", mistake.credit)
        again = Verdict.from_json(verdict.to_json())
        assert again == verdict
