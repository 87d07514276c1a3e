"""A3, circular sweep: a curve turned about an axis; sense of rotation; transform, sweep, reverse transform.

One file, and a long one: each exercise stands here whole, its reference, its data and its mistakes one below the other.
`prof` (a flat profile) and `spc` (a space curve) are the curves of the lecture data. Oracle numbers: tests/assignments.
"""

import directrix as dx
import numpy as np

from autograder.exercise import exercise

TURN = 2 * np.pi


def prof(t):
    """The flat profile (2 + sin 2t, 3t - 0.5, 0), in the xy-plane."""
    return np.stack([2 + np.sin(2 * t), 3 * t - 0.5, 0 * t], axis=-1)


def spc(t):
    """The space curve (2 + t, 3t - 0.5, 0.7 - t²)."""
    return np.stack([2 + t, 3 * t - 0.5, 0.7 - t**2], axis=-1)


def bent(rng):
    """A random cubic that lies in no plane, starts away from all three axes and meets none of them."""
    return dx.BezierCurve(np.array([[1.5, 1, 1], [3, 2, 1.5], [3, 3.5, 3], [2, 4, 1.5]]) + rng.uniform(-0.3, 0.3, (4, 3)))


def part_of_a_turn(rng):
    """An angle between 100 and 200 degrees: not a whole turn, and far from one radian."""
    return rng.uniform(np.deg2rad(100), np.deg2rad(200))


def any_vector(rng, shortest=1.5, longest=4.0):
    """A random vector, each component well away from 0."""
    return rng.uniform(shortest, longest, 3) * rng.choice([-1.0, 1.0], 3)


def points(x, y, z):
    """Coordinates that broadcast against each other, as points of shape (..., 3)."""
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


def coordinates(curve, t):
    """x, y and z of the points curve(t)."""
    return np.moveaxis(curve(np.asarray(t, dtype=float)), -1, 0)


# The three rotations of column vectors, right-hand sense, written out as the lecture does.


def about_x(x, y, z, t):
    """Rx(t) (x, y, z)."""
    return x, y * np.cos(t) - z * np.sin(t), y * np.sin(t) + z * np.cos(t)


def about_y(x, y, z, t):
    """Ry(t) (x, y, z)."""
    return x * np.cos(t) + z * np.sin(t), y, -x * np.sin(t) + z * np.cos(t)


def about_z(x, y, z, t):
    """Rz(t) (x, y, z)."""
    return x * np.cos(t) - y * np.sin(t), x * np.sin(t) + y * np.cos(t), z


ABOUT = {"x": about_x, "y": about_y, "z": about_z}


# A3.1 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="Circular sweep about y", kind="surface")
def revolve_y(u, w, curve, angle=2 * np.pi):
    """Return the points of the surface that the curve sweeps when it turns about the y axis by the given angle.

    u is the curve's own parameter; at w = 0 the curve is in its own place, at w = 1 it has turned by the whole angle.
    The sense is the right-hand rule: seen from a point high on +y, anticlockwise; +z goes to +x, and +x goes to -z.
    The curve need not lie in the xy-plane.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    curve : a function; curve(t) gives the points of the generatrix for t in [0, 1], an array of shape t.shape + (3,)
    angle : how far to turn, in radians; a whole turn if nothing is said

    Returns the points, shape of u and w together + (3,).
    """
    return dx.CircularSweep(curve, "y", angle)(u, w)


@revolve_y.data
def space_curve(rng):
    return {"curve": spc}


@revolve_y.data
def sixty_degrees(rng):
    return {"curve": spc, "angle": np.pi / 3}


@revolve_y.data
def any_curve_and_angle(rng):
    return {"curve": bent(rng), "angle": part_of_a_turn(rng)}


@revolve_y.data
def from_the_axis(rng):
    return {
        "curve": dx.Line([0.0, rng.uniform(-1.0, 0.0), 0.0], [2.0, 1.0, rng.uniform(1.0, 2.0)]),
        "angle": -part_of_a_turn(rng),
    }


@revolve_y.data(blind=True)
def lathe(rng):
    return {"curve": prof}


@revolve_y.mistake("negative_sense", credit=0.5)
def _(u, w, curve, angle):
    """Your curve turns the other way: the board's form with + x sin has the left-hand sense about y. For a whole turn only the
    direction of w differs; for part of a turn it is another wedge. Right thumb along +y: does +x go to +z or to -z?"""
    return points(*about_y(*coordinates(curve, u), -angle * w))


