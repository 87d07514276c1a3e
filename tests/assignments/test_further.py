"""A9: the printed numbers of the syllabus, and for each of the sixteen tasks an oracle that takes another road.

More than 400 lines, for sixteen tasks that have nothing in common but the assignment.
"""

from fractions import Fraction

import directrix as dx
import numpy as np
import pytest
from geomdl import NURBS, helpers, operations
from geomdl.BSpline import Surface
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.interpolate import BSpline
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from autograder.catalogue import shipped
from autograder.exercise import exercise
from autograder.judge import judge

U, W = np.linspace(0, 1, 9)[:, None], np.linspace(0, 1, 7)[None, :]
T = np.linspace(0, 1, 9)
A9 = shipped().assignment("A9").exercises
numbers = st.floats(-5, 5, allow_subnormal=False)
vectors = arrays(float, 3, elements=numbers)
nets = st.tuples(st.integers(2, 5), st.integers(2, 5)).flatmap(lambda mn: arrays(float, (*mn, 3), elements=numbers))
seeds = st.integers(0, 10**6)
whole = st.integers(-9, 9)


def reference(id):
    return A9[id].reference


def drawn(id, name, seed=0):
    return next(data.arguments for data in A9[id].draw(seed) if data.name == name)


def near(actual, expected, scale=1.0):
    """Equal to rounding: a few hundred units in the last place of the largest number involved."""
    np.testing.assert_allclose(actual, np.broadcast_to(expected, np.shape(actual)), rtol=0, atol=1e-13 * max(scale, 1.0))


def motion(seed):
    """A rotation and a shift."""
    rng = np.random.default_rng(seed)
    return Rotation.random(random_state=rng).as_matrix(), rng.uniform(-3, 3, 3)


# Quadrics --------------------------------------------------------------------------------------------------------------------


@given(st.lists(whole, min_size=10, max_size=10), st.lists(st.tuples(whole, whole, whole), min_size=1, max_size=5))
def test_the_value_is_the_equation_in_exact_fractions(coeffs, points):
    """Whole numbers, so that nothing is rounded on either side."""
    A, B, C, D, E, F, G, H, J, K = map(Fraction, coeffs)
    exact = [
        A * x * x + B * y * y + C * z * z + D * x * y + E * y * z + F * z * x + G * x + H * y + J * z + K for x, y, z in points
    ]
    assert reference("quadric_value")(np.array(coeffs), np.array(points)).tolist() == [float(value) for value in exact]


@given(vectors, st.floats(0.1, 5), arrays(float, (6, 3), elements=numbers))
def test_the_value_of_a_sphere_tells_inside_from_outside(centre, r, X):
    """|x - c|² - r²: below 0 inside, above 0 outside."""
    coeffs = [1, 1, 1, 0, 0, 0, *(-2 * centre), centre @ centre - r**2]
    near(reference("quadric_value")(np.array(coeffs), X), ((X - centre) ** 2).sum(axis=1) - r**2, 300)


SIXTEEN = {
    "ellipsoid": (1, 2, 3, 0, 0, 0, 0, 0, 0, -1),
    "hyperboloid of one sheet": (1, 2, -3, 0, 0, 0, 0, 0, 0, -1),
    "hyperboloid of two sheets": (1, 2, -3, 0, 0, 0, 0, 0, 0, 1),
    "cone": (1, 2, -3, 0, 0, 0, 0, 0, 0, 0),
    "elliptic paraboloid": (1, 2, 0, 0, 0, 0, 0, 0, -1, 0),
    "hyperbolic paraboloid": (1, -2, 0, 0, 0, 0, 0, 0, -1, 0),
    "elliptic cylinder": (1, 2, 0, 0, 0, 0, 0, 0, 0, -1),
    "hyperbolic cylinder": (1, -2, 0, 0, 0, 0, 0, 0, 0, -1),
    "parabolic cylinder": (1, 0, 0, 0, 0, 0, 0, 0, -1, 0),
    "intersecting planes": (1, -2, 0, 0, 0, 0, 0, 0, 0, 0),
    "parallel planes": (1, 0, 0, 0, 0, 0, 0, 0, 0, -1),
    "coincident planes": (1, 0, 0, 0, 0, 0, 0, 0, 0, 0),
    "line": (1, 2, 0, 0, 0, 0, 0, 0, 0, 0),
    "point": (1, 2, 3, 0, 0, 0, 0, 0, 0, 0),
    "empty": (1, 2, 0, 0, 0, 0, 0, 0, 0, 1),
    "everything": (0,) * 10,
}


