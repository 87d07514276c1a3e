# %% [markdown]
# # How round a part is
#
# **A part was made as a cylinder. A measuring machine touched it in two hundred places, and no two of them lie equally far
# from the axis. How far is it from round?**
#
# From *which* axis? The machine hands over points and no axis. Whoever answers has laid one through them.
#
# This chapter begins with a plate and four points, comes to circles and cylinders, fools a calliper, and ends with an oval
# that reports itself round. It takes two evenings, the second from section 6. Lengths are in millimetres, or in thousandths
# of one: micrometres, µm. Guess before you look.

# %% setup=true
import directrix as dx
from directrix.plot import palette

from autograder.catalogue import shipped


def lobed(angle, z):
    """By how much the part is too thick there: three lobes all round, and thinner towards both ends."""
    return 0.006 * np.cos(3 * angle) - 0.004 * (z / 30) ** 2


def part(magnified):
    """The part upright, as a surface: radius 20, height 60, its deviations drawn so many times too large."""

    def points(u, w):
        angle, z = 2 * np.pi * u, 60 * w - 30
        return around(angle, 20 + magnified * lobed(angle, z), z)

    return points


def around(angle, distance, z):
    """Points (..., 3) at these angles about the z axis, distances from it, and heights."""
    return np.stack(np.broadcast_arrays(distance * np.cos(angle), distance * np.sin(angle), z), axis=-1)


def paper(height, **names):
    """An empty sheet for a drawing in the plane; above it what will be drawn, each in its colour."""
    words = [f"<span style='color:{colour}'>━_{name}</span>".replace("_", "&nbsp;") for name, colour in names.items()]
    title = {"text": "&nbsp;&nbsp; ".join(words), "x": 0.5, "y": 0.96, "font": {"size": 13}}
    figure = go.Figure().update_layout(height=height, template="none", showlegend=False, title=title)
    figure.update_layout(margin={"t": 40 if names else 10, "b": 50, "l": 60, "r": 20})
    figure.update_xaxes(showgrid=False, zeroline=False).update_yaxes(showgrid=False, zeroline=False)
    font = {"color": palette.INK, "family": palette.FONT}
    return figure.update_layout(paper_bgcolor=palette.CLEAR, plot_bgcolor=palette.CLEAR, font=font)


def draw(figure, x, y, colour=palette.INK, width=3, dash=None, mode="lines", size=8):
    """A line or points."""
    line = {"color": colour, "width": width, "dash": dash, "simplify": False}
    figure.add_scatter(x=x, y=y, mode=mode, line=line, marker={"color": colour, "size": size})


def both(points, measure):
    """A form error twice, in µm: about the least-squares form, and with the narrowest zone."""
    return [1000 * measure(points, method=method).value for method in ("least squares", "minimum zone")]


# %% [markdown]
# ## 1 · Two hundred places
#
# Here is the part, and how the probe goes: once round, a little up, round again. Three rings are drawn; in truth there are
# eight, of 25 places each.
#
# Drawn as it is, the part would look like any tin. So its deviations are drawn **300 times too large**. Turn it, look into
# it, walk round the first ring: what shape is a section?

# %%
section = None  # in your own words

# %%
reveal(section, "a triangle with round corners: three lobes. And along the part it is a barrel")
figure = plot.walk(part(300), [(0, 0.15), (1, 0.15), (1, 0.5), (0, 0.5), (0, 0.85), (1, 0.85)], steps=61)
figure.update_layout(scene_camera_eye={"x": -1.0, "y": -1.3, "z": 2.1})

# %% [markdown]
# Now it lies in the machine as somebody clamped it: a tenth of a millimetre beside its place, and leaning by 0.3°. The drawing
# says *axis $z$, radius 20*: that is the **nominal** form. Distances from an axis come out of the part of $v = X - a$ that
# lies across the direction $k$. Say what must hold, whatever the formula: they change neither if $a$ moves along the axis, nor
# if $k$ has another length.
#
# The decisive line is missing. Write it.


# %%
def distances(X, a, k):
    """Distances (n,) of the points X (n, 3) from the axis through a along k, of any length but 0."""
    k = np.asarray(k, float) / np.linalg.norm(k)
    v = X - np.asarray(a, float)
    ### BEGIN SOLUTION
    return np.linalg.norm(v - (v @ k)[:, None] * k, axis=1)
    ### END SOLUTION


# %%
rng = np.random.default_rng(12)
angle, z = (grid.ravel() for grid in np.meshgrid(2 * np.pi * np.arange(25) / 25, np.linspace(-29, 29, 8)))
tremble = rng.normal(0, 0.0005, 200)  # a probe is no angel: half a µm
upright = around(angle, 20 + lobed(angle, z) + tremble, z)
clamped = dx.Transform.translate((0.08, -0.06, 140)) @ dx.Transform.rotate((1, 2, 0), np.radians(0.3))
cloud = clamped @ upright
a, k = clamped @ (0, 0, 0), clamped.vectors((0, 0, 1))  # the true axis, which no machine knows
with once_written():
    from_z = distances(upright, (0, 0, 0), (0, 0, 1))
    holds("upright: the distance from z", from_z, np.hypot(*upright[:, :2].T))
    holds("moving a along the axis changes nothing", distances(cloud, a + 70 * k, k), distances(cloud, a, k))
    holds("the length of k means nothing", distances(cloud, a, -3 * k), distances(cloud, a, k))
    holds("clamped or not, from its own axis", distances(cloud, a, k), from_z)

