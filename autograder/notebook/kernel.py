"""The engine `jupyter`: what a notebook's cells show comes from a real kernel; marks do not.

A kernel's process writes its own outputs, so whatever the learner's code wants can stand in them. So the notebook runs twice:
in a kernel, inside a sandbox of its own, for what is shown, and cell by cell as always, for exercise cells (judged from
outside) and for test cells that run apart. Other test cells get no mark; a person looks at what the kernel showed.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

from autograder.messages import say
from autograder.notebook.marks import CellRun
from autograder.notebook.rebuild import Rebuilt
from autograder.notebook.told import told


class Shown(Protocol):
    """What came of a notebook in a kernel: see ``autograder.sandbox.kernel.KernelRun``."""

    cells: Any
    files: Any
    ended: Any


def sources(rebuilt: Rebuilt, runs: Sequence[CellRun | None], apart: frozenset[str]) -> list[str | None]:
    """What the kernel runs: every code cell that was run, but for the judged ones, and for tests that run apart.

    The learner's code could read those in the kernel and show them, hidden tests too.
    """
    elsewhere = [mine is not None and mine.name in apart for mine in rebuilt.masters]
    return [
        cell["source"] if run is not None and run.status != "judged" and not away else None
        for cell, run, away in zip(rebuilt.cells, runs, elsewhere, strict=True)
    ]


def take(rebuilt: Rebuilt, runs: list[CellRun | None], shown: Shown, apart: frozenset[str]) -> None:
    """Put the kernel's outputs into the notebook, and take their marks from the test cells that ran in it."""
    for number, (cell, mine) in enumerate(zip(rebuilt.cells, rebuilt.masters, strict=True)):
        run = runs[number]
        if run is None or run.status == "judged" or (mine is not None and mine.name in apart):
            continue
        if number in shown.cells:
            cell["outputs"] = shown.cells[number].outputs
        else:
            lost = shown.ended is not None
            cell["outputs"] = [
                _said(say("graded.kernel_lost", why=told(shown.ended.message)) if lost else say("graded.kernel_silent"))
            ]
    without_marks(rebuilt, runs, apart)


def without_marks(rebuilt: Rebuilt, runs: list[CellRun | None], apart: frozenset[str]) -> None:
    """No test cell that shares the learner's process has a mark."""
    for number, mine in enumerate(rebuilt.masters):
        run = runs[number]
        test = mine is not None and mine.grade and not mine.solution and mine.name not in apart
        if test and run is not None and run.status != "judged":
            runs[number] = CellRun("not run", note=say("graded.forgeable"))


def _said(text: str) -> dict[str, Any]:
    return {"output_type": "display_data", "metadata": {}, "data": {"text/plain": text}}
