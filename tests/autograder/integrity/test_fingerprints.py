"""What tokens keep and leave out, and what winnowing guarantees."""

import random
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autograder.integrity.fingerprints import WINDOW, K, grams, winnow
from autograder.integrity.tokens import CHOSEN, tokens
from autograder.integrity.work import MOST_CODE


def texts(source):
    return [token.text.lstrip(CHOSEN) for token in tokens(source)]


@pytest.mark.parametrize(
    ("source", "kept"),
    [
        ("x = 2.0 * np.cos(t)  # turn", ["x", "=", "2", "*", "np", ".", "cos", "(", "t", ")"]),
        ('def f(a):\n    """Words."""\n    return "a"', ["def", "f", "(", "a", ")", ":", "return", "'"]),
        ("f(axis=-1)", ["f", "(", "axis", "=", "-", "1", ")"]),
        ("y = 1e-9 + 12 + 0.5", ["y", "=", "#", "+", "#", "+", "#"]),
        ("a = f'{x}' rb'z", ["a", "=", "'", "'"]),
        ('a = """never closed\\', ["a", "=", "'"]),
        ("", []),
    ],
)
def test_tokens_keep_what_carries_the_sense(source, kept):
    """Comments, docstrings, strings and odd numbers go; layout never counts."""
    assert texts(source) == kept


def test_lines_are_those_of_the_cell():
    """Continued lines, long strings and comments are counted."""
    found = tokens('a = \\\n  b\n# c\nd = """\n\n"""\ne')
    assert {token.text.lstrip(CHOSEN): token.line for token in found} == {"a": 1, "=": 4, "b": 2, "d": 4, "'": 4, "e": 7}


@given(st.text(max_size=300))
def test_any_text_has_tokens(source):
    """Nothing that a cell may hold is an error, and no line lies outside the cell."""
    assert all(1 <= token.line <= source.count("\n") + 1 for token in tokens(source))


@pytest.mark.parametrize("piece", ['"""a', '"', "\\", "(", "rb", "1e", "'''\\", '"\\'])
def test_hostile_text_is_read_in_one_pass(piece):
    """The most that is read of a submission takes about a second; to read on from each letter anew would take minutes."""
    begun = time.process_time()
    tokens(piece * (MOST_CODE // len(piece)))
    assert time.process_time() - begun < 20


def test_names_count_by_their_order_in_a_run():
    """Other names are the same run; other uses of the names are another."""
    one = grams(tokens("s = a * cos(b) + a * sin(b) + a"), 12)
    assert one == grams(tokens("q = r * cos(t) + r * sin(t) + r"), 12)
    assert one[0] != grams(tokens("s = a * cos(b) + b * sin(a) + b"), 12)[0]


@given(st.lists(st.integers(0, 50), min_size=1, max_size=80), st.integers(1, 8))
def test_every_window_has_a_fingerprint(hashes, window):
    """The guarantee of winnowing: of WINDOW hashes in a row one is chosen, so a match that long is never missed."""
    chosen = set(winnow(hashes, window))
    for start in range(len(hashes) - window + 1):
        assert chosen & set(range(start, start + window))


def test_a_shared_stretch_is_found_wherever_it_stands():
    """K + WINDOW - 1 shared tokens between unlike ones: the two streams share a fingerprint."""
    rng = random.Random(7)
    words = ["+", "-", "*", "/", "cos (", ")", "[", "]", "if", "for", "return", "==", "<"]
    for _ in range(50):
        shared = " ".join(rng.choices(words, k=60))
        shared = " ".join(shared.split()[: K + WINDOW - 1])
        marks = []
        for _ in range(2):
            around = [
                " ".join(rng.choices(["while", "pass", "lambda", "not", "1", "2"], k=rng.randint(0, 30))) for _ in range(2)
            ]
            hashes = grams(tokens(f"{around[0]} {shared} {around[1]}"))
            marks.append({hashes[place] for place in winnow(hashes)})
        assert marks[0] & marks[1]