@revolve_y.mistake("about_x", credit=0.25)
def _(u, w, curve, angle):
    """You turned about the x axis. While a curve turns, the coordinate along the axis never changes: which of your three is the
    one without sine and cosine?"""
    return points(*about_x(*coordinates(curve, u), angle * w))


@revolve_y.mistake("about_z", credit=0.25)
def _(u, w, curve, angle):
    """You turned about the z axis, the usual one of the textbooks. While a curve turns, the coordinate along the axis never
    changes: which of your three is the one without sine and cosine?"""
    return points(*about_z(*coordinates(curve, u), angle * w))


@revolve_y.mistake("degrees", credit=0.5)
def _(u, w, curve, angle):
    """You converted the angle to degrees. It is given in radians, and NumPy's sine and cosine take radians: your curve goes
    round 57 times too far."""
    return points(*about_y(*coordinates(curve, u), np.rad2deg(angle) * w))


@revolve_y.mistake("angle_is_w", credit=0.25)
def _(u, w, curve, angle):
    """You took w itself for the angle, so your curve always turns by one radian. At w = 1 it should have turned by the whole of
    angle."""
    return points(*about_y(*coordinates(curve, u), w))


@revolve_y.mistake("swap_uw", credit=0.5)
def _(u, w, curve, angle):
    """The right surface with the two parameters exchanged: your w runs along the curve and your u turns it. Hold w at 0 and let
    u run: the statement wants the curve there, in its own place."""
    return points(*about_y(*coordinates(curve, w), angle * u))


@revolve_y.mistake("starts_in_yz", credit=0.5)
def _(u, w, curve, angle):
    """Sine and cosine are exchanged, so your surface begins a quarter turn away from the curve. At w = 0 the angle is 0: what
    must be left of your formula there?"""
    return points(*about_y(*coordinates(curve, u), angle * w - np.pi / 2))


@revolve_y.also("starts_in_yz")  # the two words exchanged, and no sign: it turns the other way from there
def _(u, w, curve, angle):
    return points(*about_y(*coordinates(curve, u), np.pi / 2 - angle * w))


@revolve_y.mistake("flat_profile_only", credit=0.5)
def _(u, w, curve, angle):
    """Right for a flat profile in the xy-plane, as on the board; but this curve leaves that plane, and you dropped its z. A point
    (0, 0, 1) turns about y as well: where does it go?"""
    x, y, _ = coordinates(curve, u)
    return points(x * np.cos(angle * w), y, -x * np.sin(angle * w))


@revolve_y.mistake("always_full_turn", credit=0.5)
def _(u, w, curve, angle):
    """Yours always makes the whole turn: angle never enters. With 60 degrees asked for, where should the edge w = 1 be?"""
    return points(*about_y(*coordinates(curve, u), TURN * w))


# A3.2 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="Circular sweep about x, y or z", kind="surface")
def revolve_coord(u, w, curve, axis, angle=2 * np.pi):
    """Return the points of the surface that the curve sweeps when it turns about a coordinate axis, by the right-hand rule.

    Seen with the axis pointing at you the curve turns anticlockwise: about x from +y to +z, about y from +z to +x, about z
    from +x to +y. u is the curve's own parameter; at w = 0 the curve is in its own place, at w = 1 it has turned by angle.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    curve : a function; curve(t) gives the points of the generatrix for t in [0, 1], an array of shape t.shape + (3,)
    axis : 'x', 'y' or 'z'
    angle : how far to turn, in radians; a whole turn if nothing is said

    Returns the points, shape of u and w together + (3,).
    """
    return dx.CircularSweep(curve, axis, angle)(u, w)


@revolve_coord.data
def about_the_x_axis(rng):
    return {"curve": spc, "axis": "x"}


@revolve_coord.data
def about_the_y_axis(rng):
    return {"curve": spc, "axis": "y"}


@revolve_coord.data
def about_the_z_axis(rng):
    return {"curve": spc, "axis": "z"}


@revolve_coord.data
def sixty_degrees(rng):
    return {"curve": bent(rng), "axis": "y", "angle": np.pi / 3}


@revolve_coord.data
def any_curve_and_angle(rng):
    return {"curve": bent(rng), "axis": rng.choice(["x", "z"]).item(), "angle": part_of_a_turn(rng)}


@revolve_coord.data(blind=True)
def lathe(rng):
    return {"curve": prof, "axis": "x"}


