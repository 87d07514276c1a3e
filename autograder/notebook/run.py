"""Runs a rebuilt notebook in the sandbox and judges its exercise cells.

Ordinary cells are sent to the learner's session one after the other. An exercise cell ``check(name)`` is not: its call is read
from the instructor's copy, the judge calls the learner's function through the session, and the outputs are written here. So the
only way to its marks is to compute the right thing.

An instructor's ordinary test cell runs in a process of its own where that was found to give the same marks (``apart``).

When a cell ends its process (an endless loop, ``os._exit``, too much memory) a fresh session runs the earlier good cells again,
without their outputs, and the notebook goes on: a submission loses what cannot be run, and no more.

What is stopped by the clock while it has CPU time left (it waits, or the machine is busy) has no mark and asks for a look, and
so does every later cell that fails: marks must not depend on load. ``Ran.hurried`` says so, that it may be tried again alone.
"""

from __future__ import annotations

import contextlib
import logging
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from autograder import card, uses
from autograder.diagnosis.earlier import Earlier
from autograder.errors import CallFailed, SandboxError
from autograder.exercise import Exercise
from autograder.judge import judge
from autograder.messages import say
from autograder.notebook import kernel, limit, safe
from autograder.notebook.apart import Apart, Tests
from autograder.notebook.marks import CellRun
from autograder.notebook.master import MasterCell
from autograder.notebook.rebuild import Rebuilt
from autograder.notebook.told import told
from autograder.result import Verdict

log = logging.getLogger(__name__)
MAX_RESTARTS = 12
MAX_SECONDS = 300.0
ENDED = {"timeout": "TimeLimit", "memory": "MemoryLimit", "died": "ProcessEnded", "refused": "Refused"}  # shown as its error
SKIP_TAG = "skip-execution"


class Result(Protocol):
    """What a session says of one cell."""

    outputs: list[dict[str, Any]]
    status: Any
    note: str


class Session(Protocol):
    """One learner's process, as the sandbox opens it."""

    @property
    def alive(self) -> bool: ...  # noqa: D102
    def run_cell(self, source: str) -> Result: ...  # noqa: D102
    def call(self, name: str, args: Sequence[Any]) -> Any: ...  # noqa: D102
    def call_all(self, name: str, sets: Sequence[Sequence[Any]], *, deadline: float) -> list[Any]: ...  # noqa: D102
    def files(self) -> dict[str, bytes]: ...  # noqa: D102


Opener = Callable[[], contextlib.AbstractContextManager[Any]]


@dataclass
class Ran:
    """How each cell ran (aligned with the cells), what files the learner's code wrote, and what went wrong on our side."""

    cells: list[CellRun | None]
    files: dict[str, bytes] = field(default_factory=dict)
    faults: list[str] = field(default_factory=list)
    restarts: int = 0
    hurried: bool = False
    numbers: frozenset[str] = frozenset()  # test cells that return a number of points with the solution in source/


