"""What must hold before an assignment is released: a graded exercise cell is exactly ``check(name)``, at its own points.

Grading reads the call out of the instructor's copy of the cell and never runs it; a cell that says more would promise learners
something that grading does not do.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from typing import Any

from nbgrader.preprocessors import NbGraderPreprocessor

from autograder.course import Course
from autograder.errors import CourseError
from autograder.exercise import Exercise
from autograder.notebook import own
from autograder.notebook.master import checked_name

PARSING = (SyntaxError, ValueError, RecursionError, MemoryError)


class CheckExercises(NbGraderPreprocessor):  # type: ignore[misc]
    """Refuses to release a notebook whose exercise cells cannot be graded as they stand."""

    def preprocess(self, nb: Any, resources: Any) -> tuple[Any, Any]:
        """The notebook as it came, or a CourseError that names every cell to mend."""
        course = Course(self.parent.parent.coursedir.root, config=self.config)
        if wrong := list(faults(nb.cells, course.exercise)):
            raise CourseError("; ".join(wrong))
        return nb, resources


class WriteCourse(NbGraderPreprocessor):  # type: ignore[misc]
    """Writes the public word of the course where a notebook says of which course it is."""

    def preprocess(self, nb: Any, resources: Any) -> tuple[Any, Any]:
        """The notebook with the word in ``personal.course("...")``."""
        written = [cell for cell in nb.cells if cell.cell_type == "code" and own.salt_in(cell.source) is not None]
        if written:
            salt = Course(self.parent.parent.coursedir.root, config=self.config).salt()
            for cell in written:
                cell.source = own.with_salt(cell.source, salt)
        return nb, resources


def faults(cells: list[Any], find: Callable[[str], Exercise | None]) -> Iterator[str]:
    """What is wrong with the graded cells of a notebook that takes ``check`` from the autograder; others are not ours."""
    if not any(cell.cell_type == "code" and _imports_check(cell.source) for cell in cells):
        return
    posed = []
    for cell in cells:
        graded = cell.metadata.get("nbgrader", {})
        if cell.cell_type != "code" or not graded.get("grade") or graded.get("solution") or not _calls_check(cell.source):
            continue
        place = f"cell {graded.get('grade_id', '?')!r}"
        name = checked_name(cell.source)
        exercise = None if name is None else find(name)
        if name is None:
            yield f"{place} must be exactly check(name) with the name of an exercise; it is {cell.source.strip()[:80]!r}"
        elif exercise is None:
            yield f"{place} checks {name!r}, but no exercise has that name"
        elif float(graded.get("points", 0)) != exercise.points:
            yield f"{place} gives {graded.get('points')} points, but the exercise {name!r} is worth {exercise.points:g}"
        posed += [exercise] if exercise is not None else []
    code = [(cell.source, _locked(cell)) for cell in cells if cell.cell_type == "code"]
    yield from own.without_word(code, posed)


def _locked(cell: Any) -> bool:
    graded = cell.metadata.get("nbgrader", {})
    return bool(graded.get("locked") or graded.get("grade")) and not graded.get("solution")


def _calls_check(source: str) -> bool:
    return any(
        isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "check" for node in _nodes(source)
    )


def _imports_check(source: str) -> bool:
    return any(
        isinstance(node, ast.ImportFrom) and node.module == "autograder" and any(alias.name == "check" for alias in node.names)
        for node in _nodes(source)
    )


def _nodes(source: str) -> Iterator[ast.AST]:
    try:
        yield from ast.walk(ast.parse(source))
    except PARSING:  # a magic, or a slip that nbgrader itself will meet
        return
