"""Reads the instructor's copy of an assignment, and says in SQL what is asked of its marks."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any, cast

import sqlalchemy as sa
from sqlalchemy.engine import Connection

from autograder.gradebook.records import AssignmentRow, NotebookRow
from autograder.gradebook.tables import (
    base_cell,
    grade,
    grade_cells,
    source_cell,
    submitted_assignment,
    submitted_notebook,
    task_cells,
)
from autograder.notebook.master import CellType, Master, MasterCell


def notebook_row(connection: Connection, row: Any) -> NotebookRow:
    """The instructor's copy of a notebook, from the cells that nbgrader stored when the assignment was generated."""
    cells = connection.execute(
        sa.select(base_cell.c.id, base_cell.c.name, base_cell.c.type).where(base_cell.c.notebook_id == row.id)
    ).all()
    kinds = {kind: {c.name: c.id for c in cells if c.type == kind} for kind in ("GradeCell", "SolutionCell", "TaskCell")}
    points: dict[str, float] = {}
    for table in (grade_cells, task_cells):
        query = sa.select(base_cell.c.name, table.c.max_score).join(table, base_cell.c.id == table.c.id)
        points |= {cell.name: cell.max_score for cell in connection.execute(query.where(base_cell.c.notebook_id == row.id))}
    masters = {}
    for source in connection.execute(sa.select(source_cell).where(source_cell.c.notebook_id == row.id)):
        masters[source.name] = MasterCell(
            name=source.name,
            cell_type=cast(CellType, source.cell_type),
            source=source.source or "",
            checksum=source.checksum,
            locked=bool(source.locked),
            grade=source.name in kinds["GradeCell"],
            solution=source.name in kinds["SolutionCell"],
            task=source.name in kinds["TaskCell"],
            points=points.get(source.name),
        )
    kernel = _json_object(row.kernelspec)
    commented = {**kinds["SolutionCell"], **kinds["TaskCell"]}
    return NotebookRow(row.id, Master(row.name, masters, kernel), kinds["GradeCell"], commented, kinds["TaskCell"])


def _json_object(text: str | None) -> dict[str, Any]:
    try:
        value = json.loads(text or "{}")
    except ValueError:
        return {}
    return value if isinstance(value, dict) else {}


# nbgrader's indexes begin with the cell of a grade and the notebook of a submission: a query that names only what comes second
# reads a whole table, so these name the first too.
def graded(row: NotebookRow) -> list[str]:
    """Ids of the cells that have a grade."""
    return [*row.graded.values(), *row.tasks.values()]


def cell_of(of: AssignmentRow) -> sa.ColumnElement[bool]:
    """That a grade is one of an assignment."""
    return grade.c.cell_id.in_([id for row in of.notebooks.values() for id in graded(row)])


def notebook_of(of: AssignmentRow) -> sa.ColumnElement[bool]:
    """That a submitted notebook is one of an assignment."""
    return submitted_notebook.c.notebook_id.in_([row.id for row in of.notebooks.values()])


_OF_STUDENT = submitted_notebook.join(submitted_assignment, submitted_notebook.c.assignment_id == submitted_assignment.c.id)


def marked(of: AssignmentRow) -> sa.Select[tuple[str]]:
    """Who has marks of an assignment."""
    mine = submitted_notebook.c.assignment_id == submitted_assignment.c.id, notebook_of(of), cell_of(of)
    both = grade.join(submitted_notebook, grade.c.notebook_id == submitted_notebook.c.id)
    some = sa.exists(sa.select(grade.c.id).select_from(both).where(*mine))
    return sa.select(submitted_assignment.c.student_id).where(submitted_assignment.c.assignment_id == of.id, some)


def penalties(of: AssignmentRow, only: Sequence[str] | None) -> sa.Select[tuple[str, str, float | None]]:
    """Student, notebook, points taken off for lateness."""
    query = (
        sa.select(
            submitted_assignment.c.student_id, submitted_notebook.c.notebook_id, submitted_notebook.c.late_submission_penalty
        )
        .select_from(_OF_STUDENT)
        .where(submitted_assignment.c.assignment_id == of.id, notebook_of(of))
    )
    return query if only is None else query.where(submitted_assignment.c.student_id.in_(only))


def unmarked(of: AssignmentRow, student: str) -> sa.Select[tuple[str]]:
    """The notebooks of a student of which a part has no automatic score."""
    return (
        sa.select(submitted_notebook.c.notebook_id)
        .distinct()
        .select_from(grade.join(_OF_STUDENT, grade.c.notebook_id == submitted_notebook.c.id))
        .where(submitted_assignment.c.assignment_id == of.id, submitted_assignment.c.student_id == student)
        .where(grade.c.auto_score.is_(None), cell_of(of), notebook_of(of))
    )