# %% [markdown]
# The **form error** is the largest distance less the smallest. Twelve µm of lobes, four of barrel and a little trembling: about
# 17 µm, from the part's own axis. From the axis of the drawing it will be more. How many µm?

# %%
by_the_drawing = None  # µm

# %%
with once_written():
    own = np.ptp(distances(cloud, a, k))
    reveal(by_the_drawing, 1000 * np.ptp(distances(cloud, (0, 0, 140), (0, 0, 1))), "µm")
    print(f"from its own axis: {1000 * own:.1f} µm")

# %% [markdown]
# **What was measured?** The clamp, not the part. How a part *lies* is a question too, but another one: position, or
# orientation. *Form* is what is left when the part may lie as it likes. So the ideal form must be laid through the points
# first. How? Take the smallest case.

# %% [markdown]
# ## 2 · Four points
#
# A square plate, 100 by 100. It rests on three corners, and the fourth is **1 mm** up. How flat is it? *Flatness* is the
# distance between two parallel planes that have all of the points between them. They may stand as they like; the closest
# pair counts.

# %%
corner_up = None  # mm

# %%
four = np.array([(0, 0, 0), (100, 0, 0), (0, 100, 0), (100, 100, 1)], float)
print("heights above the table, from lowest to highest:", np.ptp(four[:, 2]), "mm")

# %% fold=true
reveal(corner_up, dx.flatness(four, "minimum zone").value, "mm")
tall = np.array([1, 1, 40])  # the heights, 40 times too large
around_it = [0, 1, 3, 2, 0]
leans = four * [1, 1, 0] + np.outer((-0.25, 0.25, 0.25, 0.75), (0, 0, 1))  # the plane half way between the two
above, below = (tall * (leans + (0, 0, z)) for z in (0.25, -0.25))
edges = {"the one plane": above[around_it], "the other": below[around_it]}
figure = plot.view(dx.Bilinear(*(tall * four)[[0, 2, 1, 3]]), curves=edges, lines=1, height=420)
for plane in (above, below):
    x, y, z = plane.reshape(2, 2, 3).T
    veil = {"colorscale": palette.constant(palette.CURVE), "opacity": 0.25, "showscale": False, "hoverinfo": "skip"}
    figure.add_surface(x=x, y=y, z=z, lighting=palette.FLAT, **veil)
x, y, z = (tall * four).T
figure.add_scatter3d(x=x, y=y, z=z, mode="markers", marker={"color": palette.MARK, "size": 7}, hoverinfo="skip")
figure.update_layout(scene_camera_eye={"x": 0.75, "y": -1.75, "z": 0.4}, showlegend=False)
figure.update_scenes(xaxis_visible=False, yaxis_visible=False, zaxis_visible=False)

# %% [markdown]
# **Half a millimetre.** The two planes lean along with the plate: two corners touch the one, two the other. Your *three
# corners on a table* was the drawing's axis again, a place where the plate happened to lie. Each of those corners has an error
# of its own, and is treated as the truth.

# %% [markdown]
# The same on a plate of 35 points, 80 by 50, with a flatness of 40 µm. Somebody reports **the range of the heights $z$**, and
# the clamp leans the plate a little. In the next picture one place on the floor is one slant: so many hundredths of a
# millimetre of rise along $x$ and along $y$. The height is the flatness reported. The right answer does not care: a level
# floor. What shape is the other?

# %%
shape_of_wrong = None  # "a floor, but higher", "a bowl", "a funnel" or "a slope"

# %% fold=true
right = shipped().find("flatness")
mistakes = {mistake.id: mistake for mistake in right.mistakes}
s, r = (grid.ravel() for grid in np.meshgrid(np.linspace(-1, 1, 7), np.linspace(-1, 1, 5), indexing="ij"))
bent = 0.018 * s**2 + 0.018 * s * r
plate = np.stack([40 * s, 25 * r, bent - bent.mean()], axis=-1)[np.argsort(-s * s - r * r, kind="stable")]  # corners first


def leaning(x, y):
    """The plate, leaned until its length rises by x and its width by y."""
    return dx.Transform.rotate("y", -np.arctan(x / 80)) @ dx.Transform.rotate("x", np.arctan(y / 50)) @ plate


def reported(report):
    """Over all slants up to a tenth of a millimetre: what is reported, all in hundredths of a millimetre."""

    def surface(u, w):
        x, y = np.broadcast_arrays(20 * u - 10, 20 * w - 10)
        found = [100 * float(report(leaning(*at))) for at in zip(x.ravel() / 100, y.ravel() / 100, strict=True)]
        return np.stack([x, y, np.reshape(found, x.shape)], axis=-1)

    return surface


reveal(shape_of_wrong, "a funnel; only at its lowest point, when the plate happens to lie level, is it about right")
plot.view(reported(mistakes["z_range"].formula), against=reported(right), names=("right", "range of z"), samples=25)

