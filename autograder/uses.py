"""What a function uses, of its notebook and of other modules: read from its text, which is never run, or from itself.

A learner's text is hostile where marks are given, so it is taken apart by ``tokenize``, which is plain Python, and neither
parsed nor compiled. What comes out is a plain fact ("its text has this name in it"), enough to ask a further question with.
"""

from __future__ import annotations

import dis
import functools
import io
import itertools
import keyword
import tokenize
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from types import CodeType, FunctionType, ModuleType
from typing import Any

LONGEST, MOST = 40_000, 400_000  # characters of a cell that are read, of all cells
SKIPPED = {tokenize.COMMENT, tokenize.NL, tokenize.STRING}


def in_text(sources: Iterable[str], name: str, wanted: Collection[str]) -> tuple[str, ...]:
    """Those of the wanted names that the function ``name`` uses, directly or through helpers, in cells run in this order.

    >>> in_text(["def half(t):\\n    return basis(t) / 2", "def patch(u):\\n    return half(u)"], "patch", {"basis"})
    ('basis',)
    """
    used: dict[str, set[str]] = {}
    for source in _first(sources):
        used |= _definitions(source)  # a later definition takes the place of an earlier one
    return _reached(name, lambda known: used.get(known, set()), set(wanted) - {name})


def _first(sources: Iterable[str]) -> Iterator[str]:
    """As much of each as is read, while there is room for all of that."""
    left = MOST
    for source in sources:
        left -= min(len(source), LONGEST)
        if left < 0:
            return
        yield source[:LONGEST]


def in_function(function: Callable[..., Any], wanted: Collection[str]) -> tuple[str, ...]:
    """The same of a function that is at hand: the wanted names among the globals that it and its helpers look up."""
    return _reached("", lambda name: _names(function, name), set(wanted) - {getattr(function, "__name__", "")})


def modules(function: Callable[..., Any]) -> tuple[str, ...]:
    """Modules that a function and its helpers import or look up, or whose functions they do, as far as it can be seen."""
    known, found, todo, seen = _globals_of(function), set(), [""], {""}
    while todo:
        name = todo.pop()
        value = _plain(function if name == "" else known[name])
        if isinstance(value, ModuleType):
            found.add(value.__name__)
        elif isinstance(value, FunctionType) and value.__globals__ is known:
            found |= set(_imported_in(value.__code__))
            todo += _names(function, name) - seen
            seen |= set(todo)
        elif callable(value) and isinstance(home := getattr(value, "__module__", None), str):
            found.add(home)
    return tuple(sorted(found))


def _plain(function: Any) -> Any:
    return getattr(function, "pyfunc", function)  # numpy.vectorize


def _globals_of(function: Any) -> Mapping[str, Any]:
    known: Mapping[str, Any] = getattr(_plain(function), "__globals__", {})
    return known


def _names(function: Any, name: str) -> set[str]:
    """What the function, or the helper of that name, looks up among the globals of the function."""
    known = _globals_of(function)
    value = _plain(function if name == "" else known.get(name))
    return set(_globals_in(value.__code__)) & set(known) if isinstance(value, FunctionType) else set()


def _imported_in(code: CodeType) -> Iterator[str]:
    """Names of the modules that a code imports while it runs: ``from a import b`` may mean the module a.b."""
    steps = [step for step in dis.get_instructions(code) if step.opname in ("IMPORT_NAME", "IMPORT_FROM")]
    module = ""
    for step, after in itertools.zip_longest(steps, steps[1:]):
        if step.opname == "IMPORT_FROM":
            yield f"{module}.{step.argval}"
        else:
            module = step.argval
            if after is None or after.opname == "IMPORT_NAME":
                yield module
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _imported_in(constant)


def _reached(name: str, used: Callable[[str], set[str]], wanted: set[str]) -> tuple[str, ...]:
    """Wanted names that are met on the way from a name; beyond a wanted one nothing is looked at."""
    found, seen, todo = set(), {name}, [name]
    while todo:
        here = used(todo.pop())
        found |= here & wanted
        new = here - wanted - seen
        seen |= new
        todo += sorted(new)
    return tuple(sorted(found))


def _globals_in(code: CodeType) -> Iterator[str]:
    for step in dis.get_instructions(code):
        if step.opname in ("LOAD_GLOBAL", "LOAD_NAME"):
            yield step.argval
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _globals_in(constant)


@functools.lru_cache(maxsize=128)  # the cells of one notebook, which is asked about after each exercise that is not right
def _definitions(source: str) -> dict[str, set[str]]:
    """The names in the text of each function that is defined, and in each assignment, at the left margin of a cell."""
    found: dict[str, set[str]] = {}
    for block in _blocks(source):
        words = [*(token.string for token in block), ""]
        name = words[words.index("def") + 1] if "def" in words[:2] else words[0] if words[1:2] == ["="] else ""
        if not name.isidentifier():
            continue
        used, bound = set(), {name}
        depth, header = 0, "def" in words[:2]
        for before, word, after in zip(["", *words], words, [*words[1:], ""], strict=False):
            depth += (word in "([{") - (word in ")]}") if word else 0
            if word == ":" and depth == 0:
                header = False
            if not word.isidentifier() or keyword.iskeyword(word) or before == ".":
                continue
            if (header and before in "(,*") or (after == "=" and depth == 0) or before in ("for", "def"):
                bound.add(word)
            elif after != "=":
                used.add(word)
        found[name] = used - bound
    return found


def _blocks(source: str) -> Iterator[list[tokenize.TokenInfo]]:
    """The statements at the left margin of a cell, each with what is indented below it; as far as the text can be read."""
    block: list[tokenize.TokenInfo] = []
    level, fresh = 0, True
    try:
        for token in tokenize.generate_tokens(io.StringIO(source).readline):
            if token.type in (tokenize.INDENT, tokenize.DEDENT):
                level += 1 if token.type == tokenize.INDENT else -1
            elif token.type == tokenize.NEWLINE:
                fresh = True
            elif token.type not in SKIPPED:
                if fresh and level == 0 and block:
                    yield block
                    block = []
                fresh = False
                block.append(token)
    except (tokenize.TokenError, SyntaxError):
        pass
    if block:
        yield block
