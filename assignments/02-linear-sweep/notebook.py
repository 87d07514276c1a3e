# %% [markdown]
# # A2 · Linear sweep
#
# **An extruded beam is drawn as one profile and one arrow. What exactly must the arrow say?**
#
# You will write six functions: one for the arrow, two for the sweep, and the smallest sweeps of all, a plane and a triangle. That
# takes about two hours. Predict, look, write, test it yourself, check. Later functions may call your earlier
# ones.

# %% [markdown]
# ## What holds everywhere
#
# * The curve that is swept is the **generatrix**; $u$ is its parameter. The line that guides it is the **directrix**; $w$ says
#   how far along it we are.
# * $u$ and $w$ lie in $[0, 1]$, numbers or arrays that broadcast. The answer has their shape together, plus `(3,)`.
# * Points and vectors are arrays `(3,)`; all lengths have one unit.
# * Where no surface exists, say so: raise a `ValueError`.
#
# Run the next cell first.

# %% setup=true
from autograder import personal

personal.course("workbook")  # your own numbers come from this word and your id

# %% [markdown]
# ## 1 · What goes into a sweep?
#
# *"The curve can be any curve, closed or open."* So it comes as a function: `curve(t)` gives the points for any array of
# parameters. Here is the one that we sweep today.
#
# Give it a column of five parameters, of shape `(5, 1)`. What shape do the points have?

# %%
shape = None  # for example (5, 3)


# %%
def arc(t):
    """An open curve in space."""
    t = np.asarray(t)
    return np.stack([2 * np.cos(np.pi * t), 1 + t**2, 3 * t * (1 - t)], axis=-1)


u = np.linspace(0, 1, 5)[:, None]
w = np.linspace(0, 1, 4)[None, :]
reveal(shape, arc(u).shape)
plot.view(arc)

# %% [markdown]
# ## 2 · How do a column and a row meet?
#
# To move the curve, every point gets a share $w$ of an arrow added. The points are `(5, 1, 3)`, the row `w` is `(1, 4)`, and
# the arrow is `(3,)`. One of these two lines works:
#
# * **A** `arc(u) + w * arrow`
# * **B** `arc(u) + w[..., None] * arrow`

# %%
works = None  # "A" or "B"

# %%
arrow = np.array([2.0, 4.0, 4.0])
recipes = {"A": lambda: arc(u) + w * arrow, "B": lambda: arc(u) + w[..., None] * arrow}
reveal(works, "B")
for name, recipe in recipes.items():
    try:
        print(name, "gives points of shape", recipe().shape)
    except ValueError as error:
        print(name, "fails:", error)

# %% [markdown]
# **What went wrong in A?** numpy lines shapes up from the right, so it set the 4 of `w` against the 3 of the arrow. `[..., None]`
# gives `w` an axis of its own for $x, y, z$: shapes `(5, 1, 3)` and `(1, 4, 3)` make `(5, 4, 3)`.
#
# A plain number has no `[..., None]`. Write `np.asarray(w)[..., None]` and the line serves numbers as well.

# %% [markdown]
# ## 3 · Which way, and how far?
#
# An arrow from $a$ to $b$ says two things: a direction $(l, m, n)$ of length 1, and a distance $d$.
#
# $$d\,l = x_b - x_a, \qquad d\,m = y_b - y_a, \qquad d\,n = z_b - z_a$$
#
# $l, m, n$ are the *cosines* of the angles with the axes, so $l^2 + m^2 + n^2 = 1$. (Some tables print the angles themselves.)
#
# How far is it from $(1, -2, 3)$ to $(4, 2, 15)$?

# %%
distance = None

# %% [markdown]
# **Task (direction_cosines).** Return the four numbers $l, m, n, d$ in one array. If $a$ and $b$ are the same point there is no
# direction: raise a `ValueError`.


