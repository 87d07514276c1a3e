"""The preprocessors that stand in for nbgrader's own during ``nbgrader autograde``.

    Rebuild         for ClearOutput, DeduplicateIds, OverwriteKernelspec and OverwriteCells
    Execute         runs the notebook in the sandbox, judges exercise cells; ``c.Execute...`` and --no-execute keep their sense
    LimitOutput     as nbgrader's, but stderr, which decides a mark, is not dropped
    SaveAutoGrades  our marks, by our write path

They do, notebook by notebook, what ``directrix grade`` does for a class, with the same functions.
"""

from __future__ import annotations

import dataclasses
import logging
from typing import Any

import nbformat
from nbgrader.preprocessors import ClearOutput, NbGraderPreprocessor
from nbgrader.preprocessors import Execute as NbGraderExecute
from nbgrader.preprocessors import LimitOutput as NbGraderLimitOutput

from autograder.bridge.context import Context
from autograder.gradebook import Gradebook, NotebookMarks, Record
from autograder.notebook import limit
from autograder.notebook.rebuild import rebuild
from autograder.notebook.run import Ran
from autograder.notebook.score import annotate, marks, unanswered

RESULT = "directrix"
log = logging.getLogger(__name__)


class Rebuild(NbGraderPreprocessor):  # type: ignore[misc]
    """Puts the rebuilt notebook in the place of the submitted one: see ``autograder.notebook.rebuild``."""

    def preprocess(self, nb: Any, resources: Any) -> tuple[Any, Any]:
        """Rebuild, and remove files that came through links."""
        context = Context.of(self, resources)
        built = context.rebuilt(keep_outputs=not ClearOutput(parent=self.parent).enabled)
        for name in context.drop_links():
            self.log.warning("%s: %s is a link; it was not copied", context.student, name)
        if (other := context.other_id(built)) is not None:
            self.log.warning("%s: %s.ipynb: %s", context.student, context.notebook, other)
        for note in built.notes:
            self.log.warning("%s: %s: %s", context.student, note.cell or context.notebook, note.text)
        return _node(built.notebook), resources


class Execute(NbGraderExecute):  # type: ignore[misc]
    """Runs the notebook in the sandbox. Exercise cells are judged from outside and never run by the learner's process."""

    def preprocess(self, nb: Any, resources: Any, km: Any = None) -> tuple[Any, Any]:
        """Run all cells and write their outputs."""
        context = Context.of(self, resources)
        built = context.rebuilt()
        ran = context.run(built)
        if ran.faults and context.lost:  # the sandbox itself, which is nothing of this submission: once more in another
            built = context.rebuilt()
            ran = context.run(built)
        context.keep(ran.files)
        for fault in ran.faults:
            self.log.error("%s: %s.ipynb: %s", context.student, context.notebook, fault)
        resources[RESULT] = (built, ran)
        return _node(built.notebook), resources


class LimitOutput(NbGraderLimitOutput):  # type: ignore[misc]
    """Cuts long outputs and tracebacks."""

    def preprocess(self, nb: Any, resources: Any) -> tuple[Any, Any]:
        """Cut in place."""
        limit.limit_outputs(nb.cells, self.max_lines, self.max_traceback)
        return nb, resources


class SaveAutoGrades(NbGraderPreprocessor):  # type: ignore[misc]
    """Marks every graded cell and writes the marks. What was not executed has no mark."""

    def preprocess(self, nb: Any, resources: Any) -> tuple[Any, Any]:
        """Mark, write, and put the notes of the marks under their cells."""
        context = Context.of(self, resources)
        ran: Ran | None = None
        if RESULT in resources:
            built, ran = resources[RESULT]
            built = dataclasses.replace(built, notebook=nb)
        else:
            built = dataclasses.replace(rebuild(nb, context.master, keep_outputs=True), notebook=nb)
        given = marks(built, ran)
        annotate(built, given)
        record = Record(context.student, context.timestamp(), {context.notebook: NotebookMarks(given, unanswered(built))})
        with Gradebook(resources["nbgrader"]["db_url"]) as book:
            book.write(context.row, [record], create_students=False)
        return _node(nb), resources


def _node(notebook: Any) -> Any:
    return nbformat.from_dict(notebook)  # type: ignore[no-untyped-call]
