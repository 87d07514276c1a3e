"""Quadrics: values, the sixteen kinds after any motion, scaling and change of sign, and fitting."""

import numpy as np
import pytest
from directrix.errors import DegenerateError, GeometryError, NumberError, ShapeError
from directrix.quadric import KINDS, Quadric
from directrix.transform import Transform
from hypothesis import given, settings
from hypothesis import strategies as st

inf = np.inf

# Ten coefficients in standard position, kind, and the radii they must give back (None where there are none).
STANDARD = [
    ((1 / 9, 1 / 4, 1, 0, 0, 0, 0, 0, 0, -1), "ellipsoid", (3, 2, 1)),
    ((1, 1, 1, 0, 0, 0, 0, 0, 0, -4), "ellipsoid", (2, 2, 2)),
    ((1 / 9, 1 / 4, -1, 0, 0, 0, 0, 0, 0, -1), "hyperboloid of one sheet", (3, 2, 1)),
    ((1 / 9, 1 / 4, -1, 0, 0, 0, 0, 0, 0, 1), "hyperboloid of two sheets", (3, 2, 1)),
    ((1 / 9, 1 / 4, -1, 0, 0, 0, 0, 0, 0, 0), "cone", (3, 2, 1)),
    ((1 / 3, 1 / 2, 0, 0, 0, 0, 0, 0, -2, 0), "elliptic paraboloid", (3, 2, inf)),
    ((1 / 3, -1 / 2, 0, 0, 0, 0, 0, 0, -2, 0), "hyperbolic paraboloid", (3, 2, inf)),
    ((1 / 9, 1 / 4, 0, 0, 0, 0, 0, 0, 0, -1), "elliptic cylinder", (3, 2, inf)),
    ((1 / 9, -1 / 4, 0, 0, 0, 0, 0, 0, 0, -1), "hyperbolic cylinder", (3, 2, inf)),
    ((1 / 9, -1 / 4, 0, 0, 0, 0, 0, 0, 0, 1), "hyperbolic cylinder", (2, 3, inf)),
    ((1 / 3, 0, 0, 0, 0, 0, 0, 0, -2, 0), "parabolic cylinder", (3, inf, inf)),
    ((1, -4, 0, 0, 0, 0, 0, 0, 0, 0), "intersecting planes", (1, 0.5, inf)),
    ((1, 0, 0, 0, 0, 0, 0, 0, 0, -4), "parallel planes", (2, inf, inf)),
    ((1, 0, 0, 0, 0, 0, 0, 0, 0, 0), "coincident planes", (0, inf, inf)),
    ((0, 0, 0, 0, 0, 0, 1, 2, 2, -9), "coincident planes", (0, inf, inf)),
    ((1, 4, 0, 0, 0, 0, 0, 0, 0, 0), "line", (0, 0, inf)),
    ((1, 4, 2, 0, 0, 0, 0, 0, 0, 0), "point", (0, 0, 0)),
    ((1, 1, 2, 0, 0, 0, 0, 0, 0, 3), "empty", None),
    ((1, 2, 0, 0, 0, 0, 0, 0, 0, 3), "empty", None),
    ((1, 0, 0, 0, 0, 0, 0, 0, 0, 3), "empty", None),
    ((0, 0, 0, 0, 0, 0, 0, 0, 0, 3), "empty", None),
    ((0, 0, 0, 0, 0, 0, 0, 0, 0, 0), "everything", None),
]
NAMES = [f"{kind}-{i}" for i, (_, kind, _) in enumerate(STANDARD)]


def rigid(rng, distance):
    """A random rotation and a translation of up to `distance`, as a 4x4 matrix."""
    R, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    T = np.eye(4)
    T[:3, :3] = R * np.sign(np.linalg.det(R))
    T[:3, 3] = rng.uniform(-distance, distance, 3)
    return T


