"""``directrix report``, ``similar``, ``marks`` and ``export``: they read a course and change nothing in it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from autograder.cli.options import AsJson, CourseOption, console_for, opened

if TYPE_CHECKING:
    from rich.console import Console

    from autograder.gradebook.export import Sheet


def report(
    assignment: Annotated[str, typer.Argument(help="A graded assignment, for example A1.")],
    course: CourseOption = Path(),
    as_json: AsJson = False,
) -> None:
    """Show the class as it stands: every student's marks, what the class found hard, and which mistakes were made how often.

    It is the table of `directrix grade` with the marks that are in the gradebook now, those by hand too. Nothing is graded.

    Example: directrix report A1
    """
    from autograder import fleet
    from autograder import report as reports

    standing = fleet.standing(opened(course), assignment)
    reports.show(standing, console_for(as_json))
    if as_json:
        print(json.dumps(reports.summary(standing), allow_nan=False))


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


def marks(
    assignment: Annotated[str, typer.Argument(help="A graded assignment, for example A1.")],
    course: CourseOption = Path(),
    csv: Annotated[
        Path | None, typer.Option(help="Write the marks to this file, for a spreadsheet.", show_default=False)
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Show the marks of an assignment as they stand in the gradebook, marks by hand included; write all parts as CSV.

    Example: directrix marks A1 --csv marks-A1.csv
    """
    from rich.table import Table
    from rich.text import Text

    from autograder.gradebook import export
    from autograder.report import plain

    with opened(course).gradebook() as book:
        sheet = export.sheet(book, assignment)
    header, *rows = export.table(sheet)
    console = console_for(as_json)
    made = Table(header_style="bold")
    shown = [0, 1, *range(len(header) - 4, len(header))]  # a column for each part is for the file: a screen has no room for it
    for place in shown:
        made.add_column(str(header[place]), overflow="fold", justify="left" if place < 2 else "right")
    for line in rows:
        cells = (line[place] for place in shown)
        made.add_row(*(Text(plain(f"{cell:g}" if isinstance(cell, float) else str(cell))) for cell in cells))
    console.print(made)
    if csv is not None:
        _write(sheet, csv, console)
    if as_json:
        print(_rows(sheet))


def export(
    assignment: Annotated[str, typer.Argument(help="A graded assignment, for example A1.")],
    course: CourseOption = Path(),
    csv: Annotated[
        Path | None, typer.Option(help="The file to write.", show_default="marks-ASSIGNMENT.csv in this folder")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Write the marks of an assignment as a CSV file that a learning platform or a spreadsheet takes.

    One row a student: id, name, every part, late penalty, total, points available, and how many parts wait for a person.

    Example: directrix export A1 --csv marks-A1.csv
    """
    from autograder.gradebook import export as exporting

    with opened(course).gradebook() as book:
        sheet = exporting.sheet(book, assignment)
    _write(sheet, csv if csv is not None else Path(f"marks-{assignment}.csv"), console_for(as_json))
    if as_json:
        print(_rows(sheet))


def _write(sheet: Sheet, path: Path, console: Console) -> None:
    from autograder.gradebook import export as exporting

    path.write_text(exporting.as_csv(sheet), "utf-8", newline="")
    console.print(f"{path}: {len(sheet.rows)} students, {sheet.available:g} points", highlight=False, markup=False)


def _rows(sheet: Sheet) -> str:
    from autograder.gradebook import export as exporting

    header, *rows = exporting.table(sheet)
    names = [str(name) for name in header]
    return json.dumps(
        {"assignment": sheet.assignment, "rows": [dict(zip(names, line, strict=True)) for line in rows]}, allow_nan=False
    )
