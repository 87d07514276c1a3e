"""Every attack is stopped inside and works outside: as root and as an ordinary user, at level A and at A-."""

import json
import re
import sys
from pathlib import Path

import pytest

from autograder import doctor
from autograder.sandbox import Policy, Sandbox

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


@pytest.mark.parametrize("level", ["A", "A-"])
def test_if_memory_runs_short_a_notebook_goes_first_and_whatever_ends_it_leaves_no_core(level):
    """A program that takes cores for the whole machine, as many systems have one, asks for them also where their limit is 0."""
    with Sandbox(Policy(packages=(), preload=()), level) as box, box.open() as session:
        (pid,) = re.findall(r"^Pid:\s+(\d+)$", Path(f"/proc/self/fdinfo/{session._process._pidfd}").read_text(), re.MULTILINE)
        process = Path(f"/proc/{pid}")
        assert process.joinpath("oom_score_adj").read_text() == "1000\n"
        assert re.search(r"^Max core file size +1 +1 ", process.joinpath("limits").read_text(), re.MULTILINE)
        assert process.joinpath("stat").stat().st_uid == 0  # of a process that may be dumped it is the process's own user
        here = session.run_cell("import psutil; open('/proc/self/status').read()[:5], psutil.Process().memory_info().rss > 0")
        assert here.status == ("ok" if level == "A" else "error")  # where there is a /proc, it can be read as before
