"""Writing the gradebook: batches, what is never touched, and what nbgrader's own API reads afterwards."""

import contextlib
import datetime
import re
import sqlite3
import threading

import pytest
import sqlalchemy as sa

from autograder.errors import CourseError
from autograder.gradebook import Gradebook, NotebookMarks, Record
from autograder.notebook.marks import Mark

MARKS = {
    "one": NotebookMarks(
        {"test_square": Mark(2.0), "test_half": Mark(0.0, look=True), "code_answer": Mark(None, look=True), "why": Mark(0.0)},
        frozenset({"why"}),
    ),
    "two": NotebookMarks({"test_add": Mark(1.0)}),
}


@pytest.fixture
def book(ordinary):
    with Gradebook(f"sqlite:///{ordinary.folder / 'gradebook.db'}") as opened:
        yield opened


def test_the_instructors_copy_is_read_whole(book):
    row = book.assignment("ps1")
    assert list(row.notebooks) == ["one", "two"]
    cells = row.notebooks["one"].master.cells
    assert cells["test_square"].points == 2.0
    assert "secret_number" in cells["test_square"].source
    flags = {name: (cell.grade, cell.solution, cell.task, cell.locked) for name, cell in cells.items()}
    assert flags == {
        "helper": (False, False, False, True), "square": (False, True, False, False), "test_square": (True, False, False, True),
        "half": (False, True, False, False), "test_half": (True, False, False, True), "code_answer": (True, True, False, False),
        "why": (True, True, False, False), "essay": (False, False, True, True),
    }  # fmt: skip
    assert row.notebooks["one"].master.kernelspec["name"] == "python3"


def test_nbgraders_api_reads_what_we_wrote(book, ordinary):
    from nbgrader.api import Gradebook as Nbgraders

    row = book.assignment("ps1")
    standings = book.write(row, [Record(f"s{number}", None, MARKS) for number in range(120)])
    assert standings["s7"].score == 3.0
    with Nbgraders(f"sqlite:///{ordinary.folder / 'gradebook.db'}") as theirs:
        submission = theirs.find_submission("ps1", "s7")
        assert (submission.score, submission.max_score, submission.needs_manual_grade) == (3.0, 16.5, True)
        assert theirs.find_comment("why", "one", "ps1", "s7").comment == "No response."
        assert theirs.find_comment("square", "one", "ps1", "s7").comment is None
        assert theirs.find_grade("test_half", "one", "ps1", "s7").needs_manual_grade
        assert not theirs.find_grade("test_square", "one", "ps1", "s7").needs_manual_grade
        assert len(theirs.assignment_submissions("ps1")) == 120


def test_writing_again_adds_no_row_and_touches_no_manual_work(book, ordinary):
    row = book.assignment("ps1")
    book.write(row, [Record("ada", datetime.datetime(2027, 1, 1), MARKS)])
    rows = {
        table: ordinary.sql(f"select count(*) from {table}") for table in ("grade", "comment", "submitted_notebook", "student")
    }
    ordinary.sql("update comment set manual_comment = 'well done'")
    ordinary.sql("update grade set manual_score = 1, extra_credit = 0.5, needs_manual_grade = 0")
    ordinary.sql("update submitted_notebook set flagged = 1")
    ordinary.sql("update student set first_name = 'Ada'")
    book.write(row, [Record("ada", None, MARKS)])
    assert rows == {table: ordinary.sql(f"select count(*) from {table}") for table in rows}
    assert ordinary.sql("select distinct manual_comment from comment") == [("well done",)]
    assert ordinary.sql("select distinct manual_score, extra_credit from grade") == [(1.0, 0.5)]
    assert ordinary.sql("select distinct flagged from submitted_notebook") == [(1,)]
    assert ordinary.sql("select timestamp from submitted_assignment") == [("2027-01-01 00:00:00.000000",)]
    assert ordinary.sql("select distinct needs_manual_grade from grade") == [(1,)]  # tasks too: the work is another now
    assert book.students()["ada"] == "Ada"


