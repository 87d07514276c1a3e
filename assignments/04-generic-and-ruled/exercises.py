"""A4, generic and ruled surfaces: a curve carried along a curve, a free profile turned, four corners, two curves joined.

One file, and a long one: each exercise stands here whole, its reference, its data and its mistakes one below the other.
`arc`, `wig` and `top` are the curves of the lecture data. Oracle numbers: tests/assignments.
"""

from math import comb

import directrix as dx
import numpy as np

from autograder.exercise import exercise

TURN = 2 * np.pi


def arc(t):
    """The curve (2 cos πt, 1 + t², 3t(1 - t))."""
    return np.stack([2 * np.cos(np.pi * t), 1 + t**2, 3 * t * (1 - t)], axis=-1)


def wig(t):
    """The curve (1 + t, 2 - t², 0.5 + sin 2t); it does not start in the origin."""
    return np.stack([1 + t, 2 - t**2, 0.5 + np.sin(2 * t)], axis=-1)


def top(t):
    """The curve (3t - 1, cos 3t, 2 + t)."""
    return np.stack([3 * t - 1, np.cos(3 * t), 2 + t], axis=-1)


def bent(rng):
    """A random cubic that lies in no plane and whose ends differ in every coordinate."""
    return dx.BezierCurve(np.array([[1, 0.5, 1], [3, 1, 0], [4, 4, 3], [2, 5, 2]]) + rng.uniform(-0.3, 0.3, (4, 3)))


def climbing(rng):
    """A random cubic that starts and ends far from the origin and far from the curves of `bent`."""
    return dx.BezierCurve(np.array([[-2, 2, 4], [-1, 3, 5], [0, 1, 7], [3, 3, 8]]) + rng.uniform(-0.3, 0.3, (4, 3)))


def any_vector(rng, shortest=1.5, longest=4.0):
    """A random vector, each component well away from 0."""
    return rng.uniform(shortest, longest, 3) * rng.choice([-1.0, 1.0], 3)


def points(x, y, z):
    """Coordinates that broadcast against each other, as points of shape (..., 3)."""
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


def column(t):
    """A parameter with an axis of its own for x, y and z."""
    return np.asarray(t, dtype=float)[..., np.newaxis]


# A4.1 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="Generic sweep: a curve carried along a curve", kind="surface", accept={"moved": 0.25})
def translational_sweep(u, w, gen, path):
    """Return the points of the surface that gen sweeps when it is carried along path without turning.

    The generatrix starts in its own place, wherever path begins: S(u, 0) = gen(u). From there every point of it makes the
    movements of path. u runs along gen, w along path.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    gen, path : functions; gen(t) and path(t) give points for t in [0, 1], arrays of shape t.shape + (3,)

    Returns the points, shape of u and w together + (3,).
    """
    return dx.GenericSweep(gen, path)(u, w)


@translational_sweep.data
def lecture(rng):
    return {"gen": arc, "path": wig}


@translational_sweep.data
def any_two_curves(rng):
    return {"gen": bent(rng), "path": climbing(rng)}


@translational_sweep.data
def round_a_circle(rng):
    x, y, r = rng.uniform(1.5, 4.0), rng.uniform(1.5, 4.0), rng.uniform(1.5, 3.0)
    return {
        "gen": bent(rng),
        "path": lambda t: points(x + r * np.cos(TURN * t), y + r * np.sin(TURN * t), 0 * t),
    }


@translational_sweep.data(blind=True)
def path_from_the_origin(rng):
    return {"gen": arc, "path": lambda t: points(2 * t, t**2, np.sin(t))}


@translational_sweep.mistake("not_anchored", credit=0.5)
def _(u, w, gen, path):
    """You added the two curves as they stand, so your surface starts where the path begins, away from the generatrix. Only the
    *movement* along the path counts. How far has the path moved at w = 0?"""
    return gen(u) + path(w)


@translational_sweep.mistake("gen_anchored", credit=0.5)
def _(u, w, gen, path):
    """Your generatrix was lifted from its place and set on the path: its first point rides there. The statement leaves the
    generatrix where it is. Which of the two curves has to give up its starting point?"""
    return gen(u) - gen(np.float64(0.0)) + path(w)


@translational_sweep.mistake("average", credit=0.25)
def _(u, w, gen, path):
    """You took the mean of a point of one curve and a point of the other: a surface of half the size, somewhere between the two.
    In a sweep the generatrix keeps its size. Measure the edge w = 0 of yours."""
    return (gen(u) + path(w)) / 2


