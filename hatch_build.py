"""Ships the assignments and the course in the wheel, with every solution taken out of the notebook sources."""

import re
import tempfile
from pathlib import Path

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

SHIPPED = "autograder/shipped"
# In a notebook source a written answer is a comment, so its region begins with "# ".
SOLUTION = re.compile(r"^((?:# )?[ \t]*)### BEGIN SOLUTION\n.*?^(?:# )?[ \t]*### END SOLUTION$", re.DOTALL | re.MULTILINE)


def without_solutions(text: str) -> str:
    """The notebook source with a learner's stub in each marked region; the markers stay, for nbgrader wants them."""

    def stub(region: re.Match[str]) -> str:
        lead = region[1]
        rows = ["YOUR ANSWER HERE"] if lead.startswith("#") else ["# YOUR CODE HERE", "raise NotImplementedError()"]
        return "\n".join(lead + row for row in ("### BEGIN SOLUTION", *rows, "### END SOLUTION"))

    return SOLUTION.sub(stub, text)


class ShipCourse(BuildHookInterface):
    """Adds ``assignments/`` and ``course/`` under ``autograder/shipped`` of a built (not an editable) wheel."""

    def initialize(self, version: str, build_data: dict) -> None:
        """Copy the sources, strip the solutions, and register the copies with the wheel."""
        if self.target_name != "wheel" or version == "editable":
            return
        root = Path(self.root)
        self.copies = tempfile.TemporaryDirectory()
        for room in ("assignments", "course"):
            for path in sorted((root / room).rglob("*")):
                if not path.is_file() or path.suffix not in {".py", ".md", ".json", ".csv"} or "__pycache__" in path.parts:
                    continue
                place = path.relative_to(root)
                copy = Path(self.copies.name) / place
                copy.parent.mkdir(parents=True, exist_ok=True)
                copy.write_text(without_solutions(path.read_text("utf-8")), "utf-8")
                build_data["force_include"][str(copy)] = f"{SHIPPED}/{place.as_posix()}"

    def finalize(self, version: str, build_data: dict, artifact_path: str) -> None:
        """Remove the copies."""
        if hasattr(self, "copies"):
            self.copies.cleanup()
