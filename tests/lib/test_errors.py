"""The tree of errors: one root, and what each is besides."""

import inspect
import re

import pytest
from directrix import errors
from directrix.errors import CurveError, FrozenError, GeometryError, NumberError, WeightError

ALL = [value for _, value in inspect.getmembers(errors, inspect.isclass) if issubclass(value, Exception)]


@pytest.mark.parametrize("error", ALL)
def test_every_error_is_a_value_error_through_geometry_error(error):
    """Whoever catches ValueError catches all."""
    assert issubclass(error, GeometryError)
    assert issubclass(error, ValueError)


def test_the_tree_at_the_top_of_the_file_names_every_error():
    """The drawing and the classes are the same set."""
    drawn = {word for word in re.findall(r"\w+", errors.__doc__) if word.endswith("Error")}
    assert drawn == {error.__name__ for error in ALL} | {"ValueError", "AttributeError"}


def test_an_error_keeps_its_facts():
    """A program need not parse the sentence."""
    assert NumberError("radius must be greater than 0; got -1.", name="radius", got=-1.0).facts == {
        "name": "radius",
        "got": -1.0,
    }


def test_kinds_that_are_more_than_one_thing():
    """A weight is a number; changing a frozen object is an AttributeError too, as for any read-only attribute."""
    assert issubclass(WeightError, NumberError)
    assert issubclass(FrozenError, AttributeError)
    assert not issubclass(CurveError, NumberError)
