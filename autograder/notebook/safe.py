"""What a learner's notebook may show: HTML, Markdown, figures and outputs made harmless by the trusted side.

Whatever passes here is valid JSON and valid Unicode, of a known mime type, and neither runs a script nor asks the network for
anything. The same rules hold when a notebook is written to ``autograded/`` and when it is shown.
"""

from __future__ import annotations

import base64
import binascii
import json
import math
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import nh3

from autograder.messages import say
from autograder.notebook.shallow import shallow
from autograder.notebook.told import told
from autograder.sandbox.outputs import LARGEST, Drawn

FIGURE = "application/vnd.plotly.v1+json"
IMAGES = {"image/png": b"\x89PNG", "image/jpeg": b"\xff\xd8\xff", "image/gif": b"GIF8"}
TEXTS = ("text/plain", "text/latex")
MAX_TEXT = 1_000_000
MAX_IMAGE = 8_000_000
MAX_FIGURE = 8_000_000
MAX_OUTPUTS = 200

_TAGS = {
    "a", "abbr", "b", "blockquote", "br", "caption", "code", "col", "colgroup", "dd", "del", "details", "div", "dl", "dt",
    "em", "figcaption", "figure", "h1", "h2", "h3", "h4", "h5", "h6", "hr", "i", "img", "ins", "kbd", "li", "mark", "ol",
    "p", "pre", "q", "s", "samp", "section", "small", "span", "strong", "sub", "summary", "sup", "table", "tbody", "td",
    "tfoot", "th", "thead", "tr", "tt", "u", "ul", "var",
}  # fmt: skip
_ATTRIBUTES = {
    "*": {"style", "title", "role", "aria-label", "aria-hidden", "dir", "lang"},
    "a": {"href"},
    "img": {"src", "alt", "width", "height"},
    "td": {"colspan", "rowspan", "align"},
    "th": {"colspan", "rowspan", "scope", "align"},
    "col": {"span"},
    "colgroup": {"span"},
    "ol": {"start", "type"},
    "details": {"open"},
}
# No property that takes a url(), moves an element out of its place or lays it over others.
_STYLES = {
    "color", "background-color", "border", "border-bottom", "border-collapse", "border-color", "border-left", "border-radius",
    "border-right", "border-spacing", "border-style", "border-top", "border-width", "box-sizing", "caption-side", "display",
    "flex", "flex-direction", "flex-wrap", "font", "font-family", "font-size", "font-style", "font-variant",
    "font-variant-numeric", "font-weight", "gap", "grid-template-columns", "height", "justify-content", "align-items",
    "letter-spacing", "line-height", "margin", "margin-bottom", "margin-left", "margin-right", "margin-top", "max-height",
    "max-width", "min-width", "opacity", "overflow", "overflow-x", "overflow-wrap", "padding", "padding-bottom",
    "padding-left", "padding-right", "padding-top", "text-align", "text-decoration", "text-transform", "vertical-align",
    "white-space", "width", "word-break", "color-scheme",
}  # fmt: skip
# A margin below 0 lays an element over others.
_REACHING = re.compile(r"url\s*\(|image|expression|calc|\\|margin[\w-]*\s*:[^;]*-", re.IGNORECASE)
# Traces and layouts that fetch maps or pictures when they are drawn.
_FETCHING = re.compile(r"mapbox|geo|choropleth|(scatter|density)map")
CONTROLS = ("updatemenus", "sliders")
_CHANGING = re.compile(rf'images|"\w*({_FETCHING.pattern})\w*"')  # in what they do when somebody uses them
_RAW_TAG = re.compile(r"<(?=[A-Za-z/!?])(?!https?://[^\s<>\"']+>)")
_FENCE = re.compile(r" {0,3}(`{3,}|~{3,})(.*)")
_TICKS = re.compile("`+")


def clean_html(html: str) -> str:
    """HTML without scripts, event handlers, forms, classes and ids, and without anything that is fetched."""
    return nh3.clean(
        shallow(html, _TAGS),
        tags=_TAGS,
        attributes=_ATTRIBUTES,
        attribute_filter=_attribute,
        allowed_classes={"table": {"dataframe"}},
        clean_content_tags={"script", "style", "template", "noscript", "iframe", "object", "svg", "math", "title"},
        url_schemes={"http", "https", "mailto", "data"},
        filter_style_properties=_STYLES,
    )


