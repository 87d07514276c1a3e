"""A course is read from nbgrader_config.py, with nbgrader's names and meanings, without nbgrader."""

import pytest

from autograder.course import Course
from autograder.errors import CourseError
from autograder.notebook.timestamps import parse_utc


def course(tmp_path, text=""):
    (tmp_path / "nbgrader_config.py").write_text(f"c = get_config()\n{text}")
    return Course(tmp_path)


def test_defaults_are_nbgraders(tmp_path):
    made = course(tmp_path)
    assert made.database == f"sqlite:///{tmp_path}/gradebook.db"
    assert made.path("submitted", "ada", "A1") == tmp_path / "submitted/ada/A1"
    assert made.path("source", ".", "A1") == tmp_path / "source/A1"
    assert (made.id, made.level, made.packages, made.timeout, made.penalty()) == ("", None, (), None, None)
    assert (made.permissions("Autograde"), made.permissions("GenerateFeedback")) == (0o444, 0o644)
    assert made.output_limits == (1000, 100)
    assert made.create_students
    assert not made.add_missing


def test_settings_are_found_where_nbgrader_finds_them(tmp_path):
    made = course(
        tmp_path,
        "c.CourseDirectory.course_id = ' geo '\nc.CourseDirectory.submitted_directory = 'in'\n"
        "c.CourseDirectory.groupshared = True\n"
        "c.ExecutePreprocessor.timeout = 7\nc.BaseConverter.permissions = 600\nc.IgnorePattern.enabled = True\n"
        "c.IgnorePattern.pattern = 'x'\nc.Directrix.packages = 'all'\nc.Directrix.level = 'A-'\n"
        "c.LateSubmissionPlugin.penalty_method = 'zero'\nc.Autograde.exclude_overwriting = {'A1': ['mine.py']}\n",
    )
    assert (made.id, made.timeout, made.level, made.packages, made.ignore_pattern) == ("geo", 7.0, "A-", "all", "x")
    assert made.path("submitted", "ada", "A1") == tmp_path / "in/ada/A1"
    assert made.permissions("Autograde") == 0o600
    assert made.penalty()("ada", 3.0, 1.0) == 3.0
    (tmp_path / "source/A1").mkdir(parents=True)
    for name in ("mine.py", "ours.py", "nb.ipynb"):
        (tmp_path / "source/A1" / name).touch()
    assert made.instructor_files("A1") == {"ours.py": b""}


def test_settings_from_nbgraders_command_line_have_their_types(tmp_path):
    """nbgrader autograde --Execute.timeout=2 hands over a string that its trait would have read."""
    from traitlets.config.loader import KVArgParseConfigLoader

    given = KVArgParseConfigLoader(["--Execute.timeout=2", "--CourseDirectory.course_id=geo"]).load_config()
    made = Course(tmp_path, config=given)
    assert (made.timeout, made.id) == (2.0, "geo")


def test_a_plug_in_of_the_course_decides_the_penalty(tmp_path):
    (tmp_path / "mylate.py").write_text(
        "from nbgrader.plugins import BasePlugin\n"
        "class Half(BasePlugin):\n    def late_submission_penalty(self, student, score, late):\n        return score / 2\n"
    )
    made = course(tmp_path, "c.AssignLatePenalties.plugin_class = 'mylate.Half'\n")
    assert made.penalty()("ada", 3.0, 1.0) == 1.5
    missing = course(tmp_path, "c.AssignLatePenalties.plugin_class = 'nowhere.Half'\n")
    with pytest.raises(CourseError, match="cannot be imported"):
        missing.penalty()


def test_a_configuration_that_fails_is_named(tmp_path):
    with pytest.raises(CourseError, match=r"nbgrader_config\.py cannot be read: ZeroDivisionError"):
        course(tmp_path, "1 / 0\n")
    with pytest.raises(CourseError, match="no such folder"):
        Course(tmp_path / "nothing")


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("c.Sandbox.withold = ['answers']", r"c.Sandbox.withold; is c.Sandbox.withhold meant\?"),
        ("c.Directrix.pakages = ('scipy',)", r"c.Directrix.pakages; is c.Directrix.packages meant\?"),
        ("c.Sandbox.x = 1", r"c.Sandbox.x; c.Sandbox has tests, withhold, engine"),
    ],
)
def test_a_misspelt_setting_of_ours_is_refused(tmp_path, line, said):
    """traitlets passes over it, and learners could import what is to be kept from them."""
    (tmp_path / "nbgrader_config.py").write_text(f"c = get_config()\n{line}\n")
    with pytest.raises(CourseError, match=said):
        Course(tmp_path)


def test_submissions_are_found_by_student(tmp_path):
    made = course(tmp_path)
    for place in ("ada/A1", "bob/A1", "bob/A2", ".hidden/A1", "[x]/A1"):
        (tmp_path / "submitted" / place).mkdir(parents=True)
    assert list(made.submissions("A1")) == ["[x]", "ada", "bob"]
    assert list(made.submissions("A2")) == ["bob"]
    other = course(tmp_path, "c.CourseDirectory.directory_structure = '{nbgrader_step}/{assignment_id}/{student_id}'\n"
                             "c.CourseDirectory.student_id_exclude = 'eve'\n")  # fmt: skip
    for place in ("A1/eve", "A1/kim"):
        (tmp_path / "submitted" / place).mkdir(parents=True)
    assert list(other.submissions("A1")) == ["eve", "kim"] or list(other.submissions("A1")) == ["kim"]
    assert "eve" not in other.submissions("A1")


def test_the_courses_own_exercises_go_first(tmp_path):
    made = course(tmp_path)
    assert made.exercise("cylinder").points == 4.0
    assert made.exercise("nothing") is None
    folder = tmp_path / "assignments" / "01-own"
    folder.mkdir(parents=True)
    (folder / "exercises.py").write_text(
        "from autograder.exercise import exercise\n"
        "@exercise(points=9, title='Mine', kind='value')\n"
        "def cylinder(x):\n    '''Twice x.'''\n    return 2 * x\n"
        "@cylinder.data\n"
        "def some(rng):\n    return dict(x=3.0)\n"
    )
    assert Course(tmp_path).exercise("cylinder").points == 9.0
    assert Course(tmp_path).exercise("sphere").points == made.exercise("sphere").points


@pytest.mark.parametrize(
    "text",
    ["2027-02-01 13:00:00.000000 UTC", "2027-02-01 13:00:00", "2027-02-01T13:00:00+02:00", "2027-02-01 13:00:00 Europe/Paris"],
)
def test_dates_are_read_as_nbgrader_reads_them(text):
    from nbgrader.utils import parse_utc as nbgraders

    assert parse_utc(text) == nbgraders(text)


@pytest.mark.parametrize("zone", ["../../../../etc/passwd", "/etc/localtime", "A/../../x", "A\x1b[31m", "X" * 150 + "/"])
def test_a_zone_is_a_name_and_never_the_path_of_a_file(zone):
    with pytest.raises(ValueError, match="zone"):
        parse_utc(f"2027-02-01 13:00:00 {zone}")


def test_a_numeric_zone_is_hours_and_minutes():
    """nbgrader takes +0130 for 130 seconds."""
    from nbgrader.utils import parse_utc as nbgraders

    assert parse_utc("2027-02-01 13:00:00 +0130").isoformat() == "2027-02-01T11:30:00"
    assert parse_utc("2027-02-01 13:00:00 -0500").isoformat() == "2027-02-01T18:00:00"
    assert nbgraders("2027-02-01 13:00:00 +0130").isoformat() == "2027-02-01T12:57:50"
