"""One notebook in its own child process, as the trusted side sees it."""

from __future__ import annotations

import json
import os
import secrets
import select
import signal
import socket
import time
from collections.abc import Sequence
from types import TracebackType
from typing import Any, Literal

from autograder.errors import CallFailed, SandboxError
from autograder.sandbox import messages, outputs, wire
from autograder.sandbox.policy import CellResult, CellStatus, Ended, Limits, Usage
from autograder.sandbox.wire import Value, WireError

CORES = os.cpu_count() or 1
SOFT = 1.0  # seconds between the child's own interruption, which can tell the line, and the end from outside
ROOM = 4 * 2**20  # of a frame beyond the text it shows: tracebacks, names, framing
START_SECONDS = 30.0
STATUSES = ("ok", "error", "timeout", "memory")
FAILURES = ("error", "timeout", "memory", "refused", "missing")


class Session:
    """Runs cells and calls functions of one notebook, in order. Made by :meth:`Sandbox.open`; used by one thread at a time.

    After a time limit that the code ignored, a crash or a breach of the protocol the session is over: ``alive`` is False,
    ``ended`` says why, later cells give the status "died" and later calls raise :class:`CallFailed` of the same kind.
    """

    def __init__(self, link: socket.socket, report: socket.socket, pidfd: int, limits: Limits) -> None:
        self.limits = limits
        self.ended: Ended | None = None
        self.facts: tuple[Any, ...] = ()
        self._link, self._report, self._pidfd = link, report, pidfd
        self._link.setblocking(False)
        self._began = time.monotonic()
        self._clock = _cpu_clock(pidfd)
        self._cpu, self._max_rss = 0.0, 0
        self._shown: dict[str, list[dict[str, Any]]] = {}  # displays with an id, for later updates
        self._poll = select.poll()
        self._poll.register(pidfd, select.POLLIN)

    def __enter__(self) -> Session:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    @property
    def alive(self) -> bool:
        """Whether more cells can be run."""
        return self.ended is None

    @property
    def usage(self) -> Usage:
        """What the notebook has used so far."""
        return Usage(self._measured_cpu(), time.monotonic() - self._began, self._max_rss)

    def run_cell(self, source: str, *, limits: Limits | None = None) -> CellResult:
        """Run the source of one code cell as a kernel would.

        Displays of earlier cells that this one updates are changed in the outputs handed out before.

        Raises
        ------
        SandboxError
            If the sandbox itself fails.
        """
        limits = limits or self.limits
        cpu = self._allowance(limits.cell_cpu)
        if self.ended is not None:
            return CellResult(status="died", note=self.ended.message)
        request = (source, cpu, limits.wall(cpu), limits.output, limits.outputs)
        try:
            answer = self._ask(wire.CELL, request, cpu, limits, messages.CELL, 2 * limits.output + ROOM, wire.ITEMS)
            return self._cell_result(answer, cpu)
        except WireError as error:
            self._end(Ended("refused", messages.protocol(error), "protocol"))
        except _Over:
            pass
        assert self.ended is not None
        return CellResult(status=self.ended.kind, note=self.ended.message)

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
        cpu = self._allowance(limits.call_cpu)
        self._must_be_alive()
        request = (name, tuple(arguments), cpu, limits.wall(cpu), limits.answer)
        try:
            answer = self._ask(wire.CALL, request, cpu, limits, messages.CALL, limits.answer + ROOM, wire.ITEMS)
            return self._answer(answer, cpu, limits)
        except WireError as error:
            self._end(Ended("refused", messages.protocol(error), "protocol"))
        except _Over:
            pass
        self._must_be_alive()
        raise AssertionError("an ended session was alive")

    def files(self) -> dict[str, bytes]:
        """Regular files of the notebook's working folder by relative path; links and everything else are left out.

        Empty once the session is over: the folder is gone with it.
        """
        if self.ended is not None:
            return {}
        limits = self.limits
        try:
            answer = self._ask(
                wire.FILES, (), limits.cell_cpu, limits, messages.FILES, limits.scratch + ROOM, 4 * limits.files, True
            )
            return _checked_files(answer, limits)
        except WireError as error:
            self._end(Ended("refused", messages.protocol(error), "protocol"))
        except _Over:
            pass
        return {}

    def close(self) -> None:
        """End the notebook's process, whatever it is doing."""
        if self.ended is None:
            self._end(Ended("died", "the session was closed"))
        for thing in (self._link, self._report):
            thing.close()
        if self._pidfd >= 0:
            os.close(self._pidfd)
            self._pidfd = -1

    def start(self, files: dict[str, bytes], environment: dict[str, str], seed: int) -> None:
        """Wait until the child has confined itself, then lay out its files. Called once, by the sandbox."""
        try:
            kind, _, body = self._receive(None, START_SECONDS, START_SECONDS, 2**20, messages.START)
            if kind != wire.READY:
                raise SandboxError(f"a notebook's process could not be confined: {wire.decode(body)}")
            self.facts = wire.decode(body)
            request = (tuple(files.items()), tuple(environment.items()), seed)
            self._ask(wire.START, request, START_SECONDS, self.limits, messages.START, 1000, 10)
        except (WireError, _Over) as error:
            raise SandboxError(
                f"a notebook's process could not be started: {self.ended.message if self.ended else error}"
            ) from None

    def _allowance(self, cpu: float) -> float:
        """CPU seconds that this action may take; ends the session when the notebook has none left."""
        left = self.limits.notebook_cpu - self._measured_cpu()
        if left <= 0 and self.ended is None:
            self._end(Ended("timeout", messages.notebook_time(self.limits.notebook_cpu), "notebook"))
        return min(cpu, max(left, 0.01))

    def _must_be_alive(self) -> None:
        if self.ended is not None:
            raise CallFailed(self.ended.kind, self.ended.message)

    def _ask(
        self,
        kind: int,
        request: tuple[Any, ...],
        cpu: float,
        limits: Limits,
        what: str,
        most: int,
        items: int,
        raw: bool = False,
    ) -> Any:
        """Send one request and return the decoded answer to it."""
        try:
            body = wire.encode(request, depth=wire.DEPTH + 2)
        except WireError as error:
            raise SandboxError(f"{error} cannot be sent to a notebook") from None
        exchange = secrets.token_bytes(16)
        wall = limits.wall(cpu)
        self._send(wire.frame(kind, exchange, body), wall, what)
        answered, name, answer = self._receive(exchange, cpu, wall, most, what)
        if answered != wire.DONE or name != exchange:
            raise WireError("an answer to another question")
        return wire.decode(answer, depth=6, items=items, raw=raw)

    def _send(self, data: bytes, wall: float, what: str) -> None:
        view, deadline = memoryview(data), time.monotonic() + wall
        while view:
            try:
                view = view[self._link.send(view) :]
            except BlockingIOError:
                if not select.select([], [self._link], [], 0.05)[1] and time.monotonic() > deadline:
                    self._end(Ended("timeout", messages.wall_time(what, wall), "wall"))
                    raise _Over from None
            except OSError:
                self._died(what)

    def _receive(self, exchange: bytes | None, cpu: float, wall: float, most: int, what: str) -> tuple[int, bytes, bytes]:
        """One whole frame, or the end of the session at the deadline. ``exchange`` is None for the first frame of all."""
        watch = _Watch(self._measured_cpu() + cpu, time.monotonic() + wall)
        head = self._read(wire.HEADER.size, watch, cpu, wall, what)
        kind, length, name = wire.header(head, most)
        return kind, name, self._read(length, watch, cpu, wall, what)

    def _read(self, count: int, watch: _Watch, cpu: float, wall: float, what: str) -> bytes:
        """Exactly ``count`` bytes; memory grows only with what has arrived."""
        data = bytearray()
        self._poll.register(self._link, select.POLLIN)
        while len(data) < count:
            used = self._measured_cpu()
            limit: Literal["", "cpu", "wall", "notebook"] = watch.over(used)
            if limit:
                message = messages.cpu_time(what, cpu) if limit == "cpu" else messages.wall_time(what, wall)
                if used >= self.limits.notebook_cpu:
                    limit, message = "notebook", messages.notebook_time(self.limits.notebook_cpu)
                self._end(Ended("timeout", message, limit))
                raise _Over
            ready = self._poll.poll(watch.pause(used) * 1000)
            if not ready:
                continue
            try:
                part = self._link.recv(min(count - len(data), 2**20))
            except BlockingIOError:
                part = b""
                if any(descriptor != self._pidfd for descriptor, _ in ready):
                    continue
            except OSError:
                part = b""
            if not part:
                self._died(what)
            data += part
            if len(part) < 512 and len(data) < count:
                time.sleep(0.001)  # a child that drips bytes must not keep us busy
        return bytes(data)

    def _died(self, what: str) -> None:
        """The child has ended or closed its socket: find out how, and stop here."""
        self._kill()
        end = self._final()
        status = int(end.get("status", 0))
        crashed = os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0
        if crashed == signal.SIGKILL and self._cpu >= self.limits.notebook_cpu:
            self._end(Ended("timeout", messages.notebook_time(self.limits.notebook_cpu), "notebook"))
        else:
            code = os.WEXITSTATUS(status) if os.WIFEXITED(status) else None
            self._end(Ended("died", messages.died(what, crashed, code)))
        raise _Over

    def _end(self, why: Ended) -> None:
        if self.ended is None:
            self._kill()
            self._final()
            self.ended = why

    def _kill(self) -> None:
        try:
            signal.pidfd_send_signal(self._pidfd, signal.SIGKILL)
        except (ProcessLookupError, OSError):
            pass

    def _final(self) -> dict[str, Any]:
        """The zygote's report on the ended child; also the last word on what it used."""
        self._report.settimeout(5.0)
        try:
            end: dict[str, Any] = json.loads(self._report.recv(4096) or b"{}")
        except (OSError, ValueError):
            return {}
        self._cpu, self._max_rss = float(end.get("cpu", self._cpu)), int(end.get("max_rss", 0))
        self._clock = None
        return end

    def _measured_cpu(self) -> float:
        if self._clock is not None:
            try:
                self._cpu = time.clock_gettime(self._clock)
            except OSError:
                self._clock = None
        return self._cpu

    def _cell_result(self, answer: Any, cpu: float) -> CellResult:
        if not (isinstance(answer, tuple) and len(answer) == 4 and answer[0] in STATUSES and type(answer[1]) is int):
            raise WireError("a cell's result of no known form")
        status: CellStatus = answer[0]
        shown, changed = outputs.outputs(answer[2]), outputs.updates(answer[3])
        result = [output for output, _ in shown]
        for output in result:
            if output["output_type"] == "execute_result":
                output["execution_count"] = answer[1]
        for output, name in changed:
            for earlier in self._shown.get(name, []):
                earlier.update(data=output["data"], metadata=output["metadata"])
        for output, name in shown:
            if name:
                self._shown.setdefault(name, []).append(output)
        note = {"timeout": messages.cpu_time(messages.CELL, cpu), "memory": messages.memory(messages.CELL, self.limits.memory)}
        return CellResult(result, max(0, min(answer[1], 10**6)), status, note.get(status, ""))

    def _answer(self, answer: Any, cpu: float, limits: Limits) -> Value:
        if isinstance(answer, tuple) and len(answer) == 2 and answer[0] is True:
            value: Value = answer[1]
            return value
        if not (isinstance(answer, tuple) and len(answer) == 7 and answer[0] is False and answer[1] in FAILURES):
            raise WireError("an answer of no known form")
        _, kind, message, name, bases, line, source = answer
        if not isinstance(bases, tuple) or not (line is None or type(line) is int and 0 < line < 10**6):
            raise WireError("a failure of no known form")
        message = {"timeout": message, "memory": messages.memory(messages.CALL, limits.memory)}.get(kind, message)
        raise CallFailed(
            kind, outputs.text(message, 2000), exception=outputs.text(name, 100), line=line, source=outputs.text(source, 500),
            bases=tuple(outputs.text(base, 100) for base in bases[:20]),
        )  # fmt: skip


