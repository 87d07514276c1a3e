"""One feedback page: a graded notebook as a single HTML file that needs no network and runs no learner's script.

The page says by a Content-Security-Policy which scripts may run, by their hashes: plotly.js and the one that draws figures.
Everything that a learner wrote passes the sanitiser here once more, whoever wrote the graded notebook.
"""

from __future__ import annotations

import base64
import functools
import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import jinja2
from directrix.plot import page as figures
from markupsafe import Markup

from autograder.feedback.cells import LONGEST_KEPT, code_html, folded, joined, output_html, phrase, style
from autograder.feedback.hide import Hidden
from autograder.feedback.markdown import FindImage, to_html
from autograder.notebook.master import checked_name

PAGE = Path(__file__).with_name("page.css")


@dataclass(frozen=True)
class Scored:
    """What the gradebook says of one graded cell. ``points`` None: a person has still to decide."""

    points: float | None
    available: float
    look: bool = False


@dataclass(frozen=True)
class Absent:
    """Another notebook of the assignment that has no page: ``unread`` if it was handed in and could not be read."""

    notebook: str
    points: float
    available: float
    unread: bool = False


@dataclass(frozen=True)
class Sheet:
    """What stands above a page and beside its cells."""

    notebook: str
    assignment: str
    student: str
    cells: Mapping[str, Scored] = field(default_factory=dict)
    comments: Mapping[str, str] = field(default_factory=dict)
    penalty: float = 0.0
    absent: Sequence[Absent] = ()

    @property
    def score(self) -> float:
        """The points of the notebook, late penalty taken off."""
        return sum(cell.points or 0.0 for cell in self.cells.values()) - self.penalty

    @property
    def available(self) -> float:
        """The points there were."""
        return sum(cell.available for cell in self.cells.values())


def render(notebook: Mapping[str, Any], sheet: Sheet, *, hidden: Hidden | None = None, image: FindImage | None = None) -> str:
    """The page of a graded notebook (nbformat 4).

    Parameters
    ----------
    hidden : Hidden, optional
        Markers of what learners must not read; default nbgrader's.
    image : callable, optional
        The ``data:`` address of a picture that the notebook names by a relative path.
    """
    marks = hidden or Hidden()
    cells = [_cell(marks.cell(joined(cell)), sheet, image) for cell in notebook["cells"]]
    drawn = any(cell["figures"] for cell in cells)
    head, policy = _scripts() if drawn else ("", _policy())
    return _template().render(
        sheet=sheet, cells=cells, head=Markup(head), policy=policy, style=Markup(style(PAGE)),
        points=_points, bold=_bold, say=phrase, listed=[cell for cell in cells if cell["scored"]],
    )  # fmt: skip


def _cell(cell: Mapping[str, Any], sheet: Sheet, image: FindImage | None) -> dict[str, Any]:
    meta = cell.get("metadata", {}).get("nbgrader") or {}
    name = meta.get("grade_id", "")
    kind = cell["cell_type"]
    graded = name in sheet.cells
    checked = checked_name(cell["source"]) if graded and kind == "code" else None
    outputs = [output_html(output, judged=checked is not None) for output in cell.get("outputs", ())]
    if kind == "markdown":
        body = _markdown(cell["source"], cell.get("attachments", {}), image)
    else:
        body = code_html(cell["source"]) if kind == "code" else f"<pre>{Markup.escape(cell['source'])}</pre>"
    return {
        "kind": kind,
        "name": name,
        "label": checked or name,
        "body": Markup(body) if cell["source"].strip() else "",
        "outputs": [Markup(html) for html, _ in outputs if html],
        "figures": any(drawn for _, drawn in outputs),
        "scored": sheet.cells.get(name) if graded else None,
        "comment": Markup(to_html(sheet.comments[name])) if name in sheet.comments else "",
        "folded": folded(cell),
        "answer": bool(meta.get("solution") or meta.get("task")),
    }


def _markdown(source: str, attachments: Mapping[str, Any], image: FindImage | None) -> str:
    """A text, rendered once for all learners where it is short and can show no picture."""
    pictures = attachments or "![" in source or "<img" in source.lower()
    kept = not pictures and len(source) <= LONGEST_KEPT
    return _text_only(source) if kept else to_html(source, attachments=attachments, image=image)


@functools.lru_cache(maxsize=1000)  # the instructor's texts, which come again with every learner
def _text_only(source: str) -> str:
    return to_html(source)


def _points(value: float | None) -> str:
    return "–" if value is None else f"{round(value, 2):g}"


def _bold(text: str) -> Markup:
    return Markup("<b>{}</b>").format(text)


@functools.cache
def _scripts() -> tuple[str, str]:
    """The scripts of a page with figures, and the policy that allows exactly these."""
    return figures.head(), _policy(*figures.running_scripts())


def _policy(*scripts: str) -> str:
    hashes = [f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'" for text in scripts]
    allowed = " ".join(hashes) or "'none'"
    return f"default-src 'none'; style-src 'unsafe-inline'; img-src data: blob:; font-src data:; script-src {allowed}"


@functools.cache
def _template() -> jinja2.Template:
    environment = jinja2.Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    return environment.from_string(Path(__file__).with_name("page.html.j2").read_text("utf-8"))
