"""A6, Bezier: Bernstein functions, patches of any degrees, the curves on them, and the way to the Hermite form and back.

One file, and a long one: each exercise stands here whole, its reference, its data and its mistakes one below the other.
`BP` (4 x 4, cubic in both directions) and `BP3` (4 x 3, cubic by quadratic) are the nets of the lecture data; both are generic:
no row, column or corner can be mistaken for another. Lattices and flat nets hide most mistakes. Oracle numbers:
tests/assignments.
"""

from math import comb

import directrix as dx
import numpy as np

from autograder.exercise import exercise

BP = [
    [[-2, 2, 2], [1, 2, -2], [-2, 7, 2], [-1, 14, -2]],
    [[1, 0, -2], [5, 3, 0], [1, 9, 1], [3, 11, 0]],
    [[5, 0, 0], [4, 4, 2], [8, 6, -2], [5, 13, -1]],
    [[7, 1, 1], [11, 3, -2], [8, 9, -1], [7, 11, 2]],
]
BP3 = [
    [[0, 0, -1], [2, 4, 1], [-1, 7, -2]],
    [[3, -2, -2], [5, 2, -1], [3, 8, 0]],
    [[8, 2, 0], [8, 3, 0], [5, 9, 2]],
    [[8, 0, 1], [11, 5, 1], [11, 8, -2]],
]
# Corners, tangents and twists in the order of A5.4.
G_LECTURE = [
    [[0, 0, 0], [1, 4, 1], [1, 5, 2], [-1, 3, 4]],
    [[5, -1, 2], [6, 3, -1], [0, 6, -3], [2, 3, -2]],
    [[6, 1, 3], [3, -2, 5], [2, 1, 6], [-3, 4, 2]],
    [[4, 0, -4], [7, 2, 1], [5, -2, 3], [1, 3, -7]],
]
# The two ends of a row of four control points: the end point and its neighbour.
ENDS = ((0, 1), (3, 2))


def any_net(rng, m, n):
    """A random m x n net: a lattice 3 apart, every point moved by up to 1.2 along each axis, z by up to 2."""
    lattice = np.stack(np.broadcast_arrays(3.0 * np.arange(m)[:, None], 3.0 * np.arange(n)[None, :], 0.0), axis=-1)
    return lattice + rng.uniform(-1, 1, (m, n, 3)) * [1.2, 1.2, 2.0]


def lattice(m, n):
    """An m x n net of points 1 apart in the xy-plane."""
    return np.stack(np.broadcast_arrays(1.0 * np.arange(m)[:, None], 1.0 * np.arange(n)[None, :], 0.0), axis=-1)


def functions(n, t):
    """The n + 1 Bernstein functions as the lecture writes them, C(n,i) t^i (1-t)^(n-i), shape t.shape + (n+1,)."""
    t = np.asarray(t, dtype=float)[..., None]
    i = np.arange(n + 1)
    return _row_of_pascal(n) * t**i * (1 - t) ** (n - i)


def _row_of_pascal(n):
    return np.array([comb(n, i) for i in range(n + 1)], dtype=float)


def blended(along_u, along_w, P):
    """Σ_i Σ_j f_i(u) g_j(w) P_ij, from functions along the last axes: shapes (..., m), (..., n), (m, n, 3)."""
    return np.einsum("...i,...j,ijk->...k", along_u, along_w, P)


# A6.1 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=4, title="Bernstein functions", kind="basis", tolerance=1e-12, accept={"close": 0.8})
def bernstein(n, t):
    """Return all n + 1 Bernstein functions of degree n at the parameters t.

    B_i(t) = C(n, i) t^i (1 - t)^(n - i) for i = 0, 1, ..., n, where C(n, i) is the binomial coefficient; 0^0 counts as 1.

    n : degree, a whole number of 0 or more
    t : a number or an array of any shape, in [0, 1]

    Returns an array of the shape of t + (n + 1,), the functions along its last axis; pure numbers.
    """
    return functions(n, t)


@bernstein.data
def lecture(rng):
    return {"n": 3, "t": np.arange(11) / 10}


