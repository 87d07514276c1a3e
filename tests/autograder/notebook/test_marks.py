"""nbgrader's scoring rules, one by one against nbgrader's own function, and each place where we differ on purpose."""

import math

import pytest

from autograder.notebook.marks import CellRun, Mark, mark, partial, returns_number, scored
from autograder.notebook.master import MasterCell, checksum
from autograder.result import Verdict


def result(shown):
    return {"output_type": "execute_result", "data": {"text/plain": shown}, "metadata": {}, "execution_count": 1}


STDOUT = {"output_type": "stream", "name": "stdout", "text": "hello"}
STDERR = {"output_type": "stream", "name": "stderr", "text": "careful"}
ERROR = {"output_type": "error", "ename": "AssertionError", "evalue": "", "traceback": []}
DISPLAY = {"output_type": "display_data", "data": {"text/plain": "0.5"}, "metadata": {}}


def nbgraders(outputs, points=3.0):
    import nbformat
    from nbgrader.utils import determine_grade

    meta = {"nbgrader": {"grade": True, "solution": False, "locked": True, "points": points, "grade_id": "t"}}
    cell = {"cell_type": "code", "source": "", "metadata": meta, "outputs": outputs, "execution_count": 1}
    return determine_grade(nbformat.from_dict(cell))[0]


@pytest.mark.parametrize(
    "outputs",
    [
        [], [STDOUT], [DISPLAY], [ERROR], [STDERR], [STDOUT, ERROR], [result("0.5"), ERROR], [STDERR, result("3.0")],
        [result("3.0")], [result("0")], [result("1e0")], [result(" 2.5 ")], [STDOUT, result("1.5")], [result("'0.5 points'")],
        [result("True")], [result("[0.5]")], [result("array(0.5)")], [result("(0.5, 'why')")], [result("None at all")],
    ],
)  # fmt: skip
def test_outputs_score_as_in_nbgrader(outputs):
    """The neighbour of the differences below: here the two agree exactly."""
    assert scored(outputs, 3.0).points == nbgraders(outputs)


@pytest.mark.parametrize(
    ("shown", "points", "look", "nbgrader"),
    [
        ("np.float64(0.5)", 0.5, False, 3.0),
        ("np.int64(0)", 0.0, False, 3.0),
        ("np.float32(1.5)", 1.5, False, 3.0),
        ("-1.0", 0.0, True, 3.0),
        ("nan", 0.0, True, 3.0),
        ("np.float64(nan)", 0.0, True, 3.0),
        ("np.float64(-0.5)", 0.0, True, 3.0),
        ("3.5", 0.0, True, ValueError),
        ("inf", 0.0, True, ValueError),
        ("3.0000000000000004", 3.0, False, ValueError),
    ],
)
def test_where_nbgrader_fails_open_we_fail_closed(shown, points, look, nbgrader):
    given = partial(shown, 3.0)
    assert (given.points, given.look) == (points, look)
    if nbgrader is ValueError:
        with pytest.raises(ValueError, match="partial credit"):
            nbgraders([result(shown)])
    else:
        assert nbgraders([result(shown)]) == nbgrader


def test_a_text_that_is_no_number_keeps_full_points_with_a_warning():
    given = partial("'half of it'", 3.0)
    assert given.points == 3.0
    assert "no number" in given.note


def test_minus_zero_is_zero():
    assert math.copysign(1.0, partial("-0.0", 3.0).points) == 1.0


def test_a_result_without_text_has_no_mark():
    assert partial(None, 3.0) == Mark(None, look=True, note="The test returned something without a text; please look at it.")


TEST = MasterCell("t", "code", "assert x", checksum="c" * 32, locked=True, grade=True, points=3.0)
EXERCISE = MasterCell("check_x", "code", "check(x)", checksum="c" * 32, locked=True, grade=True, points=3.0)


def cell(source="", kind="code", outputs=()):
    return {"cell_type": kind, "source": source, "metadata": {}, "outputs": list(outputs)}


