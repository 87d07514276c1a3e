"""Where two students' code runs alike: the longest common runs of tokens, with their lines on both sides."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from autograder.integrity.fingerprints import K, grams
from autograder.integrity.tokens import Token, tokens
from autograder.integrity.work import Part

REPEATS = 8  # of one run of K tokens in one side; the rest are repetitions, and would cost time for each pair of them
MOST_RUNS = 30


@dataclass(frozen=True)
class Place:
    """Lines of a cell, from 1 and both included."""

    part: Part
    begin: int
    end: int


@dataclass(frozen=True)
class Run:
    """A common run: where it stands on both sides, how many tokens, and what its fingerprints weigh."""

    first: Place
    second: Place
    length: int
    bits: float


@dataclass(frozen=True)
class _Found:
    parts: tuple[int, int]
    starts: tuple[int, int]
    length: int
    bits: float


def common_runs(first: Sequence[Part], second: Sequence[Part], weights: Mapping[int, float]) -> list[Run]:
    """The common runs that say anything, by what they say; none overlaps another by more than half on either side."""
    texts = [[tokens(part.source) for part in side] for side in (first, second)]
    taken: list[set[tuple[int, int]]] = [set(), set()]
    kept: list[Run] = []
    for run in sorted(_diagonals(texts[0], texts[1], weights), key=lambda run: (-run.bits, -run.length, run.parts, run.starts)):
        mine = [{(part, start + i) for i in range(run.length)} for part, start in zip(run.parts, run.starts, strict=True)]
        if any(2 * len(new & old) > run.length for new, old in zip(mine, taken, strict=True)):
            continue
        for new, old in zip(mine, taken, strict=True):
            old |= new
        places = [
            _place(side[part], text[part], start, run.length)
            for side, text, part, start in zip((first, second), texts, run.parts, run.starts, strict=True)
        ]
        kept.append(Run(places[0], places[1], run.length, run.bits))
        if len(kept) == MOST_RUNS:
            break
    return kept


def _place(part: Part, stream: Sequence[Token], start: int, length: int) -> Place:
    return Place(part, stream[start].line, stream[start + length - 1].line)


def _diagonals(first: Sequence[list[Token]], second: Sequence[list[Token]], weights: Mapping[int, float]) -> Iterator[_Found]:
    """Maximal runs: equal hashes at places that go on together on both sides."""
    index: dict[int, list[tuple[int, int]]] = defaultdict(list)
    for part, stream in enumerate(second):
        for place, hash in enumerate(grams(stream)):
            if len(index[hash]) < REPEATS:
                index[hash].append((part, place))
    for part, stream in enumerate(first):
        hashes = grams(stream)
        places: dict[tuple[int, int], list[int]] = defaultdict(list)
        for place, hash in enumerate(hashes):
            for other, there in index.get(hash, ()):
                places[other, there - place].append(place)
        for (other, shift), together in places.items():
            for begin, end in _unbroken(together):
                bits = sum(weights.get(hash, 0.0) for hash in set(hashes[begin : end + 1]))
                if bits > 0:
                    yield _Found((part, other), (begin, begin + shift), end - begin + K, bits)


def _unbroken(numbers: Sequence[int]) -> Iterator[tuple[int, int]]:
    """First and last of each stretch of consecutive numbers in a rising sequence."""
    begin = 0
    for place, number in enumerate(numbers):
        if place + 1 == len(numbers) or numbers[place + 1] != number + 1:
            yield numbers[begin], number
            begin = place + 1
