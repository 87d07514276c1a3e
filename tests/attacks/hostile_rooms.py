"""A course to attack, graded by nbgrader, otter or Directrix, and compared with before: marks, files, processes, what got out.

``abe`` has handed in and is graded before an attacker comes; ``zoe`` is graded after. Nothing is believed that the attacker's
notebook says of itself, but for secrets: those are random words, made anew for each room, and whoever can say one has seen it.
More than 400 lines, for the rooms of the graders are compared line by line: what one looks at, all do.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import secrets
import shutil
import socket
import sqlite3
import stat
import subprocess
import sys
import threading
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

from hostile_attacks import PRELUDE, RIGHT, TESTS, WRONG, Attack

CONFIG = """
c = get_config()
c.CourseDirectory.course_id = "attacked"
c.Execute.timeout = 3
c.Sandbox.withhold = ["geomdl"]
"""
BRIDGE = "from autograder import bridge\nbridge.configure(c)\n"
PARTLY = "def norm(v): return 2  # right for one of the tests"
MOST_WRITTEN = 8_000_000  # bytes that one graded submission may leave behind
SECONDS = 150  # that a grader may take for a room; otter has no limit of its own
CLOSE, PLAIN, HELPER, MODULE, PARTIAL = TESTS
BEGIN, END = "### BEGIN HIDDEN TESTS\n# {hidden}\n", "\n### END HIDDEN TESTS"
SOURCE = {
    "points": "import numpy as np\n\ndef points():\n    return [([3, 4], 5), ([6, 8], 10)]",
    "norm": "def norm(v):\n    ### BEGIN SOLUTION\n    return sum(x * x for x in v) ** 0.5\n    ### END SOLUTION",
    CLOSE: "np.testing.assert_allclose(norm([3, 4]), 5)\n" + BEGIN + "np.testing.assert_allclose(norm([1, 2, 2]), 3)" + END,
    PLAIN: BEGIN + "assert abs(norm([8, 15]) - 17) < 1e-9" + END,
    HELPER: "for p, length in points():\n    assert np.isclose(norm(p), length)",
    MODULE: BEGIN + "from geomdl.linalg import vector_magnitude\ndef _ref(v):\n    return vector_magnitude(v)\n"
    "assert norm((2, 3, 6)) == _ref((2, 3, 6))" + END,
    PARTIAL: "1.0 * (norm([0, 2]) == 2)",
}  # fmt: skip
OTTER = {
    CLOSE: [
        ">>> # {hidden}\n>>> np.testing.assert_allclose(norm([1, 2, 2]), 3)",
        ">>> bool(np.allclose(norm([3, 4]), 5))\nTrue",
    ],
    PLAIN: [">>> abs(norm([8, 15]) - 17) < 1e-9\nTrue"],
    HELPER: [">>> all(bool(np.isclose(norm(p), length)) for p, length in points())\nTrue"],
    MODULE: [
        ">>> from geomdl.linalg import vector_magnitude\n>>> def _ref(v):\n...     return vector_magnitude(v)\n"
        ">>> norm((2, 3, 6)) == _ref((2, 3, 6))\nTrue"
    ],
    PARTIAL: [">>> 1.0 * (norm([0, 2]) == 2)\n1.0"],
}
# Runs a command as the parent of whatever it leaves behind (prctl: PR_SET_CHILD_SUBREAPER), and ends that.
WATCH = """
import ctypes, json, os, signal, subprocess, sys, time
ctypes.CDLL(None).prctl(36, 1, 0, 0, 0)
report, seconds, command = sys.argv[1], float(sys.argv[2]), sys.argv[3:]
grader = subprocess.Popen(command)
try: code = grader.wait(seconds)
except subprocess.TimeoutExpired: code = 'no end'
def children():
    found = []
    for pid in filter(str.isdigit, os.listdir('/proc')):
        try: fields = open(f'/proc/{pid}/stat').read().rpartition(')')[2].split()
        except OSError: continue
        if int(fields[1]) == os.getpid() and int(pid) != grader.pid and fields[0] != 'Z':
            try: said = open(f'/proc/{pid}/cmdline').read().replace('\\0', ' ')
            except OSError: continue
            found.append((int(pid), said))
    return found
