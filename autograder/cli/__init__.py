"""The command line: ``directrix VERB``. Exit code 0 done, 1 something failed and was named, 2 wrong usage."""

from __future__ import annotations

import gc
import os
import sys

import typer

from autograder.cli import author, collecting, course, grading, machine, reading
from autograder.errors import DirectrixError

app = typer.Typer(
    name="directrix",
    help="Learn surface modelling by writing the surfaces. Start with: directrix demo",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
)
app.command()(course.demo)
app.command()(course.new)
app.add_typer(author.author, name="author")
app.command()(course.release)
app.command()(course.lab)
app.command()(grading.check)
app.command()(collecting.collect)
app.command()(grading.grade)
app.command()(grading.feedback)
app.command()(reading.similar)
app.command()(reading.marks)
app.command()(reading.export)
app.command()(machine.doctor)


def main() -> None:
    """Run the command line; an error made on purpose is one plain line, not a traceback."""
    gc.set_threshold(50_000, 20, 100)  # loading makes many objects and no garbage; looking for some takes a quarter of the time
    try:
        app()
    except DirectrixError as error:
        said = "".join(letter if letter.isprintable() or letter == "\n" else "\ufffd" for letter in str(error))
        print(f"directrix: {said}", file=sys.stderr)  # a name in it came from a student: it must not steer the terminal
        sys.exit(1)
    except KeyboardInterrupt:
        print("directrix: stopped; what was finished is kept", file=sys.stderr)
        sys.exit(130)
    except BrokenPipeError:  # the reader of our output has gone, as in `directrix doctor | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)
    finally:
        gc.freeze()  # the interpreter's end looks through all objects once more, for nothing
