# %% [markdown]
# # What control points do
#
# **How can a point shape a surface that never touches it?**
#
# You know one move: from one point towards another, a share of the way. This chapter does nothing else. Repeated, the move
# makes Bezier curves and patches; with a ruler of knots beside it, B-splines; one dimension higher, NURBS and an exact circle.
# It ends where one number too small turns a quarter of a circle into the other three.
#
# It takes about two hours, and halfway there is a good place to stop for tonight. Type your guess before you run the cell that
# answers; nobody marks it.

# %% setup=true
import directrix as dx
from directrix.plot import palette
from plotly.subplots import make_subplots

from autograder.catalogue import shipped


def flat(*places):
    """Points (x, y) of a plane, as an array (n, 3) with z = 0."""
    return np.array([(x, y, 0) for x, y in places], float)


def paper(height=340, **more):
    """An empty sheet for a drawing in the plane, the same scale both ways."""
    figure = go.Figure().update_layout(height=height, template="none", margin={"t": 10, "b": 10, "l": 10, "r": 10}, **more)
    figure.update_layout(
        paper_bgcolor=palette.CLEAR, plot_bgcolor=palette.CLEAR, font={"color": palette.INK, "family": palette.FONT}
    )
    return figure.update_xaxes(visible=False).update_yaxes(visible=False, scaleanchor="x")


def draw(figure, points, name=None, colour=palette.CURVE, width=4, mode="lines", **more):
    """A line through points, in the legend where it has a name."""
    x, y = np.asarray(points)[:, :2].T
    line, marker = {"color": colour, "width": width, "simplify": False}, {"color": colour, "size": 8}
    figure.add_scatter(x=x, y=y, mode=mode, name=name, showlegend=name is not None, line=line, marker=marker, **more)


def polygon(figure, points, name="control polygon", **more):
    """Control points and the legs between them."""
    draw(figure, points, name, palette.NET, 1.5, "lines+markers", **more)


def caption(figure, **words):
    """The line below a 3-D picture: what is drawn, each in its colour."""
    figure.layout.annotations[0].text = "&nbsp;&nbsp;&nbsp;".join(
        f"<span style='color:{colour}'>━ {name.replace('_', ' ')}</span>" for name, colour in words.items()
    )


def from_here(figure, x, y, z, height=520):
    """The camera of a 3-D picture, further round or nearer than usual."""
    figure.layout.height, figure.layout.scene.camera.eye = height, {"x": x, "y": y, "z": z}


t_fine = np.linspace(0, 1, 481)

# %% [markdown]
# ## 1 · One move
#
# Two points $A$ and $B$, and a number $t$ from 0 to 1. Go from $A$ towards $B$, the share $t$ of the way. You are at
#
# $$(1 - t)\,A + t\,B$$
#
# a **mix** of the two. Its shares are $1 - t$ and $t$, always together 1. Remember these two words: together 1.
#
# Now three points. One walker goes from $A$ to $B$, a second at the same time from $B$ to $C$, and an elastic string is
# stretched between them. A third walks along the string, always the share $t$ of its length. What does her path look like?

# %%
third = None  # "a straight line", "a circle", "a parabola" or "a line with a corner"

# %% fold=true
A, B, C = corners = flat((0, 0), (4, 5), (9, 1))
figure = paper(legend={"x": 0.75, "y": 0.95})
for t in np.linspace(0, 1, 17):
    draw(figure, [(1 - t) * A + t * B, (1 - t) * B + t * C], colour="#C9C9C9", width=1)
polygon(figure, corners, "A, B, C", text=["A", "B", "C"], textposition=["bottom center", "top center", "bottom center"])
figure.data[-1].update(mode="lines+markers+text", textfont={"size": 15})
figure.update_yaxes(range=[-0.9, 5.7])
draw(figure, dx.BezierCurve(corners)(t_fine), "the third walker")
here = dx.BezierCurve(corners)(0.375)
draw(figure, [0.625 * A + 0.375 * B, 0.625 * B + 0.375 * C], "the string at t = 3/8", palette.MARK, 2, "lines+markers")
draw(figure, [here], None, palette.MARK, 2, "markers")
reveal(third, "a parabola")
figure

# %% [markdown]
# **Look at the strings.** Each touches the curve in one point: the third walker always moves *along* the string. At the start
# it lies on $AB$, at the end on $BC$.
#
# Put one mix into the other, and collect:
#
# $$(1-t)\big[(1-t)A + tB\big] + t\big[(1-t)B + tC\big] = (1-t)^2 A + 2t(1-t)\,B + t^2\, C$$
#
# Second powers of $t$, so a parabola. And the three shares are still together 1, since each mix was. $B$ is never reached: its
# share, $2t(1-t)$, is at most $1/2$. Yet it bends everything.

# %% [markdown]
# ## 2 · Again and again
#
# More points? Mix all neighbours: $n$ points become $n - 1$. Mix those again, and again, until one is left. With $t$ from 0 to
# 1 it runs along the **Bezier curve** of these **control points**; the legs between them are the **control polygon**. Paul de
# Casteljau found this at Citroën in 1959, and Citroën kept it secret; Pierre Bézier of Renault published, and gave the name.
#
# $n$ points make degree $n - 1$. The decisive line is missing. Write it: from all points but the last, towards all but the
# first.


# %%
def mix(a, b, t):
    """The share t of the way from a to b."""
    return (1 - t) * a + t * b


