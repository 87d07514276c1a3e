"""A5, algebraic, Hermite and point forms: a patch as a table of numbers, and what the numbers mean in each form.

One file, and a long one: each exercise stands here whole, its reference, its data and its mistakes one below the other.
`A44`, `A43`, `G44` and `P54` are the tables of the lecture data. Conventions: a[i, j] multiplies u^i w^j; G in Mortenson's
order [[p00, p01, pw00, pw01], [p10, p11, pw10, pw11], [pu00, pu01, puw00, puw01], [pu10, pu11, puw10, puw11]].
Oracle numbers: tests/assignments.
"""

import directrix as dx
import numpy as np

from autograder.exercise import exercise

M_F = np.array([[2.0, -2, 1, 1], [-3, 3, -2, -1], [0, 0, 1, 0], [1, 0, 0, 0]])
A44 = [
    [[0, -2, 0], [0, 3, 2], [-1, 7, -2], [1, 13, 0]],
    [[2, 2, 2], [3, 5, 2], [1, 7, -2], [1, 12, -1]],
    [[8, 1, 2], [6, 4, 2], [7, 10, 0], [8, 10, -2]],
    [[9, 0, 2], [10, 3, 2], [10, 6, -1], [10, 14, -2]],
]
A43 = [
    [[-1, 2, 1], [-1, 2, 1], [-1, 8, 1]],
    [[2, -1, 2], [4, 6, -2], [2, 6, 2]],
    [[7, -1, 2], [8, 3, 1], [4, 8, 0]],
    [[7, 1, 2], [10, 4, 2], [8, 8, -1]],
]
G44 = [
    [[0, 0, 0], [1, 4, 1], [1, 5, 2], [-1, 3, 4]],
    [[5, -1, 2], [6, 3, -1], [0, 6, -3], [2, 3, -2]],
    [[6, 1, 3], [3, -2, 5], [2, 1, 6], [-3, 4, 2]],
    [[4, 0, -4], [7, 2, 1], [5, -2, 3], [1, 3, -7]],
]
P54 = [
    [[-1, 1, 2], [2, 5, -2], [1, 8, 0], [-1, 11, -1]],
    [[4, 2, -2], [3, 4, 1], [2, 7, -1], [3, 14, 1]],
    [[5, -2, -1], [5, 5, -1], [5, 8, 1], [6, 10, 0]],
    [[8, 1, 2], [10, 5, 1], [8, 9, -2], [11, 14, -1]],
    [[12, -1, 0], [11, 6, 1], [10, 7, 1], [11, 12, 1]],
]


def column(t):
    """A parameter as floats."""
    return np.asarray(t, dtype=float)


def powers(t, n, derivative=0):
    """1, t, ..., t^(n - 1) along a new last axis, or their first derivatives."""
    i = np.arange(n)
    t = column(t)[..., np.newaxis]
    return t**i if not derivative else i * t ** np.maximum(i - 1, 0)


def blended(U, table, W):
    """Σ U_i table_ij W_j for weights U (..., m) and W (..., n) that broadcast, table (m, n, 3)."""
    return np.einsum("...i,ijk,...j->...k", U, np.asarray(table, dtype=float), W)


def hermite(t, derivative=0):
    """F1 ... F4 = [t³ t² t 1] M_F along a new last axis, or their first derivatives."""
    return powers(t, 4, derivative)[..., ::-1] @ M_F


def curly(rng, twist=24.0):
    """A random table G: corners of a quadrilateral that faces down, uneven tangents, large and unequal twists."""
    G = np.zeros((4, 4, 3))
    G[:2, :2] = np.array([[[0, 0, 0], [7, 1, 2]], [[1, 8, 1], [9, 7, -2]]]) + rng.uniform(-0.5, 0.5, (2, 2, 3))
    G[:2, 2:] = np.array([9, 0, 3]) + rng.uniform(-2, 2, (2, 2, 3))  # along w: +x
    G[2:, :2] = np.array([0, 9, -3]) + rng.uniform(-2, 2, (2, 2, 3))  # along u: +y
    G[2:, 2:] = rng.uniform(0.5, 1.0, (2, 2, 3)) * rng.choice([-1.0, 1.0], (2, 2, 3)) * twist
    return G


