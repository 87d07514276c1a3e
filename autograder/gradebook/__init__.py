"""nbgrader's gradebook, written without nbgrader: the same tables, a class in one transaction.

Importing ``nbgrader.api`` costs three seconds and its calls 12 ms a submission; these statements cost a tenth of a millisecond.
``Gradebook`` brings SQLAlchemy along, the values that go in and out do not: it is loaded when it is first named.
"""

from typing import TYPE_CHECKING, Any

from autograder.gradebook.records import AssignmentRow, NotebookMarks, NotebookRow, Penalty, Record, Standing

if TYPE_CHECKING:
    from autograder.gradebook.book import Gradebook

__all__ = ["AssignmentRow", "Gradebook", "NotebookMarks", "NotebookRow", "Penalty", "Record", "Standing"]


def __getattr__(name: str) -> Any:
    if name == "Gradebook":
        from autograder.gradebook.book import Gradebook

        return Gradebook
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
