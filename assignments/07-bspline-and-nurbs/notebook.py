# %% [markdown]
# # A7 · B-spline and NURBS
#
# **Somebody pulls at one control point of a bonnet. How much of the bonnet should move?**
#
# You will write five functions: the knots, the basis functions, the B-spline patch, the NURBS patch, and a quarter of a cylinder
# that is exact. That takes about two hours. Predict, look, write, test it yourself, check. Each function calls the ones before
# it.

# %% [markdown]
# ## What holds everywhere
#
# * `P` is a net `(m, n, 3)`, first index along $u$; $k$ is the **order** along $u$ and $l$ that along $w$. *"k can be the same
#   for u and w or different."* **Order = degree + 1**: $k = 4$ is cubic.
# * $u$ and $w$ lie in $[0, 1]$. On the knots we count in spans, with a parameter $t$.
# * Weights are called $h$, because $w$ is taken.
# * The rival convention: many books and programs count by the degree, call it $p$ or even $k$, and mean one less. Ask each time.
#
# Run the next cell first.

# %% setup=true
# ruff: noqa: E741 (k and l are the orders, as the lecture names them)

# %% [markdown]
# ## 1 · What is wrong with Bezier?
#
# Seven points, one Bezier curve of degree 6. Somebody pulls the *second* point upwards. Which part of the curve moves: the
# first third, the first half, or all of it?

# %%
moves = None  # "third", "half" or "all"

# %% fold=true
row = np.array([[0, 0], [1, 2], [2, 3], [4, 3], [6, 2.5], [7, 1], [8, 0]], float)
pulled = row + np.array([[0, 0], [0, 2], *[[0, 0]] * 5])
figure = go.Figure().update_layout(height=330, template="none", margin={"t": 20, "b": 20, "l": 20, "r": 20})
curves = []
for polygon, name, colour in ((row, "before", "#0072B2"), (pulled, "after", "#D55E00")):
    levels = polygon[None].repeat(101, axis=0)
    share = np.linspace(0, 1, 101)[:, None, None]
    while levels.shape[1] > 1:  # de Casteljau
        levels = (1 - share) * levels[:, :-1] + share * levels[:, 1:]
    curves.append(levels[:, 0])
    figure.add_scatter(x=polygon[:, 0], y=polygon[:, 1], mode="lines+markers", showlegend=False, line={"color": "#bbb"})
    figure.add_scatter(x=curves[-1][:, 0], y=curves[-1][:, 1], mode="lines", name=name, line={"color": colour, "width": 4})
figure.update_xaxes(visible=False).update_yaxes(visible=False, scaleanchor="x")
gap = np.abs(curves[1] - curves[0]).max(1)
reveal(moves, f"all: even at t = 0.9 it moves by {gap[90]:.4f}; only the two ends stand still")
figure

# %% [markdown]
# **What to see.** Every Bernstein function is above 0 on the whole open interval, so every point pulls everywhere, and more points
# mean a higher degree. A **B-spline** cuts the interval into spans, at *knots*. Each function lives on a few spans only, and the
# degree is yours to choose.

# %% [markdown]
# ## 2 · How many spans?
#
# For $m$ points and order $k$ there are $m + k$ knots. *Open uniform* ones are 0, $k$ times; then $1, 2, \dots, m - k$; then
# $m - k + 1$, again $k$ times. The repeated knots at the ends make the curve reach its first and last points.
#
# Six points, $k = 4$. How many spans are not empty, that is, of how many cubic pieces is the curve made?

# %%
pieces = None

# %% [markdown]
# **Task (open_knots).** Whole numbers, as above. Where $k < 1$ or $k > m$ no such curve exists: raise a `ValueError`. (Some tables
# scale the knots to end at 1. That changes no curve, but it is another vector.)


# %% solution="open_knots"
def open_knots(m, k):
    """Open uniform knots for m points and order k = degree + 1.

    Returns an array of m + k whole numbers. Raises ValueError unless 1 <= k <= m.
    """
    ### BEGIN SOLUTION
    if not 1 <= k <= m:
        raise ValueError(f"the order must be from 1 to the number of points {m}; got {k}")
    return np.array([0] * k + list(range(1, m - k + 1)) + [m - k + 1] * k)
    ### END SOLUTION


# %%
with once_written():
    knots = open_knots(6, 4)
    print(knots)
    holds("m + k knots", len(knots), 6 + 4)
    holds("they never decrease", np.minimum(np.diff(knots), 0))
    holds("m = k: the ends only", open_knots(3, 3), [0, 0, 0, 1, 1, 1])
    reveal(pieces, int((np.diff(knots) > 0).sum()))

