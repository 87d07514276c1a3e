"""An nbgrader course: its folders, its settings and its exercises, read from ``nbgrader_config.py`` without nbgrader.

Settings keep nbgrader's names and meanings; a setting may be given under the class that has it or under a class that it
inherits from (``c.Execute.timeout``, ``c.ExecutePreprocessor.timeout``). Our own are these:

    c.Directrix.level = "A"                      # isolation to require; not set: A or A-
    c.Directrix.packages = ("numpy", "scipy")    # what learners may import, beyond what exercises allow; or "all"
    c.Directrix.salt = "surfaces 2027"           # public word for numbers of one's own; not set: one that the secret gives
    c.Sandbox.tests = "calibrated"               # ordinary test cells apart from learners' code where they can be; or insist:
                                                 # "apart", "shared"
    c.Sandbox.withhold = ["answers"]             # modules that test cells may import and learners may not;
                                                 # one beside the notebook is not handed out by `directrix release`
    c.Sandbox.engine = {"ps3": "jupyter"}        # notebooks that need a real Jupyter kernel: slower, and its test cells have
                                                 # marks only where they are exercise cells or run apart; or one for all
"""

from __future__ import annotations

import contextlib
import dataclasses
import functools
import hashlib
import importlib
import os
import re
import sys
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from traitlets.config.loader import Config

from autograder import catalogue, settings
from autograder.catalogue import Catalogue
from autograder.errors import CourseError
from autograder.exercise import Exercise
from autograder.gradebook import AssignmentRow, Penalty
from autograder.notebook import apart, secret, submission
from autograder.notebook.apart import Script
from autograder.notebook.master import Master, given
from autograder.notebook.rebuild import notification
from autograder.notebook.session import Opener, Packages, needs
from autograder.sandbox import Policy, kernel

if TYPE_CHECKING:
    from autograder.gradebook import Gradebook

ENGINES = ("ipython", "jupyter")


