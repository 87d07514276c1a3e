"""Takes out of a page what learners must not read: hidden tests and mark schemes.

nbgrader puts both back into the graded notebook, and shows them in its feedback.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from autograder.messages import say

_ANSI = re.compile(r"\x1b(?:\[[0-?]*[ -/]*[@-~]|\][^\x07\x1b]*(?:\x07|\x1b\\)?|[@-Z\\-_])|[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]")
SHORTEST = 4  # letters of a line by which a traceback is recognised as one through a hidden test


@dataclass(frozen=True)
class Hidden:
    """nbgrader's markers: a line that contains the first begins what is hidden, one that contains the second ends it."""

    tests: tuple[str, str] = ("BEGIN HIDDEN TESTS", "END HIDDEN TESTS")
    scheme: tuple[str, str] = ("BEGIN MARK SCHEME", "END MARK SCHEME")

    def source(self, source: str) -> tuple[str, list[str]]:
        """The source as learners may see it, and the hidden lines. A region that is not closed hides the rest."""
        shown: list[str] = []
        hidden: list[str] = []
        end = ""
        for line in source.split("\n"):
            if end:
                hidden.append(line)
                end = "" if end in line else end
                continue
            begun = next((pair for pair in (self.tests, self.scheme) if pair[0] in line), None)
            if begun is None:
                shown.append(line)
            else:
                hidden.append(line)
                end = begun[1]
        return "\n".join(shown), hidden

    def cell(self, cell: Mapping[str, Any]) -> dict[str, Any]:
        """A cell as learners may see it: without hidden lines, and without tracebacks that show them."""
        source, hidden = self.source(cell["source"])
        if not hidden:
            return dict(cell)
        seen = {**cell, "source": source}
        if "outputs" in cell:
            lines = [line.strip() for line in hidden if len(line.strip()) >= SHORTEST]
            seen["outputs"] = [_without(output, lines) for output in cell["outputs"]]
        return seen


def _without(output: Mapping[str, Any], hidden: Sequence[str]) -> dict[str, Any]:
    if output["output_type"] == "error":
        if _mentions([*output["traceback"], output["evalue"]], hidden):
            name = output["ename"]
            return {**output, "evalue": say("feedback.hidden"), "traceback": [say("feedback.hidden_error", exception=name)]}
    elif output["output_type"] == "stream" and _mentions([output["text"]], hidden):
        return {**output, "text": say("feedback.hidden_text") + "\n"}
    return dict(output)


def _mentions(texts: Iterable[str], hidden: Sequence[str]) -> bool:
    plain = [strip_ansi(text) for text in texts]
    return any(line in text for text in plain for line in hidden)


def strip_ansi(text: str) -> str:
    """The text without terminal colours and other escape sequences."""
    return _ANSI.sub("", text)
