import numpy as np
import pytest

from autograder.comparison.samples import GRID, low_discrepancy, samples


@pytest.mark.parametrize("n", [1, 2, 3])
def test_points_fill_the_closed_domain(n):
    points = samples(n).points
    assert points.min() == 0.0
    assert points.max() == 1.0
    assert len(points) == GRID[n] ** n + 64 + 11 * n


@pytest.mark.parametrize("n", [1, 2, 3])
@pytest.mark.parametrize("seed", [None, 4])
def test_corners_are_kept_under_every_seed(n, seed):
    plan = samples(n, None if seed is None else np.random.default_rng(seed))
    corners = plan.points[plan.corners]
    assert {tuple(c) for c in corners} == {tuple(map(float, f"{i:0{n}b}")) for i in range(2**n)}


def test_no_symmetry_of_the_square_maps_the_scattered_points_onto_themselves():
    points = low_discrepancy(2, 64)
    for image in (points[:, ::-1], 1 - points, np.column_stack([1 - points[:, 0], points[:, 1]])):
        assert np.linalg.norm(points[:, None] - image[None], axis=-1).min(axis=1).max() > 1e-3


def test_a_hidden_seed_moves_inner_lines_and_scattered_points():
    public, hidden, other = samples(2), samples(2, np.random.default_rng(1)), samples(2, np.random.default_rng(2))
    inner = public.inside
    assert (np.abs(public.points - hidden.points)[inner].max(axis=1) > 0).all()
    assert (np.abs(other.points - hidden.points)[inner].max(axis=1) > 0).all()


def test_a_mask_keeps_its_grid_under_a_hidden_seed():
    public, hidden = samples(2), samples(2, np.random.default_rng(1), keep_grid=True)
    count = public.grid.size
    assert (public.points[:count] == hidden.points[:count]).all()
    assert (public.points[count:] != hidden.points[count:]).any()
    assert (hidden.points[:count].sum(axis=1) == 1.0).sum() == 9


def test_simple_fractions_are_met_in_both_parameters():
    plan = samples(2, np.random.default_rng(9))
    for axis in range(2):
        assert {1 / 3, 2 / 3, 1 / 2, 1 / 5, 5 / 6} <= set(plan.points[:, axis])


@pytest.mark.parametrize("n", [1, 2, 3])
def test_the_mesh_names_the_points_that_its_arrays_make(n):
    plan = samples(n, np.random.default_rng(5))
    arrays = np.broadcast_arrays(*plan.open_mesh())
    assert arrays[0].shape == plan.mesh.shape
    assert len(set(plan.mesh.shape)) == len(plan.mesh.shape), "an exchange of axes must show in the shape"
    for axis, array in enumerate(arrays):
        assert (plan.points[plan.mesh][..., axis] == array).all()


def test_what_is_handed_over_is_read_only():
    plan = samples(2)
    assert not any(a.flags.writeable for a in (*plan.columns(), *plan.open_mesh(), plan.points))
