"""Grades one submission: reads its folder, rebuilds and runs each notebook, and says what is to be written.

Nothing here writes to the course: the gradebook and ``autograded/`` come after, in batches.
"""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from autograder.course import Course
from autograder.errors import SubmissionError
from autograder.exercise import Exercise
from autograder.fleet.result import STRAY, CellReport, Status, StudentReport
from autograder.gradebook import NotebookMarks, Record
from autograder.notebook import limit, own
from autograder.notebook.apart import Apart, Script
from autograder.notebook.marks import Mark
from autograder.notebook.master import Master, MasterCell
from autograder.notebook.rebuild import Rebuilt, rebuild
from autograder.notebook.run import Ran, run
from autograder.notebook.score import annotate, marks, unanswered
from autograder.notebook.session import Opener
from autograder.notebook.submission import Submission, beside, digest, harmless, parse
from autograder.notebook.written import dumps


@dataclass(frozen=True)
class Rules:
    """The course's settings that decide how a notebook is rebuilt and what of its outputs is kept."""

    add_missing: bool
    missing_notification: str
    ignore_pattern: str
    output_limits: tuple[int, int]

    @classmethod
    def of(cls, course: Course) -> Rules:
        """Those of a course."""
        return cls(course.add_missing, course.missing_notification, course.ignore_pattern, course.output_limits)


@dataclass(frozen=True)
class Plan:
    """What all submissions of an assignment share. ``seed`` of the hidden data: student, exercise, digest of the notebook."""

    rules: Rules
    masters: Mapping[str, Master]
    instructor_files: Mapping[str, bytes]
    seed: Callable[[str, str, str], bytes] = field(repr=False)
    exercises: Callable[[str], Exercise | None]
    open_session: Opener
    scripts: Mapping[str, Script] = field(default_factory=dict)  # how ordinary test cells run, by notebook
    descriptors: frozenset[int] = frozenset()  # of open files that a worker process needs for this


@dataclass(frozen=True)
class Outcome:
    """A graded submission: what the gradebook gets, what ``autograded/`` gets, and the report.

    ``hurried``: something was stopped by the clock with CPU time left, so it is worth trying again when nothing else runs.
    """

    student: str
    record: Record
    files: Mapping[str, bytes]
    report: StudentReport
    digest: str
    hurried: bool = False


def grade_one(plan: Plan, student: str, submitted: Submission) -> Outcome:
    """Grade one submission.

    Raises
    ------
    SubmissionError
        If it cannot be dated (``timestamp.txt``); broken notebooks are told in the outcome.
    """
    started = time.monotonic()
    timestamp = submitted.handed_in
    work = _Work(plan, student, submitted)
    for name, master in plan.masters.items():
        work.grade(name, master)
    status: Status = "graded" if work.written else ("broken" if work.broken else "empty")
    report = StudentReport(
        student, status, tuple(work.cells), notes=tuple(work.notes), broken=tuple(work.broken), faults=tuple(work.faults),
        seconds=time.monotonic() - started, missing=tuple(work.missing),
    )  # fmt: skip
    files = {**work.files, **plan.instructor_files, **work.written} if work.written else {}
    return Outcome(student, Record(student, timestamp, work.marks), files, report, submitted.digest, work.hurried)


