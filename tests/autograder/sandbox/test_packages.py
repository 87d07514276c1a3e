"""Learners find the packages that the policy names with what they need, and of directrix and autograder only the stand-ins."""

import importlib.metadata

import pytest
from packaging.requirements import Requirement

from autograder.errors import SandboxError
from autograder.sandbox import Policy, Sandbox, packages


def test_a_package_comes_with_all_it_requires_and_nothing_else():
    names = set(packages.entries(("plotly",)))
    assert {
        "plotly",
        "_plotly_utils",
        "narwhals",
        "packaging",
        "numpy",
        "numpy.libs",
        "IPython",
        "traitlets",
        "nbformat",
    } <= names
    assert not names & {"directrix", "autograder", "scipy", "nbgrader", "jupyterlab", "_directrix.pth", "pytest", "hypothesis"}
    assert not any(name.endswith(".pth") for name in names)


def test_what_is_required_is_read_as_the_standard_says():
    """Of every distribution that is installed here, as its markers say where no extra is asked for."""
    asked = 0
    for distribution in importlib.metadata.distributions():
        read = [Requirement(text) for text in distribution.requires or ()]
        wanted = [one.name for one in read if one.marker is None or one.marker.evaluate({"extra": ""})]
        assert list(packages._required(distribution)) == wanted, distribution.name
        asked += len(read)
    assert asked > 100


@pytest.mark.parametrize(
    ("text", "required"),
    [
        ("a; extra == 'b'", False),
        ('a; python_version > "3" and extra=="b"', False),
        ("a; extra == 'b' or python_version > '3'", True),
        ("a; extra == ''", True),
        ("a; python_version < '3'", False),
    ],
)
def test_a_requirement_of_an_extra_is_left_out(tmp_path, text, required):
    (tmp_path / "METADATA").write_text(f"Name: own\nRequires-Dist: {text}\n\nRequires-Dist: of the description\n")
    assert list(packages._required(importlib.metadata.PathDistribution(tmp_path))) == ["a"] * required


def test_an_import_name_will_do():
    assert "dateutil" in packages.entries(("dateutil",))


def test_what_is_not_installed_is_named():
    with pytest.raises(SandboxError, match="'nothing-of-that-name', says the policy"):
        packages.entries(("nothing_of_that_name",))


def test_the_library_itself_is_never_shown():
    for asked in ("directrix", "autograder"):
        assert set(packages.entries((asked,))) == set(packages.entries(()))


@pytest.fixture(scope="module")
def everything():
    with Sandbox(Policy(packages="all", preload=())) as box:
        yield box


def imports(session, name):
    return session.run_cell(f"import {name}").status == "ok"


def test_by_default_there_is_numpy_and_plotly():
    with Sandbox() as box, box.open() as session:
        assert imports(session, "numpy")
        assert imports(session, "plotly.graph_objects")
        assert not imports(session, "scipy")
        assert not imports(session, "nbgrader")
        result = session.run_cell(
            "import plotly.graph_objects as go\nfigure = go.Figure(go.Scatter(x=[1], y=[2]))\nfigure.show(); figure"
        )
        assert [list(output["data"]) for output in result.outputs] == [["application/vnd.plotly.v1+json"]] * 2


def test_the_versions_are_those_installed_here():
    with Sandbox() as box, box.open() as session:
        result = session.run_cell("import plotly, numpy; plotly.__version__, numpy.__version__")
    assert result.outputs[0]["data"]["text/plain"] == repr(
        (importlib.metadata.version("plotly"), importlib.metadata.version("numpy"))
    )


def test_an_ordinary_course_finds_all_that_is_installed(everything):
    with everything.open() as session:
        assert imports(session, "scipy.spatial, nbgrader, yaml, six")
        assert imports(session, "importlib.metadata; importlib.metadata.version('scipy')")


@pytest.mark.parametrize(
    "name",
    [
        "directrix.curves",
        "directrix.surfaces",
        "directrix.transform",
        "autograder.judge",
        "autograder.catalogue",
        "autograder.cli",
        "directrix_assignments",
    ],
)
def test_the_reference_is_nowhere(everything, sandbox, name):
    for box in (everything, sandbox):
        with box.open() as session:
            assert session.run_cell(f"import {name}").outputs[-1]["ename"] in ("ImportError", "ModuleNotFoundError")


def test_the_reference_is_nowhere_on_disk(everything):
    """Searched for by its text, in all that a learner can read."""
    source = """
import os, sys
found = []
for root in ('/packages', '/guest', '/python', '/usr', '/lib', '/scratch', '/tmp', '/etc'):
    for folder, _, names in os.walk(root):
        ours = ('known.py', 'catalogue.py', 'exercises.py', 'judge.py', 'gradebook.py')
        found += [os.path.join(folder, n) for n in names if n in ours and ('directrix' in folder or 'autograder' in folder)]
        found += [os.path.join(folder, n) for n in names if n.endswith('.pth') and os.path.getsize(os.path.join(folder, n))]
found
"""
    with everything.open() as session:
        assert session.run_cell(source).outputs[-1]["data"]["text/plain"] == "[]"


@pytest.mark.parametrize(
    "source", ["from directrix import Cylinder", "import directrix as dx\ndx.Cylinder(1, 2)", "import directrix.surfaces.known"]
)
def test_withheld_parts_say_why(session, source):
    result = session.run_cell(source)
    assert result.outputs[-1]["ename"] == "ImportError"
    assert "not there while the grader runs" in result.outputs[-1]["evalue"]


def test_check_says_that_the_grader_is_judging(session):
    result = session.run_cell("from autograder import check\ndef cone(u, w): ...\ncheck(cone)")
    assert result.outputs == [
        {
            "output_type": "stream",
            "name": "stdout",
            "text": "The grader is judging cone; its verdict stands at the graded cell.\n",
        }
    ]
    assert "only autograder.check" in session.run_cell("from autograder import judge_function").outputs[-1]["evalue"]


def test_pictures_are_drawn_by_the_real_plot_package():
    with Sandbox() as box, box.open() as session:
        source = "import numpy as np\nfrom directrix import plot\n"
        source += "def f(u, w): return np.stack([u + 0 * w, w + 0 * u, 0 * u * w], axis=-1)\nplot.view(f)"
        result = session.run_cell(source)
        assert result.status == "ok", result.outputs
        assert "application/vnd.plotly.v1+json" in result.outputs[-1]["data"]
