"""The builder: what it makes of a good text, and what it says of a bad one."""

import os
import re
import runpy
import subprocess
import sys
import types
from pathlib import Path

import nbformat
import pytest
from nbgrader.nbgraderformat import MetadataValidator

from autograder.catalogue import Assignment, load_assignment
from autograder.errors import CourseError
from autograder.notebook.source import build, dumps, release, setup_source, write

EXERCISES = '''
import numpy as np
from autograder.exercise import exercise

@exercise(points=4, title="Disc", kind="surface")
def disc(u, w, r):
    """A disc of radius r."""
    return np.stack([r * u * np.cos(w), r * u * np.sin(w), 0 * u * w], axis=-1)

@disc.data
def one(rng):
    return dict(r=2.0)

@exercise(points=2.5, title="Half", kind="value")
def half(x, by=2.0):
    """x divided."""
    return x / by

@half.data
def two(rng):
    return dict(x=3.0)
'''
TEXT = '''# %% [markdown]
# # What is a disc?
#
# It has $x^2 + y^2 \\\\le r^2$.

# %% setup=true

# %%
# a remark stays a remark
guess = None

# %% solution="disc"
def disc(u, w, r):
    """A disc of radius r."""
    u, w = np.asarray(u), np.asarray(w)
    ### BEGIN SOLUTION
    return np.stack([r * u * np.cos(w), r * u * np.sin(w), 0 * u * w], axis=-1)
    ### END SOLUTION


# %% check="disc"
check(disc)

# %% [markdown] written="why" points=3
# In two sentences:
#
# ### BEGIN SOLUTION
# Because.
# ### END SOLUTION

# %% solution="half"
def half(x, by=2.0):
    """x divided."""
    ### BEGIN SOLUTION
    return x / by
    ### END SOLUTION

# %% check="half"
check(half)
'''


def made(folder: Path, text: str = TEXT) -> Assignment:
    place = folder / "07-discs"
    place.mkdir(parents=True, exist_ok=True)
    (place / "exercises.py").write_text(EXERCISES)
    (place / "notebook.py").write_text(text)
    return load_assignment(place)


@pytest.fixture
def assignment(tmp_path):
    return made(tmp_path)


def test_markers_become_full_nbgrader_metadata(assignment):
    """Every field that schema 3 wants is there; points come from the exercise, whole ones as integers."""
    cells = {cell.id: cell for cell in build(assignment).cells}
    assert dict(cells["check_disc"].metadata.nbgrader) == {
        "grade": True, "grade_id": "check_disc", "locked": True, "points": 4, "schema_version": 3, "solution": False,
        "task": False,
    }  # fmt: skip
    assert dict(cells["disc"].metadata.nbgrader) == {
        "grade": False, "grade_id": "disc", "locked": False, "schema_version": 3, "solution": True, "task": False,
    }  # fmt: skip
    assert cells["check_half"].metadata.nbgrader.points == 2.5
    assert (cells["why"].metadata.nbgrader.points, cells["why"].cell_type) == (3, "markdown")
    assert cells["check_disc"].source == "check(disc)"
    assert cells["cell-03"].source == "# a remark stays a remark\nguess = None"


