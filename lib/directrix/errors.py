"""The errors of the library: every one is a ``ValueError`` that says what must hold, what came and what to try.

ValueError
└── GeometryError
    ├── ShapeError        an array has the wrong shape, or does not hold real numbers
    ├── NumberError       a number or point is out of its range: NaN, a radius of 0, a negative height
    │   └── WeightError   a weight that is not positive
    ├── DomainError       a parameter outside [0, 1], or NaN
    ├── OrderError        an order, a degree, a count of points or the order of a derivative that cannot be
    ├── KnotError         a knot vector that decreases, is too short, or repeats a knot too often
    ├── CurveError        a curve handed in is no vectorised callable u -> (..., 3)
    ├── DegenerateError   a zero direction, three points on one line, a frame that does not exist
    ├── CornerError       boundary curves that do not meet at their corners
    ├── ConversionError   the form asked for cannot hold this one exactly
    └── FrozenError       an attempt to change an object after it was made (an AttributeError too)
"""

from __future__ import annotations

from typing import Any


class GeometryError(ValueError):
    """Any error that the library raises on purpose.

    Attributes
    ----------
    facts : dict
        What the message says, for a program to read: for example ``{"name": "radius", "got": -1.0}``.
    """

    def __init__(self, message: str, **facts: Any) -> None:
        super().__init__(message)
        self.facts = facts


class ShapeError(GeometryError):
    """An array has the wrong shape, or does not hold real numbers."""


class NumberError(GeometryError):
    """A number or a coordinate is out of its range."""


class WeightError(NumberError):
    """A weight is not positive."""


class DomainError(GeometryError):
    """A parameter lies outside [0, 1]."""


class OrderError(GeometryError):
    """An order, degree, count of points or order of a derivative does not fit."""


class KnotError(GeometryError):
    """A knot vector does not fit its order and its points."""


class CurveError(GeometryError):
    """A curve handed in cannot be used as one."""


class DegenerateError(GeometryError):
    """The data do not span what they must: a zero direction, collinear points, no curvature to build a frame on."""


class CornerError(GeometryError):
    """Boundary curves do not meet at their corners."""


class ConversionError(GeometryError):
    """The form asked for cannot hold this one exactly."""


class FrozenError(GeometryError, AttributeError):
    """An object was to be changed after it was made; make a new one instead."""
