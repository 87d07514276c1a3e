"""Submissions per second: `directrix grade` beside `nbgrader autograde` with its stock Execute, whole processes.

    uv run python benchmarks/grading.py [--submissions 20] [--rounds 3] [--workers 0]

Both grade the same well-behaved notebooks of A1, in turn, round after round, each time from an ungraded copy of one course.
Under stock nbgrader `check(...)` refuses to judge (the learner's interpreter would hold the reference), so nbgrader only
executes the notebooks here and does less work than we do: the ratio is a lower bound. Times depend on the machine; the ratio is
what is meant to be read.
"""

from __future__ import annotations

import argparse
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from autograder import authoring, demo
from autograder.fleet import Course

ASSIGNMENT = "A1"
STOCK = "c = get_config()\nc.CourseDirectory.course_id = 'stock'\n"


def prepare(folder: Path, submissions: int) -> None:
    """A released course with that many different well-behaved submissions."""
    (made,) = authoring.new_course(folder, (ASSIGNMENT,))
    released = authoring.release(folder, ASSIGNMENT) / f"{made.slug}.ipynb"
    wanted = [m for m in demo.cohort(ASSIGNMENT) if m.kind in ("right", "mistake", "partial")]
    for number in range(submissions):
        member = wanted[number % len(wanted)]
        student = f"{member.student_id}-{number:03d}"
        demo.submit_one(member, released, Course(folder), ASSIGNMENT, student_id=student)
        notebook = folder / "submitted" / student / ASSIGNMENT / f"{made.slug}.ipynb"
        text = notebook.read_text("utf-8")
        notebook.write_text(text.replace("import numpy as np", f"import numpy as np  # {number}", 1), "utf-8")  # all different


def timed(command: list[str], folder: Path) -> float:
    """Wall time of a whole process in a folder, which must succeed."""
    start = time.perf_counter()
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True, env=environment)
    seconds = time.perf_counter() - start
    if result.returncode:
        sys.exit(f"{' '.join(command)} failed:\n{result.stderr[-3000:]}")
    return seconds


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--submissions", type=int, default=20)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--workers", type=int, default=0, help="of directrix; 0 means one for each processor")
    options = parser.parse_args()
    ours = [sys.executable, "-m", "autograder", "grade", ASSIGNMENT, "--workers", str(options.workers)]
    theirs = [sys.executable, "-m", "nbgrader", "autograde", ASSIGNMENT]
    with tempfile.TemporaryDirectory() as scratch:
        template = Path(scratch) / "template"
        prepare(template, options.submissions)
        seconds: dict[str, list[float]] = {"directrix grade": [], "nbgrader autograde": []}
        for number in range(options.rounds):
            for name, command in (("directrix grade", ours), ("nbgrader autograde", theirs)):
                course = Path(scratch) / f"{name.split()[0]}{number}"
                shutil.copytree(template, course)
                if command is theirs:
                    (course / "nbgrader_config.py").write_text(STOCK)
                seconds[name].append(timed(command, course))
    print(f"{options.submissions} submissions of {ASSIGNMENT}, {options.rounds} rounds in turn, {os.cpu_count()} processors")
    rates = {name: options.submissions / statistics.median(times) for name, times in seconds.items()}
    for name, rate in rates.items():
        print(f"  {name:20s} {rate:8.2f} submissions/s   (rounds: {', '.join(f'{t:.2f} s' for t in seconds[name])})")
    print(f"  ratio {rates['directrix grade'] / rates['nbgrader autograde']:.1f}")


if __name__ == "__main__":
    main()
