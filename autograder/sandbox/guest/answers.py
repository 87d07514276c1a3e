"""Calls of learners' functions: finding them, and telling how they failed."""

from __future__ import annotations

import linecache
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from autograder.sandbox.guest.words import say

MESSAGE = 2000  # characters kept of an error's message


class Missing(Exception):
    """There is no such function in the notebook."""


class Refused(Exception):
    """What the function returned cannot be taken as an answer."""


class TimeLimitExceeded(BaseException):
    """A cell or call has used up its time. Not an ``Exception``, so that ``except Exception`` does not swallow it."""


def find(namespace: dict[str, Any], name: str) -> Callable[..., Any]:
    """The function of that name in the notebook."""
    if name not in namespace:
        raise Missing(say("missing", name=name))
    function = namespace[name]
    if not callable(function):
        raise Missing(say("no_function", name=name, type=type(function).__name__))
    return function  # type: ignore[no-any-return]


@contextmanager
def failures(is_cell: Callable[[str], bool]) -> Iterator[list[Any]]:
    """Catches whatever goes wrong inside and fills the list with (False, kind, message, exception, bases, line, source).

    Used as ``with failures(shell.is_cell) as failure: ...``; ``tuple(failure)`` is the answer then. ``is_cell`` says of a file
    name whether that code came from a cell.
    """
    failure: list[Any] = []
    try:
        yield failure
    except (Missing, Refused) as error:
        kind = "missing" if isinstance(error, Missing) else "refused"
        failure += [False, kind, str(error)[:MESSAGE], "", (), None, ""]
    except TimeLimitExceeded as error:
        failure += [False, "timeout", str(error), "", (), *_place(error, is_cell)]
    except MemoryError as error:
        failure += [False, "memory", "", "MemoryError", ("MemoryError",), *_place(error, is_cell)]
    except BaseException as error:
        failure += [False, "error", _message(error), type(error).__name__, _bases(error), *_place(error, is_cell)]


def _message(error: BaseException) -> str:
    try:
        return str(error)[:MESSAGE]
    except BaseException:  # a learner's own __str__
        return say("unshown")


def _bases(error: BaseException) -> tuple[str, ...]:
    return tuple(base.__name__[:100] for base in type(error).__mro__[:20])


def _place(error: BaseException, is_cell: Callable[[str], bool]) -> tuple[int | None, str]:
    """Line and text of the innermost place in the learner's own cells."""
    place: tuple[int | None, str] = (None, "")
    for frame, line in traceback.walk_tb(error.__traceback__):
        name = frame.f_code.co_filename
        if is_cell(name):
            place = line, linecache.getline(name, line).strip()[:500]
    return place