def casteljau(points, t):
    """The point at t of the Bezier curve of the control points, an array (n, ...)."""
    for _ in range(len(points) - 1):
        ### BEGIN SOLUTION
        points = mix(points[:-1], points[1:], t)
        ### END SOLUTION
    return points[0]


# %% [markdown]
# Test it without a model answer. What must be true? It starts and ends at the ends. Run backwards it passes the same places.
# Three points give the three shares above. And if all points are one point, nothing else may come out.

# %%
zigzag = flat((0, 0), (2, 4), (6, -3), (10, 4), (14, -3), (18, 4), (20, 0))
with once_written():
    holds("t = 0 is the first point", casteljau(zigzag, 0), zigzag[0])
    holds("t = 1 is the last", casteljau(zigzag, 1), zigzag[-1])
    holds("backwards: the same places", casteljau(zigzag[::-1], 0.3), casteljau(zigzag, 0.7))
    shares = 0.5625 * zigzag[0] + 0.375 * zigzag[1] + 0.0625 * zigzag[2]
    holds("three points, t = 1/4: shares 9/16, 6/16, 1/16", casteljau(zigzag[:3], 0.25), shares)
    holds("all points one point", casteljau(np.full((5, 3), 7.0), 0.3), 7)

# %% [markdown]
# ### What the polygon promises
#
# All shares lie between 0 and 1 and are together 1. Everything else follows:
#
# * **End points**, and there the curve leaves along the first leg and arrives along the last.
# * **Convex hull**: a mix lies between what is mixed. Stretch a rubber band round the points; the curve stays inside.
# * **Affine invariance**: turn, scale, shear or move the points, and the curve goes along.
#
# And a fourth, less plain. The dashed line will cross this zigzag polygon in 6 places. In how many can it cross the curve?

# %%
crossings = None  # "exactly 6", "at most 6" or "at least 6"

# %% fold=true
figure = paper(330, legend={"orientation": "h", "x": 0.25, "y": -0.02})
draw(figure, [(-1, 0.3), (21, 0.9)], "a straight line", palette.INK, 2)
figure.data[-1].line.dash = "dash"
polygon(figure, zigzag)
draw(figure, dx.BezierCurve(zigzag)(t_fine), "its Bezier curve")
side = dx.BezierCurve(zigzag)(t_fine) @ [-0.6, 22, 0] > 7.2  # on which side of the line, for each sample
reveal(crossings, f"at most 6; in this picture it is {np.sum(side[1:] != side[:-1])}")
figure

# %% [markdown]
# This is called **variation diminishing**: the curve never wiggles more than its polygon. A polygon without a dent makes a
# curve without a dent. Throw lines at random, and try to find one that proves it wrong:


# %%
def crossed(path, normal, offset):
    """How often a path of points crosses the line of all X with normal · X = offset."""
    side = path @ normal > offset
    return np.sum(side[1:] != side[:-1])


rng = np.random.default_rng(1959)
with once_written():
    curve = np.array([casteljau(zigzag, t) for t in t_fine])
    lines = [(rng.normal(size=3), rng.uniform(-15, 15)) for _ in range(2000)]
    more = [max(crossed(curve, *line) - crossed(zigzag, *line), 0) for line in lines]
    holds("2000 lines: none meets the curve more often than the polygon", more)
    M, shift = np.array([[1, 2, 0], [0, 3, 1], [4, 0, 1]]), np.array([5, -6, 7])
    moved = [casteljau(zigzag @ M + shift, t) for t in t_fine]
    holds("moved points, moved curve", moved, curve @ M + shift)

# %% [markdown]
# ## 3 · A curve of curves
#
# For a surface take a **control net**, rows and columns of points $P_{ij}$: $i$ counts along $u$, $j$ along $w$. With $j$ held,
# the four points $P_{0j}, \dots, P_{3j}$ are the polygon of a curve along $u$. Let a pearl slide on each of the four curves,
# all at the same $u$. The four pearls are control points again, of one curve along $w$. While $u$ grows, that curve bends and
# travels, and what it passes is the **Bezier patch**.
#
# The pearls went along $u$ first. What comes out if they go along $w$ first, on the other four curves?

# %%
other_way = None  # "the same patch", "its mirror image" or "another patch"

# %%
net = np.array([
    [[0, 0, 0], [0, 3, 3], [0, 6, 2], [0, 9, -1]],
    [[3, 0, 2], [3, 3, 7], [3, 6, 5], [3, 9, 0]],
    [[6, -1, 1], [6, 3, 5], [6, 6, 8], [6, 9, 2]],
    [[9, 0, -2], [9, 3, 1], [9, 7, 4], [9, 9, 3]],
], float)  # fmt: skip
sail = dx.BezierPatch(net)  # the library's, for the pictures

# %% fold=true
strings = {f"curve {j}": dx.BezierCurve(net[:, j]) for j in range(4)}
pearls = np.array([string(0.4) for string in strings.values()])
lift = 0.06 * sail.normal(0.4, t_fine)  # a little off the surface, so that it is not half hidden
figure = plot.view(sail, net=net, lines=1, curves=strings | {"pearls": pearls, "made": sail(0.4, t_fine) + lift})
figure.data[-6].line.color = figure.data[-5].line.color = figure.data[-4].line.color = figure.data[-3].line.color = palette.U
look = {"line": {"color": palette.MARK, "width": 4}, "marker": {"color": palette.MARK, "size": 6}}
figure.data[-2].update(mode="lines+markers", **look)
figure.data[-1].line.update(color=palette.W, width=9)
figure.data[0].opacity = 0.75
from_here(figure, 1.9, 0.35, 0.95)
caption(figure, net=palette.NET, four_curves_along_u=palette.U, the_pearls=palette.MARK, their_curve_along_w=palette.W)
figure

