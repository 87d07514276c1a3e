"""The doctor believes what it saw: a level is given only if all attacks that prove something were stopped."""

import json

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
    assert any("apt install bubblewrap" in line for line in found.advice)


def test_a_level_that_does_not_start_is_not_given_and_says_why(attacked):
    found = attacked(A=IsolationError("no user namespaces"), A_minus=IsolationError("no bubblewrap"))
    assert found.level == "D"
    assert found.advice[:2] == ("A: no user namespaces", "A-: no bubblewrap")
    assert "no isolation" in found.meaning


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
