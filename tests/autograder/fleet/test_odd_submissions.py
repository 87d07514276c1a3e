"""Odd things handed in are named in the report, whatever they are; and an answer that was taken away has no marks."""

import errno
import importlib
import json

import pytest

from autograder import fleet

RIGHT = {"square": "def square(x): return x * x", "half": "def half(x): return x / 2"}
ADD = {"add": "def add(a, b): return a + b"}


def test_a_link_to_nowhere_is_named(ordinary):
    """Of the assignment's folder, and of the student's: both would otherwise be in no table."""
    ordinary.hand_in("ada", {"two": ADD})
    submitted = ordinary.folder / "submitted"
    (submitted / "bob").mkdir()
    (submitted / "bob" / "ps1").symlink_to("nowhere")
    (submitted / "cas").symlink_to("nowhere")
    (submitted / "dee").mkdir()  # has handed in another assignment: no concern of this one
    graded = fleet.grade(ordinary.course(), "ps1")
    assert [student.student for student in graded.students] == ["ada", "bob", "cas"]
    assert graded.student("ada").status == "graded"
    assert graded.student("bob").broken == ("the submission is no folder that can be opened: Not a directory",)
    assert graded.student("cas").broken == ("the student's folder is a link to another folder",)


def test_a_folder_in_place_of_a_notebook_is_named_and_not_taken_for_nothing(ordinary):
    place = ordinary.hand_in("ada", {"two": ADD})
    (place / "one.ipynb").mkdir()
    (place / "one.ipynb" / "x.txt").write_text("x")
    graded = fleet.grade(ordinary.course(), "ps1")
    assert graded.broken == ("ada: one.ipynb: it is a folder, not a notebook",)
    assert {cell.points for cell in graded.student("ada").cells if cell.notebook == "one"} == {None}


@pytest.mark.parametrize("files", [{}, {"notes.txt": b"sorry"}])
def test_an_emptied_resubmission_loses_its_marks_and_asks_for_a_look(ordinary, files):
    """As a deleted cell does. What an instructor gave by hand stays."""
    ordinary.hand_in("ada", {"one": RIGHT, "two": ADD})
    ordinary.hand_in("eve", {})
    first = fleet.grade(ordinary.course(), "ps1")
    assert first.student("ada").score > 0
    by_hand = "update grade set manual_score = 3 where cell_id in (select id from base_cell where name = 'why')"
    ordinary.sql(by_hand)
    ordinary.hand_in("ada", {}, files=files)
    graded = fleet.grade(ordinary.course(), "ps1")
    assert graded.student("ada").status == "empty"
    assert "no marks" in " ".join(graded.student("ada").notes)
    assert graded.student("ada").score == 3
    marks = {(cell, auto, look) for who, _, cell, _, auto, _, _, look in ordinary.tables()["grades"] if who == "ada"}
    assert {auto for _, auto, _ in marks} == {None}
    assert {look for _, _, look in marks} == {1}
    assert not (ordinary.folder / "autograded" / "ada" / "ps1").exists()
    again = fleet.grade(ordinary.course(), "ps1")
    assert (again.student("ada").score, again.student("ada").status) == (3, "empty")
    assert again.student("eve").status == "empty"
    assert ordinary.sql("select count(*) from submitted_assignment where student_id = 'eve'") == [(0,)]
    ordinary.hand_in("ada", {"one": RIGHT, "two": ADD})
    assert fleet.grade(ordinary.course(), "ps1").student("ada").status == "graded"


@pytest.mark.parametrize("said", ["true", "4.0", '"4"', "null"])
def test_a_version_that_is_no_whole_number_is_no_notebook(ordinary, said):
    notebook = json.dumps(ordinary.released("two")).replace('"nbformat": 4', f'"nbformat": {said}')
    ordinary.hand_in("ada", {"two": notebook})
    graded = fleet.grade(ordinary.course(), "ps1")
    assert graded.broken == ("ada: two.ipynb: the file is JSON, but no notebook",)


def test_a_time_whose_arithmetic_fails_is_no_date_and_stops_nobody(ordinary):
    """dateutil raises decimal.InvalidOperation here; the second run reads it in the process that grades the class."""
    ordinary.hand_in("ada", {"two": ADD})
    ordinary.hand_in("eve", {"two": ADD})
    fleet.grade(ordinary.course(), "ps1")
    ordinary.hand_in("ada", {"two": ADD}, timestamp="6" + "9" * 40 + "m15:00:00")
    graded = fleet.grade(ordinary.course(), "ps1")
    assert "timestamp.txt holds no date" in graded.student("ada").broken[0]
    assert (graded.student("eve").status, graded.faults) == ("unchanged", ())


def test_a_folder_of_a_notebooks_or_the_times_name_that_a_cell_makes_is_not_kept(ordinary):
    makes = (
        "import os\nfor name in 'two.ipynb', 'timestamp.txt':\n    os.path.isfile(name) and os.remove(name)\n"
        "    os.mkdir(name)\n    open(name + '/x', 'w').close()\n"
    )
    ordinary.hand_in("ada", {"two": {"add": makes + ADD["add"]}}, timestamp="2027-02-01 13:00:00 UTC")
    graded = fleet.grade(ordinary.course(), "ps1")
    assert (graded.faults, graded.student("ada").status) == ((), "graded")
    place = ordinary.folder / "autograded" / "ada" / "ps1"
    assert (place / "two.ipynb").is_file()
    assert (place / "timestamp.txt").is_file()


def test_a_folder_that_a_network_disk_loses_is_one_students_fault_and_not_the_classs(ordinary, monkeypatch):
    """The first to read it, when it was graded before, is the process that grades the class."""
    ordinary.hand_in("ada", {"two": ADD})
    ordinary.hand_in("eve", {"two": ADD})
    fleet.grade(ordinary.course(), "ps1")
    grading = importlib.import_module("autograder.fleet.grade")
    read = grading.read_folder

    def lost(folder, **options):
        if folder.parent.name == "ada":
            raise OSError(errno.ESTALE, "Stale file handle")
        return read(folder, **options)

    monkeypatch.setattr(grading, "read_folder", lost)
    graded = fleet.grade(ordinary.course(), "ps1")
    assert graded.faults == ("ada: the submission could not be read: Stale file handle",)
    assert graded.student("eve").status == "unchanged"
