"""What a learner reads, sentence by sentence, for one answer of each kind."""

import math

import numpy as np
import pytest

from autograder.exercise import exercise
from autograder.judge import judge

TURN = 2 * np.pi


def stack(x, y, z):
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


@pytest.fixture
def arch():
    """A patch with nothing symmetric about it, whose edges, corners and inside can be told apart."""

    @exercise(points=1, title="Arch", kind="surface")
    def arch(u, w, a):
        """Return the arch."""
        u, w = np.asarray(u), np.asarray(w)
        return stack(3 * u + 0 * w, a * w + u**2, u * w + w**3)

    @arch.data
    def two(rng):
        return {"a": 2.0}

    @arch.data
    def three(rng):
        return {"a": 3.0}

    return arch


def changed(arch, change):
    """The right arch with something added, a function of u and w."""
    return lambda u, w, a: arch.reference(u, w, a) + change(np.asarray(u), np.asarray(w), a)


def bump(u, w, a):
    return stack(u * (1 - u) * w * (1 - w), u * (1 - u) * w * (1 - w), u * (1 - u) * w * (1 - w))


def between_corners(u, w, a):
    rise = u * (1 - u) + w * (1 - w)
    return stack(rise, rise, rise)


def off_from_w0(u, w, a):
    return stack(w * u, w, w * w)


def only_z(u, w, a):
    return stack(0 * u, 0 * u, np.sin(3 * u * w) + 0.1)


class TestPlaces:
    def parts(self, arch, change):
        verdict = judge(arch, changed(arch, change))
        assert verdict.tier == "different", verdict.message
        return verdict

    def test_inside_only(self, arch):
        verdict = self.parts(arch, bump)
        assert verdict.part("right") == "All 4 edges are right."
        assert verdict.part("wrong").startswith("It differs inside only")
        assert verdict.part("look") == "Look at the term that vanishes on the edges."

    def test_corners_only(self, arch):
        verdict = self.parts(arch, between_corners)
        assert verdict.part("right") == "All 4 corners are right."
        assert verdict.part("wrong").startswith("It is exact at the corners only")

    def test_one_edge(self, arch):
        verdict = self.parts(arch, off_from_w0)
        assert verdict.part("right") == "The edge w = 0 is right."
        assert "on the way from w = 0, where you are right, to w = 1" in verdict.part("look")

    def test_the_far_edge(self, arch):
        """Nothing grows from 1 to 0, and who is right at the end did not start right."""
        verdict = self.parts(arch, lambda u, w, a: off_from_w0(u, 1 - w, a))
        assert verdict.part("right") == "The edge w = 1 is right."
        assert "on the way from w = 1, where you are right, to w = 0" in verdict.part("look")

    def test_one_coordinate(self, arch):
        verdict = self.parts(arch, only_z)
        assert verdict.part("right") == "x and y are right everywhere."
        assert "z is wrong." in verdict.part("wrong")

    def test_one_coordinate_with_the_wrong_sign(self, arch):
        verdict = judge(arch, lambda u, w, a: arch.reference(u, w, a) * [1, 1, -1])
        assert "z has the wrong sign." in verdict.part("wrong")

    def test_one_coordinate_by_a_factor(self, arch):
        verdict = judge(arch, lambda u, w, a: arch.reference(u, w, a) * [1, 0.5, 1])
        assert verdict.part("right") == "x and z are right everywhere."
        assert verdict.part("wrong") == "y is 0.5 times what it should be."

    def test_two_coordinates_exchanged(self, arch):
        verdict = judge(arch, lambda u, w, a: arch.reference(u, w, a)[..., [0, 2, 1]])
        assert "Its coordinates are exchanged: your y is the right z." in verdict.part("wrong")

    def test_a_factor_that_changes_with_the_data_is_no_factor(self, arch):
        verdict = judge(arch, lambda u, w, a: arch.reference(u, w, a) * np.array([1, 1, a]))
        assert "times what it should be" not in verdict.message

    def test_a_parameter_that_is_not_used(self, arch):
        verdict = judge(arch, lambda u, w, a: arch.reference(u, 0.5 + 0 * np.asarray(w), a) + [0, 0, 1])
        assert "It does not change with w at all." in verdict.part("wrong")
        assert verdict.part("look") == "Look for where w should come in."

    def test_an_error_that_one_parameter_does_not_change(self, arch):
        """f(u, w) = g(u, w) + e(w): what becomes of u is right. Not claimed where both parameters change it."""
        verdict = self.parts(arch, lambda u, w, a: stack(np.cos(3 * w) + 0 * u, a * w**2 + 0 * u, 1 + w + 0 * u))
        assert "is the same for every u: what it does with u is right." in verdict.part("wrong")
        assert verdict.part("look") == "Look at u = 0: what is too much there, or missing, is so for every u."
        both = self.parts(arch, lambda u, w, a: stack(np.cos(3 * w) + u**2, a * w**2 + u, 1 + w * u))
        assert "same for every" not in both.message

    def test_the_worst_point_is_given_with_both_values(self, arch):
        verdict = judge(arch, changed(arch, lambda u, w, a: stack(0 * u, 0 * u, a * (u * w) ** 4)))
        where = verdict.part("where")
        assert "on the data set two (a = 2), at u = 1, w = 1" in where  # the first that shows it plainly
        assert "your point is (3, 3, 4), the right one is (3, 3, 2)" in where

    def test_a_rounding_error_in_the_origin_is_written_0(self, arch):
        """The right point at u = w = 0 is the origin, and nobody is asked to compare with 1e-17."""

        def almost(u, w, a):
            far = np.exp(-40 * (u**2 + w**2))
            return stack(2 * far, 1e-17 + 0 * far, -1e-17 * far)

        where = self.parts(arch, almost).part("where")
        assert "at u = 0, w = 0: your point is (2, 0, 0), the right one is (0, 0, 0)." in where
        small = self.parts(arch, lambda u, w, a: almost(u, w, a) * 1e-15 + bump(u, w, a))
        assert "e-1" not in small.part("where")

    def test_digits_suffice_to_show_a_small_difference(self, arch):
        where = judge(arch, changed(arch, lambda u, w, a: stack(0 * u, 0 * u, 1e-7 * u * w))).part("where")
        assert "2.0000001" in where


