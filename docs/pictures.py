"""Every form of the library once, as a picture: what the gallery draws, by group, in the order of the course.

A picture is a title and a function that makes its figure; nothing is computed before it is asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import pi
from typing import Any

import directrix as dx
import numpy as np
from directrix.plot import view, walk

SEED = 8


@dataclass(frozen=True)
class Picture:
    """One picture of the gallery: its group, its title, and how to make it."""

    group: str
    title: str
    figure: Callable[[], Any]

    @property
    def slug(self) -> str:
        """The name of its file: the words of the title."""
        return "-".join("".join(c if c.isalnum() else " " for c in self.title.lower()).split())


def pictures() -> list[Picture]:
    """All pictures."""
    groups = {
        "Curves": curves,
        "Known forms": known_forms,
        "Sweeps": sweeps,
        "Freeform patches": freeform,
        "Boundary surfaces": boundary,
        "Quadrics": quadrics,
        "Solids": solids,
        "Properties": properties,
        "Inspection": inspection,
    }
    return [Picture(group, title, figure) for group, made in groups.items() for title, figure in made()]


Titled = Iterator[tuple[str, Callable[[], Any]]]


def shown(form: Any, **options: Any) -> Callable[[], Any]:
    """A function that draws a form."""
    return lambda: view(form, **options)


def together(*forms: Any, **options: Any) -> Callable[[], Any]:
    """A function that draws several surfaces in one scene."""
    return lambda: view(forms[0], also=forms[1:], **options)


# The data: one hill, one set of four edges, one bent path, so that pictures can be compared.


def hill(m: int, n: int) -> np.ndarray:
    """A net (m, n, 3) over the rectangle 0 <= x <= 6, 0 <= y <= 4 with a ridge and a dip."""
    x, y = np.meshgrid(np.linspace(0, 6, m), np.linspace(0, 4, n), indexing="ij")
    z = 1.8 * np.sin(x * pi / 4 + 0.3) * np.cos((y - 4) * pi / 6) + 0.3 * y
    return np.stack([x, y, z], axis=-1)


def tube_net(around: int, along: int) -> np.ndarray:
    """A net that runs round an axis: to be closed by periodic knots."""
    turn, z = np.meshgrid(np.arange(around) * 2 * pi / around, np.linspace(0, 5, along), indexing="ij")
    rho = 1.4 + 0.5 * np.cos(z * pi / 2.5)
    return np.stack([rho * np.cos(turn), rho * np.sin(turn), z], axis=-1)


POINTS = [(0, 0, 0), (0.5, 1.5, 2.5), (2.5, 2.2, 2.5), (3.5, 0, 0), (5, 0.4, -0.5), (6, 2, 2)]
C0 = dx.BezierCurve([(0, 0, 0), (1.5, -0.4, 2), (3, 0, 0.4), (4, 0, 0)])
C1 = dx.BezierCurve([(0, 3, 0.6), (1.2, 3.4, 0), (2.6, 3, 2), (4.4, 3.2, 1)])
D0 = dx.BezierCurve([(0, 0, 0), (-0.3, 1, 1.2), (0, 2, 1), (0, 3, 0.6)])
D1 = dx.BezierCurve([(4, 0, 0), (4.6, 1, -0.6), (4.2, 2, 1.6), (4.4, 3.2, 1)])
PATH = dx.BezierCurve([(0, 0, 0), (0, 3, 3), (3, 3, 0), (4, 0, 4)])
EDGES = {"c0": C0, "c1": C1, "d0": D0, "d1": D1}
CORNERS = np.array([[(0, 0, 0), (0, 3, 0.6)], [(4, 0, 0), (4, 3, 1)]], dtype=float)
ALONG_U = np.array([[(4, 0, 4), (4, 0, -3)], [(4, 0, -3), (4, 0, 3)]], dtype=float)
ALONG_W = np.array([[(0, 3, 2), (0, 3, -2)], [(0, 3, -3), (0, 3, 3)]], dtype=float)


def curves() -> Titled:
    """The ten curves."""
    yield "Line", shown(dx.Line((0, 0, 0), (3, 2, 1)))
    yield "Arc", shown(dx.Arc((0, 0, 0), 2, 0, 1.5 * pi, (1, 0, 2)))
    yield "Circle", shown(dx.Circle((0, 0, 0), 2, (1, -1, 2)))
    conic = np.array([(0, 0, 0), (2, 3, 1), (4, 0, 0)])
    yield (
        "Conics of weight 2, 1 and 1/3",
        shown(dx.Conic(*conic, 2.0), net=conic, curves={"parabola": dx.Conic(*conic, 1.0), "ellipse": dx.Conic(*conic, 1 / 3)}),
    )
    hermite = dx.HermiteCurve((0, 0, 0), (4, 0, 1), (2, 6, 0), (2, -6, 3))
    tangents = {"t0": [(0, 0, 0), (2 / 3, 2, 0)], "t1": [(4, 0, 1), (14 / 3, -2, 2)]}
    yield "Hermite curve, its tangents at a third", shown(hermite, curves=tangents)
    yield "Curve through points", shown(dx.PointCurve(POINTS, "chord"), net=POINTS)
    yield "Bezier curve", shown(dx.BezierCurve(POINTS), net=True)
    yield "B-spline curve of order 4", shown(dx.BSplineCurve(POINTS, 4), net=True)
    yield "NURBS curve, one weight 6", shown(dx.NurbsCurve(POINTS, [1, 1, 6, 1, 1, 1], 4), net=True)
    helix = dx.FunctionCurve(lambda u: np.stack([np.cos(4 * pi * u), np.sin(4 * pi * u), 2 * u], axis=-1))
    yield "Any function: a helix", shown(helix)


def known_forms() -> Titled:
    """The five known forms, with the special cases of the torus and the cone."""
    yield "Plane", shown(dx.Plane((0, 0, 0), (3, 0, 1), (0, 2, 1)))
    yield "Triangle", shown(dx.Triangle((0, 0, 0), (3, 0, 1), (0, 2, 1)))
    yield "Cylinder", shown(dx.Cylinder(1, 2))
    yield "Frustum", shown(dx.Cone(1.5, 0.7, 2))
    yield "Cone with its apex", shown(dx.Cone(1.2, 0, 2))
    yield "Sphere", shown(dx.Sphere(1))
    yield "Ring torus", shown(dx.Torus(3, 1))
    yield "Horn torus, cut open", shown(dx.Torus(1.5, 1.5).patch(0, 1, 0, 0.625))
    yield "Spindle torus, cut open", shown(dx.Torus(0.8, 1.5).patch(0, 1, 0, 0.625))


def sweeps() -> Titled:
    """Linear, circular and generic sweeps."""
    wave = dx.BSplineCurve(POINTS, 4)
    yield "Linear sweep by direction and distance", shown(dx.LinearSweep(wave, (0, -1, 2), 3))
    yield (
        "Linear sweep of a circle between two points",
        shown(dx.LinearSweep.between(dx.Circle((0, 0, 0), 1), (0, 0, 0), (1, 1, 2.5))),
    )
    vase = dx.BSplineCurve([(1, 0, 0), (2.4, 0, 0.6), (0.2, 0, 2), (0.9, 0, 3.6), (1.6, 0, 4)], 4)
    yield "Circular sweep about z", shown(dx.CircularSweep(vase))
    yield "Circular sweep about y, a third of a turn", shown(dx.CircularSweep(dx.Line((1, 0, 0), (2, 2, 0.5)), "y", 2 * pi / 3))
    lying = dx.CircularSweep.in_xy_plane(dx.Line((0, 2, 0), (2, 2.4, 0)), pi / 6, pi)
    yield (
        "Circular sweep about an axis in the xy-plane",
        shown(lying, curves={"axis": [(-1.5, -1.5 / 3**0.5, 0), (4, 4 / 3**0.5, 0)]}),
    )
    k = np.array([1.0, 1.0, 1.0])
    tilted = dx.CircularSweep.about(dx.Circle((2.4, 0, 0), 0.6, (0, 1, 0)), (0, 0, 0), k)
    yield "Circular sweep about any axis", shown(tilted, curves={"axis": [-1.6 * k, 1.6 * k]})
    ring = dx.Circle((0, 0, 0), 0.5, PATH.derivative(0))
    yield "Generic sweep, fixed frame", shown(dx.GenericSweep(ring, PATH), curves={"directrix": PATH})
    yield "Generic sweep, Frenet frame", shown(dx.GenericSweep(ring, PATH, "frenet"), curves={"directrix": PATH})
    yield "Generic sweep, minimal frame", shown(dx.GenericSweep(ring, PATH, "minimal"), curves={"directrix": PATH})
    knot = dx.FunctionCurve(
        lambda t: np.stack(
            [
                (2 + np.cos(6 * pi * t)) * np.cos(4 * pi * t),
                (2 + np.cos(6 * pi * t)) * np.sin(4 * pi * t),
                np.sin(6 * pi * t),
            ],
            axis=-1,
        )
    )
    rope = dx.Circle(knot(0), 0.35, knot.derivative(0))
    yield "A closed directrix, minimal frame", shown(dx.GenericSweep(rope, knot, "minimal"), samples=121, lines=24)
    horn = dx.Arc((0, 0, 0), 3, 0, 1.2 * pi, (0, 1, 0))
    bell = dx.Circle((3, 0, 0), 1, (0, 0, 1))
    yield "Tapered sweep: a horn", shown(dx.GenericSweep(bell, horn, "minimal", taper=0.15))


def freeform() -> Titled:
    """The tensor-product patches."""
    bicubic = dx.BezierPatch(hill(4, 4))
    yield "Algebraic patch: Enneper's surface", shown(enneper())
    yield "Hermite patch, Coons twists", shown(dx.HermitePatch.of(CORNERS, ALONG_U, ALONG_W, "coons"))
    yield "Patch through 4 x 3 points", shown(dx.PointPatch(hill(4, 3)), net=True)
    yield "Bicubic Bezier patch", shown(bicubic, net=True)
    yield "Bezier patch of degrees 5 and 2", shown(dx.BezierPatch(hill(6, 3)), net=True)
    yield "B-spline patch of orders 4 and 3", shown(dx.BSplinePatch(hill(7, 5), 4, 3), net=True, knots=True)
    yield "B-spline patch, uniform knots", shown(dx.BSplinePatch(hill(7, 5), 4, 3, "uniform", "uniform"), net=True, knots=True)
    yield "B-spline patch, periodic in u", shown(dx.BSplinePatch(tube_net(7, 5), 4, 4, "periodic"), net=True)
    creased = dx.BSplinePatch(hill(7, 5), 4, 3, [0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2])
    yield "A triple knot: a crease", shown(creased, net=True, knots=True)
    weights, peak = np.ones((7, 5)), hill(7, 5)
    weights[4, 1], peak[4, 1, 2] = 12, 3
    yield "B-spline patch, one point lifted", shown(dx.BSplinePatch(peak, 4, 3), net=True)
    yield "NURBS patch, the same point with weight 12", shown(dx.NurbsPatch(peak, weights, 4, 3), net=True)
    yield "Torus as NURBS", shown(dx.to_nurbs(dx.Torus(3, 1)), net=True)


def enneper() -> dx.AlgebraicPatch:
    """Enneper's minimal surface over -1.2 <= s, t <= 1.2: (s - s³/3 + s t², t - t³/3 + t s², s² - t²)."""
    a = np.zeros((4, 4, 3))
    a[1, 0, 0], a[3, 0, 0], a[1, 2, 0] = 1, -1 / 3, 1
    a[0, 1, 1], a[0, 3, 1], a[2, 1, 1] = 1, -1 / 3, 1
    a[2, 0, 2], a[0, 2, 2] = 1, -1
    substitute = np.array([[1, -1.2, 1.44, -1.728], [0, 2.4, -5.76, 10.368], [0, 0, 5.76, -20.736], [0, 0, 0, 13.824]])
    return dx.AlgebraicPatch(np.einsum("ik,jl,klc->ijc", substitute, substitute, a))


