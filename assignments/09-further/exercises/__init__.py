"""A9: further tasks, sixteen of them, to choose from. Each stands alone: no task needs the answer of another.

quadrics    quadric_value, quadric_class
turning     revolved_line_kind, screw_sweep, nurbs_revolve
nets        bezier_split, elevate_u, uniform_bicubic, points16_to_bezier
edges       corners_agree, cubic_coons, coons_bezier_net
measuring   fmill_tangents, outward_normals, sphericity
black_boxes same_surface

They are imported in the order in which the notebook poses them, which is the order of the catalogue. Oracle numbers:
tests/assignments.
"""

# ruff: noqa: I001  (the order of these lines is the order of the course)
from .quadrics import quadric_value, quadric_class
from .turning import revolved_line_kind, screw_sweep, nurbs_revolve
from .nets import bezier_split, elevate_u, uniform_bicubic, points16_to_bezier
from .edges import corners_agree, cubic_coons, coons_bezier_net
from .measuring import fmill_tangents, outward_normals, sphericity
from .black_boxes import same_surface

__all__ = [
    "bezier_split",
    "coons_bezier_net",
    "corners_agree",
    "cubic_coons",
    "elevate_u",
    "fmill_tangents",
    "nurbs_revolve",
    "outward_normals",
    "points16_to_bezier",
    "quadric_class",
    "quadric_value",
    "revolved_line_kind",
    "same_surface",
    "screw_sweep",
    "sphericity",
    "uniform_bicubic",
]
