"""``directrix doctor``: what this machine gives."""

from __future__ import annotations

import json
from typing import Annotated

import typer
from rich.table import Table

from autograder.cli.options import AsJson, console_for

COLOURS = {"stopped": "green", "got through": "bold red", "proves nothing": "dim"}


def doctor(
    level: Annotated[str, typer.Option(help="Fail unless this isolation level is reached: A or A-.")] = "",
    as_json: AsJson = False,
) -> None:
    """Attack the sandbox of this machine and say which isolation level it reaches.

    Each attack also runs without the sandbox: one that fails there too proves nothing and is not counted.

    Example: directrix doctor --level A
    """
    from autograder import doctor as doctors
    from autograder.sandbox.box import LEVELS

    if level and level not in LEVELS:
        raise typer.BadParameter(f"a level is one of {', '.join(LEVELS)}; got {level!r}", param_hint="--level")
    console = console_for(as_json)
    with console.status("attacking the sandbox"):
        found = doctors.examine()
    table = Table(title="attacks", title_justify="left")
    for heading in ("attack", "outcome", "what came of it"):
        table.add_column(heading)
    for probe in found.probes:
        table.add_row(probe.tried, f"[{COLOURS[probe.outcome]}]{probe.outcome}[/]", probe.detail)
    console.print(table)
    for what, value in found.machine.items():
        console.print(f"  {what}: {value}", highlight=False, markup=False)
    stopped = sum(probe.outcome == "stopped" for probe in found.probes)
    counted = sum(probe.outcome != "proves nothing" for probe in found.probes)
    console.print(f"[bold]Level {found.level}[/]: {found.meaning} ({stopped} of {counted} attacks stopped)", highlight=False)
    for line in found.advice:
        console.print(f"  {line}", highlight=False, markup=False)
    if as_json:
        print(json.dumps(found.to_dict(), allow_nan=False))
    if level and list(LEVELS).index(found.level) > list(LEVELS).index(level):
        console.print(f"Level {level} was asked for and is not given here.", highlight=False)
        raise typer.Exit(1)