@bernstein.data
def any_degree(rng):
    return {"n": int(rng.integers(4, 9)), "t": np.array([0.0, *rng.uniform(0.05, 0.95, 5), 1.0])}


@bernstein.data
def one_number(rng):
    return {"n": 5, "t": rng.uniform(0.1, 0.3)}


@bernstein.data
def a_table_of_numbers(rng):
    return {"n": 2, "t": rng.uniform(0, 1, (3, 2))}


@bernstein.data
def degree_0(rng):
    return {"n": 0, "t": np.array([0.0, rng.uniform(0.2, 0.8), 1.0])}


@bernstein.data(blind=True)
def ends_only(rng):
    return {"n": 3, "t": np.array([0.0, 1.0])}


@bernstein.mistake("no_binomials", credit=0.5)
def _(n, t):
    """The powers are right, but each function stands there once: you forgot how often its product occurs when
    (t + (1 - t)) to the power n is multiplied out. Add up your row at t = 1/2: it should give 1."""
    return functions(n, t) / _row_of_pascal(n)


@bernstein.mistake("order_for_degree", credit=0.5)
def _(n, t):
    """Yours are the functions of degree n - 1, with a 0 to fill up the row: you took n for the *order*. Here n is the degree,
    the highest power of t that occurs. How many terms has a polynomial of degree n?"""
    t = np.asarray(t, dtype=float)
    lower = functions(n - 1, t) if n else np.empty((*t.shape, 0))
    return np.concatenate([lower, np.zeros((*t.shape, 1))], axis=-1)


@bernstein.mistake("power_typo", credit=0.5)
def _(n, t):
    """Both of your powers grow together, t^i and (1-t)^i. In each product there are n factors in all: if i of them are t, how
    many are left for 1 - t? Your first function is 1 everywhere; look at it at t = 1."""
    t = np.asarray(t, dtype=float)[..., None]
    return _row_of_pascal(n) * (t * (1 - t)) ** np.arange(n + 1)


