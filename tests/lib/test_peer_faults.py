"""The faults and disagreements that other libraries were seen to have: what each does, and what we answer.

Peers: geomdl 5.4, splipy 1.10, splinepy 0.2, nurbspy 1.5, scipy 1.17, OpenCASCADE 8 (OCP), rhino3dm 8.35. Each test asks ours
first and then shows the peer's fault live, so that a fault that has been mended shows up as well. One fault is only told:
nurbspy's `get_normals` killed the process together with numba 0.68.1, which is not installed here; without numba it answers.
More than 400 lines, since one list of questions is easier to hold against the world than three.
"""

import inspect
from math import pi, sqrt

import directrix as dx
import numpy as np
import pytest
from scipy.interpolate import BSpline

ATOL = 1e-12  # coordinates of size 1 to 10: a few hundred roundings
T = np.linspace(0, 1, 41)


def spline_edges():
    """Four B-spline edges of a unit patch, cubic with seven points: their knots are not equally spaced in Greville's sense."""
    s = np.linspace(0, 1, 7)
    bulge = np.array([0, 0.1, -0.2, 0.3, 0.2, -0.1, 0])
    c0 = np.stack([s, 0 * s, bulge], axis=-1)
    c1 = np.stack([s, 0 * s + 1, -bulge], axis=-1)
    d0 = np.stack([0 * s, s, 2 * bulge], axis=-1)
    d1 = np.stack([0 * s + 1, s, bulge], axis=-1)
    return [dx.BSplineCurve(points, 4) for points in (c0, c1, d0, d1)]


def opencascade():
    """The helper module that speaks to OpenCASCADE; skips where it is not installed."""
    pytest.importorskip("OCP", reason="OpenCASCADE is not installed: uv sync --group oracles")
    from tests.lib import opencascade

    return opencascade


def net_and_weights(seed=3, m=6, n=5):
    rng = np.random.default_rng(seed)
    return rng.random((m, n, 3)), rng.uniform(0.5, 2, (m, n))


# Coons


def by_index(edges):
    """The net blended by index, as if control points lay at i / (m - 1)."""
    return dx.BSplinePatch(dx.coons_net(*(edge.control_points for edge in edges)), 4, 4)


def test_greville_weights_are_exact_and_index_weights_are_off():
    """Ours blends the inner net at Greville abscissae, which is exact; by index it is 0.038 off on a unit patch."""
    edges = spline_edges()
    coons, exact = dx.Coons(*edges), dx.to_bspline(dx.Coons(*edges))
    u, w = T[:, None], T[None, :]
    assert np.abs(exact(u, w) - coons(u, w)).max() < ATOL
    assert 0.03 < np.abs(by_index(edges)(u, w) - coons(u, w)).max() < 0.05


def test_opencascade_blends_coons_nets_by_index():
    """GeomFill's StretchStyle is the net blended by index; its CoonsStyle is neither that, nor bilinear, nor cubic Coons."""
    o, edges = opencascade(), spline_edges()
    c0, c1, d0, d1 = (o.curve(edge) for edge in edges)
    u, w = T[:, None], T[None, :]

    def filled(style):
        styles = o.occ.GeomFill.GeomFill_FillingStyle
        made = o.occ.GeomFill.GeomFill_BSplineCurves(c0, d1, c1, d0, getattr(styles, f"GeomFill_{style}"))
        return o.over(made.Surface(), T, T)

    assert filled("StretchStyle") == pytest.approx(by_index(edges)(u, w), abs=ATOL)
    for ours in (dx.Coons(*edges), dx.Coons(*edges, blend="cubic"), by_index(edges)):
        assert np.abs(filled("CoonsStyle") - ours(u, w)).max() > 0.01


