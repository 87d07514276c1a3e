"""Every rule lets a sound exercise pass and refuses the one that breaks it: each case spoils the same exercise in one way."""

import re

import numpy as np
import pytest

from autograder.authoring import rules, survey
from autograder.catalogue import load_assignment
from autograder.exercise import exercise

HINT = "Your area is that of a rectangle: you multiplied the two lengths. What happens to the height when the sides lean?"
OTHER = "You forgot the root at the end, so what you have is the square of the area. Which unit does your number have?"


def area(a, b):
    """Return the area of the parallelogram of the vectors a and b."""
    return float(np.linalg.norm(np.cross(a, b)))


def rectangle(a, b):
    return float(np.linalg.norm(a) * np.linalg.norm(b))


def squared(a, b):
    return area(a, b) ** 2


def lean(rng):
    a = rng.uniform(1, 2, 3)
    return {"a": a, "b": a * [1, -1, 2]}


def upright(rng):
    return {"a": [3.0, 0.0, 0.0], "b": [0.0, 2.0, 0.0]}


def with_hint(function, hint):
    def formula(a, b):
        return function(a, b)

    formula.__doc__ = hint
    return formula


def made(
    reference=area, data=(lean,), blind=(upright,), mistakes=((rectangle, HINT, 0.25), (squared, OTHER, 0.5)), kind="value"
):
    built = exercise(points=3, title="Area", kind=kind)(reference)
    for draw in data:
        built.data(draw)
    for draw in blind:
        built.data(blind=True)(draw)
    for number, (formula, hint, credit) in enumerate(mistakes):
        built.mistake(f"{formula.__name__}{number}", credit=credit)(with_hint(formula, hint))
    return built


def broken(one):
    return {(breach.rule, breach.must) for breach in rules.of_exercise(one, range(3))}


def test_a_sound_exercise_breaks_nothing():
    assert broken(made()) == set()


def two_refused(a, b):
    """Return nothing for the vectors a and b."""
    raise TypeError("not finished")


def wild(rng):
    return {"a": np.random.default_rng().uniform(1, 2, 3), "b": rng.uniform(3, 4, 3)}


def lazy(a, b):
    """Return nothing of the vectors a and b."""
    return 0.0


