"""A translation is a file, and it changes every word of every card, figure and feedback page."""

import html
import json
import os
import re
import string
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from autograder import card, messages, translation
from autograder.catalogue import shipped
from autograder.checking import advice, shell, signature
from autograder.checking.calling import Learner
from autograder.comparison.target import targets
from autograder.diagnosis.wording import spoken
from autograder.errors import CourseError
from autograder.exercise import PUBLIC_SEED
from autograder.feedback.hide import Hidden
from autograder.feedback.page import Scored, Sheet, render
from autograder.judge import judge
from autograder.result import Case, Figure, Verdict

sys.path.insert(0, str(Path(__file__).parents[2] / "docs"))
import cards


def louder(text):
    """The text in capitals, but for the names in braces."""
    pieces = string.Formatter().parse(text)
    return "".join(plain.upper() + ("" if name is None else f"{{{name}}}") for plain, name, _, _ in pieces)


@pytest.fixture
def loud(monkeypatch):
    """Every text in capitals, for the time of a test."""
    monkeypatch.setattr(messages, "TEXT", dict(messages.ENGLISH))
    messages.use({key: louder(text) for key, text in messages.ENGLISH.items()})


def quiet_words(text, *known):
    """What is still written small, once what is known to come from elsewhere is taken out, the longest first."""
    text = " ".join(text.replace("`", "").split())
    for phrase in sorted({" ".join(str(one).replace("`", "").split()) for one in known}, key=len, reverse=True):
        text = re.sub(rf"(?<![\w]){re.escape(phrase)}(?![\w])", " ", text) if phrase else text
    return re.findall(r"[^\W\d_]*[a-z][^\W\d_]*", re.sub(r"\d(?:\.\d+)?e[-+]?\d+", "0", text))


def of_the_assignment(exercise):
    """Words of an exercise that may stand on a card: they are in its own files."""
    for mistake in exercise.mistakes:
        yield from (mistake.hint, mistake.hint.replace("*", ""), mistake.id, spoken(mistake.id))
    yield from (exercise.title, exercise.id, exercise.signature, *exercise.arguments, *"uvwxyz")
    for data in exercise.data_sets:
        yield data.name


# What Python and NumPy say themselves.
SAID_BY_PYTHON = {
    "error": ("IndexError", "index 9 is out of bounds for axis 0 with size 4"),
    "value": (),
}


def visible(figure):
    """All words of a figure: annotations, titles, buttons, what is shown on hovering and read aloud."""
    layout = figure["layout"]
    yield from (note["text"] for note in layout.get("annotations", ()))
    yield from (button["label"] for menu in layout.get("updatemenus", ()) for button in menu["buttons"])
    yield from (layout["meta"]["alt"], layout.get("title", {}).get("text", ""))
    for trace in figure["data"]:
        yield trace.get("colorbar", {}).get("title", {}).get("text", "")
        yield re.sub(r"%\{[^}]*\}", "", trace.get("hovertemplate", ""))


def without_tags(text):
    """HTML as it is read."""
    return html.unescape(re.sub(r"<[^>]*>", " ", text))


def test_every_word_of_every_card_and_figure_is_translated(loud):
    """Each tier, gate and remark: what is left in small letters comes from the assignment or from Python."""
    left, drawn = {}, 0
    for name, verdict in cards.verdicts():
        known = [*of_the_assignment(shipped().find(verdict.exercise)), *SAID_BY_PYTHON.get(name, ())]
        known += [id for id in ("bernstein",) if name == "follows"]
        shown = [card.text(verdict), without_tags(card.html(verdict))]
        if (figure := card.figure(verdict)) is not None:
            shown += map(without_tags, visible(figure))
            drawn += 1
        left[name] = [word for text in shown for word in quiet_words(text, *known)]
    assert {name: words for name, words in left.items() if words} == {}
    assert drawn > 15


