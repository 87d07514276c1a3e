"""Boundary curves once more: do they meet, mixed by cubics, and given as Bezier polygons.

Over 400 lines, for the three share their edges, and each stands here whole with its mistakes.
"""

import directrix as dx
import numpy as np

from autograder.exercise import exercise

from .nets import elevate_u

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


def opened(rng, name, end, gap, rtol=1e-6, unit=1.0):
    """Edges that meet, but for one end of the curve called name, which is off by gap times the size (about 6)."""
    polygons = bent_edges(rng, any_corners(rng))
    polygons[name][end] += 6 * gap * np.array([2, -1, 2]) / 3
    return {**as_curves({key: unit * polygon for key, polygon in polygons.items()}), "rtol": rtol}


@corners_agree.data
def they_meet(rng):
    return {**as_curves(bent_edges(rng, any_corners(rng))), "rtol": 1e-6}


@corners_agree.data
def open_at_p10(rng):
    return opened(rng, "c0", -1, rng.uniform(0.05, 0.1))


@corners_agree.data
def open_at_p01(rng):
    return opened(rng, "d0", -1, rng.uniform(0.05, 0.1))


@corners_agree.data
def open_at_p11(rng):
    return opened(rng, "d1", -1, rng.uniform(0.05, 0.1))


@corners_agree.data
def open_at_p00(rng):
    return opened(rng, "c0", 0, rng.uniform(0.05, 0.1))


@corners_agree.data
def open_everywhere(rng):
    """No two edges meet, by a ten-millionth of the size, where a billionth is forgiven."""
    polygons = bent_edges(rng, any_corners(rng))
    away = rng.uniform(3e-7, 6e-7, 3)
    return {**as_curves({**polygons, "c0": polygons["c0"] + away, "c1": polygons["c1"] - away}), "rtol": 1e-9}


@corners_agree.data
def head_to_tail(rng):
    """The four edges of one patch, but run once round it: c0, d1, c1 backwards, d0 backwards."""
    polygons = bent_edges(rng, any_corners(rng))
    return {**as_curves({**polygons, "c1": polygons["c1"][::-1], "d0": polygons["d0"][::-1]}), "rtol": 1e-6}


@corners_agree.data
def a_speck_of_dust(rng):
    """A few micrometres long, written in metres, and open by a tenth."""
    return opened(rng, "c1", 0, 0.1, rtol=1e-3, unit=1e-6)


@corners_agree.data
def a_mountain(rng):
    """Millions long, and closed to nine digits."""
    return opened(rng, "c1", 0, 1e-9, unit=1e6)


@corners_agree.data
def rough_work(rng):
    """A gap of three hundredths where a tenth is forgiven."""
    return opened(rng, "d1", 0, 0.03, rtol=0.1)


@corners_agree.data(blind=True)
def unit_square(rng):
    lines = {
        "c0": ([0, 0, 0], [1, 0, 0]),
        "c1": ([0, 1, 0], [1, 1, 0]),
        "d0": ([0, 0, 0], [0, 1, 0]),
        "d1": ([1, 0, 0], [1, 1, 0]),
    }
    return {**{name: dx.Line(*ends) for name, ends in lines.items()}, "rtol": 1e-6}


@corners_agree.mistake("head_to_tail", credit=0.5)
def _(c0, c1, d0, d1, rtol):
    """You asked whether the curves can be walked once round, head to tail, as many CAD systems want them. Here all four run
    with growing u or w. Which end of c1 should meet d0, and which end of d0 is that?"""
    ends = [(c0(1.0), d1(0.0)), (d1(1.0), c1(0.0)), (c1(1.0), d0(0.0)), (d0(1.0), c0(0.0))]
    _, size = _gaps(c0, c1, d0, d1)
    return bool(max(np.linalg.norm(a - b) for a, b in ends) <= rtol * size)


@corners_agree.mistake("absolute_tolerance", credit=0.5)
def _(c0, c1, d0, d1, rtol):
    """You compare the right ends, and the gap with rtol itself. Then a speck of dust always closes, and a mountain never does.
    rtol has no unit and a gap has one. With what should the gap be compared?"""
    return bool(max(_gaps(c0, c1, d0, d1)[0]) <= rtol)


@corners_agree.mistake("two_corners", credit=0.5)
def _(c0, c1, d0, d1, rtol):
    """You looked at p00 and at p11, and the two other corners may gape as they like. A patch has four corners. Which two curves
    come together at u = 1, w = 0?"""
    gaps, size = _gaps(c0, c1, d0, d1)
    return bool(max(gaps[0], gaps[3]) <= rtol * size)


