"""B-spline and NURBS hyperpatches."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.checks import Array
from directrix.curves.rational import lift
from directrix.knots import Knots, KnotVector, knot_vector
from directrix.solids.solid import Orders, Solid, blended, checked_net
from directrix.surfaces.rational import cartesian, lower
from directrix.surfaces.spline import BSplinePatch, NurbsPatch
from directrix.surfaces.support import compiled_row, compiled_sums, row_of, speed
from directrix.surfaces.surface import Surface
from directrix.transform import Transform

if TYPE_CHECKING:
    from scipy.interpolate import BSpline, NdBSpline


Made = TypeVar("Made", bound="SplineSolid")


class SplineSolid(Solid):
    """What both share: a net, three orders, three knot vectors, and the coefficients they blend."""

    control_net: Array
    orders: tuple[int, int, int]
    knot_vectors: tuple[KnotVector, KnotVector, KnotVector]

    def _coefficients(self) -> Array:
        raise NotImplementedError

    @property
    def degrees(self) -> tuple[int, int, int]:
        """Degrees in u, v and w: orders - 1."""
        ku, kv, kw = self.orders
        return ku - 1, kv - 1, kw - 1

    def breaks(self) -> tuple[Array, Array, Array]:
        """The distinct knots, as values of u, v and w."""
        u, v, w = (knots.breaks() for knots in self.knot_vectors)
        return u, v, w

    @cached_property
    def _blended(self) -> Array:
        net = self._coefficients()
        for axis, knots in enumerate(self.knot_vectors):
            net = knots.extended(net, axis=axis)
        return net

    @cached_property
    def _rows(self) -> list[BSpline]:
        return [compiled_row(knots) for knots in self.knot_vectors]

    @cached_property
    def _compiled(self) -> NdBSpline:
        return compiled_sums(self._blended, self.knot_vectors)

    def _parts(self, u: Array, v: Array, w: Array, orders: Orders) -> list[Array]:
        """Derivatives of the blended coefficients (..., d): by rows on a grid, by local support at scattered points."""
        if max(u.size, v.size, w.size) < np.prod(np.broadcast_shapes(u.shape, v.shape, w.shape)):
            return [blended(self._blended, self._functions((u, v, w), order)) for order in orders]
        places = np.broadcast_arrays(u, v, w)
        t = np.stack([knots.stretch(x) for knots, x in zip(self.knot_vectors, places, strict=True)], axis=-1)
        return [self._local(t, order) for order in orders]

    def _functions(self, parameters: tuple[Array, ...], order: tuple[int, int, int]) -> tuple[Array, Array, Array]:
        f, g, h = (
            row_of(row, knots, x.ravel(), n).reshape(*x.shape, knots.count)
            for row, knots, x, n in zip(self._rows, self.knot_vectors, parameters, order, strict=True)
        )
        return f, g, h

    def _local(self, t: Array, order: tuple[int, int, int]) -> Array:
        if any(n >= k for n, k in zip(order, self.orders, strict=True)):
            return np.zeros((*t.shape[:-1], self._blended.shape[3]))
        scale = np.prod([speed(knots) ** n for knots, n in zip(self.knot_vectors, order, strict=True)])
        return np.asarray(self._compiled(t, nu=order)) * scale

    def _layer(self, axis: int, end: int) -> tuple[Array, list[KnotVector]]:
        """Coefficients and knots of a face. Knots that are not clamped reach their end between control points."""
        row = row_of(self._rows[axis], self.knot_vectors[axis], np.array([float(end)]), 0)[0]
        layer = np.tensordot(row, self._blended, axes=(0, axis))
        others = [knots for i, knots in enumerate(self.knot_vectors) if i != axis]
        return layer, [KnotVector(knots.values, knots.order) for knots in others]


class BSplineHyperpatch(SplineSolid):
    """The B-spline solid S(u, v, w) = Σ N_i,ku N_j,kv N_k,kw P_ijk of orders ku, kv, kw (degrees one less).

    u, v and w are stretched onto the knots' own domains, as for `BSplinePatch`; a control point moves ku x kv x kw spans only
    (Piegl & Tiller, The NURBS Book, 2nd ed., section 3.4, with one parameter more). Derivatives to any order.

    Parameters
    ----------
    net : (l, m, n, 3), axes u, v, w, in any one unit of length
    ku, kv, kw : orders = degree + 1, each at most the number of points along its axis
    knots_u, knots_v, knots_w : 'open', 'uniform', 'periodic' or all knots, as for `BSplinePatch`

    Raises
    ------
    ShapeError, OrderError, KnotError
        If net, orders or knots do not fit.

    Examples
    --------
    >>> net = [[[(x, y, z) for z in (0, 2)] for y in (0, 1, 2)] for x in (0, 1, 3, 4)]
    >>> BSplineHyperpatch(net, 3, 2, 2)(0.5, 0.25, 0.5)
    array([2. , 0.5, 1. ])
    """

    def __init__(
        self,
        net: ArrayLike,
        ku: int,
        kv: int,
        kw: int,
        knots_u: Knots = "open",
        knots_v: Knots = "open",
        knots_w: Knots = "open",
    ) -> None:
        self._hold(**_checked(checked_net("net", net), (ku, kv, kw), (knots_u, knots_v, knots_w)))

    def _coefficients(self) -> Array:
        return self.control_net

    def _derivatives(self, u: Array, v: Array, w: Array, orders: Orders) -> list[Array]:
        return self._parts(u, v, w, orders)

    def _nodes(self) -> int:
        return (3 * max(self.degrees)) // 2 + 1  # enough to be exact

    def _face(self, axis: int, end: int) -> Surface:
        net, knots = self._layer(axis, end)
        k, l = (vector.order for vector in knots)  # noqa: E741
        return BSplinePatch(net, k, l, *(vector.values for vector in knots))

    def moved(self, transform: Transform) -> BSplineHyperpatch:
        """The B-spline solid of the moved control points."""
        return _moved(self, transform)


class NurbsHyperpatch(SplineSolid):
    """The rational B-spline solid S = Σ N N N h_ijk P_ijk / Σ N N N h_ijk of orders ku, kv, kw.

    The points are Cartesian, not multiplied by their weights; all else as for `BSplineHyperpatch` and `NurbsPatch`
    (Piegl & Tiller, The NURBS Book, 2nd ed., section 4.4, with one more parameter).

    Parameters
    ----------
    net : (l, m, n, 3), Cartesian, axes u, v, w, in any one unit of length
    weights : (l, m, n), all > 0
    ku, kv, kw : orders = degree + 1
    knots_u, knots_v, knots_w : as for `BSplineHyperpatch`

    Raises
    ------
    ShapeError, WeightError, OrderError, KnotError
        If net, weights, orders or knots do not fit.

    Examples
    --------
    >>> net = [[[(x, y, z) for z in (0, 2)] for y in (0, 2)] for x in (0, 1, 3)]
    >>> weights = np.ones((3, 2, 2))
    >>> weights[1] = 3
    >>> NurbsHyperpatch(net, weights, 3, 2, 2)(0.5, 0.5, 0.5)
    array([1.125, 1.   , 1.   ])
    """

    weights: Array

    def __init__(
        self,
        net: ArrayLike,
        weights: ArrayLike,
        ku: int,
        kv: int,
        kw: int,
        knots_u: Knots = "open",
        knots_v: Knots = "open",
        knots_w: Knots = "open",
    ) -> None:
        net = checked_net("net", net)
        weights = checks.weights("weights", weights, net.shape[:3])
        self._hold(**_checked(net, (ku, kv, kw), (knots_u, knots_v, knots_w)), weights=weights)

    def _coefficients(self) -> Array:
        return lift(self.control_net, self.weights)

    def _derivatives(self, u: Array, v: Array, w: Array, orders: Orders) -> list[Array]:
        below = cast("Orders", lower(orders))  # triples in, triples out
        parts = [np.moveaxis(part, -1, 0) for part in self._parts(u, v, w, below)]
        return cartesian(dict(zip(below, parts, strict=True)), orders)

    def _face(self, axis: int, end: int) -> Surface:
        lifted, knots = self._layer(axis, end)
        k, l = (vector.order for vector in knots)  # noqa: E741
        return NurbsPatch(lifted[..., :3] / lifted[..., 3:], lifted[..., 3], k, l, *(vector.values for vector in knots))

    def moved(self, transform: Transform) -> NurbsHyperpatch:
        """The solid of the moved control points with the same weights."""
        return _moved(self, transform)


def _checked(net: Array, orders: tuple[int, int, int], knots: tuple[Knots, Knots, Knots]) -> dict[str, object]:
    counts = net.shape[:3]
    named = zip(("ku", "kv", "kw"), orders, counts, strict=True)
    ku, kv, kw = (checks.order(name, order, count) for name, order, count in named)
    vectors = zip(("knots_u", "knots_v", "knots_w"), knots, counts, (ku, kv, kw), strict=True)
    return {"control_net": net, "orders": (ku, kv, kw), "knot_vectors": tuple(knot_vector(*given) for given in vectors)}


def _moved(solid: Made, transform: Transform) -> Made:
    result = type(solid).__new__(type(solid))
    held = {name: getattr(solid, name) for name in solid._names}
    result._hold(**{**held, "control_net": transform.points(solid.control_net)})
    return result
