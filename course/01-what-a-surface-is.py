# %% [markdown]
# # What a parametric surface is
#
# **Roll a sheet of paper into a tube. Which point of the sheet became which point of the tube?**
#
# Whoever can answer that for *every* point has a parametric surface. This chapter rolls the sheet, writes the rule down, finds
# out what can go wrong with it, and ends where a doughnut becomes a ball. It takes about an hour. Type your guess before you run
# the cell that answers; nobody marks it.

# %% setup=true
import directrix as dx
from directrix.plot import palette

from autograder.catalogue import shipped

# %% [markdown]
# ## 1 · A sheet, and a tube
#
# Two numbers find a place on the sheet: $u$ to the right, $w$ upwards, both from 0 to 1. All of them together are the
# **parameter square**. Now roll the sheet from left to right until the left edge meets the right edge: a tube of radius 2. Pull
# it to a height of 5.
#
# Draw a straight diagonal on the sheet before you roll it. What does it become on the tube?

# %%
diagonal = None  # "a straight line", "a circle", "an ellipse" or "a helix"

# %%
tube = dx.Cylinder(radius=2, height=5)
reveal(diagonal, "a helix")
plot.walk(tube, [(0, 0), (1, 1)])

# %% [markdown]
# **Move the slider.** One marker, two places: right where it is on the sheet, left where that point of the sheet has gone. The
# blue lines run along $u$, the orange ones along $w$, here and there. What was a blue straight line has become a circle; the two
# thick orange edges have met.
#
# Where is the marker when $u = 1/4$? Say it before you look: $(x, y, z) = $?

# %%
quarter = None  # for example (1, 2, 3)

# %%
reveal(quarter, tuple((np.round(tube(0.25, 0.25), 12) + 0.0).tolist()))

# %% [markdown]
# ## 2 · The rule
#
# Three functions of $u$ and $w$, one for each coordinate. They are the surface:
#
# $$S(u, w) = \big(\,x(u, w),\; y(u, w),\; z(u, w)\,\big)$$
#
# Before you look for them, say what must be true of every point: $x^2 + y^2 = r^2$, and $z$ does not depend on $u$. Then the
# first point lies on $+x$, $u$ goes round towards $+y$, and one turn is $2\pi$.
#
# The decisive line is missing below. Write it.


# %%
def cylinder(u, w, r, h):
    """The tube: radius r about the z axis, from z = 0 to z = h."""
    u, w = np.broadcast_arrays(u, w)
    angle = 2 * np.pi * u
    ### BEGIN SOLUTION
    return np.stack([r * np.cos(angle), r * np.sin(angle), h * w], axis=-1)
    ### END SOLUTION


# %%
u, w = np.linspace(0, 1, 9)[:, None], np.linspace(0, 1, 9)[None, :]
with once_written():
    x, y, z = np.moveaxis(cylinder(u, w, 2, 5), -1, 0)
    holds("x² + y² = r²", x**2 + y**2, 4)
    holds("z does not depend on u", z, z[0])
    holds("the same as the library's", cylinder(u, w, 2, 5), tube(u, w))
    check(cylinder)

# %% [markdown]
# ## 3 · They look the same
#
# Here are two cylinders of radius 1 and height 1. One is right, one was made with a mistake that learners really make. Can you
# tell which? (The cell is folded away, since it names the mistake.)

# %% fold=true
right = shipped().find("cylinder")
mistakes = {mistake.id: mistake for mistake in right.mistakes}


def wrong(name, **size):
    """The cylinder as somebody writes it who makes the mistake of that name."""
    return lambda u, w: mistakes[name].formula(u, w, **size)


def cylinder_of(**size):
    return lambda u, w: right(u, w, **size)


small, large = {"r": 1, "h": 1}, {"r": 2, "h": 5}
plot.view(wrong("no_height", **small), against=cylinder_of(**small), names=("one", "the other"))

