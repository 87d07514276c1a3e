"""Nets: cut a Bezier patch in two, raise its degree, one piece of a uniform B-spline, from sixteen points to control points.

A little over 400 lines, for the four share their nets, and each stands here whole with its mistakes.
"""

from math import comb

import directrix as dx
import numpy as np

from autograder.exercise import exercise

# The nets of A6: four by four points, and four by three.
BP = np.array([
    [[-2, 2, 2], [1, 2, -2], [-2, 7, 2], [-1, 14, -2]],
    [[1, 0, -2], [5, 3, 0], [1, 9, 1], [3, 11, 0]],
    [[5, 0, 0], [4, 4, 2], [8, 6, -2], [5, 13, -1]],
    [[7, 1, 1], [11, 3, -2], [8, 9, -1], [7, 11, 2]],
], dtype=float)  # fmt: skip
BP3 = np.array([
    [[0, 0, -1], [2, 4, 1], [-1, 7, -2]],
    [[3, -2, -2], [5, 2, -1], [3, 8, 0]],
    [[8, 2, 0], [8, 3, 0], [5, 9, 2]],
    [[8, 0, 1], [11, 5, 1], [11, 8, -2]],
], dtype=float)  # fmt: skip


def any_net(rng, m, n):
    """A random net (m, n, 3), bent and shaken."""
    P = np.stack([*np.meshgrid(2.5 * np.arange(m), 3.5 * np.arange(n), indexing="ij"), np.zeros((m, n))], axis=-1)
    P[..., 2] = 0.5 * P[..., 0] - 0.3 * P[..., 1] + 0.1 * P[..., 0] * P[..., 1]
    return P + rng.uniform(0.4, 1.2, P.shape) * rng.choice([-1.0, 1.0], P.shape)


def lattice():
    """A regular net (4, 4, 3): P[i, j] = (i, j, 0)."""
    return np.stack([*np.meshgrid(np.arange(4.0), np.arange(4.0), indexing="ij"), np.zeros((4, 4))], axis=-1)


# S5 --------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Cut a Bezier patch in two", kind="net", accept={"close": 0.8})
def bezier_split(P, u0):
    """Return the control nets of the two pieces into which the curve u = u0 cuts a Bezier patch.

    Each piece is a Bezier patch of the same degrees, with parameters of its own in [0, 1] that run in the same directions as u and
    w of the whole. The first piece is the one from u = 0 to u = u0.

    P : control points, an array of shape (m, n, 3), first index along u
    u0 : where to cut, a number between 0 and 1

    Returns two arrays of shape (m, n, 3): first, second.
    """
    first, second = dx.split_bezier(dx.BezierPatch(P), u=u0)
    return first.control_net, second.control_net


@bezier_split.data
def lecture(rng):
    return {"P": BP, "u0": 0.3}


@bezier_split.data
def mixed_degrees(rng):
    return {"P": any_net(rng, 5, 3), "u0": rng.uniform(0.6, 0.8)}


@bezier_split.data
def two_rows(rng):
    """Degree 1 in u: a ruled surface."""
    return {"P": any_net(rng, 2, 4), "u0": rng.uniform(0.2, 0.4)}


@bezier_split.data(blind=True)
def in_the_middle(rng):
    return {"P": BP3, "u0": 0.5}


def _cut(P, u0):
    """Both nets, by de Casteljau: the first points of each round, and the last ones in reverse."""
    first, last = [P[0]], [P[-1]]
    while len(P) > 1:
        P = (1 - u0) * P[:-1] + u0 * P[1:]
        first.append(P[0])
        last.append(P[-1])
    return np.stack(first), np.stack(last[::-1])


def _bernstein(t, n):
    """The n Bernstein functions of degree n - 1, shape t.shape + (n,)."""
    t = np.asarray(t, dtype=float)[..., np.newaxis]
    i = np.arange(n)
    return np.array([comb(n - 1, k) for k in i]) * t**i * (1 - t) ** (n - 1 - i)


@bezier_split.mistake("second_reversed", credit=0.75)
def _(P, u0):
    """Nearly: your first piece is right, and the second one runs backwards. The last points of each round come up from the far
    end towards the cut. Where should the second piece begin?"""
    first, second = _cut(P, u0)
    return first, second[::-1]


@bezier_split.mistake("always_in_the_middle", credit=0.5)
def _(P, u0):
    """You cut well, always at u = 1/2: u0 never enters. A leg of the polygon is halved only when the cut is in the middle.
    Which share of the leg belongs to u0?"""
    return _cut(P, 0.5)


