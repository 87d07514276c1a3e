"""Conversions between forms, exact wherever mathematics allows, and refinements that leave a form where it is."""

from directrix.conversion.forms import to_algebraic, to_bezier, to_bspline, to_hermite, to_nurbs, to_points
from directrix.conversion.refining import elevate, insert_knot, remove_knot, split_bezier

__all__ = [
    "elevate",
    "insert_knot",
    "remove_knot",
    "split_bezier",
    "to_algebraic",
    "to_bezier",
    "to_bspline",
    "to_hermite",
    "to_nurbs",
    "to_points",
]
