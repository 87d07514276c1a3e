"""Conversions: there and back, printed values, exact sets for what turns, honest errors for what has no such form."""

import json
from pathlib import Path

import directrix as dx
import numpy as np
import pytest
from directrix.conversion.strands import Strand, bezier_strand, common, times
from directrix.errors import ConversionError, DomainError, GeometryError, KnotError, OrderError
from geomdl import operations
from geomdl.BSpline import Curve as GeomdlCurve
from hypothesis import given, settings
from hypothesis import strategies as st

PRINTED = json.loads((Path(__file__).parents[1] / "surfaces" / "syllabus_data.json").read_text())
G, BP = np.array(PRINTED["G"], dtype=float), np.array(PRINTED["BP"], dtype=float)
T = np.linspace(0, 1, 17)
U, W = T[:, None], T[None, ::2]
seeds = st.integers(0, 2**32 - 1)
fixed = settings(derandomize=True, max_examples=25, deadline=None)
few = settings(fixed, max_examples=6)


def curves(rng):
    """One of each curve that is polynomial, then one of each that is rational."""
    p = rng.standard_normal((7, 3))
    plain = [
        dx.Line(p[0], p[1]),
        dx.BezierCurve(p[: rng.integers(2, 6)]),
        dx.HermiteCurve(*p[:4]),
        dx.PointCurve(p[:5], [0, 0.2, 0.5, 0.6, 1]),
        dx.BSplineCurve(p, 4, [0, 0, 0, 0, 0.2, 0.2, 0.7, 1, 1, 1, 1]),
        dx.BSplineCurve(p, 3, "periodic"),
        dx.BSplineCurve(p, 4, "uniform"),
        dx.Transform.rotate("x", 1.0) @ dx.PointCurve(p[:4]).segment(0.9, 0.2),
    ]
    weights = rng.uniform(0.5, 2, 7)
    rational = [dx.NurbsCurve(p, weights, 4), dx.NurbsCurve(p, weights, 3, "periodic"), dx.Conic(*p[:3], weights[0])]
    return plain, rational


def between(rng, a, b, kind):
    """A curve from a to b: Bezier, B-spline, conic, or NURBS."""
    q = rng.standard_normal((4, 3))
    if kind == 0:
        return dx.BezierCurve([a, *q[:2], b])
    if kind == 1:
        return dx.BSplineCurve([a, *q, b], 3, [0, 0, 0, 0.1, 0.4, 0.4, 1, 1, 1])
    if kind == 2:
        return dx.Conic(a, q[0], b, rng.uniform(0.4, 2))
    return dx.NurbsCurve([a, *q, b], rng.uniform(0.5, 2, 6), 4)


def patches(rng):
    """One of each surface that is polynomial."""
    net = rng.standard_normal((4, 3, 3))
    p = net.reshape(-1, 3)
    return [
        dx.AlgebraicPatch(net),
        dx.HermitePatch(rng.standard_normal((4, 4, 3))),
        dx.Ferguson(*rng.standard_normal((3, 2, 2, 3))),
        dx.PointPatch(net, (0, 0.25, 0.75, 1)),
        dx.BezierPatch(net),
        dx.Bilinear(*p[:4]),
        dx.Plane(*p[:3]),
        dx.Triangle(*p[:3]),
    ]


@fixed
@given(seeds)
def test_curves_keep_every_point(seed):
    """to_bspline and to_nurbs of a curve are the same curve, parameter for parameter; a rational one is no B-spline."""
    plain, rational = curves(np.random.default_rng(seed))
    for curve in plain:
        np.testing.assert_allclose(dx.to_bspline(curve)(T), curve(T), atol=1e-11)
        assert type(dx.to_nurbs(curve)) is dx.NurbsCurve
    for curve in [*plain, *rational]:
        nurbs = dx.to_nurbs(curve)
        np.testing.assert_allclose(nurbs(T), curve(T), atol=1e-11)
        np.testing.assert_allclose(nurbs.derivative(T[1:-1]), curve.derivative(T[1:-1]), atol=1e-8)
        knots = nurbs.knots
        assert knots[0] == knots[nurbs.order - 1]  # clamped
        assert knots[-1] == knots[-nurbs.order]
    for curve in rational:
        with pytest.raises(ConversionError, match="is rational, its weights differ"):
            dx.to_bspline(curve)


