"""Small random changes to a right answer: one node of its syntax tree, as a slip of the hand or of the mind would change it.

``mutations(source, count, rng)`` draws changes; each is a kind, a line and a new source. The kinds are those of a learner who
types formulas: signs, operators, indices, constants, exchanged arguments, cos for sin, a term left out, u for w, another axis,
< for <=, a range off by one, a length not divided by, degrees.
"""

from __future__ import annotations

import ast
import copy
import itertools
import random
import re
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

OPERATORS: dict[type, type] = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.FloorDiv: ast.Mult}
COMPARISONS: dict[type, tuple[type, ...]] = {
    ast.Lt: (ast.LtE, ast.Gt), ast.LtE: (ast.Lt, ast.Gt), ast.Gt: (ast.GtE, ast.Lt), ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,), ast.NotEq: (ast.Eq,),
}  # fmt: skip
ANGLES = {"cos": "sin", "sin": "cos", "cosh": "sinh", "real": "imag", "imag": "real"}
FUNCTIONS = {
    "min": "max", "max": "min", "minimum": "maximum", "maximum": "minimum", "zeros": "ones", "ones": "zeros",
    "sum": "prod", "prod": "sum", "cumsum": "cumprod", "floor": "ceil", "mean": "sum", "any": "all", "all": "any",
    "radians": "degrees", "vstack": "hstack", "hstack": "vstack", "subtract": "add", "add": "subtract",
}  # fmt: skip
LENGTH = re.compile(r"\b(norm|length|n|d|size|denominator|scale|gap|total|sum|s)\b|norm\(|sqrt\(|\.sum\(")


@dataclass(frozen=True)
class Mutation:
    """One change: its kind, the line it is on, what stood there and what stands there now, and the whole new source."""

    kind: str
    line: int
    was: str
    now: str
    source: str


Change = tuple[str, Callable[[ast.AST], "ast.AST | None"]]


def mutations(source: str, count: int, rng: random.Random, parameters: Sequence[str] = ("u", "w")) -> list[Mutation]:
    """So many single changes of a source, each of another syntax tree.

    Each kind has its turn, so that the many names that could be exchanged do not drown the rest.
    """
    tree = ast.parse(source)
    piles: dict[str, list[tuple[int, Callable[[ast.AST], ast.AST | None]]]] = {}
    for index, node in enumerate(ast.walk(tree)):
        for kind, make in _changes(node, tree, parameters):
            piles.setdefault(kind, []).append((index, make))
    order = sorted(piles)
    rng.shuffle(order)
    for kind in order:
        rng.shuffle(piles[kind])
    seen = {ast.dump(tree)}
    found: list[Mutation] = []
    while order and len(found) < count:
        for kind in list(order):
            made = _mutation(tree, kind, *piles[kind].pop(), seen)
            if made is not None:
                found.append(made)
            if not piles[kind]:
                order.remove(kind)
            if len(found) == count:
                break
    return found


def _mutation(
    tree: ast.AST, kind: str, index: int, make: Callable[[ast.AST], ast.AST | None], seen: set[str]
) -> Mutation | None:
    twin = copy.deepcopy(tree)
    target = next(node for i, node in enumerate(ast.walk(twin)) if i == index)
    was, line = ast.unparse(target), getattr(target, "lineno", 0)
    made = make(copy.deepcopy(target))
    changed = ast.fix_missing_locations(_Replace(target, made).visit(twin))
    dump = ast.dump(changed)
    if dump in seen:
        return None
    seen.add(dump)
    try:
        text = ast.unparse(changed)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            compile(text, "<mutation>", "exec")
    except (SyntaxError, ValueError):
        return None
    return Mutation(kind, line, was, "" if made is None else ast.unparse(made), text)


class _Replace(ast.NodeTransformer):
    def __init__(self, target: ast.AST, made: ast.AST | None) -> None:
        self.target, self.made = target, made

    def visit(self, node: ast.AST) -> ast.AST | None:
        return self.made if node is self.target else self.generic_visit(node)


