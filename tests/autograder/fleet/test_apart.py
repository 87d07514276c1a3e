"""Ordinary test cells apart from the learner's process: which can be, what that stops, and what it must not change."""

import importlib.util
import json
import subprocess
import sys
from pathlib import Path

import pytest

from autograder import authoring, fleet
from autograder.errors import CourseError
from autograder.notebook import apart

spec = importlib.util.spec_from_file_location("courses_for_apart", Path(__file__).parents[1] / "conftest.py")
courses = importlib.util.module_from_spec(spec)
spec.loader.exec_module(courses)

BEGIN, END = "### BEGIN SOLUTION", "### END SOLUTION"
MEAN = "import math\ndef mean(xs):\n    ### BEGIN SOLUTION\n    return math.fsum(xs) / len(xs)\n    ### END SOLUTION"
SORT = "def sort_it(xs):\n    ### BEGIN SOLUTION\n    xs.sort()\n    ### END SOLUTION"
STACK = "class Stack:\n    ### BEGIN SOLUTION\n    def push(self, x): self.top = x\n    ### END SOLUTION"
HELPER = "import numpy as np\n\ndef reference(xs):\n    return sum(xs) / len(xs)"
TESTS = {
    "test_mean": "np.testing.assert_allclose(mean([1, 2, 6]), reference([1, 2, 6]))\nassert math.isclose(mean([5]), 5)",
    "test_hidden": "assert mean([1, 2]) == 1.5\n### BEGIN HIDDEN TESTS\nassert mean([2, 4, 9]) == 5\n### END HIDDEN TESTS",
    "test_partial": "round(2.0 * (mean([4]) == 4) / (1 if mean([1, 3]) == 2 else 2), 2)",
    "test_sort": "data = [3, 1, 2]\nsort_it(data)\nassert data == [1, 2, 3]",
    "test_stack": "s = Stack()\ns.push(3)\nassert s.top == 3",
}
SHARED = {"test_stack"}
POINTS = 2


def source():
    cell = courses.nbgrader_cell
    tests = [cell(name, text, grade=True, locked=True, points=POINTS) for name, text in TESTS.items()]
    solutions = [cell(name, text, solution=True) for name, text in (("mean", MEAN), ("sort_it", SORT), ("stack", STACK))]
    return courses.as_notebook(cell("helper", HELPER, locked=True), *solutions, *tests)


