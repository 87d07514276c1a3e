"""What a sandbox allows and what came of it: plain frozen values."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal

MiB = 2**20
CellStatus = Literal["ok", "error", "timeout", "memory", "died", "refused"]


@dataclass(frozen=True)
class Policy:
    """What learners' code finds in the sandbox.

    Attributes
    ----------
    packages : tuple of str, or "all"
        Distributions or import names, each with all it requires. "all" is everything installed except directrix and
        autograder, for ordinary nbgrader courses. IPython and numpy are always there.
    preload : tuple of str
        Modules that the zygote imports once, so that no notebook waits for them. Those that are not there are left out.
    """

    packages: tuple[str, ...] | Literal["all"] = ("numpy", "plotly")
    preload: tuple[str, ...] = ("plotly.graph_objects", "directrix.plot")


@dataclass(frozen=True)
class Limits:
    """What a notebook may use. Times are CPU seconds as the grader measures them; bytes elsewhere.

    A cell or call may take three times its CPU time plus ``patience`` seconds by the clock: marks must not depend on how
    busy the machine is. ``memory`` is what code may ask for beyond what the interpreter already has; ``output``
    (characters) and ``outputs`` bound what one cell shows, ``answer`` what one call returns, ``file`` one file,
    ``scratch`` all files together, ``files`` their number, ``threads`` the threads at once. Processes are never allowed.
    """

    cell_cpu: float = 20.0
    call_cpu: float = 5.0
    notebook_cpu: float = 120.0
    patience: float = 10.0
    memory: int = 1024 * MiB
    output: int = 1 * MiB
    outputs: int = 200
    answer: int = 16 * MiB
    file: int = 32 * MiB
    scratch: int = 64 * MiB
    files: int = 1000
    threads: int = 64

    def wall(self, cpu: float) -> float:
        """Seconds by the clock for so many CPU seconds."""
        return 3 * cpu + self.patience

    def for_child(self) -> dict[str, float | int]:
        """What the child itself enforces, as plain numbers."""
        return dict(vars(self))


@dataclass(frozen=True)
class CellResult:
    """What came of a cell: validated nbformat outputs, its number, how it ended, and a note for the learner if not well."""

    outputs: list[dict[str, Any]] = field(default_factory=list)
    execution_count: int | None = None
    status: CellStatus = "ok"
    note: str = ""


@dataclass(frozen=True)
class Usage:
    """What a session has used so far: CPU and clock seconds, and the most memory it ever held (bytes)."""

    cpu_seconds: float
    wall_seconds: float
    max_rss: int


@dataclass(frozen=True)
class Ended:
    """Why a session is over.

    ``limit`` says which limit ended it ("cpu", "wall", "notebook", "protocol", or empty): what only ran out of wall time
    may be the fault of a busy machine.
    """

    kind: Literal["timeout", "memory", "died", "refused"]
    message: str
    limit: Literal["", "cpu", "wall", "notebook", "protocol"] = ""
