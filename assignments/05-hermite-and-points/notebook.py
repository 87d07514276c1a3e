# %% [markdown]
# # A5 · Algebraic, Hermite and point forms
#
# **Sixteen points of three numbers each make a surface. What does each of the 48 numbers mean?**
#
# Three answers, three forms: coefficients, corners with tangents and twists, points to pass through. You will write seven functions,
# most of them short, and meet one double sum three times. That takes about two hours. Predict, look, write, test it yourself,
# check.

# %% [markdown]
# ## What holds everywhere
#
# * Tables have shape `(m, n, 3)`: the first index goes with $u$, the second with $w$, the last is $x, y, z$.
# * Powers **ascend**: `a[i, j]` multiplies $u^i w^j$. The rival convention is in nearly every book: matrices are printed with $u^3$
#   first. Where a printed matrix is used, this notebook says so.
# * Derivatives are $S_u$ and $S_w$; the **twist** is $S_{uw} = \partial^2 S/\partial u\,\partial w$. Their values at the corner
#   $u = i,\ w = j$ are called $p^u_{ij},\ p^w_{ij},\ p^{uw}_{ij}$ (`pu`, `pw`, `puw`), and the corner itself $p_{ij}$.
#
# Run the next cell first.

# %% setup=true

# %% [markdown]
# ## 1 · How many numbers?
#
# *"x, y, z cubic in u and w"*: every product $u^i w^j$ with $i, j = 0 \dots 3$ may occur, each with a vector of its own. *"48
# algebraic coefficients."* But mixed degrees are allowed too: cubic in $u$, quadratic in $w$. How many numbers is that?
#
# (For the cubic *curve* the lecture once says "16 inputs". It is four vectors, 12 numbers.)

# %%
cubic_by_quadratic = None

# %% [markdown]
# **Task (count_coefficients).** How many numbers are in a polynomial surface of degree `du` in $u$ and `dw` in $w$?


# %% solution="count_coefficients"
def count_coefficients(du, dw):
    """How many numbers a polynomial surface of degree du in u and dw in w is made of.

    du, dw : degrees, 0 or more
    Returns an int.
    """
    ### BEGIN SOLUTION
    return 3 * (du + 1) * (dw + 1)
    ### END SOLUTION


# %%
with once_written():
    reveal(cubic_by_quadratic, count_coefficients(3, 2))
    print("a single point, degrees 0 and 0, wanted 3:", count_coefficients(0, 0))
    print("four corners, degrees 1 and 1, wanted 12: ", count_coefficients(1, 1))
    print("5 x 4 points, degrees 4 and 3, wanted 60: ", count_coefficients(4, 3))

# %% check="count_coefficients"
check(count_coefficients)

# %% [markdown]
# ## 2 · The algebraic form
#
# $$S(u, w) = \sum_{i}\sum_{j} u^i\; a_{ij}\; w^j$$
#
# Weights of $u$, a table, weights of $w$: this double sum comes back in every form, so here it is once for all. Below, the table
# of today, half of it zeros. At $u = w = 0$ only one of its sixteen entries is left. And at $u = w = 1$?

# %%
at_one_one = None  # "a[3, 3]", "the sum of the last row" or "the sum of all entries"


# %%
def mixed(U, table, W):
    """The double sum of U_i table_ij W_j, for weights U (..., m) and W (..., n): points (..., 3)."""
    return np.einsum("...i,ijk,...j->...k", U, np.asarray(table, float), W)


A = np.zeros((4, 4, 3))
A[0, 0], A[1, 0], A[0, 1] = (1, 2, 0), (4, 0, 6), (0, 4, -3)  # constant, u, w
A[1, 1], A[2, 0], A[0, 3] = (0, 1, -5), (0, 0, -6), (0, 0, 3)  # uw, u², w³
A[3, 1], A[3, 3] = (1, 0, 9), (0, 0, -4)  # u³w, u³w³
reveal(at_one_one, f"the sum of all entries, {A.sum(axis=(0, 1))}")

# %% [markdown]
# **Task (algebraic_eval).** For a table of any size `(m, n, 3)`. The weights of $u$ are $1, u, u^2, \dots$, along a new last axis:
# `np.asarray(u)[..., None]` gives $u$ that axis. Let `mixed` do the sums.


