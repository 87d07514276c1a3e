"""Files: triangles (STL, OBJ, glTF), true NURBS (STEP), and the forms themselves (JSON, without loss)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from directrix.errors import GeometryError
from directrix.export.exact import dumps, loads
from directrix.export.mesh import mesh, write_mesh
from directrix.export.step import read_step, write_step

__all__ = ["dumps", "loads", "mesh", "read", "write"]

MESHES = {".stl", ".obj", ".glb", ".gltf", ".ply"}
STEPS = {".step", ".stp"}


def write(path: str | Path, *forms: Any, resolution: int = 64) -> Path:
    """Write forms into a file whose suffix says how.

    ``.stl``, ``.obj``, ``.glb``, ``.gltf``, ``.ply``: triangles, through trimesh (``directrix[mesh]``). ``.step``, ``.stp``:
    true NURBS, through OpenCASCADE (``directrix[cad]``), lengths in millimetres. ``.json``: the forms themselves, without loss.

    Parameters
    ----------
    path : where to write; an existing file is replaced
    forms : surfaces and solids; for JSON also curves, quadrics and transforms
    resolution : cells in each parameter of a mesh

    Returns
    -------
    Path

    Raises
    ------
    GeometryError
        If the suffix is none of these, no form is given, a library is missing, or a form cannot be written that way.

    Examples
    --------
    >>> import tempfile
    >>> from directrix.surfaces.known import Sphere
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     read(write(folder + "/ball.json", Sphere(2)))
    [Sphere(radius=2.0)]
    """
    path = _path(path)
    suffix = path.suffix.lower()
    if not forms:
        raise GeometryError("give the forms to write: write(path, surface, ...).")
    if suffix in MESHES:
        write_mesh(path, forms, resolution)
    elif suffix in STEPS:
        write_step(path, forms)
    elif suffix == ".json":
        path.write_text(dumps(*forms) + "\n", encoding="utf-8")
    else:
        raise GeometryError(f"the suffix says how to write: {', '.join(sorted(MESHES | STEPS | {'.json'}))}; got {suffix!r}.")
    return path


def read(path: str | Path) -> list[Any]:
    """The forms of a ``.json`` or ``.step`` file: those that were written, or each face's surface as a `NurbsPatch`.

    Raises
    ------
    GeometryError
        If the suffix is neither, or the file cannot be read.
    """
    path = _path(path)
    if path.suffix.lower() in STEPS:
        return list(read_step(path))
    if path.suffix.lower() == ".json":
        try:
            return loads(path.read_text(encoding="utf-8"))
        except (OSError, UnicodeDecodeError) as error:
            raise GeometryError(f"{path} cannot be read: {error}.") from None
    raise GeometryError(f"only .json and .step files are read back into forms; got {path.suffix!r}.")


def _path(path: str | Path) -> Path:
    if not isinstance(path, str | Path):
        raise GeometryError(f"the name of a file must be a str or a pathlib.Path; got {type(path).__name__}.")
    return Path(path)
