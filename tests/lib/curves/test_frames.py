"""Moving frames against the helix, whose frames are known in closed form, and against their own definitions."""

import directrix as dx
import numpy as np
import pytest
from directrix.curves.frames import FRAMES, unit_tangent
from directrix.curves.function import as_curve
from directrix.differential import numeric_derivative
from scipy.integrate import solve_ivp

W = np.linspace(0, 1, 33)
PITCH = 2.0  # along z in one turn, radius 1


def helix(t):
    return np.stack([np.cos(2 * np.pi * t), np.sin(2 * np.pi * t), PITCH * t], -1)


def helix_frame(w):
    """Columns t, n, b of the helix, from its formula."""
    c, s, speed = np.cos(2 * np.pi * w), np.sin(2 * np.pi * w), np.hypot(2 * np.pi, PITCH)
    t = np.stack([-2 * np.pi * s, 2 * np.pi * c, PITCH + 0 * w], -1) / speed
    n = np.stack([-c, -s, 0 * w], -1)
    return np.stack([t, n, np.cross(t, n)], -1)


def test_frenet_of_the_helix():
    """R(w) = F(w) F(0)^T."""
    frame = FRAMES["frenet"](as_curve("directrix", helix))
    assert np.allclose(frame.rotation(W), helix_frame(W) @ helix_frame(np.array(0.0)).T, atol=1e-8)


def test_minimal_frame_of_the_helix():
    """It lags behind the Frenet frame by the torsion: -2 pi pitch / speed per turn, about the tangent."""
    frame = FRAMES["minimal"](as_curve("directrix", helix))
    angle = -2 * np.pi * PITCH / np.hypot(2 * np.pi, PITCH) * W
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    t, n, b = np.moveaxis(helix_frame(W), -1, 0)
    exact = np.stack([t, c * n + s * b, c * b - s * n], -1) @ helix_frame(np.array(0.0)).T
    assert np.allclose(frame.rotation(W), exact, atol=2e-9)  # double reflection over 1024 steps, fourth order


@pytest.mark.parametrize("kind", ["frenet", "minimal"])
@pytest.mark.parametrize("directrix", [helix, dx.BezierCurve([(0, 0, 0), (1, 3, 1), (4, 3, -2), (5, 0, 3)])])
def test_frames_are_rotations_that_follow_the_tangent(kind, directrix):
    """R^T R = I, det R = 1, R(0) = I, and the start's tangent goes to the tangent."""
    curve = as_curve("directrix", directrix)
    rotation = FRAMES[kind](curve).rotation(W)
    assert np.allclose(np.swapaxes(rotation, -1, -2) @ rotation, np.eye(3), atol=1e-12)
    assert np.allclose(np.linalg.det(rotation), 1, atol=1e-12)
    assert np.allclose(rotation[0], np.eye(3), atol=1e-12)
    assert np.allclose(rotation @ unit_tangent(curve, np.array(0.0)), unit_tangent(curve, W), atol=1e-12)


@pytest.mark.parametrize("kind", ["frenet", "minimal"])
def test_spin_and_its_rate_are_derivatives(kind):
    """R' = [omega] R and omega' as given, against numeric differentiation of what they are derivatives of."""
    frame = FRAMES[kind](dx.BezierCurve([(0, 0, 0), (1, 3, 1), (4, 3, -2), (5, 0, 3)]))
    w = np.linspace(0.05, 0.95, 7)
    rate = numeric_derivative(frame.rotation, w, 1)
    assert np.allclose(
        np.cross(frame.spin(w)[:, None], np.swapaxes(frame.rotation(w), 1, 2)), np.swapaxes(rate, 1, 2), atol=1e-5
    )
    assert np.allclose(frame.spin_rate(w), numeric_derivative(frame.spin, w, 1), atol=1e-7)


