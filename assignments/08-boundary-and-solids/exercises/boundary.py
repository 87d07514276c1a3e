"""Surfaces through boundary curves: the Coons patch, the Ferguson patch, and the twists that lead from one to the other.

Four curves of a Coons patch have to meet. So random ones start from four random corners, and each curve runs between two.
A few more than 400 lines, for the three share their data and their formulas.
"""

import directrix as dx
import numpy as np

from autograder.exercise import exercise

# Corners, tangents and twists of the lecture data in Mortenson's order, as in A5.
G44 = np.array([
    [[0, 0, 0], [1, 4, 1], [1, 5, 2], [-1, 3, 4]],
    [[5, -1, 2], [6, 3, -1], [0, 6, -3], [2, 3, -2]],
    [[6, 1, 3], [3, -2, 5], [2, 1, 6], [-3, 4, 2]],
    [[4, 0, -4], [7, 2, 1], [5, -2, 3], [1, 3, -7]],
], dtype=float)  # fmt: skip


def edges(p, pu, pw):
    """The four Hermite curves c0, c1, d0, d1 that bound a patch with these corners and tangents, each (2, 2, 3)."""
    along_u = [dx.HermiteCurve(p[0, j], p[1, j], pu[0, j], pu[1, j]) for j in (0, 1)]
    along_w = [dx.HermiteCurve(p[i, 0], p[i, 1], pw[i, 0], pw[i, 1]) for i in (0, 1)]
    return *along_u, *along_w


def any_corners(rng):
    """Corners (2, 2, 3) of a bent quadrilateral, 3 long and 4 wide, no two edges alike."""
    flat = np.array([[[0, 0, 0], [1, 4, 1]], [[3, -1, 2], [4, 3, -2]]], dtype=float)
    return flat + rng.uniform(-0.4, 0.4, (2, 2, 3))


def any_tangents(rng):
    """Tangents (2, 2, 3) along u and along w, that differ from corner to corner."""
    pu = np.array([[[5, 1, 4], [3, -2, 5]], [[4, 1, -4], [6, 2, 2]]], dtype=float) + rng.uniform(-0.4, 0.4, (2, 2, 3))
    pw = np.array([[[1, 5, 3], [-1, 3, 4]], [[0, 6, -3], [3, 3, -5]]], dtype=float) + rng.uniform(-0.4, 0.4, (2, 2, 3))
    return pu, pw


def column(t):
    """Parameters with an axis for the coordinates."""
    return np.asarray(t, dtype=float)[..., np.newaxis]


def hermite(t):
    """F1, F2, F3, F4 at t."""
    return 2 * t**3 - 3 * t**2 + 1, 3 * t**2 - 2 * t**3, t**3 - 2 * t**2 + t, t**3 - t**2


# A8.1 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="Coons patch", kind="surface")
def coons(u, w, c0, c1, d0, d1):
    """Return the points of the Coons patch through four boundary curves, with the blending functions 1 - t and t.

    c0 and c1 are the edges w = 0 and w = 1, so c0(u) = S(u, 0) and c1(u) = S(u, 1); d0 and d1 are the edges u = 0 and u = 1, so
    d0(w) = S(0, w) and d1(w) = S(1, w). All four run in the direction of growing u or w, and they meet in the four corners.
    They may be of any kind, and each of another one. A curve may be a single point.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    c0, c1, d0, d1 : functions; c0(t) gives points for t in [0, 1], an array of shape t.shape + (3,)

    Returns the points, shape of u and w together + (3,).
    """
    return dx.Coons(c0, c1, d0, d1)(u, w)


def _parts(u, w, c0, c1, d0, d1):
    """The ruled surface between c0 and c1, the one between d0 and d1, and the bilinear surface of the corners."""
    s, t = column(u), column(w)
    across_w = (1 - t) * c0(u) + t * c1(u)
    across_u = (1 - s) * d0(w) + s * d1(w)
    flat = (1 - s) * (1 - t) * c0(0.0) + s * (1 - t) * c0(1.0) + (1 - s) * t * c1(0.0) + s * t * c1(1.0)
    return across_w, across_u, flat


@coons.data
def lecture(rng):
    return dict(zip(("c0", "c1", "d0", "d1"), edges(G44[:2, :2], G44[2:, :2], G44[:2, 2:]), strict=True))


