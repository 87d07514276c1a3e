"""Curvature against forms known in closed form, and numeric derivatives against analytic ones."""

import numpy as np
import pytest
from directrix import differential
from directrix.differential import numeric_derivative, richardson

T = np.linspace(0, 1, 41)


@pytest.mark.parametrize(
    ("order", "tolerance"),
    [(1, 1e-11), (2, 1e-8), (3, 2e-7), (4, 2e-5)],  # what the docstring promises, times the size (2 pi)^order / 6
)
def test_numeric_derivatives_reach_what_they_promise(order, tolerance):
    """Of cos 2 pi t and exp t, at the ends as well as inside."""
    circle = numeric_derivative(lambda t: np.stack([np.cos(2 * np.pi * t), np.exp(t)], -1), T, order)
    exact = np.stack([(2 * np.pi) ** order * np.cos(2 * np.pi * T + order * np.pi / 2), np.exp(T)], -1)
    assert np.abs(circle - exact).max() < tolerance * (2 * np.pi) ** order / 6


def test_numeric_derivatives_of_polynomials_are_rounding():
    """A quintic lies in the space of the interpolant."""
    assert np.allclose(numeric_derivative(lambda t: t**5, T, 1), 5 * T**4, atol=1e-12)


def test_numeric_derivatives_look_closer_at_wild_functions():
    """sin(100 t) needs a window far narrower than a quarter."""
    assert np.allclose(numeric_derivative(lambda t: np.sin(100 * t), T, 1), 100 * np.cos(100 * T), atol=1e-7)


def test_numeric_derivatives_beside_a_kink_stay_on_their_side():
    """|t - 1/2| has slope -1 and +1 as near as 1/500 to its kink."""
    t = np.array([0.0, 0.49, 0.498, 0.502, 0.51, 1.0])
    assert np.allclose(numeric_derivative(lambda x: np.abs(x - 0.5), t, 1), np.sign(t - 0.5), atol=1e-10)


def test_numeric_derivatives_never_look_outside():
    """f is asked for parameters in [0, 1] only."""
    asked = []
    numeric_derivative(lambda t: asked.append((t.min(), t.max())) or t, np.array([0.0, 1e-9, 0.5, 1.0]), 2)
    assert min(low for low, _ in asked) >= 0
    assert max(high for _, high in asked) <= 1


def test_numeric_derivatives_are_pointwise():
    """One parameter alone gives the same bits as among others."""
    f = np.exp
    assert np.array_equal(
        numeric_derivative(f, T, 1), np.concatenate([numeric_derivative(f, T[i : i + 1], 1) for i in range(41)])
    )


def test_curvature_in_skew_coordinates():
    """The graph z = (a x^2 + b y^2) / 2 at its vertex, in parameters sheared and stretched: k = a, b whatever they are."""
    a, b = 3.0, -0.5
    su, sw = np.array([2.0, 0, 0]), np.array([5.0, 0.25, 0])  # x = 2 u + 5 w, y = w / 4
    normal = np.array([0, 0, 1.0])
    form = differential.second_form(
        normal, *(np.array([0, 0, a * p[0] * q[0] + b * p[1] * q[1]]) for p, q in ((su, su), (su, sw), (sw, sw)))
    )
    bent = differential.curvature(su, sw, form)
    assert np.allclose([bent.k1, bent.k2, bent.gaussian, bent.mean], [a, b, a * b, (a + b) / 2], atol=1e-12)
    d1, d2 = differential.principal_directions(su, sw, form)
    assert np.allclose(np.abs(d1), [1, 0, 0], atol=1e-12)
    assert np.allclose(np.cross(d1, d2), normal, atol=1e-12)


def test_curvature_is_the_textbook_quotient():
    """K = (LN - M^2) / (EG - F^2), H = (EN - 2FM + GL) / 2(EG - F^2), on random data."""
    rng = np.random.default_rng(3)
    su, sw = rng.normal(size=(2, 50, 3))
    normal, regular = differential.unit_normal(np.zeros((50, 3)), su, sw)
    form = differential.second_form(normal, *rng.normal(size=(3, 50, 3)))
    E, F, G = differential.first_form(su, sw)
    bent = differential.curvature(su, sw, form)
    assert regular.all()
    assert np.allclose(bent.gaussian, (form.L * form.N - form.M**2) / (E * G - F**2), rtol=1e-9)
    assert np.allclose(bent.mean, (E * form.N - 2 * F * form.M + G * form.L) / (2 * (E * G - F**2)), rtol=1e-9, atol=1e-12)
    assert (bent.k1 >= bent.k2).all()


def test_normals_of_tangents_that_span_nothing():
    """Parallel to 1e-11, or one of them zero: (0, 0, 0) and not regular; parallel to 1e-9 only: regular."""
    su = np.array([[1.0, 0, 0]] * 3)
    sw = np.array([[1.0, 1e-11, 0], [0, 0, 0], [1.0, 1e-9, 0]])
    normal, regular = differential.unit_normal(np.zeros((3, 3)), su, sw)
    assert regular.tolist() == [False, False, True]
    assert normal[:2].tolist() == [[0, 0, 0]] * 2
    assert np.allclose(normal[2], [0, 0, 1])


def test_the_cross_product_is_numpys():
    """Broadcasting included."""
    a, b = np.random.default_rng(0).normal(size=(2, 4, 3))
    assert np.allclose(differential.cross(a[:, None], b), np.cross(a[:, None], b), atol=1e-15)


def test_richardson_finds_the_limit_of_a_power_series():
    """f(t) = 7 + t - 2 t^2 + t^3 at t, t/2, t/4, t/8: the limit is exact."""
    t = np.array([1, 0.5, 0.25, 0.125])
    assert richardson(7 + t - 2 * t**2 + t**3) == pytest.approx(7, abs=1e-14)
