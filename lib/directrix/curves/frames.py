"""Frames that travel along a curve: how a section turns on its way.

Each frame is asked for the rotation R(w), with R(0) the identity, that carries the section from the start of the directrix to
the parameter w, and for its angular velocity omega with respect to w, R' = omega x R, with the derivative of that.
"""

from __future__ import annotations

import numpy as np

from directrix.checks import Array
from directrix.curves.curve import Curve
from directrix.differential import cross, dot, norm, numeric_derivative
from directrix.errors import DegenerateError, OrderError

STEPS = 1024  # of the double reflection along the whole directrix
STILL = 1e-10  # a speed, or a curvature, this small beside the size of the curve is none


class FixedFrame:
    """The section is carried without turning: R = I."""

    def __init__(self, directrix: Curve) -> None:
        self.directrix = directrix

    def rotation(self, w: Array) -> Array:
        """R(w), shape w.shape + (3, 3)."""
        return np.broadcast_to(np.eye(3), (*w.shape, 3, 3))

    def spin(self, w: Array) -> Array:
        """omega(w) = 0, shape w.shape + (3,)."""
        return np.zeros((*w.shape, 3))

    spin_rate = spin


class FrenetFrame:
    """Tangent, principal normal and binormal: R(w) = F(w) F(0)^T with F = [t n b].

    t = D'/|D'|, b = D' x D'' / |D' x D''|, n = b x t; omega = |D'| (tau t + kappa b) (do Carmo, Differential Geometry of Curves
    and Surfaces, section 1-5). It needs curvature everywhere: on a straight piece there is no n, at an inflection n jumps.
    """

    def __init__(self, directrix: Curve) -> None:
        self.directrix = directrix
        w = np.linspace(0.0, 1.0, 257)
        self._start = self._frame(np.array(0.0))
        normals = self._frame(w)[..., 1]
        turned = dot(normals[:-1], normals[1:]) < 0
        if turned.any():
            raise DegenerateError(
                f"the directrix has an inflection near w = {w[int(np.argmax(turned))]:.3g}, where the Frenet frame jumps by "
                "half a turn. Use frame='minimal'.",
            )

    def _frame(self, w: Array) -> Array:
        first, second = (self.directrix._derivative(w, n) for n in (1, 2))
        first, second = np.broadcast_to(first, (*w.shape, 3)), np.broadcast_to(second, (*w.shape, 3))
        speed, binormal = norm(first), cross(first, second)
        bent = norm(binormal)
        flat = ~(bent > STILL * speed * np.maximum(speed, norm(second)))
        if flat.any():
            raise DegenerateError(
                f"the directrix is not curved at w = {w[flat].flat[0]:.3g}: there is no Frenet frame there. "
                "Use frame='minimal'.",
            )
        t, b = first / speed[..., None], binormal / bent[..., None]
        return np.stack([t, cross(b, t), b], axis=-1)

    def rotation(self, w: Array) -> Array:
        """R(w), shape w.shape + (3, 3)."""
        return np.asarray(self._frame(w) @ self._start.T)

    def spin(self, w: Array) -> Array:
        """omega(w) = |D'| (tau t + kappa b), shape w.shape + (3,)."""
        first, second, third = (derivative(self.directrix, w, n) for n in (1, 2, 3))
        binormal = cross(first, second)
        bent, speed = dot(binormal, binormal)[..., None], norm(first)[..., None]
        twisting = dot(binormal, third)[..., None] / bent
        return np.asarray(twisting * first + binormal / speed**2)

    def spin_rate(self, w: Array) -> Array:
        """omega'(w): with c = D' x D'' the two terms of omega = (c . D''') / |c|^2 D' + c / |D'|^2, differentiated."""
        first, second, third, fourth = (derivative(self.directrix, w, n) for n in (1, 2, 3, 4))
        c, c_rate = cross(first, second), cross(first, third)
        bent, speed = dot(c, c)[..., None], dot(first, first)[..., None]
        twisting = dot(c, third)[..., None] / bent
        twisting_rate = dot(c, fourth)[..., None] / bent - 2 * twisting * dot(c, c_rate)[..., None] / bent
        turning_rate = c_rate / speed - 2 * c * dot(first, second)[..., None] / speed**2
        return np.asarray(twisting_rate * first + twisting * second + turning_rate)


