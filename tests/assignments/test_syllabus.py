"""The mistakes and numbers of the syllabus: every listed id is there, every reference gives the printed values."""

import numpy as np
import pytest

from autograder.catalogue import shipped

LISTED = {
    "cylinder": "no_2pi diameter minus_h clockwise swap_uw centred",
    "frustum": "radii_swapped sum_not_diff mean_radius slant_as_height degrees",
    "sphere": "full_circle lat_0_to_pi north_first swap_uw no_cos_on_xy sin_cos_mixed",
    "torus": "R_is_outer translated_not_turned z_uses_R no_r swap_uw half_tube",
    "torus_class": "equal_radii_sphere sphere_never reversed",
    "direction_cosines": "not_normalised reversed angles taxicab squared",
    "linear_sweep": "not_normalised no_distance backwards swap_uw multiplied",
    "linear_sweep_points": "starts_at_a end_point_only reversed unit_length swap_uw",
    "plane3": "p3_opposite swap_uw unit_directions lerp_each bilinear_to_p3",
    "triangle_mask": "other_half open product half_each",
    "triangle_patch": "parallelogram normalised clamped",
    "cone_from_line": "negative_sense about_x about_z swap_uw reversed degrees",
    "revolve_y": "negative_sense about_x about_z degrees angle_is_w swap_uw starts_in_yz flat_profile_only always_full_turn",
    "revolve_coord": "y_sign_like_x_z all_negative flat_profile degrees",
    "revolve_xy_axis": "inverse_first no_inverse no_transform axis_ignored wrong_sense from_y",
    "revolve_axis": "through_origin no_translate_back translate_wrong_way axis_not_unit no_third_term axis_is_a_point",
    "translational_sweep": "not_anchored gen_anchored average swap_uw ruled_by_mistake",
    "vase": "no_binomials reversed rho_z_exchanged swap_uw degrees",
    "bilinear": "p01_p10 around_the_loop no_uw_term lofts_added two_edges_averaged",
    "bilinear_is_planar": "parallelogram absolute_tol always_planar",
    "ruled": "ends_exchanged no_one_minus one_reversed average different_points",
    "ruled_circles": "phase_degrees phase_ignored phase_negative phase_on_both swap_uw",
    "count_coefficients": "scalar_only curves_added total_degree",
    "algebraic_eval": "descending transposed total_degree diagonal",
    "hermite_basis": "other_order f4_sign matrix_transposed powers_ascending bezier",
    "hermite_patch": "twist_sign no_twist tangents_over_3 pu_pw_exchanged transposed matrix_transposed",
    "hermite_to_algebraic": "right_not_transposed inverse one_side transposed",
    "patch_normal": "reversed not_unit unit_then_cross twist corner_plane",
    "npoint_patch": "parameters_ignored piecewise_bilinear tu_tw_exchanged denominator_sign transposed",
    "bernstein": "no_binomials order_for_degree power_typo nan_at_ends",
    "bezier_patch": "transposed no_binomials reversed_u net_piecewise elementwise",
    "iso_curve_net": "nearest_row points_not_controls other_direction rows_interpolated",
    "bezier_to_hermite": "no_3 twist_3 twist_zero twist_all_plus transposed",
    "hermite_to_bezier": "no_third twist_third twist_forgotten far_end_plus twist_sign_mixed",
    "open_knots": "order_minus_one length_m uniform normalised repeated_inner",
    "bspline_basis": "zero_at_end order_is_degree order_short double_closed denominator_shift",
    "bspline_patch": "not_scaled orders_exchanged order_is_degree unclamped bezier transposed",
    "nurbs_patch": "not_divided weights_ignored already_weighted weighted_twice weights_transposed",
    "nurbs_quarter_cylinder": "weight_1 weight_half weight_root2 middle_on_arc",
    "coons": "no_correction averaged correction_added corners_exchanged blends_exchanged loop_orientation",
    "ferguson": "coons_instead tangents_exchanged unit_tangents inward_at_far_end bilinear_only",
    "coons_twists": "no_correction bilinear_only halved correction_added transposed",
    "hyperpatch": "uw_exchanged trilinear no_binomials vw_exchanged",
    "hyperpatch_faces": "mid_slices all_slices_u transposed near_far",
    "flatness": "z_range vertical rms three_points not_centred",
    "cylindricity": "axis_not_unit distance_to_point diameter half_zone squared",
    # The stretch tasks: the syllabus describes their mistakes in words, the names are the course's own.
    "quadric_value": "mixed_halves_forgotten factor_2 E_F_exchanged K_forgotten",
    "quadric_class": "signs_of_ABC determinant_only no_tolerance",
    "screw_sweep": "negative_sense pitch_per_radian no_advance",
    "corners_agree": "head_to_tail absolute_tolerance two_corners",
    "bezier_split": "second_reversed always_in_the_middle points_not_controls",
    "elevate_u": "degree_for_points midpoints elevated_in_w",
    "uniform_bicubic": "sixths_forgotten one_sixth_forgotten bezier through_inner_points",
    "points16_to_bezier": "points_as_controls along_u_only along_w_only matrix_transposed right_not_transposed",
    "cubic_coons": "bilinear_correction",
    "coons_bezier_net": "zero_twist one_too_many",
    "nurbs_revolve": "weights_added weights_replaced plain_knots",
    "outward_normals": "as_they_come all_inward near_faces_turned",
    "revolved_line_kind": "skew_is_cone",
    "sphericity": "centroid_as_centre half_zone rms",
    "fmill_tangents": "mean_length central_difference",
    "same_surface": "area_not_compared one_sided",
}
ASSIGNMENTS = {
    "A1": ["cylinder", "frustum", "sphere", "torus", "torus_class"],
    "A2": ["direction_cosines", "linear_sweep", "linear_sweep_points", "plane3", "triangle_mask", "triangle_patch"],
    "A3": ["revolve_y", "revolve_coord", "cone_from_line", "revolve_xy_axis", "revolve_axis"],
    "A4": ["translational_sweep", "vase", "bilinear", "bilinear_is_planar", "ruled", "ruled_circles"],
    "A5": [
        "count_coefficients",
        "algebraic_eval",
        "hermite_basis",
        "hermite_patch",
        "hermite_to_algebraic",
        "patch_normal",
        "npoint_patch",
    ],
    "A6": ["bernstein", "bezier_patch", "iso_curve_net", "bezier_to_hermite", "hermite_to_bezier"],
    "A7": ["open_knots", "bspline_basis", "bspline_patch", "nurbs_patch", "nurbs_quarter_cylinder"],
    "A8": ["coons", "ferguson", "coons_twists", "hyperpatch", "hyperpatch_faces", "flatness", "cylindricity"],
    "A9": [
        "quadric_value",
        "quadric_class",
        "revolved_line_kind",
        "screw_sweep",
        "nurbs_revolve",
        "bezier_split",
        "elevate_u",
        "uniform_bicubic",
        "points16_to_bezier",
        "corners_agree",
        "cubic_coons",
        "coons_bezier_net",
        "fmill_tangents",
        "outward_normals",
        "sphericity",
        "same_surface",
    ],
}