def unlike(exercise):
    """Answers to any exercise that are wrong in many ways, and its first listed mistake."""
    yield lambda *arguments: None
    yield lambda *arguments: 1j
    yield lambda *arguments: np.nan
    yield lambda *arguments: {}["q"]
    if exercise.judged_as is None:  # or what its own function says of an answer stands on the card
        yield lambda *arguments: "WORD"
        yield lambda *arguments: np.zeros((2, 2))
        yield lambda *arguments: (1.0, np.zeros(3))
    yield exercise.mistakes[0].formula


@pytest.mark.parametrize("exercise", list(shipped()), ids=lambda exercise: exercise.id)
def test_every_word_of_the_card_of_any_exercise_is_translated(loud, exercise):
    """Surfaces, curves, solids, fields, values, masks and words, with what is said of their data."""
    known = [*of_the_assignment(exercise), "KeyError", "q", "True", "False", "None", "ValueError", "nan"]
    for target in targets(exercise, PUBLIC_SEED):
        words = [repr(value) for value in target.drawn.arguments.values() if isinstance(value, str)]
        known += [target.drawn.says.rstrip("."), *words]
    for answer in unlike(exercise):
        verdict = judge(exercise, answer, figure=False, search=False)
        words = [case.yours for case in verdict.cases if exercise.kind == "label" and case.yours]  # the learner's own
        words += [word.strip("'") for word in words]
        assert verdict.outcome != "could not judge"
        assert quiet_words(card.text(verdict), *known, *words) == []


def bowl(height, **more):
    """A picture of a paraboloid, the learner's one so much higher."""
    t = tuple(float(x) for x in np.linspace(0, 1, 5))
    U, W = np.meshgrid(t, t, indexing="ij")
    points = np.dstack([U, W, U * W])
    yours = None if height is None else (points + [0, 0, height]).tolist()
    return Figure("surface", (t, t), points.tolist(), yours, **{"size": 1.7, **more})


def pictures():
    """What a figure says in the odd cases: gaps, far out, nothing finite, a curve, a layer, alone."""
    yield bowl(0.5, worst=(0.25, 1.0))
    yield bowl(1e4)
    yield bowl(1e12)
    yield bowl(0.0, layer="w = 0.5", names=("u", "v"))
    yield bowl(None)
    gaps = bowl(0.0)
    gaps.yours[2][3] = [None] * 3
    yield gaps
    yield Figure("surface", gaps.parameters, gaps.expected, [[[None] * 3] * 5] * 5, size=1.7)
    t = gaps.parameters[0]
    yield Figure("curve", (t,), [[x, x, x] for x in t], [[x, x, 2 * x] for x in t], size=1.7)


@pytest.mark.parametrize("drawn", list(pictures()))
def test_every_word_of_an_odd_figure_is_translated(loud, drawn):
    """Also what is left out of a picture, and what a screen reader says of it."""
    none = np.isnan(np.asarray(drawn.yours if drawn.yours is not None else 0.0, dtype=float)).all()
    for outcome, tier in (("failed", "different"), ("passed", "identical"))[: 1 if none else 2]:
        bundle = card.figure_bundle(Verdict("saddle", outcome, float(outcome == "passed"), tier, "", figure=drawn))
        for text in (bundle["text/plain"], *visible(bundle[card.PLOTLY])):
            assert quiet_words(without_tags(text), *"uvwxyz") == []


