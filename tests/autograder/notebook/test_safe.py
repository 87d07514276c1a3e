"""What a learner's notebook may show."""

import contextlib
import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from autograder import card
from autograder.errors import SubmissionError
from autograder.notebook import safe
from autograder.notebook.master import Master
from autograder.notebook.rebuild import rebuild
from autograder.notebook.submission import parse
from autograder.notebook.written import FIGURE, dumps
from autograder.result import Case, Verdict

PNG = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
ACTIVE = [
    "<script>alert(1)</script>",
    "<img src=x onerror=alert(1)>",
    "<svg onload=alert(1)><script>1</script></svg>",
    "<a href='javascript:alert(1)'>x</a>",
    "<a href='data:text/html,<script>1</script>'>x</a>",
    "<iframe src='http://x'></iframe>",
    "<form action='http://x'><input name=q><button>go</button></form>",
    "<style>@import 'http://x'</style>",
    "<div style='background-image: url(http://x)'>x</div>",
    "<div style='position: fixed; top: 0'>x</div>",
    "<div style='margin-top: -800px; height: 800px'>x</div>",
    "<div style='margin: calc(0px - 800px)'>x</div>",
    "<math><mtext></p><style><img src=x onerror=alert(1)></style></mtext></math>",
    "<img src='http://tracker/x.png'>",
    "<img src='data:image/svg+xml;base64,PHN2Zz4='>",
    "<meta http-equiv=refresh content='0;url=http://x'>",
    "<base href='http://x'>",
    "<p class='mark-graded' id='score' data-link='x'>x</p>",
    "<details ontoggle=alert(1) open>x</details>",
]


@pytest.mark.parametrize("html", ACTIVE)
def test_html_is_made_harmless(html):
    clean = safe.clean_html(html).lower()
    forbidden = ("script", "onerror", "onload", "ontoggle", "javascript:", "http://x", "tracker", "url(", "fixed", "svg",
                 "800px", "<form", "<input", "class=", "id=", "data-link", "<meta", "<base", "text/html")  # fmt: skip
    assert not [word for word in forbidden if word in clean]


def test_harmless_html_stays():
    """The neighbour: a pandas table, a data picture, a link and plain styles."""
    table = '<table class="dataframe"><tbody><tr><td style="text-align:right">1</td></tr></tbody></table>'
    assert safe.clean_html(table) == table
    picture = f'<img src="data:image/png;base64,{PNG}" alt="p">'
    assert safe.clean_html(picture) == picture
    assert 'href="https://example.org"' in safe.clean_html('<a href="https://example.org">x</a>')


def test_a_verdict_card_passes_unchanged():
    """Cards are cleaned with the rest when a page is shown: all they use is allowed."""
    case = Case("lecture", "mistake", 0.5, (0.25, 1.0), "(1, 2, 3)", "(1, 2, 4)", mistake="swap_uw")
    verdict = Verdict("cylinder", "failed", 0.0, "mistake", "m", "swap_uw", (case,), (("right", "a < b"), ("look", "`u`")))

    def plain(html):
        return html.replace("; ", ";").replace(": ", ":").replace("&nbsp;", "\xa0").replace(';"', '"').replace(", ", ",")

    shown = card.html(verdict)
    assert set(card.STYLE_PROPERTIES) <= safe._STYLES
    assert plain(safe.clean_html(shown)).count("style=") == shown.count("style=")
    assert safe.clean_html(safe.clean_html(shown)) == safe.clean_html(shown)


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("a <b>c</b>", "a &lt;b>c&lt;/b>"),
        ("x < y and y > z", "x < y and y > z"),
        ("`<b>` stays, <b> not", "`<b>` stays, &lt;b> not"),
        ("``a ` <b>`` <i>", "``a ` <b>`` &lt;i>"),
        ("```\n<b>\n```\n<i>", "```\n<b>\n```\n&lt;i>"),
        ("~~~ x\n<b>\n```\n~~~\n<i>", "~~~ x\n<b>\n```\n~~~\n&lt;i>"),
        ("$a<b$", "$a&lt;b$"),
        ("see <https://example.org/a> now", "see <https://example.org/a> now"),
        ("<!-- comment --> <?php ?>", "&lt;!-- comment --> &lt;?php ?>"),
        ("` <b> not closed", "` &lt;b> not closed"),
        ("> quoted", "> quoted"),
    ],
)
def test_raw_html_in_markdown_becomes_text_outside_code(source, expected):
    assert safe.escape_markdown(source) == expected


