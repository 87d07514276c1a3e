"""``autograder`` as a learner's notebook finds it where it is graded: ``personal``, and a ``check`` that does not judge."""

import importlib
from typing import Any

from autograder.sandbox.guest.words import say as _say

__all__ = ["check"]


def check(function: object = None, *_: Any, **__: Any) -> None:
    """Say that judging is done elsewhere. In your own JupyterLab the same line shows a verdict at once."""
    name = getattr(function, "__name__", _say("this_function"))
    print(_say("judging", name=name))


def __getattr__(name: str) -> Any:
    if name == "personal":
        return importlib.import_module("autograder.personal")
    if name.startswith("__"):
        raise AttributeError(f"module 'autograder' has no attribute {name!r}")
    raise ImportError(_say("only_check", name=f"autograder.{name}"))
