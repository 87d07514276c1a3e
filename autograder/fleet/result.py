"""What grading a class came to: plain frozen values that go to JSON."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal, TextIO

from autograder.result import Verdict

Kind = Literal["exercise", "test", "written", "task"]
Status = Literal["graded", "unchanged", "broken", "empty", "failed"]
STRAY = "not a notebook of this assignment, left out"  # how a note ends about a notebook under a name that was not released


@dataclass(frozen=True, slots=True)
class CellReport:
    """One graded cell of one student. ``points`` None: a person decides. ``verdict`` without its sampled surfaces."""

    notebook: str
    name: str
    kind: Kind
    points: float | None
    available: float
    look: bool = False
    note: str = ""
    exercise: str | None = None
    outcome: str | None = None
    tier: str | None = None
    mistake: str | None = None
    message: str = ""

    @classmethod
    def of_verdict(cls, verdict: Verdict, **fields: Any) -> CellReport:
        """A cell report with what its verdict says."""
        return cls(
            **fields, exercise=verdict.exercise, outcome=verdict.outcome, tier=verdict.tier, mistake=verdict.mistake,
            message=verdict.message,
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class StudentReport:
    """One submission.

    ``status``: graded now; unchanged since it was graded; broken (no notebook of it could be read); empty (no notebook handed
    in); failed (the grader could not do its part). ``missing`` names notebooks that were not handed in, ``broken`` what was
    wrong with the submission, ``faults`` what went wrong on the grader's side, ``notes`` what an instructor may want to know.
    """

    student: str
    status: Status
    cells: tuple[CellReport, ...] = ()
    score: float = 0.0
    available: float = 0.0
    penalty: float = 0.0
    seconds_late: float = 0.0
    notes: tuple[str, ...] = ()
    broken: tuple[str, ...] = ()
    faults: tuple[str, ...] = ()
    seconds: float = 0.0
    name: str = ""
    missing: tuple[str, ...] = ()

    @property
    def looks(self) -> int:
        """Cells that wait for a person."""
        return sum(cell.look or cell.points is None for cell in self.cells)

    def to_dict(self) -> dict[str, Any]:
        """Plain lists, dicts, strings and numbers."""
        return {**_fields(self), "cells": [_fields(cell) for cell in self.cells]}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> StudentReport:
        """The inverse of ``to_dict``, after JSON too."""
        cells = tuple(CellReport(**cell) for cell in data["cells"])
        lists = {key: tuple(data.get(key, ())) for key in ("notes", "broken", "faults", "missing")}
        return cls(**{**data, "cells": cells, **lists})


def _fields(report: CellReport | StudentReport) -> dict[str, Any]:
    """As ``dataclasses.asdict``, ten times as fast: what is in these fields need not be copied."""
    return {name: list(value) if isinstance(value := getattr(report, name), tuple) else value for name in report.__slots__}


@dataclass(frozen=True)
class GradeReport:
    """A class graded. Students in the order of their ids; those of a run lie on disk and are read whenever one asks for them.

    ``shared`` names the ordinary test cells that had to run in the learner's own process, where they could be tampered with,
    each with the reason; empty too when nothing was run.
    """

    course: str
    assignment: str
    level: str
    students: Sequence[StudentReport] = ()
    seconds: float = 0.0
    available: float = 0.0
    titles: Mapping[str, str] = field(default_factory=dict)
    shared: Mapping[str, str] = field(default_factory=dict)

    @property
    def graded(self) -> tuple[StudentReport, ...]:
        """Those graded in this run."""
        return tuple(student for student in self.students if student.status == "graded")

    @property
    def broken(self) -> tuple[str, ...]:
        """Submissions, or notebooks of them, that could not be read, by name."""
        return self._named[0]

    @property
    def faults(self) -> tuple[str, ...]:
        """What went wrong on the grader's side, by name: never a learner's failure, and tried again in the next run."""
        return self._named[1]

    @cached_property
    def _named(self) -> tuple[tuple[str, ...], tuple[str, ...]]:
        broken: list[str] = []
        faults: list[str] = []
        for student in self.students:
            broken += [f"{student.student}: {what}" for what in student.broken]
            faults += [f"{student.student}: {what}" for what in student.faults]
        return tuple(broken), tuple(faults)

    @property
    def failures(self) -> tuple[str, ...]:
        """Everything that failed and is named: broken submissions and the grader's own faults."""
        return self.broken + self.faults

    def student(self, id: str) -> StudentReport:
        """The report of one student."""
        return next(student for student in self.students if student.student == id)

    def to_dict(self) -> dict[str, Any]:
        """Plain lists, dicts, strings and numbers."""
        return {**self._of_class(), "students": [student.to_dict() for student in self.students]}

    def to_json(self, **options: Any) -> str:
        """Strict JSON (no NaN)."""
        return json.dumps(self.to_dict(), allow_nan=False, **options)

    def write_json(self, file: TextIO) -> None:
        """Write the same to a file, one student at a time."""
        file.write(json.dumps(self._of_class(), allow_nan=False)[:-1] + ', "students": [')
        for number, student in enumerate(self.students):
            file.write((", " if number else "") + json.dumps(student.to_dict(), allow_nan=False))
        file.write("]}\n")

    def _of_class(self) -> dict[str, Any]:
        return {
            "course": self.course, "assignment": self.assignment, "level": self.level, "seconds": self.seconds,
            "available": self.available, "titles": dict(self.titles), "shared": dict(self.shared),
            "failures": list(self.failures),
        }  # fmt: skip
