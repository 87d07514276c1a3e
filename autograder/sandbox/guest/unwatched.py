"""Traits of IPython's that change with every cell, set at once where nobody has asked to be told of it.

Setting a trait makes a message for its observers and then looks for observers. IPython sets nine traits for a cell, and that
takes as long as half of what it does for a cell of a line. Who observes one of these, or validates it, is told as ever.
"""

from __future__ import annotations

from typing import Any

from IPython.core.displayhook import DisplayHook
from IPython.core.history import HistoryManager
from IPython.core.interactiveshell import ExecutionResult, InteractiveShell
from traitlets import All, Bool, HasTraits, Instance, Integer, TraitType, Unicode


class Unwatched(TraitType[Any, Any]):
    """A trait whose values of a plain type need no look at who watches, if nobody does."""

    plain: tuple[type, ...] = ()

    def set(self, obj: HasTraits, value: Any) -> None:
        """Set it."""
        watched = obj._trait_notifiers
        if (
            type(value) in self.plain
            and self.name not in watched
            and not any(watched.get(All, {}).values())
            and self.name not in obj._trait_validators
            and "notify_change" not in vars(obj)  # they are held back to be told together
        ):
            obj._trait_values[self.name] = value  # type: ignore[index]
        else:
            super().set(obj, value)


class Count(Unwatched, Integer):  # type: ignore[type-arg]
    """A number."""

    plain = (int,)


class Flag(Unwatched, Bool):  # type: ignore[type-arg]
    """Yes or no."""

    plain = (bool,)


class Line(Unwatched, Unicode):  # type: ignore[type-arg]
    """A text."""

    plain = (str,)


class Outcome(Unwatched, Instance):  # type: ignore[type-arg]
    """What came of a cell, or nothing."""

    plain = (ExecutionResult, type(None))


class UnwatchedShell(InteractiveShell):
    """The shell's."""

    execution_count = Count(1)
    last_execution_succeeded = Flag(True, help=InteractiveShell.last_execution_succeeded.help)
    last_execution_result = Outcome(ExecutionResult, help=InteractiveShell.last_execution_result.help, allow_none=True)


class UnwatchedHook(DisplayHook):
    """The display hook's."""

    exec_result = Outcome(ExecutionResult, allow_none=True)


class UnwatchedHistory(HistoryManager):
    """The history's."""

    _i00 = Line("")
    _i = Line("")
    _ii = Line("")
    _iii = Line("")
