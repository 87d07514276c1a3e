"""Tracebacks without working out the same things for each: done once in the zygote, every notebook's process has it.

IPython asks of each frame which module it is in; of a cell's, Python looks through all modules, twice, to say that it is in
none. It colours a traceback with pygments: for each traceback a style is derived and turned into escape sequences, and for each
frame of it a reader of Python is derived that changes nothing in the grammar and works all of it out again. Together that takes
longer than the colouring itself. Of a library's function that a traceback passes through, all lines are coloured each time,
its long docstring too. What comes out is the same, character for character.
"""

from __future__ import annotations

import contextlib
import functools
import importlib
import inspect
import types
from typing import Any

# What learners' arrays run into most often; a traceback through a file of numpy's parses all of that file.
NUMPY = (
    "__import__('numpy').allclose([1, 2], [1, 2, 3])",
    "__import__('numpy').stack([[1], [1, 2]])",
    "__import__('numpy').broadcast_arrays([1, 2], [1, 2, 3])",
    "__import__('numpy').linalg.norm([None])",
    "__import__('numpy').linalg.norm([[None]], axis=-1)",
    "__import__('numpy').reshape([1, 2], (3, 4))",
    "__import__('numpy').cross([1], [2])",
)

MOST_COLOURED = 500  # functions whose coloured lines are remembered


def prepare() -> None:
    """Make the libraries keep what they work out; another version of one, which lacks a place where to, is left as it is."""
    for keep in (_grammars, _styles, _escapes, _modules, _colours):
        with contextlib.suppress(ImportError, AttributeError):
            keep()


def _grammars() -> None:
    """A lexer that changes nothing in its parent's grammar takes it as the parent has worked it out."""
    meta: Any = importlib.import_module("pygments.lexer").RegexLexerMeta
    work_out = meta.process_tokendef

    def process_tokendef(cls: Any, name: str, tokendefs: Any = None) -> Any:
        (parent, *others), own = cls.__bases__, vars(cls)
        if name or others or "tokens" in own or "flags" in own or "_tokens" not in vars(parent):
            return work_out(cls, name, tokendefs)
        cls._all_tokens = parent._all_tokens
        return parent._tokens

    meta.process_tokendef = process_tokendef


def _styles() -> None:
    """The style that marks the running part of a line is derived once from each style."""
    stack_data: Any = importlib.import_module("stack_data")
    stack_data.style_with_executing_node = functools.cache(stack_data.style_with_executing_node)


def _escapes() -> None:
    """The escape sequences of a style are found once."""
    formatter: Any = importlib.import_module("pygments.formatters.terminal256").Terminal256Formatter
    find, found = formatter._setup_styles, {}

    def _setup_styles(self: Any) -> None:
        key = (type(self), self.style, self.usebold, self.useunderline, self.useitalic)
        if key not in found:
            find(self)
            found[key] = dict(self.style_string)
        self.style_string = dict(found[key])

    formatter._setup_styles = _setup_styles


def _colours() -> None:
    """A function's lines are coloured once for each place in it where a traceback passes."""
    core: Any = importlib.import_module("stack_data.core")
    formatters: Any = importlib.import_module("pygments.formatters.terminal256")
    colour: Any = core._pygmented_with_ranges
    found: dict[Any, list[str]] = {}

    @functools.wraps(colour)
    def _pygmented_with_ranges(formatter: Any, code: str, ranges: list[tuple[int, int]]) -> list[str]:
        if type(formatter) is not formatters.Terminal256Formatter or set(formatter.options) - {"style"}:
            return colour(formatter, code, ranges)  # type: ignore[no-any-return]
        key = (formatter.style, code, tuple(ranges))
        if key not in found:
            if len(found) >= MOST_COLOURED:
                return colour(formatter, code, ranges)  # type: ignore[no-any-return]
            found[key] = colour(formatter, code, ranges)
        return list(found[key])

    core._pygmented_with_ranges = _pygmented_with_ranges


def _modules() -> None:
    """A frame of a cell is in no module's file."""
    look = inspect.getmodule

    @functools.wraps(look)
    def getmodule(object: Any, _filename: str | None = None) -> types.ModuleType | None:
        if type(object) is types.FrameType and object.f_code.co_filename.startswith("<ipython-input-"):
            return None
        return look(object, _filename)

    inspect.getmodule = getmodule
