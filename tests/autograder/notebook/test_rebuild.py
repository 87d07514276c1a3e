"""The graded notebook: the instructor's cells, the learner's sources, and nothing else of the submission."""

import json

import nbformat
import pytest

from autograder.errors import SubmissionError
from autograder.notebook.limit import ignore_stderr, limit_outputs
from autograder.notebook.master import Master, MasterCell, checked_name, checksum
from autograder.notebook.rebuild import rebuild
from autograder.notebook.secret import course_secret, hidden_seed
from autograder.notebook.written import dumps

PNG = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
TEST = MasterCell("t", "code", "assert f(1)  # hidden", checksum="a" * 32, locked=True, grade=True, points=2.0)
TASK = MasterCell("f", "code", "def f(x): ...", checksum="b" * 32, solution=True)
WHY = MasterCell("why", "markdown", "<b>Why?</b>", grade=True, solution=True, points=3.0)
WHY = MasterCell(**{**vars(WHY), "checksum": checksum("markdown", "<b>Why?</b>", WHY)})
MASTER = Master("nb", {cell.name: cell for cell in (TASK, TEST, WHY)}, {"name": "python3", "display_name": "Python 3"})


def cell(source, name=None, kind="code", **more):
    meta = more.pop("metadata", {})
    if name:
        meta = {**meta, "nbgrader": {"grade_id": name, "grade": False, "points": 99}}
    return {"cell_type": kind, "source": source, "metadata": meta, **more}


def built(*cells, master=MASTER, **options):
    made = rebuild({"cells": list(cells), "metadata": {"kernelspec": {"name": "evil"}, "widgets": {}}}, master, **options)
    nbformat.validate(nbformat.from_dict(made.notebook))
    return made


def test_locked_sources_flags_points_and_types_are_the_instructors():
    made = built(cell("pass", "t", kind="markdown"), cell("def f(x): return 1", "f"))
    test, task = made.cells
    assert (test["cell_type"], test["source"]) == ("code", TEST.source)
    assert test["metadata"] == {"nbgrader": TEST.metadata}
    assert test["metadata"]["nbgrader"]["points"] == 2.0
    assert task["source"] == "def f(x): return 1"
    assert made.notebook["metadata"]["kernelspec"]["name"] == "python3"
    assert "widgets" not in made.notebook["metadata"]


def test_metadata_outputs_and_unknown_names_are_dropped():
    made = built(
        cell("1", "invented", metadata={"tags": ["skip-execution"], "trusted": True}, outputs=[{"output_type": "error"}]),
        cell("2", "t", metadata={"tags": ["raises-exception"]}),
    )
    assert made.cells[0]["metadata"] == {}
    assert made.cells[0]["outputs"] == []
    assert "tags" not in made.cells[1]["metadata"]


def test_tags_and_pictures_of_the_instructors_file_are_kept(tmp_path):
    released = tmp_path / "nb.ipynb"
    picture = {"a.png": {"image/png": PNG}}
    released.write_text(json.dumps({"cells": [
        {"cell_type": "markdown", "source": ["# <i>Title</i>\n", "![](attachment:a.png)"], "metadata": {"tags": ["x"]},
         "attachments": picture},
        {"cell_type": "code", "source": TEST.source, "metadata": {"nbgrader": {"grade_id": "t"}, "tags": ["mine"]}},
    ]}))  # fmt: skip
    master = MASTER.beside(released)
    made = built(cell("# <i>Title</i>\n![](attachment:a.png)", kind="markdown"), cell("", "t"), master=master)
    assert made.cells[0]["attachments"] == picture
    assert made.cells[0]["source"].startswith("# <i>")
    assert made.cells[1]["metadata"]["tags"] == ["mine"]
    assert MASTER.beside(tmp_path / "nothing") == MASTER


def test_raw_html_of_learners_becomes_text_and_the_instructors_stays():
    made = built(
        cell("<script>alert(1)</script> a < b", kind="markdown"), cell("<b>Why?</b>", "why"), cell("<u>no</u>", kind="raw")
    )
    assert made.cells[0]["source"] == "&lt;script>alert(1)&lt;/script> a < b"
    assert made.cells[1]["source"] == "<b>Why?</b>"
    assert made.cells[2]["metadata"]["raw_mimetype"] == "text/plain"
    assert built(cell("<b>Because</b>", "why")).cells[0]["source"] == "&lt;b>Because&lt;/b>"


