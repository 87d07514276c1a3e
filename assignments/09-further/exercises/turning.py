"""Turning: a screw sweep, an exact NURBS net of revolution, and what a line becomes when it is turned."""

import directrix as dx
import numpy as np

from autograder.exercise import exercise

TURN = 2 * np.pi


def points(x, y, z):
    """Coordinates that broadcast against each other, as points of shape (..., 3)."""
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


# S3 --------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Screw sweep about x", kind="surface")
def screw_sweep(u, w, curve, pitch, turns):
    """Return the points of the surface that a curve sweeps when it is screwed along the x axis.

    While w goes from 0 to 1 the curve makes `turns` turns about the x axis, in the positive (right-hand) sense, and with each
    whole turn it moves `pitch` along x. u runs along the curve, and at w = 0 the curve is where it was given.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    curve : a function; curve(t) gives points for t in [0, 1], an array of shape t.shape + (3,)
    pitch : the way along x in one whole turn, a length; below 0 the screw is left-handed
    turns : number of turns, need not be whole

    Returns the points, shape of u and w together + (3,).
    """
    return _screwed(u, w, curve, TURN * turns, pitch * turns)


def _screwed(u, w, curve, angle, advance):
    x, y, z = np.moveaxis(curve(np.asarray(u, dtype=float)), -1, 0)
    w = np.asarray(w, dtype=float)
    c, s = np.cos(angle * w), np.sin(angle * w)
    return points(x + advance * w, c * y - s * z, s * y + c * z)


@screw_sweep.data
def printed(rng):
    return {"curve": dx.Line([0, 0, 0], [0, 3, 0]), "pitch": 10.0, "turns": 1.0}


# S11 -------------------------------------------------------------------------------------------------------------------------


def evaluated(answer):
    """The NURBS surface that an answer (P, weights, knots) stands for: Bezier along u, quadratic on the given knots along w."""
    if not isinstance(answer, tuple | list) or len(answer) != 3:
        raise ValueError(
            "three things are wanted, the control net, the weights and the knots along w: return P, weights, knots."
        )
    P, weights, knots = (np.asarray(part, dtype=float) for part in answer)
    if P.ndim != 3 or P.shape[2] != 3 or P.shape[1] < 3:
        raise ValueError(f"the control net must have shape (n, 9, 3), first index along the profile; yours has {P.shape}.")
    if weights.shape != P.shape[:2]:
        raise ValueError(f"the weights must have shape {P.shape[:2]}, one for each control point; yours have {weights.shape}.")
    if knots.shape != (P.shape[1] + 3,):
        raise ValueError(f"{P.shape[1]} columns of order 3 need {P.shape[1] + 3} knots along w; yours are {knots.size}.")
    return dx.NurbsPatch(P, weights, len(P), 3, knots_w=knots)


@exercise(
    points=6,
    title="Exact surface of revolution",
    kind="net",
    judged_as=evaluated,
    accept={"same set": 1.0, "relabelled": 0.5, "other start": 0.5, "close": 0.8},
)
def nurbs_revolve(profile, h):
    """Return control net, weights and knots, (P, weights, knots), of the NURBS surface that a profile makes in one whole turn
    about z.

    The profile is a rational Bezier curve of n control points (ρ, z), where ρ is the distance from the axis: order n along u. Along w
    the order is 3 (degree 2), and nine columns make the circle: four arcs of a quarter turn each, whose joints are doubled
    knots 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4. w = 0 is the half-plane y = 0, x >= 0, and the sense is positive. Judged is the surface,
    not the numbers: whatever gives all its points, and no others, is right.

    profile : control points (ρ, z) of the profile, an array of shape (n, 2)
    h : their weights, n numbers above 0, an array of shape (n,)

    Returns P, an array of shape (n, 9, 3), first index along the profile, in Cartesian points (not multiplied by weights);
    weights, an array of shape (n, 9); knots, the 12 knots along w.
    """
    return _revolved(profile, h)


SQUARE = np.array([[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]], dtype=float)
ARC = np.array([1, np.sqrt(0.5)] * 4 + [1])
KNOTS = np.array([0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4], dtype=float)


def _revolved(profile, h, weights=None, square=SQUARE, knots=KNOTS):
    """Net, weights and knots; with other weights, other places of the nine columns, or other knots."""
    rho, z = np.asarray(profile, dtype=float).T
    P = points(rho[:, None] * square[:, 0], rho[:, None] * square[:, 1], z[:, None])
    return P, np.outer(h, ARC) if weights is None else weights, knots


@nurbs_revolve.data
def ball(rng):
    """A semicircle as a rational cubic: the sphere of radius 2."""
    return {"profile": [[0.0, -2.0], [4.0, -2.0], [4.0, 2.0], [0.0, 2.0]], "h": [3.0, 1.0, 1.0, 3.0]}


# S13 -------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="What does a turning line make?", kind="label")
def revolved_line_kind(p, d, point, axis):
    """Return what an unlimited straight line sweeps in one whole turn about an axis: 'cylinder', 'cone', 'plane', 'hyperboloid'
    or 'line'.

    A cone is the double cone. A plane counts as 'plane' with a round hole, too. A line that turns in itself stays a 'line'.
    Numbers are rounded: directions are parallel, or at right angles, and lines meet, when they do so to 1e-9 relative to the
    lengths that are given.

    p : a point of the line, an array of shape (3,)
    d : its direction, an array of shape (3,); the length means nothing
    point : a point of the axis, an array of shape (3,)
    axis : the direction of the axis, an array of shape (3,); the length means nothing

    Returns one of the five words.
    Raises ValueError where d or axis is (0, 0, 0): that is no direction.
    """
    return _kind(p, d, point, axis)


def _unit(d, axis):
    if not (np.any(d) and np.any(axis)):
        raise ValueError(f"a direction must not be (0, 0, 0); got d = {d} and axis = {axis}")
    return d / np.linalg.norm(d), axis / np.linalg.norm(axis)


def _kind(p, d, point, axis, tolerance=1e-9):
    d, k = _unit(d, axis)
    v = np.subtract(p, point)
    size = max(np.abs(p).max(), np.abs(point).max(), np.linalg.norm(v))
    across = np.cross(d, k)
    if np.linalg.norm(across) <= tolerance:
        return "line" if np.linalg.norm(np.cross(v, k)) <= tolerance * size else "cylinder"
    if abs(d @ k) <= tolerance:
        return "plane"
    return "cone" if abs(v @ across) <= tolerance * size * np.linalg.norm(across) else "hyperboloid"


@revolved_line_kind.data
def cooling_tower(rng):
    return {"p": [3.0, 0.0, 0.0], "d": [0.0, 1.0, 2.0], "point": [0.0, 0.0, 0.0], "axis": [0.0, 0.0, 1.0]}
