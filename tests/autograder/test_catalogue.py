"""Exercises are found in an assignment folder, in a course folder, and in the set that is shipped."""

import pytest

from autograder import catalogue
from autograder.errors import CourseError, ExerciseError

EXERCISE = '''
from autograder.exercise import exercise

@exercise(points=2, title="Twice", kind="value")
def {name}(a):
    """Twice a."""
    return 2 * a
'''


def assignment(folder, name):
    folder.mkdir(parents=True)
    (folder / "exercises.py").write_text(EXERCISE.format(name=name))
    return folder


def test_an_assignment_folder_a_folder_of_them_and_a_course_are_all_found(tmp_path):
    """An instructor adds a course of her own by adding a folder."""
    first = assignment(tmp_path / "assignments" / "01-first-steps", "twice")
    assignment(tmp_path / "assignments" / "02-second", "double")
    (tmp_path / "assignments" / "notes").mkdir()
    assert [e.id for e in catalogue.load(first)] == ["twice"]
    assert [e.id for e in catalogue.load(tmp_path / "assignments")] == ["twice", "double"]
    assert [e.id for e in catalogue.load(tmp_path)] == ["twice", "double"]


def test_an_assignment_answers_to_its_number_its_slug_and_its_folder(tmp_path):
    """`A1` is what nbgrader calls the folder 01-first-steps."""
    course = catalogue.load(assignment(tmp_path / "01-first-steps", "twice").parent)
    for name in ("A1", "first-steps", "01-first-steps"):
        assert course.assignment(name).name == "A1"
    assert course.assignment("A1").points == 2.0
    with pytest.raises(CourseError, match="no assignment is called 'A7'; there are: A1"):
        course.assignment("A7")


def test_an_unknown_exercise_is_refused_with_the_names_there_are(tmp_path):
    """`get` answers None for it, `find` says what to choose from."""
    course = catalogue.load(assignment(tmp_path / "01-first", "twice"))
    assert course.get("thrice") is None
    with pytest.raises(ExerciseError, match="no exercise is called 'thrice'; there are: twice"):
        course.find("thrice")


def test_one_id_in_two_assignments_is_refused(tmp_path):
    """`check(twice)` could mean either."""
    assignment(tmp_path / "01-first", "twice")
    assignment(tmp_path / "02-second", "twice")
    with pytest.raises(CourseError, match="'twice' is in 01-first and in 02-second"):
        catalogue.load(tmp_path)


@pytest.mark.parametrize(("make", "message"), [(False, "no such folder"), (True, "no assignment in")])
def test_a_folder_without_assignments_is_refused(tmp_path, make, message):
    """The message says which layout is wanted."""
    folder = tmp_path / "empty"
    if make:
        folder.mkdir()
    with pytest.raises(CourseError, match=message):
        catalogue.load(folder)


def test_a_module_that_fails_leaves_nothing_behind_and_can_be_mended(tmp_path):
    """The instructor mends the typing slip and loads again in the same process."""
    folder = assignment(tmp_path / "01-first", "twice")
    good = (folder / "exercises.py").read_text()
    (folder / "exercises.py").write_text("import nothing_of_this_name")
    with pytest.raises(CourseError, match=r"exercises\.py:1: ModuleNotFoundError: No module named 'nothing_of_this_name'"):
        catalogue.load(folder)
    (folder / "exercises.py").write_text(good)
    assert [e.id for e in catalogue.load(folder)] == ["twice"]


def test_an_exercises_module_without_an_exercise_is_refused(tmp_path):
    """A file of plain functions earns no marks silently."""
    folder = tmp_path / "01-first"
    folder.mkdir()
    (folder / "exercises.py").write_text("def twice(a):\n    return 2 * a\n")
    with pytest.raises(CourseError, match="declares no exercise"):
        catalogue.load(folder)


def test_the_shipped_set_starts_with_the_known_forms():
    """The course that comes with the package."""
    assert catalogue.shipped().assignment("A1").slug == "known-forms"
