"""What the guard of formgrader's server takes for a course inside a course, and which files it seals."""

import pytest

from autograder.bridge.serving import PDF, SEALED, _seal, course_around


@pytest.fixture
def courses(tmp_path):
    """Two courses in a home that has a configuration of its own, as nbgrader's pages suggest."""
    (tmp_path / "nbgrader_config.py").touch()
    for name in ("first", "second"):
        (tmp_path / name / "source").mkdir(parents=True)
        (tmp_path / name / "submitted" / "ada" / "A1").mkdir(parents=True)
    (tmp_path / "first" / "nbgrader_config.py").touch()
    return tmp_path


def test_a_folder_of_a_course_is_no_course(courses):
    """Whatever course is loaded, and whatever lies in the folder."""
    submitted = courses / "first" / "submitted" / "ada" / "A1"
    (submitted / "nbgrader_config.py").touch()
    assert course_around(submitted, courses) == courses / "first"
    assert course_around(submitted / ".." / "A1", courses / "second") == courses / "first"


def test_a_course_without_a_configuration_of_its_own_is_known_while_it_is_loaded(courses):
    submitted = courses / "second" / "submitted" / "ada"
    assert course_around(submitted, courses / "second") == courses / "second"
    assert course_around(submitted, courses / "first") is None
    (courses / "second" / "gradebook.db").touch()
    assert course_around(submitted, courses / "first") == courses / "second"


def test_courses_beside_and_below_a_configuration_can_be_opened(courses):
    """A home with an ``nbgrader_config.py`` is no course: it has neither source nor submitted."""
    for loaded in (courses, courses / "first"):
        assert course_around(courses / "first", loaded) is None
        assert course_around(courses / "second", loaded) is None


@pytest.mark.parametrize(("kind", "sealed"), [("text/html", True), ("image/svg+xml", True), ("image/png", True), (PDF, False)])
def test_a_file_beside_a_notebook_has_no_scripts(kind, sealed):
    class Answer(dict):
        set_header = dict.__setitem__

        def get_content_type(self):
            return kind

    answer = Answer()
    _seal(answer, "file")
    assert answer["X-Content-Type-Options"] == "nosniff"
    assert (answer.get("Content-Security-Policy") == SEALED) is sealed
