"""What nbgrader shows of graded notebooks: its feedback files and the pages of formgrader.

Feedback is our page (``autograder.feedback``), written by ``nbgrader generate_feedback``. Formgrader keeps its own template;
the notebook that goes into it is made harmless first, and formulas and figures need no network.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from directrix.plot import page as figures
from jinja2 import pass_context
from nbconvert.exporters import Exporter
from nbconvert.preprocessors import Preprocessor
from traitlets import Bool

from autograder.course import Course
from autograder.feedback import sheet
from autograder.feedback.cells import LONGEST_LINE
from autograder.feedback.markdown import to_html
from autograder.feedback.page import render
from autograder.feedback.write import course_hidden, images_of
from autograder.notebook import safe


class Feedback(Exporter):
    """The exporter of ``nbgrader generate_feedback``: one self-contained page a notebook."""

    output_mimetype = "text/html"

    def _file_extension_default(self) -> str:
        return ".html"

    def from_notebook_node(self, nb: Any, resources: Any = None, **options: Any) -> tuple[Any, Any]:
        """The page of one notebook."""
        nb, resources = super().from_notebook_node(nb, resources, **options)
        named = resources["nbgrader"]
        converter: Any = self.parent
        course = Course(converter.coursedir.root, config=self.config)
        folder = course.path("autograded", named["student"], named["assignment"])
        with course.gradebook() as book:
            scored = sheet(book, named["assignment"], named["student"], named["notebook"], folder)
        html = render(nb, scored, hidden=course_hidden(course), image=images_of(folder))
        resources["output_extension"] = ".html"
        return html, resources


class Harmless(Preprocessor):
    """Makes a notebook harmless before formgrader's template sees it, and turns figures into HTML that needs no network."""

    enabled = Bool(True).tag(config=True)

    def preprocess(self, nb: Any, resources: Any) -> tuple[Any, Any]:
        """Clean every cell in place."""
        drawn = False
        for cell in nb.cells:
            named = cell.metadata.get("nbgrader")
            cell.metadata = type(nb)({"nbgrader": named} if isinstance(named, Mapping) else {})
            if cell.cell_type == "raw":
                cell.cell_type, cell.source = "markdown", _as_code(cell.source)
            if cell.cell_type == "code":
                cell.source = _folded(cell.source)
                outputs = []
                for output in safe.outputs(cell.outputs):
                    if safe.FIGURE in output.get("data", {}):
                        shown = figures.fragment(output["data"][safe.FIGURE])
                        output["data"] = {"text/html": shown if drawn else figures.head() + shown}
                        drawn = True
                    outputs.append(_node(nb, output))
                cell.outputs = outputs
        nb.metadata.pop("widgets", None)
        return nb, resources


@pass_context
def markdown2html(context: Any, source: str) -> str:
    """Stands in for nbconvert's filter: Markdown through the sanitiser, formulas as MathML."""
    cell = context.get("cell") or {}
    resources = context.get("resources") or {}
    path = resources.get("metadata", {}).get("path", "")
    image = resources.setdefault("directrix_images", images_of(Path(path))) if path else None  # bounded for the whole page
    return to_html(source, attachments=safe.attachments(cell.get("attachments", {})), image=image)


def _as_code(source: str) -> str:
    fence = "`" * max(3, 1 + max(map(len, re.findall("`+", source)), default=0))
    return f"{fence}\n{source}\n{fence}"


def _folded(source: str) -> str:
    """The source with lines that no person wrote broken: the template's lexer may take the square of a line's length."""
    parts = ([line[at : at + LONGEST_LINE] for at in range(0, len(line), LONGEST_LINE)] or [""] for line in source.split("\n"))
    return "\n".join(part for line in parts for part in line)


def _node(nb: Any, output: Mapping[str, Any]) -> Any:
    made = type(nb)(output)
    for key in ("data", "metadata"):
        if key in made:
            made[key] = type(nb)(made[key])
    return made
