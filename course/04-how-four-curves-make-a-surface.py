# %% [markdown]
# # How four curves make a surface
#
# **Four bent wires meet in four corners. Somebody wants a sheet of metal that ends on all four. Where is the middle of the
# sheet?**
#
# The wires do not say. Whoever answers has added something. This chapter goes from four points to two curves to four, meets
# the best-known minus sign of the trade, sees a crease that no drawing shows, and ends where a sheet curls up because
# somebody forgot a third.
#
# It takes about two hours; after section 5 is a good place to stop for tonight. Guess before you look.

# %% setup=true
import itertools

import directrix as dx
from directrix.plot import palette

from autograder.catalogue import shipped


def striped(*panels, height=400, eye=(1.2, -1.9, 1.1), stripes=32):
    """Two scenes of (name, forms): every form is painted with the stripes that a row of lamps would leave on it."""
    t = np.linspace(0, 1, 33)
    dark_and_light = [
        [at, ("#5A6B7D", palette.PLAIN)[n % 2]] for n in range(stripes) for at in (n / stripes, (n + 1) / stripes)
    ]
    figure = go.Figure()
    for number, (name, forms) in enumerate(panels):
        scene = "scene" if number == 0 else f"scene{number + 1}"
        for form in forms:
            x, y, z = np.moveaxis(form(t[:, None], t[None, :]), -1, 0)
            lit = form.normal(t[:, None], t[None, :]) @ np.array([0.48, 0.6, 0.64])
            figure.add_surface(x=x, y=y, z=z, surfacecolor=lit, cmin=-1, cmax=1, colorscale=dark_and_light, scene=scene)
        left, right = (0.0, 0.49) if number == 0 else (0.51, 1.0)
        camera = {"eye": dict(zip("xyz", eye, strict=True))}
        axes = {axis: {"visible": False} for axis in ("xaxis", "yaxis", "zaxis")}
        figure.layout[scene] = {"domain": {"x": [left, right]}, "aspectmode": "data", "camera": camera, **axes}
        figure.add_annotation(x=(left + right) / 2, y=1, text=name, showarrow=False, font={"size": 15})
    alt = f"Two surfaces with stripes: {panels[0][0]} and {panels[1][0]}."
    meta = {"link": ["scene", "scene2"], "alt": alt}
    figure.update_layout(height=height, margin={"l": 0, "r": 0, "t": 10, "b": 0}, paper_bgcolor=palette.CLEAR, meta=meta)
    figure.update_layout(font={"color": palette.INK, "family": palette.FONT})
    return figure.update_traces(showscale=False, hoverinfo="skip", lighting=palette.FLAT)


def beside(form, far, behind=0.0):
    """The same form, moved along x and y."""
    return form.moved(dx.Transform.translate((far, behind, 0)))


ends = np.array([0.0, 1.0])
t = np.linspace(0, 1, 33)
u, w = np.linspace(0, 1, 9)[:, None], np.linspace(0, 1, 9)[None, :]

# %% [markdown]
# ## 1 · Four points
#
# Begin with the corners alone. $p_{ij}$ is the corner where $u = i$ and $w = j$; first index $u$, always. The one move that
# you know from chapter 3, *a share of the way*, is enough: go from $p_{00}$ to $p_{10}$ the share $u$ of the way, on the
# other side from $p_{01}$ to $p_{11}$ just as far, and stretch a string between the two. Go along it the share $w$.
#
# This is the **bilinear patch**. Each string is straight, and if you stretch them the other way they are straight as well.
# Four corners that do not lie in one plane: how is the sheet bent?

# %%
bent = None  # "not at all", "like a bowl" or "like a saddle"


# %%
def mix(a, b, t):
    """The share t of the way from a to b: points (..., 3), t a number or an array."""
    t = np.asarray(t, float)[..., None]
    return (1 - t) * a + t * b


def bilinear(p, u, w):
    """The bilinear patch of the corners p, an array (2, 2, 3): p[i, j] is the corner u = i, w = j."""
    ### BEGIN SOLUTION
    return mix(mix(p[0, 0], p[1, 0], u), mix(p[0, 1], p[1, 1], u), w)
    ### END SOLUTION


# %% [markdown]
# Without a model answer: the corners; and along $u$, as along $w$, no second differences. What is left of a formula whose
# pure second derivatives are both 0? Only the mixed one,
#
# $$S_{uw} = p_{00} - p_{01} - p_{10} + p_{11}$$
#
# which is the same everywhere. Remember its name, the **twist**. It will be back.

