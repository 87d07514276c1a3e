"""Examples that are printed in books and courses, each with where it stands. More of them: example 4.3 of The NURBS Book in
`surfaces/test_spline_patches.py`, TAMU CPSC 645 in `surfaces/test_boundary.py`, the matrices in `conversion`."""

import directrix as dx
import numpy as np
import pytest
from directrix.basis import spline_row
from numpy.polynomial import Polynomial

KNOTS = np.array([0.0, 0, 0, 1, 2, 3, 4, 4, 5, 5, 5])
# Piegl & Tiller, The NURBS Book, 2nd ed., example 2.2: the quadratic functions on these knots, span by span, powers ascending.
PIECES = {
    (0, 0): (1, -2, 1), (1, 0): (0, 2, -3 / 2), (2, 0): (0, 0, 1 / 2), (1, 1): (2, -2, 1 / 2), (2, 1): (-3 / 2, 3, -1),
    (3, 1): (1 / 2, -1, 1 / 2), (2, 2): (9 / 2, -3, 1 / 2), (3, 2): (-11 / 2, 5, -1), (4, 2): (2, -2, 1 / 2),
    (3, 3): (8, -4, 1 / 2), (4, 3): (-16, 10, -3 / 2), (5, 3): (9, -6, 1), (5, 4): (25, -10, 1), (6, 4): (-40, 18, -2),
    (7, 4): (16, -8, 1),
}  # fmt: skip


@pytest.mark.parametrize("derivative", [0, 1, 2])
def test_the_nurbs_book_example_2_2(derivative):
    """All eight functions as polynomials on all five spans, and their derivatives."""
    for span in range(5):
        t = span + np.array([0.0, 0.25, 0.5, 0.875])
        printed = np.zeros((4, 8))
        for (i, where), powers in PIECES.items():
            if where == span:
                printed[:, i] = Polynomial(powers).deriv(derivative)(t) if derivative else Polynomial(powers)(t)
        np.testing.assert_allclose(spline_row(KNOTS, 3, t, derivative), printed, atol=1e-13)


def test_the_nurbs_book_examples_2_3_and_2_4():
    """At 5/2 the functions 2, 3, 4 are 1/8, 6/8, 1/8; their derivatives -1/2, 0, 1/2, and then 1, -2, 1."""
    at = np.array([2.5])
    assert spline_row(KNOTS, 3, at)[0, 2:5].tolist() == [1 / 8, 6 / 8, 1 / 8]
    assert spline_row(KNOTS, 3, at, 1)[0, 2:5].tolist() == [-1 / 2, 0, 1 / 2]
    assert spline_row(KNOTS, 3, at, 2)[0, 2:5].tolist() == [1, -2, 1]


def test_the_nurbs_book_example_4_1():
    """Weights 1, 4, 1, 1, 1 on (0,0,0,1,2,3,3,3): C(1) = (7/5, 6/5)."""
    points = [(0, 0, 0), (1, 1, 0), (3, 2, 0), (4, 1, 0), (5, -1, 0)]
    curve = dx.NurbsCurve(points, [1, 4, 1, 1, 1], 3, [0, 0, 0, 1, 2, 3, 3, 3])
    np.testing.assert_allclose(curve(1 / 3), (7 / 5, 6 / 5, 0), rtol=1e-15)


def test_the_nurbs_book_example_4_2():
    """The quarter circle by weights 1, 1, 2: C'(0) = (0, 2), C'(1) = (-1, 0), C''(0) = (-4, 0), C''(1) = (1, -1)."""
    quarter = dx.NurbsCurve([(1, 0, 0), (1, 1, 0), (0, 1, 0)], [1, 1, 2], 3)
    assert quarter.derivative([0.0, 1.0], 1).tolist() == [[0, 2, 0], [-1, 0, 0]]
    assert quarter.derivative([0.0, 1.0], 2).tolist() == [[-4, 0, 0], [1, -1, 0]]


def test_turning_about_y_as_cornell_prints_it():
    """CS465, homework 6: (x cos 2πw, y, -x sin 2πw), anticlockwise about the positive y axis."""
    curve = dx.BezierCurve([(1, 0, 0), (3, 1, 0), (1, 2, 0), (2, 3, 0)])
    u, w = np.linspace(0, 1, 9)[:, None], np.linspace(0, 1, 17)
    x, y, _ = np.moveaxis(curve(u), -1, 0)
    printed = np.stack(np.broadcast_arrays(x * np.cos(2 * np.pi * w), y, -x * np.sin(2 * np.pi * w)), axis=-1)
    np.testing.assert_allclose(dx.CircularSweep(curve, axis="y")(u, w), printed, atol=1e-14)


def test_a_bicubic_patch_has_48_degrees_of_freedom_as_mortenson_counts_them():
    """Sixteen vectors: in the algebraic, the geometric, the point and the Bezier form alike."""
    patch = dx.HermitePatch(np.random.default_rng(1).random((4, 4, 3)))
    forms = patch.G, dx.to_algebraic(patch).a, dx.to_points(patch).points, dx.to_bezier(patch).control_net
    assert [form.size for form in forms] == [48] * 4