def test_pasted_pictures_stay_if_they_are_pictures():
    attached = {"a.png": {"image/png": PNG}, "b.svg": {"image/svg+xml": "<svg onload=x>"}, "c.png": {"image/png": "PHN2Zz4="}}
    made = built(cell("my sketch", "why", kind="markdown", attachments=attached))
    assert made.cells[0]["attachments"] == {"a.png": {"image/png": PNG}}


def test_the_last_of_duplicates_is_the_instructors_cell():
    made = built(cell("1", "f"), cell("2", "f"), cell("3", "f"))
    assert [mine is not None for mine in made.masters] == [False, False, True]
    assert [note.cell for note in made.notes if note.look] == ["f", "t", "why"]


def test_ids_are_valid_unique_and_the_same_every_time():
    cells = [cell("1", id="a b"), cell("2", id="same"), cell("3", id="same"), cell("4"), cell("5", id="cell-0")]
    ids = [made["id"] for made in built(*cells).cells]
    assert ids[1] == "same"
    assert ids[4] == "cell-0"
    assert len(set(ids)) == 5
    assert ids == [made["id"] for made in built(*cells).cells]


@pytest.mark.parametrize("junk", [7, None, "text", [], {"cell_type": "heading"}, {"cell_type": "code", "source": 7}])
def test_cells_that_are_none_are_left_out_and_the_others_stay(junk):
    made = built(junk, cell("x = 1"))
    assert made.cells[-1]["source"] == "x = 1"


def test_lone_surrogates_and_lists_of_lines_become_valid_text():
    made = built(cell(["a = '", "\ud800'"]), cell("x", metadata=7))
    assert made.cells[0]["source"] == "a = '\ufffd'"
    dumps(made.notebook)


def test_missing_cells_are_put_back_where_nbgrader_is_told_to():
    made = built(cell("def f(x): return 1", "f"), cell("end", kind="markdown"), add_missing=True)
    assert [mine.name if mine else None for mine in made.masters] == ["f", "t", "why", None]
    assert made.cells[1]["source"].startswith("# This cell (id:t) was missing")
    assert made.cells[1]["source"].endswith(TEST.source)


@pytest.mark.parametrize(
    ("kernel", "runs"),
    [
        ({}, True), ({"name": "python3"}, True), ({"name": "geo-env", "language": "python"}, True), ({"name": "ir"}, False),
        ({"name": "python3", "language": "R"}, False), ({"name": "ir", "display_name": "R", "language": "R"}, False),
    ],
)  # fmt: skip
def test_notebooks_of_other_languages_are_refused_and_not_marked_as_bad_python(kernel, runs):
    """Of the source notebook, and where it names none, of the submitted one."""
    for submitted, source in ((kernel, {}), ({"name": "python3"}, kernel)):
        nb = {"cells": [], "metadata": {"kernelspec": submitted} if submitted else {}}
        if runs:
            nbformat.validate(nbformat.from_dict(rebuild(nb, Master("nb", {}, source)).notebook))
        else:
            with pytest.raises(SubmissionError, match="only Python notebooks"):
                rebuild(nb, Master("nb", {}, source))


def test_a_kernel_that_cannot_be_is_refused():
    with pytest.raises(SubmissionError, match="kernel"):
        rebuild({"cells": [], "metadata": {"kernelspec": {"name": "a;b"}}}, Master("nb", {}))


@pytest.mark.parametrize(
    ("source", "name"),
    [
        ("check(cylinder)", "cylinder"), ("check(cylinder)  # now", "cylinder"), ("# first\ncheck(cylinder)\n", "cylinder"),
        ("check('cylinder')", None), ("check(cylinder, 1)", None), ("check(f=cylinder)", None), ("x = check(cylinder)", None),
        ("check(cylinder); check(cone)", None), ("a.check(cylinder)", None), ("check(cyl inder)", None), ("\0", None),
        ("", None),
    ],
)  # fmt: skip
def test_only_an_exact_check_is_an_exercise(source, name):
    assert checked_name(source) == name


def test_a_file_is_written_as_nbformat_writes_it():
    outputs = [
        {"output_type": "stream", "name": "stdout", "text": "a\nb\n"},
        {"output_type": "display_data", "metadata": {}, "data": {"text/html": "<p>\n</p>", "image/png": PNG}},
        {"output_type": "error", "ename": "E", "evalue": "ü", "traceback": ["x\ny"]},
    ]
    made = built(cell("x = 1\ny = 2"), cell("", kind="markdown"), cell("ü\u2028", "why"))
    made.cells[0]["outputs"] = outputs
    expected = nbformat.writes(nbformat.from_dict(made.notebook), version=nbformat.NO_CONVERT) + "\n"
    assert dumps(made.notebook).decode() == expected


