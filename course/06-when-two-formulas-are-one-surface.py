# %% [markdown]
# # When two formulas are one surface
#
# **You send out the drawing of a tube. The file that comes back is in another form, with other numbers. Is it still your tube?**
#
# This chapter pulls a stocking over a leg, fools a grid of eighty-one samples, finds out where sixteen are enough and a
# thousand are not, and ends with two rims that nobody can tell apart and a tube between them that has a waist.
#
# It takes about two hours; after section 5 is a good place to stop for tonight. Guess before you look.

# %% setup=true
import directrix as dx
from directrix.plot import palette

from autograder.catalogue import shipped
from autograder.exercise import exercise
from autograder.judge import judge


def asked(f, g):
    """What the judge of this course says of f where g is wanted: a word, and a sentence."""

    def surface(u, w):
        """The surface g."""
        return g(u, w)

    def only(rng):
        return {}

    task = exercise(points=1, title="g", kind="surface")(surface)
    task.data(only)
    verdict = judge(task, f, figure=False)
    return verdict.tier, verdict.part("right" if verdict.tier == "identical" else "wrong")


u, w = np.linspace(0, 1, 9)[:, None], np.linspace(0, 1, 9)[None, :]
fine = np.linspace(0, 1, 97)

# %% [markdown]
# ## 1 · One tube, five formulas
#
# A tube of radius 2 and height 5 about the $z$ axis. Five people were asked for it:
#
# 1. one wrote cosine and sine,
# 2. one pushed a circle along a line,
# 3. one turned a line about the axis,
# 4. one joined two circles by straight lines,
# 5. one needed a file that holds splines only, and made a NURBS patch: 18 points, 18 weights.
#
# All five are right: $x^2 + y^2 = 4$ everywhere, and $z$ runs from 0 to 5. Ask each of them for the point at $u = 1/4$,
# $w = 1/2$. How many *different* points do you get?

# %%
different_points = None  # a number from 1 to 5

# %%
foot = dx.Circle((0, 0, 0), 2)
tube = dx.Cylinder(radius=2, height=5)
tubes = {
    "cosine and sine": tube,
    "a circle, pushed": dx.LinearSweep(foot, direction=(0, 0, 1), distance=5),
    "a line, turned": dx.CircularSweep(dx.Line((2, 0, 0), (2, 0, 5)), "z"),
    "two circles, joined": dx.Ruled(foot, dx.Circle((0, 0, 5), 2)),
    "splines": dx.to_nurbs(tube),
}
for name, form in tubes.items():
    x, y, z = np.moveaxis(form(u, w), -1, 0)
    holds(f"{name}: x² + y² = 4", x**2 + y**2, 4)
    print("     the point at (1/4, 1/2):", np.round(form(0.25, 0.5), 3) + 0.0)
found = {tuple(np.round(form(0.25, 0.5), 9) + 0.0) for form in tubes.values()}
reveal(different_points, f"{len(found)}: where a line is turned, u runs up and w goes round")

# %% [markdown]
# A hole at $u = 1/4$, $w = 1/2$ gets to different places, in one and the same tube. The word "surface" is a name for two
# things:
#
# * the **set**: which points belong to it. A weight, a coat of paint, a collision ask for no more.
# * the **map**: which point is called $(u, w)$. A texture, a tool path, a neighbour that is to be joined on ask for this one.
#
# Think of a leg and a printed stocking. The leg is the set, the print is the map. Here are one leg and two stockings; the
# colour is the distance between the two points of the same $(u, w)$:

# %%
turned = tubes["a line, turned"]
plot.view(turned, against=tube, names=("cosine and sine", "a line, turned"))

# %% [markdown]
# ## 2 · What one can do with a stocking
#
# Turn it about the leg. Pull it up unevenly. Take it off and put it on inside out. The leg stays as it is.
#
# In formulas: send $(u, w)$ to another place of the square first, and evaluate the old formula *there*. That is a **change of
# parameters**. The mildest one: $u$ becomes $u^2$. At $u = 0$ it is 0, at $u = 1$ it is 1, and every place between is still met
# just once.
#
# In the square the marker will walk evenly. Where on the tube will it be slowest?

# %%
slowest = None  # "at the start", "half way", "at the end" or "nowhere"


