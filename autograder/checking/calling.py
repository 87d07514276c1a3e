"""The learner's function, called so that an error knows its line, and prints and warnings are kept for the card.

nbgrader scores a cell that writes anything to stderr 0, but a warning of numpy is no mistake in itself. So while the judge
works nothing of all this reaches the notebook, and a bounded part of it is shown on the card.
"""

from __future__ import annotations

import contextlib
import io
import linecache
import traceback
import warnings
from collections.abc import Callable, Iterator
from itertools import groupby
from types import TracebackType
from typing import Any

import numpy as np

from autograder.checking import shell
from autograder.errors import CallFailed
from autograder.messages import say

KEPT = 2000  # characters of what is printed
LINES = 12
WARNINGS = 3


class Learner:
    """A callable that calls the learner's function and raises :class:`CallFailed` where that raises."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function = function
        self.printed = Heard()
        self.warned: dict[str, None] = {}  # ordered, without repetitions
        self.calls = 0

    def __call__(self, *args: Any) -> Any:
        """The function's answer to positional arguments."""
        self.calls += 1
        try:
            with np.errstate(divide="warn", invalid="warn", over="warn", under="ignore"):
                return self.function(*args)
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # SystemExit too: a learner's exit() must not end the notebook
            raise self._failed(error) from None

    def _failed(self, error: BaseException) -> CallFailed:
        line, source = self._place(error.__traceback__)
        bases = tuple(base.__name__ for base in type(error).__mro__)
        message = " ".join(str(error).split())[:500]
        return CallFailed("error", message, exception=type(error).__name__, bases=bases, line=line, source=source)

    def _place(self, trace: TracebackType | None) -> tuple[int | None, str]:
        """The innermost line of the file (in a notebook: the cell) that defines the function."""
        code = getattr(self.function, "__code__", None)
        own = code.co_filename if code is not None else None
        frames = [frame for frame in traceback.extract_tb(trace) if frame.filename == own]
        if not frames or frames[-1].lineno is None:
            return None, ""
        return frames[-1].lineno, (frames[-1].line or "").strip()[:200]

    @contextlib.contextmanager
    def quiet(self) -> Iterator[None]:
        """While it holds, prints, displays and warnings are heard and not shown."""
        with (
            contextlib.redirect_stdout(self.printed),
            contextlib.redirect_stderr(self.printed),
            warnings.catch_warnings(),
            shell.no_displays(),
        ):
            warnings.simplefilter("always")
            warnings.showwarning = self._warned
            yield

    def _warned(self, message: Warning | str, category: type[Warning], filename: str, lineno: int, *_: Any, **__: Any) -> None:
        code = getattr(self.function, "__code__", None)
        if code is None or filename != code.co_filename:  # not the learner's line: nothing a learner could mend
            return
        if len(self.warned) < WARNINGS:
            source = linecache.getline(filename, lineno).strip()
            place = say("heard.source", line=lineno, source=source[:120]) if source else say("heard.line", line=lineno)
            self.warned[f"{category.__name__}: {' '.join(str(message).split())[:200]}\n    {place}"] = None

    def notes(self) -> list[tuple[str, str]]:
        """What the function printed and what warned of it, for the card."""
        told = []
        if self.warned:
            told.append((say("part.warned"), "\n".join(self.warned)))
        if self.printed.total:
            told.append((say("part.printed", calls=self.calls), self.printed.shown()))
        return told


class Heard(io.TextIOBase):
    """A text stream that keeps its beginning and counts the rest."""

    def __init__(self) -> None:
        self.kept = ""
        self.total = 0

    def writable(self) -> bool:
        """It can be written to."""
        return True

    def write(self, text: str) -> int:
        """Keep what there is room for."""
        text = str(text)
        self.kept += text[: max(KEPT - len(self.kept), 0)]
        self.total += len(text)
        return len(text)

    def shown(self) -> str:
        """The beginning, and how much more there was."""
        lines = [_counted(line, len(list(same))) for line, same in groupby(self.kept.splitlines())]
        text = "\n".join(lines[:LINES])
        whole = self.total <= KEPT and len(lines) <= LINES
        return text if whole else f"{text}\n… {say('heard.all', count=self.total)}"


def _counted(line: str, times: int) -> str:
    return line if times == 1 else f"{line}    {say('heard.times', count=times)}"
