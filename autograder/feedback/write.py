"""Writes the feedback of an assignment from ``autograded/`` and the gradebook."""

from __future__ import annotations

import base64
import logging
import mimetypes
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path, PurePosixPath
from typing import Any
from urllib.parse import unquote

from autograder.course import Course
from autograder.errors import CourseError, SubmissionError
from autograder.feedback.hide import Hidden
from autograder.feedback.markdown import FindImage
from autograder.feedback.page import Absent, Scored, Sheet, render
from autograder.gradebook import AssignmentRow, Gradebook
from autograder.notebook.safe import IMAGES
from autograder.notebook.submission import parse, read_file
from autograder.whole import replaced

# nbgrader compares the first to know whether its feedback is up to date; to release feedback it needs the second too.
BESIDE = ("timestamp.txt", "submission_secret.txt")
MAX_GRADED = 200_000_000  # bytes of a graded notebook
log = logging.getLogger(__name__)
MAX_IMAGE, MAX_IMAGES = 4_000_000, 32_000_000  # bytes of one, of all on a page
BATCH = 50  # students whose marks are read at a time


def write(course: Course, assignment: str, students: Iterable[str] | None = None) -> list[Path]:
    """Write the pages of all graded submissions, or of these students'; pages that would not change are left alone.

    Returns the paths of all pages, in order.

    Raises
    ------
    CourseError
        If the assignment is unknown, nothing of it is graded, or a student is named who has nothing graded. Where somebody's
        pages cannot be written, all others are first.
    """
    return list(pages(course, assignment, students))


def pages(course: Course, assignment: str, students: Iterable[str] | None = None) -> Iterator[Path]:
    """Write the same pages one after the other, each as it is asked for; a large class takes no more memory than a small one.

    Raises
    ------
    CourseError
        As :func:`write`, when the first page is asked for; and after the last one, where somebody's could not be written.
    """
    graded = course.students("autograded", assignment)
    named = graded if students is None else list(dict.fromkeys(students))
    missing = set(named).difference(graded)
    if missing or not graded:
        who = ", ".join(student for student in named if student in missing) or "anybody"
        raise CourseError(f"nothing of {assignment} by {who} is graded yet; grade it first: directrix grade {assignment}")
    chosen = sorted(named)
    hidden = course_hidden(course)
    with course.gradebook() as book:
        row = book.assignment(assignment)
        failures = []
        for start in range(0, len(chosen), BATCH):
            some = chosen[start : start + BATCH]
            sheets = Sheets(book, row, some)
            for student in some:
                try:
                    yield from _student(course, row, sheets, student, hidden)
                except OSError:  # a full disk, say: it will fail for the others too
                    raise
                except CourseError as error:
                    failures.append(str(error))
                except Exception as error:
                    log.exception("the feedback of %s could not be written", student)
                    failures.append(f"{student}: {error!r}")
    if failures:
        raise CourseError("all feedback is written but for: " + "; ".join(failures))


def sheet(book: Gradebook, assignment: str, student: str, notebook: str, folder: Path) -> Sheet:
    """What the gradebook says of one notebook of one student, whose graded notebooks lie in a folder."""
    return Sheets(book, book.assignment(assignment), [student]).of(student, notebook, folder)


class Sheets:
    """The sheets of some students of an assignment, their marks read at once."""

    def __init__(self, book: Gradebook, row: AssignmentRow, students: Sequence[str]) -> None:
        self.book, self.row = book, row
        known = [student for student in students if student.isprintable()]  # no database is asked for other names
        self.marks, self.penalties = book.read_marks(row, known), book.penalties(row, known)
        self.names = book.students(known)

    def of(self, student: str, notebook: str, folder: Path) -> Sheet:
        """The sheet of one notebook of one student, whose graded notebooks lie in a folder."""
        cells = self._scored(student, notebook)
        comments = {name: text for (nb, name), text in self.book.comments(self.row, student).items() if nb == notebook}
        name = self.names.get(student) or student
        penalty = self.penalties.get((student, notebook), 0.0)
        return Sheet(notebook, self.row.name, name, cells, comments, penalty, self._absent(student, folder))

    def _scored(self, student: str, notebook: str) -> dict[str, Scored]:
        mine = self.marks.get(student, {})
        cells = {}
        for cell in self.row.notebooks[notebook].master.cells.values():
            if cell.grade or cell.task:
                points, look = mine.get((notebook, cell.name), (None, True))
                cells[cell.name] = Scored(points, float(cell.points or 0.0), look)
        return cells

    def _absent(self, student: str, folder: Path) -> list[Absent]:
        """The notebooks of the assignment that have no page."""
        names = [name for name in self.row.notebooks if not (folder / f"{name}.ipynb").is_file()]
        unread = self.book.unmarked(self.row, student) if names else ()
        found = []
        for name in names:
            alone = Sheet(name, self.row.name, student, self._scored(student, name))
            found.append(Absent(name, alone.score, alone.available, name in unread))
        return found


def course_hidden(course: Course) -> Hidden:
    """The markers of hidden tests and mark schemes, as the course sets them."""
    stock = Hidden()
    tests = [course.get("ClearHiddenTests", f"{end}_test_delimeter", stock.tests[i]) for i, end in enumerate(("begin", "end"))]
    scheme = [
        course.get("ClearMarkScheme", f"{end}_mark_scheme_delimeter", stock.scheme[i]) for i, end in enumerate(("begin", "end"))
    ]
    return Hidden((tests[0], tests[1]), (scheme[0], scheme[1]))


def images_of(folder: Path) -> FindImage:
    """Finds pictures below a folder: regular files of a kind that cannot hold a script, not through links.

    Each is written out where it is shown, so they may have so many bytes in all.
    """
    left = MAX_IMAGES

    def find(url: str) -> str | None:
        nonlocal left
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
            data = read_file(place / parts[-1], min(MAX_IMAGE, left)) if mime in IMAGES else b""
        except (SubmissionError, OSError, ValueError):
            return None
        left -= len(data)
        return f"data:{mime};base64,{base64.b64encode(data).decode('ascii')}" if data else None

    return find


def _student(course: Course, row: AssignmentRow, sheets: Sheets, student: str, hidden: Hidden) -> Iterator[Path]:
    folder, target = course.path("autograded", student, row.name), course.path("feedback", student, row.name)
    written = False
    for name in row.notebooks:
        source = folder / f"{name}.ipynb"
        page = target / f"{name}.html"
        if not source.is_file():
            page.unlink(missing_ok=True)  # of an earlier submission
            continue
        html = render(_read(source), sheets.of(student, name, folder), hidden=hidden, image=images_of(folder))
        _put(page, html.encode("utf-8", "replace"), course.permissions("GenerateFeedback"))
        written = True
        yield page
    for beside in BESIDE:
        if written and (folder / beside).is_file():
            _put(target / beside, read_file(folder / beside, 10_000), course.permissions("GenerateFeedback"))


def _read(path: Path) -> Mapping[str, Any]:
    try:
        return parse(read_file(path, MAX_GRADED), containers=MAX_GRADED)
    except SubmissionError as error:
        raise CourseError(f"{path} cannot be read: {error}; grade it again with --force") from None


def _put(path: Path, data: bytes, mode: int) -> None:
    """Write a file whole or not at all, and not where it is the same already."""
    if path.is_file() and path.read_bytes() == data:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    with replaced(path, mode) as file:
        file.write(data)
