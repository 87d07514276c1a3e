"""Bad input of every kind: what is not a form is refused with a sentence, and nothing but GeometryError escapes."""

import directrix as dx
import numpy as np
import pytest
from directrix.errors import GeometryError
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

JUNK = st.one_of(
    st.none(),
    st.text(max_size=3),
    st.floats(),
    st.integers(-3, 9),
    st.booleans(),
    st.lists(st.floats(), max_size=4),
    st.complex_numbers(),
    st.just({}),
    st.just(np.sin),
    st.just(lambda t: t[0]),
    arrays(float, st.tuples(st.integers(0, 4), st.integers(0, 4)), elements=st.floats()),
    arrays(float, 3, elements=st.sampled_from([0.0, 1.0, -1e-300, 1e300, 5e-324])),
    st.lists(st.lists(st.integers(-2, 2), max_size=4), max_size=4),
)
A, B, C, D = (0, 0, 0), (4, 1, 2), (0, 5, 3), (1, 1, 1)
LINE, NET = dx.Line(A, B), [A, B, C, D]
MAKERS = [
    (dx.Line, (A, B)),
    (dx.Arc, (A, 1, 0, 2, B)),
    (dx.Circle, (A, 1, B)),
    (dx.Conic, (A, B, C, 2)),
    (dx.HermiteCurve, (A, B, C, D)),
    (dx.PointCurve, (NET, [0, 0.2, 0.5, 1])),
    (dx.BezierCurve, (NET,)),
    (dx.BSplineCurve, (NET, 3, [0, 0, 0, 1, 2, 2, 2])),
    (dx.NurbsCurve, (NET, [1, 2, 3, 4], 3, "open")),
    (dx.FunctionCurve, (LINE,)),
    (dx.Cylinder, (1, 2)),
    (dx.Cone, (1, 2, 3)),
    (dx.Sphere, (1,)),
    (dx.Torus, (3, 1)),
    (dx.Plane, (A, B, C)),
    (dx.Triangle, (A, B, C)),
    (dx.LinearSweep, (LINE, C, 2)),
    (dx.LinearSweep.between, (LINE, A, C)),
    (dx.CircularSweep, (LINE, "x", 1)),
    (dx.CircularSweep.about, (LINE, A, C, 2)),
    (dx.CircularSweep.in_xy_plane, (LINE, 1, 2)),
    (dx.GenericSweep, (LINE, dx.Circle(A, 1), "minimal")),
    (dx.Transform, (np.eye(4),)),
    (dx.Transform.of, (np.eye(3), A)),
    (dx.Transform.rotate, ("x", 2, B)),
    (dx.Transform.reflect, (B, C)),
    (dx.Transform.scale, (2, C)),
    (dx.Transform.translate, (B,)),
]


def one_bad(draw, good):
    """The good arguments with one of them replaced."""
    at = draw(st.integers(0, len(good) - 1))
    return (*good[:at], draw(JUNK), *good[at + 1 :])


@pytest.mark.parametrize(("make", "good"), MAKERS, ids=lambda case: getattr(case, "__qualname__", ""))
@given(st.data())
def test_one_bad_argument_is_refused_with_a_sentence_or_makes_a_form(make, good, data):
    """Whatever comes in: a form whose points are finite numbers, or a GeometryError of more than a few words."""
    try:
        form = make(*one_bad(data.draw, good))
    except GeometryError as error:
        said = str(error)
    else:
        said = "that is a form, and so was to be made"
        assert repr(form)
        if isinstance(form, dx.Curve):
            assert form([0, 0.5, 1]).shape == (3, 3)
        elif isinstance(form, dx.Surface):
            assert form([0, 0.5, 1], 0.5).shape == (3, 3)
    assert len(said.split()) > 4


@pytest.mark.parametrize(("make", "good"), MAKERS, ids=lambda case: getattr(case, "__qualname__", ""))
def test_the_good_arguments_are_good(make, good):
    """The neighbour of all that is refused."""
    assert repr(make(*good))


@given(st.sampled_from([dx.Sphere(1), dx.Cone(1, 0, 1), dx.Plane(A, B, C), dx.CircularSweep(LINE, "x", 1)]), JUNK, JUNK)
def test_junk_parameters_are_refused_too(surface, u, w):
    """Finite points of the promised shape, or a GeometryError."""
    try:
        points = surface(u, w)
    except GeometryError as error:
        said = str(error)
    else:
        said = "these were parameters, and points came out"
        assert points.shape == (*np.broadcast_shapes(np.shape(u), np.shape(w)), 3)
        assert np.isfinite(points).all()
    assert len(said.split()) > 4