# %%
def pulled(u, w):
    """The tube, its stocking pulled: u² in place of u."""
    return tube(np.asarray(u) ** 2, w)


reveal(slowest, "at the start: by u = 1/2 it has done a quarter of the way")
figure = plot.walk(pulled, [(0, 0.5), (1, 0.5)], steps=33)
figure.update_layout(scene_camera_eye={"x": 1.75, "y": 1.0, "z": 0.8})

# %% [markdown]
# **Let it walk.** Left the orange lines crowd where the marker is slow. No point of the tube has moved.
#
# How much does a change of parameters do, at one place? Let $u$ grow a little. The old formula is then asked at a place that
# moves, $a$ times as fast along its first parameter, and $b$ times as fast along its second. When $w$ grows, let it be $c$ and
# $d$. So the new tangents are mixed from the old:
#
# $$\tilde S_u = a\,S_u + b\,S_w \qquad \tilde S_w = c\,S_u + d\,S_w$$
#
# Multiply out $\tilde S_u \times \tilde S_w$. Any arrow times itself is 0, and an exchange costs a sign. What number is left in
# front of $S_u \times S_w$? Write it.


# %%
def factor(along_u, along_w):
    """How many times S_u × S_w the new cross product is, from the rates (a, b) and (c, d)."""
    (a, b), (c, d) = along_u, along_w
    ### BEGIN SOLUTION
    return a * d - b * c
    ### END SOLUTION


# %% [markdown]
# Two things can be read off this number. Its *size* says how much more of the surface a small piece of the square has to cover.
# Its *sign* says on which side the normal stands; below 0, the stocking is inside out.
#
# Here are six changes:

# %%
changes = {
    "u slow at first": lambda u, w: (u**2, w),
    "exchanged": lambda u, w: (w, u),
    "u backwards": lambda u, w: (1 - u, w),
    "both backwards": lambda u, w: (1 - u, 1 - w),
    "another start": lambda u, w: ((u + 0.3) % 1, w),
    "round twice": lambda u, w: (2 * u % 1, w),
}


def rates(change, u, w, h=1 / 64):
    """(a, b) and (c, d) at one place, exact for what is at most quadratic."""
    by_u = np.subtract(change(u + h, w), change(u - h, w)) / (2 * h)
    by_w = np.subtract(change(u, w + h), change(u, w - h)) / (2 * h)
    return by_u, by_w


# %% [markdown]
# Which of them turn the stocking inside out?

# %%
inside_out = None  # for example "u backwards, and both backwards"

# %%
with once_written():
    flipped = []
    for name, change in changes.items():
        (a, b), (c, d) = by = rates(change, 0.25, 0.625)
        place = change(0.25, 0.625)  # where the old formula is evaluated
        S_u, S_w = tube.derivative(*place, 1, 0), tube.derivative(*place, 0, 1)
        new = np.cross(a * S_u + b * S_w, c * S_u + d * S_w)
        old = np.cross(S_u, S_w)
        holds(f"{name}: the factor is {factor(*by):4.1f}", new, factor(*by) * old)
        flipped += [name] if new @ old < 0 else []
    reveal(inside_out, " and ".join(flipped))

# %% [markdown]
# Both backwards is two times inside out, and so it is right side out again.
#
# "Round twice" has the factor 2: the same points, each of them covered twice. Its area comes out twice as large. So even a
# *set* wants to be counted.
#
# And one trap. For $u^2$ the factor is $2u$, so on the edge $u = 0$ it is **0**. Nothing is wrong with the tube there. But the
# formula for its normal says $0/0$, and whoever needs a normal for a tool path has none:

# %%
with once_written():
    normal = np.cross(tube.derivative(0, 0.5, 1, 0), tube.derivative(0, 0.5, 0, 1))
    at_the_edge = factor(*rates(changes["u slow at first"], 0.0, 0.5))
    print("S_u × S_w of the pulled tube at u = 0:", at_the_edge * normal + 0.0)
    print("the tube's own unit normal there:     ", tube.normal(0, 0.5))

