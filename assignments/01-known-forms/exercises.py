"""A1, known forms: five surfaces written down directly, and the question when a torus becomes a sphere.

One file, and a long one: each exercise stands here whole, its reference, its data and its mistakes one below the other.
Conventions: u and w in [0, 1], one turn = 2π times the parameter, right-hand sense. Oracle numbers: tests/assignments.
"""

import directrix as dx
import numpy as np

from autograder.exercise import exercise


def points(x, y, z):
    """Coordinates that broadcast against each other, as points of shape (..., 3)."""
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


def away_from_one(rng):
    """A length that cannot be mistaken for 1, where r, r² and 1 look alike."""
    return rng.choice([rng.uniform(0.4, 0.7), rng.uniform(1.5, 4.0)])


# A1.1 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=4, title="Cylinder from its known form", kind="surface")
def cylinder(u, w, r, h):
    """Return the points of the cylinder of radius r about the z axis, from z = 0 to z = h.

    u runs once round, from +x towards +y; w runs along the axis, from z = 0 (w = 0) to z = h (w = 1).

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    r : radius, a length above 0
    h : z of the far end, a length that is not 0; below 0 the cylinder hangs down from the xy-plane

    Returns the points, shape of u and w together + (3,), in the unit of r and h.
    """
    return dx.Cylinder(r, h)(u, w)


@cylinder.data
def lecture(rng):
    return {"r": 2.0, "h": 5.0}


@cylinder.data
def any_size(rng):
    return {"r": away_from_one(rng), "h": rng.uniform(4.5, 6.0)}


@cylinder.data
def hanging_down(rng):
    return {"r": rng.uniform(1.2, 3.0), "h": -rng.uniform(1.5, 4.0)}


@cylinder.data(blind=True)
def unit_cylinder(rng):
    return {"r": 1.0, "h": 1.0}


@cylinder.mistake("no_2pi", credit=0.25)
def _(u, w, r, h):
    """You took u itself for the angle. u ends at 1, and one radian is less than a sixth of the way round: your patch is a
    sliver that never closes. Which angle brings you back to where you started?"""
    return points(r * np.cos(u), r * np.sin(u), h * w)


@cylinder.mistake("diameter", credit=0.5)
def _(u, w, r, h):
    """Your circle is half as wide as it should be: you read r as the diameter. Put your point at u = 0 and measure how far it
    is from the axis."""
    return points(r / 2 * np.cos(2 * np.pi * u), r / 2 * np.sin(2 * np.pi * u), h * w)


@cylinder.mistake("minus_h", credit=0.5)
def _(u, w, r, h):
    """You have the lecture's *other* cylinder: the same radius, height and axis, grown in the opposite direction. Those three
    words do not fix the place; the statement does. At which z does it ask for the edge w = 1?"""
    return points(r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), -h * w)


@cylinder.mistake("clockwise", credit=0.5)
def _(u, w, r, h):
    """The right cylinder, run round the wrong way: seen from above, your u goes clockwise. Look at your point a quarter of the
    way round, u = 1/4: does it lie on +y?"""
    return points(r * np.cos(2 * np.pi * u), -r * np.sin(2 * np.pi * u), h * w)


@cylinder.mistake("swap_uw", credit=0.5)
def _(u, w, r, h):
    """The right cylinder with the two parameters exchanged: your w goes round and your u goes up. Walk along u alone, with w
    held at 0: the statement wants a circle there, and you get a straight line."""
    return points(r * np.cos(2 * np.pi * w), r * np.sin(2 * np.pi * w), h * u)


@cylinder.mistake("centred", credit=0.5)
def _(u, w, r, h):
    """The right cylinder in the wrong place: yours sits astride the xy-plane, half above and half below. Look at z on your
    edge w = 0."""
    return points(r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), h * (w - 0.5))


@cylinder.mistake("no_height", credit=0.5)
def _(u, w, r, h):
    """The circle is right, but your cylinder is 1 tall whatever h is: the height never enters. On the unit cylinder nobody
    notices; look at the edge w = 1 of a taller one."""
    return points(r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), w)


@cylinder.mistake("starts_on_y", credit=0.5)
def _(u, w, r, h):
    """You exchanged sine and cosine: your circle starts on the y axis and runs back towards +x. Put u = 0 into your formula:
    which axis does the statement name for the start?"""
    return points(r * np.sin(2 * np.pi * u), r * np.cos(2 * np.pi * u), h * w)


# A1.2 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Cone and frustum", kind="surface")
def frustum(u, w, r1, r2, h):
    """Return the points of the cone frustum about the z axis between the circle of radius r1 in z = 0 and that of radius r2 in z = h.

    u runs once round, from +x towards +y; w runs straight along the rulings, from r1 (w = 0) to r2 (w = 1).
    A radius may be 0: then that whole edge of the patch is one point, the apex.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    r1, r2 : radii, lengths of 0 or more, not both 0
    h : height measured along the axis, a length above 0

    Returns the points, shape of u and w together + (3,).
    """
    return dx.Cone(r1, r2, h)(u, w)


