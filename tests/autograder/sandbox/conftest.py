"""Sandboxes shared by the tests of a module, and a way to run something as an ordinary user when the tests run as root."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from autograder.sandbox import Limits, Policy, Sandbox

ROOT = Path(__file__).resolve().parents[3]
ORDINARY_UID = 1002

# Runs as root in a mount namespace of its own: interpreter and checkout may lie in folders that only root may enter. Such a
# folder is covered by an empty one and the trees are attached again at their own paths; then the process becomes the user.
BECOME = """
import os, sys
sys.path.insert(0, sys.argv[1])
from autograder.sandbox import system
uid, trees, command = int(sys.argv[2]), sys.argv[3].split(":"), sys.argv[4:]
held = {path: system.open_tree(path) for path in trees}
system.unshare(system.CLONE_NEWNS)
system.mount("none", "/", None, system.MS_REC | system.MS_PRIVATE)
for path in trees:
    parents = ["/" + "/".join(path.strip("/").split("/")[:n]) for n in range(1, path.count("/"))]
    closed = next((parent for parent in parents if not os.stat(parent).st_mode & 1), None)
    if closed:
        system.mount("tmpfs", closed, "tmpfs", 0, "mode=755")
    os.makedirs(path, exist_ok=True)
    system.move_mount(held[path], path)
os.setgroups([]); os.setresgid(uid, uid, uid); os.setresuid(uid, uid, uid)
os.execv(command[0], command)
"""


def run_as_user(command: list[str], folder: Path, **options: object) -> subprocess.CompletedProcess[str]:
    """Run a command as an ordinary user; ``folder`` becomes that user's home and temporary folder."""
    environment = {"PATH": os.environ["PATH"], "HOME": str(folder), "TMPDIR": str(folder), "LANG": "C.UTF-8"}
    environment |= {"PYTHONPATH": f"{ROOT / 'lib'}:{ROOT}", "HYPOTHESIS_STORAGE_DIRECTORY": str(folder)}
    environment["PYTHONDONTWRITEBYTECODE"] = "1"
    if os.geteuid() == 0:
        os.chown(folder, ORDINARY_UID, ORDINARY_UID)
        trees = ":".join(
            dict.fromkeys([sys.base_prefix, str(ROOT), *([] if ROOT in Path(sys.prefix).parents else [sys.prefix])])
        )
        command = [sys.executable, "-I", "-S", "-c", BECOME, str(ROOT), str(ORDINARY_UID), trees, *command]
    return subprocess.run(command, env=environment, text=True, capture_output=True, cwd=ROOT, check=False, **options)


@pytest.fixture(scope="session")
def as_ordinary_user():
    """:func:`run_as_user`."""
    return run_as_user


@pytest.fixture(scope="session")
def sandbox():
    """A sandbox with numpy alone, which starts fastest."""
    with Sandbox(Policy(packages=(), preload=())) as box:
        yield box


@pytest.fixture
def session(sandbox):
    """A fresh notebook with tight limits."""
    limits = Limits(cell_cpu=1, call_cpu=1, patience=1, memory=512 * 2**20)
    with sandbox.open(limits=limits) as notebook:
        yield notebook
