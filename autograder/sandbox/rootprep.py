"""The one thing done as root: lay out read-only mounts that another uid can read, become that uid, start bubblewrap.

An interpreter under root's home (mode 0700) is out of reach for the dropped uid by its path. So each tree is cloned as a
detached mount, attached below a fresh tmpfs in a mount namespace of this process alone, and nothing on the host changes.
Runs on the standard library only.
"""

from __future__ import annotations

import json
import os
import sys

from autograder.sandbox import system


def main() -> None:
    """Read the request from standard input, prepare, and become bubblewrap."""
    request = json.loads(sys.stdin.buffer.read())
    null = os.open("/dev/null", os.O_RDONLY)
    os.dup2(null, 0)
    stage(request["places"], request["stage"])
    become(request["uid"])
    os.execv(request["command"][0], request["command"])


def stage(places: dict[str, str], folder: str) -> None:
    """Attach each tree at its place below ``folder``, read-only, in a new mount namespace."""
    trees = {place: (system.open_tree(source), os.path.isdir(source)) for source, place in places.items()}
    system.unshare(system.CLONE_NEWNS)
    system.mount("none", "/", None, system.MS_REC | system.MS_PRIVATE)
    system.mount("tmpfs", folder, "tmpfs", system.MS_NOSUID | system.MS_NODEV, "size=1m,mode=755")
    for place, (tree, is_folder) in trees.items():
        system.set_read_only(tree)
        os.makedirs(place if is_folder else os.path.dirname(place), mode=0o755, exist_ok=True)
        if not is_folder:
            os.close(os.open(place, os.O_CREAT | os.O_WRONLY, 0o644))
        system.move_mount(tree, place)
        os.close(tree)


def become(uid: int) -> None:
    """Another user for good: no groups, no capabilities, nothing to come back by."""
    os.umask(0o077)
    os.setgroups([])
    os.setresgid(uid, uid, uid)
    os.setresuid(uid, uid, uid)
    system.no_new_privileges()
