"""What the sandbox says, in the words of the catalogue: the sandbox has no arrow to it.

Its trusted side says it with keys, which :func:`told` translates. What a notebook's process says stands among what its learner
prints, where nothing can be told apart, so that process is handed the words at its start (:func:`handed_over`).
"""

from __future__ import annotations

import json

from autograder import messages
from autograder.messages import say
from autograder.sandbox.guest import words
from autograder.sandbox.messages import Said

GUEST = {key: f"guest.{key}" for key in words.ENGLISH}


def told(text: str) -> str:
    """The same text in the language that is spoken; one that is not the sandbox's own stays as it is."""
    if not isinstance(text, Said):
        return text
    return say(f"sandbox.{text.key}", **{name: told(fact) for name, fact in text.facts.items()})


def handed_over() -> dict[str, str]:
    """The variable of a notebook's environment that holds these words; none where they are English."""
    other = {key: text for key, ours in GUEST.items() if (text := messages.TEXT[ours]) != messages.ENGLISH[ours]}
    return {words.VARIABLE: json.dumps(other)} if other else {}
