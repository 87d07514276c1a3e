"""Stock nbgrader commands with the one line of config give what `directrix grade` gives: same tables, same files."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest

from autograder import feedback, fleet

RIGHT = {"square": "def square(x): return x * x", "half": "def half(x): return x / 2"}
ADD = {"add": "def add(a, b): return a + b"}


def nbgrader(folder, *command):
    """Run a stock nbgrader command in a course folder."""
    place = Path(sys.executable).parent
    return subprocess.run(
        [place / "nbgrader", *command], cwd=folder, capture_output=True, text=True, timeout=300,
        env={**os.environ, "JUPYTER_CONFIG_DIR": str(folder / ".jupyter")},
    )  # fmt: skip


def duplicated(nb):
    """A learner's notebook with a test cell pasted twice and a forged tag on another."""
    twice = next(c for c in nb["cells"] if c["metadata"].get("nbgrader", {}).get("grade_id") == "test_square")
    nb["cells"].insert(2, {**twice, "id": "copy", "source": "3"})
    for cell in nb["cells"]:
        cell["metadata"]["tags"] = ["skip-execution"]


def well_behaved(room):
    room.sql("update assignment set duedate = '2027-02-01 12:00:00.000000'")
    room.hand_in("ada", {"one": {**RIGHT, "why": "It is so."}, "two": ADD}, timestamp="2027-02-01 11:00:00.000000 UTC")
    room.hand_in("bob", {"one": {"square": "def square(x): return 4", "half": "def half(x): return 0"}, "two": {}})
    room.hand_in("kim", {"one": {**RIGHT, "code_answer": "x = 2"}, "two": ADD}, timestamp="2027-02-03 11:00:00.000000 UTC")
    room.hand_in("leo", {"one": RIGHT}, files={"mine.txt": b"kept"})
    noisy = "import sys\ndef square(x):\n    print('!', file=sys.stderr)\n    return x * x"
    room.hand_in("tim", {"one": {"square": noisy}, "two": ADD})


def test_well_behaved_submissions_get_what_stock_nbgrader_gives(ordinary, tmp_path):
    """No line of ours in the config: nbgrader's own Execute and its kernel, against our sandbox. All tables agree."""
    well_behaved(ordinary)
    stock = ordinary.copy(tmp_path / "stock")
    done = nbgrader(stock.folder, "autograde", "ps1")
    assert done.returncode == 0, done.stderr
    graded = fleet.grade(ordinary.course(), "ps1")
    assert graded.failures == ()
    assert ordinary.tables() == stock.tables()
    assert set(ordinary.autograded()) == set(stock.autograded())


@pytest.fixture(scope="module")
def both(ordinary_template, classroom, tmp_path_factory, bridge_line):
    """Hostile and broken submissions too, graded by ours and by nbgrader with our line."""
    folder = tmp_path_factory.mktemp("both")
    ordinary = classroom(shutil.copytree(ordinary_template, folder / "ours"), "ps1")
    well_behaved(ordinary)
    ordinary.configure(bridge_line)
    ordinary.hand_in("dup", {"one": duplicated, "two": ADD})
    ordinary.hand_in("exit", {"one": {**RIGHT, "half": "import os; os._exit(0)"}, "two": ADD})
    half = "import numpy as np\ndef half(x): return np.float64(x / 2)"
    ordinary.hand_in("numpy", {"one": {**RIGHT, "half": half}, "two": ADD})
    ordinary.hand_in("zig", {"one": "{broken", "two": ADD})
    place = ordinary.hand_in("link", {"one": RIGHT, "two": ADD})
    (place / "book.txt").symlink_to(ordinary.folder / "gradebook.db")
    (place / "data.txt").symlink_to(ordinary.folder / "gradebook.db")  # the instructor has a file of that name
    secret = ordinary.course().secret()
    theirs = ordinary.copy(folder / "theirs")
    assert theirs.course().secret() == secret
    done = nbgrader(theirs.folder, "autograde", "ps1")
    graded = fleet.grade(ordinary.course(), "ps1")
    return ordinary, theirs, graded, done


def test_the_one_line_gives_the_same_marks_and_the_same_files(both):
    """The same tables for every submission that both can read, and byte for byte the same graded notebooks."""
    ours, theirs, graded, done = both
    assert done.returncode == 1  # the broken notebook, by name; the others went on
    assert "zig" in done.stderr
    assert [line.split(":")[0] for line in graded.broken] == ["zig"]

    def readable(tables):
        return {name: [row for row in rows if row[0] != "zig"] for name, rows in tables.items()}

    assert readable(ours.tables()) == readable(theirs.tables())
    mine = {name: data for name, data in ours.autograded().items() if not name.startswith("zig")}
    assert mine == theirs.autograded()
    assert "link/ps1/book.txt" not in mine
    assert mine["link/ps1/data.txt"] == b"of the instructor\n"


