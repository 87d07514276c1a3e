"""Turning: a screw sweep, an exact NURBS net of revolution, and what a line becomes when it is turned.

Over 400 lines: each exercise stands here whole, its reference, its data and its mistakes one below the other.
"""

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


def bent(rng):
    """A random cubic that lies in no plane and stays away from the x axis."""
    return dx.BezierCurve(np.array([[1.5, 1, 1], [3, 2, 1.5], [3, 3.5, 3], [2, 4, 1.5]]) + rng.uniform(-0.3, 0.3, (4, 3)))


@screw_sweep.data
def printed(rng):
    """A line of length 3, from the axis outwards, 10 forward in one turn: S(1/2, 1/2) = (5, -1.5, 0)."""
    return {"curve": dx.Line([0, 0, 0], [0, 3, 0]), "pitch": 10.0, "turns": 1.0}


@screw_sweep.data
def any_screw(rng):
    return {"curve": bent(rng), "pitch": rng.uniform(2, 3), "turns": rng.uniform(1.3, 1.8)}


@screw_sweep.data
def left_handed(rng):
    return {"curve": bent(rng), "pitch": -rng.uniform(4, 6), "turns": rng.uniform(0.5, 0.8)}


@screw_sweep.data
def screwed_back(rng):
    return {"curve": bent(rng), "pitch": rng.uniform(4, 6), "turns": -rng.uniform(0.5, 0.8)}


@screw_sweep.data(blind=True)
def lathe(rng):
    """It turns and does not move on."""
    return {"curve": bent(rng), "pitch": 0.0, "turns": 1.0}


@screw_sweep.mistake("negative_sense", credit=0.5)
def _(u, w, curve, pitch, turns):
    """You turn the other way round: your screw is left-handed. Point the thumb of your right hand along x; the fingers show the
    positive sense, from y to z. Half a turn looks the same both ways, so the printed point does not show it. Look at w =
    1/4."""
    return _screwed(u, w, curve, -TURN * turns, pitch * turns)


@screw_sweep.mistake("pitch_per_radian", credit=0.5)
def _(u, w, curve, pitch, turns):
    """You turn as you should, and move on more than six times too far: you multiplied the pitch by the angle in radians. The
    pitch is the way in a whole *turn*. How many turns have been made at w?"""
    return _screwed(u, w, curve, TURN * turns, pitch * TURN * turns)


@screw_sweep.mistake("no_advance", credit=0.25)
def _(u, w, curve, pitch, turns):
    """Your curve turns as it should and stays where it is: a surface of revolution, and the pitch never enters. What is
    different about a screw after one whole turn?"""
    return _screwed(u, w, curve, TURN * turns, 0.0)


@screw_sweep.mistake("pitch_in_all", credit=0.5)
def _(u, w, curve, pitch, turns):
    """You took the pitch for the way from w = 0 to w = 1. It is the way in *one* turn; with one turn in all nobody notices. How
    far should the curve have come after two turns?"""
    return _screwed(u, w, curve, TURN * turns, pitch)


@screw_sweep.mistake("always_one_turn", credit=0.5)
def _(u, w, curve, pitch, turns):
    """The way along x is right, but you make one turn, whatever turns says. In the printed example it is one. By which angle
    should the curve have turned at w = 1?"""
    return _screwed(u, w, curve, TURN, pitch * turns)


@screw_sweep.mistake("no_2pi", credit=0.5)
def _(u, w, curve, pitch, turns):
    """You move on as you should, but took the number of turns itself for the angle, and one radian is less than a sixth of a
    turn. What is a whole turn in radians?"""
    return _screwed(u, w, curve, turns, pitch * turns)


@screw_sweep.mistake("about_z", credit=0.25)
def _(u, w, curve, pitch, turns):
    """A good screw, about the wrong axis: yours turns about z and climbs along z. Here it is x that stands still in the turn,
    and x that grows. Which two coordinates should be mixed by sine and cosine?"""
    x, y, z = np.moveaxis(curve(np.asarray(u, dtype=float)), -1, 0)
    c, s = np.cos(TURN * turns * np.asarray(w)), np.sin(TURN * turns * np.asarray(w))
    return points(c * x - s * y, s * x + c * y, z + pitch * turns * np.asarray(w))


@screw_sweep.mistake("swap_uw", credit=0.5)
def _(u, w, curve, pitch, turns):
    """The right surface with the two parameters exchanged: your w runs along the curve, and your u turns it. The curve is the
    generatrix; which parameter runs along it?"""
    return _screwed(w, u, curve, TURN * turns, pitch * turns)


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


def _arcs(profile, h):
    """One piece along u, the four quarter turns along w."""
    return (0.0, 1.0), np.linspace(0.0, 1.0, 5)


