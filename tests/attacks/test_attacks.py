"""Every attack on Directrix wins nothing and harms nothing; some are shown to win where nothing stands in their way.

All attackers are graded as one class, by the command; as root and as an ordinary user. The whole table, with otter and with all
attacks on nbgrader, is ``table.py``.
"""

import os
import subprocess
import tempfile
from pathlib import Path

import pytest
from hostile_attacks import ATTACKS, TESTS
from hostile_rooms import Room, template
from table import HONEST, as_user

TOGETHER = {name: attack for name, attack in ATTACKS.items() if not attack.options}
EVERYBODY = {**HONEST, **TOGETHER}
# Under nbgrader: what each of these is known to win. If one does not, the looking is broken, or nbgrader has been mended.
WINS = {
    "skip_tag": "5 of 5 points",
    "no_cells": "5 of 5 points",
    "classmate_read": "a classmate's work seen",
    "environment_read": "the grader's token seen",
    "hidden_tests_read": "hidden tests seen",
    "network": "it got through",
    "script_in_text": "its script runs in the feedback page",
}
IN_THE_ROOM = {
    "mark_lowered": "the gradebook holds other marks",
    "source_written": "changed: source/ps1/lengths.ipynb",
    "daemon": "1 processes left",
}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return template(tmp_path_factory.mktemp("course"))


def graded(made, folder, grader, attacks, around=subprocess.run):
    room = Room(made, folder, attacks)
    return dict(zip(attacks, room.grade(grader, around).values(), strict=True)), room


@pytest.fixture(scope="module", params=["as this user", "as an ordinary user"])
def ours(request, made):
    """The class graded by Directrix, and its room: not below the folder of pytest, which every run of it closes to others."""
    around = subprocess.run
    if request.param == "as an ordinary user":
        if os.geteuid() != 0:
            pytest.skip("these tests are being run by an ordinary user as it is")
        around = as_user
    with tempfile.TemporaryDirectory(prefix="directrix-attacks-") as folder:
        yield graded(made, Path(folder), "ours", EVERYBODY, around)


def test_a_right_answer_gets_everything_and_a_wrong_one_nothing(ours):
    """Else the rest would show nothing."""
    seen, room = ours
    assert seen["right"].points == len(TESTS), room.said
    assert seen["wrong"].points == 0
    assert room.marks("zoe") == {**dict.fromkeys(TESTS, 0.0), "t_partial": 1.0}


@pytest.mark.parametrize("name", TOGETHER)
def test_the_attack_wins_nothing(ours, name):
    """No points, no secret, nothing changed, left running or written elsewhere."""
    assert str(ours[0][name]) == "nothing"


def test_forged_outputs_win_nothing_under_nbgraders_own_command(made, tmp_path):
    seen, room = graded(made, tmp_path, "ours", {"forged_outputs": ATTACKS["forged_outputs"]})
    assert str(seen["forged_outputs"]) == "nothing", room.said


def test_the_same_looking_sees_attacks_succeed_under_nbgrader(made, tmp_path):
    """Of a class graded by nbgrader: what each attacker took; and in a room of several, that harm was done."""
    seen, room = graded(made, tmp_path, "nbgrader", {"wrong": HONEST["wrong"]} | {n: ATTACKS[n] for n in (*WINS, *IN_THE_ROOM)})
    assert seen["wrong"].points == 0, room.said
    assert {name: said for name, said in WINS.items() if said not in str(seen[name])} == {}
    assert [said for said in IN_THE_ROOM.values() if said not in str(seen["wrong"])] == []


def test_there_are_enough_attacks_and_each_says_what_it_tries():
    assert len(ATTACKS) >= 60
    assert len({attack.tries for attack in ATTACKS.values()}) == len(ATTACKS)
