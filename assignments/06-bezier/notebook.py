# %% [markdown]
# # A6 · Bezier patches
#
# **Sixteen points make a Bezier patch. Through how many of them does it pass?**
#
# You will write five functions: the Bernstein functions, the patch of any degrees, the curves on it, and the way to the
# Hermite form of A5 and back. That takes about two hours. Predict, look, write, test it yourself, check.
#
# One of them answers a question that a student asked in the lecture, and the answer given there is half right.

# %% [markdown]
# ## What holds everywhere
#
# * The control points are a **net**, an array `P` of shape `(m, n, 3)`: *"not arbitrarily 16 points"*, but rows and columns. The
#   first index runs with $u$, the second with $w$, so `P[-1, 0]` is the corner $u = 1,\ w = 0$.
# * **Degree = number of points $-\,1$**; order = number of points. The degrees along $u$ and $w$ may differ.
# * $u$ and $w$ lie in $[0, 1]$, numbers or arrays that broadcast; all lengths have one unit.
#
# Run the next cell first.

# %% setup=true

# %%
# The lecture's size of net, 4 x 4, with generic points; and one that is cubic in u, quadratic in w.
P = np.array([
    [[-2, 2, 2], [1, 2, -2], [-2, 7, 2], [-1, 14, -2]],
    [[1, 0, -2], [5, 3, 0], [1, 9, 1], [3, 11, 0]],
    [[5, 0, 0], [4, 4, 2], [8, 6, -2], [5, 13, -1]],
    [[7, 1, 1], [11, 3, -2], [8, 9, -1], [7, 11, 2]],
], float)  # fmt: skip
P43 = np.array([
    [[0, 0, -1], [2, 4, 1], [-1, 7, -2]], [[3, -2, -2], [5, 2, -1], [3, 8, 0]],
    [[8, 2, 0], [8, 3, 0], [5, 9, 2]], [[8, 0, 1], [11, 5, 1], [11, 8, -2]],
], float)  # fmt: skip
u, w = np.linspace(0, 1, 9)[:, None], np.linspace(0, 1, 9)[None, :]

# %% [markdown]
# ## 1 · A point from a polygon
#
# Begin with one row of four points, and $t = 0.4$. Cut each leg of the polygon at that share of its length; then the two legs
# between the cuts; then the one that is left. The last cut is a point of the **Bezier curve**, and with $t$ from 0 to 1 it
# runs along all of it. De Casteljau worked this way.
#
# Through how many of the four points does the curve pass?

# %%
touched = None  # a number from 0 to 4

# %% fold=true
row = np.array([[0, 0], [1, 3], [4, 3.5], [5, 0]], float)


def cuts(t):
    """The polygon, the cuts of its legs, the cuts between those, and the last one."""
    levels = [row]
    while len(levels[-1]) > 1:
        levels.append((1 - t) * levels[-1][:-1] + t * levels[-1][1:])
    return levels


curve = np.array([cuts(t)[-1][0] for t in np.linspace(0, 1, 101)])
figure = go.Figure().update_layout(height=330, template="none", margin={"t": 20, "b": 20, "l": 20, "r": 20})
figure.add_scatter(x=curve[:, 0], y=curve[:, 1], mode="lines", name="the curve", line={"color": "#009E73", "width": 4})
names = {"polygon": "#888", "1st cuts": "#0072B2", "2nd cuts": "#D55E00", "3rd cut, t = 0.4": "#000"}
for level, (name, colour) in zip(cuts(0.4), names.items(), strict=True):
    figure.add_scatter(x=level[:, 0], y=level[:, 1], mode="lines+markers", name=name, line={"color": colour})
figure.update_xaxes(visible=False).update_yaxes(visible=False, scaleanchor="x")
reveal(touched, sum(bool((curve == point).all(-1).any()) for point in row))
figure

# %% [markdown]
# ## 2 · How much does each point count?
#
# So a point of the curve is a weighted mean of the control points. The weights come from an old identity: $1 = (t + (1 - t))^n$,
# multiplied out. Its $n + 1$ terms are the **Bernstein functions**
#
# $$B_i(t) = \binom{n}{i}\, t^i (1 - t)^{n-i}, \qquad i = 0, \dots, n$$
#
# so without any further work $\sum_i B_i(t) = 1$. For $n = 3$: what is $B_1(1/2)$?

# %%
half = None  # for example 0.25

