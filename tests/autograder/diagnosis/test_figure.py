"""The samples behind the picture: right answers share one, a solid shows a layer by its own letters, nothing overflows."""

import json

import numpy as np
import pytest

from autograder import card
from autograder.catalogue import shipped
from autograder.comparison import target
from autograder.diagnosis.figure import _nested
from autograder.judge import judge
from autograder.result import Verdict

CYLINDER, SOLID = shipped().find("cylinder"), shipped().find("hyperpatch")


def test_all_who_are_right_share_one_picture():
    """It is drawn once; a wrong answer has its own."""
    target.forget()
    first, second = (judge(CYLINDER, CYLINDER.reference, seed=seed) for seed in (b"one", b"two"))
    assert first.figure is second.figure
    assert first.figure.yours is first.figure.expected
    drawn = card.figure(first)
    drawn["layout"]["title"] = "scribbled over"
    assert card.figure(second)["layout"].get("title") != "scribbled over"
    wrong = judge(CYLINDER, lambda u, w, r, h: CYLINDER.reference(u, w, r, 2 * h))
    assert wrong.figure is not first.figure
    assert wrong.figure.yours != wrong.figure.expected


def test_who_makes_the_same_mistake_is_shown_the_same_picture():
    """It is drawn once; other numbers, another language or another title make another one."""
    target.forget()

    def taller(u, w, r, h):
        return CYLINDER.reference(u, w, r, 2 * h)

    first, second = (card.figure_bundle(judge(CYLINDER, taller, seed=seed)) for seed in (b"one", b"two"))
    (drawn,) = (first[mime] for mime in first if mime != "text/plain")
    assert any(shown is drawn for shown in second.values())
    tallest = card.figure_bundle(judge(CYLINDER, lambda u, w, r, h: CYLINDER.reference(u, w, r, 3 * h)))
    assert not any(shown is drawn or shown == drawn for shown in tallest.values())
    right = card.figure_bundle(judge(CYLINDER, CYLINDER.reference))
    assert not any(shown is drawn or shown == drawn for shown in right.values())


def test_right_at_the_samples_and_wrong_between_them_is_drawn_as_it_is():
    """The shared picture is for what is right on the grid of the picture too."""

    def answer(u, w, r, h):
        points = np.array(CYLINDER.reference(u, w, r, h))
        if np.size(u) > 1000:
            points[500] += [0, 0, 1.0]
        return points

    verdict = judge(CYLINDER, answer)
    assert verdict.tier == "identical"
    assert verdict.figure.yours is not verdict.figure.expected
    assert np.abs(np.array(verdict.figure.yours) - np.array(verdict.figure.expected)).max() == pytest.approx(1.0)


@pytest.mark.parametrize("huge", [1.7e308, -1.7e308, np.inf, 1e200])
def test_numbers_at_the_end_of_the_range_leave_a_gap(huge):
    """Rounding multiplies; no warning may come of it, and the JSON stays strict."""

    def answer(u, w, r, h):
        points = 2.0 * CYLINDER.reference(u, w, r, h)
        if np.size(u) > 1000:
            points[500] = huge
        return points

    verdict = judge(CYLINDER, answer, search=False)
    assert verdict.figure.yours[15][5] == [None, None, None]
    assert Verdict.from_json(verdict.to_json()) == verdict
    assert card.figure(verdict)["layout"]


@pytest.mark.parametrize("scale", [1e-20, 1e20])
def test_sizes_far_from_one_keep_their_digits(scale):
    """A surface of the size of an atom is not rounded to a point."""
    values = np.array([1.234567891, 2.0, -3.0]) * scale
    assert np.allclose(_nested(values, 5 * scale), values, rtol=1e-6)


def test_a_layer_of_a_solid_is_labelled_by_the_letters_that_run_in_it():
    """u and v run, w is held; nothing in the picture says that w runs."""

    def answer(u, v, w, *data):
        return SOLID.reference(u, v, w, *data) + np.asarray(u * v * w)[..., None] * [0.0, 0.0, 5.0]

    verdict = judge(SOLID, answer)
    assert verdict.figure.names == ("u", "v")
    held = float(verdict.figure.layer.removeprefix("w = "))
    shown = next(case for case in verdict.cases if case.where is not None and case.where[2] == pytest.approx(held, abs=1e-3))
    assert verdict.figure.worst == shown.where[:2]
    text = json.dumps(card.figure(verdict), ensure_ascii=False)
    assert "<b>u = %{customdata[0]" in text
    assert ", v = %{customdata[1]" in text
    assert ", w = %{customdata[1]" not in text
    assert "along v" in text
    assert "(u, v) = (" in text
    assert f"The layer {verdict.figure.layer} of the solid" in text
    assert Verdict.from_json(verdict.to_json()).figure == verdict.figure


def test_an_older_figure_has_no_letters():
    """What was written before is still read."""
    verdict = judge(CYLINDER, CYLINDER.reference)
    older = verdict.to_dict()
    del older["figure"]["names"], older["figure"]["layer"]
    assert Verdict.from_dict(older).figure.names == ()
    assert card.figure(Verdict.from_dict(older)) is not None
