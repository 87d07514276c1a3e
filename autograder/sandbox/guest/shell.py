"""Runs cells as a Jupyter kernel would, without a kernel: an IPython shell all of whose hooks end in a recorder."""

from __future__ import annotations

import asyncio
import builtins
import getpass
import io
import linecache
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any, ClassVar

from IPython.core import page
from IPython.core.displaypub import DisplayPublisher
from IPython.core.error import StdinNotImplementedError
from traitlets import Type
from traitlets.config import Config

from autograder.sandbox.guest.answers import TimeLimitExceeded
from autograder.sandbox.guest.reading import Compiler, Plainly
from autograder.sandbox.guest.recorder import Printed, Recorder
from autograder.sandbox.guest.unwatched import UnwatchedHistory, UnwatchedHook, UnwatchedShell
from autograder.sandbox.guest.words import say


class Publisher(DisplayPublisher):
    """Records ``display(...)``."""

    def publish(self, data: Any, metadata: Any = None, *_: Any, transient: Any = None, update: bool = False, **__: Any) -> None:
        """Record one display or its update."""
        display_id = (transient or {}).get("display_id")
        shell: Any = self.shell
        if update:
            shell.recorder.update(data, metadata, display_id)
        else:
            shell.recorder.display("display_data", data, metadata, display_id)

    def clear_output(self, wait: bool = False) -> None:
        """Record that the outputs so far are cleared."""
        shell: Any = self.shell
        shell.recorder.clear(wait)


class Result(UnwatchedHook):
    """Records the value of a cell's last expression."""

    shown: tuple[Any, Any] | None = None

    def start_displayhook(self) -> None:
        """Nothing to open."""
        self.shown = None

    def quiet(self) -> bool:
        """Whether the cell ends with a semicolon. IPython takes it apart into tokens to find out."""
        shell: Any = self.shell
        cells = shell.history_manager.input_hist_parsed
        return bool(cells) and ";" in cells[-1] and super().quiet()  # type: ignore[no-untyped-call]

    def write_output_prompt(self) -> None:
        """There is no prompt."""

    def write_format_data(self, format_dict: Any, md_dict: Any = None) -> None:
        """Keep the formatted value until the hook is done."""
        self.shown = (format_dict, md_dict)

    def finish_displayhook(self) -> None:
        """Record it."""
        if self.shown:
            shell: Any = self.shell
            shell.recorder.display("execute_result", *self.shown)
        self.shown = None