class TestTiers:
    def test_relabelled_says_which_way_and_what_becomes_of_the_normal(self, arch):
        verdict = judge(arch, lambda u, w, a: arch.reference(w, u, a))
        assert "u and w are exchanged. The normal S_u × S_w points to the other side." in verdict.part("wrong")
        verdict = judge(arch, lambda u, w, a: arch.reference(1 - np.asarray(u), 1 - np.asarray(w), a))
        assert "u and w both run backwards. The normal S_u × S_w keeps its side." in verdict.part("wrong")

    def test_a_quarter_turn_of_the_square_says_which(self, arch):
        verdict = judge(arch, lambda u, w, a: arch.reference(1 - np.asarray(w), u, a))
        assert verdict.symmetries == ("rot270",)
        assert "your point at (w, 1-u) is the right one at (u, w)" in verdict.part("wrong")
        u, w = 0.25, 0.875
        answer = arch.reference(1 - (1 - u), w, 2.0)  # the answer at (w, 1-u)
        assert (answer == arch.reference(u, w, 2.0)).all()

    def test_close_speaks_of_constants_and_float32_of_itself(self, arch):
        assert "rounded constant" in judge(arch, changed(arch, lambda u, w, a: stack(0 * u, 0 * u, 1e-3 * u * w))).part("look")
        assert "float32" in judge(arch, lambda *a: arch.reference(*a).astype(np.float32)).part("look")

    def test_moved_says_where_to(self, arch):
        assert "moved by (1, 0, 2)" in judge(arch, changed(arch, lambda u, w, a: np.array([1.0, 0, 2]))).message
        turned = judge(arch, lambda u, w, a: np.roll(arch.reference(u, w, a), 1, axis=-1))
        assert "turned by 120° about the direction (0.5774, 0.5774, 0.5774)." in turned.message
        assert "mirrored" in judge(arch, lambda u, w, a: -arch.reference(u, w, a)).message
        assert "2 times as large" in judge(arch, lambda u, w, a: 2 * arch.reference(u, w, a)).message

    def test_same_set_part_more_and_covered_have_their_own_words(self, arch):
        speed = judge(arch, lambda u, w, a: arch.reference(np.asarray(u) ** 2, w, a)).message
        assert "with the same corners, but u and w run at another speed" in speed
        assert "covers only a part" in judge(arch, lambda u, w, a: arch.reference(np.asarray(u) / 2, w, a)).message
        beyond = judge(arch, lambda u, w, a: arch.reference(1.2 * np.asarray(u), w, a)).message
        assert "goes on beyond it: it is about 1.2" in beyond

        def leap(u, w, a):
            """Runs through all of it, and then stands still a little further on."""
            return arch.reference(np.minimum(1.25 * np.asarray(u), 1.001), w, a)

        assert "goes on beyond it, to places that hardly add to its size" in judge(arch, leap).message
        folded = judge(arch, lambda u, w, a: arch.reference(np.abs(2 * np.asarray(u) - 1), w, a)).message
        assert "covers it 2 times" in folded
        overlapping = judge(
            arch, lambda u, w, a: arch.reference(np.interp(u, [0, 0.6, 0.8, 1], [0, 0.8, 0.6, 1]), w, a)
        ).message
        assert "covers it 1.4" in overlapping
        assert "squeezed" not in overlapping
        squeezed = judge(arch, lambda u, w, a: arch.reference(np.minimum(2 * np.asarray(u), 1), w, a)).message
        assert "of the parameter domain is squeezed into nothing" in squeezed
        line = judge(arch, lambda u, w, a: arch.reference(u, 0 * np.asarray(w), a)).message
        assert "collapsed to a curve" in line
        assert "Look for where w should come in" in line

    def test_data_sets_are_told_apart(self, arch):
        verdict = judge(arch, lambda u, w, a: arch.reference(u, w, 2.0))
        assert verdict.part("right").startswith("Right on the data set two.")
        assert "the data set three" in verdict.part("where")