def test_nurbspy_blends_coons_nets_by_index():
    """Its NurbsSurfaceCoons is the net blended by index as well."""
    nurbspy = pytest.importorskip("nurbspy", reason="nurbspy is not installed: uv sync --group oracles")
    edges = spline_edges()
    south, north, west, east = (
        nurbspy.NurbsCurve(np.ascontiguousarray(edge.control_points.T), np.ones(7), 3, edge.knots / edge.knots[-1])
        for edge in edges
    )
    peer = nurbspy.NurbsSurfaceCoons(south, north, west, east).NurbsSurface
    u, w = np.meshgrid(T, T, indexing="ij")
    theirs = peer.get_value(u.ravel(), w.ravel()).T.reshape(41, 41, 3)
    assert theirs == pytest.approx(by_index(edges)(u, w), abs=ATOL)
    assert np.abs(theirs - dx.Coons(*edges)(u, w)).max() > 0.03


def test_coons_is_the_one_of_splipy():
    """splipy's edge_curves is the exact bilinear Coons patch as well."""
    splipy = pytest.importorskip("splipy")
    from splipy import surface_factory

    edges = spline_edges()
    knots = edges[0].knots / edges[0].knots[-1]
    bottom, top, left, right = (splipy.Curve(splipy.BSplineBasis(4, knots), edge.control_points) for edge in edges)
    peer = surface_factory.edge_curves(bottom, right, top, left)
    assert np.abs(dx.Coons(*edges)(T[:, None], T[None, :]) - peer(T, T)).max() < ATOL


# Curvature


def test_curvature_needs_no_question_before_it():
    """OCP's SLProps says 0.0 unless IsCurvatureDefined() was asked first. Ours is right at the first call, on any form."""
    assert dx.to_nurbs(dx.Sphere(2)).curvature(0.3, 0.2).gaussian == pytest.approx(1 / 4, rel=1e-10)
    assert dx.Sphere(2).curvature(0.3, 0.2).k2 == pytest.approx(1 / 2, rel=1e-12)

    occ = opencascade().occ
    sphere = occ.Geom.Geom_SphericalSurface(occ.gp.gp_Ax3(), 2.0)
    cold = occ.GeomLProp.GeomLProp_SLProps(sphere, 0.3, 0.2, 2, 1e-9)
    assert cold.GaussianCurvature() == 0.0
    assert cold.IsCurvatureDefined()
    assert cold.GaussianCurvature() == pytest.approx(1 / 4)


def test_curvature_against_opencascade():
    """Asked as it wants to be asked, OpenCASCADE gives our gaussian curvature."""
    pytest.importorskip("OCP")
    from OCP.Geom import Geom_ToroidalSurface
    from OCP.GeomLProp import GeomLProp_SLProps
    from OCP.gp import gp_Ax3

    torus = Geom_ToroidalSurface(gp_Ax3(), 3.0, 1.0)
    props = GeomLProp_SLProps(torus, 0.5, 2.0, 2, 1e-9)
    assert props.IsCurvatureDefined()
    ours = dx.Torus(3, 1).curvature(2.0 / (2 * pi), 0.5 / (2 * pi)).gaussian  # OpenCASCADE has u round the axis
    assert ours == pytest.approx(props.GaussianCurvature(), rel=1e-10)


# Outside the domain


@pytest.mark.parametrize("outside", [(-1e-9, 0.5), (0.5, 1 + 1e-9), (np.nan, 0.5), (2.0, 2.0)])
def test_outside_the_domain_nothing_is_extrapolated(outside):
    """OCP, rhino3dm and scipy extrapolate; geomdl, splinepy and splipy raise, and so do we."""
    net, weights = net_and_weights()
    for form in (dx.Cylinder(1, 2), dx.BSplinePatch(net, 4, 3), dx.NurbsPatch(net, weights, 4, 3), dx.Coons(*spline_edges())):
        with pytest.raises(dx.DomainError, match=r"\[0, 1\]"):
            form(*outside)


ARCH = [(0.0, 0.0, 0.0), (1.0, 1.0, 0.0), (2.0, 0.0, 0.0)]  # at 1.5 its parabola would be at (3, -1.5, 0)


