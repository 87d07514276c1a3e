"""Submissions per second, CPU per submission and peak memory: `directrix grade` beside nbgrader, otter and the bare sandbox.

    python benchmarks/grading.py [--submissions 200] [--peer 8] [--rounds 1] [--workers 1 2 4] [--course exercises]
                                 [--growth 100 1000 5000] [--dask tcp tls] [--otter] [--profile]

Three courses, made here by nbgrader's own release: ``exercises`` is A1, whose graded cells are ``check(...)``; ``alone`` has
only A1's tasks and those cells, not the pictures and trials around them; ``ordinary`` has cells of asserts, hidden ones among
them, as any nbgrader course. ``A2`` to ``A9`` are the other assignments. All submissions differ. Every figure is that of a
whole process from its start to its end, with children; CPU is user and system time of the process and of all it started, peak
memory the largest resident set of one process of it (of the trusted side: the grader's own processes, without the sandbox's).

nbgrader grades one submission after the other at a constant rate, so it is given fewer of them (``--peer``; some twenty are
the whole mixture of styles), and its start-up is taken off its time, in its favour; ours pays for its own. Under nbgrader
``check`` refuses to judge, since in the learner's own process every answer can be forged; here that refusal is lifted, so that
nbgrader has to do what ours does: the public data are judged in its kernel, and give the same marks. The tables of both are
compared.
The bare sandbox runs the same cells in the same kind of process, as many at a time, and reads, judges, writes nothing.
Times depend on the machine and on who else uses it; the ratios are what is meant to be read.
More than 400 lines, for a row is to be read beside the ones that it is compared with, all made in the same way.
"""

from __future__ import annotations

import argparse
import compileall
import contextlib
import functools
import json
import os
import resource
import shutil
import sqlite3
import subprocess
import sys
import sysconfig
import tempfile
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from autograder import authoring, demo
from autograder.fleet import Course
from autograder.fleet.workers import Crew
from autograder.notebook.session import opened

STOCK = "c = get_config()\nc.CourseDirectory.course_id = 'bench'\n"
JUDGING = "import os\nos.environ.pop('NBGRADER_EXECUTION', None)  # by which check knows that it is to refuse\n"
BARE = "bare sandbox"


@dataclass
class Figures:
    """What one whole process took."""

    submissions: int
    seconds: float
    cpu: float
    memory: int

    @property
    def rate(self) -> float:
        """Submissions a second."""
        return self.submissions / self.seconds


# ---- the courses


def exercises(folder: Path, submissions: int, *, assignment: str = "A1", alone: bool = False) -> str:
    """An assignment with that many different well-behaved submissions: right, mistaken, partial, in many styles.

    ``alone``: its set-up, task and exercise cells only, without the pictures and trials between them.
    """
    (made,) = authoring.new_course(folder, (assignment,))
    if alone:
        source = folder / "source" / assignment / f"{made.slug}.ipynb"
        whole = json.loads(source.read_text("utf-8"))
        code = [cell for cell in whole["cells"] if cell["cell_type"] == "code"]
        whole["cells"] = [code[0], *(cell for cell in code[1:] if "nbgrader" in cell["metadata"])]
        source.write_text(json.dumps(whole), "utf-8")
    released = authoring.release(folder, assignment) / f"{made.slug}.ipynb"
    wanted = [m for m in demo.cohort(assignment) if m.kind in ("right", "mistake", "partial")]
    for number in range(submissions):
        member = wanted[number % len(wanted)]
        student = f"s{number:05d}"
        demo.submit_one(member, released, Course(folder), assignment, student_id=student)
        notebook = folder / "submitted" / student / assignment / f"{made.slug}.ipynb"
        text = notebook.read_text("utf-8")
        notebook.write_text(text.replace("import numpy as np", f"import numpy as np  # {number}", 1), "utf-8")
    return assignment