# A5.1 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=3, title="How many numbers?", kind="label")
def count_coefficients(du, dw):
    """Return how many numbers a polynomial surface of degree du in u and dw in w is made of.

    Every product u^i w^j with i up to du and j up to dw has a coefficient of its own in x, in y and in z.

    du, dw : degrees, whole numbers of 0 or more

    Returns a whole number (int).
    """
    return 3 * (du + 1) * (dw + 1)


@count_coefficients.data
def bicubic(rng):
    return {"du": 3, "dw": 3}


@count_coefficients.data
def cubic_by_quadratic(rng):
    return {"du": 3, "dw": 2}


@count_coefficients.data
def five_by_four_points(rng):
    return {"du": 4, "dw": 3}


@count_coefficients.data
def any_degrees(rng):
    du, dw = rng.permutation(np.arange(2, 8))[:2]
    return {"du": du, "dw": dw}


@count_coefficients.data(blind=True)
def bilinear(rng):
    return {"du": 1, "dw": 1}


@count_coefficients.mistake("scalar_only", credit=0.5)
def _(du, dw):
    """You counted the products u^i w^j and got their number right. But each of them is multiplied by a *vector*: how many
    numbers is that?"""
    return (du + 1) * (dw + 1)


@count_coefficients.mistake("curves_added", credit=0.25)
def _(du, dw):
    """You counted a curve in u and a curve in w and added the two. In a surface every power of u meets every power of w: lay the
    products out in a table, and count its cells."""
    return 3 * ((du + 1) + (dw + 1))


@count_coefficients.mistake("total_degree", credit=0.25)
def _(du, dw):
    """You counted the products of total degree up to the larger of the two, a triangle of the table. Here u and w have a degree
    each: u³w³ belongs to a bicubic surface, although its total degree is 6. Which cells of the table did you leave out?"""
    d = max(du, dw)
    return 3 * (d + 1) * (d + 2) // 2


@count_coefficients.mistake("degrees_multiplied", credit=0.5)
def _(du, dw):
    """You multiplied the degrees. A polynomial of degree 3 has four coefficients, not three: you left out the powers 0. What does
    your formula give for degree 0, a single point?"""
    return 3 * du * dw


@count_coefficients.mistake("always_bicubic", credit=0.25)
def _(du, dw):
    """You say 48 whatever the degrees are. That is the bicubic patch; the lecture also allows a cubic by a quadratic. Which of
    your factors should change when dw falls from 3 to 2?"""
    return 48


# A5.2 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Algebraic form, any degrees", kind="surface")
def algebraic_eval(u, w, a):
    """Return the points of the polynomial surface Σ_i Σ_j a[i, j] u^i w^j.

    The powers are ascending: a[0, 0] is the constant, a[i, j] multiplies u^i w^j. Textbooks print u³ first. The degrees m - 1
    in u and n - 1 in w need not be the same, and may be 0.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    a : coefficients, an array of shape (m, n, 3), m and n >= 1

    Returns the points, shape of u and w together + (3,).
    """
    return dx.AlgebraicPatch(a)(u, w)


@algebraic_eval.data
def lecture(rng):
    return {"a": np.array(A44, dtype=float)}


@algebraic_eval.data
def cubic_by_quadratic(rng):
    return {"a": np.array(A43, dtype=float)}


@algebraic_eval.data
def quadratic_by_quartic(rng):
    return {"a": rng.uniform(1.0, 6.0, (3, 5, 3)) * rng.choice([-1.0, 1.0], (3, 5, 3))}


@algebraic_eval.data
def degree_0_in_u(rng):
    """A curve in w, the same for every u."""
    return {"a": rng.uniform(1.0, 6.0, (1, 4, 3)) * rng.choice([-1.0, 1.0], (1, 4, 3))}


@algebraic_eval.data(blind=True)
def symmetric(rng):
    p, q, r = rng.uniform(-4.0, 4.0, (3, 3))
    return {"a": np.array([[p, q], [q, r]])}


