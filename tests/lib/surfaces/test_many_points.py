"""Many scattered points take another way than few, and grids are cut into blocks: all ways give the same surface."""

import pickle

import directrix as dx
import numpy as np
import pytest
from directrix.basis import SpanTable, spline_span
from directrix.surfaces import spline, support
from directrix.surfaces.spline import de_boor_point
from hypothesis import given, settings
from hypothesis import strategies as st

ORDERS = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 2)]
seeds = st.integers(0, 2**32 - 1)
fixed = settings(derandomize=True, max_examples=60, deadline=None)


def any_knots(rng, count, order):
    """A word, or knots with creases, gaps, knots repeated more than the order, clamped or not, spans long and tiny."""
    kind = rng.integers(5)
    if kind == 0:
        return str(rng.choice(["open", "uniform", "periodic"]))
    if kind == 1:
        return np.cumsum(10.0 ** rng.uniform(-6, 2, count + order)) - 5
    knots = np.sort(rng.integers(0, 2 + rng.integers(1, 9), count + order)) / 4 - 1
    if kind == 2:
        knots[:order], knots[-order:] = knots[0], knots[-1]
    return knots if knots[order - 1] < knots[-order] else "open"


def any_patch(rng):
    m, n = (int(x) for x in rng.integers(2, 12, 2))
    k, l = int(rng.integers(1, m + 1)), int(rng.integers(1, n + 1))  # noqa: E741
    net, knots = rng.standard_normal((m, n, 3)), (any_knots(rng, m, k), any_knots(rng, n, l))
    if rng.integers(2):
        return dx.NurbsPatch(net, rng.uniform(0.25, 4, (m, n)), k, l, *knots)
    return dx.BSplinePatch(net, k, l, *knots)


def places(rng, patch, count):
    """Parameters at random, at both ends and at every knot."""
    found = [np.concatenate([breaks, rng.random(count)]) for breaks in patch.breaks()]
    return [rng.choice(values, count) for values in found]


@pytest.fixture
def small_blocks(monkeypatch):
    """Every number of points counts as many, and blocks are small, the last one not full."""
    monkeypatch.setattr(spline, "FEW", 0)
    monkeypatch.setattr(support, "BLOCK", 7)
    monkeypatch.setattr("directrix.surfaces.grids.BLOCK", 20)


@fixed
@given(seeds)
def test_many_points_are_few_points(seed):
    """Derivatives at more points than FEW against the same points by the few, and values against the recursion."""
    rng = np.random.default_rng(seed)
    patch = any_patch(rng)
    u, w = places(rng, patch, support.FEW + 40)
    for order in ORDERS[:: 1 + seed % 3]:
        many = patch.derivative(u, w, *order)
        few = np.concatenate([patch.derivative(u[i : i + 500], w[i : i + 500], *order) for i in range(0, len(u), 500)])
        np.testing.assert_allclose(many, few, atol=1e-9 * (1 + np.abs(few).max()))
    slow = [de_boor_point(patch, a, b) for a, b in zip(u[:9], w[:9], strict=True)]
    np.testing.assert_allclose(patch(u, w)[:9], slow, atol=1e-11)


@fixed
@given(seeds)
def test_a_grid_is_its_points(seed):
    """Grids long, wide and square, sorted or not, against the same parameters scattered: derivatives and normals."""
    rng = np.random.default_rng(seed)
    patch = any_patch(rng)
    p, q = (int(x) for x in rng.choice([1, 2, 40, 90], 2))
    u, w = places(rng, patch, p)[0], places(rng, patch, q)[1]
    if seed % 2:
        u = np.sort(u)
    order = ORDERS[seed % len(ORDERS)]
    grid = patch.derivative(u[:, None], w[None], *order)
    scattered = patch.derivative(*np.meshgrid(u, w, indexing="ij"), *order)
    np.testing.assert_allclose(grid, scattered, atol=1e-9 * (1 + np.abs(grid).max()))
    assert grid.shape == (p, q, 3)


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("seed", range(12))
def test_the_last_block_is_not_full(seed):
    """Blocks of a few points or rows: no value of the block before stays behind."""
    rng = np.random.default_rng(seed)
    patch = any_patch(rng)
    for count in (1, 6, 7, 8, 23):
        u, w = places(rng, patch, count)
        slow = [de_boor_point(patch, a, b) for a, b in zip(u, w, strict=True)]
        np.testing.assert_allclose(patch(u, w), slow, atol=1e-11)
        np.testing.assert_allclose(patch(u[:, None], w[None])[range(count), range(count)], slow, atol=1e-11)


@pytest.mark.usefixtures("small_blocks")
def test_normals_do_not_depend_on_blocks():
    """The grid's normals, a few rows at a time, against those of single points, poles among them."""
    rng = np.random.default_rng(4)
    net = rng.standard_normal((6, 7, 3))
    net[0] = net[0, 0]  # a pole along u = 0
    for surface in (dx.NurbsPatch(net, rng.uniform(0.5, 2, (6, 7)), 4, 3), dx.BezierPatch(net), dx.Sphere(2), dx.Cone(2, 0, 3)):
        u, w = np.linspace(0, 1, 11), np.linspace(0, 1, 9)
        grid = surface.normal(u[:, None], w[None])
        single = [[surface.normal(a, b) for b in w] for a in u]
        np.testing.assert_allclose(grid, single, atol=1e-9)


@pytest.mark.parametrize(
    "shapes", [((), (1200,)), ((30, 1), (1, 50)), ((3, 1, 20), (40, 1)), ((4, 5, 60), (4, 5, 60)), ((0,), (0,))]
)
def test_shapes_of_many_points(shapes):
    """Whatever broadcasts: the same numbers as one point at a time, writable, of the promised shape."""
    rng = np.random.default_rng(5)
    patch = dx.NurbsPatch(rng.random((9, 8, 3)), rng.uniform(0.5, 2, (9, 8)), 4, 3)
    u, w = (rng.random(shape) for shape in shapes)
    found = patch(u, w)
    assert found.shape == (*np.broadcast_shapes(*shapes), 3)
    assert found.flags.writeable
    for at in list(np.ndindex(found.shape[:-1]))[::97]:
        a, b = (np.broadcast_to(x, found.shape[:-1])[at] for x in (u, w))
        np.testing.assert_allclose(found[at], de_boor_point(patch, float(a), float(b)), atol=1e-13)


@pytest.mark.parametrize("seed", range(40))
def test_a_span_table_is_the_search(seed):
    """At knots, between, in spans of a millionth of the domain, at both ends."""
    rng = np.random.default_rng(seed)
    patch = any_patch(rng)
    vector = patch.knot_vector_u
    u = np.concatenate([vector.breaks(), np.nextafter(vector.breaks()[1:], 0), rng.random(300)])
    t = vector.stretch(u)
    assert (SpanTable(vector.values, vector.order)(u, t) == spline_span(vector.values, vector.order, t)).all()


def test_what_is_prepared_is_not_part_of_the_form():
    """Tables and pieces are made when first needed; equality, hash and pickles do not see them."""
    rng = np.random.default_rng(6)
    patch = dx.BSplinePatch(rng.random((5, 5, 3)), 4, 4)
    twin = dx.BSplinePatch(patch.control_net, 4, 4)
    patch(*rng.random((2, 2000)))
    assert patch == twin
    assert hash(patch) == hash(twin)
    assert len(pickle.dumps(patch)) == len(pickle.dumps(twin))
    assert pickle.loads(pickle.dumps(patch)) == patch