@corners_agree.mistake("one_corner_is_enough", credit=0.25)
def _(c0, c1, d0, d1, rtol):
    """For you it is enough that *some* corner is closed. A patch can be hung only where all four are: is it the largest or the
    smallest of the gaps that decides?"""
    gaps, size = _gaps(c0, c1, d0, d1)
    return bool(min(gaps) <= rtol * size)


@corners_agree.mistake("exactly_equal", credit=0.0)  # says False of all curves that were computed, as who looks at none does
def _(c0, c1, d0, d1, rtol):
    """You asked for ends that are equal to the last digit, and rtol never enters. Points that were computed in two ways differ
    by rounding, and a workshop forgives more. How large may a gap be here?"""
    return bool(max(_gaps(c0, c1, d0, d1)[0]) == 0)


@corners_agree.mistake("own_tolerance", credit=0.5)
def _(c0, c1, d0, d1, rtol):
    """You compare the right ends, with a tolerance of your own, such as the one that is built into a library function: rtol
    never enters. Whoever does rough work forgives a tenth. What do you say then?"""
    gaps, size = _gaps(c0, c1, d0, d1)
    return bool(max(gaps) <= 1e-6 * size)


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


@cubic_coons.data
def ferguson_edges(rng):
    """The edges of a bicubic patch of A5, cubic Hermite curves all four."""
    p = np.array([[[0, 0, 0], [1, 4, 1]], [[5, -1, 2], [6, 3, -1]]], dtype=float)
    pu = np.array([[[6, 1, 3], [3, -2, 5]], [[4, 0, -4], [7, 2, 1]]], dtype=float)
    pw = np.array([[[1, 5, 2], [-1, 3, 4]], [[0, 6, -3], [2, 3, -2]]], dtype=float)
    along_u = [dx.HermiteCurve(p[0, j], p[1, j], pu[0, j], pu[1, j]) for j in (0, 1)]
    along_w = [dx.HermiteCurve(p[i, 0], p[i, 1], pw[i, 0], pw[i, 1]) for i in (0, 1)]
    return {"c0": along_u[0], "c1": along_u[1], "d0": along_w[0], "d1": along_w[1]}


@cubic_coons.data
def three_sided(rng):
    """d0 is a single point: all that is left of a side."""
    p = any_corners(rng)
    p[0, 1] = p[0, 0]
    polygons = bent_edges(rng, p)
    return as_curves({**polygons, "d0": np.stack([p[0, 0], p[0, 0]])})


@cubic_coons.data(blind=True)
def flat_parallelogram(rng):
    """Straight sides, opposite ones alike: there both kinds of blending give the same."""
    p = np.array([[[0, 0, 0], [1, 3, 1]], [[4, 0, 1], [5, 3, 2]]], dtype=float)
    return {
        "c0": dx.Line(p[0, 0], p[1, 0]), "c1": dx.Line(p[0, 1], p[1, 1]),
        "d0": dx.Line(p[0, 0], p[0, 1]), "d1": dx.Line(p[1, 0], p[1, 1]),
    }  # fmt: skip


def _linear(t):
    """1 - t and t."""
    t = np.asarray(t, dtype=float)[..., np.newaxis]
    return 1 - t, t


def _cubic(t):
    """F1 and F2."""
    t = np.asarray(t, dtype=float)[..., np.newaxis]
    return 2 * t**3 - 3 * t**2 + 1, 3 * t**2 - 2 * t**3


def _coons(u, w, c0, c1, d0, d1, along_u=_cubic, along_w=_cubic, flat=_cubic, sign=-1):
    """Coons' three parts, each with blending functions of its own, the last one with a sign."""
    (a, b), (c, d), (e, f), (g, h) = along_w(w), along_u(u), flat(u), flat(w)
    corners = e * g * c0(0.0) + f * g * c0(1.0) + e * h * c1(0.0) + f * h * c1(1.0)
    return a * c0(u) + b * c1(u) + c * d0(w) + d * d1(w) + sign * corners


@cubic_coons.mistake("bilinear_correction", credit=0.5)
def _(u, w, c0, c1, d0, d1):
    """Both sums of two curves are mixed as they should be; what you take away is still mixed by 1 - t and t. Your edges are no
    longer the given ones. Walk along w = 0: which part has to cancel d0 and d1 there?"""
    return _coons(u, w, c0, c1, d0, d1, flat=_linear)


