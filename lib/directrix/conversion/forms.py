"""The conversions by name: exact where mathematics allows, a clear error where it does not."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from directrix import checks
from directrix.basis import bernstein
from directrix.checks import Array
from directrix.conversion.patches import spline_of
from directrix.conversion.splines import (
    BEZIER_TO_HERMITE,
    HERMITE_TO_BEZIER,
    HERMITE_TO_POWERS,
    bezier_to_powers,
)
from directrix.conversion.strands import elevated
from directrix.curves.bezier import BezierCurve
from directrix.curves.bspline import BSplineCurve, NurbsCurve
from directrix.curves.curve import Curve
from directrix.curves.hermite import HermiteCurve
from directrix.curves.point import PointCurve, parameter_values
from directrix.errors import ConversionError
from directrix.knots import KnotVector
from directrix.solids.polynomial import BezierHyperpatch, HermiteHyperpatch
from directrix.solids.solid import Solid
from directrix.solids.spline import BSplineHyperpatch, NurbsHyperpatch
from directrix.surfaces.algebraic import AlgebraicPatch
from directrix.surfaces.bezier import BezierPatch
from directrix.surfaces.hermite import HermitePatch
from directrix.surfaces.point import PointPatch
from directrix.surfaces.spline import BSplinePatch, NurbsPatch, spline_part

Form = Any  # a curve, a surface or a solid


def to_bspline(form: Form) -> Form:
    """The B-spline that is exactly this form, parameter for parameter.

    Every polynomial or piecewise polynomial form has one: all patches but NURBS, and linear, ruled, Coons and translational
    surfaces of polynomial curves. The Coons net is blended at Greville abscissae, which comes of itself when the blending
    functions are written on the curves' knots (Farin, Curves and Surfaces for CAGD, 5th ed., on Coons patches).

    Parameters
    ----------
    form : a curve, surface or solid of the library

    Returns
    -------
    BSplineCurve, BSplinePatch or BSplineHyperpatch, with clamped knots

    Raises
    ------
    ConversionError
        If the form is rational (use `to_nurbs`) or no spline at all.

    Examples
    --------
    >>> from directrix.curves.line import Line
    >>> to_bspline(Line((0, 0, 0), (4, 0, 0))).control_points.tolist()
    [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0]]
    """
    spline = _solid_spline(form) if isinstance(form, Solid) else spline_of(form)
    if not isinstance(spline, NurbsCurve | NurbsPatch | NurbsHyperpatch):
        return spline
    if np.ptp(spline.weights) > 1e-14 * spline.weights.max():
        raise ConversionError(
            f"a {type(form).__name__} is rational, its weights differ from {spline.weights.min():.6g} to "
            f"{spline.weights.max():.6g}: a B-spline cannot hold it exactly. Use to_nurbs."
        )
    if isinstance(spline, NurbsCurve):
        return BSplineCurve(spline.control_points, spline.order, spline.knots)
    if isinstance(spline, NurbsPatch):
        return BSplinePatch(spline.control_net, spline.k, spline.l, spline.knots_u, spline.knots_w)
    return BSplineHyperpatch(spline.control_net, *spline.orders, *_given_knots(spline.knot_vectors))


def to_nurbs(form: Form) -> Form:
    """The NURBS that is exactly this form: polynomial ones with weights 1, conics, arcs and turned surfaces with their own.

    Parameters are kept but for arcs at constant speed, which no rational form has: there the points, edges and direction
    are the same, and the parameters agree at the ends and middles of the arc's pieces (of at most a quarter turn). A form that
    joins such arcs to other curves point by point (a Coons patch with an arc) would become another surface, and is refused.
    (Piegl & Tiller, The NURBS Book, 2nd ed., chapter 8, with exact weights also for Coons and ruled surfaces of rational
    curves of different weights, which get the product of the denominators.)

    Parameters
    ----------
    form : a curve, surface or solid of the library

    Returns
    -------
    NurbsCurve, NurbsPatch or NurbsHyperpatch, with clamped knots

    Raises
    ------
    ConversionError
        If the form has no exact spline form: plain functions, moving frames, arcs as above.

    Examples
    --------
    >>> from directrix.surfaces.known import Cylinder
    >>> quarter = to_nurbs(Cylinder(2, 5).patch(0, 0.25, 0, 1))
    >>> quarter.control_net[:, 1].round(12).tolist()
    [[2.0, 0.0, 5.0], [2.0, 2.0, 5.0], [0.0, 2.0, 5.0]]
    >>> bool(quarter.weights[1, 0] == np.cos(np.pi / 4))
    True
    """
    spline = _solid_spline(form) if isinstance(form, Solid) else spline_of(form)
    if isinstance(spline, BSplineCurve):
        return NurbsCurve(spline.control_points, np.ones(len(spline.control_points)), spline.order, spline.knots)
    if isinstance(spline, BSplinePatch):
        weights = np.ones(spline.control_net.shape[:2])
        return NurbsPatch(spline.control_net, weights, spline.k, spline.l, spline.knots_u, spline.knots_w)
    if isinstance(spline, BSplineHyperpatch):
        weights = np.ones(spline.control_net.shape[:3])
        return NurbsHyperpatch(spline.control_net, weights, *spline.orders, *_given_knots(spline.knot_vectors))
    return spline


def to_bezier(form: Form) -> Form:
    """The Bezier form of a polynomial form of one piece.

    From Hermite data: end points stay, inner points are p ± p'/3 and, with a twist, p ± pu/3 ± pw/3 ± puw/9 (Mortenson,
    Geometric Modeling, 3rd ed., on Bezier surfaces). From powers: P_j = Σ C(j, i)/C(n, i) a_i. From points: the system
    Σ B_j(t_i) P_j = Q_i is solved.

    Parameters
    ----------
    form : a curve, surface or solid of the library

    Returns
    -------
    BezierCurve, BezierPatch or BezierHyperpatch

    Raises
    ------
    ConversionError
        If the form is rational or has inner knots: `split_bezier` gives the pieces of a B-spline.

    Examples
    --------
    >>> from directrix.curves.hermite import HermiteCurve
    >>> to_bezier(HermiteCurve((0, 0, 0), (3, 0, 0), (3, 3, 0), (3, -3, 0))).control_points.tolist()
    [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [3.0, 0.0, 0.0]]
    """
    if isinstance(form, BezierCurve | BezierPatch | BezierHyperpatch):
        return form
    spline = to_bspline(form)
    if isinstance(spline, BSplineCurve):
        _one_piece(form, [spline.knot_vector])
        return BezierCurve(spline.control_points)
    if isinstance(spline, BSplinePatch):
        _one_piece(form, [spline.knot_vector_u, spline.knot_vector_w])
        return BezierPatch(spline.control_net)
    _one_piece(form, spline.knot_vectors)
    return BezierHyperpatch(spline.control_net)


def to_hermite(form: Form) -> Form:
    """The Hermite form of a polynomial form of one piece, of degree at most 3 in each parameter.

    Tangents are 3 (P1 - P0), twists 9 (P00 - P01 - P10 + P11) with the signs of the corner; lower degrees are raised first
    (Mortenson, Geometric Modeling, 3rd ed., on Hermite surfaces).

    Parameters
    ----------
    form : a curve, surface or solid of the library

    Returns
    -------
    HermiteCurve, HermitePatch or HermiteHyperpatch

    Raises
    ------
    ConversionError
        If a degree is above 3, or the form is rational or has inner knots.

    Examples
    --------
    >>> to_hermite(BezierPatch([[(0, 0, 0), (0, 1, 0)], [(1, 0, 0), (1, 1, 1)]])).twists[1, 1]
    array([0., 0., 1.])
    """
    if isinstance(form, HermiteCurve | HermitePatch | HermiteHyperpatch):
        return form
    bezier = to_bezier(form)
    if isinstance(bezier, BezierCurve):
        points = _cubic(form, bezier.control_points, 1)
        return HermiteCurve(*(BEZIER_TO_HERMITE @ points))
    net = _cubic(form, bezier.control_net, 2 if isinstance(bezier, BezierPatch) else 3)
    if isinstance(bezier, BezierPatch):
        return HermitePatch(np.einsum("ik,jl,klc->ijc", BEZIER_TO_HERMITE, BEZIER_TO_HERMITE, net))
    return HermiteHyperpatch(np.einsum("ia,jb,kc,abcd->ijkd", *[BEZIER_TO_HERMITE] * 3, net))


def to_algebraic(form: Form) -> AlgebraicPatch:
    """The algebraic form of a polynomial patch of one piece: coefficients of ascending powers.

    From Hermite data A = M_F G M_Fᵀ, whose rows and columns descend, reversed (Mortenson, Geometric Modeling, 3rd ed., on
    Hermite surfaces); from Bezier points a_i = Σ (-1)^(i-j) C(n, i) C(i, j) P_j.

    Parameters
    ----------
    form : a surface of the library

    Returns
    -------
    AlgebraicPatch

    Raises
    ------
    ConversionError
        If the form is no surface, or is rational or has inner knots.

    Examples
    --------
    >>> to_algebraic(BezierPatch([[(0, 0, 0), (0, 1, 0)], [(1, 0, 0), (1, 1, 1)]])).a[1, 1]
    array([0., 0., 1.])
    """
    if isinstance(form, AlgebraicPatch):
        return form
    if isinstance(form, Curve | Solid):
        raise ConversionError(f"to_algebraic is for surfaces: AlgebraicPatch has no brother for a {type(form).__name__}.")
    if isinstance(form, HermitePatch):
        return AlgebraicPatch(np.einsum("ik,jl,klc->ijc", HERMITE_TO_POWERS, HERMITE_TO_POWERS, form.G))
    net = to_bezier(form).control_net
    m, n = net.shape[:2]
    return AlgebraicPatch(np.einsum("ik,jl,klc->ijc", bezier_to_powers(m), bezier_to_powers(n), net))


def to_points(form: Form, tu: ArrayLike | None = None, tw: ArrayLike | None = None) -> PointCurve | PointPatch:
    """The point form of a polynomial form of one piece: as many points on it as its degrees ask, at chosen parameters.

    A bicubic gives the sixteen-point form (Mortenson, Geometric Modeling).

    Parameters
    ----------
    form : a curve or surface of the library
    tu, tw : increasing from 0 to 1, degree + 1 of them; equally spaced if not given (a bicubic's sixteen points)

    Returns
    -------
    PointCurve or PointPatch

    Raises
    ------
    ConversionError
        If the form is a solid, rational or has inner knots.
    ShapeError, NumberError
        If the parameters do not fit the degree.

    Examples
    --------
    >>> to_points(BezierCurve([(0, 0, 0), (1, 2, 0), (2, 0, 0)])).control_points.tolist()
    [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 0.0, 0.0]]
    """
    if isinstance(form, Solid):
        raise ConversionError("to_points is for curves and surfaces: there is no point form of a solid. Use to_bezier.")
    bezier = to_bezier(form)
    if isinstance(bezier, BezierCurve):
        at = parameter_values("tu", tu, bezier.control_points)
        return PointCurve(bernstein(bezier.degree, at) @ bezier.control_points, at)
    m, n = bezier.control_net.shape[:2]
    us = np.linspace(0.0, 1.0, m) if tu is None else checks.increasing("tu", tu, m)
    ws = np.linspace(0.0, 1.0, n) if tw is None else checks.increasing("tw", tw, n)
    return PointPatch(bezier(us[:, None], ws[None, :]), us, ws)


def _one_piece(form: Form, vectors: Any) -> None:
    pieces = [len(vector.breaks()) - 1 for vector in vectors]
    if max(pieces) > 1:
        counted = " x ".join(map(str, pieces))
        raise ConversionError(
            f"a {type(form).__name__} of {counted} polynomial pieces is no single Bezier form; split_bezier(form) gives its "
            "pieces."
        )


def _cubic(form: Form, points: Array, axes: int) -> Array:
    """Bezier points with degree 3 along the first axes."""
    for axis in range(axes):
        degree = points.shape[axis] - 1
        if degree > 3:
            raise ConversionError(
                f"a {type(form).__name__} of degree {degree} has no cubic Hermite form, which holds degrees up to 3 only."
            )
        points = np.moveaxis(elevated(np.moveaxis(points, axis, 0), 3 - degree), 0, axis)
    return points


def _solid_spline(solid: Solid) -> BSplineHyperpatch | NurbsHyperpatch:
    if isinstance(solid, HermiteHyperpatch):
        net = np.einsum("ia,jb,kc,abcd->ijkd", *[HERMITE_TO_BEZIER] * 3, solid.G)
        return BSplineHyperpatch(net, 4, 4, 4)
    if isinstance(solid, BezierHyperpatch):
        return BSplineHyperpatch(solid.control_net, *solid.control_net.shape[:3])
    if isinstance(solid, BSplineHyperpatch | NurbsHyperpatch):
        return _clamped_solid(solid)
    raise ConversionError(f"a {type(solid).__name__} has no exact spline form: it is none of the library's hyperpatches.")


def _clamped_solid(solid: BSplineHyperpatch | NurbsHyperpatch) -> BSplineHyperpatch | NurbsHyperpatch:
    """The same solid on clamped knots, axis by axis."""
    if all(knots.clamped for knots in solid.knot_vectors):
        return solid
    net, vectors = solid._blended, []
    for axis, knots in enumerate(solid.knot_vectors):
        part, clamped = spline_part(knots, np.moveaxis(net, axis, 0), 0.0, 1.0)
        net = np.moveaxis(part, 0, axis)
        vectors.append(clamped.values)
    if isinstance(solid, BSplineHyperpatch):
        return BSplineHyperpatch(net, *solid.orders, *vectors)
    return NurbsHyperpatch(net[..., :3] / net[..., 3:], net[..., 3], *solid.orders, *vectors)


def _given_knots(vectors: tuple[KnotVector, ...]) -> list[Any]:
    return [vector.values for vector in vectors]
