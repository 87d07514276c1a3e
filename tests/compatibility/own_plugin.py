"""A pytest plugin: nbgrader's tests meet our line of configuration, and our preprocessors where they name nbgrader's.

nbgrader's tests of ``nbgrader autograde`` read their configuration by ``NbGrader.load_config_file``; our line follows there.
Its tests of single preprocessors make one and hand it a notebook, without a course around it: the stand-ins below do with the
same functions of ours what ``autograder.bridge.preprocessors`` does, and change the notebook in place, as these tests expect.
"""

import functools
import json
import sys

import nbformat
from nbgrader import preprocessors as stock
from traitlets.config import Config

from autograder import bridge
from autograder.bridge.preprocessors import LimitOutput
from autograder.gradebook import Gradebook, NotebookMarks, Record
from autograder.notebook.marks import CellRun
from autograder.notebook.master import Master, MasterCell
from autograder.notebook.rebuild import rebuild
from autograder.notebook.run import Ran
from autograder.notebook.score import marks, unanswered
from autograder.notebook.submission import parse


def row(resources):
    """The assignment of a test, read from its gradebook by us."""
    with Gradebook(resources["nbgrader"]["db_url"]) as book:
        return book.assignment(resources["nbgrader"]["assignment"])


def rebuilt(nb, master, **options):
    return rebuild(parse(json.dumps(nb).encode()), master, **options)


def put(nb, built):
    """The rebuilt notebook in the place of the submitted one; its cells stay the same objects."""
    cells = [nbformat.from_dict(cell) for cell in built.cells]
    if len(cells) == len(nb.cells):
        for old, new in zip(nb.cells, cells, strict=True):
            old.clear()
            old.update(new)
    else:
        nb.cells = cells
    nb.metadata = nbformat.from_dict(built.notebook["metadata"])


class OverwriteCells(stock.OverwriteCells):
    def preprocess(self, nb, resources):
        master = row(resources).notebooks[resources["nbgrader"]["notebook"]].master
        put(nb, rebuilt(nb, master, add_missing=self.add_missing_cells, missing=self.missing_cell_notification))
        return nb, resources


class OverwriteKernelspec(OverwriteCells):
    pass


class DeduplicateIds(stock.DeduplicateIds):
    """There is no gradebook in its tests: the notebook's own cells are the instructor's copy."""

    def preprocess(self, nb, resources):
        cells = {}
        for cell in nb.cells:
            meta = cell.metadata.nbgrader
            about = {name: meta.get(name) for name in ("locked", "grade", "solution", "points")}
            cells[meta.grade_id] = MasterCell(meta.grade_id, cell.cell_type, cell.source, **about)
        put(nb, rebuilt(nb, Master("test", cells)))
        return nb, resources


class SaveAutoGrades(stock.SaveAutoGrades):
    """The outputs that a test put into its cells are taken for what running them gave."""

    def preprocess(self, nb, resources):
        named = resources["nbgrader"]
        found = row(resources)
        built = rebuilt(nb, found.notebooks[named["notebook"]].master)
        for cell, given in zip(built.cells, nb.cells, strict=True):
            if cell["cell_type"] == "code":
                cell["outputs"] = given.get("outputs", [])
        ran = Ran([CellRun("ok") if cell["cell_type"] == "code" else None for cell in built.cells])
        record = Record(named["student"], None, {named["notebook"]: NotebookMarks(marks(built, ran), unanswered(built))})
        with Gradebook(named["db_url"]) as book:
            book.write(found, [record], create_students=False)
        return nb, resources


OURS = (OverwriteCells, OverwriteKernelspec, DeduplicateIds, SaveAutoGrades, LimitOutput)


def pytest_configure(config):
    from nbgrader import api
    from nbgrader.apps.baseapp import NbGrader

    api.get_alembic_version = functools.cache(api.get_alembic_version)  # a process for each new gradebook, always the same word
    read = NbGrader.load_config_file

    def with_our_line(self, *args, **options):
        read(self, *args, **options)
        line = Config()
        bridge.configure(line)
        self.update_config(line)

    NbGrader.load_config_file = with_our_line


def pytest_collection_modifyitems(items):
    for name in {item.module.__name__ for item in items}:
        if ".tests.preprocessors." in name:
            for ours in OURS:
                if hasattr(sys.modules[name], ours.__name__):
                    setattr(sys.modules[name], ours.__name__, ours)