# %% solution="algebraic_eval"
def algebraic_eval(u, w, a):
    """The polynomial surface with coefficients a; a[i, j] multiplies u^i w^j.

    u, w : numbers or arrays in [0, 1];  a : (m, n, 3), ascending powers, m and n >= 1
    Returns points, shape of u and w together + (3,).
    """
    m, n, _ = np.shape(a)
    ### BEGIN SOLUTION
    U = np.asarray(u, float)[..., None] ** np.arange(m)
    W = np.asarray(w, float)[..., None] ** np.arange(n)
    return mixed(U, a, W)
    ### END SOLUTION


# %%
with once_written():
    display(plot.view(lambda u, w: algebraic_eval(u, w, A), square=True))

# %%
u, w = np.linspace(0, 1, 9)[:, None], np.linspace(0, 1, 9)[None, :]
with once_written():
    holds("S(0, 0) = a_00", algebraic_eval(0, 0, A), A[0, 0])
    holds("S(1, 1) = the sum of all", algebraic_eval(1, 1, A), A.sum(axis=(0, 1)))
    exchanged = algebraic_eval(w, u, A.swapaxes(0, 1))
    holds("a transposed table exchanges u and w", exchanged, algebraic_eval(u, w, A))
    straight = np.diff(algebraic_eval(u, w, A[:2, :2]), n=2, axis=0)
    holds("2 x 2 coefficients: straight along u, as a bilinear patch", straight)

# %% check="algebraic_eval"
check(algebraic_eval)

# %% [markdown]
# **What changes?** Add 5 to a single number, say `A[2, 1, 2]`, and look again. Somewhere the surface moves; where, and why just so,
# is hard to say. Only the entries around `A[0, 0]` have a meaning one can see: the corner, its two tangents, its twist. That is
# why nobody designs with coefficients.

# %% [markdown]
# ## 3 · Functions that blend ends
#
# A cubic curve by what one *can* see: two end points and two end tangents, $p(t) = F_1\,p(0) + F_2\,p(1) + F_3\,p'(0) + F_4\,p'(1)$.
#
# $F_4$ must be 0 at both ends, start with slope 0 and arrive at $t = 1$ with slope **plus** one. Between the ends, is it positive or
# negative?

# %%
f4_inside = None  # "positive" or "negative"

# %% [markdown]
# **Task (hermite_basis).** $F_1, \dots, F_4$ along a new last axis: `t` of shape `(5, 1)` gives `(5, 1, 4)`. The printed form, powers
# descending:
#
# $$\big[\,t^3\;\; t^2\;\; t\;\; 1\,\big]\; M_F, \qquad M_F = \begin{bmatrix} 2 & -2 & 1 & 1\\ -3 & 3 & -2 & -1\\ 0 & 0 & 1 & 0\\
# 1 & 0 & 0 & 0\end{bmatrix}$$
#
# Some tables order them $p(0), p'(0), p(1), p'(1)$. Here: both points first.


# %% solution="hermite_basis"
def hermite_basis(t):
    """The Hermite blending functions F1, F2, F3, F4, for p(0), p(1), p'(0), p'(1).

    t : number or array
    Returns shape of t + (4,).
    """
    t = np.asarray(t, float)
    ### BEGIN SOLUTION
    F1 = 2 * t**3 - 3 * t**2 + 1
    F3 = t**3 - 2 * t**2 + t
    F4 = t**3 - t**2
    return np.stack([F1, 1 - F1, F3, F4], axis=-1)
    ### END SOLUTION


