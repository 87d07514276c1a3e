"""Which test cells can run apart is tried with the instructor's solution; here without a course around it."""

import itertools
import json
from types import SimpleNamespace

import pytest

from autograder.errors import CourseError
from autograder.notebook import apart
from autograder.sandbox import Limits, Policy, Sandbox

STACK = "class Stack:\n    def push(self, x): self.top = x"
DOUBLE = "def double(x): return 2 * x"


@pytest.fixture(scope="module")
def box():
    with Sandbox(Policy(packages=("numpy", "plotly", "dateutil"), preload=())) as opened:
        yield opened


def prepared(box, tmp_path, *cells, withhold=()):
    """The script of a notebook of (name, source) cells; those called test_... are tests of one point, others solutions."""
    about = {name: {"grade_id": name, "grade": name.startswith("test"), "solution": name[:4] != "test"} for name, _ in cells}
    written = [{"cell_type": "code", "source": text, "metadata": {"nbgrader": about[name]}} for name, text in cells]
    (tmp_path / "one.ipynb").write_text(json.dumps({"cells": written}))
    tests = [name for name, _ in cells if name.startswith("test")]
    graded = [
        SimpleNamespace(name=name, cell_type="code", solution=False, exercise=None, points=1.0, checksum="") for name in tests
    ]
    limits = Limits(cell_cpu=2.0)
    withheld = itertools.repeat(withhold) if isinstance(withhold, tuple) else withhold
    return apart.prepare(
        tmp_path / "one.ipynb",
        SimpleNamespace(graded=graded, digest="d"),
        judged=(),
        open_session=lambda: box.open(limits=limits),
        open_pair=lambda: box.pair(limits=limits, withhold=next(withheld)),
    )


HELPER = "def same(a, b): assert a == b\nsame(double(2), 4)"


def test_a_cell_that_shares_keeps_what_an_earlier_test_cell_left_for_it(box, tmp_path):
    """Else the course could not be graded at all: the one runs apart, and the other would miss its helper."""
    later = "s = Stack()\ns.push(3)\nsame(s.top, 3)"
    script = prepared(
        box, tmp_path, ("a", f"{DOUBLE}\n{STACK}"), ("test_1", HELPER), ("test_2", later), ("test_3", "assert double(1) == 2")
    )
    assert set(script.shared) == {"test_1", "test_2"}
    assert "test_2, which shares, may need what it leaves" in script.shared["test_1"]
    assert script.apart == {"test_3"}


def test_a_cell_that_shares_and_needs_a_withheld_module_stops_even_where_no_cell_runs_apart(box, tmp_path):
    text = "import dateutil.parser\ns = Stack()\ns.push(dateutil.parser.parse('2020-01-02'))"
    with pytest.raises(CourseError, match=r"test_1 has to share.*No module named 'dateutil.parser'.*withheld module"):
        prepared(box, tmp_path, ("a", STACK), ("test_1", text), withhold=("dateutil",))


def test_a_cell_that_fails_once_by_chance_does_not_stop_the_course(box, tmp_path):
    withheld = iter([(), ("dateutil",), (), ()])  # in the second trial it fails, and not in the next
    text = "import dateutil.parser\nStack().push(1)"
    script = prepared(box, tmp_path, ("a", STACK), ("test_1", text), withhold=withheld)
    assert set(script.shared) == {"test_1"}
    assert next(withheld, "none left") == "none left"


READS = "import inspect\nassert 'for' not in inspect.getsource(double)"
ALONE = "xs = [2]\ndouble(xs)\nassert xs == [2]"


def test_a_cell_that_reads_the_solution_shares_and_one_that_looks_at_its_arguments_does_not(box, tmp_path):
    script = prepared(box, tmp_path, ("a", DOUBLE), ("test_1", READS), ("test_2", ALONE))
    assert (set(script.shared), set(script.apart)) == ({"test_1"}, {"test_2"})


REACHES = [
    ("import numpy as np", "np.linalg.solve = None\nassert double(1) == 2", "np.linalg.solve of its own"),
    ("import numpy as np\ndef forbid(): del np.dot", "forbid()\nassert double(1) == 2", "np.dot of its own"),
    ("from unittest.mock import patch", "with patch('math.sin'): assert double(1) == 2", "mock"),
    ("import sys", "sys.setrecursionlimit(90)\nassert double(1) == 2", "setrecursionlimit"),
    ("import sys", "assert 'scipy' not in sys.modules\nassert double(1) == 2", "modules"),
    ("import builtins as b", "old, b.sum = b.sum, None\nassert double(1) == 2\nb.sum = old", "builtins"),
    ("import warnings", "with warnings.catch_warnings():\n    assert double(1) == 2", "catch_warnings"),
    ("", "kept = double\ndel double\nassert kept(1) == 2\ndouble = kept", "del double"),
    ("import numpy as np", "with np.errstate(all='raise'): assert double(1) == 2", "errstate"),
]


@pytest.mark.parametrize(("helper", "test", "what"), REACHES)
def test_a_cell_that_sets_something_for_the_code_it_tests_shares_its_process(helper, test, what):
    trees = [apart._parsed(text) for text in (helper, test, DOUBLE)]
    found = apart.reaching({"test": trees[1]}, trees[:1], trees[2:])
    assert found == {"test": f"it uses {what}, which would not reach the code it tests"}


def test_what_a_cell_that_shares_puts_back_is_the_learners_for_the_others(box, tmp_path):
    """As in the notebook that nbgrader quickstart makes: the last test takes a function away to see who needs it."""
    twice = "def twice(x): return double(double(x))"
    taken = "kept = double\ndel double\ntry: twice(1)\nexcept NameError: pass\nelse: assert False\nfinally: double = kept"
    script = prepared(box, tmp_path, ("a", DOUBLE), ("test_1", "assert double(1) == 2"), ("b", twice), ("test_2", taken))
    assert (set(script.shared), set(script.apart), script.names) == ({"test_2"}, {"test_1"}, ("double",))


PLAIN = "import random, numpy as np\nrandom.seed(1)\nx = np.zeros(3)\nx.flat[0] = random.random()\nassert double(1) == 2"
DRAWS = "import random\ndef double(x): return x + x * (random.random() < 1)"


def test_a_seed_matters_only_where_the_solution_draws(box, tmp_path):
    assert prepared(box, tmp_path, ("a", DOUBLE), ("test_1", PLAIN)).apart == {"test_1"}
    assert prepared(box, tmp_path, ("a", DRAWS), ("test_1", PLAIN)).shared.keys() == {"test_1"}


def test_a_withheld_module_outweighs_a_setting(box, tmp_path):
    text = "import warnings, dateutil.parser\nwith warnings.catch_warnings(): assert double(1) == 2"
    assert prepared(box, tmp_path, ("a", DOUBLE), ("test_1", text), withhold=("dateutil",)).apart == {"test_1"}