# %% [markdown]
# ## 3 · Ask the judge
#
# Every card that you have seen in this course was written by a judge that never reads a formula. It asks for points, climbs
# down a ladder, and stops at the first word that is true:
#
# *identical · relabelled* ($u$ and $w$ exchanged or run backwards) *· other start · close · same set · covered* (several times)
# *· part · more · moved · different*
#
# `asked(f, g)` puts the question to it: is $f$ what $g$ should be? Let it look at our changes. Which word will it find for
# "round twice"?

# %%
word_for_twice = None  # one of the words

# %%
for name, change in changes.items():
    word, says = asked(lambda u, w, change=change: tube(*change(u, w)), tube)
    print(f"{name}: {word}", f"   {says}", sep="\n")
reveal(word_for_twice, word)  # "round twice" is the last of them

# %% [markdown]
# ### A sheet of rubber
#
# Changes of parameters may mix $u$ and $w$ as they like. Here is a flat square of side 3, once as a line pushed along a line,
# once as a Bezier patch. Its twelve outer control points lie evenly on the edges. The four inner ones we turn, as a block,
# about the middle of the square; later we spread them, too. They stay in its plane.
#
# By how many degrees can you turn them before the sheet has to fold?

# %%
turned_by = None  # 45, 90, 135 or "as far as you like"


# %%
def whirl(degrees, size=1.0):
    """A flat square of side 3 with its four inner control points turned, and spread, about the middle."""
    net = np.stack(np.broadcast_arrays(np.arange(4.0)[:, None], np.arange(4.0), 0.0), axis=-1)
    about = dx.Transform.rotate("z", np.radians(degrees)).matrix[:3, :3]
    net[1:3, 1:3] = (1.5, 1.5, 0) + size * (net[1:3, 1:3] - (1.5, 1.5, 0)) @ about.T
    return dx.BezierPatch(net)


def least_factor(sheet):
    """The least S_u × S_w anywhere, as a share of that of the even sheet; below 0 there is a fold."""
    u, w = fine[:, None], fine
    return np.cross(sheet.derivative(u, w, 1, 0), sheet.derivative(u, w, 0, 1))[..., 2].min() / 9


square = dx.LinearSweep(dx.Line((0, 0, 0), (3, 0, 0)), direction=(0, 1, 0), distance=3)

# %% fold=true
print("turned  spread  least factor  the judge")
for degrees, size in ((0, 1), (45, 1), (90, 1), (180, 1), (180, 2), (180, 3), (180, 8), (180, 12)):
    sheet = whirl(degrees, size)
    word = asked(sheet, square)[0]
    print(f"{degrees:5}° {size:7}  {least_factor(sheet):12.2f}  {word}")
reveal(turned_by, "as far as you like: even at 180°, each in the opposite corner, nothing folds")

figure = go.Figure().update_layout(height=330, template="none", margin={"t": 10, "b": 10, "l": 10, "r": 10})
figure.update_layout(
    paper_bgcolor=palette.CLEAR, plot_bgcolor=palette.CLEAR, font={"color": palette.INK, "family": palette.FONT}
)
figure.update_xaxes(visible=False, range=[-0.1, 10.3]).update_yaxes(visible=False, scaleanchor="x", range=[-0.6, 3.6])
eighths = np.arange(9) / 8
shown = ((90, 1, "90°"), (180, 1, "180°"), (180, 12, "180°, 12-fold"))
for place, (degrees, size, name) in enumerate(shown):
    sheet = whirl(degrees, size)
    shift = np.array([3.6 * place, 0])
    for colour, lines in (
        (palette.U, sheet(fine[None, :], eighths[:, None])),
        (palette.W, sheet(eighths[:, None], fine[None, :])),
    ):
        x, y = np.moveaxis(np.pad(lines[..., :2] + shift, ((0, 0), (0, 1), (0, 0)), constant_values=np.nan), -1, 0)
        figure.add_scatter(x=x.ravel(), y=y.ravel(), mode="lines", line={"color": colour, "width": 1.6})
    if size == 1:
        inner = sheet.control_net[1:3, 1:3].reshape(4, 3)[:, :2] + shift
        figure.add_scatter(x=inner[:, 0], y=inner[:, 1], mode="markers", marker={"color": palette.NET, "size": 9})
        figure.add_scatter(x=inner[:1, 0], y=inner[:1, 1], mode="markers", marker={"color": palette.MARK, "size": 13})
    figure.add_annotation(x=1.5 + 3.6 * place, y=3.3, text=name, showarrow=False, font={"size": 15})
