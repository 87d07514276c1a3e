"""Real notebooks, damaged where it might hurt: whatever comes, a valid notebook with the instructor's cells, or a refusal.

Mutations know the form of a notebook: a value is taken out, doubled, moved to where another belongs, or replaced by one that
lies near it (a text for a list, a list of texts for a text, a huge number, a lone surrogate); then some bytes are damaged too.
"""

import contextlib
import copy
import json
import tracemalloc

import nbformat
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from autograder.errors import SubmissionError
from autograder.fleet import Course
from autograder.notebook import safe
from autograder.notebook.rebuild import rebuild
from autograder.notebook.submission import parse
from autograder.notebook.written import FIGURE, dumps

MIMES = {*safe.TEXTS, *safe.IMAGES, "text/html", "text/markdown", FIGURE}
PNG = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
OUTPUTS = [
    {"output_type": "stream", "name": "stdout", "text": ["one\n", "two"]},
    {
        "output_type": "execute_result",
        "execution_count": 3,
        "metadata": {},
        "data": {"text/plain": ["1"], "text/html": "<b>1</b>"},
    },
    {
        "output_type": "display_data",
        "metadata": {"x": 1},
        "data": {"image/png": PNG, FIGURE: {"data": [{"x": [1]}], "layout": {}}},
    },
    {"output_type": "error", "ename": "E", "evalue": "e", "traceback": ["\x1b[31ma", "b"]},
]
ODD = [
    None, True, 0, -1, 2**70, 1.5, float("nan"), float("inf"), "", "x", "\ud800", "\x00", "code", "markdown", "a" * 5000, [],
    {}, ["a", 1, None], [[]], {"a": {"b": []}}, "<script>stored()</script>", ["<img src=x onerror=stored()>"], "test_square",
    "square", {"text/html": "<iframe src=x>"}, {"application/javascript": "stored()"}, "javascript:stored()",
    {"nbgrader": {"grade": True}},
]  # fmt: skip


@pytest.fixture(scope="module")
def real(ordinary_template):
    """A released notebook as somebody might hand it in, with outputs and a picture; and the instructor's copy."""
    course = Course(ordinary_template)
    with course.gradebook() as book:
        master = course.masters(book.assignment("ps1"))["one"]
    notebook = json.loads((ordinary_template / "release" / "ps1" / "one.ipynb").read_text())
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            cell["outputs"] = copy.deepcopy(OUTPUTS)
        else:
            cell["attachments"] = {"p.png": {"image/png": PNG}}
    return notebook, master


def places(value, here=()):
    """The path to every value in a tree."""
    found = [here] if here else []
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, part in items:
        found += places(part, (*here, key))
    return found


def at(tree, path):
    for key in path:
        tree = tree[key]
    return tree


def mutate(tree, data):
    """One damage somewhere in a tree, in place."""
    paths = places(tree)
    path = paths[data.draw(st.integers(0, len(paths) - 1))]
    holder, key = at(tree, path[:-1]), path[-1]
    how = data.draw(st.sampled_from(["replace", "remove", "double", "swap", "wrap", "rename"]))
    if how == "replace":
        holder[key] = copy.deepcopy(data.draw(st.sampled_from(ODD)))
    elif how == "remove":
        del holder[key]
    elif how == "double" and isinstance(holder, list):
        holder.insert(key, copy.deepcopy(holder[key]))
    elif how == "swap":
        holder[key] = copy.deepcopy(at(tree, paths[data.draw(st.integers(0, len(paths) - 1))]))
    elif how == "wrap":
        holder[key] = data.draw(st.sampled_from([lambda v: [v], lambda v: {"x": v}, str]))(holder[key])
    elif isinstance(holder, dict):
        holder[data.draw(st.sampled_from(["source", "metadata", "\ud800", "", "nbgrader", "data"]))] = holder.pop(key)


