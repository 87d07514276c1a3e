"""The zygote is told the cells that all learners were given, and nothing else of an assignment: its children inherit them."""

import json

import pytest

from autograder import fleet
from autograder.sandbox import Sandbox


@pytest.fixture
def told(monkeypatch):
    """What a sandbox is told to expect."""
    found, expect = [], Sandbox.expect

    def recorded(self, cells):
        found.extend(cells)
        expect(self, cells)

    monkeypatch.setattr(Sandbox, "expect", recorded)
    return found


def codes(path):
    return {"".join(cell["source"]) for cell in json.loads(path.read_bytes())["cells"] if cell["cell_type"] == "code"}


def test_only_released_cells_are_told(ordinary, told):
    """Neither a solution nor a hidden test, though source/ and gradebook have them; without a released file nothing."""
    ordinary.hand_in("ada", {"one": {}})
    first = fleet.grade(ordinary.course(), "ps1").student("ada")
    given, kept = (codes(ordinary.folder / step / "ps1" / "one.ipynb") for step in ("release", "source"))
    both = given | codes(ordinary.folder / "release/ps1/two.ipynb")
    assert set(told) == both
    assert "def secret_number():\n    return 12" in told
    assert any("return x * x" in cell for cell in kept)
    assert any("144" in cell for cell in kept)
    assert not any("return x * x" in cell or "144" in cell or "return a + b" in cell for cell in told)
    told.clear()
    for path in (ordinary.folder / "release/ps1").glob("*.ipynb"):
        path.unlink()
    again = fleet.grade(ordinary.course(), "ps1", force=True).student("ada")
    assert told == []
    assert [cell.points for cell in again.cells] == [cell.points for cell in first.cells]


def test_exercise_cells_are_not_run_and_not_told(surfaces, told):
    surfaces.hand_in("ada", {"known-forms": {}})
    fleet.grade(surfaces.course(), "A1")
    given = codes(surfaces.folder / "release/A1/known-forms.ipynb")
    assert set(told) == {cell for cell in given if not cell.startswith("check(")} < given
