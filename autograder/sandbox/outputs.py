"""What a learner's cell shows, checked: known mime types, valid Unicode, strict JSON, bounded, no metadata but image sizes.

Everything here treats its input as forged. Text that a browser would interpret (``ACTIVE``) is passed on as data; whoever
writes it into a page must sanitise it.
"""

from __future__ import annotations

import json
import re
import threading
from collections import OrderedDict
from typing import Any

from autograder.sandbox import messages
from autograder.sandbox.wire import WireError

IMAGES = ("image/png", "image/jpeg", "image/gif")
ACTIVE = ("text/html", "text/markdown", "text/latex")
FIGURE = "application/vnd.plotly.v1+json"
JSON_TYPES = ("application/json", FIGURE)
MIME_TYPES = ("text/plain", *ACTIVE, *IMAGES, *JSON_TYPES)
BASE64 = re.compile(r"[A-Za-z0-9+/\s]*+={0,2}\s*+")  # possessive: linear on any input
JSON_DEPTH = 40
JSON_ITEMS = 300_000
KEPT = 8_000_000  # characters of figures that are remembered: a class draws the same ones again and again
KEPT_ITEMS = 20_000  # of one of them
MORE_OUTPUTS, MORE_CHARACTERS = 200, 1_000_000  # notes, tracebacks, names of types
MAX_PIXELS = 20_000
LARGEST = 1.7e308
SURROGATES = re.compile("[\ud800-\udfff]")
# Not newline and tab; also the marks that turn the direction of writing.
CONTROLS = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")

Output = dict[str, Any]


def outputs(value: Any, characters: int, count: int) -> list[tuple[Output, str]]:
    """nbformat outputs from what a child sent, each with its display id (empty for most).

    Our child keeps to the limits of ``characters`` and ``count`` itself, but for a few notes and tracebacks; so more than
    that is forged.

    Raises
    ------
    WireError
        If it does not have the form, or the bounds, of what our child sends.
    """
    if not isinstance(value, tuple) or len(value) > count + MORE_OUTPUTS:
        raise WireError("more outputs than a cell may show")
    if sum(map(_length, value)) > characters + MORE_CHARACTERS:
        raise WireError("longer outputs than a cell may show")
    return [_output(item) for item in value]


def _length(item: Any) -> int:
    """Characters in nested tuples of texts."""
    return len(item) if isinstance(item, str) else sum(map(_length, item)) if isinstance(item, tuple) else 0


def updates(value: Any) -> list[tuple[Output, str]]:
    """New contents for displays of earlier cells: (display_data output, display id)."""
    if not isinstance(value, tuple):
        raise WireError("updates are a tuple")
    return [_display("display_data", item) for item in value]


def text(value: Any, limit: int = 1 << 30) -> str:
    """A valid Unicode string of at most ``limit`` characters."""
    if not isinstance(value, str):
        raise WireError("a text is missing")
    if value.isascii() and len(value) <= limit:
        return value
    return SURROGATES.sub("\ufffd", value[:limit])


def plain(value: Any, limit: int) -> str:
    """A text that a terminal or a table may show: :func:`text` without control characters but newline and tab."""
    return CONTROLS.sub("\ufffd", text(value, limit))


def _output(item: Any) -> tuple[Output, str]:
    kind = item[0] if isinstance(item, tuple) and len(item) in (3, 4) else None
    if kind == "stream" and len(item) == 3 and item[1] in ("stdout", "stderr"):
        return {"output_type": "stream", "name": item[1], "text": text(item[2])}, ""
    if kind == "error" and len(item) == 4 and isinstance(item[3], tuple):
        traceback = [text(line) for line in item[3]]
        return {"output_type": "error", "ename": text(item[1]), "evalue": text(item[2]), "traceback": traceback}, ""
    if kind in ("display_data", "execute_result"):
        return _display(str(kind), item)
    raise WireError("an output of no known kind")


