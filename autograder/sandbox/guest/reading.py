"""How a cell's source is read: IPython's own syntax turned into Python, and Python parsed once.

By itself IPython takes every cell apart into tokens, compiles it twice to learn whether it awaits something, parses it once
more to run it, and takes it apart again to look for a semicolon at its end. Here each is done once, where it can matter.
"""

from __future__ import annotations

import ast
import re

from IPython.core.compilerop import CachingCompiler
from IPython.core.inputtransformer2 import TransformerManager

# Without one of these no line is IPython's own syntax: a command (%magic, !system, ?help, quoting by , ; or /) at the beginning
# of a line, an assignment from one, or a question mark at the end. Not every match is such a line; every such line matches.
SPECIAL = re.compile(r"[ \t\f]*[!?%,;/]|.*=\s*[!%]|.*\?[\s;]*(?:\#.*)?$", re.DOTALL)
# What Python warns of while it parses: a backslash (in a text that is not raw), and a number with a word close behind it.
WARNED = re.compile(r"\\|\d\.?\w*(?:and|else|for|if|in|is|not|or)\b")


class Compiler(CachingCompiler):
    """Compiles cells; takes the tree of the newest one where it has been parsed already."""

    def __init__(self) -> None:
        super().__init__()  # type: ignore[no-untyped-call]
        self.stock = self.flags
        self.parsed: tuple[str, ast.AST] | None = None

    def ast_parse(self, source: str, filename: str = "<unknown>", symbol: str = "exec") -> ast.AST:
        """The tree of a source."""
        parsed, self.parsed = self.parsed, None
        if parsed is not None and parsed[0] == source and symbol == "exec" and self.flags == self.stock:
            return parsed[1]
        return super().ast_parse(source, filename, symbol)


class Plainly(TransformerManager):
    """Turns IPython's own syntax into Python; valid Python without any is not taken apart into tokens to find that out."""

    def __init__(self, compiler: Compiler | None = None) -> None:
        super().__init__()  # type: ignore[no-untyped-call]
        self.stock = list(self.token_transformers)
        self.compiler = compiler

    def do_token_transforms(self, lines: list[str]) -> list[str]:
        """The lines in Python. The tree that shows that they are already goes to the compiler."""
        if self.token_transformers == self.stock and not any(map(SPECIAL.match, lines)):
            source = "".join(lines)
            tree = parsed(source)
            if tree is not None:
                if self.compiler is not None:
                    self.compiler.parsed = source, tree
                return lines
        return super().do_token_transforms(lines)  # type: ignore[no-any-return, no-untyped-call]


def parsed(source: str) -> ast.AST | None:
    """The tree of a source, if this is Python, found out without a warning; what might bring one is not tried."""
    if WARNED.search(source):
        return None
    try:
        flags = ast.PyCF_ONLY_AST | ast.PyCF_ALLOW_TOP_LEVEL_AWAIT
        tree: ast.AST = compile(source, "<cell>", "exec", flags, dont_inherit=True)
        return tree
    except (SyntaxError, ValueError, MemoryError, RecursionError):
        return None