@algebraic_eval.mistake("descending", credit=0.5)
def _(u, w, a):
    """You read the table as the textbooks print it, u³ first. Here the powers ascend: a[0, 0] is the constant. Put u = w = 0 into
    your formula: which entry is left, and which should be?"""
    a = np.asarray(a)[::-1, ::-1]
    return blended(powers(u, a.shape[0]), a, powers(w, a.shape[1]))


@algebraic_eval.mistake("transposed", credit=0.5)
def _(u, w, a):
    """The right surface with u and w exchanged: your a[i, j] multiplies u^j w^i. The first index belongs to u. For a table that is
    not square you can see it at once: how many powers of u have you got?"""
    a = np.asarray(a).swapaxes(0, 1)
    return blended(powers(u, a.shape[0]), a, powers(w, a.shape[1]))


@algebraic_eval.mistake("total_degree", credit=0.25)
def _(u, w, a):
    """You kept only the products of total degree up to the larger of the two degrees and dropped the corner of the table with the
    highest powers. Degree 3 in u *and* degree 3 in w allows u³w³. Is your S(1, 1) the sum of all entries?"""
    m, n = np.shape(a)[:2]
    keep = np.add.outer(np.arange(m), np.arange(n)) <= max(m, n) - 1
    return blended(powers(u, m), np.where(keep[..., np.newaxis], a, 0.0), powers(w, n))


@algebraic_eval.mistake("diagonal", credit=0.25)
def _(u, w, a):
    """You let both sums run together, so that only the diagonal of the table was used, a[i, i] with (uw)^i. These are two sums,
    one inside the other: every i meets every j. How many entries took part in yours?"""
    m, n = np.shape(a)[:2]
    return blended(powers(u, m), np.eye(m, n)[..., np.newaxis] * a, powers(w, n))


@algebraic_eval.mistake("counted_from_one", credit=0.25)
def _(u, w, a):
    """Your powers start with 1 instead of 0, as if the table were counted from one. So your surface always begins in the origin.
    What is anything to the power 0, and which entry does it belong to?"""
    m, n = np.shape(a)[:2]
    return blended(powers(u, m + 1)[..., 1:], a, powers(w, n + 1)[..., 1:])


@algebraic_eval.mistake("no_mixed_terms", credit=0.25)
def _(u, w, a):
    """You added a polynomial in u and a polynomial in w: the first column and the first row of the table. Two edges of yours are
    right, but all the products u^i w^j are missing. What does such a surface do with a[1, 1]?"""
    m, n = np.shape(a)[:2]
    keep = np.multiply.outer(np.arange(m), np.arange(n)) == 0
    return blended(powers(u, m), np.where(keep[..., np.newaxis], a, 0.0), powers(w, n))


# A5.3 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=4, title="Hermite blending functions", kind="basis", tolerance=1e-12)
def hermite_basis(t):
    """Return the four Hermite blending functions at t, in the order of p(0), p(1), p'(0), p'(1).

    F1 and F2 blend the two end points, F3 and F4 the two end tangents of a cubic curve:
    p(t) = F1 p(0) + F2 p(1) + F3 p'(0) + F4 p'(1).

    t : number or array of any shape, in [0, 1]

    Returns F1, F2, F3, F4 along a new last axis, shape of t + (4,).
    """
    return hermite(t)


@hermite_basis.data
def tenths(rng):
    return {"t": np.linspace(0.0, 1.0, 11)}


@hermite_basis.data
def one_number(rng):
    return {"t": rng.uniform(0.15, 0.35)}


@hermite_basis.data
def a_table(rng):
    return {"t": rng.uniform(0.05, 0.95, (2, 3))}


@hermite_basis.data(blind=True)
def both_ends(rng):
    return {"t": [0.0, 1.0]}


@hermite_basis.mistake("other_order", credit=0.5)
def _(t):
    """The right four functions in the order p(0), p'(0), p(1), p'(1), which some books use. Here both points come first, then
    both tangents. At t = 1 one function is 1: at which place do you have it?"""
    return hermite(t)[..., [0, 2, 1, 3]]


