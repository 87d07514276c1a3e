"""compare: the same axes for both, true colours, the worst place marked in both, and JSON that is JSON."""

import base64
import json

import numpy as np
import pytest
from directrix.errors import ShapeError
from directrix.plot import compare, palette, view

T = np.linspace(0.0, 1.0, 9)
U, W = np.meshgrid(T, T, indexing="ij")
FLAT = np.dstack([U, W, 0 * U])


def unpacked(typed):
    data = np.frombuffer(base64.b64decode(typed["bdata"]), "<f4")
    return data.reshape([int(n) for n in typed["shape"].split(", ")]) if "shape" in typed else data


def traces(figure, **wanted):
    return [trace for trace in figure["data"] if all(trace.get(key) == value for key, value in wanted.items())]


def test_both_scenes_share_axes_and_camera():
    """Equal ranges and one camera: what looks larger is larger."""
    layout = compare([T, T], FLAT, FLAT + [0, 0, 2.0])["layout"]
    for key in ("xaxis", "yaxis", "zaxis", "camera", "aspectratio"):
        assert layout["scene"][key] == layout["scene2"][key]
    assert layout["scene"]["zaxis"]["range"][1] > 2
    assert layout["meta"]["link"] == ["scene", "scene2"]


def test_buttons_turn_both_cameras_without_a_script():
    """Each view names both scenes, so that it works where scripts do not run."""
    buttons = compare([T, T], FLAT, FLAT + 0.1)["layout"]["updatemenus"][0]["buttons"]
    assert [button["label"] for button in buttons] == ["3-D", "from +x", "from −y", "from +z"]
    for button in buttons:
        assert set(button["args"][0]) == {"scene.camera", "scene2.camera"}


def test_colours_are_the_deviation_over_the_size():
    """On the unit square (size √2) a lift by √2 w is a deviation of w."""
    yours = FLAT + np.sqrt(2) * W[..., None] * [0, 0, 1]
    surface = traces(compare([T, T], FLAT, yours), type="surface", scene="scene2")[0]
    np.testing.assert_allclose(unpacked(surface["surfacecolor"]), W, atol=1e-6)
    assert (surface["cmin"], surface["cmax"]) == (0.0, pytest.approx(1.0))
    assert surface["lighting"] == palette.FLAT
    hover = unpacked(surface["customdata"])  # transposed: [j, i] is (u_i, w_j, deviation)
    np.testing.assert_allclose(hover[2, 6], [0.75, 0.25, 0.25], atol=1e-6)


def test_the_worst_place_is_marked_in_both():
    """The single sample that is off is where both diamonds stand, joined by a line."""
    yours = FLAT.copy()
    yours[6, 2] += [0, 0, 1.0]
    figure = compare([T, T], FLAT, yours)
    diamonds = [trace for trace in figure["data"] if trace.get("marker", {}).get("symbol") == "diamond"]
    assert [diamond["scene"] for diamond in diamonds] == ["scene", "scene2"]
    assert [[float(unpacked(d[axis])[0]) for axis in "xyz"] for d in diamonds] == [[0.75, 0.25, 0.0], [0.75, 0.25, 1.0]]
    assert "marked at (u, w) = (0.75, 0.25)" in figure["layout"]["meta"]["alt"]


def test_a_given_worst_place_between_samples_is_met():
    """Points between the samples are linear between them."""
    figure = compare([T, T], FLAT, FLAT + [0, 0, 1.0], worst=(0.3, 0.9))
    diamond = next(trace for trace in figure["data"] if trace.get("marker", {}).get("symbol") == "diamond")
    np.testing.assert_allclose([unpacked(diamond[axis])[0] for axis in "xy"], [0.3, 0.9], atol=1e-6)


def test_the_camera_begins_where_the_worst_place_is_seen():
    """A place on the far side turns the first look round; one on the near side leaves it."""
    near, far = FLAT.copy(), FLAT.copy()
    near[8, 0] += [0, 0, 1.0]
    far[0, 8] += [0, 0, 1.0]
    eyes = [compare([T, T], FLAT, yours)["layout"]["scene"]["camera"]["eye"] for yours in (near, far)]
    assert eyes[0]["x"] > 0 > eyes[0]["y"]
    assert eyes[1]["x"] < 0 < eyes[1]["y"]


@pytest.mark.parametrize(
    ("yours", "said"),
    [
        (FLAT * np.nan, "no point of yours is finite"),
        (np.where(FLAT > 0.9, np.inf, FLAT), "of 81 points of yours are not finite"),
        (FLAT * 1e5, "up to 1e+05 sizes away"),
        (FLAT * 1e300, "more than a billion sizes away"),
    ],
)
def test_answers_that_run_away_are_drawn_and_told(yours, said):
    """A picture comes of every answer; the reference stays visible and the words say what is missing."""
    figure = compare([T, T], FLAT, yours)
    json.dumps(figure, allow_nan=False)
    assert said in figure["layout"]["meta"]["alt"]
    assert any(said in note["text"] for note in figure["layout"]["annotations"])
    assert np.ptp(figure["layout"]["scene"]["xaxis"]["range"]) < 20
    for trace in figure["data"]:
        for axis in "xyz":
            assert not np.isinf(unpacked(trace[axis])).any()


def test_alone_there_is_one_scene():
    """Without an answer, or with a right one, one scene is drawn: each is a WebGL context of the browser."""
    for figure in (compare([T, T], FLAT, None), compare([T, T], FLAT, FLAT, same=True)):
        assert "scene2" not in figure["layout"]
        assert len(traces(figure, type="surface")) == 1


def test_curves_share_one_scene_and_differ_by_more_than_colour():
    """Yours is dashed."""
    line = np.stack([T, 0 * T, 0 * T], axis=-1)
    figure = compare([T], line, line + T[:, None] * [0, 1.0, 0])
    assert "scene2" not in figure["layout"]
    assert [trace["line"]["dash"] for trace in figure["data"][:2]] == ["solid", "dash"]
    assert "marked at u = 1" in figure["layout"]["meta"]["alt"]


def test_arrays_that_do_not_fit_are_refused():
    """The message tells both shapes."""
    with pytest.raises(ShapeError, match=r"yours must have shape \(9, 9, 3\).*got \(9, 3\)"):
        compare([T, T], FLAT, FLAT[:, 0])


def test_view_against_is_the_same_picture(saddle):
    """f is coloured on the right, the reference plain on the left."""
    figure = view(lambda u, w: saddle(u, w) + [0, 0, 1.0], against=saddle, names=("asked for", "mine"))
    left, right = (trace for trace in figure.data if trace.type == "surface")
    assert (left.scene, left.name, right.scene, right.name) == ("scene", "asked for", "scene2", "mine")
    np.testing.assert_allclose(right.surfacecolor, 1 / np.sqrt(3), rtol=1e-6)
