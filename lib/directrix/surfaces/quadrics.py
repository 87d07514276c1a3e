"""A piece of each quadric to look at, made of the library's own surfaces and exact as they are."""

from __future__ import annotations

from collections.abc import Callable
from math import atan, hypot, sqrt

import numpy as np

from directrix import checks
from directrix.checks import Array
from directrix.curves.arc import Circle
from directrix.curves.bezier import BezierCurve
from directrix.curves.conic import Conic
from directrix.errors import ConversionError
from directrix.quadric import Quadric
from directrix.surfaces.boundary import Bilinear, Ruled
from directrix.surfaces.extrusion import LinearSweep
from directrix.surfaces.known import Cone, Cylinder, Sphere
from directrix.surfaces.plane import Plane
from directrix.surfaces.revolution import CircularSweep
from directrix.surfaces.surface import Surface
from directrix.transform import Transform

UP = (0.0, 0.0, 1.0)


def quadric_patches(quadric: Quadric, extent: float | None = None) -> tuple[Surface, ...]:
    """Patches of a quadric about its centre: one, or two where it has two sheets or two planes.

    An ellipsoid is a sphere stretched; a hyperboloid of one sheet the ruled surface between two circles, one turned; a
    hyperbolic paraboloid the bilinear patch of four points; a paraboloid and a hyperboloid of two sheets are a parabola and a
    hyperbola turned and stretched; cylinders are conics swept (Hilbert & Cohn-Vossen, Geometry and the Imagination, sections
    2 and 3).

    Parameters
    ----------
    quadric : Quadric
    extent : how far an unbounded one reaches from its centre along each axis, in the unit of length; by default twice its
        largest finite radius, or 1

    Returns
    -------
    tuple of one or two surfaces

    Raises
    ------
    ConversionError
        If the quadric is a line, a point, empty or everything: no surface.

    Examples
    --------
    >>> (saddle,) = quadric_patches(Quadric(0, 0, 0, 2, 0, 0, 0, 0, -2, 0))       # xy = z
    >>> x, y, z = saddle(0.3, 0.9)
    >>> bool(abs(x * y - z) < 1e-12)
    True
    """
    if not isinstance(quadric, Quadric):
        raise ConversionError(f"quadric_patches draws a Quadric; got {type(quadric).__name__}. Known forms have .implicit().")
    form = quadric.classify()
    if form.center is None or form.axes is None or form.radii is None or form.kind in ("line", "point"):
        raise ConversionError(f"this quadric is {_article(form.kind)}: there is no surface to draw.")
    finite = form.radii[np.isfinite(form.radii)]
    reach = checks.positive("extent", extent) if extent is not None else 2 * float(finite.max(initial=0.0)) or 1.0
    place = Transform.of(form.axes.T, form.center)
    return tuple(place @ patch for patch in PIECES[form.kind](form.radii, reach))


def _article(kind: str) -> str:
    return kind if kind in ("empty", "everything") else f"a {kind}"


def _stretched(radii: Array, *patches: Surface) -> list[Surface]:
    return [Transform.scale(radii) @ patch for patch in patches]


def _one_sheet(radii: Array, reach: float) -> list[Surface]:
    """x² + y² - z² = 1 between z = -t and t: lines join the lower circle to the upper one, turned by 2 atan t."""
    t = reach / radii[2]
    low, high = (Circle((0, 0, z), hypot(1, t), UP) for z in (-t, t))
    return _stretched(radii, Ruled(low, Transform.rotate("z", 2 * atan(t)) @ high))


def _two_sheets(radii: Array, reach: float) -> list[Surface]:
    """z² - x² = 1 from its vertex to z = t, turned about z. Its tangents at both ends meet on z = 1."""
    t = max(reach / radii[2], 1.5)  # an extent short of the vertex would leave nothing
    x = sqrt(t * t - 1)
    weight = sqrt((t + 1) / 2)  # the hyperbolic cosine of half the arc
    branch = Conic((0, 0, 1), ((t - 1) / x, 0, 1), (x, 0, t), weight)
    sheet = CircularSweep(branch)
    return _stretched(radii, sheet, Transform.reflect("z") @ sheet)


