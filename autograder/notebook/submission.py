"""Reads a hostile submission folder: regular files only, opened without following links, all of it bounded.

Every name is opened relative to its folder's descriptor with ``O_NOFOLLOW``, and what was opened is asked what it is: nothing
can be swapped between the look and the reading. A link, FIFO, socket or device is never opened for reading and never copied;
it is named in the notes. (A hard link cannot be told from a file; Linux lets nobody make one to a file that is not theirs.)
"""

from __future__ import annotations

import datetime
import fnmatch
import hashlib
import json
import os
import re
import stat
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Any

from autograder.errors import SubmissionError
from autograder.notebook.timestamps import FILE, handed_in
from autograder.sandbox.session import plain_name

IGNORE = (".ipynb_checkpoints", "*.pyc", "__pycache__", "feedback")  # nbgrader's own default
MAX_DEPTH = 12
MAX_CONTAINERS = 2_000_000
# formgrader writes ids into its pages as they are, between double quotes
PLAIN_ID = re.compile(r"[^\x00-\x1f\x7f<>&\"`\\\ud800-\udfff]{1,128}")
NO_ID = "is no student's id: that has up to 128 letters, digits, blanks and signs, but none of < > & \" ` \\"


@dataclass(frozen=True)
class Bounds:
    """What one submission may bring: bytes a notebook, bytes a file, bytes in all, number of entries."""

    notebook: int = 32_000_000
    file: int = 32_000_000
    total: int = 64_000_000
    entries: int = 900


@dataclass
class Submission:
    """The regular files of a folder by their path in it (``/`` between parts), and what was left out, and why.

    ``left_out`` has the reasons by path, ``notes`` the same as sentences and what else was noticed.
    """

    files: dict[str, bytes] = field(default_factory=dict)
    left_out: dict[str, str] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    @property
    def notebooks(self) -> dict[str, bytes]:
        """The notebooks at the top of the folder, by name without ``.ipynb``."""
        return {path[:-6]: data for path, data in self.files.items() if path.endswith(".ipynb") and "/" not in path}

    @property
    def others(self) -> dict[str, bytes]:
        """The files that are no notebooks."""
        return {path: data for path, data in self.files.items() if not path.endswith(".ipynb")}

    @property
    def handed_in(self) -> datetime.datetime | None:
        """When, as :func:`autograder.notebook.timestamps.handed_in` reads it.

        Raises
        ------
        SubmissionError
            Also where something else than a file that can be read stands in its place.
        """
        if FILE in self.left_out:
            raise SubmissionError(f"{FILE}: {self.left_out[FILE]}")
        return handed_in(self.files)

    @property
    def digest(self) -> str:
        """Of all files and their names."""
        total = hashlib.sha256()
        for path, data in sorted(self.files.items()):
            total.update(repr(path).encode() + hashlib.sha256(data).digest())
        return total.hexdigest()


def digest(data: bytes) -> str:
    """SHA-256 of a submitted notebook as it lies there."""
    return hashlib.sha256(data).hexdigest()


def read_folder(folder: Path, *, ignore: Sequence[str] = IGNORE, bounds: Bounds | None = None) -> Submission:
    """Read all regular files below a folder.

    Raises
    ------
    SubmissionError
        If the folder itself is a link, no folder, or cannot be opened.
    """
    found = Submission()
    try:
        descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC)
    except OSError as error:
        raise SubmissionError(f"the submission is no folder that can be opened: {error.strerror}") from None
    try:
        _Reader(found, tuple(ignore), bounds or Bounds()).walk(descriptor, "", 0)
    finally:
        os.close(descriptor)
    return found


