"""A whole notebook in a real Jupyter kernel: the slow engine, for notebooks that no other way runs.

Each notebook gets a bubblewrap of its own (never as root), with user, pid, mount, network, ipc and uts namespaces, the packages
read-only, a bounded tmpfs, resource limits and a system call filter. Programs may be started in it, so memory and CPU time
are watched from outside, over all its processes, and everything ends with its first one. Only outputs come back, as data that
is checked here; and since the learner's code can write them all, they are for show: see ``autograder.notebook.kernel``.
"""

from __future__ import annotations

import contextlib
import importlib.util
import json
import os
import secrets
import select
import signal
import socket
import subprocess
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from autograder.errors import IsolationError, SandboxError
from autograder.sandbox import messages, outputs, packages, wire
from autograder.sandbox.launcher import enter, kernel_options
from autograder.sandbox.policy import CellResult, Ended, Limits, MiB, Policy
from autograder.sandbox.session import ROOM, checked_files
from autograder.sandbox.view import View, view
from autograder.sandbox.wire import WireError

NEEDED = ("nbclient", "ipykernel")
PROGRAMS = ("/usr/bin", "/bin")  # %%bash and !command; nothing set-uid keeps its power inside
OWN = 512 * MiB  # what nbclient and an idle kernel hold themselves
LOOK = 0.05  # seconds between two looks at what the processes hold
DEPTH = 7
START = "from autograder.sandbox.guest.kernel import main; main(int(sys.argv[1]))"
STATUSES = ("ok", "error", "died")


@dataclass
class KernelRun:
    """What came of a notebook: results by the number of the cell, files it left, and why it was ended if it was."""

    cells: dict[int, CellResult] = field(default_factory=dict)
    files: dict[str, bytes] = field(default_factory=dict)
    ended: Ended | None = None


def available() -> None:
    """Raise unless the packages of a real kernel are installed where the grader runs.

    Raises
    ------
    IsolationError
        Naming what is missing.
    """
    missing = [name for name in NEEDED if importlib.util.find_spec(name) is None]
    if missing:
        raise IsolationError(
            f"the engine jupyter needs {' and '.join(NEEDED)} where the grader runs; missing: {', '.join(missing)}. "
            f"Install them (pip install {' '.join(missing)}), or leave c.Sandbox.engine out"
        )


def run_notebook(
    sources: Sequence[str | None],
    files: Mapping[str, bytes] | None = None,
    *,
    policy: Policy | None = None,
    limits: Limits | None = None,
    environment: Mapping[str, str] | None = None,
    withhold: Sequence[str] = (),
) -> KernelRun:
    """Run the cells of a notebook in a kernel of its own.

    Parameters
    ----------
    sources : sequence of str or None
        One for each cell; None is not run.
    files, environment, withhold
        As for :meth:`.Sandbox.open`.
    limits : Limits
        ``memory`` is for all processes together, beside what an idle kernel holds.

    Raises
    ------
    SandboxError
        If the machine does not give the isolation, or the engine itself fails.
    """
    available()
    policy, limits = policy or Policy(), limits or Limits()
    seen = _view(policy, withhold)
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
    with ours, tempfile.TemporaryFile() as errors:
        with theirs:
            command = seen.python_command(START, str(theirs.fileno()))
            process = enter(seen, lambda: kernel_options(seen, limits.scratch), command, theirs.fileno(), errors)
        watched = _Watched(process, ours, limits)
        run = KernelRun()
        try:
            beside = tuple(packages.without(files or {}, withhold).items())
            request = (beside, tuple((environment or {}).items()), tuple(sources), _settings(limits))
            watched.ask(request)
            watched.answers(run, len(sources))
        except _Over as over:
            run.ended = over.ended
        except WireError as error:
            run.ended = Ended("refused", messages.protocol(error), "protocol")
        finally:
            watched.end()
        if run.ended is not None and run.ended.kind == "died" and not watched.began:
            errors.seek(0)
            said = errors.read(20_000).decode("utf-8", "replace").strip().splitlines()
            raise SandboxError(f"the engine jupyter did not start: {said[-1] if said else 'no word of why'}")
    return run


def _view(policy: Policy, withhold: Sequence[str]) -> View:
    """The view of the policy with the kernel's own packages and programs, without the modules that learners may not import."""
    allowed = policy.packages if policy.packages == "all" else (*policy.packages, *NEEDED)
    seen = view(Policy(packages=allowed, preload=()))
    for place in PROGRAMS:
        if os.path.islink(place):
            seen.links.append((os.readlink(place), place))
        else:
            seen.bind(place, place)
    for folder in packages.site_packages():
        place = next((place for source, place in seen.binds if source == str(folder)), "/packages")
        for path in [path for name in withhold for path in folder.glob(f"{name}*")]:
            if path.name.partition(".")[0].partition("-")[0] in withhold:
                bound = place != "/packages" or (str(path), f"{place}/{path.name}") in seen.binds
                (seen.hidden if path.is_dir() else seen.covered).extend([f"{place}/{path.name}"] if bound else [])
    return seen


def _settings(limits: Limits) -> str:
    return json.dumps({**limits.for_child(), "wall": limits.wall(limits.cell_cpu)})


class _Over(Exception):
    def __init__(self, ended: Ended) -> None:
        self.ended = ended