def arc(t):
    return np.stack([2 * np.cos(np.pi * t), 1 + t**2, 3 * t * (1 - t)], axis=-1)


def prof(t):
    return np.stack([2 + np.sin(2 * t), 3 * t - 0.5, 0 * t], axis=-1)


def spc(t):
    return np.stack([2 + t, 3 * t - 0.5, 0.7 - t**2], axis=-1)


def wig(t):
    return np.stack([1 + t, 2 - t**2, 0.5 + np.sin(2 * t)], axis=-1)


def top(t):
    return np.stack([3 * t - 1, np.cos(3 * t), 2 + t], axis=-1)


A44 = [
    [[0, -2, 0], [0, 3, 2], [-1, 7, -2], [1, 13, 0]],
    [[2, 2, 2], [3, 5, 2], [1, 7, -2], [1, 12, -1]],
    [[8, 1, 2], [6, 4, 2], [7, 10, 0], [8, 10, -2]],
    [[9, 0, 2], [10, 3, 2], [10, 6, -1], [10, 14, -2]],
]
G44 = [
    [[0, 0, 0], [1, 4, 1], [1, 5, 2], [-1, 3, 4]],
    [[5, -1, 2], [6, 3, -1], [0, 6, -3], [2, 3, -2]],
    [[6, 1, 3], [3, -2, 5], [2, 1, 6], [-3, 4, 2]],
    [[4, 0, -4], [7, 2, 1], [5, -2, 3], [1, 3, -7]],
]
P54 = [
    [[-1, 1, 2], [2, 5, -2], [1, 8, 0], [-1, 11, -1]],
    [[4, 2, -2], [3, 4, 1], [2, 7, -1], [3, 14, 1]],
    [[5, -2, -1], [5, 5, -1], [5, 8, 1], [6, 10, 0]],
    [[8, 1, 2], [10, 5, 1], [8, 9, -2], [11, 14, -1]],
    [[12, -1, 0], [11, 6, 1], [10, 7, 1], [11, 12, 1]],
]
NODES = (0, 0.2, 0.45, 0.7, 1), (0, 0.3, 0.75, 1)
QUAD = ((0, 0, 0), (0, 3, 1), (4, 0, 0), (5, 4, 2))
TRIANGLE = ((1, 2, 0), (4, 1, 2), (0, 5, 3))
ORACLES = [
    ("cylinder", (0.25, 0.4), (2, 5), (0, 2, 2)),
    ("cylinder", (0.1, 0.5), (2, 5), (1.61803399, 1.1755705, 2.5)),
    ("frustum", (0.25, 0.5), (3, 1, 4), (0, 2, 2)),
    ("frustum", (0.125, 0.25), (3, 1, 4), (1.76776695, 1.76776695, 1)),
    ("sphere", (0.75, 0.125), (2,), (1, 1, 1.41421356)),
    ("sphere", (0.5, 0.25), (2,), (0, 2, 0)),
    ("torus", (0, 0.25), (3, 1), (0, 4, 0)),
    ("torus", (0.125, 0.5), (3, 1), (-3.70710678, 0, 0.707106781)),
    ("direction_cosines", (), ((1, -2, 3), (4, 2, 15)), (0.230769231, 0.307692308, 0.923076923, 13)),
    ("linear_sweep", (0.25, 0.5), (arc, (1, 2, 2), 6), (2.41421356, 3.0625, 2.5625)),
    ("linear_sweep_points", (0.25, 0.5), (arc, (1, -2, 3), (2, 0, 7)), (1.91421356, 2.0625, 2.5625)),
    ("plane3", (0.5, 0.25), TRIANGLE, (2.25, 2.25, 1.75)),
    ("triangle_patch", (0.5, 0.5), TRIANGLE, (1.25, 3.25, 2)),
    ("triangle_patch", (0.25, 1), TRIANGLE, (0, 5, 3)),
    ("cone_from_line", (0.5, 0.25), ((3, 0, 0), (1, 4, 0)), (0, 2, -2)),
    ("cone_from_line", (1, 0.5), ((3, 0, 0), (1, 4, 0)), (-1, 4, 0)),
    ("revolve_y", (0.5, 0.25), (prof,), (0, 1, -2.84147098)),
    ("revolve_y", (1, 0.125), (prof,), (2.05718394, 2.5, -2.05718394)),
    ("revolve_coord", (0.5, 0.25), (spc, "x"), (2.5, -0.45, 1)),
    ("revolve_xy_axis", (0.5, 0.25), (spc, 0.523598776), (2.5330127, 0.942820323, -0.383974596)),
    ("revolve_axis", (0.5, 0.25), (spc, (1, 0, -1), (1, 2, 2)), (2.01111111, 1.93888889, -0.244444444)),
    ("translational_sweep", (0.25, 0.5), (arc, wig), (1.91421356, 0.8125, 1.40397098)),
    ("vase", (0.5, 0.25), (((1, 0), (3, 1), (0.5, 2), (1.5, 4)),), (0, 1.625, 1.625)),
    ("bilinear", (0.5, 0.5), QUAD, (2.25, 1.75, 0.75)),
    ("bilinear", (0.25, 0.75), QUAD, (1.1875, 2.4375, 0.9375)),
    ("ruled", (0.25, 0.5), (arc, top), (0.582106781, 0.897094434, 1.40625)),
    ("ruled_circles", (0.25, 0.5), (2, 1.5, 3, 1.30899694), (-0.72444437, 1.19411428, 1.5)),
    ("ruled_circles", (0, 0.5), (2, 1.5, 3, 1.30899694), (1.19411428, 0.72444437, 1.5)),
    ("count_coefficients", (), (3, 3), 48),
    ("count_coefficients", (), (3, 2), 36),
    ("count_coefficients", (), (1, 1), 12),
    ("count_coefficients", (), (4, 3), 60),
    ("algebraic_eval", (0.5, 0.25), (A44,), (5.41796875, 2.19140625, 2.47265625)),
    ("hermite_basis", (), ((0, 0.1, 0.2),), ((1, 0, 0, 0), (0.972, 0.028, 0.081, -0.009), (0.896, 0.104, 0.128, -0.032))),
    ("hermite_patch", (0.5, 0.5), (G44,), (2.890625, 1.65625, 0.90625)),
    ("hermite_patch", (0.25, 0.75), (G44,), (1.98901367, 2.69580078, 0.8515625)),
    ("patch_normal", (0.5, 0.5), (np.array(G44, dtype=float),), (0.340315061, 0.610224273, 0.715410369)),
    ("npoint_patch", (0.5, 0.5), (P54, *NODES), (5.62816372, 7.07279427, -0.109650931)),
    ("npoint_patch", (0.45, 0.75), (P54, *NODES), (5, 8, 1)),
]


