# %% [markdown]
# # A8 · Boundary curves, solids, inspection
#
# **Four curves meet in four corners. How many surfaces can be hung between them?**
#
# You will write seven functions: the Coons and the Ferguson patch, what separates the two, a piece of solid and its six faces,
# and two numbers that a measuring machine prints. That takes about two hours. Predict, look, write, test it yourself, check.

# %% [markdown]
# ## What holds everywhere
#
# * The four edges have names. $c_0, c_1$ run along $u$, where $w = 0$ and $w = 1$; $d_0, d_1$ run along $w$, where $u = 0$ and
#   $u = 1$. **All of them run in the direction of growing $u$ or $w$.**
# * The corner $p_{ij}$ is where $u = i$ and $w = j$. First index $u$, always.
# * Solids have a third parameter, in between: $u, v, w$.
# * Measured points are in millimetres.
#
# The rival convention: many CAD systems want the four edges head to tail, once round the patch. There $c_1$ and $d_0$ run the
# other way.
#
# Run the next cell first.

# %% setup=true

# %% [markdown]
# ## 1 · Four curves, four kinds
#
# A wave, a parabola, a piece of a sine and a straight line: *any* kind may sit beside any other, as long as they meet.
# $c_0(0) = d_0(0)$ is one corner, and $c_1(1) = d_1(1)$ another.
#
# At which parameters do $c_1$ and $d_0$ meet? Type the one of $c_1$, then the one of $d_0$.

# %%
where_they_meet = None  # for example (1, 1)


# %%
def point(x, y, z):
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


def c0(u):
    return point(1 + 4 * u, 1.0, 1 + u + np.sin(np.pi * u))


def c1(u):
    return point(1 + 4 * u, 4.0, 2 - u + 4 * u * (1 - u))


def d0(w):
    return point(1 - np.sin(np.pi * w), 1 + 3 * w, 1 + w)


def d1(w):
    return point(5.0, 1 + 3 * w, 2 - w)


# %%
reveal(where_they_meet, "(0, 1): the corner u = 0, w = 1")
for name, end in (("c1(0)", c1(0)), ("d0(1)", d0(1)), ("c0(1)", c0(1)), ("d1(0)", d1(0))):
    print(name, end)
plot.view(c0, curves={"c1": c1, "d0": d0, "d1": d1})

# %% [markdown]
# ## 2 · A first attempt
#
# In A4 you joined two curves by straight lines. $(1-w)\,c_0(u) + w\,c_1(u)$ has two of the four edges right, and
# $(1-u)\,d_0(w) + u\,d_1(w)$ the other two. So let us add them:
#
# $$A(u, w) = (1-w)\,c_0(u) + w\,c_1(u) + (1-u)\,d_0(w) + u\,d_1(w)$$
#
# The corner is $p_{00} = (1, 1, 1)$. What is $A(0, 0)$?

# %%
first_corner = None  # for example (1, 1, 1)


# %%
def mix(t, a, b):
    """(1 - t) a + t b, for parameters t of any shape and points (..., 3)."""
    t = np.asarray(t, dtype=float)[..., None]
    return (1 - t) * a + t * b


def attempt(u, w):
    return mix(w, c0(u), c1(u)) + mix(u, d0(w), d1(w))


reveal(first_corner, attempt(0, 0))
plot.view(attempt, curves={"c0": c0, "c1": c1, "d0": d0, "d1": d1})

# %% [markdown]
# **What went wrong?** The sum hangs far off, and meets none of the four curves. Walk along the edge $w = 0$ by hand: the first
# part gives $c_0(u)$, as it should. But the second part is not zero there: it gives the *straight line* from $p_{00}$ to
# $p_{10}$. On each of the four edges there is one such line too many.
#
# So something has to be taken away that has exactly these four straight edges. You have met it: which surface of A4 is it?

# %%
too_much = None  # "a plane", "a bilinear surface", "a ruled surface" ...

