"""Builds the nbgrader notebook of an assignment from its text, and the learner's version from that.

``build`` holds the text to what grading relies on: every exercise has one task cell that defines the function with the
exercise's signature and one graded cell that is exactly ``check(name)``, with the exercise's own points. The same text gives
the same bytes, always: ids of cells come from their grade ids and places.
"""

from __future__ import annotations

import ast
import copy
import difflib
import hashlib
import inspect
from pathlib import Path
from typing import Any, Literal

import nbformat

from autograder.catalogue import Assignment
from autograder.errors import CourseError
from autograder.exercise import Exercise
from autograder.notebook.chapter import build_chapter, chapters
from autograder.notebook.text import (
    BEGIN,
    CODE_STUB,
    TEXT_STUB,
    Cell,
    Notebook,
    assembled,
    new_cell,
    read,
    region,
    setup_source,
    stubbed,
)

Role = Literal["solution", "check", "written", "locked", "setup"]
ROLES: tuple[Role, ...] = ("solution", "check", "written", "locked", "setup")
OPTIONS = {*ROLES, "points", "fold"}
SCHEMA_VERSION = 3

__all__ = ["build", "build_chapter", "chapters", "dumps", "release", "setup_source", "write"]


def build(assignment: Assignment, *, solutions: bool = True) -> Notebook:
    """The nbgrader *source* notebook of an assignment.

    Parameters
    ----------
    assignment : Assignment
        Whose ``notebook.py`` is read and whose exercises it must pose.
    solutions : bool
        False leaves a stub between the solution markers, which is all that an installed wheel has.

    Raises
    ------
    CourseError
        Beginning with file and line, where the text breaks one of the rules of the module.
    """
    cells = read(assignment.source)
    _check_exercises(cells, assignment)
    seen: dict[str, Cell] = {}
    return assembled([_built(cell, number, assignment, seen, solutions=solutions) for number, cell in enumerate(cells, 1)])


def write(assignment: Assignment, folder: Path | str, *, solutions: bool = True) -> Path:
    """Write ``<slug>.ipynb`` into a folder, usually ``COURSE/source/A1``, and return its path."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{assignment.slug}.ipynb"
    path.write_text(dumps(build(assignment, solutions=solutions)), "utf-8")
    return path


def dumps(nb: Notebook) -> str:
    """The notebook as a file's text: sorted keys and one line end, so that the same notebook is the same bytes."""
    return str(nbformat.writes(nb, version=nbformat.NO_CONVERT)) + "\n"  # type: ignore[no-untyped-call]


def release(nb: Notebook) -> Notebook:
    """The learner's version of a source notebook: stubs for solutions, locked cells, checksums, no outputs.

    The same as ``nbgrader generate_assignment`` makes with its stock settings (a test compares the two), without starting it.
    """
    nb = copy.deepcopy(nb)
    for cell in nb.cells:
        meta = cell.metadata.get("nbgrader", {})
        if cell.cell_type == "code":
            cell.outputs, cell.execution_count = [], None
        if not meta:
            continue
        if meta["solution"]:
            as_read = Cell(cell.cell_type, cell.source, Path(meta["grade_id"]), 0)
            whole = TEXT_STUB if cell.cell_type == "markdown" else CODE_STUB
            cell.source = whole if region(as_read) is None else stubbed(as_read, keep_markers=False)
        if meta["grade"] or meta["solution"] or meta["locked"]:
            cell.metadata["deletable"] = False
        if not meta["solution"] and (meta["grade"] or meta["locked"]):
            cell.metadata["editable"] = False
        meta["checksum"] = _checksum(cell)
        meta["cell_type"] = cell.cell_type
    return nb


def _checksum(cell: Any) -> str:
    # nbgrader.utils.compute_checksum; importing nbgrader for it would take seconds.
    meta = cell.metadata.nbgrader
    parts = [cell.source, cell.cell_type, str(meta["grade"]), str(meta["solution"]), str(meta["locked"]), meta["grade_id"]]
    if meta["grade"]:
        parts.append(str(float(meta["points"])))
    return hashlib.md5("".join(parts).encode()).hexdigest()


def _built(cell: Cell, number: int, assignment: Assignment, seen: dict[str, Cell], *, solutions: bool) -> dict[str, Any]:
    role = _role(cell)
    source = cell.source if solutions else stubbed(cell)
    metadata: dict[str, Any] = {}
    if role is not None:
        nbgrader = _nbgrader(cell, role, assignment)
        grade_id = nbgrader["grade_id"]
        if grade_id in seen:
            raise cell.error(f"grade id {grade_id!r} is taken by the cell in line {seen[grade_id].line}; choose another")
        seen[grade_id] = cell
        metadata["nbgrader"] = nbgrader
    elif region(cell) is not None:
        raise cell.error(f'\'{BEGIN}\' stands in a cell that is no task; mark the cell with solution="..." or written="..."')
    if role == "setup" or cell.options.get("fold"):
        metadata["jupyter"] = {"source_hidden": True}
    name = metadata["nbgrader"]["grade_id"] if role is not None else f"cell-{number:02d}"
    return new_cell(cell.kind, source, name, metadata)


