"""``directrix report``, ``similar``, ``marks`` and ``export``: they read a course and change nothing in it."""

from __future__ import annotations

import dataclasses
import json
import sys
from collections.abc import Iterator, Sequence
from io import TextIOWrapper
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from autograder.cli.options import AsJson, CourseOption, console_for, opened
from autograder.whole import replaced

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from autograder.gradebook.export import Cell, Sheet

MOST_NAMED = 20
WIDEST = 30  # letters of an id or a name that columns keep on a narrow screen


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
        with replaced(html) as file:
            file.write(page(report).encode("utf-8", "replace"))
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
    from autograder.gradebook import export

    found = opened(course)
    with found.gradebook() as book:
        sheet = export.sheet(book, assignment)
    console = console_for(as_json)
    for made in _tables(sheet):
        console.print(made)
    if not sheet.rows and csv is None:
        _nobody(sheet, console)
    if csv is not None:
        _write(sheet, csv, console)
    _left_out(sheet, found.students("submitted", assignment), console)
    if as_json:
        _print_rows(sheet)


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

    found, console = opened(course), console_for(as_json)
    with found.gradebook() as book:
        sheet = exporting.sheet(book, assignment)
    _write(sheet, csv if csv is not None else Path(f"marks-{assignment}.csv"), console)
    _left_out(sheet, found.students("submitted", assignment), console)
    if as_json:
        _print_rows(sheet)


def _write(sheet: Sheet, path: Path, console: Console) -> None:
    from autograder.gradebook import export as exporting

    with replaced(path) as file:
        exporting.write_csv(sheet, text := TextIOWrapper(file, "utf-8", newline=""))
        text.detach()
    count = len(sheet.rows)
    students = "1 student" if count == 1 else f"{count} students"
    console.print(f"{path}: {students}, {sheet.available:g} points", highlight=False, markup=False)
    if not count:
        _nobody(sheet, console)


def _nobody(sheet: Sheet, console: Console) -> None:
    said = f"Nobody has marks of {sheet.assignment} yet; grade it first: directrix grade {sheet.assignment}"
    console.print(said, highlight=False, markup=False)


def _left_out(sheet: Sheet, submitted: Sequence[str], console: Console) -> None:
    """Name who has a folder in submitted/ and no row, since whoever takes the rows for the class would forget them."""
    from autograder.report import plain

    marked = {row.student for row in sheet.rows}
    if sheet.rows and (others := [plain(student) for student in submitted if student not in marked]):
        named = ", ".join(others[:MOST_NAMED]) + (f" and {len(others) - MOST_NAMED} more" if len(others) > MOST_NAMED else "")
        said = f"Not among them, without any marks yet: {named}. What became of each: directrix grade {sheet.assignment}"
        console.print(said, highlight=False, markup=False)


def _tables(sheet: Sheet) -> Iterator[Table]:
    """The marks for a screen, which has no room for a column for each part; a large class in tables of a hundred students."""
    from rich.table import Table
    from rich.text import Text

    from autograder.gradebook import export
    from autograder.report import PAGE, plain

    header = export.header(sheet)
    shown = [0, 1, *range(len(header) - 4, len(header))]

    def row(line: list[Cell]) -> list[Text]:
        return [Text(plain(f"{cell:g}" if isinstance(cell, float) else str(cell))) for cell in map(line.__getitem__, shown)]

    widths = [0] * len(shown)
    if len(sheet.rows) > PAGE:  # so that all tables are alike
        for line in export.lines(sheet):
            widths = [max(width, cell.cell_len) for width, cell in zip(widths, row(line), strict=True)]
    for start in range(0, max(len(sheet.rows), 1), PAGE):
        made = Table(header_style="bold")
        for place, width in zip(shown, widths, strict=True):
            justify: Literal["left", "right"] = "left" if place < 2 else "right"
            made.add_column(header[place], overflow="fold", justify=justify, min_width=min(width, WIDEST))
        for line in export.lines(dataclasses.replace(sheet, rows=sheet.rows[start : start + PAGE])):
            made.add_row(*row(line))
        yield made


def _print_rows(sheet: Sheet) -> None:
    """Print the marks as one JSON document, a student at a time."""
    from autograder.gradebook import export

    header, write = export.header(sheet), sys.stdout.write
    write(f'{{"assignment": {json.dumps(sheet.assignment)}, "rows": [')
    for number, line in enumerate(export.lines(sheet)):
        row = json.dumps(dict(zip(header, line, strict=True)), allow_nan=False)
        write(f"{', ' if number else ''}{row}")
    write("]}\n")
