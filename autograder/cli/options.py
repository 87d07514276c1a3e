"""Options that several verbs share."""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console

from autograder.errors import CourseError

if TYPE_CHECKING:
    from autograder.course import Course

CourseOption = Annotated[Path, typer.Option("--course", help="The course folder.", show_default="this folder")]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON document, and what is meant for people on stderr.")]


def _offered(level: str) -> str:
    """The level, where notebooks are run at it: said at once, also where there is nothing to run."""
    if level not in ("", "A", "A-"):
        raise typer.BadParameter(
            f"notebooks are run at level A or A- only; got {level!r}. `directrix doctor` says which you have"
        )
    return level


GradingLevel = Annotated[
    str, typer.Option("--level", callback=_offered, help="Isolation level to require; empty: as the course says, else A or A-.")
]

WIDTH = 150
SIGNS = ("nbgrader_config.py", "nbgrader_config.json", "gradebook.db", "submitted", "source")


def opened(folder: Path) -> Course:
    """The course in a folder. Raises CourseError where nothing in the folder says that it is one; nothing is made there."""
    if not any((folder / sign).exists() for sign in SIGNS):
        raise CourseError(
            f"{folder.resolve()} is not a course: it has no nbgrader_config.py; "
            "go to the course's folder, name it with --course, or make one with `directrix new FOLDER`"
        )
    from autograder.course import Course

    return Course(folder)


def shown(folder: Path, course: Course, step: str) -> Path:
    """The folder of a step (``submitted``, ...) as the course's settings have it, written from where the course was named."""
    place = course.root / str(course.get("CourseDirectory", f"{step}_directory", step))
    return folder / os.path.relpath(place, course.folder)


def paragraphs(verb: Callable[..., Any]) -> str:
    """The help of a verb, its docstring with each paragraph on one line: the terminal's width folds it, not ours."""
    return "\n\n".join(" ".join(part.split()) for part in inspect.cleandoc(verb.__doc__ or "").split("\n\n"))


def console_for(as_json: bool) -> Console:
    """The console for people: standard output, or standard error where JSON goes to standard output."""
    console = Console(stderr=as_json)
    if not console.is_terminal:
        console.width = max(console.width, WIDTH)  # a log or a pipe has no edge at which tables must be folded
    return console
