"""What the front page shows of the library, run."""

import doctest
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_the_lines_of_the_library_run():
    """Every line that begins with >>> gives what stands below it."""
    result = doctest.testfile(str(ROOT / "README.md"), module_relative=False)
    assert result.attempted >= 11
    assert result.failed == 0


def test_links_lead_somewhere():
    """Each relative link of the front page is a file here."""
    import re

    links = re.findall(r"\]\((?!https?:)([^)#]+)\)", (ROOT / "README.md").read_text("utf-8"))
    assert len(links) >= 4
    assert [link for link in links if not (ROOT / link).exists()] == []
