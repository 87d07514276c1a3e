"""What a notebook's process says to a learner: in English, or in the words that the trusted side handed over at its start.

They come in the environment (``VARIABLE``: JSON of texts by their keys), so nothing that a learner prints is ever looked at or
replaced on the other side. Names in braces are filled in by :func:`say`.
"""

from __future__ import annotations

import json
import os

VARIABLE = "DIRECTRIX_WORDS"
ENGLISH: dict[str, str] = {
    "more": "... the output of this cell is cut here: it shows more than {size} kB.",
    "many": "... the output of this cell is cut here: it shows more than {count} things.",
    "unshown": "(its message cannot be shown)",
    "computing": "stopped after {seconds} s of computing; is there a loop that never ends?",
    "clock": "stopped after {seconds} s by the clock; is it waiting for something?",
    "asks": "{name}() has nobody to ask while the grader runs the notebook; use a variable instead",
    "judging": "The grader is judging {name}; its verdict stands at the graded cell.",
    "this_function": "this function",
    "only_check": "{name} is not there while the grader runs a notebook: only autograder.check and autograder.personal are",
    "only_plot": (
        "{name} is not there while the grader runs a notebook: the exercise is to write it yourself. "
        "directrix.plot may be used."
    ),
    # --- a call of the grader's
    "missing": "the notebook defines no function called {name}",
    "no_function": "{name} is not a function in the notebook but of type {type}",
    "parts": "the answer has {count} parts; at most {most} are taken",
    "bytes": "the answer has {count} bytes; at most {most} are taken",
    # --- a test that runs apart: what could not go from one process to the other
    "hands_over": "the test hands over {what}, which cannot go to the learner's process",
    "answers_with": "the learner's process answers with {what}",
    "unsent": "the answer cannot be sent: {error}",
    "cannot_leave": "{name} is {what}, which cannot leave the notebook for this test",
    "answer": "the answer",
    "has_now": "an argument has {what} in it now, which cannot leave the notebook for this test",
    "to_and_fro": "more than {most} calls to and fro between a test and the code it tests",
    "raised": "the function raised {exception}",
    "stays": "{name} of {function} stays in the learner's process",
    "nonsense": "the learner's process answers nonsense",
    "ended": "the learner's process has ended",
    "protocol": "the learner's process does not keep to the protocol: {error}",
    "never_handed": "a function that was never handed over",
    "deep": "lists, tuples or dictionaries more than {most} deep",
    "object": "an object of type {type}",
    "dtype": "an array of dtype {dtype}",
    "no_value": "something that is not a value ({exception})",
    "no_plain": "a plain value that is none",
    "no_array": "an array that is none",
    "no_text": "an array of text that is none",
}
_texts = dict(ENGLISH)  # what is said


def install() -> None:
    """Say what the environment holds, where it holds any: asked once more when a process is given to a notebook."""
    if VARIABLE in os.environ:
        _texts.update(json.loads(os.environ[VARIABLE]))


def say(key: str, **facts: object) -> str:
    """One of the texts, its facts filled in."""
    return _texts[key].format(**facts)


install()
