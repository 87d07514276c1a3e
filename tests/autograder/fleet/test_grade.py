"""A class graded in the real sandbox: marks, tables, files, and what happens the second time."""

import json
import subprocess
import sys

import pytest

from autograder import fleet
from autograder.errors import CourseError

RIGHT = {"square": "def square(x): return x * x", "half": "def half(x): return x / 2"}
ADD = {"add": "def add(a, b): return a + b"}


def points(graded, student):
    return {cell.name: cell.points for cell in graded.student(student).cells}


def test_every_kind_of_cell_is_marked_as_nbgrader_marks_it(ordinary):
    """Hidden tests count, a returned number is partial credit, an untouched answer is 0, a written one waits."""
    ordinary.hand_in("ada", {"one": {**RIGHT, "why": "It is so."}, "two": ADD})
    ordinary.hand_in("bob", {"one": {"square": "def square(x): return 4", "half": "def half(x): return 0"}, "two": {}})
    graded = fleet.grade(ordinary.course(), "ps1")
    assert points(graded, "ada") == {
        "test_square": 2.0, "test_half": 3.0, "code_answer": 0.0, "why": None, "essay": None, "test_add": 1.0,
    }  # fmt: skip
    assert points(graded, "bob") == {
        "test_square": 0.0, "test_half": 1.5, "code_answer": 0.0, "why": 0.0, "essay": None, "test_add": 0.0,
    }  # fmt: skip
    assert graded.failures == ()
    assert graded.student("ada").looks == 2


def test_grading_twice_changes_nothing(ordinary):
    ordinary.hand_in("ada", {"one": RIGHT, "two": ADD}, files={"notes.txt": b"mine"})
    first = fleet.grade(ordinary.course(), "ps1")
    tables, files = ordinary.tables(), ordinary.autograded()
    again = fleet.grade(ordinary.course(), "ps1")
    assert [student.status for student in again.students] == ["unchanged"]
    assert (ordinary.tables(), ordinary.autograded()) == (tables, files)
    forced = fleet.grade(ordinary.course(), "ps1", force=True)
    assert [student.status for student in forced.students] == ["graded"]
    assert (ordinary.tables(), ordinary.autograded()) == (tables, files)
    assert points(again, "ada") == points(first, "ada") == points(forced, "ada")


def test_a_changed_submission_is_graded_again_and_keeps_no_old_mark(ordinary):
    """nbgrader keeps the old mark of a test cell that the new submission no longer has."""
    ordinary.hand_in("ada", {"one": RIGHT, "two": ADD})
    fleet.grade(ordinary.course(), "ps1")

    def without_test(nb):
        nb["cells"] = [cell for cell in nb["cells"] if cell["metadata"].get("nbgrader", {}).get("grade_id") != "test_square"]

    ordinary.hand_in("ada", {"one": without_test, "two": ADD})
    graded = fleet.grade(ordinary.course(), "ps1")
    assert points(graded, "ada")["test_square"] is None
    assert ordinary.sql("select auto_score, needs_manual_grade from grade where cell_id = "
                        "(select id from base_cell where name = 'test_square')") == [(None, 1)]  # fmt: skip


def test_a_manual_mark_survives_and_asks_for_a_look(ordinary):
    ordinary.hand_in("ada", {"one": RIGHT, "two": ADD})
    fleet.grade(ordinary.course(), "ps1")
    cell = "(select id from base_cell where name = 'test_square')"
    ordinary.sql(f"update grade set manual_score = 0.25, extra_credit = 1, needs_manual_grade = 0 where cell_id = {cell}")
    graded = fleet.grade(ordinary.course(), "ps1", force=True)
    assert ordinary.sql(
        f"select auto_score, manual_score, extra_credit, needs_manual_grade from grade where cell_id = {cell}"
    ) == [(2.0, 0.25, 1.0, 1)]
    assert points(graded, "ada")["test_square"] == 1.25


