"""Runs a learner's own notebook in a Jupyter kernel, as JupyterLab would, and gathers what its checks said."""

from __future__ import annotations

import asyncio
import contextlib
import math
import os
import re
import shlex
import signal
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellTimeoutError, DeadKernelError
from rich.console import Console
from rich.table import Table

from autograder.errors import SubmissionError

CHECK = re.compile(r"check\((?P<name>[A-Za-z_]\w*)\)")


@dataclass(frozen=True)
class Checked:
    """What one check cell said: its points, and the card as text."""

    exercise: str
    points: float
    available: float
    text: str


@dataclass(frozen=True)
class OwnWork:
    """The checks of one notebook, and why it stopped early if it did."""

    notebook: str
    checks: tuple[Checked, ...]
    stopped: str = ""

    @property
    def complete(self) -> bool:
        """Everything was checked and is right."""
        return not self.stopped and bool(self.checks) and all(c.points >= c.available for c in self.checks)

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self) | {"complete": self.complete}


class Client(NotebookClient):
    """nbclient, which at Ctrl-C ends its kernel and then fails in its own code; here the run is what ends."""

    interrupted = False

    async def async_start_new_kernel(self, **kwargs: Any) -> None:
        """Start the kernel. It comes right after nbclient has said what Ctrl-C does."""
        task = asyncio.current_task()
        assert task is not None

        def stop() -> None:
            self.interrupted = True
            self.shutdown_kernel = "immediate"  # one that is asked to end prints how it was disturbed
            task.cancel()

        with contextlib.suppress(NotImplementedError, RuntimeError):  # no signals on Windows, nor outside the main thread
            asyncio.get_running_loop().add_signal_handler(signal.SIGINT, stop)
        await super().async_start_new_kernel(**kwargs)


def run(path: Path, *, timeout: int, environment: Mapping[str, str] | None = None) -> OwnWork:
    """Execute a notebook and read the outputs of its ``check(...)`` cells. The file itself is left as it is.

    ``environment`` has variables for its kernel beyond those of this process.
    """
    try:
        notebook = nbformat.read(path, as_version=4)  # type: ignore[no-untyped-call]
    except FileNotFoundError:
        raise SubmissionError(f"no such notebook: {path}") from None
    except IsADirectoryError:
        inside = sorted(path.glob("*.ipynb"))
        try_this = f"name its notebook: directrix check {shlex.quote(str(inside[0]))}" if inside else "it has no notebook in it"
        raise SubmissionError(f"{path} is a folder; {try_this}") from None
    except Exception as error:
        raise SubmissionError(f"{path} is not a notebook that can be read: {error}") from error
    stopped = ""
    client = Client(
        notebook,
        timeout=timeout,
        allow_errors=True,
        kernel_name="python3",
        extra_arguments=["--log-level=ERROR"],
        resources={"metadata": {"path": str(path.parent)}},
    )
    try:
        client.execute(env={**os.environ, **(environment or {})})
    except (asyncio.CancelledError, DeadKernelError) as error:
        if client.interrupted:
            raise KeyboardInterrupt from None
        if not isinstance(error, DeadKernelError):
            raise
        stopped = "the kernel ended while a cell was running, so the cells after it were not run; look for exit() or for memory"
    except CellTimeoutError:
        stopped = (
            f"a cell took more than {timeout} seconds, so the cells after it were not run; look for a loop that never ends"
        )
    return OwnWork(str(path), tuple(_checks(notebook)), stopped)


def _checks(notebook: Any) -> list[Checked]:
    found = []
    for cell in notebook.cells:
        graded = cell.metadata.get("nbgrader", {})
        match = CHECK.fullmatch(cell.source.strip())
        if cell.cell_type != "code" or not graded.get("grade") or not match:
            continue
        shown = [
            output for output in cell.get("outputs", []) if output.output_type in ("display_data", "execute_result", "error")
        ]
        points = next((_number(output) for output in shown if output.output_type == "execute_result"), 0.0)
        texts = [output.data.get("text/plain", "") for output in shown if output.output_type == "display_data"]
        text = texts[0] if texts else next((output.evalue for output in shown if output.output_type == "error"), "")
        found.append(Checked(match["name"], points, float(graded.get("points", 0)), text.strip()))
    return found


def _number(output: Any) -> float:
    try:
        value = float(output.data.get("text/plain", ""))
    except ValueError:
        return 0.0
    return value if math.isfinite(value) else 0.0


def show(result: OwnWork, console: Console) -> None:
    """Print the cards as text, then a table."""
    for checked in result.checks:
        console.rule(checked.exercise)
        console.print(checked.text, markup=False, highlight=False)
    table = Table(title=result.notebook, title_justify="left")
    table.add_column("exercise")
    table.add_column("points", justify="right")
    for checked in result.checks:
        table.add_row(checked.exercise, f"{checked.points:g} of {checked.available:g}")
    console.print(table)
    if result.stopped:
        console.print(f"Stopped: {result.stopped}.", markup=False)
    elif not result.checks:
        console.print("This notebook has no graded check(...) cell.", markup=False)