@coons.data
def heights(rng):
    """Four parabolas that stand on the sides of the unit square (CPSC 645, Texas A&M, homework 3)."""
    c0 = dx.BezierCurve([[0, 0, 2], [0.5, 0, 3.5], [1, 0, 8]])
    c1 = dx.BezierCurve([[0, 1, 28], [0.5, 1, 23], [1, 1, 20]])
    d0 = dx.BezierCurve([[0, 0, 2], [0, 0.5, 9], [0, 1, 28]])
    d1 = dx.BezierCurve([[1, 0, 8], [1, 0.5, 14], [1, 1, 20]])
    return {"c0": c0, "c1": c1, "d0": d0, "d1": d1}


@coons.data
def four_kinds(rng):
    """A Bezier curve, a circular arc, a B-spline and a straight line."""
    p = any_corners(rng)

    def between(a, b, count, bulge):
        inner = a + np.linspace(0, 1, count)[1:-1, None] * (b - a) + bulge + rng.uniform(-0.4, 0.4, (count - 2, 3))
        return np.concatenate([[a], inner, [b]])

    chord = p[1, 1] - p[0, 1]
    side = np.cross(chord, [0.0, 1.0, 0.3])
    side *= np.linalg.norm(chord) / np.linalg.norm(side)
    half_angle = rng.uniform(0.6, 0.9)  # of the arc, in radians; its tangents meet at the middle point
    middle = (p[0, 1] + p[1, 1]) / 2 + side * np.tan(half_angle) / 2
    return {
        "c0": dx.BezierCurve(between(p[0, 0], p[1, 0], 4, [0.0, -1.0, 3.0])),
        "c1": dx.Conic(p[0, 1], middle, p[1, 1], np.cos(half_angle)),
        "d0": dx.BSplineCurve(between(p[0, 0], p[0, 1], 5, [-2.0, 0.0, 2.0]), 4),
        "d1": dx.Line(p[1, 0], p[1, 1]),
    }


@coons.data
def three_sided(rng):
    """d0 is a single point: all that is left of a side."""
    p = any_corners(rng)
    p[0, 1] = p[0, 0]
    c0, c1, _, d1 = edges(p, *any_tangents(rng))
    return {"c0": c0, "c1": c1, "d0": dx.BezierCurve([p[0, 0], p[0, 0]]), "d1": d1}


@coons.data(blind=True)
def straight_edges(rng):
    p = np.array([[[0, 0, 0], [0, 2, 1]], [[3, 0, 1], [3, 2, 0]]], dtype=float)
    return {
        "c0": dx.Line(p[0, 0], p[1, 0]), "c1": dx.Line(p[0, 1], p[1, 1]),
        "d0": dx.Line(p[0, 0], p[0, 1]), "d1": dx.Line(p[1, 0], p[1, 1]),
    }  # fmt: skip


@coons.mistake("no_correction", credit=0.5)
def _(u, w, c0, c1, d0, d1):
    """You added the two ruled surfaces, and stopped there. At a corner each of them already gives the corner, so you have it
    twice, and your surface passes through none of the four curves. What do both sums contain?"""
    across_w, across_u, _ = _parts(u, w, c0, c1, d0, d1)
    return across_w + across_u


@coons.mistake("averaged", credit=0.25)
def _(u, w, c0, c1, d0, d1):
    """You took the mean of the two ruled surfaces. The corners are right, and for straight edges everything is; but along
    c0 your surface is half c0 and half a straight line. Look at the middle of an edge that bulges."""
    across_w, across_u, _ = _parts(u, w, c0, c1, d0, d1)
    return (across_w + across_u) / 2


@coons.mistake("correction_added", credit=0.5)
def _(u, w, c0, c1, d0, d1):
    """All three parts are there, but the bilinear one has the wrong sign: you count every corner three times instead of once.
    Put u = w = 0 into your formula: how many times does the corner come out?"""
    across_w, across_u, flat = _parts(u, w, c0, c1, d0, d1)
    return across_w + across_u + flat