def test_late_submissions_lose_what_nbgraders_policy_takes(ordinary):
    """penalty_method = "zero": all points, capped to the score; an extension counts; in time again, the penalty goes."""
    ordinary.sql("update assignment set duedate = '2027-02-01 12:00:00.000000'")
    ordinary.hand_in("late", {"one": RIGHT, "two": ADD}, timestamp="2027-02-01 13:00:00.000000 UTC")
    ordinary.hand_in("good", {"one": RIGHT, "two": ADD}, timestamp="2027-02-01 13:00:00.000000 +0100")
    graded = fleet.grade(ordinary.course(), "ps1")
    assert (graded.student("late").penalty, graded.student("late").seconds_late) == (6.0, 3600.0)
    assert (graded.student("good").penalty, graded.student("good").seconds_late) == (0.0, 0.0)
    ordinary.sql("update submitted_assignment set extension = '1970-01-02 00:00:00.000000' where student_id = 'late'")
    graded = fleet.grade(ordinary.course(), "ps1", force=True)
    assert graded.student("late").penalty == 0.0


def test_a_due_date_that_is_set_after_grading_is_told_where_it_would_cost_points(ordinary):
    """As under nbgrader what is graded keeps its penalty until it is graded again; ours says so, and whose."""
    ordinary.hand_in("late", {"one": RIGHT, "two": ADD}, timestamp="2027-02-01 13:00:00.000000 UTC")
    ordinary.hand_in("good", {"one": RIGHT, "two": ADD}, timestamp="2027-02-01 11:00:00.000000 UTC")
    assert fleet.grade(ordinary.course(), "ps1").student("late").notes == ()
    ordinary.sql("update assignment set duedate = '2027-02-01 12:00:00.000000'")
    graded = fleet.grade(ordinary.course(), "ps1")
    assert [student.status for student in graded.students] == ["unchanged", "unchanged"]
    assert (graded.student("late").penalty, graded.student("good").notes) == (0.0, ())
    assert "the due date or an extension has changed" in graded.student("late").notes[0]
    graded = fleet.grade(ordinary.course(), "ps1", force=True)
    assert (graded.student("late").penalty, graded.student("late").notes) == (6.0, ())


def test_a_date_that_cannot_be_read_is_named_and_not_forgiven(ordinary):
    ordinary.hand_in("ada", {"one": RIGHT, "two": ADD}, timestamp="yesterday, I think")
    graded = fleet.grade(ordinary.course(), "ps1")
    assert "timestamp.txt" in graded.broken[0]
    assert not (ordinary.folder / "autograded" / "ada").exists()


def test_a_newer_timestamp_grades_again(ordinary):
    ordinary.hand_in("ada", {"one": RIGHT, "two": ADD}, timestamp="2027-02-01 12:00:00.000000 UTC")
    fleet.grade(ordinary.course(), "ps1")
    (ordinary.folder / "submitted/ada/ps1/timestamp.txt").write_text("2027-02-02 12:00:00.000000 UTC")
    assert [student.status for student in fleet.grade(ordinary.course(), "ps1").students] == ["graded"]


def test_a_missing_notebook_is_zero_and_a_broken_one_is_named(ordinary):
    ordinary.hand_in("ada", {"one": RIGHT})
    ordinary.hand_in("bob", {"one": RIGHT, "two": '{"nbformat": 4, "cells": [{"cell_ty'})
    ordinary.hand_in("eve", {})
    graded = fleet.grade(ordinary.course(), "ps1")
    assert points(graded, "ada")["test_add"] == 0.0
    assert points(graded, "bob") == {**points(graded, "ada"), "test_add": None}
    assert graded.broken[0].startswith("bob: two.ipynb: the notebook is not valid JSON: it ends in the middle")
    assert graded.student("eve").status == "empty"
    assert graded.student("eve").looks == 0  # there is nothing of the task either
    assert graded.student("eve").notes == ("one.ipynb: not handed in", "two.ipynb: not handed in")
    grades = {(row[0], row[2]): row[4:] for row in ordinary.tables()["grades"]}
    assert grades["ada", "test_add"] == (0.0, None, None, 0)
    assert grades["bob", "test_add"] == (None, None, None, 1)


