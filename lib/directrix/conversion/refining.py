"""The same curve or surface with more to hold it by: a higher degree, more knots, more pieces; or with a knot less."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from directrix import checks
from directrix.basis import clamped, on_knots, raised
from directrix.checks import Array
from directrix.conversion.forms import to_bezier, to_bspline
from directrix.conversion.patches import spline_of, surface_from
from directrix.conversion.splines import curve_from, lifted_points
from directrix.conversion.strands import Strand, elevated
from directrix.curves.bezier import BezierCurve
from directrix.curves.bspline import BSplineCurve, NurbsCurve
from directrix.curves.curve import Curve
from directrix.errors import ConversionError, KnotError, OrderError
from directrix.knots import KnotVector
from directrix.solids.solid import Solid
from directrix.surfaces.bezier import BezierPatch
from directrix.surfaces.spline import BSplinePatch, NurbsPatch
from directrix.surfaces.surface import Surface

MOST = 32  # elevations at once: beyond this binomials and blossoms lose their digits

BEZIERS = BezierCurve | BezierPatch
SPLINES = BSplineCurve | BSplinePatch | NurbsCurve | NurbsPatch


def elevate(form: Any, u: int | None = None, w: int | None = None) -> Any:
    """The same Bezier, B-spline or NURBS form with its degree raised.

    Bezier points by Q_i = i/n P_(i-1) + (1 - i/n) P_i; splines by blossoms, each inner knot once more so that no continuity is
    gained that was not there (Farin, Curves and Surfaces for CAGD, 5th ed., "Degree Elevation").

    Parameters
    ----------
    form : BezierCurve, BezierPatch, BSplineCurve, BSplinePatch, NurbsCurve or NurbsPatch
        Other forms: convert them first (`to_bezier`, `to_bspline`, `to_nurbs`).
    u, w : int, 0 or more
        How often, in each parameter; once in every parameter if neither is given.

    Returns
    -------
    the same kind of form

    Raises
    ------
    ConversionError
        If the form has no control points.
    OrderError
        If u or w is no whole number, or w is given for a curve.

    Examples
    --------
    >>> elevate(BezierCurve([(0, 0, 0), (2, 4, 0), (4, 0, 0)])).control_points[1].round(12).tolist()
    [1.333333333333, 2.666666666667, 0.0]
    """
    if not isinstance(form, BEZIERS | SPLINES):
        raise ConversionError(
            f"elevate needs control points, which a {type(form).__name__} has not: use to_bezier, to_bspline or to_nurbs first."
        )
    curve = isinstance(form, Curve)
    if curve and w is not None:
        raise OrderError("a curve has one parameter: give u alone.")
    rest = 1 if u is None and w is None else 0
    times = [rest if n is None else checks.whole(name, n) for name, n in (("u", u), ("w", w))][: 1 if curve else 2]
    if max(times) > MOST:
        raise OrderError(f"a degree is raised at most {MOST} times at once; got {max(times)!r:.30}.")
    if isinstance(form, BezierCurve):
        return BezierCurve(elevated(form.control_points, times[0]))
    if isinstance(form, BezierPatch):
        net = elevated(form.control_net, times[0])
        return BezierPatch(elevated(net.swapaxes(0, 1), times[1]).swapaxes(0, 1))
    return _along_axes(form, [lambda points, knots, n=n: _raised(points, knots, n) for n in times])


def _raised(points: Array, knots: KnotVector, times: int) -> tuple[Array, Array, int]:
    values, order = knots.values, knots.order
    for _ in range(times):
        values, points = raised(values, order, points)
        order += 1
    return points, values, order


def insert_knot(form: Any, u: float | None = None, w: float | None = None, times: int = 1) -> Any:
    """The same curve or surface with a knot inserted: a control point more, and the same points everywhere.

    The new control points are blossoms of the old ones (Boehm's rule; Piegl & Tiller, The NURBS Book, 2nd ed., section 5.2).

    Parameters
    ----------
    form : a curve or surface that has a spline form
        A Bezier form becomes a B-spline; for other forms see `to_bspline` and `to_nurbs`.
    u, w : where, strictly between 0 and 1: parameters of the form, not knot values
    times : how often, 1 or more; a knot can occur at most order times

    Returns
    -------
    BSplineCurve, BSplinePatch, NurbsCurve or NurbsPatch

    Raises
    ------
    DomainError
        If u or w is not inside (0, 1).
    KnotError
        If the knot would occur more often than the order.
    ConversionError
        If the form has no spline form.

    Examples
    --------
    >>> insert_knot(BezierCurve([(0, 0, 0), (2, 4, 0), (4, 0, 0)]), 0.5).control_points.tolist()
    [[0.0, 0.0, 0.0], [1.0, 2.0, 0.0], [3.0, 2.0, 0.0], [4.0, 0.0, 0.0]]
    """
    spline = spline_of(form)
    times = checks.whole("times", times, least=1)
    places = _places(spline, u, w)
    return _along_axes(spline, [lambda points, knots, at=at: _inserted(points, knots, at, times) for at in places])


def _inserted(points: Array, knots: KnotVector, at: float | None, times: int) -> tuple[Array, Array, int]:
    if at is None:
        return points, knots.values, knots.order
    t = _nearby(knots, at)
    if knots.multiplicity(t) + times > knots.order:
        raise KnotError(
            f"a knot can occur at most order = {knots.order} times; at {at:g} it occurs {knots.multiplicity(t)} times, and "
            f"{times} more were asked for."
        )
    values = np.sort(np.concatenate([knots.values, [t] * times]))
    return on_knots(knots.values, knots.order, points, values), values, knots.order


def remove_knot(form: Any, u: float | None = None, w: float | None = None, times: int = 1, *, tolerance: float = 1e-9) -> Any:
    """The same curve or surface with a knot removed, if that leaves it where it is.

    The control points on the fewer knots are the least-squares solution of "inserting the knot again gives the old ones", which
    must hold to the tolerance (Piegl & Tiller, The NURBS Book, 2nd ed., section 5.4).

    Parameters
    ----------
    form : BSplineCurve, BSplinePatch, NurbsCurve or NurbsPatch
    u, w : the knot, as a parameter strictly between 0 and 1
    times : how often, 1 or more; copies beyond the order, which move nothing, go first
    tolerance : how far a (homogeneous) control point may be off, as a fraction of the size of them all

    Raises
    ------
    KnotError
        If there is no such knot, or removing it would change the form.

    Examples
    --------
    >>> arch = BezierCurve([(1, 1, 1), (2, 4, 1), (4, 1, 1)])
    >>> remove_knot(insert_knot(arch, 0.5), 0.5).control_points.round(12).tolist()
    [[1.0, 1.0, 1.0], [2.0, 4.0, 1.0], [4.0, 1.0, 1.0]]
    """
    spline = spline_of(form)
    times = checks.whole("times", times, least=1)
    places = _places(spline, u, w)
    rests = [times - _superfluous(given, at) for given, at in zip(_vectors(form), places, strict=True)]

    def fewer(points: Array, knots: KnotVector, axis: int) -> tuple[Array, Array, int]:
        return _removed(points, knots, places[axis], rests[axis], tolerance)

    return _along_axes(spline, [partial(fewer, axis=axis) for axis in range(len(places))])


def _superfluous(knots: KnotVector | None, at: float | None) -> int:
    """How many copies of a knot are more than the order: none of them changes anything."""
    return 0 if knots is None or at is None else max(knots.multiplicity(_nearby(knots, at)) - knots.order, 0)


def _vectors(form: Any) -> list[KnotVector | None]:
    """The knot vectors that a form was given, in the order of its parameters; None where it has none of its own."""
    if isinstance(form, BSplineCurve | NurbsCurve):
        return [form.knot_vector]
    if isinstance(form, BSplinePatch | NurbsPatch):
        return [form.knot_vector_u, form.knot_vector_w]
    return [None] if isinstance(form, Curve) else [None, None]


def _removed(points: Array, knots: KnotVector, at: float | None, times: int, tolerance: float) -> tuple[Array, Array, int]:
    if at is None or times <= 0:
        return points, knots.values, knots.order
    t = _nearby(knots, at)
    there = np.nonzero(knots.values == t)[0]
    if len(there) < times:
        raise KnotError(f"there is no knot to remove at {at:g}: it occurs {len(there)} times, and {times} were asked for.")
    fewer = np.delete(knots.values, there[:times])
    insertion = on_knots(fewer, knots.order, np.eye(len(fewer) - knots.order), knots.values)
    flat = points.reshape(len(points), -1)
    kept = np.linalg.lstsq(insertion, flat, rcond=None)[0]
    error = float(np.abs(insertion @ kept - flat).max() / max(np.ptp(flat, axis=0).max(), 1e-300))
    if error > tolerance:
        raise KnotError(
            f"the knot at {at:g} cannot be removed {times} times: the form would move by about {error:.3g} of its size, more "
            f"than the tolerance {tolerance:g}.",
            error=error,
        )
    return np.asarray(kept.reshape(-1, *points.shape[1:]), dtype=np.float64), fewer, knots.order


def split_bezier(form: Any, u: float | None = None, w: float | None = None) -> Any:
    """A form cut into Bezier forms: at a parameter, or, if none is given, at all its knots.

    With u (or w) a polynomial form of one piece is cut in two by de Casteljau's rule, whose first and last points of each round
    are the two nets (Farin, Curves and Surfaces for CAGD, 5th ed., on subdivision). Without, a B-spline is cut at its knots;
    constant pieces (order 1) become lines that stand still, since two points are the least that a Bezier form has.

    Parameters
    ----------
    form : a curve or surface that is polynomial between knots
    u, w : where to cut, strictly between 0 and 1; at most one of them

    Returns
    -------
    two Bezier forms; or a list of BezierCurve, or for a surface a list (along u) of lists (along w) of BezierPatch

    Raises
    ------
    ConversionError
        If the form is rational, or cut at a parameter and of more than one piece.
    OrderError
        If u and w are both given.

    Examples
    --------
    >>> left, right = split_bezier(BezierCurve([(0, 0, 0), (2, 4, 0), (4, 0, 0)]), 0.5)
    >>> left.control_points.tolist(), right.control_points.tolist()
    ([[0.0, 0.0, 0.0], [1.0, 2.0, 0.0], [2.0, 2.0, 0.0]], [[2.0, 2.0, 0.0], [3.0, 2.0, 0.0], [4.0, 0.0, 0.0]])
    """
    if u is not None and w is not None:
        raise OrderError("give u or w, not both: to cut both ways cut the parts again.")
    if isinstance(form, Solid):
        raise ConversionError("split_bezier cuts curves and surfaces; of a solid cut the faces, solid.faces().")
    if u is not None or w is not None:
        bezier = to_bezier(form)
        if isinstance(bezier, BezierCurve):
            if u is None:
                raise OrderError("a curve has one parameter: give u.")
            return bezier.split(u)
        return bezier.split(u=u, w=w)
    spline = to_bspline(form)
    if isinstance(spline, BSplineCurve):
        spline = elevate(spline, int(spline.order == 1))
        return [BezierCurve(points) for points in _cut(spline.control_points, spline.knot_vector)]
    spline = elevate(spline, int(spline.k == 1), int(spline.l == 1))
    rows = _cut(spline.control_net, spline.knot_vector_u)
    return [[BezierPatch(net.swapaxes(0, 1)) for net in _cut(row.swapaxes(0, 1), spline.knot_vector_w)] for row in rows]


def _cut(points: Array, knots: KnotVector) -> Array:
    """Bezier points (pieces, k, ...) between the knots."""
    values = clamped(knots.values, knots.order, knots.start, knots.end, knots.order)
    return on_knots(knots.values, knots.order, points, values).reshape(-1, knots.order, *points.shape[1:])


def _places(spline: Curve | Surface, u: float | None, w: float | None) -> list[float | None]:
    if u is None and w is None:
        raise OrderError("say where: give u, w or both.")
    if isinstance(spline, Curve):
        if w is not None:
            raise OrderError("a curve has one parameter: give u alone.")
        return [checks.inside("u", u)]
    return [None if at is None else checks.inside(name, at) for name, at in (("u", u), ("w", w))]


def _nearby(knots: KnotVector, at: float) -> float:
    """The knot parameter of u = at: an existing knot if it is that to rounding."""
    t = float(knots.stretch(np.array(at)))
    nearest = float(knots.values[np.abs(knots.values - t).argmin()])
    t = nearest if abs(nearest - t) <= 1e-12 * (knots.end - knots.start) else t
    if not knots.start < t < knots.end:
        raise KnotError(f"an inner knot is asked for; {at:g} is an end of the domain to rounding.")
    return t


def _along_axes(form: Any, changes: list[Any]) -> Any:
    """A spline with each axis of its (homogeneous) control points changed: (points, knots) -> (points, knots, order)."""
    spline = spline_of(form)
    points = lifted_points(spline)
    if isinstance(spline, BSplineCurve | NurbsCurve):
        return curve_from(Strand(*changes[0](points, spline.knot_vector)))
    net, knots_u, k = changes[0](points, spline.knot_vector_u)
    turned, knots_w, l = changes[1](net.swapaxes(0, 1), spline.knot_vector_w)  # noqa: E741
    return surface_from(turned.swapaxes(0, 1), Strand(net, knots_u, k), Strand(turned, knots_w, l))
