"""Makes what people open: an instructor's course folder, its released assignments, a reader's workbook."""

from __future__ import annotations

import codecs
import contextlib
import hashlib
import json
import logging
import os
import re
import secrets
import shutil
import sysconfig
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import nbformat

from autograder import catalogue
from autograder.course import Course
from autograder.errors import CourseError, DirectrixError, SubmissionError
from autograder.notebook import source
from autograder.notebook.submission import parse
from autograder.sandbox import ahead, packages

CONFIG = '''"""An nbgrader course that Directrix grades. Everything that nbgrader's own documentation says holds here too."""

c = get_config()  # noqa: F821
c.CourseDirectory.course_id = {course_id!r}

from autograder import bridge  # noqa: E402

bridge.configure(c)  # the one line: submissions run in the sandbox, `check(...)` cells are judged outside it
'''

README = """# {course_id}

An nbgrader course. From this folder:

    directrix release A1     # source/A1 -> release/A1, what learners get
    directrix grade A1       # submitted/*/A1 -> gradebook.db and autograded/
    directrix feedback A1    # -> feedback/*/A1
    directrix lab            # JupyterLab with formgrader

An exercise of your own, in assignments/ (what comes of it: docs/authoring.md of Directrix):

    directrix new . --exercise barrel_roof
    directrix author check .

Learners' notebooks go to submitted/<student>/<assignment>/. The folder .directrix holds the course secret, from which
hidden grading data are drawn: it stays with the instructor, and so does source/.
"""


def new_course(folder: Path, names: tuple[str, ...] = ()) -> list[catalogue.Assignment]:
    """Make a course folder: configuration, secret, and the source notebooks of the named assignments (default: all).

    Raises
    ------
    CourseError
        If the folder exists and is not empty; nothing in it is touched. What is stopped in the middle leaves no half a course.
    """
    shipped = catalogue.shipped()
    chosen = [shipped.assignment(name) for name in dict.fromkeys(names)] or list(shipped.assignments)
    if folder.exists() and not folder.is_dir():
        raise CourseError(f"{folder} is a file; choose a new folder for the course")
    if folder.exists() and any(folder.iterdir()):
        raise CourseError(f"{folder} exists and is not empty; choose a new folder for the course")
    place = folder if folder.exists() else folder.with_name(f".directrix-{secrets.token_hex(8)}")
    try:
        place.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(folder)) from error
    try:
        _fill(place, folder.resolve().name, chosen)
        if place != folder:
            place.rename(folder)
    except BaseException:
        for part in list(place.iterdir()) if place == folder else [place]:
            shutil.rmtree(part, ignore_errors=True) if part.is_dir() else part.unlink()
        raise
    return chosen


def _fill(folder: Path, name: str, chosen: list[catalogue.Assignment]) -> None:
    """Write the files of a course into a folder."""
    course_id = "".join(letter if letter.isalnum() else "-" for letter in name) or "surfaces"
    (folder / "nbgrader_config.py").write_text(CONFIG.format(course_id=course_id), "utf-8")
    (folder / "README.md").write_text(README.format(course_id=course_id), "utf-8")
    private = folder / ".directrix"
    private.mkdir(mode=0o700)
    (private / "secret").touch(mode=0o600)
    (private / "secret").write_text(secrets.token_hex(32) + "\n", "ascii")
    for assignment in chosen:
        source.write(assignment, folder / "source" / assignment.name)


