"""Every surface that has one, as the B-spline or NURBS that is exactly it: see `splines` for what that means.

Surfaces of curves are sums of products f(u) g(w) of splines of one parameter, over one denominator where curves are rational;
putting them on common knots gives the net, with Greville weights and products of denominators where they are due.
"""

from __future__ import annotations

import numpy as np

from directrix.basis import bernstein
from directrix.checks import Array
from directrix.conversion.splines import (
    HERMITE_TO_BEZIER,
    SplineSurface,
    pieces_of_turn,
    powers_to_bezier,
    spline_of,
    strand_of,
    turn_of,
)
from directrix.conversion.strands import Strand, bezier_strand, common, sum_of_products, times
from directrix.curves.curve import Curve
from directrix.curves.line import Line
from directrix.curves.rational import lift
from directrix.errors import ConversionError
from directrix.surfaces.algebraic import AlgebraicPatch
from directrix.surfaces.bezier import BezierPatch
from directrix.surfaces.boundary import Bilinear, Ruled
from directrix.surfaces.coons import Coons
from directrix.surfaces.extrusion import LinearSweep
from directrix.surfaces.hermite import HermitePatch
from directrix.surfaces.known import Cone, Cylinder, Sphere, Torus
from directrix.surfaces.plane import Plane, Triangle
from directrix.surfaces.point import PointPatch
from directrix.surfaces.revolution import CircularSweep
from directrix.surfaces.spline import BSplinePatch, NurbsPatch
from directrix.surfaces.surface import MovedSurface, SubPatch, Surface, Swapped
from directrix.surfaces.sweep import GenericSweep
from directrix.transform import Transform

__all__ = ["spline_of", "surface_from"]

FALLING, RISING = bezier_strand(np.array([[1.0], [0.0]])), bezier_strand(np.array([[0.0], [1.0]]))
F1, F2 = bezier_strand(np.array([[1.0], [1], [0], [0]])), bezier_strand(np.array([[0.0], [0], [1], [1]]))
ONE = bezier_strand(np.array([[1.0]]))


def surface_from(net: Array, along_u: Strand, along_w: Strand) -> SplineSurface:
    """A net (m, n, 3) or homogeneous (m, n, 4) on the knots of two strands as a surface."""
    orders, knots = (along_u.order, along_w.order), (along_u.knots, along_w.knots)
    if net.shape[2] == 3:
        return BSplinePatch(net, *orders, *knots)
    weights = net[..., 3]
    return NurbsPatch(net[..., :3] / weights[..., None], weights, *orders, *knots)


# Surfaces that are one polynomial


@spline_of.register
def _(patch: BezierPatch) -> BSplinePatch:
    m, n = patch.control_net.shape[:2]
    return BSplinePatch(patch.control_net, m, n)


@spline_of.register
def _(patch: HermitePatch) -> BSplinePatch:
    return BSplinePatch(np.einsum("ik,jl,klc->ijc", HERMITE_TO_BEZIER, HERMITE_TO_BEZIER, patch.G), 4, 4)


@spline_of.register
def _(patch: AlgebraicPatch) -> BSplinePatch:
    net = patch.a
    for axis in (0, 1):  # a constant becomes a line that stands still: a net has two points at least
        if net.shape[axis] == 1:
            net = np.concatenate([net, 0 * net], axis=axis)
    m, n = net.shape[:2]
    return BSplinePatch(np.einsum("ik,jl,klc->ijc", powers_to_bezier(m), powers_to_bezier(n), net), m, n)


@spline_of.register
def _(patch: PointPatch) -> BSplinePatch:
    m, n = patch.points.shape[:2]
    half = np.linalg.solve(bernstein(m - 1, patch.tu), patch.points.reshape(m, -1)).reshape(m, n, 3)
    net = np.linalg.solve(bernstein(n - 1, patch.tw), half.swapaxes(0, 1).reshape(n, -1)).reshape(n, m, 3)
    return BSplinePatch(net.swapaxes(0, 1), m, n)


