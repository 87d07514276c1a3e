"""What the zygote prepares must have taken effect in a notebook's process: a shortcut that misses its library says nothing."""

from __future__ import annotations

from autograder.sandbox import Policy, Sandbox


def test_a_traceback_takes_the_grammar_and_the_style_that_are_there(sandbox):
    with sandbox.open() as notebook:
        result = notebook.run_cell(
            "import stack_data\n"
            "from pygments.formatters.terminal256 import Terminal256Formatter\n"
            "from pygments.lexers import PythonLexer\n"
            "from pygments.token import Name\n"
            "import pygments.styles\n"
            "class Same(PythonLexer):\n    pass\n"
            "class Other(PythonLexer):\n    tokens = {'root': [('.+', Name)]}\n"
            "plain = pygments.styles.get_style_by_name('default')\n"
            "PythonLexer()\n"
            "stock = PythonLexer._tokens\n"
            "print(Same()._tokens is stock, Other()._tokens is stock, list(Other().get_tokens('1')))\n"
            "derived = [stack_data.style_with_executing_node(plain, 'bg:ansiyellow') for _ in range(2)]\n"
            "print(derived[0] is derived[1])\n"
            "one, two = (Terminal256Formatter(style=style) for style in (plain, derived[0]))\n"
            "print(one.style_string == two.style_string, Terminal256Formatter(style=plain).style_string == one.style_string)"
        )
    assert result.status == "ok", result.outputs
    assert result.outputs[0]["text"].splitlines() == [
        "True False [(Token.Name, '1'), (Token.Text.Whitespace, '\\n')]",
        "True",
        "False True",
    ]


def test_a_frame_of_a_cell_is_in_no_module(sandbox):
    with sandbox.open() as notebook:
        result = notebook.run_cell(
            "import inspect, json, sys\n"
            "stock = inspect.getmodule.__wrapped__\n"
            "print(inspect.getmodule(sys._getframe()), stock(sys._getframe()), inspect.getmodule(json.dumps) is json)\n"
            "print(inspect.getsource(sys._getframe()).splitlines()[0], inspect.getmodule(inspect.currentframe().f_back))\n"
        )
    assert result.status == "ok", result.outputs
    first, second = result.outputs[0]["text"].splitlines()
    assert first == "None None True"
    assert second.startswith("import inspect, json, sys <module 'IPython.core.interactiveshell'")


def test_plotly_takes_arrays_as_they_are():
    with Sandbox(Policy()) as box, box.open() as notebook:
        result = notebook.run_cell(
            "import numpy, _plotly_utils.basevalidators as used, narwhals.stable.v1 as stock\n"
            "array = numpy.zeros(2)\n"
            "print(used.nw.from_native is not stock.from_native, used.nw.from_native(array, pass_through=True) is array)"
        )
    assert result.status == "ok", result.outputs
    assert result.outputs[0]["text"] == "True True\n"


def test_what_is_rehearsed_leaves_its_speed(sandbox):
    with sandbox.open() as notebook:
        result = notebook.run_cell(
            "import stack_data, sys\n"
            "read = {name.rpartition('/')[2] for name, _ in stack_data.Source._class_local('__source_cache_with_lines', {})}\n"
            "print(sorted(read & {'crossing.py', 'peer.py', 'numeric.py'}), 'encodings.ascii' in sys.modules)"
        )
    assert result.status == "ok", result.outputs
    assert result.outputs[0]["text"] == "['crossing.py', 'numeric.py', 'peer.py'] True\n"


def test_what_is_rehearsed_leaves_nothing_else(sandbox):
    with sandbox.open() as notebook:
        first = notebook.run_cell("print(sorted(globals()))")
        then = notebook.run_cell(
            "import asyncio, linecache, signal, sys\n"
            "shell = get_ipython()\n"
            "history, cells = shell.history_manager, [name for name in linecache.cache if name.startswith('<ipython')]\n"
            "print(In[:2], Out, [_, __, ___], [_ii, _iii], shell.execution_count, asyncio.current_task().get_name())\n"
            "print(cells == list(shell.compile._filename_map), len(cells), hasattr(sys, 'last_value'), signal.getsignal(10))\n"
            "print(list(history.outputs), history.exceptions, history.output_hist_reprs)\n"
            "print([row[0] for row in history.db_input_cache], history.db_output_cache)"
        )
    assert first.outputs[0]["text"] == (
        "['In', 'Out', '_', '__', '___', '__builtin__', '__builtins__', '__doc__', '__loader__', '__name__', '__package__', "
        "'__spec__', '_dh', '_i', '_i1', '_ih', '_ii', '_iii', '_oh', 'exit', 'get_ipython', 'open', 'quit']\n"
    )
    assert then.status == "ok", then.outputs
    assert then.outputs[0]["text"].splitlines() == [
        "['', 'print(sorted(globals()))'] {} ['', '', ''] ['', ''] 3 Task-2",
        "True 2 False 0",
        "[1, 2] {} {}",
        "[1, 2] []",
    ]
