"""``directrix author check``: an instructor's own exercises, held to the rules, with a table of what sees what."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.markup import escape

from autograder.cli.options import AsJson, console_for, paragraphs

if TYPE_CHECKING:
    from rich.console import Console

    from autograder.authoring import Breach
    from autograder.catalogue import Assignment

author = typer.Typer(help="For whoever writes exercises.", no_args_is_help=True)


def check(
    folder: Annotated[Path, typer.Argument(help="An assignment folder, or a course folder with several.")] = Path(),
    seeds: Annotated[int, typer.Option(min=2, help="How many draws of the random data must see every mistake.")] = 10,
    run: Annotated[bool, typer.Option("--run", help="Also run each notebook, solved and as released (takes longer).")] = False,
    as_json: AsJson = False,
) -> None:
    """Hold exercises to the rules, and show which data set sees which mistake and what it earns.

    A number is the largest distance from the right answer relative to its size; a dot: the data set cannot see the mistake.
    The last column is what the judge would make of the mistake if it had no name.

    Example: directrix author check assignments/20-roofs
    """
    from autograder import catalogue

    console = console_for(as_json)
    told = [_assignment(one, seeds, console, run=run) for one in catalogue.load(folder).assignments]
    if as_json:
        print(json.dumps(told, allow_nan=False))
    if any(breach["must"] for one in told for breach in one["breaches"]):
        raise typer.Exit(1)


author.command(help=paragraphs(check))(check)


def _assignment(assignment: Assignment, seeds: int, console: Console, *, run: bool) -> dict[str, Any]:
    """Print one assignment; the same for JSON."""
    from autograder import authoring

    with console.status(f"checking {assignment.folder.name}"):
        found = list(authoring.breaches(assignment, range(seeds)))
        broken = {breach.exercise for breach in found if breach.rule in ("data", "reference")}
        surveys = {e.id: authoring.survey(e) for e in assignment.exercises.values() if e.id not in broken}
        if run and not any(breach.must for breach in found):
            found += _runs(assignment)
    console.rule(f"{assignment.name} {assignment.slug}", align="left")
    for id, seen in surveys.items():
        console.print(authoring.table(assignment.exercises[id], seen))
    for breach in found:
        colour, word = ("bold red", "broken") if breach.must else ("yellow", "advice")
        where = f"[bold]{escape(breach.exercise)}[/], {breach.rule}"
        console.print(f"[{colour}]{word}[/]  {where}: {escape(breach.said)}.", highlight=False)
        console.print(f"        {escape(breach.to_do)}.", highlight=False)
    if not any(breach.must for breach in found):
        count = len(assignment.exercises)
        rules = f"{count} exercise{'s' * (count != 1)}, {assignment.points:g} points: every rule holds"
        console.print(f"[bold green]good[/]    {rules}{' and the notebook runs' * run}", highlight=False)
    return {
        "assignment": assignment.name,
        "folder": str(assignment.folder),
        "points": assignment.points,
        "exercises": {id: [one.to_dict() for one in seen] for id, seen in surveys.items()},
        "breaches": [breach.to_dict() for breach in found],
    }


def _runs(assignment: Assignment) -> list[Breach]:
    """What the notebook breaks when it runs: solved it earns all points, as released none."""
    from autograder.authoring import Breach
    from autograder.catalogue import VARIABLE
    from autograder.cli import ownwork
    from autograder.notebook import source

    if not assignment.source.is_file():
        return []
    found: list[Breach] = []
    built = source.build(assignment)
    with tempfile.TemporaryDirectory() as scratch:
        for what, notebook in (("solved", built), ("released", source.release(built))):
            path = Path(scratch) / f"{what}.ipynb"
            path.write_text(source.dumps(notebook), "utf-8")
            result = ownwork.run(path, timeout=60, environment={VARIABLE: str(assignment.folder.resolve())})
            wanted = {c.exercise: c.available if what == "solved" else 0.0 for c in result.checks}
            for one in result.checks:
                if one.points != wanted[one.exercise]:
                    said = f"the notebook as {what} earns {one.points:g} of {one.available:g} points: {one.text}"
                    to_do = (
                        "mend the solution in the task cell"
                        if what == "solved"
                        else "let the stub raise, and no cell define it"
                    )
                    found.append(Breach(one.exercise, what, said, to_do))
            if result.stopped:
                found.append(Breach(assignment.folder.name, what, f"the notebook stopped: {result.stopped}", "mend that cell"))
    return found
