"""The card says all of a verdict, in words that need no colour, in HTML that no sanitiser touches and nothing leaves."""

import base64
import json
import re
from html.parser import HTMLParser

import nh3
import numpy as np
import pytest

from autograder import card
from autograder.messages import say
from autograder.result import GATES, LADDER, Case, Figure, Verdict

PARTS = (
    ("right", "z is right everywhere."),
    ("wrong", "Your surface is the one of a known slip."),
    ("wrong", "It never closes."),
    ("where", "Furthest off at u = 0.5, w = 0.25."),
    ("look", "Which angle brings you back? See `np.pi`."),
)
EVIL = "<script>alert(1)</script><img src=x onerror=alert(1)>\" style='x' $\\href{javascript:1}{x}$ \x00\x1b[31m"


def verdict(outcome="partial", tier="mistake", fraction=0.25, **more):
    slip = "no_2pi" if tier == "mistake" else None
    given = {
        "exercise": "cylinder",
        "title": "Cylinder from its known form",
        "message": "A message.",
        "parts": PARTS,
        "cases": (
            Case("lecture", tier, 0.53, (0.5, 0.25), "(1.5, 1, 1)", "(-2, 0, 1)", mistake=slip),
            Case("unit", "identical", 0.0, (0.0, 0.0), "(1, 0, 0)", "(1, 0, 0)", blind=True),
            Case("drawn", tier, hidden=True),
        ),
    }
    return Verdict(outcome=outcome, tier=tier, fraction=fraction, **{**given, **more})


def sampled(lift, kind="surface"):
    t = tuple(float(x) for x in np.linspace(0, 1, 5))
    if kind == "curve":
        points = np.stack([t, t, t], axis=-1)
        return Figure("curve", (t,), points.tolist(), (points + lift).tolist(), (0.25,), 1.7)
    U, W = np.meshgrid(t, t, indexing="ij")
    points = np.dstack([U, W, U * W])
    return Figure("surface", (t, t), points.tolist(), (points + lift).tolist(), (0.25, 1.0), 1.7)


class Flat(HTMLParser):
    """Tags, attributes and text of a fragment; fails on what does not nest."""

    def __init__(self, html):
        super().__init__()
        self.tags, self.attributes, self.words, self.open = set(), [], [], []
        self.feed(html)
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.add(tag)
        self.attributes += attrs
        self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)

    @property
    def text(self):
        return " ".join("".join(self.words).replace("\xa0", " ").split())


@pytest.mark.parametrize("tier", [*GATES, *LADDER])
def test_every_tier_has_words_and_a_sign(tier):
    """The table names the rung in words, and the sign beside it does not depend on colour."""
    shown = verdict(tier=tier)
    sign, said = card.SIGNS[tier], say(f"tier.{tier.replace(' ', '_')}")
    for text in (card.text(shown), Flat(card.html(shown)).text):
        assert any(f"{sign} {data}{said}" in text for data in ("", "lecture: ", "drawn (hidden): "))
    if tier == "mistake":  # a slip that is told by its name needs fewer words
        assert "✗ slip: no_2pi" in Flat(card.html(shown)).text


