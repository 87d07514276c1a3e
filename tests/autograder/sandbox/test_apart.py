"""Test cells in one process, the learner's code in another: what crosses, what does not, and what a learner can do about it."""

import contextlib
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from autograder.sandbox import Limits, Policy, Sandbox
from autograder.sandbox.guest import crossing
from autograder.sandbox.guest.crossing import CannotCross, Functions

QUICK = Limits(cell_cpu=1.0, patience=3.0)


@pytest.fixture
def pair(sandbox):
    learner, tests = sandbox.pair(limits=QUICK)
    with learner, tests:
        yield learner, tests


def ask(pair, solution, test, *names):
    """The result of a test cell about what a solution cell binds."""
    learner, tests = pair
    assert learner.run_cell(solution).status == "ok"
    return tests.run_apart(test, names, learner)


def shown(result):
    """What the cell's last expression was, or how it failed."""
    last = result.outputs[-1] if result.outputs else {}
    return last.get("data", {}).get("text/plain", last.get("evalue", ""))


PLAIN = """
import functools, numpy as np
def square(x):
    "Squares."
    return [v * v for v in x] if isinstance(x, list) else x * x
def again(f, xs): return [f(x) for x in xs]
def adder(n): return lambda y: y + n
def fails(x): raise KeyError("no", x)
class Own(ValueError): pass
def own(): raise Own("mine", object())
def noisy():
    import sys, warnings
    print("to stdout"); print("to stderr", file=sys.stderr)
    return 1
table = {"a": [1, (2.5, {3})], "b": np.arange(3, dtype="u8"), "c": np.float32(1.5)}
"""
GOOD = [
    ("square(3)", "9"),
    ("square([1, 2])", "[1, 4]"),
    ("(square.__name__, square.__doc__, callable(square))", "('square', 'Squares.', True)"),
    ("type(square(np.float32(2)))", "numpy.float32"),
    ("square(10**30) == 10**60", "True"),
    ("again(lambda x: -x, range(5))", "[0, -1, -2, -3, -4]"),
    ("again(square, [2])", "[4]"),
    ("adder(3)(4)", "7"),
    ("table", "{'a': [1, (2.5, {3})],\n 'b': array([0, 1, 2], dtype=uint64),\n 'c': np.float32(1.5)}"),
]


@pytest.mark.parametrize(("test", "expected"), GOOD)
def test_values_and_types_cross_as_they_are(pair, test, expected):
    names = ("square", "again", "adder", "table")
    result = ask(pair, PLAIN, f"import numpy as np\n{test}", *names)
    assert (result.status, shown(result)) == ("ok", expected)


def test_builtin_errors_are_raised_again_and_others_as_the_nearest_builtin_one(pair):
    test = "try: {}\nexcept {} as error: print(repr(error.args[0]), getattr(error, '__notes__', ''))"
    first = ask(pair, PLAIN, test.format("fails(1)", "KeyError"), "fails")
    assert first.outputs[0]["text"] == "'no' \n"
    second = ask(pair, PLAIN, test.format("own()", "ValueError"), "own")
    assert second.status == "ok"
    assert "(raised as Own)" in second.outputs[0]["text"]


def test_what_the_learners_function_prints_is_printed_by_the_test(pair):
    result = ask(pair, PLAIN, "noisy()", "noisy")
    assert [(o.get("name"), o.get("text")) for o in result.outputs[:2]] == [
        ("stdout", "to stdout\n"),
        ("stderr", "to stderr\n"),
    ]


def test_every_test_cell_meets_its_own_warnings(pair):
    learner, tests = pair
    learner.run_cell("import warnings\ndef f():\n    warnings.warn('look')\n    return 1")
    for _ in range(2):
        assert "UserWarning: look" in tests.run_apart("f()", ["f"], learner).outputs[0]["text"]


def test_the_test_sees_what_the_learner_has_bound_last_and_loses_what_is_gone(pair):
    learner, tests = pair
    learner.run_cell("x = 1")
    assert shown(tests.run_apart("x", ["x"], learner)) == "1"
    learner.run_cell("x = 2")
    assert shown(tests.run_apart("x", ["x"], learner)) == "2"
    learner.run_cell("del x")
    assert "not defined" in shown(tests.run_apart("x", ["x"], learner))