# %% [markdown]
# ## 3 · The Coons patch
#
# *Two ruled surfaces, less what both of them contain.* (In the transcript it is heard as "cones patch". It is named after
# Steven Coons, and has no cone in it.)
#
# **Task (coons).** The surface through four curves that meet. Take their corners from $c_0$ and $c_1$. `mix` may help more
# than once.


# %% solution="coons"
def coons(u, w, c0, c1, d0, d1):
    """The Coons patch through four boundary curves.

    u, w : numbers or arrays in [0, 1]
    c0, c1 : edges w = 0 and w = 1, functions of u;  d0, d1 : edges u = 0 and u = 1, functions of w
    Returns points, shape of u and w together + (3,).
    """
    across_w = mix(w, c0(u), c1(u))
    across_u = mix(u, d0(w), d1(w))
    ### BEGIN SOLUTION
    contained = mix(w, mix(u, c0(0.0), c0(1.0)), mix(u, c1(0.0), c1(1.0)))
    return across_w + across_u - contained
    ### END SOLUTION


# %%
u, w = np.linspace(0, 1, 9)[:, None], np.linspace(0, 1, 9)[None, :]
with once_written():
    reveal(too_much, "a bilinear surface, that of the four corners")
    display(plot.view(lambda u, w: coons(u, w, c0, c1, d0, d1)))

# %%
t = np.linspace(0, 1, 9)
with once_written():
    holds("S(u, 0) = c0", coons(t, 0, c0, c1, d0, d1), c0(t))
    holds("S(u, 1) = c1", coons(t, 1, c0, c1, d0, d1), c1(t))
    holds("S(0, w) = d0", coons(0, t, c0, c1, d0, d1), d0(t))
    holds("S(1, w) = d1", coons(1, t, c0, c1, d0, d1), d1(t))
    sides = (lambda w: mix(w, c0(0), c1(0))), (lambda w: mix(w, c0(1), c1(1)))
    ruled = mix(w, c0(u), c1(u))
    holds("with straight d0, d1 it is the ruled surface", coons(u, w, c0, c1, *sides), ruled)

# %% check="coons"
check(coons)

# %% [markdown]
# ### A trap: straight edges
#
# A classmate found something simpler: the *mean* of the two ruled surfaces. He tried it with four straight edges, and it agreed
# with yours to the last digit. Run the cell. Then set `straight = False` and run it again.

# %%
straight = True


def the_mean(u, w, c0, c1, d0, d1):
    return (mix(w, c0(u), c1(u)) + mix(u, d0(w), d1(w))) / 2


corner = {(i, j): (c0, c1)[j](i) for i in (0, 1) for j in (0, 1)}
ends = [((0, 0), (1, 0)), ((0, 1), (1, 1)), ((0, 0), (0, 1)), ((1, 0), (1, 1))]
lines = [lambda t, a=corner[i], b=corner[j]: mix(t, a, b) for i, j in ends]
with once_written():
    four = lines if straight else (c0, c1, d0, d1)
    holds("the mean is the Coons patch", the_mean(u, w, *four), coons(u, w, *four))

# %% [markdown]
# **What changed?** With straight edges both ruled surfaces *are* the bilinear one, $B$. Then $B + B - B$ and $(B + B)/2$ are
# the same, and so is $B$ by itself: the data are blind to everything that matters here. One edge with a bulge is enough to see.

# %% [markdown]
# ## 4 · The Ferguson patch
#
# Another way to fill the same frame. Let each edge be a Hermite cubic, given by its ends and its tangents there, and let the four
# functions $F_1 \dots F_4$ of A5 do the mixing inside as well:
#
# $$S(u, w) = \sum_{i}\sum_{j} F_i(u)\, F_j(w)\, G_{ij}$$
#
# with corners, tangents along $u$, tangents along $w$ in $G$, and **all four twists zero**.
#
# Derive by $u$ and by $w$ at a corner: which vector must $\partial^2 S/\partial u\,\partial w$ be?

# %%
mixed_derivative = None  # for example (1, 1, 1)


