"""A8: boundary curves, solids, inspection. Surfaces through four curves; pieces of solid; form errors of measured points.

boundary     coons, ferguson, coons_twists
solids       hyperpatch, hyperpatch_faces
inspection   flatness, cylindricity

They are imported in the order in which the notebook poses them, which is the order of the catalogue. Oracle numbers:
tests/assignments.
"""

# ruff: noqa: I001  (the order of these lines is the order of the course)
from .boundary import coons, ferguson, coons_twists
from .solids import hyperpatch, hyperpatch_faces
from .inspection import flatness, cylindricity

__all__ = ["coons", "coons_twists", "cylindricity", "ferguson", "flatness", "hyperpatch", "hyperpatch_faces"]
