"""Drives a notebook in JupyterLab as a student does: by keyboard and mouse, with cells named by their grade id."""

import json
import os
import re
from pathlib import Path

from tests.browser.conftest import jupyterlab


def keep(picture: bytes, name: str) -> bytes:
    """The picture again; a copy of it goes to $DIRECTRIX_SHOTS, where people look at it."""
    if folder := os.environ.get("DIRECTRIX_SHOTS"):
        (Path(folder) / f"{re.sub('[^a-z0-9-]', '_', name)}.png").write_bytes(picture)
    return picture


class Lab:
    """JupyterLab on a folder, in a page; ``with Lab(...)`` starts and ends the server."""

    def __init__(self, folder: Path, home: Path, page) -> None:
        self.folder, self.home, self.page = folder, home, page
        self.server = jupyterlab(folder, home)

    def __enter__(self) -> "Lab":
        self.address = self.server.__enter__()
        self.page.goto(f"{self.address}/lab")
        self.page.wait_for_function("() => window.jupyterapp?.commands.hasCommand('docmanager:open')", timeout=90_000)
        self.page.evaluate("() => window.jupyterapp.restored.then(() => null)")
        return self

    def __exit__(self, *details) -> None:
        if details[0] is not None:
            self.page.screenshot(path=str(self.home / "failed.png"))
        self.server.__exit__(*details)

    def open(self, path: str) -> None:
        """Open a notebook and wait for its kernel."""
        self.grade_ids = [
            cell["metadata"].get("nbgrader", {}).get("grade_id")
            for cell in json.loads((self.folder / path).read_text())["cells"]
        ]
        self.cells = json.loads((self.folder / path).read_text())["cells"]
        self.page.evaluate("path => window.jupyterapp.commands.execute('docmanager:open', {path, factory: 'Notebook'})", path)
        self.page.wait_for_selector(".jp-NotebookPanel:not(.lm-mod-hidden) .jp-Notebook .jp-Cell", timeout=60_000)
        self.page.evaluate("() => window.jupyterapp.commands.execute('filebrowser:hide-main').catch(() => null)")
        self.page.wait_for_function(
            "() => window.jupyterapp.shell.currentWidget.sessionContext?.session?.kernel?.status === 'idle'", timeout=90_000
        )

    def index(self, grade_id: str) -> int:
        """Position of the cell of that grade id."""
        return self.grade_ids.index(grade_id)

    def run(self, grade_id: str) -> None:
        """Select a cell, press Shift+Enter, and wait until the kernel is done."""
        self._select(self.index(grade_id))
        self.page.keyboard.press("Escape")
        self.page.keyboard.press("Shift+Enter")
        self._idle()

    def run_all_before(self, grade_id: str) -> None:
        """Run every cell above, as the menu entry does."""
        self._select(self.index(grade_id))
        self.page.evaluate("() => window.jupyterapp.commands.execute('notebook:run-all-above')")
        self._idle()

    def type_into(self, grade_id: str, text: str) -> None:
        """Click into a cell, select all, and type the text over it."""
        self._select(self.index(grade_id))
        editor = self._cell(self.index(grade_id)).locator(".cm-content")
        editor.click()
        self.page.keyboard.press("Control+a")
        self.page.keyboard.press("Delete")
        self.page.keyboard.insert_text(text)
        typed = self.page.evaluate(
            "i => window.jupyterapp.shell.currentWidget.content.widgets[i].model.sharedModel.getSource()", self.index(grade_id)
        )
        assert typed == text, typed

    def output(self, grade_id: str):
        """The output area of a cell, scrolled into view."""
        area = self._cell(self.index(grade_id)).locator(".jp-Cell-outputWrapper")
        area.wait_for(timeout=30_000)
        area.scroll_into_view_if_needed()
        return area

    def canvas(self, grade_id: str):
        """The drawn 3-D figure of a cell's output."""
        plot = self._cell(self.index(grade_id)).locator(".js-plotly-plot").first
        plot.wait_for(timeout=60_000)
        plot.locator("canvas").first.wait_for(timeout=60_000)
        plot.scroll_into_view_if_needed()
        self.page.wait_for_timeout(3000)  # the software renderer draws after the canvas is there
        return plot

    def drag_and_read_cameras(self, plot) -> dict[str, bool]:
        """Turn the left scene of a comparison with the mouse; say whether it moved and whether the right one followed."""
        read = "plot => [plot._fullLayout.scene.camera.eye, plot._fullLayout.scene2.camera.eye].map(e => [e.x, e.y, e.z])"
        before = plot.evaluate(read)
        box = plot.bounding_box()
        x, y = box["x"] + box["width"] * 0.25, box["y"] + box["height"] * 0.5
        self.page.mouse.move(x, y)
        self.page.mouse.down()
        self.page.mouse.move(x + 90, y + 25, steps=6)
        self.page.mouse.up()
        self.page.wait_for_timeout(2000)
        after = plot.evaluate(read)
        moved = max(abs(a - b) for a, b in zip(before[0], after[0], strict=True)) > 0.05
        linked = max(abs(a - b) for a, b in zip(after[0], after[1], strict=True)) < 1e-6
        return {"moved": moved, "linked": linked}

    def wait_for_text(self, grade_id: str, text: str) -> None:
        """Wait until a cell's output shows a text."""
        self._cell(self.index(grade_id)).locator(".jp-Cell-outputWrapper").get_by_text(text, exact=True).first.wait_for(
            timeout=30_000
        )

    def points_of(self, grade_id: str) -> str:
        """The points of a graded cell as a notebook shows them."""
        return str(float(self.cells[self.index(grade_id)]["metadata"]["nbgrader"]["points"]))

    def shot(self, element, name: str) -> bytes:
        """A screenshot of an element; kept in $DIRECTRIX_SHOTS for people to look at."""
        return keep(element.screenshot(), name)

    def _cell(self, index: int):
        return self.page.locator(f".jp-NotebookPanel:not(.lm-mod-hidden) .jp-Cell[data-windowed-list-index='{index}']")

    def _select(self, index: int) -> None:
        self.page.evaluate(
            """async i => {
                const notebook = window.jupyterapp.shell.currentWidget.content;
                notebook.activeCellIndex = i; notebook.deselectAll();
                await notebook.scrollToItem(i, 'center');
            }""",
            index,
        )
        self._cell(index).wait_for(timeout=30_000)

    def _idle(self) -> None:
        self.page.wait_for_timeout(300)
        self.page.wait_for_function(
            """() => {
                const panel = window.jupyterapp.shell.currentWidget;
                const busy = cell => cell.model.type === 'code' && cell.model.executionState === 'running';
                return panel.sessionContext.session.kernel.status === 'idle' && !panel.content.widgets.some(busy);
            }""",
            timeout=120_000,
        )