def test_scipy_opencascade_and_rhino_extrapolate():
    """The parabola of three points, asked for 1.5: no word of warning."""
    assert BSpline([0.0, 0, 0, 1, 1, 1], ARCH, 2)(1.5) == pytest.approx((3, -1.5, 0))
    o = opencascade()
    assert o.xyz(o.occ.Geom.Geom_BezierCurve(o.array1("gp_Pnt", [o.point(p) for p in ARCH])).Value(1.5)).tolist() == [
        3,
        -1.5,
        0,
    ]
    rhino = pytest.importorskip("rhino3dm", reason="rhino3dm is not installed: uv sync --group oracles")
    point = rhino.NurbsCurve.Create(False, 2, [rhino.Point3d(*p) for p in ARCH]).PointAt(1.5)
    assert pytest.approx((3, -1.5)) == (point.X, point.Y)
    with pytest.raises(dx.DomainError):
        dx.BezierCurve(ARCH)(1.5)


def test_geomdl_splipy_and_splinepy_refuse_as_we_do():
    """The same question to the three that raise."""
    geomdl, splipy, splinepy = (pytest.importorskip(name) for name in ("geomdl.BSpline", "splipy", "splinepy"))
    curve = geomdl.Curve()
    curve.degree, curve.ctrlpts, curve.knotvector = 2, ARCH, [0, 0, 0, 1, 1, 1]
    for ask in (
        lambda: curve.evaluate_single(1.5),
        lambda: splipy.Curve(splipy.BSplineBasis(3), ARCH)(1.5),
        lambda: splinepy.Bezier(degrees=[2], control_points=ARCH).evaluate([[1.5]]),
    ):
        with pytest.raises(Exception, match=r"(?i)domain|bounds|between"):
            ask()


# Knots


def test_given_knots_are_kept_and_derivatives_are_by_u():
    """geomdl rescales given knots to [0, 1]. Ours keeps them and says: derivatives are with respect to u in [0, 1]."""
    knots = np.array([2.0, 2, 2, 2, 5, 6, 10, 10, 10, 10])
    points = np.random.default_rng(1).random((6, 3))
    curve = dx.BSplineCurve(points, 4, knots)
    assert np.array_equal(curve.knots, knots)
    s = 2 + 8 * T
    for n in range(4):
        assert curve.derivative(T, n) == pytest.approx(8**n * BSpline(knots, points, 3)(s, n), abs=1e-10)

    geomdl = pytest.importorskip("geomdl.BSpline")
    peer = geomdl.Curve()
    peer.degree, peer.ctrlpts, peer.knotvector = 3, points.tolist(), knots.tolist()
    assert peer.domain == (0, 1)  # not (2, 10), as given


def test_unclamped_knots_are_evaluated_on_their_own_domain():
    """geomdl takes u over all knots, also where the functions do not sum to 1, and carries the end pieces on into nonsense.
    Ours stretches u onto knots[k - 1] to knots[-k]."""
    knots, points = np.arange(9.0), np.random.default_rng(2).random((5, 3))
    curve = dx.BSplineCurve(points, 4, knots)
    assert curve(T) == pytest.approx(BSpline(knots, points, 3)(3 + 2 * T), abs=ATOL)

    geomdl = pytest.importorskip("geomdl.BSpline")
    peer = geomdl.Curve()
    peer.degree, peer.ctrlpts, peer.knotvector = 3, points.tolist(), knots.tolist()
    assert peer.evaluate_single(3 / 8) == pytest.approx(curve(0.0), abs=ATOL)
    assert np.abs(peer.evaluate_single(0.0)).max() > 2 * np.abs(points).max()  # far outside the hull