# %% [markdown]
# A tenth of a millimetre of slant each way, and 40 µm have become 200. On the level plate nobody would have noticed: it is
# **blind** to this mistake. Here are more that learners really make, on the plate lying level about the origin, and on the
# plate as it might lie in a machine. Which of them are wrong on *both*?
#
# * `"z_range"`: the highest $z$ less the lowest
# * `"vertical"`: the best $z = ax + by + c$, and what is left along $z$
# * `"not_centred"`: the best of the planes through the origin
# * `"three_points"`: the plane through three of the corners
# * `"rms"`: the right plane, and the root mean square

# %%
wrong_on_both = None  # names

# %%
aslant = dx.Transform.translate((30, -20, 40)) @ dx.Transform.rotate((2, -1, 0), np.radians(40)) @ plate
written = {name: mistakes[name].formula for name in ("z_range", "vertical", "not_centred", "three_points", "rms")}
for name, report in {"right": right, **written}.items():
    found = [1000 * report(points) for points in (plate, aslant)]
    print(f"{name:14} {found[0]:8.1f} µm level {found[1]:10.1f} µm aslant")
reveal(wrong_on_both, "three_points and rms: one has another plane, the other no zone")
print("\n" + mistakes["three_points"].hint)

# %% [markdown]
# ## 3 · Which plane?
#
# *Leaning as it likes* is no instruction yet. There are two in use, and they are not the same:
#
# * **Minimum zone**: lean the two planes until they are as close as can be. This is what ISO 1101 means.
# * **Least squares**: lay the plane for which the sum of the *squared* distances is least, then take the range. Most
#   measuring machines do it: it is quick, and one stray point hardly moves the plane.
#
# Eleven places along a rail, seen from the side. Is the least-squares zone wider than the other, as wide, or narrower?

# %%
least_squares_is = None  # "wider", "as wide" or "narrower"; and by how many per cent?

# %% fold=true
along, h = np.arange(0, 101, 10.0), np.array([0, 4, 6, 7, 7, 6, 5, 3, 2, 0, -1.0])


def rail(x, h):
    """Two rows of places, side by side: a rail is a narrow plate. Heights in µm."""
    return np.concatenate([np.stack([x, 0 * x + y, h / 1000], axis=-1) for y in (-5, 5)])


def sides(form, off):
    """Heights in µm above x of the plane that is parallel to the form's, off to one side."""
    return [1000 * (form.point @ form.normal + off - form.normal[0] * at) / form.normal[2] for at in (-4, 104)]


figure = paper(330, least_squares=palette.YOURS, minimum_zone=palette.REFERENCE, measured=palette.INK)
for method, colour, dash in (("least squares", palette.YOURS, "dash"), ("minimum zone", palette.REFERENCE, None)):
    zone = dx.flatness(rail(along, h), method)
    for off in (zone.residuals.max(), zone.residuals.min()):
        draw(figure, (-4, 104), sides(zone.form, off), colour, 2.5, dash)
        touches = np.abs(zone.residuals - off)[:11] < 1e-9
        if method == "minimum zone":
            draw(figure, along[touches], h[touches], palette.MARK, mode="markers", size=17)
draw(figure, along, h, palette.INK, 1.5, mode="lines+markers")
figure.update_xaxes(title="along the rail, mm").update_yaxes(title="height, µm", nticks=10)
squares, narrowest = both(rail(along, h), dx.flatness)
print(f"least squares {squares:.2f} µm, minimum zone {narrowest:.2f} µm")
reveal(least_squares_is, f"wider, by {100 * (squares / narrowest - 1):.0f} per cent")
figure

# %% [markdown]
# **It can never be narrower**: the other one is the narrowest there is. Least squares asks all of the points, and a point in
# the middle has its say. The minimum zone asks only those that it touches (pink), and is deaf to the rest.
#
# Somebody puts the probe down on the right end *twenty times*. Not one new place. Which of the two answers changes?

# %%
changes = None  # "least squares", "minimum zone", "both" or "none"

# %%
often = np.append(along, 19 * [along[-1]]), np.append(h, 19 * [h[-1]])
for name, places in (("eleven places", (along, h)), ("the last one 20 times", often)):
    squares, narrowest = both(rail(*places), dx.flatness)
    print(f"{name:22} least squares {squares:.2f} µm, minimum zone {narrowest:.2f} µm")
reveal(changes, "least squares: it asks how the places are spread, the minimum zone only which there are")

# %% [markdown]
# ## 4 · How many decide?
#
# Three pink dots held the zone of the rail. Why three? Two parallel lines have a slope, a height and a gap: three numbers to
# settle, and each dot settles one. A zone of two planes has two slopes, a height and a gap. Two concentric spheres have a
# centre and two radii.
#
# Back to the part. A zone of two coaxial cylinders has an axis and two radii. How many of the two hundred points decide?

# %%
deciding = None  # a number


# %%
def touching(found):
    """How many points lie on the one or the other edge of the zone."""
    edges = np.array([found.residuals.min(), found.residuals.max()])
    return int((np.abs(found.residuals[:, None] - edges) < 1e-9).sum())