def ordinary(folder: Path, submissions: int) -> str:
    """An nbgrader course of four numpy tasks with test cells of asserts, hidden tests and partial credit."""
    tasks = {
        "area": ("def area(r):\n    return np.pi * r**2", "def area(r):\n    return 2 * np.pi * r"),
        "unit": ("def unit(v):\n    return v / np.linalg.norm(v)", "def unit(v):\n    return v"),
        "bezier": (
            "def bezier(p, t):\n    p = np.asarray(p, float)\n    while len(p) > 1:\n        p = (1 - t) * p[:-1] + t * p[1:]\n"
            "    return p[0]",
            "def bezier(p, t):\n    return (1 - t) * p[0] + t * p[-1]",
        ),
        "table": (
            "def table(f, n):\n    return {k: f(k) for k in range(n)}",
            "def table(f, n):\n    return {k: f(k) for k in range(1, n)}",
        ),
    }
    tests = {
        "area": "assert np.isclose(area(2), 4 * np.pi)",
        "unit": "assert np.isclose(np.linalg.norm(unit(np.array([3.0, 4.0]))), 1)",
        "bezier": "assert np.allclose(bezier([[0, 0], [1, 2], [2, 0]], 0.5), [1, 1])",
        "table": "float(0.5 * (table(abs, 3).get(2) == 2) + 0.5 * (0 in table(abs, 3)))",
    }
    hidden = {name: f"\n### BEGIN HIDDEN TESTS\n{test}\n### END HIDDEN TESTS" for name, test in tests.items()}
    cells = [_cell("import numpy as np", "setup")]
    for name, (right, _) in tasks.items():
        solution = right.replace("\n", "\n    ### BEGIN SOLUTION\n", 1) + "\n    ### END SOLUTION"
        cells.append(_cell(solution, name, solution=True))
        twice = tests[name] if name == "table" else tests[name] + hidden[name]
        cells.append(_cell(twice, f"test-{name}", grade=True, locked=True, points=1))
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    whole = {"nbformat": 4, "nbformat_minor": 5, "metadata": {"kernelspec": kernel}, "cells": cells}
    (folder / "source" / "ps1").mkdir(parents=True)
    (folder / "source" / "ps1" / "numbers.ipynb").write_text(json.dumps(whole))
    (folder / "nbgrader_config.py").write_text(STOCK)
    _run([sys.executable, "-m", "nbgrader", "generate_assignment", "ps1"], folder)
    released = json.loads((folder / "release" / "ps1" / "numbers.ipynb").read_text())
    for number in range(submissions):
        for cell in released["cells"]:
            name = cell["metadata"].get("nbgrader", {}).get("grade_id")
            if name in tasks:
                wrong = (number >> list(tasks).index(name)) % 4 == 0
                cell["source"] = f"# {number}\n{tasks[name][wrong]}"
        place = folder / "submitted" / f"s{number:05d}" / "ps1"
        place.mkdir(parents=True)
        (place / "numbers.ipynb").write_text(json.dumps(released))
    return "ps1"


def _cell(source: str, name: str, **flags: Any) -> dict[str, Any]:
    cell = {"cell_type": "code", "id": name, "metadata": {}, "source": source, "outputs": [], "execution_count": None}
    if flags:
        plain = {"grade": False, "solution": False, "locked": False, "task": False, "schema_version": 3, "grade_id": name}
        cell["metadata"] = {"nbgrader": {**plain, **flags}}
    return cell


COURSES = {"exercises": exercises, "alone": functools.partial(exercises, alone=True), "ordinary": ordinary}
USUAL = list(COURSES)
COURSES |= {name: functools.partial(exercises, assignment=name) for name in (f"A{number}" for number in range(2, 10))}


# ---- measuring


def compile_packages() -> None:
    """Bytecode of everything that any of the processes may import, where it is missing."""
    for place in {sysconfig.get_path("stdlib"), sysconfig.get_path("purelib"), sysconfig.get_path("platlib")}:
        compileall.compile_dir(place, quiet=2, workers=0)
    for room in ("lib", "autograder", "assignments"):
        compileall.compile_dir(Path(__file__).parents[1] / room, quiet=2)


