"""What the zygote prepares must have taken effect in a notebook's process: a shortcut that misses its library says nothing."""

from __future__ import annotations

import re

import numpy as np
import pytest

from autograder.sandbox import Policy, Sandbox
from autograder.sandbox.guest import figures


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


def test_a_function_is_coloured_once_for_each_place_in_it(sandbox):
    with sandbox.open() as notebook:
        result = notebook.run_cell(
            "import stack_data.core as core, pygments.styles\n"
            "from pygments.formatters.terminal256 import Terminal256Formatter as Terminal, TerminalTrueColorFormatter\n"
            "style = core.style_with_executing_node(pygments.styles.get_style_by_name('default'), 'bg:ansiyellow')\n"
            "stock, kept = core._pygmented_with_ranges.__wrapped__, core._pygmented_with_ranges\n"
            "code = 'def f(x):\\n    \\'\\'\\'long words\\'\\'\\'\\n    return g(x) + 1'\n"
            "for formatter in (Terminal(style=style), Terminal(style='vim'), TerminalTrueColorFormatter(style=style)):\n"
            "    for ranges in ([], [(40, 44)], [(40, 48)], [(40, 44)]):\n"
            "        first, again = kept(formatter, code, ranges), kept(formatter, code, ranges)\n"
            "        print(first == again == stock(formatter, code, ranges), first is again)\n"
            "        first.clear()\n"
            "places = {tuple(kept(Terminal(style=style), code, [(n, n + 1)])) for n in range(40, 48)}\n"
            "print(len(places) > 1)"
        )
    assert result.status == "ok", result.outputs
    assert result.outputs[0]["text"].splitlines() == ["True False"] * 12 + ["True"]


def test_tracebacks_through_rehearsed_functions_are_stock_ones(sandbox):
    """The second of two tracebacks through one function is taken from the first; a place of its own is none of the other's."""
    with sandbox.open() as notebook:
        notebook.run_cell(
            "import numpy as np\ndef g(x):\n    'words'\n    np.linalg.norm(x, axis=-1)\n    return np.reshape(x, 7)"
        )
        first, second, other = (notebook.run_cell(f"g({x})").outputs[0]["traceback"] for x in ("[[None]]", "[[None]]", "[[1]]"))
        notebook.run_cell(
            "import stack_data.core as core\ncore._pygmented_with_ranges = core._pygmented_with_ranges.__wrapped__"
        )
        stock, stock_other = (notebook.run_cell(f"g({x})").outputs[0]["traceback"] for x in ("[[None]]", "[[1]]"))
    unnumbered = [[re.sub(r"In\[.*?\d+|ipython-input-\d+-\w+", "", line) for line in lines] for lines in (first, second, stock)]
    assert unnumbered[0] == unnumbered[1] == unnumbered[2]
    assert len(first) > 3
    assert other[-1] == stock_other[-1] != first[-1]
    assert other[3:] == stock_other[3:]


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
    """The files that tracebacks go through are read one after the other, while nobody asks for a process."""
    told = ""
    for _ in range(100):
        with sandbox.open() as notebook:
            result = notebook.run_cell(
                "import stack_data, sys\n"
                "sources = stack_data.Source._class_local('__source_cache_with_lines', {})\n"
                "read = {name.rpartition('/')[2] for name, _ in sources}\n"
                "print(sorted(read & {'crossing.py', 'peer.py', 'numeric.py'}), 'encodings.ascii' in sys.modules)"
            )
        assert result.status == "ok", result.outputs
        told = result.outputs[0]["text"]
        if told == "['crossing.py', 'numeric.py', 'peer.py'] True\n":
            return
    raise AssertionError(told)


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