ways = rng.normal(size=(80, 3))
ball = (10 + rng.normal(0, 0.004, (80, 1))) * ways / np.linalg.norm(ways, axis=1, keepdims=True)
rough = plate + rng.normal(0, 0.004, (35, 1)) * [0, 0, 1]
zones = {"plane": (dx.flatness, rough), "sphere": (dx.sphericity, ball), "cylinder": (dx.cylindricity, cloud)}
deciders = {}
for name, (measure, points) in zones.items():
    deciders[name] = touching(measure(points, method="minimum zone"))
    print(f"{name:9} {len(points):4} points, of which {deciders[name]} decide")
reveal(deciding, deciders["cylinder"])

# %% [markdown]
# **Six.** An axis is four numbers, two where it passes and two how it leans; two radii make six. The other 194 places could
# be anywhere between, and nobody would know.
#
# Here is the cloud, in the colours of what is left: blue below the ideal cylinder, orange above.

# %%
found = dx.cylindricity(cloud)
squares_of_part, narrowest_of_part = both(cloud, dx.cylindricity)
print(f"cylindricity: least squares {squares_of_part:.2f} µm, minimum zone {narrowest_of_part:.2f} µm")
lean = np.degrees(np.linalg.norm(np.cross(found.form.axis, k)))
print(f"the fitted axis leans {lean:.5f}° from the true one; radius {found.form.radius:.4f}")
ideal = dx.Transform.scale(0.96, cloud.mean(axis=0)) @ found.surface()  # smaller, under the dots
figure = plot.view(ideal, points=cloud, deviations=found.residuals, lines=1)
figure.update_traces(marker_size=7, selector={"name": "measured"})
figure.update_layout(scene_camera_eye={"x": -0.9, "y": -1.2, "z": 1.3})

# %% [markdown]
# **Turn it**: three orange stripes all along, three blue ones between them, and more blue towards both ends. That is what a
# picture of deviations is for. The single number has forgotten it.

# %% [markdown]
# ## 5 · What a circle takes away
#
# One section now, a ring of points: $\varrho$ over the angle $\theta$. Take a *perfect* ring and clamp it a tenth of a
# millimetre beside the centre of the turntable. The record of $\varrho$ goes up and down. How often, in one turn?

# %%
waves = None  # a number

# %% fold=true
theta = np.linspace(0, 2 * np.pi, 361)
x, y = 20 * np.cos(theta) + 0.08, 20 * np.sin(theta) - 0.06
at = np.unwrap(np.arctan2(y, x))
figure = paper(300, a_perfect_ring_beside_the_centre=palette.U, lobes_about_their_centre=palette.W)
draw(figure, np.degrees(at), 1000 * (np.hypot(x, y) - 20), palette.U)
draw(figure, np.degrees(theta), 1000 * 0.006 * np.cos(3 * theta), palette.W)
figure.update_xaxes(title="angle, degrees", tickvals=list(range(0, 361, 60)), range=[0, 360])
figure.update_yaxes(title="ϱ − 20 mm, in µm")
reveal(waves, "once: it is 0.08 cos θ − 0.06 sin θ, to within less than a µm")
figure

# %% [markdown]
# So the parts of a record have names. A constant: the **size**. One wave a turn: the **place**.
# Neither is form. Two waves (oval), three (our part), and more: that is form.
#
# A circle has three numbers, and they take away just these: find $c_0, c_1, c_2$ so that
#
# $$\varrho_i \approx c_0 + c_1 \cos\theta_i + c_2 \sin\theta_i$$
#
# with the least sum of squares. What is left is the deviation from the least-squares circle. The shift $(c_1, c_2)$ is right to
# first order only, so one moves the points back by it and repeats; four rounds are plenty. Write the line.


# %%
def deviations(x, y):
    """What is left of a ring of points x, y (n,) when its least-squares circle is taken away: (n,)."""
    for _ in range(4):
        angle, rho = np.arctan2(y, x), np.hypot(x, y)
        waves = np.stack([np.ones_like(angle), np.cos(angle), np.sin(angle)], axis=1)  # (n, 3)
        ### BEGIN SOLUTION
        c = np.linalg.lstsq(waves, rho, rcond=None)[0]
        ### END SOLUTION
        x, y = x - c[1], y - c[2]
    return rho - waves @ c


# %%
turn = 2 * np.pi * np.arange(25) / 25
ring = around(turn, 20 + lobed(turn, 0) + rng.normal(0, 0.0005, 25), 0)
with once_written():
    x, y, _ = ring.T
    left = deviations(x, y)
    holds("of a perfect ring nothing is left", deviations(7 * np.cos(turn) + 0.3, 7 * np.sin(turn)))
    holds("as much above as below", left.sum())
    holds("the ring moved: nothing changes", deviations(x + 0.09, y - 0.05), left)
    holds("the part turned over: nor then", deviations(x, -y), left)
    pair = np.concatenate([ring, ring + (0, 0, 60)])  # the ring swept along a line, as in chapter 2
    holds("the same as the library's cylinder", deviations(x, y), dx.cylindricity(pair).residuals[:25])

