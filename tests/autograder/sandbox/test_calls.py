"""Calls of learners' functions: values in, values out, and a helpful account of what went wrong."""

import time

import numpy as np
import pytest

from autograder.curvedata import CurveData, SurfaceData
from autograder.errors import CallFailed, SandboxError
from autograder.returned import Foreign
from autograder.sandbox import Limits

CURVE = CurveData([0, 1], np.array([[[1.0, 0, 0], [0, 2, 0]]]))


def define(session, source):
    assert session.run_cell(source).status == "ok"


def failed(session, name="f", arguments=()):
    with pytest.raises(CallFailed) as caught:
        session.call(name, arguments)
    return caught.value


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("None", None),
        ("True", True),
        ("np.bool_(True)", True),
        ("3", 3),
        ("np.int64(3)", 3),
        ("2.5", 2.5),
        ("np.float32(2.5)", 2.5),
        ("'cone'", "cone"),
        ("np.str_('cone')", "cone"),
        ("(1, 'a', (2.0,))", (1, "a", (2.0,))),
        ("['a', 1]", ["a", 1]),
        ("2**70", 2.0**70),
    ],
)
def test_plain_answers(session, expression, expected):
    define(session, f"import numpy as np\ndef f(): return {expression}")
    answer = session.call("f", [])
    assert (type(answer), answer) == (type(expected), expected)


@pytest.mark.parametrize(
    "expression",
    [
        "np.arange(6.0).reshape(2, 3)",
        "[[0, 1.0, 2], [3, 4, 5]]",
        "[np.arange(3), np.arange(3.0, 6)]",
        "np.matrix([[0, 1.0, 2], [3, 4, 5]])",
        "np.arange(6, dtype='f2').reshape(2, 3)",
        "np.ma.array(np.arange(6.0).reshape(2, 3))",
    ],
)
def test_arrays_and_lists_of_numbers_are_arrays(session, expression):
    define(session, f"import numpy as np\ndef f(): return {expression}")
    answer = session.call("f", [])
    assert type(answer) is np.ndarray
    assert np.array_equal(answer, np.arange(6.0).reshape(2, 3))


def test_arguments_arrive_in_order_arrays_read_only_and_curves_callable(session):
    define(
        session,
        "def f(u, curve, name, pair):\n    return u.flags.writeable, curve(u), name, pair[1], type(curve).__name__",
    )
    u = np.array([0.0, 0.5])
    writable, points, name, second, kind = session.call("f", [u, CURVE, "x", (1, 2)])
    assert (writable, name, second, kind) == (False, "x", 2, "CurveData")
    assert np.array_equal(points, CURVE(u))


def test_a_surface_can_be_asked_where_it_is_and_tells_nothing_else(session):
    """Evaluated in the child from numbers alone, on single numbers and on an open mesh."""
    surface = SurfaceData(np.arange(18.0).reshape(2, 3, 3))
    define(session, "import numpy as np\nt = np.linspace(0, 1, 5)\ndef f(s): return s(0.25, 0.5), s(t[:, None], t[None, :2])")
    one, mesh = session.call("f", [surface])
    t = np.linspace(0, 1, 5)
    assert np.array_equal(one, surface(0.25, 0.5))
    assert np.array_equal(mesh, surface(t[:, None], t[None, :2]))


def test_an_argument_changed_in_place_is_an_error_at_its_line(session):
    define(session, "def f(u):\n    u *= 2\n    return u")
    failure = failed(session, arguments=[np.arange(3.0)])
    assert (failure.kind, failure.exception, failure.line, failure.source) == ("error", "ValueError", 2, "u *= 2")


def test_an_argument_cannot_be_made_writable(session):
    define(session, "def f(u):\n    u.flags.writeable = True\n    return u")
    assert failed(session, arguments=[np.arange(3.0)]).exception == "ValueError"


