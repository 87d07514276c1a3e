"""Hostile submission folders and hostile notebooks."""

import json
import os
import socket

import pytest

from autograder.errors import SubmissionError
from autograder.notebook.submission import Bounds, harmless, parse, read_file, read_folder
from autograder.notebook.timestamps import handed_in


def test_regular_files_are_read_with_their_paths(tmp_path):
    (tmp_path / "nb.ipynb").write_text("{}")
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "points.csv").write_bytes(b"1,2")
    found = read_folder(tmp_path)
    assert found.files == {"nb.ipynb": b"{}", "data/points.csv": b"1,2"}
    assert found.notebooks == {"nb": b"{}"}
    assert found.others == {"data/points.csv": b"1,2"}
    assert found.notes == []


def test_links_fifos_and_sockets_are_named_and_left_out(tmp_path):
    outside = tmp_path / "secret.txt"
    outside.write_text("secret")
    inside = tmp_path / "in"
    inside.mkdir()
    (inside / "file").symlink_to(outside)
    (inside / "folder").symlink_to("/etc", target_is_directory=True)
    (inside / "zero").symlink_to("/dev/zero")
    (inside / "loop").symlink_to("loop")
    os.mkfifo(inside / "pipe")
    with socket.socket(socket.AF_UNIX) as bound:
        bound.bind(str(inside / "sock"))
        found = read_folder(inside)
    assert found.files == {}
    assert sorted(note.split(": left out, ")[1] for note in found.notes) == [
        "it is a FIFO, not a file", *["it is a link, not a file"] * 4, "it is a socket, not a file",
    ]  # fmt: skip


def test_names_that_the_sandbox_would_refuse_are_left_out_and_the_rest_is_read(tmp_path):
    screenshot = "Screenshot 2027-01-01 at 10.00.00\u202fAM.png"  # as macOS names it
    for name in (screenshot, "né.txt", "no\u00a0break.txt", "back\\slash", "new\nline", "esc\x1b[31m", "turned\u202e.txt"):
        (tmp_path / name).write_bytes(b"x")
    found = read_folder(tmp_path)
    assert set(found.files) == {screenshot, "né.txt", "no\u00a0break.txt"}
    assert set(found.left_out) == {"back\\slash", "new\nline", "esc\x1b[31m", "turned\u202e.txt"}
    assert all(note.isprintable() for note in found.notes)


def test_the_folder_itself_may_not_be_a_link(tmp_path):
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "real", target_is_directory=True)
    assert read_folder(tmp_path / "real").files == {}
    with pytest.raises(SubmissionError, match="no folder"):
        read_folder(tmp_path / "link")
    with pytest.raises(SubmissionError, match="no folder"):
        read_folder(tmp_path / "nothing")


def test_sizes_and_numbers_are_bounded_and_named(tmp_path):
    (tmp_path / "a-big").write_bytes(b"x" * 101)
    (tmp_path / "b-fits").write_bytes(b"x" * 100)
    (tmp_path / "c-total").write_bytes(b"x" * 60)
    found = read_folder(tmp_path, bounds=Bounds(file=100, total=150))
    assert set(found.files) == {"b-fits"}
    assert len(found.notes) == 2
    for number in range(9):
        (tmp_path / f"n{number}").touch()
    assert "more than 5 entries" in read_folder(tmp_path, bounds=Bounds(entries=5)).notes[-1]


def test_a_sparse_file_of_a_terabyte_costs_nothing(tmp_path):
    with (tmp_path / "big.ipynb").open("wb") as file:
        file.truncate(2**40)
    assert "1099511627776 bytes" in read_folder(tmp_path).notes[0]


def test_deep_folders_end(tmp_path):
    place = tmp_path
    for _ in range(40):
        place /= "d"
        place.mkdir()
    (place / "file").touch()
    assert "deep" in read_folder(tmp_path).notes[0]


def test_names_with_control_characters_or_broken_unicode_are_left_out(tmp_path):
    (tmp_path / "a\nb").touch()
    (tmp_path / "a\x1b[31mb").touch()
    with open(os.fsencode(tmp_path) + b"/\xff\xfe", "wb"):
        pass
    found = read_folder(tmp_path)
    assert found.files == {}
    assert all(note.isprintable() for note in found.notes)
    assert len(found.notes) == 3


def test_ignored_names_are_not_read(tmp_path):
    (tmp_path / ".ipynb_checkpoints").mkdir()
    (tmp_path / ".ipynb_checkpoints" / "nb.ipynb").touch()
    (tmp_path / "x.pyc").touch()
    assert read_folder(tmp_path).files == {}