# %% [markdown]
# **Roundness** is the range of these, for one section at a time: a zone between two concentric circles in one plane, says ISO
# 1101. What must be said besides is a matter of ISO 12181: which reference circle (least squares, minimum zone, the smallest
# around, the largest inside) and which waves a filter lets through.
#
# A good place to stop for tonight. Tomorrow: how to measure a part and not see it.

# %% [markdown]
# ## 6 · Where the probe goes
#
# Time is money, so somebody probes four places, evenly all round, of a section with three lobes of 6 µm: 12 µm from the lowest
# to the highest. Where the first one lies is left to chance. What roundness is reported?

# %%
from_four = None  # µm, or "it depends where the first one lies"


# %%
def lobes(n, places, start=0.0):
    """A section of radius 20 with n lobes of 6 µm, probed evenly: x and y."""
    angle = start + 2 * np.pi * np.arange(places) / places
    return around(angle, 20 + 0.006 * np.cos(n * angle), 0)[:, :2].T


with once_written():
    for start in (0, 10, 20, 30, 45):
        value = np.ptp(deviations(*lobes(3, 4, np.radians(start))))
        print(f"the first at {start:2}°: {1000 * value:.6f} µm")
    reveal(from_four, "0, to a thousandth of a µm, wherever the first one lies")

# %% [markdown]
# **Not small: nothing.** At four places, a quarter of a turn apart, $\cos 3\theta$ and $\cos\theta$ cannot be told apart:
# draw both, and at 0°, 90°, 180°, 270° they agree. So three lobes, seen at four places, look like *one* wave. And one wave is
# place, and is taken away. Engineers call it **aliasing**; films show it as wheels that turn backwards.
#
# How many places are enough? In the next picture each number of places is tried from all starting points. The band goes from
# the least that is reported to the most; the truth is the line at 12 µm. Which numbers are hopeless for three lobes?

# %%
hopeless = None  # numbers of places, above 3

# %% fold=true
with once_written():
    figure = paper(380, three_lobes=palette.U, five_lobes=palette.W, the_truth=palette.INK)
    numbers = np.arange(4, 25)
    draw(figure, (3.5, 24.5), (12, 12), width=1.5, dash="dot")
    for n, colour in ((3, palette.U), (5, palette.W)):
        starts = np.linspace(0, 2 * np.pi, 61)
        out = np.array([[1000 * np.ptp(deviations(*lobes(n, m, at))) for at in starts] for m in numbers])
        low, high = out.min(axis=1), out.max(axis=1)
        for at, *ends in zip(numbers + (n - 4) * 0.14, low, high, strict=True):
            draw(figure, (at, at), ends, colour, 5)
        draw(figure, numbers + (n - 4) * 0.14, low, colour, mode="markers")
        print(f"{n} lobes, 0 at worst from", ", ".join(str(m) for m in numbers[low < 1e-3]), "places")
    figure.update_xaxes(title="places probed, evenly all round", tickvals=numbers[::2])
    figure.update_yaxes(title="reported, µm", range=[-0.6, 13])
    display(figure)
reveal(hopeless, "4, always; and 6, if it starts badly")

# %% [markdown]
# **Never more than the truth, and often much less.** Five lobes vanish from four, five and six places, always, and with bad
# luck from ten. The rule behind it: at $m$ places the waves $n$ and $m - n$ look alike. So take clearly more places than
# twice the waves that you fear, and rather an odd number.
#
# Leave points away from a cloud that you have. The minimum zone can then only shrink: what held all of them holds the rest. Is
# that also true of least squares?

# %%
squares_too = None  # "yes" or "no"

# %%
all_in = both(rail(along, h), dx.flatness)
fewer = [both(rail(np.delete(along, out), np.delete(h, out)), dx.flatness) for out in range(11)]
print(f"all eleven places:   least squares {all_in[0]:.2f} µm, minimum zone {all_in[1]:.2f} µm")
worst = np.max(fewer, axis=0)
print(f"without one of them: least squares {worst[0]:.2f} µm, minimum zone {worst[1]:.2f} µm at most")
reveal(squares_too, "no: leave a place away, and the rail may get worse")

# %% [markdown]
# ## 7 · The calliper
#
# No machine at hand? Take a calliper. Measure the diameter, turn the part, measure again, all round: if it never changes, the
# part is round. Is it?
#
# Describe a section by its *support*: $h(\varphi)$ is how far out a straight edge touches it that stands across the direction
# $\varphi$. Two jaws are two such edges, opposite each other. Take
#
# $$h(\varphi) = 20 + 1.5 \cos 3\varphi$$
#
# How wide is it between the jaws, in the direction $\varphi$? Write the line, before you look at the shape.


# %%
def support(phi):
    return 20 + 1.5 * np.cos(3 * phi)


def width(h, phi):
    """How far the jaws are apart in the direction phi, where a section has the support h."""
    ### BEGIN SOLUTION
    return h(phi) + h(phi + np.pi)
    ### END SOLUTION


# %%
varies = None  # by how much the calliper goes up and down while the part is turned, in mm