def test_an_error_tells_class_bases_message_line_and_source(session):
    define(session, "class Odd(KeyError): pass\n\ndef helper():\n    raise Odd('what')\n\ndef f():\n    return helper()")
    failure = failed(session)
    assert (failure.kind, failure.exception, failure.line, failure.source) == ("error", "Odd", 4, "raise Odd('what')")
    assert failure.bases[:3] == ("Odd", "KeyError", "LookupError")
    assert failure.message == "'what'"


def test_an_error_inside_numpy_points_to_the_learners_line(session):
    define(session, "import numpy as np\ndef f():\n    a = 1\n    return np.stack([np.zeros(2), np.zeros(3)])")
    failure = failed(session)
    assert (failure.exception, failure.line) == ("ValueError", 4)


@pytest.mark.parametrize(
    "what",
    [
        "raise SystemExit(0)",
        "raise KeyboardInterrupt",
        "import sys; sys.exit()",
        "exit_ = 1; raise BaseException('x')",
        "raise GeneratorExit",
    ],
)
def test_leaving_is_an_error_like_any_other(session, what):
    define(session, f"def f():\n    {what}\ndef g(): return 1")
    assert failed(session).kind == "error"
    assert session.call("g", []) == 1


def test_endless_recursion_is_an_error(session):
    define(session, "def f(): return f()")
    assert failed(session).exception == "RecursionError"


def test_an_exception_that_cannot_be_shown(session):
    define(session, "class E(Exception):\n    def __str__(self): raise ValueError\ndef f(): raise E")
    assert failed(session).message == "(its message cannot be shown)"


@pytest.mark.parametrize(
    ("source", "said"), [("f = 5", "of type int"), ("pass", "defines no function called f"), ("f = None", "NoneType")]
)
def test_a_missing_function(session, source, said):
    define(session, source)
    failure = failed(session)
    assert failure.kind == "missing"
    assert said in failure.message


@pytest.mark.parametrize(
    ("expression", "kind", "text"),
    [
        ("{}", "object", "dict"),
        ("print", "function", "builtin_function_or_method"),
        ("np.ma.array([1.0, 2.0], mask=[True, False])", "masked", "MaskedArray"),
        ("np.datetime64('2020-01-01')", "object", "datetime64"),
        ("np.zeros(2**22)", "large", "4194304"),
        ("type('A' * 300, (), {})()", "object", "A" * 100),
    ],
)
def test_what_cannot_cross_is_told_by_its_kind(session, expression, kind, text):
    define(session, f"import numpy as np\ndef f(): return {expression}")
    assert session.call("f", []) == Foreign(kind, text)


def test_an_answer_of_too_many_bytes_is_refused(session):
    define(session, "import numpy as np\ndef f(): return (np.zeros(10**6),) * 3")
    failure = failed(session)
    assert failure.kind == "refused"
    assert "bytes; at most" in failure.message


def test_an_answer_of_too_many_parts_costs_that_call_only(session):
    """A list of lists of texts: what the trusted side would not read is not sent."""
    define(session, "def f(): return [[None] * 900] * 120\ndef g(): return 1")
    failure = failed(session)
    assert failure.kind == "refused"
    assert "parts; at most" in failure.message
    assert session.call("g", []) == 1


def test_what_a_call_prints_is_discarded(session):
    """It could tell the hidden arguments."""
    define(
        session,
        "import os, sys\ndef f(x):\n    print(x); print(x, file=sys.stderr); os.write(1, b'secret'); display(x)\n    return x",
    )
    assert session.call("f", [41]) == 41
    assert session.run_cell("pass").outputs == []
    assert session.run_cell("print('seen')").outputs[0]["text"] == "seen\n"


def test_random_numbers_differ_from_call_to_call_and_not_from_run_to_run(sandbox):
    runs = []
    for _ in range(2):
        with sandbox.open() as session:
            define(session, "import numpy as np, random\ndef f(): return random.random(), np.random.rand()")
            runs.append([session.call("f", []) for _ in range(3)])
    assert runs[0] == runs[1]
    assert len(set(runs[0])) == 3


