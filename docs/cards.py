"""One verdict card of each kind, with its figure, as PNG: what a learner gets to see.

    python docs/cards.py                  into docs/_build/cards
    python docs/cards.py --to FOLDER close moved

Made with the shipped exercises and answers that end on each tier, drawn with headless Chromium as a notebook shows them.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from directrix.plot import page

from autograder import card
from autograder.catalogue import shipped
from autograder.diagnosis.earlier import Earlier
from autograder.judge import judge
from autograder.result import Verdict

sys.path.insert(0, str(Path(__file__).parent))
from gallery import SETTLE, chromium

HERE = Path(__file__).parent
Answer = Callable[..., Any]


def main(arguments: Sequence[str] | None = None) -> int:
    """The command: 0 if all pictures were made."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*", help="only cards that have one of these words in their name")
    parser.add_argument("--to", type=Path, default=HERE / "_build" / "cards", help="the folder to write into")
    asked = parser.parse_args(arguments)
    chosen = [one for one in verdicts() if not asked.words or any(word in one[0] for word in asked.words)]
    if not chosen:
        parser.error(f"no card is called {' or '.join(asked.words)}")
    asked.to.mkdir(parents=True, exist_ok=True)
    with chromium() as browser:
        shown = browser.new_page(viewport={"width": 900, "height": 900})
        for name, verdict in chosen:
            shown.set_content(as_page(verdict))
            if card.figure(verdict) is not None:
                shown.wait_for_selector(".gl-container canvas", timeout=60_000)
            shown.wait_for_timeout(SETTLE)
            path = asked.to / f"{name}.png"
            shown.locator("#card").screenshot(path=path)
            print(path)
            print(card.text(verdict), end="\n\n")
    return 0


def as_page(verdict: Verdict) -> str:
    """A card and its figure on a page of their own."""
    figure = card.figure(verdict)
    drawn = page.fragment(figure) if figure is not None else ""
    style = "width: 860px; font-family: system-ui, sans-serif"
    return f"<!doctype html><head>{page.head()}</head><div id='card' style='{style}'>{card.html(verdict)}{drawn}</div>"


def verdicts() -> Iterator[tuple[str, Verdict]]:
    """A name and a verdict for each tier and gate, and for what is said besides."""
    find = shipped().find
    cylinder, torus, bezier, spline = map(find, ("cylinder", "torus", "bezier_patch", "bspline_patch"))
    bernstein, solid, count, knots = map(find, ("bernstein", "hyperpatch", "count_coefficients", "open_knots"))

    def of(exercise: Any, answer: Answer, **options: Any) -> Verdict:
        return judge(exercise, answer, **options)

    def at(exercise: Any, change: Answer) -> Answer:
        def answer(u: Any, w: Any, *data: Any) -> Any:
            u, w = np.broadcast_arrays(np.asarray(u, dtype=float), np.asarray(w, dtype=float))
            return change(lambda u, w: exercise.reference(u, w, *data), u, w)

        return answer

    bump = np.array([0.4, -0.2, 1.0])
    yield "identical", of(cylinder, cylinder.reference)
    yield "identical-hidden", of(cylinder, cylinder.reference, seed=b"hidden")
    yield "mistake", of(bezier, bezier.mistakes[0].formula)
    yield "relabelled", of(bezier, at(bezier, lambda f, u, w: f(1 - u, 1 - w)))
    yield "other-start", of(torus, at(torus, lambda f, u, w: f((u + 0.25) % 1, w)))
    yield "close", of(cylinder, at(cylinder, lambda f, u, w: f(u * 3.14 / np.pi, w)))
    yield "same-set", of(bezier, at(bezier, lambda f, u, w: f(u**2, w)))
    yield "covered", of(cylinder, at(cylinder, lambda f, u, w: f((2 * u) % 1, w)))
    yield "part", of(bezier, at(bezier, lambda f, u, w: f(u / 2, w)))
    yield "more", of(bezier, at(bezier, lambda f, u, w: _beyond(f, u, w)))
    yield "moved", of(bezier, at(bezier, lambda f, u, w: f(u, w) + [0, 0, -3]))
    yield "moved-set", of(bezier, at(bezier, lambda f, u, w: f(u**2, w)[..., [1, 2, 0]]))
    yield "different", of(bezier, at(bezier, lambda f, u, w: f(u, w) + np.sin(9 * u * w)[..., None] * bump))
    yield (
        "different-inside",
        of(bezier, at(bezier, lambda f, u, w: f(u, w) + (u * (1 - u) * w * (1 - w))[..., None] * 9 * bump)),
    )
    yield "different-last-span", of(spline, _last_span(spline))
    yield "different-data", of(bezier, _unequal(bezier))
    yield "different-coordinate", of(bezier, at(bezier, lambda f, u, w: f(u, w) * [1, 1, -1]))
    yield "solid", of(solid, lambda u, v, w, *data: solid.reference(u, v, w, *data) + np.sin(3 * u * v * w)[..., None] * bump)
    yield "value", of(knots, lambda m, k: knots.reference(m, k)[:-1])
    yield "word", of(count, lambda *data: -1)
    yield "error", of(bezier, lambda u, w, P: P[9])
    yield "stub", of(bezier, _stub)
    yield "shape", of(cylinder, lambda u, w, r, h: np.moveaxis(cylinder.reference(u, w, r, h), -1, 0))
    yield "not-finite", of(cylinder, at(cylinder, lambda f, u, w: f(u, w) * ((u + w) / (u + w))[..., None]))
    yield "not-pointwise", of(cylinder, at(cylinder, lambda f, u, w: f(u / np.max(u, initial=0.1), w)))
    slip = next(m for m in bernstein.mistakes if m.credit is not None)
    (construction,) = bezier.constructions
    built = lambda u, w, P: construction.formula(u, w, P, slip.formula)  # noqa: E731
    yield "follows", of(bezier, built, earlier=lambda: [Earlier(bernstein, slip.formula)])


def _stub(*arguments: Any) -> Any:
    raise NotImplementedError


def _beyond(f: Answer, u: Any, w: Any) -> Any:
    """A patch that goes on beyond its end along u, as the polynomial does."""
    t = np.linspace(0.0, 1.0, 8)
    values = np.stack([f(np.full_like(u, one), w) for one in t], axis=-1)
    weights = [np.prod([(1.4 * u - b) / (a - b) for b in t if b != a], axis=0) for a in t]
    return np.einsum("...ci,i...->...c", values, np.stack(weights))


def _last_span(exercise: Any) -> Answer:
    def answer(u: Any, w: Any, P: Any, k: Any, l: Any) -> Any:  # noqa: E741
        u, w = np.broadcast_arrays(np.asarray(u, dtype=float), np.asarray(w, dtype=float))
        spans = np.shape(P)[0] - k + 1
        off = np.maximum(u - (spans - 1) / spans, 0) if spans > 1 else 0 * u
        return exercise.reference(u, w, P, k, l) + off[..., None] * [0.0, 1.0, 4.0]

    return answer


def _unequal(exercise: Any) -> Answer:
    def answer(u: Any, w: Any, P: Any) -> Any:
        u, w = np.broadcast_arrays(np.asarray(u, dtype=float), np.asarray(w, dtype=float))
        wrong = np.shape(P)[0] != np.shape(P)[1]
        return exercise.reference(u, w, P) + wrong * np.sin(4 * u * w)[..., None]

    return answer


if __name__ == "__main__":
    sys.exit(main())
