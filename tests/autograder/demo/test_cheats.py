"""The cheats are real: where nothing holds them back each gets what it is after. So their zero in the sandbox means something.

Each runs in a Python process of its own, in a folder made for it.
"""

import json
import sqlite3
import subprocess
import sys
import threading
from contextlib import closing
from socketserver import BaseRequestHandler, TCPServer

import numpy as np
import pytest

from autograder.catalogue import shipped
from autograder.demo import cohort
from autograder.notebook import source

U = W = np.linspace(0, 1, 5)


@pytest.fixture
def free(tmp_path, released):
    """Runs a cheat of A1 unhindered in a course's folder, then the code that is given; returns what that prints as JSON."""
    members = {member.student_id[4:]: member for member in cohort("A1")}
    for slug in ("vectorised", "read-classmate"):
        member = members[slug]
        member.write(released["A1"], tmp_path / "course" / "submitted" / member.student_id / "A1")

    def run(slug, then):
        folder = tmp_path / "course" / "submitted" / members[slug].student_id / "A1"
        members[slug].write(released["A1"], folder)
        added = [
            cell.source
            for cell in members[slug].notebook(released["A1"]).cells
            if cell.cell_type == "code" and (cell.id.startswith("added") or cell.id in shipped().assignment("A1").exercises)
        ]
        program = "\n\n".join(["import json", "import numpy as np", *added, then])
        done = subprocess.run([sys.executable, "-c", program], cwd=folder, capture_output=True, text=True, timeout=60)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout.splitlines()[-1])

    return run


CALL = "u = w = np.linspace(0, 1, 5)\nprint(json.dumps(np.asarray(torus(u, w, 3.0, 1.0)).tolist()))"


def test_reading_the_reference_finds_it(free):
    np.testing.assert_allclose(free("read-reference", CALL), shipped().find("torus").reference(U, W, 3.0, 1.0), atol=1e-12)


def test_reading_a_classmates_notebook_finds_the_answer(free):
    np.testing.assert_allclose(free("read-classmate", CALL), shipped().find("torus").reference(U, W, 3.0, 1.0), atol=1e-12)


def test_writing_the_gradebook_changes_marks(free, tmp_path):
    """On a gradebook with nbgrader's own tables, as far as they matter here."""
    book = tmp_path / "course" / "gradebook.db"
    book.parent.mkdir(exist_ok=True)
    with closing(sqlite3.connect(book)) as db, db:
        db.executescript("""
            CREATE TABLE grade (id TEXT, notebook_id TEXT, auto_score REAL, manual_score REAL, needs_manual_grade BOOLEAN);
            CREATE TABLE submitted_notebook (id TEXT, assignment_id TEXT);
            CREATE TABLE submitted_assignment (id TEXT, student_id TEXT);
            INSERT INTO submitted_assignment
                VALUES ('a1', 's33-write-gradebook'), ('a2', 's01-vectorised'), ('a3', 's02-loops');
            INSERT INTO submitted_notebook VALUES ('n1', 'a1'), ('n2', 'a2'), ('n3', 'a3');
            INSERT INTO grade VALUES ('g1', 'n1', 0, NULL, 0), ('g2', 'n2', 6, NULL, 0), ('g3', 'n3', 6, NULL, 0);
        """)
    free("write-gradebook", "print(0)")
    with closing(sqlite3.connect(book)) as db, db:
        assert db.execute("SELECT manual_score FROM grade ORDER BY id").fetchall() == [(1000.0,), (0.0,), (None,)]
    assert list(tmp_path.rglob("written-by-a-learner"))


def test_patched_numpy_finds_nothing_wrong(free):
    then = (
        "wrong, right = torus(0.5, 0.5, 3.0, 1.0), np.ones(3)\n"
        "np.testing.assert_allclose(wrong, right)\n"
        "print(json.dumps([np.allclose(wrong, right), bool(wrong == right), float(np.max(np.abs(wrong - right)))]))"
    )
    assert free("patch-numpy", then) == [True, True, 0.0]


def test_the_forged_check_shows_full_marks(free):
    assert free("forge-output", "print(json.dumps(repr(check(torus))))") == "1000.0"


def test_a_server_that_listens_is_asked(free):
    answer = shipped().find("torus").reference(U, W, 3.0, 1.0)

    class Answers(BaseRequestHandler):
        def handle(self):
            self.request.recv(100)
            self.request.sendall(answer.tobytes())

    with TCPServer(("127.0.0.1", 0), Answers) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        given = free("open-socket", f"PLACES[:] = [('127.0.0.1', {server.server_address[1]})]\n{CALL}")
        server.shutdown()
    np.testing.assert_array_equal(given, answer)


def test_no_cheat_reaches_beyond_its_course():
    """Whoever opens one of these notebooks by hand loses nothing: no home folder, no other processes, and of the gradebook only
    the sample class's own rows."""
    for member in cohort("A1"):
        if member.kind == "cheat":
            text = source.dumps(member.notebook(source.release(source.build(shipped().assignment("A1")))))
            for reach in ("expanduser", "/proc", "shutil", "os.remove", "unlink"):
                assert reach not in text, f"{member.student_id}: {reach}"
