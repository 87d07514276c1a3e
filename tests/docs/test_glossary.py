"""The glossary: well-formed rows, no term twice, and every code name in it exists."""

import inspect
import re
from pathlib import Path

import directrix as dx
from directrix import basis, plot
from directrix.differential import Curvature
from directrix.solids.solid import Solid

ROWS = [
    [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
    for line in (Path(__file__).parents[2] / "docs" / "glossary.md").read_text("utf-8").splitlines()
    if line.startswith("| ") and not line.startswith("| term")
]


def known_names():
    """Public names, their attributes, the names of arguments, and the fields of what methods return."""
    forms = [getattr(dx, name) for name in dx.__all__ if not name.endswith("Error")] + [Solid, plot.view]
    found = {*dx.__all__, *dir(basis), *Curvature._fields}
    for form in forms:
        found |= set(dir(form)) | set(vars(form).get("__annotations__", ()))
        calls = [form, *(getattr(form, name) for name in dir(form) if not name.startswith("_"))]
        for call in calls:
            if inspect.isroutine(call) or inspect.isclass(call):
                found |= set(inspect.signature(call).parameters)
    return found


def test_rows_have_five_cells_and_terms_differ():
    """Term, symbol, code name, our rule, others."""
    assert len(ROWS) > 45
    assert {len(row) for row in ROWS} == {5}
    assert len({row[0] for row in ROWS}) == len(ROWS)
    assert all(row[2] or row[3] for row in ROWS)


def test_every_code_name_exists():
    """What stands in the third column can be typed."""
    known = known_names()
    named = {
        name for row in ROWS for code in re.findall(r"`([^`]+)`", row[2]) for name in re.findall(r"[A-Za-z_]\w*", _bare(code))
    }
    assert len(named) > 50
    assert named <= known | {"continuity", "kind"}


def _bare(code):
    return re.sub(r'"[^"]*"', "", code)