@coons.mistake("corners_exchanged", credit=0.5)
def _(u, w, c0, c1, d0, d1):
    """In your bilinear part two corners have changed places: p01 and p10. The first index belongs to u. Which curve passes
    through the corner u = 1, w = 0, and at which of its ends?"""
    across_w, across_u, _ = _parts(u, w, c0, c1, d0, d1)
    s, t = column(u), column(w)
    flat = (1 - s) * (1 - t) * c0(0.0) + s * (1 - t) * c1(0.0) + (1 - s) * t * c0(1.0) + s * t * c1(1.0)
    return across_w + across_u - flat


@coons.mistake("blends_exchanged", credit=0.25)
def _(u, w, c0, c1, d0, d1):
    """Your blending functions stand at the wrong pair: c0 and c1 are mixed by u, d0 and d1 by w. On your way from the edge c0 to
    the edge c1, which parameter grows from 0 to 1?"""
    s, t = column(u), column(w)
    _, _, flat = _parts(u, w, c0, c1, d0, d1)
    return (1 - s) * c0(u) + s * c1(u) + (1 - t) * d0(w) + t * d1(w) - flat


@coons.mistake("loop_orientation", credit=0.5)
def _(u, w, c0, c1, d0, d1):
    """You read the four curves head to tail, once round the patch, so that c1 and d0 run backwards. Here all four run with
    growing u or w. Compare your edge w = 1 with c1: at which end does yours begin?"""
    across_w, across_u, flat = _parts(u, w, c0, lambda t: c1(1 - np.asarray(t)), lambda t: d0(1 - np.asarray(t)), d1)
    return across_w + across_u - flat


@coons.also("loop_orientation")  # with the right corners in the correction
def _(u, w, c0, c1, d0, d1):
    _, _, flat = _parts(u, w, c0, c1, d0, d1)
    s, t = column(u), column(w)
    return (1 - t) * c0(u) + t * c1(1 - np.asarray(u)) + (1 - s) * d0(1 - np.asarray(w)) + s * d1(w) - flat


@coons.mistake("one_ruled", credit=0.25)
def _(u, w, c0, c1, d0, d1):
    """Yours is the ruled surface between c0 and c1: straight lines from one to the other, and d0 and d1 never enter. Look at your
    edges u = 0 and u = 1: should they be straight?"""
    return _parts(u, w, c0, c1, d0, d1)[0]


@coons.mistake("cubic_blends", credit=0.5)
def _(u, w, c0, c1, d0, d1):
    """Your patch has the four right edges and another inside: you mixed with the cubics F1 and F2. Such a patch exists, and its
    neighbours join it smoothly; but this one is asked for with the simplest functions that lead from 1 to 0 and from 0 to 1."""
    s, t = hermite(column(u))[:2], hermite(column(w))[:2]
    flat = sum(s[i] * t[j] * (c0, c1)[j](float(i)) for i in (0, 1) for j in (0, 1))
    return t[0] * c0(u) + t[1] * c1(u) + s[0] * d0(w) + s[1] * d1(w) - flat


@coons.mistake("swap_uw", credit=0.5)
def _(u, w, c0, c1, d0, d1):
    """The right surface with the two parameters exchanged: your c0 is the edge u = 0. In this course a curve named c runs along
    u, one named d along w. Which parameter did you hand to c0?"""
    across_w, across_u, flat = _parts(w, u, c0, c1, d0, d1)
    return across_w + across_u - flat


# A8.2 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="Ferguson patch", kind="surface")
def ferguson(u, w, p, pu, pw):
    """Return the points of the Ferguson patch: the bicubic Hermite patch of four corners and eight tangents, all twists zero.

    The first index of each block is the corner's u, the second its w: p[1, 0] is the corner u = 1, w = 0; pu[1, 0] is the
    derivative by u there and pw[1, 0] the derivative by w, both with their lengths and in the direction of growing u or w.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    p, pu, pw : corners, derivatives by u, derivatives by w, arrays of shape (2, 2, 3)

    Returns the points, shape of u and w together + (3,).
    """
    return dx.Ferguson(p, pu, pw)(u, w)


@ferguson.data
def lecture(rng):
    return {"p": G44[:2, :2], "pu": G44[2:, :2], "pw": G44[:2, 2:]}


@ferguson.data
def any_patch(rng):
    pu, pw = any_tangents(rng)
    return {"p": any_corners(rng), "pu": pu, "pw": pw}


@ferguson.data
def long_tangents(rng):
    pu, pw = any_tangents(rng)
    return {"p": any_corners(rng), "pu": rng.uniform(2.0, 3.0) * pu, "pw": rng.uniform(2.0, 3.0) * pw}