words = (("━ along u", palette.U), ("━ along w", palette.W), ("● the four", palette.NET), ("● P₁₁", palette.MARK))
text = "&nbsp;&nbsp;&nbsp;".join(f"<span style='color:{colour}'>{word}</span>" for word, colour in words)
figure.add_annotation(x=5.1, y=-0.4, text=text, showarrow=False)
alt = "A square with its parameter lines, its inner control points turned by 90°, by 180°, and spread until it folds."
figure.update_layout(meta={"alt": alt}).update_traces(hoverinfo="skip", showlegend=False)

# %% [markdown]
# **What to see.** At 90° a whirl, at 180° a pinch, and not one point of the square is missing or doubled. The control points
# have changed places; the sheet has not folded. What proves it is the *factor*: as long as it is above 0, and the edges lie
# where they should, every point is met once.
#
# Spread the four wide enough, and the factor falls below 0. Now there are folds: some points are met more than once. It is
# still the same square, and only the *count* gives it away.

# %% [markdown]
# ## 4 · Nine times nine
#
# Most of what you wrote in these chapters was tested at the same places: $u$ and $w$ at 0, 1/8, 2/8 and so on, 81 in all. Put
# the fifth tube, the NURBS patch, to that test:

# %%
splines = tubes["splines"]
holds("81 places, and at each of them the same point", splines(u, w), tube(u, w))

# %% [markdown]
# Eighty-one times the same point, to rounding. So is it the same map?

# %%
same_map = None  # "yes" or "no"

# %%
x, y, _ = splines(1 / 16, 0)
come_round = np.degrees(np.arctan2(y, x))
reveal(same_map, f"no: at u = 1/16 it has come round by {come_round:.2f}°, and not by 22.5°")
print(*asked(splines, tube), sep=": ")
plot.view(splines, against=tube, names=("cosine and sine", "splines"))

# %% [markdown]
# **Read the stripes.** Dark along every eighth of $u$, bright half way between: the worst places lie exactly where our grid
# never looked. This is no bad luck. The patch is made of four quarters, and by symmetry each of them is right at its ends and
# in its middle. The grid and the surface have the same rhythm.
#
# As a set of points the two are one tube. In between, one runs ahead and falls back, by turns:

# %%
speed = np.linalg.norm(splines.derivative(fine, 0, 1, 0), axis=-1)
print(f"splines: round the axis at a speed from {speed.min():.3f} to {speed.max():.3f}")
print(f"cosine and sine: {4 * np.pi:.3f} all the way")
print(f"the fastest is {speed.max() / speed.min():.3f} times the slowest")

# %% [markdown]
# No choice of weights makes it even. In [A7](../A7/bspline-and-nurbs.ipynb) you are asked why.
#
# ## 5 · Fool the grid
#
# If a grid can be fooled by accident, it can be fooled on purpose. Here is the sail of chapter 3. Write a function `bump` that
# is **0 at all 81 places** and not 0 between, of any kind: a product, a wave. We add it to the height of the sail.
#
# It should be about 1 at its highest.


# %%
def bump(u, w):
    """0 where u and w are whole eighths; about 1 at its highest."""
    ### BEGIN SOLUTION
    return np.sin(8 * np.pi * u) * np.sin(8 * np.pi * w)
    ### END SOLUTION


# %%
sail = dx.BezierPatch([
    [[0, 0, 0], [0, 3, 3], [0, 6, 2], [0, 9, -1]],
    [[3, 0, 2], [3, 3, 7], [3, 6, 5], [3, 9, 0]],
    [[6, -1, 1], [6, 3, 5], [6, 6, 8], [6, 9, 2]],
    [[9, 0, -2], [9, 3, 1], [9, 7, 4], [9, 9, 3]],
])  # fmt: skip


def fake(u, w):
    """The sail with your bumps on it."""
    lift = np.asarray(bump(np.asarray(u, float), np.asarray(w, float)))
    return sail(u, w) + lift[..., None] * [0, 0, 1]


