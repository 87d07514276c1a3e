"""Where an answer that nobody foresaw is right and where it is not: edges, spans, ranges, data sets."""

import directrix as dx
import numpy as np
import pytest

from autograder.catalogue import shipped
from autograder.exercise import exercise
from autograder.judge import judge

PATCH = shipped().find("bspline_patch")
BEZIER = shipped().find("bezier_patch")


def bent(points, u, amount):
    """Points pushed along a skew direction where the amount is not 0."""
    return points + np.asarray(amount)[..., None] * np.array([0.3, -0.2, 0.5])


def judged(one, answer):
    return judge(one, answer, figure=False, search=False)


def spline(where):
    def answer(u, w, P, k, l):  # noqa: E741
        u, w = np.broadcast_arrays(np.asarray(u, float), np.asarray(w, float))
        return bent(dx.BSplinePatch(P, k, l)(u, w), u, where(u, w, np.shape(P)[0] - k + 1, np.shape(P)[1] - l + 1))

    return answer


@pytest.mark.parametrize(
    ("where", "said"),
    [
        (
            lambda u, w, m, n: np.maximum(u - (m - 1) / m, 0) if m > 1 else 0 * u,
            "Along u it is right in every span but the last.",
        ),
        (lambda u, w, m, n: np.maximum(1 / n - w, 0) if n > 1 else 0 * w, "Along w it is right in every span but the first."),
        (lambda u, w, m, n: np.maximum(u - 1 / m, 0) if m > 1 else 0 * u, "Along u it is right in the first only."),
        (lambda u, w, m, n: (u == 1) * 1.0, "It is right everywhere but on the edge u = 1."),
        (lambda u, w, m, n: ((u == 1) | (w == 1)) * 1.0, "It is right everywhere but on the edges u = 1 and w = 1."),
    ],
)
def test_spans_and_edges_of_a_patch_in_pieces(where, said):
    """The spans come from the exercise; a data set of one span has nothing to say and must not spoil it."""
    verdict = judged(PATCH, spline(where))
    assert said in verdict.part("right"), verdict.message
    assert "work it out by hand" not in verdict.part("look")


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        ([7], "Along w it is right in every span but the last."),
        ([3], "Along w it is right in every span but number 2 of 4."),
        ([5, 7], "Along w it is right in every span but the last 2."),
    ],
)
def test_spans_of_an_answer_that_is_a_net(columns, said):
    """A net that is judged as the surface it makes: corners of the square about some quarter turns are off, so these are."""
    revolve = shipped().find("nurbs_revolve")

    def answer(profile, h):
        P, weights, knots = revolve.reference(profile, h)
        P = P.copy()
        P[:, columns] *= 0.9
        return P, weights, knots

    assert said in judged(revolve, answer).part("right")


def test_wrong_in_two_spans_apart_is_not_said_to_be_one_run():
    """Only one run of spans is told; else nothing of spans."""
    verdict = judged(PATCH, spline(lambda u, w, m, n: np.maximum(np.abs(u - 0.5) - 0.5 + 0.5 / m, 0)))
    assert "span" not in verdict.part("right")


def test_right_up_to_a_value():
    """Without spans the range is told in numbers, as far as the samples show it."""
    verdict = judged(
        BEZIER, lambda u, w, P: bent(dx.BezierPatch(P)(u, w), u, np.maximum(np.asarray(u) + 0 * np.asarray(w) - 0.6, 0))
    )
    assert "It is right as long as u is at most 0.6." in verdict.part("right")
    assert "at about u = 0.6" in verdict.part("look")


def test_right_in_the_middle_of_nothing():
    """A bump inside leaves all edges right; the range around it is what is told."""

    def answer(u, w, P):
        bump = np.maximum(0.2 - np.abs(np.asarray(u) - 0.5), 0) * np.ones_like(np.asarray(w))
        return bent(dx.BezierPatch(P)(u, w), u, bump)

    right = judged(BEZIER, answer).part("right")
    assert "It is right up to u = 0.3" in right or "It is right up to u = 0.28" in right, right