@fixed
@given(seeds)
def test_single_patches_there_and_back(seed):
    """Every polynomial patch through every polynomial form that holds it: the same points, and the same kind again."""
    rng = np.random.default_rng(seed)
    for patch in patches(rng):
        for form in (patch, patch.swap(), dx.Transform.rotate((1, 2, 3), 0.5) @ patch, patch.patch(0.9, 0.2, 0.1, 0.8)):
            expected = form(U, W)
            for convert in (dx.to_bezier, dx.to_algebraic, dx.to_points, dx.to_bspline, dx.to_nurbs, dx.to_hermite):
                np.testing.assert_allclose(convert(form)(U, W), expected, atol=1e-11)
    hermite = dx.HermitePatch(rng.standard_normal((4, 4, 3)))
    for convert in (dx.to_bezier, dx.to_algebraic, dx.to_points, dx.to_bspline):
        np.testing.assert_allclose(dx.to_hermite(convert(hermite)).G, hermite.G, atol=1e-11)
    bezier = dx.BezierPatch(rng.standard_normal((5, 3, 3)))
    for convert in (dx.to_algebraic, dx.to_points, dx.to_bspline):
        np.testing.assert_allclose(dx.to_bezier(convert(bezier)).control_net, bezier.control_net, atol=1e-11)
    chosen = dx.to_points(bezier, tu=(0, 0.1, 0.5, 0.8, 1))
    np.testing.assert_allclose(chosen(U, W), bezier(U, W), atol=1e-12)


def test_printed_values():
    """The course's oracles: Bezier to Hermite, Hermite to Bezier, geometric to algebraic."""
    assert dx.to_hermite(dx.BezierPatch(BP)).G[0, :3].tolist() == [[-2, 2, 2], [-1, 14, -2], [9, 0, -12]]
    net = dx.to_bezier(dx.HermitePatch(G)).control_net[0, :3]
    np.testing.assert_allclose(net, [(0, 0, 0), (1 / 3, 5 / 3, 2 / 3), (4 / 3, 3, -1 / 3)], rtol=1e-15)
    assert dx.to_algebraic(dx.HermitePatch(G)).a[0, :3].tolist() == [[0, 0, 0], [1, 5, 2], [2, -1, -5]]


def test_sixteen_points_by_the_printed_matrix():
    """Points at thirds to Bezier points by K P Kᵀ, K = [[6,0,0,0],[-5,18,-9,2],[2,-9,18,-5],[0,0,0,6]]/6."""
    K = np.array([[6, 0, 0, 0], [-5, 18, -9, 2], [2, -9, 18, -5], [0, 0, 0, 6]]) / 6
    expected = np.einsum("ik,jl,klc->ijc", K, K, BP)
    np.testing.assert_allclose(dx.to_bezier(dx.PointPatch(BP)).control_net, expected, atol=1e-12)


@few
@given(seeds)
def test_surfaces_of_curves(seed):
    """Ruled, swept and Coons surfaces of polynomial and rational curves of different degrees, knots and weights: exact."""
    rng = np.random.default_rng(seed)
    p = rng.standard_normal((2, 2, 3))
    kinds = rng.integers(0, 4, 4)
    c0, c1 = (between(rng, p[0, j], p[1, j], kinds[j]) for j in (0, 1))
    d0, d1 = (between(rng, p[i, 0], p[i, 1], kinds[2 + i]) for i in (0, 1))
    forms = [
        dx.Ruled(c0, c1),
        dx.LinearSweep(c0, (1, 2, 3), 2.0),
        dx.GenericSweep(c0, d0),
        dx.GenericSweep(c0, d1, taper=0.3),
        dx.Coons(c0, c1, d0, d1),
        dx.Coons(c0, c1, d0, d1, blend="cubic"),
    ]
    for form in forms:
        for shape in (form, form.swap(), form.patch(0.7, 0.1, 0.2, 0.9), dx.Transform.rotate("y", 0.4) @ form):
            np.testing.assert_allclose(dx.to_nurbs(shape)(U, W), shape(U, W), atol=1e-9)
        if max(kinds) < 2:
            np.testing.assert_allclose(dx.to_bspline(form)(U, W), form(U, W), atol=1e-11)


