"""Source text as the tokens that carry its sense, each with its line.

Left out: comments, docstrings, layout. Neutral: strings, numbers but small whole ones, and every name that a learner is free to
choose. Kept: keywords, operators, attributes (``np.cos`` and ``math.cos`` are both ``cos``), names of keyword arguments, and
the built-in and ``math`` functions that are called.

One regular expression reads everything that a cell may hold: code with syntax errors, magics, half a string. It needs one step
for each letter, whatever the letters are.
"""

from __future__ import annotations

import builtins
import keyword
import math
import re
from collections.abc import Iterator
from typing import NamedTuple

_TOKEN = re.compile(
    r"""
      (?P<skip>   [^\S\n]+ | \#[^\n]* | \\\n )
    | (?P<line>   \n )
    | (?P<string> (?i:[rbuf]{0,2}) (?: \"{3} (?:[^\\]|\\.|\\\Z)*? (?:\"{3}|\Z) | '{3} (?:[^\\]|\\.|\\\Z)*? (?:'{3}|\Z)
                  | \"(?:[^\"\\\n]|\\.)*\"? | '(?:[^'\\\n]|\\.)*'? ) )
    | (?P<number> (?:\d[\d_]*\.?\d*|\.\d+) (?:[eE][+-]?\d+)? \w* )
    | (?P<name>   \w+ )
    | (?P<sign>   \*\*=? | //=? | ->|:=|[-+*/%@&|^=!<>]=|<<|>>|\.\.\. | . )
    """,
    re.VERBOSE | re.DOTALL,
)
FUNCTIONS = frozenset(name for module in (builtins, math) for name in dir(module) if callable(getattr(module, name)))
SMALL = frozenset("0123456789")
# Keywords that stand in no bracket: one that was never closed ends there, and does not change how the rest is read.
STATEMENTS = frozenset(
    {"assert", "break", "class", "continue", "def", "del", "except", "finally", "global",
     "import", "pass", "raise", "return", "try", "while", "with"}
)  # fmt: skip
STRING, NUMBER = "'", "#"
CHOSEN = "\0"  # begins a name that the learner chose; no source can bring it into another token


class Token(NamedTuple):
    """One token in its neutral form, and its line in the cell, from 1."""

    text: str
    line: int


class _Piece(NamedTuple):
    kind: str
    text: str
    line: int


_EDGE = _Piece("line", "\n", 0)


def tokens(source: str) -> list[Token]:
    """The tokens of a cell."""
    kept: list[Token] = []
    pieces = list(_pieces(source))
    depth = 0
    for number, (kind, text, line) in enumerate(pieces):
        before = pieces[number - 1] if number else _EDGE
        after = pieces[number + 1] if number + 1 < len(pieces) else _EDGE
        if kind == "sign":
            depth = max(depth + (text in "([{") - (text in ")]}"), 0)
        elif kind == "name" and text in STATEMENTS:
            depth = 0
        docstring = kind == "string" and depth == 0 and before.kind == after.kind == "line"
        if kind != "line" and not docstring:
            kept.append(Token(_neutral(kind, text, before.text, after.text, depth), line))
    return kept


def _pieces(source: str) -> Iterator[_Piece]:
    line = 1
    for found in _TOKEN.finditer(source.replace("\0", " ")):
        if found.lastgroup != "skip":
            yield _Piece(str(found.lastgroup), found.group(), line)
        line += found.group().count("\n")


def _neutral(kind: str, text: str, before: str, after: str, depth: int) -> str:
    if kind == "string":
        return STRING
    if kind == "number":
        whole = text.rstrip("0").removesuffix(".") if "." in text else text  # 2. and 2.0 are 2
        return whole if whole in SMALL else NUMBER
    if kind == "sign" or keyword.iskeyword(text) or before == ".":
        return text
    if (after == "(" and text in FUNCTIONS) or (after == "=" and depth):
        return text
    return CHOSEN + text