# %% [markdown]
# **Task (bernstein).** All $n + 1$ functions along the *last* axis, for `t` of any shape: `t` of shape `(5, 1)` gives
# `(5, 1, n + 1)`. The binomials are rows of Pascal's triangle, and `pascal` is written already.
#
# $0^0$ counts as 1, in Python too. So $B_0(0) = 1$, and $n = 0$ gives a single 1.


# %%
def pascal(n):
    """Row n of Pascal's triangle: C(n, 0), ..., C(n, n)."""
    row = np.ones(1)
    for _ in range(n):
        row = np.convolve(row, [1, 1])
    return row


print(pascal(3), pascal(4))


# %% solution="bernstein"
def bernstein(n, t):
    """The n + 1 Bernstein functions of degree n (order n + 1).

    n : degree, 0 or more;  t : number or array in [0, 1]
    Returns an array of shape t.shape + (n + 1,).
    """
    t = np.asarray(t, float)[..., None]
    i = np.arange(n + 1)
    ### BEGIN SOLUTION
    return pascal(n) * t**i * (1 - t) ** (n - i)
    ### END SOLUTION


# %%
t = np.linspace(0, 1, 101)
with once_written():
    reveal(half, bernstein(3, 0.5)[1])
    holds("they add up to 1", bernstein(4, t).sum(-1), 1)
    holds("B_i(t) = B_(n-i)(1 - t)", bernstein(4, t), bernstein(4, 1 - t)[:, ::-1])
    holds("none is negative", np.minimum(bernstein(4, t), 0))
    holds("only the first counts at t = 0", bernstein(3, 0), [1, 0, 0, 0])
    print("t of shape (5, 1), degree 3:", bernstein(3, np.zeros((5, 1))).shape)

# %%
with once_written():
    figure = go.Figure().update_layout(height=280, template="none", xaxis_title="t")
    figure.update_layout(margin={"t": 20, "b": 50, "l": 50, "r": 20})
    for i, name in enumerate(["B₀", "B₁", "B₂", "B₃"]):
        figure.add_scatter(x=t, y=bernstein(3, t)[:, i], mode="lines", name=name)
    display(figure)

# %% check="bernstein"
check(bernstein)

# %% [markdown]
# **What to see.** Each function has one hill, at $t = i/n$. There its point counts most, and still not alone: only at the two
# ends does one function reach 1.

# %% [markdown]
# ## 3 · From a polygon to a net
#
# A row of four points and one parameter make a curve. A net and two parameters make the patch: the two sets of weights are
# multiplied, every $B_i(u)$ with every $B_j(w)$.
#
# $$S(u, w) = \sum_{i=0}^{m-1} \sum_{j=0}^{n-1} B_i(u)\, B_j(w)\, P_{ij}$$
#
# Through how many of the 16 points will the patch pass?

# %%
passes = None  # a number from 0 to 16

# %% [markdown]
# **Task (bezier_patch).** Any net `(m, n, 3)`. Two hints for the shapes: `np.einsum("...i,...j,ijk->...k", a, b, P)` is the double
# sum; or build it in two steps, first blend the rows with the functions of $u$, then the result with those of $w$.
#
# The rival convention: exchange formats and some books list the 16 points in one line, the index of $w$ running fastest in one
# and that of $u$ in another. A line of points has no rows. We always keep the shape.


# %% solution="bezier_patch"
def bezier_patch(u, w, P):
    """The Bezier patch of the net P.

    u, w : numbers or arrays in [0, 1];  P : (m, n, 3), first index along u
    Returns points, shape of u and w together + (3,).
    """
    P = np.asarray(P, float)
    m, n, _ = P.shape
    ### BEGIN SOLUTION
    return np.einsum("...i,...j,ijk->...k", bernstein(m - 1, u), bernstein(n - 1, w), P)
    ### END SOLUTION


# %%
with once_written():
    display(plot.view(lambda u, w: bezier_patch(u, w, P), net=P, square=True))
    t = np.linspace(0, 1, 49)
    S = bezier_patch(t[:, None], t[None, :], P).reshape(-1, 3)
    gap = np.linalg.norm(P.reshape(-1, 1, 3) - S, axis=-1).min(1)  # from each control point
    reveal(passes, int((gap < 1e-9).sum()))

# %% [markdown]
# **Test it yourself.** Say what must hold before you look: the corners; the box of the net, since all weights are positive and
# add up to 1; and moving the net moves the patch, nothing else.