# %%
def F(t):
    """F1, F2, F3, F4 at t: they belong to p(0), p(1), p'(0), p'(1). Shape of t + (4,)."""
    t = np.asarray(t, dtype=float)
    each = 2 * t**3 - 3 * t**2 + 1, 3 * t**2 - 2 * t**3, t**3 - 2 * t**2 + t, t**3 - t**2
    return np.stack(each, axis=-1)


p = np.array([[[0, 0, 0], [1, 4, 1]], [[5, -1, 2], [6, 3, -1]]], dtype=float)
pu = np.array([[[6, 1, 3], [3, -2, 5]], [[4, 0, -4], [7, 2, 1]]], dtype=float)
pw = np.array([[[1, 5, 2], [-1, 3, 4]], [[0, 6, -3], [2, 3, -2]]], dtype=float)

# %% [markdown]
# **Task (ferguson).** `p[i, j]` is the corner $u = i$, $w = j$; `pu[i, j]` and `pw[i, j]` are the derivatives by $u$ and by $w$
# there, with their lengths. All of them point along growing $u$ or $w$, so at the far ends they lead *out* of the patch.
#
# The lecture says that Ferguson, too, "takes four boundary curves". It takes corners and tangents. Only where the four curves are
# Hermite cubics is that the same input.


# %% solution="ferguson"
def ferguson(u, w, p, pu, pw):
    """The bicubic Hermite patch with zero twists.

    u, w : numbers or arrays in [0, 1]
    p, pu, pw : corners, derivatives by u, derivatives by w, (2, 2, 3), index [u corner, w corner]
    Returns points, shape of u and w together + (3,).
    """
    ### BEGIN SOLUTION
    G = np.zeros((4, 4, 3))
    G[:2, :2], G[2:, :2], G[:2, 2:] = p, pu, pw
    return np.einsum("...i,...j,ijk->...k", F(u), F(w), G)
    ### END SOLUTION


# %% [markdown]
# **Test it yourself.** Each edge is a Hermite cubic of its own four vectors. For the twist take a small square at the corner,
# with the side $h$:
#
# $$\frac{S(h, h) - S(h, 0) - S(0, h) + S(0, 0)}{h^2}$$


# %%
def hermite(t, a, b, ta, tb):
    return F(t) @ np.array([a, b, ta, tb])


with once_written():
    for i, j in ((0, 0), (0, 1), (1, 0), (1, 1)):
        holds(f"corner p{i}{j}", ferguson(i, j, p, pu, pw), p[i, j])
    for k in (0, 1):
        edge = hermite(t, p[0, k], p[1, k], pu[0, k], pu[1, k])
        holds(f"edge w = {k}", ferguson(t, k, p, pu, pw), edge)
        edge = hermite(t, p[k, 0], p[k, 1], pw[k, 0], pw[k, 1])
        holds(f"edge u = {k}", ferguson(k, t, p, pu, pw), edge)
    h = 1e-4
    S = ferguson([[0], [h]], [[0, h]], p, pu, pw)
    reveal(mixed_derivative, np.round((S[1, 1] - S[1, 0] - S[0, 1] + S[0, 0]) / h**2, 1) + 0.0)

# %% check="ferguson"
check(ferguson)

# %% [markdown]
# ## 5 · Same edges, two surfaces
#
# Hand the four Hermite edges to your `coons`. Now two surfaces have the same four edges. Somebody compares them in the one place
# that is furthest from all edges, the middle $u = w = \tfrac12$. Will they differ there? Type `"yes"` or `"no"`.

# %%
differ_in_the_middle = None

# %%
along_u = [lambda t, j=j: hermite(t, p[0, j], p[1, j], pu[0, j], pu[1, j]) for j in (0, 1)]
along_w = [lambda t, i=i: hermite(t, p[i, 0], p[i, 1], pw[i, 0], pw[i, 1]) for i in (0, 1)]


def as_coons(u, w):
    return coons(u, w, *along_u, *along_w)


def as_ferguson(u, w):
    return ferguson(u, w, p, pu, pw)


with once_written():
    for place in ((0.5, 0.5), (0.25, 0.75)):
        print(place, "Ferguson", as_ferguson(*place), "Coons", as_coons(*place))
    reveal(differ_in_the_middle, "no")
    display(plot.view(as_ferguson, against=as_coons, names=("Coons", "Ferguson")))

