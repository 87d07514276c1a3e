"""The command line: help with an example for every verb, exit codes 0, 1 and 2, and no traceback for a user's error."""

import io
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import nbformat
import pytest

from autograder import authoring, catalogue
from autograder.cli.course import lab
from autograder.errors import CourseError
from autograder.notebook import source

VERBS = [
    "demo",
    "new",
    "release",
    "lab",
    "check",
    "collect",
    "grade",
    "feedback",
    "report",
    "similar",
    "marks",
    "export",
    "site",
    "doctor",
]


def directrix(*arguments, cwd):
    return subprocess.run(
        [sys.executable, "-m", "autograder", *map(str, arguments)], cwd=cwd, capture_output=True, text=True, timeout=300
    )


def test_the_help_names_every_verb(tmp_path):
    """One screen, each verb with what it does."""
    result = directrix("--help", cwd=tmp_path)
    assert result.returncode == 0
    assert [verb for verb in VERBS if verb not in result.stdout] == []


@pytest.mark.parametrize("verb", [*VERBS, "author check"])
def test_every_verb_has_help_with_an_example(verb, tmp_path):
    """The example is a line that can be typed as it stands."""
    result = directrix(*verb.split(), "--help", cwd=tmp_path)
    assert result.returncode == 0
    assert f"Example: directrix {verb}" in " ".join(result.stdout.split())


@pytest.mark.parametrize(
    ("arguments", "code", "says"),
    [
        (["grade"], 2, "Missing argument"),
        (["no-such-verb"], 2, "No such command"),
        (["grade", "A1"], 1, "nbgrader_config.py"),
        (["grade", "A1", "--level", "B"], 2, "notebooks are run at level A or A- only"),
        (["grade", "A1", "--workers", "-1"], 2, "greater than or equal to 0"),
        (["export", "A1"], 1, "nbgrader_config.py"),
        (["report", "A1"], 1, "nbgrader_config.py"),
        (["feedback", "A1"], 1, "nbgrader_config.py"),
        (["release", "A1"], 1, "is not a course"),
        (["author", "check", "nowhere"], 1, "no such folder: nowhere"),
        (["author", "check"], 1, "no assignment in"),
        (["new"], 2, "the folder of the new course"),
        (["new", "--exercise", "roof"], 1, "neither a course"),
        (["new", "20-x", "--exercise", "Roof"], 1, "small letters, digits and underscores"),
        (["new", "20-x", "--exercise", "roof", "--assignment", "A1"], 2, "does not go with --exercise"),
        (["check", "nothing.ipynb"], 1, "no such notebook: nothing.ipynb"),
        (["check", "."], 1, ". is a folder; it has no notebook in it"),
        (["new", "course", "--assignment", "A99"], 1, "no assignment is called 'A99'; there are: A1"),
        (["new", "/proc/course", "--assignment", "A1"], 1, "/proc/course: No such file or directory; is its folder there?"),
    ],
)
def test_a_users_error_is_a_plain_line_and_an_exit_code(arguments, code, says, tmp_path):
    """2 for wrong usage, 1 for what failed and was named; never a traceback."""
    result = directrix(*arguments, cwd=tmp_path)
    said = " ".join((result.stderr + result.stdout).split())
    assert result.returncode == code, said
    assert says in said
    assert "Traceback" not in said


def test_the_version_is_told_with_those_of_what_marks_depend_on(tmp_path):
    said = directrix("--version", cwd=tmp_path)
    assert re.fullmatch(r"directrix [\d.]+, Python 3[\d.]+, nbgrader [\d.]+\n", said.stdout)


def test_help_is_folded_by_the_terminal_alone(tmp_path):
    """A line of a docstring is no line of the screen: it would be folded twice."""
    said = directrix("release", "--help", cwd=tmp_path)
    assert " source/A20. Its check(...) works in learners' own JupyterLab where they have" in said.stdout


def test_a_command_to_be_typed_can_be_typed(tmp_path):
    """With blanks in the folder's name, and though the line is longer than the screen."""
    made = directrix("new", "surfaces and solids", "--assignment", "A1", cwd=tmp_path)
    assert "Next: directrix release A1 --course 'surfaces and solids'\n" in made.stdout
    assert "A1 known-forms (27 points)" in made.stdout  # those that a person gives too, as the table of marks says


def test_grade_says_where_submissions_should_lie_if_there_is_none(surfaces):
    said = directrix("grade", "A1", "--course", surfaces.folder, cwd=surfaces.folder)
    assert said.returncode == 0
    assert said.stdout.strip() == f"Nobody has handed in A1: submissions lie in {surfaces.folder}/submitted/STUDENT/A1"