@bezier_split.mistake("points_not_controls", credit=0.25)
def _(P, u0):
    """Your nets are points *on* the two pieces, at equal steps. They begin and end where they should, but the control points of
    a bent piece lie off the surface. Which points does de Casteljau's scheme leave at its rims?"""
    steps, across = np.linspace(0, 1, len(P)), _bernstein(np.linspace(0, 1, P.shape[1]), P.shape[1])
    pieces = u0 * steps, u0 + (1 - u0) * steps
    first, second = (np.einsum("ai,bj,ijk->abk", _bernstein(t, len(P)), across, P) for t in pieces)
    return first, second


@bezier_split.mistake("cut_in_w", credit=0.5)
def _(P, u0):
    """A clean cut, in the other direction: you cut along w. The first index of P belongs to u, and it is the rows P[0], P[1],
    ... that are mixed with each other. Which index shrinks in your rounds?"""
    first, second = _cut(np.swapaxes(P, 0, 1), u0)
    return np.swapaxes(first, 0, 1), np.swapaxes(second, 0, 1)


@bezier_split.mistake("pieces_exchanged", credit=0.75)
def _(P, u0):
    """Both nets are right, and you hand them over in the other order. The first piece begins where the whole patch begins.
    Which of yours holds P[0]?"""
    first, second = _cut(P, u0)
    return second, first


@bezier_split.mistake("shares_exchanged", credit=0.5)
def _(P, u0):
    """You cut at 1 - u0: in each step your two shares have changed places. For a small u0 the new point should lie close to the
    *first* of the two. Which share does that one get?"""
    return _cut(P, 1 - u0)


@bezier_split.mistake("one_round", credit=0.25)
def _(P, u0):
    """You cut the polygon: each of your pieces is a part of the old net, with one new row between. Cutting a *curve* takes as
    many rounds as it has degrees, each on the points of the round before. What do you do with the new points?"""
    steps = np.linspace(0, 1, len(P))
    return tuple(
        np.stack([(1 - f) * P[i] + f * P[i + 1] for t in piece for i, f in [_leg(t, len(P))]])
        for piece in (u0 * steps, u0 + (1 - u0) * steps)
    )


def _leg(t, n):
    """The leg of a polygon of n points on which the parameter t lies, and where."""
    i = min(int(t * (n - 1)), n - 2)
    return i, t * (n - 1) - i


# S6 --------------------------------------------------------------------------------------------------------------------------


@exercise(points=4, title="One degree more", kind="net", accept={"close": 0.8})
def elevate_u(P):
    """Return the control net of the same Bezier patch with its degree in u raised by one: the same surface, one more row.

    P : control points, an array of shape (m, n, 3), first index along u

    Returns an array of shape (m + 1, n, 3).
    """
    return dx.elevate(dx.BezierPatch(P), u=1).control_net


@elevate_u.data
def lecture(rng):
    return {"P": BP}


@elevate_u.data
def mixed_degrees(rng):
    return {"P": any_net(rng, 5, 3)}


@elevate_u.data
def quadratic(rng):
    return {"P": any_net(rng, 3, 4)}


@elevate_u.data(blind=True)
def two_rows(rng):
    """The one new row lies in the middle."""
    return {"P": any_net(rng, 2, 4)}


def _mixed(P, share):
    """Row i from the old rows i - 1 and i, of which the first gets share[i]."""
    before, after = np.concatenate([P[:1], P]), np.concatenate([P, P[-1:]])
    share = np.reshape(share, (-1, 1, 1))
    return share * before + (1 - share) * after


@elevate_u.mistake("degree_for_points", credit=0.5)
def _(P):
    """Your shares are i over the old *degree*: your last inner row is an old row, and your last row stands twice. They should
    be spread over all new legs evenly. How many legs has the new polygon?"""
    return _mixed(P, np.minimum(np.arange(len(P) + 1) / (len(P) - 1), 1))


@elevate_u.mistake("midpoints", credit=0.5)
def _(P):
    """The ends are right, and each of your inner rows lies half-way between two old ones. That holds for a straight line only:
    the shares change from row to row. Should the first new inner row lie closer to P[0] or to P[1]?"""
    share = np.full(len(P) + 1, 0.5)
    share[[0, -1]] = 0, 1
    return _mixed(P, share)


@elevate_u.mistake("elevated_in_w", credit=0.5)
def _(P):
    """You raised the degree well, in the other direction: you have one more column. The first index belongs to u, so it is one
    more *row* that is asked for. Which axis did you mix along?"""
    Q = np.swapaxes(P, 0, 1)
    return np.swapaxes(_mixed(Q, np.arange(len(Q) + 1) / len(Q)), 0, 1)


