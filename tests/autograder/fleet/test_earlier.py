"""A later function that is wrong only because an earlier one of the same notebook is: graded in the real sandbox.

The card says which function to put right first. The marks are those of any answer: what is listed is worth what the list says,
and else the share of the data sets that are right, times 1/2; nobody gets points for what another task may have spoilt.
"""

import json

import pytest

from autograder import authoring
from autograder.fleet import grade

# Right up to degree 3, half as much again from there on: no listed mistake, and seen by one drawn data set in two.
CAPPED = """def bernstein(n, t):
    t = np.asarray(t, float)[..., None]
    i = np.arange(n + 1)
    return pascal(n) * t**i * (1 - t) ** (n - i) * (1 if n <= 3 else 1.5)
"""
LISTED = CAPPED.replace("pascal(n) * ", "").replace(" * (1 if n <= 3 else 1.5)", "")  # no_binomials: half marks
PATCH = """def bezier_patch(u, w, P):
    P = np.asarray(P, float)
    m, n, _ = P.shape
    return np.einsum("...i,...j,ijk->...k", bernstein(m - 1, u), bernstein(n - 1, w), P)
"""
HANDED_IN = {
    "capped": {"bernstein": CAPPED, "bezier_patch": PATCH},
    "listed": {"bernstein": LISTED, "bezier_patch": PATCH},
    "stub": {"bezier_patch": PATCH},
    "both": {"bernstein": CAPPED, "bezier_patch": PATCH.replace("w), P)", "w), P) + [0, 0, 1 + u * w]")},
    "alone": {"bernstein": CAPPED, "bezier_patch": PATCH.replace("bernstein(", "own(") + CAPPED.replace("bernstein", "own")},
}


@pytest.fixture(scope="module")
def graded(tmp_path_factory, classroom):
    """A6 as each of them handed it in: the cells by student and name, and the cards."""
    folder = tmp_path_factory.mktemp("earlier") / "course"
    authoring.new_course(folder, ("A6",))
    authoring.release(folder, "A6")
    room = classroom(folder, "A6")
    (notebook,) = [path.stem for path in (folder / "release" / "A6").glob("*.ipynb")]
    for student, sources in HANDED_IN.items():
        room.hand_in(student, {notebook: sources})
    report = grade(room.course(), "A6", workers=1)
    assert report.failures == ()
    points, cards = {}, {}
    for student in HANDED_IN:
        nb = json.loads((folder / "autograded" / student / "A6" / f"{notebook}.ipynb").read_text())
        for cell in nb["cells"]:
            name = cell["metadata"].get("nbgrader", {}).get("grade_id", "").removeprefix("check_")
            if name in ("bernstein", "bezier_patch") and cell["metadata"]["nbgrader"]["grade"]:
                texts = [output["data"]["text/plain"] for output in cell["outputs"] if "text/html" in output.get("data", {})]
                cards[student, name] = "".join("".join(text) for text in texts)
        points |= {(student, cell.name.removeprefix("check_")): cell.points for cell in report.student(student).cells}
    return points, cards


@pytest.mark.parametrize("student", ["capped", "listed"])
def test_the_card_says_which_function_to_put_right_first(graded, student):
    """The proof is worked out with the learner's own function, called in the sandbox; the earlier one has a card of its own."""
    _, cards = graded
    later, earlier = cards[student, "bezier_patch"], cards[student, "bernstein"]
    assert "bezier_patch does with your bernstein just what it should." in later
    assert "It comes out wrong only because bernstein, which it calls, is not right yet." in later
    assert "Next: Put bernstein right and check again; bezier_patch needs no change." in later
    assert "only because" not in earlier
    assert "forgot how often its product occurs" not in later  # the listed mistake's hint, which belongs to the other card


def test_the_marks_are_those_of_any_such_answer(graded):
    """Half of the drawn data sets are right: 1/2 x 1/2 of 6 points. The listed mistake of both: 1/2 of 4, 1/4 of 6."""
    points, cards = graded
    assert points["capped", "bezier_patch"] == points["alone", "bezier_patch"] == 1.5
    assert (points["listed", "bernstein"], points["listed", "bezier_patch"]) == (2.0, 1.5)
    assert points["stub", "bernstein"] == points["stub", "bezier_patch"] == 0.0
    assert "Worth: 0.5 (right on 1 of 2 data sets" in cards["capped", "bezier_patch"]
    assert "= 0.25 of the points." in cards["capped", "bezier_patch"]


def test_the_stub_of_an_earlier_function_is_named(graded):
    """Nothing is said against the function that is written."""
    _, cards = graded
    assert "bezier_patch calls bernstein, which is not written yet." in cards["stub", "bezier_patch"]
    assert "bezier_patch is not written yet" not in cards["stub", "bezier_patch"]


def test_a_fault_of_its_own_is_not_blamed_on_the_earlier(graded):
    """Where it calls the wrong function and is wrong besides, no more is said than that; where it calls none, nothing."""
    _, cards = graded
    assert "bezier_patch calls bernstein, which is not right yet: put that right first" in cards["both", "bezier_patch"]
    assert "only because" not in cards["both", "bezier_patch"]
    assert "bernstein" not in cards["alone", "bezier_patch"]
