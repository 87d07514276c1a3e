"""One learner of the sample class: what they hand in, and what its honest content is worth."""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import nbformat

Kind = Literal["right", "mistake", "partial", "broken", "cheat"]
Notebook = nbformat.NotebookNode
Edit = Callable[[Notebook], None]
"""Changes a notebook in place, as a learner at the keyboard does."""


@dataclass(frozen=True)
class Member:
    """A learner and a submission.

    Attributes
    ----------
    student_id : str
        Such as ``s01-vectorised``; sorts in the order of the class.
    about : str
        What is special about the submission, in one sentence.
    kind : {"right", "mistake", "partial", "broken", "cheat"}
        Broken submissions cannot be run in whole; cheats hold dishonest code beside their honest content.
    expected : mapping of exercise id to float or None, or None
        The share of each exercise's points that the honest content earns, None where the cell has no mark and asks for a
        manual look; None as a whole where the notebook cannot be read.
    file : str
        Name of the notebook.
    mistakes : mapping of exercise id to mistake id
        The listed mistakes that were made.
    flagged : tuple of str
        Exercises whose graded cell asks for a manual look although it has a mark.
    """

    student_id: str
    about: str
    kind: Kind
    expected: Mapping[str, float | None] | None
    file: str
    edits: tuple[Edit, ...] = field(repr=False)
    mistakes: Mapping[str, str] = field(default_factory=dict)
    flagged: tuple[str, ...] = ()
    damage: Callable[[str], str] | None = field(default=None, repr=False)

    def notebook(self, released: Notebook) -> Notebook:
        """The released notebook as this learner filled it in."""
        nb = copy.deepcopy(released)
        for edit in self.edits:
            edit(nb)
        return nb

    def write(self, released: Notebook, folder: Path) -> None:
        """Write the submission into a folder, usually ``submitted/<student>/<assignment>``."""
        text = nbformat.writes(self.notebook(released), version=nbformat.NO_CONVERT)  # type: ignore[no-untyped-call]
        folder.mkdir(parents=True, exist_ok=True)
        (folder / self.file).write_text(self.damage(text) if self.damage else text, "utf-8")


# What learners do to a notebook. Cells are named by nbgrader's grade id: an exercise's task cell has the exercise's own id, its
# graded cell "check_" before it.


def index(nb: Notebook, grade_id: str) -> int:
    """Place of the cell of that grade id."""
    return next(i for i, cell in enumerate(nb.cells) if cell.metadata.get("nbgrader", {}).get("grade_id") == grade_id)


def solve(answers: Mapping[str, str]) -> Edit:
    """Write these sources into the task cells."""

    def edit(nb: Notebook) -> None:
        for id, source in answers.items():
            nb.cells[index(nb, id)].source = source

    return edit


def write_words(text: str) -> Edit:
    """Write this into every answer in words."""

    def edit(nb: Notebook) -> None:
        for cell in nb.cells:
            meta = cell.metadata.get("nbgrader", {})
            if cell.cell_type == "markdown" and meta.get("solution") and meta.get("grade"):
                cell.source = text

    return edit


def insert(source: str, *, after: str | None = None) -> Edit:
    """Add a code cell after the cell of a grade id; at the top, below the imports, without one."""

    def edit(nb: Notebook) -> None:
        first_code = next(i for i, cell in enumerate(nb.cells) if cell.cell_type == "code")
        place = (first_code if after is None else index(nb, after)) + 1
        nb.cells.insert(place, _new_cell(source, f"added-{place}"))

    return edit


def delete(grade_id: str) -> Edit:
    """Delete a cell."""

    def edit(nb: Notebook) -> None:
        del nb.cells[index(nb, grade_id)]

    return edit


def paste_again(grade_id: str) -> Edit:
    """Copy a cell with all its metadata and paste it below."""

    def edit(nb: Notebook) -> None:
        place = index(nb, grade_id)
        twin = copy.deepcopy(nb.cells[place])
        twin.id = f"pasted-{place}"
        nb.cells.insert(place + 1, twin)

    return edit


def tag(grade_id: str, name: str) -> Edit:
    """Tag a cell."""

    def edit(nb: Notebook) -> None:
        metadata = nb.cells[index(nb, grade_id)].metadata
        metadata["tags"] = [*metadata.get("tags", []), name]

    return edit


def tamper(grade_id: str, *, source: str, points: float, outputs: list[dict[str, Any]]) -> Edit:
    """Overwrite a graded cell: its source, its points, its lock and its outputs."""

    def edit(nb: Notebook) -> None:
        cell = nb.cells[index(nb, grade_id)]
        cell.source = source
        cell.metadata["editable"] = True
        cell.metadata["nbgrader"].update(points=points, locked=False)
        cell.execution_count = 1
        cell.outputs = [nbformat.from_dict(output) for output in outputs]  # type: ignore[no-untyped-call]

    return edit


def _new_cell(source: str, id: str) -> Notebook:
    cell: dict[str, Any] = {
        "cell_type": "code",
        "id": id,
        "metadata": {},
        "source": source,
        "outputs": [],
        "execution_count": None,
    }
    node: Notebook = nbformat.from_dict(cell)  # type: ignore[no-untyped-call]
    return node
