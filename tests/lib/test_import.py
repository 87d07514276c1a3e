"""``import directrix`` costs next to nothing; names load what they need when they are first used."""

import subprocess
import sys

import directrix as dx
import pytest


def in_a_fresh_process(code):
    """What the code prints in an interpreter of its own."""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    return done.stdout.split()


def test_importing_loads_neither_plotly_nor_scipy():
    """Not even numpy, until a name is asked for."""
    loaded = in_a_fresh_process("import directrix, sys; print(*[m for m in ('plotly', 'scipy', 'numpy') if m in sys.modules])")
    assert loaded == []


def test_the_forms_of_the_first_assignments_need_numpy_only():
    """A student's check must not wait for scipy."""
    code = (
        "import directrix as dx, sys; dx.Torus(3, 1)(0.5, 0.5); dx.CircularSweep(dx.Line((1, 0, 0), (2, 0, 1)))(0, 0); "
        "dx.BSplineCurve([(0, 0, 0), (1, 1, 1)], 2)(0.5); print(*[m for m in ('plotly', 'scipy') if m in sys.modules])"
    )
    assert in_a_fresh_process(code) == []


@pytest.mark.parametrize("name", sorted(dx.__all__))
def test_every_exported_name_is_there_and_documented(name):
    """The table of names and the modules agree; what is exported says what it is."""
    value = getattr(dx, name)
    assert value.__doc__
    assert value.__name__ == name
    assert name in dir(dx)


def test_an_unknown_name_is_an_attribute_error():
    """As for any module."""
    with pytest.raises(AttributeError, match="module 'directrix' has no attribute 'Kylinder'"):
        dx.Kylinder