class _Work:
    """Collects over the notebooks of one submission."""

    def __init__(self, plan: Plan, student: str, submitted: Submission) -> None:
        self.plan, self.student, self.submitted = plan, student, submitted
        self.files = beside(submitted.others, plan.instructor_files)
        self.written: dict[str, bytes] = {}
        self.marks: dict[str, NotebookMarks] = {}
        self.cells: list[CellReport] = []
        self.notes = list(submitted.notes)
        self.broken: list[str] = []
        self.faults: list[str] = []
        self.missing: list[str] = []
        self.hurried = False
        unknown = sorted(path for path in submitted.files if path.endswith(".ipynb") and path[:-6] not in plan.masters)
        self.notes += [f"{path}: {STRAY}" for path in unknown]
        if not set(submitted.notebooks) & set(plan.masters):
            archives = sorted(path for path in submitted.files if path.lower().endswith(".zip"))
            self.notes += [f"{path}: an archive, not opened" for path in archives]

    def grade(self, name: str, master: Master) -> None:
        """Grade one notebook, or say why not."""
        rules = self.plan.rules
        data = self.submitted.notebooks.get(name)
        reason = self.submitted.left_out.get(f"{name}.ipynb")
        if data is None and reason is not None:  # too large, say: it was handed in, and somebody should know
            self._unread(name, master, reason)
            return
        if data is None:
            self.marks[name] = NotebookMarks(missing=True)
            self._report(name, master, dict.fromkeys(master.cells, Mark(0.0)))  # tasks too: there is nothing to look at
            self.notes.append(f"{name}.ipynb: not handed in")
            self.missing.append(name)
            return
        try:
            built = rebuild(parse(data), master, add_missing=rules.add_missing, missing=rules.missing_notification)
        except SubmissionError as error:
            self._unread(name, master, str(error))
            return
        ran = self._run(built, master, digest(data))
        self.hurried = self.hurried or ran.hurried
        limit.ignore_stderr(built.cells, rules.ignore_pattern)
        limit.limit_outputs(built.cells, *rules.output_limits)
        given = marks(built, ran)
        annotate(built, given)
        self.marks[name] = NotebookMarks(given, unanswered(built))
        self.notes += [f"{name}.ipynb: {note.cell + ': ' if note.cell else ''}{note.text}" for note in built.notes]
        posed = [found for cell in master.graded if cell.exercise and (found := self.plan.exercises(cell.exercise)) is not None]
        if (other := own.other_id(built.cells, posed, self.student)) is not None:
            self.notes.append(f"{name}.ipynb: {other}")
        if ran.restarts > 0:
            ended = "a cell ended its process" if ran.restarts == 1 else f"cells ended their process {ran.restarts} times"
            self.notes.append(f"{name}.ipynb: {ended}; the cells after it ran in a fresh one")
        self.faults += [f"{name}.ipynb: {fault}" for fault in ran.faults]
        self._report(name, master, given, built, ran)
        self.written[f"{name}.ipynb"] = dumps(built.notebook)

    def _unread(self, name: str, master: Master, reason: str) -> None:
        self.marks[name] = NotebookMarks(broken=True)
        self.broken.append(f"{name}.ipynb: {reason}")
        self._report(name, master, {})

    def _run(self, built: Rebuilt, master: Master, submission: str) -> Ran:
        def seed(exercise: str) -> bytes:
            return self.plan.seed(self.student, exercise, submission)

        files = {**self.files, **self.plan.instructor_files}
        script = self.plan.scripts.get(master.notebook)
        opener = self.plan.open_session
        apart = None
        if script is not None:
            kernel = functools.partial(opener.kernel, files, student=self.student)
            apart = Apart(script, lambda: opener.pair(files, self.student), kernel)
        ran = run(
            built,
            lambda: opener(files, self.student),
            own.of_student(self.plan.exercises, master, self.student),
            seed,
            uses_check=master.uses_check,
            apart=apart,
        )
        kept = {path: data for path, data in ran.files.items() if harmless(path) and path not in self.plan.instructor_files}
        self.files = beside(self.files, kept)
        self.files = beside({**self.files, **kept}, self.plan.instructor_files)
        return ran

    def _report(
        self, name: str, master: Master, given: Mapping[str, Mark], built: Rebuilt | None = None, ran: Ran | None = None
    ) -> None:
        runs = {}
        if built is not None and ran is not None:
            runs = {mine.name: how for mine, how in zip(built.masters, ran.cells, strict=True) if mine is not None}
        for cell in master.cells.values():
            if not cell.grade and not cell.task:
                continue
            mark = given.get(cell.name, Mark(None, look=True))
            how = runs.get(cell.name)
            fields: dict[str, Any] = {
                "notebook": name, "name": cell.name, "kind": _kind(cell), "points": mark.points,
                "available": float(cell.points or 0.0), "look": mark.look, "note": mark.note,
            }  # fmt: skip
            verdict = how.verdict if how is not None else None
            self.cells.append(CellReport(**fields) if verdict is None else CellReport.of_verdict(verdict, **fields))


def _kind(cell: MasterCell) -> Any:
    if cell.task:
        return "task"
    if cell.solution:
        return "written"
    return "exercise" if cell.exercise is not None else "test"
