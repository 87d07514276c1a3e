"""Knot vectors: open, uniform and periodic ones made, given ones checked, and u in [0, 1] stretched onto their domain.

order k = degree + 1 throughout. m control points and order k need m + k knots; the curve lives on [t_(k-1), t_m], counted
from 0, which is ``knots[order - 1]`` to ``knots[-order]`` (Piegl & Tiller, The NURBS Book, 2nd ed., section 2.2).

Given knots may be any non-decreasing sequence. A knot that occurs more than k times leaves functions whose whole support is
that one point: by the recursion's 0/0 := 0 they are zero everywhere, their control points move nothing, and the other functions
sum to 1 on every span as before. Nothing is lost without them, and every conversion leaves them out.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.checks import Array
from directrix.errors import KnotError
from directrix.frozen import Frozen

Knots = ArrayLike | str
KINDS = ("open", "uniform", "periodic")


class KnotVector(Frozen):
    """A checked knot vector with its order.

    Attributes
    ----------
    values : (m + k,) non-decreasing knots for m basis functions
    order : k = degree + 1
    wrap : number of first control points that are used again at the end: k - 1 when periodic, else 0
    """

    values: Array
    order: int
    wrap: int

    def __init__(self, values: Array, order: int, wrap: int = 0) -> None:
        self._hold(values=np.array(values, dtype=np.float64), order=order, wrap=wrap)

    @property
    def degree(self) -> int:
        """order - 1."""
        return self.order - 1

    @property
    def count(self) -> int:
        """Number of basis functions, repeated control points included."""
        return len(self.values) - self.order

    @cached_property
    def start(self) -> float:
        """Where the domain begins: values[order - 1]."""
        return float(self.values[self.order - 1])

    @cached_property
    def end(self) -> float:
        """Where the domain ends: values[-order]."""
        return float(self.values[-self.order])

    def stretch(self, u: Array) -> Array:
        """u in [0, 1] as the knot parameter t, linearly onto the domain; both ends met exactly."""
        return (1 - u) * self.start + u * self.end

    def relax(self, t: Array) -> Array:
        """The knot parameter t as u in [0, 1]: the way back from ``stretch``."""
        return (np.asarray(t) - self.start) / (self.end - self.start)

    def breaks(self) -> Array:
        """The distinct knots of the domain as values of u, from 0 to 1."""
        inner = self.relax(np.unique(self.values))
        return np.concatenate([[0.0], inner[(inner > 0) & (inner < 1)], [1.0]])

    def multiplicity(self, t: float) -> int:
        """How often the knot t occurs."""
        return int((self.values == t).sum())

    @property
    def live(self) -> Array:
        """Which functions are not zero everywhere: (count,) booleans, False where t_i = t_(i+k)."""
        return np.asarray(self.values[self.order :] > self.values[: self.count])

    @property
    def clamped(self) -> bool:
        """Whether the first and last ``order`` knots are the domain's ends, no function is zero, and no point is used twice."""
        ends = self.values[0] == self.start and self.values[-1] == self.end
        return bool(ends and not self.wrap and self.live.all())

    def extended(self, points: Array, axis: int = 0) -> Array:
        """Control points (or weights) with the first ``wrap`` repeated at the end along an axis."""
        if not self.wrap:
            return points
        return np.concatenate([points, np.take(points, range(self.wrap), axis=axis)], axis=axis)


def knot_vector(name: str, knots: Knots, count: int, order: int) -> KnotVector:
    """The knot vector for ``count`` control points of an order: a word, or knots given in full.

    Parameters
    ----------
    name : what the caller calls the argument, for messages
    knots : 'open' (ends repeated k times), 'uniform' (0, 1, 2, ...), 'periodic' (uniform, the first k - 1 points used again at
        the end, so the curve closes smoothly), or any non-decreasing sequence of count + order numbers; a control point whose
        k + 1 knots are all one has no influence
    count : m, number of control points
    order : k = degree + 1, 1 <= k <= m

    Raises
    ------
    KnotError
        If given knots are too few or too many, decrease, or leave an empty domain.

    Examples
    --------
    >>> knot_vector("knots", "open", 5, 3).values.tolist()
    [0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0]
    >>> knot_vector("knots", "periodic", 5, 3).count
    7
    """
    if isinstance(knots, str):
        checks.choice(name, knots, KINDS, hint="Or give all knots as numbers.")
        if knots == "open":
            return KnotVector(open_knots(count, order), order)
        wrap = order - 1 if knots == "periodic" else 0
        return KnotVector(uniform_knots(count + wrap, order), order, wrap)
    return KnotVector(_given(name, knots, count, order), order)


def open_knots(count: int, order: int) -> Array:
    """Integer open uniform knots: 0 (k times), 1, ..., m - k, m - k + 1 (k times), for m = count, k = order.

    With m = k there are no inner knots: the Bezier case.

    Raises
    ------
    OrderError
        If not 1 <= order <= count.

    Examples
    --------
    >>> open_knots(6, 4).tolist()
    [0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0, 3.0]
    """
    k = checks.order("order", order, checks.whole("count", count, least=1))
    return np.clip(np.arange(count + k) - k + 1.0, 0.0, count - k + 1.0)


def uniform_knots(count: int, order: int) -> Array:
    """Knots 0, 1, ..., count + order - 1: nothing repeated, so the curve does not reach its first and last control points.

    >>> uniform_knots(3, 2).tolist()
    [0.0, 1.0, 2.0, 3.0, 4.0]
    """
    k = checks.order("order", order, checks.whole("count", count, least=1))
    return np.arange(count + k, dtype=np.float64)


def _given(name: str, knots: ArrayLike, count: int, order: int) -> Array:
    values = checks.array(name, knots)
    needed = count + order
    if values.shape != (needed,):
        raise KnotError(
            f"{name} must be {needed} numbers: {count} control points + order {order} (degree {order - 1}); "
            f"got shape {values.shape}. Repeat the end knots {order} times to reach the end points.",
            name=name,
            got=values.shape,
            needed=needed,
        )
    if (np.diff(values) < 0).any():
        at = int(np.argmax(np.diff(values) < 0))
        raise KnotError(
            f"{name} must not decrease; knot {at} is {values[at]:g} and knot {at + 1} is {values[at + 1]:g}.", name=name, got=at
        )
    if values[order - 1] >= values[-order]:
        raise KnotError(
            f"{name} must leave a domain: knots[order - 1] < knots[-order]; both are {values[order - 1]:g}.",
            name=name,
            got=float(values[order - 1]),
        )
    return values