# %%
with once_written():
    highest = np.abs(bump(fine[:, None], fine)).max()
    holds("the fake and the sail agree at 81 places", fake(u, w), sail(u, w))
    print("yes " if highest > 0.3 else "NO  ", f"and between they do not: up to {highest:.2f} apart")
    dots = sail(u, w).reshape(-1, 3)
    display(plot.view(fake, points=dots, title="81 points of the sail, and not the sail"))

# %% [markdown]
# Every dot lies on both. A wave can even keep whole parameter lines, or all tangents at the dots (take the square of the sine).
# And if you asked at more places, we would take a faster wave.
#
# The judge of this course knows that. Beside those 81 it asks at 64 places that lie on no grid, and at a few more. So does it
# find your fake out? And can *it* be fooled? Below is the tube with a thorn, a fifth of the radius high, and narrower than a
# hundredth of the square.

# %%
judge_is_fooled = None  # "never", "by the waves", "by the thorn" or "by both"


# %%
def thorny(u, w):
    there = np.exp(-((np.asarray(u) - 0.47) ** 2 + (np.asarray(w) - 0.53) ** 2) / 0.004**2)
    return tube(u, w) * (1 + 0.2 * there[..., None] * [1, 1, 0])


with once_written():
    fooled = []
    for name, one, other in (("waves", fake, sail), ("thorn", thorny, tube)):
        word, says = asked(one, other)
        print(f"{name}: {word}", f"   {says}", sep="\n")
        fooled += [f"by the {name}"] if word == "identical" else []
    print(f"height of the thorn: {np.hypot(*thorny(0.47, 0.53)[:2]) - 2:.2f}")
    reveal(judge_is_fooled, " and ".join(fooled) or "never")

# %% [markdown]
# **Read what it says**, word by word: your surface *meets the reference at all 167 places compared*. That is true. It is also
# all that anybody can know who only asks for points.
#
# For an arbitrary function **no number of samples is enough**. So how can sampling ever prove anything?
#
# By something known beforehand. That is the other half of this chapter, and a good place to stop for tonight.

# %% [markdown]
# ## 6 · Sixteen are enough, and a thousand are not
#
# Now let it be known that both are *bicubic*. Their difference is bicubic, too: sixteen unknown arrows $D_{ij}$,
#
# $$\sum_i \sum_j B_i(u)\,B_j(w)\,D_{ij}$$
#
# Each place where the two agree is one equation: this sum is 0 there. If the equations leave only $D_{ij} = 0$, the two agree
# *everywhere*. So sixteen places may do, if no equation repeats what the others have said. How many different ones there are is
# called the **rank**.
#
# A thousand places on the diagonal $u = w$, or a thousand on the four edges: how many different equations are those on the
# edges?

# %%
rank_of_edges = None  # a number up to 16


# %%
def B(t):
    """The Bernstein functions B0 to B3 at t, shape of t + (4,)."""
    t = np.asarray(t, float)
    return np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3], axis=-1)


def rank(u, w):
    """How many of the equations at the places (u, w) are different ones."""
    return np.linalg.matrix_rank(np.einsum("ni,nj->nij", B(u), B(w)).reshape(len(u), 16))


# %%
thirds = np.arange(4) / 3
a, b = np.random.default_rng(6).random((2, 1000))
side, end = a, np.arange(1000) % 2  # somewhere along an edge, and which end the edge is at
along_u = np.arange(1000) < 500
edges = rank(np.where(along_u, side, end), np.where(along_u, end, side))
print("   4 places, the corners:  rank", rank(end[:4], end[[0, 0, 1, 1]]))
print("  81 places, 9 × 9:        rank", rank(np.repeat(u, 9), np.tile(w[0], 9)))
print("  16 places, 4 × 4:        rank", rank(np.repeat(thirds, 4), np.tile(thirds, 4)))
print("  16 places at random:     rank", rank(a[:16], b[:16]))
print("1000 places, the diagonal: rank", rank(a, a))
print("1000 places, the edges:    rank", edges)
reveal(rank_of_edges, int(edges))