def _role(cell: Cell) -> Role | None:
    unknown = [key for key in cell.options if key not in OPTIONS]
    if unknown:
        raise cell.error(f"unknown option {unknown[0]!r} after '# %%'; there are {', '.join(sorted(OPTIONS))}")
    roles = [role for role in ROLES if role in cell.options]
    if len(roles) > 1:
        raise cell.error(f"a cell has one of the options {', '.join(ROLES)}; this one has {' and '.join(roles)}")
    role = roles[0] if roles else None
    if role is None and "points" in cell.options:
        raise cell.error('points belong to a graded cell; write check="..." or written="..." beside them')
    if cell.options.get("fold") and (cell.kind != "code" or role in ("solution", "check")):
        raise cell.error("fold=true hides code that need not be read; a task, a check and prose are to be seen")
    if role in ("solution", "check") and cell.kind != "code":
        raise cell.error(f"a {role} cell holds code; take [markdown] away")
    if role == "written" and cell.kind != "markdown":
        raise cell.error("a written answer is a [markdown] cell")
    return role


def _nbgrader(cell: Cell, role: Role, assignment: Assignment) -> dict[str, Any]:
    name = "setup" if role == "setup" else cell.options[role]
    if not isinstance(name, str) or not name.isidentifier():
        raise cell.error(f"{role}= wants a name in quotes, letters, digits and underscores; got {name!r}")
    meta: dict[str, Any] = {
        "grade": role in ("check", "written"),
        "grade_id": f"check_{name}" if role == "check" else name,
        "locked": role in ("check", "locked", "setup"),
        "schema_version": SCHEMA_VERSION,
        "solution": role in ("solution", "written"),
        "task": False,
    }
    if role == "check":
        meta["points"] = _number(_points_of(cell, _exercise(cell, name, assignment)))
    elif role == "written":
        points = cell.options.get("points")
        if isinstance(points, bool) or not isinstance(points, int | float) or not points > 0:
            raise cell.error(f"a written answer says what it is worth, as in points=3; got points={points!r}")
        if region(cell) is None:
            raise cell.error(f"a written answer holds a model answer between '{BEGIN}' and '### END SOLUTION'")
        meta["points"] = _number(points)
    return meta


def _points_of(cell: Cell, exercise: Exercise) -> float:
    stated = cell.options.get("points", exercise.points)
    if stated != exercise.points:
        raise cell.error(
            f"points={stated!r}, but the exercise {exercise.id} is worth {exercise.points:g}; "
            "leave points out here, they are taken from the exercise"
        )
    return exercise.points


def _number(points: float) -> int | float:
    return int(points) if float(points).is_integer() else float(points)


def _exercise(cell: Cell, id: str, assignment: Assignment) -> Exercise:
    if id in assignment.exercises:
        return assignment.exercises[id]
    near = difflib.get_close_matches(id, assignment.exercises, n=1)
    guess = f"; did you mean {near[0]!r}?" if near else f"; there are: {', '.join(assignment.exercises)}"
    raise cell.error(f"no exercise of {assignment.folder.name} is called {id!r}{guess}")


def _check_exercises(cells: list[Cell], assignment: Assignment) -> None:
    tasks: dict[str, Cell] = {}
    checks: dict[str, Cell] = {}
    for cell in cells:
        _role(cell)
        for role, found in (("solution", tasks), ("check", checks)):
            if isinstance(id := cell.options.get(role), str):
                exercise = _exercise(cell, id, assignment)
                if id in found:
                    raise cell.error(f"the exercise {id} has a {role} cell already, in line {found[id].line}")
                found[id] = cell
                if role == "solution":
                    _check_task(cell, exercise)
                elif cell.source != f"check({id})":
                    raise cell.error(f"the graded cell of {id} must be exactly 'check({id})'; got {_first(cell.source)!r}")
                elif id not in tasks:
                    raise cell.error(f"check({id}) comes before the cell that defines {id}; put solution={id!r} above it")
    for id in assignment.exercises:
        if id not in tasks or id not in checks:
            role = "solution" if id not in tasks else "check"
            raise CourseError(f'{assignment.source}: the exercise {id} has no {role} cell; add one marked {role}="{id}"')


def _check_task(cell: Cell, exercise: Exercise) -> None:
    if region(cell) is None:
        raise cell.error(f"the task cell of {exercise.id} needs a solution between '{BEGIN}' and '### END SOLUTION'")
    for source in (cell.source, stubbed(cell)):
        try:
            tree = ast.parse(source)
        except SyntaxError as error:
            raise cell.error(f"not Python: {error.msg}", row=error.lineno or 0) from None
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
    if [node.name for node in functions] != [exercise.id]:
        raise cell.error(f"the task cell of {exercise.id} defines that one function, outside the solution; {_names(functions)}")
    arguments = functions[0].args
    written = [argument.arg for argument in (*arguments.posonlyargs, *arguments.args)]
    if tuple(written) != exercise.arguments or len(arguments.defaults) != len(exercise.defaults):
        raise cell.error(
            f"the stub must be 'def {exercise.signature}'; got 'def {exercise.id}({ast.unparse(arguments)})'",
            row=functions[0].lineno,
        )
    if not inspect.cleandoc(ast.get_docstring(functions[0]) or ""):
        raise cell.error(f"the stub of {exercise.id} needs a docstring that says what to return", row=functions[0].lineno)


def _names(functions: list[ast.FunctionDef]) -> str:
    return f"it defines {', '.join(node.name for node in functions)}" if functions else "it defines none"


def _first(source: str) -> str:
    return source if len(source) <= 60 else source[:57] + "..."