@pytest.mark.parametrize(("name", "exercises"), ASSIGNMENTS.items())
def test_each_assignment_poses_its_exercises(name, exercises):
    assert list(shipped().assignment(name).exercises) == exercises


@pytest.mark.parametrize(("name", "ids"), LISTED.items())
def test_every_listed_mistake_is_there(name, ids):
    assert set(ids.split()) <= {mistake.id for mistake in shipped().find(name).mistakes}


@pytest.mark.parametrize(
    ("name", "place", "arguments", "expected"), ORACLES, ids=[f"{name}-{place}" for name, place, *_ in ORACLES]
)
def test_the_printed_numbers(name, place, arguments, expected):
    """Nine digits were printed, so half a unit of the ninth is allowed."""
    np.testing.assert_allclose(shipped().find(name).reference(*place, *arguments), expected, rtol=1e-8, atol=1e-8)


def test_the_first_coefficients_of_the_hermite_patch():
    """The first row of the table: a_00, a_01, a_02."""
    first = shipped().find("hermite_to_algebraic").reference(G44)[0, :3]
    np.testing.assert_allclose(first, [(0, 0, 0), (1, 5, 2), (2, -1, -5)], atol=1e-12)


@pytest.mark.parametrize(("R", "r", "kind"), [(3, 1, "ring"), (1, 1, "horn"), (0.5, 1, "spindle"), (0, 1, "sphere")])
def test_the_four_kinds_of_torus(R, r, kind):
    assert shipped().find("torus_class").reference(R, r) == kind


