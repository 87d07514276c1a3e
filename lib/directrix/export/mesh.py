"""Triangles of a surface or a solid's boundary, and files of them through trimesh (STL, OBJ, glTF)."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from directrix import checks
from directrix.checks import Array
from directrix.errors import GeometryError
from directrix.export.parts import continuous
from directrix.solids.solid import Solid
from directrix.surfaces.spline import BSplinePatch, NurbsPatch
from directrix.surfaces.surface import Surface

WELD = 1e-9  # vertices nearer than this, as a fraction of the size, are one

MISSING = "writing {suffix} needs trimesh: pip install 'directrix[mesh]'"

SPLINES = BSplinePatch, NurbsPatch
FINEST = 4096  # cells in each parameter


def mesh(form: Surface | Solid, resolution: int = 64) -> tuple[Array, NDArray[np.int64]]:
    """Triangles of a surface, or of the six faces of a solid.

    Parameters equally spaced, knots among them, each cell cut along a diagonal; where a B-spline is torn, a gap. Vertices that
    coincide (a closed seam, a pole, the edges of a solid) become one and collapsed triangles are left out, so that a closed
    surface gives a closed mesh. Triangles run anticlockwise about S_u x S_w; those of a solid about the outward normal.

    Parameters
    ----------
    form : surface or solid
    resolution : cells in each parameter, 1 to 4096

    Returns
    -------
    (vertices, triangles) : (n, 3) floats in the unit of the form, (m, 3) indices

    Raises
    ------
    GeometryError
        If the form is neither surface nor solid.

    Examples
    --------
    >>> from directrix.surfaces.plane import Plane
    >>> vertices, triangles = mesh(Plane((0, 0, 0), (1, 0, 0), (0, 1, 0)), 1)
    >>> vertices.tolist(), triangles.tolist()
    ([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]], [[0, 2, 3], [0, 3, 1]])
    """
    if checks.whole("resolution", resolution, least=1) > FINEST:
        raise GeometryError(f"resolution must be at most {FINEST}, which makes millions of triangles; got {resolution!r:.30}.")
    if isinstance(form, Solid):
        parts = [_grid(face, resolution) for face in form.faces()]
    elif isinstance(form, Surface):
        parts = [_grid(one, resolution) for one in (continuous(form) if isinstance(form, SPLINES) else [form])]
    else:
        raise GeometryError(f"a mesh is made of a surface or a solid; got {type(form).__name__}.")
    offsets = np.cumsum([0, *(len(vertices) for vertices, _ in parts)])
    vertices = np.concatenate([part for part, _ in parts])
    triangles = np.concatenate([cells + offset for (_, cells), offset in zip(parts, offsets, strict=False)])
    return _welded(vertices, triangles)


def _grid(surface: Surface, resolution: int) -> tuple[Array, NDArray[np.int64]]:
    u, w = (np.union1d(np.linspace(0.0, 1.0, resolution + 1), breaks) for breaks in surface.breaks())
    index = np.arange(len(u) * len(w)).reshape(len(u), len(w))
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]))
    return surface(u[:, None], w[None]).reshape(-1, 3), np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)


def _welded(vertices: Array, triangles: NDArray[np.int64]) -> tuple[Array, NDArray[np.int64]]:
    from scipy.spatial import cKDTree

    size = float(np.ptp(vertices, axis=0).max())
    pairs = cKDTree(vertices).query_pairs(WELD * size, output_type="ndarray")
    first = np.arange(len(vertices))
    for _ in range(8):  # chains of near vertices settle on their least index
        np.minimum.at(first, pairs[:, 1], first[pairs[:, 0]])
        np.minimum.at(first, pairs[:, 0], first[pairs[:, 1]])
    used, number = np.unique(first[triangles], return_inverse=True)
    faces = number.reshape(-1, 3)
    whole = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    return vertices[used], faces[whole]


def write_mesh(path: Path, forms: tuple[Any, ...], resolution: int) -> None:
    """One file of all forms, in the format of its suffix: .stl (binary), .obj, .glb, .gltf (in one file) or .ply."""
    kind = path.suffix.lower()[1:]
    try:
        import trimesh
    except ImportError:
        raise GeometryError(MISSING.format(suffix=path.suffix)) from None
    parts = [trimesh.Trimesh(*mesh(form, resolution), process=False) for form in forms]
    if kind in {"stl", "ply", "obj"}:
        more = {"digits": max(_decimals(part.vertices) for part in parts)} if kind == "obj" else {}
        trimesh.util.concatenate(parts).export(path, file_type=kind, **more)
        return
    scene = trimesh.Scene(parts)
    if kind == "gltf":
        # Buffers of their own would have the same names for every file in the folder.
        path.write_bytes(scene.export(file_type="gltf", embed_buffers=True)["model.gltf"])
        return
    scene.export(path, file_type=kind)


def _decimals(vertices: Array) -> int:
    """Decimals that keep ten digits of small forms too: OBJ holds decimal numbers without an exponent."""
    largest = float(np.abs(vertices).max(initial=0.0)) or 1.0
    return max(8, 10 - math.floor(math.log10(largest)))
