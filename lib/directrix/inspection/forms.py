"""The five ideal forms that measured points are compared with, each with its signed distance and the slope of that distance.

A form is moved by small steps in its own frame: sideways shifts and tilts of its axis, its angles and radii. `residuals`
returns the signed orthogonal distances d of points and the matrix J = ∂d/∂step, in closed form; both fits (least squares,
minimum zone) use nothing else. The last step always moves the whole surface along its normal: its column of J is -1. An
angle of a cone and a tilt of an axis are counted in radians, everything else in the points' unit of length.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

import numpy as np

from directrix.checks import Array
from directrix.frozen import Frozen


class Form(Frozen):
    """What the five forms share."""

    steps: ClassVar[int]  # parameters of the form, the last one along its normal

    def distance(self, points: Array) -> Array:
        """Signed orthogonal distance of points (n, 3) from the form, shape (n,): positive on the outer side."""
        return self.residuals(np.asarray(points, dtype=np.float64))[0]

    def residuals(self, points: Array) -> tuple[Array, Array]:
        """Signed distances (n,) and their derivatives (n, steps) by the form's own steps."""
        raise NotImplementedError

    def stepped(self, step: Array) -> Form:
        """The form after a small step in its own frame."""
        raise NotImplementedError

    def shifted(self, vector: Array) -> Form:
        """The form carried by a vector."""
        raise NotImplementedError


class IdealPlane(Form):
    """The plane through ``point`` with unit ``normal``."""

    steps = 3
    point: Array
    normal: Array

    def __init__(self, point: Array, normal: Array) -> None:
        self._hold(point=point, normal=normal)

    def residuals(self, points: Array) -> tuple[Array, Array]:
        """d = (x - point) . normal."""
        v, (e1, e2) = points - self.point, across(self.normal)
        return v @ self.normal, np.column_stack([v @ e1, v @ e2, -np.ones(len(v))])

    def stepped(self, step: Array) -> IdealPlane:
        """Tilted twice, then moved along the normal."""
        normal = tilted(self.normal, step[:2])
        return IdealPlane(self.point + step[2] * normal, normal)

    def shifted(self, vector: Array) -> IdealPlane:
        """The plane carried by a vector."""
        return IdealPlane(self.point + vector, self.normal)


class IdealSphere(Form):
    """The sphere about ``center`` with ``radius``."""

    steps = 4
    center: Array
    radius: float

    def __init__(self, center: Array, radius: float) -> None:
        self._hold(center=center, radius=float(radius))

    def residuals(self, points: Array) -> tuple[Array, Array]:
        """d = |x - center| - radius."""
        v = points - self.center
        out, away = unit_rows(v)
        return away - self.radius, np.column_stack([-out, -np.ones(len(v))])

    def stepped(self, step: Array) -> IdealSphere:
        """The centre moved, the radius grown."""
        return IdealSphere(self.center + step[:3], self.radius + step[3])

    def shifted(self, vector: Array) -> IdealSphere:
        """The sphere carried by a vector."""
        return IdealSphere(self.center + vector, self.radius)


class IdealCylinder(Form):
    """The cylinder of ``radius`` about the line through ``point`` along the unit ``axis``."""

    steps = 5
    point: Array
    axis: Array
    radius: float

    def __init__(self, point: Array, axis: Array, radius: float) -> None:
        self._hold(point=point, axis=axis, radius=float(radius))

    def residuals(self, points: Array) -> tuple[Array, Array]:
        """d = ρ - radius, with ρ the distance from the axis."""
        out, rho, height = about(points, self.point, self.axis)
        slopes = -out @ across(self.axis).T
        return rho - self.radius, np.column_stack([slopes, height[:, None] * slopes, -np.ones(len(rho))])

    def stepped(self, step: Array) -> IdealCylinder:
        """The axis shifted sideways and tilted, the radius grown."""
        point = self.point + step[:2] @ across(self.axis)
        return IdealCylinder(point, tilted(self.axis, step[2:4]), self.radius + step[4])

    def shifted(self, vector: Array) -> IdealCylinder:
        """The cylinder carried by a vector."""
        return IdealCylinder(self.point + vector, self.axis, self.radius)


