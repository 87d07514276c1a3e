"""Cells show what a Jupyter kernel shows for them. The kernel itself is the oracle."""

import re

import nbformat
import pytest
from nbclient import NotebookClient

from autograder.sandbox import Limits

SAME_AS_A_KERNEL = [
    "x = 20\nx + 1",
    "print('a'); print('b', end='')",
    "from IPython.display import display, HTML, Markdown, Math, Image\ndisplay(HTML('<b>x</b>'))\nprint('after')\n'result'",
    "display(Markdown('*m*'), Math('x^2')); display({'a': 1})",
    "5;",
    "None",
    "_ + '!' if isinstance(_, str) else _",
    "handle = display('first', display_id='one'); print('between'); handle.update('second')",
    "handle.update('third')\nprint('elsewhere')",
    "from IPython.display import clear_output\nprint('gone'); clear_output(); print('stays')",
    "print('gone'); clear_output(wait=True); display(1)",
    "import asyncio\nawait asyncio.sleep(0)\n'awaited'",
    "async def f():\n    return 7\nawait f()",
    "task = asyncio.get_running_loop().create_task(f())\nawait task",
    "def broken():\n    return 1 / 0\nbroken()",
    "try:\n    broken()\nexcept ZeroDivisionError as error:\n    raise KeyError('inner') from error",
    "raise SystemExit(3)",
    "undefined",
    "for i in range(3)\n    pass",
    "%%capture held\nprint('held')",
    "held.stdout",
    "%unknown_magic",
    "%%time\nvalue = 1",
    "class Rich:\n    def _repr_html_(self): return '<i>r</i>'\n    def __repr__(self): return 'rich'\nRich()",
    "class Bad:\n    def __repr__(self): raise ValueError('bad repr')\nBad()",
    "import warnings; warnings.warn('careful')",
    "import sys; sys.stderr.write('oops\\n'); None",
    "Image(data=bytes.fromhex('89504e470d0a1a0a') + b'123', format='png', width=3, height=4)",
    "import numpy as np\nnp.arange(6.0).reshape(2, 3)",
    "In[2], Out[1]",
    "get_ipython().run_line_magic('precision', '3')\n3.14159",
    "import nothing_of_that_name",
    "assert 1 == 2, 'not equal'",
    "raise type('Odd', (Exception,), {'__str__': lambda self: 'odd'})()",
    "[i for i in range(3)]\n",
    "# only a comment",
    "",
]  # fmt: skip


# Tracebacks that differ in which lines around the error are shown (a kernel takes them from its debugger's frames), and the
# names that cells' files have in warnings and syntax errors.
OTHER_LINES = ("raise KeyError('inner') from error", "bad repr")


def simplified(outputs, lines=True):
    """Addresses, times and file names of cells masked; colours and metadata of no interest left out."""
    text = []
    for output in outputs:
        output = dict(output)
        if output.get("output_type") == "error":
            shown = re.sub(r"\x1b\[[0-9;]*m", "", "\n".join(output["traceback"]))
            output["traceback"] = shown if lines else shown.splitlines()[-1]
        output["metadata"] = {key: value for key, value in output.get("metadata", {}).items() if key.startswith("image/")}
        masked = re.sub(r"0x[0-9a-f]+", "0x", repr(sorted(output.items())))
        masked = re.sub(r"(/tmp/ipykernel_\d+/)?\d+\.py|<ipython-input-[^>]*>|/\S*/IPython/", "CELL", masked)
        text.append(re.sub(r"\d+(\.\d+)?(e\+\d+)? ([µμn]?s|ms)\b", "TIME", masked))
    return text


@pytest.fixture(scope="module")
def kernel(tmp_path_factory):
    """All cells in a real kernel."""
    cells = [nbformat.v4.new_code_cell(source) for source in SAME_AS_A_KERNEL]
    notebook = nbformat.v4.new_notebook(cells=cells)
    NotebookClient(notebook, timeout=60, allow_errors=True, kernel_name="python3").execute(
        cwd=str(tmp_path_factory.mktemp("kernel"))
    )
    return notebook.cells


@pytest.fixture(scope="module")
def ours(sandbox):
    """All cells in one session."""
    with sandbox.open() as session:
        return [session.run_cell(source) for source in SAME_AS_A_KERNEL]


@pytest.mark.parametrize(
    "number", range(len(SAME_AS_A_KERNEL)), ids=[source[:40].replace("\n", " ") for source in SAME_AS_A_KERNEL]
)
def test_the_outputs_are_those_of_a_kernel(kernel, ours, number):
    lines = not any(part in SAME_AS_A_KERNEL[number] for part in OTHER_LINES)
    assert simplified(ours[number].outputs, lines) == simplified(kernel[number].outputs, lines)