def run(
    rebuilt: Rebuilt,
    open_session: Opener,
    exercises: Callable[[str], Exercise | None],
    seed: Callable[[str], bytes],
    *,
    uses_check: bool = False,
    apart: Apart | None = None,
    seconds: float = MAX_SECONDS,
) -> Ran:
    """Run all code cells in order and write outputs and execution counts into the rebuilt notebook.

    Parameters
    ----------
    open_session : callable
        Opens a fresh sandbox session as a context manager.
    exercises : callable
        The exercise of a name, or None.
    seed : callable
        The seed of the hidden data of an exercise.
    uses_check : bool
        Whether ``check(name)`` is ours even where no exercise has that name (then it could not be judged).
    apart : Apart, optional
        Which test cells run in a process of their own, and how.
    seconds : float
        For the whole notebook; cells that no time is left for are not run and have no mark.
    """
    with contextlib.ExitStack() as stack:
        runner = _Runner(open_session, stack, time.monotonic() + seconds, apart)
        ran = Ran([])
        learners: list[tuple[dict[str, Any], bool]] = []
        sent = limit.Shown()
        wrong: dict[str, Verdict] = {}  # of the exercises judged so far
        count = 0
        for cell, mine, known in zip(rebuilt.cells, rebuilt.masters, rebuilt.known, strict=True):
            if cell["cell_type"] != "code" or (mine is None and SKIP_TAG in known.tags):
                ran.cells.append(None)
                continue
            count += 1
            name = mine.exercise if mine is not None else None
            if mine is not None and name is not None and (uses_check or exercises(name) is not None):
                before = _Before(wrong, [cell["source"] for cell, _ in learners], exercises)
                result = _judge(runner, exercises(name), name, seed, before)
                wrong.pop(name, None)
                if result.verdict is not None and result.verdict.outcome in ("partial", "failed", "not run"):
                    wrong[name] = result.verdict
                outputs = judged_outputs(result, mine, count)
            else:
                graded = mine is not None and mine.grade
                result, outputs = runner.run(cell["source"], mine.name if mine is not None and graded else "")
                outputs = sent.cut(outputs, graded=graded)
                learners.append((cell, graded))
            cell["outputs"], cell["execution_count"] = outputs, count
            ran.cells.append(result)
        ran.files, ran.faults, ran.restarts = runner.files(), runner.faults, runner.restarts
        ran.hurried = runner.hurried or bool(runner.spent and runner.late)
    if apart is not None and apart.kernel is not None and apart.script.engine == "jupyter":
        _in_a_kernel(rebuilt, ran, apart)
    shown, cleaned = limit.Shown(), limit.Shown()
    for cell, graded in learners:  # once more: what was updated since may have grown, and so may what is made harmless
        cell["outputs"] = cleaned.cut(safe.outputs(shown.cut(cell["outputs"], graded=graded)), graded=graded)
        for output in cell["outputs"]:
            if output["output_type"] == "execute_result":
                output["execution_count"] = cell["execution_count"]
    ran.numbers = apart.script.numbers if apart is not None else frozenset()
    return ran


def _in_a_kernel(rebuilt: Rebuilt, ran: Ran, apart: Apart) -> None:
    """Show what a real kernel shows, and keep the files that it left."""
    assert apart.kernel is not None
    try:
        shown = apart.kernel(kernel.sources(rebuilt, ran.cells, apart.script.apart))
    except SandboxError as error:
        ran.faults.append(f"the notebook could not be run in a kernel: {error}")
        kernel.without_marks(rebuilt, ran.cells, apart.script.apart)
        return
    kernel.take(rebuilt, ran.cells, shown, apart.script.apart)
    ran.files = shown.files or ran.files


def judged_outputs(run: CellRun, master: MasterCell, count: int) -> list[dict[str, Any]]:
    """What the trusted side writes under an exercise cell: the card, the figure, and the points as a plain float."""
    outputs: list[dict[str, Any]] = []
    if run.verdict is None:
        return [_display({"text/plain": run.note})]
    for make in (card.bundle, card.figure_bundle):
        try:
            shown = make(run.verdict)
        except Exception:  # a card that cannot be drawn must not cost the mark
            log.exception("the card of %s cannot be drawn", master.name)
            shown = {"text/plain": run.verdict.message} if make is card.bundle else None
        if shown:
            outputs.append(_display(shown))
    if run.verdict.outcome != "could not judge":
        points = repr(float(run.verdict.points(float(master.points or 0.0))))
        data = {"text/plain": points}
        outputs.append({"output_type": "execute_result", "execution_count": count, "metadata": {}, "data": data})
    return outputs


def _display(data: Mapping[str, Any]) -> dict[str, Any]:
    return {"output_type": "display_data", "metadata": {}, "data": dict(data)}


@dataclass(frozen=True)
class _Before:
    """What stands above an exercise cell: the verdicts that are not right, and the text of the learner's cells."""

    wrong: Mapping[str, Verdict]
    sources: Sequence[str]
    exercises: Callable[[str], Exercise | None]

    def used_by(self, name: str, call: Callable[[str, tuple[Any, ...]], Any]) -> list[Earlier]:
        """The earlier functions that are not right and that ``name`` calls."""
        found = []
        for id in uses.in_text(self.sources, name, self.wrong.keys()) if self.wrong else ():
            if (exercise := self.exercises(id)) is not None:
                written = self.wrong[id].outcome != "not run"
                found.append(Earlier(exercise, lambda *args, id=id: call(id, args), written))
        return found


