"""B-spline and NURBS patches of orders k and l.

On a grid of parameters both are matrix products over planes of coordinates (`tensor.Grid`), the rational one over four planes
and a division, a block of rows at a time so that it stays in a processor's cache. At scattered points only the k x l control
points near each parameter count (`support.ScatteredSums`), and the cost does not grow with the net. `de_boor_point` is the slow
honest way.
"""

# ruff: noqa: E741 (k and l are the orders, as the lecture names them)
from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.basis import clamped, cox_de_boor, on_knots, spline_span
from directrix.checks import Array
from directrix.curves.rational import lift
from directrix.errors import DomainError
from directrix.knots import Knots, KnotVector, knot_vector
from directrix.surfaces.grids import row_blocks
from directrix.surfaces.rational import cartesian, lower
from directrix.surfaces.support import FEW, ScatteredSums, compiled_row, row_of
from directrix.surfaces.surface import Orders, Surface
from directrix.surfaces.tensor import Grid, planes, window
from directrix.transform import Transform

SMALL = 8  # points of a grid for which local support beats the matrix products

if TYPE_CHECKING:
    from scipy.interpolate import BSpline

Sums = dict[tuple[int, int], Array]  # order -> that derivative of the blended coefficients, as planes

Made = TypeVar("Made", bound="SplinePatch")


