"""Whatever a public constructor or function is given, it makes its form or raises a GeometryError: nothing else escapes."""

import warnings

import directrix as dx
import numpy as np
import pytest
from directrix.errors import GeometryError
from hypothesis import given, settings
from hypothesis import strategies as st

RNG = np.random.default_rng(3)
LINE = dx.Line((0, 0, 0), (1, 0, 0))
POOL = [
    None, True, 0, 1, 3, -1, 2.5, np.nan, np.inf, 1e300, 1e-300, "", "open", "periodic", "chord", "linear", "x", b"net",
    [], [[]], {}, 10**400, "2", ("open", "open"),
    (0, 0, 0), (1, 0, 0), (0, 0), [[1, 2], [3]], [None, 1, 2], ["a", "b", "c"], np.array(["1", "2", "3"]), 1j,
    np.zeros(3), np.zeros((4, 3)), np.zeros((2, 2, 3)), np.zeros((4, 4, 3)), np.full((4, 4, 3), np.nan), np.ones((4, 4)),
    -np.ones((4, 4)), np.zeros((4, 4), dtype=object), np.zeros((4, 4, 4, 3)), np.ones((4, 4, 4)), np.zeros((0, 3)),
    RNG.random((3, 3)), RNG.random((5, 3)), RNG.random((12, 3)), RNG.random((2, 2, 3)), RNG.random((4, 4, 3)),
    RNG.random((3, 5, 3)), RNG.random((2, 3, 4, 3)),
    RNG.random((4, 4, 4, 3)), np.arange(8.0), [0, 0, 0, 0, 1, 1, 1, 1], [0, 1, 2, 3, 4, 5, 6, 7],
    LINE, dx.Line((0, 0, 0), (0, 1, 0)), dx.Sphere(1), dx.BezierCurve(RNG.random((4, 3))), np.sin, lambda t: t, lambda t: 1 / 0,
    lambda t: np.zeros((len(t), 3)), dx.BezierPatch(RNG.random((4, 4, 3))), dx.BSplineCurve(RNG.random((5, 3)), 3),
]  # fmt: skip
NET, SOLID, P = RNG.random((4, 5, 3)), RNG.random((2, 3, 4, 3)), RNG.random((4, 3))
POINTS, CORNERS = RNG.random((30, 3)), RNG.random((3, 2, 2, 3))
EDGES = [dx.Line(P[0], P[1]), dx.Line(P[2], P[3]), dx.Line(P[0], P[2]), dx.Line(P[1], P[3])]
POLYGONS = [np.array([curve(t) for t in (0, 0.5, 1)]) for curve in EDGES]
SPLINE = dx.BSplinePatch(NET, 3, 3)
RIGHT = {
    dx.AlgebraicPatch: [NET], dx.HermitePatch: [NET[:, [0, 1, 2, 3]]], dx.HermitePatch.of: [*CORNERS, "coons"],
    dx.PointPatch: [NET, "chord", None], dx.BezierPatch: [NET], dx.BSplinePatch: [NET, 3, 4, "open", "periodic"],
    dx.NurbsPatch: [NET, np.ones((4, 5)), 3, 4, "uniform", "open"], dx.Bilinear: list(P), dx.Ruled: EDGES[:2],
    dx.Coons: [*EDGES, "cubic"], dx.Ferguson: list(CORNERS), dx.coons_net: [*POLYGONS, None, None],
    dx.coons_twists: [NET[:, [0, 1, 2, 3]]], dx.Quadric: list(range(10)), dx.Quadric.through: [POINTS],
    dx.Quadric.from_matrix: [np.eye(4)], dx.quadric_patches: [dx.Quadric(1, 1, -1, 0, 0, 0, 0, 0, 0, -1), 2.0],
    dx.HermiteHyperpatch: [RNG.random((4, 4, 4, 3))], dx.BezierHyperpatch: [SOLID],
    dx.BSplineHyperpatch: [SOLID, 2, 2, 3, "open", "uniform", "open"],
    dx.NurbsHyperpatch: [SOLID, np.ones((2, 3, 4)), 2, 2, 3, "open", "open", "periodic"],
    dx.flatness: [POINTS, "minimum zone"], dx.sphericity: [POINTS, "algebraic"], dx.conicity: [POINTS, "least squares"],
    dx.cylindricity: [POINTS, P[0], P[1], "least squares"], dx.toricity: [POINTS, "least squares"], dx.to_bezier: [SPLINE],
    dx.to_hermite: [dx.BezierPatch(NET[:, :4])], dx.to_algebraic: [dx.BezierPatch(NET)],
    dx.to_points: [dx.BezierPatch(NET), None, None], dx.to_bspline: [SPLINE], dx.to_nurbs: [SPLINE], dx.elevate: [SPLINE, 1, 0],
    dx.split_bezier: [dx.BezierPatch(NET), 0.5, None],
    dx.insert_knot: [SPLINE, 0.5, 0.3, 1], dx.remove_knot: [SPLINE, 0.5, None, 1],
}  # fmt: skip


def name_of(taker):
    return getattr(taker, "__qualname__", repr(taker))


def attempted(taker, arguments):
    """The answer, or the message of the error: only a GeometryError may come, and no warning."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            return taker(*arguments)
        except GeometryError as error:
            return str(error)


@pytest.mark.parametrize("taker", RIGHT, ids=name_of)
def test_one_wrong_argument(taker):
    """Right arguments, each in turn replaced by everything of the pool: a form, or an error with a message worth reading."""
    for place in range(len(RIGHT[taker])):
        for wrong in POOL:
            arguments = list(RIGHT[taker])
            arguments[place] = wrong
            answer = attempted(taker, arguments)
            assert not isinstance(answer, str) or len(answer) > 15


@pytest.mark.parametrize("taker", RIGHT, ids=name_of)
@settings(derandomize=True, max_examples=60, deadline=None)
@given(data=st.data())
def test_all_arguments_wrong(taker, data):
    """Calls with things of wrong type, shape, value and number in every place."""
    arguments = [POOL[data.draw(st.integers(0, len(POOL) - 1))] for _ in RIGHT[taker]]
    answer = attempted(taker, arguments)
    assert not isinstance(answer, str) or len(answer) > 15
