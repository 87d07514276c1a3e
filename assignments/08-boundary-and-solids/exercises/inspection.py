"""Inspection: form errors of measured points, as a coordinate measuring machine reports them. All lengths in millimetres."""

import directrix as dx
import numpy as np

from autograder.exercise import exercise


def frame(normal):
    """Two unit vectors across a unit normal, and the normal, as rows."""
    first = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(normal, first), normal])


def slanting(rng):
    """A random unit vector, none of its components near 0 or near 1."""
    v = rng.uniform(0.6, 1.4, 3) * rng.choice([-1.0, 1.0], 3)
    return v / np.linalg.norm(v)


def plate(length, width, deviation):
    """7 x 5 points of a plate (35, 3), first three of its corners; ``deviation(s, t)`` is the height, s and t from -1 to 1.

    The grid is even about 0, and so are the deviations used here: the least-squares plane is z = mean of the heights.
    """
    s, t = (grid.ravel() for grid in np.meshgrid(np.linspace(-1, 1, 7), np.linspace(-1, 1, 5), indexing="ij"))
    h = deviation(s, t)
    points = np.stack([length / 2 * s, width / 2 * t, h - h.mean()], axis=-1)
    corners = [0, 30, 4]
    return np.concatenate([points[corners], np.delete(points, corners, axis=0)])


# A8.6 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Flatness from measured points", kind="value", tolerance=1e-6, accept={"close": 0.8})
def flatness(points):
    """Return the flatness of measured points: the distance from the highest to the lowest of them, seen across the plane that
    fits them best.

    Best means least squares of the distances at right angles to the plane. The plate may stand anywhere and at any slant; the
    points come in no particular order.

    points : measured points, an array of shape (n, 3) with n >= 4, in millimetres

    Returns a number, in millimetres.
    """
    return float(dx.flatness(points).value)


@flatness.data
def milled_plate(rng):
    """Hollow along its length and twisted, on a slant: flatness 0.04 by construction."""
    flat = plate(80, 50, lambda s, t: 0.018 * s**2 + 0.018 * s * t)
    axes = np.array([[2, 1, -2], [1, 2, 2], [2, -2, 1]]) / 3
    return {"points": flat @ axes + [30, -20, 40]}


@flatness.data
def any_plate(rng):
    a, b = rng.uniform(0.02, 0.04, 2)
    flat = plate(rng.uniform(60, 90), rng.uniform(30, 50), lambda s, t: a * s**2 - b * s * t + rng.normal(0, 0.004, s.shape))
    normal = slanting(rng)
    return {"points": flat @ frame(normal) + rng.uniform(20, 40) * normal + rng.uniform(-10, 10, 3)}


@flatness.data
def bulging_plate(rng):
    bulge = rng.uniform(0.02, 0.05)
    flat = plate(rng.uniform(50, 70), rng.uniform(50, 70), lambda s, t: bulge * (1 - s**2) * (1 - t**2))
    normal = slanting(rng)
    return {"points": flat @ frame(normal) + rng.uniform(20, 40) * normal}


@flatness.data(blind=True)
def surface_table(rng):
    """Level, and centred about the origin."""
    return {"points": plate(80, 50, lambda s, t: 0.018 * s**2 + 0.018 * s * t)}


def _heights(points):
    """Distances from the least-squares plane."""
    away = points - points.mean(axis=0)
    return away @ np.linalg.svd(away, full_matrices=False)[2][-1]


@flatness.mistake("z_range", credit=0.25)
def _(points):
    """You gave the range of the heights z. That is right on a level surface table; on a slant the slant itself is counted as an
    error, and yours is hundreds of times too large. Heights above *which* plane are wanted?"""
    return float(np.ptp(points[:, 2]))