@ferguson.data(blind=True)
def flat_square(rng):
    p = [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]]
    return {"p": p, "pu": [[[1, 0, 0]] * 2] * 2, "pw": [[[0, 1, 0]] * 2] * 2}


def _ferguson(u, w, p, pu, pw):
    a, b = hermite(column(u)), hermite(column(w))
    ends = [(i, j) for i in (0, 1) for j in (0, 1)]
    return sum(a[i] * b[j] * p[i][j] + a[i + 2] * b[j] * pu[i][j] + a[i] * b[j + 2] * pw[i][j] for i, j in ends)


@ferguson.mistake("coons_instead", credit=0.5)
def _(u, w, p, pu, pw):
    """You have the Coons patch of the four Hermite edges: every edge is right, the inside is not, and at the centre the two
    even meet. Coons mixes with 1 - t and t. Which functions mix here, inside as well as on the edges?"""
    across_w, across_u, flat = _parts(u, w, *edges(p, pu, pw))
    return across_w + across_u - flat


@ferguson.mistake("tangents_exchanged", credit=0.5)
def _(u, w, p, pu, pw):
    """The corners are right, and the two blocks of tangents have changed places: you leave a corner along u with its pw. Which
    of them belongs to the functions of u, F3 and F4?"""
    return _ferguson(u, w, p, pw, pu)


@ferguson.mistake("unit_tangents", credit=0.5)
def _(u, w, p, pu, pw):
    """You made the tangents unit vectors. Their directions survive, but the length of a derivative is part of the data: it says
    how far the curve follows it. What is the derivative of your patch at a corner?"""
    return _ferguson(u, w, p, *(block / np.linalg.norm(block, axis=-1, keepdims=True) for block in (pu, pw)))


@ferguson.mistake("inward_at_far_end", credit=0.5)
def _(u, w, p, pu, pw):
    """At u = 1 and at w = 1 your tangents point back into the patch. Derivatives point along growing u or w everywhere, so at the
    far ends they lead *out* of the patch. Check the sign in front of your F4."""
    return _ferguson(u, w, p, [pu[0], -pu[1]], [[pw[0, 0], -pw[0, 1]], [pw[1, 0], -pw[1, 1]]])


@ferguson.mistake("bilinear_only", credit=0.25)
def _(u, w, p, pu, pw):
    """Yours is the bilinear surface of the four corners: straight edges, and no tangent ever enters. Look at an edge: does it
    leave its corner in the direction that is given?"""
    s, t = column(u), column(w)
    return (1 - s) * ((1 - t) * p[0, 0] + t * p[0, 1]) + s * ((1 - t) * p[1, 0] + t * p[1, 1])


@ferguson.mistake("no_tangents", credit=0.25)
def _(u, w, p, pu, pw):
    """You mixed the corners with F1 and F2 and left the tangents out. Your edges are straight, and the patch stands still at
    every corner. Two blocks of data have not been used: which of the F go with them?"""
    return _ferguson(u, w, p, 0 * pu, 0 * pw)


@ferguson.mistake("swap_uw", credit=0.5)
def _(u, w, p, pu, pw):
    """The right patch with the two parameters exchanged. The first index of p is the corner's u: walk along u from p[0, 0].
    At which corner do you arrive, and at which should you?"""
    return _ferguson(w, u, p, pu, pw)


@ferguson.mistake("thirds_forgotten", credit=0.5)
def _(u, w, p, pu, pw):
    """Your tangents are three times too long, as happens where each is added to its corner to give the next Bezier point. From a
    tangent to the leg of a control polygon there is a factor: what is the derivative of a cubic Bezier curve at its end?"""
    return _ferguson(u, w, p, 3 * pu, 3 * pw)


# A8.3 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Which twists make it a Coons patch?", kind="net", accept={"close": 0.8})
def coons_twists(G):
    """Return the four twists with which a Hermite patch is the Coons patch of its own four edges.

    The twist is the mixed derivative by u and w. Twists do not move the edges, they only shape the inside; the twists in G
    are therefore to be ignored.

    G : corners, tangents and twists in Mortenson's order, an array of shape (4, 4, 3): p = G[:2, :2], pw = G[:2, 2:],
        pu = G[2:, :2], each with index [u corner, w corner]

    Returns an array of shape (2, 2, 3), index [u corner, w corner].
    """
    # The mixed derivative of the Coons formula at its corners: the two ruled surfaces give a difference of tangents each, the
    # bilinear surface has one and the same twist everywhere (Adini's twists).
    along_w, along_u, flat = _twists(G)
    return along_w + along_u - flat