@translational_sweep.mistake("swap_uw", credit=0.5)
def _(u, w, gen, path):
    """The right idea with the two curves exchanged: your u runs along the path and your w along the generatrix. Hold w at 0
    and let u run: which curve do you see, and which does the statement want there?"""
    return gen(w) + path(u) - path(np.float64(0.0))


@translational_sweep.mistake("ruled_by_mistake", credit=0.25)
def _(u, w, gen, path):
    """You joined the two curves by straight lines: a ruled surface, which comes later in this notebook. Here nothing is
    straight unless a curve is: at every w the whole generatrix must appear again, only moved. Look at w = 1 of yours."""
    return (1 - column(w)) * gen(u) + column(w) * path(u)


@translational_sweep.mistake("both_anchored", credit=0.5)
def _(u, w, gen, path):
    """The right shape, starting in the origin: you took the starting point away from both curves. One of them must keep it,
    so that w = 0 shows that curve where it is. Which one?"""
    return gen(u) - gen(np.float64(0.0)) + path(w) - path(np.float64(0.0))


@translational_sweep.mistake("arrives_in_place", credit=0.5)
def _(u, w, gen, path):
    """The right shape in the wrong place: you measured the movement from the *end* of the path, so your generatrix arrives in
    its own place instead of leaving from it. What must be left of your formula at w = 0?"""
    return gen(u) + path(w) - path(np.float64(1.0))


# A4.2 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="Mixed form: a Bezier profile turned about z", kind="surface")
def vase(u, w, P):
    """Return the points of the vase whose profile is the Bezier curve of the control points P, turned once about the z axis.

    The profile gives the distance ρ from the axis and the height z: (ρ(u), z(u)) = Σ B_i(u) P[i], with the Bernstein functions
    B_i of degree m - 1. w turns it once round, from +x towards +y. ρ = 0 at an end makes a pole; ρ < 0 lies on the other side
    of the axis.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    P : control points (ρ_i, z_i), an array of shape (m, 2), m >= 2

    Returns the points, shape of u and w together + (3,).
    """
    P = np.asarray(P, dtype=float)
    return dx.CircularSweep(dx.BezierCurve(np.stack([P[:, 0], 0 * P[:, 0], P[:, 1]], axis=-1)), "z")(u, w)


def _profile(u, P):
    """ρ and z of the Bezier curve: Σ C(n, i) u^i (1 - u)^(n - i) P_i."""
    u, n = column(u), len(P) - 1
    curve = sum(comb(n, i) * u**i * (1 - u) ** (n - i) * P[i] for i in range(n + 1))
    return curve[..., 0], curve[..., 1]


def _turned(rho, z, angle):
    return points(rho * np.cos(angle), rho * np.sin(angle), z)


@vase.data
def lecture(rng):
    return {"P": [[1.0, 0.0], [3.0, 1.0], [0.5, 2.0], [1.5, 4.0]]}


@vase.data
def five_points(rng):
    return {"P": np.array([[1, 0], [4, 1], [3, 3], [0.5, 4], [2, 6]]) + rng.uniform(-0.3, 0.3, (5, 2))}


@vase.data
def closed_below(rng):
    """ρ = 0 at u = 0: a bowl with a pole."""
    P = np.array([[0, 0], [2.5, 0.5], [3.5, 3]]) + rng.uniform(-0.3, 0.3, (3, 2))
    P[0, 0] = 0.0
    return {"P": P}


@vase.data
def through_the_axis(rng):
    return {"P": np.array([[-2, 0.5], [1, 2], [2, 1.5], [3, 5]]) + rng.uniform(-0.3, 0.3, (4, 2))}


@vase.data(blind=True)
def straight_wall(rng):
    """Two points: a frustum, and all binomial coefficients are 1."""
    return {"P": [[2.0, 0.0], [1.0, 3.0]]}


@vase.mistake("no_binomials", credit=0.25)
def _(u, w, P):
    """You forgot the binomial coefficients: your weights do not add up to 1, and your profile sags towards the origin. Add up
    your weights at u = 1/2: what comes out for four points?"""
    t, n = column(u), len(P) - 1
    curve = sum(t**i * (1 - t) ** (n - i) * P[i] for i in range(n + 1))
    return _turned(curve[..., 0], curve[..., 1], TURN * np.asarray(w))


