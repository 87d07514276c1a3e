"""Grades a class: worker processes over one sandbox, marks committed in batches, ``autograded/`` renamed into place last.

A worker reads, runs and judges whole submissions and lays their files out beside their place; this process hands out names,
commits batches and renames. Killed at any moment and started again, the gradebook is what one clean run gives: what is not
published is graded again, and the same bytes get the same marks. What is graded and unchanged is left alone.
"""

from __future__ import annotations

import contextlib
import dataclasses
import datetime
import functools
import hashlib
import importlib
import logging
import os
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from autograder.course import Course
from autograder.errors import CourseError, SubmissionError
from autograder.exercise import Exercise
from autograder.fleet import preparing, publish, standing
from autograder.fleet.journal import Entry, Journal, only_grader
from autograder.fleet.one import Outcome, Plan, Rules
from autograder.fleet.result import GradeReport, StudentReport
from autograder.fleet.spool import Spool
from autograder.fleet.task import Landed, Task, judged
from autograder.fleet.workers import Crew, Lost
from autograder.gradebook import NotebookMarks, Record
from autograder.notebook.secret import hidden_seed
from autograder.notebook.session import Begun, opened
from autograder.notebook.submission import NO_ID, PLAIN_ID, Submission, read_file, read_folder
from autograder.notebook.timestamps import FILE, handed_in

if TYPE_CHECKING:
    from distributed import Client

    from autograder.fleet.cluster import Cluster
    from autograder.gradebook import Gradebook

log = logging.getLogger(__name__)
BATCH = 50
BATCH_SECONDS = 2.0
OTHER_DATE = "the due date or an extension has changed since this was graded; --force takes the late penalty anew"
Progress = Callable[[int, int, str], None]


def grade(
    course: Course,
    assignment: str,
    *,
    students: Iterable[str] | None = None,
    progress: Progress | None = None,
    workers: int | None = None,
    force: bool = False,
    level: str | None = None,
    scheduler: str | Client | None = None,
) -> GradeReport:
    """Grade the submissions of an assignment.

    Parameters
    ----------
    course : Course
        The course; its gradebook must know the assignment.
    assignment : str
        nbgrader's name of it, ``A1``.
    students : iterable of str, optional
        Only these; default all who handed something in.
    progress : callable, optional
        Called with (number done, number in all, student) after each submission.
    workers : int, optional
        Submissions at a time; default one for each processor.
    force : bool
        Grade again what is graded and unchanged.
    level : str, optional
        Isolation level to require; default the course's, else A or A-, whichever the machine gives.
    scheduler : str or distributed.Client, optional
        A Dask cluster to grade on instead of this machine's processes: ``tls://host:port`` (``tcp://`` on this machine), or a
        client of one. This process reads submissions, writes the gradebook and ``autograded/``, as without.

    Raises
    ------
    CourseError
        If the assignment is not in the gradebook, a student has no submission, another grader is at work, or the cluster
        cannot be reached safely.
    IsolationError
        If this machine does not give the level.
    """
    started = time.monotonic()
    level = level or course.level
    with only_grader(course.room), contextlib.ExitStack() as stack:
        chosen = _chosen(course, assignment, students)
        begun = None
        if scheduler is None and (force or set(chosen).difference(course.students("autograded", assignment))):
            begun = stack.enter_context(preparing.begun(course, assignment, level))
        run = _Run(course, stack.enter_context(course.gradebook()), assignment, level, progress, begun)
        if scheduler is None:
            run.grade(chosen, workers or os.cpu_count() or 1, force=force)
        else:
            with importlib.import_module("autograder.fleet.connection").connected(scheduler) as client:
                run.grade(chosen, client, force=force)
        return run.report(time.monotonic() - started)


def _chosen(course: Course, assignment: str, students: Iterable[str] | None) -> list[str]:
    there = course.students("submitted", assignment)
    if students is None:
        return there
    wanted = set(students)
    unknown = sorted(wanted.difference(there))
    if unknown:
        place = course.path("submitted", "*", assignment)
        raise CourseError(f"no submission of {assignment} by {', '.join(unknown)}; looked in {place}")
    return sorted(wanted)