class SplinePatch(Surface):
    """What both share: a net, two knot vectors, and the homogeneous or plain coefficients they blend."""

    control_net: Array
    k: int
    l: int
    knot_vector_u: KnotVector
    knot_vector_w: KnotVector

    @property
    def degrees(self) -> tuple[int, int]:
        """Degrees in u and in w: k - 1 and l - 1."""
        return self.k - 1, self.l - 1

    @property
    def knots_u(self) -> Array:
        """The knots of u, m + k numbers; m + 2k - 1 when periodic."""
        return self.knot_vector_u.values

    @property
    def knots_w(self) -> Array:
        """The knots of w, n + l numbers; n + 2l - 1 when periodic."""
        return self.knot_vector_w.values

    def breaks(self) -> tuple[Array, Array]:
        """The distinct knots, as values of u and of w."""
        return self.knot_vector_u.breaks(), self.knot_vector_w.breaks()

    def _coefficients(self) -> Array:
        """What the basis functions blend, shape (m, n, d), d = 3 or 4, before first points are repeated for periodic knots."""
        raise NotImplementedError

    @cached_property
    def _blended(self) -> Array:
        return self.knot_vector_w.extended(self.knot_vector_u.extended(self._coefficients(), axis=0), axis=1)

    @cached_property
    def _planes(self) -> Array:
        return planes(self._blended)

    @cached_property
    def _rows(self) -> tuple[BSpline, BSpline]:
        return compiled_row(self.knot_vector_u), compiled_row(self.knot_vector_w)

    @cached_property
    def _sums(self) -> ScatteredSums:
        return ScatteredSums(self._blended, self.knot_vector_u, self.knot_vector_w)

    def _points(self, sums: Sums, orders: Orders, out: Array | None = None) -> list[Array]:
        """Derivatives of the surface (..., 3) from those of the blended coefficients; into planes ``out``, if given."""
        raise NotImplementedError

    def _below(self, orders: Orders) -> Orders:
        """The derivatives of the blended coefficients that those of the surface are made of."""
        return orders

    def _jet(self, u: Array, w: Array, orders: Orders) -> Sequence[Array]:
        if np.broadcast(u, w).size <= FEW:
            return self._points(self._sums.few(u, w, self._below(orders)), orders)
        u, w = np.broadcast_arrays(u, w)
        out = np.empty((len(orders), 3, u.size))
        for part, found in self._sums.blocks(u.ravel(), w.ravel(), self._below(orders)):
            self._points(found, orders, out[..., part])
        return [value.T.reshape(*u.shape, 3) for value in out]

    def _mesh(self, u: Array, w: Array, orders: Orders) -> Sequence[Array]:
        if u.size * w.size <= SMALL:
            return self._jet(u[:, None], w[None], orders)
        below = self._below(orders)
        grid = self._grid(u, w, below)
        out = np.empty((len(orders), 3, u.size, w.size))
        for part in row_blocks((u.size, w.size)):
            self._points(grid(part, below), orders, out[:, :, part])
        return [value.transpose(1, 2, 0) for value in out]

    def _mesh_rows(self, u: Array, w: Array, orders: Orders) -> Callable[[slice], Sequence[Array]]:
        if u.size * w.size <= SMALL:
            return super()._mesh_rows(u, w, orders)
        below = self._below(orders)
        grid = self._grid(u, w, below)
        return lambda part: self._points(grid(part, below), orders)

    def _grid(self, u: Array, w: Array, orders: Orders) -> Grid:
        """What gives derivatives of the blended coefficients on rows of the grid of u (p,) and w (q,)."""
        rows = {nu: row_of(self._rows[0], self.knot_vector_u, u, nu) for nu in {nu for nu, _ in orders}}
        columns = {nw: row_of(self._rows[1], self.knot_vector_w, w, nw) for nw in {nw for _, nw in orders}}
        end = spline_span(self.knots_u, self.k, self.knot_vector_u.stretch(u)) + 1
        return Grid(self._planes, rows, columns, (end - self.k, end))

    def _part(self, corners: tuple[float, float, float, float]) -> tuple[Array, KnotVector, KnotVector]:
        """Coefficients and knots of a part; a part that begins after its end is run backwards."""
        u0, u1, w0, w1 = corners
        blended, knots_u = spline_part(self.knot_vector_u, self._blended, u0, u1)
        turned, knots_w = spline_part(self.knot_vector_w, blended.swapaxes(0, 1), w0, w1)
        return turned.swapaxes(0, 1), knots_u, knots_w

    def _derivative(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        return self._jet(u, w, ((nu, nw),))[0]


class BSplinePatch(SplinePatch):
    """The B-spline patch S(u, w) = Σ_i Σ_j N_i,k(s) N_j,l(t) P_ij of orders k and l (degrees k - 1 and l - 1).

    s and t are u and w stretched linearly onto the knots' own domains, s = (1-u) knots_u[k-1] + u knots_u[-k]; derivatives are
    with respect to u and w (Piegl & Tiller, The NURBS Book, 2nd ed., section 3.4, with k = p + 1). A control point moves k x l
    spans only. At a knot repeated k - 1 times there is a crease, k times a gap; values and derivatives there are those of
    growing u, and at u = 1 those of the last span. With k = m and l = n it is the Bezier patch of the net. Derivatives to any
    order.

    Parameters
    ----------
    net : (m, n, 3), m, n >= 2, first index along u, in any one unit of length
    k, l : orders = degree + 1 along u and w, 1 <= k <= m, 1 <= l <= n; 4 is cubic
    knots_u, knots_w : 'open' (default: reaches the corner points), 'uniform', 'periodic' (closes smoothly: the first k - 1 rows
        are used again), or m + k (n + l) non-decreasing numbers; a row whose k + 1 knots are all one has no influence

    Raises
    ------
    ShapeError
        If net is not (m, n, 3).
    OrderError
        If an order is above the number of points along its direction.
    KnotError
        If given knots do not fit.

    Examples
    --------
    >>> net = [[(x, y, x * (4 - x)) for y in (0, 2)] for x in (0, 1, 2, 4)]
    >>> roof = BSplinePatch(net, 3, 2)
    >>> roof(0.5, 0.25)
    array([1.5, 0.5, 3.5])
    >>> roof(1, 1)
    array([4., 2., 0.])
    >>> roof.knots_u
    array([0., 0., 0., 1., 2., 2., 2.])
    """

    def __init__(self, net: ArrayLike, k: int, l: int, knots_u: Knots = "open", knots_w: Knots = "open") -> None:
        self._hold(**_checked(checks.net("net", net), k, l, knots_u, knots_w))

    def _coefficients(self) -> Array:
        return self.control_net

    def _points(self, sums: Sums, orders: Orders, out: Array | None = None) -> list[Array]:
        if out is None:
            return [np.moveaxis(sums[order], 0, -1) for order in orders]
        for order, place in zip(orders, out, strict=True):
            place[...] = sums[order]
        return [np.moveaxis(place, 0, -1) for place in out]

    def with_net(self, net: Array, knots_u: KnotVector | None = None, knots_w: KnotVector | None = None) -> BSplinePatch:
        """The same orders with another net, on the same knots or on others."""
        return _made(type(self), self, control_net=net, knot_vector_u=knots_u, knot_vector_w=knots_w)

    def patch(self, u0: float, u1: float, w0: float, w1: float) -> BSplinePatch:
        """The part from (u0, w0) to (u1, w1) as a B-spline patch of its own, with clamped knots."""
        net, knots_u, knots_w = self._part(window(u0, u1, w0, w1))
        return self.with_net(net, knots_u, knots_w)

    def moved(self, transform: Transform) -> BSplinePatch:
        """The B-spline patch of the moved net."""
        return self.with_net(transform.points(self.control_net))

    def swap(self) -> BSplinePatch:
        """The same surface with u and w exchanged: the net transposed, orders and knots exchanged."""
        return _swapped(self, control_net=self.control_net.swapaxes(0, 1))


class NurbsPatch(SplinePatch):
    """The rational B-spline patch S = Σ_i Σ_j N_i,k(s) N_j,l(t) h_ij P_ij / Σ_i Σ_j N_i,k(s) N_j,l(t) h_ij.

    The points are Cartesian, *not* multiplied by their weights h (several libraries expect them multiplied). Equal weights give
    the `BSplinePatch`; multiplying all by one number changes nothing; a larger h_ij pulls the surface to P_ij (Piegl & Tiller,
    The NURBS Book, 2nd ed., sections 4.4 and 4.5, who write w for the weights). Parameters, knots and sides as for
    `BSplinePatch`. Derivatives to any order, by their equation 4.20.

    Parameters
    ----------
    net : (m, n, 3), Cartesian, m, n >= 2, first index along u, in any one unit of length
    weights : (m, n), all > 0
    k, l : orders = degree + 1 along u and w, 1 <= k <= m, 1 <= l <= n
    knots_u, knots_w : as for `BSplinePatch`

    Raises
    ------
    ShapeError
        If net is not (m, n, 3) or weights not (m, n).
    WeightError
        If a weight is not above 0.
    OrderError, KnotError
        If orders or knots do not fit.

    Examples
    --------
    >>> net = [[(x, y, z) for y in (0, 2)] for x, z in ((0, 0), (1, 2), (2, 0))]
    >>> weights = [(1, 1), (3, 3), (1, 1)]
    >>> NurbsPatch(net, weights, 3, 2)(0.5, 0.5)
    array([1. , 1. , 1.5])
    """

    weights: Array

    def __init__(
        self,
        net: ArrayLike,
        weights: ArrayLike,
        k: int,
        l: int,
        knots_u: Knots = "open",
        knots_w: Knots = "open",
    ) -> None:
        net = checks.net("net", net)
        weights = checks.weights("weights", weights, net.shape[:2])
        self._hold(**_checked(net, k, l, knots_u, knots_w), weights=weights)

    def _coefficients(self) -> Array:
        return lift(self.control_net, self.weights)

    def _below(self, orders: Orders) -> Orders:
        return cast("Orders", lower(orders))  # pairs in, pairs out

    def _points(self, sums: Sums, orders: Orders, out: Array | None = None) -> list[Array]:
        return cartesian(cast("dict[tuple[int, ...], Array]", sums), orders, out)

    def with_net(
        self, net: Array, weights: Array, knots_u: KnotVector | None = None, knots_w: KnotVector | None = None
    ) -> NurbsPatch:
        """The same orders with another net and weights, on the same knots or on others."""
        return _made(type(self), self, control_net=net, weights=weights, knot_vector_u=knots_u, knot_vector_w=knots_w)

    def patch(self, u0: float, u1: float, w0: float, w1: float) -> NurbsPatch:
        """The part from (u0, w0) to (u1, w1) as a NURBS patch of its own, with clamped knots."""
        lifted, knots_u, knots_w = self._part(window(u0, u1, w0, w1))
        return self.with_net(lifted[..., :3] / lifted[..., 3:], lifted[..., 3], knots_u, knots_w)

    def moved(self, transform: Transform) -> NurbsPatch:
        """The patch of the moved net with the same weights, which is the moved patch for every affine map."""
        return self.with_net(transform.points(self.control_net), self.weights)

    def swap(self) -> NurbsPatch:
        """The same surface with u and w exchanged."""
        return _swapped(self, control_net=self.control_net.swapaxes(0, 1), weights=self.weights.T)


def de_boor_point(patch: BSplinePatch | NurbsPatch, u: float, w: float) -> Array:
    """One point of a patch, summed over the whole net with the Cox-de Boor recursion: the slow honest way.

    Examples
    --------
    >>> net = [[(x, y, x * y) for y in (0, 2)] for x in (0, 1, 2)]
    >>> de_boor_point(BSplinePatch(net, 3, 2), 0.5, 0.5).tolist()
    [1.0, 1.0, 1.0]
    """
    N_u = cox_de_boor(patch.knots_u, patch.k, float(patch.knot_vector_u.stretch(np.array(u))))
    N_w = cox_de_boor(patch.knots_w, patch.l, float(patch.knot_vector_w.stretch(np.array(w))))
    weights = patch.weights if isinstance(patch, NurbsPatch) else np.ones(patch.control_net.shape[:2])
    above, below = np.zeros(3), 0.0
    for i, a in enumerate(N_u):
        for j, b in enumerate(N_w):
            here = i % len(weights), j % len(weights[0])  # periodic: the first rows again
            above = above + a * b * weights[here] * patch.control_net[here]
            below = below + a * b * weights[here]
    return np.asarray(above / below) if isinstance(patch, NurbsPatch) else above


def _checked(net: Array, k: int, l: int, knots_u: Knots, knots_w: Knots) -> dict[str, object]:
    m, n = net.shape[:2]
    k, l = checks.order("k", k, m), checks.order("l", l, n)
    return {
        "control_net": net,
        "k": k,
        "l": l,
        "knot_vector_u": knot_vector("knots_u", knots_u, m, k),
        "knot_vector_w": knot_vector("knots_w", knots_w, n, l),
    }


def _made(kind: type[Made], like: Surface, **changed: object) -> Made:
    """A form of the same kind with some of its attributes changed; None leaves one as it is."""
    result = kind.__new__(kind)
    given = {name: value for name, value in changed.items() if value is not None}
    result._hold(**{name: given.get(name, getattr(like, name)) for name in like._names})
    return result


def _swapped(like: Made, **changed: Array) -> Made:
    return _made(
        type(like), like, k=like.l, l=like.k, knot_vector_u=like.knot_vector_w, knot_vector_w=like.knot_vector_u, **changed
    )


def spline_part(knots: KnotVector, points: Array, u0: float, u1: float) -> tuple[Array, KnotVector]:
    """Control points along axis 0, repeated ones included, and clamped knots of the part [u0, u1]; backwards if u0 > u1."""
    start, end = (float(t) for t in knots.stretch(np.sort([u0, u1])))
    if start == end:
        raise DomainError(f"from {u0:g} to {u1:g} is too little to cut: on the knots both are {start:g} to rounding.")
    values = clamped(knots.values, knots.order, start, end)
    same = np.array_equal(values, knots.values)
    part = points if same else on_knots(knots.values, knots.order, points, values)
    if u0 > u1:
        part, values = part[::-1], start + end - values[::-1]
        values[: knots.order], values[-knots.order :] = start, end
    return part, KnotVector(values, knots.order)
