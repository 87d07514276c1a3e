"""The class table: numbers for programs, a table for people, and nothing that steers a terminal."""

import io
import json
import os
import tracemalloc
from collections.abc import Sequence

from rich.console import Console

from autograder import report
from autograder.fleet import CellReport, GradeReport, StudentReport
from autograder.fleet.result import STRAY


def cell(name, points, available=4.0, **more):
    return CellReport("nb", f"check_{name}", "exercise", points, available, exercise=name, **more)


def student(id, *cells, **more):
    scored = sum(cell.points or 0.0 for cell in cells)
    return StudentReport(id, **{"status": "graded", "cells": cells, "score": scored, "available": 8.0, **more})


GRADED = GradeReport(
    "geo",
    "A1",
    "A",
    (
        student("ada", cell("cylinder", 4.0), cell("cone", 2.0, mistake="slant_as_height")),
        student("bob", cell("cylinder", 0.0, mistake="no_2pi"), cell("cone", 2.0, mistake="slant_as_height"), penalty=1.0),
        student("kim", cell("cylinder", 4.0, look=True), cell("cone", None)),
        student("zig", cell("cylinder", None), cell("cone", None), status="broken", broken=("nb.ipynb: not JSON\x1b[2J",)),
        student("eve\x1b[31m", status="failed", faults=("the sandbox broke [bold]x[/bold]",)),
    ),
    seconds=2.0,
    available=8.0,
    titles={"cylinder": "The cylinder", "cone": "The cone"},
)


def shown():
    out = io.StringIO()
    Console(file=out, width=160, color_system=None).print(report.table(GRADED))
    return out.getvalue()


def test_parts_count_over_submissions_that_could_be_read():
    cylinder, cone = report.parts(GRADED)
    assert (cylinder.title, cylinder.full, cylinder.some, cylinder.none, cylinder.waiting) == ("The cylinder", 2, 0, 1, 0)
    assert cylinder.mean == 8 / 12
    assert (cone.full, cone.some, cone.none, cone.waiting) == (0, 2, 0, 1)
    assert cone.mistakes == (("slant_as_height", 2),)


def test_the_summary_is_json():
    data = json.loads(json.dumps(report.summary(GRADED), allow_nan=False))
    assert data["looks"] == {"kim": 2, "zig": 2}
    assert data["mean"] == (6 + 1 + 4) / 3
    assert [part["name"] for part in data["parts"]] == ["check_cylinder", "check_cone"]
    assert len(data["broken"]) == len(data["faults"]) == 1


def test_the_table_names_everybody_and_what_went_wrong():
    text = shown()
    for said in ("ada", "6 / 8", "1 / 8", "late: -1", "4?", "could not be read", "The cone", "slant_as_height (2)", "not JSON"):
        assert said in text
    assert "3 graded in 2.0 s, 1.5 a second; sandbox level A" in text


def test_a_notebook_under_another_name_is_named_with_what_was_wanted():
    """Who handed in known-forms (1).ipynb has not handed in nothing."""
    notes = ("nb (1).ipynb: not a notebook of this assignment, left out", "nb.ipynb: not handed in")
    graded = GradeReport("geo", "A1", "A", (student("ada", cell("cylinder", 0.0), status="empty", notes=notes),))
    out = io.StringIO()
    Console(file=out, width=160, color_system=None).print(report.table(graded))
    assert "A1: 1 submission\n" in "\n".join(line.rstrip() + "\n" for line in out.getvalue().splitlines())
    assert f"ada: {'; '.join(notes)}" in out.getvalue()


def test_a_notebook_under_another_name_is_named_though_another_was_handed_in():
    """And who simply left one out has that in the table only."""
    stray, left_out = f"nb (1).ipynb: {STRAY}", "nb.ipynb: not handed in"
    rows = (
        student("ada", cell("cylinder", 4.0), missing=("nb",), notes=(stray, left_out)),
        student("bob", cell("cylinder", 4.0), missing=("nb",), notes=(left_out,)),
        student("eve", cell("cylinder", 4.0), notes=(stray,)),
    )
    out = io.StringIO()
    Console(file=out, width=160, color_system=None).print(report.table(GradeReport("geo", "A1", "A", rows)))
    assert f"ada: {stray}; {left_out}" in out.getvalue()
    assert ("bob:" in out.getvalue(), "eve:" in out.getvalue()) == (False, False)


