"""nbgrader's own tests, from its wheel, with our Execute and preprocessors in the place of theirs.

    python -m tests.compatibility.nbgrader_own [--quick] [--write] [-n 2]

Prints how many pass and each that does not with its reason. A failure without a reason is an error, and so is a reason without
a failure. ``--write`` puts the counts and the table into docs/nbgrader.md; ``--quick`` runs what takes a minute.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "nbgrader.md"
BEGIN, END = "<!-- own: begin -->\n", "<!-- own: end -->"
AUTOGRADE = "nbgrader.tests.apps.test_nbgrader_autograde"
PREPROCESSORS = tuple(
    f"nbgrader.tests.preprocessors.test_{name}"
    for name in (
        "saveautogrades", "overwritecells", "overwritekernelspec", "deduplicateids", "limitoutput", "ignorepattern",
        "checkcellmetadata",
    )
)  # fmt: skip
QUICK = ("test_grade", "test_handle_failure", "test_showtraceback_exploit")
UNKNOWN = "a cell with a name that the assignment does not have is an ordinary cell: the submission is graded, not dropped"
NO_KEY = "the other copies have no `nbgrader` entry at all; an empty one makes nbgrader 0.9 stop the run for the whole class"
REASONS = {
    "test_handle_failure": UNKNOWN,
    "test_handle_failure_single_notebook": UNKNOWN,
    "test_no_execute": "outputs that came with the submission are not kept under graded cells: they may be forged",
    "test_autograde_timeout": "`Execute.timeout` is CPU time, and a cell that sleeps uses none; the clock's limit is longer",
    "test_nonexistent_grade_id": "an ordinary cell has no `nbgrader` entry at all; the test looks into an empty one",
    "test_duplicate_grade_cell": NO_KEY,
    "test_duplicate_solution_cell": NO_KEY,
    "test_duplicate_locked_cell": NO_KEY,
}


@dataclass(frozen=True)
class Outcome:
    """One test: "passed", "failed" or "skipped", and what it said."""

    name: str
    status: str
    said: str = ""


def run(*, quick: bool = False, workers: int = 0) -> list[Outcome]:
    """Run them in a process of their own, outside this checkout."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "pytest.ini").write_text("[pytest]\n")
        command = [sys.executable, "-m", "pytest", "-q", "-p", "tests.compatibility.own_plugin", "-p", "no:cacheprovider"]
        command += ["-c", f"{folder}/pytest.ini", "--rootdir", folder, "--junitxml", f"{folder}/report.xml", "-n", str(workers)]
        command += ["--pyargs", *PREPROCESSORS]
        command += [f"{AUTOGRADE}::TestNbGraderAutograde::{name}" for name in QUICK] if quick else [AUTOGRADE]
        environment = {name: value for name, value in os.environ.items() if not name.startswith(("PYTEST_", "NBGRADER_"))}
        environment["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
        environment["PYTHONPATH"] = f"{ROOT}{os.pathsep}{ROOT / 'lib'}"
        environment["PYTHONDONTWRITEBYTECODE"] = "1"
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
        report = Path(folder) / "report.xml"
        if done.returncode not in (0, 1) or not report.is_file():
            raise RuntimeError(f"nbgrader's tests could not be run:\n{done.stdout[-3000:]}{done.stderr[-3000:]}")
        return [_outcome(case) for case in ElementTree.parse(report).iter("testcase")]


def _outcome(case: ElementTree.Element) -> Outcome:
    for child in case:
        if child.tag in ("failure", "error", "skipped"):
            status = "skipped" if child.tag == "skipped" else "failed"
            return Outcome(case.attrib["name"], status, child.attrib.get("message", "")[:300])
    return Outcome(case.attrib["name"], "passed")


def unexplained(outcomes: list[Outcome]) -> list[str]:
    """Failures without a reason, and reasons without a failure."""
    wrong = [
        f"{one.name} failed, and no reason is listed: {one.said}"
        for one in outcomes
        if one.status == "failed" and one.name not in REASONS
    ]
    wrong += [
        f"{one.name} passed; its reason is idle: {REASONS[one.name]}"
        for one in outcomes
        if one.status == "passed" and one.name in REASONS
    ]
    return wrong


def table(outcomes: list[Outcome]) -> str:
    """What the page says: counts, and each difference with its reason."""
    count = {status: sum(one.status == status for one in outcomes) for status in ("passed", "failed", "skipped")}
    skipped = ", ".join(f"`{one.name}`" for one in outcomes if one.status == "skipped")
    lines = [
        f"Of {len(outcomes)} tests {count['passed']} pass, {count['failed']} differ for the reasons below, and "
        f"{count['skipped']} are skipped by nbgrader itself{f' ({skipped})' if skipped else ''}.",
        "", "| test | why it differs |", "|---|---|",
    ]  # fmt: skip
    lines += [f"| `{one.name}` | {REASONS.get(one.name, '?')} |" for one in outcomes if one.status == "failed"]
    return "\n".join(lines) + "\n"


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="the preprocessors and a few of the autograde tests")
    parser.add_argument("--write", action="store_true", help="put the table into docs/nbgrader.md")
    parser.add_argument("-n", type=int, default=0, help="processes at once")
    options = parser.parse_args(arguments)
    if options.quick and options.write:
        parser.error("--write needs the whole run, not --quick")
    outcomes = run(quick=options.quick, workers=options.n)
    print(table(outcomes))
    wrong = unexplained(outcomes)
    print("\n".join(wrong), end="\n" if wrong else "")
    if options.write and not wrong:
        before, _, rest = PAGE.read_text("utf-8").partition(BEGIN)
        _, _, after = rest.partition(END)
        PAGE.write_text(f"{before}{BEGIN}{table(outcomes)}{END}{after}", "utf-8")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
