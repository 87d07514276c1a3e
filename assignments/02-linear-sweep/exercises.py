"""A2, linear sweep: a curve carried along a straight line, and what two lines make: the plane and the triangle.

One file, and a long one: each exercise stands here whole, its reference, its data and its mistakes one below the other.
`arc` is the curve of the lecture data. Oracle numbers: tests/assignments.
"""

import directrix as dx
import numpy as np

from autograder.exercise import exercise


def arc(t):
    """The curve (2 cos πt, 1 + t², 3t(1 - t))."""
    return np.stack([2 * np.cos(np.pi * t), 1 + t**2, 3 * t * (1 - t)], axis=-1)


def closed(t):
    """A closed curve that lies in no plane; it never comes near the origin."""
    return np.stack([4 + np.cos(2 * np.pi * t), 3 + 2 * np.sin(2 * np.pi * t), 1 + 0.5 * np.cos(4 * np.pi * t)], axis=-1)


def bent(rng):
    """A random cubic that lies in no plane and whose ends differ in every coordinate."""
    return dx.BezierCurve(np.array([[1, 0, 1], [3, 1, 0], [4, 4, 3], [2, 5, 2]]) + rng.uniform(-0.4, 0.4, (4, 3)))


def any_vector(rng, shortest=1.5, longest=4.0):
    """A random vector, each component well away from 0."""
    return rng.uniform(shortest, longest, 3) * rng.choice([-1.0, 1.0], 3)


# A2.1 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=4, title="Direction cosines and distance", kind="value", tolerance=1e-12, accept={"close": 0.8})
def direction_cosines(a, b):
    """Return the array (l, m, n, d): the unit direction (l, m, n) from the point a to the point b, and their distance d.

    a, b : points, arrays of shape (3,)

    Returns an array of shape (4,); l, m, n are pure numbers, d is in the unit of the points.
    Raises ValueError where a and b are the same point: they have no direction.
    """
    step, d = _step(a, b)
    return np.array([*step / d, d])


def _step(a, b):
    step = np.asarray(b, dtype=float) - np.asarray(a, dtype=float)
    d = np.linalg.norm(step)
    if d == 0:
        raise ValueError(f"a and b must differ, or there is no direction; both are {a}")
    return step, d


@direction_cosines.data
def lecture(rng):
    return {"a": [1.0, -2.0, 3.0], "b": [4.0, 2.0, 15.0]}


@direction_cosines.data
def any_two_points(rng):
    a = any_vector(rng)
    return {"a": a, "b": a + any_vector(rng)}


@direction_cosines.data
def close_together(rng):
    a = any_vector(rng)
    return {"a": a, "b": a + any_vector(rng, 0.05, 0.3)}


@direction_cosines.data
def same_point(rng):
    a = any_vector(rng)
    return {"a": a, "b": a.copy()}


@direction_cosines.data(blind=True)
def one_along_x(rng):
    return {"a": [0.0, 0.0, 0.0], "b": [1.0, 0.0, 0.0]}


@direction_cosines.mistake("not_normalised", credit=0.25)
def _(a, b):
    """You gave the components of the vector from a to b. Direction *cosines* are cosines: none of them can be above 1, and
    their squares add up to 1. Do yours?"""
    step, d = _step(a, b)
    return np.array([*step, d])


@direction_cosines.mistake("reversed", credit=0.5)
def _(a, b):
    """Your direction points from b to a. Start at a and walk the distance d along your (l, m, n): do you arrive at b?"""
    step, d = _step(a, b)
    return np.array([*-step / d, d])


@direction_cosines.mistake("angles", credit=0.25)
def _(a, b):
    """You gave the three angles with the axes. The sweep wants their *cosines*, and those you had in your hands just before
    the last step."""
    step, d = _step(a, b)
    return np.array([*np.arccos(step / d), d])


@direction_cosines.mistake("taxicab", credit=0.5)
def _(a, b):
    """For d you added up the steps along x, y and z, as a taxi drives round the blocks; the distance is the straight way. For
    the vector (1, 2, 2) it is 3, not 5."""
    step, d = _step(a, b)
    return np.array([*step / d, np.abs(step).sum()])


@direction_cosines.also("taxicab")  # and divided by it
def _(a, b):
    step, _ = _step(a, b)
    d = np.abs(step).sum()
    return np.array([*step / d, d])


@direction_cosines.mistake("squared", credit=0.5)
def _(a, b):
    """Your d is the *square* of the distance: if the points are given in millimetres, in which unit is yours? Between (0, 0, 0)
    and (1, 2, 2) the distance is 3."""
    step, d = _step(a, b)
    return np.array([*step / d, d**2])