@exercise(
    points=6,
    title="Exact surface of revolution",
    kind="net",
    judged_as=evaluated,
    spans=_arcs,
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


@nurbs_revolve.data
def ring(rng):
    """A whole circle of radius r as a rational quintic, R away from the axis: the torus."""
    R, r = rng.uniform(3, 4), rng.uniform(0.6, 0.7)
    circle = np.array([[0, -1], [4, -1], [2, 3], [-2, 3], [-4, -1], [0, -1]])
    return {"profile": [R, 0] + r * circle, "h": [5.0, 1.0, 1.0, 1.0, 1.0, 5.0]}


@nurbs_revolve.data
def any_vase(rng):
    profile = np.array([[2, 0], [4, 1], [1.5, 3], [3, 4]]) + rng.uniform(-0.4, 0.4, (4, 2))
    return {"profile": profile, "h": rng.permutation([0.6, 1.2, 1.8, 2.4]) * rng.uniform(0.9, 1.1, 4)}


@nurbs_revolve.data(blind=True)
def bucket(rng):
    """A straight line with both weights 1."""
    return {"profile": [[2.0, 0.0], [3.0, 4.0]], "h": [1.0, 1.0]}


@nurbs_revolve.mistake("weights_added", credit=0.5)
def _(profile, h):
    """Points and knots are right; the weight of a point is the sum of the profile's weight and the circle's. Each row should be
    a whole circle, whatever its h: multiply all weights of one circle by a number, and it stays. Does it, when you *add*
    one?"""
    return _revolved(profile, h, np.add.outer(h, ARC))


@nurbs_revolve.mistake("weights_replaced", credit=0.5)
def _(profile, h):
    """Points and knots are right, and each row is a true circle; but the weights of the profile are gone, so that your profile
    is another curve. With all of them 1 nobody notices. How can a point carry both weights?"""
    return _revolved(profile, h, np.outer(np.ones(len(h)), ARC))


@nurbs_revolve.mistake("circle_weights_forgotten", credit=0.5)
def _(profile, h):
    """Points and knots are right, and so is the profile; but all nine points of a row have one weight, and so your rows are
    four parabolas, up to six per cent outside of the circle. What is the weight of a corner of the square?"""
    return _revolved(profile, h, np.outer(h, np.ones(9)))


@nurbs_revolve.mistake("plain_knots", credit=0.5)
def _(profile, h):
    """Your points and weights are right, the knots are not: with simple inner knots nine points make seven arcs that flow into
    each other, and not one of them is round. Each quarter should end on its control point. How often must a knot stand
    there?"""
    return _revolved(profile, h, knots=np.array([0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 7, 7]))


@nurbs_revolve.mistake("corners_on_circle", credit=0.5)
def _(profile, h):
    """Weights and knots are right, but you put all nine points *on* the circle. Between two quarter points the control point
    stands where their tangents meet, outside. Draw the square about the circle."""
    return _revolved(profile, h, square=SQUARE / np.linalg.norm(SQUARE, axis=1, keepdims=True))


@nurbs_revolve.mistake("weight_half", credit=0.75)
def _(profile, h):
    """Nearly: your corners have the weight 1/2, the cosine of 60 degrees, right for a triangle of three arcs. Here each arc
    spans a quarter of a turn: whose cosine is it? Measure the distance from the axis in the middle of an arc."""
    return _revolved(profile, h, np.outer(h, [1, 0.5, 1, 0.5, 1, 0.5, 1, 0.5, 1]))


@nurbs_revolve.mistake("points_multiplied", credit=0.75)
def _(profile, h):
    """You gave the points already multiplied by their weights, as several libraries store them. Here they are plain Cartesian
    points. Look at the z along one of your rows: all nine should have the same."""
    P, weights, knots = _revolved(profile, h)
    return P * weights[..., None], weights, knots


@nurbs_revolve.mistake("clockwise", credit=0.5)
def _(profile, h):
    """The right surface, run round the other way: your columns go from x to -y. Seen against the axis, with z towards you, the
    positive sense is anticlockwise. Where is your third column?"""
    return _revolved(profile, h, square=SQUARE * [1, -1])


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


def placed(rng, p, d):
    """A line given by p and d in the frame of the axis (its third direction), carried into general position."""
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    point = rng.uniform(1, 3, 3) * rng.choice([-1.0, 1.0], 3)
    d, p = np.array(d, dtype=float), np.array(p, dtype=float) + rng.uniform(0.5, 1.5) * np.array(d, dtype=float)
    return {
        "p": p @ turn + point, "d": rng.uniform(0.3, 3.0) * d @ turn,
        "point": point + rng.uniform(1, 2) * turn[2], "axis": rng.uniform(0.3, 3.0) * turn[2],
    }  # fmt: skip


def way(rng):
    """A length between 1 and 2."""
    return rng.uniform(1, 2)


@revolved_line_kind.data(blind=True)
def parallel(rng):
    return placed(rng, [way(rng), way(rng), 0], [0, 0, 1])


@revolved_line_kind.data(blind=True)
def lecture(rng):
    return {"p": [3.0, 0.0, 0.0], "d": [-2.0, 4.0, 0.0], "point": [0.0, 0.0, 0.0], "axis": [0.0, 1.0, 0.0]}


@revolved_line_kind.data
def against_the_axis(rng):
    return placed(rng, [way(rng), way(rng), 0], [0, 0, -1])


@revolved_line_kind.data
def in_the_axis(rng):
    return placed(rng, [0, 0, way(rng)], [0, 0, 1])


@revolved_line_kind.data
def through_the_axis(rng):
    return placed(rng, [0, 0, way(rng)], [way(rng), way(rng), way(rng)])


@revolved_line_kind.data
def across_the_axis(rng):
    return placed(rng, [0, 0, way(rng)], [way(rng), way(rng), 0])


@revolved_line_kind.data
def across_and_beside(rng):
    return placed(rng, [way(rng), 0, way(rng)], [0, 1, 0])


@revolved_line_kind.data
def aslant_and_beside(rng):
    return placed(rng, [way(rng), 0, way(rng)], [0, way(rng), way(rng)])


@revolved_line_kind.data
def nearly_parallel(rng):
    """Parallel to twelve digits."""
    return placed(rng, [way(rng), way(rng), 0], [1e-12, 0, 1])


@revolved_line_kind.data
def no_direction(rng):
    return {**placed(rng, [1, 1, 0], [0, 0, 1]), "d": [0.0, 0.0, 0.0]}


@revolved_line_kind.data
def no_axis(rng):
    return {**placed(rng, [1, 1, 0], [0, 0, 1]), "axis": [0.0, 0.0, 0.0]}


@revolved_line_kind.mistake("skew_is_cone", credit=0.5)
def _(p, d, point, axis):
    """Whatever is neither parallel nor at right angles is a cone for you. A cone has an apex: the line has to meet the axis.
    Take two sticks that pass each other aslant, and turn one: what happens where they are closest?"""
    kind = _kind(p, d, point, axis)
    return "cone" if kind == "hyperboloid" else kind


@revolved_line_kind.mistake("right_angle_is_cone", credit=0.5)
def _(p, d, point, axis):
    """For you a line that meets the axis makes a cone, always. Open a cone wider and wider, as an umbrella: what is it in the
    end, when the line stands at right angles to the axis?"""
    kind = _kind(p, d, point, axis)
    meets = abs(np.subtract(p, point) @ np.cross(d, axis)) <= 1e-9 * np.linalg.norm(d) * np.linalg.norm(axis)
    return "cone" if kind == "plane" and meets else kind


@revolved_line_kind.mistake("beside_is_hyperboloid", credit=0.5)
def _(p, d, point, axis):
    """Whatever passes the axis without meeting it is a hyperboloid for you. It has a waist, and it rises on both sides. Does
    your line rise, when it stands at right angles to the axis?"""
    kind = _kind(p, d, point, axis)
    meets = abs(np.subtract(p, point) @ np.cross(d, axis)) <= 1e-9 * np.linalg.norm(d) * np.linalg.norm(axis)
    return "hyperboloid" if kind == "plane" and not meets else kind


@revolved_line_kind.mistake("in_itself_is_cylinder", credit=0.75)
def _(p, d, point, axis):
    """Nearly: every line that is parallel to the axis makes a cylinder for you. How far from the axis is it, and what becomes
    of the cylinder when that distance is 0?"""
    kind = _kind(p, d, point, axis)
    return "cylinder" if kind == "line" else kind


@revolved_line_kind.mistake("one_sense_only", credit=0.75)
def _(p, d, point, axis):
    """Nearly: you take two directions for parallel only when they point the same way. A line has no sense: d and -d are the
    same line. What do you say to a line that runs against the axis?"""
    kind = _kind(p, d, point, axis)
    return "cone" if kind in ("cylinder", "line") and np.dot(d, axis) < 0 else kind


@revolved_line_kind.mistake("axis_through_origin", credit=0.5)
def _(p, d, point, axis):
    """The directions are judged as they should be; but you take the axis to pass through the origin, and point never enters.
    Whether two lines meet depends on both places. From where should the vector to p start?"""
    return _kind(p, d, np.zeros(3), axis)


@revolved_line_kind.mistake("no_tolerance", credit=0.5)
def _(p, d, point, axis):
    """You compare with exactly 0. Cosines, cross products and distances come out rounded, at 1e-16 instead of 0, and then
    nothing is parallel and nothing meets. What is small, compared with the lengths that are given?"""
    return _kind(p, d, point, axis, 0.0)


@revolved_line_kind.mistake("angle_only", credit=0.25)
def _(p, d, point, axis):
    """You looked at the angle between line and axis, and at nothing else: parallel, at right angles, or aslant. Two lines at
    the same angle may meet, or pass each other. Which of the data say where the line *is*?"""
    d, k = _unit(d, axis)
    if np.linalg.norm(np.cross(d, k)) <= 1e-9:
        return "cylinder"
    return "plane" if abs(d @ k) <= 1e-9 else "cone"
