"""The walkthroughs: finds the chapters of ``course/`` and builds each into a notebook for a reader.

A chapter is one text in the form of :mod:`autograder.notebook.text`, named ``NN-its-question.py``. Its first cell is prose and
begins with ``# Title``. A cell marked ``setup=true`` brings the helpers that assignments have too, with its own lines after
them; cells may be marked ``fold=true`` (the code is there, folded away); a code cell may hold a solution between markers, which
the reader receives as a stub. A chapter has no graded cells and may use the whole library.
"""

from __future__ import annotations

import re
from pathlib import Path

from autograder import catalogue
from autograder.notebook.text import Cell, Notebook, assembled, new_cell, read, region, stubbed

NAME = re.compile(r"\d\d-[a-z0-9-]+\.py")
OPTIONS = {"fold", "setup"}
GUESS = re.compile(r"(\w+) = None\b[ \t]*(?:#[ \t]*(.*))?")


def chapters(folder: Path | None = None) -> list[Path]:
    """The chapters of a folder, by default of the course that comes with the package, in the order of their numbers."""
    return sorted(path for path in (folder or catalogue.shipped_room("course")).iterdir() if NAME.fullmatch(path.name))


def title(path: Path) -> str:
    """The heading of a chapter."""
    return _title(read(path))


def guess_of(source: str) -> str | None:
    """The name that the reader is asked to fill in, where a cell begins with ``name = None``."""
    found = GUESS.match(source)
    return found[1] if found else None


def build_chapter(path: Path, *, solutions: bool = False) -> Notebook:
    """The notebook of a chapter, with the reader's stubs or, to be executed, with the solutions.

    Raises
    ------
    CourseError
        Beginning with file and line, where the text is not a chapter.
    """
    cells = read(path)
    _title(cells)
    return assembled([_built(cell, number, solutions) for number, cell in enumerate(cells, 1)])


def _title(cells: list[Cell]) -> str:
    first = cells[0]
    if first.kind != "markdown" or not first.source.startswith("# "):
        raise first.error("a chapter begins with a [markdown] cell whose first line is '# Title'")
    return first.source.split("\n")[0].removeprefix("# ").strip()


def _built(cell: Cell, number: int, solutions: bool) -> dict[str, object]:
    unknown = [key for key in cell.options if key not in OPTIONS]
    if unknown:
        raise cell.error(f"unknown option {unknown[0]!r} after '# %%'; a chapter knows {', '.join(sorted(OPTIONS))}")
    if cell.kind == "markdown" and region(cell) is not None:
        raise cell.error("a solution stands in a code cell; in prose everybody reads it")
    metadata = {"jupyter": {"source_hidden": True}} if any(map(cell.options.get, OPTIONS)) else {}
    return new_cell(cell.kind, cell.source if solutions else stubbed(cell), f"cell-{number:02d}", metadata)