@spline_of.register
def _(patch: Bilinear) -> BSplinePatch:
    return BSplinePatch(patch.corners, 2, 2)


@spline_of.register
def _(patch: Plane) -> BSplinePatch:
    return BSplinePatch([[patch.p1, patch.p3], [patch.p2, patch.p2 + patch.p3 - patch.p1]], 2, 2)


@spline_of.register
def _(patch: Triangle) -> BSplinePatch:
    return BSplinePatch([[patch.p1, patch.p3], [patch.p2, patch.p3]], 2, 2)


# Splines themselves, and surfaces of curves


@spline_of.register
def _(patch: BSplinePatch) -> BSplinePatch:
    if patch.knot_vector_u.clamped and patch.knot_vector_w.clamped:
        return patch
    return patch.patch(0.0, 1.0, 0.0, 1.0)


@spline_of.register
def _(patch: NurbsPatch) -> NurbsPatch:
    if patch.knot_vector_u.clamped and patch.knot_vector_w.clamped:
        return patch
    return patch.patch(0.0, 1.0, 0.0, 1.0)


def _split_weight(strand: Strand) -> tuple[Strand, Strand | None]:
    """Numerator (d = 3) and denominator (d = 1, None where it is the constant 1) of a curve's strand."""
    if strand.points.shape[1] == 3:
        return strand, None
    weights = strand.points[:, 3:]
    if np.ptp(weights) <= 1e-14 * weights.max():
        return strand._replace(points=strand.points[:, :3] / weights), None
    return strand._replace(points=strand.points[:, :3]), strand._replace(points=weights)


def _one_denominator(strands: list[Strand]) -> tuple[list[Strand], Strand | None]:
    """Numerators of several curves over one denominator: the one they share, or the product of all."""
    split = [_split_weight(strand) for strand in strands]
    different: list[Strand] = []
    owner: list[int | None] = []
    scales = []
    for _, weight in split:
        found, scale = None, 1.0
        if weight is not None:
            found, scale = _proportional(weight, different)
            if found is None:
                different.append(weight)
                found, scale = len(different) - 1, 1.0
        owner.append(found)
        scales.append(scale)
    numerators = []
    for (above, _), mine, scale in zip(split, owner, scales, strict=True):
        value = above._replace(points=above.points / scale)
        for i, weight in enumerate(different):
            value = value if i == mine else times(value, weight)
        numerators.append(value)
    total = None
    for weight in different:
        total = weight if total is None else times(total, weight)
    return numerators, total


def _proportional(weight: Strand, others: list[Strand]) -> tuple[int | None, float]:
    """Which of the others this weight function is a multiple of, and the factor."""
    for i, other in enumerate(others):
        a, b = (strand.points[:, 0] for strand in common([weight, other]))
        scale = float(a[0] / b[0])
        if np.abs(a - scale * b).max() <= 1e-13 * np.abs(a).max():
            return i, scale
    return None, 1.0


def _quotient(terms: list[tuple[Strand, Strand]], below_u: Strand | None, below_w: Strand | None) -> SplineSurface:
    """(Σ f(u) g(w)) / (W(u) V(w)) as a surface; the terms are vectors, None is the constant 1."""
    if below_u is None and below_w is None:
        return surface_from(*sum_of_products(terms))
    lifted = [(_padded(f, 3), g) if f.points.shape[1] == 3 else (f, _padded(g, 3)) for f, g in terms]
    lifted.append((_padded(below_u or ONE, 1), below_w or ONE))
    return surface_from(*sum_of_products(lifted))


def _padded(strand: Strand, dimension: int) -> Strand:
    """A vector strand made homogeneous with weight 0 (dimension 3), or a scalar one as the weight alone (dimension 1)."""
    sides = ((0, 0), (0, 1)) if dimension == 3 else ((0, 0), (3, 0))
    return strand._replace(points=np.pad(strand.points, sides))