# %% solution="direction_cosines"
def direction_cosines(a, b):
    """The array (l, m, n, d): the unit direction from a to b, and their distance.

    a, b : points (3,)
    Raises ValueError where a = b.
    """
    a, b = np.asarray(a, float), np.asarray(b, float)
    ### BEGIN SOLUTION
    d = np.linalg.norm(b - a)
    if d == 0:
        raise ValueError(f"a and b must differ; both are {a}")
    return np.array([*(b - a) / d, d])
    ### END SOLUTION


# %%
a, b = np.array([1.0, -2.0, 3.0]), np.array([4.0, 2.0, 15.0])
with once_written():
    *lmn, d = direction_cosines(a, b)
    reveal(distance, d)
    holds("l² + m² + n² = 1", np.dot(lmn, lmn), 1)
    holds("d (l, m, n) = b - a", d * np.array(lmn), b - a)
    holds("from b to a is the other way", direction_cosines(b, a), [*(-np.array(lmn)), d])

# %% check="direction_cosines"
check(direction_cosines)

# %% [markdown]
# ### A trap: data that cannot see
#
# Three classmates compare their answers with yours on the arrow from $(0, 0, 0)$ to $(1, 0, 0)$. Run the cell. Then take your
# own points: put `trap = (a, b)` and run it again.

# %%
trap = (np.zeros(3), np.array([1.0, 0.0, 0.0]))
classmates = {
    "Asha ": lambda a, b: [*(b - a), np.linalg.norm(b - a)],
    "Bruno": lambda a, b: [*(b - a) / np.linalg.norm(b - a), np.abs(b - a).sum()],
    "Chen ": lambda a, b: [*(b - a) / np.linalg.norm(b - a), ((b - a) ** 2).sum()],
}
with once_written():
    for name, answer in classmates.items():
        holds(f"{name} agrees with you", answer(*trap), direction_cosines(*trap))

# %% [markdown]
# **Who made which mistake?** One took the components for cosines, one added up the three steps, one forgot the root. On a step
# of length 1 along an axis all three are invisible. An arrow such as $(3, 4, 12)$ sees them all.

# %% [markdown]
# ## 4 · Sweep by direction and distance
#
# $$S(u, w) = C(u) + w\,d\,(l, m, n)$$
#
# Two things must hold without any model answer: $S(u, 0) = C(u)$, and every point travels the same way, $|d|$.
#
# Suppose the direction is given as $(1, 2, 2)$ with $d = 6$, and somebody adds $w\,d\,(1, 2, 2)$. How far do the points travel?

# %%
travelled = None

# %% [markdown]
# **Task (linear_sweep).** The direction may have any length but 0; only where it points matters. A direction `(0, 0, 0)` is a
# `ValueError`. A negative $d$ goes the other way.


# %% solution="linear_sweep"
def linear_sweep(u, w, curve, direction, d):
    """Sweep the curve the distance d along the direction.

    u, w : numbers or arrays in [0, 1];  curve : function of t in [0, 1], points (..., 3)
    direction : (3,), not 0;  d : length
    Returns points, shape of u and w together + (3,). Raises ValueError for a direction (0, 0, 0).
    """
    direction = np.asarray(direction, float)
    ### BEGIN SOLUTION
    length = np.linalg.norm(direction)
    if length == 0:
        raise ValueError("the direction must not be (0, 0, 0)")
    return curve(u) + np.asarray(w)[..., None] * d * direction / length
    ### END SOLUTION


# %%
with once_written():
    display(plot.view(lambda u, w: linear_sweep(u, w, arc, (1, 2, 2), d=6), square=True))

# %%
with once_written():
    sweep = linear_sweep(u, w, arc, (1, 2, 2), 6)
    holds("w = 0 is the curve", sweep[:, 0], arc(u)[:, 0])
    way = np.linalg.norm(linear_sweep(u, 1, arc, (1, 2, 2), 6) - arc(u), axis=-1)
    holds("every point travels d", way, 6)
    holds("the length of the direction does not matter", sweep, linear_sweep(u, w, arc, (2, 4, 4), 6))
    print("one point has shape", np.shape(linear_sweep(0.5, 0.5, arc, (1, 2, 2), 6)))

