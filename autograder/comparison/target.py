"""The reference on one data set: its values at the samples, its size, its known mistakes and its relabelled selves.

Values are found when they are first asked for and kept. Public data are the same for every learner, so their targets are kept
for the next one too.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

from autograder.comparison.answers import Answer, Array, Numbers, Raised, Several, Unreadable, raised, read
from autograder.comparison.nearest import Evaluator
from autograder.comparison.samples import Samples, read_only, samples
from autograder.comparison.sets import Measured, measured
from autograder.comparison.symmetry import Symmetry, symmetries
from autograder.errors import ExerciseError
from autograder.exercise import PUBLIC_SEED, Drawn, Exercise, Mistake, generator

ROUNDING = 64 * float(np.finfo(float).eps)
SIZE_GRID = {1: 65, 2: 33, 3: 13}
KEPT = 128  # exercises whose public targets are remembered


class Target:
    """What one data set of an exercise expects. Raises ExerciseError where the exercise itself fails."""

    def __init__(self, exercise: Exercise, drawn: Drawn, seed: int | str | bytes, *, hidden: bool) -> None:
        self.exercise = exercise
        self.drawn = drawn
        self.hidden = hidden
        self.arguments = tuple(drawn.arguments.values())
        names = exercise.parameters or (("u", "w") if exercise.judged_as else ())
        self.names = names
        rng = generator(seed, exercise.id, drawn.name, "samples") if hidden else None
        self._samples = samples(len(names), rng, keep_grid=exercise.kind == "mask") if names else None
        self._relabelled: dict[str, Array] = {}
        self._mistakes: dict[tuple[str, int], Answer] = {}
        self._mistakes_relabelled: dict[tuple[str, str], Array | None] = {}
        self.pictures: dict[tuple[int, float], Any] = {}  # kept here by the room that draws

    @property
    def name(self) -> str:
        """Name of the data set."""
        return self.drawn.name

    @property
    def samples(self) -> Samples:
        """The sample points of a map; a value has none."""
        assert self._samples is not None
        return self._samples

    @property
    def is_map(self) -> bool:
        """Whether answers are compared over parameters: surfaces, curves, solids, masks, and answers judged as surfaces."""
        return self._samples is not None

    @cached_property
    def expected(self) -> Answer:
        """The right answer: for a map Numbers (N, 3) at the samples, or Raised where it is right to raise ValueError."""
        return self._at_samples(self.exercise.reference, "the reference")

    @property
    def raises(self) -> bool:
        """Whether the right answer is a ValueError."""
        return isinstance(self.expected, Raised)

    @property
    def values(self) -> Array:
        """The right values of a map at the samples, (N, 3)."""
        assert isinstance(self.expected, Numbers)
        return self.expected.values

    @cached_property
    def answer(self) -> Any:
        """The reference's own answer where it is judged as a surface."""
        return self._guarded(self.exercise.reference, self.arguments, "the reference")

    @cached_property
    def is_tuple(self) -> bool:
        """Whether the right answer has several parts."""
        if self.exercise.judged_as is not None:
            return isinstance(self.answer, tuple)
        return isinstance(self.expected, Several)

    def at(self, points: Array) -> Array:
        """The right values at any parameters (N, n)."""
        found = self._map(self.exercise.reference, points, "the reference")
        if isinstance(found, Raised):
            raise ExerciseError(f"{self._place('the reference')} fails at some parameters: {found.message}")
        return found

    def mistake(self, known: Mistake) -> Answer:
        """What a known mistake answers at the samples."""
        key = known.id, known.way
        if key not in self._mistakes:
            self._mistakes[key] = self._at_samples(known.formula, f"mistake {known.id!r}")
        return self._mistakes[key]

    def mistake_relabelled(self, known: Mistake, symmetry: Symmetry) -> Array | None:
        """The values at the samples of that f for which f∘σ is the mistake; None where it raises."""
        key = known.id, symmetry.name
        if key not in self._mistakes_relabelled:
            points = np.concatenate([s.inverse(self.samples.points) for s in self.symmetries])
            found = self._map(known.formula, points, f"mistake {known.id!r}")
            parts = [None] * len(self.symmetries) if isinstance(found, Raised) else np.split(found, len(self.symmetries))
            for s, values in zip(self.symmetries, parts, strict=True):
                self._mistakes_relabelled[known.id, s.name] = values
        return self._mistakes_relabelled[key]

    def relabelled(self, symmetry: Symmetry) -> Array:
        """The values at the samples of that f for which f∘σ is the reference."""
        if symmetry.name not in self._relabelled:
            todo = [s for s in self.symmetries if s.name not in self._relabelled]
            points = np.concatenate([s.inverse(self.samples.points) for s in todo])
            for s, values in zip(todo, np.split(self.at(points), len(todo)), strict=True):
                self._relabelled[s.name] = values
        return self._relabelled[symmetry.name]

    @property
    def symmetries(self) -> tuple[Symmetry, ...]:
        """The relabellings of its parameters, the identity first."""
        return symmetries(self.names)

    @cached_property
    def size(self) -> float:
        """D: the diagonal of the bounding box of the reference on a 33 x 33 grid; never 0."""
        if not self.is_map or self.exercise.kind == "mask" or self.raises:
            return 1.0
        values = self._on_size_grid()
        diagonal = float(np.linalg.norm(values.max(axis=0) - values.min(axis=0)))
        return diagonal or float(np.abs(values).max()) or 1.0

    def _on_size_grid(self) -> Array:
        """The right values there, (N, 3): asked for on an open mesh, where a tensor product costs least, or point by point."""
        axes = _size_axes(len(self.names))
        try:
            with np.errstate(all="ignore"):
                formula = self.exercise.reference if self.exercise.judged_as is None else self.exercise.judged_as(self.answer)
                more = self.arguments if self.exercise.judged_as is None else ()
                values = np.asarray(formula(*axes, *more), dtype=float)
        except Exception:  # somebody's own reference may take vectors only
            values = np.empty(0)
        shape = np.broadcast_shapes(*(axis.shape for axis in axes))
        if values.shape[:-1] == shape and np.isfinite(values).all():
            return values.reshape(-1, values.shape[-1])
        return self.at(np.stack(np.broadcast_arrays(*axes), axis=-1).reshape(-1, len(axes)))

    @cached_property
    def measured(self) -> Measured:
        """Its length, area or volume, and starting points for searches on it."""
        return measured(self.at, len(self.names))

    @cached_property
    def allowed(self) -> float:
        """The deviation that still counts as identical: the exercise's tolerance times D, and never less than rounding."""
        return self.exercise.tolerance * self.size + self.rounding

    @cached_property
    def rounding(self) -> float:
        """What rounding alone makes of the right values. Less than ``allowed``, and found without the size."""
        return ROUNDING * float(np.abs(self.values).max(initial=0.0))

    @cached_property
    def data_scale(self) -> float:
        """The largest number among the arguments: what rounding errors of a value are measured by."""
        numbers = [np.abs(np.asarray(a, dtype=float)) for a in self.arguments if isinstance(a, np.ndarray | int | float)]
        return max((float(n.max()) for n in numbers if n.size), default=1.0) or 1.0

    @cached_property
    def breaks(self) -> tuple[Array, ...] | None:
        """Per parameter the places where pieces of the map meet, 0 and 1 among them; None where it is not said."""
        if self.exercise.spans is None:
            return None
        given = self._guarded(self.exercise.spans, self.arguments, "spans")
        if isinstance(given, Raised) or len(given) != len(self.names):
            raise ExerciseError(
                f"{self._place('spans')} must return the places for each of {', '.join(self.names)}; got {given!r}"
            )
        return tuple(np.unique(np.concatenate([[0.0], np.asarray(one, dtype=float), [1.0]])) for one in given)

    def surface(self, value: Any) -> Evaluator:
        """An answer judged as a surface, evaluated at points (N, 2). Raises whatever ``judged_as`` raises."""
        judged_as = self.exercise.judged_as
        assert judged_as is not None
        surface = judged_as(value)

        def at(points: Array) -> Array:
            with np.errstate(all="ignore"):
                return np.asarray(surface(*points.T), dtype=float)

        return at

    def _at_samples(self, formula: Callable[..., Any], who: str) -> Answer:
        if self.is_map:
            found = self._map(formula, self.samples.points, who)
            return found if isinstance(found, Raised) else Numbers(found)
        value = self._guarded(formula, self.arguments, who)
        if isinstance(value, Raised):
            return value
        answer = read(value, whole=False)
        if isinstance(answer, Unreadable):
            raise ExerciseError(f"{self._place(who)} returned a {type(value).__name__}, which cannot be compared")
        return answer

    def _map(self, formula: Callable[..., Any], points: Array, who: str) -> Array | Raised:
        columns = tuple(read_only(np.ascontiguousarray(column)) for column in points.T)
        if self.exercise.judged_as is None:
            value = self._guarded(formula, (*columns, *self.arguments), who)
        else:
            value = self._guarded(formula, self.arguments, who)
            if not isinstance(value, Raised):
                value = self._guarded(lambda: self.surface(value)(points), (), f"{who}, judged as a surface,")
        if isinstance(value, Raised):
            return value
        values = np.asarray(value, dtype=float)
        wanted = 1 if self.exercise.kind == "mask" else 2
        if values.ndim != wanted or len(values) != len(points):
            raise ExerciseError(
                f"{self._place(who)} must return shape ({len(points)}, 3) for {len(points)} points; got {values.shape}"
            )
        return values

    def _guarded(self, formula: Callable[..., Any], arguments: tuple[Any, ...], who: str) -> Any:
        try:
            with np.errstate(all="ignore"):
                return formula(*arguments)
        except ValueError as failure:
            return raised(failure)
        except Exception as failure:
            raise ExerciseError(f"{self._place(who)} failed: {type(failure).__name__}: {failure}") from failure

    def _place(self, who: str) -> str:
        return f"{self.exercise.id}, data set {self.name!r}: {who}"


