"""The main job on the sample class of A1: released, handed in, graded in the sandbox, read by nbgrader and graded by it too."""

import ctypes
import hashlib
import json
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
from contextlib import closing, contextmanager
from pathlib import Path
from types import SimpleNamespace

import pytest

from autograder import demo

NAME, NOTEBOOK = "A1", "known-forms"
PR_SET_CHILD_SUBREAPER = 36
MARKS = """
    SELECT student.id, base_cell.name, grade.auto_score, grade.needs_manual_grade
    FROM grade JOIN submitted_notebook ON grade.notebook_id = submitted_notebook.id
    JOIN submitted_assignment ON submitted_notebook.assignment_id = submitted_assignment.id
    JOIN student ON submitted_assignment.student_id = student.id JOIN base_cell ON grade.cell_id = base_cell.id
    ORDER BY 1, 2
"""


def digests(folder):
    """Every file below a folder with the hash of its bytes."""
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest() for p in folder.rglob("*") if p.is_file()}


def marks(course):
    """Every mark in the gradebook, read with nothing but SQL."""
    with closing(sqlite3.connect(f"file:{course / 'gradebook.db'}?mode=ro", uri=True)) as book, book:
        return book.execute(MARKS).fetchall()


@contextmanager
def orphans_come_here():
    """Whatever a command leaves running becomes a child of this process; gives a function that lists them."""
    libc = ctypes.CDLL(None, use_errno=True)
    assert libc.prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0) == 0
    before = children()
    try:
        yield lambda: {pid: line for pid, line in children().items() if pid not in before}
    finally:
        libc.prctl(PR_SET_CHILD_SUBREAPER, 0, 0, 0, 0)


