"""How a cell's source is read: IPython's own syntax turned into Python, and Python parsed and compiled once.

By itself IPython takes every cell apart into tokens, compiles it twice to learn whether it awaits something, parses it once
more to run it, compiles its statements one by one, and takes it apart again to look for a semicolon at its end. Here each is
done once, where it can matter: the statements of what is plain Python are compiled before the first of them is run, and so it
is known whether one awaits something. A cell that everybody was given is read in the zygote, for all.

Whatever a notebook may change that could make another tree or other code of a cell sends its cells the ordinary way.
"""

from __future__ import annotations

import ast
import builtins
import inspect
import re
import sys
import types
import warnings
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from IPython.core.compilerop import CachingCompiler, PyCF_MASK, code_name
from IPython.core.inputtransformer2 import TransformerManager

# Without one of these no line is IPython's own syntax: a command (%magic, !system, ?help, quoting by , ; or /) at the beginning
# of a line, an assignment from one, or a question mark at the end. Not every match is such a line; every such line matches.
SPECIAL = re.compile(r"[ \t\f]*[!?%,;/]|.*=\s*[!%]|.*\?[\s;]*(?:\#.*)?$", re.DOTALL)
# What Python warns of while it parses: a backslash (in a text that is not raw), and a number with a word close behind it.
WARNED = re.compile(r"\\|\d\.?\w*(?:and|else|for|if|in|is|not|or)\b")
AWAITING = ast.PyCF_ALLOW_TOP_LEVEL_AWAIT
OTHERWISE = PyCF_MASK | inspect.CO_COROUTINE  # of code that is not run as all the others are, or changes how they are read
FAILURES = (SyntaxError, ValueError, MemoryError, RecursionError)


class Step(NamedTuple):
    """A statement, how it is compiled, and its code."""

    statement: ast.stmt
    symbol: str
    code: types.CodeType


class Parsed(NamedTuple):
    """A cell in Python: its source, its tree and, where they are compiled already, its statements as parts of a file."""

    source: str
    tree: ast.Module
    steps: tuple[Step, ...] | None = None
    file: str = ""


class Compiler(CachingCompiler):
    """Compiles cells; takes tree and code of the newest one where it has been read already."""

    def __init__(self) -> None:
        super().__init__()  # type: ignore[no-untyped-call]
        self.stock = self.flags
        self.usual = _circumstances()
        self.given: dict[str, Parsed] = {}  # by what IPython is told to run; taken once, so no two cells share a constant
        self.transformers: Callable[[], Sequence[Any]] = tuple  # what else may change a tree
        self.forget()

    def forget(self) -> None:
        """Nothing has been read."""
        self.parsed: Parsed | None = None
        self.ready: list[Step] = []  # those that are to be compiled, the next one last
        self.file = ""  # the one that they are parts of

    def read(self, lines: list[str]) -> bool:
        """Whether lines are Python as they are, and can be parsed without a warning; what was read then waits here."""
        self.forget()
        source = "".join(lines)
        if not any(map(SPECIAL.match, lines)) and (tree := parsed(source)) is not None:
            self.parsed = Parsed(source, tree)
        return self.parsed is not None

    def keep(self, cell: str, number: int) -> None:
        """Keep what has just been read, compiled, for a notebook that holds the same cell, most likely with this number."""
        if self.parsed is not None:
            source, tree, *_ = self.parsed
            file = code_name(source, number)
            self.given[cell] = Parsed(source, tree, compiled(tree, file, self.stock | AWAITING), file)
        self.forget()

    def take(self, cell: str) -> str | None:
        """The Python of a cell that is as it was given; what was read of it waits here."""
        self.forget()
        if cell in self.given and _circumstances() == self.usual:
            self.parsed = self.given.pop(cell)
        return self.parsed.source if self.parsed is not None else None

    def compile_ahead(self, source: str, number: int) -> bool:
        """Compile what has just been read, if that brings no warning; whether it did, and nothing in it awaits something."""
        read = self.parsed
        if read is None or read.source != source or self.flags != self.stock or _circumstances() != self.usual:
            return False
        self.file, steps = code_name(source, number), read.steps
        if steps is None:
            steps = compiled(read.tree, self.file, self.stock | AWAITING)
        elif self.file != read.file:
            steps = tuple(step._replace(code=renamed(step.code, self.file)) for step in steps)
        self.ready = [*reversed(steps or ())]
        return steps is not None

    def ast_parse(self, source: str, filename: str = "<unknown>", symbol: str = "exec") -> ast.AST:
        """The tree of a source."""
        read, self.parsed = self.parsed, None
        if self.transformers():
            self.ready.clear()
        if read is not None and read.source == source and symbol == "exec" and self.flags == self.stock:
            return read.tree
        return super().ast_parse(source, filename, symbol)

    def __call__(self, source: Any, filename: str, symbol: str, **options: Any) -> types.CodeType:
        """The code of a tree."""
        if self.ready:
            statement, how, code = self.ready[-1]
            same = isinstance(source, ast.Module | ast.Interactive) and source.body == [statement]
            usual = self.flags == self.stock | AWAITING and _circumstances() == self.usual
            if same and usual and filename == self.file and symbol == how:
                self.ready.pop()
                return code
        return super().__call__(source, filename, symbol, **options)


