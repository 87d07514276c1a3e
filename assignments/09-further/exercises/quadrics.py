"""Surfaces given by one equation of the second degree: its value at points, and which surface it is."""

import directrix as dx

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


@quadric_class.data
def saddle(rng):
    return {"coeffs": [0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, -2.0, 0.0]}