@flatness.mistake("vertical", credit=0.5)
def _(points):
    """You fitted z = ax + by + c and measured the residuals along z. The distance from a plane is measured at right angles to it;
    along z it is longer, the more so the steeper the plate stands. On a level plate you would not notice."""
    A = np.column_stack([points[:, :2], np.ones(len(points))])
    return float(np.ptp(points[:, 2] - A @ np.linalg.lstsq(A, points[:, 2], rcond=None)[0]))


@flatness.mistake("rms", credit=0.5)
def _(points):
    """You have the right plane and the right distances, and then took their standard deviation. Flatness is a zone that holds *every* point: it
    is set by the two points that stick out most."""
    return float(np.sqrt(np.mean(_heights(points) ** 2)))


@flatness.mistake("three_points", credit=0.25)
def _(points):
    """You laid the plane through the first three points. Each of these has an error of its own, and you treat it as the truth.
    The plane should come from all of the points alike."""
    normal = np.cross(points[1] - points[0], points[2] - points[0])
    return float(np.ptp((points - points[0]) @ (normal / np.linalg.norm(normal))))


@flatness.mistake("not_centred", credit=0.5)
def _(points):
    """Your plane is forced through the origin of the coordinates: the singular vectors were taken of the points as they are. A
    best plane passes through the middle of the points. Move the plate about: your answer should not change."""
    return float(np.ptp(points @ np.linalg.svd(points, full_matrices=False)[2][-1]))


@flatness.mistake("one_sided", credit=0.5)
def _(points):
    """You have the right plane, and then took the largest distance from it on one side. A zone has two sides: from the lowest point up to the
    highest. How far is the farthest point on the other side?"""
    return float(np.abs(_heights(points)).max())


@flatness.mistake("longest_direction", credit=0.5)
def _(points):
    """You measured along the plate instead of across it: yours is its length. Singular values come in falling order. In which
    direction do the points of a flat plate spread *least*?"""
    away = points - points.mean(axis=0)
    return float(np.ptp(away @ np.linalg.svd(away, full_matrices=False)[2][0]))


# A8.7 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Cylindricity about a given axis", kind="value", accept={"close": 0.8})
def cylindricity(points, axis_point, axis_dir):
    """Return the cylindricity of measured points about a given axis: their largest distance from the axis less their smallest.

    The axis is a line through axis_point in the direction axis_dir. It is given, so there is nothing to fit.

    points : measured points, an array of shape (n, 3), in millimetres
    axis_point : a point of the axis, an array of shape (3,)
    axis_dir : the direction of the axis, an array of shape (3,), of any length but 0; the length means nothing

    Returns a number, in millimetres.
    """
    return float(dx.cylindricity(points, axis_point, axis_dir).value)


def shaft(radii, length):
    """Points (n, 3) about the z axis at these distances from it, winding up round a shaft."""
    n = len(radii)
    angle = 2.4 * np.arange(n)  # the golden angle: no two points above each other
    return np.column_stack([radii * np.cos(angle), radii * np.sin(angle), np.linspace(0, length, n)])


def any_shaft(rng):
    radii = rng.uniform(8, 12) + rng.uniform(-0.02, 0.02, 40) + 0.03 * np.linspace(0, 1, 40) ** 2
    return shaft(radii, rng.uniform(40, 60))


@cylindricity.data
def turned_shaft(rng):
    """Barrel-shaped: radius 12 at the ends, 12.035 in the middle. Cylindricity 0.035 by construction."""
    t = np.linspace(-1, 1, 41)
    axes = np.array([[2, 1, -2], [2, -2, 1], [1, 2, 2]]) / 3
    return {"points": shaft(12.035 - 0.035 * t**2, 60) @ axes + [3, -2, 5], "axis_point": [3, -2, 5], "axis_dir": [1, 2, 2]}


@cylindricity.data
def any_axis(rng):
    axis, point = slanting(rng), rng.uniform(3, 9, 3) * rng.choice([-1.0, 1.0], 3)
    points = any_shaft(rng) @ frame(axis) + point
    return {"points": points, "axis_point": point + rng.uniform(-20, -10) * axis, "axis_dir": rng.uniform(2, 4) * axis}