# %%
p = np.array([[[1, 2, 3], [1, 7, 5]], [[7, 2, 4], [7.5, 7, 2]]], float)
hung = dx.Bilinear(*p.reshape(4, 3))
with once_written():
    S = bilinear(p, u, w)
    holds("the corners", bilinear(p, ends[:, None], ends), p)
    holds("straight along u: no second differences", np.diff(S, n=2, axis=0))
    holds("straight along w: no second differences", np.diff(S, n=2, axis=1))
    twist = np.diff(np.diff(S, axis=0), axis=1) * 64  # an eighth each way
    holds("the twist is p00 - p01 - p10 + p11", twist, p[0, 0] - p[0, 1] - p[1, 0] + p[1, 1])
    holds("the same as the library's", S, hung(u, w))
K = hung.curvature(u, w).gaussian
print(f"Gaussian curvature: from {K.min():.4f} to {K.max():.4f}")
reveal(bent, "like a saddle, everywhere")

# %%
plot.view(hung, colour="gaussian", title="straight lines only, and bent everywhere")

# %% [markdown]
# **Straight lines, both ways, and not a flat spot.** Where two straight lines cross on a surface it cannot bend to one side
# of them only: what it gains on one diagonal it loses on the other. The Gaussian curvature is below 0 wherever the twist
# leaves the tangent plane, and 0 everywhere if all four corners lie in one plane.
#
# So even four points already say more than they seem to.

# %% [markdown]
# ## 2 · Two curves, and who is joined with whom
#
# Now two opposite edges are curves, and straight lines join them. This is the **ruled surface**:
#
# $$S(u, w) = (1 - w)\,c_0(u) + w\,c_1(u)$$
#
# It joins points of *equal parameter*. Machinists like it, since a straight cutter fits along each line. Tinsmiths ask for
# more. A piece of duct leads from a round pipe to an oval one, and it is to be *rolled from flat sheet*, without stretching.
#
# Somebody writes circle and oval the usual way, cosine and sine of the same angle, and joins them. Can that be rolled from
# sheet?

# %%
can_be_rolled = None  # "yes", "no" or "only if the oval is a circle"


# %%
def circle(t):
    angle = 2 * np.pi * np.asarray(t)
    return np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=-1)


def oval(t):
    return circle(t) * [2.4, 0.8, 0] + [0, 0, 2.5]


def turned(surface):
    """By how many degrees the tangent plane turns on the way along its lines, at most."""
    t = np.linspace(0, 1, 97)
    start, end = surface.normal(t, 0), surface.normal(t, 1)
    return np.degrees(np.arccos(np.clip((start * end).sum(-1), -1, 1))).max()


usual = dx.Ruled(circle, oval)
reveal(can_be_rolled, f"no: along a line the tangent plane turns by up to {turned(usual):.0f}°")

# %% [markdown]
# Lay a flat sheet on a straight line of the surface: it must touch *all along* that line. So the tangent plane may not turn
# on the way from $c_0$ to $c_1$. At one end it contains $c_0'(u)$, at the other $c_1'(u)$; here, where circle and oval lie in
# parallel planes, the two must be **parallel**.
#
# So do not join equal angles. Join points with parallel tangents. Where does the oval run in the direction in which the
# circle runs at the angle $\alpha$? At $(a^2\cos\alpha,\; b^2\sin\alpha)$, divided by the length of
# $(a\cos\alpha,\; b\sin\alpha)$. The *same oval*, run at another pace:


# %%
def paced(t):
    x, y, _ = np.moveaxis(circle(t), -1, 0)
    a, b = 2.4, 0.8
    return np.stack([a * a * x, b * b * y, 2.5 * np.hypot(a * x, b * y)], axis=-1) / np.hypot(a * x, b * y)[..., None]


rolled = dx.Ruled(circle, paced)
x, y, z = np.moveaxis(paced(u), -1, 0)
holds("the same oval", (x / 2.4) ** 2 + (y / 0.8) ** 2, 1)
print(f"the tangent plane turns by {turned(rolled):.3f}°")
for name, duct in (("equal angles", usual), ("parallel tangents", rolled)):
    print(f"{name:18} Gaussian curvature up to {abs(duct.curvature(t[:, None], t).gaussian.min()):.4f} below 0")

# %% fold=true
striped(("equal angles", [usual]), ("parallel tangents", [rolled]), eye=(0.5, -1.9, 1.0))

# %% [markdown]
# **Read the stripes.** A stripe is where the tangent plane stands at one and the same angle to the light. Right, each runs
# straight from rim to rim, along a line of the surface. Left they wander across the lines.
#
# Gaussian curvature 0 is what "can be rolled from flat sheet" means; such surfaces are called **developable**. Both ducts have the
# same two rims. *A ruled surface knows more than its curves: it knows how they run.* That is also how it goes wrong most often: one
# curve written backwards, and all lines cross.

