"""Outputs cut and filtered as nbgrader does between running and scoring (its LimitOutput and IgnorePattern).

Each cell's list of outputs is changed in place. What decides a mark, an error or a text on stderr, is never lost in cutting:
nbgrader drops the stderr of a test cell that printed a thousand lines before it, and the cell gets full points.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any

from autograder.messages import say
from autograder.notebook.safe import Figure
from autograder.sandbox.outputs import Drawn

MOST_SHOWN = 32_000_000


def ignore_stderr(cells: Iterable[dict[str, Any]], pattern: str) -> None:
    """Take out stderr outputs in which the pattern is found."""
    if not pattern:
        return
    for cell in cells:
        if cell["cell_type"] == "code":
            cell["outputs"] = [output for output in cell["outputs"] if not _matches(output, pattern)]


def _matches(output: dict[str, Any], pattern: str) -> bool:
    stderr = output["output_type"] == "stream" and output["name"] == "stderr"
    return stderr and re.search(pattern, output["text"]) is not None


def limit_outputs(cells: Iterable[dict[str, Any]], max_lines: int, max_traceback: int) -> None:
    """Cut the streams of each cell to so many lines in all, and tracebacks to so many; -1 for no limit."""
    for cell in cells:
        if cell["cell_type"] == "code":
            if max_lines != -1:
                cell["outputs"] = _limited(cell["outputs"], max_lines)
            if max_traceback != -1:
                for output in cell["outputs"]:
                    if output["output_type"] == "error" and len(output["traceback"]) > max_traceback:
                        output["traceback"] = _cut(output["traceback"], max_traceback)


class Shown:
    """What a notebook may show in all. Its cells each keep to a limit, but it may have thousands of them, and an update of a
    display multiplies what it shows by the number of its places.
    """

    def __init__(self, most: int = MOST_SHOWN) -> None:
        self.left = most

    def cut(self, outputs: list[dict[str, Any]], *, graded: bool) -> list[dict[str, Any]]:
        """The outputs while there is room; then a note, and of a graded cell what decides its mark."""
        kept = []
        for output in outputs:
            self.left -= _size(output)
            decides = output["output_type"] in ("error", "execute_result") or output.get("name") == "stderr"
            if self.left >= 0 or (graded and decides):
                kept.append(output)
            if graded and decides and self.left < 0:
                break
        if len(kept) < len(outputs):
            kept.append({"output_type": "display_data", "metadata": {}, "data": {"text/plain": say("graded.cut.notebook")}})
        return kept


def _size(value: Any) -> int:
    """Characters of a JSON value, nearly."""
    if type(value) is str:
        return len(value)
    if type(value) is Drawn:
        if "size" not in value.found:
            value.found["size"] = _size(dict(value))
        size: int = value.found["size"]
        return size
    if type(value) is Figure and value.written:
        return len(value.written)
    if type(value) is dict or isinstance(value, Mapping):
        size = 0
        for key, part in value.items():
            size += len(str(key)) + (len(part) if type(part) is str else _size(part))
        return size
    if isinstance(value, list | tuple):
        return sum(map(_size, value))
    return len(value) if isinstance(value, str) else 8


def _limited(outputs: list[dict[str, Any]], most: int) -> list[dict[str, Any]]:
    kept = []
    length = 0
    for output in outputs:
        if output["output_type"] == "stream":
            if length >= most and output["name"] != "stderr":
                continue
            lines = output["text"].split("\n")
            if len(lines) + length > most:
                lines = [*lines[: max(most - length - 1, 0)], say("graded.cut.lines")]
            length += len(lines)
            output["text"] = "\n".join(lines)
        kept.append(output)
    return kept


def _cut(traceback: list[str], most: int) -> list[str]:
    start = most // 2
    return [*traceback[:start], say("graded.cut.traceback"), *traceback[-(most - start - 1) :]]
