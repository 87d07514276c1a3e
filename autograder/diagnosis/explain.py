"""What a learner reads: what is right, what is wrong, where, and one thing to look at, from the findings.

Only public data are spoken of with names, numbers and places; of hidden data no more than that there are some.
A little over 400 lines: the four parts of one message are chosen here side by side; split, they would be read in four places.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from autograder import messages
from autograder.comparison import values as value_rungs
from autograder.comparison.answers import Answer, Numbers, Raised, Several
from autograder.comparison.gates import Gate, Trouble, error_gate
from autograder.comparison.maps import CLOSE, Sampled, Shifted
from autograder.comparison.sets import RATIO, SAME, SetFinding
from autograder.comparison.target import Target
from autograder.diagnosis.contrast import Contrast, contrast
from autograder.diagnosis.holding import Told, of_data, right_places
from autograder.diagnosis.ladder import Finding, Recognised, common
from autograder.diagnosis.places import AXES, Localised, coordinate_fact, localise, steady
from autograder.diagnosis.regions import region
from autograder.diagnosis.wording import (
    Parts,
    described,
    given_text,
    is_float32,
    named,
    pair_written,
    relabelled,
    sense_text,
    spoken,
    spoken_answer,
    spoken_truth,
    trouble_text,
    value_where,
    value_wrong,
    worst_finding,
    worst_index,
)
from autograder.exercise import Exercise
from autograder.messages import listing, number, place, say, written
from autograder.result import PARTS, Tier

# Look-texts of gates that are not called like their gate.
LOOKS = {
    "finite.corner": "look.finite",
    "finite.edges": "look.finite",
    "finite.inside": "look.finite",
    "finite.value": "look.finite",
    "pointwise.own_parameters": "look.own_parameters",
    "repeat.other": "look.repeat",
    "repeat.raised": "look.repeat",
    "shape.raised_writes": "look.writes",
    "shape.object": "look.shape",  # most often a mesh of all parameters, too large to read
    "shape.coordinates": "look.shape.coordinates",
}


class Explanation:
    """The parts of one verdict's message. ``shown`` are the findings on public data, ``hidden`` the others."""

    def __init__(
        self, shown: Sequence[Finding], hidden: Sequence[Finding], tier: Tier, recognised: Recognised | None = None
    ) -> None:
        self.shown = shown
        self.hidden = hidden
        self.tier = tier
        self.recognised = recognised
        self.exercise: Exercise = shown[0].target.exercise
        self.noun = say(f"noun.{'surface' if self.exercise.judged_as else self.exercise.kind}")
        self.wrong = [f for f in shown if not f.right]
        self.troubles = next((f.gated.troubles for f in shown if f.gated.troubles), ())
        if not self.troubles:
            # What an exception says may hold the data that came in; of hidden data only the form is told.
            unshown = next((f.gated.troubles for f in hidden if f.gated.troubles), ())
            self.troubles = tuple(Trouble(t.form, "shape.some", t.facts) for t in unshown)
        self.worst = worst_finding(shown)  # on data that have an answer, unless only the others are wrong

    def parts(self) -> Parts:
        """The parts, in the order in which they are read."""
        return sorted(self._parts(), key=lambda part: PARTS.index(part[0]))

    def _parts(self) -> Parts:
        if self.tier == "identical":
            return self._all_right()
        if not self.wrong and any(not f.right for f in self.hidden):
            return self._hidden_only()
        stopped = next((f.gated.stopped for f in self.wrong if f.tier == self.tier and f.gated.stopped), None)
        if stopped is not None and self.recognised is None:
            return [*self._right_sets(), *self._gate(stopped, next(f for f in self.wrong if f.gated.stopped is stopped))]
        if self.tier == "shape" and self.troubles:
            return [("right", say("right.points")), *self._shape()]
        if self.worst.sampled is None:
            return [*self._value(), *([] if self.worst.target.raises else self._not_refused())]
        body, unused = self._map()
        return [*body, *self._not_refused(), *(self._shape() if self.troubles and not unused else [])]

    # --- right

    def _all_right(self) -> Parts:
        sets = len(self.shown)
        one = "_one" if sets == 1 else ""
        f = next((f.sampled for f in self.shown if f.sampled is not None), None)
        if f is None:
            parts: Parts = [("right", say(f"right.value{one}", sets=sets))]
        else:
            parts = [("right", say(f"right.all{one}", noun=self.noun, count=len(f.indices), sets=sets))]
        empty = next((f.gated.empty for f in self.shown if f.gated.empty), None)
        if empty is not None:
            parts.append(("look", say("look.empty", wanted=empty.facts["wanted"])))
        return parts

    def _hidden_only(self) -> Parts:
        names = {f.target.name for f in self.hidden if not f.right}
        parts: Parts = [("right", say("right.shown")), ("wrong", say("wrong.hidden", data=say("hidden")))]
        if self.recognised is not None:
            return [*parts, *self._mistake()]
        failed = next((f.gated.stopped for f in self.hidden if f.gated.stopped is not None), None)
        if failed is not None and failed.key in ("error.timeout", "error.memory", "error.died"):
            parts.append(("wrong", say(failed.key)))
        elif failed is not None and failed.facts.get("exception"):
            # Its message may hold what came in; the name of its class does not.
            parts.append(("wrong", say("wrong.hidden_error", exception=failed.facts["exception"])))
        if len(names) < len(self.hidden):
            parts.append(("where", say("where.data", data=named(names))))
        return [*parts, ("look", say("look.hidden"))]

    def _right_sets(self) -> Parts:
        right = [f.target for f in self.shown if f.right]
        if not right or len(right) == len(self.shown):
            return []
        blind = [t.name for t in right if t.drawn.blind]
        seeing = [t.name for t in right if not t.drawn.blind]
        parts: Parts = [("right", say("right.sets", data=named(seeing)))] if seeing else []
        if seeing and self.contrast is not None:
            parts.append(("right", of_data(self.contrast)[0]))
        elif blind:
            parts.append(("right", say("right.blind", data=named(blind))))
        return parts

    @cached_property
    def contrast(self) -> Contrast | None:
        """What parts the data that are answered rightly from the others; a known mistake says it better."""
        vague = self.recognised is None and self.tier in ("different", "part", "more", "shape", "not finite", "error")
        seeing = any(f.right and not f.target.drawn.blind for f in self.shown)  # blind data have special numbers anyway
        return contrast(self.shown) if vague and seeing else None

    def _look_of_contrast(self) -> str | None:
        return of_data(self.contrast)[1] if self.contrast is not None else None

    # --- gates

    def _gate(self, gate: Gate, finding: Finding) -> Parts:
        facts = {
            **gate.facts,
            "id": self.exercise.id,
            "signature": self.exercise.signature,
            "noun": self.noun,
            "names": listing(self.exercise.parameters),
            "parameters": ", ".join(self.exercise.parameters),
            "data": named([finding.target.name]),
            "place": place(self._names(), gate.where) if gate.where is not None else "",
        }
        if "form" in facts:
            facts |= {"given": given_text(gate.facts), "names": listing(gate.facts["names"])}
        parts: Parts = [("wrong", say(gate.key, **facts))]
        if gate.facts.get("line"):
            key = "where.line" if gate.facts.get("source") else "where.line_only"
            parts.append(("where", say(key, **facts)))
        elif gate.key != "error.stub" and gate.key != "error.missing":
            parts.append(("where", say("where.data", data=self._described(finding.target))))
        look = LOOKS.get(gate.key) or _look_of(gate.key, len(self._names()))
        if "matmul:" in facts.get("message", ""):
            look = "look.matmul"
        if look is not None:
            parts.append(("look", say(look, **facts)))
        return parts

    def _shape(self) -> Parts:
        """The forms of input that are not handled."""
        parts: Parts = [("wrong", trouble_text(t)) for t in self.troubles]
        handled = {"vector", "mesh", "scalar"} - {t.form for t in self.troubles}
        if handled == {"scalar"} and all(t.key == "shape.raised" for t in self.troubles):
            alone = self.exercise.kind != "mask" and all("broadcast" in t.facts["message"] for t in self.troubles)
            parts.append(("look", say("look.needs_axis", name=self._names()[-1]) if alone else say("look.numbers_only")))
        else:
            key = self.troubles[0].key
            look = LOOKS.get(key) or _look_of(key, len(self._names())) or "look.shape"
            names = self._names()
            parts.append(("look", say(look, names=listing(names), parameters=", ".join(names))))
        return parts

    def _not_refused(self) -> Parts:
        """Data without an answer that were not refused, besides what else is wrong."""
        names = [f.target.name for f in self.wrong if f.target.raises]
        return [("wrong", say("wrong.also_no_error", data=named(names)))] if names else []

    # --- maps

    def _map(self) -> tuple[Parts, bool]:
        """The message for a map, and whether it leaves a parameter unused (which explains wrong shapes too)."""
        maps = [f.sampled for f in self.wrong if f.sampled is not None]
        where = localise(maps)
        f = self.worst.sampled
        assert f is not None
        sets, places = self._right_sets(), self._right_places(where, maps)
        parts = [*sets, *([("right", places[0])] if places is not None else [])]
        if self.recognised is not None:
            return [*parts, *self._mistake(), ("where", self._where(f))], False
        better = (places[1] if places is not None else None) or self._look_of_contrast()
        wrong, look = self._rung(where, maps, f, better)
        body = [*parts, *(("wrong", text) for text in wrong), ("where", self._where(f)), ("look", look)]
        return body, bool(where.unused)

    def _right_places(self, where: Localised, maps: Sequence[Sampled]) -> Told | None:
        if self.tier in ("relabelled", "other start", "close", "same set", "covered") or self.exercise.kind == "mask":
            return None
        vague = self.recognised is None and self.tier in ("different", "part", "more")
        return right_places(self._names(), where, region(maps) if vague else None)

    def _mistake(self) -> Parts:
        assert self.recognised is not None
        found, mistake = self.recognised, self.recognised.mistake
        facts = {"noun": self.noun, "mistake": spoken(mistake.id)}
        if found.second is not None:
            text = say("wrong.mistakes_two", **facts, second=spoken(found.second.id))
            return [("wrong", text), ("look", mistake.hint), ("look", found.second.hint)]
        if found.symmetry is not None:
            text = say("wrong.mistake_relabelled", **facts, relabelled=relabelled(found.symmetry))
        else:
            text = say("wrong.mistake_close" if found.close else "wrong.mistake", **facts)
        return [("wrong", text), ("look", mistake.hint)]

    def _rung(self, where: Localised, maps: Sequence[Sampled], f: Sampled, look: str | None) -> tuple[list[str], str]:
        """What is wrong on this rung, and what to look at; ``look`` where the rung itself has nothing so telling."""
        if self.tier == "relabelled":
            return self._relabelled()
        if self.tier == "other start":
            shifted = next(f.shifted for f in self.wrong if f.shifted is not None)
            start = place(self._names(), [0.0] * len(self._names()))
            return [self._other_start(shifted)], say("look.other_start", place=start)
        if self.tier == "close":
            if all(is_float32(m) for m in maps):
                return [say("wrong.close_float32")], say("look.float32")
            if f.worst > CLOSE:  # as a set of points only
                return [say("wrong.close_set", amount=messages.amount(SAME))], say("look.close")
            return [say("wrong.close", amount=messages.amount(f.worst))], say("look.close")
        if self.tier in ("same set", "covered", "part", "more"):
            found = next((f.sets for f in self.wrong if f.tier == self.tier and f.sets is not None), None)
            if found is not None:
                texts, look = self._set(found, where)
                return [*texts, *self._coordinates(maps)[0]], look
        if self.tier == "moved":
            return self._moved(maps)
        return self._different(where, maps, f, look)

    def _set(self, found: SetFinding, where: Localised) -> tuple[list[str], str]:
        """The same set of points, several times, a part of it, or more."""
        names = self._names()
        times = number(found.times, 3)
        if self.tier == "same set":
            key = "wrong.same_set_speed_curve" if len(names) == 1 else "wrong.same_set_speed"
            key = key if len(where.corners) == where.all_corners else "wrong.same_set"
            return [say(key, noun=self.noun, names=listing(names))], say("look.same_set")
        if self.tier == "covered":
            if found.ratio < 1.5 and found.collapsed > RATIO:
                return [say("wrong.collapsed", percent=messages.percent(found.collapsed))], say("look.collapsed")
            return [say("wrong.covered", noun=self.noun, times=times)], say("look.covered")
        if self.tier == "more":
            key = "wrong.more" if found.ratio > 1.03 else "wrong.more_hardly"  # measured on a mesh
            return [say(key, noun=self.noun, times=number(found.ratio, 3))], self._reach()
        if found.ratio < 1e-6:
            what = say("collapsed.curve" if len(names) == 2 else "collapsed.less")
            return [say("wrong.part_collapsed", noun=self.noun, what=what)], self._look_part(where)
        if found.ratio > 0.98:
            return [say("wrong.part_folded", noun=self.noun)], say("look.covered")
        return [say("wrong.part", noun=self.noun, percent=messages.percent(found.ratio))], self._reach()

    def _reach(self) -> str:
        return say("look.part", place=place(self._names(), [1.0] * len(self._names())))

    def _look_part(self, where: Localised) -> str:
        unused = [self._names()[i] for i in where.unused]
        return say("look.unused", name=listing(unused)) if unused else say("look.corners")

    def _moved(self, maps: Sequence[Sampled]) -> tuple[list[str], str]:
        """The right shape in another place, and how it got there."""
        finding = next(
            f for f in [self.worst, *self.wrong] if f.tier == "moved" and (f.moved is not None or f.motion is not None)
        )
        start = say("look.moved", noun=self.noun, place=place(self._names(), [0.0] * len(self._names())))
        if finding.moved is None:
            return [say("wrong.moved.set")], start
        motion, symmetry = finding.moved.motion, finding.moved.symmetry
        kind = motion.kind(finding.target.size)
        facts = {"shift": written(motion.shift, 4), "factor": number(motion.scale, 6), "angle": number(motion.angle, 4)}
        texts = [say(f"wrong.moved.{kind}", **facts, axis=written(np.round(motion.axis, 6), 4))]
        if symmetry.name != "id":
            texts.append(say("wrong.moved.relabelled", relabelled=relabelled(symmetry)))
        look = {"scale": say("look.scale"), "similarity": say("look.scale"), "reflection": say("look.mirrored")}
        told, better = self._coordinates(maps) if kind not in ("scale", "translation") else ([], None)
        return [*texts, *told], better or look.get(kind, start)

    def _relabelled(self) -> tuple[list[str], str]:
        shared = common(self.wrong)
        symmetry = shared[0] if shared else next(f.symmetries[0] for f in self.wrong if f.symmetries)
        normal = ""
        if len(symmetry.names) == 2:
            normal = say("normal.flips" if symmetry.determinant < 0 else "normal.keeps")
        text = say("wrong.relabelled", noun=self.noun, relabelled=relabelled(symmetry), normal=normal).strip()
        if symmetry.name == "swap":
            return [text], say("look.swap")
        corner = [0.0] * len(symmetry.names)
        return [text], say("look.relabelled", place=place(symmetry.names, corner))

    def _other_start(self, shifted: Shifted) -> str:
        names = self._names()
        moved = [
            say("shift.one", name=name, value=number(by, 3))
            for name, by in zip(names, shifted.shift, strict=True)
            if by is not None and min(by, 1 - by) > 1e-7
        ]
        also = shifted.symmetry.name != "id"
        text = say("wrong.moved.relabelled", relabelled=relabelled(shifted.symmetry)) if also else ""
        return say("wrong.other_start", noun=self.noun, shift=listing(moved), relabelled=text).strip()

    def _different(self, where: Localised, maps: Sequence[Sampled], f: Sampled, look: str | None) -> tuple[list[str], str]:
        if self.exercise.kind == "mask":
            return self._mask(f)
        names, away = self._names(), messages.amount(f.worst)
        if where.unused:
            unused = [names[i] for i in where.unused]
            if len(unused) == len(names):
                return [say("wrong.different", noun=self.noun, amount=away), say("fact.constant")], say(
                    "look.unused", name=listing(unused)
                )
            text = " ".join(say("fact.unused", name=name) for name in unused)
            return [say("wrong.different", noun=self.noun, amount=away), text], say("look.unused", name=listing(unused))
        told, better = self._coordinates(maps)
        if better is not None:
            return told, better
        wrong = [AXES[i] for i, fine in enumerate(where.coordinates[:3]) if not fine]
        if 0 < len(wrong) < len(where.coordinates):
            key = "fact.coordinates_wrong" if len(wrong) > 1 else "fact.coordinate_wrong"
            text = say("wrong.different", noun=self.noun, amount=away)
            texts = [text, say(key, names=listing(wrong)), *self._steady(maps)[0]]
            if self.exercise.judged_as is not None:  # no line of a net makes a coordinate of its surface
                return texts, look or say("look.worst")
            return texts, look or say("look.coordinate", names=listing(wrong))
        if where.inside_only and len(names) > 1:
            return [say("wrong.different_inside", amount=away)], say("look.inside")
        if len(where.corners) == where.all_corners and not where.sides:
            return [say("wrong.different_corners", amount=away)], say("look.corners")
        if look is not None:
            return [say("wrong.different", noun=self.noun, amount=away)], look
        told, look = self._steady(maps)
        if look is not None:
            return [say("wrong.different", noun=self.noun, amount=away), *told], look
        if len(where.sides) == 1:
            axis, end = where.sides[0]
            look = say("look.edge", name=names[axis], start=end, end=1 - end)
            return [say("wrong.different", noun=self.noun, amount=away)], look
        return [say("wrong.different", noun=self.noun, amount=away)], say("look.worst")

    def _steady(self, maps: Sequence[Sampled]) -> tuple[list[str], str | None]:
        """The parameters that change nothing in how far it is off, and what to look at then."""
        names = [self._names()[axis] for axis in steady(maps)]
        if not names:
            return [], None
        zeros = listing(f"{name} = 0" for name in names)
        return [say("fact.steady", names=listing(names))], say("look.steady", names=listing(names), zeros=zeros)

    def _coordinates(self, maps: Sequence[Sampled]) -> tuple[list[str], str | None]:
        """One rule for a coordinate that explains all of it, and what to look at then."""
        fact = coordinate_fact(maps)
        if fact is None:
            return [], None
        facts = {k: number(v, 6) if isinstance(v, float) else v for k, v in fact.facts.items()}
        if fact.key == "fact.coordinate_sign":
            look = say("look.mirrored")
        elif "factor" in facts:
            look = say("look.scale")
        else:
            look = say("look.coordinate", names=facts.get("name") or facts.get("yours", ""))
        vectors = fact.key == "fact.factor" and self.exercise.kind == "field"
        return [say("fact.factor_field" if vectors else fact.key, **facts)], look

    def _mask(self, f: Sampled) -> tuple[list[str], str]:
        bad = f.deviations > f.target.allowed
        i = worst_index(f)
        facts = {"yours": spoken_truth(f.values[i]), "expected": spoken_truth(f.expected[i])}
        return [say("wrong.mask", **facts, count=int(bad.sum()), total=len(bad))], say("look.value")

    def _where(self, f: Sampled) -> str:
        i = worst_index(f)
        yours, expected = pair_written(f, i)
        if f.values.ndim == 1:
            yours, expected = spoken_truth(f.values[i]), spoken_truth(f.expected[i])
        at, data = place(self._names(), f.points[i]), self._described(f.target)
        key = {"mask": "where.value", "field": "where.vector"}.get(self.exercise.kind, "where.point")
        return say(key, place=at, data=data, yours=yours, expected=expected)

    # --- values

    def _value(self) -> Parts:
        finding = self.worst
        answer, expected = finding.gated.answer, finding.target.expected
        assert answer is not None
        parts = self._right_sets()
        data = self._described(finding.target)
        if self.recognised is not None:
            return [*parts, *self._mistake(), *value_where(finding, data)]
        if isinstance(expected, Raised):
            return [*parts, *self._no_error(answer, data)]
        if self.tier == "close":
            f = value_rungs.worst(finding.target, answer, expected)
            away = messages.amount(f.relative if f is not None else 0.0)
            return [
                *parts,
                ("wrong", say("wrong.close", amount=away)),
                *value_where(finding, data),
                ("look", say("look.close")),
            ]
        look = self._look_of_contrast() or say(_look_of_value(finding.tier, answer, expected))
        told = sense_text(self.wrong)
        sense: Parts = [("wrong", told)] if told else []
        return [*parts, *value_wrong(finding, answer, expected), *sense, *value_where(finding, data), ("look", look)]

    def _no_error(self, answer: Answer, data: str) -> Parts:
        look = ("look", say("look.error_expected"))
        if isinstance(answer, Raised):
            facts = error_gate(answer).facts
            return [("wrong", say("wrong.other_error", **facts)), ("where", say("where.data", data=data)), look]
        text = say("wrong.no_error", yours=spoken_answer(answer))
        return [("wrong", text), ("where", say("where.data", data=data)), look]

    # --- words

    def _names(self) -> tuple[str, ...]:
        return self.shown[0].target.names

    def _described(self, target: Target) -> str:
        return say("data.one", names=described(target))


def _look_of_value(tier: Tier, answer: Answer, expected: Answer | None) -> str:
    """The look-text of a value that is not right."""
    if isinstance(expected, Several) and value_rungs.as_items(answer, len(expected.items)) is None:
        return "look.value_parts"
    if tier != "shape":
        return "look.value"
    if isinstance(expected, Numbers) and expected.values.ndim == 0:
        return "look.value_truth" if expected.was == "bool" else "look.value_number"
    rows = all(isinstance(one, Numbers) and one.values.ndim == 1 for one in (answer, expected))
    return "look.value_count" if rows else "look.value_shape"


def _look_of(key: str, dimension: int) -> str | None:
    """The look-text of a gate or of a trouble with shapes."""
    name = "look." + key.split(".", 1)[1]
    if name in messages.TEXT:
        return name
    if key.startswith("shape."):
        return "look.shape" if dimension > 1 else "look.shape_curve"
    return "look.pointwise" if key.startswith("pointwise.") else None
