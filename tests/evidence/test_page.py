"""docs/evidence.md is what the campaign wrote, and tells what was found: also what must be 0, and what was not shown."""

import json

import pytest
from evidence_mutants import Outcome
from evidence_page import PAGE, RESULTS, TOLD, counted, groups, rendered, table, totals
from evidence_solutions import solutions

from autograder.catalogue import shipped

KEPT = json.loads(RESULTS.read_text("utf-8"))


def test_the_page_is_not_written_by_hand():
    """To mend it: change evidence_page.py, then `python tests/evidence/campaign.py page`."""
    assert PAGE.read_text("utf-8") == rendered(KEPT)


def test_all_three_campaigns_are_there_with_command_date_and_version():
    assert list(KEPT) == ["mistakes", "styles", "mutants"]
    for name, campaign in KEPT.items():
        assert campaign["command"].split()[:3] == ["python", "tests/evidence/campaign.py", name]
        assert campaign["date"]
        assert " at " in campaign["version"]


def test_the_campaigns_were_long_and_found_what_must_be_nothing():
    """Numbers that the campaign wrote; whether the judge still is as good, the tests beside this one ask with fewer seeds."""
    mistakes, styles, mutants = (campaign["totals"] for campaign in KEPT.values())
    judged = (mistakes["random seeds"] + 1) * mistakes["exercises"]
    assert mistakes["exercises"] == styles["exercises"] == len(list(shipped()))
    assert mistakes["random seeds"] >= 50
    assert mistakes["reference: full marks"] == mistakes["stub: no marks"] == f"{judged} of {judged}"
    assert mistakes["mistakes in all"] == mistakes["named on the released data"] == mistakes["named under every random seed"]
    assert styles["seeds"] >= 200
    assert styles["fewest for one exercise"] >= 5
    assert styles["judgements"] == styles["right answers"] * styles["seeds"]
    assert styles["refused"] == 0
    assert mutants["wrong"] >= 2000
    assert mutants["passed all the same"] == mutants["refused all the same"] == 0


def outcome(opinion, *, passed=False, told=""):
    return Outcome("cylinder", "loops", "sign", 3, "u", "-u", opinion, 1.0, "", passed, told=told)


def test_outcomes_are_counted():
    """Each outcome in its column, wrong ones by what was told of them."""
    found = [
        outcome("equal", passed=True),
        outcome("equal", told="place"),
        outcome("borderline", passed=True),
        outcome("differs", passed=True),
        outcome("differs", told="named"),
        outcome("endless", told="gate"),
        outcome("differs", told="neither"),
    ]
    (row,) = counted(found)
    assert row == {
        "assignment": "A1", "exercise": "cylinder", "mutants": 7, "equivalent": 2, "not decided": 1, "wrong": 4,
        "passed wrongly": 1, "refused wrongly": 1, "told": {"named": 1, "gate": 1, "neither": 1},
    }  # fmt: skip
    assert table("mutants", [row]).splitlines()[-1] == "| A1 | cylinder | 7 | 2 | 1 | 4 | 1 | 1 | 1 | 1 | 0 | 0 | 0 | 1 |"
    sums = totals("mutants", [row, row])
    assert (sums["mutants"], sums["passed all the same"], sums["named"]) == (14, 2, "2 (25.0%)")
    assert list(sums)[-len(TOLD) :] == list(TOLD)
    assert "cylinder, sign" in groups(found[-1:])


def test_every_exercise_has_answers_to_change():
    assert not [exercise.id for exercise in shipped() if not solutions(exercise.id)]


@pytest.mark.parametrize("command", ["mistakes", "styles", "mutants"])
def test_tables_have_as_many_cells_in_every_row(command):
    rows = {
        "mistakes": {"assignment": "A1", "exercise": "x", "seeds": 1, "reference": 2, "stub": 2, "listed": 1, "mistakes": 1,
                     "public": 1, "random": 1},
        "styles": {"assignment": "A1", "exercise": "x", "styles": 6, "distinct": 6, "traits": [], "judged": 9, "refused": 0},
        "mutants": counted([outcome("differs", told="rule")])[0],
    }  # fmt: skip
    lines = table(command, [rows[command]]).splitlines()
    assert len({line.count("|") for line in lines}) == 1
