"""Courses for the tests of grading: an ordinary nbgrader course with every kind of cell, and ours.

Both are made once by nbgrader itself (``generate_assignment``) and copied for each test that changes something.
"""

import datetime
import json
import os
import shutil
import sqlite3
import sys
from contextlib import closing
from pathlib import Path

import pytest

from tests.autograder.postgres_server import Server, programs

ORDINARY_CONFIG = """
c = get_config()
c.CourseDirectory.course_id = "ordinary"
c.LateSubmissionPlugin.penalty_method = "zero"
"""
BRIDGE = "from autograder import bridge\nbridge.configure(c)\n"


@pytest.fixture(autouse=True)
def _nbgrader_finds_alembic(monkeypatch):
    """nbgrader calls `alembic` by name when it makes a gradebook."""
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")


def nbgrader_cell(name, source, kind="code", *, grade=False, solution=False, locked=False, task=False, points=None):
    """A cell of a source notebook."""
    meta = {"grade_id": name, "grade": grade, "solution": solution, "locked": locked, "task": task, "schema_version": 3}
    if points is not None:
        meta["points"] = points
    return plain_cell(source, kind, name.replace("_", "-")) | {"metadata": {"nbgrader": meta}}


def plain_cell(source, kind="code", id="plain"):
    """A cell that nbgrader does not know."""
    extra = {"outputs": [], "execution_count": None} if kind == "code" else {}
    return {"cell_type": kind, "id": id, "metadata": {}, "source": source, **extra}


def as_notebook(*cells):
    """A notebook of these cells, as text."""
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    whole = {"nbformat": 4, "nbformat_minor": 5, "metadata": {"kernelspec": kernel}, "cells": list(cells)}
    return json.dumps(whole)


HIDDEN = "assert square(2) == 4\n### BEGIN HIDDEN TESTS\nassert square(secret_number()) == 144\n### END HIDDEN TESTS"
ANSWER = "Why?\n=== BEGIN MARK SCHEME ===\nthe secret scheme\n=== END MARK SCHEME ==="
SQUARE = "def square(x):\n    ### BEGIN SOLUTION\n    return x * x\n    ### END SOLUTION"
ORDINARY = {
    "one": as_notebook(
        plain_cell("# Ordinary\n\nWith $x^2$ and <b>bold</b> text.", "markdown", "intro"),
        nbgrader_cell("helper", "def secret_number():\n    return 12", locked=True),
        nbgrader_cell(
            "square", "def square(x):\n    ### BEGIN SOLUTION\n    return x * x\n    ### END SOLUTION", solution=True
        ),
        nbgrader_cell("test_square", HIDDEN, grade=True, locked=True, points=2),
        nbgrader_cell("half", "def half(x):\n    ### BEGIN SOLUTION\n    return x / 2\n    ### END SOLUTION", solution=True),
        nbgrader_cell("test_half", "3.0 * (half(4) == 2) if half(1) else 1.5", grade=True, locked=True, points=3),
        nbgrader_cell("code_answer", "### BEGIN SOLUTION\nx = 1\n### END SOLUTION", grade=True, solution=True, points=1.5),
        nbgrader_cell("why", "Because of the data.", "markdown", grade=True, solution=True, points=4),
        nbgrader_cell("essay", ANSWER, "markdown", task=True, locked=True, points=5),
    ),
    "two": as_notebook(
        nbgrader_cell("add", "def add(a, b):\n    ### BEGIN SOLUTION\n    return a + b\n    ### END SOLUTION", solution=True),
        nbgrader_cell("test_add", "assert add(1, 2) == 3", grade=True, locked=True, points=1),
    ),
}


