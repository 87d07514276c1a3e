# %% [markdown]
# # A4 · Generic sweep, mixed form, bilinear and ruled surfaces
#
# **Two curves are given and nothing else. How many different surfaces can you make of them?**
#
# You will write six functions: a curve carried along a curve, a free profile turned, a patch on four corners, the test whether it
# is flat, a patch between two curves, and the lecture's "cylinder is a ruled surface" with a twist. That takes about two hours.
# Predict, look, write, test it yourself, check.

# %% [markdown]
# ## What holds everywhere
#
# * Curves come as functions: `curve(t)` gives points `t.shape + (3,)`. `curve(u)` is a column of points, `curve(w)` a row of
#   them, and the two add up to a surface.
# * First index $u$, second $w$: the corner $p_{01}$ stands at $u = 0$, $w = 1$.
# * Plain numbers come too: write `np.asarray(w)[..., None]` to multiply points by $w$.
#
# Run the next cell first.

# %% setup=true

# %% [markdown]
# ## 1 · A curve carried along a curve
#
# *"Generic sweep"*: the generatrix $G(u)$ moves along *any* directrix $D(w)$, without turning. Here are two curves. The sweep
# should start with the generatrix in its own place. The quickest idea is to add: $G(u) + D(w)$.
#
# Does that sum start in the right place? Where does it put $S(0, 0)$: at `"G(0)"`, at `"D(0)"`, or at neither?

# %%
start = None  # "G(0)", "D(0)" or "neither"


# %%
def arc(t):
    """A generatrix."""
    t = np.asarray(t)
    return np.stack([2 * np.cos(np.pi * t), 1 + t**2, 3 * t * (1 - t)], axis=-1)


def wig(t):
    """A directrix; it does not start in the origin."""
    t = np.asarray(t)
    return np.stack([1 + t, 2 - t**2, 0.5 + np.sin(2 * t)], axis=-1)


reveal(start, "neither: G(0) + D(0) is a third point")
print("G(0) =", arc(0), " D(0) =", wig(0), " their sum is", arc(0) + wig(0))

# %% [markdown]
# What counts is not where the path *is* but how far it has *come*. Say the invariants first: $S(u, 0) = G(u)$; and since nothing
# turns, $S(u, w) - S(0, w)$ is the same for every $w$.
#
# **Task (translational_sweep).** Carry `gen` along `path`, starting in its own place.


# %% solution="translational_sweep"
def translational_sweep(u, w, gen, path):
    """Carry the curve gen along the curve path without turning; w = 0 is gen in its own place.

    u, w : numbers or arrays in [0, 1];  gen, path : functions of t in [0, 1], points (..., 3)
    Returns points, shape of u and w together + (3,).
    """
    ### BEGIN SOLUTION
    return gen(u) + path(w) - path(0.0)
    ### END SOLUTION


# %%
with once_written():
    along = {"directrix": wig}
    display(plot.view(lambda u, w: translational_sweep(u, w, arc, wig), square=True, curves=along))

# %%
u, w = np.linspace(0, 1, 9)[:, None], np.linspace(0, 1, 9)[None, :]
with once_written():
    S = translational_sweep(u, w, arc, wig)
    holds("w = 0 is the generatrix", S[:, 0], arc(u[:, 0]))
    holds("the generatrix only moves: S(u, w) - S(0, w)", S - S[:1], (arc(u) - arc(0)))
    moved = translational_sweep(u, w, arc, lambda t: wig(t) + [5, -7, 9])
    holds("where the path lies does not matter", moved, S)
    line = translational_sweep(u, w, arc, lambda t: np.multiply.outer(t, [2.0, 4.0, 4.0]))
    holds("along a line it is the linear sweep of A2", line, arc(u) + w[..., None] * [2, 4, 4])

# %% check="translational_sweep"
check(translational_sweep)

