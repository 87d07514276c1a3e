"""Adaptive quadrature: exact where the rule is, honest at kinks."""

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
