"""From a course folder to the terminal, JSON and the page: hostile submissions are read, shown and never obeyed."""

import hashlib
import io
import json
import os
import re
import subprocess
import sys
from html.parser import HTMLParser

import pytest
from rich.console import Console

from autograder import integrity
from autograder.course import Course
from autograder.errors import CourseError
from autograder.integrity.page import page
from autograder.integrity.table import table
from autograder.integrity.work import MOST_CODE
from tests.autograder.integrity.integrity_class import ORIGINAL, parts, renamed

STUB = "# YOUR CODE HERE\nraise NotImplementedError()"
HELPER = "def helper(points, weights):\n" + "\n".join(
    f"    x{i} = points[{i}] * weights - np.sin(x{i - 1})" for i in range(1, 9)
)


def notebook(sources, added=()):
    """A notebook of task cells; ``added`` cells have no name."""
    cells = [{"cell_type": "code", "source": HELPER, "metadata": {"nbgrader": {"grade_id": "helper", "locked": True}}}]
    for name, source in sources.items():
        about = {"grade_id": name, "solution": True, "grade": False, "locked": False}
        cells.append({"cell_type": "code", "source": source, "metadata": {"nbgrader": about}})
        check = {"grade_id": f"check_{name}", "solution": False, "grade": True, "locked": True, "points": 1}
        cells.append({"cell_type": "code", "source": f"check({name})", "metadata": {"nbgrader": check}})
    cells += added
    return {"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": cells}


@pytest.fixture
def course(tmp_path):
    """A released notebook; Zoe and Max hand in the same work under other names; ten more hand in other texts."""
    folder = tmp_path / "course"
    (folder / "release" / "A1").mkdir(parents=True)
    (folder / "nbgrader_config.py").write_text("c = get_config()\n")
    (folder / "release" / "A1" / "known-forms.ipynb").write_text(json.dumps(notebook(dict.fromkeys(ORIGINAL, STUB))))

    def hand_in(student, content):
        place = folder / "submitted" / student / "A1"
        place.mkdir(parents=True)
        text = content if isinstance(content, str) else json.dumps(content)
        (place / "known-forms.ipynb").write_text(text)
        return place

    hand_in("zoe", notebook(ORIGINAL))
    hand_in("max", notebook({name: renamed(source) for name, source in ORIGINAL.items()}))
    for number in range(10):
        lines = "\n".join(
            f"    y{i} = {'+-*/'[(number + i) % 4]} u[{i}] if w > {number}{i} else r.{'abcdefghij'[number]}{i}"
            for i in range(6)
        )
        hand_in(f"other{number}", notebook({"cylinder": f"def cylinder(u, w, r, h):\n{lines}"}))
    return folder, hand_in


def state(folder):
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else "folder"
        for path in sorted(folder.rglob("*"))
        if not path.is_symlink()
    }


def shown(report):
    out = io.StringIO()
    Console(file=out, width=150, force_terminal=True, color_system="truecolor").print(table(report))
    return out.getvalue()


def test_the_command_reads_and_changes_nothing(course, tmp_path):
    """Table, JSON and page agree; the course folder is the same to the byte, without a gradebook or a secret."""
    folder, _ = course
    before = state(folder)
    html = tmp_path / "similar.html"
    command = [
        sys.executable,
        "-m",
        "autograder",
        "similar",
        "A1",
        "--course",
        str(folder),
        "--json",
        "--top",
        "3",
        "--html",
        str(html),
    ]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert ran.returncode == 0, ran.stderr
    data = json.loads(ran.stdout)
    assert (data["students"], len(data["pairs"]) <= 3) == (12, True)
    first = data["pairs"][0]
    assert (first["students"], first["striking"]) == (["max", "zoe"], True)
    assert first["runs"][0]["first"]["exercise"] == first["runs"][0]["second"]["exercise"]
    assert "max | zoe" in ran.stderr
    assert "a reason to look, not a finding" in " ".join(ran.stderr.split())
    assert "zoe" in html.read_text("utf-8")
    assert state(folder) == before


