# %% [markdown]
# # A1 · Known forms
#
# **A drawing says: cylinder, radius 2, height 5, axis z. How many different surfaces is that?**
#
# You will write five short functions: a cylinder, a cone, a sphere, a torus, and one that tells tori apart. That takes about
# two hours. Every part goes the same way: predict, look, write, test it yourself, check. Type each prediction *before* you
# run the cell that shows the answer. Nobody marks a prediction; a wrong one is worth the most.

# %% [markdown]
# ## What holds everywhere
#
# * The parameters $u$ and $w$ lie in $[0, 1]$. They are numbers or arrays that broadcast against each other.
# * A surface function returns points: an array of the shape of $u$ and $w$ together, plus `(3,)` for $x, y, z$.
# * Angles are radians. **One turn is $2\pi$ times the parameter.**
# * A positive turn follows the right-hand rule: thumb along the axis, the fingers show the way. About $z$ that is from $+x$
#   towards $+y$.
# * All lengths have one unit; think of millimetres.
#
# Run the next cell first. It loads numpy, plotly, `plot` and `check`, and three small helpers (unfold it if you are curious).

# %% setup=true

# %% [markdown]
# ## 1 · Is a parameter an angle?
#
# One parameter makes a curve. As $u$ runs from 0 to 1, a point shall run once round a circle of radius 2. A first attempt:
#
# $$C(u) = (2\cos u,\; 2\sin u,\; 0)$$
#
# How much of the circle does it draw? Type your guess in per cent.

# %%
share = None  # per cent of the circle, for example 50


# %%
def circle(u):
    return np.stack([2 * np.cos(u), 2 * np.sin(u), np.zeros(np.shape(u))], axis=-1)


turn = np.linspace(0, 2 * np.pi, 97)
whole = np.stack([2 * np.cos(turn), 2 * np.sin(turn), 0 * turn], axis=-1)

reveal(share, 100 / (2 * np.pi), "%")
plot.view(circle, curves={"the whole circle": whole})

# %% [markdown]
# **What went wrong?** $u$ stops at 1, and one radian is less than a sixth of a turn. Put `2 * np.pi * u` in place of `u`, both
# times, and run the cell again: now it closes. Where on the circle is $u = 1/4$?

# %% [markdown]
# ## 2 · What do two parameters make?
#
# A surface: every pair $(u, w)$ of the unit square becomes one point. Here is the smallest surface function there is, a flat
# strip. Give it a column of five $u$ and a row of four $w$, that is `u` of shape `(5, 1)` and `w` of shape `(1, 4)`. What
# shape does its answer have?

# %%
shape = None  # for example (9, 3)


# %%
def strip(u, w):
    """A flat strip, 3 long (along u) and 1 wide (along w)."""
    u, w = np.broadcast_arrays(u, w)
    return np.stack([3 * u, w, np.zeros(u.shape)], axis=-1)


column, row = np.linspace(0, 1, 5)[:, None], np.linspace(0, 1, 4)[None, :]
reveal(shape, strip(column, row).shape)
plot.view(strip, square=True)

# %% [markdown]
# **What to see.** Right the square of all $(u, w)$, left what becomes of it. The blue lines run along $u$ (and $w$ stands
# still), the orange ones along $w$. Turn the picture with the mouse; hold it over the surface to read $(u, w)$.
#
# `broadcast_arrays` gives $u$ and $w$ their common shape, so one function serves single numbers, lists of points and whole
# meshes. `np.stack(..., axis=-1)` puts $x, y, z$ last. Every function of this notebook may follow this pattern.

# %% [markdown]
# ## 3 · The cylinder
#
# Keep the circle, and let the second parameter lift it: $u$ runs once round, $w$ runs up. Before any formula, say what must be
# true of every point: $x^2 + y^2 = r^2$, and $z$ has nothing to do with $u$.
#
# For $r = 2$ and $h = 5$: which point is $S(0.75,\ 0.4)$? Work it out in your head.

# %%
point = None  # for example (1, 0, 2.5)

# %% [markdown]
# **Task (cylinder).** Axis $z$, radius $r$; the edge $w = 0$ lies in $z = 0$, the edge $w = 1$ in $z = h$; $u$ runs once
# round from $+x$ towards $+y$. Replace the last two lines of the stub.
#
# In the lecture the third line of this form is read out wrongly at first and then put right: it is $z = h\,w$.


