"""A static page in Chromium without a network: hover, linked cameras, words for the picture, contexts that are given back."""

import json
import re

import numpy as np
import pytest
from directrix.plot import compare, page, palette, view
from plotly.offline import get_plotlyjs

pytestmark = pytest.mark.browser
SCENES = "() => ['scene', 'scene2'].map(s => document.querySelector('.js-plotly-plot')._fullLayout[s]._scene.getCamera().eye)"

CAMERAS = """() => {
  const layout = document.querySelector('.js-plotly-plot')._fullLayout;
  return Object.fromEntries(['scene', 'scene2'].map(s => [s + '.camera', JSON.parse(JSON.stringify(layout[s].camera))]));
}"""


def document(*figures, gap=0):
    body = f'<div style="height:{gap}px"></div>'.join(page.fragment(figure) for figure in figures)
    return f"<!doctype html><html><head><meta charset='utf-8'>{page.head()}</head><body style='margin:0'>{body}</body></html>"


class Opened:
    """Opens documents; any request to a network, and any error of a script, fails the test."""

    def __init__(self, browser, folder):
        self.browser, self.folder, self.pages = browser, folder, []

    def __call__(self, html):
        place = self.folder / f"page{len(self.pages)}.html"
        place.write_text(html, "utf-8")
        shown = self.browser.new_page(viewport={"width": 1000, "height": 700})
        shown.troubles = []
        shown.on("pageerror", lambda error: shown.troubles.append(str(error)))
        shown.on("request", lambda r: None if r.url.startswith(("file:", "data:", "blob:")) else shown.troubles.append(r.url))
        self.pages.append(shown)
        shown.goto(place.as_uri())
        shown.wait_for_selector(".gl-container canvas", timeout=60_000)
        shown.wait_for_timeout(700)
        return shown

    def close(self):
        for shown in self.pages:
            assert shown.troubles == []
            shown.close()


@pytest.fixture
def opened(browser, tmp_path):
    pages = Opened(browser, tmp_path)
    yield pages
    pages.close()


@pytest.fixture(scope="module")
def one_page(browser, two, tmp_path_factory):
    """One page with a comparison, and where its cameras stand."""
    pages = Opened(browser, tmp_path_factory.mktemp("pair"))
    shown = pages(document(two))
    yield shown, eyes(shown), shown.evaluate(CAMERAS)
    pages.close()


@pytest.fixture
def pair(one_page):
    """That page as it was at first, for the tests that only turn it."""
    shown, start, cameras = one_page
    shown.evaluate("cameras => Plotly.relayout(document.querySelector('.js-plotly-plot'), cameras)", cameras)
    settled(shown, lambda now: np.allclose(now, start, atol=1e-3))
    yield shown
    shown.mouse.up()


@pytest.fixture(scope="module")
def two():
    t = np.linspace(0, 1, 17)
    U, W = np.meshgrid(t, t, indexing="ij")
    return compare([t, t], np.dstack([U, W, U * W]), np.dstack([U, W, U * W * W]))


def settled(shown, holds):
    """Wait until the cameras are as they should be, as long as a machine with much else to do may need."""
    for _ in range(100):
        if holds(eyes(shown)):
            return
        shown.wait_for_timeout(200)
    raise AssertionError(f"the cameras stay at {eyes(shown)}")


def eyes(shown):
    return [tuple(round(eye[axis], 6) for axis in "xyz") for eye in shown.evaluate(SCENES)]


@pytest.mark.parametrize(("height", "shape"), [(0.0, (33, 33)), (0.1, (65, 33))], ids=["flat", "more samples along u"])
def test_hover_tells_the_parameters_of_the_point_under_the_mouse(opened, height, shape):
    """Where x = 3u and y = w, the (u, w) that is shown must be the (x, y) shown: plotly.js reads customdata transposed."""
    figure = view(lambda u, w: np.stack(np.broadcast_arrays(3 * u, w, height * np.sin(9 * np.pi * u) + 0 * w), axis=-1))
    assert figure.data[0].x.shape == shape
    shown = opened(document(figure))
    seen = []
    for x, y in ((470, 200), (560, 230), (520, 215), (430, 180)):
        shown.mouse.move(x, y)
        shown.wait_for_timeout(350)
        text = shown.evaluate("() => [...document.querySelectorAll('.hovertext')].map(t => t.textContent).join(' ')")
        found = re.search(r"u = ([\d.]+), w = ([\d.]+).*\(x, y, z\) = \(([\d.]+), ([\d.]+),", text)
        if found:
            seen.append(tuple(map(float, found.groups())))
    assert len(seen) >= 2
    assert any(abs(u - w) > 0.1 for u, w, *_ in seen)
    for u, w, x, y in seen:
        assert (x / 3, y) == pytest.approx((u, w), abs=2e-3)