def test_a_missing_notebook_is_zero_and_a_broken_one_has_no_marks(book, ordinary):
    row = book.assignment("ps1")
    book.write(row, [Record("ada", None, MARKS)])
    book.write(row, [Record("ada", None, {"one": NotebookMarks(broken=True), "two": NotebookMarks(missing=True)})])
    marks = {name: row for name, *row in ordinary.sql(
        "select b.name, auto_score, needs_manual_grade from grade join base_cell b on cell_id = b.id")}  # fmt: skip
    assert marks == {
        "test_square": [None, 1], "test_half": [None, 1], "code_answer": [None, 1], "why": [None, 1], "essay": [None, 1],
        "test_add": [0.0, 0],
    }  # fmt: skip


def test_a_penalty_is_capped_to_the_score_and_only_for_the_late(book, ordinary):
    ordinary.sql("update assignment set duedate = '2027-01-01 00:00:00.000000'")
    row = book.assignment("ps1")
    seen = []

    def policy(student, score, late):
        seen.append((student, score, late))
        return {2.0: 99.0, 1.0: -5.0}[score]

    late, early = datetime.datetime(2027, 1, 1, 1), datetime.datetime(2026, 12, 1)
    standings = book.write(row, [Record("ada", late, MARKS), Record("bob", early, MARKS)], penalty=policy)
    assert seen == [("ada", 2.0, 3600.0), ("ada", 1.0, 3600.0)]
    assert (standings["ada"].penalty, standings["bob"].penalty) == (2.0, 0.0)
    assert book.penalties(row) == {("ada", "one"): 2.0, ("ada", "two"): 0.0, ("bob", "one"): 0.0, ("bob", "two"): 0.0}


def test_what_a_missing_notebook_was_given_goes_when_it_is_handed_in(book, ordinary):
    """The zero of its task as well: somebody has to look at the task now."""
    row = book.assignment("ps1")
    task = "select auto_score, needs_manual_grade from grade join base_cell b on cell_id = b.id where b.name = 'essay'"
    book.write(row, [Record("ada", None, {**MARKS, "one": NotebookMarks(missing=True)})])
    assert ordinary.sql(task) == [(0.0, 0)]
    book.write(row, [Record("ada", None, MARKS)])
    assert ordinary.sql(task) == [(None, 1)]


@pytest.mark.parametrize("left", [NotebookMarks(missing=True), NotebookMarks(broken=True)])
def test_a_notebook_that_is_left_out_takes_nothing_off_the_others(book, ordinary, left):
    ordinary.sql("update assignment set duedate = '2027-01-01 00:00:00.000000'")
    row, late = book.assignment("ps1"), datetime.datetime(2027, 1, 1, 1)

    def all_of_it(student, score, seconds):
        return score

    assert book.write(row, [Record("ada", late, MARKS)], penalty=all_of_it)["ada"].penalty == 3.0
    standing = book.write(row, [Record("ada", late, {**MARKS, "one": left})], penalty=all_of_it)["ada"]
    assert (standing.score, standing.penalty) == (1.0, 1.0)
    assert book.penalties(row) == {("ada", "one"): 0.0, ("ada", "two"): 1.0}
    ordinary.sql("update grade set manual_score = 1.5 where cell_id = (select id from base_cell where name = 'essay')")
    ordinary.sql("update submitted_notebook set late_submission_penalty = 2")
    assert book.write(row, [Record("ada", late, {**MARKS, "one": left})], penalty=all_of_it)["ada"].penalty == 2.5


def test_a_part_of_the_class_reads_as_in_the_whole(book, ordinary):
    ordinary.sql("update assignment set duedate = '2027-01-01 00:00:00.000000'")
    row = book.assignment("ps1")
    late = datetime.datetime(2027, 1, 1, 1)
    book.write(row, [Record(name, late, MARKS) for name in ("ada", "bob", "eve")], penalty=lambda student, score, late: 0.5)
    ordinary.sql("update grade set manual_score = 1, extra_credit = 0.25 where rowid % 3 = 0")
    ordinary.sql("update student set first_name = 'Ada' where id = 'ada'")
    some = ["eve", "ada", "nobody"]
    for read in (lambda *only: book.read_marks(row, *only), lambda *only: book.standings(row, *only), book.students):
        whole = read()
        assert whole.keys() == {"ada", "bob", "eve"}
        assert read(some) == {name: whole[name] for name in ("ada", "eve")}
        assert read([]) == {}
    assert book.penalties(row, some) == {key: taken for key, taken in book.penalties(row).items() if key[0] in some}
    assert len(book.penalties(row, some)) == 4