def on_standard_form(form, X):
    """The left side minus the right side of the standard equation of `Quadric.classify`'s table, at points X."""
    x, y, z = ((X - form.center) @ form.axes.T).T
    a, b, c = form.radii
    with np.errstate(divide="ignore", invalid="ignore"):
        return {
            "ellipsoid": lambda: x**2 / a**2 + y**2 / b**2 + z**2 / c**2 - 1,
            "hyperboloid of one sheet": lambda: x**2 / a**2 + y**2 / b**2 - z**2 / c**2 - 1,
            "hyperboloid of two sheets": lambda: z**2 / c**2 - x**2 / a**2 - y**2 / b**2 - 1,
            "cone": lambda: x**2 / a**2 + y**2 / b**2 - z**2,
            "elliptic paraboloid": lambda: x**2 / a + y**2 / b - 2 * z,
            "hyperbolic paraboloid": lambda: x**2 / a - y**2 / b - 2 * z,
            "elliptic cylinder": lambda: x**2 / a**2 + y**2 / b**2 - 1,
            "hyperbolic cylinder": lambda: x**2 / a**2 - y**2 / b**2 - 1,
            "parabolic cylinder": lambda: x**2 / a - 2 * z,
            "intersecting planes": lambda: x**2 - y**2 / b**2,
            "parallel planes": lambda: x**2 - a**2,
            "line": lambda: x**2 + y**2,
            "point": lambda: x**2 + y**2 + z**2,
        }[form.kind]()


def test_the_table_meets_every_kind():
    assert {kind for _, kind, _ in STANDARD} == set(KINDS)
    assert len(KINDS) == 16


@pytest.mark.parametrize(("coefficients", "kind", "radii"), STANDARD, ids=NAMES)
def test_standard_position(coefficients, kind, radii):
    """In standard position kind and radii are read off, and the sign of the equation does not matter."""
    for sign in (1, -1):
        form = Quadric(*(sign * np.array(coefficients))).classify()
        assert form.kind == kind
        if radii is None:
            assert [form.center, form.axes, form.radii] == [None, None, None]
        else:
            np.testing.assert_allclose(form.radii, radii, rtol=1e-14)


@pytest.mark.parametrize(("coefficients", "kind", "radii"), STANDARD, ids=NAMES)
@pytest.mark.parametrize("distance", [0, 1, 30, 1000])
def test_rigid_motion_scaling_and_factor(coefficients, kind, radii, distance):
    """Kind and radii survive rotation, translation, reflection, change of unit, and any factor of the equation."""
    rng = np.random.default_rng(len(kind) + distance)
    for unit in (1e-9, 1e-3, 1.0, 1e6):
        T = rigid(rng, distance)
        T[:3] *= unit
        if rng.random() < 0.5:
            T[:3, :3] = T[:3, :3] @ np.diag([1, 1, -1])
        factor = rng.choice([-1, 1]) * 10.0 ** rng.integers(-6, 7)
        form = Quadric(*(factor * (Transform(T) @ Quadric(*coefficients)).coefficients)).classify()
        assert form.kind == kind
        if radii is None:
            continue
        expected = np.array(radii, dtype=float)
        if kind not in ("cone", "intersecting planes"):
            expected *= unit
        np.testing.assert_allclose(form.radii, expected, rtol=1e-7 * max(1, distance / 30) ** 2)
        np.testing.assert_allclose(form.axes @ form.axes.T, np.eye(3), atol=1e-14)
        assert np.linalg.det(form.axes) > 0


@pytest.mark.parametrize(("coefficients", "kind", "radii"), [row for row in STANDARD if row[2] and "coincident" not in row[1]])
def test_frame_carries_the_standard_equation(coefficients, kind, radii):
    """Centre, axes and radii together are the same equation: F is a constant multiple of the standard left side."""
    rng = np.random.default_rng(7)
    quadric = Transform(rigid(rng, 3)) @ Quadric(*coefficients)
    form = quadric.classify()
    X = rng.uniform(-5, 5, (50, 3))
    if kind in ("line", "point"):
        assert abs(quadric(form.center)) < 1e-12
        assert np.linalg.norm(quadric.gradient(form.center)) < 1e-12
        if kind == "line":
            assert abs(quadric(form.center + 7 * form.axes[2])) < 1e-11
        return
    ratio = quadric(X) / on_standard_form(form, X)
    np.testing.assert_allclose(ratio, ratio[0], rtol=1e-9)


