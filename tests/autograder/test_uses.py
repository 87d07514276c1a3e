"""Which earlier functions a function calls, from its text and from itself."""

import numpy as np
import pytest

from autograder import uses

WANTED = {"basis", "knots", "patch"}


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("def patch(u):\n    return basis(u) * 2", ("basis",)),
        ("def patch(u):\n    def inner(t):\n        return basis(t)\n    return inner(u)", ("basis",)),
        ("def patch(u): return np.stack([basis(t, knots(4)) for t in u])", ("basis", "knots")),
        ("patch = np.vectorize(lambda t: basis(t))", ("basis",)),
        ("def helper(t):\n    return basis(t)\n\ndef patch(u):\n    return helper(u)", ("basis",)),
        ("@wrapped\ndef patch(u):\n    return list(map(basis, u))", ("basis",)),
        ("def patch(u):\n    return patch(u - 1)", ()),  # itself
        ("def other(u):\n    return basis(u)\n\ndef patch(u):\n    return u", ()),
        ("basis(0.5)\n\ndef patch(u):\n    return u", ()),  # at the margin, not in the function
        ("def patch(u):\n    return my.basis(u)  # basis", ()),  # an attribute, a comment
        ("def patch(u):\n    '''Uses basis(t).'''\n    return 'basis'", ()),
        ("def patch(u, basis):\n    return basis", ()),  # a parameter
        ("def patch(u):\n    basis = u ** 2\n    return basis", ()),  # a name of its own
        ("def patch(u):\n    return f(u, basis=3)", ()),  # a keyword
        ("def patch(u):\n    return basis(u", ("basis",)),  # no Python, but read as far as it goes
        ("%matplotlib inline\ndef patch(u):\n    return basis(u)", ("basis",)),
        ("def patch(u):\n  if u:\n      return basis(u)\n    else: x", ("basis",)),
        ("def", ()),
        ("", ()),
    ],
)
def test_names_in_the_text_of_a_function(text, found):
    """Only what the function itself or a helper of its own uses counts."""
    assert uses.in_text([text], "patch", WANTED) == found


def test_a_later_cell_redefines():
    """The last definition is the one that is called, and an earlier exercise is not looked into."""
    cells = ["def patch(u):\n    return basis(u)", "def basis(t):\n    return knots(t)", "def patch(u):\n    return u"]
    assert uses.in_text(cells[:2], "patch", WANTED) == ("basis",)
    assert uses.in_text(cells, "patch", WANTED) == ()


def test_a_hostile_text_is_only_read():
    """Deep nesting, null bytes and a text without end cost no more than reading them."""
    for text in ("def patch(u):\n    return " + "(" * 5000 + "basis", "def patch(u):\n    \0basis", "-" * 200_000):
        assert uses.in_text([text], "patch", WANTED) in ((), ("basis",))


def test_modules_of_a_function_at_hand():
    """Imported in it or above it, as a module or name by name, in a helper too; its own notebook is none."""
    names: dict = {"__name__": "__main__"}
    exec(
        "import math, numpy as np, scipy.special\nfrom scipy.linalg import inv\nfrom directrix import plot\n"
        "def plain(u): return u\n"
        "def lists(u): return np.sin(u)\n"
        "def inside(u):\n    import os.path\n    from scipy import stats\n    from directrix import Sphere, plot\n"
        "def helper(u): return inv(u)\n"
        "def through(u): return math.sin(helper(u)), plot\n"
        "again = np.vectorize(lambda u: again(u) + scipy.special.comb(u, 2))\n",
        names,
    )
    assert uses.modules(names["plain"]) == ()
    assert uses.modules(names["lists"]) == ("numpy",)
    assert uses.modules(names["inside"]) == ("directrix.Sphere", "directrix.plot", "os.path", "scipy.stats")
    assert uses.modules(names["through"]) == ("directrix.plot", "math", inv_home(names))
    assert "scipy" in uses.modules(names["again"])
    assert uses.modules(len) == ("builtins",)


def inv_home(names):
    return names["inv"].__module__


def test_globals_of_a_function_at_hand():
    """In a kernel the function is there, with its helpers; attributes and locals are none of its globals."""
    names: dict = {"np": np}
    exec(  # as a notebook does
        "def basis(t): return t\n"
        "def knots(m): return m\n"
        "def helper(t): return basis(t)\n"
        "def patch(u): return [helper(t) for t in u]\n"
        "def local(u):\n    basis = u\n    return np.knots(basis)\n"
        "vector = np.vectorize(lambda t: knots(t))\n",
        names,
    )
    assert uses.in_function(names["patch"], WANTED) == ("basis",)
    assert uses.in_function(names["local"], WANTED) == ()
    assert uses.in_function(names["vector"], WANTED) == ("knots",)
    assert uses.in_function(len, WANTED) == ()


def test_of_very_many_cells_the_first_are_read():
    """Taking 32 MB of text apart takes a minute, and it is asked after each exercise that is not right."""
    filled = "x = 1\n" * 6600
    cells = ["def patch(u):\n    return basis(u)", *(f"# {number}\n{filled}" for number in range(200))]
    uses._definitions.cache_clear()
    assert uses.in_text(cells, "patch", WANTED) == ("basis",)
    assert uses._definitions.cache_info().misses <= 11
