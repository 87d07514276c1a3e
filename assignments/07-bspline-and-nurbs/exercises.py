"""A7, B-spline and NURBS: knots, the recursion for the basis, patches of orders k and l, weights, and an exact cylinder.

One file, and a long one: each exercise stands here whole, its reference, its data and its mistakes one below the other.
`P65` (6 x 5) with the orders (4, 3) and the weights `H65` are the lecture data: different numbers of points and different orders,
so that nothing can be exchanged unseen. Equal weights, and as many points as the order, hide most mistakes. Oracle numbers:
tests/assignments.
"""

# ruff: noqa: E741 (k and l are the orders, as the lecture names them)

import directrix as dx
import numpy as np
from directrix.basis import spline_row

from autograder.exercise import exercise

P65 = [
    [[0, -2, 1], [-2, 5, 0], [-1, 9, 2], [1, 13, -2], [-2, 17, 0]],
    [[5, -2, -1], [3, 2, 0], [2, 6, 1], [4, 10, 2], [3, 17, -1]],
    [[7, 2, 0], [5, 4, 1], [4, 9, 0], [4, 12, 2], [4, 16, -2]],
    [[11, -1, 0], [9, 6, 1], [11, 7, -1], [8, 10, 0], [8, 17, 0]],
    [[12, 2, 0], [10, 2, 1], [12, 7, 2], [10, 11, -2], [10, 14, 1]],
    [[14, 1, 0], [17, 5, 1], [13, 8, 1], [14, 11, -2], [17, 16, -2]],
]
H65 = [[3, 4, 1, 4, 2], [3, 3, 2, 4, 1], [2, 2, 3, 2, 1], [1, 1, 1, 1, 4], [1, 3, 4, 1, 2], [2, 2, 4, 1, 4]]
LECTURE_KNOTS = [0.0, 0, 0, 0, 1, 2, 3, 3, 3, 3]
QUARTER = np.sqrt(0.5)  # cos 45°


def any_net(rng, m, n):
    """A random m x n net: a lattice 3 apart, every point moved by up to 1.2 along each axis, z by up to 3."""
    lattice = np.stack(np.broadcast_arrays(3.0 * np.arange(m)[:, None], 3.0 * np.arange(n)[None, :], 0.0), axis=-1)
    return lattice + rng.uniform(-1, 1, (m, n, 3)) * [1.2, 1.2, 3.0]


def clamped(count, k, last):
    """Whole numbers 0 (k times), 1, 2, ..., last (k times): ``count`` of them."""
    return np.clip(np.arange(count) - k + 1, 0, last)


# A7.1 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=4, title="Open uniform knot vector", kind="value")
def open_knots(m, k):
    """Return the open uniform knots for m control points and the order k: 0 (k times), 1, 2, ..., m - k, m - k + 1 (k times).

    These are m + k numbers. With m = k there is nothing between the two ends: the Bezier case.

    m : number of control points, a whole number
    k : order = degree + 1, a whole number with 1 <= k <= m; 4 is cubic

    Returns an array of m + k numbers, whole ones, that never decrease.
    Raises ValueError where k is below 1 or above m: then there is no such curve.
    """
    _must_fit(m, k)
    return clamped(m + k, k, m - k + 1)


def _must_fit(m, k):
    if not 1 <= k <= m:
        raise ValueError(f"the order must be at least 1 and at most the number of points; got k = {k} and m = {m}")


@open_knots.data
def lecture(rng):
    return {"m": 6, "k": 4}


@open_knots.data
def many_points(rng):
    return {"m": int(rng.integers(8, 13)), "k": 3}


@open_knots.data
def any_numbers(rng):
    k = int(rng.integers(2, 6))
    return {"m": k + int(rng.integers(2, 6)), "k": k}


@open_knots.data
def too_few_points(rng):
    return {"m": 3, "k": int(rng.integers(4, 7))}


@open_knots.data
def order_0(rng):
    return {"m": 5, "k": 0}


@open_knots.data(blind=True)
def the_bezier_case(rng):
    return {"m": 4, "k": 4}


@open_knots.mistake("order_minus_one", credit=0.5)
def _(m, k):
    """At the ends your knots occur only k - 1 times. k times is what it takes for the curve to reach its first and its last
    control point. Count your zeros."""
    _must_fit(m, k)
    return clamped(m + k, k - 1, m - k + 3)


