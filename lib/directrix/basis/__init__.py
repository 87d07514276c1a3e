"""Basis functions of one parameter: polynomials and B-splines, fast and slow."""

from directrix.basis.polynomial import HERMITE, bernstein, de_casteljau, hermite, lagrange, linear, monomials
from directrix.basis.spline import cox_de_boor, spline_local, spline_row, spline_span

__all__ = [
    "HERMITE",
    "bernstein",
    "cox_de_boor",
    "de_casteljau",
    "hermite",
    "lagrange",
    "linear",
    "monomials",
    "spline_local",
    "spline_row",
    "spline_span",
]
