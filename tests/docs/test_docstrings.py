"""Every public name is documented: what it is, arguments with shape or unit, errors, a source, a doctest that runs."""

import doctest
import inspect
import re

import directrix as dx
import numpy as np
import pytest
from directrix import errors, export, plot
from directrix.solids.solid import Solid
from directrix.surfaces.surface import Surface

griffe = pytest.importorskip("griffe", reason="griffe, which reads docstrings, is not installed: uv sync")
ERRORS = {name for name, value in vars(errors).items() if isinstance(value, type) and issubclass(value, Exception)}
NAMES = {name: getattr(dx, name) for name in dx.__all__ if name not in ERRORS}
FILES = {f"{room.__name__.split('.')[-1]}.{name}": getattr(room, name) for room in (plot, export) for name in room.__all__}
EVERY = pytest.mark.parametrize("name", [*NAMES, *FILES])

SOURCE = re.compile(
    r"Mortenson|Piegl & Tiller|Farin|do Carmo|Rogers & Adams|Hilbert & Cohn-Vossen|Taubin|Forbes|ISO 1101|NPL report|Trefethen|"
    r"Ferguson, |Coons, |lecture"
)
SIZE = re.compile(r"shape|\(3,\)|\(\.\.\., 3\)|, 3\)|length|radians|unit|order")


def test_the_table_of_the_design_is_there():
    """The names that a course and its exercises rely on, written out: a name that vanishes is seen."""
    table = """
        Line Arc Circle Conic HermiteCurve PointCurve BezierCurve BSplineCurve NurbsCurve FunctionCurve
        Plane Triangle Cylinder Cone Sphere Torus LinearSweep CircularSweep GenericSweep
        AlgebraicPatch HermitePatch PointPatch BezierPatch BSplinePatch NurbsPatch
        Bilinear Ruled Coons Ferguson Quadric HermiteHyperpatch BezierHyperpatch BSplineHyperpatch NurbsHyperpatch Transform
        to_bezier to_hermite to_algebraic to_points to_bspline to_nurbs elevate insert_knot split_bezier
        flatness cylindricity conicity sphericity toricity join
    """
    assert set(table.split()) <= set(dx.__all__)
    assert {"LinearSweep.between", "CircularSweep.about", "Quadric.through"} <= {
        f"{name}.{member}" for name in NAMES for member in dir(NAMES[name])
    }
    for form in (dx.Plane, dx.Triangle, dx.Cylinder, dx.Cone, dx.Sphere, dx.Torus):
        assert callable(form.swept)
        assert callable(form.implicit)
    for method in ("derivative", "normal", "curvature", "area", "nearest", "patch", "split", "flip_u", "swap"):
        assert callable(getattr(Surface, method))
    assert callable(Solid.faces)
    assert callable(Solid.volume)


def test_dir_offers_every_name():
    """What a reader completes in a notebook."""
    assert set(dx.__all__) <= set(dir(dx))
    assert {"plot", "export"} <= set(dir(dx))


def sections(name):
    """The parsed sections of a docstring: {kind: value}."""
    one = (NAMES | FILES)[name]
    parsed = griffe.Docstring(inspect.getdoc(one) or "").parse("numpy", warnings=False)
    return one, {section.kind.value: section.value for section in parsed}


@EVERY
def test_the_first_sentence_says_what_it_is(name):
    """It begins with a capital letter and ends as a sentence or before its formula."""
    text = sections(name)[1]["text"]
    first = text.split("\n\n")[0].replace("\n", " ")
    assert re.match(r"[A-Z]", first)
    assert re.search(r"[.:] |[.:]$", first)


@EVERY
def test_every_argument_is_described(name):
    """Parameters names what the call takes, no more and no less, and says of each something with a size, unit or kind."""
    one, found = sections(name)
    if one in (Surface, dx.Curve, dx.Quadric) or name in ("export.read", "export.loads"):
        return  # bases take nothing; the others are described in their words
    call = inspect.signature(one).parameters.values()
    documented = {parameter.name.lstrip("*"): parameter for parameter in found["parameters"]}
    assert list(documented) == [parameter.name for parameter in call if parameter.name in documented]
    missing = {parameter.name for parameter in call} - set(documented)
    assert not missing
    words = {key: f"{parameter.annotation or ''} {parameter.description}".strip() for key, parameter in documented.items()}
    assert all(words.values()), words


@pytest.mark.parametrize("name", NAMES)
def test_sizes_units_and_source(name):
    """Somewhere it says which shape, length or angle is meant, and where the formula comes from."""
    text = inspect.getdoc(NAMES[name])
    assert SIZE.search(text) or NAMES[name].__module__.startswith("directrix.conversion")  # these take and give whole forms
    assert SOURCE.search(text)


@EVERY
def test_raises_names_errors_of_the_library(name):
    """Each documented error is one of ours, with the condition."""
    _, found = sections(name)
    for one in found["raises"]:
        assert set(re.split(r", ", str(one.annotation))) <= ERRORS, one.annotation
        assert len(one.description) > 10


@EVERY
def test_the_examples_run(name):
    """At least one doctest, and what it prints is what it says."""
    one = (NAMES | FILES)[name]
    if name in ("export.read", "export.loads"):
        return  # shown by export.write and export.dumps
    tests = [test for test in doctest.DocTestFinder(recurse=False).find(one, name) if test.examples]
    assert tests
    for test in tests:
        test.globs.setdefault("np", np)
        result = doctest.DocTestRunner(verbose=False).run(test)
        assert (result.failed, result.attempted > 0) == (0, True)


@pytest.mark.parametrize("name", [name for name, one in NAMES.items() if inspect.isclass(one)])
def test_every_method_is_documented(name):
    """Public methods and properties, those of the bases too."""
    one = NAMES[name]
    for member in dir(one):
        value = inspect.getattr_static(one, member)
        value = value.fget if isinstance(value, property) else getattr(value, "__func__", value)
        if not member.startswith("_") and inspect.isfunction(value):
            assert inspect.getdoc(value), f"{name}.{member}"


@pytest.mark.parametrize("name", sorted(ERRORS))
def test_errors_are_value_errors_that_are_exported(name):
    """All derive from GeometryError, a ValueError, and can be caught by their name in directrix."""
    assert issubclass(getattr(dx, name), dx.GeometryError)
    assert issubclass(dx.GeometryError, ValueError)
    assert f"── {name}" in errors.__doc__
