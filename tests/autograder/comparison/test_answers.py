import numpy as np
import pytest

from autograder.comparison.answers import Numbers, Raised, Several, Unreadable, Word, ask, read
from autograder.errors import CallFailed, SandboxError


@pytest.mark.parametrize(
    "value", [[1, 2], (1.0, 2), np.float32([1, 2]), np.array([1, 2], dtype=object), [np.float64(1), np.int8(2)]]
)
def test_what_asarray_takes_are_numbers(value):
    answer = read(value)
    assert isinstance(answer, Numbers)
    assert answer.values.dtype == float
    assert answer.values.tolist() == [1.0, 2.0]


@pytest.mark.parametrize(("value", "was"), [(True, "bool"), (np.bool_(False), "bool"), (3, "int"), (2.5, "float")])
def test_single_numbers_remember_what_they_were(value, was):
    answer = read(value)
    assert isinstance(answer, Numbers)
    assert (answer.values.shape, answer.was) == ((), was)


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        (None, "none"),
        (1j, "complex"),
        (np.array([1 + 0j]), "complex"),
        (["1.0", "2.0"], "text"),
        (b"12", "text"),
        ([[1, 2], [3]], "parts"),
        ([[1, 2], [3], [4], [5]], "ragged"),
        ([np.zeros(4), np.zeros(4), 0.0], "parts"),
        (len, "function"),
        ({"x": 1}, "object"),
        ([object()], "object"),
        (np.array([None]), "object"),
        ([1.0, None], "object"),
        (np.datetime64("2026-01-01"), "object"),
    ],
)
def test_what_is_no_array_of_numbers_has_its_reason(value, reason):
    answer = read(value)
    assert isinstance(answer, Unreadable)
    assert answer.reason == reason


def test_an_array_like_whose_conversion_raises_is_an_object():
    class Wrong:
        def __array__(self, dtype=None, copy=None):
            raise RuntimeError

    assert read(Wrong()) == Unreadable("object", {"type": "Wrong"})


def test_a_word_is_a_word():
    assert read("ring") == Word("ring")


def test_parts_are_taken_apart_only_where_several_are_wanted():
    pair = ([[1.0, 2.0]], [3.0])
    assert isinstance(read(pair, whole=False), Several)
    assert isinstance(read(list(pair), whole=False), Several)
    assert isinstance(read(pair, whole=True), Unreadable)


def test_an_exception_keeps_its_class_its_bases_and_its_line():
    namespace: dict = {}
    exec("def f():\n    return 1\ndef g():\n    raise UnicodeError('odd')", namespace)
    answer = ask(namespace["g"], (), whole=True)
    assert isinstance(answer, Raised)
    assert (answer.exception, answer.message, answer.line) == ("UnicodeError", "odd", 4)
    assert answer.is_a("ValueError")
    assert not answer.is_a("TypeError")


def test_leaving_the_program_is_an_answer_and_the_keyboard_is_not():
    def leave():
        raise SystemExit(3)

    def interrupted():
        raise KeyboardInterrupt

    answer = ask(leave, (), whole=True)
    assert isinstance(answer, Raised)
    assert answer.exception == "SystemExit"
    with pytest.raises(KeyboardInterrupt):
        ask(interrupted, (), whole=True)


def test_the_sandboxs_own_failure_is_no_answer():
    def call():
        raise SandboxError("gone")

    with pytest.raises(SandboxError):
        ask(call, (), whole=True)


@pytest.mark.parametrize(("kind", "fatal"), [("timeout", True), ("died", True), ("error", False), ("refused", False)])
def test_a_failed_call_keeps_its_fields(kind, fatal):
    def call():
        raise CallFailed(kind, "why", exception="E", bases=("E", "ValueError"), line=7, source="x")

    answer = ask(call, (), whole=True)
    assert answer == Raised(kind, "why", "E", ("E", "ValueError"), 7, "x")
    assert answer.fatal is fatal


def test_floating_point_warnings_of_the_function_stay_silent():
    assert isinstance(ask(lambda: np.array([1.0]) / np.array([0.0]), (), whole=True), Numbers)