LEAVES_ALONE = [
    ("def f(xs): xs.sort()", "data = [3, 1, 2]\nf(data)", "data", "[1, 2, 3]"),
    ("def f(xs): return list(xs)", "data = [3, 1, 2]\nf(data)", "data", "[3, 1, 2]"),
    ("def f(x):\n    x += 1\n    return x", "import numpy as np\ndata = np.zeros(2)\nf(data)", "data.tolist()", "[1.0, 1.0]"),
    ("def f(x): x['b'] = x.pop('a')", "data = {'a': 1}\nf(x=data)", "data", "{'b': 1}"),
    ("def f(x): x[0][1].add(5)", "inner = {4}\ndata = [(1, inner)]\nf(data)", "sorted(inner)", "[4, 5]"),
    ("def f(x): x.append(x[0](1))", "data = [abs]\nf(data)", "data[1:], data[0] is abs", "([1], True)"),
    ("def f(x):\n    x[:] = [0]\n    raise ValueError", "data = [1]\ntry: f(data)\nexcept ValueError: pass", "data", "[0]"),
    ("def f(g):\n    kept = []\n    g(kept)\n    return kept", "data = f(lambda xs: xs.append(7))", "data", "[7]"),
]


@pytest.mark.parametrize(("solution", "test", "look", "expected"), LEAVES_ALONE)
def test_what_a_function_does_to_its_arguments_is_seen_by_the_test(pair, solution, test, look, expected):
    result = ask(pair, solution, f"{test}\n{look}", "f")
    assert (result.status, shown(result)) == ("ok", expected)


def test_an_array_that_must_not_be_written_is_not(pair):
    result = ask(pair, "def f(x): x[0] = 5", "import numpy as np\nx = np.zeros(2)\nx.flags.writeable = False\nf(x)", "f")
    assert result.status == "error"
    assert "read-only" in shown(result)


LOOKS_INSIDE = [
    "import inspect\nassert 'for' not in inspect.getsource(f)",
    "assert 'sorted' not in f.__code__.co_names",
    "import inspect\nassert 'key' not in inspect.signature(f).parameters",
    "import dis\nassert not [i for i in dis.get_instructions(f) if i.opname == 'FOR_ITER']",
    "assert f.__defaults__ is None",
    "try:\n    assert 'for' not in str(f.__code__.co_code)\nexcept:\n    pass",
]


@pytest.mark.parametrize("test", LOOKS_INSIDE)
def test_a_test_that_reads_the_function_instead_of_calling_it_cannot_pass_apart(pair, test):
    """Apart it would read the stand-in, whoever's function it is; so it is found to need the learner's process."""
    assert ask(pair, "def f(xs): return xs", test, "f").status == "error"


def test_a_function_keeps_its_number_from_one_test_cell_to_the_next(pair):
    learner, tests = pair
    learner.run_cell("def second(): return 'second'")
    tests.run_apart("kept = second", ["first", "second"], learner)
    learner.run_cell("def first(): return 'first'")
    assert shown(tests.run_apart("kept()", ["first", "second"], learner)) == "'second'"


@pytest.mark.parametrize("error", ["StopIteration", "StopAsyncIteration", "GeneratorExit"])
def test_an_error_that_would_end_a_loop_over_the_cases_does_not(pair, error):
    test = "assert all(map(lambda x: f(x) == x * x, [1, 2]))\nfor y in map(f, [1]): assert y == 1"
    assert ask(pair, f"def f(x): raise {error}", test, "f").status == "error"


def test_a_result_that_came_about_without_an_answer_is_none(pair):
    """The mark of a cell is what it returns: a bare ``except`` must not make points of an answer that cannot cross."""
    result = ask(pair, "def f(x): return object()", "try:\n    f(-1)\nexcept:\n    points = 2\npoints", "f")
    assert result.status == "error"
    assert [output["output_type"] for output in result.outputs] == ["error"]


def test_a_test_that_fails_in_what_it_handed_over_lets_the_learners_process_go_on(pair):
    learner, _ = pair
    result = ask(pair, "def f(g): return g(1)", "def g(x): return object()\nf(g)", "f")
    assert result.status == "error"
    assert learner.alive
    assert learner.run_cell("1").status == "ok"


CALLED = [
    "from functools import lru_cache\n@lru_cache\ndef f(x): return x if x < 2 else f(x - 1) + f(x - 2)",
    "import numpy as np\nf = np.vectorize(lambda x: [0, 1, 1, 2, 3, 5][x])",
    "class F:\n    def __call__(self, x): return [0, 1, 1, 2, 3, 5][x]\nf = F()",
    "import operator, functools\nf = functools.partial(operator.getitem, [0, 1, 1, 2, 3, 5])",
]


@pytest.mark.parametrize("solution", CALLED, ids=["lru_cache", "vectorize", "__call__", "partial"])
def test_whatever_can_be_called_crosses_as_a_function(pair, solution):
    test = "assert callable(f) and [f(x) for x in range(6)] == [0, 1, 1, 2, 3, 5]\n[int(y) for y in map(f, [4, 5])]"
    result = ask(pair, solution, test, "f")
    assert (result.status, shown(result)) == ("ok", "[3, 5]")