@pytest.mark.parametrize("kind", SIXTEEN)
def test_sixteen_classes_upright_and_after_a_motion(kind):
    """The class belongs to the surface: not to its place, its slant, or the factor of its equation."""
    form = SIXTEEN[kind]
    assert reference("quadric_class")(np.array(form, dtype=float)) == kind
    x, y, z = np.eye(4)[:3]
    terms = [(x, x), (y, y), (z, z), (x, y), (y, z), (z, x), (x, None), (y, None), (z, None), (None, None)]
    one = np.eye(4)[3]
    Q = sum(c * np.outer(one if a is None else a, one if b is None else b) for c, (a, b) in zip(form, terms, strict=True))
    for seed in range(25):
        R, shift = motion(seed)
        back = np.eye(4)
        back[:3, :3], back[:3, 3] = R.T, -R.T @ shift
        q = back.T @ (Q + Q.T) @ back * [0.3, -2.0][seed % 2]
        moved = [
            q[0, 0],
            q[1, 1],
            q[2, 2],
            2 * q[0, 1],
            2 * q[1, 2],
            2 * q[2, 0],
            2 * q[0, 3],
            2 * q[1, 3],
            2 * q[2, 3],
            q[3, 3],
        ]
        assert reference("quadric_class")(np.array(moved)) == kind


def test_the_data_ask_for_all_sixteen():
    """Whoever forgets one class is told."""
    for seed in range(5):
        kinds = [reference("quadric_class")(**data.arguments) for data in A9["quadric_class"].draw(seed)]
        assert set(kinds) == set(SIXTEEN)


# Turning ---------------------------------------------------------------------------------------------------------------------


def test_the_printed_point_of_the_screw():
    """A line of length 3 out of the axis, 10 forward in one turn; half-way along and half-way round."""
    near(reference("screw_sweep")(0.5, 0.5, **drawn("screw_sweep", "printed")), [5, -1.5, 0], 10)


@given(st.sampled_from(["any_screw", "left_handed", "screwed_back"]), seeds)
def test_the_screw_is_a_rotation_and_a_shift(name, seed):
    """SciPy's rotation about x, applied to the curve as it stands."""
    curve, pitch, turns = drawn("screw_sweep", name, seed).values()
    for w in (0.0, 0.3, 1.0):
        moved = Rotation.from_rotvec([2 * np.pi * turns * w, 0, 0]).apply(curve(T)) + [pitch * turns * w, 0, 0]
        near(reference("screw_sweep")(T, w, curve, pitch, turns), moved, 30)


def surface_of(answer):
    return A9["nurbs_revolve"].judged_as(answer)


@pytest.mark.parametrize("seed", range(5))
def test_ball_and_ring_are_exact(seed):
    """|S| = 2 on the sphere; on the torus the tube has the radius of the profile's circle."""
    S = surface_of(reference("nurbs_revolve")(**drawn("nurbs_revolve", "ball", seed)))(U, W)
    near(np.linalg.norm(S, axis=-1), 2, 10)
    profile, h = drawn("nurbs_revolve", "ring", seed).values()
    R, r = profile[0, 0], -profile[0, 1]
    S = surface_of(reference("nurbs_revolve")(profile, h))(U, W)
    near(np.hypot(np.hypot(S[..., 0], S[..., 1]) - R, S[..., 2]), r, 100)


@given(st.sampled_from(["ball", "ring", "any_vase", "bucket"]), seeds)
def test_geomdl_evaluates_the_net_to_the_turned_profile(name, seed):
    """Distance from the axis and height of every point are those of the rational profile; whole turn, positive sense."""
    profile, h = drawn("nurbs_revolve", name, seed).values()
    P, weights, knots = reference("nurbs_revolve")(profile, h)
    other = NURBS.Surface()
    other.degree_u, other.degree_v = len(P) - 1, 2
    other.set_ctrlpts(
        np.concatenate([P * weights[..., None], weights[..., None]], axis=-1).reshape(-1, 4).tolist(), *weights.shape
    )
    other.knotvector_u, other.knotvector_v = [0] * len(P) + [1] * len(P), knots.tolist()
    curve = dx.NurbsCurve(np.column_stack([profile, np.zeros(len(h))]), h, len(h))
    for u, w in ((0.0, 0.1), (0.3, 0.125), (0.5, 0.6), (1.0, 0.9)):
        x, y, z = other.evaluate_single((u, w))
        near((np.hypot(x, y), z), curve(u)[:2], 1000)
        near(surface_of((P, weights, knots))(u, w), (x, y, z), 1000)
        if np.hypot(x, y) > 1e-6:
            assert np.floor(np.arctan2(y, x) / (np.pi / 2)) % 4 == np.floor(4 * w)