def _judge(runner: _Runner, exercise: Exercise | None, name: str, seed: Callable[[str], bytes], before: _Before) -> CellRun:
    if exercise is None:
        note = say("graded.unknown", name=name)
        return CellRun("judged", _unjudged(name, note), note)
    try:
        session = runner.ready()
    except SandboxError as error:
        note = runner.fault(f"{name}: {error}")
        return CellRun("judged", _unjudged(name, say("graded.no_sandbox_judge"), exercise), note)
    if session is None:
        return CellRun("judged", _unjudged(name, runner.spent, exercise), runner.spent)

    def called(id: str, args: tuple[Any, ...]) -> Any:
        if runner.late:  # a function that sleeps in each of hundreds of calls must not keep the class waiting
            raise SandboxError(runner.spent)
        try:
            return session.call(id, args)
        except CallFailed as failure:
            runner.told(failure)
            raise

    after = runner.after
    try:
        verdict = judge(
            exercise, _Function(name, called, session, runner), seed=seed(name), earlier=lambda: before.used_by(name, called)
        )
    except Exception as error:  # the grader's own fault is never the learner's zero
        log.exception("the judge failed on %s", name)
        note = runner.fault(say("graded.fault_judge", name=name, exception=type(error).__name__, message=error))
        return CellRun("judged", _unjudged(name, say("graded.judge"), exercise), note)
    if verdict.outcome == "could not judge" and runner.late:
        return CellRun("judged", _unjudged(name, runner.spent, exercise), runner.spent)
    if (runner.hurried or after) and verdict.outcome != "passed":
        note = after or say("graded.hurried")
        return CellRun("judged", _unjudged(name, note, exercise), note)
    if verdict.outcome == "could not judge":
        return CellRun("judged", verdict, runner.fault(f"{name}: {verdict.message}"))
    return CellRun("judged", verdict)


@dataclass(frozen=True)
class _Function:
    """The learner's function, as the judge calls it: once, or with one set of arguments after the other."""

    name: str
    called: Callable[[str, tuple[Any, ...]], Any]
    session: Any
    runner: _Runner

    def __call__(self, *args: Any) -> Any:
        return self.called(self.name, args)

    def in_turn(self, sets: Sequence[tuple[Any, ...]]) -> list[Any]:
        """What each call gives, or how it fails, up to the first after which none can answer."""
        if self.runner.late:
            raise SandboxError(self.runner.spent)
        answers: list[Any] = self.session.call_all(self.name, sets, deadline=self.runner.deadline)
        for answer in answers:
            if isinstance(answer, CallFailed):
                self.runner.told(answer)
        if len(answers) < len(sets) and self.runner.late:
            raise SandboxError(self.runner.spent)
        return answers


def _unjudged(name: str, message: str, exercise: Exercise | None = None) -> Verdict:
    title = exercise.title if exercise is not None else name
    return Verdict(name, "could not judge", 0.0, "error", message, parts=(("wrong", message),), title=title)


