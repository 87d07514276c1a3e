"""The sample class as a whole: who is in it, what lies in their folders, and how a grading is held to it."""

import json
import re
from types import SimpleNamespace

import nbformat
import pytest

from autograder.catalogue import shipped
from autograder.demo import cohort, submit, submit_one, surprises
from autograder.demo.snippets import cells
from autograder.notebook import source

ASSIGNMENTS = list(shipped().assignments)
NAMES = [assignment.name for assignment in ASSIGNMENTS]
WANTED = {
    "vectorised", "loops", "lists", "vectorize", "matrix", "tricks", "float32", "half-finished", "import-error", "endless-loop",
    "hang-in-c", "memory", "os-exit", "sys-exit", "truncated", "deleted-cells", "pasted-twice", "skip-execution", "print-flood",
    "nan-at-the-pole", "patch-numpy", "read-reference", "write-gradebook", "forge-output", "open-socket", "read-classmate",
}  # fmt: skip
each_assignment = pytest.mark.parametrize("assignment", ASSIGNMENTS, ids=NAMES)


class Folders:
    """A course as far as handing in goes."""

    def __init__(self, root):
        self.root = root

    def path(self, step, student, assignment):
        return self.root / step / student / assignment


def the(name, slug):
    return next(member for member in cohort(name) if member.student_id.endswith(f"-{slug}"))


def filled_in(released, name, slug):
    return the(name, slug).notebook(released[name])


def cell(nb, grade_id):
    return nb.cells[places(nb, grade_id)[0]]


def places(nb, grade_id):
    return [i for i, c in enumerate(nb.cells) if c.metadata.get("nbgrader", {}).get("grade_id") == grade_id]


@each_assignment
def test_everyone_is_there_once(assignment):
    ids = [member.student_id for member in cohort(assignment.name)]
    assert len(ids) >= 16
    assert ids == sorted(set(ids))
    assert all(re.fullmatch(r"s\d\d-[a-z0-9-]+", id) for id in ids)
    assert {id[4:] for id in ids} >= WANTED


@each_assignment
def test_every_listed_mistake_is_made_by_somebody(assignment):
    made = {(id, mistake) for member in cohort(assignment.name) for id, mistake in member.mistakes.items()}
    assert made == {(exercise.id, mistake.id) for exercise in assignment.exercises.values() for mistake in exercise.mistakes}


@each_assignment
def test_no_snippet_is_left_over(assignment):
    """A renamed exercise or mistake must not leave a snippet behind that nobody hands in."""
    for style in ("vectorised", "loops", "lists", "vectorize", "matrix", "tricks", "float32"):
        assert list(cells(assignment.slug, style)) == list(assignment.exercises), style
    listed = [f"{exercise.id}: {mistake.id}" for exercise in assignment.exercises.values() for mistake in exercise.mistakes]
    assert sorted(cells(assignment.slug, "mistakes")) == sorted(listed)
    for style in ("single_points", "nan_at_pole", "careless"):
        assert set(cells(assignment.slug, style)) <= set(assignment.exercises), style


@each_assignment
def test_expectations_name_every_exercise_and_stay_within_its_points(assignment):
    for member in cohort(assignment.name):
        if member.expected is not None:
            assert list(member.expected) == list(assignment.exercises), member.student_id
            assert all(share is None or 0 <= share <= 1 for share in member.expected.values()), member.student_id


@each_assignment
def test_the_same_class_hands_in_the_same_bytes(assignment, released, tmp_path):
    """And the released notebook stays as it was."""
    before = source.dumps(released[assignment.name])
    for room in ("one", "two"):
        for member in cohort(assignment.name):
            member.write(released[assignment.name], tmp_path / room / member.student_id)
    one, two = (sorted((tmp_path / room).rglob("*.ipynb")) for room in ("one", "two"))
    assert len(one) == len(cohort(assignment.name))
    assert [path.read_bytes() for path in one] == [path.read_bytes() for path in two]
    assert source.dumps(released[assignment.name]) == before


@each_assignment
def test_all_but_the_truncated_file_are_valid_notebooks(assignment, released, tmp_path):
    for member in cohort(assignment.name):
        member.write(released[assignment.name], tmp_path)
        text = (tmp_path / member.file).read_text("utf-8")
        if member.expected is None:
            with pytest.raises(json.JSONDecodeError):
                json.loads(text)
        else:
            nb = nbformat.reads(text, as_version=4)
            nbformat.validate(nb)
            assert len({c.id for c in nb.cells}) == len(nb.cells), member.student_id


