"""check(f): the points as a plain float, a card for every answer, and nothing spilt into the notebook."""

import functools
import json
import sys
import warnings

import numpy as np
import pytest

from autograder import check, judge_function
from autograder.catalogue import shipped
from autograder.checking import advice
from autograder.errors import CheckFailed, CourseError, ExerciseError
from autograder.notebook import session


def right(u, w, r, h):
    return np.stack(np.broadcast_arrays(r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), h * w), axis=-1)


def named(function, name="cylinder"):
    @functools.wraps(function)
    def wrapper(*args):
        return function(*args)

    wrapper.__name__ = name
    return wrapper


def test_a_right_answer_returns_the_points_as_a_plain_float(capsys):
    """nbgrader reads repr of the value: a numpy float would give other marks."""
    points = check(named(right))
    assert type(points) is float
    assert points == 4.0
    out, err = capsys.readouterr()
    assert out.startswith("[✓ Right] Cylinder from its known form")
    assert err == ""


def test_what_will_not_be_there_where_marks_are_given_is_told_before(capsys):
    """A function that is right with another package, or with the library itself, would earn nothing there."""
    with_scipy, with_library = (
        define(f"def cylinder(u, w, r, h):\n    {line}\n    return right(u, w, r, h)")
        for line in ("from scipy.special import comb", "import directrix as dx")
    )
    assert check(with_scipy) == check(with_library) == 4.0
    first, second = capsys.readouterr().out.split("[✓ Right]")[1:]
    assert "uses scipy. While the grader runs it, only numpy, plotly and what comes with Python" in first
    assert "uses the reference library, directrix." in second
    check(define("def cylinder(u, w, r, h):\n    import math\n    return right(u, w, r, h)"))
    assert "Careful" not in capsys.readouterr().out
    exercise = shipped().find("same_surface")
    assert advice.not_there(exercise, ["scipy.spatial", "numpy.linalg", "directrix.plot", "__main__", "math"]) == ()


def test_the_packages_named_are_those_of_the_sandbox():
    assert set(session.BASIC) == set(advice.OFFERED)


def define(text):
    names = {"right": right, "__name__": "__main__"}
    exec(text, names)
    return names["cylinder"]


def test_a_known_slip_returns_a_share_and_names_it(capsys):
    """Half a circle's worth of credit is still a float in between."""
    points = check(named(lambda u, w, r, h: right(w, u, r, h)))
    assert 0 < points < 4
    assert "swap_uw" in capsys.readouterr().out


def test_nothing_right_raises_after_the_card(capsys):
    """A plain run of the notebook stops there; the traceback is one line."""
    with pytest.raises(CheckFailed, match="cylinder is not right yet") as raised:
        check(named(lambda u, w, r, h: right(u, w, r, h) * [1, 1 + w.max() * 0, 0] + [0, 0, 7.0]))
    assert raised.value._render_traceback_() == [f"CheckFailed: {raised.value}"]
    assert raised.value.__suppress_context__ or raised.value.__context__ is None
    assert capsys.readouterr().out.startswith("[✗ Not right yet]")


def test_an_untouched_stub_is_not_an_error_of_the_learner(capsys):
    """NotImplementedError means: not written yet."""

    def stub(u, w, r, h):
        raise NotImplementedError

    with pytest.raises(CheckFailed, match="not written yet"):
        check(named(stub))
    assert capsys.readouterr().out.startswith("[○ Nothing to judge yet]")


def test_an_exception_tells_its_line(capsys):
    """Type, message, and the learner's own line, not one of the library it called."""

    def failing(u, w, r, h):
        return np.reshape(u, (7, 11, 13))  # the line that fails

    failing.__name__ = "cylinder"
    with pytest.raises(CheckFailed):
        check(failing)
    out = capsys.readouterr().out
    assert "cannot reshape array" in out
    assert "return np.reshape(u, (7, 11, 13)) # the line that fails" in out


def test_a_forgotten_return_is_named(capsys):
    """None is no answer."""
    with pytest.raises(CheckFailed):
        check(named(lambda u, w, r, h: None))
    assert "returned nothing (None)" in capsys.readouterr().out