class Course:
    """A course folder.

    Parameters
    ----------
    path : path
        The folder that holds ``nbgrader_config.py``, or a folder laid out like nbgrader's without one.
    config : Config, optional
        The settings, where nbgrader has read them already.

    Raises
    ------
    CourseError
        If it is no folder, or its configuration cannot be read or has a setting of ours that there is not.
    """

    def __init__(self, path: Path | str, config: Config | None = None) -> None:
        self.folder = Path(path).resolve()
        if not self.folder.is_dir():
            raise CourseError(f"no such folder: {path}; a course is a folder with nbgrader_config.py")
        self.config = settings.load(self.folder) if config is None else config
        settings.refuse_unknown(self.config)
        self.root = (self.folder / str(self.get("CourseDirectory", "root", ""))).resolve()

    def __repr__(self) -> str:
        return f"Course({str(self.folder)!r})"

    def get(self, section: str, name: str, default: Any) -> Any:
        """A setting under its section or one that the section inherits from."""
        return settings.found(self.config, section, name, default)

    @property
    def id(self) -> str:
        """nbgrader's ``course_id``; may be empty."""
        return str(self.get("CourseDirectory", "course_id", "")).strip()

    @property
    def database(self) -> str:
        """URL of the gradebook."""
        return str(self.get("CourseDirectory", "db_url", "")) or f"sqlite:///{self.root / 'gradebook.db'}"

    def gradebook(self) -> Gradebook:
        """Open the gradebook."""
        from autograder.gradebook import Gradebook

        return Gradebook(self.database)

    def path(self, step: str, student: str, assignment: str) -> Path:
        """The folder of a step (``submitted``, ...) for a student (``.``: the instructor) and an assignment."""
        layout = self.get("CourseDirectory", "directory_structure", "{nbgrader_step}/{student_id}/{assignment_id}")
        directory = self.get("CourseDirectory", f"{step}_directory", step)
        return self.root / Path(layout.format(nbgrader_step=directory, student_id=student, assignment_id=assignment))

    def submissions(self, assignment: str) -> dict[str, Path]:
        """Folders handed in for an assignment, by student, in order."""
        return {student: self.path("submitted", student, assignment) for student in self.students("submitted", assignment)}

    def students(self, step: str, assignment: str) -> list[str]:
        """Who has a folder of a step (``submitted``, ...) of an assignment, in order."""
        marker = "\0"
        pattern = str(self.path(step, marker, assignment).relative_to(self.root))
        before, _, after = pattern.partition(marker)
        above, _, begin = before.rpartition("/")
        end, _, rest = after.partition("/")
        excluded = ["", *str(self.get("CourseDirectory", "student_id_exclude", "")).split(",")]
        folder, names, found = self.root / above, [], []
        with contextlib.suppress(OSError):  # there is no such folder
            names = os.listdir(folder)
        for name in names:
            student = name[len(begin) : len(name) - len(end)]
            if name != f"{begin}{student}{end}" or student in excluded or student.startswith("."):
                continue
            path = folder / name / rest
            if os.path.lexists(path) or _dangling(path.parent):  # below a link to nowhere nothing is listed, and the link is
                found.append(student)
        return sorted(found)

    def misnamed(self, assignment: str) -> list[Path]:
        """Folders handed in whose name is the assignment's but for capitals, spaces and signs, as ``a1`` for A1.

        Nobody's work is to be lost for that; who has the right one too is left alone. Where a course's folders end otherwise
        than in the assignment, none are looked for.
        """
        place = self.path("submitted", "STUDENT", assignment)
        if place.name != assignment or place.parent.name != "STUDENT":
            return []
        found = []
        for student in sorted(place.parent.parent.glob("*")):
            with contextlib.suppress(OSError):  # a file, a link to nowhere
                if not (student / assignment).exists():
                    found += [student / name for name in sorted(os.listdir(student)) if _bare(name) == _bare(assignment)]
        return found

    def instructor_file(self, assignment: str, notebook: str) -> Path:
        """The released notebook of the instructor, else the source."""
        released = self.path("release", ".", assignment) / f"{notebook}.ipynb"
        return released if released.is_file() else self.path("source", ".", assignment) / f"{notebook}.ipynb"

    def likely_masters(self, assignment: str) -> list[Master]:
        """What the instructor's files alone tell of the notebooks, for who cannot wait for the gradebook."""
        folders = [self.path(step, ".", assignment) for step in ("source", "release")]
        names = sorted({path.stem for folder in folders for path in folder.glob("*.ipynb")})
        return [Master(name, {}).beside(self.instructor_file(assignment, name)) for name in names]

    def likely_policy(self, assignment: str) -> Policy:
        """What these files say that the sandbox of the assignment has to offer."""
        masters = self.likely_masters(assignment)
        posed = [found for master in masters for name in master.checks if (found := self.exercise(name)) is not None]
        return needs(posed, self.packages, self.withhold, draws=any(master.draws for master in masters))

    def masters(self, of: AssignmentRow) -> dict[str, Master]:
        """The instructor's copies of the notebooks, with what the released files say beside them."""
        return {name: notebook.master.beside(self.instructor_file(of.name, name)) for name, notebook in of.notebooks.items()}

    def given(self, assignment: str, notebooks: Iterable[str]) -> tuple[tuple[str, ...], ...]:
        """The code cells that all learners were given, by notebook: of the released files alone, which have no solution."""
        return tuple(given(self.path("release", ".", assignment) / f"{name}.ipynb") for name in notebooks)

    def instructor_files(self, assignment: str) -> dict[str, bytes]:
        """Files of the assignment beside its notebooks, which overwrite the learner's (but for ``exclude_overwriting``)."""
        folder = self.path("source", ".", assignment)
        if not folder.is_dir():
            return {}
        kept = self.get("Autograde", "exclude_overwriting", {}).get(assignment, [])
        files = submission.read_folder(folder, ignore=self.ignore, bounds=self.bounds).others
        return {path: data for path, data in files.items() if path not in kept}

    @property
    def ignore(self) -> tuple[str, ...]:
        """Patterns of names that are not copied; exercises released beside a notebook are nobody's submission."""
        return (*self.get("CourseDirectory", "ignore", submission.IGNORE), catalogue.BESIDE)

    @property
    def bounds(self) -> submission.Bounds:
        """What a submission may bring: our bounds, or nbgrader's where they are lower."""
        ours = submission.Bounds()
        file = min(ours.file, 1000 * int(self.get("CourseDirectory", "max_file_size", 100_000)))
        total = min(ours.total, 1000 * int(self.get("CourseDirectory", "max_dir_size", 100_000)))
        return submission.Bounds(notebook=ours.notebook, file=file, total=total)

    @property
    def groupshared(self) -> bool:
        """nbgrader's ``groupshared``."""
        return bool(self.get("CourseDirectory", "groupshared", False))

    def permissions(self, section: str) -> int:
        """Mode of the files that a step writes."""
        own = "644" if section == "GenerateFeedback" else "444"
        return int(str(self.get(section, "permissions", "664" if self.groupshared else own)), 8)

    @property
    def timeout(self) -> float | None:
        """Seconds that a cell may take, nbgrader's ``Execute.timeout``; None (our own limit) if not set."""
        value = self.get("Execute", "timeout", None)
        return None if value is None or value < 0 else float(value)

    @property
    def add_missing(self) -> bool:
        """nbgrader's ``OverwriteCells.add_missing_cells``."""
        return bool(self.get("OverwriteCells", "add_missing_cells", False))

    @property
    def missing_notification(self) -> str:
        """What a cell that was put back begins with."""
        return str(self.get("OverwriteCells", "missing_cell_notification", notification()))

    @property
    def create_students(self) -> bool:
        """nbgrader's ``Autograde.create_student``."""
        return bool(self.get("Autograde", "create_student", True))

    @property
    def ignore_pattern(self) -> str:
        """What is taken out of stderr before a cell is scored; empty: nothing."""
        enabled = bool(self.get("IgnorePattern", "enabled", False))
        return str(self.get("IgnorePattern", "pattern", "")) if enabled else ""

    @property
    def output_limits(self) -> tuple[int, int]:
        """nbgrader's ``LimitOutput``: lines of output a cell, lines of traceback; -1 for no limit."""
        return int(self.get("LimitOutput", "max_lines", 1000)), int(self.get("LimitOutput", "max_traceback", 100))

    @property
    def level(self) -> str | None:
        """The isolation level that the course requires; None for A or A-, whichever the machine gives."""
        level = self.get("Directrix", "level", None)
        return None if level is None else str(level)

    @property
    def packages(self) -> Packages:
        """Packages that learners may import beyond numpy, plotly and what exercises allow."""
        given = self.get("Directrix", "packages", ())
        return "all" if given in ("*", "all") else tuple(given)

    @property
    def tests(self) -> str:
        """How ordinary test cells run, ``c.Sandbox.tests``: "calibrated" (the default), "apart" or "shared"."""
        return str(self.get("Sandbox", "tests", "calibrated"))

    @property
    def withhold(self) -> tuple[str, ...]:
        """Modules that test cells may import and learners may not, ``c.Sandbox.withhold``."""
        given = self.get("Sandbox", "withhold", ())
        return (given,) if isinstance(given, str) else tuple(map(str, given))

    def engine(self, assignment: str) -> str:
        """What runs an assignment's notebooks, ``c.Sandbox.engine``: "ipython" (the default) or "jupyter".

        Raises
        ------
        CourseError
            If it is neither.
        IsolationError
            If a kernel is wanted and none is installed.
        """
        given = self.get("Sandbox", "engine", ENGINES[0])
        found = given.get(assignment, ENGINES[0]) if isinstance(given, dict) else given
        if found not in ENGINES:
            raise CourseError(
                f'c.Sandbox.engine must be "ipython" or "jupyter", or one of them for each assignment ({{"ps3": "jupyter"}}); '
                f"got {found!r} for {assignment}"
            )
        if found == "jupyter":
            kernel.available()
        return str(found)

    def scripts(self, of: AssignmentRow, masters: Mapping[str, Master], opener: Opener) -> dict[str, Script]:
        """How the ordinary test cells of each notebook run, tried with the solutions in ``source/`` where that is not known.

        Raises
        ------
        CourseError
            If the course insists on what a cell cannot do.
        """
        files, engine = self.instructor_files(of.name), self.engine(of.name)
        beside = {path: hashlib.sha256(data).hexdigest() for path, data in sorted(files.items())}
        found: dict[str, Script] = {}
        for name, master in masters.items():
            names = {cell.exercise for cell in master.graded if cell.exercise}
            script = apart.prepare(
                self.path("source", ".", of.name) / f"{name}.ipynb",
                master,
                judged={exercise for exercise in names if master.uses_check or self.exercise(exercise) is not None},
                open_session=lambda: opener.trusted(files),
                open_pair=lambda: opener.pair(files),
                mode=self.tests,
                memory=self.room / "apart" / f"{of.name}.{name}.json",
                settings=[self.packages, self.withhold, self.timeout, beside, sys.version],
            )
            found[name] = dataclasses.replace(script, engine=engine)
        return found

    def penalty(self) -> Penalty | None:
        """The late policy: nbgrader's own two, or the course's plug-in (which loads nbgrader, being a class of it)."""
        given = self.get("AssignLatePenalties", "plugin_class", None)
        stock = given is None or (isinstance(given, str) and given.rsplit(".", 1)[-1] == "LateSubmissionPlugin")
        if stock:
            method = self.get("LateSubmissionPlugin", "penalty_method", "none")
            return (lambda student, score, late: score) if method == "zero" else None
        plugin = _imported(given, self.folder)(config=self.config)
        return lambda student, score, late: plugin.late_submission_penalty(student, score, late)

    @functools.cached_property
    def catalogue(self) -> Catalogue | None:
        """The course's own exercises, if it has any."""
        return catalogue.load(self.folder) if catalogue.has_assignments(self.folder) else None

    def exercise(self, name: str) -> Exercise | None:
        """The exercise of that name: the course's own first, then the installed and shipped ones."""
        own = self.catalogue.get(name) if self.catalogue is not None else None
        return own or catalogue.installed().get(name)

    def secret(self) -> bytes:
        """The course secret."""
        return secret.course_secret(self.folder)

    def salt(self) -> str:
        """The public word of the course, ``c.Directrix.salt``, or one that comes from its secret and does not tell it."""
        given = self.get("Directrix", "salt", None)
        if given is None:
            return secret.public_salt(self.secret())
        if not re.fullmatch(r"[\w .-]{1,80}", str(given)):
            raise CourseError(f"c.Directrix.salt must be letters, digits, blanks, dots, dashes, at most 80; got {given!r}")
        return str(given)

    @property
    def room(self) -> Path:
        """The folder for our own records, readable by the instructor only."""
        self.records.mkdir(mode=0o700, exist_ok=True)
        return self.records

    @property
    def records(self) -> Path:
        """Where that folder is, or would be: for who only reads, from a disk that may be closed to writing."""
        return self.folder / secret.ROOM


def _bare(name: str) -> str:
    """A name without capitals and with nothing between its letters."""
    return "".join(filter(str.isalnum, name.casefold()))


def _imported(given: Any, folder: Path) -> Callable[..., Any]:
    if not isinstance(given, str):
        return given  # type: ignore[no-any-return]
    module, _, name = given.rpartition(".")
    sys.path.insert(0, str(folder))
    try:
        return getattr(importlib.import_module(module), name)  # type: ignore[no-any-return]
    except (ImportError, AttributeError) as error:
        raise CourseError(f"the late policy {given!r} cannot be imported: {error}") from error
    finally:
        sys.path.remove(str(folder))


def _dangling(path: Path) -> bool:
    """Whether this is a link to nowhere."""
    return path.is_symlink() and not path.exists()