@spline_of.register
def _(surface: Ruled) -> SplineSurface:
    _of_one_speed("ruled surface", surface.c0, surface.c1)
    (a, b), below = _one_denominator([strand_of(surface.c0), strand_of(surface.c1)])
    return _quotient([(a, FALLING), (b, RISING)], below, None)


@spline_of.register
def _(surface: LinearSweep) -> SplineSurface:
    (a,), below = _one_denominator([strand_of(surface.curve)])
    vector = bezier_strand(surface.vector[None])
    return _quotient([(a, ONE), (times(vector, below or ONE), RISING)], below, None)


@spline_of.register
def _(surface: Coons) -> SplineSurface:
    straight = Line((0, 0, 0), (1, 0, 0))  # the blending functions are of the parameter itself
    _of_one_speed("Coons patch", surface.c0, surface.c1, surface.d0, surface.d1, straight)
    (a, b), below_u = _one_denominator([strand_of(surface.c0), strand_of(surface.c1)])
    (c, d), below_w = _one_denominator([strand_of(surface.d0), strand_of(surface.d1)])
    f, g = (FALLING, RISING) if surface.blend == "linear" else (F1, F2)
    W, V, p = below_u or ONE, below_w or ONE, surface.corners
    terms = [(a, times(V, f)), (b, times(V, g)), (times(W, f), c), (times(W, g), d)]
    for i, blend_u in enumerate((f, g)):
        for j, blend_w in enumerate((f, g)):
            terms.append((times(times(W, blend_u), bezier_strand(-p[i, j][None])), times(V, blend_w)))
    return _quotient(terms, below_u, below_w)


@spline_of.register
def _(surface: GenericSweep) -> SplineSurface:
    if surface.frame != "fixed":
        raise ConversionError(
            f"a GenericSweep with a {surface.frame!r} frame has no exact spline form; a 'fixed' frame has. "
            "Interpolate its points with PointPatch instead."
        )
    if surface.taper != 1:
        _of_one_speed("tapered sweep", surface.directrix, Line((0, 0, 0), (1, 0, 0)))
    (section,), below_u = _one_denominator([strand_of(surface.generatrix)])
    (path,), below_w = _one_denominator([strand_of(surface.directrix)])
    W, V = below_u or ONE, below_w or ONE
    size = bezier_strand(np.array([[1.0], [surface.taper]]))
    anchor = bezier_strand(-surface.directrix(0.0)[None])
    return _quotient([(section, times(V, size)), (W, path), (times(W, anchor), times(V, size))], below_u, below_w)


# Turned surfaces: the same points, the parameter round the axis at another speed


@spline_of.register
def _(surface: CircularSweep) -> SplineSurface:
    """For each piece of at most a quarter turn three rows: the curve, where its tangents meet, and the curve turned on."""
    strand = strand_of(surface.curve)
    lifted = strand.points if strand.points.shape[1] == 4 else lift(strand.points, np.ones(len(strand.points)))
    if surface.angle == 0:
        raise ConversionError("a CircularSweep by the angle 0 is a curve, and no patch.")
    count, cosine = pieces_of_turn(surface.angle)
    step = surface.angle / count
    rows = [_turning(surface, (i + 0.5 * half) * step, 1.0 if half == 0 else cosine) for i in range(count) for half in (0, 1)]
    rows.append(_turning(surface, surface.angle, 1.0))
    net = np.stack([lifted @ row.T for row in rows], axis=1)
    places = np.linspace(0.0, 1.0, count + 1)
    knots = np.concatenate([[0.0] * 3, np.repeat(places[1:-1], 2), [1.0] * 3])
    return surface_from(net, strand, Strand(net[0], knots, 3))


