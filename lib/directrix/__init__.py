"""Every surface form of a first course in geometric modelling: numpy arrays in, numpy arrays out.

``import directrix as dx`` is cheap: each name below is loaded from its module when it is first used.
"""

from importlib import import_module
from typing import Any

_NAMES = {
    # curves
    "Arc": "curves.arc",
    "BSplineCurve": "curves.bspline",
    "BezierCurve": "curves.bezier",
    "Circle": "curves.arc",
    "Conic": "curves.conic",
    "Curve": "curves.curve",
    "FunctionCurve": "curves.function",
    "HermiteCurve": "curves.hermite",
    "Line": "curves.line",
    "NurbsCurve": "curves.bspline",
    "PointCurve": "curves.point",
    # known forms
    "Cone": "surfaces.known",
    "Cylinder": "surfaces.known",
    "Plane": "surfaces.plane",
    "Sphere": "surfaces.known",
    "Torus": "surfaces.known",
    "Triangle": "surfaces.plane",
    # freeform
    "AlgebraicPatch": "surfaces.algebraic",
    "BSplinePatch": "surfaces.spline",
    "NurbsPatch": "surfaces.spline",
    "BezierPatch": "surfaces.bezier",
    "HermitePatch": "surfaces.hermite",
    "PointPatch": "surfaces.point",
    # boundary
    "Bilinear": "surfaces.boundary",
    "Coons": "surfaces.coons",
    "Ferguson": "surfaces.hermite",
    "Ruled": "surfaces.boundary",
    "coons_net": "surfaces.coons",
    "coons_twists": "surfaces.hermite",
    # implicit
    "Quadric": "quadric",
    "quadric_patches": "surfaces.quadrics",
    # solids
    "BSplineHyperpatch": "solids.spline",
    "BezierHyperpatch": "solids.polynomial",
    "HermiteHyperpatch": "solids.polynomial",
    "NurbsHyperpatch": "solids.spline",
    # conversion
    "elevate": "conversion",
    "insert_knot": "conversion",
    "remove_knot": "conversion",
    "split_bezier": "conversion",
    "to_algebraic": "conversion",
    "to_bezier": "conversion",
    "to_bspline": "conversion",
    "to_hermite": "conversion",
    "to_nurbs": "conversion",
    "to_points": "conversion",
    # inspection
    "conicity": "inspection",
    "cylindricity": "inspection",
    "flatness": "inspection",
    "sphericity": "inspection",
    "toricity": "inspection",
    # swept
    "CircularSweep": "surfaces.revolution",
    "GenericSweep": "surfaces.sweep",
    "LinearSweep": "surfaces.extrusion",
    # what all surfaces share
    "Surface": "surfaces.surface",
    # measures
    "join": "surfaces.joining",
    # moving
    "Transform": "transform",
    # errors
    "ConversionError": "errors",
    "CornerError": "errors",
    "CurveError": "errors",
    "DegenerateError": "errors",
    "DomainError": "errors",
    "FrozenError": "errors",
    "GeometryError": "errors",
    "KnotError": "errors",
    "NumberError": "errors",
    "OrderError": "errors",
    "ShapeError": "errors",
    "WeightError": "errors",
}
_ROOMS = {"errors", "checks", "export", "plot"}

__all__ = [*_NAMES]


def __getattr__(name: str) -> Any:
    if name in _NAMES:
        value = getattr(import_module(f"directrix.{_NAMES[name]}"), name)
    elif name in _ROOMS:
        value = import_module(f"directrix.{name}")
    else:
        raise AttributeError(f"module 'directrix' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_NAMES, *_ROOMS})
