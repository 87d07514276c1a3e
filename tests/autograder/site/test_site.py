"""The site of the walkthroughs: what stands on its pages, what waits, and that no failure leaves half of it."""

import json
import re

import nbformat
import pytest
from site_pages import Elements

from autograder import site as sites
from autograder.cli import publishing
from autograder.errors import CourseError
from autograder.notebook.text import CODE_STUB, read
from autograder.site.run import Run

TITLE = "# %% [markdown]\n# # T\n\n"


def page(built, name):
    return (built.folder / name).read_text("utf-8")


def snapshot(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def test_the_index_lists_each_chapter_with_its_question(built):
    """Title, question, what it is about, its sections, and the links to read and to take away."""
    index = page(built, "index.html")
    assert "Lines &amp; planes &lt;i&gt;" in index
    assert "How many points make a line?" in index
    assert "You will need <math" in index
    assert 'href="01-lines.html#section-1"' in index
    assert [one.page for one in built.chapters] == ["01-lines.html", "02-planes.html"]
    assert (built.chapters[0].figures, built.chapters[0].guesses, built.chapters[0].solutions) == (2, 1, 1)


def test_every_link_leads_to_what_is_there_and_nothing_is_fetched(built):
    """Pages, anchors, notebooks, plotly.js: all in the folder; an assignment that is linked comes along as learners get it."""
    for path in built.folder.glob("*.html"):
        elements = Elements(path.read_text("utf-8"))
        targets = [*elements.values("href"), *elements.values("src")]
        assert targets
        for target in targets:
            file, _, anchor = target.partition("#")
            assert (built.folder / file).exists(), target
            assert not anchor or anchor in Elements((path.parent / (file or path.name)).read_text("utf-8")).values("id"), target
    nbformat.read(built.folder / "notebooks" / "A1" / "known-forms.ipynb", as_version=4)
    assert (built.folder / "plotly.js").stat().st_size > 1_000_000


def test_the_answer_waits_until_it_is_opened(built):
    """Input above; below it, closed, all that the answering cell shows, with a place for the reader's own words."""
    html = page(built, "01-lines.html")
    before, waits = html.split('<details class="waits" data-answers="points">')
    assert '<input id="guess-points"' in before
    assert "&#34;one&#34;, &#34;two&#34; or &lt;three&gt;" in before
    assert "two &amp; no more" not in before
    inside = waits.split("</section>")[0]
    assert 'You said <q class="said" data-guess="points">…</q>; it is two &amp; no more.' in inside
    assert inside.index("You said") < inside.index("counting &lt;b&gt;")
    assert "‹points›" not in html
    assert "points = None" not in re.sub(r"<[^>]+>", "", html)


def test_a_full_stop_stays_with_its_formula(tmp_path):
    """No line begins with the full stop; a formula on a line of its own is left alone."""
    text = TITLE + "# %% [markdown]\n# Take $x$, or ($y^2$). Not $z$ but\n#\n# $$w$$\n"
    (tmp_path / "01-x.py").write_text(text)
    sites.build(tmp_path / "site", tmp_path)
    html = (tmp_path / "site" / "01-x.html").read_text("utf-8")
    tied = re.findall(r'<span class="tied">(.*?)</span>', html)
    assert [re.sub(r"<annotation.*?</annotation>|<[^>]+>", "", one) for one in tied] == ["x,", "y2)."]


def test_a_name_that_nobody_answers_is_code(built):
    assert '<span class="n">nothing</span>' in page(built, "02-planes.html")
    assert "<form" not in page(built, "02-planes.html")


def test_a_gap_is_shown_as_its_stub_and_one_way_on_request(built):
    """What follows was run with the solution; the notebook to take away has the stub and no output."""
    html = page(built, "01-lines.html")
    before, way = html.split('<details class="source way">')
    assert "NotImplementedError" in before
    assert '<span class="mi">2</span>' not in before.split("def")[-1]
    assert '<span class="mi">2</span> <span class="o">*</span>' in way.split("</details>")[0]
    assert "SOLUTION" not in html
    assert "doubled: 42" in way
    notebook = nbformat.read(built.folder / "notebooks" / "course" / "01-lines.ipynb", as_version=4)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert any(CODE_STUB.split("\n")[1] in cell.source for cell in code)
    assert not any("2 * x" in cell.source or cell.outputs for cell in code)
    assert any(cell.source.startswith("points = None") for cell in code)


def test_folded_code_is_folded_and_figures_have_words(built):
    """Frames stay, or a walk could not move; a picture without words of its own says what its legend says."""
    html = page(built, "01-lines.html")
    assert html.index('<details class="source"><summary>') < html.index("First guess.")
    assert 'role="img" aria-label="A saddle."' in html
    assert 'role="img" aria-label="A drawing of a walk."' in html
    assert '"frames":[{"name":"f","data":[]}]' in html


def test_where_the_solution_was_taken_out_there_is_no_way_to_show(tmp_path):
    """As in an installed wheel: its chapters have stubs between their markers."""
    path = tmp_path / "01-x.py"
    stub = "\n    ".join(CODE_STUB.split("\n"))
    whole = f"{TITLE}# %%\ndef f():\n    ### BEGIN SOLUTION\n    {{}}\n    ### END SOLUTION\n"
    path.write_text(whole.format(stub))
    assert Run(path, read(path), None).solution(1) is None
    path.write_text(whole.format("return 1"))
    assert Run(path, read(path), None).solution(1) == "def f():\n    return 1"


@pytest.mark.parametrize(
    ("cell", "says"),
    [
        ("1 +\n", "01-x.py:4: this cell stopped with SyntaxError"),
        ("import time\ntime.sleep(60)\n", "01-x.py:4: this cell ran longer than 1 s"),
        ("import os\nos._exit(1)\n", "01-x.py:4: the kernel ended in this cell"),
    ],
)
def test_a_chapter_that_fails_names_its_cell_and_leaves_what_was_there(built, tmp_path, cell, says):
    """The earlier site stays as it was, and nothing half-written lies beside it."""
    (tmp_path / "chapters").mkdir()
    (tmp_path / "chapters" / "01-x.py").write_text(f"{TITLE}# %%\n{cell}")
    out = tmp_path / "out" / "site"
    out.parent.mkdir()
    out.mkdir()
    manifest = out / ".directrix-site"
    manifest.write_text('["index.html"]')
    (out / "index.html").write_text("earlier")
    with pytest.raises(CourseError) as caught:
        sites.build(out, tmp_path / "chapters", timeout=1)
    assert says in str(caught.value)
    assert [path.name for path in out.parent.iterdir()] == ["site"]
    assert snapshot(out) == {".directrix-site": b'["index.html"]', "index.html": b"earlier"}


def test_a_link_that_leads_nowhere_is_named(tmp_path):
    (tmp_path / "01-x.py").write_text(TITLE + "# %% [markdown]\n# [on](09-gone.ipynb)\n")
    with pytest.raises(CourseError, match=r"01-x.py:4: a link leads to 09-gone.ipynb, which is neither"):
        sites.build(tmp_path / "site", tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["01-x.py"]


def test_a_folder_that_is_not_a_site_of_ours_is_left_alone(chapters, tmp_path):
    """Refused before anything runs; nothing in it has changed."""
    other = tmp_path / "mine"
    other.mkdir()
    (other / "thesis.tex").write_text("years of work")
    for out, says in ((other, "thesis.tex"), (other / "thesis.tex", "is a file")):
        with pytest.raises(CourseError, match=says):
            sites.build(out, chapters, progress=pytest.fail)
    (other / ".directrix-site").write_text("not JSON")
    with pytest.raises(CourseError, match="holds what is not of the site"):
        sites.build(other, chapters, progress=pytest.fail)
    assert (other / "thesis.tex").read_text() == "years of work"


@pytest.mark.parametrize(("make", "says"), [(False, "no such folder"), (True, "has no chapter; a chapter is a file NN-")])
def test_a_folder_without_chapters_is_named(tmp_path, make, says):
    if make:
        (tmp_path / "course").mkdir()
    with pytest.raises(CourseError, match=says):
        sites.build(tmp_path / "site", tmp_path / "course")


def test_an_earlier_site_is_replaced_whole_and_a_program_is_told(tmp_path, capsys):
    """A chapter that is gone has no page any more; with --json standard output is one document."""
    texts, out = tmp_path / "texts", tmp_path / "site"
    texts.mkdir()
    (texts / "02-b.py").write_text(TITLE)
    out.mkdir()
    (out / "01-a.html").write_text("gone")
    (out / ".directrix-site").write_text('["01-a.html"]')
    publishing.site(out, texts, as_json=True)
    told = json.loads(capsys.readouterr().out)
    assert told["site"] == str(out)
    assert [one["page"] for one in told["chapters"]] == ["02-b.html"]
    listed = {".directrix-site", "02-b.html", "index.html", "notebooks/course/02-b.ipynb"}
    assert set(snapshot(out)) == listed
    assert sorted(path.name for path in tmp_path.iterdir()) == ["site", "texts"]
