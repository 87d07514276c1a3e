"""What every shipped exercise must keep, whoever writes it: the rules of `directrix author check`, advice included."""

import itertools

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


@pytest.mark.parametrize("assignment", shipped().assignments, ids=lambda assignment: assignment.name)
def test_every_notebook_poses_its_exercises(assignment):
    """One task cell and one literal check cell each, at the exercise's points: nothing is said of the notebook."""
    said = itertools.takewhile(lambda breach: breach.rule == "notebook", rules.breaches(assignment))
    assert list(said) == []
