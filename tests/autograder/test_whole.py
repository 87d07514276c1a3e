"""A file is there as it was before or whole, and nothing else is left beside it."""

import errno
import os
import stat
from pathlib import Path

import pytest

from autograder.whole import replaced


def write(path, data=b"new", mode=None):
    with replaced(path, mode) as file:
        file.write(data)


def test_what_is_written_replaces_what_was_there(tmp_path):
    path = tmp_path / "marks.csv"
    write(path, b"first")
    path.chmod(0o640)
    write(path)
    assert path.read_bytes() == b"new"
    assert stat.S_IMODE(path.stat().st_mode) == 0o640
    write(path, mode=0o444)
    assert stat.S_IMODE(path.stat().st_mode) == 0o444
    assert list(tmp_path.iterdir()) == [path]


def test_a_new_file_has_the_permissions_that_new_files_have(tmp_path):
    write(tmp_path / "ours")
    (tmp_path / "plain").touch()
    assert (tmp_path / "ours").stat().st_mode == (tmp_path / "plain").stat().st_mode


@pytest.mark.parametrize("stopped", [OSError(errno.ENOSPC, "No space left on device"), KeyboardInterrupt(), ValueError("x")])
def test_what_stops_in_the_middle_leaves_what_was_there(tmp_path, stopped):
    """And the disk's refusal names the file that was wanted, which the system's own does not."""
    path = tmp_path / "marks.csv"
    path.write_bytes(b"before")

    def half():
        with replaced(path) as file:
            file.write(b"half")
            raise stopped

    with pytest.raises(type(stopped)) as raised:
        half()
    assert getattr(raised.value, "filename", str(path)) == str(path)
    assert path.read_bytes() == b"before"
    assert list(tmp_path.iterdir()) == [path]


def test_where_no_file_can_be_the_wanted_path_is_named(tmp_path):
    """Not the one that was to be renamed into it."""
    for path, wanted in ((tmp_path / "none" / "x.csv", errno.ENOENT), (tmp_path, errno.EISDIR)):
        with pytest.raises(OSError) as raised:
            write(path)
        assert (raised.value.errno, raised.value.filename) == (wanted, str(path))


def test_a_link_stays_one_and_a_pipe_is_written_to(tmp_path):
    (tmp_path / "link").symlink_to("real")
    write(tmp_path / "link")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "real").read_bytes() == b"new"
    ours, theirs = os.pipe()
    write(Path(f"/dev/fd/{theirs}"))
    assert os.read(ours, 10) == b"new"
    os.close(ours)
    os.close(theirs)
