"""A7: the printed numbers of the syllabus, the checks that need no reference, and oracles that take another road."""

import directrix as dx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.interpolate import BSpline

from autograder.catalogue import shipped
from autograder.judge import judge

U, W = np.linspace(0, 1, 13)[:, None], np.linspace(0, 1, 11)[None, :]
A7 = shipped().assignment("A7").exercises
numbers = st.floats(-5, 5, allow_subnormal=False)
DATA = A7["nurbs_patch"].draw()[0].arguments
P65, H65 = DATA["P"], DATA["h"]
ROOT = np.sqrt(0.5)


@st.composite
def splines(draw):
    """A net with orders that fit it."""
    m, n = draw(st.integers(2, 6)), draw(st.integers(2, 6))
    return draw(arrays(float, (m, n, 3), elements=numbers)), draw(st.integers(1, m)), draw(st.integers(1, n))


def reference(id):
    return A7[id].reference


def quarter(r, h, row=(1, ROOT, 1), turned=False):
    """Net and weights by hand; ``row`` are the weights along u, ``turned`` runs from (0, r) to (r, 0)."""
    arc = [(r, 0), (r, r), (0, r)][:: -1 if turned else 1]
    return np.array([[(x, y, 0), (x, y, h)] for x, y in arc], float), np.outer(row, [1, 1])


def near(actual, expected, scale=1.0):
    """Equal to rounding: a few hundred units in the last place of the largest number involved."""
    np.testing.assert_allclose(actual, np.broadcast_to(expected, np.shape(actual)), rtol=0, atol=1e-13 * max(scale, 1.0))


@pytest.mark.parametrize(
    ("id", "place", "expected"),
    [
        ("bspline_patch", (0.5, 0.5, P65, 4, 3), (7.23046875, 7.90234375, -0.04296875)),
        ("bspline_patch", (0.25, 0.75, P65, 4, 3), (3.99633789, 10.3331299, 1.21105957)),
        ("bspline_patch", (1, 1, P65, 4, 3), (17, 16, -2)),
        ("nurbs_patch", (0.5, 0.5, P65, H65, 4, 3), (5.97987928, 8.21529175, 0.169014085)),
        ("nurbs_patch", (0.25, 0.75, P65, H65, 4, 3), (3.88360329, 10.1342646, 1.39815288)),
    ],
)
def test_the_printed_numbers(id, place, expected):
    """Nine digits were printed."""
    np.testing.assert_allclose(reference(id)(*place), expected, rtol=1e-8, atol=1e-8)


def test_the_printed_rows():
    assert reference("open_knots")(6, 4).tolist() == [0, 0, 0, 0, 1, 2, 3, 3, 3, 3]
    rows = reference("bspline_basis")(np.arange(13) / 4, [0, 0, 0, 0, 1, 2, 3, 3, 3, 3], 4)
    near(rows[0], [1, 0, 0, 0, 0, 0])
    np.testing.assert_allclose(rows[1], (0.421875, 0.49609375, 0.0794270833, 0.00260416667, 0, 0), rtol=1e-8)
    np.testing.assert_allclose(rows[2], (0.125, 0.59375, 0.260416667, 0.0208333333, 0, 0), rtol=1e-8)
    near(rows[-1], [0, 0, 0, 0, 0, 1])


def test_the_printed_quarter():
    surface = A7["nurbs_quarter_cylinder"].judged_as(reference("nurbs_quarter_cylinder")(2.0, 5.0))
    np.testing.assert_allclose(surface(0.5, 0.5), (1.41421356, 1.41421356, 2.5), rtol=1e-8)
    np.testing.assert_allclose(surface(0.25, 0.0), (1.8595766, 0.736189419, 0), rtol=1e-8)


