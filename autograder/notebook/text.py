"""A notebook written as text: the py:percent form that jupytext reads, with terse markers on the cells that matter.

    # %% [markdown]                          prose
    # %%                                     code that a learner may change
    # %% fold=true                           the same, folded away: a picture whose code teaches nothing
    # %% setup=true                          imports and the helpers of every notebook (``setup_cell.txt``), then its own lines
    # %% solution="cylinder"                 the task cell of an exercise
    # %% check="cylinder"                    its graded cell, exactly ``check(cylinder)``
    # %% [markdown] written="why" points=3   an answer in words, marked by hand
    # %% locked="data"                       a cell that is put back as it was before grading

In task cells and written answers the lines between ``### BEGIN SOLUTION`` and ``### END SOLUTION`` are the solution; a
learner's notebook has a stub there.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import Any, Literal, cast

import jupytext
import nbformat

from autograder.errors import CourseError

Notebook = nbformat.NotebookNode
MARKER = re.compile(r"# ?%%")
BEGIN, END = "### BEGIN SOLUTION", "### END SOLUTION"
# What nbgrader's ClearSolutions leaves behind, so that a book made from stubs and one made from solutions release alike.
CODE_STUB = "# YOUR CODE HERE\nraise NotImplementedError()"
TEXT_STUB = "YOUR ANSWER HERE"
KERNELSPEC = {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"}
_JUPYTEXT_KEYS = {"lines_to_next_cell", "cell_marker"}


@dataclass(frozen=True)
class Cell:
    """One cell as written: its kind, its source without the marker, the options of the marker, where it begins."""

    kind: Literal["code", "markdown"]
    source: str
    path: Path
    line: int
    options: Mapping[str, Any] = field(default_factory=dict)

    def error(self, message: str, *, row: int = 0) -> CourseError:
        """A complaint about this cell that begins with its file and line; ``row`` counts from the marker."""
        return CourseError(f"{self.path}:{self.line + row}: {message}")


def read(path: Path) -> list[Cell]:
    """The cells of a notebook source.

    Raises
    ------
    CourseError
        With file and line: no such file, text before the first cell, a marker that cannot be read.
    """
    try:
        text = path.read_text("utf-8")
    except FileNotFoundError:
        raise CourseError(f"{path}: there is no such notebook source; an assignment's is its notebook.py") from None
    lines = text.splitlines()
    markers = [number for number, line in enumerate(lines, 1) if MARKER.match(line)]
    if not markers:
        raise CourseError(f"{path}:1: a notebook source is cells that begin with '# %%' or '# %% [markdown]'; there are none")
    before = next((number for number, line in enumerate(lines[: markers[0] - 1], 1) if line.strip()), None)
    if before is not None:
        raise CourseError(f"{path}:{before}: text before the first cell; begin the file with '# %%' or '# %% [markdown]'")
    cells = jupytext.reads(text, fmt="py:percent").cells
    if len(cells) != len(markers):
        raise CourseError(
            f"{path}: {len(markers)} lines begin with '# %%' but make {len(cells)} cells; "
            "such a line cannot stand inside a string or a comment"
        )
    return [_cell(cell, path, line) for cell, line in zip(cells, markers, strict=True)]


def _cell(cell: Any, path: Path, line: int) -> Cell:
    options = {key: value for key, value in cell.metadata.items() if key not in _JUPYTEXT_KEYS}
    unread = " ".join(str(options[key]) for key in ("title", "incorrectly_encoded_metadata") if key in options)
    if unread:
        raise CourseError(f"{path}:{line}: cannot read {unread!r} after '# %%'; write options as key=\"value\"")
    if cell.cell_type not in ("code", "markdown"):
        raise CourseError(f"{path}:{line}: a cell is code or [markdown]; got {cell.cell_type}")
    source = "\n".join(line.rstrip() for line in cell.source.strip("\n").split("\n"))
    if "setup" in options:
        if cell.cell_type != "code":
            raise CourseError(f"{path}:{line}: a setup cell holds code; take [markdown] away")
        source = f"{setup_source()}\n\n\n{source}".strip("\n")
    return Cell(cell.cell_type, source, path, line, options)


def setup_source() -> str:
    """The first code cell of every assignment and chapter: imports, and the helpers that its other cells use."""
    return files("autograder.notebook").joinpath("setup_cell.txt").read_text("utf-8").strip("\n")


def region(cell: Cell) -> tuple[int, int] | None:
    """First and last row (from 0, the marker lines themselves) of the solution in a cell; None if it has none.

    Raises
    ------
    CourseError
        If the region is not closed, is nested, or there are two: a stub stands for one whole answer.
    """
    rows = cell.source.split("\n")
    begins = [row for row, text in enumerate(rows) if text.strip() == BEGIN]
    ends = [row for row, text in enumerate(rows) if text.strip() == END]
    if not begins and not ends:
        return None
    if len(begins) != 1 or len(ends) != 1 or begins[0] > ends[0]:
        row = (begins[1:] or begins or ends)[0]
        raise cell.error(f"wanted one '{BEGIN}' and after it one '{END}' in the cell", row=row + 1)
    return begins[0], ends[0]


def stubbed(cell: Cell, *, keep_markers: bool = True) -> str:
    """The cell's source with its solution replaced by the stub, between its markers or without them."""
    found = region(cell)
    if found is None:
        return cell.source
    begin, end = found
    rows = cell.source.split("\n")
    indent = rows[begin][: -len(rows[begin].lstrip())]
    stub = [indent + row for row in (CODE_STUB if cell.kind == "code" else TEXT_STUB).split("\n")]
    inside = [rows[begin], *stub, rows[end]] if keep_markers else stub
    return "\n".join([*rows[:begin], *inside, *rows[end + 1 :]])


def assembled(cells: list[dict[str, Any]]) -> Notebook:
    """A valid notebook of these cells, with the kernel named: without one, JupyterLab asks and runs nothing."""
    metadata = {"kernelspec": dict(KERNELSPEC), "language_info": {"name": "python"}}
    whole = {"nbformat": 4, "nbformat_minor": 5, "metadata": metadata, "cells": cells}
    nb = cast(Notebook, nbformat.from_dict(whole))  # type: ignore[no-untyped-call]
    nbformat.validate(nb)
    return nb


def new_cell(kind: str, source: str, id: str, metadata: dict[str, Any] | None = None) -> dict[str, Any]:
    """A cell without outputs."""
    cell: dict[str, Any] = {"cell_type": kind, "id": id, "metadata": metadata or {}, "source": source}
    return cell | ({"outputs": [], "execution_count": None} if kind == "code" else {})