# %% [markdown]
# ### A circle on a circle
#
# The lecture calls sphere and torus "circle on circle". Carry a small circle that stands in the $xz$-plane along a big circle in
# the $xy$-plane, and stop a quarter of the way round. On a torus with a tube of radius 1 the small circle has turned by then: it
# is 0 wide along $x$ and 2 along $y$. How wide along $x$ is yours?

# %%
wide_along_x = None


# %%
def standing(t):
    return np.stack([3 + np.cos(2 * np.pi * t), 0 * t, np.sin(2 * np.pi * t)], axis=-1)


def lying(t):
    return 3 * np.stack([np.cos(2 * np.pi * t), np.sin(2 * np.pi * t), 0 * t], axis=-1)


with once_written():
    quarter = translational_sweep(np.linspace(0, 1, 41), np.full(41, 0.25), standing, lying)
    reveal(wide_along_x, np.ptp(quarter[:, 0]))
    display(plot.view(lambda u, w: translational_sweep(u, w, standing, lying)))

# %% [markdown]
# **What went wrong?** Nothing in your function: *carrying* is not *turning*. This is a perfectly good generic sweep, and no
# torus. Where the lecture says "circle on circle" for sphere and torus, read "a circle *turned* along a circle", as in A3.

# %% [markdown]
# ## 2 · Free in one direction
#
# The **mixed form**: one direction is known, here a circle, and the other is free. A free profile needs control points
# $P_0, \dots, P_n$, mixed by the Bernstein functions $B_i(t) = \binom{n}{i} t^i (1 - t)^{n - i}$:
#
# $$(\varrho(u), z(u)) = \sum_{i=0}^{n} B_i(u)\, P_i$$
#
# With four control points: through how many of them does the curve pass?

# %%
touched = None


# %%
def bernstein(n, t):
    """B_0 ... B_n at t, shape t.shape + (n + 1,): each degree is mixed from the one before."""
    t = np.asarray(t, float)
    B = [np.ones(t.shape)]
    for _ in range(n):
        B = [(1 - t) * a + t * b for a, b in zip([*B, 0], [0, *B], strict=True)]
    return np.stack(B, axis=-1)


reveal(touched, "2: the first and the last")
profile_points = np.array([[1, 0], [3, 1], [0.5, 2], [1.5, 4]])
rho, z = (bernstein(3, np.linspace(0, 1, 61)) @ profile_points).T
figure = go.Figure().update_layout(height=330, width=420, template="none", showlegend=False)
figure.add_scatter(x=rho, y=z, mode="lines", line={"width": 4, "color": "#0072B2"})
figure.add_scatter(x=profile_points[:, 0], y=profile_points[:, 1], line={"color": "#999"})
figure.update_xaxes(title="ϱ", range=[0, 3.2]).update_yaxes(title="z", scaleanchor="x")

# %% [markdown]
# $\varrho$ is the distance from the axis, $z$ the height. Turned once about $z$ the profile becomes a vase. You have turned
# profiles before: the sphere and the torus in A1, any curve in A3.
#
# **Task (vase).** `P` has shape `(m, 2)` with rows $(\varrho_i, z_i)$; the degree is $m - 1$. $w$ turns the profile once round,
# from $+x$ towards $+y$. You may use `bernstein`.


# %% solution="vase"
def vase(u, w, P):
    """The Bezier profile of the control points P, turned once about z.

    u, w : numbers or arrays in [0, 1];  P : (m, 2), control points (distance from the axis, height)
    Returns points, shape of u and w together + (3,).
    """
    P = np.asarray(P, float)
    ### BEGIN SOLUTION
    rho, z = np.moveaxis(bernstein(len(P) - 1, u) @ P, -1, 0)
    angle = 2 * np.pi * np.asarray(w)
    return np.stack(np.broadcast_arrays(rho * np.cos(angle), rho * np.sin(angle), z), axis=-1)
    ### END SOLUTION


# %%
with once_written():
    polygon = np.stack([profile_points[:, 0], 0 * profile_points[:, 0], profile_points[:, 1]], axis=-1)
    display(plot.view(lambda u, w: vase(u, w, profile_points), curves={"control polygon": polygon}))