# %% [markdown]
# Here $u = 0.4$. **Look at the two inner blue curves**: they float above the patch. An inner row or column of the net makes a
# curve, but not one *on* the surface. The thick orange curve, that of the pearls, does lie on it, and so it is for every other
# $u$.
#
# Write it. `casteljau` of the whole net mixes whole rows of points, so it gives you all four pearls at once. One line.


# %%
def patch(net, u, w):
    """The point (u, w) of the Bezier patch of a net (m, n, 3), first index along u; u, w are numbers."""
    ### BEGIN SOLUTION
    return casteljau(casteljau(net, u), w)
    ### END SOLUTION


# %%
u, w = np.linspace(0, 1, 9)[:, None], np.linspace(0, 1, 9)[None, :]
with once_written():
    holds("u = 1, w = 0 is the corner P[3, 0]", patch(net, 1, 0), net[3, 0])
    holds("u = 0, w = 1 is the corner P[0, 3]", patch(net, 0, 1), net[0, 3])
    holds("the edge u = 0 is the curve of the row P[0]", patch(net, 0, 0.7), casteljau(net[0], 0.7))
    turned = net.swapaxes(0, 1)  # rows become columns
    holds("first along w, then along u", patch(turned, 0.7, 0.3), patch(net, 0.3, 0.7))
    points = [[patch(net, a, b) for b in w[0]] for a in u[:, 0]]
    holds("the same as the library's", points, sail(u, w))
    reveal(other_way, "the same patch")

# %% [markdown]
# The order does not matter, because in the end each $P_{ij}$ counts with a *product* of two shares, one of $u$ and one of $w$:
#
# $$S(u, w) = \sum_i \sum_j B_i(u)\, B_j(w)\, P_{ij}$$
#
# For that it is called a **tensor product**. The $B_i$ are the shares that the repeated mixing leaves, the Bernstein functions;
# in [A6](../A6/bezier.ipynb) you write them down.
#
# The marker below walks the edges of the square, $(0,0)$ to $(1,0)$ to $(1,1)$. Which control point does it pass half way?

# %%
half_way = None  # for example "P[2, 1]"

# %%
reveal(half_way, "P[3, 0]")
plot.walk(sail, [(0, 0), (1, 0), (1, 1)])

# %% [markdown]
# ## 4 · What the net promises, and what it does not
#
# Shares between 0 and 1, together 1, so the promises come along: the four **corners**; the four **edges**, which are the Bezier
# curves of the outer rows and columns; the **convex hull**; **affine invariance**. (Not the fourth. For surfaces no
# variation-diminishing property is known: Piegl and Tiller, *The NURBS Book*, section 1.5.)
#
# And at each corner the net lies *on* the surface's **tangent plane**. Three control points make a plane. Which three at
# $S(0, 0)$?

# %%
plane_of = None  # for example "P[0, 0], P[1, 1], P[2, 2]"

# %% fold=true
reveal(plane_of, "P[0, 0], P[1, 0], P[0, 1]: the two edges leave along the first leg of each")
figure = plot.view(sail, net=True, curves={"three points": net[[1, 0, 0], [0, 0, 1]]})
figure.data[-1].update(
    mode="lines+markers", line={"color": palette.MARK, "width": 7}, marker={"color": palette.MARK, "size": 6}
)
around = np.array([(-0.4, -0.4), (1.2, -0.4), (1.2, 1.2), (-0.4, 1.2)])
x, y, z = (net[0, 0] + around @ [net[1, 0] - net[0, 0], net[0, 1] - net[0, 0]]).T
figure.add_mesh3d(x=x, y=y, z=z, i=[0, 0], j=[1, 2], k=[2, 3], color=palette.MARK, opacity=0.2, hoverinfo="skip")
from_here(figure, -1.85, -1.15, 0.3)
caption(figure, along_u=palette.U, along_w=palette.W, net=palette.NET, three_points_and_their_plane=palette.MARK)
figure

# %%
S_u, S_w = sail.derivative(0, 0, 1, 0), sail.derivative(0, 0, 0, 1)
holds("S_u at the corner is 3 (P[1, 0] - P[0, 0])", S_u, 3 * (net[1, 0] - net[0, 0]))
holds("S_w at the corner is 3 (P[0, 1] - P[0, 0])", S_w, 3 * (net[0, 1] - net[0, 0]))
directions = rng.normal(size=(3, 2000))  # in none of them may the patch reach further than its net
further = (sail(u, w) @ directions).max((0, 1)) - (net @ directions).max((0, 1))
holds("2000 directions: never outside the convex hull", np.maximum(further, 0))

# %% [markdown]
# So that is the first half of an answer. Twelve of the sixteen points are never reached; eight of these hold the edges, and
# with them the tangent planes of the corners; four reach into the middle.
#
# But does the patch really not pass through them? Here are two surfaces over a regular net of $4 \times 4$ points. One is the
# Bezier patch. The other was made by somebody who thought that it must pass through *all* of the points.

