"""No false pass: a right solution with one small change passes only where the change does not move a point.

Each mutant changes one operator, number, name or function of a solution. Whether it is another surface is found out without
the judge, on samples of the test's own.
"""

import ast
import copy

import numpy as np
import pytest

from autograder.catalogue import shipped
from autograder.judge import judge

SOLUTIONS = {
    "cylinder": """
def cylinder(u, w, r, h):
    u, w = np.broadcast_arrays(u, w)
    return np.stack([r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), h * w], axis=-1)
""",
    "frustum": """
def frustum(u, w, r1, r2, h):
    u, w = np.broadcast_arrays(u, w)
    rho = r1 + (r2 - r1) * w
    return np.stack([rho * np.cos(2 * np.pi * u), rho * np.sin(2 * np.pi * u), h * w], axis=-1)
""",
    "sphere": """
def sphere(u, w, r):
    u, w = np.broadcast_arrays(u, w)
    phi, theta = np.pi * (u - 1 / 2), 2 * np.pi * w
    return np.stack([r * np.cos(phi) * np.cos(theta), r * np.cos(phi) * np.sin(theta), r * np.sin(phi)], axis=-1)
""",
    "torus": """
def torus(u, w, R, r):
    u, w = np.broadcast_arrays(u, w)
    phi, theta = 2 * np.pi * u, 2 * np.pi * w
    rho = R + r * np.cos(phi)
    return np.stack([rho * np.cos(theta), rho * np.sin(theta), r * np.sin(phi)], axis=-1)
""",
    "linear_sweep": """
def linear_sweep(u, w, curve, direction, d):
    u, w = np.broadcast_arrays(u, w)
    length = np.linalg.norm(direction)
    if length == 0:
        raise ValueError("no direction")
    return curve(u) + d * w[..., None] * direction / length
""",
    "plane3": """
def plane3(u, w, p1, p2, p3):
    u, w = np.broadcast_arrays(u, w)
    u, w = u[..., None], w[..., None]
    return p1 + u * (p2 - p1) + w * (p3 - p1)
""",
    "triangle_patch": """
def triangle_patch(u, w, p1, p2, p3):
    u, w = np.broadcast_arrays(u, w)
    u, w = u[..., None], w[..., None]
    return (1 - u) * (1 - w) * p1 + u * (1 - w) * p2 + w * p3
""",
    "revolve_y": """
def revolve_y(u, w, curve, angle=2 * np.pi):
    u, w = np.broadcast_arrays(u, w)
    x, y, z = np.moveaxis(curve(u), -1, 0)
    t = angle * w
    return np.stack([x * np.cos(t) + z * np.sin(t), y, -x * np.sin(t) + z * np.cos(t)], axis=-1)
""",
    "revolve_axis": """
def revolve_axis(u, w, curve, point, axis, angle=2 * np.pi):
    u, w = np.broadcast_arrays(u, w)
    length = np.sqrt(axis @ axis)
    if length == 0:
        raise ValueError("no axis")
    k = axis / length
    v = curve(u) - point
    t = (angle * w)[..., None]
    along = (v @ k)[..., None] * k
    return point + v * np.cos(t) + np.cross(k, v) * np.sin(t) + along * (1 - np.cos(t))
""",
}
OTHER = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult}
FUNCTIONS = {"cos": "sin", "sin": "cos"}


def changes(node, names):
    """Every small change of one node, as functions that apply it to a copy."""
    if isinstance(node, ast.BinOp) and type(node.op) in OTHER:
        yield lambda n: setattr(n, "op", OTHER[type(n.op)]())
    if isinstance(node, ast.Constant) and type(node.value) is int and node.value > 0:
        yield lambda n: setattr(n, "value", n.value + 1)
        yield lambda n: setattr(n, "value", n.value * 1.01)
    if isinstance(node, ast.Attribute) and node.attr in FUNCTIONS:
        yield lambda n: setattr(n, "attr", FUNCTIONS[n.attr])
    if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load) and node.id in names:
        for other in names:
            if other != node.id:
                yield lambda n, other=other: setattr(n, "id", other)


def mutants(name):
    """Functions made from the solution by one change each."""
    tree = ast.parse(SOLUTIONS[name])
    body = tree.body[0]
    names = [argument.arg for argument in body.args.args if argument.arg != "curve"]
    nodes = [n for statement in body.body for n in ast.walk(statement)]
    for i, node in enumerate(nodes):
        for change in changes(node, names):
            twin = copy.deepcopy(tree)
            change([n for statement in twin.body[0].body for n in ast.walk(statement)][i])
            namespace = {"np": np}
            exec(compile(ast.fix_missing_locations(twin), f"<{name}>", "exec"), namespace)
            yield ast.unparse(twin), namespace[name]


def moves_a_point(exercise, mutant, seed):
    """Whether the mutant differs from the reference on scattered samples of some data set, by more than the tolerance."""
    u, w = np.random.default_rng(99).uniform(size=(2, 200))
    for drawn in exercise.draw(seed):
        arguments = list(drawn.arguments.values())
        try:
            right = exercise.reference(u, w, *arguments)
        except ValueError:
            continue
        try:
            with np.errstate(all="ignore"):
                answer = np.asarray(mutant(u, w, *arguments), dtype=float)
        except Exception:
            return True
        if answer.shape != right.shape:
            return True
        size = np.linalg.norm(np.ptp(right, axis=0))
        if not np.linalg.norm(answer - right, axis=-1).max() <= 10 * exercise.tolerance * size:
            return True
    return False


@pytest.mark.parametrize("name", list(SOLUTIONS))
def test_a_change_that_moves_a_point_does_not_pass(name):
    exercise = shipped().find(name)
    seed = b"mutants"
    untouched: dict = {"np": np}
    exec(SOLUTIONS[name], untouched)
    assert judge(exercise, untouched[name], seed=seed).fraction == 1.0
    seen = 0
    for source, mutant in mutants(name):
        verdict = judge(exercise, mutant, seed=seed, figure=False, search=False)
        assert verdict.outcome != "could not judge", source
        if moves_a_point(exercise, mutant, seed):
            seen += 1
            assert verdict.fraction < 1.0, source
            assert verdict.part("wrong"), source
    assert seen >= 15
