"""Makes what people open: an instructor's course folder, its released assignments, a reader's workbook."""

from __future__ import annotations

import logging
import os
import secrets
import shutil
import sysconfig
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import nbformat

from autograder import catalogue
from autograder.errors import CourseError
from autograder.notebook import source

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

Learners' notebooks go to submitted/<student>/<assignment>/. The folder .directrix holds the course secret, from which
hidden grading data are drawn: it stays with the instructor, and so does source/.
"""


def new_course(folder: Path, names: tuple[str, ...] = ()) -> list[catalogue.Assignment]:
    """Make a course folder: configuration, secret, and the source notebooks of the named assignments (default: all).

    Raises
    ------
    CourseError
        If the folder exists and is not empty; nothing in it is touched.
    """
    shipped = catalogue.shipped()
    chosen = [shipped.assignment(name) for name in names] or list(shipped.assignments)
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise CourseError(f"{folder} exists and is not empty; choose a new folder for the course")
    folder.mkdir(parents=True, exist_ok=True)
    course_id = "".join(letter if letter.isalnum() else "-" for letter in folder.resolve().name) or "surfaces"
    (folder / "nbgrader_config.py").write_text(CONFIG.format(course_id=course_id), "utf-8")
    (folder / "README.md").write_text(README.format(course_id=course_id), "utf-8")
    private = folder / ".directrix"
    private.mkdir(mode=0o700)
    (private / "secret").touch(mode=0o600)
    (private / "secret").write_text(secrets.token_hex(32) + "\n", "ascii")
    for assignment in chosen:
        source.write(assignment, folder / "source" / assignment.name)
    return chosen


def release(course: Path, name: str) -> Path:
    """Make the learners' version of an assignment with nbgrader itself, and enter its cells into the gradebook.

    Returns the folder ``release/NAME``. Raises CourseError with nbgrader's own words where it refuses.
    """
    from nbgrader.apps import NbGraderAPI  # slow to import, and only needed here
    from traitlets.config.loader import PyFileConfigLoader

    if not (course / "nbgrader_config.py").is_file():
        raise CourseError(f"{course} is not a course: it has no nbgrader_config.py; make one with `directrix new FOLDER`")
    if not (course / "source" / name).is_dir():
        there = sorted(path.name for path in (course / "source").glob("*") if path.is_dir())
        raise CourseError(f"no assignment {name!r} in {course / 'source'}; there are: {', '.join(there) or 'none'}")
    config: Any = PyFileConfigLoader("nbgrader_config.py", path=str(course)).load_config()
    config.CourseDirectory.root = str(course.resolve())
    with _quiet("traitlets"), _tools_on_path():
        result = NbGraderAPI(config=config).generate_assignment(name, force=True, create=True)
    if not result["success"]:
        raise CourseError(f"nbgrader could not release {name}:\n{(result.get('log') or result.get('error') or '').strip()}")
    return course / "release" / name


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


@contextmanager
def _tools_on_path() -> Iterator[None]:
    """nbgrader starts `alembic` by name: let it find the one beside our interpreter, in an environment not activated too."""
    before = os.environ.get("PATH", os.defpath)
    os.environ["PATH"] = os.pathsep.join([sysconfig.get_path("scripts"), before])
    try:
        yield
    finally:
        os.environ["PATH"] = before


@contextmanager
def _quiet(name: str) -> Iterator[None]:
    logger = logging.getLogger(name)
    level = logger.level
    logger.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logger.setLevel(level)