# %% [markdown]
# ### An arrow of your own
#
# Type your id in this course: everybody gets another arrow. `check` knows yours too, as the data `yours`.
#
# `arc` starts in $(2, 1, 0)$. Run the cell, and work out by hand where that point arrives. Whose point travels
# further, yours or your neighbour's: who has the longer direction, or who has the larger $d$?

# %%
student = ""  # your id, between the quotation marks

rng = personal.numbers("linear_sweep", student)
direction, d = rng.integers(1, 6, 3), rng.integers(2, 7)
print("Your direction is", direction, "and your d is", d)

# %%
arrival = None  # for example (2, 4, 4)

# %%
with once_written():
    reveal(arrival, linear_sweep(0, 1, arc, direction, d))

# %% check="linear_sweep"
check(linear_sweep)

# %% [markdown]
# ### The wrong picture beside the right one
#
# Left your sweep, right that of a classmate, coloured by how far it is off. Which mistake made it?


# %%
def from_a_classmate(u, w):
    return arc(u) + np.asarray(w)[..., None] * 6 * np.array([1, 2, 2])


def mine(u, w):
    return linear_sweep(u, w, arc, direction=(1, 2, 2), d=6)


reveal(travelled, np.linalg.norm(from_a_classmate(0, 1) - arc(0)))
with once_written():
    display(plot.view(from_a_classmate, against=mine, names=("yours", "a classmate's")))

# %% [markdown]
# **What to see.** Dark at $w = 0$, bright at $w = 1$: right where it starts, and wrong in proportion to $w$. So the arrow points
# the right way and is too long. With the direction $(0, 0, 1)$ nobody would ever have noticed.

# %% [markdown]
# ## 5 · Sweep by two points
#
# The second way to give the arrow: two points $a$ and $b$, which *"need not lie anywhere on the curve"*. Both direction and
# distance are in them. Written out, the lecture's three lines are $(x_b - x_a)\,w$, $(y_b - y_a)\,w$, $(z_b - z_a)\,w$; the
# transcript garbles the last two.
#
# Sweep `arc` from $a = (1, -2, 3)$ to $b = (2, 0, 7)$. Where does the surface begin, at $S(0, 0)$?

# %%
start = None  # "at a" or "at C(0)"

# %% [markdown]
# **Task (linear_sweep_points).** Move the curve by the vector from $a$ to $b$.


# %% solution="linear_sweep_points"
def linear_sweep_points(u, w, curve, a, b):
    """Sweep the curve by the vector from the point a to the point b.

    u, w : numbers or arrays in [0, 1];  curve : function of t in [0, 1], points (..., 3)
    a, b : points (3,)
    Returns points, shape of u and w together + (3,).
    """
    a, b = np.asarray(a, float), np.asarray(b, float)
    ### BEGIN SOLUTION
    return curve(u) + np.asarray(w)[..., None] * (b - a)
    ### END SOLUTION


# %%
a, b = np.array([1.0, -2.0, 3.0]), np.array([2.0, 0.0, 7.0])
with once_written():
    sweep = linear_sweep_points(u, w, arc, a, b)
    reveal(start, "at C(0)")
    holds("S(0, 0) = C(0)", sweep[0, 0], arc(0))
    aside = np.array([10.0, -20.0, 30.0])
    moved = linear_sweep_points(u, w, arc, a + aside, b + aside)
    holds("moving both points aside changes nothing", sweep, moved)
    *lmn, far = direction_cosines(a, b)
    holds("it is linear_sweep with their direction", sweep, linear_sweep(u, w, arc, lmn, far))

# %% check="linear_sweep_points"
check(linear_sweep_points)

# %% [markdown]
# ## 6 · A line swept along a line
#
# Take the segment from $p_1$ to $p_2$ as the generatrix, and sweep it from $p_1$ to $p_3$: a plane patch. Every point satisfies
# $(S - p_1)\cdot n = 0$ with $n = (p_2 - p_1)\times(p_3 - p_1)$.
#
# Three corners are given; the fourth follows. With $p_1 = (1, 2, 0)$, $p_2 = (4, 1, 2)$, $p_3 = (0, 5, 3)$: what is $S(1, 1)$?

