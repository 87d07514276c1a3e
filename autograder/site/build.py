"""The folder of the site. It is built beside its place and put there whole: a build that fails leaves what was there."""

from __future__ import annotations

import json
import os
import secrets
import shutil
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import nbformat

from autograder.errors import CourseError
from autograder.feedback.write import images_of
from autograder.notebook import source
from autograder.notebook.chapter import build_chapter, chapters
from autograder.notebook.text import read
from autograder.site import page as pages
from autograder.site.run import LONGEST, execute

MANIFEST = ".directrix-site"  # the files of a site of ours, so that nobody else's is ever removed


@dataclass(frozen=True)
class Built:
    """One chapter of the site. Files are named from the site's folder."""

    title: str
    page: str
    notebook: str
    figures: int
    guesses: int
    solutions: int


@dataclass(frozen=True)
class Site:
    """A site that was built."""

    folder: Path
    chapters: tuple[Built, ...]

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {"site": str(self.folder), "index": "index.html", "chapters": [asdict(one) for one in self.chapters]}


def build(
    out: Path, folder: Path | None = None, *, timeout: int = LONGEST, progress: Callable[[str], None] = lambda title: None
) -> Site:
    """Execute the chapters of a folder and write their site.

    Parameters
    ----------
    out : Path
        The site's folder: a new one, an empty one, or an earlier site, which is replaced.
    folder : Path, optional
        Where the chapters lie; default those that come with the package.
    timeout : int
        Seconds that one cell may take.
    progress : callable
        Told the title of each chapter before it runs.

    Raises
    ------
    CourseError
        If there is no chapter, one cannot be run (with file and line of its cell), or ``out`` holds anything else.
    """
    out = out.resolve()
    check_place(out)
    if folder is not None and not folder.is_dir():
        raise CourseError(f"no such folder: {folder}; --chapters names the one with NN-its-question.py in it")
    found = chapters(folder)
    if not found:
        raise CourseError(f"{folder} has no chapter; a chapter is a file NN-its-question.py, such as 01-what-a-surface-is.py")
    out.parent.mkdir(parents=True, exist_ok=True)
    beside = out.with_name(f".{out.name}.{secrets.token_hex(4)}")
    try:
        beside.mkdir()
        site = _write(beside, [path.resolve() for path in found], timeout, progress, shipped=folder is None)
        check_place(out)
        _put(beside, out)
    finally:
        shutil.rmtree(beside, ignore_errors=True)
    return Site(out, site)


def check_place(out: Path) -> None:
    """Refuse a folder that holds anything but a site of ours."""
    if not out.exists():
        return
    if not out.is_dir():
        raise CourseError(f"{out} is a file; --out names the folder of the site")
    there = {str(path.relative_to(out)) for path in out.rglob("*") if path.is_symlink() or not path.is_dir()}
    try:
        ours = set(json.loads((out / MANIFEST).read_text("utf-8"))) | {MANIFEST}
    except (OSError, ValueError, TypeError):
        ours = set()
    if strangers := sorted(there - ours):
        rest = f" and {len(strangers) - 1} more" if len(strangers) > 1 else ""
        raise CourseError(
            f"{out} holds what is not of the site ({strangers[0]}{rest}), and would be replaced whole; "
            "name a new folder with --out, or move that away"
        )


def _write(
    beside: Path, found: list[Path], timeout: int, progress: Callable[[str], None], *, shipped: bool
) -> tuple[Built, ...]:  # fmt: skip
    openings = [pages.opening(path, read(path)[0]) for path in found]
    made = []
    for path, opening in zip(found, openings, strict=True):
        progress(opening.title)
        run = execute(path, timeout=timeout)
        made.append(pages.chapter(run, openings, shipped=shipped, image=images_of(path.parent)))
        (beside / opening.page).write_text(made[-1].html, "utf-8")
        _notebook(beside / opening.notebook, build_chapter(path))
    for inside in sorted({target for one in made for target in one.linked}):
        assignment = pages.assignment_notebooks()[inside]
        _notebook(beside / pages.NOTEBOOKS / inside, source.release(source.build(assignment, solutions=False)))
    (beside / "index.html").write_text(pages.index(made), "utf-8")
    if any(one.figures for one in made):
        from plotly.offline import get_plotlyjs

        (beside / pages.PLOTLY).write_text(get_plotlyjs(), "utf-8")
    files = sorted(str(path.relative_to(beside)) for path in beside.rglob("*") if path.is_file())
    (beside / MANIFEST).write_text(json.dumps(files), "utf-8")
    return tuple(
        Built(one.opening.title, one.opening.page, one.opening.notebook, one.figures, one.guesses, one.solutions)
        for one in made
    )


def _notebook(path: Path, notebook: Any) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    nbformat.write(notebook, path)  # type: ignore[no-untyped-call]


def _put(beside: Path, out: Path) -> None:
    """The new folder in the place of the old one, which goes only when the new one stands."""
    if not out.exists():
        os.rename(beside, out)
        return
    old = out.with_name(f"{beside.name}.old")
    os.rename(out, old)
    try:
        os.rename(beside, out)
    except OSError:
        os.rename(old, out)
        raise
    shutil.rmtree(old, ignore_errors=True)