@vase.mistake("reversed", credit=0.5)
def _(u, w, P):
    """The right vase, its profile run from the last control point to the first. Put u = 0 into your formula: which weight is 1
    there, and which point does it belong to?"""
    return _turned(*_profile(u, P[::-1]), TURN * np.asarray(w))


@vase.mistake("rho_z_exchanged", credit=0.25)
def _(u, w, P):
    """You took the first column of P for the height and the second for the distance from the axis. It is the other way round:
    (ρ, z). How far from the axis does your vase begin?"""
    rho, z = _profile(u, P)
    return _turned(z, rho, TURN * np.asarray(w))


@vase.mistake("swap_uw", credit=0.5)
def _(u, w, P):
    """The right vase with the two parameters exchanged: your w climbs the profile and your u goes round. The generatrix is the
    profile; which parameter runs along it?"""
    return _turned(*_profile(w, P), TURN * np.asarray(u))


@vase.mistake("degrees", credit=0.5)
def _(u, w, P):
    """You turn by 360 w. NumPy's sine and cosine take radians, so your profile goes round more than 57 times and stops in the
    middle of a turn. What is a whole turn in radians?"""
    return _turned(*_profile(u, P), 360 * np.asarray(w))


@vase.mistake("no_2pi", credit=0.25)
def _(u, w, P):
    """You took w itself for the angle. w ends at 1, and one radian is less than a sixth of the way round: you have a sherd of the
    vase. Which angle brings the profile back to its start?"""
    return _turned(*_profile(u, P), np.asarray(w))


@vase.mistake("polygon", credit=0.25)
def _(u, w, P):
    """Your profile walks along the straight lines between the control points and has a corner at each. A Bezier curve only
    *leans* towards the inner ones: every point of it mixes all of P. How many of your control points lie on your profile?"""
    places = np.linspace(0.0, 1.0, len(P))
    rho, z = (np.interp(np.asarray(u, dtype=float), places, P[:, k]) for k in (0, 1))
    return _turned(rho, z, TURN * np.asarray(w))


# A4.3 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Bilinear surface: four corners", kind="surface")
def bilinear(u, w, p00, p01, p10, p11):
    """Return the points of the simplest surface through four corners: linear in u, linear in w.

    p_ij is the corner at u = i, w = j; so p01 is the corner at u = 0, w = 1. The corners need not lie in one plane.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    p00, p01, p10, p11 : the corners, arrays of shape (3,)

    Returns the points, shape of u and w together + (3,).
    """
    return dx.Bilinear(p00, p01, p10, p11)(u, w)


def _blend(u, w, p00, p01, p10, p11):
    u, w = column(u), column(w)
    return (1 - u) * (1 - w) * p00 + (1 - u) * w * p01 + u * (1 - w) * p10 + u * w * p11


@bilinear.data
def lecture(rng):
    return {"p00": [0.0, 0.0, 0.0], "p01": [0.0, 3.0, 1.0], "p10": [4.0, 0.0, 0.0], "p11": [5.0, 4.0, 2.0]}


@bilinear.data
def any_corners(rng):
    p00, p01, p10, p11 = np.array([[1, 1, 2], [0, 4, 3], [5, 0, 4], [7, 6, -1]]) + rng.uniform(-0.5, 0.5, (4, 3))
    return {"p00": p00, "p01": p01, "p10": p10, "p11": p11}


@bilinear.data
def two_corners_meet(rng):
    """A triangle: the whole edge w = 1 is one point."""
    apex = np.array([2, 3, 4]) + rng.uniform(-0.5, 0.5, 3)
    return {"p00": [1.0, -1.0, 0.5], "p01": apex, "p10": [4.0, 0.5, -1.0], "p11": apex}


@bilinear.data(blind=True)
def unit_square(rng):
    return {"p00": [0.0, 0.0, 0.0], "p01": [0.0, 1.0, 0.0], "p10": [1.0, 0.0, 0.0], "p11": [1.0, 1.0, 0.0]}


@bilinear.mistake("p01_p10", credit=0.5)
def _(u, w, p00, p01, p10, p11):
    """The right surface with p01 and p10 exchanged. The first index belongs to u, the second to w. Put u = 1, w = 0 into your
    formula: which corner comes out, and which should?"""
    return _blend(u, w, p00, p10, p01, p11)


