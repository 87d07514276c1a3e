# %% [markdown]
# # A3 · Circular sweep
#
# **A lathe turns a profile about an axis. After a whole turn nobody can tell which way it went. So does the sense matter?**
#
# You will write five functions: the sweep about $y$, about any coordinate axis, the lecture's cone, an axis in the $xy$-plane, and
# any axis at all. That takes about two hours. Predict, look, write, test it yourself, check.

# %% [markdown]
# ## What holds everywhere
#
# * $u$ is the curve's own parameter; $w$ is the share of the turn: at $w = 0$ the curve is where it was, at $w = 1$ it has
#   turned by `angle`, in radians. A whole turn if nothing is said.
# * **The sense is the right-hand rule**: right thumb along the axis, the fingers show the way. Seen with the axis pointing *at*
#   you, that is anticlockwise.
# * Curves come as functions, as in A2. They need not be flat.
#
# Run the next cell first.

# %% setup=true

# %% [markdown]
# ## 1 · Which way is positive?
#
# Point your right thumb along $+y$. Your fingers now carry $+z$ to another axis: to which, $+x$ or $-x$?

# %%
z_goes_to = None  # "+x" or "-x"

# %% fold=true
reveal(z_goes_to, "+x, and +x goes on to -z")

turn = np.linspace(0, 0.5 * np.pi, 60)
figure = go.Figure().update_layout(height=280, width=420, template="none", showlegend=False)
figure.update_layout(margin={"l": 5, "r": 5, "t": 40, "b": 5}, title="y points at you")
for x, y, text in ((1.25, 0, "z"), (0, 1.25, "x")):
    figure.add_annotation(x=x, y=y, ax=0, ay=0, axref="x", ayref="y", arrowhead=2, text="")
    figure.add_annotation(x=1.1 * x, y=1.1 * y, text=f"<b>{text}</b>", font={"size": 16}, showarrow=False)
style = {"width": 5, "color": "#D55E00"}
figure.add_scatter(x=np.cos(turn), y=np.sin(turn), mode="lines", line=style)
tip = {"size": 16, "symbol": "triangle-left", "color": "#D55E00"}
figure.add_scatter(x=[0.04], y=[1], mode="markers", marker=tip)
figure.add_scatter(x=[0], y=[0], mode="markers+text", text=["y"], textposition="bottom left")
figure.update_xaxes(visible=False, range=[-0.5, 1.6])
figure.update_yaxes(visible=False, scaleanchor="x", range=[-0.25, 1.5])

# %% [markdown]
# ## 2 · The two curves of today
#
# A flat profile in the $xy$-plane, as for a lathe, and one that leaves the plane. To turn a point you need its coordinates one
# by one: `np.moveaxis(points, -1, 0)` gives $x$, $y$ and $z$, each of the shape of $u$. With a `w` they broadcast as usual.


# %%
def profile(t):
    t = np.asarray(t)
    return np.stack([2 + np.sin(2 * t), 3 * t - 0.5, 0 * t], axis=-1)


def spatial(t):
    t = np.asarray(t)
    return np.stack([2 + t, 3 * t - 0.5, 0.7 - t**2], axis=-1)


u, w = np.linspace(0, 1, 9)[:, None], np.linspace(0, 1, 9)[None, :]
x, y, z = np.moveaxis(spatial(u), -1, 0)
print("x has shape", x.shape, "and x * cos(w) has", (x * np.cos(w)).shape)
plot.view(spatial, curves={"the flat profile": profile})

# %% [markdown]
# ## 3 · About the y axis
#
# The board in the lecture shows, for a flat profile, $X = x\cos t,\; Y = y,\; Z = \pm x\sin t$, and says that the sign gives
# *"positive and negative sense"*, but not which is which. Here is the form with $+$.
#
# Is it the positive sense of the right-hand rule?

# %%
plus_is_positive = None  # True or False


# %%
def board(u, w, curve=profile, angle=2 * np.pi):
    """x cos t, y, + x sin t"""
    x, y, _ = np.moveaxis(curve(u), -1, 0)
    t = angle * np.asarray(w)
    return np.stack(np.broadcast_arrays(x * np.cos(t), y, x * np.sin(t)), axis=-1)


