"""Reads an assignment, its instructor's copy and its marks."""

from __future__ import annotations

import json
from typing import Any, cast

import sqlalchemy as sa
from sqlalchemy.engine import Connection

from autograder.gradebook.records import NotebookRow
from autograder.gradebook.tables import base_cell, grade_cells, source_cell, task_cells
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
