"""Linear, circular and generic sweeps: the syllabus' numbers, its matrices, and what turning must leave alone."""

import math

import directrix as dx
import numpy as np
import pytest

from autograder.curvedata import as_curve

PI = math.pi
U, W = np.linspace(0, 1, 9)[:, None], np.linspace(0, 1, 11)[None, :]


def arc(t):
    return np.stack([2 * np.cos(PI * t), 1 + t**2, 3 * t * (1 - t)], -1)


def wig(t):
    return np.stack([1 + t, 2 - t**2, 0.5 + np.sin(2 * t)], -1)


def prof(t):
    return np.stack([2 + np.sin(2 * t), 3 * t - 0.5, 0 * t], -1)


def spc(t):
    return np.stack([2 + t, 3 * t - 0.5, 0.7 - t**2], -1)


@pytest.mark.parametrize(
    ("surface", "at", "point"),
    [
        (dx.LinearSweep(arc, (1, 2, 2), 6), (0.25, 0.5), (2.41421356, 3.0625, 2.5625)),
        (dx.LinearSweep.between(arc, (1, -2, 3), (2, 0, 7)), (0.25, 0.5), (1.91421356, 2.0625, 2.5625)),
        (dx.CircularSweep(prof, "y"), (0.5, 0.25), (0, 1, -2.84147098)),
        (dx.CircularSweep(prof, "y"), (1, 0.125), (2.05718394, 2.5, -2.05718394)),
        (dx.CircularSweep(spc, "x"), (0.5, 0.25), (2.5, -0.45, 1)),
        (dx.CircularSweep.in_xy_plane(spc, PI / 6), (0.5, 0.25), (2.5330127, 0.942820323, -0.383974596)),
        (dx.CircularSweep.about(spc, (1, 0, -1), (1, 2, 2)), (0.5, 0.25), (2.01111111, 1.93888889, -0.244444444)),
        (dx.GenericSweep(arc, wig), (0.25, 0.5), (1.91421356, 0.8125, 1.40397098)),
    ],
)
def test_the_numbers_of_the_syllabus(surface, at, point):
    """Printed to nine digits."""
    assert np.allclose(surface(*at), point, rtol=0, atol=5e-9)


def test_curves_as_data_sweep_like_the_functions_they_come_from():
    """The exercises hand over curves as data; any vectorised callable will do."""
    data = as_curve(spc)
    for make in (
        lambda c: dx.LinearSweep(c, (1, 2, 2), 6),
        lambda c: dx.CircularSweep(c, "y", 2),
        lambda c: dx.GenericSweep(c, data),
    ):
        assert np.allclose(make(data)(U, W), make(spc)(U, W), rtol=0, atol=1e-13)
        assert np.allclose(make(data).normal(U, W), make(spc).normal(U, W), atol=1e-9)


def test_the_direction_is_made_unit_and_the_vector_is_free():
    """l, m, n are direction cosines; of two points only the difference counts, and it is not rounded through a root."""
    assert np.array_equal(dx.LinearSweep(arc, (1, 2, 2), 6)(U, W), dx.LinearSweep(arc, (10, 20, 20), 6)(U, W))
    assert dx.LinearSweep.between(arc, (1, -2, 3), (2, 0, 7)) == dx.LinearSweep.between(
        dx.FunctionCurve(arc), (0, 0, 0), (1, 2, 4)
    )
    line = dx.Line((0, 0, 0), (1, 0, 0))
    assert dx.LinearSweep.between(line, (0, 0, 0), (0.1, 0.3, 0.7))(0.0, 1.0).tolist() == [0.1, 0.3, 0.7]
    assert dx.LinearSweep(arc, (1, 2, 2), -6).vector.tolist() == [-2, -4, -4]