# %% fold=true
right = shipped().find("bezier_patch")
mistakes = {mistake.id: mistake for mistake in right.mistakes}
lattice = np.stack(np.broadcast_arrays(3.0 * np.arange(4)[:, None], 3.0 * np.arange(4), 0.0), axis=-1)


def through_all(P):
    return lambda u, w: mistakes["net_piecewise"].formula(u, w, P=P)


plot.view(lambda u, w: right(u, w, P=lattice), against=through_all(lattice), names=("one", "the other"))

# %% [markdown]
# The same everywhere, to the last point: a flat lattice is **blind**. Now the same two on our net. One of them is the Bezier
# patch; the other passes through all sixteen points. Which is the Bezier patch?

# %%
bezier_is = None  # "left" or "right"

# %% fold=true
reveal(bezier_is, "the right one: no creases, and it stays well below the peaks of the net")
plot.view(lambda u, w: right(u, w, P=net), against=through_all(net), names=("one", "the other"))

# %%
print(mistakes["net_piecewise"].hint)

# %% [markdown]
# The second thing that the net does *not* promise: peace elsewhere. Pull the inner point $P_{11}$ upwards by 9 and leave all
# others. Where does the patch stay exactly where it was?

# %%
still = None  # "nowhere", "at the corners only", "on the four edges" or "everywhere beyond u = w = 1/2"

# %%
pushed = net.copy()
pushed[1, 1] += (0, 0, 9)
quarters = np.arange(5) / 4
moved = (dx.BezierPatch(pushed)(quarters[:, None], quarters) - sail(quarters[:, None], quarters))[..., 2]
print("moved by, u = 0, 1/4, ..., 1 downwards, w to the right:", np.round(moved, 2) + 0.0, sep="\n")
most = (dx.BezierPatch(pushed)(1 / 3, 1 / 3) - sail(1 / 3, 1 / 3))[2]
print(f"most of all at u = w = 1/3: by {most:.3f}, which is {most / 9:.3f} of the pull")
reveal(still, "on the four edges, and nowhere else")

# %% [markdown]
# **One point moves everything**, if only a little at the far end: its share $B_1(u)\,B_1(w)$ is above 0 in all of the open
# square. At most it is $\frac49 \cdot \frac49 = \frac{16}{81}$, so the patch follows a fifth of the way. A control point does
# not say *here*. It says *more this way*.
#
# This is a good place to stop for tonight. The other half asks how to say *more this way, but only here*, and why all of this
# still cannot make a tin can.

# %% [markdown]
# ## 5 · Degree against locality
#
# A longer curve needs more points. Bezier knows one way: a higher degree. Eleven points make degree 10, and each of them moves
# all of it.
#
# The way out: let only a few *neighbours* mix, $k$ of them at a time. $k$ is the **order**, always one more than the degree;
# $k = 4$ is cubic. (Many books, and scipy, count by the degree. Ask which, each time.) You will see the same eleven points with
# $k = 2$, 3, 4 and 11. Which curve keeps closest to its polygon?

# %%
closest = None  # 2, 3, 4 or 11

# %% fold=true
places = "0 0, 1 3.5, 2.6 3.6, 3 0.3, 4.6 -0.6, 5.6 2.4, 7 4.4, 8.6 3.2, 9 0.2, 10.6 -0.4, 12 2.4"
row = flat(*(map(float, place.split()) for place in places.split(",")))
figure = paper(legend={"orientation": "h", "x": 0.16, "y": -0.02})
polygon(figure, row)
for k, colour in ((2, palette.INK), (3, "#E69F00"), (4, palette.CURVE), (11, "#CC79A7")):
    fine = np.linspace(0, 1, 481 if k > 2 else 11)
    draw(figure, dx.BSplineCurve(row, k)(fine), f"k = {k}", colour, 3)
figure.data[1].line.dash = "dot"
reveal(closest, "2: order 2 mixes two neighbours only, and that is the polygon itself")
figure

# %% [markdown]
# **Read it from $k = 11$ down.** Order 11 is the Bezier curve: smooth, lazy, far from its points. Order 4 follows every bend.
# Order 3 touches each inner leg at its middle. Order 2 is as local as can be, and has corners. Smoothness is bought with
# locality; most of the world settles at $k = 4$, cubic.
#
# These are **B-spline curves**. How do they know which points to mix?

# %% [markdown]
# ## 6 · The same triangle, beside a ruler
#
# Lay a ruler beside the curve, with marks $t_0 \le t_1 \le t_2 \le \dots$: the **knot vector**. Between two different marks
# lies a **knot span**. There the curve is one polynomial of degree $k - 1$, mixed from $k$ points. $m$ points need $m + k$
# knots.
#
# The mixing is de Casteljau's, round after round. Only the shares change: not $t$ itself, but how far $t$ has come *between two
# knots*. In round $q$, point $j$ is mixed with its left neighbour, and the share is 0 at the knot $t_j$ and 1 at $t_{j+k-q}$.
# This is de Boor's algorithm. Write the share.


# %%
def de_boor(points, knots, k, t):
    """The point at t of the B-spline curve of order k; len(points) + k knots, first and last k times."""
    s = min(np.searchsorted(knots, t, side="right") - 1, len(points) - 1)  # the span t_s <= t < t_(s+1)
    near = points[s - k + 1 : s + 1]  # the k points that count there
    for q in range(1, k):
        j = np.arange(s - k + 1 + q, s + 1)
        start, end = knots[j], knots[j + k - q]
        ### BEGIN SOLUTION
        share = (t - start) / (end - start)
        ### END SOLUTION
        near = mix(near[:-1], near[1:], share[:, None])
    return near[0]


