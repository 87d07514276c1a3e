"""What all curves share: checking and clamping of u, shapes, moving, cutting, length."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.checks import Array
from directrix.differential import norm
from directrix.errors import DegenerateError
from directrix.frozen import Frozen
from directrix.quadrature import integrate
from directrix.transform import Transform

NUMERIC = "Its derivatives are taken numerically, and no further than the second."


class Curve(Frozen):
    """A curve p(u) in space, u in [0, 1]. Forms derive from it and give ``_derivative``; everything else is here.

    A curve is called with a number or an array of any shape, and gives points of shape ``u.shape + (3,)``: a scalar gives
    (3,), an empty array (0, 3). u within 1e-12 of [0, 1] is clamped; further out is a ``DomainError``. Lengths are in the unit
    of the points given. (do Carmo, Differential Geometry of Curves and Surfaces, sections 1-2 and 1-3.)

    Raises
    ------
    DomainError
        From every method that takes u, if it is outside [0, 1] by more than 1e-12, or NaN.
    ShapeError
        If u holds no real numbers.

    Examples
    --------
    >>> from directrix.curves.line import Line
    >>> line = Line((0, 0, 0), (4, 0, 2))
    >>> line(0.5), line([[0.0], [1.0]]).shape
    (array([2., 0., 1.]), (2, 1, 3))
    """

    def _derivative(self, u: Array, n: int) -> Array:
        """The n-th derivative (n = 0: the points) at checked parameters; its shape may broadcast to u.shape + (3,)."""
        raise NotImplementedError

    def __call__(self, u: ArrayLike) -> Array:
        """Points of shape u.shape + (3,) at the parameters u in [0, 1]."""
        return self.derivative(u, 0)

    def derivative(self, u: ArrayLike, n: int = 1) -> Array:
        """The n-th derivative with respect to u, shape u.shape + (3,).

        Raises
        ------
        DomainError
            If some u is outside [0, 1] or NaN.
        OrderError
            If n is no whole number of at least 0, or is above 2 where derivatives are numeric.
        """
        n = checks.derivative_order("n", n)
        u = checks.parameter("u", u)
        if u.size == 0:
            return np.empty((*u.shape, 3))
        value = self._derivative(u, n)
        shape = (*u.shape, 3)
        return value if value.shape == shape and value.flags.writeable else np.array(np.broadcast_to(value, shape))

    def tangent(self, u: ArrayLike) -> Array:
        """Unit tangents, shape u.shape + (3,); (0, 0, 0) where the first derivative vanishes."""
        velocity = self.derivative(u)
        speed = norm(velocity)
        return velocity * np.divide(1.0, speed, out=np.zeros_like(speed), where=speed > 0)[..., None]

    def moved(self, transform: Transform) -> Curve:
        """This curve under an affine map; also written ``transform @ curve``."""
        return MovedCurve(self, transform)

    def segment(self, u0: float, u1: float) -> Curve:
        """The part from u0 to u1, run through by a parameter of its own in [0, 1]; u0 > u1 runs it backwards."""
        return Segment(self, u0, u1)

    def flip(self) -> Curve:
        """The same curve run backwards: u becomes 1 - u."""
        return self.segment(1.0, 0.0)

    def split(self, u: float) -> tuple[Curve, Curve]:
        """The parts before and after u, 0 < u < 1."""
        at = checks.inside("u", u)
        return self.segment(0.0, at), self.segment(at, 1.0)

    def breaks(self) -> Array:
        """Parameters between which the curve is smooth, 0 and 1 among them."""
        return np.array([0.0, 1.0])

    def is_closed(self) -> bool:
        """Whether both ends are the same point, to 1e-9 of the curve's size."""
        start, *_, end = samples = self(np.linspace(0.0, 1.0, 17))
        return bool(checks.length(end - start) <= 1e-9 * np.ptp(samples, axis=0).max())

    def length(self) -> float:
        """Arc length: the integral of |p'(u)|, by adaptive Gauss quadrature to about 1e-10 of itself.

        >>> from directrix.curves.line import Line
        >>> round(Line((0, 0, 0), (3, 4, 0)).length(), 12)
        5.0
        """
        return integrate(lambda u: norm(self.derivative(u)), self.breaks())


class MovedCurve(Curve):
    """A curve under an affine map."""

    def __init__(self, curve: Curve, transform: Transform) -> None:
        self._hold(curve=curve, transform=transform)

    curve: Curve
    transform: Transform

    def _derivative(self, u: Array, n: int) -> Array:
        value = self.curve._derivative(u, n)
        return self.transform.points(value) if n == 0 else self.transform.vectors(value)

    def moved(self, transform: Transform) -> Curve:
        """This curve under one more map: the two are multiplied."""
        return MovedCurve(self.curve, transform @ self.transform)

    def breaks(self) -> Array:
        """As those of the curve that was moved."""
        return self.curve.breaks()


class Segment(Curve):
    """Part of a curve, or the curve run backwards: q(u) = p(u0 + (u1 - u0) u)."""

    curve: Curve
    u0: float
    u1: float

    def __init__(self, curve: Curve, u0: float, u1: float) -> None:
        u0, u1 = (float(checks.parameter(name, checks.number(name, value))) for name, value in (("u0", u0), ("u1", u1)))
        if u0 == u1:
            raise DegenerateError(f"u0 and u1 must differ; both are {u0:g}, which leaves one point.")
        if isinstance(curve, Segment):
            u0, u1 = (curve.u0 * (1 - u) + curve.u1 * u for u in (u0, u1))
            curve = curve.curve
        self._hold(curve=curve, u0=u0, u1=u1)

    def _derivative(self, u: Array, n: int) -> Array:
        return self.curve._derivative((1 - u) * self.u0 + u * self.u1, n) * (self.u1 - self.u0) ** n

    def breaks(self) -> Array:
        """Those of the whole curve that lie on the part."""
        inner = (self.curve.breaks() - self.u0) / (self.u1 - self.u0)
        return np.unique([0.0, 1.0, *inner[(inner > 0) & (inner < 1)]])
