"""A submission on its way: what a worker is given, and what it says."""

from __future__ import annotations

import logging
from dataclasses import dataclass
from pathlib import Path

from autograder.errors import SandboxError, SubmissionError
from autograder.fleet.one import Outcome, Plan, grade_one
from autograder.notebook.submission import Submission

log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class Task:
    """A submission to be graded: nothing of it but its student's name is known.

    ``alone``: it is graded for the second time, when all else is done, and may take its time. ``again``: the sandbox was lost
    while it was graded.
    """

    student: str
    alone: bool = False
    again: bool = False


@dataclass(frozen=True)
class Landed:
    """What a worker says of a submission: graded, perhaps laid out beside its place, or why not.

    ``broken`` is the submission's fault, ``fault`` the grader's; ``unwritten``: graded, but its files could not be laid out.
    """

    student: str
    outcome: Outcome | None = None
    staged: Path | None = None
    broken: str = ""
    fault: str = ""
    unwritten: str = ""
    hurried: bool = False  # stopped by the clock with CPU time left: to be tried again alone

    @property
    def failed(self) -> bool:
        """Whether the grader could not do its part."""
        return bool(self.fault or (self.outcome is not None and self.outcome.report.faults))


def judged(plan: Plan, task: Task, submitted: Submission) -> Landed:
    """Grade one submission, wherever this process is; nothing is raised and nothing is written."""
    try:
        outcome = grade_one(plan, task.student, submitted)
    except SubmissionError as error:  # no date: nbgrader drops such a submission too
        return Landed(task.student, broken=str(error))
    except Exception as error:  # the grader's own fault: named, never a zero, and tried again in the next run
        log.exception("grading %s failed", task.student)
        fault = str(error) if isinstance(error, SandboxError) else f"{type(error).__name__}: {error}"
        return Landed(task.student, fault=fault)
    if outcome.hurried and not task.alone:
        return Landed(task.student, hurried=True)
    return Landed(task.student, outcome)
