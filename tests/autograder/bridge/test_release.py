"""An assignment whose exercise cells cannot be graded as they stand is not released."""

import json
import zipfile

import nbformat
import pytest

from autograder import authoring
from autograder.cli import collecting
from autograder.errors import CourseError


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("release") / "course"
    authoring.new_course(folder, ("A1",))
    return folder


@pytest.fixture
def source(made):
    """The source notebook with a way to change one cell; restored afterwards."""
    path = made / "source" / "A1" / "known-forms.ipynb"
    before = path.read_bytes()

    def change(grade_id, **changes):
        notebook = nbformat.read(path, 4)
        (cell,) = [cell for cell in notebook.cells if cell.metadata.get("nbgrader", {}).get("grade_id") == grade_id]
        cell.source = changes.get("source", cell.source)
        if "points" in changes:
            cell.metadata.nbgrader.points = changes["points"]
        nbformat.write(notebook, path)

    yield change
    path.write_bytes(before)


def test_the_shipped_notebook_is_released(made):
    """The neighbour that must pass."""
    assert (authoring.release(made, "A1") / "known-forms.ipynb").is_file()


def test_a_course_whose_folders_have_names_of_its_own_is_released_and_collected_there(tmp_path, capsys):
    """An nbgrader course from elsewhere: another root, other names, and students below assignments."""
    folder = tmp_path / "elsewhere"
    authoring.new_course(folder, ("A1",))
    (folder / "instructor").mkdir()
    (folder / "source").rename(folder / "instructor" / "src")
    with (folder / "nbgrader_config.py").open("a") as config:
        config.write(
            'c.CourseDirectory.root = "instructor"\nc.CourseDirectory.source_directory = "src"\n'
            'c.CourseDirectory.release_directory = "student"\nc.CourseDirectory.submitted_directory = "handins"\n'
            'c.CourseDirectory.directory_structure = "{nbgrader_step}/{assignment_id}/{student_id}"\n'
        )
    released = authoring.release(folder, "A1")
    assert released == folder / "instructor" / "student" / "A1"
    assert (released / "known-forms.ipynb").is_file()
    with pytest.raises(CourseError, match=r"no assignment 'A2' in .*elsewhere/instructor/src; there are: A1"):
        authoring.release(folder, "A2")
    with zipfile.ZipFile(tmp_path / "class.zip", "w") as archive:
        archive.write(released / "known-forms.ipynb", "ada/known-forms.ipynb")
    collecting.collect(tmp_path / "class.zip", "A1", course=folder)
    assert f"1 submission of A1 in {folder}/instructor/handins" in capsys.readouterr().out.replace("\n", "")
    assert (folder / "instructor" / "handins" / "A1" / "ada" / "known-forms.ipynb").is_file()


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"source": "x = check(torus)"}, "cell 'check_torus' must be exactly check(name)"),
        ({"source": "check('torus')"}, "must be exactly check(name)"),
        ({"source": "check(torus); check(torus)"}, "must be exactly check(name)"),
        ({"source": "check(tyre)"}, "cell 'check_torus' checks 'tyre', but no exercise has that name"),
        ({"points": 7}, "cell 'check_torus' gives 7 points, but the exercise 'torus' is worth 6"),
    ],
)
def test_a_cell_that_could_not_be_graded_stops_the_release_by_name(made, source, changes, says):
    """nbgrader's own command goes through the same preprocessor; nothing is half-released."""
    source("check_torus", **changes)
    with pytest.raises(CourseError, match="could not release A1") as caught:
        authoring.release(made, "A1")
    assert str(caught.value).startswith("nbgrader could not release A1: cell 'check_torus' ")
    assert says in str(caught.value)


def test_what_nbgrader_raises_is_told_without_its_lines_of_code(made, source):
    source("torus", source="x = 1\n### BEGIN SOLUTION")
    with pytest.raises(CourseError) as caught:
        authoring.release(made, "A1")
    assert str(caught.value) == "nbgrader could not release A1: RuntimeError: no end solution statement found"


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (
            b"\xef\xbb\xbf{}",
            "known-forms.ipynb begins with a byte order mark, which nbgrader cannot read; save it as UTF-8 without",
        ),
        (b"\xff\xfe{\0}\0", "begins with a byte order mark"),
        (b"not json", "known-forms.ipynb cannot be released: the file is no notebook: it begins with 'not json'"),
        (None, "source/A1; put one there, a file whose name ends in .ipynb"),
    ],
)
def test_a_notebook_that_nbgrader_cannot_read_is_named_with_what_to_do(made, data, says):
    path = made / "source" / "A1" / "known-forms.ipynb"
    before = path.read_bytes()
    path.unlink() if data is None else path.write_bytes(data)
    with pytest.raises(CourseError) as caught:
        authoring.release(made, "A1")
    path.write_bytes(before)
    assert says in str(caught.value)


def test_windows_line_ends_and_the_first_format_with_cells_are_released(made):
    """As an editor on Windows writes them; nbformat 4.0 has no ids of cells."""
    path = made / "source" / "A1" / "known-forms.ipynb"
    before = path.read_bytes()
    old = json.loads(before)
    old["nbformat_minor"] = 0
    for cell in old["cells"]:
        cell.pop("id", None)
    path.write_text(json.dumps(old, indent=1), newline="\r\n")
    assert authoring.release(made, "A1").is_dir()
    path.write_bytes(before)


def test_ctrl_c_in_the_middle_of_a_release_is_no_refusal(made, monkeypatch):
    """nbgrader catches it and writes a line into its log."""

    def interrupted(*given):
        raise KeyboardInterrupt

    monkeypatch.setattr("autograder.bridge.release.faults", interrupted)
    with pytest.raises(KeyboardInterrupt):
        authoring.release(made, "A1")


def test_a_configuration_that_cannot_be_read_is_a_plain_sentence(made):
    config = made / "nbgrader_config.py"
    before = config.read_text()
    config.write_text(before + "\nc.Foo(")
    with pytest.raises(CourseError, match=r"nbgrader_config.py cannot be read: SyntaxError"):
        authoring.release(made, "A1")
    config.write_text(before)


def test_a_comment_beside_the_call_is_no_fault(made, source):
    """The call is read from the syntax tree, not from the letters."""
    source("check_torus", source="check(torus)  # six points")
    assert authoring.release(made, "A1").is_dir()


def test_ours_comes_before_nbgraders_own_preprocessors_which_stay_as_they_are():
    """A new release of nbgrader that adds one is noticed here."""
    from nbgrader.converters import GenerateAssignment

    from autograder.bridge import GENERATE

    stock = [preprocessor.__name__ for preprocessor in GenerateAssignment.preprocessors.default()]
    assert [name.rpartition(".")[2] for name in GENERATE] == ["CheckExercises", "WriteCourse", *stock]