@pytest.mark.parametrize("times", [4, 5, 6])
@pytest.mark.parametrize("place", ["start", "inside", "end"])
def test_a_knot_more_often_than_the_order(place, times):
    """Any sequence that does not decrease is a knot vector. A knot too often makes functions that are zero everywhere: the
    curve is the one without them, to its very end."""
    start, inner, end = (times if place == where else least for where, least in (("start", 3), ("inside", 1), ("end", 3)))
    knots = [*[0.0] * start, *[0.5] * inner, *[1.0] * end]
    points = np.random.default_rng(4).random((len(knots) - 3, 3))
    curve = dx.BSplineCurve(points, 3, knots)
    live = curve.knot_vector.live
    assert (~live).sum() == times - 3
    kept = dx.BSplineCurve(points[live], 3, np.repeat([0.0, 0.5, 1.0], np.minimum([start, inner, end], 3)))
    assert np.array_equal(curve(T), kept(T))
    assert curve(1.0).tolist() == points[live][-1].tolist()
    for same in (dx.to_bspline(curve), dx.elevate(curve)):
        assert same(T) == pytest.approx(curve(T), abs=ATOL)


def test_peers_at_the_end_of_such_a_knot():
    """Four knots at the end of a quadratic, whose last point is dead: geomdl divides by zero and scipy says (0, 0, 0). splipy
    and splinepy give (4, 0, 0), the end of the curve, and so do we."""
    knots, points = [0.0, 0, 0, 0.5, 1, 1, 1, 1], [(float(i), 0.0, 0.0) for i in range(1, 6)]
    assert dx.BSplineCurve(points, 3, knots)(1.0).tolist() == [4, 0, 0]
    assert dx.BSplineCurve(points, 3, knots)(1 - 1e-12) == pytest.approx((4, 0, 0), abs=1e-10)
    assert BSpline(knots, points, 2)(1.0).tolist() == [0, 0, 0]
    geomdl, splipy, splinepy = (pytest.importorskip(name) for name in ("geomdl.BSpline", "splipy", "splinepy"))
    peer = geomdl.Curve()
    peer.degree, peer.ctrlpts, peer.knotvector = 2, points, knots
    with pytest.raises(ZeroDivisionError):
        peer.evaluate_single(1.0)
    assert splipy.Curve(splipy.BSplineBasis(3, knots), points)(1.0).tolist() == [4, 0, 0]
    assert splinepy.BSpline(degrees=[2], knot_vectors=[knots], control_points=points).evaluate([[1.0]])[0].tolist() == [4, 0, 0]


def test_a_knot_as_often_as_the_order_is_a_gap_with_a_side():
    """The neighbour of the above that must pass: the curve has a gap, and at it the side of growing u."""
    points = np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0), (4, 1, 0), (5, 1, 0), (6, 1, 0)], dtype=float)
    torn = dx.BSplineCurve(points, 3, [0, 0, 0, 1, 1, 1, 2, 2, 2])
    assert torn(0.5).tolist() == [4, 1, 0]
    assert torn(0.5 - 1e-9) == pytest.approx((2, 0, 0), abs=1e-8)


def test_every_curve_can_be_swept():
    """geomdl's sweep_vector raised for all eight curves that were tried. Every curve of ours sweeps, by a vector or a curve."""
    points = [(0, 0, 0), (1, 2, 0), (2, 2, 1), (4, 0, 0)]
    curves = [
        dx.Line((0, 0, 0), (1, 0, 0)), dx.Arc((0, 0, 0), 1, 0, 1), dx.Circle((0, 0, 0), 1), dx.Conic(*points[:3], 2.0),
        dx.HermiteCurve(*points), dx.PointCurve(points), dx.BezierCurve(points), dx.BSplineCurve(points, 3),
        dx.BSplineCurve(points, 3, "periodic"), dx.NurbsCurve(points, [1, 2, 1, 1], 3),
        dx.FunctionCurve(lambda t: np.stack([t, t**2, np.sin(t)], axis=-1)),
    ]  # fmt: skip
    for curve in curves:
        for sweep in (dx.LinearSweep(curve, (0, 0, 1), 2), dx.GenericSweep(curve, dx.Line((0, 0, 0), (0, 0, 2)))):
            assert sweep(T, 0.75) == pytest.approx(curve(T) + (0, 0, 1.5), abs=ATOL)

    geomdl, sweeping = pytest.importorskip("geomdl.BSpline"), pytest.importorskip("geomdl.sweeping")
    peer = geomdl.Curve()
    peer.degree, peer.ctrlpts, peer.knotvector = 2, [list(map(float, p)) for p in points], [0, 0, 0, 0.5, 1, 1, 1]
    with pytest.raises(Exception, match="control points"):
        sweeping.sweep_vector(peer, (0, 0, 2))


