"""A notebook's process that lies: whatever it sends, the trusted side stays whole, small and quick, and believes nothing."""

import resource
import struct
import time

import numpy as np
import pytest

from autograder.errors import CallFailed
from autograder.sandbox import Limits, wire

# Takes over the harness inside: frames of the attacker's making go to the grader in place of answers.
TAKE_OVER = """
import os, socket, struct, sys, gc
link = next(o for o in gc.get_objects() if isinstance(o, socket.socket) and o.fileno() == 3)
from autograder.sandbox import wire
def frame(kind, body, exchange=None):
    for o in sys._getframe(0), :
        f = o
        while f is not None and 'exchange' not in f.f_locals or f.f_code.co_name == 'frame': f = f.f_back
    return struct.pack('<BI16s', kind, len(body), f.f_locals['exchange'] if exchange is None else exchange) + body
"""
LIMITS = Limits(cell_cpu=1, call_cpu=0.5, patience=0.5, answer=2**20)


def taken_over(sandbox, source):
    session = sandbox.open(limits=LIMITS)
    assert session.run_cell(TAKE_OVER + source).status == "ok"
    return session


def attempt(session, arguments=(1.0,)):
    """The answer or the failure of calling f, and the session's end."""
    with session:
        try:
            answer = session.call("f", arguments)
        except CallFailed as failure:
            answer = failure
        return answer, session.ended