def test_outputs_come_from_a_whitelist():
    given = [
        {"output_type": "stream", "name": "evil", "text": ["a", "b"]},
        {"output_type": "display_data", "data": {"application/javascript": "alert(1)"}, "metadata": {}},
        {"output_type": "display_data", "data": {"image/svg+xml": "<svg/>", "text/plain": "x"}, "metadata": {"isolated": True}},
        {"output_type": "display_data", "data": {"image/png": PNG, "text/html": "<b onclick=x>b</b>"}, "metadata": {}},
        {"output_type": "display_data", "data": {"application/vnd.jupyter.widget-view+json": {}}, "metadata": {}},
        {"output_type": "execute_result", "data": {"text/plain": "1"}, "execution_count": "x"},
        {"output_type": "error", "ename": 1, "evalue": None, "traceback": ["a", 2]},
        {"output_type": "update_display_data"},
        "junk",
        None,
    ]
    clean = safe.outputs(given)
    assert clean == [
        {"output_type": "stream", "name": "stdout", "text": "ab"},
        {"output_type": "display_data", "data": {"text/plain": "x"}, "metadata": {}},
        {"output_type": "display_data", "data": {"image/png": PNG, "text/html": "<b>b</b>"}, "metadata": {}},
        {"output_type": "execute_result", "data": {"text/plain": "1"}, "metadata": {}, "execution_count": None},
        {"output_type": "error", "ename": "", "evalue": "", "traceback": ["a"]},
    ]


def test_figures_are_data_and_layout_and_fetch_nothing():
    figure = {
        "data": [{"type": "scatter3d", "x": [1.0, float("nan"), float("inf")], "text": "\ud800"}],
        "layout": {"images": [{"source": "http://x"}], "title": "t", "mapbox": {}, "geo": {}},
        "config": {"plotlyServerURL": "http://x"},
        "frames": [],
    }
    clean = safe.figure(figure)
    assert clean == {"data": [{"type": "scatter3d", "x": [1.0, None, None], "text": "\ufffd"}], "layout": {"title": "t"}}
    assert safe.figure({"data": [{"x": [10**400, 7]}], "layout": {"height": -(10**400)}}) == {
        "data": [{"x": [None, 7]}], "layout": {"height": None},
    }  # fmt: skip
    for kind in ("scattermapbox", "choropleth", "scattergeo", "densitymap"):
        assert safe.figure({"data": [{"type": kind}], "layout": {}}) is None
    for junk in (None, [], {"data": 7}, {"data": [7]}, {"data": [], "layout": 7}, {"data": [{"x": object()}], "layout": {}}):
        assert safe.figure(junk) is None


@pytest.mark.parametrize(
    ("layout", "kept"),
    [
        (
            {"template": {"layout": {"images": [{"name": "i", "source": "http://x"}], "font": 1}}},
            {"template": {"layout": {"font": 1}}},
        ),
        ({"template": {"layout": {"mapbox": {"style": "http://x"}}}}, {"template": {"layout": {}}}),
        (
            {"template": {"data": {"scatter": [{"type": "scattermapbox", "mode": "text"}]}}},
            {"template": {"data": {"scatter": [{"mode": "text"}]}}},
        ),
        ({"updatemenus": [{"buttons": [{"method": "relayout", "args": ["images[0].source", "http://x"]}]}]}, {}),
        ({"sliders": [{"steps": [{"method": "restyle", "args": [{"type": ["scattergeo"]}]}]}]}, {}),
        ({"sliders": [{"steps": [{"args": [{"visible": True}], "label": "a map"}]}]}, None),
        ({"template": "none"}, None),
    ],
    ids=["template", "its map", "its types", "a button", "a slider", "an honest slider", "a template's name"],
)
def test_nor_do_templates_and_buttons_of_figures(layout, kept):
    """plotly.js draws the named pictures of a template, and takes the type of a trace that has none from there."""
    clean = safe.figure({"data": [{"y": [1, 2]}], "layout": layout})
    assert clean["layout"] == (layout if kept is None else kept)


