"""Builds the notebook that is graded: the instructor's cells, the learner's sources, and nothing else of the submission.

Order and text of the learner's own cells are kept, since an answer may need them. Types, flags, points, tags and the sources of
locked cells (hidden tests with them) are the instructor's; other metadata and old outputs are dropped; raw HTML in Markdown
that the learner wrote becomes text; pasted pictures stay if they are pictures.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from autograder import messages
from autograder.errors import SubmissionError
from autograder.messages import say
from autograder.notebook import safe
from autograder.notebook.master import Known, Master, MasterCell, checksum

MAX_CELLS = 5_000
MAX_SOURCE = 1_000_000
MAX_PICTURES = 48_000_000  # characters of pasted pictures in all; a submission's own file has at most 32 million
_ID = re.compile(r"[A-Za-z0-9_-]{1,64}")
_KERNEL = re.compile(r"[\w .()+\[\]:-]{1,100}")


@dataclass(frozen=True)
class Note:
    """One sentence about a cell (empty: about the notebook). ``look`` asks the instructor for a manual look at that cell."""

    cell: str
    text: str
    look: bool = False


@dataclass
class Rebuilt:
    """A valid nbformat-4.5 notebook, the instructor's copy of each of its cells (or None), and what was noticed."""

    notebook: dict[str, Any]
    masters: list[MasterCell | None]
    known: list[Known]
    notes: list[Note] = field(default_factory=list)

    @property
    def cells(self) -> list[dict[str, Any]]:
        """The cells, in the learner's order."""
        cells: list[dict[str, Any]] = self.notebook["cells"]
        return cells


def rebuild(
    submitted: Mapping[str, Any],
    master: Master,
    *,
    add_missing: bool = False,
    missing: str | None = None,
    keep_outputs: bool = False,
) -> Rebuilt:
    """Rebuild a submitted notebook (parsed JSON, nbformat 4, otherwise anything) around the instructor's copy.

    Parameters
    ----------
    add_missing : bool
        nbgrader's ``OverwriteCells.add_missing_cells``: put deleted graded and task cells back.
    missing : str
        What such a cell begins with, its name as ``{cell_id}``; None for nbgrader's sentence.
    keep_outputs : bool
        Keep (clean) outputs of cells that are not graded, as ``--no-execute`` asks.
    """
    notes: list[Note] = []
    drafts = [_Draft.read(cell, number) for number, cell in enumerate(submitted["cells"][:MAX_CELLS])]
    if len(submitted["cells"]) > MAX_CELLS:
        notes.append(Note("", f"The notebook has more than {MAX_CELLS} cells; the rest was left out."))
    unread = sum(draft is None for draft in drafts)
    if unread:
        notes.append(Note("", f"{unread} of its cells could not be read and were left out."))
    kept = [draft for draft in drafts if draft is not None]
    claims = _claims(kept, master, notes)
    cells, masters, known = [], [], []
    for number, draft in enumerate(kept):
        mine = claims.get(number)
        cells.append(_cell(draft, mine, master, keep_outputs=keep_outputs))
        masters.append(mine)
        known.append(_known(draft, mine, master))
    _bound_pictures(cells, notes)
    built = Rebuilt(_notebook(cells, submitted, master), masters, known, notes)
    if add_missing:
        _add_missing(built, master, notification() if missing is None else missing)
    present = {cell.name for cell in built.masters if cell is not None}
    for cell in master.cells.values():
        if cell.grade and cell.name not in present:
            built.notes.append(Note(cell.name, say("graded.missing"), look=True))
    _give_ids(built.cells)
    return built


def notification() -> str:
    """What a cell that was put back begins with, its name still in braces."""
    return messages.TEXT["graded.put_back"] + "\n\n"


@dataclass
class _Draft:
    cell_type: str
    source: str
    id: str
    name: str | None
    attachments: Mapping[str, Any]
    outputs: list[Any]

    @classmethod
    def read(cls, cell: object, number: int) -> _Draft | None:
        if not isinstance(cell, Mapping) or cell.get("cell_type") not in ("code", "markdown", "raw"):
            return None
        metadata = cell.get("metadata")
        nbgrader = metadata.get("nbgrader") if isinstance(metadata, Mapping) else None
        name = nbgrader.get("grade_id") if isinstance(nbgrader, Mapping) else None
        id, outputs, attachments = cell.get("id"), cell.get("outputs"), cell.get("attachments")
        return cls(
            cell["cell_type"],
            safe.text(cell.get("source", ""), MAX_SOURCE),
            id if isinstance(id, str) and _ID.fullmatch(id) else "",
            name if isinstance(name, str) else None,
            attachments if isinstance(attachments, Mapping) else {},
            outputs if isinstance(outputs, list) else [],
        )


def _claims(drafts: list[_Draft], master: Master, notes: list[Note]) -> dict[int, MasterCell]:
    """Which draft stands for which cell of the instructor: of several that claim one name, the last."""
    last: dict[str, int] = {}
    for number, draft in enumerate(drafts):
        if draft.name is not None and draft.name in master.cells:
            if draft.name in last and not any(note.cell == draft.name for note in notes):
                notes.append(Note(draft.name, say("graded.twice"), look=True))
            last[draft.name] = number
    return {number: master.cells[name] for name, number in last.items()}