@elevate_u.mistake("shares_exchanged", credit=0.5)
def _(P):
    """Your two shares have changed places. Put i = 1 in, for many points: the new row should lie close to P[1], only a little
    on the way back to P[0]. Where does yours lie?"""
    share = 1 - np.arange(len(P) + 1) / len(P)
    share[[0, -1]] = 0, 1
    return _mixed(P, share)


@elevate_u.mistake("row_repeated", credit=0.25)
def _(P):
    """You have one more row: the last one, twice. A Bezier patch with a doubled row is another surface, it lingers at that
    edge. All inner rows have to move: what is the same surface at u = 1/2?"""
    return np.concatenate([P, P[-1:]])


@elevate_u.mistake("points_on_the_surface", credit=0.25)
def _(P):
    """Your rows lie *on* the patch, at equal steps of u. Control points of a bent patch lie off it. Mix neighbouring control
    points instead: which two of the old rows should the new row i lie between?"""
    return np.einsum("ai,ijk->ajk", _bernstein(np.linspace(0, 1, len(P) + 1), len(P)), P)


# S7 --------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="One piece of a uniform B-spline", kind="surface")
def uniform_bicubic(u, w, P):
    """Return the points of one piece of a uniform bicubic B-spline surface: the piece that sixteen control points make.

    Order 4 (degree 3) in both directions, knots at equal distances and none of them repeated. So the piece passes, in general,
    through none of its points. u and w run over this one piece.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    P : control points, an array of shape (4, 4, 3), first index along u

    Returns the points, shape of u and w together + (3,).
    """
    knots = np.arange(8.0)
    return dx.BSplinePatch(P, 4, 4, knots, knots)(u, w)


@uniform_bicubic.data
def lecture(rng):
    return {"P": BP}


@uniform_bicubic.data
def any_piece(rng):
    return {"P": any_net(rng, 4, 4)}


@uniform_bicubic.data
def far_from_the_origin(rng):
    return {"P": any_net(rng, 4, 4) + rng.uniform(20, 30, 3)}


@uniform_bicubic.data(blind=True)
def regular_lattice(rng):
    return {"P": lattice()}


M_S = np.array([[-1, 3, -3, 1], [3, -6, 3, 0], [-3, 0, 3, 0], [1, 4, 1, 0]]) / 6
M_B = np.array([[-1, 3, -3, 1], [3, -6, 3, 0], [-3, 3, 0, 0], [1, 0, 0, 0]], dtype=float)
M_4 = np.array([[-9, 27, -27, 9], [18, -45, 36, -9], [-11, 18, -9, 2], [2, 0, 0, 0]]) / 2
CATMULL_ROM = np.array([[-1, 3, -3, 1], [2, -5, 4, -1], [-1, 0, 1, 0], [0, 2, 0, 0]]) / 2


def _patch(u, w, P, M, N=None):
    """U M P Nᵀ Wᵀ with descending powers."""
    U, W = (
        np.stack([t**3, t**2, t, np.ones_like(t)], axis=-1) for t in (np.asarray(u, dtype=float), np.asarray(w, dtype=float))
    )
    return np.einsum("...i,...j,ijk->...k", U @ M, W @ (M if N is None else N), P)


@uniform_bicubic.mistake("sixths_forgotten", credit=0.5)
def _(u, w, P):
    """The matrix is right but for the factor in front of it: your surface is 36 times too large. The four functions of a
    B-spline add up to 1 everywhere. What do yours add up to at t = 0?"""
    return _patch(u, w, P, 6 * M_S)


@uniform_bicubic.mistake("one_sixth_forgotten", credit=0.5)
def _(u, w, P):
    """Your surface is six times too large: the matrix stands on both sides of the net, and one of the two lacks its factor.
    With all control points equal, which point should come out?"""
    return _patch(u, w, P, M_S, 6 * M_S)


@uniform_bicubic.mistake("bezier", credit=0.5)
def _(u, w, P):
    """Yours is the Bezier patch of the sixteen points, and it passes through the four corners. With doubled knots at its ends
    the B-spline would do so too; these knots are all simple. How many of the functions differ from 0 at t = 0?"""
    return _patch(u, w, P, M_B)


@uniform_bicubic.mistake("through_inner_points", credit=0.5)
def _(u, w, P):
    """Your piece passes through the four inner points: that is the spline of Catmull and Rom. A B-spline passes through none,
    it only leans towards them. On a regular lattice both are the same. What are your four functions at t = 0?"""
    return _patch(u, w, P, CATMULL_ROM)


