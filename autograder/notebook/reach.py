"""Which test cells reach into the process of the code that they test, otherwise than by calling it.

A test may take ``np.linalg.solve`` or the learner's own ``squares`` away, lower the recursion limit, make warnings errors or
seed the global generator, and then call the learner's function. In a process of its own it would set all that for itself alone:
the instructor's solution passes either way, and so would whoever is to be caught. Trying it out cannot tell, so the text does:
this module reads the instructor's cells, which are trusted, and errs on the side of the learner's process, where such a test
means what it says.
"""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

SETTINGS = frozenset([
    "MonkeyPatch", "builtins", "catch_warnings", "chdir", "delattr", "errstate", "filterwarnings", "getcontext", "localcontext",
    "mock", "modules", "monkeypatch", "setattr", "setcontext", "seterr", "setprofile", "setrecursionlimit", "settrace",
    "simplefilter", "tracemalloc",
])  # fmt: skip
CHANCE = frozenset(["seed", "set_state"])  # matters only where the solution draws


def reaching(tests: Mapping[str, ast.Module], others: Sequence[ast.Module], solutions: Sequence[ast.Module]) -> dict[str, str]:
    """Names of test cells that set something for the code they test, with a sentence.

    Parameters
    ----------
    tests, others, solutions : ast.Module
        The cells: test cells by name, the instructor's other cells, and those with his solution.
    """
    trees = [*tests.values(), *others, *solutions]
    imported = {alias: path for tree in trees for alias, path in _imported(tree)}
    draws = any("random" in words for tree in solutions for words in [set(_words(tree, imported))])
    wanted = SETTINGS | CHANCE if draws else SETTINGS
    helpers = {
        node.name: node
        for tree in (*tests.values(), *others)
        for node in tree.body
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef)
    }
    written = {name for tree in solutions for name in _written(tree)}
    found = {}
    for name, tree in tests.items():
        for node in _with_helpers(tree, helpers):
            what = next((word for word in _words(node, imported) if word in wanted), None)
            what = what or _patched(node, imported) or _deleted(node, written)
            if what is not None:
                found[name] = f"it uses {what}, which would not reach the code it tests"
                break
    return found


def _with_helpers(tree: ast.AST, helpers: Mapping[str, ast.AST]) -> Iterator[ast.AST]:
    """The cell and the definitions of the instructor's that it uses, directly or through others."""
    seen: set[str] = set()
    todo = [tree]
    while todo:
        node = todo.pop()
        yield node
        names = {part.id for part in ast.walk(node) if isinstance(part, ast.Name)} & helpers.keys() - seen
        seen |= names
        todo += [helpers[name] for name in sorted(names)]


def _words(tree: ast.AST, imported: Mapping[str, str]) -> Iterator[str]:
    """Attributes that are looked up, and what the names stand for: the parts of an imported path, a builtin."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute):
            yield node.attr
        elif isinstance(node, ast.Name):
            yield from imported.get(node.id, node.id if node.id in ("setattr", "delattr", "monkeypatch") else "").split(".")


def _patched(tree: ast.AST, imported: Mapping[str, str]) -> str | None:
    """``np.linalg.solve`` where it is assigned to or deleted."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and not isinstance(node.ctx, ast.Load):
            root: ast.expr = node
            while isinstance(root, ast.Attribute):
                root = root.value
            if isinstance(root, ast.Name) and root.id in imported:
                return f"{ast.unparse(node)} of its own"
    return None


def _written(tree: ast.Module) -> Iterator[str]:
    """The functions and classes of a solution."""
    yield from (node.name for node in tree.body if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef))


def _deleted(tree: ast.AST, written: Collection[str]) -> str | None:
    """``del squares`` where the learner wrote it: to see whether another function needs it."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Del) and node.id in written:
            return f"del {node.id}"
    return None


def _imported(tree: ast.AST) -> Iterator[tuple[str, str]]:
    nodes: Iterable[ast.AST] = ast.walk(tree)
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from ((alias.asname or alias.name.partition(".")[0], alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield from ((alias.asname or alias.name, f"{node.module or ''}.{alias.name}") for alias in node.names)
