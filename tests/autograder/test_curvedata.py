"""Curves and surfaces as data: equal to the callable to rounding, closed outside [0, 1], honest where they cannot be fitted."""

import numpy as np
import pytest

from autograder.curvedata import CurveData, SurfaceData, as_curve, as_data, as_surface

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


SURFACES = {
    "saddle": lambda u, w: np.stack(np.broadcast_arrays(1 + 2 * u, w - 3, u * w**3), -1),
    "torus": lambda u, w: np.stack(
        np.broadcast_arrays(
            (3 + np.cos(2 * np.pi * u)) * np.cos(2 * np.pi * w),
            (3 + np.cos(2 * np.pi * u)) * np.sin(2 * np.pi * w),
            np.sin(2 * np.pi * u),
        ),
        -1,
    ),
    "two turns": lambda u, w: np.stack(np.broadcast_arrays(np.cos(4 * np.pi * u), np.sin(4 * np.pi * u), w), -1),
    "constant": lambda u, w: np.zeros((*np.broadcast_shapes(np.shape(u), np.shape(w)), 3)) + [1.0, 2.0, 3.0],
}


@pytest.mark.parametrize("name", SURFACES)
def test_surfaces_equal_the_callable_to_rounding_on_scattered_points_and_on_open_meshes(name):
    """2e-14 of the largest coordinate, as for curves: about a thousand terms are summed."""
    u, w = np.random.default_rng(5).uniform(size=(2, 300))
    data, wanted = as_surface(SURFACES[name]), SURFACES[name](u, w)
    assert np.abs(data(u, w) - wanted).max() <= 2e-14 * np.abs(wanted).max()
    mesh = np.linspace(0, 1, 21)[:, None], np.linspace(0, 1, 17)[None, :]
    assert np.abs(data(*mesh) - SURFACES[name](*mesh)).max() <= 2e-14 * np.abs(wanted).max()


@pytest.mark.parametrize(
    ("u", "w", "shape"),
    [(0.3, 1.0, ()), (np.zeros(4), 0.5, (4,)), (0.5, np.empty(0), (0,)), (np.zeros((3, 1)), np.ones((1, 2)), (3, 2))],
)
def test_a_surfaces_points_have_the_shape_of_u_and_w_together(u, w, shape):
    """Single numbers, mixed, empty, open meshes."""
    for surface in SURFACES.values():
        assert as_surface(surface)(u, w).shape == (*shape, 3)


def test_a_surface_keeps_no_more_than_it_needs():
    """Bilinear times cubic: what is there is the polynomial, and not sixty-five rounding errors."""
    assert as_surface(SURFACES["saddle"]).coefficients.shape == (2, 4, 3)


@pytest.mark.parametrize(("u", "w", "name"), [(-0.01, 0.5, "u"), (0.5, 1.5, "w"), (np.nan, 0.5, "u")])
def test_outside_the_unit_square_is_an_error_that_names_the_parameter(u, w, name):
    with pytest.raises(ValueError, match=rf"defined for u and w in \[0, 1\]; got {name} ="):
        as_surface(SURFACES["torus"])(u, [0.5, w])


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (lambda u, w: np.stack(np.broadcast_arrays(u, w, np.abs(u - w)), -1), "not smooth enough"),
        (lambda u, w: np.stack(np.broadcast_arrays(u, w, np.sqrt(u + 0.001)), -1), "not smooth enough"),
        (lambda u, w: u + w, "a surface must map u"),
        (lambda u, w: np.full((65, 65, 3), np.nan), "a surface must map u"),
    ],
)
def test_what_is_no_smooth_surface_is_refused(wrong, said):
    """A crease, a root too near the edge, no points, no numbers."""
    with pytest.raises(ValueError, match=said):
        as_surface(wrong)


def test_a_surface_is_kept_as_it_is_and_cannot_be_written():
    torus = as_surface(SURFACES["torus"])
    assert as_surface(torus) is torus
    assert as_data(torus) is torus
    assert SurfaceData(torus.coefficients) == torus
    assert hash(SurfaceData(torus.coefficients)) == hash(torus)
    with pytest.raises(ValueError, match="read-only"):
        torus.coefficients[0, 0, 0] = 5
    with pytest.raises(ValueError, match=r"coefficients of shape \(n, m, dimension\)"):
        SurfaceData(np.zeros(3))


def test_the_number_of_arguments_tells_a_surface_from_a_curve():
    """What has a default need not be given, and does not count."""
    assert isinstance(as_data(SURFACES["saddle"]), SurfaceData)
    assert isinstance(as_data(CURVES["arc"]), CurveData)
    assert isinstance(as_data(lambda t, r=2.0: np.stack([r * t, t, t], -1)), CurveData)