# Arcs and revolution


def test_arcs_run_at_constant_speed():
    """A rational quarter circle is at 21.60 degrees at a quarter of its parameter; an arc of ours at 22.5, as those of
    OpenCASCADE and rhino3dm."""
    arc = dx.Arc((0, 0, 0), 1, 0, pi / 2)
    x, y, _ = arc(0.25)
    assert np.degrees(np.arctan2(y, x)) == pytest.approx(22.5, abs=1e-12)
    x, y, _ = dx.to_nurbs(arc)(0.25)
    assert np.degrees(np.arctan2(y, x)) == pytest.approx(21.60, abs=0.005)

    rhino = pytest.importorskip("rhino3dm", reason="rhino3dm is not installed: uv sync --group oracles")
    peer = rhino.ArcCurve.CreateFromArc(rhino.Arc(rhino.Point3d(0, 0, 0), 1.0, pi / 2))
    for form, degrees in ((peer, 22.5), (peer.ToNurbsCurve(), 21.598)):
        point = form.PointAt(form.Domain.T0 + 0.25 * (form.Domain.T1 - form.Domain.T0))
        assert np.degrees(np.arctan2(point.Y, point.X)) == pytest.approx(degrees, abs=1e-3)
    occ = opencascade().occ
    point = occ.Geom.Geom_Circle(occ.gp.gp_Ax2(), 1.0).Value(pi / 8)
    assert np.degrees(np.arctan2(point.Y(), point.X())) == pytest.approx(22.5)


PROFILE = [(1, 0, 0), (3, 0, 1), (1, 0, 2), (2, 0, 3)]


def test_revolution_has_the_angle_in_w_and_no_error_of_the_radius():
    """Ours: u along the curve, w the angle, and every parallel a circle."""
    profile = dx.BezierCurve(PROFILE)
    for turned in (dx.CircularSweep(profile), dx.to_nurbs(dx.CircularSweep(profile))):
        radius = np.hypot(*np.moveaxis(turned(T[:, None], T[None, :]), -1, 0)[:2])
        assert radius == pytest.approx(np.broadcast_to(profile(T)[:, :1], radius.shape), abs=ATOL)
        assert turned(T, 0.0) == pytest.approx(profile(T), abs=ATOL)
    assert dx.CircularSweep(profile)(0.0, 0.25).tolist() == [0, 1, 0]


@pytest.mark.parametrize(("angle", "off"), [(90, 0.06), (180, 0.06), (360, 0.25)])
def test_splinepy_turns_a_polynomial_curve_with_the_wrong_radius(angle, off):
    """Its parallels are parabolas: 6 % off for a quarter and a half turn, 25 % for a whole one. The angle is its second
    parameter."""
    splinepy = pytest.importorskip("splinepy", reason="splinepy is not installed: uv sync --group oracles")
    curve = splinepy.BSpline(
        degrees=[3], knot_vectors=[[0, 0, 0, 0, 1, 1, 1, 1]], control_points=np.array(PROFILE, dtype=float)
    )
    turned = curve.create.revolved(axis=[0, 0, 1], center=[0, 0, 0], angle=angle)
    (u0, w0), (_, w1) = turned.parametric_bounds
    parallel = turned.evaluate([[u0, w] for w in np.linspace(w0, w1, 401)])
    radius = np.hypot(*parallel[:, :2].T)
    assert radius.max() == pytest.approx(1 + off, abs=0.002)
    ours = dx.CircularSweep(dx.BezierCurve(PROFILE), angle=np.radians(angle))(0.0, np.linspace(0, 1, 401))
    assert np.hypot(*ours[:, :2].T) == pytest.approx(np.ones(401), abs=ATOL)


