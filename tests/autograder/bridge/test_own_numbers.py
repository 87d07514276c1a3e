"""Numbers of one's own under stock `nbgrader autograde` with our line: judged and shown as `directrix grade` does."""

import os
import subprocess
import sys
from pathlib import Path

import nbformat

from autograder import fleet


def test_an_exercise_with_numbers_of_ones_own_gets_the_same_marks(own_numbers_template, bridge_line, tmp_path):
    """Whose numbers they are is what the folder says, there too: the same marks, and the same notebooks."""
    room = own_numbers_template.copy(tmp_path / "ours")
    room.configure(bridge_line)
    room.course().secret()  # hidden data are drawn from it: one for both
    theirs = room.copy(tmp_path / "theirs")
    done = subprocess.run(
        [Path(sys.executable).parent / "nbgrader", "autograde", "A2"], cwd=theirs.folder, capture_output=True, text=True,
        timeout=300, env={**os.environ, "JUPYTER_CONFIG_DIR": str(theirs.folder / ".jupyter")},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    (told,) = [line for line in done.stderr.splitlines() if "the id typed in it" in line]
    assert "bob: linear-sweep.ipynb: the id typed in it is 'ada'" in told
    assert fleet.grade(room.course(), "A2", workers=1).failures == ()
    assert room.tables() == theirs.tables()
    marks = {student: score for student, _, cell, _, score, *_ in room.tables()["grades"] if cell == "check_linear_sweep"}
    assert marks == {"ada": 3.0, "bob": 3.0, "eve": 3.0}
    mine, other = room.autograded(), theirs.autograded()
    assert list(mine) == list(other)
    for name, data in mine.items():
        if name.endswith(".ipynb"):
            assert nbformat.reads(data.decode(), 4) == nbformat.reads(other[name].decode(), 4), name
        else:
            assert data == other[name], name
