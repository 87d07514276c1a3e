"""Grades a class: a thread pool over one sandbox, marks committed in batches, ``autograded/`` renamed into place last.

Killed at any moment and started again, the gradebook is what one clean run gives: what is not published is graded again, and
the same bytes get the same marks. What is graded and unchanged is left alone.
"""

from __future__ import annotations

import contextlib
import dataclasses
import datetime
import hashlib
import logging
import os
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from pathlib import Path

from autograder.course import Course
from autograder.errors import CourseError, SandboxError, SubmissionError
from autograder.exercise import Exercise
from autograder.fleet import publish
from autograder.fleet.journal import Entry, Journal, only_grader
from autograder.fleet.one import Outcome, Plan, grade_one
from autograder.fleet.result import GradeReport, StudentReport
from autograder.gradebook import Gradebook, NotebookMarks, Record, Standing
from autograder.notebook.session import opened
from autograder.notebook.submission import PLAIN_ID, read_file, read_folder
from autograder.notebook.timestamps import FILE, handed_in

log = logging.getLogger(__name__)
BATCH = 50
BATCH_SECONDS = 2.0
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

    Raises
    ------
    CourseError
        If the assignment is not in the gradebook, a student has no submission, or another grader is at work.
    IsolationError
        If this machine does not give the level.
    """
    started = time.monotonic()
    with only_grader(course.room), course.gradebook() as book:
        run = _Run(course, book, assignment, level or course.level, progress)
        run.grade(_chosen(course, assignment, students), workers or os.cpu_count() or 1, force=force)
        return run.report(time.monotonic() - started)


def _chosen(course: Course, assignment: str, students: Iterable[str] | None) -> dict[str, Path]:
    there = course.submissions(assignment)
    if students is None:
        return there
    wanted = list(dict.fromkeys(students))
    unknown = [student for student in wanted if student not in there]
    if unknown:
        place = course.path("submitted", "*", assignment)
        raise CourseError(f"no submission of {assignment} by {', '.join(unknown)}; looked in {place}")
    return {student: there[student] for student in sorted(wanted)}


class _Run:
    """One grading run over one assignment."""

    def __init__(self, course: Course, book: Gradebook, assignment: str, level: str | None, progress: Progress | None) -> None:
        self.course, self.book, self.required, self.progress = course, book, level, progress
        self.level = level or ""  # of the sandbox, once one runs
        self.row = book.assignment(assignment)
        self.masters = course.masters(self.row)
        if not self.masters:
            raise CourseError(f"{assignment} has no notebook in the gradebook; release it: directrix release {assignment}")
        self.journal = Journal(course.room, assignment)
        self.penalty = course.penalty()
        self.version = hashlib.sha256("".join(master.digest for master in self.masters.values()).encode()).hexdigest()
        self.done: dict[str, StudentReport] = {}
        self.waiting: list[Outcome] = []
        self.committed = time.monotonic()
        self.total = 0

    def grade(self, submissions: Mapping[str, Path], workers: int, *, force: bool) -> None:
        """Grade what is new or changed, ``workers`` at a time."""
        self.total = len(submissions)
        known = set(self.book.students()) if not self.course.create_students else None
        todo: dict[str, Path] = {}
        for student, folder in submissions.items():
            if not PLAIN_ID.fullmatch(student):
                self._settled(StudentReport(student, "broken", broken=("the name of its folder is no student's id",)))
            elif folder.parent.name == student and folder.parent.is_symlink():
                self._settled(StudentReport(student, "broken", broken=("the student's folder is a link to another folder",)))
            elif known is not None and student not in known:
                self._settled(StudentReport(student, "failed", faults=("no such student in the gradebook",)))
            elif not force and (unchanged := self._unchanged(student, folder)) is not None:
                self._settled(unchanged)
            else:
                todo[student] = folder
        if todo:
            self.book.add_course(self.course.id)
            with self._plan() as plan, ThreadPoolExecutor(workers, "grader") as pool:
                self._work(plan, pool, todo, 2 * workers)

    def _work(self, plan: Plan, pool: ThreadPoolExecutor, todo: Mapping[str, Path], most: int) -> None:
        """Keep a bounded number of submissions in flight, so that memory does not grow with the class."""
        queue = iter(todo.items())
        flying: dict[Future[Outcome], str] = {}
        try:
            while True:
                for student, folder in queue:
                    flying[pool.submit(self._one, plan, student, folder)] = student
                    if len(flying) >= most:
                        break
                if not flying:
                    break
                landed, _ = wait(flying, timeout=BATCH_SECONDS, return_when=FIRST_COMPLETED)
                for future in landed:
                    self._land(flying.pop(future), future)
                self._commit(full=False)
        finally:
            for future in flying:
                future.cancel()
            self._commit(full=True)

    def _one(self, plan: Plan, student: str, folder: Path) -> Outcome:
        return grade_one(plan, student, read_folder(folder, ignore=self.course.ignore, bounds=self.course.bounds))

    def _land(self, student: str, future: Future[Outcome]) -> None:
        try:
            outcome = future.result()
        except SubmissionError as error:  # no date, or no folder: nbgrader drops such a submission too
            outcome = self._without(student, StudentReport(student, "broken", broken=(str(error),)))
        except Exception as error:  # the grader's own fault: named, never a zero, and tried again in the next run
            log.exception("grading %s failed", student)
            fault = str(error) if isinstance(error, SandboxError) else f"{type(error).__name__}: {error}"
            self._settled(StudentReport(student, "failed", faults=(fault,)))
            return
        if outcome.report.status == "empty":
            self._settled(outcome.report)
        else:
            self.waiting.append(outcome)

    def _without(self, student: str, report: StudentReport) -> Outcome:
        """The outcome of a submission of which nothing can be read: no marks, not even those of an earlier one."""
        record = Record(student, None, {name: NotebookMarks(broken=True) for name in self.masters})
        return Outcome(student, record, {}, report, "")

    def _commit(self, *, full: bool) -> None:
        due = len(self.waiting) >= BATCH or time.monotonic() - self.committed > BATCH_SECONDS
        if not self.waiting or not (full or due):
            return
        batch, self.waiting = self.waiting, []
        standings = self.book.write(
            self.row, [outcome.record for outcome in batch], penalty=self.penalty, create_students=self.course.create_students
        )
        for outcome in batch:
            report = self._with_standing(outcome.report, standings[outcome.student])
            try:
                self._publish(outcome, report)
            except OSError as error:  # a full disk, say: what is not published is graded again in the next run
                fault = f"the graded notebook could not be written: {error.strerror or error}"
                report = dataclasses.replace(report, status="failed", faults=(*report.faults, fault))
            self._settled(report)
        self.committed = time.monotonic()

    def _publish(self, outcome: Outcome, report: StudentReport) -> None:
        place = self.course.path("autograded", outcome.student, self.row.name)
        if outcome.files:
            mode = self.course.permissions("Autograde")
            staged = publish.stage(place, outcome.files, mode=mode, groupshared=self.course.groupshared)
            self.journal.forget(outcome.student)
            publish.publish(staged, place)
        elif place.exists():
            publish.remove(place)  # an earlier submission's; nbgrader removes it too when the new one fails
        if outcome.files:
            self.journal.write(outcome.student, Entry(outcome.digest, self.version, self.level, report))

    def _with_standing(self, report: StudentReport, standing: Standing) -> StudentReport:
        return dataclasses.replace(
            report, score=standing.score, penalty=standing.penalty, seconds_late=standing.seconds_late,
            available=self.available,
        )  # fmt: skip

    def _settled(self, report: StudentReport) -> None:
        self.done[report.student] = report
        if self.progress is not None:
            self.progress(len(self.done), self.total, report.student)

    def _unchanged(self, student: str, folder: Path) -> StudentReport | None:
        """The earlier report of a submission that needs no grading: nbgrader's rule, and the same bytes as then."""
        place = self.course.path("autograded", student, self.row.name)
        if not place.is_dir():
            return None
        try:
            submitted = read_folder(folder, ignore=self.course.ignore, bounds=self.course.bounds)
            then, now = _timestamp(place), handed_in(submitted.files)
        except SubmissionError:
            return None
        entry = self.journal.read(student)
        newer = then is not None and now is not None and now > then
        if newer or (entry is not None and (entry.submission != submitted.digest or entry.report.faults)):
            return None
        report = entry.report if entry is not None else StudentReport(student, "unchanged")
        notes = report.notes
        if entry is not None and entry.masters != self.version:
            notes = (*notes, "the instructor's copy has changed since this was graded; --force grades it again")
        return dataclasses.replace(report, status="unchanged", notes=notes)

    @contextlib.contextmanager
    def _plan(self) -> Iterator[Plan]:
        checked = [cell.exercise for master in self.masters.values() for cell in master.graded if cell.exercise]
        exercises = {name: found for name in checked if (found := self.course.exercise(name)) is not None}
        with opened(exercises.values(), self.course.packages, self.required, self.course.timeout) as open_session:
            self.level = open_session.level
            yield Plan(
                self.course, self.row, self.masters, self.course.instructor_files(self.row.name), self.course.secret(),
                exercises.get, open_session,
            )  # fmt: skip

    @property
    def available(self) -> float:
        """Points of the assignment."""
        return sum(float(cell.points or 0.0) for master in self.masters.values() for cell in master.cells.values())

    def report(self, seconds: float) -> GradeReport:
        """The class as it stands in the gradebook, manual marks included."""
        marked, standings, names = self.book.read_marks(self.row), self.book.standings(self.row), self.book.students()
        students = []
        for student, report in sorted(self.done.items()):
            full = _refreshed(report, marked.get(student, {}))
            if student in standings:
                full = self._with_standing(full, standings[student])
            students.append(dataclasses.replace(full, available=self.available, name=names.get(student, "")))
        titles = {exercise.id: exercise.title for exercise in self._exercises()}
        course = self.course.id or self.course.folder.name
        return GradeReport(course, self.row.name, self.level, tuple(students), seconds, self.available, titles)

    def _exercises(self) -> Iterator[Exercise]:
        for master in self.masters.values():
            for cell in master.graded:
                found = self.course.exercise(cell.exercise) if cell.exercise else None
                if found is not None:
                    yield found


def _refreshed(report: StudentReport, marked: Mapping[tuple[str, str], tuple[float | None, bool]]) -> StudentReport:
    """The same report with the points as they stand now: an instructor may have graded since."""
    cells = []
    for cell in report.cells:
        points, look = marked.get((cell.notebook, cell.name), (cell.points, cell.look))
        cells.append(dataclasses.replace(cell, points=points, look=look))
    return dataclasses.replace(report, cells=tuple(cells))


def _timestamp(place: Path) -> datetime.datetime | None:
    try:
        return handed_in({FILE: read_file(place / FILE, 1000)})
    except (SubmissionError, OSError):
        return None
