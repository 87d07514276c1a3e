"""The autograder: judge, sandbox, nbgrader bridge and command line.

In a notebook: ``from autograder import check``, then ``check(cylinder)``. From Python: ``judge_function("cylinder", f)``.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from autograder.checking import check, judge_function
    from autograder.result import Verdict

__all__ = ["Verdict", "check", "judge_function"]
_HOMES = {"check": "autograder.checking", "judge_function": "autograder.checking", "Verdict": "autograder.result"}


def __getattr__(name: str) -> Any:
    # Loaded when used: grading many notebooks must not pay for plotly, nor a notebook for the grading path.
    if name in _HOMES:
        import importlib

        value = getattr(importlib.import_module(_HOMES[name]), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module 'autograder' has no attribute {name!r}")


if os.environ.get("DIRECTRIX_MESSAGES"):
    from autograder.translation import install

    install()
