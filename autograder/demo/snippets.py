"""Code as learners write it, kept as text: ``styles/<slug>/<style>.txt``, cut into cells by lines ``# %% name``.

``# %% cylinder`` begins the cell that answers the exercise of that name, ``# %% cylinder: no_2pi`` the cell of a learner who
made that mistake. Nothing here is imported or run by this package. Snippets that serve every assignment (``styles/broken``,
``styles/cheats``) hold ``$signature`` and the like, which are filled in for an exercise.
"""

from __future__ import annotations

import functools
import re
from importlib.resources import files
from string import Template
from types import MappingProxyType

from autograder.catalogue import Assignment
from autograder.exercise import Exercise

MARKER = re.compile(r"^# %% (?P<name>\w+(?:: \w+)?)\n", re.MULTILINE)
# What a learner's function gives back who has nothing: an answer of the right form, worth nothing.
NOTHING = {
    "surface": "np.zeros(np.broadcast(u, w).shape + (3,))",
    "field": "np.zeros(np.broadcast(u, w).shape + (3,))",
    "solid": "np.zeros(np.broadcast(u, v, w).shape + (3,))",
    "curve": "np.zeros(np.shape(u) + (3,))",
    "mask": "np.zeros(np.broadcast(u, w).shape, bool)",
    "label": "''",
}


@functools.cache
def cells(room: str, style: str) -> MappingProxyType[str, str]:
    """The cells of ``styles/<room>/<style>.txt`` by name, in the order in which they are written."""
    text = files("autograder.demo").joinpath("styles", room, f"{style}.txt").read_text("utf-8")
    parts = MARKER.split(text)
    return MappingProxyType({name: code.strip("\n") for name, code in zip(parts[1::2], parts[2::2], strict=True)})


def answers(assignment: Assignment, style: str = "vectorised") -> dict[str, str]:
    """A cell for each exercise: in this style, or vectorised and right where the style has none."""
    ours, plain = cells(assignment.slug, style), cells(assignment.slug, "vectorised")
    return {id: ours.get(id, plain[id]) for id in assignment.exercises}


def mistaken(assignment: Assignment, id: str, mistake: str) -> str:
    """The cell of a learner who made a listed mistake."""
    return cells(assignment.slug, "mistakes")[f"{id}: {mistake}"]


def filled(room: str, style: str, cell: str, exercise: Exercise) -> str:
    """A snippet that serves every assignment, filled in for an exercise."""
    lead = len(exercise.parameters)
    return Template(cells(room, style)[cell]).substitute(
        name=exercise.id,
        signature=exercise.signature,
        arguments=", ".join(exercise.arguments),
        parameters=", ".join(exercise.arguments[:lead]),
        data=", ".join(exercise.arguments[lead:]),
        points=repr(exercise.points),
        nothing=NOTHING.get(exercise.kind, "np.zeros(4)"),
    )
