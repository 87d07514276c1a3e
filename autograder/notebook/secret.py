"""The course secret and the seeds that come from it.

Hidden data depend on the secret, the student, the exercise and the submission's own bytes: feedback on one submission is no
oracle for the next, and nobody can draw them at home. The secret lies in ``COURSE/.directrix/secret``, readable by its owner
only, and goes nowhere else: not to the sandbox, not into a notebook, an output, a log or an argument.
"""

from __future__ import annotations

import contextlib
import hashlib
import hmac
import os
import secrets
from pathlib import Path

from autograder.errors import CourseError

ROOM = ".directrix"
LENGTH = 32


def course_secret(root: Path) -> bytes:
    """The secret of the course in that folder, made on first use.

    Raises
    ------
    CourseError
        If it cannot be made or read, or what is there is no secret.
    """
    path = root / ROOM / "secret"
    try:
        if not path.exists():
            _make(path)
        value = bytes.fromhex(path.read_text("ascii").strip())
    except (OSError, ValueError) as error:
        raise CourseError(f"the course secret {path} cannot be used ({type(error).__name__}); mend it, or remove it") from None
    if len(value) < LENGTH:
        raise CourseError(
            f"the course secret {path} must hold {2 * LENGTH} hexadecimal digits; remove it and a new one is made"
        )
    return value


def public_salt(secret: bytes) -> str:
    """The public word of a course, from which numbers of one's own are drawn: HMAC-SHA256 under the secret, cut to 16 digits.

    It is printed in every released notebook. It tells nothing of the secret, or of the seeds of hidden data.
    """
    return hmac.new(secret, b"directrix, the public word of a course", hashlib.sha256).hexdigest()[:16]


def _make(path: Path) -> None:
    """Write a new secret beside its place and link it there, so that no reader ever meets half of it."""
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    new = path.with_name(f"secret.{os.getpid()}.{secrets.token_hex(4)}")
    descriptor = os.open(new, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, 0o600)
    try:
        with os.fdopen(descriptor, "w", encoding="ascii") as file:
            file.write(secrets.token_hex(LENGTH) + "\n")
        with contextlib.suppress(FileExistsError):  # another grader was quicker: its secret is the course's
            os.link(new, path)
    finally:
        new.unlink()


def hidden_seed(secret: bytes, student: str, exercise: str, submission: str) -> bytes:
    """The seed of the hidden data: HMAC-SHA256 of student, exercise and the submission's digest under the secret."""
    parts = [part.encode("utf-8", "surrogatepass") for part in (student, exercise, submission)]
    framed = b"".join(len(part).to_bytes(8, "big") + part for part in parts)
    return hmac.new(secret, framed, hashlib.sha256).digest()
