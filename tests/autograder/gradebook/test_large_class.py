"""A large class is read fifty students at a time, and what is written of it is what reading all at once would give."""

import contextlib
import csv
import io
import json
import sqlite3
import subprocess
import sys
from contextlib import closing

import pytest

from autograder import feedback
from autograder.cli import reading
from autograder.gradebook import Gradebook, NotebookMarks, Record, export
from autograder.notebook.marks import Mark

STUDENTS = [f"s{number:03d}" for number in range(230)]


@pytest.fixture
def large(ordinary):
    """230 students with different marks, some by hand, some late, one without any mark, and one of another assignment."""
    with ordinary.course().gradebook() as book:
        row = book.assignment("ps1")
        some = [
            {
                "one": NotebookMarks({"test_square": Mark(number / 128), "test_half": Mark(3.0)}),
                "two": NotebookMarks(missing=True),
            }
            for number in range(len(STUDENTS))
        ]
        book.write(row, [Record(student, None, marks) for student, marks in zip(STUDENTS, some, strict=True)])
    with closing(sqlite3.connect(ordinary.folder / "gradebook.db")) as connection, connection:
        connection.execute("update student set first_name = 'Ada', last_name = id where id > 's100'")
        connection.execute("update submitted_notebook set late_submission_penalty = 0.25 where rowid % 3 = 0")
        connection.execute("update grade set manual_score = 1.5 where rowid % 7 = 0")
        connection.execute("insert into student (id) values ('nobody')")
        connection.execute("insert into submitted_assignment select 'ff', id, 'nobody', null, null from assignment")
    return ordinary


@pytest.fixture
def asked(monkeypatch):
    """How many students each reading of the gradebook asked for."""
    found = []
    for name in ("read_marks", "penalties", "students"):
        real = getattr(Gradebook, name)

        def counted(self, *arguments, real=real):
            *_, only = arguments
            found.append(len(only))
            return real(self, *arguments)

        monkeypatch.setattr(Gradebook, name, counted)
    return found


def at_once(course):
    """The rows of the sheet, from the whole class read at once."""
    with course.gradebook() as book:
        row = book.assignment("ps1")
        marks, penalties, names = book.read_marks(row), book.penalties(row), book.students()
    cells = [
        (nb, cell.name) for nb, held in row.notebooks.items() for cell in held.master.cells.values() if cell.grade or cell.task
    ]
    for student in sorted(marks):
        points = [marks[student][cell][0] for cell in cells]
        penalty = sum(penalties[student, notebook] for notebook in row.notebooks)
        waiting = sum(look for _, look in marks[student].values())
        total = sum(value for value in points if value is not None) - penalty
        yield [student, names[student], *points, penalty, max(total, 0.0), 16.5, waiting]


def test_the_sheet_of_a_large_class_is_that_of_the_class_read_at_once(large, asked, monkeypatch):
    with large.course().gradebook() as book:
        sheet = export.sheet(book, "ps1")
    assert max(asked) == 50
    assert len(asked) == 3 * 5
    monkeypatch.undo()
    assert [mine.student for mine in sheet.rows] == STUDENTS
    assert list(export.lines(sheet)) == list(at_once(large.course()))


def test_the_table_of_a_large_class_has_its_heading_again_and_json_and_csv_are_whole(large):
    """Tables of a hundred are alike; the document is the one that json.dumps writes."""
    command = [sys.executable, "-m", "autograder", "marks", "ps1", "--json", "--csv", "marks.csv"]
    ran = subprocess.run(command, cwd=large.folder, capture_output=True, text=True, timeout=120)
    assert ran.returncode == 0, ran.stderr
    assert ran.stderr.count("available") == 3
    lines = [line for line in ran.stderr.splitlines() if line.startswith("│")]
    assert [line.split()[1] for line in lines] == STUDENTS
    assert len({len(line) for line in lines}) == 1
    assert ran.stdout == json.dumps(json.loads(ran.stdout)) + "\n"
    rows = json.loads(ran.stdout)["rows"]
    assert [list(row.values()) for row in rows] == list(at_once(large.course()))
    with (large.folder / "marks.csv").open(newline="") as file:
        written = list(csv.reader(file))
    assert [line[0] for line in written[1:]] == STUDENTS
    assert written[0] == list(rows[0])


def test_an_assignment_that_nobody_handed_in_has_an_empty_table(ordinary):
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        reading.marks("ps1", ordinary.folder, as_json=True)
    assert json.loads(out.getvalue()) == {"assignment": "ps1", "rows": []}


@pytest.mark.parametrize(("count", "said"), [(0, ": 0 students, 16.5 points"), (1, ": 1 student, 16.5 points")])
def test_how_many_are_in_the_file_is_said_in_words(ordinary, capsys, tmp_path, count, said):
    with ordinary.course().gradebook() as book:
        book.write(book.assignment("ps1"), [Record("ada", None, {})] * count)
    path = tmp_path / "marks.csv"
    reading.export("ps1", ordinary.folder, csv=path, as_json=False)
    wanted = [f"{path}{said}", *["Nobody has marks of ps1 yet; grade it first: directrix grade ps1"] * (count == 0)]
    assert capsys.readouterr().out.splitlines() == wanted
    assert len(path.read_text().splitlines()) == 1 + count


@pytest.mark.parametrize("verb", [reading.marks, reading.export])
def test_who_handed_in_and_has_no_row_is_named(ordinary, capsys, tmp_path, verb):
    """An empty folder has no row in nbgrader's tables: who takes the rows for the class would forget the student."""
    with ordinary.course().gradebook() as book:
        book.write(book.assignment("ps1"), [Record("ada", None, {})])
    for student in ("ada", "kim"):
        (ordinary.folder / "submitted" / student / "ps1").mkdir(parents=True)
    verb("ps1", ordinary.folder, csv=tmp_path / "marks.csv", as_json=False)
    said = capsys.readouterr().out.splitlines()
    assert said[-1] == "Not among them, without any marks yet: kim. What became of each: directrix grade ps1"
    (ordinary.folder / "submitted" / "kim" / "ps1").rmdir()
    verb("ps1", ordinary.folder, csv=tmp_path / "marks.csv", as_json=False)
    assert "kim" not in capsys.readouterr().out


def test_feedback_reads_fifty_at_a_time_and_a_single_page_one_student(large, asked):
    released = (large.folder / "release/ps1/two.ipynb").read_bytes()
    for student in STUDENTS[:70]:
        place = large.folder / "autograded" / student / "ps1"
        place.mkdir(parents=True)
        (place / "two.ipynb").write_bytes(released)
    pages = feedback.pages(large.course(), "ps1")
    assert next(pages) == large.folder / "feedback/s000/ps1/two.html"
    assert set(asked) == {50}
    assert len(list(pages)) == 69
    assert set(asked) == {50, 20}
    asked.clear()
    with large.course().gradebook() as book:
        feedback.sheet(book, "ps1", "s001", "two", large.folder / "autograded/s001/ps1")
    assert set(asked) == {1}