def test_a_linear_sweep_starts_at_its_curve_and_moves_every_point_alike():
    """S(u, 0) = C(u); S(u, 1) - S(u, 0) is the same vector for every u."""
    sweep = dx.LinearSweep(arc, (1, 2, 2), 6)
    assert np.array_equal(sweep(U, 0.0), arc(U))
    assert np.allclose(sweep(U, 1.0) - sweep(U, 0.0), [2, 4, 4], atol=1e-14)
    squash = dx.Transform.scale((1, 2, 3))
    assert isinstance(squash @ sweep, dx.LinearSweep)
    assert np.allclose((squash @ sweep)(U, W), squash @ sweep(U, W), atol=1e-13)


def syllabus_rotation(axis, t):
    """The three matrices as printed, for column vectors."""
    c, s = math.cos(t), math.sin(t)
    return np.array(
        {
            "x": [[1, 0, 0], [0, c, -s], [0, s, c]],
            "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
            "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]],
        }[axis]
    )


@pytest.mark.parametrize("axis", ["x", "y", "z"])
@pytest.mark.parametrize("angle", [2 * PI, PI / 3, -1.0, 7.0])
def test_about_a_coordinate_axis(axis, angle):
    """Against the printed matrices, for a space curve that hides no term."""
    sweep = dx.CircularSweep(spc, axis, angle)
    for w in (0.0, 0.3, 1.0):
        assert np.allclose(sweep(U[:, 0], w), spc(U[:, 0]) @ syllabus_rotation(axis, angle * w).T, rtol=0, atol=1e-14)


@pytest.mark.parametrize("alpha", [0, PI / 6, PI / 2, 2.0, -3.0])
def test_about_an_axis_in_the_xy_plane(alpha):
    """Rz(alpha) Rx(t) Rz(-alpha), read right to left."""
    sweep = dx.CircularSweep.in_xy_plane(spc, alpha, 1.5)
    for w in (0.3, 1.0):
        matrix = syllabus_rotation("z", alpha) @ syllabus_rotation("x", 1.5 * w) @ syllabus_rotation("z", -alpha)
        assert np.allclose(sweep(U[:, 0], w), spc(U[:, 0]) @ matrix.T, rtol=0, atol=1e-14)


def test_the_xy_plane_holds_x_and_y():
    """alpha = 0 is the x axis, alpha = pi/2 the y axis, bit for bit."""
    for alpha, axis in ((0, "x"), (PI / 2, "y")):
        assert np.array_equal(dx.CircularSweep.in_xy_plane(spc, alpha)(U, W), dx.CircularSweep(spc, axis)(U, W))


def test_about_any_axis_is_rodrigues():
    """point + v cos t + (k x v) sin t + (k . v) k (1 - cos t), in plain numpy."""
    rng = np.random.default_rng(8)
    for _ in range(10):
        point, direction, angle = rng.normal(size=3), rng.normal(size=3), rng.uniform(-7, 7)
        k, v, t = direction / np.linalg.norm(direction), spc(U) - point, angle * W[..., None]
        rodrigues = point + v * np.cos(t) + np.cross(k, v) * np.sin(t) + (v @ k)[..., None] * k * (1 - np.cos(t))
        assert np.allclose(dx.CircularSweep.about(spc, point, direction, angle)(U, W), rodrigues, rtol=0, atol=1e-13)


def test_about_coordinate_axes_the_long_way():
    """transform, sweep, reverse transform gives the coordinate axes back."""
    for axis, k in (("x", (2, 0, 0)), ("y", (0, 3, 0)), ("z", (0, 0, 1))):
        assert np.allclose(
            dx.CircularSweep.about(spc, (0, 0, 0), k)(U, W), dx.CircularSweep(spc, axis)(U, W), rtol=0, atol=1e-14
        )


