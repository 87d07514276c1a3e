"""Declaring an exercise: what the decorators gather, what they refuse, and that data depend on the seed alone."""

import numpy as np
import pytest

from autograder.curvedata import CurveData
from autograder.errors import ExerciseError
from autograder.exercise import Exercise, exercise, generator


def linear_sweep() -> Exercise:
    @exercise(points=6, title="Linear sweep", kind="surface", accept={"same set": 0.5})
    def linear_sweep(u, w, curve, direction, d=2 * np.pi):
        """Sweep the generatrix."""
        v = np.asarray(direction, float)
        return curve(u) + (np.asarray(w) * d)[..., None] * v / np.linalg.norm(v)

    @linear_sweep.data
    def arcs(rng):
        return {"curve": lambda t: np.stack([t, t**2, 0 * t], -1), "direction": rng.normal(size=3), "d": 2.0}

    @linear_sweep.data(blind=True)
    def unit(rng):
        return (lambda t: np.stack([t, t, 0 * t], -1)), [0, 0, 1]

    @linear_sweep.mistake("backwards", credit=0.25)
    def _(u, w, curve, direction, d):
        """You went
        the other way."""
        return linear_sweep.reference(u, w, curve, direction, -d)

    return linear_sweep


def test_an_exercise_gathers_what_its_decorators_say():
    """Id, signature, statement, hint on one line, and the reference stays callable."""
    sweep = linear_sweep()
    assert sweep.id == "linear_sweep"
    assert sweep.signature == "linear_sweep(u, w, curve, direction, d=2*np.pi)"
    assert sweep.statement == "Sweep the generatrix."
    assert [(known.name, known.blind) for known in sweep.data_sets] == [("arcs", False), ("unit", True)]
    assert (sweep.mistakes[0].id, sweep.mistakes[0].hint, sweep.mistakes[0].credit) == (
        "backwards",
        "You went the other way.",
        0.25,
    )
    assert sweep(0.5, 0.5, lambda t: np.array([t, t, 0.0]), [0, 0, 2], 4).tolist() == [0.5, 0.5, 2.0]


def test_data_are_the_same_for_the_same_seed_and_others_for_another():
    """A student's data can be drawn again on any machine."""
    first, again, other = (linear_sweep().draw(seed)[0].arguments["direction"] for seed in ("a", "a", "b"))
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)


def test_a_generator_depends_on_every_name():
    """Two exercises, or two data sets, never share their numbers under one seed."""
    draws = {
        generator(*key).integers(1 << 60) for key in [(0, "a", "b"), (0, "ab"), (1, "a", "b"), (b"0x", "a", "b"), (0, "a", "c")]
    }
    assert len(draws) == 5


def test_drawn_curves_are_data_and_drawn_arrays_are_read_only():
    """What the learner's function gets cannot be written into and tells no formula."""
    drawn = linear_sweep().draw()
    assert isinstance(drawn[0].arguments["curve"], CurveData)
    with pytest.raises(ValueError, match="read-only"):
        drawn[0].arguments["direction"][0] = 1.0


def test_drawn_numbers_are_plain_numbers():
    """np.float64 divides by zero with a warning and compares to np.bool, a float raises: learners' code must not meet both."""
    sweep = linear_sweep()
    sweep.data(lambda rng: {"curve": lambda t: np.stack([t, t, t], -1), "direction": [0, 0, 1], "d": rng.choice([1.0, 2.0])})
    assert type(sweep.draw()[-1].arguments["d"]) is float


def test_a_tuple_is_taken_in_order_and_defaults_fill_the_rest():
    """The blind data set gives two of three arguments."""
    assert linear_sweep().draw()[1].arguments["d"] == 2 * np.pi


def test_credit_of_a_tier_is_the_exercises_own_then_the_default():
    """A value or label has no ladder of surfaces: nothing below identical earns by default."""
    sweep = linear_sweep()
    assert [sweep.tier_credit(tier) for tier in ("identical", "same set", "relabelled", "different")] == [1.0, 0.5, 0.5, 0.0]
    value = exercise(points=1, title="t", kind="value")(_value)
    assert value.tier_credit("close") == 0.0


def _value(a):
    """A number."""
    return a


def _no_docstring(u, w):
    return u


@pytest.mark.parametrize(
    ("options", "function", "message"),
    [
        ({"kind": "surface"}, _value, "a surface takes u, w first; got a"),
        ({"kind": "value"}, _no_docstring, "needs a docstring, which is the statement"),
        ({"kind": "solid body"}, _value, "kind must be one of surface, curve"),
        ({"kind": "value", "points": 0}, _value, "points must be above 0; got 0"),
        ({"kind": "value", "accept": {"nearly": 0.5}}, _value, "accept maps tiers of the ladder"),
        ({"kind": "value", "accept": {"close": 1.5}}, _value, "accept maps tiers of the ladder"),
    ],
)
def test_a_wrong_declaration_is_refused_with_what_must_hold(options, function, message):
    """The instructor reads what to mend when the module is imported."""
    with pytest.raises(ExerciseError, match=message):
        exercise(**{"points": 1, "title": "t", **options})(function)


def test_a_mistake_needs_a_hint_a_new_name_the_same_arguments_and_less_than_full_credit():
    """Each rule is tested against its neighbour, which is taken."""
    value = exercise(points=1, title="t", kind="value")(_value)

    def hinted(a):
        """Look at the sign."""
        return -a

    value.mistake("sign", credit=0.5)(hinted)
    for arguments, function, message in [
        (("sign",), hinted, "is there twice"),
        (("other",), lambda a: a, "needs a docstring"),
        (("full", 1.0), hinted, r"must lie in \[0, 1\)"),
    ]:
        with pytest.raises(ExerciseError, match=message):
            value.mistake(arguments[0], credit=arguments[1] if len(arguments) > 1 else None)(function)

    def other_arguments(b):
        """Hint."""

    with pytest.raises(ExerciseError, match="must take"):
        value.mistake("arguments")(other_arguments)


def test_another_way_of_writing_a_mistake_has_its_hint_and_its_credit():
    """The mistakes stay a list of different ones; a way without its mistake, or with other arguments, is refused."""
    sweep = linear_sweep()

    @sweep.also("backwards")
    def _(u, w, curve, direction, d):
        return sweep.reference(u, w, curve, -np.asarray(direction), d + 1)

    (known,), (way,) = sweep.mistakes, sweep.ways
    assert (way.id, way.hint, way.credit, way.way) == (known.id, known.hint, known.credit, 1)
    assert way.formula is not known.formula
    with pytest.raises(ExerciseError, match="no mistake 'forwards' yet"):
        sweep.also("forwards")(known.formula)
    with pytest.raises(ExerciseError, match="must take"):
        sweep.also("backwards")(lambda u, w: u)


@pytest.mark.parametrize(
    ("drawn", "message"), [({"b": 1}, r"missing \['a'\], unknown \['b'\]"), (3, "must return a dict of arguments; got int")]
)
def test_data_that_do_not_fit_the_signature_are_refused(drawn, message):
    """Missing and unknown names are both told."""
    value = exercise(points=1, title="t", kind="value")(_value)
    value.data(lambda rng: drawn)
    with pytest.raises(ExerciseError, match=message):
        value.draw()


def test_two_data_sets_of_one_name_are_refused():
    """The second would silently take the place of the first in every report."""
    sweep = linear_sweep()

    def arcs(rng):
        return {}

    with pytest.raises(ExerciseError, match="a data set named 'arcs' exists already"):
        sweep.data(arcs)