# %%
with once_written():
    S = bezier_patch(u, w, P)
    holds("the corners", S[[0, 0, -1, -1], [0, -1, 0, -1]], P[[0, 0, -1, -1], [0, -1, 0, -1]])
    outside = np.maximum(S - P.max((0, 1)), 0) + np.maximum(P.min((0, 1)) - S, 0)
    holds("no point outside the box of the net", outside)
    M, shift = np.array([[1, 2, 0], [0, 3, 1], [4, 0, 1]]), np.array([5, -6, 7])
    holds("moved net, moved patch", bezier_patch(u, w, P @ M + shift), S @ M + shift)
    edge = np.einsum("...i,ik->...k", bernstein(3, t), P[:, 0])
    holds("the edge w = 0 is the curve of P[:, 0]", bezier_patch(t, 0, P), edge)
    print("degrees 3 and 2:", bezier_patch(u, w, P43).shape)

# %% check="bezier_patch"
check(bezier_patch)

# %% [markdown]
# ### A trap: one point in the middle
#
# Rogers and Adams print this symmetric net, and many a programmer has tried a patch on it, at $u = w = 1/2$. Three classmates
# did so. Run the cell; then set `place = (0.25, 0.75)` and run it again.

# %%
line = [(15, 0), (5, 5), (-5, 5), (-15, 0)]  # z and y along w
net = np.array([[[x, y if abs(x) > 10 else 5, z] for z, y in line] for x in (-15, -5, 5, 15)], float)
classmates = {
    "Asha ": lambda u, w: bezier_patch(w, u, net),
    "Bruno": lambda u, w: bezier_patch(1 - u, w, net),
    "Chen ": lambda u, w: bezier_patch(u, 1 - w, net),
}
place = (0.5, 0.5)
with once_written():
    for name, answer in classmates.items():
        holds(f"{name} agrees with you at {place}", answer(*place), bezier_patch(*place, net))

# %% [markdown]
# **Who made which mistake?** One exchanged $u$ and $w$, one ran $u$ backwards, one $w$. The middle of the square stays where it
# is under all eight exchanges of $u, w, 1 - u, 1 - w$, so one look there sees none of them. A good place is one that none of them
# keeps, such as $(0.25, 0.6)$; and a good net has no symmetry of its own.

# %% [markdown]
# ## 4 · Does every row give a curve on the patch?
#
# A student asked it: does every row or column of the 16 points represent a Bezier curve? The answer was yes.
#
# Take a hill: a flat lattice whose four inner points are lifted by 6. Its second row, `hill[1]`, is four points, the control
# polygon of a cubic curve, no doubt. Does that curve lie on the patch?

# %%
on_patch = None  # "yes" or "no"

# %%
lift = np.outer([0, 6, 6, 0], [0, 1, 1, 0])
hill = np.array([[[3 * i, 3 * j, lift[i, j]] for j in range(4)] for i in range(4)], float)


def of_row(t):
    return np.einsum("...j,jk->...k", bernstein(3, t), hill[1])


with once_written():
    display(plot.view(lambda u, w: bezier_patch(u, w, hill), net=hill, curves={"hill[1]": of_row}))
    reveal(on_patch, "no: it floats above it")

# %% [markdown]
# **What went wrong?** Nothing, except with the sentence. The row *is* the polygon of a Bezier curve, but that curve floats
# over the patch, since at $u = 1/3$ the other rows pull as well. Only the first and last rows and columns give curves that lie
# *on* the patch. The lecture's yes is right for the polygon and wrong for the patch.
#
# Yet hold $u$ at any $u_0$: then only $w$ is left, and the patch is $\sum_j B_j(w)\, Q_j$ for some points $Q_j$. Which?

# %% [markdown]
# For $u_0 = 0$ they are the first row. How many of the 16 points go into one $Q_j$ for $u_0 = 0.3$?

# %%
used = None  # a number

# %% [markdown]
# **Task (iso_curve_net).** Return the control points $Q_j$ of the curve $u = u_0$, an array `(n, 3)`. Look at the double sum once
# more, with $u_0$ put in, and ask which part of it knows nothing of $w$.


# %% solution="iso_curve_net"
def iso_curve_net(P, u0):
    """Control points of the Bezier curve on the patch along which u = u0.

    P : (m, n, 3), first index along u;  u0 : number in [0, 1]
    Returns an array (n, 3).
    """
    P = np.asarray(P, float)
    ### BEGIN SOLUTION
    return np.einsum("i,ijk->jk", bernstein(len(P) - 1, u0), P)
    ### END SOLUTION