def children():
    """Command lines of the living children of this process by process id."""
    found = {}
    for folder in Path("/proc").iterdir():
        if folder.name.isdigit():
            try:
                state, parent = (folder / "stat").read_text().rpartition(")")[2].split()[:2]
                if int(parent) == os.getpid() and state != "Z":
                    found[int(folder.name)] = (folder / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
            except OSError:
                continue  # it ended meanwhile
    return found


def run(*command, cwd, code=0):
    scripts = str(Path(sys.executable).parent)
    environment = {**os.environ, "PATH": os.pathsep.join([scripts, os.environ.get("PATH", "")])}
    result = subprocess.run([str(part) for part in command], cwd=cwd, capture_output=True, text=True, env=environment)
    assert result.returncode == code, f"{result.stdout[-3000:]}\n{result.stderr[-3000:]}"
    return result


@pytest.fixture(scope="module")
def course(tmp_path_factory):
    """The demo, run as a user runs it."""
    folder = tmp_path_factory.mktemp("demo") / "course"
    with orphans_come_here() as orphans:
        done = run(
            sys.executable, "-m", "autograder", "demo", "--assignment", NAME, "--dir", folder, "--json", cwd=folder.parent
        )
        left_running = orphans()
    return folder, {**json.loads(done.stdout)[NAME], "left running": left_running}


@pytest.fixture(scope="module")
def report(course):
    return {student["student"]: student for student in course[1]["students"]}


def test_the_demo_ends_well_and_nothing_in_it_surprises(course):
    """Exit code 0, and every member of the class got exactly what its honest content is worth."""
    assert course[1]["surprises"] == []
    assert course[1]["level"] == "A"


def test_the_class_is_as_large_and_as_various_as_learners_are(report):
    """At least sixteen notebooks: right, each listed mistake, broken ones, and six that cheat."""
    members = demo.cohort(NAME)
    assert len(members) >= 16
    assert {member.kind for member in members} == {"right", "mistake", "partial", "broken", "cheat"}
    assert sum(member.kind == "cheat" for member in members) >= 6
    assert set(report) == {member.student_id for member in members}


def test_no_cheat_gets_more_than_its_honest_content_earns(course, report):
    """Cell by cell, in the gradebook itself."""
    book = {(student, cell): score for student, cell, score, _ in marks(course[0])}
    available = {cell["name"]: cell["available"] for cell in report["s01-vectorised"]["cells"]}
    cheats = [member for member in demo.cohort(NAME) if member.kind == "cheat"]
    for member in cheats:
        for id, share in member.expected.items():
            cell = f"check_{id}"
            assert (book[member.student_id, cell] or 0.0) <= (share or 0.0) * available[cell] + 1e-6, (member.student_id, id)


def test_a_broken_notebook_is_named_and_loses_only_what_cannot_be_run(course, report):
    """The truncated one is reported; those that kill their process keep what they earned."""
    assert any("not valid JSON" in failure for failure in course[1]["failures"])
    for member in demo.cohort(NAME):
        if member.kind == "broken" and member.expected is not None:
            got = {cell["name"]: cell["points"] for cell in report[member.student_id]["cells"]}
            full = sum(1 for share in member.expected.values() if share == 1.0)
            assert sum(1 for id, share in member.expected.items() if share == 1.0 and got[f"check_{id}"]) == full


def test_an_orphan_would_be_seen():
    """The next test can fail: a process that outlives its starter is found."""
    with orphans_come_here() as orphans:
        subprocess.run(["sh", "-c", "sleep 30 >/dev/null 2>&1 &"], check=True)
        (found,) = orphans()
        os.kill(found, signal.SIGKILL)
        os.waitpid(found, 0)


def test_nothing_of_a_submission_is_left_running(course):
    """No process outlives the grading: not the daemons that cheats try to start, not the sandbox itself."""
    assert course[1]["left running"] == {}


def test_what_was_handed_in_is_as_it_was(course):
    """Submissions made afresh are the same byte for byte: no cheat wrote to its own folder or to a classmate's."""
    folder, _ = course
    fresh = folder.parent / "fresh"
    folders = SimpleNamespace(path=lambda step, student, name: fresh / student / name)
    demo.submit(folder / "release" / NAME / f"{NOTEBOOK}.ipynb", folders, NAME)
    assert {key: value for key, value in digests(folder / "submitted").items() if not key.endswith("timestamp.txt")} == digests(
        fresh
    )


def test_grading_twice_changes_nothing(course):
    """Neither a mark nor a byte of what was graded."""
    folder, _ = course
    before = marks(folder), digests(folder / "autograded")
    again = run(sys.executable, "-m", "autograder", "grade", NAME, "--course", folder, "--json", cwd=folder, code=1)
    assert {student["status"] for student in json.loads(again.stdout)["students"]} == {"unchanged", "broken"}
    assert (marks(folder), digests(folder / "autograded")) == before


def test_nbgraders_own_api_reads_the_gradebook(course, report):
    """Scores of all students, as formgrader shows them."""
    folder, _ = course
    script = (
        "import json, sys; from nbgrader.api import Gradebook\n"
        f"with Gradebook('sqlite:///{folder / 'gradebook.db'}', 'course') as book:\n"
        f"    print(json.dumps({{s.student.id: s.score for s in book.assignment_submissions('{NAME}')}}))"
    )
    scores = json.loads(run(sys.executable, "-W", "ignore", "-c", script, cwd=folder).stdout)
    assert scores == {id: student["score"] for id, student in report.items()}


def test_nbgrader_autograde_with_the_one_line_gives_the_same_marks(course, tmp_path):
    """Stock nbgrader, our line in its configuration, an ungraded copy of the course: table by table the same."""
    folder, _ = course
    copy = tmp_path / "course"
    shutil.copytree(folder, copy, ignore=shutil.ignore_patterns("autograded", "feedback"), symlinks=True)
    with closing(sqlite3.connect(copy / "gradebook.db")) as book, book:
        for table in ("grade", "comment", "submitted_notebook", "submitted_assignment", "student"):
            book.execute(f"DELETE FROM {table}")
    run(sys.executable, "-m", "nbgrader", "autograde", NAME, cwd=copy, code=1)  # 1: the truncated notebook is named
    assert marks(copy) == marks(folder)


def test_feedback_is_one_page_a_notebook_that_needs_no_network(course):
    """The named mistake stands in it, and no address of another machine is asked for anything."""
    page = (course[0] / "feedback" / "s07-mistakes-1" / NAME / f"{NOTEBOOK}.html").read_text("utf-8")
    assert "Cylinder from its known form" in page
    assert 'src="http' not in page
    assert "cdn.plot.ly" not in page.split("<script")[0]
