"""Coons patches: the surface through four boundary curves, continuous and discrete."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.basis import hermite, linear
from directrix.checks import Array
from directrix.curves.curve import Curve
from directrix.curves.function import as_curve
from directrix.errors import CornerError
from directrix.surfaces.boundary import CurveLike
from directrix.surfaces.surface import Orders, Surface
from directrix.surfaces.tensor import sum_on_grid
from directrix.transform import Transform

MEET = 1e-9  # corners meet when they are this near, as a fraction of the size of the four curves


class Coons(Surface):
    """The Coons patch: the surface through four boundary curves of any kind.

    Linear blending: S(u, w) = (1-w) c0(u) + w c1(u) + (1-u) d0(w) + u d1(w)
    - [(1-u)(1-w) p00 + u (1-w) p10 + (1-u) w p01 + u w p11],
    the two ruled surfaces less the bilinear one, which both contain (S. A. Coons, Surfaces for computer-aided design of space
    forms, MIT MAC-TR-41, 1967; Farin, Curves and Surfaces for CAGD, 5th ed., on Coons patches). Cubic blending has F1 and F2 of
    the Hermite functions in place of 1-t and t, in all three parts: the tangents across an edge then depend only on the edge's
    ends, so that patches side by side join smoothly. Derivatives as far as the curves have them: any order for those of the
    library, the second for plain callables (accuracy: see `FunctionCurve`).

    Parameters
    ----------
    c0, c1 : curves in u: c0(u) = S(u, 0), c1(u) = S(u, 1)
    d0, d1 : curves in w: d0(w) = S(0, w), d1(w) = S(1, w)
        Curves of the library or vectorised callables t -> (..., 3). All run in the direction of growing u or w, *not* head to
        tail round the patch.
    blend : ``linear`` or ``cubic``

    Raises
    ------
    CornerError
        If they do not meet: c0(0) = d0(0), c0(1) = d1(0), c1(0) = d0(1), c1(1) = d1(1), to 1e-9 of their size.
    CurveError
        If one of them is no curve.

    Examples
    --------
    >>> from directrix.curves.bezier import BezierCurve
    >>> c0 = BezierCurve([(0, 0, 0), (1, 0, 2), (2, 0, 0)])
    >>> c1 = BezierCurve([(0, 2, 0), (1, 2, 4), (2, 2, 0)])
    >>> d0, d1 = BezierCurve([(0, 0, 0), (0, 2, 0)]), BezierCurve([(2, 0, 0), (2, 2, 0)])
    >>> Coons(c0, c1, d0, d1)(0.5, 0.5)
    array([1. , 1. , 1.5])
    >>> Coons(c0, c1, d0, d1, blend="cubic").derivative(0.5, 0, 0, 1)
    array([0., 2., 0.])
    """

    c0: Curve
    c1: Curve
    d0: Curve
    d1: Curve
    blend: str

    def __init__(self, c0: CurveLike, c1: CurveLike, d0: CurveLike, d1: CurveLike, blend: str = "linear") -> None:
        given = {"c0": c0, "c1": c1, "d0": d0, "d1": d1}
        curves = {name: as_curve(name, curve) for name, curve in given.items()}
        meeting(**curves)
        self._hold(**curves, blend=checks.choice("blend", blend, ("linear", "cubic")))

    @property
    def corners(self) -> Array:
        """The corners p_ij, indexed [u, w], shape (2, 2, 3): ends of c0 and c1."""
        ends = np.array([0.0, 1.0])
        return np.stack([self.c0(ends), self.c1(ends)], axis=1)

    def _blend(self, t: Array, order: int) -> tuple[Array, Array]:
        """The two blending functions at t, with an axis for the coordinates."""
        if self.blend == "linear":
            return linear(t, 1.0, 0.0, order)[..., None], linear(t, 0.0, 1.0, order)[..., None]
        F = hermite(t, order)
        return F[..., 0, None], F[..., 1, None]

    def _derivative(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        f0, f1 = self._blend(u, nu)
        g0, g1 = self._blend(w, nw)
        p = self.corners
        along_u = g0 * (self.c0._derivative(u, nu) - f0 * p[0, 0] - f1 * p[1, 0])
        along_u = along_u + g1 * (self.c1._derivative(u, nu) - f0 * p[0, 1] - f1 * p[1, 1])
        along_w = f0 * self.d0._derivative(w, nw) + f1 * self.d1._derivative(w, nw)
        return along_u + along_w

    def _mesh(self, u: Array, w: Array, orders: Orders) -> Sequence[Array]:
        return [self._on_grid(u, w, nu, nw) for nu, nw in orders]

    def _on_grid(self, u: Array, w: Array, nu: int, nw: int) -> Array:
        """The same formula as ``_derivative``, as a sum of four products of a function of u and a function of w."""
        f0, f1 = self._blend(u, nu)
        g0, g1 = self._blend(w, nw)
        p = self.corners
        a0 = self.c0._derivative(u, nu) - f0 * p[0, 0] - f1 * p[1, 0]
        a1 = self.c1._derivative(u, nu) - f0 * p[0, 1] - f1 * p[1, 1]
        return sum_on_grid([a0, a1, f0, f1], [g0, g1, self.d0._derivative(w, nw), self.d1._derivative(w, nw)], u.size, w.size)

    def breaks(self) -> tuple[Array, Array]:
        """Where one of the curves is less smooth."""
        return np.union1d(self.c0.breaks(), self.c1.breaks()), np.union1d(self.d0.breaks(), self.d1.breaks())

    def moved(self, transform: Transform) -> Coons:
        """The Coons patch of the moved curves."""
        c0, c1, d0, d1 = (curve.moved(transform) for curve in (self.c0, self.c1, self.d0, self.d1))
        return Coons(c0, c1, d0, d1, blend=self.blend)

    def swap(self) -> Coons:
        """The same surface with u and w exchanged: c and d change places."""
        return Coons(self.d0, self.d1, self.c0, self.c1, blend=self.blend)


def meeting(c0: Curve, c1: Curve, d0: Curve, d1: Curve) -> None:
    """Whether four curves bound a patch: the four corner equations, with a tolerance that grows with the curves.

    Raises
    ------
    CornerError
        Naming the corner, both points and, where turning curves round mends it, which.
    """
    curves = {"c0": c0, "c1": c1, "d0": d0, "d1": d1}
    ends = {name: curve(np.array([0.0, 1.0])) for name, curve in curves.items()}
    samples = np.concatenate([curve(np.linspace(0.0, 1.0, 9)) for curve in curves.values()])
    near = MEET * float(np.linalg.norm(np.ptp(samples, axis=0)))
    for (a, i), (b, j) in _corners():
        gap = float(np.linalg.norm(ends[a][i] - ends[b][j]))
        if gap > near:
            raise CornerError(
                f"boundary curves must meet at the corners: {a}({i}) and {b}({j}) must be the same point; got "
                f"{_shown(ends[a][i])} and {_shown(ends[b][j])}, {gap:.3g} apart.{_advice(ends, near)}",
                corner=(f"{a}({i})", f"{b}({j})"),
                gap=gap,
            )


def _corners() -> list[tuple[tuple[str, int], tuple[str, int]]]:
    return [(("c0", 0), ("d0", 0)), (("c0", 1), ("d1", 0)), (("c1", 0), ("d0", 1)), (("c1", 1), ("d1", 1))]


def _advice(ends: dict[str, Array], near: float) -> str:
    """Which curves to turn round, or which pair to exchange, so that the corners meet; empty if neither helps."""

    def fits(turned: tuple[str, ...], names: dict[str, str]) -> bool:
        found = {name: ends[names[name]][:: -1 if name in turned else 1] for name in names}
        return all(np.linalg.norm(found[a][i] - found[b][j]) <= near for (a, i), (b, j) in _corners())

    plain = {name: name for name in ends}
    for count in range(1, 16):
        turned = tuple(name for bit, name in enumerate(ends) if count >> bit & 1)
        if len(turned) <= 2 and fits(turned, plain):
            return f" {' and '.join(turned)} run backwards: every curve goes in the direction of growing u or w (use .flip())."
    exchanges = {
        "c0 and c1": ("c1", "c0", "d0", "d1"),
        "d0 and d1": ("c0", "c1", "d1", "d0"),
        "c and d": ("d0", "d1", "c0", "c1"),
    }
    for words, order in exchanges.items():
        if fits((), dict(zip(ends, order, strict=True))):
            return f" {words} are exchanged: the order is c0 (w = 0), c1 (w = 1), d0 (u = 0), d1 (u = 1)."
    return " c0(u) = S(u, 0), c1(u) = S(u, 1), d0(w) = S(0, w), d1(w) = S(1, w)."


def _shown(point: Array) -> str:
    return "(" + ", ".join(f"{x:.6g}" for x in point) + ")"


def coons_net(
    c0: ArrayLike, c1: ArrayLike, d0: ArrayLike, d1: ArrayLike, tu: ArrayLike | None = None, tw: ArrayLike | None = None
) -> Array:
    """The discrete Coons net: inner control points from four boundary polygons.

    P_ij = (1-t_j) c0_i + t_j c1_i + (1-s_i) d0_j + s_i d1_j - [bilinear in the four corners], with s = tu, t = tw. With
    equally spaced s and t it is the net of the bilinearly blended Coons patch of four Bezier curves; for B-spline curves s
    and t must be the Greville abscissae of their knots: equally spaced ones miss the Coons patch by percents (Farin &
    Hansford, Discrete Coons patches, CAGD 16, 1999).

    Parameters
    ----------
    c0, c1 : (m, 3) polygons along u, at w = 0 and w = 1
    d0, d1 : (n, 3) polygons along w, at u = 0 and u = 1
    tu, tw : (m,) and (n,), from 0 to 1; equally spaced if not given

    Returns
    -------
    (m, n, 3)

    Raises
    ------
    ShapeError
        If two opposite polygons differ in their number of points.
    CornerError
        If they do not meet.

    Examples
    --------
    >>> c0, c1 = [(0, 0, 0), (1, 0, 2), (2, 0, 0)], [(0, 2, 0), (1, 2, 4), (2, 2, 0)]
    >>> net = coons_net(c0, c1, [(0, 0, 0), (0, 1, 0), (0, 2, 0)], [(2, 0, 0), (2, 1, 0), (2, 2, 0)])
    >>> net[1, 1]
    array([1., 1., 3.])
    """
    along_u, along_w = _polygons("c0", c0, "c1", c1), _polygons("d0", d0, "d1", d1)
    ends = {"c0": along_u[0][[0, -1]], "c1": along_u[1][[0, -1]], "d0": along_w[0][[0, -1]], "d1": along_w[1][[0, -1]]}
    near = MEET * float(np.linalg.norm(np.ptp(np.concatenate([*along_u, *along_w]), axis=0)))
    for (a, i), (b, j) in _corners():
        if np.linalg.norm(ends[a][i] - ends[b][j]) > near:
            raise CornerError(
                f"boundary polygons must meet at the corners: {a}[{-i}] is {_shown(ends[a][i])} and {b}[{-j}] is "
                f"{_shown(ends[b][j])}.{_advice(ends, near)}"
            )
    m, n = len(along_u[0]), len(along_w[0])
    s = np.linspace(0.0, 1.0, m) if tu is None else checks.increasing("tu", tu, m)
    t = np.linspace(0.0, 1.0, n) if tw is None else checks.increasing("tw", tw, n)
    s, t = s[:, None, None], t[None, :, None]
    (p00, p10), (p01, p11) = ends["c0"], ends["c1"]
    both = (1 - t) * along_u[0][:, None] + t * along_u[1][:, None] + (1 - s) * along_w[0][None] + s * along_w[1][None]
    return np.asarray(both - ((1 - s) * ((1 - t) * p00 + t * p01) + s * ((1 - t) * p10 + t * p11)))


def _polygons(name0: str, first: ArrayLike, name1: str, second: ArrayLike) -> tuple[Array, Array]:
    a, b = checks.points(name0, first), checks.points(name1, second)
    if len(a) != len(b):
        raise CornerError(
            f"{name0} and {name1} must have the same number of control points; got {len(a)} and {len(b)}. "
            "Raise the degree of the lower one, or insert knots, first."
        )
    return a, b
