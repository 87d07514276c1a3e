"""A feedback page on a phone, opened as a file: our comparisons are laid out for it, a learner's own figure stays as it is."""

import numpy as np
import pytest
from directrix.plot import compare, view

from autograder.feedback.page import Sheet, render
from autograder.notebook.safe import FIGURE

pytestmark = pytest.mark.browser
PHONE, TURNED = {"width": 390, "height": 844}, {"width": 844, "height": 390}
EVIL = "<img src=x onerror='window.broken = 1'></script><script>window.broken = 1</script>"
CURVE = {"type": "scatter3d", "x": [0, 1], "y": [0, 1], "z": [0, 1]}
SIDES = {"scene": {"domain": {"x": [0, 0.45]}}, "scene2": {"domain": {"x": [0.5, 0.95]}}}
PANELS = """() => [...document.querySelectorAll('.js-plotly-plot')].map(({_fullLayout: shown, ...plot}, i) => {
  const box = document.querySelectorAll('.js-plotly-plot')[i].getBoundingClientRect(), inner = shown._size;
  return ['scene', 'scene2'].filter(name => shown[name]).map(name => {
    const {x, y} = shown[name].domain;
    return {left: box.left + inner.l + x[0] * inner.w, right: box.left + inner.l + x[1] * inner.w,
            top: box.top + inner.t + (1 - y[1]) * inner.h, bottom: box.top + inner.t + (1 - y[0]) * inner.h};
  });
})"""


def comparison():
    t = np.linspace(0, 1, 9)
    u, w = np.meshgrid(t, t, indexing="ij")
    return compare([t, t], np.dstack([u, w, u * w]), np.dstack([u, w, u * w * w]))


def page(*figures):
    """A feedback page with the figures as outputs of cells."""
    outputs = [{"output_type": "display_data", "data": {FIGURE: figure}, "metadata": {}} for figure in figures]
    cells = [{"cell_type": "code", "source": "draw()", "metadata": {}, "outputs": [output]} for output in outputs]
    return render({"cells": cells}, Sheet("nb", "A1", "Ada"))


def until(shown, asked, holds):
    """What the page answers once it holds; a page with a policy lets nobody wait inside it."""
    for _ in range(150):
        answer = shown.evaluate(asked)
        if holds(answer):
            return answer
        shown.wait_for_timeout(200)
    raise AssertionError(answer)


@pytest.fixture
def opened(browser, tmp_path):
    """opened(html): the page on a phone, once its figures are drawn; no script may fail and nothing be asked for elsewhere."""
    pages, troubles = [], []

    def open_it(html, count):
        shown = browser.new_page(viewport=PHONE)
        pages.append(shown)
        shown.on("pageerror", lambda error: troubles.append(str(error)))
        shown.on("request", lambda r: None if r.url.startswith(("file:", "data:", "blob:")) else troubles.append(r.url))
        (tmp_path / "page.html").write_text(html, "utf-8")
        shown.goto((tmp_path / "page.html").as_uri())
        until(shown, "document.querySelectorAll('.gl-container canvas').length", lambda found: found >= count)
        return shown

    yield open_it
    for shown in pages:
        shown.close()
    assert troubles == []


def test_a_comparison_is_seen_whole_on_a_phone_and_side_by_side_when_it_is_turned(opened):
    """One above the other, inside the window and hardly higher than wide; then beside each other; and back again."""
    shown = opened(page(comparison()), 1)
    ((first, second),) = standing = shown.evaluate(PANELS)
    for scene in (first, second):
        assert 0 <= scene["left"] < scene["right"] <= 390
        assert 0.7 < (scene["bottom"] - scene["top"]) / (scene["right"] - scene["left"]) < 1.05
    assert first["bottom"] < second["top"]
    assert shown.evaluate("document.documentElement.scrollWidth") == 390
    assert shown.evaluate("[...document.querySelectorAll('.outputs')].every(o => o.scrollWidth <= o.clientWidth)")
    holder = shown.locator(".directrix-figure").bounding_box()
    assert holder["height"] == pytest.approx(shown.locator(".js-plotly-plot").bounding_box()["height"], abs=1)

    shown.set_viewport_size(TURNED)
    ((first, second),) = until(shown, PANELS, lambda now: now and now[0][0]["right"] < now[0][1]["left"])
    assert (first["top"], first["bottom"]) == (second["top"], second["bottom"])
    assert second["right"] <= 844
    assert shown.locator(".directrix-figure").bounding_box()["height"] == comparison()["layout"]["height"]

    shown.set_viewport_size(PHONE)
    (again,) = until(shown, PANELS, lambda now: now and now[0][0]["bottom"] < now[0][1]["top"])
    for scene, before in zip(again, standing[0], strict=True):
        assert (scene["left"], scene["right"]) == (before["left"], before["right"])
        assert scene["bottom"] - scene["top"] == pytest.approx(before["bottom"] - before["top"])