# %% check="open_knots"
check(open_knots)

# %% [markdown]
# ## 3 · Which functions live where?
#
# Order 1: $N_{i,1}$ is 1 on its own span $t_i \le t < t_{i+1}$ and 0 elsewhere. From there each order is made of two neighbours of
# the order below, by Cox and de Boor:
#
# $$N_{i,q}(t) = \frac{t - t_i}{t_{i+q-1} - t_i}\,N_{i,q-1}(t) + \frac{t_{i+q} - t}{t_{i+q} - t_{i+1}}\,N_{i+1,q-1}(t)$$
#
# where $0/0$ counts as 0. With six points and $k = 4$: how many of the six functions are above 0 at $t = 1.5$?

# %%
alive = None  # a number from 1 to 6

# %% [markdown]
# Here are the functions of order 1 as just defined, and a quotient that knows $0/0 = 0$. At every $t$ one of them should be 1.
# Is it so at the last knot, $t = 3$?

# %%
sum_at_end = None  # 0, 1 or 2


# %%
def order_1(t, knots):
    """1 on the span t_i <= t < t_(i+1), 0 elsewhere; t has shape (..., 1), spans run last."""
    return np.where((knots[:-1] <= t) & (t < knots[1:]), 1.0, 0.0)


def share(a, b):
    """a / b, and 0 where b is 0."""
    return np.divide(a, b, out=np.zeros(np.broadcast(a, b).shape), where=b != 0)


knots = np.array([0, 0, 0, 0, 1, 2, 3, 3, 3, 3], float)
for t in (0.0, 1.0, 2.5, 3.0):
    print(f"t = {t}: {order_1(t, knots)}, their sum is {order_1(t, knots).sum():g}")
reveal(sum_at_end, int(order_1(3.0, knots).sum()))

# %% [markdown]
# **What went wrong?** Half-open spans share out every parameter but the very last: no span $t_i \le t < t_{i+1}$ holds $t = 3$. Then
# all functions are 0 there, and the end of the curve falls into the origin. At least five public libraries had this bug. So *the
# last span that is not empty is closed on the right as well*.

# %% [markdown]
# **Task (bspline_basis).** All $m$ functions, along the last axis. Begin with order 1, mend the last span, and climb to order $k$.
# Each step has one function fewer than the one before: two neighbours make one.


# %% solution="bspline_basis"
def bspline_basis(t, knots, k):
    """All m = len(knots) - k basis functions of order k = degree + 1, by Cox and de Boor.

    t : number or array in [knots[k-1], knots[m]];  knots : (m + k,), never decreasing
    Returns an array of shape t.shape + (m,).
    """
    t, knots = np.asarray(t, float)[..., None], np.asarray(knots, float)
    N = order_1(t, knots)
    ### BEGIN SOLUTION
    last = np.flatnonzero(np.diff(knots))[-1]
    N[..., last] += t[..., 0] == knots[-1]
    for q in range(2, k + 1):
        i = np.arange(len(knots) - q)
        up = share(t - knots[i], knots[i + q - 1] - knots[i])
        N = up * N[..., :-1] + share(knots[i + q] - t, knots[i + q] - knots[i + 1]) * N[..., 1:]
    return N
    ### END SOLUTION


# %%
t = np.linspace(0, 3, 121)
with once_written():
    N = bspline_basis(t, knots, 4)
    reveal(alive, int((bspline_basis(1.5, knots, 4) > 0).sum()))
    holds("they add up to 1, ends included", N.sum(-1), 1)
    holds("none is negative", np.minimum(N, 0))
    holds("the first lives on one span only", N[t >= 1, 0])
    holds("at the end only the last counts", bspline_basis(3, knots, 4), [0, 0, 0, 0, 0, 1])
    s = np.linspace(0, 1, 9)
    quadratic = np.stack([(1 - s) ** 2, 2 * s * (1 - s), s**2], -1)
    holds("m = k: Bernstein", bspline_basis(s, [0, 0, 0, 1, 1, 1], 3), quadratic)

# %%
with once_written():
    figure = go.Figure().update_layout(height=280, template="none", xaxis_title="t")
    figure.update_layout(margin={"t": 20, "b": 50, "l": 50, "r": 20})
    for i in range(6):
        figure.add_scatter(x=t, y=bspline_basis(t, knots, 4)[:, i], mode="lines", name=f"N{i}")
    display(figure)