SWEPT = {
    "cylinder": "elliptic cylinder",
    "cone": "cone",
    "hyperboloid": "hyperboloid of one sheet",
    "plane": "coincident planes",
}


@pytest.mark.parametrize("seed", range(10))
def test_the_swept_line_is_the_quadric_of_that_name(seed):
    """Points of the turned line determine a quadric, and its class is the answer."""
    for data in A9["revolved_line_kind"].draw(seed):
        if data.name in ("no_direction", "no_axis"):
            continue
        p, d, point, axis = data.arguments.values()
        kind = reference("revolved_line_kind")(p, d, point, axis)
        line = p + np.linspace(-2, 3, 9)[:, None] * d / np.linalg.norm(d)
        k = axis / np.linalg.norm(axis)
        swept = np.concatenate([Rotation.from_rotvec(a * k).apply(line - point) for a in np.linspace(0, 2 * np.pi, 13)[:-1]])
        away = np.linalg.norm(np.cross(swept, k), axis=-1)
        if kind == "line":
            assert away.max() < 1e-12
        elif kind == "plane":
            assert np.ptp(swept @ k) < 1e-12
        elif data.name != "nearly_parallel":
            assert dx.Quadric.through(swept).classify(1e-9).kind == SWEPT[kind], data.name
        else:
            assert kind == "cylinder"
            assert np.ptp(away) < 1e-10


@pytest.mark.parametrize("missing", ["d", "axis"])
def test_no_direction_is_refused(missing):
    line = {**drawn("revolved_line_kind", "lecture"), missing: np.zeros(3)}
    with pytest.raises(ValueError, match=r"direction must not be \(0, 0, 0\)"):
        reference("revolved_line_kind")(**line)


# Nets ------------------------------------------------------------------------------------------------------------------------


@given(nets, st.floats(0.05, 0.95))
def test_both_pieces_are_the_surface_they_were_cut_from(P, u0):
    first, second = reference("bezier_split")(P, u0)
    S = dx.BezierPatch(P)
    near(dx.BezierPatch(first)(U, W), S(u0 * U, W), 100)
    near(dx.BezierPatch(second)(U, W), S(u0 + (1 - u0) * U, W), 100)


def test_geomdl_cuts_into_the_same_nets():
    """A Bezier patch is to geomdl a B-spline without inner knots."""
    P, u0 = drawn("bezier_split", "lecture").values()
    whole = Surface()
    whole.degree_u = whole.degree_v = 3
    whole.set_ctrlpts(P.reshape(-1, 3).tolist(), 4, 4)
    whole.knotvector_u = whole.knotvector_v = [0] * 4 + [1] * 4
    for ours, piece in zip(reference("bezier_split")(P, u0), operations.split_surface_u(whole, u0), strict=True):
        near(ours, np.reshape(piece.ctrlpts, (4, 4, 3)), 100)


@given(nets)
def test_one_degree_more_is_the_same_surface_and_geomdl_agrees(P):
    Q = reference("elevate_u")(P)
    assert Q.shape == (len(P) + 1, *P.shape[1:])
    near(dx.BezierPatch(Q)(U, W), dx.BezierPatch(P)(U, W), 100)
    for j in range(P.shape[1]):
        near(Q[:, j], helpers.degree_elevation(len(P) - 1, P[:, j].tolist()), 100)


@given(arrays(float, (4, 4, 3), elements=numbers))
def test_the_uniform_piece_is_scipys_spline_on_whole_numbers(P):
    """Knots 0, 1, ..., 7: the piece from 3 to 4."""
    along_u = BSpline(np.arange(8.0), P, 3)(3 + T)
    grid = np.stack([BSpline(np.arange(8.0), row, 3)(3 + T) for row in along_u])
    near(reference("uniform_bicubic")(T[:, None], T[None, :], P), grid, 100)


@given(arrays(float, (4, 4, 3), elements=numbers))
def test_the_bezier_patch_passes_through_the_sixteen_points(P):
    net = reference("points16_to_bezier")(P)
    near(dx.BezierPatch(net)(np.arange(4)[:, None] / 3, np.arange(4)[None, :] / 3), P, 1000)


# Boundaries ------------------------------------------------------------------------------------------------------------------


ANSWERS = {
    "they_meet": True, "a_mountain": True, "rough_work": True, "unit_square": True, "head_to_tail": False,
    "a_speck_of_dust": False, "open_at_p00": False, "open_at_p10": False, "open_at_p01": False, "open_at_p11": False,
    "open_everywhere": False,
}  # fmt: skip


