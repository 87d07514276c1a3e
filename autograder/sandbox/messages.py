"""What a learner reads when a limit is reached: what was allowed, what happened, what to look at.

The sandbox speaks English and knows no catalogue; what it says carries its key, so that who shows it to a learner can say it in
another language (``autograder.notebook.told``).
"""

from __future__ import annotations

import signal
from collections.abc import Mapping

WORDS: dict[str, str] = {
    "cell": "this cell",
    "call": "this call of your function",
    "files": "saving the files",
    "start": "starting",
    "test": "this test",
    "cpu_time": "{what} was stopped: it may compute for {seconds} s and had not finished. Is there a loop that never ends?",
    "wall_time": "{what} was stopped after {seconds} s by the clock. Is it waiting for something?",
    "notebook_time": (
        "the notebook has used the {seconds} s of computing that all its cells may take together; the rest was not run"
    ),
    "memory": "{what} asked for more memory than the {size} MiB it may have. Is an array far larger than meant?",
    "signal": "{what} ended the notebook's process: {how}. What comes after it could not be run",
    "exit": "{what} ended the notebook's own process (os._exit or the like, code {code}). What comes after it could not be run",
    "closed": (
        "{what} closed a connection that it did not open (os.close or the like), and the notebook was stopped. "
        "What comes after it could not be run"
    ),
    "protocol": (
        "the notebook's process sent something that is no answer ({error}); it was stopped. Does the code write to open files?"
    ),
    "crash_segmentation": "a crash in compiled code (segmentation fault)",
    "crash_abort": "a crash in compiled code (abort)",
    "crash_bus": "a crash in compiled code (bus error), perhaps of a full scratch folder",
    "crash_arithmetic": "a crash in compiled code (arithmetic)",
    "crash_instruction": "a crash in compiled code (illegal instruction)",
    "forbidden": "a system call that is not allowed",
    "killed": "it was killed",
    "number": "signal {number}",
    "not_shown": "[this output cannot be shown here: {kinds}]",
    "nothing": "nothing",
}


class Said(str):
    """A text made from ``WORDS``, with its key and the facts in it, some of which are such texts themselves."""

    key: str = ""
    facts: Mapping[str, str] = {}


def said(key: str, **facts: str) -> Said:
    """One of the texts above, its facts filled in."""
    text = Said(WORDS[key].format(**facts))
    text.key, text.facts = key, facts
    return text


CELL, CALL, FILES, START, TEST = map(said, ("cell", "call", "files", "start", "test"))
SIGNALS: dict[int, str] = {
    signal.SIGSEGV: said("crash_segmentation"),
    signal.SIGABRT: said("crash_abort"),
    signal.SIGBUS: said("crash_bus"),
    signal.SIGFPE: said("crash_arithmetic"),
    signal.SIGILL: said("crash_instruction"),
    signal.SIGSYS: said("forbidden"),
    signal.SIGKILL: said("killed"),
}


def cpu_time(what: str, seconds: float) -> str:
    """The CPU time of a cell or call is used up."""
    return said("cpu_time", what=what, seconds=f"{seconds:g}")


def wall_time(what: str, seconds: float) -> str:
    """Time by the clock is used up."""
    return said("wall_time", what=what, seconds=f"{seconds:g}")


def notebook_time(seconds: float) -> str:
    """The notebook's CPU time is used up."""
    return said("notebook_time", seconds=f"{seconds:g}")


def memory(what: str, allowed: int) -> str:
    """A MemoryError."""
    return said("memory", what=what, size=f"{allowed / 2**20:g}")


def died(what: str, number: int, code: int) -> str:
    """The process is gone: by a signal, or of its own will with an exit code."""
    if number:
        return said("signal", what=what, how=SIGNALS.get(number) or said("number", number=str(number)))
    return said("exit", what=what, code=str(code))


def closed(what: str) -> str:
    """The process lives, but has closed its connection to the grader."""
    return said("closed", what=what)


def protocol(error: Exception) -> str:
    """The child sent what our child never sends."""
    return said("protocol", error=str(error))


def not_shown(kinds: str) -> str:
    """An output of which nothing can be shown."""
    return said("not_shown", kinds=kinds or said("nothing"))
