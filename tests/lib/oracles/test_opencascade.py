"""OpenCASCADE beside ours on random data: splines, elementary surfaces, sweeps, frames, areas, volumes, projection."""

from math import pi

import directrix as dx
import numpy as np
import pytest

pytest.importorskip("OCP", reason="OpenCASCADE is not installed: uv sync --group oracles")

from tests.lib.opencascade import along, array1, curve, direction, knots, occ, over, point, surface, vector, xyz

T = np.linspace(0, 1, 9)
U, W = T[:, None], T[None, :]
ATOL = 1e-12  # coordinates of size 1 to 10: a few hundred roundings
RNG = np.random.default_rng(2024)
P = RNG.standard_normal((7, 3))
NET = RNG.standard_normal((6, 5, 3))
WEIGHTS = RNG.uniform(0.5, 2, (6, 5))
REPEATED = [0, 0, 0, 0, 0.3, 0.3, 0.7, 1, 1, 1, 1]


@pytest.mark.parametrize(
    "form",
    [
        dx.NurbsCurve(P, RNG.uniform(0.5, 2, 7), 4, REPEATED), dx.BSplineCurve(P, 3), dx.BezierCurve(P[:5]),
        dx.HermiteCurve(*P[:4]), dx.Conic(*P[:3], 1.7), dx.Line(*P[:2]), dx.BSplineCurve(P, 4, "periodic"),
    ],
    ids=lambda form: type(form).__name__,
)  # fmt: skip
def test_curves_with_two_derivatives_and_length(form):
    """Value, velocity, acceleration and arc length."""
    geom = curve(form)
    start, speed = geom.FirstParameter(), geom.LastParameter() - geom.FirstParameter()
    np.testing.assert_allclose(form(T), along(geom, T), atol=ATOL)
    for t in T[1:-1] + 1e-3:  # away from knots, where the sides differ
        for n in (1, 2):
            np.testing.assert_allclose(
                form.derivative(t, n), xyz(geom.DN(start + t * speed, n)) * speed**n, rtol=1e-9, atol=1e-9
            )
    adaptor = occ.GeomAdaptor.GeomAdaptor_Curve(geom)
    length = occ.GCPnts.GCPnts_AbscissaPoint.Length_s(adaptor, 1e-10)
    assert form.length() == pytest.approx(length, rel=1e-8)


@pytest.mark.parametrize(
    "form",
    [
        dx.NurbsPatch(NET, WEIGHTS, 4, 3, [0, 0, 0, 0, 0.4, 0.4, 1, 1, 1, 1]), dx.BSplinePatch(NET, 3, 4),
        dx.BSplinePatch(NET, 4, 3, "periodic"), dx.BezierPatch(NET), dx.HermitePatch(RNG.standard_normal((4, 4, 3))),
        dx.PointPatch(NET[:4, :3]), dx.AlgebraicPatch(NET[:3]), dx.Ferguson(*RNG.standard_normal((3, 2, 2, 3))),
        dx.Bilinear(*P[:4]), dx.Plane(*P[:3]),
    ],
    ids=lambda form: type(form).__name__,
)  # fmt: skip
def test_patches_with_derivatives_normals_and_curvature(form):
    """All partial derivatives to the second order, the normal, and the four curvatures in our convention of signs and order."""
    geom = surface(form)
    np.testing.assert_allclose(form(U, W), over(geom, T, T), atol=ATOL)
    u0, u1, w0, w1 = geom.Bounds()
    for u, w in RNG.uniform(0.01, 0.99, (12, 2)):
        s, t = u0 + u * (u1 - u0), w0 + w * (w1 - w0)
        for nu, nw in ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2)):
            theirs = xyz(geom.DN(s, t, nu, nw)) * (u1 - u0) ** nu * (w1 - w0) ** nw
            np.testing.assert_allclose(form.derivative(u, w, nu, nw), theirs, rtol=1e-9, atol=1e-9)
        props = occ.GeomLProp.GeomLProp_SLProps(geom, s, t, 2, 1e-12)
        np.testing.assert_allclose(form.normal(u, w), xyz(props.Normal()), atol=1e-9)
        assert props.IsCurvatureDefined()
        bent = form.curvature(u, w)
        size = 1 + abs(bent.k1) + abs(bent.k2)
        assert bent.gaussian == pytest.approx(props.GaussianCurvature(), abs=1e-8 * size**2)
        assert bent.mean == pytest.approx(props.MeanCurvature(), abs=1e-8 * size)
        assert (bent.k1, bent.k2) == pytest.approx((props.MaxCurvature(), props.MinCurvature()), abs=1e-6 * size)


AX3 = occ.gp.gp_Ax3


