"""A sandbox that starts before it is known that it will be needed: taken where it is the right one, ended where it is not."""

import subprocess

import pytest

from autograder.errors import IsolationError
from autograder.notebook import session


@pytest.fixture
def started(monkeypatch):
    """Every sandbox that is started, in order."""
    found, start = [], session.Sandbox

    def recorded(**options):
        found.append(start(**options))
        return found[-1]

    monkeypatch.setattr(session, "Sandbox", recorded)
    return found


def shown(opener):
    with opener({}) as child:
        return child.run_cell("print('runs')").outputs[0]["text"]


def ended(box):
    """Whether its processes are gone."""
    try:
        box._process.wait(5)
    except subprocess.TimeoutExpired:
        return False
    return True


def test_the_right_one_is_taken(started):
    with session.Begun(session.needs([], ("numpy",)), None) as begun:
        with session.opened([], ("numpy",), None, None, begun=begun) as opener:
            assert shown(opener) == "runs\n"
        assert len(started) == 1
        assert ended(started[0])


@pytest.mark.parametrize("other", [{"packages": "all"}, {"withhold": ("scipy",)}, {"level": "A"}])
def test_any_other_is_left_and_ended(started, other):
    """Also one that would be as good: what a notebook finds must not hang on a guess."""
    wanted = {"packages": ("numpy",), "withhold": (), "level": None} | other
    given = wanted["packages"], wanted["level"], None, wanted["withhold"]
    with session.Begun(session.needs([], ("numpy",)), None) as begun, session.opened([], *given, begun=begun) as opener:
        assert shown(opener) == "runs\n"
        assert opener.box is started[1]
    assert ended(started[0])


def test_one_sandbox_serves_one_opening(started):
    """When the sandbox is lost, a run opens another: a new one."""
    with session.Begun(session.needs([], ("numpy",)), None) as begun:
        for _ in range(2):
            with session.opened([], ("numpy",), None, None, begun=begun) as opener:
                assert shown(opener) == "runs\n"
    assert len(started) == 2


def test_one_that_nobody_takes_is_ended(started):
    with session.Begun(session.needs([], ("numpy",)), None):
        pass
    assert ended(started[0])


def test_a_failure_is_told_to_whoever_needs_one(monkeypatch):
    def refused(**options):
        raise IsolationError("level A is not given on this machine: because of a test")

    monkeypatch.setattr(session, "Sandbox", refused)
    with (
        session.Begun(session.needs([], ("numpy",)), None) as begun,
        pytest.raises(IsolationError, match="because of a test"),
        session.opened([], ("numpy",), None, None, begun=begun),
    ):
        pass