def _attribute(tag: str, name: str, value: str) -> str | None:
    if tag == "img" and name == "src":
        return value if is_image(value) else None
    if name == "href" and value.strip().lower().startswith("data:"):
        return None
    if name == "style" and _REACHING.search(value):
        return None
    return value


def is_image(source: str) -> bool:
    """Whether this is a ``data:`` picture of a kind that cannot hold a script."""
    head, _, data = source.partition(",")
    mime = head.removeprefix("data:").removesuffix(";base64")
    return head == f"data:{mime};base64" and picture(mime, data) is not None


def picture(mime: str, data: object) -> str | None:
    """The base64 text of a picture, if it is one of the kind that it says."""
    if mime not in IMAGES or not isinstance(data, str) or len(data) > MAX_IMAGE:
        return None
    try:
        raw = base64.b64decode("".join(data.split()), validate=True)
    except (binascii.Error, ValueError):
        return None
    return base64.b64encode(raw).decode("ascii") if raw.startswith(IMAGES[mime]) else None


def escape_markdown(source: str) -> str:
    """The same Markdown with every raw HTML tag outside code turned into text."""
    lines = []
    fence = ""
    for line in source.split("\n"):
        opened = _FENCE.match(line)
        if fence:
            if opened and opened[1].startswith(fence) and not opened[2].strip():
                fence = ""
            lines.append(line)
        elif opened and not (opened[1][0] == "`" and "`" in opened[2]):
            fence = opened[1]
            lines.append(opened[0][: opened.start(2)] + _RAW_TAG.sub("&lt;", opened[2]))
        else:
            lines.append(_escaped_line(line))
    return "\n".join(lines)


def _escaped_line(line: str) -> str:
    parts = []
    end = 0
    for begun, ended in _code_spans(line):
        parts += [_RAW_TAG.sub("&lt;", line[end:begun]), line[begun:ended]]
        end = ended
    return "".join([*parts, _RAW_TAG.sub("&lt;", line[end:])])


def _code_spans(line: str) -> Iterator[tuple[int, int]]:
    """Code between two runs of equally many backticks; in one pass, however many runs have no second."""
    runs = [run.span() for run in _TICKS.finditer(line)]
    closing: list[int] = []  # the end of the next run of the same length, from the last run to the first; 0 if there is none
    later: dict[int, int] = {}
    for start, end in reversed(runs):
        closing.append(later.get(end - start, 0))
        later[end - start] = end
    at = 0
    for (start, _), end in zip(runs, reversed(closing), strict=True):
        if end and start >= at:
            yield start, end
            at = end


def text(value: object, limit: int = MAX_TEXT) -> str:
    """A text (or nbformat's list of lines) as valid Unicode of bounded length."""
    joined = "".join(part for part in value if isinstance(part, str)) if isinstance(value, list) else value
    if not isinstance(joined, str):
        return ""
    valid = joined.encode("utf-16", "surrogatepass").decode("utf-16", "replace") if not joined.isascii() else joined
    return valid if len(valid) <= limit else f"{valid[:limit]}\n{say('graded.cut.text')}"


class Figure(dict[str, Any]):
    """A figure that passed, with its JSON as it is written to a file: whoever changes the figure must not use ``written``."""

    written: bytes = b""


def figure(value: object) -> Figure | None:
    """A plotly figure reduced to data and layout, finite numbers, no pictures or maps from elsewhere; None if it is none."""
    if not isinstance(value, Drawn):
        return _figure(value)
    if "harmless" not in value.found:
        value.found["harmless"] = _figure(value)
    found: Figure | None = value.found["harmless"]
    return found


def _figure(value: object) -> Figure | None:
    if not isinstance(value, Mapping) or not isinstance(value.get("data"), list):
        return None
    layout = value.get("layout", {})
    if not isinstance(layout, Mapping) or not all(isinstance(trace, Mapping) for trace in value["data"]):
        return None
    if any(_FETCHING.search(str(trace.get("type", ""))) for trace in value["data"]):
        return None
    try:
        plain = Figure(plain_json({"data": value["data"], "layout": _layout(layout)}))
        plain.written = json.dumps(plain, sort_keys=True, ensure_ascii=False, allow_nan=False).encode("utf-8")
        size = len(plain.written) if plain.written.isascii() else len(json.dumps(plain, allow_nan=False))
    except (TypeError, ValueError, RecursionError):
        return None
    return plain if size <= MAX_FIGURE else None


