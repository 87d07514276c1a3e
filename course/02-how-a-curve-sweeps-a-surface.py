# %% [markdown]
# # How a curve sweeps a surface
#
# **Carry a hoop along a bent wire, and it leaves a pipe behind. How must you hold the hoop on the way?**
#
# Two curves are given, the one that moves and the one that it follows. They do not settle the surface.
#
# This chapter pushes a curve along a line, turns it about an axis, carries it along a wire in three ways, and ends where a pipe is
# too thick for its bend. Take two evenings: sections 1 to 4, then 5 to 10, where you write three functions. Guess before you
# look: the answers that surprise you are those that stay.

# %% setup=true
import directrix as dx

from autograder.catalogue import shipped


def points(x, y, z):
    """Coordinates that broadcast against each other, as points (..., 3)."""
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


# %% [markdown]
# ## 1 · Along a line
#
# The curve that moves is the **generatrix** $G(u)$. The curve that guides it is the **directrix**; the simplest is a straight
# line, with a direction $k$ of length 1 and a distance $d$. This is the **linear sweep**:
#
# $$S(u, w) = G(u) + w\,d\,k$$
#
# Each parameter measures one thing only. $u$ says *which* point of the curve, $w$ says *how much of the way* it has gone: a share,
# from 0 to 1, and no length. Here a wave is pushed 3 along $y$. In the picture the lines along $w$ will be orange. What do they
# all have in common?

# %%
orange = None  # two things, in your own words


# %%
def wave(s):
    return points(4 * s, 0, 0.4 * np.sin(6 * np.pi * s))


roof = dx.LinearSweep(wave, direction=(0, 1, 0), distance=3)
reveal(orange, "their length and their direction: each is the arrow d k, begun at another point")
plot.walk(roof, [(0, 0), (0.75, 0), (0.75, 1)])

# %% [markdown]
# Now keep the length of the arrow and lean it over towards $x$, by 30°, by 60°, until it lies in the plane of the wave. Each point
# still travels 3. A roof is paid for by its area, so say before you look: is the sheet at 60° larger, smaller or the same?

# %%
leaning = None  # "larger", "smaller" or "the same"

# %%
rod = dx.Line((0, 0, 0), (4, 0, 0))
for degrees in (0, 30, 60, 90):
    lean = np.radians(degrees)
    k = np.sin(lean), np.cos(lean), 0
    by_wave, by_rod = (dx.LinearSweep(curve, k, 3).area() for curve in (wave, rod))
    print(f"{degrees:2}°: the wave sweeps an area of {by_wave:6.3f}, a straight rod {by_rod:6.3f}")
reveal(leaning, "smaller")

# %% [markdown]
# **What counts** is the part of the arrow that goes *across* the curve: the area element is $|G' \times k|\,d\;du\,dw$. The rod
# at 90° is pushed along itself. It moves, and makes no surface: area 0, and no normal anywhere.
#
# The wave at 90° smears itself over its own plane, every bump over the next. That area is counted, but it is a stain and no roof.

# %% [markdown]
# ## 2 · Round an axis
#
# For the **circular sweep** the directrix is a circle. To say which, give its axis, a point $p$ and a direction $k$, and the angle
# $\alpha$ to turn; $w$ is the share of it. *Each point of the generatrix has a circle of its own*: centre on the axis, plane across.
#
# So two things must hold, whatever the formula: neither $(S - p)\cdot k$, the height along the axis, nor the distance $|S - p|$
# depends on $w$.
#
# The sense is the right-hand rule: thumb along $k$, the fingers lead the way. Turn the thumb round, $k \to -k$, and the angle too,
# $\alpha \to -\alpha$. What becomes of the surface?

# %%
turned_round = None  # "the same", "the other way round" or "somewhere else"

# %%
p, k, angle = np.array([0.0, 0.0, -1.5]), np.array([2.0, 1.0, 0.5]), 4 * np.pi / 3
u, w = np.linspace(0, 1, 9)[:, None], np.linspace(0, 1, 9)[None, :]
round_it = dx.CircularSweep.about(wave, p, k, angle)
back = dx.CircularSweep.about(wave, p, -k, -angle)
arm = round_it(u, w) - p
holds("(S - p)·k does not depend on w", arm @ k, arm[:, :1] @ k)
holds("|S - p| does not depend on w", (arm**2).sum(-1), (arm[:, :1] ** 2).sum(-1))
holds("axis and angle both turned round: the same surface", round_it(u, w), back(u, w))
reveal(turned_round, "the same, point for point")

