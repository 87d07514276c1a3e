"""The part of a fitted form that measured points cover, as a surface to draw beside them."""

from __future__ import annotations

import numpy as np

from directrix.checks import Array
from directrix.inspection.forms import Form, IdealCone, IdealCylinder, IdealPlane, IdealSphere, IdealTorus, about, across
from directrix.surfaces.known import Cone, Cylinder, Sphere, Torus
from directrix.surfaces.plane import Plane
from directrix.surfaces.surface import Surface
from directrix.transform import Transform


def covering(form: Form, points: Array) -> Surface:
    """A patch of the form over the points: all round, and as high as the points reach."""
    match form:
        case IdealPlane():
            return _plane(form, points)
        case IdealCylinder():
            _, _, height = about(points, form.point, form.axis)
            low, high = height.min(), height.max()
            return frame(form.axis, form.point + low * form.axis) @ Cylinder(form.radius, high - low)
        case IdealCone():
            _, _, height = about(points, form.point, form.axis)
            low, high = height.min(), height.max()
            slope = np.tan(form.half_angle)
            radii = (max(form.radius + slope * low, 0.0), max(form.radius + slope * high, 0.0))
            return frame(form.axis, form.point + low * form.axis) @ Cone(*radii, high - low)
        case IdealSphere():
            return Transform.translate(form.center) @ Sphere(form.radius)
        case IdealTorus():
            return frame(form.axis, form.center) @ Torus(form.R, form.r)
    raise TypeError(f"no surface is known for {form!r}")


def _plane(form: IdealPlane, points: Array) -> Surface:
    v = points - form.point
    e1, e2 = np.linalg.svd(v - np.outer(v @ form.normal, form.normal), full_matrices=False)[2][:2]
    (a, b), (c, d) = ((x.min(), x.max()) for x in (v @ e1, v @ e2))
    corner = form.point + a * e1 + c * e2
    return Plane(corner, corner + (b - a) * e1, corner + (d - c) * e2)


def frame(axis: Array, origin: Array) -> Transform:
    """The rigid motion that takes the z axis to the axis and the origin to ``origin``."""
    return Transform.of(np.column_stack([*across(axis), axis]), origin)
