"""Whether a function can be called with the arguments of its exercise, by position, and how its own arguments differ."""

from __future__ import annotations

import difflib
import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from autograder.card import Card
from autograder.exercise import Exercise
from autograder.messages import say


@dataclass(frozen=True)
class Trouble:
    """What differs in the list of arguments. ``callable`` False: the call itself cannot succeed."""

    said: str
    yours: str
    callable: bool

    def card(self, exercise: Exercise) -> Card:
        """The card where there is nothing to judge."""
        return Card(
            "failed",
            exercise.title,
            (
                (say("part.wrong"), say("check.signature", said=self.said)),
                (say("part.wanted"), f"`def {exercise.signature}:`"),
                (say("part.yours"), f"`def {self.yours}:`"),
                (say("part.look"), say("check.signature.look")),
            ),
        )


def trouble_with(exercise: Exercise, f: Callable[..., Any]) -> Trouble | None:
    """What is wrong with the arguments of f, or None.

    Missing and extra arguments make the call fail. Exchanged and renamed ones do not, since the call is by position: they are
    told where the answer is not right.
    """
    try:
        given = list(inspect.signature(f).parameters.values())
    except (TypeError, ValueError):
        return None
    positional = [one for one in given if one.kind in (one.POSITIONAL_ONLY, one.POSITIONAL_OR_KEYWORD)]
    forced = [one.name for one in given if one.kind is one.KEYWORD_ONLY and one.default is one.empty]
    names = [one.name for one in positional]
    needed = [one.name for one in positional if one.default is one.empty]
    wanted = list(exercise.arguments)
    yours = f"{exercise.id}({', '.join(map(_written, given))})"
    takes_any = any(one.kind is one.VAR_POSITIONAL for one in given)
    if forced:
        return Trouble(say("check.signature.by_name", names=_list(forced)), yours, callable=False)
    if len(needed) > len(wanted) or (len(names) < len(wanted) and not takes_any):
        return Trouble(_difference(wanted, names, needed), yours, callable=False)
    if takes_any or names[: len(wanted)] == wanted:
        return None
    if sorted(names[: len(wanted)]) == sorted(wanted):
        orders = {"wanted": ", ".join(wanted), "yours": ", ".join(names)}
        return Trouble(say("check.signature.order", **orders), yours, callable=True)
    pairs = [(name, want) for want, name in zip(wanted, names, strict=False) if want != name]
    renamed = "; ".join(say("check.signature.where", yours=name, wanted=want) for name, want in pairs)
    return Trouble(say("check.signature.renamed", names=renamed), yours, callable=True)


def _difference(wanted: list[str], names: list[str], needed: list[str]) -> str:
    missing = [name for name in wanted if name not in names]
    extra = [name for name in needed if name not in wanted]
    renamed = []
    for name in list(missing):
        near = difflib.get_close_matches(name.lower(), [one.lower() for one in extra], n=1, cutoff=0.5)
        like = next((one for one in extra if near and one.lower() == near[0]), None)
        if like is not None:
            missing.remove(name)
            extra.remove(like)
            renamed.append(say("check.signature.called", wanted=name, yours=like))
    said = [say("check.signature.missing", names=_list(missing))] if missing else []
    said += [say("check.signature.extra", names=_list(extra))] if extra else []
    return " ".join([*said, *renamed])


def _list(names: list[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


def _written(one: inspect.Parameter) -> str:
    return str(one.replace(annotation=inspect.Parameter.empty))
