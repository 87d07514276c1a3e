"""Takes what a learning platform exports, one zip archive for a class, into ``submitted/``.

    ada/known-forms.ipynb                                     a folder for each student (ILIAS, and by hand)
    Ada Lovelace_4711_assignsubmission_file_/known-forms.ipynb      Moodle: the number is the student's, with folders
    Ada Lovelace_4711_assignsubmission_file_known-forms.ipynb       or without
    lovelaceada_4711_90210_known-forms.ipynb                        Canvas: the first number is the student's
    ada.zip, ada/work.zip                                     what learners zipped themselves, one level deep

One folder around all students is no student's. A regular expression with a group ``student`` (and ``file``, for archives
without folders) reads other names. Nothing is written outside ``submitted/<student>/<assignment>``, each of which is put into
place whole; whatever is not taken is named.
"""

from __future__ import annotations

import re
import zipfile
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from autograder.course import Course
from autograder.errors import CourseError, SubmissionError
from autograder.fleet import publish
from autograder.notebook import archive
from autograder.notebook.archive import Unpacked
from autograder.notebook.submission import NO_ID, PLAIN_ID, Bounds, beside
from autograder.sandbox.session import plain_name

FOLDERS = re.compile(r".+_(?P<student>\d+)_assignsubmission_\w+?_?$")
FLAT = re.compile(r".+_(?P<student>\d+)_assignsubmission_[a-z]+_(?P<file>.+)$")
FILES = re.compile(r"[^_]+_(?:LATE_)?(?P<student>\d+)_\d+_(?P<file>.+)$")
AGAIN = re.compile(r"-\d+(?=\.ipynb$)")  # Canvas numbers what is handed in again
CLASS = Bounds(entries=100_000)
MOST_LISTED = 64_000_000  # bytes of the list of members of a class's archive


@dataclass(frozen=True)
class Taken:
    """What became of one student's part of an archive. ``placed`` is false if nothing of it was put into ``submitted/``."""

    student: str
    files: tuple[str, ...] = ()
    refused: dict[str, str] = field(default_factory=dict)
    placed: bool = True


def collect(
    course: Course, path: Path, assignment: str, *, pattern: str | None = None, force: bool = False
) -> tuple[Taken, ...]:
    """Put what an archive holds into ``submitted/``; what was not taken, and why, by student.

    Parameters
    ----------
    pattern : str, optional
        Regular expression for names in the archive's first level, with a group ``student``, and ``file`` where names of files
        tell whose they are. Default: the forms above.
    force : bool
        Replace what these students have handed in before.

    Raises
    ------
    CourseError
        If there is no such assignment, the archive cannot be read, or the pattern has no group ``student``.
    """
    rules = _rules(pattern)
    with course.gradebook() as book:
        notebooks = set(book.assignment(assignment).notebooks)
    parts: dict[str, Unpacked] = {}
    strangers = Unpacked()
    try:
        with path.open("rb") as file:
            if (listed := archive.announced(file)) > MOST_LISTED:
                raise SubmissionError(f"its list of members takes {listed} bytes; at most {MOST_LISTED} are read")
            with archive.opened(file) as opened:
                _sort(opened, rules, notebooks, course, parts, strangers)
    except OSError as error:
        raise CourseError(f"{path}: {error.strerror or error}") from None
    except SubmissionError as error:
        raise CourseError(f"{path}: {error}") from None
    taken = [_place(course, student, assignment, part, force=force) for student, part in sorted(parts.items())]
    if strangers.refused:
        taken.append(Taken("", refused=strangers.refused, placed=False))
    return tuple(taken)


def to_dict(taken: Sequence[Taken]) -> list[dict[str, Any]]:
    """Plain data."""
    return [asdict(one) for one in taken]


def _rules(pattern: str | None) -> tuple[re.Pattern[str], ...]:
    if pattern is None:
        return FOLDERS, FLAT, FILES
    try:
        compiled = re.compile(pattern)
    except re.error as error:
        raise CourseError(f"the pattern is no regular expression: {error}") from None
    if "student" not in compiled.groupindex:
        raise CourseError(f"the pattern must have a group (?P<student>...); got {pattern!r}")
    return (compiled,)


