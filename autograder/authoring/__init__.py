"""For whoever makes a course: its folder, its exercises, and the rules that they keep.

courses    a course folder, its released assignments, a reader's workbook
template   a new exercise, ready to be changed
sampling   answers of references and mistakes, and how far two are apart
rules      what every exercise must keep
survey     which data set sees which mistake, and what each mistake earns
"""

from autograder.authoring.courses import new_course, points_in, release, remove_course, unknown_to_learners, workbook
from autograder.authoring.rules import Breach, breaches
from autograder.authoring.survey import Seen, survey, table
from autograder.authoring.template import new_exercise

__all__ = [
    "Breach",
    "Seen",
    "breaches",
    "new_course",
    "new_exercise",
    "points_in",
    "release",
    "remove_course",
    "survey",
    "table",
    "unknown_to_learners",
    "workbook",
]
