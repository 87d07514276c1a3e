"""STEP files through OpenCASCADE: surfaces written as true NURBS, and read back as such.

Needs the extra `directrix[cad]` (cadquery-ocp). OpenCASCADE asks that a surface be continuous: a B-spline torn at a knot of
full multiplicity is cut there first. Lengths are written as millimetres.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from directrix.checks import Array
from directrix.conversion import to_nurbs
from directrix.errors import GeometryError
from directrix.export.parts import continuous
from directrix.solids.solid import Solid
from directrix.surfaces.spline import NurbsPatch
from directrix.surfaces.surface import Surface

LEAST = 1e-5  # mm: OpenCASCADE takes points within 1e-7 mm for one, and leaves out faces without a word
SHORTEST = 1e-6  # domain of knots that is written as it is; from a shorter one faces are lost as well
FARTHEST = 1e8  # lengths of the domain at which it may begin

MISSING = "STEP files need OpenCASCADE: pip install 'directrix[cad]'"


def write_step(path: Path, forms: tuple[Any, ...]) -> None:
    """Surfaces, or the faces of solids, as B-spline faces of one STEP file."""
    surfaces = [face for form in forms for face in (form.faces() if isinstance(form, Solid) else [form])]
    if not all(isinstance(surface, Surface) for surface in surfaces):
        raise GeometryError("STEP holds surfaces and solids; convert curves into surfaces first, or write them to JSON.")
    patches = [part for surface in surfaces for part in continuous(to_nurbs(surface))]
    with _opencascade() as occ:
        builder, compound = occ.BRep.BRep_Builder(), occ.TopoDS.TopoDS_Compound()
        builder.MakeCompound(compound)
        for patch in patches:
            _check_size(patch)
            made = occ.BRepBuilderAPI.BRepBuilderAPI_MakeFace(_geom(occ, patch), 1e-6)
            if not made.IsDone():
                raise GeometryError(f"OpenCASCADE made no face of {patch!r}: {made.Error()}.")
            builder.Add(compound, made.Face())
        writer = occ.STEPControl.STEPControl_Writer()
        writer.Transfer(compound, occ.STEPControl.STEPControl_AsIs)
        if writer.Write(str(path)) != occ.IFSelect.IFSelect_ReturnStatus.IFSelect_RetDone:
            raise GeometryError(f"OpenCASCADE could not write {path}. Is the folder there, and may it be written to?")


def read_step(path: Path) -> list[NurbsPatch]:
    """The surface of each face of a STEP file as a NURBS patch over the face's range of parameters; trimming is not kept."""
    if not path.is_file():
        raise GeometryError(f"there is no file {path}.")
    with _opencascade() as occ:
        reader = occ.STEPControl.STEPControl_Reader()
        if reader.ReadFile(str(path)) != occ.IFSelect.IFSelect_ReturnStatus.IFSelect_RetDone:
            raise GeometryError(f"OpenCASCADE could not read {path} as STEP.")
        reader.TransferRoots()
        found = []
        explorer = occ.TopExp.TopExp_Explorer(reader.OneShape(), occ.TopAbs.TopAbs_ShapeEnum.TopAbs_FACE)
        while explorer.More():
            found.append(_patch(occ, _face(occ, explorer.Current())))
            explorer.Next()
        return found


def _check_size(patch: NurbsPatch) -> None:
    size = float(np.ptp(patch.control_net.reshape(-1, 3), axis=0).max())
    if size < LEAST:
        raise GeometryError(
            f"STEP holds lengths in millimetres, and a surface of {LEAST:g} mm at least; got one of {size:.3g}. "
            "Scale it up: Transform.scale(...) @ surface."
        )


class _Modules:
    """OpenCASCADE's modules by name, imported when first used."""

    def __getattr__(self, name: str) -> Any:
        from importlib import import_module

        return import_module(f"OCP.{name}")


@contextmanager
def _opencascade() -> Iterator[Any]:
    """OpenCASCADE with its chatter turned down to errors, and turned up again afterwards."""
    occ = _Modules()
    try:
        message = occ.Message
    except ImportError:
        raise GeometryError(MISSING) from None
    printers = list(message.Message.DefaultMessenger_s().Printers())
    levels = [printer.GetTraceLevel() for printer in printers]
    try:
        for printer in printers:
            printer.SetTraceLevel(message.Message_Gravity.Message_Fail)
        yield occ
    finally:
        for printer, level in zip(printers, levels, strict=True):
            printer.SetTraceLevel(level)