class MinimalFrame:
    """The rotation-minimising frame: the section never turns about the tangent, omega = t x t'.

    Found by double reflection over 1024 steps (Wang, Juettler, Zheng, Liu, Computation of rotation minimizing frames, ACM
    Transactions on Graphics 27(1), 2008, table I): fourth order, about 5e-10 radians on a turn of a helix. On a closed smooth
    directrix the frame comes home turned by some angle about the tangent; that angle is given back evenly in w, so that the
    sweep closes.
    """

    def __init__(self, directrix: Curve) -> None:
        self.directrix = directrix
        nodes = np.union1d(np.linspace(0.0, 1.0, STEPS + 1), directrix.breaks())
        self._nodes = nodes
        self._points, self._tangents = directrix._derivative(nodes, 0), unit_tangent(directrix, nodes)
        steps = _double_reflection(self._points[:-1], self._tangents[:-1], self._points[1:], self._tangents[1:])
        rotations = [np.eye(3)]
        for step in steps:
            rotations.append(step @ rotations[-1])
        self._rotations = np.stack(rotations)
        self.closing = self._closing_angle()

    def _closing_angle(self) -> float:
        """The angle about the tangent by which the frame of a closed smooth directrix comes home turned; else 0."""
        start, end = self._tangents[0], self._tangents[-1]
        if not self.directrix.is_closed() or start @ end < 1 - 1e-9:
            return 0.0
        across = np.eye(3)[np.argmin(np.abs(start))]
        across = across - (across @ start) * start
        home = self._rotations[-1] @ across
        return float(np.arctan2(start @ np.cross(across, home), across @ home))

    def rotation(self, w: Array) -> Array:
        """R(w), shape w.shape + (3, 3): one reflection step from the node before w."""
        before = np.clip(np.searchsorted(self._nodes, w, side="right") - 1, 0, len(self._nodes) - 1)
        point, tangent = self.directrix._derivative(w, 0), unit_tangent(self.directrix, w)
        point = np.broadcast_to(point, (*w.shape, 3))
        step = _double_reflection(self._points[before], self._tangents[before], point, tangent)
        rotation = step @ self._rotations[before]
        return np.asarray(_about(tangent, -self.closing * w) @ rotation if self.closing else rotation)

    def spin(self, w: Array) -> Array:
        """omega(w) = t x t', less the closing angle about t; shape w.shape + (3,)."""
        first, second = (derivative(self.directrix, w, n) for n in (1, 2))
        speed = norm(first)[..., None]
        return np.asarray(cross(first, second) / speed**2 - self.closing * first / speed)

    def spin_rate(self, w: Array) -> Array:
        """omega'(w), shape w.shape + (3,)."""
        first, second, third = (derivative(self.directrix, w, n) for n in (1, 2, 3))
        speed, slowing = dot(first, first)[..., None], dot(first, second)[..., None]
        rate = cross(first, third) / speed - 2 * slowing * cross(first, second) / speed**2
        tangent_rate = second / np.sqrt(speed) - slowing * first / speed**1.5
        return np.asarray(rate - self.closing * tangent_rate)


FRAMES = {"fixed": FixedFrame, "frenet": FrenetFrame, "minimal": MinimalFrame}


def derivative(curve: Curve, w: Array, n: int) -> Array:
    """The n-th derivative, w.shape + (3,): the curve's own where it has one, numeric where it refuses."""
    try:
        value = curve._derivative(w, n)
    except OrderError:
        flat = numeric_derivative(lambda t: curve._derivative(t, 0), w.ravel(), n)
        value = flat.reshape(*w.shape, 3)
    return np.broadcast_to(value, (*w.shape, 3))


def unit_tangent(curve: Curve, w: Array) -> Array:
    """D'/|D'|, shape w.shape + (3,); an error where the curve stands still."""
    velocity = np.broadcast_to(curve._derivative(w, 1), (*w.shape, 3))
    speed = norm(velocity)
    still = ~(speed > STILL * speed.max())
    if still.any():
        raise DegenerateError(
            f"the directrix stands still at w = {w[still].flat[0]:.3g}: it has no tangent there for the frame to follow. "
            "Use frame='fixed', or a directrix without a cusp."
        )
    return np.asarray(velocity / speed[..., None])


def _double_reflection(x0: Array, t0: Array, x1: Array, t1: Array) -> Array:
    """Rotations (..., 3, 3) that carry a frame from x0 with tangent t0 to x1 with tangent t1, hardly turning about it.

    First the mirror that exchanges x0 and x1, then the one that sends the mirrored tangent to t1.
    """
    first = _mirror(x1 - x0)
    mirrored = np.einsum("...ij,...j->...i", first, t0)
    step = _mirror(t1 - mirrored) @ first
    step[(x0 == x1).all(axis=-1)] = np.eye(3)
    return np.asarray(step)


def _mirror(v: Array) -> Array:
    """I - 2 v v^T / v.v, shape (..., 3, 3)."""
    size = np.maximum(dot(v, v), np.finfo(np.float64).tiny)[..., None, None]
    return np.eye(3) - 2 * v[..., :, None] * v[..., None, :] / size


def _about(k: Array, angle: Array) -> Array:
    """Rotations about unit directions k (..., 3) by angles (...): shape (..., 3, 3) (Rodrigues)."""
    cos, sin = np.cos(angle)[..., None, None], np.sin(angle)[..., None, None]
    wedge = np.cross(np.eye(3), k[..., None, :])  # rows e_i x k: the matrix of v -> k x v
    return cos * np.eye(3) + sin * wedge + (1 - cos) * k[..., :, None] * k[..., None, :]
