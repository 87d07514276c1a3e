"""Reports on disk: they come back as they were, leave nothing behind, survive a full disk; and a run keeps next to nothing."""

import contextlib
import copy
import gc
import importlib
import json
import os
import pathlib
import pickle
import resource
import stat
import tracemalloc

import pytest

from autograder import fleet
from autograder.errors import CourseError
from autograder.fleet import CellReport, GradeReport, StudentReport
from autograder.fleet.one import Outcome
from autograder.fleet.spool import Spool
from autograder.gradebook import NotebookMarks, Record
from autograder.notebook.marks import Mark


def report(id):
    cells = (
        CellReport("one", "test", "test", 0.1 + 0.2, 1.0, look=True, message="Grüße \N{SNOWMAN}"),
        CellReport("one", "essay", "written", None, 4.0),
    )
    return StudentReport(id, "graded", cells, 1 / 3, 5.0, notes=("a",), broken=("b", "c"), faults=("d",), name="Ada L")


REPORTS = (report("ada"), StudentReport("odd\udcff", "broken", broken=("no id",)), report("eve"))


def spooled(folder, reports=REPORTS):
    spool = Spool(folder)
    assert [spool.add(one) for one in reports] == list(range(len(reports)))
    return spool


def test_reports_come_back_as_they_were_and_as_often_as_one_likes(tmp_path):
    spool = spooled(tmp_path)
    assert len(spool) == 3
    for _ in range(2):
        assert tuple(spool) == REPORTS
    assert (spool[-1], spool[1:], spool[::-1]) == (REPORTS[2], REPORTS[1:], REPORTS[::-1])
    assert REPORTS[1] in spool
    assert spool == REPORTS == spool
    assert spool != REPORTS[:2]
    assert spool != (*REPORTS[:2], REPORTS[0])
    for outside in (3, -4):
        with pytest.raises(IndexError):
            spool[outside]


def test_a_copy_holds_the_reports_themselves(tmp_path):
    """It may cross to another process, which does not have the file."""
    graded = GradeReport("geo", "A1", "A", spooled(tmp_path))
    assert copy.deepcopy(graded).students == pickle.loads(pickle.dumps(graded)).students == REPORTS
    assert type(pickle.loads(pickle.dumps(graded)).students) is tuple


def test_nobody_else_can_read_them_and_nothing_is_left(tmp_path):
    spool = spooled(tmp_path)
    state = os.fstat(spool._file)
    assert (stat.S_IMODE(state.st_mode), state.st_nlink, state.st_dev) == (0o600, 0, tmp_path.stat().st_dev)
    assert os.listdir(tmp_path) == []
    file = spool._file
    del spool
    with pytest.raises(OSError, match="Bad file descriptor"):
        os.fstat(file)


@contextlib.contextmanager
def files_of_at_most(size):
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize("room", [0, 10, 700, 1100])
def test_what_the_disk_does_not_take_is_not_lost(tmp_path, room):
    """No room at all, room for a part of a report, for some; and room again afterwards."""
    with files_of_at_most(room):
        spool = spooled(tmp_path)
    assert tuple(spool) == REPORTS
    assert spool._held, "the limit stopped nothing"
    spool.add(REPORTS[0])
    assert tuple(spool) == (*REPORTS, REPORTS[0])
    assert 3 not in spool._held


def test_where_no_file_can_be_made_reports_stay_in_memory(tmp_path):
    assert tuple(spooled(tmp_path / "nowhere")) == REPORTS


def test_a_report_that_cannot_be_read_back_is_an_error_with_the_way_out(tmp_path):
    spool = spooled(tmp_path)
    os.ftruncate(spool._file, 900)
    assert spool[0] == REPORTS[0]
    with pytest.raises(CourseError, match=r"cannot be read back .* the file has been cut; the marks are in the gradebook"):
        tuple(spool)


def test_the_json_that_is_written_piece_by_piece_is_that_of_the_whole(tmp_path):
    readable = (REPORTS[0], REPORTS[2])
    for students in ((), spooled(tmp_path, readable)):
        graded = GradeReport("geo", "A1", "A", students, 2.0, 8.0, {"cone": "The cone"}, {"one.ipynb: test": "it prints"})
        with (tmp_path / "out").open("w+") as file:
            graded.write_json(file)
            file.seek(0)
            assert json.load(file) == json.loads(graded.to_json()) == graded.to_dict()
    assert graded.to_dict()["failures"] == ["ada: b", "ada: c", "eve: b", "eve: c", "ada: d", "eve: d"]


def test_a_run_keeps_next_to_nothing_of_a_submission(ordinary, monkeypatch):
    """Of the Python objects made between the 50th and the last of 200 submissions, what is still there at the end, report too.

    A report as an object takes five times the bound. Names of files are left out: Python keeps those of all paths in one
    table, which grows by doubling.
    """
    marks = {name: Mark(1.0) for name in ("test_square", "test_half", "code_answer", "why")}

    def graded_at_once(plan, student, submitted):
        cells = tuple(CellReport("one", name, "test", 1.0, 1.0, message=f"{student} {name} " * 20) for name in marks)
        record = Record(student, None, {"one": NotebookMarks(marks), "two": NotebookMarks(missing=True)})
        return Outcome(student, record, {"one.ipynb": b"{}"}, StudentReport(student, "graded", cells), submitted.digest)

    monkeypatch.setattr(importlib.import_module("autograder.fleet.task"), "grade_one", graded_at_once)
    for number in range(200):
        ordinary.hand_in(f"s{number:03}", {"one": "{}"})
    course = ordinary.course()
    fleet.grade(course, "ps1", workers=1, students=["s000"])  # what is loaded and compiled once

    def told(done, total, student):
        if done == 50:
            gc.collect()
            tracemalloc.start()

    try:
        graded = fleet.grade(course, "ps1", workers=1, progress=told)
        gc.collect()
        found = tracemalloc.take_snapshot().filter_traces([
            tracemalloc.Filter(False, pathlib.__file__), tracemalloc.Filter(False, tracemalloc.__file__),
        ])  # fmt: skip
    finally:
        tracemalloc.stop()
    assert [student.status for student in graded.students] == ["unchanged", *["graded"] * 199]
    assert len(json.dumps(graded.students[-1].to_dict())) > 1500
    held = sum(trace.size for trace in found.traces) / 150
    assert held < 600, f"{held:.0f} bytes a submission"