def _known(draft: _Draft, mine: MasterCell | None, master: Master) -> Known:
    found = master.by_name.get(mine.name) if mine is not None else master.by_text.get((draft.cell_type, draft.source))
    return found or Known()


def _cell(draft: _Draft, mine: MasterCell | None, master: Master, *, keep_outputs: bool) -> dict[str, Any]:
    known = _known(draft, mine, master)
    cell_type = mine.cell_type if mine is not None else draft.cell_type
    source = mine.source if mine is not None and mine.locked else draft.source
    metadata: dict[str, Any] = copy.deepcopy(dict(known.metadata))
    pictures = copy.deepcopy(dict(known.attachments))
    instructors = mine is not None and (mine.locked or checksum(cell_type, source, mine) == mine.checksum)
    if not instructors and (cell_type, source) not in master.by_text:
        pictures = {**safe.attachments(draft.attachments), **pictures}
        if cell_type == "markdown":
            source = safe.escape_markdown(source)
        elif cell_type == "raw":
            metadata = {"format": "text/plain", "raw_mimetype": "text/plain"}
    if mine is not None:
        metadata["nbgrader"] = mine.metadata
    cell: dict[str, Any] = {"cell_type": cell_type, "id": draft.id, "metadata": metadata, "source": source}
    if cell_type == "code":
        kept = safe.outputs(draft.outputs) if keep_outputs and (mine is None or not mine.grade) else []
        cell |= {"execution_count": None, "outputs": kept}
    elif pictures:
        cell["attachments"] = pictures
    return cell


def _bound_pictures(cells: list[dict[str, Any]], notes: list[Note]) -> None:
    """Who repeats a text of the instructor's a thousand times gets its pasted pictures until that becomes too much."""
    left = MAX_PICTURES
    for cell in cells:
        left -= sum(len(str(data)) for kinds in cell.get("attachments", {}).values() for data in kinds.values())
        if left < 0:
            cell.pop("attachments", None)
    if left < 0:
        notes.append(Note("", f"Pasted pictures beyond {MAX_PICTURES // 1_000_000} MB were left out."))


def _notebook(cells: list[dict[str, Any]], submitted: Mapping[str, Any], master: Master) -> dict[str, Any]:
    kernel = dict(master.kernelspec) or _kernel_of(submitted)
    if not _is_python(kernel):
        asked = kernel.get("display_name") or kernel.get("name")
        raise SubmissionError(f"the notebook wants the kernel {asked!r}, and only Python notebooks are run here")
    metadata: dict[str, Any] = {"language_info": {"name": "python"}}
    if kernel:
        name = kernel.get("name") or "python3"
        metadata["kernelspec"] = {**kernel, "name": name, "display_name": kernel.get("display_name") or name}
    return {"cells": cells, "metadata": metadata, "nbformat": 4, "nbformat_minor": 5}


def _kernel_of(submitted: Mapping[str, Any]) -> dict[str, str]:
    metadata = submitted.get("metadata")
    kernel = metadata.get("kernelspec") if isinstance(metadata, Mapping) else None
    if not isinstance(kernel, Mapping) or kernel.get("name") is None:
        return {}
    found = {key: kernel[key] for key in ("name", "display_name", "language") if kernel.get(key)}
    if not all(isinstance(value, str) and _KERNEL.fullmatch(value) for value in found.values()):
        raise SubmissionError("the notebook names a kernel that cannot be")
    return {"display_name": found["name"], **found}


def _is_python(kernel: Mapping[str, Any]) -> bool:
    """No kernel, a kernel whose language is Python whatever its name (an environment's), or one called python."""
    language, name = kernel.get("language"), kernel.get("name")
    if language:
        return str(language).lower() == "python"
    return not name or str(name).startswith("python")


def _add_missing(built: Rebuilt, master: Master, notification: str) -> None:
    """Put graded and task cells back: after the cell before them in the instructor's order, tasks at the end."""
    present = {cell.name: number for number, cell in enumerate(built.masters) if cell is not None}
    after = -1
    for mine in master.cells.values():
        if mine.name in present:
            after = next(number for number, cell in enumerate(built.masters) if cell is not None and cell.name == mine.name)
        elif mine.grade or mine.task:
            place = len(built.cells) if mine.task else after + 1
            comment = "# " if mine.cell_type == "code" else ""
            draft = _Draft(mine.cell_type, mine.source, "", mine.name, {}, [])
            cell = _cell(draft, mine, master, keep_outputs=False)
            cell["source"] = comment + notification.format(cell_id=mine.name) + mine.source
            built.cells.insert(place, cell)
            built.masters.insert(place, mine)
            built.known.insert(place, master.by_name.get(mine.name) or Known())
            present[mine.name] = place
            after = place if not mine.task else after
            built.notes.append(Note(mine.name, "The cell was missing from the submission and was put back."))


def _give_ids(cells: list[dict[str, Any]]) -> None:
    """Keep ids that are valid and unique; give the others one that depends on their place only."""
    taken = {cell["id"] for cell in cells}
    seen: set[str] = set()
    for number, cell in enumerate(cells):
        if not cell["id"] or cell["id"] in seen:
            new = f"cell-{number}"
            while new in taken:
                new += "-"
            cell["id"] = new
            taken.add(new)
        seen.add(cell["id"])