@revolve_coord.mistake("y_sign_like_x_z", credit=0.5)
def _(u, w, curve, axis, angle):
    """About x and about z yours is right; about y it turns the wrong way. You carried the pattern of signs of x and z over to y,
    and there the two coordinates come in the order z, x. Take the point (0, 0, 1) a quarter turn about y: it must come to +x."""
    sense = -1 if axis == "y" else 1
    return points(*ABOUT[axis](*coordinates(curve, u), sense * angle * w))


@revolve_coord.also("y_sign_like_x_z")  # in one place only: the sine that carries z to x
def _(u, w, curve, axis, angle):
    x, y, z = coordinates(curve, u)
    c, s = np.cos(angle * w), np.sin(angle * w)
    return points(x * c - z * s, y, z * c - x * s) if axis == "y" else points(*ABOUT[axis](x, y, z, angle * w))


@revolve_coord.mistake("all_negative", credit=0.5)
def _(u, w, curve, axis, angle):
    """About every axis yours turns by the left hand. Books that write points as rows have the signs of the sines the other way
    round from those that write columns. Test it: about z, a quarter turn takes +x to +y."""
    return points(*ABOUT[axis](*coordinates(curve, u), -angle * w))


@revolve_coord.mistake("flat_profile", credit=0.25)
def _(u, w, curve, axis, angle):
    """Right for a flat profile, and blind to the coordinate out of its plane: you dropped it. A turn about an axis mixes *two*
    coordinates, and each of them goes into both results."""
    x, y, z = coordinates(curve, u)
    c, s = np.cos(angle * w), np.sin(angle * w)
    return points(*{"x": (x, y * c, y * s), "y": (x * c, y, -x * s), "z": (x * c, x * s, z)}[axis])


@revolve_coord.mistake("degrees", credit=0.5)
def _(u, w, curve, axis, angle):
    """You converted the angle to degrees. It is given in radians, and NumPy's sine and cosine take radians: your curve goes
    round 57 times too far."""
    return points(*ABOUT[axis](*coordinates(curve, u), np.rad2deg(angle) * w))


@revolve_coord.mistake("swap_uw", credit=0.5)
def _(u, w, curve, axis, angle):
    """The right surface with the two parameters exchanged: your w runs along the curve and your u turns it. Hold w at 0 and let
    u run: the statement wants the curve there, in its own place."""
    return points(*ABOUT[axis](*coordinates(curve, w), angle * u))


# The lecture's example ---------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Sweep a line into a cone", kind="surface")
def cone_from_line(u, w, a, b):
    """Return the points of the surface that the straight line from a to b sweeps when it turns once about the y axis.

    The line lies in the xy-plane. u runs along it, from a (u = 0) to b (u = 1); w turns it once round the y axis by the
    right-hand rule: thumb along +y, the fingers show the way, from +z to +x and from +x to -z.
    Where an end lies on the axis, the cone is complete and that whole edge is its apex.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    a, b : points, arrays of shape (3,) with z = 0, not the same point

    Returns the points, shape of u and w together + (3,).
    """
    return dx.CircularSweep(dx.Line(a, b), "y")(u, w)


@cone_from_line.built_from(revolve_y)
def _(u, w, a, b, revolve_y):
    a, b = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
    return revolve_y(u, w, lambda t: a + np.asarray(t)[..., None] * (b - a), 2 * np.pi)


def _on_line(u, a, b):
    """x and y of the point that divides the line from a to b at u."""
    return a[0] + (b[0] - a[0]) * np.asarray(u), a[1] + (b[1] - a[1]) * np.asarray(u)


@cone_from_line.data
def truncated(rng):
    return {"a": [3.0, 0.0, 0.0], "b": [1.0, 4.0, 0.0]}


@cone_from_line.data
def any_line(rng):
    return {"a": [rng.uniform(1.0, 2.0), rng.uniform(0.5, 1.5), 0.0], "b": [rng.uniform(3.0, 4.0), rng.uniform(3.0, 5.0), 0.0]}


@cone_from_line.data
def complete(rng):
    return {"a": [rng.uniform(1.5, 3.0), -rng.uniform(1.0, 2.0), 0.0], "b": [0.0, rng.uniform(1.0, 3.0), 0.0]}


@cone_from_line.data
def through_the_axis(rng):
    return {
        "a": [-rng.uniform(1.0, 2.0), -rng.uniform(1.0, 2.0), 0.0],
        "b": [rng.uniform(2.5, 3.5), rng.uniform(1.0, 3.0), 0.0],
    }