def release(course: Path, name: str, *, with_exercises: bool = False) -> Path:
    """Make the learners' version of an assignment with nbgrader itself, and enter its cells into the gradebook.

    An assignment of the course's own, ``assignments/NN-slug``, is built into ``source/`` first: its text is the master. With
    ``with_exercises`` its exercises are put beside the notebook, for ``check`` in the learners' own JupyterLab.

    Returns the folder ``release/NAME``; it and ``source/`` are where the course's settings have them. Raises CourseError with
    nbgrader's own words where it refuses.
    """
    from nbgrader.apps import NbGraderAPI  # slow to import, and only needed here

    if not (course / catalogue.CONFIG).is_file():
        raise CourseError(f"{course} is not a course: it has no nbgrader_config.py; make one with `directrix new FOLDER`")
    found, own = Course(course), _own_assignment(course, name)
    name = own.name if own is not None else name
    master, released = (_folder(course, found, step, name) for step in ("source", "release"))
    if own is not None:
        _build(own, master)
    if with_exercises and own is None:
        raise CourseError(
            f"{name} is no assignment of this course's own, so it has no exercises to release; take the option away"
        )
    if not master.is_dir():
        there = sorted(path.name for path in master.parent.glob("*") if path.is_dir())
        raise CourseError(f"no assignment {name!r} in {master.parent}; there are: {', '.join(there) or 'none'}")
    _readable(master)
    config: Any = found.config
    config.CourseDirectory.root = str(found.root)
    with _quiet("traitlets"), _tools_on_path():
        result = NbGraderAPI(config=config).generate_assignment(name, force=True, create=True)
    if not result["success"]:
        said = _said(result.get("log") or result.get("error") or "")
        if said.endswith("Canceled"):  # nbgrader's word for Ctrl-C
            raise KeyboardInterrupt
        raise CourseError(f"nbgrader could not release {name}: {said}")
    _keep_back(released, found.withhold)
    if own is not None and with_exercises:
        _put_beside(own, released / catalogue.BESIDE / own.folder.name)
    _expect_grading(found, name)
    return released


def _folder(course: Path, found: Course, step: str, name: str) -> Path:
    """The instructor's folder of a step, written from where the course was named."""
    return course / os.path.relpath(found.path(step, ".", name), found.folder)


def _keep_back(released: Path, modules: Sequence[str]) -> None:
    """Take out modules that learners may not import, which nbgrader released as it does every file."""
    there = {path.relative_to(released).as_posix(): b"" for path in released.rglob("*") if path.is_file()}
    for name in there.keys() - packages.without(there, modules).keys():
        (released / name).unlink()


def _expect_grading(course: Course, name: str) -> None:
    """Leave a note of the sandbox that grading it will need, most likely, so that the first run begins with that too."""
    with contextlib.suppress(DirectrixError, OSError):  # who grades is told; and without a note a run takes a little longer
        ahead.remember(ahead.note(course.room, name), course.likely_policy(name), "A")