def test_turning_leaves_the_axis_and_the_distance_alone():
    """Another point of the axis changes nothing; the opposite direction turns the other way; a whole turn closes."""
    sweep = dx.CircularSweep.about(spc, (1, 0, -1), (1, 2, 2))
    assert np.allclose(dx.CircularSweep.about(spc, (2, 2, 1), (1, 2, 2))(U, W), sweep(U, W), atol=1e-13)
    assert np.allclose(dx.CircularSweep.about(spc, (1, 0, -1), (-1, -2, -2))(U, 1 - W), sweep(U, W), atol=1e-13)
    assert np.array_equal(sweep(U, 0.0), sweep(U, 1.0))
    k = np.array([1, 2, 2]) / 3
    v = sweep(U, W) - (1, 0, -1)
    assert np.ptp(v @ k, axis=1).max() < 1e-14
    assert np.ptp(np.linalg.norm(v, axis=-1), axis=1).max() < 1e-14
    assert np.allclose(sweep.point, (1, 0, -1))
    assert np.allclose(sweep.direction, k)


def test_the_board_form_is_the_other_sense():
    """(x cos, y, x sin) about y is a negative turn; of a whole one it is w run backwards."""
    t = 2 * PI * W
    x, y, _ = np.moveaxis(prof(U), -1, 0)
    board = np.stack(np.broadcast_arrays(x * np.cos(t), y, x * np.sin(t)), -1)
    assert np.allclose(dx.CircularSweep(prof, "y", -2 * PI)(U, W), board, atol=1e-14)
    assert np.allclose(dx.CircularSweep(prof, "y").flip_w()(U, W), board, atol=1e-14)


def test_a_point_on_the_axis_stays():
    """A degenerate edge with its limit normal."""
    sweep = dx.CircularSweep(dx.Line((0, 0, 1), (2, 0, 0)), "z")
    assert (sweep(0.0, W) == [0, 0, 1]).all()
    assert np.allclose(np.linalg.norm(sweep.normal(0.0, W), axis=-1), 1)


def test_a_translational_sweep_is_a_sum():
    """G(u) + D(w) - D(0): the same carried section everywhere, S_uw = 0, exactly G at w = 0; with a circle no torus."""
    sweep = dx.GenericSweep(arc, wig)
    assert np.array_equal(sweep(U, 0.0), arc(U))
    assert np.allclose(sweep(U, W), arc(U) + wig(W) - wig(np.array(0.0)), rtol=0, atol=1e-15)
    assert not sweep.derivative(U, W, 1, 1).any()
    tube = dx.Circle((3, 0, 0), 1, (0, -1, 0)), dx.Circle((0, 0, 0), 3)
    assert np.abs(dx.GenericSweep(*tube)(U, W) - dx.Torus(3, 1)(U, W)).max() > 1


@pytest.mark.parametrize("frame", ["frenet", "minimal"])
def test_a_turning_section_makes_the_torus(frame):
    """Circle along circle with either moving frame, with first and second derivatives."""
    sweep = dx.GenericSweep(dx.Circle((3, 0, 0), 1, (0, -1, 0)), dx.Circle((0, 0, 0), 3), frame)
    torus = dx.Torus(3, 1)
    assert np.allclose(sweep(U, W), torus(U, W), atol=1e-12)
    for orders in ((1, 0), (0, 1), (1, 1), (0, 2)):
        exact = torus.derivative(U, W, *orders)
        assert np.allclose(sweep.derivative(U, W, *orders), exact, atol=1e-12 * np.abs(exact).max())


@pytest.mark.parametrize("frame", ["fixed", "frenet", "minimal"])
def test_every_frame_starts_in_place_and_keeps_the_section(frame):
    """S(u, 0) = G(u); the section is carried rigidly, or scaled by the taper."""
    path = dx.BezierCurve([(0, 0, 0), (1, 3, 1), (4, 3, -2), (5, 0, 3)])
    for taper in (1.0, 0.5):
        sweep = dx.GenericSweep(arc, path, frame, taper=taper)
        assert np.allclose(sweep(U, 0.0), arc(U), rtol=0, atol=1e-14)
        apart = np.linalg.norm(sweep(0.0, W) - sweep(0.7, W), axis=-1)
        start = np.linalg.norm(arc(np.array(0.0)) - arc(np.array(0.7)))
        assert np.allclose(apart, (1 + (taper - 1) * W) * start, rtol=1e-12)