# %% [markdown]
# ### A trap: the middle of the patch
#
# At the middle $F_1 = F_2 = \tfrac12$, exactly as $1 - t = t = \tfrac12$, and what the twists bring in has the factors
# $+\tfrac1{64}, -\tfrac1{64}, -\tfrac1{64}, +\tfrac1{64}$: it cancels. So the middle is *blind* to the difference, and so are
# all four edges. The colours show where it lives: between the middle and the corners, up to more than a hundredth of the size. In the
# bonnet of a car you would see it in every reflection.

# %% [markdown]
# ## 6 · Which twists make it a Coons patch?
#
# Only the twists are left to differ. So the Coons patch of four Hermite edges is a Hermite patch too, with twists that are not
# zero. Which? Derive its formula by $u$ and by $w$, part by part:
#
# * $(1-w)\,c_0(u) + w\,c_1(u)$ gives $c_1'(u) - c_0'(u)$; at the corner $u = i$ these are two of the `pu`;
# * the second part does the same with `pw`;
# * and the bilinear part has a twist, too.
#
# If one edge is merely carried along the other, opposite edges are alike. What are the twists then?

# %%
carried_along = None  # for example "all equal", "all zero", "equal to pu + pw"

# %% [markdown]
# **Task (coons_twists).** Return all four, index [u corner, w corner]. $G$ is in Mortenson's order, as in A5: $p$ upper left, `pw`
# upper right, `pu` lower left. What stands lower right is to be ignored.


# %% solution="coons_twists"
def coons_twists(G):
    """Twists with which a Hermite patch is the Coons patch of its four edges.

    G : (4, 4, 3), Mortenson's order; its twist block is ignored
    Returns an array (2, 2, 3), index [u corner, w corner].
    """
    p, pw, pu = G[:2, :2], G[:2, 2:], G[2:, :2]
    ### BEGIN SOLUTION
    of_pu = pu[:, 1] - pu[:, 0]  # by i, alike for both j
    of_pw = pw[1] - pw[0]  # by j, alike for both i
    of_corners = p[1, 1] - p[1, 0] - p[0, 1] + p[0, 0]
    return of_pu[:, None] + of_pw[None, :] - of_corners
    ### END SOLUTION


# %% [markdown]
# **Test it yourself.** A twist enters through $F_3$ or $F_4$ in both directions. Add yours to your own Ferguson patch: now it has to
# be the Coons patch, *everywhere*.


# %%
def with_twists(u, w, p, pu, pw, twists):
    inside = np.einsum("...i,...j,ijk->...k", F(u)[..., 2:], F(w)[..., 2:], twists)
    return ferguson(u, w, p, pu, pw) + inside


G = np.zeros((4, 4, 3))
G[:2, :2], G[:2, 2:], G[2:, :2] = p, pw, pu
with once_written():
    ours = coons_twists(G)
    holds("with these twists it is Coons", with_twists(u, w, p, pu, pw, ours), as_coons(u, w))
    carried = G.copy()  # now opposite edges alike
    carried[2:, 1], carried[1, 2:] = carried[2:, 0], carried[0, 2:]
    carried[1, 1] = p[1, 0] + p[0, 1] - p[0, 0]
    reveal(carried_along, "all zero" if not coons_twists(carried).round(12).any() else "not all zero")

# %% check="coons_twists"
check(coons_twists)

# %% [markdown]
# ### In your own words
#
# A classmate fits a panel into four Hermite edges, once with Ferguson and once with Coons. She compares the two along all four
# edges and in the middle, finds no difference, and concludes that they are one surface.
#
# In three or four sentences: **why could her data not see a difference, where should she look, and when would she be right?**
#
# *3 points: one for why edges and middle are blind; one for a place, or a quantity, that sees; one for the condition under which
# both are the same surface.*