def _layout(layout: Mapping[str, Any]) -> dict[str, Any]:
    """A layout without pictures and maps, those of its template and of its buttons too."""
    kept = {key: part for key, part in layout.items() if key != "images" and not _FETCHING.search(str(key))}
    for name in CONTROLS:
        if name in kept and _CHANGING.search(json.dumps(kept[name])):
            del kept[name]
    if isinstance(kept.get("template"), Mapping):
        kept["template"] = _template(kept["template"])
    return kept


def _template(template: Mapping[str, Any]) -> dict[str, Any]:
    """A template likewise: a trace without a type would take the one that its template says."""
    kept = dict(template)
    if isinstance(kept.get("layout"), Mapping):
        kept["layout"] = _layout(kept["layout"])
    if isinstance(kept.get("data"), Mapping):
        kept["data"] = {kind: list(map(_typeless, items)) for kind, items in kept["data"].items() if isinstance(items, list)}
    return kept


def _typeless(trace: Any) -> Any:
    return {key: part for key, part in trace.items() if key != "type"} if isinstance(trace, Mapping) else trace


def plain_json(value: Any) -> Any:
    """The same value with valid Unicode and with None where a number is not finite."""
    if isinstance(value, str):
        return value if len(value) <= MAX_TEXT and value.isascii() else text(value)
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if type(value) is dict or isinstance(value, Mapping):
        return {text(str(key)): plain_json(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [plain_json(part) for part in value]
    if value is None or isinstance(value, bool):
        return value
    if isinstance(value, int):
        return value if abs(value) <= LARGEST else None  # what is no float either stops whoever reckons with it
    raise TypeError(f"not JSON: {type(value).__name__}")


def bundle(data: object) -> dict[str, Any]:
    """A mime bundle with the known kinds only, each made harmless."""
    if not isinstance(data, Mapping):
        return {}
    clean: dict[str, Any] = {}
    for mime, value in data.items():
        if mime in TEXTS:
            clean[mime] = text(told(value))
        elif mime == "text/html":
            clean[mime] = clean_html(text(value))
        elif mime == "text/markdown":
            clean[mime] = escape_markdown(text(value))
        elif mime in IMAGES:
            shown = picture(mime, text(value, MAX_IMAGE))
            if shown is not None:
                clean[mime] = shown
        elif mime == FIGURE:
            drawn = figure(value)
            if drawn is not None:
                clean[mime] = drawn
    return clean


def outputs(given: Iterable[Any]) -> list[dict[str, Any]]:
    """nbformat-4 outputs from the whitelist, without metadata; what is not understood is dropped."""
    clean = []
    for output in given:
        known = _output(output) if isinstance(output, Mapping) else None
        if known is not None:
            clean.append(known)
        if len(clean) >= MAX_OUTPUTS:
            break
    return clean


def _output(output: Mapping[str, Any]) -> dict[str, Any] | None:
    kind = output.get("output_type")
    if kind == "stream":
        name = "stderr" if output.get("name") == "stderr" else "stdout"
        return {"output_type": "stream", "name": name, "text": text(output.get("text"))}
    if kind == "error":
        traceback = output.get("traceback")
        lines = [text(line) for line in traceback if isinstance(line, str)] if isinstance(traceback, list) else []
        named = {"ename": text(output.get("ename"), 200), "evalue": text(output.get("evalue"), 10_000)}
        return {"output_type": "error", **named, "traceback": lines[:500]}
    if kind in ("display_data", "execute_result"):
        known: dict[str, Any] = {"output_type": kind, "data": bundle(output.get("data")), "metadata": {}}
        if kind == "execute_result":
            count = output.get("execution_count")
            known["execution_count"] = count if isinstance(count, int) and not isinstance(count, bool) else None
        return known if known["data"] or kind == "execute_result" else None
    return None


def attachments(given: object) -> dict[str, dict[str, str]]:
    """Pictures pasted into a Markdown cell; anything else attached is dropped."""
    clean: dict[str, dict[str, str]] = {}
    if isinstance(given, Mapping):
        for name, kinds in list(given.items())[:50]:
            found = {mime: shown for mime, data in _items(kinds) if (shown := picture(mime, text(data, MAX_IMAGE)))}
            if found and isinstance(name, str):
                clean[text(name, 200)] = found
    return clean


def _items(kinds: object) -> Iterable[tuple[str, object]]:
    return kinds.items() if isinstance(kinds, Mapping) else ()
