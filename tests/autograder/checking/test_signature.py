"""Arguments: what makes the call fail is told before it is made, what does not is told where the answer is wrong."""

import numpy as np
import pytest

from autograder import check
from autograder.catalogue import shipped
from autograder.checking.signature import trouble_with
from autograder.errors import CheckFailed

EXERCISE = shipped().find("cylinder")  # cylinder(u, w, r, h)


def trouble(arguments):
    scope = {}
    exec(f"def cylinder({arguments}): pass", scope)
    return trouble_with(EXERCISE, scope["cylinder"])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ("u, w, r", "Missing: `h`."),
        ("u, w", "Missing: `r`, `h`."),
        ("", "Missing: `u`, `w`, `r`, `h`."),
        ("u, w, r, h, k", "Too many: `k`."),
        ("self, u, w, r, h", "Too many: `self`."),
        ("u, w, R, h, k", "Too many: `k`. `r` is called `R`."),
        ("u, w, *, r, h", "`r`, `h` can only be given by name (they stand behind a *)."),
    ],
)
def test_calls_that_cannot_succeed(arguments, said):
    """Missing, extra and keyword-only arguments, with a misspelt one recognised."""
    found = trouble(arguments)
    assert not found.callable
    assert found.said == said


@pytest.mark.parametrize("arguments", ["u, w, r, h", "u, w, r, h=1", "u, w, r, h, k=1", "*args", "u, *rest", "u, w, /, r, h"])
def test_calls_that_succeed_are_no_trouble(arguments):
    """Defaults, further arguments with a default, and star arguments take the call as it comes."""
    assert trouble(arguments) is None


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ("w, u, r, h", "Their order differs: the task has (u, w, r, h), yours has (w, u, r, h)."),
        ("u, v, radius, h", "`v` where the task says `w`; `radius` where the task says `r`."),
    ],
)
def test_other_names_and_orders_are_remarks(arguments, said):
    """The call is by position, in the grader too."""
    found = trouble(arguments)
    assert found.callable
    assert said in found.said


def test_the_card_shows_both_lines(capsys):
    """Wanted and yours, one below the other."""

    def cylinder(u, w, r):
        return np.zeros(3)

    with pytest.raises(CheckFailed):
        check(cylinder)
    out = capsys.readouterr().out
    assert "Wanted: def cylinder(u, w, r, h):" in out
    assert "Yours: def cylinder(u, w, r):" in out


def test_an_exchanged_order_is_told_where_the_answer_is_wrong(capsys):
    """The verdict is that of the grader; the remark explains it."""

    def cylinder(w, u, r, h):
        return np.stack(np.broadcast_arrays(r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), h * w), axis=-1)

    assert 0 < check(cylinder) < 4
    assert "Arguments: Their order differs" in capsys.readouterr().out


def test_other_names_cost_nothing_and_a_right_answer_hears_no_word(capsys):
    """Names are the learner's to choose."""

    def cylinder(a, b, c, d):
        return np.stack(np.broadcast_arrays(c * np.cos(2 * np.pi * a), c * np.sin(2 * np.pi * a), d * b), axis=-1)

    assert check(cylinder) == 4.0
    assert "Arguments" not in capsys.readouterr().out
