# %% [markdown]
# # A9 · Further
#
# **How can you tell that a surface is right, when nobody lays the right one beside it?**
#
# Eight notebooks followed the lecture. This one goes on where the lecture points to something and stops: sixteen tasks, and with
# the last of them you write the judge yourself.
#
# **Each task stands alone.** None needs the function of another, and marks are given task by task and added up: what you leave out
# costs its own points and no more. Predict, look, write, test it yourself, check.

# %% [markdown]
# ## Four evenings
#
# | about two hours | chapters | tasks |
# |---|---|---|
# | first | I Implicit surfaces · II Sweeps that turn and climb | 1 to 5 |
# | second | III Nets: cut, raise, convert | 6 to 9 |
# | third | IV Boundaries | 10 to 13 |
# | fourth | V Solids and inspection · VI Be the judge yourself | 14 to 16 |
#
# If you have one evening only, take the fourth. It is what stays when the formulas are forgotten.

# %% [markdown]
# ## What holds everywhere
#
# * $u$ and $w$ lie in $[0, 1]$, numbers or arrays that broadcast; first index $u$, always.
# * $c_0, c_1$ are the edges $w = 0, 1$ and run along $u$; $d_0, d_1$ are the edges $u = 0, 1$ and run along $w$.
# * Angles in radians, turned by the right-hand rule. Weights are called $h$.
# * Between numbers that were computed, "is 0" means "is small beside what they were computed from".
#
# Run the next four cells first, on every evening. Two hold tools that you wrote in A4 to A6, ready made; the fourth a net.

# %% setup=true

# %%
def point(x, y, z):
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


def mix(t, a, b):
    """(1 - t) a + t b, for parameters t of any shape and points (..., 3)."""
    t = np.asarray(t, float)[..., None]
    return (1 - t) * a + t * b


def bernstein(n, t):
    """B_0 ... B_n at t, shape t.shape + (n + 1,)."""
    t = np.asarray(t, float)
    B = [np.ones(t.shape)]
    for _ in range(n):
        B = [(1 - t) * a + t * b for a, b in zip([*B, 0], [0, *B], strict=True)]
    return np.stack(B, axis=-1)


# %%
def bezier(t, P):
    """The Bezier curve of the points P (m, ...)."""
    return np.tensordot(bernstein(len(P) - 1, t), P, axes=1)


def bezier_patch(u, w, P):
    """The Bezier patch of the net P (m, n, 3)."""
    m, n, _ = P.shape
    return np.einsum("...i,...j,ijk->...k", bernstein(m - 1, u), bernstein(n - 1, w), P)


# %%
NET = np.array([
    [[-2, 2, 2], [1, 2, -2], [-2, 7, 2], [-1, 14, -2]],
    [[1, 0, -2], [5, 3, 0], [1, 9, 1], [3, 11, 0]],
    [[5, 0, 0], [4, 4, 2], [8, 6, -2], [5, 13, -1]],
    [[7, 1, 1], [11, 3, -2], [8, 9, -1], [7, 11, 2]],
], float)  # fmt: skip
u, w, t = np.linspace(0, 1, 9)[:, None], np.linspace(0, 1, 9)[None, :], np.linspace(0, 1, 9)
PLAIN = {"template": "none", "margin": {"t": 20, "b": 40, "l": 60, "r": 20}}  # for plane pictures

# %% [markdown]
# # I · Implicit surfaces
#
# ## 1 · A surface without parameters
#
# The lecture's first sphere had no $u$ and no $w$: $x^2 + y^2 + z^2 - r^2 = 0$. Put a point in and look at what comes out: zero on
# the sphere, negative inside, positive outside.
#
# Any equation of second degree will do. Begin with one unusual term: $x^2 + D\,xy + y^2 = 3$. For $D = 0$ it is a circle, and in
# space, where $z$ is free, a cylinder. For $D = 1$ it is an ellipse that lies aslant.
#
# And for $D = 2$? (Its left side is the square of something.)

# %%
with_two = None  # "an ellipse", "a hyperbola", "two lines", "a parabola"

# %%
angle = np.linspace(0, 2 * np.pi, 721)
figure = go.Figure().update_layout(height=380, **PLAIN)
for D, colour in ((0, "#0072B2"), (1, "#009E73"), (2, "#D55E00"), (3, "#8A6FB0")):
    below = 1 + D * np.cos(angle) * np.sin(angle)  # r² times this is 3
    r = np.sqrt(3 / np.where(below > 0.01, below, np.nan))
    x, y, line = r * np.cos(angle), r * np.sin(angle), {"color": colour, "width": 3}
    figure.add_scatter(x=x, y=y, name=f"D = {D}", mode="lines", line=line)
figure.update_xaxes(title="x", range=[-6, 6]).update_yaxes(title="y", range=[-4, 4], scaleanchor="x")
reveal(with_two, "two lines: (x + y)² = 3")
figure

# %% [markdown]
# ### A trap: points on the axes
#
# All four curves pass through the same four points, $(\pm\sqrt 3, 0)$ and $(0, \pm\sqrt 3)$. Of course: on the axes $xy = 0$. Whoever
# tries a formula on points of the axes only, the first that come to mind, cannot see $D$, nor $E$ and $F$ below; all three could be
# missing altogether. The point $(1, 1)$ tells: there the left side is $2 + D$.

# %% [markdown]
# The whole family, ten coefficients from $A$ to $K$ (there is no $I$):
#
# $$A x^2 + B y^2 + C z^2 + D\,xy + E\,yz + F\,zx + G x + H y + J z + K$$
#
# It is $h^T Q\, h$ with $h = (x, y, z, 1)$ and a symmetric matrix $Q$. $D$ appears twice in $Q$, for $xy$ and for $yx$. So what
# stands there is not $D$.
#
# **Task (quadric_value).** The value at each point, either way: term by term or by $Q$.
#
# The rival convention: Mortenson prints $2D\,xy + 2E\,yz + \dots$; his $D$ is half of ours.


# %% solution="quadric_value"
def quadric_value(coeffs, X):
    """A x² + B y² + C z² + D xy + E yz + F zx + G x + H y + J z + K at points.

    coeffs : the ten numbers A, B, C, D, E, F, G, H, J, K
    X : points (..., 3)
    Returns numbers, shape of X without its last axis.
    """
    A, B, C, D, E, F, G, H, J, K = coeffs
    x, y, z = np.moveaxis(np.asarray(X, float), -1, 0)
    ### BEGIN SOLUTION
    squares = A * x**2 + B * y**2 + C * z**2
    return squares + D * x * y + E * y * z + F * z * x + G * x + H * y + J * z + K
    ### END SOLUTION


# %%
sphere_of_3 = [1, 1, 1, 0, 0, 0, 0, 0, 0, -9]
aslant = [1, 1, 0, 1, 0, 0, 0, 0, 0, -3]
with once_written():
    holds("(1, 2, 2) is on the sphere of radius 3", quadric_value(sphere_of_3, (1, 2, 2)), 0)
    holds("(1, 2, 3) is outside: 14 - 9", quadric_value(sphere_of_3, (1, 2, 3)), 5)
    two = quadric_value(aslant, [(1, 1, 7), (1, -1, 7)])
    holds("(1, 1, 7) is on D = 1, and (1, -1, 7) inside", two, (0, -2))
    # 1 + 2·4 + 3·9 + 4·2 + 5·6 + 6·3 + 7 + 8·2 + 9·3 + 10, by hand
    holds("A to K = 1 to 10 at (1, 2, 3)", quadric_value(range(1, 11), (1, 2, 3)), 152)
    print("values at 2 x 5 points:", np.shape(quadric_value(aslant, np.ones((2, 5, 3)))))

# %% check="quadric_value"
check(quadric_value)

# %% [markdown]
# ## 2 · Which surface is it?
#
# The lecture lists what an equation of second degree may be: cylinder, cone, ellipsoid, paraboloid, hyperboloid, and the family
# that has degenerated: two planes, a line, a point. One number may decide. In
#
# $$x^2 + y^2 - z^2 = c$$
#
# there are three kinds of surface, for $c > 0$, $c = 0$ and $c < 0$. One of the three falls into two pieces, because no point of
# the plane $z = 0$ can be on it. Which $c$ is it: $1$, $0$ or $-1$?

# %%
two_pieces = None  # 1, 0 or -1


# %%
def half(c, sheet=1):
    """Half of one sheet of x² + y² - z² = c, its cut turned towards the reader."""

    def surface(u, w):
        z = mix(u, -2.0, 2.0)[..., 0] if c >= 0 else sheet * np.sqrt(1 + 4 * np.square(u))
        rho = np.sqrt(z**2 + c)
        return point(rho * np.cos(np.pi * w), rho * np.sin(np.pi * w), z)

    return surface


reveal(two_pieces, -1)
plot.view(half(1), also=[half(0), half(-1), half(-1, sheet=-1)], lines=4)

# %% [markdown]
# **What to see.** From outside to inside: the hyperboloid of one sheet ($c = 1$), the cone ($c = 0$), the hyperboloid of two sheets
# ($c = -1$), cut open. One function, three of its levels.
#
# The squares alone do not tell. $z = xy$ has none at all and is a hyperbolic paraboloid; turn a cylinder, and all ten numbers change.
# What no motion changes are the *signs of the eigenvalues* of two matrices: of $Q$, and of its upper left $3 \times 3$ block $M$.
#
# $$Q = \begin{bmatrix} A & D/2 & F/2 & G/2 \\ D/2 & B & E/2 & H/2 \\ F/2 & E/2 & C & J/2 \\ G/2 & H/2 & J/2 & K \end{bmatrix}$$

