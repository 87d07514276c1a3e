"""Surfaces given by one equation of the second degree: its value at points, and which surface it is."""

import directrix as dx
import numpy as np

from autograder.exercise import exercise

# S1 --------------------------------------------------------------------------------------------------------------------------


@exercise(points=4, title="Which side of a quadric?", kind="value", accept={"close": 0.8})
def quadric_value(coeffs, X):
    """Return the value of the quadric's equation at points: 0 on the surface, of one sign inside, of the other outside.

    The equation is A x² + B y² + C z² + D xy + E yz + F zx + G x + H y + J z + K. There is no letter I.

    coeffs : the ten coefficients A, B, C, D, E, F, G, H, J, K in this order, an array of shape (10,)
    X : points, an array of shape (n, 3)

    Returns the values, an array of shape (n,).
    """
    return dx.Quadric(*coeffs).value(X)


@quadric_value.data
def all_ten(rng):
    return {"coeffs": [1, -2, 3, 4, -5, 6, -7, 8, 9, -10], "X": [[1, 0, 0], [1, 2, -1], [0.5, -1, 2], [-3, 1, 1.5]]}


@quadric_value.data
def any_quadric(rng):
    return {"coeffs": any_size(rng, 10), "X": rng.uniform(-2, 2, (12, 3)) + any_size(rng, 3)}


@quadric_value.data(blind=True)
def ball(rng):
    """No mixed and no linear terms: most of the ten letters do not count."""
    return {"coeffs": [1, 1, 1, 0, 0, 0, 0, 0, 0, -4], "X": [[2, 0, 0], [0, 1, 0], [1, 1, 1], [3, -1, 2]]}


def any_size(rng, count):
    """Random numbers of either sign, none of them near 0."""
    return rng.uniform(1, 3, count) * rng.choice([-1.0, 1.0], count)


def _value(coeffs, X, square=1.0, mixed=1.0, linear=1.0, constant=1.0):
    A, B, C, D, E, F, G, H, J, K = coeffs
    x, y, z = np.asarray(X, dtype=float).T
    second = square * (A * x * x + B * y * y + C * z * z) + mixed * (D * x * y + E * y * z + F * z * x)
    return second + linear * (G * x + H * y + J * z) + constant * K


@quadric_value.mistake("factor_2", credit=0.5)
def _(coeffs, X):
    """You have every mixed and every linear term twice. Some books print 2Dxy and 2Gx; here D and G stand alone. Should your
    matrix be symmetric, then each of these terms comes up in *two* of its places: how much of D belongs into each?"""
    return _value(coeffs, X, mixed=2, linear=2)


@quadric_value.mistake("mixed_halves_forgotten", credit=0.5)
def _(coeffs, X):
    """Squares, linear terms and the constant are right; each of your mixed terms counts twice. In x·Mx the product xy comes up
    once in the first row and once in the second. Try one point with z = 0 and only D different from 0."""
    return _value(coeffs, X, mixed=2)


@quadric_value.mistake("one_triangle", credit=0.5)
def _(coeffs, X):
    """Your squares and the constant are right, and of each other term you have one half: halves above the diagonal of the
    matrix, and nothing below. A quadratic form sums over all places of the matrix, on both sides of the diagonal."""
    return _value(coeffs, X, mixed=0.5, linear=0.5)


@quadric_value.mistake("linear_doubled", credit=0.5)
def _(coeffs, X):
    """All terms of the second degree are right; your linear ones count twice. In the last row *and* in the last column of the
    matrix there is a G. Try a quadric that is a plane: only G and K different from 0."""
    return _value(coeffs, X, linear=2)


@quadric_value.mistake("E_F_exchanged", credit=0.5)
def _(coeffs, X):
    """Two letters have changed places: your E stands at zx and your F at yz. The order goes round: xy, yz, zx. Try a point with
    x = 0: which of D, E and F should still count there?"""
    A, B, C, D, E, F, *rest = coeffs
    return _value([A, B, C, D, F, E, *rest], X)


