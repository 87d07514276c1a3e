"""Faults for the campaign: what can happen to a grader from outside, each at the moment it is called."""

import contextlib
import os
import random
import resource
import signal
import sqlite3
import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any


@dataclass
class Scene:
    """A grader at work on a course."""

    course: Any  # a Classroom
    grader: int  # its process
    chance: random.Random
    cluster: Any = None  # the Dask processes, if it grades there
    start: Callable[[], int] | None = None  # starts another grader
    undo: contextlib.ExitStack = field(default_factory=contextlib.ExitStack)  # put right again when the grader has ended
    others: list[int] = field(default_factory=list)  # further graders


def children(pid):
    """Direct children of a process, those of its threads among them."""
    found = []
    with contextlib.suppress(OSError):
        for task in Path(f"/proc/{pid}/task").iterdir():
            found += [int(name) for name in (task / "children").read_text().split()]
    return found


def command(pid):
    with contextlib.suppress(OSError):
        return Path(f"/proc/{pid}/comm").read_text().strip()


def below(pid):
    """All descendants."""
    return [one for child in children(pid) for one in (child, *below(child))]


def graders(scene):
    """The processes that have a sandbox: the grader, or the cluster's workers."""
    return scene.cluster.workers() if scene.cluster is not None else [scene.grader]


def bubblewraps(scene):
    return [child for grader in graders(scene) for child in children(grader) if command(child) == "bwrap"]


def zygotes(scene):
    return [child for outer in bubblewraps(scene) for child in children(outer)]


def learners(scene):
    return [child for zygote in zygotes(scene) for child in children(zygote)]


def workers(scene):
    if scene.cluster is not None:
        return scene.cluster.workers()
    return [child for child in children(scene.grader) if command(child) != "bwrap"]


def kill_one(scene, find, seconds=1.0):
    """Kill one of those that ``find`` finds, waiting a little for one to be there; its process id."""
    deadline = time.monotonic() + seconds
    while not (found := find(scene)):
        if time.monotonic() > deadline:
            return None
        time.sleep(0.002)
    pid = scene.chance.choice(found)
    with contextlib.suppress(ProcessLookupError):
        os.kill(pid, signal.SIGKILL)
    return pid


# ---- the faults; each returns whether it could be done


def grader_killed(scene):
    os.kill(scene.grader, signal.SIGKILL)
    return True


def grader_terminated(scene):
    os.kill(scene.grader, scene.chance.choice([signal.SIGTERM, signal.SIGINT]))
    return True


def worker_killed(scene):
    return kill_one(scene, workers) is not None


def sandbox_killed(scene):
    return kill_one(scene, scene.chance.choice([bubblewraps, zygotes])) is not None


def learner_killed(scene):
    return kill_one(scene, learners) is not None


def stopped_and_continued(scene):
    """The grader alone, or it with all that it started, sleeps for a while."""
    tree = [scene.grader]
    if scene.chance.random() < 0.5:
        tree += below(scene.grader)
    for pid in tree:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGSTOP)
    time.sleep(scene.chance.uniform(0.2, 1.5))
    for pid in tree:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGCONT)
    return True


def disk_full(scene):
    """The course's file system has no room, or next to none, until the grader has ended."""
    if not os.path.ismount(scene.course.folder.parents[0]):
        return False
    filler = scene.course.folder.parents[0] / "filler"
    scene.undo.callback(filler.unlink, missing_ok=True)
    with filler.open("wb", buffering=0) as file, contextlib.suppress(OSError):
        while True:
            if file.write(bytes(2**16)) < 2**16:
                break
    with contextlib.suppress(OSError):
        os.truncate(filler, max(0, filler.stat().st_size - scene.chance.choice([0, 0, 4096, 20_000, 60_000])))
    return True


def database_locked(scene):
    """Somebody holds the gradebook: for a moment, or for longer than the grader waits."""
    seconds = scene.chance.choice([0.3, 0.6, 4.0])
    if hasattr(scene.course, "server"):
        with scene.course.server.connect(scene.course.database) as other:
            other.execute("begin")
            other.execute("lock table grade in exclusive mode")
            time.sleep(seconds)
            other.execute("rollback")
        return True
    with contextlib.closing(sqlite3.connect(scene.course.folder / "gradebook.db", timeout=20, isolation_level=None)) as other:
        other.execute("begin exclusive")
        time.sleep(seconds)
        other.execute("rollback")
    return True


def read_only(scene):
    """``autograded/`` cannot be written until the grader has ended. Root may write anywhere but on a read-only mount."""
    place = scene.course.folder / "autograded"
    place.mkdir(exist_ok=True)
    if os.geteuid() != 0:
        place.chmod(0o555)
        for student in place.iterdir():
            student.chmod(0o555)
        scene.undo.callback(lambda: [folder.chmod(0o755) for folder in (place, *place.iterdir())])
        return True
    if subprocess.run(["mount", "--bind", place, place], check=False, capture_output=True).returncode:
        return False
    scene.undo.callback(subprocess.run, ["umount", "-l", place], check=True)
    return subprocess.run(["mount", "-o", "remount,bind,ro", place], check=False, capture_output=True).returncode == 0


def second_grader(scene):
    """Somebody else starts a grader on the same course."""
    scene.others.append(scene.start())
    return True


def server_crashed(scene):
    """PostgreSQL ends without a word and is started again."""
    if not hasattr(scene.course, "server"):
        return False
    scene.course.server.stop()
    time.sleep(scene.chance.uniform(0, 0.5))
    scene.course.server.start()
    return True


FAULTS = {
    "grader killed": grader_killed,
    "grader terminated or interrupted": grader_terminated,
    "worker killed": worker_killed,
    "sandbox killed": sandbox_killed,
    "learner's process killed": learner_killed,
    "grader stopped and continued": stopped_and_continued,
    "disk full": disk_full,
    "file too large": None,  # a limit that the grader starts with
    "gradebook locked": database_locked,
    "autograded/ read-only": read_only,
    "second grader": second_grader,
    "database server crashed": server_crashed,
}


def limited(chance):
    """In a grader that starts: no file may grow beyond a size that is somewhere among those of a course."""
    most = chance.choice([1000, 3000, 6000, 20_000, 100_000, 200_000])
    resource.setrlimit(resource.RLIMIT_FSIZE, (most, resource.RLIM_INFINITY))


def unlimited():
    """When it has ended, what it says may be written."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
