"""The sandbox of a run of nbgrader's: what it is told beforehand, and that the class does not end with it."""

import json

import pytest
from nbgrader.converters import Autograde
from nbgrader.coursedir import CourseDirectory
from traitlets.config import Config

from autograder import bridge, fleet
from autograder.bridge.context import Context, _sandboxes
from autograder.sandbox import Sandbox

RIGHT = {"square": "def square(x): return x * x", "half": "def half(x): return x / 2"}
ADD = {"add": "def add(a, b): return a + b"}


def autograde(room):
    """As `nbgrader autograde ps1` does, in this process."""
    config = Config()
    bridge.configure(config)
    config.CourseDirectory.root = str(room.folder)
    config.CourseDirectory.course_id = "ordinary"
    config.CourseDirectory.assignment_id = "ps1"
    Autograde(coursedir=CourseDirectory(config=config), config=config).start()


def codes(path):
    return {"".join(cell["source"]) for cell in json.loads(path.read_bytes())["cells"] if cell["cell_type"] == "code"}


@pytest.mark.filterwarnings("ignore")  # nbgrader's own, of SQLAlchemy
def test_a_sandbox_that_is_lost_costs_nobody_a_mark(ordinary, tmp_path, monkeypatch):
    """Bob's is killed while he is graded; he is graded again, and Cy after him. Each is told what all were given, no more."""
    for student in ("ada", "bob", "cy"):
        ordinary.hand_in(student, {"one": RIGHT, "two": ADD})
    ordinary.course().secret()
    ours = ordinary.copy(tmp_path / "ours")
    told, killed, expect, files = [], [], Sandbox.expect, Context._files

    def watched(box, cells):
        told.append(tuple(cells))
        expect(box, cells)

    def killing(context):
        if context.student == "bob" and not killed:
            box = _sandboxes[context.converter].box
            killed.append(box)
            box._process.kill()
            box._keeper.join(10)
        return files(context)

    monkeypatch.setattr(Sandbox, "expect", watched)
    monkeypatch.setattr(Context, "_files", killing)
    autograde(ordinary)
    assert len(killed) == 1
    monkeypatch.undo()
    assert fleet.grade(ours.course(), "ps1").failures == ()
    assert ordinary.tables() == ours.tables()
    assert ordinary.autograded() == ours.autograded()
    given = [codes(ordinary.folder / f"release/ps1/{name}.ipynb") for name in ("one", "two")]
    assert [set(cells) for cells in told] == given * 2