# %% [markdown] written="same_edges" points=3
# ### BEGIN SOLUTION
# The two differ only in their twists. These enter through F3 and F4 in both directions, and F3 and F4 vanish at 0 and 1: so no
# twist moves an edge. In the middle the four twists have the factors +1/64, -1/64, -1/64, +1/64, and for the twists of the
# Coons patch this sum is zero.
#
# Elsewhere inside the difference shows, as at (1/4, 3/4); or she compares the mixed derivatives at the corners, which are zero for
# Ferguson.
#
# She is right if the twists of the Coons patch are zero as well, that is if its edges are those of one curve carried along
# another (a translational surface).
# ### END SOLUTION

# %% [markdown]
# ## 7 · A piece of solid
#
# One parameter makes a curve, two a surface; a third makes a *solid*, bounded by six patches. A cube of $4 \times 4 \times 4$
# control points:
#
# $$S(u, v, w) = \sum_i \sum_j \sum_k B_i(u)\, B_j(v)\, B_k(w)\, P_{ijk}$$
#
# 64 points, 192 numbers. How many of the 64 lie on the boundary of the cube, so that a surface could do with those?

# %%
on_the_boundary = None  # a number


# %%
def B(t):
    """The four cubic Bernstein functions, shape of t + (4,)."""
    t = np.asarray(t, dtype=float)
    s = 1 - t
    return np.stack([s**3, 3 * s**2 * t, 3 * s * t**2, t**3], axis=-1)


i, j, k = np.meshgrid(np.arange(4.0), np.arange(4.0), np.arange(4.0), indexing="ij")
lattice = np.stack([i, j, k], axis=-1)
P = lattice * [3, 4, 5] + np.stack([0.5 * k * (3 - k), 0.4 * i * k, i * (3 - i) * (j - 1)], axis=-1)
inner = ((lattice > 0) & (lattice < 3)).all(axis=-1)
reveal(on_the_boundary, 64 - int(inner.sum()))

# %% [markdown]
# **Task (hyperpatch).** $u$ goes with the first axis of $P$, $v$ with the second, $w$ with the third. Three arrays broadcast
# just as two do.


# %% solution="hyperpatch"
def hyperpatch(u, v, w, P):
    """The solid of 64 control points: the tricubic Bezier hyperpatch.

    u, v, w : numbers or arrays in [0, 1] that broadcast against each other;  P : (4, 4, 4, 3)
    Returns points, shape of u, v and w together + (3,).
    """
    ### BEGIN SOLUTION
    return np.einsum("...i,...j,...k,ijkd->...d", B(u), B(v), B(w), P)
    ### END SOLUTION


# %%
with once_written():
    display(plot.view(lambda u, v, w: hyperpatch(u, v, w, P)))

# %%
ends = np.array([0, 1])
all_three = ends[:, None, None], ends[None, :, None], ends[None, None, :]
with once_written():
    holds("the eight corners", hyperpatch(*all_three, P), P[::3, ::3, ::3])
    holds("the weights add up to 1", hyperpatch(0.2, 0.5, 0.9, np.ones((4, 4, 4, 3))), 1)
    edge = B(t) @ P[:, 0, 3]
    holds("v = 0, w = 1 is the Bezier curve of P[:, 0, 3]", hyperpatch(t, 0, 1, P), edge)
    holds("a regular lattice gives (3u, 3v, 3w)", hyperpatch(0.2, 0.5, 0.9, lattice), (0.6, 1.5, 2.7))

# %% check="hyperpatch"
check(hyperpatch)

# %% [markdown]
# The last line of that test is a weak one: on a regular lattice the eight corners alone, mixed linearly, give the same. The line
# before it is a strong one. Can you say why?

# %% [markdown]
# ## 8 · Six faces
#
# A modeller stores a solid by its boundary. Hold one parameter at 0 or 1, and two are left: a patch. Its normal is
# $S_1 \times S_2$, where 1 and 2 are the two that are left, in their order.
#
# On the pair $u = 0$ and $u = 1$ these normals point the same way, along $+u$. So on which of the two do they point *out*?

# %%
points_out = None  # "u = 0" or "u = 1"