@direction_cosines.also("squared")  # and divided by it
def _(a, b):
    step, _ = _step(a, b)
    return np.array([*step / (step @ step), step @ step])


@direction_cosines.mistake("distance_first", credit=0.75)
def _(a, b):
    """All four numbers are right, only their order is not: you put the distance first. Read the order in the statement again."""
    step, d = _step(a, b)
    return np.array([d, *step / d])


# A2.2 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="Linear sweep by direction and distance", kind="surface", personal=True)
def linear_sweep(u, w, curve, direction, d):
    """Return the points of the surface that the curve sweeps when it moves the distance d along the direction.

    u is the curve's own parameter; w is the sweep: at w = 0 the curve is in its own place, at w = 1 it has moved by d.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    curve : a function; curve(t) gives the points of the generatrix for t in [0, 1], an array of shape t.shape + (3,)
    direction : vector, an array of shape (3,), of any length but 0; only where it points matters
    d : how far, a length; below 0 the curve moves against the direction

    Returns the points, shape of u and w together + (3,).
    Raises ValueError where the direction is (0, 0, 0).
    """
    return dx.LinearSweep(curve, direction, d)(u, w)


def _unit(direction):
    length = np.linalg.norm(direction)
    if length == 0:
        raise ValueError("the direction must not be (0, 0, 0)")
    return np.asarray(direction, dtype=float) / length


def _times(parameter, vector):
    """parameter * vector, with the three coordinates on a new last axis."""
    return np.multiply.outer(parameter, np.asarray(vector, dtype=float))


@linear_sweep.data
def lecture(rng):
    return {"curve": arc, "direction": [1.0, 2.0, 2.0], "d": 6.0}


@linear_sweep.data
def yours(rng):
    """your own arrow"""
    # The notebook draws the same numbers in the same order, and shows them.
    return {"curve": arc, "direction": rng.integers(1, 6, 3).astype(float), "d": float(rng.integers(2, 7))}


@linear_sweep.data
def any_curve(rng):
    return {"curve": bent(rng), "direction": any_vector(rng), "d": rng.uniform(1.5, 4.0)}


@linear_sweep.data
def against_the_direction(rng):
    return {"curve": bent(rng), "direction": any_vector(rng, 0.2, 0.5), "d": -rng.uniform(1.5, 4.0)}


@linear_sweep.data
def closed_curve(rng):
    return {"curve": closed, "direction": any_vector(rng), "d": rng.uniform(1.5, 4.0)}


@linear_sweep.data
def no_direction(rng):
    return {"curve": arc, "direction": [0.0, 0.0, 0.0], "d": 2.0}


@linear_sweep.data(blind=True)
def one_up(rng):
    return {"curve": arc, "direction": [0.0, 0.0, 1.0], "d": 1.0}


@linear_sweep.mistake("not_normalised", credit=0.5)
def _(u, w, curve, direction, d):
    """Your sweep points the right way and goes the wrong distance: you used the direction as it is, with its length. Make the
    direction twice as long and your surface gets twice as tall; the statement says that only d decides."""
    _unit(direction)
    return curve(u) + _times(d * w, direction)


@linear_sweep.mistake("no_distance", credit=0.5)
def _(u, w, curve, direction, d):
    """Your curve always moves by 1, whatever d is. Measure from S(u, 0) to S(u, 1): it should be the distance asked for."""
    return curve(u) + _times(w, _unit(direction))


@linear_sweep.mistake("backwards", credit=0.5)
def _(u, w, curve, direction, d):
    """The right sweep in the opposite direction: yours leaves the curve backwards. Check a sign. Where is your curve at w = 1,
    seen from where it started?"""
    return curve(u) - _times(d * w, _unit(direction))


@linear_sweep.mistake("swap_uw", credit=0.5)
def _(u, w, curve, direction, d):
    """The right surface with the two parameters exchanged: your w runs along the curve and your u is the sweep. Hold w at 0 and
    let u run: the statement wants the curve there."""
    return curve(w) + _times(d * u, _unit(direction))


@linear_sweep.mistake("multiplied", credit=0.0)
def _(u, w, curve, direction, d):
    """You multiply the points of the curve by the sweep, so they are stretched away from the origin. A sweep *carries* each point
    along: what do you do with a position and a displacement?"""
    return curve(u) * (1 + _times(d * w, _unit(direction)))


