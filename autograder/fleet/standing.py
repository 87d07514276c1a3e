"""Reports as the gradebook has them: an instructor may have marked by hand since, or extended somebody's time."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from autograder.course import Course
from autograder.fleet.journal import Journal
from autograder.fleet.result import GradeReport, StudentReport
from autograder.fleet.spool import Spool
from autograder.gradebook import AssignmentRow, Standing

if TYPE_CHECKING:
    from autograder.gradebook import Gradebook  # which brings SQLAlchemy along

BATCH = 50


def standing(course: Course, assignment: str) -> GradeReport:
    """The class as it stands: what was graded, with the marks that are in the gradebook now. Nothing is graded or changed.

    A submission that is there and was not graded has the status "failed", and no faults.

    Raises
    ------
    CourseError
        If the assignment is not in the gradebook.
    """
    with course.gradebook() as book:
        row, journal = book.assignment(assignment), Journal(course.records, assignment)
        done = set(course.students("autograded", assignment))
        students = sorted(done.union(course.students("submitted", assignment)))
        found, level, posed = Spool(course.records), "", set[str]()
        for start in range(0, len(students), BATCH):
            entries = {student: journal.read(student) for student in students[start : start + BATCH]}
            reports = []
            for student, entry in entries.items():
                report = entry.report if entry is not None and student in done else StudentReport(student, "graded")
                reports.append(dataclasses.replace(report, status="graded" if student in done else "failed"))
                level = entry.level if entry is not None else level
                posed.update(cell.exercise for cell in report.cells if cell.exercise)
            for report in current(book, row, reports):
                found.add(report)
    titles = {name: exercise.title for name in posed if (exercise := course.exercise(name)) is not None}
    name = course.id or course.folder.name
    return GradeReport(name, assignment, level, found, 0.0, available(row), titles)


def available(row: AssignmentRow) -> float:
    """Points of the assignment."""
    return sum(float(cell.points or 0.0) for notebook in row.notebooks.values() for cell in notebook.master.cells.values())


def noted(row: AssignmentRow, report: StudentReport, standing: Standing) -> StudentReport:
    """A report with its standing."""
    return dataclasses.replace(
        report, score=standing.score, penalty=standing.penalty, seconds_late=standing.seconds_late, available=available(row)
    )


def current(book: Gradebook, row: AssignmentRow, reports: Sequence[StudentReport]) -> Iterator[StudentReport]:
    """A batch of reports with the marks, standings and names that are in the gradebook now."""
    students = [report.student for report in reports if report.student.isprintable()]  # no database is asked for other names
    marks, standings, names = book.read_marks(row, students), book.standings(row, students), book.students(students)
    for report in reports:
        full = _marked(report, marks.get(report.student, {}))
        if report.student in standings:
            full = noted(row, full, standings[report.student])
        yield dataclasses.replace(full, available=available(row), name=names.get(report.student, ""))


def _marked(report: StudentReport, marks: Mapping[tuple[str, str], tuple[float | None, bool]]) -> StudentReport:
    cells = []
    for cell in report.cells:
        points, look = marks.get((cell.notebook, cell.name), (cell.points, cell.look))
        cells.append(dataclasses.replace(cell, points=points, look=look))
    return dataclasses.replace(report, cells=tuple(cells))