# %%
with once_written():
    S = vase(u, w, profile_points)
    holds("it starts at the first point: S(0, 0) = (1, 0, 0)", vase(0, 0, profile_points), (1, 0, 0))
    holds("it ends at the last: S(1, 0) = (1.5, 0, 4)", vase(1, 0, profile_points), (1.5, 0, 4))
    radius = np.hypot(S[..., 0], S[..., 1])
    holds("√(x² + y²) does not depend on w", radius, radius[:, :1])
    x, y, z = np.moveaxis(vase(u, w, [[3, 0], [1, 4]]), -1, 0)
    holds("two points make the frustum of A1: ϱ = 3 - z/2", np.hypot(x, y), 3 - z / 2)

# %% check="vase"
check(vase)

# %% [markdown]
# **What changes?** Move $P_2$ from $(0.5, 2)$ to $(4, 2)$ in `profile_points`: the vase gets a belly. Move the last point to
# $(0, 4)$: a whole edge of the square becomes one point, a pole. Two control points can only make a straight wall; they would
# also hide whether you know the binomial coefficients, since all of theirs are 1.

# %% [markdown]
# ## 3 · Four corners
#
# The least one can say of a patch: its four corners. The simplest formula has a constant, a $u$ term, a $w$ term and a $uw$ term;
# four points, four coefficients. As weights of the corners:
#
# $$(1-u)(1-w), \qquad (1-u)\,w, \qquad u\,(1-w), \qquad u\,w$$
#
# With $p_{00} = (0,0,0)$, $p_{01} = (0,3,1)$, $p_{10} = (4,0,0)$, $p_{11} = (5,4,2)$: what is $S(½, ½)$?

# %%
middle = None  # for example (1, 1, 1)

# %% [markdown]
# **Task (bilinear).** Which weight belongs to which corner? $p_{ij}$ stands at $u = i$, $w = j$, and nothing else about the
# order of the four matters.
#
# The rival convention: other books and file formats walk *round* the patch, or write $w$ first. Never guess corners from a flat
# list of points.


# %% solution="bilinear"
def bilinear(u, w, p00, p01, p10, p11):
    """The bilinear patch on four corners; p_ij is the corner u = i, w = j.

    u, w : numbers or arrays in [0, 1];  p00, p01, p10, p11 : points (3,)
    Returns points, shape of u and w together + (3,).
    """
    p00, p01, p10, p11 = (np.asarray(p, float) for p in (p00, p01, p10, p11))
    u, w = np.asarray(u)[..., None], np.asarray(w)[..., None]
    ### BEGIN SOLUTION
    return (1 - u) * (1 - w) * p00 + (1 - u) * w * p01 + u * (1 - w) * p10 + u * w * p11
    ### END SOLUTION


# %%
corners = p00, p01, p10, p11 = np.array([[0, 0, 0], [0, 3, 1], [4, 0, 0], [5, 4, 2]], float)
with once_written():
    reveal(middle, bilinear(0.5, 0.5, *corners))
    display(plot.view(lambda u, w: bilinear(u, w, *corners), net=corners.reshape(2, 2, 3), square=True))

# %%
with once_written():
    ends = np.array([0, 1])
    S = bilinear(ends[:, None], ends[None, :], *corners)
    holds("corners: S(i, j) = p_ij", S, corners.reshape(2, 2, 3))
    S = bilinear(u, w, *corners)
    holds("straight along u: no second differences", np.diff(S, n=2, axis=0))
    holds("straight along w: no second differences", np.diff(S, n=2, axis=1))
    twist = np.diff(np.diff(S, axis=0), axis=1) * 64
    holds("the uw term is p00 - p01 - p10 + p11", twist, p00 - p01 - p10 + p11)

# %% check="bilinear"
check(bilinear)

# %% [markdown]
# ### A trap: the textbook corners
#
# Two classmates mixed up their corners. They compare with you on a well-known example, the corners $(0,0,1)$, $(1,1,1)$,
# $(1,0,0)$, $(0,1,0)$: the middle point, and the area. Run the cell. Then put `trap = corners` and run it again.