# A2.3 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Linear sweep by two points", kind="surface")
def linear_sweep_points(u, w, curve, a, b):
    """Return the points of the surface that the curve sweeps when it moves by the vector from the point a to the point b.

    The two points only tell how far and which way; they need not lie anywhere near the curve.
    u is the curve's own parameter; at w = 0 the curve is in its own place, at w = 1 it has moved from a to b.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    curve : a function; curve(t) gives the points of the generatrix for t in [0, 1], an array of shape t.shape + (3,)
    a, b : points, arrays of shape (3,)

    Returns the points, shape of u and w together + (3,).
    """
    return dx.LinearSweep.between(curve, a, b)(u, w)


@linear_sweep_points.data
def lecture(rng):
    return {"curve": arc, "a": [1.0, -2.0, 3.0], "b": [2.0, 0.0, 7.0]}


@linear_sweep_points.data
def any_two_points(rng):
    a = any_vector(rng)
    return {"curve": bent(rng), "a": a, "b": a + any_vector(rng)}


@linear_sweep_points.data
def points_far_away(rng):
    a = any_vector(rng, 15.0, 25.0)
    return {"curve": closed, "a": a, "b": a + any_vector(rng, 1.0, 2.0)}


@linear_sweep_points.data(blind=True)
def from_the_origin(rng):
    return {"curve": arc, "a": [0.0, 0.0, 0.0], "b": [0.0, 0.0, 1.0]}


@linear_sweep_points.mistake("starts_at_a", credit=0.5)
def _(u, w, curve, a, b):
    """The right surface in the wrong place: you pinned the vector to its starting point, and a was added to every point. Look
    at w = 0, where the curve has not moved yet: is it the curve?"""
    return curve(u) + a + _times(w, np.subtract(b, a))


@linear_sweep_points.mistake("end_point_only", credit=0.25)
def _(u, w, curve, a, b):
    """You used the point b as the vector. A point says where, a vector says how far: with a in the origin the two agree, and
    only there. Which vector takes you from a to b?"""
    return curve(u) + _times(w, b)


@linear_sweep_points.mistake("reversed", credit=0.5)
def _(u, w, curve, a, b):
    """The right sweep in the opposite direction: yours goes from b to a. End minus start, or start minus end?"""
    return curve(u) + _times(w, np.subtract(a, b))


@linear_sweep_points.mistake("unit_length", credit=0.25)
def _(u, w, curve, a, b):
    """You go the right way, but only by 1: the length of the vector was thrown away. Here nobody gives you a distance d; it is
    already in the two points."""
    step = np.subtract(b, a)
    return curve(u) + _times(w, step / np.linalg.norm(step))


@linear_sweep_points.mistake("swap_uw", credit=0.5)
def _(u, w, curve, a, b):
    """The right surface with the two parameters exchanged: your w runs along the curve and your u is the sweep. Hold w at 0 and
    let u run: the statement wants the curve there."""
    return curve(w) + _times(u, np.subtract(b, a))


# A2.4 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Plane through three points", kind="surface")
def plane3(u, w, p1, p2, p3):
    """Return the points of the plane patch with the corners S(0, 0) = p1, S(1, 0) = p2 and S(0, 1) = p3.

    It is the line from p1 to p2 swept by the vector from p1 to p3: a parallelogram, whose fourth corner follows by itself.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    p1, p2, p3 : points, arrays of shape (3,), not on one line

    Returns the points, shape of u and w together + (3,).
    """
    return dx.Plane(p1, p2, p3)(u, w)


@plane3.data
def lecture(rng):
    return {"p1": [1.0, 2.0, 0.0], "p2": [4.0, 1.0, 2.0], "p3": [0.0, 5.0, 3.0]}


@plane3.data
def any_three_points(rng):
    return dict(zip(("p1", "p2", "p3"), _corners(rng), strict=True))


@plane3.data
def far_from_the_origin(rng):
    return dict(zip(("p1", "p2", "p3"), any_vector(rng, 6.0, 9.0) + _corners(rng), strict=True))


@plane3.data(blind=True)
def unit_square(rng):
    return {"p1": [0.0, 0.0, 0.0], "p2": [1.0, 0.0, 0.0], "p3": [0.0, 1.0, 0.0]}


def _corners(rng):
    """Three points with unequal sides and no right angle."""
    return np.array([[2, 1, -1], [5, 2, 1], [1, 5, 2.5]]) + rng.uniform(-0.4, 0.4, (3, 3))


def _vectors(p1, p2, p3):
    return np.asarray(p1, dtype=float), np.asarray(p2, dtype=float), np.asarray(p3, dtype=float)


