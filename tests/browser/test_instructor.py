"""An instructor looks at the graded class in formgrader, and a student at the feedback page: in Chromium, without a network."""

import nbformat
import pytest

from autograder import authoring, demo, feedback
from autograder.fleet import Course, grade
from tests.browser.conftest import jupyterlab
from tests.browser.lab import keep
from tests.browser.pixels import colours

pytestmark = pytest.mark.browser

STUDENTS = ("s01-vectorised", "s07-mistakes-1")
SCRIPTS = """<script>window.stolen = 1</script><img src=x onerror="window.stolen = 1">
<a href="javascript:window.stolen=1">look</a>
$\\href{javascript:window.stolen=1}{x}$ <iframe srcdoc="<script>parent.stolen = 1</script>"></iframe>"""

# What a click on a learner's link may lead to, and what must not come of it.
PAGE = "<script>document.title = 'stolen'; fetch('/api/contents').then(() => { document.title = 'stolen' })</script>my page"
LINKS = {
    "my page": "figure.html",
    "my picture": "figure.svg",
    "the list": "/formgrader/manage_students/%22%2B(document.title='stolen')%2B%22",
    "the class": "/formgrader/gradebook/%3C%2Fscript%3E%3Cscript%3Edocument.title='stolen'%3C%2Fscript%3E",
    "my course": "../../?path=submitted/s99-scripts/A1",
}


@pytest.fixture(scope="module")
def course(tmp_path_factory):
    """A released, graded A1 with a right notebook, one with mistakes, and one whose outputs and text carry scripts."""
    folder = tmp_path_factory.mktemp("instructor") / "course"
    authoring.new_course(folder, ("A1",))
    released = authoring.release(folder, "A1") / "known-forms.ipynb"
    course = Course(folder)
    members = {member.student_id: member for member in demo.cohort("A1")}
    for student in STUDENTS:
        demo.submit_one(members[student], released, course, "A1")
    demo.submit_one(members[STUDENTS[0]], released, course, "A1", student_id="s99-scripts")
    path = folder / "submitted" / "s99-scripts" / "A1" / "known-forms.ipynb"
    notebook = nbformat.read(path, 4)
    for cell in notebook.cells:
        graded = cell.metadata.get("nbgrader", {})
        if cell.cell_type == "markdown" and graded.get("solution"):
            cell.source = SCRIPTS + "".join(f"\n\n[{words}](<{place}>)" for words, place in LINKS.items())
        if cell.cell_type == "code" and graded.get("grade_id") == "cylinder":
            cell.source += f"\nfrom IPython.display import HTML, Javascript, display\ndisplay(HTML({SCRIPTS!r}))"
            cell.source += "\ndisplay(Javascript('window.stolen = 1'))"
    nbformat.write(notebook, path)
    (path.parent / "figure.html").write_text(PAGE)
    (path.parent / "figure.svg").write_text(f"<svg xmlns='http://www.w3.org/2000/svg'>{PAGE}</svg>")
    (path.parent / "nbgrader_config.py").write_text(f"open({str(folder / 'stolen')!r}, 'w').close()")
    report = grade(course, "A1")
    assert not report.failures
    feedback.write(course, "A1")
    return folder


def test_formgrader_shows_the_class_and_a_submission_with_its_card_and_figure(course, offline_page, tmp_path):
    """Manage submissions lists the class with its marks; a submission opens with the verdict card and a drawn figure."""
    with jupyterlab(course, tmp_path) as address:
        page = offline_page
        page.goto(f"{address}/formgrader/manage_submissions/A1")
        for student in STUDENTS:
            page.get_by_text(student).first.wait_for(timeout=60_000)
        keep(page.screenshot(), "formgrader-class")
        rows = page.locator("tr", has_text="s07-mistakes-1").inner_text()
        assert "11" in rows.split(), rows
        page.goto(f"{address}/formgrader/gradebook/A1/known-forms")
        page.get_by_text("Submission #1").first.wait_for(timeout=60_000)
        page.goto(submission_address(page, address, "s07-mistakes-1"))
        page.get_by_text("Cylinder from its known form").first.wait_for(timeout=60_000)
        plot = page.locator(".js-plotly-plot").first
        plot.wait_for(timeout=60_000)
        plot.scroll_into_view_if_needed()
        page.wait_for_timeout(3000)
        assert colours(keep(plot.screenshot(), "formgrader-figure")) > 200
        keep(page.screenshot(), "formgrader-submission")
        assert page.strays == []


def test_a_stored_script_runs_neither_in_formgrader_nor_in_feedback(course, offline_page, tmp_path):
    """Text, outputs, attributes, formulas, and where links lead: none of them runs in another person's browser."""
    page = offline_page
    with jupyterlab(course, tmp_path) as address:
        page.goto(submission_address(page, address, "s99-scripts"))
        page.get_by_text("Cylinder from its known form").first.wait_for(timeout=60_000)
        page.wait_for_timeout(2000)
        assert page.evaluate("() => window.stolen === undefined")
        submission = page.url
        for words in LINKS:
            page.goto(submission)
            page.get_by_role("link", name=words, exact=True).click()
            page.wait_for_url(lambda url: url != submission)
            page.wait_for_timeout(300)
            assert "stolen" not in page.title(), words
        assert "is a course" in page.inner_text("body")  # the last link is refused, with the reason
        assert not (course / "stolen").exists()
    page.goto((course / "feedback" / "s99-scripts" / "A1" / "known-forms.html").as_uri())
    page.wait_for_timeout(2000)
    assert page.evaluate("() => window.stolen === undefined")
    assert page.locator("a[href^='javascript']").count() == 0


def test_the_feedback_page_draws_its_figures_and_asks_no_other_machine(course, offline_page):
    """One file, opened from disk."""
    page = offline_page
    page.goto((course / "feedback" / "s07-mistakes-1" / "A1" / "known-forms.html").as_uri())
    card = page.get_by_text("Cylinder from its known form").first
    card.scroll_into_view_if_needed()
    page.locator(".js-plotly-plot canvas").first.wait_for(timeout=60_000)
    page.wait_for_timeout(3000)
    plot = page.locator(".js-plotly-plot", has=page.locator("canvas")).first
    plot.scroll_into_view_if_needed()
    page.wait_for_timeout(2000)
    assert colours(keep(plot.screenshot(), "feedback-figure")) > 200
    keep(page.screenshot(), "feedback-page")
    assert page.strays == []


def submission_address(page, address, student):
    """Where formgrader shows a student's notebook, asked of its own interface."""
    listed = page.request.get(f"{address}/formgrader/api/submitted_notebooks/A1/known-forms").json()
    (id,) = [notebook["id"] for notebook in listed if notebook["student"] == student]
    return f"{address}/formgrader/submissions/{id}/"
