"""Runs a notebook source and photographs the page, so that somebody looks at it: ``python tests/course/look.py SOURCE OUT``.

SOURCE is an assignment's folder or a chapter's text; OUT receives ``page.html`` (plotly.js inside, formulas as MathML) and one
PNG a screenful. ``--released`` runs the learner's version with its stubs, ``--predict NAME=VALUE`` types a prediction.
"""

import argparse
import html
import json
import re
import shutil
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import nbclient
from latex2mathml.converter import convert
from nbconvert.filters import ansi2html, markdown2html_mistune
from plotly.offline import get_plotlyjs
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import PythonLexer

STYLE = """
body { font: 15px/1.5 system-ui, 'DejaVu Sans', sans-serif; max-width: 900px; margin: 2em auto; color: #222; }
pre { font: 13px/1.4 'DejaVu Sans Mono', monospace; margin: 0; white-space: pre-wrap; }
.code { background: #f5f5f5; border-left: 3px solid #ccc; padding: 8px 10px; margin: 14px 0 4px; }
.code.fold { color: #999; } .out { padding: 2px 10px; } .error { background: #fdd; }
code { background: #f2f2f2; padding: 0 3px; } table { border-collapse: collapse; } td, th { padding: 3px 10px; }
"""


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
        if cell.cell_type == "code" and (match := re.match(r"(\w+) = None\b", cell.source)):
            found[match[1]] = number
    return found


def typed(nb: Any) -> dict[str, int]:
    """Type something into every guess; returns what was asked."""
    asked = guesses(nb)
    for guess, number in asked.items():
        nb.cells[number].source = re.sub(rf"^{guess} = None", f"{guess} = 'typed'", nb.cells[number].source)
    return asked


def folded(cell: Any) -> bool:
    """Whether the cell's code is folded away."""
    return cell.metadata.get("jupyter", {}).get("source_hidden", False)


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
    body = [_prose(cell.source) if cell.cell_type == "markdown" else _code(cell) for cell in nb.cells]
    colours = HtmlFormatter().get_style_defs(".code")
    return f"<!doctype html><meta charset=utf-8><style>{STYLE}{colours}</style><script>{get_plotlyjs()}</script>{''.join(body)}"


def _prose(text: str) -> str:
    def math(found: re.Match[str]) -> str:
        display = "block" if found[0].startswith("$$") else "inline"
        return convert(found[1] or found[2], display=display)

    return (
        f"<section>{markdown2html_mistune(re.sub(r'[$][$](.+?)[$][$]|[$]([^$]+)[$]', math, text, flags=re.DOTALL))}</section>"
    )


def _code(cell: Any) -> str:
    folded = cell.metadata.get("jupyter", {}).get("source_hidden")
    source = "▸ folded cell" if folded else highlight(cell.source, PythonLexer(), HtmlFormatter(nowrap=True))
    return f"<div class='code{' fold' if folded else ''}'><pre>{source}</pre></div>" + "".join(map(_output, cell.outputs))


def _output(output: Any) -> str:
    if output.output_type == "stream":
        return f"<div class=out><pre>{html.escape(output.text)}</pre></div>"
    if output.output_type == "error":
        return f"<div class='out error'><pre>{ansi2html(chr(10).join(output.traceback))}</pre></div>"
    data = output.data
    if "application/vnd.plotly.v1+json" in data:
        figure = json.dumps(data["application/vnd.plotly.v1+json"]).replace("</", "<\\/")
        return f"<div class=out><div class=fig></div><script type=application/json class=figure>{figure}</script></div>"
    return f"<div class=out>{data.get('text/html') or '<pre>' + html.escape(data.get('text/plain', '')) + '</pre>'}</div>"


# Few scenes at a time, as a browser keeps 16 WebGL contexts: each figure becomes a picture once it is drawn.
DRAW = """async () => {
  for (const data of document.querySelectorAll('script.figure')) {
    const place = data.previousElementSibling, figure = JSON.parse(data.textContent);
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