SHOWN = """
import numpy as np, plotly.graph_objects as go, plotly.io as pio
from directrix import plot
pio.templates.default = {template!r}
def f(u, w):
    return np.stack(np.broadcast_arrays(u, w, u * w), axis=-1)
figures = [
    plot.view(f, square=True, mark=(0.25, 0.5), title="<b>NaN</b> \\u00e9/"),
    plot.view(f, against=lambda u, w: f(u, w) + 0.1),
    plot.view(lambda u, w: f(u, np.where(w > 0.5, np.nan, w))),
    go.Figure([go.Scatter(x=np.arange(3.0), y=(1, 2.5, None), line={{"width": 1}}), go.Bar(x=np.arange(3), y=["a", "b"])]),
    go.Figure(go.Surface(z=np.eye(3)[:, ::2], surfacecolor=np.ones((2, 3), "f4").T)).update_layout(height=np.float64(300)),
    go.Figure(go.Scatter(y=[1, float("nan")], meta={{"layer": {{"a": np.ones(2)}}, "range": np.ones(2)}})),
    go.Figure(go.Scatter(y=np.ones(2), name="\\ue000", text=["\\\\ue000"])),
    go.Figure(go.Scatter(y=np.ones(2), meta={{"layer": {{"a": np.ones(2)}}}})),
    go.Figure(go.Scatter(y=np.ones(2), meta={{"b": [np.ones(2), {{"a": np.ones(2)}}]}})),
    go.Figure(go.Scatter(y=np.ones(2), meta={{"range": [1, [np.ones(2)]]}})),
    go.Figure(go.Scatter(y=np.ones(2), text='": {{"dtype": "f8", "bdata": "', meta={{"range": "[{{", "layers": (1, "a")}})),
    go.Figure(go.Scatter(y=[1]), frames=[go.Frame(data=[go.Scatter(y=np.ones(2))])]).add_annotation(text="a", x=0, y=0),
]
figures[-1].layout.xaxis.range = (0, 1)
"""


@pytest.mark.parametrize("template", ["none", "plotly"])
def test_figures_are_shown_at_once_as_plotly_shows_them(template):
    """``show`` is plotly's own way: nothing of ours is in it."""
    with Sandbox(Policy()) as box, box.open() as notebook:
        assert notebook.run_cell(SHOWN.format(template=template)).status == "ok"
        for number in range(12):
            ours, stock = (notebook.run_cell(f"figures[{number}]{how}").outputs for how in ("", ".show()"))
            assert [output["output_type"] for output in ours] == ["display_data"]
            assert ours == stock
        counted = notebook.run_cell(
            "from autograder.sandbox.guest.figures import MIME\n"
            "shower = get_ipython().display_formatter.ipython_display_formatter.lookup_by_type(go.Figure).__self__\n"
            "from autograder.sandbox.guest.recorder import bundled\n"
            "stock = [dict(bundled(pio.renderers._build_mime_bundle(one.to_dict(), 'plotly_mimetype'))) for one in figures]\n"
            "def text(one):\n    try:\n        return shower.text(one)\n    except Exception:\n        return None\n"
            "print([text(one) == by_plotly[MIME] for one, by_plotly in zip(figures, stock)])"
        )
    assert counted.outputs[0]["text"] == ("[True, True, True, False, True, False, False, False, False, False, True, True]\n"), (
        "integers, NaN, the blank, and arrays in lists and in what is not converted are left to plotly"
    )


def test_nbformat_is_loaded_by_who_imports_it():
    """plotly has been told its version, and shows figures by it; that is all that was left of it."""
    with Sandbox(Policy()) as box, box.open() as notebook:
        before = notebook.run_cell("import sys\nprint('nbformat' in sys.modules, 'jsonschema' in sys.modules)")
        assert before.outputs[0]["text"] == "False False\n"
        told = notebook.run_cell("import plotly.io._renderers as r\nprint(r.nbformat.__version__)").outputs[0]["text"]
        real = notebook.run_cell("import nbformat\nprint(nbformat.__version__, nbformat.v4.new_notebook().nbformat)")
        assert real.outputs[0]["text"] == f"{told.strip()} 4\n"
    with Sandbox(Policy(packages=("numpy", "plotly"))) as box, box.open() as notebook:
        shown = notebook.run_cell("import plotly.graph_objects as go\ngo.Figure(go.Scatter(y=[1]))")
        assert "application/vnd.plotly.v1+json" in shown.outputs[0]["data"]