# %%
fourth = None  # for example (1, 1, 1)

# %% [markdown]
# **Task (plane3).** $S(0,0) = p_1$, $S(1,0) = p_2$, $S(0,1) = p_3$.
#
# In the lecture the line is said to go "from P2 to P1", while its formula goes from $P_1$ to $P_2$; and the plane first appears
# with $u$ alone, until the lecturer adds $w$. We follow the formulas.


# %% solution="plane3"
def plane3(u, w, p1, p2, p3):
    """The plane patch with S(0, 0) = p1, S(1, 0) = p2, S(0, 1) = p3.

    u, w : numbers or arrays in [0, 1];  p1, p2, p3 : points (3,), not on one line
    Returns points, shape of u and w together + (3,).
    """
    p1, p2, p3 = np.asarray(p1, float), np.asarray(p2, float), np.asarray(p3, float)
    u, w = np.asarray(u)[..., None], np.asarray(w)[..., None]
    ### BEGIN SOLUTION
    return p1 + u * (p2 - p1) + w * (p3 - p1)
    ### END SOLUTION


# %%
corners = p1, p2, p3 = np.array([1.0, 2, 0]), np.array([4.0, 1, 2]), np.array([0.0, 5, 3])
with once_written():
    reveal(fourth, plane3(1, 1, *corners))
    normal = np.cross(p2 - p1, p3 - p1)
    holds("in the plane: (S - p1)·n = 0", (plane3(u, w, *corners) - p1) @ normal)
    holds("S(0, 0) = p1", plane3(0, 0, *corners), p1)
    holds("S(1, 0) = p2", plane3(1, 0, *corners), p2)
    holds("S(0, 1) = p3", plane3(0, 1, *corners), p3)

# %% check="plane3"
check(plane3)

# %% [markdown]
# ## 7 · Half a parallelogram
#
# Three points also bound a triangle. The lecture gets it from the same patch by *"an additional condition in u and w"*: the
# diagonal from $p_2$ to $p_3$ cuts the square in two.
#
# Does $(u, w) = (0.6, 0.6)$ belong to the triangle $p_1 p_2 p_3$?

# %%
inside = None  # True or False

# %% [markdown]
# **Task (triangle_mask).** Return `True` where `plane3(u, w, ...)` lies in the triangle, edges included, as an array of the shape
# of $u$ and $w$ together.
#
# Edges included, and computers round: a point that belongs on the diagonal may come out a hair beyond it. Allow $10^{-12}$.


# %% solution="triangle_mask"
def triangle_mask(u, w):
    """True where (u, w) belongs to the triangle p1 p2 p3 of plane3, edges included.

    u, w : numbers or arrays in [0, 1]
    Returns booleans, shape of u and w together.
    """
    ### BEGIN SOLUTION
    return np.asarray(u) + np.asarray(w) <= 1 + 1e-12
    ### END SOLUTION


# %%
tenths = np.linspace(0, 1, 11)
with once_written():
    reveal(inside, bool(triangle_mask(0.6, 0.6)))
    mask = triangle_mask(tenths[:, None], tenths[None, :])
    holds("p1, p2, p3 are in it", [triangle_mask(0, 0), triangle_mask(1, 0), triangle_mask(0, 1)], 1)
    holds("the fourth corner is not", triangle_mask(1, 1), 0)
    holds("of 11 x 11 grid points, 66 are in it", mask.sum(), 66)

# %% check="triangle_mask"
check(triangle_mask)

# %% [markdown]
# **What does it look like?** Points outside become "not a number", and the picture leaves them out. Look at the long edge.


# %%
def cut(u, w):
    return np.where(triangle_mask(u, w)[..., None], plane3(u, w, *corners), np.nan)


with once_written():
    display(plot.view(cut, samples=17, square=True))

