"""``directrix collect``: what a learning platform exports, into ``submitted/``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from autograder.cli.options import AsJson, CourseOption, console_for, opened, shown


def collect(
    archive: Annotated[Path, typer.Argument(help="The zip archive that Moodle, Canvas or ILIAS gives for an assignment.")],
    assignment: Annotated[str, typer.Argument(help="Assignment that these are submissions to, for example A1.")],
    course: CourseOption = Path(),
    pattern: Annotated[
        str, typer.Option(help="Regular expression with (?P<student>...) that says whose a folder or file is.")
    ] = "",
    force: Annotated[bool, typer.Option(help="Replace what these students have handed in before.")] = False,
    as_json: AsJson = False,
) -> None:
    """Take a class's zip archive into submitted/. Whatever in it is not taken is named, with the reason.

    Example: directrix collect export.zip A1
    """
    from rich.markup import escape

    from autograder import collect as collecting
    from autograder.report import plain

    console = console_for(as_json)
    into = opened(course)
    found = collecting.collect(into, archive, assignment, pattern=pattern or None, force=force)
    if as_json:
        print(json.dumps(collecting.to_dict(found), allow_nan=False))
    for one in found:
        who = escape(plain(one.student)) or "(nobody's)"
        console.print(f"{who}: {', '.join(escape(plain(name)) for name in one.files) or 'nothing taken'}", highlight=False)
        for name, reason in one.refused.items():
            console.print(f"  [yellow]not taken:[/] {escape(plain(f'{name}: {reason}' if name else reason))}", highlight=False)
    placed = sum(one.placed for one in found)
    submissions = "1 submission" if placed == 1 else f"{placed} submissions"
    console.print(f"{submissions} of {assignment} in {shown(course, into, 'submitted')}", highlight=False, markup=False)
    if any(one.refused for one in found):
        raise typer.Exit(1)
