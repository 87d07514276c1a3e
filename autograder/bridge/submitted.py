"""How nbgrader's Autograde comes to the files that were handed in: never through what would hold or fill the machine.

nbgrader opens whatever is called ``*.ipynb`` and copies whatever lies beside it, following links: a FIFO holds the whole class
for ever, a link to ``/dev/zero`` is copied until the disk is full, and a folder whose name has a line break ends the run.
"""

from __future__ import annotations

import os
import re
import stat
from pathlib import Path
from typing import Any

from nbconvert.exporters import NotebookExporter

from autograder.notebook.submission import PLAIN_ID, Bounds, read_file


class Submitted(NotebookExporter):
    """nbgrader's exporter, for notebooks that are regular files. Made by the converter, when it has listed the submissions."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)  # type: ignore[no-untyped-call]
        listed: dict[str, Any] = getattr(self.parent, "assignments", {})
        for folder in list(listed):
            reason = self._refused(folder)
            if reason:
                del listed[folder]
                self.log.error("%s was not graded: %s", ascii(folder), reason)

    def _refused(self, folder: str) -> str:
        """Why nbgrader must not even begin with a submission; empty if it may."""
        converter: Any = self.parent
        layout = converter._format_source("(?P<assignment_id>.*)", "(?P<student_id>.*)", escape=True)
        student = re.fullmatch(layout, folder, re.DOTALL)
        if student is None or not PLAIN_ID.fullmatch(student["student_id"]):
            return "the name of its folder is no student's id"
        above = Path(folder).parent
        if os.path.islink(folder) or (above.name == student["student_id"] and above.is_symlink()):
            return "it is a link"
        endless = _endless(Path(folder))
        return f"{endless} lead to no file, and copying them might never end" if endless else ""

    def from_filename(self, filename: str, resources: Any = None, **options: Any) -> tuple[Any, Any]:
        """Read a notebook; raises SubmissionError, which nbgrader names with the student, if it is no regular file."""
        if getattr(self.parent, "_sanitizing", True):  # as handed in, not as rebuilt
            read_file(Path(filename), Bounds().notebook)
        return super().from_filename(filename, resources=resources, **options)


def _endless(folder: Path) -> list[str]:
    """Names of devices, FIFOs and sockets, and of links to them, that are no notebooks."""
    found = []
    for place, _, names in os.walk(folder):
        for name in names:
            try:
                mode = os.stat(os.path.join(place, name)).st_mode
            except OSError:  # a link to nowhere: copying fails at once
                continue
            if not stat.S_ISREG(mode) and not name.endswith(".ipynb"):
                found.append(name)
    return sorted(found)
