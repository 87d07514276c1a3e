"""The API reference: Markdown pages from the signatures and docstrings of `lib/directrix`, grouped as a course groups them.

    python docs/reference.py                     into docs/_build/reference
    python docs/reference.py --to FOLDER

The sources are read by griffe, not imported. Nothing is written by hand: what is wrong here is wrong in a docstring.
"""

from __future__ import annotations

import argparse
import logging
import re
import textwrap
from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

import griffe

HERE = Path(__file__).parent
LIBRARY = HERE.parent / "lib"

GROUPS: dict[str, tuple[str, list[str]]] = {
    "Curves": (
        "Every curve is called with u of any shape and gives points of shape u.shape + (3,).",
        ["Curve", "Line", "Arc", "Circle", "Conic", "HermiteCurve", "PointCurve", "BezierCurve", "BSplineCurve", "NurbsCurve",
         "FunctionCurve"],
    ),
    "Surfaces": (
        "What all surfaces share: evaluation, derivatives, normals, curvature, area, projection, cutting and turning round.",
        ["Surface"],
    ),
    "Known forms": (
        "About the z axis or through three points; each also as a sweep, `.swept()`, and where it is one as a `Quadric`, "
        "`.implicit()`.",
        ["Plane", "Triangle", "Cylinder", "Cone", "Sphere", "Torus"],
    ),
    "Swept surfaces": (
        "u runs along the generatrix, w along the directrix.", ["LinearSweep", "CircularSweep", "GenericSweep"],
    ),
    "Freeform patches": (
        "Tensor products of mixed degree; the first index of a net runs along u.",
        ["AlgebraicPatch", "HermitePatch", "coons_twists", "PointPatch", "BezierPatch", "BSplinePatch", "NurbsPatch"],
    ),
    "Boundary surfaces": (
        "From corners, edges, or corners with tangents.",
        ["Bilinear", "Ruled", "Coons", "coons_net", "Ferguson"],
    ),
    "Implicit surfaces": ("Ten coefficients.", ["Quadric", "quadric_patches"]),
    "Solids": (
        "Three parameters u, v, w; six faces with outward normals.",
        ["Solid", "HermiteHyperpatch", "BezierHyperpatch", "BSplineHyperpatch", "NurbsHyperpatch"],
    ),
    "Moving": ("`transform @ form` moves a curve, a surface, a solid, a quadric or points.", ["Transform"]),
    "Conversion": (
        "Exact between every pair of forms that admits it, a `ConversionError` where none exists.",
        ["to_bezier", "to_hermite", "to_algebraic", "to_points", "to_bspline", "to_nurbs", "elevate", "insert_knot",
         "remove_knot", "split_bezier"],
    ),
    "Inspection": (
        "Form errors of measured points.",
        ["flatness", "sphericity", "cylindricity", "conicity", "toricity", "FormError"],
    ),
    "Measures": ("Besides `Surface.area`, `Surface.nearest`, `Solid.volume` and `Curve.length`.", ["join"]),
    "Pictures": ("Of anything that can be called with its parameters.", ["plot.view", "plot.walk", "plot.compare"]),
    "Files": ("Triangles, true NURBS, and JSON without loss.", ["export.write", "export.read", "export.mesh", "export.dumps",
              "export.loads"]),
    "Errors": (
        "Every one is a `ValueError` that says what must hold, what came and what to try.",
        ["GeometryError", "ShapeError", "NumberError", "WeightError", "DomainError", "OrderError", "KnotError", "CurveError",
         "DegenerateError", "CornerError", "ConversionError", "FrozenError"],
    ),
}  # fmt: skip
OUTSIDE = {"Solid": "solids.solid", "FormError": "inspection"}  # documented, though not named in directrix itself


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--to", type=Path, default=HERE / "_build" / "reference", help="the folder to write into")
    folder = parser.parse_args(arguments).to
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in pages().items():
        (folder / name).write_text(text, "utf-8")
    print(folder)
    return 0


def pages() -> dict[str, str]:
    """The pages, by file name."""
    logging.getLogger("griffe").setLevel(logging.ERROR)  # units such as "length, > 0" stand where it looks for a type
    package = griffe.load("directrix", search_paths=[LIBRARY], docstring_parser="numpy")
    modules = exported(package)
    index = ["# directrix: the reference library", "", package.docstring.value, ""]
    made = {}
    for group, (about, names) in GROUPS.items():
        page = f"{group.lower().replace(' ', '-')}.md"
        objects = {name: found(package, modules, name) for name in names}
        index += [f"## [{group}]({page})", "", about, ""]
        index += [f"- [`{name}`]({page}#{anchor(name)}): {summary(one)}" for name, one in objects.items()] + [""]
        parts = [f"# {group}", about, *(text for name, one in objects.items() for text in entry(name, one))]
        made[page] = "\n\n".join(parts) + "\n"
    return {"index.md": "\n".join(index), **made}


