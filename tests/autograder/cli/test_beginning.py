"""What `directrix grade` begins before its options are read: only what it will need, and never an error."""

from pathlib import Path

import pytest

from autograder.cli import beginning


@pytest.fixture
def begun(monkeypatch):
    """Notes and levels that were begun with."""
    found = []
    monkeypatch.setattr(beginning.ahead, "begin", lambda note, level: found.append((note, level)))
    return found


@pytest.fixture
def course(tmp_path, monkeypatch):
    for folder in ("submitted/ada/A1", "submitted/ben/A1", "autograded/ada/A1"):
        (tmp_path / folder).mkdir(parents=True)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("line", "level"),
    [
        ("A1", "A"),
        ("--workers 2 A1", "A"),
        ("A1 --level A-", "A-"),
        ("--student=ada --level=A A1 --json", "A"),
        ("A1 --scheduler= --course .", "A"),
    ],
)
def test_a_class_to_grade_is_begun(course, begun, line, level):
    beginning.begin(line.split())
    assert begun == [(Path(".directrix/sandbox.A1.json"), level)]


@pytest.mark.parametrize(
    "line", ["", "--force", "A1 --help", "A1 --scheduler tls://x:1", "A1 --course nowhere", "A2", "--student"]
)
def test_what_grades_nothing_here_is_not(course, begun, line):
    beginning.begin(line.split())
    assert begun == []


def test_what_is_graded_already_is_not_unless_forced(course, begun):
    (course / "autograded/ben/A1").mkdir(parents=True)
    beginning.begin(["A1"])
    assert begun == []
    beginning.begin(["A1", "--force"])
    assert len(begun) == 1


def test_the_course_may_be_elsewhere(course, begun, monkeypatch):
    monkeypatch.chdir("/")
    beginning.begin(["A1", "--course", str(course)])
    assert begun == [(course / ".directrix/sandbox.A1.json", "A")]