@pytest.mark.parametrize(
    ("form", "geom", "swapped"),
    [
        (dx.Cylinder(2, 5), lambda: (occ.Geom.Geom_CylindricalSurface(AX3(), 2.0), (0, 2 * pi, 0, 5)), False),
        (dx.Cone(1, 3, 2), lambda: (occ.Geom.Geom_ConicalSurface(AX3(), pi / 4, 1.0), (0, 2 * pi, 0, 2 * 2**0.5)), False),
        (dx.Torus(3, 1), lambda: (occ.Geom.Geom_ToroidalSurface(AX3(), 3.0, 1.0), (0, 2 * pi, 0, 2 * pi)), True),
        (dx.Sphere(2), lambda: (occ.Geom.Geom_SphericalSurface(AX3(), 2.0), (0, 2 * pi, pi / 2, -pi / 2)), True),
    ],
    ids=["Cylinder", "Cone", "Torus", "Sphere"],
)
def test_elementary_surfaces_point_for_point(form, geom, swapped):
    """Its elementary surfaces run round the axis first, at constant speed as ours."""
    made, bounds = geom()
    theirs = over(made, T, T, bounds)
    theirs = theirs.swapaxes(0, 1) if swapped else theirs
    if isinstance(form, dx.Sphere) and np.abs(form(U, W) - theirs).max() > ATOL:
        theirs = theirs[::-1]  # from the other pole
    np.testing.assert_allclose(form(U, W), theirs, atol=ATOL)


def test_linear_sweep_is_the_surface_of_linear_extrusion():
    """Geom_SurfaceOfLinearExtrusion along a direction that is no axis."""
    along_it = np.array([1.0, 2, -1])
    sweep = dx.LinearSweep(dx.BSplineCurve(P, 4), along_it, 3)
    geom = occ.Geom.Geom_SurfaceOfLinearExtrusion(curve(sweep.curve), direction(along_it))
    u0, u1, _, _ = geom.Bounds()
    np.testing.assert_allclose(sweep(U, W), over(geom, T, T, (u0, u1, 0, 3)), atol=ATOL)


@pytest.mark.parametrize("angle", [2 * pi, 1.25, -2.0])
def test_circular_sweep_is_the_surface_of_revolution(angle):
    """Geom_SurfaceOfRevolution about an axis that misses the origin, in both senses; it has the angle first."""
    place, axis = np.array([1.0, -2, 0.5]), np.array([1.0, 1, 2])
    sweep = dx.CircularSweep.about(dx.BSplineCurve(P, 3), place, axis, angle)
    geom = occ.Geom.Geom_SurfaceOfRevolution(curve(sweep.curve), occ.gp.gp_Ax1(point(place), direction(axis)))
    _, _, w0, w1 = geom.Bounds()
    np.testing.assert_allclose(sweep(U, W), over(geom, T, T, (0, angle, w0, w1)).swapaxes(0, 1), atol=1e-11)


def test_ruled_surface_is_that_of_geomfill():
    """GeomFill.Surface between two splines of one degree and knots."""
    ruled = dx.Ruled(dx.BSplineCurve(P, 4), dx.BSplineCurve(P[::-1] + 2, 4))
    geom = occ.GeomFill.GeomFill.Surface_s(curve(ruled.c0), curve(ruled.c1))
    np.testing.assert_allclose(ruled(U, W), over(geom, T, T), atol=ATOL)


def test_frenet_frames():
    """GeomFill_Frenet along a Bezier curve: tangent, normal and binormal turn as our moving frame does."""
    path = dx.BezierCurve(P[:5])
    law = occ.GeomFill.GeomFill_Frenet()
    law.SetCurve(occ.GeomAdaptor.GeomAdaptor_Curve(curve(path)))

    def frame(t):
        axes = [occ.gp.gp_Vec() for _ in range(3)]
        assert law.D0(float(t), *axes)
        return np.stack([xyz(axis) for axis in axes], axis=-1)

    section = dx.BezierCurve(RNG.standard_normal((3, 3)))
    sweep = dx.GenericSweep(section, path, "frenet")
    start = frame(0.0)
    for t in T:
        turn = frame(t) @ start.T
        theirs = path(t) + (section(T) - path(0.0)) @ turn.T
        np.testing.assert_allclose(sweep(T, t), theirs, atol=1e-10)


def test_translational_sweep_is_a_fixed_pipe():
    """GeomFill_Pipe with a constant trihedron carries the section along without a turn; where it begins is its own affair."""
    section, path = dx.BSplineCurve(P, 4), dx.BezierCurve(RNG.standard_normal((4, 3)))
    sweep = dx.GenericSweep(section, path)
    pipe = occ.GeomFill.GeomFill_Pipe(curve(path), curve(section), occ.GeomFill.GeomFill_Trihedron.GeomFill_IsFixed)
    pipe.Perform(1e-9, False, occ.GeomAbs.GeomAbs_Shape.GeomAbs_C1, 11, 30)
    geom = pipe.Surface()
    theirs = over(geom, T, T)
    np.testing.assert_allclose(sweep(U, W) - sweep(0, 0), theirs - theirs[0, 0], atol=ATOL)


GENTLE = np.stack([*np.meshgrid(np.arange(6.0), np.arange(5.0), indexing="ij"), NET[..., 2]], axis=-1)