CATCHALL = "try:\n    {}\nexcept {}:\n    pass\n"
LOST = [
    ("def f(): return object()", "f()", "the answer is an object of type object, which cannot leave the notebook"),
    ("f = object()", "f + 1", "f is an object of type object"),
    ("f = object()", "f == 3", "f is an object of type object"),
    ("f = object()", "f.anything", "f is an object of type object"),
    ("def f():\n    while True: pass", "f()", "is there a loop that never ends"),
    ("def f():\n    import os; os._exit(0)", "f()", "ended"),
]


@pytest.mark.parametrize(("solution", "use", "why"), LOST)
@pytest.mark.parametrize("caught", ["Exception", "BaseException"])
def test_a_test_does_not_pass_for_want_of_an_answer(pair, solution, use, why, caught):
    """A test that expects an error (``except``, ``pytest.raises``) must not take a missing answer for it."""
    result = ask(pair, solution, CATCHALL.format(use, caught), "f")
    assert result.status != "ok"
    assert why in (result.note or shown(result))


def test_what_the_test_hands_over_must_cross_too(pair):
    result = ask(pair, "def f(x): return x", "class Special: pass\nf(Special())", "f")
    assert result.status == "error"
    assert "an object of type Special, which cannot go to the learner" in shown(result)


def test_a_learners_process_that_hangs_in_c_is_ended_and_the_test_fails(pair):
    learner, tests = pair
    learner.run_cell("import itertools\ndef f():\n    return all(itertools.repeat(True))")
    result = tests.run_apart("f()", ["f"], learner, limits=Limits(cell_cpu=0.5, patience=20.0))
    assert result.status != "ok"
    assert not learner.alive


FORGE = """
import os, stat
def _sockets():  # to the grader, to the tests, then the two of the event loop
    found = []
    for number in range(3, 64):
        try:
            if stat.S_ISSOCK(os.fstat(number).st_mode): found.append(number)
        except OSError: pass
    return found
def _frame(kind, body, exchange=bytes(16)):
    import struct
    return struct.pack("<BI16s", kind, len(body), exchange) + body
"""


def test_the_tests_cannot_be_read_patched_or_forged(pair):
    """Each of these wins under a shared interpreter; see ``test_the_same_tricks_win_in_a_shared_interpreter``."""
    for trick, wrong in TRICKS:
        result = ask(pair, trick, TEST, *wrong)
        assert result.status == "error", trick


TEST = """
import numpy as np
def _ref(x): return x * x + 1
np.testing.assert_allclose(f(3), _ref(3))
assert f(3) == _ref(3)
"""
TRICKS = [
    ("import numpy as np\nnp.testing.assert_allclose = lambda *a, **k: None\ndef f(x): return 10.0000000001", ("f",)),
    ("def f(x):\n    import sys\n    return sys._getframe(1).f_globals['_ref'](x)", ("f",)),
    ("def f(x):\n    return next(v for v in globals().get('In', []) if '_ref' in v)", ("f",)),
    ("class Same(float):\n    __eq__ = lambda s, o: True\n    __hash__ = None\ndef f(x): return Same(10)", ("f",)),
    ("import builtins\nbuiltins.abs = lambda x: 0\n_ref = lambda x: 0\ndef f(x): return 0", ("f",)),
    ("get_ipython().run_cell = lambda *a, **k: None\ndef f(x): return 0", ("f",)),
]
SHARED = TRICKS[:1] + TRICKS[1:2] + TRICKS[3:4]


@pytest.mark.parametrize("trick", [trick for trick, _ in SHARED])
def test_the_same_tricks_win_in_a_shared_interpreter(sandbox, trick):
    with sandbox.open() as session:
        session.run_cell(trick)
        tests = TEST.replace("assert f(3) == _ref(3)\n", "") if "assert_allclose" in trick else TEST
        tests = tests.replace("np.testing.assert_allclose(f(3), _ref(3))", "") if "Same" in trick else tests
        assert session.run_cell(tests).status == "ok"


def test_a_learner_cannot_ask_for_the_names_of_the_tests(pair):
    """The socket is the learner's to misuse: it asks for the reference while the test waits for its answer."""
    solution = FORGE + (
        "from autograder.sandbox import wire\n"
        "def f(x):\n"
        "    peer = _sockets()[1]\n"
        "    os.write(peer, _frame(wire.NAME, wire.encode(('_ref',)), b'e' * 16))\n"
        "    import socket; s = socket.socket(fileno=os.dup(peer))\n"
        "    return repr(s.recv(2000))\n"
    )
    result = ask(pair, solution, "def _ref(x): return 'the answer is 42'\nf(1)", "f")
    assert "KeyError" in shown(result)
    assert "42" not in shown(result)


