"""Another language: a JSON file of texts by the keys of :mod:`autograder.messages`, named in the environment.

    python -m autograder.translation > german.json    every key with its English text, to be translated
    DIRECTRIX_MESSAGES=/path/to/german.json           for notebooks and for the grader: they speak German

A translation may leave out keys, which stay English, and names in braces; it may add neither.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path

from autograder.errors import CourseError
from autograder.messages import TEXT, use

VARIABLE = "DIRECTRIX_MESSAGES"


def install() -> None:
    """Speak the language of the file that the environment names; ``autograder`` calls it once, where it names one.

    Raises
    ------
    CourseError
        If the file cannot be read or does not fit the catalogue.
    """
    path = os.environ.get(VARIABLE)
    if path:
        use(read(Path(path)))


def read(path: Path) -> Mapping[str, str]:
    """The texts of a translation, not yet held to the catalogue.

    Raises
    ------
    CourseError
        If there is no such file, or it holds something else.
    """
    wanted = f"{VARIABLE} names a JSON file of texts by their keys (python -m autograder.translation writes the English one)"
    try:
        texts = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise CourseError(f"{wanted}; {path} cannot be read: {error}") from None
    if not isinstance(texts, dict):
        raise CourseError(f"{wanted}; {path} holds something else")
    return texts


if __name__ == "__main__":
    print(json.dumps(TEXT, indent=2, ensure_ascii=False))