def held(raw, master, **options):
    """What the trusted side makes of these bytes, held to all that it promises; None if they are refused."""
    try:
        built = rebuild(parse(raw), master, **options)
    except SubmissionError:
        return None
    written = dumps(built.notebook)
    read = nbformat.reads(written.decode("utf-8"), as_version=nbformat.NO_CONVERT)
    nbformat.validate(read)
    assert (read.nbformat, read.nbformat_minor) == (4, 5)
    assert "\ud800" not in written.decode("utf-8")
    for cell, mine in zip(read.cells, built.masters, strict=True):
        assert "tags" not in cell.metadata
        if mine is not None:
            assert cell.cell_type == mine.cell_type
            assert dict(cell.metadata.nbgrader) == mine.metadata
            assert not mine.locked or options.get("add_missing") or cell.source == mine.source
        else:
            assert "nbgrader" not in cell.metadata
        if cell.cell_type == "markdown" and (mine is None or not mine.locked):
            assert "<script" not in cell.source
            assert "<img" not in cell.source
        for output in cell.get("outputs", []):
            assert set(output.get("data", {})) <= MIMES
            shown = output.get("data", {}).get("text/html", "")
            assert "<script" not in shown
            assert "onerror" not in shown
    names = [mine.name for mine in built.masters if mine is not None]
    assert len(names) == len(set(names))
    return built


@settings(max_examples=250)
@given(data=st.data())
def test_a_damaged_notebook_is_a_valid_one_or_is_refused(real, data):
    notebook, master = copy.deepcopy(real[0]), real[1]
    for _ in range(data.draw(st.integers(1, 5))):
        mutate(notebook, data)
        if not notebook:
            break
    options = {"keep_outputs": data.draw(st.booleans()), "add_missing": data.draw(st.booleans())}
    held(json.dumps(notebook).encode(), master, **options)


@settings(max_examples=120)
@given(data=st.data())
def test_damaged_bytes_of_a_notebook_are_a_valid_one_or_are_refused(real, data):
    raw = bytearray(json.dumps(real[0]).encode(data.draw(st.sampled_from(["utf-8", "utf-8", "utf-16", "utf-8-sig"]))))
    for _ in range(data.draw(st.integers(1, 4))):
        where = data.draw(st.integers(0, max(0, len(raw) - 1)))
        piece = data.draw(
            st.sampled_from([b"", b"\xff", b"\x00", b'"', b"{", b"]", b"\\ud800", b"1e999", b"9" * 5000, b"[" * 2000])
        )
        raw[where : where + data.draw(st.integers(0, 3))] = piece
    held(bytes(raw), real[1], keep_outputs=True)


def test_the_undamaged_notebook_passes_whole(real):
    """Else the mutations would begin with what is refused anyway."""
    built = held(json.dumps(real[0]).encode(), real[1], keep_outputs=True)
    assert {mine.name for mine in built.masters if mine is not None} == set(real[1].cells)
    assert sum(len(cell.get("outputs", [])) for cell in built.cells) > 0


WIDE = {
    "very many cells": lambda nb: nb["cells"].extend([{"cell_type": "code"}] * 100_000),
    "very many outputs": lambda nb: nb["cells"][1].update(outputs=[OUTPUTS[0]] * 100_000),
    "a million lines": lambda nb: nb["cells"][1].update(source=["x\n"] * 1_000_000),
    "a wide bundle": lambda nb: nb["cells"][1].update(
        outputs=[{**OUTPUTS[1], "data": {f"x/{n}": "y" for n in range(200_000)}}]
    ),
    "a deep figure": lambda nb: nb["cells"][1].update(outputs=[{**OUTPUTS[2], "data": {FIGURE: {"data": [deep(600)]}}}]),
    "many attachments": lambda nb: nb["cells"][0].update(attachments={f"{n}": {"image/png": PNG} for n in range(100_000)}),
}


def deep(levels):
    value = {}
    for _ in range(levels):
        value = {"x": value}
    return value


@pytest.mark.parametrize("name", WIDE)
def test_memory_and_the_written_notebook_stay_in_proportion(real, name):
    """Beyond what reading the JSON itself takes, a small multiple of the file; the written notebook is never much larger."""
    notebook = copy.deepcopy(real[0])
    WIDE[name](notebook)
    raw = json.dumps(notebook).encode()
    with contextlib.suppress(SubmissionError):
        parsed = parse(raw)
        tracemalloc.start()
        try:
            written = dumps(rebuild(parsed, real[1], keep_outputs=True).notebook)
            peak = tracemalloc.get_traced_memory()[1]
        finally:
            tracemalloc.stop()
        assert peak < 20 * len(raw) + 20_000_000
        assert len(written) < 3 * len(raw) + 100_000