def _frustum(angle, rho, z):
    return points(rho * np.cos(angle), rho * np.sin(angle), z)


@frustum.data
def lecture(rng):
    return {"r1": 3.0, "r2": 1.0, "h": 4.0}


@frustum.data
def wider_above(rng):
    return {"r1": rng.uniform(0.5, 1.5), "r2": rng.uniform(2.0, 3.5), "h": rng.uniform(2.5, 5.0)}


@frustum.data
def apex_above(rng):
    return {"r1": rng.uniform(1.0, 2.5), "r2": 0.0, "h": rng.uniform(2.6, 4.0)}


@frustum.data
def apex_below(rng):
    return {"r1": 0.0, "r2": rng.uniform(1.0, 2.5), "h": rng.uniform(2.6, 4.0)}


@frustum.data(blind=True)
def equal_radii(rng):
    return {"r1": 1.0, "r2": 1.0, "h": 2.0}


@frustum.mistake("radii_swapped", credit=0.5)
def _(u, w, r1, r2, h):
    """The right frustum, standing on its head: your circle of radius r1 is at the top. Which radius does your formula give
    where w = 0?"""
    return _frustum(2 * np.pi * u, r2 + (r1 - r2) * w, h * w)


@frustum.mistake("sum_not_diff", credit=0.25)
def _(u, w, r1, r2, h):
    """Your radius starts well and then grows by the whole of r2. It must *arrive* at r2: from r1 it has only the rest of the way
    to go. Put w = 1 into your radius and read what comes out."""
    return _frustum(2 * np.pi * u, r1 + r2 * w, h * w)


@frustum.mistake("mean_radius", credit=0.25)
def _(u, w, r1, r2, h):
    """You used one radius, the mean of the two, all the way up: that is a cylinder. On a frustum the radius changes with
    the height; which parameter should it depend on?"""
    return _frustum(2 * np.pi * u, (r1 + r2) / 2, h * w)


@frustum.mistake("slant_as_height", credit=0.5)
def _(u, w, r1, r2, h):
    """You read h as the length of a ruling on the slant. It is the height along the axis, between the two planes. At which z
    does your upper circle lie?"""
    return _frustum(2 * np.pi * u, r1 + (r2 - r1) * w, w * np.sqrt(max(h**2 - (r2 - r1) ** 2, 0.0)))


@frustum.mistake("degrees", credit=0.5)
def _(u, w, r1, r2, h):
    """You turn by 360 u. NumPy's sine and cosine take radians, so your frustum goes round more than 57 times and ends in the
    middle of a turn. The picture hides it, since each round covers the last; look at where your edge u = 1 is."""
    return _frustum(360 * u, r1 + (r2 - r1) * w, h * w)


@frustum.mistake("always_a_tip", credit=0.25)
def _(u, w, r1, r2, h):
    """Yours is always a complete cone: its radius shrinks to 0 at w = 1, and r2 never enters. With r2 = 0 that is right; look
    at the upper edge when r2 is not 0."""
    return _frustum(2 * np.pi * u, r1 * (1 - w), h * w)


# A1.3 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=5, title="Sphere: a semicircle swept a whole turn", kind="surface", accept={"same set": 0.5})
def sphere(u, w, r):
    """Return the points of the sphere of radius r about the origin: a semicircle turned once about the z axis.

    u runs along the semicircle, in the xz-plane on the side x >= 0, from the south pole (0, 0, -r) to the north pole (0, 0, r);
    w turns it about the z axis, from +x towards +y. Both edges u = 0 and u = 1 are single points, the poles.

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    r : radius, a length above 0

    Returns the points, shape of u and w together + (3,).
    """
    return dx.Sphere(r)(u, w)


@sphere.data
def lecture(rng):
    return {"r": 2.0}


@sphere.data
def any_size(rng):
    return {"r": away_from_one(rng)}


@sphere.data(blind=True)
def unit_sphere(rng):
    return {"r": 1.0}


def _ball(r, latitude, longitude):
    return r * points(np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude))


@sphere.mistake("full_circle", credit=0.5)
def _(u, w, r):
    """Your generatrix is a whole circle, and w turns it a whole turn: you have the sphere, covered twice. How much of the
    circle is enough, if w takes it all the way round?"""
    return _ball(r, 2 * np.pi * u, 2 * np.pi * w)


@sphere.mistake("lat_0_to_pi", credit=0.25)
def _(u, w, r):
    """You have a semicircle, but the upper one: it begins at the equator, passes over the north pole and comes down on the far
    side. Turned about z it covers the upper half twice and the lower half never. Where is your point for u = 0?"""
    return _ball(r, np.pi * u, 2 * np.pi * w)


