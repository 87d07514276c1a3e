"""What a learner reads when a limit is reached: what was allowed, what happened, what to look at."""

from __future__ import annotations

import signal

CELL, CALL, FILES, START, TEST = "this cell", "this call of your function", "saving the files", "starting", "this test"
REST = "What comes after it could not be run"
SIGNALS: dict[int, str] = {
    signal.SIGSEGV: "a crash in compiled code (segmentation fault)",
    signal.SIGABRT: "a crash in compiled code (abort)",
    signal.SIGBUS: "a crash in compiled code (bus error), perhaps of a full scratch folder",
    signal.SIGFPE: "a crash in compiled code (arithmetic)",
    signal.SIGILL: "a crash in compiled code (illegal instruction)",
    signal.SIGSYS: "a system call that is not allowed",
    signal.SIGKILL: "it was killed",
}


def cpu_time(what: str, seconds: float) -> str:
    """The CPU time of a cell or call is used up."""
    return f"{what} was stopped: it may compute for {seconds:g} s and had not finished. Is there a loop that never ends?"


def wall_time(what: str, seconds: float) -> str:
    """Time by the clock is used up."""
    return f"{what} was stopped after {seconds:g} s by the clock. Is it waiting for something?"


def notebook_time(seconds: float) -> str:
    """The notebook's CPU time is used up."""
    return f"the notebook has used the {seconds:g} s of computing that all its cells may take together; the rest was not run"


def memory(what: str, allowed: int) -> str:
    """A MemoryError."""
    return f"{what} asked for more memory than the {allowed / 2**20:g} MiB it may have. Is an array far larger than meant?"


def died(what: str, number: int, code: int) -> str:
    """The process is gone: by a signal, or of its own will with an exit code."""
    if number:
        return f"{what} ended the notebook's process: {SIGNALS.get(number, f'signal {number}')}. {REST}"
    return f"{what} ended the notebook's own process (os._exit or the like, code {code}). {REST}"


def closed(what: str) -> str:
    """The process lives, but has closed its connection to the grader."""
    return f"{what} closed a connection that it did not open (os.close or the like), and the notebook was stopped. {REST}"


def protocol(error: Exception) -> str:
    """The child sent what our child never sends."""
    return (
        f"the notebook's process sent something that is no answer ({error}); it was stopped. Does the code write to open files?"
    )
