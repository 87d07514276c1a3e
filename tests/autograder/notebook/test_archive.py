"""Hostile archives: what each would do to somebody who simply unpacks it, and that here it is refused by name."""

import io
import stat
import struct
import tracemalloc
import warnings
import zipfile
import zlib

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from autograder.errors import SubmissionError
from autograder.notebook import archive
from autograder.notebook.submission import Bounds

GOOD = {"known-forms.ipynb": b"{}", "data/points.csv": b"1,2"}
SMALL = Bounds(notebook=100_000, file=100_000, total=150_000, entries=50)


def member(name, mode=0o100644, **fields):
    info = zipfile.ZipInfo(name)
    info.external_attr = mode << 16
    info.compress_type = fields.pop("compress_type", zipfile.ZIP_DEFLATED)
    for field, value in fields.items():
        setattr(info, field, value)
    return info


def zipped(*members, good=True):
    """An archive of (name or ZipInfo, data), with ordinary members around them."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as file, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # zipfile warns of names that are there twice
        for name, data in [*(GOOD.items() if good else ()), *members]:
            file.writestr(name, data)
    return made.getvalue()


def encrypted(data, name):
    """The same archive with the flag set that says that one member is encrypted."""
    raw = bytearray(data)
    for signature, flags, at_name in ((b"PK\x03\x04", 6, 30), (b"PK\x01\x02", 8, 46)):
        at = raw.find(signature)
        while at >= 0:
            if raw[at + at_name :].startswith(name.encode()):
                raw[at + flags] |= 1
            at = raw.find(signature, at + 4)
    return bytes(raw)


def renamed(data, old, new):
    assert len(old) == len(new)
    return data.replace(old.encode(), new.encode())


HOSTILE = {
    "up and out": (zipped(("../out.txt", "x")), "../out.txt", "leads out"),
    "up in the middle": (zipped(("data/../../out.txt", "x")), "data/../../out.txt", "leads out"),
    "absolute": (zipped(("/out.txt", "x")), "/out.txt", "leads out"),
    "a drive": (zipped(("C:/out.txt", "x")), "C:/out.txt", "leads out"),
    "backslashes": (zipped(("..\\out.txt", "x")), "..\\out.txt", "characters"),
    "a link": (zipped((member("link", stat.S_IFLNK | 0o777), "/etc/passwd")), "link", "a link"),
    "a FIFO": (zipped((member("pipe", stat.S_IFIFO | 0o666), "")), "pipe", "no file"),
    "a device": (zipped((member("null", stat.S_IFCHR | 0o666), "")), "null", "no file"),
    "a bomb": (zipped(("zeros", bytes(20_000_000))), "zeros", "20000000 bytes are more"),
    "an encrypted member": (encrypted(zipped(("locked", "x")), "locked"), "locked", "encrypted"),
    "a name twice": (zipped(("twice", "one"), ("twice", "two")), "twice", "several members"),
    "a file that is a folder": (zipped(("both", "x"), ("both/inner", "y")), "both/inner", "is a file"),
    "terminal escapes": (zipped(("\x1b]0;owned\x07", "x")), "\x1b]0;owned\x07", "characters"),
    "text that turns around": (zipped(("gnp\u202eipynb", "x")), "gnp\u202eipynb", "characters"),
    "a NUL in the name": (renamed(zipped(("good_evil", "x")), "good_evil", "good\0evil"), "good\0evil", "characters"),
    "a forged date": (zipped(("timestamp.txt", "2001-01-01 00:00:00 UTC")), "timestamp.txt", "not for the sender"),
    "a long name": (zipped(("n" * 300, "x")), "n" * 300, "too long"),
    "deep folders": (zipped(("d/" * 40 + "x", "x")), "d/" * 40 + "x", "deep"),
    "another method": (zipped((member("slow", compress_type=zipfile.ZIP_LZMA), "x")), "slow", "method"),
}  # fmt: skip


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_member_is_refused_by_name_and_the_rest_is_read(name):
    data, path, said = HOSTILE[name]
    found = archive.read(data, bounds=SMALL)
    assert {key: found.files[key] for key in GOOD} == GOOD
    assert path not in found.files or name == "a file that is a folder"
    assert said in found.refused[path]


def unpacked(data, folder):
    """What somebody gets who unpacks without looking."""
    with zipfile.ZipFile(io.BytesIO(data)) as file:
        file.extractall(folder)
    return {str(path.relative_to(folder)): path.stat().st_size for path in folder.rglob("*") if path.is_file()}


def test_without_the_guard_bombs_dates_doubles_and_escapes_would_arrive(tmp_path):
    """Python's own extractall strips what leads out, and takes all of this."""
    for number, (name, path) in enumerate(
        [("a bomb", "zeros"), ("a forged date", "timestamp.txt"), ("a name twice", "twice"),
         ("terminal escapes", "\x1b]0;owned\x07"), ("text that turns around", "gnp\u202eipynb"), ("another method", "slow"),
         ("a NUL in the name", "good")]
    ):  # fmt: skip
        assert path in unpacked(HOSTILE[name][0], tmp_path / str(number))
    assert unpacked(HOSTILE["a bomb"][0], tmp_path / "bomb")["zeros"] == 20_000_000
    for stops in ("an encrypted member", "a file that is a folder", "a long name"):  # and these would stop it
        with pytest.raises((RuntimeError, OSError)):
            unpacked(HOSTILE[stops][0], tmp_path / stops)