@pytest.mark.parametrize("form", [dx.Torus(3, 1), dx.Sphere(2), dx.Cone(2, 0, 3), dx.BezierPatch(GENTLE)])
def test_areas(form):
    """BRepGProp over the face of the exact NURBS, which has the area whatever its parameters. Without folds and inner knots:
    there it is off by 1e-5 to 1e-4, and `test_quadrature.py` has the truth by brute force."""
    face = occ.BRepBuilderAPI.BRepBuilderAPI_MakeFace(surface(form), 1e-9).Face()
    props = occ.GProp.GProp_GProps()
    occ.BRepGProp.BRepGProp.SurfaceProperties_s(face, props, 1e-9)
    assert form.area() == pytest.approx(props.Mass(), rel=1e-6)


def test_volume_of_a_solid():
    """A B-spline hyperpatch: OpenCASCADE integrates over its six outward faces."""
    net = np.indices((4, 3, 3)).transpose(1, 2, 3, 0) + 0.2 * np.random.default_rng(1).standard_normal((4, 3, 3, 3))
    solid = dx.BSplineHyperpatch(net, 3, 3, 2)
    builder, shell = occ.BRep.BRep_Builder(), occ.TopoDS.TopoDS_Shell()
    builder.MakeShell(shell)
    for face in solid.faces():
        builder.Add(shell, occ.BRepBuilderAPI.BRepBuilderAPI_MakeFace(surface(face), 1e-9).Face())
    props = occ.GProp.GProp_GProps()
    occ.BRepGProp.BRepGProp.VolumeProperties_s(shell, props, 1e-9)
    assert solid.volume() == pytest.approx(props.Mass(), rel=1e-7)


def test_nearest_point():
    """GeomAPI_ProjectPointOnSurf finds no nearer point than ours, and ours none nearer than it."""
    patch = dx.BSplinePatch(NET, 4, 3)
    places = np.random.default_rng(3).standard_normal((8, 3)) * 2
    geom = surface(patch)
    for place, ours in zip(places, patch.nearest(places).distance, strict=True):
        projection = occ.GeomAPI.GeomAPI_ProjectPointOnSurf(point(place), geom)
        on_edges = [
            np.linalg.norm(along(geom.UIso(s), np.linspace(0, 1, 2001)) - place, axis=1).min() for s in geom.Bounds()[:2]
        ] + [np.linalg.norm(along(geom.VIso(t), np.linspace(0, 1, 2001)) - place, axis=1).min() for t in geom.Bounds()[2:]]
        inside = projection.LowerDistance() if projection.NbPoints() else np.inf
        assert ours == pytest.approx(min(inside, *on_edges), rel=1e-5)


def test_elevation_and_insertion_of_knots():
    """IncreaseDegree and InsertUKnot give our control nets and weights."""
    patch = dx.NurbsPatch(NET, WEIGHTS, 4, 3)
    raised, more = surface(patch), surface(patch)
    raised.IncreaseDegree(5, 3)
    more.InsertUKnot(1.25, 2, 1e-12, True)
    for geom, ours in ((raised, dx.elevate(patch, u=2, w=1)), (more, dx.insert_knot(patch, u=1.25 / 3, times=2))):
        net = [[xyz(geom.Pole(i + 1, j + 1)) for j in range(geom.NbVPoles())] for i in range(geom.NbUPoles())]
        weights = [[geom.Weight(i + 1, j + 1) for j in range(geom.NbVPoles())] for i in range(geom.NbUPoles())]
        np.testing.assert_allclose(ours.control_net, net, atol=1e-10)
        np.testing.assert_allclose(ours.weights, weights, rtol=1e-12)


def test_transforms():
    """gp_Trsf: a rotation about any line, a mirror, a scale about a point."""
    place, axis = np.array([1.0, 2, -1]), np.array([2.0, -1, 1])
    turn, mirror, scale = occ.gp.gp_Trsf(), occ.gp.gp_Trsf(), occ.gp.gp_Trsf()
    turn.SetRotation(occ.gp.gp_Ax1(point(place), direction(axis)), 1.25)
    mirror.SetMirror(occ.gp.gp_Ax2(point(place), direction(axis)))
    scale.SetScale(point(place), -1.5)
    ours = dx.Transform.rotate(axis, 1.25, place), dx.Transform.reflect(axis, place), dx.Transform.scale(-1.5, place)
    for move, theirs in zip(ours, (turn, mirror, scale), strict=True):
        np.testing.assert_allclose(move @ P, [xyz(point(p).Transformed(theirs)) for p in P], atol=ATOL)


def test_knots_are_counted_alike():
    """The helper itself: distinct knots and multiplicities as OpenCASCADE lists them."""
    distinct, times = knots(REPEATED)
    assert [distinct.Value(i) for i in range(1, 5)] == [0, 0.3, 0.7, 1]
    assert [times.Value(i) for i in range(1, 5)] == [4, 2, 1, 4]
    assert array1("int", [3]).Value(1) == 3
    assert xyz(vector((1, 2, 3))).tolist() == [1, 2, 3]