reveal(plus_is_positive, "False: a quarter turn takes +x to +z, and the fingers take it to -z")
plot.view(board, title="a vase, whichever sign you take")

# %% [markdown]
# **What you cannot see.** The other sign gives exactly the same picture: a whole turn hides the sense. Keep that in mind until
# you have your own.
#
# And the board form knows nothing of $z$. Before any formula, say what must hold for every curve: turning about $y$ changes
# neither $y$ nor the distance from the axis, $x^2 + z^2$.

# %% [markdown]
# **Task (revolve_y).** Turn *any* curve about the $y$ axis, positive sense: $+z$ goes to $+x$, and $+x$ goes to $-z$.
#
# A point with $x$ *and* $z$ is the sum of one on the $x$ axis and one on the $z$ axis. Where does each of them go?


# %% solution="revolve_y"
def revolve_y(u, w, curve, angle=2 * np.pi):
    """Turn the curve about the y axis by angle * w, right-hand sense.

    u, w : numbers or arrays in [0, 1];  curve : function of t in [0, 1], points (..., 3)
    angle : radians
    Returns points, shape of u and w together + (3,).
    """
    x, y, z = np.moveaxis(curve(u), -1, 0)
    t = angle * np.asarray(w)
    ### BEGIN SOLUTION
    turned = x * np.cos(t) + z * np.sin(t), y, z * np.cos(t) - x * np.sin(t)
    return np.stack(np.broadcast_arrays(*turned), axis=-1)
    ### END SOLUTION


# %%
with once_written():
    display(plot.view(lambda u, w: revolve_y(u, w, spatial, angle=np.pi / 3), square=True))

# %%
with once_written():
    start, turned = spatial(u), revolve_y(u, w, spatial)
    holds("w = 0 is the curve", revolve_y(u, 0, spatial), start)
    holds("y stays", turned[..., 1], start[..., 1])
    holds("x² + z² stays", (turned[..., ::2] ** 2).sum(-1), (start[..., ::2] ** 2).sum(-1))
    holds("a whole turn closes", revolve_y(u, 1, spatial), start)
    on_z = revolve_y(0, 1, lambda t: np.array([0, 0, 1.0]), np.pi / 2)
    holds("a quarter turn takes +z to +x", on_z, (1, 0, 0))

# %% check="revolve_y"
check(revolve_y)

# %% [markdown]
# ### A trap: a whole turn cannot see the sense
#
# Left your sweep of the flat profile, right the board's. Run it as it is and compare the shapes. Then write
# `angle = np.pi / 3` and run it again.

# %%
angle = 2 * np.pi


def mine(u, w):
    return revolve_y(u, w, profile, angle)


def boards(u, w):
    return board(u, w, profile, angle)


with once_written():
    display(plot.view(boards, against=mine, names=("yours", "the board's")))

# %% [markdown]
# **What changed?** The same shape twice, only with $w$ running the other way; and then two wedges on *different sides* of the
# $xy$-plane. The flat profile is blind as well: it hides every term with $z$. That is why you were asked for a curve in space,
# and why the check also turns by less than a whole turn.

# %% [markdown]
# ## 4 · About x, y or z
#
# *"One has to basically change these equations slightly."* Slightly, but with care. The three axes follow each other in a ring,
# $x \to y \to z \to x$. About $z$, $x$ goes towards $y$. Move every letter on by one place: about $x$, $y$ goes towards $z$;
# about $y$, $z$ goes towards $x$.
#
# Two rows change in each of the three. Where does the minus sine stand in the *lower* of the two?

# %%
odd_one = None  # "x", "y" or "z"

# %% [markdown]
# **Task (revolve_coord).** `axis` is `'x'`, `'y'` or `'z'`. You may call `revolve_y`. As a minus wanders easily, test each axis
# by itself.
#
# The rival convention: some books write points as rows and multiply from the left. Their matrices are the transposes of ours;
# mixed up, everything turns backwards.


