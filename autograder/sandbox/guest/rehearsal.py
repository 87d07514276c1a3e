"""What every notebook's process would do for the first time, done once in the zygote: nothing of it is left but its speed.

The first time costs most: modules are imported, files of tracebacks read and parsed, tables filled. So cells run here as they
will there: right ones, failing ones, and tests whose functions are another process's.
"""

from __future__ import annotations

import asyncio
import codecs
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from autograder.sandbox import wire
from autograder.sandbox.guest import child, tracebacks
from autograder.sandbox.guest.peer import Peer
from autograder.sandbox.guest.shell import Shell

CELLS = (
    "import numpy as np",
    "# a comment\ndef double(v):\n    return 2 * np.asarray(v, float)\n\nclass Pair:\n    a: int = 1",
    "for k in range(3):\n    print(k, f'{k:.2f}')",
    "np.linalg.norm(np.array([3.0, 4.0]))",
    "float(double([1.0, 2.0])[0])",
    "assert np.isclose(double(1), 2) and np.allclose(double([[0, 1], [1, 2]]), [[0, 2], [2, 4]])",
    "{k: str(k) for k in range(3)}",
)
TESTS = (
    "assert np.isclose(scaled(2.0), 4.0)\nassert np.allclose(scaled(np.array([1.0, 2.0])), [2, 4])",
    "assert scaled([1]) == [1, 1] and scaled(3) == 6 and scaled((1, 2)) != {1: 'a'}",
    "float(table(abs, 3)[2] == 2)",
)
FAILING = (
    "1 / 0",
    "not_there",
    "assert np.isclose(double(1), 3), 'twice'",
    "assert np.allclose(scaled([1, 2]), 1)",
    "scaled({})",
)
PLOT = (  # a traceback through the library reads its files, and colours the functions on its way
    "__import__('directrix.plot').plot.view(lambda u, w: u + w)",
    "__import__('directrix.plot').plot.view(lambda u, w: 1 / 0)",
)


def rehearse(shell: Shell) -> None:
    """What nearly every notebook does; the shell, the random numbers' order and the signals are afterwards as before."""
    codecs.lookup("ascii")
    loop = asyncio.new_event_loop()
    loop.call_soon(loop.stop)
    loop.run_forever()
    loop.close()
    child._reseed(0, 0)
    with _as_in_a_notebook(shell):
        for source in CELLS:
            shell.rehearse(source)
        answer = ("ok", 1, *shell.shown())
        wire.decode(wire.encode(answer, depth=child.RESULT_DEPTH), depth=child.RESULT_DEPTH)
        _know_tests(shell)
        for source in TESTS:
            shell.rehearse(source)


def failures(shell: Shell) -> Iterator[None]:
    """What fails in some notebooks, one cell at a step, and nothing is left of it in between: a traceback through a library
    parses whole files, and nobody should have to wait until that is done for all of them.
    """
    plot = PLOT if "directrix.plot" in sys.modules else ()
    for source in (*FAILING, *tracebacks.NUMPY, *plot):
        with _as_in_a_notebook(shell):
            shell.rehearse(CELLS[1])
            _know_tests(shell)
            shell.rehearse(source)
        yield


@contextmanager
def _as_in_a_notebook(shell: Shell) -> Iterator[None]:
    handlers = {number: signal.getsignal(number) for number in (signal.SIGPROF, signal.SIGALRM)}
    try:
        with shell.rehearsing(), child.Timed(60.0, 60.0):
            yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)


def _know_tests(shell: Shell) -> None:
    tests = _tests()
    shell.user_ns.update({name: tests.value(name) for name in ("scaled", "table")})


def _tests() -> Peer:
    """The tests' end of a line to a learner's process that is this one."""

    def scaled(value: Any) -> Any:
        return 2 * value

    def table(function: Any, count: int) -> dict[int, Any]:
        return {k: function(k) for k in range(count)}

    here, there = _Line(), _Line()
    here.other, there.other = there, here
    tests, learner = Peer(here, child._nothing), Peer(there, {"scaled": scaled, "table": table}.__getitem__)  # type: ignore[arg-type]
    here.answers, there.answers = learner, tests
    return tests


class _Line:
    """A socket whose other end answers when its answer is asked for."""

    other: _Line
    answers: Peer  # at the other end

    def __init__(self) -> None:
        self.arrived = bytearray()

    def sendall(self, data: bytes) -> None:
        """Lay it before the other end."""
        self.other.arrived += data

    def recv(self, count: int) -> bytes:
        """What has arrived; the other end says something first where nothing has."""
        if not self.arrived:
            self.answers._serve_one(*self.answers._receive())
        data = bytes(self.arrived[:count])
        del self.arrived[:count]
        return data