@plane3.mistake("p3_opposite", credit=0.25)
def _(u, w, p1, p2, p3):
    """Your second direction starts at p2, so p3 becomes the corner *opposite* p1. Evaluate your patch at u = 0, w = 1: which
    point should be there?"""
    p1, p2, p3 = _vectors(p1, p2, p3)
    return p1 + _times(u, p2 - p1) + _times(w, p3 - p2)


@plane3.mistake("swap_uw", credit=0.5)
def _(u, w, p1, p2, p3):
    """The right parallelogram with the two parameters exchanged: p2 and p3 have changed places. Evaluate your patch at u = 1,
    w = 0 and compare with the statement."""
    p1, p2, p3 = _vectors(p1, p2, p3)
    return p1 + _times(w, p2 - p1) + _times(u, p3 - p1)


@plane3.mistake("unit_directions", credit=0.25)
def _(u, w, p1, p2, p3):
    """You go in the right two directions, each by a length of 1, so your patch does not reach p2 and p3. Here the lengths are
    wanted: what must be added to p1 to arrive exactly at p2?"""
    p1, p2, p3 = _vectors(p1, p2, p3)
    e12, e13 = p2 - p1, p3 - p1
    return p1 + _times(u, e12 / np.linalg.norm(e12)) + _times(w, e13 / np.linalg.norm(e13))


@plane3.mistake("lerp_each", credit=0.5)
def _(u, w, p1, p2, p3):
    """The right parallelogram in the wrong place: you added two lines that both start at p1, so p1 counts twice. Evaluate your
    patch at u = w = 0."""
    p1, p2, p3 = _vectors(p1, p2, p3)
    u, w = np.asarray(u), np.asarray(w)
    return _times(1 - u, p1) + _times(u, p2) + _times(1 - w, p1) + _times(w, p3)


@plane3.mistake("bilinear_to_p3", credit=0.25)
def _(u, w, p1, p2, p3):
    """You have a triangle: all your lines run together in p3. It lies in the right plane, but a line that is *swept* keeps its
    length. Where should your patch be at u = w = 1? (Keep this formula: a later exercise asks for it.)"""
    p1, p2, p3 = _vectors(p1, p2, p3)
    u, w = np.asarray(u), np.asarray(w)
    return _times((1 - u) * (1 - w), p1) + _times(u * (1 - w), p2) + _times(w + 0 * u, p3)


@plane3.mistake("points_not_differences", credit=0.25)
def _(u, w, p1, p2, p3):
    """You go along p2 and p3 themselves, as seen from the origin. With p1 in the origin that is right, and only then. Evaluate
    your patch at u = 1, w = 0: you wanted to arrive at p2."""
    p1, p2, p3 = _vectors(p1, p2, p3)
    return p1 + _times(u, p2) + _times(w, p3)


# A2.5 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=4, title="Which half is the triangle?", kind="mask")
def triangle_mask(u, w):
    """Return True where the point plane3(u, w) of the last exercise lies in the triangle p1 p2 p3, its edges included.

    u, w : numbers or arrays in [0, 1] that broadcast against each other

    Returns booleans, shape of u and w together. Allow for rounding: a point within 1e-12 of an edge is on it.
    """
    return np.add(u, w) <= 1 + 1e-12


@triangle_mask.data
def whole_square(rng):
    return {}


@triangle_mask.mistake("other_half", credit=0.25)
def _(u, w):
    """You kept the other triangle, the one without p1. Which parameters does p1 have, and are they in your half?"""
    return np.add(u, w) >= 1 - 1e-12


@triangle_mask.mistake("open", credit=0.5)
def _(u, w):
    """The right half, but you lost an edge: the points between p2 and p3 belong to the triangle too. Even p2 itself is missing
    from yours."""
    return np.add(u, w) < 1 - 1e-12


@triangle_mask.mistake("product", credit=0.0)
def _(u, w):
    """Your condition holds on the whole square: a product of two numbers between 0 and 1 never exceeds 1. Which combination of
    u and w is constant along the edge from p2 to p3?"""
    return np.multiply(u, w) <= 1


@triangle_mask.mistake("half_each", credit=0.25)
def _(u, w):
    """You cut u and w separately, which keeps a small parallelogram at p1. The triangle's third edge runs aslant, from (1, 0)
    to (0, 1): its condition needs both parameters at once."""
    return np.logical_and(np.less_equal(u, 0.5), np.less_equal(w, 0.5))


