"""Cells of an executed notebook as HTML, for every page we write: code with its colours, outputs made harmless, figures."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pygments  # type: ignore[import-untyped]
from directrix.plot import page as figures
from markupsafe import Markup
from pygments.formatters import HtmlFormatter  # type: ignore[import-untyped]
from pygments.lexers import Python3Lexer  # type: ignore[import-untyped]

from autograder import messages
from autograder.feedback.hide import strip_ansi
from autograder.feedback.markdown import to_html
from autograder.messages import say
from autograder.notebook.safe import FIGURE, IMAGES, clean_html, figure, picture

LONGEST_CODE, LONGEST_LINE = 200_000, 2_000  # characters of code that gets colours
LONGEST_KEPT = 5_000  # letters: a thousand cells that are longer would be much to hold
Admit = Callable[[Any], Mapping[str, Any] | None]


def phrase(key: str, **facts: str) -> Markup:
    """A text of the catalogue, whose facts may be HTML already."""
    return Markup(Markup.escape(messages.TEXT[key])).format(**facts)


def folded(cell: Mapping[str, Any]) -> bool:
    """Whether the code of a cell is folded away."""
    jupyter = cell.get("metadata", {}).get("jupyter")
    return isinstance(jupyter, Mapping) and jupyter.get("source_hidden") is True


def output_html(output: Mapping[str, Any], *, judged: bool = False, admit: Admit = figure) -> tuple[str, bool]:
    """HTML of one output, and whether it is a figure. The points under a judged cell stand in its heading already.

    ``admit`` gives the figure that is shown, or None; by default only what a learner's figure may hold, so without frames.
    """
    kind = output["output_type"]
    if kind == "stream":
        return f'<pre class="{output["name"]}">{Markup.escape(strip_ansi(output["text"]))}</pre>', False
    if kind == "error":
        lines = "\n".join(output["traceback"]) or f"{output['ename']}: {output['evalue']}"
        return f'<pre class="error">{Markup.escape(strip_ansi(lines))}</pre>', False
    if kind == "execute_result" and judged:
        return "", False
    return _shown(output.get("data", {}), admit)


def _shown(data: Mapping[str, Any], admit: Admit) -> tuple[str, bool]:
    drawn = admit(data[FIGURE]) if FIGURE in data else None
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


def joined(cell: Mapping[str, Any]) -> dict[str, Any]:
    """The cell with lists of lines joined, as a file has them and nbformat does not."""
    whole = {**cell, "source": _text(cell["source"])}
    if "outputs" in cell:
        whole["outputs"] = [
            {
                **output,
                **({"text": _text(output["text"])} if "text" in output else {}),
                **({"data": {mime: _text(value) for mime, value in output["data"].items()}} if "data" in output else {}),
            }
            for output in cell["outputs"]
        ]
    return whole


def _text(value: Any) -> Any:
    return "".join(value) if isinstance(value, list) and all(isinstance(line, str) for line in value) else value


def code_html(source: str) -> str:
    """Python with its colours; what is short is kept, for an instructor's cells come again with every learner."""
    if len(source) > LONGEST_CODE or max(map(len, source.split("\n"))) > LONGEST_LINE:  # the lexer may take the square of that
        return f'<div class="highlight"><pre>{Markup.escape(source)}</pre></div>'
    return _coloured(source) if len(source) <= LONGEST_KEPT else _coloured.__wrapped__(source)


@functools.lru_cache(maxsize=1000)
def _coloured(source: str) -> str:
    return str(pygments.highlight(source, Python3Lexer(), HtmlFormatter(nowrap=False, cssclass="highlight")))


@functools.cache
def style(*sheets: Path) -> str:
    """The colours of code, light and dark, and these style sheets."""
    light = HtmlFormatter(style="default").get_style_defs(".highlight")
    dark = HtmlFormatter(style="github-dark").get_style_defs(".highlight")
    own = "\n".join(sheet.read_text("utf-8") for sheet in sheets)
    return f"{light}\n@media screen and (prefers-color-scheme: dark) {{\n{dark}\n}}\n{own}"
