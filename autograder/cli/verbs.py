"""The verbs of the command line, each in a file that is loaded when it is called, or when all are shown."""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from typing import Annotated

import typer

from autograder.cli.options import paragraphs

HOMES = {
    "demo": "course", "new": "course", "release": "course", "lab": "course", "check": "grading", "collect": "collecting",
    "grade": "grading", "feedback": "grading", "report": "reading", "similar": "reading", "marks": "reading",
    "export": "reading", "site": "publishing", "doctor": "machine",
}  # fmt: skip


def _version(asked: bool) -> None:
    if asked:
        import platform
        from importlib.metadata import version

        print(f"directrix {version('directrix')}, Python {platform.python_version()}, nbgrader {version('nbgrader')}")
        raise typer.Exit


def everywhere(
    _: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show what is installed, and exit.")
    ] = False,
) -> None:
    """Learn surface modelling by writing the surfaces. Start with: directrix demo"""


def command(words: Sequence[str]) -> typer.Typer:
    """The command with the one verb that the words begin with; with all, where that is none of them."""
    app = typer.Typer(
        name="directrix",
        no_args_is_help=True,
        add_completion=False,
        rich_markup_mode="rich",
        pretty_exceptions_enable=False,
    )
    app.callback()(everywhere)
    called = [word for word in words[:1] if word in HOMES]
    for name in called or HOMES:
        verb = getattr(importlib.import_module(f"autograder.cli.{HOMES[name]}"), name)
        app.command(help=paragraphs(verb))(verb)
    if not called:
        app.add_typer(importlib.import_module("autograder.cli.author").author, name="author")
    return app
