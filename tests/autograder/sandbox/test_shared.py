"""Level A-: notebooks share a scratch folder and a user, and still nothing of one can be had, or held up, by another."""

import time

import pytest

from autograder.sandbox import Limits, Policy, Sandbox, launcher
from autograder.sandbox.view import view

GUESS = """
import os
found = []
for number in range(64):
    for inner in ("", "/work", "/work/essay.txt", "/tmp", "/home"):
        try:
            found.append((f"/scratch/{number}{inner}", os.stat(f"/scratch/{number}{inner}").st_size))
        except OSError:
            pass
    try:
        found += os.listdir(f"/scratch/{number}")
    except OSError:
        pass
print(*[path for path, *_ in found if "work" in path or "tmp" in path or not path.startswith("/scratch/")])
"""
LARGEST = """
import mmap
least, most = 0, 2**32
while most - least > 2**20:
    middle = (least + most) // 2
    try:
        mmap.mmap(-1, middle).close()
        least = middle
    except OSError:
        most = middle
print(least)
"""


@pytest.fixture(scope="module")
def box():
    with Sandbox(Policy(packages=(), preload=()), "A-") as shared:
        yield shared


def text(result):
    assert result.status == "ok", result
    return "".join(output["text"] for output in result.outputs).strip()


def test_a_notebook_cannot_ask_what_a_classmate_handed_in(box):
    """Landlock lets everybody ask for a file's size and date by its name: so no name can be guessed."""
    with box.open({"essay.txt": b"mine"}) as mine, box.open() as other:
        assert text(mine.run_cell("import os; print(os.listdir(), os.stat('essay.txt').st_size)")) == "['essay.txt'] 4"
        assert text(other.run_cell(GUESS)) == ""
        assert text(mine.run_cell("import os; print(os.getcwd())")) not in text(other.run_cell("print(os.getcwd())"))


def test_what_a_notebook_had_is_gone_after_it(box):
    with box.open({"deep/in/it.txt": b"x" * 2**20}) as one:
        before = int(text(one.run_cell("import os; print(os.statvfs('.').f_bfree)")))
    deadline = time.monotonic() + 60
    with box.open() as other:
        while int(text(other.run_cell("import os; print(os.statvfs('.').f_bfree)"))) < before + 250:
            assert time.monotonic() < deadline
            time.sleep(0.05)


def test_a_notebook_may_take_as_much_memory_as_where_it_has_a_proc(box):
    """What the interpreter has already, and that is more where more is preloaded, is not taken off what was promised."""
    limits = Limits(memory=300 * 2**20)
    with box.open(limits=limits) as session:
        assert limits.memory - 4 * 2**20 < int(text(session.run_cell(LARGEST))) <= limits.memory + 2**20


def test_the_shared_folder_has_room_for_what_all_may_write_at_once(monkeypatch):
    """A worker runs two processes, the learner's and the tests', each with its files and what it prints to two more."""
    limits = Limits()
    for cores in (1, 4, 64):
        monkeypatch.setattr(launcher.os, "cpu_count", lambda cores=cores: cores)
        command = launcher.options(view(Policy(packages=(), preload=())), "A-")
        size = int(command[command.index("0700") - 2])
        assert size >= 2 * cores * (limits.scratch + 2 * limits.file)