# %% check="bspline_basis"
check(bspline_basis)

# %% [markdown]
# ## 4 · The patch
#
# As for Bezier, every function of $u$ meets every function of $w$. One thing is new: $u$ ends at 1, the knots end at $m - k + 1$.
# So $u$ is stretched, $t = u\,(m - k + 1)$, and $w$ likewise.
#
# Here is a net of $6 \times 5$ points, with $k = 4$ and $l = 3$. Move the corner `P[0, 0]`. How far can $S(1, 1)$ move?

# %%
far_corner = None  # a distance, as a share of that of P[0, 0]

# %%
P = np.array([
    [[0, -2, 1], [-2, 5, 0], [-1, 9, 2], [1, 13, -2], [-2, 17, 0]],
    [[5, -2, -1], [3, 2, 0], [2, 6, 1], [4, 10, 2], [3, 17, -1]],
    [[7, 2, 0], [5, 4, 1], [4, 9, 0], [4, 12, 2], [4, 16, -2]],
    [[11, -1, 0], [9, 6, 1], [11, 7, -1], [8, 10, 0], [8, 17, 0]],
    [[12, 2, 0], [10, 2, 1], [12, 7, 2], [10, 11, -2], [10, 14, 1]],
    [[14, 1, 0], [17, 5, 1], [13, 8, 1], [14, 11, -2], [17, 16, -2]],
], float)  # fmt: skip
u, w = np.linspace(0, 1, 9)[:, None], np.linspace(0, 1, 9)[None, :]

# %% [markdown]
# **Task (bspline_patch).** Open knots both ways. `np.einsum("...i,...j,ijk->...k", a, b, P)` is the double sum.


# %% solution="bspline_patch"
def bspline_patch(u, w, P, k, l):
    """The B-spline patch of the net P, order k along u and l along w, on open uniform knots.

    u, w : numbers or arrays in [0, 1];  P : (m, n, 3), first index along u;  k <= m, l <= n : orders
    Returns points, shape of u and w together + (3,).
    """
    P, u, w = np.asarray(P, float), np.asarray(u, float), np.asarray(w, float)
    m, n = P.shape[:2]
    ### BEGIN SOLUTION
    along_u = bspline_basis(u * (m - k + 1), open_knots(m, k), k)
    along_w = bspline_basis(w * (n - l + 1), open_knots(n, l), l)
    return np.einsum("...i,...j,ijk->...k", along_u, along_w, P)
    ### END SOLUTION


# %%
lines = ([0, 1 / 3, 2 / 3, 1], [0, 1 / 3, 2 / 3, 1])  # the knots, as values of u and of w
with once_written():
    display(plot.view(lambda u, w: bspline_patch(u, w, P, 4, 3), net=P, knots=lines))

# %%
with once_written():
    S = bspline_patch(u, w, P, 4, 3)
    holds("the corners", S[[0, 0, -1, -1], [0, -1, 0, -1]], P[[0, 0, -1, -1], [0, -1, 0, -1]])
    outside = np.maximum(S - P.max((0, 1)), 0) + np.maximum(P.min((0, 1)) - S, 0)
    holds("no point outside the box of the net", outside)
    moved = P.copy()
    moved[0, 0] += (0, 0, 5)
    shift = np.abs(bspline_patch(u, w, moved, 4, 3) - S).max(-1)
    holds("a corner is felt on its own spans only", shift[u[:, 0] >= 1 / 3])
    reveal(far_corner, shift[-1, -1])

# %% check="bspline_patch"
check(bspline_patch)

# %% [markdown]
# ### How much of the bonnet?
#
# Back to the first question: pull `P[1, 1]` upwards by 12. Left before, right after, coloured by how far it has moved. On paper
# first: the second function of $u$ lives on two of the three spans, and so does the second function of $w$.

# %%
with once_written():
    bonnet = P.copy()
    bonnet[1, 1] += (0, 0, 12)

    def before(u, w):
        return bspline_patch(u, w, P, 4, 3)

    def after(u, w):
        return bspline_patch(u, w, bonnet, 4, 3)

    display(plot.view(after, against=before, names=("before", "after")))

# %% [markdown]
# **What changed?** A hill on two spans by two. The rest is dark: not nearly still, but *exactly* still. That is what the knots are
# for.

# %% [markdown]
# ### A trap: as many points as the order
#
# Three classmates try their patches on a net of $4 \times 4$ points with $k = l = 4$. Run the cell; then write
# `trap = (P, 4, 3)` and run it again.