# %% [markdown]
# ## 3 · Four curves, and one thing too many
#
# Now all four edges are given, each of another kind: a Bezier curve $c_0$ and an arc of an ellipse $c_1$ along $u$, a
# B-spline $d_0$ and a straight line $d_1$ along $w$. **All run with growing $u$ or $w$**, and they meet at the corners:
# $c_0(0) = d_0(0)$, and so on.
#
# Two of the edges make a ruled surface, and so do the other two. Neither alone will do, so add them:
#
# $$A(u, w) = \big[(1-w)\,c_0(u) + w\,c_1(u)\big] + \big[(1-u)\,d_0(w) + u\,d_1(w)\big]$$
#
# A test before any picture. Lift the four wires by 1. By how much does the sheet $A$ rise?

# %%
rises = None  # a number

# %%
c0 = dx.BezierCurve([p[0, 0], (3, 1.2, 6.6), (5, 2.6, 0.6), p[1, 0]])
c1 = dx.Conic(p[0, 1], (4.2, 8.2, 8.0), p[1, 1], 0.8)
d0 = dx.BSplineCurve([p[0, 0], (0.0, 3.0, 5.8), (1.4, 4.4, 4.6), (0.2, 6.0, 3.4), p[0, 1]], 4)
d1 = dx.Line(p[1, 0], p[1, 1])
frame = {"c0": c0, "c1": c1, "d0": d0, "d1": d1}


def added(u, w, c0, c1, d0, d1):
    return mix(c0(u), c1(u), w) + mix(d0(w), d1(w), u)


up = [curve.moved(dx.Transform.translate((0, 0, 1))) for curve in frame.values()]
reveal(rises, (added(0.3, 0.6, *up) - added(0.3, 0.6, **frame))[2])

# %%
figure = plot.view(lambda u, w: added(u, w, **frame), curves=frame, title="the sum, and the four wires")
figure.update_layout(scene_camera_eye={"x": -1.5, "y": -1.4, "z": 0.9})

# %% [markdown]
# **The sum misses all four wires**, and by more, the further the frame is from the origin. No wonder: the shares of the one part are
# together 1, those of the other too, so all of them are together **2**, and chapter 3 has told what comes of that. A shape
# that depends on where the origin lies is no shape.
#
# Half of the sum then? The shares are together 1. It moves with the frame. Which of the edges does it meet, in general?

# %%
half_meets = None  # "all four", "two opposite ones" or "none"

# %%
half = {
    "c0": added(t, 0, **frame) / 2 - c0(t),
    "c1": added(t, 1, **frame) / 2 - c1(t),
    "d0": added(0, t, **frame) / 2 - d0(t),
    "d1": added(1, t, **frame) / 2 - d1(t),
}
for name, off in half.items():
    print(f"half of the sum is off {name} by up to {np.linalg.norm(off, axis=-1).max():.3f}")
reveal(half_meets, "none, but for an edge that is straight")

# %% [markdown]
# Read the table: the one edge that is met is the straight one. On the edge $w = 0$ the first part gives $c_0(u)$, as it
# should. The second gives the straight line from $p_{00}$ to $p_{10}$. So on each edge there is *a straight line too many*,
# and half of it is still half a line too many.

# %% [markdown]
# ## 4 · The Coons patch
#
# What has exactly these four straight lines as its edges? You wrote it in section 1. Take it away **once**:
#
# $$S = \text{ruled along } w \;+\; \text{ruled along } u \;-\; \text{bilinear}$$
#
# The shares are together $1 + 1 - 1 = 1$. This is the **Coons patch** (S. A. Coons, *Surfaces for computer-aided design of
# space forms*, MIT, 1967). To forget the third part, or to add it, are the best-known mistakes here. Write the line.


# %%
def coons(u, w, c0, c1, d0, d1):
    """The Coons patch of c0(u) = S(u, 0), c1(u) = S(u, 1), d0(w) = S(0, w), d1(w) = S(1, w)."""
    corners = np.array([[c0(0.0), c1(0.0)], [c0(1.0), c1(1.0)]])
    ### BEGIN SOLUTION
    return added(u, w, c0, c1, d0, d1) - bilinear(corners, u, w)
    ### END SOLUTION


# %%
sheet = dx.Coons(**frame)  # the library's, for the pictures
with once_written():
    holds("the edge w = 0 is c0", coons(u, 0, **frame), c0(u))
    holds("the edge w = 1 is c1", coons(u, 1, **frame), c1(u))
    holds("the edge u = 0 is d0", coons(0, w, **frame), d0(w))
    holds("the edge u = 1 is d1", coons(1, w, **frame), d1(w))
    holds("lift the wires by 1, and the sheet rises by 1", coons(u, w, *up), coons(u, w, **frame) + [0, 0, 1])
    straight = dx.Line(p[0, 0], p[0, 1]), dx.Line(p[1, 0], p[1, 1])
    holds("d0, d1 straight: the ruled surface", coons(u, w, c0, c1, *straight), dx.Ruled(c0, c1)(u, w))
    holds("the same as the library's", coons(u, w, **frame), sheet(u, w))

