"""How nbgrader's Autograde comes to the files that were handed in: never through what would hold or fill the machine.

nbgrader opens whatever is called ``*.ipynb`` and copies whatever lies beside it, following links: a FIFO holds the whole class
for ever, a link to ``/dev/zero`` or ``/proc/self/pagemap`` is copied until the disk is full, and a folder whose name has a line
break ends the run.
"""

from __future__ import annotations

import contextlib
import glob
import os
import re
import stat
import weakref
from pathlib import Path
from typing import Any

import nbformat
from nbconvert.exporters import NotebookExporter

from autograder.course import Course
from autograder.notebook.submission import NO_ID, PLAIN_ID, Bounds, parse, read_file
from autograder.notebook.timestamps import FILE

TIMESTAMP = 1000  # bytes of the file that says when it was handed in
MOST_LEFT_OUT = 20  # files of one submission; nbgrader looks for each of them beside every file that it copies


class Submitted(NotebookExporter):
    """nbgrader's exporter, for notebooks that are regular files. Made by the converter, when it has listed the submissions."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)  # type: ignore[no-untyped-call]
        listed: dict[str, Any] = getattr(self.parent, "assignments", {})
        if not listed:
            return
        converter: Any = self.parent
        coursedir = converter.coursedir
        largest = Course(coursedir.root, config=self.config).bounds.file
        left_out: list[str] = []
        for folder in list(listed):
            odd = [] if os.path.islink(folder) else _odd(Path(folder), largest)
            reason = self._refused(folder, odd)
            if reason:
                del listed[folder]
                self.log.error("%s was not graded: %s", ascii(folder), reason)
                continue
            left_out += odd
            for path in odd:
                self.log.warning("%s was not copied: it leads to no file, or to one too large", ascii(path))
        _ignore(coursedir, left_out)

    def _refused(self, folder: str, odd: list[str]) -> str:
        """Why nbgrader must not even begin with a submission; empty if it may."""
        converter: Any = self.parent
        layout = converter._format_source("(?P<assignment_id>.*)", "(?P<student_id>.*)", escape=True)
        student = re.fullmatch(layout, folder, re.DOTALL)
        if student is None or not PLAIN_ID.fullmatch(student["student_id"]):
            return f"the name of its folder {NO_ID}; rename it"
        above = Path(folder).parent
        if os.path.islink(folder) or (above.name == student["student_id"] and above.is_symlink()):
            return "it is a link"
        if os.path.join(folder, FILE) in odd:  # nbgrader reads it whole before it looks at what to copy
            return f"{FILE} leads to no file, or is too large"
        return f"{len(odd)} of its names lead to no file, or to one too large" if len(odd) > MOST_LEFT_OUT else ""

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


def _odd(folder: Path, largest: int) -> list[str]:
    """Paths of devices, FIFOs and sockets, of what is too large, and of links to such, that are no notebooks.

    A file of the kernel's (``/proc/self/pagemap``) says that it is empty and gives hundreds of gigabytes: a link to an empty
    file is one of them. ``timestamp.txt`` is read whole before anything is copied.
    """
    found = []
    for place, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(place, name)
            most = TIMESTAMP if path == str(folder / FILE) else largest
            regular = False
            with contextlib.suppress(OSError):  # a link to nowhere
                about = os.stat(path)
                regular = stat.S_ISREG(about.st_mode) and about.st_size <= most
                regular = regular and (about.st_size > 0 or not os.path.islink(path))
            if not regular and not name.endswith(".ipynb"):
                found.append(path)
    return sorted(found)


def _ignore(coursedir: Any, paths: list[str]) -> None:
    """Add paths to what nbgrader does not copy, in the place of those of an earlier run in the same process (formgrader's).

    nbgrader joins each pattern to the folder of a file, and a whole path stays what it is: it means this one file, and not the
    instructor's of the same name.
    """
    before = _ignored.get(coursedir, frozenset())
    added = [glob.escape(path) for path in paths]
    coursedir.ignore = [pattern for pattern in coursedir.ignore if pattern not in before] + added
    _ignored[coursedir] = frozenset(added)


_ignored: weakref.WeakKeyDictionary[Any, frozenset[str]] = weakref.WeakKeyDictionary()  # by course directory
