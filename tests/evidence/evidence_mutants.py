"""What the judge says of a changed answer, and what is true of it: each in a child process with limits of its own.

A mutant may never end, ask for all memory or leave the interpreter, so each is run in a child of a fork, under a limit of
processor time. The oracle decides first whether it is still right; then the judge is asked, with every sentence of the message
catalogue marked by its key, so that what a learner is told can be sorted.
"""

from __future__ import annotations

import contextlib
import json
import os
import random
import re
import resource
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from evidence_mutation import Mutation, mutations
from evidence_oracle import Oracle
from evidence_solutions import Solution, solutions

from autograder import messages
from autograder.catalogue import shipped
from autograder.errors import CallFailed
from autograder.exercise import PUBLIC_SEED, Exercise
from autograder.judge import judge

JUDGED = b"a course, a learner, an assignment"  # the seed of the hidden data
# The data that are judged, and others: what is equal on both is right, what differs on either must not pass.
ORACLE_SEEDS = [PUBLIC_SEED, JUDGED, *(f"oracle {number}" for number in range(6))]
ONE_CALL = 5.0  # seconds of processor time, as the sandbox would stop it
HARD = 90  # seconds of processor time for all of one mutant
MEMORY = 2 << 30  # above what the process has when it is made
MARK = re.compile("⟦([^⟧]*)⟧")
# What a message tells beyond the one worst place, by the keys of its sentences; the first of these that is met counts.
TELLS = {
    "gate": r"(error|finite|pointwise|repeat|shape|answer|value\.shape)\."
    r"|wrong\.(no_error|also_no_error|other_error|hidden_error|built)",
    "geometry": r"wrong\.(relabelled|other_start|close|same_set|covered|collapsed|more|part|moved)",
    "rule": r"fact\.(?!coordinates?_wrong)|value\.(?!entries|shape)",
    "place": r"right\.(one_coordinate|coordinates|edge|end|face|corner|sets|blind|contrast|only_side|up_to|from|outside)"
    r"|spans\.|fact\.|wrong\.(mask|yes_no|word_case|not_|tuple|item|different_)",
}


@dataclass(frozen=True)
class Outcome:
    """One mutant: what was changed, what the oracle says, what the judge says.

    ``opinion`` is "equal", "differs", "borderline" or "endless"; ``told`` is "named", one of ``TELLS`` or "neither", and empty
    where it passed.
    """

    exercise: str
    style: str
    kind: str
    line: int
    was: str
    now: str
    opinion: str
    deviation: float
    place: str
    passed: bool
    fraction: float = 0.0
    tier: str = ""
    mistake: str = ""
    told: str = ""
    keys: tuple[str, ...] = ()
    message: str = ""

    @property
    def passed_wrongly(self) -> bool:
        """Full marks for what is not right."""
        return self.passed and self.opinion in ("differs", "endless")

    @property
    def refused_wrongly(self) -> bool:
        """Less than full marks for what is right."""
        return not self.passed and self.opinion == "equal"


