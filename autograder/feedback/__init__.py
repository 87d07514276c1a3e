"""Feedback pages: each graded notebook as one HTML file, with the verdict cards, the figures and the comments.

feedback.write(course, "A1")    # feedback/<student>/A1/<notebook>.html, the same files that nbgrader writes
"""

from autograder.feedback.write import pages, sheet, write

__all__ = ["pages", "sheet", "write"]