# %% [markdown]
# What must hold? $t$ lies between the two knots, so each share is again between 0 and 1, and all promises come along. One grows
# tighter: on a span the curve stays in the hull of its $k$ points. And with knots 0 and 1 at the ends and none between, every
# share is $t$, which is de Casteljau.
#
# (The `min` closes the last span on the right. Without it nobody is at home at the very last knot.)

# %%
knots = np.array([0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 8, 8, 8], float)  # 11 points, k = 4
ends = np.array([0, 0, 0, 0, 1, 1, 1, 1], float)  # none between: 4 points, k = 4
with once_written():
    holds("knots at the ends only: de Casteljau", de_boor(row[:4], ends, 4, 0.3), casteljau(row[:4], 0.3))
    holds("t = 0 is the first point", de_boor(row, knots, 4, 0.0), row[0])
    holds("t = 8 is the last", de_boor(row, knots, 4, 8.0), row[-1])
    holds("all points one point", de_boor(np.full((11, 3), 7.0), knots, 4, 4.6), 7)
    box, point = row[4:8], de_boor(row, knots, 4, 4.6)
    holds("4 <= t < 5: in the box of P[4] to P[7]", np.clip(point, box.min(0), box.max(0)), point)
    t = np.linspace(0, 8, 41)
    holds("the same as the library's", [de_boor(row, knots, 4, s) for s in t], dx.BSplineCurve(row, 4)(t / 8))

# %% [markdown]
# Turn it round. On a span $k$ points count; so how many spans does *one* point move? The ruler has 8 spans. Pull $P_5$, the one
# in the middle, with $k = 4$. How many of the 8 feel it?

# %%
felt = None  # a number from 1 to 8

# %% fold=true
pulled = row.copy()
pulled[5] += (0, 3, 0)
before, after = dx.BSplineCurve(row, 4), dx.BSplineCurve(pulled, 4)
figure = paper(400, legend={"orientation": "h", "x": 0.12, "y": -0.02})
polygon(figure, row)
polygon(figure, pulled[4:7], None)
figure.data[-1].line.dash = "dot"
figure.add_annotation(x=5.6, y=5.4, text="P₅", showarrow=False, yshift=16, font={"size": 15})
figure.update_yaxes(range=[-1.1, 6.2])
draw(figure, before(t_fine), "before", palette.INK, 2)
draw(figure, after(t_fine), "after: the same")
moving = t_fine[(t_fine >= 0.25) & (t_fine <= 0.75)]
draw(figure, after(moving), "after: moved", palette.MARK)
draw(figure, after(np.arange(9) / 8), "knots, t = 0 to 8", palette.KNOT, 2, "markers")
figure.data[-1].marker.update(size=10, line={"color": "white", "width": 1})
gaps = np.abs(after(np.arange(8) / 8 + 1 / 16) - before(np.arange(8) / 8 + 1 / 16)).max(1)
reveal(felt, f"{int((gaps > 0).sum())}, from the knot t = 2 to the knot t = 6")
figure

# %% [markdown]
# **Exactly still**, not nearly. This is **local support**: a point moves at most $k$ spans of the curve, and so at most
# $k \times l$ of a patch of orders $k$ and $l$.
#
# Now one inner point of a net of $9 \times 9$ points, pulled upwards by 1. You look down on the parameter square; the colour is
# how far the patch has moved, and what is white has not moved at all. Left the Bezier patch of the net, right the B-spline
# patch with $k = l = 4$, its knots as lines. Count the squares that feel it.

# %% fold=true
fine = np.linspace(0, 1, 97)
grid = np.stack(np.broadcast_arrays(np.arange(9.0)[:, None], np.arange(9.0), 0.0), axis=-1)
grid[2, 3, 2] = 1  # all others are at z = 0, so z is what has moved
names = ("Bezier patch, degree 8", "B-spline patch, k = l = 4")
figure = make_subplots(1, 2, subplot_titles=names, horizontal_spacing=0.08)
for column, form in enumerate((dx.BezierPatch(grid), dx.BSplinePatch(grid, 4, 4)), start=1):
    moved = np.where((z := form(fine[:, None], fine[None, :])[..., 2]) > 0, np.log10(np.maximum(z, 1e-6)), np.nan)
    bar = {"tickvals": [-6, -4, -2, 0], "ticktext": ["10⁻⁶", "10⁻⁴", "10⁻²", "1"], "title": "moved<br>by", "thickness": 12}
    scale = palette.scale(palette.CIVIDIS)
    figure.add_heatmap(
        x=fine, y=fine, z=moved.T, zmin=-6, zmax=0, colorscale=scale, colorbar=bar, showscale=column == 2, col=column, row=1
    )
for at in np.arange(1, 6) / 6:
    figure.add_vline(at, line={"color": palette.KNOT, "width": 1.5}, col=2)
    figure.add_hline(at, line={"color": palette.KNOT, "width": 1.5}, col=2)
