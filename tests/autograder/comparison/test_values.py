"""The ladder of values: what a wrong number, net or basis has to do with the right one."""

import numpy as np
import pytest

from autograder.exercise import DataSet, exercise
from autograder.judge import judge

NET = np.arange(36.0).reshape(4, 3, 3) ** 1.5 - 20
SQUARE = np.arange(48.0).reshape(4, 4, 3) ** 1.5 - 20


def posed(right, kind="net", **options):
    @exercise(points=1, title="A value", kind=kind, **options)
    def value(a):
        """Return it."""
        return right

    @value.data
    def plain(rng):
        return {"a": 2.0}

    return value


def off_by(place, by=1.0):
    wrong = NET.copy()
    wrong[place] += by
    return wrong


@pytest.mark.parametrize(
    ("right", "wrong", "said"),
    [
        (NET, -NET, "wrong sign"),
        (NET, 3 * NET, "3 times the right one"),
        (NET, NET + 2, "the right one plus 2"),
        (NET, NET.transpose(1, 0, 2), "the axes are exchanged"),
        (SQUARE, SQUARE.transpose(1, 0, 2), "transposed"),
        (NET, NET.ravel(), "in shape (36,); wanted (4, 3, 3)"),
        (NET, NET.ravel()[::-1], "as many numbers as wanted"),
        (NET, NET[:-1], "One too few along axis 0"),
        (NET, np.concatenate([NET, NET[:1]]), "One too many along axis 0"),
        (NET, NET[0, 0], "shape (3,), wanted (4, 3, 3)"),
        (NET, NET[::-1], "reverse order along axis 0"),
        (NET, np.roll(NET, 1, axis=1), "shifted by one along axis 1"),
        (NET, NET[[2, 0, 3, 1]], "another order"),
        (NET, np.abs(NET), "have the wrong sign"),
        (NET, off_by((slice(None), 1)), "Along axis 1, 1 of 3 layers are wrong (number 1)"),
        (SQUARE, SQUARE + [1, 2, 3], "too much everywhere in your table: (1, 2, 3)"),
        (SQUARE, SQUARE + np.eye(4)[..., None] * [1, 2, 3], "all its 16 places but [0, 0], [1, 1], [2, 2] and [3, 3]"),
        (SQUARE, SQUARE + (1 - np.eye(4))[..., None] * SQUARE**2, "only [0, 0], [1, 1], [2, 2] and [3, 3] are right"),
        (SQUARE, SQUARE + np.outer([0, 1, 1, 0], [0, 1, 0, 0])[..., None] * SQUARE**2, "places but [1, 1] and [2, 1]"),
        (NET, NET * np.array([1, 1, 2]), "Along axis 2, 1 of 3 layers are wrong (number 2): they are 2 times"),
        (NET, NET + np.eye(4)[:, :3, None], "all its 12 places but [0, 0], [1, 1] and [2, 2]"),
        (np.array([1.0, 2, 3, 4]), np.array([1.0, 2, 6, 8]), "2 of 4 entries are wrong (number 2, 3): they are 2 times"),
        (np.float64(0.75), 1.5, "2 times the right one"),
        (np.float64(0.75), 0.71, "not the right value"),
        (48, 24, "0.5 times"),
        (True, False, "says False where the answer is True"),
        ("horn", "Horn ", "capitals or spaces"),
        ("horn", "ring", "“ring” is not the right word"),
        ("horn", 3.0, "The answer is a word"),
        (2.0, "two", "The answer is a number"),
    ],
)
def test_a_wrong_value_is_told_by_its_pattern(right, wrong, said):
    verdict = judge(posed(right, kind="label" if isinstance(right, str) else "net"), lambda a: wrong)
    assert verdict.fraction == 0.0
    assert said in verdict.message


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (lambda a: a**2 + 2, "the right one plus 2"),
        (lambda a: a**2 + a, "too large on every data set"),
        (lambda a: a**2 - a, "too small on every data set"),
        (lambda a: 9.0, None),
    ],
)
def test_what_single_numbers_have_in_common_from_one_data_set_to_the_other(wrong, said):
    @exercise(points=1, title="A number", kind="value")
    def square(a):
        """Return a squared."""
        return a**2

    for name, value in (("low", 2.5), ("high", 3.5)):
        square.data_sets.append(DataSet(name, lambda rng, value=value: {"a": value}))
    message = judge(square, wrong).message
    assert message.count("on every data set") + message.count("On every data set") == (said is not None)
    assert said is None or said in message


def test_the_right_word_is_not_told():
    assert "horn" not in judge(posed("horn", kind="label"), lambda a: "ring").to_json()


@pytest.mark.parametrize(
    ("right", "answer"), [(48, 48.0), (True, 1), (True, np.bool_(True)), (NET, NET.tolist()), (0.5, [0.5][0])]
)
def test_the_same_value_in_other_clothes_is_right(right, answer):
    assert judge(posed(right), lambda a: answer).fraction == 1.0