# %%
KINDS = {  # signs of the eigenvalues of M, and of Q; zeros are left out
    ("+++", "+++-"): "ellipsoid", ("+++", "+++"): "point", ("+++", "++++"): "empty",
    ("++-", "++--"): "hyperboloid of one sheet", ("++-", "+++-"): "hyperboloid of two sheets",
    ("++-", "++-"): "cone",
    ("++", "+++-"): "elliptic paraboloid", ("+-", "++--"): "hyperbolic paraboloid",
    ("++", "++-"): "elliptic cylinder", ("++", "++"): "line", ("++", "+++"): "empty",
    ("+-", "++-"): "hyperbolic cylinder", ("+-", "+-"): "intersecting planes",
    ("+", "++-"): "parabolic cylinder", ("+", "+-"): "parallel planes",
    ("+", "+"): "coincident planes", ("+", "++"): "empty",
    ("", "+-"): "coincident planes", ("", "+"): "empty", ("", ""): "everything",
}  # fmt: skip

# %% [markdown]
# **Task (quadric_class).** Find the signs and look them up. Two things to mind. $-Q$ is the same surface: a pair that the table does not
# have, it has for $-Q$. And eigenvalues are rounded: below $10^{-9}$ of the largest coefficient they count as 0.
#
# `np.linalg.eigvalsh` gives the eigenvalues of a symmetric matrix, rising; the keys of the table begin with the plus signs.


# %% solution="quadric_class"
def quadric_class(coeffs):
    """The kind of the quadric with these coefficients, one of the words of KINDS.

    coeffs : the ten numbers A, B, C, D, E, F, G, H, J, K
    """
    A, B, C, D, E, F, G, H, J, K = np.asarray(coeffs, float)
    Q = np.array([[2 * A, D, F, G], [D, 2 * B, E, H], [F, E, 2 * C, J], [G, H, J, 2 * K]]) / 2
    M = Q[:3, :3]
    ### BEGIN SOLUTION
    small = 1e-9 * np.abs(coeffs).max()

    def signs(S):
        values = np.linalg.eigvalsh(S)
        return "+" * int((values > small).sum()) + "-" * int((values < -small).sum())

    key = signs(M), signs(Q)
    return KINDS[key] if key in KINDS else KINDS[signs(-M), signs(-Q)]
    ### END SOLUTION


# %%
with once_written():
    print("x² + y² + z² = 9, wanted ellipsoid:", quadric_class([1, 1, 1, 0, 0, 0, 0, 0, 0, -9]))
    print("the same times -1:", quadric_class([-1, -1, -1, 0, 0, 0, 0, 0, 0, 9]))
    for c in (1, 0, -1):
        print(f"x² + y² - z² = {c}:", quadric_class([1, 1, -1, 0, 0, 0, 0, 0, 0, -c]))
    print("z = xy, wanted hyperbolic paraboloid:", quadric_class([0, 0, 0, 1, 0, 0, 0, 0, -1, 0]))
    for D in (0, 1, 2, 3):
        print(f"x² + {D}xy + y² = 3:", quadric_class([1, 1, 0, D, 0, 0, 0, 0, 0, -3]))
    a, b, c = 0.36, 0.48, 0.8  # a unit vector; the plane across it, squared: (ax + by + cz)² = 4
    squared = [a * a, b * b, c * c, 2 * a * b, 2 * b * c, 2 * c * a, 0, 0, 0, -4]
    print("(0.36x + 0.48y + 0.8z)² = 4, wanted parallel planes:", quadric_class(squared))

# %% check="quadric_class"
check(quadric_class)

# %% [markdown]
# **What changed?** In the last example nothing but the position, and yet `A`, `B`, `C` are all positive, as for an ellipsoid. Two
# eigenvalues of its $M$ are 0; the computer gives them as some $10^{-17}$, with a sign that means nothing. Without the tolerance you
# would have called two planes an ellipsoid, or worse, now this and now that.

# %% [markdown]
# ## 3 · A line is turned
#
# The lecture makes a cone by turning a line about an axis. A line and an axis may lie otherwise, too. Take the $z$ axis, and the line
# through $(1, 0, 0)$ in the direction $(0, 1, 1)$: its points are $(1, s, s)$. Turning changes neither $z$ nor
# $\sqrt{x^2 + y^2}$, so all the points swept satisfy
#
# $$x^2 + y^2 = 1 + z^2$$
#
# Which surface is it: a cylinder, a cone, a plane, a hyperboloid?

# %%
swept = None  # "cylinder", "cone", "plane" or "hyperboloid"


# %%
def turned_line(u, w):
    """The line (1, s, s), s from -2 to 2, turned about z."""
    s, angle = mix(u, -2.0, 2.0)[..., 0], 2 * np.pi * np.asarray(w)
    return point(np.cos(angle) - s * np.sin(angle), np.sin(angle) + s * np.cos(angle), s)


reveal(swept, "hyperboloid")
plot.view(turned_line, square=True)

# %% [markdown]
# Not one of the blue lines is curved. Five things can come out: a cylinder, a (double) cone, a hyperboloid, a plane, or a line that
# stays where it is.
#
# **Task (revolved_line_kind).** Three questions decide. Is the line parallel to the axis? Is it at right angles to it? Do they meet?
# Put them in a good order: a line at right angles sweeps a plane *whether or not* it meets the axis (then the plane has a round
# hole).
#
# Neither direction has a unit length. Take $10^{-9}$ of the lengths involved for zero. A direction $(0, 0, 0)$ is none: raise a
# `ValueError`.


# %% solution="revolved_line_kind"
def revolved_line_kind(p, d, point, axis):
    """What an unlimited line sweeps in one turn: 'cylinder', 'cone', 'plane', 'hyperboloid' or 'line'.

    p, d : a point of the line and its direction;  point, axis : a point of the axis and its direction
    """
    p, d, point, axis = (np.asarray(one, float) for one in (p, d, point, axis))
    size = max(np.abs(p).max(), np.abs(point).max())
    ### BEGIN SOLUTION
    if not (d.any() and axis.any()):
        raise ValueError("a direction must not be (0, 0, 0)")
    d, k, v = d / np.linalg.norm(d), axis / np.linalg.norm(axis), p - point
    across = np.cross(d, k)
    if (sine := np.linalg.norm(across)) <= 1e-9:
        return "line" if np.linalg.norm(np.cross(v, k)) <= 1e-9 * size else "cylinder"
    if abs(d @ k) <= 1e-9:
        return "plane"
    return "cone" if abs(v @ across) <= 1e-9 * size * sine else "hyperboloid"
    ### END SOLUTION


# %%
z = [0, 0, 1]
with once_written():
    print("the line of the picture:", revolved_line_kind([1, 0, 0], [0, 1, 1], [0, 0, 0], z))
    print("the axis at x = 1, wanted cone:", revolved_line_kind([1, 0, 0], [0, 1, 1], [1, 0, 0], z))
    print("parallel, wanted cylinder:", revolved_line_kind([1, 0, 0], [0, 0, -2], [0, 0, 5], z))
    print("the axis itself, wanted line:", revolved_line_kind([0, 0, 3], [0, 0, 2], [0, 0, 5], z))
    print("level, wanted plane:", revolved_line_kind([1, 0, 0], [0, 1, 0], [0, 0, 0], z))
    # the axis starts on the line: at (0.1, 0.2, 0.3) and 3/7 of (1, 2, 2) further
    meeting = [0.1 + 3 / 7, 0.2 + 6 / 7, 0.3 + 6 / 7]
    print("aslant, wanted cone:", revolved_line_kind([0.1, 0.2, 0.3], [1, 2, 2], meeting, [3, 1, 4]))

# %% check="revolved_line_kind"
check(revolved_line_kind)

# %% [markdown]
# **What to keep.** "The cone is a line on a circle" is half of the story: so are the cylinder, the plane and the hyperboloid. The
# lecture's cone needs a line that *meets* its axis; miss it by a millimetre and there is no apex but a narrow waist.

# %% [markdown]
# # II · Sweeps that turn and climb
#
# ## 4 · A staircase
#
# The lecture moves a curve straight ahead, or turns it. Do both at once and you get the thread of a bolt, the flutes of a drill, a
# spiral staircase.
#
# Take the line from $(0,0,0)$ to $(0,3,0)$ and the $x$ axis. In one whole turn it moves on by 10, evenly. Where is the middle of the
# line after half a turn, $S(½, ½)$?

# %%
half_way = None  # for example (1, 1, 1)

# %% [markdown]
# Turned about $x$ by the angle $\theta$, right-handed, $y$ goes towards $z$: the point $(x, y, z)$ becomes
# $(x,\ y\cos\theta - z\sin\theta,\ y\sin\theta + z\cos\theta)$.
#
# **Task (screw_sweep).** While $w$ goes from 0 to 1 the curve makes `turns` turns; with *each whole turn* it moves on by `pitch`.
#
# The lecture speaks of a positive and a negative sense and does not say which is which. Ours is the right-hand rule: look
# down the axis from its tip, and positive is anticlockwise.


