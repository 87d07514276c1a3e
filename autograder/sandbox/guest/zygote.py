"""The process that every notebook's process is cloned from: numpy, plotly and IPython are already imported in it.

It never sees a submission, a reference or an answer (what is once in its memory would be inherited by every later child), it
starts no thread, and it stops when the trusted side closes the control socket. What it is told of an assignment is what all
learners were given: the code cells of the released notebook, which are read here once.
"""

from __future__ import annotations

import contextlib
import gc
import importlib
import json
import linecache
import os
import select
import shutil
import signal
import socket
import sys
import warnings
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from autograder.sandbox import system
from autograder.sandbox.guest import child, confine, figures, rehearsal, seccomp, tracebacks
from autograder.sandbox.guest.peer import NoAnswer
from autograder.sandbox.guest.shell import Shell

NUMPY = ("numpy.random", "numpy.linalg", "numpy.polynomial", "numpy.ma")  # numpy loads these when they are first used
SHOWING = ("psutil", "autograder")  # plotly asks the one how it was started; the other is the learners' own


def main(arguments: str) -> None:
    """Prepare, say that it is ready, then clone a child for each request. ``arguments`` is JSON from the launcher."""
    linecache.cache.pop("<string>", None)  # our own command line, which Python 3.13 would show as a line of what exec() runs
    gc.disable()  # until all is loaded: nearly nothing of it is garbage, and what little there is may stay
    settings = json.loads(arguments)
    if sys.version != settings["version"]:
        raise RuntimeError(
            f"inside runs Python {sys.version}, outside {settings['version']}: another libpython was found first"
        )
    control = socket.socket(fileno=settings["control"])
    zygote = Zygote(control, settings["level"], settings["preload"])
    control.send(json.dumps({"ready": True, "compiled": _compiled()}).encode())
    zygote.serve()
    os._exit(0)  # there is nothing to put in order: what runs in here ends with this process


class Zygote:
    """Clones children and tells the trusted side how each of them ended."""

    def __init__(self, control: socket.socket, level: str, preload: list[str]) -> None:
        self.control, self.level = control, level
        self.jobs: dict[int, tuple[int, socket.socket, str]] = {}  # by pidfd: pid, socket for the report, scratch folder
        self.abandoned: dict[int, int] = {}  # pidfds by the socket for the report: when its other end is closed, nobody asks
        self.poller = select.poll()
        self.poller.register(control, select.POLLIN)
        self.count = 0
        self.tried = False  # the first child, which the trusted side waits for, has ended
        self.warm = False  # the first step of what is left is done: every child but the first is cloned after it
        self.programme = seccomp.programme(shared=level == "A-")
        self.tid_address = system.thread_id_address()
        self.shell = Shell.for_notebooks()
        _warm_up(self.shell, preload)
        self.left: Iterator[None] | None = _left(self.shell)  # to be done between one request and the next
        child.set_environment(confine.SCRATCH)
        if os.path.isdir("/proc/self/task") and len(os.listdir("/proc/self/task")) > 1:
            raise RuntimeError("a thread runs in the zygote; clone would leave its locks held for ever")
        gc.freeze()  # objects from before the clone are not touched by the child's collector, so their pages stay shared
        gc.enable()

    def serve(self) -> None:
        """Until the trusted side goes away."""
        while True:
            asked = self.poller.poll(None if self.left is None or not self.tried else 0)
            if not asked:
                self.rehearse_on()
            for descriptor, _ in asked:
                if descriptor in self.jobs:
                    self.report(descriptor)
                    continue
                if descriptor in self.abandoned:
                    self.abandon(descriptor)
                    continue
                if descriptor != self.control.fileno():
                    continue  # of a process that was reported in this round
                message, descriptors, *_ = socket.recv_fds(self.control, 65536, 2, socket.MSG_CMSG_CLOEXEC)
                if not message:
                    return
                if descriptors:
                    if self.count and not self.warm:
                        self.rehearse_on()
                    self.start(json.loads(message), *descriptors)
                else:
                    self.expect(*json.loads(message))

    def start(self, limits: dict[str, Any], job: int, report: int) -> None:
        """Clone one child; ``job`` is its socket to the trusted side, ``report`` ours."""
        reporter = socket.socket(fileno=report)
        self.count += 1
        scratch = confine.SCRATCH
        try:
            if self.level == "A-":
                scratch = f"{confine.SCRATCH}/{self.count}"
                os.mkdir(scratch, 0o700)
            flags = confine.NAMESPACES if self.level == "A" else 0
            pid = system.clone(flags, self.tid_address)
        except OSError as error:
            reporter.send(json.dumps({"refused": str(error)}).encode())
            reporter.close()
            os.close(job)
            return
        if pid == 0:
            try:
                child.main(job, self.level, limits, scratch, self.programme, self.shell)
            finally:
                os._exit(70)
        os.close(job)
        handle = os.pidfd_open(pid)
        self.jobs[handle] = (pid, reporter, scratch)
        self.poller.register(handle, select.POLLIN)
        self.abandoned[reporter.fileno()] = handle
        self.poller.register(reporter, 0)  # a hang-up is always told
        with contextlib.suppress(OSError):
            socket.send_fds(reporter, [b"{}"], [handle])

    def rehearse_on(self) -> None:
        """A step of what is left. A child that is cloned before it is done is only slower."""
        self.warm = True
        gc.disable()
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                next(self.left or iter(()))
        except (Exception, NoAnswer):  # StopIteration among them; whatever fails here fails again in the notebook
            self.left = None
        gc.freeze()
        gc.enable()

    def expect(self, cell: str, number: int) -> None:
        """Read a cell of the notebook that everybody was given: every process cloned from now on finds it read."""
        with warnings.catch_warnings(), contextlib.suppress(Exception):
            warnings.simplefilter("ignore")
            self.shell.expect(cell, number)
        gc.freeze()

    def abandon(self, reporter: int) -> None:
        """End a process whose grader has gone, whatever it is doing."""
        handle = self.abandoned.pop(reporter)
        self.poller.unregister(reporter)
        with contextlib.suppress(OSError):
            signal.pidfd_send_signal(handle, signal.SIGKILL)

    def report(self, handle: int) -> None:
        """A child has ended: tell how, and what it used."""
        self.tried = True
        pid, reporter, scratch = self.jobs.pop(handle)
        self.poller.unregister(handle)
        if self.abandoned.pop(reporter.fileno(), None) is not None:
            self.poller.unregister(reporter)
        os.close(handle)
        _, status, used = os.wait4(pid, 0)
        end = {"status": status, "cpu": used.ru_utime + used.ru_stime, "max_rss": used.ru_maxrss * 1024}
        with reporter, contextlib.suppress(OSError):
            reporter.send(json.dumps(end).encode())
        if scratch != confine.SCRATCH:
            shutil.rmtree(scratch, ignore_errors=True)


