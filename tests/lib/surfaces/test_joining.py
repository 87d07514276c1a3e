"""How smoothly curves and patches join: what is built to join in a certain way is told so."""

import directrix as dx
import numpy as np
import pytest

P = np.array([(0, 0, 0), (1, 2, 0), (3, 1, 1), (4, 0, 0)], dtype=float)


@pytest.mark.parametrize(
    ("second", "continuity"),
    [
        ([(9, 9, 9), (10, 9, 9), (11, 9, 9), (12, 9, 9)], "none"),
        ([P[3], (9, 0, 0), (10, 1, 0), (12, 0, 0)], "C0"),
        ([P[3], P[3] + 2 * (P[3] - P[2]), (10, 1, 0), (12, 0, 0)], "G1"),
        ([P[3], 2 * P[3] - P[2], (10, 1, 0), (12, 0, 0)], "C1"),
        ([P[3], 2 * P[3] - P[2], 4 * P[3] - 4 * P[2] + P[1], (12, 0, 0)], "C2"),
    ],
)
def test_bezier_curves(second, continuity):
    """The rules for control points: legs in line, equal legs, equal second differences."""
    found = dx.join(dx.BezierCurve(P), dx.BezierCurve(second))
    assert found.continuity == continuity
    if continuity != "none":
        assert (found.edge_a, found.edge_b) == ("u=1", "u=0")


def test_a_curve_run_backwards_joins_as_well():
    """End to end: the sense of the parameters is taken into account."""
    first, second = dx.BezierCurve(P).split(0.5)
    found = dx.join(first, second.flip())
    assert (found.continuity, found.edge_a, found.edge_b) == ("C2", "u=1", "u=1")


def test_a_fold_back_is_not_smooth():
    """A cusp: the tangent lines agree, the directions do not."""
    assert dx.join(dx.Line((0, 0, 0), (1, 0, 0)), dx.Line((1, 0, 0), (0.5, 0, 0))).continuity == "C0"


def test_patches():
    """Stacked cylinders, a sphere on a cylinder, halves of a torus, a lid."""
    cylinder = dx.Cylinder(1, 2)
    lift = dx.Transform.translate((0, 0, 2))
    assert dx.join(cylinder, lift @ cylinder)[:4] == ("C2", "w=1", "w=0", False)
    assert dx.join(cylinder, lift @ dx.Cylinder(1, 3)).continuity == "G1"
    dome = lift @ dx.Sphere(1).patch(0.5, 1, 0, 1)
    found = dx.join(cylinder, dome)
    assert (found.continuity, found.edge_a, found.edge_b) == ("G1", "w=1", "u=0")
    assert dx.join(cylinder, lift @ dx.Cone(1, 0, 1)).continuity == "C0"
    assert dx.join(*dx.Torus(3, 1).split(w=0.3)).continuity == "G1"
    assert dx.join(*dx.Torus(3, 1).split(w=0.5)).continuity == "C2"
    assert dx.join(dx.Sphere(1), cylinder).continuity == "none"


def test_edges_that_run_against_each_other():
    """The same two planes, one of them turned round: the edge is found with its sense."""
    a = dx.Plane((0, 0, 0), (1, 0, 0), (0, 1, 0))
    b = dx.Plane((1, 1, 0), (2, 1, 0), (1, 0, 0))
    assert dx.join(a, b) == dx.surfaces.joining.Join("C2", "u=1", "u=0", True, 0.0)


def test_a_gap_is_measured():
    """In the unit of length, with the edges it lies between."""
    found = dx.join(dx.Cylinder(1, 2), dx.Transform.translate((0, 0, 2.5)) @ dx.Cylinder(1, 2))
    assert found == ("none", "w=1", "w=0", False, 0.5)


def test_numeric_curves_join_too():
    """Second derivatives of a plain callable are good enough to see C2, or not to."""
    f = dx.FunctionCurve(lambda t: np.stack([t, t**3, 0 * t], -1))
    assert dx.join(*f.split(0.5)).continuity in {"C1", "C2"}


@pytest.mark.parametrize(("a", "b"), [(dx.Sphere(1), dx.Line((0, 0, 0), (1, 1, 1))), (dx.Sphere(1), np.sin), (1, 2)])
def test_refused(a, b):
    """Two of a kind."""
    with pytest.raises(dx.GeometryError, match="join needs two curves or two surfaces; got"):
        dx.join(a, b)


@pytest.mark.parametrize("whole", [dx.Sphere(2), dx.Cone(2, 0, 3).swap(), dx.Triangle((0, 0, 0), (2, 0, 1), (0, 3, 0)).swap()])
def test_halves_that_share_a_pole_join_along_their_edge(whole):
    """Their collapsed edges meet as well, in the pole, where nothing can be smooth."""
    found = dx.join(*whole.split(w=0.3))
    assert ({found.edge_a, found.edge_b}, found.continuity) == ({"w=0", "w=1"}, "G1")  # at the cut or at the seam