# %% solution="screw_sweep"
def screw_sweep(u, w, curve, pitch, turns):
    """A curve screwed along the x axis.

    u, w : numbers or arrays in [0, 1];  curve : a function of t, points (..., 3)
    pitch : the way along x in one whole turn;  turns : how many, need not be whole
    Returns points, shape of u and w together + (3,).
    """
    x, y, z = np.moveaxis(curve(np.asarray(u, float)), -1, 0)
    ### BEGIN SOLUTION
    turned = turns * np.asarray(w)
    c, s = np.cos(2 * np.pi * turned), np.sin(2 * np.pi * turned)
    return point(x + pitch * turned, y * c - z * s, y * s + z * c)
    ### END SOLUTION


# %%
def spoke(t):
    return point(0.0, 3 * np.asarray(t), 0.0)


with once_written():
    reveal(half_way, np.round(screw_sweep(0.5, 0.5, spoke, 10, 1), 9) + 0.0)
    display(plot.view(lambda u, w: screw_sweep(u, w, spoke, 10, 1), square=True, mark=(0.5, 0.5)))


# %%
def bent(t):
    return point(1 + 2 * t, 2 - t**2, 0.5 + t)


with once_written():
    S, C = screw_sweep(u, w, bent, 10, 2.5), bent(t)
    holds("w = 0 is the curve itself", S[:, 0], C)
    distance = np.hypot(S[..., 1], S[..., 2])
    holds("nothing comes nearer to the axis", distance, distance[:, :1])
    holds("two and a half turns: 25 on", S[:, -1, 0], C[:, 0] + 25)
    holds("and half a turn round", S[:, -1, 1:], -C[:, 1:])
    one_turn = screw_sweep(u, w, bent, 0, 1)
    holds("pitch 0, one turn: it closes", one_turn[:, -1], one_turn[:, 0])
    mirrored = screw_sweep(u, w, lambda t: bent(t) * [1, 1, -1], -10, -2.5)
    holds("its mirror image is left-handed", mirrored[..., 1:], S[..., 1:] * [1, -1])

# %% check="screw_sweep"
check(screw_sweep)

# %% [markdown]
# **What changes?** Take `turns = -1`: the staircase runs on to $x = -10$, and is still right-handed. A right-handed bolt stays
# right-handed from whichever end you look at it; only a mirror, or a pitch below 0, makes it a left-handed one.

# %% [markdown]
# ## 5 · Round, exactly
#
# No polynomial runs round a circle; a *rational* curve does. Draw the square round the unit circle. Its corners and the middles of its
# sides are nine control points (the last is the first again), and between two middles lies one quarter of the turn, an arc of degree 2 (order 3).
#
# Try it without weights first. The quarter has the points $(1,0)$, $(1,1)$, $(0,1)$, and in its middle
# $\tfrac14(1,0) + \tfrac12(1,1) + \tfrac14(0,1)$. How far is that from the centre?

# %%
without_weights = None  # a number; on the circle it would be 1

# %% fold=true
ring = np.array([(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)], float)


def round_the_square(corner):
    """Four rational arcs, whose corners have the weight given."""
    a, b, c = np.moveaxis(bernstein(2, np.linspace(0, 1, 33)) * [1, corner, 1], -1, 0)[..., None]
    return np.concatenate([(a * ring[i] + b * ring[i + 1] + c * ring[i + 2]) / (a + b + c) for i in (0, 2, 4, 6)])


reveal(without_weights, np.hypot(0.75, 0.75))
figure = go.Figure().update_layout(height=380, **PLAIN)
figure.add_scatter(x=ring[:, 0], y=ring[:, 1], name="nine points", line={"color": "#8A6FB0"}, marker={"size": 9})
for corner, colour in ((1, "#D55E00"), (np.sqrt(0.5), "#0072B2")):
    x, y = round_the_square(corner).T
    figure.add_scatter(x=x, y=y, mode="lines", name=f"corners weigh {corner:.4g}", line={"color": colour, "width": 3})
figure.update_xaxes(range=[-1.15, 1.15]).update_yaxes(scaleanchor="x")

# %% [markdown]
# Weigh the corners by $s = \sqrt{½}$ and it is the circle, to the last digit. Now let each control point $(\varrho_i, z_i)$ of a
# profile go round such a square: $n$ points become a net of $n \times 9$.
#
# **Task (nurbs_revolve).** The profile is a rational Bezier curve with weights $h_i$. Return the net, the weights, and the twelve knots
# along $w$: $0,0,0,1,1,2,2,3,3,4,4,4$, doubled where two arcs meet. The columns start on $+x$ and go towards $+y$.
#
# A product of two forms has the products of their weights.


# %% solution="nurbs_revolve"
def nurbs_revolve(profile, h):
    """Net, weights and knots of the NURBS surface of a profile turned once about z.

    profile : (n, 2), control points (distance from the axis, height);  h : (n,), their weights
    Returns P (n, 9, 3), Cartesian, first index along the profile; weights (n, 9); knots (12,).
    """
    square = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
    rho, z = np.asarray(profile, float).T[..., None]  # two columns, (n, 1)
    ### BEGIN SOLUTION
    x, y = np.array(square, float).T
    corner = np.sqrt(0.5)
    weights = np.asarray(h)[:, None] * [1, corner, 1, corner, 1, corner, 1, corner, 1]
    return point(rho * x, rho * y, z), weights, [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]
    ### END SOLUTION


# %%
def rational(u, w, P, weights):
    """The surface: w runs through the four arcs one after the other."""
    arc = np.minimum((4 * np.asarray(w)).astype(int), 3)
    bu, bw = bernstein(len(P) - 1, u), bernstein(2, 4 * np.asarray(w) - arc)
    columns = 2 * arc[..., None] + np.arange(3)
    bw = (np.eye(9)[columns] * bw[..., None]).sum(axis=-2)  # nine functions, three of them not 0
    above = np.einsum("...i,...j,ij,ijk->...k", bu, bw, weights, P)
    return above / np.einsum("...i,...j,ij->...", bu, bw, weights)[..., None]


half_circle = [(0, -2), (4, -2), (4, 2), (0, 2)], [3, 1, 1, 3]  # as a rational cubic: try it
with once_written():
    P, weights, _ = nurbs_revolve(*half_circle)
    display(plot.view(lambda u, w: rational(u, w, P, weights), net=P))

# %%
with once_written():
    P, weights, knots = nurbs_revolve(*half_circle)
    x, y, z = np.moveaxis(rational(u, w, P, weights), -1, 0)
    holds("a sphere: x² + y² + z² = 4, exactly", x**2 + y**2 + z**2, 4)
    holds("w = 1/8 is 45 degrees round: x = y", x[:, 1], y[:, 1])
    wall = nurbs_revolve([(3, 0), (1, 4)], [1, 1])
    x, y, z = np.moveaxis(rational(u, w, *wall[:2]), -1, 0)
    holds("a straight profile: the frustum with ϱ = 3 - z/2", np.hypot(x, y), 3 - z / 2)
    print("net, weights, knots:", np.shape(P), np.shape(weights), np.shape(knots))

# %% check="nurbs_revolve"
check(nurbs_revolve)

# %% [markdown]
# **What to see.** At the poles a whole row of nine points has shrunk to one; between them the net stands a good deal outside the
# sphere, and the sphere is exact. Every sphere, torus, cone and cylinder travels from one CAD program to another in this form.

# %% [markdown]
# # III · Nets: cut, raise, convert
#
# ## 6 · Cut in two
#
# *"You can split a parametric surface"*, the lecture says: along $u = u_0$, and each piece is a Bezier patch again. What are its
# control points?
#
# One curve first, $(0,0), (0,4), (4,4), (4,0)$, cut at $½$. Cut each leg in its middle: $(0,2), (2,4), (4,2)$. Cut again: $(1,3), (3,3)$. Once
# more: $(2,3)$, the point of the curve. Now you have ten points, and the two pieces need four each.
#
# How many of the *old* four are among those eight?

# %%
old_ones = None  # a number from 0 to 4

# %%
levels = [np.array([(0, 0), (0, 4), (4, 4), (4, 0)], float)]
while len(levels[-1]) > 1:
    levels.append((levels[-1][:-1] + levels[-1][1:]) / 2)
pieces = np.array([level[0] for level in levels]), np.array([level[-1] for level in levels[::-1]])
figure = go.Figure().update_layout(height=340, **PLAIN)
grey = {"color": "#A6A6A6", "dash": "dot"}
for level in levels[:-1]:
    figure.add_scatter(x=level[:, 0], y=level[:, 1], line=grey, mode="lines", showlegend=False)
for P, name, colour in ((pieces[0], "first piece", "#0072B2"), (pieces[1], "second piece", "#D55E00")):
    x, y = bezier(np.linspace(0, 1, 41), P).T
    figure.add_scatter(x=x, y=y, mode="lines", line={"color": colour, "width": 5}, showlegend=False)
    figure.add_scatter(x=P[:, 0], y=P[:, 1], name=name, line={"color": colour}, marker={"size": 9})
reveal(old_ones, 2)
figure.update_yaxes(scaleanchor="x")

# %% [markdown]
# The first piece takes the *first* point of every level; the second the *last* of every level. That holds for any $u_0$: a leg
# from $a$ to $b$ is then cut at $(1 - u_0)\,a + u_0\,b$.
#
# **Task (bezier_split).** Two nets, in this order: $u \le u_0$ and $u \ge u_0$. Both run the way the whole runs: the second
# begins where the first ends. On a net, a "point" is a row `P[i]`, and nothing else changes.


