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


def test_plotly_takes_arrays_as_they_are():
    with Sandbox(Policy()) as box, box.open() as notebook:
        result = notebook.run_cell(
            "import numpy, _plotly_utils.basevalidators as used, narwhals.stable.v1 as stock\n"
            "array = numpy.zeros(2)\n"
            "print(used.nw.from_native is not stock.from_native, used.nw.from_native(array, pass_through=True) is array)"
        )
    assert result.status == "ok", result.outputs
    assert result.outputs[0]["text"] == "True True\n"
