"""Reads and writes the gradebook, a batch of submissions in one transaction.

The order in each transaction: course, student, submitted_assignment, submitted_notebook, grade, comment, each inserted only
where it is missing; then the automatic scores. Manual marks, extra credit and extensions are never touched, and
``needs_manual_grade`` is set in SQL from the manual mark as it stands, so that an instructor who is grading in formgrader at
the same moment loses nothing.
"""

from __future__ import annotations

import contextlib
import datetime
import importlib
import uuid
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import sqlalchemy as sa
from sqlalchemy.engine import Connection

from autograder.errors import CourseError
from autograder.gradebook import reading
from autograder.gradebook.engine import engine_of, parsed
from autograder.gradebook.reading import cell_of, graded, notebook_of, notebook_row
from autograder.gradebook.records import AssignmentRow, NotebookMarks, NotebookRow, Penalty, Record, Standing
from autograder.gradebook.tables import (
    assignment,
    comment,
    course,
    grade,
    notebook,
    score_of,
    student,
    submitted_assignment,
    submitted_notebook,
)
from autograder.messages import say
from autograder.notebook.marks import Mark

CHUNK = 400  # keys in one IN (...), well under SQLite's limit of variables
DEFAULT_COURSE = "default_course"


class Gradebook:
    """A connection to a gradebook that nbgrader made, in SQLite or PostgreSQL.

    Parameters
    ----------
    url : str
        As SQLAlchemy writes it: ``sqlite:///gradebook.db``, ``postgresql+psycopg://user@host/database``.

    Raises
    ------
    CourseError
        If there is no such database, it is not nbgrader's, or its kind is not offered.
    """

    def __init__(self, url: str) -> None:
        place = parsed(url)
        if place.get_backend_name() == "sqlite" and place.database and not Path(place.database).is_file():
            raise CourseError(f"there is no gradebook {place.database}; release an assignment first: directrix release A1")
        self.engine = engine_of(place)

    def close(self) -> None:
        """Close all connections."""
        self.engine.dispose()

    def __enter__(self) -> Gradebook:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    @contextlib.contextmanager
    def _begin(self) -> Iterator[Connection]:
        try:
            with self.engine.begin() as connection:
                yield connection
        except sa.exc.DBAPIError as error:
            raise CourseError(
                f"the gradebook cannot be used: {error.orig}; is it nbgrader's, is the disk full, does another program hold it?"
            ) from error

    def assignment(self, name: str) -> AssignmentRow:
        """An assignment with the instructor's copy of its notebooks.

        Raises
        ------
        CourseError
            If the gradebook has none of that name.
        """
        with self._begin() as connection:
            row = connection.execute(sa.select(assignment).where(assignment.c.name == name)).one_or_none()
            if row is None:
                known = connection.scalars(sa.select(assignment.c.name).order_by(assignment.c.name)).all()
                there = f"there are: {', '.join(known)}" if known else "there is none yet"
                near = [one for one in known if one.casefold() == name.strip(" /").casefold()]
                what = f"Did you mean {near[0]}?" if near else f"Release it first: directrix release {name}"
                raise CourseError(f"the gradebook has no assignment {name!r}; {there}. {what}")
            notebooks = connection.execute(
                sa.select(notebook).where(notebook.c.assignment_id == row.id).order_by(notebook.c.name)
            ).all()
            return AssignmentRow(row.id, row.name, row.duedate, {nb.name: notebook_row(connection, nb) for nb in notebooks})

    def add_course(self, course_id: str) -> None:
        """The rows of the course that nbgrader adds whenever it opens a gradebook."""
        with self._begin() as connection:
            for id in {DEFAULT_COURSE, course_id} - {""}:
                self._insert(connection, course, [{"id": id}])

    def students(self, only: Sequence[str] | None = None) -> dict[str, str]:
        """Full names by student id, empty where the gradebook has none; of all students, or only of these few hundred."""
        query = sa.select(student.c.id, student.c.first_name, student.c.last_name)
        with self._begin() as connection:
            rows = connection.execute(query if only is None else query.where(student.c.id.in_(only)))
            return {row.id: " ".join(filter(None, (row.first_name, row.last_name))) for row in rows}

    def write(
        self, of: AssignmentRow, records: Sequence[Record], *, penalty: Penalty | None = None, create_students: bool = True
    ) -> dict[str, Standing]:
        """Write a batch of submissions in one transaction; the standing of each student.

        Parameters
        ----------
        of : AssignmentRow
            From :meth:`assignment`.
        records : sequence of Record
            At most one per student.
        penalty : callable, optional
            nbgrader's late policy: (student, score, seconds late) -> points to take off, or None.
        create_students : bool
            nbgrader's ``Autograde.create_student``.
        """
        names = [record.student for record in records]
        with self._begin() as connection:
            if create_students:
                self._insert(connection, student, [{"id": name} for name in names])
            submissions = self._submissions(connection, of, records)
            notebooks = self._notebooks(connection, of, list(submissions.values()))
            self._cells(connection, of, notebooks)
            self._scores(connection, of, records, submissions, notebooks)
            taken: list[dict[str, Any]] = []
            ids = submissions, notebooks
            found = {record.student: _standing(connection, of, record, *ids, penalty, taken) for record in records}
            if taken:
                connection.execute(_PENALTY, taken)
            return found

    def marked(self, of: AssignmentRow) -> list[str]:
        """The students who have marks of an assignment, in order."""
        with self._begin() as connection:
            return sorted(connection.scalars(reading.marked(of)))

    def read_marks(
        self, of: AssignmentRow, only: Sequence[str] | None = None
    ) -> dict[str, dict[tuple[str, str], tuple[float | None, bool]]]:
        """Score and need of a manual look of every graded cell, by student and (notebook, cell); ``only`` of a few hundred."""
        kinds = {
            id: (nb.master.notebook, name) for nb in of.notebooks.values() for name, id in {**nb.graded, **nb.tasks}.items()
        }
        joined = grade.join(submitted_notebook, grade.c.notebook_id == submitted_notebook.c.id).join(
            submitted_assignment, submitted_notebook.c.assignment_id == submitted_assignment.c.id
        )
        marked = sa.case((grade.c.manual_score.is_(None) & grade.c.auto_score.is_(None), None), else_=score_of)
        query = (
            sa.select(submitted_assignment.c.student_id, grade.c.cell_id, marked.label("score"), grade.c.needs_manual_grade)
            .select_from(joined)
            .where(submitted_assignment.c.assignment_id == of.id)
        )
        if only is not None:
            handed_in = sa.select(submitted_assignment.c.id).where(
                submitted_assignment.c.assignment_id == of.id, submitted_assignment.c.student_id.in_(only)
            )
            mine = sa.select(submitted_notebook.c.id).where(submitted_notebook.c.assignment_id.in_(handed_in), notebook_of(of))
            query = query.where(grade.c.notebook_id.in_(mine), cell_of(of))
        found: dict[str, dict[tuple[str, str], tuple[float | None, bool]]] = {}
        with self._begin() as connection:
            for row in connection.execute(query):
                found.setdefault(row.student_id, {})[kinds[row.cell_id]] = (row.score, bool(row.needs_manual_grade))
        return found

    def standings(self, of: AssignmentRow, only: Sequence[str] | None = None) -> dict[str, Standing]:
        """The standing of every student who handed something in, or only of these few hundred."""
        mine = submitted_notebook.c.assignment_id == submitted_assignment.c.id, notebook_of(of)
        marked = grade.join(submitted_notebook, grade.c.notebook_id == submitted_notebook.c.id)
        score = sa.select(_sum(score_of)).select_from(marked).where(*mine, cell_of(of))
        penalty = sa.select(_sum(submitted_notebook.c.late_submission_penalty)).where(*mine)
        query = sa.select(
            submitted_assignment.c.student_id,
            submitted_assignment.c.timestamp,
            submitted_assignment.c.extension,
            score.scalar_subquery().label("score"),
            penalty.scalar_subquery().label("penalty"),
        ).where(submitted_assignment.c.assignment_id == of.id)
        if only is not None:
            query = query.where(submitted_assignment.c.student_id.in_(only))
        with self._begin() as connection:
            return {
                row.student_id: Standing(row.score, row.penalty, seconds_late(row.timestamp, of.duedate, row.extension))
                for row in connection.execute(query)
            }

    def penalties(self, of: AssignmentRow, only: Sequence[str] | None = None) -> dict[tuple[str, str], float]:
        """Points taken off for lateness, by (student, notebook); of all students, or only of these few hundred."""
        names = {row.id: name for name, row in of.notebooks.items()}
        with self._begin() as connection:
            rows = connection.execute(reading.penalties(of, only))
            return {(row.student_id, names[row.notebook_id]): row.late_submission_penalty or 0.0 for row in rows}

    def unmarked(self, of: AssignmentRow, name: str) -> set[str]:
        """The notebooks of a student of which some part has no mark by the grader; one that was not handed in has zeros."""
        names = {row.id: name for name, row in of.notebooks.items()}
        with self._begin() as connection:
            return {names[row.notebook_id] for row in connection.execute(reading.unmarked(of, name))}

    def comments(self, of: AssignmentRow, name: str) -> dict[tuple[str, str], str]:
        """The comment that a student reads, by (notebook, cell): the instructor's, else the automatic one."""
        kinds = {id: (nb.master.notebook, cell) for nb in of.notebooks.values() for cell, id in nb.commented.items()}
        shown = sa.func.coalesce(comment.c.manual_comment, comment.c.auto_comment)
        joined = comment.join(submitted_notebook, comment.c.notebook_id == submitted_notebook.c.id).join(
            submitted_assignment, submitted_notebook.c.assignment_id == submitted_assignment.c.id
        )
        query = (
            sa.select(comment.c.cell_id, shown.label("text"))
            .select_from(joined)
            .where(submitted_assignment.c.assignment_id == of.id, submitted_assignment.c.student_id == name)
            .where(comment.c.cell_id.in_(kinds), notebook_of(of))
        )
        with self._begin() as connection:
            return {kinds[row.cell_id]: row.text for row in connection.execute(query) if row.text}

    def _insert(self, connection: Connection, table: sa.Table, rows: Sequence[Mapping[str, Any]]) -> None:
        if rows:
            dialect = importlib.import_module(f"sqlalchemy.dialects.{self.engine.dialect.name}")  # loading both takes long
            connection.execute(dialect.insert(table).on_conflict_do_nothing(), rows)

    def _submissions(self, connection: Connection, of: AssignmentRow, records: Sequence[Record]) -> dict[str, str]:
        rows = [
            {"id": uuid.uuid4().hex, "assignment_id": of.id, "student_id": r.student, "timestamp": r.timestamp} for r in records
        ]
        self._insert(connection, submitted_assignment, rows)
        dated = [{"who": r.student, "when": r.timestamp} for r in records if r.timestamp is not None]
        if dated:
            mine = (submitted_assignment.c.assignment_id == of.id, submitted_assignment.c.student_id == sa.bindparam("who"))
            connection.execute(sa.update(submitted_assignment).where(*mine).values(timestamp=sa.bindparam("when")), dated)
        known = sa.select(submitted_assignment.c.student_id, submitted_assignment.c.id).where(
            submitted_assignment.c.assignment_id == of.id
        )
        return dict(_chunked(connection, known, submitted_assignment.c.student_id, [r.student for r in records]))

    def _notebooks(self, connection: Connection, of: AssignmentRow, submissions: list[str]) -> dict[tuple[str, str], str]:
        """Ids of submitted notebooks by (submission, notebook)."""
        rows = [
            {"id": uuid.uuid4().hex, "assignment_id": sub, "notebook_id": nb.id, "flagged": False}
            for sub in submissions
            for nb in of.notebooks.values()
        ]
        self._insert(connection, submitted_notebook, rows)
        columns = submitted_notebook.c
        known = sa.select(columns.assignment_id, columns.notebook_id, columns.id).where(notebook_of(of))
        return {(sub, nb): id for sub, nb, id in _chunked(connection, known, columns.assignment_id, submissions)}

    def _cells(self, connection: Connection, of: AssignmentRow, notebooks: Mapping[tuple[str, str], str]) -> None:
        rows = {nb.id: nb for nb in of.notebooks.values()}
        grades: list[dict[str, Any]] = []
        comments: list[dict[str, Any]] = []
        for (_, nb), id in notebooks.items():
            both = {**rows[nb].graded, **rows[nb].tasks}
            grades += [
                {"id": uuid.uuid4().hex, "notebook_id": id, "cell_id": cell, "needs_manual_grade": True}
                for cell in both.values()
            ]
            comments += [{"id": uuid.uuid4().hex, "notebook_id": id, "cell_id": cell} for cell in rows[nb].commented.values()]
        self._insert(connection, grade, grades)
        self._insert(connection, comment, comments)

    def _scores(
        self,
        connection: Connection,
        of: AssignmentRow,
        records: Sequence[Record],
        submissions: Mapping[str, str],
        notebooks: Mapping[tuple[str, str], str],
    ) -> None:
        scores: list[dict[str, Any]] = []
        comments: list[dict[str, Any]] = []
        for record in records:
            for name, given in record.notebooks.items():
                row = of.notebooks[name]
                place = notebooks[submissions[record.student], row.id]
                scores += [{"nb": place, "cell": cell, **values} for cell, values in _cell_scores(row, given)]
                if not given.missing:
                    texts = {cell: say("graded.no_response") if cell in given.unanswered else None for cell in row.commented}
                    comments += [{"nb": place, "cell": row.commented[cell], "text": text} for cell, text in texts.items()]
        if scores:
            connection.execute(_SCORE, scores)
        if comments:
            connection.execute(_COMMENT, comments)


