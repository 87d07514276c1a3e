"""Cells are compiled ahead, those that everybody was given in the zygote, and show what they show as IPython reads them."""

from __future__ import annotations

import re

import pytest

from autograder.sandbox import Limits, Policy, Sandbox
from tests.autograder.sandbox.awkward_cells import GROUPS

IPYTHONS = "get_ipython().compile.__dict__.update(compile_ahead=lambda *_: False, take=lambda cell: None)"
OURS = "get_ipython().compile.__dict__.update()"
TOLD = (
    "import inspect, linecache, sys, warnings\ndef half(v):\n    '''Half of it.'''\n    return v / 2\nhalf(3)",
    "def outer():\n    def inner():\n        return [1 / k for k in (1, 0)]\n    return inner()\nouter()",
    "print(inspect.getsource(half), half.__code__.co_filename, linecache.getlines(half.__code__.co_filename)[1])",
    "print(sys._getframe().f_code.co_filename, [code for code in outer.__code__.co_consts if hasattr(code, 'co_code')])",
    "warnings.warn('here')\nwarnings.warn('there')",
    "a = 1000\nb = 1000\nc = 'two words'\nd = 'two words'\nprint(a is b, c is d)",
    "'a text'\nx: int = 3\n'another'\nprint(__doc__, __annotations__)",
    "print(1 is 1)",
    "print('before')\nreturn 5",
    "print('before')\n1 +",
    "  indented = 2\n  indented",
    "import asyncio\nawait asyncio.sleep(0, 'waited')",
    "%time 1",
    "half?",
    "def lost(:",
    "5;",
    "",
    "# nothing",
    "_, __",
    "In[2][:20], _i, _ih[-1] is In[-1]",
    "a = 1000\nb = 1000\nc = 'two words'\nd = 'two words'\nprint(a is b, c is d)",
    "from __future__ import annotations\ndef later(x: not_there): pass\nlater.__annotations__",
    "def later(x: not_there): pass\nlater.__annotations__",
    "for k in range(2):\n    warnings.warn('a loop')",
    "x = 5\nglobal x",
    "@half\nclass C: pass",
    "raise SystemExit",
)
# Of two statements on a line, the one with the lower address decides which lines a traceback shows around it; and a traceback
# through two threads shows which of them was the faster.
LUCK = {"bad __repr__", "bad _repr_html_", "%%bash"}
CELLS = {
    "told": TOLD,
    **{
        group: tuple(cells[name] for name in cells if name not in LUCK) for group, cells in GROUPS.items() if group != "figures"
    },
}
HABITS = {  # what a notebook may do before a given cell, which must then be read as IPython reads it
    "a transformer of trees": (
        "import ast\n"
        "class Doubling(ast.NodeTransformer):\n"
        "    def visit_Constant(self, node):\n"
        "        return ast.copy_location(ast.Constant(2 * node.value), node) if isinstance(node.value, int) else node\n"
        "get_ipython().ast_transformers.append(Doubling())"
    ),
    "one that fails half-way": (
        "import ast\n"
        "class Failing(ast.NodeTransformer):\n"
        "    def visit_Constant(self, node):\n"
        "        node.value = 7\n"
        "        raise RuntimeError('half-way')\n"
        "get_ipython().ast_transformers.append(Failing())"
    ),
    "one that comes with the cell": (
        "import ast\n"
        "class Doubling(ast.NodeTransformer):\n"
        "    def visit_Constant(self, node):\n"
        "        return ast.copy_location(ast.Constant(2 * node.value), node) if isinstance(node.value, int) else node\n"
        "get_ipython().events.register('pre_run_cell', lambda info: get_ipython().ast_transformers.append(Doubling()))"
    ),
    "a transformer of lines": "get_ipython().input_transformers_cleanup.append(lambda lines: [*lines, 'print(\"more\")\\n'])",
    "one of what comes after": "get_ipython().input_transformers_post.append(lambda lines: [*lines, 'print(\"more\")\\n'])",
    "another compile": (
        "import builtins\nstock = compile\ndef mine(source, *more, **named):\n"
        "    print('mine', type(source).__name__)\n    return stock(source, *more, **named)\nbuiltins.compile = mine\nlate = 1"
    ),
    "one that awaits": (
        "import asyncio\nget_ipython().input_transformers_post.append(lambda lines: [*lines, 'await asyncio.sleep(0)\\n'])"
    ),
    "names of one's own": (
        "import itertools\ncount = itertools.count()\n"
        "get_ipython().compile.get_code_name = lambda *about: f'<ipython-input-{next(count)}>'"
    ),
    "its own code in the middle": (
        "import ast, sys\nshell = get_ipython()\nwith shell.compile.extra_flags(ast.PyCF_ALLOW_TOP_LEVEL_AWAIT):\n"
        "    exec(shell.compile(ast.parse('print(7)'), sys._getframe().f_code.co_filename, 'exec'))\nx = 8\nprint(x)"
    ),
    "a cell in the middle": "get_ipython().run_cell('print(1)\\n2')\nx = 9\nprint(x)\nget_ipython().run_cell('x +')\nx",
    "flags in the middle": (
        "import __future__\nget_ipython().compile.flags |= __future__.annotations.compiler_flag\n"
        "def soon(x: not_there): pass\nsoon.__annotations__"
    ),
    "future annotations": "from __future__ import annotations",
    "every value is shown": "get_ipython().ast_node_interactivity = 'all'",
    "nothing is awaited": "%autoawait off",
    "hardly any depth": "import sys; sys.setrecursionlimit(150)",
    "short numbers": "import sys; sys.set_int_max_str_digits(640)",
    "another number": "get_ipython().execution_count = 20",
    "a cell more": "print('one more')\nprint('and more')",
    "a cell less": "",
    "an autocall": "%autocall 2\nimport math",
    "the same cell": "a = 257\nb = 257\n(a is b, 257)",
}
AFTER = (
    "a = 257\nb = 257\n(a is b, 257)",
    "def f(x: 1 = 3):\n    return 10\nf.__annotations__\n11",
    "math.sqrt 4",
    "x = " + "(" * 60 + "1" + ")" * 60 + "\nx",
    f"y = {'9' * 700}\nlen(str(y % 10**9))",
    "def g():\n    raise KeyError(5)\ng()",
)