def _readable(folder: Path) -> None:
    """Refuse what nbgrader cannot read, with the file and what to do: it names neither."""
    paths = sorted(folder.glob("*.ipynb"))
    if not paths:
        raise CourseError(f"no notebook lies in {folder}; put one there, a file whose name ends in .ipynb")
    for path in paths:
        data = path.read_bytes()
        if data.startswith((codecs.BOM_UTF8, codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            raise CourseError(f"{path} begins with a byte order mark, which nbgrader cannot read; save it as UTF-8 without one")
        try:
            parse(data)
        except SubmissionError as error:
            raise CourseError(f"{path} cannot be released: {error}") from None


def _said(log: str) -> str:
    """What nbgrader's log says was wrong: what was raised, without the lines of code it went through; else its errors."""
    raised = re.findall(r"^ {4}([\w.]+): (.*)$", log, re.MULTILINE)
    said = dict.fromkeys(text if kind == "autograder.errors.CourseError" else f"{kind.rpartition('.')[2]}: {text}"
                         for kind, text in raised)  # fmt: skip
    said = said or dict.fromkeys(re.findall(r"^\[(?:ERROR|WARNING)\] (.*)$", log, re.MULTILINE))
    return "; ".join(said) or log.strip()


def points_in(course: Path, name: str) -> float:
    """Points of all graded cells of an assignment in ``source/``, those that a person marks too."""
    notebooks = [_read(path) for path in (course / "source" / name).glob("*.ipynb")]
    graded = (cell.metadata.get("nbgrader", {}) for notebook in notebooks for cell in notebook.cells)
    return float(sum(about.get("points", 0) for about in graded if about.get("grade") or about.get("task")))


def unknown_to_learners(course: Path, released: Path) -> list[str]:
    """Exercises of a released assignment that ``check`` finds neither beside it nor installed."""
    own = _own_assignment(course, released.name)
    if own is None or (released / catalogue.BESIDE).is_dir():
        return []
    return [name for name in own.exercises if catalogue.installed().get(name) is None]


def _own_assignment(course: Path, name: str) -> catalogue.Assignment | None:
    """The course's own assignment of that name, number, slug or folder, if it is one."""
    if not catalogue.has_assignments(course):
        return None
    own = catalogue.load(course).assignments
    return next((one for one in own if name in (one.name, one.slug, one.folder.name)), None)


def _build(own: catalogue.Assignment, folder: Path) -> None:
    """Write the source notebook of an own assignment; one that was changed by hand since is not overwritten."""
    if not own.source.is_file():
        return  # posed in a notebook that the instructor keeps in source/ herself
    built = source.build(own)
    built.metadata["directrix"] = {"built": _digest(built)}
    path = folder / f"{own.slug}.ipynb"
    if path.exists():
        there = _read(path)
        if there.metadata.get("directrix", {}).get("built") != _digest(there):
            raise CourseError(
                f"{path} was changed since it was made from {own.source}; take the change over into "
                f"{own.source.name} and remove {path.name}, or, to go on with the notebook alone, remove {own.source.name}"
            )
    folder.mkdir(parents=True, exist_ok=True)
    path.write_text(source.dumps(built), "utf-8")


def _read(path: Path) -> Any:
    try:
        return nbformat.read(path, as_version=4)  # type: ignore[no-untyped-call]
    except Exception as error:
        raise CourseError(f"{path} is not a notebook that can be read ({error}); remove it and release again") from error


def _digest(notebook: Any) -> str:
    """Of what an author writes: kinds and texts of the cells. Outputs and a viewer's metadata do not count."""
    written = json.dumps([[cell.cell_type, cell.source] for cell in notebook.cells])
    return hashlib.sha256(written.encode()).hexdigest()


def _put_beside(own: catalogue.Assignment, place: Path) -> None:
    """Copy the exercises, and only them: the notebook source holds the solutions."""
    shutil.rmtree(place.parent, ignore_errors=True)
    place.mkdir(parents=True)
    for path in own.folder.iterdir():
        if path.name == "exercises.py":
            shutil.copyfile(path, place / path.name)
        elif path.name == "exercises" and path.is_dir():
            shutil.copytree(path, place / path.name, ignore=shutil.ignore_patterns("__pycache__", "*.pyc"))


def workbook(folder: Path) -> list[Path]:
    """Put the released notebooks and the walkthroughs into a folder for a reader; what is there already is kept.

    Returns the files that were written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for path, notebook in _pages():
        target = folder / path
        if not target.exists():
            target.parent.mkdir(parents=True, exist_ok=True)
            nbformat.write(notebook, target)  # type: ignore[no-untyped-call]
            written.append(target)
    return written


def _pages() -> Iterator[tuple[str, Any]]:
    for assignment in catalogue.shipped().assignments:
        yield f"{assignment.name}/{assignment.slug}.ipynb", source.release(source.build(assignment, solutions=False))
    for chapter in source.chapters():
        yield f"course/{chapter.stem}.ipynb", source.build_chapter(chapter)


def remove_course(folder: Path) -> None:
    """Remove a course made by :func:`new_course`, and nothing that does not look like one."""
    if not (folder / "nbgrader_config.py").is_file() or not (folder / ".directrix").is_dir():
        raise CourseError(f"{folder} was not made by directrix; remove it yourself or choose another folder")
    for path in folder.rglob("*"):
        if path.is_dir() and not path.is_symlink():
            path.chmod(0o700)  # nbgrader leaves graded folders read-only
    shutil.rmtree(folder)


@contextlib.contextmanager
def _tools_on_path() -> Iterator[None]:
    """nbgrader starts `alembic` by name: let it find the one beside our interpreter, in an environment not activated too."""
    before = os.environ.get("PATH", os.defpath)
    os.environ["PATH"] = os.pathsep.join([sysconfig.get_path("scripts"), before])
    try:
        yield
    finally:
        os.environ["PATH"] = before


@contextlib.contextmanager
def _quiet(name: str) -> Iterator[None]:
    logger = logging.getLogger(name)
    level = logger.level
    logger.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logger.setLevel(level)
