"""What a notebook's process says among its learner's outputs is said in the course's language, in a real sandbox."""

import re
import string

import pytest

from autograder import messages
from autograder.errors import CallFailed
from autograder.messages import say
from autograder.notebook.session import ENVIRONMENT, environment
from autograder.notebook.told import handed_over
from autograder.sandbox import Limits, Policy, Sandbox
from autograder.sandbox.guest import words

# Said against what no code of ours answers.
FORGED = {
    "nonsense", "answers_with", "protocol", "never_handed", "no_value", "no_plain", "no_array", "no_text", "unsent",
}  # fmt: skip


@pytest.fixture
def marked(monkeypatch):
    """Another language, in which each text is its key and its facts: ``<guest.more 10>``."""
    monkeypatch.setattr(messages, "TEXT", dict(messages.ENGLISH))
    facts = {key: [name for _, name, _, _ in string.Formatter().parse(text) if name] for key, text in messages.ENGLISH.items()}
    messages.TEXT.update({key: " ".join([f"<{key}", *(f"{{{name}}}" for name in facts[key])]) + ">" for key in facts})


@pytest.fixture(scope="module")
def box():
    with Sandbox(Policy(packages=("numpy",), preload=())) as opened:
        yield opened


CELLS = {
    "print('y' * 20_000)": "guest.more 10",
    "for k in range(300): display(k)": "guest.many 100",
    "class Mute(Exception):\n    def __str__(self): raise ValueError\nraise Mute": "guest.unshown",
    "while True: pass": "guest.computing 0.5",
    "import time; time.sleep(30)": "guest.clock 3",
    "input()": "guest.asks input",
    "import getpass; getpass.getpass()": "guest.asks getpass",
    "import autograder; autograder.check(len)": "guest.judging len",
    "autograder.check(3)": "guest.judging <guest.this_function>",
    "from autograder import judge": "guest.only_check autograder.judge",
    "import directrix; directrix.Sphere": "guest.only_plot directrix.Sphere",
}
FUNCTIONS = """
import numpy as np
number = 3
def many(): return [[None] * 900] * 120
def large(): return (np.zeros(10**5),) * 3
def same(x): return x
def own(): return object()
def odd(): return np.array([object()])
def deep():
    found = []
    for _ in range(60): found = [found]
    return found
def spoil(x): x.append(object())
def bounce(f, x): return f(x)
def stops(): raise StopIteration
def quits():
    import os
    os._exit(0)
"""
CALLS = {
    "nobody": "guest.missing nobody", "number": "guest.no_function number int", "many": "guest.parts", "large": "guest.bytes",
}  # fmt: skip
TESTS = {
    "same(object())": "guest.hands_over <guest.object object>",
    "own()": "guest.cannot_leave <guest.answer> <guest.object object>",
    "odd()": "guest.cannot_leave <guest.answer> <guest.dtype object>",
    "deep()": "guest.cannot_leave <guest.answer> <guest.deep 24>",
    "held = []\nspoil(held)": "guest.has_now <guest.object object>",
    "back = lambda x: bounce(back, x)\nbounce(back, 1)": "guest.to_and_fro 50",
    "stops()": "guest.raised StopIteration",
    "same.__code__": "guest.stays __code__ same",
    "quits()": "guest.ended",
}
QUICK = Limits(cell_cpu=0.5, patience=1.5, output=10_000, outputs=100, answer=10**6)


def shown(result):
    return " ".join(str(output) for output in result.outputs)


def told(box):
    """All that was met, by what brought it about."""
    with box.open(limits=QUICK, environment=environment("ada")) as session:
        for source in CELLS:
            yield source, shown(session.run_cell(source))
        assert session.run_cell(FUNCTIONS).status == "ok"
        for name in CALLS:
            with pytest.raises(CallFailed) as failed:
                session.call(name, ())
            yield name, failed.value.message
    learner, tests = box.pair(limits=QUICK, environment=environment("ada"))
    with learner, tests:
        assert learner.run_cell(FUNCTIONS).status == "ok"
        for source in TESTS:
            names = ("same", "own", "odd", "deep", "spoil", "bounce", "stops", "quits")
            yield source, shown(tests.run_apart(source, names, learner))


def test_the_catalogue_speaks_as_a_notebooks_process_does():
    """It has each of its texts, in English the very same."""
    assert {key: text for key, text in messages.ENGLISH.items() if key.startswith("guest.")} == {
        f"guest.{key}": text for key, text in words.ENGLISH.items()
    }


def test_all_that_a_notebooks_process_says_is_said_in_the_other_language(marked, box):
    """Nothing of it is English, and every text is met but those against a forged answer."""
    found = dict(told(box))
    wanted = {**CELLS, **CALLS, **TESTS}
    assert {by: text[-300:] for by, text in found.items() if f"<{wanted[by]}" not in text} == {}
    met = {key for text in found.values() for key in re.findall(r"<guest\.(\w+)", text)}
    assert set(words.ENGLISH) - met == FORGED


def test_in_english_nothing_is_handed_over(box):
    """The environment of a notebook has our words in no course that speaks English."""
    assert handed_over() == {}
    assert environment("") == ENVIRONMENT
    with box.open(limits=QUICK, environment=environment("ada")) as session:
        assert shown(session.run_cell("import os\nos.environ.get('DIRECTRIX_WORDS')")) == ""
        more = session.run_cell("print('y' * 20_000)").outputs[0]["text"]
        assert more.endswith(f"\n{say('guest.more', size=10)}\n")


def test_what_a_learner_prints_is_no_word_of_ours(marked, box):
    """The English text, and the key, stand as they were printed; and one notebook's language is not the next one's."""
    printed = f"{words.ENGLISH['many']} <sandbox.cell> {{size}}"
    with box.open(limits=QUICK, environment=environment("ada")) as session:
        assert session.run_cell(f"print({printed!r})").outputs[0]["text"] == f"{printed}\n"
        session.run_cell("from autograder.sandbox.guest import words\nwords._texts['more'] = 'mine'")
    with box.open(limits=QUICK, environment=ENVIRONMENT) as session:
        assert "the output of this cell is cut here" in shown(session.run_cell("print('y' * 20_000)"))