@pytest.mark.parametrize("outcome", card.OUTCOMES)
def test_every_outcome_is_a_word_a_sign_and_a_readable_badge(outcome):
    """White on each badge has a contrast of at least 5 (WCAG asks for 4.5), and no two outcomes share a sign."""
    word, (sign, ground) = card.word_of(outcome), card.OUTCOMES[outcome]
    shown = verdict(outcome=outcome)
    assert card.text(shown).startswith(f"[{sign} {word}] Cylinder from its known form")
    assert f"{sign} {word}" in Flat(card.html(shown)).text
    channels = [int(ground[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    assert 1.05 / (np.dot(linear, [0.2126, 0.7152, 0.0722]) + 0.05) >= 5
    assert [other for other, _ in card.OUTCOMES.values()].count(sign) == 1


def test_text_alone_says_everything():
    """All parts in order under their headings, both values, place and deviation of the data set that is not right."""
    assert card.text(verdict()).splitlines() == [
        "[◐ Partly right] Cylinder from its known form",
        "What holds: z is right everywhere.",
        "What does not: Your surface is the one of a known slip. It never closes.",
        "Where: Furthest off at u = 0.5, w = 0.25.",
        "Next: Which angle brings you back? See np.pi.",
        "Data sets:",
        "  ✗ lecture: slip: no_2pi; off by 53 % of its size; at (u, w) = (0.5, 0.25); yours (1.5, 1, 1); reference (-2, 0, 1)",
        "  ✓ unit (blind): right",
        "  ✗ drawn (hidden): a known slip",
    ]


def test_html_says_what_the_text_says():
    """Every word of the text is in the HTML."""
    shown = Flat(card.html(verdict())).text
    words = set(re.findall(r"[\w.()%-]+", card.text(verdict()))) - {"Data", "sets"}  # the table has no such heading
    assert words
    assert not [word for word in words if word not in shown]


def test_no_points_stand_on_a_card():
    """A mark given by hand later would contradict them: neither fraction nor points are there."""
    shown = verdict(fraction=0.4375)
    for text in (card.text(shown), card.html(shown)):
        assert "0.4375" not in text
        assert "point" not in re.sub(r"your point|no points", "", text.lower())


def test_html_needs_no_script_style_sheet_class_or_id():
    """Only plain elements with inline styles of the listed properties."""
    flat = Flat(card.html(verdict()) + card.html(card.Card("failed", "x", (), notes=(("Printed", "y"),))))
    assert flat.tags <= {"div", "span", "b", "code", "pre", "table", "tr", "th", "td"}
    assert {name for name, _ in flat.attributes} == {"style"}
    used = {rule.split(":")[0].strip() for _, style in flat.attributes for rule in style.split(";")}
    assert used == card.STYLE_PROPERTIES


def test_nh3_leaves_the_card_whole():
    """The sanitiser that feedback uses, told the listed properties, removes nothing."""
    html = card.html(verdict())
    cleaned = nh3.clean(
        html,
        tags={"div", "span", "b", "code", "pre", "table", "thead", "tbody", "tr", "th", "td"},
        attributes={"*": {"style"}},
        filter_style_properties=set(card.STYLE_PROPERTIES),
    )
    before, after = Flat(html), Flat(cleaned)
    assert after.text == before.text
    styles = [sorted(re.sub(r"\s", "", style).rstrip(";").split(";")) for _, style in before.attributes]
    assert [sorted(re.sub(r"\s", "", style).rstrip(";").split(";")) for _, style in after.attributes] == styles


def test_everything_from_outside_is_escaped():
    """Markup, formulas and control characters in any field end as text."""
    evil = verdict(
        title=EVIL,
        parts=tuple((name, EVIL + " `" + EVIL + "`") for name, _ in PARTS),
        cases=(Case(EVIL, "different", 0.5, (0.5, 0.5), EVIL, EVIL, mistake=EVIL),),
    )
    html = card.html(card.of(evil, notes=[(EVIL, EVIL)]))
    flat = Flat(html)
    assert flat.tags <= {"div", "span", "b", "code", "pre", "table", "tr", "th", "td"}
    assert {name for name, _ in flat.attributes} == {"style"}
    assert "<script>alert(1)</script>" in flat.text
    assert not set("\x00\x1b") & set(html + card.text(evil))
    assert re.findall(r"[$\\]", html) == re.findall(r"(?<=<span>)[$\\](?=</span>)", html)


def test_long_texts_are_cut():
    """A flood in one field does not become a flood on the card."""
    shown = card.of(verdict(parts=(("wrong", "x" * 10_000),)), notes=[("Printed", "y" * 10_000)])
    assert len(card.text(shown)) < 4500
    assert "…" in card.text(shown)


def test_data_sets_that_say_the_same_take_one_line():
    """A right answer lists its data sets in a sentence; with a single one there is nothing to count."""
    right = verdict("passed", "identical", 1.0, cases=(Case("a", "identical"), Case("b", "identical", blind=True)))
    assert "Data sets: ✓ right on all 2: a, b (blind)" in card.text(right)
    assert "<table" not in card.html(right)
    one = verdict("passed", "identical", 1.0, cases=(Case("a", "identical"),))
    assert "Data sets: ✓ right on a" in card.text(one)
    hidden = verdict("passed", "identical", 1.0, cases=(Case("a", "identical"), Case("s1", "identical", hidden=True)))
    assert "✓ right on all 2: a, 1 hidden" in card.text(hidden)


def test_a_verdict_without_parts_shows_its_message():
    """Old or foreign verdicts have a message only."""
    assert "A message." in card.text(verdict(parts=()))
    assert "A message." in card.html(verdict(parts=()))


def test_figure_is_plain_json_of_two_scenes():
    """Strict JSON, small, surfaces and lines only."""
    built = card.figure(verdict(figure=sampled([0, 0, 1.0])))
    text = json.dumps(built, allow_nan=False)
    assert len(text) < 60_000
    assert {trace["type"] for trace in built["data"]} == {"surface", "scatter3d"}
    assert {"scene", "scene2"} <= set(built["layout"])


def test_a_right_answer_is_drawn_alone():
    """Two equal scenes would cost the browser a context and tell nothing."""
    built = card.figure(verdict("passed", "identical", 1.0, figure=sampled(0.0)))
    assert "scene2" not in built["layout"]
    assert "agrees with the reference" in built["layout"]["meta"]["alt"]


def test_gaps_in_an_answer_are_drawn_as_gaps():
    """None for a point that is not finite."""
    figure = sampled(0.0)
    figure.yours[2][3] = [None, None, None]
    built = card.figure(verdict(tier="not finite", figure=figure))
    assert "1 of 25 points of yours are not finite" in built["layout"]["meta"]["alt"]


def test_without_samples_there_is_no_figure():
    """Values and words have none; an answer that failed shows what was asked for."""
    assert card.figure(verdict()) is None
    assert card.figure_bundle(verdict()) is None
    surface = sampled(0.0)
    alone = Figure("surface", surface.parameters, surface.expected, None)
    assert "scene2" not in card.figure(verdict(tier="error", figure=alone))["layout"]
    assert "two curves" in card.figure(verdict(figure=sampled(1.0, "curve")))["layout"]["meta"]["alt"]


def test_bundles_hold_text_for_every_reader():
    """A terminal, a screen reader and a diff read text/plain."""
    assert set(card.bundle(verdict())) == {"text/plain", "text/html"}
    bundle = card.figure_bundle(verdict(figure=sampled(0.5)))
    assert bundle["text/plain"].startswith("[figure: Two 3-D scenes")
    assert "sendChartToCloud" in bundle[card.PLOTLY]["config"]["modeBarButtonsToRemove"]


def typed(*numbers):
    return {"dtype": "f4", "bdata": base64.b64encode(np.array(numbers, "<f4").tobytes()).decode()}


@pytest.mark.parametrize(
    ("built", "complaint"),
    [
        ({"data": []}, "data .* and layout"),
        ({"data": [], "layout": {}, "frames": []}, "nothing else"),
        ({"data": [{"type": "scatter"}], "layout": {}}, "scatter3d, surface only"),
        ({"data": [{"type": "surface", "z": [[float("nan")]]}], "layout": {}}, "not finite"),
        ({"data": [{"type": "surface", "z": typed(1, np.inf)}], "layout": {}}, "not finite"),
        ({"data": [{"type": "surface", "z": {"bdata": "###", "dtype": "f4"}}], "layout": {}}, "base64"),
        ({"data": [{"type": "surface", "z": typed(1, 2) | {"shape": "3, 1"}}], "layout": {}}, "shape"),
        ({"data": [{"type": "surface", "z": typed(1) | {"dtype": "f8"}}], "layout": {}}, "dtype f4"),
        ({"data": [{"type": "surface", "z": np.zeros(3)}], "layout": {}}, "plain JSON only; got ndarray"),
        ({"data": [], "layout": {"title": "x" * 5000}}, "too long"),
        ({"data": [], "layout": {1: "x"}}, "not a string"),
        ({"data": [{"type": "surface", "z": [0] * 400_001}], "layout": {}}, "at most 400000 numbers"),
    ],
)
def test_what_is_no_such_figure_is_refused(built, complaint):
    """Each rule of the validation sees its breach."""
    with pytest.raises(ValueError, match=complaint):
        card.validated(built)


def test_gaps_and_bounded_numbers_are_let_through():
    """The neighbours of what is refused: NaN inside a typed array is a gap, None in a list too."""
    built = {"data": [{"type": "surface", "z": typed(1, np.nan), "x": [None, 1.5]}], "layout": {"title": "x"}}
    assert card.validated(built) == built


def test_a_stressed_word_is_set_in_italics_and_a_product_is_not():
    """Hints are written in Markdown's way; what a learner's own error says is left alone."""
    parts = (("look", "Here the *shape* says it, 2*x*y and u *= 2 do not; `a *b* c` is code."),)
    shown = card.html(verdict(parts=parts))
    assert "the <em>shape</em> says" in shown
    assert "2*x*y and u *= 2" in shown
    assert "<code>a *b* c</code>" in shown


def test_a_single_reason_needs_no_sum():
    """One factor is the share itself; several are multiplied out."""
    one = verdict("partial", fraction=0.5, terms=(("this slip", 0.5),))
    assert "Worth: 0.5 of the points (this slip)." in card.text(one)
    two = verdict("partial", fraction=0.375, terms=(("right on 3 of 4 data sets", 0.75), ("since not on all", 0.5)))
    assert "Worth: 0.75 (right on 3 of 4 data sets) × 0.5 (since not on all) = 0.375 of the points." in card.text(two)


def test_the_letters_of_a_place_stand_in_the_head_of_the_table():
    """Each row then holds its numbers on one line."""
    shown = card.html(verdict(cases=(Case("a", "different", 0.1, (0.5, 1.0), "(1, 2, 3)", "(1, 2, 4)"),)))
    assert ">at (u, w)</th>" in shown
    assert ">(0.5, 1)</td>" in shown