@hermite_basis.mistake("f4_sign", credit=0.5)
def _(t):
    """Three functions are right; your F4 has the wrong sign. It must be 0 at both ends and arrive with slope *plus* one at t = 1:
    so from which side of zero does it come? At the ends themselves nobody sees the difference."""
    return hermite(t) * [1.0, 1.0, 1.0, -1.0]


@hermite_basis.mistake("matrix_transposed", credit=0.25)
def _(t):
    """You took the rows of the matrix for its columns: it is transposed. The powers stand on its left, so each *column* makes one
    function. Do your first two add up to 1?"""
    return powers(t, 4)[..., ::-1] @ M_F.T


@hermite_basis.mistake("powers_ascending", credit=0.25)
def _(t):
    """Matrix and powers do not belong together: this matrix wants the powers as textbooks print them, t³ first, and you gave it
    1 first. What do your four functions give at t = 0?"""
    return powers(t, 4) @ M_F


@hermite_basis.mistake("bezier", credit=0.25)
def _(t):
    """These are the Bernstein functions, which blend four *points*. Hermite blends two points and two tangents, so two of your
    functions must vanish at both ends. Do any of them?"""
    t = column(t)
    return np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3], axis=-1)


@hermite_basis.mistake("tangents_exchanged", credit=0.5)
def _(t):
    """The first two are right; F3 and F4 have changed places. F3 belongs to the tangent at the *start*: it must leave t = 0 with
    slope one. Which of your two does?"""
    return hermite(t)[..., [0, 1, 3, 2]]


# A5.4 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="Hermite patch: corners, tangents, twists", kind="surface")
def hermite_patch(u, w, G):
    """Return the points of the bicubic Hermite patch S(u, w) = Σ_i Σ_j F_i(u) G[i, j] F_j(w).

    G holds four corners p, four derivatives by u (pu), four by w (pw) and four twists puw = ∂²S/∂u∂w, in Mortenson's order:
    [[p00, p01, pw00, pw01], [p10, p11, pw10, pw11], [pu00, pu01, puw00, puw01], [pu10, pu11, puw10, puw11]].
    The first index of p01 is u = 0, the second w = 1. F1 ... F4 are the Hermite blending functions.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    G : an array of shape (4, 4, 3)

    Returns the points, shape of u and w together + (3,).
    """
    return dx.HermitePatch(G)(u, w)


@hermite_patch.built_from(hermite_basis)
def _(u, w, G, hermite_basis):
    return blended(hermite_basis(u), G, hermite_basis(w))


@hermite_patch.data
def lecture(rng):
    return {"G": np.array(G44, dtype=float)}


@hermite_patch.data
def large_twists(rng):
    return {"G": curly(rng, twist=60.0)}


@hermite_patch.data(blind=True)
def no_twists(rng):
    """A Ferguson patch: whatever is done to the twists cannot be seen."""
    return {"G": curly(rng, twist=0.0)}


def _patch(u, w, G):
    return blended(hermite(u), G, hermite(w))


def _blocks(G, points=1.0, tangents_u=1.0, tangents_w=1.0, twists=1.0):
    """G with its blocks multiplied."""
    factors = np.block([
        [np.full((2, 2), points), np.full((2, 2), tangents_w)],
        [np.full((2, 2), tangents_u), np.full((2, 2), twists)],
    ])  # fmt: skip
    return factors[..., np.newaxis] * G


@hermite_patch.mistake("twist_sign", credit=0.5)
def _(u, w, G):
    """All four edges are right, and the inside bulges the wrong way: your twists have the wrong sign. They have no influence on
    the edges. Which of your products of two blending functions carries a minus too many?"""
    return _patch(u, w, _blocks(G, twists=-1.0))


@hermite_patch.mistake("no_twist", credit=0.5)
def _(u, w, G):
    """All four edges are right, but the inside is that of a patch without twists, a Ferguson patch. G has sixteen entries; how many
    of them does your formula use?"""
    return _patch(u, w, _blocks(G, twists=0.0))