# %%
t, h = np.linspace(0, 1, 61), 1e-6
with once_written():
    F = hermite_basis(t)
    reveal(f4_inside, "negative: it comes up to 0 from below")
    holds("F1 + F2 = 1", F[:, 0] + F[:, 1], 1)
    holds("F3 is F4 in a mirror: F4(t) = -F3(1 - t)", F[:, 3], -F[::-1, 2])
    holds("at t = 0 only F1 is left", hermite_basis(0), (1, 0, 0, 0))
    for end, wanted in ((0, "0 0 1 0"), (1, "0 0 0 1")):
        slopes = (hermite_basis(end + h) - hermite_basis(end - h)) / (2 * h)
        print(f"slopes at {end}, wanted {wanted}:", np.round(slopes, 3) + 0.0)
    figure = go.Figure().update_layout(height=280, template="none", xaxis_title="t")
    figure.update_layout(margin={"t": 20, "b": 50})
    for k, colour in enumerate(("#0072B2", "#D55E00", "#009E73", "#CC79A7")):
        figure.add_scatter(x=t, y=F[:, k], name=f"F{k + 1}", line={"width": 3, "color": colour})
    display(figure)

# %% check="hermite_basis"
check(hermite_basis)

# %% [markdown]
# **What to see.** $F_3$ and $F_4$ are small: at most 4/27 of a tangent. And at $t = 0$ and $t = 1$ both vanish, so whoever tests
# only there cannot tell a wrong sign or a wrong order. Slopes can.

# %% [markdown]
# ## 4 · Corners, tangents, twists
#
# The same on both sides of a table: $S(u, w) = \sum_i \sum_j F_i(u)\, G_{ij}\, F_j(w)$, with
#
# $$G = \begin{bmatrix} p_{00} & p_{01} & p^w_{00} & p^w_{01}\\ p_{10} & p_{11} & p^w_{10} & p^w_{11}\\ p^u_{00} & p^u_{01} &
# p^{uw}_{00} & p^{uw}_{01}\\ p^u_{10} & p^u_{11} & p^{uw}_{10} & p^{uw}_{11}\end{bmatrix}$$
#
# Four corners, eight tangents, four twists: $12 + 24 + 12 = 48$ numbers again, now with a meaning each. Change the four twists and
# nothing else. How many of the four *edges* of the patch move?

# %%
moving_edges = None

# %% [markdown]
# **Task (hermite_patch).** With `mixed` and your `hermite_basis` this is one line.


# %% solution="hermite_patch"
def hermite_patch(u, w, G):
    """The bicubic patch of corners, tangents and twists.

    u, w : numbers or arrays in [0, 1]
    G : (4, 4, 3), [[p00, p01, pw00, pw01], [p10, p11, pw10, pw11],
                    [pu00, pu01, puw00, puw01], [pu10, pu11, puw10, puw11]]
    Returns points, shape of u and w together + (3,).
    """
    ### BEGIN SOLUTION
    return mixed(hermite_basis(u), G, hermite_basis(w))
    ### END SOLUTION


# %%
G = np.array([
    [[0, 0, 0], [1, 4, 1], [1, 5, 2], [-1, 3, 4]],
    [[5, -1, 2], [6, 3, -1], [0, 6, -3], [2, 3, -2]],
    [[6, 1, 3], [3, -2, 5], [2, 1, 6], [-3, 4, 2]],
    [[4, 0, -4], [7, 2, 1], [5, -2, 3], [1, 3, -7]],
], float)  # fmt: skip
with once_written():
    patch, ends = lambda u, w: hermite_patch(u, w, G), np.array([0.0, 1.0])
    holds("corners", patch(ends[:, None], ends), G[:2, :2])
    slope = (patch(h, 0) - patch(-h, 0)) / (2 * h)
    print("S_u(0, 0), wanted", G[2, 0], ":", np.round(slope, 3) + 0.0)
    slope = (patch(0, 1 + h) - patch(0, 1 - h)) / (2 * h)
    print("S_w(0, 1), wanted", G[0, 3], ":", np.round(slope, 3) + 0.0)
    H = G.copy()
    H[2:, 2:] *= -10  # other twists
    edges = [np.ptp(hermite_patch(*e, H) - patch(*e)) > 1e-12 for e in ((u, 0), (u, 1), (0, w), (1, w))]
    reveal(moving_edges, sum(edges))

# %% check="hermite_patch"
check(hermite_patch)

# %% [markdown]
# ### A trap: the middle of the patch
#
# A classmate left the twists out: a **Ferguson patch**. (The lecture lets it "take four boundary curves"; it takes corners and
# tangents.) You compare the middle point on a patch whose four twists are all $(0, 0, 40)$. Run the cell. Then compare at
# `place = (0.25, 0.75)`.

