"""Which data set sees which mistake, by how much, and what the mistake earns: the table that an author looks at."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any

from rich.console import Group
from rich.table import Table
from rich.text import Text

from autograder.authoring.rules import SAME, SEEN
from autograder.authoring.sampling import answer, apart
from autograder.exercise import PUBLIC_SEED, Exercise
from autograder.judge import judge
from autograder.result import Outcome, Tier

MANY = 6


@dataclass(frozen=True)
class Seen:
    """One mistake on the public data.

    Attributes
    ----------
    distances : per data set, the largest distance from the right answer relative to its size
    named : what the judge takes it for; its own id where all is well
    fraction : of the points that it earns
    tier : where the judge would place it if it had no name, and ``unnamed`` what it would earn there
    """

    mistake: str
    distances: dict[str, float]
    named: str | None
    fraction: float
    outcome: Outcome
    tier: Tier
    unnamed: float

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self)


def survey(exercise: Exercise) -> list[Seen]:
    """All mistakes of an exercise, on the data that every learner sees."""
    right = {drawn.name: (drawn, answer(exercise, exercise.reference, drawn)) for drawn in exercise.draw(PUBLIC_SEED)}
    nameless = dataclasses.replace(exercise, mistakes=[])
    found = []
    for mistake in exercise.mistakes:
        far = {name: apart(what, answer(exercise, mistake.formula, drawn)) for name, (drawn, what) in right.items()}
        verdict = judge(exercise, mistake.formula, seed=PUBLIC_SEED, figure=False)
        bare = judge(nameless, mistake.formula, seed=PUBLIC_SEED, figure=False)
        found.append(Seen(mistake.id, far, verdict.mistake, verdict.fraction, verdict.outcome, bare.tier, bare.fraction))
    return found


def table(exercise: Exercise, found: Iterable[Seen]) -> Group:
    """The survey of one exercise for a terminal. Where there are many data sets, they are numbered and told below."""
    title = Text.assemble((exercise.id, "bold"), f"  {exercise.title}, {exercise.kind}, {exercise.points:g} points")
    names = [f"{known.name} (blind)" if known.blind else known.name for known in exercise.data_sets]
    numbered = len(names) > MANY
    shown = Table()
    shown.add_column("mistake", no_wrap=True)
    for number, name in enumerate(names, 1):
        shown.add_column(str(number) if numbered else name.replace(" ", "\n"), justify="right")
    shown.add_column("points", justify="right")
    shown.add_column("without its name", no_wrap=True)
    for seen in found:
        far = [_written(seen.distances[known.name]) for known in exercise.data_sets]
        earned = f"{seen.fraction * exercise.points:g}"
        shown.add_row(Text(seen.mistake), *far, earned, f"{seen.tier}, {seen.unnamed * exercise.points:g}")
    legend = [Text("  ".join(f"{number} {name}" for number, name in enumerate(names, 1)), style="dim")] if numbered else []
    return Group(title, shown, *legend)


def _written(distance: float) -> Text:
    if distance <= SAME:
        return Text("·", style="dim")
    return Text(f"{distance:.2g}", style="green" if distance > SEEN else "yellow")
