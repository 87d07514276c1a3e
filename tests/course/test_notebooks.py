"""The notebooks of the assignments: their form, and that they run, solved and as released, in a kernel and in the sandbox."""

import ast
import json
import re
from itertools import pairwise

import nbformat
import pytest
from look import MOST_SCENES, folded, guesses, scenes, typed, words

from autograder.catalogue import shipped
from autograder.notebook.source import build, release
from autograder.sandbox import Sandbox

ASSIGNMENTS = {assignment.name: assignment for assignment in shipped().assignments}


def code(nb):
    return [cell for cell in nb.cells if cell.cell_type == "code"]


def role(cell) -> str:
    """task, check, written, locked or nothing."""
    meta = cell.metadata.get("nbgrader", {})
    if meta.get("grade"):
        return "written" if meta["solution"] else "check"
    return "task" if meta.get("solution") else "locked" if meta.get("locked") else ""


@pytest.mark.parametrize("name", ASSIGNMENTS)
def test_points_of_the_checks_are_those_of_the_exercises(name):
    """What the gradebook can give for checks is what the exercises are worth; one written answer at most is added."""
    nb = build(ASSIGNMENTS[name])
    assert sum(cell.metadata.nbgrader.points for cell in nb.cells if role(cell) == "check") == ASSIGNMENTS[name].points
    assert sum(role(cell) == "written" for cell in nb.cells) <= 1


@pytest.mark.parametrize("name", ASSIGNMENTS)
def test_only_check_and_plot_are_imported_of_the_course(name):
    """Everything else of it is withheld where marks are given."""
    imported = set()
    for cell in code(build(ASSIGNMENTS[name])):
        for node in ast.walk(ast.parse(cell.source)):
            if isinstance(node, ast.Import):
                imported |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                imported |= {f"{node.module}:{alias.name}" for alias in node.names}
    assert imported <= {
        "contextlib",
        "numpy",
        "plotly.graph_objects",
        "autograder:check",
        "autograder:personal",
        "directrix:plot",
    }


@pytest.mark.parametrize("name", ASSIGNMENTS)
def test_cells_hold_one_idea(name):
    """Prose of at most 110 words, code of at most 18 lines of at most 104 characters, and a question first."""
    nb = build(ASSIGNMENTS[name])
    assert re.search(r"\*\*[^*]+\?\*\*", nb.cells[0].source)
    for cell in nb.cells:
        if cell.cell_type == "markdown" and role(cell) != "written":
            assert words(cell.source) <= 110, cell.source
        elif cell.cell_type == "code" and not folded(cell):
            assert cell.source.count("\n") < 18, cell.source
            assert max(map(len, cell.source.split("\n"))) <= 104, cell.source


@pytest.mark.parametrize("name", ASSIGNMENTS)
def test_each_task_goes_from_prediction_to_check(name):
    """Before a task a prediction; after it a test of one's own, then the graded cell; no task between."""
    nb = build(ASSIGNMENTS[name])
    places = {cell.id: number for number, cell in enumerate(nb.cells)}
    asked = guesses(nb)
    for guess, number in asked.items():
        assert any(f"reveal({guess}," in cell.source for cell in nb.cells[number + 1 :]), f"{guess} is never revealed"
    last = 0
    for id in ASSIGNMENTS[name].exercises:
        task, graded = places[id], places[f"check_{id}"]
        assert any(last < number < task for number in asked.values()), f"no prediction before {id}"
        own = [cell.source for cell in nb.cells[task + 1 : graded] if cell.cell_type == "code"]
        assert any(f"{id}(" in source and ("holds(" in source or "print(" in source) for source in own), id
        assert all("once_written()" in source for source in own if f"{id}(" in source), id
        last = task