# %% solution="bezier_split"
def bezier_split(P, u0):
    """The nets of the two pieces into which u = u0 cuts the Bezier patch of P.

    P : (m, n, 3), first index along u;  u0 : number between 0 and 1
    Returns two arrays (m, n, 3): the first piece, the second piece.
    """
    P = np.asarray(P, float)
    first, second = [P[0]], [P[-1]]
    ### BEGIN SOLUTION
    while len(P) > 1:
        P = (1 - u0) * P[:-1] + u0 * P[1:]
        first.append(P[0])
        second.insert(0, P[-1])
    return np.array(first), np.array(second)
    ### END SOLUTION


# %%
with once_written():
    first, second = bezier_split(NET, 0.25)
    holds("they meet: same row", first[-1], second[0])
    holds("the first piece ends at u = 1/4", first[-1, 0], bezier(0.25, NET[:, 0]))
    holds("the outer rows are the old ones", [first[0], second[-1]], [NET[0], NET[-1]])
    holds("first piece: u/4 of the whole", bezier_patch(u, w, first), bezier_patch(u / 4, w, NET))
    holds("second piece: 1/4 + 3u/4", bezier_patch(u, w, second), bezier_patch(0.25 + 0.75 * u, w, NET))

# %% check="bezier_split"
check(bezier_split)

# %% [markdown]
# ### A trap: the middle
#
# A classmate wrote the mean of two neighbours, $(a + b)/2$, as in the picture above, and tried her function with $u_0 = ½$: it was
# right to the last digit. Another gave back the second net from the far end, and tried a net that is its own mirror image. Which $u_0$, and
# which net, would you ask both of them to try?

# %% [markdown]
# ## 7 · One degree more
#
# A patch of degree 2 (order 3) is to go into a program that knows only degree 3. It is the same surface; only the net must grow by a row.
#
# The parabola with the points $(0,0), (2,4), (4,0)$ has its top at height 2. As a cubic it needs four points. The first and the last
# stay, the two new ones are equally high. How high? (With Bernstein's weights the top of the cubic is at $\tfrac34$ of their height.)

# %%
new_height = None  # a number

# %% [markdown]
# Each new point lies on a leg of the old polygon. With $n$ old points, counted from 0:
#
# $$Q_0 = P_0, \qquad Q_i = \tfrac{i}{n}\, P_{i-1} + \left(1 - \tfrac{i}{n}\right) P_i, \qquad Q_n = P_{n-1}$$
#
# In the example $n = 3$ and $Q_1 = \tfrac13 (0,0) + \tfrac23 (2,4)$.
#
# **Task (elevate_u).** One row more: the degree in $u$ rises by one, the degree in $w$ stays.


# %% solution="elevate_u"
def elevate_u(P):
    """The net of the same Bezier patch with its degree in u raised by one.

    P : (m, n, 3), first index along u
    Returns an array (m + 1, n, 3).
    """
    P = np.asarray(P, float)
    ### BEGIN SOLUTION
    share = np.arange(1, len(P))[:, None, None] / len(P)
    return np.concatenate([P[:1], share * P[:-1] + (1 - share) * P[1:], P[-1:]])
    ### END SOLUTION


# %%
parabola = np.array([(0, 0, 0), (2, 4, 0), (4, 0, 0)], float)
with once_written():
    raised = elevate_u(NET)
    holds("the same surface", bezier_patch(u, w, raised), bezier_patch(u, w, NET))
    holds("twice: still the same", bezier_patch(u, w, elevate_u(raised)), bezier_patch(u, w, NET))
    holds("the outer rows stay", raised[[0, -1]], NET[[0, -1]])
    print("rows and columns:", raised.shape[:2])
    reveal(new_height, elevate_u(parabola[:, None])[1, 0, 1])

# %%
with once_written():
    figure = go.Figure().update_layout(height=320, **PLAIN)
    net = parabola[:, None]  # three rows of one point: a curve
    for times in range(31):
        if times in (0, 1, 3, 10, 30):
            (x, y, _), line = net[:, 0].T, {"color": f"rgba(138, 111, 176, {1 - times / 45})"}
            dots = {"size": 7 if times < 4 else 3}
            figure.add_scatter(x=x, y=y, name=f"raised {times} times", line=line, marker=dots)
        net = elevate_u(net)
    x, y, _ = bezier(np.linspace(0, 1, 61), parabola).T
    figure.add_scatter(x=x, y=y, mode="lines", name="the curve", line={"color": "#009E73", "width": 4})
    display(figure.update_yaxes(scaleanchor="x"))

# %% check="elevate_u"
check(elevate_u)

# %% [markdown]
# **What to see.** Raised again and again, the polygon creeps up to the curve, and slowly: thirty times and there is still a gap. Cutting
# in two, as in the task before, is much faster; programs that draw Bezier curves do that.

# %% [markdown]
# ## 8 · A piece that touches nothing
#
# In A7 the knots were repeated at the ends, so that the surface reached its corner points. Leave them evenly spaced, and one piece of a
# cubic B-spline surface (degree 3, order 4) is made by $4 \times 4$ points and passes, in general, through none of them:
#
# $$S = U\, M_S\, P\, M_S^T\, W^T, \qquad M_S = \frac16 \begin{bmatrix} -1 & 3 & -3 & 1 \\ 3 & -6 & 3 & 0 \\ -3 & 0 & 3 & 0 \\ 1 & 4 & 1 & 0 \end{bmatrix}$$
#
# with $U = (u^3, u^2, u, 1)$ and $W$ alike. Put in the lattice $P_{ij} = (i, j, 0)$. Where does the piece begin, $S(0, 0)$? (There $U$ picks
# the last row of $M_S$.)

# %%
begins = None  # for example (0, 0, 0)

# %% [markdown]
# **Task (uniform_bicubic).** `P` of shape $4 \times 4$ points, first index along $u$. The formula stands for each coordinate by itself.
#
# The rival convention: other books write the powers rising, $1, u, u^2, u^3$. Then the rows of the matrix stand upside down.


# %% solution="uniform_bicubic"
def uniform_bicubic(u, w, P):
    """One piece of a uniform bicubic B-spline surface (order 4, degree 3), knots not repeated.

    u, w : numbers or arrays in [0, 1];  P : (4, 4, 3), first index along u
    Returns points, shape of u and w together + (3,).
    """
    MS = np.array([[-1, 3, -3, 1], [3, -6, 3, 0], [-3, 0, 3, 0], [1, 4, 1, 0]]) / 6
    ### BEGIN SOLUTION

    def weights(t):
        t = np.asarray(t, float)
        return np.stack([t**3, t**2, t, np.ones_like(t)], axis=-1) @ MS

    return np.einsum("...i,...j,ijk->...k", weights(u), weights(w), P)
    ### END SOLUTION


# %%
lattice = np.array([[(i, j, 0) for j in range(4)] for i in range(4)], float)
hills = np.array([[(i, j, (i * j) % 3) for j in range(4)] for i in range(5)], float)  # one row more
with once_written():
    reveal(begins, uniform_bicubic(0, 0, lattice))
    display(plot.view(lambda u, w: uniform_bicubic(u, w, hills[:4]), net=hills[:4]))

# %%
with once_written():
    holds("the lattice: (1 + u, 1 + w, 0)", uniform_bicubic(u, w, lattice), point(1 + u, 1 + w, 0))
    holds("weights that add up to 1", uniform_bicubic(u, w, np.ones((4, 4, 3))), 1)
    now = [uniform_bicubic(1 - k / 4, t, hills[:4]) for k in range(4)]  # from its end back
    then = [uniform_bicubic(k / 4, t, hills[1:]) for k in range(4)]  # the next, from its beginning on
    holds("the next piece begins where this one ends", then[0], now[0])
    steps = -11, 18, -9, 2  # these four give the derivative of a cubic exactly
    now, then = (sum(a * S for a, S in zip(steps, way, strict=True)) for way in (now, then))
    holds("and with the same derivative", then, -now)

# %% check="uniform_bicubic"
check(uniform_bicubic)

# %% [markdown]
# **What changed?** Compared with Bezier patches, the order of things: there a patch is made to fit its neighbour, here each net of
# $5 \times 4$ points *has* two pieces that join with equal first and second derivatives. The price is that you hold no point of the
# surface in your hand.

# %% [markdown]
# ## 9 · Through sixteen points
#
# In A5 a patch ran *through* sixteen points, at $u, w = 0, \tfrac13, \tfrac23, 1$. Programs want its Bezier points. Are they far away?
#
# Look at one curve: at the four parameters its heights are $0, 1, 0, 0$. Its Bezier heights begin and end with 0, too. How high is the second
# one: about $1$, $2$ or $3$?

# %%
second_height = None

# %%
at = np.array([0, 1, 2, 3]) / 3
heights, control = np.array([0, 1, 0, 0]), np.array([0, 3, -1.5, 0])
s = np.linspace(0, 1, 61)
figure = go.Figure().update_layout(height=320, **PLAIN)
line, given = {"color": "#009E73", "width": 4}, {"size": 10, "color": "#D55E00"}
figure.add_scatter(x=s, y=bezier(s, control), mode="lines", name="the curve", line=line)
figure.add_scatter(x=at, y=control, name="Bezier points", line={"color": "#8A6FB0"}, marker={"size": 9})
figure.add_scatter(x=at, y=heights, mode="markers", name="given points", marker=given)
reveal(second_height, 3)
figure.update_xaxes(title="t")

