"""The report for the terminal. Names come from students' folders and notebooks: none may steer it."""

from __future__ import annotations

from rich.console import Group
from rich.table import Table
from rich.text import Text

from autograder.integrity import SMALL_CLASS, THRESHOLD, Pair, Report, Run
from autograder.report import plain

READ = "Likeness is a reason to look, not a finding. Before you speak to a student: docs/integrity.md"


def table(report: Report) -> Group:
    """The pairs in a table, and what to know beside it."""
    made = Table(
        title=f"{plain(report.assignment)}: who shares what few others have", title_justify="left", header_style="bold"
    )
    made.add_column("likeness", justify="right", no_wrap=True)
    made.add_column("students", overflow="fold")
    made.add_column("fingerprints", justify="right", no_wrap=True)
    made.add_column("most in", overflow="fold")
    made.add_column("longest common run", overflow="fold")
    for pair, runs in zip(report.found.pairs, report.runs, strict=True):
        made.add_row(
            Text(f"{pair.likeness:.2f}", style="bold yellow" if pair.likeness >= THRESHOLD else "dim"),
            Text(plain(" | ".join(pair.students))),
            f"{pair.whole.shared} of {min(pair.whole.of)}",
            Text(plain(_exercises(pair))),
            Text(plain(_longest(runs))),
        )
    count = len(report.found.striking)
    said = f"{count} of the pairs shown at {THRESHOLD:g} or above; {report.found.students} students compared"
    lines = [Text(said), Text(READ, style="dim")]
    if report.found.students < SMALL_CLASS:
        lines.insert(1, Text(f"In a class of fewer than {SMALL_CLASS} nobody can tell what is rare.", style="yellow"))
    notes = [Text(f"  not compared: {plain(note)}", style="yellow") for note in report.notes]
    return Group(made, *notes, *lines)


def _exercises(pair: Pair) -> str:
    most = sorted(pair.exercises.items(), key=lambda item: -item[1].bits)[:3]
    return ", ".join(f"{name} ({share.shared} of {min(share.of)})" for name, share in most)


def _longest(runs: tuple[Run, ...]) -> str:
    if not runs:
        return ""
    run = max(runs, key=lambda run: run.length)
    first, second = (f"cell {place.part.cell}, {place.begin}-{place.end}" for place in (run.first, run.second))
    return f"{run.length} tokens: {first} | {second}"