# %%
def area(f, n=60):
    """Area of a surface, added up from small meshes."""
    t = np.linspace(0, 1, n + 1)
    p = f(t[:, None], t[None, :])
    rising, falling = p[1:, 1:] - p[:-1, :-1], p[:-1, 1:] - p[1:, :-1]
    return np.linalg.norm(np.cross(rising, falling), axis=-1).sum() / 2


trap = np.array([[0, 0, 1], [1, 1, 1], [1, 0, 0], [0, 1, 0]], float)
with once_written():
    for name, order in {"you  ": [0, 1, 2, 3], "Asha ": [0, 2, 1, 3], "Bruno": [0, 3, 1, 2]}.items():
        size = area(lambda u, w, p=trap[order]: bilinear(u, w, *p))
        print(f"{name} S(½, ½) = {bilinear(0.5, 0.5, *trap[order])}   area {size:.4f}")

# %% [markdown]
# **What changed?** Those four points are the corners of a *regular tetrahedron*: every two of them are equally far apart, so
# however you mix them up, the same shape comes out, merely turned. And the middle is the mean of all four in any order. With
# generic corners the area gives Bruno away, who walked round the loop: a bow tie. Asha exchanged $u$ and $w$ and still has the same
# surface. Which single point would have told you about her?

# %% [markdown]
# ## 4 · Plane or not?
#
# *"If they are coplanar then you get a plane, if not a curved surface."* The three edges from $p_{00}$ span a box. Its volume
# $(p_{10} - p_{00})\times(p_{01} - p_{00})\cdot(p_{11} - p_{00})$ vanishes exactly when all four points share a plane.
#
# Are $(5.8, 7.7, 5.3)$, $(7.6, 11.2, 7.8)$, $(5.9, 9.7, 2.5)$ and $(6.41, 10.15, 4.09)$ in one plane? (The last is the first plus
# 0.3 of one edge plus 0.7 of the other.)

# %%
coplanar = None  # True or False


# %%
def volume(p00, p01, p10, p11):
    """Volume of the box on the three edges from p00, with its sign."""
    p00, p01, p10, p11 = (np.asarray(p, float) for p in (p00, p01, p10, p11))
    return np.cross(p10 - p00, p01 - p00) @ (p11 - p00)


tenths = (5.8, 7.7, 5.3), (7.6, 11.2, 7.8), (5.9, 9.7, 2.5), (6.41, 10.15, 4.09)
reveal(coplanar, True)
print("volume == 0 says:", volume(*tenths) == 0, "  the volume comes out as", volume(*tenths))

# %% [markdown]
# **What went wrong?** Tenths are not binary numbers; they are rounded before the first sum. So "is 0" must become "is small".
# Small beside what? Give the same corners in millimetres instead of metres: the edges grow by $10^3$, the volume by $10^9$.
#
# **Task (bilinear_is_planar).** `True` if $|\text{volume}| \le 10^{-9}\, s^3$, where $s$ is the longest of the three edges from
# $p_{00}$. Four equal points count as planar. You may use `volume`.


# %% solution="bilinear_is_planar"
def bilinear_is_planar(p00, p01, p10, p11):
    """Whether the bilinear patch of the four corners is planar, up to 1e-9 of the cube of its size.

    p00, p01, p10, p11 : points (3,)
    Returns True or False.
    """
    ### BEGIN SOLUTION
    s = max(np.linalg.norm(np.subtract(p, p00)) for p in (p10, p01, p11))
    return bool(abs(volume(p00, p01, p10, p11)) <= 1e-9 * s**3)
    ### END SOLUTION