def test_what_a_notebook_changes_in_plotly_holds():
    with Sandbox(Policy()) as box, box.open() as notebook:
        notebook.run_cell("import plotly.graph_objects as go, plotly.io as pio\nfigure = go.Figure(go.Scatter(y=[1]))")
        notebook.run_cell("pio.renderers.default = 'json'")
        assert list(notebook.run_cell("figure").outputs[0]["data"]) == ["application/json"]
        notebook.run_cell(
            "pio.renderers.default = 'plotly_mimetype'\npio.renderers['plotly_mimetype'].config = {'scrollZoom': True}"
        )
        (shown,) = notebook.run_cell("figure").outputs
        assert shown["data"]["application/vnd.plotly.v1+json"]["config"]["scrollZoom"] is True
        captured = "from IPython.utils.capture import capture_output\nwith capture_output() as found:\n    display(figure)"
        assert notebook.run_cell(f"{captured}\nlen(found.outputs)").outputs[0]["data"]["text/plain"] == "1"
        notebook.run_cell("go.Figure._ipython_display_ = lambda self: print('mine')")
        assert notebook.run_cell("figure").outputs[0]["text"] == "mine\n"


def test_plotly_copies_plain_data_quickly_and_as_ever():
    array = np.arange(6.0).reshape(2, 3).T
    value = {"a": [1, {"b": array, (1, 2): (3, [4])}], "c": None, "d": {"e": "f"}}
    copy = figures.copied(value)
    assert repr(copy) == repr(value)
    assert copy["a"] is not value["a"]
    assert copy["a"][1]["b"] is not array
    assert copy["a"][1][1, 2][1] is not value["a"][1][1, 2][1]
    value["a"].append(value)
    assert figures.copied(value)["a"][2]["c"] is None
    with Sandbox(Policy()) as box, box.open() as notebook:
        result = notebook.run_cell("import plotly.basedatatypes as b, copy\nb.deepcopy is not copy.deepcopy")
    assert result.outputs[0]["data"]["text/plain"] == "True"


WRONG = [
    "go.Scatter(nonsense=1)",
    "go.Scatter(y=3)",
    "go.Scatter(line={'color': 'no colour'})",
    "go.Figure(layout={'xaxis': {'rang': [0, 1]}})",
    "go.Figure({'type': 'surface', 'z': [[1]], 'cmin': 'a'}).update_layout(scene_camera_eye_q=1)",
    "go.Figure().update_layout(scene_camera_eye_q=1, xaxis3_title='a')",
    "go.Figure().layout['xaxis']['nonsense']",
    "go.Figure().layout.xaxis.range = 'a'",
    "go.Scatter()[['x']]",
]


def test_plotly_finds_its_validators_quickly_and_as_ever():
    """What is wrong is told in the same words, by the same lines; plotly's own way is put back in the middle."""
    with Sandbox(Policy()) as box, box.open() as notebook:
        notebook.run_cell("import plotly.graph_objects as go\nfrom plotly.basedatatypes import BasePlotlyType as kind")
        swapped = notebook.run_cell("stock = kind._get_validator.__wrapped__\nfigure = go.Figure(go.Scatter3d(x=[1]))")
        assert swapped.status == "ok"
        said = []
        for _ in range(2):
            results = [notebook.run_cell(source) for source in WRONG]
            assert {result.status for result in results} == {"error"}
            said.append([re.sub(r"In\[\d+\]|ipython-input-\d+", "In", str(result.outputs)) for result in results])
            same = notebook.run_cell("print(all(find(figure.layout, name) is kind._get_validator(figure.layout, name)"
                " for find in [stock] for name in figure.layout))")  # fmt: skip
            assert same.outputs[0]["text"] == "True\n"
            notebook.run_cell("kind._get_validator = stock")
    assert said[0] == said[1]


def test_who_watches_a_trait_that_changes_with_every_cell_is_told(sandbox):
    with sandbox.open() as notebook:
        cells = (
            "import traitlets\nshell, seen = get_ipython(), []\nshell.observe(seen.append, 'execution_count')",
            "shell.displayhook.observe(seen.append)",
            "with shell.hold_trait_notifications():\n    shell.last_execution_succeeded = False\n    held = len(seen)",
            "5",
            "print(sorted({one.name for one in seen}), [one.new for one in seen if one.name == 'execution_count'], held)",
            "shell.execution_count = 'a word'",
        )
        *_, told, refused = [notebook.run_cell(cell) for cell in cells]
    assert told.outputs[0]["text"] == "['exec_result', 'execution_count'] [3, 4, 5, 6] 4\n"
    assert refused.outputs[0]["evalue"].startswith("The 'execution_count' trait of a Shell instance expected an int")
