"""The gradebook in PostgreSQL: a real server, tables made by nbgrader's own release, and the rows that SQLite has."""

import datetime
import threading

import pytest

from autograder import feedback, fleet
from autograder.errors import CourseError
from autograder.gradebook import Gradebook, NotebookMarks, Record
from autograder.gradebook import engine as module
from autograder.notebook.marks import Mark

RIGHT = {"square": "def square(x): return x * x", "half": "def half(x): return x / 2"}
ADD = {"add": "def add(a, b): return a + b"}
MARKS = {
    "one": NotebookMarks(
        {"test_square": Mark(2.0), "test_half": Mark(0.0, look=True), "code_answer": Mark(None, look=True), "why": Mark(0.0)},
        frozenset({"why"}),
    ),
    "two": NotebookMarks({"test_add": Mark(1.0)}),
}
LATE = datetime.datetime(2027, 1, 2, 3, 4, 5)


@pytest.fixture
def book(in_postgres):
    with Gradebook(in_postgres.course().database) as opened:
        yield opened


def test_the_same_writes_leave_the_same_rows_in_both(book, in_postgres, ordinary):
    """Writing, manual work, writing again, a missing and a broken notebook, lateness: equal tables in SQLite and PostgreSQL."""
    with Gradebook(ordinary.course().database) as lite:
        for room, mine in ((in_postgres, book), (ordinary, lite)):
            room.sql("update assignment set duedate = '2027-01-01 00:00:00'" + ("" if room is in_postgres else " || '.000000'"))
            row = mine.assignment("ps1")
            policy = {"penalty": lambda student, score, late: 1.5}
            mine.add_course("geometry")
            mine.write(row, [Record(f"s{number}", LATE if number % 2 else None, MARKS) for number in range(60)], **policy)
            room.sql("update grade set manual_score = 1, extra_credit = 0.5 where auto_score = 2")
            room.sql("update comment set manual_comment = 'well done'")
            mine.write(row, [Record("s1", LATE, MARKS), Record("s2", None, {"one": NotebookMarks(broken=True)})], **policy)
            mine.write(row, [Record("s3", None, {"two": NotebookMarks(missing=True)})], **policy)
        assert in_postgres.tables() == ordinary.tables()
        theirs, ours = lite.assignment("ps1"), book.assignment("ps1")
        assert ours.duedate == theirs.duedate
        assert [nb.master for nb in ours.notebooks.values()] == [nb.master for nb in theirs.notebooks.values()]
        assert book.standings(ours) == lite.standings(theirs)
        assert book.read_marks(ours) == lite.read_marks(theirs)
        assert book.penalties(ours) == lite.penalties(theirs)
        assert book.penalties(ours, ["s5"]) == lite.penalties(theirs, ["s5"])
        assert book.marked(ours) == lite.marked(theirs)
        assert book.unmarked(ours, "s5") == lite.unmarked(theirs, "s5")
        assert book.comments(ours, "s5") == lite.comments(theirs, "s5")
        assert {s.penalty for s in book.standings(ours).values()} == {0.0, 1.5, 2.5}  # 1.5: a missing notebook has none left


def test_a_class_graded_into_both_has_the_same_marks_and_nbgrader_reads_them(in_postgres, ordinary):
    for room in (in_postgres, ordinary):
        room.hand_in("ada", {"one": RIGHT, "two": ADD}, timestamp="2027-01-01 10:00:00")
        room.hand_in("bob", {"one": {**RIGHT, "half": "def half(x): return x"}})
        room.hand_in("eve", {"one": "no notebook"})
        graded = fleet.grade(room.course(), "ps1", workers=2)
        assert [student.score for student in graded.students] == [6.0, 2.0, 0.0]
        statuses = [student.status for student in fleet.grade(room.course(), "ps1", workers=1).students]
        assert statuses == ["unchanged", "unchanged", "broken"]
    assert in_postgres.tables() == ordinary.tables()
    assert in_postgres.autograded().keys() == ordinary.autograded().keys()
    assert len(feedback.write(in_postgres.course(), "ps1")) == 3

    from nbgrader.api import Gradebook as Nbgraders

    with Nbgraders(in_postgres.course().database) as theirs:
        submission = theirs.find_submission("ps1", "ada")
        assert (submission.score, submission.max_score, submission.needs_manual_grade) == (6.0, 16.5, True)
        assert theirs.find_comment("square", "one", "ps1", "bob").comment is None


def test_writers_at_the_same_time_lose_nothing(book, in_postgres):
    """Three write the same students, one sets manual marks as formgrader does: one row of each, every manual mark kept."""
    row, failures = book.assignment("ps1"), []
    book.write(row, [Record(f"s{number}", None, MARKS) for number in range(5)])

    def write():
        try:
            with Gradebook(in_postgres.course().database) as mine:
                for _ in range(4):
                    mine.write(row, [Record(f"s{number}", None, MARKS) for number in range(10)])
        except Exception as error:
            failures.append(error)

    threads = [threading.Thread(target=write) for _ in range(3)]
    for thread in threads:
        thread.start()
    waiting = in_postgres.sql("select id from grade where auto_score = 2")
    for (id,) in waiting:
        in_postgres.sql(f"update grade set manual_score = 1.25, needs_manual_grade = false where id = '{id}'")
    for thread in threads:
        thread.join()
    assert failures == []
    assert in_postgres.sql("select count(*) from submitted_assignment") == [(10,)]
    assert in_postgres.sql("select count(*), count(distinct (cell_id, notebook_id)) from grade") == [(60, 60)]
    assert in_postgres.sql("select count(*) from grade where manual_score = 1.25") == [(len(waiting),)]


def test_a_table_that_somebody_holds_is_waited_for_and_then_named(book, in_postgres, monkeypatch):
    row = book.assignment("ps1")
    monkeypatch.setattr(module, "BUSY_SECONDS", 1)
    with in_postgres.server.connect(in_postgres.database) as other:
        other.execute("begin")
        other.execute("lock table grade in access exclusive mode")
        with pytest.raises(CourseError, match="lock timeout"):
            book.write(row, [Record("ada", None, MARKS)])
        other.execute("rollback")
    assert in_postgres.sql("select count(*) from submitted_assignment") == [(0,)]
    assert book.write(row, [Record("ada", None, MARKS)])["ada"].score == 3.0


def test_a_server_that_crashes_and_comes_back(book, in_postgres):
    """A transaction is there whole or not at all, and the connections that were open are replaced."""
    row = book.assignment("ps1")
    book.write(row, [Record("ada", None, MARKS)])
    in_postgres.server.stop()
    with pytest.raises(CourseError, match="the gradebook cannot be used"):
        book.write(row, [Record("bob", None, MARKS)])
    in_postgres.server.start()
    assert book.write(row, [Record("bob", None, MARKS)])["bob"].score == 3.0
    assert in_postgres.sql("select student_id from submitted_assignment order by 1") == [("ada",), ("bob",)]


@pytest.mark.parametrize(
    ("url", "said"),
    [
        ("no url with a password", "is no database URL"),
        ("mysql://somebody:word@host/db", "SQLite or PostgreSQL; c.CourseDirectory.db_url names mysql"),
        ("postgresql+pg8000://somebody:word@host/db", r"needs pg8000: pip install 'directrix\[postgres\]'"),
        ("postgresql+psycopg://somebody:word@/none?host=/nowhere", "the gradebook cannot be used"),
    ],
)
def test_a_database_that_is_not_there_is_named_without_its_password(url, said):
    with pytest.raises(CourseError, match=said) as error, Gradebook(url) as book:
        book.assignment("ps1")
    assert "word" not in str(error.value)
