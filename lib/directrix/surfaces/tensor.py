"""Tensor products: S(u, w) = Σ_i Σ_j f_i(u) g_j(w) c_ij, the arithmetic that all patches with a net share.

Coordinates are kept apart, as planes c[0], c[1], c[2] of shape (m, n): on a grid of parameters each derivative is then two
matrix products, F c Gᵀ, two to three times faster than the same sums over an array (m, n, 3). The answer is a view of the
planes with the coordinates moved last.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property

import numpy as np

from directrix import checks
from directrix.checks import Array, Indices
from directrix.errors import OrderError
from directrix.surfaces.surface import Orders, Surface


def planes(net: Array) -> Array:
    """A net (m, n, d) as contiguous planes (d, m, n)."""
    return np.ascontiguousarray(np.moveaxis(net, -1, 0))


class Grid:
    """Σ_i Σ_j f_i(u) g_j(w) c_ij and its derivatives on the grid of u (p,) and w (q,), as planes, any rows of it at a time.

    The product along w is done once, c Gᵀ, and some rows of F times it are some rows of the grid. Of a spline only few f_i are
    not zero on neighbouring rows, and only these are multiplied. A grid much wider than long begins with F c instead. The
    arrays of one call are written over by the next: memory that was just used is still in a processor's cache.

    Parameters
    ----------
    coefficients : (d, m, n) planes
    rows : order nu -> (p, m) values of the nu-th derivatives of the functions of u
    columns : order nw -> (q, n), the same for w
    reach : (p,) first f_i that is not zero, and (p,) one more than the last; all of them if not given

    Examples
    --------
    >>> square = Grid(np.array([[[0.0, 0.0], [0.0, 1.0]]]), {0: np.eye(2)}, {0: np.eye(2)})
    >>> square(slice(1, 2), [(0, 0)])[0, 0].tolist()
    [[[0.0, 1.0]]]
    """

    WIDE = 8  # times wider than long

    def __init__(
        self,
        coefficients: Array,
        rows: dict[int, Array],
        columns: dict[int, Array],
        reach: tuple[Indices, Indices] | None = None,
    ) -> None:
        turned = {nw: np.ascontiguousarray(values.T) for nw, values in columns.items()}  # faster than transposed views
        self._wide = self.WIDE * len(rows[min(rows)]) < len(columns[min(columns)])
        self._reach = reach
        self._u = {nu: values @ coefficients for nu, values in rows.items()} if self._wide else rows
        self._w = turned if self._wide else {nw: coefficients @ values for nw, values in turned.items()}
        self._again: dict[tuple[int, int], Array] = {}

    def __call__(self, part: slice, orders: Orders) -> dict[tuple[int, int], Array]:
        """Some rows of the derivatives, each (d, rows, q); good until the next call."""
        near = slice(None)
        if self._reach is not None and not self._wide:
            near = slice(self._reach[0][part].min(), self._reach[1][part].max())
        return {order: self._product(part, near, order) for order in orders}

    def _product(self, part: slice, near: slice, order: tuple[int, int]) -> Array:
        f, g = self._u[order[0]][..., part, near], self._w[order[1]][..., near, :]
        place = self._again.get(order)
        if place is None or place.shape[1] < f.shape[-2]:
            self._again[order] = place = np.matmul(f, g)
            return place
        return np.matmul(f, g, out=place[:, : f.shape[-2]])


def sum_on_grid(along_u: Sequence[Array], along_w: Sequence[Array], p: int, q: int) -> Array:
    """Σ f(u) g(w) on a grid as one product of thin matrices for each coordinate.

    Parameters
    ----------
    along_u, along_w : as many arrays that broadcast to (p, 3), and to (q, 3)

    Returns
    -------
    (p, q, 3)
    """
    f = np.stack([np.broadcast_to(part, (p, 3)).T for part in along_u], axis=-1)
    g = np.stack([np.broadcast_to(part, (q, 3)).T for part in along_w], axis=1)
    return (f @ g).transpose(1, 2, 0)


def at_points(net: Array, rows: Array, columns: Array) -> Array:
    """The same sum point by point: rows (..., m) and columns (..., n) that broadcast, net (m, n, d); result (..., d)."""
    m, n, d = net.shape
    half = (rows @ net.reshape(m, n * d)).reshape(*rows.shape[:-1], n, d)
    return np.asarray((columns[..., None, :] @ half)[..., 0, :])


class TensorPatch(Surface):
    """A patch that is one tensor product of smooth functions: algebraic, Hermite, point and Bezier form."""

    def _net(self) -> Array:
        """The coefficients c_ij, shape (m, n, 3)."""
        raise NotImplementedError

    def _functions_u(self, u: Array, order: int) -> Array:
        """The functions f_i, or their derivatives, at u: shape u.shape + (m,)."""
        raise NotImplementedError

    def _functions_w(self, w: Array, order: int) -> Array:
        """The functions g_j, or their derivatives, at w: shape w.shape + (n,)."""
        raise NotImplementedError

    @cached_property
    def _planes(self) -> Array:
        return planes(self._net())

    @property
    def degrees(self) -> tuple[int, int]:
        """Degrees in u and in w: one less than the numbers of coefficients. The orders are one more."""
        m, n, _ = self._net().shape
        return m - 1, n - 1

    def _derivative(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        return at_points(self._net(), self._functions_u(u, nu), self._functions_w(w, nw))

    def _jet(self, u: Array, w: Array, orders: Orders) -> Sequence[Array]:
        rows = {nu: self._functions_u(u, nu) for nu in {nu for nu, _ in orders}}
        columns = {nw: self._functions_w(w, nw) for nw in {nw for _, nw in orders}}
        return [at_points(self._net(), rows[nu], columns[nw]) for nu, nw in orders]

    def _mesh(self, u: Array, w: Array, orders: Orders) -> Sequence[Array]:
        return self._mesh_rows(u, w, orders)(slice(None))

    def _mesh_rows(self, u: Array, w: Array, orders: Orders) -> Callable[[slice], Sequence[Array]]:
        rows = {nu: self._functions_u(u, nu) for nu in {nu for nu, _ in orders}}
        columns = {nw: self._functions_w(w, nw) for nw in {nw for _, nw in orders}}
        grid = Grid(self._planes, rows, columns)

        def derivatives(part: slice) -> list[Array]:
            found = grid(part, orders)
            return [found[order].transpose(1, 2, 0) for order in orders]

        return derivatives


def window(u0: float, u1: float, w0: float, w1: float) -> tuple[float, float, float, float]:
    """The corners of a part of the parameter square, checked: inside it, and not empty either way."""
    ends = {"u0": u0, "u1": u1, "w0": w0, "w1": w1}
    u0, u1, w0, w1 = (float(checks.parameter(name, checks.number(name, end))) for name, end in ends.items())
    for name, start, end in (("u", u0, u1), ("w", w0, w1)):
        if start == end:
            raise OrderError(f"{name}0 and {name}1 must differ; both are {start:g}, which leaves a curve and no patch.")
    return u0, u1, w0, w1
