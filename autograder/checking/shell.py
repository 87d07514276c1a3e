"""What check needs of IPython: to show a card, and to remember which cell failed to define a function.

Everything here works without IPython as well: cards are then printed as text, and there is nothing to remember. In a kernel
two events listen to cells, and one handler looks at NameErrors: ``check(cylinder)`` after a cell with a syntax slip would
otherwise end in a bare NameError that says nothing of the slip. Any other NameError is shown as ever.
"""

from __future__ import annotations

import ast
import contextlib
import linecache
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from types import TracebackType
from typing import Any

from autograder.errors import CheckFailed
from autograder.messages import say

REMEMBERED = 20


@dataclass(frozen=True)
class Failure:
    """A cell that stopped before it was done."""

    cell: str
    exception: str
    message: str
    line: int | None
    source: str
    is_syntax: bool


_failures: list[Failure] = []
_listener: Callable[[str], Mapping[str, Any]] | None = None


def running() -> Any | None:
    """The IPython shell this code runs in, or None. Never imports IPython."""
    ipython = sys.modules.get("IPython")
    return ipython.get_ipython() if ipython is not None else None


def show(bundle: Mapping[str, Any]) -> None:
    """Display a mime bundle; print its text where nothing can be displayed."""
    if running() is None:
        print(bundle["text/plain"])
        return
    from IPython.display import display

    display(dict(bundle), raw=True)  # type: ignore[no-untyped-call]


def shows_figures() -> bool:
    """Whether there is a notebook to show a figure in; a terminal would only say that there is one."""
    here = running()
    return here is not None and hasattr(here, "kernel")


def defined() -> Mapping[str, Any]:
    """What the notebook has defined so far."""
    here = running()
    return here.user_ns if here is not None else {}


@contextlib.contextmanager
def no_displays() -> Iterator[None]:
    """While it holds, what a learner's function displays is dropped: it is called many times."""
    here = running()
    if here is None:
        yield
        return
    from IPython.core.displaypub import CapturingDisplayPublisher

    before, here.display_pub = here.display_pub, CapturingDisplayPublisher()  # type: ignore[no-untyped-call]
    try:
        yield
    finally:
        here.display_pub = before


def failure_of(name: str) -> Failure | None:
    """The newest failure of a cell that should define the name, unless a later cell defined it."""
    return next((one for one in reversed(_failures) if name in _defines(one.cell)), None)


def listen(missing: Callable[[str], Mapping[str, Any]]) -> None:
    """Begin to remember, once for each kernel. ``missing(name)`` gives the card for ``check(name)`` without that name."""
    global _listener
    here = running()
    if here is None or _listener is not None:
        return
    _listener = missing
    here.events.register("post_run_cell", _after)
    if not here.custom_exceptions:  # somebody else's handler stays
        here.set_custom_exc((NameError,), _on_name_error)


def _after(result: Any) -> None:
    """A cell is done: remember how it failed, or forget the failures that it makes good."""
    cell = str(getattr(result.info, "raw_cell", "") or "")
    error = result.error_before_exec or result.error_in_exec
    names = _defines(cell)
    if not names:
        return
    if error is None:
        _failures[:] = [one for one in _failures if not names & _defines(one.cell)]
        return
    if isinstance(error, Exception):
        _failures.append(_failure(cell, error))
        del _failures[:-REMEMBERED]


def _failure(cell: str, error: Exception) -> Failure:
    is_syntax = isinstance(error, SyntaxError)
    if isinstance(error, SyntaxError):
        line, message = error.lineno, str(error.msg)
    else:
        line, message = _line_in_cell(error.__traceback__, cell), str(error)
    lines = cell.splitlines()
    source = lines[line - 1].strip() if line and line <= len(lines) else ""
    return Failure(cell, type(error).__name__, " ".join(message.split())[:300], line, source[:200], is_syntax)


def _line_in_cell(trace: TracebackType | None, cell: str) -> int | None:
    found = None
    while trace is not None:
        file = trace.tb_frame.f_code.co_filename
        if "".join(linecache.getlines(file)).strip() == cell.strip():
            found = trace.tb_lineno
        trace = trace.tb_next
    return found


def _defines(cell: str) -> set[str]:
    """Names that a cell defines as functions, or tries to: it need not be valid Python."""
    return set(re.findall(r"^[ \t]*(?:async[ \t]+)?def[ \t]+(\w+)", cell, re.MULTILINE))


def _on_name_error(here: Any, kind: type, error: BaseException, trace: TracebackType, tb_offset: int | None = None) -> None:
    """IPython calls this instead of showing a NameError."""
    bundle = name = None
    with contextlib.suppress(Exception):  # a fault of ours must not hide the learner's error
        name = _checked_name(error, trace)
        if name is not None and _listener is not None:
            bundle = _listener(name)
    if bundle is None:
        here.showtraceback((kind, error, trace), tb_offset=tb_offset, running_compiled_code=True)
        return
    show(bundle)
    failed = CheckFailed(say("stop.not_defined", name=name))
    here._showtraceback(CheckFailed, failed, failed._render_traceback_())


def _checked_name(error: BaseException, trace: TracebackType) -> str | None:
    """The name in a cell's ``check(name)``, if it is that name which is not defined."""
    while trace.tb_next is not None:
        trace = trace.tb_next
    code = trace.tb_frame.f_code
    name = getattr(error, "name", None)
    if code.co_name != "<module>" or not isinstance(name, str):
        return None
    tree = ast.parse("".join(linecache.getlines(code.co_filename)))
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and node.args and node.lineno <= trace.tb_lineno <= (node.end_lineno or node.lineno):
            called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            first = node.args[0]
            first = first.func if isinstance(first, ast.Call) else first  # check(cylinder(...))
            if called == "check" and isinstance(first, ast.Name) and first.id == name:
                return name
    return None
