"""What a grading run does before its first submission: a sandbox early, limits that fit the machine, what is searched with."""

from __future__ import annotations

import dataclasses
import importlib
import logging

from autograder.course import Course
from autograder.fleet import capacity
from autograder.fleet.one import Plan
from autograder.notebook.session import Begun, Opener
from autograder.sandbox import ahead

log = logging.getLogger(__name__)


def begun(course: Course, assignment: str, level: str | None) -> Begun:
    """The sandbox starts while the gradebook is loaded and read, on the word of the instructor's files."""
    return Begun(course.likely_policy(assignment), level)


def remember(course: Course, assignment: str, session: Opener) -> None:
    """Leave a note of the sandbox that this assignment needs, for the next run."""
    ahead.remember(ahead.note(course.room, assignment), session.box.policy, session.level)


def fitted(plan: Plan, workers: int) -> tuple[Plan, int]:
    """The same with limits and workers that fit this machine's memory together."""
    session = plan.open_session
    processes = 2 if any(script.apart for script in plan.scripts.values()) else 1
    fit = capacity.fit(workers, session.bounds.memory, capacity.available(), processes=processes)
    if fit.note:
        log.warning("%s", fit.note)
    bounds = dataclasses.replace(session.bounds, memory=fit.memory)
    return dataclasses.replace(plan, open_session=dataclasses.replace(session, bounds=bounds)), fit.workers


def load_searching() -> None:
    """Load what the judge searches with while the sandbox starts: forked workers then share it, instead of each loading it."""
    importlib.import_module("scipy.spatial")
