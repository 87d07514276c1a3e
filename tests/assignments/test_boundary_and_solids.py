"""A8: the printed numbers of the syllabus, the checks that need no reference, and oracles that take another road."""

from itertools import product
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
T = np.linspace(0, 1, 13)
A8 = shipped().assignment("A8").exercises
numbers = st.floats(-5, 5, allow_subnormal=False)
blocks = arrays(float, (2, 2, 3), elements=numbers)
vectors = arrays(float, 3, elements=numbers)
directions = vectors.filter(lambda v: np.linalg.norm(v) > 0.1)
solids = arrays(float, (4, 4, 4, 3), elements=numbers)
seeds = st.integers(0, 10**6)


def reference(id):
    return A8[id].reference


def drawn(id, number=0, seed=0):
    return A8[id].draw(seed)[number].arguments


def near(actual, expected, scale=1.0):
    """Equal to rounding: a few hundred units in the last place of the largest number involved."""
    np.testing.assert_allclose(actual, np.broadcast_to(expected, np.shape(actual)), rtol=0, atol=1e-13 * max(scale, 1.0))


def rotation(axis, angle):
    """Rodrigues' matrix."""
    k = axis / np.linalg.norm(axis)
    K = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def joined(p, pu, pw):
    """Four Hermite curves with these ends and tangents, as c0, c1, d0, d1."""
    along_u = [dx.HermiteCurve(p[0, j], p[1, j], pu[0, j], pu[1, j]) for j in (0, 1)]
    along_w = [dx.HermiteCurve(p[i, 0], p[i, 1], pw[i, 0], pw[i, 1]) for i in (0, 1)]
    return *along_u, *along_w


def assembled(p, pu, pw, twists):
    return np.concatenate([np.concatenate([p, pw], axis=1), np.concatenate([pu, twists], axis=1)])


@pytest.mark.parametrize(
    ("id", "place", "expected"),
    [
        ("coons", (0.5, 0.5), (2.875, 1.625, 1)),
        ("coons", (0.25, 0.75), (1.9296875, 2.796875, 0.921875)),
        ("ferguson", (0.5, 0.5), (2.875, 1.625, 1)),
        ("ferguson", (0.25, 0.75), (1.92089844, 2.74414062, 0.904296875)),
        ("hyperpatch", (0.5, 0.5, 0.5), (4.47851562, 5.9609375, 7.58984375)),
        ("hyperpatch", (0.25, 0.5, 0.75), (2.12234497, 6.05993652, 11.3635254)),
    ],
)
def test_the_printed_points(id, place, expected):
    """Nine digits were printed, for the lecture data."""
    np.testing.assert_allclose(reference(id)(*place, *drawn(id).values()), expected, rtol=1e-8, atol=1e-8)


@pytest.mark.parametrize(
    ("id", "expected"),
    [("coons_twists", [(-4, -2, 1), (0, -3, 0), (2, 3, 4)]), ("hyperpatch_faces", [(1, -1, -1), (-1, -1, 6), (1, 0, 9)])],
)
def test_the_printed_rows(id, expected):
    """The first three vectors of the answer for the lecture data are integers."""
    assert reference(id)(*drawn(id).values()).reshape(-1, 3)[:3].tolist() == [list(row) for row in expected]


def test_heights_over_the_square():
    """CPSC 645, homework 3: S(.5, .5) = (.5, .5, 12.375), and S is (u, w, height) everywhere."""
    S = reference("coons")(U, W, *drawn("coons", 1).values())
    near(reference("coons")(0.5, 0.5, *drawn("coons", 1).values()), [0.5, 0.5, 12.375], 100)
    near(S[..., 0], U, 10)
    near(S[..., 1], W, 10)


@given(st.integers(0, 4), seeds)
def test_curves_meet_under_every_seed_and_the_patch_has_them_for_edges(number, seed):
    curves = drawn("coons", number, seed)
    c0, c1, d0, d1 = curves.values()
    for one, other in ((c0(0.0), d0(0.0)), (c0(1.0), d1(0.0)), (c1(0.0), d0(1.0)), (c1(1.0), d1(1.0))):
        near(one, other, 100)
    for edge, curve in (((T, 0), c0), ((T, 1), c1), ((0, T), d0), ((1, T), d1)):
        near(reference("coons")(*edge, **curves), curve(T), 100)


def test_one_of_the_four_kinds_is_an_arc():
    """All its points have one distance from the centre of the circle through three of them."""
    for seed in range(20):
        arc = drawn("coons", 2, seed)["c1"]
        a, b, c = arc(0.0), arc(0.5), arc(1.0)
        # the circle through three points: its centre solves three planes
        planes = np.stack([b - a, c - a, np.cross(b - a, c - a)])
        centre = np.linalg.solve(planes, [planes[0] @ (a + b) / 2, planes[1] @ (a + c) / 2, planes[2] @ a])
        near(np.linalg.norm(arc(T) - centre, axis=-1), np.linalg.norm(a - centre), 1000)