@uniform_bicubic.mistake("through_all_points", credit=0.25)
def _(u, w, P):
    """Your patch passes through all sixteen points: that is the point form, with the parameters 0, 1/3, 2/3, 1. A B-spline
    piece stays inside the hull of its control points, and touches none of them in general. Which matrix is it that belongs to
    order 4?"""
    return _patch(u, w, P, M_4)


@uniform_bicubic.mistake("matrix_transposed", credit=0.25)
def _(u, w, P):
    """You have the numbers of the right matrix, with its rows and columns exchanged. Each *row* belongs to a power of t, each
    column to a control point. Which column should add up to 0: does yours?"""
    return _patch(u, w, P, M_S.T)


@uniform_bicubic.mistake("powers_ascending", credit=0.25)
def _(u, w, P):
    """You have the right matrix, and its rows belong to t³, t², t and 1 in this order; yours go with the powers the other way
    round. Put t = 0 in: which row is left?"""
    return _patch(u, w, P, M_S[::-1])


@uniform_bicubic.mistake("swap_uw", credit=0.5)
def _(u, w, P):
    """The right piece with the two parameters exchanged: your u runs along the second index of P. In which direction do you go
    from the first corner when u alone grows?"""
    return _patch(w, u, P, M_S)


# S8 --------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="From sixteen points to a Bezier net", kind="net", accept={"close": 0.8})
def points16_to_bezier(P):
    """Return the control net of the bicubic Bezier patch that passes through sixteen points.

    P[i, j] is the point of the patch at u = i/3, w = j/3.

    P : points on the patch, an array of shape (4, 4, 3), first index along u

    Returns the control points, an array of shape (4, 4, 3).
    """
    return dx.to_bezier(dx.PointPatch(P)).control_net


@points16_to_bezier.data
def lecture(rng):
    return {"P": BP}


@points16_to_bezier.data
def any_points(rng):
    return {"P": any_net(rng, 4, 4)}


@points16_to_bezier.data(blind=True)
def regular_lattice(rng):
    return {"P": lattice()}


K = np.array([[6, 0, 0, 0], [-5, 18, -9, 2], [2, -9, 18, -5], [0, 0, 0, 6]]) / 6


def _both_sides(P, left, right):
    """left P rightᵀ, for each coordinate."""
    return np.einsum("ai,bj,ijk->abk", left, right, P)


@points16_to_bezier.mistake("points_as_controls", credit=0.0)
def _(P):
    """You handed the sixteen points back as control points. The patch of *that* net passes through its corners only; a regular
    lattice hides it. At u = 1/3 a Bezier curve mixes all four of its points: what has to come out?"""
    return np.array(P, dtype=float)


@points16_to_bezier.mistake("along_u_only", credit=0.5)
def _(P):
    """Half-way: along u your points are control points, along w they are still points on the patch. The matrix stands on both
    sides of the net. Look at your first row: is it a control polygon?"""
    return _both_sides(P, K, np.eye(4))


@points16_to_bezier.mistake("along_w_only", credit=0.5)
def _(P):
    """Half-way: along w your points are control points, along u they are still points on the patch. The matrix stands on both
    sides of the net. Look at your first column: is it a control polygon?"""
    return _both_sides(P, np.eye(4), K)


@points16_to_bezier.mistake("right_not_transposed", credit=0.5)
def _(P):
    """Along u all is right. On the other side of the net you have the same matrix as it is. In matrix form it has to be
    transposed there, for it is the *rows* of it that make the control points. Does your first row begin at P[0, 0]?"""
    return _both_sides(P, K, K.T)


@points16_to_bezier.mistake("matrix_transposed", credit=0.25)
def _(P):
    """You have the right matrix with rows and columns exchanged, on both sides. Each control point is a mix whose shares add up
    to 1. Do the shares in your rows, or in your columns?"""
    return _both_sides(P, K.T, K.T)


@points16_to_bezier.mistake("other_way", credit=0.5)
def _(P):
    """You went the other way: you took the sixteen points for control points and computed the points of that patch at 0, 1/3,
    2/3 and 1. Here the points on the patch are given. Which matrix undoes what you did?"""
    inverse = np.linalg.inv(K)
    return _both_sides(P, inverse, inverse)


@points16_to_bezier.mistake("transposed", credit=0.5)
def _(P):
    """The right control points with rows and columns exchanged. First index u, in what you get and in what you hand over. Where
    is your control point near P[1, 0]?"""
    return np.swapaxes(_both_sides(P, K, K), 0, 1)
