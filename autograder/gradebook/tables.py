"""nbgrader's tables as SQLAlchemy Core describes them. A test holds them equal to nbgrader's models."""

from __future__ import annotations

from typing import Any

import sqlalchemy as sa

metadata = sa.MetaData()


def _table(name: str, *columns: sa.Column[Any] | sa.UniqueConstraint) -> sa.Table:
    return sa.Table(name, metadata, *columns)


def _id() -> sa.Column[str]:
    return sa.Column("id", sa.String(32), primary_key=True)


def _kind(name: str) -> sa.Enum:
    return sa.Enum("code", "markdown", name=name, validate_strings=True)


def _to(column: str) -> sa.ForeignKey:
    return sa.ForeignKey(column)


course = _table("course", sa.Column("id", sa.String(128), unique=True, primary_key=True, nullable=False))
assignment = _table(
    "assignment",
    _id(),
    sa.Column("name", sa.String(128), unique=True, nullable=False),
    sa.Column("duedate", sa.DateTime()),
    sa.Column("course_id", sa.String(128), _to("course.id"), nullable=False),
)
notebook = _table(
    "notebook",
    _id(),
    sa.Column("name", sa.String(128), nullable=False),
    sa.Column("assignment_id", sa.String(32), _to("assignment.id")),
    sa.Column("kernelspec", sa.String(1024)),
    sa.UniqueConstraint("name", "assignment_id"),
)
base_cell = _table(
    "base_cell",
    _id(),
    sa.Column("name", sa.String(128), nullable=False),
    sa.Column("notebook_id", sa.String(32), _to("notebook.id"), nullable=False),
    sa.Column("type", sa.String(50)),
    sa.UniqueConstraint("name", "notebook_id", "type"),
)
grade_cells = _table(
    "grade_cells",
    sa.Column("id", sa.String(32), _to("base_cell.id"), primary_key=True),
    sa.Column("max_score", sa.Float(), nullable=False),
    sa.Column("cell_type", _kind("grade_cell_type"), nullable=False),
)
solution_cells = _table("solution_cells", sa.Column("id", sa.String(32), _to("base_cell.id"), primary_key=True))
task_cells = _table(
    "task_cells",
    sa.Column("id", sa.String(32), _to("base_cell.id"), primary_key=True),
    sa.Column("max_score", sa.Float(), nullable=False),
    sa.Column("cell_type", _kind("grade_cell_type"), nullable=False),
)
source_cell = _table(
    "source_cell",
    _id(),
    sa.Column("name", sa.String(128), nullable=False),
    sa.Column("cell_type", _kind("source_cell_type"), nullable=False),
    sa.Column("locked", sa.Boolean(), nullable=False),
    sa.Column("source", sa.Text()),
    sa.Column("checksum", sa.String(128)),
    sa.Column("notebook_id", sa.String(32), _to("notebook.id")),
    sa.UniqueConstraint("name", "notebook_id"),
)
student = _table(
    "student",
    sa.Column("id", sa.String(128), primary_key=True, nullable=False),
    sa.Column("first_name", sa.String(128)),
    sa.Column("last_name", sa.String(128)),
    sa.Column("email", sa.String(128)),
    sa.Column("lms_user_id", sa.String(128)),
)
submitted_assignment = _table(
    "submitted_assignment",
    _id(),
    sa.Column("assignment_id", sa.String(32), _to("assignment.id")),
    sa.Column("student_id", sa.String(128), _to("student.id")),
    sa.Column("timestamp", sa.DateTime()),
    sa.Column("extension", sa.Interval()),
    sa.UniqueConstraint("assignment_id", "student_id"),
)
submitted_notebook = _table(
    "submitted_notebook",
    _id(),
    sa.Column("assignment_id", sa.String(32), _to("submitted_assignment.id")),
    sa.Column("notebook_id", sa.String(32), _to("notebook.id")),
    sa.Column("flagged", sa.Boolean()),
    sa.Column("late_submission_penalty", sa.Float(0)),
    sa.UniqueConstraint("notebook_id", "assignment_id"),
)
grade = _table(
    "grade",
    _id(),
    sa.Column("notebook_id", sa.String(32), _to("submitted_notebook.id")),
    sa.Column("cell_id", sa.String(32), _to("base_cell.id")),
    sa.Column("auto_score", sa.Float()),
    sa.Column("manual_score", sa.Float()),
    sa.Column("extra_credit", sa.Float()),
    sa.Column("needs_manual_grade", sa.Boolean(), nullable=False),
    sa.UniqueConstraint("cell_id", "notebook_id"),
)
comment = _table(
    "comment",
    _id(),
    sa.Column("notebook_id", sa.String(32), _to("submitted_notebook.id")),
    sa.Column("cell_id", sa.String(32), _to("base_cell.id")),
    sa.Column("auto_comment", sa.Text()),
    sa.Column("manual_comment", sa.Text()),
    sa.UniqueConstraint("cell_id", "notebook_id"),
)

score_of = sa.case(
    (grade.c.manual_score.is_not(None), grade.c.manual_score + sa.func.coalesce(grade.c.extra_credit, 0.0)),
    (grade.c.auto_score.is_not(None), grade.c.auto_score + sa.func.coalesce(grade.c.extra_credit, 0.0)),
    else_=0.0,
)