figure.update_xaxes(title="u", tickvals=[0, 0.5, 1], constrain="domain").update_yaxes(title="w", tickvals=[0, 0.5, 1])
figure.update_yaxes(scaleanchor="x", col=1).update_yaxes(scaleanchor="x2", col=2)
font = {"color": palette.INK, "family": palette.FONT}
figure.update_layout(
    height=380, template="none", margin={"t": 40, "b": 50, "l": 50, "r": 20}, paper_bgcolor=palette.CLEAR, font=font
)

# %% [markdown]
# **What to see.** On the right twelve of the 36 squares: four spans along $w$, and three along $u$, where $P_{23}$ is near the
# edge. On the left all of it. In the far corner that is less than a millionth, but no program may call it nothing.

# %% [markdown]
# ## 7 · When knots meet
#
# Where two spans meet, a cubic B-spline agrees in point, tangent and second derivative. Now push knots together. How often a
# knot occurs is its **multiplicity** $\mu$, and each time costs one derivative: at order $k$ only the first
# $k - 1 - \mu$ of them still agree.
#
# Seven points, $k = 4$, with the knot $t = 2$ once, twice, three times. What will the curve have there, at three?

# %%
three_times = None  # "nothing to see", "a corner" or "a gap"

# %% fold=true
seven = flat((0, 0), (0.4, 3), (2, 4), (3.5, 0.5), (5, 4.2), (6.6, 3), (7, 0))
kinds = {"once": [1, 2, 3], "twice": [2, 2, 3], "three times": [2, 2, 2]}
figure = paper(235, showlegend=False)
for place, (name, inner) in enumerate(kinds.items()):
    right_by = (9 * place, 0, 0)
    spline = dx.BSplineCurve(seven, 4, [0, 0, 0, 0, *inner, 4, 4, 4, 4])
    polygon(figure, seven + right_by)
    draw(figure, spline(np.linspace(0, 1, 401)) + right_by)
    draw(figure, [spline(0.5) + right_by], None, palette.KNOT, 2, "markers")
    figure.data[-1].marker.update(size=12, line={"color": "white", "width": 1})
    figure.add_annotation(x=3.5 + 9 * place, y=5.2, text=f"t = 2 {name}", showarrow=False, font={"size": 14})
figure.update_yaxes(range=[-0.5, 5.7])
reveal(three_times, "a corner, and it lies on a control point: there k - 1 knots leave no other point a share")
figure

# %% [markdown]
# A fourth time, and the curve tears. So now you know when a spline *does* touch a control point: where a knot occurs $k - 1$
# times. At the ends it occurs $k$ times, and that is all that is behind "the curve begins at its first point".
#
# On a patch the corner becomes a **crease** along a whole line. A car body has such lines, and this is one way to draw them.
# Find the crease; then find the row of control points on it.

# %%
heights = np.outer([0, 0.3, 1.2, 4.5, 2.6, 2.2, 2.4], [0.6, 1, 1.2, 1, 0.4])
wing = np.stack(np.broadcast_arrays(2.0 * np.arange(7)[:, None], 3.0 * np.arange(5), heights), axis=-1)
creased = dx.BSplinePatch(wing, 4, 3, knots_u=[0, 0, 0, 0, 2, 2, 2, 4, 4, 4, 4])
holds("at u = 1/2 row P[3] alone counts", creased(0.5, w[0]), dx.BSplineCurve(wing[3], 3)(w[0]))
plot.view(creased, net=True, knots=True, height=540)

# %% [markdown]
# ## 8 · Ends, or none
#
# Knots that repeat $k$ times at both ends are called *open* here, **clamped** in many books. (Careful: in some, "open" means
# the opposite.) The next picture shows a patch with $k = 4$, $l = 3$ and one that a learner's mistake made from the same net.
# **Which mistake?**
#
# * `"bezier"`: the whole net taken as one Bezier patch
# * `"order_is_degree"`: $k$ and $l$ taken for degrees
# * `"unclamped"`: knots 0, 1, 2, 3, ..., none repeated

# %% fold=true
spline_right = shipped().find("bspline_patch")
spline_mistakes = {mistake.id: mistake for mistake in spline_right.mistakes}
given = {"P": wing, "k": 4, "l": 3}
plot.view(
    lambda u, w: spline_mistakes["unclamped"].formula(u, w, **given),
    against=lambda u, w: spline_right(u, w, **given),
    names=("right", "wrong"),
)

# %%
mistake = None  # one of the three names

# %%
reveal(mistake, "unclamped")
print(spline_mistakes["unclamped"].hint)

# %% [markdown]
# Yet sometimes a curve should have no ends. Keep the knots evenly spaced, and when the points run out, begin again with the
# first $k - 1$: **periodic**. The curve closes, and not only the points meet but the tangents and the second derivatives too.
#
# A tube of six points round and five along, cubic both ways, periodic in $u$ and clamped in $w$. Clamped, six points of order 4
# make three spans. How many spans go round the tube?

# %%
round_it = None  # a number

# %%
turn = 2 * np.pi * np.arange(6)[:, None] / 6
radius, height = np.array([2, 3.4, 1.2, 2.2, 3.0]), np.array([0, 2, 4, 6, 8.0])
ring = np.stack(np.broadcast_arrays(radius * np.cos(turn), radius * np.sin(turn), height), axis=-1)
vase = dx.BSplinePatch(ring, 4, 4, knots_u="periodic")
holds("it closes", vase(1, w), vase(0, w))
holds("smoothly", vase.derivative(1, w, 1, 0), vase.derivative(0, w, 1, 0))
holds("and in the second derivative", vase.derivative(1, w, 2, 0), vase.derivative(0, w, 2, 0))
reveal(round_it, len(vase.breaks()[0]) - 1)
plot.view(vase, net=True, knots=True, height=540)