@triangle_mask.mistake("other_diagonal", credit=0.25)
def _(u, w):
    """You cut the square in two along the wrong diagonal, the one through p1. Put in the parameters of p2 and of p3: both must
    be kept."""
    return np.less_equal(w, np.asarray(u) + 1e-12)


# A2.6 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="A patch whose whole square is the triangle", kind="surface", accept={"same set": 0.5})
def triangle_patch(u, w, p1, p2, p3):
    """Return the points of a patch that maps the whole unit square onto the triangle p1 p2 p3.

    The edge w = 0 runs from p1 (u = 0) to p2 (u = 1); the whole edge w = 1 is the single point p3.
    Between them the lines of constant u run straight from that edge to p3, w being the share of the way.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    p1, p2, p3 : points, arrays of shape (3,), not on one line

    Returns the points, shape of u and w together + (3,).
    """
    return dx.Triangle(p1, p2, p3)(u, w)


@triangle_patch.data
def lecture(rng):
    return {"p1": [1.0, 2.0, 0.0], "p2": [4.0, 1.0, 2.0], "p3": [0.0, 5.0, 3.0]}


@triangle_patch.data
def any_three_points(rng):
    return dict(zip(("p1", "p2", "p3"), _corners(rng), strict=True))


@triangle_patch.data
def far_from_the_origin(rng):
    return dict(zip(("p1", "p2", "p3"), any_vector(rng, 6.0, 9.0) + _corners(rng), strict=True))


@triangle_patch.data(blind=True)
def p1_in_the_origin(rng):
    return {"p1": [0.0, 0.0, 0.0], "p2": [2.0, 0.0, 0.0], "p3": [0.5, 1.5, 0.0]}


@triangle_patch.mistake("parallelogram", credit=0.25)
def _(u, w, p1, p2, p3):
    """This is the whole parallelogram; barycentric weights 1 - u - w, u, w give it too, since over the whole square one of
    them goes below 0. The triangle needs an edge that shrinks: where is your edge w = 1?"""
    p1, p2, p3 = _vectors(p1, p2, p3)
    return p1 + _times(u, p2 - p1) + _times(w, p3 - p1)


@triangle_patch.mistake("normalised", credit=0.25)
def _(u, w, p1, p2, p3):
    """Weights 1, u and w divided by their sum stay inside the triangle, but they never reach p2 or p3: the weight of p1 never
    vanishes. Evaluate your patch at u = 1, w = 0."""
    p1, p2, p3 = _vectors(p1, p2, p3)
    total = 1 + np.add(u, w)
    return (p1 + _times(u, p2) + _times(w, p3)) / total[..., np.newaxis]


@triangle_patch.mistake("clamped", credit=0.25)
def _(u, w, p1, p2, p3):
    """The picture is the right triangle, but half of the square is squeezed onto its edge p2 p3: you stop w where it would
    leave the triangle. Along w = 1 all your points should be p3."""
    p1, p2, p3 = _vectors(p1, p2, p3)
    return p1 + _times(u, p2 - p1) + _times(np.minimum(w, 1 - np.asarray(u)), p3 - p1)


@triangle_patch.mistake("swap_uw", credit=0.5)
def _(u, w, p1, p2, p3):
    """The right triangle with the two parameters exchanged: your u leads to p3 and your w runs from p1 to p2. Which edge of the
    square should become a point?"""
    p1, p2, p3 = _vectors(p1, p2, p3)
    u, w = np.asarray(u), np.asarray(w)
    return _times((1 - w) * (1 - u), p1) + _times(w * (1 - u), p2) + _times(u + 0 * w, p3)


@triangle_patch.mistake("from_origin", credit=0.5)
def _(u, w, p1, p2, p3):
    """The right triangle in the wrong place: yours starts in the origin instead of p1. The vectors from p1 tell how far to go;
    from where?"""
    p1, p2, p3 = _vectors(p1, p2, p3)
    u, w = np.asarray(u), np.asarray(w)
    return _times(u * (1 - w), p2 - p1) + _times(w + 0 * u, p3 - p1)


@triangle_patch.mistake("tip_at_p1", credit=0.5)
def _(u, w, p1, p2, p3):
    """The right triangle, every point of it, but your lines of constant u run together in p1 and end on the edge from p2 to p3.
    Which corner does the statement make of the edge w = 1, and what becomes of w = 0?"""
    p1, p2, p3 = _vectors(p1, p2, p3)
    u, w = np.asarray(u), np.asarray(w)
    return p1 + _times((1 - u) * w, p2 - p1) + _times(u * w, p3 - p1)
