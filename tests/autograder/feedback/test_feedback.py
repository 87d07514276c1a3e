"""Feedback pages: formulas, hidden tests, hostile content, and what a browser makes of them."""

import base64
import importlib
import json
import shutil
import time

import pytest

from autograder import feedback, fleet
from autograder.cli import grading
from autograder.errors import CourseError
from autograder.feedback.cells import code_html
from autograder.feedback.formula import mathml
from autograder.feedback.hide import Hidden, strip_ansi
from autograder.feedback.markdown import to_html
from autograder.feedback.page import Scored, Sheet, render

RIGHT = {"square": "def square(x): return x * x", "half": "def half(x): return x / 2"}


@pytest.mark.parametrize(
    "latex",
    [r"\frac{a}{b}", r"\begin{aligned}a&=b\\c&=d\end{aligned}", r"\begin{bmatrix}1&0\\0&1\end{bmatrix}", r"a<b"],
)
def test_formulas_become_mathml(latex):
    shown = mathml(latex, block=True)
    assert shown.startswith('<math xmlns="http://www.w3.org/1998/Math/MathML" display="block">')


@pytest.mark.parametrize(
    "latex",
    [r"\text{<script>alert(1)</script>}", r"\text{<img src=x>}", "x_{", "{" * 600, "x" * 6000, r"x^{2}^{3}"],
)
def test_formulas_that_do_not_pass_are_shown_as_source(latex):
    shown = mathml(latex, block=False)
    assert shown.startswith("<code>")
    assert "<script" not in shown
    assert "<img" not in shown


def test_links_styles_and_classes_are_taken_out_of_formulas():
    for latex in (r"\href{javascript:alert(1)}{x}", r"\style{position:fixed}{x}", r"\class{mark-graded}{x}"):
        shown = mathml(latex, block=False)
        assert not any(word in shown for word in ("href", "javascript", "style=", "class"))


def test_names_of_functions_stand_off():
    assert '<mn>2</mn><mspace width="0.167em"></mspace><mi>cos</mi><mspace width="0.167em"></mspace><mi>u</mi>' in mathml(
        r"2\cos u", block=False
    )


def test_markdown_is_rendered_with_formulas_and_without_scripts():
    html = to_html("# T\n\nprice $x_1$ and `$code$`\n\n$$\na\n= b\n$$\n\na <script>x</script> [l](javascript:x) **b**")
    assert html.count("<math") == 2
    assert "<code>$code$</code>" in html
    assert "<strong>b</strong>" in html
    assert "script" not in html


def test_a_forged_place_of_a_formula_is_no_formula():
    assert "<math" not in to_html("\ue0000\ue001")


def test_pictures_come_from_the_folder_or_not_at_all(tmp_path):
    from autograder.feedback.write import images_of

    png = b"\x89PNG\r\n\x1a\n"
    (tmp_path / "a b.png").write_bytes(png)
    (tmp_path / "link.png").symlink_to(tmp_path / "a b.png")
    (tmp_path / "page.svg").write_text("<svg/>")
    find = images_of(tmp_path)
    assert find("a%20b.png").startswith("data:image/png;base64,iVBOR")
    for name in ("link.png", "page.svg", "../a b.png", "/etc/passwd", "no.png", "http://x/a.png", ""):
        assert find(name) is None
    assert "data:image/png" in to_html("![p](a%20b.png)", image=find)
    assert "[p]" in to_html("![p](http://x/a.png)", image=find)


def test_pictures_are_not_written_out_a_hundred_thousand_times(tmp_path, monkeypatch):
    write = importlib.import_module("autograder.feedback.write")  # the package has a function of that name
    png = b"\x89PNG\r\n\x1a\n" + bytes(992)
    (tmp_path / "a.png").write_bytes(png)
    monkeypatch.setattr(write, "MAX_IMAGES", 5000)
    assert to_html("![](a.png)" * 100, image=write.images_of(tmp_path)).count("<img") == 5
    pasted = {"a.png": {"image/png": base64.b64encode(png).decode()}}
    assert to_html("![](attachment:a.png)" * 100, attachments=pasted).count("<img") == 3


def test_environments_that_never_end_are_looked_for_once():
    """Each of them searched all that follows: a minute for the text of a cell that may have a million characters."""
    began = time.process_time()
    assert "<math" not in to_html("\\begin{align}\n" * 14_000 + "\\end{align} x")
    assert time.process_time() - began < 5.0
    several = to_html("a\n\\begin{align}\nx\n\\end{align} \nb\n\n\\begin{cases}\n\\begin{align}\ny\n\\end{align}")
    assert several.count("<math") == 2
    assert "<p>b</p>" in several


