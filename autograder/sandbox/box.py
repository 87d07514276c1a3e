"""A sandbox: one zygote, and as many sessions at once as are asked for."""

from __future__ import annotations

import contextlib
import json
import os
import select
import socket
import stat
import subprocess
import threading
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Literal

from autograder.errors import IsolationError, SandboxError
from autograder.sandbox import ahead, bytecode, packages
from autograder.sandbox.launcher import Launched, launch
from autograder.sandbox.policy import Limits, Policy
from autograder.sandbox.process import Process
from autograder.sandbox.session import Session

Level = Literal["A", "A-"]
LEVELS: dict[str, str] = {
    "A": "bubblewrap, own namespaces for every notebook, Landlock, system call filter, resource limits",
    "A-": "bubblewrap around all notebooks, Landlock between them, system call filter, resource limits; no file may be written",
    "B": "Landlock, system call filter and resource limits without namespaces",
    "C": "what macOS gives",
    "D": "no isolation",
}
START_SECONDS = 60.0
MESSAGE = 2**16  # bytes that the zygote takes at once
GIVEN = 2**17  # bytes of cells that it reads for all; what it makes of a byte may take three hundred


class Sandbox:
    """Starts a zygote at the isolation level asked for, and opens sessions from it. ``open`` may be called from many threads.

    Parameters
    ----------
    policy : Policy
        What learners' code finds inside.
    level : {"A", "A-"}
        The isolation wanted; there is no fall back to a weaker one.
    bubblewrap : {"system", "wheel"}, optional
        Insist on one of the two programs; by default the system's goes first.

    Raises
    ------
    IsolationError
        If this machine does not give that level; the message says what to do.
    """

    def __init__(self, policy: Policy | None = None, level: str = "A", *, bubblewrap: str | None = None) -> None:
        if level not in ("A", "A-"):
            what = f"level {level} ({LEVELS[level]})" if level in LEVELS else f"level {level!r}"
            raise IsolationError(
                f"{what} is not offered: notebooks are run at level A or A- only. `directrix doctor` says which you have"
            )
        self.policy = policy or Policy()
        self.level = level
        self._bubblewrap = bubblewrap
        self.ahead = False  # keep one process ready for the next notebook; for those who open one after the other
        self._room = GIVEN
        self._ready: _Order | None = None
        self._sessions: set[Session] = set()
        self._lock = threading.Lock()
        self._process, self._control, self._errors, shown = self._launch()
        try:
            self._start(shown)
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Sandbox:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    @property
    def descriptor(self) -> int:
        """The open file that a forked process needs to open sessions here too."""
        return self._control.fileno()

    @property
    def alive(self) -> bool:
        """Whether the zygote runs, as far as the process that made this sandbox knows.

        Who waits for its end may be told late on a busy machine; its socket is closed before anybody can have met a failure.
        """
        if not self._keeper.is_alive():
            return False
        end = select.poll()
        end.register(self._control, 0)  # only of its being closed
        return not end.poll(0)

    def open(
        self,
        files: Mapping[str, bytes] | Path | str | None = None,
        limits: Limits | None = None,
        *,
        environment: Mapping[str, str] | None = None,
        seed: int = 0,
        withhold: Sequence[str] = (),
        peer: socket.socket | None = None,
    ) -> Session:
        """A fresh process for one notebook.

        Parameters
        ----------
        files : mapping of relative path to content, or a folder
            Copied into the notebook's working folder (of a folder: regular files, links are not followed).
        environment : mapping
            Further environment variables.
        seed : int
            Where ``random`` and ``numpy.random`` start.
        withhold : sequence of str
            Top-level modules that this notebook finds neither to import nor to read, though the policy shows them, or they are
            among the files. Level A.
        peer : socket, optional
            Its socket to another notebook's process: see :meth:`pair`.

        Raises
        ------
        SandboxError
            If the zygote or the new process fails, or a module cannot be withheld.
        """
        limits = limits or Limits()
        content = _read_folder(Path(files), limits) if isinstance(files, str | Path) else dict(files or {})
        content = packages.without(content, withhold)
        size = sum(map(len, content.values()))
        if size > limits.scratch or len(content) > limits.files or any(len(data) > limits.file for data in content.values()):
            raise SandboxError(
                f"the files of this notebook ({len(content)} of {size} bytes in all) do not fit its scratch folder"
            )
        session = self._clone(limits)
        try:
            session.start(content, dict(environment or {}), seed, tuple(withhold), peer)
        except BaseException:
            session.close()
            raise
        with self._lock:
            self._sessions = {open_one for open_one in self._sessions if open_one.alive} | {session}
        return session

    def pair(
        self,
        files: Mapping[str, bytes] | Path | str | None = None,
        limits: Limits | None = None,
        *,
        environment: Mapping[str, str] | None = None,
        seed: int = 0,
        withhold: Sequence[str] = (),
    ) -> tuple[Session, Session]:
        """Two fresh processes, the learner's and one for the tests, with a socket between them that nobody else holds.

        Both find the same files and modules, but for what ``withhold`` takes from the learner's. See :meth:`Session.run_apart`.
        """
        ends = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
        with ends[0], ends[1]:
            learner = self.open(files, limits, environment=environment, seed=seed, withhold=withhold, peer=ends[0])
            try:
                tests = self.open(files, limits, environment=environment, seed=seed, peer=ends[1])
            except BaseException:
                learner.close()
                raise
        return learner, tests

    def expect(self, cells: Iterable[str]) -> None:
        """Have cells read once for all notebooks that are opened from now on, which are likely to hold them, in this order.

        Each of their processes has them in its memory: only what all learners were given may be told here.
        """
        for number, cell in enumerate(cells, 1):
            message = json.dumps([cell, number]).encode()
            if len(message) > min(MESSAGE, self._room):  # each notebook reads this one as ever
                continue
            self._room -= len(message)
            with contextlib.suppress(OSError):  # the zygote is gone: who opens a notebook is told
                self._control.send(message)

    def close(self) -> None:
        """End every session and the zygote."""
        for session in self._sessions:
            session.close()
        if self._ready is not None:
            self._ready.cancel()
        self._control.close()
        self._keeper.join(10)
        if self._keeper.is_alive():
            self._process.kill()
            self._keeper.join()
        self._errors.close()

    def _launch(self) -> Launched:
        """The zygote that was begun ahead if it is the right one, else a new one.

        It is started and awaited by a thread of its own: bubblewrap dies with the *thread* that started it
        (PR_SET_PDEATHSIG), and the thread that makes this sandbox may be a short-lived one.
        """
        done = threading.Event()
        launched: list[Launched | BaseException] = []

        def keep() -> None:
            try:
                begun = ahead.taken(self.policy, self.level) if self._bubblewrap is None else None
                zygote = begun or launch(self.policy, self.level, self._bubblewrap)
            except BaseException as error:
                launched.append(error)
                return
            else:
                launched.append(zygote)
            finally:
                done.set()
            zygote.process.wait()

        self._keeper = threading.Thread(target=keep, name="sandbox", daemon=True)
        self._keeper.start()
        done.wait()
        if isinstance(launched[0], BaseException):
            raise launched[0]
        return launched[0]

    def _start(self, shown: Mapping[str, str]) -> None:
        """Wait for the zygote's word, and try it."""
        self._control.settimeout(START_SECONDS)
        try:
            ready = self._control.recv(2**18)
        except OSError:
            ready = b""
        if not ready:
            raise IsolationError(self._why_not())
        self._control.settimeout(None)
        self._try_one()
        bytecode.keep(json.loads(ready)["compiled"], shown)

    def _try_one(self) -> None:
        """A level is given only if a child has put up all its walls."""
        try:
            self.open().close()
        except SandboxError as error:
            why = str(error).rstrip(".")
            raise IsolationError(f"level {self.level} is not given on this machine: {why}. {ADVICE}") from None

    def _why_not(self) -> str:
        self._control.close()
        try:
            self._process.wait(5)
        except subprocess.TimeoutExpired:
            self._process.kill()
        self._errors.seek(0)
        said = self._errors.read(20_000).decode("utf-8", "replace").strip().splitlines()
        why = said[-1].rstrip(".") if said else "the sandbox did not start"
        return f"level {self.level} is not given on this machine: {why}. {ADVICE}"

    def _clone(self, limits: Limits) -> Session:
        """A process: the one that was ordered ahead, where there is one with these limits, else a new one."""
        try:
            with self._lock:
                order, self._ready = self._ready, None
            if order is not None and not order.fits(limits):
                order.cancel()
                order = None
            order = order or _Order(self._control, limits)
            if self.ahead:
                following = _Order(self._control, limits)
                with self._lock:
                    surplus, self._ready = self._ready, following
                if surplus is not None:  # another thread has ordered one too
                    surplus.cancel()
            return Session(order.process(self.level), limits)
        except OSError as error:
            raise SandboxError(f"the sandbox is gone: {error}") from None