def test_the_angle_is_the_first_parameter_of_opencascade_and_rhino_and_the_second_of_splipy():
    """Three answers to one question; ours is w, the second, as splipy's."""
    line = dx.Line((1, 0, 0), (1, 0, 2))
    assert dx.CircularSweep(line)(0.5, 0.25) == pytest.approx((0, 1, 1), abs=ATOL)
    splipy_factory = pytest.importorskip("splipy").surface_factory
    assert splipy_factory.revolve(pytest.importorskip("splipy").Curve(controlpoints=[(1, 0, 0), (1, 0, 2)]))(0.5, pi / 2) == (
        pytest.approx((0, 1, 1), abs=ATOL)
    )
    rhino = pytest.importorskip("rhino3dm", reason="rhino3dm is not installed: uv sync --group oracles")
    point = rhino.Point3d
    turned = rhino.RevSurface.Create(
        rhino.LineCurve(point(1, 0, 0), point(1, 0, 2)), rhino.Line(point(0, 0, 0), point(0, 0, 1)), 0.0, 2 * pi
    )
    there = turned.PointAt(pi / 2, 1.0)
    assert pytest.approx((0, 1, 1), abs=ATOL) == (there.X, there.Y, there.Z)
    o = opencascade()
    turned = o.occ.Geom.Geom_SurfaceOfRevolution(o.curve(line), o.occ.gp.gp_Ax1())
    assert o.xyz(turned.Value(pi / 2, 0.5)) == pytest.approx((0, 1, 1), abs=ATOL)


def test_revolution_about_an_axis_that_misses_the_origin():
    """splipy's revolve has an axis but no point of it."""
    turned = dx.CircularSweep.about(dx.Line((3, 0, 0), (3, 0, 1)), (2, 0, 0), (0, 0, 1))
    assert turned(0.0, 0.5) == pytest.approx((1, 0, 0), abs=ATOL)
    factory = pytest.importorskip("splipy").surface_factory
    assert list(inspect.signature(factory.revolve).parameters) == ["curve", "theta", "axis"]


def test_the_sphere_says_which_way_its_normals_point():
    """splipy's sphere has inward normals and does not say so. Ours are inward too, and documented; flip_u turns them round."""
    assert "Normals point inward" in dx.Sphere.__doc__
    sphere = dx.Sphere(1)
    points = sphere(T[:, None], T[None, :])
    assert sphere.normal(T[:, None], T[None, :]) == pytest.approx(-points, abs=ATOL)
    assert sphere.flip_u().normal(T[::-1][:, None], T[None, :]) == pytest.approx(points, abs=ATOL)
    peer = pytest.importorskip("splipy").surface_factory.sphere(1)
    assert peer.normal(0.3, 0.4) == pytest.approx(-peer(0.3, 0.4), abs=ATOL)
    assert "normal" not in pytest.importorskip("splipy").surface_factory.sphere.__doc__