def test_plane_has_its_normal():
    """x + 2y + 2z = 9 is the plane 3 from the origin, with normal (1, 2, 2)/3."""
    form = Quadric(0, 0, 0, 0, 0, 0, 1, 2, 2, -9).classify()
    np.testing.assert_allclose(form.center, [1, 2, 2], rtol=1e-15)
    np.testing.assert_allclose(form.axes[0], np.array([1, 2, 2]) / 3, rtol=1e-15)


def test_signs_of_A_B_C_do_not_decide():
    """xy = 1 has A = B = C = 0 and is a hyperbolic cylinder; x² + y² + z² + 3xy has three plus signs and is a cone."""
    assert Quadric(0, 0, 0, 1, 0, 0, 0, 0, 0, -1).classify().kind == "hyperbolic cylinder"
    assert Quadric(1, 1, 1, 3, 0, 0, 0, 0, 0, 0).classify().kind == "cone"


def test_nearly_degenerate_forms_keep_their_kind():
    """A paraboloid seen from afar is no cylinder, a tiny sphere far away no point, a thin ellipsoid no cylinder."""
    far = Transform.translate((1e5, 0, 0))
    assert (far @ Quadric(1, 1, 0, 0, 0, 0, 0, 0, -1, 0)).classify().kind == "elliptic paraboloid"
    assert (far @ Quadric(1, 1, 1, 0, 0, 0, 0, 0, 0, -1)).classify().kind == "ellipsoid"
    assert Quadric(1, 1, 1e-10, 0, 0, 0, 0, 0, 0, -1).classify().kind == "ellipsoid"


def test_a_cylinder_carried_along_its_own_axis_needs_the_size():
    """Rounding of a long journey along the axis is invisible in the result; naming its size brings the kind back."""
    cylinder = Quadric(1, 1, 0, 0, 0, 0, 0, 0, 0, -1)
    noisy = Quadric(1, 1, 0, 0, 0, 0, 1e-7, 0, 3e-8, -1)
    assert cylinder.classify().kind == "elliptic cylinder"
    assert noisy.classify().kind == "elliptic paraboloid"
    assert noisy.classify(size=1e6).kind == "elliptic cylinder"
    assert noisy.classify(1e-11).kind == "elliptic cylinder"


def test_value_and_gradient_exact():
    """Whole numbers give whole values; halves are not forgotten and E belongs to yz, F to zx."""
    q = Quadric(1, 2, 3, 4, 5, 6, 7, 8, 9, 10)
    assert q([1, 2, 3]) == 1 + 8 + 27 + 8 + 30 + 18 + 7 + 16 + 27 + 10
    assert q.value([[[1, 0, 0], [0, 0, 1]]]).tolist() == [[18, 22]]
    assert q.gradient([1, 2, 3]).tolist() == [2 + 8 + 18 + 7, 8 + 4 + 15 + 8, 18 + 10 + 6 + 9]
    assert q(np.empty((0, 3))).shape == (0,)
    h = np.array([1, 2, 3, 1])
    assert h @ q.matrix @ h == q([1, 2, 3])
    assert Quadric.from_matrix(q.matrix) == q