@pytest.mark.parametrize("seed", [0, b"another"])
def test_words_of_the_graders_own_making_stay_out(arch, seed):
    for answer in (lambda u, w, a: arch.reference(w, u, a), changed(arch, bump), lambda *a: None):
        message = judge(arch, answer, seed=seed).message
        assert not any(word in message for word in ("tier", "seed", "sampled", "gate", "finding"))


def test_a_row_of_another_length_is_asked_for_its_entries():
    """A row has one axis, and "which axis is which" is no question."""

    @exercise(points=1, title="Row", kind="value")
    def row(n):
        """Return n ones."""
        return np.ones(n)

    row.data(lambda rng: {"n": 4})
    assert judge(row, lambda n: np.ones(n + 1)).message.endswith("which entries are too many there, or missing?")
    assert judge(row, lambda n: np.ones((n, 2))).message.endswith("which axis is which in the statement?")


def test_an_axis_that_is_missing_is_not_taken_for_math_cos():
    """A parameter times a point works for numbers; np.cos has nothing to do with it."""

    @exercise(points=1, title="Line", kind="curve")
    def line(u, p):
        """Return u p."""
        return np.asarray(u, float)[..., None] * p

    line.data(lambda rng: {"p": np.array([3.0, 4.0, 5.0])})
    message = judge(line, lambda u, p: u * p).message
    assert message.endswith("needs an axis for x, y, z, as in np.asarray(u, float)[..., None].")
    assert "np.cos, not math.cos" in judge(line, lambda u, p: math.cos(0 * u) * u * p).message


def test_a_mesh_that_is_too_large_to_read_is_called_large():
    """Not "not an array of numbers": three parameters of 222 values each make a mesh of 33 million."""

    @exercise(points=1, title="Cube", kind="solid")
    def cube(u, v, w):
        """Return (u, v, w)."""
        return stack(u, v, w)

    cube.data(lambda rng: {})

    def meshed(u, v, w):
        n = [np.size(one) for one in (u, v, w)]
        return np.broadcast_to(0.0, (*n, 3)) if max(n) > 1 else stack(u, v, w)

    message = judge(cube, meshed).message
    assert "it returns an array of 32823144 numbers, more than" in message
    assert "Begin with u, v, w = np.broadcast_arrays(u, v, w)" in message


def test_a_product_of_matrices_that_do_not_fit_is_asked_for_its_axes():
    """B P B with a net P (4, 4, 3): numpy speaks of a gufunc signature, and means that @ met x, y, z."""

    @exercise(points=1, title="Rows", kind="net")
    def rows(P):
        """Return twice P."""
        return 2 * P

    rows.data(lambda rng: {"P": rng.uniform(size=(4, 4, 3))})
    look = judge(rows, lambda P: 2 * np.eye(4) @ P @ np.eye(4)).part("look")
    assert look.startswith("Print the shapes on both sides of @")
    assert "Print the shapes" not in judge(rows, lambda P: P + np.ones(5)).message
