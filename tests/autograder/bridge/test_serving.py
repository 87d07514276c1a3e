"""What the guard of formgrader's server takes for a course inside a course, and which files it seals."""

from types import SimpleNamespace

import pytest
from nbconvert.exporters import HTMLExporter
from nbformat.v4 import new_notebook, new_raw_cell
from traitlets.config import Config

from autograder import bridge
from autograder.bridge.serving import EXPORTER, PDF, SEALED, _seal, _showing, course_around


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


def test_a_page_whose_settings_came_too_late_is_ours_all_the_same():
    """Where the course's root is another folder, nbgrader makes its exporter before it has read the course's configuration."""
    stock = {"template_name": "formgrade", "extra_template_basedirs": bridge._nbgrader_templates()}
    handler = SimpleNamespace(settings={EXPORTER: HTMLExporter(config=Config(HTMLExporter=stock))})
    show = _showing(bridge.pages_of_formgrader)
    learners = new_notebook(cells=[new_raw_cell("<script>window.stolen = 1</script>")])
    page, _ = show(handler).from_notebook_node(learners, resources={"index": 0, "total": 1})
    assert "<script>window.stolen" not in page
    assert "cdnjs" not in page
    assert show(handler) is handler.settings[EXPORTER]  # made once


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