# %% [markdown]
# **Test it by hand.** At $t = \tfrac13$ the weights of the two inner points are $3\cdot\tfrac13\cdot\tfrac49 = \tfrac49$ and
# $3\cdot\tfrac19\cdot\tfrac23 = \tfrac29$; indeed $\tfrac49\cdot 3 - \tfrac29\cdot 1.5 = 1$.
#
# **Task (points16_to_bezier).** `P[i, j]` is the point at $u = i/3$, $w = j/3$. There are two roads: the $4 \times 4$ matrix of Bernstein's
# weights at the four parameters turns control points into points, and its inverse turns them back, once for each direction; or solve the
# four equations by hand and build the matrix $K$.


# %% solution="points16_to_bezier"
def points16_to_bezier(P):
    """The control net of the bicubic Bezier patch through sixteen points.

    P : (4, 4, 3), P[i, j] at u = i/3, w = j/3
    Returns an array (4, 4, 3).
    """
    P = np.asarray(P, float)
    ### BEGIN SOLUTION
    K = np.linalg.inv(bernstein(3, np.arange(4) / 3))
    return np.einsum("ia,jb,abk->ijk", K, K, P)
    ### END SOLUTION


# %%
with once_written():
    Q = points16_to_bezier(NET)
    holds("it passes through all sixteen", bezier_patch(at[:, None], at[None, :], Q), NET)
    holds("corners stay", Q[::3, ::3], NET[::3, ::3])
    on_it = bezier_patch(at[:, None], at[None, :], NET)
    holds("sixteen points of a Bezier patch: its net comes back", points16_to_bezier(on_it), NET)
    along = points16_to_bezier(np.multiply.outer(heights, np.ones((4, 3))))
    holds("the curve above: 0, 3, -1.5, 0", along[:, 0, 0], control)

# %% check="points16_to_bezier"
check(points16_to_bezier)

# %% [markdown]
# **What to keep.** Points that one must pass through are strict masters: move a single one by 1, and a
# control point jumps by 3, its neighbour back by 1.5; on a patch by 9. That is why designers pull at control points.

# %% [markdown]
# # IV · Boundaries
#
# ## 10 · Do they meet?
#
# Coons' formula never asks whether its four curves meet. Below, $d_0$ begins half a unit above the beginning of $c_0$, and the other
# three corners are as they should be: along $w = 0$ the patch misses $c_0$, by the whole gap at one end.
#
# So one asks first. The corners stand on a rectangle of 3 by 4. A gap up to a *thousandth of the size* shall be forgiven, and the size
# is the diagonal of the box around all ends. How large a gap is that?

# %%
forgiven = None  # a number

# %%
s = np.linspace(0, 1, 41)
c0_height, gap = 1.5 * s * (1 - s), 0.5
edge_height = c0_height + (1 - s) * gap  # (1-u) d0(0) + u d1(0) adds more than the corners take away
figure = go.Figure().update_layout(height=280, **PLAIN)
for y, name, colour in ((c0_height, "c0", "#0072B2"), (edge_height, "S(u, 0)", "#D55E00")):
    figure.add_scatter(x=s, y=y, mode="lines", name=name, line={"color": colour, "width": 4})
reveal(forgiven, 0.005)
figure.update_xaxes(title="u").update_yaxes(title="height")

# %% [markdown]
# **Task (corners_agree).** `True` if at each of the four corners two ends are at most `rtol` times the size apart. The size is the diagonal of
# the smallest box, along $x, y, z$, that holds all eight ends.
#
# $c_0, c_1$ run along $u$ and $d_0, d_1$ along $w$, all of them *growing*: at which corner do $c_1$ and $d_0$ meet? (Head to tail, once
# round, is the rival convention.)
#
# Why not simply "less than a micrometre"? On the bonnet of a car that is nothing, in a watch it is something.


# %% solution="corners_agree"
def corners_agree(c0, c1, d0, d1, rtol):
    """Whether four curves meet in four corners, to rtol of their size.

    c0, c1 : edges w = 0 and w = 1, functions of u;  d0, d1 : edges u = 0 and u = 1, functions of w
    rtol : largest gap, relative to the diagonal of the box around all eight ends
    Returns True or False.
    """
    ### BEGIN SOLUTION
    of_c = np.array([c0(0.0), c0(1.0), c1(0.0), c1(1.0)])
    of_d = np.array([d0(0.0), d1(0.0), d0(1.0), d1(1.0)])
    ends = np.concatenate([of_c, of_d])
    size = np.linalg.norm(ends.max(axis=0) - ends.min(axis=0))
    return bool(np.linalg.norm(of_c - of_d, axis=-1).max() <= rtol * size)
    ### END SOLUTION


# %%
def line_between(a, b):
    return lambda t: mix(t, np.array(a, float), np.array(b, float))


def frame(lift=0.0, scale=1.0):
    """Four edges of a rectangle of 3 by 4; d0 begins too high by lift."""
    a, b, c, d, high = scale * np.array([(0, 0, 0), (3, 0, 0), (0, 4, 0), (3, 4, 0), (0, 0, lift)])
    return line_between(a, b), line_between(c, d), line_between(high, c), line_between(b, d)


with once_written():
    print("they meet, wanted True:", corners_agree(*frame(), 1e-9))
    print("gap 0.004, wanted True:", corners_agree(*frame(0.004), 1e-3))
    print("gap 0.006, wanted False:", corners_agree(*frame(0.006), 1e-3))
    print("all 1000 times as large, wanted True:", corners_agree(*frame(0.004, 1000), 1e-3))
    bottom, top, left, right = frame()
    print("head to tail, wanted False:", corners_agree(bottom, lambda t: top(1 - t), left, right, 1e-3))

# %% check="corners_agree"
check(corners_agree)

# %% [markdown]
# ## 11 · Without a crease
#
# Coons mixes with $1 - t$ and $t$. Two such patches side by side share an edge, and usually have a crease along it. Take the cubics of A5
# instead, *in all three parts*:
#
# $$F_1(t) = 1 - 3t^2 + 2t^3, \qquad F_2(t) = 3t^2 - 2t^3$$
#
# They are level at both ends. Let the four edges be straight, three corners at height 0 and $p_{11}$ at height 1. The old patch is bilinear,
# its height $uw$. The new one has $F_2(w)\,u + F_2(u)\,w - F_2(u)\,F_2(w)$. What is that at $u = w = ½$, where $F_2 = ½$?

# %%
in_the_middle = None  # a number; the bilinear patch has 1/4

# %%
s = np.linspace(0, 1, 61)
F2 = 3 * s**2 - 2 * s**3
figure = go.Figure().update_layout(height=300, **PLAIN)
line = {"color": "#D55E00", "width": 4}
figure.add_scatter(x=s, y=2 * F2 * s - F2**2 - s**2, mode="lines", line=line)
reveal(in_the_middle, 0.25)
figure.update_xaxes(title="u = w, along the diagonal").update_yaxes(title="cubic less bilinear")

# %% [markdown]
# ### A trap: the middle, once more
#
# At $½$ both kinds of mixing give ½, so in the middle of the patch nothing can be seen; nor on the edges, which are the same
# four curves. Look a quarter of the way in: $F_2(\tfrac14) = \tfrac5{32}$, and the cubic patch has the height $\tfrac{55}{1024}$,
# where the bilinear one has $\tfrac{64}{1024}$.
#
# **Task (cubic_coons).** The Coons patch with $F_1, F_2$ in place of $1 - t, t$, wherever these stand in Coons' formula: in both ruled
# parts, and in the bilinear part that is taken away.


# %% solution="cubic_coons"
def cubic_coons(u, w, c0, c1, d0, d1):
    """The Coons patch of four curves, mixed by the cubics F1 and F2.

    u, w : numbers or arrays in [0, 1]
    c0, c1 : edges w = 0 and w = 1, functions of u;  d0, d1 : edges u = 0 and u = 1, functions of w
    Returns points, shape of u and w together + (3,).
    """
    u, w = np.asarray(u, float), np.asarray(w, float)
    ### BEGIN SOLUTION
    fu, fw = 3 * u**2 - 2 * u**3, 3 * w**2 - 2 * w**3
    across_w, across_u = mix(fw, c0(u), c1(u)), mix(fu, d0(w), d1(w))
    return across_w + across_u - mix(fw, mix(fu, c0(0.0), c0(1.0)), mix(fu, c1(0.0), c1(1.0)))
    ### END SOLUTION


# %% fold=true
p = np.array([[[0, 0, 0], [1, 4, 1]], [[5, -1, 2], [6, 3, -1]]], float)
pu = np.array([[[6, 1, 3], [3, -2, 5]], [[4, 0, -4], [7, 2, 1]]], float)
pw = np.array([[[1, 5, 2], [-1, 3, 4]], [[0, 6, -3], [2, 3, -2]]], float)


def hermite(t):
    """F1, F2, F3, F4 of A5, for p(0), p(1), p'(0), p'(1)."""
    t = np.asarray(t, float)
    each = 1 - 3 * t**2 + 2 * t**3, 3 * t**2 - 2 * t**3, t - 2 * t**2 + t**3, t**3 - t**2
    return np.stack(each, axis=-1)


edges = [lambda t, j=j: hermite(t) @ [p[0, j], p[1, j], pu[0, j], pu[1, j]] for j in (0, 1)]
edges += [lambda t, i=i: hermite(t) @ [p[i, 0], p[i, 1], pw[i, 0], pw[i, 1]] for i in (0, 1)]
G = np.zeros((4, 4, 3))
G[:2, :2], G[2:, :2], G[:2, 2:] = p, pu, pw