@given(blocks, blocks)
def test_coons_with_straight_sides_is_the_ruled_surface(p, pu):
    c0, c1, *_ = joined(p, pu, pu)
    d0, d1 = dx.BezierCurve(p[0]), dx.BezierCurve(p[1])
    S = reference("coons")(U, W, c0, c1, d0, d1)
    near(S, (1 - W[..., None]) * c0(U) + W[..., None] * c1(U), 200)


@given(blocks, blocks, blocks)
def test_ferguson(p, pu, pw):
    """Its edges are Hermite cubics, its mixed derivatives at the corners vanish, and it is the cubically blended Coons patch of
    its own edges."""
    S = reference("ferguson")
    c0, c1, d0, d1 = joined(p, pu, pw)
    for edge, curve in (((T, 0), c0), ((T, 1), c1), ((0, T), d0), ((1, T), d1)):
        near(S(*edge, p, pu, pw), curve(T), 100)
    near(dx.Ferguson(p, pu, pw).derivative(np.array([[0.0], [1.0]]), np.array([[0.0, 1.0]]), 1, 1), 0.0, 1000)
    s, t = 3 * U[..., None] ** 2 - 2 * U[..., None] ** 3, 3 * W[..., None] ** 2 - 2 * W[..., None] ** 3
    flat = (1 - t) * ((1 - s) * p[0, 0] + s * p[1, 0]) + t * ((1 - s) * p[0, 1] + s * p[1, 1])
    blended = (1 - t) * c0(U) + t * c1(U) + (1 - s) * d0(W) + s * d1(W) - flat
    near(S(U, W, p, pu, pw), blended, 1000)


@given(blocks, blocks, blocks, blocks)
def test_coons_twists(p, pu, pw, ignored):
    """With them, and whatever stands in G, the Hermite patch is the Coons patch of its edges."""
    twists = reference("coons_twists")(assembled(p, pu, pw, ignored))
    hermite = dx.HermitePatch(assembled(p, pu, pw, twists))(U, W)
    near(hermite, reference("coons")(U, W, *joined(p, pu, pw)), 1000)


@given(blocks, blocks, blocks)
def test_the_middle_of_the_patch_is_blind_to_the_twists(p, pu, pw):
    """The trap of the notebook: at (1/2, 1/2) Ferguson and Coons agree whatever the edges."""
    near(reference("ferguson")(0.5, 0.5, p, pu, pw), reference("coons")(0.5, 0.5, *joined(p, pu, pw)), 1000)


@given(vectors, vectors, vectors, arrays(float, (2, 3), elements=numbers), arrays(float, (2, 3), elements=numbers))
def test_a_translational_surface_has_no_twists(p00, along_u, along_w, pu, pw):
    p = p00 + np.array([[0 * along_u, along_w], [along_u, along_u + along_w]])
    G = assembled(p, np.repeat(pu[:, None], 2, axis=1), np.repeat(pw[None], 2, axis=0), 0 * p)
    near(reference("coons_twists")(G), 0.0, 100)


@given(solids)
def test_hyperpatch(P):
    """Eight corners; a face is the Bezier patch of a layer; the sum written out as the lecture does."""
    ends = np.array([0.0, 1.0])
    near(reference("hyperpatch")(ends[:, None, None], ends[:, None], ends, P), P[::3, ::3, ::3], 100)
    near(reference("hyperpatch")(U, W, 0.0, P), dx.BezierPatch(P[:, :, 0])(U, W), 100)
    place = 0.3, 0.6, 0.85

    def B(i, t):
        return comb(3, i) * t**i * (1 - t) ** (3 - i)

    total = sum(
        B(i, place[0]) * B(j, place[1]) * B(k, place[2]) * P[i, j, k] for i, j, k in product(range(4), range(4), range(4))
    )
    near(reference("hyperpatch")(*place, P), total, 100)


@given(solids)
def test_hyperpatch_faces(P):
    """The Bezier patch of each is the solid with one parameter held, in the order of the statement."""
    faces = reference("hyperpatch_faces")(P)
    for number, (axis, end) in enumerate(product(range(3), (0.0, 1.0))):
        place = [U, W]
        place.insert(axis, end)
        near(dx.BezierPatch(faces[number])(U, W), reference("hyperpatch")(*place, P), 100)


def test_how_many_points_lie_on_faces():
    """56 of the 64: the number that the notebook asks for."""
    P = np.stack(np.meshgrid(*[np.arange(4.0)] * 3, indexing="ij"), axis=-1)
    assert len(np.unique(reference("hyperpatch_faces")(P).reshape(-1, 3), axis=0)) == 56


