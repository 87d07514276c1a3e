"""Grading with numbers of one's own: a student's folder says whose they are, and hidden data stay hidden."""

import re

import pytest

from autograder import personal
from autograder.catalogue import shipped
from autograder.fleet import Course, grade


@pytest.fixture(scope="module")
def graded(own_numbers_template, tmp_path_factory):
    """Ada typed her id, Bob typed Ada's, Eve none; all sweep backwards."""
    room = own_numbers_template.copy(tmp_path_factory.mktemp("own") / "course")
    report = grade(room.course(), "A2", workers=1)
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
    for student in ("ada", "bob", "eve"):
        (cell,) = [one for one in reports[student].cells if one.name == "check_linear_sweep"]
        assert (cell.mistake, cell.points) == ("backwards", 3.0)
    assert not any("typed" in note for student in ("ada", "eve") for note in reports[student].notes)
    (note,) = [note for note in reports["bob"].notes if "typed" in note]
    assert "'ada'" in note
    assert "the numbers of bob" in note


def numbers_of(room, student):
    """The line that the notebook prints with that student's numbers."""
    rng = personal.generator(personal.seed(salt(room), student), "linear_sweep", "yours")
    return f"Your direction is {rng.integers(1, 6, 3)} and your d is {rng.integers(2, 7)}"


def test_a_notebook_shows_in_the_sandbox_what_it_showed_at_home(graded):
    """Bob's cell shows the numbers of the id that he typed: the cell is his, and decides nothing."""
    room, _ = graded
    assert numbers_of(room, "ada") != numbers_of(room, "eve")
    for student, whose in (("ada", "ada"), ("bob", "ada")):
        assert numbers_of(room, whose) in shown(room, student)


def test_where_no_id_was_typed_it_shows_what_it_showed_on_a_hub(graded, monkeypatch):
    """A hub tells the notebook who is logged in; the sandbox tells it whose work it is. The card is about the same numbers."""
    room, _ = graded
    monkeypatch.setenv("JUPYTERHUB_USER", "eve")
    monkeypatch.setattr(personal, "_here", {"salt": salt(room), "student": ""})
    rng = personal.numbers("linear_sweep", "")
    line = f"Your direction is {rng.integers(1, 6, 3)} and your d is {rng.integers(2, 7)}"
    assert line == numbers_of(room, "eve")
    assert line in shown(room, "eve")


def test_the_seed_that_public_numbers_come_from_is_none_of_the_hidden_ones(graded):
    """The released notebook holds the word; what the secret draws for the same student is something else."""
    room, _ = graded
    sweep = shipped().find("linear_sweep")
    word = salt(room)
    assert Course(room.folder).salt() == word
    assert (room.folder / ".directrix" / "secret").read_text().strip() not in shown(room, "ada")
    publics = [one.arguments["d"] for one in sweep.of_student(personal.seed(word, "ada")).draw() if one.name == "any_curve"]
    assert publics != [one.arguments["d"] for one in sweep.draw() if one.name == "any_curve"]