def test_minimal_never_turns_about_the_tangent():
    """omega . t = 0, which is what rotation-minimising means."""
    curve = dx.BezierCurve([(0, 0, 0), (1, 3, 1), (4, 3, -2), (5, 0, 3)])
    frame = FRAMES["minimal"](curve)
    assert np.allclose((frame.spin(W) * unit_tangent(curve, W)).sum(-1), 0, atol=1e-13)


def test_a_closed_directrix_closes_the_minimal_frame():
    """A closed space curve brings the frame home turned; the turn is given back evenly."""
    knot = as_curve(
        "directrix",
        lambda t: np.stack(
            [np.cos(2 * np.pi * t), np.sin(2 * np.pi * t), np.sin(4 * np.pi * t + 1) + np.cos(6 * np.pi * t)], -1
        ),
    )
    frame = FRAMES["minimal"](knot)
    assert abs(frame.closing) > 0.01
    assert np.allclose(frame.rotation(np.array([0.0, 1.0])), np.eye(3), atol=1e-8)
    spin = frame.spin(W)
    assert np.allclose((spin * unit_tangent(knot, W)).sum(-1), -frame.closing, atol=1e-6)


def test_a_plane_closed_directrix_needs_no_correction():
    """All turning is about the normal of its plane."""
    assert FRAMES["minimal"](dx.Circle((0, 0, 0), 3)).closing == pytest.approx(0, abs=1e-9)
    assert FRAMES["minimal"](dx.Arc((0, 0, 0), 3, 0, 1)).closing == 0


STRAIGHT = dx.Line((0, 0, 0), (1, 1, 1))
WAVE = dx.BezierCurve([(0, 0, 0), (1, 2, 0), (2, -2, 0), (3, 0.1, 0)])
CUSP = dx.BezierCurve([(0, 0, 0), (0, 0, 0), (1, 1, 0), (2, 0, 1)])


@pytest.mark.parametrize(
    ("kind", "directrix", "message"),
    [
        ("frenet", STRAIGHT, "the directrix is not curved at w = 0: there is no Frenet frame there. Use frame='minimal'"),
        ("frenet", WAVE, "the directrix has an inflection near w = 0.4|not curved"),
        ("minimal", CUSP, "the directrix stands still at w = 0: it has no tangent"),
        ("frenet", CUSP, "not curved at w = 0"),
    ],
)
def test_frames_that_do_not_exist(kind, directrix, message):
    """Each says where, and which frame to take instead."""
    with pytest.raises(dx.DegenerateError, match=message):
        FRAMES[kind](directrix)


@pytest.mark.parametrize(("kind", "directrix"), [("minimal", STRAIGHT), ("minimal", WAVE), ("fixed", CUSP)])
def test_the_neighbours_exist(kind, directrix):
    """The minimal frame needs no curvature, the fixed one nothing."""
    assert np.allclose(np.linalg.det(FRAMES[kind](directrix).rotation(W)), 1)


def test_minimal_frame_solves_its_differential_equation():
    """r' = -(t' . r) t (Wang et al. 2008), integrated by scipy from the axes at w = 0."""
    curve = dx.BezierCurve([(0, 0, 0), (1, 3, 1), (4, 3, -2), (5, 0, 3)])

    def rate(w, r):
        d1, d2 = curve.derivative(w, 1), curve.derivative(w, 2)
        speed = np.linalg.norm(d1)
        t = d1 / speed
        bend = (d2 - (d2 @ t) * t) / speed
        return -(bend @ r) * t

    start = np.cross(curve.derivative(0.0, 1), (0.0, 0.0, 1.0))
    start = start / np.linalg.norm(start)
    solved = solve_ivp(rate, (0, 1), start, method="DOP853", rtol=1e-12, atol=1e-13, dense_output=True)
    rotation = FRAMES["minimal"](curve).rotation(np.linspace(0, 1, 9))
    assert np.allclose(rotation @ start, solved.sol(np.linspace(0, 1, 9)).T, atol=1e-6)