def test_what_lies_there_in_the_place_of_a_notebook_is_noted(ordinary):
    """Under another name, in a folder, in an archive: none is graded, and each is said."""
    place = ordinary.hand_in("eve", {}, files={"one (1).ipynb": b"{}", "work.zip": b"PK"})
    (place / "hw").mkdir()
    (place / "hw" / "two.ipynb").write_text("{}")
    left, wanted = "not a notebook of this assignment, left out", "not handed in"
    assert fleet.grade(ordinary.course(), "ps1").student("eve").notes == (
        f"hw/two.ipynb: {left}", f"one (1).ipynb: {left}", "work.zip: an archive, not opened",
        f"one.ipynb: {wanted}", f"two.ipynb: {wanted}",
    )  # fmt: skip


def test_links_and_devices_are_not_copied(ordinary):
    import os

    place = ordinary.hand_in("ada", {"one": RIGHT, "two": ADD}, files={"mine.txt": b"kept"})
    (place / "book").symlink_to(ordinary.folder / "gradebook.db")
    (place / "zero").symlink_to("/dev/zero")
    (place / "all").symlink_to("/etc", target_is_directory=True)
    os.mkfifo(place / "pipe")
    graded = fleet.grade(ordinary.course(), "ps1")
    names = {path.name for path in (ordinary.folder / "autograded/ada/ps1").iterdir()}
    assert names == {"one.ipynb", "two.ipynb", "mine.txt", "data.txt"}
    assert len(graded.student("ada").notes) == 4
    assert points(graded, "ada")["test_square"] == 2.0


def test_a_notebook_that_is_a_link_to_a_classmates_is_not_read(ordinary):
    good = ordinary.hand_in("ada", {"one": RIGHT, "two": ADD})
    place = ordinary.hand_in("bob", {"two": ADD})
    (place / "one.ipynb").symlink_to(good / "one.ipynb")
    graded = fleet.grade(ordinary.course(), "ps1")
    assert points(graded, "bob")["test_square"] is None
    assert graded.broken == ("bob: one.ipynb: it is a link, not a file",)


def test_a_students_folder_that_is_a_link_to_a_classmates_is_not_read(ordinary):
    ordinary.hand_in("ada", {"one": {}})
    (ordinary.folder / "submitted" / "bob").symlink_to(ordinary.folder / "submitted" / "ada", target_is_directory=True)
    graded = fleet.grade(ordinary.course(), "ps1")
    assert graded.broken == ("bob: the student's folder is a link to another folder",)
    assert graded.student("ada").status == "graded"


def test_a_notebook_that_is_too_large_is_named_and_not_called_missing(ordinary):
    """Figures make notebooks large; a learner whose work is left out for that must not pass for one who handed in nothing."""
    from autograder.notebook.submission import Bounds

    course = ordinary.course()
    ordinary.hand_in("ada", {"one": RIGHT, "two": ADD})
    assert points(fleet.grade(course, "ps1"), "ada")["test_square"] == 2.0
    large = json.dumps({"nbformat": 4, "cells": [], "metadata": {"x": "x" * Bounds().notebook}})
    ordinary.hand_in("ada", {"one": large, "two": large})
    graded = fleet.grade(course, "ps1")
    assert graded.student("ada").status == "broken"
    assert points(graded, "ada") == dict.fromkeys(points(graded, "ada"))
    assert "bytes are more than" in graded.broken[0]


def test_a_file_where_others_need_a_folder_gives_way(ordinary):
    """A file of the learner's called like a folder of the instructor's, and a folder turned into a file by the notebook."""
    (ordinary.folder / "source/ps1/tables").mkdir()
    (ordinary.folder / "source/ps1/tables/a.csv").write_bytes(b"1,2")
    turn = "import os, shutil; os.makedirs('mine', exist_ok=True); shutil.rmtree('mine'); open('mine', 'w').write('x')"
    turn += "\nshutil.rmtree('tables'); open('tables', 'w').write('x')"
    place = ordinary.hand_in("ada", {"one": {**RIGHT, "square": f"{RIGHT['square']}\n{turn}"}, "two": ADD})
    (place / "tables").write_bytes(b"not a folder")
    (place / "mine").mkdir()
    (place / "mine" / "b.txt").write_bytes(b"b")
    graded = fleet.grade(ordinary.course(), "ps1")
    assert graded.failures == ()
    assert points(graded, "ada")["test_square"] == 2.0
    done = ordinary.folder / "autograded/ada/ps1"
    assert (done / "tables/a.csv").read_bytes() == b"1,2"
    assert (done / "mine").read_bytes() == b"x"


