"""``directrix similar``: reads a course and changes nothing in it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from autograder.cli.options import AsJson, CourseOption, console_for, opened


def similar(
    assignment: Annotated[str, typer.Argument(help="Assignment in submitted/, for example A1.")],
    course: CourseOption = Path(),
    top: Annotated[int, typer.Option(min=1, help="How many pairs, those most alike.")] = 20,
    html: Annotated[Path | None, typer.Option(help="Also write a page with the code side by side.", show_default=False)] = None,
    as_json: AsJson = False,
) -> None:
    """Show which pairs of students share code that few others have. A reason to look, never a mark: docs/integrity.md.

    Example: directrix similar A1 --html similar-A1.html
    """
    from autograder import integrity
    from autograder.integrity.page import page
    from autograder.integrity.table import table

    report = integrity.similar(opened(course), assignment, top=top)
    console = console_for(as_json)
    console.print(table(report))
    if html is not None:
        html.write_text(page(report), "utf-8", errors="replace")
        said = f"{html}: the pairs side by side; it names students, so keep it as you keep marks"
        console.print(said, highlight=False, markup=False)
    if as_json:
        print(json.dumps(report.to_dict(), allow_nan=False))