def boundary() -> Titled:
    """Surfaces from their boundaries."""
    yield "Bilinear patch", shown(dx.Bilinear((0, 0, 0), (0, 3, 2), (3, 0, 2), (3, 3, 0)))
    low, high = dx.Circle((0, 0, 0), 1), dx.Circle((0, 0, 2.4), 1)
    yield "Ruled surface between two curves", shown(dx.Ruled(C0, C1), curves={"c0": C0, "c1": C1})
    yield (
        "Ruled between circles, one begun later: a hyperboloid",
        shown(dx.Ruled(low, dx.Transform.rotate("z", 2 * pi / 3) @ high), lines=16),
    )
    yield "Coons patch, linear blending", shown(dx.Coons(C0, C1, D0, D1), curves=EDGES)
    yield "Coons patch, cubic blending", shown(dx.Coons(C0, C1, D0, D1, blend="cubic"), curves=EDGES)
    net = dx.coons_net(*(curve.control_points for curve in EDGES.values()))
    yield "Discrete Coons net and its Bezier patch", shown(dx.BezierPatch(net), net=True)
    yield "Ferguson patch: flat corners", shown(dx.Ferguson(CORNERS, ALONG_U, ALONG_W))


def quadrics() -> Titled:
    """A patch of each kind that is a surface."""
    equations = {
        "Ellipsoid": (1 / 4, 1 / 2.25, 1, 0, 0, 0, 0, 0, 0, -1),
        "Hyperboloid of one sheet": (1, 1, -1, 0, 0, 0, 0, 0, 0, -1),
        "Hyperboloid of two sheets": (-1, -1, 1, 0, 0, 0, 0, 0, 0, -1),
        "Quadric cone": (1, 2, -1, 0, 0, 0, 0, 0, 0, 0),
        "Elliptic paraboloid": (1, 2, 0, 0, 0, 0, 0, 0, -1, 0),
        "Hyperbolic paraboloid": (1, -1, 0, 0, 0, 0, 0, 0, -1, 0),
        "Elliptic cylinder": (1, 3, 0, 0, 0, 0, 0, 0, 0, -1),
        "Hyperbolic cylinder": (1, -1, 0, 0, 0, 0, 0, 0, 0, -1),
        "Parabolic cylinder": (1, 0, 0, 0, 0, 0, 0, 0, -1, 0),
        "Intersecting planes": (1, -2, 0, 0, 0, 0, 0, 0, 0, 0),
        "Parallel planes": (1, 0, 0, 0, 0, 0, 0, 0, 0, -1),
        "Coincident planes, turned": (1, 1, 1, 2, 2, 2, 0, 0, 0, 0),
    }
    for title, coefficients in equations.items():
        yield title, together(*dx.quadric_patches(dx.Quadric(*coefficients)))


