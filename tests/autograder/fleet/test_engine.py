"""`c.Sandbox.engine = "jupyter"`: outputs of a real kernel, marks of nobody who could have forged them."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from autograder import fleet, messages
from autograder.errors import CourseError, IsolationError
from tests.autograder.conftest import Classroom

RIGHT = {
    "square": "def square(x): return x * x",
    "half": "print(get_ipython().kernel.__class__.__name__)\ndef half(x): return x / 2",
    "code_answer": "%%bash\necho from bash > made.txt; cat made.txt; echo for $JUPYTERHUB_USER",
    "why": "It is so.",
}
# In the learner's own kernel this makes every assertion pass; it also says so with a forged result.
FORGED = (
    "def square(x): return 4\nimport ast\nclass No(ast.NodeTransformer):\n    def visit_Assert(self, node): return ast.Pass()\n"
)
FORGED += "get_ipython().ast_transformers.append(No())"
CYLINDER = (
    "def cylinder(u, w, R, height):\n"
    "    t = 2 * np.pi * np.asarray(u)\n"
    "    return np.stack(np.broadcast_arrays(R * np.cos(t), R * np.sin(t), height * np.asarray(w)), axis=-1)"
)
ENGINE = 'c.Sandbox.engine = {"ps1": "jupyter"}\nc.Sandbox.tests = "shared"\n'


@pytest.fixture(scope="module")
def graded(ordinary_template, tmp_path_factory, bridge_line):
    """The same class graded by us and by `nbgrader autograde` with our line."""
    folder = tmp_path_factory.mktemp("engine")
    ours = Classroom(shutil.copytree(ordinary_template, folder / "ours"), "ps1")
    ours.configure(bridge_line + ENGINE)
    ours.hand_in("ada", {"one": RIGHT})
    ours.hand_in("eve", {"one": {**RIGHT, "square": FORGED}})
    ours.course().secret()
    theirs = ours.copy(folder / "theirs")
    done = subprocess.run(
        [Path(sys.executable).parent / "nbgrader", "autograde", "ps1"], cwd=theirs.folder, capture_output=True, text=True,
        timeout=300, env={**os.environ, "JUPYTER_CONFIG_DIR": str(theirs.folder / ".jupyter")},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return ours, theirs, fleet.grade(ours.course(), "ps1")


def outputs(room, student, name):
    notebook = json.loads((room.folder / "autograded" / student / "ps1" / "one.ipynb").read_text())
    cell = next(cell for cell in notebook["cells"] if cell["metadata"].get("nbgrader", {}).get("grade_id") == name)
    return "".join("".join(output.get("text", "")) for output in cell["outputs"])


def test_outputs_are_a_kernels(graded):
    """It knows whose work it is, and so do the programs that it starts."""
    ours, _, _ = graded
    assert outputs(ours, "ada", "half") == "IPythonKernel\n"
    assert [outputs(ours, student, "code_answer") for student in ("ada", "eve")] == [
        "from bash\nfor ada\n",
        "from bash\nfor eve\n",
    ]
    assert (ours.folder / "autograded/ada/ps1/made.txt").read_text() == "from bash\n"


def test_tests_in_the_learners_kernel_have_no_mark(graded):
    """Neither the honest nor the forged: what a person decides (the written answer) is as always."""
    ours, _, report = graded
    for student in ("ada", "eve"):
        marks = dict(ours.sql(
            "select b.name, g.auto_score from grade g join base_cell b on g.cell_id = b.id join submitted_notebook n on "
            "g.notebook_id = n.id join submitted_assignment s on n.assignment_id = s.id where s.student_id = ?",
            student,
        ))  # fmt: skip
        assert (marks["test_square"], marks["test_half"]) == (None, None)
    notes = {cell.name: cell.note for student in report.students for cell in student.cells if cell.name == "test_square"}
    assert notes["test_square"] == messages.ENGLISH["graded.forgeable"]
    assert report.failures == ()


def test_nbgrader_autograde_gives_the_same(graded):
    ours, theirs, _ = graded
    assert ours.tables() == theirs.tables()
    assert set(ours.autograded()) == set(theirs.autograded())


def test_tests_that_run_apart_keep_their_marks(ordinary):
    """The default: the test's process asks the learner's functions in our own engine, where nothing is forged."""
    ordinary.configure('c.Sandbox.engine = "jupyter"\n')
    ordinary.hand_in("ada", {"one": RIGHT})
    ordinary.hand_in("eve", {"one": {**RIGHT, "square": FORGED}})
    ordinary.hand_in("sly", {"one": _and_reads_the_cells})
    report = fleet.grade(ordinary.course(), "ps1")
    points = {student.student: {cell.name: cell.points for cell in student.cells} for student in report.students}
    assert (points["ada"]["test_square"], points["ada"]["test_half"]) == (2, 3)
    assert (points["eve"]["test_square"], points["eve"]["test_half"]) == (0, 3)
    read = json.loads((ordinary.folder / "autograded/sly/ps1/one.ipynb").read_text())["cells"][-1]["outputs"][0]["text"]
    assert "def square" in "".join(read)
    assert "assert" not in "".join(read)  # the learner's kernel has not seen them


def _and_reads_the_cells(notebook):
    notebook["cells"].append(
        {
            "cell_type": "code",
            "id": "sly",
            "metadata": {},
            "source": "print(len(In), *In)",
            "outputs": [],
            "execution_count": None,
        }
    )


def test_exercises_are_judged(surfaces):
    """`check(name)` is judged from outside as always."""
    surfaces.configure('c.Sandbox.engine = {"A1": "jupyter"}\n')
    surfaces.hand_in("ada", {"known-forms": {"cylinder": CYLINDER}})
    plain = surfaces.copy(surfaces.folder.parent / "plain")
    plain.configure("c.Sandbox.engine = 'ipython'\n")
    marks = [
        [(cell.name, cell.outcome, cell.points) for cell in fleet.grade(room.course(), "A1").students[0].cells]
        for room in (surfaces, plain)
    ]
    assert marks[0] == marks[1]
    assert any(outcome for _, outcome, _ in marks[0])


def test_what_it_may_be(ordinary, monkeypatch):
    course = ordinary.course()
    assert course.engine("ps1") == "ipython"
    ordinary.configure('c.Sandbox.engine = {"ps2": "jupyter"}\n')
    assert (ordinary.course().engine("ps1"), ordinary.course().engine("ps2")) == ("ipython", "jupyter")
    ordinary.configure('c.Sandbox.engine = "docker"\n')
    with pytest.raises(CourseError, match=r"must be \"ipython\" or \"jupyter\".*got 'docker' for ps1"):
        ordinary.course().engine("ps1")
    ordinary.configure('c.Sandbox.engine = "jupyter"\n')
    monkeypatch.setattr("autograder.sandbox.kernel.NEEDED", ("nbclient", "a_kernel_of_nobody"))
    with pytest.raises(IsolationError, match="missing: a_kernel_of_nobody"):
        ordinary.course().engine("ps1")
