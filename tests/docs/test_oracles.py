"""The table of what holds the library to the truth: every public form and call is in it, and the tests that it names exist."""

import inspect
import re
from pathlib import Path

import directrix as dx

TESTS = Path(__file__).parents[1] / "lib"
ROWS = [line.split("|")[1:3] for line in (TESTS / "README.md").read_text("utf-8").splitlines() if line.startswith("| ")][1:]


def test_every_public_name_has_its_oracles():
    """Each name of directrix but errors and bases stands in a first cell, and beside it at least two ways of knowing."""
    held = {name: ways for first, ways in ROWS for name in re.findall(r"`(\w+)`", first)}
    errors = {name for name in dx.__all__ if inspect.isclass(one := getattr(dx, name)) and issubclass(one, dx.GeometryError)}
    assert set(dx.__all__) - errors - {"Curve", "Surface"} - set(held) == set()
    assert {name for name, ways in held.items() if name in dx.__all__ and ways.count(";") < 1} <= {"FunctionCurve", "join"}


def test_no_row_twice_and_every_peer_is_used():
    """A library that the table names is imported somewhere in these tests."""
    firsts = [first.strip() for first, _ in ROWS]
    assert len(firsts) == len(set(firsts))
    sources = "\n".join(path.read_text("utf-8") for path in TESTS.rglob("*.py"))
    words = " ".join(ways for _, ways in ROWS)
    for word, module in {
        "geomdl": "geomdl", "splipy": 'importorskip("splipy"', "splinepy": "splinepy", "OpenCASCADE": "OCP",
        "trimesh": "trimesh", "rhino3dm": "rhino3dm", "nurbspy": "nurbspy", "scipy": "from scipy",
    }.items():  # fmt: skip
        assert word in words
        assert module in sources
    for name in re.findall(r"`((?:properties/)?test_\w+\.py)`", words):
        assert (TESTS / name).exists()
    for one in (
        "Geom_SurfaceOfRevolution",
        "GeomFill_Frenet",
        "GeomFill_Pipe",
        "gp_Trsf",
        "NdBSpline",
        "solve_ivp",
        "edge_curves",
    ):
        assert one in words
        assert one in sources