def _turning(sweep: CircularSweep, angle: float, cosine: float) -> Array:
    """The 4x4 matrix of homogeneous points that turns by an angle, and carries a point 1/cosine away from the axis.

    What is off the axis is divided by the cosine and the whole multiplied by it, the weight of the row.
    """
    away = Transform.scale((1 / cosine, 1 / cosine, 1.0)) @ Transform.rotate("z", angle)
    return np.asarray(cosine * (sweep.placement @ away @ sweep.placement.inverse()).matrix)


@spline_of.register(Cylinder)
@spline_of.register(Cone)
def _(surface: Cylinder | Cone) -> SplineSurface:
    return spline_of(surface.swept()).swap()


@spline_of.register(Sphere)
@spline_of.register(Torus)
def _(surface: Sphere | Torus) -> SplineSurface:
    return spline_of(surface.swept())


# Surfaces made from other surfaces


@spline_of.register
def _(surface: MovedSurface) -> SplineSurface:
    return spline_of(surface.surface).moved(surface.transform)


@spline_of.register
def _(surface: Swapped) -> SplineSurface:
    return spline_of(surface.surface).swap()


@spline_of.register
def _(part: SubPatch) -> SplineSurface:
    """A part of a turned surface is turned by part of the angle; of any other, the part of its spline."""
    whole, bounds = part.surface, (part.u0, part.u1, part.w0, part.w1)
    if isinstance(whole, MovedSurface):
        return spline_of(whole.surface.patch(*bounds)).moved(whole.transform)
    if isinstance(whole, Swapped):
        return spline_of(whole.surface.patch(*bounds[2:], *bounds[:2])).swap()
    if isinstance(whole, Cylinder | Cone):
        return spline_of(whole.swept().patch(*bounds[2:], *bounds[:2])).swap()
    if isinstance(whole, Sphere | Torus):
        return spline_of(whole.swept().patch(*bounds))
    if isinstance(whole, CircularSweep):
        k, angle = whole.direction, whole.angle
        start = Transform.rotate(k, angle * part.w0, whole.point)
        curve = whole.curve.segment(part.u0, part.u1).moved(start)
        return spline_of(CircularSweep.about(curve, whole.point, k, angle * (part.w1 - part.w0)))
    return _part_of_curves(part)


def _part_of_curves(part: SubPatch) -> SplineSurface:
    """A part of a surface of curves: the curves are cut, since arcs in them run at another speed than their splines."""
    whole, u0, u1, w0, w1 = part.surface, part.u0, part.u1, part.w0, part.w1
    match whole:
        case LinearSweep():
            cut: Surface = LinearSweep.between(whole.curve.segment(u0, u1), (0, 0, 0), whole.vector)
        case Ruled():
            cut = Ruled(whole.c0.segment(u0, u1), whole.c1.segment(u0, u1))
        case GenericSweep(directrix=path, taper=1.0) if turn_of(path) is not None:
            shift = Transform.translate(path(w0) - path(0.0))
            carried = whole.generatrix.segment(u0, u1).moved(shift)
            return spline_of(GenericSweep(carried, path.segment(w0, w1), whole.frame))
        case GenericSweep():
            cut = GenericSweep(whole.generatrix.segment(u0, u1), whole.directrix, whole.frame, taper=whole.taper)
        case _:
            return spline_of(whole).patch(u0, u1, w0, w1)
    return spline_of(cut).patch(0.0, 1.0, w0, w1)


def _of_one_speed(form: str, *curves: Curve) -> None:
    """Refuse arcs beside curves that do not run as they do: their spline has another speed, and another surface comes of it."""
    turns = [turn_of(curve) for curve in curves]
    if any(turn is not None for turn in turns) and len({turn and round(turn, 12) for turn in turns}) > 1:
        raise ConversionError(
            f"a {form} that joins an arc at constant speed to other curves point by point has no exact spline form: a rational "
            "arc runs at another speed. Put to_nurbs(arc) in place of the arc; that is another surface, and it has one."
        )
