"""check in IPython: cards are displayed, figures follow, and a cell that failed is remembered."""

import nbformat
import pytest

SLIP = "def cylinder(u, w, r, h):\n    x = r * np.cos(2 * np.pi * u\n    return x"


def test_the_card_and_the_figure_are_displayed(notebook, right):
    """HTML with text, then plotly JSON with text; the value of the cell is the points."""
    notebook.run(right)
    result = notebook.run("check(cylinder)")
    assert [sorted(bundle) for bundle in result.bundles] == [
        ["text/html", "text/plain"],
        ["application/vnd.plotly.v1+json", "text/plain"],
    ]
    assert result.result == 4.0


def test_a_syntax_slip_above_is_told_instead_of_a_name_error(notebook):
    """The line, the reason and a hint; the error output is one line."""
    slip = notebook.run(SLIP)
    assert slip.error_before_exec is not None
    result = notebook.run("check(cylinder)")
    assert len(result.cards) == 1
    assert "The cell that should define cylinder stopped: SyntaxError: '(' was never closed" in result.cards[0]
    assert "Line 2 of that cell: x = r * np.cos(2 * np.pi * u" in result.cards[0]
    assert "2 times ( and 1 times )" in result.cards[0]
    assert result.errors == [
        (
            "CheckFailed",
            "cylinder is not defined; see the card above.",
            "CheckFailed: cylinder is not defined; see the card above.",
        )
    ]
    assert not result.success


@pytest.mark.parametrize(
    ("cell", "said"),
    [
        ("def cylinder(u, w, r, h)\n    return 0", "Line 1 of that cell: def cylinder(u, w, r, h)"),
        ("def cylinder(u, w, r, h):\nreturn 0", "Lines of one block begin at the same column"),
        (
            "import nowhere_at_all\ndef cylinder(u, w, r, h):\n    return 0",
            "ModuleNotFoundError: No module named 'nowhere_at_all'",
        ),
    ],
)
def test_other_ways_in_which_the_cell_above_stops(notebook, cell, said):
    """A missing colon, an indentation, an import that fails before the def is reached."""
    notebook.run(cell)
    card = notebook.run("check(cylinder)").cards[0]
    assert said in card
    assert card.startswith("[○ Nothing to judge yet] cylinder is not defined")


def test_a_cell_that_was_not_run_is_asked_for(notebook):
    """Nothing failed: the definition has not been run, or the kernel was restarted."""
    card = notebook.run("check(cylinder)").cards[0]
    assert "Run the cell that begins with def cylinder(u, w, r, h): first" in card
    assert "After a restart of the kernel" in card


def test_a_misspelt_definition_is_found(notebook, right):
    """The name in the notebook and the name of the task, side by side."""
    notebook.run(right.replace("cylinder", "cylnder"))
    assert "You have defined cylnder; the task wants def cylinder(u, w, r, h):" in notebook.run("check(cylinder)").cards[0]
    notebook.run(right)
    assert "Is the name written as in the task? There is an exercise cylinder" in notebook.run("check(cylindr)").cards[0]


def test_a_call_inside_check_is_helped_as_well(notebook):
    """check(cylinder(...)) without the function."""
    assert notebook.run("check(cylinder(0, 0, 1, 1))").cards[0].startswith("[○ Nothing to judge yet] cylinder is not defined")


def test_an_older_version_is_judged_with_a_warning(notebook, right):
    """After a slip the function of before still stands in memory: what is judged is not what is seen."""
    notebook.run(right)
    notebook.run(SLIP)
    result = notebook.run("check(cylinder)")
    assert "Careful: The newest cell that defines cylinder stopped (SyntaxError, line 2)" in result.cards[0]
    notebook.run(right)
    assert "Careful" not in notebook.run("check(cylinder)").cards[0]


@pytest.mark.parametrize(
    "cell", ["undefined_name + 1", "check(1 / 0)", "def f():\n    return undefined_name\nf()", "print(cylinder)"]
)
def test_other_errors_are_shown_as_ever(notebook, cell):
    """Only check(name) is looked at."""
    result = notebook.run(cell)
    assert result.cards == []
    assert [name for name, *_ in result.errors] == ["ZeroDivisionError" if "/" in cell else "NameError"]
    assert "Traceback" in result.errors[0][2]


def test_a_name_missing_inside_the_function_is_a_verdict(notebook):
    """The learner's NameError in a call of the judge stays inside it."""
    notebook.run("def cylinder(u, w, r, h):\n    return undefined_name")
    result = notebook.run("check(cylinder)")
    assert "undefined_name" in result.cards[0]
    assert "Line 2: return undefined_name" in result.cards[0]
    assert result.errors[0][0] == "CheckFailed"


def test_displays_inside_the_function_are_dropped(notebook, right):
    """The judge calls it many times; a picture in each call would bury the card."""
    notebook.run(right.replace("    return", "    from IPython.display import display; display('a picture')\n    return"))
    result = notebook.run("check(cylinder)")
    assert len(result.bundles) == 2
    assert notebook.run("display('a picture')").bundles[0]["text/plain"] == "'a picture'"


def test_in_a_kernel_nothing_reaches_stderr(tmp_path, right):
    """The whole way through a real kernel: outputs as nbgrader reads them."""
    from nbclient import NotebookClient

    cells = [
        "import numpy as np\nfrom autograder import check",
        right.replace("    return", "    print('x'); np.log(np.zeros(1))\n    return"),
        "check(cylinder)",
        "check('cylinder')",
    ]
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
    NotebookClient(book, allow_errors=True, timeout=120, resources={"metadata": {"path": str(tmp_path)}}).execute()
    checked, misused = book.cells[2].outputs, book.cells[3].outputs
    assert [output.output_type for output in checked] == ["display_data", "display_data", "execute_result"]
    assert checked[2].data["text/plain"] == "4.0"
    assert [output.output_type for output in misused] == ["display_data", "error"]
    assert misused[1].ename == "CheckFailed"
    assert len(misused[1].traceback) == 1
    nbformat.validate(book)
