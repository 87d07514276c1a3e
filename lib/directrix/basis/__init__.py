"""Basis functions of one parameter: polynomials and B-splines, fast and slow."""

from directrix.basis.polynomial import HERMITE, bernstein, de_casteljau, hermite, lagrange, linear, monomials

__all__ = ["HERMITE", "bernstein", "de_casteljau", "hermite", "lagrange", "linear", "monomials"]
