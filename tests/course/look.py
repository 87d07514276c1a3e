"""Runs a notebook source and photographs the page, so that somebody looks at it: ``python tests/course/look.py SOURCE OUT``.

SOURCE is an assignment's folder or a chapter's text; OUT receives ``page.html`` (plotly.js inside, formulas as MathML) and one
PNG a screenful. ``--released`` runs the learner's version with its stubs, ``--predict NAME=VALUE`` types a prediction.
"""

import argparse
import re
import shutil
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import nbclient
from plotly.offline import get_plotlyjs

from autograder import feedback
from autograder.feedback.cells import code_html, folded, output_html, style
from autograder.feedback.markdown import to_html
from autograder.notebook.chapter import guess_of

MOST_SCENES = 14  # a browser keeps 16 WebGL contexts alive on one page


def words(text: str) -> int:
    """Words of prose, a formula counting as one."""
    return len(re.sub(r"\$+[^$]+\$+", "formula", text).split())


def scenes(nb: Any, exercises: Mapping[str, Any] | None = None) -> int:
    """3-D scenes of a notebook: two for a comparison, one for any other picture and for the card of a check that draws one.

    A check of values, words or a plain net draws nothing; without the exercises every check counts.
    """
    code = "\n".join(cell.source for cell in nb.cells if cell.cell_type == "code")
    cards = re.findall(r"^ *check\((\w+)", code, re.MULTILINE)
    if exercises is not None:
        cards = [id for id in cards if exercises[id].judged_as or exercises[id].kind in ("surface", "curve", "solid")]
    return sum(len(re.findall(one, code)) for one in (r"plot\.(?:view|walk)\(", r"against=")) + len(cards)


def guesses(nb: Any) -> dict[str, int]:
    """Names that the reader is asked to fill in, and the cell where."""
    found = {}
    for number, cell in enumerate(nb.cells):
        if cell.cell_type == "code" and (name := guess_of(cell.source)):
            found[name] = number
    return found


def typed(nb: Any) -> dict[str, int]:
    """Type something into every guess; returns what was asked."""
    asked = guesses(nb)
    for guess, number in asked.items():
        nb.cells[number].source = re.sub(rf"^{guess} = None", f"{guess} = 'typed'", nb.cells[number].source)
    return asked


def executed(nb: Any, folder: Path, *, allow_errors: bool = False) -> Any:
    """The notebook with outputs, run from top to bottom by a real kernel."""
    client = nbclient.NotebookClient(
        nb,
        timeout=120,
        allow_errors=allow_errors,
        kernel_name="python3",
        resources={"metadata": {"path": str(folder)}},
    )
    return client.execute()


def page(nb: Any) -> str:
    """One self-contained HTML page of an executed notebook."""
    body = [f"<section>{to_html(cell.source)}</section>" if cell.cell_type == "markdown" else _code(cell) for cell in nb.cells]
    colours = style(Path(feedback.__file__).with_name("page.css"))
    return f"<!doctype html><meta charset=utf-8><style>{colours}</style><script>{get_plotlyjs()}</script>{''.join(body)}"


def _code(cell: Any) -> str:
    source = "▸ folded cell" if folded(cell) else code_html(cell.source)
    outputs = "".join(output_html(output, admit=lambda drawn: drawn)[0] for output in cell.outputs)
    return f"<section class='code cell'><div class=source>{source}</div><div class=outputs>{outputs}</div></section>"


# Few scenes at a time, as a browser keeps 16 WebGL contexts: each figure becomes a picture once it is drawn.
DRAW = """async () => {
  for (const place of document.querySelectorAll('.directrix-figure')) {
    const figure = JSON.parse(place.querySelector('script').textContent);
    await Plotly.newPlot(place, figure.data, figure.layout, {staticPlot: true});
    if (figure.frames) await Plotly.addFrames(place, figure.frames);
    const png = await Plotly.toImage(place, {format: 'png', width: 860, height: figure.layout.height || 450});
    Plotly.purge(place);
    place.innerHTML = `<img width=860 src="${png}">`;
  }
}"""


def photograph(text: str, out: Path, *, height: int = 1500) -> list[Path]:
    """PNGs of the page, a screenful each."""
    from playwright.sync_api import sync_playwright

    out.mkdir(parents=True, exist_ok=True)
    for old in out.glob("*.png"):
        old.unlink()
    (out / "page.html").write_text(text, "utf-8")
    shots = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        tab = browser.new_page(viewport={"width": 960, "height": height})
        tab.goto((out / "page.html").resolve().as_uri())
        tab.evaluate(DRAW)
        whole = tab.evaluate("document.documentElement.scrollHeight")
        for number, top in enumerate(range(0, whole, height)):
            shots.append(out / f"{number:02d}.png")
            clip = {"x": 0, "y": top, "width": 960, "height": min(height, whole - top)}
            tab.screenshot(path=shots[-1], full_page=True, clip=clip)
        browser.close()
    return shots


def main(arguments: list[str]) -> None:
    """The command line."""
    from autograder.catalogue import load_assignment
    from autograder.notebook import chapter, source

    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("source", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--released", action="store_true")
    parser.add_argument("--predict", action="append", default=[], metavar="NAME=VALUE")
    chosen = parser.parse_args(arguments)
    if chosen.source.is_dir():
        nb = source.build(load_assignment(chosen.source))
        nb = source.release(nb) if chosen.released else nb
    else:
        nb = chapter.build_chapter(chosen.source, solutions=not chosen.released)
    for prediction in chosen.predict:
        name, value = prediction.split("=", 1)
        for cell in nb.cells:
            cell.source = re.sub(rf"^{name} = None", f"{name} = {value}", cell.source)
    print(*photograph(page(executed(nb, Path.cwd(), allow_errors=True)), chosen.out), sep="\n")


if __name__ == "__main__":
    main(sys.argv[1:])
