"""The pages of the site: one for each chapter, and the one that lists them. Texts of a page come from the catalogue."""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jinja2
from directrix.plot import page as figures
from markupsafe import Markup

from autograder import catalogue
from autograder.feedback.cells import code_html, folded, output_html, phrase, style
from autograder.feedback.markdown import FindImage, to_html
from autograder.messages import listing, say
from autograder.notebook.chapter import GUESS, title
from autograder.notebook.text import Cell, stubbed
from autograder.site.run import Run, mark

PLOTLY = "plotly.js"
NOTEBOOKS = "notebooks"
HERE = Path(__file__).parent
SHEETS = (HERE.parent / "feedback" / "page.css", HERE / "reader.css")
_QUESTION = re.compile(r"^\*\*(.+?)\*\*[ \t]*$", re.DOTALL | re.MULTILINE)
_LINK = re.compile(r"\]\(([^)\s]+?\.ipynb)((?:#[^)\s]*)?)\)")
_SECTION = re.compile(r"<h2>(.*?)</h2>", re.DOTALL)
# A browser breaks the line between a formula and the full stop after it.
_TIED = re.compile(r"(<math\b(?![^>]*block)[^>]*>(?:(?!<math\b).)*?</math>[.,;:!?)]+)", re.DOTALL)


@dataclass(frozen=True)
class Opening:
    """What the first cell of a chapter says: its title, its question, and what the reader is going to do (Markdown)."""

    stem: str
    title: str
    question: str
    about: str

    @property
    def page(self) -> str:
        """The file of its page."""
        return f"{self.stem}.html"

    @property
    def notebook(self) -> str:
        """The file of its notebook, beside the page."""
        return f"{NOTEBOOKS}/course/{self.stem}.ipynb"


def opening(path: Path, first: Cell) -> Opening:
    """Read the first cell of a chapter."""
    body = first.source.partition("\n")[2].strip()
    asked = _QUESTION.search(body)
    about = body.replace(asked[0], "", 1).strip() if asked else body
    return Opening(path.stem, title(path), " ".join(asked[1].split()) if asked else "", about)


@dataclass(frozen=True)
class Page:
    """A chapter's page, and what it counts."""

    opening: Opening
    html: str
    sections: tuple[tuple[str, str], ...]  # anchor, heading
    figures: int
    guesses: int
    solutions: int
    linked: frozenset[str]  # notebooks of assignments that the page leads to


def chapter(run: Run, all_of_them: Sequence[Opening], *, shipped: bool, image: FindImage | None = None) -> Page:
    """The page of an executed chapter, between its neighbours.

    Raises
    ------
    CourseError
        With file and line, where a cell leads to a notebook that is no chapter and no assignment.
    """
    place = next(number for number, one in enumerate(all_of_them) if one.stem == run.path.stem)
    here = all_of_them[place]
    links = _Links({one.stem for one in all_of_them})
    answered = {name for number in range(len(run.written)) for name in run.answers(number)}
    cells = [_cell(run, number, here, answered, links, image) for number in range(len(run.written))]
    sections = _numbered(cells)
    text = _template("chapter.html.j2").render(
        here=here, cells=cells, sections=sections, shipped=shipped, style=Markup(style(*SHEETS)), script=Markup(_script()),
        head=Markup(figures.head(plotly_url=PLOTLY) if any(cell["figures"] for cell in cells) else ""),
        question=_inline(here.question),
        solved=any(cell["one_way"] for cell in cells), say=phrase, Markup=Markup,
        before=all_of_them[place - 1] if place else None,
        after=all_of_them[place + 1] if place + 1 < len(all_of_them) else None,
    )  # fmt: skip
    return Page(
        here, text, sections,
        figures=sum(cell["figures"] for cell in cells),
        guesses=sum(cell["kind"] == "guess" for cell in cells),
        solutions=sum(bool(cell["one_way"]) for cell in cells),
        linked=frozenset(links.assignments),
    )  # fmt: skip


def index(pages: Sequence[Page]) -> str:
    """The page that lists the chapters."""
    listed = [(page, _inline(page.opening.question), Markup(to_html(page.opening.about))) for page in pages]
    return _template("index.html.j2").render(pages=listed, style=Markup(style(*SHEETS)), say=phrase, Markup=Markup)


class _Links:
    """Turns links between notebooks into links between pages, and remembers which assignments are led to."""

    def __init__(self, chapters: set[str]) -> None:
        self.pages = {f"{stem}.ipynb": f"{stem}.html" for stem in chapters}
        self.assignments: set[str] = set()

    def turned(self, cell: Cell) -> str:
        def turn(found: re.Match[str]) -> str:
            target, anchor = found[1], found[2]
            if "://" in target:
                return found[0]
            if target in self.pages:
                return f"]({self.pages[target]}{anchor})"
            inside = target.removeprefix("../")
            if inside not in assignment_notebooks():
                raise cell.error(
                    f"a link leads to {target}, which is neither a chapter here nor a shipped assignment's notebook; "
                    "write NN-its-name.ipynb or ../A1/its-name.ipynb"
                )
            self.assignments.add(inside)
            return f"]({NOTEBOOKS}/{inside})"

        return _LINK.sub(turn, cell.source)