@bilinear.mistake("around_the_loop", credit=0.25)
def _(u, w, p00, p01, p10, p11):
    """You read the corners as you would walk round the patch, and so two of them have changed places: your edges cross like a
    bow tie. The indices are no walk; each says at which u and which w its corner stands. Where is your p10?"""
    return _blend(u, w, p00, p11, p01, p10)


@bilinear.mistake("no_uw_term", credit=0.25)
def _(u, w, p00, p01, p10, p11):
    """You went from p00 along u and along w, and p11 never enters: yours is a flat parallelogram, right at three corners. Four
    points need four coefficients: a constant, one with u, one with w, and which one more?"""
    return np.asarray(p00) + column(u) * (p10 - p00) + column(w) * (p01 - p00)


@bilinear.mistake("lofts_added", credit=0.25)
def _(u, w, p00, p01, p10, p11):
    """You blended the corners once between the edges w = 0 and w = 1, once between u = 0 and u = 1, and added the two. Each of
    them is the whole surface already, so yours is twice as large. Add up your four weights at any (u, w)."""
    return 2 * _blend(u, w, p00, p01, p10, p11)


@bilinear.mistake("two_edges_averaged", credit=0.25)
def _(u, w, p00, p01, p10, p11):
    """You took the mean of a point on the edge from p00 to p10 and one on the edge from p00 to p01. p11 never enters, and what
    comes out is a small parallelogram. Does your surface pass through its corners?"""
    u, w = column(u), column(w)
    return ((1 - u) * p00 + u * p10 + (1 - w) * p00 + w * p01) / 2


@bilinear.mistake("p11_from_p00", credit=0.5)
def _(u, w, p00, p01, p10, p11):
    """All four terms are there, and right along the two edges that meet in p00. But in the uw term you went the whole way from
    p00 to p11, although at (1, 1) the u term and the w term have carried you most of it already. Where is your S(1, 1)?"""
    u, w = column(u), column(w)
    return p00 + u * (p10 - p00) + w * (p01 - p00) + u * w * (p11 - p00)


# A4.4 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Plane or not?", kind="label")
def bilinear_is_planar(p00, p01, p10, p11):
    """Return True when the bilinear patch of the four corners is planar, False when it is curved.

    The three edges from p00 to the other corners span a box. The patch is planar when the box has no volume. Numbers are
    rounded, so "no volume" means: at most 1e-9 times s³, where s is the length of the longest of the three edges. Then it
    makes no difference whether the corners are given in micrometres or in kilometres. Four equal points count as planar.

    p00, p01, p10, p11 : the corners, arrays of shape (3,)

    Returns True or False.
    """
    return bool(abs(_volume(p00, p01, p10, p11)) <= 1e-9 * _longest(p00, p01, p10, p11) ** 3)


def _volume(p00, p01, p10, p11):
    return np.dot(np.cross(np.subtract(p10, p00), np.subtract(p01, p00)), np.subtract(p11, p00))


def _longest(p00, p01, p10, p11):
    return max(np.linalg.norm(np.subtract(p, p00)) for p in (p01, p10, p11))


@bilinear_is_planar.data
def lecture(rng):
    return {"p00": [0.0, 0.0, 0.0], "p01": [0.0, 3.0, 1.0], "p10": [4.0, 0.0, 0.0], "p11": [5.0, 4.0, 2.0]}


@bilinear_is_planar.data
def tilted_quadrilateral(rng):
    return {"p00": [0.0, 0.0, 1.0], "p01": [1.0, 2.0, 2.0], "p10": [3.0, 0.0, 1.0], "p11": [5.0, 4.0, 3.0]}


@bilinear_is_planar.data
def on_the_floor(rng):
    return {"p00": [0.0, 0.0, 0.0], "p01": [0.0, 2.0, 0.0], "p10": [3.0, 0.0, 0.0], "p11": [5.0, 4.0, 0.0]}


@bilinear_is_planar.data
def tiny(rng):
    return {"p00": [0.0, 0.0, 0.0], "p01": [0.0, 3e-5, 1e-5], "p10": [4e-5, 0.0, 0.0], "p11": [5e-5, 4e-5, 2e-5]}


@bilinear_is_planar.data
def huge(rng):
    return {
        "p00": [1.0, 1.0, 1000001.0],
        "p01": [1000001.0, 2000001.0, 2000001.0],
        "p10": [3000001.0, 1.0, 1000001.0],
        "p11": [5000001.0, 4000001.0, 3000001.0],
    }


