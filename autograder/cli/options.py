"""Options that several verbs share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

CourseOption = Annotated[Path, typer.Option("--course", help="The course folder.", show_default="this folder")]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON document, and what is meant for people on stderr.")]

WIDTH = 150


def console_for(as_json: bool) -> Console:
    """The console for people: standard output, or standard error where JSON goes to standard output."""
    console = Console(stderr=as_json)
    if not console.is_terminal:
        console.width = max(console.width, WIDTH)  # a log or a pipe has no edge at which tables must be folded
    return console
