"""Which pairs of students share what few others have: a report to read, never a mark.

    report = integrity.similar(course, "A1", top=20)
    console.print(table(report))      # or report.to_dict(), or page(report)

``tokens`` (what a source says) -> ``fingerprints`` (winnowing) -> ``compare`` (rare ones in pairs) -> ``runs`` (where). How to
read it fairly: docs/integrity.md.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from autograder.course import Course
from autograder.integrity.compare import SMALL_CLASS, THRESHOLD, Likenesses, Pair, Share, compare
from autograder.integrity.runs import Place, Run, common_runs
from autograder.integrity.work import Class, Part, read

__all__ = [
    "SMALL_CLASS",
    "THRESHOLD",
    "Class",
    "Likenesses",
    "Pair",
    "Part",
    "Report",
    "Run",
    "compare",
    "report_on",
    "similar",
]


@dataclass(frozen=True)
class Report:
    """The pairs most alike, by falling likeness, each with its common runs; what could not be read."""

    assignment: str
    found: Likenesses
    runs: tuple[tuple[Run, ...], ...]
    notes: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        return {
            "assignment": self.assignment,
            "students": self.found.students,
            "linked_pairs": self.found.linked,
            "threshold": THRESHOLD,
            "pairs": [_pair(pair, runs) for pair, runs in zip(self.found.pairs, self.runs, strict=True)],
            "notes": list(self.notes),
        }


def similar(course: Course, assignment: str, *, top: int = 20) -> Report:
    """The report on an assignment's submissions as they were handed in. Reads only.

    Raises
    ------
    CourseError
        If nothing was handed out or nobody has handed in.
    """
    return report_on(read(course, assignment), assignment, top=top)


def report_on(work: Class, assignment: str, *, top: int = 20) -> Report:
    """The report on work that was read."""
    found = compare(work, top=top)
    runs = tuple(
        tuple(common_runs(work.parts[pair.students[0]], work.parts[pair.students[1]], found.weights)) for pair in found.pairs
    )
    return Report(assignment, found, runs, tuple(work.notes))


def _pair(pair: Pair, runs: tuple[Run, ...]) -> dict[str, Any]:
    return {
        "students": list(pair.students),
        "likeness": round(pair.likeness, 4),
        "striking": pair.likeness >= THRESHOLD,
        "whole": _share(pair.whole),
        "exercises": {name: _share(share) for name, share in pair.exercises.items()},
        "runs": [
            {"tokens": run.length, "bits": round(run.bits, 1), "first": _place(run.first), "second": _place(run.second)}
            for run in runs
        ],
    }


def _share(share: Share) -> dict[str, Any]:
    bits = round(share.bits, 1)
    return {"likeness": round(share.likeness, 4), "shared": share.shared, "of": list(share.of), "bits": bits}


def _place(place: Place) -> dict[str, Any]:
    part = place.part
    return {"notebook": part.notebook, "exercise": part.exercise, "cell": part.cell, "lines": [place.begin, place.end]}