def _display(kind: str, item: Any) -> tuple[Output, str]:
    if not (isinstance(item, tuple) and len(item) == 4 and isinstance(item[1], tuple) and isinstance(item[2], tuple)):
        raise WireError("a display of no known form")
    _, pairs, sizes, display_id = item
    output: Output = {"output_type": kind, "data": _bundle(pairs), "metadata": _metadata(sizes)}
    if kind == "execute_result":
        output["execution_count"] = None  # the session fills it in
    return output, text(display_id, 200)


def _bundle(pairs: tuple[Any, ...]) -> dict[str, Any]:
    data: dict[str, Any] = {}
    dropped: list[str] = []
    for pair in pairs[:50]:
        if not (isinstance(pair, tuple) and len(pair) == 2 and isinstance(pair[0], str) and isinstance(pair[1], str)):
            raise WireError("a mime bundle of no known form")
        mime: str = pair[0]
        content: Any = pair[1]
        if mime in JSON_TYPES:
            content = drawn(content) if mime == FIGURE else strict_json(content)
        elif mime in IMAGES:
            content = content if BASE64.fullmatch(content) else None
        elif mime in MIME_TYPES:
            content = text(content)
        else:
            content = None
        if content is None:
            dropped.append(mime)
        else:
            data[mime] = content
    if not data:
        data["text/plain"] = messages.not_shown(", ".join(text(mime, 100) for mime in dropped[:3]))
    return data


class Drawn(dict[str, Any]):
    """A figure as it was read: one object for all who draw the same, so nobody changes it. ``found``: what was made of it."""

    def __init__(self, value: dict[str, Any]) -> None:
        super().__init__(value)
        self.found: dict[str, Any] = {}


class _Kept:
    """The figures read last, by their text."""

    def __init__(self) -> None:
        self.figures: OrderedDict[str, Drawn] = OrderedDict()
        self.size = 0
        self.lock = threading.Lock()

    def get(self, content: str) -> Drawn | None:
        with self.lock:
            figure = self.figures.get(content)
            if figure is not None:
                self.figures.move_to_end(content)
            return figure

    def put(self, content: str, figure: Drawn) -> None:
        with self.lock:
            if content not in self.figures:
                self.figures[content] = figure
                self.size += len(content)
            while self.size > KEPT:
                oldest, _ = self.figures.popitem(last=False)
                self.size -= len(oldest)


_kept = _Kept()


def drawn(content: str) -> Any:
    """As :func:`strict_json`, for a figure: what was read and checked once is not read again."""
    figure = _kept.get(content)
    if figure is None:
        value = strict_json(content)
        if not isinstance(value, dict):
            return value
        figure = Drawn(value)
        if len(content) <= KEPT // 8 and sum(map(content.count, ",[{")) <= KEPT_ITEMS:
            _kept.put(content, figure)
    return figure


def strict_json(content: str) -> Any:
    """The parsed value, or None if it is not plain, finite, bounded JSON. Objects only: no number, text or list at the top."""
    if sum(map(content.count, ",[{")) > JSON_ITEMS:  # each item of a list or object follows one of these
        return None
    try:
        value = json.loads(content, parse_constant=_refuse)
        return _checked(value, JSON_DEPTH) if isinstance(value, dict | list) else None
    except (ValueError, RecursionError):
        return None


def _refuse(name: str) -> Any:
    raise ValueError(f"{name} is not JSON")


def _checked(value: Any, depth: int) -> Any:
    if depth < 1:
        raise ValueError("nested too deeply")
    if isinstance(value, str):
        return text(value)
    if isinstance(value, int | float) and not abs(value) < LARGEST:  # also NaN
        raise ValueError("a number too large")
    if isinstance(value, list):
        return [_checked(item, depth - 1) for item in value]
    if isinstance(value, dict):
        return {key if key.isascii() else text(key): _checked(item, depth - 1) for key, item in value.items()}
    return value


def _metadata(sizes: tuple[Any, ...]) -> dict[str, Any]:
    found = {}
    for size in sizes[:10]:
        if isinstance(size, tuple) and len(size) == 3 and size[0] in IMAGES:
            width, height = size[1:]
            if all(type(length) is int and 0 < length <= MAX_PIXELS for length in (width, height)):
                found[size[0]] = {"width": width, "height": height}
    return found
