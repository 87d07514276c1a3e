"""Directions and measurements: which way is out of a solid, how round is a ball, which tangents suit measured points."""

import directrix as dx
import numpy as np

from autograder.exercise import exercise

# S12 -------------------------------------------------------------------------------------------------------------------------


@exercise(points=4, title="Which way is out?", kind="net", accept={"close": 0.8})
def outward_normals(s, t, P):
    """Return the unit normals of the six faces of a solid, at one place of each, all pointing out of the solid.

    The solid is a tricubic Bezier hyperpatch S(u, v, w), and right-handed: where u, v and w grow, the directions are as those
    of thumb, first and second finger of the right hand. The faces come in the order u = 0, u = 1, v = 0, v = 1, w = 0, w = 1.
    The place is given by the two parameters that remain on a face, in their order: on the faces u = 0 and u = 1 it is v = s,
    w = t; on v = 0 and v = 1 it is u = s, w = t; on w = 0 and w = 1 it is u = s, v = t.

    s, t : the place on each face, numbers in [0, 1]
    P : control points of the solid, an array of shape (4, 4, 4, 3), axes u, v, w

    Returns the normals, an array of shape (6, 3).
    """
    # faces() turns the inner ones round by exchanging their parameters, so the place is exchanged with them
    faces = dx.BezierHyperpatch(P).faces(outward=False)
    return np.stack([sign * face.normal(s, t) for sign, face in zip(OUT, faces, strict=True)])


OUT = (-1, 1, 1, -1, -1, 1)


def bent_solid(rng):
    """A right-handed net (4, 4, 4, 3): three different steps, bent and shaken."""
    P = np.stack(np.meshgrid(*[np.arange(4.0)] * 3, indexing="ij"), axis=-1) * (rng.uniform(1.5, 2.5, 3) + [0, 1, 2])
    P[..., 2] += rng.uniform(0.1, 0.2) * P[..., 0] * (6 + P[..., 0])
    P[..., 0] += rng.uniform(0.3, 0.5) * P[..., 1]
    P[..., 1] += rng.uniform(0.1, 0.2) * P[..., 2]
    return P + rng.uniform(-0.3, 0.3, P.shape)


@outward_normals.data
def any_solid(rng):
    return {"s": rng.uniform(0.1, 0.3), "t": rng.uniform(0.7, 0.9), "P": bent_solid(rng)}


@outward_normals.data
def at_a_corner(rng):
    return {"s": 1.0, "t": 0.0, "P": bent_solid(rng)}


@outward_normals.data(blind=True)
def box(rng):
    """A regular lattice, 3 x 3 x 3: every place of a face has the same normal."""
    return {"s": 0.25, "t": 0.75, "P": np.stack(np.meshgrid(*[np.arange(4.0)] * 3, indexing="ij"), axis=-1)}


