"""Executes a chapter for the site: once, from top to bottom, in a real kernel, with its solutions and a mark in every guess.

A guess is a cell ``name = None  # what kind of answer``; a later cell calls ``reveal(name, answer)``. Where ‹name› is typed
into the guess, the line that ``reveal`` prints shows where the reader's own words belong.
"""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError, CellTimeoutError, DeadKernelError

from autograder.errors import CourseError
from autograder.notebook.chapter import build_chapter, guess_of
from autograder.notebook.text import Cell, Notebook, read, region, stubbed

LONGEST = 120  # seconds for one cell


@dataclass(frozen=True)
class Run:
    """A chapter as it came out: its cells as written, and the notebook with outputs, cell for cell."""

    path: Path
    written: list[Cell]
    notebook: Notebook

    def answers(self, number: int) -> list[str]:
        """The guesses that a cell answers."""
        cell = self.written[number]
        if cell.kind != "code":
            return []
        before = [name for one in self.written[:number] if (name := guess_of(one.source))]
        return [name for name in before if re.search(rf"\breveal\({name}\b", cell.source)]

    def solution(self, number: int) -> str | None:
        """A cell with one solution, without its markers; None where nothing was to be written, or no solution came with it."""
        cell = self.written[number]
        found = region(cell)
        if found is None:
            return None
        rows = cell.source.split("\n")
        whole = "\n".join(row for at, row in enumerate(rows) if at not in found)
        return whole if whole != stubbed(cell, keep_markers=False) else None


def mark(name: str) -> str:
    """What is typed into a guess of that name."""
    return f"‹{name}›"


def execute(path: Path, *, timeout: int = LONGEST) -> Run:
    """Run a chapter in its folder.

    Raises
    ------
    CourseError
        With file and line of the cell that stopped, took too long or ended the kernel.
    """
    written = read(path)
    notebook = build_chapter(path, solutions=True)
    for cell in notebook.cells:
        if name := guess_of(cell.source):
            cell.source = re.sub(rf"^{name} = None", f"{name} = {mark(name)!r}", cell.source)
    reached: list[int] = [0]

    def note(cell: Any, cell_index: int) -> None:
        reached[0] = cell_index

    client = NotebookClient(
        notebook,
        timeout=timeout,
        kernel_name="python3",
        extra_arguments=["--log-level=ERROR"],
        on_cell_start=note,
        resources={"metadata": {"path": str(path.parent)}},
    )
    try:
        client.execute(env=dict(os.environ))
    except CellExecutionError as error:
        raise written[reached[0]].error(
            f"this cell stopped with {error.ename}: {error.evalue}; mend it, then build again"
        ) from None
    except CellTimeoutError:
        raise written[reached[0]].error(f"this cell ran longer than {timeout} s; make its work smaller") from None
    except DeadKernelError:
        raise written[reached[0]].error("the kernel ended in this cell; is there memory enough for it?") from None
    except FileNotFoundError as error:
        raise CourseError(f"no Jupyter kernel could be started ({error}); install ipykernel") from None
    return Run(path, written, notebook)