def test_rational_second_derivatives_at_scattered_points():
    """splipy's rational second derivatives raise with tensor=False. Ours are those of the grid."""
    net, weights = net_and_weights()
    patch = dx.NurbsPatch(net, weights, 4, 3)
    for order in ((2, 0), (1, 1), (0, 2)):
        grid = patch.derivative(T[:, None], T[None, :], *order)
        scattered = patch.derivative(*np.meshgrid(T, T, indexing="ij"), *order)
        assert scattered == pytest.approx(grid, abs=1e-8)  # second derivatives here reach 1e3
    splipy = pytest.importorskip("splipy")
    bases = [splipy.BSplineBasis(k, np.repeat([0.0, *range(1, c - k + 1), c - k + 1], [k, *[1] * (c - k), k])) for c, k in
             ((6, 4), (5, 3))]  # fmt: skip
    lifted = np.concatenate([net * weights[..., None], weights[..., None]], axis=2)
    peer = splipy.Surface(*bases, lifted.transpose(1, 0, 2).reshape(-1, 4), rational=True)
    with pytest.raises(Exception):  # noqa: B017 - whatever it is that breaks there
        peer.derivative([0.5, 1.0], [0.5, 1.0], (2, 0), tensor=False)


# Normals


def test_normals_of_many_points():
    """nurbspy's get_normals killed the process (with numba 0.68.1, not at hand). Ours are numpy: 40,000 unit normals, grid and
    scattered alike; and those of nurbspy without numba are the same."""
    net, weights = net_and_weights()
    patch, t = dx.NurbsPatch(net, weights, 4, 3), np.linspace(0, 1, 200)
    normals = patch.normal(t[:, None], t[None, :])
    assert np.linalg.norm(normals, axis=-1) == pytest.approx(np.ones((200, 200)), abs=ATOL)
    assert patch.normal(*np.meshgrid(t, t, indexing="ij")) == pytest.approx(normals, abs=1e-9)

    nurbspy = pytest.importorskip("nurbspy", reason="nurbspy is not installed: uv sync --group oracles")
    knots = [values / values[-1] for values in (patch.knots_u, patch.knots_w)]
    peer = nurbspy.NurbsSurface(net.transpose(2, 0, 1), weights, 3, 2, *knots)
    u, w = np.meshgrid(t[1:-1:9], t[1:-1:9], indexing="ij")
    assert peer.get_normals(u.ravel(), w.ravel()).T.reshape(*u.shape, 3) == pytest.approx(normals[1:-1:9, 1:-1:9], abs=1e-9)


def test_degenerate_normals_are_the_limit_and_never_nan():
    """At poles and apexes most peers divide by zero or return what rounding leaves; ours is the limit, or (0, 0, 0)."""
    assert dx.Sphere(2).normal([0.0, 1.0], 0.3).tolist() == [[0, 0, 1], [0, 0, -1]]
    apex = dx.Cone(1, 0, 1).normal(0.0, 1.0)
    assert apex == pytest.approx((sqrt(0.5), 0, sqrt(0.5)), abs=1e-9)
    collapsed = dx.LinearSweep(dx.Line((0, 0, 0), (1, 0, 0)), (1, 0, 0), 1)
    assert collapsed.normal(T, T).tolist() == np.zeros((41, 3)).tolist()


def test_the_normal_on_a_collapsed_edge():
    """A triangle as a bilinear patch: splipy says NaN, geomdl raises, OpenCASCADE says that a cone's apex has none."""
    assert dx.Bilinear((0, 0, 0), (0, 0, 0), (1, 0, 0), (0, 1, 0)).normal(0, 0.5) == pytest.approx((0, 0, 1), abs=ATOL)
    splipy, geomdl, operations = (pytest.importorskip(name) for name in ("splipy", "geomdl.BSpline", "geomdl.operations"))
    net = [(0, 0, 0), (1, 0, 0), (0, 0, 0), (0, 1, 0)]  # the first parameter fastest
    with np.errstate(invalid="ignore"):
        assert np.isnan(splipy.Surface(splipy.BSplineBasis(2), splipy.BSplineBasis(2), net).normal(0, 0.5)).all()
    peer = geomdl.Surface()
    peer.degree_u = peer.degree_v = 1
    peer.set_ctrlpts([list(map(float, net[i])) for i in (0, 2, 1, 3)], 2, 2)
    peer.knotvector_u = peer.knotvector_v = [0, 0, 1, 1]
    with pytest.raises(ValueError, match="magnitude"):
        operations.normal(peer, (0.0, 0.5))
    occ = opencascade().occ
    cone = occ.Geom.Geom_ConicalSurface(occ.gp.gp_Ax3(), -pi / 4, 1.0)
    assert not occ.GeomLProp.GeomLProp_SLProps(cone, 0.3, sqrt(2), 2, 1e-9).IsNormalDefined()