REFUSED = {
    "garbage": "link.sendall(os.urandom(100_000))",
    "unknown kind": "link.sendall(frame(200, b'N'))",
    "a request in place of an answer": "link.sendall(frame(wire.CALLS, b'N'))",
    "four gigabytes announced": "link.sendall(struct.pack('<BI16s', wire.DONE, 2**32 - 1, bytes(16)))",
    "another exchange": "link.sendall(frame(wire.DONE, wire.encode((True, 1.0)), bytes(16)))",
    "no value": "link.sendall(frame(wire.DONE, b''))",
    "a value of another form": "link.sendall(frame(wire.DONE, wire.encode((True, 1.0, 'score', 100))))",
    "a score": "link.sendall(frame(wire.DONE, wire.encode((1, 100))))",
    "a pickle": "import pickle; link.sendall(frame(wire.DONE, pickle.dumps(print)))",
    "a failure of unknown kind": "link.sendall(frame(wire.DONE, wire.encode((False, 'passed', '', '', (), None, ''))))",
    "a failure with a huge line": "link.sendall(frame(wire.DONE, wire.encode((False, 'error', '', '', (), 2**60, ''))))",
    "a negative shape": "link.sendall(frame(wire.DONE, b't\\2\\0\\0\\0Ta\\1\\1' + struct.pack('<q', -5)))",
    "an array larger than its frame": "link.sendall(frame(wire.DONE, b't\\2\\0\\0\\0Ta\\1\\1' + struct.pack('<q', 10**12)))",
    "nested tuples": "link.sendall(frame(wire.DONE, b't\\1\\0\\0\\0' * 90_000))",
    "bytes": "link.sendall(frame(wire.DONE, wire.encode((True, b'x'))))",
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_forged_answers_are_refused_and_the_process_is_ended(sandbox, name):
    session = taken_over(sandbox, f"def f(x):\n    {REFUSED[name]}\n    import time; time.sleep(60)")
    failure, ended = attempt(session)
    assert isinstance(failure, CallFailed)
    assert failure.kind == "refused"
    assert ended.limit == "protocol"
    assert "sent something that is no answer" in failure.message


def test_an_answer_sent_early_is_only_an_answer(sandbox):
    """Anything in the child can be forged; a forged value is compared like any other. The true one after it is a breach."""
    session = taken_over(sandbox, "def f(x):\n    link.sendall(frame(wire.DONE, wire.encode((True, 7.5))))\n    return 1.0")
    with session:
        assert session.call("f", [1.0]) == 7.5
        with pytest.raises(CallFailed, match="no answer"):
            session.call("f", [2.0])


def test_a_true_answer_after_all_this_is_taken(sandbox):
    session = taken_over(sandbox, "def f(x): return x + 1")
    assert attempt(session)[0] == 2.0


@pytest.mark.parametrize(
    "source",
    [
        "def f(x):\n    data = bytes(2**20)\n    while True: link.sendall(data)",
        "def f(x):\n    link.sendall(struct.pack('<BI16s', wire.DONE, 10**6, bytes(16)))\n    while 1: link.sendall(bytes(9))",
        "def f(x):\n    import time\n    for i in range(10**6): link.sendall(b'A'); time.sleep(0.01)",
    ],
    ids=["flood", "small pieces", "drip"],
)
def test_floods_and_drips_end_at_the_deadline_and_cost_no_memory(sandbox, source):
    session = taken_over(sandbox, source)
    before, began, used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.monotonic(), time.process_time()
    failure, _ = attempt(session)
    assert failure.kind in ("refused", "timeout")
    assert time.monotonic() - began < 60  # the drip would take hours
    assert time.process_time() - used < 5
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 20_000  # kB


def test_a_child_that_does_not_read_its_question(sandbox):
    """The question is larger than the socket holds."""
    session = taken_over(
        sandbox, "import threading, time\ndef f(x): return 0\nwire.header = lambda *a: time.sleep(100)\ndef g(): return 0"
    )
    with session:
        session._process._send(wire.frame(wire.CALLS, bytes(16), b"N"), session._action("this call", 1, LIMITS, 100))
        with pytest.raises(CallFailed) as caught:
            session.call("f", [np.zeros(10**7)])
    assert caught.value.kind == "timeout"


def test_forged_outputs_of_a_cell_are_refused(sandbox):
    for body in (
        "wire.encode(('ok', 1, (('stream', 'stdout', 5),), ()), depth=6)",
        "wire.encode('ok')",
        "wire.encode(('passed', 1, (), ()))",
    ):
        with sandbox.open(limits=LIMITS) as session:
            result = session.run_cell(TAKE_OVER + f"link.sendall(frame(wire.DONE, {body}))")
            assert result.status == "refused"
            assert result.outputs == []


def test_forged_files_cannot_leave_their_folder(sandbox):
    names = [
        "../up",
        "/abs",
        "a/../b",
        "a//b",
        "",
        ".",
        "nul\\0",
        "good",
        "good/inside",
        "x" * 5000,
        "back\\\\slash",
        "/".join(["é" * 120] * 5),
    ]
    source = f"import autograder.sandbox.guest.child as c\nc.Server.files = lambda self: [(n, b'x') for n in {names!r}]"
    with taken_over(sandbox, source) as session:
        assert session.files() == {"good/inside": b"x"}


def test_more_files_than_announced_are_a_breach(sandbox):
    source = "import autograder.sandbox.guest.child as c\nc.Server.files = lambda self: [(str(i), b'') for i in range(90_000)]"
    with taken_over(sandbox, source) as session:
        assert session.files() == {}
        assert session.ended.kind == "refused"


def test_everything_patched_inside_changes_nothing_outside(sandbox):
    """A learner who replaces numpy's comparison, the harness's statuses and print earns nothing but an odd notebook."""
    source = (
        "import numpy as np\nnp.allclose = lambda *a, **k: True\nnp.array_equal = np.allclose\ndef f(x): return np.zeros(3)"
    )
    with taken_over(sandbox, source) as session:
        assert session.call("f", [1.0]).tolist() == [0, 0, 0]
    assert not np.allclose(0, 1)


def test_header_layout_is_what_the_forger_here_writes():
    """The forged frames above are well-formed, so that they fail for what they say and not for how they are written."""
    assert wire.HEADER.format == "<BI16s"
    assert wire.frame(wire.DONE, b"e" * 16, b"N") == struct.pack("<BI16s", wire.DONE, 1, b"e" * 16) + b"N"