# %%
phi = np.linspace(0, 2 * np.pi, 721)
with once_written():
    holds("a circle is as wide as its diameter", width(lambda phi: 20 + 0 * phi, phi), 40)
    oval_widths = width(lambda phi: 20 + 1.5 * np.cos(2 * phi), np.array([0, np.pi / 2]))
    holds("an oval is not", oval_widths, [43, 37])
    moved = width(lambda phi: support(phi) + 5 * np.cos(phi), phi)
    holds("5 mm to the side: the same", moved, width(support, phi))

# %% fold=true
figure = paper(260).update_layout(margin={"l": 10, "r": 10, "t": 10, "b": 10})
out = np.stack([np.cos(phi), np.sin(phi)])
coin = support(phi) * out - 4.5 * np.sin(3 * phi) * np.stack([-np.sin(phi), np.cos(phi)])  # h and h' along and across
for place, by in enumerate(np.radians((0, 12, 30))):
    turned = np.array([[np.cos(by), -np.sin(by)], [np.sin(by), np.cos(by)]]) @ coin
    sit = np.array([52 * place, -20 - turned[1].min()])
    draw(figure, turned[0] + sit[0], turned[1] + sit[1], palette.CURVE, 4)
    for edge in (18.5, 21.5):
        draw(figure, edge * out[0] + sit[0], edge * out[1] + sit[1], palette.INK, 1.5, "dot")
for jaw in (-20, 20):
    draw(figure, (-30, 134), (jaw, jaw), palette.U, 5)
figure.update_xaxes(visible=False).update_yaxes(visible=False, scaleanchor="x")
with once_written():
    reveal(varies, f"{np.ptp(width(support, phi)):.3f}", "mm")
print(f"out of round, between the dotted circles: {np.ptp(np.hypot(*coin)):.3f} mm")
figure

# %% [markdown]
# **A curve of constant width.** It rolls between two rulers like a wheel, and is 3 mm out of round. The seven-sided
# British 50p is one, so that a slot machine may measure it however it falls in.
#
# What the calliper adds is the wave at $\varphi$ and at $\varphi + 180°$: even numbers of waves are doubled, **odd ones
# cancel**. And just these are common: a chuck with three jaws makes three lobes, grinding without centres three or five.

# %% [markdown]
# The workshop's answer is a **V-block**: two flanks below, a gauge above. Three contacts; that must see three lobes. Old hands
# keep two, a V of 60° and one of 90°, beside the calliper. Is there a number of lobes, from 2 to 9, that gets past all three?

# %%
past_all = None  # a number of lobes, or "none"

# %% [markdown]
# A small lobe under a flank lifts the part. The flanks touch at $90° + \alpha/2$ to both sides of the gauge, where $\alpha$ is
# the angle of the V, and a lobe of height $\varepsilon$ under both lifts it by $\varepsilon / \sin(\alpha/2)$. So the gauge
# shows $n$ lobes
#
# $$1 + \frac{\cos\, n(90° + \alpha/2)}{\sin(\alpha/2)}$$
#
# times as large as they are. A flat plate is a V of 180°: that is the calliper.

# %%
lobe = np.arange(2, 10)
shown = {}
print("lobes            ", "".join(f"{n:7}" for n in lobe))
for alpha in (180, 60, 90, 120):
    half = np.radians(alpha / 2)
    shown[alpha] = np.round(1 + np.cos(lobe * (np.pi / 2 + half)) / np.sin(half), 9) + 0.0
    print(f"V of {alpha:3}°: times ", "".join(f"{times:7.2f}" for times in shown[alpha]))
blind = [n for i, n in enumerate(lobe) if not any(shown[alpha][i] for alpha in (180, 60, 90))]
reveal(past_all, f"{', '.join(map(str, blind))}: as many as the coin has sides")

# %% [markdown]
# The V of 60° sees multiples of three and nothing else, and those three times too large. So no reading of a calliper or a V is
# a roundness. It becomes one if somebody tells you the number of lobes; and whoever knows that, has already measured in
# another way.
#
# (The last row, 120°, misses none of these; but look at six, which it makes small, and turns hills into dales.)

# %% [markdown]
# ## 8 · Round, and no cylinder
#
# Back to the whole part. Here are three others, and *every section of each is a perfect circle*. One is bent by 10 µm, one is
# tapered by 10 µm in radius from end to end, one is a barrel, 10 µm thicker in the middle. Roundness 0, everywhere. Which of
# them has the worst cylindricity, and how much?

# %%
worst_of_three = None  # "bent", "tapered" or "barrel", and how many µm

