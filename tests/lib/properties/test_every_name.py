"""No public name, and no public method, is left out of the tests of bad input: what is new has no row, and fails here.

Functions and constructors have their rows in `test_junk.py` and `test_junk_freeform.py`; those of methods, pictures and files
are here. Each argument in turn is replaced by everything of the pool: an answer comes, or a GeometryError in words.
"""

import inspect
import json

import directrix as dx
import numpy as np
import pytest
from directrix import export, plot

from tests.lib.properties.test_junk import MAKERS
from tests.lib.properties.test_junk_freeform import EDGES, NET, POOL, RIGHT, SPLINE, attempted

BASES = (dx.Curve, dx.Surface)
NAMES = {name: getattr(dx, name) for name in dx.__all__}
CLASSES = {name: one for name, one in NAMES.items() if inspect.isclass(one) and not issubclass(one, dx.GeometryError)}
CALLS = {key: list(good) for key, good in MAKERS} | RIGHT
JUNK = [*POOL, np.full((2, 3), np.inf), "u=0", [dx.Sphere(1)], dx.Transform.scale(2), np.array([[0.5], [0.25]])]
U, W = np.array([0.0, 0.5]), 0.25
PLACE = {"u": 0.5, "v": 0.25, "w": 0.75, "nu": 1, "nv": 0, "nw": 1, "n": 1, "u0": 0.1, "u1": 0.8, "w0": 0.9, "w1": 0.2}
GIVEN = {
    "points": np.ones((4, 3)), "vectors": np.ones((4, 3)), "transform": dx.Transform.rotate("x", 1.0), "tolerance": 1e-9,
    "size": 2.0, "outward": False, "other": dx.Transform.scale(2),
}  # fmt: skip


def takes(call):
    """The names of the arguments of a bound method."""
    kinds = inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY
    return [p.name for p in inspect.signature(call).parameters.values() if p.kind in kinds]


def an(name):
    """One form of a class, from the row of its constructor."""
    return CLASSES[name](*CALLS[CLASSES[name]])


OF_TRANSFORM = {"moved", "with_net"}  # called by `transform @ form` and by conversions, with what these have checked


def methods():
    """(class, method) of all that takes arguments, classmethods apart; what several classes share once."""
    seen = set()
    for name, kind in CLASSES.items():
        if kind in BASES:
            continue
        for method in ("__call__", *(m for m in dir(kind) if not m.startswith("_"))):
            value = inspect.getattr_static(kind, method, None)
            if method not in OF_TRANSFORM and inspect.isfunction(value) and len(inspect.signature(value).parameters) > 1:
                if value not in seen:
                    yield name, method
                seen.add(value)


def test_every_constructor_and_function_has_its_row():
    """dx.__all__ less errors and bases; the named constructors; the rooms of pictures and files."""
    wanted = {one for one in NAMES.values() if not (inspect.isclass(one) and issubclass(one, (dx.GeometryError, *BASES)))}
    wanted |= {CLASSES[name] for name in CLASSES if CLASSES[name] not in BASES}
    assert {one.__name__ for one in wanted - set(CALLS) - {dx.join}} == set()
    named = {
        getattr(kind, method).__qualname__
        for kind in CLASSES.values()
        for method in vars(kind)
        if isinstance(inspect.getattr_static(kind, method), classmethod | staticmethod) and not method.startswith("_")
    }
    rows = {one.__qualname__ for one in CALLS}
    assert named - rows - {"Transform.identity"} == set()  # which takes nothing
    assert {f"{room.__name__}.{name}" for room in (plot, export) for name in room.__all__} == {
        f"{call.__module__.split('.')[0]}.{where}.{call.__name__}" for where, call in ROOMS
    }


@pytest.mark.parametrize(("name", "method"), list(methods()), ids=lambda part: part)
def test_one_wrong_argument_of_a_method(name, method):
    """The good arguments pass, then each is replaced in turn, where the method names it and where it comes first."""
    form = an(name)
    call = getattr(form, method)
    good = {argument: (PLACE | GIVEN)[argument] for argument in takes(call)}
    if method == "split":
        good.pop("w", None)
    call(**good)
    for argument in good:
        for wrong in JUNK:
            answer = attempted(
                lambda *a, keys=tuple(good): call(**dict(zip(keys, a, strict=True))), (good | {argument: wrong}).values()
            )
            assert not isinstance(answer, str) or len(answer) > 15, (argument, wrong)


ROOMS = [
    ("plot", plot.view), ("plot", plot.walk), ("plot", plot.compare), ("export", export.mesh), ("export", export.dumps),
    ("export", export.loads), ("export", export.write), ("export", export.read),
]  # fmt: skip


def test_join_is_asked_of_all_pairs():
    """Two curves or two surfaces; all else is told so."""
    for one in JUNK:
        for pair in ((one, EDGES[0]), (SPLINE, one), (one, one)):
            answer = attempted(dx.join, pair)
            assert not isinstance(answer, str) or len(answer) > 15


@pytest.mark.parametrize("place", range(3))
def test_pictures_of_anything(place):
    """plot.view with each of form, net and mark wrong."""
    for wrong in JUNK:
        if callable(wrong) and not isinstance(wrong, dx.Curve | dx.Surface):
            continue  # what a function raises is its own
        good = [dx.BezierPatch(NET), NET, (0.5, 0.25)]
        good[place] = wrong
        answer = attempted(lambda form, net, mark: plot.view(form, net=net, mark=mark), good)
        assert not isinstance(answer, str) or len(answer) > 15, wrong


def test_walks_and_comparisons_of_anything():
    """plot.walk with a wrong form or path; plot.compare with wrong parameters or points."""
    u, w = np.linspace(0, 1, 4), np.linspace(0, 1, 3)
    points = dx.Sphere(1)(u[:, None], w)
    for wrong in JUNK:
        for call, good in ((plot.walk, (dx.Sphere(1), [(0, 0), (1, 1)])), (plot.compare, ((u, w), points, points + 0.1))):
            for place in range(len(good)):
                if callable(wrong):
                    continue  # what a function raises is its own
                arguments = [*good]
                arguments[place] = wrong
                answer = attempted(call, arguments)
                assert not isinstance(answer, str) or len(answer) > 15, (call, place, wrong)


def test_files_of_anything(tmp_path):
    """Writing, meshing, reading and parsing what is none."""
    (tmp_path / "text.json").write_text(json.dumps([1, 2]))
    for wrong in JUNK:
        for call, arguments in (
            (export.mesh, (wrong, 4)), (export.mesh, (dx.Sphere(1), wrong)), (export.dumps, (wrong,)), (export.loads, (wrong,)),
            (export.write, (tmp_path / "a.json", wrong)), (export.write, (tmp_path / "a.obj", wrong)), (export.read, (wrong,)),
            (export.write, (wrong, dx.Sphere(1))),
        ):  # fmt: skip
            answer = attempted(call, arguments)
            assert answer is not None
            assert not isinstance(answer, str) or len(answer) > 15 or call is export.dumps, (call, wrong)
    assert "begins with" in attempted(export.read, (tmp_path / "text.json",))
