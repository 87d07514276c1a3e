"""A function that is wrong only because an earlier one of the notebook is: proved where it can be, else told as a fact."""

import numpy as np
import pytest

from autograder.catalogue import shipped
from autograder.diagnosis.earlier import Earlier
from autograder.errors import CallFailed, ExerciseError, SandboxError
from autograder.exercise import exercise
from autograder.judge import judge
from autograder.result import Verdict

BUILT = [(one, construction) for one in shipped() for construction in one.constructions]
SEED = b"hidden"


def built(construction, **instead):
    """A learner's function that is built as stated, on these functions and else on right ones."""
    blocks = [instead.get(block.id, block.reference) for block in construction.blocks]
    return lambda *arguments: construction.formula(*arguments, *blocks)


@pytest.mark.parametrize(("later", "construction"), BUILT, ids=lambda x: getattr(x, "id", ""))
def test_a_stated_construction_is_right(later, construction):
    """On right functions it is the reference itself."""
    assert judge(later, built(construction), seed=SEED, figure=False).tier == "identical"


@pytest.mark.parametrize(("later", "construction"), BUILT, ids=lambda x: getattr(x, "id", ""))
def test_every_listed_mistake_of_the_earlier_is_told_from_one_of_the_later(later, construction):
    """Where a mistake below makes the later function wrong, that alone is said to be the reason; it is put right below."""
    told = 0
    for block in construction.blocks:
        for mistake in block.mistakes:
            below = [Earlier(block, mistake.formula)]
            with np.errstate(all="ignore"):
                answer = built(construction, **{block.id: mistake.formula})
                verdict = judge(later, answer, seed=SEED, figure=False, search=False, earlier=lambda below=below: below)
            if verdict.outcome in ("passed", "not run") or "error" in {case.tier for case in verdict.cases}:
                continue  # it does not see that mistake, or cannot be called on it
            told += 1
            assert verdict.follows == (block.id,), (mistake.id, verdict.message)
            assert verdict.part("right").endswith(f"`{later.id}` does with your `{block.id}` just what it should.")
            assert verdict.part("look") == f"Put `{block.id}` right and check again; `{later.id}` needs no change."
            assert mistake.hint not in verdict.message
    assert told


def test_a_fault_of_its_own_is_not_blamed_on_the_earlier():
    """The earlier function is wrong and the later one too: a fact is told, and the later one's own diagnosis stays."""
    later, bernstein = shipped().find("bezier_patch"), shipped().find("bernstein")
    (construction,) = later.constructions
    wrong = next(m for m in bernstein.mistakes if judge(later, built(construction, bernstein=m.formula)).fraction < 1)

    def turned(u, w, P):
        return built(construction, bernstein=wrong.formula)(u, w, P) * [1, 1, -1]

    verdict = judge(later, turned, earlier=lambda: [Earlier(bernstein, wrong.formula)])
    assert verdict.follows == ()
    fact = "`bezier_patch` calls `bernstein`, which is not right yet: put that right first, then check again."
    assert verdict.part("look").startswith(fact)
    assert "only because" not in verdict.message
    listed = later.mistakes[0]
    verdict = judge(later, listed.formula, earlier=lambda: [Earlier(bernstein, wrong.formula)])
    assert (verdict.follows, verdict.mistake) == ((), listed.id)
    assert verdict.part("look") == f"{fact} {listed.hint}"


def test_marks_do_not_hang_on_it():
    """The words change, the verdict does not."""
    later, bernstein = shipped().find("bezier_patch"), shipped().find("bernstein")
    (construction,) = later.constructions
    for mistake in bernstein.mistakes:
        answer = built(construction, bernstein=mistake.formula)
        plain = judge(later, answer, seed=SEED, figure=False)
        told = judge(later, answer, seed=SEED, figure=False, earlier=lambda m=mistake: [Earlier(bernstein, m.formula)])
        assert (plain.fraction, plain.tier, plain.mistake, plain.cases) == (told.fraction, told.tier, told.mistake, told.cases)


def test_a_right_answer_never_asks_for_the_earlier_ones():
    """Judging them costs time, and there is nothing to explain."""
    later = shipped().find("bezier_patch")
    assert judge(later, later.reference, earlier=lambda: pytest.fail("asked for")).outcome == "passed"


