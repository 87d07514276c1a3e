"""Reads a zip archive from people who may want it to do harm: nothing is unpacked, every member is read within bounds.

A member is taken only if it is an ordinary file with an ordinary relative name that occurs once, stored or deflated, not
encrypted, and as large as it says. Everything else is named with the reason, and the rest is read on. Dates and permissions of
members are the sender's word and are not used; the same holds for a ``timestamp.txt``. An archive inside an archive is read in
the same way, one level deep.
"""

from __future__ import annotations

import fnmatch
import io
import re
import stat
import struct
import warnings
import zipfile
import zlib
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import IO

from autograder.errors import SubmissionError
from autograder.notebook.submission import IGNORE, MAX_DEPTH, Bounds
from autograder.notebook.timestamps import FILE
from autograder.sandbox.session import plain_name

METHODS = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}  # the others can ask for gigabytes of memory before the first byte
JUNK = ("__MACOSX", ".DS_Store", "Thumbs.db")
LONGEST_NAME = 200
_ENTRY = b"PK\x01\x02"
_END, _END64 = struct.Struct("<4s4H2LH"), struct.Struct("<4sQ2H2L4Q")
_BROKEN = (zipfile.BadZipFile, zlib.error, EOFError, OSError, NotImplementedError, RuntimeError, ValueError, struct.error)


@dataclass
class Unpacked:
    """The members of an archive that can be taken, by path, and why others are not; bytes that were unpacked in vain."""

    files: dict[str, bytes] = field(default_factory=dict)
    refused: dict[str, str] = field(default_factory=dict)
    wasted: int = 0


def read(data: bytes, *, ignore: Sequence[str] = IGNORE, bounds: Bounds | None = None) -> Unpacked:
    """All members of an archive that one learner made.

    Raises
    ------
    SubmissionError
        If it is no zip archive that can be read, or announces too many members.
    """
    bounds = bounds or Bounds()
    if data.count(_ENTRY) > bounds.entries:  # before the list of members takes memory
        raise SubmissionError(f"the archive has more than {bounds.entries} members")
    found = Unpacked()
    with opened(io.BytesIO(data)) as archive:
        take(archive, list(members(archive, found.refused, ignore)), found, bounds)
    return found


def opened(file: IO[bytes]) -> zipfile.ZipFile:
    """The archive in an open file.

    Raises
    ------
    SubmissionError
        If it is none.
    """
    try:
        return zipfile.ZipFile(file)
    except _BROKEN as error:
        raise SubmissionError(f"it is no zip archive that can be read ({error})") from None


def announced(file: IO[bytes]) -> int:
    """Bytes of the list of members, which is read whole when an archive is opened; 0 if there is no such list."""
    size = file.seek(0, io.SEEK_END)
    file.seek(max(0, size - 2**16 - _END.size))
    tail = file.read()
    at = tail.rfind(b"PK\x05\x06")
    if at < 0 or len(tail) - at < _END.size:
        return 0
    length = int(_END.unpack_from(tail, at)[5])
    wide = tail.rfind(b"PK\x06\x06", 0, at)
    if length == 0xFFFFFFFF and wide >= 0 and at - wide >= _END64.size:
        length = int(_END64.unpack_from(tail, wide)[8])
    return length


def members(
    archive: zipfile.ZipFile, refused: dict[str, str], ignore: Sequence[str] = IGNORE
) -> Iterator[tuple[str, zipfile.ZipInfo]]:
    """The members that may be read, with their paths; the others are named in ``refused``."""
    listed = [(info.orig_filename, info) for info in archive.infolist()]
    times = Counter(name for name, _ in listed)
    files = {name for name, _ in listed if not name.endswith("/")}
    for name, info in listed:
        if any(fnmatch.fnmatch(part, pattern) for part in name.split("/") for pattern in (*ignore, *JUNK)):
            continue
        reason = _refusal(name, info)
        if not reason and times[name] > 1:
            reason = "the archive has several members of this name, and which one counts would depend on who unpacks it"
        if not reason and any(str(parent) in files for parent in PurePosixPath(name).parents):
            reason = "it lies in a folder that is a file in the same archive"
        if reason:
            refused[name] = reason
        elif not name.endswith("/"):
            yield name, info


def take(archive: zipfile.ZipFile, chosen: Sequence[tuple[str, zipfile.ZipInfo]], found: Unpacked, bounds: Bounds) -> None:
    """Read these members into ``found``, within the bounds of one submission."""
    left = bounds.total - sum(map(len, found.files.values())) - found.wasted
    for path, info in chosen:
        most = min(bounds.notebook if path.endswith(".ipynb") else bounds.file, left)
        if len(found.files) >= bounds.entries:
            found.refused[path] = f"there are more than {bounds.entries} files"
            continue
        try:
            data = _read(archive, info, most)
        except SubmissionError as error:
            found.refused[path] = str(error)
            if info.file_size <= most:  # it was unpacked to find that out, and thousands of such members take their time
                found.wasted += info.file_size
                left -= info.file_size
            continue
        left -= len(data)
        found.files[path] = data


def _refusal(name: str, info: zipfile.ZipInfo) -> str:
    parts = name.removesuffix("/").split("/")
    kind = stat.S_IFMT(info.external_attr >> 16)
    if name.startswith("/") or ".." in parts or re.match(r"[A-Za-z]:", name):
        return "its name leads out of the folder"
    if not all(plain_name(part) and len(part) <= LONGEST_NAME for part in parts):
        return "its name has characters that a file's name should not have, or is too long"
    if len(parts) > MAX_DEPTH:
        return f"it lies more than {MAX_DEPTH} folders deep"
    if kind not in (0, stat.S_IFREG, stat.S_IFDIR):
        return "it is a link" if kind == stat.S_IFLNK else "it is no file"
    if info.flag_bits & 0x41:
        return "it is encrypted"
    if not name.endswith("/") and info.compress_type not in METHODS:
        return "it is compressed by a method that is not taken here; make the archive with the ordinary one (deflate)"
    if parts[-1] == FILE:
        return "when something was handed in is not for the sender to say"
    return ""


def _read(archive: zipfile.ZipFile, info: zipfile.ZipInfo, most: int) -> bytes:
    too_large = f"more than the {max(most, 0)} bytes that a submission may still bring"
    if info.file_size > most:
        raise SubmissionError(f"{info.file_size} bytes are {too_large}")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # newer Pythons warn of parts that overlap; what they hold is bounded in any case
            with archive.open(info) as member:
                data = member.read(most + 1)
    except _BROKEN as error:
        raise SubmissionError(f"it is damaged ({error})") from None
    if len(data) > most:
        raise SubmissionError(f"it holds {too_large}")
    if len(data) != info.file_size:
        raise SubmissionError("it is not as long as the archive says")
    return data
