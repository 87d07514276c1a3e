"""Fingerprints of token streams: winnowing (Schleimer, Wilkerson, Aiken: Winnowing, SIGMOD 2003).

Every run of K tokens is hashed; of each WINDOW hashes in a row the least is a fingerprint (of equal ones the last). Two streams
that share K + WINDOW - 1 tokens in a row share a fingerprint, wherever it stands; below K tokens nothing is seen.

Names that a learner chose are counted in the order in which they first appear *in the run*: ``a * cos(b) + a`` is ``r * cos(t)
+ r`` and is not ``a * cos(b) + b``; a run reads alike wherever it is moved (Baker 1995 calls this a parameterized match).
"""

from __future__ import annotations

from collections.abc import Sequence
from hashlib import blake2b

from autograder.integrity.tokens import CHOSEN, Token

K = 12
WINDOW = 4


def grams(stream: Sequence[Token], k: int = K) -> list[int]:
    """A hash, the same on every machine, for each run of k tokens: len(stream) - k + 1 of them, or none."""
    texts = [token.text for token in stream]
    return [_hash(texts[start : start + k]) for start in range(len(texts) - k + 1)]


def winnow(hashes: Sequence[int], window: int = WINDOW) -> list[int]:
    """Places of the fingerprints among the hashes, in order."""
    if not hashes:
        return []
    chosen: list[int] = []
    for start in range(max(len(hashes) - window + 1, 1)):
        part = range(start, min(start + window, len(hashes)))
        least = min(part, key=lambda place: (hashes[place], -place))
        if not chosen or chosen[-1] != least:
            chosen.append(least)
    return chosen


def _hash(texts: list[str]) -> int:
    numbers: dict[str, str] = {}
    plain = [numbers.setdefault(text, f"{CHOSEN}{len(numbers)}") if text[0] == CHOSEN else text for text in texts]
    return int.from_bytes(blake2b("\n".join(plain).encode("utf-8", "surrogatepass"), digest_size=8).digest(), "big")
