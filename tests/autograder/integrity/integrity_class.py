"""Classes in memory for the tests of the similarity report: the sample class, and copies of one student's work."""

import ast
import functools
import re

import nbformat

from autograder import demo
from autograder.catalogue import shipped
from autograder.integrity import Class, Part
from autograder.integrity.work import BEGINNING

# Written by one student alone; functions, helpers and the order of many statements are her own.
ORIGINAL = {
    "cylinder": '''
def cylinder(u, w, r, h):
    """A tube around z."""
    turns = 360 * np.asarray(u)
    levels = np.asarray(w) * h
    east = r * np.cos(np.deg2rad(turns))
    north = r * np.sin(np.deg2rad(turns))
    shape = np.broadcast(east, levels).shape
    out = np.empty((*shape, 3))
    out[..., 2] = levels  # upwards
    out[..., 0] = east
    out[..., 1] = north
    return out
''',
    "frustum": """
def girth(low, high, where):
    return (1 - where) * low + where * high

def frustum(u, w, r1, r2, h):
    wide = girth(r1, r2, np.asarray(w))
    tube = cylinder(u, w, 1.0, h)
    tube[..., 0] *= wide
    tube[..., 1] *= wide
    return tube
""",
    "torus": """
def torus(u, w, R, r):
    tube_angle = 2 * np.pi * np.asarray(u)
    ring_angle = 2 * np.pi * np.asarray(w)
    away = R + r * np.cos(tube_angle)
    rise = r * np.sin(tube_angle)
    parts = [away * np.cos(ring_angle), away * np.sin(ring_angle), rise + 0 * ring_angle]
    return np.moveaxis(np.array(np.broadcast_arrays(*parts)), 0, -1)
""",
    "torus_class": """
def torus_class(R, r):
    kinds = {-1: "spindle", 0: "horn", 1: "ring"}
    if min(R, r) < 0 or not r:
        raise ValueError(f"no torus has the radii {R} and {r}")
    return "sphere" if not R else kinds[int(np.sign(R - r))]
""",
}


def parts(sources, extra=()):
    """Task cells by exercise; extra cells stand where their exercise's cell stands, after it."""
    cells = []
    for exercise, source in sources.items():
        cells.append((exercise, source.strip()))
        cells += [(exercise, more) for name, more in extra if name == exercise]
    return [Part("known-forms", exercise, number, source) for number, (exercise, source) in enumerate(cells, 1)]


@functools.cache
def sample(name):
    """The shipped sample class of an assignment as it would be read: task cells and added cells."""
    assignment = shipped().assignment(name)
    nb = nbformat.v4.new_notebook()
    nb.cells.append(nbformat.v4.new_code_cell("import numpy as np\nimport math"))
    for exercise in assignment.exercises:
        for id, source in ((exercise, ""), (f"check_{exercise}", f"check({exercise})")):
            nb.cells.append(nbformat.v4.new_code_cell(source, metadata={"nbgrader": {"grade_id": id, "solution": not source}}))
    made = {}
    for member in demo.cohort(name):
        if member.expected is None:
            continue
        found, exercise = [], BEGINNING
        for number, cell in enumerate(member.notebook(nb).cells, 1):
            id = cell.metadata.get("nbgrader", {}).get("grade_id", "")
            exercise = id if id in assignment.exercises else exercise
            if number > 1 and not id.startswith("check_"):
                found.append(Part(assignment.slug, exercise, number, cell.source))
        made[member.student_id] = found
    return made


def classroom(**students):
    """The sample class of A1 and these students."""
    return Class(parts={**sample("A1"), **students}, given=["import numpy as np\nimport math"])


class _Renamed(ast.NodeTransformer):
    """Every name that the source binds gets another one; functions of exercises keep theirs."""

    def __init__(self, tree):
        bound = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
        bound |= {node.arg for node in ast.walk(tree) if isinstance(node, ast.arg)} | {"girth"}
        self.new = {name: f"my_{number}" for number, name in enumerate(sorted(bound))}

    def visit_Name(self, node):
        node.id = self.new.get(node.id, node.id)
        return node

    def visit_arg(self, node):
        node.arg = self.new.get(node.arg, node.arg)
        return node

    def visit_FunctionDef(self, node):
        node.name = self.new.get(node.name, node.name)
        return self.generic_visit(node)


def renamed(source):
    """Other names, and another layout: the tree is printed anew."""
    tree = ast.parse(source)
    return ast.unparse(_Renamed(tree).visit(tree))


SWAPPED = ["turns", "levels", "out[..., 0]", "out[..., 1]", "east", "north", "tube_angle", "ring_angle", "away", "rise"]
SWAPPED += ["tube[..., 0]", "tube[..., 1]"]


def shuffled(source):
    """Statements that do not need each other change places, two and two."""
    lines = source.strip().split("\n")
    place = {begin: i for begin in SWAPPED for i, line in enumerate(lines) if line.strip().startswith(f"{begin} ")}
    for one, other in zip(SWAPPED[::2], SWAPPED[1::2], strict=True):
        if one in place:
            lines[place[one]], lines[place[other]] = lines[place[other]], lines[place[one]]
    return "\n".join(lines)


def copies():
    """Six ways in which somebody else hands in ORIGINAL."""
    comments = {
        name: re.sub(r"\n    (?=\w)", "\n    # as in the lecture\n\n    ", re.sub(r'    """.*"""\n|  # .*', "", source))
        for name, source in ORIGINAL.items()
    }
    helper, main = ORIGINAL["frustum"].strip().split("\n\n")
    return {
        "verbatim": parts(ORIGINAL),
        "renamed": parts({name: renamed(source) for name, source in ORIGINAL.items()}),
        "reordered": parts({**dict(reversed(ORIGINAL.items())), "frustum": f"{main}\n\n{helper}"}),
        "comments": parts(comments),
        "split": parts({**ORIGINAL, "frustum": helper}, extra=[("frustum", main)]),
        "shuffled": parts({name: shuffled(source) for name, source in ORIGINAL.items()}),
    }