def _derivatives(t, P):
    """Points and derivatives (2, n, 3) of the curves P (4, n, 3) at t."""
    b = [(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3]
    d = [-3 * (1 - t) ** 2, 3 * (1 - t) * (1 - 3 * t), 3 * t * (2 - 3 * t), 3 * t**2]
    return np.tensordot(np.array([b, d]), P, 1)


def _normals(s, t, P, signs=OUT, unit=True):
    """S_first x S_second on each face, at one place, with these signs."""
    found = []
    for face in (P[0], P[-1], P[:, 0], P[:, -1], P[:, :, 0], P[:, :, -1]):
        point, along_first = _derivatives(s, face)
        n = np.cross(_derivatives(t, along_first[:, None])[0, 0], _derivatives(t, point[:, None])[1, 0])
        found.append(n / np.linalg.norm(n) if unit else n)
    return np.array(signs)[:, None] * np.stack(found)


@outward_normals.mistake("as_they_come", credit=0.5)
def _(s, t, P):
    """All six directions are right, and three of yours point into the solid: you took the cross product of the two derivatives
    as it comes. On the face u = 0 that is along growing u. Is that the way out?"""
    return _normals(s, t, P, (1, 1, 1, 1, 1, 1))


@outward_normals.mistake("near_faces_turned", credit=0.5)
def _(s, t, P):
    """You turned the three near faces round, as u, v and w grow away from them. That is right for u and for w, and not for v:
    on its faces the remaining two come as u, w. What is S_u x S_w in a right-handed solid?"""
    return _normals(s, t, P, (-1, 1, -1, 1, -1, 1))


@outward_normals.mistake("all_inward", credit=0.5)
def _(s, t, P):
    """All six of yours are exactly the other way round: they point into the solid, so you turned the wrong three. Go to the
    face u = 1: in which direction do you leave the solid there, and what does v x w give?"""
    return _normals(s, t, P, tuple(-sign for sign in OUT))


@outward_normals.mistake("not_unit", credit=0.5)
def _(s, t, P):
    """Your normals point where they should, and have the lengths that the cross product gave them. A unit normal tells the
    direction and nothing else. How long are yours?"""
    return _normals(s, t, P, unit=False)


@outward_normals.mistake("s_t_exchanged", credit=0.5)
def _(s, t, P):
    """Your normals are those of another place: s and t have changed places. On a box it makes no difference. On the face v = 1,
    which of u and w is the first of the two that remain?"""
    return _normals(t, s, P)


@outward_normals.mistake("always_the_middle", credit=0.25)
def _(s, t, P):
    """Your normals belong to the middle of each face; s and t never enter. On a bent face the normal changes from place to
    place. Where on the face is it asked for?"""
    return _normals(0.5, 0.5, P)


@outward_normals.mistake("as_for_a_box", credit=0.25)
def _(s, t, P):
    """You gave the six directions of a box that stands along x, y and z. The control points decide how a face lies: which two
    derivatives span its tangent plane?"""
    return np.array([[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1]], dtype=float)


# S14 -------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Sphericity from measured points", kind="value", tolerance=1e-6, accept={"close": 0.8})
def sphericity(points):
    """Return the sphericity of measured points: their largest distance from the centre of the sphere that fits them best, less
    their smallest.

    Best is meant in this sense: points on a sphere of centre c satisfy |x|² = 2 c·x + k with one number k, which is linear in
    c and k. Take the c and k for which the sum of the squared differences of the two sides is smallest. The points need not be
    spread evenly over the ball.

    points : measured points, an array of shape (n, 3) with n >= 5, not in one plane, in millimetres

    Returns a number, in millimetres.
    """
    return float(dx.sphericity(points, "algebraic").value)


def around(centre, radius, directions):
    """Points at these distances from a centre, in these directions."""
    return centre + np.reshape(radius, (-1, 1)) * directions / np.linalg.norm(directions, axis=-1, keepdims=True)


def any_centre(rng):
    return rng.uniform(5, 15, 3) * rng.choice([-1.0, 1.0], 3)


@sphericity.data
def cap(rng):
    """Points of the upper part of a ball only."""
    directions = rng.normal(size=(60, 3))
    directions[:, 2] = 0.3 + np.abs(directions[:, 2])
    return {"points": around(any_centre(rng), 12 + rng.uniform(-0.02, 0.02, 60), directions)}


@sphericity.data
def pear(rng):
    """Drawn out towards one side; measured more densely there."""
    directions = rng.normal(size=(80, 3)) + [0.8, 0, 0]
    along = directions[:, 0] / np.linalg.norm(directions, axis=1)
    radius = rng.uniform(8, 10) + 0.05 * along**3 + rng.uniform(-0.005, 0.005, 80)
    return {"points": around(any_centre(rng), radius, directions)}


@sphericity.data(blind=True)
def opposite_pairs(rng):
    """About the origin, each point with its opposite: the centroid is the centre."""
    half = rng.normal(size=(20, 3))
    radius = 10 + rng.uniform(-0.02, 0.02, 20)
    return {"points": around(np.zeros(3), np.tile(radius, 2), np.concatenate([half, -half]))}


def _distances(points, centre):
    return np.linalg.norm(points - centre, axis=1)


def _fitted(points):
    """The centre of the linear least-squares fit."""
    A = np.column_stack([2 * points, np.ones(len(points))])
    return np.linalg.lstsq(A, (points**2).sum(axis=1), rcond=None)[0][:3]


@sphericity.mistake("centroid_as_centre", credit=0.5)
def _(points):
    """You measured from the mean of the points. They are not spread evenly over the ball: where more were taken, the mean is
    drawn. Of a cap it lies far from the centre. What do points on a sphere tell about its centre?"""
    return float(np.ptp(_distances(points, points.mean(axis=0))))


@sphericity.mistake("half_zone", credit=0.5)
def _(points):
    """Exactly half of the right value: you gave it as plus or minus about a mean radius. Sphericity is the whole width of the
    zone, from the sphere inside to the sphere outside."""
    return float(np.ptp(_distances(points, _fitted(points)))) / 2


@sphericity.mistake("rms", credit=0.5)
def _(points):
    """You have the right centre and the right distances, and then took their standard deviation. The zone has to hold *every*
    point. Which two of the points decide?"""
    return float(np.std(_distances(points, _fitted(points))))


@sphericity.mistake("diameter", credit=0.5)
def _(points):
    """Exactly twice the right value: you compared diameters. The zone lies between two concentric spheres, and its width is a
    difference of radii."""
    return 2 * float(np.ptp(_distances(points, _fitted(points))))


@sphericity.mistake("about_origin", credit=0.25)
def _(points):
    """You measured from the origin, where the ball is not. Move all points together: your answer should not change. Which point
    has, as nearly as can be, the same distance from all of them?"""
    return float(np.ptp(np.linalg.norm(points, axis=1)))


@sphericity.mistake("no_constant", credit=0.5)
def _(points):
    """Your linear system has three unknowns, and the constant k is missing: that makes the sphere pass through the origin.
    Write |x - c|² = r² out: what is left besides |x|² and 2 c·x?"""
    return float(np.ptp(_distances(points, np.linalg.lstsq(2 * points, (points**2).sum(axis=1), rcond=None)[0])))


@sphericity.mistake("centre_doubled", credit=0.75)
def _(points):
    """Nearly: your centre is twice as far from the origin as it should be. The 2 in 2 c·x has been lost. What do the first
    three unknowns of your system stand for?"""
    return float(np.ptp(_distances(points, 2 * _fitted(points))))


@sphericity.mistake("squared", credit=0.5)
def _(points):
    """You have the right centre, and gave the range of the *squared* distances: yours is in square millimetres. Where does the
    root belong, before the difference or after it?"""
    return float(np.ptp(_distances(points, _fitted(points)) ** 2))


# S15 -------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Tangents for a grid of points", kind="net", accept={"close": 0.8})
def fmill_tangents(P):
    """Return tangents (pu, pw) for a grid of points, by the rule of FMILL, so that Ferguson patches can be laid through them.

    At an inner point of a row of points the tangent has the direction from the point before to the point after, and its length is the
    shorter of the two distances, to the point before and to the point after. At both ends of a row there is no such point; there
    the tangent is (0, 0, 0). pu belongs to the rows along the first index, pw to those along the second. (A. Saxena and B.
    Sahay, Computer Aided Engineering Design, eq. 7.46.)

    P : points, an array of shape (m, n, 3) with m, n >= 3, first index along u

    Returns pu and pw, two arrays of shape (m, n, 3).
    """
    return _both(P, _along)


def _along(P, length=np.minimum):
    """Tangents along the first axis; ``length`` makes one length of the two distances."""
    P = np.asarray(P, dtype=float)
    before, after = P[1:-1] - P[:-2], P[2:] - P[1:-1]
    chord = P[2:] - P[:-2]
    tangents = np.zeros(P.shape)
    sizes = length(np.linalg.norm(before, axis=-1), np.linalg.norm(after, axis=-1))
    tangents[1:-1] = sizes[..., None] * chord / np.linalg.norm(chord, axis=-1, keepdims=True)
    return tangents


@fmill_tangents.data
def printed(rng):
    """Example 7.9 of Saxena and Sahay: pw[0, 1] = (0, 1/√5, 2/√5) and pw[2, 1] = (0, 1/√17, 4/√17)."""
    P = [[[0, 0, 0], [0, 1, 0], [0, 1, 2]], [[1, 0, 0], [1, 1, 0], [1, 1, 2]], [[2, 0, 0], [2, 1, 0], [2, 1, 4]]]
    return {"P": np.array(P, dtype=float)}


@fmill_tangents.data
def any_grid(rng):
    """Steps that grow or shrink, and a bent sheet."""
    x, y = np.cumsum(rng.permutation([1.0, 2.0, 3.0, 1.5])), np.cumsum(rng.permutation([1.0, 2.5, 1.5, 4.0, 2.0]))
    P = np.stack([*np.meshgrid(x, y, indexing="ij"), np.zeros((4, 5))], axis=-1)
    P[..., 2] = 0.1 * P[..., 0] * P[..., 1]
    return {"P": P + rng.uniform(-0.3, 0.3, P.shape)}


@fmill_tangents.data(blind=True)
def regular_lattice(rng):
    return {"P": np.stack([*np.meshgrid(np.arange(4.0), np.arange(4.0), indexing="ij"), np.zeros((4, 4))], axis=-1)}


def _both(P, along):
    """A rule for rows, applied along both indices."""
    return along(P), np.swapaxes(along(np.swapaxes(P, 0, 1)), 0, 1)


def _inner(P, tangents):
    """Tangents at the inner points of the rows, zero at both ends."""
    zero = np.zeros((1, *P.shape[1:]))
    return np.concatenate([zero, tangents, zero])


@fmill_tangents.mistake("mean_length", credit=0.5)
def _(P):
    """Your directions are right; for the lengths you took the *mean* of the two distances. Where a short leg follows a long
    one, such a tangent shoots beyond the short one. Which of the two distances does FMILL take?"""
    return _both(P, lambda rows: _along(rows, lambda a, b: (a + b) / 2))


@fmill_tangents.mistake("longer_length", credit=0.5)
def _(P):
    """Your directions are right; for the lengths you took the longer of the two distances. Then the curve overshoots in the
    shorter leg, and may even make a loop. Which of the two is safe?"""
    return _both(P, lambda rows: _along(rows, np.maximum))


@fmill_tangents.mistake("central_difference", credit=0.5)
def _(P):
    """You took half of the way from the point before to the point after. The direction is right; with equal steps the length
    is, too. Next to a short leg yours is too long. Which two distances should you compare?"""
    return _both(P, lambda rows: _inner(rows, (rows[2:] - rows[:-2]) / 2))


@fmill_tangents.mistake("unit", credit=0.5)
def _(P):
    """Your directions are right, and all your tangents have length 1. In millimetres or in metres, the curve between two points
    should look the same. What should the length grow with?"""
    return _both(P, lambda rows: _along(rows, lambda a, b: np.ones_like(a)))


@fmill_tangents.mistake("chord_not_unit", credit=0.5)
def _(P):
    """Your tangents are far too long: you multiplied the chord from the point before to the point after by a distance, and so
    you have a length squared. What has to be done to a chord, so that only its direction is left?"""

    def along(rows):
        return _along(rows) * np.linalg.norm(_inner(rows, rows[2:] - rows[:-2]), axis=-1, keepdims=True)

    return _both(P, along)


@fmill_tangents.mistake("pu_pw_exchanged", credit=0.5)
def _(P):
    """Both arrays are right, and you hand them over in the other order. pu belongs to the rows in which the *first* index
    changes. In your first array, where are the zeros?"""
    return _both(P, _along)[::-1]


@fmill_tangents.mistake("towards_the_next", credit=0.25)
def _(P):
    """Your tangents point to the next point, as the legs of the polygon do. Then the curve comes in by one leg and leaves by
    another. FMILL is fair to both neighbours: which two points give the direction?"""

    def along(rows):
        before, after = rows[1:-1] - rows[:-2], rows[2:] - rows[1:-1]
        size = np.linalg.norm(after, axis=-1, keepdims=True)
        return _inner(rows, np.minimum(np.linalg.norm(before, axis=-1, keepdims=True), size) * after / size)

    return _both(P, along)


@fmill_tangents.mistake("ends_not_zero", credit=0.5)
def _(P):
    """All your inner tangents are right. At both ends of a row you put in the only leg there is, which is sensible, and not
    what is asked for: where a point has no neighbour on one side, leave the tangent at zero."""

    def along(rows):
        tangents = _along(rows)
        tangents[0], tangents[-1] = rows[1] - rows[0], rows[-1] - rows[-2]
        return tangents

    return _both(P, along)