# %%
with once_written():
    flat = [(0, 0, 1), (1, 2, 2), (3, 0, 1), (5, 4, 3)]
    print("tilted quadrilateral, wanted True: ", bilinear_is_planar(*flat))
    print("tenths,               wanted True: ", bilinear_is_planar(*tenths))
    print("our corners,          wanted False:", bilinear_is_planar(*corners))
    for scale in (1e-5, 1e6):  # the size and the place must not matter
        moved = scale * (corners + [1, 1, 1])
        print(f"the same, times {scale:g}, wanted False:", bilinear_is_planar(*moved))
    print("one point four times, wanted True: ", bilinear_is_planar(p11, p11, p11, p11))

# %% check="bilinear_is_planar"
check(bilinear_is_planar)

# %% [markdown]
# ## 5 · Two curves and straight lines
#
# A **ruled surface** joins two opposite boundary curves by straight lines:
#
# $$S(u, w) = (1 - w)\,c_0(u) + w\,c_1(u)$$
#
# The lecture asks for two curves and does not say: *which* point of $c_1$ does the line from $c_0(u)$ go to? The formula does: the
# one with the same parameter.
#
# Let $c_1$ stand still in one point for all $u$. Which surface of A1 is that, when $c_0$ is a circle?

# %%
stands_still = None  # "cylinder", "cone", "sphere" or "torus"

# %% [markdown]
# **Task (ruled).** $w = 0$ is $c_0$, $w = 1$ is $c_1$.


# %% solution="ruled"
def ruled(u, w, c0, c1):
    """The ruled surface between two curves: straight lines join points of equal parameter.

    u, w : numbers or arrays in [0, 1];  c0, c1 : functions of t in [0, 1], points (..., 3)
    Returns points, shape of u and w together + (3,).
    """
    ### BEGIN SOLUTION
    w = np.asarray(w)[..., None]
    return (1 - w) * c0(u) + w * c1(u)
    ### END SOLUTION


# %%
def top(t):
    t = np.asarray(t)
    return np.stack([3 * t - 1, np.cos(3 * t), 2 + t], axis=-1)


with once_written():
    S = ruled(u, w, arc, top)
    holds("w = 0 is c0", S[:, 0], arc(u[:, 0]))
    holds("w = 1 is c1", S[:, -1], top(u[:, 0]))
    holds("straight along w: no second differences", np.diff(S, n=2, axis=1))
    lower, upper = (lambda t, a=a, b=b: a + t[..., None] * (b - a) for a, b in ((p00, p10), (p01, p11)))
    holds("two lines: your bilinear", ruled(u, w, lower, upper), bilinear(u, w, *corners))
    reveal(stands_still, "cone")

# %% check="ruled"
check(ruled)

# %% [markdown]
# ### The wrong picture beside the right one
#
# Left your surface between the two curves, right a classmate's. Both have the very same two boundary curves. Which mistake made it?


# %%
def from_a_classmate(u, w):
    return ruled(u, w, arc, lambda t: top(1 - np.asarray(t)))


def mine(u, w):
    return ruled(u, w, arc, top)


with once_written():
    display(plot.view(from_a_classmate, against=mine, names=("yours", "a classmate's")))

# %% [markdown]
# **What to see.** One curve was run backwards, so that each line starts at one end and arrives at the other. As sets of points
# the boundary curves did not change at all. A ruled surface knows more than its two curves: it knows how they *run*.

# %% [markdown]
# ## 6 · "A cylinder is a ruled surface"
#
# So it is: two equal circles, one above the other, joined by straight lines. Now start the upper circle later, by an angle
# *phase*. Every line leans over; how far the surface draws in is told by
#
# $$x^2 + y^2 = r_0^2 (1-w)^2 + r_1^2 w^2 + 2 r_0 r_1 w (1-w) \cos(\text{phase})$$
#
# Take $r_0 = r_1 = 2$ and a phase of 120°, whose cosine is $-½$. What is the radius at half height?

# %%
waist = None

# %% [markdown]
# **Task (ruled_circles).** $c_0$: radius $r_0$, in $z = 0$, starting on $+x$. $c_1$: radius $r_1$, in $z = h$, starting at the
# angle `phase` from $+x$. Both run towards $+y$. You may use your `ruled`.