def _run(command: list[str], folder: Path, **variables: str) -> Figures:
    """A whole process in a folder, which must succeed; its memory is watched while it runs."""
    path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "PATH": path, **variables}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(command, cwd=folder, env=environment, stdout=said, stderr=said)
        peak = [0]
        watcher = threading.Thread(target=_watch, args=(process.pid, peak), daemon=True)
        watcher.start()
        process.wait()
        seconds = time.perf_counter() - start
        watcher.join()
        if process.returncode:
            said.seek(0)
            sys.exit(f"{' '.join(command)} failed:\n{said.read()[-3000:].decode('utf-8', 'replace')}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Figures(0, seconds, cpu, peak[0])


def _watch(pid: int, peak: list[int]) -> None:
    """The largest resident set of the process, its workers and what it started, without what runs inside a sandbox."""
    while True:
        found = [_resident(one) for one in (pid, *_children(pid))]
        if found[0] is None:
            return
        peak[0] = max(peak[0], *(size for size in found if size is not None))
        time.sleep(0.1)


def _children(pid: int) -> list[int]:
    try:
        names = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
        return [int(name) for name in names if "bwrap" not in Path(f"/proc/{name}/comm").read_text()]
    except OSError:
        return []


def _resident(pid: int) -> int | None:
    try:
        fields = dict(line.split(":", 1) for line in Path(f"/proc/{pid}/status").read_text().splitlines())
        return int(fields["VmHWM"].split()[0]) * 1024
    except (OSError, KeyError):
        return None


def bare(course: Course, assignment: str, workers: int) -> None:
    """Run the code cells of every submission in the sandbox, nothing else: how fast the sandbox alone can be."""
    with course.gradebook() as book:
        row = book.assignment(assignment)
    masters = course.masters(row)
    named = [cell.exercise for master in masters.values() for cell in master.graded if cell.exercise]
    posed = [found for name in named if (found := course.exercise(name)) is not None]

    def work(path: Path, number: int) -> int:
        cells = json.loads(path.read_bytes())["cells"]
        with open_session(files) as session:
            for cell in cells:
                source = "".join(cell["source"])
                if cell["cell_type"] == "code" and not source.startswith("check("):
                    session.run_cell(source)
        return len(cells)

    notebooks = sorted(path for folder in course.submissions(assignment).values() for path in folder.glob("*.ipynb"))
    files = course.instructor_files(assignment)
    with opened(posed, course.packages, None, None) as open_session, Crew(work, workers, {open_session.box.descriptor}) as crew:
        assert sum(1 for done in crew.each(notebooks) if done is not None) == len(notebooks)


def marks(folder: Path) -> list[tuple[Any, ...]]:
    """Every grade and comment of a gradebook, by names."""
    query = """select s.student_id, n.name, b.name, b.type, x.auto_score, x.manual_score, x.extra_credit, x.needs_manual_grade
               from grade x join submitted_notebook sn on x.notebook_id = sn.id join submitted_assignment s
               on sn.assignment_id = s.id join notebook n on sn.notebook_id = n.id join base_cell b on x.cell_id = b.id"""
    comments = query.replace("grade x", "comment x").replace(
        "x.auto_score, x.manual_score, x.extra_credit, x.needs_manual_grade", "x.auto_comment, x.manual_comment, 0, 0"
    )
    with sqlite3.connect(folder / "gradebook.db") as connection:
        return sorted(connection.execute(query).fetchall(), key=repr) + sorted(connection.execute(comments), key=repr)


def table(rows: dict[str, Figures], base: str) -> None:
    """One line for each, with its ratio to the first."""
    print(f"  {'':34}{'n':>6}{'/s':>9}{'CPU s each':>12}{'MB':>7}{'ratio':>8}")
    for name, row in rows.items():
        ratio = row.rate / rows[base].rate
        memory = f"{row.memory / 1e6:7.0f}" if row.memory else "      -"
        print(f"  {name:34}{row.submissions:>6}{row.rate:>9.2f}{row.cpu / row.submissions:>12.3f}{memory}{ratio:>7.1f}x")


def best(command: list[str], template: Path, scratch: Path, rounds: int, count: int, keep: str = "") -> Figures:
    """The quickest of some rounds, each on a fresh copy of the course with its first ``count`` submissions."""
    found = []
    for number in range(rounds):
        place = scratch / (keep or f"round{number}")
        shutil.rmtree(place, ignore_errors=True)
        shutil.copytree(template, place)
        for student in sorted((place / "submitted").iterdir())[count:]:
            shutil.rmtree(student)
        figures = _run(command, place, **(_stock(place) if "nbgrader" in command else {}))
        figures.submissions = count
        found.append(figures)
        if not keep:
            shutil.rmtree(place)
    return min(found, key=lambda one: one.seconds)


def _stock(place: Path) -> dict[str, str]:
    """Make a course one of stock nbgrader, whose kernels judge; the variables for that."""
    (place / "nbgrader_config.py").write_text(STOCK)
    startup = place / "ipython" / "profile_default" / "startup"
    startup.mkdir(parents=True)
    (startup / "judging.py").write_text(JUDGING)
    return {"IPYTHONDIR": str(place / "ipython")}


# ---- Dask


@contextlib.contextmanager
def dask_cluster(workers: int, protocol: str) -> Iterator[str]:
    """The address of a cluster of processes on this machine, running beforehand; with certificates of its own over TLS.

    Its workers are no children of the grader, so that the CPU time and memory of such a row are the grader's own alone.
    """
    import distributed

    security = distributed.Security.temporary() if protocol == "tls" else None
    files = {"CA_FILE": "tls_ca_file", "CLIENT__CERT": "tls_client_cert", "CLIENT__KEY": "tls_client_key"}
    named = {f"DASK_DISTRIBUTED__COMM__TLS__{name}": getattr(security, of) for name, of in files.items()} if security else {}
    with distributed.LocalCluster(
        n_workers=workers, threads_per_worker=1, protocol=f"{protocol}://", security=security, dashboard_address=None
    ) as cluster:
        os.environ.update(named)
        try:
            yield cluster.scheduler_address
        finally:
            for name in named:
                del os.environ[name]


# ---- otter


def otter(scratch: Path, notebook: Path) -> Figures | None:
    """`otter run` on one submission, in an environment of its own; None with a message where it cannot be had."""
    place = scratch / "otter"
    commands = [
        ["uv", "venv", "-q", str(place)],
        ["uv", "pip", "install", "-q", "--python", f"{place}/bin/python", "otter-grader", "ipykernel", "numpy"],
    ]
    try:
        for command in commands:
            subprocess.run(command, check=True, capture_output=True, timeout=600)
    except (OSError, subprocess.SubprocessError) as error:
        print(f"  otter-grader could not be installed here, so it is left out ({type(error).__name__})")
        return None
    work = scratch / "otter-work"
    (work / "tests").mkdir(parents=True)
    (work / "tests" / "q1.py").write_text(
        "OK_FORMAT = True\ntest = {'name': 'q1', 'points': 1, 'suites': [{'cases': [{'code': '>>> bool(area(1) > 3)\\nTrue'}], "
        "'scored': True, 'setup': '', 'teardown': '', 'type': 'doctest'}]}\n"
    )
    shutil.copy(notebook, work / "numbers.ipynb")
    subprocess.run(["zip", "-qr", "autograder.zip", "tests"], cwd=work, check=False)
    if not (work / "autograder.zip").exists():
        shutil.make_archive(str(work / "autograder"), "zip", work, "tests")
    figures = _run([f"{place}/bin/otter", "run", "-a", "autograder.zip", "numbers.ipynb"], work)
    figures.submissions = 1
    return figures


# ---- the command


def compare(name: str, options: argparse.Namespace, scratch: Path) -> None:
    """One course: nbgrader, the bare sandbox, ours with each number of workers; then feedback and growth."""
    template = scratch / name
    assignment = COURSES[name](template, options.submissions)
    grade = [sys.executable, "-m", "autograder", "grade", assignment, "--workers"]
    stock = [sys.executable, "-m", "nbgrader", "autograde", assignment]
    most = max(options.workers)
    again = functools.partial(best, template=template, scratch=scratch, rounds=options.rounds)
    one, many = again(stock, count=1), again(stock, count=options.peer, keep=f"{name}-stock")
    count = options.peer - 1
    rows = {"nbgrader autograde, start-up off": Figures(count, many.seconds - one.seconds, many.cpu - one.cpu, many.memory)}
    for workers in options.workers:
        keep = f"{name}-ours" if workers == most else ""
        rows[f"directrix grade, {workers} workers"] = again([*grade, str(workers)], count=options.submissions, keep=keep)
    sandbox = [sys.executable, __file__, "--bare", assignment, str(most)]
    rows[f"{BARE}, {most} workers"] = again(sandbox, count=options.submissions)
    for protocol in options.dask or ():
        with dask_cluster(most, protocol) as address:
            command = [*grade[:-1], "--scheduler", address]
            rows[f"directrix grade, Dask {protocol}, {most}"] = again(command, count=options.submissions)
    print(f"\n{name}: {assignment}, {options.submissions} different submissions, {os.cpu_count()} processors")
    table(rows, next(iter(rows)))
    share = rows[f"directrix grade, {most} workers"].rate / rows[f"{BARE}, {most} workers"].rate
    print(f"  directrix grade reaches {share:.0%} of what the bare sandbox alone does")
    graded, stocked = scratch / f"{name}-ours", scratch / f"{name}-stock"
    theirs = marks(stocked)
    students = {row[0] for row in theirs}
    mine = [row for row in marks(graded) if row[0] in students]
    print(f"  grades and comments of the {len(students)} that both graded: {'equal' if mine == theirs else 'DIFFERENT'}")
    if options.otter and name == "ordinary":
        figures = otter(scratch, next((graded / "submitted").rglob("*.ipynb")))
        if figures is not None:
            table({"otter run, start-up in it": figures, **rows}, next(iter(rows)))
    peer = _run([sys.executable, "-m", "nbgrader", "generate_feedback", assignment], stocked)
    ours = _run([sys.executable, "-m", "autograder", "feedback", assignment], graded)
    peer.submissions, ours.submissions = options.peer, options.submissions
    table({"nbgrader generate_feedback": peer, "directrix feedback": ours}, "nbgrader generate_feedback")


def growth(counts: list[int], scratch: Path, workers: int) -> None:
    """Rate and memory of the trusted side as the class grows; the submissions of the ordinary course, which are small."""
    template = scratch / "growth"
    assignment = ordinary(template, max(counts))
    command = [sys.executable, "-m", "autograder", "grade", assignment, "--workers", str(workers)]
    print("\ngrowth, ordinary course")
    table({f"{count} submissions": best(command, template, scratch, 1, count) for count in counts}, f"{counts[0]} submissions")


def profile(options: argparse.Namespace, scratch: Path) -> None:
    """Where the trusted side's time goes: cProfile of one process that grades some submissions, the sandbox's time outside."""
    import cProfile
    import importlib
    import pstats

    from autograder.fleet.one import grade_one
    from autograder.notebook.submission import read_folder

    folder = scratch / "profiled"
    assignment = COURSES[options.course[0]](folder, options.submissions)
    module = importlib.import_module("autograder.fleet.grade")
    course, profiler = Course(folder), cProfile.Profile()
    with course.gradebook() as book:
        run = module._Run(course, book, assignment, None, None)
        with run._plan() as plan:
            for student, place in course.submissions(assignment).items():
                profiler.runcall(grade_one, plan, student, read_folder(place))
    pstats.Stats(profiler).sort_stats("tottime").print_stats(40)


def main() -> None:
    if sys.argv[1:2] == ["--bare"]:
        bare(Course(Path.cwd()), sys.argv[2], int(sys.argv[3]))
        return
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--submissions", type=int, default=200, help="for ours and for the bare sandbox")
    parser.add_argument("--peer", type=int, default=8, help="for nbgrader, whose rate is constant")
    parser.add_argument("--rounds", type=int, default=1, help="the quickest of so many counts")
    parser.add_argument("--workers", type=int, nargs="+", default=[1, 2, 4])
    parser.add_argument("--course", nargs="+", choices=COURSES, default=USUAL)
    parser.add_argument("--growth", type=int, nargs="+", metavar="N", help="classes of these sizes, for example 100 1000 5000")
    parser.add_argument("--dask", nargs="+", choices=["tcp", "tls"], help="rows through Dask on this machine, by protocol")
    parser.add_argument("--otter", action="store_true", help="install otter-grader in a scratch environment and run it too")
    parser.add_argument("--profile", action="store_true", help="print where the trusted side's time goes, and nothing else")
    options = parser.parse_args()
    compile_packages()
    with tempfile.TemporaryDirectory() as scratch:
        if options.profile:
            profile(options, Path(scratch))
            return
        for name in options.course:
            compare(name, options, Path(scratch))
        if options.growth:
            growth(options.growth, Path(scratch), max(options.workers))


if __name__ == "__main__":
    main()