@quadric_value.mistake("K_forgotten", credit=0.5)
def _(coeffs, X):
    """All terms with x, y and z are right, and the constant is missing: every one of your values is off by the same number.
    What should come out at the origin?"""
    return _value(coeffs, X, constant=0)


@quadric_value.mistake("mixed_ignored", credit=0.25)
def _(coeffs, X):
    """Squares, linear terms and constant are right; D, E and F never enter. On a ball nobody notices. They are what turns a
    quadric out of the directions of x, y and z: where would yours have its axes?"""
    return _value(coeffs, X, mixed=0)


# S2 --------------------------------------------------------------------------------------------------------------------------


@exercise(points=6, title="Which quadric is it?", kind="label")
def quadric_class(coeffs):
    """Return the name of the surface A x² + B y² + C z² + D xy + E yz + F zx + G x + H y + J z + K = 0.

    It may stand anywhere and at any slant. With the axes of its own symmetry, λ1 x² + λ2 y² + λ3 z² and what is left over, it is
    one of 'ellipsoid', 'hyperboloid of one sheet', 'hyperboloid of two sheets', 'cone', 'elliptic paraboloid', 'hyperbolic
    paraboloid', 'elliptic cylinder', 'hyperbolic cylinder', 'parabolic cylinder', 'intersecting planes', 'parallel planes',
    'coincident planes' (also where the equation is linear: one plane), 'line', 'point', 'empty' (no point satisfies it) and
    'everything' (all do). Sphere and round cylinder are not told from ellipsoid and elliptic cylinder. Numbers are rounded:
    what is below 1e-9 of the largest coefficient counts as 0. The data are then far from doubt, a few units in size.

    coeffs : the ten coefficients A, B, C, D, E, F, G, H, J, K in this order, an array of shape (10,)

    Returns one of the sixteen names.
    """
    return dx.Quadric(*coeffs).classify().kind


def moved(rng, coeffs, factor=True):
    """The quadric of these coefficients, turned and carried a few units away, its equation multiplied by some number."""
    A, B, C, D, E, F, G, H, J, K = coeffs
    Q = np.array([[A, D / 2, F / 2, G / 2], [D / 2, B, E / 2, H / 2], [F / 2, E / 2, C, J / 2], [G / 2, H / 2, J / 2, K]])
    T = np.eye(4)
    T[:3, :3] = turned(rng)
    T[:3, 3] = -T[:3, :3] @ (rng.uniform(1, 2, 3) * rng.choice([-1.0, 1.0], 3))
    Q = T.T @ Q @ T * (rng.uniform(0.5, 2.0) * rng.choice([-1.0, 1.0]) if factor else 1.0)
    (A, D, F, G), (_, B, E, H), (_, _, C, J), (_, _, _, K) = Q
    return {"coeffs": [A, B, C, 2 * D, 2 * E, 2 * F, 2 * G, 2 * H, 2 * J, K]}


def turned(rng):
    """A random rotation, each axis of which is at least 25 degrees away from x, y and z."""
    while True:
        turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        if np.abs(turn).max() < 0.9:
            return turn * np.linalg.det(turn)


def lengths(rng):
    """Three lengths, no two of them alike."""
    return rng.permutation([0.8, 1.2, 1.7]) * rng.uniform(0.9, 1.1, 3)


def axes_and(rng, signs, G=0.0, H=0.0, J=0.0, K=0.0):
    """x²/a², y²/b² and z²/c² with these signs, and the rest."""
    return [*(np.array(signs) / lengths(rng) ** 2), 0, 0, 0, G, H, J, K]


# Sixteen classes, two of them twice. The names are pictures, so that they do not tell.


@quadric_class.data(blind=True)
def pebble(rng):
    return moved(rng, axes_and(rng, (1, 1, 1), K=-1))


