"""The public word of a course in its notebooks, from which numbers of one's own are drawn, and the id that a student typed.

A notebook that shows such numbers says ``personal.course("...")`` in a locked cell, usually the setup cell; releasing it writes
the course's word there. Grading reads the word from the instructor's copy. The id in a submission is never trusted: whose work
it is, its folder says.
"""

from __future__ import annotations

import ast
import functools
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from autograder import personal
from autograder.exercise import Exercise
from autograder.notebook.master import Master

COURSE = re.compile(r"^personal\.course\((?P<quote>[\"'])(?P<salt>[^\"'\\\n]*)(?P=quote)\)", re.MULTILINE)
VARIABLE = "student"
Find = Callable[[str], Exercise | None]


def salt_in(source: str) -> str | None:
    """The word in a cell; None where it has none."""
    found = COURSE.search(source)
    return found["salt"] if found else None


def with_salt(source: str, salt: str) -> str:
    """The cell with the course's word in the place of the one that is there."""
    return COURSE.sub(f'personal.course("{salt}")', source)


def of_student(find: Find, master: Master, student: str) -> Find:
    """Exercises by name with the public data of a student, as the instructor's copy of the notebook shows them to him."""
    salts = (salt_in(cell.source) for cell in master.cells.values() if cell.cell_type == "code")
    seed = personal.seed(next((salt for salt in salts if salt is not None), ""), student)

    @functools.cache
    def found(name: str) -> Exercise | None:
        exercise = find(name)
        return exercise.of_student(seed) if exercise is not None else None

    return found


def without_word(cells: Iterable[tuple[str, bool]], posed: Iterable[Exercise]) -> Iterator[str]:
    """What is wrong where a notebook poses personal exercises: ``cells`` are the sources of its code cells, locked or not."""
    names = [exercise.id for exercise in posed if exercise.personal]
    if names and not any(locked and salt_in(source) is not None for source, locked in cells):
        yield (
            f"{', '.join(names)}: the data are each student's own, but no locked cell says of which course the notebook is; "
            'add two lines to the setup cell: from autograder import personal, and personal.course("workbook")'
        )


def other_id(cells: Iterable[Mapping[str, Any]], posed: Iterable[Exercise], student: str) -> str | None:
    """A sentence where a submission with personal exercises draws its numbers for somebody else."""
    if not any(exercise.personal for exercise in posed):
        return None
    typed = [id for cell in cells if cell["cell_type"] == "code" for id in _typed(str(cell["source"]))]
    if not typed or typed[-1] in ("", student):
        return None
    return f"the id typed in it is {typed[-1][:80]!r}; it was judged with the numbers of {student}, in whose folder it lies"


def _typed(source: str) -> Iterator[str]:
    """Words that a cell gives to the variable ``student``, in order."""
    try:
        body = ast.parse(source).body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return
    for node in body:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Constant(value=str(value))) if name == VARIABLE:
                yield value.strip()
