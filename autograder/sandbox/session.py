"""One notebook in its own process, as the trusted side sees it: cells and calls in, checked values out."""

from __future__ import annotations

import math
import socket
import time
import unicodedata
from collections.abc import Callable, Iterator, Mapping, Sequence
from types import TracebackType
from typing import Any, Literal, TypeVar

from autograder.errors import CallFailed, SandboxError
from autograder.sandbox import messages, outputs, wire
from autograder.sandbox.policy import CellResult, CellStatus, Ended, Limits, Usage
from autograder.sandbox.process import RESULT_DEPTH, Action, Beside, Over, Process, encoded
from autograder.sandbox.wire import Value, WireError

ROOM = 4 * 2**20  # of a frame beyond the text it shows: tracebacks, names, framing
START_SECONDS = 30.0
STATUSES = ("ok", "error", "timeout", "memory")
T = TypeVar("T")
TOGETHER = 48 * 1024  # bytes of arguments sent at once: what a socket takes without anybody reading
LONGEST_PATH = 1000  # bytes; below a course's folder a file of it can still be made
FAILURES = ("error", "timeout", "memory", "refused", "missing")


class Session:
    """Runs cells and calls functions of one notebook, in order. Made by :meth:`Sandbox.open`; used by one thread at a time.

    Code that runs out of time is interrupted and the session goes on. After a limit that the code ignored, a crash or a
    breach of the protocol it is over: ``alive`` is False, ``ended`` says why, later cells give the status "died" and later
    calls raise :class:`CallFailed`.
    """

    def __init__(self, process: Process, limits: Limits) -> None:
        self.limits = limits
        self.ended: Ended | None = None
        self.out_of_time: Ended | None = None  # the last interruption; its ``limit`` tells CPU time from time by the clock
        self.facts: list[Any] = []
        self._process = process
        self._began = time.monotonic()
        self._action_began = self._began
        self._shown: dict[str, list[dict[str, Any]]] = {}  # displays with an id, for later updates

    def __enter__(self) -> Session:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    @property
    def alive(self) -> bool:
        """Whether more cells can be run."""
        return self.ended is None

    @property
    def stopped_by_clock(self) -> bool:
        """Whether its last stop came by the clock with CPU time left, as when the code waits or the machine is too busy."""
        why = self.ended if self.ended is not None and self.ended.limit else self.out_of_time
        return why is not None and why.limit == "wall"

    @property
    def usage(self) -> Usage:
        """What the notebook has used so far; ``max_rss`` is known once the session is over."""
        return Usage(self._process.cpu, time.monotonic() - self._began, self._process.max_rss)

    def run_cell(self, source: str, *, limits: Limits | None = None) -> CellResult:
        """Run the source of one code cell as a kernel would.

        Displays of earlier cells that this one updates are changed in the outputs handed out before.

        Raises
        ------
        SandboxError
            If the sandbox itself fails.
        """
        limits = limits or self.limits
        action = self._action(messages.CELL, limits.cell_cpu, limits, 4 * limits.output + ROOM)
        if self.ended is not None:
            return CellResult(status="died", note=self.ended.message)
        try:
            request = (source, action.cpu, action.wall, limits.output, limits.outputs)
            return self._cell_result(self._ask(wire.CELL, request, action), action, limits)
        except Over as over:
            return CellResult(status=over.ended.kind, note=over.ended.message)

    def run_apart(self, source: str, names: Sequence[str], learner: Session, *, limits: Limits | None = None) -> CellResult:
        """Run a test cell in this session whose ``names`` are those of ``learner``, opened with it by :meth:`Sandbox.pair`.

        The learner's session may be over afterwards: its ``alive`` tells.

        Raises
        ------
        SandboxError
            If the sandbox itself fails.
        """
        limits = limits or self.limits
        action = self._action(messages.TEST, limits.cell_cpu, limits, 4 * limits.output + ROOM)
        theirs = learner._action(messages.TEST, limits.cell_cpu, limits, ROOM)
        if self.ended is not None:
            return CellResult(status="died", note=self.ended.message)
        if learner.ended is not None:
            return CellResult(status="died", note=learner.ended.message)
        try:
            serving = learner._process.post(wire.SERVE, (theirs.cpu, theirs.wall, limits.output), theirs)
        except Over as over:
            learner.ended = over.ended
            return CellResult(status=over.ended.kind, note=over.ended.message)
        try:
            request = (source, tuple(names), action.cpu, action.wall, limits.output, limits.outputs)
            answer = self._ask(wire.APART, request, action, Beside(learner._process, theirs.cpu))
            result = self._cell_result(answer, action, limits)
        except Over as over:
            result = CellResult(status=over.ended.kind, note=over.ended.message)
        learner._served(serving)
        if learner.ended is not None and result.status == "error":  # whatever the test made of it
            result = CellResult(result.outputs, result.execution_count, learner.ended.kind, learner.ended.message)
        return result

    def _served(self, exchange: bytes) -> None:
        """The tests are done with this session: it should say so at once."""
        try:
            self._process.take(exchange, Action(messages.TEST, 1.0, 5.0, ROOM))
        except Over as over:
            self.ended = over.ended
        except WireError as error:
            self._breach(error)
        except SandboxError as error:
            self._process.kill()
            self.ended = Ended("died", str(error))
            raise

    def call(self, name: str, arguments: Sequence[Value], *, limits: Limits | None = None) -> Value:
        """Call the notebook's function ``name`` with positional arguments; what it prints is discarded.

        Raises
        ------
        CallFailed
            If the function gives no answer.
        SandboxError
            If the sandbox itself fails, or an argument cannot be sent.
        """
        limits = limits or self.limits
        action = self._action(messages.CALL, limits.call_cpu, limits, limits.answer + ROOM)
        if self.ended is not None:
            raise CallFailed("died", self.ended.message)
        try:
            request = (name, action.cpu, action.wall, limits.answer, tuple(arguments))
            return self._answer(self._ask(wire.CALLS, request, action), action)
        except Over as over:
            raise CallFailed(over.ended.kind, over.ended.message) from None

    def call_all(
        self, name: str, sets: Sequence[Sequence[Value]], *, deadline: float = math.inf, limits: Limits | None = None
    ) -> list[Value | CallFailed]:
        """Call a function with one set of arguments after the other, each call as :meth:`call`, without waiting between them.

        Returns what each of them gave or how it failed, up to the first after which no call can be answered, or until the
        clock (``time.monotonic``) passes the ``deadline``, which ends the session.

        Raises
        ------
        SandboxError
            If the sandbox itself fails, or an argument cannot be sent.
        """
        limits = limits or self.limits
        answers: list[Value | CallFailed] = []
        for some in _posted_together([encoded(tuple(arguments), RESULT_DEPTH - 1) for arguments in sets]):
            exchange, before = b"", math.inf
            action: Action | None = None
            for _ in some:
                if action is None or not self._process.arrived(action):
                    action = self._action(messages.CALL, limits.call_cpu, limits, limits.answer + ROOM)
                    # The child is ahead of us, so this call may have begun while we still took the answer to the one before.
                    self._action_began, before = min(before, self._action_began), self._action_began
                    if self.ended is None and time.monotonic() > deadline:
                        self._process.kill()
                        self.ended = Ended("timeout", messages.wall_time(action.what, action.wall), "wall")
                    if self.ended is not None:
                        return [*answers, CallFailed("died", self.ended.message)]
                try:
                    if not exchange:
                        about = map(encoded, (name, action.cpu, action.wall, limits.answer))
                        body = wire.row([*about, *some])
                        exchange = self._guarded(self._process.post_encoded, wire.CALLS, body, action)
                    answers.append(self._answer(self._guarded(self._process.take, exchange, action), action))
                except Over as over:
                    return [*answers, CallFailed(over.ended.kind, over.ended.message)]
                except CallFailed as failure:
                    answers.append(failure)
                    if failure.kind in wire.FATAL:
                        return answers
        return answers

    def files(self) -> dict[str, bytes]:
        """Regular files of the notebook's working folder by relative path; links and everything else are left out.

        Empty once the session is over: the folder is gone with it.
        """
        limits = self.limits
        action = self._action(messages.FILES, limits.cell_cpu, limits, limits.scratch + ROOM, 4 * limits.files + 10, raw=True)
        if self.ended is not None:
            return {}
        try:
            return checked_files(self._ask(wire.FILES, (), action), limits)
        except Over:
            return {}

    def close(self) -> None:
        """End the notebook's process, whatever it is doing."""
        if self.ended is None:
            self._process.kill()
            self.ended = Ended("died", "the session was closed")
        self._process.close()

    def start(
        self,
        files: Mapping[str, bytes],
        environment: Mapping[str, str],
        seed: int,
        withhold: tuple[str, ...] = (),
        peer: socket.socket | None = None,
    ) -> None:
        """Have the child lay out its files and confine itself; give it its socket to a peer. Called once, by the sandbox."""
        for name in files:
            if not all(map(plain_name, name.split("/"))):
                raise SandboxError(f"a notebook's files have relative paths of plain names; got {name!r}")
        action = Action(messages.START, START_SECONDS, START_SECONDS, 2**20)
        try:
            request = (tuple(files.items()), tuple(environment.items()), seed, withhold)
            posted = self._process.post(wire.START, request, action, None if peer is None else peer.fileno())
            answer = self._process.take(posted, action)
        except (Over, WireError) as error:
            raise SandboxError(f"a notebook's process could not be started: {error}") from None
        confined, *self.facts = answer
        if confined is not True:
            raise SandboxError(f"a notebook's process could not be confined: {self.facts[0]}")

    def _action(
        self, what: str, cpu: float, limits: Limits, most: int, items: int = wire.ITEMS, *, raw: bool = False
    ) -> Action:
        """What the next action may take; ends the session when the notebook has no time left."""
        self._action_began = time.monotonic()
        left = self.limits.notebook_cpu - self._process.cpu
        if left <= 0 and self.ended is None:
            self._process.kill()
            self.ended = Ended("timeout", messages.notebook_time(self.limits.notebook_cpu), "notebook")
        cpu = min(cpu, max(left, 0.01))
        return Action(what, cpu, limits.wall(cpu), most, items, raw)

    def _ask(self, kind: int, request: tuple[Any, ...], action: Action, beside: Beside | None = None) -> Any:
        """One exchange; whatever ends the process ends the session, and is raised as Over or SandboxError."""
        return self._guarded(self._process.ask, kind, request, action, beside)

    def _guarded(self, exchange: Callable[..., T], *given: Any) -> T:
        """What an exchange gives; whatever ends the process ends the session, and is raised as Over or SandboxError."""
        try:
            return exchange(*given)
        except Over as over:
            self.ended = over.ended
            raise
        except WireError as error:
            raise self._breach(error) from None
        except SandboxError as error:
            self._process.kill()
            self.ended = Ended("died", str(error))
            raise

    def _breach(self, error: WireError) -> Over:
        self._process.kill()
        self.ended = Ended("refused", messages.protocol(error), "protocol")
        return Over(self.ended)

    def _cell_result(self, answer: Any, action: Action, limits: Limits) -> CellResult:
        try:
            status, number, shown, changed = _checked_cell(answer, limits)
        except WireError as error:
            raise self._breach(error) from None
        for name, output in {name: output for output, name in changed}.items():  # the last counts
            for earlier in self._shown.get(name, []):
                earlier.update(data=output["data"], metadata=output["metadata"])
        for output, name in shown:
            if name:
                self._shown.setdefault(name, []).append(output)
        note = messages.memory(action.what, self.limits.memory) if status == "memory" else ""
        if status == "timeout":
            note = self._interrupted(action).message
        return CellResult([output for output, _ in shown], number, status, note)

    def _answer(self, answer: Any, action: Action) -> Value:
        try:
            if isinstance(answer, tuple) and len(answer) == 2 and answer[0] is True:
                value: Value = answer[1]
                return value
            failure = _checked_failure(answer)
        except WireError as error:
            raise self._breach(error) from None
        if failure.kind == "timeout":
            failure.args = (self._interrupted(action).message,)
        elif failure.kind == "memory":
            failure.args = (messages.memory(action.what, self.limits.memory),)
        raise failure

    def _interrupted(self, action: Action) -> Ended:
        """The child says that time was up; which time, is measured here."""
        limit: Literal["cpu", "wall"] = "wall" if time.monotonic() - self._action_began > 0.95 * action.wall else "cpu"
        self.out_of_time = self._process.out_of_time(limit, action)
        return self.out_of_time