def test_exit_inside_the_function_does_not_end_the_notebook(capsys):
    """SystemExit is an answer that failed."""
    with pytest.raises(CheckFailed):
        check(named(lambda u, w, r, h: sys.exit(0)))
    assert "ends the program" in capsys.readouterr().out


def test_prints_are_kept_short_and_shown_on_the_card(capsys):
    """One line said in every call stands there once, and a flood is cut."""

    def chatty(u, w, r, h):
        print("here")
        print("careful", file=sys.stderr)
        return right(u, w, r, h)

    check(named(chatty))
    out, err = capsys.readouterr()
    assert out.index("[✓ Right]") == 0
    assert out.count("here") <= 12
    assert err == ""

    def flood(u, w, r, h):
        print("x" * 100_000)
        return right(u, w, r, h)

    check(named(flood))
    out = capsys.readouterr().out
    assert len(out) < 4000
    assert "characters in all" in out


def test_warnings_of_the_learners_code_are_shown_and_not_raised(capsys):
    """nbgrader gives 0 for a cell with any stderr; a division by zero that is mended afterwards is no mistake."""

    def careless(u, w, r, h):
        np.log(np.zeros(2))  # warns
        return right(u, w, r, h)

    careless.__name__ = "cylinder"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert check(careless) == 4.0
    out, err = capsys.readouterr()
    assert err == ""
    assert "RuntimeWarning: divide by zero encountered in log" in out
    assert "np.log(np.zeros(2))  # warns" in out


def test_the_filters_and_streams_of_the_notebook_are_as_before():
    """What was redirected is given back, also after a failure."""
    before = (sys.stdout, sys.stderr, warnings.showwarning, list(warnings.filters))
    with pytest.raises(CheckFailed):
        check(named(lambda u, w, r, h: 1 / 0))
    assert (sys.stdout, sys.stderr, warnings.showwarning, list(warnings.filters)) == before


def test_an_interrupt_is_told_apart(capsys):
    """The learner pressed stop: perhaps a loop without end."""

    def endless(u, w, r, h):
        raise KeyboardInterrupt

    with pytest.raises(CheckFailed):
        check(named(endless))
    assert "was stopped by you in its call number 1" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("cylinder", "Write check(cylinder)."),
        ("cilinder", "Write check(cylinder)."),
        (3.5, "check was given a value of type float"),
        (None, "check was given nothing (None)"),
        (np.zeros((4, 3)), "check was given an array of shape (4, 3)"),
        (lambda u, w: u, "has no name"),
        (named(right, "Cilinder"), "Then write def cylinder(u, w, r, h):"),
        (named(right, "zzz"), "There are: cylinder, "),
        (functools.partial(named(right, "zzz"), r=1), "no exercise called zzz"),
    ],
)
def test_what_names_no_exercise_gets_a_card(given, said, capsys):
    """Never a bare TypeError, and always what to write instead."""
    with pytest.raises(CheckFailed, match="see the card above"):
        check(given)
    out, err = capsys.readouterr()
    assert out.startswith("[○ Nothing to judge yet]")
    assert said in out
    assert err == ""


def test_under_autograde_without_the_bridge_it_refuses_loudly(monkeypatch, capsys):
    """Marks must not come from a process in which the learner's code runs."""
    monkeypatch.setenv("NBGRADER_EXECUTION", "autograde")
    with pytest.raises(CourseError, match=r"autograder\.bridge\.configure\(c\)"):
        check(named(right))
    assert "has not been judged" in capsys.readouterr().err


def test_under_validate_it_works(monkeypatch):
    """Students validate in their own kernel."""
    monkeypatch.setenv("NBGRADER_EXECUTION", "validate")
    assert check(named(right)) == 4.0


def test_judge_function_gives_the_verdict_and_shows_nothing(capsys):
    """From Python, by the exercise's id; the name of the function does not matter."""
    verdict = judge_function("cylinder", right, seed=7)
    assert (verdict.outcome, verdict.tier, verdict.fraction) == ("passed", "identical", 1.0)
    assert capsys.readouterr() == ("", "")
    json.loads(verdict.to_json())
    with pytest.raises(ExerciseError, match="no exercise is called 'nothing'"):
        judge_function("nothing", right)