# %%
place = (0.5, 0.5)
equal = G.copy()
equal[2:, 2:] = 0, 0, 40
without = equal.copy()
without[2:, 2:] = 0
with once_written():
    yours, theirs = hermite_patch(*place, equal), hermite_patch(*place, without)
    holds(f"at {place} both agree", yours, theirs)

# %%
with once_written():
    f, g = (lambda u, w, table=table: hermite_patch(u, w, table) for table in (without, equal))
    display(plot.view(f, against=g, names=("with twists", "without")))

# %% [markdown]
# **What changed?** At ½ the four products $F_3F_3$, $F_3F_4$, $F_4F_3$, $F_4F_4$ are $\tfrac1{64}$ with the signs $+, -, -, +$: four
# equal twists cancel *exactly* in the favourite test point of the textbooks. The picture shows where they live: inside each corner,
# with the edges and the cross through the middle untouched. Test with unequal twists, away from the middle.

# %% [markdown]
# ### In your own words
#
# You are given the four boundary curves of a car's bonnet, cubic each, and no twists.
#
# In three or four sentences: **what of the surface is fixed by the boundary curves, what do the twists decide, and how would you
# notice on the finished part that somebody set them all to zero?**
#
# *3 points: one for what the edges fix (which entries of G); one for what the twists do and where; one for a consequence that
# one could see or measure.*

# %% [markdown] written="what_twists_do" points=3
# ### BEGIN SOLUTION
# Four cubic edges fix the four corners and the eight tangents along the edges, twelve of the sixteen entries of G. So position, and
# the tangent plane at the corners, are settled; the four twists are free.
#
# A twist says how the tangent across an edge turns as one moves along the edge, away from the corner. It leaves all four edges
# where they are and lifts or lowers the inside near its corner, most of all about a third of the way in.
#
# With zero twists the tangents across the edges change there as if the patch were locally a carried curve: the patch has flat spots
# near its corners. On a bonnet one sees them as pinched or dented reflections, and a coordinate measuring machine finds the points
# near the corners off while all the edges are right.
# ### END SOLUTION

# %% [markdown]
# ## 5 · From one table to the other
#
# Powers times a matrix are the blending functions, so $S = [u^3 \dots 1]\;M_F\,G\,M_F^{T}\;[w^3 \dots 1]^T$: *"use the same matrix and
# just extend."* What stands between the powers is the algebraic table, in **printed** order.
#
# In our ascending order `a[0, 0]` is the corner $p_{00}$. Which entry of $G$ is `a[1, 1]`?

# %%
a11 = None  # "p11", "pu00", "pw00" or "puw00"

# %% [markdown]
# **Task (hermite_to_algebraic).** Return the ascending table `a`, so that `algebraic_eval(u, w, a)` is `hermite_patch(u, w, G)`.
# `mixed` multiplies a table by matrices, too: `mixed(X[:, None], G, Y[None, :])` is $X\,G\,Y^T$, for $x$, $y$ and $z$ at once.

# %%
M_F = np.array([[2, -2, 1, 1], [-3, 3, -2, -1], [0, 0, 1, 0], [1, 0, 0, 0]], float)


# %% solution="hermite_to_algebraic"
def hermite_to_algebraic(G):
    """The algebraic coefficients of the Hermite patch of G, powers ascending.

    G : (4, 4, 3), as in hermite_patch
    Returns (4, 4, 3); a[i, j] multiplies u^i w^j.
    """
    ### BEGIN SOLUTION
    printed = mixed(M_F[:, None], G, M_F[None, :])
    return printed[::-1, ::-1]
    ### END SOLUTION


# %%
with once_written():
    a = hermite_to_algebraic(G)
    reveal(a11, "puw00")
    holds("the same surface", algebraic_eval(u, w, a), hermite_patch(u, w, G))
    holds("a_00 = p00", a[0, 0], G[0, 0])
    holds("a_10 = pu00", a[1, 0], G[2, 0])
    holds("a_11 = puw00", a[1, 1], G[2, 2])
    holds("the sum of all is p11", a.sum(axis=(0, 1)), G[1, 1])