@functools.cache
def _size_axes(n: int) -> tuple[Array, ...]:
    return tuple(read_only(axis) for axis in np.ix_(*[np.linspace(0.0, 1.0, SIZE_GRID[n])] * n))


def targets(exercise: Exercise, seed: int | str | bytes, *, hidden: bool = False) -> tuple[Target, ...]:
    """The targets of all data sets of an exercise under one seed."""
    if hidden:
        return _targets(exercise, seed, hidden)
    known = (len(exercise.data_sets), len(exercise.mistakes) + len(exercise.ways), exercise.tolerance)
    return _kept(exercise, seed, known)


def forget() -> None:
    """Drop every target that is remembered, as a new process would."""
    _kept.cache_clear()


@functools.lru_cache(maxsize=KEPT)
def _kept(exercise: Exercise, seed: int | str | bytes, known: tuple[int, int, float]) -> tuple[Target, ...]:
    return _targets(exercise, seed, False)


def _targets(exercise: Exercise, seed: int | str | bytes, hidden: bool) -> tuple[Target, ...]:
    if not exercise.data_sets:
        raise ExerciseError(f"{exercise.id} has no data set; register one with @{exercise.id}.data")
    try:
        drawn = exercise.draw(seed)
    except ExerciseError:
        raise
    except Exception as failure:
        raise ExerciseError(f"{exercise.id}: drawing its data failed: {type(failure).__name__}: {failure}") from failure
    found = tuple(Target(exercise, one, seed, hidden=hidden) for one in drawn)
    for target in found:
        _check_finite(target)
    return found


def _check_finite(target: Target) -> None:
    def finite(answer: Answer) -> bool:
        if isinstance(answer, Several):
            return all(finite(item) for item in answer.items)
        return not isinstance(answer, Numbers) or bool(np.isfinite(answer.values).all())

    if not finite(target.expected):
        raise ExerciseError(f"{target.exercise.id}, data set {target.name!r}: the reference is not finite everywhere")


__all__ = ["PUBLIC_SEED", "Target", "targets"]
