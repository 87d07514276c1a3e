"""One notebook's process: confines itself, then runs cells and calls functions for the trusted side until it is ended.

Code of learners shares this process, so nothing it answers is believed on the other side. Where test cells run apart, two
such processes hold a socket to each other: the learner's (``serve``) and the tests' (``apart``); see :mod:`.peer`.
"""

from __future__ import annotations

import os
import random
import signal
import socket
import stat
import sys
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType, TracebackType
from typing import Any, NoReturn

import numpy as np

from autograder.returned import plainly
from autograder.sandbox import wire
from autograder.sandbox.guest import answers, confine, words
from autograder.sandbox.guest.answers import TimeLimitExceeded
from autograder.sandbox.guest.peer import NoAnswer, Peer, Unreachable
from autograder.sandbox.guest.shell import Shell

ENVIRONMENT = {
    "PATH": "/usr/bin",
    "LANG": "C.UTF-8",
    "USER": "learner",
    "LOGNAME": "learner",
    "MPLBACKEND": "module://matplotlib_inline.backend_inline",
    "OPENBLAS_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "PLOTLY_RENDERER": "plotly_mimetype",
}
RESULT_DEPTH = 6  # of what a cell shows: result, outputs, output, bundle, pair
MAX_REQUEST = 2**30


def main(job: int, level: str, limits: dict[str, Any], scratch: str, programme: bytes, shell: Shell) -> NoReturn:
    """The child's life."""
    os.dup2(job, 3)
    os.closerange(4, 2**20)
    if level == "A-":  # other notebooks may ask what lies where; this name no process knows but this one, nor the zygote
        scratch = f"{scratch}/{os.urandom(16).hex()}"
    link = socket.socket(fileno=3)
    server = Server(link, limits, shell, f"{scratch}/work")
    exchange, (files, environment, seed, withhold) = server.first()
    try:
        facts = confine.confine(level, limits, scratch, programme, lambda: lay_out(files), withhold)
    except BaseException as error:
        link.sendall(wire.frame(wire.DONE, exchange, wire.encode((False, f"{type(error).__name__}: {error}"))))
        os._exit(70)
    if scratch != confine.SCRATCH:
        set_environment(scratch)
    os.environ.update(environment)
    words.install()
    as_a_notebook()
    server.seed = seed
    _reseed(seed, 0)
    link.sendall(
        wire.frame(wire.DONE, exchange, wire.encode((True, level, int(facts["landlock"]), str(facts.get("proc", "")))))
    )
    while True:
        try:
            server.answer()
        except OSError:
            os._exit(wire.LINK_LOST)


