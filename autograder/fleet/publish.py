"""Writes ``autograded/<student>/<assignment>``: complete beside its place first, then renamed into it.

For nbgrader a submission is done when that folder exists. So it comes last, after the marks are committed, and comes whole.
"""

from __future__ import annotations

import contextlib
import os
import secrets
import shutil
import stat
from collections.abc import Mapping
from pathlib import Path

MARK = ".directrix-"


def stage(place: Path, files: Mapping[str, bytes], *, mode: int, groupshared: bool) -> Path:
    """Write the files into a new hidden folder beside their place and return it."""
    clear(place)
    folder = place.with_name(f".{place.name}{MARK}{secrets.token_hex(8)}")
    folder.mkdir(parents=True)
    try:
        for name, data in files.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            with path.open("xb") as file:
                file.write(data)
            path.chmod(mode)
    except OSError:  # a full disk has no room for half a submission
        remove(folder)
        raise
    if groupshared:
        for directory in [folder.parent, folder, *(path for path in folder.rglob("*") if path.is_dir())]:
            with contextlib.suppress(PermissionError):
                directory.chmod((directory.stat().st_mode | 0o2770) & 0o2777)
    return folder


def publish(staged: Path, place: Path) -> None:
    """Put a staged folder into its place; what was there before is removed."""
    if place.exists() or place.is_symlink():
        old = place.with_name(f".{place.name}{MARK}{secrets.token_hex(8)}")
        os.rename(place, old)
        os.rename(staged, place)
        remove(old)
    else:
        os.rename(staged, place)


def withdraw(place: Path) -> None:
    """Remove what is in a place: it goes at once, however long that takes."""
    old = place.with_name(f".{place.name}{MARK}{secrets.token_hex(8)}")
    os.rename(place, old)
    remove(old)


def remove(folder: Path) -> None:
    """Remove a folder that we wrote, read-only files and folders included; of a link, the link."""
    if folder.is_symlink() or not folder.is_dir():
        folder.unlink(missing_ok=True)
        return
    for directory in (folder, *(path for path in folder.rglob("*") if path.is_dir() and not path.is_symlink())):
        with contextlib.suppress(PermissionError):
            directory.chmod(directory.stat().st_mode | stat.S_IRWXU)
    shutil.rmtree(folder)


def clear(place: Path) -> None:
    """Remove what a killed grader left beside a place; what the disk does not let go is in nobody's way until the next time."""
    for left in place.parent.glob(f".{place.name}{MARK}*") if place.parent.is_dir() else ():
        with contextlib.suppress(OSError):
            remove(left)