def test_code_that_no_person_wrote_has_no_colours():
    """The lexer takes the square of the length of such a line."""
    assert code_html("'\\N{" * 100_000).startswith('<div class="highlight"><pre>&#39;\\N{')
    assert "<span" in code_html("x = 1\n" * 1000)
    assert "<span" not in code_html("x = 1\n" * 50_000)


def test_hidden_tests_and_mark_schemes_are_taken_out():
    marks = Hidden()
    assert marks.source("a\n### BEGIN HIDDEN TESTS\nb\n### END HIDDEN TESTS\nc") == (
        "a\nc", ["### BEGIN HIDDEN TESTS", "b", "### END HIDDEN TESTS"],
    )  # fmt: skip
    assert marks.source("=== BEGIN MARK SCHEME ===\nopen to the end")[0] == ""
    assert marks.source("a\nb") == ("a\nb", [])


def test_a_traceback_through_a_hidden_test_is_not_shown():
    hidden = "### BEGIN HIDDEN TESTS\nassert f(7) == 49\n### END HIDDEN TESTS"
    error = {"output_type": "error", "ename": "AssertionError", "evalue": "", "traceback": ["\x1b[1massert\x1b[0m f(7) == 49"]}
    cell = {"cell_type": "code", "source": hidden, "metadata": {}, "outputs": [error]}
    assert Hidden().cell(cell)["outputs"][0]["traceback"] == ["AssertionError in a hidden test"]
    visible = {**error, "traceback": ["assert f(2) == 4"]}
    assert Hidden().cell({**cell, "outputs": [visible]})["outputs"] == [visible]


def test_terminal_escapes_are_taken_out():
    assert strip_ansi("\x1b[0;31mE\x1b[0m\x1b]0;title\x07\x00x\ty\n") == "Ex\ty\n"


HOSTILE = "<script>window.hacked = 1</script><img src=x onerror='window.hacked=2'><svg onload='window.hacked=3'>"


ENDING = "</script>" + HOSTILE


def hostile_notebook():
    outputs = [
        {"output_type": "display_data", "metadata": {}, "data": {"text/html": HOSTILE}},
        {"output_type": "display_data", "metadata": {}, "data": {"text/markdown": HOSTILE}},
        {"output_type": "display_data", "metadata": {}, "data": {"text/latex": HOSTILE}},
        {"output_type": "display_data", "metadata": {}, "data": {"image/svg+xml": HOSTILE}},
        {"output_type": "display_data", "metadata": {}, "data": {"application/javascript": "window.hacked = 4"}},
        {"output_type": "display_data", "metadata": {}, "data": {"image/png": '"><script>window.hacked=5</script>'}},
        {"output_type": "display_data", "metadata": {}, "data": {"application/vnd.plotly.v1+json": {
            "data": [{"type": "scatter", "x": [1, 2], "y": [1, 2], "name": HOSTILE}], "layout": {"title": {"text": ENDING}},
        }}},
        {"output_type": "stream", "name": "stdout", "text": HOSTILE},
        {"output_type": "error", "ename": HOSTILE, "evalue": HOSTILE, "traceback": [HOSTILE]},
    ]  # fmt: skip
    cells = [
        {
            "cell_type": "markdown",
            "metadata": {},
            "source": HOSTILE + "\n[x](javascript:window.hacked=6) $\\text{" + HOSTILE + "}$",
        },
        {"cell_type": "raw", "metadata": {}, "source": HOSTILE},
        {"cell_type": "code", "metadata": {"nbgrader": {"grade_id": "t"}}, "source": HOSTILE, "outputs": outputs},
    ]
    return {"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": cells}


@pytest.fixture(scope="module")
def hostile_page(tmp_path_factory):
    sheet = Sheet(HOSTILE, HOSTILE, HOSTILE, {"t": Scored(1.0, 2.0)}, {"t": HOSTILE})
    page = tmp_path_factory.mktemp("hostile") / "page.html"
    page.write_text(render(hostile_notebook(), sheet), "utf-8")
    return page


