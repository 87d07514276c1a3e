"""The gates: what an answer must be before it is worth comparing.

Shapes for numbers, vectors and open meshes; finite on the closed square; pointwise; repeatable. A function that handles some
shapes of input but not all is judged by those that it handles.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from autograder.comparison import values as value_rungs
from autograder.comparison.answers import Answer, Numbers, Raised, Unreadable, Word
from autograder.comparison.asking import PAIR, Asked
from autograder.comparison.maps import Sampled, agree
from autograder.comparison.nearest import Evaluator
from autograder.comparison.samples import Form
from autograder.comparison.target import ROUNDING, Target
from autograder.messages import listing, say
from autograder.result import Tier

LARGEST = 1e150  # beyond it squares of lengths, of which all comparisons are made, overflow


@dataclass(frozen=True)
class Gate:
    """What stopped a comparison: its tier, and a key of the message catalogue with the facts that fill it in."""

    tier: Tier
    key: str
    facts: dict[str, Any] = field(default_factory=dict)
    where: tuple[float, ...] | None = None


@dataclass(frozen=True)
class Trouble:
    """A form of input that the function does not handle."""

    form: Form
    key: str
    facts: dict[str, Any] = field(default_factory=dict)


@dataclass(eq=False)
class Gated:
    """One data set after the gates: stopped by one of them, or with values to compare."""

    target: Target
    stopped: Gate | None = None
    sampled: Sampled | None = None  # of a map
    answer: Answer | None = None  # of anything else, and of a map whose right answer is to raise
    surface: Evaluator | None = None  # of an answer judged as a surface
    troubles: tuple[Trouble, ...] = ()
    empty: Trouble | None = None  # a remark only


def through_gates(asked: Sequence[Asked]) -> list[Gated]:
    """Hold the answers on all data sets to the gates."""
    gated = [_through(one) for one in asked]
    fatal = next((error_gate(one.fatal) for one in asked if one.fatal is not None), None)
    if fatal is not None:
        for one, place in zip(gated, asked, strict=True):
            if place.vector is None:
                one.stopped = Gate(fatal.tier, "error.not_reached")
    repeat = next((g.stopped for g in gated if g.stopped is not None and g.stopped.tier == "not repeatable"), None)
    for one in gated:
        # What changes from call to call also changes with what else is in the array; that is not the point then.
        if repeat is not None and one.stopped is not None and one.stopped.tier == "not pointwise":
            one.stopped = repeat
    return gated


def _through(asked: Asked) -> Gated:
    target, gated = asked.target, Gated(asked.target)
    if asked.fatal is not None:
        gated.stopped = error_gate(asked.fatal)
    elif asked.vector is None:
        return gated  # not reached
    elif target.raises:
        gated.answer = asked.vector
    elif target.exercise.parameters:
        _map_gates(asked, gated)
    else:
        _value_gates(asked, gated)
    return gated


def error_gate(failure: Raised) -> Gate:
    """The gate for a call that ended in an exception or in a limit."""
    facts = {
        "exception": failure.exception or say("told.error"),
        "message": failure.message,
        "line": failure.line,
        "source": failure.source.strip(),
    }
    if failure.kind != "error":
        return Gate("timeout" if failure.kind == "timeout" else "error", f"error.{failure.kind}", facts)
    if failure.is_a("NotImplementedError"):
        return Gate("error", "error.stub", facts)
    if "read-only" in failure.message or "read only" in failure.message:
        return Gate("error", "error.writes", facts)
    if failure.is_a("TypeError") and ("positional argument" in failure.message or "required positional" in failure.message):
        return Gate("error", "error.signature", facts)
    for name in ("RecursionError", "NameError", "ImportError", "SystemExit", "ZeroDivisionError", "AxisError", "IndexError"):
        if failure.is_a(name):
            return Gate("error", f"error.{name}", facts)
    return Gate("error", "error.exception", facts)


def unreadable_gate(answer: Unreadable) -> Gate:
    """The gate for an answer that is not numbers."""
    return Gate("error", f"answer.{answer.reason}", dict(answer.facts))


def _map_gates(asked: Asked, gated: Gated) -> None:
    target = asked.target
    tail = target.values.shape[1:]
    wanted = {"vector": target.values.shape, "mesh": (*target.samples.mesh.shape, *tail), "scalar": tail}
    answers = {"vector": asked.vector, "mesh": asked.mesh, "scalar": asked.scalar}
    if all(isinstance(a, Raised) for a in answers.values()) and isinstance(asked.vector, Raised):
        gated.stopped = error_gate(asked.vector)
        return
    asked_for: tuple[Form, ...] = ("vector", "mesh", "scalar")
    forms = [form for form in asked_for if answers[form] is not None]
    troubles = [t for form in forms if (t := _trouble(target, form, answers[form], wanted[form])) is not None]
    handled = [form for form in forms if form not in {t.form for t in troubles}]
    if not handled:
        gated.stopped = _no_form(target, asked, answers, troubles)
        return
    gated.troubles = tuple(troubles)
    gated.sampled = _sampled(asked, handled)
    gated.stopped = _finite_gate(gated.sampled) or _again_gate(asked) or _pointwise_gate(asked, gated.sampled, handled)
    if asked.empty is not None:
        gated.empty = _trouble(target, "vector", asked.empty, (0, *tail))


def _trouble(target: Target, form: Form, answer: Answer | None, wanted: tuple[int, ...]) -> Trouble | None:
    """Why an answer has not the shape that this form of input asks for; None where it has."""
    if isinstance(answer, Numbers) and answer.values.shape == wanted:
        return None
    names = target.names
    facts: dict[str, Any] = {"form": form, "given": _given(target, form), "wanted": str(wanted), "names": names}
    if isinstance(answer, Raised):
        gate = error_gate(answer)
        key = "shape.raised_writes" if gate.key == "error.writes" else "shape.raised"
        return Trouble(form, key, {**facts, "exception": answer.exception, "message": answer.message.rstrip(".")})
    if isinstance(answer, Unreadable):
        return Trouble(
            form,
            f"shape.{answer.reason}" if answer.reason in ("parts", "none", "object") else "shape.unreadable",
            {**facts, **answer.facts},
        )
    if not isinstance(answer, Numbers):
        return Trouble(form, "shape.unreadable", {**facts, "type": "text"})
    got = answer.values.shape
    facts["got"] = str(got)
    count = wanted[0] if form == "vector" else 0
    points = target.values.ndim > 1  # a mask has one number a place, and no coordinates
    if points and len(wanted) > 1 and got == (wanted[-1], *wanted[:-1]):
        return Trouble(form, "shape.coordinates_first", facts)
    if form == "vector" and len(names) == 2 and got[:2] == (count, count):
        return Trouble(form, "shape.own_mesh", facts)
    if form == "mesh" and len(got) > 1 and got == (wanted[1], wanted[0], *wanted[2:]):
        return Trouble(form, "shape.mesh_transposed", facts)
    if points and got == wanted[:-1]:
        return Trouble(form, "shape.one_coordinate", facts)
    if points and got == wanted[-1:] and form != "scalar":
        return Trouble(form, "shape.one_point", facts)
    if points and got[:-1] == wanted[:-1]:
        return Trouble(form, "shape.coordinates", {**facts, "count": got[-1], "coordinates": wanted[-1]})
    return Trouble(form, "shape.other", facts)


def _given(target: Target, form: Form) -> str:
    """The shapes of the parameters in this form, ``(9, 1) and (1, 7)``; empty for single numbers."""
    if form == "scalar":
        return ""
    arrays = target.samples.columns() if form == "vector" else target.samples.open_mesh()
    return listing(sorted({str(a.shape) for a in arrays}, reverse=True))


def _no_form(target: Target, asked: Asked, answers: dict[str, Answer | None], troubles: list[Trouble]) -> Gate:
    """The gate for a function that handles no form of input."""
    if isinstance(asked.vector, Unreadable):
        return unreadable_gate(asked.vector)
    if isinstance(asked.vector, Word):
        return unreadable_gate(Unreadable("text", {"text": repr(asked.vector.text[:40])}))
    shapes = {a.values.shape for a in answers.values() if isinstance(a, Numbers)}
    if len(shapes) == 1 and all(isinstance(a, Numbers) for a in answers.values()):
        return Gate("not pointwise", "pointwise.own_parameters", {"got": str(shapes.pop())})
    if isinstance(asked.vector, Raised):
        first = next(t for t in troubles if t.form != "vector" and t.key != "shape.raised")
        return Gate("shape", first.key, first.facts)
    return Gate("shape", troubles[0].key, troubles[0].facts)


def _sampled(asked: Asked, handled: list[Form]) -> Sampled:
    """The values at the samples, from the richest form that the function handles."""
    target, samples = asked.target, asked.target.samples
    if "vector" in handled:
        assert isinstance(asked.vector, Numbers)
        return Sampled(target, np.arange(len(samples.points)), asked.vector.values)
    if "mesh" in handled:
        assert isinstance(asked.mesh, Numbers)
        tail = target.values.shape[1:]
        return Sampled(target, samples.mesh.ravel(), asked.mesh.values.reshape(-1, *tail))
    tail = target.values.shape[1:]
    every = [
        (i, a.values)
        for i, a in zip(samples.singles, asked.singles or (), strict=False)
        if isinstance(a, Numbers) and a.values.shape == tail
    ]
    assert isinstance(asked.scalar, Numbers)
    every.append((np.intp(len(samples.points) - 1), asked.scalar.values))
    return Sampled(target, np.array([i for i, _ in every]), np.stack([v for _, v in every]))


def _finite_gate(f: Sampled) -> Gate | None:
    good = np.abs(f.values) < LARGEST
    if good.all():
        return None
    bad: NDArray[np.bool_] = np.asarray(~good.reshape(len(f.values), -1).all(axis=1))
    place = f.points[bad]
    corners = [p for p in place if np.isin(p, (0.0, 1.0)).all()]
    at = tuple(float(x) for x in (corners or place)[0])
    on_edges = bool(np.isin(place, (0.0, 1.0)).any(axis=1).all())
    key = "finite.corner" if corners and len(corners) == len(place) else "finite.edges" if on_edges else "finite.inside"
    return Gate("not finite", key, {"count": int(bad.sum()), "total": len(bad)}, at)


def _pointwise_gate(asked: Asked, f: Sampled, handled: list[Form]) -> Gate | None:
    """The same parameters must give the same point, whatever array they come in."""
    samples = f.target.samples
    rounding = 16 * ROUNDING * float(np.abs(f.values).max(initial=0.0))
    place = np.full(len(samples.points), -1)
    place[f.indices] = np.arange(len(f.indices))

    def differs(answer: Answer | None, indices: NDArray[np.intp]) -> bool:
        if not isinstance(answer, Numbers):
            return False
        known = place[indices] >= 0
        table = answer.values.reshape(len(indices), *f.values.shape[1:])
        mine, same = table[known], f.values[place[indices][known]]
        if agree(mine, same, rounding):  # and so within what is allowed, which takes longer to find
            return False
        # float32 answers differ in their last digits with the length of the array: matrix products are summed in other orders.
        room = 2 * f.target.allowed if f.identical else max(f.target.allowed, 1e-5 * f.target.size)
        return not agree(mine, same, rounding + room)

    last = len(samples.points)
    if isinstance(asked.pair, Numbers) and asked.pair.values.shape == (2, *f.target.values.shape[1:]):
        if differs(asked.pair, np.array([last + i for i in PAIR])):
            return Gate("not pointwise", "pointwise.alone")
    elif asked.pair is not None and "vector" in handled:
        return Gate("not pointwise", "pointwise.length")
    if "scalar" in handled and differs(asked.scalar, np.array([last - 1])):
        return Gate("not pointwise", "pointwise.alone")
    if "mesh" in handled and "vector" in handled and differs(asked.mesh, samples.mesh.ravel()):
        return Gate("not pointwise", "pointwise.mesh")
    return None


def _again_gate(asked: Asked) -> Gate | None:
    first, second = asked.vector, asked.again
    if second is None or isinstance(first, Raised):
        return None
    if isinstance(second, Raised):
        return Gate("not repeatable", "repeat.raised", {"exception": second.exception, "message": second.message})
    if not _equal_answers(asked.target, first, second):
        return Gate("not repeatable", "repeat.other")
    return None


def _equal_answers(target: Target, first: Answer | None, second: Answer) -> bool:
    if isinstance(first, Numbers) and isinstance(second, Numbers):
        largest = float(np.abs(np.nan_to_num(first.values)).max(initial=0.0))
        return agree(first.values, second.values, 1e-9 * largest)
    if first is None or isinstance(first, Unreadable | Raised):
        return True
    return value_rungs.same(target, second, first)


def _value_gates(asked: Asked, gated: Gated) -> None:
    target, answer = asked.target, asked.vector
    assert answer is not None
    gated.answer = answer
    if isinstance(answer, Raised):
        gated.stopped = error_gate(answer)
    elif (
        isinstance(answer, Unreadable)
        and answer.reason in ("parts", "ragged")
        and isinstance(target.expected, Numbers)
        and not target.is_map
    ):
        gated.stopped = Gate("shape", "answer.pieces", {"wanted": str(target.expected.values.shape)})
    elif isinstance(answer, Unreadable):
        gated.stopped = unreadable_gate(answer)
    elif (bad := value_rungs.first_unreadable(answer)) is not None:
        gated.stopped = unreadable_gate(bad)
    elif value_rungs.not_finite(answer):
        gated.stopped = Gate("not finite", "finite.value")
    else:
        gated.stopped = _again_gate(asked)
        if gated.stopped is None and target.exercise.judged_as is not None:
            _as_surface(target, answer, gated)


def _as_surface(target: Target, answer: Answer, gated: Gated) -> None:
    """Turn an answer into the surface that is compared."""
    try:
        gated.surface = target.surface(plain(answer))
        values = gated.surface(target.samples.points)
    except Exception as failure:  # whatever the exercise's own function says of a net that it cannot take
        gated.stopped = Gate("shape", "answer.no_surface", {"message": " ".join(str(failure).split())[:300]})
        return
    if values.shape != target.values.shape:
        gated.stopped = Gate("shape", "answer.no_surface", {"message": say("told.values", shape=values.shape)})
        return
    gated.sampled = Sampled(target, np.arange(len(values)), values)
    gated.stopped = _finite_gate(gated.sampled)


def plain(answer: Answer) -> Any:
    """An answer as the values it was read from."""
    if isinstance(answer, Numbers):
        return answer.values
    items = getattr(answer, "items", None)
    return tuple(plain(item) for item in items) if items is not None else getattr(answer, "text", None)