@cone_from_line.data(blind=True)
def apex_in_the_origin(rng):
    return {"a": [0.0, 0.0, 0.0], "b": [2.0, 3.0, 0.0]}


@cone_from_line.mistake("negative_sense", credit=0.5)
def _(u, w, a, b):
    """The right cone, turned the other way: you gave z = + x sin, as on the board, where no sense is fixed. Point your right
    thumb along +y and look where the fingers take a point of the x axis after a quarter turn."""
    x, y = _on_line(u, a, b)
    return points(x * np.cos(TURN * w), y, x * np.sin(TURN * w))


@cone_from_line.mistake("about_x", credit=0.25)
def _(u, w, a, b):
    """You turned the line about the x axis. Whichever axis you turn about, the coordinate along it must stay the same: which of
    yours does?"""
    x, y = _on_line(u, a, b)
    return points(x, y * np.cos(TURN * w), y * np.sin(TURN * w))


@cone_from_line.mistake("about_z", credit=0.25)
def _(u, w, a, b):
    """You turned the line about the z axis. It lies in the xy-plane and never leaves it that way: your surface is flat. Which
    coordinate must stay the same while it turns about y?"""
    x, y = _on_line(u, a, b)
    return points(*about_z(x, y, 0.0, TURN * w))


@cone_from_line.mistake("frustum_about_z", credit=0.5)
def _(u, w, a, b):
    """A good frustum with its axis along z, as in the known form. Here the axis is y: the heights of a and b must stay in your
    second coordinate."""
    x, y = _on_line(u, a, b)
    return points(x * np.cos(TURN * w), x * np.sin(TURN * w), y)


@cone_from_line.mistake("swap_uw", credit=0.5)
def _(u, w, a, b):
    """The right cone with the two parameters exchanged: your u goes round and your w runs along the line. This is how the known
    form of the frustum labels it; in a sweep u belongs to the generatrix. Which of the two curves is the generatrix here?"""
    x, y = _on_line(w, a, b)
    return points(x * np.cos(TURN * u), y, -x * np.sin(TURN * u))


@cone_from_line.mistake("reversed", credit=0.5)
def _(u, w, a, b):
    """The right cone, its line run from b to a. Where is your point for u = 0, w = 0?"""
    x, y = _on_line(u, b, a)
    return points(x * np.cos(TURN * w), y, -x * np.sin(TURN * w))


@cone_from_line.mistake("degrees", credit=0.5)
def _(u, w, a, b):
    """You turn by 360 w. NumPy's sine and cosine take radians, so your line goes round more than 57 times and stops in the
    middle of a turn. What is a whole turn in radians?"""
    x, y = _on_line(u, a, b)
    return points(x * np.cos(360 * w), y, -x * np.sin(360 * w))


@cone_from_line.mistake("no_2pi", credit=0.25)
def _(u, w, a, b):
    """You took w itself for the angle. w ends at 1, and one radian is less than a sixth of the way round: you have a narrow
    strip of the cone. Which angle brings the line back to its start?"""
    x, y = _on_line(u, a, b)
    return points(x * np.cos(w), y, -x * np.sin(w))


@cone_from_line.mistake("b_is_a_vector", credit=0.25)
def _(u, w, a, b):
    """Your line starts at a and goes on by the whole of b, so it does not end there. With a in the origin nobody notices. Where
    is your point for u = 1, w = 0?"""
    x, y = a[0] + b[0] * np.asarray(u), a[1] + b[1] * np.asarray(u)
    return points(x * np.cos(TURN * w), y, -x * np.sin(TURN * w))


# A3.3 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="An axis in the xy-plane", kind="surface")
def revolve_xy_axis(u, w, curve, alpha, angle=2 * np.pi):
    """Return the points of the surface that the curve sweeps when it turns about an axis in the xy-plane, by the right-hand rule.

    The axis passes through the origin in the direction (cos alpha, sin alpha, 0). Transform, sweep, transform back: lay the
    axis onto x, turn there, and undo the first step.
    u is the curve's own parameter; at w = 0 the curve is in its own place, at w = 1 it has turned by angle.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    curve : a function; curve(t) gives the points of the generatrix for t in [0, 1], an array of shape t.shape + (3,)
    alpha : direction of the axis, in radians from +x towards +y
    angle : how far to turn, in radians; a whole turn if nothing is said

    Returns the points, shape of u and w together + (3,).
    """
    return dx.CircularSweep.about(curve, [0.0, 0.0, 0.0], [np.cos(alpha), np.sin(alpha), 0.0], angle)(u, w)