def _changes(node: ast.AST, tree: ast.AST, parameters: Sequence[str]) -> Iterator[Change]:
    if isinstance(node, ast.BinOp):
        yield from _of_operation(node)
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        yield "sign", lambda n: n.operand  # type: ignore[attr-defined]
    elif isinstance(node, ast.Constant):
        yield from _of_constant(node)
    elif isinstance(node, ast.Call):
        yield from _of_call(node)
    elif isinstance(node, ast.Attribute):
        yield from _of_attribute(node)
    elif isinstance(node, ast.Name):
        yield from _of_name(node, tree, parameters)
    elif isinstance(node, ast.Compare):
        for other in COMPARISONS.get(type(node.ops[0]), ()):
            yield "comparison", lambda n, other=other: ast.Compare(n.left, [other(), *n.ops[1:]], n.comparators)
    elif isinstance(node, ast.BoolOp):
        yield "comparison", lambda n: ast.BoolOp(ast.Or() if isinstance(n.op, ast.And) else ast.And(), n.values)
    elif isinstance(node, ast.Subscript):
        yield from _of_subscript(node)
    elif isinstance(node, ast.List | ast.Tuple) and isinstance(node.ctx, ast.Load):
        for i in range(len(node.elts) - 1):
            yield "exchanged entries", lambda n, i=i: _exchanged(n, "elts", i)
        for i, entry in enumerate(node.elts):
            if not isinstance(entry, ast.Constant | ast.List | ast.Tuple | ast.Starred | ast.Slice):
                yield "sign", lambda n, i=i: _negated(n, i)
    elif isinstance(node, ast.AugAssign):
        if type(node.op) in OPERATORS:
            yield "operator", lambda n: ast.AugAssign(n.target, OPERATORS[type(n.op)](), n.value)
        kind = "normalisation" if isinstance(node.op, ast.Div) else "dropped term"
        yield kind, lambda n: ast.Pass()
    elif isinstance(node, ast.If | ast.Raise):
        yield "dropped case", lambda n: ast.Pass()
    elif isinstance(node, ast.While):
        yield "loop", lambda n: ast.If(n.test, n.body, [])


def _of_operation(node: ast.BinOp) -> Iterator[Change]:
    op = type(node.op)
    if op in OPERATORS:
        yield "operator", lambda n: ast.BinOp(n.left, OPERATORS[type(n.op)](), n.right)
    if op in (ast.Sub, ast.Div, ast.MatMult, ast.Pow):
        yield "exchanged operands", lambda n: ast.BinOp(n.right, n.op, n.left)
    if op in (ast.Add, ast.Sub):
        yield "dropped term", lambda n: n.left
        yield "dropped term", lambda n: n.right
    if op in (ast.Mult, ast.MatMult):
        yield "dropped factor", lambda n: n.left
        yield "dropped factor", lambda n: n.right
    if op is ast.Div:
        yield "normalisation" if LENGTH.search(ast.unparse(node.right)) else "dropped factor", lambda n: n.left
    if op is ast.Pow:
        yield "power", lambda n: ast.BinOp(n.left, n.op, ast.BinOp(n.right, ast.Add(), ast.Constant(1)))
        yield "power", lambda n: n.left


def _of_constant(node: ast.Constant) -> Iterator[Change]:
    value = node.value
    if isinstance(value, bool) or value is None:
        if isinstance(value, bool):
            yield "constant", lambda n: ast.Constant(not n.value)
    elif isinstance(value, int):
        yield "constant", lambda n: ast.Constant(n.value + 1)
        yield "constant", lambda n: ast.Constant(n.value - 1)
    elif isinstance(value, float | complex):
        yield "constant", lambda n: ast.Constant(n.value * 2)
        yield "constant", lambda n: ast.Constant(n.value * 1.01 + 0.01)
    elif isinstance(value, str) and "->" in value:
        letters = [i for i, c in enumerate(value) if c.isalpha()]
        for a, b in itertools.pairwise(letters):
            yield "axis", lambda n, a=a, b=b: ast.Constant(_swapped_letters(n.value, a, b))
    elif isinstance(value, str) and value.isalpha() and len(value) < 12:
        yield "word", lambda n: ast.Constant(n.value[::-1] if n.value != n.value[::-1] else n.value + "s")


def _swapped_letters(text: str, a: int, b: int) -> str:
    letters = list(text)
    letters[a], letters[b] = letters[b], letters[a]
    return "".join(letters)


def _of_call(node: ast.Call) -> Iterator[Change]:
    name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
    plain = [i for i, argument in enumerate(node.args) if not isinstance(argument, ast.Starred)]
    for i in plain[:-1]:
        yield "exchanged arguments", lambda n, i=i: _exchanged(n, "args", i)
    if name in ("cos", "sin", "exp") and node.args:
        yield "degrees", lambda n: _with_argument(n, "degrees")
        yield "degrees", lambda n: _with_argument(n, "radians")
    if name == "range" and node.args:
        yield "range", lambda n: _range(n, 0, 1)
        yield "range", lambda n: _range(n, 0, -1)
        yield "range", lambda n: _range(n, 1, 0)
    if name in ("sqrt", "abs", "asarray", "clip", "reversed") and node.args:
        yield "normalisation" if name == "sqrt" else "dropped call", lambda n: n.args[0]  # type: ignore[attr-defined]
    for i, keyword in enumerate(node.keywords):
        if keyword.arg == "axis" and isinstance(keyword.value, ast.Constant | ast.UnaryOp):
            for axis in (0, 1, -1):
                yield "axis", lambda n, i=i, axis=axis: _with_axis(n, i, axis)


