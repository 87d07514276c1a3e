"""OpenCASCADE as an oracle: our splines as its curves and surfaces, its points as arrays. For tests alone."""

from importlib import import_module

import directrix as dx
import numpy as np


class Modules:
    """OpenCASCADE's modules by name."""

    def __getattr__(self, name):
        if name.startswith("_"):
            raise AttributeError(name)
        return import_module(f"OCP.{name}")


occ = Modules()


def array1(kind, values):
    """One of its arrays, which count from 1."""
    made = getattr(occ.collections, f"Array1_{kind}")(1, len(values))
    for i, value in enumerate(values, start=1):
        made.SetValue(i, value)
    return made


def array2(kind, rows):
    """One of its tables."""
    made = getattr(occ.collections, f"Array2_{kind}")(1, len(rows), 1, len(rows[0]))
    for i, row in enumerate(rows, start=1):
        for j, value in enumerate(row, start=1):
            made.SetValue(i, j, value)
    return made


def point(p):
    """A gp_Pnt."""
    return occ.gp.gp_Pnt(*map(float, p))


def vector(p):
    """A gp_Vec."""
    return occ.gp.gp_Vec(*map(float, p))


def direction(p):
    """A gp_Dir."""
    return occ.gp.gp_Dir(*map(float, p))


def xyz(p):
    """A point or vector of its own as an array."""
    return np.array([p.X(), p.Y(), p.Z()])


def knots(values):
    """Distinct knots and how often each occurs."""
    distinct, times = np.unique(values, return_counts=True)
    return array1("double", distinct.tolist()), array1("int", times.tolist())


def curve(form):
    """A curve with a spline form as a Geom_BSplineCurve on the same knots."""
    nurbs = dx.to_nurbs(form)
    poles = array1("gp_Pnt", [point(p) for p in nurbs.control_points])
    return occ.Geom.Geom_BSplineCurve(poles, array1("double", nurbs.weights.tolist()), *knots(nurbs.knots), nurbs.degree)


def surface(form):
    """A surface with a spline form as a Geom_BSplineSurface on the same knots."""
    nurbs = dx.to_nurbs(form)
    poles = array2("gp_Pnt", [[point(p) for p in row] for row in nurbs.control_net])
    (knots_u, times_u), (knots_w, times_w) = knots(nurbs.knots_u), knots(nurbs.knots_w)
    weights = array2("double", nurbs.weights.tolist())
    return occ.Geom.Geom_BSplineSurface(poles, weights, knots_u, knots_w, times_u, times_w, *nurbs.degrees)


def along(geom, u):
    """Points of a curve at u in [0, 1], stretched onto its own range."""
    start, end = geom.FirstParameter(), geom.LastParameter()
    return np.array([xyz(geom.Value(start + t * (end - start))) for t in u])


def over(geom, u, w, bounds=None):
    """Points of a surface on the grid of u and w in [0, 1], stretched onto its own range or the given one."""
    u0, u1, w0, w1 = bounds or geom.Bounds()
    return np.array([[xyz(geom.Value(u0 + a * (u1 - u0), w0 + b * (w1 - w0))) for b in w] for a in u])
