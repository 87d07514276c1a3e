"""The report as one self-contained HTML page: pairs side by side, common runs in colour. No script, nothing loaded."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import files

import jinja2

from autograder.integrity import SMALL_CLASS, THRESHOLD, Part, Report, Run
from autograder.integrity.runs import Place
from autograder.report import plain

POLICY = "default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"
COLOURS = 6


@dataclass(frozen=True)
class Line:
    """A line of code with the number of the common run that it belongs to, 0 for none."""

    number: int
    text: str
    run: int


def page(report: Report) -> str:
    """The HTML. Everything that came from students is escaped."""
    environment = jinja2.Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    environment.filters["plain"] = plain
    here = files("autograder.integrity")
    return environment.from_string(here.joinpath("page.html.j2").read_text("utf-8")).render(
        report=report,
        policy=POLICY,
        style=here.joinpath("page.css").read_text("utf-8"),
        pairs=[(pair, runs, _sides(runs)) for pair, runs in zip(report.found.pairs, report.runs, strict=True)],
        threshold=THRESHOLD,
        small=report.found.students < SMALL_CLASS,
        colours=COLOURS,
    )


def _sides(runs: tuple[Run, ...]) -> tuple[list[tuple[Part, list[Line]]], list[tuple[Part, list[Line]]]]:
    first, second = [run.first for run in runs], [run.second for run in runs]
    return _cells(first), _cells(second)


def _cells(places: list[Place]) -> list[tuple[Part, list[Line]]]:
    """The cells that hold a run, in the order of the notebook, with their lines."""
    parts = sorted({place.part for place in places}, key=lambda part: (part.notebook, part.cell))
    made = []
    for part in parts:
        run_of: dict[int, int] = {}
        for number, place in enumerate(places, 1):
            if place.part == part:
                for line in range(place.begin, place.end + 1):
                    run_of.setdefault(line, number)
        lines = part.source.expandtabs(4).split("\n")
        made.append((part, [Line(number, plain(text.rstrip()), run_of.get(number, 0)) for number, text in enumerate(lines, 1)]))
    return made