def test_grade_names_folders_that_are_nearly_the_assignment(surfaces):
    for name in ("ada/a1", "ben/A 1", "cy/A-1", "cy/A2", "dee/a1", "dee/A1"):
        (surfaces.folder / "submitted" / name).mkdir(parents=True)
    (surfaces.folder / "submitted" / "A1").write_text("no folder")
    said = directrix("grade", "A1", "--course", surfaces.folder, cwd=surfaces.folder)
    named = [line for line in said.stderr.splitlines() if "was not graded" in line]
    places = [surfaces.folder / "submitted" / name for name in ("ada/a1", "ben/A 1", "cy/A-1")]
    assert named == [f"directrix: {place} was not graded: if it is A1, rename it to A1" for place in places]


@pytest.mark.parametrize("arguments", [["marks", "A1", "--csv"], ["similar", "A1", "--html"]])
def test_a_file_that_cannot_be_written_is_a_plain_line(surfaces, arguments):
    surfaces.hand_in("ada", {})
    said = directrix(*arguments, "nowhere/file", cwd=surfaces.folder)
    assert said.returncode == 1
    assert said.stderr == "directrix: nowhere/file: No such file or directory; is its folder there?\n"


def test_a_full_disk_is_told_with_the_file_that_was_wanted(ordinary):
    said = directrix("export", "ps1", "--csv", "/dev/full", cwd=ordinary.folder)
    assert (said.returncode, said.stdout) == (1, "")
    wanted = "directrix: /dev/full: No space left on device; make room, then start again; what was finished is kept\n"
    assert said.stderr == wanted


def test_ctrl_c_is_one_plain_line(tmp_path):
    """Here in the middle of a cell: what runs the notebook has a way of its own to end, and says nothing of it."""
    cell = "import pathlib, time\npathlib.Path('started').touch()\ntime.sleep(60)"
    nbformat.write(nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell)]), tmp_path / "slow.ipynb")
    command = [sys.executable, "-m", "autograder", "check", "slow.ipynb"]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as running:
        while not (tmp_path / "started").exists():
            assert running.poll() is None
            time.sleep(0.05)
        running.send_signal(signal.SIGINT)
        said = running.communicate(timeout=60)
    assert (running.returncode, *said) == (130, "", "directrix: stopped; what was finished is kept\n")


def test_lab_opens_the_course_whose_folder_it_is_started_in(tmp_path, monkeypatch):
    """And makes no learner's workbook in it; elsewhere it makes one."""
    started = []
    monkeypatch.setattr(os, "execv", lambda program, arguments: started.append(Path.cwd()))
    course = tmp_path / "course"
    authoring.new_course(course, ("A1",))
    for folder in (course, tmp_path):
        monkeypatch.chdir(folder)
        lab(None, browser=False)
    assert started == [course, tmp_path / "directrix-workbook"]


def test_author_check_tells_a_program_what_it_tells_people(tmp_path):
    """A spoilt exercise fails, with the rule, what broke it and what to do, and the table as numbers."""
    authoring.new_exercise(tmp_path / "20-roofs", "roof")
    path = tmp_path / "20-roofs" / "exercises.py"
    good = directrix("author", "check", "20-roofs", "--seeds", "2", "--json", cwd=tmp_path)
    assert good.returncode == 0, good.stderr
    (told,) = json.loads(good.stdout)
    (mistake,) = told["exercises"]["roof"]
    assert (told["assignment"], told["breaches"], mistake["named"]) == ("A20", [], "no_rise")
    assert mistake["distances"]["one_high"] == 0.0 < mistake["distances"]["lecture"]
    path.write_text(path.read_text().replace("(blind=True)", ""))
    bad = directrix("author", "check", "20-roofs", "--seeds", "2", "--json", cwd=tmp_path)
    assert bad.returncode == 1
    ((breach,),) = [one["breaches"] for one in json.loads(bad.stdout)]
    assert (breach["rule"], breach["must"]) == ("blind", True)
    assert "'one_high' sees no mistake" in " ".join(bad.stderr.split())


def test_a_folder_that_is_no_students_id_cannot_steer_the_terminal(surfaces):
    """Its name comes from outside: no escape sequence, no line of its own, no markup, in the progress as at the end."""
    from rich.console import Console

    from autograder.cli.course import grade_with_progress

    for student in ("esc\x1b]0;title\x07", "two\nlines", "[red]bo[b", os.fsdecode(b"sur\xffrogate")):
        (surfaces.folder / "submitted" / student / "A1").mkdir(parents=True)
    told = directrix("grade", "A1", "--course", surfaces.folder, cwd=surfaces.folder)
    assert told.returncode == 1
    assert "\x1b" not in told.stdout + told.stderr
    assert [line for line in told.stderr.splitlines() if not line.startswith("directrix: ")] == []
    shown = io.StringIO()
    console = Console(file=shown, force_terminal=True, width=200)
    grade_with_progress(console, surfaces.course(), "A1")
    assert "\x1b]0" not in shown.getvalue()
    assert "[red]bo[b" in shown.getvalue()