def test_the_minimal_frame_closes_on_a_closed_directrix():
    """A closed space curve, a section that shows every turn: w = 0 and w = 1 meet in position and in slope."""
    ring = lambda t: np.stack([3 * np.cos(2 * PI * t), 3 * np.sin(2 * PI * t), np.sin(4 * PI * t + 1) + np.cos(6 * PI * t)], -1)  # noqa: E731
    sweep = dx.GenericSweep(lambda u: ring(0 * u) + np.stack([u, u**2, 0.5 - u], -1), ring, "minimal")
    assert sweep._turning.closing != 0
    assert np.allclose(sweep(U, 0.0), sweep(U, 1.0), atol=1e-7)
    assert np.allclose(sweep.derivative(U, 0.0, 0, 1), sweep.derivative(U, 1.0, 0, 1), atol=1e-5)


def test_a_bezier_profile_turned_is_the_mixed_form():
    """The syllabus' vase: S(.5, .25) = (0, 1.625, 1.625)."""
    vase = dx.CircularSweep(dx.BezierCurve([(1, 0, 0), (3, 0, 1), (0.5, 0, 2), (1.5, 0, 4)]))
    assert vase(0.5, 0.25).tolist() == [0, 1.625, 1.625]


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: dx.LinearSweep(arc, (0, 0, 0), 1), dx.DegenerateError, "direction must not be the zero vector"),
        (lambda: dx.LinearSweep(arc, (0, 0, 1), np.inf), dx.NumberError, "distance must be finite"),
        (lambda: dx.LinearSweep(3, (0, 0, 1), 1), dx.CurveError, "curve: a curve must be a callable"),
        (
            lambda: dx.LinearSweep(lambda t: t, (0, 0, 1), 1),
            dx.CurveError,
            r"curve: a curve must return points of shape u.shape",
        ),
        (lambda: dx.LinearSweep.between(arc, (1, 1, 1), (1, 1, 1)), dx.DegenerateError, "a and b must be different points"),
        (
            lambda: dx.CircularSweep(arc, "w"),
            dx.NumberError,
            "one of 'x', 'y', 'z'; got 'w'. For another axis use CircularSweep.about",
        ),
        (lambda: dx.CircularSweep(arc, (0, 0, 1)), dx.NumberError, r"got \(0, 0, 1\). For another axis use"),
        (lambda: dx.CircularSweep(arc, "z", np.nan), dx.NumberError, "angle must be finite"),
        (
            lambda: dx.CircularSweep.about(arc, (0, 0, 0), (0, 0, 0)),
            dx.DegenerateError,
            "direction must not be the zero vector",
        ),
        (lambda: dx.CircularSweep.about(arc, (0, 0), (0, 0, 1)), dx.ShapeError, r"point must have shape \(3,\)"),
        (lambda: dx.CircularSweep.in_xy_plane(arc, "x"), dx.ShapeError, "alpha must be real numbers"),
        (lambda: dx.GenericSweep(3, arc), dx.CurveError, "generatrix: a curve must be a callable"),
        (lambda: dx.GenericSweep(arc, 3), dx.CurveError, "directrix: a curve must be a callable"),
        (lambda: dx.GenericSweep(arc, wig, "twisted"), dx.NumberError, "frame must be one of 'fixed', 'frenet', 'minimal'"),
        (lambda: dx.GenericSweep(arc, wig, taper=np.nan), dx.NumberError, "taper must be finite"),
        (
            lambda: dx.GenericSweep(arc, dx.Line((0, 0, 0), (1, 0, 0)), "frenet"),
            dx.DegenerateError,
            "the directrix is not curved",
        ),
        (
            lambda: dx.GenericSweep(arc, wig, "minimal").derivative(0.5, 0.5, 0, 3),
            dx.OrderError,
            "nw must be at most 2 here; got 3. The turning",
        ),
    ],
)
def test_refused(call, error, message):
    """The tests above hold the neighbours."""
    with pytest.raises(error, match=message):
        call()