# %% check="hermite_to_algebraic"
check(hermite_to_algebraic)

# %% [markdown]
# ## 6 · Which way does it face?
#
# A milling cutter stands on the **normal** $n = S_u \times S_w$, made 1 long. Both derivatives are the same double sum, with the
# slopes $F'$ on one side.
#
# Here is a patch whose whole edge $w = 0$ is a single point. Before you run the cell: what does dividing by the length give
# there?

# %%
on_the_edge = None  # "0", "1", "infinity" or "not a number"


# %%
def hermite_slopes(t):
    """The derivatives F1', F2', F3', F4', shape of t + (4,)."""
    t = np.asarray(t, float)
    return np.stack([3 * t**2, 2 * t, np.ones(t.shape), np.zeros(t.shape)], axis=-1) @ M_F


tent = G.copy()
tent[:, 0] = 0  # both corners and both tangents along the edge w = 0
with once_written():
    S_u = mixed(hermite_slopes(0.5), tent, hermite_basis(0.0))
    S_w = mixed(hermite_basis(0.5), tent, hermite_slopes(0.0))
    n = np.cross(S_u, S_w)
    with np.errstate(invalid="ignore"):
        print("S_u =", S_u, "  n / |n| =", n / np.linalg.norm(n))
reveal(on_the_edge, "not a number: 0 / 0")

# %% [markdown]
# **What went wrong?** Along a collapsed edge $S_u = 0$, so there is no $S_u \times S_w$ to divide by. One NaN spoils a whole tool
# path. Say instead that there is none: $(0, 0, 0)$.
#
# **Task (patch_normal).** $n = S_u \times S_w$ divided by its length; $(0, 0, 0)$ where $|S_u \times S_w| \le 10^{-10}\,|S_u|\,|S_w|$.
# Mind that both sides may be 0. `np.linalg.norm(v, axis=-1, keepdims=True)` measures a whole field of vectors.


# %% solution="patch_normal"
def patch_normal(u, w, G):
    """The unit normals S_u x S_w / |S_u x S_w| of a Hermite patch; (0, 0, 0) where there is none.

    u, w : numbers or arrays in [0, 1];  G : (4, 4, 3), as in hermite_patch
    Returns vectors, shape of u and w together + (3,).
    """
    S_u = mixed(hermite_slopes(u), G, hermite_basis(w))
    S_w = mixed(hermite_basis(u), G, hermite_slopes(w))
    ### BEGIN SOLUTION
    n = np.cross(S_u, S_w)
    length, across, along = (np.linalg.norm(v, axis=-1, keepdims=True) for v in (n, S_u, S_w))
    exists = length > 1e-10 * across * along
    return np.where(exists, n, 0) / np.where(exists, length, 1)
    ### END SOLUTION


# %%
with once_written():
    n, S = patch_normal(u, w, G), hermite_patch(u, w, G)
    holds("|n| = 1", np.linalg.norm(n, axis=-1), 1)
    for name, ahead in (("n·S_u", hermite_patch(u + h, w, G)), ("n·S_w", hermite_patch(u, w + h, G))):
        along = (n * (ahead - S) / h).sum(-1)
        print(f"{name} by small steps, wanted nearly 0: {np.abs(along).max():.0e}")
    swapped = patch_normal(w, u, G.swapaxes(0, 1))
    holds("exchanging u and w turns it round", swapped, -n)
    holds("no normal on the collapsed edge, and no NaN", patch_normal(u, 0, tent))
    holds("in a unit ten million times as large", patch_normal(u, w, 1e-7 * G), n)


# %%
def tent_patch(u, w):
    return hermite_patch(u, w, tent)


tent_patch.normal = lambda u, w: patch_normal(u, w, tent)  # the picture draws yours
with once_written():
    display(plot.view(tent_patch, normals=True))

# %% check="patch_normal"
check(patch_normal)