@sphere.mistake("north_first", credit=0.5)
def _(u, w, r):
    """The right sphere, with the semicircle run from north to south: you measured the angle from the north pole. At which pole
    does the statement begin?"""
    return points(
        r * np.sin(np.pi * u) * np.cos(2 * np.pi * w), r * np.sin(np.pi * u) * np.sin(2 * np.pi * w), r * np.cos(np.pi * u)
    )


@sphere.mistake("swap_uw", credit=0.5)
def _(u, w, r):
    """The right sphere with the two parameters exchanged: your u goes round and your w climbs. In a sweep u runs along the
    generatrix; which of your parameters moves along the semicircle?"""
    return _ball(r, np.pi * (w - 0.5), 2 * np.pi * u)


@sphere.mistake("no_cos_on_xy", credit=0.25)
def _(u, w, r):
    """Your height is right, but every circle of latitude has the full radius r: that is a cylinder round the sphere. How wide
    is the circle near the pole?"""
    return points(r * np.cos(2 * np.pi * w), r * np.sin(2 * np.pi * w), r * np.sin(np.pi * (u - 0.5)))


@sphere.mistake("sin_cos_mixed", credit=0.25)
def _(u, w, r):
    """Two books in one formula: the sine and cosine are those for an angle measured from the pole, the angle is the one measured
    from the equator. Together they cover the upper half twice. Put u = 0 in: are you at the south pole?"""
    latitude = np.pi * (u - 0.5)
    return points(
        r * np.sin(latitude) * np.cos(2 * np.pi * w), r * np.sin(latitude) * np.sin(2 * np.pi * w), r * np.cos(latitude)
    )


@sphere.mistake("z_without_r", credit=0.5)
def _(u, w, r):
    """x and y are right, but your z only reaches from -1 to 1, whatever the radius: a flattened or stretched ball. On the unit
    sphere nobody sees it; how high is the north pole of yours?"""
    return _ball(r, np.pi * (u - 0.5), 2 * np.pi * w) * [1, 1, 1 / r]


# A1.4 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="Torus: a circle swept along a circle", kind="surface", accept={"other start": 0.5})
def torus(u, w, R, r):
    """Return the points of the torus: a circle of radius r, its centre at distance R from the z axis, turned once about z.

    u runs round the small circle, which lies in the xz-plane with its centre at (R, 0, 0), from its outermost point upwards;
    w turns it about the z axis, from +x towards +y.
    R may be smaller than r (the tube then cuts through itself), or 0 (the tube becomes a sphere, covered twice).

    u, w : numbers or arrays in [0, 1] that broadcast against each other
    R : distance from the axis to the centre of the tube, a length of 0 or more
    r : radius of the tube, a length above 0

    Returns the points, shape of u and w together + (3,).
    """
    return dx.Torus(R, r)(u, w)


def _ring(centre, tube, height, longitude):
    return points((centre + tube) * np.cos(longitude), (centre + tube) * np.sin(longitude), height)


@torus.data
def lecture(rng):
    return {"R": 3.0, "r": 1.0}


@torus.data
def ring(rng):
    r = away_from_one(rng)
    return {"R": r + rng.uniform(0.8, 2.0), "r": r}


@torus.data
def spindle(rng):
    r = rng.uniform(1.5, 3.0)
    return {"R": r * rng.uniform(0.3, 0.7), "r": r}


@torus.data
def no_hole_left(rng):
    return {"R": 0.0, "r": rng.uniform(1.5, 3.0)}


@torus.data(blind=True)
def horn(rng):
    return {"R": 2.0, "r": 2.0}


@torus.mistake("R_is_outer", credit=0.5)
def _(u, w, R, r):
    """A good torus, too small: you read R as the radius of the outer rim. R is measured to the centre of the tube. How far from
    the axis is your point for u = 0, and how far should it be?"""
    return _ring(R - r, r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), 2 * np.pi * w)


@torus.mistake("translated_not_turned", credit=0.25)
def _(u, w, R, r):
    """Your small circle is *carried* along the big one and always stays parallel to the xz-plane. Circle on circle means that it
    *turns* as it goes, always in a plane through the axis. Look at your small circle a quarter of the way round, at w = 1/4."""
    phi, theta = 2 * np.pi * u, 2 * np.pi * w
    return points(R * np.cos(theta) + r * np.cos(phi), R * np.sin(theta), r * np.sin(phi))


@torus.mistake("z_uses_R", credit=0.25)
def _(u, w, R, r):
    """x and y are right, but your tube is R tall instead of r: its section is an ellipse. Which of the two radii belongs to the
    small circle? With R = r the two look the same."""
    return _ring(R, r * np.cos(2 * np.pi * u), R * np.sin(2 * np.pi * u), 2 * np.pi * w)


