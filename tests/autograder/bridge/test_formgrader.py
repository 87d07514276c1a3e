"""Formgrader's page of a hostile notebook, through nbgrader's own template and our line of config, in a browser."""

import json

import pytest

HOSTILE = "<script>window.hacked = 1</script><img src=x onerror='window.hacked=2'><svg onload='window.hacked=3'>"
FIGURE = {
    "data": [{"type": "scatter", "x": [1, 2], "y": [1, 2], "name": HOSTILE}],
    "layout": {"title": {"text": "</script>" + HOSTILE}},
}
KINDS = {
    "text/html": HOSTILE,
    "text/markdown": HOSTILE + "[x](javascript:window.hacked=4)",
    "text/latex": HOSTILE,
    "text/plain": HOSTILE,
    "image/svg+xml": HOSTILE,
    "image/png": '"><script>window.hacked=5</script>',
    "application/javascript": "window.hacked = 6",
    "application/vnd.jupyter.widget-view+json": {"model_id": "</script>" + HOSTILE},
    "application/vnd.plotly.v1+json": FIGURE,
}


def hostile(kinds):
    outputs = [
        {"output_type": "display_data", "metadata": {kind: {"isolated": True}}, "data": {kind: data}}
        for kind, data in kinds.items()
    ]
    outputs += [
        {"output_type": "stream", "name": "stdout", "text": HOSTILE},
        {"output_type": "error", "ename": HOSTILE, "evalue": HOSTILE, "traceback": [HOSTILE]},
    ]
    meta = {"tags": ['"><script>window.hacked=7</script>']}
    graded = {
        "grade": True,
        "solution": False,
        "locked": True,
        "task": False,
        "schema_version": 3,
        "points": 1,
        "grade_id": "t",
    }
    cells = [
        {"cell_type": "markdown", "id": "a", "metadata": meta, "source": HOSTILE + "\n\n$x^2$ <math><mtext><script>1</script>"},
        {"cell_type": "raw", "id": "b", "metadata": {}, "source": HOSTILE},
        {"cell_type": "code", "id": "c", "metadata": {"nbgrader": graded, **meta}, "source": HOSTILE, "outputs": outputs,
         "execution_count": 1},
    ]  # fmt: skip
    return {"nbformat": 4, "nbformat_minor": 5, "metadata": {"widgets": {"x": HOSTILE}}, "cells": cells}


@pytest.fixture(scope="module")
def formgrade_page(tmp_path_factory):
    from nbconvert.exporters import HTMLExporter
    from traitlets.config import Config

    from autograder import bridge

    folder = tmp_path_factory.mktemp("formgrade")
    notebook = folder / "nb.ipynb"
    notebook.write_text(json.dumps(hostile(KINDS)))
    config = Config()
    bridge.configure(config)
    config.HTMLExporter.template_name = "formgrade"
    names = ("assignment_id", "notebook_id", "submission_id", "base_url", "student", "last_name", "first_name", "notebook_path")
    resources = {**dict.fromkeys(names, "x"), "index": 0, "total": 1}
    html, _ = HTMLExporter(config=config).from_filename(str(notebook), resources=resources)
    page = folder / "page.html"
    page.write_text(html, "utf-8")
    return page


def test_the_page_is_formgraders_with_our_formulas_and_figures(formgrade_page):
    html = formgrade_page.read_text()
    assert 'class="score tabbable"' in html
    assert "<msup>" in html
    assert "directrix-figure" in html
    assert "window.MathJax = {Hub" in html
    for address in ("cdnjs", "unpkg", "jsdelivr"):
        assert address not in html.split("</head>")[0]


@pytest.mark.browser
def test_no_stored_script_runs_in_an_instructors_browser(formgrade_page, chromium):
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        try:
            page = browser.new_page()
            asked = []
            page.on("request", lambda request: asked.append(request.url))
            page.goto(formgrade_page.as_uri())
            page.wait_for_selector(".directrix-figure svg.main-svg", timeout=30_000)
            page.wait_for_timeout(300)
            assert page.evaluate("window.hacked") is None
            assert [url for url in asked if url.startswith(("http", "ws"))] == []
        finally:
            browser.close()


@pytest.mark.browser
def test_without_our_line_the_same_notebook_runs_its_scripts(tmp_path, chromium):
    """The guard is what stops them: nbgrader's own page of the same notebook does not."""
    from nbconvert.exporters import HTMLExporter
    from playwright.sync_api import sync_playwright
    from traitlets.config import Config

    from autograder.bridge import _nbgrader_templates

    notebook = tmp_path / "nb.ipynb"
    notebook.write_text(json.dumps({**hostile({"text/html": HOSTILE}), "metadata": {}}))
    config = Config()
    config.HTMLExporter.template_name = "formgrade"
    config.HTMLExporter.extra_template_basedirs = _nbgrader_templates()
    html, _ = HTMLExporter(config=config).from_filename(str(notebook), resources={"index": 0, "total": 1})
    (tmp_path / "page.html").write_text(html, "utf-8")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        try:
            page = browser.new_page()
            page.route("http*://**", lambda route: route.abort())
            page.goto((tmp_path / "page.html").as_uri())
            page.wait_for_timeout(300)
            assert page.evaluate("window.hacked") is not None
        finally:
            browser.close()


def test_a_line_that_no_lexer_ends_with_is_broken_in_the_page():
    from autograder.bridge.pages import _folded

    assert _folded("x = 1\n\ny") == "x = 1\n\ny"
    broken = _folded("'\\N{" * 1000)
    assert max(map(len, broken.split("\n"))) == 2000
    assert broken.replace("\n", "") == "'\\N{" * 1000


def test_a_raw_cell_of_backticks_is_fenced_at_once():
    from autograder.bridge.pages import _as_code

    assert _as_code("a ` b") == "```\na ` b\n```"
    ticks = "`" * 1_000_000
    assert _as_code(f"x\n{ticks}") == f"{ticks}`\nx\n{ticks}\n{ticks}`"
