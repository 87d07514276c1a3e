"""Runs a notebook in a real Jupyter kernel, inside a bubblewrap of its own: nbclient, the kernel and a few processes.

What the kernel says is the learner's word, and the learner's code can reach this process too. So nothing that comes out of
here is believed: it is shown, and marks come from elsewhere.
"""

from __future__ import annotations

import asyncio
import json
import math
import os
import socket
import sys
from collections import Counter
from typing import Any, NoReturn

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import DeadKernelError

from autograder.sandbox import system, wire
from autograder.sandbox.guest import child, confine, seccomp, words
from autograder.sandbox.guest.recorder import bundled, many, more, sizes_of

PATH = "/python/bin:/usr/bin:/bin"
SHOWS = ("stream", "display_data", "execute_result", "update_display_data", "error")


def main(descriptor: int) -> NoReturn:
    """Confine this process and all it will start, run the notebook, send each cell's outputs, then the files, and end."""
    link = socket.socket(fileno=descriptor)
    server = child.Server(link, {}, None, f"{confine.SCRATCH}/work")  # type: ignore[arg-type]
    exchange, (files, environment, sources, settings) = server.first()
    server.limits = json.loads(settings)
    _prepare(files, environment, server.limits)

    def send(number: int, *answer: Any) -> None:
        link.sendall(wire.frame(wire.DONE, exchange, wire.encode((number, *answer), depth=child.RESULT_DEPTH + 1)))

    asyncio.run(_run(sources, server.limits, send))
    send(-1, tuple(server.files()))
    os._exit(0)


def _prepare(files: Any, environment: Any, limits: dict[str, Any]) -> None:
    """Folders, environment and the walls that bubblewrap does not put up. What is started later inherits them."""
    for folder in ("work", "tmp", "home"):
        os.mkdir(f"{confine.SCRATCH}/{folder}", 0o700)
    os.chdir(f"{confine.SCRATCH}/work")
    child.lay_out(files)
    child.set_environment(confine.SCRATCH)
    os.environ.update(environment)
    words.install()
    child.as_a_notebook()
    packages = ":".join(place for place in sys.path if place.startswith(("/packages", "/guest")))
    os.environ.update(
        PATH=PATH, PYTHONHOME="/python", PYTHONPATH=packages, LD_LIBRARY_PATH="/python/lib", MALLOC_ARENA_MAX="2",
        SHELL="/bin/bash", JUPYTER_PLATFORM_DIRS="1",
    )  # fmt: skip
    confine.limit_resources(limits)
    system.no_new_privileges()
    system.load_filter(seccomp.programme(processes=True))


async def _run(sources: tuple[str | None, ...], limits: dict[str, Any], send: Any) -> None:
    """Run the cells that have a source, one after the other; those of a kernel that has died are not sent."""
    cells = [nbformat.v4.new_code_cell(source or "") for source in sources]  # type: ignore[no-untyped-call]
    notebook = nbformat.v4.new_notebook(cells=cells)  # type: ignore[no-untyped-call]
    client = Client(
        notebook, kernel_name="python3", timeout=math.ceil(limits["wall"]), interrupt_on_timeout=True, allow_errors=True,
        error_on_timeout={"ename": "TimeLimit", "evalue": words.say("clock", seconds=f"{limits['wall']:g}"), "traceback": []},
        startup_timeout=60, record_timing=False, store_widget_state=False,
    )  # fmt: skip
    client.room, client.count = int(limits["output"]), int(limits["outputs"])
    manager = client.create_kernel_manager()
    manager.transport, manager.ip = "ipc", f"{confine.SCRATCH}/tmp/kernel"
    sent: dict[int, Any] = {}
    async with client.async_setup_kernel():
        for number, source in enumerate(sources):
            if source is None:
                continue
            try:
                await client.async_execute_cell(cells[number], number)
            except DeadKernelError:
                send(number, "died", _plain(cells[number].outputs))
                return
            sent[number] = _plain(cells[number].outputs)
            failed = any(output[0] == "error" for output in sent[number])
            send(number, "error" if failed else "ok", sent[number])
        for number, before in sent.items():  # a later cell may have updated a display of an earlier one
            if (now := _plain(cells[number].outputs)) != before:
                send(number, "error" if any(output[0] == "error" for output in now) else "ok", now)


class Client(NotebookClient):
    """nbclient, with an end to what one cell may show."""

    room = count = 0

    def process_message(self, msg: dict[str, Any], cell: Any, cell_index: int) -> Any:
        """Take a message of the kernel unless the cell has shown too much."""
        if msg["msg_type"] in SHOWS:
            used = self.__dict__.setdefault("used", Counter())
            if used[cell_index] > self.room or len(cell.outputs) > self.count:
                return None
            used[cell_index] += len(json.dumps(msg["content"], default=str))
            note = more(self.room) if used[cell_index] > self.room else ""
            note = note or (many(self.count) if len(cell.outputs) >= self.count else "")
            if note:
                used[cell_index] = self.room + 1
                cell.outputs.append(nbformat.from_dict({"output_type": "stream", "name": "stdout", "text": note}))  # type: ignore[no-untyped-call]
                return None
        return super().process_message(msg, cell, cell_index)


def _plain(outputs: list[Any]) -> tuple[Any, ...]:
    """Outputs in the form in which a notebook's process tells them: see :meth:`.shell.Shell.shown`."""
    found: list[Any] = []
    for output in outputs:
        kind = output.output_type
        if kind == "stream" and found and found[-1][:2] == (kind, output.name):
            found[-1] = (kind, output.name, found[-1][2] + output.text)
        elif kind == "stream":
            found.append((kind, output.name, output.text))
        elif kind == "error":
            found.append((kind, output.ename, output.evalue, tuple(output.traceback)))
        else:
            found.append((kind, tuple(bundled(output.data)), sizes_of(output.metadata), ""))
    return tuple(found)
