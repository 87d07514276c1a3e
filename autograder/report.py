"""The class at a glance: plain data, and a table for the terminal.

data = report.summary(graded)       # numbers and names, for programs
console.print(report.table(graded)) # the same for people
"""

from __future__ import annotations

from collections import Counter
from dataclasses import asdict, dataclass
from typing import Any

from rich.console import Group
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from autograder.fleet import CellReport, GradeReport, StudentReport

MOST_MISTAKES = 3
WIDEST_NAME = 22
STATUS = {
    "graded": ("graded", ""),
    "unchanged": ("unchanged", "dim"),
    "broken": ("could not be read", "bold red"),
    "empty": ("nothing handed in", "yellow"),
    "failed": ("not graded", "bold red"),
}


@dataclass(frozen=True)
class Part:
    """How the class did on one graded cell: how many have all points, some, none, wait for a person; the mean share."""

    notebook: str
    name: str
    title: str
    available: float
    full: int
    some: int
    none: int
    waiting: int
    mean: float | None
    mistakes: tuple[tuple[str, int], ...] = ()


def parts(graded: GradeReport) -> tuple[Part, ...]:
    """The graded cells of an assignment in their order, over all submissions that could be read."""
    cells: dict[tuple[str, str], list[CellReport]] = {}
    for student in graded.students:
        if student.status in ("graded", "unchanged"):
            for cell in student.cells:
                cells.setdefault((cell.notebook, cell.name), []).append(cell)
    return tuple(_part(found, graded) for found in cells.values())


def _part(cells: list[CellReport], graded: GradeReport) -> Part:
    first = cells[0]
    points = [cell.points for cell in cells if cell.points is not None]
    full = sum(value >= first.available for value in points)
    none = sum(value <= 0 < first.available for value in points)
    mistakes = Counter(cell.mistake for cell in cells if cell.mistake)
    return Part(
        first.notebook, first.name, graded.titles.get(first.exercise or "", "") or first.name, first.available,
        full, len(points) - full - none, none, len(cells) - len(points),
        sum(points) / (len(points) * first.available) if points and first.available else None,
        tuple(sorted(mistakes.items(), key=lambda pair: (-pair[1], pair[0]))),
    )  # fmt: skip


def summary(graded: GradeReport) -> dict[str, Any]:
    """The class in numbers: parts, mistakes, and who waits for what. Plain data."""
    scores = [student.score - student.penalty for student in graded.students if student.status in ("graded", "unchanged")]
    return {
        "course": graded.course,
        "assignment": graded.assignment,
        "level": graded.level,
        "submissions": len(graded.students),
        "mean": sum(scores) / len(scores) if scores else None,
        "available": graded.available,
        "parts": [asdict(part) for part in parts(graded)],
        "looks": {student.student: student.looks for student in graded.students if student.looks},
        "broken": list(graded.broken),
        "faults": list(graded.faults),
        "shared": dict(graded.shared),
    }


def table(graded: GradeReport) -> Group:
    """The class as a table of students and a table of what it found hard."""
    shown: list[Any] = [_students(graded), _legend(graded)]
    found = parts(graded)
    if any(part.mistakes or part.mean is not None for part in found):
        shown += ["", _class(found)]
    for heading, lines in (("Could not be read", graded.broken), ("The grader's own failures", graded.faults)):
        if lines:
            shown += ["", Text(heading, style="bold red"), *(Padding(Text(plain(line)), (0, 0, 0, 2)) for line in lines)]
    if graded.shared:
        shown += ["", Text("Tests that ran in the learners' own process, where they can be tampered with", style="bold yellow")]
        shown += [Padding(Text(plain(f"{cell}: {why}")), (0, 0, 0, 2)) for cell, why in graded.shared.items()]
    shown.append(Text(_footer(graded), style="dim"))
    return Group(*shown)


def _students(graded: GradeReport) -> Table:
    title = Text(plain(f"{graded.assignment}: {len(graded.students)} submissions"))
    made = Table(title=title, title_justify="left", header_style="bold", expand=True)
    longest = max((len(student.student) for student in graded.students), default=0)
    made.add_column("student", overflow="fold", min_width=min(longest, WIDEST_NAME))
    columns = _columns(graded)
    for number in range(1, len(columns) + 1):
        made.add_column(str(number), justify="right", no_wrap=True)
    made.add_column("points", justify="right", no_wrap=True)
    made.add_column("", no_wrap=True, overflow="ellipsis", ratio=1)
    for student in graded.students:
        cells = {(cell.notebook, cell.name): cell for cell in student.cells}
        made.add_row(
            Text(plain(student.student)),
            *(_points(cells.get(column)) for column in columns),
            f"{student.score - student.penalty:g} / {graded.available:g}",
            _remark(student),
        )
    return made


def _columns(graded: GradeReport) -> list[tuple[str, str]]:
    """The graded cells of the class, (notebook, name), in their order."""
    return list(dict.fromkeys((cell.notebook, cell.name) for student in graded.students for cell in student.cells))


def _legend(graded: GradeReport) -> Text:
    """Which cell each number at the head of the table means: numbers leave room for the marks on a narrow screen."""
    names = (name.removeprefix("check_") for _, name in _columns(graded))
    return Text(plain("   ".join(f"{number} {name}" for number, name in enumerate(names, 1))), style="dim")


def _points(cell: CellReport | None) -> Text:
    if cell is None:
        return Text("")
    if cell.points is None:
        return Text("?", style="yellow")
    style = "green" if cell.points >= cell.available else ("" if cell.points > 0 else "red")
    return Text(f"{cell.points:g}{'?' if cell.look else ''}", style=style)


def _remark(student: StudentReport) -> Text:
    word, style = STATUS[student.status]
    said = [] if student.status == "graded" else [word]
    if student.penalty:
        said.append(f"late: -{student.penalty:g}")
    if student.looks:
        said.append(f"{student.looks} to look at")
    slips = list(dict.fromkeys(cell.mistake for cell in student.cells if cell.mistake))
    said += slips[:MOST_MISTAKES] + (["..."] if len(slips) > MOST_MISTAKES else [])
    return Text(plain(", ".join(said)), style=style)


def _class(found: tuple[Part, ...]) -> Table:
    made = Table(title="What the class found hard", title_justify="left", header_style="bold")
    made.add_column("part", overflow="fold")
    for heading in ("mean", "all", "some", "none", "open"):
        made.add_column(heading, justify="right")
    made.add_column("mistakes that were named", overflow="fold")
    for part in sorted(found, key=lambda part: part.mean if part.mean is not None else 2.0):
        mean = "" if part.mean is None else f"{100 * part.mean:.0f} %"
        named = ", ".join(f"{name} ({count})" for name, count in part.mistakes)
        counts = (str(part.full), str(part.some), str(part.none), str(part.waiting or ""))
        made.add_row(Text(plain(part.title)), mean, *counts, Text(plain(named)))
    return made


def _footer(graded: GradeReport) -> str:
    done = len(graded.graded)
    speed = f", {done / graded.seconds:.1f} a second" if done and graded.seconds > 0 else ""
    sandbox = f"; sandbox level {graded.level}" if graded.level else ""
    return f"{done} graded in {graded.seconds:.1f} s{speed}{sandbox}; '?' waits for a person"


def plain(text: str) -> str:
    """Names and messages that came from outside cannot steer the terminal."""
    return "".join(letter if letter.isprintable() else "�" for letter in text)
