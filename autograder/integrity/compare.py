"""Which two students share what few others have.

A fingerprint says the more the fewer have it: among n students, log2(n / number who have it) bits, as a word's weight in a
library (Spärck Jones 1972, inverse document frequency). None at all has what was handed out, what the instructor's solution
does, and what more than COMMON of the class wrote: a cylinder of five lines is the same for everybody.

    likeness(a, b) = bits that both have / (bits of the one who has fewer + DOUBT)

DOUBT, what DOUBTFUL fingerprints weigh that only two have, stands for what chance shares. It keeps short answers low, however
alike they are: three rare fingerprints, and nothing else, are a likeness of 0.2 at most.

An index from each fingerprint to its students finds the pairs, so that the time grows with the class and not with its square:
a fingerprint that more than MOST have is common in any class.
"""

from __future__ import annotations

import heapq
import math
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations

from autograder.integrity.fingerprints import grams, winnow
from autograder.integrity.tokens import tokens
from autograder.integrity.work import Class, Part

Marks = Mapping[int, set[str]]  # fingerprints, each with the exercises where it stands
COMMON, FEWEST, MOST = 0.2, 3, 40
DOUBTFUL = 10
THRESHOLD = 0.6  # between what answers of one's own reach and what copies reach: docs/integrity.md has both
SMALL_CLASS = 10


@dataclass(frozen=True)
class Share:
    """What two students have in common in one exercise, or in all: likeness, fingerprints of both and of either one, bits."""

    likeness: float
    shared: int
    of: tuple[int, int]
    bits: float


@dataclass(frozen=True)
class Pair:
    """Two students, in the order of their ids, over all exercises and in each that says anything."""

    students: tuple[str, str]
    whole: Share
    exercises: Mapping[str, Share]

    @property
    def likeness(self) -> float:
        """Of the whole, or of the exercise that is most alike: one long answer may be all that was copied."""
        return max([self.whole.likeness, *(share.likeness for share in self.exercises.values())])


@dataclass(frozen=True)
class Likenesses:
    """A compared class.

    Attributes
    ----------
    pairs : by falling likeness
    students : how many were compared
    linked : how many pairs share anything rare at all
    weights : bits of each fingerprint that says something
    """

    pairs: list[Pair]
    students: int
    linked: int
    weights: Mapping[int, float] = field(repr=False)

    @property
    def striking(self) -> list[Pair]:
        """The pairs at or above the threshold."""
        return [pair for pair in self.pairs if pair.likeness >= THRESHOLD]


def compare(work: Class, *, top: int | None = None) -> Likenesses:
    """Compare everybody with everybody who shares anything rare.

    Parameters
    ----------
    work : Class
        What was read, or made by hand.
    top : int, optional
        Only so many pairs, those most alike.
    """
    given = {hash for text in work.given for hash in grams(tokens(text))}
    marks = {student: _marks(parts, given) for student, parts in work.parts.items()}
    holders: dict[int, list[str]] = defaultdict(list)
    for student in sorted(marks):
        for hash in marks[student]:
            holders[hash].append(student)
    count = len(marks)
    most = min(max(int(COMMON * count), FEWEST), MOST)
    weights = {hash: math.log2(count / len(who)) for hash, who in holders.items() if len(who) <= most}
    shared: dict[tuple[str, str], list[int]] = defaultdict(list)
    for hash in weights:
        for pair in combinations(holders[hash], 2):
            shared[pair].append(hash)
    scale = _Scale(weights, DOUBTFUL * max(math.log2(max(count, 2) / 2), 1.0))
    return Likenesses(_most_alike(shared, marks, scale, top), count, len(shared), weights)


@dataclass(frozen=True)
class _Scale:
    weights: Mapping[int, float]
    doubt: float

    def bits(self, hashes: Iterable[int]) -> float:
        return sum(self.weights.get(hash, 0.0) for hash in hashes)

    def share(self, shared: Sequence[int], first: Sequence[int], second: Sequence[int]) -> Share:
        bits = self.bits(shared)
        fewer = min(self.bits(first), self.bits(second))
        return Share(bits / (fewer + self.doubt), len(shared), (len(first), len(second)), bits)


def _marks(parts: Sequence[Part], given: set[int]) -> Marks:
    """The fingerprints of a student that were not handed out, each with the exercises where it stands."""
    found: dict[int, set[str]] = defaultdict(set)
    for part in parts:
        hashes = grams(tokens(part.source))
        for place in winnow(hashes):
            if hashes[place] not in given:
                found[hashes[place]].add(part.exercise)
    return found


def _most_alike(
    shared: Mapping[tuple[str, str], list[int]], marks: Mapping[str, Marks], scale: _Scale, top: int | None
) -> list[Pair]:
    """The pairs in order. Who shares s bits has a likeness of s / (s + doubt) at most: with ``top``, few are looked at."""
    bits = {who: scale.bits(hashes) for who, hashes in shared.items()}
    best: list[float] = []
    pairs: list[Pair] = []
    for who in sorted(shared, key=lambda who: (-bits[who], who)):
        if top is not None and len(best) >= max(top, 1) and bits[who] / (bits[who] + scale.doubt) < best[0]:
            break
        pairs.append(_pair(who, shared[who], marks, scale))
        heapq.heappush(best, pairs[-1].likeness)
        if top is not None and len(best) > max(top, 1):
            heapq.heappop(best)
    pairs.sort(key=lambda pair: (-pair.likeness, -pair.whole.bits, pair.students))
    return pairs if top is None else pairs[:top]


def _pair(who: tuple[str, str], shared: list[int], marks: Mapping[str, Marks], scale: _Scale) -> Pair:
    first, second = ({hash: where for hash, where in marks[student].items() if hash in scale.weights} for student in who)
    exercises = {}
    for name in sorted({name for hash in shared for name in first[hash] & second[hash]}):
        there = [[hash for hash, where in side.items() if name in where] for side in (first, second)]
        exercises[name] = scale.share([hash for hash in shared if name in first[hash] & second[hash]], *there)
    return Pair(who, scale.share(shared, list(first), list(second)), exercises)