def _sum(column: Any) -> sa.ColumnElement[float]:
    return sa.func.coalesce(sa.func.sum(column), 0.0)


# A bound number decides whether a person must look; a manual mark that stands asks for a look too, as in nbgrader.
_SCORE = (
    sa.update(grade)
    .where(grade.c.notebook_id == sa.bindparam("nb"), grade.c.cell_id == sa.bindparam("cell"))
    .values(
        auto_score=sa.bindparam("auto", type_=sa.Float()),
        needs_manual_grade=sa.case(
            (sa.bindparam("never", type_=sa.Boolean()), sa.false()),
            (sa.bindparam("look", type_=sa.Boolean()), sa.true()),
            else_=grade.c.manual_score.is_not(None),
        ),
    )
)
_COMMENT = (
    sa.update(comment)
    .where(comment.c.notebook_id == sa.bindparam("nb"), comment.c.cell_id == sa.bindparam("cell"))
    .values(auto_comment=sa.bindparam("text", type_=sa.Text()))
)


def _cell_scores(row: NotebookRow, given: NotebookMarks) -> Iterator[tuple[str, dict[str, Any]]]:
    if given.missing:
        for cell in (*row.graded.values(), *row.tasks.values()):
            yield cell, {"auto": 0.0, "look": False, "never": True}
        return
    for name, cell in row.graded.items():
        mark = given.marks.get(name, Mark(None, look=True))
        yield cell, {"auto": mark.points, "look": mark.look or mark.points is None, "never": False}
    for cell in row.tasks.values():  # a person's mark may be of an earlier submission, a zero of one without this notebook
        yield cell, {"auto": None, "look": True, "never": False}


