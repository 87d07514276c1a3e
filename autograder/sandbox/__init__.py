"""Runs learners' code where it can do no harm: no network, no processes, no file but its own, bounded time and memory.

    with Sandbox(policy=Policy(), level="A") as box, box.open() as session:
        session.run_cell("def f(u): return 2 * u")
        session.call("f", [np.arange(3.0)])

This package is the only one that starts processes. It knows no geometry, and everything it hands back is plain data that was
checked on the trusted side. How it is built is told in ``box.py`` (trusted side) and ``guest/`` (inside).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from autograder.sandbox.box import Sandbox
    from autograder.sandbox.policy import CellResult, Ended, Limits, Policy, Usage
    from autograder.sandbox.session import Session
    from autograder.sandbox.wire import Value

__all__ = ["CellResult", "Ended", "Limits", "Policy", "Sandbox", "Session", "Usage", "Value"]
_HOMES = {"Sandbox": "box", "Session": "session", "Value": "wire"}


def __getattr__(name: str) -> Any:
    # Loaded when used: the root helper and the child import parts of this package where numpy or the client is not there.
    if name in __all__:
        import importlib

        home = importlib.import_module(f"autograder.sandbox.{_HOMES.get(name, 'policy')}")
        value = getattr(home, name)
        globals()[name] = value
        return value
    raise AttributeError(f"module 'autograder.sandbox' has no attribute {name!r}")
