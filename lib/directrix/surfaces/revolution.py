"""The circular sweep: a curve turned about an axis."""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.checks import Array
from directrix.curves.curve import Curve
from directrix.curves.function import as_curve
from directrix.surfaces.surface import Orders, Surface
from directrix.transform import Transform, turn

AXES = {"x": (1, 2, 0), "y": (2, 0, 1), "z": (0, 1, 2)}  # which coordinates play x, y and z of a turn about z


class CircularSweep(Surface):
    """A curve turned about an axis by the right-hand rule: S(u, w) = R(angle w) C(u).

    u runs along the generatrix C, w round the circle. About z: (x c - y s, x s + y c, z), with c, s the cosine and sine of
    angle w; about x and y the coordinates change places in a ring, so about y: (x c + z s, y, -x s + z c). In CAD: revolve.
    The lecture's board form (x c, y, x s) about y is the other sense: a negative angle. Where the curve meets the axis the
    edge w collapses to a point. Multiples of a quarter turn are exact, and a whole turn closes bit for bit. Derivatives to
    any order in w, in u as far as the curve's own. (Piegl & Tiller, The NURBS Book, 2nd ed., section 8.5, the
    surface of revolution, there rational and not at constant speed. Rogers & Adams, Mathematical Elements for Computer
    Graphics, 2nd ed., write row vectors, so their matrices are transposed.)

    Parameters
    ----------
    curve : a curve of the library, or any vectorised callable u -> (..., 3); it need not be plane
    axis : 'x', 'y' or 'z'; for other axes use ``CircularSweep.in_xy_plane`` and ``CircularSweep.about``
    angle : radians, 2 pi by default; positive seen anticlockwise when the axis points at you

    Raises
    ------
    NumberError
        If the axis is none of the three, or the angle is not finite.
    CurveError
        If the curve is no vectorised callable.

    Examples
    --------
    >>> from directrix.curves.line import Line
    >>> CircularSweep(Line((1, 0, 0), (2, 0, 4)), "z")(0.5, 0.25)
    array([0. , 1.5, 2. ])
    """

    curve: Curve
    placement: Transform
    angle: float

    def __init__(self, curve: Callable[[Array], Any], axis: str = "z", angle: float = 2 * pi) -> None:
        hint = "For another axis use CircularSweep.about(curve, point, direction, angle)."
        ring = AXES[checks.choice("axis", axis, tuple(AXES), hint=hint)]
        self._hold(
            curve=as_curve("curve", curve),
            placement=Transform.of(np.eye(3)[:, ring]),
            angle=checks.number("angle", angle),
        )

    @classmethod
    def about(
        cls, curve: Callable[[Array], Any], point: ArrayLike, direction: ArrayLike, angle: float = 2 * pi
    ) -> CircularSweep:
        """The sweep about the line through ``point`` along ``direction``: transform, sweep about z, reverse transform.

        S = T A R_z(angle w) A^-1 T^-1 C(u): the axis is carried to the z axis, the curve turned about it, and all carried
        back. It equals point + v cos t + (k x v) sin t + (k . v) k (1 - cos t), v = C - point, k the unit direction
        (Rodrigues). Another point of the same axis changes nothing; -direction turns the other way.

        Parameters
        ----------
        curve : a curve of the library, or any vectorised callable u -> (..., 3)
        point : (3,), any point of the axis
        direction : (3,) of any length but 0
        angle : radians

        Raises
        ------
        DegenerateError
            If the direction is the zero vector.

        Examples
        --------
        >>> from directrix.curves.line import Line
        >>> CircularSweep.about(Line((2, 0, 0), (2, 0, 1)), (1, 0, 0), (0, 0, 3), np.pi)(0.0, 1.0)
        array([0., 0., 0.])
        """
        k = checks.direction("direction", direction)
        e1 = np.eye(3)[np.argmin(np.abs(k))]
        e1 = e1 - (e1 @ k) * k
        e1 = e1 / checks.length(e1)
        frame = np.stack([e1, np.cross(k, e1), k], axis=1)
        return cls._placed(curve, Transform.of(frame, checks.point("point", point)), angle)

    @classmethod
    def in_xy_plane(cls, curve: Callable[[Array], Any], alpha: float, angle: float = 2 * pi) -> CircularSweep:
        """The sweep about the axis (cos alpha, sin alpha, 0) through the origin: R_z(alpha) R_x(angle w) R_z(-alpha) C(u).

        alpha is in radians, from +x towards +y: 0 is the x axis, pi / 2 the y axis.

        >>> from directrix.curves.line import Line
        >>> CircularSweep.in_xy_plane(Line((1, 0, 0), (2, 0, 0)), np.pi / 2)(0.0, 0.25)
        array([ 0.,  0., -1.])
        """
        to_axis = Transform.rotate("z", checks.number("alpha", alpha))
        return cls._placed(curve, Transform.of(to_axis.linear[:, AXES["x"]]), angle)

    @classmethod
    def _placed(cls, curve: Callable[[Array], Any], placement: Transform, angle: float) -> CircularSweep:
        sweep = cls.__new__(cls)
        sweep._hold(curve=as_curve("curve", curve), placement=placement, angle=checks.number("angle", angle))
        return sweep

    @property
    def point(self) -> Array:
        """A point of the axis, (3,)."""
        return self.placement.offset

    @property
    def direction(self) -> Array:
        """Unit direction of the axis, (3,)."""
        return self.placement.linear[:, 2]

    def _derivative(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        return self._jet(u, w, ((nu, nw),))[0]

    def _jet(self, u: Array, w: Array, orders: Orders) -> list[Array]:
        profiles = {nu: self._profile(u, nu) for nu in {nu for nu, _ in orders}}
        turns = {nw: self._turned(w, nw) for nw in {nw for _, nw in orders}}
        return [self._product(profiles[nu], turns[nw], fixed=nw == 0) for nu, nw in orders]

    def _profile(self, u: Array, nu: int) -> tuple[Array, Array, Array]:
        """The generatrix in three parts: what stays, what goes with the cosine, what goes with the sine."""
        linear, offset = self.placement.linear, self.placement.offset
        given = self.curve._derivative(u, nu)
        x, y, z = np.moveaxis((given - offset if nu == 0 else given) @ linear, -1, 0)  # orthonormal: the transpose leads back
        ex, ey, ez = linear.T
        stays = z[..., None] * ez + (offset if nu == 0 else 0.0)
        return stays, x[..., None] * ex + y[..., None] * ey, x[..., None] * ey - y[..., None] * ex

    def _turned(self, w: Array, nw: int) -> tuple[Array, Array]:
        turns = self.angle / (2 * pi)
        cos, sin = turn(turns * w, nw)
        return cos[..., None] * turns**nw, sin[..., None] * turns**nw

    @staticmethod
    def _product(profile: tuple[Array, Array, Array], turned: tuple[Array, Array], *, fixed: bool) -> Array:
        stays, with_cos, with_sin = profile
        cos, sin = turned
        moves = cos * with_cos + sin * with_sin
        return moves + stays if fixed else moves

    def breaks(self) -> tuple[Array, Array]:
        """Those of the curve in u; in w the quarters of the turn."""
        quarters = max(1, min(64, round(abs(self.angle) / (pi / 2))))
        return self.curve.breaks(), np.linspace(0.0, 1.0, quarters + 1)
