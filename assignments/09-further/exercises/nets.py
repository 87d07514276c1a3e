"""Nets: cut a Bezier patch in two, raise its degree, one piece of a uniform B-spline, and from sixteen points to control points."""

import directrix as dx
import numpy as np

from autograder.exercise import exercise

# The nets of A6: four by four points, and four by three.
BP = np.array([
    [[-2, 2, 2], [1, 2, -2], [-2, 7, 2], [-1, 14, -2]],
    [[1, 0, -2], [5, 3, 0], [1, 9, 1], [3, 11, 0]],
    [[5, 0, 0], [4, 4, 2], [8, 6, -2], [5, 13, -1]],
    [[7, 1, 1], [11, 3, -2], [8, 9, -1], [7, 11, 2]],
], dtype=float)  # fmt: skip
BP3 = np.array([
    [[0, 0, -1], [2, 4, 1], [-1, 7, -2]],
    [[3, -2, -2], [5, 2, -1], [3, 8, 0]],
    [[8, 2, 0], [8, 3, 0], [5, 9, 2]],
    [[8, 0, 1], [11, 5, 1], [11, 8, -2]],
], dtype=float)  # fmt: skip


# S5 --------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Cut a Bezier patch in two", kind="net", accept={"close": 0.8})
def bezier_split(P, u0):
    """Return the control nets of the two pieces into which the curve u = u0 cuts a Bezier patch.

    Each piece is a Bezier patch of the same degrees, with parameters of its own in [0, 1] that run in the same directions as u and
    w of the whole. The first piece is the one from u = 0 to u = u0.

    P : control points, an array of shape (m, n, 3), first index along u
    u0 : where to cut, a number between 0 and 1

    Returns two arrays of shape (m, n, 3): first, second.
    """
    first, second = dx.split_bezier(dx.BezierPatch(P), u=u0)
    return first.control_net, second.control_net


@bezier_split.data
def lecture(rng):
    return {"P": BP, "u0": 0.3}


# S6 --------------------------------------------------------------------------------------------------------------------------


@exercise(points=4, title="One degree more", kind="net", accept={"close": 0.8})
def elevate_u(P):
    """Return the control net of the same Bezier patch with its degree in u raised by one: the same surface, one more row.

    P : control points, an array of shape (m, n, 3), first index along u

    Returns an array of shape (m + 1, n, 3).
    """
    return dx.elevate(dx.BezierPatch(P), u=1).control_net


@elevate_u.data
def lecture(rng):
    return {"P": BP}


# S7 --------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="One piece of a uniform B-spline", kind="surface")
def uniform_bicubic(u, w, P):
    """Return the points of one piece of a uniform bicubic B-spline surface: the piece that sixteen control points make.

    Order 4 (degree 3) in both directions, knots at equal distances and none of them repeated. So the piece passes, in general,
    through none of its points. u and w run over this one piece.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    P : control points, an array of shape (4, 4, 3), first index along u

    Returns the points, shape of u and w together + (3,).
    """
    knots = np.arange(8.0)
    return dx.BSplinePatch(P, 4, 4, knots, knots)(u, w)


@uniform_bicubic.data
def lecture(rng):
    return {"P": BP}


# S8 --------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="From sixteen points to a Bezier net", kind="net", accept={"close": 0.8})
def points16_to_bezier(P):
    """Return the control net of the bicubic Bezier patch that passes through sixteen points.

    P[i, j] is the point of the patch at u = i/3, w = j/3.

    P : points on the patch, an array of shape (4, 4, 3), first index along u

    Returns the control points, an array of shape (4, 4, 3).
    """
    return dx.to_bezier(dx.PointPatch(P)).control_net


@points16_to_bezier.data
def lecture(rng):
    return {"P": BP}
