"""The generic sweep: a curve carried along any curve."""

from __future__ import annotations

from collections.abc import Callable
from math import comb
from typing import Any

import numpy as np

from directrix import checks
from directrix.basis import linear
from directrix.checks import Array
from directrix.curves.curve import Curve
from directrix.curves.frames import FRAMES, FixedFrame, FrenetFrame, MinimalFrame
from directrix.curves.function import as_curve
from directrix.surfaces.surface import Orders, Surface

MOVING = "The turning of a moving frame is known to its second derivative."


class GenericSweep(Surface):
    """A generatrix carried along a directrix: S(u, w) = D(w) + s(w) R(w) (G(u) - D(0)), s(w) = 1 + (taper - 1) w.

    It starts in its own place, S(u, 0) = G(u), and need not touch the directrix. The frame says how it turns:

    - 'fixed': R = I, the translational sweep G(u) + D(w) - D(0). With a circle for D this is no torus: the section does not
      turn.
    - 'frenet': with the tangent, principal normal and binormal of D; needs curvature everywhere.
    - 'minimal': never about the tangent (Wang et al. 2008, double reflection); closes on a closed smooth directrix.

    With 'fixed' derivatives reach as far as those of the curves; the moving frames go to the second order in w, from their
    angular velocity and its rate. These take derivatives of D up to the fourth ('frenet') or third ('minimal'): exact for
    curves of the library, numeric for other callables (S_ww then to about 1e-5).
    (Piegl & Tiller, The NURBS Book, 2nd ed., section 10.4, swept surfaces.)

    Parameters
    ----------
    generatrix : curve in u, of the library or any vectorised callable u -> (..., 3); need not be plane
    directrix : curve in w, likewise; its start need not lie on the generatrix
    frame : 'fixed', 'frenet' or 'minimal'
    taper : size of the section at w = 1 as part of its size at w = 0, changing evenly; 1 leaves it, 0 shrinks it to a point

    Raises
    ------
    CurveError
        If a curve is no vectorised callable.
    NumberError
        If the frame is none of the three, or the taper is not finite.
    DegenerateError
        If a moving frame does not exist: the directrix stands still, or for 'frenet' is straight or has an inflection.

    Examples
    --------
    >>> from directrix.curves.line import Line
    >>> GenericSweep(Line((1, 0, 0), (2, 0, 0)), Line((5, 5, 5), (5, 9, 5)))(0.5, 0.5)
    array([1.5, 2. , 0. ])
    """

    generatrix: Curve
    directrix: Curve
    frame: str
    taper: float

    def __init__(
        self,
        generatrix: Callable[[Array], Any],
        directrix: Callable[[Array], Any],
        frame: str = "fixed",
        *,
        taper: float = 1.0,
    ) -> None:
        self._hold(
            generatrix=as_curve("generatrix", generatrix),
            directrix=as_curve("directrix", directrix),
            frame=checks.choice("frame", frame, tuple(FRAMES)),
            taper=checks.number("taper", taper),
        )
        object.__setattr__(self, "_turning", FRAMES[frame](self.directrix))  # found from what is held, so no part of it

    _turning: FixedFrame | FrenetFrame | MinimalFrame

    def __setstate__(self, state: dict[str, Any]) -> None:
        super().__setstate__(state)
        object.__setattr__(self, "_turning", FRAMES[self.frame](self.directrix))

    def _derivative(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        return self._jet(u, w, ((nu, nw),))[0]

    def _jet(self, u: Array, w: Array, orders: Orders) -> list[Array]:
        anchor = self.directrix._derivative(np.array(0.0), 0)
        sections = {nu: self.generatrix._derivative(u, nu) for nu in {nu for nu, _ in orders}}
        turns = {nw: self._turned(w, nw) for nw in {nw for _, nw in orders}}
        return [self._placed(sections[nu], anchor, turns[nw], w, nu, nw) for nu, nw in orders]

    def _placed(self, section: Array, anchor: Array, turned: Array | None, w: Array, nu: int, nw: int) -> Array:
        """One derivative; what does not turn is added as it is, so that S(u, 0) = G(u) to the last bit."""
        value = section if nw == 0 else np.zeros(3)
        if turned is not None:
            arm = section - anchor if nu == 0 else section
            value = value + np.einsum("...ij,...j->...i", turned, np.broadcast_to(arm, np.broadcast_shapes(arm.shape, (3,))))
        if nu == 0:
            path = self.directrix._derivative(w, nw)
            value = value + (path - anchor if nw == 0 else path)
        return value

    def _turned(self, w: Array, nw: int) -> Array | None:
        """The nw-th derivative of s(w) R(w) - I, shape w.shape + (3, 3); None where it vanishes for every w."""
        if self.frame == "fixed" and (self.taper == 1 or nw > 1):
            return None
        if self.frame != "fixed":
            checks.derivative_order("nw", nw, most=2, why=MOVING)
        total = np.zeros((*w.shape, 3, 3))
        for i in range(min(nw, 1) + 1):
            scale = linear(w, 1.0, self.taper, i)[..., None, None]
            total = total + comb(nw, i) * scale * self._rotation(w, nw - i)
        return total - np.eye(3) if nw == 0 else total

    def _rotation(self, w: Array, n: int) -> Array:
        """R and its derivatives: R' = [omega] R, R'' = ([omega'] + [omega]^2) R."""
        rotation = self._turning.rotation(w)
        if n == 0:
            return rotation
        if self.frame == "fixed":
            return np.zeros((*w.shape, 3, 3))
        spin = _wedge(self._turning.spin(w))
        if n == 1:
            return np.asarray(spin @ rotation)
        return np.asarray((_wedge(self._turning.spin_rate(w)) + spin @ spin) @ rotation)

    def breaks(self) -> tuple[Array, Array]:
        """Those of the generatrix, and of the directrix."""
        return self.generatrix.breaks(), self.directrix.breaks()


def _wedge(v: Array) -> Array:
    """The matrices of x -> v x x, shape (..., 3, 3)."""
    result = np.zeros((*v.shape, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        result[..., i, j], result[..., j, i] = -v[..., k], v[..., k]
    return result
