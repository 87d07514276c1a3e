"""What every shipped exercise must keep, whoever writes it: the rules of `directrix author check`, advice included."""

import itertools

import numpy as np
import pytest

from autograder.authoring import rules
from autograder.catalogue import shipped

EXERCISES = list(shipped())
MORE = range(50)  # of the rule that needs no judge, and hangs on the luck of the draw
SEEDS = {"seen": MORE}
each_exercise = pytest.mark.parametrize("exercise", EXERCISES, ids=lambda exercise: exercise.id)


@pytest.mark.parametrize("rule", [*rules.RULES, *rules.ADVICE])
@each_exercise
def test_every_exercise_keeps_every_rule(exercise, rule):
    """Each mistake is seen, told from the others and named; the reference passes; the stub and zeros score nothing..."""
    asked = {**rules.RULES, **rules.ADVICE}[rule]
    assert list(asked(exercise, SEEDS.get(rule, rules.SEEDS))) == []


@each_exercise
def test_every_reference_takes_lists_for_arrays(exercise):
    """Whoever tries one out writes a net as it is printed."""
    places = [0.25, 0.5, 0.75][: len(exercise.parameters)]
    for drawn in exercise.draw(1):
        given = list(drawn.arguments.values())
        answer = asked(exercise, *places, *given)
        assert same(asked(exercise, *places, *map(written, given)), answer), drawn.name


def asked(exercise, *arguments):
    try:
        return exercise(*arguments)
    except ValueError:
        return "refused"


def written(value):
    return value.tolist() if isinstance(value, np.ndarray) else value


def same(one, other):
    if isinstance(one, tuple):
        return all(map(np.array_equal, one, other))
    return np.array_equal(one, other)


@pytest.mark.parametrize("assignment", shipped().assignments, ids=lambda assignment: assignment.name)
def test_every_notebook_poses_its_exercises(assignment):
    """One task cell and one literal check cell each, at the exercise's points: nothing is said of the notebook."""
    said = itertools.takewhile(lambda breach: breach.rule == "notebook", rules.breaches(assignment))
    assert list(said) == []
