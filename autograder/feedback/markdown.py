"""Markdown of a notebook as harmless HTML: formulas as MathML, pictures inlined, everything else through the sanitiser."""

from __future__ import annotations

import bisect
import functools
import html
import re
from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any

import mistune
from mistune.plugins import import_plugin
from mistune.plugins.math import math, math_in_list, math_in_quote

from autograder.feedback.formula import mathml
from autograder.notebook.safe import clean_html, is_image

FindImage = Callable[[str], str | None]
# Formulas are put in after sanitising, in the place of such a token; the letters stand in no text that comes in.
OPEN, CLOSE = "\ue000", "\ue001"
_TOKEN = re.compile(f"{OPEN}(\\d+){CLOSE}")
_ENVIRONMENT = r"^ {0,3}(?P<environment>\\begin\{(?P<called>[a-z]+\*?)\})"
_END = re.compile(r"\\end\{([a-z]+\*?)\}(?=[ \t]*$)", re.MULTILINE)
USES = 3  # of one attached picture in a cell: each is written out


def to_html(source: str, *, attachments: Mapping[str, Mapping[str, str]] | None = None, image: FindImage | None = None) -> str:
    """HTML of one Markdown cell.

    Parameters
    ----------
    attachments : mapping
        Pictures of the cell: name to mime type to base64.
    image : callable, optional
        The ``data:`` address of a picture named by a relative path, or None.
    """
    formulas: list[str] = []
    renderer = _Renderer(formulas, attachments or {}, image)
    plugins: list[Any] = ["table", "strikethrough", "url", math, math_in_list, math_in_quote, _environments]
    convert = mistune.Markdown(renderer=renderer)
    for plugin in plugins:
        (import_plugin(plugin) if isinstance(plugin, str) else plugin)(convert)
    renderer.register("block_math", lambda _, text: renderer.formula(text, block=True))
    renderer.register("inline_math", lambda _, text: renderer.formula(text, block=False))
    rendered = str(convert(source.replace(OPEN, "").replace(CLOSE, "")))
    return _TOKEN.sub(lambda found: formulas[int(found[1])], clean_html(rendered))


class _Renderer(mistune.HTMLRenderer):
    def __init__(self, formulas: list[str], attachments: Mapping[str, Mapping[str, str]], image: FindImage | None) -> None:
        super().__init__(escape=False)
        self.formulas, self.attachments, self.find = formulas, attachments, image
        self.uses: Counter[str] = Counter()

    def formula(self, text: str, *, block: bool) -> str:
        self.formulas.append(mathml(html.unescape(text), block=block))
        token = f"{OPEN}{len(self.formulas) - 1}{CLOSE}"
        return f"<p>{token}</p>\n" if block else token

    def image(self, text: str, url: str, title: str | None = None) -> str:
        source = self._source(url)
        words = html.escape(text, quote=True)
        if source is None:
            shown = f"[{words or 'picture'}]"
            return f'<a href="{html.escape(url, quote=True)}">{shown}</a>' if url.startswith(("http:", "https:")) else shown
        return f'<img src="{source}" alt="{words}">'

    def _source(self, url: str) -> str | None:
        if url.startswith("attachment:"):
            self.uses[url] += 1
            kinds = self.attachments.get(url.removeprefix("attachment:"), {}) if self.uses[url] <= USES else {}
            url = next((f"data:{mime};base64,{data}" for mime, data in kinds.items()), "")
        elif not url.startswith("data:"):
            url = (self.find(url) if self.find is not None else None) or ""
        return url if is_image(url) else None


def _environments(md: mistune.Markdown) -> None:
    def parse(block: Any, found: re.Match[str], state: Any) -> int | None:
        ends = _ends(state.src).get(found["called"], [])
        after = bisect.bisect(ends, found.end())
        if after == len(ends):
            return None
        begin, end = found.start("environment"), ends[after]
        state.append_token({"type": "block_math", "raw": state.src[begin:end]})
        line: int = state.src.find("\n", end)
        return len(state.src) if line < 0 else line + 1

    md.block.register("latex", _ENVIRONMENT, parse, before="list")


@functools.lru_cache(maxsize=2)
def _ends(source: str) -> dict[str, list[int]]:
    """Where environments end, by name; found once, not for each that begins and does not end."""
    found: dict[str, list[int]] = {}
    for end in _END.finditer(source):
        found.setdefault(end[1], []).append(end.end())
    return found