def test_coons_of_beziers_is_the_discrete_coons_net():
    """Four Bezier cubics: the net that the conversion finds is the discrete Coons net."""
    rng = np.random.default_rng(2)
    p = rng.standard_normal((2, 2, 3))
    ends = [(p[0, 0], p[1, 0]), (p[0, 1], p[1, 1]), (p[0, 0], p[0, 1]), (p[1, 0], p[1, 1])]
    polygons = [np.array([a, *rng.standard_normal((2, 3)), b]) for a, b in ends]
    net = dx.to_bezier(dx.Coons(*(dx.BezierCurve(q) for q in polygons))).control_net
    np.testing.assert_allclose(net, dx.coons_net(*polygons), atol=1e-14)


@pytest.mark.parametrize("angle", [0.4, np.pi / 2, 2.0, -3.0, 2 * np.pi])
def test_arcs_keep_their_points_ends_and_middles(angle):
    """A rational arc lies on its circle and meets the arc at ends and middles of its pieces; in between its speed differs."""
    arc = dx.Arc((1, 2, 3), 2, 0.3, 0.3 + angle, (1, 1, 1))
    nurbs = dx.to_nurbs(arc)
    np.testing.assert_allclose(np.linalg.norm(nurbs(T) - (1, 2, 3), axis=1), 2, rtol=1e-14)
    pieces = len(nurbs.breaks()) - 1
    assert pieces == np.ceil(abs(angle) / (np.pi / 2) - 1e-9)
    at = np.linspace(0, 1, 2 * pieces + 1)
    np.testing.assert_allclose(nurbs(at), arc(at), atol=1e-14)
    assert np.abs(nurbs(0.3 / pieces) - arc(0.3 / pieces)).max() > 1e-6
    part = dx.to_nurbs(arc.segment(0.9, 0.3))
    np.testing.assert_allclose(part([0, 1]), arc([0.9, 0.3]), atol=1e-14)


@pytest.mark.parametrize(
    "form",
    [dx.Cylinder(2, 3), dx.Cone(2, 1, 3), dx.Cone(2, 0, 3), dx.Cone(0, 2, 3), dx.Sphere(2), dx.Torus(3, 1), dx.Torus(0, 1)],
)
def test_known_forms_are_their_quadrics(form):
    """NURBS of the known forms, whole, in part, moved: on the quadric (or torus) to rounding, with the same corners."""
    for shape in (form, form.patch(0.1, 0.77, 0.9, 0.3), form.swap().patch(0, 0.5, 0.2, 1)):
        points = dx.to_nurbs(shape)(U, W)
        if isinstance(form, dx.Torus):
            off = (np.hypot(points[..., 0], points[..., 1]) - form.R) ** 2 + points[..., 2] ** 2 - form.r**2
        else:
            off = form.implicit()(points)
        assert np.abs(off).max() < 1e-12
        np.testing.assert_allclose(points[[0, 0, -1, -1], [0, -1, 0, -1]], shape([0, 0, 1, 1], [0, 1, 0, 1]), atol=1e-13)
    T3 = dx.Transform.rotate((1, 1, 0), 0.8, (1, 2, 3))
    np.testing.assert_allclose(dx.to_nurbs(T3 @ form)(U, W), T3 @ dx.to_nurbs(form)(U, W), atol=1e-13)


