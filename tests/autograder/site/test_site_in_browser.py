"""The site's pages in Chromium, opened as files, with no network: the guess, the figure, the keyboard, dark and narrow."""

import pytest

# Contrast of text on its background as WCAG 2.2 reckons it (success criterion 1.4.3: at least 4.5).
CONTRAST = """selector => {
  const channel = c => { c /= 255; return c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; };
  const light = ([r, g, b]) => 0.2126 * channel(r) + 0.7152 * channel(g) + 0.0722 * channel(b);
  const read = text => text.match(/[\\d.]+/g).map(Number);
  const said = [...document.querySelectorAll(selector)].filter(e => e.getClientRects().length && e.textContent.trim());
  return Math.min(...said.map(element => {
    let under = element;
    while (read(getComputedStyle(under).backgroundColor)[3] === 0) under = under.parentElement;
    const a = light(read(getComputedStyle(element).color)), b = light(read(getComputedStyle(under).backgroundColor));
    return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
  }));
}"""
TEXT = "p, h1, h2, a, summary, label, label span, button, .highlight span, pre, q"


@pytest.fixture
def opened(built, browser):
    """opened(name, **how): a page of the site from its file; `page.strays` lists what it asked for elsewhere."""
    pages = []

    def open_it(name, **how):
        page = browser.new_page(**how)
        pages.append(page)
        page.strays, page.faults = [], []
        page.on("pageerror", lambda error: page.faults.append(str(error)))
        page.on("request", lambda request: page.strays.append(request.url))
        page.goto((built.folder / name).as_uri())
        return page

    yield open_it
    for page in pages:
        page.close()


@pytest.mark.browser
def test_a_reader_guesses_by_keyboard_and_sees_the_answer_and_its_figure(opened, built):
    """Nothing is drawn in the closed answer; once it is open the surface is, and nothing came from elsewhere."""
    page = opened("01-lines.html", viewport={"width": 390, "height": 700})
    answer = page.locator("details.waits")
    assert not page.locator("p.said").is_visible()
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.className") == "skip"
    page.focus("#guess-points")
    page.keyboard.press("Enter")
    assert answer.get_attribute("open") is None
    page.keyboard.type("<b>three</b>")
    page.keyboard.press("Enter")
    page.wait_for_selector("details.waits .js-plotly-plot .gl-container canvas", timeout=30_000)
    assert page.locator("p.said").inner_text() == "You said <b>three</b>; it is two & no more."
    assert page.evaluate("document.activeElement.tagName") == "SUMMARY"
    assert page.locator(".js-plotly-plot").first.get_attribute("aria-label") == "A saddle."
    assert page.evaluate("document.documentElement.scrollWidth") == 390
    page.keyboard.press("Enter")
    assert answer.get_attribute("open") is None
    folder = built.folder.as_uri()
    assert [url for url in page.strays if not url.startswith((folder, "data:", "blob:"))] == []
    assert page.faults == []


@pytest.mark.browser
@pytest.mark.parametrize(("width", "above"), [(390, True), (900, False)])
def test_two_scenes_stand_one_above_the_other_on_a_phone(opened, width, above):
    """Where they would stand side by side, half of a comparison were out of sight; elsewhere they stay side by side."""
    page = opened("01-lines.html", viewport={"width": width, "height": 700})
    page.click("#unfold")
    page.wait_for_selector(".js-plotly-plot .gl-container canvas", timeout=30_000)
    domains = "(({scene, scene2}) => [scene.domain, scene2.domain])(document.querySelector('.js-plotly-plot').layout)"
    left, right = page.evaluate(domains)
    assert (left["y"][0] > right["y"][1]) == (left["x"] == right["x"]) == above
    assert page.evaluate("[...document.querySelectorAll('.outputs')].some(o => o.scrollWidth > o.clientWidth)") is False


@pytest.mark.browser
def test_a_walk_is_walked_by_keyboard(opened):
    """A range and a button that say where the marker is, in place of plotly's slider; the figure follows."""
    page = opened("01-lines.html", viewport={"width": 900, "height": 700})
    walks = page.locator(".walk")
    assert walks.count() == 1
    way, said, play = walks.locator("input"), walks.locator("span"), walks.locator("button")
    marker = "[...document.querySelectorAll('.js-plotly-plot')].map(plot => plot.data[0].x[0]).at(-1)"
    page.keyboard.press("End")  # the figure is drawn where it is seen
    way.scroll_into_view_if_needed()
    page.wait_for_function(f"{marker} === 0", timeout=30_000)
    assert page.locator(".slider-container, .updatemenu-container").count() == 0
    way.focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowRight")
    page.wait_for_function(f"{marker} === 2")
    assert said.inner_text() == way.get_attribute("aria-valuetext") == "at step 2"
    play.focus()
    waits = play.inner_text()
    page.keyboard.press("Enter")
    page.wait_for_function(f"{marker} === 3")
    page.wait_for_function("text => document.querySelector('.walk button').textContent === text", arg=waits)  # it has stopped
    assert page.faults == []


@pytest.mark.browser
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_text_is_legible_in_light_and_dark(opened, scheme):
    page = opened("01-lines.html", viewport={"width": 1400, "height": 900}, color_scheme=scheme)
    assert (page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)") == (scheme == "light")
    page.click("#unfold")
    assert page.evaluate(CONTRAST, TEXT) >= 4.5
    assert page.locator("nav.places details").get_attribute("open") is not None
    page.goto(page.url.replace("01-lines", "index"))
    assert page.evaluate(CONTRAST, TEXT) >= 4.5


@pytest.mark.browser
def test_on_paper_answers_are_open_and_figures_are_pictures(opened):
    page = opened("01-lines.html", viewport={"width": 900, "height": 700}, color_scheme="dark")
    page.evaluate("() => { window.print = () => { window.printed = document.querySelectorAll('img.still').length; }; }")
    page.click("#paper")
    page.wait_for_function("window.printed !== undefined", timeout=30_000)
    assert page.evaluate("window.printed") == 2
    page.emulate_media(media="print")
    assert page.locator("p.said").is_visible()
    assert page.locator("img.still").first.bounding_box()["height"] > 100
    assert not page.locator("form.guess .row").is_visible()
    assert page.evaluate(CONTRAST, TEXT) >= 4.5  # dark ink, also where the screen is dark
