"""Every form that has one, as the B-spline or NURBS that is exactly it: the dispatch, and all curves.

`spline_of` is the centre of all conversions: it returns a `BSplineCurve` or `BSplinePatch` where the form is polynomial between
knots, a `NurbsCurve` or `NurbsPatch` where it is rational, with clamped knots. Parameters are kept, point for point, with one
exception that mathematics forces: arcs at constant speed have no rational form. Their NURBS has the same points, edges and
direction, and the parameter agrees at the ends of its pieces of at most a quarter turn and in their middles. The surfaces are
in `patches`.
"""

from __future__ import annotations

from functools import singledispatch
from math import ceil, comb, pi
from typing import Any

import numpy as np

from directrix.basis import HERMITE, bernstein
from directrix.checks import Array
from directrix.conversion.strands import Strand, joined, on_unit
from directrix.curves.arc import Arc
from directrix.curves.bezier import BezierCurve
from directrix.curves.bspline import BSplineCurve, NurbsCurve
from directrix.curves.conic import Conic
from directrix.curves.curve import Curve, MovedCurve, Segment
from directrix.curves.hermite import HermiteCurve
from directrix.curves.line import Line
from directrix.curves.point import PointCurve
from directrix.curves.rational import lift
from directrix.errors import ConversionError
from directrix.knots import KnotVector
from directrix.surfaces.spline import BSplinePatch, NurbsPatch, spline_part

SplineCurve = BSplineCurve | NurbsCurve
SplineSurface = BSplinePatch | NurbsPatch

HERMITE_TO_BEZIER = np.array([[1, 0, 0, 0], [1, 0, 1 / 3, 0], [0, 1, 0, -1 / 3], [0, 1, 0, 0]])
BEZIER_TO_HERMITE = np.array([[1.0, 0, 0, 0], [0, 0, 0, 1], [-3, 3, 0, 0], [0, 0, -3, 3]])
HERMITE_TO_POWERS = HERMITE[::-1]


def powers_to_bezier(count: int) -> Array:
    """M with Bezier points P = M a for coefficients a of ascending powers: P_j = Σ_i C(j, i) / C(n, i) a_i, n = count - 1."""
    return np.array([[comb(j, i) / comb(count - 1, i) for i in range(count)] for j in range(count)])


def bezier_to_powers(count: int) -> Array:
    """The inverse of `powers_to_bezier`: a_i = Σ_j (-1)^(i-j) C(n, i) C(i, j) P_j."""
    n = count - 1
    return np.array([[(-1.0) ** (i - j) * comb(n, i) * comb(i, j) for j in range(count)] for i in range(count)])


@singledispatch
def spline_of(form: Any) -> Any:
    """The spline that is exactly this form: see the head of this file.

    Raises
    ------
    ConversionError
        If the form has none: it is built on a plain function, or turns with a moving frame.
    """
    raise ConversionError(
        f"a {type(form).__name__} has no exact spline form. Interpolate points of it instead: "
        "PointPatch or PointCurve through values at parameters of your choice, and look at the difference."
    )


def strand_of(curve: Curve) -> Strand:
    """A curve's spline on [0, 1] as a strand of dimension 3, or 4 (homogeneous) where it is rational."""
    spline = spline_of(curve)
    points = spline.knot_vector.extended(lifted_points(spline))
    return on_unit(points, spline.knots, spline.order)


def lifted_points(spline: SplineCurve | SplineSurface) -> Array:
    """Control points as the basis functions blend them: Cartesian, or homogeneous where the spline is rational."""
    points = spline.control_points if isinstance(spline, BSplineCurve | NurbsCurve) else spline.control_net
    return lift(points, spline.weights) if isinstance(spline, NurbsCurve | NurbsPatch) else points


def curve_from(strand: Strand) -> SplineCurve:
    """A strand of dimension 3 or 4 as a curve."""
    if strand.points.shape[1] == 3:
        return BSplineCurve(strand.points, strand.order, strand.knots)
    weights = strand.points[:, 3]
    return NurbsCurve(strand.points[:, :3] / weights[:, None], weights, strand.order, strand.knots)


