"""From a notebook that has run to what the gradebook gets: marks, unanswered cells, and notes beside the cells."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape

from autograder.notebook.marks import Mark, mark
from autograder.notebook.master import checksum
from autograder.notebook.rebuild import Rebuilt
from autograder.notebook.run import Ran


def marks(built: Rebuilt, ran: Ran | None) -> dict[str, Mark]:
    """The mark of every graded cell that is there, by grade id. ``ran`` None: nothing was executed."""
    reasons = {note.cell: note.text for note in built.notes if note.look}
    found: dict[str, Mark] = {}
    for number, (cell, mine) in enumerate(zip(built.cells, built.masters, strict=True)):
        if mine is not None and mine.grade:
            how, numbers = (ran.cells[number], ran.numbers) if ran is not None else (None, frozenset[str]())
            given = mark(cell, mine, how, number=mine.name in numbers)
            found[mine.name] = _with_look(given, reasons.get(mine.name))
    return found


def _with_look(given: Mark, reason: str | None) -> Mark:
    return given if reason is None else Mark(given.points, look=True, note=" ".join(filter(None, (reason, given.note))))


def unanswered(built: Rebuilt) -> frozenset[str]:
    """Solution cells whose text is the one that was handed out."""
    return frozenset(
        mine.name
        for cell, mine in zip(built.cells, built.masters, strict=True)
        if mine is not None and mine.solution and checksum(cell["cell_type"], cell["source"], mine) == mine.checksum
    )


def annotate(built: Rebuilt, given: Mapping[str, Mark]) -> None:
    """Write the note of a mark under its code cell, where instructor and learner see it. It changes no mark."""
    for cell, mine in zip(built.cells, built.masters, strict=True):
        note = given[mine.name].note if mine is not None and mine.name in given else ""
        if note and cell["cell_type"] == "code":
            html = f'<p style="border-left: 4px solid; padding-left: 8px"><em>{escape(note)}</em></p>'
            data = {"text/plain": note, "text/html": html}
            cell["outputs"] = [*cell["outputs"], {"output_type": "display_data", "metadata": {}, "data": data}]