# %%
parts = [beside(dx.Ruled(d0, d1).swap(), 9, 9), beside(hung, 0, 0), beside(sheet, 9, 0)]
words = "back: ruled along w, ruled along u<br>front: bilinear, and first + second − third"
figure = plot.view(beside(dx.Ruled(c0, c1), 0, 9), also=parts, title=words, lines=6)
figure.update_layout(scene_camera_eye={"x": 0.0, "y": -1.2, "z": 1.0}, margin_t=64, title_y=0.93)
figure.update_scenes(xaxis_visible=False, yaxis_visible=False, zaxis_visible=False)

# %% [markdown]
# Now a wrong one beside the right one. All four *corners* are right, and so is one whole edge, the straight one. The three
# bent edges are half as much bent as they should be. **Which mistake made it?**
#
# * `"averaged"`: the mean of the two ruled surfaces
# * `"corners_exchanged"`: $p_{01}$ and $p_{10}$ exchanged in the bilinear part
# * `"blends_exchanged"`: $c_0, c_1$ mixed by $u$, and $d_0, d_1$ by $w$

# %% fold=true
right = shipped().find("coons")
mistakes = {mistake.id: mistake for mistake in right.mistakes}


def somebody(name):
    """The sheet as somebody spans it who makes the mistake of that name."""
    return lambda u, w: mistakes[name].formula(u, w, **frame)


plot.view(somebody("averaged"), against=sheet, names=("right", "wrong"))

# %%
mistake = None  # one of the three names

# %%
reveal(mistake, "averaged")
print(mistakes["averaged"].hint, "\n")
four = dict(zip(frame, (dx.Line(*p[:, 0]), dx.Line(*p[:, 1]), dx.Line(*p[0]), dx.Line(*p[1])), strict=True))
for name in ("averaged", "one_ruled", "corners_exchanged", "no_correction"):
    off = [np.abs(mistakes[name].formula(u, w, **wires) - right(u, w, **wires)).max() for wires in (four, frame)]
    print(f"{name:18} off by {off[0]:6.3f} with straight wires, {off[1]:6.3f} with ours")

# %% [markdown]
# With straight wires both ruled surfaces *are* the bilinear one, $B$, and $(B + B)/2$ is the same as $B + B - B$. Four straight
# edges are **blind** to the first two of these mistakes. One bent edge is enough to see them.
#
# ### How high is the dome?
#
# Four equal arches stand on the sides of a square, each of height 1. What is the height of the Coons patch in the middle?
# (The feet of the arches are at height 0.)

# %%
dome = None  # a height


# %%
def arch(a, b):
    """A parabola of height 1 over the straight line from a to b."""
    return dx.BezierCurve([a, (np.add(a, b)) / 2 + (0, 0, 2), b])


foot = np.array([[[0, 0, 0], [0, 4, 0]], [[4, 0, 0], [4, 4, 0]]], float)
arches = {"c0": arch(*foot[:, 0]), "c1": arch(*foot[:, 1]), "d0": arch(*foot[0]), "d1": arch(*foot[1])}
tent = dx.Coons(**arches)
reveal(dome, tent(0.5, 0.5)[2])
plot.view(tent, curves=arches, mark=(0.5, 0.5))

# %% [markdown]
# **Twice as high as any wire.** Each ruled surface is 1 high in the middle, the bilinear one 0, and $1 + 1 - 0 = 2$. The
# shares are together 1, so it moves along with the frame; but one of them is $-1$, so the *convex hull* of chapter 3 is gone.
# The Coons patch is not the lazy skin of a soap film. It adds up what the edges ask for.
#
# Is it then "the" surface of the four wires? It is the simplest formula. You will now see what that costs.

# %% [markdown]
# ## 5 · Two sheets side by side
#
# A bonnet is rarely one sheet. Here are two, with a rib between them that both share. The front line runs through *smoothly*
# from one sheet to the next, and so does the back line. Each sheet is a Coons patch. How do they meet along the rib?

# %%
meet = None  # "smoothly", "with a crease" or "with a gap"


# %%
def line(y, x0):
    """A piece, one long, of a smooth wave across both sheets: it begins at x0."""
    return dx.FunctionCurve(lambda t: np.stack([x0 + t, y + 0 * t, 0.15 * np.sin(1.2 * (x0 + t) + y)], axis=-1))


def rib(x, height):
    """From the front line to the back line, and in between as high as we like."""
    start, end = line(0.0, x)(0.0), line(2.0, x)(0.0)
    return dx.BezierCurve([start, (2 * start + end) / 3 + (0, 0, height), (start + 2 * end) / 3 + (0, 0, height), end])


