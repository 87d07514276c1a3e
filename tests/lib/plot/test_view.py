"""view: what stands in a figure, and that its scale, colours and hover are right."""

import subprocess
import sys

import directrix as dx
import numpy as np
import pytest
from directrix.errors import GeometryError, ShapeError
from directrix.plot import palette, view


def named(figure, name):
    return [trace for trace in figure.data if trace.name == name]


def test_axes_have_one_scale(tube):
    """The ratio of the axes is that of their ranges, so a circle looks round."""
    scene = view(tube).layout.scene
    ranges = np.array([np.ptp(scene[f"{axis}axis"].range) for axis in "xyz"])
    ratio = np.array([scene.aspectratio[axis] for axis in "xyz"])
    assert scene.aspectmode == "manual"
    np.testing.assert_allclose(ratio / ratio[0], ranges / ranges[0], rtol=1e-12)
    assert scene.xaxis.range[0] < -2 < 2 < scene.xaxis.range[1]


def test_hover_data_are_transposed_for_plotly(saddle):
    """customdata[j][i] holds (u_i, w_j): plotly.js looks them up with rows and columns exchanged."""
    surface = view(saddle, samples=5).data[0]
    assert surface.customdata.shape == (5, 5, 2)
    assert surface.customdata[1, 3].tolist() == [0.75, 0.25]
    assert (surface.x[3, 1], surface.y[3, 1]) == (0.75, 0.25)


def test_lines_along_u_hold_w_and_carry_the_colour_of_u(saddle):
    """On every blue line y = w is constant, on every orange one x = u."""
    figure = view(saddle, samples=33)
    for colour, held in ((palette.U, "y"), (palette.W, "x")):
        lines = [
            trace for trace in figure.data if trace.type == "scatter3d" and trace.line.color == colour and trace.mode == "lines"
        ]
        assert lines
        for trace in lines:
            values, running = np.asarray(trace[held]), np.asarray(trace["x" if held == "y" else "y"])
            pieces = np.split(np.arange(len(values)), np.flatnonzero(np.isnan(values)))
            assert all(np.nanstd(values[piece]) < 5e-3 < np.nanstd(running[piece]) for piece in pieces if len(piece) > 2)


def test_lines_lie_at_eighths(saddle):
    """The inner lines are at w = 1/8 ... 7/8, on both sides of the surface."""
    inner = next(trace for trace in view(saddle).data if trace.name == "along u" and trace.line.width < 2)
    at = np.unique(np.asarray(inner.y, dtype=float)[~np.isnan(inner.y)])
    assert set(np.round(at * 8)) == set(range(1, 8))
    assert (np.abs(at * 8 - np.round(at * 8)) < 0.03).all()  # the lift


def test_one_line_a_range_draws_the_edges_only(saddle):
    """lines=1 leaves the inner lines out."""
    assert {trace.line.width for trace in named(view(saddle, lines=1), "along u")} == {5}


def test_net_shows_the_index_of_each_point(saddle):
    """Control points tell P[i, j]."""
    net = np.arange(24.0).reshape(2, 4, 3)
    dots = named(view(saddle, net=net), "control points")[0]
    assert list(dots.text[:5]) == ["P[0, 0]", "P[0, 1]", "P[0, 2]", "P[0, 3]", "P[1, 0]"]
    with pytest.raises(ShapeError, match=r"net must have shape \(m, n, 3\).*got \(4, 2\)"):
        view(saddle, net=np.zeros((4, 2)))


def test_the_picture_grows_to_hold_the_net(saddle):
    """A control point far above the surface is inside the axes."""
    net = np.array([[[0, 0, 0], [0, 1, 9.0]], [[1, 0, 0], [1, 1, 0]]])
    assert view(saddle, net=net).layout.scene.zaxis.range[1] > 9


def test_normals_are_those_of_the_surface():
    """A form with .normal is asked; the needles of a sphere of the library point inwards."""
    needles = named(view(dx.Sphere(2.0), normals=True), "normals")[0]
    points = np.stack([needles.x, needles.y, needles.z], axis=-1)
    start, end = points[::3], points[1::3]
    assert len(start) >= 49
    assert (np.linalg.norm(end, axis=1) < np.linalg.norm(start, axis=1)).all()


