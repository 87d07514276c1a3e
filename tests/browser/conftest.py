"""JupyterLab in headless Chromium: one browser for all tests, one server for a folder."""

import os
import socket
import subprocess
import sys
import time
import urllib.request
from contextlib import contextmanager
from pathlib import Path

import pytest

CONFIG = """
from jupyterlab.handlers.announcements import NeverCheckForUpdate

c.LabApp.news_url = None
c.LabApp.check_for_updates_class = NeverCheckForUpdate
"""


@pytest.fixture
def offline_page(browser):
    """A page that reaches this machine only; `page.strays` lists what it tried beyond."""
    page = browser.new_page(viewport={"width": 1500, "height": 1300})
    page.strays = []

    def gate(route):
        url = route.request.url
        if url.startswith(("http://127.0.0.1", "http://localhost", "file:", "data:", "blob:")):
            route.continue_()
        else:
            page.strays.append(url)
            route.abort()

    page.route("**/*", gate)
    yield page
    page.close()


@contextmanager
def jupyterlab(folder: Path, home: Path):
    """A JupyterLab server on a folder; gives its address and ends with the block."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    (home / "config").mkdir(parents=True, exist_ok=True)
    (home / "config" / "jupyter_lab_config.py").write_text(CONFIG)
    command = [
        sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root",
        f"--ServerApp.port={port}", "--ServerApp.port_retries=0",
        "--IdentityProvider.token=", "--ServerApp.password=", "--LabApp.expose_app_in_browser=True",
        f"--LabServerApp.workspaces_dir={home / 'workspaces'}", f"--LabServerApp.user_settings_dir={home / 'settings'}",
    ]  # fmt: skip
    environment = {
        **os.environ,
        "HOME": str(home),
        "JUPYTER_CONFIG_DIR": str(home / "config"),
        "JUPYTER_RUNTIME_DIR": str(home / "runtime"),
        "IPYTHONDIR": str(home / "ipython"),
    }
    environment.pop("NBGRADER_EXECUTION", None)
    with (home / "server.log").open("w") as log:
        server = subprocess.Popen(command, cwd=folder, env=environment, stdout=log, stderr=subprocess.STDOUT)
    address = f"http://127.0.0.1:{port}"
    try:
        for _ in range(240):
            try:
                urllib.request.urlopen(f"{address}/api/status", timeout=1).close()
                break
            except OSError:
                assert server.poll() is None, (home / "server.log").read_text()[-3000:]
                time.sleep(0.25)
        else:
            raise AssertionError("JupyterLab did not answer within a minute:\n" + (home / "server.log").read_text()[-3000:])
        yield address
    finally:
        server.terminate()
        try:
            server.wait(20)
        except subprocess.TimeoutExpired:
            server.kill()
            server.wait()