def make(arguments, *sets):
    names = ", ".join(arguments)
    space: dict = {"np": np}
    exec(
        f"def some(u, w, {names}):\n    '''A flat piece.'''\n    return np.stack(np.broadcast_arrays(u, w, 0 * u * w), -1)",
        space,
    )
    made = exercise(points=1, title="Some", kind="surface")(space["some"])
    for number, values in enumerate(sets):

        def draw(rng, values=values):
            return dict(zip(arguments, values, strict=True))

        draw.__name__ = f"set_{number}"
        made.data(draw)
    return made


NET = np.arange(27.0).reshape(3, 3, 3)
CASES = [
    (
        ("k", "n"),
        [(3, 3), (4, 4), (3, 4)],
        lambda k, n: k == n,
        "right where k and n are equal, and wrong where k and n differ.",
    ),
    (
        ("P",),
        [(NET,), (NET[:2],)],
        lambda P: len(P) == 3,
        "right where P has as many rows as columns, and wrong where P has unequal numbers of rows and columns.",
    ),
    (("d",), [(2.0,), (-2.0,), (1.0,)], lambda d: d > 0, "right where d is not negative, and wrong where d is negative."),
    (("d",), [(2.0,), (0.0,), (1.0,)], lambda d: d != 0, "right where d is not 0, and wrong where d is 0."),
    (("v",), [(np.eye(3)[1],), (np.ones(3),)], lambda v: v[0] == 0, "right where v has length 1"),
    (("v",), [(2 * np.eye(3)[1],), (np.ones(3),)], lambda v: v[0] == 0, "right where v lies along x, y or z"),
    (("h",), [(np.ones((2, 2)),), (np.eye(2) + 1,)], lambda h: np.ptp(h) == 0, "right where all numbers in h are the same"),
]


@pytest.mark.parametrize(("arguments", "sets", "right", "said"), CASES)
def test_what_parts_the_data_sets(arguments, sets, right, said):
    """A plain property that all right data have and no wrong ones."""

    def answer(u, w, *given):
        flat = np.stack(np.broadcast_arrays(u, w, 0 * u * w), -1)
        return flat if right(*given) else bent(flat, u, np.sin(5 * u * w))

    verdict = judged(make(arguments, *sets), answer)
    assert said in verdict.part("right"), verdict.message
    assert verdict.part("look").startswith(f"Follow {' and '.join(arguments)} through your function")


def test_a_property_that_does_not_part_them_is_not_told():
    """Right on one of two alike: there is nothing to say but their names."""
    made = make(("d",), (2.0,), (3.0,))
    verdict = judged(made, lambda u, w, d: np.stack(np.broadcast_arrays(u, w, (d == 3) * u * w), -1))
    assert "right where" not in verdict.message
    assert "Right on the data set set_0." in verdict.part("right")


def test_a_data_set_is_described_in_its_own_words():
    """The docstring of a data set is what a learner reads of it; where the answer is a word it would tell that."""
    vase = shipped().find("vase")

    def answer(u, w, *rest):
        points = vase.reference(u, w, *rest)
        low = np.asarray(vase.reference(0.0, 0.0, *rest))
        return points if np.abs(low[:2]).max() > 1e-9 else bent(points, u, np.sin(3 * np.asarray(u) * w))

    verdict = judged(vase, answer)
    assert "closed_below (ρ = 0 at u = 0: a bowl with a pole" in verdict.part("where"), verdict.message
    label = shipped().find("bilinear_is_planar")
    said = " ".join(data.says for data in label.data_sets if data.says)
    verdict = judge(label, lambda *arguments: not label.reference(*arguments))
    assert said
    assert not any(data.says and data.says.rstrip(".") in verdict.message for data in label.data_sets)


def test_a_curve_that_is_wrong_at_its_end_only():
    """An end, not an edge."""

    @exercise(points=1, title="Line", kind="curve")
    def line(u, a):
        """Straight on."""
        return np.asarray(u)[..., None] * np.asarray(a)

    @line.data
    def one(rng):
        return {"a": [1.0, 2.0, 3.0]}

    verdict = judged(line, lambda u, a: (np.asarray(u) * (np.asarray(u) != 1))[..., None] * np.asarray(a))
    assert verdict.part("right") == "It is right everywhere but at the end u = 1."