# %% [markdown]
# ## 9 · Why not simply round?
#
# The vase looks round. Is it? Measure the radius of its foot, $w = 0$. And ask for less: a mere quarter of a circle of radius
# 1, from one polynomial $x(t)$ and one $y(t)$ of any degree you like. From which degree on can $x^2 + y^2 = 1$ be exact?

# %%
exact_from = None  # a degree, or "none"

# %%
foot = np.hypot(*vase(t_fine, 0)[:, :2].T)
print(f"radius of the vase at its foot: from {foot.min():.4f} to {foot.max():.4f}\n")
follow = np.polynomial.Chebyshev.interpolate  # polynomials that keep close to a function from -1 to 1
for degree in (2, 4, 6, 8):
    x = follow(lambda t: np.cos(np.pi / 4 * (t + 1)), degree)(2 * t_fine - 1)
    y = follow(lambda t: np.sin(np.pi / 4 * (t + 1)), degree)(2 * t_fine - 1)
    print(f"degree {degree}: x² + y² is off by up to {np.abs(x**2 + y**2 - 1).max():.1e}")
reveal(exact_from, "none")

# %% [markdown]
# **None, ever.** Let $a\,t^n$ and $b\,t^n$ be the highest powers in $x$ and $y$, not both 0. Then $x^2 + y^2$ contains
# $(a^2 + b^2)\,t^{2n}$, and squares cannot cancel. So it is no constant, unless $n = 0$, and that is a single point.
#
# A Bezier patch is polynomial along each of its lines, a B-spline patch on each span. So neither is even a piece of a cylinder;
# for sphere and torus it is the same. (And the cone? Wait a little.) The errors above are soon smaller than any machine can
# cut. But a drawing that says *cylinder* should mean one, for the next program that measures it or cuts it with a plane.

# %% [markdown]
# ## 10 · One dimension higher
#
# What is not a polynomial but nearly as easy? A *quotient* of two. Give each control point a **weight** $h_i > 0$ and one
# coordinate more: lift $(x, y)$ to $(h x,\; h y,\; h)$. Run de Casteljau up there, as ever. Then come down: divide by the last
# coordinate. These curves are called **rational**.
#
# Write the way down.


# %%
def rational(points, weights, t):
    """The point at t of the rational Bezier curve: points (n, 2), not multiplied by their weights (n,)."""
    h = np.asarray(weights, float)[:, None]
    point = casteljau(np.hstack([h * points, h]), t)
    ### BEGIN SOLUTION
    return point[:-1] / point[-1]
    ### END SOLUTION


# %%
arc = np.array([[1, 0], [1, 1], [0, 1]], float)  # the ends of a quarter, and where their tangents meet
c45 = np.cos(np.radians(45))
h = np.array([1, c45, 1])
with once_written():
    quarter = np.array([rational(arc, h, t) for t in t_fine])
    holds("weights 1, cos 45°, 1: x² + y² = 1", (quarter**2).sum(1), 1)
    holds("all weights times 5: nothing changes", rational(arc, 5 * h, 0.3), rational(arc, h, 0.3))
    holds("all weights 1: the plain curve", rational(arc, [1, 1, 1], 0.3), casteljau(arc, 0.3))

# %% [markdown]
# Written out, the share of point $i$ is now
#
# $$\frac{h_i\, B_i(t)}{\sum_j h_j\, B_j(t)}$$
#
# With all weights above 0 it lies between 0 and 1, and the shares are together 1. So every promise of section 2 still holds.
#
# And there is a circle, from nothing but mixing and one division! What curve did you draw *before* you divided, upstairs, where
# the points are $(h x,\; h y,\; h)$? You have known it since section 1.

# %%
upstairs = None  # "a circle", "a parabola", "a straight line" or "an ellipse"

# %% fold=true
lifted = np.array([[1, 0, 1], [c45, c45, c45], [0, 1, 1]])
upper = dx.BezierCurve(lifted)(t_fine)
lower = upper / upper[:, 2:]  # divided by the last coordinate


def cone(u, w):
    angle = np.radians(-30 + 150 * u)
    return np.stack(np.broadcast_arrays(1.15 * w * np.cos(angle), 1.15 * w * np.sin(angle), 1.15 * w), axis=-1)


figure = plot.view(cone, lines=1, net=lifted, curves={"circle": 1.006 * lower, "parabola": 1.006 * upper})
figure.data[-2].line.update(width=9)
figure.data[-1].line.update(color=palette.MARK, width=9)
for end in lower[::60]:
    x, y, z = np.transpose([np.zeros(3), 1.004 * end])
    figure.add_scatter3d(x=x, y=y, z=z, mode="lines", line={"color": palette.INK, "width": 2}, hoverinfo="skip")
figure.data[0].update(opacity=0.55, lighting=palette.FLAT)
figure.data = (figure.data[0], *figure.data[5:])  # without the edges and letters of the cone
from_here(figure, 1.3, 0.9, 0.6)
words = {"before dividing": palette.MARK, "after": palette.CURVE, "lifted polygon": palette.NET, "rays": palette.INK}
caption(figure, **words)
reveal(upstairs, "a parabola")
figure

