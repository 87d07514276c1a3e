"""Forms are values: set once, equal by content, safe from the caller's arrays."""

import copy
import pickle

import directrix as dx
import numpy as np
import pytest


def test_setting_an_attribute_is_refused():
    """The message names the class and the attribute; a new attribute is refused as well."""
    line = dx.Line((0, 0, 0), (1, 0, 0))
    with pytest.raises(dx.FrozenError, match="a Line does not change once it is made; build a new one to change end"):
        line.end = (2, 0, 0)
    with pytest.raises(dx.FrozenError, match="to change note"):
        line.note = "mine"
    with pytest.raises(dx.FrozenError, match="end cannot be deleted"):
        del line.end


def test_a_held_array_is_read_only():
    """What numpy says when one writes into it is enough."""
    curve = dx.BezierCurve([(0, 0, 0), (1, 1, 0)])
    with pytest.raises(ValueError, match="read-only"):
        curve.control_points[0, 0] = 5


def test_the_callers_array_is_copied():
    """Changing the array afterwards leaves the form, and the array stays writable."""
    points = np.zeros((2, 3))
    points[1] = 1
    curve = dx.BezierCurve(points)
    points[1] = 7
    assert curve(1.0).tolist() == [1, 1, 1]
    assert points.flags.writeable


def test_equal_by_class_and_content():
    """The same numbers in another class are another thing; a Circle is not the Arc it is built on."""
    assert dx.Sphere(2) == dx.Sphere(2.0)
    assert dx.Sphere(2) != dx.Sphere(3)
    assert dx.Circle((0, 0, 0), 1) != dx.Arc((0, 0, 0), 1, 0, 2 * np.pi)
    assert dx.Line((0, 0, 0), (1, 0, 0)) != "a line"


def test_equal_forms_hash_alike():
    """-0.0 equals 0.0, so it must hash alike too."""
    assert hash(dx.Line((0.0, 0, 0), (1, 0, 0))) == hash(dx.Line((-0.0, 0, 0), (1, 0, 0)))
    assert len({dx.Sphere(1), dx.Sphere(1.0), dx.Sphere(2)}) == 2


@pytest.mark.parametrize(
    "form", [dx.Sphere(2), dx.Line((0, 0, 0), (1, 2, 3)), dx.BSplineCurve(np.eye(3), 2), dx.Transform.rotate("x", 1)]
)
def test_copies_are_equal_and_still_frozen(form):
    """Through pickle and copy; arrays come back read-only."""
    for again in (pickle.loads(pickle.dumps(form)), copy.deepcopy(form)):
        assert again == form
        with pytest.raises(dx.FrozenError):
            again.anything = 1
        assert all(not value.flags.writeable for value in vars(again).values() if isinstance(value, np.ndarray))


def test_a_pickled_sweep_finds_its_frame_again():
    """The moving frame is made from the directrix, not stored."""
    sweep = dx.GenericSweep(dx.Line((1, 0, 0), (2, 0, 0)), dx.Circle((0, 0, 0), 2), "minimal")
    again = pickle.loads(pickle.dumps(sweep))
    assert np.array_equal(again(0.3, 0.7), sweep(0.3, 0.7))


def test_the_repr_shows_what_was_given():
    """Short arrays in full, long ones by their shape."""
    assert repr(dx.Sphere(2)) == "Sphere(radius=2.0)"
    assert repr(dx.Line((0, 0, 0), (1, 0, 0))) == "Line(start=[0.0, 0.0, 0.0], end=[1.0, 0.0, 0.0])"
    assert repr(dx.BezierCurve(np.zeros((9, 3)))) == "BezierCurve(control_points=<array of shape (9, 3)>)"
