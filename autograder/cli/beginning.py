"""What ``directrix grade`` begins with, before the command line itself is loaded: the sandbox that the last run needed."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from autograder.notebook.secret import ROOM
from autograder.sandbox import ahead

VALUED = ("--course", "--student", "--workers", "--level", "--scheduler")


def begin(words: Sequence[str]) -> None:
    """Begin, if these words of the command line say that an assignment is graded here. Whether they are right is not asked."""
    given, assignment = _read(words)
    if assignment is None or given.get("--scheduler"):
        return
    course = Path(given.get("--course", ""))
    if "--force" in given or _something_new(course, assignment):
        ahead.begin(ahead.note(course / ROOM, assignment), given.get("--level") or "A")


def _read(words: Sequence[str]) -> tuple[dict[str, str], str | None]:
    """Options, the last of each, and the assignment; no assignment where help is asked for."""
    given: dict[str, str] = {}
    assignment = None
    rest = iter(words)
    for word in rest:
        option, sign, value = word.partition("=")
        if option in VALUED:
            given[option] = value if sign else next(rest, "")
        elif word.startswith("-"):
            given[word] = ""
        else:
            assignment = assignment or word
    return given, None if "--help" in given else assignment


def _something_new(course: Path, assignment: str) -> bool:
    """Whether somebody has handed in who has never been graded; where folders are named otherwise nobody has."""
    try:
        names = os.listdir(course / "submitted")
    except OSError:
        return False
    graded, handed_in = (f"{course}/{step}/{{}}/{assignment}" for step in ("autograded", "submitted"))
    return any(not os.path.exists(graded.format(name)) and os.path.exists(handed_in.format(name)) for name in names)
