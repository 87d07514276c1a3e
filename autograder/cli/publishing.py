"""``directrix site``: the walkthroughs as pages for a reader without JupyterLab."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from autograder.cli.options import AsJson, console_for


def site(
    out: Annotated[Path, typer.Option(help="The folder of the site; an earlier site there is replaced.")] = Path("site"),
    chapters: Annotated[
        Path | None,
        typer.Option(help="A folder with chapters of your own (NN-its-question.py).", show_default="those of directrix"),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Build the walkthroughs as a static site: pages with formulas, figures to turn, and guesses whose answers wait.

    Every chapter is executed once. The pages need no server and no network: open index.html, or put the folder anywhere.

    Example: directrix site --out site
    """
    from autograder import site as sites

    console = console_for(as_json)
    with console.status("") as status:
        built = sites.build(out, chapters, progress=lambda title: status.update(f"running: {title}"))
    for one in built.chapters:
        counts = [
            _counted(one.figures, "figure"),
            _counted(one.guesses, "guess", "guesses"),
            _counted(one.solutions, "solution"),
        ]
        console.print(f"{one.page}: {one.title} ({', '.join(counts)})", highlight=False, markup=False)
    if not any(one.solutions for one in built.chapters):
        console.print(
            "No chapter has a solution to show. An installed package brings the chapters without theirs; a checkout has them.",
            highlight=False, markup=False,
        )  # fmt: skip
    console.print(f"Open {built.folder / 'index.html'} in a browser", highlight=False, markup=False, soft_wrap=True)
    if as_json:
        print(json.dumps(built.to_dict()))


def _counted(count: int, one: str, more: str = "") -> str:
    return f"{count} {one if count == 1 else more or f'{one}s'}"
