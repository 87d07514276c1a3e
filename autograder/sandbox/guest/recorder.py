"""What a cell shows, in the order in which it came and within its limits.

A kernel regroups stdout and stderr; here text, displays, results and errors stay as they were.
"""

from __future__ import annotations

import base64
import io
import json
import math
from typing import Any

from autograder.sandbox.guest.words import say

JSON_TYPES = ("application/json", "+json")
ERRORS = 300_000  # characters of tracebacks that one cell may show
RESULT, RESULTS = 10_000, 10  # characters of a result that every cell may show, and how many of them
Output = list[Any]
Sizes = tuple[tuple[str, int, int], ...]


def more(size: int) -> str:
    """The line after which output is left out that has more than so many bytes."""
    return f"\n{say('more', size=size // 1000)}\n"


def many(count: int) -> str:
    """The same for more than so many outputs."""
    return f"\n{say('many', count=count)}\n"


class Recorder:
    """What one cell shows, within its limits."""

    def __init__(self) -> None:
        self.silent = False
        self.begin(0, 0)

    def begin(self, size: int, count: int) -> None:
        """Start afresh for a cell that may show ``size`` bytes in ``count`` outputs."""
        self.outputs: list[Output] = []
        self.updates: dict[str, Output] = {}
        self.by_id: dict[str, list[Output]] = {}
        self.size, self.count, self.left = size, count, size
        self.errors_left, self.results_left = ERRORS, RESULTS
        self.clear_at_next = False
        self.full = False

    def texts(self) -> tuple[str, str]:
        """What was printed to stdout and to stderr."""
        streams = [output for output in self.outputs if output[0] == "stream"]
        out, err = ("".join("".join(parts) for _, name, parts in streams if name == wanted) for wanted in ("stdout", "stderr"))
        return out, err

    def stream(self, name: str, text: str) -> None:
        """Printed text; it is joined to the text before it."""
        if self.silent or self.full or not text:
            return
        text = self._room(text)
        if self.outputs and not self.clear_at_next and self.outputs[-1][:2] == ["stream", name]:
            self.outputs[-1][2].append(text)
        elif text:
            self.add(["stream", name, [text]])

    def display(self, kind: str, data: dict[str, Any], metadata: dict[str, Any] | None, display_id: Any = None) -> None:
        """A rich display, or a cell's result (``kind`` execute_result)."""
        self.show(kind, bundled(data), sizes_of(metadata), "" if display_id is None else str(display_id)[:200])

    def show(self, kind: str, bundle: list[tuple[str, str]], sizes: Sizes = (), display_id: str = "") -> None:
        """The same, of texts by mime type."""
        if self.silent or not bundle:
            return
        output: Output = [kind, bundle, sizes, display_id]
        length = _length(bundle)
        if not self.full and self._fits(length) and self.add(output):
            if display_id:
                self.by_id.setdefault(display_id, []).append(output)
        elif kind == "execute_result" and length <= RESULT and self.results_left:  # it may be a number of points
            self.results_left -= 1
            self.outputs.append(output)

    def update(self, data: dict[str, Any], metadata: dict[str, Any] | None, display_id: Any) -> None:
        """Replace an earlier display, in this cell or (told to the trusted side) in one before."""
        name, bundle, sizes = str(display_id)[:200], bundled(data), sizes_of(metadata)
        here = self.by_id.get(name, [])
        before = _length(self.updates[name][1]) if name in self.updates else -100
        growth = sum(_length(bundle) - _length(output[1]) for output in here) + _length(bundle) - before
        if self.silent or self.full or not self._fits(growth):
            return
        for output in here:
            output[1:3] = [bundle, sizes]
        self.updates[name] = ["update", bundle, sizes, name]

    def error(self, name: str, value: str, traceback: list[str]) -> None:
        """An exception with its traceback, shown even when the cell has shown too much."""
        lines = [line[:10_000] for line in traceback[:100]]
        self.errors_left -= sum(map(len, lines)) + 2000
        if not self.silent and self.errors_left > 0:
            self.outputs.append(["error", name[:200], value[:2000], lines])

    def clear(self, wait: bool) -> None:
        """Jupyter's clear_output."""
        if wait:
            self.clear_at_next = True
        else:
            self.outputs.clear()

    def add(self, output: Output) -> bool:
        """Append unless the cell has shown too many things."""
        if self.clear_at_next:
            self.outputs.clear()
            self.clear_at_next = False
        if len(self.outputs) >= self.count:
            self._stop(many(self.count))
            return False
        self.outputs.append(output)
        return True

    def _stop(self, note: str) -> None:
        self.full = True
        self.outputs.append(["stream", "stdout", [note]])

    def _room(self, text: str) -> str:
        """The text, or its beginning with a note if the limit is reached."""
        if len(text) <= self.left:
            self.left -= len(text)
            return text
        text, self.left, self.full = text[: self.left], 0, True
        return text + more(self.size)

    def _fits(self, size: int) -> bool:
        """Take so much of what is left, or stop."""
        if size > self.left:
            self._stop(more(self.size))
            return False
        self.left -= size
        return True


class Printed(io.TextIOBase):
    """sys.stdout or sys.stderr of the notebook."""

    encoding = "UTF-8"
    errors = "replace"

    def __init__(self, name: str, recorder: Recorder) -> None:
        self.name, self.recorder = name, recorder

    def write(self, text: str) -> int:
        """Record the text."""
        if not isinstance(text, str):
            raise TypeError(f"write() argument must be str, not {type(text).__name__}")
        self.recorder.stream(self.name, text)
        return len(text)

    def writable(self) -> bool:
        """Always."""
        return True


def bundled(data: dict[str, Any]) -> list[tuple[str, str]]:
    """The data of a display by mime type, as text; what has no text form is left out."""
    texts = ((str(mime)[:100], _as_text(mime, value)) for mime, value in data.items())
    return [(mime, text) for mime, text in texts if text is not None]


def _length(bundle: list[tuple[str, str]]) -> int:
    return sum(len(text) for _, text in bundle)


def _as_text(mime: Any, value: Any) -> str | None:
    """The data of one mime type as text; JSON types as strict JSON."""
    if str(mime).endswith(JSON_TYPES):
        try:
            return json.dumps(_finite(value), allow_nan=False)
        except (TypeError, ValueError, RecursionError):
            return None
    if isinstance(value, bytes):
        return base64.b64encode(value).decode("ascii")
    return value if isinstance(value, str) else None


def _finite(value: Any) -> Any:
    """JSON has no NaN and no infinity: null."""
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, dict):
        return {str(key): _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return value


def sizes_of(metadata: Any) -> Sizes:
    """Width and height of images, the only metadata that is kept."""
    found = []
    for mime, about in metadata.items() if isinstance(metadata, dict) else ():
        if isinstance(about, dict) and isinstance(about.get("width"), int) and isinstance(about.get("height"), int):
            found.append((str(mime)[:100], about["width"], about["height"]))
    return tuple(found[:10])