def simple(result):
    """Outputs without addresses and times, and of a library's lines in a traceback only those that run."""
    for output in result.outputs:
        for k, frame in enumerate(output.get("traceback", ())):
            if "File " in frame:
                output["traceback"][k] = [line for line in frame.splitlines() if "File " in line or "-> " in line]
    text = re.sub(r"0x[0-9a-f]+", "ADDRESS", repr((result.status, result.note, result.outputs, result.execution_count)))
    text = re.sub(r"The slowest run took .*?\\n", "", text)  # what %timeit says on a busy machine
    return re.sub(r"\d+(\.\d+)?(e\+\d+)? ([µμmn]?s)\b", "TIME", text)


def shown(box, cells, first=OURS):
    with box.open(limits=Limits(notebook_cpu=300)) as session:
        session.run_cell(first)
        return [simple(session.run_cell(cell)) for cell in cells]


@pytest.fixture(scope="module")
def boxes():
    """One that knows nothing, and one that has been given all cells."""
    policy = Policy(packages="all", preload=())
    with Sandbox(policy) as one, Sandbox(policy) as other:
        for cells in (*CELLS.values(), AFTER):
            other.expect(cells)
        yield one, other


@pytest.mark.parametrize("group", CELLS)
def test_a_cell_shows_what_it_shows_as_ipython_reads_it(boxes, group):
    usual = shown(boxes[0], CELLS[group], IPYTHONS)
    assert shown(boxes[0], CELLS[group]) == usual
    assert shown(boxes[1], CELLS[group]) == usual


@pytest.mark.parametrize("habit", HABITS)
def test_what_a_notebook_may_change_first_is_noticed(boxes, habit):
    cells = (HABITS[habit], *AFTER)
    usual = shown(boxes[0], cells, IPYTHONS)
    assert shown(boxes[0], cells) == usual
    assert shown(boxes[1], cells) == usual


def test_a_given_cell_is_not_read_again():
    """Each is there to be taken once; its code runs with the number that the cell has, expected or not."""
    cells = ("x = 2000\ndef f():\n    return x", "y = 3000\nf() + y", "z = 4000")
    watch = "import sys\nread = []\nsys.addaudithook(lambda name, about: name == 'compile' and read.append(about))"
    ask = "print(len(read), [*get_ipython().compile.given]); read.clear()"
    with Sandbox(Policy(packages=(), preload=())) as box:
        box.expect(cells)
        with box.open() as session:
            runs = [session.run_cell(cell).outputs for cell in (watch, ask, *cells[:2], ask, cells[0], ask, "f.__code__")]
    once, given, again = (runs[k][0]["text"] for k in (1, 4, 6))
    assert given == once.replace(str(list(cells)), "['z = 4000']")
    assert int(again.split()[0]) > int(once.split()[0])
    assert runs[3][0]["data"]["text/plain"] == "5000"
    assert 'file "<ipython-input-6-' in runs[7][0]["data"]["text/plain"]


def test_what_is_too_long_is_read_by_each_notebook():
    """One cell that is longer than a message, and all of them together."""
    long = "x = [" + "1, " * 10_000 + "]\nlen(x)"
    cells = (long + " " * 2**16, *(f"{long} + {k}" for k in range(20)))
    with Sandbox(Policy(packages=(), preload=())) as box:
        box.expect(cells)
        with box.open() as session:
            held = session.run_cell("print(sorted(int(cell.split('+')[-1]) for cell in get_ipython().compile.given))")
            shown = [session.run_cell(cell).outputs[0]["data"]["text/plain"] for cell in (cells[0], cells[1], cells[-1])]
    assert held.outputs[0]["text"] == f"{list(range(4))}\n"
    assert shown == ["10000", "10000", "10019"]