@quadric_class.data
def cooling_tower(rng):
    return moved(rng, axes_and(rng, (1, 1, -1), K=-1))


@quadric_class.data
def two_bowls(rng):
    return moved(rng, axes_and(rng, (1, 1, -1), K=1))


@quadric_class.data
def sand_glass(rng):
    return moved(rng, axes_and(rng, (1, 1, -1)))


@quadric_class.data
def satellite_dish(rng):
    return moved(rng, axes_and(rng, (1, 1, 0), J=-1))


@quadric_class.data
def saddle(rng):
    return moved(rng, axes_and(rng, (1, -1, 0), J=-1))


@quadric_class.data
def pipe(rng):
    return moved(rng, axes_and(rng, (1, 1, 0), K=-1))


@quadric_class.data
def two_gutters(rng):
    return moved(rng, axes_and(rng, (1, -1, 0), K=-1))


@quadric_class.data
def gutter(rng):
    return moved(rng, axes_and(rng, (1, 0, 0), J=-1))


@quadric_class.data
def open_scissors(rng):
    return moved(rng, axes_and(rng, (1, -1, 0)))


@quadric_class.data
def floor_and_ceiling(rng):
    return moved(rng, axes_and(rng, (1, 0, 0), K=-1))


@quadric_class.data
def sheet_of_paper(rng):
    return moved(rng, axes_and(rng, (1, 0, 0)))


@quadric_class.data
def table_top(rng):
    """A linear equation."""
    return moved(rng, axes_and(rng, (0, 0, 0), J=1))


@quadric_class.data
def wire(rng):
    return moved(rng, axes_and(rng, (1, 1, 0)))


@quadric_class.data
def speck(rng):
    return moved(rng, axes_and(rng, (1, 1, 1)))


@quadric_class.data
def nowhere(rng):
    return moved(rng, axes_and(rng, (1, 1, 1), K=1))


@quadric_class.data
def everywhere(rng):
    return {"coeffs": [0.0] * 10}


@quadric_class.data
def small_numbers(rng):
    """The whole equation times 1e-13: the same surface."""
    return {"coeffs": 1e-13 * np.array(moved(rng, axes_and(rng, (1, 1, -1), K=1), factor=False)["coeffs"])}


@quadric_class.data(blind=True)
def upright_pipe(rng):
    return {"coeffs": axes_and(rng, (1, 1, 0), K=-1)}


def _signs(coeffs, tolerance, zero=0.0):
    """Signs of the eigenvalues of the 3 x 3 block and of the whole 4 x 4 matrix, those that count as 0 left out."""
    A, B, C, D, E, F, G, H, J, K = coeffs
    Q = np.array([[A, D / 2, F / 2, G / 2], [D / 2, B, E / 2, H / 2], [F / 2, E / 2, C, J / 2], [G / 2, H / 2, J / 2, K]])
    limit = tolerance * np.abs(Q).max() + zero
    block, whole = np.linalg.eigvalsh(Q[:3, :3]), np.linalg.eigvalsh(Q)
    return np.sign(block[np.abs(block) > limit]), np.sign(whole[np.abs(whole) > limit])


# By the rank of the block, whether its eigenvalues have one sign, and the rank of the whole.
NAMES = {
    (3, True, 3): "point",
    (3, False, 3): "cone",
    (2, True, 4): "elliptic paraboloid",
    (2, False, 4): "hyperbolic paraboloid",
    (2, False, 3): "hyperbolic cylinder",
    (2, True, 2): "line",
    (2, False, 2): "intersecting planes",
    (1, True, 3): "parabolic cylinder",
    (1, True, 1): "coincident planes",
    (0, True, 2): "coincident planes",
    (0, True, 1): "empty",
    (0, True, 0): "everything",
}