# %% solution="cylinder"
def cylinder(u, w, r, h):
    """The cylinder of radius r about the z axis, from z = 0 (w = 0) to z = h (w = 1).

    u, w : numbers or arrays in [0, 1];  r > 0 : radius;  h : z of the far end, may be negative
    Returns points, shape of u and w together + (3,).
    """
    u, w = np.broadcast_arrays(u, w)
    ### BEGIN SOLUTION
    angle = 2 * np.pi * u
    return np.stack([r * np.cos(angle), r * np.sin(angle), h * w], axis=-1)
    ### END SOLUTION


# %%
with once_written():
    reveal(point, cylinder(0.75, 0.4, r=2, h=5))
    display(plot.view(lambda u, w: cylinder(u, w, r=2, h=5), square=True, mark=(0.75, 0.4)))

# %% [markdown]
# **Test it yourself.** A formula that must hold needs no model answer. `np.moveaxis` takes $x, y, z$ apart; `holds` compares two
# sides and prints `yes`, or how far apart they are. Change $r$ and $h$; try a negative $h$.

# %%
u, w = np.linspace(0, 1, 9)[:, None], np.linspace(0, 1, 9)[None, :]
with once_written():
    r, h = 2, 5
    x, y, z = np.moveaxis(cylinder(u, w, r, h), -1, 0)
    holds("x² + y² = r²", x**2 + y**2, r**2)
    holds("z does not depend on u", z, z[0])
    holds("it closes: S(0, w) = S(1, w)", cylinder(0, w, r, h), cylinder(1, w, r, h))
    holds("S(1/4, 1) = (0, r, h)", cylinder(0.25, 1, r, h), (0, r, h))

# %% check="cylinder"
check(cylinder)

# %% [markdown]
# **So how many surfaces was that?** "Radius 2, height 5, axis z" does not say *where* on the axis. $h = -5$ fits those words,
# and so does a cylinder from $-2.5$ to $2.5$: infinitely many. A formula cannot be that vague. It also fixes what no drawing
# shows: where $u$ begins, which way it runs, and which parameter is which.

# %% [markdown]
# ## 4 · The cone, whole or cut
#
# Let the radius change on the way up: $r_1$ at $w = 0$, $r_2$ at $w = 1$, in a straight line between. The invariant: the
# distance from the axis, $\varrho = \sqrt{x^2 + y^2}$, depends on $z$ alone, and linearly.
#
# With $r_1 = 3$, $r_2 = 1$, $h = 4$: what is $\varrho$ a quarter of the way up?

# %%
rho = None  # for example 2

# %% [markdown]
# **Task (frustum).** The circle of radius $r_1$ lies in $z = 0$, that of radius $r_2$ in $z = h$; $u$ as before. Mind the
# height: here $h$ is measured *along the axis*. Many drawings give the slant length instead, $\sqrt{h^2 + (r_1 - r_2)^2}$.


# %% solution="frustum"
def frustum(u, w, r1, r2, h):
    """The frustum about z between the circle r1 in z = 0 (w = 0) and the circle r2 in z = h (w = 1).

    u, w : numbers or arrays in [0, 1];  r1, r2 >= 0 : radii, not both 0;  h > 0 : height along the axis
    Returns points, shape of u and w together + (3,).
    """
    u, w = np.broadcast_arrays(u, w)
    ### BEGIN SOLUTION
    angle = 2 * np.pi * u
    rho = r1 + (r2 - r1) * w
    return np.stack([rho * np.cos(angle), rho * np.sin(angle), h * w], axis=-1)
    ### END SOLUTION


# %%
with once_written():
    reveal(rho, np.linalg.norm(frustum(0, 0.25, 3, 1, 4)[:2]))
    display(plot.view(lambda u, w: frustum(u, w, r1=3, r2=1, h=4)))

# %% [markdown]
# **What changes?** Set `r2=0` above. The whole edge $w = 1$ becomes one point, the apex, whatever $u$ is.
# There $\partial S/\partial u = 0$, and no tangent plane exists.