def cards_of_check():
    """What check shows where there is no answer, with the words in it that come from elsewhere."""
    known = shipped()
    cylinder = known.find("cylinder")

    def named(name):
        def f(u, w, r, h):
            raise NotImplementedError

        f.__name__ = name
        return f

    slip = shell.Failure("def cylinder(u:", "SyntaxError", "'(' was never closed", 1, "def cylinder(u:", is_syntax=True)
    tabs = shell.Failure("def cylinder(u):", "TabError", "inconsistent", None, "", is_syntax=True)
    colon = shell.Failure("def cylinder(u)", "SyntaxError", "expected colon", 1, "", is_syntax=True)
    late = shell.Failure("x = nowhere", "NameError", "nowhere", None, "x = nowhere", is_syntax=False)
    for given in ("cylinder", "cilinder", None, np.zeros((4, 3)), lambda u: u, named("cilinder"), named("zzz")):
        yield advice.no_exercise(given, known, {})
    own = named("<lambda>")
    yield advice.no_exercise(own, known, {"cylinder": own})
    yield advice.no_exercise(3.5, known, {})
    for failure in (slip, tabs, colon, late):
        yield advice.missing("cylinder", failure, known, {})
    yield advice.missing("cylinder", None, known, {})
    yield advice.missing("zzzzz", None, known, {})
    yield advice.missing("cylindr", None, known, {})
    yield advice.missing("cylinder", None, known, {"cylnder": named("cylnder")})
    more = [advice.older_version("cylinder", slip), advice.whose_numbers("ada"), advice.whose_numbers("")]
    more += advice.not_there(cylinder, ["scipy.special", "directrix.Sphere"])
    yield card.with_parts(card.Card("passed", "cylinder", ()), more)
    yield advice.interrupted(cylinder, Learner(named("cylinder")))
    for f in (
        lambda u, w: 0, lambda u, w, hh: 0, lambda u, w, r, *, h: 0, lambda w, u, r, h: 0, lambda u, w, radius, h: 0,
        lambda u, w, radius, h, zzz: 0, lambda u, w, r, h, zzz: 0,
    ):  # fmt: skip
        trouble = signature.trouble_with(cylinder, f)
        yield trouble.card(cylinder)


FROM_ELSEWHERE = (
    "def cylinder(u:", "'(' was never closed", "inconsistent", "expected colon", "x = nowhere", "nowhere", "SyntaxError",
    "TabError", "NameError", "ada", "zzz", "zzzzz", "cilinder", "cylindr", "cylnder", "hh", "def", "check", "float", "radius",
    "NotImplementedError", "line", "scipy", "directrix.Sphere", "numpy", "plotly",
)  # fmt: skip


def test_every_word_of_what_check_shows_is_translated(loud):
    """Names, results, missing functions, cells that stopped, arguments that differ."""
    shown = list(cards_of_check())
    known = [*FROM_ELSEWHERE, *(one.id for one in shipped()), *of_the_assignment(shipped().find("cylinder"))]
    assert {one.title: words for one in shown if (words := quiet_words(card.text(one), *known))} == {}
    asked = {key for key in messages.ENGLISH if key.startswith("check.")}
    said = "\n".join(card.text(one).replace("`", "") for one in shown)
    pieces = {key: [p for p, *_ in string.Formatter().parse(messages.TEXT[key].replace("`", "")) if p.strip()] for key in asked}
    assert sorted(key for key in asked if not all(" ".join(p.split()) in said for p in pieces[key])) == []


def test_what_a_function_printed_and_warned_of_is_headed_in_the_other_language(loud):
    """The words around it are ours, the lines are the learner's."""

    def chatty(u):
        print("hello")
        print("hello")
        print("y" * 3000)
        np.log(np.zeros(1))

    learner = Learner(chatty)
    with learner.quiet():
        learner(0.5)
    notes = [text for pair in learner.notes() for text in pair]
    ours = [re.sub("hello|y{9,}|RuntimeWarning.*|np.log.*", "", text) for text in notes]
    assert len(notes) == 4
    assert [word for text in ours for word in quiet_words(text)] == []


def test_every_word_of_a_feedback_page_is_translated(loud):
    """Head, table, cells that wait, late penalty, comments, folded code, hidden tests."""
    meta = {"nbgrader": {"grade_id": "q1", "grade": True}, "jupyter": {"source_hidden": True}}
    hidden = "### BEGIN HIDDEN TESTS\nassert 41 + 1 == 42\n### END HIDDEN TESTS"
    outputs = [
        {"output_type": "error", "ename": "OOPS", "evalue": "assert 41 + 1 == 42", "traceback": ["assert 41 + 1 == 42"]},
        {"output_type": "stream", "name": "stdout", "text": "assert 41 + 1 == 42"},
        {"output_type": "display_data", "data": {"image/png": "iVBORw0KGgo="}},
    ]
    cells = [{"cell_type": "code", "metadata": meta, "source": hidden, "outputs": outputs}]
    sheet = Sheet("NB", "A1", "ADA", {"q1": Scored(None, 2.0)}, {"q1": "FINE"}, 0.5)
    page = render({"cells": cells}, sheet, hidden=Hidden())
    assert '<html lang="EN">' in page
    labels = re.findall(r'(?:aria-label|alt)="([^"]*)"', page)
    body = re.sub(r"<style>.*?</style>", "", page, flags=re.DOTALL)
    assert quiet_words(" ".join([without_tags(body), *labels]), "q1") == []
    for said in ("feedback.waits", "feedback.comment", "feedback.code", "feedback.hidden_text", "feedback.part"):
        assert messages.TEXT[said] in without_tags(page)