class _Runner:
    """Keeps a live session: opens it, and after a death opens another and runs the good cells again."""

    def __init__(self, open_session: Opener, stack: contextlib.ExitStack, deadline: float, apart: Apart | None = None) -> None:
        self.open_session, self.stack, self.deadline = open_session, stack, deadline
        self.apart = apart if apart is not None and apart.script.apart else None
        self.tests: Tests | None = None
        self.session: Any = None
        self.good: list[str] = []
        self.restarts = -1  # the first opening is none
        self.faults: list[str] = []
        self.spent = ""
        self.hurried = False

    def ready(self) -> Any:
        """A live session that has run all good cells; None when no restart or no time is left."""
        while self.session is None or not self.session.alive or (self.tests is not None and not self.tests.alive):
            if self.restarts >= MAX_RESTARTS:
                self.spent = say("graded.restarts", count=MAX_RESTARTS)
                return None
            if self.late:
                return None
            self.stack.close()
            self.restarts += 1
            self._open()
        return None if self.late else self.session

    def _open(self) -> None:
        if self.apart is None:
            self.session = self.stack.enter_context(self.open_session())
            self._replay()
            return
        self.session, tests = map(self.stack.enter_context, self.apart.open_pair())
        self._replay()
        done = self.tests.done if self.tests is not None else []
        if self.session.alive:
            self.tests = Tests(self.apart.script, self.session, tests, done)

    @property
    def late(self) -> bool:
        """Whether the time for the whole notebook is used up; ``spent`` says so then."""
        if time.monotonic() <= self.deadline:
            return False
        self.spent = say("graded.late")
        return True

    def _replay(self) -> None:
        for source in list(self.good):
            if self.session.run_cell(source).status not in ("ok", "error") or not self.session.alive:
                self.good.remove(source)  # good once, fatal now: leave it out from here on
                if not self.session.alive:
                    return

    def run(self, source: str, test: str = "") -> tuple[CellRun, list[dict[str, Any]]]:
        """Run one ordinary cell; ``test`` is the name of a graded one."""
        apart = self.apart is not None and test in self.apart.script.apart
        try:
            session = self.ready()
            if session is None:
                return CellRun("not run", note=self.spent), [_display({"text/plain": self.spent})]
            result = self.tests.run(test, source) if apart and self.tests is not None else session.run_cell(source)
        except SandboxError as error:
            note = self.fault(say("graded.fault_cell", error=error))
            return CellRun("not run", note=note), [_display({"text/plain": say("graded.no_sandbox")})]
        if result.status in ("ok", "error") and session.alive and not apart:
            self.good.append(source)
        outputs = result.outputs  # cleaned when all cells have run: a later cell may update a display in them
        status, note = result.status, told(result.note)
        if status not in ("ok", "error") or (not session.alive and status == "ok"):
            outputs.append(_ended(status if status in ENDED else "died", note))
        elif status == "error" and not any(output["output_type"] == "error" for output in outputs):
            outputs.append(_error("Error", note or say("graded.error")))
        if self.after and status != "ok":
            return CellRun("not run", note=self.after), outputs
        if self.by_clock(status):
            return CellRun("not run", note=say("graded.hurried")), outputs
        return CellRun(status, note=note), outputs

    @property
    def after(self) -> str:
        """Why what fails from here on has no mark; empty as long as it is the learner's own."""
        return say("graded.after") if self.hurried else say("graded.faulty") if self.faults else ""

    def told(self, failure: CallFailed) -> None:
        """Put into the course's words how a call failed; what the clock stopped is no failure of the learner's."""
        if self.by_clock(failure.kind):
            raise SandboxError(say("graded.hurried")) from None
        failure.args = (told(failure.message),)

    def by_clock(self, status: str) -> bool:
        """Whether what has just ended so was stopped by the clock with CPU time left; ``hurried`` from then on."""
        sessions = [self.session, *([self.tests.session] if self.tests is not None else [])]
        stopped = status == "timeout" and any(getattr(session, "stopped_by_clock", False) for session in sessions)
        self.hurried = self.hurried or stopped
        return stopped

    def fault(self, note: str) -> str:
        self.faults.append(note)
        return note

    def files(self) -> dict[str, bytes]:
        """What the last live session left in its scratch folder."""
        if self.session is None or not self.session.alive:
            return {}
        try:
            written: dict[str, bytes] = self.session.files()
        except (SandboxError, CallFailed) as error:
            self.fault(f"files that the notebook wrote were not kept: {error}")
            return {}
        return written


def _ended(status: str, note: str) -> dict[str, Any]:
    return _error(ENDED[status], note or say(f"graded.ended.{status}"))


def _error(name: str, value: str) -> dict[str, Any]:
    value = safe.text(value, 10_000)
    return {"output_type": "error", "ename": name, "evalue": value, "traceback": [f"\x1b[0;31m{name}\x1b[0m: {value}"]}