@torus.mistake("no_r", credit=0.25)
def _(u, w, R, r):
    """The tube moves your point up and down, but never in and out: what you have is a cylinder of radius R, passed over twice.
    How far from the axis is the outermost point of the small circle, and the innermost?"""
    return _ring(R, 0.0, r * np.sin(2 * np.pi * u), 2 * np.pi * w)


@torus.mistake("swap_uw", credit=0.5)
def _(u, w, R, r):
    """The right torus with the two parameters exchanged: your u takes the long way round the axis, your w the short way round
    the tube. Which circle is the generatrix, and which parameter runs along it?"""
    return _ring(R, r * np.cos(2 * np.pi * w), r * np.sin(2 * np.pi * w), 2 * np.pi * u)


@torus.mistake("half_tube", credit=0.25)
def _(u, w, R, r):
    """You have the upper half of the torus: your u goes only half of the way round the tube. For the sphere a semicircle was
    enough; what is different here?"""
    return _ring(R, r * np.cos(np.pi * u), r * np.sin(np.pi * u), 2 * np.pi * w)


@torus.mistake("radii_swapped", credit=0.5)
def _(u, w, R, r):
    """A torus, but with the two radii exchanged: r is your distance from the axis and R your tube. Put u = 1/4 in, the top of
    the tube: how high is it?"""
    return _ring(r, R * np.cos(2 * np.pi * u), R * np.sin(2 * np.pi * u), 2 * np.pi * w)


# A1.5 ------------------------------------------------------------------------------------------------------------------------


@exercise(points=4, title="When is a torus a sphere?", kind="label")
def torus_class(R, r):
    """Return what the torus of the last exercise is: 'ring', 'horn', 'spindle' or 'sphere'.

    ring: a hole in the middle; horn: the hole has just closed to a point; spindle: the tube cuts through itself;
    sphere: the tube's circle is centred on the axis.

    R : distance from the axis to the centre of the tube, a length of 0 or more
    r : radius of the tube, a length above 0

    Raises ValueError where R is below 0 or r is not above 0: then there is no torus.
    """
    _must_be_a_torus(R, r)
    if R == 0:
        return "sphere"
    if r == R:
        return "horn"
    return "ring" if r < R else "spindle"


def _must_be_a_torus(R, r):
    if not (R >= 0 and r > 0):
        raise ValueError(f"a torus has R >= 0 and r > 0; got R = {R} and r = {r}")


@torus_class.data
def horn(rng):
    return {"R": 1.0, "r": 1.0}


@torus_class.data
def spindle(rng):
    return {"R": 0.5, "r": 1.0}


@torus_class.data
def no_hole_left(rng):
    return {"R": 0.0, "r": 1.0}


@torus_class.data
def any_ring(rng):
    r = away_from_one(rng)
    return {"R": r * rng.uniform(1.05, 3.0), "r": r}


@torus_class.data
def any_horn(rng):
    r = away_from_one(rng)
    return {"R": r, "r": r}


@torus_class.data
def any_spindle(rng):
    r = away_from_one(rng)
    return {"R": r * rng.uniform(0.05, 0.95), "r": r}


@torus_class.data
def negative_R(rng):
    return {"R": -2.0, "r": 1.0}


@torus_class.data
def no_tube(rng):
    return {"R": 2.0, "r": 0.0}


@torus_class.data(blind=True)
def doughnut(rng):
    return {"R": 3.0, "r": 1.0}


@torus_class.mistake("equal_radii_sphere", credit=0.5)
def _(R, r):
    """You call it a sphere when the two radii are equal, as was said in class. That is true if R is measured to the *outermost*
    point of the tube. Here R is measured to its centre: draw the tube for R = r and see where it touches the axis."""
    _must_be_a_torus(R, r)
    if r == R:
        return "sphere"
    return "ring" if r < R else "spindle"


@torus_class.also("equal_radii_sphere")  # beside the right answer for R = 0
def _(R, r):
    _must_be_a_torus(R, r)
    if r == R or R == 0:
        return "sphere"
    return "ring" if r < R else "spindle"


@torus_class.mistake("sphere_never", credit=0.5)
def _(R, r):
    """You treat R = 0 like any other small R. Let R shrink to nothing and watch the small circle: where is its centre in the
    end, and what does it trace when it turns?"""
    _must_be_a_torus(R, r)
    if r == R:
        return "horn"
    return "ring" if r < R else "spindle"


@torus_class.mistake("reversed", credit=0.25)
def _(R, r):
    """You exchanged ring and spindle. Think of a bicycle tyre: which is larger, the distance from the hub to the middle of the
    tyre or the thickness of the tyre?"""
    _must_be_a_torus(R, r)
    if R == 0:
        return "sphere"
    if r == R:
        return "horn"
    return "ring" if r > R else "spindle"