@bilinear_is_planar.data
def tenths(rng):
    """Planar, in numbers that no computer holds exactly: however the volume is worked out, it comes out near 1e-15, not 0."""
    return {"p00": [5.8, 7.7, 5.3], "p01": [7.6, 11.2, 7.8], "p10": [5.9, 9.7, 2.5], "p11": [6.41, 10.15, 4.09]}


@bilinear_is_planar.data
def any_plane(rng):
    p00, a, b = any_vector(rng, 10.0, 20.0), any_vector(rng), any_vector(rng)
    b = b + np.cross(a, any_vector(rng)) / 4  # never parallel to a
    return {"p00": p00, "p01": p00 + a, "p10": p00 + b, "p11": p00 + rng.uniform(1.2, 2.0) * a + rng.uniform(0.2, 0.8) * b}


@bilinear_is_planar.data
def any_saddle(rng):
    drawn = bilinear.data_sets[1].draw(rng)
    scale = 10.0 ** rng.uniform(-6, -4)
    return {name: scale * p for name, p in drawn.items()}


@bilinear_is_planar.data
def all_one_point(rng):
    p = any_vector(rng)
    return {"p00": p, "p01": p.copy(), "p10": p.copy(), "p11": p.copy()}


@bilinear_is_planar.data(blind=True)
def unit_square(rng):
    return {"p00": [0.0, 0.0, 0.0], "p01": [0.0, 1.0, 0.0], "p10": [1.0, 0.0, 0.0], "p11": [1.0, 1.0, 0.0]}


@bilinear_is_planar.data(blind=True)
def tilted_parallelogram(rng):
    return {"p00": [0.0, 0.0, 0.0], "p01": [0.0, 2.0, 1.0], "p10": [3.0, 0.0, 2.0], "p11": [3.0, 2.0, 3.0]}


@bilinear_is_planar.mistake("parallelogram", credit=0.25)
def _(p00, p01, p10, p11):
    """You asked whether p00 + p11 = p01 + p10, that is, for a parallelogram. Every parallelogram is planar, but most planar
    quadrilaterals are none. Draw any four points on a sheet of paper: what does your function say of them?"""
    return bool(np.allclose(np.add(p00, p11), np.add(p01, p10), rtol=1e-9, atol=0))


@bilinear_is_planar.mistake("absolute_tol", credit=0.5)
def _(p00, p01, p10, p11):
    """The right quantity, but you hold it against a fixed number. A volume is a length to the third power: measure the same patch in
    metres and in millimetres and it changes a thousand million times. What should the tolerance grow with?"""
    return bool(abs(_volume(p00, p01, p10, p11)) < 1e-9)


@bilinear_is_planar.mistake("always_planar", credit=0.0)
def _(p00, p01, p10, p11):
    """You say True of every four points. Three points always lie in a plane, four need not: a table with three legs stands
    firm, one with four may rock. Which of your corners could leave the plane of the other three?"""
    return True


@bilinear_is_planar.mistake("no_tolerance", credit=0.5)
def _(p00, p01, p10, p11):
    """The right quantity, but you compare it with exactly 0. Computers round: 0.1 + 0.2 is not 0.3, and a volume that should vanish comes
    out near 1e-15. How small is small enough, for corners of the size that you are given?"""
    return bool(_volume(p00, p01, p10, p11) == 0)


@bilinear_is_planar.mistake("nothing_left_out", credit=0.75)
def _(p00, p01, p10, p11):
    """Right for every patch that is one. When all four corners are the same point, your size s is 0 as well: a volume *below* 0
    times anything does not exist, and 0 divided by 0 is no number. Which sign of comparison lets 0 pass beside 0?"""
    return bool(abs(_volume(p00, p01, p10, p11)) < 1e-9 * _longest(p00, p01, p10, p11) ** 3)


@bilinear_is_planar.mistake("same_height", credit=0.25)
def _(p00, p01, p10, p11):
    """You compared the heights z: True only for a patch that lies level. A plane may be tilted in any way, and a roof is as
    planar as a floor. What do you get for four points on a roof?"""
    return bool(np.ptp([p00[2], p01[2], p10[2], p11[2]]) <= 1e-9 * _longest(p00, p01, p10, p11))