ribs = [rib(0.0, 0.38), rib(1.0, 0.36), rib(2.0, 0.12)]
bonnet = {}
for blend in ("linear", "cubic"):
    bonnet[blend] = [dx.Coons(line(0.0, i), line(2.0, i), ribs[i], ribs[i + 1], blend) for i in (0, 1)]
    before, after = bonnet[blend][0].normal(1, t), bonnet[blend][1].normal(0, t)
    bonnet[blend, "crease"] = np.degrees(np.arccos(np.clip((before * after).sum(-1), -1, 1))).max()
reveal(meet, f"with a crease, of up to {bonnet['linear', 'crease']:.0f}°")

# %% [markdown]
# Look at what a sheet does across its edge $u = 1$. Derive the formula by $u$: there is $d_1(w) - d_0(w)$ in it, and $d_0$ is
# the rib on the *far* side. The two sheets have different far sides. So the direction in which each arrives depends on a wire
# that is nowhere near.
#
# The cure is in the blending. In place of $1 - t$ and $t$ take two functions that also go from 1 to 0 and from 0 to 1, but
# **start and end with slope 0**, in all three parts:
#
# $$F_1 = 2t^3 - 3t^2 + 1, \qquad F_2 = 3t^2 - 2t^3$$
#
# Then the far rib has no say. In the library: `blend="cubic"`.

# %% fold=true
print(f"crease with linear blends: {bonnet['linear', 'crease']:.2f}°, with cubic ones: {bonnet['cubic', 'crease']:.2f}°")
striped(("linear blends", bonnet["linear"]), ("cubic blends", bonnet["cubic"]))

# %% [markdown]
# **Here are the lamps again.** Body shops hang a row of them over a panel and look at how the reflections run: the eye forgives a
# crease of a few degrees, but no broken line. Where a stripe *jumps*, the tangent plane jumps. Where it has a *corner*, the
# curvature does. Where it runs through, you may paint.
#
# Left they jump. Right they meet at the rib, each with a corner: better, and still not what one calls a clean bonnet.
#
# A good place to stop for tonight. The other half is about what the wires have left open.

# %% [markdown]
# ## 6 · A tangent has a length
#
# Steel wire is bought by its ends and by how it leaves them. A **Hermite cubic** is given so: two points, two derivatives,
#
# $$F_1(t)\,p_0 + F_2(t)\,p_1 + F_3(t)\,p_0' + F_4(t)\,p_1'$$
#
# with $F_3 = t^3 - 2t^2 + t$ and $F_4 = t^3 - t^2$. A derivative has a direction *and a length*. Make a quarter of the unit
# circle, from $(1, 0)$, upwards, to $(0, 1)$, arriving to the left. The directions are plain. Which length for the two?

# %%
best_length = None  # 1, about 1.57 (the length of the arc) or about 1.66


# %%
def F(t):
    """F1, F2, F3, F4 at t, shape of t + (4,)."""
    t = np.asarray(t, float)
    return np.stack([2 * t**3 - 3 * t**2 + 1, 3 * t**2 - 2 * t**3, t**3 - 2 * t**2 + t, t**3 - t**2], axis=-1)


def quarter(length):
    return F(np.linspace(0, 1, 241)) @ np.array([[1, 0], [0, 1], [0, length], [-length, 0]])


for length in (1, np.pi / 2, 4 * (np.sqrt(2) - 1), 3):
    r = np.hypot(*quarter(length).T)
    print(f"length {length:.3f}: the radius goes from {r.min():.4f} to {r.max():.4f}")
reveal(best_length, "about 1.66, that is 4(√2 − 1): then the middle lies on the circle, as F3(1/2) = 1/8 makes it")

# %% fold=true
figure = go.Figure().update_layout(height=380, template="none", margin={"t": 10, "b": 10, "l": 10, "r": 10})
figure.update_layout(
    paper_bgcolor=palette.CLEAR, plot_bgcolor=palette.CLEAR, font={"color": palette.INK, "family": palette.FONT}
)
figure.update_xaxes(visible=False, range=[-1.2, 2.2]).update_yaxes(visible=False, scaleanchor="x", range=[-0.1, 1.6])
angle = np.linspace(0, np.pi / 2, 91)
grey = {"color": palette.INK, "width": 6, "dash": "dot"}
figure.add_scatter(x=np.cos(angle), y=np.sin(angle), mode="lines", name="the circle", line=grey)
colours = ["#E69F00", palette.CURVE, "#CC79A7", palette.YOURS]
for length, colour in zip((1, 1.657, 3, 8), colours, strict=True):
    x, y = quarter(length).T
    figure.add_scatter(x=x, y=y, mode="lines", name=f"length {length}", line={"color": colour, "width": 3})
for x, y, right_by, up_by in ((1, 0, 0, 1), (0, 1, -1, 0)):
    arrow = {"showarrow": True, "arrowhead": 2, "arrowwidth": 2, "arrowcolor": palette.INK, "text": ""}
    figure.add_annotation(x=x + 0.5 * right_by, y=y + 0.5 * up_by, ax=x, ay=y, axref="x", ayref="y", **arrow)