time.sleep(1.0)  # what is ending anyway may end
if code == 'no end': left = ['the grader itself']
else: left = [said for pid, said in children()]
if grader.poll() is None: grader.kill(); grader.wait()
for again in range(20):
    there = children()
    for pid, said in there: os.kill(pid, signal.SIGKILL)
    if not there: break
    time.sleep(0.1)
with open(report, 'w') as file: json.dump({'code': code, 'left': left}, file)
"""


@dataclass
class Seen:
    """What came of one attack: tests passed, secrets that got out, and what is not as it was."""

    points: float
    told: tuple[str, ...] = ()
    harm: tuple[str, ...] = ()

    @property
    def won(self) -> bool:
        """Whether the attacker has anything for it."""
        return bool(self.points or self.told or self.harm)

    def __str__(self) -> str:
        parts = [f"{self.points:g} of {len(TESTS)} points"] if self.points else []
        return "; ".join([*parts, *self.told, *self.harm]) or "nothing"


def template(folder: Path) -> Path:
    """The course with one assignment, released by nbgrader itself; its hidden tests hold a random word."""
    hidden = secrets.token_hex(8)
    cells = [_cell(name, text.replace("{hidden}", hidden)) for name, text in SOURCE.items()]
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    whole = {"nbformat": 4, "nbformat_minor": 5, "metadata": {"kernelspec": kernel}, "cells": cells}
    course = folder / "course"
    (course / "source" / "ps1").mkdir(parents=True)
    (course / "source" / "ps1" / "lengths.ipynb").write_text(json.dumps(whole))
    (course / "source" / "ps2").mkdir()
    (course / "source" / "ps2" / "exam.txt").write_text(f"the answers of next week: {secrets.token_hex(8)}\n")
    (course / "nbgrader_config.py").write_text(CONFIG)
    (course / "hidden.txt").write_text(hidden)
    _checked([sys.executable, "-m", "nbgrader", "generate_assignment", "ps1"], course)
    _hand_in(course, "abe", f"# {secrets.token_hex(8)}\n{RIGHT}", "2030-01-01 09:00:00 UTC")
    _checked([sys.executable, "-m", "nbgrader", "autograde", "ps1"], course)
    return course


def _cell(name: str, source: str) -> dict[str, Any]:
    flags = {"grade": name in TESTS, "solution": name == "norm", "locked": name != "norm", "task": False}
    meta = {"grade_id": name, "schema_version": 3, **flags, **({"points": 1} if name in TESTS else {})}
    return {
        "cell_type": "code", "id": name.replace("_", "-"), "metadata": {"nbgrader": meta}, "source": source, "outputs": [],
        "execution_count": None,
    }  # fmt: skip


def environment(**more: str) -> dict[str, str]:
    """The grader's environment: without ours, so that nobody's token but the decoy is there."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    kept = {key: os.environ[key] for key in ("HOME", "LANG", "TMPDIR") if key in os.environ}
    return {**kept, "PATH": path, "PYTHONDONTWRITEBYTECODE": "1", "OPENBLAS_NUM_THREADS": "1", **more}


def _checked(command: Sequence[str], folder: Path) -> None:
    done = subprocess.run(command, cwd=folder, env=environment(), capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)} failed:\n{done.stdout[-2000:]}{done.stderr[-4000:]}")


def _hand_in(course: Path, student: str, solution: str, timestamp: str, attack: Attack | None = None) -> None:
    notebook = json.loads((course / "release" / "ps1" / "lengths.ipynb").read_text())
    for cell in notebook["cells"]:
        if cell["metadata"].get("nbgrader", {}).get("grade_id") == "norm":
            cell["source"] = solution
    if attack is not None and attack.change is not None:
        attack.change(notebook)
    place = course / "submitted" / student / "ps1"
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir(parents=True)
    (place / "lengths.ipynb").write_text(json.dumps(notebook))
    (place / "timestamp.txt").write_text(timestamp)
    if attack is not None and attack.folder is not None:
        attack.folder(place, course)