def test_curvature_colours_both_signs_alike():
    """The bar is symmetric about zero, so the pale colour is a flat place."""
    surface = view(dx.Torus(3.0, 1.0), colour="gaussian").data[0]
    assert surface.cmin == -surface.cmax
    assert surface.lighting.diffuse == 0.0
    with pytest.raises(GeometryError, match=r"needs a surface that has \.curvature"):
        view(lambda u, w: np.zeros((*np.broadcast_shapes(u.shape, w.shape), 3)), colour="mean")
    with pytest.raises(GeometryError, match="'gaussian', 'mean'; got 'red'"):
        view(dx.Torus(3.0, 1.0), colour="red")


def test_knot_lines_lie_at_the_knots(saddle):
    """Lines of constant u at the knots of u, of constant w at those of w."""
    knots = named(view(saddle, knots=([0.5], [0.25])), "knots")[0]
    pieces = np.split(np.stack([knots.x, knots.y]), np.flatnonzero(np.isnan(knots.x)), axis=1)
    lift = 0.01  # all lines are lifted off the surface, by less than a hundredth of its size
    assert pieces[0][0] == pytest.approx(np.full(33, 0.5), abs=lift)
    assert pieces[1][1][1:] == pytest.approx(np.full(33, 0.25), abs=lift)
    assert np.ptp(pieces[0][1]) == pytest.approx(1, abs=lift)
    with pytest.raises(GeometryError, match=r"knots must be given as parameters in \[0, 1\]"):
        view(saddle, knots=([2.0], []))


def test_knots_between_the_samples_cost_no_second_picture(saddle):
    """Their lines run through points of their own; the surface is drawn at its samples, from the same calls."""
    asked = []

    def watched(u, w):
        asked.append((u.shape, w.shape))
        return saddle(u, w)

    figure = view(watched, knots=([0.3, 0.6], [0.7]))
    assert asked == [((35, 1), (1, 34))]
    assert np.array_equal(figure.data[0].x[:, 0], np.linspace(0, 1, 33, dtype=np.float32))
    assert np.array_equal(figure.data[0].y[0], np.linspace(0, 1, 33, dtype=np.float32))


def waves(turns_u, turns_w):
    """A surface whose lines turn so often along u and along w."""

    def f(u, w):
        a, b = 2 * np.pi * turns_u * u, 2 * np.pi * turns_w * w
        return np.stack(np.broadcast_arrays((3 + np.cos(b)) * np.cos(a), (3 + np.cos(b)) * np.sin(a), np.sin(b)), axis=-1)

    return f


@pytest.mark.parametrize(
    ("form", "shape"),
    [
        (waves(0.5, 0.0), (33, 33)),
        (waves(1.0, 0.0), (65, 33)),  # a cylinder's facets are seen across its axis only
        (waves(0.5, 1.0), (33, 65)),
        (waves(1.0, 1.0), (65, 65)),
        (dx.Sphere(2), (33, 65)),  # half a turn and a full one; at the poles a line is a point
        (lambda u, w: np.stack(np.broadcast_arrays(u, w, np.abs(u - 0.4)), axis=-1), (65, 33)),  # a crease
        (lambda u, w: np.stack(np.broadcast_arrays(u, w, 1 / (u + w)), axis=-1), (65, 65)),  # a hole
    ],
    ids=["half a turn", "cylinder", "across", "torus", "sphere", "crease", "hole"],
)
def test_a_surface_has_as_many_samples_as_it_needs_to_look_round(form, shape):
    """33 each way, 65 where lines would have corners; whoever wants another number has it."""
    figure = view(form)
    assert figure.data[0].x.shape == shape
    assert figure.data[0].customdata.shape == (*shape[::-1], 2)
    assert view(form, samples=21).data[0].x.shape == (21, 21)


def test_lines_that_few_samples_would_put_unevenly_have_more(saddle):
    """Tenths lie nearer to one of 64 steps than to one of 32."""
    assert view(saddle, lines=10).data[0].x.shape == (65, 65)
    assert view(saddle, lines=16).data[0].x.shape == (33, 33)


def test_the_square_marks_the_same_place(saddle):
    """One diamond in the scene and one in the square, both at the (u, w) asked for."""
    figure = view(saddle, square=True, mark=(0.25, 0.5))
    diamonds = [trace for trace in figure.data if getattr(trace, "marker", None) and trace.marker.symbol == "diamond"]
    assert [trace.type for trace in diamonds] == ["scatter3d", "scatter"]
    assert (diamonds[0].x[0], diamonds[0].y[0], diamonds[0].z[0]) == (0.25, 0.5, 0.125)
    assert (diamonds[1].x[0], diamonds[1].y[0]) == (0.25, 0.5)
    with pytest.raises(GeometryError, match=r"mark must be \(u, w\) in \[0, 1\]"):
        view(saddle, mark=(2, 0))


