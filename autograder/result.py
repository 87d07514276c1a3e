"""What a judgement is: plain frozen values that go to JSON and back, and know nothing of how they came about."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from typing import Any, Literal, get_args

Outcome = Literal["passed", "partial", "failed", "not run", "could not judge"]
Tier = Literal[
    # gates: what stops a comparison before it starts
    "error", "timeout", "shape", "not finite", "not pointwise", "not repeatable",
    # the ladder, from right to unrelated
    "identical", "mistake", "relabelled", "other start", "close", "same set", "covered", "part", "more", "moved",
    "different",
]  # fmt: skip
GATES: tuple[Tier, ...] = ("error", "timeout", "shape", "not finite", "not pointwise", "not repeatable")
LADDER: tuple[Tier, ...] = get_args(Tier)[len(GATES) :]
PARTS = ("right", "wrong", "where", "look")


@dataclass(frozen=True)
class Case:
    """How one data set was answered.

    ``deviation`` is the worst distance between the two answers relative to the size of the reference (the diagonal of its
    bounding box); ``where`` the parameters of the worst place, ``yours`` and ``expected`` both values there, already written
    out. All four are None for hidden data, of which only the tier is told.
    """

    data: str
    tier: Tier
    deviation: float | None = None
    where: tuple[float, ...] | None = None
    yours: str | None = None
    expected: str | None = None
    blind: bool = False
    hidden: bool = False
    mistake: str | None = None
    note: str = ""


@dataclass(frozen=True)
class Figure:
    """The sampled surfaces or curves behind a comparison picture, of public data only.

    ``parameters`` holds the values along each axis (one list for a curve, two for a surface); ``expected`` and ``yours``
    are nested lists of points, ``yours`` None where the learner's function could not be sampled. ``worst`` is the
    parameter place to mark. ``names`` are the parameters that run; of a solid two do, at the ``layer`` "w = 0.5", say.
    """

    kind: Literal["curve", "surface"]
    parameters: tuple[tuple[float, ...], ...]
    expected: Any
    yours: Any = None
    worst: tuple[float, ...] | None = None
    size: float = 1.0
    names: tuple[str, ...] = ()
    layer: str = ""


@dataclass(frozen=True)
class Verdict:
    """What the judge says of one answer to one exercise.

    ``fraction`` in [0, 1] of the exercise's points; ``tier`` the rung of the ladder (or the gate) that decided it;
    ``mistake`` the id of the recognised mistake; ``message`` what the learner reads, which is ``parts`` in order: what is
    right, what is wrong, where, and one thing to look at. ``follows`` names the earlier functions of the notebook whose faults
    alone explain this one. ``terms`` is the arithmetic of a part of the points: why, and the factor; their product is the
    fraction.
    """

    exercise: str
    outcome: Outcome
    fraction: float
    tier: Tier
    message: str
    mistake: str | None = None
    cases: tuple[Case, ...] = ()
    parts: tuple[tuple[str, str], ...] = ()
    figure: Figure | None = None
    title: str = ""
    symmetries: tuple[str, ...] = field(default=())
    follows: tuple[str, ...] = ()
    terms: tuple[tuple[str, float], ...] = ()

    def __post_init__(self) -> None:
        if not 0.0 <= self.fraction <= 1.0:  # also refuses NaN
            raise ValueError(f"a verdict's fraction must lie in [0, 1]; got {self.fraction!r}")

    def part(self, name: str) -> str:
        """One part of the message (``right``, ``wrong``, ``where`` or ``look``), empty when there is none."""
        return " ".join(text for key, text in self.parts if key == name)

    def points(self, available: float) -> float:
        """The points this verdict is worth, as a plain float clamped to [0, available]."""
        return float(min(max(round(self.fraction * available, 6), 0.0), available))

    def to_dict(self) -> dict[str, Any]:
        """Plain lists, dicts, strings and numbers."""
        return asdict(self)

    def to_json(self, **options: Any) -> str:
        """Strict JSON (no NaN)."""
        return json.dumps(self.to_dict(), allow_nan=False, **options)

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Verdict:
        """The inverse of :meth:`to_dict`; lists become the tuples they were."""
        cases = tuple(Case(**{**case, "where": _tuple(case["where"])}) for case in data["cases"])
        figure = data["figure"]
        if figure is not None:
            axes = tuple(tuple(axis) for axis in figure["parameters"])
            names = tuple(figure.get("names", ()))
            figure = Figure(**{**figure, "parameters": axes, "worst": _tuple(figure["worst"]), "names": names})
        parts = tuple((key, text) for key, text in data["parts"])
        tuples = {key: tuple(data.get(key, ())) for key in ("symmetries", "follows")}
        terms = tuple((why, factor) for why, factor in data.get("terms", ()))
        return cls(**{**data, "cases": cases, "figure": figure, "parts": parts, "terms": terms, **tuples})

    @classmethod
    def from_json(cls, text: str) -> Verdict:
        """The inverse of :meth:`to_json`."""
        return cls.from_dict(json.loads(text))


def _tuple(values: list[float] | None) -> tuple[float, ...] | None:
    return None if values is None else tuple(values)
