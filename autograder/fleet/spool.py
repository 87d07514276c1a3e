"""The reports of a class, on disk: memory holds a few bytes of each, so a run takes no more of it for a larger class."""

from __future__ import annotations

import json
import os
import tempfile
import weakref
from array import array
from collections.abc import Sequence
from pathlib import Path
from typing import Any, overload

from autograder.errors import CourseError
from autograder.fleet.result import StudentReport


class Spool(Sequence[StudentReport]):
    """Reports in the order in which they were added, read as often as one likes, each from the disk.

    They lie as JSON in a file of mode 0600 that has no name, so it goes with the last who holds it, however that one ends. What
    the disk does not take, a full one say, stays in memory: a report is never lost for want of room. Copied or pickled, a spool
    becomes a tuple.

    Parameters
    ----------
    folder : Path
        Where the file is made: on the disk that has room for the course, which a folder for temporary files need not have.
    """

    def __init__(self, folder: Path) -> None:
        self._ends = array("Q", [0])  # where each report ends in the file, after where the first begins
        self._held: dict[int, bytes] = {}
        self._file = -1
        try:
            file = tempfile.TemporaryFile(dir=folder, buffering=0)  # noqa: SIM115
        except OSError:
            return
        self._file = file.fileno()
        weakref.finalize(self, file.close)

    def add(self, report: StudentReport) -> int:
        """Add a report; its place."""
        place, begin = len(self), self._ends[-1]
        data = json.dumps(report.to_dict()).encode()
        try:
            taken = os.pwrite(self._file, data, begin) == len(data)
        except OSError:
            taken = False
        if not taken:
            self._held[place] = data
        self._ends.append(begin + len(data) * taken)
        return place

    def __len__(self) -> int:
        return len(self._ends) - 1

    @overload
    def __getitem__(self, place: int) -> StudentReport: ...
    @overload
    def __getitem__(self, place: slice) -> tuple[StudentReport, ...]: ...
    def __getitem__(self, place: int | slice) -> StudentReport | tuple[StudentReport, ...]:
        """One report, or a tuple of several.

        Raises
        ------
        CourseError
            If the disk does not give back what was written to it.
        """
        if isinstance(place, slice):
            return tuple(self[one] for one in range(len(self))[place])
        place = range(len(self))[place]  # counts from the end too, and refuses what is outside
        return StudentReport.from_dict(json.loads(self._held.get(place) or self._read(place)))

    def _read(self, place: int) -> bytes:
        begin, end = self._ends[place], self._ends[place + 1]
        try:
            data = os.pread(self._file, end - begin, begin)
        except OSError as error:
            raise _unread(error.strerror or str(error)) from error
        if len(data) < end - begin:
            raise _unread("the file has been cut")
        return data

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, (tuple, Spool)):
            return NotImplemented
        return len(self) == len(other) and all(mine == theirs for mine, theirs in zip(self, other, strict=True))

    def __reduce__(self) -> tuple[Any, ...]:
        return tuple, (tuple(self),)

    def __repr__(self) -> str:
        return f"<Spool of {len(self)} reports>"


def _unread(why: str) -> CourseError:
    return CourseError(
        f"a report of this run cannot be read back from .directrix/: {why}; the marks are in the gradebook, and the same "
        "command again reports them"
    )
