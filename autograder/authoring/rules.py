"""What every exercise must keep, whoever writes it: each mistake is real, is seen, and is told from the others.

A rule is a function of an exercise and some seeds that yields what breaks it, each with what to do. Most must hold; some are
advice on wording. ``directrix author check`` prints them, and the tests hold the shipped exercises to all of them.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from autograder.authoring.sampling import answer, apart, refuses
from autograder.catalogue import Assignment
from autograder.curvedata import CurveData, SurfaceData
from autograder.errors import CourseError
from autograder.exercise import PUBLIC_SEED, Drawn, Exercise, Mistake
from autograder.judge import judge
from autograder.notebook import own, source

SEEN = 0.01  # relative to the size: five times what the ladder still calls "close"
SAME = 1e-9
SEEDS = tuple(range(10))
JUDGED: tuple[int | bytes, ...] = (PUBLIC_SEED, 7, b"a course's secret, a student and a digest")
WORDS = (15, 75)  # of a hint: long enough to help, short enough to be read


@dataclass(frozen=True)
class Breach:
    """One rule that an exercise or a notebook breaks. ``must`` False: advice, which fails nothing."""

    exercise: str
    rule: str
    said: str
    to_do: str
    must: bool = True

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self)


Found = Iterator[tuple[str, str]]
Rule = Callable[[Exercise, Sequence[int]], Found]
RULES: dict[str, Rule] = {}
ADVICE: dict[str, Rule] = {}


def breaches(assignment: Assignment, seeds: Sequence[int] = SEEDS) -> Iterator[Breach]:
    """What is wrong with an assignment: first its notebook, then exercise by exercise."""
    yield from _of_notebook(assignment)
    for exercise in assignment.exercises.values():
        yield from of_exercise(exercise, seeds)


def of_exercise(exercise: Exercise, seeds: Sequence[int] = SEEDS) -> list[Breach]:
    """What is wrong with one exercise. Where its data or its reference fail, that alone is said: the rest hangs on them."""
    for name in ("data", "reference"):
        if found := list(_asked(exercise, name, RULES[name], seeds, must=True)):
            return found
    asked = [(name, rule, True) for name, rule in RULES.items() if name not in ("data", "reference")]
    asked += [(name, rule, False) for name, rule in ADVICE.items()]
    return [breach for name, rule, must in asked for breach in _asked(exercise, name, rule, seeds, must=must)]


def _asked(exercise: Exercise, name: str, rule: Rule, seeds: Sequence[int], *, must: bool) -> Iterator[Breach]:
    try:
        for said, to_do in rule(exercise, seeds):
            yield Breach(exercise.id, name, said, to_do, must)
    except Exception as error:
        said = f"asking for this ended in {type(error).__name__}: {error}"
        yield Breach(exercise.id, name, said, "mend the function that fails: a data set, the reference or a mistake")


def _of_notebook(assignment: Assignment) -> Iterator[Breach]:
    if not assignment.source.is_file():
        said = f"there is no {assignment.source.name} beside the exercises"
        to_do = "write one, or pose them in a notebook of your own: each graded cell is exactly check(name)"
        yield Breach(assignment.folder.name, "notebook", said, to_do, must=False)
        return
    try:
        built = source.build(assignment)
        code = [(cell.source, bool(cell.metadata.get("nbgrader", {}).get("locked"))) for cell in built.cells]
        for said in own.without_word(code, assignment.exercises.values()):
            yield Breach(assignment.folder.name, "notebook", said, "each student's numbers are drawn from that word and the id")
    except CourseError as error:
        yield Breach(assignment.folder.name, "notebook", str(error), "mend that cell of the notebook source")


def _rule(name: str, where: dict[str, Rule]) -> Callable[[Rule], Rule]:
    def register(rule: Rule) -> Rule:
        where[name] = rule
        return rule

    return register


# Rules that must hold -------------------------------------------------------------------------------------------------------


@_rule("data", RULES)
def data_are_there_and_come_from_rng_alone(exercise: Exercise, seeds: Sequence[int]) -> Found:
    """A data set that decides; the same seed, the same data; another seed, other data."""
    if not exercise.data_sets:
        yield "there is no data set", f"write one: @{exercise.id}.data above a function of rng that returns the arguments"
        return
    if all(known.blind for known in exercise.data_sets):
        yield "all data sets are blind, and those never decide alone", "add one without blind=True, with numbers that differ"
    for one, again in zip(exercise.draw(seeds[0]), exercise.draw(seeds[0]), strict=True):
        if _written(one) != _written(again):
            to_do = "take every random number from rng, not from np.random, random or the clock"
            yield f"data set {one.name!r} differs from one drawing to the next under one seed", to_do
    drawn = [[_written(one) for one in exercise.draw(seed)] for seed in seeds[:2]]
    if exercise.arguments != exercise.parameters and len(drawn) == 2 and drawn[0] == drawn[1]:
        to_do = "draw numbers of at least one data set from rng: what a learner knows by heart must not be all that is asked"
        yield "no data set changes with the seed", to_do


@_rule("reference", RULES)
def the_reference_has_full_marks(exercise: Exercise, seeds: Sequence[int]) -> Found:
    """Its own judge passes it, under the public seed and others."""
    for seed in JUDGED:
        verdict = judge(exercise, exercise.reference, seed=seed, figure=False)
        if (verdict.outcome, verdict.fraction, verdict.tier) != ("passed", 1.0, "identical"):
            said = f"its own judge says of the reference: {verdict.outcome}, {verdict.tier} ({verdict.message})"
            yield said, "mend the reference, or the data that it cannot take"
            return


@_rule("shape", RULES)
def the_reference_has_the_promised_shape(exercise: Exercise, seeds: Sequence[int]) -> Found:
    """For numbers, vectors, open meshes and empty arrays."""
    axes = len(exercise.parameters)
    if not axes:
        return
    tail = () if exercise.kind == "mask" else (3,)
    mesh = np.meshgrid(*[np.linspace(0, 1, n + 2) for n in range(axes)], indexing="ij", sparse=True)
    places: dict[str, tuple[Sequence[Any], tuple[int, ...]]] = {
        "numbers": ([0.5] * axes, ()),
        "vectors of 5": ([np.linspace(0, 1, 5)] * axes, (5,)),
        "an open mesh": (mesh, tuple(range(2, 2 + axes))),
        "empty arrays": ([np.empty(0)] * axes, (0,)),
    }
    for drawn in exercise.draw(seeds[0]):
        if refuses(answer(exercise, exercise.reference, drawn)):
            continue
        for what, (where, shape) in places.items():
            got = np.shape(exercise.reference(*where, *drawn.arguments.values()))
            if got != (*shape, *tail):
                said = f"for {what} the reference must return shape {(*shape, *tail)}; got {got} on {drawn.name!r}"
                yield said, "let the parameters broadcast and stack x, y, z on a new last axis"


@_rule("stub", RULES)
def nothing_scores_nothing(exercise: Exercise, seeds: Sequence[int]) -> Found:
    """The untouched stub, and the laziest legal answer: zeros of the right shape."""

    def stub(*args: Any) -> Any:
        raise NotImplementedError

    def zeros(*args: Any) -> Any:
        try:
            return np.zeros_like(exercise.reference(*args))
        except ValueError:
            return 0.0

    verdict = judge(exercise, stub, seed=7, figure=False)
    if (verdict.outcome, verdict.fraction) != ("not run", 0.0):
        yield (
            f"the untouched stub scores {verdict.fraction:g} ({verdict.outcome})",
            "look at the data sets: none may be met by it",
        )
    if exercise.kind == "label":
        return
    verdict = judge(exercise, zeros, seed=7, figure=False)
    if verdict.fraction > 0.0:
        yield f"an array of zeros scores {verdict.fraction:g}", "add a data set on which the right answer is far from 0"


@_rule("seen", RULES)
def each_mistake_is_seen(exercise: Exercise, seeds: Sequence[int]) -> Found:
    """A blind data set never decides alone, and no draw of random data may hide a mistake."""
    data = [(seed, [drawn for drawn in exercise.draw(seed) if not drawn.blind]) for seed in seeds]
    for mistake in [*exercise.mistakes, *exercise.ways]:
        for seed, seeing in data:
            far = {drawn.name: _distance(exercise, mistake.formula, drawn) for drawn in seeing}
            if max(far.values()) <= SEEN:
                told = ", ".join(f"{distance:.2g} on {name!r}" for name, distance in far.items())
                said = f"mistake {_named(mistake)} hardly differs from the reference under seed {seed} (of its size: {told})"
                yield said, f"add a data set that is not blind and on which it differs by more than {SEEN:g}"
                break


@_rule("told apart", RULES)
def no_two_mistakes_coincide(exercise: Exercise, seeds: Sequence[int]) -> Found:
    """Else the judge could not tell which one was made."""
    found = set()
    for seed in seeds[:10]:
        data = exercise.draw(seed)
        every = [*exercise.mistakes, *exercise.ways]
        answers = {_named(m): [answer(exercise, m.formula, drawn) for drawn in data] for m in every}
        for (one, first), (other, second) in itertools.combinations(answers.items(), 2):
            if (one, other) not in found and max(map(apart, first, second)) <= SEEN:
                found.add((one, other))
                to_do = "add a data set on which they differ, or make one mistake of the two"
                yield f"mistakes {one} and {other} give the same answers on all data under seed {seed}", to_do


@_rule("named", RULES)
def each_mistake_is_named_as_itself(exercise: Exercise, seeds: Sequence[int]) -> Found:
    """By the judge, with the credit that was set."""
    for mistake in [*exercise.mistakes, *exercise.ways]:
        for seed in JUDGED:
            verdict = judge(exercise, mistake.formula, seed=seed, figure=False)
            if (verdict.mistake, verdict.tier) != (mistake.id, "mistake") or mistake.hint not in verdict.message:
                got = f"as {verdict.mistake!r}" if verdict.mistake else f"not at all (tier {verdict.tier!r})"
                said = f"the judge names mistake {_named(mistake)} {got} under seed {seed!r}"
                yield said, "make it differ more, from the reference or from that other mistake"
                break
            if mistake.credit is not None and verdict.fraction != mistake.credit:
                earns = f"earns {verdict.fraction:g} under seed {seed!r}, not its credit {mistake.credit:g}"
                said = f"mistake {_named(mistake)} {earns}"
                yield said, "see that it handles every shape of input and refuses what the reference refuses"
                break


@_rule("blind", RULES)
def data_sets_are_what_they_claim(exercise: Exercise, seeds: Sequence[int]) -> Found:
    """Some mistake stays invisible on blind data; other data see one, unless they ask for a refusal."""
    for drawn in exercise.draw() if exercise.mistakes else ():
        right = answer(exercise, exercise.reference, drawn)
        seen = {m.id: apart(right, answer(exercise, m.formula, drawn)) > SAME for m in exercise.mistakes}
        if drawn.blind and all(seen.values()):
            yield (
                f"data set {drawn.name!r} is called blind and hides no mistake",
                "take blind=True away, or choose blinder numbers",
            )
        elif not drawn.blind and not refuses(right) and not any(seen.values()):
            yield (
                f"data set {drawn.name!r} sees no mistake",
                "call it blind=True if that is its lesson, else choose other numbers",
            )


@_rule("hints", RULES)
def hints_say_something_of_their_own(exercise: Exercise, seeds: Sequence[int]) -> Found:
    """A hint is there, holds no line of code, and is not another mistake's."""
    if not exercise.mistakes:
        to_do = f"write one: @{exercise.id}.mistake('name', credit=0.5) above the wrong formula, its docstring the hint"
        yield "there is no known mistake, so nothing can be named", to_do
    hints: dict[str, str] = {}
    for mistake in exercise.mistakes:
        if not mistake.hint.strip():
            yield f"mistake {mistake.id!r} has an empty hint", "write its docstring: what was done, and what to look at"
        elif mistake.hint in hints:
            yield f"mistakes {hints[mistake.hint]!r} and {mistake.id!r} have the same hint", "say what makes each its own"
        elif "np." in mistake.hint or re.search(r"\breturn\b", mistake.hint):
            yield (
                f"the hint of mistake {mistake.id!r} holds code",
                "say what to look at; the line of code is the learner's to find",
            )
        hints.setdefault(mistake.hint, mistake.id)


