"""A new exercise to start from: it runs, it keeps every rule, and each line is there to be changed.

An assignment folder ``NN-slug`` gets ``exercises.py`` and ``notebook.py``; one that has them already gets the new exercise at
their ends. Nothing that is there is changed.
"""

from __future__ import annotations

import keyword
import re
from importlib.resources import files
from pathlib import Path

from autograder import catalogue
from autograder.errors import CourseError
from autograder.exercise import Kind

KINDS: tuple[Kind, ...] = ("surface", "curve", "value")


def new_exercise(place: Path, name: str, kind: str = "surface", points: float = 5) -> Path:
    """Write a new exercise.

    Parameters
    ----------
    place : path
        An assignment folder ``NN-slug``, there or not yet; or a course folder, which gets the next assignment.
    name : str
        The function that learners write.
    kind : {"surface", "curve", "value"}
        What it answers; other kinds start from the nearest of these.
    points : float
        Points of its graded cell.

    Returns
    -------
    Path
        The assignment folder.

    Raises
    ------
    CourseError
        If the name cannot be an exercise, is taken, or there is no place for it. Nothing is written then.
    """
    _check(name, kind, points)
    folder = _assignment(place, name)
    entry, notebook = folder / "exercises.py", folder / "notebook.py"
    if (folder / "exercises").is_dir():
        raise CourseError(f"{folder} keeps its exercises in a package, exercises/; add the new one there by hand")
    if taken := _taken(folder, name):
        raise CourseError(f"{taken} has an exercise {name!r} already; choose another name")
    words = {"NAME": name, "POINTS": f"{points:g}", "TITLE": _title(name), "ASSIGNMENT": _title(folder.name[3:])}
    folder.mkdir(parents=True, exist_ok=True)
    for path, start in ((entry, "exercises"), (notebook, "notebook")):
        text = path.read_text("utf-8").rstrip("\n") if path.exists() else _filled(f"{start}_begin.txt", words)
        path.write_text(f"{text}\n\n{_filled(f'{start}_{kind}.txt', words)}\n", "utf-8")
    return folder


def _check(name: str, kind: str, points: float) -> None:
    if not re.fullmatch(r"[a-z][a-z0-9_]*", name) or keyword.iskeyword(name) or name == "check":
        raise CourseError(
            f"an exercise is called as its function: small letters, digits and underscores, as in 'ruled_roof'; got {name!r}"
        )
    if kind not in KINDS:
        raise CourseError(
            f"there are templates for {', '.join(KINDS)}; got {kind!r}. Start from the nearest, then change kind="
        )
    if not points > 0:
        raise CourseError(f"points must be above 0; got {points:g}")


def _assignment(place: Path, name: str) -> Path:
    """The assignment folder that is meant."""
    if catalogue.SLUG.fullmatch(place.resolve().name):
        return place
    if not (place / catalogue.CONFIG).is_file():
        raise CourseError(
            f"{place} is neither a course (it has no {catalogue.CONFIG}) nor an assignment folder such as 20-roofs; "
            "go to the course, name it, or make one with `directrix new FOLDER`"
        )
    return place / "assignments" / f"{_next(place):02d}-{name.replace('_', '-')}"


def _next(course: Path) -> int:
    """The first number above those of the course and of the shipped assignments."""
    own = [path.name[:2] for path in (course / "assignments").glob("*") if catalogue.SLUG.fullmatch(path.name)]
    made = [path.name[1:] for path in (course / "source").glob("A*") if path.name[1:].isdigit()]
    return max(map(int, [*own, *made, *(a.folder.name[:2] for a in catalogue.shipped().assignments)]), default=0) + 1


def _taken(folder: Path, name: str) -> str | None:
    """Where an exercise of that name is: in this assignment, in the others of its course, or in the shipped set."""
    known = catalogue.shipped()
    course = folder.resolve().parent
    for place in (folder, course):
        if place.is_dir() and catalogue.has_assignments(place):
            known = catalogue.load(place).before(known)
    return next((a.folder.name for a in known.assignments if name in a.exercises), None)


def _title(name: str) -> str:
    return name.replace("_", " ").replace("-", " ").capitalize()


def _filled(file: str, words: dict[str, str]) -> str:
    text = files("autograder.authoring").joinpath("templates", file).read_text("utf-8").rstrip("\n")
    for word, meant in words.items():
        text = text.replace(word, meant)
    return text
