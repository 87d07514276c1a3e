"""One card of each kind: the script makes what its names say, and a browser draws it."""

import sys
from pathlib import Path

import pytest

from autograder import card
from autograder.result import GATES, LADDER

sys.path.insert(0, str(Path(__file__).parents[2] / "docs"))
import cards


@pytest.fixture(scope="module")
def every():
    return dict(cards.verdicts())


def test_every_tier_has_its_card(every):
    """What a learner may get to see is there to be looked at; only chance and the clock are left out."""
    shown = {verdict.tier for verdict in every.values()}
    assert set(LADDER) | set(GATES) == shown | {"timeout", "not repeatable"}


def test_each_says_what_to_look_at(every):
    """First what is right, then what is wrong, where, and one thing to look at."""
    order = ["right", "wrong", "where", "look"]
    for name, verdict in every.items():
        told = [part for part, _ in verdict.parts]
        assert told == sorted(told, key=order.index), name
        if verdict.outcome != "passed":
            assert "wrong" in told, name
            assert "look" in told, name
        assert all(text.strip() and "{" not in text for _, text in verdict.parts), name


def test_a_card_is_drawn(tmp_path, chromium):
    """A picture of the card with its figure, and its words on the terminal."""
    assert cards.main(["--to", str(tmp_path), "stub", "solid"]) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["solid.png", "stub.png"]
    assert (tmp_path / "solid.png").stat().st_size > 20_000


def test_words_that_fit_nothing_are_an_error(capsys):
    with pytest.raises(SystemExit):
        cards.main(["klein"])
    assert "no card is called klein" in capsys.readouterr().err


def test_text_and_html_say_the_same(every):
    """The plain text alone suffices."""
    for name, verdict in every.items():
        text = card.text(verdict).replace("`", "")
        for _, said in verdict.parts:
            assert " ".join(said.replace("`", "").split()) in text or len(said) > 1000, name