@pytest.mark.parametrize("seed", range(5))
def test_corners_agree_where_a_coons_patch_can_be_hung(seed):
    """The library refuses just those edges (its own tolerance lies between the gaps and the roundings here)."""
    for data in A9["corners_agree"].draw(seed):
        *curves, rtol = data.arguments.values()
        assert reference("corners_agree")(*curves, rtol) is ANSWERS[data.name], data.name
        if data.name not in ("rough_work", "a_mountain"):
            if ANSWERS[data.name]:
                dx.Coons(*curves)
            else:
                with pytest.raises(dx.GeometryError):
                    dx.Coons(*curves)


@pytest.mark.parametrize("word", [True, False])
def test_one_word_for_all_curves_earns_nothing(word):
    verdict = judge(A9["corners_agree"], lambda *arguments: word, seed=b"hidden", figure=False)
    assert verdict.fraction == 0.0


@pytest.mark.parametrize(("gap", "agrees"), [(0.99e-3, True), (1.01e-3, False)])
def test_the_gap_is_measured_by_the_box_of_all_ends(gap, agrees):
    """A rectangle of 3 by 4, whose diagonal is 5; one curve begins too high by a share of that."""
    c0, c1 = dx.Line([0, 0, 5 * gap], [3, 0, 0]), dx.Line([0, 4, 0], [3, 4, 0])
    d0, d1 = dx.Line([0, 0, 0], [0, 4, 0]), dx.Line([3, 0, 0], [3, 4, 0])
    assert reference("corners_agree")(c0, c1, d0, d1, 1e-3) is agrees


@given(st.sampled_from(["any_edges", "ferguson_edges", "three_sided", "flat_parallelogram"]), seeds)
def test_cubic_coons_has_the_four_edges(name, seed):
    curves = drawn("cubic_coons", name, seed)
    for edge, curve in zip(((T, 0), (T, 1), (0, T), (1, T)), curves.values(), strict=True):
        near(reference("cubic_coons")(*edge, **curves), curve(T), 100)


def test_cubic_coons_of_hermite_edges_is_ferguson():
    """Mortenson's point: the same patch, from curves and from corners and tangents."""
    curves = list(drawn("cubic_coons", "ferguson_edges").values())
    p = np.array([[curves[j](float(i)) for j in (0, 1)] for i in (0, 1)])
    h = 1e-6
    ends = [(0.0, h), (1 - h, 1.0)]
    pu = np.array([[(curves[j](b) - curves[j](a)) / h for j in (0, 1)] for a, b in ends])
    pw = np.array([[(curves[2 + i](b) - curves[2 + i](a)) / h for a, b in ends] for i in (0, 1)])
    S = reference("cubic_coons")(U, W, *curves)
    np.testing.assert_allclose(S, dx.Ferguson(p, pu, pw)(U, W), atol=1e-4)  # the tangents are one-sided differences
    assert np.abs(S - dx.Coons(*curves)(U, W)).max() > 0.05  # and the plain Coons patch is another


@given(st.sampled_from(["bicubic", "quartic_by_cubic", "quadratic_by_quintic", "translational"]), seeds)
def test_the_net_is_that_of_the_coons_patch(name, seed):
    polygons = drawn("coons_bezier_net", name, seed)
    net = reference("coons_bezier_net")(**polygons)
    for row, polygon in zip((net[:, 0], net[:, -1], net[0], net[-1]), polygons.values(), strict=True):
        near(row, polygon, 100)
    near(dx.BezierPatch(net)(U, W), dx.Coons(*(dx.BezierCurve(polygon) for polygon in polygons.values()))(U, W), 300)


# Measuring -------------------------------------------------------------------------------------------------------------------


def test_the_printed_tangents():
    """Saxena and Sahay, Example 7.9: t01 and t21; all tangents along u are (1, 0, 0) but the last, s12."""
    pu, pw = reference("fmill_tangents")(**drawn("fmill_tangents", "printed"))
    near(pw[0, 1], np.array([0, 1, 2]) / np.sqrt(5))
    near(pw[2, 1], np.array([0, 1, 4]) / np.sqrt(17))
    near(pu[1, 0], [1, 0, 0])
    near(pu[1, 2], np.array([2, 0, 2]) / np.sqrt(8))
    assert not pu[[0, -1]].any()
    assert not pw[:, [0, -1]].any()


