"""Small exercises to hold the judge to, written as an instructor would write them."""

import numpy as np
import pytest

from autograder.exercise import exercise

TURN = 2 * np.pi


def points(x, y, z):
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


def make_tube():
    @exercise(points=4, title="A tube", kind="surface", accept={"same set": 0.3})
    def tube(u, w, r, h):
        """Return the cylinder of radius r about the z axis from z = 0 to z = h."""
        return points(r * np.cos(TURN * u), r * np.sin(TURN * u), h * w)

    @tube.data
    def any_size(rng):
        return {"r": rng.uniform(1.5, 3.0), "h": rng.uniform(4.0, 6.0)}

    @tube.data
    def hanging(rng):
        return {"r": rng.uniform(1.5, 3.0), "h": -rng.uniform(1.0, 2.0)}

    @tube.data(blind=True)
    def unit(rng):
        return {"r": 1.0, "h": 1.0}

    @tube.mistake("diameter", credit=0.5)
    def _(u, w, r, h):
        """Your circle is half as wide as asked for."""
        return points(r / 2 * np.cos(TURN * u), r / 2 * np.sin(TURN * u), h * w)

    @tube.mistake("no_height", credit=0.25)
    def _(u, w, r, h):
        """Your tube is one tall, whatever h is."""
        return points(r * np.cos(TURN * u), r * np.sin(TURN * u), w)

    @tube.mistake("swap_uw")
    def _(u, w, r, h):
        """u and w are exchanged."""
        return points(r * np.cos(TURN * w), r * np.sin(TURN * w), h * u)

    return tube


@pytest.fixture
def tube():
    return make_tube()


@pytest.fixture
def swept():
    """An exercise with a curve in its data and arguments for which there is no answer."""

    @exercise(points=4, title="Sweep", kind="surface")
    def swept(u, w, curve, direction):
        """Sweep the curve by the unit vector of the direction."""
        length = np.linalg.norm(direction)
        if length == 0:
            raise ValueError("a direction must not be 0")
        return curve(u) + np.asarray(w)[..., None] * np.asarray(direction) / length

    def wavy(t):
        return points(t, np.sin(3 * t), 1 - t**2)

    @swept.data
    def slanted(rng):
        return {"curve": wavy, "direction": rng.uniform(1.0, 2.0, 3)}

    @swept.data
    def nowhere(rng):
        return {"curve": wavy, "direction": np.zeros(3)}

    return swept


@pytest.fixture
def helix():
    @exercise(points=2, title="Helix", kind="curve")
    def helix(u, r, pitch):
        """Return the helix."""
        return points(r * np.cos(TURN * u), r * np.sin(TURN * u), pitch * np.asarray(u))

    @helix.data
    def any_helix(rng):
        return {"r": rng.uniform(1, 2), "pitch": rng.uniform(3, 4)}

    return helix


@pytest.fixture
def block():
    @exercise(points=2, title="Block", kind="solid")
    def block(u, v, w, a, b, c):
        """Return the block with a bulge."""
        return points(a * u + 0.3 * np.asarray(v) * w, b * v + 0.2 * np.asarray(w) ** 2, c * np.asarray(w))

    @block.data
    def any_block(rng):
        a, b, c = rng.uniform(1, 3, 3)
        return {"a": a, "b": b, "c": c}

    return block


@pytest.fixture
def net_of_a_quarter():
    """An answer that is judged as the surface it makes."""

    def quadratic(answer):
        net, weights = answer
        net, weights = np.asarray(net, dtype=float), np.asarray(weights, dtype=float)
        if net.shape[-1] != 3 or net.shape[:2] != weights.shape or len(net) != 3:
            raise ValueError(f"a net has shape (3, n, 3) and weights (3, n); got {net.shape} and {weights.shape}")

        def surface(u, w):
            u, w = np.broadcast_arrays(u, w)
            bu = np.stack([(1 - u) ** 2, 2 * u * (1 - u), u**2], axis=-1)
            bw = np.stack([1 - w, w], axis=-1)
            blend = bu[..., :, None] * bw[..., None, :] * weights
            return np.einsum("...ij,ijk->...k", blend, net) / blend.sum(axis=(-2, -1))[..., None]

        return surface

    @exercise(points=5, title="Quarter", kind="net", accept={"same set": 1.0}, judged_as=quadratic)
    def quarter(r, h):
        """Return the net (3, 2, 3) and the weights (3, 2) of a quarter of a cylinder."""
        corner = np.array([[r, 0, 0], [r, r, 0], [0, r, 0]], dtype=float)
        net = np.stack([corner, corner + [0, 0, h]], axis=1)
        return net, np.array([[1.0, 1.0], [np.sqrt(0.5), np.sqrt(0.5)], [1.0, 1.0]])

    @quarter.data
    def any_size(rng):
        return {"r": rng.uniform(1, 3), "h": rng.uniform(2, 5)}

    @quarter.mistake("weight_1", credit=0.4)
    def _(r, h):
        """A parabola, not a circle."""
        return quarter.reference(r, h)[0], np.ones((3, 2))

    return quarter