def solids() -> Titled:
    """The hyperpatches, by their six faces."""
    net = np.stack(np.meshgrid(np.linspace(0, 3, 4), np.linspace(0, 2, 3), np.linspace(0, 2, 3), indexing="ij"), axis=-1)
    bent = net + 0.35 * np.random.default_rng(SEED).standard_normal(net.shape)
    yield "Tricubic Hermite hyperpatch", shown(hermite_solid())
    yield "Bezier hyperpatch", shown(dx.BezierHyperpatch(bent))
    yield "B-spline hyperpatch", shown(dx.BSplineHyperpatch(bent, 3, 3, 2))
    arc, weights = np.array([(2, 0), (2, 2), (0, 2)]), np.array([1, 0.5**0.5, 1])
    pipe = [[[(r * x / 2, r * y / 2, z) for z in (0, 1)] for r in (1, 2)] for x, y in arc]
    yield (
        "NURBS hyperpatch: a quarter of a pipe",
        shown(dx.NurbsHyperpatch(pipe, np.broadcast_to(weights[:, None, None], (3, 2, 2)), 3, 2, 2)),
    )


def hermite_solid() -> dx.HermiteHyperpatch:
    """A box (x, y, z) = (3u, 2v, 2w) whose edges along u bulge: tangents that rise at u = 0 and fall at u = 1."""
    G = np.zeros((4, 4, 4, 3))
    G[1, :2, :2, 0] = G[2:, :2, :2, 0] = 3
    G[:2, 1, :2, 1] = G[:2, 2:, :2, 1] = 2
    G[:2, :2, 1, 2] = G[:2, :2, 2:, 2] = 2
    G[2, :2, 1, 2], G[3, :2, 1, 2] = 4, -4
    G[2, 1, :2, 1], G[3, 1, :2, 1] = -3, 3
    return dx.HermiteHyperpatch(G)