def exported(package: Any) -> dict[str, str]:
    """The public names and the modules they come from, as ``directrix/__init__.py`` lists them."""
    listed = package["_NAMES"].value
    return {key.strip("'\""): str(value).strip("'\"") for key, value in zip(listed.keys, listed.values, strict=True)}


def found(package: Any, modules: dict[str, str], name: str) -> Any:
    """The class or function of a public name, followed to where it is written."""
    place = f"{modules.get(name, OUTSIDE.get(name, ''))}.{name}".strip(".")
    one = package[place]
    return one.final_target if one.is_alias else one


def entry(name: str, one: Any, level: int = 2) -> Iterator[str]:
    """A class with its own public methods, or a function."""
    yield f'<a id="{anchor(name)}"></a>\n\n{"#" * level} `{name}`'
    if not one.is_attribute and not name.endswith("Error"):
        yield f"```python\n{signature(name, one)}\n```"
    if one.is_class and (bases := [str(base) for base in one.bases if not str(base).startswith(("Frozen", "_"))]):
        yield f"Kind of {', '.join(f'`{base}`' for base in bases)}."
    yield from docstring(one)
    if one.is_class:
        for member in (*one.members.values(), *from_bases(one)):
            if member.is_public and member.docstring and (member.is_function or "property" in member.labels):
                yield from entry(f"{name}.{member.name}", member, level + 1)


def from_bases(one: Any) -> Iterator[Any]:
    """Members of bases that have no place of their own in the reference."""
    documented = {name for _, names in GROUPS.values() for name in names} | {"Frozen"}
    for member in one.inherited_members.values():
        if member.final_target.parent.name not in documented:
            yield member.final_target


def signature(name: str, one: Any) -> str:
    """How it is called, without the hints: the parameters below say more."""
    call = one.members.get("__init__") if one.is_class else one
    if call is None and one.is_class:
        call = next((base.members["__init__"] for base in one.mro() if "__init__" in base.members), None)
    if call is None or not call.is_function:
        return name
    shown, star = [], False
    for parameter in call.parameters:
        if parameter.name in ("self", "cls"):
            continue
        kind = parameter.kind.value
        if kind == "keyword-only" and not star:
            shown.append("*")
            star = True
        star = star or kind == "variadic positional"
        stars = {"variadic positional": "*", "variadic keyword": "**"}.get(kind, "")
        default = f"={written(parameter.default, call)}" if parameter.default is not None and not stars else ""
        shown.append(f"{stars}{parameter.name}{default}")
    return "\n".join(textwrap.wrap(f"{name}({', '.join(shown)})", 100, subsequent_indent="    "))


def written(default: Any, call: Any) -> str:
    """A default as a number, where the source has the name of a constant."""
    constant = call.module.members.get(str(default))
    return str(constant.value) if constant is not None and constant.is_attribute else str(default)


def docstring(one: Any) -> Iterator[str]:
    """The docstring as Markdown, section by section."""
    for section in one.docstring.parsed if one.docstring else []:
        kind = section.kind.value
        if kind == "text":
            yield prose(section.value)
        elif kind in ("parameters", "attributes", "raises", "returns"):
            yield f"**{kind.capitalize()}**"
            yield "\n".join(rows(section.value))
        elif kind == "examples":
            yield "**Examples**"
            yield "\n\n".join(prose(text) if part.value == "text" else f"```pycon\n{text}\n```" for part, text in section.value)
        else:
            raise ValueError(f"{one.path}: a section {kind!r} has no place in the reference")


def rows(items: Sequence[Any]) -> Iterator[str]:
    """One line an item; names that share their words share their line."""
    for (annotation, description), same in groupby(items, key=lambda one: (str(one.annotation or ""), one.description)):
        names = ", ".join(f"`{one.name}`" for one in same if getattr(one, "name", ""))
        kind, words = annotation.strip("'"), prose(" ".join(description.split()))
        if kind.endswith("Error"):
            yield f"- `{kind}`: {words[:1].lower()}{words[1:]}"
        else:
            yield f"- {': '.join(part for part in (names, '. '.join(part for part in (kind, words) if part)) if part)}"


def prose(text: str) -> str:
    """Text with its tables and doctests fenced, and its references plain."""
    text = re.sub(r":\w+:`~?([^`]+)`", r"`\1`", text)
    blocks = []
    for block in re.split(r"\n\s*\n", text):
        if block.startswith(">>>"):
            blocks.append(f"```pycon\n{block}\n```")
        elif block.startswith("===") or block.lstrip("\n").startswith("    "):
            blocks.append(f"```text\n{textwrap.dedent(block.strip(chr(10)))}\n```")
        else:
            blocks.append(block)
    return "\n\n".join(blocks)


def summary(one: Any) -> str:
    """The first sentence, or what of it stands before a formula's colon."""
    first = " ".join(one.docstring.value.split("\n\n")[0].split())
    return re.split(r"(?<=[a-z)])[.:] ", f"{first} ", maxsplit=1)[0].strip().rstrip(".") + "."


def anchor(name: str) -> str:
    """The name as the target of a link."""
    return name.lower().replace(".", "-")


if __name__ == "__main__":
    raise SystemExit(main())