def test_one_notebook_of_several_that_was_not_handed_in_is_named_in_the_table():
    """Beside the student, who has marks for the other; who handed in nothing at all has that said already."""
    rows = (
        student("ada", cell("cylinder", 4.0), missing=("solids", "sweeps\x1b[2J")),
        student("bob", cell("cylinder", 0.0), status="unchanged", missing=("solids",), penalty=1.0),
        student("eve", cell("cylinder", 0.0), status="empty", missing=("nb", "solids")),
    )
    graded = GradeReport("geo", "A1", "A", rows, available=8.0)
    out = io.StringIO()
    Console(file=out, width=160, color_system=None).print(report.table(graded))
    assert "solids, sweeps\ufffd[2J not handed in" in out.getvalue()
    assert "unchanged, solids not handed in, late: -1" in out.getvalue()
    assert out.getvalue().count("not handed in") == 2
    assert report.summary(graded)["missing"]["bob"] == ["solids"]


def test_names_and_messages_cannot_steer_the_terminal():
    text = shown()
    assert "\x1b" not in text
    assert "[bold]x[/bold]" in text


def test_an_empty_class_has_a_table_too():
    out = io.StringIO()
    Console(file=out, width=80).print(report.table(GradeReport("c", "A1", "A")))
    assert "0 submissions" in out.getvalue()
    assert report.summary(GradeReport("c", "A1", "A"))["mean"] is None


def test_titles_names_and_mistakes_are_no_markup():
    """A closing tag that was never opened would stop the report, a colour would spread, an escape would reach the terminal."""
    titles = {"cylinder": "On [/] and [red]red[/red] \x1b[2J", "cone": "The cone [/b]"}
    rows = (student("[/x] ada\x1b[2J", cell("cylinder", 1.0, mistake="slip[/]\x1b[2J"), cell("cone", 2.0)),)
    graded = GradeReport("geo", "A1 [/i]\x1b[2J", "A", rows, seconds=2.0, available=8.0, titles=titles)
    out = io.StringIO()
    Console(file=out, width=200, color_system=None, force_terminal=True).print(report.table(graded))
    assert "\x1b" not in out.getvalue()
    for said in ("On [/] and [red]red[/red]", "The cone [/b]", "[/x] ada", "slip[/]", "A1 [/i]"):
        assert said in out.getvalue()


def many(count):
    return GradeReport("geo", "A1", "A", Fresh(count), available=8.0)


class Fresh(Sequence):
    """Reports that are made anew whenever somebody asks, as those of a run are read from the disk."""

    def __init__(self, count):
        self.count = count

    def __len__(self):
        return self.count

    def __getitem__(self, place):
        if place >= self.count:
            raise IndexError
        return student(
            f"s{place}", cell("cylinder", 4.0 if place % 2 else 0.25), cell("cone", None), broken=("x",) * (place == 0)
        )


def printed(show):
    out = io.StringIO()
    show(Console(file=out, width=100, color_system=None))
    return out.getvalue().splitlines()


def test_a_large_class_is_shown_in_tables_of_the_same_widths_that_leave_nobody_out(monkeypatch):
    whole = printed(lambda console: report.show(many(25), console))
    assert whole == printed(lambda console: console.print(report.table(many(25))))
    monkeypatch.setattr(report, "PAGE", 12)
    paged = printed(lambda console: report.show(many(25), console))
    headings = [line for line in paged if line.startswith("┏") and len(line) == 100]  # those of parts are narrower
    assert headings == headings[:1] * 3
    assert sum("student" in line for line in paged) == 3
    assert sum("25 submissions" in line for line in paged) == 1
    rows = [[line for line in shown if line.startswith("│ s")] for shown in (whole, paged)]
    assert len(rows[0]) == 25
    assert rows[0] == rows[1]


def test_what_a_larger_class_takes_to_show_does_not_grow(monkeypatch):
    """The most that is held at a time; kept rows of this class would take 2 KB each."""
    monkeypatch.setattr(report, "PAGE", 10)
    peaks = []
    for count in (120, 20, 120):  # the first time things are loaded and remembered
        tracemalloc.start()
        try:
            with open(os.devnull, "w") as nowhere:
                report.show(many(count), Console(file=nowhere, width=100))
            peaks.append(tracemalloc.get_traced_memory()[1])
        finally:
            tracemalloc.stop()
    assert peaks[2] - peaks[1] < 100 * 500, peaks
