"""Numbers of one's own: drawn from a student's id and a public word of the course, the same wherever they are drawn.

    personal.course("3f0c...")                       # in the setup cell; `directrix release` writes the course's word there
    rng = personal.numbers("linear_sweep", "ada")    # a numpy generator

The generator is the one that the data set ``yours`` of that exercise is drawn from when ada runs ``check`` and when her work is
graded, so a notebook can show the very numbers. All of this is public: whoever knows an id can draw its numbers. What marks
hang on is drawn from the course's secret, which is not among the ingredients here. The sandbox
loads this module too: numpy only.
"""

from __future__ import annotations

import hashlib
import os

import numpy as np

PUBLIC_SEED = 0  # of the data that everybody sees
YOURS = "yours"
_here = {"salt": "", "student": ""}  # of the notebook that runs in this process


def course(salt: str) -> None:
    """Say of which course this notebook is: numbers of one's own differ from course to course."""
    _here["salt"] = salt


def numbers(exercise: str, student: str = "", data: str = YOURS) -> np.random.Generator:
    """A generator of the student's own random numbers for a data set of an exercise.

    Parameters
    ----------
    exercise : str
        The id of the exercise.
    student : str
        The student's id in the course. Empty: the name on a JupyterHub, which in grading is whose work it is; where there is
        none, the numbers that all share.
    data : str
        The data set.
    """
    _here["student"] = str(student).strip()
    return generator(seed_here(), exercise, data)


def student_here() -> str:
    """The id that was given last in this process, else the name on a JupyterHub, else empty."""
    return _here["student"] or os.environ.get("JUPYTERHUB_USER", "").strip()


def seed_here() -> int | bytes:
    """The seed of public data for whoever works in this process."""
    return seed(_here["salt"], student_here())


def seed(salt: str, student: str) -> int | bytes:
    """The seed of a student's public data; that of everybody's where no student is named."""
    if not student:
        return PUBLIC_SEED
    parts = (part.encode("utf-8", "surrogatepass") for part in ("directrix, numbers of one's own", salt, student))
    return hashlib.sha256(b"".join(len(part).to_bytes(8, "big") + part for part in parts)).digest()


def generator(seed: int | str | bytes, *names: str) -> np.random.Generator:
    """A random generator that depends on the seed and the names, and on nothing else."""
    key = seed if isinstance(seed, bytes) else str(seed).encode()
    digest = hashlib.sha256(b"\x00".join([key, *(name.encode() for name in names)])).digest()
    return np.random.default_rng(int.from_bytes(digest, "big"))
