"""Every attack is stopped inside and works outside: as root and as an ordinary user, at level A and at A-."""

import json
import sys

import pytest

from autograder import doctor

# What an ordinary user may not do anyway, so that its being stopped proves nothing there.
ONLY_ROOT = {"become_root", "write_packages"}


@pytest.fixture(scope="module")
def facts():
    with doctor._decoys() as known:
        yield known


@pytest.fixture(scope="module")
def bare(facts):
    return doctor.without_sandbox(facts)


@pytest.fixture(scope="module", params=["A", "A-"])
def probes(request, facts, bare):
    return {probe.name: probe for probe in doctor.attack(request.param, facts, bare)}


@pytest.mark.parametrize("name", doctor.ATTACKS)
def test_the_attack_works_without_the_sandbox(bare, name):
    """Else its being stopped would prove nothing."""
    if name in ONLY_ROOT and doctor.os.geteuid() != 0:
        assert bare[name] != "got through"
    else:
        assert bare[name] == "got through"


@pytest.mark.parametrize("name", doctor.ATTACKS)
def test_the_attack_is_stopped(probes, bare, name):
    expected = "stopped" if bare[name] == "got through" else "proves nothing"
    assert probes[name].outcome == expected, probes[name].detail


def test_there_are_attacks_of_every_kind():
    assert len(doctor.ATTACKS) >= 40
    assert all(getattr(doctor.attacks, name).__doc__ for name in doctor.ATTACKS)


@pytest.fixture(scope="module")
def as_user(as_ordinary_user, tmp_path_factory):
    """The doctor's report, run by an ordinary user (in this process's place if we are one already)."""
    done = as_ordinary_user([sys.executable, "-m", "autograder.doctor"], tmp_path_factory.mktemp("user"))
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_an_ordinary_user_reaches_level_a(as_user):
    assert as_user["level"] == "A"
    assert as_user["machine"]["user"].startswith("uid ")


def test_every_attack_is_stopped_for_an_ordinary_user(as_user):
    outcomes = {probe["name"]: probe["outcome"] for probe in as_user["probes"]}
    assert set(outcomes) == set(doctor.ATTACKS)
    assert {name for name, outcome in outcomes.items() if outcome != "stopped"} <= ONLY_ROOT


def test_the_sandbox_tests_pass_for_an_ordinary_user(as_ordinary_user, tmp_path):
    """Sessions, endings and answers do not hang on being root (the doctor has tried the limits)."""
    if doctor.os.geteuid() != 0:
        pytest.skip("these tests are being run by an ordinary user as it is")
    files = [f"tests/autograder/sandbox/test_{name}.py" for name in ("box", "calls")]
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-n", "2", *files]
    done = as_ordinary_user(command, tmp_path)
    assert done.returncode == 0, done.stdout[-5000:] + done.stderr[-2000:]
    assert " passed" in done.stdout
