"""What a cell is worth: nbgrader's scoring rules, failing closed where nbgrader fails open.

nbgrader (``nbgrader.utils.determine_grade``): an answer that a person grades is worth 0 while it is untouched and has no mark
once it is written; a test cell is worth 0 after an error or anything on stderr, else the number it returns, else all points.
We differ where a mark would come about by accident or by force: see :func:`partial` and ``DIFFERENCES``.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from autograder.messages import say
from autograder.notebook.master import MasterCell, checksum
from autograder.result import Verdict

Status = Literal["ok", "error", "timeout", "memory", "died", "refused", "judged", "not run"]
RAN: tuple[Status, ...] = ("ok", "error", "timeout", "memory", "died", "refused")
ROUNDING = 1e-9
_NUMPY = re.compile(r"np\.(?:float|int|uint)(?:8|16|32|64|128)?\((.*)\)|np\.(?:longdouble|intc|uintc)\((.*)\)")


@dataclass(frozen=True)
class CellRun:
    """What running one cell came to. A judged cell has a verdict; a cell that was not run says why in ``note``."""

    status: Status
    verdict: Verdict | None = None
    note: str = ""


@dataclass(frozen=True)
class Mark:
    """Points of one cell, None where a person decides. ``look`` asks for a manual look, ``note`` says why."""

    points: float | None
    look: bool = False
    note: str = ""


def mark(cell: Mapping[str, Any], master: MasterCell, run: CellRun | None, *, number: bool = False) -> Mark:
    """The mark of a graded cell as it lies in the rebuilt notebook.

    Parameters
    ----------
    cell : mapping
        The cell with its outputs, in nbformat 4.
    master : MasterCell
        The instructor's copy of it.
    run : CellRun or None
        How it ran; None if nothing was executed.
    number : bool
        Whether an ordinary test cell returns a number of points with the instructor's solution.
    """
    points = float(master.points or 0.0)
    if master.solution:
        if checksum(cell["cell_type"], cell["source"], master) == master.checksum:
            return Mark(0.0)
        return Mark(None, look=True)
    if cell["cell_type"] != "code":
        return Mark(None, look=True)
    if master.exercise is not None and (run is None or run.status not in RAN):
        return judged(run, points)
    if run is None or run.status not in RAN:
        return Mark(None, look=True, note=(run.note if run else "") or say("graded.not_executed"))
    return scored(cell["outputs"], points, number=number)


def judged(run: CellRun | None, points: float) -> Mark:
    """The mark of an exercise cell: its verdict's share of the points."""
    if run is None or run.verdict is None:
        return Mark(None, look=True, note=(run.note if run else "") or say("graded.not_judged"))
    if run.verdict.outcome == "could not judge":
        return Mark(None, look=True, note=run.note or say("graded.could_not_judge"))
    return Mark(run.verdict.points(points))


def scored(outputs: Sequence[Mapping[str, Any]], points: float, *, number: bool = False) -> Mark:
    """The mark of an ordinary test cell from its outputs; the first that decides, decides.

    What returns a ``number`` of points with the solution has to return one.
    """
    for output in outputs:
        kind = output["output_type"]
        if kind == "error" and _could_not_cross(output):
            return Mark(0.0, look=True, note=say("graded.could_not_cross"))
        if kind == "error" or (kind == "stream" and output["name"] == "stderr"):
            return Mark(0.0)
        if kind == "execute_result":
            return partial(output["data"].get("text/plain"), points, number=number)
    return Mark(points) if not number else Mark(0.0, look=True, note=say("graded.no_points", shown=say("graded.nothing")))


def _could_not_cross(output: Mapping[str, Any]) -> bool:
    """Whether a test that runs apart failed for a value that has no way to it, which may be a right one."""
    gap, told = "\0", ("guest.hands_over", "guest.cannot_leave", "guest.has_now")
    ends = tuple(say(key, name=gap, what=gap).rpartition(gap)[2] for key in told)
    return output.get("ename") == "NoAnswer" and str(output.get("evalue")).endswith(ends)


def returns_number(outputs: Sequence[Mapping[str, Any]]) -> bool:
    """Whether the cell returned a plain number."""
    shown = [output["data"].get("text/plain") for output in outputs if output["output_type"] == "execute_result"]
    return any(isinstance(text, str) and _number(text) is not None for text in shown)


def partial(shown: str | None, points: float, *, number: bool = False) -> Mark:
    """The mark for the value that a test cell returned, from its text.

    A plain number in [0, points] counts, ``np.float64(0.5)`` too (nbgrader: full points). Negative, NaN or more than the
    points: 0 and a manual look (nbgrader: full points, full points, the submission fails). Anything else keeps nbgrader's full
    points, with a warning; but where a ``number`` is due, an array or a text is what a wrong answer made of it: 0 and a look.
    """
    if shown is None:
        return Mark(None, look=True, note=say("graded.no_text"))
    value = _number(shown)
    if value is None and number:
        return Mark(0.0, look=True, note=say("graded.no_points", shown=_short(shown)))
    if value is None:
        return Mark(points, note=say("graded.no_number", shown=_short(shown)))
    if 0 <= value <= points + ROUNDING * max(points, 1.0):
        return Mark(min(abs(value), points))
    outside = {"value": f"{value:g}", "points": f"{points:g}"}
    return Mark(0.0, look=True, note=say("graded.nan") if math.isnan(value) else say("graded.outside", **outside))


def _number(shown: str) -> float | None:
    inner = _NUMPY.fullmatch(shown.strip())
    try:
        return float((inner[1] or inner[2]) if inner else shown)
    except ValueError:
        return None


def _short(shown: str) -> str:
    line = " ".join(shown.split())
    return line if len(line) <= 60 else line[:57] + "..."


DIFFERENCES = (
    ("forged outputs under --no-execute", "scored", "outputs of graded cells are dropped; no mark, and a manual look"),
    ("a cell of the submission with a name that the assignment does not have", "the submission is dropped", "an ordinary cell"),
    ("code that hangs in C, os._exit, too much memory", "the submission is dropped", "costs its own cells; the rest is graded"),
    ("c.Execute.timeout", "seconds by the clock", "seconds of CPU time; by the clock three times that and ten"),
    ("np.float64(0.5) returned by a test cell", "full points", "0.5 points"),
    ("a negative number or NaN returned by a test cell", "full points", "0 points and a manual look"),
    ("an array, or nothing, returned where it is a number with the solution in source/", "full points", "0 points and a look"),
    ("a Decimal, or the learner's own class, where a test runs apart", "as the test finds", "0 points and a look"),
    ("a number above the points", "the submission is dropped", "0 points and a manual look (rounding aside)"),
    ("a tag such as skip-execution on a graded cell of the submission", "not run, full points", "ignored: it is run"),
    ("a graded cell that is there twice", "the run for the whole class stops", "the last counts, with a manual look"),
    ("a graded cell that was deleted from a resubmission", "keeps the old mark", "no mark, and a manual look"),
    ("a task of a resubmission", "a mark by hand, or the zero of no notebook, stands", "the first stands, with a manual look"),
    ("a penalty on a notebook that a resubmission leaves out", "taken off the others", "no more than the notebook has"),
    ("a resubmission without any notebook", "keeps the old marks", "no marks, and a manual look (by `directrix grade`)"),
    ("a notebook in UTF-16, or with an odd nbformat_minor", "the submission is dropped", "graded"),
    ("a time zone written +0100 in timestamp.txt", "taken for 100 seconds", "one hour"),
    ("a test cell that was not executed", "full points", "no mark, and a manual look"),
)
"""Where we differ from nbgrader's scores: (what, nbgrader, here)."""