def test_the_stub_of_an_earlier_function_is_not_taken_for_its_own():
    """NotImplementedError from below: the later function is written."""
    later, bernstein = shipped().find("bezier_patch"), shipped().find("bernstein")

    def stub(*arguments):
        raise NotImplementedError

    answer = built(later.constructions[0], bernstein=stub)
    verdict = judge(later, answer, earlier=lambda: [Earlier(bernstein, stub, written=False)])
    assert (verdict.outcome, verdict.fraction) == ("not run", 0.0)
    assert verdict.part("wrong") == "`bezier_patch` calls `bernstein`, which is not written yet."
    assert "bezier_patch is not written yet" not in verdict.message
    own = judge(later, stub, earlier=lambda: [Earlier(bernstein, bernstein.mistakes[0].formula)])
    assert own.part("wrong") == "bezier_patch is not written yet."


def test_an_error_below_explains_the_same_error_above():
    """The earlier function stops, and so does the later one, in the same way."""
    later, bernstein = shipped().find("bezier_patch"), shipped().find("bernstein")

    def stops(n, t):
        raise CallFailed("error", "index 4 is out of bounds", exception="IndexError", bases=("IndexError",))

    answer = built(later.constructions[0], bernstein=stops)
    verdict = judge(later, answer, earlier=lambda: [Earlier(bernstein, stops)])
    assert (verdict.tier, verdict.follows) == ("error", ("bernstein",))

    def otherwise(*arguments):
        raise CallFailed("error", "no", exception="KeyError", bases=("KeyError",))

    assert judge(later, otherwise, earlier=lambda: [Earlier(bernstein, stops)]).follows == ()


@pytest.mark.parametrize("failure", [SandboxError("gone"), CallFailed("died", "ended"), ValueError("no"), RecursionError()])
def test_an_earlier_function_that_cannot_be_called_costs_the_verdict_nothing(failure):
    """The question stays open; what was found stands."""
    later, bernstein = shipped().find("bezier_patch"), shipped().find("bernstein")

    def gone(*arguments):
        raise failure

    verdict = judge(later, later.mistakes[0].formula, earlier=lambda: [Earlier(bernstein, gone)])
    assert (verdict.outcome != "could not judge", verdict.follows) == (True, ())
    assert verdict.mistake == later.mistakes[0].id


def test_an_earlier_function_is_not_called_for_ever():
    """A construction that calls it point by point ends at a bound."""

    @exercise(points=1, title="Base", kind="value")
    def base(t):
        """Double it."""
        return 2.0 * t

    @base.data
    def some(rng):
        return {"t": 1.5}

    @exercise(points=1, title="Sum", kind="value")
    def total(n):
        """Add up doubles."""
        return sum(2.0 * i for i in range(n))

    @total.data
    def many(rng):
        return {"n": 1000}

    @total.built_from(base)
    def _(n, base):
        return sum(base(float(i)) for i in range(n))

    calls = []

    def tripled(t):
        calls.append(t)
        return 3.0 * t

    verdict = judge(total, lambda n: sum(3.0 * i for i in range(n)), earlier=lambda: [Earlier(base, tripled)])
    assert verdict.follows == ()
    assert len(calls) <= 200


def test_a_construction_must_fit_its_exercise():
    """Its arguments are those of the exercise, then one for each earlier exercise, under their names."""
    later, bernstein = shipped().find("bezier_patch"), shipped().find("bernstein")
    for formula in (lambda u, w, P: P, lambda u, w, P, basis: P, lambda P, bernstein: P):
        with pytest.raises(ExerciseError, match="one function for each earlier exercise"):
            later.built_from(bernstein)(formula)
    with pytest.raises(ExerciseError, match="built from"):
        later.built_from()(lambda u, w, P: P)


def test_it_goes_to_json_and_back():
    """The names of the earlier functions stay with the verdict; older verdicts have none."""
    verdict = Verdict("patch", "failed", 0.0, "different", "no", follows=("basis",))
    assert Verdict.from_json(verdict.to_json()) == verdict
    older = verdict.to_dict()
    del older["follows"]
    assert Verdict.from_dict(older).follows == ()
