"""What was graded from what: one small file a submission in ``.directrix/graded/``, written after everything else.

A submission whose bytes are those in its journal is not graded again. A journal that is lost costs time, never a mark: marks
are in the gradebook, and grading the same bytes gives the same marks.
"""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
import json
import os
import secrets
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from autograder.errors import CourseError
from autograder.fleet.result import StudentReport


@dataclass(frozen=True)
class Entry:
    """Digests of the submission and of the instructor's copy that were graded, the sandbox's level, and the report."""

    submission: str
    masters: str
    level: str
    report: StudentReport


class Journal:
    """The journal of one assignment."""

    def __init__(self, room: Path, assignment: str) -> None:
        self.folder = room / "graded" / quote(assignment, safe="")

    def read(self, student: str) -> Entry | None:
        """The entry of a student; None if there is none that can be read."""
        try:
            data = json.loads(self._path(student).read_text("utf-8"))
            return Entry(data["submission"], data["masters"], data["level"], StudentReport.from_dict(data["report"]))
        except (OSError, ValueError, KeyError, TypeError):
            return None

    def write(self, student: str, entry: Entry) -> None:
        """Replace the entry of a student, whole or not at all."""
        self._replace(student, json.dumps({**vars(entry), "report": entry.report.to_dict()}, allow_nan=False))

    def begin(self, student: str) -> None:
        """Replace the entry of a student by a note that new marks are about to be committed."""
        self._replace(student, json.dumps({"begun": True}))

    def begun(self, student: str) -> bool:
        """Whether there is such a note in the place of an entry; what cannot be read counts as one."""
        return self._path(student).exists() and self.read(student) is None

    def _replace(self, student: str, text: str) -> None:
        self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        path = self._path(student)
        new = path.with_name(f".{secrets.token_hex(8)}")
        try:
            new.write_text(text, "utf-8")
            os.replace(new, path)
        except OSError:
            new.unlink(missing_ok=True)
            raise

    def _path(self, student: str) -> Path:
        name = quote(student, safe="")  # nine bytes for a letter of three: long ids in other scripts outgrow a file's name
        return self.folder / f"{name if len(name) <= 200 else hashlib.sha256(student.encode()).hexdigest()}.json"


@contextlib.contextmanager
def only_grader(room: Path) -> Iterator[None]:
    """Hold the course's lock: two graders at once would undo each other's work. The lock goes with its process.

    Raises
    ------
    CourseError
        If another grader holds it.
    """
    with (room / "lock").open("a") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise CourseError("another grader is at work in this course; wait until it has finished") from None
        yield