def test_both_sides_of_a_crease_can_be_had():
    """Of the peers only splipy lets the caller choose the side. Ours is that of growing u; the other is the end of the part
    before it."""
    net = np.array([[(x, y, abs(x - 2)) for y in (0.0, 1.0)] for x in (0, 1, 2, 3, 4)])
    roof = dx.BSplinePatch(net, 3, 2, [0, 0, 0, 1, 1, 2, 2, 2])
    after, before = roof.derivative(0.5, 0.5, 1, 0), roof.patch(0, 0.5, 0, 1).derivative(1, 0.5, 1, 0) / 0.5
    assert after == pytest.approx((4, 0, 4))
    assert before == pytest.approx((4, 0, -4))
    assert roof.split(u=0.5)[1].normal(0, 0.5) == pytest.approx(roof.normal(0.5, 0.5))
    splipy = pytest.importorskip("splipy")
    peer = splipy.Curve(splipy.BSplineBasis(3, [0, 0, 0, 1, 1, 2, 2, 2]), net[:, 0])
    assert peer.derivative(1.0) == pytest.approx(after / 2)
    assert peer.derivative(1.0, above=False) == pytest.approx(before / 2)


# Layouts


def test_the_order_of_control_points():
    """splinepy lists them with u fastest, geomdl with v fastest, splipy wants them multiplied by the weight, rhino3dm leaves
    out the outer knots. Ours: net[i, j] with i along u, Cartesian, all m + k knots."""
    net, weights = net_and_weights()
    patch = dx.NurbsPatch(net, weights, 4, 3)
    assert patch(1.0, 0.0) == pytest.approx(net[-1, 0], abs=ATOL)
    assert patch(0.0, 1.0) == pytest.approx(net[0, -1], abs=ATOL)
    assert len(patch.knots_u) == 6 + 4
    assert len(patch.knots_w) == 5 + 3
    geomdl = pytest.importorskip("geomdl.NURBS").Surface()
    geomdl.degree_u, geomdl.degree_v = 3, 2
    lifted = np.concatenate([net * weights[..., None], weights[..., None]], axis=2)
    geomdl.set_ctrlpts(lifted.reshape(-1, 4).tolist(), 6, 5)
    geomdl.knotvector_u, geomdl.knotvector_v = patch.knots_u.tolist(), patch.knots_w.tolist()
    assert patch(0.3, 0.8) == pytest.approx(geomdl.evaluate_single((0.3, 0.8)), abs=ATOL)
    rhino = pytest.importorskip("rhino3dm", reason="rhino3dm is not installed: uv sync --group oracles")
    peer = rhino.NurbsSurface.Create(3, True, 4, 3, 6, 5)
    assert (len(peer.KnotsU), len(peer.KnotsV)) == (6 + 4 - 2, 5 + 3 - 2)


def test_the_order_of_splinepy():
    """The same surface in splinepy: transposed, and its weights beside the points."""
    splinepy = pytest.importorskip("splinepy")
    net, weights = net_and_weights()
    patch = dx.NurbsPatch(net, weights, 4, 3)
    knots = [patch.knots_u / patch.knots_u[-1], patch.knots_w / patch.knots_w[-1]]
    points, h = net.transpose(1, 0, 2).reshape(-1, 3), weights.T.reshape(-1, 1)
    peer = splinepy.NURBS(degrees=[3, 2], knot_vectors=knots, control_points=points, weights=h)
    assert patch([0.3, 0.7], [0.8, 0.1]) == pytest.approx(peer.evaluate([[0.3, 0.8], [0.7, 0.1]]), abs=ATOL)