# %%
trap = (P[:4, :4], 4, 4)
classmates = {
    "Asha ": lambda P, k, l: bspline_patch(u / (len(P) - k + 1), w / (len(P[0]) - l + 1), P, k, l),
    "Bruno": lambda P, k, l: bspline_patch(u, w, P, len(P), len(P[0])),
    "Chen ": lambda P, k, l: bspline_patch(u, w, P, l, k),
}
with once_written():
    for name, answer in classmates.items():
        holds(f"{name} agrees with you", answer(*trap), bspline_patch(u, w, *trap))

# %% [markdown]
# **Who made which mistake?** One forgot to stretch $u$, one made a Bezier patch of the whole net, one exchanged the orders. With as
# many points as the order there is a single span of length 1, and B-spline, Bezier and $t = u$ are all the same thing. A good test
# has more points than the order, and two different orders.

# %% [markdown]
# ## 5 · One more number per point
#
# NURBS: each point gets a weight $h_{ij} > 0$, and the sum is divided so that the shares add up to 1 again:
#
# $$S(u, w) = \frac{\sum_i \sum_j N_{i,k}\, N_{j,l}\; h_{ij} P_{ij}}{\sum_i \sum_j N_{i,k}\, N_{j,l}\; h_{ij}}$$
#
# What happens to the surface if *all* weights are multiplied by 2?

# %%
doubled = None  # "twice as large", "closer to the net" or "nothing"

# %% [markdown]
# **Task (nurbs_patch).** `P` holds plain Cartesian points. (Several libraries store them multiplied by their weights; ours are
# not.) Above and below the bar stands the same sum, once of vectors and once of numbers. Can `bspline_patch` do both?


# %% solution="nurbs_patch"
def nurbs_patch(u, w, P, h, k, l):
    """The NURBS patch of the net P with weights h, of orders k and l, on open uniform knots.

    u, w : numbers or arrays in [0, 1];  P : (m, n, 3), Cartesian;  h : (m, n), above 0;  k, l : orders
    Returns points, shape of u and w together + (3,).
    """
    P, h = np.asarray(P, float), np.asarray(h, float)[..., None]
    ### BEGIN SOLUTION
    return bspline_patch(u, w, h * P, k, l) / bspline_patch(u, w, h, k, l)
    ### END SOLUTION


# %%
h = np.array([
    [3, 4, 1, 4, 2], [3, 3, 2, 4, 1], [2, 2, 3, 2, 1],
    [1, 1, 1, 1, 4], [1, 3, 4, 1, 2], [2, 2, 4, 1, 4],
], float)  # fmt: skip
with once_written():
    S = nurbs_patch(u, w, P, h, 4, 3)
    holds("the corners", S[[0, 0, -1, -1], [0, -1, 0, -1]], P[[0, 0, -1, -1], [0, -1, 0, -1]])
    holds("all weights times 2", nurbs_patch(u, w, P, 2 * h, 4, 3), S)
    even = nurbs_patch(u, w, P, np.full((6, 5), 0.7), 4, 3)
    holds("equal weights: the B-spline patch", even, bspline_patch(u, w, P, 4, 3))
    outside = np.maximum(S - P.max((0, 1)), 0) + np.maximum(P.min((0, 1)) - S, 0)
    holds("no point outside the box of the net", outside)
    reveal(doubled, "nothing")

# %% check="nurbs_patch"
check(nurbs_patch)

# %% [markdown]
# **What does one weight do?** Let $h_{31}$ grow. Which point does the surface run to, and does it ever get there? Change the 20.

# %%
with once_written():
    heavy = np.ones((6, 5))
    heavy[3, 1] = 20
    point = {"P[3, 1]": P[3, 1]}
    display(plot.view(lambda u, w: nurbs_patch(u, w, P, heavy, 4, 3), curves=point, knots=lines))

# %% [markdown]
# ## 6 · A cylinder, exactly
#
# No polynomial runs along a circle, so no Bezier and no B-spline patch is a cylinder. A quotient of polynomials can do it. Take a
# quarter: the ends $(r, 0)$ and $(0, r)$, and the middle control point $(r, r)$, where the two end tangents meet.
#
# First with all weights 1. How far from the axis is $u = 1/2$, in per cent of $r$?

# %%
per_cent = None  # 100 would be exact


