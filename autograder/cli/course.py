"""``directrix demo``, ``new``, ``release`` and ``lab``: making courses and opening them.

Verbs import what they need when they run, here and beside: ``directrix --help`` should not wait for notebooks and tables.
"""

from __future__ import annotations

import json
import os
import shlex
import sys
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from autograder.cli.options import AsJson, CourseOption, GradingLevel, console_for
from autograder.errors import CourseError

FIRST = ("A1", "A2", "A3")
AS_IT_IS: Any = {"highlight": False, "markup": False, "soft_wrap": True}  # a command to be typed: no fold in the middle
IMPATIENT = """
c.Execute.timeout = 5  # seconds of computing for one cell: the sample class has loops that never end
"""


def typed(path: Path) -> str:
    """A path as it is typed into a shell."""
    return shlex.quote(str(path))


def new(
    course: Annotated[
        Path | None,
        typer.Argument(
            help="The new folder; with --exercise a course (this folder, if not named) or an assignment folder.",
            show_default=False,
        ),
    ] = None,
    assignment: Annotated[list[str] | None, typer.Option(help="Only these assignments (A1, A2, ...); may be repeated.")] = None,
    exercise: Annotated[
        str, typer.Option(metavar="NAME", help="Write a new exercise of your own: the name of its function.")
    ] = "",
    kind: Annotated[str, typer.Option(help="What the new exercise answers: surface, curve or value.")] = "surface",
    points: Annotated[float, typer.Option(help="Points of the new exercise.")] = 5,
) -> None:
    """Make an nbgrader course with the shipped assignments, or write a new exercise to start from.

    Example: directrix new surfaces-2027

    Example: directrix new assignments/20-roofs --exercise barrel_roof
    """
    from autograder import authoring

    console = console_for(as_json=False)
    if exercise:
        if assignment:
            raise typer.BadParameter(
                "chooses shipped assignments of a new course; it does not go with --exercise", param_hint="--assignment"
            )
        folder = authoring.new_exercise(course or Path(), exercise, kind, points)
        said = f"{folder}: exercise {exercise} in exercises.py, its task in notebook.py; both are yours to change"
        console.print(said, highlight=False, markup=False)
        console.print(f"Next: directrix author check {typed(folder)}", **AS_IT_IS)
        return
    if course is None:
        raise typer.BadParameter("the folder of the new course, as in: directrix new surfaces-2027", param_hint="COURSE")
    made = authoring.new_course(course, tuple(assignment or ()))
    listed = ", ".join(f"{a.name} {a.slug} ({authoring.points_in(course, a.name):g} points)" for a in made)
    console.print(f"{course}: {listed}", highlight=False, markup=False)
    console.print(f"Next: directrix release {made[0].name} --course {typed(course)}", **AS_IT_IS)


