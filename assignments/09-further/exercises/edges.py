"""Boundary curves once more: do they meet, mixed by cubics, and given as Bezier polygons."""

import directrix as dx
import numpy as np

from autograder.exercise import exercise

# S4 --------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Do four curves bound a patch?", kind="label")
def corners_agree(c0, c1, d0, d1, rtol):
    """Return True when four curves meet in four corners, so that a Coons patch can be hung between them, else False.

    c0 and c1 are to be the edges w = 0 and w = 1, d0 and d1 the edges u = 0 and u = 1; all run in the direction of growing u or w.
    At a corner two curve ends are to be one point. They agree when their distance is at most rtol times the size of the
    patch, where the size is the diagonal of the box (with sides along x, y, z) that just holds all eight ends. So it makes no
    difference whether the curves are given in micrometres or in kilometres.

    c0, c1, d0, d1 : functions; c0(t) gives points for t in [0, 1], an array of shape t.shape + (3,)
    rtol : how large a gap may be, relative to the size, such as 1e-6

    Returns True or False.
    """
    gaps, size = _gaps(c0, c1, d0, d1)
    return bool(max(gaps) <= rtol * size)


def _gaps(c0, c1, d0, d1):
    """The four gaps at p00, p10, p01, p11, and the size."""
    ends = np.array([[c0(0.0), c0(1.0), c1(0.0), c1(1.0)], [d0(0.0), d1(0.0), d0(1.0), d1(1.0)]])
    flat = ends.reshape(-1, 3)
    return np.linalg.norm(ends[0] - ends[1], axis=-1), np.linalg.norm(flat.max(axis=0) - flat.min(axis=0))


def any_corners(rng):
    """Corners (2, 2, 3) of a bent quadrilateral, 3 long and 4 wide, no two edges alike."""
    flat = np.array([[[0, 0, 0], [1, 4, 1]], [[3, -1, 2], [4, 3, -2]]], dtype=float)
    return flat + rng.uniform(-0.4, 0.4, (2, 2, 3))


def bent_edges(rng, p):
    """Four cubic Bezier curves c0, c1, d0, d1 between the corners p (2, 2, 3), by their control points."""

    def between(a, b, bulge):
        inner = a + np.array([[1], [2]]) / 3 * (b - a) + bulge + rng.uniform(-0.4, 0.4, (2, 3))
        return np.concatenate([[a], inner, [b]])

    return {
        "c0": between(p[0, 0], p[1, 0], [0, -1, 3]), "c1": between(p[0, 1], p[1, 1], [0, 2, -1]),
        "d0": between(p[0, 0], p[0, 1], [-2, 0, 2]), "d1": between(p[1, 0], p[1, 1], [1, 0, -2]),
    }  # fmt: skip


def as_curves(polygons):
    return {name: dx.BezierCurve(polygon) for name, polygon in polygons.items()}


@corners_agree.data
def they_meet(rng):
    return {**as_curves(bent_edges(rng, any_corners(rng))), "rtol": 1e-6}


# S9 --------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Coons patch with cubic blending", kind="surface")
def cubic_coons(u, w, c0, c1, d0, d1):
    """Return the points of the Coons patch through four boundary curves, mixed by the cubics F1 and F2.

    F1(t) = 2t³ - 3t² + 1 falls from 1 to 0 and F2(t) = 3t² - 2t³ rises from 0 to 1, both level at the ends. They take the place of
    1 - t and t, wherever these stand in Coons' formula. c0 and c1 are the edges w = 0 and w = 1, d0 and d1 the edges u = 0 and
    u = 1. All run in the direction of growing u or w and meet in the four corners.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    c0, c1, d0, d1 : functions; c0(t) gives points for t in [0, 1], an array of shape t.shape + (3,)

    Returns the points, shape of u and w together + (3,).
    """
    return dx.Coons(c0, c1, d0, d1, blend="cubic")(u, w)


@cubic_coons.data
def any_edges(rng):
    return as_curves(bent_edges(rng, any_corners(rng)))


# S10 -------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Net of a Coons patch", kind="net", accept={"close": 0.8})
def coons_bezier_net(c0, c1, d0, d1):
    """Return the control net of the Bezier patch that is the Coons patch of four Bezier curves.

    The four curves are given by their control polygons; opposite ones have equally many points. c0 and c1 are the edges w = 0
    and w = 1, d0 and d1 the edges u = 0 and u = 1. All run in the direction of growing u or w and meet in the four corners. The
    blending functions are 1 - t and t.

    c0, c1 : control points of the edges along u, arrays of shape (m, 3)
    d0, d1 : control points of the edges along w, arrays of shape (n, 3)

    Returns the net, an array of shape (m, n, 3), first index along u.
    """
    return _net(c0, c1, d0, d1)


def _parts(c0, c1, d0, d1, s=None, t=None):
    """Nets of the ruled surface from c0 to c1, of the one from d0 to d1, and of the bilinear surface of the corners."""
    s = np.linspace(0, 1, len(c0))[:, None, None] if s is None else s
    t = np.linspace(0, 1, len(d0))[None, :, None] if t is None else t
    across_w = (1 - t) * c0[:, None] + t * c1[:, None]
    across_u = (1 - s) * d0[None] + s * d1[None]
    flat = (1 - s) * (1 - t) * c0[0] + s * (1 - t) * c0[-1] + (1 - s) * t * c1[0] + s * t * c1[-1]
    return across_w, across_u, flat


def _net(c0, c1, d0, d1, s=None, t=None):
    across_w, across_u, flat = _parts(c0, c1, d0, d1, s, t)
    return across_w + across_u - flat


@coons_bezier_net.data
def bicubic(rng):
    return bent_edges(rng, any_corners(rng))
