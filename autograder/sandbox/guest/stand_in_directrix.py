"""``directrix`` as a learner's notebook finds it while the grader runs it: ``directrix.plot`` only.

The reference library holds the answers, so it is withheld where marks are given. In your own JupyterLab it is all there.
"""

import importlib
import sys
from collections.abc import Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any

from autograder.sandbox.guest.words import say as _say

THERE = ("plot", "errors", "checks")  # plot, and the two modules that it uses


class _Withheld:
    """An import finder that gives the reason instead of a bare "No module named"."""

    @staticmethod
    def find_spec(name: str, path: Sequence[str] | None = None, target: ModuleType | None = None) -> ModuleSpec | None:
        package, _, rest = name.partition(".")
        if package == "directrix" and rest and rest.split(".")[0] not in THERE:
            raise ImportError(_say("only_plot", name=name), name=name)
        return None


sys.meta_path.insert(0, _Withheld)


def __getattr__(name: str) -> Any:
    if name in THERE:
        return importlib.import_module(f"directrix.{name}")
    if name.startswith("__"):
        raise AttributeError(f"module 'directrix' has no attribute {name!r}")
    raise ImportError(_say("only_plot", name=f"directrix.{name}"), name=f"directrix.{name}")