# %%
with once_written():
    x, y, z = np.moveaxis(frustum(u, w, 3, 1, 4), -1, 0)
    holds("ϱ = 3 - z/2: linear in z", np.hypot(x, y), 3 - z / 2)
    holds("r1 = r2 gives the cylinder", frustum(u, w, 2, 2, 5), cylinder(u, w, 2, 5))

# %% check="frustum"
check(frustum)

# %% [markdown]
# ### A trap: data that cannot see
#
# A classmate wrote the frustum below, tried it on $r_1 = r_2 = 1$, compared it with yours, and went to bed. Run the cell. Then
# change the two radii to 3 and 1 in `radii`, and run it again.


# %%
def from_a_classmate(u, w, r1, r2, h):
    u, w = np.broadcast_arrays(u, w)
    rho = r2 + (r1 - r2) * w
    return np.stack([rho * np.cos(2 * np.pi * u), rho * np.sin(2 * np.pi * u), h * w], axis=-1)


radii = (1, 1)
with once_written():
    holds(f"radii {radii}: both agree", from_a_classmate(u, w, *radii, h=2), frustum(u, w, *radii, h=2))

# %% [markdown]
# **Which mistake was it?** Equal radii are *blind* to it, and so are all cylinders. Ones, zeros, squares, equal lengths: the
# inputs one tries first hide the most. A good test uses numbers that nothing else could be mistaken for, such as 3, 1 and 4.
# The check does the same: it always judges on several sets of data.

# %% [markdown]
# ## 5 · The sphere
#
# *Take a semicircle and sweep it 360 degrees.* The curve that is swept is the **generatrix**; the one that guides it, here a
# circle about $z$, is the **directrix**. Our semicircle lies in the $xz$-plane on the side $x \ge 0$, and $u$ runs from the
# south pole to the north pole:
#
# $$\varphi = \pi\,(u - \tfrac12), \qquad C(u) = (r\cos\varphi,\; 0,\; r\sin\varphi)$$
#
# How far from the axis is the point $u = 0.75$, for $r = 2$?

# %%
distance = None  # for example 1.5


# %%
def semicircle(u, r=2):
    phi = np.pi * (u - 0.5)
    return np.stack([r * np.cos(phi), np.zeros(np.shape(u)), r * np.sin(phi)], axis=-1)


reveal(distance, semicircle(0.75)[0])
plot.view(semicircle)

# %% [markdown]
# **Task (sphere).** Turn that semicircle about $z$, from $+x$ towards $+y$; $w$ is the share of the turn. Each of its points
# runs round a circle of its own: how wide is it?
#
# The rival convention: physicists measure the angle from the *north* pole, and write $\sin$ where we write $\cos$. Do not mix.


# %% solution="sphere"
def sphere(u, w, r):
    """The sphere of radius r about the origin, a semicircle turned about z.

    u, w : numbers or arrays in [0, 1]; u from south pole to north pole, w once round from +x to +y
    r > 0 : radius
    Returns points, shape of u and w together + (3,).
    """
    u, w = np.broadcast_arrays(u, w)
    phi = np.pi * (u - 0.5)
    ### BEGIN SOLUTION
    theta = 2 * np.pi * w
    rho = r * np.cos(phi)
    return np.stack([rho * np.cos(theta), rho * np.sin(theta), r * np.sin(phi)], axis=-1)
    ### END SOLUTION


# %%
with once_written():
    display(plot.view(lambda u, w: sphere(u, w, r=2)))

# %%
with once_written():
    holds("|S| = r", np.linalg.norm(sphere(u, w, 2), axis=-1), 2)
    holds("the south pole is one point: S(0, w) = (0, 0, -r)", sphere(0, w, 2), (0, 0, -2))
    holds("w = 0 is the semicircle", sphere(u, 0, 2), semicircle(u))

# %% check="sphere"
check(sphere)

# %% [markdown]
# ### Covered once, or twice?
#
# Sweep the *whole* circle a whole turn, with $\varphi = 2\pi u$. The picture looks the same. Does anything tell the two apart?
# The next cell adds up its area, mesh by flat mesh. For $r = 2$ a sphere has $16\pi \approx 50.27$; flat meshes fall a little short.
# What will the whole circle give?

# %%
area_of_two_passes = None