class Room:
    """A copy of the course with one or several attackers, an open folder, and a server that writes down what it is sent."""

    def __init__(self, made: Path, folder: Path, attacks: Mapping[str, Attack]) -> None:
        self.course = Path(shutil.copytree(made, folder / "course", symlinks=True))
        self.drop, self.folder = folder / "drop", folder
        self.drop.mkdir()
        self.drop.chmod(0o777)
        self.attacks = {f"m{number:02}": attack for number, attack in enumerate(attacks.values())}
        self.proofs = {student: secrets.token_hex(8) for student in self.attacks}
        self.token = secrets.token_hex(8)
        self.heard = bytearray()

    # ---- handing in and grading

    def hand_in(self, *, earlier: bool = False) -> None:
        """The attackers' submissions, and zoe's; or what the attackers handed in before, where an attack has that."""
        for student, attack in self.attacks.items():
            if not earlier:
                _hand_in(self.course, student, self.cell(student), "2030-01-01 11:00:00 UTC", attack)
            elif attack.earlier:
                _hand_in(self.course, student, attack.earlier, "2030-01-01 10:00:00 UTC")
        if not earlier:
            _hand_in(self.course, "zoe", PARTLY, "2030-01-01 11:00:00 UTC")

    def cell(self, student: str) -> str:
        """The solution cell of an attacker. The proof stands there backwards, so that showing the cell shows nothing."""
        known = {"course": str(self.course), "drop": str(self.drop), "port": self.port, "who": student}
        return PRELUDE.format(**known, proof=self.proofs[student][::-1]) + self.attacks[student].text

    @contextlib.contextmanager
    def server(self) -> Iterator[None]:
        """Listens on a port of this machine."""
        with socket.create_server(("127.0.0.1", 0)) as listening:
            self.port = listening.getsockname()[1]
            threading.Thread(target=self._listen, args=(listening,), daemon=True).start()
            yield
            with contextlib.suppress(OSError):
                listening.shutdown(socket.SHUT_RDWR)

    def _listen(self, listening: socket.socket) -> None:
        with contextlib.suppress(OSError):
            while True:
                link, _ = listening.accept()
                with link, contextlib.suppress(OSError):
                    link.settimeout(5)
                    while part := link.recv(2**16):
                        self.heard += part

    def run(self, command: Sequence[str], around: Any = subprocess.run) -> dict[str, Any]:
        """A command in the course, with a token in its environment; its exit code and the processes that it left."""
        report = self.folder / "report.json"
        watched = [sys.executable, "-c", WATCH, str(report), str(SECONDS), *command]
        done = around(
            watched, cwd=self.course, env=environment(GRADER_TOKEN=self.token), text=True, capture_output=True, check=False
        )
        if not report.exists():
            raise RuntimeError(f"{' '.join(command)}: {done.stdout[-2000:]}{done.stderr[-4000:]}")
        self.said = done.stdout + done.stderr
        found: dict[str, Any] = json.loads(report.read_text())
        report.unlink()
        return found

    def grade(self, grader: str, around: Any = subprocess.run, zoe: Mapping[str, float] | None = None) -> dict[str, Seen]:
        """Hand in, grade, give feedback; what came of each attack. ``zoe``: the marks that she should get."""
        commands = {
            "ours": [sys.executable, "-m", "autograder", "grade", "ps1", "--workers", "2"],
            "nbgrader": [sys.executable, "-m", "nbgrader", "autograde", "ps1"],
        }
        options = {option for attack in self.attacks.values() for option in attack.options}
        command = [*commands["nbgrader" if options else grader], *sorted(options)]
        if grader == "ours":
            with (self.course / "nbgrader_config.py").open("a") as config:
                config.write(BRIDGE)
        with self.server():
            if any(attack.earlier for attack in self.attacks.values()):
                self.hand_in(earlier=True)
                self.run(command, around)
            self.hand_in()
            before = self.files()
            marks = self.others()
            ended = self.run(command, around)
            after = self.files()
            if any(attack.feedback for attack in self.attacks.values()):
                verb = ["autograder", "feedback"] if grader == "ours" else ["nbgrader", "generate_feedback"]
                self.run([sys.executable, "-m", *verb, "ps1"], around)
        harm = [f"changed: {path}" for path in sorted(before.keys() | after.keys()) if before.get(path) != after.get(path)]
        if self.others() != marks:
            harm.append("the gradebook holds other marks, or other tests, than before")
        harm += [f"{len(ended['left'])} processes left"] if ended["left"] and ended["code"] != "no end" else []
        graded = self.marks("zoe")
        if options:
            pass  # zoe has no outputs to keep
        elif graded is None:
            harm.append("a classmate is not graded")
        elif zoe is not None and graded != zoe:
            harm.append("a classmate has other marks")
        if isinstance(ended["code"], int) and ended["code"] < 0:
            harm.append("the grader was ended")
        elif ended["code"] == "no end":
            harm.append("the grader does not end")
        return {student: self.seen(student, harm) for student in self.attacks}

    # ---- looking

    def files(self) -> dict[str, str]:
        """Every file of the course but the gradebook, what is graded and our own records: what it holds."""
        found = {}
        for path in sorted(self.course.rglob("*")):
            where = path.relative_to(self.course).parts
            mine = where[0] in ("autograded", "feedback") and where[1:2] != ("abe",)
            if mine or where[0] in (".directrix", "gradebook.db") or where[0].startswith("gradebook.db"):
                continue
            kind = path.lstat().st_mode
            content = os.readlink(path).encode() if stat.S_ISLNK(kind) else path.read_bytes() if stat.S_ISREG(kind) else b""
            found["/".join(where)] = hashlib.sha256(content).hexdigest()
        return found

    def _sql(self, query: str, *values: str) -> list[tuple[Any, ...]]:
        with contextlib.closing(sqlite3.connect(self.course / "gradebook.db")) as book:
            return book.execute(query, values).fetchall()

    def others(self) -> list[tuple[Any, ...]]:
        """What of the gradebook no grading of these attackers may change: tests, cells, and abe's marks."""
        grades = self._grades("abe")
        return [*grades, *sorted(self._sql("select name, source, checksum, locked from source_cell"), key=repr)]

    def _grades(self, student: str) -> list[tuple[Any, ...]]:
        return self._sql(
            "select b.name, g.auto_score, g.manual_score, g.extra_credit from grade g join submitted_notebook n"
            " on g.notebook_id = n.id join submitted_assignment a on n.assignment_id = a.id"
            " join base_cell b on g.cell_id = b.id where a.student_id = ? order by b.name",
            student,
        )

    def marks(self, student: str) -> dict[str, float] | None:
        """Marks of a student, manual ones first, as nbgrader counts; None if not one cell was judged."""
        found = {name: manual if manual is not None else auto for name, auto, manual, _ in self._grades(student)}
        if all(mark is None for mark in found.values()):
            return None
        return {name: mark or 0.0 for name, mark in found.items()}

    def _canaries(self) -> dict[str, str]:
        abe = json.loads((self.course / "submitted" / "abe" / "ps1" / "lengths.ipynb").read_text())
        copied = next("".join(cell["source"]) for cell in abe["cells"] if cell["id"] == "norm").split()[1]
        return {
            "hidden tests seen": (self.course / "hidden.txt").read_text(),
            "next week's solutions seen": (self.course / "source" / "ps2" / "exam.txt").read_text().split()[-1],
            "a classmate's work seen": copied,
            "the grader's token seen": self.token,
        }

    def seen(self, student: str, harm: Sequence[str], points: float | None = None, shown: str = "") -> Seen:
        """What came of one attack: its own marks and words, and the harm done in the room."""
        graded = self.course / "autograded" / student
        files = [path for path in graded.rglob("*") if path.is_file()] if graded.exists() else []
        harm = list(harm)
        if sum(path.stat().st_size for path in files) > MOST_WRITTEN:
            harm.append("its graded files fill the disk")
        for path in files:
            text = path.read_text("utf-8", "replace")
            shown += _outputs(text) if path.suffix == ".ipynb" else text
        shown += "".join(path.read_text("utf-8", "replace") for path in self.drop.glob(f"{student}-*"))
        said = shown + self.heard.decode("utf-8", "replace")
        told = [what for what, word in self._canaries().items() if word in said]
        told += ["it got through"] if self.proofs[student] in said else []
        pages = (self.course / "feedback" / student).rglob("*.html") if self.attacks[student].feedback else []
        if any(_runs(page.read_text("utf-8")) for page in pages):
            harm.append("its script runs in the feedback page")
        if points is None:
            points = sum((self.marks(student) or {}).values())
        return Seen(points, tuple(told), tuple(harm))