@hermite_patch.mistake("tangents_over_3", credit=0.25)
def _(u, w, G):
    """You divided the tangents by 3 and the twists by 9. Those are the legs of a *Bezier* net; here the derivatives themselves are
    given and the functions F3 and F4 expect just them. How fast does your patch leave the corner (0, 0)?"""
    return _patch(u, w, _blocks(G, tangents_u=1 / 3, tangents_w=1 / 3, twists=1 / 9))


@hermite_patch.mistake("pu_pw_exchanged", credit=0.5)
def _(u, w, G):
    """Corners and twists are right, but the two blocks of tangents are exchanged: your patch leaves its corners along u with the
    tangents meant for w. The lower left block of G belongs to F3 and F4 of *which* parameter?"""
    G = np.asarray(G)
    return _patch(u, w, np.block([[[G[:2, :2]], [G[2:, :2]]], [[G[:2, 2:]], [G[2:, 2:]]]]))


@hermite_patch.mistake("transposed", credit=0.5)
def _(u, w, G):
    """The right surface with u and w exchanged: you used the table as if its rows belonged to w. p01 is the corner at u = 0,
    w = 1. Where is it on your patch?"""
    return _patch(u, w, np.asarray(G).swapaxes(0, 1))


@hermite_patch.mistake("matrix_transposed", credit=0.25)
def _(u, w, G):
    """You have M on the side where its transpose belongs, and the other way round. From left to right: powers of u, then the matrix
    as it is printed, then the table. What do the first two alone give at u = 0?"""
    U, W = powers(u, 4)[..., ::-1], powers(w, 4)[..., ::-1]
    return blended(U @ M_F.T, G, W @ M_F.T)


@hermite_patch.mistake("powers_ascending", credit=0.25)
def _(u, w, G):
    """The matrix wants the powers as textbooks print them, u³ first, and you gave it 1 first. Put u = w = 0 in: of your four
    powers only one is not 0. Which row of the matrix does it pick, and which should it pick?"""
    return blended(powers(u, 4) @ M_F, G, powers(w, 4) @ M_F)


@hermite_patch.mistake("twists_exchanged", credit=0.5)
def _(u, w, G):
    """Everything of yours is right but for two twists: puw01 and puw10 have changed places. The first index is the one of u, in the
    lower right block as well. Which of the two belongs to the corner u = 0, w = 1?"""
    G = np.array(G, dtype=float)
    G[2, 3], G[3, 2] = G[3, 2].copy(), G[2, 3].copy()
    return _patch(u, w, G)


# A5.5 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Geometric to algebraic", kind="net")
def hermite_to_algebraic(G):
    """Return the algebraic coefficients of a Hermite patch: a with algebraic_eval(u, w, a) = hermite_patch(u, w, G).

    G : corners, tangents and twists as in hermite_patch, an array of shape (4, 4, 3)

    Returns an array of shape (4, 4, 3), powers ascending: a[i, j] multiplies u^i w^j.
    """
    return np.array(_printed(M_F, G, M_F.T)[::-1, ::-1])


def _printed(left, G, right):
    """left G right for each of x, y, z."""
    return np.einsum("ia,abk,bj->ijk", left, np.asarray(G, dtype=float), right)


@hermite_to_algebraic.data
def lecture(rng):
    return {"G": np.array(G44, dtype=float)}


@hermite_to_algebraic.data
def any_patch(rng):
    return {"G": curly(rng)}


@hermite_to_algebraic.data(blind=True)
def symmetric(rng):
    """G[i, j] = G[j, i]: u and w play the same part."""
    G = curly(rng)
    return {"G": (G + G.swapaxes(0, 1)) / 2}


@hermite_to_algebraic.mistake("right_not_transposed", credit=0.5)
def _(G):
    """The left side is right; on the right you multiplied by the matrix and not by its transpose. There the powers of w stand as
    a column. Turn the whole product over: what becomes of each factor?"""
    return _printed(M_F, G, M_F)[::-1, ::-1]


@hermite_to_algebraic.mistake("inverse", credit=0.5)
def _(G):
    """You converted the other way round, from coefficients to corners and tangents, with the inverse of the matrix. Your a[0, 0]
    must be the point S(0, 0). Is it?"""
    inverse = np.linalg.inv(M_F)
    return _printed(inverse, G, inverse.T)[::-1, ::-1]