# %% solution="ruled_circles"
def ruled_circles(u, w, r0, r1, h, phase):
    """The ruled surface between two circles about z, the upper one started later by phase.

    u, w : numbers or arrays in [0, 1];  r0, r1 > 0 : radii;  h > 0 : height;  phase : radians
    Returns points, shape of u and w together + (3,).
    """

    def circle(t, r, z, start):
        angle = 2 * np.pi * np.asarray(t) + start
        return np.stack(np.broadcast_arrays(r * np.cos(angle), r * np.sin(angle), z), axis=-1)

    ### BEGIN SOLUTION
    return ruled(u, w, lambda t: circle(t, r0, 0.0, 0.0), lambda t: circle(t, r1, h, phase))
    ### END SOLUTION


# %%
phase = 2 * np.pi / 3
with once_written():
    reveal(waist, np.hypot(*ruled_circles(0.0, 0.5, 2, 2, 4, phase)[:2]))
    display(plot.view(lambda u, w: ruled_circles(u, w, 2, 2, 4, phase), square=True))

# %%
with once_written():
    x, y, z = np.moveaxis(ruled_circles(u, w, 2, 1.5, 3, phase), -1, 0)
    drawn_in = 4 * (1 - w) ** 2 + 1.5**2 * w**2 + 6 * w * (1 - w) * np.cos(phase)
    holds("x² + y² as above, for every u", x**2 + y**2, drawn_in + 0 * u)
    x, y, z = np.moveaxis(ruled_circles(u, w, 3, 1, 4, 0), -1, 0)
    holds("phase 0 is the frustum of A1: ϱ = 3 - z/2", np.hypot(x, y), 3 - z / 2)
    holds("phase π: all lines meet in one point", ruled_circles(u, 0.5, 2, 2, 4, np.pi), (0, 0, 2))
    one, other = (ruled_circles(0, w, 2, 2, 4, sign * phase) for sign in (1, -1))
    holds("-phase: the mirror image in the xz-plane", one * [1, -1, 1], other)

# %% check="ruled_circles"
check(ruled_circles)

# %% [markdown]
# **What changes?** Go through the phases: 0, 60°, 120°, 180°: a cylinder, two hyperboloids with ever narrower waists, a double
# cone. The last line of the test hides a small miracle: the hyperboloid is its own mirror image, so `phase` and `-phase` give the
# *same* surface, ruled by two families of straight lines. Cooling towers are built that way.

# %% [markdown]
# ### In your own words
#
# A drawing shows two circles of equal size, one above the other, and the words "ruled surface between them".
#
# In three or four sentences: **which surfaces fit this drawing, why do the circles not decide between them, and what would you
# add to the drawing so that only one is left?**
#
# *3 points: one for at least three surfaces that fit; one for the part that the parametrisation plays; one for an addition that
# settles it.*

# %% [markdown] written="which_ruled_surface" points=3
# ### BEGIN SOLUTION
# The cylinder, any hyperboloid of one sheet with a waist narrower than the circles, and the double cone all fit; if the circles
# may run in opposite senses, so do crossed surfaces that cut through themselves.
#
# A ruling joins points of equal parameter. The circles as sets of points say nothing about where u = 0 lies on each or which way u
# runs, so they do not say which points are joined.
#
# It is settled by marking one pair of points that are joined and the sense of both circles, if both are run at constant speed; or
# by giving the phase, or both curves with their parametrisation. Giving the waist radius settles the set of points, but leaves
# the two families of lines.
# ### END SOLUTION

# %% [markdown]
# ## If you want more
#
# * Through every point of a bilinear patch run two straight lines that lie on it. And on the hyperboloid? Put a picture of `phase`
#   and one of `-phase` side by side.
# * Let the generatrix of your generic sweep be a line too. Which surface is that, and when does it degenerate?
# * Bend a strip of paper into each of today's surfaces. Which ones refuse? (A mill that cuts with its flank cares.)
#
# Next: **A5**, where a patch is a table of numbers.
