"""The sandbox that an assignment needs: what learners may import there, how long a cell may take, one session a notebook."""

from __future__ import annotations

import contextlib
import dataclasses
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, Literal

from autograder.exercise import Exercise
from autograder.sandbox import Limits, Policy, Sandbox

Packages = tuple[str, ...] | Literal["all"]
OpenSession = Callable[[Mapping[str, bytes]], contextlib.AbstractContextManager[Any]]
BASIC = ("numpy", "plotly")


def needs(exercises: Iterable[Exercise], packages: Packages) -> Policy:
    """What the sandbox offers: numpy, plotly and what exercises and course allow; all that is installed without exercises."""
    posed = list(exercises)
    if packages == "all" or not (posed or packages):
        return Policy(packages="all")
    allowed = [package for exercise in posed for package in exercise.allow]
    return Policy(packages=tuple(dict.fromkeys([*BASIC, *packages, *allowed])))


def limits(timeout: float | None) -> Limits:
    """The sandbox's limits with nbgrader's ``Execute.timeout`` as the CPU time of a cell; None: our own."""
    return Limits() if timeout is None else dataclasses.replace(Limits(), cell_cpu=timeout)


@contextlib.contextmanager
def opened(policy: Policy, level: str, timeout: float | None) -> Iterator[OpenSession]:
    """Start a sandbox; yields what opens a session in it, from any thread, given the files that the notebook finds.

    Raises
    ------
    IsolationError
        If this machine does not give the level.
    """
    bounds = limits(timeout)
    with Sandbox(policy=policy, level=level) as box:
        yield lambda files: box.open(files=files, limits=bounds, environment={"NBGRADER_EXECUTION": "autograde"})