# %% fold=true
shapes = {  # radius and sideways shift, at the heights -30 to 30: s from -1 to 1
    "bent": lambda s: (20 + 0 * s, 0.010 * (1 - s**2)),
    "tapered": lambda s: (20 + 0.005 * s, 0 * s),
    "barrel": lambda s: (20 + 0.010 * (1 - s**2), 0 * s),
}
figure = paper(330, the_part_from_the_side=palette.CURVE, its_narrowest_zone=palette.REFERENCE)
figure.update_layout(margin={"l": 10, "r": 10, "b": 10})
s, turn = np.linspace(-1, 1, 41), 2 * np.pi * np.arange(24) / 24
report = ""
for place, (name, shape) in enumerate(shapes.items()):
    radius, shift = (value[::5, None] for value in shape(s))
    points = around(turn, radius, 30 * s[::5, None]) + shift[..., None] * [1, 0, 0]
    squares, narrowest = both(points.reshape(-1, 3), dx.cylindricity)
    report += f"{name:8} cylindricity: least squares {squares:5.2f} µm, minimum zone {narrowest:5.2f} µm\n"
    zone = dx.cylindricity(points.reshape(-1, 3), method="minimum zone")
    for side in (-1, 1):
        radius, shift = shape(s)
        off = side * (radius - 20) + shift
        edges = side * (zone.form.radius - 20 + np.array([-1, 1]) * zone.value / 2) + zone.form.point[0]
        box = {"fillcolor": palette.REFERENCE, "opacity": 0.35, "line": {"width": 0}, "y0": -30, "y1": 30, "layer": "below"}
        figure.add_shape(x0=78 * place + 20 * side + 400 * edges[0], x1=78 * place + 20 * side + 400 * edges[1], **box)
        draw(figure, 78 * place + 20 * side + 400 * off, 30 * s, palette.CURVE)
    for end in (-1, 1):
        radius, shift = shape(end)
        ends = np.array([-1, 1]) * (20 + 400 * (radius - 20)) + 400 * shift
        draw(figure, 78 * place + ends, (30 * end, 30 * end), palette.CURVE)
    figure.add_annotation(x=78 * place, y=0, text=f"{name}<br>× 400", showarrow=False, font={"size": 14})
figure.update_xaxes(visible=False).update_yaxes(visible=False, scaleanchor="x")
print(report)
reveal(worst_of_three, "none: 10 µm each")
figure

# %% [markdown]
# **The number cannot tell them apart.** It is the same for a bar that was bent in hardening, for one turned with the tailstock
# off its line, and for one that gave way in the middle under the tool. (Least squares makes more of the bent one: most of its
# rings lie towards one side of the zone.)
#
# What does hold: cut the narrowest zone across its axis, and you get two concentric circles, just as far apart. So in every
# section *roundness is at most cylindricity*. Not the other way round:

# %%
with once_written():
    rings = (clamped.inverse() @ cloud).reshape(8, 25, 3)  # as if somebody had told us how it lies
    rounds = [1000 * np.ptp(deviations(*ring[:, :2].T)) for ring in rings]
    print("roundness of the eight rings, µm:", ", ".join(f"{value:.1f}" for value in rounds))
    print(f"cylindricity of the part, µm:     {narrowest_of_part:.1f}")

# %% [markdown]
# ## 9 · A grain of dust
#
# In one of the two hundred places lies a grain of dust, 30 µm high. Three numbers, with dust and without: both zones, and the
# root mean square of what is left. Which of them is hardly impressed?

# %%
calm = None  # "least squares zone", "minimum zone" or "root mean square"

# %%
dusty = cloud.copy()
away = cloud[88] - a - (cloud[88] - a) @ k * k
dusty[88] += 0.030 * away / np.linalg.norm(away)
for name, points in (("clean", cloud), ("dusty", dusty)):
    squares, narrowest = both(points, dx.cylindricity)
    rms = 1000 * dx.cylindricity(points).rms
    print(f"{name}: least squares {squares:.2f}, minimum zone {narrowest:.2f}, root mean square {rms:.2f} µm")
most = np.sort(1000 * dx.cylindricity(dusty).residuals)[:-6:-1]
print("what sticks out most, µm:", ", ".join(f"{one:.1f}" for one in most))
reveal(calm, "root mean square: one point in two hundred has little weight there")

# %% [markdown]
# **A zone is as wide as its worst point.** That is no weakness, it is what was asked for: a shaft that jams does so at one
# place. But then the answer for two hundred places hangs on one, and the root mean square, which stays calm, would stay calm
# about a real burr too.
#
# The last line shows how one finds the grain: one number stands alone. Wipe the part and probe again *there*. Throwing it out
# since it looks odd is a decision, and whoever takes it writes it down. No formula knows dust from a burr.

# %% [markdown]
# Dust is rare, trembling is not. Now a *perfect* cylinder, by a probe that trembles by half a µm (standard deviation) each
# time. Few places miss lobes, said section 6. So take 20, 200, 2000: what becomes of the cylindricity?

# %%
with_more_places = None  # "it goes to 0", "it stays" or "it grows"

# %%
for places in (20, 200, 2000):
    at = 2.4 * np.arange(places), np.linspace(-30, 30, places)  # winding up round the part
    trembling = np.random.default_rng(places).normal(0, 0.0005, places)
    perfect = around(at[0], 20 + trembling, at[1])
    print(f"{places:4} places on a perfect part: {1000 * dx.cylindricity(perfect).value:.2f} µm")
reveal(with_more_places, "it grows, slowly and without end")

# %% [markdown]
# **Nobody ever measures 0.** A range keeps what is worst, and who asks more often hears worse. So neither few places nor many:
# enough for the waves that matter, and a *filter* that takes the quicker ones away before the range is taken. For roundness
# 50 waves a turn has long been the usual limit.

