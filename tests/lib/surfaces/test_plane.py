"""Plane and triangle: exact corners, the sweep that they are, and points on one line."""

import directrix as dx
import numpy as np
import pytest

P = (1, 2, 0), (4, 1, 2), (0, 5, 3)
U, W = np.arange(9)[:, None] / 8, np.arange(5)[None, :] / 4


def test_plane_is_exact():
    """Corners p1, p2, p3 and p2 + p3 - p1; the syllabus' number."""
    plane = dx.Plane(*P)
    assert plane([0, 1, 0, 1], [0, 0, 1, 1]).tolist() == [[1, 2, 0], [4, 1, 2], [0, 5, 3], [3, 4, 5]]
    assert plane(0.5, 0.25).tolist() == [2.25, 2.25, 1.75]


def test_triangle_is_exact():
    """The edge w = 1 is p3, all of it; the syllabus' numbers."""
    triangle = dx.Triangle(*P)
    assert triangle(0.5, 0.5).tolist() == [1.25, 3.25, 2]
    assert (triangle(U, 1.0) == P[2]).all()
    assert triangle([0, 1], 0).tolist() == [list(P[0]), list(P[1])]


def test_the_triangle_is_half_of_the_plane():
    """Half its area, in the same plane, with u' + w' <= 1."""
    assert dx.Triangle(*P).area() == pytest.approx(dx.Plane(*P).area() / 2, rel=1e-13)
    p1, p2, p3 = np.array(P, dtype=float)
    inside = np.linalg.lstsq(np.stack([p2 - p1, p3 - p1], 1), (dx.Triangle(*P)(U, W) - p1).reshape(-1, 3).T, rcond=None)[0]
    assert inside.min() > -1e-14
    assert inside.sum(axis=0).max() < 1 + 1e-14


@pytest.mark.parametrize("form", [dx.Plane(*P), dx.Triangle(*P)])
def test_both_are_sweeps(form):
    """A line along a line; for the triangle shrinking to a point on its way."""
    assert np.allclose(form.swept()(U, W), form(U, W), rtol=0, atol=1e-15)


@pytest.mark.parametrize("form", [dx.Plane(*P), dx.Triangle(*P)])
def test_one_normal_everywhere(form):
    """(p2 - p1) x (p3 - p1) made unit, on the collapsed edge too; the implicit form has it as gradient."""
    p1, p2, p3 = np.array(P, dtype=float)
    n = np.cross(p2 - p1, p3 - p1)
    n /= np.linalg.norm(n)
    assert np.allclose(form.normal(U, W), n, atol=1e-14)
    assert np.allclose(form.implicit().gradient(p1), n, atol=1e-15)
    assert np.abs(form.implicit()(form(U, W))).max() < 1e-14
    assert np.allclose(form.curvature(0.3, 0.4), 0, atol=1e-14)


@pytest.mark.parametrize("form", [dx.Plane, dx.Triangle])
@pytest.mark.parametrize("p3", [(7, 0, 4), (1, 2, 0), (4, 1, 2), (-2, 3, -2)])
def test_points_on_one_line_are_refused(form, p3):
    """Beyond, between, or twice the same."""
    with pytest.raises(dx.DegenerateError, match="p1, p2, p3 must not lie on one line; got"):
        form(P[0], P[1], p3)


@pytest.mark.parametrize("size", [1e-150, 1e-9, 1, 1e9, 1e70])
def test_the_size_of_the_points_does_not_matter(size):
    """A tiny triangle is a triangle, a huge line is a line."""
    scaled = size * np.array(P, dtype=float)
    assert np.allclose(dx.Plane(*scaled)(0.5, 0.25) / size, [2.25, 2.25, 1.75], rtol=1e-15)
    with pytest.raises(dx.DegenerateError):
        dx.Plane(scaled[0], scaled[1], 2 * scaled[1] - scaled[0])


def test_moved_planes_are_planes():
    """Of the moved points."""
    shift = dx.Transform.translate((1, 1, 1))
    assert shift @ dx.Plane(*P) == dx.Plane(*(np.array(P) + 1))
    with pytest.raises(dx.ShapeError, match=r"p2 must have shape \(3,\)"):
        dx.Plane(P[0], (1, 2), P[2])
