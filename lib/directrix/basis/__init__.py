"""Basis functions of one parameter: polynomials and B-splines, fast and slow."""

from directrix.basis.polynomial import HERMITE, bernstein, de_casteljau, hermite, lagrange, linear, monomials
from directrix.basis.refinement import bezier_extraction, blossom, clamped, derived, on_knots, raised
from directrix.basis.spline import SpanTable, cox_de_boor, spline_local, spline_planes, spline_row, spline_span

__all__ = [
    "HERMITE",
    "SpanTable",
    "bernstein",
    "bezier_extraction",
    "blossom",
    "clamped",
    "cox_de_boor",
    "de_casteljau",
    "derived",
    "hermite",
    "lagrange",
    "linear",
    "monomials",
    "on_knots",
    "raised",
    "spline_local",
    "spline_planes",
    "spline_row",
    "spline_span",
]
