"""Which isolation a class is graded at: A, else A-, never less, and never quietly."""

import pytest

from autograder.errors import IsolationError
from autograder.notebook import session
from autograder.sandbox import Sandbox


@pytest.fixture
def without_level(monkeypatch):
    """A machine that does not give some levels."""

    def lacking(*levels):
        def start(policy=None, level="A", **options):
            if level in levels:
                raise IsolationError(f"level {level} is not given on this machine: because of a test")
            return Sandbox(policy=policy, level=level, **options)

        monkeypatch.setattr(session, "Sandbox", start)

    return lacking


def level_of(required):
    with session.opened([], ("numpy",), required, None) as opener, opener({}) as child:
        assert child.run_cell("print('runs')").outputs[0]["text"] == "runs\n"
        return opener.level


def test_the_best_level_is_taken_when_none_is_required():
    """A where the machine gives it."""
    assert level_of(None) == "A"


def test_without_namespaces_of_their_own_notebooks_run_at_a_minus(without_level):
    """And the report says so: the level is that of the sandbox, not a wish."""
    without_level("A")
    assert level_of(None) == "A-"


def test_level_a_required_and_not_given_stops_though_a_minus_would_be(without_level):
    """What a course requires is not bargained down."""
    without_level("A")
    with pytest.raises(IsolationError, match="level A is not given"):
        level_of("A")


def test_a_machine_that_gives_neither_is_told_why_it_does_not_give_a(without_level):
    """The message of the better level, whose cause is the one to mend."""
    without_level("A", "A-")
    with pytest.raises(IsolationError, match="level A is not given"):
        level_of(None)


@pytest.mark.parametrize("level", ["B", "D", "Z"])
def test_a_weaker_level_is_not_offered(level):
    """Nothing runs a learner's notebook with less than A-."""
    with pytest.raises(IsolationError, match="at level A or A- only"):
        level_of(level)