def _twists(G, pu=None, pw=None):
    """The twists of the two ruled surfaces and of the bilinear one; shapes (1, 2, 3), (2, 1, 3) and (3,)."""
    G = np.asarray(G, dtype=float)
    p = G[:2, :2]
    pu = G[2:, :2] if pu is None else pu
    pw = G[:2, 2:] if pw is None else pw
    return (pw[1] - pw[0])[np.newaxis], (pu[:, 1] - pu[:, 0])[:, np.newaxis], p[1, 1] - p[1, 0] - p[0, 1] + p[0, 0]


def _corner_data(p, pu, pw, twists=0.0):
    G = np.empty((4, 4, 3))
    G[:2, :2], G[2:, :2], G[:2, 2:], G[2:, 2:] = p, pu, pw, twists
    return G


@coons_twists.data
def lecture(rng):
    return {"G": G44}


@coons_twists.data
def any_patch(rng):
    return {"G": _corner_data(any_corners(rng), *any_tangents(rng), rng.uniform(-5, 5, (2, 2, 3)))}


@coons_twists.data(blind=True)
def translational(rng):
    """One curve carried along another: opposite edges are alike, and the twists are 0."""
    pu, pw = [[[2, 1, 3]] * 2, [[4, -1, -3]] * 2], [[[1, 2, 1], [0, 3, -2]]] * 2
    return {"G": _corner_data([[[0, 0, 0], [1, 4, 1]], [[5, -1, 2], [6, 3, 3]]], pu, pw)}


@coons_twists.mistake("no_correction", credit=0.5)
def _(G):
    """You added the twists of the two ruled surfaces. The Coons patch has a third part, and it has a twist as well: what is the
    mixed derivative of the bilinear surface of the corners?"""
    along_w, along_u, _ = _twists(G)
    return along_w + along_u


@coons_twists.mistake("bilinear_only", credit=0.25)
def _(G):
    """You gave the twist of the bilinear surface, the same at all four corners. The tangents never enter, and they say how the
    edges start and end. What do the two ruled surfaces add?"""
    return np.broadcast_to(_twists(G)[2], (2, 2, 3)).copy()


@coons_twists.mistake("halved", credit=0.5)
def _(G):
    """All your twists are half of the right ones, as if the patch were a *mean* of two surfaces. In Coons' formula the two
    ruled surfaces are added whole, and the bilinear one is taken away whole."""
    along_w, along_u, flat = _twists(G)
    return (along_w + along_u - flat) / 2


@coons_twists.mistake("correction_added", credit=0.5)
def _(G):
    """You added the twist of the bilinear surface. In the Coons patch that surface is taken *away*, as it is contained in both
    of the others; a derivative keeps the sign."""
    along_w, along_u, flat = _twists(G)
    return along_w + along_u + flat


@coons_twists.mistake("transposed", credit=0.5)
def _(G):
    """Your four vectors are the right ones, but two of them have changed places: the twist at u = 1, w = 0 stands where that at
    u = 0, w = 1 belongs. The first index is the corner's u."""
    along_w, along_u, flat = _twists(G)
    return np.swapaxes(along_w + along_u - flat, 0, 1)


@coons_twists.mistake("blocks_exchanged", credit=0.5)
def _(G):
    """Your differences run along the wrong sides: you compare pw at w = 0 with pw at w = 1, or you took the block of pu for that of
    pw, which comes to the same. The twist says how the derivative by w changes on the way along *u*. Between which corners?"""
    along_w, along_u, flat = _twists(G, pu=G[:2, 2:], pw=G[2:, :2])
    return along_w + along_u - flat


@coons_twists.mistake("zero", credit=0.0)
def _(G):
    """Your twists are all zero. That is Ferguson's choice, and it gives another surface on the same edges; only for a curve
    carried along another do the two agree. What is the mixed derivative of Coons' formula at a corner?"""
    return np.zeros((2, 2, 3))