@pytest.mark.parametrize(
    ("corners", "planar"),
    [
        (QUAD, False),
        (((0, 0, 1), (1, 2, 2), (3, 0, 1), (5, 4, 3)), True),
        (((0, 0, 0), (0, 2, 0), (3, 0, 0), (5, 4, 0)), True),
        (((0, 0, 0), (0, 2, 1), (3, 0, 2), (3, 2, 3)), True),
        (((0, 0, 0), (0, 3e-05, 1e-05), (4e-05, 0, 0), (5e-05, 4e-05, 2e-05)), False),
        (((1, 1, 1000001), (1000001, 2000001, 2000001), (3000001, 1, 1000001), (5000001, 4000001, 3000001)), True),
        (((2, 3, 4),) * 4, True),
    ],
)
def test_planar_or_not(corners, planar):
    assert shipped().find("bilinear_is_planar").reference(*corners) is planar


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("torus_class", (-1.0, 1.0)),
        ("torus_class", (1.0, 0.0)),
        ("torus_class", (1.0, -1.0)),
        ("direction_cosines", ((1, 2, 3), (1, 2, 3))),
        ("linear_sweep", (0.5, 0.5, arc, (0, 0, 0), 1.0)),
        ("revolve_axis", (0.5, 0.5, spc, (1, 0, -1), (0, 0, 0))),
    ],
)
def test_refusals(name, arguments):
    with pytest.raises(ValueError, match=r"."):
        shipped().find(name).reference(*arguments)
