"""Adaptive quadrature: exact where the rule is, honest at kinks."""

from itertools import pairwise

import numpy as np
import pytest
from directrix.quadrature import integrate, integrate_square

WHOLE = np.array([0.0, 1.0])


def test_polynomials_are_exact_to_rounding():
    """Ten points integrate degree 19."""
    assert integrate(lambda u: 20 * u**19, WHOLE) == pytest.approx(1, rel=1e-14)
    assert integrate_square(lambda u, w: 3 * u**2 * 4 * w**3, WHOLE, WHOLE) == pytest.approx(1, rel=1e-14)


@pytest.mark.parametrize("f", [lambda u: np.sqrt(u), lambda u: 1.5 * np.abs(u - 1 / 3) ** 0.5])
def test_a_root_at_the_end_or_inside(f):
    """Halving towards the singular place; scipy is the oracle."""
    from scipy.integrate import quad

    oracle = quad(lambda x: float(f(np.array(x))), 0, 1, points=[1 / 3], epsabs=1e-13)[0]
    assert integrate(f, WHOLE) == pytest.approx(oracle, rel=1e-9)


def test_a_kink_along_a_slanted_line():
    """|u - w| over the square is 1/3."""
    assert integrate_square(lambda u, w: np.abs(u - w), WHOLE, WHOLE) == pytest.approx(1 / 3, rel=1e-9)


def test_breaks_make_a_step_exact():
    """A jump at 1/4 that the caller names costs nothing."""
    assert integrate(lambda u: (u > 0.25) * 1.0, np.array([0, 0.25, 1])) == pytest.approx(0.75, rel=1e-15)


def test_zero_is_zero():
    """Nothing to compare with, and still an end."""
    assert integrate_square(lambda u, w: 0 * u, WHOLE, WHOLE) == 0


@pytest.mark.parametrize("rational", [False, True])
def test_area_of_a_folded_patch(rational):
    """A random net folds, and |S_u x S_w| dips nearly to zero along curves: against 200 x 200 Gauss points on each piece."""
    import directrix as dx

    rng = np.random.default_rng(2024)
    net, weights = rng.standard_normal((5, 4, 3)), rng.uniform(0.5, 2, (5, 4))
    patch = dx.NurbsPatch(net, weights, 4, 3) if rational else dx.BezierPatch(net)
    nodes, shares = np.polynomial.legendre.leggauss(200)
    total = 0.0
    for a, b in pairwise(patch.breaks()[0]):
        for c, d in pairwise(patch.breaks()[1]):
            grid = (a + b + (b - a) * nodes[:, None]) / 2, (c + d + (d - c) * nodes) / 2
            element = np.linalg.norm(np.cross(patch.derivative(*grid, 1, 0), patch.derivative(*grid, 0, 1)), axis=-1)
            total += shares @ element @ shares * (b - a) * (d - c) / 4
    assert patch.area() == pytest.approx(total, rel=1e-6)
