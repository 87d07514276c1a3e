"""Files: JSON to the last bit, triangles that close, STEP read back as the NURBS that was written, and refusals."""

import json
from importlib.util import find_spec

import directrix as dx
import numpy as np
import pytest
from directrix import export
from directrix.errors import ConversionError, GeometryError, NumberError

RNG = np.random.default_rng(1)
P, NET, WEIGHTS = RNG.standard_normal((8, 3)), RNG.standard_normal((4, 5, 3)), RNG.uniform(0.3, 3, (4, 5))
TURN = dx.Transform.rotate((1, 2, 3), 0.7, (1, 0, 1))
U, W = np.linspace(0, 1, 13)[:, None], np.linspace(0, 1, 11)[None]


steps = pytest.mark.skipif(find_spec("OCP") is None, reason="OpenCASCADE is not installed: uv sync --group oracles")


def every_form():
    """One of each class that is data."""
    bezier, arc = dx.BezierCurve(P[:4]), dx.Arc(P[0], 1 / 3, 0.1, 2.2, P[1])
    ends = [dx.Line(P[0], P[1]), dx.Line(P[2], P[3]), dx.Line(P[0], P[2]), dx.Line(P[1], P[3])]
    solid = RNG.standard_normal((2, 3, 4, 3))
    curves = [
        *ends[:1], bezier, arc, dx.Circle(P[0], 0.1, P[1]), dx.Conic(*P[:3], 0.7), dx.HermiteCurve(*P[:4]),
        dx.PointCurve(P[:4], [0, 0.1, 0.3, 1]), dx.BSplineCurve(P, 3, "periodic"), dx.NurbsCurve(P, WEIGHTS.ravel()[:8], 4),
        TURN @ arc, bezier.segment(0.1, 0.3), arc.segment(0.9, 0.3),
    ]  # fmt: skip
    surfaces = [
        dx.Plane(*P[:3]), dx.Triangle(*P[:3]), dx.Cylinder(0.1, 0.3), dx.Cone(0, 0.1, 1), dx.Sphere(1 / 3), dx.Torus(1, 1 / 7),
        dx.LinearSweep(arc, P[2], 1 / 3), dx.LinearSweep.between(bezier, P[0], P[1]), dx.CircularSweep(bezier, "x", 0.3),
        dx.CircularSweep.about(bezier, P[0], P[1], 0.3), dx.GenericSweep(bezier, dx.BezierCurve(P[3:7]), "minimal"),
        dx.AlgebraicPatch(NET), dx.HermitePatch(RNG.standard_normal((4, 4, 3))),
        dx.Ferguson(*RNG.standard_normal((3, 2, 2, 3))), dx.PointPatch(NET, tu="chord"),
        dx.BezierPatch(NET), dx.BSplinePatch(NET, 3, 3, "uniform", "periodic"),
        dx.NurbsPatch(NET, WEIGHTS, 3, 3), dx.Bilinear(*P[:4]), dx.Ruled(bezier, arc), dx.Coons(*ends, blend="cubic"),
        TURN @ dx.Sphere(2), dx.Sphere(2).patch(0.1, 0.2, 0.3, 0.4), dx.Sphere(2).swap(),
    ]  # fmt: skip
    solids = [
        dx.HermiteHyperpatch(RNG.standard_normal((4, 4, 4, 3))), dx.BezierHyperpatch(solid),
        dx.BSplineHyperpatch(solid, 2, 2, 3, knots_w="periodic"),
        dx.NurbsHyperpatch(solid, RNG.uniform(1, 2, (2, 3, 4)), 2, 3, 4),
    ]  # fmt: skip
    return [*curves, *surfaces, *solids, dx.Quadric(*RNG.standard_normal(10)), TURN]


@pytest.mark.parametrize("form", every_form(), ids=lambda form: type(form).__name__)
def test_json_there_and_back(form, tmp_path):
    """Equal to the last bit, and evaluating to the same bits."""
    (back,) = export.read(export.write(tmp_path / "form.json", form))
    assert type(back) is type(form)
    assert back == form
    if isinstance(form, dx.Surface):
        assert np.array_equal(back(U, W), form(U, W))
    assert export.dumps(back) == export.dumps(form)