@given(st.integers(1, 12), st.integers(1, 12))
def test_open_knots(m, k):
    """Length, ends, steps of 1 between; refused where k does not fit."""
    if k > m:
        with pytest.raises(ValueError, match="order"):
            reference("open_knots")(m, k)
        return
    knots = reference("open_knots")(m, k)
    assert len(knots) == m + k
    assert knots.dtype.kind == "i", "whole numbers may not be rounded ones"
    assert (knots[:k] == 0).all()
    assert (knots[-k:] == m - k + 1).all()
    assert (np.diff(knots[k - 1 : m + 1]) == 1).all()


def test_order_0_is_refused():
    with pytest.raises(ValueError, match="order"):
        reference("open_knots")(5, 0)


@given(st.integers(2, 5), st.lists(st.floats(0.1, 2), min_size=3, max_size=6), st.booleans())
def test_bspline_basis(k, steps, clamped):
    """They add up to 1 on the whole closed domain, live on k spans, and are SciPy's."""
    inner = np.concatenate([[0.0], np.cumsum(steps)])
    open_ends = np.concatenate([np.zeros(k - 1), inner, np.full(k - 1, inner[-1])])
    knots = open_ends if clamped else np.arange(len(open_ends)) / 3
    m = len(knots) - k
    t = np.linspace(knots[k - 1], knots[m], 23)
    N = reference("bspline_basis")(t, knots, k)
    assert N.shape == (23, m)
    assert (N >= 0).all()
    near(N.sum(axis=-1), 1.0)
    for i in range(m):
        near(N[(t < knots[i]) | (t > knots[i + k]), i], 0.0)
    near(N, BSpline(knots, np.eye(m), k - 1)(t), 10)


@given(splines(), arrays(float, (3, 3), elements=numbers), arrays(float, 3, elements=numbers))
def test_bspline_patch(spline, M, shift):
    """Corners (orders above 1 or not), box, affine maps, local control, and SciPy's curves along the edges."""
    P, k, l = spline  # noqa: E741 (the order along w, as the lecture names it)
    S = reference("bspline_patch")(U, W, P, k, l)
    near(S[[0, 0, -1, -1], [0, -1, 0, -1]], P[[0, 0, -1, -1], [0, -1, 0, -1]], 20)
    near(S, np.clip(S, P.min((0, 1)), P.max((0, 1))), 20)
    near(reference("bspline_patch")(U, W, P @ M + shift, k, l), S @ M + shift, 400)
    m = len(P)
    moved = P.copy()
    moved[0, 0] += 7
    beyond = U[:, 0] * (m - k + 1) >= 1 if m > k else np.zeros(13, bool)
    near(reference("bspline_patch")(U, W, moved, k, l)[beyond], S[beyond], 20)
    edge = BSpline(reference("open_knots")(m, k).astype(float), P[:, 0], k - 1)
    near(S[:, 0], edge(U[:, 0] * (m - k + 1)), 40)


@given(arrays(float, (4, 3, 3), elements=numbers))
def test_the_bezier_case(P):
    near(reference("bspline_patch")(U, W, P, 4, 3), dx.BezierPatch(P)(U, W), 40)


@given(splines(), st.floats(0.1, 10), st.data())
def test_nurbs_patch(spline, factor, data):
    """Equal weights, all weights times one number, the box; the formula with the B-spline patch above and below."""
    P, k, l = spline  # noqa: E741
    h = data.draw(arrays(float, P.shape[:2], elements=st.floats(0.1, 10)))
    S = reference("nurbs_patch")(U, W, P, h, k, l)
    near(reference("nurbs_patch")(U, W, P, factor * h, k, l), S, 100)
    near(reference("nurbs_patch")(U, W, P, np.full(P.shape[:2], factor), k, l), reference("bspline_patch")(U, W, P, k, l), 100)
    near(S, np.clip(S, P.min((0, 1)), P.max((0, 1))), 100)
    lifted = np.concatenate([h[..., None] * P[..., :2], h[..., None]], axis=-1)  # x, y and the weight as three coordinates
    above = reference("bspline_patch")(U, W, lifted, k, l)
    near(S[..., :2], above[..., :2] / above[..., 2:], 1000)