@hermite_to_algebraic.mistake("one_side", credit=0.25)
def _(G):
    """You converted one direction only: your columns are still blended by Hermite functions of w. A patch has two parameters. What
    has to happen on the right of the table?"""
    return _printed(M_F, G, np.eye(4))[::-1, ::-1]


@hermite_to_algebraic.mistake("transposed", credit=0.5)
def _(G):
    """All the numbers are there, with u and w exchanged: your table is transposed. a[1, 0] multiplies u, so it must be the
    derivative by u in the corner. Which one is yours?"""
    return _printed(M_F, G, M_F.T)[::-1, ::-1].swapaxes(0, 1)


@hermite_to_algebraic.mistake("not_reversed", credit=0.5)
def _(G):
    """The product is right, and its rows and columns stand for u³, u², u, 1. The table that is asked for ascends. Which entry of
    yours is the constant, S(0, 0)?"""
    return _printed(M_F, G, M_F.T)


@hermite_to_algebraic.mistake("one_reversed", credit=0.5)
def _(G):
    """You turned the rows round so that they ascend, and forgot the columns. Both run from the third power down to the constant.
    What stands in your a[0, 0]?"""
    return _printed(M_F, G, M_F.T)[::-1]


# A5.6 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="Unit normal of a patch", kind="field", tolerance=1e-7)
def patch_normal(u, w, G):
    """Return the unit normals of the Hermite patch: S_u × S_w divided by its length.

    S_u and S_w are the derivatives by u and by w. Where there is no normal, return (0, 0, 0), never NaN: that is where S_u or
    S_w is (0, 0, 0), or where the length of S_u × S_w is at most 1e-10 times that of S_u times that of S_w.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    G : corners, tangents and twists as in hermite_patch, an array of shape (4, 4, 3)

    Returns vectors of length 1 or 0, shape of u and w together + (3,).
    """
    return _divided(np.cross(*_tangents(u, w, G)), _tangents(u, w, G))


def _tangents(u, w, G):
    """S_u and S_w."""
    return blended(hermite(u, 1), G, hermite(w)), blended(hermite(u), G, hermite(w, 1))


def _length(v):
    return np.linalg.norm(v, axis=-1, keepdims=True)


@patch_normal.built_from(hermite_basis)
def _(u, w, G, hermite_basis):
    S_u, S_w = blended(hermite(u, 1), G, hermite_basis(w)), blended(hermite_basis(u), G, hermite(w, 1))
    return _divided(np.cross(S_u, S_w), (S_u, S_w))


def _divided(v, tangents):
    """v divided by its length where the tangents have a normal, 0 elsewhere."""
    pu, pw = tangents
    exists = _length(np.cross(pu, pw)) > 1e-10 * _length(pu) * _length(pw)
    return np.divide(v, _length(v), out=np.zeros_like(v), where=exists & (_length(v) > 0))


@patch_normal.data
def lecture(rng):
    return {"G": np.array(G44, dtype=float)}


@patch_normal.data
def any_patch(rng):
    return {"G": curly(rng, twist=4.0)}


@patch_normal.data
def collapsed_edge(rng):
    """The whole edge w = 0 is one point, the origin: S_u = 0 there."""
    G = curly(rng, twist=4.0)
    G[:, 0] = 0.0
    return {"G": G}


@patch_normal.data
def tangents_agree_in_a_corner(rng):
    G = curly(rng, twist=4.0)
    G[0, 2] = 2 * G[2, 0]
    return {"G": G}


@patch_normal.data
def a_tiny_patch(rng):
    """Below a micrometre across, in metres: S_u × S_w is some 1e-12 long, and has a direction all the same."""
    return {"G": 1e-7 * curly(rng, twist=4.0)}


@patch_normal.data(blind=True)
def lies_flat(rng):
    """A curved map of a plane piece: all normals are (0, 0, 1)."""
    G = curly(rng, twist=4.0).swapaxes(0, 1)
    G[..., 2] = 0.0
    return {"G": G}