def assignment_notebooks() -> dict[str, Any]:
    """The notebooks of the shipped assignments as links name them, ``A1/known-forms.ipynb``."""
    return {f"{one.name}/{one.slug}.ipynb": one for one in catalogue.shipped().assignments}


def _cell(
    run: Run, number: int, here: Opening, answered: set[str], links: _Links, image: FindImage | None
) -> dict[str, Any]:  # fmt: skip
    cell, done = run.written[number], run.notebook.cells[number]
    shown: dict[str, Any] = {"kind": cell.kind, "outputs": [], "figures": 0, "one_way": "", "answers": ()}
    if cell.kind == "markdown":
        source = here.about if number == 0 else cell.source
        turned = links.turned(Cell("markdown", source, cell.path, cell.line))
        return shown | {"body": Markup(_TIED.sub(r'<span class="tied">\1</span>', to_html(turned, image=image)))}
    found = GUESS.match(cell.source)
    if found and found[1] in answered:
        rest = cell.source[found.end() :].strip("\n")
        return shown | {
            "kind": "guess",
            "name": found[1],
            "hint": found[2] or "",
            "body": Markup(code_html(rest)) if rest else "",
        }
    printed, said = _said(_merged(done.outputs), run.answers(number))
    outputs = [output_html(output, admit=_worded) for output in printed]
    solution = run.solution(number)
    return shown | {
        "body": Markup(code_html(stubbed(cell, keep_markers=False))),
        "one_way": Markup(code_html(solution)) if solution else "",
        "folded": folded(done),
        "answers": run.answers(number),
        "said": said,
        "outputs": [Markup(text) for text, _ in outputs if text],
        "figures": sum(drawn for _, drawn in outputs),
    }


def _merged(outputs: Sequence[Any]) -> list[dict[str, Any]]:
    """The outputs with what was printed in one go in one piece: a kernel sends it as it comes."""
    whole: list[dict[str, Any]] = []
    for output in outputs:
        if whole and output["output_type"] == "stream" and whole[-1].get("name") == output["name"]:
            whole[-1] = {**whole[-1], "text": whole[-1]["text"] + output["text"]}
        else:
            whole.append(dict(output))
    return whole


def _said(outputs: Sequence[dict[str, Any]], names: Sequence[str]) -> tuple[list[dict[str, Any]], list[Markup]]:
    """The outputs without the lines that say a guess, and those lines with a place for the reader's own words."""
    kept, said = [], []
    for output in outputs:
        if output["output_type"] != "stream":
            kept.append(output)
            continue
        rest = []
        for line in output["text"].splitlines():
            if not any(mark(name) in line for name in names):
                rest.append(line)
                continue
            shown = Markup.escape(line)
            for name in names:
                shown = shown.replace(mark(name), Markup('<q class="said" data-guess="{}">…</q>').format(name))
            said.append(shown)
        if any(rest):
            kept.append({**output, "text": "\n".join(rest)})
    return kept, said


def _worded(figure: Mapping[str, Any]) -> Mapping[str, Any]:
    """A figure of a chapter, which is ours, so that it keeps its frames and may be laid out for a phone; one without words for
    who cannot see it gets its legend's.
    """
    layout = figure.get("layout", {})
    meta = layout.get("meta") or {}
    if not isinstance(meta, Mapping):
        return figure
    meta = {**meta, "fit": True}
    if meta.get("alt"):
        return {**figure, "layout": {**layout, "meta": meta}}
    names = dict.fromkeys(trace["name"] for trace in figure.get("data", []) if trace.get("name"))
    words = say("site.drawing", names=listing(names)) if names else say("feedback.picture")
    return {**figure, "layout": {**layout, "meta": {**meta, "alt": words}}}


def _numbered(cells: Sequence[dict[str, Any]]) -> tuple[tuple[str, str], ...]:
    """Give each second heading an anchor; the sanitiser lets no other through."""
    sections: list[tuple[str, str]] = []

    def anchor(found: re.Match[str]) -> str:
        sections.append((f"section-{len(sections) + 1}", found[1]))
        return f'<h2 id="{sections[-1][0]}">{found[1]}</h2>'

    for cell in cells:
        if cell["kind"] == "markdown":
            cell["body"] = Markup(_SECTION.sub(anchor, str(cell["body"])))
    return tuple(sections)


def _inline(source: str) -> Markup:
    return Markup(to_html(source).strip().removeprefix("<p>").removesuffix("</p>"))


@functools.cache
def _script() -> str:
    return (HERE / "reader.js").read_text("utf-8")


@functools.cache
def _template(name: str) -> jinja2.Template:
    environment = jinja2.Environment(
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
        loader=jinja2.FileSystemLoader(HERE),
    )
    return environment.get_template(name)