def properties() -> Titled:
    """What a picture can show besides the surface."""
    spline = dx.BSplinePatch(hill(7, 5), 4, 3)
    yield "Normals of a sphere point inward", shown(dx.Sphere(1).patch(0.5, 1, 0, 0.75), normals=True)
    yield "Gaussian curvature of a torus", shown(dx.Torus(3, 1), colour="gaussian")
    yield "Mean curvature of a B-spline patch", shown(spline, colour="mean")
    yield "The parameter square beside the surface", shown(spline, square=True, knots=True, mark=(0.25, 0.75))
    yield "A part cut out", shown(dx.Torus(3, 1).patch(0.1, 0.6, 0.2, 0.7), square=True)
    path = [(0.05, 0.05), (0.95, 0.3), (0.2, 0.9)]
    yield "A walk in the square and on the surface", lambda: walk(dx.BezierPatch(hill(4, 4)), path)
    yield (
        "Against the reference: Coons, cubic and linear",
        shown(
            dx.Coons(C0, C1, D0, D1, blend="cubic"),
            against=dx.Coons(C0, C1, D0, D1),
            names=("linear blending", "cubic blending"),
        ),
    )
    rational = dx.to_nurbs(dx.Arc((0, 0, 0), 2, 0, pi / 2))
    yield (
        "Two curves against each other",
        shown(
            dx.FunctionCurve(lambda u: rational(u**2)),
            against=dx.Conic((2, 0, 0), (2, 2, 0), (0, 2, 0), 1.0),
            names=("parabola", "arc"),
        ),
    )


def inspection() -> Titled:
    """Measured points, the fitted form, and how far the points are off it, enlarged."""
    rng = np.random.default_rng(SEED)
    u, w = rng.random((2, 160))
    for title, form, measure in (
        ("Flatness", dx.Plane((0, 0, 0), (4, 0, 1), (0, 3, 0.5)), dx.flatness),
        ("Cylindricity of a partial arc", dx.Cylinder(2, 3).patch(0, 0.4, 0, 1), dx.cylindricity),
        ("Conicity", dx.Cone(2, 1, 3), dx.conicity),
        ("Sphericity", dx.Sphere(2).patch(0.5, 1, 0, 1), dx.sphericity),
        ("Toricity", dx.Torus(3, 1).patch(0.6, 1, 0, 0.5), dx.toricity),
    ):
        points = form(u, w) + 0.01 * rng.standard_normal((160, 3))
        yield title, lambda points=points, measure=measure: fitted(measure(points))


def fitted(found: Any) -> Any:
    """The fitted form, and the measured points coloured by their residuals."""
    title = f"a zone {found.value:.3g} wide about a {type(found.form).__name__.removeprefix('Ideal').lower()}"
    return view(found.surface(), points=found.points, deviations=found.residuals, title=title)