# %% [markdown]
# ## 8 · The whole square on the triangle
#
# A saw-tooth edge is the price of the mask. Another map has none: let the whole edge $w = 1$ *collapse* into $p_3$. The edge
# $w = 0$ runs from $p_1$ to $p_2$, and from each of its points a straight line runs to $p_3$, $w$ being the share of the way.
#
# The picture draws nine orange lines, edges included. How many of them meet in $p_3$?

# %%
meet = None

# %% [markdown]
# **Task (triangle_patch).** Build it in two steps: first the point on the edge $w = 0$, then the point on the line from there to
# $p_3$.


# %% solution="triangle_patch"
def triangle_patch(u, w, p1, p2, p3):
    """The whole square on the triangle: edge w = 0 from p1 to p2, the edge w = 1 is the point p3.

    u, w : numbers or arrays in [0, 1];  p1, p2, p3 : points (3,), not on one line
    Returns points, shape of u and w together + (3,).
    """
    p1, p2, p3 = np.asarray(p1, float), np.asarray(p2, float), np.asarray(p3, float)
    u, w = np.asarray(u)[..., None], np.asarray(w)[..., None]
    ### BEGIN SOLUTION
    edge = (1 - u) * p1 + u * p2
    return (1 - w) * edge + w * p3
    ### END SOLUTION


# %%
with once_written():
    display(plot.view(lambda u, w: triangle_patch(u, w, *corners), square=True))
    reveal(meet, 9)


# %%
def area(f, n=60):
    """Area of a surface, added up from small meshes."""
    t = np.linspace(0, 1, n + 1)
    p = f(t[:, None], t[None, :])
    rising, falling = p[1:, 1:] - p[:-1, :-1], p[:-1, 1:] - p[1:, :-1]  # the diagonals of each mesh
    return np.linalg.norm(np.cross(rising, falling), axis=-1).sum() / 2


with once_written():
    holds("w = 0 runs from p1 to p2", triangle_patch([0, 1], 0, *corners), [p1, p2])
    holds("w = 1 is p3", triangle_patch(tenths, 1, *corners), p3)
    half = area(lambda u, w: triangle_patch(u, w, *corners))
    whole = area(lambda u, w: plane3(u, w, *corners))
    print(f"area {half:.3f}; half of the parallelogram is {whole / 2:.3f}")

# %% check="triangle_patch"
check(triangle_patch)

# %% [markdown]
# ### In your own words
#
# Two maps, one triangle: `plane3` with a mask, and `triangle_patch`. A milling machine shall follow the orange lines
# ($u$ = constant) from edge to edge.
#
# In three or four sentences: **what happens on each of the two at the boundary, what happens near $p_3$, and which one would
# you give to the machine?**
#
# *3 points: one for the edges of both maps; one for what happens to the distance of the lines, or to the normal, near $p_3$;
# one for a choice that follows from these.*

# %% [markdown] written="two_triangles" points=3
# ### BEGIN SOLUTION
# With the mask the lines have equal distances everywhere, but they stop inside the square wherever u + w = 1: the slanted edge is
# no parameter line, and on a mesh it comes out as a saw. On the patch all four edges of the square are edges of the triangle (one
# of them a point), so every line runs from edge to edge.
#
# Near p3 all lines of the patch crowd together: their distance falls to 0, S_u = 0 there, and S_u x S_w gives no normal at p3
# itself. The machine would pass over the same spot again and again.
#
# Either choice is right if it follows: the patch for a clean boundary, with the last bit near p3 left out; or the mask for even
# line distances, with the boundary cut in a separate pass.
# ### END SOLUTION

# %% [markdown]
# ## If you want more
#
# * Sweep a circle of radius $r$ along $z$. Which of your functions of A1 comes out, and are $u$ and $w$ where they were?
# * Sweep a line along its own direction. What is left of the surface, and what does `area` say?
# * Normalise three weights: $(p_1 + u\,p_2 + w\,p_3)/(1 + u + w)$. All its points lie in the triangle. Do they fill it?
#
# Next: **A3**, where the directrix is a circle.