# --- how it is installed


@pytest.fixture
def english(monkeypatch):
    monkeypatch.setattr(messages, "TEXT", dict(messages.ENGLISH))


def test_what_a_translation_does_not_have_stays_english(english):
    """A translation may be begun with one text, and may leave out a name."""
    messages.use({"part.look": "Weiter", "table.many_hidden": "einige verborgen"})
    shown = Verdict("x", "failed", 0.0, "different", "", parts=(("look", "A"), ("where", "B")))
    assert card.text(shown).splitlines()[1:] == ["Weiter: A", "Where: B"]
    cases = tuple(Case(name, "different", hidden=True) for name in "ab")
    assert "einige verborgen" in card.text(Verdict("x", "failed", 0.0, "different", "", cases=cases))


@pytest.mark.parametrize(
    ("texts", "complaint"),
    [
        ({"part.lok": "Weiter"}, "'part.lok' is none; did you mean 'part.look'?"),
        ({"part.look": 3}, "the translation of 'part.look' must be a text; got 3"),
        ({"stop.card": "{titel}"}, "may name in braces: title; got titel"),
        ({"part.look": "{title}"}, "may name in braces: none; got title"),
        ({"stop.card": "{title.upper}"}, "may name in braces: title; got title.upper"),
        ({"stop.card": "{title!r:>9}"}, "may name in braces: title; got title!r:>9"),
        ({"stop.card": "a { b"}, "has a brace that is none"),
    ],
)
def test_a_text_that_could_not_be_said_is_refused(english, texts, complaint):
    """What must hold, what came; and nothing is replaced."""
    with pytest.raises(CourseError, match=re.escape(complaint)):
        messages.use({"part.where": "Wo", **texts})
    assert messages.ENGLISH == messages.TEXT


@pytest.mark.parametrize(
    ("content", "complaint"),
    [(None, "cannot be read"), (b"{", "cannot be read"), (b"[]", "something else"), (b"\xff", "cannot be read")],
)
def test_a_file_that_is_no_translation_is_refused(tmp_path, content, complaint):
    """It says how to begin one."""
    path = tmp_path / "german.json"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(CourseError, match=rf"autograder\.translation writes.*{complaint}"):
        translation.read(path)


def test_the_environment_names_the_file(tmp_path):
    """Begun with what the module writes; then judge and check speak it, in whatever process."""
    run = [sys.executable, "-m", "autograder.translation"]
    written = subprocess.run(run, capture_output=True, text=True, check=True, encoding="utf-8").stdout
    assert json.loads(written) == messages.ENGLISH
    path = tmp_path / "german.json"
    path.write_text(json.dumps({"outcome.passed": "Richtig", "right.value_one": "Stimmt.", "part.right": "Gut"}), "utf-8")
    say = "from autograder.messages import say\nprint(say('outcome.passed'), say('right.value_one'))"
    environment = {**os.environ, translation.VARIABLE: str(path)}
    run = [sys.executable, "-c", say]
    assert subprocess.run(run, capture_output=True, text=True, check=True, env=environment).stdout == "Richtig Stimmt.\n"
    path.write_text('{"outcome.pased": "Richtig"}', "utf-8")
    failed = subprocess.run(run, capture_output=True, text=True, check=False, env=environment)
    assert failed.returncode == 1
    assert "'outcome.pased' is none; did you mean 'outcome.passed'?" in failed.stderr
