"""`directrix new --exercise`: a template of each kind that keeps every rule at once, and that overwrites nothing."""

import pytest

from autograder import catalogue
from autograder.authoring import breaches, new_exercise
from autograder.authoring.template import KINDS
from autograder.errors import CourseError


@pytest.mark.parametrize("kind", KINDS)
def test_each_template_keeps_every_rule_and_all_advice(tmp_path, kind):
    """Its notebook poses it, with its points."""
    folder = new_exercise(tmp_path / "20-roofs", "barrel_roof", kind, 2.5)
    made = catalogue.load_assignment(folder)
    assert list(breaches(made, range(5))) == []
    assert (made.exercises["barrel_roof"].kind, made.points) == (kind, 2.5)


def test_a_second_exercise_is_added_at_the_ends_of_what_is_there(tmp_path):
    """What was written before stays byte for byte."""
    folder = new_exercise(tmp_path / "20-roofs", "barrel_roof")
    before = {name: (folder / name).read_text() for name in ("exercises.py", "notebook.py")}
    assert new_exercise(folder, "ridge", "curve") == folder
    for name, text in before.items():
        assert (folder / name).read_text().startswith(text)
    made = catalogue.Catalogue((catalogue.load_assignment(folder),))
    assert [one.id for one in made] == ["barrel_roof", "ridge"]


def test_in_a_course_it_gets_the_next_free_number(tmp_path):
    """Above the shipped assignments and the course's own."""
    (tmp_path / "nbgrader_config.py").touch()
    (tmp_path / "source" / "A41").mkdir(parents=True)
    assert new_exercise(tmp_path, "barrel_roof").name == "42-barrel-roof"
    assert new_exercise(tmp_path, "ridge").name == "43-ridge"


@pytest.mark.parametrize(
    ("name", "options", "said"),
    [
        ("Barrel Roof", {}, "small letters, digits and underscores"),
        ("class", {}, "small letters, digits and underscores"),
        ("check", {}, "small letters, digits and underscores"),
        ("roof", {"kind": "solid"}, "there are templates for surface, curve, value; got 'solid'"),
        ("roof", {"points": 0}, "points must be above 0; got 0"),
        ("roof", {"points": float("nan")}, "points must be above 0; got nan"),
        ("cylinder", {}, "01-known-forms has an exercise 'cylinder' already"),
        ("taken", {}, "20-roofs has an exercise 'taken' already"),
    ],
)
def test_what_cannot_be_is_refused_and_nothing_is_written(tmp_path, name, options, said):
    """The message says what to write instead."""
    folder = new_exercise(tmp_path / "20-roofs", "taken")
    before = (folder / "exercises.py").read_text()
    for place in (folder, tmp_path / "21-more"):
        with pytest.raises(CourseError, match=said):
            new_exercise(place, name, **options)
    assert (folder / "exercises.py").read_text() == before
    assert not (tmp_path / "21-more").exists()


def test_a_folder_that_is_no_course_and_no_assignment_is_refused(tmp_path):
    """An exercise that nothing finds is no use."""
    with pytest.raises(CourseError, match="neither a course"):
        new_exercise(tmp_path, "roof")
    assert list(tmp_path.iterdir()) == []


def test_exercises_in_a_package_are_left_to_their_author(tmp_path):
    """Which of its files is meant, nobody knows."""
    package = tmp_path / "20-roofs" / "exercises"
    package.mkdir(parents=True)
    (package / "__init__.py").touch()
    with pytest.raises(CourseError, match="keeps its exercises in a package"):
        new_exercise(tmp_path / "20-roofs", "roof")