# %% [markdown]
# **Sixteen well placed beat a thousand badly placed.** On the diagonal a bicubic is one curve of degree 6, seven unknowns. On
# the edges it is four cubics that share their corners: $4 \cdot 4 - 4 = 12$.
#
# And the four that are missing? The four inner control points; in Hermite's form, the four *twists*. So two bicubics may agree
# along all their edges, at as many places as you like, and differ inside.
#
# Somebody turns a Hermite patch into a Bezier net and makes a mistake with a twist. First a patch whose twists are all 0:

# %% fold=true
task = shipped().find("hermite_to_bezier")
mistakes = {mistake.id: mistake for mistake in task.mistakes}
G = np.array(dx.to_hermite(sail).G)
G[2, 3], G[3, 2] = (0, 0, 70), (0, 0, -70)  # the twists of the corners (0, 1) and (1, 0)
untwisted = G.copy()
untwisted[2:, 2:] = 0


def by(formula, data):
    return dx.BezierPatch(formula(data))


wrong = mistakes["twist_sign_mixed"].formula
plot.view(by(wrong, untwisted), against=by(task, untwisted), names=("right", "wrong"))

# %% [markdown]
# The same, to the last point: such data are **blind** to the mistake. Now with twists. Look *where* it is bright, then say
# **which mistake** it was:
#
# * `"twist_forgotten"`: no twist at all
# * `"twist_third"`: a third of the twist where a ninth was due
# * `"twist_sign_mixed"`: a plus at all four corners

# %% fold=true
figure = plot.view(by(wrong, G), against=by(task, G), names=("right", "wrong"))
above = {"x": -0.9, "y": -0.9, "z": 1.7}
figure.update_layout(scene_camera_eye=above, scene2_camera_eye=above)

# %%
mistake = None  # one of the three names

# %%
reveal(mistake, "twist_sign_mixed")
print(mistakes["twist_sign_mixed"].hint)
edge = np.array([0.0, 1.0])
holds("edges u = 0 and u = 1", by(wrong, G)(edge[:, None], fine), by(task, G)(edge[:, None], fine))
holds("edges w = 0 and w = 1", by(wrong, G)(fine[:, None], edge), by(task, G)(fine[:, None], edge))

# %% [markdown]
# Two bright spots, towards the two *mixed* corners. From $(0, 0)$ to $(1, 1)$ it stays dark: there a plus is right. And all
# four edges agree to rounding: whoever checks a conversion at the corners, or along the edges, lets this one pass.

# %% [markdown]
# ## 7 · What a conversion is
#
# The other way round is more useful still. A Hermite cubic and a Bezier cubic are both cubics; so *make* them agree at four
# places, and they agree everywhere. A row for each of the four $t$, a column for each function, $F$ Hermite's and $B$
# Bernstein's:
#
# $$B(t)\,P = F(t)\,G \quad\text{so}\quad P = C\,G,\quad C = B(t)^{-1} F(t)$$
#
# One matrix, and it knows nothing of the curve. Somebody takes four other places than you. What is her $C$?

# %%
her_matrix = None  # "the same" or "another"


# %%
def F(t):
    """Hermite's functions for p(0), p(1), p'(0), p'(1) at t, shape of t + (4,)."""
    t = np.asarray(t, float)
    F2 = 3 * t**2 - 2 * t**3
    return np.stack([1 - F2, F2, t**3 - 2 * t**2 + t, t**3 - t**2], axis=-1)


def conversion(old, new, t=(0, 1 / 3, 2 / 3, 1)):
    """The matrix from the old form's numbers to the new one's; np.linalg.solve(A, R) solves A C = R."""
    ### BEGIN SOLUTION
    return np.linalg.solve(new(t), old(t))
    ### END SOLUTION


# %%
with once_written():
    C = conversion(F, B)
    print("three times C:", np.round(3 * C, 12) + 0.0, sep="\n")
    holds("the same curve, at all places", B(fine) @ C, F(fine))
    holds("there and back is nothing", conversion(B, F) @ C, np.eye(4))
    hers = conversion(F, B, (0.1, 0.2, 0.5, 0.7))
    reveal(her_matrix, "the same" if np.allclose(hers, C) else "another")
    net = np.einsum("ai,bj,ijk->abk", C, C, G)  # once along u, once along w
    holds("a patch: the library's conversion", net, dx.to_bezier(dx.HermitePatch(G)).control_net)