def _sort(
    opened: zipfile.ZipFile,
    rules: Sequence[re.Pattern[str]],
    notebooks: set[str],
    course: Course,
    parts: dict[str, Unpacked],
    strangers: Unpacked,
) -> None:
    """Whose each member is, read within the bounds of that student's submission."""
    if len(opened.infolist()) > CLASS.entries:
        raise SubmissionError(f"it has more than {CLASS.entries} members")
    refused: dict[str, str] = {}
    chosen: dict[str, list[tuple[str, zipfile.ZipInfo]]] = {}
    members = list(archive.members(opened, refused, course.ignore))
    around = _around([path for path, _ in members], rules, notebooks)
    for path, info in members:
        student, inner = _whose(path.removeprefix(around), rules, notebooks)
        if student:
            chosen.setdefault(student, []).append((inner, info))
        else:
            strangers.refused[path] = "its name does not say whose it is"
    for path, reason in refused.items():
        student, inner = _whose(path.removeprefix(around), rules, notebooks)
        part = parts.setdefault(student, Unpacked()) if student in chosen else strangers
        part.refused[inner if student in chosen else path] = reason
    for student, listed in chosen.items():
        part = parts.setdefault(student, Unpacked())
        archive.take(opened, listed, part, course.bounds)
        _inner(part, course)


def _around(paths: Sequence[str], rules: Sequence[re.Pattern[str]], notebooks: set[str]) -> str:
    """The folder around all students, ``export/``; empty if there is none, or if it may be a student's own.

    It is no student's if all that lies in it is named as a platform names it, or one notebook is in several of its folders.
    """
    tops = {path.partition("/")[0] for path in paths if "/" in path}
    if len(tops) != 1 or not all("/" in path for path in paths) or any(rule.search(top) for rule in rules for top in tops):
        return ""
    inside = [path.split("/")[1:] for path in paths]
    named = all(any(rule.search(parts[0]) for rule in rules) for parts in inside)
    holders = [(parts[-1], parts[0]) for parts in inside if len(parts) > 1 and parts[-1][:-6] in notebooks]
    several = len(set(holders)) > len({notebook for notebook, _ in holders})
    return f"{tops.pop()}/" if named or several else ""


def _whose(path: str, rules: Sequence[re.Pattern[str]], notebooks: set[str]) -> tuple[str, str]:
    """Student and path in the submission, from a path in the archive; no student where it does not say."""
    first, _, rest = path.partition("/")
    for rule in rules:
        match = rule.search(first)
        if match is None:
            continue
        named = match.groupdict().get("file")
        if bool(rest) == (named is not None) and not (rest == "" and named is None and first.endswith(".zip")):
            continue
        if named is None:
            return match["student"], rest or first
        plain = AGAIN.sub("", named)
        return match["student"], plain if named[:-6] not in notebooks and plain[:-6] in notebooks else named
    if rest:
        return first, rest
    return (first[:-4], first) if first.endswith(".zip") else ("", path)


def _inner(part: Unpacked, course: Course) -> None:
    """Replace a student's archives by what is in them, and leave out a folder that is around everything."""
    for name in [name for name in part.files if name.lower().endswith(".zip")]:
        data = part.files.pop(name)
        try:
            bounds = course.bounds
            total = bounds.total - sum(map(len, part.files.values())) - part.wasted
            inside = archive.read(
                data, ignore=course.ignore, bounds=Bounds(bounds.notebook, bounds.file, total, bounds.entries)
            )
            part.wasted += inside.wasted
        except SubmissionError as error:
            part.refused[name] = str(error)
            continue
        part.refused |= {f"{name}: {path}": reason for path, reason in inside.refused.items()}
        for path, content in _bare(inside.files).items():
            if path.lower().endswith(".zip"):
                part.refused[f"{name}: {path}"] = "it is an archive in an archive"
            elif path in part.files or path not in beside({path: content}, part.files):
                part.refused[f"{name}: {path}"] = "a file of this name lies beside the archive"
            else:
                part.files[path] = content
    part.files = _bare(part.files)


def _bare(files: dict[str, bytes]) -> dict[str, bytes]:
    """Without the one folder that is around all of it."""
    around = {path.partition("/")[0] for path in files}
    if len(around) != 1 or not all("/" in path for path in files):
        return files
    return {path.partition("/")[2]: data for path, data in files.items()}


def _place(course: Course, student: str, assignment: str, part: Unpacked, *, force: bool) -> Taken:
    """Put one student's files into place, whole or not at all."""
    place = course.path("submitted", student, assignment)
    reason = ""
    if not PLAIN_ID.fullmatch(student) or not plain_name(student) or student.startswith("."):
        reason = f"the name {NO_ID}"
    elif not part.files:
        reason = "there is nothing in it that can be taken"
    elif place.parent.is_symlink() or course.path("submitted", "x", assignment).parent.parent.is_symlink():
        reason = "the student's folder is a link to another folder"
    elif place.exists() and not force:
        reason = "there is a submission already; --force replaces it"
    if reason:
        return Taken(student, (), {**part.refused, "": reason}, placed=False)
    try:
        publish.publish(publish.stage(place, part.files, mode=0o644, groupshared=course.groupshared), place)
    except OSError as error:
        return Taken(student, (), {**part.refused, "": f"it cannot be written ({error.strerror})"}, placed=False)
    return Taken(student, tuple(sorted(part.files)), part.refused)