# %%
plot.view(round_it, curves={"axis": [p - 0.3 * k, p + 2.3 * k]})

# %% [markdown]
# **Look at the orange lines**: circles, each round a point of the green axis, two thirds of a turn. Nothing asked the axis to be
# $z$, to pass through the origin, or even to lie in the plane of the curve.
#
# Which is why nobody should *test* with the $z$ axis. Here are three mistakes, first about $z$, through the origin, and
# then about our axis:

# %%
right = shipped().find("revolve_axis")
mistakes = {mistake.id: mistake for mistake in right.mistakes}
about_z = {"curve": wave, "point": np.zeros(3), "axis": np.array([0, 0, 1.0]), "angle": 2}
about_ours = {"curve": wave, "point": p, "axis": k, "angle": 2}

for name in ("through_origin", "axis_not_unit", "wrong_sense"):
    wrong = mistakes[name].formula
    z, ours = (np.abs(wrong(u, w, **it) - right(u, w, **it)).max() for it in (about_z, about_ours))
    print(f"{name:15} about z: off by up to {z:5.2f}    about ours: {ours:5.2f}")

# %% [markdown]
# Two of the three are invisible about $z$: the textbook axis is **blind** to them. Here is one of the three about ours. What gives
# it away is what it keeps: its $(S - p)\cdot k$ does not depend on $w$, its $|S - p|$ does. **Which mistake made it?**
#
# * `"through_origin"`: the point $p$ never entered
# * `"axis_not_unit"`: $k$ used with its own length
# * `"wrong_sense"`: the left hand


# %% fold=true
def swept(f):
    """A surface of u and w alone, by somebody's formula."""
    return lambda u, w: f(u, w, **about_ours)


plot.view(swept(mistakes["through_origin"].formula), against=swept(right), names=("right", "wrong"))

# %%
culprit = None  # one of the three names

# %%
reveal(culprit, "through_origin")
print(mistakes["through_origin"].hint)

# %% [markdown]
# A wrong sense would keep both: its circles are the right ones, run the other way. An axis that is not of length 1 keeps neither.
# Turning about a *parallel* line keeps the height along the axis and misses the distance. Two measurements tell, and no model
# answer was needed.
#
# ## 3 · Where the curve meets the axis
#
# A rod from $-1$ to $1$ on the $x$ axis, turned about $z$: it goes through the axis and sweeps a disc, of area $\pi$. How far must
# it turn to cover the disc just once?

# %%
needed = None  # in degrees

# %%
rod = dx.Line((-1, 0, 0), (1, 0, 0))
for degrees in (90, 180, 360):
    disc = dx.CircularSweep(rod, "z", np.radians(degrees))
    print(f"{degrees:3}°: area {disc.area() / np.pi:.2f} π")
reveal(needed, 180)

# %% [markdown]
# The rod has two halves, and each sweeps its own half of the disc. A whole turn covers it twice, as the torus of chapter 1 covered
# the ball at the very end.
#
# Now let the halves differ. The next curve crosses the axis at $u = ½$, and turns by three quarters so that you can look in. The walk
# goes along the curve to that place, then along $w$ from 0 to 1, then on. What does the marker on the surface do while $w$ runs?

# %%
at_the_pole = None  # "goes round a circle", "stands still" or "jumps"

# %%
across = dx.BezierCurve(np.array([(-2, 0, 1.8), (-1, 0, -1.2), (1, 0, 1.6), (2, 0, 0.6)], float))
reveal(at_the_pole, "stands still: its circle has the radius 0")
plot.walk(dx.CircularSweep(across, "z", 1.5 * np.pi), [(0, 0), (0.5, 0), (0.5, 1), (1, 1)])

# %% [markdown]
# **Two things to see.** A whole line of the square has become one point, a **pole**; there $S_w = 0$, and the cross product
# $S_u \times S_w$ gives no normal. And the two sheets pass *through each other*, along parts of a circle: there both halves of the
# curve are equally high at the same distance from the axis.
#
# A plane generatrix that stays on one side of its axis has neither trouble. It may touch the axis with an end: that closes a cap.

