"""A notebook's process seen from outside: questions and answers under deadlines, its measured time, its end."""

from __future__ import annotations

import contextlib
import json
import os
import secrets
import select
import signal
import socket
import time
from dataclasses import dataclass
from typing import Any, Literal

from autograder.errors import SandboxError
from autograder.sandbox import messages, wire
from autograder.sandbox.policy import Ended, Limits
from autograder.sandbox.wire import WireError

CORES = os.cpu_count() or 1
SOFT = 1.0  # seconds between the child's own interruption, which can tell the line, and the end from outside
CLOSING = 1.0  # seconds that a process may take between closing its socket and being gone
RESULT_DEPTH = wire.DEPTH + 2


@dataclass(frozen=True)
class Action:
    """What one exchange may take: CPU seconds, seconds by the clock, bytes and values of the answer. ``what`` names it."""

    what: str
    cpu: float
    wall: float
    most: int
    items: int = wire.ITEMS
    raw: bool = False


class Over(Exception):
    """The process is gone; ``ended`` says why."""

    def __init__(self, ended: Ended) -> None:
        super().__init__(ended.message)
        self.ended = ended


class Process:
    """One child of the zygote. It is killed, through its pidfd, when it outstays a limit or breaks the protocol."""

    def __init__(self, link: socket.socket, report: socket.socket, pidfd: int, limits: Limits, level: str) -> None:
        self.limits, self.level = limits, level
        self.max_rss = 0
        self._link, self._report, self._pidfd = link, report, pidfd
        self._rest = bytearray()  # what has arrived and is not taken yet
        self._link.setblocking(False)
        self._cpu = 0.0
        self._stopped: Ended | None = None
        self._clock = _cpu_clock(pidfd)
        self._poll = select.poll()
        self._poll.register(pidfd, select.POLLIN)

    @property
    def cpu(self) -> float:
        """CPU seconds used so far, by all its threads."""
        if self._clock is not None:
            try:
                self._cpu = time.clock_gettime(self._clock)
            except OSError:  # it has been reaped; the zygote's report says the rest
                self._clock = None
        return self._cpu

    def ask(self, kind: int, request: tuple[Any, ...], action: Action, beside: Beside | None = None) -> Any:
        """Send one request and return the decoded answer to it. What is ``beside`` it is ended when its own time is up.

        Raises
        ------
        Over
            If a limit was reached or the process ended.
        WireError
            If the answer breaks the protocol.
        SandboxError
            If the request cannot be sent, or the sandbox itself is gone.
        """
        return self.take(self.post(kind, request, action), action, beside)

    def post(self, kind: int, request: tuple[Any, ...], action: Action, peer: int | None = None) -> bytes:
        """Send one request, with a descriptor if one is given; returns the exchange by which to take the answer."""
        return self.post_encoded(kind, encoded(request), action, peer)

    def post_encoded(self, kind: int, body: bytes, action: Action, peer: int | None = None) -> bytes:
        """Send one request that is in binary form already (:func:`encoded`)."""
        exchange = secrets.token_bytes(16)
        data = wire.frame(kind, exchange, body)
        if peer is not None:
            try:
                data = data[socket.send_fds(self._link, [data], [peer]) :]
            except OSError:
                self._gone(action)
        self._send(data, action)
        return exchange

    def take(self, exchange: bytes, action: Action, beside: Beside | None = None) -> Any:
        """Wait for the answer to a request that was posted."""
        answered, name, answer = self._frame(action, beside)
        if answered != wire.DONE or name != exchange:
            raise WireError("an answer to another question")
        return wire.decode(answer, depth=RESULT_DEPTH, items=action.items, raw=action.raw)

    def arrived(self, action: Action) -> bool:
        """Whether an answer is there already, or what can be none, so that :meth:`take` will not wait."""
        try:
            return self._missing(action) <= 0
        except WireError:
            return True

    def kill(self) -> dict[str, Any] | None:
        """End it, and return the zygote's report (None if the zygote is gone too)."""
        with contextlib.suppress(OSError):  # it has ended already
            signal.pidfd_send_signal(self._pidfd, signal.SIGKILL)
        self._report.settimeout(10.0)
        try:
            end: dict[str, Any] = json.loads(self._report.recv(4096))
        except (OSError, ValueError):
            return None
        self._cpu, self._clock = max(self._cpu, float(end["cpu"])), None
        self.max_rss = int(end["max_rss"])
        return end

    def stop(self, why: Ended) -> None:
        """End it while nobody waits for it; who asks next is told why."""
        self._stopped = why
        with contextlib.suppress(OSError):
            signal.pidfd_send_signal(self._pidfd, signal.SIGKILL)

    def close(self) -> None:
        """Let go of its sockets. It must have been killed."""
        if self._pidfd >= 0:
            self._link.close()
            self._report.close()
            os.close(self._pidfd)
            self._pidfd = -1

    def _send(self, data: bytes, action: Action) -> None:
        view, watch = memoryview(data), None
        while view:
            try:
                view = view[self._link.send(view) :]
            except BlockingIOError:
                watch = watch or self._watch(action, select.POLLOUT)
                self._within(watch, action)
                self._poll.poll(watch.pause(self._cpu) * 1000)
            except OSError:
                self._gone(action)

    def _frame(self, action: Action, beside: Beside | None = None) -> tuple[int, bytes, bytes]:
        """One whole frame: kind, exchange, body. What came too early is met by the next question, and is no answer to it."""
        watch = None
        while (missing := self._missing(action)) > 0:
            watch = watch or self._watch(action, select.POLLIN, beside)
            self._receive(missing, watch, action)
        kind, length, exchange = wire.header(self._rest, action.most)
        end = wire.HEADER.size + length
        body = bytes(memoryview(self._rest)[wire.HEADER.size : end])
        del self._rest[:end]
        return kind, exchange, body

    def _missing(self, action: Action) -> int:
        """How many bytes have still to arrive, at least, until there is a whole frame."""
        size = wire.HEADER.size - len(self._rest)
        return size if size > 0 else size + wire.header(self._rest, action.most)[1]

    def _receive(self, missing: int, watch: _Watch, action: Action) -> None:
        """Wait for more; memory grows only with what has arrived."""
        self._within(watch, action)
        ready = [descriptor for descriptor, _ in self._poll.poll(watch.pause(self._cpu) * 1000)]
        if self._link.fileno() not in ready:
            if ready:
                self._drain_or_gone(action)
            return
        try:
            part = self._link.recv(max(2**16, min(missing, 2**20)))
        except BlockingIOError:
            return
        except OSError:
            part = b""
        if not part:
            self._gone(action)
        self._rest += part
        if len(part) < 512 and len(part) < missing:
            time.sleep(0.001)  # a child that drips bytes must not keep us busy

    def _watch(self, action: Action, event: int, beside: Beside | None = None) -> _Watch:
        """The deadlines of an exchange from now on, to be met by the socket's being ready for this."""
        self._poll.register(self._link, event)
        return _Watch(self.cpu + action.cpu, time.monotonic() + action.wall, beside)

    def _drain_or_gone(self, action: Action) -> None:
        """The process has ended: what it sent before may still be waiting."""
        poll = select.poll()
        poll.register(self._link, select.POLLIN)
        if not poll.poll(0):
            self._gone(action)

    def _within(self, watch: _Watch, action: Action) -> None:
        used = self.cpu
        limit = watch.over(used)
        if limit:
            self.kill()
            raise Over(self.out_of_time(limit, action))
        if watch.beside is not None:
            watch.beside.within()

    def out_of_time(self, limit: Literal["cpu", "wall"], action: Action) -> Ended:
        """Why an action was stopped, in words."""
        if self._cpu >= self.limits.notebook_cpu:
            return Ended("timeout", messages.notebook_time(self.limits.notebook_cpu), "notebook")
        if limit == "cpu":
            return Ended("timeout", messages.cpu_time(action.what, action.cpu), "cpu")
        return Ended("timeout", messages.wall_time(action.what, action.wall), "wall")

    def _gone(self, action: Action) -> None:
        """The process has ended or has closed its socket: find out how."""
        poll = select.poll()
        poll.register(self._pidfd, select.POLLIN)
        by_itself = bool(poll.poll(CLOSING * 1000))
        end = self.kill()
        if end is None:
            raise SandboxError("the zygote has died, and the notebook's process with it")
        if self._stopped is not None:
            raise Over(self._stopped)
        status = int(end["status"])
        number = os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0
        if not by_itself or (os.WIFEXITED(status) and os.WEXITSTATUS(status) == wire.LINK_LOST):
            raise Over(Ended("died", messages.closed(action.what)))
        if number == signal.SIGKILL and self._cpu >= self.limits.notebook_cpu:  # the kernel's own clock was quicker than ours
            raise Over(self.out_of_time("cpu", action))
        if number == signal.SIGKILL and self.level == "A":  # nobody inside can do that to the first process of a namespace
            raise SandboxError("the notebook's process was killed from outside, perhaps because the machine ran out of memory")
        raise Over(Ended("died", messages.died(action.what, number, os.WEXITSTATUS(status))))


