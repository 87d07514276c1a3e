"""How nbgrader's Autograde comes to the files that were handed in: never through what would hold or fill the machine.

nbgrader opens whatever is called ``*.ipynb`` and copies whatever lies beside it, following links: a FIFO holds the whole class
for ever, a link to ``/dev/zero`` or ``/proc/self/pagemap`` is copied until the disk is full, and a folder whose name has a line
break ends the run.
"""

from __future__ import annotations

import os
import re
import stat
from pathlib import Path
from typing import Any

import nbformat
from nbconvert.exporters import NotebookExporter

from autograder.notebook.submission import NO_ID, PLAIN_ID, Bounds, parse, read_file
from autograder.notebook.timestamps import FILE

TIMESTAMP = 1000  # bytes of the file that says when it was handed in


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
            return f"the name of its folder {NO_ID}; rename it"
        above = Path(folder).parent
        if os.path.islink(folder) or (above.name == student["student_id"] and above.is_symlink()):
            return "it is a link"
        endless = _endless(Path(folder), 1000 * converter.coursedir.max_file_size)
        return f"{endless} lead to no file, or to one too large, and copying them might never end" if endless else ""

    def from_filename(self, filename: str, resources: Any = None, **options: Any) -> tuple[Any, Any]:
        """Read a notebook; raises SubmissionError, which nbgrader names with the student, if we could not read it."""
        if self._as_handed_in:
            parse(read_file(Path(filename), Bounds().notebook))
        return super().from_filename(filename, resources=resources, **options)

    def from_file(self, file_stream: Any, resources: Any = None, **options: Any) -> tuple[Any, Any]:
        """Begin a submitted notebook with an empty page, since Rebuild reads it itself: what nbformat refuses, it may not."""
        if not self._as_handed_in:
            return super().from_file(file_stream, resources=resources, **options)
        page: Any = nbformat.from_dict({"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": []})  # type: ignore[no-untyped-call]
        begun: tuple[Any, Any] = super().from_notebook_node(page, resources=resources, **options)  # type: ignore[no-untyped-call]
        return begun

    @property
    def _as_handed_in(self) -> bool:
        """Whether nbgrader is reading what was handed in, and not what was rebuilt from it."""
        return bool(getattr(self.parent, "_sanitizing", True))


def _endless(folder: Path, largest: float) -> list[str]:
    """Names of devices, FIFOs and sockets, of what is too large, and of links to such, that are no notebooks.

    A file of the kernel's (``/proc/self/pagemap``) says that it is empty and gives hundreds of gigabytes: a link to an empty
    file is one of them. ``timestamp.txt`` is read whole before anything is copied.
    """
    found = []
    for place, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(place, name)
            try:
                about = os.stat(path)
            except OSError:  # a link to nowhere: copying fails at once
                continue
            most = TIMESTAMP if path == str(folder / FILE) else largest
            regular = stat.S_ISREG(about.st_mode) and about.st_size <= most and (about.st_size or not os.path.islink(path))
            if not regular and not name.endswith(".ipynb"):
                found.append(name)
    return sorted(found)