# %% solution="revolve_coord"
def revolve_coord(u, w, curve, axis, angle=2 * np.pi):
    """Turn the curve about the axis 'x', 'y' or 'z' by angle * w, right-hand sense.

    u, w : numbers or arrays in [0, 1];  curve : function of t in [0, 1], points (..., 3)
    angle : radians
    Returns points, shape of u and w together + (3,).
    """
    x, y, z = np.moveaxis(curve(u), -1, 0)
    t = angle * np.asarray(w)
    c, s = np.cos(t), np.sin(t)
    ### BEGIN SOLUTION
    turned = {
        "x": (x, y * c - z * s, y * s + z * c),
        "y": (x * c + z * s, y, z * c - x * s),
        "z": (x * c - y * s, x * s + y * c, z),
    }[axis]
    return np.stack(np.broadcast_arrays(*turned), axis=-1)
    ### END SOLUTION


# %%
reveal(odd_one, "y: -x sin t, in the row of z; about x and z it stands in the earlier row")
with once_written():
    for i, axis in enumerate("xyz"):
        turned, start = revolve_coord(u, w, spatial, axis), spatial(u)
        holds(f"{axis}: the coordinate along the axis stays", turned[..., i], start[..., i])
        holds(f"{axis}: |S| stays", (turned**2).sum(-1), (start**2).sum(-1))
    holds("y is revolve_y", revolve_coord(u, w, spatial, "y"), revolve_y(u, w, spatial))
    unit = np.eye(3)
    for a, axis, b in ((1, "x", 2), (2, "y", 0), (0, "z", 1)):
        quarter_turn = revolve_coord(0, 1, lambda t, a=a: unit[a], axis, np.pi / 2)
        holds(f"about {axis}: {'xyz'[a]} goes to {'xyz'[b]}", quarter_turn, unit[b])

# %% check="revolve_coord"
check(revolve_coord)

# %% [markdown]
# ## 5 · A line becomes a cone
#
# The lecture's own example: a straight line in the $xy$-plane, from $a$ to $b$, turned once about $y$. In A1 you built the
# frustum from radii and a height, and $u$ went round. Which of your two parameters goes round now?

# %%
goes_round = None  # "u" or "w"

# %% [markdown]
# **Task (cone_from_line).** $a$ and $b$ have $z = 0$. $u$ runs from $a$ to $b$, $w$ once round $y$ in the positive sense. You may
# call your own functions.
#
# Somebody asked whether a cone needs its axis as an extra input. No: *"once you say that the directrix is a circle, its axis is
# defined."*


# %% solution="cone_from_line"
def cone_from_line(u, w, a, b):
    """Turn the straight line from a to b once about the y axis, right-hand sense.

    u, w : numbers or arrays in [0, 1];  a, b : points (3,) in the xy-plane
    Returns points, shape of u and w together + (3,).
    """
    a, b = np.asarray(a, float), np.asarray(b, float)
    ### BEGIN SOLUTION
    return revolve_y(u, w, lambda t: a + np.asarray(t)[..., None] * (b - a))
    ### END SOLUTION


# %%
a, b = np.array([3.0, 0.0, 0.0]), np.array([1.0, 2.0, 0.0])
with once_written():
    reveal(goes_round, "w")
    display(plot.view(lambda u, w: cone_from_line(u, w, a, b), square=True))

# %%
with once_written():
    cone = cone_from_line(u, w, a, b)
    holds("w = 0 is the line", cone[:, 0], a + u * (b - a))
    radius = np.hypot(cone[..., 0], cone[..., 2])
    holds("the radius falls evenly: √(x² + z²) = 3 - 2u", radius, 3 - 2 * u)
    holds("with b on the axis, u = 1 is one point", cone_from_line(1, w, a, (0, 2, 0)), (0, 2, 0))
    holds("a quarter of the way round, a is on -z", cone_from_line(0, 0.25, a, b), (0, 0, -3))

# %% check="cone_from_line"
check(cone_from_line)

