"""Grades on a Dask cluster: workers on other machines run and judge, this process reads, commits and publishes.

A worker that is lost loses time: its batches are graded by others, and only this process writes. What a worker is given,
``autograder.fleet.remote`` says.
"""

from __future__ import annotations

import contextlib
import logging
import pickle
from asyncio import CancelledError
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace

import distributed
from distributed.comm.core import CommClosedError

from autograder.errors import CourseError
from autograder.fleet.remote import Grading, Job, Sent, grade_batch
from autograder.fleet.task import Landed, Task
from autograder.fleet.workers import Lost
from autograder.notebook.submission import Submission, digest

log = logging.getLogger(__name__)
BATCH = 25  # submissions at most in a task: a task costs Dask about a millisecond, a submission ten to thirty
BATCH_BYTES = 8 * 2**20


class Cluster:
    """A Dask cluster that does one kind of work, used as a :class:`~autograder.fleet.workers.Crew` is.

    Parameters
    ----------
    client : distributed.Client
        Of a cluster whose addresses are safe.
    job : Job
        What all submissions share.
    count : int
        Submissions in all.
    seed : callable
        Of the hidden data: student, exercise, digest of the notebook.
    read : callable
        A task to its submission, or to what is said of it where it cannot be read.
    lay_out : callable
        What came back to the same with its files beside their place.
    """

    def __init__(
        self,
        client: distributed.Client,
        job: Job,
        count: int,
        seed: Callable[[str, str, str], bytes],
        read: Callable[[Task], Submission | Landed],
        lay_out: Callable[[Landed], Landed],
    ) -> None:
        self.client, self._seed, self._read, self._lay_out = client, seed, read, lay_out
        self.job = replace(job, name=f"{job.name}-{client.id}")  # so that others see whose it is
        self.unfinished: list[Task] = []
        self._closed = False
        self._sent: dict[distributed.Future, list[Task]] = {}
        self._digests: dict[str, str] = {}  # of what was sent, by student
        self._again: deque[Task] = deque()  # each by itself: one of them may be what ended its workers
        self._ready: list[tuple[Task, Landed]] = []
        try:
            with self._scheduler_gone():
                self._forget_the_dead()
                client.register_plugin(Grading(self.job), name=self.job.name)
                self._size = max(1, min(BATCH, count // (2 * max(1, self._threads()))))
        except BaseException:  # some workers have taken it
            self.close()
            raise

    def __enter__(self) -> Cluster:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def close(self) -> None:
        """Take back what is not done, and what workers were given."""
        if self._closed:
            return
        self._closed = True
        for tasks in self._sent.values():
            self.unfinished += tasks
        futures, self._sent = list(self._sent), {}
        with contextlib.suppress(Exception):  # a cluster that is gone has nothing left of it
            self.client.cancel(futures)
            self.client.unregister_worker_plugin(self.job.name)

    def each(self, tasks: Iterable[Task], patience: float | None = None) -> Iterator[tuple[Task, Landed | Lost] | None]:
        """Every task with its result as they come, not in order; ``None`` when nothing came for ``patience`` seconds.

        Raises
        ------
        CourseError
            If the scheduler is gone.
        """
        queue = iter(tasks)
        while True:
            with self._scheduler_gone():
                self._fill(queue)
            while self._ready:
                yield self._ready.pop()
            if not self._sent:
                return
            with self._scheduler_gone(), self.client.as_current():
                try:
                    done = distributed.wait(list(self._sent), timeout=patience, return_when="FIRST_COMPLETED").done
                except TimeoutError:
                    done = set()
            if not done:
                yield None
            for future in done:
                yield from self._landed(future)

    def _forget_the_dead(self) -> None:
        """A grader that was killed took nothing back: each worker still keeps a sandbox for it, and what it was given."""
        dead = self.client.run_on_scheduler(
            lambda dask_scheduler: [
                name
                for name in dask_scheduler.worker_plugins
                if name.startswith("directrix-") and name.split("-", 2)[2] not in dask_scheduler.clients
            ]
        )
        for name in dead:
            with contextlib.suppress(Exception):  # another grader has just done it
                self.client.unregister_worker_plugin(name)

    def _threads(self) -> int:
        return sum(self.client.nthreads().values())

    def _fill(self, queue: Iterator[Task]) -> None:
        """Keep two batches for each worker's thread on the way, read only now."""
        most = 2 * self._threads() + 1
        while len(self._sent) < most and not self._ready:
            tasks: list[Task] = []
            sent: list[Sent] = []
            size = 0
            for task in [self._again.popleft()] if self._again else queue:
                submitted = self._read(task)
                if isinstance(submitted, Landed):
                    self._ready.append((task, submitted))
                else:
                    tasks.append(task)
                    self._digests[task.student] = submitted.digest
                    sent.append((task.student, task.alone, submitted, self._seeds(task.student, submitted)))
                    size += sum(map(len, submitted.files.values()))
                if len(tasks) >= self._size or size > BATCH_BYTES:
                    break
            if not tasks:
                return
            batch = pickle.dumps(sent, protocol=5)
            future = self.client.submit(grade_batch, self.job.name, batch, pure=False, resources={self.job.name: 1})
            self._sent[future] = tasks

    def _seeds(self, student: str, submitted: Submission) -> dict[tuple[str, str], bytes]:
        notebooks = [digest(submitted.notebooks[name]) for name in self.job.masters if name in submitted.notebooks]
        return {(name, of): self._seed(student, name, of) for name in self.job.exercises for of in notebooks}

    def _landed(self, future: distributed.Future) -> Iterator[tuple[Task, Landed | Lost]]:
        with self._scheduler_gone():
            error = future.exception()
            answer = future.result() if error is None else b""
        tasks = self._sent.pop(future)
        future.release()
        why = f"the cluster's workers that had it were lost ({type(error).__name__}: {error})"
        if error is None:
            answers = self._answers(answer, tasks)
            if answers:
                for task, landed in zip(tasks, answers, strict=True):
                    del self._digests[task.student]
                    yield task, self._lay_out(landed)
                return
            why = "the cluster's worker that had it answered for another submission, or what cannot be read"
        if len(tasks) > 1:
            self._again.extend(tasks)
        else:
            yield tasks[0], Lost(why)

    def _answers(self, answer: bytes, tasks: Sequence[Task]) -> list[Landed]:
        """What came back, of each task its own; nothing if it is anything else. A worker is trusted, but may be broken."""
        try:
            answers: list[Landed] = pickle.loads(answer)
            return answers if len(answers) == len(tasks) and all(map(self._of, answers, tasks)) else []
        except Exception:  # cut short, or of types that no worker of this build sends
            log.exception("a worker's answer cannot be read")
            return []

    def _of(self, landed: Landed, task: Task) -> bool:
        """Whether this came of the task: of the student and of the bytes that were sent. Marks go to whom the record names."""
        outcome = landed.outcome
        if outcome is None:
            return landed.student == task.student
        named = {landed.student, outcome.student, outcome.record.student, outcome.report.student}
        return named == {task.student} and outcome.digest == self._digests[task.student]

    @contextlib.contextmanager
    def _scheduler_gone(self) -> Iterator[None]:
        try:
            yield
        except (OSError, CommClosedError, CancelledError) as error:
            said = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
            raise CourseError(
                f"the Dask scheduler is gone ({said}); what was graded so far is kept, and the next run goes on from there"
            ) from None
