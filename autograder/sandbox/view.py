"""What there is to see inside a sandbox: the interpreter, the system's shared libraries, the allowed packages, the guest files.

Everything lies at a place of its own (``/python``, ``/packages``, ``/guest``), so that no path of this machine shows
through and no other file comes along. All of it is read-only.
"""

from __future__ import annotations

import glob
import json
import os
import platform
import sys
import sysconfig
from dataclasses import dataclass, field
from pathlib import Path

from autograder.errors import SandboxError
from autograder.sandbox import packages
from autograder.sandbox.policy import Policy

HERE = Path(__file__).resolve().parent
AUTOGRADER = HERE.parent
LIBRARIES = ("/lib", "/lib32", "/lib64", "/usr/lib", "/usr/lib64")
STORES = ("/nix/store", "/gnu/store")  # of systems that keep every package, and the interpreter, in one tree
FILES = ("/etc/ld.so.cache", "/etc/localtime", "/usr/share/zoneinfo")
DEVICES = ("/dev/null", "/dev/zero", "/dev/full", "/dev/random", "/dev/urandom")
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


@dataclass
class View:
    """Real paths with their places inside, in the order in which they are mounted; folders made empty, links."""

    binds: list[tuple[str, str]] = field(default_factory=list)
    hidden: list[str] = field(default_factory=list)  # folders inside what is bound that are covered by an empty one
    covered: list[str] = field(default_factory=list)  # files likewise
    links: list[tuple[str, str]] = field(default_factory=list)
    environment: dict[str, str] = field(default_factory=dict)
    python: str = ""
    path: list[str] = field(default_factory=list)

    def bind(self, source: Path | str, place: str) -> None:
        """Show a file or folder, if there is one."""
        if os.path.exists(source):
            self.binds.append((str(source), place))

    def command(self, control: int, level: str, policy: Policy) -> list[str]:
        """The zygote's command line."""
        settings = {"control": control, "level": level, "preload": list(policy.preload), "version": sys.version}
        return self.python_command("from autograder.sandbox.guest.zygote import main; main(sys.argv[1])", json.dumps(settings))

    def python_command(self, code: str, *arguments: str) -> list[str]:
        """A command line that runs a line of Python with the view's packages."""
        start = f"import sys; sys.path[:0] = {self.path[:1]!r}; sys.path += {self.path[1:]!r}; {code}"
        return [self.python, "-s", "-P", "-S", "-c", start, *arguments]


def view(policy: Policy) -> View:
    """All that a sandbox with this policy shows."""
    result = View()
    _system(result)
    _interpreter(result)
    _packages(result, policy)
    _guest(result)
    return result


def _system(view: View) -> None:
    """The C library and what else shared objects need; where such a folder is a link, a link."""
    for place in LIBRARIES:
        # Debian and its kin keep shared libraries in a folder of their own; /usr/lib has whole applications beside it.
        inner = f"{place}/{platform.machine()}-linux-gnu"
        if os.path.islink(place):
            view.links.append((os.readlink(place), place))
        else:
            view.bind(*([inner] * 2 if os.path.isdir(inner) else [place] * 2))
    for place in (*STORES, *FILES):
        view.bind(os.path.realpath(place), place)
    # Elsewhere the system's own Python packages lie inside; a learner could put them on the path.
    whole = [source for source, _ in view.binds if source.endswith(("/lib", "/lib64"))]
    view.hidden += [place for source in whole for place in glob.glob(f"{source}/python3*/*-packages") if os.path.isdir(place)]


def _interpreter(view: View) -> None:
    prefix, binary = Path(sys.base_prefix), Path(os.path.realpath(sys.executable))
    standard = Path(sysconfig.get_path("stdlib"))
    try:
        inside = standard.relative_to(prefix)
    except ValueError:
        raise SandboxError(f"the standard library of this Python, {standard}, does not lie under {prefix}") from None
    whole = str(prefix) not in ("/usr", "/usr/local", "/")  # a tree that holds this interpreter only
    shown = {prefix / inside.parts[0]: f"/python/{inside.parts[0]}"} if whole else {standard: f"/python/{inside}"}
    for source, place in shown.items():
        view.bind(source, place)
        view.hidden += [place + path[len(str(source)) :] for path in glob.glob(f"{source}/**/*-packages", recursive=not whole)]
    if not whole:
        for library in glob.glob(f"{prefix}/lib*/libpython3*.so*"):
            view.bind(library, f"/python/lib/{Path(library).name}")
    view.python = f"/python/bin/{binary.name}"
    view.bind(binary, view.python)
    view.environment = {
        "PATH": "/usr/bin", "LANG": "C.UTF-8", "HOME": "/scratch/home", "PYTHONHASHSEED": "0",
        "PYTHONHOME": "/python", "MALLOC_ARENA_MAX": "2", "PLOTLY_RENDERER": "plotly_mimetype", **dict.fromkeys(THREADS, "1"),
    }  # fmt: skip


def _packages(view: View, policy: Policy) -> None:
    view.path = ["/guest"]
    if policy.packages != "all":
        for name, path in sorted(packages.entries(policy.packages).items()):
            view.bind(path, f"/packages/{name}")
        view.path.append("/packages")
        return
    for number, folder in enumerate(packages.site_packages()):
        place = f"/packages/{number}"
        view.bind(folder, place)
        view.path.append(place)
        for path in packages.withheld(folder):
            (view.hidden if path.is_dir() else view.covered).append(f"{place}/{path.name}")


def _guest(view: View) -> None:
    """Stand-ins for autograder and directrix, with the few real files that running a notebook takes."""
    view.bind(HERE / "guest" / "stand_in_autograder.py", "/guest/autograder/__init__.py")
    for name in ("curvedata.py", "personal.py", "returned.py"):
        view.bind(AUTOGRADER / name, f"/guest/autograder/{name}")
    for name in ("__init__.py", "wire.py", "system.py", "guest"):
        view.bind(HERE / name, f"/guest/autograder/sandbox/{name}")
    view.bind(HERE / "guest" / "stand_in_directrix.py", "/guest/directrix/__init__.py")
    for library in (AUTOGRADER.parent / "lib" / "directrix", AUTOGRADER.parent / "directrix"):  # a checkout, an installation
        if library.is_dir():
            for name in ("plot", "errors.py", "checks.py"):
                view.bind(library / name, f"/guest/directrix/{name}")
            break
