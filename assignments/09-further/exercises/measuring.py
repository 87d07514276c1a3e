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


@outward_normals.data
def box(rng):
    P = np.stack(np.meshgrid(*[np.arange(4.0)] * 3, indexing="ij"), axis=-1)
    return {"s": 0.3, "t": 0.6, "P": P}


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


@sphericity.data
def cap(rng):
    a, b = rng.uniform(0, 2 * np.pi, 40), rng.uniform(0.2, 1.2, 40)
    r = 12 + rng.uniform(-0.02, 0.02, 40)
    return {"points": r[:, None] * np.stack([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)], -1) + [5, -3, 2]}


# S15 -------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Tangents for a grid of points", kind="net", accept={"close": 0.8})
def fmill_tangents(P):
    """Return tangents (pu, pw) for a grid of points, by the rule of FMILL, so that Ferguson patches can be laid through them.

    At an inner point of a row of points the tangent has the direction from the point before to the point after, and its length is the
    shorter of the two distances, to the point before and to the point after. At both ends of a row there is no such point; there
    the tangent is (0, 0, 0). pu belongs to the rows along the first index, pw to those along the second. (S. Saxena and B.
    Sahay, Computer Aided Engineering Design, section 7.4.)

    P : points, an array of shape (m, n, 3) with m, n >= 3, first index along u

    Returns pu and pw, two arrays of shape (m, n, 3).
    """
    return _along(P), np.swapaxes(_along(np.swapaxes(P, 0, 1)), 0, 1)


def _along(P, length=np.minimum):
    """Tangents along the first axis; ``length`` makes one length of the two distances."""
    before, after = P[1:-1] - P[:-2], P[2:] - P[1:-1]
    chord = P[2:] - P[:-2]
    tangents = np.zeros(P.shape)
    sizes = length(np.linalg.norm(before, axis=-1), np.linalg.norm(after, axis=-1))
    tangents[1:-1] = sizes[..., None] * chord / np.linalg.norm(chord, axis=-1, keepdims=True)
    return tangents


@fmill_tangents.data
def printed(rng):
    """Example 7.9 of Saxena and Sahay."""
    P = [[[0, 0, 0], [0, 1, 0], [0, 1, 2]], [[1, 0, 0], [1, 1, 0], [1, 1, 2]], [[2, 0, 0], [2, 1, 0], [2, 1, 4]]]
    return {"P": np.array(P, dtype=float)}
