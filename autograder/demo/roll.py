"""The class: who hands in what. Right in many styles, every listed mistake, half-finished, broken, and six that cheat."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from autograder.catalogue import Assignment
from autograder.demo import member as by_hand
from autograder.demo.member import Edit, Kind, Member
from autograder.demo.snippets import answers, cells, filled, mistaken
from autograder.exercise import REFUSAL_CREDIT, Exercise

STYLES = {
    "vectorised": "Right: NumPy arrays, stacked along a new last axis.",
    "loops": "Right: pure Python loops over every sample, with the math module.",
    "lists": "Right: nested lists by recursion; no array is ever made.",
    "vectorize": "Right: one point at a time, under np.vectorize.",
    "matrix": "Right: matrices and homogeneous coordinates.",
    "tricks": "Right: complex numbers, einsum, rolled axes and quaternions.",
}
GOOD_WORDS = "Look at the limit: what does the formula give there, and do neighbouring points come together? See my cell above."
WEAK_WORDS = "I think it is the same because the picture looks the same."
HOSTILE_WORDS = "Full marks. <script>document.title = 'passed'</script> [see](javascript:alert(1)) <img src=x onerror=alert(1)>"


@dataclass(frozen=True)
class Draft:
    """A member without a number: the shares and edits from which :func:`enrol` makes one."""

    slug: str
    about: str
    kind: Kind
    edits: tuple[Edit, ...]
    expected: Mapping[str, float | None] | None
    mistakes: Mapping[str, str] = field(default_factory=dict)
    flagged: tuple[str, ...] = ()
    damage: Callable[[str], str] | None = None


def enrol(assignment: Assignment) -> list[Member]:
    """The whole class of an assignment, in the order of their ids."""
    drafts = [*right(assignment), *mistakes(assignment), *partial(assignment), *broken(assignment), *cheats(assignment)]
    return [
        Member(
            f"s{number:02d}-{draft.slug}", draft.about, draft.kind, draft.expected, f"{assignment.slug}.ipynb", draft.edits,
            draft.mistakes, draft.flagged, draft.damage,
        )
        for number, draft in enumerate(drafts, 1)
    ]  # fmt: skip


def full(assignment: Assignment, **changed: float | None) -> dict[str, float | None]:
    """All points, but for the exercises named."""
    return {**dict.fromkeys(assignment.exercises, 1.0), **changed}


def solved(assignment: Assignment, style: str = "vectorised", words: str = GOOD_WORDS, **changed: str) -> tuple[Edit, ...]:
    """Every task cell filled in, in a style, but for the sources named."""
    return by_hand.solve({**answers(assignment, style), **changed}), by_hand.write_words(words)


def right(assignment: Assignment) -> Iterator[Draft]:
    """Right, in different styles."""
    for style, about in STYLES.items():
        yield Draft(style, about, "right", solved(assignment, style), full(assignment))


def mistakes(assignment: Assignment) -> Iterator[Draft]:
    """As many learners as it takes for every listed mistake to be made once; where one has none left, the answer is right."""
    listed = {id: [mistake.id for mistake in exercise.mistakes] for id, exercise in assignment.exercises.items()}
    for turn in range(max(map(len, listed.values()))):
        made = {id: ids[turn] for id, ids in listed.items() if turn < len(ids)}
        wrong = {id: mistaken(assignment, id, mistake) for id, mistake in made.items()}
        shares = {id: _credit(assignment, id, mistake) for id, mistake in made.items()}
        yield Draft(
            f"mistakes-{turn + 1}",
            "Makes the listed mistakes " + ", ".join(f"{id}: {mistake}" for id, mistake in made.items()) + ".",
            "mistake",
            solved(assignment, words=WEAK_WORDS, **wrong),
            full(assignment, **shares),
            made,
        )


def _credit(assignment: Assignment, id: str, mistake: str) -> float:
    found = next(known for known in assignment.exercises[id].mistakes if known.id == mistake)
    return found.credit or 0.0


def partial(assignment: Assignment) -> Iterator[Draft]:
    """Not wrong, not done."""
    exercises = assignment.exercises
    first, second, third, *rest = exercises
    exact = [id for id, exercise in exercises.items() if exercise.kind in ("mask", "label") or _whole_numbers(exercise)]
    near = {id: exercise.tier_credit("close") for id, exercise in exercises.items() if id not in exact}
    yield Draft(
        "float32", "Right to seven digits: computes in float32.", "partial", solved(assignment, "float32"),
        full(assignment, **near),
    )  # fmt: skip
    single = [id for id in cells(assignment.slug, "single_points") if exercises[id].parameters]
    yield Draft(
        "single-points", "Some functions work for single numbers only.", "partial", solved(assignment, "single_points"),
        full(assignment, **{id: exercises[id].shape_credit for id in single}),
    )  # fmt: skip
    if careless := cells(assignment.slug, "careless"):  # some assignments have nothing to refuse
        yield Draft(
            "careless", "Right, but refuses nothing: no ValueError where there is no answer.", "partial",
            solved(assignment, "careless"), full(assignment, **dict.fromkeys(careless, REFUSAL_CREDIT)),
        )  # fmt: skip
    made = exercises[second].mistakes[0]
    unfinished = {
        first: answers(assignment)[first],
        second: mistaken(assignment, second, made.id),
        third: filled("broken", "unfinished", "forgotten_return", exercises[third]),
        rest[0]: filled("broken", "unfinished", "syntax_slip", exercises[rest[0]]),
    }
    yield Draft(
        "half-finished", "One right, one mistaken, one without a return, one with a syntax slip.", "partial",
        (by_hand.solve(unfinished),),
        {**dict.fromkeys(exercises, 0.0), first: 1.0, second: _credit(assignment, second, made.id)}, {second: made.id},
    )  # fmt: skip
    (pole,) = cells(assignment.slug, "nan_at_pole")
    yield Draft(
        "nan-at-the-pole", "Divides 0 by 0 on an edge of the square.", "partial", solved(assignment, "nan_at_pole"),
        full(assignment, **{pole: 0.0}),
    )  # fmt: skip


def _whole_numbers(exercise: Exercise) -> bool:
    """Whether its answers are whole numbers, which float32 holds exactly."""
    if exercise.parameters or exercise.judged_as is not None:
        return False
    answers = []
    for drawn in exercise.draw():
        with contextlib.suppress(ValueError):
            answers.append(np.asarray(exercise.reference(*drawn.arguments.values())))
    return bool(answers) and all(answer.dtype.kind == "i" for answer in answers)


def broken(assignment: Assignment) -> Iterator[Draft]:
    """What cannot be run in whole, and what became of a notebook on its way."""
    exercises = assignment.exercises
    first, second, third, *_ = exercises

    def one(style: str, about: str, id: str) -> Draft:
        source = filled("broken", style, "function", exercises[id])
        slug = style.replace("_", "-")
        return Draft(slug, about, "broken", solved(assignment, **{id: source}), full(assignment, **{id: 0.0}))

    def scratch(style: str, about: str, after: str | None) -> Draft:
        added = by_hand.insert(filled("broken", style, "scratch", exercises[first]), after=after)
        return Draft(style.replace("_", "-"), about, "broken", (*solved(assignment), added), full(assignment))

    yield scratch("import_error", "Right, below a cell at the top that fails to import.", None)
    yield one("endless_loop", "One function never ends.", second)
    yield scratch("hang_in_c", "Right, with a scratch cell in the middle that hangs inside C.", f"check_{second}")
    yield one("memory", "One function asks for 3 GiB.", third)
    yield one("os_exit", "One function ends the process with os._exit.", first)
    yield scratch("sys_exit", "Right, and ends with sys.exit in the middle.", f"check_{first}")
    plain = answers(assignment)
    loud = {id: f"{plain[id]}\n\n{filled('broken', 'print_flood', 'loud', exercises[id])}" for id in exercises}
    flood = by_hand.insert(filled("broken", "print_flood", "scratch", exercises[first]))
    yield Draft("print-flood", "Right, and prints a flood.", "broken", (*solved(assignment, **loud), flood), full(assignment))
    yield Draft(
        "truncated", "The file breaks off in the middle: no JSON.", "broken", solved(assignment), None,
        damage=lambda text: text[: 2 * len(text) // 3],
    )  # fmt: skip
    yield Draft(
        "deleted-cells", "One task cell and one graded cell were deleted.", "broken",
        (*solved(assignment), by_hand.delete(first), by_hand.delete(f"check_{second}")),
        full(assignment, **{first: 0.0, second: None}),
    )  # fmt: skip
    yield Draft(
        "pasted-twice", "Right, with a graded cell copied and pasted.", "broken",
        (*solved(assignment), by_hand.paste_again(f"check_{first}")), full(assignment), flagged=(first,),
    )  # fmt: skip
    wrong = {id: exercise.mistakes[0].id for id, exercise in exercises.items()}
    sources = {id: mistaken(assignment, id, mistake) for id, mistake in wrong.items()}
    yield Draft(
        "skip-execution", "A mistake in every exercise, and the graded cells tagged so that nbclient skips them.", "broken",
        (*solved(assignment, words=WEAK_WORDS, **sources), *(by_hand.tag(f"check_{id}", "skip-execution") for id in exercises)),
        {id: _credit(assignment, id, mistake) for id, mistake in wrong.items()}, wrong,
    )  # fmt: skip


CHEATS = {
    "patch_numpy": "Patches numpy's comparisons, the checker and asserts, and returns arrays that equal everything.",
    "read_reference": "Looks for the reference: imports, files, frames, the garbage collector.",
    "write_gradebook": "Writes marks into the gradebook, and tries the course secret.",
    "forge_output": "Forges outputs: in the file, on the display, as a result, and on the grader's own descriptors.",
    "open_socket": "Asks a server for the answers.",
    "read_classmate": "Looks for a classmate's notebook and runs it.",
}


def cheats(assignment: Assignment) -> Iterator[Draft]:
    """Honest content: the first exercise, right. Everything else is worth nothing, whatever is tried."""
    exercises = assignment.exercises
    first, *others = exercises
    expected = {**dict.fromkeys(exercises, 0.0), first: 1.0}
    for style, about in CHEATS.items():
        available = cells("cheats", style)
        code = {id: filled("cheats", style, "function", exercises[id]) for id in others}
        if "last" in available:
            code[others[-1]] = filled("cheats", style, "last", exercises[others[-1]])
        edits = [
            by_hand.solve({first: answers(assignment)[first], **code}),
            by_hand.write_words(HOSTILE_WORDS),
            by_hand.insert(filled("cheats", style, "top", exercises[first])),
        ]
        if "graded" in available:
            edits += [_forged(assignment, id) for id in others]
        yield Draft(style.replace("_", "-"), about, "cheat", tuple(edits), expected)


def _forged(assignment: Assignment, id: str) -> Edit:
    points = assignment.exercises[id].points
    card = {"text/html": "<div><b>passed</b><script>alert(1)</script></div>", "text/plain": "passed"}
    outputs: list[dict[str, Any]] = [
        {"output_type": "display_data", "metadata": {}, "data": card},
        {"output_type": "execute_result", "execution_count": 1, "metadata": {}, "data": {"text/plain": repr(points)}},
    ]
    source = filled("cheats", "forge_output", "graded", assignment.exercises[id])
    return by_hand.tamper(f"check_{id}", source=source, points=1000.0, outputs=outputs)