# %% [markdown]
# **Task (hyperpatch_faces).** The nets of the faces, in the order $u = 0$, $u = 1$, $v = 0$, $v = 1$, $w = 0$, $w = 1$; the axes
# that remain keep their order.


# %% solution="hyperpatch_faces"
def hyperpatch_faces(P):
    """Control nets of the six faces u = 0, u = 1, v = 0, v = 1, w = 0, w = 1.

    P : (4, 4, 4, 3), axes u, v, w
    Returns an array (6, 4, 4, 3); the two remaining axes keep their order.
    """
    ### BEGIN SOLUTION
    return np.stack([P[0], P[-1], P[:, 0], P[:, -1], P[:, :, 0], P[:, :, -1]])
    ### END SOLUTION


# %%
def bezier_patch(u, w, net):
    return np.einsum("...i,...j,ijd->...d", B(u), B(w), net)


with once_written():
    faces = hyperpatch_faces(P)
    for number, end in enumerate((0, 1)):
        holds(f"face u = {end}", bezier_patch(u, w, faces[number]), hyperpatch(end, u, w, P))
        holds(f"face v = {end}", bezier_patch(u, w, faces[2 + number]), hyperpatch(u, end, w, P))
        holds(f"face w = {end}", bezier_patch(u, w, faces[4 + number]), hyperpatch(u, w, end, P))
    reveal(points_out, "u = 1")
    # the needles on the face u = 1 point away from the middle of the solid, which is marked by a cross
    at, cross = hyperpatch(0.5, 0.5, 0.5, P), np.concatenate([np.eye(3), -np.eye(3)])
    middle = np.insert(at + cross, range(7), at, axis=0)
    face = faces[1]
    display(plot.view(lambda u, w: bezier_patch(u, w, face), normals=True, curves={"middle": middle}))

# %% check="hyperpatch_faces"
check(hyperpatch_faces)

# %% [markdown]
# **What to keep.** Out on $u = 1$, in on $u = 0$; with $v$ it is the other way round, since $S_u \times S_w$ points along $-v$;
# with $w$ as with $u$. Whoever wants all six outward turns three of them over.

# %% [markdown]
# ## 9 · How flat is flat?
#
# The workshop delivers a plate, 80 mm by 50 mm. A measuring machine touches it at 35 points. *Flatness* is how far the highest
# lies above the lowest, across the plane that fits best: this plate has **0.04 mm**.
#
# In the machine it does not lie level: along its long side it rises by 2 mm on every 3, along its short side it falls by 1 mm on
# every 3. How many millimetres is it then from the lowest $z$ to the highest?

# %%
range_of_z = None  # mm

# %%
s, r = np.meshgrid(np.linspace(-1, 1, 7), np.linspace(-1, 1, 5), indexing="ij")
s, r = s.ravel(), r.ravel()
height = 0.018 * s**2 + 0.018 * s * r  # hollow along its length, and twisted
level = point(40 * s, 25 * r, height - height.mean())
turned = np.array([[1, 2, 2], [-2, 2, -1], [-2, -1, 2]]) / 3  # a rotation: orthonormal rows
plate = level @ turned + [30, -20, 40]
reveal(range_of_z, np.ptp(plate[:, 2]), "mm")
print(f"from the lowest to the highest, lying level: {np.ptp(level[:, 2]):.4f} mm")

figure = go.Figure().update_layout(height=300, template="none", title="the deviations, lying level, mm")
for row in np.unique(r):
    figure.add_scatter(x=40 * s[r == row], y=level[r == row, 2], name=f"y = {25 * row:g} mm")
figure.update_xaxes(title="x, mm")

# %% [markdown]
# **Task (flatness).** The best plane passes through the mean $c$ of the points. Its normal $n$ is the direction in which the points
# $X - c$ spread *least*: the right singular vector of the smallest singular value. `np.linalg.svd(A)[2]` has them as rows, the
# smallest last. Then $d = (X - c)\cdot n$.
#
# Some tables mean another plane: the standard ISO 1101 asks for the *narrowest* zone, and least squares can only give as much or
# more. Say which you report.