def test_areas_agree_where_speeds_differ():
    """The NURBS of a turned surface covers it once: the same area."""
    for form in (dx.Cylinder(2, 3), dx.Torus(3, 1), dx.Sphere(2)):
        assert dx.to_nurbs(form).area() == pytest.approx(form.area(), rel=1e-8)


def test_revolved_about_any_axis():
    """Part of a turn of a Bezier profile about a skew axis: each parallel on its circle, edges and middle exact."""
    profile = dx.BezierCurve([(2, 0, 0), (3, 1, 1), (2, 0, 3), (4, 4, 4)])
    sweep = dx.CircularSweep.about(profile, (1, -1, 0), (1, 2, 2), 2.5)
    nurbs = dx.to_nurbs(sweep)
    for w in (0.0, 0.25, 0.5, 0.75, 1.0):
        np.testing.assert_allclose(nurbs(T, w), sweep(T, w), atol=1e-13)
    v = nurbs(U, W) - (1, -1, 0)
    k = np.array([1, 2, 2]) / 3
    np.testing.assert_allclose(v @ k, np.broadcast_to((sweep(T, 0.0) - (1, -1, 0)) @ k, (9, 17)).T, atol=1e-12)
    np.testing.assert_allclose(dx.to_nurbs(sweep.patch(0.2, 0.9, 0.1, 0.4))([0, 1], 1.0), sweep([0.2, 0.9], 0.4), atol=1e-13)


def test_arcs_joined_to_other_curves_are_refused():
    """A Coons patch with an arc at constant speed has no spline form; with the rational arc in its place it has."""
    arc = dx.Arc((0, 0, 0), 2, 0, np.pi / 2)
    a, b = arc(0.0), arc(1.0)
    up = np.array([0, 0, 3.0])
    others = dx.Line(a + up, b + up), dx.Line(a, a + up), dx.Line(b, b + up)
    for form in (dx.Coons(arc, *others), dx.Ruled(arc, others[0]), dx.GenericSweep(others[0], arc, taper=0.5)):
        with pytest.raises(ConversionError, match="arc at constant speed"):
            dx.to_nurbs(form)
    rational = dx.Coons(dx.to_nurbs(arc), *others)
    np.testing.assert_allclose(dx.to_nurbs(rational)(U, W), rational(U, W), atol=1e-13)
    equal = dx.Ruled(dx.Circle((0, 0, 0), 2), dx.Circle((0, 0, 3), 1))
    np.testing.assert_allclose(dx.Cone(2, 1, 3).implicit()(dx.to_nurbs(equal)(U, W)), 0, atol=1e-13)
    carried = dx.GenericSweep(dx.Line((0, 0, 0), (0, 0, 1)), arc)
    np.testing.assert_allclose(
        dx.to_nurbs(carried.patch(0, 1, 0.3, 0.8))([0, 1], [0, 1]), carried([0, 1], [0.3, 0.8]), atol=1e-14
    )


def test_what_has_no_form_says_so():
    arch = dx.BezierCurve([(0, 0, 0), (1, 2, 0), (2, 0, 0)])
    cases = [
        (
            lambda: dx.to_nurbs(dx.FunctionCurve(lambda t: np.stack([t, t, t], axis=-1))),
            "FunctionCurve has no exact spline form",
        ),
        (lambda: dx.to_nurbs(dx.GenericSweep(arch, arch, frame="minimal")), "'minimal' frame has no exact"),
        (lambda: dx.to_bezier(dx.Sphere(1)), "is rational"),
        (lambda: dx.to_bezier(dx.BSplinePatch(BP, 3, 3)), "of 2 x 2 polynomial pieces"),
        (lambda: dx.to_hermite(dx.BezierPatch(np.ones((6, 2, 3)))), "degree 5 has no cubic Hermite form"),
        (lambda: dx.to_algebraic(arch), "for surfaces"),
        (lambda: dx.to_points(dx.BezierHyperpatch(np.ones((2, 2, 2, 3)))), "for curves and surfaces"),
        (lambda: dx.elevate(dx.Sphere(1)), "needs control points"),
        (lambda: dx.to_nurbs("patch"), "a str has no exact spline form"),
    ]
    for make, message in cases:
        with pytest.raises(ConversionError, match=message):
            make()


