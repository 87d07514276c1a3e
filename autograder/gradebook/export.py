"""The marks of an assignment as rows, and as CSV that a spreadsheet may open.

Spreadsheets take a cell that begins with ``=``, ``+``, ``-``, ``@``, a tab or a carriage return for a formula, and run it with
the rights of whoever opens the file. Names, ids and cell names come from outside, so a text that begins so gets an apostrophe
before it, which spreadsheets take for "text"; numbers stay numbers.

The gradebook is read fifty students at a time, and the rows are written one after the other: what is held of a large class is
a row each of its marks, a few hundred bytes.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TextIO

from autograder.gradebook.book import Gradebook
from autograder.gradebook.records import AssignmentRow

FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n")
BATCH = 50
Cell = str | float | None


@dataclass(frozen=True, slots=True)
class Marks:
    """One student's marks: points by column, None where there is no mark yet; ``open`` counts what waits for a person."""

    student: str
    name: str
    points: tuple[float | None, ...]
    open: int
    penalty: float

    @property
    def total(self) -> float:
        """All points less the penalty, never below 0, as nbgrader counts."""
        return max(sum(value for value in self.points if value is not None) - self.penalty, 0.0)


@dataclass(frozen=True)
class Sheet:
    """The marks of an assignment: its columns (notebook, cell, points available) and a row for each student who handed in."""

    assignment: str
    columns: tuple[tuple[str, str, float], ...]
    rows: tuple[Marks, ...]

    @property
    def available(self) -> float:
        """All points."""
        return sum(points for _, _, points in self.columns)


def sheet(book: Gradebook, assignment: str) -> Sheet:
    """The marks as they stand in the gradebook, by a person's hand where a person gave one.

    Raises
    ------
    CourseError
        If the gradebook has no such assignment.
    """
    row = book.assignment(assignment)
    columns = tuple(
        (name, cell.name, float(cell.points or 0.0))
        for name, notebook in sorted(row.notebooks.items())
        for cell in notebook.master.cells.values()
        if cell.grade or cell.task
    )
    return Sheet(assignment, columns, tuple(_rows(book, row, columns)))


def _rows(book: Gradebook, row: AssignmentRow, columns: Sequence[tuple[str, str, float]]) -> Iterator[Marks]:
    students = book.marked(row)
    for start in range(0, len(students), BATCH):
        some = students[start : start + BATCH]
        marks, penalties, names = book.read_marks(row, some), book.penalties(row, some), book.students(some)
        for student in some:
            yield _row(student, marks.get(student, {}), penalties, names, columns)


def _row(
    student: str,
    mine: dict[tuple[str, str], tuple[float | None, bool]],
    penalties: dict[tuple[str, str], float],
    names: dict[str, str],
    columns: Sequence[tuple[str, str, float]],
) -> Marks:
    found = [mine.get((notebook, cell), (None, True)) for notebook, cell, _ in columns]
    return Marks(
        student,
        names.get(student, ""),
        tuple(points for points, _ in found),
        sum(look or points is None for points, look in found),
        sum(points for (who, _), points in penalties.items() if who == student),
    )


def header(sheet: Sheet) -> list[str]:
    """Names of the columns: id, name, one for each graded cell, penalty, total, available, open."""
    several = len({notebook for notebook, _, _ in sheet.columns}) > 1
    names = [f"{notebook}/{cell}" if several else cell for notebook, cell, _ in sheet.columns]
    return ["student", "name", *names, "penalty", "total", "available", "open"]


def lines(sheet: Sheet) -> Iterator[list[Cell]]:
    """The rows under :func:`header`, one at a time."""
    available = sheet.available
    for mine in sheet.rows:
        yield [mine.student, mine.name, *mine.points, mine.penalty, mine.total, available, float(mine.open)]


def as_csv(sheet: Sheet) -> str:
    """The table as CSV (RFC 4180) in which no text can be a formula."""
    out = io.StringIO()
    write_csv(sheet, out)
    return out.getvalue()


def write_csv(sheet: Sheet, file: TextIO) -> None:
    """Write the same to a file that is open for text and leaves the ends of lines as they are."""
    writer = csv.writer(file, lineterminator="\r\n")
    writer.writerow([_written(name) for name in header(sheet)])
    writer.writerows([_written(cell) for cell in line] for line in lines(sheet))


def _written(cell: Cell) -> str:
    if cell is None:
        return ""
    if isinstance(cell, float):
        return f"{cell:.10g}"
    text = "".join(letter if letter.isprintable() or letter in "\t\r\n" else "\ufffd" for letter in cell)
    return f"'{text}" if text.lstrip(" ").startswith(FORMULA) else text