def test_the_plate_and_the_shaft_are_what_they_were_made_to_be():
    """On the even grid s² less its mean and st are orthogonal to 1, s and t: the least-squares plane is known beforehand."""
    s, t = np.meshgrid(np.linspace(-1, 1, 7), np.linspace(-1, 1, 5), indexing="ij")
    heights = 0.018 * s**2 + 0.018 * s * t
    assert np.ptp(heights) == pytest.approx(0.04, abs=1e-15)
    for number in (0, 3):
        assert reference("flatness")(*drawn("flatness", number).values()) == pytest.approx(0.04, rel=1e-9)
    for number in (0, 3):
        assert reference("cylindricity")(*drawn("cylindricity", number).values()) == pytest.approx(0.035, rel=1e-9)


@given(seeds, directions, st.floats(-3, 3), vectors)
def test_flatness(seed, axis, angle, shift):
    """A rigid motion changes nothing; a perfect plane has none; another road: the normal by the smallest eigenvalue."""
    points = drawn("flatness", 1, seed)["points"]
    value = reference("flatness")(points)
    near(reference("flatness")(points @ rotation(axis, angle).T + 10 * shift), value, 1000)
    away = points - points.mean(axis=0)
    normal = np.linalg.eigh(away.T @ away)[1][:, 0]
    near(np.ptp(away @ normal), value, 1e4)
    perfect = away - np.outer(away @ normal, normal)
    near(reference("flatness")(perfect @ rotation(axis, angle).T + 10 * shift), 0.0, 1000)


@given(seeds, st.floats(-50, 50), st.floats(0.1, 9), st.booleans())
def test_cylindricity(seed, along, factor, backwards):
    """Where on the axis the point is does not matter, nor the length and sense of the direction. Another road: |v x k|."""
    points, point, axis = drawn("cylindricity", 1, seed).values()
    value = reference("cylindricity")(points, point, axis)
    other = reference("cylindricity")(points, point + along * axis, (-factor if backwards else factor) * axis)
    near(other, value, 1e4)
    distances = np.linalg.norm(np.cross(points - point, axis / np.linalg.norm(axis)), axis=-1)
    near(np.ptp(distances), value, 1000)


def test_points_on_the_axis_are_at_no_distance():
    assert reference("cylindricity")([[0, 0, 1], [0, 0, 5], [3, 4, 2]], [0, 0, 0], [0, 0, 2]) == 5.0


def test_the_formula_alone_has_full_marks():
    """Nothing is asked about a direction of no length, of which the task does not speak."""

    def formula(points, axis_point, axis_dir):
        k, v = axis_dir / np.linalg.norm(axis_dir), points - axis_point
        return np.ptp(np.linalg.norm(v - np.outer(v @ k, k), axis=1))

    assert judge(A8["cylindricity"], formula, seed=5).fraction == 1.0


@pytest.mark.parametrize(("id", "answer"), [("flatness", 1e-6), ("cylindricity", 1e-9)])
def test_how_near_a_value_must_come(id, answer):
    """Relative 1e-6 for the flatness, where fits differ in rounding, and 1e-9 where there is nothing to fit."""
    right = reference(id)
    assert judge(A8[id], lambda *data: right(*data) * (1 + answer / 2), seed=3).tier == "identical"
    assert judge(A8[id], lambda *data: right(*data) * (1 + 10 * answer), seed=3).tier == "close"


@pytest.mark.parametrize("form", [list, tuple, lambda faces: [face.tolist() for face in faces]])
def test_six_faces_may_come_as_a_list_of_nets(form):
    right = reference("hyperpatch_faces")
    assert judge(A8["hyperpatch_faces"], lambda P: form(right(P)), seed=3).outcome == "passed"


@pytest.mark.parametrize(
    ("flipped", "words"),
    [
        ("u", "u runs backwards"),
        ("v", "v runs backwards"),
        ("w", "w runs backwards"),
        ("uv", "u and v both run backwards"),
        ("uw", "u and w both run backwards"),
        ("vw", "v and w both run backwards"),
    ],
)
def test_a_solid_that_runs_backwards_is_told_which_way(flipped, words):
    """Three parameters, and a relabelling that is none of the listed mistakes: half of the points, and which parameters."""

    def wrong(u, v, w, P):
        turned = [1 - np.asarray(t) if name in flipped else t for name, t in zip("uvw", (u, v, w), strict=True)]
        return reference("hyperpatch")(*turned, P)

    verdict = judge(A8["hyperpatch"], wrong, seed=3)
    assert (verdict.tier, verdict.mistake, verdict.fraction) == ("relabelled", None, 0.5)
    assert f": {words}." in verdict.message