def test_a_curve_is_one_line_with_its_start_marked():
    """A function of u alone is a curve."""
    figure = view(lambda u: np.stack([u, u * u, 0 * u], axis=-1), mark=[0.5])
    assert figure.data[0].mode == "lines"
    assert named(figure, "u = 0")[0].x.tolist() == [0.0]
    assert named(figure, "u = 0.5")[0].y.tolist() == [0.25]


def test_a_solid_is_drawn_as_its_six_faces():
    """u, v, w = 0 and 1, each face hovering with the two parameters that run on it."""
    figure = view(lambda u, v, w: np.stack(np.broadcast_arrays(u, v, w), axis=-1))
    faces = [trace for trace in figure.data if trace.type == "surface"]
    assert [face.name for face in faces] == ["u = 0", "u = 1", "v = 0", "v = 1", "w = 0", "w = 1"]
    assert set(np.ravel(faces[3].y)) == {1.0}
    assert "<b>u = " in faces[3].hovertemplate
    assert ", w = " in faces[3].hovertemplate


@pytest.mark.parametrize(("angle", "count"), [(np.pi / 2, 17), (2 * np.pi, 33)])
def test_a_round_solid_has_more_samples(angle, count):
    """All six faces alike."""

    def ring(u, v, w):
        return np.stack(np.broadcast_arrays((1 + v) * np.cos(angle * u), (1 + v) * np.sin(angle * u), w), axis=-1)

    assert {trace.x.shape for trace in view(ring).data if trace.type == "surface"} == {(count, count)}


def test_further_curves_and_points_stand_in_the_scene(tube):
    """A directrix as a callable, a point by its coordinates."""
    figure = view(tube, curves={"axis": lambda t: np.stack([0 * t, 0 * t, 9 * t], -1), "top": (0, 0, 12)})
    assert len(named(figure, "axis")[0].x) == 65
    assert named(figure, "top")[0].z.tolist() == [12.0]
    assert figure.layout.scene.zaxis.range[1] > 12


def test_a_figure_stays_small(tube):
    """float32: a comparison is a third of a megabyte, and more than 121 samples are refused."""
    assert len(view(tube, against=tube).to_json()) < 450_000
    with pytest.raises(GeometryError, match="samples must be from 2 to 121; got 500"):
        view(tube, samples=500)


@pytest.mark.parametrize("samples", [2, 3, 4])
@pytest.mark.parametrize("form", [dx.Sphere(2), dx.Cone(0, 2, 3), dx.Torus(3, 1)], ids=["sphere", "cone", "torus"])
def test_a_few_samples_are_enough(form, samples):
    """Where an edge is a point, letters stand on the line beside it."""
    figure = view(form, samples=samples)
    assert figure.data[0].x.shape == (samples, samples)
    words = [trace for trace in figure.data if trace.type == "scatter3d" and trace.mode == "text"]
    assert [list(trace.text) for trace in words] == [["u", "w"]]


def test_no_cloud_button():
    """The notebook renderer is told to leave plotly's upload button out."""
    import plotly.io as pio

    view(lambda u: np.stack([u, u, u], axis=-1))
    assert "sendChartToCloud" in pio.renderers["plotly_mimetype"].config["modeBarButtonsToRemove"]


def test_title_is_data_not_markup(saddle):
    """A name goes into plotly's small HTML as text."""
    figure = view(saddle, curves={"<a href='javascript:0'>x</a>": (0, 0, 0)})
    assert "<a" not in "".join(str(trace.name) for trace in figure.data)


