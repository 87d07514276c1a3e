"""A learner's notebook without a browser: an IPython shell in this process, whose displays are kept."""

import atexit
import sys

import pytest

from autograder.checking import _missing, shell


class Notebook:
    """Cells that are run one after the other."""

    def __init__(self, running):
        self.shell = running

    def run(self, cell):
        """Run a cell; its result also has `.bundles`, `.cards` (their text) and `.errors` (name, message, traceback)."""
        self.shell.display_pub.outputs.clear()
        self.shell.shown_errors.clear()
        result = self.shell.run_cell(cell, store_history=True)
        result.bundles = [output["data"] for output in self.shell.display_pub.outputs]
        result.cards = [bundle["text/plain"] for bundle in result.bundles if "text/html" in bundle]
        result.errors = list(self.shell.shown_errors)
        return result


@pytest.fixture
def notebook(monkeypatch):
    from IPython.core.displaypub import CapturingDisplayPublisher
    from IPython.core.interactiveshell import InteractiveShell
    from traitlets.config import Config

    class Kept(InteractiveShell):
        """What the kernel's shell sends to the notebook is kept in a list."""

        shown_errors = []  # noqa: RUF012

        def _showtraceback(self, etype, evalue, stb):
            self.shown_errors.append((etype.__name__, str(evalue), "\n".join(stb)))

    hook = sys.displayhook
    monkeypatch.setattr(shell, "_failures", [])
    monkeypatch.setattr(shell, "_listener", None)
    running = Kept.instance(config=Config(HistoryManager={"enabled": False}, InteractiveShell={"colors": "nocolor"}))
    InteractiveShell._instance = running
    running.display_pub = CapturingDisplayPublisher()
    running.kernel = object()  # a notebook, not a terminal: figures are shown
    shell.listen(_missing)
    opened = Notebook(running)
    opened.run("import numpy as np\nfrom autograder import check")
    yield opened
    running.atexit_operations()
    atexit.unregister(running.atexit_operations)
    Kept.clear_instance()
    InteractiveShell.clear_instance()
    sys.displayhook = hook


CYLINDER = """
def cylinder(u, w, r, h):
    return np.stack(np.broadcast_arrays(r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), h * w), axis=-1)
"""


@pytest.fixture
def right():
    return CYLINDER