class _Over(Exception):
    """The session has just ended; ``ended`` says why."""


class _Watch:
    """The two deadlines of one exchange: CPU seconds of the child, and the clock."""

    def __init__(self, cpu: float, wall: float) -> None:
        self.cpu, self.wall = cpu + SOFT, wall + SOFT

    def over(self, used: float) -> Literal["", "cpu", "wall"]:
        if used > self.cpu:
            return "cpu"
        return "wall" if time.monotonic() > self.wall else ""

    def pause(self, used: float) -> float:
        """How long nothing can be over: all cores together cannot use up the CPU time any sooner."""
        return max(0.002, min(self.wall - time.monotonic(), (self.cpu - used) / CORES))


def _cpu_clock(pidfd: int) -> int | None:
    """The CPU clock of the process behind a pidfd, as clock_gettime takes it (linux/posix-timers.h: ~pid << 3 | 2)."""
    with open(f"/proc/self/fdinfo/{pidfd}", encoding="ascii") as file:
        fields = dict(line.split(":\t") for line in file.read().splitlines() if ":\t" in line)
    pid = int(fields.get("Pid", "-1"))
    return (~pid << 3) | 2 if pid > 0 else None


def _checked_files(answer: Any, limits: Limits) -> dict[str, bytes]:
    """Relative paths of plain names only, none of them the folder of another."""
    files: dict[str, bytes] = {}
    if not isinstance(answer, tuple) or len(answer) > limits.files:
        raise WireError("files of no known form")
    for item in answer:
        if not (isinstance(item, tuple) and len(item) == 2 and isinstance(item[0], str) and isinstance(item[1], bytes)):
            raise WireError("a file of no known form")
        name, content = item
        parts = name.split("/")
        if len(name) > 1000 or not all(_plain_name(part) for part in parts) or name in files:
            continue
        files[name] = content
    folders = {name.rsplit("/", depth)[0] for name in files for depth in range(1, name.count("/") + 1)}
    return {name: content for name, content in files.items() if name not in folders}


def _plain_name(part: str) -> bool:
    return (
        0 < len(part.encode("utf-8", "replace")) <= 255 and part not in (".", "..") and part.isprintable() and "\\" not in part
    )
