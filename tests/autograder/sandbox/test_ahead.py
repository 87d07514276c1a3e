"""A zygote launched on the word of the last run: taken by who wants that very one, else ended, and its note is only a guess."""

import json

import pytest

from autograder.sandbox import Policy, Sandbox, ahead
from autograder.sandbox.launcher import launch

PLAIN = Policy(packages=("numpy",), preload=())


@pytest.fixture
def note(tmp_path):
    yield ahead.note(tmp_path, "A1")
    ahead.drop()


@pytest.fixture
def launched(monkeypatch):
    """Every zygote that was launched ahead, in order."""
    found = []

    def recorded(*given):
        found.append(launch(*given))
        return found[-1]

    monkeypatch.setattr(ahead, "launch", recorded)
    return found


def test_what_the_last_run_needed_is_taken(note, launched):
    ahead.remember(note, PLAIN, "A")
    ahead.begin(note, "A")
    (begun,) = launched
    with Sandbox(PLAIN) as box:
        assert box._process is begun.process
        with box.open() as notebook:
            assert notebook.run_cell("print(1)").outputs[0]["text"] == "1\n"
        assert ahead.taken(PLAIN, "A") is None, "it serves one sandbox"
    assert begun.process.returncode is not None


@pytest.mark.parametrize("other", [{"packages": "all"}, {"packages": ("numpy", "scipy")}, {"preload": ("json",)}])
def test_any_other_is_ended(note, launched, other):
    """A wrong guess shows nobody a package: what is wanted is started."""
    ahead.remember(note, Policy(**{"packages": ("numpy",), "preload": ()} | other), "A")
    ahead.begin(note, "A")
    (begun,) = launched
    with Sandbox(PLAIN) as box:
        assert box._process is not begun.process
        assert begun.process.returncode is not None
        with box.open() as notebook:
            assert notebook.run_cell("import scipy").outputs[0]["ename"] == "ModuleNotFoundError"


def test_another_level_is_not_begun(note, launched):
    ahead.remember(note, PLAIN, "A-")
    ahead.begin(note, "A")
    assert launched == []


def test_what_nobody_takes_is_ended(note, launched):
    ahead.remember(note, PLAIN, "A")
    ahead.begin(note, "A")
    ahead.drop()
    assert launched[0].process.returncode is not None


def test_one_that_has_died_is_not_taken(note, launched):
    ahead.remember(note, PLAIN, "A")
    ahead.begin(note, "A")
    launched[0].process.kill()
    launched[0].process.wait()
    with Sandbox(PLAIN) as box:
        assert box.alive


@pytest.mark.parametrize(
    "text", ["", "[]", "{", json.dumps({"packages": 3, "preload": [], "level": "A"}), json.dumps({"level": "A"})]
)
def test_a_note_that_is_none_begins_nothing(note, launched, text):
    ahead.begin(note, "A")
    note.write_text(text)
    ahead.begin(note, "A")
    assert launched == []


def test_a_note_that_names_what_is_not_installed_begins_nothing(note):
    ahead.remember(note, Policy(packages=("no-such-package",)), "A")
    ahead.begin(note, "A")
    assert ahead.taken(PLAIN, "A") is None


def test_a_note_is_written_once(note):
    ahead.remember(note, PLAIN, "A")
    first = note.stat().st_mtime_ns, note.stat().st_ino
    ahead.remember(note, PLAIN, "A")
    assert (note.stat().st_mtime_ns, note.stat().st_ino) == first
    ahead.remember(note.parent / "nowhere" / "note", PLAIN, "A")
    assert [path.name for path in note.parent.iterdir()] == [note.name]