@given(st.floats(0.1, 10), st.floats(-10, 10).filter(bool))
def test_the_quarter_lies_on_the_cylinder(r, h):
    S = A7["nurbs_quarter_cylinder"].judged_as(reference("nurbs_quarter_cylinder")(r, h))(U, W)
    near(S[..., 0] ** 2 + S[..., 1] ** 2, r**2, 4 * r**2)
    near(S[..., 2], h * W, 4 * abs(h))
    assert (S[..., :2] >= -1e-15 * r).all()


@pytest.mark.parametrize("row", [(1, 1, 2), (4, 2, 2), (0.5, 0.1, 0.04)])
def test_other_weights_that_give_the_same_quarter_are_right(row):
    """Any with h0 h2 / h1² = 2: the same points at another speed, for full marks."""
    verdict = judge(A7["nurbs_quarter_cylinder"], lambda r, h: quarter(r, h, row), seed=b"hidden")
    assert (verdict.outcome, verdict.fraction, verdict.tier) == ("passed", 1.0, "same set"), verdict.message


@pytest.mark.parametrize("c", [1 + 1e-6, 1.001, 1.0095, 1.02])
def test_weights_that_hardly_change_the_speed_are_right_too(c):
    """So near to the reference point by point that it could be a rounded constant: the set decides."""
    verdict = judge(A7["nurbs_quarter_cylinder"], lambda r, h: quarter(r, h, (1, c * ROOT, c**2)), seed=b"hidden")
    assert (verdict.outcome, verdict.fraction, verdict.tier) == ("passed", 1.0, "same set"), verdict.message


def test_wrong_weights_are_not_sought_in_the_line_that_makes_x():
    """cos(45), 45 taken for radians: x and y are wrong, and no line of the answer makes them."""
    verdict = judge(A7["nurbs_quarter_cylinder"], lambda r, h: quarter(r, h, (1, np.cos(45), 1)))
    assert "x and y are wrong" in verdict.message
    assert "the line that makes" not in verdict.message


@pytest.mark.parametrize(
    ("answer", "fraction", "tier"),
    [
        (lambda r, h: quarter(r, h, turned=True), 0.5, "relabelled"),
        (lambda r, h: quarter(r, h, (1, 0.7071, 1)), 0.8, "close"),
        (lambda r, h: quarter(r, h, (1, 0.707107, 1)), 0.8, "close"),
        (lambda r, h: quarter(r, h, (1, 2 * 0.707107, 4)), 0.8, "close"),
        (lambda r, h: quarter(r, h, (1, 2 * 0.7071, 4)), 0.0, "different"),  # and not moved, by a millionth
        (lambda r, h: quarter(r, h, (1, 0.9, 1)), 0.0, "different"),
        (lambda r, h: quarter(r, h)[0], 0.0, "shape"),
        (lambda r, h: quarter(r, h)[::-1], 0.0, "shape"),
        (lambda r, h: (quarter(r, h)[0].swapaxes(0, 1), quarter(r, h)[1].T), 0.0, "shape"),
        (lambda r, h: quarter(r, h, (1, -ROOT, 1)), 0.0, "shape"),
    ],
    ids=[
        "turned",
        "rounded",
        "less",
        "at-another-speed",
        "more",
        "another",
        "net-only",
        "weights-first",
        "w-first",
        "negative",
    ],
)
def test_answers_that_are_not_the_quarter(answer, fraction, tier):
    verdict = judge(A7["nurbs_quarter_cylinder"], answer, seed=b"hidden")
    assert (verdict.fraction, verdict.tier) == (fraction, tier), verdict.message
    if tier == "shape":
        assert any(word in verdict.message for word in ("(3, 2, 3)", "return P, weights", "greater than 0")), verdict.message