@pytest.mark.parametrize("start", [250, 690])
def test_dragging_one_scene_turns_the_other_with_it(pair, start):
    """While the mouse moves, and to the same camera in the end, from either side."""
    shown = pair
    before = eyes(shown)
    assert before[0] == before[1]
    shown.mouse.move(start, 200)
    shown.mouse.down()
    for step in range(8):
        shown.mouse.move(start + 9 * step, 200 + 4 * step)
        shown.wait_for_timeout(60)
    settled(shown, lambda during: all(np.linalg.norm(np.subtract(*one)) > 0.1 for one in zip(during, before, strict=True)))
    shown.mouse.up()
    settled(shown, lambda after: after[0] == after[1] != before[0])


def test_the_wheel_zooms_both(pair):
    """plotly.js tells of a wheel before it zooms, so the scenes themselves are asked afterwards."""
    shown = pair
    before = eyes(shown)
    shown.mouse.move(690, 200)
    shown.mouse.wheel(0, 240)
    farther = 1.1 * np.linalg.norm(before[0])
    settled(shown, lambda after: after[0] == pytest.approx(after[1], abs=1e-6) and np.linalg.norm(after[0]) > farther)


def test_a_button_turns_both_without_our_script(opened, two):
    """In a page (or a Lab) that runs none of our scripts the views are still linked."""
    linking = "if (Array.isArray(meta.link) && meta.link.length > 1) link(plot, meta.link.map(String));"
    unlinked = page.figures_js().replace(linking, "")
    assert unlinked != page.figures_js()
    scripts = [text.replace("</script", "<\\/script") for text in (get_plotlyjs(), unlinked)]
    shown = opened(document(two).replace(page.head(), "".join(f"<script>{text}</script>" for text in scripts)))
    shown.locator(".updatemenu-button", has_text="from +z").click()
    shown.wait_for_timeout(600)
    left, right = eyes(shown)
    assert left == right
    assert left[2] > 1.5 > abs(left[0]) + abs(left[1])


def test_a_picture_has_words(pair):
    """role=img and a label, on the holder and on what plotly draws."""
    shown = pair
    labels = shown.evaluate("() => [...document.querySelectorAll('[role=img]')].map(e => e.getAttribute('aria-label'))")
    assert len(labels) == 2
    assert all(label.startswith("Two 3-D scenes on the same axes") for label in labels)


def test_figures_far_away_give_their_contexts_back(opened, two):
    """A browser keeps about 16 WebGL contexts: what is far from the window is taken away, and drawn again on return."""
    shown = opened(document(*[two] * 5, gap=2000))
    canvases = shown.locator(".js-plotly-plot .gl-container canvas")
    drawn = "i => !!document.querySelectorAll('.directrix-figure')[i].querySelector('.gl-container canvas')"
    assert canvases.count() == 2
    for place in (4, 0):
        shown.evaluate("i => document.querySelectorAll('.directrix-figure')[i].scrollIntoView()", place)
        shown.wait_for_function(drawn, arg=place, timeout=30_000)
        shown.wait_for_timeout(300)
        assert canvases.count() == 2
        assert not shown.evaluate(drawn, 4 - place)