@fixed
@given(seeds)
def test_solids_there_and_back(seed):
    """Hyperpatches through each other's form."""
    rng = np.random.default_rng(seed)
    hermite = dx.HermiteHyperpatch(rng.standard_normal((4, 4, 4, 3)))
    at = rng.random((3, 9))
    for convert in (dx.to_bezier, dx.to_bspline, dx.to_nurbs):
        np.testing.assert_allclose(convert(hermite)(*at), hermite(*at), atol=1e-12)
    np.testing.assert_allclose(dx.to_hermite(dx.to_bezier(hermite)).G, hermite.G, atol=1e-12)
    low = dx.BezierHyperpatch(rng.standard_normal((2, 3, 4, 3)))
    np.testing.assert_allclose(dx.to_hermite(low)(*at), low(*at), atol=1e-12)


@few
@given(seeds)
def test_refinements_leave_the_form(seed):
    """Elevation, knot insertion and its removal: other nets, the same points."""
    rng = np.random.default_rng(seed)
    plain, rational = curves(rng)
    for curve in [*plain[4:7], *rational[:2], plain[1]]:
        high = dx.elevate(curve, 2)
        assert high.degree == curve.degree + 2
        np.testing.assert_allclose(high(T), curve(T), atol=1e-11)
        at = float(rng.random())
        finer = dx.insert_knot(curve, at)
        np.testing.assert_allclose(finer(T), curve(T), atol=1e-11)
        back = dx.remove_knot(finer, at)
        assert len(back.control_points) == len(finer.control_points) - 1
        np.testing.assert_allclose(back(T), curve(T), atol=1e-7)
    net, weights = rng.standard_normal((5, 6, 3)), rng.uniform(0.5, 2, (5, 6))
    for patch in (dx.BSplinePatch(net, 3, 4), dx.NurbsPatch(net, weights, 4, 3, "uniform", "periodic"), dx.BezierPatch(net)):
        high = dx.elevate(patch, u=1, w=2)
        assert type(high) is type(patch)
        assert high.degrees == (patch.degrees[0] + 1, patch.degrees[1] + 2)
        np.testing.assert_allclose(high(U, W), patch(U, W), atol=1e-10)
        np.testing.assert_allclose(dx.insert_knot(patch, 0.3, 0.6, times=2)(U, W), patch(U, W), atol=1e-10)


@fixed
@given(seeds)
def test_insertion_against_geomdl(seed):
    """The control points are those that another library computes."""
    rng = np.random.default_rng(seed)
    points = rng.standard_normal((7, 3))
    curve = dx.BSplineCurve(points, 4)
    peer = GeomdlCurve()
    peer.degree, peer.ctrlpts = 3, points.tolist()
    peer.knotvector = curve.knots.tolist()
    at = float(rng.uniform(0.01, 0.99))
    inserted = operations.insert_knot(peer, [at], [1], check_num=False)
    np.testing.assert_allclose(dx.insert_knot(curve, at).control_points, inserted.ctrlpts, atol=1e-12)


@few
@given(seeds)
def test_bezier_pieces(seed):
    """The pieces of a B-spline, put side by side, are the B-spline; de Casteljau's two halves are the halves."""
    rng = np.random.default_rng(seed)
    patch = dx.BSplinePatch(rng.standard_normal((6, 5, 3)), 4, 3, "uniform", [0, 0, 0, 0.1, 0.7, 1, 1, 1])
    pieces = dx.split_bezier(patch)
    us, ws = patch.breaks()
    assert (len(pieces), len(pieces[0])) == (len(us) - 1, len(ws) - 1)
    for i, row in enumerate(pieces):
        for j, piece in enumerate(row):
            inner = patch(us[i] + (us[i + 1] - us[i]) * U, ws[j] + (ws[j + 1] - ws[j]) * W)
            np.testing.assert_allclose(piece(U, W)[:-1, :-1], inner[:-1, :-1], atol=1e-11)
    low, high = dx.split_bezier(dx.BezierPatch(BP), u=0.25)
    np.testing.assert_allclose(low(U, W), dx.BezierPatch(BP)(U / 4, W), atol=1e-13)
    np.testing.assert_allclose(high(U, W), dx.BezierPatch(BP)(0.25 + 0.75 * U, W), atol=1e-13)
    assert len(dx.split_bezier(dx.BSplineCurve(BP[0], 2))) == 3