def drawn(count: int, seed: int, only: Sequence[str] = ()) -> list[tuple[Solution, Mutation]]:
    """So many mutants, the same number (but for one) of each answer in each style, drawn with a fixed seed."""
    chosen = [s for exercise in shipped() for s in solutions(exercise.id) if not only or exercise.id in only]
    order = list(range(len(chosen)))
    random.Random(seed).shuffle(order)
    share = {number: count // len(chosen) + (place < count % len(chosen)) for place, number in enumerate(order)}
    found: list[tuple[Solution, Mutation]] = []
    for number, solution in enumerate(chosen):
        names = shipped().find(solution.exercise).parameters
        rng = random.Random(f"{seed} {solution.name}")
        found += [(solution, mutation) for mutation in mutations(solution.source, share[number], rng, names)]
    return found


def outcomes(work: Sequence[tuple[Solution, Mutation]]) -> Iterator[Outcome]:
    """Each mutant of one exercise in a child process."""
    exercise = shipped().find(work[0][0].exercise)
    oracle = Oracle(exercise, ORACLE_SEEDS)
    for solution, mutation in work:
        yield in_child(lambda told, s=solution, m=mutation: _examine(exercise, oracle, s, m, told))


def in_child(work: Callable[[Callable[[Outcome], None]], None]) -> Outcome:
    """Run ``work`` in a fork under limits; the last outcome that it told counts, also where the child was killed later."""
    sys.stdout.flush()
    read_end, write_end = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(read_end)
        status = 1
        try:
            resource.setrlimit(resource.RLIMIT_CPU, (HARD, HARD + 5))
            most = MEMORY + int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
            resource.setrlimit(resource.RLIMIT_AS, (most, most))
            nowhere = os.open(os.devnull, os.O_RDWR)
            for descriptor in (0, 1, 2):
                os.dup2(nowhere, descriptor)
            with os.fdopen(write_end, "w", encoding="utf-8") as pipe:

                def tell(outcome: Outcome) -> None:
                    pipe.write(json.dumps(asdict(outcome)) + "\n")
                    pipe.flush()

                work(tell)
            status = 0
        finally:
            os._exit(status)
    os.close(write_end)
    with os.fdopen(read_end, encoding="utf-8") as pipe:
        told = [json.loads(line) for line in pipe]
    os.waitpid(child, 0)
    return Outcome(**{**told[-1], "keys": tuple(told[-1]["keys"])})


class _Endless(BaseException):
    """The time for one call is over."""


@contextlib.contextmanager
def limited(seconds: float) -> Iterator[None]:
    """Raise :class:`_Endless` in the body after so many seconds of processor time."""

    def stop(*_: Any) -> None:
        raise _Endless

    signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)


def _examine(
    exercise: Exercise, oracle: Oracle, solution: Solution, mutation: Mutation, tell: Callable[[Outcome], None]
) -> None:
    about = {
        "exercise": exercise.id, "style": solution.style, "kind": mutation.kind, "line": mutation.line,
        "was": mutation.was, "now": mutation.now,
    }  # fmt: skip
    # Until more is known: a mutant that kills its process, which a sandbox survives and calls an error.
    tell(Outcome(**about, opinion="endless", deviation=1e300, place="", passed=False, tier="error", told="gate"))
    try:
        with limited(ONE_CALL):
            function = solution.function(mutation.source)
    except (Exception, _Endless, SystemExit):
        function = None
    if function is None:
        tell(Outcome(**about, opinion="differs", deviation=1e300, place="its cell", passed=False, tier="error", told="gate"))
        return
    try:
        with limited(HARD / 3):
            opinion = oracle.opinion(_guarded(function, raising=True))
        known = Outcome(
            **about, opinion=opinion.word, deviation=min(opinion.deviation, 1e300), place=opinion.place, passed=False
        )
    except _Endless:
        known = Outcome(**about, opinion="endless", deviation=1e300, place="", passed=False)
    tell(replace(known, tier="timeout", told="gate"))
    tell(_judged(exercise, function, known))


def _judged(exercise: Exercise, function: Callable[..., Any], known: Outcome) -> Outcome:
    for key, text in messages.TEXT.items():
        messages.TEXT[key] = f"⟦{key}⟧{text}"  # in this child only
    verdict = judge(exercise, _guarded(function), seed=JUDGED, figure=False)
    keys = tuple(dict.fromkeys(MARK.findall(verdict.message)))
    passed = verdict.fraction == 1.0
    told = "" if passed else "named" if verdict.mistake else tells(keys)
    return replace(
        known, passed=passed, fraction=verdict.fraction, tier=verdict.tier, mistake=verdict.mistake or "", told=told, keys=keys,
        message=MARK.sub("", verdict.message),
    )  # fmt: skip


def tells(keys: Sequence[str]) -> str:
    """The first of ``TELLS`` that a message with sentences of these keys has to offer, or "neither"."""
    return next((told for told, wanted in TELLS.items() if any(re.match(wanted, key) for key in keys)), "neither")


def _guarded(function: Callable[..., Any], *, raising: bool = False) -> Callable[..., Any]:
    """The function with a limit for each call, which the judge meets as it meets the sandbox's."""

    def call(*arguments: Any) -> Any:
        if raising:
            return function(*arguments)
        try:
            with limited(ONE_CALL):
                return function(*arguments)
        except _Endless:
            raise CallFailed("timeout", f"it took longer than {ONE_CALL:g} s") from None

    return call
