"""The instructor's copy of a notebook: what the gradebook remembers of it, which no submission can change.

nbgrader stores the cells that matter (graded, solution, task and locked ones) when an assignment is generated, hidden tests
included. All other cells are known from the released file, where there is one, by their text.
"""

from __future__ import annotations

import ast
import functools
import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

CellType = Literal["code", "markdown", "raw"]
SCHEMA_VERSION = 3


@dataclass(frozen=True)
class MasterCell:
    """One cell as the instructor wrote it. ``points`` is None where the cell is not graded."""

    name: str
    cell_type: CellType
    source: str
    checksum: str | None = None
    locked: bool = False
    grade: bool = False
    solution: bool = False
    task: bool = False
    points: float | None = None

    @property
    def exercise(self) -> str | None:
        """The name in ``check(name)``, if this graded cell is exactly that."""
        if not self.grade or self.solution or self.cell_type != "code":
            return None
        return checked_name(self.source)

    @property
    def metadata(self) -> dict[str, Any]:
        """nbgrader's metadata of this cell, as ``generate_assignment`` writes it."""
        meta: dict[str, Any] = {
            "schema_version": SCHEMA_VERSION,
            "grade_id": self.name,
            "grade": self.grade,
            "solution": self.solution,
            "locked": self.locked,
            "task": self.task,
            "cell_type": self.cell_type,
        }
        if self.points is not None:
            meta["points"] = self.points
        if self.checksum:
            meta["checksum"] = self.checksum
        return meta


@dataclass(frozen=True)
class Known:
    """What the instructor's file says beside a cell's text: metadata (without nbgrader's) and attachments."""

    metadata: Mapping[str, Any] = field(default_factory=dict)
    attachments: Mapping[str, Any] = field(default_factory=dict)

    @property
    def tags(self) -> tuple[str, ...]:
        """The instructor's tags of the cell."""
        tags = self.metadata.get("tags", ())
        return tuple(tag for tag in tags if isinstance(tag, str)) if isinstance(tags, list) else ()


@dataclass(frozen=True)
class Master:
    """The instructor's copy of one notebook.

    Attributes
    ----------
    notebook : name without ``.ipynb``
    cells : the cells that nbgrader knows, by grade id, in the instructor's order
    kernelspec : of the source notebook, empty where it had none
    by_text, by_name : what the released file says beside its cells, by (type, text) and by grade id
    uses_check : whether a graded ``check(name)`` is ours even for a name that no exercise has
    """

    notebook: str
    cells: Mapping[str, MasterCell]
    kernelspec: Mapping[str, Any] = field(default_factory=dict)
    by_text: Mapping[tuple[str, str], Known] = field(default_factory=dict)
    by_name: Mapping[str, Known] = field(default_factory=dict)
    uses_check: bool = False

    @property
    def graded(self) -> tuple[MasterCell, ...]:
        """The graded cells."""
        return tuple(cell for cell in self.cells.values() if cell.grade)

    @property
    def checks(self) -> list[str]:
        """The names in cells of the instructor's file that are exactly ``check(name)``, graded or not."""
        sources = (source for cell_type, source in self.by_text if cell_type == "code" and source.startswith("check("))
        return [name for source in sources if (name := checked_name(source)) is not None]

    @property
    def digest(self) -> str:
        """Changes when a cell of the instructor changes."""
        rows = [[getattr(cell, name) for name in MasterCell.__dataclass_fields__] for cell in self.cells.values()]
        return hashlib.sha256(json.dumps([self.notebook, rows]).encode()).hexdigest()

    @property
    def draws(self) -> bool:
        """Whether a cell of the instructor's names plotly, or directrix, which draws with it."""
        sources = [*(cell.source for cell in self.cells.values()), *(source for _, source in self.by_text)]
        return any("plotly" in source or "directrix" in source for source in sources)

    def beside(self, released: Path) -> Master:
        """The same with metadata and attachments read from the instructor's file, if there is such a file."""
        try:
            notebook = json.loads(released.read_bytes())
            listed = list(_listed(notebook))
        except (OSError, ValueError, AttributeError, TypeError):
            return self
        by_text: dict[tuple[str, str], Known] = {}
        by_name: dict[str, Known] = {}
        order: list[str] = []
        for cell_type, source, name, known in listed:
            by_text.setdefault((cell_type, source), known)
            if name:
                by_name[name] = known
                order.append(name)
        place = {name: number for number, name in enumerate(order)}
        cells = dict(sorted(self.cells.items(), key=lambda item: place.get(item[0], len(place))))
        uses_check = any("autograder" in source for _, source, _, _ in listed)
        return Master(self.notebook, cells, self.kernelspec, by_text, by_name, uses_check or self.uses_check)


def given(released: Path) -> tuple[str, ...]:
    """The code cells of a released notebook, but for exercise cells: what most processes of the class will run, in order."""
    try:
        listed = list(_listed(json.loads(released.read_bytes())))
    except (OSError, ValueError, AttributeError, TypeError, KeyError):
        return ()
    return tuple(source for kind, source, *_ in listed if kind == "code" and checked_name(source) is None)


def _listed(notebook: Any) -> Iterator[tuple[str, str, str, Known]]:
    for cell in notebook["cells"]:
        source = cell.get("source", "")
        source = "".join(source) if isinstance(source, list) else source
        metadata = dict(cell.get("metadata", {}))
        name = metadata.pop("nbgrader", {}).get("grade_id", "")
        yield cell["cell_type"], source, name, Known(metadata, cell.get("attachments", {}))


@functools.lru_cache(maxsize=4096)
def checked_name(source: str) -> str | None:
    """``cylinder`` for a cell that is exactly ``check(cylinder)``, else None."""
    try:
        body = ast.parse(source).body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None
    match body:
        case [ast.Expr(ast.Call(func=ast.Name("check"), args=[ast.Name(name)], keywords=[]))]:
            return name
    return None


def checksum(cell_type: str, source: str, cell: MasterCell) -> str:
    """nbgrader's checksum of a cell with this text under the instructor's flags (``nbgrader.utils.compute_checksum``)."""
    locked = not cell.solution and (cell.grade or cell.locked)
    parts = [source, cell_type, str(cell.grade), str(cell.solution), str(locked), cell.name]
    if cell.grade:
        parts.append(str(float(cell.points or 0.0)))
    return hashlib.md5("".join(parts).encode("utf-8", "surrogatepass")).hexdigest()