def test_outputs_are_valid_notebook_outputs(ours):
    cells = [
        nbformat.v4.new_code_cell(source, outputs=result.outputs, execution_count=result.execution_count)
        for source, result in zip(SAME_AS_A_KERNEL, ours, strict=True)
    ]
    nbformat.validate(nbformat.v4.new_notebook(cells=cells))


def test_streams_and_displays_keep_the_order_in_which_they_came(session):
    """A kernel would join the two pieces of stdout."""
    result = session.run_cell("import sys\nprint('1'); sys.stderr.write('2'); print('3'); display(4); print('5')")
    assert [output.get("text", output.get("data")) for output in result.outputs] == [
        "1\n",
        "2",
        "3\n",
        {"text/plain": "4"},
        "5\n",
    ]


def test_what_c_code_prints_is_shown(session):
    result = session.run_cell("import os; os.write(1, b'past Python'); None")
    assert result.outputs == [{"output_type": "stream", "name": "stdout", "text": "past Python"}]
    assert session.run_cell("pass").outputs == []


def test_input_has_nobody_to_ask(session):
    result = session.run_cell("input('name? ')")
    assert result.status == "error"
    assert "use a variable instead" in result.outputs[0]["evalue"]


def test_exit_and_help_do_no_harm(session):
    assert session.run_cell("exit()").status == "ok"
    assert session.run_cell("quit").status == "ok"
    assert session.run_cell("print?").status == "ok"
    assert session.run_cell("1 + 1").outputs[0]["data"] == {"text/plain": "2"}


def test_what_the_zygote_tried_out_left_no_trace(session):
    source = (
        "import sys\nhasattr(sys, 'last_value'), [name for name in globals() if name.startswith('_i') and globals()[name]], Out"
    )
    assert session.run_cell(source).outputs[0]["data"]["text/plain"].startswith("(False, ['_ih', '_i1'], {}")


def test_statuses(session):
    assert session.run_cell("1").status == "ok"
    assert session.run_cell("1 / 0").status == "error"
    assert session.run_cell("1 +").status == "error"
    assert session.run_cell("raise MemoryError").status == "memory"
    assert session.run_cell("1").execution_count == 5


def test_the_notebook_finds_its_files_and_modules(sandbox):
    files = {"data/points.csv": b"1,2", "helper.py": b"answer = 42"}
    with sandbox.open(files) as session:
        result = session.run_cell("import helper; open('data/points.csv').read(), helper.answer, __name__")
        assert result.outputs[0]["data"]["text/plain"] == "('1,2', 42, '__main__')"


def test_files_come_back_and_links_do_not(sandbox, tmp_path):
    (tmp_path / "given.txt").write_text("given")
    (tmp_path / "link").symlink_to("/etc/passwd")
    source = "import os\nopen('made.txt', 'w').write('made')\nos.makedirs('a/b'); open('a/b/c', 'w').write('c')\n"
    source += "os.symlink('/etc/passwd', 'l'); os.symlink('made.txt', 'm'); os.remove('given.txt')\n"
    source += "open('bad\\nname', 'w'); open('tab\\\\', 'w')"
    with sandbox.open(tmp_path) as session:
        assert session.files() == {"given.txt": b"given"}
        assert session.run_cell(source).status == "ok"
        assert session.files() == {"made.txt": b"made", "a/b/c": b"c"}


def test_environment_and_seed_are_the_callers(sandbox):
    draws = []
    for seed in (1, 1, 2):
        with sandbox.open(environment={"NBGRADER_EXECUTION": "autograde"}, seed=seed) as session:
            text = session.run_cell(
                "import os, random, numpy\nprint(os.environ['NBGRADER_EXECUTION'], random.random(), numpy.random.rand())"
            )
            draws.append(text.outputs[0]["text"])
    assert draws[0].startswith("autograde ")
    assert draws[0] == draws[1] != draws[2]


def test_the_grader_environment_is_not_there(sandbox, monkeypatch):
    with sandbox.open() as session:
        names = session.run_cell("import os; sorted(os.environ)").outputs[0]["data"]["text/plain"]
    assert "PATH" in names
    assert "PYTEST_CURRENT_TEST" not in names


def test_a_limit_of_one_cell_can_be_set_apart(session):
    quick = Limits(cell_cpu=0.2, patience=1)
    assert session.run_cell("while True: pass", limits=quick).note.startswith("this cell was stopped: it may compute for 0.2 s")
