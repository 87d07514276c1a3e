"""The sample class that ``directrix demo`` submits, grades and holds to what its honest content is worth.

``cohort("A1")`` are its members; ``submit`` hands in for all of them; ``surprises`` compares a finished grading with what each
member's honest content earns. Everything is made from text snippets in this package, the same every time.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Protocol

import nbformat

from autograder.catalogue import shipped
from autograder.demo.member import Member
from autograder.demo.roll import enrol

__all__ = ["Member", "cohort", "submit", "submit_one", "surprises"]
ROUNDING = 1e-6  # points


class Folders(Protocol):
    """Where a course keeps things."""

    def path(self, step: str, student: str, assignment: str) -> Path:
        """The folder of a step (``submitted``) for a student and an assignment."""


class Cell(Protocol):
    """A graded cell in a grading's report."""

    @property
    def name(self) -> str: ...
    @property
    def points(self) -> float | None: ...
    @property
    def available(self) -> float: ...
    @property
    def look(self) -> bool: ...
    @property
    def mistake(self) -> str | None: ...


def cohort(name: str) -> list[Member]:
    """The class of a shipped assignment (``A1``, ``known-forms``), in the order of their ids."""
    return enrol(shipped().assignment(name))


def submit(released: Path, course: Folders, name: str) -> list[Member]:
    """Hand in the whole class's notebooks, made from the released one, into the course's ``submitted`` folder."""
    members = cohort(name)
    for member in members:
        submit_one(member, released, course, name)
    return members


def submit_one(member: Member, released: Path, course: Folders, name: str, *, student_id: str | None = None) -> Path:
    """Hand in one member's notebook and return its folder. ``student_id``: under another name than the member's."""
    folder = course.path("submitted", student_id or member.student_id, name)
    notebook = nbformat.read(released, as_version=nbformat.NO_CONVERT)  # type: ignore[no-untyped-call]
    member.write(notebook, folder)
    return folder


def surprises(name: str, graded: Any) -> list[str]:
    """Every way in which a grading of the class (a ``fleet.GradeReport``) is not what the honest content earns."""
    reports = {report.student: report for report in graded.students}
    found = []
    for member in cohort(name):
        report = reports.get(member.student_id)
        if report is None:
            found.append(f"{member.student_id}: is not in the report")
        elif member.expected is None:
            if not report.broken:
                found.append(f"{member.student_id}: cannot be read, and is not named as broken")
        else:
            found += [f"{member.student_id}, {what}" for what in _differences(member, report.cells)]
    return found


def _differences(member: Member, cells: Sequence[Cell]) -> list[str]:
    by_name = {cell.name: cell for cell in cells}
    found = []
    for id, share in (member.expected or {}).items():
        cell = by_name.get(f"check_{id}")
        points = None if cell is None else cell.points
        if share is None or cell is None:
            if share is not None or points is not None:
                found.append(f"{id}: {_told(share, 1.0)} expected, {_told(points, 1.0)} given")
            continue
        if points is None or abs(points - share * cell.available) > ROUNDING:
            found.append(f"{id}: {_told(share, cell.available)} expected, {_told(points, 1.0)} given")
        if id in member.mistakes and cell.mistake != member.mistakes[id]:
            found.append(f"{id}: the mistake {member.mistakes[id]} was not named; told {cell.mistake}")
        if id in member.flagged and not cell.look:
            found.append(f"{id}: no manual look is asked for")
    return found


def _told(share: float | None, available: float) -> str:
    return "no mark" if share is None else f"{share * available:g} points"