@open_knots.also("order_minus_one")  # the numbers between as they should be: two knots too few
def _(m, k):
    _must_fit(m, k)
    return clamped(m + k, k, m - k + 1)[1:-1]


@open_knots.mistake("length_m", credit=0.5)
def _(m, k):
    """Your vector is one knot short: at one end yours occurs k - 1 times only. There must be m + k of them, one for each control
    point and k more. Count them at both ends."""
    _must_fit(m, k)
    return clamped(m + k, k, m - k + 1)[:-1]


@open_knots.also("length_m")  # one short at the other end
def _(m, k):
    _must_fit(m, k)
    return clamped(m + k, k, m - k + 1)[1:]


@open_knots.mistake("uniform", credit=0.25)
def _(m, k):
    """You simply counted on. Those are *uniform* knots, and they are not open: a curve on them begins and ends somewhere beside
    its first and last control points. What happens to the knots at the two ends?"""
    _must_fit(m, k)
    return np.arange(m + k)


@open_knots.mistake("normalised", credit=0.75)
def _(m, k):
    """Right up to scale: you divided by the last knot, so that yours run from 0 to 1. Many programs do, and the surface is the
    same; but the vector asked for has whole numbers, each span 1 long. With m = k nobody sees the difference."""
    _must_fit(m, k)
    return clamped(m + k, k, m - k + 1) / (m - k + 1)


@open_knots.mistake("repeated_inner", credit=0.5)
def _(m, k):
    """Your first knot occurs k + 1 times: the numbers between the ends begin with one more 0. One control point then has no
    influence at all. With which number should the inner knots begin?"""
    _must_fit(m, k)
    return clamped(m + k, k + 1, m - k)


@open_knots.also("repeated_inner")  # the numbers between begin with 0 and so end one too early
def _(m, k):
    _must_fit(m, k)
    return np.array([0] * k + [*range(m - k)] + [m - k + 1] * k)


@open_knots.mistake("order_is_degree", credit=0.5)
def _(m, k):
    """You have one knot too many: at the ends yours occur k + 1 times, as they should if k were the *degree*. Here k is the order,
    degree + 1, as in the lecture. How many knots do m points and order k need?"""
    _must_fit(m, k)
    return clamped(m + k + 1, k + 1, m - k)


@open_knots.also("order_is_degree")  # put together from three lists, which gives still more knots where m = k
def _(m, k):
    _must_fit(m, k)
    return np.array([0] * (k + 1) + [*range(1, m - k)] + [m - k] * (k + 1))


@open_knots.mistake("starts_at_1", credit=0.75)
def _(m, k):
    """Every one of your knots is too large by 1: you began to count with 1, as some languages do. The curve would not mind; the
    statement does. At which number does it begin?"""
    _must_fit(m, k)
    return clamped(m + k, k, m - k + 1) + 1


# A7.2 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="B-spline basis functions", kind="basis", tolerance=1e-12, accept={"close": 0.8})
def bspline_basis(t, knots, k):
    """Return all m = len(knots) - k basis functions of order k at the parameters t, by the recursion of Cox and de Boor.

    N_i,1 = 1 on the span t_i <= t < t_(i+1), 0 elsewhere; the last span that is not empty is closed on the right as well.
    N_i,q = (t - t_i) / (t_(i+q-1) - t_i) N_i,q-1 + (t_(i+q) - t) / (t_(i+q) - t_(i+1)) N_(i+1),q-1 for q = 2, ..., k, where a
    fraction 0/0 counts as 0.

    t : a number or an array of any shape, in [knots[k-1], knots[m]], both ends included
    knots : numbers that never decrease, an array of shape (m + k,)
    k : order = degree + 1, a whole number of 1 or more

    Returns an array of the shape of t + (m,), the functions along its last axis; pure numbers that add up to 1.
    """
    return spline_row(np.asarray(knots, dtype=float), k, np.asarray(t, dtype=float))


