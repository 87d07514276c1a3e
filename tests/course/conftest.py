"""Notebooks executed by a real kernel, each once per session."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))
from look import executed


@pytest.fixture(scope="session")
def run(tmp_path_factory):
    """run(nb): the notebook with its outputs; every error stays in the cell that raised it."""
    return lambda nb: executed(nb, tmp_path_factory.mktemp("notebook"), allow_errors=True)
