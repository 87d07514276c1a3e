"""Finds exercises: in an assignment folder, in a course folder, in an installed package, or in the set that is shipped.

An exercise that an instructor wrote is found by ``check`` in these places, the first that knows its name decides:

1. the course that a notebook lies in (the instructor's own JupyterLab), or the folder ``directrix-exercises`` beside it, which
   ``directrix release --with-exercises`` puts there;
2. the folders that the environment variable ``DIRECTRIX_EXERCISES`` names;
3. installed packages that declare an entry point of the group ``directrix.exercises``;
4. the set that comes with directrix.

The grader looks into the course folder, then into 2 to 4. This is the only place that imports an assignment.
"""

from __future__ import annotations

import functools
import importlib.metadata
import importlib.util
import os
import re
import sys
import traceback
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

from autograder.errors import CourseError, ExerciseError
from autograder.exercise import Exercise

BESIDE = "directrix-exercises"
VARIABLE = "DIRECTRIX_EXERCISES"
GROUP = "directrix.exercises"
CONFIG = "nbgrader_config.py"
WRITTEN = "__directrix_written__"  # when the files of a loaded assignment were written
SLUG = re.compile(r"(?P<number>\d\d)-(?P<slug>[a-z0-9][a-z0-9-]*)")


@dataclass(frozen=True)
class Assignment:
    """A folder ``NN-slug`` with its exercises and, where it has one, its notebook source."""

    folder: Path
    exercises: dict[str, Exercise]

    @property
    def name(self) -> str:
        """What nbgrader calls it: ``A1`` for the folder ``01-known-forms``."""
        return f"A{int(self.folder.name[:2])}"

    @property
    def slug(self) -> str:
        """``known-forms``; also the name of its notebook."""
        return self.folder.name[3:]

    @property
    def source(self) -> Path:
        """The notebook as text (py:percent)."""
        return self.folder / "notebook.py"

    @property
    def points(self) -> float:
        """Points of all its exercises."""
        return sum(exercise.points for exercise in self.exercises.values())


@dataclass(frozen=True)
class Catalogue:
    """Assignments in the order of their numbers. Exercise ids are unique in it."""

    assignments: tuple[Assignment, ...]

    def __iter__(self) -> Iterator[Exercise]:
        for assignment in self.assignments:
            yield from assignment.exercises.values()

    def get(self, id: str) -> Exercise | None:
        """The exercise of that id, or None."""
        return next((assignment.exercises[id] for assignment in self.assignments if id in assignment.exercises), None)

    def find(self, id: str) -> Exercise:
        """The exercise of that id.

        Raises
        ------
        ExerciseError
            If there is none; the message names those there are.
        """
        found = self.get(id)
        if found is None:
            raise ExerciseError(f"no exercise is called {id!r}; there are: {', '.join(exercise.id for exercise in self)}")
        return found

    def before(self, other: Catalogue) -> Catalogue:
        """Both together; where two have the same id, the one of this catalogue is meant."""
        return Catalogue((*self.assignments, *other.assignments))

    def assignment(self, name: str) -> Assignment:
        """The assignment called ``A1``, ``01-known-forms`` or ``known-forms``."""
        for assignment in self.assignments:
            if name in (assignment.name, assignment.slug, assignment.folder.name):
                return assignment
        raise CourseError(f"no assignment is called {name!r}; there are: {', '.join(a.name for a in self.assignments)}")


@functools.cache
def shipped() -> Catalogue:
    """The assignments that come with the package, in a checkout and in an installed wheel alike."""
    return load(shipped_room("assignments"))


def installed() -> Catalogue:
    """The shipped set and before it what this machine adds: the folders of ``DIRECTRIX_EXERCISES``, and installed packages.

    Raises
    ------
    CourseError
        If what the variable or a package names is no folder of exercises.
    """
    return _installed(os.environ.get(VARIABLE, ""))


@functools.cache
def _installed(variable: str) -> Catalogue:
    named = [Path(place) for place in variable.split(os.pathsep) if place]
    packages = sorted(importlib.metadata.entry_points(group=GROUP), key=lambda entry: entry.name)
    found = Catalogue(())
    for folder in [*named, *map(_package_folder, packages)]:
        found = found.before(load(folder))
    return found.before(shipped())


def _package_folder(entry: importlib.metadata.EntryPoint) -> Path:
    """The folder of the package that an entry point names; nothing of the package is run for it."""
    spec = importlib.util.find_spec(entry.module)
    places = spec.submodule_search_locations if spec is not None else None
    if not places:
        raise CourseError(
            f"the entry point {entry.name} = {entry.value!r} of the group {GROUP} must name a package (a folder with NN-slug/"
            "exercises.py in it); mend it in that package's pyproject.toml, or uninstall that package"
        )
    return Path(next(iter(places)))