class Server:
    """Answers requests."""

    def __init__(self, link: socket.socket, limits: dict[str, Any], shell: Shell, work: str) -> None:
        self.link, self.limits, self.shell, self.work = link, limits, shell, work
        self.seed = 0
        self.calls = 0
        self.peer: Peer | None = None  # the process of the tests, or of the code that they test

    def answer(self) -> None:
        """Read one request and answer it."""
        kind, exchange, request = self.request()
        if kind == wire.CALLS:
            for body in self.calls_in_turn(*request):
                self.link.sendall(wire.frame(wire.DONE, exchange, body))
            return
        if kind == wire.CELL:
            answer: Any = self.cell(*request)
        elif kind == wire.SERVE:
            self.serve(*request)
            answer = None
        elif kind == wire.APART:
            answer = self.apart(*request)
        else:
            answer = tuple(self.files())
        self.link.sendall(wire.frame(wire.DONE, exchange, wire.encode(answer, depth=RESULT_DEPTH)))

    def first(self) -> tuple[bytes, tuple[Any, ...]]:
        """The first request, which may bring a socket along: the one to another notebook's process."""
        data, descriptors, *_ = socket.recv_fds(self.link, wire.HEADER.size, 1, socket.MSG_CMSG_CLOEXEC)
        if descriptors:
            self.peer = Peer(socket.socket(fileno=descriptors[0]), _nothing)  # one for life: functions keep their numbers
        _, length, exchange = wire.header(data + self._receive(wire.HEADER.size - len(data)), MAX_REQUEST)
        return exchange, wire.decode(self._receive(length), depth=RESULT_DEPTH, items=MAX_REQUEST, raw=True)

    def request(self) -> tuple[int, bytes, tuple[Any, ...]]:
        """Read one request: its kind, its exchange and what it asks."""
        kind, length, exchange = wire.header(self._receive(wire.HEADER.size), MAX_REQUEST)
        return kind, exchange, wire.decode(self._receive(length), depth=RESULT_DEPTH, items=MAX_REQUEST, raw=True)

    def _receive(self, count: int) -> bytes:
        data = bytearray()
        while len(data) < count:
            part = self.link.recv(min(count - len(data), 2**20))
            if not part:
                os._exit(0)  # the trusted side has closed its end
            data += part
        return bytes(data)

    def cell(self, source: str, cpu: float, wall: float, output: int, outputs: int) -> tuple[Any, ...]:
        """Run a cell: (status, its number, outputs, updates of earlier displays)."""
        try:
            with Timed(cpu, wall):
                status = self.shell.run(source, output, outputs)
        except TimeLimitExceeded:  # it fell due after the cell, while its outputs were gathered
            status = "timeout"
        return (status, self.shell.number, *self.shell.shown())

    def calls_in_turn(self, name: str, cpu: float, wall: float, limit: int, *sets: tuple[Any, ...]) -> Iterator[bytes]:
        """Call a function of the notebook with one set of arguments after the other, until one call ends so that no later one
        could answer. Each gives an answer in binary form: of (True, what it returned) or of (False, how it failed...)."""
        timed = Timed(cpu, wall)
        for arguments in sets:
            body, kind = self.call(name, arguments, timed, limit)
            yield body
            if kind in wire.FATAL:
                return

    def call(self, name: str, arguments: tuple[Any, ...], timed: Timed, limit: int) -> tuple[bytes, str]:
        """One such call: its answer, and the kind of its failure or nothing."""
        self.calls += 1
        _reseed(self.seed, self.calls)
        body = b""
        with self.shell.silence(), answers.failures(self.shell.is_cell) as failure:
            function = answers.find(self.shell.user_ns, name)
            with timed:
                value = function(*arguments)
            answer = (True, plainly(value))
            if (count := wire.count(answer)) > wire.ITEMS:
                raise answers.Refused(words.say("parts", count=count, most=wire.ITEMS))
            body = wire.encode(answer, depth=wire.DEPTH + 1)
            if len(body) > limit:
                raise answers.Refused(words.say("bytes", count=len(body), most=limit))
        return (wire.encode(tuple(failure)), failure[1]) if failure else (body, "")

    def serve(self, cpu: float, wall: float, output: int) -> None:
        """Let the tests' process call this notebook's functions, until it is done with a cell."""
        assert self.peer is not None
        recorder, left, within = self.shell.recorder, cpu, 0
        recorder.begin(output, 1000)

        def printed() -> tuple[str, str]:
            self.shell.printed_by_c()
            texts = recorder.texts()
            recorder.begin(recorder.left, 1000)
            return texts

        @contextmanager
        def timed() -> Iterator[None]:
            nonlocal left, within
            began, within = time.process_time(), within + 1
            try:
                if within > 1:  # a call back to a call: the time of the first one is running
                    yield
                    return
                with Timed(max(left, 0.01), wall):
                    yield
            finally:
                within -= 1
                left -= time.process_time() - began if not within else 0.0

        self.peer.find, self.peer.printed, self.peer.timed = self.shell.user_ns.__getitem__, printed, timed
        with warnings.catch_warnings():  # which makes every warning fresh again: each test cell meets its own
            self.peer.serve()

    def apart(self, source: str, names: tuple[str, ...], cpu: float, wall: float, output: int, outputs: int) -> tuple[Any, ...]:
        """Run a test cell here whose ``names`` are the other process's: functions stand in for its own, data are copied."""
        assert self.peer is not None
        peer, namespace = self.peer, self.shell.user_ns
        peer.lost.clear()
        try:
            with Timed(cpu, wall), warnings.catch_warnings():
                for name in names:
                    namespace.pop(name, None)
                    try:
                        namespace[name] = peer.value(name)
                    except KeyError:
                        continue
                    except NoAnswer as error:
                        namespace[name] = Unreachable(peer, str(error))
                peer.lost.clear()
                status = self.shell.run(source, output, outputs)
        except TimeLimitExceeded:
            status = "timeout"
        except NoAnswer:  # while the cell's result was shown
            status = "ok"
        finally:
            peer.end()
        if peer.lost and status == "ok":  # the test went on without an answer that it asked for: nor is its result one
            recorder = self.shell.recorder
            recorder.outputs = [output for output in recorder.outputs if output[0] != "execute_result"]
            recorder.error("NoAnswer", peer.lost[0], [f"NoAnswer: {peer.lost[0]}"])
            status = "error"
        return (status, self.shell.number, *self.shell.shown())

    def files(self) -> Iterator[tuple[str, bytes]]:
        """Regular files of the working folder, within the limits; folders deeper than 16 are left out."""
        left, count = int(self.limits["scratch"]), int(self.limits["files"])
        folders = [""]
        while folders:
            inside = folders.pop()
            for name in sorted(os.listdir(f"{self.work}/{inside}")):
                relative = f"{inside}{name}"
                about = os.lstat(f"{self.work}/{relative}")
                if stat.S_ISDIR(about.st_mode) and inside.count("/") < 16:
                    folders.append(f"{relative}/")
                if not stat.S_ISREG(about.st_mode) or about.st_size > left or count < 1:
                    continue
                with open(f"{self.work}/{relative}", "rb") as file:
                    content = file.read(left)
                left, count = left - len(content), count - 1
                yield relative, content