def test_functions_are_no_data():
    with pytest.raises(ConversionError, match="FunctionCurve holds a function"):
        export.dumps(dx.Ruled(lambda t: np.stack([t, t, t], axis=-1), dx.Line((0, 0, 0), (1, 0, 0))))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{"form": "os.system"}', "not known: 'os.system'"),
        ('{"form": "Sphere"}', "Sphere in this file is not whole"),
        ('{"form": "Sphere", "radius": -1}', "radius must be greater than 0"),
        ('{"form": "Sphere", "radius": "2"}', "radius must be real numbers"),
        ('{"form": "Sphere", "radius": NaN}', "radius must be finite"),
        ('{"form": "Sphere", "radius": 1, "name": 2}', "does not hold together"),
        ('{"form": "BezierCurve", "control_points": {"array": [[1, 2], [3]]}}', "an array in this file"),
        ('{"form": "BezierCurve", "control_points": {"array": [[1, 2]]}}', r"shape \(n, 3\)"),
    ],
)
def test_bad_files_are_refused(text, message):
    """Whatever a file holds, what comes out has passed the library's own checks."""
    with pytest.raises(GeometryError, match=message):
        export.loads(f'{{"format": "directrix 1", "forms": [{text}]}}')


@pytest.mark.parametrize(
    ("text", "message"), [("{", "this is no JSON"), ("[]", "begins with"), ('{"forms": []}', "begins with")]
)
def test_other_files_are_refused(text, message):
    with pytest.raises(GeometryError, match=message):
        export.loads(text)


def test_contradicting_parts_are_refused():
    """A sweep whose vector does not belong to its direction is no sweep."""
    text = export.dumps(dx.LinearSweep(dx.Line((0, 0, 0), (1, 0, 0)), (0, 0, 1), 2.0))
    data = json.loads(text)
    data["forms"][0]["vector"]["array"] = [5.0, 5.0, 5.0]
    with pytest.raises(GeometryError, match="contradict each other"):
        export.loads(json.dumps(data))


def edges_of(triangles):
    """Every directed edge of the triangles with the number of times it occurs."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    return np.unique(edges, axis=0, return_counts=True)


@pytest.mark.parametrize(
    "form", [dx.Sphere(2), dx.Torus(3, 1), dx.BezierHyperpatch(np.indices((2, 3, 2)).transpose(1, 2, 3, 0))]
)
def test_closed_forms_give_closed_meshes(form):
    """Every edge is used once each way: seams, poles and the edges of a solid are joined. Euler's number tells the genus."""
    vertices, triangles = export.mesh(form, 16)
    edges, counts = edges_of(triangles)
    assert (counts == 1).all()
    assert {tuple(e) for e in edges} == {tuple(e[::-1]) for e in edges}
    assert len(vertices) - len(edges) // 2 + len(triangles) == (0 if isinstance(form, dx.Torus) else 2)


def test_mesh_volume_and_orientation():
    """The signed volume of a solid's mesh is positive, and that of a sphere's, whose normals point inward, negative."""

    def volume(form):
        a, b, c = (export.mesh(form, 64)[0][corner] for corner in export.mesh(form, 64)[1].T)
        return np.einsum("ij,ij->", a, np.cross(b, c)) / 6

    assert volume(dx.BezierHyperpatch(2 * np.indices((2, 2, 2)).transpose(1, 2, 3, 0))) == pytest.approx(8)
    assert volume(dx.Sphere(1)) == pytest.approx(-4 / 3 * np.pi, rel=4e-3)


def test_a_tear_stays_open():
    """Two steps, at heights 0 and 5: no triangle joins them."""
    net = np.array([[(x, y, z) for y in (0, 1)] for x, z in ((0, 0), (1, 0), (1, 5), (2, 5))], dtype=float)
    torn = dx.BSplinePatch(net, 2, 2, [0, 0, 1, 1, 2, 2])
    vertices, triangles = export.mesh(torn, 5)
    assert set(np.ptp(vertices[triangles][..., 2], axis=1)) == {0.0}
    a, b, c = (vertices[corner] for corner in triangles.T)
    assert np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2 == pytest.approx(2)