# %% [markdown]
# ## 4 · Along any curve
#
# Now let the directrix $D(w)$ be any curve. The least that one can do is to carry $G$ along and never turn it:
#
# $$S(u, w) = G(u) + D(w) - D(0)$$
#
# What counts is how far $D$ has *come*, so $S(u, 0) = G(u)$. And $w$ is the parameter of $D$ now, whatever it measures: at
# $w = ½$ half of the length need not be done.
#
# Let the straight ridges of the roof become arches: the wave is carried along an arch that begins in the same point. Now carry the
# arch along the wave instead. Which surface is that?

# %%
exchanged = None  # "another one", "the same" or "its mirror image"


# %%
def arch(s):
    return points(0, 3 * s, 4 * s * (1 - s))


vault = dx.GenericSweep(wave, arch, frame="fixed")
other = dx.GenericSweep(arch, wave, frame="fixed")
holds("the wave along the arch is the arch along the wave", vault(u, w), other(w, u))
reveal(exchanged, "the same, with u and w exchanged")
plot.view(vault, square=True)

# %% [markdown]
# The formula is a sum, and a sum does not care about the order. Such a surface is called a **translation surface**: *both*
# families of lines consist of one curve and its copies, and there is no telling which of them was the generatrix.
#
# Is that how to hold a hoop? The next one stands across its wire where the wire starts. Then the wire bends upwards, and the hoop
# is not turned. Water flows along the wire: how much of the opening is left for it where the wire has bent by 60°?

# %%
opening = None  # a part of the whole opening, for example 0.9

# %%
bend = dx.Arc((0, 0, 3), 3, -np.pi / 2, 0, normal=(0, -1, 0))
hoop = dx.Circle((0, 0, 0), 1, normal=(1, 0, 0))
squeezed = dx.GenericSweep(hoop, bend, frame="fixed")
flow = bend.tangent(2 / 3)  # 60° of 90°
reveal(opening, f"{np.dot((1, 0, 0), flow):.2f}, the cosine of 60°; at 90° nothing at all")
plot.view(squeezed, curves={"wire": bend})

# %% [markdown]
# ## 5 · A frame that comes with the wire
#
# So the hoop must turn with the wire. Three arrows of length 1, each at right angles to the other two, say how it is held: a
# **frame**. The first is the **tangent** $t$. For the other two J. F. Frenet (1847) and J.-A. Serret (1851) asked the curve where it
# bends to:
#
# $$t = \frac{D'}{|D'|}, \qquad b = \frac{D' \times D''}{|D' \times D''|}, \qquad n = b \times t$$
#
# The **principal normal** $n$ points to the inside of the bend, the **binormal** $b$ across the plane of bending. Before you
# write it: $t$, $n$, $b$ have length 1, and $t \times n = b$. Two lines are missing.


# %%
def frenet(d1, d2):
    """The Frenet frame t, n, b of a curve with the derivatives d1 = D' and d2 = D'', arrays (..., 3)."""
    t = d1 / np.linalg.norm(d1, axis=-1, keepdims=True)
    ### BEGIN SOLUTION
    b = np.cross(d1, d2)
    b = b / np.linalg.norm(b, axis=-1, keepdims=True)
    ### END SOLUTION
    return t, np.cross(b, t), b


# %%
def helix(w, order=0):
    """A helix of radius 2 that climbs 3 in its one turn, or a derivative of it."""
    angle, size = 2 * np.pi * w + order * np.pi / 2, 2 * (2 * np.pi) ** order
    return points(size * np.cos(angle), size * np.sin(angle), (3 * w, 3, 0)[order])


with once_written():
    t, n, b = frenet(helix(w, 1), helix(w, 2))
    holds("t, n and b have length 1", [(t * t).sum(-1), (n * n).sum(-1), (b * b).sum(-1)], 1)
    holds("t × n = b", np.cross(t, n), b)
    holds("n points straight at the axis of the helix", 2 * n[..., :2], -helix(w)[..., :2])
    holds("b keeps its angle with the axis", b[..., 2], b[0, 0, 2])

# %% [markdown]
# With a frame the pipe is one line. Go round the circle in the plane of $n$ and $b$, about the point $D(w)$:
#
# $$S(u, w) = D(w) + r \cos(2\pi u)\, n(w) + r \sin(2\pi u)\, b(w)$$
#
# Without any model answer: every point is $r$ away from $D(w)$, and $(S - D)\cdot t = 0$.