class _Watched:
    """The processes of one notebook: what they say, and an end to them when they take too much."""

    def __init__(self, process: subprocess.Popen[bytes], link: socket.socket, limits: Limits) -> None:
        self.process, self.link, self.limits = process, link, limits
        self.exchange = secrets.token_bytes(16)
        self.began = False
        self._pidfd = os.pidfd_open(process.pid)
        self._deadline = time.monotonic() + limits.wall(limits.notebook_cpu)
        self._looked = 0.0
        self._cpu: dict[tuple[int, int], float] = {}
        link.setblocking(False)

    def ask(self, request: tuple[object, ...]) -> None:
        """Send the notebook."""
        try:
            body = wire.encode(request, depth=DEPTH)
        except WireError as error:
            raise SandboxError(f"{error} cannot be sent to a notebook") from None
        rest = memoryview(wire.frame(wire.START, self.exchange, body))
        while rest:
            self._wait(select.POLLOUT)
            try:
                rest = rest[self.link.send(rest) :]
            except BlockingIOError:
                continue
            except OSError:
                raise _Over(Ended("died", messages.died(messages.START, 0, 0))) from None

    def answers(self, run: KernelRun, cells: int) -> None:
        """Take what is sent for each cell, at most twice, and the files at the end."""
        limits = self.limits
        most = max(4 * limits.output, limits.scratch) + ROOM
        for _ in range(2 * cells + 1):
            kind, length, exchange = wire.header(self._read(wire.HEADER.size), most)
            answer = wire.decode(self._read(length), depth=DEPTH, items=wire.ITEMS + 4 * limits.files, raw=True)
            self.began = True
            if kind != wire.DONE or exchange != self.exchange or not isinstance(answer, tuple) or not answer:
                raise WireError("an answer to another question")
            number, *rest = answer
            if number == -1 and len(rest) == 1:
                run.files = checked_files(rest[0], limits)
                return
            if type(number) is not int or not 0 <= number < cells or len(rest) != 2 or rest[0] not in STATUSES:
                raise WireError("a cell's result of no known form")
            shown = [output for output, _ in outputs.outputs(rest[1], limits.output, limits.outputs)]
            run.cells[number] = CellResult(shown, None, rest[0])
        raise WireError("more answers than cells")

    def _read(self, count: int) -> bytes:
        data = bytearray()
        while len(data) < count:
            self._wait(select.POLLIN)
            try:
                part = self.link.recv(min(count - len(data), 2**20))
            except BlockingIOError:
                continue
            except OSError:
                part = b""
            if not part:
                raise _Over(Ended("died", messages.closed(messages.CELL)))
            data += part
        return bytes(data)

    def _wait(self, event: int) -> None:
        """Until the socket is ready; now and then look at what the processes take."""
        poll = select.poll()
        poll.register(self.link, event)
        while True:
            now = time.monotonic()
            if now > self._deadline:
                raise _Over(Ended("timeout", messages.notebook_time(self.limits.notebook_cpu), "wall"))
            if now > self._looked + LOOK:
                self._look()
                self._looked = time.monotonic()
            if poll.poll(LOOK * 1000):
                return

    def _look(self) -> None:
        held, now = 0, 0.0
        processes = list(tree(self.process.pid))
        for process in processes:
            key = (process.pid, process.started)
            self._cpu[key] = max(self._cpu.get(key, 0.0), process.cpu)
            held, now = held + process.rss, now + process.cpu + process.children_cpu
        most = self.limits.memory + OWN
        if held > most and sum(proportional(process) for process in processes) > most:
            raise _Over(Ended("memory", messages.memory(messages.CELL, self.limits.memory)))
        if max(now, sum(self._cpu.values())) > self.limits.notebook_cpu:
            raise _Over(Ended("timeout", messages.notebook_time(self.limits.notebook_cpu), "notebook"))

    def end(self) -> None:
        """Kill bubblewrap, and with it the first process of the pid namespace, and with that all others."""
        with contextlib.suppress(OSError):
            signal.pidfd_send_signal(self._pidfd, signal.SIGKILL)
        os.close(self._pidfd)
        self.process.wait()


@dataclass(frozen=True)
class Seen:
    """One process as /proc shows it: CPU seconds of its own and of the children it has waited for, resident bytes."""

    pid: int
    started: int
    cpu: float
    children_cpu: float
    rss: int


def proportional(process: Seen) -> int:
    """Resident bytes of a process, those that it shares divided among those that share them; none of one that has ended."""
    try:
        for line in Path(f"/proc/{process.pid}/smaps_rollup").read_text("ascii").splitlines():
            if line.startswith("Pss:"):
                return int(line.split()[1]) * 1024
    except (FileNotFoundError, ProcessLookupError):
        return 0
    except OSError:  # it may not be read: then what is shared counts for each
        pass
    return process.rss


def tree(pid: int) -> Iterator[Seen]:
    """A process and all that descend from it, as far as they are there while one looks."""
    tick, page = os.sysconf("SC_CLK_TCK"), os.sysconf("SC_PAGE_SIZE")
    todo, met = [pid], set()
    while todo:
        pid = todo.pop()
        if pid in met:
            continue
        met.add(pid)
        with contextlib.suppress(OSError, ValueError, IndexError):
            fields = Path(f"/proc/{pid}/stat").read_text("utf-8", "replace").rpartition(")")[2].split()
            user, system, user_below, system_below = map(int, fields[11:15])
            yield Seen(
                pid, int(fields[19]), (user + system) / tick, (user_below + system_below) / tick, int(fields[21]) * page
            )  # fmt: skip
            for thread in os.listdir(f"/proc/{pid}/task"):
                todo += map(int, Path(f"/proc/{pid}/task/{thread}/children").read_text("ascii").split())
