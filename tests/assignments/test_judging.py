"""Every shipped exercise under its own judge: right is right, nothing is nothing, each mistake has its name."""

import numpy as np
import pytest

from autograder.catalogue import shipped
from autograder.exercise import PUBLIC_SEED
from autograder.judge import judge

EXERCISES = list(shipped())
MISTAKES = [(exercise, mistake) for exercise in EXERCISES for mistake in exercise.mistakes]
SEEDS = [PUBLIC_SEED, 7, b"a course's secret, a student and a digest"]
each_exercise = pytest.mark.parametrize("exercise", EXERCISES, ids=lambda exercise: exercise.id)
each_mistake = pytest.mark.parametrize(
    ("exercise", "mistake"), MISTAKES, ids=[f"{exercise.id}-{mistake.id}" for exercise, mistake in MISTAKES]
)
each_seed = pytest.mark.parametrize("seed", SEEDS, ids=["public", "seven", "secret"])


@each_seed
@each_exercise
def test_the_reference_passes(exercise, seed):
    verdict = judge(exercise, exercise.reference, seed=seed)
    assert (verdict.outcome, verdict.fraction, verdict.tier) == ("passed", 1.0, "identical"), verdict.message


@each_exercise
def test_the_stub_scores_nothing(exercise):
    def stub(*args):
        raise NotImplementedError

    verdict = judge(exercise, stub, seed=7)
    assert (verdict.outcome, verdict.fraction) == ("not run", 0.0)


@pytest.mark.parametrize("exercise", [e for e in EXERCISES if e.kind != "label"], ids=lambda exercise: exercise.id)
def test_zeros_score_nothing(exercise):
    """The laziest legal answer, an array of zeros of the right shape, is worth nothing anywhere."""

    def zeros(*args):
        try:
            return np.zeros_like(exercise.reference(*args))
        except ValueError:
            return 0.0

    assert judge(exercise, zeros, seed=7).fraction == 0.0


@each_seed
@each_mistake
def test_the_mistake_is_named_as_itself(exercise, mistake, seed):
    verdict = judge(exercise, mistake.formula, seed=seed)
    assert (verdict.mistake, verdict.tier) == (mistake.id, "mistake"), verdict.message
    assert verdict.fraction == mistake.credit
    assert mistake.hint in verdict.message