@cubic_coons.mistake("linear_blends", credit=0.5)
def _(u, w, c0, c1, d0, d1):
    """Yours is the Coons patch with 1 - t and t. The four edges are right, the inside is not the one that is asked for: two
    such patches meet with a crease. Which functions are level at their ends?"""
    return _coons(u, w, c0, c1, d0, d1, _linear, _linear, _linear)


@cubic_coons.mistake("only_w_cubic", credit=0.5)
def _(u, w, c0, c1, d0, d1):
    """Right in one direction only: c0 and c1 are mixed by the cubics, but d0 and d1 still by 1 - u and u, in what you add and
    in what you take away. The edges are right. How does your patch leave the edge u = 0?"""
    s, t = _linear(u), _cubic(w)
    corners = s[0] * (t[0] * c0(0.0) + t[1] * c1(0.0)) + s[1] * (t[0] * c0(1.0) + t[1] * c1(1.0))
    return t[0] * c0(u) + t[1] * c1(u) + s[0] * d0(w) + s[1] * d1(w) - corners


@cubic_coons.mistake("no_correction", credit=0.5)
def _(u, w, c0, c1, d0, d1):
    """You mixed with the right functions, added both sums, and stopped there. At a corner each of the sums gives the corner, so
    you have it twice. What is contained in both?"""
    return _coons(u, w, c0, c1, d0, d1, sign=0)


@cubic_coons.mistake("correction_added", credit=0.5)
def _(u, w, c0, c1, d0, d1):
    """All three parts are there, with the right functions, and the part of the corners has the wrong sign: you have each corner
    three times. Put u = w = 0 in: how often does the corner come out?"""
    return _coons(u, w, c0, c1, d0, d1, sign=1)


@cubic_coons.mistake("blends_exchanged", credit=0.25)
def _(u, w, c0, c1, d0, d1):
    """Your cubics stand at the wrong pair: c0 and c1 are mixed by functions of u, d0 and d1 by functions of w. On the way from
    the edge c0 to the edge c1, which parameter grows?"""
    (a, b), (c, d) = _cubic(u), _cubic(w)
    corners = a * c * c0(0.0) + b * c * c0(1.0) + a * d * c1(0.0) + b * d * c1(1.0)
    return a * c0(u) + b * c1(u) + c * d0(w) + d * d1(w) - corners


@cubic_coons.mistake("swap_uw", credit=0.5)
def _(u, w, c0, c1, d0, d1):
    """The right surface with the two parameters exchanged: your c0 is the edge u = 0. In this course a curve named c runs along
    u, one named d along w. Which parameter did you hand to c0?"""
    return _coons(w, u, c0, c1, d0, d1)


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


@coons_bezier_net.built_from(elevate_u)
def _(c0, c1, d0, d1, elevate_u):
    """Needs no other task; but who raises degrees need not know the shares: each of the three parts has degree 1 across."""

    def rows(net, count):
        for _ in range(count - len(net)):
            net = elevate_u(net)
        return net

    def columns(net, count):
        return np.swapaxes(rows(np.swapaxes(net, 0, 1), count), 0, 1)

    m, n = len(c0), len(d0)
    flat = np.array([[c0[0], c1[0]], [c0[-1], c1[-1]]], dtype=float)
    return columns(np.stack([c0, c1], axis=1), n) + rows(np.stack([d0, d1]), m) - columns(rows(flat, m), n)


def _parts(c0, c1, d0, d1, s=None, t=None):
    """Nets of the ruled surface from c0 to c1, of the one from d0 to d1, and of the bilinear surface of the corners."""
    c0, c1, d0, d1 = (np.asarray(points, dtype=float) for points in (c0, c1, d0, d1))
    s = np.linspace(0, 1, len(c0))[:, None, None] if s is None else s
    t = np.linspace(0, 1, len(d0))[None, :, None] if t is None else t
    across_w = (1 - t) * c0[:, None] + t * c1[:, None]
    across_u = (1 - s) * d0[None] + s * d1[None]
    flat = (1 - s) * (1 - t) * c0[0] + s * (1 - t) * c0[-1] + (1 - s) * t * c1[0] + s * t * c1[-1]
    return across_w, across_u, flat


def _net(c0, c1, d0, d1, s=None, t=None):
    across_w, across_u, flat = _parts(c0, c1, d0, d1, s, t)
    return across_w + across_u - flat