def around(place: Path) -> Catalogue:
    """What ``check`` knows in a notebook in this folder: the exercises of its course or beside it, then the installed.

    Folders are looked at only as far as they belong to whoever runs this: exercises are code, and nobody else's is run.
    """
    own = _own_folder(place.resolve())
    return load(own).before(installed()) if own is not None else installed()


def _own_folder(place: Path) -> Path | None:
    if (place / BESIDE).is_dir() and _ours(place / BESIDE):
        return place / BESIDE
    for folder in (place, *place.parents):
        if not _ours(folder):
            return None
        if (folder / CONFIG).is_file():
            return folder if has_assignments(folder) else None
    return None


def _ours(folder: Path) -> bool:
    return not hasattr(os, "geteuid") or folder.stat().st_uid == os.geteuid()


def has_assignments(folder: Path) -> bool:
    """Whether :func:`load` finds an assignment there."""
    return bool(_assignment_folders(folder))


def shipped_room(room: str) -> Path:
    """The folder ``assignments`` or ``course`` of this installation."""
    here = Path(__file__).resolve().parent
    for place in (here / "shipped" / room, here.parent / room):
        if place.is_dir():
            return place
    raise CourseError(f"the folder {room!r} is missing from this installation; install directrix again")


def load(folder: Path | str) -> Catalogue:
    """Exercises of an assignment folder, of a course folder (its ``assignments/``), or of a folder of assignments.

    Raises
    ------
    CourseError
        If there is no such folder, it holds no ``exercises.py``, or two assignments claim one exercise id.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise CourseError(f"no such folder: {folder}")
    found = _assignment_folders(folder)
    if not found:
        raise CourseError(f"no assignment in {folder}: wanted NN-slug/exercises.py, here or in {folder / 'assignments'}")
    assignments = tuple(load_assignment(place) for place in found)
    seen: dict[str, Assignment] = {}
    for assignment in assignments:
        for id in assignment.exercises:
            if id in seen:
                raise CourseError(f"exercise {id!r} is in {seen[id].folder.name} and in {assignment.folder.name}; rename one")
            seen[id] = assignment
    return Catalogue(assignments)


def _assignment_folders(folder: Path) -> list[Path]:
    """The folders NN-slug with exercises: this one itself, else those in it, else those in its ``assignments/``."""
    for room in ([folder], sorted(folder.iterdir()), sorted(folder.glob("assignments/*"))):
        found = [place for place in room if SLUG.fullmatch(place.name) and _entry(place) is not None]
        if found:
            return found
    return []


def load_assignment(folder: Path) -> Assignment:
    """Import ``exercises.py`` (or the package ``exercises/``) of one assignment folder and gather its exercises in order."""
    entry = _entry(folder)
    if entry is None:
        raise CourseError(f"{folder} has no exercises.py")
    module = _import(entry, f"directrix_assignments_{re.sub('[^a-z0-9]', '_', str(folder.resolve()))}")
    exercises = {value.id: value for value in vars(module).values() if isinstance(value, Exercise)}
    if not exercises:
        raise CourseError(f"{entry} declares no exercise; decorate a function with @exercise(...)")
    return Assignment(folder, exercises)


def _entry(folder: Path) -> Path | None:
    return next((path for path in (folder / "exercises.py", folder / "exercises" / "__init__.py") if path.is_file()), None)


def _import(entry: Path, name: str) -> ModuleType:
    written = [(path.name, path.stat().st_mtime_ns, path.stat().st_size) for path in sorted(entry.parent.glob("*.py"))]
    if name in sys.modules and getattr(sys.modules[name], WRITTEN) == written:
        return sys.modules[name]
    _forget(name)  # an author changes a file and runs the same cell again
    package = [str(entry.parent)] if entry.name == "__init__.py" else None
    spec = importlib.util.spec_from_file_location(name, entry, submodule_search_locations=package)
    if spec is None or spec.loader is None:
        raise CourseError(f"{entry} cannot be imported")
    module = importlib.util.module_from_spec(spec)
    setattr(module, WRITTEN, written)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except BaseException as error:
        _forget(name)
        if not isinstance(error, Exception):
            raise
        raise CourseError(f"{_line(error, entry)}: {type(error).__name__}: {error}") from error
    return module


def _forget(name: str) -> None:
    for known in [key for key in sys.modules if key == name or key.startswith(f"{name}.")]:
        del sys.modules[known]


def _line(error: Exception, entry: Path) -> str:
    """``exercises.py:12``: the innermost line of the assignment's own files that an error comes from."""
    if isinstance(error, SyntaxError) and error.filename:
        return f"{error.filename}:{error.lineno}"
    here = entry.parent.absolute()  # as modules name their files, wherever the folder was named from
    frames = [f for f in traceback.extract_tb(error.__traceback__) if Path(f.filename).is_relative_to(here)]
    return f"{frames[-1].filename}:{frames[-1].lineno}" if frames else str(entry)