def test_exact_dyadic_refinements():
    """Halving and elevating by dyadic ratios rounds nothing."""
    arch = dx.BezierCurve([(0, 0, 0), (4, 8, 0), (8, 0, 0)])
    assert [half.control_points.tolist() for half in dx.split_bezier(arch, 0.5)] == [
        [[0, 0, 0], [2, 4, 0], [4, 4, 0]],
        [[4, 4, 0], [6, 4, 0], [8, 0, 0]],
    ]
    line = dx.elevate(dx.BezierCurve([(0, 0, 0), (8, 0, 4)]), 3)
    assert line.control_points[:, 0].tolist() == [0, 2, 4, 6, 8]


@fixed
@given(seeds)
def test_strands_add_and_multiply(seed):
    """Sums on common knots and products are those of the values, knots with multiplicities included."""
    rng = np.random.default_rng(seed)

    def value(s):
        return dx.BSplineCurve(np.repeat(s.points, 3, axis=1), s.order, s.knots)(T)[:, 0]

    a = Strand(rng.standard_normal((5, 1)), np.array([0, 0, 0, 0.25, 0.25, 1, 1, 1.0]), 3)
    b = Strand(rng.standard_normal((6, 1)), np.array([0, 0, 0, 0, 0.25, 0.5, 1, 1, 1, 1]), 4)
    c = bezier_strand(rng.standard_normal((2, 1)))
    f, g, h = common([a, b, c])
    assert np.array_equal(f.knots, g.knots)
    np.testing.assert_allclose(value(f) + value(g) + value(h), value(a) + value(b) + value(c), atol=1e-12)
    np.testing.assert_allclose(value(times(a, b)), value(a) * value(b), atol=1e-12)
    torn = Strand(rng.standard_normal((6, 1)), np.array([0, 0, 0, 0.5, 0.5, 0.5, 1, 1, 1.0]), 3)
    np.testing.assert_allclose(value(times(torn, c)), value(torn) * value(c), atol=1e-12)


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (lambda c: dx.insert_knot(c, 0.0), DomainError, "strictly between 0 and 1"),
        (lambda c: dx.insert_knot(c), OrderError, "say where"),
        (lambda c: dx.insert_knot(c, w=0.5), OrderError, "one parameter"),
        (lambda c: dx.insert_knot(c, 0.5, times=5), KnotError, "at most order = 4 times"),
        (lambda c: dx.insert_knot(c, 0.5, times=0), OrderError, "times must be a whole number"),
        (lambda c: dx.remove_knot(c, 0.5), KnotError, "no knot to remove"),
        (lambda c: dx.remove_knot(dx.BSplineCurve([*BP[0], *BP[1]], 4), 0.2), KnotError, "cannot be removed 1 times"),
        (lambda c: dx.elevate(c, w=1), OrderError, "one parameter"),
        (lambda c: dx.elevate(c, -1), OrderError, "u must be a whole number"),
        (lambda c: dx.split_bezier(c, 0.5, 0.5), OrderError, "not both"),
        (lambda c: dx.split_bezier(c, w=0.5), OrderError, "give u"),
        (lambda c: dx.to_points(c, (0, 0.5, 1)), GeometryError, r"tu must have shape \(4,\)"),
    ],
)
def test_bad_input_is_named(make, error, message):
    with pytest.raises(error, match=message):
        make(dx.BezierCurve(BP[0]))
