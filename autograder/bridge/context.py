"""What our preprocessors know of the run that nbgrader started: course, submission, instructor's copy, sandbox."""

from __future__ import annotations

import contextlib
import datetime
import functools
import shutil
import weakref
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from autograder.course import Course
from autograder.exercise import Exercise
from autograder.gradebook import AssignmentRow
from autograder.notebook import own
from autograder.notebook.apart import Apart
from autograder.notebook.master import Master
from autograder.notebook.rebuild import Rebuilt, rebuild
from autograder.notebook.run import Ran, run
from autograder.notebook.secret import hidden_seed
from autograder.notebook.session import Opener, opened
from autograder.notebook.submission import beside, digest, harmless, parse, read_file, read_folder
from autograder.notebook.timestamps import FILE, handed_in


@dataclass
class Context:
    """One notebook of one student, as named in nbgrader's resources."""

    course: Course
    student: str
    assignment: str
    notebook: str
    row: AssignmentRow
    master: Master
    converter: Any

    @classmethod
    def of(cls, preprocessor: Any, resources: Mapping[str, Any]) -> Context:
        """The context of a preprocessor that nbgrader's Autograde runs."""
        named = resources["nbgrader"]
        converter = preprocessor.parent.parent
        course = Course(converter.coursedir.root, config=preprocessor.config)
        with course.gradebook() as book:
            row = book.assignment(named["assignment"])
        master = course.masters(row)[named["notebook"]]
        return cls(course, named["student"], named["assignment"], named["notebook"], row, master, converter)

    @property
    def submitted(self) -> Path:
        """The folder that was handed in."""
        return self.course.path("submitted", self.student, self.assignment)

    @property
    def autograded(self) -> Path:
        """The folder that nbgrader is filling."""
        return self.course.path("autograded", self.student, self.assignment)

    def data(self) -> bytes:
        """The submitted notebook: a regular file, never through a link, bounded."""
        return read_file(self.submitted / f"{self.notebook}.ipynb", self.course.bounds.notebook)

    def timestamp(self) -> datetime.datetime | None:
        """When it was handed in, if the folder says."""
        try:
            return handed_in({FILE: read_file(self.submitted / FILE, 1000)})
        except OSError:
            return None

    def rebuilt(self, *, keep_outputs: bool = False) -> Rebuilt:
        """The notebook that is graded."""
        return rebuild(
            parse(self.data()),
            self.master,
            add_missing=self.course.add_missing,
            missing=self.course.missing_notification,
            keep_outputs=keep_outputs,
        )

    def drop_links(self) -> list[str]:
        """Remove from ``autograded/`` what nbgrader copied there through a link; the names of those files.

        Where the instructor has a file of that name, nbgrader has put it in the place of the copy already.
        """
        places = sorted(self.autograded.rglob("*")) if self.autograded.is_dir() else []
        names = [path.relative_to(self.autograded).as_posix() for path in places if not path.is_dir()]
        linked = [name for name in names if (self.submitted / name).is_symlink()]
        instructors = self.course.instructor_files(self.assignment) if linked else {}
        dropped = [name for name in linked if name not in instructors]
        for name in dropped:
            (self.autograded / name).unlink()
        return dropped

    def run(self, built: Rebuilt) -> Ran:
        """Run a rebuilt notebook in the sandbox of this grading run."""
        secret, submission = self.course.secret(), digest(self.data())
        exercises = self.exercises()
        open_session = self._sandbox(exercises)
        files = self._files()

        def seed(exercise: str) -> bytes:
            return hidden_seed(secret, self.student, exercise, submission)

        script = self.course.scripts(self.row, {self.notebook: self.master}, open_session)[self.notebook]
        kernel = functools.partial(open_session.kernel, files, student=self.student)
        apart = Apart(script, lambda: open_session.pair(files, self.student), kernel)
        return run(
            built,
            lambda: open_session(files, self.student),
            own.of_student(exercises.get, self.master, self.student),
            seed,
            uses_check=self.master.uses_check,
            apart=apart,
        )

    def _sandbox(self, exercises: Mapping[str, Exercise]) -> Opener:
        """One for each of nbgrader's runs, started with its first notebook and closed with its converter; if lost, another."""
        if self.lost:
            stack = contextlib.ExitStack()
            course = self.course
            opening = opened(
                exercises.values(), course.packages, course.level, course.timeout, course.withhold,
                given=course.given(self.assignment, self.row.notebooks),
            )  # fmt: skip
            _sandboxes[self.converter] = stack.enter_context(opening)
            weakref.finalize(self.converter, stack.close)
        return _sandboxes[self.converter]

    @property
    def lost(self) -> bool:
        """Whether no sandbox runs, or none any more: somebody ended it, or the machine was short of memory."""
        return self.converter not in _sandboxes or not _sandboxes[self.converter].box.alive

    def other_id(self, built: Rebuilt) -> str | None:
        """A sentence where the notebook draws its numbers for somebody else."""
        return own.other_id(built.cells, self.exercises().values(), self.student)

    def exercises(self) -> dict[str, Exercise]:
        """The exercises that the assignment poses, in any of its notebooks."""
        names = [cell.exercise for nb in self.row.notebooks.values() for cell in nb.master.graded if cell.exercise]
        return {name: found for name in names if (found := self.course.exercise(name)) is not None}

    def _files(self) -> dict[str, bytes]:
        return read_folder(self.autograded, ignore=self.course.ignore, bounds=self.course.bounds).others

    def keep(self, files: Mapping[str, bytes]) -> None:
        """Write what the learner's code wrote into ``autograded/``, never over the instructor's files."""
        instructors = self.course.instructor_files(self.assignment)
        kept = {name: data for name, data in files.items() if harmless(name) and name not in instructors}
        for name, data in beside(kept, instructors).items():
            path = self.autograded / name
            if path.is_dir():  # the notebook made a file where a folder was
                shutil.rmtree(path)
            for folder in path.relative_to(self.autograded).parents:  # or a folder where a file was
                if (self.autograded / folder).is_file():
                    (self.autograded / folder).unlink()
            path.parent.mkdir(parents=True, exist_ok=True)
            path.unlink(missing_ok=True)
            path.write_bytes(data)


_sandboxes: weakref.WeakKeyDictionary[Any, Opener] = weakref.WeakKeyDictionary()  # by converter
