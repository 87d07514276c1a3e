"""A notebook as the bytes of its file: what nbformat writes, but for figures, which stand on one line each.

A figure is thousands of small values that nobody reads line by line; so written they cost a fifth of the time and of the room.
"""

from __future__ import annotations

import json
import secrets
from collections.abc import Mapping
from typing import Any

from autograder.notebook.safe import FIGURE

MANY_LINES, SHORT_LINE = 5000, 10  # lines of a text, characters of a line


def dumps(notebook: Mapping[str, Any]) -> bytes:
    """The file of a valid nbformat-4 notebook: sorted keys, texts split into lines, one newline at the end."""
    figures: dict[str, bytes] = {}
    split = {**notebook, "cells": [_cell(cell, figures) for cell in notebook["cells"]]}
    text = json.dumps(split, indent=1, sort_keys=True, separators=(",", ": "), ensure_ascii=False, allow_nan=False)
    parts, rest = [], text.encode("utf-8")
    for place, figure in figures.items():  # in the order of the cells, as in the text
        before, _, rest = rest.partition(f'"{place}"'.encode())
        parts += [before, figure]
    return b"".join([*parts, rest, b"\n"])


def _lines(text: str) -> list[str] | str:
    """The lines of a text; the text itself where they are many with hardly anything in them, for each takes 15 bytes more."""
    lines = text.splitlines(True)
    return lines if len(lines) <= MANY_LINES or len(text) >= SHORT_LINE * len(lines) else text


def _cell(cell: Mapping[str, Any], figures: dict[str, bytes]) -> dict[str, Any]:
    split = {**cell, "source": _lines(cell["source"])}
    if "outputs" in cell:
        split["outputs"] = [_output(output, figures) for output in cell["outputs"]]
    return split


def _output(output: Mapping[str, Any], figures: dict[str, bytes]) -> dict[str, Any]:
    if output["output_type"] == "stream":
        return {**output, "text": _lines(output["text"])}
    if "data" in output:
        data = {mime: _lines(value) if mime.startswith("text/") else value for mime, value in output["data"].items()}
        if isinstance(data.get(FIGURE), dict):
            place = secrets.token_hex(16)  # nothing that a learner wrote can be this
            written: bytes = getattr(data[FIGURE], "written", b"")  # where it was written already
            figures[place] = written or json.dumps(data[FIGURE], sort_keys=True, ensure_ascii=False, allow_nan=False).encode(
                "utf-8"
            )
            data[FIGURE] = place
        return {**output, "data": data}
    return dict(output)
