"""The house has one direction: this test reads every import and fails on one that points back."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]

# Each room with the rooms it may import, nearest first. A room may always import itself and what its own rooms may import.
LIBRARY = {
    "errors": (),
    "frozen": ("errors",),
    "checks": ("errors",),
    "transform": ("checks", "frozen"),
    "knots": ("checks", "frozen"),
    "quadrature": ("checks",),
    "basis": ("knots",),
    "differential": ("basis", "transform"),
    "curves": ("basis", "transform", "differential", "quadrature"),
    "quadric": ("basis", "transform"),
    "surfaces": ("curves", "differential", "quadric"),
    "solids": ("surfaces",),
    "conversion": ("solids",),
    "inspection": ("solids",),
    "export": ("conversion", "inspection"),
    "plot": ("checks",),
}
AUTOGRADER = {
    "errors": (),
    "curvedata": (),
    "returned": ("curvedata",),
    "result": ("errors",),
    "personal": (),
    "exercise": ("result", "curvedata", "personal"),
    "messages": ("exercise",),
    "translation": ("messages",),
    "comparison": ("messages", "returned"),
    "diagnosis": ("comparison",),
    "judge": ("diagnosis",),
    "uses": (),
    "whole": (),
    "catalogue": ("exercise",),
    "sandbox": ("result", "returned"),
    "doctor": ("sandbox",),
    "card": ("judge",),
    "checking": ("card", "catalogue", "uses"),
    "gradebook": ("notebook",),
    "settings": ("errors",),
    "course": ("gradebook", "settings"),
    "notebook": ("judge", "sandbox", "card", "catalogue", "uses"),
    "feedback": ("course", "whole"),
    "bridge": ("feedback",),
    "site": ("feedback",),
    "fleet": ("bridge",),
    "authoring": ("course",),
    "demo": ("catalogue", "notebook"),
    "report": ("fleet",),
    "collect": ("fleet",),
    "integrity": ("report",),
    "cli": ("integrity", "site", "collect", "report", "doctor", "demo", "authoring", "checking"),
    "__main__": ("cli",),
}
# Which rooms of the library the autograder's rooms may see: cards draw; everything else judges callables and arrays.
DRAWS = {"card", "checking", "feedback", "bridge", "site"}


def allowed(rooms: dict[str, tuple[str, ...]], room: str) -> set[str]:
    """All rooms that may be imported from a room: the listed ones and, through them, theirs."""
    seen: set[str] = set()
    todo = [room]
    while todo:
        here = todo.pop()
        if here not in seen:
            seen.add(here)
            todo += rooms[here]
    return seen


def imports(path: Path, package: str) -> list[tuple[int, str]]:
    """Absolute dotted names a file imports, with the line; names taken from a package count as its modules."""
    found = []
    for node in ast.walk(ast.parse(path.read_text("utf-8"), str(path))):
        if isinstance(node, ast.Import):
            found += [(node.lineno, alias.name) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                parents = package.split(".")[: len(package.split(".")) - node.level + 1]
                base = ".".join([*parents, *([base] if base else [])])
            found += [(node.lineno, f"{base}.{alias.name}") for alias in node.names]
    return found


def files(folder: Path, name: str) -> list[tuple[Path, str, str]]:
    """Every Python file of a package with its room (first part below the package) and its dotted package."""
    result = []
    for path in sorted(folder.rglob("*.py")):
        place = path.relative_to(folder)
        if {"guest", "shipped", "styles"} & set(place.parts):
            continue  # not modules of this package: what a learner's process sees, what the wheel carries, cohort snippets
        room = place.parts[0].removesuffix(".py")
        package = ".".join([name, *place.parts[:-1]])
        result.append((path, room, package))
    return result


def wrong_arrows(folder: Path, name: str, rooms: dict[str, tuple[str, ...]]) -> list[str]:
    wrong = []
    for path, room, package in files(folder, name):
        if room == "__init__":
            continue
        for line, target in imports(path, package):
            parts = target.split(".")
            place = f"{path.relative_to(ROOT)}:{line}"
            if parts[0] == name and len(parts) > 1:
                if room not in rooms:
                    wrong.append(f"{place} is in a room that the house does not have: {room}")
                elif parts[1] in rooms and parts[1] not in allowed(rooms, room):
                    wrong.append(f"{place} imports {target}: {room} must not know {parts[1]}")
            elif name == "directrix" and parts[0] in ("autograder", "nbgrader", "IPython", "jupyterlab", "nbformat"):
                wrong.append(f"{place} imports {target}: the library knows nothing of notebooks or grading")
            elif (
                name == "autograder" and parts[0] == "directrix" and not (room in DRAWS and target.startswith("directrix.plot"))
            ):
                wrong.append(f"{place} imports {target}: only {', '.join(sorted(DRAWS))} draw, and nothing else knows surfaces")
            elif name == "autograder" and parts[0] == "assignments":
                wrong.append(f"{place} imports {target}: only the catalogue loads assignments, from their folder")
    return wrong


@pytest.mark.parametrize(
    ("folder", "name", "rooms"), [("lib/directrix", "directrix", LIBRARY), ("autograder", "autograder", AUTOGRADER)]
)
def test_no_import_points_back(folder, name, rooms):
    """Every import of the package goes the way of its arrows."""
    assert wrong_arrows(ROOT / folder, name, rooms) == []


@pytest.mark.parametrize(("name", "rooms"), [("directrix", LIBRARY), ("autograder", AUTOGRADER)])
def test_every_file_has_a_room(name, rooms):
    """A new file is put into the house on purpose, by a row above."""
    folder = ROOT / ("lib/directrix" if name == "directrix" else "autograder")
    strangers = {room for _, room, _ in files(folder, name)} - set(rooms) - {"__init__", "__main__"}
    assert strangers == set()


def test_assignments_import_only_the_library_and_the_exercise():
    """An assignment's exercises know the library, `autograder.exercise`, numpy and scipy, and nothing that grades them.

    Where they are a package, its files know each other.
    """
    wrong = []
    for path in sorted((ROOT / "assignments").rglob("*.py")):
        if path.name == "notebook.py":
            continue
        for line, target in imports(path, "assignments"):
            top, module = (*target.split("."), "")[:2]
            if path.parent.name == "exercises" and top == "assignments" and (path.parent / f"{module}.py").is_file():
                continue
            if top in ("autograder", "assignments", "course", "tests") and not target.startswith("autograder.exercise."):
                wrong.append(f"{path.relative_to(ROOT)}:{line} imports {target}")
    assert wrong == []


def test_pure_rooms_touch_no_file_process_or_clock():
    """The judge is a function of its arguments: its rooms import nothing that could make it otherwise."""
    impure = {"os", "io", "pathlib", "subprocess", "time", "datetime", "random", "socket", "threading", "tempfile", "secrets"}
    wrong = []
    for path, room, package in files(ROOT / "autograder", "autograder"):
        if room in ("result", "exercise", "messages", "comparison", "diagnosis", "judge", "curvedata"):
            wrong += [f"{path.name}:{line} imports {t}" for line, t in imports(path, package) if t.split(".")[0] in impure]
    assert wrong == []


def test_an_arrow_that_points_back_is_found(tmp_path):
    """The reader of imports sees absolute, relative and function-level imports."""
    (tmp_path / "errors.py").write_text("def f():\n    from directrix.surfaces import known\n")
    (tmp_path / "checks.py").write_text("from .plot import view\nimport directrix.errors\n")
    found = []
    for path, room, package in files(tmp_path, "directrix"):
        for _, target in imports(path, package):
            found += [(room, target)] if target.split(".")[1] not in allowed(LIBRARY, room) else []
    assert found == [("checks", "directrix.plot.view"), ("errors", "directrix.surfaces.known")]


def test_a_long_file_says_why():
    """More than 400 lines need a reason in the first docstring. The source of a notebook or chapter is as long as that is."""
    silent = []
    for folder in ("autograder", "lib", "assignments", "benchmarks", "docs", "tests"):
        for path in sorted((ROOT / folder).rglob("*.py")):
            text = path.read_text("utf-8")
            if text.count("\n") > 400 and path.name != "notebook.py":
                said = ast.get_docstring(ast.parse(text)) or ""
                silent += [] if "400 lines" in said or "a long one" in said else [str(path.relative_to(ROOT))]
    assert silent == []
