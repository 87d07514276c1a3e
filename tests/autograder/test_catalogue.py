"""Exercises are found in an assignment folder, in a course folder, and in the set that is shipped."""

import os
from pathlib import Path

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


def test_a_file_that_was_changed_is_read_again_and_else_not(tmp_path):
    """An author changes an exercise and runs the same cell again; meanwhile an exercise is one object."""
    folder = assignment(tmp_path / "01-first", "twice")
    first = catalogue.load(folder).find("twice")
    assert catalogue.load(folder).find("twice") is first
    (folder / "exercises.py").write_text(EXERCISE.format(name="twice").replace("points=2", "points=25"))
    assert catalogue.load(folder).find("twice").points == 25.0


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


@pytest.fixture
def _fresh(monkeypatch):
    """What is installed is looked up once in a process: here, again."""
    catalogue._installed.cache_clear()
    monkeypatch.delenv(catalogue.VARIABLE, raising=False)
    yield
    catalogue._installed.cache_clear()


@pytest.mark.usefixtures("_fresh")
def test_a_course_and_what_lies_beside_a_notebook_are_found_around_it(tmp_path):
    """The instructor's JupyterLab runs in COURSE/source/A20, the learner's where the released files lie."""
    assignment(tmp_path / "course" / "assignments" / "20-first", "twice_in_course")
    (tmp_path / "course" / catalogue.CONFIG).touch()
    (tmp_path / "course" / "source" / "A20").mkdir(parents=True)
    assignment(tmp_path / "work" / catalogue.BESIDE / "20-first", "twice_beside")
    here = catalogue.around(tmp_path / "course" / "source" / "A20")
    assert here.get("twice_in_course") is not None
    assert here.get("cylinder") is not None
    assert catalogue.around(tmp_path / "work").get("twice_beside") is not None
    assert catalogue.around(tmp_path).get("twice_beside") is None


@pytest.mark.usefixtures("_fresh")
def test_a_folder_above_that_belongs_to_somebody_else_is_not_run(tmp_path, monkeypatch):
    """Exercises are code; a course planted in a folder that all may write to is none of ours."""
    assignment(tmp_path / "assignments" / "20-planted", "planted")
    (tmp_path / catalogue.CONFIG).touch()
    place = tmp_path / "mine"
    place.mkdir()
    assert catalogue.around(place).get("planted") is not None
    monkeypatch.setattr(catalogue, "_ours", lambda folder: folder != tmp_path)
    assert catalogue.around(place).get("planted") is None


@pytest.mark.usefixtures("_fresh")
def test_exercises_that_somebody_else_put_beside_a_notebook_are_not_run(tmp_path, monkeypatch):
    """As in a folder that all may write to, such as /tmp."""
    beside = tmp_path / catalogue.BESIDE
    assignment(beside / "20-planted", "planted")
    assert catalogue.around(tmp_path).get("planted") is not None
    monkeypatch.setattr(catalogue, "_ours", lambda folder: folder != beside)
    assert catalogue.around(tmp_path).get("planted") is None


@pytest.mark.usefixtures("_fresh")
def test_the_variable_names_folders_and_comes_before_the_shipped_set(tmp_path, monkeypatch):
    """A folder on a JupyterHub that all can read."""
    assignment(tmp_path / "one" / "20-first", "cylinder")
    assignment(tmp_path / "two" / "21-second", "twice_shared")
    monkeypatch.setenv(catalogue.VARIABLE, f"{tmp_path / 'one'}{os.pathsep}{tmp_path / 'two'}")
    assert catalogue.installed().get("twice_shared") is not None
    assert catalogue.installed().find("cylinder").title == "Twice"
    monkeypatch.setenv(catalogue.VARIABLE, str(tmp_path / "nowhere"))
    with pytest.raises(CourseError, match="no such folder"):
        catalogue.installed()


@pytest.mark.usefixtures("_fresh")
@pytest.mark.parametrize(
    ("value", "said"), [("own_course_exercises", None), ("own_course_exercises_not", "must name a package")]
)
def test_an_installed_package_declares_its_exercises(tmp_path, monkeypatch, value, said):
    """The entry point group `directrix.exercises`, read from the metadata as pip writes it."""
    assignment(tmp_path / "own_course_exercises" / "20-first", "twice_installed")
    (tmp_path / "own_course_exercises" / "__init__.py").touch()
    metadata = tmp_path / "own_course-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: own-course\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(f"[{catalogue.GROUP}]\nown = {value}\n")
    monkeypatch.syspath_prepend(tmp_path)
    if said is None:
        assert catalogue.installed().get("twice_installed") is not None
    else:
        with pytest.raises(CourseError, match=said):
            catalogue.installed()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("def (", r"exercises\.py:1: SyntaxError"),
        ("x = 1\ny = x / 0", r"exercises\.py:2: ZeroDivisionError"),
        (
            EXERCISE.format(name="twice").replace("points=2", "points=-1"),
            r"exercises\.py:4: ExerciseError: twice: points must be",
        ),
    ],
)
def test_a_file_that_cannot_be_loaded_is_told_with_its_line(tmp_path, monkeypatch, text, said):
    """No traceback through the loader: the author's own line, also of a folder that is named from where one is."""
    (tmp_path / "01-first").mkdir()
    (tmp_path / "01-first" / "exercises.py").write_text(text)
    with pytest.raises(CourseError, match=said):
        catalogue.load(tmp_path)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(CourseError, match=said):
        catalogue.load(Path("01-first"))
