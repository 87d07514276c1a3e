"""A class's archive into ``submitted/``: whose each file is, what is refused, and that nothing else is touched."""

import importlib.util
import json
from pathlib import Path

import pytest

from autograder import cli, collect, fleet
from autograder.errors import CourseError
from autograder.notebook.submission import NO_ID

spec = importlib.util.spec_from_file_location("archives", Path(__file__).parent / "notebook" / "test_archive.py")
archives = importlib.util.module_from_spec(spec)
spec.loader.exec_module(archives)
zipped = archives.zipped


def taken(course, tmp_path, *members, **options):
    path = tmp_path / "export.zip"
    path.write_bytes(zipped(*members, good=False))
    return {one.student: one for one in collect.collect(course.course(), path, "ps1", **options)}


def submitted(course):
    root = course.folder / "submitted"
    return {str(path.relative_to(root)): path.read_bytes() for path in root.rglob("*") if path.is_file()}


def test_a_folder_for_each_student(ordinary, tmp_path):
    found = taken(ordinary, tmp_path, ("ada/one.ipynb", "{}"), ("ada/data/x.csv", "1"), ("bob/two.ipynb", "[]"))
    assert submitted(ordinary) == {"ada/ps1/one.ipynb": b"{}", "ada/ps1/data/x.csv": b"1", "bob/ps1/two.ipynb": b"[]"}
    assert found["ada"].files == ("data/x.csv", "one.ipynb")
    assert found["ada"].placed


@pytest.mark.parametrize(
    ("name", "placed"),
    [
        ("Ada Lovelace_4711_assignsubmission_file_/one.ipynb", "4711/ps1/one.ipynb"),
        ("Ada_Lovelace_4711_assignsubmission_file/one.ipynb", "4711/ps1/one.ipynb"),
        ("Ada Lovelace_4711_assignsubmission_file_one.ipynb", "4711/ps1/one.ipynb"),
        ("Ada_Lovelace_4711_assignsubmission_file_my_plot.png", "4711/ps1/my_plot.png"),
        ("lovelaceada_4711_90210_one.ipynb", "4711/ps1/one.ipynb"),
        ("export/Ada Lovelace_4711_assignsubmission_file_/one.ipynb", "4711/ps1/one.ipynb"),
        ("export/lovelaceada_4711_90210_one.ipynb", "4711/ps1/one.ipynb"),
        ("lovelaceada_LATE_4711_90210_one-2.ipynb", "4711/ps1/one.ipynb"),
        ("lovelaceada_4711_90210_plot-2.png", "4711/ps1/plot-2.png"),
        ("ada/A1 homework/one.ipynb", "ada/ps1/one.ipynb"),
    ],
)
def test_names_of_learning_platforms(ordinary, tmp_path, name, placed):
    taken(ordinary, tmp_path, (name, "{}"))
    assert list(submitted(ordinary)) == [placed]


def test_a_folder_around_all_students_is_no_student(ordinary, tmp_path):
    """As after packing a folder by hand: one notebook in several folders is not one student's."""
    taken(ordinary, tmp_path, ("export/ada/one.ipynb", "{}"), ("export/bob/hw/one.ipynb", "[]"), ("export/bob/two.ipynb", "1"))
    assert submitted(ordinary) == {"ada/ps1/one.ipynb": b"{}", "bob/ps1/hw/one.ipynb": b"[]", "bob/ps1/two.ipynb": b"1"}


def test_a_student_with_folders_of_her_own_is_one_student(ordinary, tmp_path):
    """The neighbour: each notebook is there once."""
    files = ("ada/first/one.ipynb", "{}"), ("ada/second/two.ipynb", "[]"), ("ada/data_4711_90210_x.csv", "")
    assert list(taken(ordinary, tmp_path, *files)) == ["ada"]


def test_other_names_by_a_pattern(ordinary, tmp_path):
    pattern = r"(?P<student>[a-z]+)@uni__(?P<file>.+)"
    taken(ordinary, tmp_path, ("ada@uni__one.ipynb", "{}"), pattern=pattern)
    assert list(submitted(ordinary)) == ["ada/ps1/one.ipynb"]
    for wrong, said in (("(", "no regular expression"), ("(?P<who>.*)", "must have a group")):
        with pytest.raises(CourseError, match=said):
            taken(ordinary, tmp_path, ("x", ""), pattern=wrong)


@pytest.mark.parametrize("name", ["ada.zip", "ada/work.zip", "Ada_4711_assignsubmission_file_/work.zip", "ada/Work.ZIP"])
def test_an_archive_of_the_learner_is_read_one_level_deep(ordinary, tmp_path, name):
    inner = zipped(
        ("hw/one.ipynb", "{}"), ("hw/again.zip", zipped()), ("../up.txt", "x"), ("hw/timestamp.txt", "2001"), good=False
    )
    (one,) = taken(ordinary, tmp_path, (name, inner)).values()
    assert [path.split("/", 1)[1] for path in submitted(ordinary)] == ["ps1/one.ipynb"]
    reasons = " | ".join(f"{path}: {reason}" for path, reason in one.refused.items())
    assert "again.zip: it is an archive in an archive" in reasons
    assert "../up.txt: its name leads out" in reasons
    assert "timestamp.txt: when something was handed in is not for the sender to say" in reasons


