"""The exceptions of the autograder.

DirectrixError
├── ExerciseError       an exercise, its data or its mistakes are written wrongly   (the instructor's to mend)
├── CourseError         a course folder, notebook or configuration does not hold together
├── SubmissionError     a submission cannot be read                                 (named in the report, never fatal)
├── SandboxError        the sandbox itself failed or is not available               (never the learner's failure)
│   └── IsolationError  this machine does not give the isolation that was asked for
├── CallFailed          the learner's function did not give an answer
└── CheckFailed         what `check` raises when nothing was right
"""

from __future__ import annotations

from typing import Literal

FailureKind = Literal["error", "timeout", "memory", "died", "refused", "missing"]


class DirectrixError(Exception):
    """Any error the autograder raises on purpose: one sentence that says what must hold, what came, what to try."""


class ExerciseError(DirectrixError):
    """An exercise is written wrongly."""


class CourseError(DirectrixError):
    """A course folder, notebook or configuration does not hold together."""


class SubmissionError(DirectrixError):
    """A submission cannot be read; it is reported by name and the others go on."""


class SandboxError(DirectrixError):
    """The sandbox failed. A mark must never depend on it: what it could not run *could not be judged*."""


class IsolationError(SandboxError):
    """The machine does not give the isolation level that was asked for."""


class CheckFailed(DirectrixError):
    """Nothing in the checked answer was right. Raised by ``check`` so that a plain notebook run stops there too."""

    def _render_traceback_(self) -> list[str]:
        """IPython asks for the traceback here: one line, since the card above says the rest."""
        return [f"CheckFailed: {self}"]


class CallFailed(DirectrixError):
    """The learner's function gave no answer.

    Attributes
    ----------
    kind : str
        ``error`` (it raised), ``timeout``, ``memory``, ``died`` (its process ended), ``refused`` (its answer cannot be
        taken, for example an object array), ``missing`` (no function of that name).
    exception : str
        Name of the exception class that was raised, empty unless ``kind`` is ``error``.
    bases : tuple of str
        Names of that class and of its base classes.
    line : int or None
        Line of the learner's source where it was raised, counted from 1 in the cell that defines the function.
    source : str
        That line's text, when it is known.
    """

    def __init__(
        self,
        kind: FailureKind,
        message: str,
        *,
        exception: str = "",
        bases: tuple[str, ...] = (),
        line: int | None = None,
        source: str = "",
    ) -> None:
        super().__init__(message)
        self.kind: FailureKind = kind
        self.exception = exception
        self.bases = bases
        self.line = line
        self.source = source

    @property
    def message(self) -> str:
        """What went wrong, in one sentence."""
        return str(self.args[0])
