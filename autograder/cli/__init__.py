"""The command line: ``directrix VERB``. Exit code 0 done, 1 something failed and was named, 2 wrong usage."""

from __future__ import annotations

import errno
import gc
import os
import sys

from autograder.errors import DirectrixError

# What the disk may refuse to anybody, and what to try.
DISK = {
    errno.EACCES: "may you read and write there?",
    errno.EPERM: "may you read and write there?",
    errno.EROFS: "choose a folder that can be written",
    errno.ENOENT: "is its folder there?",
    errno.ENOTDIR: "a folder is wanted where a file is",
    errno.EEXIST: "a file of that name is in the way",
    errno.EISDIR: "a file is wanted where a folder is",
    errno.ENOSPC: "make room, then start again; what was finished is kept",
    errno.EDQUOT: "make room, then start again; what was finished is kept",
    errno.ENAMETOOLONG: "choose a shorter name",
}

INTERRUPTED = 130  # as a shell counts: 128 and the number of the signal


def main() -> None:
    """Run the command line; an error made on purpose is one plain line, not a traceback."""
    gc.set_threshold(10_000, 20, 100)  # loading makes many objects and no garbage; looking for some takes a quarter of the time
    words = sys.argv[1:]
    try:
        if words[:1] == ["grade"]:
            from autograder.cli import beginning

            beginning.begin(words[1:])
        from autograder.cli.verbs import command

        command(words)(prog_name="directrix")
    except DirectrixError as error:
        said = "".join(letter if letter.isprintable() or letter == "\n" else "\ufffd" for letter in str(error))
        print(f"directrix: {said}", file=sys.stderr)  # a name in it came from a student: it must not steer the terminal
        sys.exit(1)
    except (KeyboardInterrupt, SystemExit) as ended:
        if isinstance(ended, SystemExit) and ended.code != INTERRUPTED:  # which is all that typer makes of Ctrl-C
            raise
        print("directrix: stopped; what was finished is kept", file=sys.stderr)
        sys.exit(INTERRUPTED)
    except BrokenPipeError:  # the reader of our output has gone, as in `directrix doctor | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)
    except OSError as error:  # a folder that may not be written, a full disk
        if error.errno not in DISK:
            raise
        place = f"{error.filename}: " if isinstance(error.filename, str) else ""
        print(f"directrix: {place}{error.strerror}; {DISK[error.errno]}", file=sys.stderr)
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # or what is still unwritten fails again at the exit
        sys.exit(1)
    finally:
        if "autograder.sandbox.ahead" in sys.modules:
            sys.modules["autograder.sandbox.ahead"].drop()
        gc.freeze()  # the interpreter's end looks through all objects once more, for nothing
