"""An exercise: one function to write, its reference, its data and its known mistakes, declared by decorators.

    @exercise(points=6, title="Linear sweep by direction and distance", kind="surface")
    def linear_sweep(u, w, curve, direction, d):
        \"\"\"Sweep the generatrix the distance d along the direction.\"\"\"
        return dx.LinearSweep(curve, direction, d)(u, w)

    @linear_sweep.data
    def arcs(rng):
        return dict(curve=..., direction=..., d=...)

    @linear_sweep.mistake("not_normalised", credit=0.5)
    def _(u, w, curve, direction, d):
        \"\"\"You multiplied by the direction as given: divide by its length first.\"\"\"
        return ...

Its id is the name of the function. The leading arguments of a surface (u, w), curve (u), solid (u, v, w) and mask (u, w)
are parameters that the judge chooses; all other arguments come from the data sets, by name. A field (u, w) is vectors over the
square, such as normals: compared one by one, as nothing is meant by moving or relabelling them.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Literal, get_args

import numpy as np

from autograder.curvedata import CurveData, SurfaceData, as_data
from autograder.errors import ExerciseError
from autograder.personal import PUBLIC_SEED as PUBLIC_SEED
from autograder.personal import generator as generator
from autograder.result import LADDER, Tier

Kind = Literal["surface", "curve", "solid", "field", "basis", "net", "value", "mask", "label"]
PARAMETERS: dict[str, tuple[str, ...]] = {
    "surface": ("u", "w"),
    "curve": ("u",),
    "solid": ("u", "v", "w"),
    "field": ("u", "w"),
    "mask": ("u", "w"),
}
TOLERANCE = 1e-9
# What an answer below "identical" earns unless the exercise says otherwise. A surface that is right but for its labels or its
# seam shows that the form is understood; a surface that is merely near or elsewhere shows less.
TIER_CREDIT: dict[Tier, float] = {"relabelled": 0.5, "other start": 0.5, "close": 0.8}
SHAPE_CREDIT = 0.5
# The share of the data sets that are right counts so much where the others are wrong: half of the work is to be right always.
# Of words and of yes or no nothing counts, or guessing would.
DATA_CREDIT = 0.5
# The share kept by a function that is right (or has its mistake's credit) wherever there is an answer, and does not raise
# ValueError where there is none: it has the geometry, and not yet the care.
REFUSAL_CREDIT = 0.75


@dataclass(frozen=True)
class DataSet:
    """One named set of arguments. ``blind`` data are known to hide mistakes: shown as a trap, never decisive alone.

    ``weight`` is what it counts among the others where only some are right; blind data count nothing.
    """

    name: str
    draw: Callable[[np.random.Generator], Any]
    blind: bool = False
    weight: float = 1.0

    @cached_property
    def says(self) -> str:
        """What it is like, in one line: the docstring of its function, or nothing."""
        return " ".join((inspect.getdoc(self.draw) or "").split())


@dataclass(frozen=True)
class Drawn:
    """A data set with its arguments: values by name, arrays read-only, callables already as :class:`CurveData`
    or :class:`SurfaceData`."""

    name: str
    arguments: Mapping[str, Any]
    blind: bool = False
    says: str = ""


@dataclass(frozen=True)
class Mistake:
    """A known wrong formula, runnable, with the hint that a learner reads. ``credit`` None: the credit of its tier.

    ``way`` is 0 for the mistake as it was declared, and counts the other ways of writing it.
    """

    id: str
    formula: Callable[..., Any]
    hint: str
    credit: float | None = None
    way: int = 0


@dataclass(frozen=True, eq=False)
class Construction:
    """The right formula as it is built from earlier exercises: it takes the arguments, then a function for each of these."""

    blocks: tuple[Exercise, ...]
    formula: Callable[..., Any]


@dataclass(eq=False)
class Exercise:
    """One function to write. Made by :func:`exercise`; calling it calls the reference."""

    id: str
    reference: Callable[..., Any]
    points: float
    title: str
    kind: Kind
    statement: str
    arguments: tuple[str, ...]
    defaults: Mapping[str, Any]
    accept: Mapping[Tier, float]
    tolerance: float = TOLERANCE
    judged_as: Callable[..., Any] | None = None
    spans: Callable[..., Any] | None = None
    allow: tuple[str, ...] = ()
    shape_credit: float = SHAPE_CREDIT
    data_credit: float = DATA_CREDIT
    personal: bool = False
    public_seed: int | bytes = PUBLIC_SEED
    data_sets: list[DataSet] = field(default_factory=list)
    mistakes: list[Mistake] = field(default_factory=list)
    ways: list[Mistake] = field(default_factory=list)
    constructions: list[Construction] = field(default_factory=list)

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        """The reference's answer."""
        return self.reference(*args, **kwargs)

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of the leading arguments that the judge samples: ('u', 'w') for a surface, () for a value."""
        return PARAMETERS.get(self.kind, ())

    @property
    def signature(self) -> str:
        """The line a learner writes: ``cylinder(u, w, r, h)``."""
        shown = [f"{name}={_readable(self.defaults[name])}" if name in self.defaults else name for name in self.arguments]
        return f"{self.id}({', '.join(shown)})"

    def data(self, draw: Callable[..., Any] | None = None, *, blind: bool = False, weight: float = 1.0) -> Any:
        """Register a data set: a function of ``rng`` that returns the arguments, as a dict or in order as a tuple.

        Its docstring, where it has one, is what a learner reads of it.
        """

        def register(function: Callable[..., Any]) -> Callable[..., Any]:
            if any(known.name == function.__name__ for known in self.data_sets):
                raise ExerciseError(f"{self.id}: a data set named {function.__name__!r} exists already; choose another name")
            if not 0 <= weight < math.inf:
                raise ExerciseError(
                    f"{self.id}: the weight of data set {function.__name__!r} must be 0 or more; got {weight!r}"
                )
            self.data_sets.append(DataSet(function.__name__, function, blind, weight))
            return function

        return register if draw is None else register(draw)

    def mistake(self, id: str, *, credit: float | None = None) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
        """Register a known wrong formula under ``id``. Its docstring is the hint."""

        def register(function: Callable[..., Any]) -> Callable[..., Any]:
            hint = inspect.getdoc(function)
            if not hint:
                raise ExerciseError(f"{self.id}: mistake {id!r} needs a docstring, which is the hint a learner reads")
            if any(known.id == id for known in self.mistakes):
                raise ExerciseError(f"{self.id}: mistake {id!r} is there twice; choose another name")
            if credit is not None and not 0 <= credit < 1:
                raise ExerciseError(f"{self.id}: the credit of mistake {id!r} must lie in [0, 1); got {credit!r}")
            self._same_arguments(id, function)
            self.mistakes.append(Mistake(id, function, " ".join(hint.split()), credit))
            return function

        return register

    def also(self, id: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
        """Register another way of writing the mistake ``id``, with other values, the same hint and the same credit.

        A wrong length, say, may be put beside the right direction, or be what the direction is divided by.
        """

        def register(function: Callable[..., Any]) -> Callable[..., Any]:
            known = next((one for one in self.mistakes if one.id == id), None)
            if known is None:
                raise ExerciseError(f"{self.id}: there is no mistake {id!r} yet to write in another way; declare it first")
            self._same_arguments(id, function)
            way = 1 + sum(one.id == id for one in self.ways)
            self.ways.append(replace(known, formula=function, way=way))
            return function

        return register

    def _same_arguments(self, id: str, function: Callable[..., Any]) -> None:
        names = tuple(inspect.signature(function).parameters)
        if names != self.arguments:
            raise ExerciseError(
                f"{self.id}: mistake {id!r} must take {self.arguments}, as the reference does; it takes {names}"
            )

    def built_from(self, *blocks: Exercise) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
        """Register how the answer is built from earlier exercises, for the judge to tell whose fault a wrong one is.

        The formula takes the arguments of this exercise, then one function for each of the earlier ones, under its name:

            @bezier_patch.built_from(bernstein)
            def _(u, w, P, bernstein): ...
        """

        def register(formula: Callable[..., Any]) -> Callable[..., Any]:
            wanted = (*self.arguments, *(block.id for block in blocks))
            names = tuple(inspect.signature(formula).parameters)
            if not blocks or names != wanted:
                raise ExerciseError(
                    f"{self.id}: what it is built from takes its arguments, then one function for each earlier exercise named, "
                    f"{wanted}; it takes {names}"
                )
            self.constructions.append(Construction(blocks, formula))
            return formula

        return register

    def of_student(self, seed: int | bytes) -> Exercise:
        """The same exercise with the public data of one student, from :func:`autograder.personal.seed`.

        An exercise that is not personal is returned as it is: its public data are everybody's.
        """
        return replace(self, public_seed=seed) if self.personal and seed != self.public_seed else self

    def draw(self, seed: int | str | bytes = PUBLIC_SEED) -> list[Drawn]:
        """All data sets under one seed. The same seed gives the same data, on every machine; ``PUBLIC_SEED`` gives the public
        data, which are a student's own after :meth:`of_student`."""
        if seed == PUBLIC_SEED:
            seed = self.public_seed
        return [Drawn(known.name, self._arguments_of(known, seed), known.blind, known.says) for known in self.data_sets]

    @cached_property
    def by_heart(self) -> frozenset[str]:
        """Names of data sets that are the same under every seed: whoever was shown them can write the answer down."""
        once, again = self.draw("once"), self.draw("again")
        return frozenset(
            one.name
            for one, other in zip(once, again, strict=True)
            if all(_same(one.arguments[name], other.arguments[name]) for name in one.arguments)
        )

    def _arguments_of(self, known: DataSet, seed: int | str | bytes) -> dict[str, Any]:
        drawn = known.draw(generator(seed, self.id, known.name))
        wanted = self.arguments[len(self.parameters) :]
        if isinstance(drawn, tuple):
            drawn = dict(zip(wanted, drawn, strict=False))
        if not isinstance(drawn, Mapping):
            raise ExerciseError(
                f"{self.id}: data set {known.name!r} must return a dict of arguments; got {type(drawn).__name__}"
            )
        missing = [name for name in wanted if name not in drawn and name not in self.defaults]
        unknown = [name for name in drawn if name not in wanted]
        if missing or unknown:
            raise ExerciseError(
                f"{self.id}: data set {known.name!r} must give {', '.join(wanted) or 'nothing'}; "
                f"missing {missing or 'none'}, unknown {unknown or 'none'}"
            )
        return {name: _frozen(drawn[name] if name in drawn else self.defaults[name]) for name in wanted}

    def tier_credit(self, tier: Tier) -> float:
        """The share of the points that an answer of this tier earns here."""
        if tier == "identical":
            return 1.0
        return self.accept.get(tier, TIER_CREDIT.get(tier, 0.0) if self.parameters else 0.0)