class Shell(UnwatchedShell):
    """An IPython shell without terminal, kernel, history file or threads."""

    displayhook_class = Type(Result)
    display_pub_class = Type(Publisher)
    compiler_class = Type(Compiler)
    kernel: ClassVar[None] = None
    loop: asyncio.AbstractEventLoop | None = None  # made by the first cell: a loop of the zygote would be everybody's

    def __init__(self, **options: Any) -> None:
        self.recorder = Recorder()
        self.number = 0
        self.ran_into: type[BaseException] | None = None
        self.told: tuple[Any, dict[str, Any]] = (None, {})  # the last error that was shown: its class, and what was said of it
        self.read: tuple[str, str] | None = None  # the source of the cell that is to be run, and what it is in Python
        self.plain: str | None = None  # the Python of a cell that awaits nothing
        super().__init__(**options)  # type: ignore[no-untyped-call]
        assert isinstance(self.compile, Compiler)
        self.compiler = self.compile
        self.compiler.transformers = lambda: self.ast_transformers
        self.input_transformer_manager = Plainly(self.compiler)

    @classmethod
    def for_notebooks(cls) -> Shell:
        """The one shell of this process, and its standard streams."""
        settings = Config()
        settings.HistoryManager.enabled = False
        settings.HistoryManager.hist_file = ":memory:"
        settings.InteractiveShell.autoindent = False
        settings.InteractiveShell.xmode = "Context"
        shell = cls.instance(config=settings)
        sys.stdout, sys.stderr = Printed("stdout", shell.recorder), Printed("stderr", shell.recorder)
        sys.stdin = io.StringIO()
        builtins.input, getpass.getpass = _no_input, _no_password
        return shell

    def init_ipython_dir(self, ipython_dir: Any) -> None:
        """There is none."""

    def init_profile_dir(self, profile_dir: Any) -> None:
        """There is no profile."""

    def init_history(self) -> None:
        """What has been run, in memory."""
        self.history_manager = UnwatchedHistory(shell=self, parent=self)
        self.configurables.append(self.history_manager)  # type: ignore[arg-type]

    def init_hooks(self) -> None:
        """``name?`` shows its help below the cell."""
        super().init_hooks()  # type: ignore[no-untyped-call]
        self.set_hook("show_in_pager", page.as_hook(self._page), 99)  # type: ignore[no-untyped-call]

    def init_virtualenv(self) -> None:
        """There is none."""

    def enable_gui(self, gui: Any = None) -> None:
        """No windows here."""

    def ask_exit(self) -> None:
        """``exit()`` and ``quit`` would end a kernel after the cell; the grader runs the cells after it as well."""

    def _page(self, strg: Any, start: int = 0, screen_lines: int = 0, pager_cmd: Any = None) -> None:
        """A kernel shows a pager's text apart from the outputs; nothing of it is kept."""

    def _showtraceback(self, etype: Any, evalue: Any, stb: Any) -> None:
        self.ran_into = etype
        try:
            value = str(evalue)
        except BaseException:  # a learner's own __str__
            value = say("unshown")
        lines = [str(line) for line in stb]
        self.told = etype, {"ename": str(etype.__name__), "evalue": value, "traceback": lines}
        self.recorder.error(str(etype.__name__), value, lines)

    def _format_exception_for_storage(self, exception: BaseException, *more: Any, **options: Any) -> dict[str, Any]:
        """What IPython's history keeps of an error: the traceback that was shown. Formatting it again takes as long as once."""
        kind, told = self.told
        if kind is type(exception):
            return told
        kept: dict[str, Any] = super()._format_exception_for_storage(exception, *more, **options)  # type: ignore[no-untyped-call]
        return kept

    def is_cell(self, filename: str) -> bool:
        """Whether code of that file name came from a cell."""
        return filename in getattr(self.compile, "_filename_map", {}) or filename.startswith("<ipython-input")

    def run(self, source: str, size: int, count: int) -> str:
        """Run one cell, recording what it shows; returns its status."""
        self.recorder.begin(size, count)
        self.ran_into, self.told = None, (None, {})
        self.number = self.execution_count
        if self.loop is None or self.loop.is_closed():
            self.loop = asyncio.new_event_loop()
            asyncio.set_event_loop(self.loop)
        try:
            result = self.loop.run_until_complete(self._run_in_loop(source))
        except (Exception, SystemExit, KeyboardInterrupt):  # a task that ends the loop, not the cell
            self.showtraceback()
            self.printed_by_c()
            return "error"
        self.printed_by_c()
        error = result.error_before_exec or result.error_in_exec
        if isinstance(error, TimeLimitExceeded):
            return "timeout"
        if isinstance(error, MemoryError):
            return "memory"
        return "error" if error is not None or self.ran_into is not None else "ok"

    async def _run_in_loop(self, source: str) -> Any:
        """As a kernel does: every cell finds the loop running, so that a task may outlive the cell that made it."""
        try:
            cell = self.transform_cell(source)
            awaits = self.should_run_async(source, transformed_cell=cell)
            self.read, self.plain = (None, None) if awaits else ((source, cell), cell)
        except Exception:  # run_cell meets it too, and shows it
            awaits = False
        if not awaits:
            return self.run_cell(source, store_history=True)  # type: ignore[no-untyped-call]
        result = await self.run_cell_async(source, store_history=True, transformed_cell=cell)
        self.events.trigger("post_execute")
        self.events.trigger("post_run_cell", result)
        return result

    def transform_cell(self, raw_cell: str) -> str:
        """The cell in Python. What ``_run_in_loop`` has just found out is not worked out again."""
        read, self.read = self.read, None
        if read is not None and read[0] == raw_cell:
            return read[1]
        return super().transform_cell(raw_cell)  # type: ignore[no-any-return, no-untyped-call]

    def should_run_async(
        self, raw_cell: str, *, transformed_cell: str | None = None, preprocessing_exc_tuple: Any = None
    ) -> bool:
        """Whether a cell awaits something: IPython compiles it to find out. Nor is this worked out again."""
        plain, self.plain = self.plain, None
        cell = transformed_cell if preprocessing_exc_tuple is None else None
        if cell is not None and (cell == plain or self.compiler.compile_ahead(cell, self.execution_count)):
            return False
        return super().should_run_async(
            raw_cell, transformed_cell=transformed_cell, preprocessing_exc_tuple=preprocessing_exc_tuple
        )

    def shown(self) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
        """Outputs of the last cell, and updates for displays of earlier cells, as plain tuples."""
        outputs: list[tuple[Any, ...]] = []
        for kind, *rest in self.recorder.outputs:
            if kind == "stream":
                outputs.append((kind, rest[0], "".join(rest[1])))
            elif kind == "error":
                outputs.append((kind, rest[0], rest[1], tuple(rest[2])))
            else:
                outputs.append((kind, tuple(rest[0]), rest[1], rest[2]))
        updates = tuple((kind, tuple(bundle), sizes, name) for kind, bundle, sizes, name in self.recorder.updates.values())
        return tuple(outputs), updates

    def rehearse_showing(self, value: Any) -> None:
        """Show a value to nobody."""
        formatter: Any = self.display_formatter
        self.recorder.silent = True
        try:
            formatter.format(value)
        finally:
            self.recorder.silent = False

    def expect(self, source: str, number: int) -> None:
        """Read a cell that notebooks may hold, most likely with this number, so that each finds it read."""
        self.input_transformer_manager.transform_cell(source)
        self.compiler.keep(source, number)

    def rehearse(self, source: str) -> None:
        """Run a cell that leaves no trace of it; inside :meth:`rehearsing`."""
        running = self._run_in_loop(source)  # nothing in it waits, and a task would take the number of the notebook's first
        with suppress(StopIteration):
            running.send(None)
        self.shown()

    @contextmanager
    def rehearsing(self) -> Iterator[None]:
        """What is done first takes longest, a traceback above all. A notebook finds the shell as it was before."""
        history: Any = self.history_manager
        kept = [(found, found.copy()) for found in (self.user_ns, self.user_ns_hidden, self.compile._filename_map)]
        self.recorder.begin(10**6, 1000)
        try:
            yield
        finally:
            for found, before in kept:
                found.clear()
                found.update(before)
            for name in [name for name in linecache.cache if name.startswith("<ipython-input")]:
                del linecache.cache[name]
            history.reset(new_session=False)
            history.input_hist_parsed[:] = history.input_hist_raw[:] = [""]
            for held in (history.output_hist_reprs, history.db_input_cache, history.db_output_cache):
                held.clear()
            history._i = history._ii = history._iii = history._i00 = ""
            self.displayhook._ = self.displayhook.__ = self.displayhook.___ = ""
            self.execution_count, self.last_execution_succeeded, self.last_execution_result = 1, True, None
            self.ran_into, self.told, self.read, self.plain = None, (None, {}), None, None
            self.compiler.forget()
            self.recorder.begin(0, 0)
            for name in ("last_type", "last_value", "last_traceback", "last_exc"):
                if hasattr(sys, name):
                    delattr(sys, name)

    @contextmanager
    def silence(self) -> Iterator[None]:
        """Nothing shown inside is recorded: what a call prints could tell the hidden inputs."""
        self.recorder.silent = True
        try:
            yield
        finally:
            self.recorder.silent = False
            self.printed_by_c()

    def printed_by_c(self) -> None:
        """Record: take what was written to file descriptors 1 and 2 past Python, and empty those files."""
        for descriptor, name in ((1, "stdout"), (2, "stderr")):
            try:
                size = os.lseek(descriptor, 0, os.SEEK_END)
                if not size:
                    continue
                text = os.pread(descriptor, min(size, self.recorder.left + 1), 0).decode("utf-8", "replace")
                os.ftruncate(descriptor, 0)
            except OSError:  # the learner's code has closed it
                continue
            self.recorder.stream(name, text)


def _no_input(prompt: object = "") -> str:
    raise StdinNotImplementedError(say("asks", name="input"))


def _no_password(prompt: object = "", stream: object = None) -> str:
    raise StdinNotImplementedError(say("asks", name="getpass"))
