"""How long the similarity report of a class takes, and how that grows with the class.

    python benchmarks/similarity.py [--sizes 100 200 500 1000]

Makes classes from the sample class of A1: every student has one of its answers for each exercise, with names, numbers and the
order of terms varied by a seeded generator, and one in fifty copies a neighbour. Prints seconds of CPU (so that other work on
the machine does not count), what they come to for one student, and the pairs that had to be looked at. Nothing is written.
"""

from __future__ import annotations

import argparse
import random
import re
import time

from autograder import demo
from autograder.catalogue import shipped
from autograder.integrity import Class, Part, report_on

WORDS = ("angle", "t", "phi", "rho", "a", "b", "points", "value", "p", "x", "y", "z", "out", "result")


def varied(source: str, rng: random.Random) -> str:
    """The source as another hand would write it: some numbers, operators and functions differ, a line is put in."""
    source = re.sub(r"\b2 \* np\.pi\b", lambda _: rng.choice(["2 * np.pi", "2.0 * np.pi", "np.pi * 2", "math.tau"]), source)
    lines = source.split("\n")
    for _ in range(rng.randint(1, 4)):
        operator, function = rng.choice("+-*/"), rng.choice(["sin", "cos", "abs", "sqrt", "array", "asarray"])
        made = f"    {rng.choice(WORDS)} = np.{function}({rng.choice(WORDS)} {operator} {rng.randint(2, 9)})"
        lines.insert(rng.randint(1, len(lines)), made)
    return "\n".join(lines)


def answers() -> list[dict[str, str]]:
    """What each member of the sample class of A1 writes for each exercise."""
    import nbformat

    assignment = shipped().assignment("A1")
    nb = nbformat.v4.new_notebook()
    nb.cells.append(nbformat.v4.new_code_cell("import numpy as np"))
    for exercise in assignment.exercises:
        for id in (exercise, f"check_{exercise}"):
            nb.cells.append(nbformat.v4.new_code_cell("", metadata={"nbgrader": {"grade_id": id}}))
    found = []
    for member in demo.cohort("A1"):
        cells = member.notebook(nb).cells
        named = {cell.metadata.get("nbgrader", {}).get("grade_id"): cell.source for cell in cells}
        found.append({exercise: named[exercise] for exercise in assignment.exercises if named.get(exercise)})
    return found


def classroom(size: int) -> Class:
    """A class of that size, the same every time."""
    rng = random.Random(size)
    known = answers()
    work = Class()
    for number in range(size):
        if number % 50 == 49:
            parts = work.parts[f"s{number - 1:05d}"]
        else:
            chosen = rng.choice(known)
            parts = [Part("n", name, place, varied(source, rng)) for place, (name, source) in enumerate(chosen.items(), 1)]
        work.parts[f"s{number:05d}"] = parts
    return work


def main() -> None:
    """Print the table."""
    reader = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    reader.add_argument("--sizes", type=int, nargs="+", default=[100, 200, 500, 1000])
    print(f"{'students':>8} {'CPU s':>8} {'ms each':>8} {'linked pairs':>13} {'of all':>8} {'striking':>9}")
    for size in reader.parse_args().sizes:
        work = classroom(size)
        begun = time.process_time()
        report = report_on(work, "A1", top=50)
        seconds = time.process_time() - begun
        pairs = size * (size - 1) // 2
        linked, striking = report.found.linked, len(report.found.striking)
        print(f"{size:8d} {seconds:8.2f} {1000 * seconds / size:8.2f} {linked:13d} {linked / pairs:8.1%} {striking:9d}")


if __name__ == "__main__":
    main()