_DATES = sa.select(submitted_assignment.c.timestamp, submitted_assignment.c.extension).where(
    submitted_assignment.c.id == sa.bindparam("submission")
)
_TOTAL = sa.select(_sum(score_of)).where(
    grade.c.notebook_id == sa.bindparam("nb"), grade.c.cell_id.in_(sa.bindparam("cells", expanding=True))
)
_TAKEN = sa.select(submitted_notebook.c.late_submission_penalty).where(submitted_notebook.c.id == sa.bindparam("nb"))
_PENALTY = (
    sa.update(submitted_notebook)
    .where(submitted_notebook.c.id == sa.bindparam("nb"))
    .values(late_submission_penalty=sa.bindparam("off"))
)


def _standing(
    connection: Connection,
    of: AssignmentRow,
    record: Record,
    submissions: Mapping[str, str],
    notebooks: Mapping[tuple[str, str], str],
    penalty: Penalty | None,
    taken_off: list[dict[str, Any]],
) -> Standing:
    """Where a student stands; what is taken off each notebook is added to ``taken_off``."""
    id = submissions[record.student]
    dates = connection.execute(_DATES, {"submission": id}).one()
    late = seconds_late(dates.timestamp, of.duedate, dates.extension)
    total = taken = 0.0
    for name, given in record.notebooks.items():
        place = notebooks[id, of.notebooks[name].id]
        score = float(connection.scalar(_TOTAL, {"nb": place, "cells": graded(of.notebooks[name])}) or 0.0)
        total += score
        if given.missing or given.broken:  # the policy is not asked; of what it took before, no more than there is now
            before = connection.scalar(_TAKEN, {"nb": place})
            if before is not None:
                taken += min(before, score)
                taken_off.append({"nb": place, "off": min(before, score)})
            continue
        off = penalty(record.student, score, late) if penalty is not None and late > 0 else None
        capped = None if off is None else min(max(float(off), 0.0), score)
        taken += capped or 0.0
        taken_off.append({"nb": place, "off": capped})
    return Standing(total, taken, late)


def seconds_late(
    handed_in: datetime.datetime | None, duedate: datetime.datetime | None, extension: datetime.timedelta | None
) -> float:
    """Seconds after the due date with its extension; 0 in time, or where there is no date."""
    if handed_in is None or duedate is None:
        return 0.0
    return max(0.0, (handed_in - duedate - (extension or datetime.timedelta())).total_seconds())


def _chunked(connection: Connection, query: Any, column: Any, keys: Sequence[str]) -> Iterable[Any]:
    for start in range(0, len(keys), CHUNK):
        yield from connection.execute(query.where(column.in_(keys[start : start + CHUNK])))
