"""When a submission was handed in: ``timestamp.txt``, read as nbgrader reads it."""

from __future__ import annotations

import datetime
from collections.abc import Mapping

from dateutil import parser, tz  # type: ignore[import-untyped]

from autograder.errors import SubmissionError

FILE = "timestamp.txt"


def handed_in(files: Mapping[str, bytes]) -> datetime.datetime | None:
    """The time in UTC, None without a file or with an empty one.

    Raises
    ------
    SubmissionError
        If the file holds something else: grading on would forget that it may be late.
    """
    raw = files.get(FILE, b"")[:200].decode("utf-8", "replace").strip()
    if not raw:
        return None
    try:
        return parse_utc(raw)
    except (ValueError, OverflowError):
        raise SubmissionError(f"timestamp.txt holds no date: {raw[:60]!r}") from None


def parse_utc(text: str) -> datetime.datetime:
    """A date as nbgrader writes it ("2027-02-03 15:00:00.000000 UTC", also with +0100 or a zone's name), in UTC."""
    when: datetime.datetime
    parts = text.split(" ")
    if len(parts) == 3:
        try:
            zone: object = int(parts[2])
        except ValueError:
            zone = tz.gettz(parts[2])
        when = parser.parse(" ".join([*parts[:2], "TZ"]), tzinfos={"TZ": zone})
    else:
        when = parser.parse(text)
    offset = when.utcoffset()
    return when if offset is None else (when - offset).replace(tzinfo=None)
