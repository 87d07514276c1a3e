import numpy as np
import pytest

from autograder.comparison.motion import Motion, fit

CLOUD = np.random.default_rng(8).normal(size=(30, 3))
QUARTER_Z = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])


def test_a_motion_is_found_as_it_was():
    motion = Motion(0.5, QUARTER_Z, np.array([1.0, 2, 3]))
    found, residual = fit(CLOUD, motion(CLOUD), mirrored=False)
    assert residual < 1e-12
    assert found.scale == pytest.approx(0.5)
    np.testing.assert_allclose(found.turn, QUARTER_Z, atol=1e-12)
    np.testing.assert_allclose(found.shift, [1, 2, 3], atol=1e-12)


def test_a_mirror_is_found_only_as_a_mirror():
    goal = CLOUD * [1, 1, -1]
    assert fit(CLOUD, goal, mirrored=True)[1] < 1e-12
    assert fit(CLOUD, goal, mirrored=False)[1] > 0.1


def test_the_inverse_leads_back():
    motion = Motion(3.0, QUARTER_Z, np.array([1.0, 2, 3]))
    np.testing.assert_allclose(motion.inverse(motion(CLOUD)), CLOUD, atol=1e-12)


@pytest.mark.parametrize(
    ("motion", "kind"),
    [
        (Motion(1.0, np.eye(3), np.array([1.0, 0, 0])), "translation"),
        (Motion(1.0, QUARTER_Z, np.zeros(3)), "rotation"),
        (Motion(1.0, QUARTER_Z, np.array([0, 0, 1.0])), "screw"),
        (Motion(1.0, -np.eye(3), np.zeros(3)), "reflection"),
        (Motion(2.0, np.eye(3), np.zeros(3)), "scale"),
        (Motion(2.0, np.eye(3), np.ones(3)), "similarity"),
    ],
)
def test_kinds(motion, kind):
    assert motion.kind(1.0) == kind


def test_angle_and_axis_obey_the_right_hand():
    motion = Motion(1.0, QUARTER_Z, np.zeros(3))
    assert motion.angle == pytest.approx(90)
    np.testing.assert_allclose(motion.axis, [0, 0, 1], atol=1e-12)
    np.testing.assert_allclose(Motion(1.0, QUARTER_Z.T, np.zeros(3)).axis, [0, 0, -1], atol=1e-12)