def encoded(value: Any, depth: int = RESULT_DEPTH) -> bytes:
    """What is to be sent, in binary form; SandboxError where it has none."""
    try:
        return wire.encode(value, depth=depth)
    except WireError as error:
        raise SandboxError(f"{error} cannot be sent to a notebook") from None


class Beside:
    """A process that works for another one's exchange, within CPU seconds of its own."""

    def __init__(self, process: Process, cpu: float) -> None:
        self.process, self.cpu, self.most = process, cpu, process.cpu + cpu + SOFT

    @property
    def left(self) -> float:
        """CPU seconds that it has left."""
        return self.most - self.process.cpu

    def within(self) -> None:
        """End it if it has used up its time; whoever waits for it meets its end."""
        if self.left < 0:
            self.process.stop(Ended("timeout", messages.cpu_time(messages.TEST, self.cpu), "cpu"))


class _Watch:
    """The two deadlines of one exchange: CPU seconds of the child, and the clock."""

    def __init__(self, cpu: float, wall: float, beside: Beside | None = None) -> None:
        self.cpu, self.wall, self.beside = cpu + SOFT, wall + SOFT, beside

    def over(self, used: float) -> Literal["cpu", "wall"] | None:
        if used > self.cpu:
            return "cpu"
        return "wall" if time.monotonic() > self.wall else None

    def pause(self, used: float) -> float:
        """How long nothing can be over: all cores together cannot use up the CPU time any sooner."""
        left = self.cpu - used if self.beside is None else max(0.01, min(self.cpu - used, self.beside.left))
        return max(0.002, min(self.wall - time.monotonic(), left / CORES))


def _cpu_clock(pidfd: int) -> int | None:
    """The CPU clock of the process behind a pidfd, as clock_gettime takes it (linux/posix-timers.h: ~pid << 3 | 2)."""
    with open(f"/proc/self/fdinfo/{pidfd}", encoding="ascii") as file:
        fields = dict(line.split(":\t") for line in file.read().splitlines() if ":\t" in line)
    pid = int(fields.get("Pid", "-1"))
    return (~pid << 3) | 2 if pid > 0 else None