# %%
def pipe(u, w, wire, r):
    """A pipe of radius r round a curve of the library."""
    _, n, b = frenet(wire.derivative(w, 1), wire.derivative(w, 2))
    angle = 2 * np.pi * np.asarray(u)[..., None]
    ### BEGIN SOLUTION
    return wire(w) + r * np.cos(angle) * n + r * np.sin(angle) * b
    ### END SOLUTION


# %%
with once_written():
    arm = pipe(u, w, bend, 1) - bend(w)
    holds("every point is r away from the wire", np.linalg.norm(arm, axis=-1), 1)
    holds("each hoop stands across the wire", (arm * bend.tangent(w)).sum(-1))
    inside = pipe(0, w, bend, 1) - (0, 0, 3)
    holds("the inside of this bend is a circle, of radius 3 - 1", np.linalg.norm(inside, axis=-1), 2)
    holds("a quarter of the way round lies on b, here (0, -1, 0)", pipe(0.25, w, bend, 1) - bend(w), (0, -1, 0))

# %% [markdown]
# ## 6 · A third way, and who can see it
#
# Follow the frame along the helix: it turns with the bend, and it also turns *about the tangent*. How fast, per unit of length, is
# called the **torsion** $\tau$. A plane curve has none.
#
# Nothing obliges the hoop to join in with that. The **rotation-minimising frame** turns with the tangent and never about it (R. L.
# Bishop, *There is more than one way to frame a curve*, 1975). In the library: `frame="minimal"`.
#
# Carry a round hoop along the helix both ways. Which points belong to one pipe and not to the other?

# %%
differ = None  # "nearly all", "some" or "none"

# %%
start = helix(0.0)
ring = dx.Circle(start, 0.7, normal=helix(0.0, 1))
by_frenet = dx.GenericSweep(ring, helix, frame="frenet")
minimal = dx.GenericSweep(ring, helix, frame="minimal")
reveal(differ, "none: as sets of points they are the same pipe")
plot.view(minimal, against=by_frenet, names=("Frenet", "minimal"))

# %% [markdown]
# **The colour** compares point with point of the same $(u, w)$. Dark at the start, brighter all the way: the hoop of one turns in
# itself against the hoop of the other, and slides along in its own circle. The orange lines show it, the shape does not.
#
# *A round section is blind to the frame.* Take the plainest section that is not round: a straight step, from the helix to the
# inside. Three frames, three surfaces, of the same two curves. Only one of them is a spiral staircase. Which?

# %%
staircase = None  # "fixed", "frenet" or "minimal"

# %%
step = dx.Line(start, (0.5, 0, 0))
stairs = {frame: dx.GenericSweep(step, helix, frame) for frame in ("fixed", "frenet", "minimal")}
before = stairs["fixed"].moved(dx.Transform.translate((-5, 0, 0)))
beyond = stairs["minimal"].moved(dx.Transform.translate((5.5, 0, 0)))
reveal(staircase, "frenet, in the middle")
figure = plot.view(stairs["frenet"], also=[before, beyond], title="fixed · Frenet · minimal", lines=4)
figure.update_layout(scene_camera_eye={"x": 0.1, "y": -1.05, "z": 0.65})

# %%
S = stairs["frenet"](u, w)
holds("Frenet: the distance from the axis does not depend on w", np.hypot(S[..., 0], S[..., 1]), 2 - 1.5 * u)
print(f"      and each step is level, to within {np.ptp(S[..., 2], axis=0).max():.0e}")
S = stairs["fixed"](u, w)
holds("fixed: the helix itself, pushed along a line", S, dx.LinearSweep(helix, (-1, 0, 0), 1.5)(w, u))
S = stairs["minimal"](u, w)
falls = np.arcsin((S[0, -1] - S[-1, -1])[2] / 1.5)
print(f"minimal: the last step falls by {np.degrees(falls):.0f}° to the inside")

# %% [markdown]
# **Left** the step never turns: the sum of section 4 again, so it is also the helix, pushed sideways. **Right** the step turns
# with the wire but never about it, and by the end it stands on edge.
#
# **In the middle**, a *helicoid*. A helix is the same everywhere, in its bend and in its torsion, so its Frenet frame turns evenly about
# one axis while it climbs. Whatever you carry along a helix in it is *screwed*: stairs, a thread, a drill.