# %%
with once_written():
    for u0 in (0, 0.3, 1):
        curve = np.einsum("...j,jk->...k", bernstein(3, t), iso_curve_net(P, u0))
        holds(f"the curve of Q lies on the patch, u0 = {u0}", curve, bezier_patch(u0, t, P))
    holds("u0 = 0 gives the first row", iso_curve_net(P, 0), P[0])
    print("as many points as the net has along w:", iso_curve_net(P43, 0.3).shape)
    reveal(used, 4)

# %% check="iso_curve_net"
check(iso_curve_net)

# %%
with once_written():
    curves = {"polygon of Q": iso_curve_net(hill, 1 / 3), "the row": hill[1]}
    display(plot.view(lambda u, w: bezier_patch(u, w, hill), curves=curves, mark=(1 / 3, 0.5)))

# %% [markdown]
# **What to see.** The same number of points twice. The row stands high above; the polygon of $Q$ is lower and belongs to the
# curve through the marked point. And you have a recipe: blend the columns with $B_i(u_0)$, then blend the result along $w$. The
# whole patch in two easy steps.

# %% [markdown]
# ## 5 · The same patch in other numbers
#
# In A5 a bicubic patch had 4 corners, 8 tangents and 4 twists: also 16 vectors. *"One form can be converted to another."*
#
# Begin with one curve. Its derivative at $t = 0$ is a multiple of the first leg of the polygon, $p'(0) = c\,(P_1 - P_0)$. What is
# $c$ for a cubic?

# %%
factor = None

# %%
with once_written():
    step = 1e-6
    rise = (bezier_patch(step, 0, P) - bezier_patch(0, 0, P)) / step
    print("derivative by u at (0, 0), by a small step:", np.round(rise, 3))
    print("first leg of the polygon, P[1, 0] - P[0, 0]:", P[1, 0] - P[0, 0])
    reveal(factor, round(rise[0] / (P[1, 0] - P[0, 0])[0], 3))

# %% [markdown]
# **Task (bezier_to_hermite).** Fill the four blocks, in the order of A5:
#
# $$G = \begin{bmatrix} p_{00} & p_{01} & p^w_{00} & p^w_{01} \\ p_{10} & p_{11} & p^w_{10} & p^w_{11} \\
# p^u_{00} & p^u_{01} & p^{uw}_{00} & p^{uw}_{01} \\ p^u_{10} & p^u_{11} & p^{uw}_{10} & p^{uw}_{11} \end{bmatrix}$$
#
# Two things to mind. A tangent points where its parameter *grows*, at the far end too. And the twist is a difference of
# differences: $P_{11} - P_{10} - P_{01} + P_{00}$ at the corner $(0, 0)$, times a factor for each of the two derivatives.


# %% solution="bezier_to_hermite"
def bezier_to_hermite(P):
    """Corners, tangents and twists of the bicubic Bezier patch.

    P : (4, 4, 3), first index along u
    Returns G (4, 4, 3): [[p, pw], [pu, puw]], each block 2 x 2, [u corner, w corner].
    """
    P = np.asarray(P, float)
    ### BEGIN SOLUTION
    # One curve at a time: p(0), p(1), p'(0), p'(1) from P0, P1, P2, P3; first along u, then along w.
    C = np.array([[1, 0, 0, 0], [0, 0, 0, 1], [-3, 3, 0, 0], [0, 0, -3, 3]])
    return np.einsum("ai,bj,ijk->abk", C, C, P)
    ### END SOLUTION


# %%
def hermite_patch(u, w, G):
    """The geometric form of A5: F(u) G F(w) with the four blending functions."""
    MF = np.array([[2, -2, 1, 1], [-3, 3, -2, -1], [0, 0, 1, 0], [1, 0, 0, 0]])
    U, W = (np.stack([t**3, t**2, t, np.ones_like(t)], -1) @ MF for t in np.broadcast_arrays(u, w))
    return np.einsum("...i,...j,ijk->...k", U, W, G)


with once_written():
    G = bezier_to_hermite(P)
    holds("corners", G[:2, :2], P[::3, ::3])
    holds("it is the same surface", hermite_patch(u, w, G), bezier_patch(u, w, P))

# %% check="bezier_to_hermite"
check(bezier_to_hermite)

# %% [markdown]
# **What changed?** Nothing: no point of the surface, only what it is told by. That was your strongest test, too: two forms, two
# evaluations, one surface. On a flat lattice *any* factor for the twists would have passed: there all twists are 0.