# %% [markdown]
# **So here are the thirds** of chapter 4: the second row says $P_1 = p_0 + p_0'/3$. Nobody had to remember them; they follow
# from being the same curve.
#
# Every conversion between polynomial forms is such a matrix product, once along $u$ and once along $w$. Send the sail on a
# journey through all of them:

# %%
form = sail
for convert in (dx.to_hermite, dx.to_algebraic, dx.to_points, dx.to_bspline, dx.to_bezier):
    form = convert(form)
    off = np.abs(form(fine[:, None], fine) - sail(fine[:, None], fine)).max()
    print(f"{type(form).__name__:14} the same map, to within {off:.0e}")
holds("home again, with the same net", form.control_net, sail.control_net)

# %% [markdown]
# ## 8 · Exact on paper
#
# *Exact* was said of numbers on paper. A machine keeps sixteen digits. Take a random net of coordinates of size 1, turn it into
# powers of $u$ and $w$, and back: on paper, nothing has happened.
#
# For bicubics all was well. What is left of the sixteen digits at degree 40?

# %%
digits_left = None  # a number of digits

# %%
rng = np.random.default_rng(40)
for degree in (3, 10, 20, 30, 40):
    net = rng.uniform(-1, 1, (degree + 1, 2, 3))
    powers = dx.to_algebraic(dx.BezierPatch(net))
    off = np.abs(dx.to_bezier(powers).control_net - net).max()
    largest = np.abs(powers.a).max()
    print(f"degree {degree:2}: coefficients up to {largest:.0e}, the net comes back off by {off:.0e}")
reveal(digits_left, f"{max(0, int(-np.log10(off)))}: what comes back is larger than what was sent")

# %% [markdown]
# **Why?** A net of size 1 becomes coefficients beyond $10^{17}$, which have to cancel again, and a machine has forgotten their
# last digits. The same surface on paper is another one in the machine.
#
# So a file should travel in the form in which it was made, or in a form that mixes: Bezier, B-spline, NURBS. In those all
# shares lie between 0 and 1, and nothing has to cancel.

# %% [markdown]
# ## 9 · What cannot be converted
#
# The tube itself: chapter 3 has proved that no polynomial runs along a circle. The library refuses:

# %%
try:
    dx.to_bspline(tube)
except dx.ConversionError as refused:
    print(refused)

# %% [markdown]
# *Nearly* it can be done, and that is how round things are drawn where only cubics are at hand: four of them, one for each
# quarter, from $(1, 0)$ by $(1, c)$ and $(c, 1)$ to $(0, 1)$. The usual $c$ puts the middle on the circle:
# $c = \tfrac43(\sqrt2 - 1)$.
#
# Draw a shaft with a radius of 50 mm that way. By how many micrometres is it out of round?

# %%
micrometres = None  # about 1, 15, 150 or 1500

# %%
t = np.linspace(0, 1, 2001)


def out_of_round(c):
    """Radius less 1, along the cubic quarter from (1, 0) by (1, c) and (c, 1) to (0, 1)."""
    return np.hypot(*(B(t) @ [[1, 0], [1, c], [c, 1], [0, 1]]).T) - 1


usual = 4 / 3 * (np.sqrt(2) - 1)
tried = np.linspace(0.5510, 0.5530, 2001)
best = tried[np.argmin([np.abs(out_of_round(c)).max() for c in tried])]
for name, c in (("usual", usual), ("best", best)):
    off = out_of_round(c)
    print(f"{name} c = {c:.4f}: between {off.min():+.2e} and {off.max():+.2e} of the radius")
reveal(micrometres, f"{50e3 * np.abs(out_of_round(usual)).max():.1f} µm")

# %% fold=true
figure = go.Figure().update_layout(height=330, template="none", margin={"t": 20, "b": 50, "l": 80, "r": 20})
figure.update_layout(
    paper_bgcolor=palette.CLEAR, plot_bgcolor=palette.CLEAR, font={"color": palette.INK, "family": palette.FONT}
)
alt = "Two curves: how far a cubic quarter is out of round, for the usual control points and for the best."
figure.update_layout(legend={"orientation": "h", "x": 0.2, "y": 1.12}, meta={"alt": alt})
angles = np.degrees(np.arctan2(*(B(t) @ [[1, 0], [1, usual], [usual, 1], [0, 1]])[:, ::-1].T))
for name, c, colour in (("usual c", usual, palette.YOURS), ("best c", best, palette.CURVE)):
    figure.add_scatter(x=angles, y=1e4 * out_of_round(c), mode="lines", name=name, line={"color": colour, "width": 3})
