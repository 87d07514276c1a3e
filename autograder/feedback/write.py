"""Writes the feedback of an assignment from ``autograded/`` and the gradebook."""

from __future__ import annotations

import base64
import mimetypes
import os
import secrets
from collections.abc import Iterable, Mapping
from pathlib import Path, PurePosixPath
from typing import Any
from urllib.parse import unquote

from autograder.course import Course
from autograder.errors import CourseError, SubmissionError
from autograder.feedback.hide import Hidden
from autograder.feedback.markdown import FindImage
from autograder.feedback.page import Scored, Sheet, render
from autograder.gradebook import AssignmentRow, Gradebook
from autograder.notebook.safe import IMAGES
from autograder.notebook.submission import parse, read_file

TIMESTAMP = "timestamp.txt"
MAX_IMAGE = 4_000_000


def write(course: Course, assignment: str, students: Iterable[str] | None = None) -> list[Path]:
    """Write the pages of all graded submissions, or of these students'; pages that would not change are left alone.

    Returns the paths of all pages, in order.

    Raises
    ------
    CourseError
        If the assignment is unknown, nothing of it is graded, or a student is named who has nothing graded.
    """
    wanted = None if students is None else list(students)
    graded = course.graded(assignment)
    missing = [student for student in wanted or () if student not in graded]
    if missing or not graded:
        who = ", ".join(missing) or "anybody"
        raise CourseError(f"nothing of {assignment} by {who} is graded yet; grade it first: directrix grade {assignment}")
    pages = []
    hidden = course_hidden(course)
    with course.gradebook() as book:
        row = book.assignment(assignment)
        sheets = Sheets(book, row)
        for student, folder in graded.items():
            if wanted is None or student in wanted:
                pages += _student(course, row, sheets, student, folder, hidden)
    return pages


def sheet(book: Gradebook, assignment: str, student: str, notebook: str) -> Sheet:
    """What the gradebook says of one notebook of one student."""
    return Sheets(book, book.assignment(assignment)).of(student, notebook)


class Sheets:
    """The sheets of an assignment, its marks read once."""

    def __init__(self, book: Gradebook, row: AssignmentRow) -> None:
        self.book, self.row = book, row
        self.marks, self.penalties, self.names = book.read_marks(row), book.penalties(row), book.students()

    def of(self, student: str, notebook: str) -> Sheet:
        """The sheet of one notebook of one student."""
        master = self.row.notebooks[notebook].master
        mine = self.marks.get(student, {})
        cells = {}
        for cell in master.cells.values():
            if cell.grade or cell.task:
                points, look = mine.get((notebook, cell.name), (None, True))
                cells[cell.name] = Scored(points, float(cell.points or 0.0), look)
        comments = {name: text for (nb, name), text in self.book.comments(self.row, student).items() if nb == notebook}
        name = self.names.get(student) or student
        return Sheet(notebook, self.row.name, name, cells, comments, self.penalties.get((student, notebook), 0.0))


def course_hidden(course: Course) -> Hidden:
    """The markers of hidden tests and mark schemes, as the course sets them."""
    stock = Hidden()
    tests = [course.get("ClearHiddenTests", f"{end}_test_delimeter", stock.tests[i]) for i, end in enumerate(("begin", "end"))]
    scheme = [
        course.get("ClearMarkScheme", f"{end}_mark_scheme_delimeter", stock.scheme[i]) for i, end in enumerate(("begin", "end"))
    ]
    return Hidden((tests[0], tests[1]), (scheme[0], scheme[1]))


def images_of(folder: Path) -> FindImage:
    """Finds pictures below a folder: regular files of a kind that cannot hold a script, not through links."""

    def find(url: str) -> str | None:
        parts = PurePosixPath(unquote(url.partition("?")[0].partition("#")[0])).parts
        if not parts or ".." in parts or parts[0] == "/" or any(":" in part for part in parts):
            return None
        mime = mimetypes.guess_type(parts[-1])[0] or ""
        place = folder
        for part in parts[:-1]:
            place /= part
            if place.is_symlink():
                return None
        try:
            data = read_file(place / parts[-1], MAX_IMAGE)
        except (SubmissionError, OSError, ValueError):
            return None
        return f"data:{mime};base64,{base64.b64encode(data).decode('ascii')}" if mime in IMAGES else None

    return find


def _student(course: Course, row: AssignmentRow, sheets: Sheets, student: str, folder: Path, hidden: Hidden) -> list[Path]:
    target = course.path("feedback", student, row.name)
    pages = []
    for name in row.notebooks:
        source = folder / f"{name}.ipynb"
        if not source.is_file():
            continue
        html = render(_read(source), sheets.of(student, name), hidden=hidden, image=images_of(folder))
        page = target / f"{name}.html"
        _put(page, html.encode("utf-8", "replace"), course.permissions("GenerateFeedback"))
        pages.append(page)
    stamp = folder / TIMESTAMP
    if pages and stamp.is_file():  # nbgrader compares it to know whether its feedback is up to date
        _put(target / TIMESTAMP, read_file(stamp, 10_000), course.permissions("GenerateFeedback"))
    return pages


def _read(path: Path) -> Mapping[str, Any]:
    try:
        return parse(read_file(path, 200_000_000))
    except SubmissionError as error:
        raise CourseError(f"{path} cannot be read: {error}; grade it again with --force") from None


def _put(path: Path, data: bytes, mode: int) -> None:
    """Write a file whole or not at all, and not where it is the same already."""
    if path.is_file() and path.read_bytes() == data:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_name(f".{path.name}.{secrets.token_hex(4)}")
    new.write_bytes(data)
    new.chmod(mode)
    os.replace(new, path)
