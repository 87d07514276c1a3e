"""Awkward cells show what nbclient and a Jupyter kernel show for them, but for a listed few, each with its reason."""

import asyncio
import re
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

from autograder.sandbox import Limits, Policy, Sandbox
from tests.autograder.sandbox.awkward_cells import DIFFERENT, GROUPS, OTHER_LINES

ROOT = Path(__file__).resolve().parents[3]
CELLS = [(group, name) for group, cells in GROUPS.items() for name in cells]
MASKS = (
    (r"0x[0-9a-f]+", "ADDRESS"),
    (r"\d+(\.\d+)?(e\+\d+)? ([µμn]?s|ms)\b", "TIME"),
    (r"(/tmp/ipykernel_\d+/)?\d+\.py|<ipython-input-[^>]*>", "CELL"),
    (r"(~|/)[^\s'\"]*/IPython/", "IPYTHON/"),
    (r"(~|/)[^\s'\"]*/lib/python3\.\d+/", "LIBRARY/"),
    (r"Thread-\d+", "THREAD"),
)


def masked(text):
    for pattern, name in MASKS:
        text = re.sub(pattern, name, text)
    return text


def joined(outputs):
    """Outputs with printed text in one piece: on a busy machine a kernel sends in two what was printed at once."""
    made = []
    for output in map(dict, outputs):
        if made and output["output_type"] == made[-1]["output_type"] == "stream" and output["name"] == made[-1]["name"]:
            made[-1]["text"] += output["text"]
        else:
            made.append(output)
    return made


COLOURS = re.compile(r"\x1b\[[0-9;]*m")


def simplified(outputs, lines=True):
    """Outputs without addresses, times, paths and colours; with ``lines`` false also without the lines around an error."""
    found = []
    for output in joined(outputs):
        if output["output_type"] == "error":
            shown = COLOURS.sub("", "\n".join(output["traceback"])).splitlines()
            if not lines:
                shown = [re.sub(r", line \d+", "", line) for line in shown if not re.match(r"(-+>|\s)*\d+( |$)", line)]
                shown = [line for line in shown if not line.startswith("Cell In")] + sorted(
                    {line for line in shown if line.startswith("Cell In")}
                )
            output["traceback"] = shown
        elif output.get("name") == "stderr":  # since Python 3.13 a thread's traceback is coloured in a kernel
            output["text"] = COLOURS.sub("", output["text"])
        output["metadata"] = {kind: about for kind, about in output.get("metadata", {}).items() if kind.startswith("image/")}
        found.append(masked(repr(sorted(output.items()))))
    return found


@pytest.fixture(scope="session")
def kernels(tmp_path_factory):
    """Each group in a kernel of its own, all at once."""
    notebooks = {}
    for group, cells in GROUPS.items():
        sources = [nbformat.v4.new_code_cell(source) for source in cells.values()]
        notebooks[group] = nbformat.v4.new_notebook(cells=sources)

    async def run():
        clients = [
            NotebookClient(
                notebook, timeout=120, allow_errors=True, kernel_name="python3",
                resources={"metadata": {"path": str(tmp_path_factory.mktemp(group))}},
            )
            for group, notebook in notebooks.items()
        ]  # fmt: skip
        await asyncio.gather(*(client.async_execute() for client in clients))

    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("PYTEST_CURRENT_TEST", raising=False)  # a kernel that finds it leaves what C code prints alone
        asyncio.run(run())
    return {
        (group, name): cell for group, cells in GROUPS.items() for name, cell in zip(cells, notebooks[group].cells, strict=True)
    }


@pytest.fixture(scope="session")
def ours():
    """Each group in a session of its own. Compared when all have run, since a cell may update displays of another."""
    found = {}
    with Sandbox(Policy(packages="all", preload=())) as box:
        for group, cells in GROUPS.items():
            with box.open(limits=Limits(notebook_cpu=300)) as session:
                found |= {(group, name): session.run_cell(source) for name, source in cells.items()}
                assert session.alive, session.ended
    return found


@pytest.mark.parametrize(("group", "name"), CELLS, ids=[name for _, name in CELLS])
def test_the_outputs_are_those_of_a_kernel(kernels, ours, group, name):
    """A listed difference must be one: a reason that has become idle fails too."""
    theirs, mine = kernels[group, name], ours[group, name]
    assert mine.execution_count == theirs.execution_count or not theirs.source
    same = simplified(mine.outputs) == simplified(theirs.outputs)
    if name in DIFFERENT:
        assert not same, f"equal, but a difference is listed: {DIFFERENT[name]}"
    elif name in OTHER_LINES:
        assert not same, f"equal, but a difference is listed: {OTHER_LINES[name]}"
        assert simplified(mine.outputs, lines=False) == simplified(theirs.outputs, lines=False)
    else:
        assert simplified(mine.outputs) == simplified(theirs.outputs)


def test_the_table_is_whole():
    """Names are told once, and every listed difference is one of a cell that is there; there are 58 cells and more."""
    names = [name for _, name in CELLS]
    assert len(set(names)) == len(names) >= 58
    assert set(DIFFERENT) | set(OTHER_LINES) <= set(names)
    assert not set(DIFFERENT) & set(OTHER_LINES)


def test_the_page_lists_the_differences():
    page = (ROOT / "docs" / "nbgrader.md").read_text("utf-8")
    table = page.split("<!-- cells: begin -->")[1].split("<!-- cells: end -->")[0]
    rows = [line for line in table.splitlines() if line.startswith("| ")][1:]
    listed = {**DIFFERENT, **{name: f"other lines: {reason}" for name, reason in OTHER_LINES.items()}}
    assert rows == [f"| `{name}` | {reason} |" for name, reason in listed.items()]
    assert f"{len(CELLS)} awkward cells" in page
    assert f"{len(CELLS) - len(listed)} show the same" in page


def test_our_outputs_are_valid_notebook_outputs(ours):
    for group, cells in GROUPS.items():
        sources = [
            nbformat.v4.new_code_cell(
                source, outputs=ours[group, name].outputs, execution_count=ours[group, name].execution_count
            )
            for name, source in cells.items()
        ]
        nbformat.validate(nbformat.v4.new_notebook(cells=sources))
