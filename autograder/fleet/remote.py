"""The part of a cluster's worker: a sandbox of its own, the exercises as the grader has them, batches of submissions.

A worker is a trusted process of the instructor's. It is sent, through the scheduler, what an assignment shares (the
instructor's copies with their hidden tests, the exercises' source) and then batches: the files of some submissions and, for
each, the seeds of its hidden data. It never has the course secret, the gradebook, another submission or a folder of the course.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import pickle
import platform
import secrets
import tempfile
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import distributed
import numpy as np

from autograder import catalogue
from autograder.errors import CourseError, SandboxError
from autograder.exercise import Exercise
from autograder.fleet.connection import listening, refuse
from autograder.fleet.one import Plan, Rules
from autograder.fleet.task import Landed, Task, judged
from autograder.notebook.apart import Script
from autograder.notebook.master import Master
from autograder.notebook.session import Packages, opened
from autograder.notebook.submission import Submission

if TYPE_CHECKING:
    from autograder.course import Course

Sent = tuple[str, bool, Submission, dict[tuple[str, str], bytes]]  # student, alone, files, seeds by (exercise, digest)


@functools.cache
def build() -> str:
    """What decides marks beside the course: this code, Python's and numpy's versions. The same everywhere or nowhere."""
    total = hashlib.sha256(f"{platform.python_version()} {np.__version__}".encode())
    house = Path(__file__).resolve().parents[1]
    library = next(path for path in (house.parent / "lib/directrix", house.parent / "directrix") if path.is_dir())
    for folder in (house, library):
        for path in sorted(folder.rglob("*.py")):
            total.update(path.relative_to(folder).as_posix().encode() + hashlib.sha256(path.read_bytes()).digest())
    return total.hexdigest()


@dataclass(frozen=True)
class Job:
    """What the submissions of an assignment share, as it crosses; no secret, no path of the course, no student."""

    name: str  # no other job's, whoever uses the cluster: graders in containers have the same folder and process id
    build: str
    rules: Rules
    masters: Mapping[str, Master] = field(repr=False)
    instructor_files: Mapping[str, bytes] = field(repr=False)
    scripts: Mapping[str, Script] = field(repr=False)
    exercises: Mapping[str, str]  # folder of the assignment that has it, by name
    sources: Mapping[str, bytes] = field(repr=False)  # of these folders' exercises, by path
    packages: Packages
    level: str
    timeout: float | None
    withhold: tuple[str, ...]
    given: tuple[tuple[str, ...], ...] = field(repr=False)

    @classmethod
    def of(cls, course: Course, assignment: str, plan: Plan, posed: Mapping[str, Exercise]) -> Job:
        """The job of a course's assignment."""
        folders = {name: _folder(course, name) for name in posed}
        sources = {
            f"{folder.name}/{path.relative_to(folder).as_posix()}": path.read_bytes()
            for folder in dict.fromkeys(folders.values())
            for path in _sources(folder)
        }
        return cls(
            f"directrix-{secrets.token_hex(8)}", build(), plan.rules, plan.masters,
            plan.instructor_files, plan.scripts, {name: folder.name for name, folder in folders.items()}, sources,
            course.packages, plan.open_session.level, course.timeout, course.withhold, course.given(assignment, plan.masters),
        )  # fmt: skip


def _folder(course: Course, name: str) -> Path:
    for known in (course.catalogue, catalogue.installed()):
        for assignment in known.assignments if known is not None else ():
            if name in assignment.exercises:
                return assignment.folder
    raise CourseError(f"the exercise {name} has no folder that could be sent to other machines")


def _sources(folder: Path) -> list[Path]:
    package = folder / "exercises"
    if (folder / "exercises.py").is_file():
        return [folder / "exercises.py"]
    return sorted(path for path in package.rglob("*") if path.is_file() and "__pycache__" not in path.parts)


class Grading(distributed.WorkerPlugin):  # type: ignore[misc]
    """In a Dask worker: its sandbox, the exercises as the grader has them, and the grading of batches."""

    def __init__(self, job: Job) -> None:
        self.job, self.name = job, job.name

    async def setup(self, worker: Any) -> None:
        """Start the sandbox. What it raises ends the run that is beginning; of a worker that joins later Dask only logs it.

        So batches ask for a resource of the job's name, which only a worker that came through this has.
        """
        self._held = contextlib.ExitStack()
        try:
            self._start(worker)
        except BaseException:
            self._held.close()
            raise
        await worker.set_resources(**{self.name: worker.state.nthreads})

    def _start(self, worker: Any) -> None:
        refuse([worker.address, *listening(worker)])
        if build() != self.job.build:
            raise CourseError(
                f"the worker {worker.address} has another directrix, Python or numpy than the grader; marks must not depend on "
                "where a submission is graded: install the same everywhere"
            )
        room = Path(self._held.enter_context(tempfile.TemporaryDirectory(prefix="directrix-")))
        for name, data in self.job.sources.items():
            (room / name).parent.mkdir(parents=True, exist_ok=True)
            (room / name).write_bytes(data)
        folders = set(self.job.exercises.values())
        known = {folder: catalogue.load_assignment(room / folder).exercises for folder in folders}
        self._exercises = {name: known[folder][name] for name, folder in self.job.exercises.items()}
        self._open()

    def teardown(self, worker: Any) -> None:
        """End the sandbox."""
        self._held.close()

    def _open(self) -> None:
        job = self.job
        self._sandbox = self._held.enter_context(contextlib.ExitStack())
        posed = self._exercises.values()
        opening = opened(posed, job.packages, job.level, job.timeout, job.withhold, given=job.given)
        self._opener = self._sandbox.enter_context(opening)
        self._opener.box.ahead = True

    def grade(self, batch: list[Sent]) -> list[Landed]:
        """Grade a batch; nothing is raised."""
        return [self._grade(*sent) for sent in batch]

    def _grade(self, student: str, alone: bool, submitted: Submission, seeds: Mapping[tuple[str, str], bytes]) -> Landed:
        task = Task(student, alone)
        landed = judged(self._plan(seeds), task, submitted)
        if landed.failed and not self._opener.box.alive:  # somebody ended the sandbox: that is nothing of this submission
            self._sandbox.close()
            try:
                self._open()
            except SandboxError as error:
                return Landed(student, fault=str(error))
            landed = judged(self._plan(seeds), task, submitted)
        return landed

    def _plan(self, seeds: Mapping[tuple[str, str], bytes]) -> Plan:
        job = self.job
        return Plan(
            job.rules, job.masters, job.instructor_files, lambda student, exercise, of: seeds[exercise, of],
            self._exercises.get, self._opener, job.scripts,
        )  # fmt: skip


def grade_batch(name: str, batch: bytes) -> bytes:
    """The task that Dask schedules: pickled submissions to pickled results, opaque to Dask on the way.

    It is done in a thread that Dask does not know: its pages, which anybody may read over HTTP, show line by line where its own
    threads are, also in a reference or a hidden test.
    """
    plugin: Any = distributed.get_worker().plugins[name]
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(lambda: pickle.dumps(plugin.grade(pickle.loads(batch)), protocol=5)).result()
