"""Copies are found however they are dressed, and nobody is named for what a class shares by nature."""

import difflib

import pytest

from autograder.integrity import THRESHOLD, Class, Part, compare, report_on
from tests.autograder.integrity.integrity_class import ORIGINAL, classroom, copies, parts, sample

FROM_ONE_MOULD = ("mistakes-", "half-finished", "skip-execution")  # members made of the texts in styles/*/mistakes.txt


def mould(student):
    return any(word in student for word in FROM_ONE_MOULD)


def most_equal_letters(first, second):
    """How alike the letters of two students' cells are in the exercise where they are most alike, by difflib, from 0 to 1."""
    pairs = [(one.source, two.source) for one in first for two in second if one.exercise == two.exercise]
    return max(difflib.SequenceMatcher(None, one, two, autojunk=False).ratio() for one, two in pairs)


@pytest.mark.parametrize("kind", list(copies()))
def test_each_kind_of_copy_is_found_above_every_honest_pair(kind):
    """One original, one copy, in the sample class: the pair is striking and stands above all pairs of different hands."""
    found = compare(classroom(zoe=parts(ORIGINAL), copy=copies()[kind]))
    (pair,) = (pair for pair in found.pairs if pair.students == ("copy", "zoe"))
    honest = [other.likeness for other in found.pairs if not all(map(mould, other.students)) and other is not pair]
    assert pair in found.striking
    assert pair.likeness > max(honest) + 0.1


def test_a_ring_of_copies_is_found():
    """All seven at once: each is striking beside the original, although what they share is no longer shared by two only."""
    found = compare(classroom(zoe=parts(ORIGINAL), **copies()))
    assert {pair.students for pair in found.striking if "zoe" in pair.students} == {(copy, "zoe") for copy in copies()}
    ring = {"zoe", *copies()}
    assert [pair.students for pair in found.striking if len(ring & set(pair.students)) == 1] == []


@pytest.mark.parametrize("name", ["A1", "A2", "A3", "A4", "A5"])
def test_no_honest_pair_of_the_sample_class_is_striking(name):
    """Six styles, slips, half-done work, cheats: all below. What is above are texts of one mould, varied by a few letters."""
    work = sample(name)
    found = compare(Class(parts=work))
    assert found.students == len(work) > 30
    assert max(pair.likeness for pair in found.pairs if not all(map(mould, pair.students))) < THRESHOLD - 0.1
    for pair in found.striking:
        first, second = (work[student] for student in pair.students)
        assert most_equal_letters(first, second) > 0.85, pair.students
    twins = [pair.students for pair in found.pairs if "skip-execution" in pair.students[1]][:1]
    assert "mistakes-1" in twins[0][0]  # the same text in every exercise, which the sample class does on purpose
    assert twins[0] == found.pairs[0].students


def test_what_was_handed_out_never_counts():
    """Two who handed in nothing but released code and the instructor's solution, long as both are, share nothing."""
    released = ORIGINAL["cylinder"] + ORIGINAL["torus"]
    solution = ORIGINAL["frustum"] + ORIGINAL["torus_class"]
    work = classroom(one=parts(ORIGINAL), two=parts(ORIGINAL))
    assert compare(work).pairs[0].students == ("one", "two")
    work.given += [released, solution]
    assert [pair for pair in compare(work).pairs if pair.students == ("one", "two")] == []


def test_what_many_wrote_never_counts():
    """The same long answer by a quarter of the class is the way to do it, not a ring."""
    crowd = {f"crowd{number:02d}": parts(ORIGINAL) for number in range(12)}
    found = compare(classroom(**crowd))
    assert [pair for pair in found.pairs if pair.students[0].startswith("crowd") and pair.students[1].startswith("crowd")] == []


def test_a_short_answer_is_never_striking_by_itself():
    """Three lines that only two have are not enough, though they are equal to the letter."""
    lines = "def cylinder(u, w, r, h):\n    a = u * math.tau\n    return np.dstack((np.cos(a) * r, np.sin(a) * r, w * h))"
    short = parts({"cylinder": lines})
    (pair,) = (pair for pair in compare(classroom(one=short, two=short)).pairs if pair.students == ("one", "two"))
    assert pair.whole.shared == min(pair.whole.of) > 0
    assert pair.likeness < THRESHOLD


def test_one_long_exercise_is_enough():
    """Who copied one long answer and wrote the rest alone is found by that exercise, which is named."""
    long = "\n".join(ORIGINAL.values())
    own = {name: sample("A1")[f"s0{number}-{name}"] for number, name in enumerate(("vectorised", "loops", "lists"), 1)}
    one, two = ([*own[name], Part("known-forms", "torus", 99, long)] for name in ("loops", "lists"))
    work = classroom(one=one, two=two)
    (pair,) = (pair for pair in compare(work).pairs if pair.students == ("one", "two"))
    assert max(pair.exercises, key=lambda name: pair.exercises[name].likeness) == "torus"
    assert pair.likeness == pair.exercises["torus"].likeness >= THRESHOLD
    assert pair.whole.likeness < pair.likeness


def test_syntax_errors_do_not_hide_a_copy():
    """Half a statement at the end, an open bracket at the top, a magic: the rest is compared as ever."""
    broken = {name: f"%matplotlib inline\nx = (\n{source}\nreturn 'never closed" for name, source in ORIGINAL.items()}
    found = compare(classroom(one=parts(ORIGINAL), two=parts(broken)))
    assert ("one", "two") in [pair.students for pair in found.striking]


def test_runs_tell_the_lines_on_both_sides():
    """The copy begins three lines lower; the longest run says so."""
    lower = {name: f"# mine\n\n{source.lstrip()}" for name, source in ORIGINAL.items()}
    report = report_on(classroom(one=parts(ORIGINAL), two=[*parts(lower)]), "A1", top=1)
    assert report.found.pairs[0].students == ("one", "two")
    longest = max(report.runs[0], key=lambda run: run.length)
    assert (longest.first.part.exercise, longest.second.part.exercise) == ("cylinder", "cylinder")
    assert (longest.first.begin, longest.first.end) == (1, 12)
    assert (longest.second.begin, longest.second.end) == (3, 14)


def test_the_top_pairs_are_the_first_of_all_pairs():
    """Asking for few leaves most pairs unlooked at, and changes nothing in the answer."""
    work = classroom(zoe=parts(ORIGINAL), **copies())
    every = compare(work)
    for top in (1, 5, 30):
        assert compare(work, top=top).pairs == every.pairs[:top]


def test_a_class_of_one_or_two_says_nothing():
    """Nothing is rare there, so nothing is alike."""
    assert compare(Class(parts={"one": parts(ORIGINAL)})).pairs == []
    assert all(pair.likeness == 0 for pair in compare(Class(parts={"one": parts(ORIGINAL), "two": parts(ORIGINAL)})).pairs)
