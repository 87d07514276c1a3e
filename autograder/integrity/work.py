"""What each student wrote: the code cells of a submission that are not the instructor's, read as bytes and never run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from autograder.course import Course
from autograder.errors import CourseError, SubmissionError
from autograder.notebook import safe
from autograder.notebook.submission import parse, read_file, read_folder

MOST_CODE = 100_000  # characters of code that are compared in one submission; a learner writes a few thousand
BEGINNING = "(before the first task)"


@dataclass(frozen=True)
class Part:
    """One code cell of a student: the task that it answers (or follows), its place among the cells from 1, its text."""

    notebook: str
    exercise: str
    cell: int
    source: str


@dataclass
class Class:
    """What a class wrote, and which texts belong to nobody: the released cells and the instructor's own solution."""

    parts: dict[str, list[Part]] = field(default_factory=dict)
    given: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class _Handed:
    """The instructor's cells: texts, names of the cells that are put back as they were, names of those that learners fill."""

    texts: list[str]
    locked: frozenset[str]
    tasks: frozenset[str]


def read(course: Course, assignment: str) -> Class:
    """Read all submissions of an assignment. Nothing in the course is changed.

    Raises
    ------
    CourseError
        If there is no instructor's notebook to tell released code by, or nobody has handed in.
    """
    handed = _handed(course, assignment)
    found = Class(given=handed.texts)
    submissions = course.submissions(assignment)
    if not submissions:
        raise CourseError(f"nobody has handed in {assignment}; submissions lie in {course.path('submitted', '*', assignment)}")
    for student, folder in submissions.items():
        try:
            notebooks = read_folder(folder, ignore=course.ignore, bounds=course.bounds).notebooks
        except SubmissionError as error:
            found.notes.append(f"{student}: {error}")
            continue
        parts: list[Part] = []
        unread = 0
        for name, data in sorted(notebooks.items()):
            try:
                parts += _parts(name, parse(data), handed)
            except SubmissionError as error:
                found.notes.append(f"{student}, {name}: {error}")
                unread += 1
        if not notebooks:
            found.notes.append(f"{student}: there is no notebook")
        elif unread < len(notebooks):
            found.parts[student] = _bounded(parts, student, found.notes)
    return found


def _handed(course: Course, assignment: str) -> _Handed:
    texts: list[str] = []
    locked: set[str] = set()
    tasks: set[str] = set()
    for step in ("release", "source"):
        for path in sorted(course.path(step, ".", assignment).glob("*.ipynb")):
            try:
                cells = list(_code(parse(read_file(path, course.bounds.notebook))))
            except SubmissionError as error:
                raise CourseError(f"{path} cannot be read: {error}") from None
            for _, source, about in cells:
                texts.append(source)
                if name := about.get("grade_id"):
                    (tasks if about.get("solution") else locked).add(str(name))
    if not texts:
        place = course.path("release", ".", assignment)
        raise CourseError(f"no notebook in {place} nor in source/: without what was handed out, all work would look alike")
    return _Handed(texts, frozenset(locked), frozenset(tasks))


def _parts(notebook: str, content: Mapping[str, Any], handed: _Handed) -> Iterator[Part]:
    exercise = BEGINNING
    given = set(handed.texts)
    for number, source, about in _code(content):
        name = about.get("grade_id")
        if isinstance(name, str) and name in handed.tasks:
            exercise = name
        if not (isinstance(name, str) and name in handed.locked) and source not in given and source.strip():
            yield Part(notebook, exercise, number, source)


def _code(content: Mapping[str, Any]) -> Iterator[tuple[int, str, Mapping[str, Any]]]:
    """Place, text and nbgrader's metadata of each code cell, whatever the rest of the notebook is."""
    for number, cell in enumerate(content["cells"], 1):
        if isinstance(cell, Mapping) and cell.get("cell_type") == "code":
            metadata = cell.get("metadata")
            about = metadata.get("nbgrader") if isinstance(metadata, Mapping) else None
            yield number, safe.text(cell.get("source")), about if isinstance(about, Mapping) else {}


def _bounded(parts: list[Part], student: str, notes: list[str]) -> list[Part]:
    kept: list[Part] = []
    left = MOST_CODE
    for part in parts:
        if part.source and len(part.source) <= left:
            kept.append(part)
            left -= len(part.source)
    if len(kept) < len(parts):
        notes.append(f"{student}: more than {MOST_CODE} characters of code; {len(parts) - len(kept)} cells are not compared")
    return kept
