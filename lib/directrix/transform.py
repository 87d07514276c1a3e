"""Affine maps as 4 x 4 matrices: move, turn about any line, mirror, scale."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.checks import Array
from directrix.errors import DegenerateError, GeometryError, NumberError, ShapeError
from directrix.frozen import Frozen

AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
ORIGIN = (0.0, 0.0, 0.0)


def turn(t: Array, derivative: int = 0) -> tuple[Array, Array]:
    """Cosine and sine of 2 pi t: exact at every quarter of a turn, and with period 1 to the last bit.

    The d-th derivative with respect to t is (2 pi)^d times the same pair a quarter of d turns further on.

    Examples
    --------
    >>> turn(np.array([0.0, 0.25, 0.5, 1.0]))[0].tolist()
    [1.0, 0.0, -1.0, 1.0]
    """
    quarter = np.rint(4 * np.asarray(t, dtype=np.float64))
    rest = 2 * pi * (t - quarter / 4)  # within an eighth of a turn, where cos and sin lose nothing
    cos, sin = np.cos(rest), np.sin(rest)
    turned = quarter + derivative
    which = turned - 4 * np.floor(turned / 4)  # the remainder: np.mod takes five times as long
    odd, past = (which == 1) | (which == 3), which >= 2
    c, s = np.where(odd, -sin, cos), np.where(odd, cos, sin)
    scale = (2 * pi) ** derivative
    return np.where(past, -c, c) * scale + 0.0, np.where(past, -s, s) * scale + 0.0


class Transform(Frozen):
    """An affine map p -> A p + t, held as the 4 x 4 matrix [[A, t], [0, 1]] that multiplies column vectors.

    ``second @ first`` does first what stands on the right. ``transform @ form`` moves a curve, surface or solid;
    ``transform @ points`` moves an array of points of shape (..., 3). Rogers & Adams multiply row vectors from the left:
    their matrices are the transposes of these (Mathematical Elements for Computer Graphics, 2nd ed.).

    Parameters
    ----------
    matrix : (4, 4), last row (0, 0, 0, 1)

    Raises
    ------
    ShapeError
        If the matrix is not 4 x 4.
    NumberError
        If its last row is not (0, 0, 0, 1), or a number in it is not finite.

    Examples
    --------
    >>> quarter = Transform.rotate("z", np.pi / 2, point=(1, 0, 0))
    >>> quarter @ (2, 0, 0)
    array([1., 1., 0.])
    >>> quarter.inverse() @ quarter == Transform.identity()
    True
    """

    matrix: Array

    def __init__(self, matrix: ArrayLike) -> None:
        given = checks.array("matrix", matrix)
        if given.shape != (4, 4):
            raise ShapeError(
                f"matrix must have shape (4, 4); got {given.shape}. From a 3 x 3 matrix: Transform.of(A, offset).",
                got=given.shape,
            )
        if not np.array_equal(given[3], (0, 0, 0, 1)):
            raise NumberError(
                f"the last row of matrix must be (0, 0, 0, 1); got {given[3].tolist()}. "
                "A matrix written for row vectors is the transpose of what is wanted here."
            )
        self._hold(matrix=given)

    @classmethod
    def of(cls, linear: ArrayLike, offset: ArrayLike = ORIGIN) -> Transform:
        """The map p -> linear p + offset, from a (3, 3) matrix and a (3,) vector."""
        a, t = checks.array("linear", linear), checks.point("offset", offset)
        if a.shape != (3, 3):
            raise ShapeError(f"linear must have shape (3, 3); got {a.shape}.", got=a.shape)
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = a, t
        return cls(matrix)

    @classmethod
    def identity(cls) -> Transform:
        """The map that leaves every point where it is."""
        return cls(np.eye(4))

    @classmethod
    def translate(cls, vector: ArrayLike) -> Transform:
        """The shift by a vector of shape (3,).

        >>> Transform.translate((1, 2, 3)) @ (0, 0, 1)
        array([1., 2., 4.])
        """
        return cls.of(np.eye(3), checks.point("vector", vector))

    @classmethod
    def rotate(cls, direction: ArrayLike | str, angle: float, point: ArrayLike = ORIGIN) -> Transform:
        """The turn about the line through ``point`` along ``direction``, by the right-hand rule.

        p -> point + v cos t + (k x v) sin t + (k . v) k (1 - cos t), v = p - point, k the unit direction
        (Rodrigues; Rogers & Adams, on rotation about an arbitrary axis).

        Parameters
        ----------
        direction : 'x', 'y', 'z' or (3,) of any length but 0
        angle : radians, positive anticlockwise when the direction points at you; exact at multiples of pi / 2
        point : (3,), any point of the axis
        """
        k = _direction("direction", direction)
        cos, sin = (float(part) for part in turn(np.array(checks.number("angle", angle) / (2 * pi))))
        cross = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
        linear = cos * np.eye(3) + sin * cross + (1 - cos) * np.outer(k, k)
        return cls._about(linear, point)

    @classmethod
    def reflect(cls, normal: ArrayLike | str, point: ArrayLike = ORIGIN) -> Transform:
        """The mirror image in the plane through ``point`` with the given normal ('x', 'y', 'z' or (3,)).

        >>> Transform.reflect("x", point=(1, 0, 0)) @ (3, 5, 7)
        array([-1.,  5.,  7.])
        """
        n = _direction("normal", normal)
        return cls._about(np.eye(3) - 2 * np.outer(n, n), point)

    @classmethod
    def scale(cls, factor: ArrayLike, point: ArrayLike = ORIGIN) -> Transform:
        """Scaling about ``point`` by one factor, or by three along x, y and z; none may be 0.

        >>> Transform.scale((2, 1, 0.5), point=(1, 1, 1)) @ (2, 2, 2)
        array([3. , 2. , 1.5])
        """
        given = checks.array("factor", factor)
        if given.shape not in {(), (3,)}:
            raise ShapeError(f"factor must be one number or three; got shape {given.shape}.", got=given.shape)
        if not given.all():
            raise NumberError("factor must not be 0: everything would collapse. To flatten on purpose write the matrix.")
        return cls._about(np.diag(np.broadcast_to(given, 3)), point)

    @classmethod
    def _about(cls, linear: Array, point: ArrayLike) -> Transform:
        fixed = checks.point("point", point)
        return cls.of(linear, fixed - linear @ fixed)

    @property
    def linear(self) -> Array:
        """The (3, 3) part A, which acts on vectors."""
        return self.matrix[:3, :3]

    @property
    def offset(self) -> Array:
        """The (3,) part t, where the origin goes."""
        return self.matrix[:3, 3]

    def points(self, points: ArrayLike) -> Array:
        """Points of shape (..., 3), moved."""
        return self.vectors(points) + self.offset

    def vectors(self, vectors: ArrayLike) -> Array:
        """Vectors of shape (..., 3): turned and scaled, not shifted."""
        given = checks.array("points", vectors)
        if given.ndim == 0 or given.shape[-1] != 3:
            raise ShapeError(f"points must have shape (..., 3); got {given.shape}.", got=given.shape)
        return np.asarray(given @ self.linear.T)

    def inverse(self) -> Transform:
        """The map back; an error if this one flattens space."""
        size = np.abs(self.linear).max()
        if size == 0 or abs(np.linalg.det(self.linear / size)) < 1e-14:
            raise DegenerateError("this transform flattens space onto a plane, line or point: nothing leads back.")
        back = np.linalg.inv(self.linear) + 0.0
        return Transform.of(back, -back @ self.offset + 0.0)

    def __matmul__(self, other: Any) -> Any:
        if isinstance(other, Transform):
            return Transform(self.matrix @ other.matrix)
        if hasattr(other, "moved"):
            return other.moved(self)
        if callable(other):
            raise GeometryError(
                f"transform @ {type(other).__name__} needs a form of the library; wrap a plain function first: "
                "transform @ FunctionCurve(f), or apply transform.points to what it returns."
            )
        return self.points(other)


def _direction(name: str, value: ArrayLike | str) -> Array:
    """A unit direction from 'x', 'y', 'z' or a vector."""
    if isinstance(value, str):
        value = AXES[checks.choice(name, value, tuple(AXES), hint="Or give a vector of shape (3,).")]
    return checks.direction(name, value)
