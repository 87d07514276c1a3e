"""What cells show, and how they end. What a kernel would show is in test_awkward.py."""

import ast

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from IPython.core.inputtransformer2 import TransformerManager

from autograder.sandbox import Limits, Policy, Sandbox
from autograder.sandbox.guest import reading

PIECES = (
    *(
        "a",
        "f",
        " ",
        "\n",
        "    ",
        "\t",
        "\\\n",
        "=",
        "==",
        "!",
        "%",
        "%%",
        "?",
        "??",
        ",",
        ";",
        "/",
        "(",
        ")",
        "[",
        "]",
        "{",
        "}",
    ),
    *(
        "'",
        '"',
        '"""',
        "#",
        "!=",
        "a = ",
        "a=%ls",
        "!ls",
        "if a:\n",
        "def f():\n",
        "f'{a!r}'",
        "\r",
        "\f",
        "\u2028",
        "\xa0",
        "1",
    ),
)


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


@pytest.mark.filterwarnings("ignore:`make_tokens_by_line`:UserWarning")  # IPython on a line that ends in a rare separator
@settings(deadline=None)
@given(st.lists(st.sampled_from(PIECES), max_size=12).map("".join))
def test_a_cell_without_ipythons_syntax_is_left_alone_by_ipython(source):
    """The quick look may send a cell through IPython's transformations for nothing; it may not keep one from them."""
    assert transformed(reading.Plainly(), source) == transformed(TransformerManager(), source)


def transformed(manager, source):
    try:
        return manager.transform_cell(source)
    except Exception as error:  # lines that are indented in no order, and what IPython does not foresee
        return repr(error)


@pytest.mark.parametrize(
    "source", ["a = 7 % 4", "f'{a!r}'", "a != b", "'why?'.strip()", "# so\nx = '%d' % 5", "await f(1,\n 2)"]
)
def test_plain_python_is_seen_to_be_plain(source, monkeypatch):
    monkeypatch.setattr(TransformerManager, "do_token_transforms", lambda self, lines: ["taken apart"])
    assert reading.Plainly().transform_cell(source) == source + "\n"
    assert reading.Plainly().transform_cell(source + "\n%time 1") == "taken apart"


FIGURE = """
import numpy as np, plotly.graph_objects as go
go.Figure([
    go.Scatter3d(x=np.arange(3), y=np.float32([1, np.nan, 2]), z=np.array(["a", 2, None], object), text=np.array(["p", "q"])),
    go.Surface(z=np.eye(3)[:, ::2], customdata=np.ones((3, 2, 2), bool), surfacecolor=np.ma.masked_less(np.eye(3), 0.5)),
    go.Scatter(x=np.array(["2000-01-01"], "M8[D]"), y=[1], marker={"color": np.uint8([7])}),
]).to_json()
"""


def test_arrays_are_drawn_as_plotly_draws_them_elsewhere():
    with Sandbox(Policy(packages=("numpy", "plotly"))) as box, box.open() as session:
        direct = (
            "import _plotly_utils.basevalidators as b, narwhals\nb.nw is narwhals, b.nw.from_native([1], pass_through=True)"
        )
        assert session.run_cell(direct).outputs[0]["data"]["text/plain"] == "(False, [1])"
        inside = ast.literal_eval(session.run_cell(FIGURE).outputs[0]["data"]["text/plain"])
    *setting, last = ast.parse(FIGURE).body
    namespace: dict = {}
    exec(compile(ast.Module(setting, []), "figure", "exec"), namespace)
    assert inside == eval(compile(ast.Expression(last.value), "figure", "eval"), namespace)