def test_feedback_is_the_same_page_and_tells_no_secrets(both):
    ours, theirs, _, _ = both
    done = nbgrader(theirs.folder, "generate_feedback", "ps1")
    assert done.returncode == 0, done.stderr
    pages = feedback.write(ours.course(), "ps1")
    for page in pages:
        if "zig" in page.parts:
            continue
        assert page.read_bytes() == (theirs.folder / page.relative_to(ours.folder)).read_bytes(), page
        html = page.read_text()
        for hidden in ("secret_number()) == 144", "BEGIN HIDDEN", "the secret scheme"):
            assert hidden not in html
    again = {page: page.stat().st_mtime_ns for page in pages}
    assert {page: page.stat().st_mtime_ns for page in feedback.write(ours.course(), "ps1")} == again


def test_nbgrader_releases_the_feedback_that_we_wrote(ordinary, tmp_path):
    """It reads the time of handing in and the secret of the exchange beside the pages, and stops where they are not."""
    place = ordinary.folder / "autograded/ada/ps1"
    place.mkdir(parents=True)
    shutil.copy(ordinary.folder / "release/ps1/one.ipynb", place)
    (place / "timestamp.txt").write_text("2027-02-01 11:00:00.000000 UTC")
    (place / "submission_secret.txt").write_text("s3cret")
    ordinary.configure(f'c.Exchange.root = "{tmp_path / "exchange"}"\n')
    (tmp_path / "exchange").mkdir(mode=0o777)
    (tmp_path / "exchange").chmod(0o777)
    (page,) = feedback.write(ordinary.course(), "ps1")
    done = nbgrader(ordinary.folder, "release_feedback", "ps1")
    assert done.returncode == 0, done.stderr
    released = list((tmp_path / "exchange" / "ordinary" / "feedback").glob("*.html"))
    assert [path.read_bytes() for path in released] == [page.read_bytes()]


def test_what_would_hold_the_class_or_fill_the_disk_is_named_and_the_others_are_graded(ordinary, bridge_line, tmp_path):
    """nbgrader waits for ever at the FIFO, and copies zeros until the disk is full. Either command leaves out the same."""
    ordinary.configure(bridge_line)
    left_out = ("zero", "proc", "large", "nowhere")
    (ordinary.hand_in("zero", {"one": RIGHT, "two": ADD}) / "[data].bin").symlink_to("/dev/zero")
    # as every file of the kernel's, pagemap too, which has hundreds of gigabytes, it says that it is empty
    (ordinary.hand_in("proc", {"one": RIGHT, "two": ADD}) / "data.bin").symlink_to("/proc/self/status")
    large = ordinary.hand_in("large", {"one": RIGHT, "two": ADD}, files={"data.txt": b""})
    os.truncate(large / "data.txt", 32_000_001)  # the instructor has a file of that name
    (ordinary.hand_in("nowhere", {"one": RIGHT, "two": ADD}) / "data.bin").symlink_to("nowhere")
    ours = ordinary.copy(tmp_path / "ours")
    ordinary.hand_in("many", {"one": RIGHT, "two": ADD})
    for number in range(21):
        (ordinary.folder / f"submitted/many/ps1/{number}").symlink_to("/dev/null")
    os.mkfifo(ordinary.hand_in("fifo", {"two": ADD}) / "one.ipynb")
    ordinary.hand_in("long", {"one": RIGHT, "two": ADD}, timestamp="2027-02-01 11:00:00 UTC".ljust(1001))
    os.mkfifo(ordinary.hand_in("when", {"one": RIGHT, "two": ADD}) / "timestamp.txt")
    (ordinary.hand_in("linked", {"two": ADD}) / "one.ipynb").symlink_to(ordinary.folder / "source/ps1/one.ipynb")
    ordinary.hand_in("whole", {})
    (ordinary.folder / "submitted/whole/ps1").rmdir()
    (ordinary.folder / "submitted/whole/ps1").symlink_to(ordinary.folder / "source/ps1")
    for name in ("new\nline", "a<b>", "zoe"):
        ordinary.hand_in(name, {"one": RIGHT, "two": ADD})
    done = nbgrader(ordinary.folder, "autograde", "ps1")
    assert done.returncode == 1
    for student in ("fifo", "many", "long", "when", "linked", "whole", "new\\nline", "a<b>"):
        assert f"{student}/ps1" in done.stderr or f"'{student}'" in done.stderr
        assert not (ordinary.folder / "autograded" / student / "ps1").exists()
    marked = dict(ordinary.sql(MARKED))
    assert marked == dict.fromkeys(("zoe", *left_out), 2.0)
    assert fleet.grade(ours.course(), "ps1", students=left_out).failures == ()
    theirs, mine = ordinary.autograded(), ours.autograded()
    assert {name for name in theirs if not name.startswith("zoe/")} == set(mine)
    assert mine["large/ps1/data.txt"] == theirs["large/ps1/data.txt"] == b"of the instructor\n"
    for student in left_out:
        assert f"{student}/ps1/" in done.stderr