# %% [markdown]
# ## 6 · And back
#
# Given corners, tangents and twists, where are the control points? On the boundary each is a corner plus or minus a third of
# a tangent. The four inner ones need the twists.
#
# Suppose all twists are 0. Which figure do the corner $P_{00}$ and its three neighbours $P_{10}$, $P_{11}$, $P_{01}$ form?

# %%
figure_of_four = None  # "parallelogram", "square", "any quadrilateral"

# %% [markdown]
# **Task (hermite_to_bezier).** The inverse of the last one: solve it for the control points, or think at each corner: one step
# along $u$, one along $w$, and what the twist adds. Mind the signs where a parameter is at its end.


# %% solution="hermite_to_bezier"
def hermite_to_bezier(G):
    """The control net of the bicubic patch with corners, tangents and twists G.

    G : (4, 4, 3), [[p, pw], [pu, puw]]
    Returns P (4, 4, 3), first index along u.
    """
    G = np.asarray(G, float)
    ### BEGIN SOLUTION
    third = 1 / 3
    C = np.array([[1, 0, 0, 0], [1, 0, third, 0], [0, 1, 0, -third], [0, 1, 0, 0]])
    return np.einsum("ia,jb,abk->ijk", C, C, G)
    ### END SOLUTION


# %%
flat = bend = np.zeros((4, 4, 3))
with once_written():
    G = bezier_to_hermite(P)
    holds("there and back", hermite_to_bezier(G), P)
    holds("back and there", bezier_to_hermite(hermite_to_bezier(G)), G)
    flat, bend = G.copy(), G.copy()
    flat[2:, 2:] = 0
    Q = hermite_to_bezier(flat)
    holds("no twist: P11 = P10 + P01 - P00", Q[1, 1], Q[1, 0] + Q[0, 1] - Q[0, 0])
    holds("the boundary does not know the twists", Q[0], P[0])
    reveal(figure_of_four, "parallelogram")

# %% check="hermite_to_bezier"
check(hermite_to_bezier)

# %% [markdown]
# ### What does a twist do?
#
# Left the patch without twists, right the same corners, tangents and edges with one large twist at $(0, 0)$, coloured by how
# far it is away. Where do they agree?

# %%
agree_at = None  # "corners", "edges" or "nowhere"

# %%
bend[2:, 2:] = 0
bend[2, 2] = (0, 0, 150)


def without(u, w):
    return bezier_patch(u, w, hermite_to_bezier(flat))


def with_one(u, w):
    return bezier_patch(u, w, hermite_to_bezier(bend))


with once_written():
    display(plot.view(with_one, against=without, names=("no twists", "one twist")))
    reveal(agree_at, "edges: a twist moves one inner point, and no edge feels those")

# %% [markdown]
# ### In your own words
#
# A colleague draws the sixteen control points of a car door and says: "Row two is a Bezier curve, so I can cut the sheet along
# it."
#
# In three or four sentences: **what is true about the row, why is its curve not on the door, and what must she compute to cut
# along $u = 1/3$?**
#
# *3 points: one for what a row is (a polygon of some curve) and which rows lie on the patch; one for the reason, in the weights of
# the other rows; one for the control points to be computed, with how.*

# %% [markdown] written="row_of_the_net" points=3
# ### BEGIN SOLUTION
# Any row of four points is the control polygon of some cubic Bezier curve; that much is true. But only the curves of the first
# and the last row (and column) lie on the patch.
#
# At u = 1/3 the functions B0, B2 and B3 are not zero, so all four rows pull at the patch there; only at u = 0 and u = 1 one row
# counts alone.
#
# She needs Q_j = sum over i of B_i(1/3) P_ij, four points, each a blend of one whole column; their Bezier curve is the curve
# u = 1/3 of the door.
# ### END SOLUTION

# %% [markdown]
# ## If you want more
#
# * Pull one inner point, `P[1, 2] += (0, 0, 10)`, and draw both patches. How far does the change reach? (A7 has an answer to that.)
# * Raise the degree without moving the patch: new row $i$ is $\frac{i}{m} P_{i-1} + (1 - \frac{i}{m}) P_i$ for $m$ rows.
# * De Casteljau's way: `for _ in range(m - 1): P = (1 - u0) * P[:-1] + u0 * P[1:]`. What is left in the end, and which of your
#   functions is it?
#
# Next: **A7**, where a point pulls at its own neighbourhood only.