def test_a_nested_bomb_is_bounded_with_the_rest_of_the_submission(ordinary, tmp_path):
    ordinary.configure("c.CourseDirectory.max_dir_size = 500\n")
    bomb = zipped(("zeros", bytes(5_000_000)), ("one.ipynb", "{}"), good=False)
    assert len(bomb) < 10_000
    found = taken(ordinary, tmp_path, ("ada/bomb.zip", bomb))
    assert submitted(ordinary) == {"ada/ps1/one.ipynb": b"{}"}
    assert "5000000 bytes are more" in found["ada"].refused["bomb.zip: zeros"]


def test_nothing_is_written_outside_and_every_refusal_is_named(ordinary, tmp_path):
    before = {str(path) for path in tmp_path.rglob("*")}
    link = archives.member("ada/link", 0o120777)
    found = taken(
        ordinary, tmp_path, ("../../evil", "x"), ("ada/../bob/one.ipynb", "x"), ("/abs/one.ipynb", "x"), (link, "/etc/passwd"),
        ("ada/one.ipynb", "{}"), ("stray.ipynb", "{}"), ("a<b/one.ipynb", "{}"), (".hidden/one.ipynb", "{}"), ("cas/x\x1b", ""),
    )  # fmt: skip
    assert submitted(ordinary) == {"ada/ps1/one.ipynb": b"{}"}
    after = {str(path) for path in tmp_path.rglob("*")}
    assert {path for path in after - before if "submitted" not in path} == {str(tmp_path / "export.zip")}
    assert set(found["ada"].refused) == {"../bob/one.ipynb", "link"}
    assert set(found[""].refused) == {"../../evil", "/abs/one.ipynb", "stray.ipynb", "cas/x\x1b"}
    assert found["a<b"].refused[""] == found[".hidden"].refused[""] == f"the name {NO_ID}"


def test_what_was_handed_in_before_stays_unless_told_otherwise(ordinary, tmp_path):
    taken(ordinary, tmp_path, ("ada/one.ipynb", "first"), ("ada/old.txt", "x"))
    assert "already" in taken(ordinary, tmp_path, ("ada/one.ipynb", "second"))["ada"].refused[""]
    assert submitted(ordinary)["ada/ps1/one.ipynb"] == b"first"
    taken(ordinary, tmp_path, ("ada/one.ipynb", "second"), force=True)
    assert submitted(ordinary) == {"ada/ps1/one.ipynb": b"second"}


def test_a_students_folder_that_is_a_link_is_not_written_through(ordinary, tmp_path):
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (ordinary.folder / "submitted").mkdir(exist_ok=True)
    (ordinary.folder / "submitted" / "ada").symlink_to(elsewhere, target_is_directory=True)
    assert "a link to another folder" in taken(ordinary, tmp_path, ("ada/one.ipynb", "{}"))["ada"].refused[""]
    assert list(elsewhere.iterdir()) == []


def test_what_is_no_archive_or_no_assignment_is_said(ordinary, tmp_path):
    (tmp_path / "no.zip").write_text("no archive")
    with pytest.raises(CourseError, match="no zip archive"):
        collect.collect(ordinary.course(), tmp_path / "no.zip", "ps1")
    with pytest.raises(CourseError, match=r"nothing\.zip: No such file"):
        collect.collect(ordinary.course(), tmp_path / "nothing.zip", "ps1")
    with pytest.raises(CourseError, match="ps9"):
        collect.collect(ordinary.course(), tmp_path / "no.zip", "ps9")


def test_the_command_collects_and_the_class_can_be_graded(ordinary, tmp_path, monkeypatch, capsys):
    notebook = ordinary.released("two")
    notebook["cells"][0]["source"] = "def add(a, b): return a + b"
    (tmp_path / "export.zip").write_bytes(zipped(("ada/two.ipynb", json.dumps(notebook)), ("ada/\x1b[31m", "x"), good=False))
    arguments = ["directrix", "collect", str(tmp_path / "export.zip"), "ps1", "--course", str(ordinary.folder), "--json"]
    monkeypatch.setattr("sys.argv", arguments)
    with pytest.raises(SystemExit) as ended:
        cli.main()
    shown = capsys.readouterr()
    assert ended.value.code == 1
    assert json.loads(shown.out)[0]["files"] == ["two.ipynb"]
    assert "not taken" in shown.err
    assert "\x1b" not in shown.err
    graded = fleet.grade(ordinary.course(), "ps1")
    assert {cell.name: cell.points for cell in graded.student("ada").cells}["test_add"] == 1.0
