"""The one line in ``nbgrader_config.py``: nbgrader's own commands grade through the sandbox and the judge.

    from autograder import bridge
    bridge.configure(c)

``nbgrader autograde``, formgrader, ``nbgrader generate_feedback``, late policies and the exchange keep working. This module
names classes only; nbgrader imports them when it needs them, and ``directrix grade`` never does.
"""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

from autograder.bridge import serving

SANITIZE = (
    "autograder.bridge.preprocessors.Rebuild",  # for ClearOutput, DeduplicateIds, OverwriteKernelspec and OverwriteCells
    "nbgrader.preprocessors.CheckCellMetadata",
)
AUTOGRADE = (
    "autograder.bridge.preprocessors.Execute",
    "nbgrader.preprocessors.IgnorePattern",
    "nbconvert.preprocessors.ClearMetadataPreprocessor",
    "autograder.bridge.preprocessors.LimitOutput",
    "autograder.bridge.preprocessors.SaveAutoGrades",
    "nbgrader.preprocessors.AssignLatePenalties",
    "nbgrader.preprocessors.CheckCellMetadata",
)
GENERATE = (
    "autograder.bridge.release.CheckExercises",
    "autograder.bridge.release.WriteCourse",
    *(
        f"nbgrader.preprocessors.{name}"
        for name in (
            "IncludeHeaderFooter", "InstantiateTests", "LockCells", "ClearSolutions", "ClearOutput", "CheckCellMetadata",
            "ComputeChecksums", "SaveCells", "ClearHiddenTests", "ClearMarkScheme", "ComputeChecksums", "CheckCellMetadata",
        )
    ),
)  # fmt: skip
TEMPLATES = Path(__file__).with_name("templates")


def configure(c: Any) -> None:
    """Set what an nbgrader course needs to be graded by Directrix; everything else in ``c`` stays as the course has it."""
    c.GenerateAssignment.preprocessors = list(GENERATE)
    c.Autograde.exporter_class = "autograder.bridge.submitted.Submitted"
    c.Autograde.sanitize_preprocessors = list(SANITIZE)
    c.Autograde.autograde_preprocessors = list(AUTOGRADE)
    c.GenerateFeedback.exporter_class = "autograder.bridge.pages.Feedback"
    c.GenerateFeedback.preprocessors = []
    pages_of_formgrader(c)
    serving.guard(pages_of_formgrader)


def pages_of_formgrader(c: Any) -> None:
    """Set how formgrader shows a notebook."""
    c.HTMLExporter.preprocessors = ["autograder.bridge.pages.Harmless"]
    c.HTMLExporter.filters = {"markdown2html": "autograder.bridge.pages.markdown2html"}
    c.HTMLExporter.extra_template_basedirs = [str(TEMPLATES), *_nbgrader_templates()]


def _nbgrader_templates() -> list[str]:
    """Where nbgrader keeps formgrader's templates, found without importing it."""
    found = importlib.util.find_spec("nbgrader")
    places = found.submodule_search_locations if found is not None else None
    return [str(Path(place, "server_extensions", "formgrader", "templates")) for place in places or ()]
