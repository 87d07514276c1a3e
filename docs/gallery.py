"""The gallery: every form of the library once, as PNG, as contact sheets and as one page that turns in a browser.

    python docs/gallery.py                       into docs/_build/gallery
    python docs/gallery.py --to FOLDER torus     only pictures with "torus" in their title

Draws with headless Chromium, the same figures as a notebook shows: `directrix.plot.view`, with the options of `pictures.py`.
"""

from __future__ import annotations

import argparse
import html
import os
import shutil
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import groupby
from pathlib import Path
from typing import Any

from directrix.plot import page
from playwright.sync_api import sync_playwright

sys.path.insert(0, str(Path(__file__).parent))
from pictures import Picture, pictures

HERE = Path(__file__).parent
WIDE = 720  # of a picture; as in a notebook
SETTLE = 350  # milliseconds from the first drawing to the last
STYLE = """
body { margin: 0; background: white; color: #333; font: 15px system-ui, sans-serif }
h1 { font-size: 22px; margin: 20px 12px 4px } h2 { font-size: 18px; margin: 20px 12px 4px }
figure { margin: 0; width: 720px } figcaption { padding: 6px 12px; font-weight: 600 }
.sheet { display: grid; grid-template-columns: repeat(4, 400px) } .sheet figure { width: 400px } .sheet img { width: 400px }
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """The command: 0 if all pictures were made."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*", help="only pictures that have one of these words in their title or group")
    parser.add_argument("--to", type=Path, default=HERE / "_build" / "gallery", help="the folder to write into")
    asked = parser.parse_args(arguments)
    chosen = [one for one in pictures() if fits(one, asked.words)]
    if not chosen:
        parser.error(f"no picture has {' or '.join(asked.words)} in its title")
    for path in make(chosen, asked.to):
        print(path)
    return 0


def fits(picture: Picture, words: Sequence[str]) -> bool:
    """Whether a picture was asked for: no words ask for all."""
    told = f"{picture.group} {picture.title}".lower()
    return not words or any(word.lower() in told for word in words)


def make(chosen: Sequence[Picture], folder: Path) -> Iterator[Path]:
    """The page, its pictures and a contact sheet a group; the path of each as soon as it is there."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "index.html").write_text(document(chosen), "utf-8")
    yield folder / "index.html"
    with chromium() as browser:
        yield from photographed(browser, chosen, folder)
        for group, members in groupby(chosen, key=lambda one: one.group):
            yield contact_sheet(browser, group, list(members), folder)


def document(chosen: Sequence[Picture]) -> str:
    """One page of its own with all figures, which needs no network."""
    parts = []
    for group, members in groupby(chosen, key=lambda one: one.group):
        parts.append(f"<h2>{html.escape(group)}</h2>")
        parts += [
            f'<figure id="{one.slug}"><figcaption>{html.escape(one.title)}</figcaption>{page.fragment(one.figure())}</figure>'
            for one in members
        ]
    return _html("Every form once", page.head(), "\n".join(parts))


def photographed(browser: Any, chosen: Sequence[Picture], folder: Path) -> Iterator[Path]:
    """A PNG of each figure of the page, taken when it has come into view and is drawn."""
    window = browser.new_page(viewport={"width": WIDE, "height": 700})
    troubles: list[str] = []
    window.on("pageerror", lambda error: troubles.append(str(error)))
    window.goto((folder / "index.html").as_uri())
    for one in chosen:
        figure = window.locator(f"#{one.slug} .directrix-figure")
        figure.scroll_into_view_if_needed()
        window.wait_for_selector(f"#{one.slug} .gl-container canvas", timeout=60_000)
        window.wait_for_timeout(SETTLE)
        path = folder / f"{one.slug}.png"
        figure.screenshot(path=path)
        if troubles:
            raise RuntimeError(f"{one.title}: {troubles[0]}")
        yield path
    window.close()


def contact_sheet(browser: Any, group: str, members: Sequence[Picture], folder: Path) -> Path:
    """The pictures of one group on one sheet."""
    cells = "".join(
        f'<figure><img src="{one.slug}.png"><figcaption>{html.escape(one.title)}</figcaption></figure>' for one in members
    )
    name = f"sheet-{group.lower().replace(' ', '-')}"
    source = folder / f"{name}.html"
    source.write_text(_html(group, "", f'<div class="sheet">{cells}</div>'), "utf-8")
    window = browser.new_page(viewport={"width": 400 * min(len(members), 4), "height": 300})
    window.goto(source.as_uri())
    window.screenshot(path=folder / f"{name}.png", full_page=True)
    window.close()
    return folder / f"{name}.png"


def _html(title: str, head: str, body: str) -> str:
    title = html.escape(title)
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{title}</title><style>{STYLE}</style>{head}</head>'
        f"<body><h1>{title}</h1>{body}</body></html>"
    )


@contextmanager
def chromium() -> Iterator[Any]:
    """A headless Chromium; as root it cannot have its own sandbox."""
    names = ("chromium", "chromium-browser", "google-chrome")
    path = next((found for name in names if (found := shutil.which(name))), None)
    if path is None:
        raise SystemExit("no Chromium found: install the package `chromium`.")
    root = hasattr(os, "geteuid") and os.geteuid() == 0
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"] if root else [])
        yield browser
        browser.close()


if __name__ == "__main__":
    raise SystemExit(main())
