"""docs/speed.md speaks of the targets that the benchmark computes, and of no others. Nothing is timed here."""

import importlib.util
import re
from collections import defaultdict
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "speed.md").read_text("utf-8")
ROWS = re.findall(r"^\| (.+?) \| (.+?) \| (met|behind) \|$", PAGE, re.MULTILINE)
WORDS = {3: "three", 11: "eleven", 14: "fourteen"}


@pytest.fixture
def benchmark(monkeypatch):
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "1")  # it sets this itself where nobody did
    spec = importlib.util.spec_from_file_location("benchmark_of_surfaces", ROOT / "benchmarks" / "surfaces.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class EveryPeer(defaultdict):
    """Times of a case in which every peer is installed."""

    def __contains__(self, name):
        return True


def test_the_page_names_every_target_in_the_words_of_the_script(benchmark):
    """One row each, in the same order."""
    cases = [EveryPeer(lambda: 1.0) for _ in range(8)]
    asked = benchmark.targets(cases, defaultdict(lambda: 1.0), defaultdict(lambda: 1.0))
    assert [text for text, _ in asked] == [name for name, _, _ in ROWS]


def test_the_verdicts_of_the_page_are_counted_rightly_and_each_target_behind_has_its_reason():
    """What the table calls behind, the section below it speaks of, with the same numbers."""
    behind = [(name, measured) for name, measured, verdict in ROWS if verdict == "behind"]
    counted = f"{WORDS[len(ROWS) - len(behind)]} were met, {WORDS[len(behind)]} were behind"
    assert f"{WORDS[len(ROWS)].capitalize()} targets, in the order and the words of the script: {counted}" in PAGE
    reasons = PAGE.partition("## Where we are behind")[2].partition("## Tried")[0]
    for _, measured in behind:
        low, high = re.findall(r"[\d.]+x", measured)
        assert f"{low} to {high}" in reasons


def test_a_row_is_called_met_only_where_its_numbers_are_within_what_its_words_allow():
    """For the rows whose target and measurement both are factors."""
    compared = 0
    for name, measured, verdict in ROWS:
        wanted, found = re.search(r"([\d.]+)x", name), [float(x) for x in re.findall(r"([\d.]+)x", measured)]
        if wanted and found:
            limit = float(wanted[1])
            holds = max(found) <= limit if "within" in name else min(found) >= limit
            assert verdict == ("met" if holds else "behind"), name
            compared += 1
    assert compared == 5
