"""What a killed grader left beside a place is removed, and costs nothing where that cannot be done."""

import errno
import shutil

from autograder.fleet import publish


def test_what_the_disk_does_not_let_go_is_in_nobodys_way(tmp_path, monkeypatch):
    """A class on a disk that has become read-only is told of each notebook that cannot be written, not of a leftover."""
    place = tmp_path / "ada" / "A1"
    left = publish.stage(place, {"one.ipynb": b"{}"}, mode=0o444, groupshared=False)
    with monkeypatch.context() as patch:
        patch.setattr(shutil, "rmtree", refused)
        publish.clear(place)
        assert left.is_dir()
        staged = publish.stage(place, {"one.ipynb": b"[]"}, mode=0o444, groupshared=False)
        publish.publish(staged, place)
    assert (place / "one.ipynb").read_bytes() == b"[]"
    publish.clear(place)
    assert list(place.parent.iterdir()) == [place]


def refused(*_, **__):
    raise OSError(errno.EROFS, "Read-only file system")
