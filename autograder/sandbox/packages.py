"""Which files of the installed packages a sandbox shows: those of the allowed distributions and of all they require."""

from __future__ import annotations

import functools
import importlib.metadata
import importlib.util
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from autograder.errors import SandboxError

ALWAYS = ("numpy", "ipython")  # what running a notebook takes
ALSO = {"plotly": ("nbformat",)}  # asked for at run time, by plotly's renderers
WITHHELD = ("directrix", "autograder")
NEVER = ("__pycache__", "bin", "..")
CODE = (".py", ".pyc", ".so")
FIELD = "Requires-Dist:"
OF_EXTRA = re.compile(r"""\bextra\s*==\s*(["'])[^"']+\1""")  # only with an extra that is not asked for here


@functools.cache
def entries(packages: tuple[str, ...]) -> dict[str, Path]:
    """Top-level names in site-packages (folders, modules, compiled modules, metadata) with where they are.

    Raises
    ------
    SandboxError
        If a package is not installed.
    """
    found: dict[str, Path] = {}
    todo = [*ALWAYS, *packages, *(more for name in packages for more in ALSO.get(name, ()))]
    seen: set[str] = set()
    while todo:
        name = canonicalize_name(todo.pop())
        if name in seen or name in WITHHELD:
            continue
        seen.add(name)
        distribution = _distribution(name, asked=name in {canonicalize_name(package) for package in packages})
        if distribution is not None:
            found.update(_top_level(distribution))
            todo += _required(distribution)
    return found


def _distribution(name: str, *, asked: bool) -> importlib.metadata.Distribution | None:
    """The distribution of that name, or the one that holds a module of that name."""
    try:
        return importlib.metadata.distribution(name)
    except importlib.metadata.PackageNotFoundError:
        if not asked:
            return None  # an optional requirement that is not installed
    for module in (name, name.replace("-", "_")):
        holders = importlib.metadata.packages_distributions().get(module)
        if holders:
            return importlib.metadata.distribution(holders[0])
    raise SandboxError(
        f"learners may import {name!r}, says the policy, but it is not installed here; install it or leave it out"
    )


def installed(name: str) -> bool:
    """Whether a package or module of that name is installed, so that it can be allowed; one of Python's own is always there."""
    try:
        return _distribution(name, asked=True) is not None
    except SandboxError:
        return False


def _required(distribution: importlib.metadata.Distribution) -> Iterable[str]:
    head, _, _ = (distribution.read_text("METADATA") or "").partition("\n\n")  # all of it takes an e-mail's reader long
    said = [line.removeprefix(FIELD) for line in head.splitlines() if line.startswith(FIELD)]
    for text in said if head else distribution.requires or ():
        _, _, marker = text.partition(";")
        if OF_EXTRA.search(marker) and " or " not in marker:
            continue  # most are, and to read them in full takes longer than all else here
        requirement = Requirement(text)
        if requirement.marker is None or requirement.marker.evaluate({"extra": ""}):
            yield requirement.name


def _top_level(distribution: importlib.metadata.Distribution) -> dict[str, Path]:
    """First parts of the paths that the distribution installed."""
    first = {line.partition("/")[0] for line in (distribution.read_text("RECORD") or "").splitlines()}
    names = {part.partition(",")[0].strip('"') for part in first}
    root = Path(str(distribution.locate_file("")))
    found = {name: root / name for name in names if name and name not in NEVER and not name.endswith(".pth")}
    found = {name: path for name, path in found.items() if path.exists()}
    if found:
        return found
    # Installed by a system's package manager, or editable: no list of files that would help.
    for module in (distribution.read_text("top_level.txt") or distribution.name.replace("-", "_")).split():
        spec = importlib.util.find_spec(module)
        if spec is not None and spec.origin not in (None, "built-in", "frozen"):
            path = Path(str(spec.origin))
            path = path.parent if path.name == "__init__.py" else path
            found[path.name] = path
    return found


def site_packages() -> list[Path]:
    """The folders of installed packages that this interpreter uses."""
    return [
        Path(place) for place in sys.path if Path(place).name in ("site-packages", "dist-packages") and Path(place).is_dir()
    ]


def withheld(folder: Path) -> list[Path]:
    """What of a whole site-packages folder stays hidden: directrix, autograder, and every list of paths."""
    hidden = [path for path in folder.iterdir() if path.name.lower().startswith(WITHHELD) or path.suffix == ".pth"]
    return [*hidden, *(path for path in folder.glob("__editable__*"))]


def without(files: Mapping[str, bytes], modules: Sequence[str]) -> dict[str, bytes]:
    """Files beside a notebook without those of these modules: ``answers.py``, what is compiled of it, ``answers/``.

    A file of data of that name stays.
    """
    return {path: data for path, data in files.items() if not any(_belongs(path, module) for module in modules)}


def _belongs(path: str, module: str) -> bool:
    *folders, name = path.split("/")
    return module in folders or (name.partition(".")[0] == module and name.endswith(CODE))