class Plainly(TransformerManager):
    """Turns IPython's own syntax into Python; valid Python without any is not taken apart into tokens to find that out."""

    def __init__(self, compiler: Compiler | None = None) -> None:
        super().__init__()  # type: ignore[no-untyped-call]
        self.stock = self._steps()
        self.compiler = compiler or Compiler()

    def transform_cell(self, cell: str) -> str:
        """The cell in Python."""
        given = self.compiler.take(cell) if self._steps() == self.stock else None
        return super().transform_cell(cell) if given is None else given

    def do_token_transforms(self, lines: list[str]) -> list[str]:
        """The lines in Python. The tree that shows that they are already stays with the compiler."""
        if self.token_transformers == self.stock[2] and self.compiler.read(lines):
            return lines
        return super().do_token_transforms(lines)  # type: ignore[no-any-return, no-untyped-call]

    def _steps(self) -> tuple[list[Any], ...]:
        return [*self.cleanup_transforms], [*self.line_transforms], [*self.token_transformers]


def parsed(source: str) -> ast.Module | None:
    """The tree of a source, if this is Python, found out without a warning; what might bring one is not tried."""
    if WARNED.search(source):
        return None
    try:
        tree: ast.Module = compile(source, "<cell>", "exec", ast.PyCF_ONLY_AST | AWAITING, dont_inherit=True)
        return tree
    except FAILURES:
        return None


def compiled(tree: ast.Module, file: str, flags: int) -> tuple[Step, ...] | None:
    """The statements as IPython compiles them, one by one: the value of an expression is shown if it comes last.

    None if one awaits something, has a say in how others are read, or brings a warning.
    """
    filters, steps = warnings.filters, []
    try:  # not by catch_warnings: after it all that was warned of once is warned of again
        warnings.filters = [("error", None, SyntaxWarning, None, 0), *filters]
        for statement in tree.body:
            shown = statement is tree.body[-1] and isinstance(statement, ast.Expr)
            piece, symbol = (ast.Interactive([statement]), "single") if shown else (ast.Module([statement], []), "exec")
            steps.append(Step(statement, symbol, compile(piece, file, symbol, flags, dont_inherit=True)))
    except FAILURES:
        return None
    finally:
        warnings.filters = filters
    return None if any(step.code.co_flags & OTHERWISE for step in steps) else tuple(steps)


def renamed(code: types.CodeType, file: str) -> types.CodeType:
    """The same code as a part of another file."""
    inside = tuple(renamed(value, file) if isinstance(value, types.CodeType) else value for value in code.co_consts)
    return code.replace(co_filename=file, co_consts=inside)


def _circumstances() -> tuple[Any, ...]:
    """What a notebook may change that decides how Python is read, or what of it is too deep or too long."""
    return builtins.compile, sys.getrecursionlimit(), sys.get_int_max_str_digits()
