"""The script that runs nbgrader's own tests: its judgement, and that the page lists what it lists. The run itself is apart."""

import pytest

from tests.compatibility import nbgrader_own
from tests.compatibility.nbgrader_own import Outcome, table, unexplained

SOME = next(iter(nbgrader_own.REASONS))


@pytest.mark.parametrize(
    ("name", "status", "wrong"),
    [
        ("test_new", "passed", ""),
        ("test_new", "skipped", ""),
        ("test_new", "failed", "no reason is listed: said"),
        (SOME, "failed", ""),
        (SOME, "passed", "its reason is idle"),
    ],
)
def test_failures_need_a_reason_and_reasons_a_failure(name, status, wrong):
    found = unexplained([Outcome(name, status, "said")])
    assert bool(found) == bool(wrong)
    assert not wrong or wrong in found[0]


def test_the_table_counts_and_explains():
    outcomes = [Outcome("a", "passed"), Outcome("b", "passed"), Outcome("c", "skipped"), Outcome(SOME, "failed", "x")]
    text = table(outcomes)
    assert "Of 4 tests 2 pass, 1 differ" in text
    assert "1 are skipped by nbgrader itself (`c`)" in text
    assert f"| `{SOME}` | {nbgrader_own.REASONS[SOME]} |" in text


def test_the_page_gives_every_reason():
    page = nbgrader_own.PAGE.read_text("utf-8")
    written = page.split(nbgrader_own.BEGIN)[1].split(nbgrader_own.END)[0]
    for name, reason in nbgrader_own.REASONS.items():
        assert f"| `{name}` | {reason} |" in written