def test_read_file_takes_a_file_and_nothing_else(tmp_path):
    (tmp_path / "file").write_bytes(b"12345")
    (tmp_path / "link").symlink_to(tmp_path / "file")
    assert read_file(tmp_path / "file", 5) == b"12345"
    for name, limit in (("file", 4), ("link", 5), (".", 5)):
        with pytest.raises(SubmissionError):
            read_file(tmp_path / name, limit)


def test_the_digest_depends_on_names_and_bytes(tmp_path):
    (tmp_path / "a").write_bytes(b"1")
    first = read_folder(tmp_path).digest
    assert read_folder(tmp_path).digest == first
    (tmp_path / "a").rename(tmp_path / "b")
    assert read_folder(tmp_path).digest != first


NOTEBOOK = {"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": []}


def test_a_notebook_parses():
    assert parse(json.dumps(NOTEBOOK).encode()) == NOTEBOOK


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"", "the file is empty"),
        (
            '{"cells": "Gr\xf6\xdfe"}'.encode("latin-1"),
            "no text in UTF-8; perhaps another kind of file was renamed, or it was saved",
        ),
        (b"<!DOCTYPE html><html>Log in</html>", "begins with '<!DOCTYPE html><'; perhaps another kind of file"),
        (json.dumps(NOTEBOOK)[:-3].encode(), "ends in the middle"),
        (b'{"nbformat": 4, "cells": [{"source": "def f', "ends in the middle"),
        (b'{"nbformat": 4,, "cells": []}', "line 1"),
        (b"PK\x03\x04\xff\xfe", "no text"),
        (b"[1, 2]", "no notebook"),
        (b'{"nbformat": "4"}', "no notebook"),
        (b'{"nbformat": 4}', "no list of cells"),
        (b'{"nbformat": 9, "cells": []}', "nbformat 9"),
        (b"[" * 200_000, "nested too deeply"),
        (b'{"nbformat": 4, "x": ' + b"9" * 10_000 + b"}", "absurd length"),
        (b'{"nbformat": 4, "cells": [], "x": [' + b"[]," * 2_000_000 + b"0]}", "more than 2000000 lists"),
    ],
)
def test_what_is_no_notebook_says_what_is_wrong(data, said):
    with pytest.raises(SubmissionError, match=said):
        parse(data)


@pytest.mark.filterwarnings("ignore")
def test_an_old_notebook_is_converted():
    """nbformat 3 kept cells in worksheets."""
    old = {"nbformat": 3, "nbformat_minor": 0, "metadata": {"name": ""}, "worksheets": [{"cells": [
        {"cell_type": "code", "language": "python", "input": "x = 1", "outputs": [], "collapsed": False, "metadata": {}},
    ]}]}  # fmt: skip
    assert parse(json.dumps(old).encode())["cells"][0]["source"] == "x = 1"
    with pytest.raises(SubmissionError, match="old format"):
        parse(b'{"nbformat": 3, "worksheets": 7}')


@pytest.mark.parametrize(
    "path", ["a.ipynb", "sub/a.ipynb", "a.ipynb/x.txt", "sub/a.ipynb/x", "timestamp.txt", "timestamp.txt/x"]
)
def test_no_file_of_a_notebook_takes_the_place_of_a_notebook_or_the_time(path):
    assert not harmless(path)
    assert harmless("sub/timestamp.txt")


@pytest.mark.parametrize("said", ["0001-01-01 00:00:00 UTC", "9999-12-31 23:59:59 UTC", "6" + "9" * 40 + "m15:00:00", "soon"])
def test_a_time_at_the_end_of_the_calendar_is_no_date(said):
    """In New York, formgrader's list of submissions fails for the whole class over one of the year 1."""
    with pytest.raises(SubmissionError, match="no date"):
        handed_in({"timestamp.txt": said.encode()})
    assert handed_in({"timestamp.txt": b"1970-01-01 00:00:00 UTC"}).year == 1970


def test_a_folder_in_the_place_of_the_time_is_left_out(tmp_path):
    (tmp_path / "timestamp.txt").mkdir()
    (tmp_path / "timestamp.txt" / "x").touch()
    found = read_folder(tmp_path)
    assert found.files == {}
    with pytest.raises(SubmissionError, match=r"timestamp.txt: it is a folder, not a time"):
        assert found.handed_in