# %% [markdown]
# Nobody can: they are the same everywhere. $r = h = 1$ is **blind** to this mistake. Take numbers that nothing else could be
# mistaken for:

# %%
plot.view(wrong("no_height", **large), against=cylinder_of(**large), names=("right", "wrong"))

# %% [markdown]
# Now it shows: the height never entered the formula. The ones, zeros and equal lengths that come to mind first are the worst
# test there is.
#
# ## 4 · The same points, another rule
#
# The next pair is drawn with $r = 2$, $h = 5$, and still the two *sets of points* agree exactly. But the colour is the distance
# between $S(u, w)$ of one and $S(u, w)$ of the other. **Which mistake made it?**
#
# * `"swap_uw"`: $u$ and $w$ exchanged
# * `"clockwise"`: round the wrong way
# * `"starts_on_y"`: sine and cosine exchanged
#
# Look first, then type; the last cell answers.

# %% fold=true
plot.view(wrong("clockwise", **large), against=cylinder_of(**large), names=("right", "wrong"))

# %%
mistake = None  # one of the three names

# %%
reveal(mistake, "clockwise")
print(mistakes["clockwise"].hint)

# %% [markdown]
# **Read the colours.** Dark along two lines, $u = 0$ and $u = 1/2$: there clockwise and anticlockwise meet. Bright half way
# between. Follow the thick orange edge: $u$ leaves it to the other side.
#
# A set of points is not yet a surface. The rule says which point has which name, and everything that is built on it relies on the
# names: a texture, a trimmed hole, the path of a milling cutter, and the side that is *outside*.

# %% [markdown]
# ## 5 · Which side is outside?
#
# At each point two directions leave: along $u$ and along $w$. Their cross product $S_u \times S_w$ is the **normal**. So the rule
# decides where it points, and nobody else. On our tube, $u$ goes round anticlockwise and $w$ goes up.
#
# Does the normal point outwards or inwards?

# %%
normal = None  # "outwards" or "inwards"

# %%
reveal(normal, "outwards")
print("at u = 0, w = 1/2 the point is", tube(0, 0.5), "and the normal", tube.normal(0, 0.5))
plot.view(tube, normals=True)

# %% [markdown]
# **Turn it inside out.** Exchange $u$ and $w$, or run one of them backwards, and all needles point inwards, with not one point
# moved. Do both, and they point outwards again. (Some books take $S_w \times S_u$. Ask which, before you subtract a hole.)

# %% [markdown]
# ## 6 · Four forms, one lathe
#
# Cylinder, cone, sphere and torus are the same construction. Draw a curve beside an axis, and turn it. Only the curve changes:
#
# | form | distance from the axis, $\varrho$ | height, $z$ |
# |---|---|---|
# | cylinder | $r$ | $h\,t$ |
# | cone | $r_1 + (r_2 - r_1)\,t$ | $h\,t$ |
# | sphere | $r \cos\varphi$ | $r \sin\varphi$ |
# | torus | $R + r \cos\varphi$ | $r \sin\varphi$ |
#
# One change from each line to the next. Just one of the four curves touches the axis. Which, and what becomes of that edge of the
# square?

# %%
touches = None  # for example "the torus; the edge becomes a line"

# %% fold=true
reveal(touches, "the sphere, at both ends; each of these edges becomes one point, a pole")
t = np.linspace(0, 1, 97)
curves = {
    "cylinder": (2 + 0 * t, 4 * t - 2),
    "cone": (2.4 - 2 * t, 4 * t - 2),
    "sphere": (2 * np.cos(np.pi * (t - 0.5)), 2 * np.sin(np.pi * (t - 0.5))),
    "torus": (1.6 + np.cos(2 * np.pi * t), np.sin(2 * np.pi * t)),
}
figure = go.Figure().update_layout(height=280, template="none", showlegend=False, margin={"l": 10, "r": 10, "t": 40, "b": 10})
figure.update_layout(
    paper_bgcolor=palette.CLEAR, plot_bgcolor=palette.CLEAR, font={"color": palette.INK, "family": palette.FONT}
)
for place, (name, (rho, z)) in enumerate(curves.items()):
    left = 5 * place
    figure.add_scatter(x=[left, left], y=[-2.6, 2.6], mode="lines", line={"color": "#888", "dash": "dash", "width": 1})
    figure.add_scatter(x=left + rho, y=z, mode="lines", line={"color": "#0072B2", "width": 4})
    figure.add_scatter(x=[left + rho[0]], y=[z[0]], mode="markers", marker={"color": "#7A7A7A", "size": 9})
    figure.add_annotation(x=left + 1, y=3, text=name, showarrow=False, font={"size": 15})