def _cone(radii: Array, reach: float) -> list[Surface]:
    half = Cone(0, reach, reach)
    return _stretched(radii, half, Transform.reflect("z") @ half)


def _paraboloid(radii: Array, reach: float) -> list[Surface]:
    """z = (x² + y²)/2 as a parabola turned, then stretched by the roots of the radii."""
    x = sqrt(2 * reach)
    half = CircularSweep(BezierCurve([(0, 0, 0), (x / 2, 0, 0), (x, 0, reach)]))
    return [Transform.scale((sqrt(radii[0]), sqrt(radii[1]), 1.0)) @ half]


def _saddle(radii: Array, reach: float) -> list[Surface]:
    """z = (x² - y²)/2 = p q with p, q = (x ± y)/√2: bilinear over the square of p and q."""
    s = sqrt(reach)
    corners = [((p + q) / sqrt(2) * s, (p - q) / sqrt(2) * s, p * q * reach) for p in (-1, 1) for q in (-1, 1)]
    return [Transform.scale((sqrt(radii[0]), sqrt(radii[1]), 1.0)) @ Bilinear(*corners)]


def _elliptic_cylinder(radii: Array, reach: float) -> list[Surface]:
    tube = Transform.translate((0, 0, -reach)) @ Cylinder(1, 2 * reach)
    return [Transform.scale((radii[0], radii[1], 1.0)) @ tube]


def _hyperbolic_cylinder(radii: Array, reach: float) -> list[Surface]:
    """x² - y² = 1 from y = -t to t, swept along z; its end tangents meet on the x axis at 1/x."""
    t = reach / radii[1]
    x = hypot(1, t)
    branch = Conic((x, -t, -reach), (1 / x, 0, -reach), (x, t, -reach), x)
    sheet = LinearSweep(branch, UP, 2 * reach)
    scale = Transform.scale((radii[0], radii[1], 1.0))
    return [scale @ sheet, scale @ Transform.reflect("x") @ sheet]


def _parabolic_cylinder(radii: Array, reach: float) -> list[Surface]:
    """x² = 2 a z, swept along y."""
    x = sqrt(2 * reach * radii[0])
    return [LinearSweep(BezierCurve([(-x, -reach, reach), (0, -reach, -reach), (x, -reach, reach)]), (0, 1, 0), 2 * reach)]


def _planes(radii: Array, reach: float) -> list[Surface]:
    """Two planes through the z axis, at the slopes ±b."""
    a, b = reach / hypot(1, radii[1]), reach * radii[1] / hypot(1, radii[1])
    return [Plane((-a, -s * b, -reach), (a, s * b, -reach), (-a, -s * b, reach)) for s in (1, -1)]


def _parallel(radii: Array, reach: float) -> list[Surface]:
    return [Plane((x, -reach, -reach), (x, reach, -reach), (x, -reach, reach)) for x in (radii[0], -radii[0])]


PIECES: dict[str, Callable[[Array, float], list[Surface]]] = {
    "ellipsoid": lambda radii, reach: _stretched(radii, Sphere(1)),
    "hyperboloid of one sheet": _one_sheet,
    "hyperboloid of two sheets": _two_sheets,
    "cone": _cone,
    "elliptic paraboloid": _paraboloid,
    "hyperbolic paraboloid": _saddle,
    "elliptic cylinder": _elliptic_cylinder,
    "hyperbolic cylinder": _hyperbolic_cylinder,
    "parabolic cylinder": _parabolic_cylinder,
    "intersecting planes": _planes,
    "parallel planes": _parallel,
    "coincident planes": lambda radii, reach: _parallel(radii, reach)[:1],
}