@each_assignment
def test_task_cells_hold_the_learners_code(assignment, released):
    nb = filled_in(released, assignment.name, "loops")
    for id in assignment.exercises:
        assert cell(nb, id).source == cells(assignment.slug, "loops")[id]
        assert cell(nb, f"check_{id}").source == f"check({id})"
    written = [c for c in nb.cells if c.cell_type == "markdown" and c.metadata.get("nbgrader", {}).get("grade")]
    assert written
    assert all("YOUR ANSWER HERE" not in c.source for c in written)


def test_what_became_of_cells(released):
    """Deleted, pasted twice, tagged, and overwritten with forged outputs."""
    nb = filled_in(released, "A1", "deleted-cells")
    assert not places(nb, "cylinder")
    assert not places(nb, "check_frustum")
    twins = places(filled_in(released, "A1", "pasted-twice"), "check_cylinder")
    assert twins == [twins[0], twins[0] + 1]
    assert cell(filled_in(released, "A1", "skip-execution"), "check_torus").metadata.tags == ["skip-execution"]
    forged = cell(filled_in(released, "A1", "forge-output"), "check_torus")
    assert forged.source == "_Points(6.0)"
    assert forged.metadata.nbgrader.points == 1000.0
    assert not forged.metadata.nbgrader.locked
    assert forged.outputs[-1].data["text/plain"] == "6.0"


def test_a_scratch_cell_stands_where_it_was_added(released):
    nb = filled_in(released, "A1", "hang-in-c")
    assert "10**13" in nb.cells[places(nb, "check_frustum")[0] + 1].source
    nb = filled_in(released, "A1", "import-error")
    code = [c.source for c in nb.cells if c.cell_type == "code"]
    assert "import numpy as np" in code[0]
    assert code[1].startswith("from surfaces_toolbox")


def test_submissions_land_in_the_courses_folders(released, tmp_path):
    path = tmp_path / "release" / "known-forms.ipynb"
    path.parent.mkdir()
    path.write_text(source.dumps(released["A1"]), "utf-8")
    members = submit(path, Folders(tmp_path), "A1")
    there = sorted(str(p.relative_to(tmp_path / "submitted")) for p in (tmp_path / "submitted").rglob("*.ipynb"))
    assert there == [f"{member.student_id}/A1/known-forms.ipynb" for member in members]
    folder = submit_one(members[0], path, Folders(tmp_path), "A1", student_id="somebody-else")
    assert folder == tmp_path / "submitted" / "somebody-else" / "A1"
    assert (folder / "known-forms.ipynb").is_file()


def exact_grading():
    """A report of A1 that is as expected; tests spoil it."""
    students = {}
    for member in cohort("A1"):
        graded = {}
        for id, share in (member.expected or {}).items():
            available = shipped().find(id).points
            graded[f"check_{id}"] = SimpleNamespace(
                name=f"check_{id}",
                points=None if share is None else share * available,
                available=available,
                look=share is None or id in member.flagged,
                mistake=member.mistakes.get(id),
            )
        broken = ("no JSON",) if member.expected is None else ()
        students[member.student_id] = SimpleNamespace(student=member.student_id, cells=graded, broken=broken)
    return students


def told(students):
    made = [SimpleNamespace(**{**vars(student), "cells": tuple(student.cells.values())}) for student in students.values()]
    return surprises("A1", SimpleNamespace(students=made))


def test_an_exact_grading_holds_no_surprise():
    assert told(exact_grading()) == []


@pytest.mark.parametrize(
    ("slug", "exercise", "change", "expected"),
    [
        ("vectorised", "torus", {"points": 5.0}, "s01-vectorised, torus: 6 points expected, 5 points given"),
        ("forge-output", "torus", {"points": 6.0}, "s34-forge-output, torus: 0 points expected, 6 points given"),
        ("vectorised", "torus", {"points": None}, "s01-vectorised, torus: 6 points expected, no mark given"),
        ("deleted-cells", "frustum", {"points": 5.0}, "s28-deleted-cells, frustum: no mark expected, 5 points given"),
        (
            "mistakes-1", "cylinder", {"mistake": None},
            "s07-mistakes-1, cylinder: the mistake no_2pi was not named; told None",
        ),
        ("pasted-twice", "cylinder", {"look": False}, "s29-pasted-twice, cylinder: no manual look is asked for"),
    ],
)  # fmt: skip
def test_each_surprise_is_named(slug, exercise, change, expected):
    students = exact_grading()
    vars(students[the("A1", slug).student_id].cells[f"check_{exercise}"]).update(change)
    assert told(students) == [expected]


def test_a_missing_student_and_a_broken_notebook_that_nobody_named():
    students = exact_grading()
    del students["s01-vectorised"]
    students[the("A1", "truncated").student_id].broken = ()
    assert told(students) == [
        "s01-vectorised: is not in the report",
        "s27-truncated: cannot be read, and is not named as broken",
    ]