def _recursion(t, knots, k, first=None, *, one_too_long=0, guard=True):
    """Cox and de Boor, from the functions of order 1 (right ones if none are given) to those of order k."""
    t, knots = np.asarray(t, dtype=float)[..., None], np.asarray(knots, dtype=float)
    N = _half_open(t, knots, closed=True) if first is None else first(t, knots)
    for q in range(2, k + 1):
        i = np.arange(len(knots) - q)
        up = (t - knots[i], knots[np.minimum(i + q - 1 + one_too_long, len(knots) - 1)] - knots[i])
        down = (knots[i + q] - t, knots[i + q] - knots[i + 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            N = _divided(*up, guard) * N[..., :-1] + _divided(*down, guard) * N[..., 1:]
    return N


def _divided(a, b, guard):
    return np.where(b != 0, a / b, 0.0) if guard else a / b


def _half_open(t, knots, closed=False):
    last = np.flatnonzero(np.diff(knots))[-1]
    return np.where(
        (np.arange(len(knots) - 1) == last) & closed,
        (knots[:-1] <= t) & (t <= knots[1:]),
        (knots[:-1] <= t) & (t < knots[1:]),
    ).astype(float)


def _both_closed(t, knots):
    return ((knots[:-1] <= t) & (t <= knots[1:])).astype(float)


def _left_open(t, knots):
    return ((knots[:-1] < t) & (t <= knots[1:])).astype(float)


def uneven_knots(rng):
    """Order 3: both ends three times, and between them two simple knots and a double one, at uneven distances."""
    a, b, c, end = np.cumsum(rng.uniform(0.6, 2.0, 4))
    return np.array([0, 0, 0, a, b, b, c, end, end, end])


@bspline_basis.data
def lecture(rng):
    return {"t": np.arange(13) / 4, "knots": LECTURE_KNOTS, "k": 4}


@bspline_basis.data
def uneven_with_a_double_knot(rng):
    knots = uneven_knots(rng)
    return {"t": np.sort(np.concatenate([knots[2:8], rng.uniform(0, knots[-1], 6)])), "knots": knots, "k": 3}


@bspline_basis.data
def ends_not_repeated(rng):
    knots = np.cumsum(rng.uniform(0.5, 1.5, 9))
    return {"t": rng.uniform(knots[2], knots[6], (2, 4)), "knots": knots, "k": 3}


@bspline_basis.data
def last_knot_alone(rng):
    return {"t": 3.0, "knots": LECTURE_KNOTS, "k": 4}


@bspline_basis.data(blind=True)
def inside_one_span(rng):
    return {"t": rng.uniform(0.2, 0.8, 5), "knots": [0.0, 0, 0, 1, 1, 1], "k": 3}


@bspline_basis.mistake("zero_at_end", credit=0.75)
def _(t, knots, k):
    """Right everywhere but at the last parameter: there all your functions are 0. No span t_i <= t < t_(i+1) holds the last
    knot, so the last span that is not empty must be closed on the right. Five public libraries had this very bug."""
    return _recursion(t, knots, k, lambda t, knots: _half_open(t, knots))


@bspline_basis.mistake("order_is_degree", credit=0.5)
def _(t, knots, k):
    """You went one step too far: yours are the functions of degree k, one fewer than there are control points. Order k is degree
    k - 1. With which q does the recursion begin, and with which does it end?"""
    return _recursion(t, knots, k + 1)


@bspline_basis.also("order_is_degree")  # filled up with zeros to m columns
def _(t, knots, k):
    N = _recursion(t, knots, k + 1)
    return np.concatenate([N, np.zeros((*N.shape[:-1], 1))], axis=-1)


@bspline_basis.mistake("order_short", credit=0.5)
def _(t, knots, k):
    """You stopped one step too early: yours are functions of order k - 1. Python's range ends before its second number. Look at
    the graph of a cubic function: does yours have kinks?"""
    N = _recursion(t, knots, k - 1)
    return N[..., : len(knots) - k]


@bspline_basis.also("order_short")  # all of them, one more than there are control points
def _(t, knots, k):
    return _recursion(t, knots, k - 1)


@bspline_basis.mistake("double_closed", credit=0.5)
def _(t, knots, k):
    """Between the knots all is right; *at* an inner knot your functions add up to 2. Both spans beside it claim it, since you
    closed them at both ends. Each parameter must belong to one span only."""
    return _recursion(t, knots, k, _both_closed)


@bspline_basis.mistake("denominator_shift", credit=0.5)
def _(t, knots, k):
    """Your functions do not add up to 1: the denominator of your first fraction reaches one knot too far. It is the length of
    the support of the function that it stands at, N_i of order q - 1. How many spans is that?"""
    return _recursion(t, knots, k, one_too_long=1)


@bspline_basis.mistake("nan_not_0", credit=0.0)
def _(t, knots, k):
    """Where knots are repeated you divide 0 by 0, and one NaN spoils the row. Such a function lives on an empty span and is 0: you
    must ask for the denominator before you divide. On knots that are all different nobody notices."""
    return _recursion(t, knots, k, guard=False)


@bspline_basis.mistake("closed_on_the_right", credit=0.75)
def _(t, knots, k):
    """Right everywhere but at the first parameter: there all your functions are 0. Your spans are open on the left and closed on
    the right, so the first knot belongs to none. Put the first knot in: which function should be 1?"""
    return _recursion(t, knots, k, _left_open)


# A7.3 ------------------------------------------------------------------------------------------------------------------------


def _spans(P, k, l):
    return tuple(np.linspace(0.0, 1.0, count - order + 2) for count, order in zip(np.shape(P), (k, l), strict=False))


@exercise(points=6, title="B-spline patch of orders k and l", kind="surface", spans=_spans)
def bspline_patch(u, w, P, k, l):
    """Return the points of the B-spline patch with the control net P, of order k along u and order l along w.

    S(u, w) = Σ_i Σ_j N_i,k(s) N_j,l(t) P_ij on open uniform knots both ways, where u and w in [0, 1] are stretched onto the knots:
    s = u (m - k + 1) and t = w (n - l + 1).

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    P : control net, an array of shape (m, n, 3), first index along u
    k, l : orders = degree + 1 along u and w, whole numbers, k <= m and l <= n; they may differ

    Returns the points, shape of u and w together + (3,).
    """
    return dx.BSplinePatch(P, k, l)(u, w)


@bspline_patch.built_from(open_knots, bspline_basis)
def _(u, w, P, k, l, open_knots, bspline_basis):
    return _on_knots(u, w, P, k, l, open_knots, bspline_basis)


def _on_knots(u, w, P, k, l, open_knots, bspline_basis):
    m, n, _ = np.shape(P)
    along_u = bspline_basis(np.asarray(u) * (m - k + 1), open_knots(m, k), k)
    along_w = bspline_basis(np.asarray(w) * (n - l + 1), open_knots(n, l), l)
    return np.einsum("...i,...j,ijk->...k", along_u, along_w, P)


@bspline_patch.data
def lecture(rng):
    return {"P": P65, "k": 4, "l": 3}


@bspline_patch.data
def any_net_of_5_by_7(rng):
    return {"P": any_net(rng, 5, 7), "k": 3, "l": 4}


@bspline_patch.data
def square_net(rng):
    return {"P": any_net(rng, 6, 6), "k": 2, "l": 4}


@bspline_patch.data(blind=True)
def the_bezier_case(rng):
    return {"P": any_net(rng, 4, 4), "k": 4, "l": 4}


@bspline_patch.mistake("not_scaled", credit=0.5)
def _(u, w, P, k, l):
    """A piece of the right patch, the one next to its first corner: you used u and w themselves as knot parameters. The knots
    go further than 1: up to m - k + 1. Where does your patch end, and where should it?"""
    m, n, _ = np.shape(P)
    return dx.BSplinePatch(P, k, l)(np.asarray(u) / (m - k + 1), np.asarray(w) / (n - l + 1))


@bspline_patch.mistake("orders_exchanged", credit=0.5)
def _(u, w, P, k, l):
    """The two orders have changed places: yours has order l along u and k along w. The corners and the general shape are right,
    which hides it well. Which order belongs to the first index of the net?"""
    m, n, _ = np.shape(P)
    return dx.BSplinePatch(P, min(l, m), min(k, n))(u, w)


@bspline_patch.mistake("order_is_degree", credit=0.5)
def _(u, w, P, k, l):
    """Yours is too smooth: you took k and l for degrees. k = 4 is *cubic*: order = degree + 1, as the lecture has it. Count the
    knots you made: there should be m + k along u."""
    m, n, _ = np.shape(P)
    return dx.BSplinePatch(P, min(k + 1, m), min(l + 1, n))(u, w)


@bspline_patch.mistake("unclamped", credit=0.25)
def _(u, w, P, k, l):
    """Your patch does not reach its corner points: your knots are 0, 1, 2, ... without any repeated ones at the ends. Put u = w = 0
    in; what should come out, and what does it take for that?"""
    return dx.BSplinePatch(P, k, l, "uniform", "uniform")(u, w)


@bspline_patch.mistake("bezier", credit=0.25)
def _(u, w, P, k, l):
    """You have the Bezier patch of the whole net: the orders never enter, and every point pulls everywhere. Move the far corner
    of the net: a B-spline patch does not feel that at u = w = 0.2. With as many points as the order both are the same."""
    return dx.BezierPatch(P)(u, w)


@bspline_patch.mistake("transposed", credit=0.5)
def _(u, w, P, k, l):
    """The right patch with the two parameters exchanged: your u runs along the second index of the net. Put u = 1, w = 0 in: which
    corner of P should come out?"""
    return dx.BSplinePatch(P, k, l)(w, u)


@bspline_patch.mistake("zero_at_end", credit=0.5)
def _(u, w, P, k, l):
    """Right inside, and on the edges u = 1 and w = 1 your patch collapses into the origin: all basis functions are 0 there. The
    last knot belongs to no half-open span. Evaluate your basis at the last knot and add it up."""
    inside = (np.asarray(u) < 1) & (np.asarray(w) < 1)
    return dx.BSplinePatch(P, k, l)(u, w) * inside[..., None]


@bspline_patch.mistake("stretched_too_far", credit=0.5)
def _(u, w, P, k, l):
    """You stretched u to m - k + 2, one span beyond the last knot, where all functions are 0: there your patch falls into the
    origin. The books that print n - k + 2 count the points from 0 to n, so that n is one *less* than their number. Which is the last
    of your knots?"""
    m, n, _ = np.shape(P)
    beyond_u, beyond_w = np.asarray(u) * (m - k + 2) / (m - k + 1), np.asarray(w) * (n - l + 2) / (n - l + 1)
    inside = (beyond_u <= 1) & (beyond_w <= 1)
    S = dx.BSplinePatch(P, k, l)(np.minimum(beyond_u, 1.0), np.minimum(beyond_w, 1.0))
    return np.where(inside[..., None], S, 0.0)


@bspline_patch.mistake("one_order", credit=0.5)
def _(u, w, P, k, l):
    """You used the order k in both directions, and l never enters. In the lecture k may be the same for u and w, or different.
    Along w your patch is smoother, or less smooth, than asked for."""
    return dx.BSplinePatch(P, k, min(k, np.shape(P)[1]))(u, w)


# A7.4 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="NURBS patch", kind="surface", spans=lambda P, h, k, l: _spans(P, k, l))
def nurbs_patch(u, w, P, h, k, l):
    """Return the points of the NURBS patch with the control net P and the weights h, of order k along u and order l along w.

    S = Σ_i Σ_j N_i,k(s) N_j,l(t) h_ij P_ij / Σ_i Σ_j N_i,k(s) N_j,l(t) h_ij on open uniform knots, u and w stretched as for
    the B-spline patch. The weights are called h, because w is a parameter.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    P : control net of *Cartesian* points, not multiplied by their weights; an array of shape (m, n, 3), first index along u
    h : weights, an array of shape (m, n) of numbers above 0
    k, l : orders = degree + 1 along u and w, whole numbers, k <= m and l <= n

    Returns the points, shape of u and w together + (3,).
    """
    return dx.NurbsPatch(P, h, k, l)(u, w)


@nurbs_patch.built_from(bspline_patch)
def _(u, w, P, h, k, l, bspline_patch):
    spread = np.repeat(np.asarray(h, dtype=float)[..., None], 3, axis=-1)
    return np.asarray(bspline_patch(u, w, spread * P, k, l)) / bspline_patch(u, w, spread, k, l)


@nurbs_patch.built_from(open_knots, bspline_basis)
def _(u, w, P, h, k, l, open_knots, bspline_basis):
    spread = np.repeat(np.asarray(h, dtype=float)[..., None], 3, axis=-1)
    over, under = (_on_knots(u, w, net, k, l, open_knots, bspline_basis) for net in (spread * P, spread))
    return over / under


def _blend(u, w, values, k, l):
    """Σ_i Σ_j N_i,k N_j,l values_ij, for values of any dimension, on open uniform knots."""
    m, n = np.shape(values)[:2]
    along_u = spline_row(1.0 * clamped(m + k, k, m - k + 1), k, np.asarray(u) * (m - k + 1))
    along_w = spline_row(1.0 * clamped(n + l, l, n - l + 1), l, np.asarray(w) * (n - l + 1))
    return np.einsum("...i,...j,ij->..." if np.ndim(values) == 2 else "...i,...j,ijd->...d", along_u, along_w, values)


def any_weights(rng, m, n):
    """Weights between 0.4 and 4, neighbours well apart in the mean."""
    return rng.choice([0.4, 0.8, 2.0, 4.0], (m, n)) * rng.uniform(0.9, 1.1, (m, n))


@nurbs_patch.data
def lecture(rng):
    return {"P": P65, "h": H65, "k": 4, "l": 3}


@nurbs_patch.data
def any_net_of_5_by_6(rng):
    return {"P": any_net(rng, 5, 6), "h": any_weights(rng, 5, 6), "k": 3, "l": 4}


@nurbs_patch.data
def square_net(rng):
    return {"P": any_net(rng, 4, 4), "h": any_weights(rng, 4, 4), "k": 2, "l": 3}


@nurbs_patch.data(blind=True)
def all_weights_1(rng):
    return {"P": P65, "h": np.ones((6, 5)), "k": 4, "l": 3}


@nurbs_patch.mistake("not_divided", credit=0.5)
def _(u, w, P, h, k, l):
    """Your surface is blown up: you multiplied by the weights and did not divide by their sum. What is below the fraction bar
    sees to it that a point counts by its *share*. Multiply all weights by 2: nothing should change."""
    return _blend(u, w, np.asarray(h)[..., None] * P, k, l)


@nurbs_patch.mistake("weights_ignored", credit=0.25)
def _(u, w, P, h, k, l):
    """You have the B-spline patch: the weights never enter. With all weights 1 nobody notices. Make one weight very large: the
    surface must come close to that control point."""
    return _blend(u, w, np.asarray(P, dtype=float), k, l)


@nurbs_patch.mistake("already_weighted", credit=0.5)
def _(u, w, P, h, k, l):
    """Below the fraction bar all is right; above it the weights are missing: you took the points to be multiplied by them already,
    as several libraries store them. Here P holds plain Cartesian points. What happens at a corner, where one point counts alone?"""
    return _blend(u, w, np.asarray(P, dtype=float), k, l) / _blend(u, w, np.asarray(h, dtype=float), k, l)[..., None]


@nurbs_patch.mistake("weighted_twice", credit=0.5)
def _(u, w, P, h, k, l):
    """You multiplied the points by their weights twice, perhaps once when you stored them and once in the sum. At a corner
    one point counts alone, and its weight must cancel. Does yours come out there?"""
    h = np.asarray(h, dtype=float)
    return _blend(u, w, h[..., None] ** 2 * P, k, l) / _blend(u, w, h, k, l)[..., None]


@nurbs_patch.mistake("weights_transposed", credit=0.5)
def _(u, w, P, h, k, l):
    """You read the points right, and the weights in the other order: column by column instead of row by row, so that most points carry
    the weight of another one. The four corners hide it. Which weight belongs to P[0, 1]?"""
    h = np.asarray(h, dtype=float)
    return dx.NurbsPatch(P, h.T.reshape(h.shape), k, l)(u, w)


@nurbs_patch.also("weights_transposed")  # written row by row, read column by column
def _(u, w, P, h, k, l):
    h = np.asarray(h, dtype=float)
    return dx.NurbsPatch(P, h.ravel().reshape(h.shape, order="F"), k, l)(u, w)


@nurbs_patch.mistake("orders_exchanged", credit=0.5)
def _(u, w, P, h, k, l):
    """The two orders have changed places: yours has order l along u and k along w. The four corners hide it. Which order belongs to
    the first index of the net, and in which order do you hand the two on?"""
    m, n, _ = np.shape(P)
    return dx.NurbsPatch(P, h, min(l, m), min(k, n))(u, w)


@nurbs_patch.mistake("divided_by_total", credit=0.5)
def _(u, w, P, h, k, l):
    """You divided by the sum of *all* weights, one number for the whole patch. At each place only the functions that live there
    count: the divisor is a function of u and w. With all points equal, is yours that point everywhere?"""
    h = np.asarray(h, dtype=float)
    return _blend(u, w, h[..., None] * P, k, l) / h.sum()


# A7.5 ------------------------------------------------------------------------------------------------------------------------


def evaluated(answer):
    """The NURBS surface of orders (3, 2) on open knots that an answer (P, weights) stands for."""
    if not isinstance(answer, tuple | list) or len(answer) != 2:
        raise ValueError("two things are wanted, the control net and the weights: return P, weights.")
    P, weights = (np.asarray(part, dtype=float) for part in answer)
    if P.shape != (3, 2, 3):
        raise ValueError(
            f"the control net must have shape (3, 2, 3), three points along u by two along w; yours has {P.shape}."
        )
    if weights.shape != (3, 2):
        raise ValueError(f"the weights must have shape (3, 2), one for each control point; yours have {weights.shape}.")
    return dx.NurbsPatch(P, weights, 3, 2)


@exercise(
    points=5,
    title="An exact quarter cylinder",
    kind="net",
    judged_as=evaluated,
    accept={"same set": 1.0, "relabelled": 0.5, "close": 0.8},
)
def nurbs_quarter_cylinder(r, h):
    """Return control net and weights, (P, weights), of a NURBS patch that is a quarter of the cylinder of radius r about z.

    The orders are 3 along u (quadratic) and 2 along w (linear), the knots open. u runs round the quarter with x, y >= 0, from
    (r, 0) to (0, r); w runs up, from z = 0 to z = h. Judged is the surface, not the numbers: whatever gives every point of this
    quarter, and no other, is right.

    r : radius, a length above 0
    h : z of the far end, a length that is not 0; below 0 it hangs down from the xy-plane

    Returns P, an array of shape (3, 2, 3), first index along u, and weights, an array of shape (3, 2) of numbers above 0.
    """
    return _quarter(r, h)


def _quarter(r, h, weight=QUARTER, middle=1.0):
    """Net and weights with another middle weight, or the middle point at another share of the way out from the axis."""
    arc = np.array([[r, 0], [middle * r, middle * r], [0, r]], dtype=float)
    P = np.stack([np.column_stack([arc, np.full(3, z)]) for z in (0.0, h)], axis=1)
    return P, np.array([[1.0, 1.0], [weight, weight], [1.0, 1.0]])


@nurbs_quarter_cylinder.data
def lecture(rng):
    return {"r": 2.0, "h": 5.0}


@nurbs_quarter_cylinder.data
def any_size(rng):
    return {"r": rng.uniform(2.0, 4.0), "h": rng.uniform(1.5, 4.0)}


@nurbs_quarter_cylinder.data
def hanging_down(rng):
    return {"r": rng.uniform(1.5, 2.5), "h": -rng.uniform(1.5, 3.0)}


@nurbs_quarter_cylinder.data(blind=True)
def unit_quarter(rng):
    return {"r": 1.0, "h": 1.0}


@nurbs_quarter_cylinder.mistake("weight_1", credit=0.5)
def _(r, h):
    """The right points, but with all weights 1 your curve is a parabola: up to six per cent too far from the axis. No polynomial
    runs along a circle. Measure the distance from the axis at u = 1/2, then ask what the middle weight must do."""
    return _quarter(r, h, 1.0)


@nurbs_quarter_cylinder.mistake("weight_half", credit=0.75)
def _(r, h):
    """Nearly: your middle weight is the cosine of 60 degrees, right for a *third* of a turn. It is the cosine of half the angle
    that the arc spans. Your curve is an ellipse, a little too close to the axis."""
    return _quarter(r, h, 0.5)


@nurbs_quarter_cylinder.mistake("weight_root2", credit=0.75)
def _(r, h):
    """The right number upside down: your middle weight is above 1 and pulls the curve outwards, or the small weights stand at the
    ends. Must the middle point, which is not on the circle, count more than the ends, or less?"""
    return _quarter(r, h, np.sqrt(2.0))


@nurbs_quarter_cylinder.mistake("middle_on_arc", credit=0.5)
def _(r, h):
    """You put the middle control point *on* the circle. The curve would pass through it only if it were an end; here it must stand
    where the two end tangents meet. Draw the tangents at (r, 0) and (0, r)."""
    return _quarter(r, h, middle=QUARTER)


@nurbs_quarter_cylinder.mistake("points_multiplied", credit=0.75)
def _(r, h):
    """You gave the points already multiplied by their weights, as several libraries store them. Here they are plain Cartesian
    points: look at the z of your middle point at the far end: it must be h, as for its neighbours."""
    P, weights = _quarter(r, h)
    return P * weights[..., None], weights


@nurbs_quarter_cylinder.mistake("height_1", credit=0.5)
def _(r, h):
    """The arc is exact, but your patch is 1 high whatever h is: the height never enters. On a unit cylinder nobody notices. Look
    at the z of your far points."""
    return _quarter(r, 1.0)