# %% [markdown]
# ## 10 · The limit: how short may a cylinder be?
#
# The last part is **oval**: radius 20.01 one way, 19.99 the other, all along. Roundness and cylindricity are 20 µm, clear
# enough. Two rings are probed, one above the other, and cylindricity is asked for, with a fitted axis. Somebody is in a hurry
# and probes the second ring hardly above the first.
#
# Let their distance go to 0. What is reported then?

# %%
in_the_end = None  # µm


# %%
def oval(apart, by=0.01):
    """Two rings of 24 places on an oval bar, of radius 20 + by one way and 20 - by the other."""
    angle = 2 * np.pi * np.arange(24) / 24
    one = around(angle, 1, 0) * [20 + by, 20 - by, 0]
    return np.concatenate([one, one + (0, 0, apart)])


print("   apart   least squares   minimum zone     its axis leans")
for apart in (20, 1, 0.6, 0.4, 0.1, 0.01):
    zones = [dx.cylindricity(oval(apart), method=method) for method in ("least squares", "minimum zone")]
    squares, narrowest = (1000 * zone.value for zone in zones)
    lean = np.degrees(np.arcsin(np.hypot(*zones[1].form.axis[:2])))
    print(f"{apart:5} mm {squares:12.2f} µm {narrowest:11.2f} µm {lean:17.2f}°")
reveal(in_the_end, "0")

# %% [markdown]
# **What happened?** Cut a perfect cylinder aslant: the section is an ellipse. And our oval is one. So *a single oval ring lies
# on a perfect cylinder*, one that leans, here by $\arccos(19.99/20.01) = 2.56°$. While the second ring is far away, leaning
# costs more than it gains. When it is close, the best cylinder tips over, and takes the whole error with it.

# %% fold=true
rings = oval(0.5, by=4)
tipped = dx.cylindricity(rings)
figure = plot.view(tipped.surface(), points=rings, lines=2, title="400 times as oval: radius 24 one way, 16 the other")
figure.update_traces(marker={"color": palette.MARK, "size": 6}, selector={"name": "measured"})
figure.update_traces(opacity=0.5, selector={"type": "surface"})
figure.update_layout(scene_camera_eye={"x": 0.35, "y": -1.75, "z": 0.55})

# %% [markdown]
# (At 0.6 mm look twice: least squares leans already, and reports *more* than 20. It makes squares small, not zones.)
#
# At 0 the library refuses:

# %%
try:
    dx.cylindricity(oval(0))
except dx.GeometryError as refused:
    print(refused)
about_z = dx.cylindricity(oval(0), axis_point=(0, 0, 0), axis_direction=(0, 0, 1))
print(f"about the axis that the drawing gives: {1000 * about_z.value:.2f} µm")

# %% [markdown]
# A **given axis** cannot tip over. (Strictly that is no longer a form error: with a datum axis the drawing would say *total
# run-out*.)
#
# All the way the answer was right, for the question that was asked. In chapter 1 a torus became a sphere, and the
# topology did not go along. Here a cylinder became a circle, and the *question* did not: a ring has no axis to be measured
# from.

# %% [markdown]
# ## The answer
#
# How far is the part from round? Ask ten people who have the same part:

# %%
with once_written():
    answers = {
        "from the axis in the drawing": 1000 * np.ptp(distances(cloud, (0, 0, 140), (0, 0, 1))),
        "least squares": squares_of_part,
        "minimum zone": narrowest_of_part,
        "minimum zone, with dust": both(dusty, dx.cylindricity)[1],
        "as plus or minus, half the zone": narrowest_of_part / 2,
        "root mean square": 1000 * dx.cylindricity(cloud).rms,
        "roundness of the worst ring": max(rounds),
        "roundness of a ring of four places": 1000 * np.ptp(deviations(*lobes(3, 4))),
        "calliper, once round the middle": 1000 * np.ptp(width(lambda phi: 20 + lobed(phi, 0), phi)),
        "gauge over a V of 60°": 12 * shown[60][1],
    }
    for name, value in answers.items():
        print(f"{name:36}{value:7.1f} µm")

# %% [markdown]
# (The last three without the probe's trembling.) Nobody has miscalculated. *A form error is a number and a sentence*: which
# ideal form, laid how, through which points. ISO 1101 says what the zone is: two planes, two concentric circles, two coaxial
# cylinders, as close as can be. ISO 12181 for roundness, 12180 for cylindricity and 12781 for flatness say how to complete the
# sentence.
#
# Balls, cones and tori go the same way: `dx.sphericity`, `dx.conicity`, `dx.toricity`.
#
# To read on: A. B. Forbes, *Least-squares best-fit geometric elements*, NPL report DITC 140/89, by which this library fits.

# %% [markdown]
# ## Where to go from here
#
# Write flatness and cylindricity yourself in [A8 · Boundary curves and solids](../A8/boundary-and-solids.ipynb), with the axis
# given, so that nothing can tip over. A ball comes in [A9](../A9/further.ipynb), where its centre falls out of a linear system.
#
# Left open: these forms had names. Two hundred points of a *car door* have none. Then the ideal form is itself one of the
# patches of the chapters before, and someone has to say which $(u, w)$ each point belongs to: `patch.nearest(points)` does.
#
# Next: [When two formulas are one surface](06-when-two-formulas-are-one-surface.ipynb).
