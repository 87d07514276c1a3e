"""How many notebooks fit into this machine's memory at once, if each takes all that it may.

Learners' processes are the first that the kernel ends when memory runs short (their oom_score_adj is the highest); but a mark
must not depend on who else was greedy, so the sum of the limits fits.
"""

from __future__ import annotations

import contextlib
from dataclasses import dataclass
from pathlib import Path

MiB = 2**20
OWN = 256 * MiB  # of a worker and of what a notebook's process has before it asks for anything
LEAST = 256 * MiB  # below this much, numpy and a figure do not fit
CGROUPS = (
    ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"),
    ("/sys/fs/cgroup/memory/memory.limit_in_bytes", "/sys/fs/cgroup/memory/memory.usage_in_bytes"),
)


@dataclass(frozen=True)
class Fit:
    """Workers, bytes that each notebook's process may take, and a sentence if either is less than was asked for."""

    workers: int
    memory: int
    note: str = ""


def fit(workers: int, memory: int, available: int, *, processes: int = 1) -> Fit:
    """As many workers as fit with the whole limit; where not even one does, one with a lower limit.

    Parameters
    ----------
    memory : int
        What one notebook's process may take, in bytes.
    available : int
        What this machine, or this container, has left.
    processes : int
        Of one notebook: 2 where its tests run apart.
    """
    each = processes * memory + OWN
    if workers * each <= available:
        return Fit(workers, memory)
    least = f"{available // MiB} MiB of memory are free, and a notebook may take {processes * memory // MiB} MiB"
    if each <= available:
        fewer = int(available // each)
        return Fit(fewer, memory, f"{least}: {fewer} at a time instead of {workers}")
    lower = max(LEAST, (available - OWN) // processes)
    return Fit(1, min(memory, lower), f"{least}: one at a time, with {min(memory, lower) // MiB} MiB for each of its processes")


def available() -> int:
    """Bytes that are free on this machine, or left in this control group if that is less."""
    fields = dict(line.split(":", 1) for line in Path("/proc/meminfo").read_text("ascii").splitlines())
    found = int(fields["MemAvailable"].split()[0]) * 1024
    for limit, used in CGROUPS:
        with contextlib.suppress(OSError, ValueError):  # no such file, or "max"
            found = min(found, max(0, int(Path(limit).read_text("ascii")) - int(Path(used).read_text("ascii"))))
    return found
