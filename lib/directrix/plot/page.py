"""Figures in a static page that needs no network: plotly.js once, the figures as data, and figures.js that draws them.

    html = f"<head>{head()}</head><body>{fragment(figure)}{fragment(another)}</body>"

Figures are drawn when they come near the window and taken away again when they are far, so that a page may hold any number.
Ours are laid out anew for the narrow window of a phone.
"""

from __future__ import annotations

import base64
import functools
import gzip
import html
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

LABEXTENSIONS = Path(__file__).with_name("labextensions")


UNPACK = """
(async () => {
  const packed = Uint8Array.from(atob(document.getElementById("directrix-packed").textContent), c => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  const script = document.createElement("script");
  script.textContent = await new Response(stream).text();
  document.head.append(script);
})();
"""


def head(*, plotly_url: str | None = None) -> str:
    """The scripts of the page, once, for its ``<head>``: plotly.js and figures.js.

    Without ``plotly_url`` both stand in the page itself, packed by gzip to 1.9 MB from 4.8; browsers since 2023 unpack them.
    """
    if plotly_url is None:
        return f'<script type="application/gzip" id="directrix-packed">{_packed()}</script>\n<script>{UNPACK}</script>'
    return f'<script src="{html.escape(plotly_url, quote=True)}" defer></script>\n<script>{_closed(figures_js())}</script>'


def running_scripts() -> tuple[str, ...]:
    """The exact texts of the scripts that run in a page with :func:`head`, for a Content-Security-Policy by hashes."""
    return UNPACK, _both()


def fragment(figure: Mapping[str, Any] | Any) -> str:
    """One figure, as data that no browser executes, with its height kept free and its words for who cannot see it.

    ``figure`` is a plotly Figure or its JSON dict. Whatever strings it holds, they cannot leave the ``<script>`` element.
    """
    plain = figure if isinstance(figure, Mapping) else json.loads(figure.to_json())
    shown = {"data": plain.get("data", []), "layout": plain.get("layout", {}), "frames": plain.get("frames", [])}
    height = shown["layout"].get("height", 450)
    height = min(max(float(height), 100.0), 2000.0) if isinstance(height, int | float) else 450.0
    panels = sum(name in shown["layout"] for name in ("scene", "scene2", "xaxis"))
    wide = " wide" if panels > 1 else ""  # side by side they need room: a page may let them scroll on a narrow screen
    meta = shown["layout"].get("meta")
    alt = html.escape(str(meta.get("alt", "")) if isinstance(meta, Mapping) else "", quote=True)
    # "<" never stands in JSON but inside a string, where its escape means the same.
    data = json.dumps(shown, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
    return (
        f'<div class="directrix-figure{wide}" role="img" aria-label="{alt}" style="min-height:{height:g}px">'
        f'<script type="application/vnd.plotly.v1+json">{data}</script></div>'
    )


def figures_js() -> str:
    """The texts of fitting.js, which lays figures out for a phone, and of figures.js, which links cameras and draws."""
    static = LABEXTENSIONS / "directrix-figures" / "static"
    return "\n".join((static / name).read_text("utf-8") for name in ("fitting.js", "figures.js"))


@functools.cache
def _both() -> str:
    from plotly.offline import get_plotlyjs

    return f"{get_plotlyjs()}\n{figures_js()}"


@functools.cache
def _packed() -> str:
    return base64.b64encode(gzip.compress(_both().encode(), mtime=0)).decode()


def _closed(script: str) -> str:
    return script.replace("</script", "<\\/script")
