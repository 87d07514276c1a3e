"""What a function returned, made plain: the same wherever it is called, and never an error."""

import collections
import datetime
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

from autograder.catalogue import shipped
from autograder.checking.calling import Learner
from autograder.comparison.answers import Numbers, read
from autograder.judge import judge
from autograder.notebook.session import opened
from autograder.returned import ITEMS, MOST_VALUES, Foreign, plainly

NUMBERS = [
    [[1.0, 2.0], [3.0, 4.0]],
    [range(1, 3), (3, 4)],
    np.array([[1, 2], [3, 4]], dtype=object),
    [[Fraction(1), Fraction(2)], [Decimal(3), 4]],
    np.array([[1, 2], [3, 4]], dtype=np.longdouble),
    memoryview(np.array([[1.0, 2.0], [3.0, 4.0]])),
    collections.deque([np.array([1, 2]), np.array([3, 4])]),
]


class Rough:
    """An object that fails whatever it is asked."""

    def __array__(self, *_, **__):
        raise RuntimeError("not now")

    def __float__(self):
        raise RuntimeError("nor so")

    def __len__(self):
        raise RuntimeError("nor this")


def objects(*items):
    """An array of them; NumPy itself would ask what they are."""
    found = np.empty(len(items), dtype=object)
    for place, item in enumerate(items):
        found[place] = item
    return found


class Liar(str):
    def __str__(self):
        raise RuntimeError("no")


@pytest.mark.parametrize("value", NUMBERS, ids=lambda value: type(value).__name__)
def test_what_numpy_takes_as_numbers_is_an_array_of_them(value):
    answer = read(value)
    assert isinstance(answer, Numbers)
    assert answer.values.tolist() == [[1, 2], [3, 4]]


@pytest.mark.parametrize(
    ("value", "plain"),
    [
        (np.float32(2.5), 2.5),
        (np.longdouble(2.5), 2.5),
        (np.int8(3), 3),
        (np.True_, True),
        (Fraction(1, 4), 0.25),
        (2**70, 2.0**70),
        (10**400, Foreign("object", "int")),
        (Liar("cone"), "cone"),
        (b"ab", ["b'ab'"]),
        (np.array(["a", "b"]), ["a", "b"]),
        ([1, "a"], [1, "a"]),
        ([None, 1.0], [None, 1.0]),
        ({1}, Foreign("object", "set")),
        (datetime.date(2027, 1, 1), Foreign("object", "date")),
        (len, Foreign("function", "builtin_function_or_method")),
        (Rough(), Foreign("object", "Rough")),
        ([Rough()], [Foreign("object", "Rough")]),
        (objects(Rough(), 1), [Foreign("object", "Rough"), 1]),
        ([[[[[{}]]]]], [[[[Foreign("object", "list")]]]]),
        (["a"] * (ITEMS + 1), ["a"] * ITEMS),
        (np.zeros(MOST_VALUES + 1, dtype=bool), Foreign("large", str(MOST_VALUES + 1))),
        (np.empty((0, 2**31)), Foreign("large", str(2**31))),
        (np.empty((2**31, 2**31, 0), dtype="i1"), Foreign("large", str(2**62))),
        (np.ma.array([1.0, 2.0], mask=[True, False]), Foreign("masked", "MaskedArray")),
    ],
    ids=lambda value: type(value).__name__,
)  # fmt: skip
def test_everything_else_is_told_as_what_it_is(value, plain):
    """Twice is as good as once: the judge reads what the sandbox has made plain already."""
    found = plainly(value)
    assert (type(found), found) == (type(plain), plain)
    assert plainly(found) == found


@pytest.mark.parametrize("deep", [list, tuple])
def test_what_holds_itself_comes_to_an_end(deep):
    inner = []
    inner.append(deep([inner]))
    assert plainly(inner) == plainly(plainly(inner))


POINTS = """
import collections, datetime, decimal, fractions
import numpy as np

class Array:
    def __init__(self, points):
        self.points = points

    def __array__(self, dtype=None, copy=None):
        return np.asarray(self.points, dtype)

def points(u, w, r, h):
    u, w = np.broadcast_arrays(u, w)
    return np.stack([r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), h * w], axis=-1)

def cylinder(u, w, r, h):
    right = points(u, w, r, h)
    return """
ENDS = [
    "right.tolist()", "right.astype(object)", "list(right.astype(object))", "right.astype('f2')", "right.astype('>f8')",
    "np.vectorize(fractions.Fraction, otypes=[object])(right)", "memoryview(np.ascontiguousarray(right))", "Array(right)",
    "np.vectorize(decimal.Decimal, otypes=[object])(right).tolist()", "right.astype(np.longdouble)", "right + 0j",
    "np.ma.array(right)", "np.ma.array(right, mask=right > 1)", "np.where(right > 1, None, right)", "right.astype(str)",
    "right.tobytes()", "right.astype('M8[s]')", "tuple(np.moveaxis(right, -1, 0))", "[right[..., 0], right[..., :1], h]",
    "{'x': right}", "{1, 2}", "map(float, range(3))", "range(3)", "collections.deque([1, 2, 3])", "Array", "points", "None",
    "10**30", "np.zeros((1,) * 9)", "np.zeros((1500, 1500))", "[[1, 2], [3]]", "[[[[[right]]]]]", "'2.0'", "print(right)",
    "datetime.date(2027, 1, 1)", "(x for x in right)",
]  # fmt: skip


@pytest.fixture(scope="module")
def sandboxed():
    with opened([shipped().find("cylinder")], (), None, None) as open_session, open_session({}) as session:
        yield session


@pytest.mark.parametrize("end", ENDS)
def test_check_and_grading_say_the_same(sandboxed, end, capsys):
    """In the learner's own process and behind the sandbox's wall: outcome, points and every word."""
    exercise, source, own = shipped().find("cylinder"), POINTS + end, {}
    exec(source, own)
    assert sandboxed.run_cell(source).status == "ok"
    checked = judge(exercise, Learner(own["cylinder"]), seed=0)
    graded = judge(exercise, lambda *arguments: sandboxed.call("cylinder", arguments), seed=0)
    assert (graded.outcome, graded.fraction, graded.message) == (checked.outcome, checked.fraction, checked.message)


def test_numbers_in_objects_have_full_marks(sandboxed):
    """The judge looks at values, not at how they are kept."""
    sandboxed.run_cell(POINTS + "right.astype(object)")
    graded = judge(shipped().find("cylinder"), lambda *arguments: sandboxed.call("cylinder", arguments), seed=b"hidden")
    assert graded.outcome == "passed"