# %% [markdown]
# **Test it yourself.** The folded cell has four Hermite cubics for edges, with their corners, tangents and the matrix $G$ of A5, all
# twists 0. The last line of this test is the reason why the cubics were taken: along the edge $w = 0$ the derivative *across* it is mixed from
# the two ends alone. So a neighbour with the same edge and the same two tangents joins without a crease.

# %%
with once_written():
    S = cubic_coons(u, w, *edges)
    holds("edges w = 0 and w = 1", S[:, [0, -1]], np.stack([edges[0](t), edges[1](t)], axis=1))
    holds("edges u = 0 and u = 1", S[[0, -1]], [edges[2](t), edges[3](t)])
    ferguson = np.einsum("...i,...j,ijk->...k", hermite(u), hermite(w), G)
    holds("Hermite edges: it is the Ferguson patch of A8", S, ferguson)
    h = 1 / 4
    across = [cubic_coons(t, k * h, *edges) for k in range(4)]  # exact, as it is cubic in w
    across = (-11 * across[0] + 18 * across[1] - 9 * across[2] + 2 * across[3]) / (6 * h)
    holds("across the edge: F1 pw00 + F2 pw10", across, hermite(t)[:, :2] @ pw[:, 0])

# %% check="cubic_coons"
check(cubic_coons)

# %% [markdown]
# **What to keep.** In A8 Ferguson and Coons differed by their twists. Now they are one patch: Ferguson *is* Coons with cubic mixing,
# when the edges are Hermite cubics. (The lecture says that Ferguson "takes four boundary curves"; it takes corners and tangents,
# and here you see when that is the same.)

# %% [markdown]
# ## 12 · The net of a Coons patch
#
# Four Bezier curves for edges, and the patch that Coons' formula hangs between them is a Bezier patch. Its boundary points are the polygons
# given; only the inner ones are wanted.
#
# Look at heights only. All four edges are cubic and level at 0, but for $c_0$, whose control heights are $0, 9, 9, 0$. What is the height of
# $P_{11}$? Two answers are heard: $P_{10} + P_{01} - P_{00} = 9$, and $\tfrac23$ of the way towards $c_0$, $6$.

# %%
inner_height = None  # 9 or 6

# %% [markdown]
# Coons' formula, with the polygons in place of the curves and, in place of $u$ and $w$, the shares $s_i$ and $t_j$ from 0 to 1 in equal
# steps, that is $0, \tfrac13, \tfrac23, 1$ for four points:
#
# $$P_{ij} = (1 - t_j)\, c_{0,i} + t_j\, c_{1,i} + (1 - s_i)\, d_{0,j} + s_i\, d_{1,j} - (\text{bilinear, of the corners})$$
#
# **Task (coons_bezier_net).** $c_0, c_1$ have $m$ points and $d_0, d_1$ have $n$; $m$ and $n$ may differ.


# %% solution="coons_bezier_net"
def coons_bezier_net(c0, c1, d0, d1):
    """The Bezier net of the Coons patch (mixed by 1 - t and t) of four Bezier curves.

    c0, c1 : (m, 3), control points of the edges w = 0, 1;  d0, d1 : (n, 3), of the edges u = 0, 1
    Returns an array (m, n, 3), first index along u.
    """
    s, t = np.linspace(0, 1, len(c0))[:, None], np.linspace(0, 1, len(d0))[None, :]
    ### BEGIN SOLUTION
    across_w = mix(t, c0[:, None], c1[:, None])
    across_u = mix(s, d0[None], d1[None])
    return across_w + across_u - mix(t, mix(s, c0[0], c0[-1]), mix(s, c1[0], c1[-1]))
    ### END SOLUTION


# %%
polygons = NET[:, 0], NET[:, -1], NET[0], NET[-1]
with once_written():
    net = coons_bezier_net(*polygons)
    display(plot.view(lambda u, w: bezier_patch(u, w, net), net=net))


# %%
def coons(u, w, c0, c1, d0, d1):
    corners = mix(w, mix(u, c0(0), c0(1)), mix(u, c1(0), c1(1)))
    return mix(w, c0(u), c1(u)) + mix(u, d0(w), d1(w)) - corners


with once_written():
    net = coons_bezier_net(*polygons)
    holds("the boundary of the net", net[[0, -1]], NET[[0, -1]])
    curves = [lambda t, P=P: bezier(t, P) for P in polygons]
    holds("it is the Coons patch", bezier_patch(u, w, net), coons(u, w, *curves))
    rest = np.zeros((4, 3))
    only = coons_bezier_net(np.outer([0, 9, 9, 0], [0, 0, 1]), rest, rest, rest)
    reveal(inner_height, only[1, 1, 2])

# %% check="coons_bezier_net"
check(coons_bezier_net)

# %% [markdown]
# **Which patch did the other answer give?** $P_{11} = P_{10} + P_{01} - P_{00}$ makes a parallelogram at the corner: twist 0. With that rule at all
# four corners you have the *Ferguson* patch of the same edges. Nine or six: two programs, both right by their own rule, and two bonnets
# that do not fit on each other.

# %% [markdown]
# ## 13 · How long a tangent?
#
# A Ferguson patch wants tangents, and the machinist has only points. So a tangent at each point is made from its two neighbours: its
# *direction* is that from the point before to the point after. Its *length* is the question.
#
# Four points: $(0,0), (6,0), (7,1), (7,7)$; two long legs and a short one of $\sqrt 2$ between them. FMILL, an early program, takes the *shorter* of the
# two distances to the neighbours. How long is the tangent at $(6, 0)$? (The picture shows the corner.)

# %%
tangent_length = None  # a number

# %% fold=true
row = np.array([(0, 0), (6, 0), (7, 1), (7, 7)], float)
legs = np.linalg.norm(np.diff(row, axis=0), axis=-1)
s = np.linspace(0, 1, 41)[:, None]
ease = 1 - 3 * s**2 + 2 * s**3, 3 * s**2 - 2 * s**3, s - 2 * s**2 + s**3, s**3 - s**2
reveal(tangent_length, np.sqrt(2))
figure = go.Figure().update_layout(height=420, **PLAIN)
for name, length, colour in (("longer", np.maximum, "#D55E00"), ("shorter", np.minimum, "#0072B2")):
    size = length(legs[:-1], legs[1:])[:, None]
    chord = row[2:] - row[:-2]
    tangent = np.zeros_like(row)
    tangent[1:-1] = size * chord / np.linalg.norm(chord, axis=-1, keepdims=True)
    pieces = [sum(f * a for f, a in zip(ease, (row[i], row[i + 1], tangent[i], tangent[i + 1]), strict=True)) for i in range(3)]
    x, y = np.concatenate(pieces).T
    figure.add_scatter(x=x, y=y, mode="lines", name=f"the {name} one", line={"color": colour, "width": 3})
figure.add_scatter(x=row[:, 0], y=row[:, 1], mode="markers", name="points", marker={"size": 9, "color": "#7A7A7A"})
figure.update_xaxes(range=[4.4, 8]).update_yaxes(range=[-0.7, 2.4], scaleanchor="x")

# %% [markdown]
# **What to see.** A tangent that is too long for the short leg shoots past the next point and has to come back.
#
# **Task (fmill_tangents).** Points in a grid; `pu` for the rows that run along the first index, `pw` for those along the second. At
# both ends of a row one neighbour is missing: the tangent there is $(0, 0, 0)$.
#
# By hand: the row $(0,0,0), (0,1,0), (0,1,2)$ has at its middle the direction $(0,1,2)/\sqrt5$, and the shorter leg is 1.


# %% solution="fmill_tangents"
def fmill_tangents(P):
    """Tangents along both directions of a grid of points, by the rule of FMILL.

    P : (m, n, 3), first index along u
    Returns pu and pw, each (m, n, 3); zero at the ends of each row.
    """

    def along_first(P):
        tangents = np.zeros(P.shape)
        ### BEGIN SOLUTION
        before, after = P[1:-1] - P[:-2], P[2:] - P[1:-1]
        length = np.minimum(np.linalg.norm(before, axis=-1), np.linalg.norm(after, axis=-1))
        chord = before + after
        tangents[1:-1] = (length / np.linalg.norm(chord, axis=-1))[..., None] * chord
        ### END SOLUTION
        return tangents

    return along_first(P), np.swapaxes(along_first(np.swapaxes(P, 0, 1)), 0, 1)


# %%
steps = np.array([[0, 0, 0], [0, 1, 0], [0, 1, 2]])
grid = np.stack([steps, steps + [1, 0, 0], steps * [1, 1, 2] + [2, 0, 0]]).astype(float)
with once_written():
    pu, pw = fmill_tangents(grid)
    holds("first row: (0, 1, 2)/√5", pw[0, 1], np.array([0, 1, 2]) / np.sqrt(5))
    holds("last row: (0, 1, 4)/√17", pw[2, 1], np.array([0, 1, 4]) / np.sqrt(17))
    holds("across: steps of 1 along x", pu[1, :2], [[1, 0, 0], [1, 0, 0]])
    holds("none at the ends", [*pu[[0, -1]].ravel(), *pw[:, [0, -1]].ravel()], 0)
    holds("ten times as large: tangents, too", fmill_tangents(10 * grid), 10 * np.array([pu, pw]))

# %% check="fmill_tangents"
check(fmill_tangents)