# Curves


@spline_of.register
def _(curve: BSplineCurve) -> BSplineCurve:
    return curve if curve.knot_vector.clamped else BSplineCurve(*_clean(curve.control_points, curve.knot_vector))


@spline_of.register
def _(curve: NurbsCurve) -> NurbsCurve:
    if curve.knot_vector.clamped:
        return curve
    points, order, knots = _clean(lifted_points(curve), curve.knot_vector)
    return NurbsCurve(points[:, :3] / points[:, 3:], points[:, 3], order, knots)


def _clean(points: Array, knots: KnotVector) -> tuple[Array, int, Array]:
    strand = on_unit(knots.extended(points), knots.values, knots.order)
    return strand.points, strand.order, knots.start + (knots.end - knots.start) * strand.knots


@spline_of.register
def _(curve: BezierCurve) -> BSplineCurve:
    return BSplineCurve(curve.control_points, curve.degree + 1)


@spline_of.register
def _(curve: Line) -> BSplineCurve:
    return BSplineCurve([curve.start, curve.end], 2)


@spline_of.register
def _(curve: HermiteCurve) -> BSplineCurve:
    return BSplineCurve(HERMITE_TO_BEZIER @ np.stack([curve.p0, curve.p1, curve.t0, curve.t1]), 4)


@spline_of.register
def _(curve: PointCurve) -> BSplineCurve:
    rows = bernstein(curve.degree, curve.parameters)
    return BSplineCurve(np.linalg.solve(rows, curve.control_points), curve.degree + 1)


@spline_of.register
def _(curve: Conic) -> NurbsCurve:
    return NurbsCurve(curve.control_points, curve.weights, 3)


@spline_of.register
def _(arc: Arc) -> SplineCurve:
    """Quadratic pieces of at most a quarter turn: ends on the arc, middle points where the end tangents meet."""
    count, cosine = pieces_of_turn(arc.end - arc.start)
    ends = arc(np.linspace(0.0, 1.0, count + 1))
    middles = arc((np.arange(count) + 0.5) / count)
    middles = arc.center + (middles - arc.center) / cosine
    one, less = np.ones(count), np.full(count, cosine)
    pieces = np.stack([lift(ends[:-1], one), lift(middles, less), lift(ends[1:], one)], axis=1)
    return curve_from(joined(pieces, np.linspace(0.0, 1.0, count + 1)))


def pieces_of_turn(angle: float) -> tuple[int, float]:
    """Number of pieces of at most a quarter turn, and the cosine of half of one."""
    count = max(1, ceil(abs(angle) / (pi / 2) - 1e-9))
    return count, float(np.cos(angle / count / 2))


@spline_of.register
def _(curve: MovedCurve) -> SplineCurve:
    return spline_of(curve.curve).moved(curve.transform)


@spline_of.register
def _(curve: Segment) -> SplineCurve:
    whole, u0, u1 = curve.curve, curve.u0, curve.u1
    if isinstance(whole, MovedCurve):
        return spline_of(whole.curve.segment(u0, u1)).moved(whole.transform)
    if isinstance(whole, Arc):
        start, end = ((1 - u) * whole.start + u * whole.end for u in (u0, u1))
        return spline_of(Arc(whole.center, whole.radius, start, end, whole.normal))
    strand = strand_of(whole)
    part, knots = spline_part(KnotVector(strand.knots, strand.order), strand.points, u0, u1)
    return curve_from(on_unit(part, knots.values, strand.order))


def turn_of(curve: Curve) -> float | None:
    """The angle of an arc at constant speed, moved or cut; None for any other curve."""
    match curve:
        case Arc():
            return abs(curve.end - curve.start)
        case MovedCurve():
            return turn_of(curve.curve)
        case Segment():
            angle = turn_of(curve.curve)
            return None if angle is None else angle * abs(curve.u1 - curve.u0)
    return None