# %% solution="flatness"
def flatness(points):
    """Peak-to-valley distance of points from their orthogonal least-squares plane.

    points : (n, 3), n >= 4, in mm
    Returns a number, in mm.
    """
    ### BEGIN SOLUTION
    away = points - points.mean(axis=0)
    normal = np.linalg.svd(away, full_matrices=False)[2][-1]
    d = away @ normal
    return d.max() - d.min()
    ### END SOLUTION


# %%
with once_written():
    holds("lying level", flatness(level), np.ptp(level[:, 2]))
    holds("lying aslant: unchanged", flatness(plate), flatness(level))
    holds("upside down, elsewhere: unchanged", flatness(7 - plate), flatness(level))
    holds("a perfect plate in any position", flatness((level * [1, 1, 0]) @ turned + [5, 6, 7]), 0)
    holds("in tenths of a millimetre", flatness(10 * plate), 10 * flatness(plate))

# %% check="flatness"
check(flatness)

# %% [markdown]
# ## 10 · How round is a shaft?
#
# *Cylindricity* about a given axis: the largest distance from the axis less the smallest. The axis is a point $a$ and a direction,
# of any length. Let $v = X - a$; with a unit vector $k$ the part of $v$ along the axis is $(v\cdot k)\,k$, and what is left goes
# straight across.
#
# A shaft is 0.035 mm thicker in its middle than at its ends, measured in radius. What is its cylindricity, in millimetres?

# %%
barrel = None  # mm

# %% [markdown]
# **Task (cylindricity).** `axis_dir` is any vector but zero, and seldom a unit one.


# %% solution="cylindricity"
def cylindricity(points, axis_point, axis_dir):
    """Range of the distances of points from a given axis.

    points : (n, 3), in mm;  axis_point : (3,);  axis_dir : (3,), any length but 0
    Returns a number, in mm.
    """
    ### BEGIN SOLUTION
    k = np.asarray(axis_dir) / np.linalg.norm(axis_dir)
    v = points - axis_point
    distance = np.linalg.norm(v - (v @ k)[:, None] * k, axis=-1)
    return distance.max() - distance.min()
    ### END SOLUTION


# %%
along = np.linspace(-1, 1, 41)
angle, radius = 2.4 * np.arange(41), 12.035 - 0.035 * along**2
upright = point(radius * np.cos(angle), radius * np.sin(angle), 30 * along)
a, k = np.array([3.0, -2.0, 5.0]), turned[2]  # the z axis is turned into the last row
shaft = upright @ turned + a
with once_written():
    reveal(barrel, cylindricity(shaft, a, k))
    holds("between centres", cylindricity(upright, (0, 0, 0), (0, 0, 1)), 0.035)
    holds("aslant", cylindricity(shaft, a, k), 0.035)
    holds("the length of axis_dir does not matter", cylindricity(shaft, a, -7 * k), 0.035)
    holds("nor where on the axis the point is", cylindricity(shaft, a + 100 * k, k), 0.035)
    beside = cylindricity(shaft, a + 0.1 * turned[0], k)
    print(f"with the axis 0.1 mm beside the true one: {beside:.3f} mm")

# %% check="cylindricity"
check(cylindricity)

# %% [markdown]
# **What changed in the last line?** A tenth of a millimetre beside the axis, and the shaft seems to be out of round by two tenths
# and more. Form errors are small differences of large numbers: where the datum lies decides what you report.

# %% [markdown]
# ## If you want more
#
# * Replace $1 - t$ and $t$ by $F_1$ and $F_2$ in *all three* parts of your Coons formula, on the four Hermite edges. Which
#   surface of this notebook comes out?
# * Give `coons` three sides: let $d_0$ be a single point. What happens to the normal there?
# * Write `corners_agree(c0, c1, d0, d1)`. How large a gap would you still forgive: a micrometre, or a share of the size?
# * Points of a ball: the centre of the best sphere comes from a *linear* system, $|x|^2 = 2\,c\cdot x + \text{const}$. Sphericity?
#
# Next: **A9**, sixteen tasks further on, and the judge's own seat.
