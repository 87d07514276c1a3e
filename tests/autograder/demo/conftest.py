"""A member's notebook run as a kernel would run it, without kernel or sandbox: for the honest ones only."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from autograder.catalogue import Assignment, shipped
from autograder.demo import Member
from autograder.errors import CallFailed
from autograder.notebook import source

NAMES = [assignment.name for assignment in shipped().assignments]


@pytest.fixture(scope="session")
def released() -> dict[str, Any]:
    """The learner's notebook of each assignment."""
    return {assignment.name: source.release(source.build(assignment)) for assignment in shipped().assignments}


@pytest.fixture(scope="session")
def run(released) -> Callable[[Assignment, Member], dict[str, Callable[..., Any]]]:
    """The functions that a member's task cells leave behind, each as a caller that the judge can use."""

    def functions(assignment: Assignment, member: Member) -> dict[str, Callable[..., Any]]:
        space: dict[str, Any] = {"np": np}
        for cell in member.notebook(released[assignment.name]).cells:
            grade_id = cell.metadata.get("nbgrader", {}).get("grade_id")
            if cell.cell_type == "code" and grade_id in assignment.exercises:
                try:
                    exec(compile(cell.source, grade_id, "exec"), space)
                except SyntaxError:
                    continue
        return {id: _caller(space, id) for id in assignment.exercises}

    return functions


def _caller(space: dict[str, Any], id: str) -> Callable[..., Any]:
    def call(*args: Any) -> Any:
        if id not in space:
            raise CallFailed("missing", f"there is no function {id}")
        with np.errstate(all="ignore"):
            return space[id](*args)

    return call