def test_an_argument_that_cannot_be_sent_is_the_graders_fault(session):
    define(session, "def f(x): return x")
    with pytest.raises(SandboxError, match="dict"):
        session.call("f", [{}])


def test_messages_from_inside_have_no_terminal_escapes_and_an_end(session):
    define(session, "def f(): raise ValueError('\\x1b[2J\\u202e' + 'x' * 10_000)")
    message = failed(session).message
    assert "\x1b" not in message
    assert len(message) <= 2000


IN_TURN = """
import numpy as np, time
seen = []
def f(x):
    seen.append(x)
    if x == "stop":
        while True:
            pass
    if x == "fail":
        raise KeyError(x)
    return np.random.random(), len(seen)
def again():
    return len(seen)
"""


def test_calls_in_turn_answer_as_calls_one_by_one_do(sandbox):
    with sandbox.open(seed=3) as one, sandbox.open(seed=3) as other:
        one.run_cell(IN_TURN), other.run_cell(IN_TURN)
        together = one.call_all("f", [[1.0], ["fail"], [2.0]])
        assert [one.call("again", []), together[0], together[2]] == [3, other.call("f", [1.0]), (together[2][0], 3)]
        assert (together[1].kind, together[1].exception, together[1].line) == ("error", "KeyError", 9)
        with pytest.raises(CallFailed):
            other.call("f", ["fail"])
        assert together[2] == other.call("f", [2.0])


def test_calls_in_turn_end_with_the_first_that_runs_out_of_time(sandbox):
    limits = Limits(call_cpu=0.2)
    with sandbox.open(limits=limits) as session:
        session.run_cell(IN_TURN)
        answers = session.call_all("f", [[1.0], ["stop"], [2.0], [3.0]])
        assert [type(answer) for answer in answers] == [tuple, CallFailed]
        assert answers[1].kind == "timeout"
        assert session.call("again", []) == 2
        assert [answer.kind for answer in session.call_all("g", [[1.0], [2.0]])] == ["missing"]


def test_calls_in_turn_of_many_bytes_are_sent_in_several_messages(sandbox):
    with sandbox.open() as session:
        session.run_cell("def f(x):\n    return x + 1")
        sets = [[np.full(3000, float(number))] for number in range(40)]
        assert [float(answer[0]) for answer in session.call_all("f", sets)] == [number + 1.0 for number in range(40)]


def test_calls_in_turn_end_with_the_process(sandbox):
    with sandbox.open() as session:
        session.run_cell("import os\ndef f(x):\n    return x if x < 2 else os._exit(3)")
        answers = session.call_all("f", [[0], [1], [2], [3]])
        assert answers[:2] == [0, 1]
        assert answers[2].kind == "died"
        assert len(answers) == 3
        assert [answer.kind for answer in session.call_all("f", [[0], [1]])] == ["died"]


def test_calls_in_turn_end_at_a_deadline(sandbox):
    with sandbox.open() as session:
        session.run_cell("import time\ndef f(x):\n    time.sleep(0.2)\n    return x")
        answers = session.call_all("f", [[number] for number in range(20)], deadline=time.monotonic() + 0.5)
        assert 1 < len(answers) < 6
        assert answers[-1].kind == "died"
        assert not session.alive


def test_an_answer_to_no_call_ends_calls_in_turn(sandbox):
    """The learner's code writes whole frames itself, and more of them than there are calls."""
    with sandbox.open() as session:
        session.run_cell(
            "import os\nfrom autograder.sandbox import wire\n"
            "def f(x):\n    os.write(3, wire.frame(wire.DONE, b'0' * 16, wire.encode((True, 1.0))))\n    return x"
        )
        answers = session.call_all("f", [[0.0], [1.0]])
        assert [answer.kind for answer in answers] == ["refused"]
        assert not session.alive