# A4.5 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Ruled surface: two curves joined by straight lines", kind="surface")
def ruled(u, w, c0, c1):
    """Return the points of the ruled surface between two curves: straight lines join points of equal parameter.

    S(u, 0) = c0(u) and S(u, 1) = c1(u); for fixed u the surface is a straight line, run evenly in w. Since points of *equal
    parameter* are joined, the surface depends on how the curves are parametrised and not on their shapes alone.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    c0, c1 : functions; c0(t) and c1(t) give points for t in [0, 1], arrays of shape t.shape + (3,)

    Returns the points, shape of u and w together + (3,).
    """
    return dx.Ruled(c0, c1)(u, w)


@ruled.data
def lecture(rng):
    return {"c0": arc, "c1": top}


@ruled.data
def any_two_curves(rng):
    return {"c0": bent(rng), "c1": climbing(rng)}


@ruled.data
def across(rng):
    """Two lines that pass each other: a patch of a hyperbolic paraboloid."""
    start, end = any_vector(rng), any_vector(rng)
    return {"c0": dx.Line([0.0, 0.0, 0.0], [3.0, 1.0, 0.5]), "c1": dx.Line(start + [0, 0, 6], 5 * np.sign(start) + end)}


@ruled.data(blind=True)
def to_a_point(rng):
    """c1 stands still: a cone. Where on c1 the lines arrive cannot be seen."""
    apex = any_vector(rng)
    return {"c0": arc, "c1": lambda t: apex + 0 * column(t)}


@ruled.mistake("ends_exchanged", credit=0.5)
def _(u, w, c0, c1):
    """The right surface, run backwards in w: your lines start on c1 and end on c0. Put w = 0 into your weights: which curve is
    left?"""
    return column(w) * c0(u) + (1 - column(w)) * c1(u)


@ruled.mistake("no_one_minus", credit=0.25)
def _(u, w, c0, c1):
    """You added the share w of c1 and took nothing away from c0. Right at w = 0, and then too long: at w = 1 you stand at the
    *sum* of the two points. What must two weights add up to?"""
    return c0(u) + column(w) * c1(u)


@ruled.mistake("one_reversed", credit=0.25)
def _(u, w, c0, c1):
    """One of your curves runs backwards, so that your lines cross over: each start is joined with the other's end. Points of
    *equal* parameter belong together. Which line leaves your c0(0), and where does it arrive?"""
    return (1 - column(w)) * c0(u) + column(w) * c1(1 - np.asarray(u, dtype=float))


@ruled.mistake("average", credit=0.25)
def _(u, w, c0, c1):
    """w never enters: you have the one curve halfway between the two, and no surface. Halfway is right for w = 1/2. How much of
    each curve should there be for any other w?"""
    return (c0(u) + c1(u)) / 2 + 0 * column(w)


@ruled.mistake("different_points", credit=0.25)
def _(u, w, c0, c1):
    """You asked the second curve at w. So w moves along a line and along c1 at the same time, and your lines are bent. Both
    ends of a ruling belong to the same parameter of the two curves: which one?"""
    return (1 - column(w)) * c0(u) + column(w) * c1(w)


@ruled.mistake("swap_uw", credit=0.5)
def _(u, w, c0, c1):
    """The right surface with the two parameters exchanged: your w runs along the curves and your u along the straight lines. Hold
    w at 0 and let u run: which curve should that be?"""
    return (1 - column(u)) * c0(w) + column(u) * c1(w)


@ruled.mistake("parallel_rulings", credit=0.25)
def _(u, w, c0, c1):
    """All your lines are parallel: you carried c0 along the one vector between the two starting points. That is a linear sweep,
    and of c1 it knows the first point only. Is your edge w = 1 the curve c1?"""
    return c0(u) + column(w) * (c1(np.float64(0.0)) - c0(np.float64(0.0)))


# A4.6 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="Two circles: cylinder, cone or hyperboloid", kind="surface", accept={"same set": 0.5})
def ruled_circles(u, w, r0, r1, h, phase):
    """Return the points of the ruled surface between two circles about the z axis, the second one started later by phase.

    c0 has radius r0, lies in z = 0 and starts on +x; c1 has radius r1, lies in z = h and starts at the angle phase from +x.
    Both run once round, from +x towards +y. Straight lines join points of equal u.
    With phase 0 this is a frustum, or a cylinder; with any other, a hyperboloid of one sheet; with phase π, a double cone.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    r0, r1 : radii, lengths above 0
    h : height of the second circle, a length above 0
    phase : angle at which the second circle starts, in radians; it may be negative

    Returns the points, shape of u and w together + (3,).
    """
    return _between(u, w, _circle(r0, 0.0, 0.0), _circle(r1, h, phase))