def test_source_notebook_is_valid_for_nbgrader_and_carries_nothing_else(assignment):
    """nbgrader's own validator takes it; a kernel is named, no outputs, no trace of jupytext."""
    nb = build(assignment)
    MetadataValidator().validate_nb(nb)
    assert nb.metadata == {
        "kernelspec": {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    assert all(cell.get("outputs", []) == [] for cell in nb.cells)
    assert "jupytext" not in dumps(nb)
    assert "lines_to_next_cell" not in dumps(nb)


def test_setup_cell_brings_imports_and_helpers_locked_and_folded(assignment):
    """The helpers stand in one place for all notebooks; a learner sees them folded and cannot break them."""
    cell = next(cell for cell in build(assignment).cells if cell.id == "setup")
    assert cell.source == setup_source()
    assert cell.metadata.nbgrader.locked
    assert cell.metadata.jupyter == {"source_hidden": True}


def test_folded_cell_hides_its_code_and_nothing_else(tmp_path):
    """A picture whose code teaches nothing is folded away; it stays an ordinary cell."""
    folded = made(tmp_path, TEXT.replace("# %%\n# a remark", "# %% fold=true\n# a remark"))
    cell = next(cell for cell in build(folded).cells if cell.id == "cell-03")
    assert cell.metadata == {"jupyter": {"source_hidden": True}}


def test_rebuilding_gives_the_same_bytes(assignment, tmp_path):
    """Nothing random: two builds of one text are the same file."""
    first = write(assignment, tmp_path / "one").read_bytes()
    assert write(assignment, tmp_path / "two").read_bytes() == first
    assert (tmp_path / "one" / "discs.ipynb").is_file()


def test_without_solutions_a_stub_stands_between_the_markers(assignment):
    """The book made from an installed wheel holds no answer, and releases exactly as the solved one does."""
    bare = build(assignment, solutions=False)
    cell = next(cell for cell in bare.cells if cell.id == "disc")
    assert cell.source.endswith(
        "    ### BEGIN SOLUTION\n    # YOUR CODE HERE\n    raise NotImplementedError()\n    ### END SOLUTION"
    )
    assert "Because" not in dumps(bare)
    assert release(bare) == release(build(assignment))


def test_release_leaves_a_stub_that_raises(assignment):
    """The learner's cell keeps signature, docstring and first lines, then says that it is not written."""
    cell = next(cell for cell in release(build(assignment)).cells if cell.id == "half")
    assert cell.source == ('def half(x, by=2.0):\n    """x divided."""\n    # YOUR CODE HERE\n    raise NotImplementedError()')
    space: dict = {}
    exec(cell.source, space)
    with pytest.raises(NotImplementedError):
        space["half"](1)


def test_release_is_what_nbgrader_releases(assignment, tmp_path):
    """Byte for byte the file of `nbgrader generate_assignment` with its stock settings."""
    course = tmp_path / "course"
    write(assignment, course / "source" / "A7")
    done = subprocess.run(
        [sys.executable, "-m", "nbgrader", "generate_assignment", "A7", f"--CourseDirectory.root={course}"],
        cwd=course, capture_output=True, text=True, timeout=120, check=False,
        # nbgrader calls alembic by its bare name
        env={**os.environ, "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    theirs = (course / "release" / "A7" / "discs.ipynb").read_text()
    assert nbformat.reads(theirs, as_version=4) == release(build(assignment))
    assert theirs.rstrip("\n") == dumps(release(build(assignment))).rstrip("\n")


def test_wheel_ships_the_text_from_which_the_same_learner_version_is_built(assignment, tmp_path, monkeypatch):
    """What hatch_build.py leaves of a source builds to the very notebook that the full source releases."""
    interface = types.ModuleType("hatchling.builders.hooks.plugin.interface")
    interface.BuildHookInterface = object
    for name in ("hatchling", "hatchling.builders", "hatchling.builders.hooks", "hatchling.builders.hooks.plugin"):
        monkeypatch.setitem(sys.modules, name, types.ModuleType(name))
    monkeypatch.setitem(sys.modules, interface.__name__, interface)
    hook = runpy.run_path(str(Path(__file__).resolve().parents[3] / "hatch_build.py"))
    shipped = made(tmp_path / "wheel", hook["without_solutions"](TEXT))
    text = shipped.source.read_text()
    assert "Because" not in text
    assert "x / by" not in text
    assert build(shipped) == build(assignment, solutions=False)


DISC, HALF, WHY = '# %% solution="disc"', '# %% solution="half"', '# %% [markdown] written="why"'
# name: what is replaced, by what, the text of the line that is blamed (None: the file as a whole), what is said
BROKEN = {
    "unknown exercise": ('solution="disc"', 'solution="disk"', '# %% solution="disk"', "did you mean 'disc'?"),
    "no graded cell": ('# %% check="half"\ncheck(half)\n', "", None, "the exercise half has no check cell"),
    "more in a graded cell": ("check(half)", "check(half)  # mine", '# %% check="half"', "must be exactly 'check(half)'"),
    "points that differ": ('check="disc"', 'check="disc" points=6', '# %% check="disc"', "points=6, but the exercise disc is"),
    "second task cell": (HALF, '# %%  solution="disc"', "# %%  solution", "disc has a solution cell already, in line 12"),
    "grade id twice": ('written="why"', 'written="disc"', "# %% [markdown] written", "'disc' is taken by the cell in line 12"),
    "no closing marker": ("    ### END SOLUTION\n\n\n", "\n", "    ### BEGIN", "wanted one '### BEGIN SOLUTION' and after"),
    "solution outside a task": ("guess = None", "### BEGIN SOLUTION\n### END SOLUTION", "# %%\n", "in a cell that is no task"),
    "unknown option": ('# %% check="half"', '# %% checks="half"', "# %% checks", "unknown option 'checks'"),
    "option without quotes": ('# %% check="half"', "# %% check=half", "# %% check=half", "cannot read 'check=half'"),
    "two roles": ('check="disc"', 'check="disc" locked="x"', '# %% check="disc"', "this one has check and locked"),
    "other signature": ("def half(x, by=2.0):", "def half(x, by):", "def half", "'def half(x, by=2.0)'; got 'def half(x, by)'"),
    "no docstring": ('    """x divided."""\n', "", "def half", "needs a docstring"),
    "syntax slip": ("def half(x, by=2.0):", "def half(x, by=2.0)", "def half", "not Python: expected ':'"),
    "folded task": (DISC, DISC + " fold=true", DISC, "fold=true hides code that need not be read"),
    "words worth nothing": (" points=3", "", WHY, "says what it is worth"),
    "words in code": ('[markdown] written="why"', 'written="why"', "# %% written", "a written answer is a [markdown] cell"),
    "check before task": (DISC, f'# %% check="disc" \ncheck(disc)\n\n{DISC}', '# %% check="disc" \n', "comes before the cell"),
    "text before": ("# %% [markdown]\n# # What", "x = 1\n# %% [markdown]\n# # What", "x = 1", "text before the first cell"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_text_is_named_with_file_and_line(tmp_path, name):
    """A complaint begins with the place to mend."""
    old, new, blamed, message = BROKEN[name]
    assert old in TEXT
    text = TEXT.replace(old, new, 1)
    broken = made(tmp_path, text)
    place = str(broken.source) if blamed is None else f"{broken.source}:{text[: text.index(blamed)].count(chr(10)) + 1}"
    with pytest.raises(CourseError, match=re.escape(message)) as caught:
        build(broken)
    assert str(caught.value).startswith(f"{place}: ")


def test_missing_source_is_named(tmp_path):
    """An assignment without a notebook says which file is wanted."""
    assignment = made(tmp_path)
    assignment.source.unlink()
    with pytest.raises(CourseError, match=r"notebook\.py: there is no such notebook source"):
        build(assignment)
