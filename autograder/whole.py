"""A file that is written whole or not at all: a full disk, a stopped command leave the one that was there before."""

from __future__ import annotations

import contextlib
import os
import secrets
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO


@contextlib.contextmanager
def replaced(path: Path, mode: int | None = None) -> Iterator[BinaryIO]:
    """A file to write, which takes the place of the one at ``path`` once all of it is on the disk.

    Where ``path`` is a link, what it names is replaced; what is no file but a pipe or a device (``/dev/stdout``) is written to.

    Parameters
    ----------
    mode : int, optional
        Permissions of the file; default those of the one before, or those that new files have.

    Raises
    ------
    OSError
        If it cannot be written, with ``path`` as its ``filename``; nothing of it is left.
    """
    try:
        with path.open("wb") if path.exists() and not path.is_file() else _beside(Path(os.path.realpath(path)), mode) as file:
            yield file
    except OSError as error:
        if error.errno is None:
            raise
        raise OSError(error.errno, error.strerror, str(path)) from error


@contextlib.contextmanager
def _beside(path: Path, mode: int | None) -> Iterator[BinaryIO]:
    """A new file in the same folder, renamed when it is written."""
    mode = path.stat().st_mode & 0o7777 if mode is None and path.exists() else mode
    new = path.with_name(f".directrix-{secrets.token_hex(8)}")
    try:
        with new.open("xb") as file:
            yield file
        if mode is not None:
            new.chmod(mode)
        os.replace(new, path)
    except BaseException:
        with contextlib.suppress(OSError):
            new.unlink(missing_ok=True)
        raise
