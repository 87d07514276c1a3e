"""LaTeX to MathML, which browsers draw by themselves: no script of MathJax, no network.

latex2mathml does the work, but passes markup through (``\\text{<script>}``, ``\\href{javascript:...}``), so its answer is read
as XML and written again from a list of elements and attributes. What does not pass is shown as its source.
"""

from __future__ import annotations

import functools
import html
import re
from xml.etree import ElementTree

from latex2mathml.converter import convert

LONGEST = 5_000
LONGEST_KEPT = 500  # letters: MathML is a hundred times as long
NAMESPACE = "http://www.w3.org/1998/Math/MathML"
ELEMENTS = {
    "math", "menclose", "merror", "mfenced", "mfrac", "mi", "mmultiscripts", "mn", "mo", "mover", "mpadded", "mphantom",
    "mprescripts", "mroot", "mrow", "ms", "mspace", "msqrt", "mstyle", "msub", "msubsup", "msup", "mtable", "mtd", "mtext",
    "mtr", "munder", "munderover", "none",
}  # fmt: skip
ATTRIBUTES = {
    "accent", "accentunder", "close", "columnalign", "columnlines", "columnspacing", "depth", "display", "displaystyle",
    "fence", "form", "height", "linebreak", "linethickness", "lspace", "mathcolor", "mathsize", "mathvariant", "maxsize",
    "minsize", "movablelimits", "notation", "open", "rowlines", "rowspacing", "rspace", "scriptlevel", "separator",
    "separators", "stretchy", "symmetric", "voffset", "width",
}  # fmt: skip
# Environments that latex2mathml does not know, all drawn as the one that it knows.
_ENVIRONMENT = re.compile(r"\\(begin|end)\{(?:aligned|align|gather\*?|gathered|eqnarray\*?)\}")
_NUMBERED = re.compile(r"\\(?:begin|end)\{equation\*?\}|\\label\{[^{}]*\}|\\(?:nonumber|notag)\b")


def mathml(latex: str, *, block: bool) -> str:
    """The formula as a MathML element, or its source in ``<code>`` where it cannot be converted. What is short is kept."""
    return _converted(latex, block) if len(latex) <= LONGEST_KEPT else _converted.__wrapped__(latex, block)


@functools.lru_cache(maxsize=4096)
def _converted(latex: str, block: bool) -> str:
    source = _NUMBERED.sub("", _ENVIRONMENT.sub(r"\\\1{align*}", latex)).strip()
    shown = f"<code>{html.escape(latex.strip())}</code>"
    if not source or len(source) > LONGEST:
        return shown
    try:
        tree = ElementTree.fromstring(convert(source, display="block" if block else "inline"))
        _check(tree)
        _space_functions(tree)
    except Exception:  # whatever a formula does to the converter, the page goes on
        return shown
    ElementTree.register_namespace("", NAMESPACE)
    return ElementTree.tostring(tree, encoding="unicode", short_empty_elements=False)


def _check(tree: ElementTree.Element) -> None:
    for element in tree.iter():
        namespace, _, name = element.tag.rpartition("}")
        if namespace != f"{{{NAMESPACE}" or name not in ELEMENTS:
            raise ValueError(f"{element.tag} has no place in a formula")
        for attribute in [key for key in element.attrib if key not in ATTRIBUTES]:
            del element.attrib[attribute]


def _space_functions(tree: ElementTree.Element) -> None:
    """Put the thin spaces of TeX round names such as cos, which the converter leaves out."""
    for parent in list(tree.iter(f"{{{NAMESPACE}}}mrow")) + [tree]:
        spaced: list[ElementTree.Element] = []
        for child in parent:
            if spaced and _is_function(spaced[-1]) and not _is_operator(child):
                spaced.append(_thin_space())
            if spaced and _is_function(child) and not _is_operator(spaced[-1]) and spaced[-1].tag != _thin_space().tag:
                spaced.append(_thin_space())
            spaced.append(child)
        parent[:] = spaced


def _is_function(element: ElementTree.Element) -> bool:
    named = element[0] if len(element) and element.tag in (f"{{{NAMESPACE}}}msup", f"{{{NAMESPACE}}}msub") else element
    return named.tag == f"{{{NAMESPACE}}}mi" and (named.text or "").isascii() and len(named.text or "") > 1


def _is_operator(element: ElementTree.Element) -> bool:
    return element.tag == f"{{{NAMESPACE}}}mo"


def _thin_space() -> ElementTree.Element:
    return ElementTree.Element(f"{{{NAMESPACE}}}mspace", width="0.167em")