def test_a_text_of_newlines_takes_no_line_of_the_file_for_each():
    """A million of them would be a file of 15 MB."""
    made = built(cell("x = 1"))
    blank = "\n" * 100_000
    shown = {"output_type": "display_data", "metadata": {}, "data": {"text/plain": blank}}
    made.cells[0]["outputs"] = [{"output_type": "stream", "name": "stdout", "text": blank}, shown]
    written = dumps(made.notebook)
    assert len(written) < 500_000
    read = nbformat.reads(written.decode(), as_version=4)
    nbformat.validate(read)
    assert read.cells[0].outputs[1]["data"]["text/plain"] == read.cells[0].outputs[0]["text"] == blank


def test_long_outputs_are_cut_as_nbgrader_cuts_them():
    from nbgrader.preprocessors import LimitOutput

    lines = "\n".join(str(number) for number in range(30))
    stream = {"output_type": "stream", "name": "stdout", "text": lines}
    error = {"output_type": "error", "ename": "E", "evalue": "", "traceback": [str(n) for n in range(30)]}
    for outputs in ([stream], [stream, stream], [stream, error, stream], [error]):
        made = built(cell("x"))
        made.cells[0]["outputs"] = json.loads(json.dumps(outputs))
        theirs = nbformat.from_dict(json.loads(json.dumps(made.notebook)))
        LimitOutput(max_lines=20, max_traceback=10).preprocess(theirs, {})
        limit_outputs(made.cells, 20, 10)
        assert made.cells[0]["outputs"] == theirs.cells[0].outputs


def test_stderr_that_decides_a_mark_is_not_cut_away():
    """nbgrader: a thousand lines on stdout hide the stderr after them, and the cell has full points."""
    made = built(cell("x"))
    made.cells[0]["outputs"] = [
        {"output_type": "stream", "name": "stdout", "text": "\n" * 50},
        {"output_type": "stream", "name": "stderr", "text": "!"},
    ]
    limit_outputs(made.cells, 20, 10)
    assert [output["name"] for output in made.cells[0]["outputs"]] == ["stdout", "stderr"]


def test_stderr_that_the_course_ignores_is_taken_out():
    made = built(cell("x"))
    made.cells[0]["outputs"] = [{"output_type": "stream", "name": name, "text": "!"} for name in ("stdout", "stderr")]
    ignore_stderr(made.cells, "")
    assert len(made.cells[0]["outputs"]) == 2
    ignore_stderr(made.cells, "^!$")
    assert [output["name"] for output in made.cells[0]["outputs"]] == ["stdout"]


def test_the_course_secret_is_made_once_and_is_nobody_elses(tmp_path):
    secret = course_secret(tmp_path)
    assert course_secret(tmp_path) == secret
    assert len(secret) == 32
    place = tmp_path / ".directrix"
    assert oct(place.stat().st_mode)[-3:] == "700"
    assert [(path.name, oct(path.stat().st_mode)[-3:]) for path in place.iterdir()] == [("secret", "600")]
    (place / "secret").write_text("12")
    with pytest.raises(Exception, match="64 hexadecimal digits"):
        course_secret(tmp_path)


def test_seeds_differ_by_student_exercise_and_submission():
    seeds = {hidden_seed(b"s", *names) for names in (("a", "b", "c"), ("ab", "", "c"), ("a", "bc", ""), ("b", "b", "c"))}
    assert len(seeds) == 4
    assert hidden_seed(b"t", "a", "b", "c") not in seeds


def test_an_instructors_picture_is_not_repeated_without_end(tmp_path, monkeypatch):
    """Five thousand copies of one of the instructor's texts, each with its picture, would be a notebook of gigabytes."""
    monkeypatch.setattr("autograder.notebook.rebuild.MAX_PICTURES", 3 * len(PNG))
    told = {"cell_type": "markdown", "source": "see", "metadata": {}, "attachments": {"a.png": {"image/png": PNG}}}
    released = tmp_path / "nb.ipynb"
    released.write_text(json.dumps({"cells": [told]}))
    made = built(*[cell("see", kind="markdown")] * 5, master=MASTER.beside(released))
    assert ["attachments" in one for one in made.cells] == [True, True, True, False, False]
    assert "Pasted pictures" in made.notes[0].text