# %% [markdown]
# ## 7 · Through a grid of points
#
# The third meaning: $m \times n$ points to pass through. *"You have to choose parameter values"*: $t^u_i$ for row $i$, $t^w_j$ for
# column $j$. The weights that are 1 at their own parameter and 0 at all the others are Lagrange's:
#
# $$L_i(t) = \prod_{k \ne i} \frac{t - t_k}{t_i - t_k}$$
#
# Below are the twenty points of today. Pass through the same points with other parameters. Is it the same surface?

# %%
same_surface = None  # True or False

# %%
P = np.array([
    [[-1, 1, 2], [2, 5, -2], [1, 8, 0], [-1, 11, -1]],
    [[4, 2, -2], [3, 4, 1], [2, 7, -1], [3, 14, 1]],
    [[5, -2, -1], [5, 5, -1], [5, 8, 1], [6, 10, 0]],
    [[8, 1, 2], [10, 5, 1], [8, 9, -2], [11, 14, -1]],
    [[12, -1, 0], [11, 6, 1], [10, 7, 1], [11, 12, 1]],
], float)  # fmt: skip


def first_column(t):
    return np.stack([np.interp(t, np.linspace(0, 1, 5), x) for x in P[:, 0].T], axis=-1)


plot.view(first_column, net=P, title="five points along u, four along w; in blue the points P[:, 0]")

# %% [markdown]
# **Task (npoint_patch).** $S = \sum_i\sum_j L_i(u)\,P_{ij}\,L_j(w)$. In `lagrange`, the factor for $k = i$ is left out; `np.delete(nodes,
# i)` are the other nodes.


# %% solution="npoint_patch"
def npoint_patch(u, w, P, tu, tw):
    """The polynomial patch through a grid of points: S(tu[i], tw[j]) = P[i, j].

    u, w : numbers or arrays in [0, 1];  P : (m, n, 3);  tu (m,), tw (n,) : increasing from 0 to 1
    Returns points, shape of u and w together + (3,).
    """

    def lagrange(t, nodes):
        t = np.asarray(t, float)[..., None]
        ### BEGIN SOLUTION
        L = []
        for i, node in enumerate(nodes):
            others = np.delete(nodes, i)
            L.append(np.prod((t - others) / (node - others), axis=-1))
        return np.stack(L, axis=-1)
        ### END SOLUTION

    return mixed(lagrange(u, tu), P, lagrange(w, tw))


# %%
tu, tw = np.array([0, 0.2, 0.45, 0.7, 1]), np.array([0, 0.3, 0.75, 1])
even = np.linspace(0, 1, 5), np.linspace(0, 1, 4)
with once_written():
    holds("through all 20 points", npoint_patch(tu[:, None], tw, P, tu, tw), P)
    holds("equal steps: through them too", npoint_patch(even[0][:, None], even[1], P, *even), P)
    flat = np.ones((5, 4, 3))  # all points the same: the weights must add up to 1
    holds("Σ L_i = 1", npoint_patch(u, w, flat, tu, tw), 1)
    reveal(same_surface, bool(np.allclose(npoint_patch(u, w, P, tu, tw), npoint_patch(u, w, P, *even))))

# %% check="npoint_patch"
check(npoint_patch)

# %%
with once_written():
    f, g = (lambda u, w, nodes=nodes: npoint_patch(u, w, P, *nodes) for nodes in (even, (tu, tw)))
    display(plot.view(f, against=g, names=("tu and tw", "equal steps")))

# %% [markdown]
# **What to see.** The same twenty points, two surfaces: between the points they part by up to 8 % of the size. A measured grid
# has no parameters; whoever fits the surface chooses them, mostly by the distances between the points. Four by four at
# $0, \tfrac13, \tfrac23, 1$ is the classical *16-point form*: the 48 numbers a third time.

# %% [markdown]
# ## If you want more
#
# * Turn your points into coefficients: evaluate the 16-point form, solve for `a`, and compare with `algebraic_eval`.
# * Take 12 x 12 points of a flat sheet, lift one by 1, and pass a patch through them. What happens near the edges? (Runge knew.)
# * At the collapsed edge of the tent the normal has a *limit*. Take $w = 10^{-3}, 10^{-4}, \dots$: where does it go, and why can the
#   formula not say so?
#
# Next: **A6**, where the points attract the surface and are not passed through.