figure

# %% [markdown]
# **The same two arrows, the same directions.** Unit tangents cut the corner by 12 per cent; too long ones overshoot, and
# still longer ones make a loop. Whoever makes derivatives unit vectors, since "only the direction counts", throws a part of
# the data away.
#
# ### The Ferguson patch
#
# Let the same four functions mix in both directions. For that one needs, at each corner, the point $p$, the tangents $p_u$
# and $p_w$, and a fourth thing, which for the moment is **zero**:
#
# $$S(u, w) = \sum_i \sum_j F_i(u)\, F_j(w)\, G_{ij}, \qquad
# G = \begin{pmatrix} p & p_w \\ p_u & 0 \end{pmatrix}$$
#
# each a block of $2 \times 2$ corners (J. C. Ferguson, *Multivariable curve interpolation*, 1964). Write the double sum.


# %%
def hermite_patch(G, u, w):
    """The patch of G, an array (4, 4, 3): [[p, pw], [pu, twists]], each block [u corner, w corner]."""
    ### BEGIN SOLUTION
    return np.einsum("...i,...j,ijk->...k", F(u), F(w), G)
    ### END SOLUTION


# %% [markdown]
# The lecture says that Ferguson, too, "takes four boundary curves". Try it. From our four wires take the corners and, there,
# the derivatives: nothing else. Which of the four wires are edges of the Ferguson patch?
#
# Recall what they are: $c_0$ a cubic Bezier curve, $c_1$ an arc of an ellipse, $d_0$ a B-spline of two spans, $d_1$ a straight line.

# %%
kept = None  # for example "c0, c1"

# %%
pu = np.stack([c0.derivative(ends), c1.derivative(ends)], axis=1)
pw = np.stack([d0.derivative(ends), d1.derivative(ends)])
G = np.zeros((4, 4, 3))
G[:2, :2], G[2:, :2], G[:2, 2:] = p, pu, pw
with once_written():
    S = {"c0": (u[:, 0], 0), "c1": (u[:, 0], 1), "d0": (0, w[0]), "d1": (1, w[0])}
    for name, place in S.items():
        off = np.linalg.norm(hermite_patch(G, *place) - frame[name](w[0]), axis=-1).max()
        print(f"the edge in place of {name} is off by up to {off:.3f}")
    reveal(kept, "c0, d1: a Hermite cubic is all that corners and tangents can say, and these two are cubics")
    holds("the same as the library's", hermite_patch(G, u, w), dx.Ferguson(p, pu, pw)(u, w))

# %% [markdown]
# So the two take different things. Coons takes *four whole curves* and says nothing of tangents. Ferguson takes *corners and
# tangents*; only if the wires are Hermite cubics is that the same frame. From here on let them be, so that only the inside
# can differ.

# %% [markdown]
# ## 7 · What the zeros do
#
# Those zeros in the corner of $G$ are mixed derivatives, $\partial^2 S/\partial u\,\partial w$: the **twists**. They do not
# touch the edges, as $F_3$ and $F_4$ vanish at both ends. So what harm can they do?
#
# Take the simplest bent surface there is, $z = xy$ over the unit square. It is bilinear, all its edges are straight. Hand
# Ferguson its corners and its tangents, all of them exact. Do you get $z = xy$ back?

# %%
back = None  # "yes", "nearly" or "no"

# %%
saddle = dx.Bilinear((0, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 1))
at = ends[:, None], ends[None, :]
pressed = dx.Ferguson(saddle.corners, saddle.derivative(*at, 1, 0), saddle.derivative(*at, 0, 1))
holds("the same four edges: u = 0 and u = 1", pressed(ends[:, None], w), saddle(ends[:, None], w))
holds("the same four edges: w = 0 and w = 1", pressed(u, ends), saddle(u, ends))
off = np.abs(pressed(t[:, None], t) - saddle(t[:, None], t)).max()
reveal(back, f"nearly: off by {100 * off:.1f} per cent of the side")
for name, form in (("z = xy", saddle), ("Ferguson", pressed)):
    K = form.curvature(*at).gaussian + 0.0
    print(f"{name:9} Gaussian curvature at the corners: {', '.join(f'{k:.3f}' for k in K.ravel())}")

# %% [markdown]
# One per cent: nobody would see that. But look at the last line. *All four corners of the Ferguson patch are flat*: curvature
# 0, while the saddle has none that is 0 anywhere. Here is the same patch, coloured by it:

# %%
plot.view(pressed, colour="gaussian", title="z = xy, as Ferguson gives it back: the Gaussian curvature")

