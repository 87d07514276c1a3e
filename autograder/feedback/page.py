"""One feedback page: a graded notebook as a single HTML file that needs no network and runs no learner's script.

The page says by a Content-Security-Policy which scripts may run, by their hashes: plotly.js and the one that draws figures.
Everything that a learner wrote passes the sanitiser here once more, whoever wrote the graded notebook.
"""

from __future__ import annotations

import base64
import functools
import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import jinja2
import pygments  # type: ignore[import-untyped]
from directrix.plot import page as figures
from markupsafe import Markup
from pygments.formatters import HtmlFormatter  # type: ignore[import-untyped]
from pygments.lexers import Python3Lexer  # type: ignore[import-untyped]

from autograder import messages
from autograder.feedback.hide import Hidden, strip_ansi
from autograder.feedback.markdown import FindImage, to_html
from autograder.messages import say
from autograder.notebook.master import checked_name
from autograder.notebook.safe import FIGURE, IMAGES, clean_html, figure, picture


@dataclass(frozen=True)
class Scored:
    """What the gradebook says of one graded cell. ``points`` None: a person has still to decide."""

    points: float | None
    available: float
    look: bool = False


@dataclass(frozen=True)
class Sheet:
    """What stands above a page and beside its cells."""

    notebook: str
    assignment: str
    student: str
    cells: Mapping[str, Scored] = field(default_factory=dict)
    comments: Mapping[str, str] = field(default_factory=dict)
    penalty: float = 0.0

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
    cells = [_cell(marks.cell(_joined(cell)), sheet, image) for cell in notebook["cells"]]
    drawn = any(cell["figures"] for cell in cells)
    head, policy = _scripts() if drawn else ("", _policy())
    return _template().render(
        sheet=sheet, cells=cells, head=Markup(head), policy=policy, style=Markup(_style()),
        points=_points, bold=_bold, say=_say, listed=[cell for cell in cells if cell["scored"]],
    )  # fmt: skip


def _cell(cell: Mapping[str, Any], sheet: Sheet, image: FindImage | None) -> dict[str, Any]:
    meta = cell.get("metadata", {}).get("nbgrader") or {}
    name = meta.get("grade_id", "")
    kind = cell["cell_type"]
    graded = name in sheet.cells
    checked = checked_name(cell["source"]) if graded and kind == "code" else None
    outputs = [_output(output, judged=checked is not None) for output in cell.get("outputs", ())]
    if kind == "markdown":
        body = _markdown(cell["source"], cell.get("attachments", {}), image)
    else:
        body = _code(cell["source"]) if kind == "code" else f"<pre>{Markup.escape(cell['source'])}</pre>"
    return {
        "kind": kind,
        "name": name,
        "label": checked or name,
        "body": Markup(body) if cell["source"].strip() else "",
        "outputs": [Markup(html) for html, _ in outputs if html],
        "figures": any(drawn for _, drawn in outputs),
        "scored": sheet.cells.get(name) if graded else None,
        "comment": Markup(to_html(sheet.comments[name])) if name in sheet.comments else "",
        "folded": _folded(cell),
        "answer": bool(meta.get("solution") or meta.get("task")),
    }


def _folded(cell: Mapping[str, Any]) -> bool:
    jupyter = cell.get("metadata", {}).get("jupyter")
    return isinstance(jupyter, Mapping) and jupyter.get("source_hidden") is True


def _output(output: Mapping[str, Any], *, judged: bool) -> tuple[str, bool]:
    """HTML of one output, and whether it is a figure. The points under a judged cell stand in its heading already."""
    kind = output["output_type"]
    if kind == "stream":
        return f'<pre class="{output["name"]}">{Markup.escape(strip_ansi(output["text"]))}</pre>', False
    if kind == "error":
        lines = "\n".join(output["traceback"]) or f"{output['ename']}: {output['evalue']}"
        return f'<pre class="error">{Markup.escape(strip_ansi(lines))}</pre>', False
    if kind == "execute_result" and judged:
        return "", False
    return _shown(output.get("data", {}))


def _shown(data: Mapping[str, Any]) -> tuple[str, bool]:
    drawn = figure(data[FIGURE]) if FIGURE in data else None
    if drawn is not None:
        return figures.fragment(drawn), True
    if "text/html" in data:
        return f'<div class="html">{clean_html(data["text/html"])}</div>', False
    for mime in IMAGES:
        shown = picture(mime, data.get(mime))
        if shown is not None:
            words = Markup.escape(str(data.get("text/plain") or say("feedback.picture")))
            return f'<img src="data:{mime};base64,{shown}" alt="{words}">', False
    if "text/markdown" in data:
        return to_html(data["text/markdown"]), False
    if "text/latex" in data:
        return to_html(data["text/latex"]), False
    return f"<pre>{Markup.escape(strip_ansi(str(data['text/plain'])))}</pre>" if "text/plain" in data else "", False


def _joined(cell: Mapping[str, Any]) -> dict[str, Any]:
    """The cell with lists of lines joined, as a file has them and nbformat does not."""
    joined = {**cell, "source": _text(cell["source"])}
    if "outputs" in cell:
        joined["outputs"] = [
            {
                **output,
                **({"text": _text(output["text"])} if "text" in output else {}),
                **({"data": {mime: _text(value) for mime, value in output["data"].items()}} if "data" in output else {}),
            }
            for output in cell["outputs"]
        ]
    return joined


def _text(value: Any) -> Any:
    return "".join(value) if isinstance(value, list) and all(isinstance(line, str) for line in value) else value


def _markdown(source: str, attachments: Mapping[str, Any], image: FindImage | None) -> str:
    """A text, rendered once for all learners where it can show no picture."""
    pictures = attachments or "![" in source or "<img" in source.lower()
    return to_html(source, attachments=attachments, image=image) if pictures else _text_only(source)


@functools.lru_cache(maxsize=1000)  # the instructor's texts, which come again with every learner
def _text_only(source: str) -> str:
    return to_html(source)


@functools.lru_cache(maxsize=1000)
def _code(source: str) -> str:
    return str(pygments.highlight(source, Python3Lexer(), HtmlFormatter(nowrap=False, cssclass="highlight")))


def _points(value: float | None) -> str:
    return "–" if value is None else f"{round(value, 2):g}"


def _bold(text: str) -> Markup:
    return Markup("<b>{}</b>").format(text)


def _say(key: str, **facts: str) -> Markup:
    """A text of the catalogue, whose facts may be HTML already."""
    return Markup(Markup.escape(messages.TEXT[key])).format(**facts)


@functools.cache
def _scripts() -> tuple[str, str]:
    """The scripts of a page with figures, and the policy that allows exactly these."""
    return figures.head(), _policy(*figures.running_scripts())


def _policy(*scripts: str) -> str:
    hashes = [f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'" for text in scripts]
    allowed = " ".join(hashes) or "'none'"
    return f"default-src 'none'; style-src 'unsafe-inline'; img-src data: blob:; font-src data:; script-src {allowed}"


@functools.cache
def _style() -> str:
    light = HtmlFormatter(style="default").get_style_defs(".highlight")
    dark = HtmlFormatter(style="github-dark").get_style_defs(".highlight")
    own = Path(__file__).with_name("page.css").read_text("utf-8")
    return f"{light}\n@media (prefers-color-scheme: dark) {{\n{dark}\n}}\n{own}"


@functools.cache
def _template() -> jinja2.Template:
    environment = jinja2.Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    return environment.from_string(Path(__file__).with_name("page.html.j2").read_text("utf-8"))