# %% [markdown]
# ## 7 · Where Frenet's frame breaks
#
# Try it on a straight wire, and on a wire that bends first to one side and then to the other:

# %%
snake = dx.BezierCurve(np.array([(0, 0, 0), (2, 0, 3.5), (3.5, 0, -3), (6, 0, 1)], float))
for wire in (dx.Line((0, 0, 0), (6, 0, 1)), snake):
    try:
        dx.GenericSweep(dx.Circle((0, 0, 0), 0.5, normal=wire.tangent(0)), wire, frame="frenet")
    except dx.DegenerateError as error:
        print("·", error)

# %% [markdown]
# The library refuses, with reason. On a straight piece $D' \times D'' = 0$: there is no inside of the bend, and $n$ is $0/0$. Where
# the bend changes sides, at an **inflection**, the inside is suddenly on the other side.
#
# Your `frenet` does not refuse. By how many degrees does its $n$ jump there, and what becomes of the pipe?

# %%
jump = None  # in degrees

# %%
with once_written():
    fine = np.linspace(0, 1, 1000)
    _, n, _ = frenet(snake.derivative(fine, 1), snake.derivative(fine, 2))
    turns = np.degrees(np.arccos(np.clip((n[1:] * n[:-1]).sum(-1), -1, 1)))
    reveal(jump, f"{turns.max():.0f}, near w = {fine[turns.argmax()]:.2f}")
    display(plot.view(lambda u, w: pipe(u, w, snake, 0.5), samples=33, title="your pipe along the snake"))

# %% [markdown]
# **The pinch.** Each hoop is right, before and after. But the two that meet at the inflection call opposite points by the same
# name, $u$. Whoever joins equal names, as this picture does and every file of triangles, pinches the pipe off.
#
# "My wires have no inflections", somebody says: "they always leave the plane a little." Then nothing jumps. Lift the snake out of
# its plane, by less and less, and watch how much the frame turns about the tangent, and on how short a piece half of that happens.


# %% fold=true
def lifted(h):
    """The snake, a little out of its plane."""
    return dx.BezierCurve(snake.control_points + h * np.array([(0, 1, 0), (0, 0, 0), (0, 0, 0), (0, 1, 0)]))


with once_written():
    fine = np.linspace(0, 1, 20001)
    for h in (1, 0.3, 0.1, 0.03, 0.01):
        d1, d2, d3 = (lifted(h).derivative(fine, order) for order in (1, 2, 3))
        t, n, b = frenet(d1, d2)
        bent = np.cross(d1, d2)
        rate = (bent * d3).sum(-1) / (bent * bent).sum(-1) * np.linalg.norm(d1, axis=-1)  # torsion, per unit of w
        turned = np.degrees(np.concatenate([[0], np.cumsum((rate[1:] + rate[:-1]) / 2 * np.diff(fine))]))
        quarters = np.interp(np.array([0.25, 0.75]) * abs(turned[-1]), np.abs(turned), fine)
        print(f"h = {h:<5} turns by {abs(turned[-1]):5.1f}°, half of it within {np.ptp(quarters):.4f} of the way")

# %% [markdown]
# **The limit is the jump.** The closer the wire is to its plane, the shorter the piece on which the hoop is wrung round by half a
# turn. No check for an inflection can save that: it happens to wires that have none.

# %% [markdown]
# ## 8 · Two mirrors
#
# The minimal frame does not ask where the wire bends to, so it has nothing to lose on a straight piece. It only asks how the hoop was
# held just before. Two points and two tangents are enough to take it one step further: *reflect it in two mirrors* (W. Wang,
# B. Jüttler, D. Zheng, Y. Liu, *Computation of rotation minimizing frames*, ACM Transactions on Graphics 27, 2008).
#
# The mirror across an arrow $a$ is the plane at right angles to it. It sends $a$ to $-a$ and leaves alone whatever lies in that plane.
# What does one mirror make of a right-handed frame?

# %%
in_the_mirror = None  # "a right-handed frame" or "a left-handed one"

