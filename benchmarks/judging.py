"""How long `check` lets a learner wait, for a right answer, a listed mistake, the same set of points, and the worst case.

    uv run python benchmarks/judging.py [--assignment A3] [--rounds 1] [--slowest 5]

Times the judge from the call to the finished card and figure, on one thread if OPENBLAS_NUM_THREADS=1 is set. "First" is with
nothing remembered of the exercise, as after a restart of the kernel; "again" is the second check of the same answer. Beside
them stands the ratio to the time spent in the learner's own function. A target that the median of "first" misses is said to be
missed, and the exit code is 1 then.

right        the reference itself
mistake      every listed mistake
same set     u replaced by u², for each curve, surface and solid
worst        turned, shifted and traced in another way; and that, bent as well, so that nothing is recognised
"""

from __future__ import annotations

import argparse
import os
import statistics
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from autograder import card
from autograder.catalogue import shipped
from autograder.comparison import target
from autograder.exercise import Exercise
from autograder.judge import judge

TARGETS = {"right": 0.1, "mistake": 0.1, "same set": 1.0, "worst": 3.0}  # seconds, of the median
Answer = Callable[..., Any]


@dataclass(frozen=True)
class Timed:
    """One check: its case, what was checked, seconds the first time and again, seconds in the learner's function, the tier."""

    case: str
    name: str
    first: float
    again: float
    own: float
    tier: str


class Learner:
    """A function that keeps the time spent in it."""

    def __init__(self, function: Answer) -> None:
        self.function, self.seconds = function, 0.0

    def __call__(self, *arguments: Any) -> Any:
        """Its answer."""
        start = time.perf_counter()
        try:
            return self.function(*arguments)
        finally:
            self.seconds += time.perf_counter() - start


def turned() -> np.ndarray:
    """A rotation about a skew axis."""
    axis = np.array([2.0, -1.0, 2.0]) / 3.0
    cross = np.cross(np.eye(3), axis)
    return np.eye(3) + np.sin(0.7) * cross + (1 - np.cos(0.7)) * cross @ cross


def answers(exercise: Exercise) -> Iterator[tuple[str, str, Answer]]:
    """The answers to try: case, name, function."""
    yield "right", exercise.id, exercise.reference
    for mistake in exercise.mistakes:
        yield "mistake", f"{exercise.id}: {mistake.id}", mistake.formula
    if exercise.kind not in ("curve", "surface", "solid"):
        return
    count = len(exercise.parameters)

    def slowed(*arguments: Any) -> Any:
        parameters = [np.asarray(one, dtype=float) for one in arguments[:count]]
        return exercise.reference(parameters[0] ** 2, *parameters[1:], *arguments[count:])

    def moved(*arguments: Any) -> Any:
        return slowed(*arguments) @ turned() + (0.3, -0.2, 0.5)

    def bent(*arguments: Any) -> Any:
        points = moved(*arguments)
        return points + 0.1 * np.sin(points[..., [1, 2, 0]])

    yield "same set", f"{exercise.id}(u²)", slowed
    yield "worst", f"{exercise.id}, moved", moved
    yield "worst", f"{exercise.id}, moved and bent", bent


def checked(exercise: Exercise, learner: Learner) -> tuple[float, str]:
    """Seconds from the call to the card and the figure, and the tier."""
    start = time.perf_counter()
    verdict = judge(exercise, learner)
    card.bundle(verdict)
    card.figure_bundle(verdict)
    return time.perf_counter() - start, verdict.tier


def timed(exercise: Exercise, case: str, name: str, function: Answer, rounds: int) -> Timed:
    """Check one answer, forgetting the exercise before each round."""
    first, again, own, tier = [], [], [], ""
    for _ in range(rounds):
        target.forget()
        learner = Learner(function)
        seconds, tier = checked(exercise, learner)
        first.append(seconds)
        own.append(learner.seconds)
        again.append(checked(exercise, learner)[0])
    return Timed(case, name, statistics.median(first), statistics.median(again), statistics.median(own), tier)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--assignment", help="A3, say; every assignment unless it is given")
    parser.add_argument("--rounds", type=int, default=1)
    parser.add_argument("--slowest", type=int, default=3, help="how many of the slowest of each case are named")
    options = parser.parse_args()
    catalogue = shipped()
    chosen = [catalogue.assignment(options.assignment)] if options.assignment else list(catalogue.assignments)
    exercises = [exercise for assignment in chosen for exercise in assignment.exercises.values()]
    warm = exercises[0]
    checked(warm, Learner(warm.reference))  # what is loaded at the first figure is not the judge's
    every = [
        timed(exercise, *answer, options.rounds) for exercise in exercises for answer in answers(exercise)
    ]  # fmt: skip
    names = ", ".join(assignment.name for assignment in chosen)
    print(f"{len(exercises)} exercises of {names}, {os.cpu_count()} processors; milliseconds, medians")
    print(f"{'case':10s} {'checks':>6s} {'first':>8s} {'slowest':>8s} {'again':>8s} {'÷ own':>7s}  {'target':>7s}")
    missed = 0
    for case, wanted in TARGETS.items():
        found = [one for one in every if one.case == case]
        if not found:
            continue
        median = statistics.median(one.first for one in found)
        again = statistics.median(one.again for one in found)
        ratio = statistics.median(one.first / max(one.own, 1e-6) for one in found)
        missed += median > wanted
        verdict = "met" if median <= wanted else "MISSED"
        slowest = max(one.first for one in found)
        print(
            f"{case:10s} {len(found):6d} {1e3 * median:8.1f} {1e3 * slowest:8.1f} {1e3 * again:8.1f} {ratio:7.1f}  "
            f"{1e3 * wanted:7.0f}  {verdict}, {sum(one.first > wanted for one in found)} of {len(found)} checks above it"
        )
    for case in TARGETS:
        for one in sorted((one for one in every if one.case == case), key=lambda one: -one.first)[: options.slowest]:
            print(f"  slow {case}: {one.name} ({one.tier}) {1e3 * one.first:.0f} ms, of these {1e3 * one.own:.0f} its own")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
