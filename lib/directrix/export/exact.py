"""JSON without loss: every form of the library as text and back, equal to the last bit.

A form is written as its class and what it holds; Python writes floats with as many digits as it takes to read the same float
again. What is read goes through the form's own checks, so a file cannot make a form that the library would refuse.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import numpy as np

from directrix.curves.arc import Arc, Circle
from directrix.curves.bezier import BezierCurve
from directrix.curves.bspline import BSplineCurve, NurbsCurve
from directrix.curves.conic import Conic
from directrix.curves.curve import MovedCurve, Segment
from directrix.curves.hermite import HermiteCurve
from directrix.curves.line import Line
from directrix.curves.point import PointCurve
from directrix.errors import ConversionError, GeometryError
from directrix.frozen import Frozen
from directrix.knots import KnotVector, knot_vector
from directrix.quadric import Quadric
from directrix.solids.polynomial import BezierHyperpatch, HermiteHyperpatch
from directrix.solids.spline import BSplineHyperpatch, NurbsHyperpatch
from directrix.surfaces.algebraic import AlgebraicPatch
from directrix.surfaces.bezier import BezierPatch
from directrix.surfaces.boundary import Bilinear, Ruled
from directrix.surfaces.coons import Coons
from directrix.surfaces.extrusion import LinearSweep
from directrix.surfaces.hermite import Ferguson, HermitePatch
from directrix.surfaces.known import Cone, Cylinder, Sphere, Torus
from directrix.surfaces.plane import Plane, Triangle
from directrix.surfaces.point import PointPatch
from directrix.surfaces.revolution import CircularSweep
from directrix.surfaces.spline import BSplinePatch, NurbsPatch
from directrix.surfaces.surface import MovedSurface, SubPatch, Swapped
from directrix.surfaces.sweep import GenericSweep
from directrix.transform import Transform

FORMAT = "directrix 1"


def _knots(*vectors: KnotVector) -> list[Any]:
    return ["periodic" if vector.wrap else vector.values for vector in vectors]


# How to make each form again from what it holds; whatever its constructor checks is checked when a file is read.
REMADE: dict[type[Frozen], Callable[[Any], Any]] = {
    Line: lambda f: Line(f.start, f.end),
    Arc: lambda f: Arc(f.center, f.radius, f.start, f.end, f.normal),
    Circle: lambda f: Circle(f.center, f.radius, f.normal),
    Conic: lambda f: Conic(f.p0, f.p1, f.p2, f.weight),
    HermiteCurve: lambda f: HermiteCurve(f.p0, f.p1, f.t0, f.t1),
    PointCurve: lambda f: PointCurve(f.control_points, f.parameters),
    BezierCurve: lambda f: BezierCurve(f.control_points),
    BSplineCurve: lambda f: BSplineCurve(f.control_points, f.order, *_knots(f.knot_vector)),
    NurbsCurve: lambda f: NurbsCurve(f.control_points, f.weights, f.order, *_knots(f.knot_vector)),
    MovedCurve: lambda f: MovedCurve(f.curve, f.transform),
    Segment: lambda f: Segment(f.curve, f.u0, f.u1),
    Plane: lambda f: Plane(f.p1, f.p2, f.p3),
    Triangle: lambda f: Triangle(f.p1, f.p2, f.p3),
    Cylinder: lambda f: Cylinder(f.radius, f.height),
    Cone: lambda f: Cone(f.r1, f.r2, f.height),
    Sphere: lambda f: Sphere(f.radius),
    Torus: lambda f: Torus(f.R, f.r),
    LinearSweep: lambda f: LinearSweep(f.curve, f.direction, f.distance),
    CircularSweep: lambda f: CircularSweep.about(f.curve, f.point, f.direction, f.angle),
    GenericSweep: lambda f: GenericSweep(f.generatrix, f.directrix, f.frame, taper=f.taper),
    AlgebraicPatch: lambda f: AlgebraicPatch(f.a),
    HermitePatch: lambda f: HermitePatch(f.G),
    Ferguson: lambda f: Ferguson(f.corners, f.tangents_u, f.tangents_w),
    PointPatch: lambda f: PointPatch(f.points, f.tu, f.tw),
    BezierPatch: lambda f: BezierPatch(f.control_net),
    BSplinePatch: lambda f: BSplinePatch(f.control_net, f.k, f.l, *_knots(f.knot_vector_u, f.knot_vector_w)),
    NurbsPatch: lambda f: NurbsPatch(f.control_net, f.weights, f.k, f.l, *_knots(f.knot_vector_u, f.knot_vector_w)),
    Bilinear: lambda f: Bilinear(f.p00, f.p01, f.p10, f.p11),
    Ruled: lambda f: Ruled(f.c0, f.c1),
    Coons: lambda f: Coons(f.c0, f.c1, f.d0, f.d1, f.blend),
    MovedSurface: lambda f: MovedSurface(f.surface, f.transform),
    SubPatch: lambda f: SubPatch(f.surface, f.u0, f.u1, f.w0, f.w1),
    Swapped: lambda f: Swapped(f.surface),
    HermiteHyperpatch: lambda f: HermiteHyperpatch(f.G),
    BezierHyperpatch: lambda f: BezierHyperpatch(f.control_net),
    BSplineHyperpatch: lambda f: BSplineHyperpatch(f.control_net, *f.orders, *_knots(*f.knot_vectors)),
    NurbsHyperpatch: lambda f: NurbsHyperpatch(f.control_net, f.weights, *f.orders, *_knots(*f.knot_vectors)),
    Quadric: lambda f: Quadric(*f.coefficients, tolerance=f.tolerance, size=f.size),
    Transform: lambda f: Transform(f.matrix),
    KnotVector: lambda f: knot_vector("knots", "periodic" if f.wrap else f.values, f.count - f.wrap, f.order),
}
NAMES = {kind.__name__: kind for kind in REMADE}


def dumps(*forms: Any) -> str:
    """Forms as one JSON text, which `loads` reads back equal to the last bit.

    Parameters
    ----------
    forms : curves, surfaces, solids, quadrics, transforms of the library

    Raises
    ------
    ConversionError
        If a form holds a plain function: that is code, and no data.

    Examples
    --------
    >>> text = dumps(Sphere(0.1))
    >>> text
    '{"format": "directrix 1", "forms": [{"form": "Sphere", "radius": 0.1}]}'
    >>> loads(text) == [Sphere(0.1)]
    True
    """
    return json.dumps({"format": FORMAT, "forms": [_one_of_ours(form) for form in forms]}, allow_nan=False)


def loads(text: str) -> list[Any]:
    """The forms of a JSON text written by `dumps`, checked as if they were made anew.

    Raises
    ------
    GeometryError
        If the text is no such JSON, or a form in it is one that the library refuses.
    """
    if not isinstance(text, str):
        raise GeometryError(f"loads reads the text of a file, a str; got {type(text).__name__}. For a file: read(path).")
    try:
        given = json.loads(text)
    except json.JSONDecodeError as error:
        raise GeometryError(f"this is no JSON: {error}.") from None
    if not isinstance(given, dict) or given.get("format") != FORMAT or not isinstance(given.get("forms"), list):
        raise GeometryError(f'a file of forms begins with "format": "{FORMAT}" and has a list "forms".')
    return [_read(part) for part in given["forms"]]


def _written(value: Any) -> Any:
    if isinstance(value, Frozen):
        if type(value) not in REMADE:
            raise ConversionError(f"a {type(value).__name__} holds a function, which is code: only data are written to JSON.")
        return {"form": type(value).__name__, **{name: _written(getattr(value, name)) for name in value._names}}
    if isinstance(value, np.ndarray):
        return {"array": value.tolist()}
    if isinstance(value, tuple):
        return {"tuple": [_written(part) for part in value]}
    return value


def _one_of_ours(form: Any) -> Any:
    if not isinstance(form, Frozen):
        raise ConversionError(f"forms of the library are written to JSON; got {type(form).__name__}.")
    return _written(form)


def _read(value: Any) -> Any:
    if not isinstance(value, dict):
        return value
    if set(value) == {"array"}:
        try:
            return np.array(value["array"], dtype=np.float64)
        except (TypeError, ValueError):
            raise GeometryError("an array in this file does not hold numbers in rows of equal length.") from None
    if set(value) == {"tuple"} and isinstance(value["tuple"], list):
        return tuple(_read(part) for part in value["tuple"])
    kind = NAMES.get(str(value.get("form")))
    if kind is None:
        raise GeometryError(f"a form in this file is of a kind that is not known: {value.get('form')!r}.")
    held = {name: _read(part) for name, part in value.items() if name != "form"}
    return _exactly(kind, held)


def _exactly(kind: type[Frozen], held: dict[str, Any]) -> Any:
    """The form that holds just this, once its constructor has found nothing wrong with it and holds the same to rounding."""
    try:
        form = kind.__new__(kind)
        form.__setstate__({"_names": tuple(held), **held})
        checked = REMADE[kind](form)
    except GeometryError:
        raise
    except (AttributeError, TypeError, ValueError, IndexError, KeyError) as error:
        raise GeometryError(f"a {kind.__name__} in this file is not whole: {type(error).__name__}: {error}.") from None
    if checked._names != form._names or not all(_alike(getattr(checked, n), getattr(form, n), kind) for n in form._names):
        raise GeometryError(f"a {kind.__name__} in this file does not hold together: its parts contradict each other.")
    return form


def _alike(a: Any, b: Any, kind: type[Frozen]) -> bool:
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return a.shape == b.shape and bool(np.allclose(a, b, rtol=1e-9, atol=1e-9 * (1 + np.abs(a).max(initial=0.0))))
    if isinstance(a, float) and isinstance(b, float | int):
        return bool(np.isclose(a, b, rtol=1e-9, atol=0))
    return (kind is CircularSweep and isinstance(a, Transform)) or bool(a == b)