def test_importing_plot_loads_neither_plotly_nor_a_surface():
    """A notebook that draws nothing pays for nothing, and the room is mounted alone where learners' code runs."""
    code = (
        "import sys, directrix.plot; loaded = [m for m in sys.modules if m.split('.')[0] == 'plotly' "
        "or m.startswith(('directrix.surf', 'directrix.curves'))]; sys.exit(bool(loaded))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_the_forms_own_net_and_knots():
    """net=True and knots=True ask the form; one without them says so, and given values still win."""
    net = np.stack(np.meshgrid(np.arange(5.0), np.arange(4.0), [0.0], indexing="ij"), axis=-1)[:, :, 0]
    patch = dx.BSplinePatch(net, 3, 3)
    figure = view(patch, net=True, knots=True)
    dots = named(figure, "control points")[0]
    assert sorted(zip(dots.x, dots.y, strict=True)) == [(x, y) for x in range(5) for y in range(4)]
    assert list(dots.text[:2]) == ["P[0, 0]", "P[0, 1]"]
    assert "━ net" in figure.layout.annotations[0].text
    lines = named(figure, "knots")[0]
    assert np.isnan(lines.x).sum() == 2 * 3 - 1  # knots 1/3 and 2/3 of u, 1/2 of w, on both sides
    with pytest.raises(GeometryError, match="Torus has none"):
        view(dx.Torus(3, 1), net=True)
    with pytest.raises(GeometryError, match="function has none"):
        view(lambda u, w: patch(u, w), knots=True)


def test_a_polygon_and_the_net_of_a_solid():
    """A net has lines along each of its axes."""
    corners = [[[(x, y, z) for z in (0, 1, 2)] for y in (0, 2)] for x in (0, 2)]
    solid = named(view(dx.BezierHyperpatch(corners), net=True), "control net")[0]
    assert np.isnan(solid.x).sum() == 2 * 3 + 2 * 3 + 2 * 2 - 1
    curve = named(view(dx.BezierCurve([(0, 0, 0), (1, 2, 0), (2, 0, 0)]), net=True), "control net")[0]
    assert list(curve.y) == [0, 2, 0]


def test_further_surfaces_share_the_scene():
    """Both sheets of a hyperboloid lie in one box, and a curve there is refused."""
    sheets = dx.quadric_patches(dx.Quadric(-1, -1, 1, 0, 0, 0, 0, 0, 0, -1))
    figure = view(sheets[0], also=sheets[1:])
    assert sum(trace.type == "surface" for trace in figure.data) == 2
    low, high = figure.layout.scene.zaxis.range
    assert low < -1 < 1 < high
    with pytest.raises(GeometryError, match="also takes further surfaces"):
        view(sheets[0], also=[dx.Line((0, 0, 0), (1, 0, 0))])


def test_measured_points_are_coloured_by_their_deviation():
    """A symmetric bar, one value a point; other counts are refused."""
    points = [(0, 0, 1), (1, 0, -2), (0, 1, 0.5)]
    flat = dx.Plane((0, 0, 0), (1, 0, 0), (0, 1, 0))
    dots = named(view(flat, points=points, deviations=[1, -2, 0.5]), "measured")[0]
    assert list(dots.marker.color) == [1, -2, 0.5]
    assert (dots.marker.cmin, dots.marker.cmax) == (-2, 2)
    with pytest.raises(GeometryError, match=r"deviations must have shape \(3,\)"):
        view(flat, points=points, deviations=[1, 2])
    with pytest.raises(GeometryError, match=r"points must have shape \(n, 3\)"):
        view(flat, points=[(1, 2)])


def test_a_tall_figure_is_seen_whole():
    """Every corner of its box lies within the camera's opening of 45 degrees, up and down."""
    for form in (dx.Cylinder(1, 9), dx.Sphere(1), dx.Cylinder(9, 1)):
        scene = view(form).layout.scene
        eye = np.array([scene.camera.eye[axis] for axis in "xyz"])
        centre = np.array([scene.camera.center[axis] for axis in "xyz"])
        half = np.array([scene.aspectratio[axis] for axis in "xyz"]) / 2
        ahead = -eye / np.linalg.norm(eye)
        up = np.array([0, 0, 1]) - ahead[2] * ahead
        up /= np.linalg.norm(up)
        for corner in np.ndindex(2, 2, 2):
            seen = (2 * np.array(corner) - 1) * half - centre - eye
            assert abs(seen @ up) <= np.tan(np.pi / 8) * (seen @ ahead)


def _without_template(figure):
    whole = figure.to_plotly_json()
    return {**whole, "layout": {key: part for key, part in whole["layout"].items() if key != "template"}}


@pytest.mark.parametrize("options", [{}, {"square": True, "mark": (0.5, 0.25)}, {"normals": True}, {"colour": "gaussian"}])
def test_a_figure_is_built_unchecked_of_valid_parts(options):
    """plotly's checks, made of the whole afterwards, find nothing and change nothing; what is added later is checked."""
    import plotly.graph_objects as go

    sphere = dx.Sphere(2)
    pictures = [view(sphere, **options), view(sphere, against=dx.Sphere(2.1))]
    pictures += [view(dx.Circle((0, 0, 0), 2, (0, 0, 1)), title="a circle"), view(dx.BezierPatch(np.ones((3, 3, 3))), net=True)]
    for figure in pictures:
        checked = go.Figure(figure.to_dict())
        np.testing.assert_equal(go.Figure(_without_template(checked)).to_dict()["data"], figure.to_dict()["data"])
        assert _without_template(checked)["layout"].keys() == _without_template(figure)["layout"].keys()
        for change in (figure.update_layout, figure.data[0].update, figure.layout.update):
            with pytest.raises(ValueError, match="nonsense"):
                change(nonsense=1)


def _words(figure):
    """The letters of a figure and where they stand."""
    (trace,) = [t for t in figure.data if t.type == "scatter3d" and t.mode == "text"]
    return dict(zip(trace.text, np.stack([trace.x, trace.y, trace.z], axis=-1).tolist(), strict=True))


@pytest.mark.parametrize("form", [dx.Sphere(2), dx.Torus(3, 1), dx.Cylinder(1, 2), dx.Cone(1, 0, 2), dx.Plane(*np.eye(3))])
def test_both_letters_stand_off_their_lines_and_in_the_box(form):
    """Also where an edge is one point: the w of a sphere stands on its equator. None is on the other, nor outside the axes."""
    figure = view(form)
    places = {text.removeprefix("<b>").removesuffix("</b>"): np.array(at) for text, at in _words(figure).items()}
    assert set(places) == {"u", "w"}
    t = np.linspace(0, 1, 201)
    points = form(t[:, None], t)
    size = np.ptp(points.reshape(-1, 3), axis=0).max()
    for at in places.values():
        assert 0.01 * size < np.linalg.norm(points - at, axis=-1).min() < 0.06 * size
    assert np.linalg.norm(places["u"] - places["w"]) > 0.1 * size
    for letter, axis in zip("xyz", range(3), strict=True):
        low, high = figure.layout.scene[f"{letter}axis"].range
        assert all(low <= at[axis] <= high for at in places.values())
    if isinstance(form, dx.Sphere):
        assert abs(places["w"][2]) < 0.1 * size


@pytest.mark.parametrize(
    ("form", "closed"),
    [
        (dx.BSplineCurve(np.eye(4)[:, :3], 3, "periodic"), 1), (dx.BSplineCurve(np.eye(4)[:, :3], 3), 0),
        (dx.BSplinePatch(np.random.default_rng(1).random((5, 4, 3)), 3, 3, "periodic", "open"), 4),
        (dx.BSplinePatch(np.random.default_rng(1).random((5, 4, 3)), 3, 3, "open", "periodic"), 5),
    ],
)  # fmt: skip
def test_a_net_of_periodic_knots_is_closed(form, closed):
    """Each of its lines that runs round comes back to its first point."""
    net = next(t for t in view(form, net=True).data if t.name == "control net")
    lines = np.stack([net.x, net.y, net.z], axis=-1)
    breaks = np.flatnonzero(np.isnan(lines[:, 0]))
    parts = [part[~np.isnan(part[:, 0])] for part in np.split(lines, breaks)]
    assert sum(len(part) > 1 and np.array_equal(part[0], part[-1]) for part in parts) == closed


def test_further_curves_with_gaps_leave_the_box_to_finite_points():
    """NaN rows are gaps in the line; what is not finite, in one coordinate or in all, stretches the scene nowhere."""

    def patch(u, w):
        return np.stack(np.broadcast_arrays(u, w, u * w), axis=-1)

    t = np.linspace(0, 1, 21)
    line = np.stack([t, t, 3 * t], axis=-1)
    whole = view(patch, curves={"line": line[:11]})
    line[11:] = [np.nan, np.inf, 300.0]
    line[4:6] = np.nan
    broken = view(patch, curves={"line": line})
    for axis in ("xaxis", "yaxis", "zaxis"):
        assert broken.layout.scene[axis].range == whole.layout.scene[axis].range
    drawn = next(trace for trace in broken.data if trace.name == "line")
    assert np.isnan(drawn.x[4:6]).all()
    assert np.isfinite(np.r_[drawn.x[:4], drawn.x[6:11]]).all()
    assert not drawn.connectgaps
