"""Transforms: exact quarter turns, the three matrices of the course, and an independent oracle for any axis."""

import directrix as dx
import numpy as np
import pytest
from directrix.transform import turn
from scipy.spatial.transform import Rotation

c, s = np.cos(0.7), np.sin(0.7)
COURSE = {
    "x": [[1, 0, 0], [0, c, -s], [0, s, c]],
    "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
    "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]],
}


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_the_three_matrices_of_the_course(axis):
    """Column vectors, right-hand sense; the y matrix has its signs the other way round."""
    assert np.allclose(dx.Transform.rotate(axis, 0.7).linear, COURSE[axis], atol=1e-16, rtol=1e-15)


@pytest.mark.parametrize(
    ("axis", "start", "end"), [("x", (0, 1, 0), (0, 0, 1)), ("y", (0, 0, 1), (1, 0, 0)), ("z", (1, 0, 0), (0, 1, 0))]
)
def test_a_quarter_turn_is_exact(axis, start, end):
    """y goes to z, z to x, x to y, to the last bit."""
    assert (dx.Transform.rotate(axis, np.pi / 2) @ start).tolist() == list(end)


def test_rotation_about_any_line_agrees_with_scipy():
    """Rotation vectors of scipy are an independent route; the fixed point stays."""
    rng = np.random.default_rng(1)
    for _ in range(20):
        k, point, q, angle = rng.normal(size=3), rng.normal(size=3), rng.normal(size=(5, 3)), rng.uniform(-9, 9)
        mine = dx.Transform.rotate(k, angle, point) @ q
        oracle = Rotation.from_rotvec(angle * k / np.linalg.norm(k)).apply(q - point) + point
        assert np.allclose(mine, oracle, atol=1e-14)  # a dozen roundings of numbers of size 5
        assert np.allclose(dx.Transform.rotate(k, angle, point) @ point, point, atol=1e-14)


def test_products_do_the_right_hand_one_first():
    """Shift then turn is not turn then shift."""
    shift, quarter = dx.Transform.translate((1, 0, 0)), dx.Transform.rotate("z", np.pi / 2)
    assert (quarter @ shift @ (0, 0, 0)).tolist() == [0, 1, 0]
    assert (shift @ quarter @ (0, 0, 0)).tolist() == [1, 0, 0]


def test_reflection_twice_is_the_identity_and_reverses_handedness():
    """A mirror has determinant -1."""
    mirror = dx.Transform.reflect((1, 2, 2), point=(1, 0, 0))
    assert np.allclose((mirror @ mirror).matrix, np.eye(4), atol=1e-15)
    assert np.linalg.det(mirror.linear) == pytest.approx(-1, abs=1e-15)
    assert dx.Transform.reflect("z") == dx.Transform.reflect((0, 0, 3))


def test_scaling_about_a_point_leaves_it():
    """One factor or three."""
    assert (dx.Transform.scale(3, point=(1, 1, 1)) @ [(1, 1, 1), (2, 1, 1)]).tolist() == [[1, 1, 1], [4, 1, 1]]
    assert (dx.Transform.scale((1, 2, 4)) @ (1, 1, 1)).tolist() == [1, 2, 4]


def test_the_inverse_leads_back():
    """Also for a scale that makes the determinant tiny."""
    there = dx.Transform.rotate((1, 2, 3), 0.4) @ dx.Transform.scale(1e-6) @ dx.Transform.translate((1, 2, 3))
    assert np.allclose((there.inverse() @ there).matrix, np.eye(4), atol=1e-12)  # the offsets are divided by 1e-6


def test_vectors_are_not_shifted():
    """Tangents turn with a form and do not move with it."""
    assert dx.Transform.translate((5, 5, 5)).vectors((1, 2, 3)).tolist() == [1, 2, 3]
    assert dx.Transform.translate((5, 5, 5)).points((1, 2, 3)).tolist() == [6, 7, 8]


def test_any_form_moves():
    """Curves, surfaces and arrays alike; a moved form moved again keeps one matrix."""
    move = dx.Transform.rotate("z", np.pi / 2) @ dx.Transform.translate((1, 0, 0))
    assert (move @ dx.Line((0, 0, 0), (1, 0, 0))) == dx.Line((0, 1, 0), (0, 2, 0))
    torus = dx.Torus(3, 1)
    u, w = np.random.default_rng(0).random((2, 7))
    assert np.allclose((move @ torus)(u, w), move @ torus(u, w), atol=1e-15)
    assert np.allclose((move @ (move @ torus))(u, w), move @ (move @ torus(u, w)), atol=1e-14)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: dx.Transform(np.eye(3)), r"matrix must have shape \(4, 4\); got \(3, 3\)"),
        (lambda: dx.Transform(np.eye(4) + np.eye(4, k=-3)), "the last row of matrix must be"),
        (lambda: dx.Transform.of(np.eye(2)), r"linear must have shape \(3, 3\)"),
        (lambda: dx.Transform.rotate((0, 0, 0), 1), "direction must not be the zero vector"),
        (lambda: dx.Transform.rotate("q", 1), "direction must be one of 'x', 'y', 'z'; got 'q'"),
        (lambda: dx.Transform.scale(0), "factor must not be 0"),
        (lambda: dx.Transform.scale((1, 2)), "factor must be one number or three"),
        (lambda: dx.Transform.of(np.diag([1, 1, 0])).inverse(), "this transform flattens space"),
        (lambda: dx.Transform.identity() @ (1, 2), r"points must have shape \(\.\.\., 3\)"),
        (lambda: dx.Transform.identity() @ (lambda u: u), "needs a form of the library; wrap a plain function first"),
    ],
)
def test_refused(call, message):
    """Each message has what provokes it; the tests above are the neighbours that pass."""
    with pytest.raises(dx.GeometryError, match=message):
        call()


def test_turns_are_exact_at_quarters_and_periodic_to_the_last_bit():
    """Closed circles close exactly; numpy's own cos(2 pi t) is the oracle elsewhere."""
    t = np.arange(-8, 9) / 4
    cos, sin = turn(t)
    assert set(np.concatenate([cos, sin])) == {-1.0, 0.0, 1.0}
    u = np.random.default_rng(2).random(100) / 1024 // 2**-40 * 2**-40  # so that u + 3 is exact
    assert np.array_equal(turn(u)[0], turn(u + 3)[0])
    assert np.allclose(turn(u), [np.cos(2 * np.pi * u), np.sin(2 * np.pi * u)], atol=1e-15)


@pytest.mark.parametrize("n", range(6))
def test_derivatives_of_turns(n):
    """(2 pi)^n times the pair a quarter of n turns further on."""
    t = np.linspace(0, 1, 7)
    cos, sin = turn(t, n)
    assert np.allclose(cos, (2 * np.pi) ** n * np.cos(2 * np.pi * t + n * np.pi / 2), atol=1e-14 * (2 * np.pi) ** n)
    assert np.allclose(sin, (2 * np.pi) ** n * np.sin(2 * np.pi * t + n * np.pi / 2), atol=1e-14 * (2 * np.pi) ** n)
