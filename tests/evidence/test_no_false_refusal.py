"""The small version of ``campaign.py styles``: every right answer in every style, under four seeds."""

import pytest
from evidence_solutions import distinct, normal_form, solutions, traits
from evidence_tables import styles_of

from autograder.catalogue import shipped

IDS = [exercise.id for exercise in shipped() if solutions(exercise.id)]
SEEDS = [b"refused? %d" % number for number in range(4)]
FEWEST = 5


@pytest.mark.parametrize("id", IDS)
def test_right_answers_in_five_styles_and_more_get_full_marks(id):
    """Also those that come to the same numbers by another road: tolerances leave room for their rounding."""
    row = styles_of(id, SEEDS)
    assert not row.failures
    assert row.judged == row.styles * len(SEEDS)
    assert row.distinct >= FEWEST


def test_assignments_with_styles_have_them_for_all_exercises():
    for assignment in shipped().assignments:
        with_styles = [id for id in assignment.exercises if solutions(id)]
        assert with_styles in ([], list(assignment.exercises)), assignment.name


@pytest.mark.parametrize("id", IDS)
def test_an_answer_that_only_has_other_names_is_no_other_style(id):
    first = solutions(id)[0]
    renamed = first.source.replace(f"def {id}(", f"def {id}(").replace("points", "result").replace("angle_", "turn_")
    assert normal_form(f"# the same\n{renamed}") == normal_form(first.source)
    assert len(distinct(id)) <= len(solutions(id))


def test_normal_forms():
    """Names, imports, messages and docstrings do not count; another operation or another order does."""
    one = "import math\ndef f(u, r):\n    'Turn.'\n    if r < 0: raise ValueError('no')\n    return r * math.cos(u)"
    same = "def f(a, b):\n    if b < 0: raise ValueError\n    return b * np.cos(a)"
    other = "def f(a, b):\n    if b < 0: raise ValueError\n    return np.cos(a) * b"
    assert normal_form(one) == normal_form(same)
    assert normal_form(one) != normal_form(other)


def test_traits():
    assert traits("def f(n):\n    return 1 if n == 0 else n * f(n - 1)") == {"recursion"}
    assert traits("for i in range(3):\n    x = np.stack([i]) @ y") == {"loop", "whole arrays", "matrix"}
    assert traits("x = [1j * i for i in y]") == {"complex", "comprehension"}
