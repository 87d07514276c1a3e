"""Curves as data: equal to the callable to rounding, closed outside [0, 1], honest where they cannot be written down."""

import numpy as np
import pytest

from autograder.curvedata import CurveData, as_curve

CURVES = {
    "line": lambda t: np.stack([1 + 2 * t, -t, 0 * t], -1),
    "arc": lambda t: np.stack([2 * np.cos(np.pi * t), 1 + t**2, 3 * t * (1 - t)], -1),
    "three turns": lambda t: np.stack([np.cos(6 * np.pi * t), np.sin(6 * np.pi * t), t], -1),
    "rational": lambda t: np.stack([1 / (1 + 8 * t**2), t / (1 + 8 * t**2), t], -1),
    "kink at a quarter": lambda t: np.stack([t, np.abs(t - 0.25), 0 * t], -1),
    "far away": lambda t: np.stack([1e6 + np.sin(t), t, 0 * t], -1),
}


@pytest.mark.parametrize("name", CURVES)
def test_data_equal_the_callable_to_rounding(name):
    """2e-14 of the largest coordinate is a hundred roundings: a hundred Chebyshev terms are summed."""
    t = np.linspace(0, 1, 777)
    wanted = CURVES[name](t)
    assert np.abs(as_curve(CURVES[name])(t) - wanted).max() <= 2e-14 * np.abs(wanted).max()


@pytest.mark.parametrize("shape", [(), (5,), (0,), (2, 1, 3)])
def test_points_have_the_shape_of_the_parameters_and_a_last_axis_of_three(shape):
    """Scalars, arrays of any shape and empty arrays, over one piece and over several."""
    for name in ("line", "kink at a quarter"):
        assert as_curve(CURVES[name])(np.full(shape, 0.3)).shape == (*shape, 3)


def test_both_ends_belong_to_the_curve():
    """t = 1 is the end of the last piece, not outside it."""
    curve = as_curve(CURVES["kink at a quarter"])
    assert np.allclose(curve([0.0, 0.25, 1.0])[:, 1], [0.25, 0.0, 0.75], rtol=0, atol=1e-15)


@pytest.mark.parametrize("t", [-0.01, 1.5, np.nan])
def test_outside_the_unit_interval_is_an_error_that_says_what_to_pass(t):
    """An angle passed for the parameter is the usual reason."""
    with pytest.raises(ValueError, match=r"defined for t in \[0, 1\]; got t = .*Pass the parameter itself"):
        as_curve(CURVES["line"])([0.5, t])


def test_rounding_outside_is_taken_as_the_end():
    """1 + 1e-13 is where a sum of steps of 0.1 may end."""
    line = as_curve(CURVES["line"])
    assert np.array_equal(line(1 + 1e-13), line(1.0))


def test_a_kink_off_the_dyadic_fractions_is_refused_with_its_place():
    """Such a curve would be a fit that is almost right: better none."""
    with pytest.raises(ValueError, match=r"not smooth enough near t = 0\.33"):
        as_curve(lambda t: np.stack([t, np.abs(t - 1 / 3), 0 * t], -1))


@pytest.mark.parametrize("wrong", [lambda t: t, lambda t: np.zeros((3, len(t))), lambda t: np.full((len(t), 3), np.nan)])
def test_what_is_not_a_curve_is_refused(wrong):
    """Wrong shape or not finite."""
    with pytest.raises(ValueError, match="a curve must map t"):
        as_curve(wrong)


def test_data_are_kept_as_they_are_and_cannot_be_written():
    """Fitting data again gives the same object; arrays are read-only; equality is by value."""
    line = as_curve(CURVES["line"])
    assert as_curve(line) is line
    assert CurveData(line.breaks, line.coefficients) == line
    with pytest.raises(ValueError, match="read-only"):
        line.coefficients[0, 0, 0] = 5


def test_coefficients_that_do_not_fit_the_breaks_are_refused():
    """p pieces have p + 1 breaks."""
    with pytest.raises(ValueError, match=r"p \+ 1 breaks"):
        CurveData([0, 0.5, 1], np.zeros((1, 4, 3)))
