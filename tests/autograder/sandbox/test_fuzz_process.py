"""A child that answers with anything: the grader's side of the socket gets a value, or ends the child with a reason."""

import json
import os
import socket
import struct
import subprocess
import tracemalloc

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from autograder.sandbox import Limits, wire
from autograder.sandbox.process import Action, Over, Process
from autograder.sandbox.wire import WireError

MOST = 2**14
ACTION = Action("this call", 0.2, 0.2, MOST, 200)
ANSWERS = [
    (True, 1.5),
    (True, np.arange(12.0).reshape(3, 4)),
    (True, (1, "text", None, False)),
    (False, "error", "ValueError", "no", ("ValueError", "Exception"), 3, "x = 1"),
    ("ok", 1, (("stream", "stdout", "hello"),), ()),
]


class Child:
    """The other end of a process's socket. The process itself has ended already, so that nothing waits for it."""

    def __init__(self):
        ours, self.end = socket.socketpair()
        report, self.report = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.sleeper = subprocess.Popen(["true"])
        pidfd = os.pidfd_open(self.sleeper.pid)
        self.process = Process(ours, report, pidfd, Limits(), "A")
        self.report.send(json.dumps({"cpu": 0.0, "max_rss": 1, "status": 0}).encode())
        os.waitid(os.P_PIDFD, pidfd, os.WEXITED | os.WNOWAIT)

    def __enter__(self):
        return self

    def __exit__(self, *how):
        self.process.close()
        for one in (self.end, self.report):
            one.close()
        self.sleeper.wait()


def frames(data, exchange):
    """What a child might send that knows the protocol and does not mean to keep it."""
    sent = b""
    for _ in range(data.draw(st.integers(1, 3))):
        body = bytearray(wire.encode(data.draw(st.sampled_from(ANSWERS)), depth=6))
        for _ in range(data.draw(st.integers(0, 3))):
            where = data.draw(st.integers(0, len(body)))
            body[where : where + data.draw(st.integers(0, 4))] = data.draw(st.binary(max_size=8))
        length = len(body) + data.draw(st.sampled_from([0, 0, 0, 1, -1, MOST, 2**31]))
        kind = data.draw(st.sampled_from([wire.DONE, wire.DONE, wire.DONE, wire.CALLS, 0, 255]))
        name = data.draw(st.sampled_from([exchange, exchange, exchange, bytes(16)]))
        sent += struct.pack("<BI16s", kind, max(0, min(length, 2**32 - 1)), name) + bytes(body)
    return sent[: data.draw(st.integers(0, len(sent)))] if data.draw(st.booleans()) else sent


@settings(max_examples=200)
@given(data=st.data())
def test_whatever_a_child_sends_is_a_value_or_its_end(data):
    with Child() as child:
        exchange = child.process.post(wire.CALLS, ("f", (1.0,)), ACTION)
        sent = frames(data, exchange)
        child.end.sendall(sent)
        child.end.close()
        tracemalloc.start()
        try:
            value = child.process.take(exchange, ACTION)
        except (Over, WireError):
            value = None
        finally:
            peak = tracemalloc.get_traced_memory()[1]
            tracemalloc.stop()
        assert peak < 64 * (MOST + len(sent)) + 2_000_000
        assert value is None or isinstance(value, (bool, int, float, str, tuple, np.ndarray)) or hasattr(value, "coefficients")


def test_a_true_answer_arrives():
    """Else all of the above might be refused for another reason."""
    with Child() as child:
        exchange = child.process.post(wire.CALLS, ("f", (1.0,)), ACTION)
        child.end.sendall(wire.frame(wire.DONE, exchange, wire.encode((True, 2.5))))
        assert child.process.take(exchange, ACTION) == (True, 2.5)