CASES = {
    "no data": ({"data": (), "blind": ()}, ("data", True), "there is no data set"),
    "only blind data": ({"data": ()}, ("data", True), "all data sets are blind"),
    "data that are not drawn from rng": ({"data": (wild,)}, ("data", True), "differs from one drawing to the next"),
    "data known by heart": ({"data": (lambda rng: {"a": [1, 2, 2], "b": [3, 0, 4]},)}, ("data", True), "changes with the seed"),
    "a reference that fails": ({"reference": two_refused}, ("reference", True), "its own judge says of the reference"),
    "a right answer of nothing": ({"reference": lazy, "mistakes": ()}, ("stub", True), "an array of zeros scores 1"),
    "a mistake that is none": ({"mistakes": ((area, HINT, 0.5),)}, ("seen", True), "hardly differs from the reference"),
    "one mistake twice": (
        {"mistakes": ((rectangle, HINT, 0.5), (rectangle, OTHER, 0.25))}, ("told apart", True), "give the same answers",
    ),
    "blind data that hide nothing": (
        {"mistakes": ((squared, OTHER, 0.5),)}, ("blind", True), "is called blind and hides no mistake",
    ),
    "data that see nothing": ({"data": (lean, lambda rng: upright(rng)), "blind": (), "mistakes": ((rectangle, HINT, 0.5),)},
        ("blind", True), "sees no mistake"),
    "no mistake": ({"mistakes": ()}, ("hints", True), "there is no known mistake"),
    "one hint twice": ({"mistakes": ((rectangle, HINT, 0.5), (squared, HINT, 0.5))}, ("hints", True), "have the same hint"),
    "code in a hint": ({"mistakes": ((rectangle, HINT + " See np.cross.", 0.5),)}, ("hints", True), "holds code"),
    "a hint too short": ({"mistakes": ((rectangle, "You are wrong.", 0.5),)}, ("wording", False), "has 3 words"),
    "a hint to nobody": ({"mistakes": ((rectangle, " ".join(["wrong"] * 20), 0.5),)}, ("wording", False), "does not speak"),
    "no credit": ({"mistakes": ((rectangle, HINT, None),)}, ("wording", False), "no credit of its own"),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_what_breaks_a_rule_is_said(case):
    """With the rule's name, whether it must hold, and what to do."""
    spoilt, wanted, said = CASES[case]
    found = rules.of_exercise(made(**spoilt), range(3))
    (breach,) = [one for one in found if (one.rule, one.must) == wanted and re.search(said, one.said)]
    assert breach.exercise == made(**spoilt).id
    assert breach.to_do


def test_a_surface_that_takes_no_arrays_is_told_which_shape_failed():
    """numpy may call a function with one number, a vector, an open mesh, or nothing at all."""

    def tilted(u, w, h):
        """Return the points of a tilted square, u and w in [0, 1], of height h."""
        return np.stack([u + 0 * w, w + 0 * u, h * u], axis=-1)

    def heights(rng):
        return {"h": rng.uniform(1, 2)}

    found = list(rules.RULES["shape"](made(reference=tilted, data=(heights,), blind=(), mistakes=(), kind="surface"), range(2)))
    assert [said for said, _ in found] == []

    def mesh_only(u, w, h):
        """Return the points of a square, u and w in [0, 1], of height h."""
        return np.stack([u * np.ones_like(w), w * np.ones_like(u), h * np.ones_like(u * w)], axis=-1)[..., :2]

    found = list(
        rules.RULES["shape"](made(reference=mesh_only, data=(heights,), blind=(), mistakes=(), kind="surface"), range(2))
    )
    assert "for numbers the reference must return shape (3,); got (2,) on 'heights'" in found[0][0]


def test_a_mistake_that_the_judge_takes_for_another_is_told():
    """Same answers but for a shape that only the reference handles: the credit that was set is not what it earns."""

    def shifted(u, w, h):
        """Return the points of a square, u and w in [0, 1], lifted by h."""
        return np.stack(np.broadcast_arrays(u, w, h), axis=-1)

    one = exercise(points=1, title="Lift", kind="surface")(shifted)
    one.data(lambda rng: {"h": rng.uniform(1, 2)})

    @one.mistake("numbers_only", credit=0.5)
    def _(u, w, h):
        """You left the square on the ground. Look at its height: every corner should have been lifted by h."""
        if np.ndim(u) == 0:
            raise TypeError("arrays only")
        return np.stack(np.broadcast_arrays(u, w, 0.0), axis=-1)

    found = list(rules.RULES["named"](one, range(2)))
    assert len(found) == 1
    assert "not its credit 0.5" in found[0][0]


def test_the_survey_measures_what_each_data_set_sees():
    """0 where the data are blind; the fraction is the credit; without its name the mistake would be worth nothing."""
    first, second = survey(made())
    assert first.distances["upright"] == 0.0
    assert first.distances["lean"] > rules.SEEN
    assert (first.named, first.fraction, first.outcome) == (first.mistake, 0.25, "partial")
    assert (first.tier, first.unnamed) == ("different", 0.0)
    assert second.distances["upright"] > rules.SEEN


PERSONAL = '''
from autograder.exercise import exercise

@exercise(points=2, title="Twice", kind="value", personal=True)
def twice(a):
    """Return twice a."""
    return 2 * a
'''
NOTEBOOK = """# %% setup=true
{word}
# %% solution="twice"
def twice(a):
    \"\"\"Twice a.\"\"\"
    ### BEGIN SOLUTION
    return 2 * a
    ### END SOLUTION
# %% check="twice"
{check}
"""
WORD = 'from autograder import personal\npersonal.course("workbook")'


@pytest.mark.parametrize(
    ("word", "check", "said"),
    [
        (WORD, "check(twice)", None),
        (WORD, "check(twice) or 2", "must be exactly 'check(twice)'"),
        ("", "check(twice)", "no locked cell says of which course"),
    ],
)
def test_the_notebook_is_held_to_its_rules_too(tmp_path, word, check, said):
    """Grading reads the call out of the cell, and the word that personal numbers are drawn from."""
    folder = tmp_path / "20-twice"
    folder.mkdir()
    (folder / "exercises.py").write_text(PERSONAL)
    (folder / "notebook.py").write_text(NOTEBOOK.format(word=word, check=check))
    found = [b for b in rules.breaches(load_assignment(folder), range(2)) if b.rule == "notebook"]
    assert ([said in b.said and b.must for b in found] == [True]) if said else found == []


def test_an_assignment_without_a_notebook_is_only_advised(tmp_path):
    """An instructor may keep a notebook of her own in source/."""
    folder = tmp_path / "20-twice"
    folder.mkdir()
    (folder / "exercises.py").write_text(PERSONAL)
    found = [b for b in rules.breaches(load_assignment(folder), range(2)) if b.rule == "notebook"]
    assert [(b.must, "no notebook.py" in b.said) for b in found] == [(False, True)]