def _geom(occ: Any, patch: NurbsPatch) -> Any:
    arrays = _arrays(occ)
    m, n = patch.weights.shape
    poles, weights = arrays["points"](1, m, 1, n), arrays["numbers2"](1, m, 1, n)
    for i in range(m):
        for j in range(n):
            poles.SetValue(i + 1, j + 1, occ.gp.gp_Pnt(*map(float, patch.control_net[i, j])))
            weights.SetValue(i + 1, j + 1, float(patch.weights[i, j]))
    (knots_u, times_u), (knots_w, times_w) = (_knots(arrays, knots) for knots in (patch.knots_u, patch.knots_w))
    try:
        return occ.Geom.Geom_BSplineSurface(poles, weights, knots_u, knots_w, times_u, times_w, *patch.degrees)
    except Exception as failure:  # OpenCASCADE's exceptions have nothing in common
        raise GeometryError(f"OpenCASCADE takes no such surface: {failure}. Knots may lie too near to each other.") from None


def _knots(arrays: dict[str, Any], knots: Array) -> tuple[Any, Any]:
    distinct, counts = np.unique(_spread(knots), return_counts=True)
    values, times = arrays["numbers"](1, len(distinct)), arrays["counts"](1, len(distinct))
    for i, (knot, count) in enumerate(zip(distinct, counts, strict=True), start=1):
        values.SetValue(i, float(knot))
        times.SetValue(i, int(count))
    return values, times


def _spread(knots: Array) -> Array:
    """Knots whose ends are repeated; from 0 to 1 where they lie too near to each other: the surface over u is the same."""
    start, end = knots[0], knots[-1]
    plain = end - start >= SHORTEST and max(abs(start), abs(end)) <= FARTHEST * (end - start)
    return knots if plain else (knots - start) / (end - start)


def _arrays(occ: Any) -> dict[str, Any]:
    """OpenCASCADE's array classes, which version 8 moved."""
    try:
        new = occ.collections
        return {
            "points": new.Array2_gp_Pnt,
            "numbers2": new.Array2_double,
            "numbers": new.Array1_double,
            "counts": new.Array1_int,
        }
    except ImportError:
        std = occ.TColStd
        return {
            "points": occ.TColgp.TColgp_Array2OfPnt,
            "numbers2": std.TColStd_Array2OfReal,
            "numbers": std.TColStd_Array1OfReal,
            "counts": std.TColStd_Array1OfInteger,
        }


def _face(occ: Any, shape: Any) -> Any:
    """A shape as the face it is; the cast has two names in OpenCASCADE's versions."""
    cast = occ.TopoDS.TopoDS
    return (cast.Face_s if hasattr(cast, "Face_s") else cast.Face)(shape)


def _patch(occ: Any, face: Any) -> NurbsPatch:
    u0, u1, w0, w1 = occ.BRepTools.BRepTools.UVBounds_s(face)
    trimmed = occ.Geom.Geom_RectangularTrimmedSurface(occ.BRep.BRep_Tool.Surface_s(face), u0, u1, w0, w1)
    spline = occ.GeomConvert.GeomConvert.SurfaceToBSplineSurface_s(trimmed)
    spline.SetUNotPeriodic()
    spline.SetVNotPeriodic()
    m, n = spline.NbUPoles(), spline.NbVPoles()
    poles = [[spline.Pole(i + 1, j + 1) for j in range(n)] for i in range(m)]
    net = [[(p.X(), p.Y(), p.Z()) for p in row] for row in poles]
    weights = [[spline.Weight(i + 1, j + 1) for j in range(n)] for i in range(m)]
    knots_u = [spline.UKnot(i) for i in range(1, spline.NbUKnots() + 1) for _ in range(spline.UMultiplicity(i))]
    knots_w = [spline.VKnot(i) for i in range(1, spline.NbVKnots() + 1) for _ in range(spline.VMultiplicity(i))]
    return NurbsPatch(net, weights, spline.UDegree() + 1, spline.VDegree() + 1, knots_u, knots_w)