def test_hostile_submissions_are_named_and_the_others_compared(course):
    """Links, broken JSON, cells that are none, floods of code: notes, and Zoe and Max are still found."""
    folder, hand_in = course
    (hand_in("linked", "{}") / "known-forms.ipynb").unlink()
    (folder / "submitted" / "linked" / "A1" / "known-forms.ipynb").symlink_to("/etc/passwd")
    hand_in("broken", '{"cells": [')
    odd = [
        7,
        None,
        {"cell_type": "code"},
        {"cell_type": "code", "source": 5, "metadata": 5},
        {"cell_type": "code", "source": ["a = '", "\ud800'"]},
    ]
    odd.append(
        {"cell_type": "code", "source": "x = 1\n", "metadata": {"nbgrader": {"grade_id": ["cylinder"], "solution": True}}}
    )
    hand_in("odd", notebook(ORIGINAL, odd))
    hand_in("flood", notebook({"cylinder": "((((" * MOST_CODE}))
    os.mkfifo(folder / "submitted" / "zoe" / "A1" / "pipe.ipynb")
    report = integrity.similar(Course(folder), "A1", top=5)
    handed_in = {path.parent.name for path in (folder / "submitted").glob("*/A1")}
    assert report.found.students == len(handed_in - {"linked", "broken"})
    assert {"max", "zoe", "odd"} == {student for pair in report.found.striking for student in pair.students}
    notes = " ".join(report.notes)
    assert "broken, known-forms: the notebook is not valid JSON" in notes
    assert "linked: there is no notebook" in report.notes
    assert f"flood: more than {MOST_CODE} characters" in notes
    json.dumps(report.to_dict(), allow_nan=False).encode()
    shown(report)
    page(report).encode("utf-8", "replace")


class _Tags(HTMLParser):
    def __init__(self):
        super().__init__()
        self.seen, self.attributes = set(), set()

    def handle_starttag(self, tag, attrs):
        self.seen.add(tag)
        self.attributes |= {name for name, _ in attrs}


def test_names_and_code_steer_neither_the_terminal_nor_the_page(course):
    """A name with colours, markup and a script; code that ends the page's own tags."""
    folder, hand_in = course
    evil = "\x1b]0;owned\x07\x1b[31m[bold]<script>alert(1)<\\script>\u202e"
    code = {
        name: f"# tab\there </pre></span><script>alert(1)</script><img src=x onerror=alert(1)>\x1b[2J\n{source}"
        for name, source in ORIGINAL.items()
    }
    hand_in(evil, notebook(code))
    report = integrity.similar(Course(folder), "A1", top=3)
    assert evil in {student for pair in report.found.striking for student in pair.students}
    terminal = re.sub(r"\x1b\[[0-9;]*m", "", shown(report))  # Rich's own colours
    assert "\x1b" not in terminal
    assert "\u202e" not in terminal
    assert "[bold]<script>" in terminal.replace("\n", "")
    html = page(report)
    tags = _Tags()
    tags.feed(html)
    assert not tags.seen & {"script", "img", "iframe", "link", "object", "form", "a"}
    assert not {name for name in tags.attributes if name.startswith("on") or name in ("src", "href")}
    assert "\x1b" not in html
    assert "# tab   here" in html
    assert "default-src &#39;none&#39;" in html
    assert "&lt;/pre&gt;&lt;/span&gt;&lt;script&gt;" in html


def test_locked_and_released_cells_are_nobodys_work(course):
    """A locked cell is put back before grading, so what is written there does not count; nor do released texts elsewhere."""
    folder, hand_in = course
    for student in ("kim", "lea"):
        handed = notebook(dict.fromkeys(ORIGINAL, STUB), [{"cell_type": "code", "source": HELPER, "metadata": {}}])
        handed["cells"][0]["source"] = "\n".join(ORIGINAL.values())
        hand_in(student, handed)
    report = integrity.similar(Course(folder), "A1", top=200)
    assert not {"kim", "lea"} & {student for pair in report.found.pairs for student in pair.students}


def test_without_anything_handed_out_or_in_there_is_no_report(tmp_path):
    """Both are said with the place that was looked at."""
    (tmp_path / "nbgrader_config.py").write_text("c = get_config()\n")
    with pytest.raises(CourseError, match="without what was handed out, all work would look alike"):
        integrity.similar(Course(tmp_path), "A1")
    (tmp_path / "release" / "A1").mkdir(parents=True)
    (tmp_path / "release" / "A1" / "n.ipynb").write_text(json.dumps(notebook(ORIGINAL)))
    with pytest.raises(CourseError, match="nobody has handed in A1"):
        integrity.similar(Course(tmp_path), "A1")


def test_small_classes_and_empty_reports_say_so():
    """Three students: a pair, and a warning that nobody can tell what is rare; one student: no pairs."""
    work = integrity.Class(parts={"one": parts(ORIGINAL), "two": parts(ORIGINAL), "six": parts({"cylinder": "x = 1"})})
    report = integrity.report_on(work, "A1")
    assert "fewer than 10" in shown(report)
    assert "In so small a class" in page(report)
    alone = integrity.report_on(integrity.Class(parts={"one": parts(ORIGINAL)}), "A1")
    assert "No two students share anything rare" in page(alone)