# %% [markdown]
# # V · Solids and inspection
#
# ## 14 · Which way is out?
#
# A solid $S(u, v, w)$ has six faces. On each, one parameter is held and two are left; call the cross product of the two derivatives, in the
# order of the letters, the normal. On $u = 0$ and on $u = 1$ it is $S_v \times S_w$ and points along growing $u$: out of the solid at
# $u = 1$, and into it at $u = 0$.
#
# On the faces of $v$ it is $S_u \times S_w$; on those of $w$ it is $S_u \times S_v$. Three of the six have to be turned over. Which?

# %%
to_turn = None  # for example ("u = 0", "v = 0", "w = 0")


# %%
def solid(u, v, w, P, derivative=None):
    """A point of the Bezier solid of P, or its derivative by the parameter 0 (u), 1 (v) or 2 (w)."""
    weights = [bernstein(3, x) for x in (u, v, w)]
    if derivative is not None:
        lower = bernstein(2, (u, v, w)[derivative])
        pad = np.zeros((*lower.shape[:-1], 1))
        weights[derivative] = 3 * (np.concatenate([pad, lower], -1) - np.concatenate([lower, pad], -1))
    return np.einsum("...i,...j,...k,ijkd->...d", *weights, P)


i, j, k = np.meshgrid(np.arange(4.0), np.arange(4.0), np.arange(4.0), indexing="ij")
box = np.stack([i, j, k], axis=-1)
bowed = box * [3, 4, 5] + np.stack([k * (3 - k) / 2, 0.4 * i * k, i * (3 - i) * (j - 1)], axis=-1)
reveal(to_turn, ("u = 0", "v = 1", "w = 0"))

# %% [markdown]
# Why $v = 1$, and not $v = 0$? Because $u, w$ skips a letter: $S_u \times S_w$ points along *falling* $v$. Test it on the cube where $u, v, w$
# are $x, y, z$.
#
# **Task (outward_normals).** The solid is right-handed, as that cube is. Six unit normals, all of them outward, in the order $u = 0$, $u = 1$, $v = 0$, $v = 1$, $w = 0$, $w = 1$. The
# place on each face is $(s, t)$: its two parameters in the order of the letters. `solid` gives the derivatives.


# %% solution="outward_normals"
def outward_normals(s, t, P):
    """Unit normals of the six faces at their place (s, t), all pointing out of the solid.

    s, t : the two parameters left on each face, in the order of the letters;  P : (4, 4, 4, 3)
    Returns an array (6, 3), faces u = 0, u = 1, v = 0, v = 1, w = 0, w = 1.
    """
    places = (0, s, t), (1, s, t), (s, 0, t), (s, 1, t), (s, t, 0), (s, t, 1)
    left = (1, 2), (1, 2), (0, 2), (0, 2), (0, 1), (0, 1)  # parameters that are left
    ### BEGIN SOLUTION
    normals = [
        out * np.cross(solid(*place, P, a), solid(*place, P, b))
        for out, place, (a, b) in zip((-1, 1, 1, -1, -1, 1), places, left, strict=True)
    ]
    return np.array([n / np.linalg.norm(n) for n in normals])
    ### END SOLUTION


# %%
with once_written():
    needles = outward_normals(0.5, 0.5, bowed)
    at_faces = (0, 0.5, 0.5), (1, 0.5, 0.5), (0.5, 0, 0.5), (0.5, 1, 0.5), (0.5, 0.5, 0), (0.5, 0.5, 1)
    feet = np.array([solid(*place, bowed) for place in at_faces])
    middle = np.broadcast_to(solid(0.5, 0.5, 0.5, bowed), feet.shape)
    way = np.stack([middle, feet, feet + 4 * needles, feet, middle], axis=1).reshape(-1, 3)
    needles = {"outward normals": way}
    display(plot.view(lambda u, v, w: solid(u, v, w, bowed), curves=needles))

# %%
with once_written():
    six = np.array([[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1]])
    holds("the cube", outward_normals(0.3, 0.6, box), six)
    n = outward_normals(0.3, 0.6, bowed)
    holds("unit vectors", np.linalg.norm(n, axis=-1), 1)
    holds("across S_u and S_w where v = 1", [n[3] @ solid(0.3, 1, 0.6, bowed, d) for d in (0, 2)], 0)
    holds("moved and twice as large: the same", outward_normals(0.3, 0.6, 2 * bowed + 5), n)

# %% check="outward_normals"
check(outward_normals)

# %% [markdown]
# ## 15 · How round is a ball?
#
# *Sphericity*: the largest distance from the centre less the smallest. Which centre? The nearest idea is the mean of the measured points. But a
# machine seldom reaches all round.
#
# A perfect ball of radius 10, measured on its upper half, at heights evenly spread from 0 to 10. (Equal slices of a sphere have equal areas:
# so says Archimedes.) At what height is the mean of the points?

# %%
mean_height = None  # in mm; the centre is at 0

# %%
height = (np.arange(60) + 0.5) / 6
angle = 2.4 * np.arange(60)
dome = point(*(np.sqrt(100 - height**2) * [np.cos(angle), np.sin(angle)]), height)
reveal(mean_height, dome[:, 2].mean(), "mm")
for name, centre in (("the mean", (0, 0, 5)), ("the centre", (0, 0, 0))):
    far = np.linalg.norm(dome - centre, axis=-1)
    print(f"about {name}: from {far.min():.2f} to {far.max():.2f} mm")
figure = go.Figure().update_layout(height=320, **PLAIN)
side = np.hypot(dome[:, 0], dome[:, 1]) * np.where(np.cos(angle) < 0, -1, 1)
figure.add_scatter(x=side, y=height, mode="markers", name="measured", marker={"color": "#0072B2"})
figure.add_scatter(x=[0], y=[0], mode="markers", name="centre", marker={"color": "#009E73", "size": 12})
figure.add_scatter(x=[0], y=[5], mode="markers", name="mean", marker={"color": "#D55E00", "size": 12})
figure.update_xaxes(title="distance from the axis, mm").update_yaxes(title="z, mm", scaleanchor="x")

# %% [markdown]
# **What went wrong?** About the mean this perfect ball is out of round by 6 mm. On a ball that is measured evenly all round, the mean *is* the
# centre, and nobody notices.
#
# A sphere about $c$ is $|x - c|^2 = r^2$; multiplied out, $|x|^2 = 2\,c\cdot x + k$ with $k = r^2 - |c|^2$. Four unknowns, $c$ and $k$, and all
# of them linear!
#
# **Task (sphericity).** Find them by least squares, one row $(2x, 2y, 2z, 1)$ a point: `np.linalg.lstsq(A, b, rcond=None)[0]`. Then the largest
# distance from $c$ less the smallest.


# %% solution="sphericity"
def sphericity(points):
    """Range of the distances of points from the centre of their best sphere, |x|² = 2 c·x + k.

    points : (n, 3), n at least 5, not all in one plane, in mm
    Returns a number, in mm.
    """
    points = np.asarray(points, float)
    ### BEGIN SOLUTION
    A = np.column_stack([2 * points, np.ones(len(points))])
    c = np.linalg.lstsq(A, (points**2).sum(axis=-1), rcond=None)[0][:3]
    distance = np.linalg.norm(points - c, axis=-1)
    return distance.max() - distance.min()
    ### END SOLUTION


# %%
with once_written():
    holds("the perfect dome", sphericity(dome), 0)
    holds("a third of it, elsewhere", sphericity(dome[40:] + [7, -8, 9]), 0)
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    six_and_eight = np.concatenate([2 * np.eye(3), -2 * np.eye(3), corners])
    holds("six points at 2, eight at √3", sphericity(six_and_eight), 2 - np.sqrt(3))
    holds("in another unit", sphericity(1000 * six_and_eight), 1000 * (2 - np.sqrt(3)))

# %% check="sphericity"
check(sphericity)

# %% [markdown]
# # VI · Be the judge yourself
#
# Every card of this course was written by a judge that has never read a line of your code. It did what anybody can do with a surface:
# choose some $(u, w)$, ask, and look at the points that come back. From those alone it told "right, but $u$ and $w$ are exchanged" from
# "wrong".
#
# You know by now what it looks at. In the last task you take its seat.

# %% [markdown]
# ## 16 · Five ways to be the same
#
# Two black boxes, $f$ and $g$, that give points and nothing else. *Are they the same surface?* Five answers:
#
# | rung | what $f$ and $g$ share |
# |---|---|
# | **same map** | every point, at the same $(u, w)$ |
# | **relabelled** | the same, once $u$ and $w$ were exchanged or run backwards |
# | **same set** | the points, each as often, however traced |
# | **moved** | the shape: a rotation and a shift carry $g(u, w)$ to $f(u, w)$ |
# | **different** | nothing of this |
#
# The first rung from the top that holds is the answer.

# %% [markdown]
# Our $g$ is half a turn of a spiral staircase, and there are eight boxes, A to H, to compare with it. Box B is
# $f(u, w) = g(u^2, w)$. Which rung is that?

# %%
rung_of_B = None  # "same map", "relabelled", "same set", "moved" or "different"


# %% fold=true
def stairs(u, w):
    """g: half a turn of a spiral staircase, right-handed."""
    rho, angle = 1 + 2 * np.asarray(u, float), np.pi * np.asarray(w, float)
    return point(rho * np.cos(angle), rho * np.sin(angle), angle)