def _range(node: ast.AST, low: int, high: int) -> ast.AST:
    assert isinstance(node, ast.Call)
    first = node.args[0] if len(node.args) > 1 else ast.Constant(0)
    last = node.args[1] if len(node.args) > 1 else node.args[0]
    first = ast.BinOp(first, ast.Add(), ast.Constant(low)) if low else first
    last = ast.BinOp(last, ast.Add(), ast.Constant(high)) if high else last
    return ast.Call(node.func, [first, last, *node.args[2:]], [])


def _with_argument(node: ast.AST, function: str) -> ast.AST:
    assert isinstance(node, ast.Call)
    inner = ast.Call(ast.Attribute(ast.Name("np", ast.Load()), function, ast.Load()), [node.args[0]], [])
    return ast.Call(node.func, [inner, *node.args[1:]], node.keywords)


def _with_axis(node: ast.AST, i: int, axis: int) -> ast.AST:
    assert isinstance(node, ast.Call)
    node.keywords[i] = ast.keyword("axis", ast.Constant(axis))
    return node


def _exchanged(node: ast.AST, field: str, i: int) -> ast.AST:
    entries = getattr(node, field)
    entries[i], entries[i + 1] = entries[i + 1], entries[i]
    return node


def _negated(node: ast.AST, i: int) -> ast.AST:
    assert isinstance(node, ast.List | ast.Tuple)
    node.elts[i] = ast.UnaryOp(ast.USub(), node.elts[i])
    return node


def _of_attribute(node: ast.Attribute) -> Iterator[Change]:
    if node.attr in ANGLES:
        yield "cos and sin", lambda n: ast.Attribute(n.value, ANGLES[n.attr], n.ctx)
    elif node.attr in FUNCTIONS:
        yield "function", lambda n: ast.Attribute(n.value, FUNCTIONS[n.attr], n.ctx)
    elif node.attr == "T":
        yield "transposed", lambda n: n.value  # type: ignore[attr-defined]
    elif node.attr == "pi":
        yield "degrees", lambda n: ast.Constant(180)
        yield "constant", lambda n: ast.Constant(3.14)


def _of_name(node: ast.Name, tree: ast.AST, parameters: Sequence[str]) -> Iterator[Change]:
    if not isinstance(node.ctx, ast.Load):
        return
    if node.id in ANGLES or node.id in FUNCTIONS:
        other = ANGLES.get(node.id) or FUNCTIONS[node.id]
        yield "cos and sin" if node.id in ANGLES else "function", lambda n: ast.Name(other, n.ctx)
    if node.id == "pi":
        yield "degrees", lambda n: ast.Constant(180)
    functions = [f for f in ast.walk(tree) if isinstance(f, ast.FunctionDef | ast.Lambda)]
    functions = [f for f in functions if any(inner is node for inner in ast.walk(f))]
    if not functions:
        return
    called = {n.func.id for n in ast.walk(tree) if isinstance(n, ast.Call) and isinstance(n.func, ast.Name)}
    known = [a.arg for f in functions for a in f.args.args]
    known += [n.id for f in functions for n in ast.walk(f) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)]
    if node.id not in known:
        return
    for other in dict.fromkeys(known):
        if other != node.id and (other in called) == (node.id in called):
            both = {other, node.id} <= set(parameters)
            yield "u and w" if both else "another name", lambda n, other=other: ast.Name(other, n.ctx)


def _of_subscript(node: ast.Subscript) -> Iterator[Change]:
    place = node.slice
    if isinstance(place, ast.Constant) and isinstance(place.value, int):
        yield "index", lambda n: ast.Subscript(n.value, ast.Constant(n.slice.value + 1), n.ctx)
        yield "index", lambda n: ast.Subscript(n.value, ast.Constant(n.slice.value - 1), n.ctx)
    elif isinstance(place, ast.Name | ast.BinOp) and not isinstance(node.ctx, ast.Del):
        yield "index", lambda n: ast.Subscript(n.value, ast.BinOp(n.slice, ast.Add(), ast.Constant(1)), n.ctx)
        yield "index", lambda n: ast.Subscript(n.value, ast.BinOp(n.slice, ast.Sub(), ast.Constant(1)), n.ctx)
    elif isinstance(place, ast.Tuple):
        for i in range(len(place.elts) - 1):
            yield "index", lambda n, i=i: ast.Subscript(n.value, _exchanged(n.slice, "elts", i), n.ctx)
    elif isinstance(place, ast.Slice):
        yield "slice", lambda n: ast.Subscript(n.value, ast.Slice(n.slice.upper, n.slice.lower, n.slice.step), n.ctx)
        if place.step is not None:
            yield "slice", lambda n: ast.Subscript(n.value, ast.Slice(n.slice.lower, n.slice.upper), n.ctx)
        elif place.lower is not None or place.upper is not None:
            yield "slice", lambda n: n.value if isinstance(n.ctx, ast.Load) else n
