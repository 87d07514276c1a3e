"""The judge held to every exercise: its reference, its stub, its listed mistakes, and right answers in many styles."""

from __future__ import annotations

import functools
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from evidence_solutions import distinct, solutions, traits

from autograder.catalogue import shipped
from autograder.exercise import PUBLIC_SEED
from autograder.judge import judge


@functools.cache
def syllabus() -> dict[str, list[str]]:
    """The ids of the mistakes that the syllabus lists for each exercise, as they stand in its tables."""
    found: dict[str, list[str]] = json.loads(Path(__file__).with_name("syllabus_mistakes.json").read_text("utf-8"))
    return found


def random_seeds(count: int, of: str) -> list[bytes]:
    """So many seeds as a course makes them: bytes that nobody chose by hand, the same every time."""
    rng = np.random.default_rng(int.from_bytes(of.encode()[:8], "big"))
    return [rng.bytes(16) for _ in range(count)]


@dataclass(frozen=True)
class Mistakes:
    """One exercise: seeds at which the reference has full marks, seeds at which the stub has none, and mistakes that are named.

    ``listed``: mistakes that stand in the syllabus; ``mistakes``: all. ``public``: named on the released data; ``random``:
    mistakes named under every one of the random seeds.
    """

    assignment: str
    exercise: str
    seeds: int
    reference: int
    stub: int
    listed: int
    mistakes: int
    public: int
    random: int
    failures: tuple[str, ...] = ()


def mistakes_of(id: str, seeds: int) -> Mistakes:
    """Judge the reference, the stub and every mistake on the released data and under so many random seeds."""
    exercise = shipped().find(id)
    failures: list[str] = []
    every = [PUBLIC_SEED, *random_seeds(seeds, f"mistakes {id}")]

    def stub(*_: Any) -> None:
        raise NotImplementedError

    reference = stubs = 0
    named = {mistake.id: 0 for mistake in exercise.mistakes}
    public = 0
    missing = [name for name in syllabus().get(id, []) if name not in named]
    failures += [f"the syllabus lists {name}, which is not there" for name in missing]
    for seed in every:
        verdict = judge(exercise, exercise.reference, seed=seed, figure=False)
        if (verdict.fraction, verdict.tier) == (1.0, "identical"):
            reference += 1
        else:
            failures.append(f"the reference under {seed!r}: {verdict.tier}. {verdict.message}")
        verdict = judge(exercise, stub, seed=seed, figure=False)
        if (verdict.fraction, verdict.outcome) == (0.0, "not run"):
            stubs += 1
        else:
            failures.append(f"the stub under {seed!r}: {verdict.outcome}, {verdict.fraction:g}")
        for mistake in exercise.mistakes:
            verdict = judge(exercise, mistake.formula, seed=seed, figure=False)
            if verdict.mistake != mistake.id:
                failures.append(f"{mistake.id} under {seed!r}: {verdict.tier}, {verdict.mistake}. {verdict.message}")
            elif seed == PUBLIC_SEED:
                public += 1
            else:
                named[mistake.id] += 1
    return Mistakes(
        _assignment(id), id, seeds, reference, stubs, len(syllabus().get(id, [])) - len(missing), len(named), public,
        sum(count == seeds for count in named.values()), tuple(failures),
    )  # fmt: skip


@dataclass(frozen=True)
class Styles:
    """One exercise: how many answers of different normal form there are, with which tools, and how often one was refused."""

    assignment: str
    exercise: str
    seeds: int
    styles: int
    distinct: int
    traits: tuple[str, ...]
    judged: int
    refused: int
    failures: tuple[str, ...] = ()


def styles_of(id: str, seeds: int | Sequence[bytes]) -> Styles:
    """Judge every right answer under each seed; anything but full marks is a failure.

    Every fifth seed is that of hidden data, with the released data beside them and samples of their own, as in grading; the
    others are judged as released data are, which costs half as much.
    """
    exercise = shipped().find(id)
    every = random_seeds(seeds, f"styles {id}") if isinstance(seeds, int) else list(seeds)
    failures: list[str] = []
    judged = 0
    found = solutions(id)
    for solution in found:
        function = solution.function()
        for number, seed in enumerate(every):
            released = PUBLIC_SEED if number % 5 == 0 else seed
            with np.errstate(all="ignore"):
                verdict = judge(exercise, function, seed=seed, public_seed=released, figure=False, search=False)
            judged += 1
            if verdict.fraction != 1.0:
                failures.append(f"{solution.style} under {seed!r}: {verdict.tier}, {verdict.fraction:g}. {verdict.message}")
    used = sorted({trait for solution in found for trait in traits(solution.source)})
    return Styles(
        _assignment(id), id, len(every), len(found), len(distinct(id)), tuple(used), judged, len(failures), tuple(failures)
    )


def _assignment(id: str) -> str:
    return next(a.name for a in shipped().assignments if id in a.exercises)