class _Run:
    """One grading run over one assignment."""

    def __init__(
        self, course: Course, book: Gradebook, assignment: str, level: str | None, progress: Progress | None,
        begun: Begun | None = None,
    ) -> None:  # fmt: skip
        self.course, self.book, self.required, self.progress = course, book, level, progress
        self.begun = begun
        self.level = level or ""  # of the sandbox, once one runs
        self.row = book.assignment(assignment)
        self.masters = course.masters(self.row)
        if not self.masters:
            raise CourseError(f"{assignment} has no notebook in the gradebook; release it: directrix release {assignment}")
        self.journal = Journal(course.room, assignment)
        self.penalty = course.penalty()
        self.version = hashlib.sha256("".join(master.digest for master in self.masters.values()).encode()).hexdigest()
        self.reports = Spool(course.room)  # as they come; their places by student
        self.done: dict[str, int] = {}
        self.waiting: list[Landed] = []
        self.committed = time.monotonic()
        self.total = 0
        self.shared: dict[str, str] = {}  # test cells that share the learner's process, with the reason

    def grade(self, students: Sequence[str], workers: int | Client, *, force: bool) -> None:
        """Grade what is new or changed, ``workers`` at a time."""
        self.total = len(students)
        for student in students:
            publish.clear(self._place(student))
        known = set(self.book.students()) if not self.course.create_students else None
        tasks: list[Task] = []
        for student in students:
            folder = self._folder(student)
            if not PLAIN_ID.fullmatch(student):
                self._settled(StudentReport(student, "broken", broken=(f"the name of its folder {NO_ID}; rename it",)))
            elif folder.parent.name == student and folder.parent.is_symlink():
                self._settled(StudentReport(student, "broken", broken=("the student's folder is a link to another folder",)))
            elif known is not None and student not in known:
                self._settled(StudentReport(student, "failed", faults=("no such student in the gradebook",)))
            elif not force and (unchanged := self._unchanged(student)) is not None:
                self._settled(unchanged)
            else:
                tasks.append(Task(student))
        if tasks:
            self.book.add_course(self.course.id)
            while tasks:
                with self._plan(shared=len(tasks) > 1) as plan:
                    if isinstance(workers, int):
                        plan, workers = preparing.fitted(plan, min(workers, len(tasks)))
                    tasks = self._work(plan, tasks, workers)

    def _work(self, plan: Plan, todo: list[Task], workers: int | Client) -> list[Task]:
        """Grade these; what is still to be done, since the sandbox itself was lost, is returned."""
        hurried: list[Task] = []
        gone: list[Task] = []
        with self._crew(plan, len(todo), workers) as crew:
            try:
                for done in crew.each(todo, BATCH_SECONDS):
                    if done is not None:
                        task, landed = done
                        if isinstance(landed, Lost):
                            self._land(Landed(task.student, fault=str(landed)))
                        elif landed.hurried:
                            hurried.append(dataclasses.replace(task, alone=True))
                        elif landed.failed and not task.again and not plan.open_session.box.alive:
                            gone.append(dataclasses.replace(task, again=True))
                            publish.clear(self._place(task.student))
                        else:
                            self._land(landed)
                    self._commit(full=False)
            finally:
                crew.close()
                for task in crew.unfinished:
                    publish.clear(self._place(task.student))
                self._commit(full=True)
        return gone + (self._work(plan, hurried, 1) if hurried else [])

    def _crew(self, plan: Plan, count: int, workers: int | Client) -> Crew[Task, Landed] | Cluster:
        """Who does the work: processes of this machine, or a Dask cluster, which sees no folder of the course."""
        if isinstance(workers, int):

            def work(task: Task, number: int) -> Landed:
                plan.open_session.box.ahead = count > 1
                read = self._read(task)
                return read if isinstance(read, Landed) else self._laid_out(judged(plan, task, read))

            return Crew(work, workers, plan.descriptors)
        module: Any = importlib.import_module("autograder.fleet.cluster")
        job = module.Job.of(self.course, self.row.name, plan, self._posed())
        return module.Cluster(workers, job, count, plan.seed, self._read, self._laid_out)  # type: ignore[no-any-return]

    def _folder(self, student: str) -> Path:
        return self.course.path("submitted", student, self.row.name)

    def _place(self, student: str) -> Path:
        return self.course.path("autograded", student, self.row.name)

    def _read(self, task: Task) -> Submission | Landed:
        try:
            return read_folder(self._folder(task.student), ignore=self.course.ignore, bounds=self.course.bounds)
        except SubmissionError as error:
            return Landed(task.student, broken=str(error))
        except OSError as error:
            return Landed(task.student, fault=f"the submission could not be read: {error.strerror or error}")

    def _laid_out(self, landed: Landed) -> Landed:
        """The files of a graded submission beside their place."""
        if landed.outcome is None or not landed.outcome.files:
            return landed
        staged, unwritten = None, ""
        try:
            staged = publish.stage(
                self._place(landed.student), landed.outcome.files, mode=self.course.permissions("Autograde"),
                groupshared=self.course.groupshared,
            )  # fmt: skip
        except OSError as error:  # a full disk, say: what is not published is graded again in the next run
            unwritten = f"the graded notebook could not be written: {error.strerror or error}"
        outcome = dataclasses.replace(landed.outcome, files={})
        return dataclasses.replace(landed, outcome=outcome, staged=staged, unwritten=unwritten)

    def _land(self, landed: Landed) -> None:
        if landed.fault:
            self._settled(StudentReport(landed.student, "failed", faults=(landed.fault,)))
            return
        if landed.outcome is None:
            report = StudentReport(landed.student, "broken", broken=(landed.broken,))
            landed = dataclasses.replace(landed, outcome=self._without(landed.student, report))
        assert landed.outcome is not None
        report = landed.outcome.report
        if report.status == "empty":
            if not self._place(landed.student).exists():
                self._settled(report)
                return
            report = dataclasses.replace(report, notes=(*report.notes, "what was graded before has been taken away: no marks"))
            landed = dataclasses.replace(landed, outcome=self._without(landed.student, report))
        self.waiting.append(landed)

    def _without(self, student: str, report: StudentReport) -> Outcome:
        """The outcome of a submission of which nothing can be read: no marks, not even those of an earlier one."""
        record = Record(student, None, {name: NotebookMarks(broken=True) for name in self.masters})
        return Outcome(student, record, {}, report, "")

    def _commit(self, *, full: bool) -> None:
        due = len(self.waiting) >= BATCH or time.monotonic() - self.committed > BATCH_SECONDS
        if not self.waiting or not (full or due):
            return
        batch, self.waiting = [self._begun(landed) for landed in self.waiting], []
        graded = [(landed, landed.outcome) for landed in batch if landed.outcome is not None]
        standings = self.book.write(
            self.row, [outcome.record for _, outcome in graded], penalty=self.penalty,
            create_students=self.course.create_students,
        )  # fmt: skip
        for landed, outcome in graded:
            report = standing.noted(self.row, outcome.report, standings[outcome.student])
            fault = landed.unwritten
            try:
                if not fault:
                    self._publish(outcome, landed.staged, report)
            except OSError as error:
                fault = f"the graded notebook could not be written: {error.strerror or error}"
            if fault:
                report = dataclasses.replace(report, status="failed", faults=(*report.faults, fault))
            self._settled(report)
        self.committed = time.monotonic()

    def _begun(self, landed: Landed) -> Landed:
        """Note that what lies in ``autograded/`` will not fit the marks until it is replaced; where that fails, no mark."""
        try:
            self.journal.begin(landed.student)
        except OSError as error:
            publish.clear(self._place(landed.student))
            fault = f"the journal could not be written: {error.strerror or error}"
            self._settled(StudentReport(landed.student, "failed", faults=(fault,)))
            return dataclasses.replace(landed, outcome=None)
        return landed

    def _publish(self, outcome: Outcome, staged: Path | None, report: StudentReport) -> None:
        place = self._place(outcome.student)
        if staged is not None:
            publish.publish(staged, place)
            self.journal.write(outcome.student, Entry(outcome.digest, self.version, self.level, report))
        elif place.exists():
            publish.withdraw(place)  # an earlier submission's; nbgrader removes it too when the new one fails

    def _settled(self, report: StudentReport) -> None:
        self.done[report.student] = self.reports.add(report)
        if self.progress is not None:
            self.progress(len(self.done), self.total, report.student)

    def _unchanged(self, student: str) -> StudentReport | None:
        """The earlier report of a submission that needs no grading: nbgrader's rule, and the same bytes as then."""
        place = self._place(student)
        if not place.is_dir():
            return None
        try:
            submitted = read_folder(self._folder(student), ignore=self.course.ignore, bounds=self.course.bounds)
            then, now = _timestamp(place), submitted.handed_in
        except (SubmissionError, OSError):  # who grades it says why
            return None
        entry = self.journal.read(student)
        if entry is None and self.journal.begun(student):  # a grader was ended before it had replaced what lies there
            return None
        newer = then is not None and now is not None and now > then
        if newer or (entry is not None and (entry.submission != submitted.digest or entry.report.faults)):
            return None
        report = entry.report if entry is not None else StudentReport(student, "unchanged")
        notes = report.notes
        if entry is not None and entry.masters != self.version:
            notes = (*notes, "the instructor's copy has changed since this was graded; --force grades it again")
        return dataclasses.replace(report, status="unchanged", notes=notes)

    @contextlib.contextmanager
    def _plan(self, *, shared: bool = True) -> Iterator[Plan]:
        """``shared``: by several submissions, one of which will need what takes long to load; one alone may not."""
        course, exercises = self.course, self._posed()
        loading = threading.Thread(target=preparing.load_searching, daemon=True)
        if exercises and shared:
            loading.start()
        draws = any(master.draws for master in self.masters.values())
        with opened(
            exercises.values(), course.packages, self.required, course.timeout, course.withhold, draws=draws, begun=self.begun,
            given=course.given(self.row.name, self.masters),
        ) as open_session:  # fmt: skip
            self.level = open_session.level
            preparing.remember(course, self.row.name, open_session)
            if exercises and shared:
                loading.join()
            scripts = course.scripts(self.row, self.masters, open_session)
            self.shared = {f"{name}.ipynb: {cell}": why for name in scripts for cell, why in scripts[name].shared.items()}
            yield Plan(
                Rules.of(course), self.masters, course.instructor_files(self.row.name),
                functools.partial(hidden_seed, course.secret()), exercises.get, open_session, scripts,
                frozenset({open_session.box.descriptor}),
            )  # fmt: skip

    def _posed(self) -> dict[str, Exercise]:
        """The exercises of this assignment, by name, in their order."""
        checked = [cell.exercise for master in self.masters.values() for cell in master.graded if cell.exercise]
        return {name: found for name in checked if (found := self.course.exercise(name)) is not None}

    def report(self, seconds: float) -> GradeReport:
        """The class as it stands in the gradebook, manual marks included."""
        found, order = Spool(self.course.room), sorted(self.done)
        for start in range(0, len(order), BATCH):
            reports = [self.reports[self.done[student]] for student in order[start : start + BATCH]]
            for then, now in zip(reports, standing.current(self.book, self.row, reports), strict=True):
                found.add(dataclasses.replace(now, notes=(*now.notes, OTHER_DATE)) if self._other_date(then, now) else now)
        titles = {exercise.id: exercise.title for exercise in self._posed().values()}
        course = self.course.id or self.course.folder.name
        available = standing.available(self.row)
        return GradeReport(course, self.row.name, self.level, found, seconds, available, titles, self.shared)

    def _other_date(self, then: StudentReport, now: StudentReport) -> bool:
        """Whether a penalty hangs on a date that is another since the submission was graded."""
        return self.penalty is not None and bool(then.cells) and then.seconds_late != now.seconds_late


def _timestamp(place: Path) -> datetime.datetime | None:
    try:
        return handed_in({FILE: read_file(place / FILE, 1000)})
    except (SubmissionError, OSError):
        return None
