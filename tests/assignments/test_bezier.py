"""A6: the printed numbers of the syllabus, the checks that need no reference, and oracles that take another road."""

from math import comb

import directrix as dx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from autograder.catalogue import shipped
from autograder.judge import judge

U, W = np.linspace(0, 1, 13)[:, None], np.linspace(0, 1, 11)[None, :]
A6 = shipped().assignment("A6").exercises
numbers = st.floats(-5, 5, allow_subnormal=False)
nets = st.tuples(st.integers(2, 5), st.integers(2, 5)).flatmap(lambda shape: arrays(float, (*shape, 3), elements=numbers))
bicubic = arrays(float, (4, 4, 3), elements=numbers)
BP, BP3 = (drawn.arguments["P"] for drawn in A6["bezier_patch"].draw()[:2])
G = A6["hermite_to_bezier"].draw()[0].arguments["G"]
MF = np.array([[2, -2, 1, 1], [-3, 3, -2, -1], [0, 0, 1, 0], [1, 0, 0, 0]])
MB = np.array([[-1, 3, -3, 1], [3, -6, 3, 0], [-3, 3, 0, 0], [1, 0, 0, 0]])


def reference(id):
    return A6[id].reference


def near(actual, expected, scale=1.0):
    """Equal to rounding: a few hundred units in the last place of the largest number involved."""
    np.testing.assert_allclose(actual, np.broadcast_to(expected, np.shape(actual)), rtol=0, atol=1e-13 * max(scale, 1.0))


@pytest.mark.parametrize(
    ("id", "place", "expected"),
    [
        ("bezier_patch", (0.5, 0.5, BP), (4.203125, 5.640625, -0.09375)),
        ("bezier_patch", (0.25, 0.75, BP), (1.51342773, 8.9519043, -0.0766601562)),
        ("bernstein", (3, np.arange(11) / 10), [(1, 0, 0, 0), (0.729, 0.243, 0.027, 0.001), (0.512, 0.384, 0.096, 0.008)]),
        ("iso_curve_net", (BP3, 0.3), [(3.051, -0.504, -1.198), (4.7, 2.956, -0.071), (2.222, 7.846, -0.362)]),
        ("bezier_to_hermite", (BP,), [(-2, 2, 2), (-1, 14, -2), (9, 0, -12)]),
        ("hermite_to_bezier", (G,), [(0, 0, 0), (1 / 3, 5 / 3, 2 / 3), (4 / 3, 3, -1 / 3)]),
    ],
)
def test_the_printed_numbers(id, place, expected):
    """Nine digits were printed; of arrays the first rows, of nets the first points."""
    found = reference(id)(*place)
    rows = found if np.ndim(expected) == 1 or found.ndim == 2 else found[0]
    np.testing.assert_allclose(rows[: len(expected)], expected, rtol=1e-8, atol=1e-8)


@given(st.integers(0, 12), arrays(float, (2, 3), elements=st.floats(0, 1)))
def test_bernstein(n, t):
    """They add up to 1, are symmetric and not negative, and each is the probability of i hits in n."""
    B = reference("bernstein")(n, t)
    assert B.shape == (2, 3, n + 1)
    assert (B >= 0).all()
    near(B.sum(axis=-1), 1.0)
    near(B, reference("bernstein")(n, 1 - t)[..., ::-1], 20)
    hits = np.zeros((*t.shape, n + 1))
    hits[..., 0] = 1.0
    for _ in range(n):  # one more throw
        hits[..., 1:] = t[..., None] * hits[..., :-1] + (1 - t[..., None]) * hits[..., 1:]
        hits[..., 0] *= 1 - t
    near(B, hits)
    assert reference("bernstein")(n, 0.5)[0] == 0.5**n * comb(n, 0)


@given(nets, arrays(float, (3, 3), elements=numbers), arrays(float, 3, elements=numbers))
def test_bezier_patch(P, M, shift):
    """Corners, box, affine maps; the boundary rows are the boundary curves; de Casteljau says the same."""
    S = reference("bezier_patch")(U, W, P)
    near(S[[0, 0, -1, -1], [0, -1, 0, -1]], P[[0, 0, -1, -1], [0, -1, 0, -1]], 20)
    box = P.min((0, 1)), P.max((0, 1))
    near(S, np.clip(S, *box), 20)
    near(reference("bezier_patch")(U, W, P @ M + shift), S @ M + shift, 400)
    near(S[:, 0], dx.BezierCurve(P[:, 0])(U[:, 0]), 40)
    for u, w in ((0.3, 0.8), (1.0, 0.1)):
        rows = P
        while len(rows) > 1:
            rows = (1 - u) * rows[:-1] + u * rows[1:]
        points = rows[0]
        while len(points) > 1:
            points = (1 - w) * points[:-1] + w * points[1:]
        near(reference("bezier_patch")(u, w, P), points[0], 40)


@given(nets, st.floats(0, 1))
def test_iso_curve_net(P, u0):
    """The curve of these points lies on the patch; at the edges they are rows of the net."""
    Q = reference("iso_curve_net")(P, u0)
    assert Q.shape == P.shape[1:]
    near(dx.BezierCurve(Q)(W[0]), reference("bezier_patch")(u0, W[0], P), 40)
    near(reference("iso_curve_net")(P, 0.0), P[0], 20)
    near(reference("iso_curve_net")(P, 1.0), P[-1], 20)


@given(bicubic)
def test_bezier_to_hermite(P):
    """The same surface in both forms, by the matrices of the syllabus; and its derivatives at the corners."""
    G = reference("bezier_to_hermite")(P)
    K = np.linalg.solve(MF.astype(float), MB.astype(float))
    near(G, np.einsum("ai,bj,ijk->abk", K, K, P), 4000)
    patch = dx.BezierPatch(P)
    for i in (0, 1):
        for j in (0, 1):
            for block, nu, nw in (((0, 0), 0, 0), ((2, 0), 1, 0), ((0, 2), 0, 1), ((2, 2), 1, 1)):
                near(G[block[0] + i, block[1] + j], patch.derivative(i, j, nu, nw), 4000)


@given(bicubic)
def test_hermite_to_bezier(G):
    """The way back, both ways round; without twists each corner has a parallelogram."""
    P = reference("hermite_to_bezier")(G)
    near(reference("bezier_to_hermite")(P), G, 4000)
    near(reference("hermite_to_bezier")(reference("bezier_to_hermite")(G)), G, 4000)
    G = G.copy()
    G[2:, 2:] = 0
    Q = reference("hermite_to_bezier")(G)
    near(Q[1, 1], Q[1, 0] + Q[0, 1] - Q[0, 0], 100)
    near(Q[2, 1], Q[2, 0] + Q[3, 1] - Q[3, 0], 100)
    near(Q[[0, 3]], P[[0, 3]], 100)


def test_an_array_of_another_shape_is_told_its_shape():
    """A net that comes out as 16 points in a line is right but for that; a curve with the wrong number of points is not."""
    flat = judge(A6["bezier_to_hermite"], lambda P: reference("bezier_to_hermite")(P).reshape(16, 3))
    assert flat.tier == "shape"
    assert "(16, 3)" in flat.message
    assert "(4, 4, 3)" in flat.message
    functions_first = judge(A6["bernstein"], lambda n, t: np.moveaxis(reference("bernstein")(n, t), -1, 0))
    assert functions_first.fraction < 1.0
    assert "shape" in functions_first.message
