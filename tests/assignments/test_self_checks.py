"""The checks that need no reference, as the syllabus gives them to the learner: what must hold for the reference itself."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autograder.catalogue import shipped

U, W = np.linspace(0, 1, 13)[:, None], np.linspace(0, 1, 11)[None, :]
lengths = st.floats(0.1, 10)
numbers = st.floats(-5, 5)
spots = st.tuples(numbers, numbers, numbers).map(np.array)
directions = spots.filter(lambda v: np.linalg.norm(v) > 0.1)
angles = st.floats(-7, 7)


def reference(id):
    return shipped().find(id).reference


def near(actual, expected, scale=1.0):
    """Equal to rounding: a few hundred units in the last place of the largest number involved."""
    np.testing.assert_allclose(actual, np.broadcast_to(expected, np.shape(actual)), rtol=0, atol=1e-13 * max(scale, 1.0))


def curve(t):
    return np.stack([2 + t, 3 * t - 0.5, 0.7 - t**2], axis=-1)


def distance_to_axis(points, point, axis):
    v = points - point
    k = axis / np.linalg.norm(axis)
    return np.linalg.norm(v - (v @ k)[..., None] * k, axis=-1), v @ k


@given(lengths, st.one_of(lengths, lengths.map(lambda h: -h)))
def test_cylinder(r, h):
    S = reference("cylinder")(U, W, r, h)
    near(S[..., 0] ** 2 + S[..., 1] ** 2, r**2, 4 * r**2)
    near(S[..., 2], h * W, 4 * abs(h))
    near(reference("cylinder")(0.25, W[0], r, h), np.stack([0 * W[0], 0 * W[0] + r, h * W[0]], -1), 4 * max(r, abs(h)))


@given(lengths, lengths, lengths)
def test_frustum(r1, r2, h):
    S = reference("frustum")(U, W, r1, r2, h)
    near(np.hypot(S[..., 0], S[..., 1]), r1 + (r2 - r1) * S[..., 2] / h, 10 * max(r1, r2))
    near(reference("frustum")(U, W, r1, r1, h), reference("cylinder")(U, W, r1, h), 10 * max(r1, h))


def test_the_apex_is_one_point():
    for r1, r2, edge, z in [(2.0, 0.0, 1.0, 3.0), (0.0, 2.0, 0.0, 0.0)]:
        near(reference("frustum")(U[:, 0], edge, r1, r2, 3.0), [0, 0, z], 4)


@given(lengths)
def test_sphere(r):
    S = reference("sphere")(U, W, r)
    near(np.linalg.norm(S, axis=-1), r, 4 * r)
    near(S[0], [0, 0, -r], 4 * r)
    near(S[-1], [0, 0, r], 4 * r)
    assert (S[:, 0, 0] >= -1e-15 * r).all(), "the generatrix lies on the side x >= 0"


@given(lengths, st.floats(1.0, 4.0))
def test_torus(r, ratio):
    R = ratio * r
    S = reference("torus")(U, W, R, r)
    near((np.hypot(S[..., 0], S[..., 1]) - R) ** 2 + S[..., 2] ** 2, r**2, 10 * (R + r) ** 2)
    near(S[0], S[-1], 10 * (R + r))
    near(S[:, 0], S[:, -1], 10 * (R + r))


@given(lengths, lengths)
def test_only_the_torus_without_R_is_a_sphere(R, r):
    """The distance from the origin is constant where the class says sphere, and only there."""
    for centre in (0.0, R):
        distance = np.linalg.norm(reference("torus")(U, W, centre, r), axis=-1)
        assert (np.ptp(distance) < 1e-12 * (centre + r)) == (reference("torus_class")(centre, r) == "sphere")


@given(spots, directions)
def test_direction_cosines(a, step):
    *cosines, d = reference("direction_cosines")(a, a + step)
    near(np.square(cosines).sum(), 1.0)
    near(d * np.array(cosines), (a + step) - a, 10)


@given(directions, numbers)
def test_linear_sweep(direction, d):
    S = reference("linear_sweep")(U, W, curve, direction, d)
    near(S[:, 0], curve(U[:, 0]), 10)
    near(np.linalg.norm(S[:, -1] - S[:, 0], axis=-1), abs(d), 10)


@given(spots, directions, spots)
def test_linear_sweep_by_two_points(a, step, shift):
    """The two points may be moved together: only their difference counts."""
    S = reference("linear_sweep_points")(U, W, curve, a, a + step)
    near(S[:, 0], curve(U[:, 0]), 10)
    near(reference("linear_sweep_points")(U, W, curve, a + shift, a + step + shift), S, 40)
    near(reference("linear_sweep")(U, W, curve, step, np.linalg.norm(step)), S, 40)


@given(spots, directions, directions)
def test_plane_and_triangle(p1, e2, e3):
    """The triangle is the part of the plane patch that the mask keeps, and its corners are where the statement says."""
    if np.linalg.norm(np.cross(e2, e3)) < 0.05:
        return
    p2, p3 = p1 + e2, p1 + e3
    normal = np.cross(e2, e3)
    for id in ("plane3", "triangle_patch"):
        S = reference(id)(U, W, p1, p2, p3)
        near((S - p1) @ normal, 0.0, 50 * np.linalg.norm(normal))
        near(S[0, 0], p1, 20)
        near(S[-1, 0], p2, 20)
    near(reference("plane3")(0.0, 1.0, p1, p2, p3), p3, 20)
    near(reference("triangle_patch")(U[:, 0], 1.0, p1, p2, p3), p3, 20)
    frame = np.linalg.lstsq(np.stack([e2, e3], axis=1), (S - p1).reshape(-1, 3).T, rcond=None)[0]
    assert (frame > -1e-9).all(), "barycentric coordinates of the patch"
    assert (frame.sum(axis=0) < 1 + 1e-9).all()


def test_triangle_mask():
    keep = reference("triangle_mask")
    assert keep(0.0, 0.0)
    assert keep(1.0, 0.0)
    assert keep(0.0, 1.0)
    assert not keep(1.0, 1.0)
    t = np.linspace(0, 1, 101)
    assert keep(t, 1 - t).all(), "the edge p2 p3, rounding included"
    assert keep(t[:, None], t[None]).mean() == pytest.approx(0.5, abs=0.01)


@given(st.floats(0.2, 4), st.floats(0.2, 4), st.floats(-3, 3), st.floats(0.5, 3))
def test_cone_from_line(x1, x2, y1, rise):
    """A frustum of the known form, turned and relabelled: (u, w) there is (w, u) here, and the axis z has become y."""
    S = reference("cone_from_line")(U, W, np.array([x1, y1, 0]), np.array([x2, y1 + rise, 0]))
    known = reference("frustum")(W, U, x1, x2, rise)
    near(S[..., 0], known[..., 0], 20)
    near(S[..., 1], known[..., 2] + y1, 20)
    near(S[..., 2], -known[..., 1], 20)


@given(angles)
def test_revolve_y(angle):
    S = reference("revolve_y")(U, W, curve, angle)
    radius, height = distance_to_axis(S, np.zeros(3), np.array([0.0, 1, 0]))
    near(S[:, 0], curve(U[:, 0]), 20)
    near(radius, radius[:, :1], 20)
    near(height, height[:, :1], 20)
    near(reference("revolve_coord")(U, W, curve, "y", angle), S, 20)


@pytest.mark.parametrize(
    ("axis", "start", "end"), [("x", (0, 1, 0), (0, 0, 1)), ("y", (0, 0, 1), (1, 0, 0)), ("z", (1, 0, 0), (0, 1, 0))]
)
def test_the_sense_about_each_axis(axis, start, end):
    """A quarter turn takes each axis to the next."""

    def still(t):
        return np.multiply.outer(np.ones_like(t), start) + 0.0

    near(reference("revolve_coord")(0.5, 1.0, still, axis, np.pi / 2), end)


@given(angles, angles)
def test_revolve_xy_axis(alpha, angle):
    k = np.array([np.cos(alpha), np.sin(alpha), 0.0])
    S = reference("revolve_xy_axis")(U, W, curve, alpha, angle)
    near(S @ k, (S @ k)[:, :1], 20)
    near(S[:, 0], curve(U[:, 0]), 20)
    near(reference("revolve_xy_axis")(U, W, lambda t: np.multiply.outer(t, k), alpha, angle), U[..., None] * k, 20)


@given(angles)
def test_the_two_special_axes_of_the_plane(angle):
    """alpha = 0 is x; alpha = π/2 is y, a free check of the signs of the y matrix."""
    turned = reference("revolve_xy_axis")
    near(turned(U, W, curve, 0.0, angle), reference("revolve_coord")(U, W, curve, "x", angle), 20)
    near(turned(U, W, curve, np.pi / 2, angle), reference("revolve_y")(U, W, curve, angle), 20)


@given(spots, directions, angles, numbers)
def test_revolve_axis(point, axis, angle, along):
    S = reference("revolve_axis")(U, W, curve, point, axis, angle)
    radius, height = distance_to_axis(S, point, axis)
    near(S[:, 0], curve(U[:, 0]), 100)
    near(radius, radius[:, :1], 1000)
    near(height, height[:, :1], 100)
    near(reference("revolve_axis")(U, W, curve, point + along * axis / np.linalg.norm(axis), axis, angle), S, 1000)
    near(reference("revolve_axis")(U, W, curve, point, -axis, -angle), S, 100)


def climbing(t):
    return np.stack([4 - t, 1 + np.sin(t), 2 * t**2 - 3], axis=-1)


@given(spots)
def test_translational_sweep(shift):
    """The generatrix starts in its own place and only moves; it does not matter where the path lies."""
    S = reference("translational_sweep")(U, W, curve, climbing)
    near(S[:, 0], curve(U[:, 0]), 20)
    near(S - S[:1], curve(U) - curve(np.array(0.0)), 40)
    near(reference("translational_sweep")(U, W, curve, lambda t: climbing(t) + shift), S, 40)


@given(spots, directions)
def test_translational_sweep_along_a_line_is_linear(a, step):
    S = reference("translational_sweep")(U, W, curve, lambda t: a + np.multiply.outer(t, step))
    near(S, reference("linear_sweep_points")(U, W, curve, a, a + step), 100)


@given(st.lists(st.tuples(numbers, numbers), min_size=2, max_size=6).map(np.array))
def test_vase(P):
    """Ends of the profile are its first and last point; every w is the same profile, turned; two points make a frustum."""
    S = reference("vase")(U, W, P)
    near(S[0, 0], [P[0, 0], 0, P[0, 1]], 40)
    near(S[-1, 0], [P[-1, 0], 0, P[-1, 1]], 40)
    near(S[..., 0] ** 2 + S[..., 1] ** 2, S[:, :1, 0] ** 2, 400)
    near(S[..., 2], S[:, :1, 2], 40)


@given(lengths, lengths, lengths)
def test_vase_of_two_points(r1, r2, h):
    near(reference("vase")(U, W, [[r1, 0.0], [r2, h]]), reference("frustum")(W, U, r1, r2, h), 20 * max(r1, r2, h))


@given(spots, directions, directions, spots)
def test_bilinear(p00, a, b, p11):
    """Corners; straight both ways; the second mixed difference is the uw term; planar corners stay in their plane."""
    p01, p10 = p00 + a, p00 + b
    S = reference("bilinear")(U, W, p00, p01, p10, p11)
    near(S[[0, 0, -1, -1], [0, -1, 0, -1]], [p00, p01, p10, p11], 40)
    near(np.diff(S, n=2, axis=0), 0.0, 200)
    near(np.diff(S, n=2, axis=1), 0.0, 200)
    near(np.diff(np.diff(S[::12, ::10], axis=0), axis=1)[0, 0], p00 - p01 - p10 + p11, 100)


@given(spots, directions, directions, st.floats(1e-4, 1e4), angles)
def test_being_planar_survives_motion_scale_and_relabelling(p00, a, b, scale, t):
    """Also the other way round: a corner lifted out of the plane is noticed at every scale."""
    normal = np.cross(a, b)
    if np.linalg.norm(normal) < 0.1 * np.linalg.norm(a) * np.linalg.norm(b):
        return
    planar = reference("bilinear_is_planar")
    c, s = np.cos(t), np.sin(t)
    turn = scale * np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    flat = np.array([p00, p00 + a, p00 + b, p00 + 1.5 * a + 0.5 * b]) @ turn.T
    lifted = flat + np.array([0, 0, 0, 0.1])[:, None] * (normal @ turn.T) / np.linalg.norm(normal)
    for order in ([0, 1, 2, 3], [0, 2, 1, 3], [3, 1, 2, 0], [1, 0, 3, 2]):
        assert planar(*flat[order])
        assert not planar(*lifted[order])


def test_ruled():
    S = reference("ruled")(U, W, curve, climbing)
    near(S[:, 0], curve(U[:, 0]), 20)
    near(S[:, -1], climbing(U[:, 0]), 20)
    near(np.diff(S, n=2, axis=1), 0.0, 40)


@given(spots, spots, spots, spots)
def test_ruled_between_two_lines_is_bilinear(p00, p01, p10, p11):
    if not np.ptp([p00, p01, p10, p11], axis=0).any():
        return
    S = reference("ruled")(
        U, W, lambda t: p00 + np.multiply.outer(t, p10 - p00), lambda t: p01 + np.multiply.outer(t, p11 - p01)
    )
    near(S, reference("bilinear")(U, W, p00, p01, p10, p11), 100)


@given(lengths, lengths, lengths, angles)
def test_ruled_circles(r0, r1, h, phase):
    """How far it draws in; the two families of lines are mirror images; phase 0 is the frustum."""
    scale = 20 * max(r0, r1, h)
    S = reference("ruled_circles")(U, W, r0, r1, h, phase)
    drawn_in = r0**2 * (1 - W) ** 2 + r1**2 * W**2 + 2 * r0 * r1 * W * (1 - W) * np.cos(phase)
    near(S[..., 0] ** 2 + S[..., 1] ** 2, np.broadcast_to(drawn_in, S.shape[:2]), scale**2)
    other = reference("ruled_circles")(1 - U, W, r0, r1, h, -phase)
    near(S * [1, -1, 1], other, scale)
    near(reference("ruled_circles")(U, W, r0, r1, h, 0.0), reference("frustum")(U, W, r0, r1, h), scale)


def tables(m, n):
    """Random tables (m, n, 3)."""
    return st.integers(0, 10**6).map(lambda seed: np.random.default_rng(seed).uniform(-5, 5, (m, n, 3)))


degrees = st.integers(0, 6)


@given(degrees, degrees)
def test_count_coefficients(du, dw):
    """The size of a table with a row for every power of u and a column for every power of w."""
    assert reference("count_coefficients")(du, dw) == np.zeros((du + 1, dw + 1, 3)).size


@given(tables(3, 4))
def test_algebraic_eval(a):
    """S(0,0), S(1,1), the tangent and the twist in the corner, by exact differences of low powers."""
    S = reference("algebraic_eval")
    near(S(0.0, 0.0, a), a[0, 0], 10)
    near(S(1.0, 1.0, a), a.sum(axis=(0, 1)), 100)
    near(S(W, U, a.swapaxes(0, 1)), S(U, W, a), 100)
    near(S(U, 0.0, a), sum(U[..., None] ** i * a[i, 0] for i in range(3)), 100)
    two = a[:2, :2]
    near(S(1.0, 1.0, two) - S(1.0, 0.0, two) - S(0.0, 1.0, two) + S(0.0, 0.0, two), a[1, 1], 100)


@given(st.floats(0, 1))
def test_hermite_basis(t):
    F, mirrored = reference("hermite_basis")(t), reference("hermite_basis")(1 - t)
    near(F[0] + F[1], 1.0)
    near(F[3], -mirrored[2], 10)
    assert F[3] <= 1e-16
    assert F[2] >= -1e-16


@given(tables(4, 4))
def test_hermite_patch(G):
    """The corners, and the tangents and twists by differences of second order, which cubics leave an error of h²."""
    S, h = reference("hermite_patch"), 1e-4
    ends = np.array([0.0, 1.0])
    near(S(ends[:, None], ends, G), G[:2, :2], 20)
    for i, u, du in ((0, 0.0, h), (1, 1.0, -h)):
        for j, w, dw in ((0, 0.0, h), (1, 1.0, -h)):
            along_u = (-3 * S(u, w, G) + 4 * S(u + du, w, G) - S(u + 2 * du, w, G)) / (2 * du)
            along_w = (-3 * S(u, w, G) + 4 * S(u, w + dw, G) - S(u, w + 2 * dw, G)) / (2 * dw)
            twist = (S(u, w, G) - S(u + du, w, G) - S(u, w + dw, G) + S(u + du, w + dw, G)) / (du * dw)
            np.testing.assert_allclose(along_u, G[2 + i, j], atol=1e-4)
            np.testing.assert_allclose(along_w, G[i, 2 + j], atol=1e-4)
            np.testing.assert_allclose(twist, G[2 + i, 2 + j], atol=0.2)


@given(tables(4, 4))
def test_four_equal_twists_cannot_be_seen_in_the_middle(G):
    equal, none = G.copy(), G.copy()
    equal[2:, 2:], none[2:, 2:] = G[3, 3], 0.0
    S = reference("hermite_patch")
    near(S(0.5, 0.5, equal), S(0.5, 0.5, none), 20)
    assert np.abs(S(0.25, 0.75, equal) - S(0.25, 0.75, none)).max() > 0.005 * np.abs(G[3, 3]).max()


@given(tables(4, 4))
def test_hermite_to_algebraic(G):
    a = reference("hermite_to_algebraic")(G)
    near(reference("algebraic_eval")(U, W, a), reference("hermite_patch")(U, W, G), 1000)
    near(a[:2, :2], [[G[0, 0], G[0, 2]], [G[2, 0], G[2, 2]]], 20)
    near(a.sum(axis=(0, 1)), G[1, 1], 1000)


@given(tables(4, 4), st.booleans())
def test_patch_normal(G, collapsed):
    """Of length 1, or 0 where the edge has collapsed; across both tangents; turned round when u and w are exchanged."""
    if collapsed:
        G[:, 0] = 0.0
    n = reference("patch_normal")(U, W, G)
    length = np.linalg.norm(n, axis=-1)
    near(length[:, 0], 0.0 if collapsed else 1.0, 10)
    near(length[:, 1:], 1.0, 10)
    near(reference("patch_normal")(W, U, G.swapaxes(0, 1)), -n, 1e5)
    a = reference("hermite_to_algebraic")(G)
    along_u = reference("algebraic_eval")(U, W, np.arange(1, 4)[:, None, None] * a[1:])
    along_w = reference("algebraic_eval")(U, W, np.arange(1, 4)[:, None] * a[:, 1:])
    near((n * along_u).sum(axis=-1), 0.0, 1e5)
    near((n * along_w).sum(axis=-1), 0.0, 1e5)


@given(tables(4, 3), st.floats(0.1, 0.45), st.floats(0.55, 0.9), st.floats(0.2, 0.8))
def test_npoint_patch(P, one, two, middle):
    """Through the points; and weights that add up to 1: points that are all moved move the patch with them."""
    tu, tw = np.array([0, one, two, 1]), np.array([0, middle, 1])
    S = reference("npoint_patch")
    near(S(tu[:, None], tw, P, tu, tw), P, 100)
    near(S(U, W, P + [1, 2, 3], tu, tw), S(U, W, P, tu, tw) + [1, 2, 3], 10_000)