def test_a_bomb_that_lies_about_its_size_costs_no_more_than_it_may_bring():
    """Sizes are the sender's word: the reader counts what comes out."""
    data = bytearray(zipped(("zeros", bytes(50_000_000)), good=False))
    for signature, at_size in ((b"PK\x03\x04", 22), (b"PK\x01\x02", 24)):
        struct.pack_into("<L", data, data.find(signature) + at_size, 10)
    tracemalloc.start()
    try:
        found = archive.read(bytes(data), bounds=SMALL)
        assert tracemalloc.get_traced_memory()[1] < 3_000_000
    finally:
        tracemalloc.stop()
    assert found.files == {}
    assert set(found.refused) == {"zeros"}


def test_many_bombs_together_are_bounded_by_what_one_submission_may_bring():
    """Each member is small enough; all of them are not."""
    found = archive.read(zipped(*((f"f{n}", bytes(90_000)) for n in range(10)), good=False), bounds=SMALL)
    assert sum(map(len, found.files.values())) <= SMALL.total
    assert len(found.refused) == 9


def test_more_members_than_a_submission_may_have_are_not_even_listed():
    data = zipped(*((f"f{n}", b"") for n in range(60)), good=False)
    with pytest.raises(SubmissionError, match="more than 50 members"):
        archive.read(data, bounds=SMALL)
    assert len(unpacked_names(data)) == 60


def unpacked_names(data):
    with zipfile.ZipFile(io.BytesIO(data)) as file:
        return file.namelist()


def test_a_damaged_member_costs_itself():
    data = bytearray(zipped((member("hurt", compress_type=zipfile.ZIP_STORED), b"twelve bytes"), good=True))
    data[data.find(b"twelve")] ^= 1
    found = archive.read(bytes(data))
    assert set(found.files) == set(GOOD)
    assert "damaged" in found.refused["hurt"]


@pytest.mark.parametrize("data", [b"", b"PK\x03\x04", b"PK\x05\x06" + bytes(18)[:3], zipped()[:-30], b"\x1f\x8b gzip"])
def test_what_is_no_archive_is_refused(data):
    with pytest.raises(SubmissionError, match="no zip archive"):
        archive.read(data)


def test_system_files_and_folders_are_passed_over():
    found = archive.read(zipped(("__MACOSX/._x", "x"), (".DS_Store", "x"), ("data/", ""), ("a/.ipynb_checkpoints/x", "x")))
    assert found.files == GOOD
    assert found.refused == {}


def test_the_length_of_the_list_of_members_is_read_before_the_list():
    data = zipped()
    with zipfile.ZipFile(io.BytesIO(data)) as file:
        start = file.start_dir
    assert archive.announced(io.BytesIO(data)) == len(data) - start - 22
    assert archive.announced(io.BytesIO(b"no archive")) == 0


@settings(max_examples=150, deadline=None)
@given(st.data())
def test_whatever_is_changed_in_an_archive_it_is_read_within_bounds_or_refused(data):
    """Bytes flipped, cut and repeated anywhere, the list of members included."""
    raw = bytearray(zipped(("notes.txt", b"n" * 500), (member("s", compress_type=zipfile.ZIP_STORED), zlib.compress(b"x"))))
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(raw) - 1))
        how = data.draw(st.sampled_from(["flip", "cut", "repeat", "big"]))
        if how == "flip":
            raw[at] = data.draw(st.integers(0, 255))
        elif how == "cut":
            del raw[at : at + data.draw(st.integers(1, 40))]
        elif how == "repeat":
            raw[at:at] = raw[at : at + data.draw(st.integers(1, 200))]
        else:
            raw[at : at + 4] = b"\xff\xff\xff\x7f"
        if not raw:
            break
    try:
        found = archive.read(bytes(raw), bounds=SMALL)
    except SubmissionError:
        return
    assert sum(map(len, found.files.values())) <= SMALL.total
    assert all(".." not in path.split("/") and path.isprintable() and path[0] != "/" for path in found.files)


def damaged(count, size):
    """An archive of so many members of so many zeros, each with a wrong checksum, which shows when all of it is unpacked."""
    raw = bytearray(zipped(*((f"{number}.bin", bytes(size)) for number in range(count)), good=False))
    at = raw.find(b"PK\x01\x02")
    while at >= 0:
        raw[at + 16 : at + 20] = b"none"
        at = raw.find(b"PK\x01\x02", at + 4)
    return bytes(raw)


def test_what_is_unpacked_in_vain_is_counted_too():
    """Two thousand such members fit into a submission: two minutes of unpacking, for nothing."""
    found = archive.read(damaged(5, 60_000), bounds=SMALL)
    assert found.files == {}
    assert ["damaged" in reason for reason in found.refused.values()] == [True, True, False, False, False]
    assert "more than the 30000 bytes" in found.refused["4.bin"]
    assert found.wasted == 120_000