@cylindricity.data
def short_direction(rng):
    axis, point = slanting(rng), rng.uniform(3, 9, 3) * rng.choice([-1.0, 1.0], 3)
    return {"points": any_shaft(rng) @ frame(axis) + point, "axis_point": point, "axis_dir": rng.uniform(0.1, 0.3) * axis}


@cylindricity.data(blind=True)
def between_centres(rng):
    """On the lathe: the axis is z, through the origin, with a unit direction."""
    t = np.linspace(-1, 1, 41)
    return {"points": shaft(12.035 - 0.035 * t**2, 60), "axis_point": [0.0, 0.0, 0.0], "axis_dir": [0.0, 0.0, 1.0]}


def _unit(axis_dir):
    return axis_dir / np.linalg.norm(axis_dir)


def _away(points, axis_point, k):
    """Distances of the points from a line, where k is taken for a unit vector."""
    v = points - axis_point
    return np.linalg.norm(v - (v @ k)[:, np.newaxis] * k, axis=-1)


@cylindricity.mistake("axis_not_unit", credit=0.5)
def _(points, axis_point, axis_dir):
    """You projected on axis_dir with the length it came with. The part of v along the axis is (v·k) k for a *unit* vector k;
    otherwise you take away too much or too little. Try the same axis with a direction twice as long."""
    return float(np.ptp(_away(points, axis_point, axis_dir)))


@cylindricity.mistake("distance_to_point", credit=0.25)
def _(points, axis_point, axis_dir):
    """You measured the distance from axis_point. That point only says where the line lies; a point further along the shaft is
    further from it, however round the shaft is. The way to the *axis* is across it."""
    return float(np.ptp(np.linalg.norm(points - axis_point, axis=-1)))


@cylindricity.mistake("diameter", credit=0.5)
def _(points, axis_point, axis_dir):
    """Exactly twice the right value: you compared diameters. Cylindricity is the gap between two cylinders about the axis, one
    inside and one outside the points, and a gap is a difference of radii."""
    return 2 * float(np.ptp(_away(points, axis_point, _unit(axis_dir))))


@cylindricity.mistake("half_zone", credit=0.5)
def _(points, axis_point, axis_dir):
    """Exactly half of the right value: you gave it as plus or minus about a mean radius. A form error is the whole width of the
    zone, from the inner cylinder to the outer one."""
    return float(np.ptp(_away(points, axis_point, _unit(axis_dir)))) / 2


@cylindricity.mistake("squared", credit=0.5)
def _(points, axis_point, axis_dir):
    """You gave the range of the *squared* distances; yours is in square millimetres. A root is missing, and it has to be taken
    before the smallest is subtracted from the largest."""
    return float(np.ptp(_away(points, axis_point, _unit(axis_dir)) ** 2))


@cylindricity.mistake("through_origin", credit=0.5)
def _(points, axis_point, axis_dir):
    """You measured from a parallel line through the origin: axis_point never enters. Between centres on a lathe you would not
    notice. From where should the vector to a measured point start?"""
    return float(np.ptp(_away(points, 0.0, _unit(axis_dir))))


@cylindricity.mistake("about_z", credit=0.25)
def _(points, axis_point, axis_dir):
    """You took the distance from the z direction, from x and y alone: axis_dir never enters. On a shaft that lies aslant your
    points seem to wander away. Which part of a vector is the one *across* a given direction?"""
    return float(np.ptp(np.linalg.norm((points - axis_point)[:, :2], axis=-1)))


@cylindricity.mistake("axis_is_a_point", credit=0.25)
def _(points, axis_point, axis_dir):
    """You read axis_dir as a second point of the axis. It is a direction: it must not change when the whole shaft is moved.
    Which vector did you project on?"""
    return float(np.ptp(_away(points, axis_point, _unit(axis_dir - axis_point))))
