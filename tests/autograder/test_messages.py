"""One catalogue holds all that the judge says: every key that is asked for is there, and every text can be said."""

import ast
import re
import string
from pathlib import Path

import pytest

from autograder import messages
from autograder.comparison.answers import Reason
from autograder.comparison.symmetry import SURFACE_NAMES

HOUSE = Path(messages.__file__).parents[1]
ROOMS = ("comparison", "diagnosis", "card", "checking", "notebook", "feedback", "site")
SINGLE = ("judge.py", "gradebook/book.py")
SOURCES = [*(HOUSE / path for path in SINGLE), *(path for room in ROOMS for path in sorted((HOUSE / room).glob("*.py")))]
ASKING = [*SOURCES, HOUSE / "messages" / "__init__.py", *(HOUSE / "feedback").glob("*.j2"), *(HOUSE / "site").glob("*.j2")]
WRITTEN = "\n".join(path.read_text("utf-8") for path in ASKING)


def literal_keys(path):
    """Strings in a file that look like keys of the catalogue, f-strings with the varying part as a pattern."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and re.fullmatch(r"[a-z]+(\.\w+)+", node.value):
            yield re.escape(node.value)
        if isinstance(node, ast.JoinedStr):
            parts = [re.escape(v.value) if isinstance(v, ast.Constant) else r"\w*" for v in node.values]
            if isinstance(node.values[0], ast.Constant) and re.match(r"[a-z]+\.", node.values[0].value):
                yield "".join(parts)


PATTERNS = {pattern for path in SOURCES for pattern in literal_keys(path)}
ROOTS = {key.split(".")[0] for key in messages.TEXT}


@pytest.mark.parametrize("pattern", sorted(p for p in PATTERNS if p.split(r"\.")[0] in ROOTS))
def test_every_key_that_is_asked_for_is_there(pattern):
    assert any(re.fullmatch(pattern, key) for key in messages.TEXT), pattern


@pytest.mark.parametrize("key", sorted(messages.TEXT))
def test_every_text_can_be_said(key):
    known = any(re.fullmatch(pattern, key) for pattern in PATTERNS)
    tail = key.split(".", 1)[-1]
    by_gate = key.startswith("look.") and any(other.split(".", 1)[-1] == tail for other in messages.TEXT if other != key)
    assert known or by_gate or f'"{key}"' in WRITTEN, f"{key} is never said"


@pytest.mark.parametrize("key", sorted(messages.TEXT))
def test_texts_are_plain_sentences(key):
    text = messages.TEXT[key]
    fields = [name for _, name, _, _ in string.Formatter().parse(text) if name is not None]
    assert all(name.isidentifier() for name in fields)
    assert "  " not in text
    if key.split(".")[0] in ("right", "wrong", "look", "fact", "where", "finite", "pointwise", "repeat", "shape"):
        # A sentence, or one that ends in what a program said.
        assert text[-1] in ".?:" or text.endswith("}"), text


def test_each_relabelling_of_a_surface_and_each_reason_has_its_words():
    assert {f"relabel.{name}" for name in SURFACE_NAMES.values() if name != "id"} <= set(messages.TEXT)
    reasons = set(Reason.__args__)
    assert {f"answer.{reason}" for reason in reasons} <= set(messages.TEXT)
    assert {f"look.{reason}" for reason in reasons} <= set(messages.TEXT)


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [(0.0, 4, "0"), (-0.0, 4, "0"), (2.0, 4, "2"), (2.123456, 4, "2.123"), (2.123456, 6, "2.12346"), (1e-7, 4, "1e-07")],
)
def test_numbers_are_short(value, digits, text):
    assert messages.number(value, digits) == text


def test_rounding_errors_in_a_point_are_written_zero():
    assert messages.written([1e-17, 2.0, -3.5]) == "(0, 2, -3.5)"


def test_digits_grow_until_a_difference_shows():
    for deviation in (1.0, 1e-3, 1e-6, 1e-9):
        digits = messages.digits_for(deviation, 2.0)
        assert messages.number(2.0, digits) != messages.number(2.0 + deviation, digits)


@pytest.mark.parametrize(("names", "text"), [([], ""), (["a"], "a"), (["a", "b"], "a and b"), (["a", "b", "c"], "a, b and c")])
def test_lists_read_as_in_a_sentence(names, text):
    assert messages.listing(names) == text


@pytest.mark.parametrize(
    ("share", "text"),
    [
        (0.00123, "0.12 % of its size"),
        (0.5, "50 % of its size"),
        (0.997, "100 % of its size"),  # not 1e+02 %
        (13.2, "13 times its size"),
        (688.7, "690 times its size"),
        (3e8, "3e+08 times its size"),
    ],
)
def test_amounts(share, text):
    assert messages.amount(share) == text