# %%
def quarter_with(middle, r=1.0, h=1.0):
    arc = [(r, 0), (r, r), (0, r)]
    net = np.array([[(x, y, 0), (x, y, h)] for x, y in arc], float)
    return lambda u, w: nurbs_patch(u, w, net, [[1, 1], [middle, middle], [1, 1]], 3, 2)


with once_written():
    for middle in (1.0, 0.8, 0.6, 0.4):
        x, y, _ = quarter_with(middle)(0.5, 0)
        print(f"middle weight {middle}: distance from the axis {100 * np.hypot(x, y):.2f} %")
    x, y, _ = quarter_with(1.0)(0.5, 0)
    reveal(per_cent, round(100 * np.hypot(x, y), 2), "%")

# %% [markdown]
# Somewhere between 0.8 and 0.6 it is right at $u = 1/2$, and then everywhere. At $u = 1/2$ the point is
# $(C_0 + 2\,h_1 C_1 + C_2)/(2 + 2h_1)$, where the $C$ are the three control points. Ask for the distance $r$ and solve for $h_1$;
# or think of half the angle that the arc spans.
#
# **Task (nurbs_quarter_cylinder).** Return the net `(3, 2, 3)` and the weights `(3, 2)` for orders 3 and 2. $u$ runs from $(r, 0)$
# to $(0, r)$, $w$ from $z = 0$ to $z = h$. Judged is the *surface*: any weights that give every point of the quarter are right.


# %% solution="nurbs_quarter_cylinder"
def nurbs_quarter_cylinder(r, h):
    """Net and weights of an exact quarter cylinder: orders 3 along u and 2 along w, open knots.

    r > 0 : radius;  h : z of the far end, may be negative
    Returns (P, weights): arrays (3, 2, 3) and (3, 2), first index along u.
    """
    ### BEGIN SOLUTION
    s = np.cos(np.pi / 4)
    P = np.array([[(x, y, 0), (x, y, h)] for x, y in [(r, 0), (r, r), (0, r)]], float)
    return P, np.array([[1, 1], [s, s], [1, 1]])
    ### END SOLUTION


# %%
with once_written():
    net, weights = nurbs_quarter_cylinder(r=2, h=3)
    S = nurbs_patch(u, w, net, weights, 3, 2)
    holds("x² + y² = r²", S[..., 0] ** 2 + S[..., 1] ** 2, 4)
    holds("z does not depend on u", S[..., 2], S[:1, :, 2])
    holds("it begins at (r, 0, 0)", S[0, 0], (2, 0, 0))
    holds("it ends at (0, r, h)", S[-1, -1], (0, 2, 3))
    display(plot.view(lambda u, w: nurbs_patch(u, w, net, weights, 3, 2), net=net, square=True))

# %% check="nurbs_quarter_cylinder"
check(nurbs_quarter_cylinder)

# %% [markdown]
# ### In your own words
#
# For the cylinder of A1, $u = 1/4$ is a quarter of the way round. On your quarter $u = 1/2$ lies at 45°. Where does $u = 1/4$ lie?
# Compute it.
#
# In three or four sentences: **in which sense are the two surfaces the same, in which are they not, and why can no choice of
# weights make $u$ the angle?**
#
# *3 points: one for the set of points, the same exactly; one for the parameter, with the angle at $u = 1/4$; one for the reason,
# in what a quotient of polynomials can and cannot be.*

# %% [markdown] written="is_u_the_angle" points=3
# ### BEGIN SOLUTION
# As sets of points they are the same, exactly: x² + y² = r² holds for every u, and z runs from 0 to h on both.
#
# As maps they differ. At u = 1/4 the quarter stands at arctan(0.736/1.860), about 21.6 degrees, not at 22.5: it starts
# more slowly, is faster in the middle, and agrees with the even one at u = 0, 1/2 and 1 only.
#
# If u were the angle, x would be r cos(πu/2). That is no quotient of polynomials: as a function of all real u it has infinitely
# many zeros, and a quotient has finitely many. Weights change the speed, never the kind of function.
# ### END SOLUTION

# %% [markdown]
# ## If you want more
#
# * Give your quarter the weights 1, 1, 2 along $u$. Same points? Same speed? What does `check` say of it?
# * Four quarters make a whole circle: nine points and the knots 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4. Why must the inner knots be double?
# * Draw the net `P` with `k, l = 2, 2`, then `3, 3` and `4, 4`, and at last `6, 5`. Which one is the net itself, and which one Bezier?
#
# Next: **A8**, where four boundary curves, and then six faces, make the whole.