class _Order:
    """A process asked of the zygote, which clones it while the one who ordered it does something else.

    It has confined nothing and knows nothing until it is given a notebook's files. It belongs to the process that ordered it:
    in a fork of that, it is nobody's, or two graders would share one learner's process.
    """

    def __init__(self, control: socket.socket, limits: Limits) -> None:
        self.limits, self.owner = limits, os.getpid()
        self.link, job = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
        self.report, reporter = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        try:
            with job, reporter:
                socket.send_fds(control, [json.dumps(limits.for_child()).encode()], [job.fileno(), reporter.fileno()])
        except BaseException:
            self.cancel()
            raise

    def fits(self, limits: Limits) -> bool:
        """Whether it may be used here, under these limits."""
        return self.limits == limits and self.owner == os.getpid()

    def process(self, level: str) -> Process:
        """The process, as soon as it is there."""
        pidfds: list[int] = []
        try:
            self.report.settimeout(START_SECONDS)
            said, pidfds, *_ = socket.recv_fds(self.report, 4096, 1, socket.MSG_CMSG_CLOEXEC)
            if not pidfds:
                why = json.loads(said or b"{}").get("refused", "the zygote has died")
                raise SandboxError(f"no process for a notebook: {why}")
            return Process(self.link, self.report, pidfds[0], self.limits, level)
        except BaseException:
            self.cancel()
            for pidfd in pidfds:
                os.close(pidfd)
            raise

    def cancel(self) -> None:
        """Let go of it; the zygote ends what nobody holds."""
        self.link.close()
        self.report.close()


ADVICE = "`directrix doctor` shows what is missing and what to do"


def _read_folder(folder: Path, limits: Limits) -> dict[str, bytes]:
    """Regular files of a folder, opened without following links."""
    found: dict[str, bytes] = {}
    for place, folders, names in os.walk(folder):
        folders.sort()
        for name in sorted(names):
            path = os.path.join(place, name)
            if not stat.S_ISREG(os.lstat(path).st_mode):
                continue
            descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
            with open(descriptor, "rb") as file:
                if stat.S_ISREG(os.fstat(descriptor).st_mode):
                    found[os.path.relpath(path, folder)] = file.read(limits.file + 1)
    return found