def test_new_makes_a_course_and_refuses_to_touch_a_folder_that_is_not_empty(tmp_path):
    """The secret is the instructor's alone; nothing is half-written."""
    made = directrix("new", "course", "--assignment", "A1", cwd=tmp_path)
    assert made.returncode == 0, made.stderr
    course = tmp_path / "course"
    assert (course / ".directrix" / "secret").stat().st_mode & 0o077 == 0
    assert [path.name for path in (course / "source" / "A1").iterdir()] == ["known-forms.ipynb"]
    again = directrix("new", "course", cwd=tmp_path)
    assert again.returncode == 1
    assert "is not empty" in again.stderr
    assert not (course / "source" / "A2").exists()


@pytest.mark.parametrize("there", [False, True])
def test_a_course_that_was_stopped_in_the_making_leaves_nothing(tmp_path, monkeypatch, there):
    """So the same command makes it; a folder that was there before is there and empty."""
    folder = tmp_path / "course"
    if there:
        folder.mkdir()
    with monkeypatch.context() as patch:
        written = []

        def stopped(assignment, place):
            written.append(place)
            source.write(assignment, place)
            if len(written) == 2:
                raise KeyboardInterrupt

        patch.setattr("autograder.authoring.courses.source", SimpleNamespace(write=stopped))
        with pytest.raises(KeyboardInterrupt):
            authoring.new_course(folder)
    assert [path.name for path in tmp_path.rglob("*")] == ["course"] * there
    made = authoring.new_course(folder, ("A1", "A1"))
    assert [one.name for one in made] == ["A1"]
    (tmp_path / "file").touch()
    with pytest.raises(CourseError, match="is a file; choose a new folder"):
        authoring.new_course(tmp_path / "file")


def test_a_workbook_has_every_notebook_and_chapter_and_keeps_the_readers_work(tmp_path):
    """Opening it a second time adds what is new and overwrites nothing."""
    first = authoring.workbook(tmp_path)
    assert len([path for path in first if path.parent.name == "course"]) >= 1
    assert {path.parent.name for path in first} >= {"A1", "A2", "A3"}
    mine = tmp_path / "A1" / "known-forms.ipynb"
    mine.write_text("my own work")
    assert authoring.workbook(tmp_path) == []
    assert mine.read_text() == "my own work"


@pytest.fixture(scope="module")
def a1():
    return catalogue.shipped().assignment("A1")


def test_check_runs_ones_own_notebook_and_counts_its_points(tmp_path, a1):
    """Solved, it exits 0; as released, 1, and every exercise is named with 0 points."""
    solved = source.build(a1, solutions=True)
    nbformat.write(solved, tmp_path / "solved.ipynb")
    nbformat.write(source.release(solved), tmp_path / "released.ipynb")
    right = directrix("check", "solved.ipynb", "--json", cwd=tmp_path)
    assert right.returncode == 0, right.stdout + right.stderr
    (report,) = json.loads(right.stdout)
    assert {c["exercise"]: c["points"] for c in report["checks"]} == {e.id: e.points for e in a1.exercises.values()}
    stubs = directrix("check", "released.ipynb", "--json", cwd=tmp_path)
    assert stubs.returncode == 1
    (report,) = json.loads(stubs.stdout)
    assert [c["points"] for c in report["checks"]] == [0.0] * len(a1.exercises)
    assert all(c["text"] for c in report["checks"])


def test_check_says_where_it_stopped(tmp_path, a1):
    """An endless loop stops the run with a sentence, and what was checked before it is kept."""
    notebook = source.build(a1, solutions=True)
    where = next(i for i, cell in enumerate(notebook.cells) if cell.metadata.get("nbgrader", {}).get("grade_id") == "frustum")
    notebook.cells[where].source = "while True:\n    pass"
    nbformat.write(notebook, tmp_path / "loop.ipynb")
    result = directrix("check", "loop.ipynb", "--timeout", "5", "--json", cwd=tmp_path)
    assert result.returncode == 1
    (report,) = json.loads(result.stdout)
    assert "more than 5 seconds" in report["stopped"]
    assert report["checks"][0]["points"] == a1.exercises["cylinder"].points
