"""Grades whole classes: a course, its submissions, one report."""

from autograder.course import Course
from autograder.fleet.grade import grade
from autograder.fleet.result import CellReport, GradeReport, StudentReport
from autograder.fleet.standing import standing

__all__ = ["CellReport", "Course", "GradeReport", "StudentReport", "grade", "standing"]
