"""Form errors of measured points: flatness, cylindricity, conicity, sphericity, toricity.

A form error is the width of the zone between two copies of the ideal form that holds all measured points: the largest signed
distance minus the smallest. Which ideal form is meant has to be said (ISO 1101 asks for the minimum zone; coordinate
measuring machines mostly report about the least-squares form, which never gives less).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.checks import Array
from directrix.errors import GeometryError
from directrix.frozen import Frozen
from directrix.inspection.fitting import (
    Fitter,
    algebraic_sphere,
    fit_cone,
    fit_cylinder,
    fit_plane,
    fit_sphere,
    fit_torus,
    minimum_zone,
    narrowest_plane,
)
from directrix.inspection.forms import Form, IdealCone, IdealCylinder, IdealPlane, IdealSphere, IdealTorus, about
from directrix.inspection.shown import covering
from directrix.surfaces.surface import Surface

__all__ = [
    "FormError",
    "IdealCone",
    "IdealCylinder",
    "IdealPlane",
    "IdealSphere",
    "IdealTorus",
    "conicity",
    "cylindricity",
    "flatness",
    "sphericity",
    "toricity",
]

METHODS = ("least squares", "minimum zone")


class FormError(Frozen):
    """The form error of measured points.

    Attributes
    ----------
    value : float
        Width of the zone, max - min of the residuals, in the points' unit of length. ``float(result)`` is this number.
    form : IdealPlane, IdealSphere, IdealCylinder, IdealCone or IdealTorus
        The fitted form, with its position, axis and radii.
    residuals : (n,) array
        Signed orthogonal distances of the points from the form, in the order of the points.
    points : (n, 3) array
        The measured points.
    method : str
        ``least squares``, ``minimum zone``, ``algebraic`` or ``given axis``.
    """

    value: float
    form: Form
    residuals: Array
    points: Array
    method: str

    def __init__(self, form: Form, points: Array, method: str) -> None:
        residuals = form.distance(points)
        self._hold(value=float(np.ptp(residuals)), form=form, residuals=residuals, points=points, method=method)

    def __float__(self) -> float:
        return self.value

    @property
    def rms(self) -> float:
        """Root mean square of the residuals."""
        return float(np.sqrt(np.square(self.residuals).mean()))

    def surface(self) -> Surface:
        """The part of the fitted form that the points cover, as a surface to draw."""
        return covering(self.form, self.points)

    def __repr__(self) -> str:
        return f"FormError({self.value:.6g}, {type(self.form).__name__}, {len(self.points)} points, {self.method})"


def flatness(points: ArrayLike, method: str = "least squares") -> FormError:
    """Flatness of measured points: the width of the zone between two parallel planes that holds them.

    d_i = (x_i - mean) . n with n the singular vector of the least singular value of the centred points; value = max d - min d
    (the lecture's CMM part; ISO 1101:2017, on flatness). The minimum zone turns the planes until the zone is narrowest.

    Parameters
    ----------
    points : (n, 3), n >= 4, in any one unit of length
    method : ``least squares`` or ``minimum zone``

    Returns
    -------
    FormError
        ``.value``, ``.form`` (an IdealPlane), ``.residuals``.

    Raises
    ------
    GeometryError
        If there are fewer than 4 points, they are not finite, or all are the same.

    Examples
    --------
    >>> flatness([(0, 0, 0), (2, 0, 0), (0, 2, 0), (2, 2, 0), (1, 1, 0.5)]).value
    0.5
    """
    return _fitted(points, 4, fit_plane, method)


def sphericity(points: ArrayLike, method: str = "least squares") -> FormError:
    """Sphericity (roundness in space): the width of the zone between two concentric spheres that holds the points.

    d_i = |x_i - c| - r. ``least squares`` minimises Σ d² (A. B. Forbes, NPL report DITC 140/89); ``algebraic`` solves the
    linear system |x|² = 2 c·x + k instead, which agrees to second order in the error; ``minimum zone`` minimises
    max d - min d.

    Parameters
    ----------
    points : (n, 3), n >= 5, not in one plane
    method : ``least squares``, ``minimum zone`` or ``algebraic``

    Returns
    -------
    FormError
        ``.value``, ``.form`` (an IdealSphere), ``.residuals``.

    Raises
    ------
    GeometryError
        If there are too few points, or they lie in one plane.

    Examples
    --------
    >>> sphericity([(2, 0, 0), (-2, 0, 0), (0, 2, 0), (0, -2, 0), (0, 0, 2), (0, 0, -2)]).value
    0.0
    """
    if isinstance(method, str) and method == "algebraic":
        X = checks.points("points", points, least=5)
        return FormError(algebraic_sphere(X), X, method)
    return _fitted(points, 5, fit_sphere, method, extra=("algebraic",))


def cylindricity(
    points: ArrayLike,
    axis_point: ArrayLike | None = None,
    axis_direction: ArrayLike | None = None,
    method: str = "least squares",
) -> FormError:
    """Cylindricity: the width of the zone between two coaxial cylinders that holds the points.

    ρ_i = |v - (v·k) k|, v = x_i - axis_point; value = max ρ - min ρ (ISO 1101:2017, on cylindricity). With a datum axis given
    there is nothing to fit, and the form's radius is the mean of the ρ_i. Otherwise the axis is fitted, starting from the best
    of 240 directions, so that partial arcs are found too.

    Parameters
    ----------
    points : (n, 3); n >= 6 to fit, n >= 2 for a given axis
    axis_point, axis_direction : (3,), both or neither
        A point of the datum axis and its direction, of any length but 0.
    method : ``least squares`` or ``minimum zone``, where the axis is fitted

    Returns
    -------
    FormError
        ``.value``, ``.form`` (an IdealCylinder), ``.residuals``.

    Raises
    ------
    GeometryError
        If there are too few points, they do not bend, or only half of the axis is given.

    Examples
    --------
    >>> cylindricity([(2, 0, 0), (0, 2, 1), (-2, 0, 2), (0, -2.25, 3)], (0, 0, 7), (0, 0, 3)).value
    0.25
    """
    if (axis_point is None) != (axis_direction is None):
        raise GeometryError("a datum axis needs axis_point and axis_direction, both of shape (3,); got only one of them.")
    if axis_point is None:
        return _fitted(points, 6, fit_cylinder, method)
    X, point = checks.points("points", points), checks.point("axis_point", axis_point)
    axis = checks.direction("axis_direction", axis_direction)
    _, rho, _ = about(X, point, axis)
    return FormError(IdealCylinder(point, axis, rho.mean()), X, "given axis")


def conicity(points: ArrayLike, method: str = "least squares") -> FormError:
    """Conicity: the width, across the surface, of the zone between two parallel coaxial cones that holds the points.

    d_i = (ρ_i - r0) cos φ - h_i sin φ, with ρ, h the cylindrical coordinates about the axis and φ the half angle (NPL report
    DITC 140/89, section 11). The half angle is fitted too.

    Parameters
    ----------
    points : (n, 3), n >= 7, on one nappe
    method : ``least squares`` or ``minimum zone``

    Returns
    -------
    FormError
        ``.value``, ``.form`` (an IdealCone with ``apex`` and ``half_angle``), ``.residuals``.

    Raises
    ------
    GeometryError
        If there are too few points, or they do not bend.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.linspace(0, 6, 40)
    >>> cone = np.stack([(3 + t % 2) * np.cos(t), (3 + t % 2) * np.sin(t), t % 2], axis=1)
    >>> conicity(cone).value < 1e-12
    True
    """
    return _fitted(points, 7, fit_cone, method)


def toricity(points: ArrayLike, method: str = "least squares") -> FormError:
    """Toricity: the width of the zone between two tori of the same centre circle that holds the points.

    d_i = hypot(ρ_i - R, h_i) - r, with ρ, h the cylindrical coordinates about the axis. Both radii are fitted (the lecture's
    CMM part; orthogonal distances as for the other forms, A. B. Forbes, NPL report DITC 140/89).

    Parameters
    ----------
    points : (n, 3), n >= 8
    method : ``least squares`` or ``minimum zone``

    Returns
    -------
    FormError
        ``.value``, ``.form`` (an IdealTorus with ``R`` and ``r``), ``.residuals``.

    Raises
    ------
    GeometryError
        If there are too few points, or they do not bend.

    Examples
    --------
    >>> from directrix.surfaces.known import Torus
    >>> import numpy as np
    >>> u, w = np.meshgrid(np.linspace(0, 1, 9), np.linspace(0, 1, 9))
    >>> result = toricity(Torus(3, 1)(u, w).reshape(-1, 3))
    >>> result.value < 1e-12, round(result.form.R, 9), round(result.form.r, 9)
    (True, 3.0, 1.0)
    """
    return _fitted(points, 8, fit_torus, method)


def _fitted(points: ArrayLike, least: int, fit: Fitter, method: str, extra: tuple[str, ...] = ()) -> FormError:
    checks.choice("method", method, METHODS + extra)
    X = checks.points("points", points, least=least)
    mean = X.mean(axis=0)
    v = X - mean
    if not v.any():
        raise GeometryError("the measured points are all the same: no form fits them best.")
    form = fit(v)
    if method == "minimum zone":
        form = narrowest_plane(form, v) if isinstance(form, IdealPlane) else minimum_zone(form, v)
    return FormError(form.shifted(mean), X, method)