# %% [markdown]
# **What changes?** Put $b$ on the axis, $(0, 2, 0)$: the complete cone. Put it straight above $a$, $(3, 2, 0)$: a cylinder, with
# $u$ and $w$ the other way round than in A1. Beside $a$, $(1, 0, 0)$: a flat ring. One function, four known forms.

# %% [markdown]
# ## 6 · An axis in the xy-plane
#
# An axis through the origin that makes the angle $\alpha$ with $x$. There is no new formula, only a plan: **transform, sweep,
# transform back.** Turn everything about $z$ so that the axis lies on $x$; turn about $x$, which you know; undo the first turn.
#
# About $z$, by which angle is the first turn?

# %%
first_turn = None  # "+alpha" or "-alpha"


# %%
def Rz(angle):
    """Matrix of a turn about z, for columns. Our points are rows: points @ Rz(angle).T"""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


alpha = np.pi / 6
axis = np.array([np.cos(alpha), np.sin(alpha), 0])
laid = axis @ Rz(-alpha).T
reveal(first_turn, f"-alpha: it takes the axis to {np.round(laid, 12) + 0.0}")
plot.view(spatial, curves={
    "axis": [-axis, 5 * axis], "axis, laid onto x": [-laid, 5 * laid],
    "curve, turned with it": lambda t: spatial(t) @ Rz(-alpha).T,
})  # fmt: skip

# %% [markdown]
# **Task (revolve_xy_axis).** In one line of mathematics, read from right to left:
#
# $$S(u, w) = R_z(\alpha)\; R_x(\text{angle}\cdot w)\; R_z(-\alpha)\; C(u)$$
#
# You may use `Rz` and your own `revolve_coord`.


# %% solution="revolve_xy_axis"
def revolve_xy_axis(u, w, curve, alpha, angle=2 * np.pi):
    """Turn the curve about the axis (cos alpha, sin alpha, 0) by angle * w, right-hand sense.

    u, w : numbers or arrays in [0, 1];  curve : function of t in [0, 1], points (..., 3)
    alpha : direction of the axis in radians, from +x towards +y;  angle : radians
    Returns points, shape of u and w together + (3,).
    """
    ### BEGIN SOLUTION
    return revolve_coord(u, w, lambda t: curve(t) @ Rz(-alpha).T, "x", angle) @ Rz(alpha).T
    ### END SOLUTION


# %%
with once_written():
    line = {"axis": [-axis, 5 * axis]}
    display(plot.view(lambda u, w: revolve_xy_axis(u, w, spatial, alpha, np.pi), curves=line))

# %%
with once_written():
    turned, start = revolve_xy_axis(u, w, spatial, alpha), spatial(u)
    holds("the coordinate along the axis stays", turned @ axis, start @ axis)
    holds("|S| stays", (turned**2).sum(-1), (start**2).sum(-1))
    holds("w = 0 is the curve", turned[:, 0], start[:, 0])
    fixed = revolve_xy_axis(0, w, lambda t: 3 * axis, alpha)
    holds("points of the axis stay", fixed, 3 * axis)
    holds("alpha = 0 is x", revolve_xy_axis(u, w, spatial, 0), revolve_coord(u, w, spatial, "x"))
    y_axis = revolve_xy_axis(u, w, spatial, np.pi / 2)
    holds("alpha = π/2 is y", y_axis, revolve_coord(u, w, spatial, "y"))

# %% check="revolve_xy_axis"
check(revolve_xy_axis)

# %% [markdown]
# The last line of that test is a gift: $\alpha = \pi/2$ goes through $x$ and $z$ only, and still has to agree with your $y$. If
# a sign in $y$ were wrong, you would know now.

# %% [markdown]
# ### In your own words
#
# Read $R_z(\alpha)\,R_x(t)\,R_z(-\alpha)$ from right to left.
#
# In three or four sentences: **what does each of the three factors do to the curve, and what would the surface be if somebody
# forgot the leftmost one?**
#
# *3 points: one for the order and the first factor; one for the middle one; one for what the last one undoes, with the shape and
# the place of the surface that comes out without it.*