def _circle(r, z, start):
    return lambda t: points(r * np.cos(TURN * np.asarray(t) + start), r * np.sin(TURN * np.asarray(t) + start), z)


@ruled_circles.built_from(ruled)
def _(u, w, r0, r1, h, phase, ruled):
    return ruled(u, w, _circle(r0, 0.0, 0.0), _circle(r1, h, phase))


def _between(u, w, c0, c1):
    return dx.Ruled(c0, c1)(u, w)


@ruled_circles.data
def lecture(rng):
    return {"r0": 2.0, "r1": 1.5, "h": 3.0, "phase": 5 * np.pi / 12}


@ruled_circles.data
def any_phase(rng):
    return _hoops(rng, np.deg2rad(rng.uniform(50, 130)))


@ruled_circles.data
def negative_phase(rng):
    return _hoops(rng, -np.deg2rad(rng.uniform(50, 130)))


def _hoops(rng, phase):
    return {"r0": rng.uniform(0.8, 1.6), "r1": rng.uniform(2.0, 3.0), "h": rng.uniform(2.5, 5.0), "phase": phase}


@ruled_circles.data(blind=True)
def no_phase(rng):
    return _hoops(rng, 0.0)


@ruled_circles.data(blind=True)
def half_a_turn(rng):
    return _hoops(rng, np.pi)


@ruled_circles.mistake("phase_degrees", credit=0.5)
def _(u, w, r0, r1, h, phase):
    """You converted the phase to degrees. It is given in radians, and NumPy's sine and cosine take radians: your second circle
    starts somewhere else. At which angle from +x does the line for u = 0 arrive?"""
    return _between(u, w, _circle(r0, 0.0, 0.0), _circle(r1, h, np.rad2deg(phase)))


@ruled_circles.mistake("phase_ignored", credit=0.25)
def _(u, w, r0, r1, h, phase):
    """phase never enters, so your lines run straight up the side of a frustum. Turn the upper circle by the phase and every
    line leans over, and the surface gets a waist. Where does your line for u = 0 arrive?"""
    return _between(u, w, _circle(r0, 0.0, 0.0), _circle(r1, h, 0.0))


@ruled_circles.mistake("phase_negative", credit=0.5)
def _(u, w, r0, r1, h, phase):
    """This is the very same hyperboloid, ruled by its *other* family of lines: yours lean to the other side. Every point of
    it carries two straight lines. To which side does the statement turn the start of the second circle?"""
    return _between(u, w, _circle(r0, 0.0, 0.0), _circle(r1, h, -np.asarray(phase)))


@ruled_circles.mistake("phase_on_both", credit=0.25)
def _(u, w, r0, r1, h, phase):
    """You started *both* circles later by the phase. Then nothing leans: yours is a frustum that merely starts elsewhere. Only
    the second circle is turned. Where is your S(0, 0)?"""
    return _between(u, w, _circle(r0, 0.0, phase), _circle(r1, h, phase))


@ruled_circles.mistake("swap_uw", credit=0.5)
def _(u, w, r0, r1, h, phase):
    """The right surface with the two parameters exchanged: your w goes round the circles and your u along the straight lines.
    Which parameter runs along the curves of a ruled surface?"""
    return _between(w, u, _circle(r0, 0.0, 0.0), _circle(r1, h, phase))


@ruled_circles.mistake("twisted_frustum", credit=0.25)
def _(u, w, r0, r1, h, phase):
    """You let the radius and the angle change evenly with w. Then your curves wind round a frustum and are not straight. A ruling
    joins two *points*: mix the coordinates, not the angles. Is your S(0, 1/2) midway between S(0, 0) and S(0, 1)?"""
    w = np.asarray(w)
    angle = TURN * np.asarray(u) + phase * w
    rho = r0 + (r1 - r0) * w
    return points(rho * np.cos(angle), rho * np.sin(angle), h * w)


@ruled_circles.mistake("phase_on_first", credit=0.5)
def _(u, w, r0, r1, h, phase):
    """You turned the lower circle instead of the upper one. The waist is right, but your lines start at the phase and lean the
    other way. Where should S(0, 0) be?"""
    return _between(u, w, _circle(r0, 0.0, phase), _circle(r1, h, 0.0))