# %%
def area(f, n=60):
    t = np.linspace(0, 1, n + 1)
    p = f(t[:, None], t[None, :])
    rising, falling = p[1:, 1:] - p[:-1, :-1], p[:-1, 1:] - p[1:, :-1]  # the diagonals of each mesh
    return np.linalg.norm(np.cross(rising, falling), axis=-1).sum() / 2


with once_written():
    print(f"the semicircle swept:    {area(lambda u, w: sphere(u, w, 2)):.2f}")
    # u -> 2u - 1/2 stretches the semicircle to the whole circle
    reveal(area_of_two_passes, round(area(lambda u, w: sphere(2 * u - 0.5, w, 2)), 2))

# %% [markdown]
# **What to keep.** A set of points is not yet a surface: how often it is covered belongs to the map. A milling cutter that
# follows the second one goes over every spot twice.

# %% [markdown]
# ## 6 · The torus
#
# A circle on a circle again; only place and radii differ from the sphere. The tube's circle has radius $r$ and its centre at
# distance $R$ from the axis. The quickest idea is to *carry* it along the big circle, that is, to add the two:
#
# $$(R\cos\theta + r\cos\varphi,\;\; R\sin\theta,\;\; r\sin\varphi)$$
#
# Is that a torus? Type `"yes"` or `"no"`.

# %%
torus_so = None


# %%
def carried(u, w, R=3, r=1):
    phi, theta = np.broadcast_arrays(2 * np.pi * u, 2 * np.pi * w)
    return np.stack([R * np.cos(theta) + r * np.cos(phi), R * np.sin(theta), r * np.sin(phi)], axis=-1)


reveal(torus_so, "no: at θ = π/2 the plane through the axis cuts it in a line, not in a circle")
plot.view(carried)

# %% [markdown]
# **What went wrong?** Follow one orange line: the tube's circle keeps facing the same way, so it slides edge-on where the big
# circle turns. "Circle on circle" has to mean *turning*: the small circle must stay in a plane through the axis. The invariant
# says it: in every such plane the section is a circle of radius $r$,
#
# $$\left(\sqrt{x^2 + y^2} - R\right)^2 + z^2 = r^2 \qquad (R \ge r).$$

# %% [markdown]
# **Task (torus).** The small circle starts in the $xz$-plane, centre $(R, 0, 0)$; $u$ runs round it from its *outermost* point
# upwards. $w$ turns it about $z$, from $+x$ towards $+y$. $R$ is measured to the centre of the tube, not to the outside.


# %% solution="torus"
def torus(u, w, R, r):
    """The torus about z, a circle turned about a line beside it.

    u, w : numbers or arrays in [0, 1]; u round the tube, from outermost upwards, w from +x to +y
    R >= 0 : axis to the centre of the tube;  r > 0 : radius of the tube
    Returns points, shape of u and w together + (3,).
    """
    u, w = np.broadcast_arrays(u, w)
    ### BEGIN SOLUTION
    phi, theta = 2 * np.pi * u, 2 * np.pi * w
    rho = R + r * np.cos(phi)
    return np.stack([rho * np.cos(theta), rho * np.sin(theta), r * np.sin(phi)], axis=-1)
    ### END SOLUTION


# %%
with once_written():
    display(plot.view(lambda u, w: torus(u, w, R=3, r=1)))

# %%
with once_written():
    x, y, z = np.moveaxis(torus(u, w, 3, 1), -1, 0)
    holds("(√(x² + y²) - R)² + z² = r²", (np.hypot(x, y) - 3) ** 2 + z**2, 1)
    holds("it starts outermost: S(0, 0) = (R + r, 0, 0)", torus(0, 0, 3, 1), (4, 0, 0))
    holds("then upwards: S(1/4, 0) = (R, 0, r)", torus(0.25, 0, 3, 1), (3, 0, 1))
    around = area(lambda u, w: torus(u, w, 3, 1))
    print(f"area {around:.2f}; Pappus says 4π²Rr = {4 * np.pi**2 * 3:.2f}")

# %% check="torus"
check(torus)

# %% [markdown]
# ## 7 · When is a torus a sphere?
#
# Somebody asked that in the lecture. Keep $r = 1$ and let $R$ shrink: 3, 1, ½, 0. There are four names: **sphere**,
# **spindle** (the tube cuts through itself), **ring** (a hole in the middle) and **horn**.
#
# Which name belongs to $R = r$? The next cell draws the section of each by the $xz$-plane, the axis dashed.