def release(
    assignment: Annotated[
        str, typer.Argument(help="Assignment in source/, for example A1, or one of your own in assignments/.")
    ],
    course: CourseOption = Path(),
    with_exercises: Annotated[
        bool, typer.Option("--with-exercises", help="Put your own exercises, references included, beside the notebook.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Make the learners' version of an assignment: release/A1, with stubs for solutions.

    An assignment of your own (assignments/20-roofs) is first built into source/A20. Its check(...) works in learners' own
    JupyterLab where they have its exercises: beside the notebook, by --with-exercises, or installed.

    Example: directrix release A1
    """
    from autograder import authoring

    console = console_for(as_json)
    made = authoring.release(course, assignment, with_exercises=with_exercises)
    unknown = authoring.unknown_to_learners(course, made)
    if as_json:
        print(json.dumps({"released": str(made), "exercises_not_with_learners": unknown}))
    console.print(f"{made}: hand it out, or put it on the exchange with nbgrader release_assignment", highlight=False)
    if unknown:
        names = ", ".join(unknown)
        console.print(
            f"check(...) in learners' own JupyterLab does not know {names}, unless you install them there or release again "
            "with --with-exercises (docs/authoring.md); grading knows them.",
            highlight=False,
        )


def lab(
    folder: Annotated[
        Path | None,
        typer.Argument(
            help="A course, or a folder for your own workbook.",
            show_default="this folder if it is a course, else directrix-workbook",
        ),
    ] = None,
    browser: Annotated[bool, typer.Option(help="Open a browser window.")] = True,
    port: Annotated[int, typer.Option(help="Port of the local server.")] = 8888,
) -> None:
    """Open JupyterLab: on a course (with formgrader), or on a workbook with all notebooks and walkthroughs.

    Example: directrix lab
    """
    from autograder import authoring

    here = Path("nbgrader_config.py").is_file()
    folder = folder or (Path() if here else Path("directrix-workbook"))
    if not (folder / "nbgrader_config.py").is_file():
        written = authoring.workbook(folder)
        kept = "your own work is kept" if not written else f"{len(written)} notebooks added, what was there is kept"
        Console().print(f"{folder}: {kept}", highlight=False)
    os.chdir(folder)
    options = ["--ServerApp.root_dir=.", f"--ServerApp.port={port}", *([] if browser else ["--no-browser"])]
    if hasattr(os, "geteuid") and os.geteuid() == 0:
        options.append("--allow-root")
    sys.stdout.flush()
    os.execv(sys.executable, [sys.executable, "-m", "jupyterlab", *options])


def demo(
    directory: Annotated[Path, typer.Option("--dir", help="Where the demo course goes.")] = Path("directrix-demo"),
    assignment: Annotated[list[str] | None, typer.Option(help="Only these assignments; may be repeated.")] = None,
    level: GradingLevel = "",
    every: Annotated[bool, typer.Option("--all", help="Every shipped assignment, not only the first three.")] = False,
    again: Annotated[bool, typer.Option("--again", help="Replace an earlier demo in that folder.")] = False,
    as_json: AsJson = False,
) -> None:
    """Run the main job from one end to the other: release, submit a sample class, grade it in the sandbox, give feedback.

    Example: directrix demo --dir demo
    """
    from rich.markup import escape

    from autograder import authoring, feedback, fleet, report
    from autograder import demo as cohorts

    console = console_for(as_json)
    if again and directory.exists():
        authoring.remove_course(directory)
    console.rule("a course, its released notebooks, and a sample class")
    chosen = tuple(assignment or ()) or (() if every else FIRST)
    assignments = authoring.new_course(directory, chosen)
    with (directory / "nbgrader_config.py").open("a") as config:
        config.write(IMPATIENT)
    course = fleet.Course(directory)
    summary: dict[str, Any] = {}
    problems = 0
    for made in assignments:
        released = authoring.release(directory, made.name) / f"{made.slug}.ipynb"
        members = cohorts.submit(released, course, made.name)
        console.print(f"{made.name} {made.slug}: released, {len(members)} submissions", highlight=False)
    for made in assignments:
        console.rule(f"grading {made.name} in the sandbox")
        graded = grade_with_progress(console, course, made.name, level=level or None)
        pages = feedback.write(course, made.name)
        report.show(graded, console)
        surprises = cohorts.surprises(made.name, graded)
        problems += len(surprises) + len(graded.faults)
        for surprise in surprises:
            console.print(f"[bold red]not as expected:[/] {surprise}")
        summary[made.name] = {**graded.to_dict(), "feedback": len(pages), "surprises": surprises}
    if as_json:
        print(json.dumps(summary, allow_nan=False))
    console.rule("where everything lies")
    for what, place in [
        ("gradebook, read by nbgrader too", directory / "gradebook.db"),
        ("what learners handed in", directory / "submitted"),
        ("graded notebooks", directory / "autograded"),
        ("feedback pages, open one in a browser", directory / "feedback"),
    ]:
        console.print(f"  {escape(str(place))}  [dim]{what}[/]", highlight=False)
    lab = f"directrix lab {escape(typed(directory))}"
    console.print(f"  {lab}  [dim]JupyterLab with formgrader on this course[/]", highlight=False, soft_wrap=True)
    if problems:
        raise CourseError(f"{problems} results of the demo are not as expected; they are listed above")


def grade_with_progress(console: Console, course: Any, assignment: str, **options: Any) -> Any:
    """Grade an assignment under a Rich progress bar."""
    from rich.markup import escape
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    from autograder import fleet, report

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task(assignment, total=None)

        def tell(done: int, total: int, student: str) -> None:
            progress.update(task, completed=done, total=total, description=escape(f"{assignment} {report.plain(student)}"))

        return fleet.grade(course, assignment, progress=tell, **options)
