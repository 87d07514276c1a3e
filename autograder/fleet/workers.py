"""Worker processes on this machine: each does whole tasks by itself, and what a killed one had goes to another.

The judge holds the interpreter's lock, so threads cannot use several cores. Workers are forked: they share the memory of all
that was read and imported before, and start in milliseconds. A worker keeps nothing of its parent's open files but its own line
and those it is told to keep, ignores the keyboard, and ends with its parent.
"""

from __future__ import annotations

import contextlib
import gc
import logging
import os
import signal
import warnings
from collections import deque
from collections.abc import Callable, Collection, Iterable, Iterator
from multiprocessing.connection import Connection, Pipe, wait
from typing import Any, Generic, NoReturn, TypeVar

from autograder.sandbox import system

log = logging.getLogger(__name__)
Task = TypeVar("Task")
Result = TypeVar("Result")
AHEAD = 2  # tasks given to a worker at a time, so that it need not wait while the parent is busy
TRIES = 3  # a task whose worker was lost this often is given up: it may be what ends them


class Lost(Exception):
    """The workers that had this task were ended from outside."""


class Crew(Generic[Task, Result]):
    """Worker processes that all do the same kind of work.

    Parameters
    ----------
    work : callable
        Done in a worker: a task to its result. What it raises ends the worker, so it should raise nothing. Tasks and results
        cross by pickle, between processes of the grader only.
    count : int
        Workers.
    keep : collection of int
        File descriptors that workers go on using.
    """

    def __init__(self, work: Callable[[Task, int], Result], count: int, keep: Collection[int] = ()) -> None:
        self._work, self._keep = work, frozenset(keep)
        self._members: list[_Member[Task]] = []
        self._again: deque[Task] = deque()  # of lost workers, for others
        self.unfinished: list[Task] = []  # what workers had when they were ended by close()
        for number in range(max(1, count)):
            self._members.append(_Member(self, number))

    def __enter__(self) -> Crew[Task, Result]:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def close(self) -> None:
        """End all workers at once; what they have not answered is lost."""
        for member in self._members:
            member.kill()  # each takes a while to go
        while self._members:
            member = self._members.pop()
            self.unfinished += member.given
            member.end()
        self.unfinished += self._again
        self._again.clear()

    def each(self, tasks: Iterable[Task], patience: float | None = None) -> Iterator[tuple[Task, Result | Lost] | None]:
        """Every task with its result as they come, not in order; ``None`` when nothing came for ``patience`` seconds.

        No more tasks are taken than the workers hold, so memory does not grow with their number. Who stops taking may call
        this again for more: a task that was handed over is done, and what is still with the workers comes then.
        """
        queue = iter(tasks)
        tries: dict[int, int] = {}
        while True:
            for most in range(1, AHEAD + 1):  # everybody has something before anybody has more
                for member in self._members:
                    self._give(member, queue, most)
            busy = {member.line: member for member in self._members if member.given}
            if not busy:
                return
            ready = wait(list(busy), patience)
            if not ready:
                yield None
            for line in ready:
                member = busy[line]  # type: ignore[index]
                try:
                    result = member.line.recv()
                except (EOFError, OSError):
                    yield from self._replace(member, tries)
                else:
                    yield member.given.popleft(), result

    def _give(self, member: _Member[Task], queue: Iterator[Task], most: int) -> None:
        while len(member.given) < most:
            if self._again:
                task = self._again.popleft()
            else:
                try:
                    task = next(queue)
                except StopIteration:
                    return
            member.given.append(task)
            with contextlib.suppress(OSError):  # it has been ended; reading says so
                member.line.send(task)

    def _replace(self, member: _Member[Task], tries: dict[int, int]) -> Iterator[tuple[Task, Lost]]:
        """Another worker in the place of a lost one; its tasks are done again."""
        first, *others = member.given
        how = member.end()
        log.warning("a worker process was ended from outside (%s); its submissions are graded by another", how)
        self._members[self._members.index(member)] = _Member(self, member.number)
        self._again.extend(others)
        tries[id(first)] = tries.get(id(first), 0) + 1
        if tries[id(first)] < TRIES:
            self._again.append(first)
        else:
            yield first, Lost(f"the worker processes that had it were ended from outside {TRIES} times ({how})")


class _Member(Generic[Task]):
    """One worker as its parent sees it: its process, its line, the tasks that it was given and has not answered."""

    def __init__(self, crew: Crew[Task, Any], number: int) -> None:
        self.number = number
        self.given: deque[Task] = deque()
        self.line, theirs = Pipe()
        parent = os.getpid()
        with warnings.catch_warnings():  # Python 3.12 warns of forks beside threads; ours take no lock of theirs
            warnings.simplefilter("ignore", DeprecationWarning)
            self.pid = os.fork()
        if self.pid == 0:
            _worker(crew, number, theirs, parent)
        theirs.close()

    def kill(self) -> None:
        """Kill it; :meth:`end` waits until it is gone."""
        with contextlib.suppress(ProcessLookupError):
            os.kill(self.pid, signal.SIGKILL)

    def end(self) -> str:
        """Kill it; how it ended, in words."""
        self.kill()
        self.line.close()
        _, status = os.waitpid(self.pid, 0)
        number = os.waitstatus_to_exitcode(status)
        return signal.Signals(-number).name if number < 0 else f"exit {number}"


def _worker(crew: Crew[Any, Any], number: int, line: Connection[Any, Any], parent: int) -> NoReturn:
    """The life of a worker; it never returns into the parent's code."""
    code = 1
    try:
        system.die_with_parent()
        if os.getppid() != parent:
            os._exit(0)
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        _let_go({0, 1, 2, line.fileno(), *crew._keep})
        gc.freeze()  # what the parent has loaded is no garbage: looking for some would take long and copy its pages
        while True:
            line.send(crew._work(line.recv(), number))
    except (EOFError, OSError):
        code = 0
    except BaseException:
        log.exception("a worker process failed")
    finally:
        os._exit(code)


def _let_go(keep: Collection[int]) -> None:
    """Lay /dev/null over the parent's open files (locks, gradebook, lines of others): whoever closes a number closes that."""
    null = os.open(os.devnull, os.O_RDWR | os.O_CLOEXEC)
    for name in os.listdir("/proc/self/fd"):
        if int(name) not in keep and int(name) != null:
            with contextlib.suppress(OSError):  # the listing's own
                os.fstat(int(name))
                os.dup2(null, int(name), inheritable=False)