@patch_normal.mistake("reversed", credit=0.5)
def _(u, w, G):
    """Your normals point to the other side: you took the cross product in the order S_w × S_u. Point the fingers of your right hand
    along u and bend them towards w: where does the thumb point?"""
    return -patch_normal.reference(u, w, G)


@patch_normal.mistake("not_unit", credit=0.5)
def _(u, w, G):
    """The direction is right, the length is not: you gave S_u × S_w itself. Its length is the area that a small mesh of the square
    is stretched to. A *unit* normal has which length?"""
    return np.cross(*_tangents(u, w, G))


@patch_normal.mistake("unit_then_cross", credit=0.5)
def _(u, w, G):
    """You made both tangents unit vectors first and then took the cross product. Its length is the sine of the angle between them,
    and that is 1 only where they are perpendicular. In which order do the two steps belong?"""
    pu, pw = (np.divide(v, _length(v), out=np.zeros_like(v), where=_length(v) > 0) for v in _tangents(u, w, G))
    return np.cross(pu, pw)


@patch_normal.mistake("twist", credit=0.0)
def _(u, w, G):
    """You divided the mixed derivative, the twist, by its length. It tells how S_u changes along w and need not be perpendicular
    to anything. Which product of two vectors is perpendicular to both?"""
    twist = blended(hermite(u, 1), G, hermite(w, 1))
    return np.divide(twist, _length(twist), out=np.zeros_like(twist), where=_length(twist) > 0)


@patch_normal.mistake("corner_plane", credit=0.0)
def _(u, w, G):
    """You have one normal for the whole patch, that of the plane through three corners. A curved patch faces another way at every
    point. Which two vectors lie in the tangent plane at (u, w)?"""
    n = np.cross(G[1, 0] - G[0, 0], G[0, 1] - G[0, 0])
    length = np.linalg.norm(n)
    shape = np.broadcast_shapes(np.shape(u), np.shape(w))
    return np.broadcast_to(n / length if length else n, (*shape, 3))


@patch_normal.mistake("absolute_border", credit=0.75)
def _(u, w, G):
    """You compare the length of S_u × S_w with a fixed number, so that a very small patch has no normals at all. Whether two vectors
    are parallel does not depend on the unit of length. With what must their product be compared?"""
    n = np.cross(*_tangents(u, w, G))
    return np.divide(n, _length(n), out=np.zeros_like(n), where=_length(n) > 1e-10)


@patch_normal.mistake("always_up", credit=0.25)
def _(u, w, G):
    """You turned every normal so that it points upwards. But the sign belongs to the patch: S_u × S_w says which side is which, and
    a patch that faces down has normals that point down. What happens to yours where a patch stands upright?"""
    n = patch_normal.reference(u, w, G)
    return np.where(n[..., 2:] < 0, -n, n)


# A5.7 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="n-point form: a surface through a grid of points", kind="surface", tolerance=1e-8)
def npoint_patch(u, w, P, tu, tw):
    """Return the points of the polynomial surface through a grid of points: S(tu[i], tw[j]) = P[i, j].

    Its degree is m - 1 in u and n - 1 in w. The parameters at which the points are reached have to be chosen: tu[i] for the row
    i, tw[j] for the column j; others give another surface through the same points. Four at 0, 1/3, 2/3, 1 each way make the
    classical 16-point form.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    P : points, an array of shape (m, n, 3)
    tu, tw : parameters, arrays of shape (m,) and (n,), increasing from 0 to 1

    Returns the points, shape of u and w together + (3,).
    """
    return dx.PointPatch(P, tu, tw)(u, w)


def _lagrange(t, nodes):
    """L_i(t) = Π_{k ≠ i} (t - t_k) / (t_i - t_k) along a new last axis."""
    t = column(t)
    return np.stack(
        [np.prod([(t - k) / (i - k) for k in nodes if k != i], axis=0) + 0 * t for i in nodes],
        axis=-1,
    )


def _through(u, w, P, tu, tw):
    return blended(_lagrange(u, tu), P, _lagrange(w, tw))