class _Scripts(HTMLParser):
    """Notes whether a page holds the stored script, in a tag of its own or as what a tag does when it fails."""

    found = False
    inside = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.inside = tag == "script"
        self.found = self.found or any(name.startswith("on") and "stored" in (value or "") for name, value in attrs)

    def handle_endtag(self, tag: str) -> None:
        self.inside = False

    def handle_data(self, data: str) -> None:
        self.found = self.found or (self.inside and "='stored'" in data)


def _runs(page: str) -> bool:
    reader = _Scripts()
    reader.feed(page)
    return reader.found


def _outputs(text: str) -> str:
    try:
        cells = json.loads(text)["cells"]
    except (ValueError, KeyError):
        return text
    outputs = [output for cell in cells for output in cell.get("outputs", [])]
    # The traceback of a test that failed shows the test; feedback pages are where that is hidden or not.
    return json.dumps([{key: output[key] for key in output if key != "traceback"} for output in outputs], ensure_ascii=False)


class OtterRoom(Room):
    """The same, graded by `otter run` in an environment of its own; otter has no gradebook and grades one notebook."""

    python: Path

    def grade(self, grader: str, around: Any = subprocess.run, zoe: Mapping[str, float] | None = None) -> dict[str, Seen]:
        """Grade the attackers one by one."""
        found = {}
        for student in self.attacks:
            with self.server():
                work = self._laid_out(student)
                before = self.files()
                ended = self.run([str(self.python.parent / "otter"), "run", "-a", "ag.zip", "-o", ".", work.name], around)
                after = self.files()
            changed = [path for path in sorted(before.keys() | after.keys()) if before.get(path) != after.get(path)]
            harm = [f"changed: {path}" for path in changed if path not in (f"{student}.ipynb", "results.json")]
            harm += [f"{len(ended['left'])} processes left"] if ended["left"] and ended["code"] != "no end" else []
            harm += ["the grader does not end"] if ended["code"] == "no end" else []
            results = self.course / "results.json"
            shown, points = "", 0.0
            if results.exists():
                shown = results.read_text()
                points = sum(float(test.get("score") or 0.0) for test in json.loads(shown)["tests"])
                shown = _without_tests(shown)
            found[student] = self.seen(student, harm, points, shown)
        return found

    def _laid_out(self, student: str) -> Path:
        import zipfile

        hidden = (self.course / "hidden.txt").read_text()
        with zipfile.ZipFile(self.course / "ag.zip", "w") as archive:
            for name, cases in OTTER.items():
                listed = [{"code": case.replace("{hidden}", hidden)} for case in cases]
                suite = {"cases": listed, "scored": True, "setup": "", "teardown": "", "type": "doctest"}
                test = {"name": name, "points": 1, "suites": [suite]}
                archive.writestr(f"tests/{name}.py", f"OK_FORMAT = True\ntest = {test!r}\n")
        sources = [SOURCE["points"], self.cell(student)]
        cells: list[dict[str, Any]] = [
            {"cell_type": "code", "id": f"c{number}", "metadata": {}, "source": source, "outputs": [], "execution_count": None}
            for number, source in enumerate(sources)
        ]
        kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
        notebook = {"nbformat": 4, "nbformat_minor": 5, "metadata": {"kernelspec": kernel}, "cells": cells}
        (self.course / f"{student}.ipynb").write_text(json.dumps(notebook))
        return self.course / f"{student}.ipynb"


def _without_tests(results: str) -> str:
    """The output of tests without their text, which otter's results show to the instructor."""
    return "\n".join(line for test in json.loads(results)["tests"] for line in str(test.get("output", "")).splitlines()
                     if not line.lstrip().startswith((">>>", "...", "#")))  # fmt: skip


__all__ = ["RIGHT", "WRONG", "OtterRoom", "Room", "Seen", "template"]
