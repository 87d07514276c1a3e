"""The small version of ``campaign.py mutants``, and the tools of it held to what they claim."""

import json
import random
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from evidence_mutants import Outcome, tells
from evidence_mutation import mutations
from evidence_oracle import Oracle

from autograder.catalogue import shipped

HERE = Path(__file__).parent
EXERCISES = list(shipped())


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """The outcomes of 80 mutants, drawn with a seed that the long campaign does not use; by the script itself."""
    kept = tmp_path_factory.mktemp("mutants") / "outcomes.jsonl"
    command = [HERE / "campaign.py", "mutants", "--count", "80", "--seed", "150", "--jobs", "1", "--keep", kept]
    done = subprocess.run([sys.executable, *map(str, command)], capture_output=True, text=True, timeout=900, check=False)
    outcomes = [json.loads(line) for line in kept.read_text("utf-8").splitlines()] if kept.exists() else []
    return done, [Outcome(**{**outcome, "keys": tuple(outcome["keys"])}) for outcome in outcomes]


def test_no_wrong_answer_passes_and_no_right_one_is_refused(found):
    done, outcomes = found
    assert done.returncode == 0, done.stdout[-4000:] + done.stderr[-2000:]
    assert len(outcomes) == 80
    assert not [outcome for outcome in outcomes if outcome.passed_wrongly or outcome.refused_wrongly]


def test_most_changes_are_wrong_and_of_many_kinds(found):
    """Else nothing would have been shown."""
    _, outcomes = found
    wrong = [outcome for outcome in outcomes if outcome.opinion in ("differs", "endless")]
    assert len(wrong) >= 60
    assert len({outcome.kind for outcome in wrong}) >= 12
    assert len({outcome.exercise for outcome in wrong}) >= 30


def test_few_messages_say_neither_what_nor_where(found):
    _, outcomes = found
    failed = [outcome for outcome in outcomes if outcome.told]
    assert all(outcome.message for outcome in failed if outcome.tier != "error")
    assert sum(outcome.told == "neither" for outcome in failed) <= 0.1 * len(failed)


# --- the oracle ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("exercise", EXERCISES, ids=lambda exercise: exercise.id)
def test_the_oracle_tells_the_reference_from_every_listed_mistake(exercise):
    oracle = Oracle(exercise, ["one seed"], scattered=40)
    assert oracle.opinion(exercise.reference).word == "equal"
    for mistake in exercise.mistakes:
        assert oracle.opinion(mistake.formula).word == "differs", mistake.id


@pytest.mark.parametrize(("deviation", "word"), [(1e-12, "equal"), (1e-9, "borderline"), (1e-7, "differs")])
def test_the_oracle_leaves_undecided_what_is_near_the_tolerance(deviation, word):
    exercise = shipped().find("plane3")
    oracle = Oracle(exercise, ["one seed"])

    def shifted(u, w, p1, p2, p3):
        size = np.linalg.norm(np.ptp(np.array([p1, p2, p3, p2 + p3 - p1]), axis=0))
        return exercise.reference(u, w, p1, p2, p3) + [0, 0, deviation * size]

    assert oracle.opinion(shifted).word == word


def test_the_oracle_wants_every_shape_of_input_and_every_refusal():
    exercise = shipped().find("linear_sweep")
    oracle = Oracle(exercise, ["one seed"])

    def no_mesh(u, w, *data):
        return exercise.reference(u, w, *data) if np.shape(u) == np.shape(w) else np.zeros(3)

    def never_refuses(u, w, curve, direction, d):
        return exercise.reference(u, w, curve, direction if np.any(direction) else np.ones(3), d)

    assert oracle.opinion(no_mesh).place.endswith("a mesh")
    assert "no_direction" in oracle.opinion(never_refuses).place


# --- the changes -----------------------------------------------------------------------------------------------------------