@pytest.fixture(scope="module")
def template(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PATH", f"{Path(sys.executable).parent}:/usr/bin:/bin")
        made = courses.generated(tmp_path_factory.mktemp("apart"), courses.ORDINARY_CONFIG, {"one": source()}, "ps1")
    fleet.grade(courses.Classroom(made, "ps1").course(), "ps1")  # nothing to grade yet
    return courses.Classroom(made, "ps1")


@pytest.fixture
def course(template, tmp_path):
    return template.copy(tmp_path / "course")


def points(graded, student):
    return {cell.name: cell.points for cell in graded.student(student).cells}


RIGHT = {
    "mean": "import math\ndef mean(xs): return sum(xs) / len(xs)",
    "sort_it": "def sort_it(xs): xs.sort()",
    "stack": "class Stack:\n    def push(self, x): self.top = x",
}


def test_a_right_answer_has_full_marks_and_the_cells_that_had_to_share_are_named(course):
    course.hand_in("ada", {"one": RIGHT})
    graded = fleet.grade(course.course(), "ps1")
    assert points(graded, "ada") == dict.fromkeys(TESTS, float(POINTS))
    assert {cell.removeprefix("one.ipynb: ") for cell in graded.shared} == SHARED
    assert "Stack" in graded.shared["one.ipynb: test_stack"]
    assert graded.to_dict()["shared"] == dict(graded.shared)


def test_a_wrong_answer_loses_what_it_is_wrong_in(course):
    course.hand_in("bob", {"one": {**RIGHT, "mean": "def mean(xs): return xs[0] if len(xs) < 3 else 3"}})
    graded = fleet.grade(course.course(), "ps1")
    assert points(graded, "bob") == {"test_mean": 2, "test_hidden": 0, "test_partial": 1, "test_sort": 2, "test_stack": 2}


# Each is handed in as the solution cell of ``mean``; none computes a mean. What each wins in a shared process is what the same
# trick was seen to win under nbgrader: the cells named here.
CHEATS = {
    "patched numpy": (
        "np.testing.assert_allclose = lambda *a, **k: None\nimport math\nmath.isclose = lambda *a, **k: True\n"
        "def mean(xs): return 0.1",
        {"test_mean"},
    ),
    "equal to everything": (
        "class Any(float):\n    __eq__ = lambda s, o: True\n    __hash__ = None\n"
        "    __rmul__ = __mul__ = lambda s, o: o\ndef mean(xs): return Any(5)",
        {"test_hidden", "test_partial"},
    ),
    "the reference in the caller's frame": (
        "import math, sys\ndef mean(xs): return sys._getframe(1).f_globals['reference'](xs)",
        {"test_mean", "test_hidden", "test_partial"},
    ),
    "no asserts": (
        "import ast\nclass Drop(ast.NodeTransformer):\n    def visit_Assert(self, node): return ast.Pass()\n"
        "    def visit_Expr(self, node): return ast.Pass()\n"
        "get_ipython().ast_transformers.append(Drop())\ndef mean(xs): return 0",
        {"test_mean", "test_hidden", "test_partial"},
    ),
    "cells that do nothing": (
        "import types\nshell = get_ipython()\nold = shell.run_cell\n"
        "shell.run_cell = lambda source, **k: old('pass', **k)\ndef mean(xs): return 0",
        {"test_mean", "test_hidden", "test_partial"},
    ),
    "the hidden test read back": (
        "def mean(xs):\n    import sys\n    frame = sys._getframe(1)\n    text = get_ipython().user_ns['In'][-1]\n"
        "    import re\n    wanted = dict((repr(a), float(b)) for a, b in re.findall(r'mean\\((.*?)\\) == ([0-9.]+)', text)"
        " for a in [eval(a)])\n    return wanted.get(repr(xs), 0)",
        {"test_hidden", "test_partial"},
    ),
    "a builtin": (
        "import builtins\nbuiltins.round = lambda *a: 2.0\ndef mean(xs): return 0",
        {"test_partial"},
    ),
}  # fmt: skip


@pytest.fixture(scope="module")
def both_ways(template, tmp_path_factory):
    """All cheats handed in, graded apart and in a shared process."""
    graded = {}
    for mode in ("calibrated", "shared"):
        room = template.copy(tmp_path_factory.mktemp("cheats") / mode)
        room.configure(f'c.Sandbox.tests = "{mode}"\n')
        for number, (text, _) in enumerate(CHEATS.values()):
            room.hand_in(f"s{number}", {"one": {**RIGHT, "mean": text}})
        graded[mode] = fleet.grade(room.course(), "ps1")
    return graded


@pytest.mark.parametrize("name", CHEATS)
def test_tampering_wins_nothing_apart_and_would_win_in_a_shared_process(both_ways, name):
    number = list(CHEATS).index(name)
    apart, shared = (points(both_ways[mode], f"s{number}") for mode in ("calibrated", "shared"))
    mean = [test for test in TESTS if "mean" in TESTS[test]]
    assert {test: apart[test] for test in mean} == dict.fromkeys(mean, 0.0)
    assert {test for test in mean if shared[test]} >= CHEATS[name][1]


def test_a_test_that_ends_the_learners_process_costs_itself(course):
    text = "def mean(xs):\n    import os\n    if len(xs) == 3: os._exit(0)\n    return sum(xs) / len(xs)"
    course.hand_in("cas", {"one": {**RIGHT, "mean": text}})
    graded = fleet.grade(course.course(), "ps1")
    assert points(graded, "cas") == {"test_mean": 0, "test_hidden": 0, "test_partial": 2, "test_sort": 2, "test_stack": 2}
    assert graded.faults == ()


def test_what_cannot_cross_fails_its_cell_with_a_message(course):
    course.hand_in("dee", {"one": {**RIGHT, "mean": "class Mean: pass\ndef mean(xs): return Mean()"}})
    graded = fleet.grade(course.course(), "ps1")
    assert points(graded, "dee")["test_mean"] == 0
    assert {cell.name for cell in graded.student("dee").cells if cell.look} == {"test_mean", "test_hidden", "test_partial"}
    notebook = json.loads((course.folder / "autograded" / "dee" / "ps1" / "one.ipynb").read_text())
    said = [cell for cell in notebook["cells"] if cell["metadata"].get("nbgrader", {}).get("grade_id") == "test_mean"]
    assert "an object of type Mean, which cannot leave the notebook" in said[0]["outputs"][-2]["evalue"]
    assert "may be right" in str(said[0]["outputs"][-1]["data"])


def test_a_course_may_insist(course):
    course.hand_in("ada", {"one": RIGHT})
    course.configure('c.Sandbox.tests = "apart"\n')
    with pytest.raises(CourseError, match=r"insists that test cells run apart.*test_(sort|stack)"):
        fleet.grade(course.course(), "ps1")
    course.configure('c.Sandbox.tests = "shared"\n')
    assert set(fleet.grade(course.course(), "ps1").shared.values()) == {"the course says so"}
    course.configure('c.Sandbox.tests = "elsewhere"\n')
    with pytest.raises(CourseError, match="must be one of calibrated, apart, shared; got 'elsewhere'"):
        fleet.grade(course.course(), "ps1", force=True)


def test_what_was_found_is_tried_again_when_a_file_beside_the_notebook_has_changed(course, monkeypatch):
    """A test may read it: with other numbers in it, the same text may need something else."""
    seen = []
    monkeypatch.setattr(apart, "prepare", lambda *_, settings, **__: seen.append(repr(settings)) or apart.Script())
    for text in ("1", "1", "2"):
        (course.folder / "source" / "ps1" / "numbers.csv").write_text(text)
        with course.course().gradebook() as book:
            row = book.assignment("ps1")
            course.course().scripts(row, course.course().masters(row), None)
    assert seen[0] == seen[1] != seen[2]


def test_without_a_source_notebook_nothing_is_apart_and_the_report_says_why(course):
    course.hand_in("ada", {"one": RIGHT})
    (course.folder / "source" / "ps1" / "one.ipynb").unlink()
    graded = fleet.grade(course.course(), "ps1")
    assert points(graded, "ada") == dict.fromkeys(TESTS, float(POINTS))
    assert set(graded.shared.values()) == {"there is no one.ipynb in source/ to try it with"}


def test_a_cell_that_the_solution_fails_or_that_was_changed_is_shared(course):
    path = course.folder / "source" / "ps1" / "one.ipynb"
    notebook = json.loads(path.read_text())
    for cell in notebook["cells"]:
        if cell["metadata"]["nbgrader"]["grade_id"] == "test_mean":
            cell["source"] += "\nassert True"
        if cell["metadata"]["nbgrader"]["grade_id"] == "mean":
            cell["source"] = "def mean(xs): return 1.5"
    path.write_text(json.dumps(notebook))
    course.hand_in("ada", {"one": RIGHT})
    graded = fleet.grade(course.course(), "ps1")
    assert points(graded, "ada") == dict.fromkeys(TESTS, float(POINTS))
    assert "another text of it than the gradebook" in graded.shared["one.ipynb: test_mean"]
    assert "the solution in source/ does not pass it: AssertionError" in graded.shared["one.ipynb: test_hidden"]


def test_a_withheld_module_serves_the_tests_and_not_the_learners(tmp_path):
    cell, name = courses.nbgrader_cell, "vector_magnitude"
    text = courses.as_notebook(
        cell("norm", f"def norm(v):\n    {BEGIN}\n    return sum(x * x for x in v) ** 0.5\n    {END}", solution=True),
        cell("test_norm", f"from geomdl.linalg import {name}\nassert norm((3, 4)) == {name}((3, 4))", grade=True, points=1),
    )
    folder = courses.generated(tmp_path / "withheld", courses.ORDINARY_CONFIG, {"one": text}, "ps1")
    course = courses.Classroom(folder, "ps1")
    course.configure('c.Sandbox.withhold = ["geomdl"]\n')
    course.hand_in("ada", {"one": {"norm": "def norm(v): return (v[0] ** 2 + v[1] ** 2) ** 0.5"}})
    course.hand_in("bob", {"one": {"norm": "from geomdl.linalg import vector_magnitude as norm"}})
    graded = fleet.grade(course.course(), "ps1")
    assert (points(graded, "ada"), points(graded, "bob")) == ({"test_norm": 1}, {"test_norm": 0})
    assert graded.shared == {}


@pytest.mark.parametrize("more", ['c.Directrix.packages = ["numpy"]\n', 'c.Sandbox.engine = "jupyter"\n'])
def test_a_withheld_module_beside_the_notebook_or_of_pythons_own_is_not_the_learners(tmp_path, more):
    """It is not handed out, and a learner who has it all the same cannot read it; a file of data of that name stays."""
    cell = courses.nbgrader_cell
    load = f"def total():\n    {BEGIN}\n    return int(open('answers.txt').read())\n    {END}"
    text = courses.as_notebook(
        cell("mean", f"def mean(xs):\n    {BEGIN}\n    return sum(xs) / len(xs)\n    {END}\n\n{load}", solution=True),
        cell("test_mean", "import answers, statistics\nassert mean([1, 2]) == answers.mean([1, 2]) == statistics.mean([1, 2])\n"
             "assert total() == 5", grade=True, locked=True, points=1),
    )  # fmt: skip
    folder = tmp_path / "beside"
    (folder / "source/ps1").mkdir(parents=True)
    (folder / "source/ps1/one.ipynb").write_text(text)
    answers = "def mean(xs): return sum(xs) / len(xs)"
    (folder / "source/ps1/answers.py").write_text(answers)
    (folder / "source/ps1/answers.txt").write_text("5")
    (folder / "nbgrader_config.py").write_text('c = get_config()\nc.Sandbox.withhold = ["answers", "statistics"]\n' + more)
    released = authoring.release(folder, "ps1")
    assert sorted(path.name for path in released.iterdir()) == ["answers.txt", "one.ipynb"]
    course, total = courses.Classroom(folder, "ps1"), "\ndef total(): return int(open('answers.txt').read())"
    course.hand_in("ada", {"one": {"mean": answers + total}})
    course.hand_in("bob", {"one": {"mean": "from answers import mean" + total}}, files={"answers.py": answers.encode()})
    course.hand_in("cas", {"one": {"mean": "from statistics import mean" + total}})
    course.hand_in("dee", {"one": {"mean": "exec(open('answers.py').read())" + total}})
    graded = fleet.grade(course.course(), "ps1")
    assert {student.student: student.score for student in graded.students} == {"ada": 1, "bob": 0, "cas": 0, "dee": 0}


def test_nbgraders_own_command_gives_the_same_marks(course, bridge_line, tmp_path):
    course.hand_in("ada", {"one": RIGHT})
    for number, (text, _) in enumerate(list(CHEATS.values())[:3]):
        course.hand_in(f"s{number}", {"one": {**RIGHT, "mean": text}})
    course.configure(bridge_line)
    theirs = course.copy(tmp_path / "theirs")
    fleet.grade(course.course(), "ps1")
    command = [sys.executable, "-m", "nbgrader", "autograde", "ps1"]
    subprocess.run(command, cwd=theirs.folder, check=True, capture_output=True, text=True)
    assert theirs.tables() == course.tables()
    assert theirs.autograded().keys() == course.autograded().keys()
