"""Grading with numbers of one's own: a student's folder says whose they are, and hidden data stay hidden."""

import re

import pytest

from autograder import authoring, personal
from autograder.catalogue import shipped
from autograder.fleet import Course, grade

BACKWARDS = """def linear_sweep(u, w, curve, direction, d):
    direction = np.asarray(direction, float)
    if not direction.any():
        raise ValueError("no direction")
    return curve(u) - np.asarray(w)[..., None] * d * direction / np.linalg.norm(direction)
"""


@pytest.fixture(scope="module")
def graded(tmp_path_factory, classroom):
    """Ada typed her id, Bob typed Ada's; both sweep backwards."""
    folder = tmp_path_factory.mktemp("own") / "course"
    authoring.new_course(folder, ("A2",))
    authoring.release(folder, "A2")
    room = classroom(folder, "A2")

    def typed(id):
        def change(nb):
            for cell in nb["cells"]:
                named = cell["metadata"].get("nbgrader", {}).get("grade_id")
                text = BACKWARDS if named == "linear_sweep" else "".join(cell["source"])
                cell["source"] = text.replace('student = ""', f'student = "{id}"')

        return change

    for student in ("ada", "bob"):
        room.hand_in(student, {"linear-sweep": typed("ada")})
    report = grade(Course(folder), "A2", workers=1)
    return room, {one.student: one for one in report.students}


def shown(room, student):
    """The graded notebook of a student as text."""
    return (room.folder / "autograded" / student / "A2" / "linear-sweep.ipynb").read_text()


def salt(room):
    (word,) = set(re.findall(r'personal\.course\(\\"(\w+)\\"\)', (room.folder / "release/A2/linear-sweep.ipynb").read_text()))
    return word


def test_each_is_judged_with_the_numbers_of_the_folders_name(graded):
    """The mistake is named for both; only the note tells that an id was not the student's."""
    _, reports = graded
    for student in ("ada", "bob"):
        (cell,) = [one for one in reports[student].cells if one.name == "check_linear_sweep"]
        assert (cell.mistake, cell.points) == ("backwards", 3.0)
    assert not any("typed" in note for note in reports["ada"].notes)
    (note,) = [note for note in reports["bob"].notes if "typed" in note]
    assert "'ada'" in note
    assert "the numbers of bob" in note


def test_a_notebook_shows_in_the_sandbox_what_it_showed_at_home(graded):
    """Bob's cell shows the numbers of the id that he typed: the cell is his, and decides nothing."""
    room, _ = graded
    rng = personal.generator(personal.seed(salt(room), "ada"), "linear_sweep", "yours")
    line = f"Your direction is {rng.integers(1, 6, 3)} and your d is {rng.integers(2, 7)}"
    assert line in shown(room, "ada")
    assert line in shown(room, "bob")


def test_the_seed_that_public_numbers_come_from_is_none_of_the_hidden_ones(graded):
    """The released notebook holds the word; what the secret draws for the same student is something else."""
    room, _ = graded
    sweep = shipped().find("linear_sweep")
    word = salt(room)
    assert Course(room.folder).salt() == word
    assert (room.folder / ".directrix" / "secret").read_text().strip() not in shown(room, "ada")
    publics = [one.arguments["d"] for one in sweep.of_student(personal.seed(word, "ada")).draw() if one.name == "any_curve"]
    assert publics != [one.arguments["d"] for one in sweep.draw() if one.name == "any_curve"]
