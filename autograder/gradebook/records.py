"""What is read from the gradebook and what is written to it, as plain frozen values."""

from __future__ import annotations

import datetime
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from autograder.notebook.marks import Mark
from autograder.notebook.master import Master

Penalty = Callable[[str, float, float], float | None]


@dataclass(frozen=True)
class NotebookRow:
    """A notebook of an assignment: its row, the instructor's copy, and the ids of its cells by name."""

    id: str
    master: Master
    graded: Mapping[str, str]
    commented: Mapping[str, str]
    tasks: Mapping[str, str]


@dataclass(frozen=True)
class AssignmentRow:
    """An assignment with its notebooks by name."""

    id: str
    name: str
    duedate: datetime.datetime | None
    notebooks: Mapping[str, NotebookRow]


@dataclass(frozen=True)
class NotebookMarks:
    """What is written for one submitted notebook.

    ``marks`` of the graded cells that are there, by grade id; a graded cell that is not gets no mark and a manual look.
    ``unanswered`` names the solution cells that are as they were handed out. ``missing``: the notebook was not handed in,
    which is 0 without a look. ``broken``: it could not be read; no marks at all.
    """

    marks: Mapping[str, Mark] = field(default_factory=dict)
    unanswered: frozenset[str] = frozenset()
    missing: bool = False
    broken: bool = False


@dataclass(frozen=True)
class Record:
    """What is written for one submission. ``timestamp`` None leaves the one that is there."""

    student: str
    timestamp: datetime.datetime | None
    notebooks: Mapping[str, NotebookMarks]


@dataclass(frozen=True)
class Standing:
    """Where a submission stands after writing: its score with manual marks, its penalty, how late it was."""

    score: float
    penalty: float
    seconds_late: float