class Timed:
    """Interrupts the code inside when its time is up, so that its traceback shows where it was; may be entered again.

    Code that ignores this (a loop in C, an ``except`` that catches everything) is ended from outside a little later.
    """

    def __init__(self, cpu: float, wall: float) -> None:
        self.cpu, self.wall = cpu, wall
        for number in (signal.SIGPROF, signal.SIGALRM):
            signal.signal(number, self._stop)

    def __enter__(self) -> None:
        signal.setitimer(signal.ITIMER_PROF, self.cpu)
        signal.setitimer(signal.ITIMER_REAL, self.wall)

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None) -> None:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.setitimer(signal.ITIMER_REAL, 0)

    def _stop(self, number: int, frame: FrameType | None) -> None:
        __tracebackhide__ = True
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.setitimer(signal.ITIMER_REAL, 0)
        if number == signal.SIGPROF:
            raise TimeLimitExceeded(words.say("computing", seconds=f"{self.cpu:g}"))
        raise TimeLimitExceeded(words.say("clock", seconds=f"{self.wall:g}"))


def lay_out(files: tuple[tuple[str, bytes], ...]) -> None:
    """Write the notebook's files into the current folder."""
    for name, content in files:
        os.makedirs(os.path.dirname(name) or ".", exist_ok=True)
        with open(name, "wb") as file:
            file.write(content)


def set_environment(scratch: str) -> None:
    """What every notebook finds, and nothing else; done by the zygote where all have the same."""
    os.environ.clear()
    os.environ.update(ENVIRONMENT)
    os.environ.update(
        HOME=f"{scratch}/home", TMPDIR=f"{scratch}/tmp", IPYTHONDIR=f"{scratch}/home", MPLCONFIGDIR=f"{scratch}/home"
    )


def as_a_notebook() -> None:
    """Modules beside the notebook can be imported, and the command line says nothing."""
    sys.path.insert(0, "")
    sys.argv[:] = ["notebook"]


def _nothing(name: str) -> Any:
    """The tests' names are not for the code that they test."""
    raise KeyError(name)


def _reseed(seed: int, number: int) -> None:
    """Each call starts from its own known state: the same in every grading run, another one for every call."""
    random.seed(f"{seed}/{number}")
    np.random.seed((seed * 1_000_003 + number) % 2**32)  # noqa: NPY002 (the learner's global generator is meant)
