"""What all tests share: Chromium, one Hypothesis profile, and that nothing is skipped where the project's gate runs."""

import os
import shutil

import pytest
from hypothesis import settings

# The same examples every time, so that a failure is a failure for everyone; no deadline, since machines are shared.
settings.register_profile("fixed", derandomize=True, deadline=None, max_examples=40, database=None)
settings.load_profile("fixed")

FLAGS = [
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
CHROMIUM = next((path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))), None)


@pytest.fixture(scope="session")
def chromium():
    """Path of a Chromium. Without one a browser test is skipped on a developer's machine, and fails in CI."""
    if CHROMIUM is None:
        pytest.skip("no Chromium found: install the package `chromium` to run the browser tests")
    return CHROMIUM


@pytest.fixture(scope="module")
def browser(chromium):
    """A running Chromium. For one module: while Playwright runs, nothing else of the process may use asyncio."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=chromium, args=FLAGS)
        yield running
        running.close()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    """In CI a skipped test is a failed one: CI installs what tests need."""
    report = yield
    if report.skipped and os.environ.get("CI") and not hasattr(report, "wasxfail"):
        report.outcome = "failed"
        report.longrepr = f"skipped in CI, where nothing may be: {report.longrepr}"
    return report
