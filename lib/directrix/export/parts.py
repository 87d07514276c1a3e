"""A surface as parts that hold together: torn B-splines are cut at their tears, since files hold no gap within a face."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, TypeVar

import numpy as np

from directrix.conversion import elevate
from directrix.knots import KnotVector
from directrix.surfaces.spline import BSplinePatch, NurbsPatch

Spline = TypeVar("Spline", bound=BSplinePatch | NurbsPatch)


def continuous(patch: Spline) -> list[Spline]:
    """The parts between the knots at which a patch is torn (order times or more), with degrees of at least 1."""
    if min(patch.degrees) == 0:
        patch = elevate(patch, u=int(patch.k == 1), w=int(patch.l == 1))
    cuts_u, cuts_w = tears(patch.knot_vector_u), tears(patch.knot_vector_w)
    if len(cuts_u) == len(cuts_w) == 2:
        return [patch]
    parts: list[Any] = [patch.patch(a, b, c, d) for a, b in pairwise(cuts_u) for c, d in pairwise(cuts_w)]
    return parts


def tears(knots: KnotVector) -> list[float]:
    """Both ends, and between them each knot that occurs order times or more, as values of u."""
    distinct, times = np.unique(knots.values, return_counts=True)
    inner = distinct[(times >= knots.order) & (distinct > knots.start) & (distinct < knots.end)]
    return [0.0, *(float(u) for u in knots.relax(inner)), 1.0]
