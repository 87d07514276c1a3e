"""No room that speaks to learners keeps words of its own: they stand in the catalogue, where a translation finds them."""

import ast
import re
from pathlib import Path
from typing import get_args

import pytest
from directrix.plot.wording import WORDS

import autograder
from autograder import messages
from autograder.result import Outcome, Tier

HOUSE = Path(autograder.__file__).parent
SPEAKING = [
    HOUSE / "judge.py",
    HOUSE / "personal.py",
    *(
        path
        for room in ("comparison", "diagnosis", "card", "checking", "feedback")
        for path in sorted((HOUSE / room).glob("*.py"))
    ),
    # Of these rooms, what writes into a learner's notebook; the other files read submissions and speak to instructors.
    *(HOUSE / "notebook" / f"{name}.py" for name in ("run", "marks", "rebuild", "kernel", "limit", "safe", "score", "told")),
    HOUSE / "gradebook" / "book.py",
    HOUSE / "site" / "page.py",
]
NAMES = {*get_args(Tier), *get_args(Outcome)}  # values of a type, never shown themselves
# Words that no learner reads, or that are no words: the file, how the literal begins, and why it may stand there.
ALLOWED = {
    ("rendering.py", "background-color: "): "a style",
    ("rendering.py", "border-bottom: "): "a style",
    ("rendering.py", "font-weight: "): "a style",
    ("page.py", "default-src 'none'"): "a Content-Security-Policy",
    ("cells.py", "@media screen and"): "a style",
    ("__init__.py", "check() gives no marks inside"): "for the instructor who grades without the bridge",
    ("gates.py", "read only"): "what NumPy says of its arrays",
    ("gates.py", "positional argument"): "what Python says of a call",
    ("gates.py", "required positional"): "what Python says of a call",
    ("wording.py", "None"): "the value of Python",
    ("hide.py", "BEGIN HIDDEN TESTS"): "a marker of nbgrader",
    ("hide.py", "END HIDDEN TESTS"): "a marker of nbgrader",
    ("hide.py", "BEGIN MARK SCHEME"): "a marker of nbgrader",
    ("hide.py", "END MARK SCHEME"): "a marker of nbgrader",
    ("target.py", "the reference"): "for the author of an exercise",
    ("target.py", "mistake "): "for the author of an exercise",
    ("target.py", ", judged as a surface,"): "for the author of an exercise",
    ("target.py", ", data set "): "for the author of an exercise",
    ("target.py", "Target"): "the name of a type",
    ("run.py", "the card of"): "for the log",
    ("run.py", "the judge failed on"): "for the log",
    ("run.py", "the notebook could not be run in a kernel"): "for the instructor's report",
    ("run.py", "files that the notebook wrote"): "for the instructor's report",
    ("run.py", "Refused"): "the name of an error",
    ("run.py", "Error"): "the name of an error",
    ("rebuild.py", "The notebook has more than"): "for the instructor's report",
    ("rebuild.py", "Pasted pictures beyond"): "for the instructor's report",
    ("rebuild.py", "of its cells could not be read"): "for the instructor's report",
    ("rebuild.py", "The cell was missing from the submission and was put back."): "for the instructor's report",
    ("book.py", "there are:"): "for the instructor",
    ("book.py", "there is none yet"): "for the instructor",
    ("book.py", "Did you mean"): "for the instructor",
    ("book.py", "Release it first"): "for the instructor",
    ("write.py", "the feedback of"): "for the log",
    ("personal.py", "directrix, numbers of one's own"): "hashed",
}

OF_THE_PAGES = {"DIFFERENCES"}  # a constant whose words stand in docs/ only


def literals(tree):
    """Strings of a program but for docstrings, annotations and the errors that instructors and authors read."""
    unread = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            unread.add(node.value)
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name) and node.targets[0].id in OF_THE_PAGES:
            unread |= set(ast.walk(node))
        for field in ("annotation", "returns"):
            if (named := getattr(node, field, None)) is not None:
                unread |= set(ast.walk(named))
        raised = node.exc if isinstance(node, ast.Raise) else None
        if isinstance(raised, ast.Call) and getattr(raised.func, "id", "") != "CheckFailed":
            unread |= set(ast.walk(raised))
        if isinstance(node, ast.JoinedStr):
            if node not in unread:
                yield node.lineno, "".join(part.value for part in node.values if isinstance(part, ast.Constant))
            unread |= set(node.values)
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and node not in unread:
            yield node.lineno, node.value


def speaks(text):
    """Whether a literal looks like a sentence or a label: two words in a row, or a single one with a capital."""
    plain = re.sub(r"<[^>]*>|</?\w.*", " ", text).strip()
    return bool(re.search(r"[^\W\d_]{2,}[,:;.]? +\(?[^\W\d_]{2,}", plain) or re.fullmatch(r"[A-Z][a-z]+[:.]?", plain))


@pytest.mark.parametrize("path", SPEAKING, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_no_room_that_speaks_to_learners_has_words_of_its_own(path):
    """What looks like a sentence or a label stands in the catalogue, or in the list above with its reason."""
    said = [(line, text) for line, text in literals(ast.parse(path.read_text("utf-8"))) if speaks(text) and text not in NAMES]
    allowed = [start for name, start in ALLOWED if name == path.name]
    assert [(line, text) for line, text in said if not text.strip().startswith(tuple(allowed))] == []


def test_the_list_of_exceptions_has_no_entry_too_many():
    """An exception that is needed no longer is taken out."""
    found = {
        (name, start)
        for path in SPEAKING
        for _, text in literals(ast.parse(path.read_text("utf-8")))
        for name, start in ALLOWED
        if path.name == name and text.strip().startswith(start.strip())
    }
    assert found == set(ALLOWED)


def test_words_that_are_put_beside_the_catalogue_are_found():
    """Sentences, labels and pieces of f-strings; docstrings and errors for instructors are not looked at."""
    source = '''"""A docstring of words."""
def f(n):
    """Another one."""
    raise ValueError("not for learners")
    raise CheckFailed("for learners indeed")
    return ("Look at", f"it takes {n} arguments", "Worth", "<b>Data sets:</b>", "look.worst", "off", "%d")
'''
    found = {text for _, text in literals(ast.parse(source)) if speaks(text)}
    assert found == {"for learners indeed", "Look at", "it takes  arguments", "Worth", "<b>Data sets:</b>"}


@pytest.mark.parametrize("template", ["feedback/page.html.j2", "site/chapter.html.j2", "site/index.html.j2"])
def test_the_template_of_a_page_has_no_words(template):
    """Tags and what is filled in are all of it."""
    page = re.sub(r"<code>[^<]*</code>", "", (HOUSE / template).read_text("utf-8"))
    bare = re.sub(r"\{\{.*?\}\}|\{%.*?%\}", "", page)
    labels = re.findall(r'(?:aria-label|alt|title)="([^"]*)"', bare)
    assert re.findall(r"[^\W\d_]{2,}", re.sub(r"<[^>]*>", " ", bare)) == []
    assert "".join(labels) == ""


def test_the_figure_speaks_as_the_library_does():
    """The catalogue has each word of a comparison picture, in English the very same."""
    assert {key: messages.ENGLISH.get(f"figure.{key}") for key in WORDS} == WORDS