def generated(folder, config, sources, name, database=None):
    """A course with one assignment released by nbgrader itself, its gradebook in that database (default: SQLite)."""
    from nbgrader.apps import NbGraderAPI
    from traitlets.config import Config

    place = folder / "source" / name
    place.mkdir(parents=True)
    (folder / "nbgrader_config.py").write_text(config)
    for notebook, text in sources.items():
        (place / f"{notebook}.ipynb").write_text(text)
    (place / "data.txt").write_text("of the instructor\n")
    loaded = Config()
    loaded.CourseDirectory.root = str(folder)
    loaded.CourseDirectory.course_id = "ordinary"
    if database is not None:
        loaded.CourseDirectory.db_url = database
    result = NbGraderAPI(config=loaded).generate_assignment(name, create=True)
    assert result["success"], result
    return folder


@pytest.fixture(scope="session")
def ordinary_template(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
        return generated(tmp_path_factory.mktemp("ordinary"), ORDINARY_CONFIG, ORDINARY, "ps1")


@pytest.fixture(scope="session")
def surfaces_template(tmp_path_factory):
    """A course with our A1, as `directrix new` and `directrix release` make it."""
    from autograder import authoring

    folder = tmp_path_factory.mktemp("courses") / "surfaces"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
        authoring.new_course(folder, ("A1",))
        authoring.release(folder, "A1")
    return folder


SWEPT_BACKWARDS = """def linear_sweep(u, w, curve, direction, d):
    direction = np.asarray(direction, float)
    if not direction.any():
        raise ValueError("no direction")
    return curve(u) - np.asarray(w)[..., None] * d * direction / np.linalg.norm(direction)
"""
TYPED = {"ada": "ada", "bob": "ada", "eve": ""}  # on a JupyterHub nobody needs to type anything


@pytest.fixture(scope="session")
def own_numbers_template(tmp_path_factory):
    """A2, numbers of one's own in it: Ada typed her id, Bob typed Ada's, Eve none; all sweep backwards."""
    from autograder import authoring

    folder = tmp_path_factory.mktemp("courses") / "own"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
        authoring.new_course(folder, ("A2",))
        authoring.release(folder, "A2")
    room = Classroom(folder, "A2")

    def typed(id):
        def change(nb):
            for cell in nb["cells"]:
                named = cell["metadata"].get("nbgrader", {}).get("grade_id")
                text = SWEPT_BACKWARDS if named == "linear_sweep" else "".join(cell["source"])
                cell["source"] = text.replace('student = ""', f'student = "{id}"')

        return change

    for student, id in TYPED.items():
        room.hand_in(student, {"linear-sweep": typed(id)})
    return room


class Classroom:
    """A course folder in which tests hand in."""

    def __init__(self, folder, assignment):
        self.folder, self.assignment = folder, assignment

    def released(self, notebook):
        return json.loads((self.folder / "release" / self.assignment / f"{notebook}.ipynb").read_text())

    def hand_in(self, student, notebooks, *, files=(), timestamp=None):
        """Notebooks by name: a dict of sources by grade id, a function that changes the released notebook, or raw text."""
        place = self.folder / "submitted" / student / self.assignment
        shutil.rmtree(place, ignore_errors=True)
        place.mkdir(parents=True)
        for name, change in notebooks.items():
            nb = self.released(name)
            if isinstance(change, dict):
                for cell in nb["cells"]:
                    named = cell["metadata"].get("nbgrader", {}).get("grade_id")
                    cell["source"] = change.get(named, cell["source"])
            elif callable(change):
                nb = change(nb) or nb
            (place / f"{name}.ipynb").write_text(change if isinstance(change, str) else json.dumps(nb))
        for name, data in dict(files).items():
            (place / name).write_bytes(data)
        if timestamp is not None:
            (place / "timestamp.txt").write_text(timestamp)
        return place

    def course(self):
        from autograder.fleet import Course

        return Course(self.folder)

    def configure(self, more):
        path = self.folder / "nbgrader_config.py"
        path.write_text(path.read_text() + more)

    def sql(self, statement, *values):
        with closing(sqlite3.connect(self.folder / "gradebook.db")) as connection, connection:
            return connection.execute(statement, values).fetchall()

    def tables(self):
        """The gradebook in words that do not depend on its random ids."""
        sub = "join submitted_notebook sn on x.notebook_id = sn.id join submitted_assignment s on sn.assignment_id = s.id"
        cell = f"{sub} join notebook n on sn.notebook_id = n.id join base_cell b on x.cell_id = b.id"
        columns = "x.auto_score, x.manual_score, x.extra_credit, x.needs_manual_grade"
        return {
            "grades": sorted(self.sql(f"select s.student_id, n.name, b.name, b.type, {columns} from grade x {cell}")),
            "comments": sorted(
                self.sql(f"select s.student_id, n.name, b.name, x.auto_comment, x.manual_comment from comment x {cell}"),
                key=repr,
            ),
            "submissions": sorted(self.sql("select student_id, timestamp, extension from submitted_assignment"), key=repr),
            "notebooks": sorted(
                self.sql(
                    "select s.student_id, n.name, sn.flagged, sn.late_submission_penalty from submitted_notebook sn "
                    "join submitted_assignment s on sn.assignment_id = s.id join notebook n on sn.notebook_id = n.id"
                ),
                key=repr,
            ),
            "students": sorted(self.sql("select * from student"), key=repr),
            "courses": sorted(self.sql("select * from course")),
        }

    def autograded(self):
        root = self.folder / "autograded"
        return {str(path.relative_to(root)): path.read_bytes() for path in sorted(root.rglob("*")) if path.is_file()}

    def copy(self, folder):
        shutil.copytree(self.folder, folder, symlinks=True)
        return Classroom(folder, self.assignment)


class PostgresClassroom(Classroom):
    """The same with its gradebook in PostgreSQL."""

    def __init__(self, folder, assignment, server, database):
        super().__init__(folder, assignment)
        self.server, self.database = server, database

    @classmethod
    def of(cls, template, server, folder):
        """A course of its own: copies of a course folder and of its database."""
        database = server.create(template.database)
        copy = cls(shutil.copytree(template.folder, folder, symlinks=True), template.assignment, server, database)
        copy.configure(f'c.CourseDirectory.db_url = "{server.url(database)}"\n')
        return copy

    def sql(self, statement, *values):
        rows = self.server.sql(statement, self.database)
        return [tuple(_as_sqlite(value) for value in row) for row in rows]

    def copy(self, folder):
        return PostgresClassroom.of(self, self.server, folder)


def _as_sqlite(value):
    """Truth and time as SQLite keeps them, so that gradebooks can be compared."""
    if isinstance(value, bool):
        return int(value)
    return f"{value:%Y-%m-%d %H:%M:%S.%f}" if isinstance(value, datetime.datetime) else value


@pytest.fixture(scope="session")
def postgres():
    """A running PostgreSQL. Without its programs such tests are skipped on a developer's machine, and fail in CI."""
    if programs() is None:
        pytest.skip("no PostgreSQL found: install the package `postgresql` to run these tests")
    server = Server()
    yield server
    server.close()


@pytest.fixture(scope="session")
def postgres_template(postgres, tmp_path_factory):
    """The ordinary course, released by nbgrader into PostgreSQL."""
    folder, database = tmp_path_factory.mktemp("ordinary-postgres"), postgres.create()
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
        generated(folder, ORDINARY_CONFIG, ORDINARY, "ps1", postgres.url(database))
    return PostgresClassroom(folder, "ps1", postgres, database)


@pytest.fixture
def in_postgres(postgres_template, tmp_path):
    """The ordinary course with its gradebook in PostgreSQL."""
    return postgres_template.copy(tmp_path / "in_postgres")


@pytest.fixture(scope="session")
def classroom():
    return Classroom


@pytest.fixture
def ordinary(ordinary_template, tmp_path):
    return Classroom(shutil.copytree(ordinary_template, tmp_path / "ordinary"), "ps1")


@pytest.fixture
def surfaces(surfaces_template, tmp_path):
    return Classroom(shutil.copytree(surfaces_template, tmp_path / "surfaces"), "A1")


@pytest.fixture(scope="session")
def bridge_line():
    return BRIDGE