MARKED = """select s.student_id, max(x.auto_score) from grade x join submitted_notebook sn on x.notebook_id = sn.id
    join submitted_assignment s on sn.assignment_id = s.id join base_cell b on x.cell_id = b.id
    where b.name = 'test_square' and x.auto_score is not null group by s.student_id"""


def test_what_the_notebook_wrote_is_kept_as_ours_keeps_it(ordinary, bridge_line, tmp_path):
    """No timestamp, no notebook; a file for a folder and a folder for a file; odd names hold nobody up."""
    write = "import os, shutil; shutil.rmtree('mine'); open('mine', 'w').write('x'); os.remove('flat'); os.mkdir('flat')"
    write += "; open('flat/a', 'w').write('y'); open('timestamp.txt', 'w').write('1999'); open('extra.ipynb', 'w').write('{}')"
    ordinary.configure(bridge_line)
    odd = {"flat": b"f", "Screenshot 10.00.00\u202fAM.png": b"p", "back\\slash": b"b"}
    place = ordinary.hand_in("ada", {"one": {**RIGHT, "square": f"{RIGHT['square']}\n{write}"}, "two": ADD}, files=odd)
    (place / "mine").mkdir()
    (place / "mine" / "b.txt").write_bytes(b"b")
    ordinary.course().secret()
    theirs = ordinary.copy(tmp_path / "theirs")
    done = nbgrader(theirs.folder, "autograde", "ps1")
    assert done.returncode == 0, done.stderr
    assert fleet.grade(ordinary.course(), "ps1").failures == ()
    theirs_files = theirs.autograded()
    assert theirs_files.pop("ada/ps1/back\\slash") == b"b"  # nbgrader copies it; ours leaves it out by name
    mine = ordinary.autograded()
    assert set(mine) == set(theirs_files)
    assert (mine["ada/ps1/mine"], mine["ada/ps1/flat/a"]) == (b"x", b"y")
    assert ordinary.tables() == theirs.tables()


def test_without_execution_nothing_has_a_mark(ordinary, bridge_line):
    """nbgrader keeps the outputs that were handed in, and scores them."""

    def forged(nb):
        for cell in nb["cells"]:
            if cell["cell_type"] == "code":
                result = {"output_type": "execute_result", "data": {"text/plain": "3"}, "metadata": {}, "execution_count": 1}
                cell["outputs"] = [result]

    ordinary.configure(bridge_line)
    ordinary.hand_in("ada", {"one": forged, "two": forged})
    done = nbgrader(ordinary.folder, "autograde", "ps1", "--no-execute")
    assert done.returncode == 0, done.stderr
    marks = {row[2]: (row[4], row[7]) for row in ordinary.tables()["grades"]}
    assert [marks[name] for name in ("test_square", "test_half", "test_add")] == [(None, 1)] * 3


def test_exercises_are_judged_under_nbgrader_too(surfaces):
    """A right cylinder: 4 points, its card, the notebook of `directrix grade` (which writes a figure in one line)."""
    right = "def cylinder(u, w, r, h):\n    u, w = np.broadcast_arrays(u, w)\n    a = 2 * np.pi * u\n"
    right += "    return np.stack([r * np.cos(a), r * np.sin(a), h * w], axis=-1)"
    surfaces.hand_in("ada", {"known-forms": {"cylinder": right}})
    done = nbgrader(surfaces.folder, "autograde", "A1")
    assert done.returncode == 0, done.stderr
    tables, files = surfaces.tables(), surfaces.autograded()
    marks = {row[2]: row[4] for row in tables["grades"]}
    assert marks["check_cylinder"] == 4.0
    assert marks["check_sphere"] == 0.0
    graded = fleet.grade(surfaces.course(), "A1", force=True)
    assert graded.student("ada").score == 4.0
    assert surfaces.tables() == tables
    again = surfaces.autograded()
    assert list(again) == list(files)
    for name, data in files.items():
        assert nbformat.reads(again[name].decode(), 4) == nbformat.reads(data.decode(), 4), name