def _compiled() -> list[str]:
    """The files of which there is no bytecode: they had to be compiled in here."""
    specs = [spec for module in list(sys.modules.values()) if (spec := getattr(module, "__spec__", None)) is not None]
    return [str(spec.origin) for spec in specs if spec.cached and not os.path.exists(spec.cached)]


def _warm_up(shell: Shell, preload: list[str]) -> None:
    """Import what notebooks will import, and use it once where the work is done at first use.

    Whatever fails here fails again, and is shown, in the notebook that asks for it.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for name in (*NUMPY, *SHOWING, *preload):
            with contextlib.suppress(Exception):
                importlib.import_module(name)
        if "plotly" in sys.modules:
            figures.ask_nbformat_for_its_version_only()
            figures.take_arrays_as_they_are()
            figures.copy_quickly()
        tracebacks.prepare()
        with contextlib.suppress(Exception, NoAnswer):
            rehearsal.rehearse(shell)


def _left(shell: Shell) -> Iterator[None]:
    """What need not be done before the first child, which is only tried: all pictures, then failing cells one by one."""
    for figure in _figures(sys.modules.get("plotly.graph_objects"), sys.modules.get("directrix.plot")):
        with contextlib.suppress(Exception):
            shell.rehearse_showing(figure())
    if "plotly" in sys.modules:
        figures.find_validators_quickly()
        figures.show_at_once(shell)  # from here on; what plotly does itself has been rehearsed
    yield
    yield from rehearsal.failures(shell)


def _figures(go: Any, plot: Any) -> Iterator[Callable[[], Any]]:
    """Pictures of every kind that notebooks draw: what plotly checks values with is made when it is first needed."""

    def saddle(u: Any, w: Any) -> Any:
        return np.stack(np.broadcast_arrays(u, w, u * w), axis=-1)

    if go is not None:
        grid = np.array([[0.0, 1.0], [1.0, 0.0]])
        flat = (go.Scatter, go.Scatter3d, go.Bar, go.Mesh3d, go.Cone)
        traces = [kind(**dict.fromkeys("xyz"[: 2 if kind in (go.Scatter, go.Bar) else 3], grid[0])) for kind in flat]
        traces += [go.Surface(z=grid), go.Contour(z=grid), go.Heatmap(z=grid)]
        line, axis = {"color": "black", "width": 1}, {"title": {"text": "x"}, "range": [0, 1]}
        marked = go.Scatter(x=grid[0], y=grid[1], mode="lines+markers+text", text=["a", "b"], line=line, marker={"size": 3})
        about = {"title": {"text": "a"}, "xaxis": axis, "yaxis": {**axis, "scaleanchor": "x"}, "width": 400, "height": 300}
        scene = {"aspectmode": "data", "camera": {"eye": {"x": 1}}, **{f"{letter}axis": axis for letter in "xyz"}}
        yield lambda: go.Figure([*traces, marked])
        yield lambda: go.Figure(traces).update_layout(**about, scene=scene, margin={"l": 0}, showlegend=False)
        yield (lambda: go.Figure(marked, {"template": "none"}).add_annotation(text="a", x=0, y=0).update_yaxes(visible=False))
    if plot is not None:
        yield lambda: plot.view(saddle)
        yield lambda: plot.view(saddle, square=True, mark=(0.5, 0.5), normals=True, title="a saddle")
        yield lambda: plot.view(saddle, against=saddle)
        yield lambda: plot.view(saddle, net=saddle(*np.meshgrid([0.0, 0.5, 1.0], [0.0, 0.5, 1.0], indexing="ij")))
        yield lambda: plot.view(lambda u: np.stack([u, u, u], axis=-1), curves={"c": saddle(grid[0], grid[1])})