def test_knots_are_among_the_vertices():
    """A crease at a knot is kept, whatever the resolution."""
    net = np.array([[(x, y, z) for y in (0, 1)] for x, z in ((0, 0), (1, 1), (3, 0))], dtype=float)
    vertices, _ = export.mesh(dx.BSplinePatch(net, 2, 2), 3)
    assert vertices[:, 2].max() == 1


@pytest.mark.parametrize("suffix", [".stl", ".obj", ".glb", ".gltf", ".ply"])
def test_mesh_files_are_read_back(suffix, tmp_path):
    """trimesh reads what was written: the same triangles, the same area."""
    trimesh = pytest.importorskip("trimesh")
    path = export.write(tmp_path / f"torus{suffix}", dx.Torus(3, 1), resolution=24)
    read = trimesh.load(path, force="mesh")
    vertices, triangles = export.mesh(dx.Torus(3, 1), 24)
    a, b, c = (vertices[corner] for corner in triangles.T)
    assert len(read.faces) == len(triangles)
    assert read.area == pytest.approx(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2, rel=1e-5)


@pytest.mark.parametrize("suffix", [".STL", ".Obj", ".GLB", ".glTF", ".PLY", ".JSON", pytest.param(".STEP", marks=steps)])
def test_the_file_has_the_name_that_was_asked_for(suffix, tmp_path):
    path = export.write(tmp_path / f"ball{suffix}", dx.Sphere(2), resolution=4)
    assert [file.name for file in tmp_path.iterdir()] == [path.name] == [f"ball{suffix}"]


def test_a_second_file_in_the_folder_leaves_the_first_as_it_was(tmp_path):
    """A glTF file holds its own buffers: those beside it would have the same names for each."""
    trimesh = pytest.importorskip("trimesh")
    first = export.write(tmp_path / "ball.gltf", dx.Sphere(2), resolution=8)
    area = trimesh.load(first, force="mesh").area
    export.write(tmp_path / "tube.gltf", dx.Cylinder(1, 1), resolution=6)
    assert trimesh.load(first, force="mesh").area == area


@pytest.mark.parametrize("radius", [1e-9, 1e-6, 1e-3, 1.0, 1e6])
def test_an_obj_file_keeps_its_digits_whatever_the_unit(radius, tmp_path):
    """OBJ has no exponents: with a fixed number of decimals a ball of a micrometre, in metres, was off by a percent."""
    path = export.write(tmp_path / "ball.obj", dx.Sphere(radius), resolution=8)
    lines = [line.split()[1:] for line in path.read_text().splitlines() if line.startswith("v ")]
    assert np.allclose(np.linalg.norm(np.array(lines, dtype=float), axis=1), radius, rtol=1e-9, atol=0)


@steps
@pytest.mark.parametrize(
    "form",
    [
        dx.NurbsPatch(NET, WEIGHTS, 3, 4), dx.BSplinePatch(NET, 4, 2, "uniform"), dx.BezierPatch(NET), dx.Torus(3, 1),
        dx.Sphere(2), dx.Cone(2, 0, 3), TURN @ dx.Cylinder(2, 3),
        dx.Coons(*[dx.Line(*p) for p in (P[[0, 1]], P[[2, 3]], P[[0, 2]], P[[1, 3]])]),
    ],
    ids=lambda form: type(form).__name__,
)  # fmt: skip
def test_step_there_and_back(form, tmp_path):
    """The file holds the NURBS itself: control points, weights and knots come back to the digits that STEP prints."""
    (back,) = export.read(export.write(tmp_path / "form.step", form))
    written = dx.to_nurbs(form)
    np.testing.assert_allclose(back(U, W), written(U, W), atol=1e-12 * (1 + np.abs(written.control_net).max()))
    assert back.degrees == written.degrees