def read_file(path: Path, limit: int) -> bytes:
    """One regular file, not through a link, up to a limit in bytes.

    Raises
    ------
    SubmissionError
        If it is something else, larger, or unreadable.
    """
    folder = os.open(path.parent, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        return _read(folder, path.name, limit)
    finally:
        os.close(folder)


class _Reader:
    def __init__(self, found: Submission, ignore: tuple[str, ...], bounds: Bounds) -> None:
        self.found, self.ignore, self.bounds = found, ignore, bounds
        self.entries = self.total = 0

    def walk(self, folder: int, prefix: str, depth: int) -> None:
        for name in self._names(folder, prefix):
            path = prefix + name
            if not plain_name(name) or len(name) > 200:
                self._leave_out(path, "its name has characters that a file's name should not have")
                continue
            try:
                if stat.S_ISDIR(os.stat(name, dir_fd=folder, follow_symlinks=False).st_mode):
                    self._enter(folder, name, path, depth)
                else:
                    self._take(folder, name, path)
            except SubmissionError as error:
                self._leave_out(path, str(error))
            except OSError as error:
                self._leave_out(path, f"it cannot be read ({error.strerror})")

    def _leave_out(self, path: str, reason: str) -> None:
        self.found.left_out[path] = reason
        self.found.notes.append(f"{_shown(path)}: left out, {reason}")

    def _names(self, folder: int, prefix: str) -> Iterator[str]:
        with os.scandir(folder) as listing:
            names = []
            for entry in listing:
                self.entries += 1
                if self.entries > self.bounds.entries:
                    self.found.notes.append(
                        f"{_shown(prefix) or 'the folder'}: more than {self.bounds.entries} entries; the rest is left out"
                    )
                    break
                if not any(fnmatch.fnmatch(entry.name, pattern) for pattern in self.ignore):
                    names.append(entry.name)
        yield from sorted(names)

    def _enter(self, folder: int, name: str, path: str, depth: int) -> None:
        if depth == 0 and (path.endswith(".ipynb") or path == FILE):
            raise SubmissionError(f"it is a folder, not a {'time' if path == FILE else 'notebook'}")
        if depth >= MAX_DEPTH:
            raise SubmissionError(f"folders lie more than {MAX_DEPTH} deep")
        inner = os.open(name, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC, dir_fd=folder)
        try:
            self.walk(inner, path + "/", depth + 1)
        finally:
            os.close(inner)

    def _take(self, folder: int, name: str, path: str) -> None:
        largest = self.bounds.notebook if name.endswith(".ipynb") else self.bounds.file
        data = _read(folder, name, min(largest, self.bounds.total - self.total))
        self.total += len(data)
        self.found.files[path] = data


def _read(folder: int, name: str, limit: int) -> bytes:
    # The kind is asked before opening, since opening alone can act on a device; and again of what was opened.
    _regular(os.stat(name, dir_fd=folder, follow_symlinks=False))
    descriptor = os.open(name, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC, dir_fd=folder)
    with os.fdopen(descriptor, "rb") as file:
        known = os.fstat(descriptor)
        _regular(known)
        data = file.read(limit + 1) if known.st_size <= limit else b""
    if known.st_size > limit or len(data) > limit:
        raise SubmissionError(f"{known.st_size} bytes are more than the {max(limit, 0)} that a submission may still bring")
    return data


def _regular(known: os.stat_result) -> None:
    if stat.S_ISREG(known.st_mode):
        return
    kinds = {stat.S_IFLNK: "a link", stat.S_IFIFO: "a FIFO", stat.S_IFSOCK: "a socket", stat.S_IFDIR: "a folder"}
    raise SubmissionError(f"it is {kinds.get(stat.S_IFMT(known.st_mode), 'a device')}, not a file")


def _shown(path: str) -> str:
    return path if path.isprintable() else ascii(path)[1:-1]


def beside(files: Mapping[str, bytes], first: Mapping[str, bytes]) -> dict[str, bytes]:
    """The files that can lie in one folder with the ``first`` ones: none is a folder there, none lies in a file there."""
    folders = {str(parent) for path in first for parent in PurePosixPath(path).parents}
    return {
        path: data
        for path, data in files.items()
        if path not in folders and not any(str(parent) in first for parent in PurePosixPath(path).parents)
    }


def harmless(path: str) -> bool:
    """Whether a path from the sandbox may be written below ``autograded/``: relative, no notebook, not the timestamp.

    Nor may a folder of such a name stand in the place of one.
    """
    parts = PurePosixPath(path).parts
    plain = bool(parts) and not path.startswith("/") and ".." not in parts and path.isprintable() and "\\" not in path
    return plain and parts[0] != FILE and not any(part.endswith(".ipynb") for part in parts)


def parse(data: bytes, *, containers: int = MAX_CONTAINERS) -> dict[str, Any]:
    """The JSON of a submitted notebook, in nbformat 4, with so many lists and objects in it at most.

    Raises
    ------
    SubmissionError
        Saying what is wrong with it, in words that a learner can act on.
    """
    if data.count(b"[") + data.count(b"{") > containers:  # each takes 60 bytes and more once it is read
        raise SubmissionError(f"the notebook has more than {containers} lists and objects in it")
    try:
        notebook: Any = json.loads(data)
    except UnicodeDecodeError:
        said = "the notebook is no text in UTF-8; perhaps another kind of file was renamed, or it was saved in another encoding"
        raise SubmissionError(said) from None
    except json.JSONDecodeError as error:
        begins = error.doc.strip()[:16]
        if not begins:
            raise SubmissionError("the file is empty") from None
        if not begins.startswith("{"):
            said = f"the file is no notebook: it begins with {begins!r}; perhaps another kind of file was saved under its name"
            raise SubmissionError(said) from None
        ends = error.msg.startswith("Unterminated") or error.pos >= len(error.doc.rstrip()) - 2
        how = "it ends in the middle, as after an upload that broke off" if ends else f"line {error.lineno}: {error.msg}"
        raise SubmissionError(f"the notebook is not valid JSON: {how}") from None
    except (ValueError, RecursionError):
        raise SubmissionError("the notebook is not valid JSON: nested too deeply, or a number of absurd length") from None
    if not isinstance(notebook, dict) or type(notebook.get("nbformat")) is not int:
        raise SubmissionError("the file is JSON, but no notebook")
    if notebook["nbformat"] != 4:
        notebook = _converted(notebook)
    if not isinstance(notebook.get("cells"), list):
        raise SubmissionError("the notebook has no list of cells")
    return dict(notebook)


def _converted(notebook: dict[str, Any]) -> dict[str, Any]:
    if not 1 <= notebook["nbformat"] < 4:
        raise SubmissionError(f"the notebook says nbformat {notebook['nbformat']}; 4 is the newest that is known here")
    import nbformat  # costs a second and is needed for notebooks of before 2015 only

    try:
        converted: dict[str, Any] = nbformat.convert(nbformat.from_dict(notebook), 4)  # type: ignore[no-untyped-call]
    except Exception as error:
        raise SubmissionError(f"the notebook is in an old format that cannot be converted ({type(error).__name__})") from None
    return converted