@revolve_xy_axis.built_from(revolve_coord)
def _(u, w, curve, alpha, angle, revolve_coord):
    cos, sin = np.cos(alpha), np.sin(alpha)
    lay = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])  # the axis onto x
    return np.asarray(revolve_coord(u, w, lambda t: curve(t) @ lay.T, "x", angle)) @ lay


@revolve_xy_axis.data
def thirty_degrees(rng):
    return {"curve": spc, "alpha": np.pi / 6}


@revolve_xy_axis.data
def any_curve_and_axis(rng):
    return {"curve": bent(rng), "alpha": np.deg2rad(rng.uniform(100, 170)), "angle": part_of_a_turn(rng)}


@revolve_xy_axis.data
def below_x(rng):
    return {"curve": bent(rng), "alpha": -np.deg2rad(rng.uniform(20, 70)), "angle": np.pi / 3}


@revolve_xy_axis.data(blind=True)
def axis_is_x(rng):
    return {"curve": spc, "alpha": 0.0}


@revolve_xy_axis.mistake("inverse_first", credit=0.5)
def _(u, w, curve, alpha, angle):
    """All three steps are there, but the transformation and its inverse have changed places: you turn about the mirror image of
    the axis, at -alpha. The *first* step must lay the axis onto x. Which way must you turn it for that?"""
    laid = about_z(*coordinates(curve, u), alpha)
    return points(*about_z(*about_x(*laid, angle * w), -alpha))


@revolve_xy_axis.mistake("no_inverse", credit=0.5)
def _(u, w, curve, alpha, angle):
    """The right surface, left lying in the wrong place: you laid the axis onto x and swept there, and then forgot the way back.
    At w = 0 the surface should pass through the curve itself."""
    laid = about_z(*coordinates(curve, u), -alpha)
    return points(*about_x(*laid, angle * w))


@revolve_xy_axis.mistake("no_transform", credit=0.25)
def _(u, w, curve, alpha, angle):
    """You turn the curve about x and then swing the result round to the axis: the last two steps of three. Before the sweep the
    curve has to be moved as well, together with the axis."""
    return points(*about_z(*about_x(*coordinates(curve, u), angle * w), alpha))


@revolve_xy_axis.mistake("axis_ignored", credit=0.25)
def _(u, w, curve, alpha, angle):
    """You turned about the x axis; alpha never enters. It is right for alpha = 0 and for no other. Which points of space must
    stay fixed while your surface turns?"""
    return points(*about_x(*coordinates(curve, u), angle * w))


@revolve_xy_axis.mistake("wrong_sense", credit=0.5)
def _(u, w, curve, alpha, angle):
    """The right axis, the other sense of rotation. Take alpha = 0, where your axis is x: a quarter turn must bring +y to +z."""
    laid = about_z(*coordinates(curve, u), -alpha)
    return points(*about_z(*about_x(*laid, -angle * w), alpha))


@revolve_xy_axis.mistake("from_y", credit=0.5)
def _(u, w, curve, alpha, angle):
    """All three steps are right, but you measured alpha from the y axis: you laid the axis onto y and turned about y. What is
    your axis when alpha = 0?"""
    laid = about_z(*coordinates(curve, u), -alpha)
    return points(*about_z(*about_y(*laid, angle * w), alpha))


@revolve_xy_axis.mistake("swap_uw", credit=0.5)
def _(u, w, curve, alpha, angle):
    """The right surface with the two parameters exchanged: your w runs along the curve and your u turns it. Hold w at 0 and let
    u run: the statement wants the curve there, in its own place."""
    laid = about_z(*coordinates(curve, w), -alpha)
    return points(*about_z(*about_x(*laid, angle * u), alpha))


# A3.4 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=7, title="An arbitrary axis", kind="surface")
def revolve_axis(u, w, curve, point, axis, angle=2 * np.pi):
    """Return the points of the surface that the curve sweeps when it turns about any line in space, by the right-hand rule.

    The line passes through point in the direction axis; right thumb along axis, the fingers show the way.
    u is the curve's own parameter; at w = 0 the curve is in its own place, at w = 1 it has turned by angle.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    curve : a function; curve(t) gives the points of the generatrix for t in [0, 1], an array of shape t.shape + (3,)
    point : a point on the axis, an array of shape (3,)
    axis : vector along the axis, an array of shape (3,), of any length but 0
    angle : how far to turn, in radians; a whole turn if nothing is said

    Returns the points, shape of u and w together + (3,).
    Raises ValueError where axis is (0, 0, 0).
    """
    return dx.CircularSweep.about(curve, point, axis, angle)(u, w)


