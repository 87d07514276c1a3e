"""The doctor believes what it saw: a level is given only if all attacks that prove something were stopped."""

import json
import shutil

import pytest

from autograder import doctor
from autograder.errors import IsolationError

ALL_WORK = dict.fromkeys(doctor.ATTACKS, "got through")


@pytest.fixture
def attacked(monkeypatch):
    """Make the attacks at each level come out as told; returns the examination."""

    def examine(**outcomes):
        def attack(level, facts, bare):
            through = outcomes[level.replace("-", "_minus")]
            if isinstance(through, Exception):
                raise through
            return tuple(doctor.Probe(name, "", "got through" if name in through else "stopped") for name in doctor.ATTACKS)

        monkeypatch.setattr(doctor, "attack", attack)
        monkeypatch.setattr(doctor, "without_sandbox", lambda facts: ALL_WORK)
        return doctor.examine()

    return examine


def test_level_a_if_everything_is_stopped(attacked):
    found = attacked(A=())
    assert (found.level, found.advice) == ("A", ())


def test_one_attack_that_got_through_costs_the_level(attacked):
    found = attacked(A=("tcp",), A_minus=())
    assert found.level == "A-"
    assert found.advice[0] == "A: not stopped: tcp"
    assert any("needs bubblewrap" in line for line in found.advice)


def test_a_level_that_does_not_start_is_not_given_and_says_why(attacked):
    found = attacked(A=IsolationError("no user namespaces"), A_minus=IsolationError("no bubblewrap"))
    assert found.level == "B"  # this machine has Landlock and a system call filter all the same
    assert found.advice[:2] == ("A: no user namespaces", "A-: no bubblewrap")
    assert "nothing is graded at level B" in found.advice[-1]


def test_without_landlock_or_a_filter_there_is_no_level(attacked, monkeypatch):
    for what, value in (("landlock", 0), ("system call filter", "no (OSError)")):
        known = doctor.machine() | {what: value}
        monkeypatch.setattr(doctor, "machine", lambda known=known: known)
        found = attacked(A=IsolationError("no"), A_minus=IsolationError("no"))
        assert (found.level, found.meaning) == ("D", "no isolation")
        monkeypatch.undo()


@pytest.mark.parametrize(
    ("system", "level", "said"), [("darwin", "C", "Linux virtual machine"), ("win32", "D", "WSL2: `wsl --install`")]
)
def test_other_systems_are_told_where_to_grade_and_nothing_is_attacked(monkeypatch, system, level, said):
    monkeypatch.setattr(doctor.sys, "platform", system)
    monkeypatch.setattr(doctor, "without_sandbox", None)
    if system == "win32":
        monkeypatch.delattr(doctor.os, "geteuid")
        monkeypatch.setattr(shutil, "which", lambda name, **_: None)  # the real one would ask Windows
    found = doctor.examine()
    assert (found.level, found.probes) == (level, ())
    assert said in found.advice[0]
    assert json.loads(json.dumps(found.to_dict()))["machine"]["user namespaces"] == "only on Linux"


def test_the_advice_is_of_what_forbids_namespaces_here(monkeypatch, tmp_path):
    """A setting that allows them is not complained of."""
    for number, (path, (forbids, advice)) in enumerate(doctor.SETTINGS.items()):
        place = tmp_path / str(number)
        monkeypatch.setattr(doctor, "SETTINGS", {str(place): (forbids, advice)})
        place.write_text(f"{1 - int(forbids)}\n")
        assert advice not in doctor._advice("D"), path
        place.write_text(f"{forbids}\n")
        assert advice in doctor._advice("D"), path
        monkeypatch.undo()
    monkeypatch.setattr(doctor, "CONTAINERS", (str(tmp_path),))
    assert doctor.IN_CONTAINERS in doctor._advice("D")
    monkeypatch.setattr(doctor, "CONTAINERS", ())
    monkeypatch.delenv("container", raising=False)
    assert doctor.IN_CONTAINERS not in doctor._advice("D")


def test_what_is_tried_can_fail_and_says_why():
    assert doctor._tried(doctor.FILTER) == "yes"
    assert doctor._tried("raise OSError(1, 'Operation not permitted')").startswith("no (PermissionError")


def test_an_attack_that_fails_without_the_sandbox_proves_nothing():
    probe = doctor._probe(None, "tcp", {}, "PermissionError")
    assert (probe.outcome, probe.detail) == ("proves nothing", "without the sandbox: PermissionError")


def test_the_report_is_plain_data(attacked):
    data = json.loads(json.dumps(attacked(A=()).to_dict()))
    assert {probe["name"] for probe in data["probes"]} == set(doctor.ATTACKS)
    assert data["machine"]["system"].startswith("Linux")


def test_an_attack_without_guard_is_told_from_a_harmless_one():
    """The decoys are what makes the difference."""
    with doctor._decoys() as facts:
        assert doctor._unguarded("read_gradebook", facts) == "got through"
        assert doctor._unguarded("read_gradebook", facts | {"decoy": __file__}) == "it did nothing"
        assert "Connection refused" in doctor._unguarded("abstract_socket", facts | {"abstract": "nobody-listens-here"})