# %% [markdown] written="three_factors" points=3
# ### BEGIN SOLUTION
# The rightmost factor comes first: Rz(-alpha) turns axis and curve together about z until the axis lies on x. Rx(t) then turns the
# curve about x, the sweep that we know. Rz(alpha) turns everything back, so that the axis is where it was.
#
# Without the leftmost factor the surface has the right shape and size but lies about the x axis: the wanted surface, turned by
# -alpha about z. At w = 0 it shows the laid curve instead of the curve itself.
# ### END SOLUTION

# %% [markdown]
# ## 7 · Any axis
#
# A line through a point $p$ with a direction $k$, now of length 1. Let $v = C(u) - p$. The part of $v$ along $k$ stays; the part
# across turns in its plane, of which $k \times v$ is the other direction:
#
# $$S = p + v\cos t + (k\times v)\sin t + (k\cdot v)\,k\,(1 - \cos t), \qquad t = \text{angle}\cdot w$$
#
# Somebody gives the axis as $(1, 2, 2)$, somebody else as $(2, 4, 4)$. Should that change the surface?

# %%
length_matters = None  # True or False

# %% [markdown]
# **Task (revolve_axis).** `axis` has any length but 0; `(0, 0, 0)` is a `ValueError`. Mind the shapes: `v` is `(..., 3)`, so the
# cosine needs an axis of its own, `[..., None]`.


# %% solution="revolve_axis"
def revolve_axis(u, w, curve, point, axis, angle=2 * np.pi):
    """Turn the curve about the line through point in the direction axis by angle * w, right-hand sense.

    u, w : numbers or arrays in [0, 1];  curve : function of t in [0, 1], points (..., 3)
    point : (3,), on the axis;  axis : (3,), any length but 0;  angle : radians
    Returns points, shape of u and w together + (3,). Raises ValueError for an axis (0, 0, 0).
    """
    point, axis = np.asarray(point, float), np.asarray(axis, float)
    v = curve(u) - point
    t = angle * np.asarray(w)[..., None]
    ### BEGIN SOLUTION
    length = np.linalg.norm(axis)
    if length == 0:
        raise ValueError("the axis must not be (0, 0, 0)")
    k = axis / length
    along = (v @ k)[..., None] * k
    return point + v * np.cos(t) + np.cross(k, v) * np.sin(t) + along * (1 - np.cos(t))
    ### END SOLUTION


# %%
point, k = np.array([1.0, 0.0, -1.0]), np.array([1.0, 2.0, 2.0]) / 3
with once_written():
    turned, start = revolve_axis(u, w, spatial, point, k), spatial(u)
    reveal(length_matters, False)
    longer = revolve_axis(u, w, spatial, point, 6 * k)
    holds("the length of the axis does not matter", longer, turned)
    elsewhere = revolve_axis(u, w, spatial, point + 5 * k, k)
    holds("nor where on the axis the point is", elsewhere, turned)
    distance = np.linalg.norm(turned - point, axis=-1)
    holds("|S - p| stays", distance, np.linalg.norm(start - point, axis=-1))
    holds("(S - p)·k stays", (turned - point) @ k, (start - point) @ k)
    about_z = revolve_axis(u, w, spatial, (0, 0, 0), (0, 0, 1))
    holds("about z it is what you had", about_z, revolve_coord(u, w, spatial, "z"))

# %%
with once_written():
    line = {"axis": [point - k, point + 5 * k]}
    turn = 4 * np.pi / 3
    display(plot.view(lambda u, w: revolve_axis(u, w, spatial, point, k, turn), curves=line))

# %% check="revolve_axis"
check(revolve_axis)

# %% [markdown]
# ## If you want more
#
# * Turn the line from $(1, 0, -1)$ to $(1, 2, 1)$ about $z$. It neither meets the axis nor is parallel to it. What is that, and
#   where have you seen it beside a power station?
# * Add $w\cdot\text{pitch}$ along the axis while you turn: a screw. Is it still closed in $w$?
# * Which of your sweeps give $u$ and $w$ the same roles as the known forms of A1, and which exchange them?
#
# Next: **A4**, where any curve may be the directrix.