@settings(derandomize=True, max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_gradient_is_the_derivative(seed):
    """Central differences of a quadratic are exact: F(x + e) - F(x - e) = 2 e·∇F."""
    rng = np.random.default_rng(seed)
    q = Quadric(*rng.standard_normal(10))
    X, e = rng.standard_normal((2, 5, 3))
    np.testing.assert_allclose(q(X + e) - q(X - e), 2 * (e * q.gradient(X)).sum(axis=1), atol=1e-12)


@settings(derandomize=True, max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_moving_the_quadric_moves_its_points(seed):
    """F'(T x) = F(x) for every affine T that has an inverse."""
    rng = np.random.default_rng(seed)
    q, X, T = Quadric(*rng.standard_normal(10)), rng.standard_normal((6, 3)), np.eye(4)
    T[:3] = rng.standard_normal((3, 4)) + 2 * np.eye(3, 4)
    there = X @ T[:3, :3].T + T[:3, 3]
    back = np.linalg.cond(T) ** 2
    np.testing.assert_allclose((Transform(T) @ q)(there), q(X), atol=1e-12 * back)


def surface_points(kind, rng, n):
    a, b = rng.uniform(0, 2 * np.pi, n), rng.uniform(-1, 1, n)
    return {
        "ellipsoid": np.stack([3 * np.cos(a) * np.cos(b), 2 * np.sin(a) * np.cos(b), np.sin(b)], axis=1),
        "elliptic cylinder": np.stack([3 * np.cos(a), 2 * np.sin(a), 4 * b], axis=1),
        "cone": np.stack([b * np.cos(a), b * np.sin(a), 2 * b], axis=1),
        "hyperbolic paraboloid": np.stack([np.cos(a), b, b * np.cos(a)], axis=1),
        "parabolic cylinder": np.stack([b, np.cos(a), b**2], axis=1),
        "hyperboloid of one sheet": np.stack([np.cosh(b) * np.cos(a), np.cosh(b) * np.sin(a), np.sinh(b)], axis=1),
        "intersecting planes": np.stack([np.cos(a), b, np.where(rng.random(n) < 0.5, b, -2 * b)], axis=1),
    }[kind]


FITTED = ["ellipsoid", "elliptic cylinder", "cone", "hyperbolic paraboloid", "parabolic cylinder", "hyperboloid of one sheet"]


@pytest.mark.parametrize("kind", [*FITTED, "intersecting planes"])
@pytest.mark.parametrize("noise", [0, 1e-9])
def test_through_finds_the_kind(kind, noise):
    """Points of a quadric, moved and scaled, and slightly disturbed, give that quadric's kind back."""
    rng = np.random.default_rng(3)
    for unit in (1e-4, 1.0, 1e4):
        X = surface_points(kind, rng, 60)
        T = rigid(rng, 20)
        X = unit * ((X + noise * rng.standard_normal(X.shape)) @ T[:3, :3].T + T[:3, 3])
        fitted = Quadric.through(X)
        assert fitted.classify().kind == kind
        distance = np.abs(fitted(X)) / np.maximum(np.linalg.norm(fitted.gradient(X), axis=1), 0.1 * unit)
        assert distance.max() < unit * (1e-9 + 10 * noise)


def test_through_nine_points_is_exact():
    """Nine points in general position lie on exactly one quadric."""
    X = np.random.default_rng(5).standard_normal((9, 3))
    assert np.abs(Quadric.through(X)(X)).max() < 1e-11


@pytest.mark.parametrize(
    ("points", "message"),
    [
        (np.zeros((8, 3)), r"n >= 9; got \(8, 3\)"),
        (np.zeros((12, 3)), "are the same"),
        (np.random.default_rng(0).random((12, 3)) * [1, 1, 0], "lie on many"),
        (np.outer(np.arange(12), [1, 2, 3]), "lie on many"),
        (np.stack([np.cos(np.arange(12)), np.sin(np.arange(12)), np.arange(12) % 2], axis=1), "lie on many"),
    ],
    ids=["eight", "one point", "plane", "line", "two circles"],
)
def test_through_refuses_what_many_quadrics_meet(points, message):
    with pytest.raises(GeometryError, match=message):
        Quadric.through(points)


def test_bad_input_is_named():
    with pytest.raises(NumberError, match="coefficient C of a quadric must be finite"):
        Quadric(1, 1, np.nan, 0, 0, 0, 0, 0, 0, 0)
    with pytest.raises(ShapeError, match="coefficient K of a quadric must be real numbers"):
        Quadric(1, 1, 1, 0, 0, 0, 0, 0, 0, "one")
    with pytest.raises(NumberError, match="tolerance must be at least 0"):
        Quadric(1, 1, 1, 0, 0, 0, 0, 0, 0, 0).classify(-1)
    with pytest.raises(ShapeError, match=r"shape \(4, 4\); got \(3, 3\)"):
        Quadric.from_matrix(np.eye(3))
    with pytest.raises(ShapeError, match=r"points must have shape \(\.\.\., 3\); got \(2,\)"):
        Quadric(1, 1, 1, 0, 0, 0, 0, 0, 0, 0)([1, 2])
    with pytest.raises(DegenerateError, match="flattens space"):
        Transform(np.diag([1, 1, 0, 1])) @ Quadric(1, 1, 1, 0, 0, 0, 0, 0, 0, 0)
