"""Members whose code can be run here: what the judge says of them is what the class says they earn."""

import pytest

from autograder.catalogue import shipped
from autograder.demo import cohort
from autograder.judge import judge

HONEST = [
    (assignment, member)
    for assignment in shipped().assignments
    for member in cohort(assignment.name)
    if member.kind in ("right", "mistake", "partial") or member.student_id.endswith("skip-execution")
]


@pytest.mark.parametrize(("assignment", "member"), HONEST, ids=[f"{a.name}-{m.student_id}" for a, m in HONEST])
def test_earns_what_its_content_is_worth_on_hidden_data(assignment, member, run):
    """Under a hidden seed, as in grading: the expected share of each exercise, and each mistake under its own name."""
    for id, call in run(assignment, member).items():
        verdict = judge(assignment.exercises[id], call, seed=b"hidden", figure=False)
        assert verdict.outcome != "could not judge", verdict.message
        assert verdict.fraction == pytest.approx(member.expected[id]), f"{id}: {verdict.tier}. {verdict.message}"
        assert verdict.mistake == member.mistakes.get(id), f"{id}: {verdict.message}"
        if member.kind == "right":
            assert verdict.tier == "identical", f"{id}: {verdict.message}"