@steps
@pytest.mark.parametrize(("length", "start"), [(1e-9, 0.0), (1e-12, 0.0), (1e-3, 1e6)])
def test_step_of_knots_on_a_short_domain(length, start, tmp_path):
    """OpenCASCADE takes parameters within 1e-9 for one and would write no face, or another, without a word."""
    knots = start + length * np.array([0, 0, 0, 0.25, 1, 1, 1])
    form = dx.BSplinePatch(NET, 3, 5, knots)
    (back,) = export.read(export.write(tmp_path / "form.step", form))
    assert np.allclose(back(U, W), form(U, W), atol=1e-5)


@steps
def test_step_says_what_it_cannot_hold(tmp_path):
    """A face smaller than OpenCASCADE's resolution was left out of the file; knots an ulp apart ended in its own exception."""
    (back,) = export.read(export.write(tmp_path / "small.step", dx.BezierPatch(1e-5 * NET)))
    assert np.allclose(back.control_net, 1e-5 * NET, rtol=0, atol=1e-15)
    with pytest.raises(GeometryError, match=r"a surface of 1e-05 mm at least; got one of .*Scale it up"):
        export.write(tmp_path / "tiny.step", dx.BezierPatch(1e-7 * NET))
    near = dx.BSplinePatch(NET, 2, 5, [0, 0, 0.5, np.nextafter(0.5, 1), 1, 1])
    with pytest.raises(GeometryError, match=r"OpenCASCADE takes no such surface.*too near"):
        export.write(tmp_path / "near.step", near)


@steps
def test_step_of_a_torn_patch_and_a_solid(tmp_path):
    """A tear becomes two faces, a solid six."""
    net = np.array([[(x, y, x) for y in (0, 1)] for x in (0, 1, 5, 6)], dtype=float)
    torn = dx.BSplinePatch(net, 2, 2, [0, 0, 1, 1, 2, 2])
    left, right = export.read(export.write(tmp_path / "torn.stp", torn))
    np.testing.assert_allclose(left(1, 0.5), (1, 0.5, 1), atol=1e-14)
    np.testing.assert_allclose(right(0, 0.5), (5, 0.5, 5), atol=1e-14)
    cube = dx.BezierHyperpatch(np.indices((2, 2, 2)).transpose(1, 2, 3, 0))
    assert len(export.read(export.write(tmp_path / "cube.step", cube))) == 6
    stairs = dx.BSplinePatch(net, 1, 2)
    assert len(export.read(export.write(tmp_path / "stairs.step", stairs))) == 4


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (lambda f: export.write(f / "a.dwg", dx.Sphere(1)), GeometryError, "suffix says how to write"),
        (lambda f: export.write(f / "a.json"), GeometryError, "give the forms"),
        (lambda f: export.read(f / "a.stl"), GeometryError, "only .json and .step"),
        (lambda f: export.read(f / "none.json"), GeometryError, "cannot be read"),
        (lambda f: export.read(f / "none.step"), GeometryError, "there is no file"),
        (lambda f: export.mesh(dx.Line((0, 0, 0), (1, 0, 0))), GeometryError, "of a surface or a solid"),
        (lambda f: export.mesh(dx.Sphere(1), 0), GeometryError, "resolution must be a whole number"),
        (lambda f: export.write(f / "a.step", dx.Line((0, 0, 0), (1, 0, 0))), GeometryError, "STEP holds surfaces"),
        (lambda f: export.dumps(dx.Sphere(np.inf)), NumberError, "finite"),
    ],
)  # fmt: skip
def test_bad_requests_are_named(make, error, message, tmp_path):
    with pytest.raises(error, match=message):
        make(tmp_path)


def test_missing_libraries_say_what_to_install(tmp_path, monkeypatch):
    """Without trimesh or OpenCASCADE the error names the extra."""
    monkeypatch.setitem(__import__("sys").modules, "trimesh", None)
    with pytest.raises(GeometryError, match=r"directrix\[mesh\]"):
        export.write(tmp_path / "a.stl", dx.Sphere(1))
    for name in ("OCP", "OCP.Message"):
        monkeypatch.setitem(__import__("sys").modules, name, None)
    with pytest.raises(GeometryError, match=r"directrix\[cad\]"):
        export.write(tmp_path / "a.step", dx.Sphere(1))
