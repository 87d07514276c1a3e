"""Marks as CSV: what a spreadsheet reads is what the gradebook says, and no name is a formula."""

import csv
import io
import json
import sqlite3
import subprocess
import sys
from contextlib import closing

import pytest

from autograder import fleet
from autograder.gradebook.export import Marks, Sheet, as_csv

COLUMNS = (("one", "check_cylinder", 4.0), ("one", "why", 2.5))


def read(text):
    return list(csv.reader(io.StringIO(text, newline="")))


@pytest.mark.parametrize(
    ("name", "written"),
    [
        ('=HYPERLINK("http://x";"y")', '\'=HYPERLINK("http://x";"y")'),
        ("+1", "'+1"),
        ("-2+3", "'-2+3"),
        ("@SUM(A1)", "'@SUM(A1)"),
        ("\t=1", "'\t=1"),
        ("\r=1", "'\r=1"),
        ("  =1", "'  =1"),
        ("a,b\nc", "a,b\nc"),
        ('Ann "Bo" O\'Hara', 'Ann "Bo" O\'Hara'),
        ("x=1", "x=1"),
        ("\x1b[31mred\ud800", "�[31mred�"),
    ],
)
def test_no_text_is_a_formula_and_numbers_stay_numbers(name, written):
    """The same for ids and for names; a harmless name is as it was. A negative number is a number."""
    for row in (Marks(name, "", (4.0, -0.5), 0, 0.25), Marks("ada", name, (4.0, -0.5), 0, 0.25)):
        header, line = read(as_csv(Sheet("A1", COLUMNS, (row,))))
        assert written in line[:2]
        assert line[2:] == ["4", "-0.5", "0.25", "3.25", "6.5", "0"]
    assert header == ["student", "name", "check_cylinder", "why", "penalty", "total", "available", "open"]
    as_csv(Sheet("A1", COLUMNS, (row,))).encode("utf-8")


def test_cells_of_several_notebooks_are_told_apart_and_formulas_in_the_header_too():
    """Column names come from notebooks."""
    sheet = Sheet("A1", (("=one", "q", 1.0), ("two", "q", 1.0)), ())
    assert read(as_csv(sheet))[0][2:4] == ["'=one/q", "two/q"]


def test_the_command_writes_what_the_gradebook_says(ordinary):
    """Marks of the grader and by hand, a penalty, an open cell, hostile names; JSON, table and CSV agree."""
    ordinary.hand_in("ada", {"one": {"square": "def square(x):\n    return x * x"}, "two": {}})
    fleet.grade(ordinary.course(), "ps1")
    with closing(sqlite3.connect(ordinary.folder / "gradebook.db")) as book, book:
        book.execute("update student set first_name = '=cmd|x', last_name = '\x1b[31m[bold]A[/bold]' where id = 'ada'")
        book.execute("update submitted_notebook set late_submission_penalty = 0.25")
        book.execute(
            "update grade set manual_score = 3.5 where cell_id = (select id from base_cell where name = 'why' limit 1)"
        )
    command = [sys.executable, "-m", "autograder", "marks", "ps1", "--json", "--csv", "marks.csv"]
    ran = subprocess.run(command, cwd=ordinary.folder, capture_output=True, text=True, timeout=120)
    assert ran.returncode == 0, ran.stderr
    (mine,) = json.loads(ran.stdout)["rows"]
    assert (mine["student"], mine["one/test_square"], mine["one/why"], mine["penalty"]) == ("ada", 2.0, 3.5, 0.5)
    assert mine["total"] == sum(value or 0.0 for name, value in mine.items() if "/" in name) - 0.5
    header, line = read((ordinary.folder / "marks.csv").read_bytes().decode("utf-8"))
    written = dict(zip(header, line, strict=True))
    assert written["name"] == "'=cmd|x �[31m[bold]A[/bold]"
    assert {name: float(written[name]) for name in ("one/test_square", "one/why", "penalty", "total")} == {
        name: mine[name] for name in ("one/test_square", "one/why", "penalty", "total")
    }
    again = [sys.executable, "-m", "autograder", "export", "ps1"]
    subprocess.run(again, cwd=ordinary.folder, check=True, capture_output=True, timeout=120)
    assert (ordinary.folder / "marks-ps1.csv").read_bytes() == (ordinary.folder / "marks.csv").read_bytes()
    assert "\x1b" not in ran.stderr
    assert "[bold]A[/bold]" in ran.stderr.replace("\n", "")