@pytest.mark.parametrize("name", ASSIGNMENTS)
def test_form_of_the_course_is_kept(name):
    """A trap of blind data, a failure that is asked about, rival conventions, an open end, and few enough scenes."""
    nb = build(ASSIGNMENTS[name])
    prose = "\n".join(cell.source for cell in nb.cells if cell.cell_type == "markdown")
    assert "### A trap: " in prose
    assert re.search(r"\*\*What (went wrong|changed)", prose)
    assert re.search(r"rival convention|Some tables|Many drawings", prose)
    assert "## If you want more" in prose
    follower = next((later for earlier, later in pairwise(ASSIGNMENTS) if earlier == name), None)
    assert re.findall(r"Next: \*\*(A\d+)", nb.cells[-1].source) == ([follower] if follower else [])
    assert scenes(nb, ASSIGNMENTS[name].exercises) <= MOST_SCENES


@pytest.mark.parametrize("name", ASSIGNMENTS)
def test_released_notebook_tells_no_solution(name):
    """Not a line of a solution, code or words, is left in what learners receive."""
    nb = build(ASSIGNMENTS[name])
    text = nbformat.writes(release(nb))
    for cell in nb.cells:
        for region in re.findall(r"### BEGIN SOLUTION\n(.*?)\s*### END SOLUTION", cell.source, re.DOTALL):
            for line in region.split("\n"):
                assert len(line.strip()) <= 24 or json.dumps(line.strip(), ensure_ascii=False)[1:-1] not in text, line


@pytest.mark.parametrize("name", ASSIGNMENTS)
def test_solved_notebook_gets_full_points(name, run):
    """Every check returns the exercise's points, every claim of a self-check holds, stderr stays empty."""
    nb = build(ASSIGNMENTS[name])
    asked = len(typed(nb))
    done = run(nb)
    said = []
    for cell in code(done):
        for output in cell.outputs:
            assert output.output_type != "error", f"{cell.source}\n{output.evalue}"
            assert output.get("name") != "stderr", output.text
            said += output.get("text", "").splitlines()
        if role(cell) == "check":
            results = [output for output in cell.outputs if output.output_type == "execute_result"]
            assert [float(result.data["text/plain"]) for result in results] == [cell.metadata.nbgrader.points], cell.source
    assert not [line for line in said if line.startswith("NO ")]
    assert sum(line.startswith("You said typed") for line in said) == asked


@pytest.mark.parametrize("name", ASSIGNMENTS)
def test_released_notebook_runs_and_only_its_checks_complain(name, run):
    """Whatever needs an unwritten function waits quietly; a check says that nothing is written yet and gives no points."""
    for cell in code(run(release(build(ASSIGNMENTS[name])))):
        errors = [output for output in cell.outputs if output.output_type == "error"]
        if role(cell) == "check":
            assert {error.ename for error in errors} in ({"CheckFailed"}, {"NotImplementedError"}), cell.source
            assert "execute_result" not in [output.output_type for output in cell.outputs], "points for nothing"
        else:
            assert not errors, f"{cell.source}\n{errors}"


@pytest.fixture(scope="module")
def sandbox():
    """The sandbox of grading, as it is by default."""
    with Sandbox() as box:
        yield box


@pytest.mark.parametrize("released", [False, True], ids=["solved", "released"])
@pytest.mark.parametrize("name", ASSIGNMENTS)
def test_notebook_runs_in_the_sandbox_with_numpy_and_plotly_alone(name, released, sandbox):
    """Where marks are given every cell runs too; a solved notebook shows its pictures there."""
    nb = build(ASSIGNMENTS[name])
    drawing = sum("plot.view(" in cell.source or "go.Figure(" in cell.source for cell in code(nb))
    pictures = 0
    with sandbox.open(files={}) as session:
        for cell in code(release(nb) if released else nb):
            result = session.run_cell(cell.source)
            assert result.status == "ok", f"{cell.source}\n{result.note or result.outputs}"
            pictures += any("application/vnd.plotly.v1+json" in output.get("data", {}) for output in result.outputs)
    assert drawing >= 4
    assert 1 <= pictures < drawing if released else pictures == drawing
