"""The API reference: built from the docstrings, with every public name in exactly one place."""

import re
import sys
from collections import Counter
from pathlib import Path

import directrix as dx
import pytest

DOCS = Path(__file__).parents[2] / "docs"
pytest.importorskip("griffe", reason="griffe, which reads docstrings, is not installed: uv sync")
sys.path.insert(0, str(DOCS))
import reference  # noqa: E402


@pytest.fixture(scope="module")
def built():
    return reference.pages()


def test_every_public_name_has_one_place():
    """No name of directrix is left out, none appears twice."""
    placed = Counter(name for _, names in reference.GROUPS.values() for name in names)
    assert set(placed.values()) == {1}
    assert set(dx.__all__) <= set(placed)


def test_every_link_of_the_index_leads_somewhere(built):
    """Pages exist and anchors stand in them."""
    links = re.findall(r"\]\(([^)#]+\.md)(?:#([^)]+))?\)", built["index.md"])
    assert len(links) > 80
    for page, target in links:
        assert not target or f'<a id="{target}"></a>' in built[page]


def test_a_page_reads_as_the_docstring(built):
    """Signature, shapes, errors and doctest of one form, as written in the source."""
    page = built["boundary-surfaces.md"]
    assert "Coons(c0, c1, d0, d1, blend='linear')" in page
    assert "- `CornerError`: if they do not meet" in page
    assert ">>> Coons(c0, c1, d0, d1)(0.5, 0.5)\narray([1. , 1. , 1.5])" in page
    assert "- `c0`, `c1`: curves in u: c0(u) = S(u, 0), c1(u) = S(u, 1)" in page


def test_inherited_members_without_a_place_of_their_own_are_shown(built):
    """Plane.implicit is written in a private base, the spline patches' degrees in a shared one."""
    assert "### `Plane.implicit`" in built["known-forms.md"]
    assert "### `NurbsPatch.degrees`" in built["freeform-patches.md"]


def test_fences_are_closed_and_constants_are_numbers(built):
    """Markdown that any renderer reads: fences in pairs; defaults that a reader understands."""
    for page in built.values():
        assert page.count("```") % 2 == 0
    assert "lines=8" in built["pictures.md"]
    assert "| ellipsoid" in built["implicit-surfaces.md"] or "ellipsoid  " in built["implicit-surfaces.md"]


def test_the_command_writes_the_pages(tmp_path, capsys):
    """One file a group, and the index."""
    assert reference.main(["--to", str(tmp_path / "out")]) == 0
    assert {path.name for path in (tmp_path / "out").iterdir()} == set(reference.pages())
    assert str(tmp_path) in capsys.readouterr().out