@pytest.mark.browser
def test_no_script_of_a_learner_runs_and_nothing_is_fetched(hostile_page, chromium):
    """The figure is drawn, so scripts do run on this page: ours."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        try:
            page = browser.new_page()
            asked, refused = [], []
            page.on("request", lambda request: asked.append(request.url))
            page.on("console", lambda message: refused.append(message.text) if "Content Security" in message.text else None)
            page.goto(hostile_page.as_uri())
            page.wait_for_selector(".directrix-figure svg.main-svg", timeout=30_000)
            page.wait_for_timeout(300)
            assert page.evaluate("window.hacked") is None
            assert [url for url in asked if not url.startswith(("file:", "data:", "blob:"))] == []
            assert refused == []
            # The guard is real: a script put there by hand does not run.
            page.evaluate("document.body.append(Object.assign(document.createElement('script'), {text: 'window.hacked = 9'}))")
            assert page.evaluate("window.hacked") is None
        finally:
            browser.close()


@pytest.mark.browser
def test_the_page_fits_a_phone(tmp_path, chromium):
    """A long formula and a comparison of two scenes scroll within the page, which itself does not."""
    from playwright.sync_api import sync_playwright

    compared = {"data": [], "layout": {"scene": {}, "scene2": {}, "height": 300}}
    output = {"output_type": "display_data", "metadata": {}, "data": {"application/vnd.plotly.v1+json": compared}}
    cells = [
        {"cell_type": "markdown", "metadata": {}, "source": "$$" + "+".join(f"x_{{{i}}}" for i in range(40)) + "$$"},
        {
            "cell_type": "code", "source": "1", "outputs": [output],
            "metadata": {"nbgrader": {"grade_id": "a_part_with_a_long_name", "grade": True, "points": 3}},
        },
    ]  # fmt: skip
    path = tmp_path / "page.html"
    scored = {"a_part_with_a_long_name": Scored(None, 3.0, look=True)}
    path.write_text(render({"cells": cells}, Sheet("nb", "A1", "ada", scored, {})), "utf-8")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        try:
            page = browser.new_page(viewport={"width": 390, "height": 800})
            page.goto(path.as_uri())
            assert page.evaluate("document.querySelector('.directrix-figure').clientWidth") >= 570
            assert page.evaluate("document.querySelector('math').scrollWidth") > 390
            assert page.evaluate("document.documentElement.scrollWidth") == 390
        finally:
            browser.close()


def test_the_page_says_the_marks_and_who_waits():
    cells = {"a": Scored(1.5, 2.0), "b": Scored(None, 3.0, look=True)}
    nb = {"cells": [{"cell_type": "markdown", "metadata": {"nbgrader": {"grade_id": "b"}}, "source": "my answer"}]}
    html = render(nb, Sheet("nb", "A1", "Ada", cells, {"b": "Well *said*."}, penalty=0.5))
    assert "<b>1</b> of 5 points" in html
    assert "0.5 points were taken off" in html
    assert "waits for your instructor" in html
    assert "Well <em>said</em>." in html
    assert "<script" not in html


def test_pages_are_written_for_who_is_graded(ordinary):
    ordinary.hand_in("ada", {"one": RIGHT, "two": {}}, timestamp="2027-02-01 12:00:00.000000 UTC")
    ordinary.hand_in("bob", {"one": RIGHT, "two": {}})
    with pytest.raises(CourseError, match="anybody is graded yet"):
        feedback.write(ordinary.course(), "ps1")
    fleet.grade(ordinary.course(), "ps1")
    pages = feedback.write(ordinary.course(), "ps1", ["bob"])
    assert [page.relative_to(ordinary.folder).as_posix() for page in pages] == [
        "feedback/bob/ps1/one.html", "feedback/bob/ps1/two.html",
    ]  # fmt: skip
    assert len(feedback.write(ordinary.course(), "ps1")) == 4
    assert (ordinary.folder / "feedback/ada/ps1/timestamp.txt").is_file()
    with pytest.raises(CourseError, match="eve is graded yet"):
        feedback.write(ordinary.course(), "ps1", ["eve"])


def test_one_page_that_cannot_be_written_keeps_no_other_back(ordinary, monkeypatch, caplog):
    for student in ("ada", "bob", "cyd", "dan"):
        ordinary.hand_in(student, {"one": RIGHT, "two": {}})
    fleet.grade(ordinary.course(), "ps1")
    (ordinary.folder / "autograded/bob/ps1/one.ipynb").write_text("{", "utf-8")

    def fails(notebook, sheet, **options):
        return 1 / 0 if sheet.student == "cyd" else render(notebook, sheet, **options)

    monkeypatch.setattr(importlib.import_module("autograder.feedback.write"), "render", fails)
    told = r"but for: .*bob/ps1/one.ipynb cannot be read: .*; grade it again with --force; cyd: ZeroDivisionError"
    with pytest.raises(CourseError, match=told):
        feedback.write(ordinary.course(), "ps1")
    assert sorted(path.parts[-3] for path in (ordinary.folder / "feedback").rglob("*.html")) == ["ada"] * 2 + ["dan"] * 2
    assert "the feedback of cyd could not be written" in caplog.text


def test_a_notebook_without_a_page_is_named_on_the_page_of_the_other(ordinary):
    """One was not handed in, one could not be read; the page of an earlier submission of it goes."""
    ordinary.hand_in("ada", {"one": RIGHT, "two": {}}, files={"submission_secret.txt": b"s3cret"})
    ordinary.hand_in("bob", {"one": RIGHT, "two": "{broken"})
    graded = fleet.grade(ordinary.course(), "ps1")
    assert graded.student("ada").missing == graded.student("bob").missing == ()
    assert "under that name" not in feedback.write(ordinary.course(), "ps1", ["ada"])[0].read_text()
    folder = ordinary.folder / "feedback" / "ada" / "ps1"
    assert {path.name for path in folder.iterdir()} == {"one.html", "two.html", "submission_secret.txt"}
    ordinary.hand_in("ada", {"one": RIGHT})
    for status in ("graded", "unchanged"):
        again = fleet.grade(ordinary.course(), "ps1").student("ada")
        assert (again.status, again.missing) == (status, ("two",))
    assert fleet.standing(ordinary.course(), "ps1").student("ada").missing == ("two",)
    ada, bob = feedback.write(ordinary.course(), "ps1")
    assert (ada.name, bob.name) == ("one.html", "one.html")
    assert not (folder / "two.html").exists()
    assert "<b>two</b> was not handed in under that name: 0 of 1 points." in ada.read_text()
    assert "<b>two</b> could not be read: 0 of 1 points. Ask your instructor." in bob.read_text()


def test_pages_of_a_submission_that_was_taken_away_are_named(ordinary, capsys):
    """They are not removed: whoever did so may have had another reason."""
    for student in ("ada", "bob"):
        for step in ("autograded", "feedback"):
            (ordinary.folder / step / student / "ps1").mkdir(parents=True)
        shutil.copy(ordinary.folder / "release/ps1/two.ipynb", ordinary.folder / "autograded" / student / "ps1")
    grading.feedback("ps1", ordinary.folder, student=None, as_json=False)
    assert capsys.readouterr().out.splitlines() == [f"2 pages under {ordinary.folder}/feedback"]
    shutil.rmtree(ordinary.folder / "autograded" / "bob")
    grading.feedback("ps1", ordinary.folder, student=None, as_json=False)
    place = ordinary.folder / "feedback/bob/ps1"
    assert capsys.readouterr().out.splitlines() == [
        f"1 page under {ordinary.folder}/feedback",
        f"{place}: pages of an earlier submission, which is graded no more; do not hand them out",
    ]
    assert (place / "two.html").is_file()


def test_a_card_and_its_figure_are_on_the_page_and_json_cannot_leave_its_element(surfaces):
    wrong = "def cylinder(u, w, r, h):\n    u, w = np.broadcast_arrays(u, w)\n    a = 2 * np.pi * w\n"
    wrong += "    return np.stack([r * np.cos(a), r * np.sin(a), h * u], axis=-1)"
    surfaces.hand_in("ada", {"known-forms": {"cylinder": wrong}})
    graded = fleet.grade(surfaces.course(), "A1")
    assert graded.student("ada").cells[0].mistake == "swap_uw"
    (page,) = feedback.write(surfaces.course(), "A1")
    html = page.read_text()
    assert "Partly right" in html
    assert html.count('<div class="directrix-figure wide"') >= 1
    assert html.count("directrix-packed") == 2  # the packed scripts and what unpacks them, once
    assert html.split("<body>")[0].count("sha256-") == 2
    assert "cdn" not in html.split("<body>")[1]
    for block in html.split("<body>")[1].split('<script type="application/vnd.plotly.v1+json">')[1:]:
        json.loads(block.split("</script>")[0])