def test_a_value_of_zero_leaves_room_for_rounding_and_no_more():
    """A flatness of 0 comes out as 1e-16 times the size of the data."""
    assert judge(posed(0.0, kind="value"), lambda a: 3e-16).fraction == 1.0
    assert judge(posed(0.0, kind="value"), lambda a: 1e-9).fraction == 0.0


def test_the_tolerance_is_relative_to_the_largest_entry():
    exact = posed(NET, tolerance=1e-6)
    largest = np.abs(NET).max()
    assert judge(exact, lambda a: NET + 0.5e-6 * largest).fraction == 1.0
    assert judge(exact, lambda a: NET + 5e-6 * largest).tier == "close"


def test_one_entry_is_named_with_both_values():
    verdict = judge(posed(NET), lambda a: off_by((2, 1, 0), 8.0))
    assert "entry [2, 1, 0] is" in verdict.part("where")
    assert f"{NET[2, 1, 0]:.4g}" in verdict.part("where")


def test_a_tuple_names_the_element():
    pair = posed((NET, np.ones((4, 3))))
    assert judge(pair, lambda a: (NET, np.ones((4, 3)))).fraction == 1.0
    assert judge(pair, lambda a: [NET, np.ones((4, 3))]).fraction == 1.0
    verdict = judge(pair, lambda a: (NET, 2 * np.ones((4, 3))))
    assert "Element 1 of the tuple" in verdict.message
    assert "2 times" in verdict.message
    assert "a tuple of 2" in judge(pair, lambda a: (NET, NET, NET)).message


def test_not_a_number_in_a_value_earns_nothing_but_its_mistake_is_named():
    value = posed(np.array([1.0, 2.0]), kind="basis")

    @value.mistake("logarithms")
    def _(a):
        """0 to the power 0 by logarithms."""
        return np.array([np.nan, 2.0])

    assert judge(value, lambda a: np.array([np.nan, 3.0])).tier == "not finite"
    verdict = judge(value, lambda a: np.array([np.nan, 2.0]))
    assert (verdict.mistake, verdict.fraction) == ("logarithms", 0.0)
    assert judge(value, lambda a: np.array([np.nan, 2.0 + 4e-16])).mistake == "logarithms", "rounding is no other mistake"


def test_a_basis_is_held_to_its_tolerance_whatever_the_size_of_the_data():
    """Its functions lie between 0 and 1 even where the knots reach to 1000."""
    basis, net = (posed(np.array([0.25, 0.75]), kind=kind, tolerance=1e-12) for kind in ("basis", "net"))
    for value in (basis, net):
        value.data_sets[0] = DataSet("far", lambda rng: {"a": 1000.0})
    assert judge(basis, lambda a: np.array([0.25, 0.75 + 5e-13])).fraction == 1.0
    assert judge(basis, lambda a: np.array([0.25, 0.75 + 5e-12])).tier == "close"
    assert judge(net, lambda a: np.array([0.25, 0.75 + 5e-12])).tier == "identical"


def test_a_mistake_of_another_shape_is_named():
    value = posed(np.arange(10.0))

    @value.mistake("one_short", credit=0.5)
    def _(a):
        """One knot short."""
        return np.arange(9.0)

    verdict = judge(value, lambda a: np.arange(9.0))
    assert (verdict.mistake, verdict.fraction) == ("one_short", 0.5)


def test_a_mask_tells_a_place_and_how_many():
    @exercise(points=1, title="Half", kind="mask")
    def half(u, w):
        """Return where u + w is at most 1."""
        return np.asarray(u) + np.asarray(w) <= 1.0

    half.data(lambda rng: {})
    assert judge(half, lambda u, w: (np.asarray(u) + w <= 1).astype(int), seed=4).fraction == 1.0
    verdict = judge(half, lambda u, w: np.asarray(u) + w < 1, seed=4)
    assert verdict.fraction == 0.0
    assert "False where the answer is True, at 9 of" in verdict.message


def test_a_truth_in_an_array_or_as_a_word_is_asked_for_a_single_one():
    """Not "says (1)", and not "the answer is a number"."""
    row = judge(posed(True), lambda a: np.array([True])).message
    assert "says" not in row
    assert row.endswith("The answer is a single True or False: is an index missing, or all() or any()?")
    word = judge(posed(True), lambda a: "yes").message
    assert "The answer is True or False; your function returned the word “yes”." in word


@pytest.mark.parametrize("wrong", [NET, np.concatenate([NET, NET])], ids=["half", "joined"])
def test_half_of_a_pair_is_asked_for_the_other_half(wrong):
    look = judge(posed((NET, np.ones((4, 3)))), lambda a: wrong).part("look")
    assert look == "Return all of them in one line, in the order of the statement, with commas between."