def _checked_cell(answer: Any, limits: Limits) -> tuple[CellStatus, int, list[Any], list[Any]]:
    """Status, number, outputs and updates of a cell's result."""
    if not (isinstance(answer, tuple) and len(answer) == 4 and answer[0] in STATUSES and type(answer[1]) is int):
        raise WireError("a cell's result of no known form")
    number = max(0, min(answer[1], 10**6))
    shown, changed = outputs.outputs(answer[2], limits.output, limits.outputs), outputs.updates(answer[3])
    for output, _ in shown:
        if output["output_type"] == "execute_result":
            output["execution_count"] = number
    return answer[0], number, shown, changed


def _posted_together(sets: Sequence[bytes]) -> Iterator[list[bytes]]:
    """The sets in order, in groups that are sent in one message each."""
    group: list[bytes] = []
    size = 0
    for one in sets:
        if group and size + len(one) > TOGETHER:
            yield group
            group, size = [], 0
        group.append(one)
        size += len(one)
    if group:
        yield group


def _checked_failure(answer: Any) -> CallFailed:
    """How a call failed, as the child tells it."""
    if not (isinstance(answer, tuple) and len(answer) == 7 and answer[0] is False and answer[1] in FAILURES):
        raise WireError("an answer of no known form")
    _, kind, message, name, bases, line, source = answer
    if not isinstance(bases, tuple) or not (line is None or (type(line) is int and 0 < line < 10**6)):
        raise WireError("a failure of no known form")
    return CallFailed(
        kind, outputs.plain(message, 2000), exception=outputs.plain(name, 100), line=line, source=outputs.plain(source, 500),
        bases=tuple(outputs.plain(base, 100) for base in bases[:20]),
    )  # fmt: skip


def checked_files(answer: Any, limits: Limits) -> dict[str, bytes]:
    """Relative paths of plain names only, none of them the folder of another."""
    files: dict[str, bytes] = {}
    for item in answer[: limits.files] if isinstance(answer, tuple) else ():
        if not (isinstance(item, tuple) and len(item) == 2 and isinstance(item[0], str) and isinstance(item[1], bytes)):
            continue
        name, content = item
        if len(name.encode("utf-8", "replace")) <= LONGEST_PATH and all(plain_name(part) for part in name.split("/")):
            files[name] = content
    folders = {name.rsplit("/", depth)[0] for name in files for depth in range(1, name.count("/") + 1)}
    return {name: content for name, content in files.items() if name not in folders}


def plain_name(part: str) -> bool:
    """Whether a file or folder may have this name: no path, nothing that steers a terminal. Spaces of every width may be in it:
    macOS puts a narrow one into the name of each screenshot.
    """
    shown = all(letter.isprintable() or unicodedata.category(letter) == "Zs" for letter in part)
    return 0 < len(part.encode("utf-8", "replace")) <= 255 and part not in (".", "..") and shown and "\\" not in part