# %% [markdown]
# **A pale spot at each corner**, and to make up for it the sheet bends too much elsewhere. The reason in one line: a surface
# bends at a point by $S_{uu}$, $S_{ww}$ and $S_{uw}$. The edges settle the first two; with $S_{uw} = 0$ the third is lost. A
# corner with zero twist *bends only as its two edges bend*; if they are straight, it is flat.
#
# In the Bezier net of the patch one sees it as a shape: the four points at each corner make a **parallelogram**, since
# $S_{uw} = 9\,(P_{00} - P_{01} - P_{10} + P_{11})$.

# %%
P = dx.to_bezier(pressed).control_net
holds("Ferguson: a parallelogram at the corner", P[1, 1], P[1, 0] + P[0, 1] - P[0, 0])
edges = (dx.Line(*pressed(ends, 0)), dx.Line(*pressed(ends, 1)), dx.Line(*pressed(0, ends)), dx.Line(*pressed(1, ends)))
holds("the Coons patch of these edges gives z = xy back", dx.Coons(*edges)(u, w), saddle(u, w))

# %% [markdown]
# Is zero ever right? Yes: for one curve *carried along* another, the sum $G(u) + D(w) - D(0)$ of chapter 2. There no term
# contains both $u$ and $w$, and the twist is zero everywhere. A Ferguson patch is at its best where opposite edges are alike.

# %% [markdown]
# ## 8 · Where twists come from
#
# Nobody measures a twist. But Coons gave the saddle back, and Coons was handed nothing but edges! So the edges contain a good
# guess. Derive his formula by $u$ and by $w$, part by part, at the corner $ij$:
#
# * ruled along $w$: the change of $p_u$ from one edge to the other, $p_{u,i1} - p_{u,i0}$
# * ruled along $u$: the change of $p_w$, that is $p_{w,1j} - p_{w,0j}$
# * less the twist of the bilinear patch, $p_{00} - p_{01} - p_{10} + p_{11}$
#
# If the four edges are Hermite cubics, the Coons patch is the Hermite patch with *these* twists.

# %%
T = G.copy()
T[2:, 2:] = (pu[:, 1] - pu[:, 0])[:, None] + (pw[1] - pw[0])[None, :] - (p[0, 0] - p[0, 1] - p[1, 0] + p[1, 1])
along_u = [dx.HermiteCurve(p[0, j], p[1, j], pu[0, j], pu[1, j]) for j in (0, 1)]
along_w = [dx.HermiteCurve(p[i, 0], p[i, 1], pw[i, 0], pw[i, 1]) for i in (0, 1)]
with once_written():
    holds("with these twists it is Coons", hermite_patch(T, u, w), coons(u, w, *along_u, *along_w))
    holds("twists do not move an edge", hermite_patch(T, u, ends), hermite_patch(G, u, ends))
    apart = np.linalg.norm(hermite_patch(T, u, w) - hermite_patch(G, u, w), axis=-1)
    print(f"inside, Ferguson and Coons are up to {apart.max():.3f} apart")

# %% [markdown]
# How good is a guess? Ask a surface that we know. A *lampshade*, a leaning curve turned about an axis, is cut into
# $n \times n$ pieces. Each piece keeps its exact corners and its exact tangents and is filled three ways: with zero twists,
# with those of Coons, and with the true ones.
#
# Twice as many pieces each way: by what is the error divided? For Hermite cubics one expects 16.

# %%
zero_divided_by = None  # 2, 4, 8 or 16

# %% fold=true
leaning = dx.BezierCurve([(2, -1.5, 0), (1.2, -0.3, 1), (1.2, 0.6, 2.2), (2.4, 1.6, 3)])
shade = dx.CircularSweep(leaning, "z", 1.2)


def pieces(n, rule):
    """The shade, filled again from the corners and tangents of n × n pieces, with the twists of a rule."""
    found, h = [], 1 / n
    for i in range(n):
        for j in range(n):
            at = (h * (i + ends))[:, None], (h * (j + ends))[None, :]
            along = h * shade.derivative(*at, 1, 0), h * shade.derivative(*at, 0, 1)
            twists = h * h * shade.derivative(*at, 1, 1) if rule == "true" else rule
            found.append(dx.HermitePatch.of(shade(*at), *along, twists))
    return found


def furthest(n, rule):
    """How far that is from the shade, at most."""
    s = np.linspace(0, 1, 13)
    off = [
        form(s[:, None], s) - shade((s[:, None] + i) / n, (s + j) / n)
        for form, (i, j) in zip(pieces(n, rule), np.ndindex(n, n), strict=True)
    ]
    return np.linalg.norm(off, axis=-1).max()


errors = {rule: [furthest(n, rule) for n in (1, 2, 4, 8)] for rule in ("zero", "coons", "true")}
for rule, off in errors.items():
    ratios = ", ".join(f"{a / b:4.1f}" for a, b in itertools.pairwise(off))
    print(f"{rule:6} off by {', '.join(f'{e:.1e}' for e in off)}    divided by {ratios}")
