"""The point form: the polynomial patch through a grid of points."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.basis import lagrange
from directrix.checks import Array
from directrix.errors import DegenerateError
from directrix.surfaces.tensor import TensorPatch, window
from directrix.transform import Transform


class PointPatch(TensorPatch):
    """The patch of degrees (m - 1, n - 1) through m x n points: S(tu[i], tw[j]) = P[i, j].

    S = Σ L_i(u) L_j(w) P_ij, L_i(t) = Π_{k != i} (t - t_k)/(t_i - t_k). With 4 x 4 points at 0, 1/3, 2/3, 1 it is the
    sixteen-point form (Mortenson, Geometric Modeling). The parameters have to be chosen: others give
    another surface through the same points. Beyond some twenty points a direction the surface oscillates between them.
    Derivatives to any order.

    Parameters
    ----------
    points : (m, n, 3), m, n >= 2, first index along u, in any one unit of length
    tu, tw : (m,) and (n,), increasing from 0 to 1; or ``chord``
        Equally spaced if not given. ``chord`` takes the chord lengths of the rows, made 1 in all and averaged
        (Piegl & Tiller, The NURBS Book, 2nd ed., equation 9.5 and algorithm A9.3).

    Raises
    ------
    ShapeError, NumberError
        If points is no net, or the parameters do not increase from 0 to 1.
    DegenerateError
        If chord lengths are asked for and neighbouring points coincide all along the net.

    Examples
    --------
    >>> P = [[(0, 0, 0), (0, 1, 0)], [(1, 0, 1), (1, 1, 1)], [(2, 0, 0), (2, 1, 0)]]
    >>> arch = PointPatch(P)
    >>> arch(0.25, 0.5)
    array([0.5 , 0.5 , 0.75])
    >>> PointPatch(P, tu=(0, 0.25, 1))(0.25, 0)
    array([1., 0., 1.])
    """

    points: Array
    tu: Array
    tw: Array

    def __init__(self, points: ArrayLike, tu: ArrayLike | str | None = None, tw: ArrayLike | str | None = None) -> None:
        net = checks.net("points", points)
        given = (("tu", tu, net), ("tw", tw, net.swapaxes(0, 1)))
        self._hold(points=net, **{name: _parameters(name, value, along) for name, value, along in given})

    def _net(self) -> Array:
        return self.points

    def _functions_u(self, u: Array, order: int) -> Array:
        return lagrange(self.tu, u, order)

    def _functions_w(self, w: Array, order: int) -> Array:
        return lagrange(self.tw, w, order)

    def moved(self, transform: Transform) -> PointPatch:
        """The patch through the moved points."""
        return PointPatch(transform.points(self.points), self.tu, self.tw)

    def patch(self, u0: float, u1: float, w0: float, w1: float) -> PointPatch:
        """The part from (u0, w0) to (u1, w1) as a point patch of its own, through points at the same parameters of the part."""
        u0, u1, w0, w1 = window(u0, u1, w0, w1)
        (net,) = self._mesh((1 - self.tu) * u0 + self.tu * u1, (1 - self.tw) * w0 + self.tw * w1, ((0, 0),))
        return PointPatch(net, self.tu, self.tw)

    def swap(self) -> PointPatch:
        """The same surface with u and w exchanged."""
        return PointPatch(self.points.swapaxes(0, 1), self.tw, self.tu)


def _parameters(name: str, value: ArrayLike | str | None, net: Array) -> Array:
    if value is None:
        return np.linspace(0.0, 1.0, len(net))
    if isinstance(value, str):
        checks.choice(name, value, ("chord",), hint="Or give the parameters themselves.")
        return chord_parameters(net)
    return checks.increasing(name, value, len(net))


def chord_parameters(net: Array) -> Array:
    """Parameters for axis 0 of a net (m, n, 3): chord lengths along it, each row's total made 1, averaged over the rows.

    Rows of no length (a collapsed edge) say nothing and are left out (Piegl & Tiller, The NURBS Book, 2nd ed., algorithm A9.3).

    Examples
    --------
    >>> chord_parameters(np.array([[(0, 0, 0)], [(1, 0, 0)], [(4, 0, 0)]], float)).tolist()
    [0.0, 0.25, 1.0]
    """
    steps = np.linalg.norm(np.diff(net, axis=0), axis=2)
    total = steps.sum(axis=0)
    if not total.any():
        raise DegenerateError("chord parameters need points that differ along the net; all steps have length 0.")
    share = (steps[:, total > 0] / total[total > 0]).mean(axis=1)
    if (share <= 0).any():
        raise DegenerateError(
            f"points {int(np.argmin(share))} and the next coincide in every row: give the parameters yourself."
        )
    parameters = np.concatenate([[0.0], np.cumsum(share)])
    parameters[-1] = 1.0
    return np.asarray(parameters)
