"""When a submission was handed in: ``timestamp.txt``, read as nbgrader reads it, but for one slip.

nbgrader takes the zone of "13:00:00 +0100" for 100 seconds. Here it is one hour.
"""

from __future__ import annotations

import datetime
import re
from collections.abc import Mapping

from dateutil import parser, tz  # type: ignore[import-untyped]

from autograder.errors import SubmissionError

FILE = "timestamp.txt"
FIRST_YEAR, LAST_YEAR = 1970, 9000  # formgrader cannot show every time zone's time at the ends of the calendar
_OFFSET = re.compile(r"([+-])(\d\d):?(\d\d)")
_ZONE = re.compile(r"[A-Za-z][A-Za-z0-9_+-]*(/[A-Za-z0-9_+-]+)*")


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
        when = parse_utc(raw)
        if not FIRST_YEAR <= when.year <= LAST_YEAR:
            raise ValueError("nobody handed anything in then")
        return when
    except Exception:  # dateutil raises what its arithmetic raises
        raise SubmissionError(f"timestamp.txt holds no date: {raw[:60]!r}") from None


def parse_utc(text: str) -> datetime.datetime:
    """A date as nbgrader writes it ("2027-02-03 15:00:00.000000 UTC", also with +0100 or a zone's name), in UTC."""
    when: datetime.datetime
    parts = text.split(" ")
    if len(parts) == 3:
        numeric = _OFFSET.fullmatch(parts[2])
        if numeric is None and not _ZONE.fullmatch(parts[2]):
            raise ValueError("no name of a time zone")  # dateutil takes it for the path of a file
        zone = int(f"{numeric[1]}1") * 60 * (60 * int(numeric[2]) + int(numeric[3])) if numeric else tz.gettz(parts[2])
        when = parser.parse(" ".join([*parts[:2], "TZ"]), tzinfos={"TZ": zone})
    else:
        when = parser.parse(text)
    offset = when.utcoffset()
    return when if offset is None else (when - offset).replace(tzinfo=None)
