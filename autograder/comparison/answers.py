"""What a function gave back, read once: an array of numbers, a word, a tuple, or the reason why it is none of these.

Anything that ``np.asarray(x, float)`` takes is an array: lists, integers, float32, booleans, fractions. What it takes by
accident (text that looks like numbers) or with a loss (complex numbers, masked arrays) is not. :mod:`autograder.returned`
makes it plain first, here or in the sandbox, so an answer is read in the same way wherever it comes from.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from autograder.errors import CallFailed, FailureKind, SandboxError
from autograder.messages import say
from autograder.returned import MOST_VALUES, Foreign, plainly

Array: TypeAlias = NDArray[np.float64]
Reason = Literal["none", "complex", "text", "ragged", "parts", "function", "masked", "object"]


@dataclass(frozen=True)
class Raised:
    """The call ended in an exception, or in a limit. ``bases`` names the exception's class and those it derives from."""

    kind: FailureKind
    message: str
    exception: str = ""
    bases: tuple[str, ...] = ()
    line: int | None = None
    source: str = ""

    def is_a(self, name: str) -> bool:
        """Whether the exception is of the class of that name."""
        return name in (self.exception, *self.bases)

    @property
    def fatal(self) -> bool:
        """Whether no later call can be answered."""
        return self.kind in ("timeout", "memory", "died", "missing")


@dataclass(frozen=True)
class Unreadable:
    """An answer that is not numbers. ``facts`` fill in the sentence that explains it."""

    reason: Reason
    facts: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Numbers:
    """An array of numbers; a single number has shape ()."""

    values: Array
    was: str = "float"  # "bool", "int" or "float"


@dataclass(frozen=True)
class Word:
    """A string."""

    text: str


@dataclass(frozen=True, eq=False)
class Several:
    """A tuple of answers."""

    items: tuple[Answer, ...]


Answer: TypeAlias = Numbers | Word | Several | Unreadable | Raised


def ask(call: Callable[..., Any], arguments: tuple[Any, ...], *, whole: bool) -> Answer:
    """Call a function and read its answer.

    ``whole``: one array is wanted, so that a tuple of equal rows is taken as ``np.asarray`` takes it.
    """
    try:
        with np.errstate(all="ignore"):
            return read(call(*arguments), whole=whole)
    except CallFailed as failure:
        return _failed(failure)
    except SandboxError:
        raise
    except (Exception, SystemExit) as failure:
        return raised(failure)


def ask_in_turn(call: Callable[..., Any], sets: Sequence[tuple[Any, ...]], *, whole: bool) -> list[Answer]:
    """:func:`ask` with one set of arguments after the other, ending with the first answer that is fatal.

    Where ``call`` has a method ``in_turn`` that takes all sets at once, no time is lost between the calls.
    """
    together = getattr(call, "in_turn", None)
    if together is not None:
        with np.errstate(all="ignore"):
            return [_failed(one) if isinstance(one, CallFailed) else read(one, whole=whole) for one in together(sets)]
    answers: list[Answer] = []
    for arguments in sets:
        answers.append(ask(call, arguments, whole=whole))
        if isinstance(answers[-1], Raised) and answers[-1].fatal:
            break
    return answers


def _failed(failure: CallFailed) -> Raised:
    return Raised(failure.kind, failure.message, failure.exception, tuple(failure.bases), failure.line, failure.source)


def raised(failure: BaseException) -> Raised:
    """An exception of a learner's function that runs in this process."""
    names = tuple(base.__name__ for base in type(failure).__mro__ if base is not object)
    line, trace = None, failure.__traceback__
    while trace is not None:
        # The innermost line of a notebook cell or of source without a file: what lies deeper is some package's.
        if trace.tb_frame.f_code.co_filename.startswith("<") or "ipykernel" in trace.tb_frame.f_code.co_filename:
            line = trace.tb_lineno
        trace = trace.tb_next
    text = " ".join(str(failure).split())[:300]
    return Raised("error", text, type(failure).__name__, names, line)


def read(value: Any, *, whole: bool = True) -> Answer:
    """Sort an answer into one of the kinds above. Never raises.

    Unless one ``whole`` array is wanted, a tuple, or a list of unlike elements, is taken apart.
    """
    value = plainly(value)
    if value is None:
        return Unreadable("none")
    if isinstance(value, str):
        return Word(value)
    if isinstance(value, Foreign):
        return _foreign(value)
    if callable(value):  # a curve or surface that it was given
        return Unreadable("function", {"type": type(value).__name__})
    if isinstance(value, tuple) and not whole:
        return Several(tuple(read(item) for item in value))
    try:
        array = np.asarray(value)
    except ValueError:  # rows of unequal lengths
        array = np.empty(0, dtype=object)
    if array.dtype.kind in "biuf":
        was = {"b": "bool", "i": "int", "u": "int", "f": "float"}[array.dtype.kind]
        return Numbers(np.array(array, dtype=float), was)
    if array.dtype.kind == "c":
        return Unreadable("complex")
    if array.dtype.kind in "SU":
        return Unreadable("text", {"text": repr(str(array.flat[0]) if array.size else "")[:40]})
    if isinstance(value, list) and not whole:
        return Several(tuple(read(item) for item in value))
    return _pieces(value)


def _foreign(value: Foreign) -> Unreadable:
    if value.kind == "large":
        return Unreadable("object", {"type": say("told.large", count=value.text, most=MOST_VALUES)})
    reason: Reason = "function" if value.kind == "function" else "masked" if value.kind == "masked" else "object"
    return Unreadable(reason, {"type": value.text})


def _pieces(value: Any) -> Unreadable:
    """Why a list or tuple is no array of numbers."""
    items = list(value)
    shapes = []
    for item in items[:4]:
        inner = read(item)
        if not isinstance(inner, Numbers):
            break
        shapes.append(inner.values.shape)
    if len(items) in (2, 3) and len(shapes) == len(items):
        names = ", ".join(say("told.coordinate", name=name, shape=shape) for name, shape in zip("xyz", shapes, strict=False))
        return Unreadable("parts", {"parts": names})
    if shapes and len(shapes) == min(len(items), 4):
        return Unreadable("ragged", {"first": str(shapes[0]), "other": str(next((s for s in shapes if s != shapes[0]), ""))})
    other = items[len(shapes)]
    return _foreign(other) if isinstance(other, Foreign) else Unreadable("object", {"type": type(other).__name__})