def _turned(v, k, t):
    """Rodrigues' rotation of the vectors v (..., 3) by the angles t (...) about k, which it takes to be a unit vector."""
    t = np.asarray(t)[..., np.newaxis]
    return v * np.cos(t) + np.cross(k, v) * np.sin(t) + (v @ k)[..., np.newaxis] * k * (1 - np.cos(t))


def _unit(axis):
    length = np.linalg.norm(axis)
    if length == 0:
        raise ValueError("axis must not be (0, 0, 0)")
    return np.asarray(axis, dtype=float) / length


@revolve_axis.data
def lecture(rng):
    return {"curve": spc, "point": [1.0, 0.0, -1.0], "axis": [1.0, 2.0, 2.0]}


@revolve_axis.data
def any_axis(rng):
    return {"curve": bent(rng), "point": any_vector(rng), "axis": any_vector(rng), "angle": part_of_a_turn(rng)}


@revolve_axis.data
def short_axis(rng):
    return {"curve": bent(rng), "point": any_vector(rng), "axis": any_vector(rng, 0.1, 0.3), "angle": np.pi / 3}


@revolve_axis.data
def no_axis(rng):
    return {"curve": spc, "point": [1.0, 0.0, -1.0], "axis": [0.0, 0.0, 0.0]}


@revolve_axis.data(blind=True)
def axis_is_z(rng):
    return {"curve": spc, "point": [0.0, 0.0, 0.0], "axis": [0.0, 0.0, 1.0]}


@revolve_axis.mistake("through_origin", credit=0.5)
def _(u, w, curve, point, axis, angle):
    """You turn about a parallel line through the origin: point never enters. The point itself lies on the axis and must not move
    when it is turned. Does it?"""
    return _turned(curve(u), _unit(axis), angle * w)


@revolve_axis.mistake("no_translate_back", credit=0.5)
def _(u, w, curve, point, axis, angle):
    """The right surface, left in the wrong place: you moved the axis into the origin, turned, and did not move back. At w = 0
    the surface should pass through the curve itself."""
    return _turned(curve(u) - point, _unit(axis), angle * w)


@revolve_axis.mistake("translate_wrong_way", credit=0.5)
def _(u, w, curve, point, axis, angle):
    """Both translations are there, with their signs exchanged: you turn about a line through -point. The first step must bring
    point into the origin."""
    return _turned(curve(u) + point, _unit(axis), angle * w) - point


@revolve_axis.mistake("axis_not_unit", credit=0.25)
def _(u, w, curve, point, axis, angle):
    """You put axis into the formula with its length. Rodrigues' formula wants a *unit* vector: otherwise it stretches as it
    turns. Measure the distance of your points from the axis: it should not change with w."""
    _unit(axis)
    return point + _turned(curve(u) - point, np.asarray(axis, dtype=float), angle * w)


@revolve_axis.mistake("no_third_term", credit=0.25)
def _(u, w, curve, point, axis, angle):
    """The part of your vector *along* the axis shrinks with the cosine, as if it turned too. It must stay as it is; one term of
    the formula, the one with 1 - cos, is missing."""
    k, v, t = _unit(axis), curve(u) - point, np.multiply(angle, w)[..., np.newaxis]
    return point + v * np.cos(t) + np.cross(k, v) * np.sin(t)


@revolve_axis.mistake("axis_is_a_point", credit=0.25)
def _(u, w, curve, point, axis, angle):
    """You read axis as a second point of the line. It is a direction: moving point along with the whole line must not change
    it. Which vector did you turn about?"""
    _unit(axis)
    return point + _turned(curve(u) - point, _unit(np.subtract(axis, point)), angle * w)


@revolve_axis.mistake("wrong_sense", credit=0.5)
def _(u, w, curve, point, axis, angle):
    """The right axis, the other sense of rotation: yours turns by the left hand. Check the order of the two vectors in your
    cross product, or the sign of the sine."""
    return point + _turned(curve(u) - point, _unit(axis), -np.multiply(angle, w))