@given(seeds, st.floats(0.1, 10))
def test_tangents_move_and_grow_with_the_points(seed, factor):
    """A rule for shapes: turn, shift and enlarge the points, and the tangents are turned and enlarged."""
    P = drawn("fmill_tangents", "any_grid", seed)["P"]
    R, shift = motion(seed)
    for before, after in zip(reference("fmill_tangents")(P), reference("fmill_tangents")(factor * P @ R + shift), strict=True):
        near(after, factor * before @ R, 1000)


@given(seeds, st.floats(0, 1), st.floats(0, 1))
def test_normals_are_the_gradients_of_the_parameters(seed, s, t):
    """Out is where the parameter across a face grows at its far end and falls at its near end: the inverse Jacobian knows."""
    P = drawn("outward_normals", "any_solid", seed)["P"]
    solid = dx.BezierHyperpatch(P)
    found = reference("outward_normals")(s, t, P)
    for face in range(6):
        place = list(np.insert([s, t], face // 2, face % 2))
        J = np.stack([solid.derivative(*place, *np.eye(3, dtype=int)[way]) for way in range(3)], axis=-1)
        assert np.linalg.det(J) > 0  # right-handed, as the statement promises
        across = np.linalg.inv(J)[face // 2] * (2 * (face % 2) - 1)
        near(found[face], across / np.linalg.norm(across), 100)


@pytest.mark.parametrize("seed", range(10))
def test_the_librarys_outward_faces_have_these_normals(seed):
    """In the middle, where it does not matter that its inner faces exchange their parameters."""
    P = drawn("outward_normals", "any_solid", seed)["P"]
    near(reference("outward_normals")(0.5, 0.5, P), [face.normal(0.5, 0.5) for face in dx.BezierHyperpatch(P).faces()], 10)


@pytest.mark.parametrize("name", ["cap", "pear", "opposite_pairs"])
@pytest.mark.parametrize("seed", range(5))
def test_sphericity_by_scipys_minimiser(name, seed):
    """The same sum of squares, minimised by a search instead of a linear system; and it does not change with the place."""
    points = drawn("sphericity", name, seed)["points"]
    middle = points.mean(axis=0)

    def off(unknown):
        return ((points - middle) ** 2).sum(axis=1) - 2 * (points - middle) @ unknown[:3] - unknown[3]

    c = middle + least_squares(off, [0, 0, 0, 100], xtol=1e-15, ftol=1e-15, gtol=1e-15).x[:3]
    expected = np.ptp(np.linalg.norm(points - c, axis=1))
    R, shift = motion(seed)
    for cloud in (points, points @ R + shift):
        assert reference("sphericity")(cloud) == pytest.approx(expected, rel=1e-8)
    assert reference("sphericity")(points) == pytest.approx(dx.sphericity(points).value, rel=0.05)  # geometric: second order


@given(vectors, st.floats(1, 10), st.integers(0, 1000))
def test_points_of_a_sphere_have_no_form_error(centre, r, seed):
    directions = np.random.default_rng(seed).normal(size=(12, 3))
    points = centre + r * directions / np.linalg.norm(directions, axis=1, keepdims=True)
    assert reference("sphericity")(points) < 1e-10


# Black boxes -----------------------------------------------------------------------------------------------------------------


LABELS = {
    "quarter_turn": "relabelled", "slow_start": "same set", "other_seam": "same set", "twice_round": "different",
    "there_and_back": "different", "a_part": "different", "carried": "moved", "in_the_mirror": "different",
    "larger": "different", "same_edges": "different", "twins": "same map", "backwards": "relabelled",
}  # fmt: skip
TIERS = {
    "same map": {"identical"},
    "relabelled": {"relabelled"},
    "same set": {"same set", "other start"},
    "moved": {"moved"},
    "different": {"different", "covered", "part", "more", "moved"},  # the judge calls mirrored and enlarged ones moved, too
}


@pytest.mark.parametrize("seed", range(10))
def test_the_labels_are_those_the_data_were_made_for(seed):
    found = {data.name: reference("same_surface")(**data.arguments) for data in A9["same_surface"].draw(seed)}
    assert found == LABELS


@pytest.mark.parametrize("name", LABELS)
def test_the_judge_of_this_course_says_the_same(name):
    """Its ladder is another program: nearest points by Gauss-Newton, eight symmetries, Umeyama."""
    f, g = drawn("same_surface", name).values()

    @exercise(points=1, title="Two surfaces", kind="surface")
    def two(u, w, k):
        """Return g, in which u, w and k count."""
        return g(u, w)

    @two.data
    def one(rng):
        return {"k": 1.0}

    verdict = judge(two, lambda u, w, k: f(u, w), seed=0, figure=False)
    assert verdict.tier in TIERS[LABELS[name]], verdict.message