def test_in_jupyterlab_it_is_a_prebuilt_extension(browser):
    """There the same file registers the container that package.json names, and draws nothing by itself."""
    package = json.loads((page.LABEXTENSIONS / "directrix-figures" / "package.json").read_text())
    assert package["jupyterlab"]["_build"] == {"load": "static/figures.js", "extension": "./extension"}
    lab = browser.new_page()
    lab.set_content("<script id='jupyter-config-data' type='application/json'>{}</script>")
    lab.add_script_tag(content=page.figures_js())
    plugin = lab.evaluate(
        """async name => {
            const container = window._JUPYTERLAB[name];
            await container.init({});
            const plugin = (await container.get("./extension"))().default;
            plugin.activate({});
            return [plugin.id, plugin.autoStart];
        }""",
        package["name"],
    )
    lab.close()
    assert plugin == ["directrix-figures:plugin", True]


def test_hostile_words_stay_words(opened):
    """A name that tries to leave its element, or to be a script, is shown and not run."""
    evil = "</script><script>window.broken = 1</script><img src=x onerror='window.broken = 1'>"
    figure = view(lambda u: np.stack([u, u, u], axis=-1), title=evil, curves={evil: (0, 0, 0)})
    figure.layout.meta["alt"] = evil
    shown = opened(document(figure))
    assert shown.evaluate("() => window.broken === undefined")
    assert shown.evaluate("() => document.querySelectorAll('img').length") == 0


PLAIN = {"template": {"data": {"scatter": [{"type": "scatter"}]}}, "height": 120}  # what plotly writes for template="none"


def drawn_in(colour=None, **layout):
    """A plane figure, its curve in that colour."""
    curve = {"type": "scatter", "x": [0, 1], "y": [0, 1], **({"line": {"color": colour}} if colour else {})}
    return {"data": [curve], "layout": {**PLAIN, **layout}}


GROUNDS = {
    "nothing said": (drawn_in(), True),
    "a light line": (drawn_in("#56B4E9"), True),
    "a scene": ({"data": [{"type": "scatter3d", "x": [0, 1], "y": [0, 1], "z": [0, 1]}], "layout": PLAIN}, True),
    "a black line": (drawn_in("black"), False),
    "dark points among others": (
        {"data": [{"type": "scatter", "y": [1, 2], "marker": {"color": ["#FFF", "rgb(10, 20, 60)"]}}], "layout": PLAIN}, False,
    ),
    "a dark word": (drawn_in(title={"text": "a <span style='color: navy'>word</span>"}), False),
    "its own ground": (drawn_in(paper_bgcolor="#FFFFEE"), False),
    "a template's ground": (drawn_in(template={"layout": {"plot_bgcolor": "#E5ECF6"}}), False),
}  # fmt: skip
STANDS = """() => [...document.querySelectorAll('.js-plotly-plot')].map(({_fullLayout: shown}) => [
  shown.paper_bgcolor, shown.plot_bgcolor || shown.scene.bgcolor, shown.font.color])"""


def test_a_figure_without_a_ground_of_its_own_follows_the_page(opened):
    """Greys of the palette on a dark page, unless a colour that it names would be lost there; on a light one as it is."""
    style = "<style>body { background: #fff } @media (prefers-color-scheme: dark) { body { background: #14181d } }</style>"
    html = document(*(figure for figure, _ in GROUNDS.values())).replace("</head>", f"{style}</head>")
    shown = opened(html)
    light = shown.evaluate(STANDS)
    assert [stands[0] for stands in light] == ["#fff"] * 6 + ["#FFFFEE", "#fff"]
    shown.emulate_media(color_scheme="dark")
    shown.wait_for_timeout(700)
    dark = shown.evaluate(STANDS)
    clear = "rgba(0, 0, 0, 0)"
    for stands, before, (_, follows) in zip(dark, light, GROUNDS.values(), strict=True):
        assert stands == ([clear, clear, palette.INK] if follows else before)
    written = shown.evaluate("[...document.querySelectorAll('.directrix-figure script')].map(one => one.textContent)")
    assert [json.loads(text)["layout"] for text in written] == [figure["layout"] for figure, _ in GROUNDS.values()]
    shown.emulate_media(color_scheme="light")
    shown.wait_for_timeout(700)
    assert shown.evaluate(STANDS) == light


def test_the_greys_of_the_script_are_those_of_the_palette():
    said = dict(re.findall(r'(INK|GRID|CLEAR) = "([^"]+)"', page.figures_js()))
    assert said == {"INK": palette.INK, "GRID": palette.GRID, "CLEAR": palette.CLEAR}