def test_too_much_is_cut_or_dropped():
    assert len(safe.text("x" * 10_000_000)) < safe.MAX_TEXT + 100
    assert safe.figure({"data": [{"x": ["y" * 100] * 100_000}], "layout": {}}) is None
    assert len(safe.outputs([{"output_type": "stream", "name": "stdout", "text": "x"}] * 1000)) == safe.MAX_OUTPUTS


KEYS = [
    "cell_type", "source", "metadata", "outputs", "data", "text/html", "text/plain", "nbgrader", "grade_id", "id",
    "attachments", "output_type", "text", "name", "layout", "application/vnd.plotly.v1+json",
]  # fmt: skip
KINDS = st.sampled_from(["code", "markdown", "display_data", "execute_result", "error", "stream"])
JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda children: st.lists(children, max_size=3) | st.dictionaries(st.sampled_from(KEYS), children | KINDS, max_size=5),
    max_leaves=12,
)
CELLS = st.fixed_dictionaries(
    {"cell_type": st.sampled_from(["code", "markdown", "raw"])},
    optional={"source": JSON, "metadata": JSON, "outputs": st.lists(JSON), "attachments": JSON, "id": JSON},
)


@settings(max_examples=300, deadline=None)
@given(st.lists(JSON | CELLS, max_size=4))
def test_any_json_becomes_a_valid_notebook_or_is_refused(cells):
    """Whatever a submission holds, the trusted side neither crashes nor writes an invalid notebook."""
    import nbformat

    raw = json.dumps({"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": cells}).encode()
    try:
        made = rebuild(parse(raw), Master("nb", {}), keep_outputs=True)
    except SubmissionError:
        return
    written = dumps(made.notebook)
    nbformat.validate(nbformat.reads(written.decode(), as_version=4))


@settings(max_examples=100, deadline=None)
@given(st.lists(st.dictionaries(st.text(max_size=5), JSON, max_size=3), max_size=4), st.text(max_size=20))
def test_a_written_notebook_holds_its_figures_on_one_line_each(layouts, text):
    """What is read back is what was written, figures among it, and everything else is as nbformat writes it."""
    import nbformat

    drawn = [safe.figure({"data": [{"type": "scatter", "x": [1.5, None]}], "layout": layout}) for layout in layouts]
    figures, text = [figure for figure in drawn if figure is not None], safe.text(text)
    shown = [{"output_type": "display_data", "metadata": {}, "data": {FIGURE: fig, "text/plain": text}} for fig in figures]
    cell = {"cell_type": "code", "id": "a", "metadata": {}, "source": text, "execution_count": 1, "outputs": shown}
    whole = {"cells": [cell, cell | {"id": "b"}], "metadata": {}, "nbformat": 4, "nbformat_minor": 5}
    written = dumps(whole).decode()
    read = nbformat.reads(written, as_version=4)
    assert [dict(output["data"][FIGURE]) for one in read["cells"] for output in one["outputs"]] == 2 * figures
    assert written.count('"data": [{"type": "scatter", "x": [1.5, null]}]') == 2 * len(figures)
    if not figures:
        assert written == nbformat.writes(nbformat.from_dict(whole)) + "\n"


@settings(max_examples=200, deadline=None)
@given(st.binary(max_size=200) | st.text(max_size=200).map(lambda text: text.encode("utf-8", "surrogatepass")))
def test_any_bytes_are_parsed_or_refused(data):
    with contextlib.suppress(SubmissionError):
        parse(data)