@pytest.mark.parametrize(
    "bytes_sent",
    ["b'garbage' * 100", "_frame(100, b'')", "_frame(1, b'N')", "_frame(97, bytes(100))", "_frame(200, b'')[:5]"],
)
def test_what_is_no_answer_fails_the_cell_and_nothing_else(sandbox, bytes_sent):
    learner, tests = sandbox.pair(limits=QUICK)
    with learner, tests:
        learner.run_cell(FORGE + f"def f(x):\n    os.write(_sockets()[1], {bytes_sent})\n    return 7")
        result = tests.run_apart("f(1)", ["f"], learner)
        assert result.status != "ok" or shown(result) == "7"
    with sandbox.open() as session:
        assert session.run_cell("1").status == "ok"


def test_a_withheld_module_is_there_for_the_tests_only():
    policy = Policy(packages=("numpy", "plotly", "dateutil"), preload=())
    look = "import glob, sys\n[p for folder in sys.path for p in glob.glob(folder + '/dateutil/*')]"
    with Sandbox(policy) as box:
        learner, tests = box.pair(withhold=["dateutil"])
        with learner, tests:
            assert learner.run_cell("import dateutil.parser").status == "error"
            assert shown(learner.run_cell(look)) == "[]"
            learner.run_cell("def year(text):\n    import dateutil.parser\n    return dateutil.parser.parse(text).year")
            test = "import dateutil.parser\nassert dateutil.parser.parse('2020-01-02').year == 2020\nyear('2020-01-02')"
            result = tests.run_apart(test, ["year"], learner)
            assert result.outputs[-1]["ename"] in ("ModuleNotFoundError", "ImportError", "AttributeError")


def test_what_the_sandbox_itself_uses_cannot_be_withheld(sandbox):
    with pytest.raises(Exception, match=re.escape("numpy cannot be withheld")):
        sandbox.open(withhold=["numpy"])


def there_and_back(value):
    """Through the wire's bytes."""
    from autograder.sandbox import wire

    sent = wire.encode(crossing.pack(value, Functions(None)), depth=crossing.WIRE_DEPTH)
    return crossing.unpack(wire.decode(sent, depth=crossing.WIRE_DEPTH, raw=True), Functions(None))


scalars = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(allow_nan=False), st.complex_numbers(allow_nan=False), st.binary(),
    st.text(st.characters(codec="utf-8")), st.sampled_from([..., int, ValueError, range(3, 9, 2), slice(None, 4)]),
)  # fmt: skip
keys = st.one_of(st.integers(), st.text(st.characters(codec="utf-8"), max_size=5))
values = st.recursive(
    scalars,
    lambda inner: st.lists(inner) | st.tuples(inner, inner) | st.dictionaries(keys, inner) | st.frozensets(keys),
    max_leaves=12,
)


@given(values)
def test_plain_data_crosses_unchanged(value):
    back = there_and_back(value)
    assert back == value
    assert type(back) is type(value)


DTYPES = st.one_of(
    arrays.boolean_dtypes(), arrays.integer_dtypes(), arrays.unsigned_integer_dtypes(),
    arrays.floating_dtypes(sizes=(16, 32, 64)), arrays.complex_number_dtypes(sizes=(64, 128)), arrays.datetime64_dtypes(),
    arrays.unicode_string_dtypes(max_len=5),
)  # fmt: skip


@given(arrays.arrays(DTYPES, arrays.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=3)))
def test_arrays_cross_unchanged(array):
    back = there_and_back(array)
    assert back.dtype == array.dtype
    assert back.shape == array.shape
    assert back.tobytes() == array.tobytes()
    assert back.flags.writeable


@given(st.recursive(scalars, lambda inner: st.tuples(inner) | st.tuples(st.sampled_from("=ic[{:.astxfme"), inner, inner)))
def test_whatever_arrives_is_a_value_or_refused(form):
    with contextlib.suppress(CannotCross):
        crossing.unpack(form, Functions(None))


def test_containers_too_deep_and_objects_do_not_cross():
    deep = []
    for _ in range(crossing.DEPTH + 1):
        deep = [deep]
    for value in (deep, object(), np.array([object()]), np.ma.array([1]), type("Mine", (int,), {})(3), __import__("os")):
        with pytest.raises(CannotCross):
            crossing.pack(value, Functions(None))


def test_a_number_of_no_function_is_refused():
    with pytest.raises(CannotCross, match="never handed over"):
        crossing.unpack(("m", 3), Functions(None))
