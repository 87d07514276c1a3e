"""Chapters keep the form of a walkthrough, and run: as a reader gets them and with their solutions."""

import ast
import re

import pytest
from look import MOST_SCENES, folded, guesses, scenes, typed, words

from autograder.catalogue import shipped
from autograder.errors import CourseError
from autograder.notebook.chapter import build_chapter, chapters, title
from autograder.notebook.text import CODE_STUB, setup_source

CHAPTERS = {path.stem: path for path in chapters()}


def test_there_is_a_first_chapter():
    """The course begins with what a surface is."""
    assert title(next(iter(CHAPTERS.values()))) == "What a parametric surface is"


@pytest.mark.parametrize("name", CHAPTERS)
def test_question_comes_before_any_formula(name):
    """The first cell asks, in bold."""
    first = build_chapter(CHAPTERS[name]).cells[0]
    assert re.search(r"\*\*[^*]+\?\*\*", first.source)
    assert "$" not in first.source


@pytest.mark.parametrize("name", CHAPTERS)
def test_cells_hold_one_idea(name):
    """Prose of at most 110 words, code of at most 18 lines, unless it is folded."""
    for cell in build_chapter(CHAPTERS[name], solutions=True).cells:
        if cell.cell_type == "markdown":
            assert words(cell.source) <= 110, cell.source
        elif not folded(cell):
            assert cell.source.count("\n") < 18, cell.source


@pytest.mark.parametrize("name", CHAPTERS)
def test_helpers_are_those_of_the_assignments(name):
    """The second cell brings them, folded away; no chapter has a version of its own."""
    code = [cell for cell in build_chapter(CHAPTERS[name]).cells if cell.cell_type == "code"]
    assert code[0].source.startswith(setup_source() + "\n")
    assert folded(code[0])
    assert not [cell.source for cell in code[1:] if re.search(r"^def (reveal|holds|once_written)\b", cell.source, re.MULTILINE)]


@pytest.mark.parametrize("name", CHAPTERS)
def test_guess_comes_before_its_answer(name):
    """Every guess is revealed, in a later cell, and there are at least three."""
    nb = build_chapter(CHAPTERS[name])
    asked = guesses(nb)
    assert len(asked) >= 3
    for guess, number in asked.items():
        answers = [i for i, cell in enumerate(nb.cells) if f"reveal({guess}," in cell.source]
        assert answers, f"{guess} is never revealed"
        assert min(answers) > number


@pytest.mark.parametrize("name", CHAPTERS)
def test_chapter_links_on_and_a_browser_can_draw_it(name):
    """The last cell leads somewhere; the scenes fit into one page."""
    nb = build_chapter(CHAPTERS[name])
    targets = re.findall(r"\]\(([^)]+)\)", nb.cells[-1].source)
    books = {f"../{a.name}/{a.slug}.ipynb" for a in shipped().assignments} | {f"{stem}.ipynb" for stem in CHAPTERS}
    assert targets
    assert set(targets) <= books
    assert scenes(nb) <= MOST_SCENES


@pytest.mark.parametrize("name", CHAPTERS)
def test_chapter_shows_a_walk_and_a_wrong_picture(name):
    """Square and surface with a moving marker, and a comparison with an exercise's own mistake."""
    code = "\n".join(cell.source for cell in build_chapter(CHAPTERS[name]).cells if cell.cell_type == "code")
    assert "plot.walk(" in code
    assert ".mistakes" in code
    assert "against=" in code


@pytest.mark.parametrize("name", CHAPTERS)
def test_chapter_runs_with_its_solutions_and_every_claim_holds(name, run):
    """No error, no claim that fails, every check gives full points, and a browser can draw all that was drawn."""
    nb = build_chapter(CHAPTERS[name], solutions=True)
    asked = len(typed(nb))
    printed, drawn = [], 0
    for cell in run(nb).cells:
        for output in cell.get("outputs", []):
            assert output.output_type != "error", f"{cell.source}\n{output.evalue}"
            if output.output_type == "stream":
                printed += [(output.name, line) for line in output.text.splitlines()]
            figure = output.get("data", {}).get("application/vnd.plotly.v1+json", {"layout": {}})
            drawn += sum(key.startswith("scene") for key in figure["layout"])
    assert 0 < drawn <= MOST_SCENES
    assert [line for stream, line in printed if stream == "stderr"] == []
    assert not [line for _, line in printed if line.startswith("NO ")]
    assert sum(line.startswith("You said typed") for _, line in printed) == asked


@pytest.mark.parametrize("name", CHAPTERS)
def test_chapter_runs_as_a_reader_gets_it(name, run):
    """With the stubs in place nothing breaks: what needs them says that it waits."""
    nb = build_chapter(CHAPTERS[name])
    stubs = sum("NotImplementedError()" in cell.source for cell in nb.cells)
    done = run(nb)
    errors = [(cell.source, o.evalue) for cell in done.cells for o in cell.get("outputs", []) if o.output_type == "error"]
    assert errors == []
    waits = [o for cell in done.cells for o in cell.get("outputs", []) if "waits for your function" in o.get("text", "")]
    assert bool(waits) == bool(stubs)


def test_second_chapter_is_one_more_text_file(tmp_path):
    """Found by its name, in order, and built; files of other names are left alone."""
    (tmp_path / "02-sweeps.py").write_text("# %% [markdown]\n# # Sweeps\n#\n# **What moves?**\n\n# %%\n1 + 1\n")
    (tmp_path / "01-points.py").write_text(
        "# %% [markdown]\n# # Points\n\n# %%\ndef f():\n    ### BEGIN SOLUTION\n    return 1\n    ### END SOLUTION\n"
    )
    (tmp_path / "README.md").write_text("for authors")
    (tmp_path / "helpers.py").write_text("x = 1")
    found = chapters(tmp_path)
    assert [title(path) for path in found] == ["Points", "Sweeps"]
    bare, solved = build_chapter(found[0]), build_chapter(found[0], solutions=True)
    assert CODE_STUB.split("\n")[1] in bare.cells[1].source
    assert "return 1" in solved.cells[1].source
    for cell in [*bare.cells, *solved.cells]:
        if cell.cell_type == "code":
            ast.parse(cell.source)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("# %%\n1\n", ":1: a chapter begins with a"),
        ('# %% [markdown]\n# # T\n\n# %% check="f"\ncheck(f)\n', ":4: unknown option 'check'"),
        ("# %% [markdown]\n# # T\n\n# %% [markdown] setup=true\n# x\n", ":4: a setup cell holds code"),
        ("# %% [markdown]\n# # T\n#\n# ### BEGIN SOLUTION\n# x\n# ### END SOLUTION\n", ":1: a solution stands in a code cell"),
    ],
)
def test_text_that_is_no_chapter_is_named_with_its_line(tmp_path, text, said):
    """An author reads where to mend."""
    path = tmp_path / "01-x.py"
    path.write_text(text)
    with pytest.raises(CourseError) as caught:
        build_chapter(path)
    assert f"{path}{said}" in str(caught.value)
