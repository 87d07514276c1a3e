"""Formgrader's pages while a server shows them: what nbgrader 0.9 leaves to whoever writes a link, and to where a course lies.

What learners hand in may hold links, and a link in a page of formgrader is followed with the instructor's rights: it may lead
to a file beside the notebook, to any address of formgrader, or back to the course list with a folder. nbgrader shows such a
file as a page of its own server, writes the address into a page as it stands, and runs the folder's ``nbgrader_config.py``. So
a click would be enough to read the gradebook, or to run a program as the instructor.

Where a course's configuration names another folder as its root, nbgrader reads it too late for the page of a submission, which
is then nbgrader's own: it asks another machine for what draws formulas.

nbgrader has no setting for any of these, so its classes are changed where they are loaded: in the server, and nowhere else.
"""

from __future__ import annotations

import copy
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

# A page in a sandbox has no scripts, no cookies and no server of its own; it fetches nothing. The reader of PDF files needs to
# be outside, and runs none of a page's scripts.
SEALED = "sandbox; default-src 'none'; style-src 'unsafe-inline'; img-src data:; media-src data:"
PDF = "application/pdf"
EXPORTER = "nbgrader_exporter"
_AS_TEXT = str.maketrans({"<": "&lt;", ">": "&gt;", '"': "&quot;"})


def guard(pages: Callable[[Any], None]) -> None:
    """Close them in nbgrader's formgrader, if this process serves it; once, however often a config is read.

    ``pages`` puts into a configuration how a notebook is shown.
    """
    handlers = sys.modules.get("nbgrader.server_extensions.formgrader.handlers")
    if handlers is not None and "set_extra_headers" not in vars(handlers.SubmissionFilesHandler):
        handlers.SubmissionFilesHandler.set_extra_headers = _seal
        handlers.BaseHandler.exporter = property(_showing(pages))
        handlers.BaseHandler.render = _escaping(handlers.BaseHandler.render)
        handlers.FormgraderHandler.get = _outside_courses(handlers.FormgraderHandler.get, handlers.web)


def _seal(handler: Any, path: str) -> None:
    """Headers of a file that a learner handed in or that a notebook wrote."""
    handler.set_header("X-Content-Type-Options", "nosniff")
    if handler.get_content_type() != PDF:
        handler.set_header("Content-Security-Policy", SEALED)


def _showing(pages: Callable[[Any], None]) -> Callable[[Any], Any]:
    """What turns a notebook into formgrader's page: nbgrader's exporter, with our settings if they came too late for it."""

    def exporter(handler: Any) -> Any:
        made = handler.settings[EXPORTER]
        config = copy.deepcopy(made.config)
        pages(config)
        ours, there = config.HTMLExporter, made.config.HTMLExporter
        if any(set(ours[name]).difference(there.get(name, ())) for name in ("preprocessors", "extra_template_basedirs")):
            handler.settings[EXPORTER] = made = type(made)(config=config)
        return made

    return exporter


def _escaping(render: Any) -> Any:
    """Formgrader's pages with what comes from an address as text, in the page as in its scripts' strings."""

    def escaped(handler: Any, name: str, **values: Any) -> Any:
        return render(handler, name, **{key: _text(value) for key, value in values.items()})

    return escaped


def _text(value: Any) -> Any:
    return value.translate(_AS_TEXT) if isinstance(value, str) else value


def _outside_courses(get: Any, web: Any) -> Any:
    """Opening another course by its folder: not by one that lies in a course, where learners' files are."""

    def checked(handler: Any) -> Any:
        path = handler.get_argument("path", "")
        around = course_around(Path(path), Path(handler.coursedir.root)) if path else None
        if around is not None:
            raise web.HTTPError(
                400, "%s lies in the course %s: files handed in are there, and none of them is a course", path, around
            )
        return get(handler)

    return web.authenticated(checked)


def course_around(folder: Path, loaded: Path) -> Path | None:
    """The course in which a folder lies, ``loaded`` or another; None for a course's own folder and for one elsewhere."""
    loaded = loaded.resolve()
    for around in folder.resolve().parents:
        named = around == loaded or any((around / name).is_file() for name in ("nbgrader_config.py", "gradebook.db"))
        if named and any((around / step).is_dir() for step in ("source", "submitted")):
            return around
    return None
