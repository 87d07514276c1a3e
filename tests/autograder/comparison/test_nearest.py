"""Distances to black-box maps against closed forms, with the traps that once caught them."""

import numpy as np
import pytest

from autograder.comparison.nearest import nearest
from autograder.comparison.sets import measured

TURN = 2 * np.pi


def as_points(f):
    return lambda p: np.stack(np.broadcast_arrays(*f(*p.T)), axis=-1)


def cylinder(u, w):
    return 2 * np.cos(TURN * u), 2 * np.sin(TURN * u), 5 * w


def distance_to_cylinder(x):
    radius = np.hypot(x[:, 0], x[:, 1])
    beyond = np.maximum(np.maximum(-x[:, 2], x[:, 2] - 5), 0)
    return np.hypot(radius - 2, beyond)


def distances(f, targets, n=2):
    of = measured(as_points(f), n)
    return nearest(of.at, of.cloud, targets, 1e-12).distances


def test_distances_to_a_cylinder_are_those_of_the_formula():
    """Far from a bent map the search stops at 1e-4 of the distance; near it, where it decides, at rounding."""
    targets = np.random.default_rng(4).uniform([-3, -3, -2], [3, 3, 7], size=(60, 3))
    np.testing.assert_allclose(distances(cylinder, targets), distance_to_cylinder(targets), rtol=1e-4)
    s, t = np.random.default_rng(5).uniform(size=(2, 60))
    near = np.stack(np.broadcast_arrays(*cylinder(s, t)), axis=-1) + np.random.default_rng(6).normal(scale=1e-4, size=(60, 3))
    np.testing.assert_allclose(distances(cylinder, near), distance_to_cylinder(near), atol=1e-9)


@pytest.mark.parametrize(
    ("name", "f"),
    [
        ("plain", lambda u, w: (u, w, u * w)),
        ("zero derivative at an edge", lambda u, w: (np.sin(np.pi * u / 2), w, np.sin(np.pi * u / 2) * w)),
        ("squared", lambda u, w: (u**2, w**3, u**2 * w**3)),
        ("collapsed edge", lambda u, w: ((1 - w) * u, w, (1 - w) * u * w)),
        ("kink", lambda u, w: (np.where(u < 0.5, u / 2, 1.5 * u - 0.5), w, np.where(u < 0.5, u / 2, 1.5 * u - 0.5) * w)),
        ("half of the square squeezed to an edge", lambda u, w: (np.minimum(u, 1 - w) + 0 * w, w, np.minimum(u, 1 - w) * w)),
    ],
)
def test_points_of_the_saddle_are_found_on_it_however_it_is_traced(name, f):
    s, t = np.random.default_rng(6).uniform(size=(2, 40))
    if name in ("collapsed edge", "half of the square squeezed to an edge"):
        s = s * (1 - t)
    targets = np.stack([s, t, s * t], axis=-1)
    assert distances(f, targets).max() < 1e-9


def test_distances_to_a_curve():
    targets = np.array([[0.0, 0, 0], [3, 0, 0], [0, 4, 0], [1, 0, 2]])
    circle = distances(lambda u: (np.cos(np.pi * u), np.sin(np.pi * u), 0 * u), targets, n=1)
    np.testing.assert_allclose(circle, [1, 2, 3, 2], atol=1e-9)


def test_distances_to_a_solid():
    targets = np.array([[0.5, 0.5, 0.5], [2, 0.5, 0.5], [2, 2, 1], [-1, -1, -1]])
    found = distances(lambda u, v, w: (u, v, w), targets, n=3)
    np.testing.assert_allclose(found, [0, 1, np.sqrt(2), np.sqrt(3)], atol=1e-9)