# %% [markdown]
# Any arrow $v$ has a part along $a$, namely
#
# $$\frac{v\cdot a}{a\cdot a}\,a$$
#
# The mirror turns that part round. Take it away once and the arrow lies in the mirror; what else? Write the line.


# %%
def mirrored(v, a):
    """The arrow v in the mirror across the arrow a, both (3,)."""
    ### BEGIN SOLUTION
    return v - 2 * (v @ a) / (a @ a) * a
    ### END SOLUTION


# %%
v, a = np.array([1.0, -2, 3]), np.array([2.0, 1, -0.5])
with once_written():
    holds("a goes to -a", mirrored(a, a), -a)
    holds("what is at right angles to a stays", mirrored(np.cross(a, v), a), np.cross(a, v))
    holds("twice is nothing", mirrored(mirrored(v, a), a), v)
    holds("the length stays", np.linalg.norm(mirrored(v, a)), np.linalg.norm(v))
    x, y, z = (mirrored(e, a) for e in np.eye(3))
    reveal(in_the_mirror, "a right-handed frame" if np.cross(x, y) @ z > 0 else "a left-handed one")

# %% [markdown]
# So one mirror will not do, and two will. From the point $x_0$ with tangent $t_0$ to the next one, $x_1$ with $t_1$: the first mirror
# stands half way and exchanges $x_0$ and $x_1$. It sends $t_0$ nearly to $-t_1$; the second mirror sends that to $t_1$.


# %%
def carried(arrow, x, t):
    """An arrow at x[0], carried along the points x (n, 3) with tangents t (n, 3): n arrows."""
    arrows = [arrow]
    for i in range(len(x) - 1):
        first = x[i + 1] - x[i]
        second = t[i + 1] - mirrored(t[i], first)
        arrows.append(mirrored(mirrored(arrows[-1], first), second))
    return np.array(arrows)


# %% [markdown]
# What must come out? On the helix we know it exactly. Frenet's frame turns about the tangent by $\tau$ per unit of length, yours does
# not; so after one turn of length $L$ they differ by the angle $\tau L$. With radius $R = 2$ and a climb of $2\pi c = 3$:
# $\tau = c/(R^2 + c^2)$ and $L = 2\pi\sqrt{R^2 + c^2}$.
#
# The steps are finite, so there is an error. Take twice as many: by what is it divided?

# %%
divided_by = None  # 2, 4, 8 or 16

# %%
c = 3 / (2 * np.pi)
exact = 2 * np.pi * c / np.hypot(2, c)
with once_written():
    before = None
    for steps in (8, 16, 32, 64, 128):
        s = np.linspace(0, 1, steps + 1)
        t, n, b = frenet(helix(s, 1), helix(s, 2))
        end = carried(n[0], helix(s), t)[-1]
        error = abs(np.arctan2(-end @ b[-1], end @ n[-1]) - exact)
        print(f"{steps:3} steps: off by {error:.2e}", f"  {before / error:.1f} times less" if before else "")
        before = error
    reveal(divided_by, 16)

# %% [markdown]
# The error is of *fourth order*, from two mirrors and without a single second derivative. And on the snake, where Frenet's frame
# jumped, or on a straight piece? An arrow straight across their plane should stay as it is:

# %%
with once_written():
    s = np.linspace(0, 1, 65)
    out = np.array([0.0, 1, 0])
    holds("along the snake it stays", carried(out, snake(s), snake.tangent(s)), out + 0 * snake(s))
    straight = dx.Line((0, 0, 0), (6, 0, 1))
    holds("along a line it stays", carried(out, straight(s), straight.tangent(s)), out + 0 * snake(s))

healed = dx.GenericSweep(dx.Circle((0, 0, 0), 0.5, normal=snake.tangent(0)), snake, frame="minimal")
plot.view(healed, title="the same snake, with the minimal frame")

# %% [markdown]
# ## 9 · The way home
#
# Close the wire: a knot. Make a mark on the hoop and carry it once round; it never turns about the wire, not for a moment. Back where
# it started, is the mark where it was?

# %%
mark_is_home = None  # "yes", "nearly" or "no"


# %%
def knot(s):
    """A trefoil knot."""
    one, two, three = (2 * np.pi * i * s for i in (1, 2, 3))
    return points(np.sin(one) + 2 * np.sin(two), np.cos(one) - 2 * np.cos(two), -1.5 * np.sin(three))