reveal(zero_divided_by, f"{errors['zero'][2] / errors['zero'][3]:.0f}; with the twists of Coons or the true ones it is 16")

# %% [markdown]
# **Two whole orders lost**, for four zeros. And the guess of Coons is in the same class as the truth: the edges knew it all
# along.
#
# Now look at the shade under the lamps, from $4 \times 4$ pieces. Edges, corners and tangents of the two are the same; what
# differs is less than a thousandth of the size.

# %% fold=true
striped(("zero twists", pieces(4, "zero")), ("twists of Coons", pieces(4, "coons")), eye=(1.5, 0.83, 0.4), stripes=40)

# %% [markdown]
# **What to see.** Left every stripe staggers at every corner, though everything is exact but the twists. Books have a name
# for such corners, *pseudo-flats*.

# %% [markdown]
# ## 9 · The limit: how long may a tangent be?
#
# A flat square of side 1. All edges straight, all tangents along the edges, all of them $s$ long; twists zero. For $s = 1$
# the patch is $S = (u, w, 0)$. Let $s$ grow. No edge ever bends, since everything lies on its line. From which $s$ on does
# the sheet fold over itself?

# %%
folds_from = None  # a length

# %%
unit = np.array([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]], float)
for s in (1, 2, 3, 3.5, 5):
    flat = dx.Ferguson(unit, [[[s, 0, 0]] * 2] * 2, [[[0, s, 0]] * 2] * 2)
    speed = flat.derivative(t, 0, 1, 0)[:, 0]
    print(f"s = {s:<3}  slowest along u: {speed.min():5.2f}   area, counted as often as covered: {flat.area():.3f}")
reveal(folds_from, 3)

# %% [markdown]
# The derivative at $t = 1/2$ is $\tfrac32 - \tfrac{s}{2}$. At $s = 3$ the sheet *stands still* on two lines across it, and
# there it has no normal. Above 3 it runs backwards.
#
# Where would anybody get tangents three times too long? On the way to a **Bezier net**, where the first leg is *a third* of
# the tangent. Whoever adds the whole tangent to the corner arrives here exactly. On a flat square the set of points is the
# same to the end: the square is blind to it. On a bent frame it is not:

# %%
long = {mistake.id: mistake for mistake in shipped().find("ferguson").mistakes}["thirds_forgotten"]
print(long.hint)
bend = np.array([[0, 0, 0.5], [0, 0, -0.5]])[:, None, :]
given = {"p": unit, "pu": np.array([1.4, 0, 0]) + 0 * unit + bend, "pw": np.array([0, 1.0, 0]) + 0 * unit}
figure = plot.walk(lambda u, w: long.formula(u, w, **given), [(0, 0.5), (1, 0.5)], steps=49, title="three times too long")
figure.update_traces(opacity=0.55, selector={"type": "surface"})

# %% [markdown]
# **Walk slowly.** In the square the marker goes straight across. The sheet has curled up, and the marker runs through a loop.
# Each corner is right, and so is the direction of every tangent; only the lengths are not. In chapter 2 a pipe that was too
# thick for its bend ran backwards in the same way, and there too nothing at its ends gave it away.

# %% [markdown]
# ## The answer
#
# Where is the middle of the sheet? Ask five people who have the same four wires:

# %%
middles = {
    "straight lines from c0 to c1": dx.Ruled(c0, c1),
    "straight lines from d0 to d1": dx.Ruled(d0, d1).swap(),
    "Coons, linear blends": sheet,
    "Coons, cubic blends": dx.Coons(**frame, blend="cubic"),
    "Ferguson, from the tangents": dx.Ferguson(p, pu, pw),
}
for name, form in middles.items():
    print(f"{name:29} {np.round(form(0.5, 0.5), 2) + 0.0}")

# %% [markdown]
# (Two of the five agree here, and differ elsewhere: at $t = 1/2$ both blends are one half. The middle is blind to blends.)
#
# Each has added something that the wires do not say. *Four curves do not make a surface; four curves and a rule do.* So
# whoever hands over four edges must say by which rule they were filled, or hand over the inside as well: sixteen points, or
# four twists.
#
# To read on: Farin, *Curves and Surfaces for CAGD*, for Coons patches and for twists.

# %% [markdown]
# ## Where to go from here
#
# Write them yourself: bilinear and ruled surfaces, and a plane that can be told from a saddle, in [A4 · Generic and
# ruled](../A4/generic-and-ruled.ipynb); Coons, Ferguson and the twists between the two in [A8 · Boundary
# curves](../A8/boundary-and-solids.ipynb), where the place is named in which the two can never be told apart.
#
# And where one sheet ends, a solid may begin: six patches that close, and a third parameter to fill them. That is in A8, too.
#
# Left open: somebody *makes* the thing, and it is not quite what was meant. By how much? That is the next chapter: [How round
# a part is](05-how-round-a-part-is.ipynb).