# %%
equal_radii = None  # "sphere", "spindle", "ring" or "horn"

# %% fold=true
reveal(equal_radii, "horn: the hole has just closed to a point")

turn = np.linspace(0, 2 * np.pi, 181)
tori = {"ring": (0, 3), "horn": (10.5, 1), "spindle": (17, 0.5), "sphere": (22.5, 0)}
dashed = {"color": "#888", "dash": "dash", "width": 1}
drawn = []
for name, (place, R) in tori.items():
    drawn.append({"mode": "lines", "x": [place] * 2, "y": [-1.6, 1.6], "line": dashed})
    for side, colour in ((1, "#0072B2"), (-1, "#D55E00")):
        x = place + side * (R + np.cos(turn))
        drawn.append({"mode": "lines", "x": x, "y": np.sin(turn), "line": {"color": colour, "width": 3}})
    drawn.append({"mode": "text", "x": [place], "y": [2.3], "text": [f"<b>{name}</b>, R = {R}"], "hoverinfo": "skip"})
across = {"visible": False, "range": [-4.5, 24.5]}
upwards = {"visible": False, "range": [-1.8, 2.8], "scaleanchor": "x"}
frame = {"height": 200, "template": "none", "showlegend": False, "margin": {"l": 5, "r": 5, "t": 5, "b": 5}}
go.Figure(drawn, {**frame, "xaxis": across, "yaxis": upwards})

# %% [markdown]
# **Task (torus_class).** Return the name as a string. Where there is no torus at all, for $R < 0$ or $r \le 0$, raise a
# `ValueError` that says so.


# %% solution="torus_class"
def torus_class(R, r):
    """What torus(u, w, R, r) is: 'ring', 'horn', 'spindle' or 'sphere'.

    Raises ValueError for R < 0 or r <= 0: then there is no torus.
    """
    ### BEGIN SOLUTION
    if R < 0 or r <= 0:
        raise ValueError(f"a torus needs R >= 0 and r > 0; got R = {R}, r = {r}")
    if R == 0:
        return "sphere"
    if r == R:
        return "horn"
    return "ring" if r < R else "spindle"
    ### END SOLUTION


# %%
with once_written():
    print([torus_class(R, 1) for R in (3, 1, 0.5, 0)])
    for R in (3, 1, 0.5, 0):  # a sphere about the origin has one value of |S| only
        size = np.linalg.norm(torus(u, w, R, 1), axis=-1)
        print(f"R = {R}: |S| from {size.min():.3f} to {size.max():.3f}")

# %% check="torus_class"
check(torus_class)

# %% [markdown]
# ### In your own words
#
# The answer given in the lecture was: the torus becomes a sphere when both circles have *the same radius* and a common centre.
# You have just seen that $R = r$ gives a horn. Yet the sentence can be saved.
#
# In three or four sentences: **which circle of the torus must "the directrix" mean for the sentence to be right, which one makes
# it wrong, and how often is the sphere covered?**
#
# *3 points: one for the circle that makes it right, with the reason; one for the circle that makes it wrong, with what comes out
# then; one for the covering, with the reason.*

# %% [markdown] written="torus_or_sphere" points=3
# ### BEGIN SOLUTION
# Right, if the directrix is the circle that the *outermost* point of the tube runs along: its radius is R + r, and R + r = r
# means R = 0, so both circles are centred in the origin.
#
# Wrong, if it is the circle of the tube's *centre*, the usual R: R = r alone gives a horn torus, which touches itself in the
# origin and has no common centre.
#
# For R = 0 a whole circle turns a whole turn about its own diameter, so each point of the sphere is met twice: the area
# integral gives 8πr².
# ### END SOLUTION

# %% [markdown]
# ## If you want more
#
# * Draw `torus(u, w, R=0.5, r=1)`, the spindle. Which part of the square makes the inner skin?
# * Turn the cylinder inside out: $S(1-u, w)$. Same points, other normal. Which other exchanges of $u$, $w$, $1-u$, $1-w$ flip it?
# * $u$ goes round the cylinder, but *along* the generatrix of the sphere. Write the cylinder as a line that is turned, and see
#   $u$ and $w$ change places. That is where A3 begins.
#
# Next: **A2**, where any curve at all is swept along a straight line.
