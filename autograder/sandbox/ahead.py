"""A zygote that is launched on the word of the run before, while the grader itself is still being loaded.

What a sandbox must show is known once course, exercises and gradebook have been read, and to start one takes as long as that.
So a run leaves a note of the policy, and the next one begins with what the note says. Whoever makes a :class:`Sandbox` of that
very policy and level is given it; a guess that was wrong is ended, and decides nothing.
"""

from __future__ import annotations

import contextlib
import json
import os
from pathlib import Path

from autograder.sandbox.launcher import Launched, launch
from autograder.sandbox.policy import Policy

_waiting: list[tuple[Policy, str, Launched]] = []  # at most one


def note(room: Path, assignment: str) -> Path:
    """Where the note of an assignment lies in the folder of a course's own records."""
    return room / f"sandbox.{assignment}.json"


def remember(place: Path, policy: Policy, level: str) -> None:
    """Leave a note for the next run; where that cannot be written, the next run takes longer."""
    text = json.dumps({"packages": policy.packages, "preload": policy.preload, "level": level})
    with contextlib.suppress(OSError):
        if not place.exists() or place.read_text("utf-8") != text:
            written = place.with_name(f"{place.name}.{os.getpid()}")
            written.write_text(text, "utf-8")
            written.replace(place)


def begin(place: Path, level: str) -> None:
    """Launch what the note says, if that has the level. Call it from the main thread: bubblewrap dies with who started it."""
    with contextlib.suppress(Exception):  # no note, or torn; and whoever needs a sandbox tells why none can be started
        said = json.loads(place.read_text("utf-8"))
        packages = said["packages"] if said["packages"] == "all" else tuple(map(str, said["packages"]))
        if said["level"] == level:
            policy = Policy(packages, tuple(map(str, said["preload"])))
            _waiting.append((policy, level, launch(policy, level)))


def taken(policy: Policy, level: str) -> Launched | None:
    """The zygote that was begun, which is the taker's from now on, if it is of this policy and level."""
    while _waiting:
        *guessed, launched = _waiting.pop()
        if guessed == [policy, level] and launched.process.poll() is None:
            return launched
        launched.end()
    return None


def drop() -> None:
    """End what nobody has taken."""
    while _waiting:
        _waiting.pop()[-1].end()