def any_polygons(rng, m, n):
    """Four control polygons c0, c1 (m, 3) and d0, d1 (n, 3) that meet in four corners."""
    p = any_corners(rng)

    def between(a, b, count):
        inner = a + np.linspace(0, 1, count)[1:-1, None] * (b - a)
        return np.concatenate([[a], inner + rng.uniform(0.5, 1.5, inner.shape) * rng.choice([-1.0, 1.0], inner.shape), [b]])

    return {
        "c0": between(p[0, 0], p[1, 0], m), "c1": between(p[0, 1], p[1, 1], m),
        "d0": between(p[0, 0], p[0, 1], n), "d1": between(p[1, 0], p[1, 1], n),
    }  # fmt: skip


@coons_bezier_net.data
def bicubic(rng):
    return any_polygons(rng, 4, 4)


@coons_bezier_net.data
def quartic_by_cubic(rng):
    return any_polygons(rng, 5, 4)


@coons_bezier_net.data
def quadratic_by_quintic(rng):
    return any_polygons(rng, 3, 6)


@coons_bezier_net.data(blind=True)
def translational(rng):
    """One polygon carried along another: opposite edges are alike."""
    c = np.array([[0, 0, 0], [1, 0, 2], [2, 1, 2], [3, 0, 0]], dtype=float)
    d = np.array([[0, 0, 0], [0, 1, 1], [1, 2, 1], [1, 3, -1]], dtype=float)
    return {"c0": c, "c1": c + d[-1], "d0": d, "d1": d + c[-1]}


@coons_bezier_net.mistake("zero_twist", credit=0.5)
def _(c0, c1, d0, d1):
    """The edges are right. Inside you completed parallelograms: neighbour plus neighbour minus the nearest corner. That makes
    every twist zero, which is Ferguson's choice. Coons mixes each point from *all four* edges: where do c1 and d1 enter near
    the corner p00?"""
    net = _net(c0, c1, d0, d1)
    m, n = len(c0), len(d0)
    for i in range(1, m - 1):
        for j in range(1, n - 1):
            c, d = (c0 if 2 * j < n else c1), (d0 if 2 * i < m else d1)
            net[i, j] = c[i] + d[j] - c[0 if 2 * i < m else -1]
    return net


@coons_bezier_net.mistake("one_too_many", credit=0.5)
def _(c0, c1, d0, d1):
    """Your shares are i over the number of *points*. They grow from 0 and never reach 1, and so your far edges are not the
    given ones. A row of four points has three legs: which share belongs to the last point?"""
    s, t = np.arange(len(c0)) / len(c0), np.arange(len(d0)) / len(d0)
    return _net(c0, c1, d0, d1, s[:, None, None], t[None, :, None])


@coons_bezier_net.mistake("no_correction", credit=0.5)
def _(c0, c1, d0, d1):
    """You added the nets of the two ruled surfaces. Each of them has the corner points, so you have these twice, and your net
    holds none of the four polygons. What do both nets contain?"""
    across_w, across_u, _ = _parts(c0, c1, d0, d1)
    return across_w + across_u


@coons_bezier_net.mistake("averaged", credit=0.25)
def _(c0, c1, d0, d1):
    """You took the mean of the nets of the two ruled surfaces. The corners are right; along an edge you have half the polygon
    and half a straight line. Which net has to be taken away from the *sum*?"""
    across_w, across_u, _ = _parts(c0, c1, d0, d1)
    return (across_w + across_u) / 2


@coons_bezier_net.mistake("correction_added", credit=0.5)
def _(c0, c1, d0, d1):
    """All three nets are there, and the one of the corners has the wrong sign. Look at your first point: how many times does
    the corner come out, and how often should it?"""
    across_w, across_u, flat = _parts(c0, c1, d0, d1)
    return across_w + across_u + flat


@coons_bezier_net.mistake("one_ruled", credit=0.25)
def _(c0, c1, d0, d1):
    """Yours is the net of the ruled surface between c0 and c1; d0 and d1 never enter, and your edges u = 0 and u = 1 are
    straight. What do they add?"""
    return _parts(c0, c1, d0, d1)[0]


@coons_bezier_net.mistake("transposed", credit=0.5)
def _(c0, c1, d0, d1):
    """You have the right net with rows and columns exchanged. The first index belongs to u, and c0 runs along u: which index should
    change on the way along c0?"""
    return np.swapaxes(_net(c0, c1, d0, d1), 0, 1)
