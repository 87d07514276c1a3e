"""Reports as the gradebook has them: an instructor may have marked by hand since, or extended somebody's time."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping, Sequence

from autograder.fleet.result import StudentReport
from autograder.gradebook import AssignmentRow, Gradebook, Standing


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