def otherwise(u, w):
    """The staircase by another formula."""
    rho, angle = 3 - 2 * (1 - np.asarray(u, float)), np.pi * np.asarray(w, float)
    return point(rho * (1 - 2 * np.sin(angle / 2) ** 2), 2 * rho * np.sin(angle / 2) * np.cos(angle / 2), angle)


BOXES = {
    "A": (otherwise, "same map"),
    "B": (lambda u, w: stairs(np.square(u), w), "same set"),
    "C": (lambda u, w: stairs(1 - np.asarray(w), u), "relabelled"),
    "D": (lambda u, w: stairs(u, np.asarray(w) / 2), "different"),
    "E": (lambda u, w: stairs(np.abs(2 * np.asarray(u) - 1), w), "different"),
    "F": (lambda u, w: stairs(u, w) @ (np.array([[1, -2, 2], [2, 2, 1], [-2, 1, 2]]) / 3) + [1, 0, 4], "moved"),
    "G": (lambda u, w: stairs(u, w) * [1, -1, 1], "different"),
    "H": (lambda u, w: stairs(u, w) * 1.1, "different"),
}
reveal(rung_of_B, BOXES["B"][1])
plot.view(BOXES["B"][0], against=stairs, names=("g", "box B"))

# %% [markdown]
# **What to see.** The same steps, the same rails, and yet the right picture is full of deviations: at the same $(u, w)$ the two are at
# different points, and the orange lines show it. A set of points is one thing, a map is another.
#
# **The second rung.** There are eight ways to relabel the square: exchange $u$ and $w$ or not, run each of them forwards or backwards. Write an F on the
# square. In how many of the eight does it become a mirror-written F?

# %%
mirrored = None  # a number from 0 to 8

# %%
EIGHT = {
    "u, w": lambda u, w: (u, w), "1-u, w": lambda u, w: (1 - u, w),
    "u, 1-w": lambda u, w: (u, 1 - w), "1-u, 1-w": lambda u, w: (1 - u, 1 - w),
    "w, u": lambda u, w: (w, u), "1-w, u": lambda u, w: (1 - w, u),
    "w, 1-u": lambda u, w: (w, 1 - u), "1-w, 1-u": lambda u, w: (1 - w, 1 - u),
}  # fmt: skip
letter = np.array([(0.3, 0.15), (0.3, 0.85), (0.75, 0.85), (0.3, 0.85), (0.3, 0.5), (0.6, 0.5)]).T
square = np.array([(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)]).T
figure = go.Figure().update_layout(height=400, showlegend=False, **PLAIN)
for n, (name, relabelled) in enumerate(EIGHT.items()):
    x, y = 1.4 * (n // 2), -1.6 * (n % 2)
    colour = "#0072B2" if n in (0, 3, 5, 6) else "#D55E00"
    for shape, line in ((square, {"color": "#A6A6A6"}), (letter, {"color": colour, "width": 5})):
        a, b = relabelled(*shape)
        figure.add_scatter(x=x + a, y=y + b, mode="lines", line=line)
    figure.add_annotation(x=x + 0.5, y=y - 0.2, text=name, showarrow=False, font_size=14)
reveal(mirrored, 4)
figure.update_xaxes(visible=False).update_yaxes(visible=False, scaleanchor="x")

# %% [markdown]
# The orange ones are mirror-written, and those are the four whose normal changes sides.
#
# **The third rung.** For "same set" a natural test comes to mind: take many points of $f$, and look whether each of them lies on $g$, that is how far it
# is from the nearest point of $g$.
#
# Box D is the lower half of the staircase. What will the largest of those distances be for D, apart from the width of the grid?

# %%
half_of_it = None  # a number


# %%
def grid_of(f, n=49):
    """n x n points of a surface, (n, n, 3)."""
    t = np.linspace(0, 1, n)
    return np.asarray(f(t[:, None], t[None, :]), float)


def farthest(f, g):
    """How far a point of f can be from the nearest point of g, up to the width of the grid."""
    X, Y = grid_of(f).reshape(-1, 3), grid_of(g).reshape(-1, 3)
    return max(np.linalg.norm(Y - x, axis=-1).min() for x in X)


def area(f):
    """Area, added up from the two triangles of each mesh; what is covered twice counts twice."""
    p = grid_of(f)
    rising, falling = p[1:, 1:] - p[:-1, :-1], p[:-1, 1:] - p[1:, :-1]
    return np.linalg.norm(np.cross(rising, falling), axis=-1).sum() / 2


# %% [markdown]
# ### A trap: half of the truth

# %%
reveal(half_of_it, 0)
for name in "BDE":
    f = BOXES[name][0]
    ways = f"f to g {farthest(f, stairs):.2f}   g to f {farthest(stairs, f):.2f}"
    print(f"box {name}   {ways}   area {area(f) / area(stairs):.2f} of that of g")

# %% [markdown]
# **What went wrong?** All of D lies on $g$ (0.10 is the width of the grid, on a staircase of size 7); but much of $g$ is far from D. So the
# distance is taken *both* ways. That unmasks D, and still not E, which covers every step twice: there the area tells.

# %% [markdown]
# **The fourth rung.** No need to try all rotations. If $f$ is $g$ moved, the mean of its points is the moved mean; and with the means taken away,
# one matrix product and its singular values give the best rotation of all. That is `carried`. The sign in it keeps a mirror out: a
# left-handed staircase is not a right-handed one, moved.


# %%
def carried(X, Y):
    """X (n, 3), turned and shifted as a rigid body to where it is nearest to Y, point by point."""
    x, y = X - X.mean(axis=0), Y - Y.mean(axis=0)
    left, _, right = np.linalg.svd(x.T @ y)
    hand = np.sign(np.linalg.det(left @ right))
    return x @ left @ np.diag([1, 1, hand]) @ right + Y.mean(axis=0)


# %% [markdown]
# **Task (same_surface).** Return `"same map"`, `"relabelled"`, `"same set"`, `"moved"` or `"different"`: the first that holds.
#
# What agrees in our data agrees to $10^{-9}$ of the size, so $10^{-6}$ is a safe border for the rungs that compare point by point. On the
# rung of sets your grid has a width: there a twentieth of the size separates right from wrong, in distance and in area. You may use `EIGHT`, `grid_of`,
# `farthest`, `area` and `carried`.


# %% solution="same_surface"
def same_surface(f, g):
    """How f and g are related: 'same map', 'relabelled', 'same set', 'moved' or 'different'.

    f, g : surfaces, functions of u and w in [0, 1] that give points (..., 3)
    """
    X, Y = grid_of(f).reshape(-1, 3), grid_of(g).reshape(-1, 3)
    size = np.linalg.norm(np.ptp(Y, axis=0))
    ### BEGIN SOLUTION
    if np.abs(X - Y).max() <= 1e-6 * size:
        return "same map"
    for to in EIGHT.values():
        if np.abs(grid_of(lambda u, w, to=to: f(*to(u, w))).reshape(-1, 3) - Y).max() <= 1e-6 * size:
            return "relabelled"
    if max(farthest(f, g), farthest(g, f)) < size / 25 and abs(area(f) / area(g) - 1) < 1 / 40:
        return "same set"
    return "moved" if np.abs(carried(X, Y) - Y).max() <= 1e-6 * size else "different"
    ### END SOLUTION


# %%
with once_written():
    print("g and g, wanted same map:", same_surface(stairs, stairs))
    for name, (f, wanted) in BOXES.items():
        print(f"box {name}, wanted {wanted}: {same_surface(f, stairs)}")

# %% check="same_surface"
check(same_surface)

# %% [markdown]
# **What to keep.** Each rung asks less than the one above, so the order matters: what is relabelled is a same set as well, and only the first true
# word is the whole truth. And every rung *can fail*. A test that cannot fail says nothing.

# %% [markdown]
# ### In your own words
#
# A supplier replaces a surface of your drawing by one of his own, with other parameters. Your judge says: *same set*.
#
# In three or four sentences: **for what is his surface as good as yours, for what is it not, and what could your judge have overlooked, since
# it has only seen samples?**
#
# *3 points: one for a use to which only the set of points matters; one for a use to which the parameters matter; one for a fault that can hide from
# samples, with how you would look for it.*

# %% [markdown] written="what_a_judge_can_know" points=3
# ### BEGIN SOLUTION
# For all that only asks where the material is, his surface is as good: area, volume, weight, collisions, a measured form error, a
# casting mould.
#
# Where parameters mean something it is not: joining it to a neighbour along an edge with equal derivatives, a Coons patch or a ruled
# surface hung on its edges (lines join points of equal parameter), tool paths along u, a texture, places noted as (u, w). Its derivatives differ,
# and if the tracing stands still somewhere, so does the formula for its normal.
#
# The judge looked at a grid. A bump or a hole narrower than its meshes, or a deviation below its tolerance, passes. One looks with a finer grid, at
# places that are not on a regular grid, near edges and corners, and along knot lines, where pieces meet.
# ### END SOLUTION

# %% [markdown]
# ## If you want more
#
# * Let your judge say *which* of the eight it was, and whether the normal changed sides.
# * Box G is a left-handed staircase: "different". Add a rung for mirror images. Where in the ladder does it belong?
# * Deceive your judge: write an `f` that differs from $g$ somewhere and is called the same map. Then mend the judge.
# * Let it compare your cylinders: the formula (A1), swept (A2), turned (A3), ruled (A4).
#
# That was the course. In its first notebook you asked us whether your cylinder was right. From here on you can ask the cylinder.