def test_a_figure_that_is_not_ours_is_left_as_it_is(opened):
    """Also beside one of ours, and with all that ours have but what meta says."""
    own = comparison()
    own["layout"]["meta"] = {"alt": "mine", "fit": "true"}
    shown = opened(page(own, comparison()), 2)
    mine, ours = shown.evaluate(PANELS)
    assert mine[0]["right"] < mine[1]["left"]
    assert ours[0]["bottom"] < ours[1]["top"]
    heights = shown.evaluate("[...document.querySelectorAll('.js-plotly-plot')].map(plot => plot._fullLayout.height)")
    assert heights[0] == own["layout"]["height"] < heights[1]


HOSTILE = {
    "no domains": {"scene": {}, "scene2": {}},
    "annotations that are none": {**SIDES, "annotations": [None, 7, {"text": 7, "y": -1}]},
    "more annotations than ours have": {**SIDES, "annotations": [{"text": "a b " * 400, "y": -1}] * 1000},
    "margins past all pages": {**SIDES, "margin": {"t": 1e9}, "height": 300},
    "cameras that look nowhere": {
        "scene": {"aspectmode": "manual", "aspectratio": {"x": "a"}, "camera": {"eye": {"x": 0, "y": 0, "z": 0}, "up": 3}}
    },
    "buttons that set nonsense": {
        "scene": {"aspectmode": "manual"},
        "updatemenus": [{"buttons": [{"label": "a", "args": [7]}, {"label": "b", "args": [{"scene.camera": 3}]}]}],
    },
    "a prototype": {"scene": {}, "margin": {"__proto__": {"broken": 1}, "constructor": {"prototype": {"broken": 1}}}},
    "brackets without end": {"scene": {}, "title": {"text": "< " * 3_000}},
    "scripts": {
        "scene": {},
        "title": {"text": f"{EVIL} " * 9},
        "annotations": [{"text": f"{EVIL}&nbsp;&nbsp;&nbsp;{EVIL}", "y": -0.1}],
    },
}  # fmt: skip


def test_what_only_says_that_it_is_ours_runs_nothing_and_stops_nothing(opened):
    """Whatever learners' figures say they are: no script of them runs, the page answers, and a figure after them is fitted."""
    hostile = [{"data": [CURVE], "layout": {"height": 200, **layout, "meta": {"fit": True}}} for layout in HOSTILE.values()]
    shown = opened(page(*hostile, comparison()), 1)
    holders = shown.locator(".directrix-figure")
    for i in range(holders.count()):
        holders.nth(i).scroll_into_view_if_needed()
        canvas = f"!!document.querySelectorAll('.directrix-figure')[{i}].querySelector('.gl-container canvas')"
        until(shown, canvas, bool)
    ours = shown.evaluate(PANELS)[-1]
    assert ours[0]["bottom"] < ours[1]["top"]
    assert shown.evaluate("window.broken === undefined && ({}).broken === undefined")
    assert shown.locator("img").count() == 0
    heights = holders.evaluate_all("all => all.map(one => one.style.minHeight)")
    assert heights[list(HOSTILE).index("margins past all pages")] == "300px"


# Where the corners of the data stand, from -1 at one edge of the scene to 1 at the other.
ACROSS = """() => [...document.querySelectorAll('.js-plotly-plot')].map(plot => {
  const scene = plot._fullLayout.scene._scene;
  const {model, view, projection} = scene.glplot.cameraParams;
  const times = (m, v) => [0, 1, 2, 3].map(i => m[i] * v[0] + m[4 + i] * v[1] + m[8 + i] * v[2] + m[12 + i] * v[3]);
  const trace = plot._fullData[0], places = [];
  trace.x.forEach((row, i) => row.forEach((x, j) => {
    const scaled = [x, trace.y[i][j], trace.z[i][j]].map((value, axis) => value * scene.dataScale[axis]);
    const clip = times(projection, times(view, times(model, [...scaled, 1])));
    places.push(clip[0] / clip[3]);
  }));
  return [Math.min(...places), Math.max(...places)];
})"""


def test_a_wide_row_is_seen_whole_on_a_phone(opened):
    """The camera steps back as far as needed there: what is as wide as three surfaces in a row is not cropped at the sides."""
    figure = view(lambda u, w: np.stack(np.broadcast_arrays(12 * u, w, u * w), axis=-1), samples=5)
    figure.update_layout(scene_camera_eye={"x": 0.1, "y": -1.05, "z": 0.65})
    figure = figure.to_dict()
    figure["data"] = [figure["data"][0]]
    for axis in "xyz":
        figure["data"][0][axis] = np.asarray(figure["data"][0][axis]).tolist()
    plain = {**figure, "layout": {**figure["layout"], "meta": {}}, "data": [{**figure["data"][0], "customdata": None}]}
    ours = {**plain, "layout": figure["layout"]}
    near, far = opened(page(plain, ours), 2).evaluate(ACROSS)
    assert near[0] < -1.05
    assert near[1] > 1.05
    assert -0.95 < far[0] < -0.5
    assert 0.5 < far[1] < 0.95
