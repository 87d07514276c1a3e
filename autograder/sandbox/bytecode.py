"""Bytecode for what runs inside, where nothing may be written: else the same files are compiled again for every sandbox.

Python keeps the bytecode of a file beside it when it is first imported. What only runs in a sandbox (IPython, what draws and
what formats tracebacks) is imported nowhere else, and some installers leave the compiling to that first import.
"""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Iterable, Mapping


def keep(files: Iterable[object], shown: Mapping[str, str]) -> None:
    """Compile in the background, for the next sandbox, what this one had to.

    Parameters
    ----------
    files : iterable of str
        Python files, by their places inside.
    shown : mapping
        The places of folders inside, with what they are outside.
    """
    if sys.dont_write_bytecode or sys.pycache_prefix is not None:
        return
    todo = "\n".join(found for file in files if (found := outside(file, shown)) and os.access(os.path.dirname(found), os.W_OK))
    if todo:
        command = [sys.executable, "-I", "-m", "compileall", "-q", "-i", "-"]
        silent = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "text": True}
        threading.Thread(target=subprocess.run, args=(command,), kwargs={"input": todo, **silent}, daemon=True).start()


def outside(file: object, shown: Mapping[str, str]) -> str | None:
    """Where a Python file lies that is at this place inside; None for what is no such file below a folder that is shown."""
    if not isinstance(file, str) or os.path.normpath(file) != file or not file.endswith(".py") or not file.isprintable():
        return None
    folder = file
    while (folder := os.path.dirname(folder)) not in ("", "/"):
        if folder in shown:
            return shown[folder] + file[len(folder) :]
    return None