def exercise(
    *,
    points: float,
    title: str,
    kind: Kind,
    accept: Mapping[Tier, float] | None = None,
    tolerance: float = TOLERANCE,
    judged_as: Callable[..., Any] | None = None,
    spans: Callable[..., Any] | None = None,
    allow: Sequence[str] = (),
    shape_credit: float = SHAPE_CREDIT,
    data_credit: float | None = None,
    personal: bool = False,
) -> Callable[[Callable[..., Any]], Exercise]:
    """Turn a reference function into an :class:`Exercise`.

    Parameters
    ----------
    points : float
        Points of its graded cell, above 0.
    title : str
        What a card and a table call it.
    kind : {"surface", "curve", "solid", "field", "basis", "net", "value", "mask", "label"}
        What the function answers, which decides how answers are compared.
    accept : mapping of tier to credit in [0, 1], optional
        Tiers below "identical" that earn credit here, over the defaults of ``TIER_CREDIT``.
    tolerance : float
        What "identical" allows, relative to the size of the reference.
    judged_as : callable, optional
        Turns an answer (a net with weights, say) into the surface that is compared: ``judged_as(answer)(u, w)``.
    spans : callable, optional
        Where the pieces of a map in pieces meet: takes the arguments of the data and returns, for each parameter, the places
        from 0 to 1. With it a learner is told in which spans a B-spline patch is right.
    allow : sequence of str
        Packages beyond numpy and plotly that learners may import, ``("scipy",)``.
    shape_credit : float
        The share kept by a function that is right for some shapes of input but not for others.
    data_credit : float in [0, 1), optional
        What the share of the data sets that are right is multiplied by where others are wrong: 1/2, and 0 for words, yes or no
        and masks, unless it is given.
    personal : bool
        Whether the data that a student is shown are his own, drawn from his id and a public word of the course (see
        :mod:`autograder.personal`). Hidden data are each student's own in any case.

    Raises
    ------
    ExerciseError
        Where the declaration breaks one of the rules above.
    """

    def declare(reference: Callable[..., Any]) -> Exercise:
        name = reference.__name__
        statement = inspect.getdoc(reference)
        if not statement:
            raise ExerciseError(f"{name}: the reference needs a docstring, which is the statement a learner reads")
        if kind not in get_args(Kind):
            raise ExerciseError(f"{name}: kind must be one of {', '.join(get_args(Kind))}; got {kind!r}")
        if not points > 0:
            raise ExerciseError(f"{name}: points must be above 0; got {points!r}")
        given = inspect.signature(reference).parameters
        arguments = tuple(given)
        leading = PARAMETERS.get(kind, ())
        if arguments[: len(leading)] != leading:
            raise ExerciseError(f"{name}: a {kind} takes {', '.join(leading)} first; got {', '.join(arguments)}")
        for tier, credit in (accept or {}).items():
            if tier not in LADDER or not 0 <= credit <= 1:
                raise ExerciseError(f"{name}: accept maps tiers of the ladder to credit in [0, 1]; got {tier!r}: {credit!r}")
        some = data_credit if data_credit is not None else 0.0 if kind in ("label", "mask") else DATA_CREDIT
        if not 0 <= some < 1:
            raise ExerciseError(f"{name}: data_credit must lie in [0, 1); got {data_credit!r}")
        defaults = {key: value.default for key, value in given.items() if value.default is not value.empty}
        return Exercise(
            id=name, reference=reference, points=float(points), title=title, kind=kind, statement=statement,
            arguments=arguments, defaults=defaults, accept=dict(accept or {}), tolerance=tolerance, judged_as=judged_as,
            spans=spans, allow=tuple(allow), shape_credit=shape_credit, data_credit=some, personal=personal,
        )  # fmt: skip

    return declare


def _frozen(value: Any) -> Any:
    if isinstance(value, np.generic):  # a learner's own code must behave alike here and in the sandbox: plain numbers
        value = value.item()
    if isinstance(value, CurveData | SurfaceData | str | bool | int | float | None):
        return value
    if callable(value):
        return as_data(value)
    if isinstance(value, list | tuple) and any(callable(item) for item in value):
        return tuple(_frozen(item) for item in value)
    array = np.array(value)
    array.flags.writeable = False
    return array


def _same(one: Any, other: Any) -> bool:
    """Whether two drawn arguments are equal."""
    if isinstance(one, tuple):
        return len(one) == len(other) and all(map(_same, one, other))
    if isinstance(one, CurveData | SurfaceData):
        fields = type(one).__slots__
        return type(one) is type(other) and all(np.array_equal(getattr(one, name), getattr(other, name)) for name in fields)
    return bool(np.array_equal(one, other)) if isinstance(one, np.ndarray) else bool(one == other)


def _readable(value: Any) -> str:
    if isinstance(value, float) and value and (value / np.pi).is_integer():
        return f"{int(value / np.pi)}*np.pi".removeprefix("1*")
    return repr(value)