# Advice ---------------------------------------------------------------------------------------------------------------------


@_rule("wording", ADVICE)
def hints_speak_to_the_learner(exercise: Exercise, seeds: Sequence[int]) -> Found:
    """Long enough to help, short enough to be read, and it says "you"; its credit is a decision."""
    least, most = WORDS
    for mistake in exercise.mistakes:
        words = len(mistake.hint.split())
        if not least <= words <= most:
            yield f"the hint of mistake {mistake.id!r} has {words} words", f"between {least} and {most} are read and help"
        if not re.search(r"\byou(rs?)?\b", mistake.hint, re.IGNORECASE):
            yield (
                f"the hint of mistake {mistake.id!r} does not speak to the learner",
                'say what was done: "You ...", "Your ..."',
            )
        if mistake.credit is None:
            to_do = "set credit= to what a learner with this mistake has understood"
            yield f"mistake {mistake.id!r} has no credit of its own; it earns what its tier earns", to_do


@_rule("statement", ADVICE)
def the_statement_names_every_argument(exercise: Exercise, seeds: Sequence[int]) -> Found:
    """Units and shapes are told where the inputs are named."""
    unnamed = [name for name in exercise.arguments if not re.search(rf"\b{name}\b", exercise.statement)]
    if unnamed:
        yield (
            f"the statement does not name {', '.join(unnamed)}",
            "tell shape, unit and domain of every argument in the docstring",
        )
    if not exercise.statement.startswith("Return "):
        yield "the statement does not begin with what to return", 'begin the docstring with "Return ..."'


def _named(mistake: Mistake) -> str:
    return repr(mistake.id) + (f", written in way {mistake.way + 1}," if mistake.way else "")


def _distance(exercise: Exercise, formula: Callable[..., Any], drawn: Drawn) -> float:
    return apart(answer(exercise, exercise.reference, drawn), answer(exercise, formula, drawn))


def _written(drawn: Drawn) -> list[bytes]:
    return [_value(value) for value in drawn.arguments.values()]


def _value(value: Any) -> bytes:
    if isinstance(value, CurveData | SurfaceData):
        return value.coefficients.tobytes()
    if isinstance(value, tuple):
        return b"|".join(map(_value, value))
    return value.tobytes() if isinstance(value, np.ndarray) else repr(value).encode()