def test_a_test_cell_that_did_not_run_has_no_mark():
    """nbgrader gives full points to a cell without outputs."""
    assert nbgraders([]) == 3.0
    assert mark(cell(), TEST, None).points is None
    assert mark(cell(), TEST, CellRun("not run", note="no time")) == Mark(None, look=True, note="no time")
    assert mark(cell(), TEST, CellRun("ok")) == Mark(3.0)


def test_a_verdict_gives_its_share_rounded_and_clamped():
    half = Verdict("x", "partial", 1 / 3, "mistake", "")
    assert mark(cell(), EXERCISE, CellRun("judged", half)) == Mark(1.0)
    unjudged = Verdict("x", "could not judge", 0.0, "error", "")
    assert mark(cell(), EXERCISE, CellRun("judged", unjudged, "the sandbox broke")) == Mark(None, True, "the sandbox broke")


def test_forged_outputs_under_an_exercise_cell_count_for_nothing():
    assert mark(cell(outputs=[result("3.0")]), EXERCISE, None).points is None


@pytest.mark.parametrize("kind", ["code", "markdown"])
def test_an_answer_is_zero_untouched_and_waits_once_written(kind):
    flags = {"grade": True, "solution": True, "points": 2.0}
    handed_out = checksum(kind, "your answer", MasterCell("a", kind, "your answer", **flags))
    master = MasterCell("a", kind, "your answer", checksum=handed_out, **flags)
    assert mark(cell("your answer", kind), master, None) == Mark(0.0)
    assert mark(cell("my answer", kind), master, None) == Mark(None, look=True)


@pytest.mark.parametrize("flags", [{"grade": True}, {"solution": True}, {"grade": True, "solution": True}, {"locked": True}])
def test_our_checksum_is_nbgraders(flags):
    import nbformat
    from nbgrader.utils import compute_checksum

    master = MasterCell("name", "code", "x = 1", points=2.5 if flags.get("grade") else None, **flags)
    made = nbformat.from_dict({"cell_type": "code", "source": "x = 'ü'", "metadata": {"nbgrader": master.metadata}})
    assert checksum("code", "x = 'ü'", master) == compute_checksum(made)


def test_every_difference_is_told_to_instructors():
    """The page and the list in the code say the same, row by row."""
    from pathlib import Path

    from autograder.notebook.marks import DIFFERENCES

    page = (Path(__file__).resolve().parents[3] / "docs" / "nbgrader.md").read_text("utf-8").split("\n## ")[0]
    rows = [tuple(part.strip() for part in line.strip("|").split("|")) for line in page.splitlines() if line.startswith("| ")]
    assert tuple(rows[1:]) == DIFFERENCES


@pytest.mark.parametrize("shown", ["array([0.])", "'passed'", "(0+1j)", "[1.0]", None])
def test_where_a_number_of_points_is_due_nothing_else_has_points(shown):
    """A wrong answer that is an array makes one of ``1.0 * (f(2) == 4)``, and full points of it under nbgrader."""
    outputs = [] if shown is None else [result(shown)]
    given = scored(outputs, 3.0, number=True)
    assert (given.points, given.look) == (0.0, True)
    assert "number of points" in given.note
    assert scored(outputs, 3.0).points == 3.0
    assert not returns_number(outputs)


def test_a_number_that_is_due_counts():
    assert scored([result("np.float64(0.5)")], 3.0, number=True) == Mark(0.5)
    assert returns_number([result("np.float64(0.5)")])


@pytest.mark.parametrize(
    ("said", "look"),
    [
        ("mean is an object of type M, which cannot leave the notebook for this test", True),
        ("an argument has a lock in it now, which cannot leave the notebook for this test", True),
        ("the test hands over an object of type P, which cannot go to the learner's process", True),
        ("the learner's process has ended", False),
    ],
)
def test_a_value_that_cannot_reach_its_test_may_be_right_and_asks_for_a_look(said, look):
    given = scored([{"output_type": "error", "ename": "NoAnswer", "evalue": said, "traceback": []}], 3.0)
    assert (given.points, given.look) == (0.0, look)