def _spread(rng, n):
    """n parameters from 0 to 1, unevenly: those inside lie well away from equal steps, and from their mirror image."""
    even = np.linspace(0.0, 1.0, n)
    return np.where((even == 0) | (even == 1), even, even ** rng.uniform(1.4, 1.7))


def _grid(rng, m, n):
    """m by n points over a square of side 9, uneven."""
    x, y = np.meshgrid(np.linspace(0, 9, m), np.linspace(0, 9, n), indexing="ij")
    return np.stack([x, y, np.zeros((m, n))], axis=-1) + rng.uniform(-1.0, 1.0, (m, n, 3)) * [1, 1, 2]


@npoint_patch.data
def lecture(rng):
    return {"P": np.array(P54, dtype=float), "tu": [0.0, 0.2, 0.45, 0.7, 1.0], "tw": [0.0, 0.3, 0.75, 1.0]}


@npoint_patch.data
def four_by_three(rng):
    return {"P": _grid(rng, 4, 3), "tu": _spread(rng, 4), "tw": 1 - _spread(rng, 3)[::-1]}


@npoint_patch.data
def four_by_four(rng):
    return {"P": _grid(rng, 4, 4), "tu": _spread(rng, 4), "tw": 1 - _spread(rng, 4)[::-1]}


@npoint_patch.data(blind=True)
def sixteen_points(rng):
    thirds = np.array([0.0, 1 / 3, 2 / 3, 1.0])
    return {"P": _grid(rng, 4, 4), "tu": thirds, "tw": thirds}


@npoint_patch.mistake("parameters_ignored", credit=0.5)
def _(u, w, P, tu, tw):
    """A surface through all the points, but not this one: you used equal steps, and tu and tw never enter. Evaluate yours at
    (tu[1], tw[1]): are you at P[1, 1]?"""
    return _through(u, w, P, np.linspace(0, 1, len(tu)), np.linspace(0, 1, len(tw)))


@npoint_patch.mistake("piecewise_bilinear", credit=0.25)
def _(u, w, P, tu, tw):
    """Your surface passes through all the points and is straight between them, with creases along the grid lines. *One* polynomial
    is asked for: every point has a say everywhere. Is your patch smooth where it passes a point?"""
    tent_u = np.stack([np.interp(column(u), tu, row) for row in np.eye(len(tu))], axis=-1)
    tent_w = np.stack([np.interp(column(w), tw, row) for row in np.eye(len(tw))], axis=-1)
    return blended(tent_u, P, tent_w)


@npoint_patch.mistake("tu_tw_exchanged", credit=0.5)
def _(u, w, P, tu, tw):
    """You took the parameters of one direction for the other. tu belongs to the first index of P and to u. On equal steps both ways
    nobody can see it; at (tu[1], 0) of this grid you should be at P[1, 0]."""
    if len(tu) != len(tw):
        return _through(u, w, P, 1 - np.asarray(tu)[::-1], tw)
    return _through(u, w, P, tw, tu)


@npoint_patch.mistake("denominator_sign", credit=0.5)
def _(u, w, P, tu, tw):
    """Your denominators are the wrong way round, t_k - t_i. Each factor then changes its sign; with an odd number of factors in all
    your surface is the mirror image in the origin, with an even number nobody sees it. What is your L_i at t_i?"""
    sign = (-1.0) ** (len(tu) + len(tw))
    return sign * _through(u, w, P, tu, tw)


@npoint_patch.mistake("transposed", credit=0.5)
def _(u, w, P, tu, tw):
    """The right surface with u and w exchanged: the first index of your P runs along w. Where does the edge w = 0 of yours
    pass: through the first column of P, or through its first row?"""
    return blended(_lagrange(w, tu), P, _lagrange(u, tw))


@npoint_patch.mistake("control_points", credit=0.25)
def _(u, w, P, tu, tw):
    """You took P for the control points of a Bezier patch. Such a patch leans towards its inner points and passes them by. This
    one has to pass *through* all of them: is your S(tu[1], tw[1]) the point P[1, 1]?"""
    return dx.BezierPatch(P)(u, w)