line = {"color": palette.INK, "width": 1, "dash": "dot"}
figure.add_hline(0, line=line)
figure.update_xaxes(title="degrees", tickvals=[0, 22.5, 45, 67.5, 90], showgrid=False, zeroline=False)
figure.update_yaxes(title="out of round,<br>10⁻⁴ of the radius", showgrid=False, zeroline=False)
figure

# %% [markdown]
# **Outside all the way**, and by $2.7 \cdot 10^{-4}$ of the radius; whoever gives up the middle gets by with
# $2.0 \cdot 10^{-4}$, to both sides. (S. Mortensen, *Approximate a circle with cubic Bézier curves*, works out that $c$.) On a
# circle with a radius of 1000 pixels that is a quarter of a pixel. Whether 14 µm matter on a shaft, the tolerance on the
# drawing says.
#
# So a tube has three answers: as polynomials *nearly* the set; as NURBS exactly the set, at an uneven speed; as cosine and sine
# the set and the speed, but in no file that holds splines. Choose what may get lost, and say so.

# %% [markdown]
# ## 10 · The limit: sameness is not inherited
#
# "My customers only need the set." Then they must never build on it. Take the two rims of our tube and join them by straight
# lines. First the upper rim as it is. Then the *same* upper rim, run by $u^2$: not one point of either rim has changed.
#
# What is the least radius of the second surface?

# %%
least_radius = None  # the rims have 2

# %%
rim = dx.Circle((0, 0, 5), 2)


def late(t):
    """The upper rim, the same circle, at another pace."""
    return rim(np.asarray(t) ** 2)


waist = dx.Ruled(foot, late)
radius = np.hypot(*np.moveaxis(waist(np.linspace(0, 1, 401)[:, None], fine), -1, 0)[:2])
reveal(least_radius, round(radius.min(), 3))
plot.view(waist, against=dx.Ruled(foot, rim), names=("the rim", "the same rim"))

# %% [markdown]
# **The rims are the same sets; what is built on them is not.** A ruled surface joins equal *parameters*. Where the upper rim
# lags by a quarter of a turn, the lines cut across the inside, and the tube has a waist.
#
# That was a coarse pace. Take the NURBS circle, the one with the perfect points and the speed that nobody sees:

# %%
slight = dx.Ruled(foot, dx.to_nurbs(rim))
radius = np.hypot(*np.moveaxis(slight(np.linspace(0, 1, 401)[:, None], fine), -1, 0)[:2])
print(f"least radius {radius.min():.5f}, {1e6 * (1 - radius.min() / 2):.0f} millionths too small")
print("the judge, where the tube is wanted:", asked(slight, tube)[0])
try:
    dx.to_nurbs(slight)
except dx.ConversionError as refused:
    print("refused:", refused)

# %% [markdown]
# A waist of thirty millionths, and yet no tube any more, and nobody has made an error: each of two exact circles was handed on in
# good faith. That is why the library refuses here and says why, where it could have answered with *nearly*.
#
# ## The answer
#
# Is it still your tube? Ask back: *for what?*
#
# * To weigh it or to paint it: the same **set** is enough, covered once.
# * To build on it: the same **map**, or a change of parameters that you know.
# * And *how do you know?* From samples alone you do not. From samples, well placed, *and a degree* you do.

# %% [markdown]
# ## Where to go from here
#
# Convert forms yourself, by hand and both ways: [A5 · Hermite and points](../A5/hermite-and-points.ipynb), [A6 ·
# Bezier](../A6/bezier.ipynb). Make the quarter tube that is exact in [A7 · B-spline and NURBS](../A7/bspline-and-nurbs.ipynb).
# And in the last task of [A9 · Further](../A9/further.ipynb) you take the judge's seat: two black boxes, and a word to find.
#
# When a card next tells you *same set* and not *identical*, you know what it has looked at, and what it has not.
