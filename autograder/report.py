"""The class at a glance: plain data, and a table for the terminal.

data = report.summary(graded)       # numbers and names, for programs
console.print(report.table(graded)) # the same for people
report.show(graded, console)        # the same without holding all of a large class in memory
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass, field, replace
from typing import Any

from rich.console import Console, Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from autograder.fleet import CellReport, GradeReport, StudentReport
from autograder.fleet.result import STRAY

PAGE = 100  # students in a table: the next has its heading again
FEW = 5  # tables of students that may be held in memory at once
MOST_MISTAKES = 3
WIDEST_NAME = 22
STATUS = {
    "graded": ("graded", ""),
    "unchanged": ("unchanged", "dim"),
    "broken": ("could not be read", "bold red"),
    "empty": ("no notebook", "yellow"),
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


@dataclass
class _Tally:
    """What is counted for a part while the submissions go by."""

    first: CellReport
    cells: int = 0
    marked: int = 0
    points: float = 0.0
    full: int = 0
    none: int = 0
    mistakes: Counter[str] = field(default_factory=Counter)

    def count(self, cell: CellReport) -> None:
        self.cells += 1
        if cell.mistake:
            self.mistakes[cell.mistake] += 1
        if cell.points is not None:
            self.marked += 1
            self.points += cell.points
            self.full += cell.points >= self.first.available
            self.none += cell.points <= 0 < self.first.available

    def part(self, graded: GradeReport) -> Part:
        first = self.first
        return Part(
            first.notebook, first.name, graded.titles.get(first.exercise or "", "") or first.name, first.available,
            self.full, self.marked - self.full - self.none, self.none, self.cells - self.marked,
            self.points / (self.marked * first.available) if self.marked and first.available else None,
            tuple(sorted(self.mistakes.items(), key=lambda pair: (-pair[1], pair[0]))),
        )  # fmt: skip


def parts(graded: GradeReport) -> tuple[Part, ...]:
    """The graded cells of an assignment in their order, over all submissions that could be read."""
    found: dict[tuple[str, str], _Tally] = {}
    for student in graded.students:
        if student.status in ("graded", "unchanged"):
            for cell in student.cells:
                found.setdefault((cell.notebook, cell.name), _Tally(cell)).count(cell)
    return tuple(tally.part(graded) for tally in found.values())


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
        "missing": {student.student: list(student.missing) for student in graded.students if student.missing},
        "broken": list(graded.broken),
        "faults": list(graded.faults),
        "shared": dict(graded.shared),
    }


def table(graded: GradeReport) -> Group:
    """The class as a table of students and a table of what it found hard."""
    return Group(*_pieces(graded))


def show(graded: GradeReport, console: Console) -> None:
    """Print the same, piece by piece."""
    for piece in _pieces(graded):
        console.print(piece)


def _pieces(graded: GradeReport) -> Iterator[RenderableType]:
    if len(graded.students) <= FEW * PAGE:  # more are read from disk whenever something is asked of them
        graded = replace(graded, students=tuple(graded.students))
    widths = _widths(graded)
    yield from _students(graded, widths)
    yield _legend(widths)
    found = parts(graded)
    if any(part.mistakes or part.mean is not None for part in found):
        yield from ("", _class(found))
    without = (f"{student.student}: {'; '.join(student.notes)}" for student in graded.students if _misnamed(student))
    yield from _listed("No notebook under the name that was released", "bold yellow", without)
    yield from _listed("Could not be read", "bold red", graded.broken)
    yield from _listed("The grader's own failures", "bold red", graded.faults)
    shared = (f"{cell}: {why}" for cell, why in graded.shared.items())
    yield from _listed("Tests that ran in the learners' own process, where they can be tampered with", "bold yellow", shared)
    yield Text(_footer(graded), style="dim")


def _misnamed(student: StudentReport) -> bool:
    """Whether a notebook that was not handed in may lie there under another name."""
    return student.status == "empty" or bool(student.missing and any(note.endswith(STRAY) for note in student.notes))


def _listed(heading: str, style: str, lines: Iterable[str]) -> Iterator[RenderableType]:
    """Lines under a heading; nothing where there are none."""
    for number, line in enumerate(lines):
        if number == 0:
            yield from ("", Text(heading, style=style))
        yield Padding(Text(plain(line)), (0, 0, 0, 2))


@dataclass
class _Widths:
    """How wide the columns of the class are, so that all its tables are alike: ids, marks by (notebook, name), points."""

    student: int = 0
    marks: dict[tuple[str, str], int] = field(default_factory=dict)
    points: int = 0


def _widths(graded: GradeReport) -> _Widths:
    found = _Widths()
    for student in graded.students:
        found.student = max(found.student, len(student.student))
        found.points = max(found.points, len(_total(student, graded)))
        for cell in student.cells:
            key = cell.notebook, cell.name
            found.marks[key] = max(found.marks.get(key, 0), len(_points(cell)[0]))
    return found


def _students(graded: GradeReport, widths: _Widths) -> Iterator[Table]:
    count = len(graded.students)
    made = _page(widths, title=plain(f"{graded.assignment}: {count} submission{'s' * (count != 1)}"))
    for student in graded.students:
        if made.row_count == PAGE:
            yield made
            made = _page(widths)
        cells = {(cell.notebook, cell.name): cell for cell in student.cells}
        marks = (Text(*_points(cells.get(column))) for column in widths.marks)
        made.add_row(Text(plain(student.student)), *marks, _total(student, graded), _remark(student))
    yield made


def _page(widths: _Widths, title: str | None = None) -> Table:
    made = Table(title=None if title is None else Text(title), title_justify="left", header_style="bold", expand=True)
    made.add_column("student", overflow="fold", min_width=min(widths.student, WIDEST_NAME))
    for number, width in enumerate(widths.marks.values(), 1):
        made.add_column(str(number), justify="right", no_wrap=True, min_width=width)
    made.add_column("points", justify="right", no_wrap=True, min_width=widths.points)
    made.add_column("", no_wrap=True, overflow="ellipsis", ratio=1)
    return made


def _total(student: StudentReport, graded: GradeReport) -> str:
    return f"{student.score - student.penalty:g} / {graded.available:g}"


def _legend(widths: _Widths) -> Text:
    """Which cell each number at the head of the table means: numbers leave room for the marks on a narrow screen."""
    names = (name.removeprefix("check_") for _, name in widths.marks)
    return Text(plain("   ".join(f"{number} {name}" for number, name in enumerate(names, 1))), style="dim")


def _points(cell: CellReport | None) -> tuple[str, str]:
    """The points of a cell and the style to show them in."""
    if cell is None:
        return "", ""
    if cell.points is None:
        return "?", "yellow"
    style = "green" if cell.points >= cell.available else ("" if cell.points > 0 else "red")
    return f"{cell.points:g}{'?' if cell.look else ''}", style


def _remark(student: StudentReport) -> Text:
    word, style = STATUS[student.status]
    said = [] if student.status == "graded" else [word]
    if student.missing and student.status != "empty":
        said.append(f"{', '.join(student.missing)} not handed in")
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
    done = sum(student.status == "graded" for student in graded.students)
    took = f" in {graded.seconds:.1f} s" if graded.seconds > 0 else ""
    speed = f", {done / graded.seconds:.1f} a second" if done and graded.seconds > 0 else ""
    sandbox = f"; sandbox level {graded.level}" if graded.level else ""
    return f"{done} graded{took}{speed}{sandbox}; '?' waits for a person"


def plain(text: str) -> str:
    """Names and messages that came from outside cannot steer the terminal."""
    return "".join(letter if letter.isprintable() else "�" for letter in text)