@pytest.mark.parametrize(
    "student",
    ["\u65e5\u672c" * 40, "Bob O'Neil", "--help", "=1+1"],  # 240 bytes are a folder's name; quoted, too many for a file's
    ids=["long", "apostrophe", "option", "formula"],
)
def test_an_odd_id_is_graded_once(ordinary, student):
    ordinary.hand_in(student, {"one": RIGHT, "two": ADD})
    assert fleet.grade(ordinary.course(), "ps1").student(student).status == "graded"
    assert fleet.grade(ordinary.course(), "ps1").student(student).status == "unchanged"


def test_files_of_the_learner_are_kept_but_never_over_the_instructors(ordinary):
    write = (
        "open('out.txt', 'w').write('made'); open('data.txt', 'w').write('forged'); open('timestamp.txt', 'w').write('1999')"
    )
    ordinary.hand_in("ada", {"one": {**RIGHT, "square": f"{RIGHT['square']}\n{write}"}, "two": ADD})
    fleet.grade(ordinary.course(), "ps1")
    place = ordinary.folder / "autograded/ada/ps1"
    assert (place / "out.txt").read_text() == "made"
    assert (place / "data.txt").read_text() == "of the instructor\n"
    assert not (place / "timestamp.txt").exists()
    assert oct((place / "one.ipynb").stat().st_mode)[-3:] == "444"


def test_one_student_only_and_who_is_not_there(ordinary):
    ordinary.hand_in("ada", {"one": RIGHT, "two": ADD})
    ordinary.hand_in("bob", {"one": RIGHT, "two": ADD})
    assert [student.student for student in fleet.grade(ordinary.course(), "ps1", students=["bob"]).students] == ["bob"]
    with pytest.raises(CourseError, match="no submission of ps1 by eve"):
        fleet.grade(ordinary.course(), "ps1", students=["eve"])
    with pytest.raises(CourseError, match="no assignment 'ps9'; there are: ps1"):
        fleet.grade(ordinary.course(), "ps9")


def test_a_second_grader_is_refused(ordinary):
    from autograder.fleet.journal import only_grader

    course = ordinary.course()
    with only_grader(course.room), pytest.raises(CourseError, match="another grader"):
        fleet.grade(course, "ps1")


def test_progress_counts_everybody(ordinary):
    for student in ("ada", "bob", "eve"):
        ordinary.hand_in(student, {"one": RIGHT, "two": ADD} if student != "eve" else {"one": "broken"})
    seen = []
    fleet.grade(ordinary.course(), "ps1", progress=lambda *told: seen.append(told))
    assert [told[:2] for told in seen] == [(1, 3), (2, 3), (3, 3)]
    assert {told[2] for told in seen} == {"ada", "bob", "eve"}


def test_the_report_is_json_both_ways(ordinary):
    ordinary.hand_in("ada", {"one": RIGHT, "two": ADD})
    graded = fleet.grade(ordinary.course(), "ps1")
    data = json.loads(graded.to_json())
    assert data["students"][0]["cells"][0]["name"] == "test_square"
    assert fleet.StudentReport.from_dict(data["students"][0]) == graded.students[0]


def test_what_takes_long_to_load_is_not_loaded_before_the_sandbox_starts():
    """SQLAlchemy, scipy and plotly wait, or the sandbox would."""
    late = ("sqlalchemy", "scipy", "plotly", "nbformat", "nbgrader")
    code = f"import sys; from autograder import fleet, report; print(sorted(set(sys.modules) & set({late!r})))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert done.stdout.strip() == "[]", done.stderr


def test_the_hot_path_imports_no_nbgrader(ordinary):
    """Three seconds of imports, and an ORM that costs a hundred times the statements."""
    ordinary.hand_in("ada", {"one": RIGHT, "two": ADD})
    code = (
        "import sys; from autograder import fleet; "
        f"graded = fleet.grade(fleet.Course({str(ordinary.folder)!r}), 'ps1'); "
        "assert graded.students[0].score == 6, graded; "
        "print(sorted(name for name in sys.modules if name.split('.')[0] in ('nbgrader', 'nbconvert', 'nbformat', 'IPython')))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert done.stdout.strip() == "[]", done.stderr
