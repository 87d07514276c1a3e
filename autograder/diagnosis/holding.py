"""What holds of an answer that is not right: which coordinates, edges, spans and data sets are right. The most telling first.

A message gets two such statements at most, one of the data sets and one of places; each is true of all public data that are
wrong.
"""

from __future__ import annotations

from collections.abc import Sequence

from autograder.diagnosis.contrast import Contrast
from autograder.diagnosis.places import AXES, Localised
from autograder.diagnosis.regions import Interval, OnlySides, Region, Spans
from autograder.messages import listing, number, say

Told = tuple[str, str | None]  # what is right, and what to look at if nothing says it better


def right_places(names: Sequence[str], where: Localised, region: Region | None) -> Told | None:
    """The most telling statement of where a map is right.

    Wrong on an edge only, then whole spans, then coordinates, then a part of the range, edges, and corners.
    """
    if isinstance(region, OnlySides | Spans):
        return _of_region(names, region)
    if (coordinates := _coordinates(where)) is not None:
        return coordinates, None
    if region is not None and len(where.sides) < 2 * len(names):
        return _of_region(names, region)
    edges = _edges(names, where) or _corners(names, where)
    return (edges, None) if edges is not None else None


def of_data(found: Contrast) -> Told:
    """What parts the data that are answered rightly from the others."""
    names = listing(found.names)
    has, lacks = say(f"has.{found.property}", names=names), say(f"lacks.{found.property}", names=names)
    right, wrong = (has, lacks) if found.right_have_it else (lacks, has)
    key = "right.contrast_answered" if found.refusals else "right.contrast"
    return say(key, right=right, wrong=wrong), say("look.contrast", names=names)


def _coordinates(where: Localised) -> str | None:
    right = [AXES[i] for i, fine in enumerate(where.coordinates[:3]) if fine]
    if not right:
        return None
    return say("right.coordinates" if len(right) > 1 else "right.one_coordinate", names=listing(right))


def _of_region(names: Sequence[str], region: Region) -> Told:
    if isinstance(region, OnlySides):
        sides = [f"{names[axis]} = {end}" for axis, end in region.sides]
        key = "right.only_sides" if len(sides) > 1 else "right.only_side"
        return say(key, thing=_side(names), names=listing(sides)), say("look.only_sides", values=listing(sides))
    name = names[region.axis]
    if isinstance(region, Spans):
        return _spans(name, region), say("look.spans")
    return _interval(name, region)


def _spans(name: str, region: Spans) -> str:
    if region.counted == "inner":
        key = "span.number" if region.run == 1 else "span.numbers"
        run = say(key, number=region.start + 1, last=region.start + region.run, count=region.count)
    else:
        run = say(f"span.{region.counted}" if region.run == 1 else f"span.{region.counted}s", count=region.run)
    return say(f"spans.{region.form}", name=name, run=run)


def _interval(name: str, region: Interval) -> Told:
    low, high = number(region.low, 3), number(region.high, 3)
    if region.high >= 1:
        return say("right.up_to", name=name, value=low), say("look.interval", name=name, value=low)
    if region.low <= 0:
        return say("right.from", name=name, value=high), say("look.interval", name=name, value=high)
    return say("right.outside", name=name, low=low, high=high), say("look.interval", name=name, value=low)


def _side(names: Sequence[str]) -> str:
    return say({1: "side.end", 2: "side.edge"}.get(len(names), "side.face"))


def _edges(names: Sequence[str], where: Localised) -> str | None:
    sides = [f"{names[axis]} = {end}" for axis, end in where.sides]
    if not sides:
        return None
    if len(names) == 1:
        return say("right.ends") if len(sides) == 2 else say("right.end", names=sides[0])
    thing = "face" if len(names) == 3 else "edge"
    if len(sides) == 2 * len(names):
        return say(f"right.{thing}s_all", count=len(sides))
    return say(f"right.{thing}s" if len(sides) > 1 else f"right.{thing}", names=listing(sides))


def _corners(names: Sequence[str], where: Localised) -> str | None:
    corners = [f"({', '.join(names)}) = ({', '.join(map(str, corner))})" for corner in where.corners]
    if not corners:
        return None
    if len(corners) == where.all_corners:
        return say("right.corners", count=len(corners))
    return say("right.corners_some" if len(corners) > 1 else "right.corner", names=listing(corners))
