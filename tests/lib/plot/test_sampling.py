"""What is drawn is evaluated once on an open mesh, and what cannot be drawn is told why."""

import functools

import numpy as np
import pytest
from directrix.errors import CurveError, GeometryError, ShapeError
from directrix.plot.sampling import bounds, count_parameters, deviation, grid_normals, sample, size_of

HALVES = np.array([0.0, 0.5, 1.0])


def test_surface_is_called_once_with_an_open_mesh(saddle):
    """One call with u (n, 1) and w (1, m) serves the whole picture."""
    shapes = []

    def watched(u, w):
        shapes.append((u.shape, w.shape))
        return saddle(u, w)

    points = sample(watched, HALVES, np.array([0.0, 1.0]))
    assert shapes == [((3, 1), (1, 2))]
    assert points.shape == (3, 2, 3)
    assert points[1, 1].tolist() == [0.5, 1.0, 0.5]


def test_lists_and_integers_are_points_too():
    """Whatever numpy reads as an array of numbers is drawn."""
    assert sample(lambda u: [[0, 0, 0], [1, 2, 3], [4, 5, 6]], HALVES)[1].tolist() == [1.0, 2.0, 3.0]


def test_a_constant_answer_is_one_point_for_all():
    """A function that ignores u and w is drawn as the point it is."""
    assert sample(lambda u, w: np.array([1.0, 2.0, 3.0]), HALVES, HALVES).shape == (3, 3, 3)


def test_infinite_points_become_holes(saddle):
    """A point with one coordinate that is not finite is left out; its neighbours stay."""
    with_hole = sample(lambda u, w: saddle(u, w) / np.where((u == 0) & (w == 0), 0.0, 1.0)[..., None], HALVES, HALVES)
    assert np.isnan(with_hole[0, 0]).all()
    assert np.isfinite(with_hole[0, 1]).all()


@pytest.mark.parametrize(
    ("answer", "advice"),
    [
        (lambda u, w: np.stack(np.broadcast_arrays(u, w, u)), "The coordinates come first"),
        (lambda u, w: np.stack(np.broadcast_arrays(u, w), axis=-1), "third coordinate is missing"),
        (lambda u, w: np.zeros((3, 4, 5, 3)), "Return np.stack"),
        (lambda u, w: np.zeros((7, 2, 3)), "broadcasting"),
        (lambda u, w: None, "is a return missing?"),
        (lambda u, w: "a point", "'a point' (str)"),
    ],
)
def test_wrong_shape_names_what_came_and_what_to_try(answer, advice):
    """The message holds the shape that came and one thing to do."""
    with pytest.raises(ShapeError, match=r"picture needs|must have shape") as raised:
        sample(answer, HALVES, np.array([0.0, 1.0]))
    assert advice in str(raised.value)


def test_the_number_of_parameters_is_read_from_the_signature():
    """Curves take one, surfaces two, solids three; what has a default does not count."""
    assert count_parameters(lambda u: u) == 1
    assert count_parameters(lambda u, w, r=2: u) == 2
    assert count_parameters(lambda u, v, w: u) == 3
    assert count_parameters(functools.partial(lambda u, w, r: u, r=1)) == 2
    assert count_parameters(lambda *args: args) == 2


def test_a_function_with_more_arguments_is_told_to_fix_them():
    """The advice names the arguments that want a value."""

    def cylinder(u, w, r, h):
        return u

    with pytest.raises(CurveError, match=r"view\(lambda u, w: cylinder\(u, w, \.\.\.\)\) with values for r, h"):
        count_parameters(cylinder)


def test_a_result_instead_of_a_function_is_told_apart():
    """view(f(u, w)) is a common slip."""
    with pytest.raises(CurveError, match=r"an array of shape \(3,\).*not view\(f\(u, w\)\)"):
        count_parameters(np.zeros(3))


def test_grid_normals_of_a_plane_are_exact_and_vanish_at_a_pole():
    """S_u x S_w made unit; zero, never NaN, where a whole row is one point."""
    t = np.linspace(0, 1, 5)
    U, W = np.meshgrid(t, t, indexing="ij")
    plane = np.dstack([2 * U, 3 * W, 0 * U])
    assert (grid_normals(plane) == [0, 0, 1]).all()
    cone = np.dstack([U * np.cos(W), U * np.sin(W), U])
    collapsed = np.where(np.arange(5)[:, None, None] == 0, 0.0, cone)
    normals = grid_normals(collapsed)
    assert np.isfinite(normals).all()
    assert (normals[0] == 0).all()
    np.testing.assert_allclose(np.linalg.norm(normals[1:], axis=-1), 1.0, rtol=1e-14)


def test_deviation_is_nan_where_there_is_none():
    """An infinite answer has no deviation that could be coloured."""
    there = np.zeros((2, 3))
    here = np.array([[3.0, 4.0, 0.0], [np.inf, 0.0, 0.0]])
    assert deviation(there, here)[0] == 5.0
    assert np.isnan(deviation(there, here)[1])


def test_nothing_finite_is_nothing_to_draw():
    """An all-NaN surface is refused with a hint."""
    with pytest.raises(GeometryError, match="every point is NaN or infinite"):
        bounds(np.full((2, 3), np.nan))
    assert size_of(np.zeros((2, 3))) == 1.0  # a single point has a picture all the same