figure.update_xaxes(visible=False, range=[-1, 19]).update_yaxes(visible=False, scaleanchor="x", range=[-2.8, 3.4])
figure

# %% [markdown]
# The curve that is turned is called the **generatrix**, the circle that guides it the **directrix**. For the sphere and the torus
# "a circle on a circle" means *turning* the one round the other, not carrying it along.
#
# One thing to watch. In the formulas of the lecture $u$ goes round the cylinder, but *along* the generatrix of the sphere. Built
# on the lathe, the cylinder has its parameters exchanged:

# %%
turned = tube.swept()
print("by the formula S(1/4, 0) =", np.round(tube(0.25, 0), 12) + 0.0)
print("on the lathe   S(1/4, 0) =", np.round(turned(0.25, 0), 12) + 0.0)
plot.walk(turned, [(0, 0.25), (1, 0.25), (1, 1)])

# %% [markdown]
# ## 7 · Something to test against, without a model answer
#
# Each of the four has an equation that knows nothing of $u$ and $w$. Put any surface in: if the answer is 0 everywhere, its points
# lie where they should. It cannot see *which* point is which, so it is a first test, not the last.

# %%
ball = dx.Sphere(radius=2)
equation = ball.implicit()
print("the sphere in its own equation: ", np.abs(equation(ball(u, w))).max())
print("the tube in the sphere's:       ", np.abs(equation(tube(u, w))).max())

# %% [markdown]
# ## 8 · The limit: when does a doughnut become a ball?
#
# Let the radius $r = 1$ of the tube stay, and let $R$, its distance from the axis, go to 0. Guess the **area** at the very end. A
# ring torus has $4\pi^2 R\,r$; a ball of radius 1 has $4\pi \approx 12.57$.

# %%
area_at_the_end = None

# %%
for R in (3, 1, 0.5, 0.1, 0):
    print(f"R = {R:<4} area {dx.Torus(R, 1).area():7.3f}    4π²Rr = {4 * np.pi**2 * R:7.3f}")
reveal(area_at_the_end, round(dx.Torus(0, 1).area(), 3))

# %%
plot.walk(dx.Torus(0.5, 1), [(0, 0.1), (1, 0.1)], title="R = 0.5: the tube cuts through itself")

# %% [markdown]
# **What happened?** Below $R = 1$ the tube cuts through itself, and $4\pi^2 Rr$ stops counting right: an inner skin lies within the
# outer one. At $R = 0$ both skins coincide. It *is* the sphere, and the rule covers it **twice**: the area is
# $8\pi \approx 25.13$. Change `0.5` above to `0` and walk round: after half of the way you see places that you know.
#
# All the way down the rule is that of a torus, closed in $u$ *and* in $w$; at the very end its image is a sphere, which has no
# hole. The shape has a limit. The topology does not go along.

# %% [markdown]
# ## Where to go from here
#
# You have met the five known forms as rules. Write them yourself in [A1 · Known forms](../A1/known-forms.ipynb), where each
# function is checked like the one above, and each mistake has a name.
#
# The next form needs no circle at all: take *any* curve, and push it along a straight line. That is the **linear sweep**, and the
# beginning of the next chapter: [How a curve sweeps a surface](02-how-a-curve-sweeps-a-surface.ipynb).
