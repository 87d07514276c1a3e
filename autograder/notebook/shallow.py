"""HTML whose parsing takes time, and gives a page, in proportion to its length: what nests is closed, and nests so deep only.

The rules by which HTML is parsed mend what is nested wrongly by making elements again: ``<p><b id=1><p><b id=2>...`` grows with
the square of its length, and what lies ten thousand deep takes as long. Here every element ends before the one around it does,
as in what programs write; the sanitiser then decides what may stay.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator

DEEPEST = 50  # elements in each other; the tags of deeper ones are dropped
# A tag is read as the HTML standard reads it, or else it is text. Possessive: linear on any input.
_TAG = re.compile(
    r"<(?P<end>/?)(?P<name>[A-Za-z][A-Za-z0-9]*+)"
    r"""(?P<more>(?:\s++[^\s"'<>/=]++(?:\s*+=\s*+(?:"[^"]*+"|'[^']*+'|[^\s"'<>=`]++))?+)*+\s*+/?+)>""",
    re.ASCII,
)
_MARK = re.compile(r"<[!?/]")
_VOID = {"br", "col", "hr", "img"}
_RAW = {"script", "style", "template", "noscript", "iframe", "object", "svg", "math", "title", "textarea", "xmp", "noembed",
        "noframes", "plaintext", "select"}  # fmt: skip
_BLOCKS = ("blockquote", "details", "div", "dl", "figure", "h1", "h2", "h3", "h4", "h5", "h6", "ol", "p", "pre", "section",
           "table", "ul")  # fmt: skip
_CELLS, _GROUPS = ("td", "th"), ("tbody", "thead", "tfoot")
# What the beginning of an element ends, where it comes right after.
_ENDS: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(_BLOCKS, ("p",)), "li": ("li",), "dt": ("dt", "dd"), "dd": ("dt", "dd"), **dict.fromkeys(_CELLS, _CELLS),
    "tr": ("tr", *_CELLS), **dict.fromkeys(_GROUPS, (*_GROUPS, "tr", *_CELLS)),
}  # fmt: skip


def shallow(html: str, known: Collection[str]) -> str:
    """The same with tags of ``known`` elements only, all closed in order; comments and scripts are left out."""
    return "".join(_parts(html, known)) if "<" in html else html


def _parts(html: str, known: Collection[str]) -> Iterator[str]:
    is_open: list[str] = []
    endless: set[str] = set()
    at = 0
    while (start := html.find("<", at)) >= 0:
        yield html[at:start]
        tag = _TAG.match(html, start)
        if tag is None:
            at, shown = _no_tag(html, start)
            yield shown
            continue
        at, name = tag.end(), tag["name"].lower()
        if name in _RAW and name not in endless and not tag["end"]:
            found = re.compile(rf"</{name}[\s/>]", re.IGNORECASE).search(html, at)
            if found is None:
                endless.add(name)  # its tag is an unknown one then
            else:
                at = found.start()
        elif name not in known:
            continue
        elif name in _VOID:
            yield f"<{name}{tag['more']}>" if not tag["end"] else ""
        elif tag["end"]:
            while name in is_open:
                last = is_open.pop()
                yield f"</{last}>"
                if last == name:
                    break
        else:
            while is_open and is_open[-1] in _ENDS.get(name, ()):
                yield f"</{is_open.pop()}>"
            if len(is_open) < DEEPEST:
                is_open.append(name)
                yield f"<{name}{tag['more'].removesuffix('/')}>"
    yield html[at:]
    yield from (f"</{name}>" for name in reversed(is_open))


def _no_tag(html: str, start: int) -> tuple[int, str]:
    """Where to read on after a "<" that begins no tag, and what is shown for it."""
    if _MARK.match(html, start) is None:
        return start + 1, "&lt;"
    end = "-->" if html.startswith("<!--", start) else ">"
    found = html.find(end, start + 2)
    return (len(html), "") if found < 0 else (found + len(end), "")
