"""What every shipped exercise must keep, whoever writes it: each mistake is real, is seen, and is told from the others."""

import itertools
import re

import numpy as np
import pytest

from autograder.catalogue import shipped
from autograder.curvedata import CurveData
from autograder.exercise import PUBLIC_SEED, Exercise

SEEDS = range(50)
SEEN = 0.01  # relative to the size: five times what the ladder still calls "close"
EXERCISES = list(shipped())
MISTAKES = [(exercise, mistake) for exercise in EXERCISES for mistake in exercise.mistakes]
each_exercise = pytest.mark.parametrize("exercise", EXERCISES, ids=lambda exercise: exercise.id)
each_mistake = pytest.mark.parametrize(
    ("exercise", "mistake"), MISTAKES, ids=[f"{exercise.id}-{mistake.id}" for exercise, mistake in MISTAKES]
)


@each_mistake
def test_seen_by_data_that_are_not_blind_under_every_seed(exercise, mistake, sampler):
    """A blind data set never decides alone, and no draw of random data may hide a mistake."""
    for seed in SEEDS:
        seeing = [drawn for drawn in exercise.draw(seed) if not drawn.blind]
        distances = [
            sampler.apart(sampler.answer(exercise, exercise.reference, drawn), sampler.answer(exercise, mistake.formula, drawn))
            for drawn in seeing
        ]
        assert max(distances) > SEEN, f"seed {seed}: {dict(zip([drawn.name for drawn in seeing], distances, strict=True))}"


@each_exercise
def test_no_two_mistakes_coincide_on_all_data(exercise, sampler):
    """Else the judge could not tell which one was made."""
    for seed in range(10):
        data = exercise.draw(seed)
        answers = {
            mistake.id: [sampler.answer(exercise, mistake.formula, drawn) for drawn in data] for mistake in exercise.mistakes
        }
        for (one, first), (other, second) in itertools.combinations(answers.items(), 2):
            assert max(map(sampler.apart, first, second)) > SEEN, f"seed {seed}: {one} and {other}"


@each_exercise
def test_every_blind_data_set_hides_a_mistake_and_the_others_see_one(exercise, sampler):
    """`blind` is a claim: some mistake stays invisible there. A data set that no mistake differs on would be no use at all,
    unless it asks for a refusal."""
    for drawn in exercise.draw():
        right = sampler.answer(exercise, exercise.reference, drawn)
        seen = {m.id: sampler.apart(right, sampler.answer(exercise, m.formula, drawn)) > 1e-9 for m in exercise.mistakes}
        if drawn.blind:
            assert not all(seen.values()), f"{drawn.name} hides nothing"
        elif not (isinstance(right, str) and right == "ValueError"):
            assert any(seen.values()), f"{drawn.name} sees nothing"


@each_exercise
def test_has_data_that_see_and_data_that_change_with_the_seed(exercise):
    """What a learner knows by heart must not be all that is asked."""
    assert [known for known in exercise.data_sets if not known.blind]
    if exercise.arguments != exercise.parameters:
        assert _values(exercise, 1) != _values(exercise, 2)
        assert _values(exercise, 1) == _values(exercise, 1)


def _values(exercise: Exercise, seed: int) -> list[bytes]:
    values = [value for drawn in exercise.draw(seed) for value in drawn.arguments.values()]
    return [v.coefficients.tobytes() if isinstance(v, CurveData) else str(v).encode() for v in values]


@pytest.mark.parametrize("exercise", [e for e in EXERCISES if e.parameters], ids=lambda exercise: exercise.id)
def test_the_reference_has_the_promised_shape(exercise):
    """For scalars, vectors, open meshes and empty arrays."""
    tail = () if exercise.kind == "mask" else (3,)
    axes = len(exercise.parameters)
    mesh = np.meshgrid(*[np.linspace(0, 1, n + 2) for n in range(axes)], indexing="ij", sparse=True)
    for drawn in exercise.draw():
        arguments = list(drawn.arguments.values())
        try:
            assert np.shape(exercise.reference(*[0.5] * axes, *arguments)) == tail
        except ValueError:
            continue
        assert exercise.reference(*[np.linspace(0, 1, 5)] * axes, *arguments).shape == (5, *tail)
        assert exercise.reference(*mesh, *arguments).shape == (*range(2, 2 + axes), *tail)
        assert exercise.reference(*[np.empty(0)] * axes, *arguments).shape == (0, *tail)


@each_mistake
def test_the_hint_speaks_to_the_learner_and_keeps_the_answer(exercise, mistake):
    """It says what was done and ends on something to look at; it is long enough to help and short enough to be read, and it
    holds no line of code."""
    words = mistake.hint.split()
    assert 15 <= len(words) <= 75, len(words)
    assert re.search(r"\byou(rs?)?\b", mistake.hint, re.IGNORECASE)
    assert "np." not in mistake.hint
    assert "return" not in mistake.hint
    assert mistake.credit is not None, "say what a learner with this mistake has understood"


def test_hints_of_one_exercise_differ():
    for exercise in EXERCISES:
        hints = [mistake.hint for mistake in exercise.mistakes]
        assert len(set(hints)) == len(hints), exercise.id


@each_exercise
def test_the_statement_names_every_argument(exercise):
    """Units and shapes are told where the inputs are named."""
    for name in exercise.arguments:
        assert re.search(rf"\b{name}\b", exercise.statement), name
    assert exercise.statement.startswith("Return ")
    assert PUBLIC_SEED == 0
