"""Right answers as learners write them: the sample class's snippets, every style that is meant to be right.

``solutions(exercise id)`` are the answers to one exercise. Two of them count as two styles only where their normal forms
differ: without names of variables, imports, comments and error messages.
"""

from __future__ import annotations

import ast
import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import files
from typing import Any

import numpy as np

from autograder.catalogue import Assignment, shipped
from autograder.demo.snippets import cells

NOT_RIGHT = {"careless", "float32", "mistakes", "nan_at_pole", "single_points"}  # right up to something, on purpose
MODULES = {"np", "numpy", "math"}


@dataclass(frozen=True)
class Solution:
    """A right answer: the cell of one exercise, and the cells that stand before it in the notebook."""

    exercise: str
    style: str
    source: str
    before: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """Such as ``cylinder-loops``."""
        return f"{self.exercise}-{self.style}"

    def function(self, source: str | None = None) -> Callable[..., Any]:
        """The function that the notebook holds after this cell; ``source``: another text in its place."""
        space: dict[str, Any] = {"np": np, "__name__": "__main__"}
        for number, cell in enumerate(self.before):
            exec(compile(cell, f"<cell {number}>", "exec"), space)
        exec(compile(self.source if source is None else source, f"<{self.exercise}>", "exec"), space)
        found: Callable[..., Any] = space[self.exercise]
        return found


def styles(assignment: Assignment) -> list[str]:
    """The names of the styles that an assignment's right answers are kept in."""
    room = files("autograder.demo").joinpath("styles", assignment.slug)
    if not room.is_dir():
        return []
    return sorted(name for file in room.iterdir() if (name := file.name.removesuffix(".txt")) not in NOT_RIGHT)


@functools.cache
def solutions(exercise: str) -> tuple[Solution, ...]:
    """All right answers to an exercise, in the order of their styles."""
    assignment = next(a for a in shipped().assignments if exercise in a.exercises)
    found = []
    for style in styles(assignment):
        here = cells(assignment.slug, style)
        if exercise in here:
            names = list(here)
            before = tuple(here[name] for name in names[: names.index(exercise)])
            found.append(Solution(exercise, style, here[exercise], before))
    return tuple(found)


def distinct(exercise: str) -> dict[str, str]:
    """One style's name for each normal form among the answers to an exercise."""
    return {normal_form(solution.source): solution.style for solution in reversed(solutions(exercise))}


def normal_form(source: str) -> str:
    """The syntax tree without what does not change the way of thinking: names, imports, docstrings, error messages."""
    tree = _Normal().visit(ast.parse(source))
    return ast.dump(tree)


class _Normal(ast.NodeTransformer):
    def __init__(self) -> None:
        self.names: dict[str, str] = {}

    def _renamed(self, name: str) -> str:
        if name in MODULES or name in vars(math) or name in __builtins__:  # type: ignore[operator]
            return name
        return self.names.setdefault(name, f"v{len(self.names)}")

    def visit_Name(self, node: ast.Name) -> ast.AST:
        return ast.Name(self._renamed(node.id), node.ctx)

    def visit_arg(self, node: ast.arg) -> ast.AST:
        return ast.arg(self._renamed(node.arg))

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        if isinstance(node.value, ast.Name) and node.value.id in MODULES:
            return ast.Name(node.attr, node.ctx)  # math.cos, np.cos and cos are one way of thinking
        return self.generic_visit(node)

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.AST:
        node.name = self._renamed(node.name)
        if ast.get_docstring(node) is not None:
            node.body = node.body[1:] or [ast.Pass()]
        return self.generic_visit(node)

    def visit_Raise(self, node: ast.Raise) -> ast.AST:
        return ast.Raise()

    def visit_Import(self, node: ast.Import) -> None:
        return None

    def visit_ImportFrom(self, node: ast.ImportFrom) -> None:
        return None


TRAITS = ("loop", "recursion", "comprehension", "whole arrays", "matrix", "complex", "scipy")


def traits(source: str) -> set[str]:
    """Which tools an answer uses, read off its syntax tree."""
    tree = ast.parse(source)
    nodes = list(ast.walk(tree))
    calls = {_called(node) for node in nodes if isinstance(node, ast.Call)}
    found = set()
    if any(isinstance(node, ast.For | ast.While) for node in nodes):
        found.add("loop")
    for function in (node for node in nodes if isinstance(node, ast.FunctionDef)):
        if any(_called(node) == function.name for node in ast.walk(function) if isinstance(node, ast.Call)):
            found.add("recursion")
    if any(isinstance(node, ast.ListComp | ast.GeneratorExp) for node in nodes):
        found.add("comprehension")
    if calls & {"stack", "broadcast_arrays", "einsum", "concatenate", "moveaxis", "outer", "where", "cross"}:
        found.add("whole arrays")
    if any(isinstance(node, ast.MatMult) for node in nodes) or calls & {"dot", "matmul", "solve", "inv", "kron", "svd", "det"}:
        found.add("matrix")
    if any(isinstance(node, ast.Constant) and isinstance(node.value, complex) for node in nodes) or "complex" in calls:
        found.add("complex")
    if any(isinstance(node, ast.ImportFrom) and (node.module or "").startswith("scipy") for node in nodes):
        found.add("scipy")
    return found


def _called(node: ast.Call) -> str:
    return node.func.id if isinstance(node.func, ast.Name) else node.func.attr if isinstance(node.func, ast.Attribute) else ""
