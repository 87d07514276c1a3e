"""What a sandbox had to compile is compiled beside its files for the next, and nothing else is touched."""

import importlib.util
import sys
import time
from pathlib import Path

import pytest

from autograder.sandbox import Policy, Sandbox, box, bytecode


@pytest.fixture
def written(monkeypatch):
    """Python writes bytecode here."""
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    monkeypatch.setattr(sys, "pycache_prefix", None)


def cached(file):
    return Path(importlib.util.cache_from_source(str(file)))


def test_what_was_compiled_inside_is_kept_outside(tmp_path, written):
    for name in ("seen", "other", "wrong"):
        (tmp_path / f"{name}.py").write_text("x = = 1\n" if name == "wrong" else "raise SystemExit('compiled, never run')\n")
    bytecode.keep(["/packages/own/seen.py", "/packages/own/wrong.py", "/elsewhere/other.py"], {"/packages/own": str(tmp_path)})
    until = time.monotonic() + 30
    while not cached(tmp_path / "seen.py").exists():
        assert time.monotonic() < until
        time.sleep(0.02)
    time.sleep(0.2)
    assert not cached(tmp_path / "other.py").exists()


@pytest.mark.parametrize(("name", "value"), [("dont_write_bytecode", True), ("pycache_prefix", "elsewhere")])
def test_nothing_is_compiled_where_python_writes_no_bytecode_beside_files(tmp_path, written, monkeypatch, name, value):
    monkeypatch.setattr(sys, name, value)
    monkeypatch.setattr(bytecode.threading, "Thread", None)
    (tmp_path / "seen.py").write_text("")
    bytecode.keep(["/packages/own/seen.py"], {"/packages/own": str(tmp_path)})


@pytest.mark.parametrize(
    ("file", "found"),
    [
        ("/packages/own/a.py", "/real/own/a.py"),
        ("/packages/own/sub/a.py", "/real/own/sub/a.py"),
        ("/packages/owner/a.py", None),
        ("/packages/own/../other/a.py", None),
        ("/packages/own/a.so", None),
        ("/packages/own/a\n/etc/b.py", None),
        ("packages/own/a.py", None),
        ("/a.py", None),
        (None, None),
        (3, None),
    ],
)
def test_only_python_files_below_what_is_shown_are_found(file, found):
    assert bytecode.outside(file, {"/packages/own": "/real/own", "/python/lib": "/real/lib"}) == found


def test_a_sandbox_says_what_it_compiled(monkeypatch):
    """Files that are shown one by one have no bytecode beside them inside; folders that are shown have what theirs have."""
    told = []
    monkeypatch.setattr(box.bytecode, "keep", lambda files, shown: told.append((files, shown)))
    with Sandbox(Policy(packages=("numpy",), preload=())):
        pass
    ((files, shown),) = told
    assert "/guest/autograder/sandbox/wire.py" in files
    assert bytecode.outside("/guest/autograder/sandbox/wire.py", shown) is None
    guest = Path(bytecode.__file__).parent / "guest"
    assert bytecode.outside("/guest/autograder/sandbox/guest/zygote.py", shown) == str(guest / "zygote.py")
    for file in files:
        place = bytecode.outside(file, shown)
        assert place is None or (Path(place).exists() and not cached(place).exists())