def _named(block, whole):
    """The name that goes with the signs of the eigenvalues."""
    one_sign, empty = bool(abs(block.sum()) == len(block)), bool(abs(whole.sum()) == len(whole))
    key = (len(block), one_sign, len(whole))
    if key in NAMES:
        return NAMES[key]
    if len(block) == 3 and not one_sign:
        return "hyperboloid of one sheet" if whole.prod() > 0 else "hyperboloid of two sheets"
    if empty:
        return "empty"
    return {3: "ellipsoid", 2: "elliptic cylinder", 1: "parallel planes"}.get(len(block), "coincident planes")


@quadric_class.mistake("signs_of_ABC", credit=0.25)
def _(coeffs):
    """You judged by A, B and C, and the mixed terms never enter. That is right as long as the surface stands along x, y and z;
    turn it, and the same surface has other A, B and C. Which three numbers of the matrix stay the same when a body is
    turned?"""
    return _named(*_signs([*coeffs[:3], 0, 0, 0, *coeffs[6:]], 1e-9))


@quadric_class.mistake("determinant_only", credit=0.25)
def _(coeffs):
    """You judged by determinants alone. They tell whether some eigenvalue is 0, and how many signs are even or odd; not *how
    many* are 0, nor whether all have one sign. How would you tell a cone from a single point, or a wire from a pipe?"""
    block, whole = _signs(coeffs, 1e-9)
    if len(whole) < 4:
        return "cone" if len(block) == 3 else "elliptic cylinder"
    if whole.prod() < 0:
        return "ellipsoid" if len(block) == 3 else "elliptic paraboloid"
    return "hyperboloid of one sheet" if len(block) == 3 else "hyperbolic paraboloid"


@quadric_class.mistake("no_tolerance", credit=0.5)
def _(coeffs):
    """Your table of signs is right, and you compare with exactly 0. After a turn a computed eigenvalue that should be 0 is some
    1e-17, of either sign, and a wire becomes a pipe or worse. What is small, compared with the largest coefficient?"""
    return _named(*_signs(coeffs, 0.0))


@quadric_class.mistake("absolute_tolerance", credit=0.75)
def _(coeffs):
    """Nearly: you call small what is below a fixed number. Multiply an equation by 1e-13 and its surface stays the same, but
    for you all its coefficients have vanished. Small, compared with what?"""
    return _named(*_signs(coeffs, 0.0, 1e-9))


@quadric_class.mistake("block_only", credit=0.25)
def _(coeffs):
    """You looked at the terms of the second degree only. They tell an ellipsoid from a hyperboloid, and not a hyperboloid from
    its cone, nor an ellipsoid from a point, from nothing. Where do G, H, J and K enter?"""
    block, _whole = _signs(coeffs, 1e-9)
    if abs(block.sum()) == len(block):
        return {3: "ellipsoid", 2: "elliptic cylinder", 1: "coincident planes", 0: "everything"}[len(block)]
    return "hyperboloid of one sheet" if len(block) == 3 else "hyperbolic cylinder"


@quadric_class.mistake("sheets_exchanged", credit=0.5)
def _(coeffs):
    """Everything is told apart, but your hyperboloids of one and of two sheets have changed places. Take x² + y² - z² = 1, the
    cooling tower in one piece: how many of the four eigenvalues are above 0?"""
    other = {"hyperboloid of one sheet": "hyperboloid of two sheets", "hyperboloid of two sheets": "hyperboloid of one sheet"}
    name = _named(*_signs(coeffs, 1e-9))
    return other.get(name, name)


@quadric_class.mistake("never_empty", credit=0.5)
def _(coeffs):
    """Your table has a surface for everything. But x² + y² + z² = -1 has no point at all, and its block looks as an
    ellipsoid's. What do the four eigenvalues of the whole matrix have in common there?"""
    block, whole = _signs(coeffs, 1e-9)
    return "ellipsoid" if len(block) == 3 and abs(whole.sum()) == 4 else _named(block, whole)