wire = dx.FunctionCurve(knot)
s = np.linspace(0, 1, 801)
with once_written():
    mark = np.cross(wire.tangent(0), (0, 0, 1))
    mark = mark / np.linalg.norm(mark)
    home = carried(mark, wire(s), wire.tangent(s))[-1]
    reveal(mark_is_home, f"no: it is off by {np.degrees(np.arccos(home @ mark)):.1f}°")

# %%
closed = dx.GenericSweep(dx.Circle(wire(0), 0.45, normal=wire.tangent(0)), wire, frame="minimal")
plot.view(closed, samples=121, lines=16)

# %% [markdown]
# *Never turned about the wire, and yet turned at home.* That is no error, and finer steps do not make it go away. On a plane wire
# the angle is 0. In space it may be anything: it is the torsion, added up along the whole wire, whole turns left out.
#
# So a pipe that is to close must give in a little, and say so. The library gives the angle back evenly along the way: the pipe
# above does turn about its wire, as little as closing takes.

# %% [markdown]
# ## 10 · The limit: too thick for the bend
#
# Bend a straight pipe of radius $r$ and length $L$. The outside of the bend is stretched, the inside is pressed together, and the two
# make up for each other exactly: the area stays $2\pi r L$.
#
# How long does that go on? Where the wire has the curvature $\kappa$, the pipe is stretched $1 - r\kappa\cos 2\pi u$ times; $u = 0$ is
# the inside. Now take the parabola $z = x^2$ as the wire; it bends most at its vertex. Which is the thickest pipe
# that it bears?

# %%
thickest = None  # a radius

# %%
parabola = dx.BezierCurve(np.array([(-1.5, 0, 2.25), (0, 0, -2.25), (1.5, 0, 2.25)]))
s, around = np.linspace(0, 1, 2001), np.cos(2 * np.pi * np.linspace(0, 1, 720, endpoint=False))
d1, d2 = parabola.derivative(s, 1), parabola.derivative(s, 2)
speed = np.linalg.norm(d1, axis=-1)
kappa = np.linalg.norm(np.cross(d1, d2), axis=-1) / speed**3
for r in (0.2, 0.4, 0.5, 0.6, 1.0):
    stretched = 1 - r * kappa[:, None] * around
    area = 2 * np.pi * r * np.trapezoid(speed * np.abs(stretched).mean(axis=1), s)
    straight = 2 * np.pi * r * parabola.length()
    print(f"r = {r}: area {area:7.3f}   2πrL = {straight:7.3f}   least stretch {stretched.min():5.2f}")
reveal(thickest, f"{1 / kappa.max():.2f}, the radius of curvature at the vertex")


# %%
def thick(u, w):
    return pipe(u, w, parabola, 1.0)


with once_written():
    figure = plot.walk(thick, [(0, 0.1), (0, 0.9)], steps=49, title="r = 1: along the inside of the bend")
    display(figure.update_traces(opacity=0.45, selector={"type": "surface"}))

# %% [markdown]
# **Walk slowly.** In the square the marker goes straight on. On the surface it goes forward, *turns back* through the
# vertex, and goes forward again: where $r\kappa > 1$ the inside runs backwards, and the pipe cuts through itself. At both turning
# points $S_w = 0$. (Counted with its sign, the area would still be $2\pi r L$. What runs backwards would count as less than nothing.)
#
# In chapter 1 the torus did the same below $R = 1$. Now it has a reason: the radius of curvature of its circle is $R$, and its tube
# was thicker. And no frame can help. It is no longer a question of how to hold the hoop.

# %% [markdown]
# ## Where to go from here
#
# A sweep is given by two curves, says the lecture. *Two curves do not say how to hold the hoop.* Not turned at all, turned with the
# bend, or turned as little as possible: three surfaces, and whoever writes "sweep" on a drawing must add which.
#
# Write the sweeps yourself, each checked on many curves: [A2 · Linear sweep](../A2/linear-sweep.ipynb), [A3 · Circular
# sweep](../A3/circular-sweep.ipynb), [A4 · Generic and ruled](../A4/generic-and-ruled.ipynb), where two
# curves may also stand still.
#
# And where do curves like the snake come from? Four points made it, and it met two of them. That is the next chapter:
# [What control points do](03-what-control-points-do.ipynb).
