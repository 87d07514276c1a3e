"""``directrix check``, ``grade`` and ``feedback``: one's own notebook, and a class."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated

import typer

from autograder.cli.course import grade_with_progress
from autograder.cli.options import AsJson, CourseOption, GradingLevel, console_for, opened, shown


def check(
    notebooks: Annotated[list[Path], typer.Argument(help="Notebooks to run and check, for example A1/known-forms.ipynb.")],
    timeout: Annotated[int, typer.Option(help="Seconds that one cell may take.")] = 60,
    as_json: AsJson = False,
) -> None:
    """Run your own notebooks from top to bottom and show what each check says.

    Example: directrix check A1/known-forms.ipynb
    """
    from autograder.cli import ownwork

    console = console_for(as_json)
    results = [ownwork.run(path, timeout=timeout) for path in notebooks]
    for result in results:
        ownwork.show(result, console)
    if as_json:
        print(json.dumps([result.to_dict() for result in results], allow_nan=False))
    if not all(result.complete for result in results):
        raise typer.Exit(1)


def grade(
    assignment: Annotated[str, typer.Argument(help="Assignment in submitted/, for example A1.")],
    course: CourseOption = Path(),
    student: Annotated[list[str] | None, typer.Option(help="Only this student; may be repeated.")] = None,
    force: Annotated[
        bool, typer.Option("--force/--resume", help="Grade again what is graded already; or leave it, and go on from there.")
    ] = False,
    workers: Annotated[int, typer.Option(min=0, help="Submissions at a time; 0 means one for each processor.")] = 0,
    level: GradingLevel = "",
    scheduler: Annotated[str, typer.Option(help="Grade on a Dask cluster: tls://host:port; empty: on this machine.")] = "",
    as_json: AsJson = False,
) -> None:
    """Grade a class: every submission in its own sandbox, marks into the gradebook, a table at the end.

    A run that was interrupted is gone on with by the same command: what is graded and unchanged is left alone.

    Example: directrix grade A1 --student ada
    """
    from autograder import report

    console = console_for(as_json)
    graded = grade_with_progress(
        console, opened(course), assignment, students=student or None, force=force, workers=workers or None,
        level=level or None, scheduler=scheduler or None,
    )  # fmt: skip
    if len(graded.students):
        report.show(graded, console)
    else:
        place = opened(course).path("submitted", "STUDENT", assignment)
        said = f"Nobody has handed in {assignment}: submissions lie in {place}"
        console.print(said, highlight=False, markup=False, soft_wrap=True)
    if as_json:
        graded.write_json(sys.stdout)
    for folder in opened(course).misnamed(assignment):
        said = f"{folder} was not graded: if it is {assignment}, rename it to {assignment}"
        print(f"directrix: {report.plain(said)}", file=sys.stderr)
    for failure in graded.failures:
        print(f"directrix: {report.plain(failure)}", file=sys.stderr)
    if graded.failures:
        raise typer.Exit(1)


def feedback(
    assignment: Annotated[str, typer.Argument(help="A graded assignment, for example A1.")],
    course: CourseOption = Path(),
    student: Annotated[list[str] | None, typer.Option(help="Only this student; may be repeated.")] = None,
    as_json: AsJson = False,
) -> None:
    """Write feedback pages: one self-contained HTML file for each graded notebook.

    Example: directrix feedback A1
    """
    from autograder import feedback as pages

    paths: list[str] = []
    count, of = 0, opened(course)
    for count, path in enumerate(pages.pages(of, assignment, students=student or None), 1):  # noqa: B007
        paths += [str(path)] * as_json
    if as_json:
        print(json.dumps(paths))
    else:
        pages_are = "1 page" if count == 1 else f"{count} pages"
        console_for(as_json).print(f"{pages_are} under {shown(course, of, 'feedback')}", highlight=False, markup=False)
    now = set(of.students("autograded", assignment))
    for one in of.students("feedback", assignment):
        if one not in now and (not student or one in student):
            place = of.path("feedback", one, assignment)
            said = f"{place}: pages of an earlier submission, which is graded no more; do not hand them out"
            console_for(as_json).print(said, highlight=False, markup=False, soft_wrap=True)