# %% [markdown]
# **Follow one grey ray.** The pink parabola lies on a cone of such rays, $x^2 + y^2 = h^2$: cut a cone by a plane parallel to
# one of its rays, and the cut is a parabola. Dividing by $h$ slides every point along its ray to height 1, and at height 1 the
# cone is a circle.
#
# The middle weight decides whether the parabola lies on the cone. For an arc of the angle $\alpha$ it must be $\cos(\alpha/2)$
# (Farin, *Curves and Surfaces for CAGD*, on conics). A quarter: $\cos 45°$.

# %% [markdown]
# And the cone that had to wait? Look at the picture again: a parabola and straight rays, nothing rational. A piece of a round
# *cone* is a plain Bezier patch, without any weights:

# %%
piece = dx.BezierPatch(np.stack([0 * lifted, lifted], axis=1))  # from the apex to the three lifted points
x, y, z = np.moveaxis(piece(u, w), -1, 0)
holds("x² + y² = z²", x**2 + y**2, z**2)
print("degrees along u and w:", piece.control_net.shape[0] - 1, piece.control_net.shape[1] - 1)

# %% [markdown]
# ### Weights on a surface
#
# Here too one line does it: lift the net, take the B-spline patch, divide. Rational B-splines on any knots are called
# **NURBS**, *non-uniform rational B-splines*. A larger weight pulls the surface towards its point.
#
# Now a quarter of a cylinder of radius 3, made right, and made by somebody who forgot the weights: all 1. Does the wrong one
# run inside the cylinder or outside?

# %%
wrong_runs = None  # "inside" or "outside"

# %% fold=true
quarter_right = shipped().find("nurbs_quarter_cylinder")
quarter_mistakes = {mistake.id: mistake for mistake in quarter_right.mistakes}


def built(net_and_weights):
    return dx.NurbsPatch(*net_and_weights, 3, 2)


size = {"r": 3, "h": 2}
wrong = built(quarter_mistakes["weight_1"].formula(**size))
reveal(wrong_runs, f"outside, by {100 * (np.hypot(*wrong(0.5, 0)[:2]) / 3 - 1):.1f} per cent of the radius half way round")
plot.view(wrong, against=built(quarter_right(**size)), names=("cos 45°", "weight 1"))

# %% [markdown]
# ## 11 · The limit: how small may a weight be?
#
# Let the middle weight $h$ of the quarter circle go down from $\cos 45°$: the curve flattens. At $h = 0$ the middle point has
# no share left, and the curve is the straight line between the ends.
#
# Go on. Where is the point $t = 1/2$ for the weight $-\cos 45°$?

# %%
beyond = None  # (x, y), for example (0.5, 0.5)

# %% fold=true
figure = paper(440, legend={"x": 0.78, "y": 0.95, "title": {"text": "middle weight"}})
weights = {"1": 1, "cos 45°": c45, "0.3": 0.3, "0": 0, "−0.4": -0.4, "−cos 45°": -c45}
colours = ["#E69F00", palette.CURVE, palette.KNOT, palette.INK, "#CC79A7", palette.YOURS]
for (name, weight), colour in zip(weights.items(), colours, strict=True):
    up = dx.BezierCurve([(1, 0, 1), (weight, weight, weight), (0, 1, 1)])(t_fine)
    draw(figure, up[:, :2] / up[:, 2:], name, colour, 5 if abs(weight) == c45 else 2)
polygon(figure, arc)
up = dx.BezierCurve([(1, 0, 1), (-c45, -c45, -c45), (0, 1, 1)])(0.5)
draw(figure, [up[:2] / up[2]], "t = 1/2 for −cos 45°", palette.MARK, 2, "markers")
reveal(beyond, f"({up[0] / up[2]:.3f}, {up[1] / up[2]:.3f}), on the far side of the circle")
figure

# %% [markdown]
# **What happened?** The equation of the circle does not ask for the sign of $h$. So it is the same circle, but now the *other
# three quarters*, far outside the hull of the three points. The promises of section 2 all stood on shares between 0 and 1,
# together 1. With a negative weight they are still together 1, so affine invariance stays. They are no longer between 0 and 1:
# the hull goes, and variation diminishing with it.
#
# At $h = -1$ the divisor is $(1 - 2t)^2$, and the point at $t = 1/2$ is at infinity. That is why weights must be above 0, here
# and in most programs:

# %%
try:
    dx.NurbsCurve([(1, 0, 0), (1, 1, 0), (0, 1, 0)], [1, -c45, 1], 3)
except dx.WeightError as refused:
    print(refused)

# %% [markdown]
# ## The answer
#
# So how does a point shape a surface that never touches it? By its share. Corners and edges, tangent planes, the hull: all that
# a net promises is said by shares between 0 and 1, together 1. Knots say *where* a point has a share, weights *how much* of it
# beside the others.
#
# To read on: Farin, *Curves and Surfaces for CAGD*, for the mixing; Piegl and Tiller, *The NURBS Book*, for knots and weights.

# %% [markdown]
# ## Where to go from here
#
# Write them yourself: the shares and the patch in [A6 · Bezier](../A6/bezier.ipynb), knots, basis functions and weights in [A7
# · B-spline and NURBS](../A7/bspline-and-nurbs.ipynb).
#
# Left open: you had to place sixteen points. What if somebody hands you the four *edges* only? Then the inner points must come
# from somewhere, and that is the next chapter: [How four curves make a surface](04-how-four-curves-make-a-surface.ipynb).