@bernstein.mistake("nan_at_ends", credit=0.0)
def _(n, t):
    """Between the ends all is right, but at t = 0 and t = 1 you have a NaN: your powers go through logarithms, and 0 times
    the logarithm of 0 is not a number. A power with ** knows that 0 to the power 0 is 1."""
    t, i = np.asarray(t, dtype=float)[..., None], np.arange(n + 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return _row_of_pascal(n) * np.exp(i * np.log(t)) * np.exp((n - i) * np.log(1 - t))


@bernstein.mistake("reversed", credit=0.5)
def _(n, t):
    """The right functions in reverse order: you exchanged t and 1 - t. Which function should be 1 at t = 0, where the curve
    is at its first point?"""
    return functions(n, t)[..., ::-1]


@bernstein.mistake("one_short", credit=0.5)
def _(n, t):
    """You stop at i = n - 1, so the last function is missing. Python's range(n) ends before n. At t = 1 your row holds nothing
    but zeros: which point would a curve be at there?"""
    return functions(n, t)[..., :-1]


@bernstein.mistake("powers_only", credit=0.25)
def _(n, t):
    """The factor with 1 - t is missing: yours are powers of t with a number in front, and they grow without ever adding up to
    1. Look at t = 1: all of your functions are there, and only one should be."""
    return _row_of_pascal(n) * np.asarray(t, dtype=float)[..., None] ** np.arange(n + 1)


# A6.2 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="Bezier patch of any degrees", kind="surface")
def bezier_patch(u, w, P):
    """Return the points of the Bezier patch with the control net P.

    S(u, w) = Σ_i Σ_j B_i(u) B_j(w) P_ij: the first index of P runs with u, the second with w. The degrees are one less than
    the numbers of points, and need not be the same along u and along w.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    P : control net, an array of shape (m, n, 3); degree m - 1 in u and n - 1 in w

    Returns the points, shape of u and w together + (3,).
    """
    return dx.BezierPatch(P)(u, w)


@bezier_patch.built_from(bernstein)
def _(u, w, P, bernstein):
    m, n, _ = np.shape(P)
    return np.einsum("...i,...j,ijk->...k", bernstein(m - 1, u), bernstein(n - 1, w), P)


@bezier_patch.data
def lecture(rng):
    return {"P": BP}


@bezier_patch.data
def cubic_by_quadratic(rng):
    return {"P": BP3}


@bezier_patch.data
def any_net_of_3_by_5(rng):
    return {"P": any_net(rng, 3, 5)}


@bezier_patch.data
def any_bicubic_net(rng):
    return {"P": any_net(rng, 4, 4)}


@bezier_patch.data(blind=True)
def square_lattice(rng):
    return {"P": lattice(4, 4)}


@bezier_patch.mistake("transposed", credit=0.5)
def _(u, w, P):
    """The right patch with the two parameters exchanged: your u runs along the second index of the net. Put u = 1, w = 0 in:
    P[-1, 0] should come out. A flat list of 16 points exists in both orders in real programs; here the *shape* says it."""
    return dx.BezierPatch(P)(w, u)


@bezier_patch.mistake("no_binomials", credit=0.25)
def _(u, w, P):
    """The four corners are right, and inside your patch sinks towards the origin: the binomial coefficients are missing, so the
    weights of a point do not add up to 1. What should come out where all control points are equal?"""
    m, n, _ = np.shape(P)
    return blended(functions(m - 1, u) / _row_of_pascal(m - 1), functions(n - 1, w) / _row_of_pascal(n - 1), P)


@bezier_patch.mistake("reversed_u", credit=0.5)
def _(u, w, P):
    """The right patch, with u running backwards: you start at the far row of the net. Which row of P should the edge u = 0
    follow?"""
    return dx.BezierPatch(P)(1 - np.asarray(u), w)


@bezier_patch.mistake("net_piecewise", credit=0.25)
def _(u, w, P):
    """You drew the net itself: flat meshes that pass through *all* control points. A Bezier patch passes through its four
    corners; the other points only pull at it. On a regular lattice nobody sees the difference."""
    return blended(_hats(np.shape(P)[0], u), _hats(np.shape(P)[1], w), P)


def _hats(count, t):
    """The piecewise linear functions through ``count`` equally spaced places: 1 at one's own, 0 at all others."""
    return np.clip(1 - np.abs(np.asarray(t)[..., None] * (count - 1) - np.arange(count)), 0, 1)


@bezier_patch.mistake("elementwise", credit=0.25)
def _(u, w, P):
    """You multiplied B_i(u) by B_i(w), the same i in both, so only the diagonal of the net counts. *Every* function of u meets
    every function of w: 4 x 4 = 16 products for 16 points."""
    count = min(np.shape(P)[:2])
    return np.einsum(
        "...i,...i,ik->...k",
        functions(np.shape(P)[0] - 1, u)[..., :count],
        functions(np.shape(P)[1] - 1, w)[..., :count],
        np.asarray(P)[range(count), range(count)],
    )


@bezier_patch.mistake("corners_only", credit=0.25)
def _(u, w, P):
    """The four corners are right; the points between them never enter. Yours is the bilinear surface of the corners. What should
    happen to the patch when somebody pulls at an inner control point?"""
    return dx.Bilinear(P[0][0], P[0][-1], P[-1][0], P[-1][-1])(u, w)


@bezier_patch.mistake("count_for_degree", credit=0.5)
def _(u, w, P):
    """You took the *number* of points for the degree: m points make degree m - 1. Yours is one too high in both directions, one
    function of each row is left without a point, and the patch never reaches its far corner. Look at u = w = 1."""
    m, n, _ = np.shape(P)
    return blended(functions(m, u)[..., :m], functions(n, w)[..., :n], P)


# A6.3 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Curves on the patch", kind="net", tolerance=1e-10, accept={"close": 0.8})
def iso_curve_net(P, u0):
    """Return the control points of the curve on the Bezier patch of the net P along which u = u0 and w runs from 0 to 1.

    That curve is a Bezier curve of its own, Σ_j B_j(w) Q_j = S(u0, w), and Q_j = Σ_i B_i(u0) P_ij.

    P : control net, an array of shape (m, n, 3)
    u0 : where u is held, a number in [0, 1]

    Returns the control points Q, an array of shape (n, 3), as many as the net has along w.
    """
    return np.einsum("i,ijk->jk", functions(np.shape(P)[0] - 1, u0), P)


@iso_curve_net.built_from(bernstein)
def _(P, u0, bernstein):
    return np.einsum("i,ijk->jk", bernstein(np.shape(P)[0] - 1, u0), P)


@iso_curve_net.data
def lecture(rng):
    return {"P": BP, "u0": 0.3}


@iso_curve_net.data
def cubic_by_quadratic(rng):
    return {"P": BP3, "u0": rng.uniform(0.55, 0.8)}


@iso_curve_net.data
def any_net_of_3_by_5(rng):
    return {"P": any_net(rng, 3, 5), "u0": rng.uniform(0.15, 0.35)}


@iso_curve_net.data
def far_edge(rng):
    return {"P": any_net(rng, 4, 4), "u0": 1.0}


@iso_curve_net.data(blind=True)
def near_edge(rng):
    return {"P": BP, "u0": 0.0}


@iso_curve_net.mistake("nearest_row", credit=0.25)
def _(P, u0):
    """You took a row of the net. Each row is the control polygon of *some* Bezier curve, but only the first and the last of
    them lie on the patch: inside, every row has a say. With u0 = 0 nobody notices. Draw your curve and the patch together."""
    return np.asarray(P)[round(u0 * (np.shape(P)[0] - 1))]


@iso_curve_net.mistake("points_not_controls", credit=0.5)
def _(P, u0):
    """Your points lie *on* the curve, S(u0, 0), ..., S(u0, 1); control points lie off it, but for the first and the last. In
    which of the two sums, over i or over j, does w occur? It is not needed here."""
    return dx.BezierPatch(P)(u0, np.linspace(0, 1, np.shape(P)[1]))


@iso_curve_net.mistake("other_direction", credit=0.5)
def _(P, u0):
    """Yours are the control points of the *other* curve, w = u0, along which u runs: you summed over the second index. Which
    index belongs to u? On a net that is not square the number of your points gives it away."""
    return np.einsum("j,ijk->ik", functions(np.shape(P)[1] - 1, u0), P)


@iso_curve_net.mistake("rows_interpolated", credit=0.25)
def _(P, u0):
    """You went in a straight line from one row of the net to the next. That would be the net, not the patch: at u0 *all* rows
    count, each by its Bernstein function. At u0 = 0 and u0 = 1 both are the same."""
    return np.einsum("i,ijk->jk", _hats(np.shape(P)[0], u0), P)


@iso_curve_net.mistake("reversed_u", credit=0.5)
def _(P, u0):
    """Yours is the curve at 1 - u0: you counted the rows from the far end. Put u0 = 0 in: which row of the net should come
    out?"""
    return np.einsum("i,ijk->jk", functions(np.shape(P)[0] - 1, 1 - u0), P)


@iso_curve_net.mistake("no_binomials", credit=0.25)
def _(P, u0):
    """At the edges yours is right; in between your points move towards the origin. The binomial coefficients are missing, so
    your weights do not add up to 1. What if all points of the net were equal?"""
    m = np.shape(P)[0]
    return np.einsum("i,ijk->jk", functions(m - 1, u0) / _row_of_pascal(m - 1), P)


# A6.4 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Bezier to Hermite", kind="net", accept={"close": 0.8})
def bezier_to_hermite(P):
    """Return the geometric (Hermite) form G of the bicubic Bezier patch with the net P: corners, tangents and twists.

    G = [[p00, p01, pw00, pw01], [p10, p11, pw10, pw11], [pu00, pu01, puw00, puw01], [pu10, pu11, puw10, puw11]]: p01 is the
    corner u = 0, w = 1; pu and pw are the derivatives by u and by w there, puw the twist, the mixed derivative. It is the same
    surface in other numbers.

    P : control net, an array of shape (4, 4, 3), first index along u

    Returns G, an array of shape (4, 4, 3).
    """
    return np.array(dx.to_hermite(dx.BezierPatch(P)).G)


def _hermite(P, tangent=3.0, twist=9.0, *, far=-1.0, mixed=-1.0):
    """G from P: tangents are a factor times the first differences, twists times the mixed ones; ``far`` is the sign of a tangent
    at a far end, ``mixed`` that of a twist at the corners 01 and 10."""
    P, G = np.asarray(P, dtype=float), np.empty((4, 4, 3))
    for i, (e, f) in enumerate(ENDS):
        for j, (d, g) in enumerate(ENDS):
            G[i, j] = P[e, d]
            G[2 + i, j] = tangent * (far if i else 1) * (P[f, d] - P[e, d])
            G[i, 2 + j] = tangent * (far if j else 1) * (P[e, g] - P[e, d])
            G[2 + i, 2 + j] = twist * (mixed if i != j else 1) * (P[e, d] - P[f, d] - P[e, g] + P[f, g])
    return G


def _tangents_exchanged(G):
    """G with its block of tangents along u and its block of tangents along w in each other's place."""
    G = np.array(G, dtype=float)
    G[2:, :2], G[:2, 2:] = G[:2, 2:].copy(), G[2:, :2].copy()
    return G


@bezier_to_hermite.data
def lecture(rng):
    return {"P": BP}


@bezier_to_hermite.data
def any_bicubic_net(rng):
    return {"P": any_net(rng, 4, 4)}


@bezier_to_hermite.data(blind=True)
def square_lattice(rng):
    return {"P": lattice(4, 4)}


@bezier_to_hermite.mistake("no_3", credit=0.5)
def _(P):
    """The corners are right, and every tangent points the right way; but a tangent is a *derivative*, and you gave the leg of
    the polygon. For a cubic it is how many times as long? And a twist is differentiated twice."""
    return _hermite(P, 1.0, 1.0)


@bezier_to_hermite.mistake("twist_3", credit=0.75)
def _(P):
    """Corners and tangents are right; your twists are too small by one and the same factor. The twist is differentiated once by
    u *and* once by w: each of the two brings its own factor."""
    return _hermite(P, 3.0, 3.0)


@bezier_to_hermite.mistake("twist_zero", credit=0.5)
def _(P):
    """Corners and tangents are right, but all your twists are 0: the four inner control points never enter. Move P[1, 1] alone:
    the edges stay, the patch changes. Some number of G must tell of it."""
    return _hermite(P, 3.0, 0.0)


@bezier_to_hermite.mistake("twist_all_plus", credit=0.75)
def _(P):
    """Nearly: two of your four twists have the wrong sign, those where one parameter is at its beginning and the other at its
    end. There you take one of the two differences against the sense of its parameter, and the other with it."""
    return _hermite(P, mixed=1.0)


@bezier_to_hermite.mistake("transposed", credit=0.5)
def _(P):
    """Corners and twists are right; your tangents along u stand where those along w belong, and the other way round. Read the
    blocks of G again: which are on the right of the corners, and which below?"""
    return _tangents_exchanged(_hermite(P))


@bezier_to_hermite.mistake("far_end_backwards", credit=0.5)
def _(P):
    """At the near ends all is right. At the far ends your tangents point back into the patch: you took the difference from the
    corner inwards there as well. A derivative points where its parameter *grows*."""
    return _hermite(P, far=1.0)


@bezier_to_hermite.mistake("u_w_exchanged", credit=0.5)
def _(P):
    """The right form of the patch with u and w exchanged: your G is transposed as a whole. The first index of P runs with u; so
    which control point is the corner p01, where u = 0 and w = 1?"""
    return _hermite(P).swapaxes(0, 1)


# A6.5 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Hermite to Bezier", kind="net", accept={"close": 0.8})
def hermite_to_bezier(G):
    """Return the Bezier net P of the bicubic patch whose geometric (Hermite) form is G: the way back from bezier_to_hermite.

    G = [[p00, p01, pw00, pw01], [p10, p11, pw10, pw11], [pu00, pu01, puw00, puw01], [pu10, pu11, puw10, puw11]]

    G : corners, tangents and twists, an array of shape (4, 4, 3)

    Returns the control net P, an array of shape (4, 4, 3), first index along u.
    """
    return np.array(dx.to_bezier(dx.HermitePatch(G)).control_net)


def _bezier(G, tangent=1 / 3, twist=1 / 9, *, far=-1.0, mixed=-1.0):
    """P from G, one corner after the other: the corner, a step along u, a step along w, and the point across from it."""
    G, P = np.asarray(G, dtype=float), np.empty((4, 4, 3))
    for i, (e, f) in enumerate(ENDS):
        for j, (d, g) in enumerate(ENDS):
            along_u = tangent * (far if i else 1) * G[2 + i, j]
            along_w = tangent * (far if j else 1) * G[i, 2 + j]
            P[e, d] = G[i, j]
            P[f, d] = G[i, j] + along_u
            P[e, g] = G[i, j] + along_w
            P[f, g] = G[i, j] + along_u + along_w + twist * (mixed if i != j else 1) * G[2 + i, 2 + j]
    return P


@hermite_to_bezier.data
def lecture(rng):
    return {"G": G_LECTURE}


@hermite_to_bezier.data
def any_form(rng):
    return {"G": _hermite(any_net(rng, 4, 4))}


@hermite_to_bezier.data
def large_twists(rng):
    G = _hermite(any_net(rng, 4, 4))
    G[2:, 2:] = rng.uniform(10, 25, (2, 2, 3)) * rng.choice([-1.0, 1.0], (2, 2, 3))
    return {"G": G}


@hermite_to_bezier.data(blind=True)
def no_twists(rng):
    return {"G": _hermite(BP, twist=0.0)}


@hermite_to_bezier.mistake("no_third", credit=0.5)
def _(G):
    """Your control points stand where the *tangents* end, three times too far out. A tangent is a derivative, and the leg of the
    polygon is a part of it. Which part, for a cubic?"""
    return _bezier(G, 1.0, 1.0)


@hermite_to_bezier.also("no_third")  # with the right share of the twist
def _(G):
    return _bezier(G, 1.0)


@hermite_to_bezier.mistake("twist_third", credit=0.75)
def _(G):
    """The twelve points of the boundary are right; in your four inner ones the twist counts too much. It is a derivative by u
    *and* by w: each of the two has its own share in it."""
    return _bezier(G, twist=1 / 3)


@hermite_to_bezier.mistake("twist_forgotten", credit=0.5)
def _(G):
    """The twelve points of the boundary are right. Each inner one completes a parallelogram with its corner: that is the patch
    without twists. Four vectors of G you have not used yet."""
    return _bezier(G, twist=0.0)


@hermite_to_bezier.mistake("far_end_plus", credit=0.5)
def _(G):
    """At the near ends all is right. At the far ends you *added* the tangent, so your control points lie outside the patch,
    beyond its edges. The parameter arrives at the far corner: on which side of it is the point before?"""
    return _bezier(G, far=1.0)


@hermite_to_bezier.also("far_end_plus")  # every sign a plus, that of the twist too
def _(G):
    return _bezier(G, far=1.0, mixed=1.0)


@hermite_to_bezier.mistake("twist_sign_mixed", credit=0.75)
def _(G):
    """Nearly: two of your four inner points are wrong, P[1, 2] and P[2, 1]. From their corners one step goes forward and the
    other one backward; what does that do to the sign of the twist?"""
    return _bezier(G, mixed=1.0)


@hermite_to_bezier.mistake("wrong_way_round", credit=0.5)
def _(G):
    """The factors of the way *there*: you multiplied by 3 and by 9, as for the way from Bezier to Hermite. Here you come back.
    Turn a net into G and that back into a net: you should be where you began."""
    return _bezier(G, 3.0, 9.0)


@hermite_to_bezier.mistake("tangents_exchanged", credit=0.5)
def _(G):
    """The corners are right; along each edge you used the tangents of the other direction. In G the tangents along w stand to
    the right of the corners, those along u below them. Which of them leads from P[0, 0] to P[1, 0]?"""
    return _bezier(_tangents_exchanged(G))