SOURCE = """
def f(u, w, r):
    angle = 2 * np.pi * u
    if r < 0:
        raise ValueError
    total = np.zeros(3)
    for i in range(3):
        total += [r * np.cos(angle), r * np.sin(angle), w][i]
    return np.stack([total[0] - 1, total[1], total[2]], axis=-1) / np.linalg.norm(total)
"""


def test_changes_are_single_distinct_and_the_same_every_time():
    drawn = mutations(SOURCE, 60, random.Random(5))
    assert [m.source for m in drawn] == [m.source for m in mutations(SOURCE, 60, random.Random(5))]
    assert len({m.source for m in drawn}) == len(drawn) == 60
    for mutation in drawn:
        compile(mutation.source, "changed", "exec")


def test_every_kind_of_slip_is_among_them():
    kinds = {m.kind for m in mutations(SOURCE, 10_000, random.Random(5))}
    assert kinds >= {
        "sign", "operator", "index", "constant", "cos and sin", "dropped term", "dropped factor", "u and w", "axis",
        "comparison", "range", "normalisation", "degrees", "another name", "exchanged entries", "dropped case",
    }  # fmt: skip


# --- the children ----------------------------------------------------------------------------------------------------------

DANGEROUS = """
import os
os.environ["OPENBLAS_NUM_THREADS"] = "1"
import json, sys
sys.path.insert(0, sys.argv[1])
import evidence_mutants
from evidence_mutation import Mutation
from evidence_solutions import solutions
evidence_mutants.ONE_CALL, evidence_mutants.HARD = 0.2, 3
bodies = {
    "endless": "while True: pass",
    "leaves": "import os; os._exit(0)",
    "hungry": "return np.ones((1 << 33,))",
    "exits": "raise SystemExit",
    "deep": "return cylinder(u, w, r, h)",
    "right": "u, w = np.broadcast_arrays(u, w); t = 2 * np.pi * u; return np.stack([r * np.cos(t), r * np.sin(t), h * w], -1)",
}
work = [(solutions("cylinder")[0], Mutation(k, 1, "", "", f"def cylinder(u, w, r, h):\\n    {b}")) for k, b in bodies.items()]
print(json.dumps({o.kind: [o.opinion, o.passed, o.tier, o.told] for o in evidence_mutants.outcomes(work)}))
"""


def test_a_mutant_that_never_ends_eats_memory_or_leaves_is_reported_like_any_other():
    done = subprocess.run([sys.executable, "-c", DANGEROUS, str(HERE)], capture_output=True, text=True, timeout=300, check=True)
    told = json.loads(done.stdout.splitlines()[-1])
    assert told["right"] == ["equal", True, "identical", ""]
    assert told["endless"] == ["endless", False, "timeout", "gate"]
    assert told["deep"][1:] == [False, "error", "gate"]
    assert not any(passed for kind, (_, passed, *_) in told.items() if kind != "right")


@pytest.mark.parametrize(
    ("keys", "told"),
    [
        (("wrong.different", "where.point", "look.worst"), "neither"),
        (("right.edges", "wrong.different"), "place"),
        (("wrong.different", "fact.coordinate_wrong"), "place"),
        (("wrong.different", "fact.coordinate_sign"), "rule"),
        (("value.entries", "where.entry"), "neither"),
        (("value.transposed",), "rule"),
        (("value.shape.other",), "gate"),
        (("right.corners", "wrong.moved.translation"), "geometry"),
        (("error.exception", "where.line"), "gate"),
    ],
)
def test_what_a_message_tells(keys, told):
    assert tells(keys) == told


@pytest.mark.parametrize(
    ("opinion", "passed", "wrongly", "refused"),
    [
        ("differs", True, True, False),
        ("endless", True, True, False),
        ("equal", False, False, True),
        ("borderline", True, False, False),
    ],
)
def test_what_counts_as_wrong(opinion, passed, wrongly, refused):
    outcome = Outcome("e", "s", "k", 1, "", "", opinion, 1.0, "", passed)
    assert (outcome.passed_wrongly, outcome.refused_wrongly) == (wrongly, refused)