class IdealCone(Form):
    """The cone about the line through ``point`` along the unit ``axis``, of ``radius`` at the point, widening along the axis.

    ``half_angle`` is the angle between axis and ruling, in radians, 0 for a cylinder, negative if it narrows along the axis.
    Distances are those from one nappe, prolonged beyond the apex as a plane through the axis would see its rulings.
    """

    steps = 6
    point: Array
    axis: Array
    radius: float
    half_angle: float

    def __init__(self, point: Array, axis: Array, radius: float, half_angle: float) -> None:
        self._hold(point=point, axis=axis, radius=float(radius), half_angle=float(half_angle))

    @property
    def apex(self) -> Array:
        """Where the rulings meet, shape (3,); infinite for a cylinder."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(self.point - self.radius / np.tan(self.half_angle) * self.axis)

    def residuals(self, points: Array) -> tuple[Array, Array]:
        """d = (ρ - radius) cos φ - h sin φ, with ρ the distance from the axis, h the height along it, φ the half angle."""
        out, rho, height = about(points, self.point, self.axis)
        cos, sin = np.cos(self.half_angle), np.sin(self.half_angle)
        side = out @ across(self.axis).T
        shift = -cos * side
        tilt = -(cos * height + sin * rho)[:, None] * side
        turn = -(rho - self.radius) * sin - height * cos
        return (rho - self.radius) * cos - height * sin, np.column_stack([shift, tilt, turn, -np.ones(len(rho))])

    def stepped(self, step: Array) -> IdealCone:
        """The axis shifted and tilted, the angle opened, the surface moved along its normal."""
        point = self.point + step[:2] @ across(self.axis)
        angle = self.half_angle + step[4]
        radius = self.radius + step[5] / np.cos(angle)
        return IdealCone(point, tilted(self.axis, step[2:4]), radius, angle)

    def shifted(self, vector: Array) -> IdealCone:
        """The cone carried by a vector."""
        return IdealCone(self.point + vector, self.axis, self.radius, self.half_angle)


class IdealTorus(Form):
    """The torus about ``center`` with unit ``axis``: a tube of radius ``r`` whose centre runs on the circle of radius ``R``."""

    steps = 7
    center: Array
    axis: Array
    R: float
    r: float

    def __init__(self, center: Array, axis: Array, R: float, r: float) -> None:
        self._hold(center=center, axis=axis, R=float(R), r=float(r))

    def residuals(self, points: Array) -> tuple[Array, Array]:
        """d = hypot(ρ - R, h) - r, with ρ the distance from the axis and h the height over the plane of the circle."""
        out, rho, height = about(points, self.center, self.axis)
        tube = np.hypot(rho - self.R, height)
        safe = np.where(tube > 0, tube, 1.0)
        a, b = (rho - self.R) / safe, height / safe
        side = out @ across(self.axis).T
        shift = -a[:, None] * side
        tilt = (b * rho - a * height)[:, None] * side
        return tube - self.r, np.column_stack([shift, -b, tilt, -a, -np.ones(len(rho))])

    def stepped(self, step: Array) -> IdealTorus:
        """The centre moved, the axis tilted, R and r grown."""
        center = self.center + step[:2] @ across(self.axis) + step[2] * self.axis
        return IdealTorus(center, tilted(self.axis, step[3:5]), self.R + step[5], self.r + step[6])

    def shifted(self, vector: Array) -> IdealTorus:
        """The torus carried by a vector."""
        return IdealTorus(self.center + vector, self.axis, self.R, self.r)


Fit = Callable[[Array], Form]


def across(axis: Array) -> Array:
    """Two unit vectors at right angles to a unit vector and to each other, as rows (2, 3), right-handed with it."""
    least = np.eye(3)[np.argmin(np.abs(axis))]
    first = np.cross(axis, least)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(axis, first)])


def tilted(axis: Array, step: Array) -> Array:
    """A unit vector leaned over by two small angles."""
    leaned = axis + step @ across(axis)
    return np.asarray(leaned / np.linalg.norm(leaned))


def unit_rows(vectors: Array) -> tuple[Array, Array]:
    """Rows made unit, and their lengths; a zero row stays zero."""
    length = np.linalg.norm(vectors, axis=1)
    return vectors / np.where(length > 0, length, 1.0)[:, None], length


def about(points: Array, point: Array, axis: Array) -> tuple[Array, Array, Array]:
    """Cylindrical coordinates about a line: unit radial directions (n, 3), distances (n,), heights (n,) over the point."""
    v = points - point
    height = v @ axis
    out, rho = unit_rows(v - height[:, None] * axis)
    return out, rho, height
