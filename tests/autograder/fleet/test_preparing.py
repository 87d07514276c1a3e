"""The sandbox starts before the gradebook is read: once, the right one, and only if something is to be graded."""

import json

import pytest

from autograder import authoring, fleet
from autograder.notebook import session
from autograder.sandbox import ahead


@pytest.fixture
def started(monkeypatch):
    """The policies of all sandboxes that are started, in order."""
    found, start = [], session.Sandbox

    def recorded(**options):
        found.append(options["policy"])
        return start(**options)

    monkeypatch.setattr(session, "Sandbox", recorded)
    return found


@pytest.mark.parametrize(("name", "notebook"), [("ordinary", "one"), ("surfaces", "known-forms")])
def test_one_sandbox_serves_a_run_and_none_a_run_without_work(request, started, name, notebook):
    """What the instructor's files tell is what the gradebook tells, for asserts and for exercises."""
    room = request.getfixturevalue(name)
    room.hand_in("ada", {notebook: {}})
    assert fleet.grade(room.course(), room.assignment).student("ada").status == "graded"
    assert len(started) == 1
    assert fleet.grade(room.course(), room.assignment).student("ada").status == "unchanged"
    assert len(started) == 1


def test_without_the_instructor_s_files_the_gradebook_decides(surfaces, started):
    """They may be anywhere, or not be there any more: another sandbox is started then."""
    surfaces.hand_in("ada", {"known-forms": {}})
    expected = fleet.grade(surfaces.course(), "A1")
    for path in surfaces.folder.glob("*/A1/*.ipynb"):
        path.unlink()
    graded = fleet.grade(surfaces.course(), "A1", force=True)
    assert [cell.points for cell in graded.student("ada").cells] == [cell.points for cell in expected.student("ada").cells]
    assert started[0] == started[-1]
    assert len(started) == 3


def test_a_release_leaves_the_note_that_a_run_leaves(surfaces):
    """So the first run begins with its sandbox too."""
    note = ahead.note(surfaces.folder / ".directrix", "A1")
    authoring.release(surfaces.folder, "A1")
    told = json.loads(note.read_text("utf-8"))
    note.unlink()
    surfaces.hand_in("ada", {"known-forms": {}})
    graded = fleet.grade(surfaces.course(), "A1")
    assert json.loads(note.read_text("utf-8")) == {**told, "level": graded.level}