def test_no_statement_about_some_submissions_reads_those_of_all(book):
    """nbgrader's indexes begin with what these need not name; where they do not name it, each takes longer in a large class."""
    row = book.assignment("ps1")
    plans = []

    @sa.event.listens_for(book.engine, "before_cursor_execute")
    def _(connection, cursor, statement, parameters, context, executemany):
        if statement.split()[0] in ("SELECT", "UPDATE"):
            given = parameters[0] if executemany else parameters
            found = connection.connection.dbapi_connection.execute(f"explain query plan {statement}", given)
            plans.extend(line[3] for line in found)

    book.write(row, [Record("ada", datetime.datetime(2027, 1, 1), MARKS)], penalty=lambda student, score, late: 0.5)
    book.read_marks(row, ["ada"])
    book.standings(row, ["ada"])
    book.students(["ada"])
    book.comments(row, "ada")
    book.penalties(row, ["ada"])
    book.unmarked(row, "ada")
    book.marked(row)
    assert len(plans) > 30
    assert [plan for plan in plans if plan.startswith("SCAN")] == []


def test_two_writers_wait_for_each_other(book, ordinary):
    """SQLite's default is to fail with "database is locked" when two transactions want to write."""
    row = book.assignment("ps1")
    failures = []

    def write(prefix):
        try:
            with Gradebook(f"sqlite:///{ordinary.folder / 'gradebook.db'}") as mine:
                for number in range(10):
                    mine.write(row, [Record(f"{prefix}{number}", None, MARKS)])
        except Exception as error:
            failures.append(error)

    threads = [threading.Thread(target=write, args=(prefix,)) for prefix in "abc"]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert failures == []
    assert ordinary.sql("select count(*) from submitted_assignment") == [(30,)]


def test_who_holds_the_gradebook_for_too_long_is_asked_for(book, ordinary, monkeypatch):
    monkeypatch.setattr("autograder.gradebook.engine.BUSY_SECONDS", 0.05)
    row = book.assignment("ps1")
    with contextlib.closing(sqlite3.connect(ordinary.folder / "gradebook.db", isolation_level=None)) as other:
        other.execute("begin exclusive")
        mine = Gradebook(f"sqlite:///{ordinary.folder / 'gradebook.db'}")
        with mine, pytest.raises(CourseError, match=r"locked; .* does another program hold it"):
            mine.write(row, [Record("ada", None, MARKS)])


@pytest.mark.parametrize(("name", "says"), [("PS1", "Did you mean ps1?"), ("ps1/", "Did you mean ps1?"), ("ps2", "Release it")])
def test_an_assignment_that_is_not_there_is_told_from_one_that_was_mistyped(book, name, says):
    with pytest.raises(CourseError, match=re.escape(f"has no assignment {name!r}; there are: ps1. {says}")):
        book.assignment(name)


def test_what_is_no_gradebook_is_said_plainly(tmp_path):
    with pytest.raises(CourseError, match="there is no gradebook"):
        Gradebook(f"sqlite:///{tmp_path / 'none.db'}")
    (tmp_path / "junk.db").write_bytes(b"not a database, but a text that is long enough to be looked at")
    with Gradebook(f"sqlite:///{tmp_path / 'junk.db'}") as junk, pytest.raises(CourseError, match="cannot be used"):
        junk.assignment("A1")
    (tmp_path / "empty.db").touch()
    with Gradebook(f"sqlite:///{tmp_path / 'empty.db'}") as empty, pytest.raises(CourseError, match="cannot be used"):
        empty.assignment("A1")
